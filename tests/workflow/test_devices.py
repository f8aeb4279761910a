"""The example of devices, with small samples: it runs, and the library gives the same numbers without files."""

import json
import re

import pytest
import xarray as xr
import yaml
from browser import Browser, missing
from conftest import ROOT, snakemake
from test_report import STYLE, faults

import stiction
from stiction.config.merging import merged

pytestmark = pytest.mark.slow

#: Few samples and inputs, so that a run takes a minute.
SMALL = {
    "contact": {"samples": 60, "chunks": 2, "distance_step_nm": 0.2},
    "chaos": {"order": 2},
    "design": {"beams": 200, "shares": [0.01], "chart_points": 2, "budget_beams": 20},
    "studies": {
        "slopes": {"samples": 20},
        "plasticity": {"strips": 2},
        "variants": {"van_der_waals": ["none"], "psd": [], "every": [], "spacing_nm": [], "poisson_ratio": []},
    },
    "devices": {
        "C1": {"humidities": [0.67], "chart": {"thicknesses_um": [2.6]}},
        "S1": {"humidities": [0.67, 0.9]},
    },
}


def in_a_browser(test):
    """Test that needs a browser."""
    return pytest.mark.browser(pytest.mark.skipif(bool(missing()), reason=missing())(test))


def example():
    """The example with small samples; only its first device has uncertain surfaces."""
    config = merged(yaml.safe_load((ROOT / "examples" / "devices.yaml").read_text(encoding="utf-8")), SMALL)
    for name, kept in {"R1": ["residual_stress_MPa"], "S1": ["humidity", "young_modulus_GPa"]}.items():
        stated = config["devices"][name]["uncertainty"]
        config["devices"][name]["uncertainty"] = {key: stated[key] for key in kept}
    return config


@pytest.fixture(scope="module")
def run(shared):
    """Folder of a finished run of the example."""

    def fill(folder):
        path = folder / "example.yaml"
        path.write_text(yaml.safe_dump(example()))
        snakemake(folder, "devices", configs=[path])

    return shared("devices", fill)


def test_every_device_has_a_page_and_every_table_and_figure_is_there(run):
    results = run / "results"
    assert {path.stem for path in (results / "devices").glob("*.html")} == {"C1", "R1", "S1"}
    tables = {"safe_lengths", "chart", "stoppers", "budget", "life"}
    assert {path.stem for path in (results / "tables").glob("*.html")} == tables
    figures = {"risk", "chart", "stoppers", "life", *(f"budget_{device}" for device in ("C1", "R1", "S1"))}
    assert {path.stem for path in (results / "figures").glob("*.png")} == figures


def test_every_page_states_the_run_and_the_commit_that_made_it(run):
    (record,) = json.loads((run / "results" / "provenance.json").read_text(encoding="utf-8"))
    code = f"commit {record['git']['commit']}" if record["git"] else "installed"
    for path in (run / "results" / "devices").glob("*.html"):
        page = path.read_text(encoding="utf-8")
        assert f"Made by the run of {record['started'][:10]}" in page
        assert code in page


def test_warnings_of_all_devices_are_listed_and_the_plasticity_of_their_pair_is_checked(run):
    text = (run / "results" / "devices" / "warnings.md").read_text(encoding="utf-8")
    assert "R1, RH 0.67, held by the middle: The gap is equal to the thickness" in text
    assert "was not checked" not in text
    assert "Not in the model" in text


def test_the_library_gives_the_same_forces_and_budget_as_the_workflow(run):
    stopper = stiction.Device.of(stiction.load(example()), "S1")
    for path, found in (("stoppers/S1", stopper.forces()), ("budget/S1_rh090", stopper.budget(0.9))):
        with xr.open_dataset(run / "results" / "devices" / f"{path}.nc") as dataset:
            xr.testing.assert_equal(dataset.load(), found)


@in_a_browser
def test_the_report_shows_every_page_table_and_figure(run, tmp_path):
    report, results = tmp_path / "report.html", run / "results"
    asked = "devices", "--report", report, "--report-stylesheet", STYLE
    assert "ERROR" not in snakemake(run, *asked, configs=[run / "example.yaml"]).stdout
    made = [*results.glob("devices/*.html"), *results.glob("tables/*.html"), *results.glob("figures/*.png")]
    with Browser() as browser:
        browser.open(report)
        shown = set(browser.run("return Object.keys(results)"))
        assert shown == {f"results/{path.relative_to(results)}" for path in made}
        assert faults(browser, report) == []


@in_a_browser
@pytest.mark.parametrize("device", ["C1", "R1", "S1"])
def test_a_browser_shows_the_answer_and_the_figures_of_a_page(run, device):
    path = run / "results" / "devices" / f"{device}.html"
    with Browser() as browser:
        browser.open(path)
        assert browser.run("return document.querySelector('h1').innerText").startswith(f"{device}: ")
        assert "0.67" in browser.run("return document.querySelector('.answer').innerText")
        browser.resize(1440)
        assert browser.run("return document.querySelector('.answer').getBoundingClientRect().bottom") < 900
        widths = browser.run("return [...document.images].map(picture => picture.naturalWidth)")
        assert len(widths) == len(re.findall("<img", path.read_text(encoding="utf-8"))) >= 2
        assert min(widths) > 600
        for width in (1440, 390):
            browser.resize(width)
            assert browser.run("return document.documentElement.scrollWidth") <= width
        assert browser.errors() == []


@in_a_browser
def test_a_browser_shows_the_index_at_every_width(run):
    path = run / "results" / "index.html"
    with Browser() as browser:
        browser.open(path)
        assert browser.run("return document.querySelector('h1').innerText").startswith("Results of ")
        for width in (1440, 768, 390):
            browser.resize(width)
            assert browser.run("return document.documentElement.scrollWidth") <= width
        browser.run("document.querySelectorAll('img').forEach(picture => { picture.loading = 'eager' })")
        pictures = "return Promise.all([...document.images].map(picture => picture.decode().then(() => true)))"
        assert all(browser.run(pictures))
        assert browser.errors() == []
