r"""What frees a device: the force of its spring, a shock, and how often it may touch.

A shock frees a stopper if its inertia adds what the spring lacks, :math:`a = (F_\mathrm{hold} - F) / m`. With the force
:math:`F_\mathrm{hold}` of slow separation it is the least acceleration that is needed. A shock can separate surfaces
faster than water evaporates: menisci keep their volume, `stiction.contact.separation`, and can hold more.

A device touches n times. If it meets other summits each time, it sticks with :math:`1 - (1 - P)^n`. If it meets the
same ones, it sticks the first time or never, with P. How much touchdowns have in common is unknown: both are bounds.

A voltage V adds :math:`V^2 g(d)` to the attraction f(d) of a patch at the distance d. A spring that pulls with p per
area frees the patch if it is stronger at every distance, :math:`p > f(d) + V^2 g(d)`, hence below the voltage with
:math:`V^2 = \min_d (p - f) / g`. Flats in contact, :math:`g = \epsilon_0 / 2 D^2`, need the least voltage to stay.
"""

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

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


def freeing_potential_of_flats(spare: float, capacitor: Capacitor, area: float) -> float:
    """Potential below which a spring frees flats in contact [V], from the force that it has to spare without one [N].

    Examples
    --------
    >>> from stiction.contact.voltage import Dielectric
    >>> round(freeing_potential_of_flats(1e-6, Capacitor(Dielectric(100e-9, 1.0)), 9e-12), 2)
    15.84
    """
    return float(np.sqrt(max(spare, 0.0) / (area * capacitor.per_volt.largest_pressure)))


def stuck_after(probability: float, touchdowns: int) -> float:
    """P(stuck) after n independent touchdowns [-], 1 - (1 - P)^n, from one touchdown's.

    Examples
    --------
    >>> round(stuck_after(1e-3, 1000), 3)
    0.632
    """
    return float(-np.expm1(touchdowns * np.log1p(-probability))) if probability < 1 else 1.0


def probability_for(stuck: float, touchdowns: int) -> float:
    """P(stuck) of one touchdown for a fraction stuck after n independent ones, inverse of `stuck_after` [-].

    Examples
    --------
    >>> round(1e6 * probability_for(0.1, 1000), 1)
    105.4
    """
    return float(-np.expm1(np.log1p(-stuck) / touchdowns))
