r"""Full elastic contact of a rough strip, by boundary elements (not in the paper).

A second model of the contact of a pair, with which the sum over summits is compared: every element acts on every other,
summits have their true shape, and the attraction of water and solids deforms the surfaces. With the pressure p >= 0 of
the solids, the attraction q >= 0, and the displacement K of `stiction.contact.full.halfspace`,

.. math:: g = d - z + K (p - q) , \quad g \ge 0 , \quad p g = 0 , \quad q = q(g) , \quad f = \bar p - \bar q .

The energy U is 0 at infinity, so that the adhesion energy is that of the one state without force:

.. math:: e = -U(f = 0) , \quad U = \tfrac12 \overline{(p - q) K (p - q)} + \overline{w(g)} , \quad \frac{dU}{dd} = -f .

The distance d is the one between the mean planes of the deformed surfaces if the strip repeats. Other surroundings,
which displace all elements alike by p - q, change d by a multiple of f: distances depend on them, e and f_max do not.

Solids may also yield: elements press with the hardness H at most, and overlap where that does not hold the surfaces
apart. The overlap is flattening that remains (`State.flattening`), and the flattened surface carries the same pressures
elastically: p = H where g < 0.

Solids can also attract each other across the gaps between them, with the work of `stiction.contact.gaps` at the gaps of
the deformed surfaces.

ASSUME: solids are linearly elastic up to the hardness, perfectly plastic beyond, without material that piles up beside
the flattened tops, and frictionless, and slopes are small. Where several states have the same distance, the
strip is in the one that it reaches during separation, from the state without force; that one begins without attraction.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from operator import itemgetter

import numpy as np

from stiction.contact.environment import Gaps
from stiction.contact.forcelaw import extremum, limit_distance
from stiction.contact.full.halfspace import OWN_DISPLACEMENT, HalfSpace
from stiction.contact.vanderwaals import DugdaleAttraction
from stiction.errors import NotConverged
from stiction.kernels import kernel

#: Largest gap or overlap of an element in contact [m]: 1 % of the range of van der Waals forces.
TOLERANCE = 2e-12
#: Largest relative change of the attraction in the last turn.
SETTLED = 2e-3
#: In each turn, the pressure is computed to this share of the gaps and overlaps that the new attraction causes.
SHARE = 0.3
#: The attraction of each turn goes beyond that of the last gap by this factor, because turns approach from one side.
RELAXATION = 1.4
#: The first state of a search for one without force, which only says how far that is, settles this many times less.
FIRST = 10
#: Share of the adhesion energy that a force may leave where it is taken to vanish.
ENERGY_LEFT = 1e-3
#: Spacing of the tables of the attraction across gaps [m].
GAP_STEP = 0.02e-9
#: Gaps of these tables [m], to where flats have 1e-5 of the work of flats that touch. ASSUME: no attraction beyond.
GAPS = np.arange(0, 300e-9, GAP_STEP)
#: Most turns of the attraction, displacements in each, and distances in the search for one state.
TURNS, STEPS, STATES = 40, 1000, 60
#: Distances in the search after which its steps away from contact grow.
SHORT = 20
_UNSETTLED = (
    "full elastic contact does not settle, with surfaces too smooth or a solid too soft for the grid: decrease "
    "sampling.spacing_nm"
)


@dataclass(frozen=True)
class Adhesion:
    """Attraction of two surfaces over their gap: a film of water, and van der Waals forces as a Dugdale stress.

    The edge of the latter is a ramp of the same energy. It is twice as wide as the displacement of one element under
    the stress: with a step, an element could feel all of the stress or none of it at the same distance. Attraction
    across gaps is a table of its work beyond film and stress.
    """

    height: float  #: h_C of the film [m]
    tension: float  #: -ΔP in it [Pa]
    stress: float = 0.0  #: -σ_vdW [Pa]
    reach: float = 0.0  #: h_vdW [m]
    ramp: float = 1e-10  #: width of its edge [m]
    work: np.ndarray | None = None  #: across the gaps `GAPS`, if solids attract each other there [J m⁻²]

    @classmethod
    def from_film(
        cls,
        film: tuple[float, float],
        solids: DugdaleAttraction | None,
        space: HalfSpace,
        across: Gaps | None = None,
    ) -> "Adhesion":
        """Adhesion of a film (height, tension), see `stiction.contact.meniscus.film`, and van der Waals forces or none.

        Solids with van der Waals forces can attract each other ``across`` gaps as well.

        Raises
        ------
        ValueError
            If the elements are too large to resolve the van der Waals forces.
        """
        if solids is None:
            return cls(*film)
        ramp = 2 * OWN_DISPLACEMENT * space.unit * solids.stress
        if ramp > 2 * solids.range:
            enough = 0.99e9 * space.spacing * 2 * solids.range / ramp  # [nm]
            raise ValueError(
                f"full elastic contact needs a finer grid: van der Waals forces displace an element of "
                f"{space.spacing:.3g} m by {ramp / 2:.3g} m, more than their range of {solids.range:.3g} m; decrease "
                f"sampling.spacing_nm to {enough:.3g}"
            )
        touching = cls(*film, solids.stress, solids.range, ramp)
        return touching._reaching(across) if across else touching

    def _reaching(self, gaps):
        """Adhesion with the work across gaps beyond film and stress.

        ASSUME: in the range of the stress, the solids pull across gaps as where the range ends. The stress is weaker by
        as much: flats that touch need the work of Eq. (10) in all, and under a film what the solids have beyond it.
        """
        work, end = gaps.work(GAPS, self.height), int(np.searchsorted(GAPS, self.reach + self.ramp / 2))
        line = work[end] + (work[end] - work[end + 1]) * (end - np.arange(end))
        stress = self.stress + (work[0] - line[0]) / self.reach
        return replace(self, stress=float(stress), work=np.concatenate([line, work[end:]]))

    @cached_property
    def _pull(self):
        """Negative derivative of the work across gaps, at `GAPS`, float32 [Pa]."""
        return -np.gradient(self.work, GAP_STEP).astype(np.float32)

    def traction(self, gap: np.ndarray) -> np.ndarray:
        """Attraction q at gaps [Pa], of their shape, float32."""
        law = np.float32([self.height, self.tension, self.stress, self.reach + self.ramp / 2, self.ramp])
        gaps = np.ravel(gap).astype(np.float32, copy=False)
        traction = _traction(gaps, *law)
        if self.work is not None:
            _add_table(traction, gaps, self._pull, np.float32(1 / GAP_STEP))
        return traction.reshape(np.shape(gap))

    def energy(self, gap: np.ndarray) -> np.ndarray:
        """Energy w per area at gaps >= 0, of their shape, negative [J m⁻²]."""
        gaps = np.ravel(gap).astype(float, copy=False)
        work = _work(gaps, self.height, self.tension, self.stress, self.reach + self.ramp / 2, self.ramp)
        if self.work is not None:
            _add_table(work, gaps, self.work, 1 / GAP_STEP)
        return -work.reshape(np.shape(gap))


@dataclass(frozen=True)
class State:
    """Strip in equilibrium at a distance."""

    distance: float  #: d [m]
    pressure: np.ndarray  #: p (n1, n2) [Pa]
    attraction: np.ndarray  #: q (n1, n2) [Pa]
    gap: np.ndarray  #: g (n1, n2) [m]
    turns: int  #: of the attraction
    hardness: float = np.inf  #: largest pressure [Pa]

    @property
    def force(self) -> float:
        """Per apparent area f, positive in repulsion [Pa]."""
        return _mean(self.pressure) - _mean(self.attraction)

    def energy(self, heights: np.ndarray, adhesion: Adhesion) -> float:
        """Energy U per apparent area of a strip of heights z (n1, n2), stationary in the errors of p and q [J m⁻²]."""
        displacement = self.gap - (np.float32(self.distance) - heights)
        elastic = (self.pressure - self.attraction) * displacement / 2
        # p g is zero in equilibrium; without it, U would have the error of p to first order.
        return _mean(elastic - self.pressure * self.gap) + _mean(adhesion.energy(np.maximum(self.gap, 0)))

    @property
    def residual(self) -> float:
        """Largest gap of an element in contact, and overlap of one below the hardness [m]."""
        return float(_residual(self.pressure, self.gap, np.float32(self.hardness)))

    @property
    def flattening(self) -> np.ndarray:
        """Overlap of the elements at the hardness, the later decrease of their heights (n1, n2) [m]."""
        return np.where(self.pressure >= np.float32(self.hardness), np.maximum(-self.gap, 0), np.float32(0))


def _mean(values):
    return float(values.mean(dtype=float))


def equilibrium(
    space: HalfSpace,
    heights: np.ndarray,
    distance: float,
    adhesion: Adhesion | None = None,
    start: State | None = None,
    hardness: float = np.inf,
    coarser: float = 1.0,
) -> State:
    """State of a strip of heights z (n1, n2) float32 [m] at a distance d [m]. Elastic, without attraction by default.

    It begins with the pressure and the attraction of another state, by default with contact without attraction, and
    settles ``coarser`` times less than to `SETTLED` and `TOLERANCE`.

    Raises
    ------
    NotConverged
        If pressure or attraction do not settle.
    """
    undeformed = np.float32(distance) - heights
    if start is None:
        zeros = np.zeros_like(undeformed)
        pressure, gap, _ = _supported(space, undeformed, zeros, zeros, hardness, coarser * TOLERANCE)
        start = State(distance, pressure, zeros, gap, 0, hardness)
        if adhesion is None:
            return start
        attraction = adhesion.traction(gap)
    else:
        pressure, attraction = start.pressure, start.attraction
    for turn in range(1, TURNS + 1):
        pressure, gap, before = _supported(space, undeformed, pressure, attraction, hardness, TOLERANCE, SHARE)
        relaxed, change, size = _relaxed(adhesion.traction(gap), attraction, np.float32(RELAXATION))
        residual = change / max(size, 1.0)
        if residual <= coarser * SETTLED and before <= 5 * coarser * TOLERANCE:
            return State(distance, pressure, attraction, gap, turn, hardness)
        attraction = relaxed
    raise NotConverged(f"{_UNSETTLED}: change of the attraction", residual, SETTLED, TURNS)


@kernel
def _traction(gap, height, tension, stress, end, ramp):
    """Attraction q at gaps (n,) [Pa]: of a film up to its height, and a stress with a ramp at its end."""
    traction, none = np.empty_like(gap), np.float32(0)
    for i in range(gap.size):
        inside = _larger(end - gap[i], none)
        traction[i] = (tension if gap[i] < height else none) + stress * (inside / ramp if inside < ramp else 1)
    return traction


@kernel
def _work(gap, height, tension, stress, end, ramp):
    """Work of `_traction` from gaps (n,) on [J m⁻²]."""
    work = np.empty_like(gap)
    for i in range(gap.size):
        inside = _larger(end - gap[i], 0.0)
        near = inside * inside / (2 * ramp) if inside < ramp else inside - ramp / 2
        work[i] = tension * _larger(height - gap[i], 0.0) + stress * near
    return work


@kernel
def _add_table(values, gap, table, per_gap):
    """Add a table, equally spaced from the gap 0 and linear in between, to values at gaps (n,), all of one precision.

    Nodes ``per_gap`` [m⁻¹]. The table is that of its first node at overlaps, and zero beyond its last.
    """
    for i in range(gap.size):
        position = _larger(gap[i] * per_gap, np.float32(0))
        node = np.int64(position)
        if node < table.size - 1:
            values[i] += table[node] + (position - np.float32(node)) * (table[node + 1] - table[node])


@kernel
def _relaxed(target, attraction, factor):
    """Attraction (n1, n2) after a part of the way to the wanted one, mean size of this way and of the attraction.

    All in Pa.
    """
    relaxed, columns = np.empty_like(attraction), attraction.shape[1]
    changes, sizes = np.zeros(columns), np.zeros(columns)
    for i in range(attraction.shape[0]):
        for j in range(columns):
            change = target[i, j] - attraction[i, j]
            changes[j] += abs(change)
            sizes[j] += abs(attraction[i, j])
            relaxed[i, j] = attraction[i, j] + factor * change
    return relaxed, changes.sum() / attraction.size, sizes.sum() / attraction.size


def _supported(space, undeformed, pressure, attraction, hardness, tolerance, share=0.0):
    """Pressure 0 <= p <= H without overlap at p < H, p and gap (n1, n2) [Pa], [m], and the first residual [m].

    Projected gradients with the steps of J. Barzilai and J. M. Borwein, IMA J. Numer. Anal. 8, 141 (1988), of one
    displacement each. Conjugate gradients need two wherever the projection changes their direction, which is nearly
    always here, and twice as many displacements in all.

    The residual is reduced to a tolerance [m], or to a share of that at the beginning.
    """
    gap, hardness = undeformed + space.displacement(pressure - attraction), np.float32(hardness)
    first = residual = _residual(pressure, gap, hardness)
    step = first_step = 0.5 / space.unit
    for _ in range(STEPS):
        if residual <= max(tolerance, share * first):
            return pressure, gap, first
        descended, traction = _descended(pressure, gap, attraction, np.float32(step), hardness)
        displacement = space.displacement(traction)
        after, step, residual = _moved(pressure, gap, descended, undeformed, displacement, hardness)
        pressure, gap, step = descended, after, step or first_step
    raise NotConverged(f"{_UNSETTLED}: gap of an element in contact [m]", residual, tolerance, STEPS)


@kernel
def _descended(pressure, gap, attraction, step, hardness):
    """Pressure in [0, H] after a step against the gap, and the pressure less the attraction (n1, n2) each [Pa]."""
    descended, traction = np.empty_like(pressure), np.empty_like(pressure)
    for i in range(pressure.shape[0]):
        for j in range(pressure.shape[1]):
            descended[i, j] = min(max(pressure[i, j] - step * gap[i, j], np.float32(0)), hardness)
            traction[i, j] = descended[i, j] - attraction[i, j]
    return descended, traction


# Sums and maxima are taken along each column first, so that the compiler can take those of several columns at once.
@kernel
def _moved(pressure, gap, descended, undeformed, displacement, hardness):
    r"""Gap after a step (n1, n2) [m], the next step of Barzilai and Borwein [Pa m⁻¹], and the residual [m].

    The next step is over elements in contact or overlap, and 0 if there are none. Elements that overlap at the hardness
    stay as they are.

    .. math:: \alpha = \frac{\Delta p \cdot \Delta g}{\Delta g \cdot \Delta g}
    """
    after, columns, none = np.empty_like(gap), gap.shape[1], np.float32(0)
    mixed, square, largest = np.zeros(columns), np.zeros(columns), np.zeros(columns, np.float32)
    for i in range(gap.shape[0]):
        for j in range(columns):
            now, carried = undeformed[i, j] + displacement[i, j], descended[i, j]
            yields, overlaps = carried == hardness, now < 0
            moves = overlaps & (not yields) | (carried > 0) & (not overlaps)
            change = np.float64(now - gap[i, j] if moves else none)
            mixed[j] += (carried - pressure[i, j]) * change
            square[j] += change * change
            largest[j] = _larger(largest[j], _error(carried, now, hardness))
            after[i, j] = now
    slope = mixed.sum()
    return after, slope / square.sum() if slope > 0 else 0.0, largest.max()


@kernel
def _residual(pressure, gap, hardness):
    """Largest gap of an element in contact, and overlap of one below the hardness [m]."""
    largest = np.zeros(gap.shape[1], np.float32)
    for i in range(gap.shape[0]):
        for j in range(gap.shape[1]):
            largest[j] = _larger(largest[j], _error(pressure[i, j], gap[i, j], hardness))
    return largest.max()


@kernel(inline="always")
def _error(pressure, gap, hardness):
    """Gap of an element in contact, or overlap of one below the hardness, else 0 [m]."""
    none = np.float32(0)
    return _larger(gap if pressure > 0 else none, -gap if pressure < hardness else none)


@kernel(inline="always")
def _larger(first, second):
    """Larger of two numbers, without the branch of max for NaN."""
    return first if first > second else second


#: State at a distance by elements, heights, distance, adhesion, a state before it, and how much coarser; `equilibrium`.
Settle = Callable[..., State]


@dataclass(frozen=True)
class Separation:
    """Strip from the state without force to the largest attraction."""

    adhesion_energy: float  #: e [J m⁻²]
    pull_off: float  #: f_max [Pa]
    closed: State  #: without force
    states: int  #: number of distances


def separation(
    space: HalfSpace,
    heights: np.ndarray,
    adhesion: Adhesion,
    curve: tuple[np.ndarray, np.ndarray],
    settle: Settle | None = None,
    end: float = 0.0,
) -> Separation:
    """Adhesion energy and largest attraction of a strip of heights z (n1, n2) float32 [m].

    Parameters
    ----------
    curve : tuple of 2 (n,) arrays
        Distances and forces of another model, which lead to the distance without force [m], [Pa]. A third of the
        difference between its distances without force and of the largest attraction is the step between distances, and
        a third of that near the largest attraction.
    settle : callable, optional
        Solver of one state, by default `equilibrium`.
    end : float, optional
        Distance up to which a larger attraction is sought [m], by default that of the largest attraction of ``curve``.

    Raises
    ------
    NotConverged
        If a state does not settle.
    ValueError
        If no distance without force is found, or no largest attraction.
    """
    closed, states = at_rest(space, heights, adhesion, curve, settle, end)
    pull_off, number = pulled_off((space, heights, adhesion), closed, curve, settle, end)
    return Separation(-closed.energy(heights, adhesion), pull_off, closed, states + number)


def pulled_off(
    strip: tuple[HalfSpace, np.ndarray, Adhesion],
    closed: State,
    curve: tuple[np.ndarray, np.ndarray],
    settle: Settle | None = None,
    end: float = 0.0,
) -> tuple[float, int]:
    """Largest attraction of a strip from its state without force [Pa], and the number of distances.

    The strip is elements, heights and adhesion. Other parameters and errors as of `separation`.
    """
    at, step = _states_of(strip, settle), _step(curve)
    coarse, before = _beyond_extremum(at, closed, step, max(extremum(*curve)[0], end))
    fine, _ = _beyond_extremum(at, before, step / 3, before.distance + step)
    return _largest_attraction(coarse, fine), len(coarse) + len(fine) - 2


def roughly_pulled_off(
    strip: tuple[HalfSpace, np.ndarray, Adhesion],
    closed: State,
    curve: tuple[np.ndarray, np.ndarray],
    settle: Settle | None = None,
) -> float:
    """Largest attraction [Pa] as of `pulled_off`, by a parabola through steps three times as long.

    On 8 strips of pair b at RH 0.44, it is 1.5 to 3 % smaller, and as good a control of other strips.
    """
    coarse, _ = _beyond_extremum(_states_of(strip, settle), closed, _step(curve), extremum(*curve)[0])
    return extremum(*np.transpose(coarse))[1]


def _states_of(strip, settle):
    """Function of a distance [m] and a state before it, which gives the state there."""
    space, heights, adhesion = strip
    return lambda distance, before: (settle or equilibrium)(space, heights, distance, adhesion, before)


def at_rest(
    space: HalfSpace,
    heights: np.ndarray,
    adhesion: Adhesion,
    curve: tuple[np.ndarray, np.ndarray],
    settle: Settle | None = None,
    end: float = 0.0,
) -> tuple[State, int]:
    """State without force, with the adhesion energy, and the number of states. Parameters of `separation`."""

    def at(distance, before, coarser=1.0):
        """State at a distance [m], from a state before it, on a coarser tolerance."""
        return (settle or equilibrium)(space, heights, distance, adhesion, before, coarser=coarser)

    return _without_force(at, curve, lambda state: state.energy(heights, adhesion), end)


def _step(curve):
    """Step between distances [m]."""
    return (extremum(*curve)[0] - limit_distance(*curve, 0.0)) / 3


def _largest_attraction(coarse, fine):
    """Largest attraction [Pa] of states in steps, and in finer steps from before it: distances and forces each.

    ASSUME: where finer steps leave the states of the others at once, and attract less, these have the largest one.
    """
    if min(fine, key=itemgetter(1)) == fine[0]:
        return -min(force for _, force in coarse)
    return extremum(*np.transpose(fine))[1]


def _beyond_extremum(at, state, step, end):
    """Distances and forces, in steps, beyond the largest attraction and a distance. State a step before the former.

    Where the surfaces repel each other again, on their highest point, more attraction may follow.
    """
    curve, before = [(state.distance, state.force)], state
    lowest, falls, most = state.force, True, _most(state, step, end)
    while falls or state.force > 0 or state.distance < end:
        last, state = state, at(state.distance + step, state)
        falls = state.force < lowest  # not where a film floods everything and the force no longer changes
        if falls:
            lowest, before = state.force, last
        curve.append((state.distance, state.force))
        _refuse_after(len(curve), most)
    return curve, before


def _without_force(at, curve, energy, end=0.0):
    """State without force, and number of states. ``at(distance, before, coarser)`` is a state after another.

    The curve of another model, shifted to the force of the first state, leads near it, steps to a change of sign, and
    secants to a force too small to change the energy. More steps are taken if they lead to the ``end``.

    The other model misses peaks at the rim of a strip, which are no summits. Steps away from contact grow after the
    first ones, and halves take the place of secants where these would end in the tail of the attraction.
    """
    state, number, step = at(limit_distance(*curve, 0.0), None, FIRST), 1, _step(curve)
    ends, most = {state.force > 0: state}, _most(state, step, end)
    move = _shift(curve, state.force, step)
    longest, stride, first = max(abs(move), step), step, state
    while True:
        before, state, number = state, at(state.distance + move, state), number + 1
        earlier, ends[state.force > 0] = ends.get(False, first), state
        is_compared = state.force <= 0 and earlier is not first
        is_tail = is_compared and state.force < earlier.force and state.distance < earlier.distance
        near, far = (ends[True], ends[False]) if len(ends) == 2 else (before, state)
        width, drop = far.distance - near.distance, near.force - far.force
        left = 0.5 * state.force**2 * width / drop if width * drop > 0 else np.inf
        is_before = state.force > 0 or width <= step or is_compared and not is_tail  # the largest attraction
        if left < ENERGY_LEFT * abs(energy(state)) and width <= longest and is_before:
            return state, number
        if len(ends) == 2:
            share = 0.5 if width > longest or is_tail else near.force / drop
            move = near.distance + share * width - state.distance
        else:
            stride *= 2 if number > SHORT and state.force > 0 else 1
            move = stride if state.force > 0 else -step
        _refuse_after(number, most)


def _shift(curve, force, step):
    """Distance between a repulsive force and none in the curve of another model [m], or a step towards it."""
    if force <= 0:
        return -step
    try:
        return limit_distance(*curve, 0.0) - limit_distance(*curve, force)
    except ValueError:
        return step  # no distance of the curve has this force


def _most(state, step, end):
    """Largest number of states from one that may be steps away from an end."""
    return STATES + max(0, int((end - state.distance) / step))


def _refuse_after(states, most):
    if states > most:
        raise ValueError(
            "full elastic contact finds no distance at which the surfaces come to rest: they are too smooth or the "
            "solid is too soft to resist the adhesion"
        )
