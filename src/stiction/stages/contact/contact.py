"""Contact of a pair (Sec. III-A): solid pressure and bearing area of its samples, independent of humidity.

`stiction.stages.contact.changes.table` declares all stages with such a dataset.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from stiction.contact.pair import DistanceGrid, contacts_of_samples
from stiction.contact.tilted import TiltedPair
from stiction.progress import progress
from stiction.rounding import is_at_most
from stiction.stages.contact.pairs import Settings, require_feasible, streams_of_sides, surface_pairs
from stiction.stages.surfaces.heights import moments
from stiction.stages.surfaces.parameters import spectrum_of
from stiction.stages.surfaces.rough_surfaces import sides_of
from stiction.surface.neighbours import mean_height_correlations
from stiction.surface.spectrum import uncorrelated_beyond


def compute(
    surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]],
    pair: str,
    model: str,
    settings: Settings,
    samples: range | None = None,
) -> xr.Dataset:
    """Draw surface pairs and compute p_s(sample, distance) and A(sample, height), in single precision.

    The two surfaces are datasets (heights, spectrum), that of the beam first; the name of the pair is part of the
    addresses of random numbers. Model ``G`` has Gaussian heights, ``NG`` those of the surfaces. All samples are drawn
    by default.
    """
    return compute_each([surfaces], pair, model, settings, samples)[0]


def compute_each(
    alternatives: Sequence[Sequence[tuple[xr.Dataset, xr.Dataset]]],
    pair: str,
    model: str,
    settings: Settings,
    samples: range | None = None,
) -> list[xr.Dataset]:
    """Contacts as by `compute`, for several choices of the two surfaces with the same random numbers.

    A surface with the same tuple of datasets in several choices is drawn once for all of them.
    """
    pairs = surface_pairs(alternatives, model, settings)
    samples = range(settings.contact.samples) if samples is None else samples
    streams = streams_of_sides(settings.seed, pair)
    contacts = contacts_of_samples(pairs, streams, progress(samples, "surface pairs"))
    datasets = [layout(*curves, rough.distances, samples) for curves, rough in zip(contacts, pairs, strict=True)]
    datasets = [_displaced(*each, streams) for each in zip(datasets, pairs, strict=True)]
    if settings.probe:
        # The rms is that of z₁ + z₂, which the bearing area does not show.
        rms = [((), pair.rms) for pair in pairs]
        return [each.assign(rms=of_pair) for each, of_pair in zip(datasets, rms, strict=True)]
    return [tip_dataset(*each) for each in zip(datasets, pairs, strict=True)] if settings.tilt else datasets


def _displaced(contact, pair, streams):
    """Contact with the displacements of its strips, if the beam plays above a surface that it follows."""
    if not (pair.replica and pair.replica.of_heights.play):
        return contact
    displacements = [pair.replica.displacement(streams(int(k))[0]) for k in contact.strip]
    return contact.assign(displacement=("strip", displacements))


def from_surfaces(data: Mapping[str, Any], pair: str, settings: Settings) -> xr.Dataset:
    """Compute from the datasets of both surfaces by stage, of which one can follow the other as stated."""
    require_feasible(sides_of(data), "NG", settings)
    return compute(sides_of(data), pair, "NG", settings)


def layout(solid_pressure: np.ndarray, bearing_area: np.ndarray, grid: DistanceGrid, samples: range) -> xr.Dataset:
    """Dataset of p_s(sample, distance) and A(sample, height), independent of humidity, in float32.

    Solid pressures p_s are (n, n_solid) [Pa] and bearing areas A (n, n_bearing) [-], those of tips (n, n_slopes,
    n_solid) and so on; ``samples`` are their numbers within the study.
    """
    over = ("strip", "slope") if np.ndim(solid_pressure) == 3 else ("strip",)
    return xr.Dataset(
        {
            "solid_pressure": ((*over, "distance"), np.asarray(solid_pressure, np.float32)),
            "bearing_area": ((*over, "height"), np.asarray(bearing_area, np.float32)),
            "step": ((), grid.step),
        },
        coords={
            "strip": np.asarray(samples, np.int32),
            "distance": ("distance", grid.solid),
            "height": ("height", grid.bearing),
        },
    )


def tip_dataset(contact: xr.Dataset, pair: TiltedPair) -> xr.Dataset:
    """Dataset of tips: with their slopes and ends, and the reference length of pressures and areas along the strip."""
    slopes = ("slope", list(pair.tilt.slopes))
    of_strips = {"length": ((), pair.length), "ends": ("slope", pair.tilt.ends)}
    return contact.assign(of_strips).assign_coords(slope=slopes)


def chunk(samples: int, number: int, chunks: int) -> range:
    """Indices of the samples in one of several chunks of nearly equal size."""
    return range(samples * number // chunks, samples * (number + 1) // chunks)


def drawn_chunk(data: Mapping[str, Any], at: Any, settings: Settings) -> xr.Dataset:
    """Compute the samples of one chunk from the datasets of both surfaces by stage and the wildcards of a job."""
    require_feasible(sides_of(data), at.model, settings)
    samples = chunk(settings.contact.samples, int(at.chunk), int(at.number))
    return compute(sides_of(data), at.pair, at.model, settings, samples)


def join_chunks(chunks: Iterable[xr.Dataset], settings: Settings) -> xr.Dataset:
    """Join the contact of all samples from the chunks in their order. Of an iterator, one chunk is held at a time.

    Raises
    ------
    ValueError
        If a chunk has other distances than those before it, or if samples are missing or repeated.
    """
    samples = settings.contact.samples
    pressures = areas = grid = None
    joined_samples, displacements = 0, []
    for chunk in chunks:
        displacements += [chunk[["displacement"]]] if "displacement" in chunk else []
        if grid is None:
            grid = _grid(chunk)
            pressures, areas = (np.empty((samples, n), np.float32) for n in (grid.above, grid.below + grid.above))
        rows = slice(joined_samples, joined_samples + chunk.sizes["strip"])
        if _grid(chunk) != grid or not np.array_equal(chunk.strip, np.arange(samples)[rows]):
            raise ValueError(f"the chunk after {joined_samples} of {samples} samples does not continue the contact")
        pressures[rows], areas[rows] = chunk.solid_pressure, chunk.bearing_area
        joined_samples = rows.stop
    if joined_samples != samples:
        raise ValueError(f"the chunks contain {joined_samples} of {samples} samples")
    joined = layout(pressures, areas, grid, range(samples))
    return joined.merge(xr.concat(displacements, "strip")) if displacements else joined


def _grid(contact):
    """Grid of the distances."""
    above = contact.sizes["distance"]
    return DistanceGrid(float(contact.step), contact.sizes["height"] - above, above)


def first(contact: xr.Dataset, samples: int) -> xr.Dataset:
    """Contact of the first samples alone."""
    return contact.isel(strip=slice(samples))


def with_correlations(
    contact: xr.Dataset, surfaces: Iterable[tuple[xr.Dataset, xr.Dataset]], sides: tuple[float, float]
) -> xr.Dataset:
    """Contact with the correlations of the mean heights of its strips, none if they are longer than their correlation.

    The surfaces are datasets (heights, spectrum), and strips have these sides [m].
    """
    described = [(spectrum_of(spectrum), moments(heights).rms) for heights, spectrum in surfaces]
    reach = max(uncorrelated_beyond(spectrum) for spectrum, _ in described) / sides[0]
    correlations = [] if is_at_most(reach, 1) else mean_height_correlations(described, sides, math.ceil(reach))
    return contact.assign(correlations=("lag", correlations))


def surface_rms(contact: xr.Dataset) -> float:
    r"""Root mean square of z₁ + z₂ from the mean bearing area, :math:`m_2 = 2 \int z (A(z) - [z < 0]) dz` [m].

    That under a probe is stated.
    """
    if "rms" in contact:
        return float(contact.rms)
    height = contact.height.values
    area = contact.bearing_area.values.mean(axis=0, dtype=float)
    return float(np.sqrt(2 * float(contact.step) * np.sum(height * (area - (height < 0)))))


def tables(contact: xr.Dataset) -> tuple[np.ndarray, np.ndarray, tuple[float, float], float]:
    """Solid pressures (m, n_s) [Pa], bearing areas (m, n_b) [-], first distance of each and common step [m]."""
    starts = float(contact.distance[0]), float(contact.height[0])
    return contact.solid_pressure.values, contact.bearing_area.values, starts, float(contact.step)
