r"""Voltage as an addition to the adhesion of a touching device.

A dielectric of thickness t and relative permittivity :math:`\epsilon_r` keeps beam and substrate apart, and counts as a
gap :math:`D = t / \epsilon_r`. At the gap g they attract each other as a capacitor per area,
:math:`\epsilon_0 V^2 / 2 (g + D)^2`. Their separation from contact to the gap h needs

.. math:: \Gamma_V = \frac{\epsilon_0 V^2}{2} \left( \frac{1}{D} - \frac{1}{D + h} \right) .

**Beams.** Along the open part of a beam :math:`EI (u''' u' - u''^2 / 2) - \Phi` is constant, with the potential Φ of
all attraction. The beam has no slope at the clamp and at the crack. A crack is thus held as if the adhesion energy were
:math:`\Gamma + \Gamma_V`. The length of an S-shape or of an arc falls with the fourth root of its energy,

.. math:: L_V^{-4} = L^{-4} + \frac{\Gamma_V}{c E t^3 h^2}, \quad
    c = \tfrac{3}{2} \text{ (S-shape)}, \tfrac{3}{8} \text{ (arc)},

for any fraction of the devices, because all of them gain the same. The zone of the field is :math:`\sqrt{D / 3 h}` of
the length, 2 to 4 %. Cracks in the field are longer than the law by up to half of this, so that the law is safe.

**Stoppers** are held by :math:`\epsilon_0 V^2 A / 2 D^2` more.

Rough surfaces in contact are some nanometres apart, which adds to D: flats in contact are the safe side. V is the
largest difference of potential: voltages and offsets (contact potential, charge) of either sign add up.

ASSUME: no current, no drift of charge, and no water in the gap, whose permittivity would add to the attraction.
"""

from stiction.beam.cantilever import Beam
from stiction.constants import VACUUM_PERMITTIVITY

#: Field at which thin oxides and nitrides break down [V m⁻¹]. D. J. DiMaria and J. W. Stasiak, J. Appl. Phys. 65, 2342
#: (1989), for SiO2: about 1 V/nm.
BREAKDOWN = 1e9
#: Energies of arcs and S-shapes, in units of E t³ h² / L⁴.
ARC, S_SHAPE = 3 / 8, 3 / 2


def energy_of_voltage(voltage: float, distance: float, gap: float) -> float:
    """Work Γ_V against a voltage [V] from contact to a gap h [m], with ``distance`` D in contact [m] [J m⁻²].

    Examples
    --------
    >>> round(1e3 * energy_of_voltage(3.0, 100e-9, 20e-6), 3)  # mJ/m²
    0.396
    """
    return VACUUM_PERMITTIVITY * voltage**2 / 2 * (1 / distance - 1 / (distance + gap))


def pressure_of_voltage(voltage: float, distance: float) -> float:
    """Attraction of flats in contact at a voltage, ε0 V² / 2 D² [Pa]. Parameters as of `energy_of_voltage`."""
    return VACUUM_PERMITTIVITY * voltage**2 / (2 * distance**2)


def length_at_voltage(length: float, beam: Beam, added: float, form: float) -> float:
    """Length to release at a voltage, from one without voltage [m], the energy Γ_V [J m⁻²] and form c [-].

    Examples
    --------
    >>> beam = Beam(1e-3, 30e-6, 2.6e-6, 164e9, 20e-6, 1)
    >>> round(length_at_voltage(1001e-6, beam, 0.396e-3, S_SHAPE) * 1e6)  # µm
    951
    """
    scale = form * beam.young_modulus * beam.thickness**3 * beam.gap**2
    return float((length**-4 + added / scale) ** (-1 / 4))
