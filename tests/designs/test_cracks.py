from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from beams import uniform_laws
from ground import C1, R1, RMS, UM, VECTORS, computed, contact, settings
from numpy.testing import assert_allclose, assert_array_equal
from vectors import sampled_vectors

from stiction.beam.energy import arrest_length
from stiction.beam.foundation import ELEMENT, STRIP, foundation_length
from stiction.beam.montecarlo import Experiment, columns, simulate
from stiction.beam.release import EndState
from stiction.chaos.model import draw_laws, fit
from stiction.contact import forcelaw
from stiction.designs import cracks
from stiction.streams import stream


@pytest.fixture(scope="module")
def found():
    return computed(settings(beams=12), VECTORS)


def test_cracks_are_those_of_long_beams_on_laws_of_the_chaos_model(found):
    model = fit(VECTORS, 1.2 * VECTORS[:, 1].max(), 3, 0.001)
    address = partial(stream, 2021, "devices", "b")
    laws = draw_laws(model, cracks.LAWS, address("mesh"))
    beam, points = cracks.long_beam(C1, laws)
    released = columns(list(simulate(Experiment(beam, points, partial(draw_laws, model)), range(12), address)))
    assert np.all(released["state"] == EndState.S_SHAPE)
    assert_array_equal(found.crack_length, released["crack_length"])
    assert_allclose(float(found.foundation_length), foundation_length(beam, laws), rtol=1e-12)
    assert_allclose(float(found.mean_energy), forcelaw.energy(laws).mean(), rtol=1e-12)


def test_beams_that_are_not_s_shaped_have_no_crack():
    model = fit(VECTORS, 1.2 * VECTORS[:, 1].max(), 3, 0.001)
    address = partial(stream, 2021, "devices", "b")
    short = replace(C1.beam, length=450 * UM, elements=60)
    assert np.all(np.isinf(cracks.crack_lengths(model, short, 300, 3, address)))


def test_each_group_of_the_samples_is_fitted_alone_and_the_random_numbers_are_the_same(monkeypatch):
    fitted, models = [], []

    def recorded(vectors, limit, order, tolerance):
        fitted.append(vectors)
        models.append(fit(VECTORS, limit, order, tolerance))
        return models[-1]

    monkeypatch.setattr(cracks, "fit", recorded)
    dataset = computed(settings(beams=3), VECTORS, groups=4)
    whole, *parts = fitted
    assert_array_equal(whole, VECTORS)
    assert [len(part) for part in parts] == [100] * 4
    assert set(map(tuple, np.concatenate(parts))) == set(map(tuple, VECTORS))
    assert_array_equal(dataset.crack_length_of_group, np.tile(dataset.crack_length, (4, 1)))  # models are equal here


@pytest.mark.parametrize(("samples", "groups"), [(60, 2), (160, 3), (2000, 10)])
def test_a_group_has_fifty_samples_unless_there_are_few(monkeypatch, samples, groups):
    monkeypatch.setattr(cracks, "crack_lengths", lambda *_: np.ones(2))
    found = computed(settings(beams=2), sampled_vectors(samples, 0.24), groups=10)
    assert found.sizes["group"] == groups


def test_a_bridge_has_two_cracks_under_its_tension():
    found = computed(settings(R1, beams=4), VECTORS)
    assert found.sizes["crack"] == 8
    free = computed(settings(replace(R1, residual_stress=0.0), beams=4), VECTORS)
    assert np.all(found.crack_length.values > free.crack_length.values)
    assert R1.beam.tension == pytest.approx(50e6 * 60e-12)
    assert R1.cracks == 2 * C1.cracks


def test_devices_of_a_pair_share_their_random_numbers():
    thick = replace(C1, thickness=3 * UM)
    one, other = (cracks.addresses(settings(device))(5).random() for device in (C1, thick))
    assert one == other != cracks.addresses(settings(replace(C1, pair="c")))(5).random()


@pytest.mark.parametrize("thickness", [1.6, 2.6, 6.0])
@pytest.mark.parametrize("gap", [2, 20])
def test_long_beams_follow_the_mesh_rule_and_are_longer_than_their_cracks(thickness, gap):
    laws = uniform_laws(20)
    device = replace(C1, thickness=thickness * UM, gap=gap * UM)
    beam, points = cracks.long_beam(device, laws)
    foundation = foundation_length(beam, laws)
    assert beam.element_length <= ELEMENT * foundation
    assert beam.length / points == pytest.approx(1.5 * UM, rel=1e-12)
    assert beam.length / points <= STRIP * foundation
    assert points % beam.elements == 0
    assert points // beam.elements <= cracks.PER_ELEMENT
    assert 1.3 <= beam.length / arrest_length(float(forcelaw.energy(laws[0])), beam) < 1.3 + 90 * UM / beam.length * 1.5


def test_a_beam_that_its_strips_do_not_resolve_is_refused_with_the_key_that_helps():
    with pytest.raises(ValueError, match="strips of 1.5 µm do not resolve") as refused:
        cracks.long_beam(replace(C1, thickness=0.5 * UM), uniform_laws(20))
    assert "strip_um, here 1.5 µm" in refused.value.__notes__[0]


def test_the_rms_of_the_surfaces_is_in_their_bearing_area():
    assert_allclose(cracks.surface_rms(contact()), RMS, rtol=1e-3)


def test_a_dataset_keeps_all_lengths(found):
    whole, of_group, foundation = cracks.lengths(found)
    assert (whole.shape, of_group.shape) == ((12,), (2, 12))
    assert foundation == float(found.foundation_length)
    assert_allclose(float(found.rms), RMS, rtol=1e-3)
    assert float(found.beam_length) > whole.max()
    assert round(float(found.element_length) / 1.5e-6, 9) in (4, 5)
