"""Rows of dimples: closed forms, finite elements, tension as a string, and the deflection beside them."""

from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
import pytest
from loaded_beams import Elements
from numpy.testing import assert_allclose

from stiction.beam.cantilever import Beam
from stiction.life.dimples import holds, least_load, least_pull, states

BEAM = Beam(200e-6, 30e-6, 2e-6, 164e9, 3e-6, 1)
STRESSES = (0.0, 1e3, 1e6, 50e6, 1e9)


def row(beam, clamps, at):
    """Pull on one row at a distance, and the largest deflection over that there."""
    (state,) = states(beam, clamps, [at])
    return state.pull[0], state.deepest


def by_elements(beam, clamps, nodes):
    """Pull on rows at nodes and the largest deflection over that there, by finite elements."""
    model = Elements(beam, clamps, number=64)
    bending, slopes = model.stiffness()
    matrix, held = bending + beam.tension * slopes, 2 * np.array(nodes)
    free, u = np.setdiff1d(model.free, held), np.zeros(len(bending))
    u[held] = 1.0
    u[free] = -np.linalg.solve(matrix[np.ix_(free, free)], (matrix @ u)[free])
    return (matrix @ u)[held], u[::2]


def test_a_cantilever_has_the_stiffness_of_its_part_and_goes_on_straight():
    for at in (40e-6, 100e-6, 190e-6):
        stiffness, deepest = row(BEAM, 1, at)
        assert_allclose(stiffness, 3 * BEAM.bending_stiffness / at**3, rtol=1e-12)
        assert_allclose(deepest, 1 + 1.5 * (BEAM.length - at) / at, rtol=1e-12)


@pytest.mark.parametrize("stress", STRESSES)
@pytest.mark.parametrize("nodes", [[8], [20], [50], [16, 40], [20, 32, 44], [10, 20, 50, 60]])
@pytest.mark.parametrize("clamps", [1, 2])
def test_beams_on_rows_bend_as_by_finite_elements(stress, nodes, clamps):
    beam = replace(BEAM, tension=stress * BEAM.width * BEAM.thickness * (clamps == 2))
    at, above = [node / 64 * BEAM.length for node in nodes], set()
    for number in range(1, len(nodes) + 1):
        for rows in combinations(range(len(nodes)), number):
            pull, u = by_elements(beam, clamps, [nodes[row] for row in rows])
            if u[nodes].max() < 1 + 1e-6:
                above.add(rows)
                (found,) = [state for state in states(beam, clamps, at) if state.rows == rows]
                assert_allclose(found.pull, pull, rtol=2e-3, atol=1e-3 * abs(pull).max())
                assert_allclose(found.deepest, u.max(), rtol=2e-3)
    assert above == {state.rows for state in states(beam, clamps, at)}


def test_a_bridge_has_its_closed_form_and_both_sides_are_alike():
    length, at = BEAM.length, 60e-6
    expected = 3 * BEAM.bending_stiffness * length**3 / (at * (length - at)) ** 3
    assert_allclose(row(BEAM, 2, at)[0], expected, rtol=1e-12)
    tense = replace(BEAM, tension=50e6 * BEAM.width * BEAM.thickness)
    for beam in (BEAM, tense):
        assert_allclose(row(beam, 2, at), row(beam, 2, length - at), rtol=1e-9)
    assert_allclose(row(BEAM, 2, length / 2)[1], 1, rtol=1e-12)


def test_under_much_tension_a_bridge_is_a_string_that_is_deepest_at_its_row():
    at, tension = 60e-6, 1e12 * BEAM.width * BEAM.thickness
    stiffness, deepest = row(replace(BEAM, tension=tension), 2, at)
    assert_allclose(stiffness, tension * (1 / at + 1 / (BEAM.length - at)), rtol=0.03)
    assert_allclose(deepest, 1, rtol=1e-2)


def test_a_row_far_from_the_others_and_two_next_to_each_other_hold_as_one():
    close = states(BEAM, 1, [150e-6, 150.001e-6])
    assert_allclose(least_pull(close), row(BEAM, 1, 150.001e-6)[0], rtol=1e-4)
    # A row close to a clamp never comes down as far as one beyond it, which alone holds the beam with least force.
    far = states(BEAM, 1, [1e-6, 150e-6])
    assert_allclose(least_pull(far), row(BEAM, 1, 150e-6)[0], rtol=1e-9)


def test_a_beam_sticks_where_one_state_holds_at_every_row_and_pressed_rows_need_no_force():
    found = states(BEAM, 1, [80e-6, 160e-6])
    assert [state.rows for state in found] == [(1,), (0, 1)]
    both, alone = found[1].pull, found[0].pull[0]
    assert both[1] < 0 < alone < both[0]
    held = np.array([[0.0, 1.01 * alone], [0.0, 0.99 * alone], [1.01 * both[0], 0.0], [0.99 * both[0], 0.0]])
    assert list(holds(found, 1.0, held)) == [True, False, True, False]
    assert list(holds(found, 2.0, held)) == [False] * 4


