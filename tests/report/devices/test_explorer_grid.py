"""Grid of a page: values between computed states, never beyond them, and every text of a page as its characters."""

import json
from dataclasses import replace

import numpy as np
import pytest
from hostile import HOSTILE, Reading
from numpy.testing import assert_allclose
from packed import unpacked
from scipy.interpolate import PchipInterpolator
from scipy.special import ndtr

from stiction.devices.risk import SCORES
from stiction.report.devices.grid import Grid, GridAxis, StuckShares, monotone, packed
from stiction.report.devices.levels import counted
from stiction.report.page import Page

RNG = np.random.default_rng(5)


def axis(key, values, scale="log", between=True):
    return GridAxis(key, key, "µm", scale, tuple(values), values[0], between, "it was not computed", f"{key}_um")


#: Lognormal sticking lengths, whose median is a power of thickness, of thirty thousand devices.
SLOPE, DEVICES = 0.1, 30_000
THICKNESS, SHARE = axis("thickness", (1.0, 2.0, 4.0)), axis("share", (1e-3, 1e-2), "score")
STATE = {"thickness": 3.0, "share": 4e-3, "length": 200.0}


def lognormal(falls=False):
    medians = 100 * np.array(THICKNESS.values)[:, None] ** 0.75
    safe = medians * np.exp(SLOPE * SHARE.coordinates * (-1 if falls else 1))
    size = axis("length", (10.0, 1000.0), "linear")
    known = medians * np.exp((-1 if falls else 1) * SLOPE * SCORES)
    return Grid((THICKNESS,), SHARE, size, safe, counted(known, DEVICES), DEVICES, falls)


def score_of(state):
    return np.log(state["length"] / (100 * state["thickness"] ** 0.75)) / SLOPE


@pytest.mark.parametrize("count", [2, 3, 7])
def test_the_cubic_is_that_of_fritsch_and_butland(count):
    places, values = np.sort(RNG.random(count)), RNG.normal(size=(count, 40))
    for at in np.linspace(places[0], places[-1], 23):
        assert_allclose(monotone(places, values, at), PchipInterpolator(places, values)(at), rtol=1e-9, atol=1e-12)


def test_a_power_law_is_answered_exactly_between_its_states():
    grid = lognormal()
    assert grid.safe_size(STATE) == pytest.approx(100 * 3**0.75 * np.exp(SLOPE * SHARE.coordinate(4e-3)), rel=1e-9)
    assert grid.stuck(STATE).share == pytest.approx(ndtr(score_of(STATE)), rel=1e-9)
    assert grid.stuck(STATE | {"length": grid.safe_size(STATE)}).share == pytest.approx(4e-3, rel=1e-9)


def test_more_stoppers_stick_where_more_beams_release():
    beams, stoppers = lognormal(), lognormal(falls=True)
    assert stoppers.stuck(STATE).share == pytest.approx(1 - beams.stuck(STATE).share)


@pytest.mark.parametrize("falls", [False, True])
def test_beyond_the_simulated_devices_a_fraction_is_a_bound(falls):
    grid, sign = lognormal(falls), -1 if falls else 1
    for length, beyond in ((10.0, -sign), (1000.0, sign)):
        found = grid.stuck(STATE | {"length": length})
        assert found.beyond == beyond
        assert found.share == pytest.approx(ndtr(SCORES[-1] * beyond))
    assert np.isnan(replace(grid, levels=np.full_like(grid.levels, np.nan)).stuck(STATE).share)


def test_no_state_beyond_the_computed_ones_has_an_answer():
    grid = lognormal()
    for key, value in (("thickness", 0.99), ("thickness", 4.01), ("share", 0.02)):
        with pytest.raises(ValueError, match=r"has no answer: it was not computed"):
            grid.safe_size(STATE | {key: value})
    with pytest.raises(ValueError, match="thickness 3 µm"):
        replace(grid, axes=(axis("thickness", THICKNESS.values, between=False),)).safe_size(STATE)


def test_the_band_of_counted_devices_is_that_of_wilson():
    grid, factor = lognormal(), 1.959964**2 / DEVICES
    for length in (190.0, 228.0, 260.0):
        found = grid.stuck(STATE | {"length": length})
        half = 1.959964 * np.sqrt(found.share * (1 - found.share) / DEVICES + factor / (4 * DEVICES))
        ends = [(found.share + factor / 2 + sign * half) / (1 + factor) for sign in (-1, 1)]
        assert (found.low, found.high) == pytest.approx(ends, rel=0.02)


