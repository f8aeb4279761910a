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


def correction_inputs(plan: Any, pair: str, variant: str = "base", model: str = "NG") -> dict[str, str]:
    """Error of the model of a pair, as input of a stage with corrected force laws, otherwise none.

    Those of Gaussian heights do, for which full contact is not computed.
    """
    is_corrected = plan.variants.is_corrected(variant) and model == "NG"
    return {"model_error": f"studies/model_error/{pair}"} if is_corrected else {}


def corrected(settings: S, data: Mapping[str, Any]) -> S:
    """Settings of a stage with the correction from its inputs."""
    if "model_error" not in data:
        return settings
    return replace(settings, water=replace(settings.water, correction=correction(data["model_error"])))
