"""Study scan_uncertainty: uncertainty of the adhesion energy of a pair due to finite scans of measured surfaces.

To first order the error of ln ē is the product of its slopes and the errors of the estimate, so that its variance is
g C g with the covariance C of the estimate. The errors of skewness and kurtosis of a scan largely compensate: without
their correlation the result would be three times too large.

ASSUME: the errors of moments and spectrum are independent, and so are those of the slopes. The form of measured heights
errs in its modes alone.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import xarray as xr

from stiction.analysis.variants import relative_shift
from stiction.devices.budget import Budget, joined
from stiction.models import ALTERNATIVES_OF_SCANS, MODE_QUANTITIES, MOMENT_QUANTITIES, SPECTRUM_QUANTITIES
from stiction.plan.stage import Stage, select
from stiction.stages.contact.contact import first
from stiction.stages.contact.curves import energies
from stiction.stages.laws import slopes as study_slopes
from stiction.stages.laws.slopes import Settings
from stiction.stages.surfaces import estimate as stage_estimate

#: What an estimate consists of.
PARTS = ("rms", "shape", "spectrum", "total")
#: Relative standard error of ē that a sufficient number of scans would not exceed [-].
GOAL = 0.05
#: A sum of relative variances that exceeds 1 by this rounding error does not need another scan.
_ROUNDING = 16 * np.finfo(float).eps


@dataclass(frozen=True)
class ScanErrors:
    """Errors of the estimate of a surface from its scans."""

    names: tuple[str, ...]  #: quantities of the heights, ``rms`` first, see `stiction.analysis.shifts`
    heights: np.ndarray  #: their covariance, (k, k) [-]
    modes: np.ndarray  #: covariance of the modes of the measured form, (7, 7) [-]
    spectrum: np.ndarray  #: covariance of (ln corner, slope) of Eq. (7), (2, 2) [-]
    scans: int  #: number of scans


class Uncertainty(NamedTuple):
    """Relative standard errors of ē by the scans of several surfaces [-]."""

    parts: np.ndarray  #: of the `PARTS` of the estimates, (n_surfaces, parts, n_rh)
    sampling: np.ndarray  #: standard errors of the total by the samples of the slopes, (n_surfaces, n_rh)
    form: np.ndarray  #: of the measured form, whatever the heights of the surface are, (n_surfaces, n_rh)


def errors_of(estimate: xr.Dataset, quantities: Sequence[str]) -> ScanErrors:
    """Errors of a surface from its dataset of stage estimate. Its heights have the moments if these have slopes."""
    names = MOMENT_QUANTITIES if set(MOMENT_QUANTITIES) <= set(quantities) else MODE_QUANTITIES
    modes = estimate.mode_covariance.values
    heights = estimate.covariance.values if names == MOMENT_QUANTITIES else modes
    scans = len(stage_estimate.files(estimate))
    return ScanErrors(names, heights, modes[1:, 1:], estimate.fit_covariance.values[1:, 1:], scans)


def errors_by_surface(slopes: Mapping[str, xr.Dataset], estimates: Mapping[str, xr.Dataset]) -> dict[str, ScanErrors]:
    """Surface to the errors of its estimate in the quantities of its slopes. Datasets of these names by surface."""
    return {name: errors_of(estimate, study_slopes.quantities(slopes[name])) for name, estimate in estimates.items()}


def compute(
    slopes: Mapping[str, xr.Dataset],
    errors: Mapping[str, ScanErrors],
    base: xr.Dataset,
    choices: Mapping[str, xr.Dataset],
    settings: Settings,
) -> xr.Dataset:
    """Relative standard errors of ē by surface and part, sufficient numbers of scans, and the effect of choices.

    Slopes and errors of the estimates are by surface. The base is the contact of the pair, of as many samples at least
    as those of the choices, keys of `stiction.models.ALTERNATIVES_OF_SCANS` with the contact under the other value.
    """

    def by_surface(function):
        """Values of one function for every surface."""
        return np.array([function(dataset, errors[name]) for name, dataset in slopes.items()])

    uncertainty = Uncertainty(*map(by_surface, (_parts, _sampling, _form)))
    changes = {name: _changes(contact, base, settings) for name, contact in choices.items()}
    return layout(list(slopes), settings.humidities, uncertainty, [errors[name].scans for name in slopes], changes)


def _budgets(slopes, errors):
    """Budget of ln ē and the standard errors of its slopes, one after the other for every humidity."""
    names = (*errors.names, *SPECTRUM_QUANTITIES)
    of_slopes = zip(study_slopes.by_quantity(slopes, names), study_slopes.errors_of(slopes, names), strict=True)
    count = len(errors.names)
    for values, uncertain in of_slopes:
        heights = Budget(errors.names, values[:count], errors.heights)
        yield joined([heights, Budget(SPECTRUM_QUANTITIES, values[count:], errors.spectrum)]), uncertain


def _parts(slopes, errors):
    """Relative errors of ē by the parts of one surface, (parts, n_rh) [-]."""
    groups = errors.names[:1], errors.names[1:], SPECTRUM_QUANTITIES
    return np.transpose([[*map(budget.effect, groups), budget.total] for budget, _ in _budgets(slopes, errors)])


def _sampling(slopes, errors):
    """Standard errors of the total of one surface by the slopes, (n_rh,) [-]."""
    return [budget.error_of_effect(budget.names, uncertain) for budget, uncertain in _budgets(slopes, errors)]


def _form(slopes, errors):
    """Relative error of ē by the measured form of one surface, (n_rh,) [-]."""
    modes = MODE_QUANTITIES[1:]
    return [Budget(modes, values, errors.modes).total for values in study_slopes.by_quantity(slopes, modes)]


def _changes(contact, base, settings):
    """Relative change of ē by a choice and its standard error, (n_rh, 2) [-]."""
    same = first(base, contact.sizes["strip"])
    pairs = ([energies(dataset, h, settings.water) for dataset in (contact, same)] for h in settings.humidities)
    return [relative_shift(*pair) for pair in pairs]


def layout(
    surfaces: Sequence[str],
    humidities: Sequence[float],
    uncertainty: Uncertainty,
    scans: Sequence[int],
    choices: Mapping[str, Sequence[tuple[float, float]]],
) -> xr.Dataset:
    """Dataset of the relative errors of ē, with the number of scans of each surface.

    Each choice has the relative change of ē and its standard error due to sampling, (n_rh, 2) [-].
    """
    total = uncertainty.parts[:, -1]
    pair, form = np.linalg.norm(total, axis=0), np.linalg.norm(uncertainty.form, axis=0)
    changes = np.array(list(choices.values())).reshape(len(choices), len(humidities), 2)
    by_scans = np.array([form if name == "heights" else 0 * form for name in choices]).reshape(changes.shape[:2])
    return xr.Dataset(
        {
            "error": (("surface", "part", "humidity"), uncertainty.parts),
            "error_sampling": (("surface", "humidity"), uncertainty.sampling),
            "pair_error": ("humidity", pair),
            "pair_error_sampling": ("humidity", np.linalg.norm(total * uncertainty.sampling, axis=0) / pair),
            "change": (("choice", "humidity"), changes[..., 0]),
            "change_error": (("choice", "humidity"), changes[..., 1]),
            "change_error_scans": (("choice", "humidity"), by_scans),
            "scans": ("surface", list(scans)),
            "scans_needed": (("surface", "humidity"), scans_needed(total, np.array(scans)[:, None], GOAL)),
        },
        coords={"surface": list(surfaces), "choice": list(choices), "part": list(PARTS), "humidity": list(humidities)},
    )


def scans_needed(errors: np.ndarray, scans: np.ndarray, goal: float) -> np.ndarray:
    r"""Numbers of scans of the surfaces of a pair to reduce its error to the goal, with the fewest scans in all.

    With the error σᵢ of one scan of surface i, that of the pair is :math:`\sqrt{\sum_i \sigma_i^2 / n_i}`.

    Parameters
    ----------
    errors : (n_surfaces, ...) array
        By the present scans [-].
    scans : array
        Their numbers, broadcast to the errors.
    goal : float
        [-]

    Examples
    --------
    >>> scans_needed(np.array([0.129]), 1, 0.05).tolist()
    [7]
    >>> scans_needed(np.array([0.05, 0.05]), 1, 0.05).tolist()
    [2, 2]
    """
    return np.apply_along_axis(_fewest, 0, scans * (np.asarray(errors) / goal) ** 2)


def _fewest(variances):
    """Whole numbers nᵢ of the least sum with Σ varianceᵢ / nᵢ of at most 1, both (n_surfaces,).

    Every nᵢ is at least its variance. Each further scan is one of the surface to which it brings most. For any number
    of scans this gives the smallest variance in all, because further scans of a surface bring less and less.
    """
    variances = variances * (1 - _ROUNDING)
    numbers = np.ceil(variances).astype(int)
    while np.sum(variances / np.maximum(numbers, 1)) > 1:
        numbers[np.argmax(variances / np.maximum(numbers, 1) / (numbers + 1))] += 1
    return numbers


def pair_errors(dataset: xr.Dataset) -> dict[float, float]:
    """Relative standard error of ē by humidity, by the scans of both surfaces."""
    return dict(zip(dataset.humidity.values.tolist(), dataset.pair_error.values.tolist(), strict=True))


def _inputs(plan, at):
    """Slopes and estimates of the measured surfaces of a pair, its contact, and contacts under other evaluations."""
    surfaces = plan.scans.sides(at.pair)
    return {
        "slopes": {name: f"studies/slopes/{at.pair}_{name}" for name in surfaces},
        "estimates": {name: f"estimate/{name}" for name in surfaces},
        "base": f"contact/{at.pair}_NG",
        "choices": {choice: f"studies/choices/{at.pair}_{choice}" for choice in ALTERNATIVES_OF_SCANS},
    }


def _uncertainty(data, settings):
    """Uncertainty of a pair, with as many samples of the base as of the other evaluations."""
    base = first(data["base"], max(choice.sizes["strip"] for choice in data["choices"].values()))
    errors = errors_by_surface(data["slopes"], data["estimates"])
    return compute(data["slopes"], errors, base, data["choices"], settings)


STAGES = (
    Stage.writing(
        "scan_uncertainty",
        "studies/scan_uncertainty/{pair}",
        inputs=_inputs,
        settings=lambda plan, at: select(Settings, plan.over_humidities(at.pair)),
        kind=Settings,
        compute=_uncertainty,
        message="Uncertainty of the adhesion of pair {pair} due to finite scans.",
    ),
)
