"""Error of the model of the contact at all humidities of a pair: ratios of full contact to the sum over summits."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.analysis.model_error import interpolation_error, length_factors, mean_ratios, scatter_ratios, tip_ratios
from stiction.contact.correction import interpolated
from stiction.plan.stage import Running, Stage
from stiction.stages.contact import full_contact, tips_in_full_contact


@dataclass(frozen=True)
class Settings:
    """Humidities for the error of the model, 0 for dry air, and those at which it is applied."""

    humidities: tuple[float, ...]  #: [-]
    applied: tuple[float, ...] = ()  #: those at which the predictions are corrected by it [-]
    condenses: bool = True  #: whether water condenses between the surfaces; otherwise all air is dry


def compute(study: xr.Dataset, settings: Settings, tips: xr.Dataset | None = None) -> xr.Dataset:
    """Ratios and powers of energies and of largest attractions, and the factor of crack lengths, with their errors.

    Those of tips are among them, if any are on the pair.
    """
    computed, *energies = full_contact.energies(study)
    _, *pull_offs = full_contact.pull_offs(study)
    of_energy, of_pull_off = np.moveaxis(full_contact.moved_models(study), -1, 0)
    at = np.sort(settings.humidities)
    airs = at * settings.condenses
    given = computed, airs
    ratios = {
        "energy_ratio": mean_ratios(*of_energy, *given),
        "pull_off_ratio": mean_ratios(*of_pull_off, *given),
        "energy_power": scatter_ratios(*energies, *given),
        "pull_off_power": scatter_ratios(*pull_offs, *given),
        "length_factor": length_factors(*of_energy, *given),
    }
    found = layout(ratios, at, at[np.isin(airs, computed)], study.sizes["strip"], settings.applied)
    return found if tips is None else found.assign(_of_tips(tips, given)).assign_coords(slope=tips.slope)


def _of_tips(tips, given):
    """Variables of the changes of tips at slopes: ratio, power, and error of what one tip in 1000 exceeds."""
    found, (computed, airs) = tip_ratios(*tips_in_full_contact.models(tips)), given
    between = [interpolation_error(np.log(one), *given) for one in found.means.T]
    errors = [np.interp(airs, computed, one) for one in found.error.T]
    ratios = [interpolated(one, *given) for one in found.means.T]
    over = "humidity", "slope"
    return {
        "tip_ratio": (over, np.transpose(ratios), {"units": "1"}),
        "tip_error": (over, np.hypot(errors, between).T, {"units": "1"}),
        "tip_power": ("humidity", interpolated(found.powers, *given), {"units": "1"}),
    }


def layout(
    ratios: Mapping[str, tuple[np.ndarray, np.ndarray]],
    at: np.ndarray,
    computed: Sequence[float],
    strips: int,
    applied: Sequence[float] = (),
) -> xr.Dataset:
    """Dataset of ratios and factors, by name, with their standard errors, (k,) each [-].

    They are at increasing humidities; full contact was ``computed`` at some of them, on a number of strips, and the
    predictions are corrected at those ``applied``.
    """
    columns = {name: values for name, (values, _) in ratios.items()}
    columns |= {f"{name}_error": errors for name, (_, errors) in ratios.items()}
    flags = {"interpolated": ~np.isin(at, computed), "applied": np.isin(at, applied)}
    return xr.Dataset(
        {name: ("humidity", values, {"units": "1"}) for name, values in columns.items()}
        | {name: ("humidity", flags) for name, flags in flags.items()}
        | {"strips": ((), strips)},
        coords={"humidity": ("humidity", at, {"units": "1"})},
    )


def _settings(plan, at):
    """Humidities of a pair and of its figures; dry air alone if no water condenses."""
    humidities = plan.humidities_of_full_contact(at.pair)
    dry = {} if plan.air.is_wetted(at.pair) else {"condenses": False}
    airs = list(dict.fromkeys([*humidities, *([0.0] if dry else [])]))
    applied = plan.variants.corrected(at.pair, airs)
    return {"humidities": airs} | ({"applied": applied} if applied else {}) | dry


def _inputs(plan, pair, between):
    """Study of a pair, and that of its tips if it has any."""
    tips = {"tips": f"studies/full_contact/tips/{between}{pair}"} if plan.devices.has_tips(pair) else {}
    return {"study": f"studies/full_contact/{between}{pair}"} | tips


def _stage(name, between, forces):
    """Stage of the ratios of a pair under some forces. ``between`` is the folder of the study under them."""
    return Stage.writing(
        name,
        f"studies/model_error/{between}{{pair}}",
        inputs=lambda plan, at: _inputs(plan, at.pair, between),
        settings=_settings,
        kind=Settings,
        compute=compute,
        message=f"Error of the model of the contact of pair {{pair}}{forces}.",
        running=Running(priority=1),
    )


STAGES = (
    _stage("pair_model_error", "", ""),
    _stage("pair_model_error_across", "across/", " with attraction across gaps"),
    _stage("pair_model_error_dry", "dry/", " in dry air"),
)
