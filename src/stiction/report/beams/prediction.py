"""Prediction intervals of Table III: ranges of measured lengths if the form of the model errs as on other pairs."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from stiction.analysis.prediction import LENGTHS, PAIRS, Discrepancy
from stiction.contact.air import is_humid
from stiction.plan.stage import File
from stiction.report.format import MISSING
from stiction.report.style import (
    DOUBLE,
    columns_of_panels,
    figure_stage,
    handles,
    humidity_axis,
    legend_outside,
    letter,
    plain_log,
    styled,
)
from stiction.report.table import Term

#: Probabilities of the intervals.
COVERAGES = (0.68, 0.95)
#: Columns with the ends of the interval of each probability [µm].
ENDS = {
    coverage: tuple(f"prediction_{100 * coverage:.0f}_{end}_um" for end in ("low", "high")) for coverage in COVERAGES
}
_GREYS = "0.88", "0.72"
_COMPUTED = {"color": "#0072B2", "marker": "o", "markersize": 3}
_MEASURED = {"fmt": "D", "color": "black", "markersize": 3}
#: Model with the measured moments of the heights, by which all discrepancies are learnt.
_LEARNT_BY = "NG"


def with_intervals(rows: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Rows of Table III with the ends of their prediction intervals, unchanged without two other measured pairs.

    The discrepancy of a pair is learnt from all others: its own measured lengths take no part.
    ASSUME: that of beams with scattered dimensions is that of nominal ones. Gaussian surfaces and dry air, with which
    the paper has no comparison, have no interval.
    """
    frame = pd.DataFrame(rows)
    lengths = frame[(frame.model == _LEARNT_BY) & is_humid(frame.relative_humidity) & frame.crack_length_um.notna()]
    measured = {
        pair: (table.crack_length_um.values, table.experiment_um.values)
        for pair, table in lengths[lengths.experiment_um.notna()].groupby("pair", sort=False)
        if table.crack_length_um.nunique() >= LENGTHS
    }
    parts = []
    for pair, table in frame.groupby("pair", sort=False):
        others = [lengths_of_pair for other, lengths_of_pair in measured.items() if other != pair]
        if len(others) >= PAIRS:
            middle = np.log(lengths.crack_length_um[lengths.pair == pair]).mean()
            parts.append(_ends(table, Discrepancy.learnt(others), middle))
    if not parts:
        return list(map(dict, rows))
    return frame.join(pd.concat(parts)).to_dict("records")


def _ends(rows, discrepancy, middle):
    """Ends of the intervals of the rows of a pair."""
    computed_rows = rows[(rows.model != "G") & is_humid(rows.relative_humidity) & rows.crack_length_um.notna()]
    lengths = computed_rows.crack_length_um.values
    scans = computed_rows.get("crack_length_scans_se_um", pd.Series(0.0, computed_rows.index)).fillna(0.0)
    errors = np.hypot(computed_rows.crack_length_se_um, scans).values / lengths
    intervals_of_rows = pd.DataFrame(
        index=rows.index, columns=[name for ends in ENDS.values() for name in ends], dtype=float
    )
    for coverage, names in ENDS.items():
        widths = discrepancy.half_widths(np.log(lengths) - middle, errors, coverage)
        for name, sign in zip(names, (-1, 1), strict=True):
            intervals_of_rows.loc[computed_rows.index, name] = lengths * np.exp(sign * widths)
    return intervals_of_rows


def count_contained(table: pd.DataFrame, coverage: float) -> tuple[int, int]:
    """Number of the measured lengths in their intervals of a probability, and of all, model NG."""
    compared = table[(table.model == _LEARNT_BY) & table.experiment_um.notna() & table[ENDS[coverage][0]].notna()]
    low, high = (compared[name] for name in ENDS[coverage])
    return int(compared.experiment_um.between(low, high).sum()), len(compared)


def caption(table: pd.DataFrame) -> Term:
    """Meaning of the columns, and how many measured lengths they contain."""
    stated = [(_percent(coverage), *count_contained(table, coverage)) for coverage in COVERAGES]
    number = " and ".join(f"{inside}" for _, inside, _ in stated)
    return Term(
        " and ".join(name for name, *_ in stated),
        "prediction intervals of a measured length, with the form of the "
        "model as an error: a factor, a slope over ln l_s and a rest, learnt from the measured lengths of the paper's "
        f"other pairs, and the standard error. They contain {number} of {stated[0][2]} measured lengths.",
    )


def _percent(coverage):
    """Probability as text."""
    return f"{100 * coverage:.0f} %"


def _as_text(low, high):
    """Interval as text [µm]."""
    return MISSING if np.isnan(low) else f"{low:.0f} to {high:.0f}"


#: Columns for reading.
COLUMNS = {f"{_percent(coverage)} [µm]": (_as_text, *names) for coverage, names in ENDS.items()}


@styled
def intervals(table: pd.DataFrame) -> Figure:
    """Computed crack lengths with their prediction intervals, measured lengths beside them. A panel for each pair.

    If cracks of too few pairs have a length, there is one empty panel.
    """
    ends = table.reindex(columns=[name for names in ENDS.values() for name in names])
    compared = table[(table.model == _LEARNT_BY) & ends.notna().all(axis=1)]
    parts = dict(list(compared.groupby("pair", sort=False)))
    figure, columns, _ = columns_of_panels(max(len(parts), 1), 1, lambda across: DOUBLE, 2.6)
    for panel, table_of_pair in zip(columns[:, 0], parts.values(), strict=False):
        for coverage, colour in zip(reversed(COVERAGES), _GREYS, strict=True):
            low, high = (table_of_pair[name] for name in ENDS[coverage])
            panel.fill_between(
                table_of_pair.relative_humidity,
                low,
                high,
                color=colour,
                linewidth=0,
                label=f"{_percent(coverage)} interval",
            )
        panel.plot(table_of_pair.relative_humidity, table_of_pair.crack_length_um, label="computed", **_COMPUTED)
        if table_of_pair.experiment_um.notna().any():
            measured = table_of_pair.experiment_um, table_of_pair.experiment_std_um
            panel.errorbar(table_of_pair.relative_humidity, *measured, label="measured ± std", **_MEASURED)
        panel.set_yscale("log")
        plain_log(panel.yaxis)
        panel.set(xlabel="relative humidity RH [–]", ylabel="crack length $l_s$ [µm]")
        humidity_axis(panel)
    if parts:
        letter(columns[:, 0], [f"pair {pair}" for pair in parts])
        legend_outside(figure, handles(*columns.flat), "lower", 4)
    return figure


def _measured_pairs(plan):
    """Pairs of the run with enough measured lengths to learn from."""
    return [pair for pair in plan.paper.pairs if len(plan.air.humid(pair)) >= LENGTHS]


STAGES = (
    figure_stage(
        "intervals",
        "crack lengths with prediction intervals",
        "Beams (Secs. IV and V)",
        inputs=lambda plan, at: {"table": File("results/tables/table_3.csv")},
        jobs=lambda plan: [{}] if len(plan.pairs) > PAIRS <= len(_measured_pairs(plan)) else [],
        compute=lambda data: intervals(pd.read_csv(data["table"], dtype={"pair": str})),
        targets=("figures",),
    ),
)
