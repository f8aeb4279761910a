"""Error of the model of the contact at all humidities of a pair: ratios of full contact to the sum over summits."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from stiction.analysis.model_error import (
    few_tip_ratios,
    interpolation_error,
    length_factors,
    mean_ratios,
    scatter_ratios,
    tip_ratios,
)
from stiction.beam.energy import CRACK_LENGTH_POWER
from stiction.config.cases import case_id
from stiction.contact.air import has_dry
from stiction.contact.correction import interpolated
from stiction.contact.full.smooth_pairs import in_wetter_air
from stiction.plan.names import by_case
from stiction.plan.stage import Running, Stage
from stiction.stages.contact import full_contact, tips_in_full_contact
from stiction.stages.contact.corrections import study_of

#: ASSUME: standard error of the power of tips in humid air, which is taken as 1. On pair b at RH 0.44, 0.67 and 0.92,
#: 24, 12 and 8 strips at three slopes each have 0.87, 1.09 and 1.02; eight strips alone know it to 0.2.
POWER_ERROR = 0.1


def compute(
    study: xr.Dataset,
    humidities: Sequence[float],
    applied: Sequence[float] = (),
    condenses: bool = True,
    tips: xr.Dataset | None = None,
) -> xr.Dataset:
    """Ratios and powers of energies and of largest attractions, and the factor of crack lengths, with their errors.

    Those of tips are among them, if any are on the pair. Predictions are corrected by them at the humidities of
    ``applied`` [-]. Unless water ``condenses`` between the surfaces, all air is dry.
    """
    computed_at, *energies = full_contact.energies(study)
    _, *pull_offs = full_contact.pull_offs(study)
    of_energy, of_pull_off = np.moveaxis(full_contact.moved_models(study), -1, 0)
    at = np.sort(humidities)
    airs = at * condenses
    airs_of_study_and_pair = computed_at, airs
    ratios = {
        "energy_ratio": mean_ratios(*of_energy, *airs_of_study_and_pair),
        "pull_off_ratio": mean_ratios(*of_pull_off, *airs_of_study_and_pair),
        "energy_power": scatter_ratios(*energies, *airs_of_study_and_pair),
        "pull_off_power": scatter_ratios(*pull_offs, *airs_of_study_and_pair),
        "length_factor": length_factors(*of_energy, *airs_of_study_and_pair),
    }
    changes = layout(ratios, at, at[np.isin(airs, computed_at)], study.sizes["strip"], applied)
    return (
        changes
        if tips is None
        else changes.assign(_of_tips(tips, airs_of_study_and_pair)).assign_coords(slope=tips.slope)
    )


def of_devices(
    energies: Mapping[Any, xr.Dataset],
    study: xr.Dataset | None = None,
    tips: xr.Dataset | None = None,
    tips_in_water: Mapping[Any, xr.Dataset] | None = None,
) -> xr.Dataset:
    """Changes of a pair for devices, from datasets of stages full_energy and tips_of_devices, and all in dry air.

    ``study`` and ``tips`` have dry air, if a device is in it. Humid air without forces or tips has none changed.
    """
    humid = _by_levels({rh: energy for (_, rh), energy in sorted(energies.items(), key=lambda each: each[0][1])})
    if settled := [tip for tip in (tips_in_water or {}).values() if tip.force.notnull().all()]:
        humid = humid.assign(_of_tips_in_water(settled, humid.humidity.values))
    else:
        humid = humid.assign(tip_applied=("humidity", np.full(humid.sizes["humidity"], False)))
    humid = humid.assign(nearest=((), True))
    if study is None:
        return humid
    study, tips = (each if each is None else each.sel(humidity=[0.0]) for each in (study, tips))
    dry = compute(study, (0.0,), (0.0,), tips=tips).drop_vars("strips")
    dry = dry.assign({f"{quantity}_applied": dry.applied for quantity in ("pull_off", "tip")})
    joined = xr.concat([dry, humid], "humidity", data_vars="all", coords="minimal", compat="override", join="outer")
    joined = joined.fillna({name: same for name, same in _NO_TIPS.items() if name in joined})
    flags = {name: joined[name].astype(bool) for name in ("applied", "pull_off_applied", "tip_applied")}
    return joined.assign(flags | {"nearest": ((), True)})


#: Changes of tips where none are known.
_NO_TIPS = {"tip_ratio": 1.0, "tip_error": 0.0, "tip_power": 1.0}


def _by_levels(energies):
    """Variables of `layout` of datasets of stage full_energy by increasing humidity."""
    at = np.array(list(energies))

    def columns(*names):
        """Values of some variables, NaN where a dataset has none (n, h)."""
        return np.array([[float(dataset.get(name, np.nan)) for dataset in energies.values()] for name in names])

    ratio, error, *of_power = columns("ratio", "ratio_error", "power", "power_error")
    length = ratio**CRACK_LENGTH_POWER
    forces = columns("pull_off_ratio", "pull_off_ratio_error", "pull_off_power", "pull_off_power_error")
    of_ratio, of_forces = _between(forces, columns("pull_off_applied")[0], at)
    ratios = {
        "energy_ratio": (ratio, error),
        "pull_off_ratio": of_ratio[:2],
        "energy_power": of_power,
        "pull_off_power": of_ratio[2:],
        "length_factor": (length, abs(CRACK_LENGTH_POWER) * length * error / ratio),
    }
    laid_out = layout(ratios, at, at, 0, at[columns("applied")[0] > 0]).drop_vars("strips")
    copied = "summit_energy", "summit_pull_off", "largest_residual", "pull_off_largest_residual"
    variables = dict(zip(copied, columns(*copied), strict=True)) | {"pull_off_applied": of_forces}
    return laid_out.assign({name: ("humidity", values) for name, values in variables.items()})


def _between(forces, applied, at):
    """Ratio and power of forces with their errors (4, h), and whether they are applied, at all humidities (h,).

    Those wanted remain, and are NaN where they are not found. Others are on the curve through those applied, with the
    error of `_off_nodes`. ASSUME: in drier air the change is that in the driest, and beyond the wettest as in
    `stiction.contact.full.smooth_pairs.in_wetter_air`.
    """
    applies, finite = applied > 0, np.isfinite(applied)
    if not applies.any():
        return np.where(finite, forces, [[1.0], [0.0], [1.0], [0.0]]), applies
    ratio, error, power, power_error = forces[:, applies]
    within = np.maximum(at, at[applies][0])
    filled_ratio = _from_driest(ratio, at[applies], within)
    error, power, power_error = (np.interp(within, at[applies], row) for row in (error, power, power_error))
    error = np.hypot(error, filled_ratio * _off_nodes(ratio, at[applies], within))
    filled = np.array([filled_ratio, error, power, power_error])
    return np.where(finite, forces, filled), np.where(finite, applies, True)


def _from_driest(ratio, computed_at, at):
    """Ratio (k,) of forces at humidities (h,) from the driest computed one on, beyond the wettest as in wetter air."""
    wettest, most = computed_at[-1], ratio[-1]
    beyond = [in_wetter_air(most, wettest, humidity) if humidity > wettest else most for humidity in at]
    return np.where(at > wettest, beyond, interpolated(ratio, computed_at, np.minimum(at, wettest)))


def _off_nodes(ratio, computed_at, at):
    """Relative error of a ratio (k,) between computed humidities (h,), by one of them as large as its change."""
    if len(computed_at) > 1:
        return interpolation_error(np.log(ratio), computed_at, at)
    return np.abs(np.log(_from_driest(ratio, computed_at, at) / ratio[0]))


def _of_tips_in_water(studies, at):
    """Variables of the changes of tips at all humidities (h,), between those computed as `_between`.

    The power is 1 with `POWER_ERROR`.
    """
    studies = sorted(studies, key=lambda study: float(study.humidity[0]))
    computed_at = np.array([float(study.humidity[0]) for study in studies])
    few = tips_in_full_contact.models_of_devices
    means, errors = np.concatenate([few_tip_ratios(*few(study), POWER_ERROR) for study in studies], axis=1)
    within = np.maximum(at, computed_at[0])
    between = [_off_nodes(each, computed_at, within) for each in means.T]
    errors = [np.interp(within, computed_at, each) for each in errors.T]
    over = "humidity", "slope"
    ratios = [_from_driest(each, computed_at, within) for each in means.T]
    return {
        "tip_ratio": (over, np.transpose(ratios)),
        "tip_error": (over, np.hypot(errors, between).T),
        "tip_power": ("humidity", np.ones(len(at))),
        "tip_applied": ("humidity", np.full(len(at), True)),
        "slope": ("slope", studies[0].slope.values),
    }


def _of_tips(tips, humidities):
    """Variables of the changes of tips at slopes: ratio, power, and error of what one tip in 1000 exceeds."""
    ratios_of_tips, (computed_at, airs) = tip_ratios(*tips_in_full_contact.models(tips)), humidities
    between = [interpolation_error(np.log(ratio), *humidities) for ratio in ratios_of_tips.means.T]
    errors = [np.interp(airs, computed_at, error) for error in ratios_of_tips.error.T]
    ratios = [interpolated(ratio, *humidities) for ratio in ratios_of_tips.means.T]
    over = "humidity", "slope"
    return {
        "tip_ratio": (over, np.transpose(ratios)),
        "tip_error": (over, np.hypot(errors, between).T),
        "tip_power": ("humidity", interpolated(ratios_of_tips.powers, *humidities)),
    }


def layout(
    ratios: Mapping[str, tuple[np.ndarray, np.ndarray]],
    at: np.ndarray,
    computed_at: Sequence[float],
    strips: int,
    applied: Sequence[float] = (),
) -> xr.Dataset:
    """Dataset of ratios and factors, by name, with their standard errors, (k,) each [-].

    They are at increasing humidities; full contact was computed at some of them (``computed_at``), on a
    number of strips, and the predictions are corrected at those ``applied``.
    """
    columns = {name: values for name, (values, _) in ratios.items()}
    columns |= {f"{name}_error": errors for name, (_, errors) in ratios.items()}
    flags = {"interpolated": ~np.isin(at, computed_at), "applied": np.isin(at, applied)}
    return xr.Dataset(
        {name: ("humidity", values) for name, values in columns.items()}
        | {name: ("humidity", flags) for name, flags in flags.items()}
        | {"strips": ((), strips)},
        coords={"humidity": ("humidity", at)},
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
        compute=compute,
        message=f"Error of the model of the contact of pair {{pair}}{forces}.",
        running=Running(priority=1),
    )


def _inputs_of_devices(plan, at):
    """Energies, forces and tips of a pair by humidity, and its studies in dry air if a device is in it."""
    devices, pair, by_levels = plan.devices, at.pair, plan.air_of_devices.by_levels
    device_airs = {
        rh for section in devices.sections.values() if section["pair"] == pair for rh in section["humidities"]
    }
    airs = sorted({*plan.airs_of_beams(pair), *devices.airs_of_forces(pair), *device_airs})
    inputs = {"energies": by_case("studies/full_contact/energy", _cases(pair, by_levels(pair, airs)))}
    if wet := by_levels(pair, devices.airs_of_tips(pair)):
        inputs["tips_in_water"] = by_case("studies/full_contact/tips/devices", _cases(pair, wet))
    if not has_dry(airs):
        return inputs
    water = plan.air_of_devices.water(pair)
    folders = {"study": "studies/full_contact"}
    folders |= {"tips": "studies/full_contact/tips"} if devices.has_tips(pair) else {}
    return inputs | {key: study_of(plan, folder, pair, water) for key, folder in folders.items()}


def _cases(pair, humidities):
    """Names of the cases of a pair at some humidities."""
    return [case_id(pair, rh) for rh in humidities]


STAGES = (
    _stage("pair_model_error", "", ""),
    _stage("pair_model_error_across", "across/", " with attraction across gaps"),
    _stage("pair_model_error_dry", "dry/", " in dry air"),
    Stage.writing(
        "model_error_of_devices",
        "studies/model_error/devices/{pair}",
        inputs=_inputs_of_devices,
        compute=of_devices,
        message="Full elastic contact of pair {pair} under devices, over the sum over summits.",
        running=Running(priority=1),
    ),
)
