"""Pictures of answers: the steps from the estimate to the size to build, and P(stuck) around it."""

import textwrap
from collections.abc import Mapping
from itertools import chain, cycle

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stiction.answer.data import Answer, Cause
from stiction.contact.air import Air
from stiction.devices.probes import UNLIKELY
from stiction.devices.risk import one_in
from stiction.plan.names import by_name
from stiction.report.answer import tables, words
from stiction.report.format import safe_size
from stiction.report.html import with_minus
from stiction.report.style import (
    BUILD,
    DOUBLE,
    OUTLINED,
    SINGLE,
    at_most_double,
    columns_of_panels,
    figure_stage,
    handles,
    humidity_colour,
    legend_below,
    legend_outside,
    letter_lines,
    page_width,
    panels,
    styled,
)
from stiction.stages.devices import device_warnings

#: Colours of steps that are inside the answer, and of those beside it [Okabe and Ito].
_INSIDE, _BESIDE = "#0072B2", "0.6"
#: Height of a row of steps, of the rest, and of a panel of P(stuck) [in].
_ROW, _AROUND, _PANEL = 0.42, 1.3, 3.4
#: Label of the axis of P(stuck), and its lower end over the allowed fraction.
_STUCK, _LOWEST = "P(stuck) [–]", 1 / 30
#: Widest label of a step [characters].
_WIDE = 26
#: Colour and marker of sizes that are stricter than the size to build.
_STRICTER = {"color": "black", "marker": "v", "linestyle": "", "markersize": 6}
_IN_TITLES = "stricter sizes, in the titles"
#: Most characters of a line above one of three panels, and of a line of its legend.
_LINE = 38
#: Dashes of airs alone, in turn, and widths of the curves of all airs and of their mean [points].
_DASHES, _THICK, _THIN = ((0, (5, 2)), (0, (1.2, 1.2)), (0, (7, 2, 1.2, 2))), 2.0, 0.7
#: What curves mean, with their widths, by whether there is a size to build.
_MEANINGS = {
    True: {"at most so many stick (95 %)": _THICK, "mean over all cases": _THIN},
    False: {"mean": _THICK},
}
#: Place of the label of a fraction.
_LABEL = {"xycoords": ("axes fraction", "data"), "va": "bottom", "fontsize": 7, "path_effects": OUTLINED}


@styled
def ladder(answer: Answer) -> Figure:
    """Draw the steps from the estimate to the size to build that are known, one row each, and beside them P(stuck).

    The legend of P(stuck) is below its own panel.
    """
    figure, grid = panels(1, 2, (2 * SINGLE, _AROUND + _ROW * len(answer.known_steps)))
    _steps(grid[0, 0], answer)
    _stuck(grid[0, 1], answer, stricter=textwrap.fill(f"stricter: {'; '.join(words.stricter(answer))}", _LINE))
    grid[0, 1].set_ylabel(_STUCK)
    if entries := handles(grid[0, 1])[0]:
        legend_below(grid[0, 1], entries)
    return figure


def _steps(panel: Axes, answer):
    """Steps from the estimate to the size to build, one row each, with its size and change beside the panel."""
    (scale, label), steps = _axis(answer), answer.known_steps
    before, rows = steps[0].size, range(len(steps))
    for row, step in enumerate(steps):
        colour, ends = _INSIDE if step.stated else _BESIDE, np.array([before, step.size]) / scale
        panel.plot(ends, [row, row], color=colour, linewidth=5, solid_capstyle="butt")
        panel.plot(ends[1], row, "|", color=colour, markersize=11)
        before = step.size if step.stated else before
    if np.isfinite(answer.build):
        panel.axvline(answer.build / scale, color=BUILD, linewidth=1.2, zorder=0)
    panel.margins(x=0.1)
    panel.set(xlabel=label, ylim=(len(steps) - 0.5, -0.8))
    panel.set_yticks(rows, [_label_of_row(answer, row) for row in rows], fontsize=7, linespacing=1)
    panel.tick_params(axis="y", length=0)
    _stated(panel, answer, scale)


def _label_of_row(answer, row):
    """Words on a row of the ladder with its size and change."""
    step = answer.known_steps[row]
    change = with_minus(f" ({100 * (step.factor - 1):+.1f} %)") if row else ""
    return f"{textwrap.fill(words.step_in_words(answer, step), _WIDE)}\n{safe_size(step.size, answer.sought)}{change}"


