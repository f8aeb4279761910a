"""Figures of devices: share of stuck beams over their length, safe length over the relative humidity."""

import textwrap
from collections.abc import Iterable, Mapping
from itertools import product
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke

from stiction.answer.data import Answer
from stiction.contact.air import Air, is_humid
from stiction.devices.chart import FEWEST_HUMIDITIES, between, error_between
from stiction.devices.limits.limit import Limit
from stiction.devices.risk import one_in
from stiction.plan.names import by_name
from stiction.report.answer.tables import of_datasets
from stiction.report.answer.words import is_forbidden, to_build, unasked
from stiction.report.format import TO_UM, UM, bounding, fraction_with_band, listed
from stiction.report.limits.words import distinct, in_short, numbered, with_numbers
from stiction.report.style import (
    BUILD,
    OUTLINED,
    SINGLE,
    at_most_double,
    columns_of_panels,
    figure_stage,
    handles,
    humidity_axis,
    humidity_colours,
    legend_below,
    legend_outside,
    letter_lines,
    on_own_axes,
    places,
    shades,
    styled,
)
from stiction.rounding import in_percent
from stiction.stages.devices import device_warnings
from stiction.stages.devices.chart import axes, charts
from stiction.stages.devices.end_states import END_STATES

#: Marker of each basis of a safe length.
_BASES = {"sampled": "o", "fitted": "s", "extrapolated": "x", "longest": ">", "flat": "|"}
#: Height of a line of panels, and of an entry of the legends below them [in].
_PANEL, _ENTRY = 3.3, 0.12
#: Mean width of a character of a title, or below a figure [in].
_CHARACTER = 0.05
#: Label of the lengths of a chart.
_OF_CHART = "length [µm]; lines: simulated limit,\none touchdown, exact inputs (not to build)"
#: End of the title of a panel with sizes to build.
_BUILD_THESE = ": build diamonds"
#: Points of a curve between computed humidities.
_POINTS = 200
#: Space above the longest curve of a chart, in units of the range of its lengths.
_ROOM = 0.05
#: Least distance of the names of two curves of a chart, in heights of their panel.
_APART = 0.05


def refer_to_warnings(figure: Figure, warnings: Mapping[Any, list[Limit]]) -> str:
    """Add the texts of warnings to the caption of a figure, and return their numbers and short form."""
    if not (sentences := with_numbers(warnings)):
        return ""
    figure.set_label("\n".join(["Warnings:", *sentences]))
    numbers = "(1)" if len(sentences) == 1 else f"(1) to ({len(sentences)})"
    return _filled(f"{numbers}: {in_short(distinct(warnings))}", figure)


def _filled(text, figure, across=1):
    """Text in lines that fit below a figure, or above a panel of one with some panels side by side."""
    return textwrap.fill(text, int(figure.get_figwidth() / across / _CHARACTER))


@styled
def simulated(
    datasets: Mapping[tuple[str, float], xr.Dataset], warnings: Mapping[tuple[str, float, str], list]
) -> Figure:
    """P(stuck) of beams by simulation alone against their length, one panel for each device and end state.

    It has bands of 95 % and simulated limits. A humidity has the same colour in all panels.
    The numbers of the warnings, which are by name, humidity and shape, mark the curves.
    """
    names = list(dict.fromkeys(name for name, _ in datasets))
    numbers = numbered(warnings)
    most = max(sum(device == name for device, _ in datasets) for name in names)
    colours = humidity_colours(humidity for _, humidity in datasets)
    held = {name: dataset["shape"].values.tolist() for (name, _), dataset in datasets.items()}
    subjects = [(name, shape) for name in names for shape in held[name]]
    figure, columns, lines = columns_of_panels(len(subjects), 1, at_most_double(1.5 * SINGLE), _PANEL + _ENTRY * most)
    for panel, (name, shape) in zip(columns[:, 0], subjects, strict=True):
        cases = {rh: dataset.sel(shape=shape) for (device, rh), dataset in datasets.items() if device == name}
        named = []
        for humidity, dataset in cases.items():
            _shares(panel, dataset, colours[humidity])
            label = f"{Air(humidity).words}{_at_length(dataset)}{_marks(numbers, name, humidity)}"
            named.append(Line2D([], [], color=colours[humidity], linewidth=3, label=label))
        legend_below(panel, named)
        if "length_of_device" in dataset:
            panel.axvline(TO_UM * float(dataset.length_of_device), color="0.4", linestyle=":", linewidth=0.8)
        shares = np.concatenate([dataset.share.values for dataset in cases.values()])
        panel.set(
            yscale="log", ylim=(shares.min() / 2, 1.3), xlabel=on_own_axes("length of the device [µm]", columns.T)
        )
    for line in lines:
        line[0, 0].set_ylabel("P(stuck), simulated [–]")
    titles = [f"{name}, {END_STATES[shape].title}" for name, shape in subjects]
    letter_lines(lines, [_filled(title, figure, lines[0].shape[1]) for title in titles])
    _explain(columns[0, 0], datasets)
    legend_outside(figure, handles(columns[0, 0]), "upper", 4 if len(subjects) > 1 else 3)
    if below := refer_to_warnings(figure, warnings):
        figure.supxlabel(below, fontsize=7, ha="left", x=0.01)
    return figure


