"""How fine elements and contact points must be: release of a beam on uniform ground (App. C)."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from stiction.beam.cantilever import Beam
from stiction.beam.energy import apparent_adhesion_energy
from stiction.beam.release import EndState, released_beam
from stiction.contact.forcelaw import energy
from stiction.numbers import is_multiple


@dataclass(frozen=True)
class Arrest:
    """Arrest of the crack of a beam on uniform ground."""

    crack_length: float  #: l_s [m]
    energy: float  #: Γ of Eq. (13) [J m⁻²]


def arrest_on_uniform_ground(beam: Beam, law: np.ndarray, points: int) -> Arrest:
    """Release a beam whose ``points`` contact points all have one law [f_max, d_max, a_left, a_right].

    Both numbers of the result are NaN if the beam does not stick in an S-shape.

    Raises
    ------
    ValueError
        If the crack is too short for the elements to resolve it.
    """
    end = released_beam(beam, np.tile(law, (points, 1)), float(energy(law)))
    if end.state != EndState.S_SHAPE:
        return Arrest(np.nan, np.nan)
    return Arrest(end.crack_length, apparent_adhesion_energy(end.crack_length, beam))


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
    whole = [(e, p) for e, p in pairs if is_multiple(length, e) and is_multiple(e, p)]
    if not whole:
        raise ValueError(
            f"no elements of {element_lengths} m with points {point_distances} m apart divide {length} m evenly"
        )
    return whole
