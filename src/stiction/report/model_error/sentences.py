"""Error of the model of the contact beside the predictions for devices: rows of tables, sentences of pages."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from stiction.contact.air import Air, humid
from stiction.plan.names import by_name
from stiction.report.format import airs, listed, signed
from stiction.report.model_error.column import change
from stiction.rounding import in_percent
from stiction.stages.devices.end_states import END_STATES
from stiction.stages.devices.opening import EITHER, SOUGHT_BY

#: Subject of sentences.
_FULL_CONTACT = "Full elastic contact of the surfaces"


def device_change(errors: Mapping[str, xr.Dataset] | None, device: str, humidity: float, shape: str) -> dict[str, Any]:
    """Change of a device by full contact, in an end state, or nothing without datasets of stage device_model_error."""
    if not errors:
        return {}
    error = errors.get(device)
    is_known = error is not None and shape in error["shape"] and humidity in error.humidity
    return change(error.sel(shape=shape, humidity=humidity) if is_known else None, "factor")


def sentences(device: str, errors: Mapping[str, xr.Dataset] | None) -> list[str]:
    """Changes of a device by full contact in words, and the safe side of them, none without errors."""
    if errors is None:
        return []
    error = errors[device]
    shape = str(error["shape"].values[0])
    sought = SOUGHT_BY[shape]
    response = "pull-off force" if sought.more_is_better else f"lengths held by the {END_STATES[shape].by}"
    rows = {float(humidity): device_change(errors, device, humidity, shape) for humidity in error.humidity.values}
    finite = {humidity: row for humidity, row in rows.items() if np.isfinite(row["model_error_percent"])}
    if not finite:
        return [f"The model's error in the {response} is not known {airs(rows)}{_why(error)}."]
    applied = set(error.humidity.values[error.applied.values])
    texts, uncorrected = [], {humidity: row for humidity, row in finite.items() if humidity not in applied}
    inside, beside = (f"{_FULL_CONTACT}, inside, has changed", f"{_FULL_CONTACT}, not inside, would change")
    for does, humidities in (inside, applied & finite.keys()), (beside, uncorrected):
        by = [f"{_percent(finite[humidity])} {airs([humidity])}" for humidity in sorted(humidities)]
        texts += [f"{does} the {response} by {', '.join(by)}."] if by else []
    if len(finite) < len(rows):
        texts.append(f"It is not known {airs([humidity for humidity in rows if humidity not in finite])}.")
    if EITHER in error["shape"]:
        texts += _of_tips(error)
    texts += [_safe_side(uncorrected, sought)] if uncorrected else []
    if error.across_gaps:
        return texts
    gaps = "the other way in drier air: build no longer and rely on no smaller force because of it."
    return [*texts, f"Attraction across gaps is in neither model. It acts {gaps}"]


def _why(error):
    """Why no change is known: by levels, full contact was computed at each humidity."""
    if error.by_levels.any():
        return ", where full elastic contact does not settle or takes too long"
    return ", beyond the humidities of the pair"


def _of_tips(error):
    """Sentences on what full contact does to tips, with and without a correction."""
    applied = np.where(error.by_levels, error.get("tips_applied", False), error.applied)
    corrected, others = (list(map(float, error.humidity.values[flags])) for flags in (applied, ~applied))
    texts = [_corrected_tips(error, corrected)] if corrected else []
    where = f" {airs(others)}" * bool(corrected)
    unknown = error.by_levels.any() if corrected else True
    texts += [f"It is not known for what the tip holds{where}."] if unknown and others else []
    return texts


def _corrected_tips(error, corrected):
    """Sentence on what tips hold over what summits hold, by their slope."""
    by = [_ratio_of_tips(error, humidity) for humidity in humid(corrected) if "least_of_tips" in error]
    holds = f": it holds {listed(by)} what its summits alone would, depending on its slope" if by else ""
    return f"Full elastic contact changes the tip, too{holds}. Sizes contain the upper end (95 % confidence)."


def _ratio_of_tips(error, humidity):
    """What tips hold over what summits hold."""
    least, largest = (float(error[f"{end}_of_tips"].sel(humidity=humidity)) for end in ("least", "largest"))
    return f"{least:.2f} to {largest:.2f} times ({Air(humidity).words})"


def _percent(row):
    """Change with its standard error, and whether it is interpolated."""
    text = f"{signed(row['model_error_percent'], row['model_error_se_percent'])} %"
    return f"{text} (interpolated)" if row["interpolated"] else text


def _safe_side(changes, sought):
    """Sentence on the safe side: longer beams and smaller forces stick less under full contact."""
    unsafe = {
        humidity: abs(row["model_error_percent"])
        for humidity, row in changes.items()
        if sought.sign * row["model_error_percent"] < -2 * row["model_error_se_percent"]
    }
    if not unsafe:
        return "What is stated is on the safe side of it, or does not differ by more than twice its standard error."
    mend = "raise the restoring force" if sought.more_is_better else "shorten the lengths"
    by = in_percent(max(unsafe.values()) / 100)
    return f"What is stated is not on the safe side of it {airs(unsafe)}: {mend} by {by}."


def error_inputs(plan: Any, *devices: str) -> dict[str, Any]:
    """Errors of those of some devices for which they are stated, as inputs of a stage."""
    stated = list(filter(plan.states_error_of_device, devices))
    return {"errors": by_name("devices/model_error", stated)} if stated else {}
