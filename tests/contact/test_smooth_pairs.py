"""Forces on summits of smooth pairs in humid air: the table, full elastic contact beside it, and who is warned."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from stiction.analysis.model_error import mean_ratios
from stiction.config.files import load
from stiction.config.units import in_si
from stiction.contact.full.smooth_pairs import (
    ERRORS,
    HUMIDITIES,
    RATIOS,
    RMS,
    in_wetter_air,
    largest_shortfall,
    shortfall,
)
from stiction.devices.limits import rules as limits
from stiction.plan.graph import Graph, Results
from stiction.plan.plan import Plan
from stiction.report.limits.words import not_modelled, text
from stiction.stages.contact import full_contact
from stiction.stages.surfaces.rough_surfaces import sides_of

NM = 1e-9


def test_the_table_is_met_at_its_points_and_never_left_between_them():
    for k, humidity in enumerate(HUMIDITIES):
        for i, rms in enumerate(RMS):
            short, error = shortfall(rms, humidity)
            assert_allclose(short, max(1 - 1 / RATIOS[k, i], 0))
            assert_allclose(error, ERRORS[k, i] / RATIOS[k, i] ** 2)
    rng = np.random.default_rng(1)
    drawn = [shortfall(rng.uniform(0.1, 8) * NM, rng.uniform(0.3, 0.999))[0] for _ in range(500)]
    assert min(drawn) >= 0
    assert max(drawn) < largest_shortfall()
    assert max(drawn) > 0.6 * largest_shortfall(), "control"


def test_rough_pairs_lack_nothing_and_smooth_ones_more_in_wetter_air():
    assert all(shortfall(6e-9, humidity)[0] < 0.02 for humidity in HUMIDITIES)
    for rms in RMS[:3]:
        assert np.all(np.diff([shortfall(rms, humidity)[0] for humidity in HUMIDITIES]) > 0)


def test_in_wetter_air_a_ratio_follows_its_pair_and_never_falls():
    for pair in RATIOS.T[1:3]:
        assert_allclose([in_wetter_air(pair[0], 0.67, humidity) for humidity in (0.67, 0.9)], pair[:2])
    rng = np.random.default_rng(2)
    for _ in range(200):
        ratio, computed = rng.uniform(0.3, 2), rng.uniform(0.1, 0.9)
        found = [in_wetter_air(ratio, computed, humidity) for humidity in np.linspace(computed, 0.99, 30)]
        assert_allclose(found[0], ratio)
        assert np.all(np.diff(found) > -1e-12)
        assert (found[-1] > 1) == (ratio > 1)
    assert in_wetter_air(0.8, 0.5, 1.0) == 1


def of_strips(rms_nm, humidity, strips):
    """Ratio of the mean largest attractions, full contact over summits, of strips of 1.5 x 4 µm and its error [-]."""
    config = {
        "seed": 5,
        "run": {"pairs": ["p"], "studies": ["full_contact"]},
        "surfaces": {"P": {"like": "B2", "rms_nm": rms_nm}},
        "pairs": {"p": {"beam": "P", "substrate": "Sub1", "gap_um": 2, "humidities": [humidity]}},
        "attraction": {"reach": "all"},
        "beam": {"width_um": 4},
    }
    results = Results.of(load(config))
    job = results.graph.job("studies/full_contact/across/p")
    settings = replace(in_si(full_contact.Settings, job.settings), strips=strips)
    study = full_contact.compute(sides_of(results.inputs(job)), "p", settings)
    at, *models = full_contact.pull_offs(study)
    (ratio,), (error,) = mean_ratios(*models, at, at)
    return ratio, error


@pytest.mark.slow
@pytest.mark.parametrize(("rms_nm", "humidity"), [(1.0, 0.9), (1.7, 0.97), (3.4, 0.9)])
def test_full_elastic_contact_of_other_strips_has_the_forces_of_the_table(rms_nm, humidity):
    ratio, error = of_strips(rms_nm, humidity, strips=4)
    row, column = HUMIDITIES.tolist().index(humidity), int(np.argmin(abs(np.hypot(rms_nm, 0.17) * NM - RMS)))
    # Errors of four strips are known to 40 %.
    assert abs(ratio - RATIOS[row, column]) < 4 * np.hypot(1.4 * error, ERRORS[row, column])
    assert (ratio > 1.2) == (rms_nm == 1.0), "control: rougher pairs lack less"


@pytest.mark.slow
def test_strips_of_a_pair_have_the_ratio_in_wetter_air_that_follows_from_drier():
    (drier, error), (wetter, own) = (of_strips(0.7, humidity, strips=4) for humidity in (0.7, 0.85))
    followed, allowed = in_wetter_air(drier, 0.7, 0.85), 3 * 1.4 * np.hypot(error, own)
    assert abs(followed - wetter) < allowed + 0.05 * wetter, "the table is known to 5 % between its points"
    assert wetter - drier > 0.05, "control: one that stays is too small"


STOPPER = {"kind": "stopper", "pair": "p", "contact_um": [3, 3], "restoring_force_uN": 20}
BEAM = {"kind": "cantilever", "pair": "p", "thickness_um": 2.6, "gap_um": 2, "width_um": 30}
DIMPLES = {"number": 2, "at_um": [50], "height_um": 1, "contact_um": [1, 1]}


def on_summits(devices, **config):
    """Humidities at which warnings would count summits alone, by device, from the settings of their jobs."""
    pair = {"beam": "B2", "substrate": "Sub1", "gap_um": 2, "humidities": [0.4, 0.98]}
    graph = Graph(Plan(load({"run": {"pairs": []}, "pairs": {"p": pair}, "devices": devices} | config)))
    settings = {name: graph.job(f"devices/warnings/{name}.json").settings for name in devices}
    return {name: list(of.get("stopper", of.get("beam")).get("on_summits", ())) for name, of in settings.items()}


def test_forces_on_summits_in_humid_air_are_checked_and_no_others():
    devices = {
        "Bump": STOPPER | {"humidities": ["dry", 0.67, 0.9]},
        "Dry": STOPPER | {"humidities": ["dry"]},
        "Lever": BEAM | {"length_um": 100, "dimples": DIMPLES, "humidities": [0.67]},
        "Beam": BEAM | {"humidities": ["dry", 0.67]},
        "DryBeam": BEAM | {"humidities": ["dry"]},
    }
    found = {"Bump": [0.67, 0.9], "Dry": [], "Lever": [0.67], "Beam": [0.67], "DryBeam": []}
    assert on_summits(devices) == found
    one = {"Bump": STOPPER | {"humidities": [0.67]}}
    assert on_summits(one, contact={"model": "full"}) == {"Bump": []}
    coated = {"surfaces": {name: {"material": "FDTS"} for name in ("B2", "Sub1")}}
    assert on_summits(one, materials={"FDTS": {"contact_angle_deg": 110}}, **coated) == {"Bump": []}


def test_the_warning_has_the_number_of_the_table_and_forbids_to_rely_on_the_force():
    for rms, humidity in ((1.0 * NM, 0.9), (0.6 * NM, 0.7), (1.2 * NM, 0.95)):
        found = limits.smooth_pair(rms, [humidity])
        sentence = text(found)
        assert f" {100 * shortfall(rms, humidity)[0]:.0f} ± " in sentence
        assert found.forbids
    assert limits.smooth_pair(1.7 * NM, [0.9]) is None
    assert limits.smooth_pair(1.0 * NM, []) is None
    assert f"up to {100 * largest_shortfall():.2g} % too small" in not_modelled(["summits"])
