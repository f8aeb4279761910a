r"""Prediction intervals of the lengths of cantilevers, with the form of the model as an error.

How far the model errs is learnt from all lengths that the paper measured, as for Table III, see
`stiction.analysis.prediction`. They are compared with lengths computed with the reach of attraction of the device. The
place of a length is, by Eq. (13),

.. math:: u = -\tfrac14 \ln \frac{\bar e(\mathrm{RH})}{\bar e(\mathrm{RH}_0)} ,

the logarithm of its ratio to the length of the same beam at the humidity RH₀ in the middle of the paper's lengths.

ASSUME: a length held by few beams errs as the mean length, and a length corrected to full elastic contact as one on
summits.
The paper measured no tips, bridges or stoppers, and nothing in dry air: they have no interval. Test beams of a device
learn how far the model errs on its own surfaces, so that the paper's lengths say nothing more.
"""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from stiction.analysis.prediction import Discrepancy
from stiction.config.cases import Case
from stiction.contact.air import is_humid
from stiction.plan.stage import File
from stiction.stages.contact import curves
from stiction.stages.contact.contact import first
from stiction.stages.contact.error_notes import on_patch
from stiction.stages.devices.contact_names import contact_of
from stiction.stages.devices.opening import S_SHAPE

#: Computed and measured crack lengths of the paper's pairs; ``docs/update.py`` writes it from runs of the paper.
PAPER_LENGTHS = Path(__file__).with_name("paper_lengths.csv")
#: Probability that an interval contains the length.
COVERAGE = 0.95
#: Columns with lengths computed with attraction of touching summits alone, and across gaps, and the measured ones.
TOUCHING, ACROSS_GAPS, MEASURED = "touching_um", "across_gaps_um", "measured_um"
#: Samples of the contact that are enough for a place: a standard error of 5 % of both energies moves it by 0.02.
_SAMPLES = 500
#: Power of the adhesion energy in the length at which a crack stops, Eq. (13).
_OF_ENERGY = -1 / 4


def inputs(plan: Any, case: Case) -> dict[str, str]:
    """Contact and lengths of the paper for a cantilever in humid air without test beams, otherwise none."""
    has_length = plan.devices.kind(case.device).has_tip and is_humid(case.humidity)
    if not has_length or "test_beams" in plan.config["devices"][case.device]:
        return {}
    return {"contact": contact_of(plan, case), "paper": File(PAPER_LENGTHS)}


def with_intervals(dataset: xr.Dataset, data: Mapping[str, Any], settings: Any) -> xr.Dataset:
    """Dataset of stage safe_lengths with its intervals, or as it is without the `inputs`."""
    if "paper" not in data:
        return dataset
    reach = ACROSS_GAPS if settings.water.gaps else TOUCHING
    discrepancy, middle = learnt(pd.read_csv(data["paper"]), reach)
    contact, on_summits = first(data["contact"], _SAMPLES), replace(settings.water, correction=None)
    with on_patch(settings.device.strip, settings.device.width), np.errstate(divide="ignore", invalid="ignore"):
        energies = [
            curves.energies(contact, humidity, on_summits).mean(dtype=float) for humidity in (settings.humidity, middle)
        ]
        coordinate = _OF_ENERGY * float(np.log(np.divide(*energies)))
    return dataset.assign(intervals(dataset, discrepancy, coordinate))


def learnt(lengths: pd.DataFrame, column: str) -> tuple[Discrepancy, float]:
    """Discrepancy of a column of lengths on all pairs of the paper, and the relative humidity in their middle."""
    pairs = [table for _, table in lengths.groupby("pair", sort=False)]
    discrepancy = Discrepancy.learnt([(table[column].values, table[MEASURED].values) for table in pairs])
    coordinates = [-np.log(table[column].values) for table in pairs]
    middles = [np.interp(u.mean(), u, table.relative_humidity) for u, table in zip(coordinates, pairs, strict=True)]
    return discrepancy, float(np.mean(middles))


def intervals(dataset: xr.Dataset, discrepancy: Discrepancy, coordinate: float) -> dict[str, tuple]:
    """Variables with the ends of the intervals of the estimates held by the beam, NaN for tips, by shape and share [m].

    The ``coordinate`` of all lengths is u [-], not finite if surfaces do not adhere: then there are none.
    """
    errors = np.hypot(dataset.beams_error, dataset.surfaces_error.fillna(0.0)) / dataset.estimate
    is_known = (
        np.isfinite(dataset.estimate) & np.isfinite(errors) & np.isfinite(coordinate) & (dataset["shape"] == S_SHAPE)
    )
    mask, widths = is_known.values, np.full(dataset.estimate.shape, np.nan)
    widths[mask] = discrepancy.half_widths(np.full(mask.sum(), coordinate), errors.values[mask], COVERAGE)
    return {
        f"prediction_{end}": (("shape", "share"), dataset.estimate.values * np.exp(sign * widths))
        for end, sign in (("low", -1), ("high", 1))
    }
