"""Parts of a configuration equal to the paper's, for the comparison of results with published values."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from stiction.config.cases import Case
from stiction.config.reading import paper
from stiction.models import SIDES

#: Keys of the measured statistics of a surface: moments of the heights and summit statistics.
MOMENTS = ("rms_nm", "skewness", "kurtosis")
SUMMITS = ("mean_summit_radius_um", "summit_density_per_um2")
#: Keys that define the beam that the paper measured and simulated.
_OF_BEAM = {"beam": ("length_um", "width_um", "thickness_um"), "solid": ("young_modulus_GPa",)}
#: Keys that define the mesh of the paper and, with Young's modulus and the force laws, how fine it is; it has no width.
_OF_MESH = {"beam": ("length_um", "thickness_um", "elements"), "sampling": ("strip_length_um",)}


def _same(section, other, only=None, but=()):
    """Whether two sections agree in some keys, by default in all. ``False`` if the other section is ``None``."""
    if other is None:
        return False
    keys = only or {*section, *other} - set(but)
    return all(section.get(key) == other.get(key) for key in keys)


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
        and _same(pair, paper()["pairs"].get(name), but=["humidities"])
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

    def has_mesh(self, case: Case) -> bool:
        """Whether the beams of a case have the elements of the paper, whatever their force laws.

        ASSUME: the mesh of the paper belongs to its beam, strips and pairs, up to the highest humidity of each pair. It
        is kept under other model choices, so that variants differ by their choice alone.
        """
        return case.humidity <= self._highest_on_mesh.get(case.pair, 0)

    @cached_property
    def _highest_on_mesh(self):
        """Highest humidity of the paper for each pair with beams on the elements of the paper."""
        if not _has(self.config, _OF_MESH):
            return {}
        return {
            pair: max(of_paper["humidities"])
            for pair, of_paper in paper()["pairs"].items()
            if _same(of_paper, self.config["pairs"].get(pair), but=["humidities"])
            and self._has_modulus(pair)
            and all(self._has_heights(name) for name in self.plan.sides(pair))
        }

    def _has_modulus(self, pair):
        """Whether the beam of a pair has the Young's modulus of the paper."""
        modulus = self.plan.materials.modulus(pair)
        return _same(modulus, paper()["solid"], only=list(modulus))

    def _has_heights(self, surface):
        """Whether a surface has the moments of the paper, and its published spectrum or its summits."""
        entry = self.config["surfaces"][surface]
        spectrum = ["published_psd"] if entry["psd"] == "published" else SUMMITS
        return _same(entry, paper()["surfaces"].get(surface), only=[*MOMENTS, *spectrum])
