r"""Mean force curve of two surfaces, estimated without drawing them (Sec. III-A).

Greenwood and Williamson's sum over summits with the summits of a continuous Gaussian surface (Nayak; Bush, Gibson and
Thomas, Wear 35, 1975): all have the mean radius, and their heights are normal with

.. math:: \text{mean } 4 \sqrt{m_0 / (\pi\alpha)}, \quad \text{variance } (1 - 0.8968 / \alpha) \, m_0 .

For validating a configuration before anything runs. Skewness, kurtosis and the sampling of the surfaces are ignored:
sampled surfaces have fewer and blunter summits, so that the repulsion is estimated up to a factor of two too high.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr

from stiction.contact.asperity import Asperity
from stiction.surface.spectrum import CutoffSelfAffine, NayakSummits

#: Smallest α of a Gaussian surface.
_NARROWEST = 1.5


@dataclass(frozen=True)
class ProfileMoments:
    """Spectral moments of a profile; those of a sum of independent surfaces are the sums."""

    m0: float  #: variance of the heights [m²]
    m2: float  #: of the slopes [-]
    m4: float  #: of the curvatures [m⁻²]

    @classmethod
    def of_spectrum(cls, rms: float, spectrum: CutoffSelfAffine) -> "ProfileMoments":
        """Moments of Eq. (7), scaled to an rms [m]."""
        moments = NayakSummits(spectrum).profile_moments
        return cls(*(rms**2 / moments[0] * moment for moment in moments))

    @classmethod
    def of_summits(cls, rms: float, mean_radius: float, density: float) -> "ProfileMoments":
        """Moments of a Gaussian surface with this rms [m], mean radius [m] and density [m⁻²] of summits (Nayak)."""
        m4 = np.pi * (3 / 8 / mean_radius) ** 2
        return cls(rms**2, m4 / (6 * np.pi * np.sqrt(3) * density), m4)

    @classmethod
    def of_sum(cls, surfaces: Iterable["ProfileMoments"]) -> "ProfileMoments":
        """Moments of the equivalent surface z₁ + z₂."""
        return cls(*map(sum, zip(*((each.m0, each.m2, each.m4) for each in surfaces), strict=True)))

    @property
    def summit_density(self) -> float:
        """Summits per area [m⁻²]."""
        return self.m4 / (6 * np.pi * np.sqrt(3) * self.m2)

    @property
    def mean_radius(self) -> float:
        """1 / mean curvature of the summits [m]."""
        return 3 / 8 * np.sqrt(np.pi / self.m4)

    @property
    def summit_heights(self) -> tuple[float, float]:
        """Mean and standard deviation of the heights of the summits [m]."""
        alpha = max(self.m0 * self.m4 / self.m2**2, _NARROWEST)
        return 4 * np.sqrt(self.m0 / (np.pi * alpha)), np.sqrt((1 - 0.8968 / alpha) * self.m0)


def solid_pressure(surface: ProfileMoments, asperity: Asperity, distance: np.ndarray, points: int = 400) -> np.ndarray:
    """Mean solid pressure p_s of an equivalent surface on a flat [Pa]; distances (n,) [m].

    As in `stiction.contact.pair`, summits below the mean plane are not in contact.
    """
    mean, deviation = surface.summit_heights
    height = np.linspace(0, mean + 6 * deviation, points)
    share = np.exp(-0.5 * ((height - mean) / deviation) ** 2) / (np.sqrt(2 * np.pi) * deviation) * height[1]
    interference = np.linspace(-distance[-1], height[-1], 4 * points)
    force = asperity.force(interference, surface.mean_radius)
    return surface.summit_density * (np.interp(height - distance[:, None], interference, force) @ share)


def repulsion_and_attraction(
    surface: ProfileMoments, asperity: Asperity, films: Iterable[tuple[float, float]]
) -> list[tuple[float, float]]:
    """Force at zero distance between the mean planes and largest attraction, both [Pa], for every water film.

    Parameters
    ----------
    surface : ProfileMoments
        Of the equivalent surface.
    asperity : Asperity
    films : iterable
        Height h_C [m] and tension [Pa] of the water.
    """
    films, rms = list(films), np.sqrt(surface.m0)
    distance = np.linspace(0, 6 * rms + max(height for height, _ in films), 200)
    solid = solid_pressure(surface, asperity, distance)
    curves = [solid - tension * ndtr((height - distance) / rms) for height, tension in films]
    return [(float(curve[0]), float(-curve.min())) for curve in curves]
