"""Tables of devices: lengths of beams that come free."""

from collections.abc import Mapping

import pandas as pd
import xarray as xr

from stiction.designs.findings import numbered
from stiction.devices.limits import NOT_MODELLED
from stiction.report.format import UM, error_alone, number
from stiction.report.tables import Table

#: Shapes in words: what holds a device that sticks.
_SHAPES = {"S-shape": "beam", "S-shape or arc": "beam or tip"}
_CAPTION = (
    "Safe length: the largest length of which, with a confidence of 95 %, at most a share p of the devices sticks. "
    "A device is held by its beam (S-shape) or by its tip alone (arc). Estimate: length at which a share p sticks, "
    "with its standard errors due to the number of beams and to the number of sampled surfaces. Every beam "
    "has its own tip, whose scatter is part of the first. Basis: sampled, by "
    "order statistics; fitted, by a line through the shortest 5 %; extrapolated, beyond what was verified."
)


def safe_lengths(found: Mapping[tuple[str, float], xr.Dataset], warnings: Mapping[tuple[str, float], list]) -> Table:
    """Safe lengths of all beams, one row per device, humidity, shape and share.

    Parameters
    ----------
    found : dict
        Name and humidity to the dataset of stage safe_lengths.
    warnings : dict
        Name and humidity to sentences.
    """
    rows = [
        _row(key, one, warnings[key])
        for key, dataset in found.items()
        for shape in dataset["shape"].values
        for share in dataset.share.values
        for one in [dataset.sel(shape=shape, share=share)]
    ]
    sentences, numbers = numbered(warnings)
    listed = " ".join(f"({k}) {sentence}" for k, sentence in enumerate(sentences, 1))
    caption = " ".join(filter(None, [_CAPTION, listed and f"Warnings: {listed}", NOT_MODELLED]))
    cells = [_cells(row, numbers[row["device"], row["relative_humidity"]]) for row in rows]
    return Table(pd.DataFrame(rows), caption, pd.DataFrame(cells))


def _row(key, one, warnings):
    """One safe length with its errors."""
    device, humidity = key
    return {
        "device": device,
        "relative_humidity": humidity,
        "held_by": _SHAPES[str(one["shape"].values)],
        "share": float(one.share),
        "safe_length_um": float(one.safe_length) / UM,
        "estimate_um": float(one.estimate) / UM,
        "estimate_se_beams_um": float(one.beams_error) / UM,
        "estimate_se_surfaces_um": float(one.surfaces_error) / UM,
        "basis": str(one.basis.values),
        "warnings": " ".join(warnings),
    }


def _cells(row, numbers):
    """One safe length as text."""
    return {
        "device": row["device"],
        "RH": f"{row['relative_humidity']:g}",
        "held by": row["held_by"],
        "p": f"{row['share']:g}",
        "safe length [µm]": number(row["safe_length_um"], ".1f"),
        "estimate [µm]": number(row["estimate_um"], ".1f"),
        "se, beams": error_alone(row["estimate_se_beams_um"]),
        "se, surfaces": error_alone(row["estimate_se_surfaces_um"]),
        "basis": row["basis"],
        "warnings": ", ".join(map(str, numbers)),
    }
