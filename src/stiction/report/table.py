"""Common to all tables: numbers for machines, text for reading, and the files of both."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from stiction.plan.stage import Shown, Stage, stage_name, title_of
from stiction.report import html
from stiction.report.format import humidity_text, number
from stiction.run import markdown
from stiction.run.atomic import save_text

_TEMPLATE = "table.html"
#: Columns for reading by title: a format or a function, and the keys of the numbers that it shows as text.
Columns = Mapping[str, tuple[str | Callable[..., str], *tuple[str, ...]]]
#: The first columns of most tables.
HUMIDITY = {"RH": (humidity_text, "relative_humidity")}
PAIR = {"pair": (str, "pair")} | HUMIDITY
DEVICE = {"device": (str, "device")} | HUMIDITY


@dataclass(frozen=True)
class Term:
    """Term of a caption, such as the title of a column, and what it means."""

    name: str
    meaning: str

    def __str__(self):
        return f"{self.name}: {self.meaning}"


@dataclass(frozen=True)
class Line:
    """Sentence of a caption that stands on a line of its own."""

    sentence: str


#: What a table shows: sentences, terms, and lines below all of these.
Caption = Sequence[str | Term | Line]


@dataclass(frozen=True)
class Table:
    """One table of the results."""

    frame: pd.DataFrame  #: every number with its error, in the units of the names of the columns
    shows: str | Caption
    cells: pd.DataFrame  #: the same for reading, as text

    @classmethod
    def from_rows(cls, rows: Iterable[Mapping[str, Any]], shows: str | Caption, columns: Columns) -> "Table":
        """Table of rows of numbers, with their text in some columns."""
        frame = pd.DataFrame(rows)
        return cls(frame, shows, as_text(frame, columns))

    @property
    def parts(self) -> Caption:
        """Parts of the caption that are not empty."""
        return tuple(filter(None, [self.shows] if isinstance(self.shows, str) else self.shows))

    @property
    def caption(self) -> str:
        """Caption as text: one paragraph, and below it lines.

        Examples
        --------
        >>> parts = "Lengths.", Term("Limit", "the least."), "Warnings:", Line("Too steep."), Line("Too thin.")
        >>> print(Table(pd.DataFrame(), parts, pd.DataFrame()).caption)
        Lengths. Limit: the least. Warnings:
        <BLANKLINE>
        - Too steep.
        - Too thin.
        """
        lines = [f"- {entry.sentence}" for entry in self.parts if isinstance(entry, Line)]
        paragraph = " ".join(str(entry) for entry in self.parts if not isinstance(entry, Line))
        return "\n".join([paragraph, *([""] if lines else []), *lines])

    @property
    def csv(self) -> str:
        """Table as CSV, with all numbers."""
        return self.frame.to_csv(index=False)

    @property
    def markdown(self) -> str:
        """Caption and cells. A cell keeps all its digits, even if it looks like a number."""
        grid = self.cells.map(markdown.cell).to_markdown(index=False, disable_numparse=True, stralign="right")
        return "\n".join([*map(markdown.literal, self.caption.split("\n")), "", grid, ""])

    def page(self, title: str) -> str:
        """Page of title, caption and cells, as HTML."""
        return html.rendered(_TEMPLATE, title=title, parts=self.parts, cells=self.cells)


def as_text(frame: pd.DataFrame, columns: Columns) -> pd.DataFrame:
    """Rows of numbers for reading.

    Examples
    --------
    >>> print(as_text(pd.DataFrame({"x": [0.123]}), {"x [%]": ("{:.0%}".format, "x"), "x": (".1f", "x")}))
      x [%]    x
    0   12%  0.1
    """
    rows = frame.to_dict("records")
    return pd.DataFrame([{title: _cell(row, *shown) for title, shown in columns.items()} for row in rows])


def _cell(row, show, *keys):
    """Text of the values of a row by their keys. A format shows a single number."""
    values = [row[key] for key in keys]
    return show(*values) if callable(show) else number(*values, show)


def warned(sentences: Sequence[str]) -> list[str | Line]:
    """End of a caption with warnings, nothing without one."""
    return ["Warnings:", *map(Line, sentences)] if sentences else []


def save(table: Table, paths: Mapping[str, str], title: str) -> None:
    """Write a table as CSV, as Markdown for reading and as a page: ``paths`` has the keys csv, markdown and html."""
    save_text(table.csv, paths["csv"])
    save_text(table.markdown, paths["markdown"])
    save_text(table.page(title), paths["html"])


def table_stage(file: str, shows: str, inputs: Callable, name: str = "", title: str = "", **declared: Any) -> Stage:
    """Stage for a `Table` in files of a name. ``shows`` ends its title in the report, which begins with their name."""
    files = {key: f"tables/{file}.{end}" for key, end in (("csv", "csv"), ("markdown", "md"), ("html", "html"))}
    shown = Shown(file="html", title=title or title_of(file, shows), category="Tables")
    name, message = name or stage_name("table", file), f"{shown.title}."
    return Stage(
        name=name,
        files=files,
        inputs=lambda plan, at: {**inputs(plan, at), "templates": html.files(_TEMPLATE)},
        save=lambda table, paths: save(table, paths, shown.title),
        shown=shown,
        message=message,
        **declared,
    )