def _at_length(dataset):
    """P(stuck) at the length that a device states, for the legend."""
    if "length_of_device" not in dataset:
        return ""
    stuck, *band = map(float, dataset.stuck_at_length)
    text = f"{100 * stuck:.3g} %" if 0 < stuck < 1 else fraction_with_band(stuck, *band, " %")
    return f": {text} at {TO_UM * float(dataset.length_of_device):g} µm"


def _marks(numbers: Mapping[tuple, Iterable[int]], *subject) -> str:
    """Numbers of the warnings about all shapes of a subject."""
    return _marks_of_warnings({k for (*about, _), marks in numbers.items() if tuple(about) == subject for k in marks})


def _marks_of_warnings(numbers):
    """Numbers of warnings as marks in a label."""
    return "".join(f" ({k})" for k in sorted(numbers))


def _shares(panel: Axes, curve, colour):
    """P(stuck) of a device at one humidity in one end state, its band and its safe lengths."""
    length, drawn = TO_UM * curve.length.values, curve.stuck.values > 0
    line = END_STATES[str(curve["shape"].values)].lines[0]
    panel.plot(length[drawn], curve.stuck.values[drawn], line, color=colour)
    panel.fill_between(length[drawn], *curve.stuck_band.values[:, drawn], color=colour, alpha=0.2, linewidth=0)
    for share in curve.share.values:
        safe = curve.sel(share=share)
        panel.plot(TO_UM * float(safe.safe_length), share, _BASES[str(safe.basis.values)], color=colour)


def _explain(panel, datasets):
    """Add the used line styles and markers to the legend of a panel. Equal lines share an entry."""
    legends: dict[str, list[str]] = {}
    for shape, state in END_STATES.items():
        if any(shape in dataset["shape"].values for dataset in datasets.values()):
            legends.setdefault(state.lines[0], []).append(state.legend)
    for line, held in legends.items():
        label = " / ".join([held[0], *(legend.removeprefix("held by ") for legend in held[1:])])
        panel.plot([], [], line, color="0.3", label=label)
    if any("length_of_device" in dataset for dataset in datasets.values()):
        panel.plot([], [], ":", color="0.4", linewidth=0.8, label="length of the device")
    for basis, mark in _BASES.items():
        if any(basis in dataset.basis.values for dataset in datasets.values()):
            panel.plot([], [], mark, color="0.3", label=f"simulated limit, {basis}")


@styled
def chart(
    datasets: Mapping[tuple[str, float], xr.Dataset],
    warnings: Mapping[tuple[str, float, float, str], list],
    answers: Mapping[str, tuple[float, float, Answer]] | None = None,
) -> Figure:
    """Simulated limit of lengths against the relative humidity for the middle one of the shares.

    Each device, gap and shape has a panel: a tip holds beams that are so much shorter that one axis would hide them.
    The panel of all that can hold a device is first, and has its sizes to build, from the thickness [m], gap [m] and
    answer by device. Dry air is beside the axis. The numbers of the warnings, by name, thickness [m], gap [m] and
    shape, mark the curves; there may be none.
    """
    numbers = numbered(warnings)
    wholes = axes(datasets)
    placed = {name: places(dataset.relative_humidity.values.tolist()) for name, dataset in wholes.items()}
    subjects = [
        (name, *at)
        for name, dataset in wholes.items()
        for at in product(dataset.gap.values, dataset["shape"].values[::-1])
    ]
    figure, columns, lines = columns_of_panels(len(subjects), 1, at_most_double(1.5 * SINGLE), _PANEL)
    drawn = list(zip(columns[:, 0], subjects, strict=True))
    built = {}
    for panel, (name, gap, shape) in drawn:
        curves = wholes[name].sel(gap=gap, shape=shape)
        marks = {t: _marks_of_warnings(numbers.get((name, t, gap, shape), ())) for t in curves.thickness.values}
        built[panel] = _lines_of_chart(panel, name, curves, (answers or {}).get(name), placed[name], marks)
    titles = [
        f"{name}, gap {TO_UM * gap:g} µm, {END_STATES[shape].title}{_BUILD_THESE * bool(built[panel])}"
        for panel, (name, gap, shape) in drawn
    ]
    letter_lines(lines, [_filled(title, figure, lines[0].shape[1]) for title in titles])
    _legend_of_chart(figure, columns[:, 0], refer_to_warnings(figure, warnings))
    figure.draw_without_rendering()  # lays the panels out, so that words can be clear of lines
    for panel, sizes in built.items():
        for size in sizes:
            _name_size(panel, *size)
    return figure


