"""Study scan_uncertainty: uncertainty of the adhesion energy of a pair due to finite scans of measured surfaces.

To first order the error of ln ē is the product of its slopes and the errors of the estimate, so that its variance is
g C g with the covariance C of the estimate. The errors of skewness and kurtosis of a scan largely compensate: without
their correlation the result would be three times too large.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.analysis.variants import relative_shift
from stiction.devices.budget import Budget, joined
from stiction.measured import estimate as stage_estimate
from stiction.models import OF_MOMENTS, OF_SPECTRUM
from stiction.stages.curves import energies
from stiction.studies import slopes as study_slopes
from stiction.studies.slopes import Settings

#: What an estimate consists of.
PARTS = ("rms", "shape", "spectrum", "total")
#: Relative standard error of ē that a sufficient number of scans would not exceed [-].
GOAL = 0.05


@dataclass(frozen=True)
class Errors:
    """Errors of the estimate of a surface from its scans."""

    names: tuple[str, ...]  #: quantities of the heights, ``rms`` first, see `stiction.analysis.shifts`
    heights: np.ndarray  #: their covariance, (k, k) [-]
    spectrum: np.ndarray  #: covariance of (ln corner, slope) of Eq. (7), (2, 2) [-]
    scans: int  #: number of scans


def errors_of(estimate: xr.Dataset, quantities: Sequence[str]) -> Errors:
    """Errors of some quantities of a surface, from its dataset of stage estimate."""
    names = tuple(name for name in quantities if name not in OF_SPECTRUM)
    covariance = estimate.covariance if names == OF_MOMENTS else estimate.mode_covariance
    scans = len(stage_estimate.files(estimate))
    return Errors(names, covariance.values, estimate.fit_covariance.values[1:, 1:], scans)


def compute(
    slopes: Mapping[str, xr.Dataset],
    errors: Mapping[str, Errors],
    base: xr.Dataset,
    choices: Mapping[str, xr.Dataset],
    settings: Settings,
) -> xr.Dataset:
    """Relative standard errors of ē by surface and part, the scans that would be sufficient, and the effect of choices.

    ASSUME: the errors of moments and spectrum are independent.

    Parameters
    ----------
    slopes : dict
        Surface to its dataset of study slopes.
    errors : dict
        Surface to the errors of its estimate.
    base : Dataset
        Contact of the pair, of as many samples at least as those of the choices.
    choices : dict
        Choice, key of `stiction.models.CHOICES`, to the contact with its other value.
    settings : Settings
    """
    found = {name: _parts(dataset, errors[name]) for name, dataset in slopes.items()}
    changes = {name: _changes(contact, base, settings) for name, contact in choices.items()}
    parts = np.array(list(found.values()))
    return layout(list(found), settings.humidities, parts, [errors[name].scans for name in found], changes)


def _parts(slopes, errors):
    """Relative errors of ē by the parts of one surface, (parts, n_rh) [-]."""
    groups = errors.names[:1], errors.names[1:], OF_SPECTRUM
    columns = []
    for of_heights, of_spectrum in zip(*(study_slopes.of(slopes, n) for n in (errors.names, OF_SPECTRUM)), strict=True):
        heights = Budget(errors.names, of_heights, errors.heights)
        budget = joined([heights, Budget(OF_SPECTRUM, of_spectrum, errors.spectrum)])
        columns.append([*map(budget.effect, groups), budget.total])
    return np.transpose(columns)


def _changes(contact, base, settings):
    """Relative change of ē by a choice and its standard error, (n_rh, 2) [-]."""
    same = base.isel(sample=slice(contact.sizes["sample"]))
    pairs = ([energies(of, h, settings.water) for of in (contact, same)] for h in settings.humidities)
    return [relative_shift(*pair) for pair in pairs]


def layout(
    surfaces: Sequence[str],
    humidities: Sequence[float],
    errors: np.ndarray,
    scans: Sequence[int],
    choices: Mapping[str, Sequence[tuple[float, float]]],
) -> xr.Dataset:
    """Dataset of the relative errors of ē.

    Parameters
    ----------
    surfaces : sequence
        Names.
    humidities : sequence
        Relative humidities RH [-].
    errors : (n_surfaces, parts, n_rh) array
        Of the `PARTS` of an estimate [-].
    scans : sequence
        Number of scans of each surface.
    choices : dict
        Choice to the relative change of ē and its standard error, (n_rh, 2) [-].
    """
    total = errors[:, -1]
    changes = np.array(list(choices.values())).reshape(len(choices), len(humidities), 2)
    return xr.Dataset(
        {
            "error": (("surface", "part", "humidity"), errors, {"units": "1", "long_name": "standard error of ln e"}),
            "pair_error": ("humidity", np.sqrt(np.sum(total**2, axis=0)), {"units": "1"}),
            "change": (("choice", "humidity"), changes[..., 0], {"units": "1", "long_name": "relative change of e"}),
            "change_error": (("choice", "humidity"), changes[..., 1], {"units": "1"}),
            "scans": ("surface", list(scans)),
            "scans_needed": (("surface", "humidity"), scans_needed(total, np.array(scans)[:, None], GOAL)),
        },
        coords={"surface": list(surfaces), "choice": list(choices), "part": list(PARTS), "humidity": list(humidities)},
    )


def scans_needed(error: np.ndarray, scans: np.ndarray, goal: float) -> np.ndarray:
    """Number of scans that reduces an error from a number of scans to the goal; it falls with the root of the number.

    Examples
    --------
    >>> int(scans_needed(0.129, 1, 0.05))
    7
    """
    return np.ceil(scans * (error / goal) ** 2).astype(int)


def pair_errors(dataset: xr.Dataset) -> dict[float, float]:
    """Relative standard error of ē by humidity, by the scans of both surfaces."""
    return dict(zip(dataset.humidity.values.tolist(), dataset.pair_error.values.tolist(), strict=True))
