"""Measured surfaces of a configuration, evaluated before any job for the relations between keys.

The numbers are preliminary: they contain the bias that stage estimate removes. Results depend on them only through the
question which studies are possible. They are kept by the content of the files, the settings and the code, so that a
process that checks the same configuration again does not read the files.
"""

import contextlib
import hashlib
import json
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

from stiction.config.memory import GRID
from stiction.config.merging import section_at, texts
from stiction.config.messages import Problem
from stiction.config.surfaces.knowledge import with_uncertainty
from stiction.config.units import NM_PER_UM, from_si, in_si, to_si
from stiction.errors import ScanError
from stiction.models import MODE_QUANTITIES, MOMENT_QUANTITIES, SPECTRUM_QUANTITIES
from stiction.regular_files import require_regular
from stiction.run.disk_cache import DiskCache
from stiction.run.fingerprint import fingerprint
from stiction.run.provenance import version_of

#: Values of the keys of a measured surface that are not given.
_DEFAULTS = {"heights": "moments", "psd": "fitted", "beyond": "cut"}
#: Range of the key ``rms_nm`` of other surfaces, which only a wrong unit exceeds [nm].
_SMOOTHEST, _ROUGHEST = 1e-3, 1e3
#: Key of the description of a measured surface: distance beyond the correlation of its heights [µm].
MEASURED_CORRELATION = "correlation_um"
#: Least kurtosis over 1 + skewness², which is 1 for surfaces of two heights and 1.5 for sinusoidal ones. ASSUME: the
#: moments of scans with less may become impossible when the bias of levelling is removed.
_OF_TWO_HEIGHTS = 1.1
_OF_SCANS = {"fast_axis": "x", "level": "plane", "lines": "none"}
#: Signs in the path of a file that stand for something else: Snakemake leaves no way to write them.
_MISREAD = {
    "[{}]": "braces in its path, which Snakemake reads as wildcards",
    "<[a-z][a-z0-9_]*>": "a word between < and > in its path, which Snakemake reads as a variable",
    "[\x01-\x1f\x7f-\x9f\u2028\u2029]": "a line break or control character in its path, which no list can show",
}
#: Keys that say how a file is read, and how its map is evaluated.
_READING = ("channel", "fast_axis", "size_um", "height_unit")
_EVALUATION = ("tip_radius_nm", "shortest_nm")
#: Sections of a surface that name files.
_FILED = ("scans", "profiles")


def is_measured(entry: Mapping[str, Any]) -> bool:
    """Whether a section of ``surfaces`` describes the surface by scans."""
    return "scans" in entry


def quantities(entry: Mapping[str, Any]) -> tuple[str, ...]:
    """Quantities of a surface to take slopes by, see `stiction.analysis.shifts`."""
    return (MODE_QUANTITIES if entry.get("heights") == "measured" else MOMENT_QUANTITIES) + SPECTRUM_QUANTITIES


def has_scans(config: Mapping[str, Any]) -> bool:
    """Whether a configuration, valid or not, describes a surface by scans or lines."""
    return any(key in section_at(entry) for entry in section_at(config, "surfaces").values() for key in _FILED)


def complete(entry: dict[str, Any]) -> dict[str, Any]:
    """Section of a surface with the defaults of all missing keys."""
    if not is_measured(entry):
        return entry
    return _DEFAULTS | entry | {"scans": _OF_SCANS | entry["scans"]}


def resolve_scan_paths(config: dict[str, Any], named: Mapping[str, Any], folder: str | Path) -> dict[str, Any]:
    """Configuration, valid or not, with paths of scans and lines relative to the folder of the file naming them."""
    for key in _FILED:
        moved = {
            name: _in_folder(entry, key, Path(folder).absolute())
            for name, entry in section_at(config, "surfaces").items()
            if (files := _files(entry, key)) and files == _files(section_at(named, "surfaces", name), key)
        }
        config = config | {"surfaces": config["surfaces"] | moved} if moved else config
    return config


def _files(entry, key):
    """Files of a section of a surface. None if they are no list of texts."""
    return texts(section_at(entry, key).get("files"))


