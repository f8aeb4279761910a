r"""Spectrum of Eq. (7) from a measured one: Whittle's likelihood, within the reach of the microscope.

The ring means P of a periodogram are s_Z times a χ² variable with 2 n degrees of freedom over 2 n, so that the fit
minimises :math:`\sum n (\ln s_Z + P / s_Z)`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import minimize, minimize_scalar
from scipy.special import chdtrc

from stiction.scans.periodogram import Rings
from stiction.surface.spectrum import CutoffSelfAffine, TabulatedSpectrum

#: Longest wave of the fit: levelling and taper reduce longer ones.
_LONGEST_WAVE = 1 / 1.5
#: Shortest wave of the fit in pixels, half of the Nyquist wave number: aliases and noise raise the spectrum beyond.
_SHORTEST_WAVE = 4
#: Peak curvatures above this share of that of the tip are not resolved (Sanner et al., 2022).
_TIP_SAFETY = 0.5
#: ASSUME: the errors of rings on non-Gaussian heights exceed those of Gaussian ones by the scatter of drawn scans.
NON_GAUSSIAN = 1.15
#: A spectrum has ended where it is below this share of the fit in all further rings, and the fewest of these.
_ENDED, _RINGS_BEYOND = 0.5, 4
#: Parts of the reach differ by this factor, and so do ends that are the same at most; parts from the end over this
#: factor up to it show it, and the power law is as long.
_STEP, _SOON = 1.1, 2.0
#: Scans resolve the power law if the fit falls below this part of its plateau.
_FALLEN = 0.5
#: Fewest rings of a fit.
FEWEST_RINGS = 8
#: Largest χ² per degree of freedom of a fit, unless chance exceeds it with this probability.
MISFIT, UNLIKELY = 2.0, 0.01
#: Starting points of the search: corners per decade of the range, and exponents of the power law.
_CORNERS, _SLOPES = 12, -np.geomspace(0.5, 12, 16)
#: Logarithm of the longest wave of the corner over that of the first ring. ASSUME: a corner or an exponent that no ring
#: shows is anywhere in the range of the search.
_LONGER = np.log(4)
#: Steepest and flattest exponent of the search.
_BOUNDS = (-40.0, -0.05)
_POINTS = 2000
#: Variance that is zero but for rounding, relative to the largest one.
_ROUNDING = 1e-10


@dataclass(frozen=True)
class Reach:
    """Wave numbers resolved by a scan."""

    low: float  #: [rad m⁻¹]
    high: float  #: [rad m⁻¹]
    nyquist: float  #: of the wider distance of points [rad m⁻¹]
    tip: float  #: wave number beyond which the tip rounds the surface; infinite if it does not [rad m⁻¹]
    end: float  #: wave number beyond which the scan shows no roughness, the Nyquist wave number at most [rad m⁻¹]


def reach(
    size: tuple[float, float], pixel: tuple[float, float], shortest: float | None = None, tip: float = np.inf
) -> Reach:
    """Reach of a scan with this size and these distances of its points [m].

    The shortest wavelength used is by default four pixels, half of the Nyquist wave number [m]; ``tip`` is the reach of
    the tip, `tip_reach` [rad m⁻¹].
    """
    nyquist = np.pi / max(pixel)
    high = 2 * np.pi / (_SHORTEST_WAVE * max(pixel) if shortest is None else shortest)
    return Reach(2 * np.pi / (_LONGEST_WAVE * min(size)), min(high, nyquist, tip), nyquist, tip, nyquist)


def tip_reach(scans: Sequence[np.ndarray], pixel: float, radius: float) -> float:
    """Wave number beyond which a tip of a radius [m] rounds the surface [rad m⁻¹].

    The largest peak curvature h'' over a stencil along the fast axis, the first of the scans (n1, n2) [m], decreases
    with the length of the stencil; where it is that of the tip, less a margin, ends the reach. The pixel is that along
    this axis [m].
    """
    halves = np.arange(1, (len(scans[0]) - 1) // 4)
    curvature = np.array([max(_peak_curvature(z, half, pixel) for z in scans) for half in halves])
    sharp = np.flatnonzero(curvature > _TIP_SAFETY / radius)
    if len(sharp) == 0:
        return np.inf
    last = min(sharp[-1], len(halves) - 2)
    fraction = np.interp(-_TIP_SAFETY / radius, -curvature[[last, last + 1]], [0, 1])
    return np.pi / (pixel * (halves[last] + fraction))


def _peak_curvature(z, half, pixel):
    """Largest -h'' over stencils of ``2 half`` pixels along the fast axis [m⁻¹]."""
    return np.nanmax(2 * z[half:-half] - z[: -2 * half] - z[2 * half :]) / (half * pixel) ** 2


@dataclass(frozen=True)
class WhittleFit:
    """Plateau and power law of Eq. (7) fitted to a measured spectrum."""

    plateau: float  #: s⁰ [m⁴]
    corner: float  #: ζ₀ [rad m⁻¹]
    slope: float  #: exponent of the power law [-]
    covariance: np.ndarray  #: of (ln plateau, ln corner, slope), (3, 3) [-]
    chi2: float  #: sum over the rings of the squared relative deviations in standard errors [-]
    freedom: int  #: rings less parameters

    @property
    def errors(self) -> np.ndarray:
        """Standard errors of (ln plateau, ln corner, slope), (3,) [-]."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def amplitude_error(self) -> float:
        """Standard error of ln plateau at this corner and slope [-]."""
        return float(np.linalg.inv(self.covariance)[0, 0] ** -0.5)

    @property
    def misfit(self) -> float:
        """χ² per degree of freedom."""
        return self.chi2 / self.freedom

    @property
    def contradicted(self) -> bool:
        """Whether the spectrum is not of the form of Eq. (7)."""
        return self.misfit > MISFIT and chdtrc(self.freedom, self.chi2) < UNLIKELY

    @property
    def likely(self) -> bool:
        """Whether a spectrum of the form of Eq. (7) has such deviations by chance."""
        return chdtrc(self.freedom, self.chi2 / NON_GAUSSIAN**2) >= UNLIKELY

    def is_resolved(self, within: Reach) -> bool:
        """Whether a reach shows the power law: the fit falls below half of its plateau there."""
        return bool(shape(within.high, np.log(self.corner), self.slope) < _FALLEN)

    def density(self, wavenumber: np.ndarray) -> np.ndarray:
        """Fitted s_Z without cut-off, shape of the wave numbers [m⁴]. A trial fit may be that of no surface."""
        return self.plateau * shape(wavenumber, np.log(self.corner), self.slope)

    def spectrum(self, cutoff: float) -> CutoffSelfAffine:
        """Eq. (7) with a cut-off [rad m⁻¹]. Raises ValueError if no surface has it."""
        return CutoffSelfAffine(self.plateau, self.plateau * (cutoff / self.corner) ** self.slope, self.corner, cutoff)


