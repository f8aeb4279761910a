"""Surfaces without scans, described as papers do or by their rms alone, and how well their quantities are known.

``{like: B2, rms_nm: 5}`` is surface B2 of the library of typical surfaces with another rms. ``{rms_nm: 5, hurst: 0.8,
correlation_length_nm: 60, cutoff_rad_per_um: 125}`` is a self-affine surface. What such a section leaves open is from
the surface in ``like``, or is the mean of the library, and is listed as ``unknown``: its uncertainty is the scatter
over the library. In the normal form, every such surface has moments and the parameters of Eq. (7).

ASSUME: the library, the four surfaces of the paper (Tables I and II), stands for the surfaces of MEMS. Their skewness
is negative. Gaussian heights would stick less, which is not the safe side.
"""

import math
from collections.abc import Iterator, Mapping
from itertools import chain, islice
from typing import Any

import numpy as np

from stiction.config.messages import Problem, did_you_mean, one_line
from stiction.config.surfaces.knowledge import Library, slope, with_uncertainty
from stiction.config.units import from_si, to_si
from stiction.surface import self_affine

#: Keys of the spectrum as papers state it, and all keys of a section that is to be completed.
_OF_SPECTRUM = ("hurst", "correlation_length_nm", "corner_rad_per_um", "cutoff_rad_per_um")
KEYS = ("like", *_OF_SPECTRUM)
#: Other descriptions of a surface.
_OTHERS = ("psd", "published_psd", "mean_summit_radius_um", "summit_density_per_um2", "scans", "heights", "beyond")
_FORM = ("skewness", "kurtosis")
#: Significant digits of computed parameters: the same on every machine.
_DIGITS = 9


def is_described(entry: Mapping) -> bool:
    """Whether a section of ``surfaces`` is to be completed."""
    return not entry.keys().isdisjoint(KEYS) and "psd" not in entry


def complete(entry: dict[str, Any], library: Library) -> dict[str, Any]:
    """Section of a surface in normal form: moments, parameters of Eq. (7), and the unknown ones among them.

    Raises
    ------
    ValueError
        If no spectrum has the stated correlation length.
    """
    if not is_described(entry):
        return entry
    typical = library.get(entry.get("like"), {})
    heights = {key: entry.get(key, typical.get(key, _mean(library, key))) for key in _FORM}
    left_open = [name for name, keys in _LEAVES_OPEN.items() if not any(key in entry for key in keys)]
    unknown = list(dict.fromkeys([*left_open, *entry.get("unknown", ())]))
    psd = _spectrum(entry, typical.get("published_psd"))
    kept = {key: value for key, value in entry.items() if key in ("rms_nm", "material")}
    more = {"unknown": unknown} if unknown else {}
    more |= {"uncertainty": _uncertainty(entry, psd)} if "uncertainty" in entry else {}
    return kept | heights | {"psd": "published", "published_psd": psd} | more


#: Words of key ``unknown`` by the keys that state their quantities.
_LEAVES_OPEN = {
    "skewness": ("skewness",),
    "kurtosis": ("kurtosis",),
    "corner": ("corner_rad_per_um", "correlation_length_nm"),
    "hurst": ("hurst",),
    "cutoff": ("cutoff_rad_per_um",),
}


def _mean(library, key):
    """Mean of a moment over the library."""
    return float(np.mean([entry[key] for entry in library.values()]))


def _spectrum(entry, typical):
    """Section ``published_psd`` of a surface. Missing parameters are a typical surface's."""
    falling = self_affine.slope_of(entry["hurst"]) if "hurst" in entry else slope(typical)
    cutoff = entry.get("cutoff_rad_per_um") or typical["cutoff_rad_per_um"]
    corner = entry.get("corner_rad_per_um") or _corner(entry, typical, falling, cutoff)
    ends = to_si(corner, "rad_per_um"), to_si(cutoff, "rad_per_um")
    fitted = self_affine.spectrum(to_si(entry["rms_nm"], "nm"), falling, *ends)
    numbers = {"plateau_nm4": from_si(fitted.plateau, "nm4"), "floor_nm4": from_si(fitted.floor, "nm4")}
    return {key: _rounded(value) for key, value in numbers.items()} | {
        "corner_rad_per_um": corner,
        "cutoff_rad_per_um": cutoff,
    }