def _lines_of_chart(panel, name, curves, of_device, placed, marks):
    """Limits in one gap and shape, with marks of warnings by thickness; sizes to build, of which words follow."""
    thickness, gap, answer = of_device or (np.nan, np.nan, None)
    shape = str(curves["shape"].values)
    has_its_gap = np.isclose(curves.gap, gap, rtol=1e-6, atol=0)
    is_its_own = has_its_gap & np.isclose(curves.thickness, thickness, rtol=1e-6, atol=0)
    _thicknesses(panel, curves, shape, placed, is_its_own)
    sizes, is_whole = [], not END_STATES[shape].only_if
    if has_its_gap and is_whole:
        (colour,) = shades(curves.sizes["thickness"])[np.flatnonzero(is_its_own)] if is_its_own.any() else (BUILD,)
        sizes = _mark_sizes_to_build(panel, _limits(curves.isel(thickness=is_its_own)), answer, placed, colour)
    low, high = panel.dataLim.intervaly
    panel.set(xlabel="relative humidity [–]", ylabel=_OF_CHART, ylim=(0.95 * low, high + _ROOM * (high - low)))
    humidity_axis(panel, placed)
    style = {"xycoords": "axes fraction", "ha": "right", "va": "top", "fontsize": 7, "path_effects": OUTLINED}
    panel.annotate("above each line: more stick", (0.98, 0.98), **style)
    own = [f" ({name})" * int(is_own) for is_own in is_its_own]
    _name_thicknesses(panel, curves, [f"{who}{mark}" for who, mark in zip(own, marks.values(), strict=True)])
    return sizes


def _legend_of_chart(figure, panels_of_chart, reference):
    """Legend below all panels: lines, then bands, then words without a line."""
    shown = sorted(zip(*handles(*panels_of_chart), strict=True), key=lambda entry: isinstance(entry[0], PolyCollection))
    words = ["axes of panels differ" * (len(panels_of_chart) > 1), reference]
    shown += [(Line2D([], [], linestyle=""), text) for text in words if text]
    legend_outside(figure, ([entry for entry, _ in shown], [_filled(text, figure) for _, text in shown]), "lower", 2)


def _limits(curves):
    """Simulated limits for the middle one of the shares, by thickness and humidity [µm]."""
    return TO_UM * curves.safe_length.sel(share=_middle(curves)).transpose("thickness", "relative_humidity")


def _mark_sizes_to_build(panel, limits, answer, placed, colour):
    """Mark the size to build of a device in each stated air, and in all of them where it is decided.

    A line in the colour of its thickness leads to each from the simulated limit of a beam of this, if the chart has it
    (1 or 0, humidity): the mark can be on the curve of another thickness. There are none if a limit forbids them.

    Returns
    -------
    list of tuples
        Words on each size, its place on the axis, and the ends of its line [µm].
    """
    if is_forbidden(answer) or not np.isfinite(answer.build):
        return []
    decides, sought, stricter = answer.together.humidity, answer.sought, unasked(answer)
    label = f"to build {answer.device}: {to_build(answer)}"
    alone = {air.humidity: air.build for air in answer.airs if air.humidity != decides and np.isfinite(air.build)}
    beside = f", but {listed(stricter)}" if stricter else ""
    only = f"to build {answer.device} in this air alone{beside}"
    styles, named = ({"markerfacecolor": "white", "label": only}, {"label": label}), []
    for sizes, style in zip((alone, {decides: answer.build}), styles, strict=True):
        for humidity, size in sizes.items():
            at, height = placed.get(humidity, humidity), TO_UM * size
            limit = limits.sel(relative_humidity=limits.relative_humidity == humidity).values.ravel()[:1]
            for top in limit:
                style_of_line = {"color": colour, "linewidth": _WIDTHS[True], "zorder": 3}
                panel.plot([at, at], [height, top], **style_of_line, label=_LED.format(name=answer.device))
            panel.plot(at, height, "D", color=BUILD, markersize=6, zorder=4, linestyle="", path_effects=_HALO, **style)
            number = f"{answer.device}: {bounding(size / sought.scale, 3, sought.more_is_better)}"
            words = [number, *stricter[:1]] if humidity == decides else [number]
            named.append((textwrap.fill(", but ".join(words), _NARROW), at, (height, *limit)))
    return named


