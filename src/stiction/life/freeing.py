r"""What frees a device: the force of its spring, a shock, and how often it may touch.

A shock frees a stopper if its inertia adds what the spring lacks, :math:`a = (F_\mathrm{hold} - F) / m`. With the force
:math:`F_\mathrm{hold}` of slow separation it is the least acceleration that is needed. A shock can separate surfaces
faster than water evaporates: menisci keep their volume, `stiction.contact.separation`, and can hold more.

A device touches n times. If it meets other summits each time, it sticks with :math:`1 - (1 - P)^n`. If it meets the
same ones, it sticks the first time or never, with P. How much touchdowns have in common is unknown: both are bounds.

Flats in contact need the least voltage to stay, see `stiction.contact.voltage`.
"""

import numpy as np

from stiction.beam.cantilever import Beam
from stiction.contact.voltage import Capacitor
from stiction.devices.bridges import pull


def force_at_contact(beam: Beam, clamps: int) -> float:
    """Force of a beam at its tip, 3 EI h / L³, or at its middle, in contact [N]."""
    if clamps == 2:
        return float(pull(beam.length, beam)[0])
    return 3 * beam.bending_stiffness * beam.gap / beam.length**3


def freeing_acceleration(hold: float, restoring_force: float, mass: float) -> float:
    """Least acceleration away from the substrate to free a stopper, zero if its spring does [m s⁻²].

    Examples
    --------
    >>> round(freeing_acceleration(30e-6, 20e-6, 1e-9)), freeing_acceleration(10e-6, 20e-6, 1e-9)
    (10000, 0.0)
    """
    return max(hold - restoring_force, 0.0) / mass


def freeing_potential_of_flats(spare: float, capacitor: Capacitor, area: float) -> float:
    """Potential below which a spring frees flats in contact [V], from the force that it has to spare without one [N].

    Examples
    --------
    >>> from stiction.contact.voltage import Dielectric
    >>> round(freeing_potential_of_flats(1e-6, Capacitor(Dielectric(100e-9, 1.0)), 9e-12), 2)
    15.84
    """
    return float(np.sqrt(max(spare, 0.0) / (area * capacitor.per_volt.largest_pressure)))


def stuck_after(probability: float | np.ndarray, touchdowns: int) -> float | np.ndarray:
    """P(stuck) after n independent touchdowns [-], 1 - (1 - P)^n, from one touchdown's, of any shape.

    Examples
    --------
    >>> round(float(stuck_after(1e-3, 1000)), 3)
    0.632
    """
    with np.errstate(divide="ignore"):  # all stick
        return -np.expm1(touchdowns * np.log1p(-np.asarray(probability, float)))[()]


def probability_for(stuck: float, touchdowns: int) -> float:
    """P(stuck) of one touchdown for a fraction stuck after n independent ones, inverse of `stuck_after` [-].

    Examples
    --------
    >>> round(1e6 * probability_for(0.1, 1000), 1)
    105.4
    """
    return float(-np.expm1(np.log1p(-stuck) / touchdowns))
