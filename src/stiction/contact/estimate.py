r"""Mean force curve and force law of two surfaces, estimated without drawing them (Sec. III-A).

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
#: Smallest slope of a translation of heights, where the highest peaks are flat.
_FLATTEST = 0.05
#: Ratio of f_limit to f_max.
_LIMIT = 1.5


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


def force_law(
    surface: ProfileMoments, asperity: Asperity, heights: np.ndarray, film: tuple[float, float], points: int = 40
) -> tuple[float, float]:
    """Estimates of f_max [Pa] and a_left [m⁻¹] of Eq. (12) for heights that are not Gaussian.

    A surface of the model is a monotonic translation of a Gaussian one, Eq. (5), so that its summits are those of the
    Gaussian surface, at translated heights and with radii divided by the slope of the translation. On the surfaces of
    the paper the foundation length that follows is 0.84 to 1.05 of that of the contact for pairs a and b, and 0.6 to
    0.9 for pair c.

    ASSUME: f_limit is 1.5 f_max; it is 1 to 3 times the mean f_max on the surfaces of pairs a and b.

    Parameters
    ----------
    surface : ProfileMoments
        Of the equivalent surface.
    asperity : Asperity
    heights : (n,) array
        Equally probable heights of the equivalent surface, increasing [m].
    film : tuple of 2 floats
        Height h_C [m] and tension [Pa] of the water.
    points : int
        Number of heights among which the summits are distributed.

    Raises
    ------
    ValueError
        If the force does not rise to f_limit where the mean planes meet.
    """
    rms, (height, tension) = np.sqrt(surface.m0), film
    mean, deviation = np.array(surface.summit_heights) / rms
    score = np.linspace(0, mean + 4 * deviation, points)
    share = np.exp(-0.5 * ((score - mean) / deviation) ** 2) / (np.sqrt(2 * np.pi) * deviation) * score[1]
    rank = (np.arange(len(heights)) + 0.5) / len(heights)
    summits = np.interp(ndtr(score), rank, heights)
    slopes = np.maximum(np.gradient(summits, score) / rms, _FLATTEST)
    distance = np.linspace(0, heights[-1] + height, 300)
    forces = (
        asperity.force(top - distance, surface.mean_radius / slope) for top, slope in zip(summits, slopes, strict=True)
    )
    solid = surface.summit_density * sum(part * force for part, force in zip(share, forces, strict=True))
    curve = solid - tension * (1 - np.interp(distance - height, heights, rank, left=0.0, right=1.0))
    deepest = int(np.argmin(curve))
    limit = _LIMIT * -curve[deepest]
    above = np.flatnonzero(curve[:deepest] >= limit)
    if not above.size:
        raise ValueError("the estimated force does not rise to f_limit where the mean planes meet")
    last = above[-1]
    d_limit = np.interp(-limit, -curve[last : last + 2], distance[last : last + 2])
    steepness = np.log(1 + np.sqrt(1 + _LIMIT)) / (distance[deepest] - d_limit)
    return float(-curve[deepest]), float(steepness)
