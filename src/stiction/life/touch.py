r"""Causes of the contact of a device: voltage, and shock.

**Voltage.** Substrate and beam are electrodes along the whole length, at the distance h - u. They attract each other
with :math:`\epsilon_0 V^2 w / 2 (h - u)^2` per length. In the units of `stiction.life.bending`

.. math:: U'''' - \tau U'' = \frac{\lambda}{(1 - U)^2}, \quad
    \lambda = \frac{\epsilon_0 V^2 w L^4}{2 EI h^3} = \frac{6 \epsilon_0 V^2 L^4}{E t^3 h^3} .

The beam is pulled in where λ reaches its fold: 1.6808 for a cantilever, 70.095 for a bridge without tension. ASSUME: no
fringes of the field, which lower the voltage of narrow beams, no dielectric, no offset by charge.

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
of their way.
"""

from stiction.beam.cantilever import Beam
from stiction.constants import VACUUM_PERMITTIVITY
from stiction.life.bending import Bent

#: Largest displacement of an oscillator without damping under a half-sine of any duration, over the static one [-]:
#: the largest of sin(2πr / (1 + r)) / (1 - r) over the ratio r of half the period of the pulse to that of the
#: oscillator, rounded up. A pulse of another shape that rises and falls once reaches at most 2, as a rectangular one.
HALF_SINE = 1.7685


def bent(beam: Beam, clamps: int, rigid: bool = False) -> Bent:
    """Beam with one or two clamps in units of its length. Rigid clamps let a bridge stretch."""
    stretching = 6 * (beam.gap / beam.thickness) ** 2 if rigid and clamps == 2 else 0.0
    return Bent(clamps, (beam.decay * beam.length) ** 2, stretching)


def pull_in_voltage(beam: Beam, clamps: int, rigid: bool = False) -> float:
    """Voltage of the pull-in of a beam [V].

    Examples
    --------
    >>> beam = Beam(266e-6, 30e-6, 2.6e-6, 164e9, 20e-6, 1)
    >>> round(pull_in_voltage(beam, clamps=1))
    382
    """
    force = 2 * beam.bending_stiffness * beam.gap**3 / (VACUUM_PERMITTIVITY * beam.width * beam.length**4)
    return float((bent(beam, clamps, rigid).fold(2) * force) ** 0.5)


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


def half_sine_factor(beam: Beam, clamps: int) -> float:
    """Bound of the deflection by a half-sine shock of any duration, relative to a slow one of the same peak [-]."""
    return HALF_SINE * bent(beam, clamps).overshoot()


def stopper_voltage(stiffness: float, way: float, area: float, gap: float) -> float:
    """Voltage on an electrode for contact of a stopper [V].

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
