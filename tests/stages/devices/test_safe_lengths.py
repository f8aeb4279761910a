from dataclasses import replace

import numpy as np
import pytest
from ground import C1, R1, SURFACES, lognormal_cracks, safe_with_tips, safe_without_tips, wanted
from numpy.testing import assert_allclose, assert_array_equal

from stiction.beam.energy import apparent_adhesion_energy
from stiction.contact.environment import Water
from stiction.devices import arcs, risk
from stiction.stages.devices import cracks, safe_lengths
from stiction.stages.devices.opening import EITHER, MIDDLE, S_SHAPE
from stiction.streams import stream


def energies(mean, number=400):
    return mean * np.exp(0.4 * np.random.default_rng(9).standard_normal(number))


@pytest.fixture(scope="module")
def cantilever():
    """Safe lengths of cantilevers whose tips hold at about the lengths of their cracks."""
    return safe_with_tips(energies(2e-3))


def test_shares_are_those_of_the_sticking_lengths(cantilever):
    dataset = lognormal_cracks()
    alone = cracks.lengths(dataset) + 2 * float(dataset.foundation_length)
    either = np.minimum(alone, arcs.arc_length(energies(2e-3), C1.beam))
    for shape, lengths in ((S_SHAPE, alone), (EITHER, either)):
        one = cantilever.sel(shape=shape)
        stuck, low, high = risk.stuck_share(one.length.values, lengths)
        assert_array_equal(one.stuck, stuck)
        assert_array_equal(one.stuck_band, [low, high])
    assert np.any(cantilever.stuck[1] > cantilever.stuck[0])
    assert cantilever.stuck.values[:, 0].tolist() == [0, 0]
    assert cantilever.stuck.values[:, -1].tolist() == [1, 1]


def test_safe_lengths_are_those_of_the_sticking_lengths_with_their_basis_and_error(cantilever):
    dataset = lognormal_cracks()
    lengths = cracks.lengths(dataset) + 2 * float(dataset.foundation_length)
    for share in (1e-2, 1e-3):
        expected = risk.safe_length(lengths, share, stream(2021, "safe length"))
        one = cantilever.sel(shape=S_SHAPE, share=share)
        stated = one.estimate, one.beams_error
        assert_allclose(list(map(float, stated)), [expected.estimate, expected.error], rtol=1e-12)
        assert one.safe_length < expected.length
        assert str(one.basis.values) == expected.basis


def on_other_samples(lengths):
    """Lengths one standard error of each principal direction off, both ways, by hand."""
    variances, directions = np.linalg.eigh(SURFACES.covariance)
    for step in (np.sqrt(variances) * directions).T:
        yield [lengths * np.exp(s * step[0] - np.log(SURFACES.length / lengths) * s * step[1]) for s in (1, -1)]


def test_the_error_of_the_surfaces_is_that_of_the_estimate_from_lengths_on_other_samples(cantilever):
    dataset = lognormal_cracks()
    found, hold = cracks.lengths(dataset), 2 * float(dataset.foundation_length)
    for k, share in enumerate((1e-2, 1e-3)):
        ends = [
            [risk.safe_length(end + hold, share, stream(2021, "safe length")).estimate for end in both]
            for both in on_other_samples(found)
        ]
        expected = np.hypot(*(np.subtract(*both) / 2 for both in ends))
        assert_allclose(cantilever.surfaces_error[0, k], expected, rtol=1e-9)


def test_bounds_allow_for_the_error_of_the_surfaces_and_are_those_of_the_beams_without_it(cantilever):
    exact = replace(SURFACES, covariance=np.zeros((2, 2)))
    alone = safe_with_tips(energies(2e-3), surfaces=exact).sel(shape=S_SHAPE)
    assert np.all(np.isnan(alone.surfaces_error))
    both = cantilever.sel(shape=S_SHAPE)
    assert_array_equal(both.estimate, alone.estimate)
    own, whole = (np.log(one.estimate / one.safe_length) for one in (alone, both))
    surfaces = np.sqrt(whole**2 - own**2) / 1.645  # from the error of the bound, close to that of the estimate
    assert_allclose(surfaces, both.surfaces_error / both.estimate, rtol=0.15)


def test_tips_that_hardly_adhere_hold_no_beam_and_strong_ones_hold_all():
    weak, strong = safe_with_tips(energies(1e-6)), safe_with_tips(energies(1.0))
    assert_array_equal(weak.stuck.sel(shape=EITHER), weak.stuck.sel(shape=S_SHAPE))
    tips = arcs.arc_length(energies(1.0), C1.beam)
    expected = risk.safe_length(tips, 1e-2, stream(2021, "safe length"))
    assert_allclose(float(strong.safe_length.sel(shape=EITHER, share=1e-2)), expected.length, rtol=1e-12)
    assert np.all(np.isnan(strong.surfaces_error.sel(shape=EITHER)))  # the samples of strips do not matter


