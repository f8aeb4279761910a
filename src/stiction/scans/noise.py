r"""White noise of a microscope: its floor in the measured spectrum, and moments without it.

Noise that is independent from point to point has a constant spectrum up to the Nyquist wave number ζ_N. Its variance
adds to that of the surface, and its third and fourth cumulants are zero if it is Gaussian. Roughness at ζ is seen at ζ
and, folded, at other wave numbers below ζ_N; aliases rise towards ζ_N, where they resemble a floor:

.. math:: P(\zeta) = s_Z(\zeta) + \sum_{m \ne 0} s_Z(|\zeta + 2 m \zeta_N|) + N .
"""

from dataclasses import dataclass, replace
from itertools import product
from operator import attrgetter

import numpy as np
from scipy.optimize import minimize
from scipy.special import chdtrc

from stiction.scans.periodogram import Rings
from stiction.scans.whittle import FEWEST_RINGS, NON_GAUSSIAN, UNLIKELY, Reach, fit_to_the_end, shape

#: A floor is flat over this factor of wave numbers up to the Nyquist one, unless the spectrum ends before it.
_OCTAVE = 2.0
#: Directions of a ring in an eighth of a turn, of which all have the same aliases.
_DIRECTIONS = 4
#: Ends of the spectrum that are tried on either side of the best one, and logarithms of their ratios.
_ENDS, _STEPS = 6, (0.12, 0.02, 0.003)


@dataclass(frozen=True)
class Floor:
    """Constant part of a measured spectrum."""

    density: float = 0.0  #: [m⁴]
    error: float = 0.0  #: standard error of the density [m⁴]

    def variance(self, pixel: tuple[float, float]) -> tuple[float, float]:
        """Variance of the noise on points of these distances [m], and its standard error [m²]."""
        area = 4 * np.pi**2 / (pixel[0] * pixel[1])
        return area * self.density, area * self.error


def without_noise(moments: np.ndarray, variance: float) -> np.ndarray:
    """Moments (ln rms, skewness, kurtosis) without Gaussian noise of a variance [m²]. Its other cumulants are 0.

    Examples
    --------
    >>> noisy = without_noise(np.array([0.0, 0.5, 3.2]), 0.19)
    >>> [round(float(value), 3) for value in noisy]
    [-0.105, 0.686, 3.305]
    """
    log_rms, skewness, kurtosis = moments
    ratio = np.exp(2 * log_rms) / (np.exp(2 * log_rms) - variance)
    return np.array([log_rms - np.log(ratio) / 2, skewness * ratio**1.5, 3 + (kurtosis - 3) * ratio**2])


def can_be_noise(moments: np.ndarray, variance: float) -> bool:
    """Whether heights with these moments can have Gaussian noise of a variance [m²]: kurtosis above 1 + skewness²."""
    if variance >= np.exp(2 * moments[0]):
        return False
    _, skewness, kurtosis = without_noise(moments, variance)
    return bool(kurtosis > 1 + skewness**2)


def slopes_with_noise(moments: np.ndarray) -> np.ndarray:
    """Derivatives of moments without noise (ln rms, skewness, kurtosis) by its variance, (3,) [m⁻²]."""
    log_rms, skewness, kurtosis = moments
    return np.array([-0.5, 1.5 * skewness, 2 * (kurtosis - 3)]) * np.exp(-2 * log_rms)


def above(rings: Rings, within: Reach, floor: Floor) -> Reach:
    """Reach up to the last ring, noise included, of at least twice its floor."""
    inside = rings.between(within.low, within.high)
    last = np.flatnonzero(inside.density >= 2 * floor.density)
    if len(last) and last[-1] == len(inside.density) - 1:
        return within
    return replace(within, high=float(inside.wavenumber[last[-1]]) if len(last) else within.low)


def white_floor(rings: Rings, within: Reach) -> Floor:
    """White floor of the measured spectrum of scans of one size, zero if they show none.

    ASSUME: noise is independent from point to point, and aliases follow the power law of the spectrum up to its end.
    It shows beyond the end of the spectrum, or as a flat octave below the Nyquist wave number. Otherwise it is fitted
    together with Eq. (7), its aliases and its end. Such a floor counts if the rings do not contradict this fit, and
    contradict the one without a floor. Scans that do not resolve the power law show no floor: the surface itself is
    nearly flat up to their Nyquist wave number.
    """
    if len(rings.between(within.low, within.high).wavenumber) < FEWEST_RINGS:
        return Floor()
    fitted, resolved = fit_to_the_end(rings, within)
    if not fitted.is_resolved(resolved):
        return Floor()
    ended = resolved.end < resolved.nyquist
    beyond = rings.between(resolved.end if ended else resolved.nyquist / _OCTAVE, resolved.nyquist)
    flat = _flat(beyond)
    if len(flat.wavenumber) >= FEWEST_RINGS and (ended or len(flat.wavenumber) == len(beyond.wavenumber)):
        level = float(np.average(flat.density, weights=flat.weight))
        return Floor(level, NON_GAUSSIAN * level / np.sqrt(flat.weight.sum()))
    return Floor() if ended else _joint_floor(rings.between(within.low, within.nyquist), within.nyquist, fitted)


def _flat(rings):
    """Longest part of the rings, up to the last one, constant within its errors."""
    n, p = rings.modes[::-1], rings.density[::-1]
    count, first, second = (np.cumsum(n * p**power) for power in range(3))
    chi2 = np.maximum(second * (count / first) ** 2 - count, 0)  # of n (p / mean - 1)²
    constant = np.flatnonzero(_likely(chi2, np.arange(len(p))))
    return rings.between(rings.wavenumber[::-1][constant[-1]], np.inf) if len(constant) else rings.between(np.inf, 0)


