"""Force curves at a humidity from the dataset of stage contact. Shared by several stages, not a stage itself."""

from functools import partial

import numpy as np
import xarray as xr

from stiction.config.units import from_si
from stiction.contact import environment, forcelaw, gaps
from stiction.contact.environment import ForceCurves, Water
from stiction.contact.separation import keep_volume
from stiction.stages.contact.contact import tables


def force_curves(contact: xr.Dataset, humidity: float, water: Water) -> ForceCurves:
    """Force curves at a relative humidity."""
    return environment.force_curves(*tables(contact), humidity, water)


def parametrised(sampled: ForceCurves, humidity: float, water: Water) -> tuple[np.ndarray, float]:
    """Vectors v of Eq. (11) of force curves (m, 4) [SI] and f_limit [Pa], corrected to full elastic contact if wanted.

    ASSUME: one ratio of e and one of f_max at a humidity hold for all samples, on strips and patches of any size.
    """
    vectors = forcelaw.parametrise(*sampled)
    return water.correction.vectors(*vectors, humidity) if water.correction else vectors


def energies(contact: xr.Dataset, humidity: float, water: Water) -> np.ndarray:
    """Adhesion energies e of all samples at a relative humidity (m,) [J m⁻²]."""
    energies = forcelaw.adhesion_energies(*force_curves(contact, humidity, water))
    return energies * water.correction.at(humidity)[0] if water.correction else energies


def tip_forces(contact: xr.Dataset, humidity: float, water: Water) -> tuple[np.ndarray, np.ndarray]:
    """Slopes of tips (s,) [-] and the largest attraction of each tip at each slope, per width of the beam (m, s) [N/m].

    Across gaps, the wedge below the stored heights attracts like a plane of its slope. Tips are not corrected to full
    elastic contact, which is not computed on tilted strips.

    Raises
    ------
    ValueError
        If the film is higher than the contact of the tips reaches.
    """
    return contact.slope.values, _wedges(contact, humidity, water, endless=True)


def tilted_forces(contact: xr.Dataset, humidity: float, water: Water) -> np.ndarray:
    """Largest attraction of each tilted patch at each slope, per its width (m, s) [N/m]; errors as of `tip_forces`.

    ASSUME: the ratio of the pull-off force on parallel patches to full elastic contact is that on tilted ones.
    """
    forces = _wedges(contact, humidity, water, endless=False)
    return forces * water.correction.at(humidity)[1] if water.correction else forces


def _wedges(contact, humidity, water, endless):
    """Largest attractions per width of strips that go on below their stored heights or end there (m, s) [N/m]."""
    layer, reach = water.film(humidity), -float(contact.height[0])
    if layer[0] > reach:
        raise ValueError(
            f"the contact of the tips is for films of up to {from_si(reach, 'nm'):.3g} nm, and that at a relative "
            f"humidity of {humidity:g} is {from_si(layer[0], 'nm'):.3g} nm high: state this humidity with the device"
        )
    solid, bearing, starts, step = tables(contact)
    if water.reaches_across:
        work = partial(water.work_across, height=layer[0])
        pressure, _ = gaps.gap_pressures(bearing, starts[1], contact.distance.values, step, work)
        rest = work(contact.distance.values + reach) / (contact.slope.values[:, None] * float(contact.length))
        solid = solid + pressure - endless * rest.astype(np.float32)
    return forcelaw.largest_attractions(solid, bearing, starts, step, layer) * float(contact.length)


def pull_offs(contact: xr.Dataset, humidity: float, water: Water) -> np.ndarray:
    """Largest attraction f_max of all samples at a relative humidity (m,) [Pa]."""
    sampled = force_curves(contact, humidity, water)
    forces = forcelaw.pull_offs(*sampled[:3], sampled.flat)
    return forces * water.correction.at(humidity)[1] if water.correction else forces


def fast_pull_offs(contact: xr.Dataset, humidity: float, water: Water) -> np.ndarray:
    """As `pull_offs`, of surfaces that separate faster than water evaporates; infinite where no summits stop them."""
    _, fast = _separations(contact, humidity, water)
    forces = np.array([np.inf if one is None else -one[0].min() for one in fast])
    return forces * water.correction.at(humidity)[1] if water.correction else forces


def fast_energies(contact: xr.Dataset, humidity: float, water: Water) -> np.ndarray:
    """As `energies`, of surfaces that separate faster than water evaporates; infinite where no summits stop them."""
    sampled, fast = _separations(contact, humidity, water)
    beyond = np.zeros(sampled.samples) if sampled.beyond is None else sampled.beyond
    energies = [
        np.inf if one is None else forcelaw.adhesion_energy(sampled.distance, one[0], beyond[k] + one[1])
        for k, one in enumerate(fast)
    ]
    return np.array(energies) * (water.correction.at(humidity)[0] if water.correction else 1.0)


def _separations(contact, humidity, water):
    """Force curves at a relative humidity, and those of fast separations one by one."""
    sampled, (_, bearing, starts, _) = force_curves(contact, humidity, water), tables(contact)
    layer = water.film(humidity)
    return sampled, (
        keep_volume(sampled.curve(k), sampled.distance, bearing[k], starts[1], layer) for k in range(sampled.samples)
    )


def share_flat(contact: xr.Dataset, humidity: float, water: Water) -> float:
    """Fraction of the samples at a relative humidity to count as flat surfaces, not stopped by summits [-]."""
    sampled = force_curves(contact, humidity, water)
    return forcelaw.share_flat(sampled.curve, sampled.samples) if sampled.flat else 0.0


def vectors(contact: xr.Dataset, humidity: float, water: Water) -> tuple[np.ndarray, float]:
    """Vectors v of Eq. (11) of all samples at a relative humidity (m, 4) [SI], and f_limit [Pa]."""
    return parametrised(force_curves(contact, humidity, water), humidity, water)
