r"""Bridges: beams clamped at both ends, under the tension of a residual stress, stuck at their middle.

Two cracks open a bridge that was pressed down. Once they meet, the bridge is not yet free: its middle has no slope and
touches as a parabola, and adhesion holds it on a few micrometres. It comes free if it pulls harder than this patch
holds, at about half of the length at which the cracks meet. `held_lengths` finds this length by finite elements
(`stiction.beam.middle`), `least_length` bounds it in closed form.

A state that is held this way is metastable, as an arc is; its barrier, of the order of 1e-12 J, is far above thermal
energy.

ASSUME: compression (buckling) and stretching of the bridge are left out; neighbouring strips repeat laws only where
long waves raise them together (on pair b, parameters of laws correlate by less than 0.05, also for strips of 0.25 µm).
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from stiction.beam.cantilever import Beam
from stiction.beam.energy import arrest_length
from stiction.beam.foundation import LONGER, STRIP, foundation_length
from stiction.beam.middle import outwards, shortest_held
from stiction.beam.tension import end_stiffness
from stiction.contact import forcelaw
from stiction.progress import progress

#: Half of the middle zone, in foundation lengths; the middle holds on 1 or 2. On pair b, zones of 6 and 20 give the
#: same quantiles of 1 and 5 % within 0.3 %; at RH 0.44, single long bridges stop at places in between.
ZONE = 6.0
#: Longest element of the middle zone, in foundation lengths; with half of it, lengths grow by 0.15 %.
ELEMENT = 0.25
#: Factor between the lengths among which `least_length` looks for the longest free one.
_SHORTER = 0.98


def half_of_bridge(beam: Beam, residual_stress: float) -> Beam:
    """Cantilever under the tension of a bridge with this residual stress [Pa].

    Raises
    ------
    ValueError
        If the stress is compressive: the bridge may buckle, which is not in the model.
    """
    if not residual_stress >= 0:
        raise ValueError(
            f"a residual stress of {residual_stress / 1e6:.3g} MPa is compressive: buckling is not in the model"
        )
    return replace(beam, tension=residual_stress * beam.width * beam.thickness)


# Finite elements


def longest_strip(beam: Beam, laws: np.ndarray) -> float:
    """Longest strip to resolve the middle of a bridge on force laws (n, 4) [m]. ``beam`` is any part of it."""
    return STRIP * foundation_length(beam, laws)


def middle_zone(beam: Beam, strip: float, laws: np.ndarray) -> tuple[Beam, int]:
    """Zone around the middle of a bridge with fine enough elements, and its number of strips.

    From any part of the bridge, under its tension, the length of a strip of ground [m], and a sample of the force laws
    of these strips (n, 4) [SI].

    Raises
    ------
    ValueError
        If the strips are too long for the laws.
    """
    foundation, allowed = foundation_length(beam, laws), longest_strip(beam, laws)
    if strip > LONGER * allowed:
        raise ValueError(
            f"strips of {1e6 * strip:.3g} µm do not resolve the middle of a bridge on these surfaces: they must be at "
            f"most {1e6 * allowed:.3g} µm long; decrease strip_um, or increase the thickness of the bridge"
        )
    strips = 2 * int(np.ceil(ZONE * foundation / strip))
    each = int(np.ceil(strip / (ELEMENT * foundation)))
    return replace(beam, length=strips * strip, elements=strips * each), strips


def held_length(zone: Beam, laws: np.ndarray) -> float:
    """Length of the shortest bridge to stick at its middle, infinite if two cracks on the mean law do not stop [m].

    The zone is from `middle_zone`; the force laws of its strips (strips, 4) are ordered from the middle outwards, first
    to the right [SI].
    """
    strips = len(laws)
    along = np.repeat(laws[outwards(strips)], zone.elements // strips, axis=0)
    return shortest_held(zone, along, _longest(zone, laws))


def held_on_mean(zone: Beam, laws: np.ndarray) -> float:
    """Length `held_length` on strips that all have the mean of force laws (n, 4), or the longest tried one [m]."""
    uniform = np.tile(forcelaw.mean_law(laws), (zone.elements, 1))
    return min(shortest_held(zone, uniform, _longest(zone, uniform)), _longest(zone, uniform))


def _longest(zone, laws):
    """Length of arrest of both cracks of a bridge on its mean law, the start of its search [m]."""
    return 2 * float(arrest_length(forcelaw.energy(laws).mean(), zone))


def longest_tried(zone: Beam, strips: int, draw_laws: Callable, rng: np.random.Generator) -> float:
    """Length at the start of the search of `held_lengths` for one bridge [m]. ``rng`` is its stream."""
    return _longest(zone, draw_laws(strips, rng))


def held_lengths(
    zone: Beam,
    strips: int,
    draw_laws: Callable[[int, np.random.Generator], np.ndarray],
    number: int,
    stream: Callable[[int], np.random.Generator],
) -> np.ndarray:
    """Lengths `held_length` of a number of bridges on random ground (number,) [m]. Zone and strips from `middle_zone`.

    ``draw_laws(n, rng)`` gives n force laws (n, 4) [SI], and ``stream(k)`` is the numpy.random.Generator of bridge k.
    """
    return np.array([held_length(zone, draw_laws(strips, stream(k))) for k in progress(range(number), "bridges")])


# Closed form


def pull(length: float, beam: Beam) -> tuple[float, float]:
    """Force of a bridge of a length [m] at its middle [N], and the curvature there [m⁻¹]."""
    half = length / 2
    force, moment, _, _ = end_stiffness(beam.decay * half) if beam.tension else (12.0, 6.0, 4.0, 2.0)
    return 2 * force * beam.bending_stiffness * beam.gap / half**3, moment * beam.gap / half**2


def least_length(energy: float, pull_off: float, beam: Beam) -> float:
    r"""Least length of a bridge to stick at its middle, over all laws of this energy [J m⁻²] and pull-off [Pa] [m].

    The law that holds most attracts with f_max as far as e / f_max, and not beyond. It balances the force P of the
    bridge on a half-width :math:`b = P / (2 w f_\mathrm{max})`, where the middle, of curvature κ under a point force,
    has risen by at least

    .. math:: \frac{\kappa b^2}{2} - \frac{7 P b^3}{48 EI} .

    The bridge is free if this is more than e / f_max. The second term is the effect of P on a width rather than at a
    point. Without it and without tension, :math:`L^4 = 16 E t^3 h \sqrt{3 h / (e f_\mathrm{max})}`.

    Returns 0 if there is no such length.

    Examples
    --------
    >>> bridge = Beam(600e-6, 30e-6, 2e-6, 164e9, 2e-6, 80)
    >>> round(least_length(6.165e-3, 2.85e6, bridge) * 1e6, 1)  # µm; 172 by finite elements
    166.4
    """

    def excess(length):
        """Gap at the end of the stuck width beyond the reach of the law, at a length of the bridge [m]."""
        force, curvature = pull(length, beam)
        width = force / (2 * beam.width * pull_off)
        rise = curvature * width**2 / 2 - 7 / 48 * force * width**3 / beam.bending_stiffness
        return rise - energy / pull_off

    longer = 2 * float(arrest_length(energy, beam))
    while longer > beam.thickness:
        shorter = _SHORTER * longer
        if excess(shorter) > 0:
            return float(brentq(excess, shorter, longer))
        longer = shorter
    return 0.0
