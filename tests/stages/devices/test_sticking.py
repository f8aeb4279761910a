from dataclasses import replace

import numpy as np
import pytest
from ground import C1, R1, VECTORS, WATER, flats, ground_dataset, settings, wanted
from numpy.testing import assert_allclose, assert_array_equal
from scipy.special import ndtr

from stiction.beam.energy import apparent_adhesion_energy
from stiction.constants import HAMAKER_CONSTANT
from stiction.contact import forcelaw
from stiction.contact.environment import Gaps, Water, flooded_parts, force_curves
from stiction.contact.gaps import work_across_film
from stiction.contact.tilt import Tilt
from stiction.contact.vanderwaals import DugdaleAttraction
from stiction.devices import risk
from stiction.devices.arcs import arc_length, flat_force, flat_length
from stiction.devices.bridges import least_length
from stiction.devices.risk import LengthBounds
from stiction.stages.devices import ground, opening, sticking
from stiction.stages.devices.opening import EITHER, MIDDLE, S_SHAPE
from stiction.streams import stream


def test_beams_without_a_crack_stick_at_no_known_length():
    found = sticking.sticking_lengths(np.array([7e-4, np.inf]), 3e-6, C1, np.array([1e-3, 1e-3]))
    assert_array_equal(found[S_SHAPE], [7e-4 + 6e-6, np.inf])
    assert_array_equal(found[EITHER], [7e-4 + 6e-6, 1e-3])


def test_a_bridge_is_held_by_its_middle_and_has_no_tip():
    found = sticking.sticking_lengths(np.array([2e-4, 2.1e-4]), 3e-6, R1, None)
    assert list(found) == [MIDDLE]
    assert_array_equal(found[MIDDLE], [2e-4, 2.1e-4])


def flooded_lengths(device, water=WATER, humidity=0.67, edge_radius=0.0):
    return sticking.flooded_lengths(device, water, humidity, edge_radius)


def test_lengths_of_flats_are_those_of_their_water_and_their_solids_by_shape():
    energy = 0.072 * (1 + np.cos(1.0)) + DugdaleAttraction(1e-19).work_of_adhesion
    alone, tip = flooded_lengths(replace(C1, hamaker_constant=1e-19), Water(300.0, (1.0, 0.0)))
    assert_allclose(apparent_adhesion_energy(alone, C1.beam), energy, rtol=1e-9)
    assert_allclose(tip, arc_length(energy, C1.beam), rtol=1e-9)


def test_the_edge_of_the_tip_shortens_the_arc_of_flats_alone():
    sharp, round_edge = flooded_lengths(C1), flooded_lengths(C1, edge_radius=0.1e-6)
    assert round_edge[0] == sharp[0]
    parts = flooded_parts(0.67, WATER.at(0.67), C1.hamaker_constant)
    assert_allclose(round_edge[1], flat_length(parts, 0.1e-6, C1.beam), rtol=1e-12)
    assert round_edge[1] < 0.95 * sharp[1]


@pytest.mark.parametrize("humidity", [0.0, 0.44, 0.92])
@pytest.mark.parametrize("radius", [0.02e-6, 0.1e-6, 2e-6])
def test_no_smooth_tip_in_water_and_across_gaps_is_held_harder_than_its_bound(humidity, radius):
    air = Water(300.0, gaps=Gaps(HAMAKER_CONSTANT, "water", 100e-9)).at(humidity)
    height, tension = air.film(humidity)
    gap = np.concatenate([[0], np.geomspace(1e-13, 2e-6, 4000)])
    solids = work_across_film(gap, height, air.gaps.through(air.gaps.summits), air.gaps.through("dry"))
    middle, pulls = (gap[1:] + gap[:-1]) / 2, -np.diff(solids) / np.diff(gap)
    for slope in (0.03, 0.15, 0.4):
        tilt = Tilt((slope,), gap[-1] / 2, radius=radius)
        steps = np.geomspace(1e-14, 1, 100_000)  # from the line that touches, on both sides
        along = -radius * slope + np.concatenate([-(tilt.before - radius * slope) * steps[::-1], [0], 1e-6 * steps])
        drop = tilt.drop(slope, along)
        force = np.trapezoid(np.interp(drop, middle, pulls) + tension * (drop < height), along)
        bound = flat_force(np.array([slope]), flooded_parts(humidity, air, 0.0), radius).item()
        assert 0.4 * bound < force < bound


def test_adsorbed_films_shorten_the_lengths_of_flooded_flats_by_their_work():
    wet = Water(300.0, adsorbed=0.5e-9)
    for humidity in (0.44, 0.9):
        energy = 2 * 0.072 + wet.film(humidity)[1] * 0.5e-9
        alone, tip = flooded_lengths(replace(C1, hamaker_constant=0.0), wet, humidity)
        assert_allclose(apparent_adhesion_energy(alone, C1.beam), energy, rtol=1e-9)
        assert_allclose(tip, arc_length(energy, C1.beam), rtol=1e-9)
        flat = replace(R1, hamaker_constant=0.0)
        assert flooded_lengths(flat, wet, humidity) < flooded_lengths(flat, WATER, humidity)


@pytest.mark.parametrize("humidity", [0.0, 0.44, 0.92])
def test_flat_patches_stick_no_harder_than_flats_in_contact(humidity):
    air, bearing = Water(300.0, gaps=Gaps(HAMAKER_CONSTANT, "water", 100e-9)).at(humidity), np.array([[1.0, 0.0]])
    most = force_curves(np.zeros((1, 2)), bearing, (0.0, -2e-11), 5e-11, humidity, air).flat
    alone, _ = flooded_lengths(C1, air, humidity)
    assert apparent_adhesion_energy(alone, C1.beam) >= (1 - 1e-9) * most[0]


