"""The middle of a bridge, against a second finite-element method that presses whole bridges down and releases them."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from beams import scattered_laws
from numpy.testing import assert_allclose, assert_array_equal
from scipy.linalg import solveh_banded

from stiction.beam.cantilever import Beam
from stiction.beam.energy import arrest_length
from stiction.beam.middle import outwards, shortest_held
from stiction.beam.release import crack_length, release
from stiction.contact import forcelaw

UM = 1e-6
STRESS = 50e6
#: Energy and largest attraction of pair b at RH 0.67.
DRY = 6.165e-3, 2.85e6


def zone(half=15, element=0.5, stress=STRESS, gap=2.0):
    number = 2 * round(half / element)
    tension = stress * 60e-12
    return Beam(number * element * UM, 30 * UM, 2 * UM, 164e9, gap * UM, number, tension)


def uniform(energy, pull_off, number):
    vector = np.array([[energy, pull_off, 8e-9, 6.5e-9]])
    return np.repeat(forcelaw.coefficients(vector, 1.5 * pull_off), number, axis=0)


def held(energy, pull_off, **more):
    """Shortest bridge on a uniform law [µm]."""
    part = zone(**more)
    longest = 2 * float(arrest_length(energy, part))
    return shortest_held(part, uniform(energy, pull_off, part.elements), longest) / UM


# Uniform ground: thresholds of an independent computation, pressed and released at fixed lengths


@pytest.mark.parametrize(
    ("law", "stress", "between"),
    [(DRY, STRESS, (200, 210)), (DRY, 0.0, (160, 200)), ((73e-3, 10.2e6), STRESS, (110, 120))],
)
@pytest.mark.parametrize("element", [1.0, 0.5, 0.25])
def test_a_uniform_bridge_is_held_down_to_the_threshold_of_its_middle_on_any_mesh(law, stress, between, element):
    found = held(*law, stress=stress, element=element)
    assert between[0] < found < between[1]
    assert_allclose(found, held(*law, stress=stress, element=0.25), rtol=0.01)


def test_a_mesh_that_does_not_resolve_the_middle_holds_shorter_bridges():
    assert held(*DRY, element=3.0) < 0.8 * held(*DRY)  # control of the test above


def test_bridges_are_held_far_below_the_length_at_which_their_cracks_meet():
    # Control: by the sum of two cracks, a bridge of 300 µm would be free.
    both = 2 * arrest_length(DRY[0], zone()) / UM
    assert both == pytest.approx(492, abs=1)
    assert both > 300
    assert is_held(300 * UM, zone(), uniform(*DRY, 60))
    assert held(*DRY) < 0.45 * both


@pytest.mark.parametrize("half", [6, 9, 24])
def test_the_size_of_the_zone_does_not_matter(half):
    assert_allclose(held(*DRY, half=half), held(*DRY), rtol=2e-3)


def test_the_start_of_the_search_does_not_matter():
    part, laws = zone(), uniform(*DRY, 60)
    lengths = [shortest_held(part, laws, longest * UM) / UM for longest in (215, 300, 700)]
    assert_allclose(lengths, lengths[0], rtol=3e-3)


def test_more_energy_more_attraction_or_a_smaller_gap_hold_shorter_bridges_and_stress_frees_longer_ones():
    energy, pull_off = DRY
    nominal = held(*DRY)
    assert held(1.2 * energy, pull_off) < nominal < held(0.8 * energy, pull_off)
    assert held(energy, 1.2 * pull_off) < nominal < held(energy, 0.8 * pull_off)
    assert held(*DRY, gap=1.8) < nominal < held(*DRY, gap=2.2)
    assert held(*DRY, stress=0.0) < held(*DRY, stress=20e6) < nominal < held(*DRY, stress=100e6)
    assert_allclose(held(*DRY, stress=1.0), held(*DRY, stress=0.0), rtol=2e-3)


def test_lengths_scale_as_the_closed_form_without_stress():
    # L⁴ = 16 E t³ h √(3h / (e f_max)); the shape of the law, a f_max / e, is kept.
    energy, pull_off = DRY
    assert_allclose(held(*DRY, stress=0.0, gap=3) / held(*DRY, stress=0.0), 1.5 ** (3 / 8), rtol=0.01)
    assert_allclose(held(2 * energy, 2 * pull_off, stress=0.0) / held(*DRY, stress=0.0), 2 ** (-1 / 4), rtol=0.01)


# Random ground, by brute force


@cache
def elastic(length, stress, step):
    """Stiffness of a whole clamped bridge by Gauss quadrature of its elements, in upper band form, without its ends."""
    number = round(length / step)
    x, weights = np.polynomial.legendre.leggauss(4)
    s = (x[:, None] + 1) / 2
    slope = np.hstack([6 * s**2 - 6 * s, 1 - 4 * s + 3 * s**2, 6 * s - 6 * s**2, 3 * s**2 - 2 * s]) / step
    bend = np.hstack([12 * s - 6, 6 * s - 4, 6 - 12 * s, 6 * s - 2]) / step**2
    part = 164e9 * 20e-24 * np.einsum("g,gi,gj", weights, bend, bend) * step / 2
    part += stress * 60e-12 * np.einsum("g,gi,gj", weights, slope, slope) * step / 2
    band = np.zeros((4, 2 * number + 2))
    for element in range(number):
        for i in range(4):
            for j in range(i, 4):
                band[3 - (j - i), 2 * element + j] += part[i, j]
    return band[:, 2:-2]


def times(band, u):
    """Product of a symmetric band matrix and a vector."""
    found = band[3] * u
    for k in (1, 2, 3):
        found[:-k] += band[3 - k, k:] * u[k:]
        found[k:] += band[3 - k, k:] * u[:-k]
    return found


def is_held(length, part, laws):
    """Press a whole bridge of equal elements down and let it creep: semi-implicit steps, no condensed arms."""
    step, area = part.element_length, part.width * part.element_length
    number = 2 * round(length / step / 2)
    band = elastic(number * step, part.tension / 60e-12, step)
    first = (number - len(laws)) // 2
    shape = np.array([0.5, 0.125, 0.5, -0.125])
    rows = 2 * (first + np.arange(len(laws)))[:, None] - 2 + np.arange(4)
    s = np.clip(np.arange(1, number) / first, 0, None)
    s = np.minimum(np.minimum(s, s[::-1]), 1)
    u = np.zeros(2 * (number - 1))
    u[::2] = (part.gap - np.mean(laws[:, 1] - np.log(2) / laws[:, 2])) * s**2 * (6 - 8 * s + 3 * s**2)
    creep = np.max(laws[:, 0] * laws[:, 3]) * area
    for _ in range(30_000):
        distance = part.gap - u[rows] @ shape
        steepness = np.where(distance < laws[:, 1], laws[:, 2], laws[:, 3])
        decay = np.exp(-np.clip(steepness * (distance - laws[:, 1]), -20, 50))
        push = laws[:, 0] * area * decay * (decay - 2)
        if np.all(distance > laws[:, 1]):
            return False
        force = -times(band, u)
        np.add.at(force, rows, -push[:, None] * shape)
        tangent = np.maximum(2 * steepness * laws[:, 0] * area * decay * (decay - 1), 0) + creep
        system = band.copy()
        for i in range(4):
            for j in range(i, 4):
                np.add.at(system, (3 - (j - i), rows[:, j]), tangent * shape[i] * shape[j])
        move = solveh_banded(system, force)
        largest = np.max(steepness * np.abs(move[rows] @ shape))
        u += move * min(1, 0.5 / largest)
        if largest < 1e-4:
            return True
    raise AssertionError("the bridge still creeps")


@pytest.mark.parametrize("seed", range(5))
def test_random_bridges_are_held_where_pressing_and_releasing_the_whole_bridge_holds_them(seed):
    part = zone(half=12)
    laws = scattered_laws(np.random.default_rng(seed), part.elements, 0.3, *DRY)
    length = shortest_held(part, laws, 500 * UM)
    assert not is_held(0.96 * length, part, laws)
    assert is_held(1.04 * length, part, laws)


def test_where_nothing_is_held_the_length_is_not_known():
    part = zone()
    assert shortest_held(part, uniform(*DRY, 60), 150 * UM) == np.inf


def test_a_long_bridge_opens_as_two_cantilevers():
    # The crack of a cantilever under tension is half of the length at which the two cracks of a bridge meet.
    laws = uniform(*DRY, 600)
    half = replace(zone(), length=300 * UM, elements=600)
    crack = crack_length(half, laws, release(half, laws, 60 * UM).deflection)
    assert_allclose(crack, arrest_length(DRY[0], half), rtol=0.015)


def test_strips_are_numbered_from_the_middle_so_that_the_ground_does_not_change_with_the_zone():
    for small, large in ((4, 6), (10, 30)):
        edge = (large - small) // 2
        assert_array_equal(outwards(large)[edge:-edge], outwards(small))
    assert_array_equal(np.sort(outwards(8)), np.arange(8))
    assert sorted(outwards(8)[3:5]) == [0, 1]


def test_a_zone_that_is_longer_than_the_bridge_is_refused():
    with pytest.raises(ValueError, match="shorter than its middle zone"):
        shortest_held(zone(), uniform(*DRY, 60), 20 * UM)


# Rough ground: places d_max that differ by tens of lengths 1/a


def on_two_levels(part, below):
    """Uniform laws, every second of which lies lower [m]."""
    laws = uniform(*DRY, part.elements)
    laws[::2, 1] -= below
    return laws


def test_laws_far_below_their_neighbours_hold_no_bridge():
    part, longest = zone(), 400 * UM
    low = on_two_levels(part, 100e-9)
    alone = low.copy()
    alone[::2, 0] *= 1e-9
    found = [shortest_held(part, laws, longest) for laws in (low, alone)]
    assert_allclose(found[0], found[1], rtol=3e-3)
    assert shortest_held(part, on_two_levels(part, 0.0), longest) < 0.95 * found[0]  # control


def test_mean_planes_may_be_anywhere():
    part, longest = zone(), 400 * UM
    laws, sunk = on_two_levels(part, 2e-9), on_two_levels(part, 2e-9)
    sunk[:, 1] -= 20e-9
    assert np.all(sunk[:, 1] < 0)
    lower = replace(part, gap=part.gap - 20e-9)
    assert_allclose(shortest_held(lower, sunk, longest), shortest_held(part, laws, longest), rtol=1e-6)
