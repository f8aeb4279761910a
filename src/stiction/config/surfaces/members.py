"""Whole typical surfaces in place of one that is partly assumed.

``like: B2`` says that a surface is one of the typical surfaces, and not which one. A member is the surface with all
assumed quantities of one typical surface: what is stated stays. Quantities of different surfaces do not mix, so that
a member also has what no slope describes, such as the cut-off.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from stiction.config.surfaces.knowledge import Library, assumed, slope
from stiction.devices.limits.limit import Limit, Side
from stiction.surface import self_affine

#: Halvings of the way from the stated to the typical form of the heights.
_HALVINGS = 12
#: Logarithm of the least ratio of cut-off to corner, and relative difference of equal numbers.
_APART, _ROUNDING = 0.05, 1e-6


def members(entry: Mapping[str, Any], library: Library, end: float = np.inf) -> dict[str, dict[str, float]]:
    """Assumed quantities of a surface in normal form, as of each surface of the library, none from fewer than two.

    The numbers are by the words of key ``unknown``, in the units of the configuration; ``hurst`` is the slope of the
    spectrum [-].

    ASSUME: where a member cannot have what is stated, its nearest feasible quantities take part: heights on the way
    from the stated form, a corner below the cut-off, a cut-off up to an ``end``, the Nyquist wave number [rad/µm].

    ASSUME: a corner from a stated correlation length stays, also with another slope. For 60 nm it would be between 24
    and 37 rad/µm with the slopes of the library.
    """
    words = list(assumed(entry).values())
    if not words or len(library) < 2:
        return {}
    stated, typical = quantities(entry), {name: quantities(other) for name, other in library.items()}
    return {name: _feasible({word: others[word] for word in words}, stated, end) for name, others in typical.items()}


def quantities(entry: Mapping[str, Any]) -> dict[str, float]:
    """Quantities of a surface in normal form by the words of key ``unknown``, as far as it states them."""
    numbers = {"rms": entry["rms_nm"], "skewness": entry["skewness"], "kurtosis": entry["kurtosis"]}
    if psd := entry.get("published_psd"):
        numbers |= {"corner": psd["corner_rad_per_um"], "hurst": slope(psd), "cutoff": psd["cutoff_rad_per_um"]}
    return numbers


def is_itself(entry: Mapping[str, Any], member: Mapping[str, float]) -> bool:
    """Whether a member is the surface as stated."""
    stated = quantities(entry)
    return all(np.isclose(stated.get(word, np.nan), value, rtol=_ROUNDING) for word, value in member.items())


def like(surface: str, member: str) -> str:
    """Name of a member in budgets."""
    return f"{surface} like {member}"


def _feasible(member, stated, end):
    """Quantities of a member, changed where the surface cannot have them with its own others."""
    member = dict(member)
    if len(form := {"skewness", "kurtosis"} & set(member)) == 1:  # both are of one surface, which has them
        member |= _form(*form, stated, member)
    if "cutoff" in member:
        least = 0.0 if "corner" in member else stated.get("corner", 0.0) * np.exp(_APART)
        member["cutoff"] = float(max(min(member["cutoff"], end), least))
    if "corner" in member and (cutoff := (stated | member).get("cutoff")):
        member["corner"] = float(min(member["corner"], cutoff * np.exp(-_APART)))
    return member


def _form(word, stated, member):
    """Skewness or kurtosis of a member, feasible beside the other one of the surface, by its word."""
    from stiction.surface.feasible import is_feasible  # only few plans need it

    other = stated["kurtosis" if word == "skewness" else "skewness"]

    def is_possible(value):
        """Whether heights have this value."""
        return is_feasible(value, other) if word == "skewness" else is_feasible(other, value)

    if is_possible(member[word]):
        return {}
    near, far = stated[word], member[word]
    for _ in range(_HALVINGS):
        middle = 0.5 * (near + far)
        near, far = (middle, far) if is_possible(middle) else (near, middle)
    return {word: near}


def limits(name: str, entry: Mapping[str, Any], library: Library, end: float = np.inf) -> list[Limit]:
    """Limits by the assumed quantities of a surface, none without any. The end is as of `members`."""
    if not (words := list(assumed(entry).values())):
        return []
    stated, others = (
        _shown(quantities(entry)),
        {other: _shown(member) for other, member in members(entry, library, end).items()},
    )
    listed = [[word, _rounded(stated.get(word)), _scatter(word, others)] for word in words]
    numbers = {"surface": name, "library": list(library), "listed": listed}
    if not others:
        return [Limit("assumed_without_scatter", Side.EITHER, False, numbers=numbers)]
    limits_of_members = [Limit("assumed_surface", Side.EITHER, True, numbers=numbers)]
    typical = {other: _shown(quantities(library[other])) for other in others}
    changed = [
        [word, _rounded(value), _rounded(typical[other][word]), other]
        for other, member in others.items()
        for word, value in member.items()
        if not np.isclose(value, typical[other][word], rtol=_ROUNDING)
    ]
    numbers = {"surface": name, "changed": changed}
    return [*limits_of_members, *([Limit("unlike_typical", Side.EITHER, True, numbers=numbers)] if changed else [])]


#: Quantities whose scatter is that of their logarithm.
_RELATIVE = ("rms", "corner", "cutoff")


def _shown(member):
    """Quantities as readers know them, with the Hurst exponent in place of the slope."""
    return member | ({"hurst": self_affine.hurst_of(member["hurst"])} if "hurst" in member else {})


def _scatter(word, others):
    """Scatter of a quantity over typical surfaces, of its logarithm for some, or None without any."""
    values = [member[word] for member in others.values()]
    return _rounded(np.std(np.log(values) if word in _RELATIVE else values, ddof=1)) if values else None


def _rounded(value):
    """Number with nine digits, the same on every machine, or None."""
    return None if value is None else float(f"{value:.9g}")