def test_a_bridge_sticks_if_it_is_longer_than_the_shortest_that_its_middle_holds():
    found = safe_without_tips()
    assert list(found["shape"]) == [MIDDLE]
    lengths = cracks.lengths(lognormal_cracks(R1))
    assert_array_equal(found.stuck[0], risk.stuck_share(found.length.values, lengths)[0])


def test_the_axis_of_lengths_is_finite_although_some_beams_never_stick():
    dataset = lognormal_cracks(R1)
    dataset["held_length"][:20] = np.inf
    found = safe_lengths.compute(dataset, wanted(R1))
    assert np.isfinite(found.length).all()
    assert float(found.stuck[0, -1]) == pytest.approx(0.95)


def test_limits_of_the_model_are_stated(cantilever):
    assert float(cantilever.film) == pytest.approx(2 * 0.072 * 1.8e-5 / (8.314462618 * 300 * -np.log(0.67)))


def test_lengths_in_saturated_air_are_those_of_flooded_flats(cantilever):
    alone, tip = cantilever.flooded_length.values
    energy = 2 * 0.072  # tension times two perfectly wetting sides [J/m²]
    assert_allclose(apparent_adhesion_energy(alone, C1.beam), energy, rtol=1e-9)
    assert_allclose(tip, arcs.arc_length(energy, C1.beam), rtol=1e-9)
    assert safe_without_tips().flooded_length.shape == (1,)


def test_contact_angles_reduce_the_film():
    tilted = replace(wanted(R1), water=Water(300.0, (np.radians(60), 0.0)))
    found = safe_lengths.compute(lognormal_cracks(R1), tilted)
    assert_allclose(float(found.film / safe_without_tips().film), 0.75, rtol=1e-12)


def of_length(device, length, dataset=None):
    """Dataset of devices of a length [m], without one for ``None``."""
    dataset = lognormal_cracks(device) if dataset is None else dataset
    return safe_lengths.compute(dataset, replace(wanted(device), length=length))


@pytest.mark.parametrize("device", [C1, R1], ids=["cantilever", "bridge"])
def test_the_share_at_the_length_of_a_device_is_that_of_the_curve(device):
    for number in (40, 150, 260):
        curve = of_length(device, None)
        length = float(curve.length[number])
        found = of_length(device, length)
        assert_array_equal(found.stuck_at_length.sel(end="estimate"), curve.stuck[:, number])
        assert_array_equal(found.stuck_at_length.sel(end=["low", "high"]), curve.stuck_band[:, :, number])
        assert float(found.length_of_device) == length
        assert_array_equal(found.safe_length, curve.safe_length)
    assert "stuck_at_length" not in curve


def test_short_devices_come_free_and_long_ones_stick_whatever_the_axis():
    short, long = (of_length(R1, length).stuck_at_length[0] for length in (1e-6, 1.0))
    assert_allclose(short, [0, 0, 1 - 0.025 ** (1 / 400)], rtol=1e-12)
    assert_allclose(long, [1, 0.025 ** (1 / 400), 1], rtol=1e-12)


def test_devices_longer_than_those_simulated_may_all_stick():
    cracks_of_r1, reach = lognormal_cracks(R1), 690e-6
    beyond = np.where(cracks_of_r1.held_length > reach, np.inf, cracks_of_r1.held_length)
    cut = cracks_of_r1.assign(held_length=("device", beyond) if beyond.ndim == 1 else cracks_of_r1.held_length)
    stuck, low, high = of_length(R1, 800e-6, cut.assign(reach=reach)).stuck_at_length.values[0]
    assert 0.2 < stuck < 0.5
    assert low < stuck
    assert high == 1
    inside = of_length(R1, 680e-6, cut.assign(reach=reach)).stuck_at_length.values[0]
    assert inside[2] < 0.5


def test_the_error_of_a_share_is_that_of_the_share_of_lengths_on_other_samples():
    lengths = cracks.lengths(lognormal_cracks(R1))
    ends = [[np.mean(end < 700e-6) for end in both] for both in on_other_samples(lengths)]
    found = of_length(R1, 700e-6)
    assert_allclose(found.stuck_surfaces_error, np.hypot(*(np.subtract(*both) / 2 for both in ends)), rtol=1e-9)
