"""Every face of a device shows one answer: terminal, text, table, page, index, front page, Python and sliders."""

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from answers import (
    BRIDGE,
    BUDGETS,
    CANTILEVER,
    STOPPER,
    STOPPERS,
    beam_answer,
    beam_page,
    designed,
    of_length,
    safe,
    silent,
    stopper_answer,
    stopper_dataset,
    stopper_page,
)

from stiction.answer.data import Cause, Verdict
from stiction.command import front_page, index
from stiction.command.present import Present
from stiction.contact.voltage import Dielectric
from stiction.device import Device
from stiction.devices.limits import rules
from stiction.report.answer import tables, words
from stiction.report.devices import explorer
from stiction.report.format import safe_size
from stiction.stages.answer.answer import layout
from stiction.stages.life.inputs import BeamErrors, BeamKeys, StopperKeys

UNSAFE = rules.plastic_contact(0.5, 1e8)
TIP = {(0.67, "tip"): BUDGETS["C1", 0.67, "tip"]}
VOLTAGE = BeamKeys(
    device=designed(),
    density=2330.0,
    liquids={},
    uncertainty=BeamErrors(),
    voltage=5.0,
    dielectric=Dielectric(1e-7, 4.0),
)
#: Section, datasets, budgets and more of each kind of beam. The budget of "uncertain" leaves no number.
BEAMS = {
    "cantilever": (CANTILEVER, {0.67: safe()}, TIP, {}),
    "two airs": (CANTILEVER | {"humidities": [0.44, 0.67]}, {0.44: safe(), 0.67: safe(longest=500e-6)}, TIP, {}),
    "own length": (CANTILEVER | {"length_um": 275}, {0.67: of_length(275e-6)}, TIP, {}),
    "too long": (CANTILEVER | {"length_um": 400}, {0.67: of_length(400e-6)}, {}, {}),
    "bridge": (BRIDGE, {0.67: safe("bridge")}, {}, {}),
    "dry": (CANTILEVER | {"humidities": [0.0]}, {0.0: safe()}, {}, {}),
    "voltage": (CANTILEVER | {"length_um": 275}, {0.67: of_length(275e-6)}, {}, {"of": VOLTAGE}),
    "forbidden": (CANTILEVER | {"length_um": 275}, {0.67: of_length(275e-6)}, TIP, {"limits": [UNSAFE]}),
    "uncertain": (
        CANTILEVER | {"length_um": 275},
        {0.67: of_length(275e-6)},
        {(0.67, "tip"): BUDGETS["C1", 0.67, "tip"].assign(covariance=5e3 * BUDGETS["C1", 0.67, "tip"].covariance)},
        {},
    ),
}
SIZE = re.compile(r"(?:No longer than|At least) (\S+) µ[mN]")


@pytest.fixture(scope="module", params=[*BEAMS, "stopper"])
def case(request):
    """Section, datasets by humidity or of a stopper, answer and page of a kind."""
    if request.param == "stopper":
        answer = stopper_answer(STOPPERS["S1"], {(0.67,): BUDGETS["S1", 0.67]})
        return STOPPER, STOPPERS["S1"], answer, stopper_page(STOPPER, STOPPERS["S1"], answer=answer)
    section, lengths, budgets, more = BEAMS[request.param]
    limits = more.get("limits", ())
    answer = beam_answer(section, lengths, budgets, **more)
    page = beam_page(section, lengths, budgets, warnings=silent(lengths, limits=limits), answer=answer)
    return section, lengths, answer, page


class Kept(dict):
    """Results of a device that are computed already."""

    def __init__(self, name, section, answer):
        super().__init__({f"devices/answer/{name}": layout(answer)})
        self.graph = SimpleNamespace(
            plan=SimpleNamespace(config={"devices": {name: section}}, sides=lambda _: ("B2", "Sub1"))
        )

    def __missing__(self, _):
        return None

    def has(self, name):
        """Whether a result is computed."""
        return name in self


