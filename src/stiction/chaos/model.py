r"""Stochastic model of the apparent contact forces: polynomial chaos (Sec. III-B2, App. B).

Samples of the vector v pass through two changes of coordinates, Eqs. (15) and (16), to uncorrelated coordinates η of
variance 1. Their density is a mixture of Gaussian kernels; its conditional quantiles, one coordinate after the other,
map a uniform vector ξ in the unit cube to η, and Eq. (19) expands this map in polynomials.

Convention: :math:`\Psi_\alpha(\xi) = \prod_j P_{\alpha_j}(\xi_j)` with the shifted Legendre polynomials scaled so that
:math:`\int_0^1 P_a P_b \, d\xi = \delta_{ab}`. The multi-indices α stand in lexicographic order, the constant first.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np
from numba import njit
from scipy.special import ndtr

from stiction.contact import forcelaw

#: Points per dimension of the quadrature that projects the conditional quantiles: on them polynomials up to MAX_ORDER
#: are orthonormal to 1e-12, and the coefficients of a normal quantile are exact to 1e-5.
NODES = 32
#: Largest total order N_d.
MAX_ORDER = 12

#: Points evaluated together, few enough that their polynomials stay in the first cache.
_BLOCK = 64


# App. B-A: input data processing


def unconstrained(vectors):
    """Vectors v (m, 4) as numbers without bounds: log e, log f_max, d_max, log(d_max - d_limit); Eq. (15) times σ."""
    e, f_max, d_max, d_limit = np.asarray(vectors, float).T
    return np.column_stack([np.log(e), np.log(f_max), d_max, np.log(d_max - d_limit)])


def constrained(free):
    """Inverse of `unconstrained`: vectors v (m, 4) that respect e > 0, f_max > 0 and d_max > d_limit."""
    log_e, log_f_max, d_max, log_gap = free.T
    return np.column_stack([np.exp(log_e), np.exp(log_f_max), d_max, d_max - np.exp(log_gap)])


def dimension_error(variances):
    """Share Err^DR of the variance that is lost when 1, 2, ... of the coordinates are kept (4,) [-]."""
    return np.append(np.cumsum(variances[:0:-1])[::-1], 0.0) / np.sum(variances)


@dataclass(frozen=True)
class PrincipalCoordinates:
    """Change of coordinates between vectors v and uncorrelated coordinates η of variance 1: Eqs. (15)-(17)."""

    scale: np.ndarray  #: standard deviations σ of Eq. (15) (4,)
    mean: np.ndarray  #: mean of q (4,)
    variances: np.ndarray  #: eigenvalues λ of the covariance of q, largest first (4,)
    axes: np.ndarray  #: eigenvectors A, one per column (4, 4)

    def reduce(self, vectors):
        """Coordinates η (m, 4) of vectors v (m, 4), Eq. (16)."""
        return (unconstrained(vectors) / self.scale - self.mean) @ self.axes / np.sqrt(self.variances)

    def restore(self, eta):
        """Vectors v (m, 4) with the first coordinates η (m, N_g) and the others at their mean, Eq. (17)."""
        steps = self.axes[:, : eta.shape[1]] * np.sqrt(self.variances[: eta.shape[1]])
        # a sum of columns, not a matrix product, whose rounding depends on the number of rows
        q = self.mean + sum(np.outer(column, step) for column, step in zip(eta.T, steps.T, strict=True))
        return constrained(q * self.scale)


def principal_coordinates(vectors):
    """Coordinates of Eqs. (15)-(16) fitted to vectors v (m, 4).

    Raises
    ------
    ValueError
        If a vector violates a constraint or a component does not vary.
    """
    free = _checked(vectors)
    scale = free.std(axis=0)
    q = free / scale
    variances, axes = np.linalg.eigh(np.cov(q.T, bias=True))
    variances, axes = variances[::-1], axes[:, ::-1]
    if not variances[-1] > 1e-12 * variances[0]:
        raise ValueError(f"components of v depend on each other exactly: eigenvalues {variances}")
    # an eigenvector has no sign: choose one, so that draws do not depend on the linear algebra library
    signs = np.sign(axes[np.abs(axes).argmax(axis=0), np.arange(4)])
    return PrincipalCoordinates(scale, q.mean(axis=0), variances.copy(), axes * signs)


def _checked(vectors):
    """Unconstrained numbers of vectors that respect the constraints (m, 4)."""
    e, f_max, d_max, d_limit = vectors.T
    bad = ~((e > 0) & (f_max > 0) & (d_max > d_limit) & np.isfinite(vectors).all(axis=1))
    if bad.any():
        k = int(bad.argmax())
        raise ValueError(f"sample {k} of {len(bad)} breaks e > 0, f_max > 0 or d_max > d_limit: v = {vectors[k]}")
    free = unconstrained(vectors)
    if not np.all(np.ptp(free, axis=0) > 0):
        raise ValueError(f"a component of v does not vary: ranges {np.ptp(free, axis=0)}")
    return free


# App. B-B (i): kernel density and its conditional quantiles


@dataclass(frozen=True)
class KernelDensity:
    """Mixture of equal Gaussian kernels around given centres."""

    centres: np.ndarray  #: centres of the m kernels (N_g, m)
    bandwidth: float  #: standard deviation of a kernel, the same along all coordinates

    def draw(self, n, rng):
        """Draw n points (n, N_g) from the density itself."""
        dimension, m = self.centres.shape
        return self.centres[:, rng.integers(m, size=n)].T + self.bandwidth * rng.standard_normal((n, dimension))


def silverman_bandwidth(samples, dimension):
    """Silverman's bandwidth for coordinates of variance 1 [-].

    Examples
    --------
    >>> round(silverman_bandwidth(5000, 3), 3)
    0.287
    """
    return (4 / (samples * (dimension + 2))) ** (1 / (dimension + 4))


def kernel_density(eta):
    """Kernel density of coordinates η (m, N_g), shrunk so that it keeps their mean 0 and covariance I exactly.

    Centres and bandwidth s are both divided by √(1 + s²) (Soize and Ghanem, J. Comput. Phys. 321, 2016).
    """
    # DEPARTS: plain kernels, as App. B reads, would inflate every variance by s², 8 % at m = 5000 and N_g = 3.
    bandwidth = silverman_bandwidth(*eta.shape)
    shrink = 1 / np.sqrt(1 + bandwidth**2)
    return KernelDensity(np.ascontiguousarray(eta.T * shrink), float(bandwidth * shrink))


@njit(cache=True, nogil=True)
def _kernel_weights(given, centres, bandwidth, weights):
    """Weight that each kernel has at the coordinates ``given`` (k,) that precede, (m,)."""
    weights[:] = 0.0
    for j in range(given.size):
        for i in range(weights.size):
            distance = (given[j] - centres[j, i]) / bandwidth
            weights[i] += distance * distance
    nearest = weights.min()
    for i in range(weights.size):
        weights[i] = np.exp(0.5 * (nearest - weights[i]))


@njit(cache=True, nogil=True)
def _bin_linearly(points, weights, start, step, bins):
    """Share each weight between the two nearest nodes of a grid."""
    bins[:] = 0.0
    for i in range(points.size):
        position = (points[i] - start) / step
        cell = int(position)
        upper = (position - cell) * weights[i]
        bins[cell] += weights[i] - upper
        bins[cell + 1] += upper


@njit(cache=True, nogil=True)
def _smooth(bins, taps, masses):
    """Probability of each cell, (n + taps - 1,): every node of ``bins`` (n,) spread by the taps."""
    masses[:] = 0.0
    for t in range(taps.size):
        for i in range(bins.size):
            masses[i + t] += taps[t] * bins[i]
    masses /= masses.sum()


@njit(cache=True, nogil=True)
def _invert(masses, start, step, probabilities, quantiles):
    """Quantiles at increasing probabilities of a density that is linear in each cell, tilted as its neighbours are."""
    cell, below = 1, masses[0]
    for i in range(probabilities.size):
        while below + masses[cell] < probabilities[i] and cell < masses.size - 2:
            below += masses[cell]
            cell += 1
        rest = max(probabilities[i] - below, 0.0)
        mass = masses[cell]
        tilt = 0.5 * (masses[cell + 1] - masses[cell - 1])
        tilt = min(max(tilt, -mass), mass)  # the density must not become negative
        left = mass - 0.5 * tilt  # rest = left t + tilt t² / 2, in the form that does not cancel
        part = 2 * rest / (left + np.sqrt(left * left + 2 * tilt * rest)) if rest > 0 else 0.0
        quantiles[i] = start + (cell + part) * step


@njit(cache=True, nogil=True)
def _quantile_rows(given, centres, bandwidth, grid, taps, probabilities, rows):
    """Fill ``rows`` (r, n) of `conditional_quantiles`; ``grid`` is (first node, step, number of nodes)."""
    start, step, count = grid
    coordinate = given.shape[1]
    weights = np.empty(centres.shape[1])
    bins, masses = np.empty(count), np.empty(count + taps.size - 1)
    edge = start - 0.5 * taps.size * step
    for r in range(given.shape[0]):
        _kernel_weights(given[r], centres, bandwidth, weights)
        _bin_linearly(centres[coordinate], weights, start, step, bins)
        _smooth(bins, taps, masses)
        _invert(masses, edge, step, probabilities, rows[r])


def _taps(deviation, step):
    """Probability of cells of width ``step`` around 0 under a Gaussian kernel, out to 6 deviations (2 R + 1,)."""
    reach = int(np.ceil(6 * deviation / step))
    edges = (np.arange(-reach, reach + 2) - 0.5) * step
    return np.diff(ndtr(edges / deviation))


def conditional_quantiles(density, given, probabilities):
    """Quantiles of coordinate k + 1 of a density, given the k coordinates before it.

    The weighted kernels are shared out on a grid of an eighth of the bandwidth and smoothed there: the probabilities of
    the quantiles are within 3e-4 of those by the sum over all kernels.

    Parameters
    ----------
    density : KernelDensity
        Density of N_g > k coordinates.
    given : (r, k) float64
        Values of the first k coordinates; k = 0 asks for the first coordinate.
    probabilities : (n,) float64
        Increasing, not closer than 1e-7 to 0 or 1.

    Returns
    -------
    (r, n) float64
    """
    points = density.centres[given.shape[1]]
    step = density.bandwidth / 8
    # sharing a point between two nodes adds a variance of step² / 6 on average; take it off the kernel
    taps = _taps(np.sqrt(density.bandwidth**2 - step**2 / 6), step)
    grid = (float(points.min()), float(step), int(np.ptp(points) / step) + 2)
    rows = np.empty((len(given), len(probabilities)))
    _quantile_rows(np.ascontiguousarray(given), density.centres, density.bandwidth, grid, taps, probabilities, rows)
    return rows


def quantile_tables(density, probabilities):
    """Conditional quantiles of all coordinates on a tensor grid of probabilities: the inverse Rosenblatt transform.

    Table k, of shape (n,) * k, holds η_k at the probabilities ξ_1, ..., ξ_k.
    """
    n = len(probabilities)
    given, tables = np.empty((1, 0)), []
    for k in range(1, len(density.centres) + 1):
        rows = conditional_quantiles(density, given, probabilities)
        tables.append(rows.reshape((n,) * k))
        given = np.column_stack([np.repeat(given, n, axis=0), rows.ravel()])
    return tables


# App. B-B (ii): polynomial chaos


def multi_indices(order, dimension):
    """Orders of the polynomials of total order up to N_d, (N, N_g) int64, with N = (N_d + N_g)! / (N_g! N_d!).

    Examples
    --------
    >>> len(multi_indices(12, 3))
    455
    """
    return np.array([alpha for alpha in product(range(order + 1), repeat=dimension) if sum(alpha) <= order])


@njit(cache=True, nogil=True)
def legendre(points, values):
    """Orthonormal Legendre polynomials on [0, 1] at ``points`` (n,), written to ``values`` (order + 1, n)."""
    values[0] = 1.0
    if len(values) > 1:
        values[1] = 2 * points - 1
    for a in range(1, len(values) - 1):
        for i in range(points.size):
            values[a + 1, i] = ((2 * a + 1) * values[1, i] * values[a, i] - a * values[a - 1, i]) / (a + 1)
    for a in range(len(values)):
        values[a] *= np.sqrt(2 * a + 1)


def quadrature():
    """Points and weights for integrals over [0, 1] of functions as steep at the ends as a quantile; (NODES,) each.

    Gauss-Legendre in t with ξ = t²(3 - 2t): the points crowd at the ends, where quantiles diverge. With as many points
    in ξ itself the coefficients of a normal quantile would be 300 times less accurate.
    """
    x, w = np.polynomial.legendre.leggauss(NODES)
    t = 0.5 * (1 + x)
    return t * t * (3 - 2 * t), 3 * w * t * (1 - t)


def project(tables, order):
    """Coefficients of Eq. (19) of functions tabulated at the points of `quadrature`.

    Parameters
    ----------
    tables : sequence of N_g arrays
        Table k, of shape (NODES,) * k, depends on ξ_1, ..., ξ_k only: its other coefficients are zero.
    order : int
        Total order N_d.

    Returns
    -------
    (N_g, N) float64
    """
    points, weights = quadrature()
    values = np.empty((order + 1, NODES))
    legendre(points, values)
    indices = multi_indices(order, len(tables))
    coefficients = np.zeros((len(tables), len(indices)))
    for k, table in enumerate(tables, start=1):
        for _ in range(k):  # contracts the first axis and appends its polynomials as the last
            table = np.tensordot(table, values * weights, axes=(0, 1))
        used = ~indices[:, k:].any(axis=1)
        coefficients[k - 1, used] = table[tuple(indices[used, :k].T)]
    return coefficients


@njit(cache=True, nogil=True)
def _multiply(left, right, out):
    for i in range(out.size):
        out[i] = left[i] * right[i]


@njit(cache=True, nogil=True)
def _add(factor, values, out):
    for i in range(out.size):
        out[i] += factor * values[i]


@njit(cache=True, nogil=True)
def _expand_block(xi, indices, coefficients, values, partial, eta):
    """Sum Eq. (19) over one block of points; ``xi`` and ``eta`` are (N_g, n), the rest is memory to work in."""
    terms, dimension = indices.shape
    for j in range(dimension):
        legendre(xi[j], values[j])
    partial[0] = 1.0
    eta[:] = 0.0
    for t in range(terms):
        first, last = 0, dimension - 1
        while t > 0 and indices[t, first] == indices[t - 1, first]:
            first += 1  # the product over the leading dimensions is still that of the term before
        for j in range(first, dimension):
            _multiply(partial[j], values[j, indices[t, j]], partial[j + 1])
        while last > 0 and indices[t, last] == 0:
            last -= 1  # coordinate k depends on the first k dimensions only
        for k in range(last, dimension):
            _add(coefficients[k, t], partial[dimension], eta[k])


@njit(cache=True, nogil=True)
def _expand(xi, indices, coefficients, order, eta):
    """Sum Eq. (19) at points (N_g, n), block by block."""
    dimension, n = xi.shape
    for start in range(0, n, _BLOCK):
        size = min(_BLOCK, n - start)
        values = np.empty((dimension, order + 1, size))
        partial = np.empty((dimension + 1, size))
        part = np.empty((dimension, size))
        _expand_block(xi[:, start : start + size].copy(), indices, coefficients, values, partial, part)
        eta[:, start : start + size] = part


@dataclass(frozen=True)
class ChaosModel:
    """Polynomial chaos of the vector v of one case: Eqs. (15), (17) and (19)."""

    coordinates: PrincipalCoordinates
    coefficients: np.ndarray  #: c of Eq. (19) (N_g, N); zero where α involves a later coordinate than its own
    indices: np.ndarray  #: multi-indices α (N, N_g) int64
    f_limit: float  #: pressure at d_limit [Pa]

    @property
    def dimension(self):
        """Number N_g of coordinates kept."""
        return len(self.coefficients)

    @property
    def order(self):
        """Total order N_d."""
        return int(self.indices.sum(axis=1).max())

    @property
    def dimension_error(self):
        """Err^DR for N_g = 1, ..., 4 (4,) [-]."""
        return dimension_error(self.coordinates.variances)

    @property
    def truncation_error(self):
        """Share of the variance of each coordinate η that polynomials of this order do not reach (N_g,) [-]."""
        return 1 - np.sum(self.coefficients[:, 1:] ** 2, axis=1)

    def __call__(self, xi):
        """Coordinates η (n, N_g) at points ξ (n, N_g) of the unit cube, Eq. (19)."""
        eta = np.empty(xi.shape[::-1])
        _expand(np.ascontiguousarray(xi.T), self.indices, self.coefficients, self.order, eta)
        return eta.T


def fit(vectors, f_limit, order, tolerance):
    """Polynomial chaos of sampled vectors (App. B).

    Parameters
    ----------
    vectors : (m, 4) float64
        Samples of v = [e, f_max, d_max, d_limit].
    f_limit : float
        Pressure at d_limit [Pa].
    order : int
        Total order N_d, at most MAX_ORDER.
    tolerance : float
        Largest Err^DR: the fewest coordinates that meet it are kept. DEPARTS: the paper keeps 3 in every case.

    Returns
    -------
    ChaosModel

    Raises
    ------
    ValueError
        If order or tolerance are out of range or the samples break a constraint.
    """
    if not (1 <= order <= MAX_ORDER and tolerance >= 0):
        raise ValueError(f"need a total order in 1 ... {MAX_ORDER} and a tolerance >= 0, got {order}, {tolerance}")
    coordinates = principal_coordinates(vectors)
    dimension = 1 + int(np.argmax(dimension_error(coordinates.variances) <= tolerance))
    density = kernel_density(coordinates.reduce(vectors)[:, :dimension])
    tables = quantile_tables(density, quadrature()[0])
    return ChaosModel(coordinates, project(tables, order), multi_indices(order, dimension), float(f_limit))


def truncated(model, order):
    """Model of lower total order; as the projection is orthogonal, this equals a new fit of that order."""
    kept = model.indices.sum(axis=1) <= order
    coefficients = np.ascontiguousarray(model.coefficients[:, kept])
    return ChaosModel(model.coordinates, coefficients, model.indices[kept], model.f_limit)


# Draws


def _accept(candidates, n, f_limit):
    """Collect n admissible vectors, in the order of the stream, and count the others.

    DEPARTS: Eq. (15) admits vectors without a law of Eq. (12), a_right <= 0; they are drawn anew.

    ``candidates(k)`` draws k vectors. Never are more drawn than are missing: so draws do not depend on their batching.
    """
    kept, missing, rejected = [], n, 0
    while missing > 0:
        vectors = candidates(missing)
        good = forcelaw.admissible(vectors, f_limit)
        kept.append(vectors[good])
        missing -= int(good.sum())
        rejected += int((~good).sum())
        if rejected > 10 * n + 1000:
            raise ValueError(f"{rejected} of {n - missing + rejected} vectors have no force law: the model is unusable")
    return np.concatenate([np.empty((0, 4)), *kept]), rejected


def draw(model, n, rng):
    """Draw vectors v from the chaos model; those without a law of Eq. (12) are rejected and drawn anew.

    Returns
    -------
    vectors : (n, 4) float64
        Rows [e, f_max, d_max, d_limit].
    rejected : int
        Number of vectors that were rejected on the way.

    Raises
    ------
    ValueError
        If nearly all vectors are rejected.
    """

    def candidates(k):
        return model.coordinates.restore(model(rng.random((k, model.dimension))))

    return _accept(candidates, n, model.f_limit)


def draw_laws(model, n, rng):
    """Draw force laws [f_max, d_max, a_left, a_right] (n, 4) and the number of rejected vectors, as `draw`."""
    vectors, rejected = draw(model, n, rng)
    return forcelaw.coefficients(vectors, model.f_limit), rejected


def draw_kernels(model, vectors, n, rng):
    """Draw vectors v from the kernel density that the chaos expands; returns as `draw`.

    ``vectors`` (m, 4) are the samples to which the model was fitted. A reference that is free of truncation.
    """
    density = kernel_density(model.coordinates.reduce(vectors)[:, : model.dimension])
    return _accept(lambda k: model.coordinates.restore(density.draw(k, rng)), n, model.f_limit)


def resample_laws(vectors, f_limit, n, rng):
    """Draw force laws (n, 4) of the sampled vectors (m, 4) themselves, with replacement.

    A reference that is free of any model: what it does otherwise, the chaos model does.
    """
    lawful = vectors[forcelaw.admissible(vectors, f_limit)]
    if not len(lawful):
        raise ValueError(f"none of {len(vectors)} samples has a force law")
    return forcelaw.coefficients(lawful[rng.integers(len(lawful), size=n)], f_limit)


# Quality of the fit


def statistics(vectors):
    """Mean, standard deviation, 1 % and 99 % quantile of each component (4, 4) and correlations (4, 4) of (n, 4)."""
    low, high = np.quantile(vectors, [0.01, 0.99], axis=0)
    return np.array([vectors.mean(axis=0), vectors.std(axis=0), low, high]), np.corrcoef(vectors.T)


def fit_report(model, vectors, n, rng):
    """Statistics of the input, of draws from its kernel density and of draws from the chaos.

    All three are those of vectors that have a law of Eq. (12): no others are drawn.

    Parameters
    ----------
    model : ChaosModel
        Model fitted to ``vectors``.
    vectors : (m, 4) float64
        Input samples.
    n : int
        Number of draws.
    rng : numpy.random.Generator
        Source of the draws.

    Returns
    -------
    values : (3, 4, 4) float64
        By source (input, kernels, chaos), by `statistics` and by component of v.
    correlations : (3, 4, 4) float64
        By source.
    """
    lawful = vectors[forcelaw.admissible(vectors, model.f_limit)]
    sources = lawful, draw_kernels(model, vectors, n, rng)[0], draw(model, n, rng)[0]
    values, correlations = zip(*map(statistics, sources), strict=True)
    return np.array(values), np.array(correlations)
