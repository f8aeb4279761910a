"""Flags of measured surfaces, as limits of every number from them."""

from collections.abc import Iterable, Mapping
from typing import Any

import xarray as xr

from stiction.devices.limits.limit import Limit, Side
from stiction.plan.names import by_name

#: Kind of the notes on files, such as the choice of a channel.
NOTE = "note"
#: Side of each kind of flag, and whether its amount is known: within the errors of the surface, or zero because
#: something else is used instead. A surface that is too rough sticks less than the measured one, the unsafe side.
SIDES = {
    "no_plateau": (Side.SAFE, False),
    "few_wavelengths": (Side.EITHER, False),
    "bowed": (Side.UNSAFE, False),
    "holes": (Side.EITHER, False),
    "not_homogeneous": (Side.EITHER, False),
    "scans_differ": (Side.EITHER, False),
    "sizes_differ": (Side.EITHER, False),
    "places_differ": (Side.EITHER, True),
    "spectra_differ": (Side.EITHER, False),
    "small_scans": (Side.EITHER, True),
    "power_law_is_not_resolved": (Side.SAFE, False),
    "spectrum_misfits": (Side.EITHER, True),
    "noise": (Side.EITHER, False),
    "noise_stays": (Side.EITHER, False),
    "spectrum_ends": (Side.EITHER, False),
    "anisotropic": (Side.EITHER, False),
    "moments_have_no_density": (Side.EITHER, True),
    "moments_do_not_describe": (Side.EITHER, False),
    "errors_are_wider": (Side.EITHER, True),
    "tip_rounds": (Side.EITHER, False),
    "lines_jump": (Side.EITHER, False),
    "summits_differ": (Side.EITHER, False),
    "no_summits": (Side.EITHER, False),
    "grid_ends": (Side.SAFE, False),
    "correlated_strips": (Side.EITHER, False),
    "correlated_edges": (Side.EITHER, False),
    NOTE: (Side.EITHER, False),
}


def flagged(flags: Iterable[tuple[str, str]]) -> dict[str, tuple]:
    """Variables of a dataset from the kinds and sentences of its flags."""
    flags = list(flags)
    return {
        "flags": ((), "\n".join(sentence for _, sentence in flags)),
        "flag_kinds": ((), "\n".join(kind for kind, _ in flags)),
    }


def flags(*datasets: xr.Dataset) -> list[str]:
    """Sentences on the limits of a measured surface, from the datasets of its estimate and of its spectrum."""
    return [flag for dataset in datasets for flag in str(dataset["flags"].item()).splitlines()]


def inputs(plan: Any, *pairs: str) -> dict[str, dict[str, str]]:
    """Estimates and spectra of the measured surfaces of some pairs."""
    names = list(dict.fromkeys(name for pair in pairs for name in plan.scans.sides(pair)))
    return {"estimates": by_name("estimate", names), "spectra": by_name("spectrum", names)}


def limits_of(data: Mapping[str, Mapping[str, xr.Dataset]]) -> dict[str, list[Limit]]:
    """Flags of every measured surface as limits, from the datasets of `inputs`."""
    return {name: _limits(name, estimate, data["spectra"][name]) for name, estimate in data["estimates"].items()}


def together(data: Mapping[str, Mapping[str, xr.Dataset]]) -> list[Limit]:
    """Flags of all measured surfaces."""
    return [limit for limits in limits_of(data).values() for limit in limits]


def _limits(surface, *datasets):
    """Limits from the flags of datasets, with their sentences as numbers."""
    kinds = [kind for dataset in datasets for kind in str(dataset["flag_kinds"].item()).splitlines()]
    return [
        Limit(kind, *SIDES[kind], numbers={"surface": surface, "flag": flag})
        for kind, flag in zip(kinds, flags(*datasets), strict=True)
    ]
