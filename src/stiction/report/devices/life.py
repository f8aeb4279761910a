"""Life of devices: causes of contact, adhesion then, and ways to free them."""

import textwrap
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from stiction.answer.data import Answer
from stiction.answer.sought import FORCE, LENGTH, SOUGHT
from stiction.config.units import from_si
from stiction.constants import FREE_FALL
from stiction.contact.voltage import BREAKDOWN
from stiction.plan.names import by_name
from stiction.report import dots
from stiction.report.answer import tables, words
from stiction.report.format import MISSING, TO_MJ, TO_NM, TO_UM, TO_UN, bounding, fraction_between, listed, safe_size
from stiction.report.style import (
    BUILD,
    DOUBLE,
    figure_stage,
    legend_outside,
    letter,
    page_width,
    panels,
    styled,
)
from stiction.report.table import Table, table_stage
from stiction.rounding import is_equal
from stiction.stages.answer.beside import is_short, unsafe_end
from stiction.stages.devices import device_warnings
from stiction.stages.life.answers import FREE, HOLD, QUESTIONS, STICK, TOUCH, LifeRow, Name, answers_of

#: Units of the answers by those in SI: factor and text.
_UNITS = {
    "m": (TO_UM, "µm"),
    "V": (1.0, "V"),
    "V m-1": (1 / TO_NM, "V/nm"),
    "m s-2": (1 / FREE_FALL, "g"),
    "N": (TO_UN, "µN"),
    "N m-1": (1.0, "N/m"),
    "J m-2": (TO_MJ, "mJ/m²"),
    "1": (100.0, "%"),
    "rad": (from_si(1.0, "deg"), "°"),
}
#: Whether sizes are safe if they are rounded up, by their unit for readers.
_SAFE_SIDE = {sought.shown: sought.more_is_better for sought in SOUGHT.values()}
#: What the answers are, for the table and for pages.
CAPTION = (
    "The life of a device, in the order of a designer's questions: what brings a device into contact (touch), whether "
    "it then sticks (stick), what holds it (hold), what frees it (free). Every answer is between at least and at "
    "most, which are equal where the model leaves nothing open. A – means that no number is known, or that a key is "
    "missing, which the row then names. The column ± has the standard uncertainty of the lower bound, due to the "
    "stated uncertainties of the device or to sampled surfaces. For a beam, voltage, shock, energy and force are "
    "computed at its stated length, without one at its least simulated limit. A liquid that dries is not humid air: it "
    "holds the whole area that it wets. Lengths and forces are simulated limits with exact inputs: build the size of "
    "the answer, which has everything inside."
)
_COLOURS = dict(zip(QUESTIONS, ("#0072B2", "#C98500", "#CC79A7", "#009E73"), strict=True))
#: What each question asks.
_QUESTIONS = {
    TOUCH: "touch: what brings it into contact",
    STICK: "stick: whether it then sticks",
    HOLD: "hold: what holds it",
    FREE: "free: what frees it",
}
#: Colours of a limit that does not allow the size to build, and of others, whose inputs are exact.
_SHORT, _EXACT = "#B00020", "0.3"
#: Markers of a limit with the errors of the inputs, and of a length below which an unknown one is safe. Ground of sizes
#: that a row does not allow.
_DECIDES, _BELOW, _FORBIDDEN = "D", "<", {"color": _SHORT, "alpha": 0.08, "linewidth": 0, "zorder": -1}
#: What is safer, by whether more of a size is better.
_SAFER = {False: "shorter", True: "stronger"}
#: Heights of the legend and of a further line of a title, and largest height of the figure [in]. Share of its width for
#: labels, and mean width of their characters [in]. Characters of a title by width [1/in]. Room on the safe side of an
#: axis, over its length.
_LEGEND, _TITLE, _TALLEST, _LABELS, _CHARACTER, _TITLED, _ROOM = 0.3, 0.15, 100.0, 0.38, 0.045, 9, 0.1


