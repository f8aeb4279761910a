"""Force curves at a humidity from the dataset of stage contact; shared by several stages, not a stage itself."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.contact import forcelaw
from stiction.contact.meniscus import film, flooded_energy
from stiction.stages.contact import tables


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


def tip_energies(contact: xr.Dataset, humidity: float, water: Water) -> np.ndarray:
    """Adhesion energies e of strips as short as the wedge at the tip of a beam (m,) [J m⁻²].

    ASSUME: where the solids stop the attraction at no distance between the mean planes, because a short strip lies low
    as a whole (1 of 40 000 tips of pair b), the energy is that of flooded flats, the largest that water alone can give.
    """
    distance, curve = force_curves(contact, humidity, water)
    flooded = flooded_energy(water.temperature, water.contact_angles)

    def energy(force):
        resists = force[: int(np.argmin(force)) + 1].max() >= 0
        return forcelaw.adhesion_energy(distance, force) if resists else flooded

    return np.array([energy(curve(k)) for k in range(contact.sizes["sample"])])


def pull_offs(contact: xr.Dataset, humidity: float, water: Water) -> np.ndarray:
    """Largest attraction f_max of all samples at a relative humidity (m,) [Pa]."""
    return forcelaw.pull_offs(*force_curves(contact, humidity, water), contact.sizes["sample"])


def vectors(contact: xr.Dataset, humidity: float, water: Water) -> tuple[np.ndarray, float]:
    """Vectors v of Eq. (11) of all samples at a relative humidity (m, 4) [SI], and f_limit [Pa]."""
    return forcelaw.parametrise(*force_curves(contact, humidity, water), contact.sizes["sample"])
