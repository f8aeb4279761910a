"""Limits are data: each kind has one sentence and one row of the docs, sides follow from physics, no text is read."""

import ast
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from beams import PAPER
from hypothesis import given, settings
from hypothesis import strategies as st
from test_limits import CASES

from stiction.beam.energy import arrest_length
from stiction.contact.full.smooth_pairs import RATIOS
from stiction.contact.gaps import FlatAttraction
from stiction.devices.limits import rules
from stiction.devices.limits.limit import Limit, Side, restored
from stiction.report.limits import words
from stiction.run.fingerprint import PACKAGE, fingerprint
from stiction.run.stored_limits import as_text, of_text
from stiction.scans.flags import KINDS
from stiction.stages.surfaces.surface_flags import SIDES

ROOT = Path(__file__).parents[2]
FOUND = [limit(*beyond) for limit, beyond, *_ in CASES]
FOUND += [rules.without_gaps({0.5: (change, 0.01)}, shorter=True) for change in (-0.2, 0.2)]
SOURCES = {path: ast.parse(path.read_text(encoding="utf-8")) for path in PACKAGE.rglob("*.py")}


def stated_in_source():
    """Kind, side and whether the error is known of every limit that the code writes down."""
    for tree in SOURCES.values():
        for node in ast.walk(tree):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "Limit" and len(node.args) >= 3:
                kind, side, bounded, *_ = node.args
                if isinstance(kind, ast.Constant):
                    yield kind.value, side.attr.lower(), bounded.value


def rows():
    """Kind, side and whether the error is known, of the table of the docs."""
    table = (ROOT / "docs" / "tables" / "warnings.md").read_text(encoding="utf-8")
    return [
        (kind, side, known == "yes") for kind, side, known in re.findall(r"^\| `(\w+)` \| (\w+) \| (\w+) ", table, re.M)
    ]


def test_every_kind_has_one_row_of_the_docs_with_its_side_and_one_sentence():
    by_rules = {(limit.kind, str(limit.side), limit.bounded) for limit in FOUND}
    by_flags = {(kind, str(side), bounded) for kind, (side, bounded) in SIDES.items()}
    stated = by_rules | by_flags | set(stated_in_source())
    assert sorted(rows()) == sorted(stated), "each once"
    assert {kind for kind, *_ in rows()} == set(words.SENTENCES)
    assert set(KINDS) < set(SIDES)


def test_what_forbids_a_number_is_what_forbade_one():
    """As decided by the words of the sentences, before they were data."""
    forbidding = {kind for kind, side, known in rows() if side == "unsafe" and not known}
    own = {"smoother_than_full_contact", "test_beams_contradict"}  # not in lists of first screens; by its p value
    said = {limit.kind for limit in FOUND if "the unsafe side" in words.text(limit)}
    assert forbidding - own == said | {"bowed"}
    assert said >= {"plastic_contact", "spacer", "without_gaps", "smooth_pair", "wide_meniscus"}


@pytest.mark.parametrize("limit", FOUND)
def test_limits_come_back_from_their_files(limit):
    (again,) = of_text(as_text([limit]))
    assert again == limit
    assert words.text(again) == words.text(limit)
    np.testing.assert_equal(again.amount, limit.amount)


NUMBERS = st.dictionaries(st.text(), st.floats(allow_nan=False, allow_infinity=False) | st.text() | st.booleans())
LIMITS = st.builds(Limit, st.text(), st.sampled_from(Side), st.booleans(), st.floats(-1, 1) | st.just(np.nan), NUMBERS)


@settings(max_examples=30)
@given(LIMITS)
def test_any_limit_comes_back_and_forbids_only_unknown_errors_on_the_unsafe_side(limit):
    again = restored(json.loads(json.dumps(limit.stored(), allow_nan=False)))
    assert (again, again.forbids) == (limit, limit.forbids)
    assert hash(again) == hash(limit)
    np.testing.assert_equal(again.amount, limit.amount)
    assert limit.forbids == (limit.side == Side.UNSAFE and not limit.bounded)
    assert replace(limit, numbers={"x": 0}) != replace(limit, numbers={"x": 1})


# Sides by a second route: with the effect, does the device stick more?


