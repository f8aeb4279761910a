r"""Polynomial chaos of Eq. (19): basis, projection and sum (App. B-B, step ii).

Convention: :math:`\Psi_\alpha(\xi) = \prod_j P_{\alpha_j}(\xi_j)` with the shifted Legendre polynomials normalised to
:math:`\int_0^1 P_a P_b \, d\xi = \delta_{ab}`. The multi-indices α are in lexicographic order, the constant first.
"""

from collections.abc import Sequence
from itertools import product

import numpy as np

from stiction.kernels import kernel

#: Points per dimension of the quadrature that projects the conditional quantiles: polynomials up to MAX_ORDER are
#: orthonormal on them to 1e-12, and the coefficients of a normal quantile are accurate to 1e-5.
NODES = 32
#: Largest total order N_d.
MAX_ORDER = 12

#: Points evaluated together, few enough that their polynomials of one coordinate fit into the first-level cache.
_BLOCK = 128


def multi_indices(order: int, dimension: int) -> np.ndarray:
    """Multi-indices α of total order up to N_d, (N, N_g) int64, with N = (N_d + N_g)! / (N_g! N_d!).

    Examples
    --------
    >>> len(multi_indices(12, 3))
    455
    """
    return np.array([alpha for alpha in product(range(order + 1), repeat=dimension) if sum(alpha) <= order])


@kernel
def legendre(points: np.ndarray, values: np.ndarray) -> None:
    """Write the orthonormal Legendre polynomials on [0, 1] at ``points`` (n,) to ``values`` (order + 1, n)."""
    for i in range(points.size):
        values[0, i] = 1.0
        if len(values) > 1:
            values[1, i] = 2 * points[i] - 1
    for a in range(1, len(values) - 1):
        for i in range(points.size):
            values[a + 1, i] = ((2 * a + 1) * values[1, i] * values[a, i] - a * values[a - 1, i]) / (a + 1)
    for a in range(len(values)):
        norm = np.sqrt(2 * a + 1)
        for i in range(points.size):
            values[a, i] *= norm


def quadrature() -> tuple[np.ndarray, np.ndarray]:
    """Points and weights for integrals over [0, 1] of functions with steep ends, such as quantiles, (NODES,) each.

    Gauss-Legendre in t with ξ = t²(3 - 2t), which concentrates the points at the ends, where quantiles diverge.
    With the same number of points in ξ itself the coefficients of a normal quantile would be 300 times less accurate.
    """
    x, w = np.polynomial.legendre.leggauss(NODES)
    t = 0.5 * (1 + x)
    return t * t * (3 - 2 * t), 3 * w * t * (1 - t)


def project(tables: Sequence[np.ndarray], order: int) -> np.ndarray:
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
        for _ in range(k):  # contracts the first axis and appends the polynomial orders as the last
            table = np.tensordot(table, values * weights, axes=(0, 1))
        used = ~indices[:, k:].any(axis=1)
        coefficients[k - 1, used] = table[tuple(indices[used, :k].T)]
    return coefficients


def expand(xi: np.ndarray, indices: np.ndarray, coefficients: np.ndarray) -> np.ndarray:
    """Sum of Eq. (19): coordinates η (n, N_g) at points ξ (n, N_g) of the unit cube.

    Parameters
    ----------
    xi : (n, N_g) float64
    indices : (N, N_g) int64
        Multi-indices α as from `multi_indices`; the first of the last one is the total order.
    coefficients : (N_g, N) float64
        Zero where α involves a later coordinate than that of the row.
    """
    eta = np.empty(xi.shape[::-1])
    _expand(np.ascontiguousarray(xi.T), indices, coefficients, int(indices[-1, 0]), eta)
    return eta.T


# Inlined: passing an array to a compiled function counts its references, which takes longer than these loops.


@kernel(inline="always")
def _multiply(left, values, a, out):
    """Write left · values[a]."""
    for i in range(_BLOCK):
        out[i] = left[i] * values[a, i]


@kernel(inline="always")
def _add_products(factors, left, values, out):
    """Add Σ factors[a] · left · values[a], in the order of a."""
    # Two terms in one loop: half as many loads and stores of the sum.
    pairs = factors.size // 2
    for a in range(0, 2 * pairs, 2):
        for i in range(_BLOCK):
            out[i] = out[i] + factors[a] * (left[i] * values[a, i]) + factors[a + 1] * (left[i] * values[a + 1, i])
    for a in range(2 * pairs, factors.size):
        for i in range(_BLOCK):
            out[i] += factors[a] * (left[i] * values[a, i])


@kernel
def _expand_block(xi, indices, coefficients, values, partial, eta):
    """Sum Eq. (19) over a block: ``xi`` and ``eta`` (N_g, _BLOCK), with ``values`` and ``partial`` as workspace.

    The terms are summed in runs that differ in the last index only, 0, 1, ...; the product of the others is common.
    """
    (terms, dimension), run = indices.shape, 0
    last = dimension - 1
    for j in range(dimension):
        legendre(xi[j], values[j])
    partial[0].fill(1.0)
    eta.fill(0.0)
    while run < terms:
        end = run + 1
        while end < terms and indices[end, last] > 0:
            end += 1
        first, used = 0, last
        while run > 0 and first < last and indices[run, first] == indices[run - 1, first]:
            first += 1  # the product over the leading dimensions is unchanged from the previous run
        for j in range(first, last):
            _multiply(partial[j], values[j], indices[run, j], partial[j + 1])
        while used > 0 and indices[run, used] == 0:
            used -= 1  # coordinate k depends on the first k dimensions only
        for k in range(used, last):
            _add_products(coefficients[k, run : run + 1], partial[last], values[last], eta[k])
        _add_products(coefficients[last, run:end], partial[last], values[last], eta[last])
        run = end


@kernel
def _expand(xi, indices, coefficients, order, eta):
    """Sum Eq. (19) at points (N_g, n), block by block. Unused points fill up the last block."""
    dimension, n = xi.shape
    points, block = np.zeros((dimension, _BLOCK)), np.empty((dimension, _BLOCK))
    values, partial = np.empty((dimension, order + 1, _BLOCK)), np.empty((dimension, _BLOCK))
    for start in range(0, n, _BLOCK):
        size = min(_BLOCK, n - start)
        for j in range(dimension):
            for i in range(size):
                points[j, i] = xi[j, start + i]
        _expand_block(points, indices, coefficients, values, partial, block)
        for k in range(dimension):
            for i in range(size):
                eta[k, start + i] = block[k, i]
