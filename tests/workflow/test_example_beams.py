"""The example of test beams: the drawn files are those that its configuration reads, and its comparison is right."""

import runpy
import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from scipy.special import ndtr

from stiction.config.files import load
from stiction.stages.devices.opening import EITHER

FOLDER = Path(__file__).parents[2] / "examples" / "drawn_beams"
draw, compare = (SimpleNamespace(**runpy.run_path(str(FOLDER / f"{name}.py"))) for name in ("draw", "compare"))
AXIS = np.linspace(200e-6, 700e-6, 200)


def cracks(humidity):
    """Cracks of beams that are shorter in wetter air."""
    found = 1e-3 * (1.6 - humidity) * np.random.default_rng(0).lognormal(0, 0.05, 40)
    return xr.Dataset(
        {
            "crack_length": ("device", found),
            "foundation_length": 4e-6,
            "uniform_length": found.mean(),
            "surfaces_covariance": (("of", "with"), np.diag([1e-4, 0.0])),
        }
    )


def safe_lengths(_):
    stuck = xr.DataArray([ndtr((AXIS - 400e-6) / 50e-6)], coords={"shape": [EITHER], "length": ("length", AXIS)})
    return xr.Dataset({"stuck": stuck})


WAFER = SimpleNamespace(cracks=cracks, safe_lengths=safe_lengths)


def test_the_configuration_reads_the_drawn_beams(tmp_path):
    draw.write(tmp_path / "wafer.csv", draw.COLUMNS, [*draw.measured(WAFER), *draw.counted(WAFER)])
    shutil.copy(FOLDER / "mine.yaml", tmp_path)
    array = load(tmp_path / "mine.yaml")["test_beams"]["wafer"]
    assert [entry["humidity"] for entry in array["crack_lengths"]] == list(draw.MEASURED)
    assert {entry["beams"] for entry in array["crack_lengths"]} == {draw.NUMBER}
    # The air is wetter than stated, and cracks of these beams as long as in that air.
    expected = [1e6 * float(cracks(rh + draw.AIR).crack_length[: draw.NUMBER].mean()) for rh in draw.MEASURED]
    assert [entry["mean_um"] for entry in array["crack_lengths"]] == pytest.approx(expected, abs=0.05)
    shares = [(entry["length_um"], entry["stuck"] / entry["of"]) for entry in array["stuck"]]
    assert [length for length, _ in shares] == list(draw.COUNTED)
    assert shares[0][1] < 0.5 < shares[1][1]


def test_the_comparison_counts_differences_in_standard_deviations():
    rows = [
        {
            "name": name,
            "part": part,
            "relative_humidity": 0.6,
            "before": 700,
            "before_std": 80,
            "after": 640,
            "after_std": 30,
        }
        for name, part in (("C1", "crack length [µm]"), ("C1", "simulated limit"), ("wafer", "crack length [µm]"))
    ]
    truth = pd.DataFrame({"humidity": [0.6], "crack_length_um": [610.0], "se_um": [2.0]})
    found = compare.compared(pd.DataFrame(rows), truth)
    (row,) = found.itertuples()
    assert compare.off(row, "before") == pytest.approx(90 / np.hypot(80, 2))
    assert compare.off(row, "after") == pytest.approx(30 / np.hypot(30, 2))
    cells = compare.written(found).cells
    assert cells["with test beams: difference in standard deviations"].tolist() == ["+1.0"]
    assert compare.drawn(found).axes
