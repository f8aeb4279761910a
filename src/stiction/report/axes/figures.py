"""Figures along an axis: curves of a device with bands, maps of its margin over two axes, and laws of surfaces."""

import textwrap

import numpy as np
import xarray as xr
from matplotlib.collections import Collection
from matplotlib.colors import CenteredNorm
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import MultipleLocator

from stiction.config.surfaces import process
from stiction.contact.air import Air
from stiction.devices.risk import one_in
from stiction.report.axes.axis import axes_of
from stiction.report.axes.labels import Label, put
from stiction.report.axes.roughness import (
    crossings_of,
    flats_suffice,
    is_unknown,
    ranges_of,
    smoother_than_known,
    sure_in_short,
)
from stiction.report.format import TO_NM, TO_UM
from stiction.report.style import (
    BUILD,
    DOUBLE,
    INTERVAL,
    OUTLINED,
    SINGLE,
    columns_of_panels,
    figure_stage,
    handles,
    humidity_colours,
    legend_outside,
    letter,
    panels,
    plain_log,
    styled,
)
from stiction.stages.axes.law import law_of, plain
from stiction.stages.axes.margins import PARTS
from stiction.stages.axes.requirement import margins_of, sought_of
from stiction.stages.axes.roughness import KURTOSIS, curves_of
from stiction.stages.devices.end_states import END_STATES

#: Quantities of a surface on an axis: words and function of the unscaled quantity.
_SHOWN = {
    "rms": ("rms [nm]", lambda values: TO_NM * np.exp(values)),
    "skewness": ("skewness [–]", lambda values: values),
    "kurtosis": ("kurtosis [–]", lambda values: values),
    "corner": ("corner of the spectrum [rad/µm]", lambda values: np.exp(values) / TO_UM),
    "slope": ("slope of the spectrum [–]", lambda values: values),
}
#: Number of values along a law.
_POINTS = 101
#: Numbers along a logarithmic axis of less than a decade.
_WITHIN_A_DECADE = (1, 1.5, 2, 3, 4, 6, 8)
#: Width of a figure of curves, for text of 11 pixels where it is 390 pixels wide, and height of a panel [in].
_WIDE, _HIGH = 3.4, 2.8
#: Line along the required value where it is sure.
_SURE = {"linewidth": 3.5, "alpha": 0.6}
#: Colour of surfaces whose full contact is unknown, and least value between these and others.
_UNKNOWN, _LEAST = "0.85", 1e-6
#: Colour of the best setting where none suffices.
_NOT_ENOUGH = "0.4"
#: Part of a panel of a process that is free of curves at its bottom and its top.
_FREE = 0.14
#: Longest line of a label [characters].
_LONGEST = 36
#: Least part of a panel between its required value and each end, for words of two lines.
_WORDS = 0.2
#: Decades of a map from which each is named, in place of its half, too.
_MANY = 4
#: Start of the label of flat surfaces.
_FLAT = "flat surfaces"


# Curves


@styled
def roughness(dataset: xr.Dataset) -> Figure:
    """Estimate with its band of 95 %, simulated limit and crossings with the required one. A panel for each end state.

    Of a map, the curve with the second quantity as given is drawn.
    """
    curves = curves_of(dataset)
    as_given = (curve for curve in curves if "other" not in curve.coords or curve.other == curve.other_given)
    curve = next(as_given)
    axis, given = axes_of(curve)[0], float(curve.given)

    def marks(panel, shape):
        """The given roughness, what a dash means at any humidity, and the crossings in words."""
        panel.axvline(axis.in_unit(given), color="0.6", linestyle=":", label=f"as given: {axis.at(given)}")
        if not flats_suffice(curve, shape):
            _veil(panel, curve, alpha=0.65, zorder=2.5, label="full contact unknown: more stick than drawn")
        panel.plot([], [], "_", color="0.3", markersize=8, label="simulated limit")
        sure = "sure, exact inputs: simulated limit meets it, 95 %"
        panel.plot([], [], color="0.3", **_SURE, solid_capstyle="butt", label=sure)
        if any(crossings_of(curve, humidity, shape).sizes["crossing"] for humidity in curve.humidity.values):
            panel.plot([], [], "o", color="0.3", fillstyle="none", label="estimate meets it, bar: two-sided 95 %")
        return _crossings(curve, shape)

    return _curves(curve, _simulated, marks, "dashes {side} it release")