def shown(answer):
    """Sizes that a face may state as the one to build, as text."""
    if answer.forbidden or not np.isfinite(answer.build):
        return []
    return [safe_size(answer.build, answer.sought).split()[0]]


def test_headline_text_page_index_and_front_page_state_the_same_size(case, tmp_path):
    section, _, answer, page = case
    (tmp_path / "devices").mkdir()
    (tmp_path / "devices" / f"{answer.device}.txt").write_text("".join(f"{line}\n" for line in page.lines))
    results, config = Present(tmp_path), {"devices": {answer.device: section}, "run": {"pairs": []}}
    (front,) = front_page.answers(results, config)
    (row,) = index._devices(results, config, [])  # noqa: SLF001
    number = page.html.partition('class="number">')[2].partition("</p>")[0].replace("\N{NO-BREAK SPACE}", " ")
    for said in (page.summary.line, page.lines[0], front, row["answer"], number):
        assert SIZE.findall(said) == shown(answer)
    assert front.endswith(page.lines[0])
    assert row["answer"] == page.lines[0]


def test_the_table_for_a_spreadsheet_has_the_numbers_and_the_verdict_of_the_page(case):
    _, _, answer, page = case
    table = tables.devices({answer.device: answer})
    (row,) = table.frame.to_dict("records")
    scale = 1e6
    expected = np.nan if answer.forbidden else scale * answer.build
    np.testing.assert_allclose(row["to_build"], expected, rtol=1e-9)
    assert (row["verdict"], row["sign"]) == (str(answer.verdict), page.summary.sign)
    if answer.stuck is not None and not page.is_forbidden:
        assert row["stuck"] in page.summary.answer
        np.testing.assert_allclose(row["stuck_high"], answer.stuck.high, rtol=1e-9)
    if page.is_forbidden:
        numbers = [row[name] for name in ("to_build", "exact", "stuck_value", "stuck_low", "stuck_high", "if_measured")]
        assert np.isnan(numbers).all()


def test_python_has_the_answer_of_the_page(case, monkeypatch):
    section, _, answer, page = case
    forbidding = [UNSAFE] * page.is_forbidden
    monkeypatch.setattr(Device, "limits", lambda self, found: forbidding)
    bare = replace(answer, forbidden=tuple(kind for kind in answer.forbidden if kind != UNSAFE.kind))
    device = Device(answer.device, Kept(answer.device, section, bare))
    found = device.answer()
    assert (found.verdict, found.forbidden) == (answer.verdict, answer.forbidden)
    np.testing.assert_equal([found.build, found.exact, found.size], [answer.build, answer.exact, answer.size])
    assert (page.summary.answer in device._repr_html_()) == (not page.is_forbidden)  # noqa: SLF001


def test_the_sliders_start_at_the_size_to_build(case):
    section, data, answer, page = case
    if page.is_forbidden:
        return
    if section["kind"] == "stopper":
        view, *_ = explorer.views_of_stopper(section, data, answer)
    else:
        view, *_ = explorer.views_of_beam(answer.device, section, data, {}, answer)
    assert view.grid.safe_size(view.grid.start) == pytest.approx(1e6 * answer.build, rel=1e-6)


def test_one_word_has_one_number(case):
    """Row 1: no two lengths are stated to build, and no length but this is called safe."""
    _, _, answer, page = case
    text = " ".join([*page.lines, page.html, tables.devices({answer.device: answer}).caption])
    assert "safe length" not in text.lower()
    assert "safe force" not in text.lower()
    assert set(SIZE.findall(" ".join(page.lines))) == set(shown(answer))


