"""Loads on beams that rest on some of their rows: finite elements whose other rows carry when they come down."""

from dataclasses import dataclass
from functools import cached_property
from itertools import chain, combinations

import numpy as np
import pytest
from loaded_beams import Elements

from stiction.beam.cantilever import Beam
from stiction.life.dimples import least_load, states
from stiction.streams import stream

NUMBER = 32


@dataclass(frozen=True)
class OneSided:
    """Beam of which some rows hold it at a deflection [m], and all others keep it from coming down farther."""

    elements: Elements
    way: float
    nodes: tuple[int, ...]
    held: tuple[int, ...]

    @cached_property
    def compliance(self):
        """Deflections by forces on all unknowns, without rows."""
        bending, slopes = self.elements.stiffness()
        free = np.ix_(self.elements.free, self.elements.free)
        inverse = np.zeros_like(bending)
        inverse[free] = np.linalg.inv((bending + self.elements.beam.tension * slopes)[free])
        return inverse

    def bent(self, force):
        """Deflection under given forces, and the rows that touch."""
        alone = self.compliance @ force
        further = [row for row in range(len(self.nodes)) if row not in self.held]
        for more in chain.from_iterable(combinations(further, number) for number in range(len(further) + 1)):
            rows = sorted(self.held + more)
            at = 2 * np.array([self.nodes[row] for row in rows])
            reaction = np.linalg.solve(self.compliance[np.ix_(at, at)], self.way - alone[at])
            u = alone + self.compliance[:, at] @ reaction
            pushed = all(reaction[rows.index(row)] <= 0 for row in more)
            if pushed and np.all(u[2 * np.array(self.nodes)] <= self.way * (1 + 1e-9)):
                return u, tuple(rows)
        raise AssertionError("one set of rows must carry the beam")

    def stands(self, factor, power):
        """Whether it does not touch beside its rows under a load ``factor`` / gap ** ``power`` per length.

        It comes down as slowly as in a viscous medium: rows that come down on the way stop it.
        """
        gap, (u, _) = self.elements.beam.gap, self.bent(np.zeros(len(self.compliance)))
        for _ in range(3000):
            if u[::2].max() >= gap * (1 - 1e-3):
                return False
            force, _ = self.elements.forces(u, lambda v: (factor / (gap - v) ** power, 0 * v))
            before, (u, _) = u, self.bent(force)
            if np.abs(u - before)[::2].max() < 1e-8 * gap:
                return True
        return True


def beams(clamps, nodes, part, stress=0.0):
    """A beam on rows at nodes that deflect it by a part of its gap, and one with finite elements for each state."""
    beam = Beam(200e-6, 30e-6, 2e-6, 164e9, 3e-6, 1, tension=stress * 30e-6 * 2e-6)
    found = states(beam, clamps, [node / NUMBER * beam.length for node in nodes])
    elements = Elements(beam, clamps, number=NUMBER)
    return beam, found, [OneSided(elements, part * beam.gap, nodes, state.rows) for state in found]


def drawn(number):
    """Clamps, nodes, part of the gap, tension and power of the load of a drawn beam."""
    rng = stream(3, "rows", number)
    clamps = int(rng.integers(1, 3))
    nodes = tuple(sorted(map(int, rng.choice(np.arange(3, NUMBER - 2), rng.integers(1, 5), replace=False))))
    stress = float(rng.choice([0.0, 20e6, 100e6])) * (clamps == 2)
    return clamps, nodes, float(rng.uniform(0.1, 0.8)), stress, int(rng.integers(1, 3))


#: Beams that another row would carry if the load on it were that at the smallest gap, and that touch before.
EARLY = [(1, (3, 21, 28), 0.22), (1, (8, 16, 22, 27), 0.61), (1, (12, 18, 27), 0.58), (1, (14, 24, 27), 0.63)]
DRAWS = [*((*beam, 0.0, power) for beam in EARLY for power in (1, 2)), *map(drawn, range(20))]


@pytest.mark.parametrize("draw", DRAWS, ids=str)
def test_no_state_of_a_beam_touches_beside_its_rows_at_the_least_load(draw):
    *shape, power = draw
    beam, found, by_elements = beams(*shape)
    for state, one in zip(found, by_elements, strict=True):
        assert one.bent(np.zeros(len(one.compliance)))[1] == state.rows, "it rests on these rows alone"
    load = least_load(found, shape[2] * beam.gap, beam.gap, power)
    assert all(one.stands(0.999 * load, power) for one in by_elements) == (load > 0), "it touches without a load"


def test_a_state_without_its_further_rows_may_touch_at_a_load_that_they_carry():
    beam, found, by_elements = beams(1, (16, 29), 0.1)
    load = least_load(found, 0.1 * beam.gap, beam.gap, 2)
    outer = by_elements[[state.rows for state in found].index((1,))]
    alone = OneSided(outer.elements, outer.way, (29,), (0,))
    assert outer.stands(load, 2)
    assert not alone.stands(load, 2)
