from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from ground import C1, R1, RMS, VECTORS, computed, settings
from numpy.testing import assert_allclose, assert_array_equal

from stiction.beam.foundation import foundation_length
from stiction.beam.montecarlo import Experiment, columns, simulate
from stiction.beam.release import EndState
from stiction.chaos.model import draw_laws, fit
from stiction.contact import forcelaw
from stiction.devices import bridges
from stiction.devices.sampling import sampled_surfaces
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
