"""Style, sizes, labels and files of all figures. Equal data give files equal byte for byte.

Figures are drawn in the modules ``figures`` of each subject: functions of datasets that return a matplotlib figure.
"""

import io
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from itertools import chain, islice
from pathlib import Path
from string import ascii_lowercase
from typing import Any, NamedTuple

import numpy as np
from matplotlib import colormaps, rcParams, style
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure, FigureBase
from matplotlib.patheffects import withStroke
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter
from matplotlib.transforms import ScaledTranslation
from PIL import Image

from stiction.contact.air import DRY, Air, has_dry, humid, is_humid
from stiction.plan.stage import File, Shown, Stage, stage_name, title_of, without_wildcards
from stiction.run.atomic import save_bytes

STYLE = Path(__file__).with_name("stiction.mplstyle")
#: Widths of one and of two columns of the journal [in].
SINGLE, DOUBLE = 3.5, 7.16
#: Category of the figures of studies in the report.
STUDIES = "Sensitivity, appendices, model choices"
#: Half width of an interval that holds 95 %, in standard deviations.
INTERVAL = 1.96
#: Largest height of a figure of many panels, which are smaller then [in].
TALLEST = 24.0
#: Shortest axis of the relative humidity, for figures of a single one [-].
_SHORTEST = 0.1
#: Distance of dry air from the lowest humidity of an axis, in lengths of the axis [-].
_BESIDE = 0.2
#: Largest number of columns of panels side by side.
_ABREAST = 4
#: Width of the panels on a page [in]: text of 7 points has 11 pixels on a phone 358 pixels wide.
PAGE = 3.0
#: Width of the panels on the page that is drawn [in], 0 for figures of a journal.
_PAGE_WIDTH = ContextVar("width of a page", default=0.0)
#: Space around a strip of a figure [in].
_AROUND = 0.04
#: Levels of red, green and blue of rare colours in a picture of a page, which err by half of their step; part of the
#: pixels that a common colour has.
_LEVELS, _COMMON = 8, 1e-3
#: Points of an inch; height of the labels below a panel, in points.
_POINTS, _LABELLED = 72, 24
#: Mean width of a character and of a handle with its space, in units of the size of the text of a legend.
_CHARACTER, _HANDLE = 0.45, 5.0

#: Style of the models in every figure.
MODELS = {
    "G": {"color": "#C98500", "linestyle": "--", "label": "Gaussian"},
    "NG": {"color": "#0072B2", "linestyle": "-", "label": "non-Gaussian"},
    "GEO": {"color": "#0072B2", "linestyle": "-", "label": "non-Gaussian, scattered geometry"},
}

#: Part of the scale of colours from which the contrast to white is 3, and the colour of dry air.
DISTINCT, _DRY_AIR = 0.41, "#8C510A"
#: Colour of published values.
PUBLISHED = "#D55E00"
#: Colour of the size to build.
BUILD = "#D55E00"
_MARKERS = ("o", "s", "^", "v", "D", "P", "X", "<", ">", "p")
_DASHES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2)), (0, (1, 3)), (0, (4, 4)))

#: White outline of text that lies on data.
OUTLINED = [withStroke(linewidth=1.8, foreground="white")]

#: Decorator of a function that draws: the style of the study, independent of the user's own settings.
styled = style.context(STYLE, after_reset=True)


def marker(k: int) -> str:
    """Marker of curve number ``k``. Markers and `dashes` repeat after different numbers of curves."""
    return _MARKERS[k % len(_MARKERS)]


def dashes(k: int) -> str | tuple:
    """Line style of curve number ``k``."""
    return _DASHES[k % len(_DASHES)]


def shades(count: int) -> np.ndarray:
    """Colours darkening from the first to the last, also when printed in grey, (count, 4).

    The contrast of the lightest to white is 3.
    """
    return colormaps["viridis_r"](np.linspace(DISTINCT, 1, count))


