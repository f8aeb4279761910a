"""Error of the model of the contact at all humidities of a pair: ratios of full contact to the sum over summits."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.analysis.model_error import length_factors, mean_ratios
from stiction.plan.stage import Stage
from stiction.stages.contact import full_contact


@dataclass(frozen=True)
class Settings:
    """Humidities for the error of the model, 0 for dry air."""

    humidities: tuple[float, ...]  #: [-]
    applied: bool = False  #: whether the predictions are corrected by it


def compute(study: xr.Dataset, settings: Settings) -> xr.Dataset:
    """Ratios of energies and of largest attractions, and the factor of crack lengths, each with its standard error."""
    computed, *energies = full_contact.energies(study)
    _, *pull_offs = full_contact.pull_offs(study)
    at = np.sort(settings.humidities)
    given = computed, at
    ratios = {
        "energy_ratio": mean_ratios(*energies, *given),
        "pull_off_ratio": mean_ratios(*pull_offs, *given),
        "length_factor": length_factors(*energies, *given),
    }
    return layout(ratios, at, computed, study.sizes["sample"], settings.applied)


def layout(
    ratios: Mapping[str, tuple[np.ndarray, np.ndarray]],
    at: np.ndarray,
    computed: Sequence[float],
    strips: int,
    applied: bool = False,
) -> xr.Dataset:
    """Dataset of ratios and factors, by name, with their standard errors, (k,) each [-].

    They are at increasing humidities; full contact was ``computed`` at some of them, on a number of strips. ``applied``
    says whether the predictions are corrected.
    """
    columns = {name: values for name, (values, _) in ratios.items()}
    columns |= {f"{name}_error": errors for name, (_, errors) in ratios.items()}
    return xr.Dataset(
        {name: ("humidity", values, {"units": "1"}) for name, values in columns.items()}
        | {"interpolated": ("humidity", ~np.isin(at, computed)), "strips": ((), strips), "applied": ((), applied)},
        coords={"humidity": ("humidity", at, {"units": "1"})},
    )


def _settings(plan, at):
    """Humidities of a pair and of its figures; dry air alone if no water condenses."""
    humidities = plan.air.humidities_of_full_contact(at.pair) if plan.air.is_wetted(at.pair) else [0.0]
    return {"humidities": humidities} | ({"applied": True} if plan.variants.is_corrected() else {})


def _stage(name, between, forces):
    """Stage of the ratios of a pair under some forces. ``between`` is the folder of the study under them."""
    return Stage.writing(
        name,
        f"studies/model_error/{between}{{pair}}",
        inputs=lambda plan, at: {"study": f"studies/full_contact/{between}{at.pair}"},
        settings=_settings,
        kind=Settings,
        compute=compute,
        message=f"Error of the model of the contact of pair {{pair}}{forces}.",
    )


STAGES = (
    _stage("pair_model_error", "", ""),
    _stage("pair_model_error_across", "across/", " with attraction across gaps"),
)