def table(life: Mapping[str, xr.Dataset]) -> Table:
    """Answers about all devices, one row each."""
    rows = []
    for device, dataset in life.items():
        for answer in answers_of(dataset):
            factor, unit = _UNITS[answer.unit]
            numbers = {"at_least": answer.low, "at_most": answer.high, "standard_uncertainty": answer.error}
            head = {"device": device, "length_um": TO_UM * float(dataset.length), "question": answer.question}
            scaled = {name: factor * value for name, value in numbers.items()}
            tail = {"unit": unit, "form": answer.form, "source": answer.source, "needs": answer.needs}
            rows.append(head | {"answer": str(answer.name), "what": answer.what} | scaled | tail)
    columns = {
        "device": (str, "device"),
        "question": (str, "question"),
        "what": (str, "what"),
        "at least": (lambda *ends: bounds_in_words(*ends)[0], "at_least", "at_most", "unit"),
        "at most": (lambda *ends: bounds_in_words(*ends)[1], "at_least", "at_most", "unit"),
        "±": (lambda error: significant(float(f"{error:.2g}")), "standard_uncertainty"),
        "unit": (str, "unit"),
        "form": (lambda form, needs: f"unknown: state {needs}" if needs else form, "form", "needs"),
        "source": (str, "source"),
    }
    return Table.from_rows(rows, CAPTION, columns)


def significant(value: float, up: bool | None = None) -> str:
    """Number with three significant digits and without an exponent, – for NaN. A bound is rounded ``up`` or down.

    Examples
    --------
    >>> significant(128764.0), significant(381.96), significant(0.0123), significant(float("inf"))
    ('129 000', '382', '0.0123', 'any')
    >>> significant(128764.0, up=False), significant(381.96, up=False), significant(0.01231, up=True)
    ('128 000', '381', '0.0124')
    """
    if np.isnan(value):
        return MISSING
    if np.isinf(value):
        return "any"
    rounded = float(f"{value:.3g}" if up is None else bounding(value, 3, up))
    return f"{rounded:,.0f}".replace(",", " ") if abs(rounded) >= 100 else f"{rounded:g}"


def bounds_in_words(low: float, high: float, unit: str) -> tuple[str, str]:
    """Texts of both bounds in a unit for readers: of sizes, rounded to their safe side, of others, outwards."""
    if unit not in _SAFE_SIDE and is_equal(low, high, high):
        return significant(low), significant(high)
    return significant(low, _SAFE_SIDE.get(unit, False)), significant(high, _SAFE_SIDE.get(unit, True))


# Sentences


#: Words for simulated limits by their unit: what is needed, at a voltage, and in fast separation.
_SIMULATED = {
    LENGTH.unit: (*["its simulated limit is"] * 2, "its simulated limit can fall from {high} to {low} µm"),
    FORCE.unit: (
        *("it needs a restoring force of", "they hold it with a further"),
        "it can need a restoring force of {high} instead of {low} µN",
    ),
}


def sentences(dataset: xr.Dataset, build: float = np.nan, has_shares: bool = False) -> list[str]:
    """Life of a device in words: causes of contact, drying, and many touchdowns, beside its size to build [m, N].

    The latter counts touchdowns in their conditions if these have shares, the limits here never do.
    """
    answers = {answer.name: answer for answer in answers_of(dataset) if not answer.needs}
    unknown = [answer for answer in answers_of(dataset) if answer.needs]
    length = float(dataset.length)
    at = f"At {bounding(TO_UM * length, 3, up=False)} µm{_limit(answers, length)} it" if np.isfinite(length) else "It"
    potential = float(dataset.potential)
    texts = [*_beside(build, _sought(dataset)), *_touching(answers, at)]
    texts += _asking(answer for answer in unknown if answer.question == TOUCH)
    texts += [*_pulled_in(answers, potential), *_shaken(answers, float(dataset.get("shock", 0.0)))]
    texts += [*_drying(answers, at, length), *_on_dimples(answers), *_at_tilts(answers)]
    texts += [*_at_voltage(answers, potential), *_fast(answers), *_often(answers, int(dataset.touchdowns), has_shares)]
    return [*texts, *_asking(answer for answer in unknown if answer.question != TOUCH)]


def _sought(dataset):
    """Number sought for a device: those with a length have none of a force."""
    return FORCE if np.isnan(float(dataset.length)) else LENGTH


def _beside(build, sought):
    """Note on the difference of simulated limits from the size to build."""
    if not 0 < build < np.inf:
        return []
    size = f"{sought.name} to build, {safe_size(build, sought)}"
    return [f"The {size}, has inside all that is stated. Simulated limits below have one cause each and exact inputs."]