#: What the line of a size to build is, in the legend.
_LED = "from the curve of {name} down to its size to build"
#: Longest line of the words on a size to build [characters], and steps by which they are raised [points].
_NARROW, _STEPS = 20, range(2, 80, 2)
#: Parts of a line, from its lower end, beside which words on a size to build are.
_PARTS_OF_LINE = (0.5, 0.3, 0.7, 0.15, 0.85)


def _name_size(panel, words, at, heights):
    """Words on a size to build beside its line, best at its middle, or above it along a thin one, clear of all lines.

    They are below the size where nothing else is clear, also with the name on a line of its own.
    """
    style = {"textcoords": "offset points", "fontsize": 7, "linespacing": 1, "path_effects": OUTLINED, "zorder": 5}
    text, top = panel.annotate(words, (at, max(heights)), (0, 0), color=BUILD, **style), max(heights)
    beside = [(np.quantile(heights, part), 0, "center") for part in _PARTS_OF_LINE]
    above = [(top, up, "bottom") for up in _STEPS]
    anywhere = [*beside, *above, (min(heights), -3, "top")]
    in_lines = words, words.replace(": ", ":\n", 1)
    for shown, (height, up, vertical), (apart, side) in product(in_lines, anywhere, ((5, "left"), (-5, "right"))):
        text.xy = at, height
        text.set(text=shown, position=(apart, up), ha=side, va=vertical)
        if _is_clear(panel, text):
            break
    if vertical == "bottom":
        end = text.get_window_extent().transformed(panel.transData.inverted()).y0
        panel.plot([at, at], [top, end], color=BUILD, linewidth=0.6)


def _is_clear(panel, text):
    """Whether a text lies within its panel, on none of its lines and none of its other texts."""
    box = text.get_window_extent()
    paths = [line.get_path().transformed(line.get_transform()) for line in panel.lines if len(line.get_xdata())]
    others = [other.get_window_extent() for other in panel.texts if other is not text]
    return panel.bbox.count_contains(box.corners()) == len(box.corners()) and not any(
        (
            *(path.intersects_bbox(box, filled=False) or box.count_contains(path.vertices) for path in paths),
            *(box.overlaps(other) for other in others),
        )
    )


#: White edge of a marker, so that it stands apart from curves.
_HALO = [withStroke(linewidth=3, foreground="white")]


def _write(panel, text, point, apart, **style):
    """Small words beside a point of a panel, some points apart from it."""
    outlined = {"textcoords": "offset points", "fontsize": 7, "path_effects": OUTLINED}
    panel.annotate(text, point, apart, **outlined, **style)


