"""Stage heights (Sec. II-A): the maximum-entropy height density of one surface."""

from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.surface import maxent
from stiction.surface.maxent import GAUSSIAN, HeightDensity


@dataclass(frozen=True)
class Settings:
    """Moments of the heights, Eq. (2)."""

    rms: float  #: [m]
    skewness: float  #: [-]
    kurtosis: float  #: [-]


def compute(settings: Settings) -> xr.Dataset:
    """Solve for the maximum-entropy density with the moments of the surface."""
    return layout(maxent.solve(settings.skewness, settings.kurtosis), settings)


def layout(density: HeightDensity, moments: Settings) -> xr.Dataset:
    """Dataset of the maximum-entropy density of one surface.

    Parameters
    ----------
    density : HeightDensity
    moments : Settings
    """
    z = np.linspace(-6, 6, 601)
    return xr.Dataset(
        {
            "multiplier": (
                "order",
                list(density.multipliers),
                {"units": "1", "long_name": "λ of Eq. (3), standardised heights"},
            ),
            "density": (
                "height",
                density(z),
                {"units": "1", "long_name": "probability density of the standardised height"},
            ),
            "rms": ((), moments.rms, {"units": "m"}),
            "skewness": ((), moments.skewness, {"units": "1"}),
            "kurtosis": ((), moments.kurtosis, {"units": "1"}),
        },
        coords={"order": [1, 2, 3, 4], "height": ("height", z, {"units": "1"})},
    )


def density(heights: xr.Dataset, model: str) -> HeightDensity:
    """Height density of model ``NG``, or the Gaussian one of model ``G``."""
    return HeightDensity(tuple(map(float, heights.multiplier))) if model == "NG" else GAUSSIAN


def moments(heights: xr.Dataset) -> Settings:
    """Moments for which the density was solved."""
    return Settings(float(heights.rms), float(heights.skewness), float(heights.kurtosis))