def test_no_text_decides(case, monkeypatch):
    """Row 5: with a placeholder in place of every text, verdicts and numbers stay."""
    _, _, answer, _ = case
    before = tables.devices({answer.device: answer}).frame
    tone = words.sign_of(answer)[0], words.is_forbidden(answer)
    monkeypatch.setattr(words, "CAUSES", dict.fromkeys(Cause, ("x", "x")))
    signs = {sought: {key: (tone, "x") for key, (tone, _) in of.items()} for sought, of in words._SIGNS.items()}  # noqa: SLF001
    monkeypatch.setattr(words, "_SIGNS", signs)
    monkeypatch.setattr(words, "NO_NUMBER", "x")
    monkeypatch.setattr(words, "_REASONS", dict.fromkeys(words._REASONS, "x"))  # noqa: SLF001
    after = tables.devices({answer.device: answer}).frame
    assert (words.sign_of(answer)[0], words.is_forbidden(answer)) == tone
    assert after.drop(columns="sign").equals(before.drop(columns="sign"))


# The other rows of what was wrong


def test_the_band_in_the_headline_contains_what_inputs_leave_open():
    """Row 2: the band is not that of the simulation alone."""
    section, lengths = CANTILEVER | {"length_um": 275}, {0.67: of_length(275e-6)}
    exact = beam_answer(section, lengths)
    tip = BUDGETS["C1", 0.67, "tip"]
    wide = beam_answer(section, lengths, {(0.67, "tip"): tip.assign(covariance=400 * tip.covariance)})
    assert wide.stuck.high - wide.stuck.low > 5 * (exact.stuck.high - exact.stuck.low)
    assert words.stuck_in_words(wide.stuck) in words.headline(wide)


def test_touchdowns_are_inside_the_headline_and_never_lengthen_a_beam():
    """Row 3."""
    once, often = (beam_answer(CANTILEVER | {"touchdowns": n}, {0.67: safe()}) for n in (1, 1000))
    assert often.build < once.build
    assert Cause.TOUCHDOWNS in often.included
    assert f"{1e6 * often.build:.0f} µm" in words.headline(often)
    assert "after 1000 touchdowns" in words.promise(often)


def test_a_voltage_is_inside_length_and_probability():
    """Row 4: P of a device with a voltage is not that of 0 V."""
    section, lengths = CANTILEVER | {"length_um": 300}, {0.67: of_length(300e-6)}
    of = BeamKeys(**{**VOLTAGE.__dict__, "voltage": 40.0})
    without, at = beam_answer(section, lengths), beam_answer(section, lengths, keys=of)
    assert Cause.VOLTAGE in at.included
    assert at.build < 0.9 * without.build
    assert at.stuck.value > without.stuck.value + 0.1


@pytest.mark.parametrize("touchdowns", [1, 100, 10_000])
def test_a_count_of_none_is_an_upper_bound_also_after_touchdowns(touchdowns):
    """Row 5 of the table: none of 400 patches stick at a force that all of them fall short of."""
    strong = stopper_dataset().assign(restoring_force=2e-5 * 1.0001)
    of = StopperKeys(restoring_force=float(strong.restoring_force), contact=(3e-6, 3e-6), touchdowns=touchdowns)
    answer = stopper_answer(strong, keys=of)
    # A fraction p of which none of 400 shows up in 5 % of all runs, after n touchdowns on other summits each.
    most = 1 - 0.05 ** (touchdowns / 400)
    assert answer.stuck.none_seen
    assert answer.stuck.low == 0
    assert answer.stuck.high >= (min(most, answer.share) if answer.is_enough else most) * (1 - 1e-9)
    assert words.stuck_in_words(answer.stuck).startswith("0 to 100 %" if most > 0.999 else "at most ")
    assert " 0 %" not in words.headline(answer)


def test_only_stated_airs_have_rows(case):
    """Row 7: nobody sees an air that nobody stated."""
    section, _, answer, _ = case
    assert {air.humidity for air in answer.airs} <= set(section["humidities"])


def test_a_limit_forbids_by_its_fields_alone():
    """Row 6: the sentence of a limit decides nothing."""
    lengths = {0.67: safe()}
    assert beam_answer(CANTILEVER, lengths, limits=[UNSAFE]).verdict is Verdict.NONE
    for limit in (rules.large_rotation(20e-6, 100e-6), rules.flat_patches(0.1)):
        assert beam_answer(CANTILEVER, lengths, limits=[limit]).verdict is Verdict.BUILD