def _veil(panel, data, **style):
    """Mark surfaces that are smoother than the smoothest one with full contact, where they are on the unsafe side."""
    if ends := smoother_than_known(data):
        panel.axvspan(*ends, color=_UNKNOWN, linewidth=0, **style)


@styled
def devices(curve: xr.Dataset, recommended: xr.Dataset, device: str) -> Figure:
    """Estimate of a device over a process variable, with its 95 % bands, the required value and the best setting.

    A panel for each end state. Grey: the settings that suffice at all humidities and against all end states.
    """
    settings = recommended.sel(who=device)
    ranges = settings.sufficient.values[np.isfinite(settings.sufficient.values[:, 0])]

    def marks(panel, _shape):
        """Settings that suffice, and the best one."""
        for ends in ranges:
            panel.axvspan(*ends, color="0.9", zorder=0, label="next run suffices, 95 %")
        if np.isfinite(float(settings.best)):
            _best(panel, settings)
        return []

    return _curves(curve, _band, marks, "sure where the whole outer band is {side}")


def _curves(curve, draw, mark, releases):
    """Figure of a curve: ``draw`` draws it at a humidity, ``mark`` what is common to a panel, and returns labels.

    ``releases`` says on which side a device releases.
    """
    shapes = _strictest_first(curve)
    figure, axes = panels(len(shapes), 1, (_WIDE, _HIGH * len(shapes)))
    sought, level = sought_of(curve), TO_UM * float(curve.required)
    side = "below" if sought.more_is_better else "above"
    words = f"{sought.required} {sought.in_words(float(curve.required))}: {releases.format(side=side)}"
    for panel, shape in zip(axes[:, 0], shapes, strict=True):
        for humidity, colour in humidity_colours(curve.humidity.values.tolist()).items():
            draw(panel, curve.sel(humidity=humidity, shape=shape), colour)
        panel.axhline(level, color="black", linewidth=0.8, label=words)
        panel.set_yscale("log")
        labels = mark(panel, shape)
        _plain(panel.yaxis)
        _show(panel.xaxis, panel.set_xscale, curve, axes_of(curve)[0])
        panel.set_ylabel(f"{sought.label} at which\n{one_in(float(curve.share))} sticks [{sought.shown}]")
        _make_room(panel, level)
        put(panel, level, labels)
    letter(axes, _held_by(shapes))
    entries = zip(*handles(*axes[:, 0]), strict=True)
    lines_first = sorted(entries, key=lambda entry: (isinstance(entry[0], Collection), entry[1].startswith(_FLAT)))
    legend_outside(figure, tuple(zip(*lines_first, strict=True)), "lower", 2)
    return figure


def _make_room(panel, level):
    """Extend a logarithmic panel at its ends until words fit between them and a level."""
    bottom, top = panel.get_ylim()
    reach = _WORDS / (1 - _WORDS)
    panel.set_ylim(min(bottom, level * (level / top) ** reach), max(top, level * (level / bottom) ** reach))


def _strictest_first(curve):
    """End states of a curve, beginning with the one that decides."""
    return list(map(str, curve["shape"].values[::-1]))


def _held_by(shapes, end=""):
    """What holds a device in each end state, for the titles of panels; nothing where there is one."""
    return [END_STATES[shape].title + end for shape in shapes] if len(shapes) > 1 else [""]


