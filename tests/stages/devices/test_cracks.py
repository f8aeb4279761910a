from dataclasses import replace
from functools import partial

import numpy as np
import pytest
import xarray as xr
from ground import C1, R1, RMS, VECTORS, computed, ground_dataset, settings
from numpy.testing import assert_allclose, assert_array_equal

import stiction
from stiction.beam.foundation import foundation_length
from stiction.beam.montecarlo import Experiment, columns, simulate
from stiction.beam.release import EndState
from stiction.chaos.model import draw_laws, fit
from stiction.contact import forcelaw
from stiction.devices import bridges
from stiction.devices.sampling import sampled_surfaces
from stiction.plan.cost import PER_JOB, job_cost
from stiction.plan.devices import MANY
from stiction.plan.graph import Results
from stiction.stages.devices import cracks, opening
from stiction.streams import stream


@pytest.fixture(scope="module")
def found():
    return computed(settings(beams=12), VECTORS)


def test_cracks_are_those_of_long_beams_on_laws_of_the_chaos_model(found):
    model = fit(VECTORS, 1.2 * VECTORS[:, 1].max(), 6, 0.001)
    address = partial(stream, 2021, "devices", "b")
    laws = draw_laws(model, opening.LAWS, address("mesh"))
    beam, points = opening.long_beam(C1, laws)
    released = columns(list(simulate(Experiment(beam, points, partial(draw_laws, model)), range(12), address)))
    assert np.all(released["state"] == EndState.S_SHAPE)
    assert_array_equal(found.crack_length, released["crack_length"])
    assert_allclose(float(found.foundation_length), foundation_length(beam, laws), rtol=1e-12)
    assert_allclose(float(found.mean_energy), forcelaw.energy(laws).mean(), rtol=1e-12)


@pytest.mark.parametrize("device", [C1, R1], ids=["cantilever", "bridge"])
def test_the_errors_of_the_surfaces_are_those_of_the_lawful_samples(device):
    limit = 1.2 * VECTORS[:, 1].max()
    unlawful = np.concatenate([VECTORS, [[1e-9, *VECTORS[0, 1:]]]])
    found = cracks.beams_of(computed(settings(device, beams=2), unlawful), device, None).surfaces
    laws, opens = forcelaw.coefficients(VECTORS, limit), device.opening
    expected = sampled_surfaces(laws, opens.contribution, partial(opens.length_on_mean, beam=device.beam), found.length)
    assert_array_equal(found.covariance, expected.covariance)
    mean = opens.length_on_mean(opens.contribution(laws), device.beam)
    assert_allclose(found.length, mean, rtol=1e-12 if device is C1 else 0.1)  # least bridges are shorter than held ones


def test_bridges_are_those_that_their_middle_holds_on_laws_of_the_chaos_model():
    found = computed(settings(R1, beams=6), VECTORS)
    model = fit(VECTORS, 1.2 * VECTORS[:, 1].max(), 6, 0.001)
    address = partial(stream, 2021, "devices", "b")
    zone, strips = bridges.middle_zone(R1.beam, R1.strip, draw_laws(model, opening.LAWS, address("mesh")))
    held = [bridges.held_length(zone, draw_laws(model, strips, address(k))) for k in range(6)]
    assert_array_equal(found.held_length, held)
    assert_array_equal(cracks.lengths(found), held)
    assert "crack_length" not in found
    free = computed(settings(replace(R1, residual_stress=0.0), beams=6), VECTORS)
    assert np.all(found.held_length.values > free.held_length.values)


def test_a_dataset_keeps_all_lengths(found):
    beams = cracks.beams_of(found, C1, None)
    assert beams.arrested.shape == (12,)
    assert beams.foundation == float(found.foundation_length)
    assert_allclose(float(found.rms), RMS, rtol=1e-3)
    assert float(found.beam_length) > beams.arrested.max()
    assert round(float(found.element_length) / 1.5e-6, 9) in (4, 5)


# Many sizes on one ground


def many(number, **more):
    """Graph of cantilevers of as many thicknesses, with few samples."""
    beam = {"kind": "cantilever", "pair": "b", "gap_um": 20, "width_um": 30, "humidities": [0.67]}
    devices = {f"D{k}": beam | {"thickness_um": round(2 + 0.1 * k, 3)} for k in range(number)}
    few = {"contact": {"samples": 200, "model": "summits"}, "chaos": {"order": 3}, "design": {"beams": 200}}
    return Results.of(stiction.load({"run": {"pairs": [], "studies": []}, "devices": devices}, few, more))


def test_from_many_devices_on_a_ground_on_their_lengths_follow_those_of_three_sizes():
    bridge = {"kind": "bridge", "pair": "b", "thickness_um": 2, "gap_um": 2, "width_um": 30, "humidities": [0.67]}
    bridge |= {"residual_stress_MPa": 50}
    own, other = ({"devices": {"B": bridge | {"width_um": width}}} for width in (30, 20))
    for number, more, is_by_sizes in ((MANY, own, True), (MANY - 1, other, False)):
        graph = many(number, **more).graph
        job = graph.job("devices/cracks/D3_rh067")
        assert ("of_sizes" in job.inputs) == job.settings.get("by_sizes", False) == is_by_sizes
        assert "of_sizes" not in graph.job("devices/cracks/B_rh067").inputs
        if is_by_sizes:
            of_sizes = graph.job(job.inputs["of_sizes"]).settings
            assert (of_sizes["gaps_um"], of_sizes["thicknesses_um"]) == ([20], [2.0, 2.792848, 3.9])
            assert job_cost(job.settings, {}) < 2 * PER_JOB < job_cost(of_sizes, {})


@pytest.mark.slow
def test_lengths_of_many_sizes_are_those_by_finite_elements():
    results = many(MANY, design={"beams": 600})
    job = results.graph.job("devices/cracks/D7_rh067")
    data, wanted = results.inputs(job), job.stage.converted(job.settings)
    found, own = cracks.compute(data["ground"], wanted, data["of_sizes"]), cracks.compute(data["ground"], wanted)
    error, excess = float(found.size_error), float(data["of_sizes"].excess)
    assert 0 <= excess <= error < 0.02
    assert float(own.size_error) == 0
    by_laws, by_elements = (np.log(np.sort(one.crack_length)) for one in (found, own))
    other = cracks.compute(data["ground"], replace(wanted, device=replace(wanted.device, thickness=3.2e-6)))
    of_other, again = (
        np.log(np.sort(other.crack_length)),
        np.sort(np.random.default_rng(1).choice(by_elements, (200, 600))),
    )
    for shortest in (600, 30):
        scatter = again[:, :shortest].mean(axis=1).std()  # of beams of one size, more than with common random numbers
        deviations = [(one - by_elements)[:shortest].mean() for one in (by_laws, of_other)]
        assert abs(deviations[0] + excess) < error + 2 * scatter
        assert abs(deviations[1]) > error + 2 * scatter  # control
    for name in ("uniform_length", "surfaces_covariance", "foundation_length", "beam_length", "reach"):
        assert_array_equal(found[name], own[name])


def test_a_device_is_simulated_where_the_power_laws_do_not_hold():
    wanted = settings(beams=12)
    laws = xr.Dataset({"powers": (("of", "device"), np.full((3, 12), np.nan)), "error": 0.03, "excess": 0.0})
    found = cracks.compute(ground_dataset(C1), replace(wanted, by_sizes=True), laws)
    xr.testing.assert_identical(found, computed(wanted, VECTORS))
