"""Errors of the quantities of surfaces without scans: as stated, or as typical surfaces scatter.

The library of typical surfaces is given as sections of a configuration with moments and the parameters of Eq. (7). The
scatter is for test beams, which correct each quantity; others see whole typical surfaces
(`stiction.config.surfaces.members`).
"""

from collections.abc import Collection, Mapping
from typing import Any, NamedTuple

import numpy as np

from stiction.models import MOMENT_QUANTITIES, SIDES, SPECTRUM_QUANTITIES

#: Quantities of `stiction.analysis.shifts` by the words of key ``unknown``, and by the keys of ``uncertainty``.
_QUANTITIES = {"rms": "rms", "skewness": "skewness", "kurtosis": "kurtosis", "corner": "corner", "hurst": "slope"}
_QUANTITIES |= {"cutoff": "cutoff"}  # which has no slope
_OF_UNCERTAINTY = {"rms_nm": "rms", "skewness": "skewness", "kurtosis": "kurtosis"}
_OF_UNCERTAINTY |= {"corner_rad_per_um": "corner", "hurst": "slope"}
#: Quantities whose errors are independent of those of the others.
_PARTS = (MOMENT_QUANTITIES[:1], MOMENT_QUANTITIES[1:], SPECTRUM_QUANTITIES)
_ALL = MOMENT_QUANTITIES + SPECTRUM_QUANTITIES

Library = Mapping[str, Mapping[str, Any]]


class Knowledge(NamedTuple):
    """Uncertain quantities of a surface, keys of `stiction.analysis.shifts.STEPS`, and covariance of their errors."""

    quantities: tuple[str, ...]
    covariance: np.ndarray  #: (k, k); of ln rms and ln corner for these

    @property
    def section(self) -> dict[str, list]:
        """Settings of a job, with the same numbers on every machine."""
        rounded = [[float(f"{value:.9g}") for value in row] for row in self.covariance]
        return {"quantities": list(self.quantities), "covariance": rounded}


def with_uncertainty(config: dict[str, Any], surfaces: Collection[str]) -> dict[str, Any]:
    """Configuration with a section of uncertainty in every device on one of these surfaces."""
    uncertain = {
        name: {"uncertainty": {}} | device
        for name, device in config.get("devices", {}).items()
        if any(config["pairs"][device["pair"]][side] in surfaces for side in SIDES)
    }
    return config | {"devices": config["devices"] | uncertain} if uncertain else config


def slope(psd: Mapping[str, float]) -> float:
    """Exponent of the power law of a section ``published_psd``."""
    falls = np.log(psd["floor_nm4"] / psd["plateau_nm4"])
    return float(falls / np.log(psd["cutoff_rad_per_um"] / psd["corner_rad_per_um"]))


def knowledge(entry: Mapping[str, Any], library: Library) -> Knowledge:
    """Errors of the quantities of a surface, from its section in normal form.

    A stated uncertainty takes the place of the scatter over the library.
    """
    variances = {quantity: deviation**2 for quantity, deviation in _deviations(entry).items()}
    names = uncertain(entry)
    indices = [_ALL.index(name) for name in names]
    covariance = scatter(library)[np.ix_(indices, indices)]
    for index, name in enumerate(names):
        if name in variances:
            covariance[index], covariance[:, index] = 0.0, 0.0
            covariance[index, index] = variances[name]
    return Knowledge(names, covariance)


def stated(entry: Mapping[str, Any]) -> Knowledge:
    """Stated errors of the quantities of a surface without those of assumed ones."""
    deviations = _deviations(entry)
    names = tuple(name for name in _ALL if deviations.get(name))
    return Knowledge(names, np.diag([deviations[name] ** 2 for name in names]).reshape(len(names), len(names)))


def uncertain(entry: Mapping[str, Any]) -> tuple[str, ...]:
    """Uncertain quantities of the section of a surface: assumed, or with an uncertainty above zero."""
    unknown, deviations = assumed(entry), _deviations(entry)
    return tuple(name for name in _ALL if name in unknown or deviations.get(name))


def assumed(entry: Mapping[str, Any]) -> dict[str, str]:
    """Assumed quantities of a surface, with their words in key ``unknown``."""
    stated = _deviations(entry)
    words = {_QUANTITIES[word]: word for word in entry.get("unknown", ())}
    return {name: word for name, word in words.items() if name not in stated}


def _deviations(entry):
    """Stated standard uncertainties by quantity: of ln rms, skewness, kurtosis, ln corner and slope."""
    stated, psd = entry.get("uncertainty", {}), entry.get("published_psd", {})
    scale = {"rms_nm": entry.get("rms_nm"), "corner_rad_per_um": psd.get("corner_rad_per_um"), "hurst": 0.5}
    return {_OF_UNCERTAINTY[key]: value / scale.get(key, 1.0) for key, value in stated.items()}


def scatter(library: Library) -> np.ndarray:
    """Covariance over the library of ln rms, skewness, kurtosis, ln corner and slope, (5, 5).

    ASSUME: the rms, the form of the heights and the spectrum of a surface say nothing about each other. Correlations
    between them over few surfaces are chance; that of skewness and kurtosis holds for all heights with a long tail.
    """
    rows = [
        [
            np.log(entry["rms_nm"]),
            entry["skewness"],
            entry["kurtosis"],
            np.log(entry["published_psd"]["corner_rad_per_um"]),
            slope(entry["published_psd"]),
        ]
        for entry in library.values()
    ]
    group = np.repeat(np.arange(len(_PARTS)), list(map(len, _PARTS)))
    return np.cov(np.transpose(rows)) * (group[:, None] == group)