def _simulated(panel, line, colour):
    """Estimate along a roughness with its band, simulated limits, and where both meet the required value."""
    axis, shape = axes_of(line)[0], str(line["shape"].values)
    x, estimate = axis.in_unit(line.roughness.values), TO_UM * line.estimate.values
    reach = INTERVAL * TO_UM * line.error.values
    panel.fill_between(x, estimate - reach, estimate + reach, color=colour, alpha=0.2, linewidth=0)
    nowhere = ": nowhere enough" * bool((margins_of(line) <= 0).all())
    words = f"{Air(float(line.humidity)).words}, estimate and 95 % band{nowhere}"
    panel.plot(x, estimate, ".-", color=colour, label=words)
    panel.plot(x, TO_UM * line.safe.values, "_", color=colour, markersize=8)
    if np.isfinite(line.bound.values).any():
        style, label = END_STATES[shape].lines[1], f"{_FLAT}, {END_STATES[shape].by}"
        panel.plot(x, TO_UM * line.bound.values, style, color=colour, linewidth=0.8, label=label)
    sure = [] if END_STATES[shape].only_if else axis.in_unit(ranges_of(line, float(line.humidity), shape))
    for ends in sure:
        panel.hlines(TO_UM * float(line.required), *ends, color=colour, **_SURE)
    crossed = crossings_of(line, float(line.humidity), shape)
    if crossed.sizes["crossing"]:
        places, errors = (axis.in_unit(crossed[name].values) for name in ("crossing_place", "crossing_error"))
        height = np.full(len(places), TO_UM * float(line.required))
        panel.errorbar(places, height, xerr=INTERVAL * errors, fmt="o", color=colour, fillstyle="none", zorder=3)


def _crossings(curve, shape):
    """Labels of where the limit and the estimate meet the required value, and of humidities where all of it is enough.

    A place of the estimate has its 95 % interval, as its bar.
    """
    axis, labels, elsewhere = axes_of(curve)[0], [], {}
    for humidity, colour in humidity_colours(curve.humidity.values.tolist()).items():
        air, crossed = Air(humidity).words, crossings_of(curve, humidity, shape)
        places, sure = crossed.crossing_place.values, sure_in_short(curve, humidity, shape)
        for k, (crossing, reach) in enumerate(zip(places, INTERVAL * crossed.crossing_error.values, strict=True)):
            interval = f"{axis.text(crossing - reach)} to {axis.at(crossing + reach)}"
            estimate = f"estimate {axis.text(crossing)}, 95 %: {interval}"
            text = f"{air}: {estimate}" if k else textwrap.fill(f"{air}: {sure}", _LONGEST) + f"\n{estimate}"
            labels.append(Label(text, colour, axis.in_unit(crossing)))
        margin = margins_of(curve.sel(humidity=humidity, shape=shape))
        if not len(places) and (margin > 0).any():
            nearest = int(np.nanargmin(np.where(is_unknown(curve.sel(humidity=humidity)), np.inf, np.abs(margin))))
            elsewhere.setdefault((nearest, sure), {})[air] = colour
    for (nearest, sure), colours in elsewhere.items():
        text = textwrap.fill(f"{', '.join(colours)}: {sure}", _LONGEST)
        colour = next(iter(colours.values())) if len(colours) == 1 else "black"
        labels.append(Label(text, colour, axis.in_unit(curve.roughness.values[nearest])))
    return labels


def _band(panel, line, colour):
    """Estimate over a process, with the bands of the mean process and, on both sides of it, of the next run."""
    x, estimate = line.value.values, TO_UM * line.estimate.values
    mean, run = (
        np.exp(INTERVAL * np.sqrt(sum(line[f"{name}_error"].values ** 2 for name in names)))
        for names in (PARTS, (*PARTS, "run"))
    )
    panel.plot(x, estimate, ".-", color=colour, label=f"{Air(float(line.humidity)).words}, estimate")
    style = {"color": colour, "linewidth": 0}
    inner = "inner band: mean process, 95 %"
    panel.fill_between(x, estimate / mean, estimate * mean, alpha=0.35, label=inner, **style)
    for near, far in ((1 / mean, 1 / run), (mean, run)):
        panel.fill_between(x, estimate * near, estimate * far, alpha=0.15, label="outer band: next run, 95 %", **style)


