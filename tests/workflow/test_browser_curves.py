"""Curves of a page in a browser: any state as in Python, nothing beyond the points, studies that a run takes."""

import re

import numpy as np
import pandas as pd
import pytest
import yaml
from browser import missing, says_fraction
from drawn_curves import BEAM, OXIDE, STOPPER, biased, etched, mapped, rough

import stiction
from stiction.command import main
from stiction.config.merging import differing
from stiction.config.reading import paper
from stiction.devices.risk import SCORES
from stiction.report.devices import curve_views, explorer, voltage_views
from stiction.report.devices.grid import Grid, GridAxis
from stiction.report.devices.levels import counted
from stiction.report.format import bounding
from stiction.report.page import Page, Summary

pytestmark = [
    pytest.mark.slow,
    pytest.mark.browser,
    pytest.mark.skipif(bool(missing()), reason=missing()),
]

NUMBER = re.compile(r"-?\d[\d.]*(?:e[+-]?\d+)?")
STUDY = {
    "process": {
        "etch": {
            "variable": "etch_time_s",
            "surface": "B2",
            "settings": [
                {"value": value, "rms_nm": rms, "uncertainty": {"rms_nm": 0.05}} for value, rms in ((30, 2), (120, 5))
            ],
        }
    }
}


@pytest.fixture(scope="module")
def views():
    return {
        "process": curve_views.process_view("D", STOPPER, *etched()),
        "beam": curve_views.process_view("D", BEAM, *etched(is_beam=True, unknown=(60.0,))),
        "map": curve_views.map_view("D", STOPPER, *mapped()),
        "roughness": curve_views.roughness_view("D", STOPPER, rough(others=(-0.5, 0.0, 0.5))),
        "voltage": voltage_views.stopper_view("D", STOPPER | OXIDE, biased()),
        "of_beam": curve_views.roughness_view("D", BEAM, rough(is_beam=True, unknown=(2,))),
    }


