"""Parts of a configuration equal to the paper's, for the comparison of results with published values.

Nothing that is computed depends on them.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from stiction.config.reading import paper
from stiction.models import SIDES

#: Keys of the measured statistics of a surface: moments of the heights and summit statistics.
MOMENTS = ("rms_nm", "skewness", "kurtosis")
SUMMITS = ("mean_summit_radius_um", "summit_density_per_um2")
#: Keys that define the beam that the paper measured and simulated.
_OF_BEAM = {"beam": ("length_um", "width_um", "thickness_um"), "solid": ("young_modulus_GPa",)}


def _equal(value, other):
    """Whether two values are equal, numbers within what a conversion of units rounds."""
    if isinstance(value, Mapping) and isinstance(other, Mapping):
        return value.keys() == other.keys() and all(_equal(value[key], other[key]) for key in value)
    if isinstance(value, int | float) and isinstance(other, int | float):
        return math.isclose(value, other, rel_tol=1e-6)
    return value == other


def _same(section, other, only=None, but=()):
    """Whether two sections agree in some keys, by default in all. ``False`` if the other section is ``None``."""
    if other is None:
        return False
    keys = only or {*section, *other} - set(but)
    return all(_equal(section.get(key), other.get(key)) for key in keys)


def _has(config, sections):
    """Whether some keys of sections have the values of the paper."""
    return all(_same(config[section], paper()[section], only=keys) for section, keys in sections.items())


def is_surface(config: dict, name: str) -> bool:
    """Whether a surface has the measured statistics and the published spectrum of the paper."""
    return _same(config["surfaces"][name], paper()["surfaces"].get(name), but=["psd"])


def is_pair(config: dict, name: str) -> bool:
    """Whether a pair has surfaces, gap and beam of the paper, for comparison with published values."""
    pair = config["pairs"][name]
    return (
        _has(config, _OF_BEAM)
        and _same(pair, paper()["pairs"].get(name), only=[*SIDES, "gap_um"])
        and all(is_surface(config, pair[side]) for side in SIDES)
    )


@dataclass(frozen=True)
class PaperCase:
    """Parts of a plan shared with the case study of the paper."""

    plan: Any  #: a `stiction.plan.plan.Plan`

    @property
    def config(self) -> dict:
        """Configuration of the plan."""
        return self.plan.config

    @cached_property
    def surfaces(self) -> list[str]:
        """Surfaces of the paper among the computed ones."""
        return [name for name in self.plan.surfaces if is_surface(self.config, name)]

    @cached_property
    def pairs(self) -> list[str]:
        """Pairs of the paper in the run."""
        return [pair for pair in self.plan.pairs if is_pair(self.config, pair)]