def judged_without(answer: Answer) -> list[str]:
    """Sentence on the stricter limits that nothing stated asks for."""
    sizes = words.unasked(answer)
    if not sizes or answer.forbidden:
        return []
    together = " Several at once can be stricter: state them." if len(words.stricter(answer)) > 1 else ""
    return [
        f"Not inside, as nothing that you stated asks for it: {listed(sizes)}, with the errors of the inputs.{together}"
    ]


def _limit(answers, length):
    """Note on a length that is the least simulated limit [m]."""
    return ", its simulated limit," * any(
        answer.low == length for name, answer in answers.items() if name.startswith(Name.SAFE)
    )


def _asking(unknown):
    """Sentences on numbers that nobody knows without further keys, and on these keys."""
    return [f"The {answer.what} is unknown: state {answer.needs}." for answer in unknown]


def _touching(answers, at):
    """Voltage and shock below which a device does not touch; nothing if neither is known."""
    limits = [f"{_low(answers[Name.VOLTAGE])} V"] if Name.VOLTAGE in answers else []
    limits += [f"a half-sine shock of {_low(answers[Name.SHOCK])} g"] if Name.SHOCK in answers else []
    slow = f" A slow shock of {_high(answers[Name.SHOCK])} g brings it down." if Name.SHOCK in answers else ""
    return [f"{at} does not touch below {' or '.join(limits)}.{slow}"] if limits else []


def _pulled_in(answers, potential):
    """Sentence on the pull-in of a device by its own voltage."""
    if Name.VOLTAGE not in answers or potential < answers[Name.VOLTAGE].low:
        return []
    at_once = "" if potential >= answers[Name.VOLTAGE].high else " if it is switched on at once"
    return [f"Its own voltage of {significant(potential)} V {'can pull' if at_once else 'pulls'} it in{at_once}."]


def _shaken(answers, shock):
    """Sentence on the contact of a device by its own shock [m s⁻²]."""
    if not shock or Name.SHOCK not in answers:
        return []
    limit, own_shock = answers[Name.SHOCK], f"Its own shock of {significant(_UNITS['m s-2'][0] * shock)} g"
    if shock < limit.low:
        return [f"{own_shock} does not bring it down."]
    return [f"{own_shock} {'brings' if shock >= limit.high else 'can bring'} it down."]


def _on_dimples(answers):
    """Whether a beam sticks on its dimples, and whether it touches beside them."""
    if Name.DIMPLES not in answers:
        return []
    pulls, holds = answers[Name.PULLED], answers[Name.DIMPLES]
    often = max(
        (answer for answer in answers.values() if answer.name.startswith(f"{Name.ON_DIMPLES}_")),
        key=lambda answer: answer.high,
    )
    text = (
        f"The {pulls.what} is at least {_low(pulls)} µN. A row is held by {_low(holds)} µN on average: "
        f"{fraction_between(often.low, often.high, ' %')} of the beams stick on dimples in the strictest of their airs."
    )
    if answers[Name.BESIDE].low > 0:
        tension = from_si(answers[Name.TENSION_BESIDE].low, "mN_per_m")
        volts = f"a slowly raised voltage of {_low(answers[Name.VOLTAGE_BESIDE])} V"
        return [
            f"{text} Beside them, {_low(answers[Name.BESIDE])} % of the gap is left: it does not touch there below "
            f"{volts}, or while a liquid of up to {significant(tension)} mN/m dries."
        ]
    return [f"{text} But it touches beside them, where they do not protect it."]


def _at_tilts(answers):
    """Force on a stopper at its tilts, and the tilt that makes it that of a wedge."""
    if Name.TILTED not in answers:
        return []
    tilted, wedge = answers[Name.TILTED], answers[Name.WEDGE]
    ends, limit = (" to ".join(dict.fromkeys((_low(each), _high(each)))) for each in (tilted, wedge))
    worst = " (the most with each area at its worst tilt)" * (tilted.high > tilted.low)
    return [
        f"Its {tilted.what}, is {ends} µN{worst}. Beyond a tilt of {limit}°, a longer side of its area hardly holds "
        "more."
    ]