def _in_folder(entry, key, folder):
    """Section of a surface with the relative files of one of its sections in a folder."""
    return entry | {key: entry[key] | {"files": [str(folder / file) for file in entry[key]["files"]]}}


def source(entry: Mapping[str, Any]) -> dict[str, Any]:
    """Settings for reading files: `stiction.scans.reading.Source` in the units of the configuration."""
    return {key: entry["scans"][key] for key in _READING if key in entry["scans"]}


def evaluation(entry: Mapping[str, Any], section: Mapping[str, Any]) -> dict[str, Any]:
    """Settings for evaluating scans: `stiction.scans.inspection.Settings` in the units of the configuration."""
    scans = entry["scans"]
    levelling = {"levelling": {key: scans[key] for key in ("level", "lines")}}
    limits = {key: section[key] for key in ("tiles", "undefined_share")}
    return levelling | {key: scans[key] for key in _EVALUATION if key in scans} | limits


def digest(path: str | Path) -> str:
    """SHA-256 of the content of a regular file. Raises OSError."""
    require_regular(path)
    path = Path(path)
    status = path.stat()
    return _digest(path.absolute(), status.st_mtime_ns, status.st_size)


@cache
def _digest(path, _modified, _size):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def preliminary_estimates(
    config: dict[str, Any], kept: str | Path | None = None
) -> tuple[dict[str, dict], list[Problem]]:
    """Preliminary numbers of the measured surfaces by name, and problems of the others.

    Between processes, the numbers are kept in a folder, if one is named.
    """
    estimates, problems = {}, []
    for name, entry in config["surfaces"].items():
        if is_measured(entry):
            try:
                estimates[name] = _preliminary_numbers(complete(entry), config["scans"], kept)
                problems += _without_power_law(name, entry, estimates[name])
            except ScanError as refusal:
                problems.append(_problem(name, complete(entry), refusal))
    return estimates, problems


def simulates(config: Mapping[str, Any]) -> bool:
    """Whether a configuration simulates anything. Rules of strips, grids and densities hold for nothing else."""
    return bool(config["run"]["pairs"] or config.get("devices") or config.get("test_beams"))


def usable(
    entry: dict[str, Any], section: Mapping[str, Any], kept: str | Path | None = None
) -> tuple[dict[str, Any] | None, list[str]]:
    """Section of a surface with its usable files, and reasons against the others, or ``None`` without any.

    Parameters
    ----------
    entry, section : dict
        Section of the surface, and section ``scans`` of the configuration, both as the schema demands.
    kept : path, optional
        As in `preliminary_estimates`.
    """
    files, reasons = list(entry["scans"]["files"]), []
    while files:
        left_out = {"left_out": reasons} if reasons else {}
        remaining = entry | {"scans": entry["scans"] | {"files": files} | left_out}
        try:
            _preliminary_numbers(complete(remaining), section, kept)
        except ScanError as refusal:
            key = "" if refusal.key == "files" else f" (key {refusal.key})"
            reasons.append(f"{refusal.file} is not used: it {refusal.reason}{key}")
            labels = _labels(remaining)
            if refusal.file not in labels:
                break
            del files[labels.index(refusal.file)]
        else:
            return remaining, reasons
    return None, reasons


def readable(entry: dict[str, Any]) -> Any:
    """First readable scan of a surface, see `stiction.scans.scan.Scan`, or ``None``."""
    entry = complete(entry)
    for path, label in zip(entry["scans"]["files"], _labels(entry), strict=True):
        with contextlib.suppress(ScanError):
            return _scan(path, label, source(entry))
    return None


def _preliminary_numbers(entry, section, kept):
    """Preliminary numbers of one surface, computed if they are not known yet."""
    files = dict(zip(_labels(entry), entry["scans"]["files"], strict=True))
    contents, settings = digests(files), (source(entry), evaluation(entry, section))
    text = json.dumps([contents, settings, _code()], sort_keys=True)
    key = hashlib.sha256(text.encode()).hexdigest()
    if key not in _NUMBERS:
        _NUMBERS[key] = kept_numbers(key, kept, lambda: _preliminary(files, *settings))
    return _NUMBERS[key]


