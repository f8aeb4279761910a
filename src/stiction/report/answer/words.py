"""Answer about a device in words. No decision is made here: `stiction.answer.data.Answer` has them."""

from collections.abc import Mapping, Sequence

import numpy as np

from stiction.answer.data import INPUTS, Answer, Cause, Probability, Step, Verdict
from stiction.answer.sought import FORCE, LENGTH, PULL_OFF
from stiction.constants import ZERO_CELSIUS
from stiction.contact.air import Air
from stiction.devices.risk import one_in
from stiction.report.format import airs, humidity_text, listed, number, percent_bound, safe_size
from stiction.rounding import grouped, in_percent
from stiction.stages.devices.end_states import END_STATES
from stiction.stages.life.answers import Name

#: Causes in words: as the row of a ladder, and inside a sentence.
CAUSES: Mapping[Cause, tuple[str, str]] = {
    Cause.ESTIMATE: ("estimate", "the estimate"),
    Cause.SIMULATION: ("error of the simulation", "the simulation"),
    Cause.FAST: ("fast separation, as in a shock", "fast separation"),
    Cause.TOUCHDOWNS: ("all touchdowns", "all touchdowns"),
    Cause.TILT: ("worst of its tilts", "its tilts"),
    Cause.VOLTAGE: ("voltage", "its voltage"),
    Cause.DRYING: ("drying of the stated liquids", "the drying of the stated liquids"),
    Cause.INPUTS: ("uncertainty of the inputs", "the uncertainty of the inputs"),
    Cause.TEST_BEAMS: ("inputs and model, by the test beams", "the test beams"),
}
#: Stated conditions that are not inside, in words.
_LEFT_OUT = {
    "dimples": "its dimples (see its life below)",
    "inputs": "the uncertainty of the inputs where too few devices stick to show it",
    "requirement": "the smaller fraction that it requires (see the curve of the axis below)",
    "shock": "the fast separation in its shock, which nothing bounds",
    "voltage": "its voltage, at which the dielectric breaks down",
}
#: Limits that nothing stated asks for, in words.
_UNLESS = dict.fromkeys([Name.FAST, Name.RESTORING], "if it separates fast")
#: Relative change of a size that is not worth a word.
_SAME = 0.01
#: Signs of verdicts with the tone of their box, by the number that is sought.
_SIGNS = {
    LENGTH.name: {
        Verdict.BUILD: ("good", "Length to build"),
        Verdict.SAFE: ("good", "Safe"),
        Verdict.OPEN: ("open", "Not shown to be safe"),
        Verdict.BAD: ("bad", "Too long"),
    },
    FORCE.name: {
        Verdict.BUILD: ("good", "Force to build"),
        Verdict.SAFE: ("good", "Suffices"),
        Verdict.OPEN: ("open", "Not shown to suffice"),
        Verdict.BAD: ("bad", "Too weak"),
    },
    PULL_OFF.name: {
        Verdict.PLACES: ("good", "Pull-off force"),
        Verdict.FITS: ("good", "Fits"),
        Verdict.UNDECIDED: ("open", "Not decided"),
        Verdict.MISFIT: ("bad", "Does not fit"),
    },
}
#: Reasons in the data why no number is stated, in words.
NO_NUMBER = "Do not rely on a number"
_REASONS = {
    INPUTS: "The inputs are too uncertain for a number. Were all exact, it would be {exact}. First measure {measure}.",
}

#: Fraction that is too small for a number.
LEAST = 1e-5
#: Fraction that is too near to all for a number.
MOST = 0.999
#: Part of a power of ten from which on an upper end of a band is this power.
_NEAR = 0.95
#: Fraction beyond which two digits would round to all.
_NEARLY_ALL = 0.99