def _corner(entry, typical, slope, cutoff):
    """Corner of the spectrum [rad/µm], from the correlation length if it is stated."""
    if "correlation_length_nm" not in entry:
        return typical["corner_rad_per_um"]
    length = to_si(entry["correlation_length_nm"], "nm")
    return _rounded(from_si(self_affine.corner_of(length, slope, to_si(cutoff, "rad_per_um")), "rad_per_um"))


def _rounded(value):
    return float(f"{value:.{_DIGITS}g}")


def _uncertainty(entry, psd):
    """Section ``uncertainty`` with the corner's in place of the correlation length's.

    At a given slope, and far from the cut-off, one is inversely proportional to the other.
    """
    stated = dict(entry["uncertainty"])
    if "correlation_length_nm" in stated:
        relative = stated.pop("correlation_length_nm") / entry["correlation_length_nm"]
        stated["corner_rad_per_um"] = _rounded(relative * psd["corner_rad_per_um"])
    return stated


# Checks


def problems(config: Mapping[str, Any], library: Library) -> list[Problem]:
    """Problems of the surfaces that cannot be completed, or have impossible uncertainties, one of each."""
    refused = []
    for name, entry in config["surfaces"].items():
        refusals = chain(_refusals(entry, library), _impossible_uncertainties(entry, library))
        refused += [_problem(name, entry, *refusal) for refusal in islice(refusals, 1)]
    return refused


def completed(config: dict[str, Any], library: Library) -> dict[str, Any]:
    """Configuration with complete surfaces."""
    return config | {"surfaces": {name: complete(entry, library) for name, entry in config["surfaces"].items()}}


def with_uncertain_devices(config: dict[str, Any]) -> dict[str, Any]:
    """Configuration in which devices on surfaces that are not known exactly have a section of their uncertainty."""
    surfaces = config["surfaces"].items()
    uncertain = [name for name, entry in surfaces if entry.get("unknown") or entry.get("uncertainty")]
    return with_uncertainty(config, uncertain)


def _problem(name, entry, key, message):
    """Problem with a key of a surface, or with the surface as a whole."""
    if not key:
        return Problem(("surfaces", name), message)
    return Problem(("surfaces", name, *key.split(".")), f"is {one_line(_value(entry, key))}, {message}")


def _value(entry, key):
    for name in key.split("."):
        entry = entry[name]
    return entry


def _refusals(entry, library) -> Iterator[tuple[str, str]]:
    """Keys of a surface, none for the surface as a whole, with the reasons why they cannot be used."""
    stated = [key for key in KEYS if key in entry]
    if stated and (beside := [key for key in _OTHERS if key in entry]):
        yield stated[0], f"must not be given beside {', '.join(beside)}; give the surface a name of its own"
    elif stated:
        yield from _refusals_of_described(entry, library)
    elif "scans" not in entry and (missing := [key for key in (*_FORM, "psd") if key not in entry]):
        yield "", _without(missing, library)
    yield from _refusals_of_uncertainty(entry)


def _without(missing, library):
    """Message about a surface with nothing but an rms."""
    return (
        f"is without {', '.join(missing)}, must state rms_nm, skewness, kurtosis and psd; or rms_nm and like: one of "
        f"{', '.join(library)}, a typical surface for what is not known; or rms_nm, hurst, correlation_length_nm and "
        "cutoff_rad_per_um; or scans"
    )


