"""Counts of none and of all of the simulated devices are bounds, wherever they are printed."""

import re

import numpy as np
import pytest
import xarray as xr
from answers import CANTILEVER, STOPPER, STOPPERS, beam_page, of_length, silent, stopper_dataset, stopper_page
from hypothesis import given
from hypothesis import strategies as st
from lives import STOPPER as IN_USE

from stiction.contact.correction import NONE
from stiction.devices.risk import stuck_share, upper_bound
from stiction.report.budget import tables as tables_budget
from stiction.report.devices import sentences
from stiction.report.devices import tables as tables_devices
from stiction.report.format import fraction_between, fraction_with_band
from stiction.stages.devices.stoppers import stuck_with_band
from stiction.stages.life.stoppers import stopper_answers

#: A fraction of zero or of all as an estimate: 0 %, 100 %, 0 (…) and 100 (…) in cells.
AS_ESTIMATE = re.compile(r"(?<![\d.,])(?:0|100)(?: %| \()")


def counted(stuck, number):
    """Fraction of some of a number of devices with its band."""
    lengths = np.where(np.arange(number) < stuck, 1.0, 3.0)
    return tuple(float(part[0]) for part in stuck_share(np.array([2.0]), lengths))


@given(st.integers(10, 100_000), st.floats(0, 1))
def test_a_count_is_printed_with_its_band_unless_it_is_none_or_all(number, part):
    for stuck in {0, round(part * number), number}:
        text = fraction_with_band(*counted(stuck, number), " %")
        said = [float(value) / 100 for value in re.findall(r"[\d.e-]+(?= %)", text)]
        if 0 < stuck < number:
            assert re.fullmatch(r"\S+ % \(\S+ to \S+ %\)", text)
        else:
            (bound,) = said
            # By the binomial distribution, a true fraction at the bound shows such a count in 2.5 % of the runs.
            seen = (1 - bound) ** number if stuck == 0 else bound**number
            assert 0.017 < seen < 0.0251, "two digits, on the safe side"
            assert text.startswith("at most" if stuck == 0 else "at least")


def test_ends_without_a_bound_stay_ends():
    assert fraction_between(0.0, 1.0, " %") == "0 to 100 %"
    assert fraction_between(0.2, 0.4) == "20 to 40"


@given(st.floats(-9, -2), st.floats(0.01, 1))
def test_no_end_short_of_all_is_printed_as_all(power, part):
    high = 1 - 10**power
    low = high * part
    for text in (fraction_between(0.0, high), fraction_between(low, high), fraction_between(high, 1.0)):
        said = [float(value) for value in re.findall(r"\d[\d.e-]*", text)]
        assert max(said) < 100
        assert said[-1] == pytest.approx(100 * high, abs=0.05)


@pytest.mark.parametrize("truth", [0.1 / 400, 1 / 400, 2.9 / 400])
def test_touchdowns_of_a_stopper_of_which_none_stuck_are_bounded_by_what_its_patches_can_hide(truth):
    forces = stopper_dataset()
    strong = 1.001 * float(forces.pull_off.max())
    stuck = [stuck_with_band(row, strong, NONE) for row in forces.pull_off.values]
    none = forces.assign(stuck=(("bound", "humidity"), np.transpose(stuck)))
    assert float(none.stuck.sel(bound="estimate").max()) == 0
    found = {one.name: one for one in stopper_answers(none, IN_USE)}["stuck_after"]
    assert (1 - truth) ** 400 > 0.05, "such patches are not rare"
    assert found.low <= truth
    assert 1 - (1 - truth) ** IN_USE.touchdowns < found.high
    assert found.high < 2 * IN_USE.touchdowns * upper_bound(0, 400)


def of_stopper(share):
    """Everything that is said of a stopper of which a share of none or all sticks."""
    band = {0.0: (0.0, 0.0, 0.0092), 1.0: (1.0, 0.9908, 1.0)}[share]
    found = STOPPERS["S1"]
    for name in ("stuck", "stuck_along"):
        shares = xr.zeros_like(found[name]) + xr.DataArray(list(band), dims="bound")
        found = found.assign({name: shares.transpose(*found[name].dims)})
    strong = 1.1 if share == 0 else 1e-3
    page = stopper_page(STOPPER, found.assign(restoring_force=strong * found.pull_off.max()))
    screen = page.summary
    cells = tables_budget.stoppers({"S1": found}, {"S1": []}).cells["P(stuck) [%]"]
    return [*page.lines, screen.answer, *screen.cells.iloc[:, 1], *cells, sentences.worst_sentence(found)]


def of_beam(length):
    """Everything that is said of beams of a length of which none or all stick."""
    cases = {0.67: of_length(length)}
    page = beam_page(CANTILEVER | {"length_um": 1e6 * length}, cases)
    screen = page.summary
    cells = tables_devices.safe_lengths({("C1", 0.67): cases[0.67]}, silent(cases).lengths).cells["P(stuck) [%]"]
    return [*page.lines, screen.answer, *screen.cells.iloc[:, -1], *cells]


@pytest.mark.parametrize("said", [of_stopper(0.0), of_stopper(1.0), of_beam(150e-6), of_beam(500e-6)])
def test_no_page_screen_or_table_has_a_count_of_none_or_all_as_an_estimate(said):
    assert not [text for text in said if AS_ESTIMATE.search(str(text).replace("\N{NO-BREAK SPACE}", " "))]
    assert any("at most" in str(text) or "at least" in str(text) for text in said)


def test_the_search_finds_an_estimate_of_none():
    for text in ("0 % (0 to 0.918 %)", "0 (0 to 0.918)", "more than 0 % stick", "100 % (99.1 to 100 %)"):
        assert AS_ESTIMATE.search(text)
