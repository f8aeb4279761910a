"""Fineness of elements and contact points: release of a beam on uniform ground (App. C)."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import ceil

import numpy as np

from stiction.beam.cantilever import Beam
from stiction.beam.energy import apparent_adhesion_energy
from stiction.beam.foundation import ELEMENT, STRIP, foundation_length
from stiction.beam.release import EndState, released_beam
from stiction.contact.forcelaw import adhesion_energy, energy, pressure
from stiction.rounding import is_multiple

#: Number of distances at which the mean of force laws is evaluated.
_NODES = 20_000


@dataclass(frozen=True)
class Arrest:
    """Arrest of the crack of a beam on uniform ground."""

    crack_length: float  #: l_s [m]
    energy: float  #: Γ of Eq. (13) [J m⁻²]


def arrest_on_uniform_ground(beam: Beam, law: np.ndarray, points: int) -> Arrest:
    """Release a beam on uniform ground: all ``points`` contact points have one law [f_max, d_max, a_left, a_right].

    Both numbers of the result are NaN if the beam does not stick in an S-shape.

    Raises
    ------
    ValueError
        If the crack is too short for the elements to resolve it.
    NotConverged
        If no equilibrium is found, for example because the elements are much longer than the foundation length.
    """
    end = released_beam(beam, np.tile(law, (points, 1)))
    if end.state != EndState.S_SHAPE:
        return Arrest(np.nan, np.nan)
    return Arrest(end.crack_length, apparent_adhesion_energy(end.crack_length, beam))


def finer_mesh(beam: Beam, law: np.ndarray, points: int) -> tuple[Beam, int]:
    """Beam and number of points of a mesh at least twice as fine, and twice as fine as the law requires.

    Elements are then wrong by an eighth, points by a quarter: ``tests/beam/test_release.py``.
    """
    length = foundation_length(beam, law[None])
    fine = points * max(2, ceil(2 * beam.length / points / (STRIP * length)))
    element = min(beam.element_length, ELEMENT * length) / 2
    multiples = (n for n in range(beam.elements, fine + 1) if fine % n == 0 and beam.length / n <= element)
    return replace(beam, elements=next(multiples)), fine


@dataclass(frozen=True)
class Resolution:
    """Arrest on uniform ground on the mesh in use and on a finer one."""

    coarse: Arrest
    fine: Arrest
    law: np.ndarray  #: force law of the ground [SI]

    @property
    def error(self) -> float:
        """Relative error of the crack length on the mesh in use [-]."""
        return self.coarse.crack_length / self.fine.crack_length - 1

    @property
    def excess(self) -> float:
        """Γ of Eq. (13) on the finer mesh, relative to the energy of the law [-].

        It is above 1, because the crack ends where the distance falls below d_max, before the beam is flat.
        """
        return self.fine.energy / float(energy(self.law))


def resolution(beam: Beam, law: np.ndarray, points: int) -> Resolution:
    """Effect of the mesh of a beam on its crack on uniform ground. Raises as `arrest_on_uniform_ground`."""
    used = arrest_on_uniform_ground(beam, law, points)
    finer, more = finer_mesh(beam, law, points)
    return Resolution(used, arrest_on_uniform_ground(finer, law, more), law)


def rigid_energy(laws: np.ndarray) -> float:
    """Adhesion energy of the mean of force laws (n, 4), as for a beam too stiff to follow single strips [J m⁻²].

    It is at most the mean of their energies, because some strips already push while others still pull.
    """
    _, d_max, a_left, a_right = laws.T
    repulsive, decayed = d_max - np.log(4) / a_left, d_max + 20 / a_right
    distance = np.linspace(repulsive.min(), decayed.max(), _NODES)
    return float(adhesion_energy(distance, sum(pressure(law, distance) for law in laws) / len(laws)))


def whole_meshes(
    length: float, element_lengths: Iterable[float], point_distances: Iterable[float]
) -> list[tuple[float, float]]:
    """Pairs (element length, distance of points) [m]: whole points per element, whole elements per beam length [m].

    Raises
    ------
    ValueError
        If there is no such pair.
    """
    pairs = [(element, point) for point in point_distances for element in element_lengths]
    divisors = [(e, p) for e, p in pairs if is_multiple(length, e) and is_multiple(e, p)]
    if not divisors:
        raise ValueError(
            f"no elements of {element_lengths} m with points {point_distances} m apart divide {length} m evenly"
        )
    return divisors
