"""The example of measured surfaces: its scans have the truth, and its prediction is compared with it."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from configurations import module
from conftest import snakemake

import stiction

pytest.importorskip("SurfaceTopography")
FOLDER = Path(__file__).parents[2] / "examples" / "scans"


draw, compare = (module(FOLDER / f"{name}.py") for name in ("draw", "compare"))
SMALL = [replace(scans, side=5e-6, pixel=20e-9) for scans in draw.SCANS]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("example")
    draw.main(path, SMALL)
    shutil.copy(FOLDER / "mine.yaml", path)
    return path


def test_the_files_are_those_of_the_configuration_which_is_valid(folder):
    overlay = folder / "mine.yaml"
    surfaces = yaml.safe_load(overlay.read_text())["surfaces"]
    named = {file for surface in surfaces.values() for file in surface["scans"]["files"]}
    assert named == {path.name for path in folder.iterdir()} - {"mine.yaml"}
    assert stiction.load(overlay)["run"]["pairs"] == [compare.MEASURED, compare.TRUE]


@pytest.mark.parametrize("surface", SMALL, ids=lambda surface: surface.truth)
def test_scans_are_tilted_maps_of_the_true_surface(folder, surface):
    scan = stiction.read_scan(folder / f"{surface.name}_1.{surface.ending}").scan
    assert scan.frame.shape == (250, 250)
    np.testing.assert_allclose(scan.size, 5e-6)
    slope = np.polyfit(np.arange(250) * 20e-9, scan.heights.mean(axis=1), 1)[0]
    assert slope == pytest.approx(draw.TILT[0], rel=0.1)
    found = stiction.estimate_surface([scan], seed=1)
    truth = stiction.load()["surfaces"][surface.truth]
    wanted = np.array([np.log(1e-9 * truth["rms_nm"]), truth["skewness"], truth["kurtosis"]])
    assert np.all(np.abs(found.moments - wanted) < 4 * found.errors)
    other = stiction.read_scan(folder / f"{surface.name}_2.{surface.ending}").scan
    assert not np.array_equal(other.heights, scan.heights)


def test_files_that_exist_are_kept(folder):
    path = folder / "etched_1.gwy"
    before = path.stat().st_mtime_ns
    draw.main(folder, SMALL)
    assert path.stat().st_mtime_ns == before


def table_3(predicted=700.0, true=690.0):
    row = {"relative_humidity": 0.67, "crack_length_se_um": 3.0, "crack_length_scans_se_um": 4.0}
    return pd.DataFrame(
        [
            row | {"pair": pair, "model": model, "crack_length_um": length}
            for pair, length in (("mine", predicted), ("truth", true))
            for model in ("G", "NG")
        ]
    )


def test_the_prediction_is_compared_in_all_its_errors(tmp_path):
    found = compare.compared(table_3())
    assert list(found.relative_humidity) == [0.67]
    assert found.errors_off[0] == pytest.approx(10 / np.sqrt(4**2 + 3**2 + 3**2))
    (tmp_path / "results" / "tables").mkdir(parents=True)
    table_3().to_csv(tmp_path / "results" / "tables" / "table_3.csv")
    compare.main(tmp_path)
    assert "700.0 ± 5.0" in (tmp_path / "prediction.md").read_text()
    assert (tmp_path / "prediction.png").stat().st_size > 5000


@pytest.mark.slow
def test_the_whole_chain_runs_from_files_to_crack_lengths_beside_the_truth(folder, overlay):
    small = overlay(
        "pairs: {mine: {humidities: [0.67]}, truth: {humidities: [0.67]}}\n"
        "contact: {samples: 60}\nchaos: {order: 2}\nbeam: {samples: 10}\nstudies: {slopes: {samples: 20}}\n"
        "scans: {model_scans: 8}"
    )
    snakemake(folder, "measured", configs=(folder / "mine.yaml", small))
    compare.main(folder)
    (row,) = pd.read_csv(folder / "prediction.csv").itertuples()
    assert 0.005 < row.scans_se_um / row.predicted_um < 0.1
    assert abs(row.errors_off) < 4
    for name in ("Etched", "Polished"):
        assert (folder / "results" / "figures" / f"surface_sheet_{name}.png").exists()
    assert len((folder / "results" / "tables" / "scans.csv").read_text().splitlines()) == 6
