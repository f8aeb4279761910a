"""The example of devices, with small samples: it runs, and the library gives the same numbers without files."""

import csv
import json
import math
import re

import conventions
import numpy as np
import pytest
import xarray as xr
import yaml
from browser import Browser, missing, says_fraction
from conftest import ROOT, snakemake
from packed import unpacked
from test_report import STYLE, faults

import stiction
from stiction.command import main
from stiction.config.merging import merged
from stiction.report.devices.grid import Grid, GridAxis
from stiction.report.format import bounding

pytestmark = pytest.mark.slow

#: Few samples and inputs, so that a run takes a minute.
SMALL = {
    "contact": {"samples": 60, "chunks": 2, "distance_step_nm": 0.2},
    "chaos": {"order": 2},
    "design": {"beams": 200, "shares": [0.01], "chart_points": 2, "budget_beams": 20, "budget_samples": 20},
    "studies": {
        "slopes": {"samples": 20},
        "plasticity": {"strips": 2},
        "variants": {"van_der_waals": ["none"], "psd": [], "every": [], "spacing_nm": [], "poisson_ratio": []},
    },
    "devices": {
        "C1": {"humidities": [0.67], "chart": {"thicknesses_um": [2, 2.6], "humidities": [0.67, 0.95]}},
        "S1": {"humidities": [0.67, 0.9]},
    },
}


#: Tables of the run.
TABLES = {"devices", "safe_lengths", "chart", "stoppers", "budget", "life", "estimate", "estimate_of_force"}


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
    assert {path.stem for path in (results / "tables").glob("*.html")} == TABLES
    figures = {"risk", "chart", "stoppers", "life", *(f"budget_{device}" for device in ("C1", "R1", "S1"))}
    assert {path.stem for path in (results / "figures").glob("*.png")} == figures


def test_devices_in_humid_air_have_the_estimate_beside_their_run_or_why_not(run):
    pages = {
        name: (run / "results" / "devices" / f"{name}.html").read_text(encoding="utf-8") for name in ("C1", "R1", "S1")
    }
    assert [name for name, page in pages.items() if "The estimate at once beside the run" in page] == ["C1", "R1", "S1"]
    with (run / "results" / "tables" / "estimate.csv").open(encoding="utf-8", newline="") as file:
        rows = {row["device"]: row for row in csv.DictReader(file)}
    assert list(rows) == ["C1", "R1"]
    row = rows["C1"]
    assert row["refused"] == "contact.distance_step_nm was not learnt"
    assert row["refused"] in pages["C1"]
    assert float(row["run_um"]) > 0


def test_all_files_follow_the_conventions(run):
    paths = sorted((run / "results").rglob("*.nc"))
    assert len({path.parent for path in paths}) > 10
    assert {path.name: found for path in paths if (found := conventions.faults(path))} == {}


def test_every_page_states_the_run_and_the_commit_that_made_it(run):
    (record,) = json.loads((run / "results" / "provenance.json").read_text(encoding="utf-8"))
    code = f"commit {record['git']['commit'][:10]}" if record["git"] else "installed"
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
        assert min(widths) >= 600
        for width in (1440, 390):
            browser.resize(width)
            assert browser.run("return document.documentElement.scrollWidth") <= width
        assert browser.errors() == []


# Controls

