r"""Pair of surfaces in dry air under a beam or a stopper, as the estimate knows them. Plain Python, SI units.

Without water the solids attract each other alone, across all gaps. Flats that touch need the work of Eq. (10), with the
distance :math:`D_0` at rest,

.. math:: \omega = \frac{\mathfrak{H}}{16 \pi D_0^2} .

They would hold a tip up to the slope :math:`\theta_0 = (27 \, \omega / 2 K)^{1/4}`, and an area A with
:math:`\omega A / D_0`. Forces of elastic solids are in proportion to their modulus, so that lengths depend on the
Hamaker constant over the modulus alone, at the same stiffness over the modulus.

Full contact changes a force by a ratio r and its scatter s by a power b, as in `stiction.estimate.force`. Of tips, r is
the upper end that a run applies.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar

from stiction.constants import MOLECULAR_DISTANCE
from stiction.estimate.length import OF_FORCES, SCORES, Lengths, falling, known_at
from stiction.estimate.state import curvature
from stiction.estimate.statistics import Heights
from stiction.estimate.table import Surrogate

#: Distance D₀ of solids at rest [m]: `stiction.contact.vanderwaals.DugdaleAttraction`.
AT_REST = (2 / 15) ** (1 / 6) * MOLECULAR_DISTANCE
#: Names of the coordinates, for messages: of both, of a beam and of a stopper.
_OF_CONTACT = (
    "rms of the heights",
    "attraction of the solids over slopes of the surface (from Hamaker constant, rms and spectrum)",
    "breadth of the spectrum (from Hurst exponent, corner and cut-off)",
    "correlation length (from corner and Hurst exponent)",
    "skewness",
    "kurtosis",
    "curvature of the summits (from Hurst exponent, corner and cut-off)",
)
OF_TIPS = (
    *_OF_CONTACT,
    "softness of the beam over slopes of the surface (from thickness, gap and rms)",
    "width of the beam in summits",
)
OF_PATCHES = (*_OF_CONTACT, "area in contact in summits")


def work_of(constant: float) -> float:
    """Work ω to separate flats with a Hamaker constant [J] in dry air [J m⁻²].

    Examples
    --------
    >>> round(work_of(18.65e-20), 3)  # polysilicon
    0.166
    """
    return constant / (16 * math.pi * AT_REST**2)


def _of_contact(state):
    """Coordinates of the contact of surfaces in dry air."""
    heights = state.heights
    low, second, fourth = heights.moments
    return (
        math.log(heights.rms),
        math.log(work_of(state.constant) / (AT_REST * state.modulus * heights.slope)),
        math.log(fourth / second**2),
        math.log(low**2 * second),
        heights.skewness,
        heights.kurtosis,
        math.log(curvature(heights)),
    )


@dataclass(frozen=True)
class DryTip:
    """Surfaces, solids and beam."""

    heights: Heights  #: of the sum of both surfaces
    constant: float  #: Hamaker constant ℌ of both solids [J]
    stiffness: float  #: K = E t³ / h² [N m⁻¹]
    width: float  #: [m]
    modulus: float  #: E of the solids [Pa]
    names: ClassVar[tuple[str, ...]] = OF_TIPS

    @property
    def flat_slope(self) -> float:
        """θ₀, up to which flats hold a tip [-]."""
        return (13.5 * work_of(self.constant) / self.stiffness) ** 0.25

    def at(self, slope: float) -> "DryTip":
        """Tip under a beam that flats hold up to a slope [-]."""
        return replace(self, stiffness=13.5 * work_of(self.constant) / slope**4)

    @property
    def coordinates(self) -> tuple[float, ...]:
        """Numbers on which the slope of a stuck tip depends, by ``OF_TIPS``, logarithms but for heights' form."""
        return (
            *_of_contact(self),
            math.log(self.flat_slope / self.heights.slope),
            math.log(self.width * curvature(self.heights)),
        )


@dataclass(frozen=True)
class DryPatch:
    """Surfaces, solids and area of a stopper. ASSUME: the ratio of its sides does not matter."""

    heights: Heights  #: of the sum of both surfaces
    constant: float  #: Hamaker constant ℌ of both solids [J]
    area: float  #: [m²]
    modulus: float  #: E of the solids [Pa]
    names: ClassVar[tuple[str, ...]] = OF_PATCHES

    @property
    def flat_force(self) -> float:
        """Force ω A / D₀ of flats [N]."""
        return work_of(self.constant) / AT_REST * self.area

    @property
    def coordinates(self) -> tuple[float, ...]:
        """Numbers on which the pull-off force depends, by ``OF_PATCHES``, as those of `DryTip`."""
        return *_of_contact(self), math.log(self.area * curvature(self.heights) ** 2)


def lengths(tip: DryTip, gap: float, tips: Surrogate, full: Surrogate) -> Lengths:
    """Lengths of beams over a gap [m].

    Raises
    ------
    NotLearnt
        If the tip is beyond what was learnt.
    """
    distribution = _on_summits(tip, gap, tips)
    power = 1.0
    for _ in range(2):
        change = known_at(full, tip.at(1.5 * gap / distribution.at(SCORES[-1])).coordinates, tip.names)
        power, scatter = max(1.0, change["power"]), OF_FORCES * distribution.fall
        factor = math.exp(change["ratio"] + (1 - power**2) * scatter**2 / 2)
        distribution = _on_summits(replace(tip, stiffness=tip.stiffness / factor), gap, tips)
    return scattered(distribution, power)


def _on_summits(tip, gap, tips):
    """Lengths on summits alone."""
    return falling(known_at(tips, tip.coordinates, tip.names), math.log(1.5 * gap / tip.flat_slope))


def scattered(distribution: Lengths, power: float, shift: float = 0.0) -> Lengths:
    """Lengths whose logarithms scatter more by a power, around a shifted median."""
    median = distribution.logarithms[0]
    return Lengths(
        tuple(median + shift + power * (each - median) for each in distribution.logarithms), power * distribution.slope
    )


def reciprocals(patch: DryPatch, forces: Surrogate, full: Surrogate) -> Lengths:
    """Reciprocals of the pull-off forces of a patch [1/N].

    Raises
    ------
    NotLearnt
        If the patch is beyond what was learnt.
    """
    change, values = (known_at(process, patch.coordinates, patch.names) for process in (full, forces))
    distribution, power = falling(values, -math.log(patch.flat_force)), max(1.0, change["power"])
    return scattered(distribution, power, -change["ratio"] - (1 - power**2) * distribution.fall**2 / 2)


def pull_off(patch: DryPatch, learnt: Mapping[str, Any]) -> float:
    """Median pull-off pressure of a patch, from the part of the table about stoppers in dry air [Pa].

    Raises
    ------
    NotLearnt
        If the patch is beyond what was learnt.
    """
    found = reciprocals(patch, *processes(learnt, "forces", "full"))
    return math.exp(-found.logarithms[0]) / patch.area


def processes(section: Mapping[str, Any], *names: str) -> tuple[Surrogate, ...]:
    """Processes of a part of the table by name."""
    return tuple(Surrogate(**section[name]) for name in names)