def kept_numbers(key: str, folder: str | Path | None, compute: Callable[[], dict]) -> dict:
    """Numbers kept in a folder under a key, or computed now."""
    if folder is None:
        return compute()
    remember = DiskCache(Path(folder) / f"{key}.json")
    numbers = remember(key, compute)
    remember.save()
    return numbers


def _labels(entry):
    """Names of the files of the scans of a surface in messages, by `labels`."""
    return labels(entry["scans"]["files"])


def labels(files: list[str]) -> list[str]:
    """Names of files in messages: without folders, or as paths if names are equal."""
    names = [Path(file).name for file in files]
    return [file if names.count(name) > 1 else name for file, name in zip(files, names, strict=True)]


def digests(files: Mapping[str, str]) -> list[list[str]]:
    """Name and SHA-256 of every file, by label. Refuses equal contents, because scans are independent samples."""
    label_of = {}
    for label, path in files.items():
        if obstacle := next((words for signs, words in _MISREAD.items() if re.search(signs, str(path))), None):
            raise ScanError(label, "files", f"has {obstacle} ({str(path)!r}): rename it")
        try:
            content = digest(path)
        except OSError as reason:
            raise ScanError(label, "files", f"cannot be opened: {reason.strerror} ({str(path)!r})") from None
        if content in label_of:
            raise ScanError(label, "files", f"has the same content as {label_of[content]}; a scan counts once")
        label_of[content] = label
    return [[Path(path).name, content] for path, content in zip(files.values(), label_of, strict=True)]


#: Preliminary numbers that this process knows, by content, settings and code.
_NUMBERS = {}


@cache
def _code():
    """Fingerprint of the code for the evaluation of scans, this module included, and the version of the library."""
    folder = Path(__file__).parents[1] / "scans"
    modules = __file__, folder / "estimate.py", folder / "reading.py"
    return [list(map(fingerprint, modules)), version_of("SurfaceTopography")]


def _preliminary(files, reading, evaluating):
    """Read and evaluate the scans of a surface, without model scans. Raises the ScanErrors of both."""
    # Imported here: configurations without scans need neither.
    from stiction.scans import estimate
    from stiction.scans.quantiles import measured_density

    scans = [_scan(path, label, reading) for label, path in files.items()]
    inspection = estimate.inspect(scans, in_si(estimate.Settings, evaluating))
    rms = _in_range(from_si(math.exp(inspection.moments[0]), "nm"), next(iter(files)), reading)
    nearest = estimate.nearest_density(inspection)
    form = measured_density(inspection.quantiles, inspection.areas)
    skewness, kurtosis = map(float, inspection.moments[1:])
    return {
        "rms_nm": rms,
        "measured": [skewness, kurtosis],
        "feasible": None if nearest is None else [nearest.skewness, nearest.kurtosis],
        "form": [form.scores.tolist(), form.heights.tolist()],
        "plateau_nm4": from_si(inspection.fit.plateau, "nm4"),
        "corner_rad_per_um": from_si(inspection.fit.corner, "rad_per_um"),
        "slope": inspection.fit.slope,
        "end_rad_per_um": from_si(float(inspection.reach.end), "rad_per_um"),
        "resolved": inspection.is_resolved,
        "correlation_um": {psd: _correlation(inspection, psd) for psd in ("fitted", "tabulated")},
    }


def _correlation(inspection, psd):
    """Distance beyond the correlation of heights with the spectrum of a source [µm]."""
    from stiction.scans.whittle import spectrum
    from stiction.surface.spectrum import uncorrelated_beyond

    within, coarsest = inspection.reach, math.pi / to_si(GRID["spacing_nm"], "nm")
    ends = {within.end, min(within.end, coarsest)}
    drawn = (spectrum(psd, inspection.fit, inspection.rings, within, end) for end in ends)
    return from_si(max(map(uncorrelated_beyond, drawn)), "um")


def _scan(path, label, settings):
    """Scan in a file, named by its label."""
    from stiction.scans.reading import Source, read

    try:
        return replace(read(path, in_si(Source, settings)).scan, name=label)
    except ScanError as refusal:
        raise ScanError(label, refusal.key, refusal.reason) from None


