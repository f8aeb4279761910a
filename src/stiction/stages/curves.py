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
    forces = map(curve, range(contact.sizes["sample"]))
    return np.array([forcelaw.adhesion_energy(distance, f) if _resist(f) else flooded for f in forces])


def tip_pull_offs(contact: xr.Dataset, humidity: float, water: Water) -> np.ndarray:
    """Largest attraction f_max of the strips of `tip_energies` (m,) [Pa].

    ASSUME: where the solids do not stop the attraction, f_max is the largest on the grid, at the mean planes or above.
    """
    distance, curve = force_curves(contact, humidity, water)
    forces = map(curve, range(contact.sizes["sample"]))
    return np.array([forcelaw.extremum(distance, f)[1] if _resist(f) else -f.min() for f in forces])


def _resist(force):
    """Whether the solids stop the attraction at some distance below that of its maximum."""
    return force[: int(np.argmin(force)) + 1].max() >= 0


def pull_offs(contact: xr.Dataset, humidity: float, water: Water) -> np.ndarray:
    """Largest attraction f_max of all samples at a relative humidity (m,) [Pa]."""
    return forcelaw.pull_offs(*force_curves(contact, humidity, water), contact.sizes["sample"])


def vectors(contact: xr.Dataset, humidity: float, water: Water) -> tuple[np.ndarray, float]:
    """Vectors v of Eq. (11) of all samples at a relative humidity (m, 4) [SI], and f_limit [Pa]."""
    return forcelaw.parametrise(*force_curves(contact, humidity, water), contact.sizes["sample"])
