r"""Voltage as an addition to the adhesion of a touching device.

Surfaces attract each other across their gaps as `stiction.contact.voltage` says, with the gap D of air of the same
capacity as the dielectric.

**Beams.** Along the open part of a beam :math:`EI (u''' u' - u''^2 / 2) - \Phi` is constant, with the potential Φ of
all attraction. The beam has no slope at the clamp and at the crack. A crack is thus held as if the adhesion energy were
:math:`\Gamma + \Gamma_V`, and its length falls with the fourth root of its energy,

.. math:: L_V^{-4} = L^{-4} + \frac{\Gamma_V}{c E t^3 h^2}, \quad
    c = \tfrac{3}{2} \text{ (S-shape)}, \tfrac{3}{8} \text{ (arc)},

for any fraction of the devices, because all of them gain the same. The zone of the field is :math:`\sqrt{D / 3 h}` of
the length, 2 to 4 %. Cracks in the field are longer than the law by up to half of this, so that the law is safe.

Γ_V of rough surfaces is the gain of the mean energy of their samples, a number of stage ``at_voltage``.
Flats in contact need most, the closed form

.. math:: \Gamma_V = \frac{\epsilon_0 V^2}{2} \left( \frac{1}{D} - \frac{1}{D + h} \right) .

**Stoppers** are held by :math:`\epsilon_0 V^2 A / 2 D^2` more if they are flat.
"""

import numpy as np

from stiction.beam.cantilever import Beam
from stiction.contact.voltage import Capacitor

#: Energies of arcs and S-shapes, in units of E t³ h² / L⁴.
ARC, S_SHAPE = 3 / 8, 3 / 2


def energy_of_voltage(capacitor: Capacitor, gap: float) -> float:
    """Work Γ_V against a voltage from flats in contact to a gap h [m] [J m⁻²]."""
    return capacitor.work(0.0) - capacitor.work(gap)


def length_at_voltage(length: float | np.ndarray, beam: Beam, added: float, form: float) -> float | np.ndarray:
    """Length to release at a voltage, from one without voltage [m], the energy Γ_V [J m⁻²] and form c [-].

    An infinite length is that of a beam without adhesion. ASSUME: the voltage alone then holds it.

    Examples
    --------
    >>> beam = Beam(1e-3, 30e-6, 2.6e-6, 164e9, 20e-6, 1)
    >>> round(length_at_voltage(1001e-6, beam, 0.396e-3, S_SHAPE) * 1e6)  # µm
    951
    """
    scale, length = form * beam.young_modulus * beam.thickness**3 * beam.gap**2, np.asarray(length)
    if not added:
        return length[()]
    return ((length**-4 + added / scale) ** (-1 / 4))[()]