def _stated(panel, answer, scale):
    """Stated size of a device: a line among its steps, or its name at the edge of the panel that it is beyond."""
    sizes = [step.size for step in answer.known_steps]
    if 0.5 * min(sizes) < answer.size < 2 * max(sizes):
        panel.axvline(answer.size / scale, color="0.3", linestyle=":", linewidth=1, zorder=0)
    elif np.isfinite(answer.size):
        text_of_size, below = f"yours: {answer.in_words(answer.size)}", answer.size < min(sizes)
        text, at = (f"← {text_of_size}", 0.01) if below else (f"{text_of_size} →", 0.99)
        style = {"xycoords": "axes fraction", "ha": "left" if below else "right", "va": "top", "fontsize": 7}
        panel.annotate(text, (at, 0.98), **style)


def _axis(answer):
    """Unit of the sizes of an answer, and the label of their axis."""
    return answer.sought.scale, f"{answer.sought.label} [{answer.sought.shown}]"


@styled
def risk(answers: Mapping[str, Answer]) -> Figure:
    """P(stuck) with all that is unknown inside, against the size, one panel for each device."""
    figure, columns, lines = columns_of_panels(len(answers), 1, at_most_double(SINGLE), _PANEL)
    for panel, answer in zip(columns[:, 0], answers.values(), strict=True):
        _stuck(panel, answer)
    for line in lines:
        line[0, 0].set_ylabel(_STUCK)
    for panel, answer in zip(columns[:, 0], answers.values(), strict=True):
        if answer.pull_offs:
            panel.set_ylabel(f"{answer.sought.fraction} [–]")
    letter_lines(lines, [_title(name, answer) for name, answer in answers.items()])
    _explain(figure, columns[:, 0])
    return figure


def _title(name, answer):
    """Name and kind of a device, and below it the sizes that are stricter than the size to build."""
    stricter = [] if words.is_forbidden(answer) else words.stricter(answer)
    lines = [_wrapped(f"stricter: {size}") for size in stricter]
    return "\n".join([f"{name}, {answer.kind}", *chain.from_iterable(lines)])


def _wrapped(line):
    """Line above one of three panels, or above one on a page, as lines that fit there, with a humidity whole."""
    fitting = int(_LINE * page_width(DOUBLE / 3) / (DOUBLE / 3))
    return textwrap.wrap(line.replace("RH ", "RH\N{NO-BREAK SPACE}"), fitting)


def _stuck(panel: Axes, answer, stricter=_IN_TITLES):
    """Bound of P(stuck) in all stated airs, dashed in each of the others alone, its mean, and the size to build.

    Without a size to build, means are drawn in place of bounds, with the band of all airs. Sizes that are ``stricter``
    are named in the legend.
    """
    scale, label = _axis(answer)
    panel.set_xlabel(label)
    if words.is_forbidden(answer) or not answer.sizes.size:
        panel.set(xticks=[], yticks=[])
        panel.text(0.5, 0.5, words.sign_of(answer)[1], ha="center", transform=panel.transAxes)
        return
    _curves(panel, answer, scale)
    legend_below(panel, panel.get_legend_handles_labels()[0])
    for label, width in _MEANINGS[bool(np.isfinite(answer.build))].items():
        panel.plot([], [], color="0.3", linewidth=width, label=label)
    if np.isfinite(answer.share):
        panel.axhline(answer.share, color="0.4", linestyle=":", linewidth=0.8)
        at, side = (0.01, "left") if answer.sought.more_is_better else (0.99, "right")  # clear of marks
        panel.annotate("allowed", (at, answer.share), ha=side, **_LABEL)
    _size_to_build(panel, answer, scale)
    beside = _stricter(panel, answer, scale, stricter)
    sizes, lowest = answer.sizes / scale, _LOWEST * np.nan_to_num(answer.share, nan=UNLIKELY)
    left = 0 if answer.sought.more_is_better else min([sizes.min(), *(0.98 * size for size in beside)])
    panel.set(yscale="log", xlim=(left, max([sizes.max(), *(1.02 * size for size in beside)])), ylim=(lowest, 1.3))
    panel.yaxis.set_major_formatter(lambda share, _: "all" if share == 1 else one_in(share))