def released_energy(length, thickness, clamp, shear):
    """-dU/dl of a clamped and guided beam with h = E = w = 1, by flexibilities: its clamp turns, its shear yields."""

    def energy(length):
        second = thickness**3 / 12
        bend = np.array([[length**3 / 3, length**2 / 2], [length**2 / 2, length]]) / second  # of a cantilever
        turn = clamp / thickness**2 * np.outer([length, 1], [length, 1])
        slide = np.diag([shear * length / thickness, 0])
        stiffness = np.linalg.inv(bend + turn + slide)
        return stiffness[0, 0] / 2  # its free end sinks by 1 without turning

    step = 1e-4 * length
    return (energy(length - step) - energy(length + step)) / (2 * step)


@pytest.mark.parametrize("ratio", [8, 19, 60])
def test_shear_and_an_elastic_clamp_shorten_cracks_as_stated(ratio):
    clamp, shear = 16.67 / np.pi, 2 * (1 + 0.22) / (5 / 6)
    ideal = released_energy(ratio, 1.0, 0.0, 0.0)
    np.testing.assert_allclose(ideal, 1.5 / ratio**4, rtol=1e-6)  # Eq. (13), the control
    lengths = np.linspace(0.8, 1.0, 2001) * ratio
    released = [released_energy(length, 1.0, clamp, shear) for length in lengths]
    arrested = lengths[np.argmin(np.abs(np.log(released) - np.log(ideal)))]
    shorter = rules.CLAMP / ratio + rules.SHEAR / ratio**2
    np.testing.assert_allclose(1 - arrested / ratio, shorter, atol=0.6 / ratio**2)  # of first order in t / l
    if limit := rules.stubby_beam(ratio, 1.0):
        assert (limit.side, limit.amount) == (Side.UNSAFE, -shorter)


def test_a_plate_comes_free_at_lengths_at_which_a_beam_sticks():
    plate = replace(PAPER, young_modulus=PAPER.young_modulus / (1 - 0.22**2))
    assert arrest_length(5e-3, plate) > arrest_length(5e-3, PAPER)
    assert rules.wide_beam(20e-6, 500e-6, 2.6e-6, 700e-6).side == Side.SAFE


def test_a_coating_that_attracts_holds_more_than_a_spacer():
    spaced, attracting = (FlatAttraction(1e-19, spacer=spacer).work(0.0) for spacer in (2e-9, 0.0))
    assert attracting > spaced
    assert rules.spacer("FDTS", ("coating",)).side == Side.UNSAFE


def test_smooth_pairs_hold_more_than_their_summits_by_the_amount():
    limit = rules.smooth_pair(1.0145e-9, [0.9])
    np.testing.assert_allclose(1 + limit.amount, RATIOS[1, 1], rtol=2e-3)


def test_the_mean_of_cracks_that_fit_a_beam_is_too_short():
    cracks = np.random.default_rng(1).normal(1400, 100, 10_000)
    short = cracks[cracks < 1500]
    assert short.mean() < cracks.mean()
    assert rules.cut_off_mean(len(short) / len(cracks), short.mean(), 1500).side == Side.SAFE


# No sentence is read


READS = {"partition", "rpartition", "split", "startswith", "endswith", "find", "index", "search", "match", "count"}


def searches(tree):
    """Expressions that look into a text of a name that speaks of warnings or limits."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Compare) and any(isinstance(part, ast.In | ast.NotIn) for part in node.ops):
            looked, at = isinstance(node.left, ast.Constant | ast.JoinedStr), node.comparators[0]
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in READS:
            looked, at = True, node.func.value
        else:
            continue
        if looked and re.search("warning|limit|sentence|flag", ast.unparse(at)):
            yield ast.unparse(node)


def test_no_module_searches_in_the_text_of_a_warning():
    """One lays out the flags of the table of scans."""
    found = {path.name: expression for path, tree in SOURCES.items() for expression in searches(tree)}
    assert found == {"index.py": "flag.partition(': ')"}


@pytest.mark.parametrize("line", ["'unsafe' in warning", "warning.partition('; ')", "sentence.split(':')[0]"])
def test_a_search_in_a_warning_is_found(line):
    assert list(searches(ast.parse(line)))


def test_a_sentence_reruns_no_stage_of_contacts_surfaces_or_points():
    """Their jobs rerun if a module of their fingerprint changes. Limits alone, which have no words, are among them."""
    home = "stiction.report.limits.words"
    stages = {path: fingerprint(path) for path in PACKAGE.glob("stages/**/*.py")}
    assert len(stages) > 50
    assert not [path.name for path, modules in stages.items() if home in modules]
    points = stages[PACKAGE / "stages" / "axes" / "roughness.py"]
    assert "stiction.devices.limits.rules" in points
    assert home in fingerprint(PACKAGE / "report" / "devices" / "pages.py"), "the control: pages have words"