def _refusals_of_described(entry, library):
    """Yield the same for a surface to be completed."""
    if "like" in entry and entry["like"] not in library:
        hint = did_you_mean(entry["like"], library)
        yield "like", f"must be one of {', '.join(library)}, the library of typical surfaces{hint}"
    if "correlation_length_nm" in entry and "corner_rad_per_um" in entry:
        yield "correlation_length_nm", "must come without corner_rad_per_um: one gives the other"
    needed = {"hurst": ("hurst",), "cutoff_rad_per_um": ("cutoff_rad_per_um",)}
    needed["correlation_length_nm or corner_rad_per_um"] = _LEAVES_OPEN["corner"]
    missing = [words for words, keys in needed.items() if not any(key in entry for key in keys)]
    if missing and "like" not in entry:
        first = next(key for key in KEYS if key in entry)
        yield first, f"must come with {', '.join(missing)}, or with like: one of {', '.join(library)}"
    for key, other in (_FORM, _FORM[::-1]):
        if key in entry and other not in entry:
            yield key, f"must come with {other}: both are stated or neither"
    try:
        _spectrum(entry, library.get(entry.get("like"), {}).get("published_psd"))
    except ValueError as reason:
        key = next((key for key in _LEAVES_OPEN["corner"][::-1] if key in entry), "cutoff_rad_per_um")
        yield key if key in entry else "like", f"no spectrum has it: {reason}"


def _refusals_of_uncertainty(entry):
    """Yield key and reason for each stated error of a quantity of a surface that cannot be used."""
    for key in ("unknown", "uncertainty"):
        if key in entry and "scans" in entry:
            yield key, "must not be given beside scans, which give the errors of the surface"
    has_spectrum = "published_psd" in entry or is_described(entry)
    for key in entry.get("uncertainty", {}):
        if key == "correlation_length_nm" and key not in entry:
            yield f"uncertainty.{key}", f"must come with {key} of the surface"
        elif key in ("corner_rad_per_um", "hurst") and not has_spectrum:
            yield f"uncertainty.{key}", "must come with published_psd, or with the spectrum as papers state it"


def _impossible_uncertainties(entry, library):
    """Yield keys of uncertainties beyond their quantities of a surface that can be completed, with refusals.

    Any distribution has a kurtosis above its skewness² + 1, so that the mean of kurtoses is above the mean skewness²,
    its variance and 1 together.
    """
    surface = complete(entry, library)
    stated, psd = entry.get("uncertainty", {}), surface.get("published_psd", {})
    sizes = {key: surface.get(key, entry.get(key, psd.get(key))) for key in _POSITIVE}
    for key, value in sizes.items():
        if key in stated and value is not None and stated[key] >= value:
            yield f"uncertainty.{key}", f"must be below {key} itself, {value:g}"
    if set(_FORM) <= set(surface):
        skewness, kurtosis = (surface[key] for key in _FORM)
        if kurtosis - stated.get("kurtosis", 0) < 1:
            yield "uncertainty.kurtosis", f"must be at most {kurtosis - 1:g}: the kurtosis, {kurtosis:g}, is above 1"
        room = kurtosis - 1 - skewness**2
        if 0 < room < stated.get("skewness", 0) ** 2:
            largest = math.sqrt(room)
            reason = f"the kurtosis, {kurtosis:g}, is above 1 and the mean of skewness² together"
            yield "uncertainty.skewness", f"must be at most {largest:.3g}: {reason}"


#: Quantities of surfaces that are positive.
_POSITIVE = "rms_nm", "correlation_length_nm", "corner_rad_per_um"


def origins(config: Mapping[str, Any]) -> dict[tuple, tuple]:
    """Keys stated by users, as paths with their values, by the keys of complete surfaces derived from them."""
    by_key = {}
    for name, entry in config["surfaces"].items():
        if is_described(entry):
            for key, sources in _SOURCES.items():
                source = next((source for source in (*sources, "like") if source in entry), "rms_nm")
                by_key["surfaces", name, *key] = ("surfaces", name, source), entry.get(source)
    return by_key


#: Keys of a complete surface, and those that they follow from.
_SOURCES = {
    ("skewness",): ("skewness",),
    ("kurtosis",): ("kurtosis",),
    ("published_psd",): (*_LEAVES_OPEN["corner"], *_OF_SPECTRUM),
    ("published_psd", "plateau_nm4"): (),
    ("published_psd", "floor_nm4"): ("hurst",),
    ("published_psd", "corner_rad_per_um"): _LEAVES_OPEN["corner"],
    ("published_psd", "cutoff_rad_per_um"): ("cutoff_rad_per_um",),
}
