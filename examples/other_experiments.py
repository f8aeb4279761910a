"""Numbers of this tool beside experiments of others: ``python other_experiments.py FOLDER``, after ``make paper``.

Draws flats as large as the end of a flat tip of an atomic force microscope, 2 µm across, and writes the humidity of
their largest pull-off force (``flat_tips.csv`` and ``.md``) to ``runs/experiments`` in FOLDER.
"""

import sys
from pathlib import Path

import numpy as np
import pandas as pd

import stiction
from stiction.contact.environment import Water
from stiction.plan.graph import Results
from stiction.report.format import UN
from stiction.stages.contact.curves import pull_offs

#: Sides of a patch as large as a disc 2 µm across [µm].
LENGTH, WIDTH = 1.5, 2.1
#: Pairs of the paper, and two silicon wafers like its substrate Sub1.
PAIRS = {"smooth": {"beam": "Sub1", "substrate": "Sub1", "gap_um": 20, "humidities": [0.45]}}
NAMES = ("smooth", "a", "b", "c")
HUMIDITIES = np.round(np.arange(0.42, 0.985, 0.02), 2)


def main(folder):
    """Write the table of flat tips."""
    rows = [flat_tip(name) for name in NAMES]
    frame = pd.DataFrame(rows)
    into = folder / "runs" / "experiments"
    into.mkdir(parents=True, exist_ok=True)
    frame.to_csv(into / "flat_tips.csv", index=False, lineterminator="\n")
    (into / "flat_tips.md").write_text(frame.to_markdown(index=False, floatfmt=".3g") + "\n", encoding="utf-8")


def flat_tip(name):
    """Pull-off forces of a flat tip on one pair: at RH 0.45, the largest, and its humidity; mean over 300 patches."""
    changed = {"sampling": {"strip_length_um": LENGTH}, "beam": {"width_um": WIDTH}, "chaos": {"order": 3}}
    changed |= {"contact": {"samples": 300, "chunks": 1}, "attraction": {"reach": "touching"}}
    results = Results.of(stiction.load(changed | {"pairs": PAIRS, "run": {"pairs": [name]}}))
    contact = results[f"contact/{name}_NG"]
    forces = [pull_offs(contact, float(h), Water(300.0)).mean() * LENGTH * WIDTH * 1e-12 / UN for h in HUMIDITIES]
    most = int(np.argmax(forces))
    return {
        "pair": name,
        "RH 0.46 [µN]": forces[list(HUMIDITIES).index(0.46)],
        "largest [µN]": forces[most],
        "at RH": HUMIDITIES[most],
        "RH 0.98 [µN]": forces[-1],
    }


if __name__ == "__main__":
    main(Path(sys.argv[1]))