def fit_to_the_end(rings: Rings, within: Reach) -> tuple[WhittleFit, Reach]:
    """Fit up to the end of the measured spectrum at most, by `fit`. Return it and the reach with that end.

    Aliases and noise raise a spectrum, so that a drop is real: the surface, or what tip and instrument leave of it, has
    no shorter waves. A fit that includes waves beyond the end bends towards them, and hides it. Where the rings
    contradict the fit, parts of the reach are therefore fitted, too. An end is one that all parts show which reach from
    half of it up to it; a spectrum that only becomes steeper has none, because longer parts show later ends. Where no
    fit up to such an end is likely, as beyond a real end where noise begins, likely fits up to their own ends compete.
    """
    fitted, high = fit(rings, within), within.high
    if fitted.contradicted:
        inside = rings.between(within.low, within.high)
        parts = [_ShorterFit(fitted, high, _end(rings, within, fitted))]
        for shorter in _shorter(inside):
            shorter_fit = fit(rings, replace(within, high=shorter))
            parts.append(_ShorterFit(shorter_fit, shorter, _end(rings, within, shorter_fit)))
        showing = _showing(parts, within.nyquist)
        likely = (candidate for candidate in showing if candidate.fitted.likely)
        ended = [candidate for candidate in parts if candidate.fitted.likely and candidate.near(candidate.end)]
        rivals = [*showing, *ended] if showing else parts
        best = next(likely, None) or min(rivals, key=lambda candidate: _deviance(inside, candidate))
        fitted, high = best.fitted, best.high
    return _up_to_the_end(rings, within, fitted, high)


@dataclass(frozen=True)
class _ShorterFit:
    """Fit to a part of the reach, and its end."""

    fitted: WhittleFit
    high: float  #: [rad m⁻¹]
    end: float  #: [rad m⁻¹]

    def near(self, end):
        """Whether this part reaches from half of an end or more up to it, at most."""
        return end / _SOON <= self.high <= end

    def shows(self, end):
        """Whether this part shows an end, up to the resolution of the parts, with a long enough power law."""
        return 1 / _STEP < self.end / end < _STEP and self.fitted.corner <= end / _SOON


