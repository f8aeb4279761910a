"""Stage contact (Sec. III-A): solid pressure and bearing area of the sampled pairs, independent of humidity."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.contact.pair import DistanceGrid, contact_of_samples
from stiction.progress import progress
from stiction.stages.pairs import Contact, Solid, streams_of_sides, surface_pair
from stiction.stages.surfaces import Sampling, Width


@dataclass(frozen=True)
class Settings:
    """Everything that the contact of a pair depends on apart from its surfaces; independent of humidity."""

    seed: int
    sampling: Sampling
    solid: Solid
    van_der_waals: str
    contact: Contact
    beam: Width
    surfaces: tuple[str, ...] = ()  #: names of the two surfaces; they do not affect the results


def compute(
    surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]],
    pair: str,
    model: str,
    settings: Settings,
    samples: range | None = None,
) -> xr.Dataset:
    """Draw surface pairs and compute p_s(sample, distance) and A(sample, height), in single precision.

    Parameters
    ----------
    surfaces : sequence
        Datasets (heights, spectrum) of the surfaces of beam and substrate.
    pair : str
        Name of the pair, part of the addresses of random numbers.
    model : str
        ``NG``, or ``G`` for surfaces with Gaussian heights.
    settings : Settings
    samples : range, optional
        Indices of the samples; all by default.
    """
    meeting = surface_pair(surfaces, model, settings)
    samples = range(settings.contact.samples) if samples is None else samples
    streams = streams_of_sides(settings.seed, pair)
    curves = contact_of_samples(meeting, streams, progress(samples, "surface pairs"))
    return layout(*curves, meeting.distances, samples)


def layout(solid_pressure: np.ndarray, bearing_area: np.ndarray, grid: DistanceGrid, samples: range) -> xr.Dataset:
    """Dataset of p_s(sample, distance) and A(sample, height), independent of humidity; float32.

    Parameters
    ----------
    solid_pressure, bearing_area : (n, n_solid), (n, n_bearing) arrays
        Solid pressure p_s [Pa] and bearing area A [-].
    grid : DistanceGrid
    samples : range
        Indices of the samples within the study.
    """
    return xr.Dataset(
        {
            "solid_pressure": (("sample", "distance"), np.asarray(solid_pressure, np.float32), {"units": "Pa"}),
            "bearing_area": (("sample", "height"), np.asarray(bearing_area, np.float32), {"units": "1"}),
            "step": ((), grid.step, {"units": "m"}),
        },
        coords={
            "sample": np.asarray(samples, np.int32),
            "distance": ("distance", grid.solid, {"units": "m"}),
            "height": ("height", grid.bearing, {"units": "m"}),
        },
    )


def chunk(samples: int, number: int, chunks: int) -> range:
    """Indices of the samples in one of several chunks of nearly equal size."""
    return range(samples * number // chunks, samples * (number + 1) // chunks)


def joined(chunks: Sequence[xr.Dataset]) -> xr.Dataset:
    """Contact of all samples, joined from the chunks in the order of the samples."""
    return xr.concat(chunks, "sample", data_vars="minimal", coords="minimal", compat="equals", join="exact")


def tables(contact: xr.Dataset) -> tuple[np.ndarray, np.ndarray, tuple[float, float], float]:
    """Solid pressures (m, n_s) [Pa], bearing areas (m, n_b) [-], first distance of each and common step [m]."""
    starts = float(contact.distance[0]), float(contact.height[0])
    return contact.solid_pressure.values, contact.bearing_area.values, starts, float(contact.step)
