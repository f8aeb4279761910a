"""Compare predictions with experiments: ``python comparison.py PREDICTIONS INTO``.

Reads ``PREDICTIONS/NAME.json`` of every experiment and writes ``validation.csv``, the tables ``validation.md`` and
``misses.md``, and ``validation.png`` to INTO.
"""

import json
import sys
from pathlib import Path

import numpy as np
import pandas as pd
from experiment import FROM_SI, LINEAR, Experiment, Row, experiments
from figure import drawn
from prediction import SEED
from scipy.special import ndtri

from stiction.report.format import MISSING, number
from stiction.report.style import save
from stiction.streams import stream

LICENCE = "# Licence: CC BY 4.0, the stiction developers. Measured values are facts of the cited sources.\n"
#: Unit of the standard deviations apart: larger values stand for this one in tables.
FARTHEST = 99
HEADS = ("experiment", "quantity", "measured", "predicted, 90 %", "deviations apart", "inside")


def main(predictions, into):
    """Write tables and figure."""
    found = experiments()
    frame = pd.DataFrame([row for experiment in found for row in rows(experiment, predictions)]).replace("", np.nan)
    into.mkdir(parents=True, exist_ok=True)
    (into / "validation.csv").write_text(LICENCE + frame.to_csv(index=False, lineterminator="\n"), encoding="utf-8")
    (into / "validation.md").write_text(table(frame), encoding="utf-8")
    (into / "misses.md").write_text(misses(frame), encoding="utf-8")
    save(drawn(frame), into / "validation.png")


def rows(experiment: Experiment, predictions: Path) -> list[dict]:
    """Rows of the table of one experiment, without numbers if it is not computed."""
    source = experiment.source
    about = {
        "experiment": experiment.name,
        "title": experiment.title,
        "laboratory": experiment.laboratory,
        "source": source["cite"],
        "link": f"https://doi.org/{source['doi']}" if "doi" in source else source["link"],
        "read": source["read"],
        "not_computed": experiment.not_computed,
    }
    stored = json.loads((predictions / f"{experiment.name}.json").read_text(encoding="utf-8"))
    computed = [
        compared(row, unit_of(row) * np.array(found["draws"]), stream(SEED, "noise", experiment.name, number))
        | {"monte_carlo": found["monte_carlo"]}
        for number, (row, found) in enumerate(zip(experiment.rows, stored, strict=False))
    ]
    computed = computed or [{}] * len(experiment.rows)
    return [about | stated(row) | numbers for row, numbers in zip(experiment.rows, computed, strict=True)]


def unit_of(row: Row) -> float:
    """Factor from a predicted quantity to the unit of its row: places of laws have it already."""
    return FROM_SI[row.unit] if row.kind == "level" else 1.0


def stated(row: Row) -> dict:
    """What a row says of the measurement, and why it disagrees."""
    names = ("quantity", "kind", "unit", "value", "error", "at_most", "at_least", "reading", "reason", "side")
    return {name: getattr(row, name) for name in names}


def compared(row: Row, draws: np.ndarray, rng: np.random.Generator) -> dict:
    """Median and interval of the predicted measurement, and its distance from the measured value.

    Each draw gets an error of the measurement. The interval is the range of the draws, in which another draw would lie
    in (n - 1) of (n + 1) cases. Distances are in standard deviations of the draws, positive if more was measured; for a
    bound, the distance by which most draws exceed it.
    """
    measurements = noisy(row, draws, rng)
    scale = (lambda values: values) if row.kind in LINEAR else np.log
    low, high = measurements.min(), measurements.max()
    middle, deviation = scale(measurements).mean(), scale(measurements).std(ddof=1)
    if row.is_bound:
        is_upper = np.isnan(row.at_least)
        bound = row.at_most if is_upper else row.at_least
        beyond = (scale(bound) - middle) / deviation
        apart, inside = (min(0.0, beyond), low <= bound) if is_upper else (max(0.0, beyond), high >= bound)
    else:
        apart, inside = (scale(row.value) - middle) / deviation, low <= row.value <= high
    return {
        "predicted": float(np.median(draws)),
        "low": low,
        "high": high,
        "apart": float(apart),
        "inside": bool(inside),
    }


def noisy(row: Row, draws: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Draws with an error of the measurement each, evenly spread quantiles of a normal distribution."""
    scores = ndtri((rng.permutation(len(draws)) + 0.5) / len(draws))
    if row.is_bound:
        return draws
    return draws + row.error * scores if row.kind in LINEAR else draws * np.exp(row.error / row.value * scores)


def table(frame: pd.DataFrame) -> str:
    """Every row beside its prediction. Markdown; † marks values read in an abstract alone."""
    lines = [f"| {' | '.join(HEADS)} |", "|---" * len(HEADS) + "|"]
    for row in frame.itertuples():
        mark = " †" if row.read == "abstract" else ""
        cells = [f"[{row.title}]({row.link}){mark}", row.quantity, measured(row), *prediction(row)]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def prediction(row) -> list[str]:
    """Cells of a row about its prediction."""
    if np.isnan(row.predicted):
        return [f"not computed: {row.not_computed}", MISSING, MISSING]
    apart = f"{np.clip(row.apart, -FARTHEST, FARTHEST):+.1f}"
    return [f"{row.predicted:.3g} ({row.low:.3g} to {row.high:.3g})", apart, "yes" if row.inside else "**no**"]


def measured(row) -> str:
    """Measured value or bound with its unit."""
    unit = "" if row.unit == "-" else f" {row.unit}"
    if not np.isnan(row.value):
        return f"{row.value:g}{f' ± {row.error:g}' if row.error else ''}{unit}"
    return f"at most {row.at_most:g}{unit}" if np.isnan(row.at_least) else f"at least {row.at_least:g}{unit}"


def misses(frame: pd.DataFrame) -> str:
    """Rows outside of their interval, with the reason. Markdown."""
    lines = ["| experiment | quantity | measured | predicted | the model is | reason |", "|---|---|---|---|---|---|"]
    outside = frame[frame.inside.eq(False)].fillna({"side": MISSING, "reason": MISSING})
    for row in outside.itertuples():
        cells = [f"[{row.title}]({row.link})", row.quantity, measured(row), number(row.predicted, ".3g")]
        lines.append(f"| {' | '.join([*cells, row.side, row.reason])} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