def _best(panel, settings):
    """The best setting with its 95 % interval at the bottom of a panel, grey and open where no setting suffices."""
    along, best, (low, high) = axes_of(settings)[0], float(settings.best), map(float, settings.best_interval)
    suffices = bool(along.ranges(settings.sufficient.values))
    style = {"color": BUILD} if suffices else {"color": _NOT_ENOUGH, "markerfacecolor": "white"}
    bottom, top = panel.get_ylim()
    free = (top / bottom) ** _FREE
    panel.set_ylim(bottom / free, top * free)
    reach, across = np.maximum([[best - low], [high - best]], 0), panel.get_xaxis_transform()
    panel.errorbar(best, _FREE / 4, xerr=reach, fmt="D", markersize=4, transform=across, **style)
    label = ("best " if suffices else "best, but not sufficient: ") + along.at(best)
    label += f", 95 %: {along.text(low)} to {along.at(high)}" if low < high else ""
    fraction = (best - along.values[0]) / np.ptp(along.values)  # of the way across the panel
    alignment = {"ha": ("left", "center", "right")[int(np.clip(3 * fraction, 0, 2))], "va": "bottom", "fontsize": 7}
    alignment |= {"color": style["color"], "path_effects": OUTLINED}
    panel.annotate(label, (best, _FREE / 4), (0, 4), xycoords=across, textcoords="offset points", **alignment)
    if not suffices:
        panel.text(
            0.5,
            0.97,
            "no setting is sure to suffice in the next run",
            transform=panel.transAxes,
            ha="center",
            va="top",
            fontsize=7,
        )


def _plain(side):
    """Plain numbers along a logarithmic axis, more of them within a decade."""
    low, high = side.get_view_interval()
    plain_log(side, _WITHIN_A_DECADE if high < 10 * low else (1, 2, 5))


def _show(side, scale, data, axis):
    """Scale and label of an axis. A skewness has its kurtosis in brackets at every computed value."""
    side.set_label_text(axis.label)
    if axis.scale == "log":
        scale("log")
        _plain(side)
    if axis.name == "skewness":
        along = data[KURTOSIS].isel({other: 0 for other in data[KURTOSIS].dims if other != axis.dimension})
        pairs = zip(axis.values, along.values, strict=True)
        between = "\n" if side.axis_name == "x" else " "
        side.set_ticks(axis.values, [f"{at:.3g}{between}({kurtosis:.3g})".replace("-", "−") for at, kurtosis in pairs])
        side.set_label_text(f"{axis.label} (kurtosis)")


# Maps


@styled
def roughness_map(data: xr.Dataset) -> Figure:
    """Margin to the requirement, and lines of zero margin, against the two quantities of a dataset of stage roughness.

    The panels are by humidity and end state.
    """
    humidities, shapes = data.humidity.values, _strictest_first(data)
    size = min(DOUBLE, _WIDE * len(shapes)), _HIGH * len(humidities)
    figure, axes = panels(len(humidities), len(shapes), size)
    along, across = axes_of(data)
    for row, humidity in zip(axes, humidities, strict=True):
        for panel, shape in zip(row, shapes, strict=True):
            curve = data.sel(humidity=humidity, shape=shape).transpose("other", "roughness", ...)
            unknown, margin = is_unknown(curve).values, margins_of(curve)
            safe = np.where(unknown, np.nan, margins_of(curve, "safe"))
            _filled(panel, data, (margin, safe), sought_of(data).ratio)
            _hide(panel, data, margin, unknown)
            as_given = along.in_unit(float(data.given)), across.in_unit(float(data.other_given))
            panel.plot(*as_given, "k+", markersize=8, linestyle="none", zorder=3, label="surface as given")
    letter(axes, [f"{by}{Air(humidity).words}" for humidity in humidities for by in _held_by(shapes, ", ")])
    legend_outside(figure, handles(*axes.flat), "lower", 2)
    return figure


@styled
def process_map(margins: xr.Dataset, pairs: xr.Dataset) -> Figure:
    """Smallest margin of a device over two processes, with its lines of zero margin and the best pair."""
    figure, ((panel,),) = panels(1, 1, (1.5 * SINGLE, 3.4))
    _filled(panel, margins, (pairs.margin.values, pairs.safe.values), "smallest margin, as a factor", pairs)
    best, interval = pairs.best.values, pairs.best_interval.values
    across, up = np.abs(interval - best[:, None])[..., None]
    marks = {"fmt": "D", "color": "black", "markersize": 4, "label": "best, 95 % intervals", "clip_on": False}
    panel.errorbar(*best, xerr=across, yerr=up, **marks)
    legend_outside(figure, handles(panel), "lower", 2)
    return figure


