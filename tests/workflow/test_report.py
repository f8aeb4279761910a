"""The report in a browser: every category opens and shows every figure and table, without an error in the console."""

import json
import re

import pytest
from browser import missing
from conftest import ROOT, copied, snakemake

from stiction.command.front_page import FRONT, front_page

pytestmark = [pytest.mark.slow, pytest.mark.browser, pytest.mark.skipif(bool(missing()), reason=missing())]

STYLE = ROOT / "workflow" / "report" / "style.css"
#: Width of the open picture, if its upper edge can be seen.
PIXELS = """
const pictures = [...document.querySelectorAll('img[src^="data:image/png"]')];
const whole = pictures.filter(picture => picture.getBoundingClientRect().top >= 0);
return whole.reduce((sum, picture) => sum + picture.naturalWidth, 0);
"""
#: Kind of every result, and results of every category.
KINDS = "return [Object.fromEntries(Object.entries(results).map(([path, of]) => [path, of.mime_type])), categories]"
#: Number of rows of the table in a frame.
ROWS = "return document.querySelectorAll('table tr').length"


#: Whether an open table is wider than its frame, and the lines of its tallest cell, apart from heads.
WIDTH = "const table = document.querySelector('.table'); return table.scrollWidth - table.clientWidth"
LINES = "return Math.max(...[...document.querySelectorAll('td')].map(cell => cell.getClientRects()[0].height)) / 17"


@pytest.fixture(scope="module")
def report(smoke, tmp_path_factory):
    """Report of the smoke run, with its front page."""
    run = copied(smoke, tmp_path_factory.mktemp("report") / "run")
    (run / FRONT).write_text(front_page(run / "results"), encoding="utf-8")
    options = ["--report-stylesheet", STYLE, "--report-metadata", STYLE.with_name("guide.yaml")]
    printed = snakemake(run, "--report", "results/report.html", *options).stdout
    assert "Warning" not in printed
    assert "ERROR" not in printed, "in a caption"
    return run / "results" / "report.html"


def faults(browser, report):
    """What a reader of a report does not see, and the errors in the console; opens every result of every category."""
    browser.open(report)
    browser.errors()
    kinds, categories = browser.run(KINDS)
    found = []
    for category, parts in categories.items():
        hidden = {path for paths in parts.values() for path in paths}
        browser.open(report)
        browser.click(entry(browser, category))
        browser.wait(lambda: buttons(browser), 5)
        for k in range(len(buttons(browser))):
            path = browser.wait(lambda k=k, unseen=hidden: clicked(browser, k, unseen))
            kind = kinds.get(path)
            if browser.wait(lambda kind=kind: opened(browser, kind)):
                hidden.discard(path)
        found += [f"{category} does not show {path}" for path in sorted(hidden)]
    return found + browser.errors()


def buttons(browser):
    """The button of each listed result that opens it."""
    return browser.find("#app tbody tr a:first-of-type")


def clicked(browser, k, unseen):
    """Path of the result that opens by a click on a button. A list that is drawn anew loses a click."""
    browser.click(buttons(browser)[k])
    return browser.wait(lambda: opening(browser, unseen), 5)


def opening(browser, unseen):
    """Path of the result that opens, if it was not seen before."""
    path = browser.run("return app.state.resultPath")
    return path if path in unseen else None


def opened(browser, kind):
    """Whether the open result has pixels or rows."""
    if kind == "image/png":
        return browser.run(PIXELS)
    return browser.find("iframe") and browser.inside("iframe", ROWS)


def test_every_category_opens_and_shows_its_figures_and_tables(browser, report):
    results = report.parent
    made = [*results.glob("figures/*.png"), *results.glob("tables/*.html")]
    browser.open(report)
    assert set(browser.run("return Object.keys(results)")) == {f"results/{path.relative_to(results)}" for path in made}
    assert faults(browser, report) == []


def shown(browser, report, width):
    """Open the report on a screen of some width; its front page, once it is there."""
    browser.resize(width)
    browser.open(report)
    (page,) = browser.wait(lambda: browser.find("#app .prose"))
    return page


def entry(browser, category):
    """Entry of a category in the menu."""
    (link,) = [link for link in browser.find("#app li a") if browser.text(link).strip() == category]
    return link


def test_the_front_page_opens_first_and_names_what_is_in_the_menu(browser, report):
    page = shown(browser, report, 1440)
    for part in (
        "Results of pair b",
        "Open first",
        "checks of the results passed",
        "Provenance",
        "Started",
        "order: 4",
    ):
        assert part in browser.text(page)
    assert browser.errors() == []
    named = [line.strip().split(" › ") for line in browser.text(page).splitlines() if " › " in line]
    assert len(named) >= 3
    for category, title in named:
        shown(browser, report, 1440)
        browser.click(entry(browser, category))
        assert browser.wait(lambda title=title: title in browser.text(browser.find("#app tbody")[0])), title


def open_table_3(browser, report, width):
    """Open Table III by the menu."""
    shown(browser, report, width)
    browser.click(entry(browser, "Tables"))
    assert browser.wait(lambda: buttons(browser))
    rows = map(browser.text, browser.find("#app tbody tr"))
    (number,) = (k for k, row in enumerate(rows) if row.startswith("Table 3"))
    browser.click(buttons(browser)[number])
    assert browser.wait(lambda: opened(browser, "text/html"))


def test_table_3_is_whole_and_unbroken_on_a_screen(browser, report):
    open_table_3(browser, report, 1440)
    assert browser.inside("iframe", WIDTH) <= 0
    assert browser.inside("iframe", LINES) < 1.5


def test_on_a_phone_page_and_table_take_the_whole_width(browser, report):
    shown(browser, report, 390)
    page = "document.querySelector('#app .prose').getBoundingClientRect().width"
    width, whole = browser.run(f"return [{page}, document.documentElement.scrollWidth]")
    assert width > 300
    assert whole <= 390
    open_table_3(browser, report, 390)
    assert browser.run("return document.querySelector('iframe').clientWidth") == 390
    assert browser.run("return document.querySelector('iframe').clientHeight") > 300


def test_a_second_label_that_halves_a_category_is_noticed(browser, report, tmp_path):
    # The page of Snakemake's report takes it for a switch between two versions of each result, and stays blank.
    def halved(found):
        results = json.loads(found[1])
        for k, result in enumerate(results.values()):
            result["labels"]["kind"] = "ab"[k % 2]
        return f"var results = {json.dumps(results)};"

    text, count = re.subn(r"var results = (\{.*\});", halved, report.read_text(encoding="utf-8"))
    assert count == 1
    (tmp_path / "report.html").write_text(text, encoding="utf-8")
    found = faults(browser, tmp_path / "report.html")
    assert any("does not show results/" in fault for fault in found)
    assert any("Cannot read properties of undefined" in fault for fault in found)
