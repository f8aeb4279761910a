r"""Causes of the contact of a device: voltage, and shock.

**Voltage.** Substrate and beam are electrodes along the whole length, at the distance h - u. They attract each other
with :math:`\epsilon_0 V^2 w / 2 (h - u)^2` per length. In the units of `stiction.life.bending`

.. math:: U'''' - \tau U'' = \frac{\lambda}{(1 - U)^2}, \quad
    \lambda = \frac{\epsilon_0 V^2 w L^4}{2 EI h^3} = \frac{6 \epsilon_0 V^2 L^4}{E t^3 h^3} .

Raised slowly, the voltage pulls the beam in where λ reaches its fold: 1.6808 for a cantilever, 70.095 for a bridge
without tension. Fringes of the field (`stiction.life.fringes`) lower it, and a dielectric, a further gap D, raises it.
*At most* the field has no fringes. *At least* it has them at all edges of the beam, and is switched on at once, so that
the beam swings farther by its inertia (`stiction.life.bending`): 0.909 of the voltage of plates for a cantilever, 0.913
for a bridge. ASSUME: it is switched on once. At the beam's own frequency, less brings it down. It
contains any offset by charge.

**Shock.** At the acceleration a the beam carries the load ρ w t a. It touches with its tip or middle where U = 1,

.. math:: \lambda = \frac{\rho w t a L^4}{EI h} = 8 \text{ (cantilever)}, \; 384 \text{ (bridge without tension)},

:math:`a = 2 E t^2 h / 3 \rho L^4` for a cantilever. This is the peak of a shock that is slow compared with the beam. A
half-sine moves an oscillator without damping by at most 1.7685 times as much (`HALF_SINE`), and a beam by at most
`stiction.life.bending.Bent.overshoot` times that, because its modes may add up. ASSUME: the frame stays rigid and the
air does not damp.

**Stoppers** on a spring touch under their restoring force F, at F/m, and are pulled down by an electrode of area A
at the distance g. After the way u,

.. math:: k u = \frac{\epsilon_0 A V^2}{2 (g - u)^2},

which has its fold at u = g/3, :math:`V^2 = 8 k g^3 / 27 \epsilon_0 A`. Stoppers that touch earlier do so at the voltage
of their way. Switched on at once, the voltage has to do the work of the spring up to u, without fringes

.. math:: \frac{k u^2}{2} = \frac{\epsilon_0 A V^2}{2} \left( \frac{1}{g - u} - \frac{1}{g} \right)

at any u on the way. ASSUME: the electrode is a square, and thick. A long and narrow one has more fringes.
"""

import numpy as np
from scipy.optimize import minimize_scalar

from stiction.beam.cantilever import Beam
from stiction.constants import VACUUM_PERMITTIVITY
from stiction.life.bending import Bent, Load
from stiction.life.fringes import edge_width

#: Largest displacement of an oscillator without damping under a half-sine of any duration, over the static one [-]:
#: the largest of sin(2πr / (1 + r)) / (1 - r) over the ratio r of half the period of the pulse to that of the
#: oscillator, rounded up.
HALF_SINE = 1.7685
#: The same of a rectangular pulse, the most of any pulse that rises and falls once [-].
RECTANGLE = 2.0


def bent(beam: Beam, clamps: int, rigid: bool = False) -> Bent:
    """Beam with one or two clamps in units of its length. Rigid clamps let a bridge stretch."""
    stretching = 6 * (beam.gap / beam.thickness) ** 2 if rigid and clamps == 2 else 0.0
    return Bent(clamps, (beam.decay * beam.length) ** 2, stretching)


def pull_in_voltage(beam: Beam, clamps: int, rigid: bool = False, dielectric: float = 0.0) -> float:
    """Slowly growing voltage for the pull-in of a beam in a field without fringes [V].

    ``dielectric`` is the gap D of air of the same capacity as the dielectric on the substrate [m].

    Examples
    --------
    >>> beam = Beam(266e-6, 30e-6, 2.6e-6, 164e9, 20e-6, 1)
    >>> round(pull_in_voltage(beam, clamps=1))
    382
    """
    open_gap = 1 + dielectric / beam.gap
    return _voltage(bent(beam, clamps, rigid).fold(lambda u: (open_gap - u) ** -2), beam)


