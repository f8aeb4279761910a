"""Stage heights (Sec. II-A): the maximum-entropy height density of one surface."""

import warnings
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from stiction.plan.stage import Stage, select
from stiction.surface import maxent
from stiction.surface.empirical import MeasuredDensity
from stiction.surface.feasible import Moments, nearest_feasible
from stiction.surface.maxent import GAUSSIAN, HeightDensity
from stiction.surface.translation import Density


@dataclass(frozen=True)
class Settings:
    """Moments of the heights, Eq. (2)."""

    rms: float  #: [m]
    skewness: float  #: [-]
    kurtosis: float  #: [-]


def compute(settings: Settings) -> xr.Dataset:
    """Solve for the maximum-entropy density with the moments of the surface, or with the nearest feasible ones.

    ASSUME: if no maximum-entropy density has the measured moments, they are off by sampling error, and the nearest
    feasible ones are used. A warning states both.

    Raises
    ------
    ValueError, NotConverged
        As `stiction.surface.feasible.nearest_feasible`.
    """
    feasible = nearest_feasible(settings.skewness, settings.kurtosis)
    feasible_settings = replace(settings, skewness=feasible.skewness, kurtosis=feasible.kurtosis)
    measured = Moments(settings.skewness, settings.kurtosis, feasible.distance) if feasible.distance else None
    dataset = layout(maxent.solve(feasible.skewness, feasible.kurtosis), feasible_settings, measured)
    if measured:
        warnings.warn(substitution(dataset), stacklevel=2)
    return dataset


def layout(density: Density, moments: Settings, measured: Moments | None = None) -> xr.Dataset:
    """Dataset of the height density of one surface and its moments.

    ``measured`` are measured moments, and the distance of those of a maximum-entropy density from them; by default
    there are none.
    """
    z = np.linspace(-6, 6, 601)
    form = _measured_form if isinstance(density, MeasuredDensity) else _maximum_entropy
    variables, coordinates = form(density)
    return xr.Dataset(
        variables
        | {
            "density": ("height", density(z)),
            "rms": ((), moments.rms),
            "skewness": ((), moments.skewness),
            "kurtosis": ((), moments.kurtosis),
        }
        | ({} if measured is None else _measured_variables(measured)),
        coords=coordinates | {"height": ("height", z)},
    )


def _maximum_entropy(density):
    """Variables and coordinates of Eq. (3)."""
    return {"multiplier": ("order", list(density.multipliers))}, {"order": [1, 2, 3, 4]}


def _measured_form(density):
    """Variables and coordinates of measured quantiles."""
    return {"quantile": ("score", density.heights)}, {"score": ("score", density.scores)}


def _measured_variables(moments):
    """Variables of the measured moments."""
    return {
        "measured_skewness": ((), moments.skewness),
        "measured_kurtosis": ((), moments.kurtosis),
        "distance": ((), moments.distance),
    }


def density(heights: xr.Dataset, model: str) -> Density:
    """Height density of model ``NG``, or the Gaussian one of model ``G``."""
    if model == "G":
        return GAUSSIAN
    if "score" in heights:
        return MeasuredDensity(heights.score.values, heights["quantile"].values)
    return HeightDensity(tuple(map(float, heights.multiplier)))


def moments(heights: xr.Dataset) -> Settings:
    """Moments of the density."""
    return Settings(float(heights.rms), float(heights.skewness), float(heights.kurtosis))


def measured_moments(heights: xr.Dataset) -> Moments:
    """Measured skewness and kurtosis, and the distance of those of the density from them in standard errors."""
    if "distance" not in heights:
        return Moments(float(heights.skewness), float(heights.kurtosis), 0.0)
    return Moments(*(float(heights[name]) for name in ("measured_skewness", "measured_kurtosis", "distance")))


def substitution(heights: xr.Dataset) -> str:
    """Sentence about moments in place of the measured ones, or nothing if the density has the measured ones."""
    skewness, kurtosis, distance = measured_moments(heights)
    if not distance:
        return ""
    return (
        f"no maximum-entropy density has the measured skewness {skewness:.4g} and kurtosis {kurtosis:.4g}; the heights "
        f"have the nearest feasible ones, {float(heights.skewness):.4g} and {float(heights.kurtosis):.4g}, "
        f"{distance:.2g} standard errors away"
    )


STAGES = (
    Stage.writing(
        "heights",
        "heights/{surface}",
        surfaces=lambda plan: plan.scans.described_by_numbers,
        settings=lambda plan, at: select(Settings, plan.config["surfaces"][at.surface]),
        kind=Settings,
        compute=compute,
        message="Maximum-entropy height density of {surface} (Sec. II-A).",
    ),
)
