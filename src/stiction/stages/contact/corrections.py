"""Correction of force laws to full elastic contact, for every stage with force laws from a contact."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, TypeVar

import xarray as xr

from stiction.contact.correction import Correction

S = TypeVar("S")


def correction(error: xr.Dataset) -> Correction:
    """Ratios of a pair from its dataset of stage pair_model_error."""
    return Correction(error.humidity.values, error.energy_ratio.values, error.pull_off_ratio.values)


def study_of(folder: str, pair: str, water: Mapping[str, Any]) -> str:
    """Dataset of a pair in a folder of studies of full contact, with attraction across gaps if its water has any."""
    return f"{folder}/across/{pair}" if "gaps" in water else f"{folder}/{pair}"


def correction_inputs(
    plan: Any, pair: str, variant: str = "base", model: str = "NG", water: Mapping[str, Any] | None = None
) -> dict[str, str]:
    """Error of the model of a pair, as input of a stage with corrected force laws, otherwise none.

    The water is that of the laws, by default the one of the pair under the variant. Laws of Gaussian heights are not
    corrected, for which full contact is not computed.
    """
    if not plan.variants.is_corrected(variant) or model != "NG":
        return {}
    return {"model_error": study_of("studies/model_error", pair, water or plan.variants.water(pair, variant))}


def errors_of_pairs(plan: Any) -> dict[str, str]:
    """Errors of the model of all pairs in the run with condensation of water, by pair."""
    return {pair: study_of("studies/model_error", pair, plan.air.water(pair)) for pair in plan.humid_pairs}


def with_correction(settings: S, data: Mapping[str, Any]) -> S:
    """Settings of a stage with the correction from its inputs."""
    if "model_error" not in data:
        return settings
    return replace(settings, water=replace(settings.water, correction=correction(data["model_error"])))