def _filled(panel, computed, margins, label, shown=None):
    """Map of a margin with lines where it and its 95 % bound are zero, at the computed points or other ones shown."""
    x, y = (axis.in_unit(axis.values) for axis in axes_of(computed if shown is None else shown))
    levels = np.ma.masked_invalid(margins[0] / np.log(10))
    if levels.count():
        colours = panel.contourf(x, y, levels, 12, cmap="RdBu", norm=CenteredNorm())
        bar = panel.figure.colorbar(colours, ax=panel, label=label)
        bar.ax.yaxis.set_major_locator(MultipleLocator(0.5 if np.ptp(levels) < _MANY else 1))
        bar.ax.yaxis.set_major_formatter(lambda level, _: f"{10**level:.2g}")
        _name_sides(panel, *margins)
    _hatch(panel, x, y, *margins)
    lines = (("-", "estimate meets the requirement"), ("--", "with 95 % confidence too"))
    for values, (line, words) in zip(margins, lines, strict=True):
        if np.nanmin(values, initial=np.inf) < 0 < np.nanmax(values, initial=-np.inf):
            panel.contour(x, y, np.ma.masked_invalid(values), [0], colors="black", linestyles=line, zorder=2.2)
            panel.plot([], [], line, color="black", label=words)
    axes = axes_of(computed)
    points = np.meshgrid(*(axis.in_unit(axis.values) for axis in axes))
    panel.plot(*map(np.ravel, points), ".", color="0.3", markersize=2, label="computed")
    for side, scale, axis in zip((panel.xaxis, panel.yaxis), (panel.set_xscale, panel.set_yscale), axes, strict=True):
        _show(side, scale, computed, axis)


def _name_sides(panel, margin, safe):
    """Words in the corner with the largest margin if that is sure, and in the one with the smallest margin."""
    for values, words in ((safe, "releases"), (-margin, "sticks")):
        corners = np.nan_to_num(values[np.ix_([0, -1], [0, -1])], nan=-np.inf)
        row, column = np.unravel_index(np.argmax(corners), corners.shape)
        if corners[row, column] > 0:
            sides = {"ha": ("left", "right")[column], "va": ("bottom", "top")[row]}
            place = [(0.03, 0.97)[column], (0.03, 0.97)[row]]
            panel.text(*place, words, transform=panel.transAxes, **sides, fontsize=7, path_effects=OUTLINED)


def _hatch(panel, x, y, margin, safe):
    """Hatch where the estimate meets the requirement and its 95 % bound does not, or is unknown."""
    safe = np.where(np.isnan(safe), -np.abs(margin), safe)
    if np.nanmax(margin, initial=-np.inf) <= 0 or np.nanmin(safe, initial=np.inf) >= 0:
        return
    unsure = panel.contourf(x, y, np.ma.masked_invalid(safe), [-np.inf, 0], colors="none", hatches=["////"])
    _clip(panel, unsure, x, y, margin)
    entry = {"facecolor": "none", "edgecolor": "black", "linewidth": 0, "label": "met without 95 % confidence"}
    panel.add_patch(Rectangle((x[0], y[0]), 0, 0, hatch="////", **entry))


def _clip(panel, area, x, y, margin):
    """Clip an area of a map to where the estimate meets the requirement."""
    sufficient = panel.contourf(x, y, np.ma.masked_invalid(margin), [0, np.inf], colors="none")
    area.set_clip_path(sufficient.get_paths()[0], panel.transData)


