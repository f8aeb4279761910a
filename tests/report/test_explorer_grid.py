"""Grid of a page: values between computed states, never beyond them, and every text of a page as its characters."""

import json
from dataclasses import replace

import numpy as np
import pytest
from hostile import HOSTILE, Reading
from numpy.testing import assert_allclose
from scipy.interpolate import PchipInterpolator
from scipy.special import ndtr

from stiction.devices.risk import SCORES
from stiction.report.devices.grid import Axis, Grid, band, monotone
from stiction.report.page import Page

RNG = np.random.default_rng(5)


def axis(key, values, scale="log", between=True):
    return Axis(key, key, "µm", scale, tuple(values), values[0], between, "it was not computed", f"{key}_um")


#: Lognormal sticking lengths, whose median is a power of thickness, of thirty thousand devices.
SLOPE, DEVICES = 0.1, 30_000
THICKNESS, SHARE = axis("thickness", (1.0, 2.0, 4.0)), axis("share", (1e-3, 1e-2), "score")
STATE = {"thickness": 3.0, "share": 4e-3, "length": 200.0}


def lognormal(falls=False):
    medians = 100 * np.array(THICKNESS.values)[:, None] ** 0.75
    safe = medians * np.exp(SLOPE * SHARE.places * (-1 if falls else 1))
    size = axis("length", (10.0, 1000.0), "linear")
    return Grid((THICKNESS,), SHARE, size, safe, medians * np.exp(SLOPE * SCORES), DEVICES, falls)


def score_of(state):
    return np.log(state["length"] / (100 * state["thickness"] ** 0.75)) / SLOPE


@pytest.mark.parametrize("count", [2, 3, 7])
def test_the_cubic_is_that_of_fritsch_and_butland(count):
    places, values = np.sort(RNG.random(count)), RNG.normal(size=(count, 40))
    for at in np.linspace(places[0], places[-1], 23):
        assert_allclose(monotone(places, values, at), PchipInterpolator(places, values)(at), rtol=1e-9, atol=1e-12)


def test_a_power_law_is_answered_exactly_between_its_states():
    grid = lognormal()
    assert grid.safe_size(STATE) == pytest.approx(100 * 3**0.75 * np.exp(SLOPE * SHARE.place(4e-3)), rel=1e-9)
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
    assert np.isnan(replace(grid, quantiles=np.full_like(grid.quantiles, np.nan)).stuck(STATE).share)


def test_no_state_beyond_the_computed_ones_has_an_answer():
    grid = lognormal()
    for key, value in (("thickness", 0.99), ("thickness", 4.01), ("share", 0.02)):
        with pytest.raises(ValueError, match=r"has no answer: it was not computed"):
            grid.safe_size(STATE | {key: value})
    with pytest.raises(ValueError, match="thickness 3 µm"):
        replace(grid, axes=(axis("thickness", THICKNESS.values, between=False),)).safe_size(STATE)


def test_the_band_holds_the_fraction_as_often_as_it_says():
    share, samples = 0.03, 400
    found = RNG.binomial(samples, share, 20_000) / samples
    ends = np.array([band(one, samples) for one in np.unique(found)])
    inside = dict(zip(np.unique(found), (ends[:, 0] <= share) & (share <= ends[:, 1]), strict=True))
    assert np.mean([inside[one] for one in found]) == pytest.approx(0.95, abs=0.02)


def test_no_text_of_a_grid_leaves_its_script():
    content = {"name": HOSTILE, "study": {HOSTILE: HOSTILE}, "grid": lognormal().json}
    page = Page(HOSTILE, {}, [HOSTILE], explorer=content).html
    read = Reading(page)
    data, script = read.text["script"]
    assert json.loads(data) == json.loads(json.dumps(content | {"forbidden": ""}))
    assert script.startswith("// Controls")
    assert read.code == ["meta"] * 3 + ["script"] * 2, "those of the template"


def test_a_page_without_a_grid_has_no_script():
    assert Reading(Page("C1", {}, ["Build it."]).html).code == ["meta"] * 3