def percent(fraction: float, end: str = "") -> str:
    """Fraction in percent with two digits, near all of them of the rest.

    An ``end`` of a band, ``low`` or ``high``, is rounded outwards, an upper one just below 0.1 %, 1 % or 10 % to these.

    Examples
    --------
    >>> percent(0.1812), percent(0.000242), percent(3e-9), percent(0.99992), percent(0.9962)
    ('18 %', '0.024 %', 'less than 0.001 %', 'more than 99.9 %', '99.62 %')
    >>> percent(0.000961, "high"), percent(0.0019, "low"), percent(3e-9, "low"), percent(3e-9, "high")
    ('0.1 %', '0.19 %', '0 %', '0.001 %')
    """
    if fraction < LEAST:
        return {"low": "0 %", "high": f"{100 * LEAST:g} %"}.get(end, f"less than {100 * LEAST:g} %")
    if fraction > MOST:
        return {"low": "99.9 %", "high": "100 %"}.get(end, "more than 99.9 %")
    if end:
        return f"{percent_bound(fraction, _digits(fraction, end), end == 'high')} %"
    if fraction > _NEARLY_ALL:
        return f"{100 - float(f'{100 * (1 - fraction):.2g}'):.4g} %"
    return f"{float(f'{100 * fraction:.2g}'):g} %"


def _digits(fraction, end):
    """Digits of an end of a band: one for an upper end that they raise to a power of ten below 100 %."""
    power = 10 ** np.ceil(np.log10(fraction))
    return 1 if end == "high" and _NEAR * power < fraction < power < 1 else 2


def step_in_words(answer: Answer, step: Step) -> str:
    """Cause of a step, as the row of a ladder. The size to build, and what is not inside it, are marked."""
    cause = CAUSES[step.cause][0]
    if not step.stated:
        return f"{cause} (not stated)"
    is_last = step is answer.stated_steps[-1] and not answer.forbidden and np.isfinite(answer.build)
    return f"{cause}: to build" if is_last else cause


def stuck_in_words(stuck: Probability) -> str:
    """P(stuck) with its band. Where no simulated device sticks, its upper end alone, or with a larger expectation.

    Examples
    --------
    >>> stuck_in_words(Probability(0.18, 1e-9, 0.95)), stuck_in_words(Probability(1e-9, 0.0, 0.0037, none_seen=True))
    ('18 % (0 to 95 %)', 'at most 0.37 %')
    >>> stuck_in_words(Probability(0.002, 0.0, 0.001, none_seen=True))
    'at most 0.1 % (95 % confidence; 0.2 % on average, as many stick in the worst 5 %)'
    """
    if stuck.none_seen:
        most, mean = percent(stuck.high, "high"), percent(stuck.value)
        more = (
            f" (95 % confidence; {mean} on average, as many stick in the worst 5 %)"
            if stuck.value > stuck.high and mean != most
            else ""
        )
        return "0 to 100 %" if stuck.high > MOST else f"at most {most}{more}"
    if stuck.low > MOST:
        return percent(stuck.low)
    low, high = percent(stuck.low, "low").removesuffix(" %"), percent(stuck.high, "high")
    return f"{percent(stuck.value)} ({low} to {high})"


def is_forbidden(answer: Answer) -> bool:
    """Whether a limit of the model, or test beams, forbid a number. Inputs that are too uncertain only leave none."""
    return bool(set(answer.forbidden) - set(_REASONS))


def sign_of(answer: Answer) -> tuple[str, str]:
    """Tone and sign of the verdict."""
    if answer.verdict is Verdict.NONE:
        return ("bad", NO_NUMBER) if is_forbidden(answer) else ("open", "Not known")
    if answer.verdict is Verdict.SAFE and not answer.is_enough_between:
        return "open", f"{_SIGNS[answer.sought.name][Verdict.SAFE][1]} in these airs, perhaps not between them"
    return _SIGNS[answer.sought.name][answer.verdict]


