r"""Spectrum of Eq. (7) from numbers in papers: rms, Hurst exponent, and correlation length or corner.

A surface is self-affine with the Hurst exponent H if heights a distance τ apart differ by
:math:`\langle (z(x + \tau) - z(x))^2 \rangle \propto \tau^{2H}`. A power law :math:`s_Z \propto \zeta^{p}` in the
plane gives :math:`\int s_Z (1 - J_0(\zeta \tau)) \zeta \, d\zeta \propto \tau^{-p - 2}`, so that

.. math:: p = -2 (1 + H) .

ASSUME: a correlation length is the distance at which the autocovariance has fallen to 1/e of the variance, the usual
definition for random surfaces.
"""

import numpy as np

from stiction.surface.spectrum import CutoffSelfAffine

#: Autocovariance at the correlation length, in variances.
FALLEN_TO = np.exp(-1)
#: Product of wave number and distance at which 2 J₁(x) / x, the autocovariance of a plateau alone, is 1/e.
_OF_PLATEAU = 2.58384
#: Largest ζ τ of the quadrature, its largest step, and its fewest points. Beyond, slopes of -2 or below leave less than
#: 1e-5 of the variance.
_FAR, _STEP, _FEWEST = 1000.0, 0.02, 200


def slope_of(hurst: float) -> float:
    """Exponent p of the spectrum of an isotropic surface with a Hurst exponent [-].

    Examples
    --------
    >>> slope_of(0.8)
    -3.6
    """
    return -2 * (1 + hurst)


def hurst_of(slope: float) -> float:
    """Hurst exponent of an isotropic surface with this exponent of its spectrum [-].

    Examples
    --------
    >>> round(hurst_of(-3.6), 12)
    0.8
    """
    return -slope / 2 - 1


def spectrum(rms: float, slope: float, corner: float, cutoff: float) -> CutoffSelfAffine:
    """Spectrum of a surface with this rms height [m], slope [-], corner and cut-off [rad m⁻¹]."""
    plateau = rms**2 / (np.pi * corner**2)  # of a surface without roughness beyond the corner
    decay = (cutoff / corner) ** slope
    unscaled = CutoffSelfAffine(plateau, plateau * decay, corner, cutoff)
    plateau *= rms**2 / unscaled.variance
    return CutoffSelfAffine(plateau, plateau * decay, corner, cutoff)


def correlation_at(lag: float, slope: float, corner: float, cutoff: float) -> float:
    """Autocovariance at a distance [m] over the variance [-]. Spectrum as in `spectrum`, with a slope of -2 or below.

    As `stiction.surface.spectrum.autocovariance`, for a corner at any fraction of the cut-off: the plateau is
    integrated in closed form, the power law over ln ζ.
    """
    from scipy.special import j0, j1  # takes 0.2 s, and a plan needs only the numbers of spectra

    shape, end = spectrum(1e-9, slope, corner, cutoff), min(cutoff, max(_FAR / lag, corner))
    logarithms = np.linspace(np.log(corner), np.log(end), _FEWEST + int(np.log(end / corner) * end * lag / _STEP))
    zeta = np.exp(logarithms)
    beyond = np.trapezoid(shape(zeta) * zeta**2 * j0(zeta * lag), logarithms)
    plateau = shape.plateau * corner * j1(corner * lag) / lag
    return float(2 * np.pi * (plateau + beyond) / shape.variance)


def corner_of(correlation_length: float, slope: float, cutoff: float) -> float:
    """Corner [rad m⁻¹] of the spectrum of a surface with this correlation length [m].

    Raises
    ------
    ValueError
        If roughness below the cut-off [rad m⁻¹] is correlated over more than this length.
    """
    from scipy.optimize import brentq  # takes 0.2 s more

    largest = cutoff * (1 - 1e-9)  # a corner is below the cut-off

    def excess(corner):
        """Autocorrelation at the correlation length, less its required value, for a corner [rad m⁻¹]."""
        return correlation_at(correlation_length, slope, corner, cutoff) - FALLEN_TO

    if excess(largest) > 0:
        raise ValueError(
            f"need a correlation length above {1e6 * _OF_PLATEAU / cutoff:.3g} µm, over which heights without waves "
            f"beyond {cutoff:.4g} rad/m are correlated, got {1e6 * correlation_length:.3g} µm"
        )
    corner = min(1 / correlation_length, largest)
    while excess(corner) < 0:
        corner /= 2
    return float(brentq(excess, corner, largest, rtol=1e-9))