def _likely(chi2, freedom):
    """Whether errors of rings have this χ² by chance."""
    return chdtrc(np.maximum(freedom, 1), chi2 / NON_GAUSSIAN**2) >= UNLIKELY


def _joint_floor(rings, nyquist, start):
    """Floor of rings up to the Nyquist wave number by a fit with Eq. (7). Zero if it is not needed or contradicted."""
    waves = _Waves.from_rings(rings.wavenumber, nyquist)
    without, *fits = (_noisy(rings, waves, np.inf, start, floor) for floor in (False, True))
    if without.likely and not _better(fits[0], without):
        return Floor()
    centre = nyquist
    for step in _STEPS:
        ends = centre * np.exp(step * np.arange(-_ENDS, _ENDS + 1))
        fits += [_noisy(rings, waves, end, start) for end in ends]
        best = min(fits, key=attrgetter("deviance"))
        centre = min(best.end, ends[-1])
    return _averaged(fits, best) if best.likely and _better(best, without) else Floor()


def _better(fitted, other):
    """Whether a fit with one more parameter is better than another by more than chance."""
    return chdtrc(1, max(other.deviance - fitted.deviance, 0.0) / NON_GAUSSIAN**2) < UNLIKELY


def _averaged(fits, best):
    """Mean floor over all ends of the spectrum by their likelihood. Its error includes the unknown end."""
    weight = np.exp((best.deviance - np.array([fit.deviance for fit in fits])) / (2 * NON_GAUSSIAN**2))
    level, error = (np.array([getattr(fit.floor, name) for fit in fits]) for name in ("density", "error"))
    mean = np.average(level, weights=weight)
    return Floor(float(mean), float(np.sqrt(np.average(error**2 + (level - mean) ** 2, weights=weight))))


@dataclass(frozen=True)
class _Waves:
    """Waves of one ring."""

    wavenumber: np.ndarray  #: [rad m⁻¹]
    ring: np.ndarray  #: number of the ring of each
    share: np.ndarray  #: of the directions of the ring that each stands for [-]

    @classmethod
    def from_rings(cls, wavenumber, nyquist):
        """Waves of rings (n,) themselves, and in some directions their aliases."""
        angle = np.pi / 4 * (np.arange(_DIRECTIONS) + 0.5) / _DIRECTIONS
        folded = np.array([shift for shift in product((0, -2, 2), repeat=2) if any(shift)]) * nyquist
        vectors = wavenumber[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
        aliases = np.linalg.norm(vectors[:, :, None, :] + folded, axis=-1).reshape(len(wavenumber), -1)
        ring = np.arange(len(wavenumber))
        return cls(
            np.concatenate([wavenumber, aliases.ravel()]),
            np.concatenate([ring, np.repeat(ring, aliases.shape[1])]),
            np.concatenate([np.ones(len(ring)), np.full(aliases.size, 1 / _DIRECTIONS)]),
        )

    def up_to(self, end):
        """Waves up to a wave number [rad m⁻¹]."""
        inside = self.wavenumber <= end
        return _Waves(self.wavenumber[inside], self.ring[inside], self.share[inside])


@dataclass(frozen=True)
class _Noisy:
    """Fit of Eq. (7) with a floor."""

    end: float  #: of the spectrum [rad m⁻¹]
    floor: Floor
    deviance: float  #: twice the negative logarithm of the likelihood, less a constant
    likely: bool  #: whether the rings have their χ² by chance


def _noisy(rings, waves, end, start, floor=True):
    """Fit plateau, corner, slope and floor of a spectrum with this end."""
    up_to_end = waves.up_to(end)

    def total(parameters):
        """Spectrum in the rings relative to its plateau, with the floor [-]."""
        form = up_to_end.share * shape(up_to_end.wavenumber, *parameters[:2])
        return np.bincount(up_to_end.ring, form, len(rings.density)) + (np.exp(parameters[2]) if floor else 0.0)

    def objective(parameters):
        """Half of the deviance per weight of the rings, at the best plateau."""
        relative = total(parameters)
        plateau = np.average(rings.density / relative, weights=rings.weight)
        return np.log(plateau) + np.average(np.log(relative), weights=rings.weight)

    guess = [np.log(start.corner), start.slope, np.log(rings.density.min() / start.plateau)]
    optimum = minimize(objective, guess[: 2 + floor], method="Nelder-Mead", options={"xatol": 1e-4, "fatol": 1e-8})
    relative = total(optimum.x)
    plateau = np.average(rings.density / relative, weights=rings.weight)
    chi2 = np.sum(rings.modes * (rings.density / (plateau * relative) - 1) ** 2)
    level = plateau * np.exp(optimum.x[2]) if floor else 0.0
    return _Noisy(
        end,
        Floor(float(level), float(level * _relative_error(rings, total, optimum.x)) if floor else 0.0),
        float(2 * rings.weight.sum() * optimum.fun),
        bool(_likely(chi2, len(rings.density) - 3 - floor)),
    )


def _relative_error(rings, total, parameters):
    """Standard error of the floor over the floor, by Fisher's information of plateau, corner, slope and floor [-]."""
    steps = 1e-4 * np.eye(len(parameters))
    slopes = [(np.log(total(parameters + step)) - np.log(total(parameters - step))) / 2e-4 for step in steps]
    gradient = np.array([np.ones_like(rings.density), *slopes])  # the floor is relative to the plateau
    covariance = NON_GAUSSIAN**2 * np.linalg.pinv(gradient * rings.weight @ gradient.T, hermitian=True)
    combined = np.array([1.0, 0, 0, 1.0])
    return np.sqrt(combined @ covariance @ combined)
