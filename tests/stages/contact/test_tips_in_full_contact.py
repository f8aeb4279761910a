"""Tilted strips in full elastic contact beside the sum over summits, and the changes of tips that follow."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from stiction.config.files import load
from stiction.contact.asperity import HertzAsperity
from stiction.contact.full.elements import Adhesion
from stiction.contact.full.halfspace import HalfSpace
from stiction.contact.meniscus import film
from stiction.contact.tilt import Tilt, length_of_edge
from stiction.plan.graph import Results
from stiction.stages.contact import corrections, full_contact, pair_model_error, tips_in_full_contact
from stiction.stages.contact.tips_in_full_contact import TipsAtSlope
from stiction.stages.surfaces.rough_surfaces import sides_of

NM, UM = 1e-9, 1e-6
#: Beam on the surface of pair b with half of its rms, in dry air.
C1 = {"kind": "cantilever", "pair": "b", "thickness_um": 2, "gap_um": 2, "width_um": 8, "humidities": ["dry"]}
DRY = {
    "run": {"pairs": ["b"]},
    "surfaces": {"B2": {"rms_nm": 1.7}},
    "pairs": {"b": {"humidities": ["dry"]}},
    "devices": {"C1": C1},
    "design": {"beams": 200},
}


@cache
def results(strips=8):
    return Results.of(load(DRY | {"studies": {"full_contact": {"samples": strips}}}))


@cache
def job(name="studies/full_contact/tips/dry/b"):
    return results().graph.job(name)


@cache
def settings():
    return job().stage.converted(job().settings)


@cache
def few():
    return tips_in_full_contact.compute(sides_of(results().inputs(job())), "b", replace(settings(), strips=3))


def test_strips_have_the_width_the_slopes_and_the_edge_of_the_tips_and_their_number_grows_only_if_it_is_not_stated():
    assert settings().beam.width == pytest.approx(8 * UM)
    assert settings().tilt.radius == pytest.approx(0.1 * UM)
    assert len(settings().tilt.slopes) == 3
    assert (settings().strips, settings().most) == (8, 0)
    free = Results.of(load(DRY)).graph.job("studies/full_contact/tips/dry/b")
    assert free.settings["most"] == tips_in_full_contact.MOST


@pytest.mark.slow
def test_the_study_has_both_models_at_every_slope_and_a_sample_does_not_depend_on_the_others():
    assert few().sizes == {"strip": 3, "slope": 3, "humidity": 1}
    assert np.all(few().force > 0)
    assert np.all(few().summit_force > 0)
    alone = tips_in_full_contact.compute(sides_of(results().inputs(job())), "b", replace(settings(), strips=1))
    assert alone.equals(few().isel(strip=slice(1)))
    assert len(np.unique(few().summit_force)) == few().summit_force.size


def test_strips_are_drawn_until_the_accuracy_or_the_most(monkeypatch):
    for accuracy, number in ((0.0, 5), (np.inf, 3)):
        monkeypatch.setattr(tips_in_full_contact, "ACCURACY", accuracy)
        at = replace(settings(), strips=3, most=5, tilt=replace(settings().tilt, slopes=(0.05,)))
        assert tips_in_full_contact.compute(sides_of(results().inputs(job())), "b", at).sizes["strip"] == number


@pytest.mark.parametrize(("slope", "radius"), [(0.03, 0.1 * UM), (0.03, 1 * UM), (0.1, 0.1 * UM)])
def test_a_stiff_smooth_tip_on_a_peak_is_held_by_the_water_on_its_wedge_and_its_edge(slope, radius):
    """In both models: tension times the length above which the film is as high as the peak and the drop of the tip."""
    (height, tension), peak = film(0.9, 300.0), 4 * NM
    tilt = Tilt((slope,), 20 * NM, radius=radius)
    given = settings()
    own = replace(
        given,
        tilt=tilt,
        sampling=replace(given.sampling, strip_length=tilt.before + tilt.reach / slope),
        beam=replace(given.beam, width=2 * UM),
    )
    pair = tips_in_full_contact.surface_pair(sides_of(results().inputs(job())), "NG", own)
    pair = replace(pair, asperity=HertzAsperity(1e12))
    heights, row = np.zeros(pair.beam.grid.shape, np.float32), round(tilt.before / pair.spacing) + 1
    heights[row, ::5] = peak  # beside where the edge begins
    space = HalfSpace(heights.shape, pair.spacing, 1e12)
    water = replace(given.water, gaps=None)
    found = TipsAtSlope(pair, space, Adhesion(height, tension), water, 0.9).both_models(heights)
    filled = height - peak + pair.drop(slope, len(heights))[row]
    wet = filled / slope - slope * radius / 2 + length_of_edge(radius, filled, slope)
    assert_allclose(found, tension * wet, rtol=0.1)  # of whole rows of points
    assert min(found) > 1.15 * tension * filled / slope, "control: the edge holds as well"


def test_the_change_of_tips_is_that_of_the_study_and_reaches_every_tip():
    of_strips = full_contact.layout(np.random.default_rng(1).gamma(9, size=(8, 1, 9)), (0.0,), 10 * NM)
    error = pair_model_error.compute(of_strips, [0.0], [0.0], tips=few())
    full, summits = tips_in_full_contact.models(few())
    assert_allclose(error.tip_ratio, full.mean(axis=0) / summits.mean(axis=0))
    scatters = [np.sqrt(np.mean(np.log(np.mean(each**2, axis=0) / each.mean(axis=0) ** 2))) for each in (full, summits)]
    assert_allclose(error.tip_power, scatters[0] / scatters[1])
    given = corrections.applied(error)
    slopes = error.slope.values
    assert_allclose([one.ratio for one in given.of_tips(0.0, slopes)], error.tip_ratio[0])
    assert_allclose([one.ratio_error for one in given.of_tips(0.0, slopes)], error.tip_error[0])
    assert_array_equal([one.power for one in given.of_tips(0.0, slopes)], max(1, float(error.tip_power[0])))


@pytest.mark.nightly
def test_tips_between_the_slopes_and_of_wider_beams_hold_as_predicted():
    """Full contact of strips 30 µm wide at two slopes between those of the study, beside predictions of others."""
    wanted = [float(np.sqrt(a * b)) for a, b in zip(settings().tilt.slopes, settings().tilt.slopes[1:], strict=False)]
    changes = corrections.applied(results(30)["studies/model_error/dry/b"]).of_tips(0.0, wanted)
    surfaces = sides_of(results().inputs(job()))
    at = replace(
        settings(),
        seed=settings().seed + 1,
        strips=20,
        beam=replace(settings().beam, width=30 * UM),
        tilt=replace(settings().tilt, slopes=tuple(wanted)),
    )
    full, summits = (
        each[:, 0] for each in tips_in_full_contact.models(tips_in_full_contact.compute(surfaces, "b", at))
    )
    for k, change in enumerate(changes):
        ratio = full[:, k].mean() / summits[:, k].mean()
        error = np.std(full[:, k] - ratio * summits[:, k]) / np.sqrt(20) / summits[:, k].mean()
        assert abs(ratio - change.ratio) < 3 * np.hypot(error, change.ratio * change.ratio_error)
        assert change.at_most(0.95).ratio > ratio - error
