"""Levelling: a polynomial of the whole map, then one of every line along the fast axis, by least squares.

Levelling also removes roughness of long wavelengths: `stiction.scans.model_scans` estimates how much.
"""

from dataclasses import dataclass

import numpy as np

#: Largest total degree of the polynomial of the map, and degree of that of a line.
LEVELS = {"mean": 0, "plane": 1, "quadratic": 2}
LINES = {"none": None, "offset": 0, "tilt": 1, "bow": 2}


@dataclass(frozen=True)
class Levelling:
    """Parts to be subtracted from a map of heights."""

    level: str = "plane"  #: key of `LEVELS`
    lines: str = "none"  #: key of ``LINES``


def level(heights: np.ndarray, levelling: Levelling) -> np.ndarray:
    """Level heights to mean zero, (n1, n2) with the fast axis first and NaN where undefined [m]."""
    levelled = heights - _surface(heights, LEVELS[levelling.level])
    degree = LINES[levelling.lines]
    return levelled if degree is None else levelled - _lines(levelled, degree)


def _surface(heights, degree):
    """Polynomial of total degree ``degree`` closest to the defined heights, (n1, n2) [m]."""
    along, across = (_legendre(n, degree) for n in heights.shape)
    weights = polynomial(heights, degree)
    return sum(c * np.outer(along[:, a], across[:, b]) for (a, b), c in weights.items())


def polynomial(heights: np.ndarray, degree: int) -> dict[tuple[int, int], float]:
    """Weights of the products P_a P_b of Legendre polynomials in the polynomial closest to the defined heights [m].

    Heights as in `level`; the degree is the largest sum of the degrees a along the fast and b along the slow axis.
    """
    along, across = (_legendre(n, degree) for n in heights.shape)
    terms = [(a, b) for a in range(degree + 1) for b in range(degree + 1 - a)]
    defined = np.isfinite(heights)
    basis = np.array([np.outer(along[:, a], across[:, b])[defined] for a, b in terms])
    weights = np.linalg.solve(basis @ basis.T, basis @ heights[defined])
    return dict(zip(terms, weights, strict=True))


def _lines(heights, degree):
    """Polynomial of every line ``heights[:, j]``, (n1, n2), of the smallest norm at few defined points [m]."""
    basis = _legendre(len(heights), degree)
    defined = np.isfinite(heights)
    products = (basis[:, :, None] * basis[:, None, :]).reshape(len(heights), -1)
    gram = (products.T @ defined).T.reshape(-1, degree + 1, degree + 1)
    moments = basis.T @ np.where(defined, heights, 0.0)
    return basis @ np.einsum("jab,bj->aj", np.linalg.pinv(gram, rcond=1e-12, hermitian=True), moments)


def _legendre(points, degree):
    """Legendre polynomials at equally spaced points of ±1, (points, degree + 1)."""
    return np.polynomial.legendre.legvander(np.linspace(-1, 1, points), degree)


def line_jump(heights: np.ndarray, pixel: tuple[float, float]) -> tuple[float, float]:
    """Typical step across the lines, and along them over about the same distance [m].

    Heights as in `level`; the steps are as wide as the larger distance of the points [m].

    Returns
    -------
    slow, fast : float
        Root mean squares of the medians of the steps across the lines and along them. Without jumps of the lines both
        are about equal on an isotropic surface.
    """
    points = [round(max(pixel) / p) for p in pixel]
    return _typical_step(heights.T, points[1]), _typical_step(heights, points[0])


def _typical_step(heights, points):
    """Root mean square of the medians of the steps between rows this number of points apart [m]."""
    steps = heights[points:] - heights[:-points]
    defined = steps[np.isfinite(steps).any(axis=1)]
    return float(np.sqrt(np.mean(np.nanmedian(defined, axis=1) ** 2)))
