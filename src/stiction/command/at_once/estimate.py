"""Command ``stiction estimate``: the length to build at once, without the libraries for numbers."""

import argparse
import sys
from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import Any

from stiction.command.output_streams import say
from stiction.config.units import from_si
from stiction.estimate.answer import CHOSEN, FRACTIONS, Estimate, answer
from stiction.estimate.length import NotLearnt
from stiction.estimate.question import of_numbers, questions, surface
from stiction.estimate.table import content, known

#: Options of a cantilever on a described surface: key in a file, metavar, help, default.
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
}
_OF_SURFACE = ("rms", "like", "hurst", "corner", "cutoff", "skewness", "kurtosis")
#: Opposite surface without a file.
OPPOSITE = "Sub1"
#: What the command does.
PURPOSE = "Estimate the length to build at once, from runs on drawn surfaces. A run computes it exactly."


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command."""
    parser.add_argument("files", nargs="*", metavar="FILE", help="file with devices; or state a cantilever by options")
    for name, (_, unit, words, default) in OPTIONS.items():
        kind = str if name == "like" else float
        parser.add_argument(f"--{name}", type=kind, metavar=unit, help=words, default=default)
    words = "thickness and relative permittivity of the dielectric"
    parser.add_argument("--dielectric", type=float, nargs=2, metavar=("NM", "PERMITTIVITY"), help=words)
    parser.add_argument("--rh", type=float, nargs="+", metavar="RH", help="relative humidities, such as 0.45")
    parser.add_argument("--touchdowns", type=int, default=1, metavar="N", help="number of touchdowns (default: 1)")


def run(arguments: argparse.Namespace) -> int:
    """Print the estimates that are asked for, and return the exit status: 2 if one of them is not known."""
    status, name_of_file = 0, " ".join(arguments.files) or "mine.yaml"
    for name, question in _questions(arguments).items():
        try:
            for line in shown(answer(question, *known())):
                say(line)
            say(f"  Computed exactly by: stiction devices {name_of_file}")
        except NotLearnt as reason:
            status = 2
            say(f"{name} is not known at once: {reason}. Run: stiction devices {name_of_file}")
    return status


def in_short(files: Sequence[str]) -> Iterator[str]:
    """Lines with the length to build of each device of some valid files that the estimate knows."""
    for name, question in _of_files(files).items():
        with suppress(NotLearnt):
            length = answer(question, *known()).chosen.length
            said = f"1 in {1 / CHOSEN:.0f} of {name} sticks at about {_um(length)} µm"
            yield f"Estimate: {said}; stiction estimate {' '.join(files)} says more."


def main(words: Sequence[str]) -> int:
    """Print the estimates for the words after ``stiction estimate``."""
    parser = argparse.ArgumentParser("stiction estimate", description=PURPOSE)
    add_options(parser)
    try:
        return run(parser.parse_args(words))
    except (OSError, ValueError) as error:
        say(str(error), sys.stderr)
        return 2


def _questions(arguments):
    """Questions by the name of the device."""
    if arguments.files:
        return _of_files(arguments.files)
    try:
        return {"The cantilever": _of_options(arguments, content()["library"])}
    except NotLearnt as reason:
        return {"The cantilever": reason}


def _of_files(files):
    """Questions of all devices of some files."""
    from stiction.config.reading import read  # imports the parser of YAML

    return {name: one for file in files for name, one in questions(read(file), content()).items()}


def _of_options(arguments, library):
    """Question by the options alone."""
    needed = ("rms", "rh", "thickness", "gap") + ("dielectric",) * (arguments.voltage is not None)
    for name in needed:
        if getattr(arguments, name) is None:
            raise NotLearnt(f"--{name} is missing")
    stated = {OPTIONS[name][0]: getattr(arguments, name) for name in OPTIONS if getattr(arguments, name) is not None}
    entry = {key: stated.pop(key) for key in [OPTIONS[name][0] for name in _OF_SURFACE] if key in stated}
    device = stated | {"humidities": arguments.rh, "touchdowns": arguments.touchdowns}
    averaged = "like" not in entry
    if arguments.dielectric:
        device["dielectric"] = dict(zip(("thickness_nm", "permittivity"), arguments.dielectric, strict=True))
    side = surface({"like": "B2"} | entry, library)
    return of_numbers("The cantilever", device, [side, surface(library[OPPOSITE], library)], averaged=averaged)


def shown(found: Estimate) -> Iterator[str]:
    """Lines of an answer."""
    asked = found.question
    left_open = ", typical surfaces stand for what is not stated" * any(asked.members)
    yield f"{asked.name}: estimate at RH {found.humidity:g}, the worst air; stated inputs count as exact{left_open}"
    yield "  stuck            length [µm]    90 %            95 %"
    for row in found.rows:
        ends = "    ".join(f"{_um(low):>5} to {_um(high):<5}" for low, high in row.intervals.values())
        yield f"  1 in {1 / row.fraction:<10.0f}  {_um(row.length):>8}     {ends}"
    if found.stuck is not None:
        value, low, high = map(_percent, found.stuck)
        yield f"  At {_um(asked.length)} µm, {value} % stick (95 %: {low} to {high} %)."
    yield "  The estimate is no length to build: a run adds what it leaves out."


def _percent(part):
    """Fraction in percent, not below the smallest one with a length."""
    return f"{100 * part:.2g}" if part >= FRACTIONS[-1] else f"less than {100 * FRACTIONS[-1]:.4f}"


def _um(length: Any) -> str:
    """Length in µm, with three digits."""
    return f"{from_si(length, 'um'):.3g}"
