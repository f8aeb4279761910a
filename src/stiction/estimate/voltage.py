r"""Lengths and forces at a voltage, by the closed forms that a run takes for them. Plain Python, SI units.

With :math:`\Gamma_V = \frac{\epsilon_0 V^2}{2} (1/D - 1/(D + h))` of flats at the distance D of the dielectric, lengths
L without and :math:`L_V` with voltage,

.. math:: L_V^{-4} = L^{-3} L_V^{-1} + d , \quad d = \frac{8 \Gamma_V}{3 E t^3 h^2} ,

see `stiction.life.holding`. Forces F of stoppers grow by that on flats of their area A,

.. math:: F_V = F + \frac{\epsilon_0 V^2 A}{2 D^2} .
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from stiction.config.units import to_si
from stiction.constants import VACUUM_PERMITTIVITY

#: Keys of a device at a voltage.
KEYS = ("voltage_V", "offset_V", "dielectric")
#: Steps of Newton's method, as many as `stiction.life.holding` takes.
_STEPS = 8


def potential_of(device: Mapping) -> float:
    """Largest difference of potential of a device [V]."""
    return sum(abs(device.get(key, 0.0)) for key in KEYS[:2])


def energy_of(device: Mapping, gap: float) -> float:
    """Energy Γ_V that the voltage of a device adds over its gap [m] [J m⁻²], zero without one."""
    if not (potential := potential_of(device)):
        return 0.0
    distance = _distance_of(device)
    return VACUUM_PERMITTIVITY * potential**2 / 2 * (1 / distance - 1 / (distance + gap))


def tension_of(device: Mapping) -> float:
    """Tension that the voltage of a device adds on flats in contact [Pa], zero without one."""
    potential = potential_of(device)
    return VACUUM_PERMITTIVITY * (potential / _distance_of(device)) ** 2 / 2 if potential else 0.0


def _distance_of(device):
    """Gap D of air of the same capacity as the dielectric of a device [m]."""
    dielectric = device["dielectric"]
    return to_si(dielectric["thickness_nm"], "nm") / dielectric["permittivity"]


def drive_of(energy: float, stiffness: float, gap: float) -> float:
    """Drive d of an energy [J m⁻²], from the stiffness E t³ / h² [N m⁻¹] and the gap [m] of a beam [m⁻⁴]."""
    return 8 * energy / (3 * stiffness * gap**4)


def at_voltage(length: float, drive: float) -> float:
    """Length that a tip holds at a voltage, from that without one [m].

    Examples
    --------
    >>> drive = drive_of(0.01, 164e9 * 2.6e-6**3 / 20e-6**2, 20e-6)
    >>> round(1e6 * at_voltage(500e-6, drive))  # µm
    389
    """
    bare = 1 / length
    inverse = bare + drive**0.25
    for _ in range(_STEPS):
        inverse -= (inverse**4 - bare**3 * inverse - drive) / (4 * inverse**3 - bare**3)
    return 1 / inverse


def without_voltage(length: float, drive: float) -> float:
    """Length of a tip that holds a length at a voltage, infinite where the voltage alone holds it [m].

    Examples
    --------
    >>> round(without_voltage(at_voltage(5.0, 0.01), 0.01), 6), without_voltage(5.0, 1.0)
    (5.0, inf)
    """
    cube = length**-3 - drive * length
    return cube ** (-1 / 3) if cube > 0 else math.inf


@dataclass(frozen=True)
class Driven:
    """Tip at a voltage."""

    drive: float  #: d, zero without one [m⁻⁴]

    def length(self, bare: float) -> float:
        """Length at the voltage, from that without one [m]."""
        return at_voltage(bare, self.drive) if self.drive else bare

    def bare(self, length: float) -> float:
        """Length without the voltage, as `without_voltage` [m]."""
        return without_voltage(length, self.drive)


@dataclass(frozen=True)
class Pulled:
    """Stopper at a voltage."""

    added: float  #: force of the voltage on flats of its area, zero without one [N]

    def length(self, bare: float) -> float:
        """Reciprocal of the force at the voltage, from that without one [1/N]."""
        return bare / (1 + self.added * bare)

    def bare(self, length: float) -> float:
        """Reciprocal of the force without the voltage, infinite where the voltage alone holds it [1/N]."""
        rest = 1 - self.added * length
        return length / rest if rest > 0 else math.inf