def _middle(curves):
    """Middle one of the shares of a chart."""
    return float(curves.share.values[len(curves.share) // 2])


def _thicknesses(panel, curves, shape, placed, is_its_own):
    """Curves of all thicknesses of one device, gap and shape, their bounds, and marks of power laws.

    Points are at the places of their humidities; no line leads to dry air. That of the device itself is thick.
    """
    share, (line, dotted) = _middle(curves), END_STATES[shape].lines
    shown = zip(curves.thickness.values, shades(curves.sizes["thickness"]), is_its_own, strict=True)
    for thickness, shade, is_thick in shown:
        for line_part, styles in _parts(curves.sel(thickness=thickness, share=share), (line, dotted)):
            at = [placed[humidity] for humidity in line_part.relative_humidity.values]
            by_law, lengths = line_part.by_elements.values == 0, TO_UM * line_part.safe_length
            fine, curve = _curve(at, lengths.values)
            panel.plot(fine, curve, styles[0], color=shade, linewidth=_WIDTHS[is_thick])
            if np.isfinite(error := error_between(np.array(at), lengths.values)):
                ends = (1 - error) * curve, (1 + error) * curve
                panel.fill_between(fine, *ends, color=shade, alpha=0.2, linewidth=0, label="error between the dots")
            panel.plot(np.array(at)[by_law], lengths[by_law], "o", color=shade, fillstyle="none")
            panel.plot(np.array(at)[~by_law], lengths[~by_law], ".", color=shade)
            panel.plot(*_curve(at, TO_UM * line_part.flooded_length.values), styles[1], color=shade, linewidth=0.8)
    _explain_chart(panel, curves.sel(share=share), shape)
    _name_flat_surfaces(panel, TO_UM * curves.flooded_length)


def _name_flat_surfaces(panel, lengths):
    """Name the bounds of flat surfaces [µm] at the left end of the longest ones that are known."""
    first = lengths.isel(relative_humidity=0)
    if np.isfinite(first).any():
        _write(panel, "flat surfaces", (panel.dataLim.x0, float(first.max())), (2, 1), va="bottom")


#: Widths of curves, of a beam of another thickness and of the device itself [points].
_WIDTHS = {False: 1.1, True: 2.0}


def _explain_chart(panel, curves, shape):
    """Add what lines and markers of one share are to the legend of a panel."""
    line, by = END_STATES[shape].lines[0], END_STATES[shape].by
    panel.plot([], [], line, color="0.3", marker=".", label=f"{one_in(float(curves.share))} stick by {by}")
    if not curves.by_elements.all():
        label = f"by a power law, ± {in_percent(float(curves.power_law_error.max()))}"
        panel.plot([], [], "o", color="0.3", fillstyle="none", label=label)


def _name_thicknesses(panel, chart_curves, marks):
    """Name every known curve of a chart to the right of its panel, at its last point but clear of the names below."""
    (low, high), below = panel.get_ylim(), -np.inf
    finite = [curve[np.isfinite(curve)] for curve in _limits(chart_curves).values]
    named = zip(finite, chart_curves.thickness.values, shades(len(marks)), marks, strict=True)
    for curve, thickness, shade, mark in sorted(
        (entry for entry in named if len(entry[0])), key=lambda entry: entry[0][-1]
    ):
        below = max((curve[-1] - low) / (high - low), below + _APART)
        style = {"xycoords": "axes fraction", "color": shade, "fontsize": 7, "va": "center"}
        panel.annotate(f"{TO_UM * thickness:g} µm thick{mark}", (1.02, below), **style)


def _curve(at, lengths):
    """Curve through computed lengths (n,) along an axis: the cubic between enough of them, otherwise lines."""
    if len(at) < FEWEST_HUMIDITIES or not np.isfinite(lengths).all():
        return at, lengths
    fine = np.linspace(at[0], at[-1], _POINTS)
    return fine, between(np.array(at), lengths, fine)


def _parts(curves, lines):
    """Lengths along the axis, as lines, and in dry air, as markers, each with the styles of lengths and bounds."""
    humid = is_humid(curves.relative_humidity.values)
    parts = (curves.isel(relative_humidity=humid), lines), (curves.isel(relative_humidity=~humid), ("D", "_"))
    return [(dataset, styles) for dataset, styles in parts if dataset.sizes["relative_humidity"]]


def own_sizes(section: Mapping[str, Any]) -> tuple[float, float]:
    """Thickness and gap of a beam [m]."""
    return section["thickness_um"] * UM, section["gap_um"] * UM


def _chart(data, settings):
    """Figure of charts from their datasets, answers and limits."""
    answers = of_datasets(data["answers"], data["warnings"])
    sizes_and_answers = {name: (*settings["sizes"][name], answer) for name, answer in answers.items()}
    return chart(data["charts"], device_warnings.read(data["warnings"]).curves, sizes_and_answers)


STAGES = (
    figure_stage(
        "chart",
        "simulated limit against relative humidity",
        "Devices",
        inputs=lambda plan, at: (
            charts(plan)
            | {"answers": by_name("devices/answer", plan.devices.with_chart)}
            | {"warnings": device_warnings.files_of(*plan.devices.with_chart)}
        ),
        settings=lambda plan, at: {
            "sizes": {name: own_sizes(plan.devices.sections[name]) for name in plan.devices.with_chart}
        },
        compute=_chart,
        jobs=lambda plan: [{}] if plan.devices.with_chart else [],
        targets=("devices",),
    ),
)
