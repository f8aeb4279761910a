"""With a placeholder in the place of every sentence on a limit, pages, tables, counts and verdicts decide the same."""

import json

import pytest
from answers import (
    BRIDGE,
    CANTILEVER,
    STOPPER,
    beam_answer,
    beam_page,
    safe,
    screen_of,
    silent,
    stopper_dataset,
    stopper_page,
)
from noted import save_page

from stiction.command.last_lines import where_to_look
from stiction.devices.limits import rules
from stiction.report.limits import pages, words
from stiction.stages.beams.pair_warnings import Subject

LIMITS = [
    rules.plastic_contact(0.5, 1e8),
    rules.plastic_contact(float("nan"), float("nan")),
    rules.spacer("FDTS", ["coating"]),
    rules.without_gaps({0.1: (-0.2, 0.01)}, shorter=True),
    rules.without_gaps({0.1: (0.2, 0.01)}, shorter=True),
    rules.smooth_pair(1e-9, [0.9]),
    rules.unknown_full_contact([0.5]),
    rules.thin_film(0.5e-9),
    rules.beyond_isotherm(0.9, 0.95),
    rules.condensing([{"temperature_C": 5, "dew_point_C": 10}]),
    rules.supercooled([{"temperature_C": -5, "humidity": 0.5}]),
    rules.large_rotation(20e-6, 100e-6),
    rules.stubby_beam(20e-6, 2e-6),
    rules.flat_patches(0.1),
]


class Unread(str):
    """Text that fails where it is searched."""

    def _refuse(self, *_):
        raise AssertionError("a sentence on a limit is read")

    __contains__ = partition = rpartition = split = splitlines = startswith = endswith = find = _refuse


def _bridge(found):
    """Page of a bridge with some limits."""
    lengths = {0.67: safe("bridge")}
    return beam_page(BRIDGE, lengths, warnings=silent(lengths, limits=found))


def decided(folder):
    """What pages, files and the terminal decide without limits, with some, and with all of them."""
    for found in ([], LIMITS[-2:], LIMITS):
        for page in (_bridge(found), stopper_page(STOPPER, stopper_dataset(), limits=found)):
            yield page.summary.sign, page.summary.tone, len(page.warnings), page.is_forbidden
        save_page(folder, *found)
        yield json.loads((folder / "warnings.json").read_text())
        yield sum(line.startswith("- ") for line in (folder / "warnings.md").read_text().splitlines())
        yield list(where_to_look(folder))


def test_decisions_are_those_with_a_placeholder_for_every_sentence(tmp_path, monkeypatch):
    with_words = list(decided(tmp_path))
    monkeypatch.setattr(words, "SENTENCES", dict.fromkeys(words.SENTENCES, lambda **_: Unread("x")))
    assert list(decided(tmp_path)) == with_words
    signs = {sign for sign, *_ in (row for row in with_words if isinstance(row, tuple))}
    assert {"Do not rely on a number"} < signs, "the control: limits decide"


@pytest.mark.parametrize("limit", LIMITS, ids=lambda limit: limit.kind)
def test_a_first_screen_has_no_number_where_a_limit_forbids_it_and_only_there(limit):
    shown = screen_of(beam_answer(CANTILEVER, {0.67: safe()}, limits=[limit]), CANTILEVER, [limit])
    assert (shown.sign == "Do not rely on a number") == limit.forbids


def test_limits_come_back_from_the_file_of_a_page_with_their_subjects():
    first, second = Subject("C1", ("RH 0.6", "held by the tip")), Subject("C: 2; x")
    found = {first: LIMITS[:2], second: LIMITS[1:]}
    assert dict(pages.of_json(pages.as_json(found))) == pages.by_limit(found)
    assert pages.by_limit(found)[LIMITS[1]] == [first, second]
    assert pages.of_json("") == []
