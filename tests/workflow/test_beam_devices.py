"""Devices from the configuration to tables, figures, pages and warnings, with small samples and _ and - in names."""

import csv
import re
from urllib.parse import unquote

import conventions
import pytest
from conftest import snakemake
from numpy.testing import assert_allclose, assert_array_equal

from stiction.config.files import load
from stiction.device import Device
from stiction.run import storage

MINE = """
design: {beams: 200, chart_points: 2, shares: [1.0e-2, 1.0e-3]}
surfaces:
  B_2: {rms_nm: 3.4, skewness: -0.76, kurtosis: 3.9, psd: published,
        published_psd: {plateau_nm4: 525, floor_nm4: 0.8, corner_rad_per_um: 32, cutoff_rad_per_um: 138}}
pairs: {my-pair_2: {beam: B_2, substrate: Sub1, gap_um: 20, humidities: [0.88]}}
devices:
  C_1-b: {kind: cantilever, pair: my-pair_2, thickness_um: 2.6, gap_um: 20, width_um: 30, humidities: [0.88],
       chart: {thicknesses_um: [2.6], humidities: [0.88, 0.92]}}
  R-1_b: {kind: bridge, pair: my-pair_2, thickness_um: 2, gap_um: 1, width_um: 6, residual_stress_MPa: 50,
          humidities: [0.88]}
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
        ("C_1-b", "beam", "0.01"),
        ("C_1-b", "beam", "0.001"),
        ("C_1-b", "beam or tip", "0.01"),
        ("C_1-b", "beam or tip", "0.001"),
        ("R-1_b", "middle", "0.01"),
        ("R-1_b", "middle", "0.001"),
    ]
    assert all(float(row["safe_length_um"]) < float(row["estimate_um"]) for row in rows)
    assert "Not in the model" in (results / "devices" / "warnings.md").read_text()
    assert not (results / "warnings.md").exists()  # of the pairs that run
    for name in ("risk", "chart"):
        assert (results / "figures" / f"{name}.pdf").stat().st_size > 5000


@pytest.mark.slow
def test_all_files_follow_the_conventions(finished):
    paths = sorted((finished[0] / "results").rglob("*.nc"))
    assert len(paths) > 10
    assert {path.name: found for path in paths if (found := conventions.faults(path))} == {}


@pytest.mark.slow
def test_every_link_of_the_index_leads_to_a_file(finished):
    results = finished[0] / "results"
    links = {*re.findall(r'(?:href|src)="([^"#]+)"', (results / "index.html").read_text(encoding="utf-8"))}
    assert links >= {"devices/C_1-b.html", "devices/R-1_b.html", "tables/safe_lengths.html", "figures/risk.png"}
    assert [link for link in links if not (results / unquote(link)).exists()] == []
    for name in ("C_1-b", "R-1_b"):
        assert f"<h1>{name}: " in (results / "devices" / f"{name}.html").read_text(encoding="utf-8")


@pytest.mark.slow
def test_the_table_of_a_chart_has_the_numbers_of_its_datasets(finished):
    results = finished[0] / "results"
    with (results / "tables" / "chart.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if row["relative_humidity"] == "0.92"]
    chart = storage.load(results / "devices" / "chart" / "C_1-b_rh092.nc", "chart")
    assert [(row["held_by"], row["share"], row["from"]) for row in rows] == [
        (held, share, "finite elements") for held in ("beam", "beam or tip") for share in ("0.01", "0.001")
    ]
    assert_allclose([float(row["safe_length_um"]) for row in rows], 1e6 * chart.safe_length.values.ravel(), rtol=1e-9)


@pytest.mark.slow
def test_python_gives_the_numbers_of_the_workflow(finished):
    folder, files = finished
    for name in ("C_1-b", "R-1_b"):
        device = Device.of(load(*files), name)
        stored = storage.load(folder / f"results/devices/safe_lengths/{name}_rh088.nc", "safe_lengths")
        found = device.safe_lengths(0.88)
        for variable in ("safe_length", "estimate", "beams_error", "surfaces_error", "stuck", "basis"):
            assert_array_equal(found[variable], stored[variable])
        if name == "C_1-b":
            chart = storage.load(folder / "results/devices/chart/C_1-b_rh088.nc", "chart")
            assert_array_equal(chart.safe_length[0, 0], stored.safe_length)


@pytest.mark.slow
def test_a_device_uses_the_strips_of_its_pair_where_they_are_equal(finished):
    own = {path.name for path in (finished[0] / "results" / "devices" / "contact").rglob("*.nc")}
    assert own == {"my-pair_2_500x6000.nc", "my-pair_2_960x30000.nc"}


@pytest.mark.slow
def test_a_log_of_beams_shows_their_progress(finished):
    assert "beams: 100%" in (finished[0] / "results" / "logs" / "devices" / "cracks" / "C_1-b_rh088.log").read_text()


@pytest.mark.slow
def test_a_second_run_has_nothing_to_do(finished):
    assert "Nothing to be done" in snakemake(finished[0], "-n", "devices", configs=finished[1]).stdout