def _at_voltage(answers, potential):
    """Effect of a voltage on a touching device, and on its dielectric."""
    if Name.AT_VOLTAGE not in answers:
        return []
    limit, field = answers[Name.AT_VOLTAGE], answers[Name.FIELD]
    on, ends = f"While {significant(potential)} V are on,", [(_low(limit), limit.low), (_high(limit), limit.high)]
    finite_ends = dict.fromkeys(end for end, value in ends if not np.isnan(value))
    texts = [f"{on} {_SIMULATED[limit.unit][1]} {' to '.join(finite_ends)} {_UNITS[limit.unit][1]}."]
    if Name.FREEING in answers:
        texts.append(_release_voltage(answers[Name.FREEING]))
    if field.high > BREAKDOWN:
        texts.append(
            f"The field in its dielectric, {_high(field)} V/nm, is above 1 V/nm, where thin oxides break down."
        )
    return [*texts, _AFTER_GROUNDING]


#: What is not computed of a device after its voltage; arXiv 2508.17724.
_AFTER_GROUNDING = (
    "Water that its field draws in can stay after grounding, even below RH 0.1, and hold it (not in the model, "
    "unsafe): test after use at voltage."
)


def _release_voltage(answer):
    """Voltage below which the spring of a stopper frees it."""
    if not max(answer.low, answer.high) > 0:
        return f"There is no {answer.what}: without voltage it does not free them, either."
    ends = " to ".join(dict.fromkeys(text for text in (_low(answer), _high(answer)) if text != MISSING))
    return f"The {answer.what} is {ends} V."


def _drying(answers, at, length):
    """Beams standing while liquids dry, the fate of one of this length, and beams releasing afterwards."""
    standing = _liquids(answers, Name.COLLAPSE)
    if not standing:
        return []
    fates = {}
    for liquid, limit in standing.items():
        fates.setdefault((length > limit.low) + (length > limit.high), []).append(liquid)
    now = [f"{_FATES[fate]} when it is dried from {listed(names)}" for fate, names in fates.items()]
    limits = ", ".join(f"{_low(limit)} and {_high(limit)} µm ({liquid})" for liquid, limit in standing.items())
    released = _liquids(answers, Name.RELEASED)
    free = ", ".join(f"{_high(limit)} µm ({liquid})" for liquid, limit in released.items())
    shorter = "; shorter ones may, too" if any(np.isnan(limit.low) for limit in released.values()) else ""
    return [
        *([f"{at} {', and '.join(now)}."] if np.isfinite(length) else []),
        f"Beams that dry stand up to the first of these lengths and collapse beyond the second: {limits}. After a "
        f"collapse they stay down if they are longer than {free}{shorter}.",
    ]


#: What becomes of a beam that dries, by the number of bounds of its length that it exceeds.
_FATES = ("stands", "may collapse", "collapses")


def _liquids(answers, name):
    """Answers of one kind by the liquid that they are about."""
    return {key.removeprefix(f"{name}_"): answer for key, answer in answers.items() if key.startswith(f"{name}_")}


def _fast(answers):
    """Safe length, or restoring force, of fast separation in words, if both are known and read differently."""
    limit = answers.get(Name.FAST) or answers.get(Name.RESTORING)
    if limit is None or not limit.low < limit.high < np.inf or _low(limit) == _high(limit):
        return []
    needs = _SIMULATED[limit.unit][2].format(low=_low(limit), high=_high(limit))
    return [f"If it separates faster than water evaporates, as in a shock, {needs}."]


def _often(answers, touchdowns, has_shares):
    """What is safe for many touchdowns, as far as it is known."""
    if Name.AFTER not in answers:
        return []
    limit = answers[Name.AFTER]
    sought = SOUGHT[limit.unit]
    bounds = [f"{bound(limit)} {sought.shown}" for bound in (_low, _high)]
    others, same = reversed(bounds) if sought.more_is_better else bounds
    where = ", all in the strictest air," * has_shares
    number = f"For {touchdowns} touchdowns{where} {_SIMULATED[limit.unit][0]} {others}"
    return [f"{number} if each meets other summits, and {same} if all meet the same ones."]


def _low(answer: LifeRow) -> str:
    """Lower bound of an answer in its unit."""
    return _ends(answer)[0]


