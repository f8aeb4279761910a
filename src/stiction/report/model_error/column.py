"""Error of the model of the contact beside a prediction: its numbers, its column and the column's caption."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from stiction.report.format import MISSING, signed
from stiction.report.table import Term
from stiction.stages.contact.corrections import errors_of_pairs


def change(error: xr.Dataset | None, factor: str = "length_factor") -> dict[str, Any]:
    """Numbers of a row: by how much full contact changes a prediction, and whether this is interpolated.

    The error is one humidity of a dataset of stage pair_model_error or device_model_error, ``None`` if it is not known;
    ``factor`` is the variable with the factor of the prediction.
    """
    if error is None:
        return {"model_error_percent": np.nan, "model_error_se_percent": np.nan, "interpolated": False}
    return {
        "model_error_percent": 100 * (float(error[factor]) - 1),
        "model_error_se_percent": 100 * float(error[f"{factor}_error"]),
        "interpolated": bool(error.interpolated),
    }


def marked_change(change: float, error: float, interpolated: bool) -> str:
    """Change ± standard error as text, with a mark if it is interpolated.

    Examples
    --------
    >>> marked_change(5.33, 0.11, True), marked_change(2.322, 0.042, False)
    ('+5.33 ± 0.11 *', '+2.322 ± 0.042')
    >>> marked_change(float("nan"), float("nan"), True)
    '–'
    """
    text = signed(change, error)
    return f"{text} *" if interpolated and text != MISSING else text


#: Where predictions with forces are corrected, and where they are not.
IN_DRY_AIR = " in dry air, and would change it in humid air"
#: Column for reading.
COLUMN = {"model error [%]": (marked_change, "model_error_percent", "model_error_se_percent", "interpolated")}


def caption(errors: Mapping[Any, xr.Dataset]) -> Term:
    """Meaning of the column, from the datasets with the errors."""
    applied = {bool(flag) for error in errors.values() for flag in error.applied}
    does = "has changed what is stated" if True in applied else "would change what is stated"
    by_levels = any("by_levels" in error and error.by_levels.any() for error in errors.values())
    others = ", or would change it where its error is too large" if by_levels else IN_DRY_AIR
    does += others * (len(applied) > 1)
    with_bounds = " Where it has, bounds contain its standard error." * (True in applied)
    return Term(
        "Model error",
        f"by how much full elastic contact of the surfaces {does}, ± standard error over its strips; * "
        "interpolated between the humidities at which it was computed, with the error of the interpolation; – not "
        f"known. It has one sign and is no random error: it is part of no standard error.{with_bounds}",
    )


def error_inputs(plan: Any) -> dict[str, Any]:
    """Errors of all pairs, as inputs of a stage, none unless they are wanted."""
    errors = errors_of_pairs(plan)
    return {"errors": errors} if errors else {}