def humidity_colour(humidity: float) -> tuple[float, float, float, float]:
    """Colour of a relative humidity, the same in all figures of devices, with a contrast of at least 3 to white.

    It darkens with the square of the humidity, because devices are mostly in air above 0.4. Dry air is brown.
    """
    if not is_humid(humidity):
        return to_rgba(_DRY_AIR)
    return colormaps["viridis_r"](DISTINCT + (1 - DISTINCT) * humidity**2)


def humidity_colours(humidities: Iterable[float]) -> dict[float, tuple[float, float, float, float]]:
    """Colour of every relative humidity, in their order."""
    return {humidity: humidity_colour(humidity) for humidity in sorted(set(humidities))}


@contextmanager
def on_a_page(width: float = PAGE) -> Iterator[None]:
    """Draw figures for a page: all panels below each other, each as wide as a phone or another ``width`` [in]."""
    token = _PAGE_WIDTH.set(width)
    try:
        yield
    finally:
        _PAGE_WIDTH.reset(token)


def is_page() -> bool:
    """Whether a figure is drawn for a page."""
    return _PAGE_WIDTH.get() > 0


def page_width(width: float) -> float:
    """Width of a figure of `panels`: that of a page while one is drawn, else ``width`` [in]."""
    return _PAGE_WIDTH.get() or width


def panels(
    rows: int, columns: int, size: tuple[float, float], *, beside: bool = False, **shared
) -> tuple[Figure, np.ndarray]:
    """New figure of ``size`` (width, height) [in] and its axes (rows, columns), ``shared`` as in Figure.subplots.

    On a page all panels are below each other, unless small ones stay ``beside`` each other.
    """
    if _PAGE_WIDTH.get() and not beside:
        return _stacked(rows, columns, size[1], shared.get("height_ratios", [1] * rows))
    figure = Figure(figsize=(page_width(size[0]), size[1]), layout="constrained")
    return figure, figure.subplots(rows, columns, squeeze=False, **shared)


def _stacked(rows, columns, height, ratios):
    """New figure of a page with all panels of rows and columns below each other, and its axes (rows, columns)."""
    figure = Figure(figsize=(_PAGE_WIDTH.get(), columns * height), layout="constrained")
    axes = figure.subplots(rows * columns, 1, squeeze=False, height_ratios=np.repeat(ratios, columns))
    return figure, axes.reshape(rows, columns)


def at_most_double(each: float) -> Callable[[int], float]:
    """Width of a figure by the number of its columns of panels, each this wide if there is room [in]."""
    return lambda columns: min(DOUBLE, each * columns)


def columns_of_panels(
    count: int, rows: int, width: Callable[[int], float], height: float, **shared
) -> tuple[Figure, np.ndarray, list[np.ndarray]]:
    """New figure with one column of ``rows`` panels for each of ``count`` subjects, at most four columns side by side.

    Parameters
    ----------
    count, rows : int
    width : callable
        Width of the figure [in] by the number of columns.
    height : float
        [in] of one line of columns, less if the figure would be taller than `TALLEST`.
    shared
        As in Figure.subplots, of one line of columns.

    Returns
    -------
    figure : Figure
    columns : (count, rows) array of Axes
    lines : list of (rows, n) arrays of Axes
        The panels as they are arranged, line by line.
    """
    figure, ((_, columns, lines),) = blocks_of_columns(1, count, rows, width, height, **shared)
    return figure, columns, lines


def blocks_of_columns(
    blocks: int, count: int, rows: int, width: Callable[[int], float], height: float, **shared
) -> tuple[Figure, list[tuple[FigureBase, np.ndarray, list[np.ndarray]]]]:
    """Several times the panels of `columns_of_panels`, below each other in one new figure.

    Returns
    -------
    figure : Figure
    blocks : list of tuples
        Part of the figure, which can have a legend of its own, and its ``columns`` and ``lines``.
    """
    many, across = _arrangement(count)
    wide, tall = page_width(width(across)), np.inf if _PAGE_WIDTH.get() else TALLEST
    figure = Figure(figsize=(wide, min(height * many * blocks, tall)), layout="constrained")
    parts = [figure] if blocks == 1 else figure.subfigures(blocks, 1)
    return figure, [(block, *_columns(block, count, rows, shared)) for block in parts]