def headline(answer: Answer) -> str:
    """Size to build, and what happens at the stated size."""
    if forbidding := reasons(answer):
        build = " ".join(forbidding).removesuffix(".")
    elif not np.isfinite(answer.build):
        build = "Too few simulated devices bound a size"
    else:
        build = f"{answer.sought.bound} {to_build(answer)}"
    if answer.stuck is None:
        return f"{build}."
    size = f"{answer.size / answer.sought.scale:.4g} {answer.sought.shown}"
    return f"{build}; with your {size}, {stuck_in_words(answer.stuck)} stick."


def to_build(answer: Answer) -> str:
    """Size to build, and the stricter ones beside it."""
    return to_build_beside(answer, stricter(answer))


def to_build_beside(answer: Answer, sizes: Sequence[str]) -> str:
    """Size to build, and some stricter sizes in words."""
    size = safe_size(answer.build, answer.sought)
    return f"{size}, but {listed(sizes)}" if sizes else size


def stricter(answer: Answer) -> list[str]:
    """Stricter sizes of airs between the stated ones, which are interpolated, and of what nothing stated asks for."""
    at, between = answer.between, []
    if at and answer.sought.is_stricter(at.size, answer.build):
        size = safe_size(at.size, answer.sought)
        between = [f"{size} between these airs (interpolated at RH {at.humidity:.2g}: compute it)"]
    return between + unasked(answer)


def unasked(answer: Answer) -> list[str]:
    """Stricter sizes of what nothing that is stated asks for."""
    limits = [limit for limit in answer.unasked if answer.sought.is_stricter(limit.size, answer.build)]
    return [f"{safe_size(limit.size, answer.sought)} {_unless(limit)}" for limit in limits]


def _unless(stricter_size):
    """What a limit that nothing stated asks for is about, after its size."""
    if stricter_size.name.startswith(Name.COLLAPSE):
        return f"if {stricter_size.name.removeprefix(f'{Name.COLLAPSE}_')} dries on it"
    return _UNLESS.get(stricter_size.name, f"by its {stricter_size.what.partition(':')[0]}")


def promise(answer: Answer) -> str:
    """What the size to build promises, after how many touchdowns."""
    shared = ", shared among its conditions," * bool(answer.stays)
    after = f"{grouped(answer.touchdowns)} touchdowns{shared}" if answer.touchdowns > 1 else "one touchdown"
    where = airs([air.humidity for air in answer.airs])
    sentence = f"At most {one_in(answer.share)} sticks after {after} {where} (95 % confidence, if the model holds)."
    if answer.stuck is None or not answer.is_enough or answer.stuck.value <= answer.share:
        return sentence
    return f"{sentence} On average more stick, as many do in the worst 5 % of cases."


def contains(answer: Answer) -> str:
    """What the numbers contain, and which stated conditions they leave out."""
    inside = [CAUSES[cause][1] for cause in answer.included]
    sentence = f"Inside: {', '.join(inside)}."
    if Cause.INPUTS not in answer.included and Cause.TEST_BEAMS not in answer.included:
        sentence += " All inputs count as exact."
    if answer.left_out:
        sentence += f" Stated, but not inside: {', '.join(map(_LEFT_OUT.get, answer.left_out))}."
    if answer.extrapolated:
        sentence += (
            " The simulation is extrapolated to such rare cases, beyond what was verified: the size can err either way."
        )
    return sentence


def decides(answer: Answer) -> str:
    """Air and end state that decide, and the largest step."""
    last, largest = answer.stated_steps[-1], answer.largest_step
    held = END_STATES[last.shape].by if last.shape in END_STATES else "liquid that dries"
    held = "tip" if answer.is_by_tip else held
    stuck = "" if answer.sought.more_is_better else f", stuck by {'the ' if held != 'beam or tip' else ''}{held}"
    sentence = f"{_air(answer, last.humidity)}{_among_airs(answer)}{stuck}."
    if answer.between and answer.sought.is_stricter(answer.between.size, answer.build):
        sentence += f" Between these, RH {answer.between.humidity:.2g} is stricter (interpolated)."
    change = largest.factor - 1
    if not np.isfinite(change) or abs(change) < _SAME:
        return sentence
    by = f"{'+' if change > 0 else '-'}{in_percent(abs(change))} of the {answer.sought.name}"
    return f"{sentence} Largest step: {CAUSES[largest.cause][1]}, {by}."


