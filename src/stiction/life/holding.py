r"""Voltage as an addition to the adhesion of a touching device.

Surfaces attract each other across their gaps as `stiction.contact.voltage` says, with the gap D of air of the same
capacity as the dielectric.

**Beams.** Along the open part of a beam :math:`EI (u''' u' - u''^2 / 2) - \Phi` is constant, with the potential Φ of
all attraction. The beam has no slope at the clamp and at the crack. A crack is thus held as if the adhesion energy were
:math:`\Gamma + \Gamma_V`, and its length falls with the fourth root of its energy,

.. math:: L_V^{-4} = L^{-4} + \frac{2 \Gamma_V}{3 E t^3 h^2} ,

for any fraction of the devices, because all of them gain the same. The zone of the field is :math:`\sqrt{D / 3 h}` of
the length, 2 to 4 %. Cracks in the field are longer than the law by up to half of this, so that the law is safe.

A tip has the slope :math:`3 h / 2 L`, and a voltage pulls at its wedge with :math:`2 \Gamma_V L / 3 h` per width. What
holds the tip without voltage depends on its slope, too: on uniform surfaces it falls as the slope grows, on rough ones
it hardly changes. ASSUME: it does not fall and stays P, the safe side,

.. math:: \frac{3 E I h}{L_V^3} = w \left( P + \frac{2 \Gamma_V L_V}{3 h} \right), \quad
    P = \frac{3 E I h}{w L^3} .

Lengths by the law of cracks are up to 2.8 % longer.

Γ_V of rough surfaces is the gain of the mean energy of their samples, a number of stage ``at_voltage``.
Flats in contact need most, the closed form

.. math:: \Gamma_V = \frac{\epsilon_0 V^2}{2} \left( \frac{1}{D} - \frac{1}{D + h} \right) .

**Stoppers** are held by :math:`\epsilon_0 V^2 A / 2 D^2` more if they are flat.
"""

import numpy as np

from stiction.beam.cantilever import Beam
from stiction.contact.voltage import Capacitor

#: Steps of Newton's method from above to a root of a convex quartic, at most twice as large as the root.
_STEPS = 8


def energy_of_voltage(capacitor: Capacitor, gap: float) -> float:
    """Work Γ_V against a voltage from flats in contact to a gap h [m] [J m⁻²]."""
    return capacitor.work(0.0) - capacitor.work(gap)


def length_at_voltage(length: float | np.ndarray, beam: Beam, added: float) -> float | np.ndarray:
    """Crack length at a voltage, from one without voltage [m] and the energy Γ_V [J m⁻²].

    An infinite length is that of a beam without adhesion. ASSUME: the voltage alone then holds it.

    Examples
    --------
    >>> beam = Beam(1e-3, 30e-6, 2.6e-6, 164e9, 20e-6, 1)
    >>> round(length_at_voltage(1001e-6, beam, 0.396e-3) * 1e6)  # µm
    951
    """
    scale, length = 3 / 2 * beam.young_modulus * beam.thickness**3 * beam.gap**2, np.asarray(length)
    if not added:
        return length[()]
    return ((length**-4 + added / scale) ** (-1 / 4))[()]


def tip_length_at_voltage(length: float | np.ndarray, beam: Beam, added: float) -> float | np.ndarray:
    """Length that a tip holds at a voltage, as `length_at_voltage`, by a force that does not depend on its slope [m].

    Examples
    --------
    >>> beam = Beam(1e-3, 30e-6, 2.6e-6, 164e9, 20e-6, 1)
    >>> round(tip_length_at_voltage(500e-6, beam, 0.01) * 1e6)  # µm
    389
    """
    if not added:
        return np.asarray(length)[()]
    bare = 1 / np.asarray(length)
    driven = 2 * added * beam.width / (9 * beam.bending_stiffness * beam.gap**2)
    inverse = bare + driven ** (1 / 4)
    for _ in range(_STEPS):
        inverse = inverse - (inverse**4 - bare**3 * inverse - driven) / (4 * inverse**3 - bare**3)
    return (1 / inverse)[()]
