"""Table III of the base case and under the reading of ``print.yaml``, beside print.

``python compare_print.py BASE PRINT``, both of them folders with ``results``, writes to PRINT: ``print.csv``, all
cases, and ``print.md``, deviations by pair.
"""

import sys
from pathlib import Path

import numpy as np
import pandas as pd

#: Columns that identify a case, and those of published and measured lengths.
CASE = ["pair", "relative_humidity", "model"]
KNOWN = ["published_um", "published_std_um", "experiment_um"]
#: Columns of each run.
COMPUTED = ["crack_length_um", "crack_length_std_um", "crack_length_se_um"]


def main(base, printed):
    """Write the comparison of both runs."""
    runs = [
        pd.read_csv(folder / "results" / "tables" / "table_3.csv", dtype={"pair": str}) for folder in (base, printed)
    ]
    cases = compared(*runs)
    cases.to_csv(printed / "print.csv", index=False, lineterminator="\n")
    (printed / "print.md").write_text(by_pair(cases), encoding="utf-8")


def compared(base, printed):
    """Published cases of both runs, side by side, with their deviations from the published values."""
    sides = [run.set_index(CASE)[COMPUTED].add_prefix(f"{name}_") for name, run in (("base", base), ("print", printed))]
    cases = base.set_index(CASE)[KNOWN].dropna().join(sides, how="inner").reset_index()
    for name in ("base", "print"):
        lengths = cases[f"{name}_crack_length_um"]
        cases[f"{name}_deviation_percent"] = 100 * (lengths / cases.published_um - 1)
        cases[f"{name}_measured_deviation_percent"] = 100 * (lengths / cases.experiment_um - 1)
        cases[f"{name}_scatter_ratio"] = cases[f"{name}_crack_length_std_um"] / cases.published_std_um
    return cases


def by_pair(cases):
    """Deviations by model and pair, in Markdown."""
    rows = []
    for (model, pair), group in cases.groupby(["model", "pair"], sort=False):
        row = {"model": model, "pair": pair}
        for name in ("base", "print"):
            off, measured = (group[f"{name}_{which}_percent"] for which in ("deviation", "measured_deviation"))
            row |= {
                f"{name}: rms dev. from print [%]": f"{rms(off):.1f}",
                f"{name}: mean dev. [%]": f"{off.mean():+.1f}",
                f"{name}: scatter over printed": f"{np.exp(np.log(group[f'{name}_scatter_ratio']).mean()):.2f}",
                f"{name}: rms dev. from measured [%]": f"{rms(measured):.1f}",
            }
        rows.append(row)
    caption = (
        "Table III of the base case and under the reading nearest to print (no attraction of solids, grid of 5 nm): "
        "root mean square and mean over the humidities of the deviation of the mean crack length from the published "
        "one, geometric mean of the ratio of its standard deviation to the published one, and rms deviation from the "
        "measured lengths."
    )
    return f"{caption}\n\n{pd.DataFrame(rows).to_markdown(index=False, disable_numparse=True, stralign='right')}\n"


def rms(values):
    """Root mean square."""
    return np.sqrt(np.mean(values**2))


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