def _showing(candidates, nyquist):
    """Parts near the ends shown by all parts near them, from the last end, longest part first."""
    ends = sorted(
        {candidate.end for candidate in candidates if candidates[-1].high <= candidate.end / _SOON < nyquist / _SOON},
        reverse=True,
    )
    near = [[candidate for candidate in candidates if candidate.near(end)] for end in ends]
    shown = (
        of_end for end, of_end in zip(ends, near, strict=True) if all(candidate.shows(end) for candidate in of_end)
    )
    return [candidate for of_end in shown for candidate in of_end]


def _shorter(rings):
    """Wave numbers before the end of the rings for the ends of fits, the largest first [rad m⁻¹]."""
    steps = int(np.log(len(rings.wavenumber) / FEWEST_RINGS) / np.log(_STEP))
    return rings.wavenumber[np.geomspace(len(rings.wavenumber), FEWEST_RINGS, steps + 1).astype(int)[1:] - 1]


def _deviance(rings, candidate):
    """Deviance of rings from the fit to a part. Rings beyond it count as if they were at half of the fit [-]."""
    ratio = rings.density / candidate.fitted.density(rings.wavenumber)
    ratio = np.where(rings.wavenumber <= candidate.high, np.maximum(ratio, np.finfo(float).tiny), _ENDED)
    return 2 * np.sum(rings.modes * (ratio - 1 - np.log(ratio)))


def _up_to_the_end(rings, within, fitted, high):
    """Fit with all rings up to the end shown by one up to ``high``, unless they are few or unlikely, and its reach."""
    last = min(_end(rings, within, fitted), within.high)
    if len(rings.between(within.low, last).wavenumber) >= FEWEST_RINGS:
        joint = fit(rings, replace(within, high=last))
        if joint.likely or joint.misfit <= fitted.misfit:
            fitted, high = joint, last
    end = _end(rings, within, fitted)
    return fitted, replace(within, high=min(within.high if fitted.contradicted else high, end), end=end)


def _end(rings, within, fitted):
    """First wave number with all rings beyond below half of the fit, or the Nyquist one without any [rad m⁻¹]."""
    inside = rings.between(within.low, within.nyquist)
    last = np.flatnonzero(inside.density >= _ENDED * fitted.density(inside.wavenumber))[-1]
    if len(inside.wavenumber) - 1 - last < _RINGS_BEYOND:
        return within.nyquist
    return float(inside.wavenumber[last : last + 2].mean())


def fit(rings: Rings, within: Reach) -> WhittleFit:
    """Fit plateau, corner and slope of Eq. (7) to the rings within the reach.

    Where Eq. (7) misfits, the covariance grows by χ² per degree of freedom.

    Raises
    ------
    ValueError
        If fewer than 8 rings are within the reach.
    """
    inside = rings.between(within.low, within.high)
    wavenumber, density, weight = inside.wavenumber, inside.density, inside.weight
    if len(wavenumber) < FEWEST_RINGS:
        raise ValueError(f"{FEWEST_RINGS} rings are needed within the reach of the scan, there are {len(wavenumber)}")

    def objective(parameters):
        """Half of the deviance per weight of the rings, at the best plateau."""
        relative = shape(wavenumber, *parameters)
        plateau = np.average(density / relative, weights=weight)
        return np.log(plateau) + np.average(np.log(relative), weights=weight)  # P / s is 1 on average at its optimum

    start = _start(inside)
    first, last = np.log(wavenumber[[0, -1]])
    bounds = [(first - _LONGER, last), _BOUNDS]
    corner, slope = minimize(
        objective, start, method="Nelder-Mead", bounds=bounds, options={"xatol": 1e-5, "fatol": 1e-10}
    ).x
    relative = shape(wavenumber, corner, slope)
    plateau = np.average(density / relative, weights=weight)
    chi2, freedom = float(np.sum(inside.modes * (density / (plateau * relative) - 1) ** 2)), len(wavenumber) - 3
    scale = max(chi2 / freedom, 1.0)
    bend = _corner_of_rings(objective, (corner, slope), bounds[0], weight.sum() / (scale * NON_GAUSSIAN**2))
    hidden = [_second_moment(value, *ends) for value, ends in ((corner, bounds[0]), (slope, _SLOPES[[-1, 0]]))]
    covariance = _covariance(scale, _information(wavenumber, weight, bend, slope), hidden)
    return WhittleFit(float(plateau), float(np.exp(corner)), float(slope), covariance, chi2, freedom)


