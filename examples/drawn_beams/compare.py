"""Crack lengths of the device with and without test beams beside the truth: ``python compare.py FOLDER``.

Reads the table of test beams of a run in the folder, and writes ``prediction.csv``, ``prediction.md`` and
``prediction.png``.
"""

import sys
from pathlib import Path

import pandas as pd

from stiction.contact.air import Air
from stiction.report.format import number, with_error
from stiction.report.style import INTERVAL, SINGLE, handles, legend_outside, panels, save, styled
from stiction.report.table import Table

#: Predictions by the columns of the table: words, colour and shift in the figure.
PREDICTIONS = {"before": ("without test beams", "0.6", -0.14), "after": ("with test beams", "#0072B2", 0.14)}


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
    """Predicted and true crack lengths, a row for each humidity, which ends with half the widths of the intervals."""
    figure, ((panel,),) = panels(1, 1, (SINGLE, 0.9 + 0.5 * len(lengths)))
    for place, row in enumerate(lengths.itertuples()):
        widths = [INTERVAL * getattr(row, f"{name}_std_um") for name in PREDICTIONS]
        for (name, (words, colour, shift)), width in zip(PREDICTIONS.items(), widths, strict=True):
            style = {"fmt": "o", "color": colour, "label": "_" if place else f"{words}, 95 %"}
            panel.errorbar(getattr(row, f"{name}_um"), place + shift, xerr=width, **style)
        panel.plot([row.true_um] * 2, [place - 0.3, place + 0.3], color="black", label="_" if place else "truth")
        text = f"± {' → ± '.join(f'{width:.0f}' for width in widths)} µm"
        panel.text(0.99, place - 0.36, text, transform=panel.get_yaxis_transform(), ha="right", va="center", fontsize=7)
    panel.set(xlabel="crack length $l_s$ [µm]", ylim=(len(lengths) - 0.5, -0.6))
    panel.set_yticks(range(len(lengths)), [Air(humidity).words for humidity in lengths.humidity])
    panel.tick_params(axis="y", length=0)
    legend_outside(figure, handles(panel), "lower", 3)
    return figure


if __name__ == "__main__":
    main(Path(sys.argv[1]))