def _arrangement(count):
    """Number of lines of columns of panels, and of columns side by side."""
    many = -(-count // (1 if _PAGE_WIDTH.get() else _ABREAST))
    return many, -(-count // many)


def _columns(block, count, rows, shared):
    """Columns of panels in a figure or a part of it, and the same panels line by line."""
    many, across = _arrangement(count)
    if many == 1 or rows == 1:
        lines = np.split(block.subplots(rows * many, across, squeeze=False, **shared), many)
    else:
        lines = [line.subplots(rows, across, squeeze=False, **shared) for line in block.subfigures(many, 1)]
    lines[-1], unused = np.split(lines[-1], [count - across * (many - 1)], axis=1)
    for panel in unused.flat:
        panel.remove()
    return np.concatenate([line.T for line in lines]), lines


def legends(figure: Figure, options: Mapping[Axes, dict], most: int = 6) -> None:
    """Legend in each panel with at most ``most`` curves, and one below the figure for the curves of all other panels.

    Panels come with the options of their legends.
    """
    crowded = [panel for panel in options if len(handles(panel)[0]) > most]
    for panel, chosen in options.items():
        if panel not in crowded:
            panel.legend(**chosen)
    if crowded:
        figure.legend(*handles(*crowded), loc="outside lower center", ncols=6)


def legend_below(panel: Axes, entries: Sequence[Artist]) -> None:
    """Legend below the label of the horizontal axis of a panel, clear of all curves.

    It has as many columns as fit below the panel.
    """
    grid, figure = panel.get_gridspec(), panel.figure
    columns = _fitting(figure.bbox.width / figure.dpi / grid.ncols, [entry.get_label() for entry in entries])
    below = panel.transAxes + ScaledTranslation(0, -_LABELLED / _POINTS, figure.dpi_scale_trans)
    position = {"loc": "upper center", "bbox_to_anchor": (0.5, 0), "bbox_transform": below}
    panel.legend(handles=entries, ncols=columns, **position)


def legend_outside(figure: Figure, shown: tuple[Sequence[Artist], Sequence[str]], side: str, most: int) -> None:
    """Legend of ``shown`` handles and labels above (``upper``) or below (``lower``) all panels of a figure.

    It has as many columns as fit, at most ``most``.
    """
    columns = min(most, _fitting(figure.get_figwidth(), shown[1]))
    figure.legend(*shown, loc=f"outside {side} center", ncols=columns)


def _fitting(width, labels):
    """Number of columns of a legend with some labels that fit into a width [in], at least one."""
    lines = (line for label in labels for line in label.splitlines())
    em, longest = rcParams["legend.fontsize"] / _POINTS, max(map(len, lines), default=0)
    return max(1, int(width / (em * (_CHARACTER * longest + _HANDLE))))


def places(humidities: Iterable[float]) -> dict[float, float]:
    """Place of every relative humidity along an axis. Dry air is beside its lowest humidity, never on it.

    Examples
    --------
    >>> places([0.0, 0.5, 0.75])
    {0.0: 0.45, 0.5: 0.5, 0.75: 0.75}
    """
    humidities = sorted(set(humidities))
    on_axis = humid(humidities) or [0.5]
    apart = _BESIDE * max(on_axis[-1] - on_axis[0], _SHORTEST)
    return {humidity: Air(humidity).choose(humidity, on_axis[0] - apart) for humidity in humidities}


def humidity_axis(panel: Axes, placed: Mapping[float, float] | None = None) -> None:
    """Keep the axis of the relative humidity within 0 and 1, and long enough for separate ticks.

    Dry air, if it is among the `places` of an axis, has a tick of its own beyond a dotted line.
    """
    left, right = panel.get_xlim()
    short = max(0, _SHORTEST - (right - left)) / 2
    if short or left < 0 or right > 1:
        panel.set_xlim(max(left - short, 0), min(right + short, 1))
    if short:
        # Labels at the ends would stick out of the panel.
        panel.xaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10], prune="both"))
    dry_tick(panel, placed or {})


