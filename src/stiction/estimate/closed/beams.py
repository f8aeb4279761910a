r"""Closed forms of the life of beams: `stiction.life.drying` and `stiction.life.touch` in plain Python, SI units.

**Drying.** A beam stands up to the length with :math:`\lambda = 24 \gamma \cos\theta L^4 / E t^3 h^2` at its fold, of
liquid at every cross-section (at least) or of a connected one (at most).

**Shock.** A slow one of :math:`a = EI h / (\rho w t L^4 U)` brings down the end or middle that a unit load deflects by

.. math:: U = \frac{1}{8} \text{ (cantilever)}, \quad
    \frac{1}{\tau} \left( \frac{1}{8} - \frac{\tanh(k/4)}{2 k} \right), \; k = \sqrt{\tau} \text{ (bridge)} ,

a half-sine one of at least that over `HALF_SINE`, and over the deflection by all modes of one sign. Those of a bridge
are :math:`\cos(a y) / \cos(a/2) - \cosh(b y) / \cosh(b/2)` about its middle, with :math:`b^2 = a^2 + \tau` and
:math:`a \tan(a/2) = -b \tanh(b/2)`.
"""

import math
from dataclasses import dataclass

from stiction.constants import VACUUM_PERMITTIVITY
from stiction.estimate.closed.bending import (
    AT_REST,
    SLACK,
    BentBeam,
    GrowingLoad,
    end_stiffness,
    largest,
    root,
    settled,
)

#: As of `stiction.life.touch`.
HALF_SINE = 1.7685
#: Deflection of a cantilever by all modes of one sign over a uniform load's, `stiction.life.bending.Bent.overshoot`.
_OF_CANTILEVER = 1.0290535885833705
#: Modes of a bridge.
_MODES = 24


@dataclass(frozen=True)
class DryingLiquid:
    """Liquid that dries."""

    surface_tension: float  #: γ [N m⁻¹]
    contact_angle: float = 0.0  #: θ [rad]

    @property
    def adhesion(self) -> float:
        """Adhesion tension γ cos θ [N m⁻¹]."""
        return self.surface_tension * math.cos(self.contact_angle)

    def pull(self, width_by_gap: float) -> float:
        """Largest pull of it pinned at both edges, as of `stiction.life.drying.pull_of_liquid` [-]."""
        pinned = max(self.contact_angle, math.atan2(2, width_by_gap))
        return width_by_gap * (math.cos(self.contact_angle) + math.cos(pinned)) + 2 * math.sin(pinned)