def _among_airs(answer):
    """How strict the air that decides is: another one can be stricter alone, but not in most draws of all of them."""
    if len(answer.airs) == 1:
        return ""
    sign = answer.sought.sign
    build = next(air.build for air in answer.airs if air.humidity == answer.together.humidity)
    often = any(sign * air.build < sign * build for air in answer.airs)
    return f", {'most often ' * often}the strictest of the stated airs"


def measure(answer: Answer) -> str:
    """What to measure, and what it would be worth unless a limit forbids a number."""
    if Cause.TEST_BEAMS in answer.included:
        return "The section on test beams says which further ones help."
    if not answer.measure:
        return "State the uncertainties of the inputs in section uncertainty: the answer then says what to measure."
    group = f"{answer.measure[0].upper()}{answer.measure[1:]}"
    if is_forbidden(answer) or np.isnan(answer.if_measured):
        return f"{group}."
    if abs(np.log(answer.if_measured / answer.build)) < _SAME:
        return f"Nothing: with {answer.measure} known exactly, it would change by less than {in_percent(_SAME)}."
    return f"{group}: known exactly, it would be {safe_size(answer.if_measured, answer.sought)}."


def reasons(answer: Answer) -> list[str]:
    """Why no number is stated, as far as the inputs are the reason."""
    exact = safe_size(answer.exact, answer.sought)
    return [_REASONS[kind].format(exact=exact, measure=answer.measure) for kind in answer.forbidden if kind in _REASONS]


def by_test_beams(answer: Answer) -> list[str]:
    """Size without the test beams, beside the one with them."""
    if np.isnan(answer.without_test_beams):
        return []
    return [f"Without the test beams, it would be {safe_size(answer.without_test_beams, answer.sought)}."]


def of_airs(answer: Answer) -> list[dict[str, str]]:
    """Rows of the table of a first screen: size to build and P(stuck) in each stated air alone.

    The air that decides has those in all of them, as pictures and controls have: its own alone can be less safe.
    """
    rows, sought, together = [], answer.sought, answer.together
    after = f" after {grouped(answer.touchdowns)} touchdowns, each on other summits," * (
        answer.touchdowns > 1 and not answer.stays
    )
    for air in answer.airs:
        decides = len(answer.airs) > 1 and air.humidity == together.humidity
        shown = together if decides else air
        row = {"RH": humidity_text(air.humidity) + " (decides)" * decides} | _celsius(answer, air)
        row |= {"touchdowns": f"{answer.touchdowns_in(air.humidity):.5g}"} if answer.stays else {}
        row |= {f"{sought.name} to build [{sought.shown}]": _size(answer, shown.build)}
        if np.isfinite(air.without_tip):
            row["if the tip cannot touch and the model holds [µm]"] = _size(answer, air.without_tip)
        if shown.stuck is not None:
            row[f"P(stuck){after} at {answer.size / sought.scale:.4g} {sought.shown}"] = stuck_in_words(shown.stuck)
        rows.append(row)
    return rows


def _air(answer, humidity):
    """Air that decides, with its temperature if the device has a mission."""
    air = Air(humidity)
    at = next((air.temperature for air in answer.airs if air.humidity == humidity), np.nan)
    return air.choose(air.words, "Dry air") + (f" at {at - ZERO_CELSIUS:.3g} °C" if np.isfinite(at) else "")


def _celsius(answer, air):
    """Cell with the temperature of an air, any if it has no water; none for a device without conditions."""
    if not np.isfinite([air.temperature for air in answer.airs]).any():
        return {}
    return {"°C": Air(air.humidity).choose(number(air.temperature - ZERO_CELSIUS, ".3g"), "any")}


def _size(answer, size):
    """Size without its unit, – if none is known."""
    return safe_size(size, answer.sought).split()[0] if np.isfinite(size) else "–"