#: Largest page [bytes]: a table and eleven panels of at most 16 kB, and 70 kB of controls.
LARGEST = 300_000
#: Numbers of a text of the page.
NUMBER = re.compile(r"\d[\d.]*")
#: Elements that a reader sees but cannot read or tell apart: text on its ground, controls and pictures without a name.
CONTRASTS = """
const light = colour => {
  const [r, g, b] = colour.match(/[\\d.]+/g).slice(0, 3).map(part => part / 255)
    .map(part => part <= 0.03928 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4);
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};
const ground = part => {
  for (let one = part; one; one = one.parentElement) {
    const colour = getComputedStyle(one).backgroundColor;
    if (!/, 0\\)$/.test(colour)) return colour;
  }
  return "rgb(255, 255, 255)";
};
const texts = [...document.querySelectorAll("body *")].filter(part => part.checkVisibility() &&
  !part.closest("svg, :disabled") && [...part.childNodes].some(node => node.nodeType === 3 && node.data.trim()));
return Math.min(...texts.map(part => {
  const [low, high] = [light(getComputedStyle(part).color), light(ground(part))].sort((a, b) => a - b);
  return (high + 0.05) / (low + 0.05);
}));
"""
UNNAMED = """
const named = part => part.getAttribute("aria-label") || part.labels?.length || part.textContent.trim() || part.alt;
return [...document.querySelectorAll("input, button, textarea, img, svg[role], a")].filter(part => !named(part))
  .map(part => part.outerHTML.slice(0, 80));
"""
#: Least height of text in figures and charts [pixels]: of 7 points in pictures 3 inches wide, and of SVG.
TEXT = """
const charts = [...document.querySelectorAll(".charts svg")]
  .map(svg => [svg.getScreenCTM().a, svg.querySelector("text")])
  .map(([scale, text]) => scale * parseFloat(getComputedStyle(text).fontSize));
return Math.min(...charts, ...[...document.images].map(one => one.getBoundingClientRect().width / 3 / 72 * 7));
"""
#: Share of the width that pictures take together with texts and tables beside them, of each part with pictures.
ROWS = """
const boxes = (part, those) => [...part.querySelectorAll(those)].map(one => one.getBoundingClientRect());
const width = some => Math.max(...some.map(one => one.right)) - Math.min(...some.map(one => one.left));
const whole = width(boxes(document, "main"));
return [...document.querySelectorAll(".part")].map(part => {
  const pictures = boxes(part, "img");
  const isBeside = one => pictures.some(to => one.top < to.bottom && to.top < one.bottom);
  return pictures.length ? width([...pictures, ...boxes(part, ".said p, .said table").filter(isBeside)]) / whole : 1;
});
"""
#: Share of the width that texts take outside of parts with pictures, and the widest line of text [heights of text].
LINES = """
const whole = document.querySelector("main").clientWidth;
const box = one => one.getBoundingClientRect();
const width = one => Math.max(...[...one.children].map(part => box(part).right)) - box(one).left;
const texts = [...document.querySelectorAll(".text")].filter(one => one.children.length > 1);
const alone = texts.filter(one => !one.parentElement.parentElement.querySelector("img"));
return [Math.min(1, ...alone.map(one => width(one) / whole)),
  Math.max(...texts.flatMap(one => [...one.children]).map(one => box(one).width / 15))];
"""
LEVELS = "return [...document.querySelectorAll('h1, h2, h3, h4')].map(head => Number(head.tagName[1]))"


def page_of(run, device):
    return run / "results" / "devices" / f"{device}.html"


def grid_of(run, device):
    """Grid on the page of a device, read by Python."""
    page = page_of(run, device).read_text(encoding="utf-8")
    content = json.loads(re.search(r'id="explorer-data">(.*?)</script>', page)[1])["views"][0]["grid"]
    axes = [
        GridAxis(**one | {"values": tuple(one["values"])})
        for one in (*content["axes"], content["share"], content["size"])
    ]
    arrays = {name: np.array(content[name], float) for name in ("safe", "scores", "first")}
    arrays |= {"levels": unpacked(content["levels"])}
    numbers = {name: content[name] for name in ("samples", "falls")}
    return Grid(tuple(axes[:-2]), axes[-2], axes[-1], **arrays, **numbers)


def random_state(grid, rng):
    """State within a grid, with few digits."""
    axes = (*grid.axes, grid.share, grid.size)
    state = {one.key: float(f"{rng.uniform(one.values[0], one.values[-1]):.4g}") for one in axes if one.between}
    return {one.key: float(rng.choice(one.values)) for one in axes} | state


