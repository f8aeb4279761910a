"""Surfaces measured along lines, evaluated before any job: they become surfaces by numbers, each with its error.

``{profiles: {files: [line_1.txt, line_2.txt]}}`` has the moments and Eq. (7) that the lines show, and an
``uncertainty`` for another place. All that follows is that of other surfaces by numbers.
"""

import hashlib
import json
import math
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from stiction.config import scans
from stiction.config.messages import Problem
from stiction.config.surfaces.knowledge import slope
from stiction.config.units import from_si, in_si
from stiction.errors import ScanError
from stiction.run.fingerprint import fingerprint

#: Keys for reading files and for evaluating lines, and keys of a surface that stay beside its numbers.
_READING, _EVALUATION, _BESIDE = ("x_unit", "height_unit"), ("level", "shortest_nm"), ("material",)
#: Share of the rms from which noise is named.
_NOISY = 0.1
#: Significant digits of computed numbers: the same on every machine.
_DIGITS = 5
#: ASSUME: largest errors of ln rms, ln corner and the Hurst exponent that say anything about a surface.
_LARGEST = {"rms": 0.7, "corner": 1.0, "Hurst exponent": 0.5}


def with_numbers(config: dict[str, Any], kept: Path | None = None) -> tuple[dict[str, Any], list[Problem]]:
    """Configuration with numbers in place of lines, kept in a folder between processes, and problems of the files."""
    surfaces, problems = evaluated(config, kept)
    numbers = {name: _beside(config["surfaces"][name]) | of_lines["section"] for name, of_lines in surfaces.items()}
    return config | {"surfaces": config["surfaces"] | numbers}, problems


def evaluated(config: dict[str, Any], kept: Path | None = None) -> tuple[dict[str, dict], list[Problem]]:
    """Surfaces measured along lines by name, each its ``section`` by numbers and ``notes``, and problems of others."""
    surfaces, problems = {}, []
    for name, entry in config["surfaces"].items():
        if "profiles" in entry:
            try:
                surfaces[name] = _numbers(name, entry, config["seed"], kept)
            except ScanError as refusal:
                problems.append(_problem(name, entry["profiles"], refusal))
    return surfaces, problems


def in_words(name: str, of_lines: Mapping[str, Any]) -> str:
    """Numbers of a surface measured along lines, and notes on them, as of `evaluated`."""
    section, errors = of_lines["section"], of_lines["section"]["uncertainty"]
    values = {
        "rms_nm": f"rms {section['rms_nm']:.3g} ± {errors['rms_nm']:.2g} nm",
        "corner_rad_per_um": f"corner {section['published_psd']['corner_rad_per_um']:.3g} ± "
        f"{errors['corner_rad_per_um']:.2g} rad/µm",
        "hurst": f"exponent {slope(section['published_psd']):.3g} ± {2 * errors['hurst']:.2g}",
    } | {key: f"{key} {section[key]:.3g} ± {errors[key]:.2g}" for key in ("skewness", "kurtosis")}
    return ". ".join([f"{name} by lines: {', '.join(values[key] for key in errors)}", *of_lines["notes"]])


def _beside(entry):
    """Keys of a surface that stay beside its numbers."""
    return {key: entry[key] for key in _BESIDE if key in entry}


def _numbers(name, entry, seed, kept):
    """Section of a surface by numbers, and notes."""
    section = entry["profiles"]
    if others := [key for key in entry if key not in ("profiles", *_BESIDE)]:
        raise ScanError("", "files", f"must not be given beside {', '.join(others)}; give one surface its own name")
    files = dict(zip(scans.labels(section["files"]), section["files"], strict=True))
    if len(files) < len(section["files"]):
        raise ScanError("", "files", "must name each file once; a line counts once")
    determined_by = [scans.digests(files), {**section, "files": None}, name, seed, _code()]
    key = hashlib.sha256(json.dumps(determined_by, sort_keys=True).encode()).hexdigest()
    if key not in _NUMBERS:
        _NUMBERS[key] = scans.kept_numbers(key, kept, lambda: _evaluated(files, section, seed, name))
    return _NUMBERS[key]


#: Evaluated surfaces that this process knows, by content, settings and code.
_NUMBERS = {}


@cache
def _code():
    """Fingerprints of the code for the evaluation."""
    package = Path(__file__).parents[2]
    modules = __file__, package / "scans/lines/estimate.py", package / "formats/texts/profile.py"
    return list(map(fingerprint, modules))


