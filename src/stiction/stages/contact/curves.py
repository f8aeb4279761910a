"""Force curves at a humidity from the dataset of stage contact; shared by several stages, not a stage itself."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.config.units import from_si
from stiction.contact import forcelaw
from stiction.contact.meniscus import film
from stiction.stages.contact.contact import tables


@dataclass(frozen=True)
class Water:
    """Condensed water."""

    temperature: float  #: T [K]
    contact_angles: tuple[float, float] = (0.0, 0.0)  #: on beam and substrate [rad]


def force_curves(contact: xr.Dataset, humidity: float, water: Water) -> tuple[np.ndarray, Callable[[int], np.ndarray]]:
    """Distance (n_d,) [m] and ``curve(k)``, force of sample k [Pa], from `stiction.contact.forcelaw.humid_curves`."""
    return forcelaw.humid_curves(*tables(contact), film(humidity, water.temperature, water.contact_angles))


def energies(contact: xr.Dataset, humidity: float, water: Water) -> np.ndarray:
    """Adhesion energies e of all samples at a relative humidity (m,) [J m⁻²]."""
    return forcelaw.adhesion_energies(*force_curves(contact, humidity, water), contact.sizes["sample"])


def tip_forces(contact: xr.Dataset, humidity: float, water: Water) -> tuple[np.ndarray, np.ndarray]:
    """Slopes of tips (s,) [-] and the largest attraction of each tip at each slope, per width of the beam (m, s) [N/m].

    Raises
    ------
    ValueError
        If the film is higher than the contact of the tips reaches.
    """
    layer, reach = film(humidity, water.temperature, water.contact_angles), -float(contact.height[0])
    if layer[0] > reach:
        raise ValueError(
            f"the contact of the tips is for films of up to {from_si(reach, 'nm'):.3g} nm, and that at a relative "
            f"humidity of {humidity:g} is {from_si(layer[0], 'nm'):.3g} nm high: state this humidity with the device"
        )
    return contact.slope.values, forcelaw.largest_attractions(*tables(contact), layer) * float(contact.length)


def pull_offs(contact: xr.Dataset, humidity: float, water: Water) -> np.ndarray:
    """Largest attraction f_max of all samples at a relative humidity (m,) [Pa]."""
    return forcelaw.pull_offs(*force_curves(contact, humidity, water), contact.sizes["sample"])


def vectors(contact: xr.Dataset, humidity: float, water: Water) -> tuple[np.ndarray, float]:
    """Vectors v of Eq. (11) of all samples at a relative humidity (m, 4) [SI], and f_limit [Pa]."""
    return forcelaw.parametrise(*force_curves(contact, humidity, water), contact.sizes["sample"])
