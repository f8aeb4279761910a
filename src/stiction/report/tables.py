"""Common to all tables: numbers for machines, text for reading, and the files of both."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from stiction.plan.stage import Shown, Stage, titled
from stiction.run.atomic import save_text

_PAGE = """<!DOCTYPE html>
<meta charset="utf-8">
<style>
body {{ font: 13px sans-serif }} p {{ white-space: pre-line }} td, th {{ padding: 1px 10px; text-align: right }}
</style>
<p>{caption}</p>
{cells}
"""


@dataclass(frozen=True)
class Table:
    """One table of the results."""

    frame: pd.DataFrame  #: every number with its error, in the units of the names of the columns
    caption: str  #: what the table shows
    cells: pd.DataFrame  #: the same for reading, as text

    @property
    def csv(self) -> str:
        """All numbers."""
        return self.frame.to_csv(index=False)

    @property
    def markdown(self) -> str:
        """Caption and cells; a cell keeps all its digits, even if it looks like a number."""
        grid = self.cells.to_markdown(index=False, disable_numparse=True, stralign="right")
        return f"{self.caption}\n\n{grid}\n"

    @property
    def html(self) -> str:
        """Page of caption and cells."""
        return _PAGE.format(caption=self.caption, cells=self.cells.to_html(index=False, border=0))


def with_list(caption: str, sentences: Sequence[str]) -> str:
    """Caption with sentences below each other.

    Examples
    --------
    >>> print(with_list("Lengths. Warnings:", ["Too steep.", "Too thin."]))
    Lengths. Warnings:
    <BLANKLINE>
    - Too steep.
    - Too thin.
    """
    return "\n".join([caption, *([""] if sentences else []), *(f"- {sentence}" for sentence in sentences)])


def save(table: Table, paths: Mapping[str, str]) -> None:
    """Write a table as CSV, as Markdown for reading and as HTML for the report: ``paths`` has these three keys."""
    for key, path in paths.items():
        save_text(getattr(table, key), path)


def table_stage(name: str, file: str, shows: str, **declared: Any) -> Stage:
    """Stage that makes a `Table` and writes it into files of a name; ``shows`` ends its title in the report."""
    files = {key: f"tables/{file}.{end}" for key, end in (("csv", "csv"), ("markdown", "md"), ("html", "html"))}
    shown = Shown(file="html", title=titled(file, shows), category="Tables")
    return Stage(name=name, files=files, save=save, shown=shown, message=f"{titled(file, shows)}.", **declared)
