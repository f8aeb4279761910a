from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from beams import PAPER, scattered_laws, uniform_laws
from numpy.testing import assert_allclose, assert_array_equal

from stiction.beam.cantilever import Beam
from stiction.beam.energy import arrest_length
from stiction.beam.foundation import LONGER, STRIP, foundation_length
from stiction.beam.middle import shortest_held
from stiction.contact import forcelaw
from stiction.contact.environment import Water, flooded_law
from stiction.devices import bridges
from stiction.streams import stream

BEAM = Beam(600e-6, 30e-6, 2e-6, 164e9, 2e-6, 160)
R1 = bridges.half_of_bridge(BEAM, 50e6)
DRY = 6.165e-3, 2.85e6


def test_tension_is_the_stress_times_the_cross_section():
    assert_allclose(R1.tension, 50e6 * 60e-12, rtol=1e-14)
    assert bridges.half_of_bridge(BEAM, 0) == BEAM


def test_compression_is_refused():
    with pytest.raises(ValueError, match="-5 MPa is compressive"):
        bridges.half_of_bridge(PAPER, -5e6)
    with pytest.raises(ValueError, match="compressive"):
        bridges.half_of_bridge(replace(PAPER), float("nan"))


# Closed form


def test_the_pull_and_the_curvature_are_those_of_a_clamped_beam_or_of_a_string():
    force, curvature = bridges.pull(200e-6, BEAM)
    stiffness = BEAM.bending_stiffness
    assert_allclose(force, 192 * stiffness * BEAM.gap / 200e-6**3, rtol=1e-12)
    assert_allclose(curvature, force * 200e-6 / 8 / stiffness, rtol=1e-12)
    stressed = bridges.half_of_bridge(BEAM, 1e13)
    force, _ = bridges.pull(200e-6, stressed)
    assert_allclose(force, 4 * stressed.tension * BEAM.gap / 200e-6, rtol=0.01)
    slack = bridges.half_of_bridge(BEAM, 1.0)
    assert_allclose(bridges.pull(200e-6, slack), bridges.pull(200e-6, BEAM), rtol=1e-6)


def test_without_stress_the_bound_is_close_to_the_parabola_of_a_point_force():
    # L⁴ = 16 E t³ h √(3h / (e f_max)) = (167 µm)⁴; the width of the patch, b = P / (2 w f_max), lowers it a little.
    energy, pull_off = DRY
    length = (16 * 164e9 * 2e-6**3 * 2e-6 * np.sqrt(6e-6 / (energy * pull_off))) ** (1 / 4)
    assert length == pytest.approx(167e-6, abs=0.5e-6)
    assert 0.98 < bridges.least_length(*DRY, BEAM) / length < 1
    # The limit of a short range: the same product of energy and attraction, but a narrower patch.
    assert_allclose(bridges.least_length(energy / 100, pull_off * 100, BEAM) / length, 1, rtol=1e-3)


@pytest.mark.parametrize("stress", [0.0, 10e6, 50e6, 300e6])
@pytest.mark.parametrize("law", [(6.165e-3, 2.85e6), (73e-3, 10.2e6), (2e-3, 1e6)])
def test_the_bound_is_a_few_percent_below_finite_elements_on_a_uniform_law(law, stress):
    half = bridges.half_of_bridge(BEAM, stress)
    laws = uniform_laws(48, *law)
    zone = replace(half, length=24e-6, elements=48)
    found = shortest_held(zone, laws, 2 * float(arrest_length(law[0], zone)))
    assert 0.9 < bridges.least_length(*law, half) / found < 1


def test_no_random_ground_holds_a_bridge_below_the_bound_of_its_strongest_law():
    rng = np.random.default_rng(2)
    shortest = []
    for _ in range(60):
        stress, gap, thickness = rng.choice([0, 50e6, 200e6]), rng.uniform(1, 3) * 1e-6, rng.uniform(1.5, 3) * 1e-6
        half = bridges.half_of_bridge(replace(BEAM, gap=gap, thickness=thickness), stress)
        pull_off = 1e6 * 10 ** rng.uniform()
        laws = scattered_laws(rng, 40, 0.3, rng.uniform(2.5e-9, 8e-9) * pull_off, pull_off)
        strongest = forcelaw.energy(laws).max(), laws[:, 0].max()
        zone = replace(half, length=20e-6, elements=40)
        found = shortest_held(zone, laws, 2 * float(arrest_length(strongest[0], zone)))
        shortest.append(found / bridges.least_length(*strongest, half))
    assert min(shortest) > 1
    # Control: the mean law is no bound.
    assert min(shortest) < 1.2


