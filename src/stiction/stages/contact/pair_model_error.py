"""Error of the model of the contact at all humidities of a pair: ratios of full contact to the sum over summits."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from stiction.analysis.model_error import interpolation_error, length_factors, mean_ratios, scatter_ratios, tip_ratios
from stiction.beam.energy import CRACK_LENGTH_POWER
from stiction.config.cases import case_id
from stiction.contact.air import has_dry
from stiction.contact.correction import interpolated
from stiction.plan.names import by_case
from stiction.plan.stage import Running, Stage
from stiction.stages.contact import full_contact, tips_in_full_contact
from stiction.stages.contact.corrections import study_of

#: Variables of datasets of stage full_energy for devices.
_OF_ENERGIES = ["ratio", "ratio_error", "power", "power_error", "applied", "summit_energy", "summit_pull_off"]


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


def of_devices(
    energies: Mapping[Any, xr.Dataset], study: xr.Dataset | None = None, tips: xr.Dataset | None = None
) -> xr.Dataset:
    """Changes of a pair for the beams of devices, from datasets of stage full_energy, and all changes in dry air.

    ``study`` and ``tips`` have dry air, if a beam is in it. In humid air no forces are changed.
    """
    by_humidity = [
        one[_OF_ENERGIES].reset_coords(drop=True).drop_encoding().expand_dims(humidity=[rh])
        for (_, rh), one in energies.items()
    ]
    humid = _by_levels(xr.concat(by_humidity, "humidity").sortby("humidity")).assign(nearest=((), True))
    if study is None:
        return humid
    study, tips = (each if each is None else each.sel(humidity=[0.0]) for each in (study, tips))
    dry = compute(study, Settings((0.0,), (0.0,)), tips).drop_vars("strips")
    unchanged = {"tip_ratio": 1.0, "tip_error": 0.0, "tip_power": 1.0}
    joined = xr.concat([dry, humid], "humidity", data_vars="all", coords="minimal", compat="override", join="outer")
    joined = joined.fillna({name: same for name, same in unchanged.items() if name in dry})
    return joined.assign(applied=joined.applied.astype(bool), nearest=((), True))


def _by_levels(found):
    """Variables of `layout` of datasets of stage full_energy along the humidity."""
    ratio, error = found.ratio.values, found.ratio_error.values
    length, same = ratio**CRACK_LENGTH_POWER, (np.ones(len(ratio)), np.zeros(len(ratio)))
    ratios = {
        "energy_ratio": (ratio, error),
        "pull_off_ratio": same,
        "energy_power": (found.power.values, found.power_error.values),
        "pull_off_power": same,
        "length_factor": (length, abs(CRACK_LENGTH_POWER) * length * error / ratio),
    }
    at = found.humidity.values
    laid_out = layout(ratios, at, at, 0, at[found.applied.values]).drop_vars("strips")
    return laid_out.assign(found[["summit_energy", "summit_pull_off"]])


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


def _inputs_of_devices(plan, at):
    """Energies of a pair by humidity, and its study in dry air if a beam is in it."""
    airs = plan.airs_of_beams(at.pair)
    humid = plan.air_of_devices.by_levels(at.pair, airs)
    energies = {"energies": by_case("studies/full_contact/energy", [case_id(at.pair, rh) for rh in humid])}
    if not has_dry(airs):
        return energies
    water, has_tips = plan.air_of_devices.water(at.pair), plan.devices.has_tips(at.pair)
    folders = {"study": "studies/full_contact"} | ({"tips": "studies/full_contact/tips"} if has_tips else {})
    return energies | {key: study_of(plan, folder, at.pair, water) for key, folder in folders.items()}


STAGES = (
    _stage("pair_model_error", "", ""),
    _stage("pair_model_error_across", "across/", " with attraction across gaps"),
    _stage("pair_model_error_dry", "dry/", " in dry air"),
    Stage.writing(
        "model_error_of_devices",
        "studies/model_error/devices/{pair}",
        inputs=_inputs_of_devices,
        compute=of_devices,
        message="Full elastic contact of pair {pair} under the beams of devices, over the sum over summits.",
        running=Running(priority=1),
    ),
)
