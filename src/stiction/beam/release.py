"""Release of a beam that was pressed down: its crack opens until the adhesion arrests it (Sec. III-C)."""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from stiction.beam import tension
from stiction.beam.cantilever import Beam
from stiction.beam.energy import arrest_length
from stiction.beam.equilibrium import Equilibrium, distances, equilibrate

#: Crack length under the artificial load, relative to the one that Eq. (13) predicts from the mean adhesion energy.
START = 1 / 3
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


def holding_load(beam: Beam, crack: float) -> float:
    """Uniform load that presses a beam without adhesion to an S-shape of this crack length, 72 EI h / l⁴ [N/m].

    It follows from EI u⁽⁴⁾ = q with u = u⁽¹⁾ = 0 at the clamp and u = h, u⁽¹⁾ = u⁽²⁾ = 0 at the end of the crack.
    """
    if beam.tension:
        return tension.holding_load(beam, crack)
    return 72 * beam.bending_stiffness * beam.gap / crack**4


def s_shape(beam: Beam, depth: float, crack: float) -> np.ndarray:
    """Deflection under `holding_load` of a beam that touches down at ``depth`` [m]; (elements + 1, 2) [m, -].

    That of a beam without tension; for others it is where the search for the equilibrium starts.
    """
    s = np.minimum(beam.nodes / crack, 1)
    return depth * np.stack([s**2 * (6 - 8 * s + 3 * s**2), 12 * s * (1 - s) ** 2 / crack], axis=-1)


def _touching(laws):
    """Distance at which a flat beam starts [m]: f = 0 for the mean law, or farther where that presses some law too far.

    Laws of rough surfaces differ in d_max by many lengths 1/a, over each of which the repulsion grows by e².
    """
    _, d_max, a_left, _ = laws.T
    return max(np.mean(d_max - np.log(2) / a_left), np.max(d_max - PRESSED / a_left))


def _release_from(beam, laws, crack):
    """Press a beam down to a crack length [m], then remove the load; returns the equilibrium."""
    start = s_shape(beam, beam.gap - _touching(laws), crack)
    held = equilibrate(beam, laws, start, holding_load(beam, crack))
    return equilibrate(beam, laws, held.deflection)


def release(beam: Beam, laws: np.ndarray, start_crack: float) -> Equilibrium:
    """Press a beam down and release it: the crack opens up to the first place that arrests it (Sec. III-C).

    Parameters
    ----------
    beam : Beam
    laws : (points, 4) float64
        Rows [f_max, d_max, a_left, a_right], SI.
    start_crack : float
        Crack length under the artificial load [m], well below the expected one. A beam that does not open by half of it
        is pressed down again on half the length, so that the result does not depend on the start.

    Raises
    ------
    ValueError
        If the crack is too short for the elements to resolve it.
    NotConverged
        If no equilibrium is found.
    """
    # DEPARTS: the load is removed at once, not progressively: the beam creeps, so that the crack cannot pass an arrest.
    while not start_crack < 2 * beam.element_length:
        end = _release_from(beam, laws, start_crack)
        if crack_length(beam, laws, end.deflection) > 1.5 * start_crack:
            return end
        start_crack /= 2
    raise ValueError(
        f"elements of {1e6 * beam.element_length:.3g} µm do not resolve a crack of {1e6 * start_crack:.3g} µm: use "
        "more elements along the beam"
    )


def crack_length(beam: Beam, laws: np.ndarray, deflection: np.ndarray) -> float:
    """First place from the clamp, between points, where d < d_max; the whole length if there is none [m].

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
    """Whether a beam ends S-shaped, as an arc or free.

    ASSUME: at the end of its crack an arc has the slope 3h/2l of a cantilever on a simple support, an S-shape none; a
    beam is classified by the nearer of the two. The paper mentions S-shapes only.
    """
    if np.all(distances(beam, laws, deflection) >= laws[:, 1]):
        return EndState.FREE
    crack = crack_length(beam, laws, deflection)
    slope = np.interp(crack, beam.nodes, deflection[:, 1])
    return EndState.ARC if slope > 0.75 * beam.gap / crack else EndState.S_SHAPE


def released_beam(beam: Beam, laws: np.ndarray, energy: float) -> ReleasedBeam:
    """`release` from a start that is well below the crack length that Eq. (13) predicts from an adhesion energy [J
    m⁻²].

    The energy is that which is expected, for example the mean of the laws.

    Raises
    ------
    ValueError, NotConverged
        As `release`.
    """
    end = release(beam, laws, START * min(arrest_length(energy, beam), beam.length))
    return ReleasedBeam(end, end_state(beam, laws, end.deflection), crack_length(beam, laws, end.deflection))