def _start(rings):
    """Logarithm of the corner and slope of the best of a grid of both, by the objective of `fit`."""
    logarithm, share = np.log(rings.wavenumber), rings.weight / rings.weight.sum()
    decades = (logarithm[-1] - logarithm[0]) / np.log(10)
    corners = np.linspace(*logarithm[[0, -1]], int(_CORNERS * decades) + 3)[:-1]
    decay = np.maximum(logarithm - corners[:, None], 0.0)
    columns = [np.log(np.exp(-slope * decay) @ (share * rings.density)) + slope * decay @ share for slope in _SLOPES]
    corner, slope = np.unravel_index(np.argmin(np.transpose(columns)), (len(corners), len(_SLOPES)))
    return corners[corner], _SLOPES[slope]


def shape(wavenumber: np.ndarray, log_corner: float, slope: float) -> np.ndarray:
    """Eq. (7) with a plateau of 1 and without cut-off, shape of the wave numbers [-]."""
    return np.maximum(wavenumber / np.exp(log_corner), 1.0) ** slope


def _corner_of_rings(objective, best, ends, weight):
    """Logarithm of the corner that the rings show, or an end of its range if, but for chance, the fit there is as good.

    Without a plateau the rings show a slope alone, without a power law neither.
    """
    low, high = ends
    straight = minimize_scalar(lambda slope: objective((low, slope)), bounds=_BOUNDS, method="bounded").fun
    corner, least = best[0], objective(best)
    for end, without in ((low, straight), (high, objective((high, best[1])))):
        if chdtrc(1, 2 * weight * (without - least)) >= UNLIKELY:
            corner = end
    return corner


def _information(wavenumber, weight, log_corner, slope):
    """Fisher's information of the rings on (ln plateau, ln corner, slope), (3, 3)."""
    decay = np.log(wavenumber) - log_corner
    gradient = np.where(decay > 0, [np.ones_like(decay), np.full_like(decay, -slope), decay], 0.0)
    gradient[0] = 1.0
    return gradient * weight @ gradient.T


def _covariance(scale, information, hidden):
    """Scaled inverse of an information (3, 3), and along all that it does not show, variances of corner and slope."""
    variances, axes = np.linalg.eigh(information)
    dark = axes[:, variances <= _ROUNDING * variances.max()]
    prior = np.linalg.inv(dark[1:].T / hidden @ dark[1:])
    shown = NON_GAUSSIAN**2 * np.linalg.pinv(information, rcond=_ROUNDING, hermitian=True)
    return scale * shown + dark @ prior @ dark.T


def _second_moment(value, low, high):
    """Second moment about a value of a uniform density between two ends."""
    return ((high - value) ** 3 - (low - value) ** 3) / (3 * (high - low))


def spectrum(
    psd: str, fitted: WhittleFit, rings: Rings, within: Reach, cutoff: float
) -> CutoffSelfAffine | TabulatedSpectrum:
    """Spectrum ``fitted``, unless the rings contradict it, or ``tabulated``, up to a cut-off [rad m⁻¹]."""
    if psd == "fitted" and not fitted.contradicted:
        return fitted.spectrum(cutoff)
    return tabulated(rings, within, fitted.slope, cutoff)


def tabulated(rings: Rings, within: Reach, slope: float, cutoff: float) -> TabulatedSpectrum:
    """Measured spectrum itself: log-log interpolation of the rings within the reach, up to a cut-off [rad m⁻¹].

    ASSUME: the first ring continues to 0, and the last one to the cut-off as the power law of the fit, with this slope:
    rings beyond the reach hold aliases.
    """
    inside = rings.between(within.low, within.high)
    shown = inside.density > 0  # noise hides the others
    shown_waves, wavenumber = inside.wavenumber[shown], np.linspace(0, cutoff, _POINTS)
    inner = np.interp(
        np.log(np.maximum(wavenumber, shown_waves[0])), np.log(shown_waves), np.log(inside.density[shown])
    )
    beyond = slope * np.log(np.maximum(wavenumber / shown_waves[-1], 1.0))
    return TabulatedSpectrum(wavenumber, np.exp(inner + beyond), cutoff)