def _evaluated(files, section, seed, name):
    """Read and evaluate the lines of a surface."""
    # Imported here: configurations without lines do not need it.
    from stiction.scans.lines.estimate import Settings, estimate_lines

    lines, step = _lines(files, {key: section[key] for key in _READING if key in section})
    settings = in_si(Settings, {key: section[key] for key in _EVALUATION if key in section})
    try:
        estimate = estimate_lines(lines, step, seed, settings, name)
    except ScanError as refusal:
        raise ScanError(", ".join(files), refusal.key, refusal.reason) from None
    _require_known(estimate, ", ".join(files))
    return {"section": _section(estimate), "notes": _notes(estimate)}


def _notes(estimate):
    """Sentences on the limits of an estimate."""
    notes = ["No line shows whether the surface is isotropic: it is assumed"]
    if estimate.noise > _NOISY * math.exp(estimate.values[0]):
        notes.append(f"White noise of {from_si(estimate.noise, 'nm'):.2g} nm was subtracted")
    return notes


def _lines(files, units):
    """Heights of all lines (n,) each and their common step [m]."""
    from stiction.formats.content import content_of
    from stiction.formats.texts.profile import profile
    from stiction.scans.lines.estimate import require_alike

    read = {}
    for label, path in files.items():
        text = content_of(label, str(path), Path(path).read_bytes()).text
        if text is None:
            raise ScanError(label, "files", "is no text; save the line as a text with two columns, place and height")
        read[label] = profile(text, label, units)
    return [heights for heights, _ in read.values()], require_alike(read)


def _require_known(estimate, files):
    """Refuse lines that say too little of a quantity."""
    relative = dict(zip(_LARGEST, (estimate.errors[0], estimate.errors[3], estimate.errors[4] / 2), strict=True))
    _, skewness, kurtosis = estimate.values[:3]
    room = kurtosis - 1 - skewness**2
    vague = [quantity for quantity, error in relative.items() if error >= _LARGEST[quantity]]
    vague += ["kurtosis"] if estimate.errors[2] >= kurtosis - 1 else []
    vague += ["skewness"] if estimate.errors[1] ** 2 >= room else []
    if vague:
        raise ScanError(files, "files", f"shows too little of its {' and '.join(vague)}: measure more or longer lines")


def _section(estimate):
    """Section of a surface by numbers, with their errors."""
    log_rms, skewness, kurtosis, log_corner, slope = map(float, estimate.values)
    of_rms, *of_form, of_corner, of_slope = map(float, estimate.errors)
    spectrum = estimate.spectrum
    numbers = {
        "rms_nm": from_si(math.exp(log_rms), "nm"),
        "skewness": skewness,
        "kurtosis": kurtosis,
        "psd": "published",
        "published_psd": {
            "plateau_nm4": from_si(spectrum.plateau, "nm4"),
            "floor_nm4": from_si(spectrum.floor, "nm4"),
            "corner_rad_per_um": from_si(spectrum.corner, "rad_per_um"),
            "cutoff_rad_per_um": from_si(spectrum.cutoff, "rad_per_um"),
        },
    }
    errors = {
        "rms_nm": numbers["rms_nm"] * of_rms,
        **dict(zip(("skewness", "kurtosis"), of_form, strict=True)),
        "corner_rad_per_um": from_si(spectrum.corner, "rad_per_um") * of_corner,
        "hurst": of_slope / 2,
    }
    return _rounded(numbers | {"uncertainty": errors})


def _rounded(value: Any) -> Any:
    """Numbers of a section with few digits."""
    if isinstance(value, Mapping):
        return {key: _rounded(inner) for key, inner in value.items()}
    return float(f"{value:.{_DIGITS}g}") if isinstance(value, float) else value


def _problem(name, section, refusal):
    """Problem with the key behind a refusal of lines."""
    path, labels = ("surfaces", name, "profiles"), scans.labels(section["files"])
    if refusal.key == "files" and refusal.file in labels:
        return Problem((*path, "files", labels.index(refusal.file)), f"is {refusal.file!r}, which {refusal.reason}")
    if refusal.key == "files":
        return Problem(path, f"{refusal.file} {refusal.reason}".strip())
    content = f"is {section[refusal.key]!r}" if refusal.key in section else "is missing"
    return Problem((*path, refusal.key), f"{content}: {refusal.file} {refusal.reason}")
