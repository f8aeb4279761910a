r"""What flat surfaces in contact hold, with water in all gaps where it condenses. Plain Python, SI units.

`stiction.stages.devices.sticking.flooded_lengths` without a voltage. Water of the tension p pulls up to the height
:math:`h_C`. Solids need the work ω of Eq. (10) through what is between them, and beyond the film that through air,

.. math:: U(g) = \frac{\mathfrak{H}}{12 \pi} \Bigl( \frac{1}{D^2 (1 + b g / \lambda)} - \frac{D_0^6}{4 D^8} \Bigr),
    \quad D = D_0 + g ,

see `stiction.contact.gaps`. Each pulls with an energy e and at most a tension q. No surface holds a shorter cantilever
along its underside, a shorter bridge, or a stopper with a larger force. A rough tip can hold a shorter cantilever.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from stiction.config.units import to_si
from stiction.constants import MOLECULAR_DISTANCE
from stiction.estimate.closed.beams import SlenderBeam
from stiction.estimate.closed.bending import end_stiffness, root
from stiction.estimate.dry import AT_REST, work_of
from stiction.estimate.solids import SolidPair
from stiction.estimate.state import Film

#: Radius R of the edge of a tip [m] and wavelength λ of the retardation [m] that devices have by default.
EDGE, WAVELENGTH = to_si(0.1, "um"), to_si(100, "nm")
#: Strength b of the retardation [-], and end of the stress of summits [m]: `stiction.contact.gaps.RETARDATION` and
#: `stiction.contact.vanderwaals.DugdaleAttraction.range`.
_RETARDATION, _RANGE = 5.32, 0.97 * 2 ** (1 / 6) * MOLECULAR_DISTANCE
#: Slopes of tips, and factor between lengths of bridges, as of `stiction.devices.arcs` and `stiction.devices.bridges`.
_SLOPES, _SHORTER = 65, 0.98


class FlatPull(NamedTuple):
    """Attraction of flats in contact."""

    energy: float  #: e [J m⁻²]
    largest: float  #: q [Pa]


@dataclass(frozen=True)
class FlatBound:
    """Size of a device on flat surfaces."""

    size: float  #: below which no surface holds a beam [m], or above which none holds a stopper [N]
    at_tip: float | None = (
        None  #: length of a cantilever that a flat tip holds, NOT safe: a rough tip can hold less [m]
    )


def worst(bounds: Sequence[FlatBound], is_force: bool) -> FlatBound:
    """Bound of some airs: the shortest lengths, or the largest force."""
    tips = [bound.at_tip for bound in bounds if bound.at_tip is not None]
    return FlatBound((max if is_force else min)(bound.size for bound in bounds), min(tips, default=None))


def attractions(water: Film | None, solids: SolidPair) -> tuple[FlatPull, ...]:
    """Attractions of the solids in a film of water, or in dry air without one, and of the film."""
    air = solids.in_dry_air
    farthest = air / (6 * math.pi * AT_REST**3) * 2 / math.sqrt(27)
    if water is None:
        return (FlatPull(work_of(air), work_of(air) / _RANGE + farthest),)
    work = work_of(solids.through_water)
    beyond = _work(air, water.height) - _work(solids.through_water, water.height)
    of_solids = FlatPull(work + beyond, work / _RANGE + farthest)
    return of_solids, FlatPull(water.energy, water.energy / water.height)


def _work(constant, gap):
    """Work U of flats from a gap [J m⁻²]."""
    near = AT_REST / (AT_REST + gap)
    return work_of(constant) * 4 / 3 * (near**2 / (1 + _RETARDATION * gap / WAVELENGTH) - near**8 / 4)


def of_stopper(area: float, attracted: Sequence[FlatPull]) -> FlatBound:
    """Force that no surfaces of an area [m²] exceed."""
    return FlatBound(area * sum(each.largest for each in attracted))


def of_cantilever(beam: SlenderBeam, attracted: Sequence[FlatPull]) -> FlatBound:
    """Lengths that flats hold along the underside and by the tip."""
    energy = sum(each.energy for each in attracted)
    return FlatBound(beam.arrested(energy), _at_tip(beam, energy, attracted))


def _at_tip(beam, energy, attracted):
    """Length of `stiction.devices.arcs.flat_length` [m]."""
    sharp = 1.5 * beam.gap / beam.arrested(energy) * math.sqrt(2)
    bending = 2 / 27 * beam.modulus * beam.thickness**3 / beam.gap**2  # of a slope of 1, over the width

    def excess(slope):
        """Logarithm of the attraction at a slope over the force that frees the tip there."""
        return math.log(sum(_on_edge(each, slope) for each in attracted) / (bending * slope**3))

    ratio = 4 * math.exp(excess(sharp) / 3)
    slopes = [sharp / 2 * ratio ** (k / (_SLOPES - 1)) for k in range(_SLOPES)]
    held = max(k for k, slope in enumerate(slopes) if excess(slope) >= 0)
    below, above = excess(slopes[held]), excess(slopes[held + 1])
    return 1.5 * beam.gap / (slopes[held] * (slopes[held + 1] / slopes[held]) ** (below / (below - above)))


def _on_edge(attraction, slope):
    """Largest attraction of a tip with an edge at a slope over its width [N m⁻¹]."""
    energy, largest = attraction
    edge = math.sqrt(2 * EDGE * energy * largest)
    on_wedge = slope**2 * EDGE / 2 < energy / largest
    return energy / slope + largest * slope * EDGE / 2 + edge if on_wedge else 2 * edge


def of_bridge(beam: SlenderBeam, attracted: Sequence[FlatPull]) -> FlatBound:
    """Length below which no middle holds a bridge, `stiction.devices.bridges.least_length`, zero without one."""
    energy, largest = map(sum, zip(*attracted, strict=True))

    def excess(logarithm):
        """Rise of the middle at the end of its contact beyond the reach of the law [m]."""
        half = math.exp(logarithm) / 2
        force, moment = end_stiffness(math.sqrt(beam.tension(half)))
        pull, curvature = 2 * force * beam.stiffness * beam.gap / half**3, moment * beam.gap / half**2
        width = pull / (2 * beam.width * largest)
        return curvature * width**2 / 2 - 7 / 48 * pull * width**3 / beam.stiffness - energy / largest

    longer, step = math.log(2 * beam.arrested(energy)), math.log(_SHORTER)
    while longer > math.log(beam.thickness):
        if excess(longer + step) > 0:
            return FlatBound(math.exp(root(excess, longer + step, longer)))
        longer += step
    return FlatBound(0.0)