def test_flooded_flats_bound_water_and_solids_at_every_humidity():
    height, tension = Water(300.0).film(0.65)
    water = flooded_law(0.65, Water(300.0), 0.0)
    assert_allclose(water, (height * tension, tension), rtol=1e-12)
    both = flooded_law(0.65, Water(300.0), 9.75e-20)
    solid = np.subtract(both, water)
    assert_allclose(solid[0] / solid[1], 0.2275e-9, rtol=1e-3)  # range of the van der Waals stress
    assert bridges.least_length(*both, R1) < bridges.least_length(*water, R1)


def test_a_bridge_that_is_held_at_any_length_has_no_bound():
    assert bridges.least_length(1e3, 10.0, R1) == 0


def test_stronger_laws_or_less_stress_lower_the_bound():
    energy, pull_off = DRY
    nominal = bridges.least_length(*DRY, R1)
    assert bridges.least_length(2 * energy, pull_off, R1) < nominal > bridges.least_length(energy, 2 * pull_off, R1)
    assert bridges.least_length(*DRY, BEAM) < nominal < bridges.least_length(*DRY, bridges.half_of_bridge(BEAM, 80e6))


# Finite elements on random ground


def test_the_middle_zone_is_resolved_and_wide_enough():
    laws = uniform_laws(10, *DRY)
    foundation = foundation_length(R1, laws)
    for strip in (0.5e-6, 1.5e-6):
        zone, strips = bridges.middle_zone(R1, strip, laws)
        assert zone.length / strips == pytest.approx(strip, rel=1e-12)
        assert strips % 2 == zone.elements % strips == 0
        assert zone.element_length <= bridges.ELEMENT * foundation
        assert 0 <= zone.length - 2 * bridges.ZONE * foundation < 2 * strip
    with pytest.raises(ValueError, match=r"strips of 2 µm do not resolve the middle of a bridge"):
        bridges.middle_zone(R1, 2e-6, uniform_laws(10, 60e-3, 60e6))
    assert LONGER * STRIP * foundation_length(R1, uniform_laws(10, 60e-3, 60e6)) < 2e-6


def test_a_bridge_has_the_same_ground_in_any_zone():
    laws = scattered_laws(np.random.default_rng(3), 120, 0.3, *DRY)
    zone = replace(R1, length=30e-6, elements=60)
    lengths = [bridges.held_length(replace(zone, length=n * 0.5e-6, elements=n), laws[:n]) for n in (50, 60, 120)]
    assert_allclose(lengths, lengths[0], rtol=3e-3)
    # Control: other ground.
    assert abs(bridges.held_length(zone, laws[60:]) / lengths[0] - 1) > 3e-3


def test_bridges_have_their_own_random_numbers_and_finer_elements_change_little():
    zone, strips = bridges.middle_zone(R1, 0.5e-6, uniform_laws(10, *DRY))
    draw = lambda n, rng: scattered_laws(rng, n, 0.3, *DRY)  # noqa: E731
    many = bridges.held_lengths(zone, strips, draw, 12, partial(stream, 1))
    assert_array_equal(bridges.held_lengths(zone, strips, draw, 4, partial(stream, 1)), many[:4])
    assert len(set(many)) == 12
    fine = bridges.held_lengths(replace(zone, elements=2 * zone.elements), strips, draw, 12, partial(stream, 1))
    assert abs(np.mean(fine / many) - 1) < 0.005


def test_scatter_of_the_ground_lets_some_bridges_be_held_that_the_mean_law_frees():
    zone, strips = bridges.middle_zone(R1, 0.5e-6, uniform_laws(10, *DRY))
    uniform = bridges.held_length(zone, uniform_laws(strips, *DRY))
    draw = lambda n, rng: scattered_laws(rng, n, 0.4, *DRY)  # noqa: E731
    found = bridges.held_lengths(zone, strips, draw, 60, partial(stream, 2))
    assert found.min() < 0.95 * uniform
    assert np.all(found < 2 * arrest_length(DRY[0], R1))