def _curves(panel, answer, scale):
    """P(stuck) in each stated air alone and, thick, in all of them."""
    has_build, is_together = np.isfinite(answer.build), len(answer.airs) > 1 and bool(np.isfinite(answer.share))
    together, alone = answer.together, " alone" * is_together
    others = [air for air in answer.airs if air.humidity != together.humidity]
    for air, dashes in zip(others, cycle(_DASHES), strict=False):
        sizes, fractions = _falling(*answer.at_most(air)) if has_build else (answer.sizes, air.curve[0])
        style = {"linestyle": dashes, "color": humidity_colour(air.humidity), "linewidth": 1.1}
        panel.plot(sizes / scale, fractions, **style, label=f"{Air(air.humidity).words}{alone}")
    colour, decides = humidity_colour(together.humidity), Air(together.humidity).words
    sizes, fractions = _falling(*answer.at_most(together)) if has_build else (answer.sizes, together.curve[0])
    label = f"all airs; {decides} decides" if is_together else decides
    panel.plot(sizes / scale, fractions, color=colour, linewidth=_THICK, label=label)
    if has_build:
        panel.plot(answer.sizes / scale, answer.curve[0], color=colour, linewidth=_THIN)
        return
    band = answer.curve[1:]
    style = {"color": colour, "alpha": 0.2, "linewidth": 0, "label": "its 95 % band"}
    panel.fill_between(answer.sizes / scale, *band, where=_resolved(band[1]), **style)


def _falling(sizes, fractions):
    """Bound of P(stuck) without the safer sizes at which it is no lower: nothing says that as many stick there."""
    return sizes, np.where(_resolved(fractions), fractions, np.nan)


def _stricter(panel, answer, scale, label):
    """Marks of the sizes that are stricter than the size to build, at the allowed fraction; these sizes."""
    beside = [limit.size for limit in (answer.between, *answer.unasked) if limit]
    sizes = [size / scale for size in beside if answer.sought.is_stricter(size, answer.build)]
    if sizes:
        panel.plot(sizes, [answer.share] * len(sizes), **_STRICTER, label=label)
    return sizes


def _resolved(upper):
    """Where an upper end is above its least value, which the simulation resolves no more, and next to it (n,)."""
    above = upper > upper.min()
    return np.convolve(above, np.ones(3), "same") > 0


def _explain(figure, panels):
    """Legend below a figure of what its panels have in common, without the airs in their own legends."""
    in_panels = {text.get_text() for panel in panels if (legend := panel.get_legend()) for text in legend.get_texts()}
    common = [(handle, label) for handle, label in zip(*handles(*panels), strict=True) if label not in in_panels]
    if common:
        legend_outside(figure, tuple(zip(*common, strict=True)), "lower", 3)


def _size_to_build(panel, answer, scale):
    """Vertical lines of the simulated limit, of the size to build, with its number, and of the stated size."""
    if np.isfinite(answer.build):
        (limit,) = (step.size for step in answer.steps if step.cause is Cause.SIMULATION)
        panel.axvline(
            limit / scale, color=BUILD, linestyle="--", linewidth=1, label="limit by simulation, exact inputs"
        )
        panel.axvline(answer.build / scale, color=BUILD, linewidth=1.5, label="to build: thick line at allowed")
        side, end = (3, "left") if answer.sought.more_is_better else (-3, "right")  # clear of the curve
        style = {"xytext": (side, -3), "textcoords": "offset points", "ha": end, "va": "top", "rotation": 90}
        label = f"build {safe_size(answer.build, answer.sought)}"
        panel.annotate(label, (answer.build / scale, 1), xycoords=("data", "axes fraction"), color=BUILD, **style)
    if answer.sizes.min() < answer.size < answer.sizes.max():
        panel.axvline(answer.size / scale, color="0.3", linestyle=":", linewidth=1, label="stated size")


STAGES = (
    figure_stage(
        "risk",
        "P(stuck) of devices against their size, and what to build",
        "Devices",
        inputs=lambda plan, at: {
            "answers": by_name("devices/answer", plan.devices.sections),
            "warnings": device_warnings.files_of(*plan.devices.sections),
        },
        compute=lambda data: risk(tables.of_datasets(data["answers"], data["warnings"])),
        jobs=lambda plan: [{}] if plan.devices.sections else [],
        targets=("devices",),
    ),
)
