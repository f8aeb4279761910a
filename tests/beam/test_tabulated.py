"""The beam on tabulated force curves, by which laws of Eq. (12) are compared with the curves: ``make tails``."""

from dataclasses import replace

import numpy as np
import pytest
from beams import E_BAR, PAPER, uniform_laws
from benchmarks import tails

from stiction.beam.energy import arrest_length
from stiction.beam.release import released_beam
from stiction.contact import forcelaw

STEP, POINTS = 0.05e-9, 400


def lengths(factor=1.0):
    """Crack length on laws of Eq. (12), and on a table of them with all forces times a factor [m]."""
    beam = replace(PAPER, length=1e-3, elements=POINTS // 5)
    laws = uniform_laws(POINTS, energy=4 * E_BAR)
    table = factor * forcelaw.pressure(laws[:1, None], STEP * np.arange(2000))
    start = arrest_length(4 * E_BAR, beam) / 3
    return released_beam(beam, laws).crack_length, tails.crack_length(
        beam, (laws, table, np.zeros(POINTS, int), STEP), start, 1.0
    )


@pytest.mark.slow
def test_on_a_table_of_eq_12_the_crack_is_that_of_the_law():
    law, table = lengths()
    assert table == pytest.approx(law, rel=1e-5)


@pytest.mark.slow
def test_a_table_with_a_tenth_less_force_has_a_crack_that_is_longer_as_the_fourth_root():
    law, table = lengths(factor=0.9)
    assert table / law == pytest.approx(0.9**-0.25, rel=0.01)


DISTANCE = STEP * np.arange(2000)


def bell_curves():
    """Two curves with a parabola left of d_max and a tail that falls with the third power of the distance [Pa]."""
    f_max, d_max = np.array([[1e5], [3e5]]), np.array([[8e-9], [9e-9]])
    far = (DISTANCE - d_max) / 2e-9
    return f_max * np.where(far < 0, (2 * far) ** 2 - 1, -((1 + far**2) ** -1.5))


def shapes(curves):
    """Energies e (m,), tables of all shapes, vectors and f_limit of curves."""
    vectors, limit = forcelaw.parametrise(DISTANCE, curves.__getitem__, len(curves))
    return vectors[:, 0], tails.shapes(DISTANCE, curves, vectors, limit), vectors, limit


def energies(table):
    return [forcelaw.adhesion_energy(DISTANCE, force) for force in table]


# Tolerances are those of linear interpolation on the grid: curves are steep left of d_max.


def test_shapes_with_one_branch_of_the_curve_have_its_energy_and_largest_attraction():
    curves = bell_curves()
    e, every, vectors, _ = shapes(curves)
    for table in every:
        np.testing.assert_allclose(energies(table), e, rtol=2e-3)
        np.testing.assert_allclose(table.min(axis=1), curves.min(axis=1), rtol=1e-3)
    grafted = np.where(vectors[:, 2:3] > DISTANCE, curves, every[0])  # the right branch keeps its energy
    assert np.all(np.abs(energies(grafted) / e - 1) > 0.04)


def test_branches_of_curves_that_are_laws_are_those_of_the_laws():
    laws = np.array([[1e5, 8e-9, 0.8e9, 0.8e9], [3e5, 9e-9, 0.5e9, 0.5e9]])
    _, (law, _, right, left, parabola), vectors, _ = shapes(forcelaw.pressure(laws[:, None], DISTANCE))
    used, scale = vectors[:, 3:] < DISTANCE, vectors[:, 1:2]
    for table in (right, left):
        assert np.max(np.abs(table - law) / scale, where=used, initial=0) < 0.01
    assert np.max(np.abs(parabola - law) / scale, where=used, initial=0) > 0.1


def test_the_parabola_passes_its_lowest_point_and_d_limit_and_that_of_a_parabolic_curve_is_the_curve():
    curves = bell_curves()
    _, (law, *_, parabola), vectors, limit = shapes(curves)
    for table, (_, _, _, d_limit) in zip(parabola, vectors, strict=True):
        assert forcelaw.limit_distance(DISTANCE, table, limit) == pytest.approx(d_limit, abs=0.01 * STEP)
    left = (vectors[:, 3:] < DISTANCE) & (vectors[:, 2:3] > DISTANCE)
    assert np.max(np.abs(parabola - curves) / limit, where=left, initial=0) < 0.01
    assert np.max(np.abs(law - curves) / limit, where=left, initial=0) > 0.05
