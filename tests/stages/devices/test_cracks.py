from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from ground import C1, R1, RMS, VECTORS, computed, settings
from numpy.testing import assert_allclose, assert_array_equal
from vectors import sampled_vectors

from stiction.beam.foundation import foundation_length
from stiction.beam.montecarlo import Experiment, columns, simulate
from stiction.beam.release import EndState
from stiction.chaos.model import draw_laws, fit
from stiction.contact import forcelaw
from stiction.devices import bridges
from stiction.stages.devices import cracks, opening
from stiction.streams import stream


@pytest.fixture(scope="module")
def found():
    return computed(settings(beams=12), VECTORS)


def test_cracks_are_those_of_long_beams_on_laws_of_the_chaos_model(found):
    model = fit(VECTORS, 1.2 * VECTORS[:, 1].max(), 3, 0.001)
    address = partial(stream, 2021, "devices", "b")
    laws = draw_laws(model, opening.LAWS, address("mesh"))
    beam, points = opening.long_beam(C1, laws)
    released = columns(list(simulate(Experiment(beam, points, partial(draw_laws, model)), range(12), address)))
    assert np.all(released["state"] == EndState.S_SHAPE)
    assert_array_equal(found.crack_length, released["crack_length"])
    assert_allclose(float(found.foundation_length), foundation_length(beam, laws), rtol=1e-12)
    assert_allclose(float(found.mean_energy), forcelaw.energy(laws).mean(), rtol=1e-12)


def test_each_group_of_the_samples_is_fitted_alone_and_the_random_numbers_are_the_same(monkeypatch):
    fitted, models = [], []

    def recorded(vectors, limit, order, tolerance):
        fitted.append(vectors)
        models.append(fit(VECTORS, limit, order, tolerance))
        return models[-1]

    monkeypatch.setattr(opening, "fit", recorded)
    dataset = computed(settings(beams=3), VECTORS, groups=4)
    whole, *parts = fitted
    assert_array_equal(whole, VECTORS)
    assert [len(part) for part in parts] == [100] * 4
    assert set(map(tuple, np.concatenate(parts))) == set(map(tuple, VECTORS))
    assert_array_equal(dataset.crack_length_of_group, np.tile(dataset.crack_length, (4, 1)))  # models are equal here


@pytest.mark.parametrize(("samples", "groups"), [(60, 2), (160, 3), pytest.param(2000, 10, marks=pytest.mark.slow)])
def test_a_group_has_fifty_samples_unless_there_are_few(monkeypatch, samples, groups):
    monkeypatch.setattr(cracks, "arrests", lambda *_: np.ones(2))
    found = computed(settings(beams=2), sampled_vectors(samples, 0.24), groups=10)
    assert found.sizes["group"] == groups


def test_bridges_are_those_that_their_middle_holds_on_laws_of_the_chaos_model():
    found = computed(settings(R1, beams=6), VECTORS)
    model = fit(VECTORS, 1.2 * VECTORS[:, 1].max(), 3, 0.001)
    address = partial(stream, 2021, "devices", "b")
    zone, strips = bridges.middle_zone(R1.beam, R1.strip, draw_laws(model, opening.LAWS, address("mesh")))
    held = [bridges.held_length(zone, draw_laws(model, strips, address(k))) for k in range(6)]
    assert_array_equal(found.held_length, held)
    assert_array_equal(cracks.lengths(found)[0], held)
    assert "crack_length" not in found
    free = computed(settings(replace(R1, residual_stress=0.0), beams=6), VECTORS)
    assert np.all(found.held_length.values > free.held_length.values)


def test_a_dataset_keeps_all_lengths(found):
    whole, of_group, foundation = cracks.lengths(found)
    assert (whole.shape, of_group.shape) == ((12,), (2, 12))
    assert foundation == float(found.foundation_length)
    assert_allclose(float(found.rms), RMS, rtol=1e-3)
    assert float(found.beam_length) > whole.max()
    assert round(float(found.element_length) / 1.5e-6, 9) in (4, 5)