def dry_tick(panel: Axes, placed: Mapping[float, float]) -> None:
    """Tick for dry air if it is among the `places` of an axis, and a line between it and the lowest humidity."""
    if not has_dry(placed):
        return
    dry, lowest = (*placed.values(), np.inf)[:2]
    ticks = [tick for tick in panel.get_xticks() if (dry + lowest) / 2 < tick <= panel.get_xlim()[1]]
    panel.set_xticks([dry, *ticks], [DRY, *(f"{tick:g}" for tick in ticks)])
    for sibling in panel.get_shared_x_axes().get_siblings(panel) if ticks else ():
        sibling.axvline((dry + lowest) / 2, color="0.6", linestyle=":", linewidth=0.8)


def letter(axes: Iterable[Axes], names: Sequence[str] | None = None) -> None:
    """Title panels (a), (b), ... in reading order, each with its name. A single panel has its name alone."""
    axes = np.ravel(axes)
    marks = [f"({mark}) " for mark in _marks(len(axes))] if len(axes) > 1 else [""]
    for mark, panel, name in zip(marks, axes, names or [""] * len(axes), strict=True):
        panel.set_title(f"{mark}{name}".rstrip(), loc="left")


def letter_lines(lines: Sequence[np.ndarray], names: Sequence[str], shown: Sequence[str] = ("",)) -> None:
    """Title the panels of all lines of `columns_of_panels`, each with the name of its column, but for removed ones.

    What panels of several rows have ``shown`` follows the name.
    """
    names = iter(names)
    columns = [(line, list(islice(names, line.shape[1]))) for line in lines]
    titles = [
        f"{name}{shown[k % len(shown)]}"
        for line, names_of_line in columns
        for k in range(line.shape[0])
        for name in names_of_line
    ]
    titled = zip(np.concatenate([line.ravel() for line in lines]), titles, strict=True)
    letter(*zip(*((panel, title) for panel, title in titled if panel.figure), strict=True))


def on_own_axes(text: str, line: np.ndarray) -> str:
    """Label of a quantity on the first of a line of panels, each of which has an axis of its own."""
    return f"{text}, axes differ" if line.shape[-1] > 1 else text


def handles(*panels: Axes) -> tuple[list, list[str]]:
    """Handles and labels of the curves of some panels, each label once."""
    by_label = {}
    for panel in panels:
        by_label |= dict(zip(*reversed(panel.get_legend_handles_labels()), strict=True))
    return list(by_label.values()), list(by_label)


