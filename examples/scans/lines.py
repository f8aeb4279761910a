"""Draw lines across surface B2 of the paper, as a stylus writes them: ``python lines.py FOLDER``, then lines.yaml."""

import sys
from pathlib import Path

import numpy as np

import stiction

#: Length of a line [m], and tilt of the sample [-].
LENGTH, TILT = 40e-6, 2e-3


def main(folder, length=LENGTH, number=3):
    """Write texts with places [µm] and heights [nm], a point every 20 nm."""
    surface = stiction.Surface.of(stiction.load(), "B2")
    Path(folder).mkdir(parents=True, exist_ok=True)
    for k in range(number):
        line = surface.draw(k, length, width=1e-6)[::2, 0]
        places, heights = line.x.to_numpy(), line.to_numpy() + TILT * line.x.to_numpy()
        columns = np.column_stack([1e6 * places, 1e9 * heights])
        path = Path(folder) / f"line_{k + 1}.txt"
        np.savetxt(path, columns, "%.4f", "\t", header="x [µm]\tz [nm]", comments="", encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
