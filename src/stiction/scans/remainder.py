r"""Tilts and bows left by levelling, beyond chance on a stationary surface.

The coefficient of an orthonormal polynomial P_a P_b is linear in the heights, and the Fourier transform of a Legendre
polynomial is a spherical Bessel function. On a map of L1 x L2 the variance of the coefficient is therefore

.. math::

    \int s_Z(\zeta) \, w_a^2(\zeta_1 L_1) \, w_b^2(\zeta_2 L_2) \, d^2\zeta, \quad
    w_a(x) = \sqrt{2 a + 1} \, j_a(x / 2) .

These waves are longer than that of the corner, where the spectrum is flat, so that the coefficients are uncorrelated.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import fdtrc, spherical_jn

from stiction.scans.levelling import LEVELS, LINES, Levelling, polynomial
from stiction.surface.spectrum import Spectrum

#: Largest wave number of the integral in steps 2 π / L of a scan, and points per step.
_STEPS, _PER_STEP = 40, 12


@dataclass(frozen=True)
class Remainder:
    """Polynomials to be removed by a stronger levelling of scans."""

    level: str  #: that removes them, a key of `stiction.scans.levelling.LEVELS`
    rms: float  #: root mean square over all scans [m]
    likely: float  #: probability of larger coefficients by chance [-]


def remainders(
    scans: Sequence[np.ndarray], size: tuple[float, float], levelling: Levelling, spectrum: Spectrum, error: float
) -> tuple[Remainder, ...]:
    """Remainders of all stronger levels, the weakest first, in levelled heights (n1, n2) [m] of scans of one size [m].

    The sum over scans and terms of c² over its variance has an F distribution, because the spectrum of the heights is
    estimated; its plateau has this relative standard error [-]. Terms that the levelling of lines removes do not count.
    """
    remaining = []
    for name, degree in LEVELS.items():
        terms = [(a, degree - a) for a in range(degree + 1) if not _levelled(a, levelling.lines)]
        if degree > LEVELS[levelling.level] and terms:
            c = np.array([coefficients(z, terms) for z in scans])
            chi2 = np.sum(c**2 / variances(spectrum, size, terms))
            likely = fdtrc(c.size, 2 / error**2, chi2 / c.size)
            remaining.append(Remainder(name, float(np.sqrt(np.mean(np.sum(c**2, axis=1)))), float(likely)))
    return tuple(remaining)


def _levelled(degree, lines):
    """Whether levelling of lines removes this degree along the fast axis."""
    return LINES[lines] is not None and degree <= LINES[lines]


def coefficients(heights: np.ndarray, terms: Sequence[tuple[int, int]]) -> np.ndarray:
    """Coefficients of the orthonormal polynomials P_a P_b in a map (n1, n2), by least squares, (terms,) [m].

    The terms are degrees (a, b) along the fast and the slow axis, with equal sums; heights are NaN where undefined [m].
    """
    weights = polynomial(heights, sum(terms[0]))
    return np.array([weights[a, b] / np.sqrt((2 * a + 1) * (2 * b + 1)) for a, b in terms])


def variances(spectrum: Spectrum, size: tuple[float, float], terms: Sequence[tuple[int, int]]) -> np.ndarray:
    """Variances of the `coefficients` of a stationary surface on a map, (terms,) [m²]. Spectrum [m⁴] and size [m]."""
    steps = (np.arange(_STEPS * _PER_STEP) + 0.5) / _PER_STEP  # midpoints of one quadrant, in wave numbers 2 π / L
    first, second = (2 * np.pi * steps / length for length in size)
    four_cells = np.prod([4 * np.pi / _PER_STEP / length for length in size])
    density = four_cells * spectrum(np.hypot(first[:, None], second))
    return np.array([_power(a, steps) @ density @ _power(b, steps) for a, b in terms])


def _power(degree, steps):
    """w² of a Legendre polynomial, (n,) [-]."""
    return (2 * degree + 1) * spherical_jn(degree, np.pi * steps) ** 2
