"""Force curves at a humidity from the dataset of stage contact; shared by several stages, not a stage itself."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
import xarray as xr

from stiction.config.units import from_si
from stiction.contact import bounds, forcelaw, gaps, vanderwaals
from stiction.contact.meniscus import film
from stiction.stages.contact.contact import tables


@dataclass(frozen=True)
class Gaps:
    """Attraction across the gaps between the solids."""

    hamaker_constant: dict[str, float]  #: of the two solids, by medium [J]
    summits: str  #: medium through which the summits attract, whose work is not counted again
    wavelength: float = np.inf  #: of the retardation [m]

    def through(self, medium: str) -> gaps.FlatAttraction:
        """Attraction of flats through a medium."""
        return gaps.FlatAttraction(self.hamaker_constant[medium], self.wavelength)

    def work(self, gap: float | np.ndarray, height: float) -> float | np.ndarray:
        """Work of two flats beyond that of the summits [J m⁻²], at gaps [m] and under a film of a height [m].

        If the summits attract through dry air, so do the solids across the film.
        """
        counted = vanderwaals.attraction(self.summits, self.hamaker_constant[self.summits])
        return gaps.work_across_film(gap, height, self.through(self.summits), self.through("dry")) - counted.work(gap)


@dataclass(frozen=True)
class Water:
    """Condensed water, and what attracts where there is none."""

    temperature: float  #: T [K]
    contact_angles: tuple[float, float] = (0.0, 0.0)  #: on beam and substrate [rad]
    gaps: Gaps | None = None  #: attraction across the gaps; without it, only the summits attract

    def film(self, humidity: float) -> tuple[float, float]:
        """Height h_C [m] and tension -ΔP [Pa] at a relative humidity, see `stiction.contact.meniscus.film`."""
        return film(humidity, self.temperature, self.contact_angles)


class ForceCurves(NamedTuple):
    """Force curves of all samples, as `stiction.contact.forcelaw.parametrise` takes them."""

    distance: np.ndarray  #: d (n_d,) [m]
    curve: Callable[[int], np.ndarray]  #: force of sample k (n_d,) [Pa]
    samples: int
    beyond: np.ndarray | None = None  #: energy beyond the last distance, where attraction reaches farther (m,) [J m⁻²]


def force_curves(contact: xr.Dataset, humidity: float, water: Water) -> ForceCurves:
    """Force curves at a relative humidity."""
    layer, (solid, bearing, starts, step) = water.film(humidity), tables(contact)
    distance, curve = forcelaw.humid_curves(solid, bearing, starts, step, layer)
    if water.gaps is None:
        return ForceCurves(distance, curve, len(solid))
    work = partial(water.gaps.work, height=layer[0])
    pressure, beyond = gaps.gap_pressures(bearing, starts[1], distance, step, work)
    return ForceCurves(distance, lambda k: curve(k) + pressure[k], len(solid), beyond)


def flooded_law(humidity: float, water: Water, hamaker_constant: float) -> tuple[float, float]:
    """Upper bounds of e [J m⁻²] and f_max [Pa] of any surfaces, see `stiction.contact.bounds.flooded_law`."""
    layer = water.film(humidity)
    energy, pull = bounds.flooded_law(layer, hamaker_constant)
    if water.gaps is None:
        return energy, pull
    return energy + float(water.gaps.work(0.0, layer[0])), pull + water.gaps.through("dry").largest_pressure


def energies(contact: xr.Dataset, humidity: float, water: Water) -> np.ndarray:
    """Adhesion energies e of all samples at a relative humidity (m,) [J m⁻²]."""
    return forcelaw.adhesion_energies(*force_curves(contact, humidity, water))


def tip_forces(contact: xr.Dataset, humidity: float, water: Water) -> tuple[np.ndarray, np.ndarray]:
    """Slopes of tips (s,) [-] and the largest attraction of each tip at each slope, per width of the beam (m, s) [N/m].

    Across gaps, the wedge below the stored heights attracts like a plane of its slope.

    Raises
    ------
    ValueError
        If the film is higher than the contact of the tips reaches.
    """
    layer, reach = water.film(humidity), -float(contact.height[0])
    if layer[0] > reach:
        raise ValueError(
            f"the contact of the tips is for films of up to {from_si(reach, 'nm'):.3g} nm, and that at a relative "
            f"humidity of {humidity:g} is {from_si(layer[0], 'nm'):.3g} nm high: state this humidity with the device"
        )
    solid, bearing, starts, step = tables(contact)
    if water.gaps is not None:
        work = partial(water.gaps.work, height=layer[0])
        pressure, _ = gaps.gap_pressures(bearing, starts[1], contact.distance.values, step, work)
        rest = work(contact.distance.values + reach) / (contact.slope.values[:, None] * float(contact.length))
        solid = solid + pressure - rest.astype(np.float32)
    largest = forcelaw.largest_attractions(solid, bearing, starts, step, layer)
    return contact.slope.values, largest * float(contact.length)


def pull_offs(contact: xr.Dataset, humidity: float, water: Water) -> np.ndarray:
    """Largest attraction f_max of all samples at a relative humidity (m,) [Pa]."""
    return forcelaw.pull_offs(*force_curves(contact, humidity, water)[:3])


def vectors(contact: xr.Dataset, humidity: float, water: Water) -> tuple[np.ndarray, float]:
    """Vectors v of Eq. (11) of all samples at a relative humidity (m, 4) [SI], and f_limit [Pa]."""
    return forcelaw.parametrise(*force_curves(contact, humidity, water))