def answers(browser):
    """Texts of the answers to the present values."""
    found = browser.run(
        "return [...document.querySelectorAll('[data-answer]')].map(p => [p.dataset.answer, p.textContent])"
    )
    return dict(found)


def numbers(text):
    """Numbers behind the colon of an answer."""
    return [float(number) for number in NUMBER.findall(text.rpartition(": ")[2])]


def rounds_safely(text, size, up):
    """Whether an answer is a size in three digits, rounded to its safe side, or says that it is not known."""
    if not math.isfinite(size):
        return "not known" in text
    # The formulas of the page differ by less than 1e-5, which can change the last digit.
    near = {float(bounding(size * (1 + error), 3, up)) for error in (-1e-5, 0, 1e-5)}
    return len(found := numbers(text)) == 1 and found[0] in near


@in_a_browser
@pytest.mark.parametrize("device", ["C1", "R1", "S1"])
def test_a_page_answers_any_state_as_python_does(run, browser, device):
    grid, rng = grid_of(run, device), np.random.default_rng(3)
    browser.open(page_of(run, device))
    for state in (random_state(grid, rng) for _ in range(50)):
        address = "&".join(f"{key}={value}" for key, value in state.items())
        browser.run("location.hash = arguments[0]; dispatchEvent(new HashChangeEvent('hashchange'))", address)
        shown = answers(browser)
        stuck = grid.stuck(state)
        assert rounds_safely(shown["safe"], grid.safe_size(state), grid.falls)
        assert says_fraction(shown["stuck"], stuck.share, (stuck.low, stuck.high), stuck.beyond)


def rows_of(run, table):
    """Rows of a table of the run about its first device, at the allowed fraction, held by whatever holds it."""
    with (run / "results" / "tables" / f"{table}.csv").open(encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["device"] == "C1" and float(row["share"]) == 0.01]
    return [row for row in rows if row["held_by"] == "beam or tip"]


@in_a_browser
def test_the_numbers_of_a_page_are_those_of_its_tables(run, browser):
    # It states one air, so that one factor leads from all simulated limits to lengths to build.
    (answer,), (own,) = rows_of(run, "devices"), rows_of(run, "safe_lengths")
    factor = float(answer["to_build"]) / float(own["safe_length_um"])
    rows = rows_of(run, "chart")
    assert len(rows) == 4
    for row in rows:
        browser.open(page_of(run, "C1"))
        state = {"thickness_um": row["thickness_um"], "gap_um": row["gap_um"], "humidity": row["relative_humidity"]}
        browser.run("location.hash = arguments[0]", "&".join(f"{key}={value}" for key, value in state.items()))
        size = factor * float(row["safe_length_um"])
        assert browser.wait(lambda size=size: rounds_safely(answers(browser)["safe"], size, up=False), 5)


@in_a_browser
@pytest.mark.parametrize("device", ["C1", "R1", "S1"])
def test_the_controls_begin_with_the_number_of_the_answer(run, browser, device):
    browser.open(page_of(run, device))
    screen, shown = browser.run("return document.querySelector('.answer').innerText"), answers(browser)
    answer = re.search(r"(?:No longer than|At least) (\S+)\s", screen)
    if not answer:
        is_unknown = "Too few simulated devices bound a size" in screen and "not known" in shown["safe"]
        assert is_unknown or shown["forbidden"] in screen
    else:
        assert float(answer[1]) == numbers(shown["safe"])[-1]
    for stuck in re.findall(
        r"(\S+ % \(.* %\)|at (?:most|least) \S+ %) stick", screen.replace("\N{NO-BREAK SPACE}", " ")
    ):
        assert shown["stuck"].endswith(stuck)


#: Paths of the curve and of the band of the first chart.
PATHS = "return ['.curve', '.band'].map(name => document.querySelector('.charts path' + name).getAttribute('d'))"


