"""Flags of measured surfaces, as warnings beside every number from them."""

from collections.abc import Mapping
from typing import Any

import xarray as xr

from stiction.plan.names import by_name


def flags(*datasets: xr.Dataset) -> list[str]:
    """Sentences on the limits of a measured surface, from the datasets of its estimate and of its spectrum."""
    return [flag for dataset in datasets for flag in str(dataset["flags"].item()).splitlines()]


def inputs(plan: Any, *pairs: str) -> dict[str, dict[str, str]]:
    """Estimates and spectra of the measured surfaces of some pairs."""
    names = list(dict.fromkeys(name for pair in pairs for name in plan.scans.sides(pair)))
    return {"estimates": by_name("estimate", names), "spectra": by_name("spectrum", names)}


def sentences(data: Mapping[str, Mapping[str, xr.Dataset]]) -> dict[str, list[str]]:
    """Flags of every measured surface, each with the name of the surface, from the datasets of `inputs`."""
    return {
        name: [f"surface {name}: {flag}" for flag in flags(estimate, data["spectra"][name])]
        for name, estimate in data["estimates"].items()
    }


def together(data: Mapping[str, Mapping[str, xr.Dataset]]) -> list[str]:
    """Flags of all measured surfaces."""
    return [sentence for flags in sentences(data).values() for sentence in flags]