def _high(answer: LifeRow) -> str:
    """Upper bound of an answer in its unit."""
    return _ends(answer)[1]


def _ends(answer):
    """Both bounds of an answer in its unit."""
    factor, unit = _UNITS[answer.unit]
    return bounds_in_words(factor * answer.low, factor * answer.high, unit)


# Figure


@styled
def figure(life: Mapping[str, xr.Dataset], answers: Mapping[str, Answer | None]) -> Figure:
    """Limits of the lives of devices as dot plots: lengths of beams, or forces of stoppers, a panel for each device.

    Answers are by device, none where the size to build is forbidden. Sizes that the strictest row does not allow are
    shaded, and those beyond the size to build twice.
    """
    widest = int(_LABELS * page_width(DOUBLE) / _CHARACTER)
    rows = {name: _rows(dataset) for name, dataset in life.items()}
    marks = {name: _marks(limits, answers[name], widest) for name, limits in rows.items()}
    titles = [_title(name, answer) for name, answer in answers.items()]
    heights = [
        dots.height(labels) + _TITLE * title.count("\n") for labels, title in zip(marks.values(), titles, strict=True)
    ]
    size = DOUBLE, min(sum(heights) + _LEGEND, _TALLEST)
    figure_of_lives, axes = panels(len(rows), 1, size, height_ratios=heights)
    for panel, (name, answer) in zip(axes[:, 0], answers.items(), strict=True):
        sought = _sought(life[name])
        dots.draw(panel, marks[name], column="")
        _shade(panel, sought, [_strictest(rows[name], answer, sought), answer.build if answer else np.nan])
        panel.set_xlabel(f"{sought.name} [{sought.shown}], {_SAFER[sought.more_is_better]} is safer")
    letter(axes[:, 0], titles)
    entries = list(_entries([mark for of_device in marks.values() for row in of_device.values() for mark in row]))
    legend_outside(figure_of_lives, (entries, [entry.get_label() for entry in entries]), "lower", 2)
    dots.heighten(figure_of_lives, axes[:, 0])
    return figure_of_lives


def _strictest(limits, answer, sought):
    """Strictest size of all rows whose safe size is known, and of the answer [m, N]."""
    sizes = [unsafe_end(limit) for limit in limits if not _is_open(limit)]
    if answer:
        sizes += [answer.build, *(limit.size for limit in answer.unasked)]
        sizes += [answer.between.size] if answer.between else []
    return sought.sign * min((sought.sign * size for size in sizes if np.isfinite(size)), default=np.nan)


def _is_open(answer):
    """Whether an answer is a length of which no safe value is known."""
    return bool(np.isnan(answer.low)) and not SOUGHT[answer.unit].more_is_better


def _shade(panel, sought, ends):
    """Shade sizes beyond the strictest one, and once more beyond the size to build, with room on the safe side."""
    low, high = panel.get_xlim()
    for size in (end / sought.scale for end in ends if np.isfinite(end)):
        panel.axvspan(*((low, size) if sought.more_is_better else (size, high)), **_FORBIDDEN)
    if np.isfinite(ends[-1]):
        panel.axvline(ends[-1] / sought.scale, color=BUILD, linewidth=1.2, zorder=0)
    room = _ROOM * (high - low)
    panel.set_xlim(low - room * (not sought.more_is_better), high + room * sought.more_is_better)


def _title(name, answer):
    """Title of a panel: the device, its size to build, and the stricter ones beside it."""
    if answer is None or not np.isfinite(answer.build):
        return name
    return textwrap.fill(f"{name}: build {words.to_build(answer)}", int(page_width(DOUBLE) * _TITLED))


def _entries(marks):
    """Yield entries of the legend: the questions whose colours are drawn, sizes to build, and what marks are."""
    for question, colour in _COLOURS.items():
        if colour in {mark.color for mark in marks}:
            yield Line2D([], [], color=colour, linewidth=4, label=_QUESTIONS[question])
    yield Line2D([], [], color=BUILD, label="size to build, if no stricter row applies")
    yield Patch(**_FORBIDDEN, label="sizes that a stricter row does not allow")
    yield Patch(**_FORBIDDEN | {"alpha": 2 * _FORBIDDEN["alpha"]}, label="sizes beyond that to build")
    yield _sign(marker="o", color="0.3", label="dot or bar: one cause, inputs exact")
    if _DECIDES in {mark.marker for mark in marks}:
        yield _sign(marker=_DECIDES, color=_SHORT, label="with all that is stated inside")
    for marker, label in {"o": "interpolated between airs", _BELOW: "below this; no safe length known"}.items():
        if any(mark.marker == marker and not mark.filled for mark in marks):
            yield _sign(marker=marker, markerfacecolor="white", color="0.3", label=label)


