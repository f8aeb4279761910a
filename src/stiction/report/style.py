"""What all figures share: style, sizes, labels, and files that are equal byte for byte whenever the data are.

The figures themselves stand in ``figures_surfaces``, ``figures_forces`` and ``figures_beams``: functions of datasets
that return a matplotlib figure.
"""

import io
from pathlib import Path
from string import ascii_lowercase

import numpy as np
from matplotlib import style
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.ticker import LogLocator, NullFormatter

from stiction.stages.data import save_bytes

STYLE = Path(__file__).with_name("stiction.mplstyle")
#: Widths of one and of two columns of the journal [in].
SINGLE, DOUBLE = 3.5, 7.16
#: Factors from SI to the units of the axes.
NM, UM, MPA, MJ = 1e9, 1e6, 1e-6, 1e3

#: How the height models look, in every figure in which they meet.
MODELS = {
    "G": {"color": "#E69F00", "linestyle": "--", "label": "Gaussian"},
    "NG": {"color": "#0072B2", "linestyle": "-", "label": "non-Gaussian"},
    "GEO": {"color": "#0072B2", "linestyle": "-", "label": "non-Gaussian, scattered geometry"},
}

#: White outline of text that lies on data.
OUTLINED = [withStroke(linewidth=1.8, foreground="white")]

#: Decorator of a function that draws: the style of the study, whatever the user's own settings are.
styled = style.context(STYLE, after_reset=True)


def panels(rows, columns, size, **shared):
    """New figure of ``size`` (width, height) [in] and its axes (rows, columns), ``shared`` as in Figure.subplots."""
    figure = Figure(figsize=size, layout="constrained")
    return figure, figure.subplots(rows, columns, squeeze=False, **shared)


def letter(axes, names=None):
    """Title panels (a), (b), ... in reading order, each with its name."""
    axes = np.ravel(axes)
    for mark, panel, name in zip(_marks(len(axes)), axes, names or [""] * len(axes), strict=True):
        panel.set_title(f"({mark}) {name}".rstrip(), loc="left")


def handles(*panels):
    """Handles and labels of the curves of some panels, each label once."""
    found = {}
    for panel in panels:
        found |= dict(zip(*reversed(panel.get_legend_handles_labels()), strict=True))
    return list(found.values()), list(found)


def _marks(count):
    """Marks a, b, ..., z, aa, ab, ... of panels."""
    letters = ascii_lowercase
    return [(letters[k // 26 - 1] if k >= 26 else "") + letters[k % 26] for k in range(count)]


def plain_log(axis):
    """Label a logarithmic axis that spans few decades by plain numbers 1, 2, 5."""
    axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter(NullFormatter())


def _write_pdf(figure, content):
    # Without the date of drawing, a drawing is a function of its data.
    FigureCanvasPdf(figure).print_pdf(content, metadata={"CreationDate": None})


def _write_png(figure, content):
    FigureCanvasAgg(figure).print_png(content)


_WRITERS = {".pdf": _write_pdf, ".png": _write_png}


@styled
def save(figure, *paths):
    """Write a figure as PDF or PNG, whatever each path ends with; equal figures give equal bytes."""
    # The layout is settled once and the canvases are written directly: savefig would do both anew for every file, and
    # start the layout from the last one.
    if (layout := figure.get_layout_engine()) is not None:
        layout.execute(figure)
        figure.set_layout_engine("none")
    resolution = figure.dpi
    for path in paths:
        content = io.BytesIO()
        _WRITERS[Path(path).suffix](figure, content)
        figure.dpi = resolution  # a PDF leaves 72
        save_bytes(content.getvalue(), path)
