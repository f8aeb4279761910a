"""Tables on a phone: they fit, or scroll in their box below a hint, with what their rows are about in sight."""

import pandas as pd
import pytest
from browser import missing

from stiction.report import html
from stiction.report.page import Page, Section, Summary

pytestmark = [
    pytest.mark.slow,
    pytest.mark.browser,
    pytest.mark.skipif(bool(missing()), reason=missing()),
]

LONG = "longest beam of a rather wide device that does not collapse while isopropanol dries"
NARROW = pd.DataFrame({"RH": ["0.44", "0.9"], "force [µN]": ["12", "2 190 000"]})
WIDE = pd.DataFrame({"RH": ["0.44"]} | {f"quantity {k} [mJ/m²]": ["5 840 000 ± 190 000"] for k in range(9)})
OF_WORDS = pd.DataFrame(
    {"what": [LONG, "x"], "at least": ["2 190 000"] * 2, "at most": ["9 840 000"] * 2, "form": [LONG] * 2}
)
#: Of each table: width beyond its box, place of its first cell over that of its box before and after scrolling to its
#: end, part of the width that its first column takes, and whether its hint is shown, at both.
STATES = """
return [...document.querySelectorAll('.table')].map(box => {
  const cell = box.querySelector('td'), place = () => cell.getBoundingClientRect().x - box.getBoundingClientRect().x;
  const top = () => box.querySelector('table').getBoundingClientRect().y - box.getBoundingClientRect().y;
  box.scrollLeft = 0;
  const before = place(), beyond = box.scrollWidth - box.clientWidth;
  box.scrollLeft = 99999;
  const style = getComputedStyle(box);
  const last = [...cell.parentElement.cells].at(-1).getBoundingClientRect().right;
  return {beyond, before, after: place(), part: cell.offsetWidth / box.clientWidth, top: top(),
    paper: getComputedStyle(cell).backgroundColor, hint: style.backgroundImage.includes('more'),
    room: parseFloat(style.paddingTop), end: last - box.getBoundingClientRect().right};
});
"""


def states(browser, path, text):
    path.write_text(text, encoding="utf-8")
    browser.open(path)
    browser.resize(390)
    assert browser.run("return document.documentElement.scrollWidth") <= 390
    return browser.run(STATES)


def page():
    summary = Summary("good", "Safe", "It is safe.", (), {}, NARROW)
    tables = [Section(f"Part {k}", (), cells) for k, cells in enumerate([NARROW, WIDE, OF_WORDS])]
    return Page("D", {"surfaces": "pair b"}, [], tables, summary=summary).html


def table_page():
    return html.rendered("table.html", title="Table", parts=(), cells=WIDE)


@pytest.mark.parametrize(("text", "wide"), [(page, [False, False, True, True]), (table_page, [True])])
def test_a_wide_table_says_that_there_is_more_and_keeps_its_first_column(browser, tmp_path, text, wide):
    found = states(browser, tmp_path / "page.html", text())
    assert [state["beyond"] > 1 for state in found] == wide
    for state in found:
        assert state["hint"]
        assert state["top"] >= state["room"] >= 15, "the hint is above the table, not below its numbers"
        assert state["part"] <= 0.5
        assert state["after"] == pytest.approx(state["before"], abs=1)
        assert state["end"] <= 1, "its last number can be reached"
        assert state["paper"] not in ("transparent", "rgba(0, 0, 0, 0)"), "no number is seen through it"


def test_the_first_column_of_a_table_without_the_style_is_lost(browser, tmp_path):
    """A control of the test above."""
    found = states(browser, tmp_path / "page.html", page().replace("position: sticky", ""))
    assert [abs(state["after"] - state["before"]) > 20 for state in found] == [False, False, True, True]