def _in_range(rms, file, reading):
    """Rms of levelled heights [nm], if possible for a surface. Otherwise the heights are in another unit."""
    if _SMOOTHEST <= rms <= _ROUGHEST:
        return rms
    key = "height_unit" if "height_unit" in reading else "files"
    reason = f"has heights with an rms of {rms:.3g} nm, must be from {_SMOOTHEST:g} to {_ROUGHEST:g} nm"
    raise ScanError(file, key, f"{reason}: they are in another unit than is stated")


def with_heights(config: dict[str, Any], estimates: Mapping[str, dict]) -> dict[str, Any]:
    """Configuration with the measured density of measured surfaces without a density of their moments.

    ASSUME: it follows the scans, as does a measured spectrum that is not of the form of Eq. (7). A flag says so.
    """
    changed = {
        name: config["surfaces"][name] | {"heights": "measured"}
        for name, preliminary in estimates.items()
        if complete(config["surfaces"][name])["heights"] == "moments" and _without_density(preliminary)
    }
    return config | {"surfaces": config["surfaces"] | changed} if changed else config


def _without_density(preliminary):
    """Whether no maximum-entropy density has the moments of scans, or they are those of two heights."""
    skewness, kurtosis = preliminary["measured"]
    return not preliminary["feasible"] or kurtosis < _OF_TWO_HEIGHTS * (1 + skewness**2)


def _without_power_law(name, entry, preliminary):
    """Problem of a surface with an extended power law but scans without one."""
    if complete(entry)["beyond"] == "cut" or preliminary["resolved"]:
        return []
    reason = f"the pixels of {', '.join(_labels(entry))} do not resolve the power law that would go on"
    return [Problem(("surfaces", name, "beyond"), f"is 'continued', but {reason}, must be cut")]


def _problem(name, entry, refusal):
    """Problem with the key behind a refusal of scans."""
    if refusal.key == "files":
        labels = _labels(entry)
        index = (labels.index(refusal.file),) if refusal.file in labels else ()
        return Problem(("surfaces", name, "scans", "files", *index), f"is {refusal.file!r}, which {refusal.reason}")
    path, section = ("surfaces", name, "scans", refusal.key), entry["scans"]
    content = f"is {section[refusal.key]!r}" if refusal.key in section else "is missing"
    return Problem(path, f"{content}: {refusal.file} {refusal.reason}")


def with_preliminary_estimates(config: dict[str, Any], estimates: Mapping[str, dict]) -> dict[str, Any]:
    """Configuration with measured surfaces described by their preliminary numbers, as other surfaces are.

    Devices on measured surfaces are uncertain even if nothing else about them is.
    """
    spacing = config["sampling"]["spacing_nm"]
    described = {name: _by_numbers(complete(config["surfaces"][name]), estimates[name], spacing) for name in estimates}
    return with_uncertainty(config | {"surfaces": config["surfaces"] | described}, described)


def _by_numbers(entry, preliminary, spacing):
    """Section of a surface by numbers: skewness and kurtosis, or the measured form if it gives the heights."""
    grid = math.pi / spacing * NM_PER_UM
    cutoff = min(preliminary["end_rad_per_um"], grid) if entry["beyond"] == "cut" else grid
    plateau, corner = preliminary["plateau_nm4"], preliminary["corner_rad_per_um"]
    psd = {
        "plateau_nm4": plateau,
        "floor_nm4": plateau * (cutoff / corner) ** preliminary["slope"],
        "corner_rad_per_um": corner,
        "cutoff_rad_per_um": cutoff,
    }
    if entry["heights"] == "measured":
        shape = {"form": tuple(map(tuple, preliminary["form"]))}
    else:
        shape = dict(zip(("skewness", "kurtosis"), preliminary["feasible"] or (), strict=False))
    material = {"material": entry["material"]} if "material" in entry else {}
    correlation = {MEASURED_CORRELATION: preliminary["correlation_um"][entry["psd"]]}
    return {
        "rms_nm": preliminary["rms_nm"],
        **shape,
        "psd": "published",
        "published_psd": psd,
        **material,
        **correlation,
    }
