"""Study correlation (App. C, Fig. 19c): autocorrelation of the surfaces and their correlation lengths."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from stiction.plan.stage import Stage
from stiction.stages.surfaces import parameters
from stiction.surface.spectrum import autocovariance, correlation_length

#: Distances of the autocorrelation [m].
_LAG = np.linspace(0, 1e-6, 401)


def compute(spectra: Mapping[str, xr.Dataset], surfaces: Sequence[str]) -> xr.Dataset:
    """Transform the spectra of surfaces, by name, Eq. (7)."""
    targets = [parameters.spectrum_of(spectra[name]) for name in surfaces]
    covariances = [autocovariance(target, _LAG) for target in targets]
    lengths = [correlation_length(target) for target in targets]
    return layout(surfaces, _LAG, [c / c[0] for c in covariances], lengths)


def layout(surfaces: Sequence[str], lag: np.ndarray, correlations: Sequence, lengths: Sequence[float]) -> xr.Dataset:
    """Normalised autocorrelation of surfaces (n_s, n) [-] over the distance, and correlation lengths (n_s,) [m]."""
    return xr.Dataset(
        {
            "autocorrelation": (("surface", "lag"), correlations),
            "correlation_length": ("surface", lengths),
        },
        coords={"surface": list(surfaces), "lag": ("lag", lag)},
    )


STAGES = (
    Stage.writing(
        "correlation",
        "studies/correlation",
        inputs=lambda plan, at: {"spectra": {name: f"spectrum/{name}" for name in plan.surfaces}},
        settings=lambda plan, at: {"surfaces": plan.surfaces},
        compute=compute,
        message="Autocorrelation of the surfaces (App. C).",
    ),
)