@pytest.fixture(scope="module")
def page(views, tmp_path_factory):
    """Page with all these views, and a study with a process."""
    section = STOPPER | OXIDE | {"process": "etch"}
    study = differing(stiction.load(STUDY, {"devices": {"D": section}}), paper())
    content = explorer.content("D", section, list(views.values()))
    content["study"] = {key: value for key, value in study.items() if key != "devices"}
    path = tmp_path_factory.mktemp("page") / "D.html"
    path.write_text(Page("D: stopper", {}, ["It is safe."], explorer=content).html, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def forbidden(views, tmp_path_factory):
    """Page with all these views and a warning in the place of its number."""
    content = explorer.content("D", STOPPER, list(views.values())) | {"study": {}}
    cells = pd.DataFrame({"RH": ["0.6"], "force [µN]": ["–"]})
    summary = Summary("bad", "Do not rely on a number", "It is plastic.", (), {}, cells, is_forbidden=True)
    path = tmp_path_factory.mktemp("forbidden") / "D.html"
    page = Page("D: stopper", {}, ["It is safe up to 5 µm."], explorer=content, summary=summary)
    path.write_text(page.html, encoding="utf-8")
    return path


def test_a_warning_that_forbids_a_number_stands_in_the_place_of_all_answers(views, forbidden, browser):
    browser.open(forbidden)
    for number, view in enumerate(views.values()):
        assert go_to(browser, number, view.grid.start) == {"forbidden": "Do not rely on a number: It is plastic."}
        assert browser.run("return document.querySelectorAll('.charts svg').length") == 0
        assert browser.run("return document.querySelectorAll('.control').length") >= 3
    assert browser.errors() == []


def test_a_small_chart_has_the_noise_of_its_curve_as_a_band(browser, tmp_path):
    humidities, noisy = np.linspace(0.4, 0.8, 9), 300 * (1 + 0.02 * np.random.default_rng(6).normal(size=(9, 1)))
    axes = (explorer.humidity_axis(humidities, 0.8, "humidities", True),)
    grid = Grid(
        axes,
        explorer.share_axis([0.01], 0.01, ""),
        GridAxis("length_um", "length", "µm", "linear", (100, 400), 200, True, ""),
        noisy,
        counted(noisy * np.exp(0.1 * SCORES), 400),
        400,
        False,
    )
    view = explorer.View("air", grid, {"safe": "Safe length", "stick": "Stuck", "bound": "safe"})
    path = tmp_path / "D.html"
    path.write_text(Page("D", {}, ["Yes."], explorer=explorer.content("D", BEAM, [view])).html, encoding="utf-8")
    browser.open(path)
    chart = "[...document.querySelectorAll('.charts svg')].at(-1)"
    paths = f"return [...{chart}.querySelectorAll('path')].map(one => one.getAttribute('d'))"
    band, curve = (np.array(re.findall(r"[ML]\S+ ([^ML]+)", one), float) for one in browser.run(paths))
    ground = browser.run(f"return Number({chart}.querySelector('line').getAttribute('y1'))")
    heights = ground - curve
    noise = grid.noise_at(grid.start)
    assert noise > 0.01
    assert ground - band[: len(curve)] == pytest.approx((1 - noise) * heights, abs=0.2)
    assert ground - band[len(curve) :][::-1] == pytest.approx((1 + noise) * heights, abs=0.2)
    captions = browser.run("return [...document.querySelectorAll('.charts figcaption')].map(one => one.textContent)")
    assert f"± {100 * noise:.2g} %" in captions[-1]


def go_to(browser, number, state):
    """Answers on the page to a state of a view."""
    address = "&".join([f"view={number}", *(f"{key}={value}" for key, value in state.items())])
    browser.run("location.hash = arguments[0]; dispatchEvent(new HashChangeEvent('hashchange'))", address)
    found = "return [...document.querySelectorAll('[data-answer]')].map(p => [p.dataset.answer, p.textContent])"
    return dict(browser.run(found))


def numbers(text):
    """Numbers behind the last colon of an answer."""
    return [float(number) for number in NUMBER.findall(text.rpartition(": ")[2])]


def random_state(grid, rng):
    """State with few digits, in one of three cases at a computed value."""
    quantity, *choices = grid.axes
    value = float(f"{rng.uniform(quantity.values[0], quantity.values[-1]):.4g}")
    if rng.random() < 1 / 3:
        value = next(one for one in rng.permutation(quantity.values) if float(f"{one:.4g}") == one)
    return grid.start | {quantity.key: float(value)} | {axis.key: float(rng.choice(axis.values)) for axis in choices}


@pytest.mark.parametrize("name", ["process", "beam", "map", "roughness", "of_beam"])
def test_a_page_answers_any_state_as_python_does(views, page, browser, name):
    grid, rng, unknown = views[name].grid, np.random.default_rng(3), 0
    browser.open(page)
    for state in (random_state(grid, rng) for _ in range(50)):
        shown, found = go_to(browser, list(views).index(name), state), grid.at(state)
        assert ("suffices" in shown["enough"]) == grid.suffices(state)
        if np.isnan(found["margin"]):
            unknown += 1
            assert all("not computed here" in shown[one] for one in ("size", "margin"))
            continue
        sizes = [*grid.sizes(state)]
        if "safe" in found:
            safe = grid.size.start * np.exp((-1 if grid.falls else 1) * found["safe"])
            sizes.append(float(bounding(float(f"{safe:.6g}"), 3, up=grid.falls)))
        assert numbers(shown["size"])[: len(sizes)] == pytest.approx(sizes, rel=1e-3)
        reach = 1.959964 * found["error"]
        margins = [found["margin"] + part for part in (0, -reach, reach)]
        assert numbers(shown["margin"]) == pytest.approx(margins, rel=1e-3, abs=1e-5)
        assert says_fraction(shown["stuck"], found["stuck"], (found["low"], found["high"]))
    assert (unknown > 0) == (name in ("beam", "of_beam"))
    assert browser.errors() == []


def test_a_page_answers_any_voltage_as_python_does(views, page, browser):
    grid, rng = views["voltage"].grid, np.random.default_rng(3)
    browser.open(page)
    for _ in range(50):
        state = grid.start | {"voltage_V": float(f"{rng.uniform(*grid.size.values):.4g}")}
        state |= {"humidity": float(rng.choice(grid.axes[0].values))}
        shown, stuck = go_to(browser, list(views).index("voltage"), state), grid.stuck(state)
        assert says_fraction(shown["stuck"], stuck.share, (stuck.low, stuck.high), stuck.beyond)
        safe = grid.safe_size(state)
        assert ("none: too few" in shown["safe"]) == np.isnan(safe)
        if np.isfinite(safe):
            assert numbers(shown["safe"]) == pytest.approx([safe], rel=1e-3)
    assert browser.errors() == []


def test_settings_beyond_the_process_are_not_answered_and_the_page_says_why(page, browser):
    browser.open(page)
    go_to(browser, 0, {"etch_time_s": 75})
    (number,) = browser.find("#control-etch_time_s + input")
    control, none, enter = "\ue009", "\ue000", "\ue007"
    browser.send("POST", f"/element/{number}/value", text=f"{control}a{none}130{enter}")
    said = (
        "return document.querySelector('#control-etch_time_s').closest('.control').querySelector('.note').textContent"
    )
    assert browser.run(said) == (
        "130 is not shown: the process is measured from 30 to 120 s; process.etch.settings changes this."
    )
    assert browser.run("return document.querySelector('#control-etch_time_s').ariaValueText") == "120 s"
    assert browser.run("return document.querySelector('#control-force').disabled")
    assert "etch_time_s=120" in browser.run("return location.href")


@pytest.mark.parametrize("name", ["process", "map", "roughness"])
def test_the_ranges_that_suffice_and_the_required_value_are_marked(views, page, browser, name):
    browser.open(page)
    grid = views[name].grid
    start = grid.start | ({"humidity": 0.6, "rms_nm": 8} if name == "roughness" else {})
    go_to(browser, list(views).index(name), start)
    count = "return document.querySelectorAll(arguments[0]).length"
    assert browser.run(count, ".charts figure") == 2
    assert browser.run(count, ".charts rect.enough") == 2 * len(grid._selection(grid.ranges, start))
    assert browser.run(count, ".charts line.safe") == 1
    assert browser.run(count, ".charts circle.best") == (name == "process")
    for width in (1440, 768, 390):
        browser.resize(width)
        assert browser.run("return document.documentElement.scrollWidth") <= width
    assert browser.errors() == []


def test_a_checker_of_accessibility_finds_nothing_on_a_curve_but_a_control_without_a_name(views, page, browser):
    pytest.importorskip("axe_core_python")
    browser.open(page)
    for number, view in enumerate(views.values()):
        go_to(browser, number, view.grid.start)
        assert browser.violations() == []
    browser.run("document.querySelector('.control label').remove()")
    assert [rule for rule, *_ in browser.violations()] == ["label"]


def test_a_finger_moves_a_control_and_takes_it_back(views, page, browser):
    browser.resize(390, 844)
    browser.open(page)
    grid = views["process"].grid
    go_to(browser, list(views).index("process"), grid.start)
    (control,), (back,) = browser.find("#control-etch_time_s"), browser.find("#explorer button:nth-of-type(2)")
    value = "return parseFloat(document.querySelector('#control-etch_time_s').ariaValueText)"
    answer = "return document.querySelector('[data-answer=enough]').textContent"
    before = browser.run(answer)
    browser.touch(control, 0.5, 0.9)
    assert browser.run(value) > grid.start["etch_time_s"]
    assert browser.run(answer) != before
    browser.click(back)
    assert browser.wait(lambda: browser.run(answer) == before, 2)
    browser.resize(1440)


@pytest.mark.parametrize("name", ["process", "roughness", "voltage"])
def test_the_study_of_a_curve_is_one_that_a_run_takes(views, page, browser, tmp_path, capsys, name):
    browser.open(page)
    state = (
        views[name].grid.start
        | {"humidity": 0.6}
        | {"process": {"etch_time_s": 75.5}, "roughness": {"rms_nm": 6.25}, "voltage": {"voltage_V": 2.5}}[name]
    )
    go_to(browser, list(views).index(name), state)
    (button,) = browser.find("#explorer button:first-of-type")
    browser.click(button)
    text = browser.run("return document.querySelector('#explorer textarea').value")
    note = browser.run("return document.querySelector('.controls > .note').textContent")
    (tmp_path / "mine.yaml").write_text(text, encoding="utf-8")
    assert main.main(["check", str(tmp_path / "mine.yaml")]) == main.Status.DONE, capsys.readouterr()
    config = stiction.load(tmp_path / "mine.yaml")
    assert config["devices"]["D"]["humidities"] == [0.6]
    assert config["process"]["etch"]["settings"] == STUDY["process"]["etch"]["settings"]
    if name == "roughness":
        assert config["surfaces"]["B2"]["rms_nm"] == 6.25
    elif name == "voltage":
        assert config["devices"]["D"]["voltage_V"] == 2.5
    else:
        assert yaml.safe_load(text).get("surfaces", {}).get("B2") is None
        assert 'stiction.Process.of(stiction.load("mine.yaml"), "etch").at(75.5) in Python' in note
        assert stiction.Process.of(config, "etch").at(75.5).estimate.shape == (1,)
