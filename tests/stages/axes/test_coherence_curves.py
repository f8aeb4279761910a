"""Devices over the coherence of both surfaces, and over the play of one that follows the other."""

from dataclasses import replace

import numpy as np
import pytest
from plans import LIKE_B2
from test_roughness_curves import RANGE8, WATER, point

import stiction
from stiction.config.messages import ConfigError
from stiction.contact.correction import Correction, ElasticChange
from stiction.devices.roughness import SCALES
from stiction.plan.graph import Graph, Results
from stiction.plan.plan import Plan
from stiction.report.axes import roughness as sentences
from stiction.report.devices import curve_views, pages
from stiction.stages.axes import requirement, roughness
from stiction.stages.axes.roughness import POINTS

SAMPLES, SHARE, FORCE = 200, 0.05, 8
FULL = replace(WATER, correction=Correction(np.array([0.5, 0.8]), ElasticChange(1.2), ElasticChange(1.3)))
STOPPER = {"kind": "stopper", "pair": "r", "contact_um": [1, 1], "restoring_force_uN": FORCE, "humidities": [0.67]}
STOPPER |= {"requirement": {"share": SHARE}, "roughness": {"surface": "G", "coherence": [0, 0.97]}}


def study(coherence=0.9, **stated):
    """Configuration of a stopper on a surface that follows another one alike."""
    pair = {"beam": "G", "substrate": "G", "gap_um": 2, "humidities": [0.67], "replica": {"coherence": coherence}}
    few = {"contact": {"samples": SAMPLES, "model": "summits"}, "chaos": {"order": 1}}
    return few | {
        "surfaces": {"G": LIKE_B2},
        "pairs": {"r": pair},
        "devices": {"S": STOPPER | stated},
        "run": {"pairs": [], "studies": []},
    }


def device(coherence=0.9):
    """Stopper at a coherence."""
    return stiction.Device("S", Results.of(stiction.load(study(coherence))))


@pytest.fixture(scope="module")
def curve():
    """Stopper over the coherence."""
    return device().roughness()


def test_the_force_at_the_given_coherence_is_todays_and_it_grows_with_the_coherence(curve):
    given = curve.sel(roughness=float(curve.given))
    assert float(curve.given) == 0.9
    np.testing.assert_array_equal(given.stuck[:, 0], device().forces().stuck.T)
    assert np.all(np.diff(curve.estimate.values.squeeze()) > 0)


def test_at_the_coherence_that_a_device_stands_the_allowed_share_sticks(curve):
    """On the same random numbers; the error of the cubic between the points is all that is left."""
    (place,), (error,) = curve.crossing_place.values, curve.crossing_error.values
    assert 0 < error < 0.3 * (1 - place)
    for coherence, expected in ((place, True), (1 - 0.7 * (1 - place), False)):
        forces = device(float(coherence)).forces().pull_off.values
        apart = abs(np.mean(forces > 1e-6 * FORCE) - SHARE)
        assert bool(apart < np.sqrt(SHARE * (1 - SHARE) / SAMPLES)) is expected


def test_the_safe_end_is_below_the_estimate_and_both_are_said(curve):
    ((low,), (high,)), (place,) = (curve.range_low.values, curve.range_high.values), curve.crossing_place.values
    assert (low, high < place) == (0, True)
    (said,) = [one for one in sentences.answers(curve) if one.startswith("For a restoring force")]
    assert f"sticks where the coherence of G is 0 to {high:.3g} (" in said
    assert "exactly 1 in 20 sticks at 0." in said
    assert "stays" not in sentences.form(curve)
    section, *_ = pages._how_rough("S", curve)
    assert section.title == "How closely may it follow?"


def test_coherences_are_spaced_by_equal_factors_of_their_rest_and_plays_evenly():
    (values,) = roughness.axes_of(Plan(stiction.load(study())), "S").values()
    rests = 1 - np.array(values[:-1])
    np.testing.assert_allclose(rests[1:] / rests[:-1], (1 - 0.97) ** (1 / (POINTS - 2)), rtol=1e-7)
    assert np.ptp(np.diff(values[:-1])) > 0.1, "control"
    np.testing.assert_allclose(np.diff(roughness.spaced("play_nm", 0, 60, POINTS - 1)), 10)


