"""Correction of force laws to full elastic contact, for every stage with force laws from a contact."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any, TypeVar

import xarray as xr

from stiction.contact.correction import Correction, ElasticChange, TipChanges

S = TypeVar("S")
#: Variables where no correction is applied, by the flag that says so.
UNCHANGED = {
    "applied": {"energy_ratio": 1.0, "energy_ratio_error": 0.0, "energy_power": 1.0, "energy_power_error": 0.0},
    "pull_off_applied": {
        "pull_off_ratio": 1.0,
        "pull_off_ratio_error": 0.0,
        "pull_off_power": 1.0,
        "pull_off_power_error": 0.0,
    },
}


def correction(error: xr.Dataset) -> Correction:
    """Changes of a pair, from its dataset of stage pair_model_error."""

    def change(quantity):
        """Change of a quantity, with relative errors."""
        ratio, power = (error[f"{quantity}_{name}"].values for name in ("ratio", "power"))
        errors = error[f"{quantity}_ratio_error"].values / ratio, error[f"{quantity}_power_error"].values
        return ElasticChange(ratio, power, *errors)

    return Correction(error.humidity.values, change("energy"), change("pull_off"), _of_tips(error))


def _of_tips(error):
    """Changes of the tips of a pair, none without any."""
    if "tip_ratio" not in error:
        return None
    ratio, power, of_largest = (
        error[f"tip_{name}"].transpose("humidity", ...).values for name in ("ratio", "power", "error")
    )
    return TipChanges(error.slope.values, ElasticChange(ratio, power, of_largest))


def in_all_air(folder: str, pair: str, water: Mapping[str, Any]) -> str:
    """Dataset of a pair in a folder of studies of full contact, with attraction across gaps if its water has any."""
    return f"{folder}/across/{pair}" if "gaps" in water else f"{folder}/{pair}"


def study_of(plan: Any, folder: str, pair: str, water: Mapping[str, Any]) -> str:
    """Dataset as of `in_all_air`, or in dry air alone if full contact is not wanted in humid air."""
    return in_all_air(folder, pair, water) if plan.has_humid_full_contact else f"{folder}/dry/{pair}"


def correction_inputs(
    plan: Any,
    pair: str,
    humidities: Iterable[float],
    variant: str = "base",
    water: Mapping[str, Any] | None = None,
) -> dict[str, str]:
    """Error of the model of a pair, as input of a stage with corrected force laws at some humidities, otherwise none.

    The water is that of the laws, by default the one of the pair under the variant.
    """
    if not plan.variants.corrected(pair, humidities, variant):
        return {}
    return {"model_error": study_of(plan, "studies/model_error", pair, water or plan.variants.water(pair, variant))}


def corrections_of_laws(plan: Any, pair: str, humidities: Iterable[float], model: str) -> dict[str, str]:
    """Correction of the laws of a pair. Full contact is not computed for Gaussian heights."""
    return correction_inputs(plan, pair, humidities) if model == "NG" else {}


def errors_of_pairs(plan: Any) -> dict[str, str]:
    """Errors of the model of all pairs in the run for which they are stated, by pair."""
    pairs = [pair for pair in plan.pairs if plan.states_model_error(pair, plan.config["pairs"][pair]["humidities"])]
    return {pair: study_of(plan, "studies/model_error", pair, plan.air.water(pair)) for pair in pairs}


def applied(error: xr.Dataset) -> Correction:
    """Changes by full contact that predictions of a pair have.

    ASSUME: beyond the humidities of all devices of a pair, where budgets shift one of them, its own change holds.
    """
    if "nearest" not in error:
        return correction(error.isel(humidity=error.applied.values))
    variables = {
        name: error[name].where(error[flag], same)
        for flag, unchanged in UNCHANGED.items()
        for name, same in unchanged.items()
    }
    return replace(correction(error.assign(variables)), nearest=True)


def with_correction(settings: S, data: Mapping[str, Any]) -> S:
    """Settings of a stage with the correction from its inputs, where predictions are corrected."""
    return _corrected(settings, data, applied)


def with_all_corrections(settings: S, data: Mapping[str, Any]) -> S:
    """Settings of a variant, corrected at all humidities of its inputs, also where predictions are not."""
    return _corrected(settings, data, correction)


def _corrected(settings, data, choose):
    """Settings with the correction that is chosen from the error of the model, if there is one."""
    if "model_error" not in data:
        return settings
    return replace(settings, water=replace(settings.water, correction=choose(data["model_error"])))