def pull_in_voltage_at_once(beam: Beam, clamps: int) -> float:
    """Voltage switched on at once that does not pull in a beam, with the fringes at its edges [V].

    Examples
    --------
    >>> beam = Beam(266e-6, 30e-6, 2.6e-6, 164e9, 20e-6, 1)
    >>> round(pull_in_voltage_at_once(beam, clamps=1))
    288
    """
    return _voltage(bent(beam, clamps).fold_at_once(with_fringes(beam)), beam)


def with_fringes(beam: Beam) -> Load:
    """Attraction of a beam by a plane, in units of plates at the open gap, with the fringes at its edges."""

    def edge(u):
        """Width that an edge adds [m]."""
        return edge_width(beam.gap * (1 - u), beam.thickness)

    def along(u):
        """Attraction per length [-]."""
        return (1 + 2 * edge(u) / beam.width) / (1 - u) ** 2

    return Load(along, lambda u: along(u) * edge(u) / beam.length)


def _voltage(load_factor, beam):
    """Voltage of a load factor λ [V]."""
    force = 2 * beam.bending_stiffness * beam.gap**3 / (VACUUM_PERMITTIVITY * beam.width * beam.length**4)
    return float((load_factor * force) ** 0.5)


def touching_acceleration(beam: Beam, clamps: int, density: float, rigid: bool = False) -> float:
    """Slowly growing acceleration for contact of the tip or middle of a beam [m s⁻²]. Density [kg m⁻³].

    Examples
    --------
    >>> beam = Beam(1500e-6, 30e-6, 2.6e-6, 164e9, 20e-6, 1)
    >>> round(touching_acceleration(beam, 1, 2330.0) / 9.80665)
    128
    """
    weight = density * beam.width * beam.thickness * beam.length**4
    return bent(beam, clamps, rigid).under(lambda u: 1 + 0 * u, 1.0)[0] * beam.bending_stiffness * beam.gap / weight


def shock_factor(beam: Beam, clamps: int, oscillator: float = HALF_SINE) -> float:
    """Bound of the deflection by a shock of any duration, relative to a slow one of the same peak [-].

    ``oscillator`` is the largest factor of an oscillator under pulses of this shape, `HALF_SINE` or `RECTANGLE`.

    Examples
    --------
    >>> beam = Beam(266e-6, 30e-6, 2.6e-6, 164e9, 20e-6, 1)
    >>> [round(shock_factor(beam, 1, pulse), 2) for pulse in (HALF_SINE, RECTANGLE)]
    [1.82, 2.06]
    """
    return oscillator * bent(beam, clamps).overshoot()


def stopper_voltage(stiffness: float, way: float, area: float, gap: float) -> float:
    """Slowly growing voltage on an electrode for contact of a stopper, in a field without fringes [V].

    Parameters
    ----------
    stiffness : float
        k of its spring [N m⁻¹].
    way : float
        That it moves before it touches [m].
    area, gap : float
        Area A of the electrode [m²] and its distance g from the moving part [m].

    Examples
    --------
    >>> round(stopper_voltage(2.0, 1e-6, 1e-8, 3e-6), 2)  # 8/27 of 2 k g³ / ε0 A
    13.44
    """
    moved = min(way, gap / 3)
    return float((2 * stiffness * moved * (gap - moved) ** 2 / (VACUUM_PERMITTIVITY * area)) ** 0.5)


def stopper_voltage_at_once(stiffness: float, way: float, area: float, gap: float) -> float:
    """Voltage switched on at once that does not bring a stopper into contact, with fringes at its square electrode [V].

    Parameters as in `stopper_voltage`.

    Examples
    --------
    >>> round(stopper_voltage_at_once(2.0, 1e-6, 1e-8, 3e-6), 2)
    11.29
    """
    points, weights = np.polynomial.legendre.leggauss(24)

    def squared(fraction):
        """Squared voltage that does as much work on a part of the way as the spring stores [V²]."""
        moved = fraction * min(way, gap)
        left = gap - moved * (1 + points) / 2
        sides = area**0.5 + 4 * left / np.pi  # 2 / π gaps at each edge
        return stiffness * moved / (VACUUM_PERMITTIVITY * (weights / 2) @ (sides / left) ** 2)

    optimum = minimize_scalar(lambda fraction: -squared(fraction), bounds=(0, 1), method="bounded")
    return float(squared(optimum.x) ** 0.5)
