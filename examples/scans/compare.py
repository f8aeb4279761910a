"""Crack lengths predicted from the drawn scans compared with those of the true surfaces: ``python compare.py FOLDER``.

Reads Table III of a run in the folder, and writes ``prediction.csv``, ``prediction.md`` and ``prediction.png``.
"""

import sys
from pathlib import Path

import numpy as np
import pandas as pd

from stiction.report.format import error_alone, number, with_error
from stiction.report.style import SINGLE, humidity_axis, letter, panels, save, styled
from stiction.report.table import Table

#: Pairs of the measured and of the true surfaces.
MEASURED, TRUE = "mine", "truth"


def main(folder):
    """Write table and figure."""
    cracks = compared(pd.read_csv(folder / "results" / "tables" / "table_3.csv"))
    table = written(cracks)
    (folder / "prediction.csv").write_text(table.csv, encoding="utf-8")
    (folder / "prediction.md").write_text(table.markdown, encoding="utf-8")
    save(drawn(cracks), folder / "prediction.png")
    print(table.markdown)  # noqa: T201


def compared(table_3):
    """Crack lengths of both pairs with their errors [µm], one row per humidity; model NG."""
    cases = table_3[table_3.model == "NG"].set_index(["pair", "relative_humidity"])
    mine, true = cases.loc[MEASURED], cases.loc[TRUE]
    cracks = pd.DataFrame(
        {
            "predicted_um": mine.crack_length_um,
            "scans_se_um": mine.crack_length_scans_se_um,
            "simulation_se_um": mine.crack_length_se_um,
            "true_um": true.crack_length_um,
            "true_se_um": true.crack_length_se_um,
        }
    )
    errors = cracks[["scans_se_um", "simulation_se_um", "true_se_um"]]
    cracks["errors_off"] = (cracks.predicted_um - cracks.true_um) / np.sqrt((errors**2).sum(axis=1, skipna=False))
    return cracks.reset_index()


def written(cracks):
    """Table for reading."""
    rows = [
        {
            "RH": f"{row.relative_humidity:g}",
            "l_s from scans [µm]": with_error(row.predicted_um, np.hypot(row.scans_se_um, row.simulation_se_um)),
            "error due to scans": error_alone(row.scans_se_um),
            "error due to simulation": error_alone(row.simulation_se_um),
            "l_s of the true surfaces [µm]": with_error(row.true_um, row.true_se_um),
            "difference in standard errors": number(row.errors_off, "+.1f"),
        }
        for row in cracks.itertuples()
    ]
    caption = (
        "Crack length predicted from scans, ± standard error due to scans and to the simulation, and its true value."
    )
    return Table(cracks, caption, pd.DataFrame(rows))


@styled
def drawn(cracks):
    """Crack lengths over the humidity, and their differences from those of the true surfaces."""
    figure, ((lengths,), (differences,)) = panels(2, 1, (SINGLE, 3.8), sharex=True, height_ratios=[2, 1])
    error = np.hypot(cracks.scans_se_um, cracks.simulation_se_um)
    scans = {"marker": "o", "linestyle": "", "label": "from scans, ± standard error"}
    lengths.plot(cracks.relative_humidity, cracks.true_um, color="black", marker="s", label="of the true surfaces")
    lengths.errorbar(cracks.relative_humidity, cracks.predicted_um, error, **scans)
    lengths.set(ylabel="crack length $l_s$ [µm]")
    lengths.legend()
    difference, of_both = cracks.predicted_um - cracks.true_um, np.hypot(error, cracks.true_se_um)
    differences.axhline(0, color="black", linewidth=0.8)
    differences.errorbar(
        cracks.relative_humidity, *(100 * part / cracks.true_um for part in (difference, of_both)), **scans
    )
    differences.set(xlabel="relative humidity [–]", ylabel="difference [%]")
    humidity_axis(differences)
    letter([lengths, differences], ["crack lengths", "difference, with both errors"])
    return figure


if __name__ == "__main__":
    main(Path(sys.argv[1]))