def corners(path):
    """Corners of a path of lines (n, 2)."""
    return np.array([corner.split() for corner in re.split("[ML]", path)[1:]], float)


@in_a_browser
@pytest.mark.parametrize("device", ["C1", "R1", "S1"])
def test_there_is_a_band_around_the_whole_curve(run, browser, device):
    browser.open(page_of(run, device))
    curve, band = map(corners, browser.run(PATHS))
    lower, upper = band[: len(band) // 2], band[len(band) // 2 :][::-1]
    np.testing.assert_array_equal(lower[:, 0], upper[:, 0])
    assert {*curve[:, 0]} <= {*lower[:, 0]}
    assert (upper[:, 1] <= lower[:, 1]).all(), "a higher fraction is above a lower one"


@in_a_browser
def test_keys_move_a_control_at_once_and_the_address_keeps_it(run, browser):
    browser.open(page_of(run, "C1"))
    before = answers(browser)["safe"]
    (thickness,) = browser.find("#control-thickness_um")
    end, left = "\ue010", "\ue012"
    browser.send("POST", f"/element/{thickness}/value", text=left * 12)
    (moved,) = browser.run("return [document.querySelector('#control-thickness_um').ariaValueText]")
    assert moved not in ("2 µm", "2.6 µm")
    assert answers(browser)["safe"] != before
    shown, address = answers(browser), browser.run("return location.href")
    browser.send("POST", f"/element/{thickness}/value", text=end)
    assert answers(browser)["safe"] == before
    browser.send("POST", "/url", url="about:blank")
    browser.send("POST", "/url", url=address)
    assert answers(browser) == shown
    times = browser.run(
        """const range = document.querySelector("#control-length_um"), found = [];
        for (let k = 0; k < 20; k++) {
          const start = performance.now();
          range.value = 20 * k;
          range.dispatchEvent(new Event("input"));
          document.body.getBoundingClientRect();
          found.push(performance.now() - start);
        }
        return found"""
    )
    assert np.median(times) < 100
    assert browser.errors() == []


@in_a_browser
def test_values_that_were_not_computed_are_not_answered_and_the_page_says_why(run, browser):
    browser.open(page_of(run, "C1"))
    grid = grid_of(run, "C1")
    (number,) = browser.find("#control-humidity + input")
    control, a, none, enter = "\ue009", "a", "\ue000", "\ue007"
    browser.send("POST", f"/element/{number}/value", text=f"{control}{a}{none}0.99{enter}")
    assert browser.run("return document.querySelector('#control-humidity').ariaValueText") == "0.95"
    said = "return document.querySelector('#control-humidity').closest('.control').querySelector('.note').textContent"
    assert browser.run(said) == f"0.99 is not shown: {grid.axes[0].reason}."
    assert "computed from 0.67 to 0.95" in grid.axes[0].reason
    assert browser.run("return document.querySelector('#control-gap_um').disabled")
    assert browser.run(said.replace("humidity", "gap_um")) == f"Fixed: {grid.axes[2].reason}."


@in_a_browser
@pytest.mark.parametrize("device", ["C1", "R1", "S1"])
def test_the_study_of_a_page_is_one_that_a_run_takes(run, browser, tmp_path, device, capsys):
    browser.open(page_of(run, device))
    state = random_state(grid_of(run, device), np.random.default_rng(1))
    browser.run("location.hash = arguments[0]", "&".join(f"{key}={value}" for key, value in state.items()))
    browser.wait(lambda: str(state["share"]) in browser.run("return location.hash"), 2)
    (button,) = browser.find("#explorer button:first-of-type")
    browser.click(button)
    text = browser.run("return document.querySelector('#explorer textarea').value")
    (tmp_path / "mine.yaml").write_text(text, encoding="utf-8")
    assert main.main(["check", str(tmp_path / "mine.yaml")]) == main.Status.DONE, capsys.readouterr()
    config = stiction.load(tmp_path / "mine.yaml")
    (section,) = config["devices"].values()
    assert section["humidities"] == [state["humidity"]]
    assert all(section[key] == pytest.approx(state[key]) for key in section.keys() & state.keys())
    assert config["contact"]["samples"] == SMALL["contact"]["samples"]


@in_a_browser
def test_a_page_with_two_views_keeps_the_chosen_one_in_its_address(run, browser, tmp_path):
    def doubled(found):
        content = json.loads(found[2])
        content["views"].append(content["views"][0] | {"title": "again"})
        return f"{found[1]}{json.dumps(content)}{found[3]}"

    text = page_of(run, "S1").read_text(encoding="utf-8")
    text, count = re.subn(r'(id="explorer-data">)(.*?)(</script>)', doubled, text)
    (tmp_path / "page.html").write_text(text, encoding="utf-8")
    browser.open(tmp_path / "page.html")
    assert count == 1
    assert browser.run("return [...document.querySelector('#views').options].map(one => one.text)") == [
        "humidity",
        "again",
    ]
    (menu,) = browser.find("#views")
    browser.send("POST", f"/element/{menu}/value", text="again")
    assert "view=1" in browser.run("return location.hash")
    shown, address = answers(browser), browser.run("return location.href")
    browser.send("POST", "/url", url="about:blank")
    browser.send("POST", "/url", url=address)
    assert browser.run("return document.querySelector('#views').value") == "1"
    assert answers(browser) == shown
    assert browser.errors() == []


@in_a_browser
def test_a_reader_without_scripts_has_the_whole_answer_and_no_empty_controls(run, browser, tmp_path):
    text = page_of(run, "C1").read_text(encoding="utf-8")
    (tmp_path / "page.html").write_text(
        text.replace("script-src 'sha256-", "script-src 'sha256-AAAA"), encoding="utf-8"
    )
    browser.open(tmp_path / "page.html")
    assert "Content Security Policy" in "".join(browser.errors()), "no other script runs"
    assert not browser.run("return document.querySelector('#explore').checkVisibility()")
    assert "No longer than" in browser.run("return document.querySelector('.answer').innerText")


@in_a_browser
@pytest.mark.parametrize("device", ["C1", "R1", "S1"])
def test_a_page_is_one_small_file_that_everyone_can_use(run, browser, device):
    path = page_of(run, device)
    assert path.stat().st_size < LARGEST
    browser.open(path)
    for width in (1440, 768, 390):
        browser.resize(width)
        assert browser.run("return document.documentElement.scrollWidth") <= width
        assert browser.run("return document.querySelector('#explorer').getBoundingClientRect().width") > 0.85 * width
        assert browser.run(TEXT) >= 11
        assert min(browser.run(ROWS)) > 0.85
        filled, longest = browser.run(LINES)
        assert filled > 0.85
        assert longest < 52, "a line of 105 characters"
    assert (
        browser.run("return performance.getEntriesByType('resource').filter(one => !one.name.startsWith('data:'))")
        == []
    )
    assert browser.run(UNNAMED) == []
    assert browser.run(CONTRASTS) >= 4.5
    assert browser.run("return document.documentElement.lang") == "en"
    levels = browser.run(LEVELS)
    assert levels[0] == 1
    assert max(np.diff(levels)) <= 1
    assert browser.errors() == []


@in_a_browser
@pytest.mark.parametrize(
    "page", ["devices/C1", "devices/R1", "devices/S1", "index", *(f"tables/{one}" for one in sorted(TABLES))]
)
def test_a_checker_of_accessibility_finds_nothing_on_a_page(run, browser, page):
    pytest.importorskip("axe_core_python")
    browser.open(run / "results" / f"{page}.html")
    browser.run("document.querySelectorAll('details').forEach(part => { part.open = true })")
    for width in (1440, 390):
        browser.resize(width)
        assert browser.violations() == []
        assert browser.run("return document.documentElement.scrollWidth") <= width


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
