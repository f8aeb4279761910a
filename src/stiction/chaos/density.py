"""Kernel density of the coordinates η and its conditional quantiles (App. B-B, step i)."""

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr

from stiction.kernels import kernel


@dataclass(frozen=True)
class KernelDensity:
    """Mixture of equal Gaussian kernels."""

    centres: np.ndarray  #: centres of the m kernels (N_g, m)
    bandwidth: float  #: standard deviation of a kernel, the same for all coordinates

    def draw(self, n: int, rng: np.random.Generator) -> np.ndarray:
        """Draw n points (n, N_g)."""
        dimension, m = self.centres.shape
        return self.centres[:, rng.integers(m, size=n)].T + self.bandwidth * rng.standard_normal((n, dimension))


def silverman_bandwidth(samples: int, dimension: int) -> float:
    """Silverman's bandwidth for coordinates of unit variance [-].

    Examples
    --------
    >>> round(silverman_bandwidth(5000, 3), 3)
    0.287
    """
    return (4 / (samples * (dimension + 2))) ** (1 / (dimension + 4))


def kernel_density(eta: np.ndarray) -> KernelDensity:
    """Kernel density of coordinates η (m, N_g), scaled to preserve their mean 0 and covariance I exactly.

    Centres and bandwidth s are both divided by √(1 + s²) (Soize and Ghanem, J. Comput. Phys. 321, 2016).
    """
    # DEPARTS: unscaled kernels, as in App. B, would inflate every variance by s²: 8 % at m = 5000 and N_g = 3.
    bandwidth = silverman_bandwidth(*eta.shape)
    shrink = 1 / np.sqrt(1 + bandwidth**2)
    return KernelDensity(np.ascontiguousarray(eta.T * shrink), float(bandwidth * shrink))


@kernel
def _add_squares(value, centres, bandwidth, before, squares):
    """Squared distances (m,) of the kernels in the coordinates ``before``, plus those in one more, in bandwidths."""
    for i in range(centres.size):
        distance = (value - centres[i]) / bandwidth
        squares[i] = before[i] + distance * distance


@kernel
def _kernel_weights(squares, weights):
    """Weight of each kernel (m,) at these squared distances from the preceding coordinates."""
    nearest = squares.min()
    for i in range(weights.size):
        weights[i] = np.exp(0.5 * (nearest - squares[i]))


@kernel
def _locate(points, start, step, cells, fractions):
    """Cells of points (m,) on a grid, and their positions within the cells."""
    for i in range(points.size):
        position = (points[i] - start) / step
        cells[i] = int(position)
        fractions[i] = position - cells[i]


@kernel
def _bin_linearly(cells, fractions, weights, bins):
    """Split each weight between the two nearest nodes of a grid."""
    bins.fill(0.0)
    for i in range(cells.size):
        upper = fractions[i] * weights[i]
        bins[cells[i]] += weights[i] - upper
        bins[cells[i] + 1] += upper


@kernel
def _smooth(bins, taps, masses):
    """Probability of each cell (n + taps - 1,): convolution of ``bins`` (n,) with the taps."""
    masses.fill(0.0)
    for t in range(taps.size):
        for i in range(bins.size):
            masses[i + t] += taps[t] * bins[i]
    total = masses.sum()
    for i in range(masses.size):
        masses[i] /= total


@kernel
def _invert(masses, start, step, probabilities, quantiles):
    """Quantiles at increasing probabilities of a density linear within each cell, sloped as its neighbours."""
    cell, below = 1, masses[0]
    for i in range(probabilities.size):
        while below + masses[cell] < probabilities[i] and cell < masses.size - 2:
            below += masses[cell]
            cell += 1
        remainder = max(probabilities[i] - below, 0.0)
        mass = masses[cell]
        tilt = 0.5 * (masses[cell + 1] - masses[cell - 1])
        tilt = min(max(tilt, -mass), mass)  # the density must not become negative
        linear = mass - 0.5 * tilt  # remainder = linear t + tilt t² / 2, solved in the form without cancellation
        fraction = 2 * remainder / (linear + np.sqrt(linear * linear + 2 * tilt * remainder)) if remainder > 0 else 0.0
        quantiles[i] = start + (cell + fraction) * step


@kernel
def _quantile_rows(leading, centres, bandwidth, grid, taps, probabilities, rows):
    """Fill ``rows`` (r, n) of `conditional_quantiles` on a ``grid`` of (first node, step, number of nodes)."""
    start, step, count = grid
    coordinate, m = leading.shape[1], centres.shape[1]
    squares, weights = np.zeros((coordinate + 1, m)), np.empty(m)
    cells, fractions = np.empty(m, np.int64), np.empty(m)
    _locate(centres[coordinate], start, step, cells, fractions)
    bins, masses = np.empty(count), np.empty(count + taps.size - 1)
    edge = start - 0.5 * taps.size * step
    for r in range(leading.shape[0]):
        first = 0
        while r > 0 and first < coordinate and leading[r, first] == leading[r - 1, first]:
            first += 1  # the distances in the leading coordinates are unchanged from the previous row
        for j in range(first, coordinate):
            _add_squares(leading[r, j], centres[j], bandwidth, squares[j], squares[j + 1])
        _kernel_weights(squares[coordinate], weights)
        _bin_linearly(cells, fractions, weights, bins)
        _smooth(bins, taps, masses)
        _invert(masses, edge, step, probabilities, rows[r])


def _taps(deviation, step):
    """Probability of cells of width ``step`` around 0 under a Gaussian kernel, up to 6 deviations (2 R + 1,)."""
    reach = int(np.ceil(6 * deviation / step))
    edges = (np.arange(-reach, reach + 2) - 0.5) * step
    return np.diff(ndtr(edges / deviation))


def conditional_quantiles(density: KernelDensity, leading: np.ndarray, probabilities: np.ndarray) -> np.ndarray:
    """Quantiles of coordinate k + 1 of a density, conditional on the first k coordinates.

    The weighted kernels are binned on a grid of an eighth of the bandwidth and smoothed there: the probabilities of the
    quantiles agree with the sum over all kernels within 3e-4.

    Parameters
    ----------
    density : KernelDensity
        Density of N_g > k coordinates.
    leading : (r, k) float64
        Values of the first k coordinates; k = 0 for the first coordinate.
    probabilities : (n,) float64
        Increasing, at least 1e-7 away from 0 and 1.

    Returns
    -------
    (r, n) float64
    """
    points = density.centres[leading.shape[1]]
    step = density.bandwidth / 8
    # Linear binning adds a variance of step² / 6 on average; it is subtracted from that of the kernel.
    taps = _taps(np.sqrt(density.bandwidth**2 - step**2 / 6), step)
    grid = (float(points.min()), float(step), int(np.ptp(points) / step) + 2)
    rows = np.empty((len(leading), len(probabilities)))
    _quantile_rows(np.ascontiguousarray(leading), density.centres, density.bandwidth, grid, taps, probabilities, rows)
    return rows


def quantile_tables(density: KernelDensity, probabilities: np.ndarray) -> list[np.ndarray]:
    """Conditional quantiles of all coordinates on a tensor grid of probabilities: the inverse Rosenblatt transform.

    Table k, of shape (n,) * k, holds η_k at the probabilities ξ_1, ..., ξ_k.
    """
    n = len(probabilities)
    leading, tables = np.empty((1, 0)), []
    for k in range(1, len(density.centres) + 1):
        rows = conditional_quantiles(density, leading, probabilities)
        tables.append(rows.reshape((n,) * k))
        leading = np.column_stack([np.repeat(leading, n, axis=0), rows.ravel()])
    return tables
