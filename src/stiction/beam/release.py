"""Release of a beam after it was pressed down: its crack opens until the adhesion arrests it (Sec. III-C).

A crack of length l drives its front with the energy release rate of Eq. (13), which falls as l⁻⁴. No place arrests it
while that exceeds the largest adhesion energy along the beam. The crack therefore starts at a safe fraction of the
length at which it would stop on the strongest place.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from stiction.beam.cantilever import Beam
from stiction.beam.energy import arrest_length
from stiction.beam.equilibrium import Equilibrium, distances, equilibrate
from stiction.contact import forcelaw

#: First crack length, relative to the one that Eq. (13) predicts from the largest adhesion energy along the beam, or to
#: the length of the beam if that is shorter.
START = 0.7
#: A crack that opens by less than this factor may have started beyond a place of arrest. On uneven ground the beam is
#: bent between its contact points, which can arrest a crack that Eq. (13) would open; otherwise it opens by 1 / START.
OPENS = 1.35
#: Deepest start of any point below its d_max, in lengths 1/a_left. Each makes a law stiffer by e², and beyond 18 the
#: linear system loses all other stiffness to rounding. Points on the surfaces of the paper start within 14.
PRESSED = -np.log(np.finfo(float).eps) / 2


class EndState(IntEnum):
    """Final configuration of a released beam."""

    S_SHAPE = 0  #: adheres beyond the crack
    #: Only the tip adheres. How many beams end so depends on the length of the strips, see `stiction.devices.arcs`.
    ARC = 1
    FREE = 2  #: no contact

    @property
    def label(self) -> str:
        """Name in datasets, tables and figures."""
        return ("S-shape", "arc", "free")[self]


@dataclass(frozen=True)
class ReleasedBeam:
    """Equilibrium of a released beam, its end state and its crack length."""

    equilibrium: Equilibrium
    state: EndState
    crack_length: float  #: l_s [m]; the length of the beam if it is free


def s_shape(beam: Beam, depth: float, crack: float) -> np.ndarray:
    """Deflection of a beam touching down at ``depth`` [m] beyond a crack [m], (elements + 1, 2) [m, -].

    It follows from u⁽⁴⁾ = 0 with u = u⁽¹⁾ = 0 at the clamp and u = depth, u⁽¹⁾ = 0 at the end of the crack; tension is
    left out.
    """
    s = np.minimum(beam.nodes / crack, 1)
    return depth * np.stack([s**2 * (3 - 2 * s), 6 * s * (1 - s) / crack], axis=-1)


def touching(laws: np.ndarray) -> float:
    """Distance at which a flat beam starts [m]: f = 0 for the mean law, or farther if that presses some law too far.

    Laws of rough surfaces differ in d_max by many lengths 1/a, over each of which the repulsion grows by e².
    """
    _, d_max, a_left, _ = laws.T
    return max(np.mean(d_max - np.log(2) / a_left), np.max(d_max - PRESSED / a_left))


def release(beam: Beam, laws: np.ndarray, start_crack: float) -> Equilibrium:
    """Release a beam from a short crack. The crack opens up to the first place of arrest (Sec. III-C).

    Parameters
    ----------
    beam : Beam
    laws : (points, 4) float64
        Rows [f_max, d_max, a_left, a_right], SI.
    start_crack : float
        First crack length [m], at least two elements. A crack that does not open by the factor `OPENS` starts again at
        half the length, so that the result does not depend on the start.

    Raises
    ------
    ValueError
        If the crack is too short for the elements to resolve it.
    NotConverged
        If no equilibrium is found.
    """
    # DEPARTS: no load presses the beam down. Beyond the first crack it adheres to the ground, in equilibrium, as a load
    # would leave it; then the crack creeps, so that it cannot pass an arrest.
    while not start_crack < 2 * beam.element_length:
        held = int(np.searchsorted(beam.nodes, start_crack, side="right")) - 1
        start = s_shape(beam, beam.gap - touching(laws), beam.nodes[held])
        end = equilibrate(beam, laws, start, held=held)
        if crack_length(beam, laws, end.deflection) > OPENS * start_crack:
            return end
        start_crack /= 2
    raise ValueError(
        f"elements of {1e6 * beam.element_length:.3g} µm do not resolve a crack of {1e6 * start_crack:.3g} µm: use "
        "more elements along the beam"
    )


def crack_length(beam: Beam, laws: np.ndarray, deflection: np.ndarray) -> float:
    """First place from the clamp, between points, with d < d_max, or the whole length without any [m].

    ASSUME: the paper does not define the end of a crack; here it is where the attraction has passed its maximum.
    """
    excess = distances(beam, laws, deflection) - laws[:, 1]
    r = int(np.argmax(excess < 0))
    if excess[r] >= 0:
        return beam.length
    before = excess[r - 1] if r else np.inf
    behind = excess[r] / (before - excess[r]) if r else 0.0
    return (r + 0.5 + behind) * beam.length / len(laws)


def end_state(beam: Beam, laws: np.ndarray, deflection: np.ndarray) -> EndState:
    """Final state of a beam: S-shape, arc or free.

    ASSUME: at the end of its crack an arc has the slope 3h/2l of a cantilever on a simple support, an S-shape none; a
    beam is classified by the nearer of the two. The paper mentions S-shapes only.
    """
    if np.all(distances(beam, laws, deflection) >= laws[:, 1]):
        return EndState.FREE
    crack = crack_length(beam, laws, deflection)
    slope = np.interp(crack, beam.nodes, deflection[:, 1])
    return EndState.ARC if slope > 0.75 * beam.gap / crack else EndState.S_SHAPE


def released_beam(beam: Beam, laws: np.ndarray) -> ReleasedBeam:
    """Release a beam from a crack too short to be arrested at any place along it.

    Raises
    ------
    ValueError, NotConverged
        As `release`.
    """
    start = START * min(arrest_length(forcelaw.energy(laws).max(), beam), beam.length)
    end = release(beam, laws, max(start, 2 * beam.element_length))
    return ReleasedBeam(end, end_state(beam, laws, end.deflection), crack_length(beam, laws, end.deflection))