def test_the_bound_of_a_bridge_is_that_of_flooded_flats_in_contact_at_its_humidity():
    tension = 8.314462618 * 300 * -np.log(0.67) / 1.8e-5
    (water,) = flooded_lengths(replace(R1, hamaker_constant=0.0))
    assert_allclose(water, least_length(2 * 0.072, tension, R1.beam), rtol=1e-9)
    dry, wet = (flooded_lengths(R1, WATER, humidity)[0] for humidity in (0.3, 0.99))
    assert dry < wet < water  # solids in contact pull as well, and drier water harder


def test_no_safe_length_of_a_bridge_is_below_its_bound_and_a_tip_has_none():
    bound = sticking.lengths_without_samples(*flats(wanted(R1)), np.inf)[MIDDLE].safe
    scattered = bound * np.exp(0.3 + 0.1 * np.random.default_rng(3).standard_normal(200))
    asked = replace(wanted(), shares=(1e-2, 1e-4))
    free, held = (sticking.safe_lengths(scattered, asked, LengthBounds(safe=least)) for least in (0.0, bound))
    assert free[1].length < bound
    assert [one.length for one in held] == [max(one.length, bound) for one in free]
    assert [one.estimate for one in held] == [one.estimate for one in free]
    assert [one.safe for one in sticking.lengths_without_samples(*flats(wanted()), np.inf).values()] == [0, 0]


def test_there_is_one_safe_length_for_every_share():
    lengths = 7e-4 * np.exp(0.02 * np.random.default_rng(3).standard_normal(400))
    shares = (1e-2, 1e-3, 1e-4)
    found = sticking.safe_lengths(lengths, replace(wanted(), shares=shares))
    expected = [risk.safe_length(lengths, share, stream(2021, "safe length")) for share in shares]
    assert repr(found) == repr(expected)  # an unknown error is NaN, which differs from itself


# Strips that are not independent draws from a chaos model


def with_rare_strips(vectors):
    """Vectors of which a few hold many times the energy of the others, in the same distances."""
    rare = vectors[:2].copy()
    rare[:, :2] *= 40
    return np.concatenate([vectors[2:], rare])


def test_beams_draw_from_the_samples_where_the_chaos_model_lacks_rare_strips():
    usual, rare = ground_dataset(), ground_dataset(vectors=with_rare_strips(VECTORS))
    assert int(usual.resampled) == 0
    assert int(rare.resampled) == rare.sizes["sample"] == len(VECTORS)
    model, samples = (ground.ground_from(one, settings()).strips for one in (usual, rare))
    drawn = model.draw(300, stream(1))
    assert not set(drawn[:, 0]) & set(model.sampled[:, 0])
    assert set(samples.draw(300, stream(1))[:, 0]) <= set(samples.sampled[:, 0])


def test_rare_strips_stop_cracks_that_the_chaos_model_lets_pass():
    found = ground.ground_from(ground_dataset(vectors=with_rare_strips(VECTORS)), settings())
    model = replace(found, strips=replace(found.strips, is_narrow=False))
    lengths, without = (sticking.release_beams(C1, of, settings(beams=100)).arrested for of in (found, model))
    assert np.quantile(lengths, 0.1) < 0.9 * np.quantile(without, 0.1)


@pytest.mark.parametrize(("corner", "repeats"), [(12e6, False), (6e6, False), (2.0e6, True), (1.0e6, True)])
def test_strips_in_a_row_repeat_laws_where_their_mean_heights_are_correlated(corner, repeats):
    dataset = ground_dataset(corner=corner)
    assert (float(dataset.repetition) > 0) == repeats
    laws = ground.ground_from(dataset, settings()).strips.in_row(C1)(4000, stream(2))
    fresh = len(np.unique(laws[:, 0])) / 4000
    assert fresh == pytest.approx(1 - float(dataset.repetition), abs=4 * 0.5 * 4000**-0.5)


def correlated(laws, rho):
    """Draw of laws whose normal scores of the energy are an autoregressive process, with this correlation."""
    ordered = laws[np.argsort(forcelaw.energy(laws))]

    def draw(number, rng):
        scores = rng.standard_normal(number)
        for k in range(1, number):
            scores[k] = rho * scores[k - 1] + (1 - rho**2) ** 0.5 * scores[k]
        return ordered[np.minimum((ndtr(scores) * len(laws)).astype(int), len(laws) - 1)]

    return draw


@pytest.mark.slow
@pytest.mark.parametrize("rho", [0.3, 0.45])
def test_lengths_on_strips_that_repeat_laws_are_at_most_those_on_correlated_strips(rho):
    """Correlation of neighbours up to that of their distances, where heights are correlated over 5.5 strips."""
    found, asked = ground.ground_from(ground_dataset(corner=1.0e6), settings()), settings(beams=300)

    def short(draw):
        """Length of P(stuck) = 0.1."""
        part = opening.ground_of(C1, found.laws)
        return np.quantile(opening.arrests(C1, part, draw, asked.beams, opening.addresses(asked)), 0.1)

    repeated, real, free = map(short, (found.strips.in_row(C1), correlated(found.laws, rho), correlated(found.laws, 0)))
    assert repeated < 1.005 * real
    assert repeated < 0.98 * free
