r"""Full elastic contact of a smooth strip, by descent in its energy (not in the paper).

The states are those of `stiction.contact.full.elements`. On smooth strips the attraction displaces the surfaces by more
than its range, and its turns there do not settle. Here the unknowns are the gaps g, and steps lower the energy:

.. math:: U(g) = \tfrac12 \overline{u K^{-1} u} + \overline{w(g)} , \quad u = g - (d - z) , \quad g \ge 0 , \quad
          \bar g = d - \bar z .

Its gradient r = K⁻¹ u + q(g) is p - f in equilibrium: the force -f is the multiplier of the mean gap, and p >= 0 are
those of closed gaps.

Each step follows the gradient as a half-space on springs would, with the same stiffness for nearly all waves, among the
elements that are open or about to open. It ends at the nearest gaps that are allowed, has the length of Barzilai and
Borwein, and is shortened until the energy is below the largest of the last few (E. G. Birgin, J. M. Martínez and M.
Raydan, SIAM J. Optim. 10, 1196 (2000)). The gradient alone takes six times as many steps, or does not settle.

ASSUME: where several states have the same distance, the strip is in one below the start of the descent: without
attraction for the first state, and with the gaps of the last one in proportion for others, so that none opens by that.
"""

from dataclasses import dataclass

import numpy as np

from stiction.contact.full import elements
from stiction.contact.full.elements import Adhesion, State
from stiction.contact.full.halfspace import HalfSpace
from stiction.errors import NotConverged
from stiction.kernels import kernel

#: Largest mean rest of the gradient in the last step, over the attraction or the force. With a tenth of it, e changes
#: by 0.004 % and f_max by 0.1 %.
SETTLED = 1e-3
#: Most steps of a descent, and halvings of one step.
STEPS, HALVINGS = 1500, 30
#: Energies of which a step must stay below the largest, by this share of the decrease that its gradient predicts.
REMEMBERED, DECREASE = 10, 1e-4
#: Relative rounding of an energy, which must not stop a descent.
ROUNDING = 1e-9
#: Length of the first step and largest one, as multiples of the displacement on springs.
FIRST, LONGEST = 1.0, 30.0
#: Length of a step down the gradient alone, where springs lead up, in units of Δ/E'. The stiffest wave has 0.3.
ALONE = 0.3


@dataclass(frozen=True)
class _Strip:
    """Strip at a distance, with functions of its gaps (n1, n2) float64 [m]."""

    space: HalfSpace
    undeformed: np.ndarray  #: d - z (n1, n2) float64 [m]
    adhesion: Adhesion

    def elastic(self, gap):
        """Traction K⁻¹ u of mean 0 (n1, n2) float32 [Pa]."""
        return self.space.traction((gap - self.undeformed).astype(np.float32))

    def energy(self, gap, elastic):
        """Energy U [J m⁻²]."""
        stored = 0.5 * _product(gap, self.undeformed, elastic)
        return stored + float(self.adhesion.energy(gap).mean())

    def moved(self, gap, elastic, way, bounds):
        """Gap after the first half, quarter, ... of a way that is short enough, its elastic traction and energy.

        ``bounds``: energy [J m⁻²] of which a step must stay below, and slope of the energy along the way [J m⁻²].
        """
        change, (largest, slope) = self.elastic(gap + way) - elastic, bounds
        for fraction in 0.5 ** np.arange(HALVINGS):
            ahead, traction = gap + fraction * way, elastic + np.float32(fraction) * change
            energy = self.energy(ahead, traction)
            if energy <= largest + DECREASE * fraction * slope:
                break
        return ahead, traction, energy


