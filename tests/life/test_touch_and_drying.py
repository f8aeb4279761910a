"""What brings beams into contact: folds of the package against finite elements under load control, and closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from loaded_beams import Elements
from numpy.testing import assert_allclose
from scipy.optimize import brentq

from stiction.beam.cantilever import Beam
from stiction.beam.energy import apparent_adhesion_energy
from stiction.constants import FREE_FALL, LIQUIDS
from stiction.life.bending import Bent
from stiction.life.drying import longest_free, longest_standing, longest_standing_each
from stiction.life.touch import HALF_SINE, pull_in_voltage, stopper_voltage, touching_acceleration

C1 = Beam(266e-6, 30e-6, 2.6e-6, 164e9, 20e-6, 1)
BRIDGE = Beam(170e-6, 30e-6, 2e-6, 164e9, 2e-6, 1)
STRESSED = replace(BRIDGE, tension=50e6 * 30e-6 * 2e-6)
#: Beams with their clamps, and whether these are rigid.
BEAMS = [(C1, 1, False), (BRIDGE, 2, False), (STRESSED, 2, False), (STRESSED, 2, True)]
#: Relative distance from a fold at which finite elements must stand, or must not.
NEAR = 2e-3
#: Width over which edges pull on a liquid no more than elsewhere, in gaps.
WIDE = 1e6
WATER, ALCOHOL = LIQUIDS["water"], LIQUIDS["isopropanol"]


def test_constants_are_those_of_the_notes():
    constants = [Bent(clamps).fold(lambda u, power=power: (1 - u) ** -power) for power in (2, 1) for clamps in (1, 2)]
    assert_allclose(constants, [1.6808, 70.095, 2.7845, 116.95], rtol=5e-5)
    exact = 3 / ((alpha := (33**0.5 - 3) / 4) ** 2 * (1 - alpha) * (3 + alpha))
    assert_allclose([Bent(1).fold_of_drop(), Bent(2).fold_of_drop()], [exact, 203.175], rtol=1e-5)


@pytest.mark.parametrize(("beam", "clamps", "rigid"), BEAMS)
def test_a_beam_stands_below_its_voltage_and_falls_above(beam, clamps, rigid):
    elements, voltage = Elements(beam, clamps, rigid), pull_in_voltage(beam, clamps, rigid)
    assert elements.stands_at((1 - NEAR) * voltage)
    assert not elements.stands_at((1 + NEAR) * voltage)


def test_the_bracket_of_the_voltage_refuses_a_form_with_the_square_in_the_wrong_place():
    # λ E t³ h³ / (6 ε0 L⁴) is V², not V: as V it differs by orders of magnitude.
    wrong = pull_in_voltage(C1, 1) ** 2
    assert not Elements(C1, 1).stands_at((1 - NEAR) * wrong)
    # The constant of a rigid plate on a spring in place of 1.6808.
    plate = pull_in_voltage(C1, 1) * (8 * 4 / 27 / Bent(1).fold(lambda u: (1 - u) ** -2)) ** 0.5
    assert Elements(C1, 1).stands_at((1 + NEAR) * plate)


@pytest.mark.parametrize(("beam", "clamps", "rigid"), BEAMS)
def test_a_beam_touches_under_its_acceleration(beam, clamps, rigid):
    weight = 2330.0 * beam.width * beam.thickness * touching_acceleration(beam, clamps, 2330.0, rigid)
    assert_allclose(Elements(beam, clamps, rigid).sags_to(weight), 1, rtol=1e-5)  # discretisation


@pytest.mark.parametrize(("beam", "clamps"), [(C1, 1), (BRIDGE, 2), (STRESSED, 2)])
def test_a_beam_shorter_than_its_length_stands_while_each_section_dries_and_a_longer_one_falls(beam, clamps):
    length = longest_standing_each(beam, clamps, WATER)
    assert Elements(replace(beam, length=(1 - NEAR) * length), clamps).stands_wet(WATER)
    assert not Elements(replace(beam, length=(1 + NEAR) * length), clamps).stands_wet(WATER)


@pytest.mark.parametrize("clamps", [1, 2])
@pytest.mark.parametrize(("by_gap", "angle"), [(0.25, 0.0), (1.5, 0.0), (1.5, 1.0), (15, 0.3)])
def test_no_angle_of_a_liquid_at_the_edges_brings_a_narrow_beam_down_below_its_length(clamps, by_gap, angle):
    beam = replace(C1, width=by_gap * C1.gap)
    length = longest_standing_each(beam, clamps, WATER, angle)
    elements = [Elements(replace(beam, length=part * length), clamps, number=16) for part in (1 - NEAR, 1 + NEAR)]
    assert [one.stands_wet(WATER, angle) for one in elements] == [True, False]


@pytest.mark.parametrize("clamps", [1, 2])
def test_the_length_of_a_wide_beam_is_refused_on_one_as_narrow_as_the_gap(clamps):
    wide, narrow = (replace(C1, width=by_gap * C1.gap) for by_gap in (WIDE, 1))
    length = longest_standing_each(wide, clamps, WATER)
    assert not Elements(replace(narrow, length=(1 - NEAR) * length), clamps, number=16).stands_wet(WATER)


@pytest.mark.slow
@pytest.mark.parametrize(("beam", "clamps"), [(C1, 1), (BRIDGE, 2), (STRESSED, 2)])
def test_a_beam_shorter_than_its_length_stands_while_a_connected_liquid_dries_and_a_longer_one_falls(beam, clamps):
    length = longest_standing(beam, clamps, WATER)
    assert Elements(replace(beam, length=(1 - NEAR) * length), clamps).stands_drying(WATER)
    assert not Elements(replace(beam, length=(1 + NEAR) * length), clamps).stands_drying(WATER)


def test_the_bracket_of_drying_refuses_two_ninths():
    length = longest_standing(C1, 1, WATER)
    quoted = length * (2 / 9 / 0.2295) ** 0.25
    first = round(0.686 * 32)  # where the drop of the fold begins
    assert not Elements(replace(C1, length=(1 + NEAR) * length), 1).stands_with_drop(WATER, first)
    assert Elements(replace(C1, length=(1 + NEAR) * quoted), 1).stands_with_drop(WATER, first)


def test_without_tension_lengths_are_the_closed_forms():
    wide = replace(C1, width=WIDE * C1.gap)
    for clamps, drop, each in ((1, 0.2295, 0.1160), (2, 8.466, 4.873)):
        scale = C1.young_modulus * C1.thickness**3 * C1.gap**2 / WATER
        assert_allclose(longest_standing(C1, clamps, WATER), (drop * scale) ** 0.25, rtol=1e-4)
        if clamps == 2:  # no free end
            assert_allclose(longest_standing_each(wide, clamps, WATER), (each * scale) ** 0.25, rtol=1e-4)
    assert_allclose(longest_free(C1, 1, WATER), (3 / 16 * scale) ** 0.25, rtol=1e-12)


def test_beams_of_the_notes_have_their_numbers():
    shallow, paper = replace(C1, gap=2e-6), replace(C1, length=1500e-6)
    assert_allclose([pull_in_voltage(one, 1) for one in (paper, C1, shallow)], [12.0, 382, 12.1], rtol=5e-3)
    shocks = [touching_acceleration(one, 1, 2330.0) / FREE_FALL for one in (paper, C1, shallow)]
    assert_allclose(shocks, [128, 129_000, 12_900], rtol=5e-3)
    dried = [longest_standing(one, 1, liquid) * 1e6 for one in (C1, shallow) for liquid in (WATER, ALCOHOL)]
    assert_allclose(dried, [246, 333, 78, 105], rtol=5e-3)
    aluminium = Beam(300e-6, 200e-6, 2e-6, 70e9, 3.5e-6, 1)
    assert_allclose(longest_standing(aluminium, 1, WATER), 68e-6, rtol=0.01)


def test_tension_and_rigid_clamps_raise_every_threshold_of_a_bridge():
    measures = (
        lambda beam, rigid: pull_in_voltage(beam, 2, rigid),
        lambda beam, rigid: touching_acceleration(beam, 2, 2330.0, rigid),
    )
    for measure in measures:
        assert measure(BRIDGE, False) < measure(STRESSED, False) < measure(STRESSED, True)
    for longest in (longest_standing, longest_standing_each, longest_free):
        assert longest(BRIDGE, 2, WATER) < longest(STRESSED, 2, WATER)


@pytest.mark.parametrize("longest", [longest_standing, longest_standing_each, longest_free])
def test_little_tension_changes_nothing(longest):
    little = replace(BRIDGE, tension=1e-6 * STRESSED.tension)
    assert_allclose(longest(little, 2, WATER), longest(BRIDGE, 2, WATER), rtol=1e-5)


def test_a_bridge_under_high_tension_is_a_string():
    # String: U'' = -λ / τ (1 - U)^-2 on a unit length has its fold at 1.4000; both clamps shorten it by 2 / √τ.
    tension = 4e4
    fold = Bent(2, tension).fold(lambda u: (1 - u) ** -2)
    assert_allclose(fold / tension, 1.4000 * (1 + 4 / tension**0.5), rtol=1e-3)
    assert_allclose(
        Bent(2, tension).under(lambda u: 1 + 0 * u, 1.0)[0] / tension, 8 * (1 + 4 / tension**0.5), rtol=2e-3
    )


@pytest.mark.parametrize("longest", [longest_standing, longest_standing_each, longest_free])
def test_a_liquid_that_does_not_wet_lets_every_beam_stand(longest):
    assert longest(C1, 1, 0.0) == longest(STRESSED, 2, -0.01) == np.inf
    assert longest(C1, 1, 1e-9) > 10 * longest(C1, 1, WATER)


def test_what_dried_is_held_by_twice_the_tension_of_the_liquid():
    # Cracks of a bridge meet in its middle; each is an S-shape whose rate of release is the energy.
    half = longest_free(STRESSED, 2, WATER) / 2
    assert_allclose(apparent_adhesion_energy(half, STRESSED), 2 * WATER, rtol=1e-6)


# Shocks


def displacement(duration, pulse):
    """Largest displacement of an oscillator of period 1 without damping under a pulse of unit height, over static."""
    t = np.linspace(0, duration + 1, 8001)
    forced = pulse(t / duration) * (t <= duration)
    c, s = np.cos(2 * np.pi * t), np.sin(2 * np.pi * t)
    step = t[1]
    return np.max(2 * np.pi * step * (s * np.cumsum(forced * c) - c * np.cumsum(forced * s)))


def test_no_half_sine_moves_an_oscillator_by_more_than_its_factor():
    largest = max(displacement(d, lambda x: np.sin(np.pi * x)) for d in np.linspace(0.6, 1.0, 81))
    assert_allclose(largest, HALF_SINE, rtol=1e-3)
    assert displacement(20.0, lambda x: np.sin(np.pi * x)) < 1.1  # slow: nearly static
    assert displacement(2.0, np.ones_like) > 1.05 * HALF_SINE  # a rectangle exceeds it


def free_mode(root):
    """Mode of a cantilever on x from 0 to 1, for a root of cos z cosh z = -1."""
    x = np.linspace(0, 1, 20_001)
    ratio = (np.sinh(root) - np.sin(root)) / (np.cosh(root) + np.cos(root))
    return np.cosh(root * x) - np.cos(root * x) - ratio * (np.sinh(root * x) - np.sin(root * x))


def clamped_mode(root):
    """Symmetric mode of a bridge, from its end to its middle, for a root of tan(z / 2) = -tanh(z / 2)."""
    x = np.linspace(-0.5, 0, 20_001)
    return np.cos(root * x) / np.cos(root / 2) - np.cosh(root * x) / np.cosh(root / 2)


@pytest.mark.parametrize(
    ("clamps", "mode", "equation", "first"),
    [
        (1, free_mode, lambda z: np.cos(z) + 1 / np.cosh(z), np.pi * np.arange(5)),
        (2, clamped_mode, lambda z: np.sin(z / 2) + np.cos(z / 2) * np.tanh(z / 2), np.pi * (1 + 2 * np.arange(5))),
    ],
)
def test_modes_of_a_beam_add_to_the_first_what_their_closed_forms_say(clamps, mode, equation, first):
    parts = []
    for low in first:
        root = brentq(equation, low + 1e-6, low + np.pi)
        shape = mode(root)
        parts.append(shape[-1] * shape.mean() / (shape**2).mean() / root**4)
    assert_allclose(Bent(clamps).overshoot(), np.abs(parts).sum() / np.sum(parts), rtol=1e-3)


# Stoppers on springs


def test_a_stopper_is_pulled_in_at_a_third_of_the_gap_and_before_that_at_its_way():
    stiffness, area, gap = 2.0, 1e-8, 3e-6
    fold = (8 * stiffness * gap**3 / (27 * 8.8541878128e-12 * area)) ** 0.5
    ways = np.linspace(0.01, 1, 100) * gap
    voltages = np.array([stopper_voltage(stiffness, way, area, gap) for way in ways])
    assert_allclose(voltages[ways >= gap / 3], fold, rtol=1e-12)
    assert np.all(np.diff(voltages[ways < gap / 3]) > 0)
    for way, voltage in zip(ways[:30], voltages, strict=False):
        attraction = 8.8541878128e-12 * area * voltage**2 / (2 * (gap - way) ** 2)
        assert_allclose(attraction, stiffness * way, rtol=1e-9)
