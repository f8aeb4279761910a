"""Voltage switched on at once, in a field with fringes: beams in motion, fields by boundary elements, and limits."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from loaded_beams import Elements
from numpy.testing import assert_allclose
from plate_fields import area_of_force, width_of_force
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from test_touch_and_drying import BRIDGE, C1, STRESSED

from stiction.constants import VACUUM_PERMITTIVITY
from stiction.life.bending import Bent, Load
from stiction.life.fringes import edge_width
from stiction.life.touch import (
    pull_in_voltage,
    pull_in_voltage_at_once,
    shock_factor,
    stopper_voltage,
    stopper_voltage_at_once,
)
from stiction.streams import stream

BEAMS = [pytest.param(C1, 1, marks=pytest.mark.slow), (BRIDGE, 2), (STRESSED, 2)]
#: Relative distance from a bound at which a moving beam must stand, or must not.
NEAR = 3e-3


def plates(u):
    """Attraction of plates, over that at the open gap."""
    return (1 - u) ** -2


# Inertia


@pytest.mark.parametrize(("beam", "clamps"), BEAMS)
def test_a_moving_beam_falls_where_its_energy_passes_the_equilibrium_beyond_the_fold(beam, clamps):
    one = Bent(clamps, (beam.decay * beam.length) ** 2)
    ratio = (one.fold_at_once(plates) / one.fold(plates)) ** 0.5
    at_once, elements = ratio * pull_in_voltage(beam, clamps), Elements(beam, clamps, number=16)

    def stands(part):
        force = VACUUM_PERMITTIVITY * (part * at_once) ** 2 * beam.width / 2
        return elements.stands_at_once(lambda u: force / (beam.gap - u) ** 2)

    assert stands(1 - NEAR)
    assert not stands(1 + NEAR)
    assert not stands(1 / ratio - NEAR), "what a slow voltage leaves up, the same voltage at once brings down"


def test_a_plate_on_a_spring_is_the_limit_of_a_load_at_the_end():
    # x (1 - x)² has its largest value at 1/3, x (1 - x) at 1/2; a cantilever has the stiffness 3 at its end.
    at_end = Load(lambda u: 0 * u, plates)
    assert_allclose([Bent(1).fold(at_end), Bent(1).fold_at_once(at_end)], [3 * 4 / 27, 3 / 8], rtol=1e-6)


@pytest.mark.parametrize("way", [0.05, 0.2, 1 / 3, 0.45, 0.7])
def test_a_stopper_on_its_spring_moves_to_its_contact_at_the_voltage_of_its_energy(way):
    gap, area, stiffness = 3e-6, 1e-6, 2.0  # so large an electrode has hardly any fringes
    voltage = stopper_voltage_at_once(stiffness, way * gap, area, gap)
    least = min(way, 0.5)
    closed = (stiffness * least * (1 - least) * gap**3 / (VACUUM_PERMITTIVITY * area)) ** 0.5
    assert 0.99 * closed < voltage < closed < stopper_voltage(stiffness, way * gap, area, gap)

    def touches(factor):
        """Whether a mass of one touches within four periods."""
        force = VACUUM_PERMITTIVITY * area * (factor * closed) ** 2 / 2

        def rates(_, state):
            return [state[1], force / (gap - min(state[0], 0.999 * gap)) ** 2 - stiffness * state[0]]

        contact = lambda _, state: state[0] - way * gap  # noqa: E731
        contact.terminal = True
        time = 8 * np.pi / stiffness**0.5
        return len(solve_ivp(rates, (0, time), [0.0, 0.0], events=contact, rtol=1e-9, atol=1e-15).t_events[0]) > 0

    assert [touches(1 - NEAR), touches(1 + NEAR)] == [False, True]


@pytest.mark.parametrize("clamps", [1, 2])
def test_a_rectangular_pulse_moves_a_beam_by_more_than_twice_its_static_deflection_and_not_beyond_its_factor(clamps):
    beam = C1 if clamps == 1 else BRIDGE
    squares, shapes, mass = Elements(beam, clamps, number=16).modes(4)
    end = shapes[-2 if clamps == 1 else 16]
    parts = end * (shapes[::2].T @ mass[::2, ::2].sum(axis=1)) / squares  # of a load per length, in every mode
    frequencies, rng = (squares / squares[0]) ** 0.5, stream(5, "pulses", clamps)
    ended, asked = rng.uniform(0, 60, (2, 400_000, 1))
    after = np.cos(frequencies * asked) - np.cos(frequencies * (asked + ended))
    farthest = np.max(after @ parts) / parts.sum()
    factor = shock_factor(beam, clamps, 2.0)
    assert 2 < farthest < factor < 1.01 * farthest
    assert factor > 1.1 * shock_factor(beam, clamps)


# Fringes


@cache
def drawn_plates():
    """Widths, thicknesses and gaps [m] over orders of magnitude."""
    rng = stream(5, "plates")
    return 10 ** rng.uniform([-6, -7, -7], [-4, -5, -5], (12, 3))


def test_no_plate_is_attracted_by_more_than_its_edges_say():
    shares = []
    for width, thickness, gap in drawn_plates():
        found, edges = width_of_force(width, thickness, gap), 2 * edge_width(gap, thickness)
        assert width < found < width + edges * (1 + 1e-3)
        shares.append((found - width) / edges)
    assert min(shares) < 0.8, "narrow plates share the field of their edges"
    # Half of the width is less than a wide plate has.
    assert width_of_force(100e-6, 2e-6, 2e-6) > 100e-6 + edge_width(2e-6, 2e-6)


@pytest.mark.parametrize("ratio", [1e-3, 0.1, 1.0, 10.0])
def test_edges_of_wide_plates_are_those_of_the_map(ratio):
    gap = 1e-6
    width = 200 * gap * max(1.0, ratio)
    found = (width_of_force(width, ratio * gap, gap) - width) / 2
    assert_allclose(found, edge_width(gap, ratio * gap), rtol=0.05)  # panels, and the other edge


@pytest.mark.parametrize("by_gap", [10, 2])
def test_corners_of_a_square_are_no_worse_than_those_of_a_larger_one(by_gap):
    side = 1e-5
    gap = side / by_gap
    coarse, fine = (area_of_force((side, side), gap, number) for number in (8, 16))
    widened = (side + 2 * edge_width(gap, 1e-3 * gap)) ** 2
    assert side**2 < fine
    assert 2 * fine - coarse < widened, "panels of half the size halve the error"


@pytest.mark.parametrize(("beam", "clamps"), BEAMS)
def test_a_beam_in_its_field_stands_at_least_and_falls_at_most(beam, clamps):
    narrow = replace(beam, width=1.5 * beam.gap, tension=beam.tension / beam.width * 1.5 * beam.gap)
    gaps = np.linspace(0.1, 1, 7) * narrow.gap
    widths = CubicSpline(gaps, [width_of_force(narrow.width, narrow.thickness, gap) for gap in gaps])
    low, high = pull_in_voltage_at_once(narrow, clamps), pull_in_voltage(narrow, clamps, rigid=True)
    elements = Elements(narrow, clamps, number=16)

    def stands(voltage):
        def load(u):
            gap = np.maximum(narrow.gap - u, gaps[0])
            return VACUUM_PERMITTIVITY * voltage**2 / 2 * widths(gap) / gap**2

        return elements.stands_at_once(load)

    assert stands(low)
    assert not stands(high)
    assert not stands(0.909 * pull_in_voltage(narrow, clamps)), "without fringes it would stand"


def test_a_dielectric_raises_the_voltage_as_a_larger_gap():
    by_dielectric = pull_in_voltage(C1, 1, dielectric=1e-6)
    assert_allclose(by_dielectric, pull_in_voltage(replace(C1, gap=21e-6), 1), rtol=1e-9)
    assert by_dielectric > 1.05 * pull_in_voltage(C1, 1)
