"""Crack lengths of the device with and without test beams beside the truth: ``python compare.py FOLDER``.

Reads the table of test beams of a run in the folder, and writes ``prediction.csv``, ``prediction.md`` and
``prediction.png``.
"""

import sys
from pathlib import Path

import pandas as pd

from stiction.report.format import number, with_error
from stiction.report.style import SINGLE, humidity_axis, panels, save, styled
from stiction.report.table import Table

#: Predictions by the columns of the table: words, colour and shift in the figure.
PREDICTIONS = {"before": ("without test beams", "0.6", -0.004), "after": ("with test beams", "#0072B2", 0.004)}


def main(folder):
    """Write table and figure."""
    rows = pd.read_csv(folder / "results" / "tables" / "test_beams.csv")
    lengths = compared(rows, pd.read_csv(folder / "truth.csv"))
    table = written(lengths)
    (folder / "prediction.csv").write_text(table.csv, encoding="utf-8")
    (folder / "prediction.md").write_text(table.markdown, encoding="utf-8")
    save(drawn(lengths), folder / "prediction.png")
    print(table.markdown)  # noqa: T201


def compared(rows, truth):
    """Mean crack lengths with their standard deviations, and the true ones, one row per humidity [µm]."""
    own = rows[(rows.name == "C1") & (rows.part == "crack length [µm]")].set_index("relative_humidity")
    true = truth.set_index("humidity")
    columns = {f"{name}{end}_um": own[f"{name}{end}"] for name in PREDICTIONS for end in ("", "_std")}
    return (
        pd.DataFrame(columns | {"true_um": true.crack_length_um, "true_se_um": true.se_um})
        .rename_axis("humidity")
        .reset_index()
    )


def off(row, name):
    """Difference of a prediction from the truth in its standard deviations."""
    deviation = (getattr(row, f"{name}_std_um") ** 2 + row.true_se_um**2) ** 0.5
    return (getattr(row, f"{name}_um") - row.true_um) / deviation


def written(lengths):
    """Table for reading."""
    rows = []
    for row in lengths.itertuples():
        cells = {"RH": f"{row.humidity:g}", "true l_s [µm]": with_error(row.true_um, row.true_se_um)}
        for name, (words, *_) in PREDICTIONS.items():
            cells[f"{words} [µm]"] = with_error(getattr(row, f"{name}_um"), getattr(row, f"{name}_std_um"))
            cells[f"{words}: difference in standard deviations"] = number(off(row, name), "+.1f")
        rows.append(cells)
    return Table(lengths, "Mean crack length of the device, predicted and true.", pd.DataFrame(rows))


@styled
def drawn(lengths):
    """Predicted and true crack lengths over the humidity."""
    figure, ((panel,),) = panels(1, 1, (SINGLE, 2.6))
    panel.plot(lengths.humidity, lengths.true_um, color="black", marker="s", linestyle="", label="truth")
    for name, (words, colour, shift) in PREDICTIONS.items():
        deviation = 1.96 * lengths[f"{name}_std_um"]
        panel.errorbar(
            lengths.humidity + shift, lengths[f"{name}_um"], deviation, fmt="o", color=colour, label=f"{words}, 95 %"
        )
    panel.set(xlabel="relative humidity [–]", ylabel="crack length $l_s$ [µm]")
    panel.legend()
    humidity_axis(panel)
    return figure


if __name__ == "__main__":
    main(Path(sys.argv[1]))
