"""Page of a device as one file of HTML: the answer in words, tables, figures, warnings and terms."""

import base64
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from stiction.report import html
from stiction.report.format import MISSING
from stiction.report.style import strips

TEMPLATE, SCRIPT = "page.html", "explorer.js"
#: Most rows of a table that is not folded.
_ROWS = 30


@dataclass(frozen=True)
class Section:
    """Part of a page: paragraphs, a table and a figure, each possibly missing."""

    title: str
    paragraphs: Sequence[str] = ()
    cells: pd.DataFrame | None = None
    figure: Figure | None = None
    missing: str = "it does not apply to this row, or too few samples bound it"  #: why cells have no number

    @property
    def has_missing(self) -> bool:
        """Whether a cell has no number."""
        return bool((self.cells == MISSING).any(axis=None))

    @property
    def is_long(self) -> bool:
        """Whether the table is folded."""
        return len(self.cells) > _ROWS

    @property
    def pictures(self) -> list[tuple[str, bool]]:
        """Panels and legends of the figure in Base64, each with whether it is a legend."""
        return [(base64.b64encode(strip.content).decode(), strip.is_legend) for strip in strips(self.figure)]


@dataclass(frozen=True)
class Summary:
    """First screen of a page."""

    tone: str  #: ``good``, ``bad`` or ``open``
    sign: str  #: the answer in a word or two
    answer: str  #: one number with its error, or the warning that forbids relying on it
    basis: Sequence[str]  #: what the number rests on
    points: Mapping[str, str]  #: what decides, what to change, what to measure
    cells: pd.DataFrame  #: one small table
    missing: str = "test beams contradict the model, or too few samples bound it"  #: why cells have no number
    is_forbidden: bool = False  #: whether a limit stands in the place of all numbers in words

    @property
    def has_missing(self) -> bool:
        """Whether a cell has no number."""
        return bool((self.cells == MISSING).any(axis=None))

    @property
    def line(self) -> str:
        """Answer in a line."""
        return f"{self.sign}: {self.answer}"


@dataclass(frozen=True)
class Page:
    """Contents of the page of a device."""

    title: str
    facts: Mapping[str, str]  #: dimensions and conditions, by name
    answer: Sequence[str]  #: all of it in sentences, for a file beside the page; the first is the verdict
    sections: Sequence[Section] = ()
    warnings: Sequence[str] = ()  #: where the model ends for this device
    words: Mapping[str, str] = field(default_factory=dict)  #: terms and what they mean
    run: Sequence[str] = ()  #: when it was computed, and by which code
    not_modelled: str = ""  #: what is not in the model
    drawing: str = ""  #: of the device, as SVG
    summary: Summary | None = None  #: its first screen
    more: Sequence[str] = ()  #: sentences of the answer that are not on the first screen
    explorer: Mapping[str, Any] | None = None  #: for its controls, numbers and texts alone

    @property
    def script_hash(self) -> str:
        """Hash of the only script that a browser may run on the page."""
        return html.hash_of(SCRIPT)

    @property
    def lines(self) -> list[str]:
        """Answer for a file of text: the first screen, and all sentences unless a warning forbids them."""
        if self.summary is None:
            return [*self.answer]
        points = [f"{term}: {text}" for term, text in self.summary.points.items()]
        return [self.summary.line, *self.summary.basis, *points, *([] if self.is_forbidden else self.answer)]

    @property
    def is_forbidden(self) -> bool:
        """Whether a warning stands in the place of all numbers in words."""
        return self.summary is not None and self.summary.is_forbidden

    @property
    def controls(self) -> dict[str, Any]:
        """Content of its controls, with the warning that stands in the place of their answers, if there is one."""
        return self.explorer | {"forbidden": self.summary.line if self.is_forbidden else ""}

    @property
    def html(self) -> str:
        """Page as one file, with its figures inside."""
        return html.rendered(TEMPLATE, page=self)
