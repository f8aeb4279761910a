r"""Attraction of two rough surfaces by a voltage across a dielectric (not in the paper).

A dielectric of thickness t and relative permittivity :math:`\epsilon_r` keeps the solids apart, and counts as a gap
:math:`D = t / \epsilon_r`. Flats at the gap g attract each other as a capacitor per area, so that their separation to
infinity needs the work

.. math:: w(g) = \frac{\epsilon_0 V^2}{2 (g + D)} .

`stiction.contact.gaps.gap_pressures` averages it over the bearing area, as the van der Waals attraction.

A voltage V adds :math:`V^2 g(d)` to the attraction f(d) of a patch at the distance d. A spring that pulls with p per
area frees the patch if it is stronger at every distance, :math:`p > f(d) + V^2 g(d)`, hence below the voltage with
:math:`V^2 = \min_d (p - f) / g`. Flats in contact, :math:`g = \epsilon_0 / 2 D^2`,
need the least voltage to stay.

ASSUME: no current, no drift of charge, and no water in the gap, whose permittivity would add to the attraction. Where
solids touch, the gap stays zero while they deform, so that the voltage does no work there.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from stiction.constants import VACUUM_PERMITTIVITY

#: Field at which thin oxides and nitrides break down [V m⁻¹]. D. J. DiMaria and J. W. Stasiak, J. Appl. Phys. 65, 2342
#: (1989), for SiO2: about 1 V/nm.
BREAKDOWN = 1e9


@dataclass(frozen=True)
class Dielectric:
    """Dielectric between a device and its substrate at a voltage."""

    thickness: float  #: [m]
    permittivity: float  #: relative [-]

    @property
    def distance(self) -> float:
        """Gap D of air of the same capacity [m]."""
        return self.thickness / self.permittivity


@dataclass(frozen=True)
class Capacitor:
    """Device and its substrate at a voltage."""

    dielectric: Dielectric
    voltage: float = 0.0  #: [V]
    offset: float = 0.0  #: by charge and contact potential [V]

    @property
    def potential(self) -> float:
        """Largest difference of potential V [V]. ASSUME: voltages of both signs occur."""
        return abs(self.voltage) + abs(self.offset)

    @property
    def per_volt(self) -> "Capacitor":
        """The same at 1 V. Its pressures and works are those per V²."""
        return Capacitor(self.dielectric, 1.0)

    @property
    def field(self) -> float:
        """Field in the dielectric between surfaces in contact, V / t [V m⁻¹]."""
        return self.potential / self.dielectric.thickness

    @property
    def largest_pressure(self) -> float:
        """Tension between flats in contact, ε₀ V² / 2 D² [Pa]."""
        return VACUUM_PERMITTIVITY * self.potential**2 / (2 * self.dielectric.distance**2)

    def work(self, gap: float | np.ndarray) -> float | np.ndarray:
        """Work per area to separate flats from a gap >= 0 [m] to infinity [J m⁻²], any shape.

        Examples
        --------
        >>> oxide = Capacitor(Dielectric(100e-9, 1.0), 3.0)
        >>> round(1e3 * (oxide.work(0.0) - oxide.work(20e-6)), 3)  # mJ/m²
        0.396
        """
        return VACUUM_PERMITTIVITY * self.potential**2 / (2 * (gap + self.dielectric.distance))


def freeing_potential(excess: Callable[[float], float], highest: float) -> float:
    """Potential below which a spring frees a patch, zero if it does not without a potential [V].

    Parameters
    ----------
    excess : callable
        Largest attraction at a squared potential [V²] less the pull of the spring [Pa], increasing.
    highest : float
        Squared potential at which the attraction is at least as large as the pull [V²].

    Examples
    --------
    >>> round(freeing_potential(lambda squared: 2 * squared - 18, 100.0), 6)
    3.0
    """
    return float(np.sqrt(brentq(excess, 0.0, highest))) if excess(0.0) < 0 < excess(highest) else 0.0
