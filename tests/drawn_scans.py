"""Scans of the published surfaces, and of one whose heights are not of maximum entropy, as a microscope sees them."""

from dataclasses import dataclass

import numpy as np
from published import MICROSCOPE, SPACING, SURFACES
from scipy.optimize import fsolve

from stiction.scans.scan import Scan
from stiction.streams import stream
from stiction.surface.field import RoughSurface, StripGrid
from stiction.surface.translation import Translation, underlying_spectrum

PIXELS = (MICROSCOPE, MICROSCOPE)


def grid(side):
    return StripGrid(side, side, SPACING, margin=1e-6)


def sample(surface, rng):
    """Every second point of a drawn surface."""
    every = round(MICROSCOPE / SPACING)
    return surface.draw(rng)[::every, ::every].astype(float)


def scans(surface, side, count, address):
    """Squares of a side [m] of a surface of this project, 20 nm between points."""
    drawn = (sample(surface, stream(1, address, k)) for k in range(count))
    return [Scan(z, (side, side), f"{address}-{k}.spm") for k, z in enumerate(drawn)]


def published(name, side, count, address="scan"):
    """Squares of a published surface."""
    return scans(SURFACES[name].on(grid(side)), side, count, f"{name}-{address}")


def truth(name):
    """Moments (ln rms, skewness, kurtosis) of a published surface."""
    surface = SURFACES[name]
    return np.array([np.log(surface.rms), surface.skewness, surface.kurtosis])


@dataclass(frozen=True)
class Cubic:
    """Heights a u + b u² + c u³ - b of a normal score u (Fleishman), with given skewness and kurtosis."""

    skewness: float
    kurtosis: float

    def __post_init__(self):
        def misfit(parameters):
            a, b, c = parameters
            return (
                a**2 + 6 * a * c + 2 * b**2 + 15 * c**2 - 1,
                2 * b * (a**2 + 24 * a * c + 105 * c**2 + 2) - self.skewness,
                24 * (a * c + b**2 * (1 + a**2 + 28 * a * c) + c**2 * (12 + 48 * a * c + 141 * b**2 + 225 * c**2))
                - (self.kurtosis - 3),
            )

        object.__setattr__(self, "parameters", fsolve(misfit, (1, 0.1 * self.skewness, 0.02)))

    def quantile_of_normal(self, score):
        a, b, c = self.parameters
        return a * score + b * (score**2 - 1) + c * score**3


def fleishman(side, count, skewness=SURFACES["B2"].skewness, kurtosis=SURFACES["B2"].kurtosis):
    """Scans with the spectrum and the rms of B2, and by default its four moments, but another density."""
    b2 = SURFACES["B2"]
    translation = Translation(Cubic(skewness, kurtosis))
    underlying = underlying_spectrum(b2.spectrum, translation, SPACING)[0]
    return scans(RoughSurface(underlying, translation, b2.rms, grid(side)), side, count, "fleishman")


def gaussian(side, count):
    """Scans with the spectrum of B2 and Gaussian heights."""
    return scans(SURFACES["B2"].with_gaussian_heights(grid(side)), side, count, "gaussian")
