"""Devices from the configuration to tables, figures and warnings, with small samples."""

import csv

import pytest
from conftest import snakemake
from numpy.testing import assert_allclose, assert_array_equal

from stiction.config.files import load
from stiction.device import Device
from stiction.run import storage

MINE = """
design: {beams: 200, chart_points: 2, shares: [1.0e-2, 1.0e-3]}
devices:
  C1: {kind: cantilever, pair: b, thickness_um: 2.6, gap_um: 20, width_um: 30, humidities: [0.88],
       chart: {thicknesses_um: [2.6], humidities: [0.88, 0.92]}}
  R1: {kind: bridge, pair: b, thickness_um: 2, gap_um: 1, width_um: 6, residual_stress_MPa: 50, humidities: [0.88]}
"""


@pytest.fixture(scope="module")
def finished(shared, tiny):
    """Folder of a finished run of two devices, and its configuration files."""

    def fill(folder):
        (folder / "mine.yaml").write_text(MINE)
        snakemake(folder, "devices", configs=[tiny, folder / "mine.yaml"])

    folder = shared("beam_devices", fill)
    return folder, [tiny, folder / "mine.yaml"]


@pytest.mark.slow
def test_a_run_gives_table_figures_and_warnings(finished):
    results = finished[0] / "results"
    with (results / "tables" / "safe_lengths.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [(row["device"], row["held_by"], row["share"]) for row in rows] == [
        ("C1", "beam", "0.01"),
        ("C1", "beam", "0.001"),
        ("C1", "beam or tip", "0.01"),
        ("C1", "beam or tip", "0.001"),
        ("R1", "middle", "0.01"),
        ("R1", "middle", "0.001"),
    ]
    assert all(float(row["safe_length_um"]) < float(row["estimate_um"]) for row in rows)
    assert "Not in the model" in (results / "devices" / "warnings.md").read_text()
    assert not (results / "warnings.md").exists()  # of the pairs that run
    for name in ("risk", "chart"):
        assert (results / "figures" / f"{name}.pdf").stat().st_size > 5000


@pytest.mark.slow
def test_the_table_of_a_chart_has_the_numbers_of_its_datasets(finished):
    results = finished[0] / "results"
    with (results / "tables" / "chart.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if row["relative_humidity"] == "0.92"]
    chart = storage.load(results / "devices" / "chart" / "C1_rh092.nc", "chart")
    assert [(row["held_by"], row["share"], row["from"]) for row in rows] == [
        (held, share, "finite elements") for held in ("beam", "beam or tip") for share in ("0.01", "0.001")
    ]
    assert_allclose([float(row["safe_length_um"]) for row in rows], 1e6 * chart.safe_length.values.ravel(), rtol=1e-9)


@pytest.mark.slow
def test_python_gives_the_numbers_of_the_workflow(finished):
    folder, files = finished
    for name in ("C1", "R1"):
        device = Device.of(load(*files), name)
        stored = storage.load(folder / f"results/devices/safe_lengths/{name}_rh088.nc", "safe_lengths")
        found = device.safe_lengths(0.88)
        for variable in ("safe_length", "estimate", "beams_error", "surfaces_error", "stuck", "basis"):
            assert_array_equal(found[variable], stored[variable])
        if name == "C1":
            chart = storage.load(folder / "results/devices/chart/C1_rh088.nc", "chart")
            assert_array_equal(chart.safe_length[0, 0], stored.safe_length)


@pytest.mark.slow
def test_a_device_uses_the_strips_of_its_pair_where_they_are_equal(finished):
    own = {path.name for path in (finished[0] / "results" / "devices" / "contact").rglob("*.nc")}
    assert own == {"b_500x6000.nc", "b_870x30000.nc"}


@pytest.mark.slow
def test_a_log_of_beams_shows_their_progress(finished):
    assert "beams: 100%" in (finished[0] / "results" / "logs" / "devices" / "cracks" / "C1_rh088.log").read_text()


@pytest.mark.slow
def test_a_second_run_has_nothing_to_do(finished):
    assert "Nothing to be done" in snakemake(finished[0], "-n", "devices", configs=finished[1]).stdout
