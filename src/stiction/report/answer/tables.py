"""Table of the verdicts on all devices, one row each, for a spreadsheet; and the steps of one answer."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
import xarray as xr

from stiction.answer.data import Answer, Cause, Probability
from stiction.answer.sought import LENGTH
from stiction.contact.air import Air
from stiction.plan.names import by_name
from stiction.report.answer import places, words
from stiction.report.answer.judged import judged
from stiction.report.format import MISSING, bounding, number, safe_size
from stiction.report.table import Table, Term, table_stage
from stiction.stages.devices import device_warnings
from stiction.stages.devices.end_states import END_STATES

_SHOWS = (
    "One row for each device.",
    Term(
        "To build",
        "the largest length, or the smallest restoring force, with at most this fraction stuck in all stated airs, "
        "after one touchdown or all stated ones, at the stated voltage and tilts, with 95 % confidence if the model "
        "holds; the simulation and all stated or assumed uncertainties are inside.",
    ),
    Term(
        "But",
        "stricter sizes, between the stated airs, or by simulation alone where nothing that is stated asks for them.",
    ),
    Term("P(stuck)", "expected fraction at the stated size, with a band of 95 % that contains the same."),
    Term("Measure", "what would change the size most, and the size if it were known exactly."),
    Term("No number", "what forbids one."),
)


def devices(answers: Mapping[str, Answer]) -> Table:
    """Verdicts on all devices."""
    columns = {
        "device": (str, "device"),
        "verdict": (str, "sign"),
        "stated": (_size, "size", "unit"),
        "to build": (_bound, "to_build", "unit"),
        "but": (str, "stricter"),
        "P(stuck) at the stated size": (str, "stuck"),
        "at most 1 in": (lambda share: number(1 / share, "g"), "share"),
        "largest step": (str, "largest_step"),
        "measure first": (str, "measure"),
        "then to build": (_bound, "if_measured", "unit"),
        "no number because of": (str, "forbidden"),
    }
    rows, shows = [_row(answer) for answer in answers.values()], _SHOWS
    if any(answer.pull_offs for answer in answers.values()):
        rows = [row | _of_places(answer) for row, answer in zip(rows, answers.values(), strict=True)]
        columns, shows = columns | _COLUMNS_OF_PLACES, (*shows, *_PLACES)
    return Table.from_rows([_without_noise(row) for row in rows], shows, columns)


#: What columns about probes show.
_PLACES = (
    "Without a spring, a probe is asked for its pull-off force: what half of the places hold at most, in the air where "
    "they hold most, and the probability that a measurement gives no more than the measured force, or no less, with "
    "bands of 95 % that contain the errors of simulation and inputs.",
    Term(
        "Two-sided",
        "twice the smaller of both, with a band of the simulation alone. Below 5 % with its band, the measured force "
        "does not fit.",
    ),
)
#: Numbers of probes: ends of bands, quantiles of the forces, and ranks of a measured one.
_ENDS, _QUANTILES, _RANKS = (
    ("", "_low", "_high"),
    ("pull_off_5", "pull_off_50", "pull_off_95"),
    ("less", "more", "two_sided"),
)


def _of_places(answer):
    """Numbers of a probe without a spring in the air where places hold most, NaN of other devices."""
    numbers = np.full((len(_QUANTILES) + len(_RANKS), len(_ENDS)), np.nan)
    if answer.pull_offs and not words.is_forbidden(answer):
        forces = answer.pull_off
        ranks = [
            (rank.value, rank.low, rank.high) if rank else [np.nan] * len(_ENDS)
            for rank in (forces.less, forces.more, forces.two_sided)
        ]
        numbers = np.concatenate([forces.quantiles / answer.sought.scale, ranks])
    names = (*(f"{name}_percent_nN" for name in _QUANTILES), *_RANKS)
    return {
        f"{name}{end}": float(value)
        for name, row in zip(names, numbers, strict=True)
        for end, value in zip(_ENDS, row, strict=True)
    }


def _probability(*numbers):
    """Probability with its band, – without one."""
    return places.in_words(Probability(*numbers)) if np.isfinite(numbers).all() else MISSING


_COLUMNS_OF_PLACES = {
    "median pull-off [nN]": (places.with_band, *(f"pull_off_50_percent_nN{end}" for end in _ENDS)),
    "P(measured or less)": (_probability, *(f"less{end}" for end in _ENDS)),
    "P(measured or more)": (_probability, *(f"more{end}" for end in _ENDS)),
    "two-sided": (_probability, *(f"two_sided{end}" for end in _ENDS)),
}


def _row(answer):
    """Numbers of one device in the unit of its size. Where a limit forbids a number, there is none."""
    scale, unit = answer.sought.scale, answer.sought.shown
    factor = np.nan if words.is_forbidden(answer) else 1.0
    to_build = np.nan if answer.forbidden else answer.build / scale
    last, stuck = answer.stated_steps[-1], None if answer.pull_offs else answer.stuck
    band = (stuck.value, stuck.low, stuck.high) if stuck else (np.nan,) * 3
    return {
        "device": answer.device,
        "kind": answer.kind,
        "verdict": str(answer.verdict),
        "tone": words.sign_of(answer)[0],
        "sign": words.sign_of(answer)[1],
        "unit": unit,
        "size": answer.size / scale,
        "to_build": to_build,
        "between": np.nan if answer.forbidden or not answer.between else answer.between.size / scale,
        "stricter": MISSING if answer.forbidden else "; ".join(words.stricter(answer)) or MISSING,
        "exact": factor * answer.exact / scale,
        "share": answer.share,
        **dict(zip(("stuck_value", "stuck_low", "stuck_high"), factor * np.array(band), strict=True)),
        "none_seen": bool(stuck and stuck.none_seen),
        "stuck": words.stuck_in_words(stuck) if stuck and not words.is_forbidden(answer) else MISSING,
        **{f"after_{cause}": np.nan for cause in Cause},
        **{f"after_{step.cause}": factor * step.size / scale for step in answer.steps},
        "relative_humidity": last.humidity,
        "held_by": END_STATES[last.shape].by if last.shape in END_STATES else last.shape,
        "by_tip": answer.is_by_tip,
        "largest_step": str(answer.largest_step.cause) if answer.known_steps else MISSING,
        "measure": answer.measure,
        "if_measured": factor * answer.if_measured / scale,
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


def _bound(value, unit):
    """Size to build with its unit, rounded to its safe side: lengths down, forces up."""
    return bounding(value, 3, unit != LENGTH.shown) + (f" {unit}" if np.isfinite(value) else "")


def steps(answer: Answer) -> pd.DataFrame:
    """Steps from the estimate to the size to build, and beyond it by what is not stated, for reading."""
    return pd.DataFrame(
        {
            "step": words.step_in_words(answer, step),
            f"{answer.sought.name} after it": safe_size(step.size, answer.sought),
            "change [%]": number(100 * (step.factor - 1), "+.1f") if k else "",
            "air": Air(step.humidity).words,
        }
        for k, step in enumerate(answer.known_steps)
    )


def allowed(datasets: Mapping[str, xr.Dataset], warnings: Mapping[str, str]) -> dict[str, Answer | None]:
    """Answers by device, none for a device whose size to build is forbidden. Parameters as of `of_datasets`."""
    answers = of_datasets(datasets, warnings)
    return {name: None if answer.forbidden else answer for name, answer in answers.items()}


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
