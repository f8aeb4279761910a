"""The four surfaces of Tables I and II, from the configuration, in SI units."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import yaml

from stiction.config.units import in_si
from stiction.streams import stream
from stiction.surface import maxent
from stiction.surface.field import RoughSurface
from stiction.surface.spectrum import CutoffSelfAffine
from stiction.surface.translation import Translation, underlying_spectrum

CONFIG = Path(__file__).parents[1] / "config.yaml"
#: Spacing of the generated surfaces; fine enough for the largest cut-off of Table II [m].
SPACING = 10e-9
#: Interval at which the microscope of Table I sampled the heights [m].
MICROSCOPE = 20e-9


@dataclass(frozen=True, repr=False)
class PublishedSurface:
    """One surface: AFM column of Table I, row of Table II."""

    rms: float
    skewness: float
    kurtosis: float
    mean_summit_radius: float
    summit_density: float
    psd: str
    published_psd: CutoffSelfAffine

    @cached_property
    def spectrum(self):
        return self.published_psd

    @cached_property
    def density(self):
        return maxent.solve(self.skewness, self.kurtosis)

    @cached_property
    def translation(self):
        return Translation(self.density)

    @cached_property
    def underlying(self):
        return underlying_spectrum(self.spectrum, self.translation, SPACING)[0]

    @cached_property
    def defect(self):
        return underlying_spectrum(self.spectrum, self.translation, SPACING)[1]

    def on(self, grid):
        """Return the non-Gaussian surface (NG)."""
        return RoughSurface(self.underlying, self.translation, self.rms, grid)

    def with_gaussian_heights(self, grid):
        """Return the surface with the same spectrum and rms but Gaussian heights (G)."""
        return RoughSurface(self.spectrum, IDENTITY, self.rms, grid)


IDENTITY = Translation(maxent.GAUSSIAN)
SURFACES = {
    name: in_si(PublishedSurface, entry)
    for name, entry in yaml.safe_load(CONFIG.read_text(encoding="utf-8"))["surfaces"].items()
}


def streams(number):
    """Random streams of both surfaces of a sample."""
    return stream(2021, "beam", number), stream(2021, "substrate", number)