def test_more_rows_leave_more_of_the_gap_between_them():
    deepest = [
        min(state.deepest for state in states(BEAM, 1, np.linspace(0, 180e-6, number + 1)[1:])) for number in (1, 2, 4)
    ]
    assert np.all(np.diff(deepest) < 0)


# Loads


@dataclass(frozen=True)
class OnRows(Elements):
    """A beam on rows at some nodes, which hold it at a deflection."""

    rows: tuple[int, ...] = ()

    @property
    def free(self):
        """Unknowns that neither clamps nor rows hold."""
        return np.setdiff1d(super().free, 2 * np.array(self.rows))

    def bears(self, way, factor, power):
        """Whether it stands under a load that grows to ``factor`` / gap ** ``power`` per length."""
        u = np.zeros(2 * self.number + 2)
        u[2 * np.array(self.rows)] = way

        def load(share, v):
            gap = self.beam.gap - v
            return share * factor / gap**power, share * power * factor / gap ** (power + 1)

        for share in 1 - np.linspace(1, 0, 16) ** 2:
            u = self.balance(lambda v, share=share: self.forces(v, lambda w: load(share, w)), u)
            if u is None:
                return False
        return True


def on_all(beam, clamps, nodes, way, power):
    """Largest load on a beam that all its rows hold."""
    found = states(beam, clamps, [node / 64 * beam.length for node in nodes])
    return least_load([state for state in found if len(state.rows) == len(nodes)], way, beam.gap, power)


ON = [(1, (20, 50)), (1, (60,)), (2, (16, 40)), (2, (20, 32, 44)), (2, (32,))]


@pytest.mark.parametrize("power", [1, 2])
@pytest.mark.parametrize(("clamps", "nodes"), ON)
def test_finite_elements_stand_at_the_largest_load_and_fall_at_less_than_three_times_that(clamps, nodes, power):
    for stress in (0.0, 50e6 * (clamps == 2)):
        beam, way = replace(BEAM, tension=stress * BEAM.width * BEAM.thickness), 1e-6
        elements, load = OnRows(beam, clamps, number=64, rows=nodes), on_all(beam, clamps, nodes, way, power)
        assert elements.bears(way, load, power)
        assert not elements.bears(way, 3 * load, power)


@pytest.mark.parametrize(("clamps", "nodes"), ON)
def test_a_little_load_bends_parts_as_by_finite_elements(clamps, nodes):
    """Without a way of the rows and far from the fold, the limit of a load c / g⁰ is h over the largest deflection."""
    model = OnRows(BEAM, clamps, number=64, rows=nodes)
    bending, _ = model.stiffness()
    down, edges, size, free = np.zeros(65), [0, *nodes, 64], model.size, model.free
    for low, high in zip(edges, edges[1:], strict=False):
        force, u = np.zeros(len(bending)), np.zeros(len(bending))
        for i in range(2 * low, 2 * high, 2):
            force[i : i + 4] += [size / 2, size**2 / 12, size / 2, -(size**2) / 12]
        u[free] = np.linalg.solve(bending[np.ix_(free, free)], force[free])
        down += np.maximum(u[::2], 0)
    # Nodes are up to 1/128 of the length from the deepest place.
    assert_allclose(on_all(BEAM, clamps, nodes, 0.0, 0), BEAM.gap / down.max(), rtol=1e-2)


def test_a_load_cannot_bring_down_a_beam_that_more_rows_carry_and_any_load_one_that_touches():
    limits = []
    for number in (1, 2, 4):
        found = states(BEAM, 2, np.linspace(0, BEAM.length, number + 2)[1:-1])
        limits.append(least_load(found[-1:], 1e-6, BEAM.gap, 2))  # on all of them
    assert np.all(np.diff(limits) > 0)
    for power in (1, 2):
        (far,) = states(BEAM, 1, [40e-6])
        assert far.deepest * 1e-6 > BEAM.gap
        assert least_load([far], 1e-6, BEAM.gap, power) == 0
    # A load as large as the limit of the outer row alone has brought the inner row down long before.
    both = states(BEAM, 1, [100e-6, 180e-6])
    alone, together = ([one for one in both if len(one.rows) == number] for number in (1, 2))
    assert least_load(both, 0.1e-6, BEAM.gap, 2) == least_load(together, 0.1e-6, BEAM.gap, 2)
    assert least_load(alone[:0] + together, 0.1e-6, BEAM.gap, 2) > 0