def equilibrium(
    space: HalfSpace,
    heights: np.ndarray,
    distance: float,
    adhesion: Adhesion,
    start: State | None = None,
    coarser: float = 1.0,
) -> State:
    """State of a periodic strip of heights z (n1, n2) float32 [m] at a distance d [m]. Elastic, under an attraction.

    The tension of a film ends in a step, where its energy has a ridge: no state ends there. The strip begins with the
    gaps of another state; without any, with those of contact without attraction. At distances without room
    for gaps, contact is complete, under the smallest force >= 0 that keeps it so.

    Raises
    ------
    NotConverged
        If the gradient does not settle to `SETTLED` of the attraction or the force, or ``coarser`` times that.
    """
    strip = _Strip(space, distance - heights.astype(float), adhesion)
    if (mean := strip.undeformed.mean()) <= 0:
        return _complete(space, heights, adhesion)
    if start is None or not start.gap.any():  # nothing is open that could open further
        start = elements.equilibrium(space, heights, distance)
    gap = start.gap.astype(float).clip(0)
    gap *= mean / gap.mean()
    elastic, step, before = strip.elastic(gap), FIRST, None
    pull, energies = adhesion.traction(gap), [strip.energy(gap, elastic)]
    for number in range(STEPS):
        gradient = elastic + pull
        force, residual = _balance(gap, gradient)
        size = max(float(pull.mean(dtype=float)), abs(force), 1.0)
        if residual <= coarser * SETTLED * size:
            pressure = np.where(gap > 0, np.float32(0), np.maximum(gradient + np.float32(force), 0))
            return State(distance, pressure, pull, gap.astype(np.float32), number)
        free_gradient = _among_free(gradient, gap, gradient, force)
        down = _among_free(space.displacement_on_springs(free_gradient), gap, gradient, force)
        if before is not None:
            step = _step(*before, free_gradient, down)
        way, slope = _way(gap, down, step, gradient, mean)
        if slope >= 0:
            way, slope = _way(gap, free_gradient, ALONE * space.unit, gradient, mean)
        largest = max(energies[-REMEMBERED:]) + ROUNDING * abs(energies[-1])
        after, elastic, energy = strip.moved(gap, elastic, way, (largest, slope))
        before, gap, pull = (after - gap, free_gradient, down), after, adhesion.traction(after)
        energies.append(energy)
    subject = "full elastic contact does not settle by descent: rest of the gradient"
    raise NotConverged(subject, residual / size, coarser * SETTLED, STEPS)


def _complete(space, heights, adhesion):
    """State without gaps, under the smallest force >= 0 without tension between the solids."""
    gap = np.zeros_like(heights)
    pull = adhesion.traction(gap)
    pressure = space.traction(heights) + pull
    pressure += max(-pressure.min(), np.float32(0))
    return State(float(heights.mean(dtype=float)), pressure, pull, gap, 0)


@kernel
def _balance(gap, gradient):
    """Force f [Pa], the negative mean gradient at gaps, and the mean size of the rest of the gradient [Pa]."""
    total, number, residual = 0.0, 0, 0.0
    for i in range(gap.shape[0]):
        for j in range(gap.shape[1]):
            opened = gap[i, j] > 0
            total += np.float64(gradient[i, j]) if opened else 0.0
            number += opened
    force = -total / number
    for i in range(gap.shape[0]):
        for j in range(gap.shape[1]):
            difference = gradient[i, j] + force
            residual += abs(difference) if gap[i, j] > 0 else max(-difference, 0.0)
    return force, residual / gap.size


@kernel
def _among_free(values, gap, gradient, force):
    """Values less their mean on elements that are open, or that the gradient opens, and 0 on others (n1, n2)."""
    free, total, number = np.zeros_like(values), 0.0, 0
    for i in range(gap.shape[0]):
        for j in range(gap.shape[1]):
            if gap[i, j] > 0 or gradient[i, j] + force < 0:
                total += values[i, j]
                number += 1
    mean = np.float32(total / number)
    for i in range(gap.shape[0]):
        for j in range(gap.shape[1]):
            if gap[i, j] > 0 or gradient[i, j] + force < 0:
                free[i, j] = values[i, j] - mean
    return free


@kernel
def _way(gap, down, step, gradient, mean):
    """Way (n1, n2) [m] to the nearest gaps >= 0 of a mean [m] to those a number of steps down, and the slope along it.

    The nearest ones are max(g - s, 0), with the shift s by Newton's method.
    """
    way, shift, before, slope = gap - step * down, 0.0, np.inf, 0.0
    while abs(shift - before) > ROUNDING * mean:
        before, total, number = shift, 0.0, 0
        for i in range(gap.shape[0]):
            for j in range(gap.shape[1]):
                above = way[i, j] > before
                total += way[i, j] if above else 0.0
                number += above
        shift = (total - mean * gap.size) / number
    for i in range(gap.shape[0]):
        for j in range(gap.shape[1]):
            way[i, j] = max(way[i, j] - shift, 0.0) - gap[i, j]
            slope += gradient[i, j] * way[i, j]
    return way, slope / gap.size


@kernel
def _product(gap, undeformed, elastic):
    """Mean product of displacement [m] and traction [Pa]."""
    total = 0.0
    for i in range(gap.shape[0]):
        for j in range(gap.shape[1]):
            total += (gap[i, j] - undeformed[i, j]) * elastic[i, j]
    return total / gap.size


@kernel
def _step(moved, gradient_before, down_before, gradient, down):
    """Length of Barzilai and Borwein from a way [m] and the gradients before and after it, as they are and smoothed."""
    bend, square = 0.0, 0.0
    for i in range(moved.shape[0]):
        for j in range(moved.shape[1]):
            change = np.float64(gradient[i, j] - gradient_before[i, j])
            bend += moved[i, j] * change
            square += (down[i, j] - down_before[i, j]) * change
    return min(bend / square, LONGEST) if bend > 0 and square > 0 else FIRST  # where the energy bends down
