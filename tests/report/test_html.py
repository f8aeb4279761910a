"""Templates: what they are filled with is text, and all files of which they consist are known."""

from pathlib import Path

import pandas as pd
import pytest
from hostile import HOSTILE, Reading
from jinja2 import UndefinedError

from stiction.report import html
from stiction.report.page import Page
from stiction.report.table import Table

#: Templates, each with what fills it.
FILLED = {
    "table.html": lambda: Table(pd.DataFrame(), HOSTILE, pd.DataFrame({HOSTILE: [HOSTILE]})).page(HOSTILE),
    "page.html": lambda: Page(HOSTILE, {HOSTILE: HOSTILE}, [HOSTILE], more=[HOSTILE], explorer={HOSTILE: HOSTILE}).html,
    "front.html": lambda: html.rendered(
        "front.html", **dict.fromkeys(["subjects", "checks", "changes"], HOSTILE),
        **dict.fromkeys(["answers", "opened", "warnings", "provenance"], [HOSTILE]),
        pairs=[{HOSTILE: HOSTILE}], length=1, models={"NG": HOSTILE},
    ),
}  # fmt: skip


@pytest.mark.parametrize("template", FILLED)
def test_a_template_reads_no_other_files_than_those_it_is_said_to_consist_of(template, monkeypatch):
    read, loader = set(), html._ENVIRONMENT.loader
    load = loader.get_source
    monkeypatch.setattr(loader, "get_source", lambda environment, file: read.add(file) or load(environment, file))
    html._ENVIRONMENT.cache.clear()
    FILLED[template]()
    assert {Path(file) for file in html.files(template)} == {html.TEMPLATES / file for file in read}


@pytest.mark.parametrize("template", FILLED)
def test_whatever_fills_a_template_is_text(template):
    shown = Reading(FILLED[template]())
    assert {*shown.code} <= {"meta", "script"}
    assert not [script for script in shown.text.get("script", []) if script.startswith("alert")]
    assert sum(text == HOSTILE for texts in shown.text.values() for text in texts) >= 3


def test_no_line_ends_between_the_thousands_of_a_number():
    cells = pd.DataFrame({"at least": ["154 000", "1 234 567 g", "12 3"], "number": [1.5, 2.5, 3.5]})
    shown = html.rendered("table.html", title="Life", cells=cells, parts=())
    for text in ("154\N{NO-BREAK SPACE}000", "1\N{NO-BREAK SPACE}234\N{NO-BREAK SPACE}567 g", "12 3", "1.5"):
        assert f"<td>{text}</td>" in shown


def test_a_value_that_a_template_lacks_is_an_error():
    with pytest.raises(UndefinedError, match="'parts' is undefined"):
        html.rendered("table.html", title="Table 3", cells=pd.DataFrame({"pair": ["b"]}))


def test_the_script_of_a_page_has_the_statements_of_its_source_without_comments_and_indentation():
    source = (html.TEMPLATES / "explorer.js").read_text(encoding="utf-8")
    shown = FILLED["page.html"]().rpartition("<script>")[2].partition("</script>")[0]
    statements = [line.strip() for line in source.splitlines()]
    kept = [line for line in statements if line and not line.startswith(("//", "/**"))]
    assert [line for line in shown.splitlines() if line] == kept
    assert len(shown) < 0.9 * len(source)
    assert not [line for line in kept if line.count("`") % 2], (
        "no text goes over several lines, where spaces would count"
    )
    assert not [line for line in kept if line.startswith("*") or ("/**" in line and "*/" not in line)]