def test_below_a_size_the_upper_end_of_a_fraction_alone_is_known():
    grid = lognormal()
    first = 100 * np.array(THICKNESS.values)[:, None] ** 0.75 * np.exp(-3 * SLOPE)
    below = 0.99 * float(100 * 3**0.75 * np.exp(-3 * SLOPE))
    band = grid.stuck(STATE | {"length": below})
    bounded = replace(grid, first=first)
    assert bounded.stuck(STATE | {"length": below}) == StuckShares(band.share, 0.0, band.high, -1)
    above = STATE | {"length": 1.02 * below / 0.99}
    assert bounded.stuck(above) == grid.stuck(above)
    assert grid.stuck(above).beyond == 0


@pytest.mark.parametrize("falls", [False, True])
def test_an_end_of_a_band_beyond_its_levels_is_no_narrower_than_known(falls):
    grid, sign = lognormal(falls), -1 if falls else 1
    half = replace(grid, levels=grid.levels.copy())
    half.levels[1, ..., : len(grid.scores) // 2] = np.nan  # below the middle, a lower end is not known
    half.levels[2, ..., len(grid.scores) // 2 :] = np.nan  # above it, an upper end is not
    few, many = (half.stuck(STATE | {"length": 228 * np.exp(2 * sign * step * SLOPE)}) for step in (-1, 1))
    assert (few.low, many.high) == (0, 1)
    assert few.high == grid.stuck(STATE | {"length": 228 * np.exp(-2 * sign * SLOPE)}).high
    none = replace(grid, levels=np.stack([grid.levels[0], *np.full_like(grid.levels[1:], np.nan)])).stuck(STATE)
    assert (none.low, none.high) == (0, 1)


@pytest.mark.parametrize("falls", [False, True])
def test_a_fraction_grows_with_the_size_also_where_its_levels_do_not(falls):
    grid, sign = lognormal(falls), -1 if falls else 1
    ragged = replace(grid, levels=grid.levels * np.exp(0.5 * SLOPE * RNG.normal(size=grid.levels.shape[1:])))
    lengths = 228 * np.exp(sign * SLOPE * np.linspace(-3, 3, 41))
    found = np.array([[one.low, one.share, one.high] for one in (ragged.stuck(STATE | {"length": x}) for x in lengths)])
    assert (np.diff(found, axis=0) >= 0).all()
    assert (np.diff(found, axis=1) >= 0).all(), "in its band"


@pytest.mark.parametrize("shape", [(3, 2, 5), (3, 7)])
@pytest.mark.parametrize("decades", [0.1, 7])
def test_packed_sizes_are_the_same_to_a_millionth_and_shorter_than_their_digits(shape, decades):
    sizes = 10 ** RNG.uniform(-decades / 2, decades / 2, shape)
    sizes[0, 0], sizes[2, ..., -1] = np.nan, np.nan
    content = packed(sizes)
    assert_allclose(unpacked(content), sizes, rtol=1e-6 * decades / 7)
    assert len(content["content"]) == 4 * sizes.size
    assert json.loads(json.dumps(content)) == content


@pytest.mark.parametrize("sizes", [np.full((2, 3), np.nan), np.array([[5.0, np.nan]]), np.array([[0.0, 2.0, np.inf]])])
def test_packed_sizes_can_be_unknown_or_all_the_same(sizes):
    known = np.where(np.isfinite(sizes) & (sizes > 0), sizes, np.nan)
    assert_allclose(unpacked(packed(sizes)), known, rtol=1e-12)


def test_no_text_of_a_grid_leaves_its_script():
    content = {"name": HOSTILE, "study": {HOSTILE: HOSTILE}, "grid": lognormal().json}
    page = Page(HOSTILE, {}, [HOSTILE], explorer=content).html
    read = Reading(page)
    data, script = read.text["script"]
    assert json.loads(data) == json.loads(json.dumps(content | {"forbidden": ""}))
    assert script.startswith('(() => {\n"use strict";\nconst content = JSON.parse(')
    assert read.code == ["meta"] * 3 + ["script"] * 2, "those of the template"


def test_a_page_without_a_grid_has_no_script():
    assert Reading(Page("C1", {}, ["Build it."]).html).code == ["meta"] * 3