def _marks(count):
    """Marks a, b, ..., z, aa, ab, ... of panels."""
    letters = ascii_lowercase
    return [(letters[k // 26 - 1] if k >= 26 else "") + letters[k % 26] for k in range(count)]


def plain_log(axis: Axis, subs: Sequence[float] = (1, 2, 5)) -> None:
    """Label a logarithmic axis over few decades by plain numbers, ``subs`` times powers of ten."""
    axis.set_major_locator(LogLocator(subs=subs))
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter(NullFormatter())


def _write_pdf(figure, content):
    # No creation date: equal data give equal files.
    FigureCanvasPdf(figure).print_pdf(content, metadata={"CreationDate": None})


def _write_png(figure, content):
    FigureCanvasAgg(figure).print_png(content)


_WRITERS = {".pdf": _write_pdf, ".png": _write_png}


@styled
def save(figure: Figure, *paths: str | Path) -> None:
    """Write a figure as PDF or PNG, by the suffix of each path. Equal figures give equal bytes."""
    # The layout is computed once and the canvases are written directly: savefig would compute it again for every file,
    # starting from the previous layout.
    if (layout := figure.get_layout_engine()) is not None:
        layout.execute(figure)
        figure.set_layout_engine("none")
    resolution = figure.dpi
    for path in paths:
        content = io.BytesIO()
        _WRITERS[Path(path).suffix](figure, content)
        figure.dpi = resolution  # writing a PDF sets it to 72
        save_bytes(content.getvalue(), path)


def figure_stage(
    file: str, shows: str, category: str, inputs: Callable, name: str = "", caption: str = "", **declared: Any
) -> Stage:
    """Stage for a figure as PDF and PNG, with its caption. ``shows`` ends its title in the report.

    The text of the caption is in ``workflow/report``; the label of the figure ends it.
    """
    caption = caption or without_wildcards(file)
    return Stage(
        name=name or stage_name("figure", file),
        files={key: f"figures/{file}.{key}" for key in ("pdf", "png", "txt")},
        inputs=lambda plan, at: {**inputs(plan, at), "style": File(STYLE)},
        save=lambda figure, paths: save(figure, paths["pdf"], paths["png"]),
        shown=Shown(file="png", title=title_of(file, shows), category=category, caption=caption),
        message=f"{title_of(file, shows)}.",
        **declared,
    )


@styled
def preload() -> None:
    """Draw a small figure and discard it.

    Fonts, the parser of formulas and all that files need are then loaded, also for the processes forked from this one.
    """
    figure, axes = panels(1, 1, (SINGLE, SINGLE))
    axes[0, 0].set(xlabel="$x$", xscale="log")
    for write in _WRITERS.values():
        write(figure, io.BytesIO())


@styled
def png(figure: Figure) -> bytes:
    """Content of a PNG file of a figure."""
    content = io.BytesIO()
    _write_png(figure, content)
    return content.getvalue()


class Picture(NamedTuple):
    """Part of a figure of a page, as wide as the figure."""

    content: bytes
    is_legend: bool = False  #: whether it explains all panels beside it


@styled
def strips(figure: Figure) -> list[Picture]:
    """Panels of a figure that was drawn for a page, and its legends outside of them, from top to bottom.

    A page arranges panels in as many columns as fit. A legend has a line of its own.
    """
    canvas = FigureCanvasAgg(figure)
    for panel in figure.axes:
        for text in (panel.title, panel._left_title, panel.xaxis.label):
            text.set_wrap(True)
    canvas.draw()
    pixels, around = np.asarray(canvas.buffer_rgba()), _AROUND * figure.dpi
    shown, legends = ([_ends(canvas, artist) for artist in parts] for parts in (figure.axes, _legends(figure)))
    parts = []
    for low, high in _joined(shown + legends):
        ends = len(pixels) - np.array([high + around, low - around])
        top, bottom = np.clip(ends, 0, len(pixels)).round().astype(int)
        parts.append(Picture(picture(pixels[top:bottom, :, :3]), (low, high) in legends))
    return parts


def picture(pixels: np.ndarray) -> bytes:
    """Content of a file of pixels (rows, columns, 3), as lossless WebP: a quarter smaller than PNG.

    Colours of areas and lines stay. Those of few pixels, at edges and in letters, have 8 levels of each part.
    """
    codes, places, counts = np.unique(pixels @ np.array([1 << 16, 1 << 8, 1]), return_inverse=True, return_counts=True)
    colours, step = np.stack([codes >> 16, codes >> 8 & 255, codes & 255], axis=1), 255 / (_LEVELS - 1)
    is_common = counts > _COMMON * counts.sum()
    colours = np.where(is_common[:, None], colours, np.rint(np.rint(colours / step) * step)).astype(np.uint8)
    content = io.BytesIO()
    Image.fromarray(colours[places].reshape(pixels.shape)).save(content, "webp", lossless=True, quality=100)
    return content.getvalue()


def _ends(canvas, artist):
    """Lower and upper end of a part of a figure [pixels]."""
    box = artist.get_tightbbox(canvas.get_renderer())
    return box.y0, box.y1


def _legends(figure):
    """Legends of a figure and its parts that are outside of panels."""
    return [*figure.legends, *chain.from_iterable(block.legends for block in figure.subfigs)]


def _joined(intervals):
    """Intervals with overlapping ones joined, from the highest to the lowest."""
    joined: list[tuple[float, float]] = []
    for low, high in sorted(intervals, key=lambda ends: -ends[1]):
        if joined and high > joined[-1][0]:
            low, high = min(low, joined[-1][0]), joined.pop()[1]
        joined.append((low, high))
    return joined
