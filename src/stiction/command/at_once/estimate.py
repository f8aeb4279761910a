"""Command ``stiction estimate``: the length or force to build at once, without the libraries for numbers."""

import argparse
import json
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from typing import Any, NamedTuple

from stiction.command.at_once import flats, life
from stiction.command.output_streams import say
from stiction.config.units import from_si
from stiction.contact.air import DRY, DRY_AIR, Air
from stiction.estimate.answer import CHOSEN, FRACTIONS, Estimate, answer
from stiction.estimate.bridge import Bridge
from stiction.estimate.force import Stopper
from stiction.estimate.length import Impossible, NotLearnt
from stiction.estimate.question import (
    ENDS,
    Question,
    of_area,
    of_middle,
    of_numbers,
    questions,
    refuse_impossible,
    solids_of,
    surface,
    temperature_of,
)
from stiction.estimate.table import content, known, origin
from stiction.rounding import bounding

#: Options of a device on a described surface: key in a file, metavar, help, default.
OPTIONS = {
    "rms": ("rms_nm", "NM", "rms of the heights of the underside", None),
    "like": ("like", "SURFACE", "typical surface for what is not known: B1, B2, Sub1 or Sub2", None),
    "hurst": ("hurst", "H", "Hurst exponent", None),
    "corner": ("corner_rad_per_um", "RAD/UM", "corner of the spectrum", None),
    "cutoff": ("cutoff_rad_per_um", "RAD/UM", "cut-off of the spectrum", None),
    "skewness": ("skewness", "S", "skewness of the heights", None),
    "kurtosis": ("kurtosis", "K", "kurtosis of the heights, 3 for Gaussian ones", None),
    "thickness": ("thickness_um", "UM", "thickness of the beam", None),
    "gap": ("gap_um", "UM", "gap below the beam", None),
    "width": ("width_um", "UM", "width of the beam (default: 30)", 30.0),
    "length": ("length_um", "UM", "length of the beam, for the probability that it sticks", None),
    "voltage": ("voltage_V", "V", "voltage in contact; needs --dielectric", None),
    "stress": ("residual_stress_MPa", "MPA", "tensile stress of a bridge, in place of a cantilever", None),
    "force": ("restoring_force_uN", "UN", "restoring force of a stopper, for the probability that it sticks", None),
    "modulus": ("young_modulus_GPa", "GPA", "Young's modulus of both sides (default: 164)", None),
    "temperature": ("temperature_K", "K", "temperature of the water (default: 300)", None),
}
_OF_SURFACE = ("rms", "like", "hurst", "corner", "cutoff", "skewness", "kurtosis")
#: Sections of files that have the numbers of options, and materials of both sides by their contact angles.
_OF_SECTIONS = {"modulus": "solid", "temperature": "water"}
_SIDES = ("Upper", "Lower")
#: Opposite surface without a file.
OPPOSITE = "Sub1"
#: What the command does.
PURPOSE = "Estimate the length or force to build at once, from runs on drawn surfaces. A run simulates your own device."


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command."""
    parser.add_argument("files", nargs="*", metavar="FILE", help="file with devices; or state one by options")
    for name, (_, unit, words, default) in OPTIONS.items():
        kind = str if name == "like" else float
        parser.add_argument(f"--{name}", type=kind, metavar=unit, help=words, default=default)
    words = "sides of the area of a stopper, in place of a cantilever"
    parser.add_argument("--contact", type=float, nargs=2, metavar="UM", help=words)
    words = "thickness and relative permittivity of the dielectric"
    parser.add_argument("--dielectric", type=float, nargs=2, metavar=("NM", "PERMITTIVITY"), help=words)
    words = "contact angles of water on both sides, the underside first"
    parser.add_argument("--angles", type=float, nargs=2, metavar="DEG", help=words)
    words = "relative humidities, such as 0.45, or dry"
    parser.add_argument("--rh", type=_humidity, nargs="+", metavar="RH", help=words)
    parser.add_argument("--touchdowns", type=int, default=1, metavar="N", help="number of touchdowns (default: 1)")


def run(arguments: argparse.Namespace) -> int:
    """Print the estimates that are asked for, and return the exit status: 2 if one of them is not known."""
    status, to_run = 0, f"stiction devices {' '.join(arguments.files) or 'mine.yaml'}"
    for name, question in _questions(arguments).items():
        try:
            for line in shown(answer(question, *known())):
                say(line)
            say(f"  A run adds what the estimate leaves out: {to_run}")
        except Impossible as reason:
            return _refused(f"{name} has no estimate: {reason}.")
        except NotLearnt as reason:
            status = _refused(f"{name} is not known at once: {reason}. Run: {to_run}")
    if arguments.contact and arguments.force is None:
        say("With --force, the lines of mine.yaml follow.")
    elif not arguments.files:
        say(f"Lines of mine.yaml, with {LIKE} for all that is not stated:\n{file_of(arguments)}")
    return status


def _refused(sentence):
    """Say a refusal, and return its exit status."""
    say(sentence)
    return 2


def in_short(files: Sequence[str]) -> Iterator[str]:
    """Lines with the length or force to build of each device of some valid files that the estimate knows."""
    for name, question in _of_files(files).items():
        with suppress(NotLearnt):
            interval = chosen(answer(question, *known()), f" of {name}")
            yield f"Estimate: {interval}; stiction estimate {' '.join(files)} says more."


def main(words: Sequence[str]) -> int:
    """Print the estimates for the words after ``stiction estimate``."""
    parser = argparse.ArgumentParser(
        "stiction estimate", "%(prog)s FILE ... | OPTIONS (-h lists them)", PURPOSE, origin()
    )
    add_options(parser)
    try:
        return run(parser.parse_args(words))
    except (OSError, ValueError) as error:
        say(str(error), sys.stderr)
        return 2


def _questions(arguments):
    """Questions by the name of the device."""
    if arguments.files:
        return _of_files_alone(arguments)
    try:
        return {_NAME: _of_options(arguments, content()["library"])}
    except NotLearnt as reason:
        return {_NAME: reason}


def _of_files_alone(arguments):
    """Questions of files without options of a device."""
    if stated := [name for name in (*OPTIONS, *_MORE) if getattr(arguments, name) not in (None, _DEFAULTS.get(name))]:
        raise ValueError(f"--{stated[0]} is for a device without a file: state it in {arguments.files[0]}")
    if not (by_device := _of_files(arguments.files)):
        raise ValueError(f"{' '.join(arguments.files)} has no devices to estimate")
    return by_device


def _of_files(files):
    """Questions of all devices of some files."""
    from stiction.config.reading import read  # imports the parser of YAML

    return {name: question for file in files for name, question in questions(read(file), content()).items()}


def _of_options(arguments, library):
    """Question by the options alone."""
    kind = _kind_of(arguments)
    needed = ("rms", "rh", *kind.needed) + ("dielectric",) * (arguments.voltage is not None)
    for name, others in kind.strange.items():
        if getattr(arguments, name) is not None:
            raise Impossible(f"--{name} is for {others} alone")
    for name in needed:
        if getattr(arguments, name) is None:
            raise Impossible(f"--{name} is missing{_HINT}")
    entry, device = _stated(arguments)
    refuse_impossible(entry | device | device.get("dielectric", {}), _NAMES)
    _refuse_beyond(arguments)
    if (arguments.skewness is None) != (arguments.kurtosis is None):
        raise Impossible("--skewness and --kurtosis must come together")
    sides = [surface({"like": LIKE} | entry, library), surface(library[OPPOSITE], library)]
    sections = _sections(arguments)
    solids = solids_of(_SIDES if arguments.angles else (None, None), sections)
    more = {"averaged": arguments.like is None, "solids": solids} | temperature_of(sections)
    return kind.question(_NAME, device, sides, **more)


def _refuse_beyond(arguments):
    """Refuse options of surface, solids and water that no configuration can have."""
    for name in (*_OF_SURFACE, *_OF_SECTIONS):
        ends, value = ENDS.get(OPTIONS[name][0]), getattr(arguments, name)
        if ends and value is not None and (refusal := ends.refusal(value)):
            raise Impossible(f"--{name} {refusal}")


class _Kind(NamedTuple):
    """Kind of a device that options state."""

    name: str  #: in a file
    question: Callable[..., Any]  #: as `stiction.estimate.question.of_numbers`
    needed: tuple[str, ...]  #: options that it needs
    strange: dict[str, str]  #: options of other kinds, and these in words


#: Kinds of devices that options state.
_CANTILEVER = _Kind("cantilever", of_numbers, ("thickness", "gap"), {"force": "stoppers"})
_BRIDGE = _Kind("bridge", of_middle, ("thickness", "gap"), _CANTILEVER.strange)
_OF_BEAMS = dict.fromkeys(("thickness", "gap", "length"), "beams") | {"stress": "bridges"}
_STOPPER = _Kind("stopper", of_area, ("contact",), _OF_BEAMS)


def _kind_of(arguments):
    """Kind of the device of some options."""
    if arguments.contact:
        return _STOPPER
    return _CANTILEVER if arguments.stress is None else _BRIDGE


def _sections(arguments):
    """Sections of solids and water that options state, as in files."""
    sections = {}
    for name, section in _OF_SECTIONS.items():
        if (value := getattr(arguments, name)) is not None:
            sections[section] = {OPTIONS[name][0]: value}
    if arguments.angles:
        sections["materials"] = {
            side: {"contact_angle_deg": angle} for side, angle in zip(_SIDES, arguments.angles, strict=True)
        }
    return sections


def _stated(arguments):
    """Entries of the surface and of the device that options state, by the keys of files."""
    names = [name for name in OPTIONS if name not in _OF_SECTIONS and getattr(arguments, name) is not None]
    stated = {OPTIONS[name][0]: getattr(arguments, name) for name in names}
    entry = {key: stated.pop(key) for key in [OPTIONS[name][0] for name in _OF_SURFACE] if key in stated}
    device = stated | {"humidities": arguments.rh, "touchdowns": arguments.touchdowns}
    if arguments.contact:
        del device["width_um"]
        device["contact_um"] = arguments.contact
    if arguments.dielectric:
        device["dielectric"] = dict(zip(("thickness_nm", "permittivity"), arguments.dielectric, strict=True))
    return entry, device


def file_of(arguments: argparse.Namespace) -> str:
    """File with the device of some options, for a run."""
    entry, device = _stated(arguments)
    kind = _kind_of(arguments).name
    air = {"humidities": [Air(each).name for each in arguments.rh]}
    pair = {"beam": "Mine", "substrate": OPPOSITE, "gap_um": arguments.gap or _GAP} | air
    surfaces = {"Mine": {"like": LIKE} | entry}
    if arguments.angles:
        surfaces = {"Mine": surfaces["Mine"] | {"material": _SIDES[0]}, OPPOSITE: {"material": _SIDES[1]}}
    return "\n".join(
        (
            "run: {pairs: [mine], studies: []}",
            *(f"{name}: {_in_yaml(section)}" for name, section in _sections(arguments).items()),
            "\n".join(["surfaces:", *(f"  {name}: {_in_yaml(each)}" for name, each in surfaces.items())]),
            f"pairs:\n  mine: {_in_yaml(pair)}",
            f"devices:\n  Mine: {_in_yaml({'kind': kind, 'pair': 'mine'} | device | air)}",
        )
    )


def _in_yaml(entry):
    """Entry in one line, which is JSON without quotes."""
    return json.dumps(entry).replace('"', "")


def _humidity(word):
    """Relative humidity of a word, which can be that for dry air."""
    try:
        return DRY_AIR.humidity if word == DRY else float(word)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be {DRY}, or numbers above 0 and below 1, got {word}") from None


#: Options beside `OPTIONS`, and what they are without being stated. Keys of all by their options.
_MORE = {"contact": "contact_um", "dielectric": "dielectric", "rh": "humidities", "touchdowns": "touchdowns"}
_MORE |= {"angles": "contact_angle_deg"}
_DEFAULTS = {"width": 30.0, "touchdowns": 1}
_NAMES = {key: f"--{name}" for name, key in [*((name, each[0]) for name, each in OPTIONS.items()), *_MORE.items()]}
_NAMES |= dict.fromkeys(("thickness_nm", "permittivity"), "--dielectric")
#: What a file needs that options do not state: the typical surface, and a gap beside that of a stopper [µm].
LIKE, _GAP = "B2", 2.0
_HINT = "; a cantilever needs --rms --rh --thickness --gap, a bridge --stress as well, a stopper --rms --rh --contact"
#: Name of a device without a file.
_NAME = "The device"
#: What a size is by its unit, and the symbol of this.
_WORDS = {"um": ("length", "µm"), "uN": ("force", "µN")}


def shown(estimate: Estimate) -> Iterator[str]:
    """Lines of an answer."""
    asked, (name, symbol) = estimate.question, _WORDS[estimate.question.unit]
    left_open = ", typical surfaces stand for what is not stated" * any(asked.members)
    where = f"{Air(estimate.humidity).where}, the strictest air"
    yield f"{asked.name}: estimate {where}; stated inputs count as exact{left_open}"
    yield f"  stuck            {f'{name} [{symbol}]':<15}90 %            95 %"
    for row in estimate.rows:
        both = (_outward(ends, asked) for ends in row.intervals.values())
        ends = "    ".join(f"{low:>5} to {high:<5}" for low, high in both)
        yield f"  1 in {1 / row.fraction:<10.0f}  {_number(row.size, asked):>8}     {ends}"
    if estimate.stuck is not None:
        yield f"  {_at_its_size(estimate, symbol)}"
    yield f"  {chosen(estimate)}."
    if estimate.promise:
        yield f"  {estimate.promise}"
    yield f"  {flats.sentences(estimate, symbol)}"
    yield from (f"  {sentence}" for sentence in life.sentences(estimate, symbol))


def _at_its_size(estimate, symbol):
    """Fraction stuck at the stated size, after its verdict if it is beyond that to use."""
    asked = estimate.question
    value, low, high = (_percent(fraction, asked.most) for fraction in estimate.stuck)
    size = f"{life.as_stated(asked.size, asked.unit)} {symbol}"
    if not estimate.is_unsafe:
        return f"At {size}, {value} stick (95 %: {low} to {high})."
    beyond = "less" if estimate.is_force else "longer"
    limit = life.bound(estimate.use_if_slow, asked.unit, estimate.is_force)
    upper = "" if high == value else f", but up to {high} (95 %)"
    return f"{size} is {beyond} than {limit}: not safe. Best estimate: {value} stick{upper}."


def chosen(estimate: Estimate, subject: str = "") -> str:
    """Interval of the size for 1 in 1000, and the end to use."""
    asked = estimate.question
    least, most = _outward(estimate.chosen.intervals["90"], asked)
    learnt = f"1 in {1 / CHOSEN:.0f}{subject} sticks between {least} and {most} {_WORDS[asked.unit][1]} (90 %)"
    if estimate.is_fast:
        return f"{learnt} if it separates slowly: menisci hold more in a shock, and a run says what to use"
    if estimate.drying:
        longest = life.bound(estimate.use, asked.unit)
        return f"{learnt}: use at most {longest}, or it can collapse while {estimate.drying} dries"
    return f"{learnt}: use {f'at least {most}' if estimate.is_force else f'at most {least}'}"


#: Largest fraction that is shown.
_NEARLY_ALL = 0.99


def _percent(fraction, most):
    """Fraction in percent, between the smallest one with a length and the largest that is known."""
    if fraction < FRACTIONS[-1]:
        return f"less than {100 * FRACTIONS[-1]:.4f} %"
    return f"{'at least ' * (fraction >= most)}{float(f'{100 * min(fraction, _NEARLY_ALL):.2g}'):g} %"


def _outward(ends: Sequence[float], question: Question | Stopper | Bridge) -> list[str]:
    """Ends of an interval in the unit of a question, with three digits, and not within it."""
    return [bounding(from_si(end, question.unit), 3, up) for end, up in zip(ends, (False, True), strict=True)]


def _number(size: float, question: Question | Stopper | Bridge) -> str:
    """Size in the unit of a question, with three digits."""
    return f"{float(f'{from_si(size, question.unit):.3g}'):g}"