def _sign(**style):
    """Entry of the legend that is a marker."""
    return Line2D([], [], linestyle="", markersize=4, **style)


def _rows(dataset):
    """Finite answers of a device in lengths or, for a stopper, forces."""
    unit = _sought(dataset).unit
    return [answer for answer in answers_of(dataset) if answer.unit == unit and np.isfinite(answer.high)]


def _marks(limits, answer, widest):
    """One row for each limit from its lower to its upper bound, with both numbers, by its label.

    Stricter sizes with the errors of the inputs have a mark of their own and stand before bounds with exact inputs.
    """
    rows, build = {}, answer.build if answer else np.nan
    stricter = {limit.name: limit.size for limit in answer.unasked} if answer else {}
    for limit in limits:
        sought = SOUGHT[limit.unit]
        least, scale, colour = limit.high if np.isnan(limit.low) else limit.low, sought.scale, _COLOURS[limit.question]
        text = " to ".join(end for end in dict.fromkeys(_ends(limit)) if end != MISSING)
        if is_open := _is_open(limit):
            text = f"at most {text}"
        shade, marker = _SHORT if is_short(limit, build) else _EXACT, _BELOW if is_open else "o"
        ends = least / scale, limit.high / scale
        marks = [dots.Mark(*ends, colour, text, filled=not is_open, text_color=shade, marker=marker)]
        if limit.name in stricter:
            marks = _with_errors(marks[0], stricter[limit.name], sought)
        rows[textwrap.fill(_label(limit), widest)] = marks
    return rows | (_mark_between(answer, widest) if answer else {})


def _with_errors(mark, size, sought):
    """Marks of a row with exact inputs and of its stricter size with their errors, with both numbers."""
    shown = size / sought.scale
    text = f"{bounding(shown, 3, up=sought.more_is_better)}\nexact: {mark.text}"
    return [replace(mark, text=""), dots.Mark(shown, shown, _SHORT, text, marker=_DECIDES, text_color=_SHORT)]


def _mark_between(answer, widest):
    """Row of the size to build between the stated airs by its label, none if it reads as the size to build."""
    between, sought = answer.between, answer.sought
    if between is None or not sought.is_stricter(between.size, answer.build):
        return {}
    size, text = between.size / sought.scale, bounding(between.size / sought.scale, 3, up=sought.more_is_better)
    label = f"{sought.label} to build at RH {between.humidity:.2g}, between stated airs, interpolated"
    return {textwrap.fill(label, widest): [dots.Mark(size, size, _SHORT, text, filled=False, text_color=_SHORT)]}


def _label(answer):
    """What an answer is about, in short."""
    return answer.what.partition(":")[0]


#: What table and figure declare alike.
_OF_ALL: dict = {
    "inputs": lambda plan, at: {"life": by_name("devices/life", plan.devices.with_life)},
    "jobs": lambda plan: [{}] if plan.devices.with_life else [],
    "targets": ("devices",),
}


def _inputs_of_figure(plan, at):
    """Lives, answers and warnings of all devices."""
    answers = by_name("devices/answer", plan.devices.with_life)
    warnings = device_warnings.files_of(*plan.devices.with_life)
    return _OF_ALL["inputs"](plan, at) | {"answers": answers, "warnings": warnings}


STAGES = (
    table_stage(
        "life",
        "what brings devices into contact, holds and frees them",
        compute=table,
        **_OF_ALL,
    ),
    figure_stage(
        "life",
        "what limits the life of devices, on one axis",
        "Devices",
        compute=lambda data: figure(data["life"], tables.allowed(data["answers"], data["warnings"])),
        **_OF_ALL | {"inputs": _inputs_of_figure},
    ),
)
