"""Page of a device as one file of HTML: the answer in words, tables, figures, warnings and terms."""

import base64
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import pandas as pd
from matplotlib.figure import Figure

from stiction.report import html
from stiction.report.format import MISSING
from stiction.report.style import png

TEMPLATE = "page.html"
#: Pixels of a page for one inch of a figure, and most rows of a table that is not folded.
_PIXELS, _ROWS = 120, 30


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
    def picture(self) -> str:
        """Figure as PNG in Base64."""
        return base64.b64encode(png(self.figure)).decode()

    @property
    def width(self) -> int:
        """Width of the figure on the page [pixels]."""
        return round(_PIXELS * self.figure.get_figwidth())


@dataclass(frozen=True)
class Summary:
    """First screen of a page."""

    tone: str  #: ``good``, ``bad`` or ``open``
    sign: str  #: the answer in a word or two
    answer: str  #: one number with its error, or the warning that forbids relying on it
    basis: Sequence[str]  #: what the number rests on
    points: Mapping[str, str]  #: what decides, what to change, what to measure
    cells: pd.DataFrame  #: one small table

    @property
    def has_missing(self) -> bool:
        """Whether a cell has no number."""
        return bool((self.cells == MISSING).any(axis=None))


@dataclass(frozen=True)
class Page:
    """Contents of the page of a device."""

    title: str
    facts: Mapping[str, str]  #: dimensions and conditions, by name
    answer: Sequence[str]  #: sentences at the top, the first of which is the verdict
    sections: Sequence[Section] = ()
    warnings: Sequence[str] = ()  #: where the model ends for this device
    words: Mapping[str, str] = field(default_factory=dict)  #: terms and what they mean
    made: Sequence[str] = ()  #: when and by which code
    not_modelled: str = ""  #: what is not in the model
    drawing: str = ""  #: of the device, as SVG
    summary: Summary | None = None  #: its first screen

    @property
    def html(self) -> str:
        """Page as one file, with its figures inside."""
        return html.rendered(TEMPLATE, page=self)