@dataclass(frozen=True)
class SlenderBeam:
    """Beam of any length."""

    clamps: int  #: 1, a cantilever, or 2, a bridge
    thickness: float  #: t [m]
    gap: float  #: h [m]
    width: float  #: w [m]
    modulus: float  #: E [Pa]
    stress: float = 0.0  #: of a bridge [Pa]

    @property
    def stiffness(self) -> float:
        """E I [N m²]."""
        return self.modulus * self.width * self.thickness**3 / 12

    def tension(self, length: float) -> float:
        """τ at a length [m]."""
        return 12 * self.stress / self.modulus * (length / self.thickness) ** 2

    # Drying

    def standing_each(self, liquid: DryingLiquid) -> float:
        """Longest beam to stand if each cross-section has its own liquid, infinite if it does not wet it [m]."""
        if liquid.adhesion <= 0:
            return math.inf
        scale, unit = self._scale(liquid), self.gap / (2 * math.cos(liquid.contact_angle))

        def along(u):
            """Load per length over that of the open gap on a wide beam [-]."""
            return liquid.pull(self.width / (self.gap * (1 - u))) * unit / self.width

        def at(deflection):
            """Length that balances a deflection of the end or middle [m]."""

            def nearer(state):
                """State nearer to a balance."""
                length = (math.exp(state[0]) * scale) ** 0.25
                load = GrowingLoad(along, lambda _: unit / length)
                return BentBeam(self.clamps, self.tension(length)).nearer(load, deflection, state[1:])

            return (math.exp(settled(nearer, AT_REST)[0]) * scale) ** 0.25

        return largest(at, 1.0)

    def standing(self, liquid: DryingLiquid) -> float:
        """Longest beam to stand while a connected liquid dries, infinite if it does not wet it [m]."""
        if liquid.adhesion <= 0:
            return math.inf
        scale = self._scale(liquid)

        def at_fold(length):
            """Length with the load at the fold of a length [m]."""
            return (BentBeam(self.clamps, self.tension(length)).fold_of_drop() * scale) ** 0.25

        return _settled(at_fold, scale**0.25)

    def _scale(self, liquid):
        """L⁴ / λ [m⁴]."""
        return self.stiffness * self.gap**2 / (2 * liquid.adhesion * self.width)

    def released(self, liquid: DryingLiquid) -> float:
        """Longest beam to come free after a collapse, of bridges the length of two meeting cracks [m]."""
        if liquid.adhesion <= 0:
            return math.inf
        crack = self.arrested(2 * liquid.adhesion)
        return crack / math.sqrt(2) if self.clamps == 1 else 2 * crack

    def arrested(self, energy: float) -> float:
        """Length at which a crack stops at an adhesion energy [J m⁻²], `stiction.beam.energy.arrest_length` [m]."""
        pull = math.sqrt(2 * self.width * energy / self.stiffness) / self.gap
        decay = math.sqrt(self.tension(1.0))
        return _settled(lambda crack: math.sqrt(end_stiffness(decay * crack)[1] / pull), math.sqrt(6 / pull))

    # Touching

    def slow_shock(self, length: float, density: float) -> float:
        """Slowly growing acceleration that brings down the end or middle of a beam [m s⁻²]. Density [kg m⁻³]."""
        weight = density * self.width * self.thickness * length**4
        return self.stiffness * self.gap / (weight * self._by_unit_load(length))

    def _by_unit_load(self, length):
        """Deflection U of the end or middle by a unit load [-]."""
        if self.clamps == 1:
            return 1 / 8
        k = math.sqrt(self.tension(length))
        return 1 / 384 - k**2 / 15360 if k < SLACK else (1 / 8 - math.tanh(k / 4) / (2 * k)) / k**2

    def half_sine_shock(self, length: float, density: float) -> float:
        """Peak of a half-sine shock of any duration that does not bring down a beam [m s⁻²]. Density [kg m⁻³]."""
        return self.slow_shock(length, density) / (HALF_SINE * self._overshoot(length))

    def _overshoot(self, length):
        """Deflection by all modes of one sign over a uniform load's, as `stiction.life.bending.Bent.overshoot`."""
        if self.clamps == 1:
            return _OF_CANTILEVER
        tension = self.tension(length)
        return sum(abs(_by_mode(number, tension)) for number in range(1, _MODES + 1)) / self._by_unit_load(length)

    def pull_in_at_once(self, length: float) -> float:
        """Voltage switched on at once that does not pull in a beam, with the fringes at its edges [V]."""

        def edge(u):
            """Width that an edge adds [m], as `stiction.life.fringes.edge_width`."""
            gap = self.gap * (1 - u)
            ratio = 2 * gap / self.thickness
            return gap / math.pi * (1 + math.log1p(ratio) / ratio)

        def along(u):
            """Attraction per length, of plates at the open gap [-]."""
            return (1 + 2 * edge(u) / self.width) / (1 - u) ** 2

        load = GrowingLoad(along, lambda u: along(u) * edge(u) / length)
        fold = BentBeam(self.clamps, self.tension(length)).fold_at_once(load)
        unit = 2 * self.stiffness * self.gap**3 / (VACUUM_PERMITTIVITY * self.width * length**4)
        return math.sqrt(fold * unit)


def _settled(step, start):
    """Length that a step leaves as it is [m]."""
    (logarithm,) = settled(lambda logarithms: [math.log(step(math.exp(logarithms[0])))], [math.log(start)])
    return math.exp(logarithm)


def _by_mode(number, tension):
    """Part of a mode in the deflection of the middle of a bridge by a unit load."""

    def slope(a):
        """Slope at the clamps, times cos(a/2)."""
        b = math.sqrt(a * a + tension)
        return a * math.sin(a / 2) + b * math.tanh(b / 2) * math.cos(a / 2)

    a = root(slope, (2 * number - 1) * math.pi, 2 * number * math.pi)
    b = math.sqrt(a * a + tension)
    by_a, by_b = math.tan(a / 2) / a, math.tanh(b / 2) / b
    square = 1 / (2 * math.cos(a / 2) ** 2) + by_a + 1 / (2 * math.cosh(b / 2) ** 2) + by_b
    middle = 1 / math.cos(a / 2) - 1 / math.cosh(b / 2)
    return middle * 2 * (by_a - by_b) / ((a * b) ** 2 * square)