@pytest.mark.parametrize("name", SCALES)
def test_scales_are_inverted_and_have_their_slope(name):
    scale, value = SCALES[name], np.array([0.2, 0.9])
    at, step = scale.coordinate(value), 1e-6
    np.testing.assert_allclose(scale.value(at), value, rtol=1e-12)
    np.testing.assert_allclose((scale.value(at + step) - scale.value(at - step)) / (2 * step), scale.slope(value))
    np.testing.assert_allclose(np.diff(scale.coordinate(scale.spaced(*value, 5)), 2), 0, atol=1e-12)


def job_settings(number, **stated):
    """Settings of a point."""
    return Graph(Plan(stiction.load(study(**stated)))).job(f"devices/roughness/points/S_{number}").settings


def test_a_map_has_coherences_and_plays_and_other_curves_have_no_setting_of_either():
    over = {"surface": "G", "coherence": [0.5, 0.9], "play_nm": [0, 40]}
    last = job_settings(5 * POINTS - 2, roughness=over)
    assert last["device"]["humid"]["contact"]["replica"] == {"coherence": 0.9, "play_nm": 40}
    assert (last["replica"], last["values"], last["varied"]) == ({"coherence": 0.9}, {}, ["coherence", "play"])
    assert "replica" not in job_settings(0, roughness={"surface": "G", "rms_nm": [2, 5]})


def test_tips_of_beams_follow_as_their_strips():
    beam = {"kind": "cantilever", "pair": "r", "thickness_um": 4, "gap_um": 2, "width_um": 20, "humidities": [0.67]}
    over = {"requirement": {"share": SHARE, "length_um": 200}, "roughness": STOPPER["roughness"]}
    plan = Plan(stiction.load(study() | {"devices": {"B": beam | over}}))
    contacts = Graph(plan).job("devices/roughness/points/B_0").settings["device"]["humid"]
    assert [contacts[name]["replica"]["coherence"] for name in ("contact", "tips")] == [0, 0]


def test_a_slider_interpolates_as_the_sentence(curve):
    grid, (place,) = curve_views.roughness_view("S", STOPPER, curve).grid, curve.crossing_place.values
    assert grid.at(grid.start | {"coherence": float(place)})["margin"] == pytest.approx(0, abs=1e-6)
    assert abs(grid.at(grid.start | {"coherence": 1 - 0.9 * (1 - place)})["margin"]) > 0.01, "control"


@pytest.mark.parametrize(("key", "sign"), [("coherence", 1), ("play_nm", -1)])
def test_where_both_surfaces_follow_closer_they_are_smoother_than_those_of_full_contact(key, sign):
    found = roughness.curve_or_map([point(0.1 * k, water=FULL) for k in (1, 2, 3, 4, 5, 6, 7, 4.5)], "G", key)
    for flag, value in zip(found.flagged.sel(humidity=0.6).values, found["roughness"].values, strict=True):
        assert (requirement.SMOOTHER.kind in flag) == (sign * (value - 0.45) > 0)


def test_curves_of_a_map_at_which_both_surfaces_follow_closer_are_smoother_as_well():
    def at(coherence, rms):
        """Point over rms and coherence."""
        return point(rms, water=FULL).assign(other=coherence, other_given=0.5)

    grid = [at(coherence, rms) for coherence in (0.5, 0.2, 0.9) for rms in RANGE8]
    flags = roughness.curve_or_map(grid, "G", "rms_nm", "coherence").flagged.sel(humidity=0.6)
    for coherence, smoother in ((0.2, False), (0.5, False), (0.9, True)):
        assert bool(flags.sel(other=coherence)[-1].item()) is smoother, "rougher than given"


def test_a_coherence_without_a_replica_and_one_that_surfaces_cannot_have_are_refused():
    independent = study()
    del independent["pairs"]["r"]["replica"]
    with pytest.raises(ConfigError, match="must be left out, because pair r has no replica; state replica: "):
        stiction.load(independent)
    skewed = study() | {"surfaces": {"G": LIKE_B2 | {"skewness": -0.76, "kurtosis": 3.9}}}
    results = Results.of(stiction.load(skewed))
    assert results["devices/roughness/points/S_0"].stuck.notnull().all(), "control"
    with pytest.raises(ValueError, match="a full replica has the opposite skewness"):
        results[f"devices/roughness/points/S_{POINTS - 2}"]
