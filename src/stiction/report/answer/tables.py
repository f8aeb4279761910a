"""Table of the verdicts on all devices, one row each, for a spreadsheet; and the steps of one answer."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
import xarray as xr

from stiction.answer.data import Answer, Cause
from stiction.contact.air import Air
from stiction.plan.names import by_name
from stiction.report.answer import words
from stiction.report.answer.judged import judged
from stiction.report.format import number
from stiction.report.table import Table, table_stage
from stiction.stages.devices import device_warnings
from stiction.stages.devices.end_states import END_STATES

_CAPTION = (
    "One row for each device. To build: the largest length, or the smallest restoring force, with at most this "
    "fraction stuck in all stated airs, after all stated touchdowns, at the stated voltage and tilts, with 95 % "
    "confidence; the simulation and all stated or assumed uncertainties are inside. P(stuck): expected fraction at the "
    "stated size, with a band of 95 % that contains the same. Measure: what would change the size most, and the size "
    "if it were known exactly. No number: what forbids one."
)


def devices(answers: Mapping[str, Answer]) -> Table:
    """Verdicts on all devices."""
    columns = {
        "device": (str, "device"),
        "verdict": (str, "sign"),
        "stated": (_size, "size", "unit"),
        "to build": (_size, "to_build", "unit"),
        "P(stuck) at the stated size": (str, "stuck"),
        "1 in": (lambda share: f"{1 / share:g}", "share"),
        "largest step": (str, "largest_step"),
        "measure": (str, "measure"),
        "then": (_size, "if_measured", "unit"),
        "no number": (str, "forbidden"),
    }
    return Table.of([_without_noise(_row(answer)) for answer in answers.values()], _CAPTION, columns)


def _row(answer):
    """Numbers of one device in the unit of its size. Where a limit forbids a number, there is none."""
    scale, unit = answer.sought.scale, answer.sought.shown
    known = np.nan if words.is_forbidden(answer) else 1.0
    to_build = np.nan if answer.forbidden else answer.build / scale
    last, stuck = answer.stated_steps[-1], answer.stuck
    band = (stuck.value, stuck.low, stuck.high) if stuck else (np.nan,) * 3
    return {
        "device": answer.device,
        "kind": answer.kind,
        "verdict": str(answer.verdict),
        "sign": words.sign_of(answer)[1],
        "unit": unit,
        "size": answer.size / scale,
        "to_build": to_build,
        "exact": known * answer.exact / scale,
        "share": answer.share,
        **dict(zip(("stuck_value", "stuck_low", "stuck_high"), known * np.array(band), strict=True)),
        "none_seen": bool(stuck and stuck.none_seen),
        "stuck": words.stuck_in_words(stuck) if stuck and not words.is_forbidden(answer) else "–",
        **{f"after_{cause}": np.nan for cause in Cause},
        **{f"after_{step.cause}": known * step.size / scale for step in answer.steps},
        "relative_humidity": last.humidity,
        "held_by": END_STATES[last.shape].by if last.shape in END_STATES else last.shape,
        "by_tip": answer.is_by_tip,
        "largest_step": str(answer.largest_step.cause),
        "measure": answer.measure,
        "if_measured": known * answer.if_measured / scale,
        "included": " ".join(answer.included),
        "left_out": " ".join(answer.left_out),
        "forbidden": " ".join(answer.forbidden),
    }


def _without_noise(row):
    """Row with twelve digits of each number: 250 as stated, not 250.00000000000003."""
    return {key: float(f"{value:.12g}") if isinstance(value, float) else value for key, value in row.items()}


def _size(value, unit):
    """Size with its unit, – without one."""
    return number(value, ".4g") + (f" {unit}" if np.isfinite(value) else "")


def steps(answer: Answer) -> pd.DataFrame:
    """Steps from the estimate to the size to build, for reading."""
    return pd.DataFrame(
        {
            "step": words.CAUSES[step.cause][0] + " (not stated)" * (not step.stated),
            f"{answer.sought.name} after it": answer.in_words(step.size),
            "change [%]": number(100 * (step.factor - 1), "+.1f") if k else "",
            "air": Air(step.humidity).words,
        }
        for k, step in enumerate(answer.known_steps)
    )


def builds(datasets: Mapping[str, xr.Dataset], warnings: Mapping[str, str]) -> dict[str, float]:
    """Sizes to build by device [m or N], NaN where none is stated. Parameters as of `of_datasets`."""
    answers = of_datasets(datasets, warnings)
    return {name: np.nan if answer.forbidden else answer.build for name, answer in answers.items()}


def of_datasets(answers: Mapping[str, xr.Dataset], warnings: Mapping[str, str]) -> dict[str, Answer]:
    """Answers of some devices from their datasets, and from the files of their limits, by name."""
    limits = device_warnings.read(warnings)
    return {name: judged(dataset, limits) for name, dataset in answers.items()}


STAGES = (
    table_stage(
        "devices",
        "verdicts on all devices",
        inputs=lambda plan, at: {
            "answers": by_name("devices/answer", plan.devices.sections),
            "warnings": device_warnings.files_of(*plan.devices.sections),
        },
        compute=lambda data, settings: devices(
            of_datasets({name: data["answers"][name] for name in settings["order"]}, data["warnings"])
        ),
        settings=lambda plan, at: {"order": plan.devices.in_order},
        jobs=lambda plan: [{}] if plan.devices.sections else [],
        targets=("devices",),
    ),
)