def _hide(panel, data, margin, unknown):
    """Hide where the estimate meets the requirement, but full contact, in which more stick, is unknown (n, m)."""
    hidden = unknown & (margin > 0)
    if not hidden.any():
        return
    x, y = (axis.in_unit(axis.values) for axis in axes_of(data))
    area = panel.contourf(x, y, unknown, [_LEAST, 1], colors=[_UNKNOWN], zorder=2.1)
    _clip(panel, area, x, y, margin)
    entry = {"facecolor": _UNKNOWN, "linewidth": 0, "label": "full contact unknown: can stick"}
    panel.add_patch(Rectangle((x[0], y[0]), 0, 0, **entry))
    points = panel.transData.transform(np.stack(np.meshgrid(x, y), axis=-1)[hidden])
    middle = panel.transData.inverted().transform(points.mean(axis=0))
    panel.text(*middle, "unknown", ha="center", va="center", fontsize=7, zorder=3)


# Laws


@styled
def laws(law: xr.Dataset) -> Figure:
    """Quantities of a surface over a process variable: settings with their errors, and the law with its 95 % band."""
    fitted, names = law_of(law), list(map(str, law["quantity"].values))
    figure, columns, _ = columns_of_panels(len(names), 1, lambda count: min(DOUBLE, 2.4 * count), 2.2)
    values = np.linspace(*fitted.ends, _POINTS)
    curves = plain(fitted.at(values), fitted.covariance_at(values), names)
    points = plain(law.measured.values, law.errors.values, names)
    for k, (name, (panel, *_)) in enumerate(zip(names, columns, strict=True)):
        words, shown = _SHOWN[name]
        low, line, high = (shown(curves[0][:, k] + INTERVAL * sign * curves[1][:, k]) for sign in (-1, 0, 1))
        below, at, above = (shown(points[0][:, k] + INTERVAL * sign * points[1][:, k]) for sign in (-1, 0, 1))
        panel.fill_between(values, low, high, color="0.85", linewidth=0, label="95 % band of the law")
        panel.plot(values, line, color="black", label="law")
        panel.errorbar(
            law.setting.values, at, yerr=[at - below, above - at], fmt="o", markersize=3, label="settings, 95 %"
        )
        panel.set_xlabel(f"{process.words_of(law.variable)} [{process.unit_of(law.variable)}]")
        panel.set_ylabel(words)
    letter(columns[:, 0], [_SHOWN[name][0].partition(" [")[0] for name in names])
    legend_outside(figure, handles(columns[0][0]), "lower", 3)
    return figure


def _stage(file, shows, inputs, draw, names):
    """Stage for a figure of each of some devices or processes of a plan, the wildcard at the end of its file."""
    wildcard = file.rpartition("{")[2].rstrip("}")
    return figure_stage(
        file,
        shows,
        "Devices",
        inputs=inputs,
        compute=draw,
        jobs=lambda plan: [{wildcard: name} for name in names(plan)],
        targets=("devices",),
    )


def _roughness(_plan, at):
    """Dataset of a device over a roughness."""
    return {"roughness": f"devices/roughness/{at.device}"}


STAGES = (
    _stage(
        "roughness_{device}",
        "how rough the surfaces of {device} must be",
        _roughness,
        lambda data: roughness(data["roughness"]),
        lambda plan: plan.devices.over_roughness,
    ),
    _stage(
        "roughness_map_{device}",
        "how rough the surfaces of {device} must be, over two quantities",
        _roughness,
        lambda data: roughness_map(data["roughness"]),
        lambda plan: plan.devices.over_two_quantities,
    ),
    _stage(
        "process_{device}",
        "which settings of its process leave {device} free",
        lambda plan, at: {
            "curve": f"process/curves/{at.device}",
            "recommended": f"process/settings/{process.variable_of(plan.config, at.device)}",
        },
        devices,
        lambda plan: plan.devices.over_process,
    ),
    _stage(
        "process_law_{process}",
        "surface over the variable of process {process}",
        lambda plan, at: {"law": f"process/laws/{at.process}"},
        laws,
        lambda plan: process.used_processes(plan.config),
    ),
    _stage(
        "process_map_{device}",
        "which pairs of settings of two processes leave {device} free",
        lambda plan, at: {"map": f"process/maps/{at.device}", "pairs": f"process/pairs/{at.device}"},
        lambda data: process_map(data["map"], data["pairs"]),
        lambda plan: plan.devices.processed_twice,
    ),
)
