r"""Stochastic model of the apparent contact forces: polynomial chaos (Sec. III-B2, App. B).

Samples of the vector v are transformed by Eqs. (15) and (16) to uncorrelated coordinates η of unit variance
(:mod:`stiction.chaos.coordinates`). Their density is a mixture of Gaussian kernels; its conditional quantiles, one
coordinate after the other, map a uniform vector ξ in the unit cube to η (:mod:`stiction.chaos.density`), and Eq. (19)
expands this map in polynomials (:mod:`stiction.chaos.polynomials`).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from stiction.chaos.coordinates import PrincipalCoordinates, dimension_error, principal_coordinates
from stiction.chaos.density import kernel_density, quantile_tables
from stiction.chaos.polynomials import MAX_ORDER, expand, multi_indices, project, quadrature
from stiction.contact import forcelaw


@dataclass(frozen=True)
class Truncation:
    """Truncation of a chaos model, from the section ``chaos`` of the configuration."""

    order: int  #: total order N_d of the polynomials
    dimension_tolerance: float  #: largest share of the variance lost by the dimension reduction [-]


@dataclass(frozen=True)
class ChaosModel:
    """Polynomial chaos of the vector v of one case: Eqs. (15), (17) and (19)."""

    coordinates: PrincipalCoordinates
    coefficients: np.ndarray  #: c of Eq. (19) (N_g, N); zero where α involves a later coordinate than that of the row
    indices: np.ndarray  #: multi-indices α (N, N_g) int64
    f_limit: float  #: pressure at d_limit [Pa]

    @property
    def dimension(self) -> int:
        """Number N_g of coordinates kept."""
        return len(self.coefficients)

    @property
    def order(self) -> int:
        """Total order N_d."""
        return int(self.indices.sum(axis=1).max())

    @property
    def dimension_error(self) -> np.ndarray:
        """Err^DR for N_g = 1, ..., 4 (4,) [-]."""
        return dimension_error(self.coordinates.variances)

    @property
    def truncation_error(self) -> np.ndarray:
        """Fraction of the variance of each coordinate η not represented by polynomials of this order (N_g,) [-]."""
        return 1 - np.sum(self.coefficients[:, 1:] ** 2, axis=1)

    def __call__(self, xi: np.ndarray) -> np.ndarray:
        """Coordinates η (n, N_g) at points ξ (n, N_g) of the unit cube, Eq. (19)."""
        return expand(xi, self.indices, self.coefficients)


def fit(vectors: np.ndarray, f_limit: float, order: int, tolerance: float) -> ChaosModel:
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
        Largest Err^DR allowed; the smallest sufficient number of coordinates is kept. DEPARTS: the paper keeps 3
        in every case.

    Raises
    ------
    ValueError
        If order or tolerance is out of range, a sample violates a constraint, or components do not vary independently.
    """
    if not (1 <= order <= MAX_ORDER and tolerance >= 0):
        raise ValueError(f"need a total order in 1 ... {MAX_ORDER} and a tolerance >= 0, got {order}, {tolerance}")
    coordinates = principal_coordinates(vectors)
    dimension = 1 + int(np.argmax(dimension_error(coordinates.variances) <= tolerance))
    density = kernel_density(coordinates.reduce(vectors)[:, :dimension])
    tables = quantile_tables(density, quadrature()[0])
    return ChaosModel(coordinates, project(tables, order), multi_indices(order, dimension), float(f_limit))


def truncated(model: ChaosModel, order: int) -> ChaosModel:
    """Model of lower total order. It equals a new fit of lower order, because the projection is orthogonal."""
    lower = model.indices.sum(axis=1) <= order
    coefficients = np.ascontiguousarray(model.coefficients[:, lower])
    return ChaosModel(model.coordinates, coefficients, model.indices[lower], model.f_limit)


# Draws


def _accept(candidates: Callable[[int], tuple[np.ndarray, np.ndarray]], n: int) -> tuple[np.ndarray, int]:
    """Collect n admissible vectors or their laws, in the order of the stream, and count the others.

    DEPARTS: Eq. (15) admits vectors without a force law of Eq. (12), a_right <= 0; they are redrawn.

    ``candidates(k)`` draws k rows and states which are admissible. Only the missing number is drawn, so that the result
    does not depend on how the draws are batched.
    """
    accepted, missing, rejected = [], n, 0
    while missing > 0:
        rows, good = candidates(missing)
        accepted.append(rows if good.all() else rows[good])
        missing -= int(good.sum())
        rejected += int((~good).sum())
        if rejected > 10 * n + 1000:
            raise ValueError(
                f"{rejected} of {n - missing + rejected} vectors drawn from the model have no force law, a_right <= 0: "
                "most samples have none either, or they are too few for chaos.order"
            )
    return accepted[0] if len(accepted) == 1 else np.concatenate([np.empty((0, 4)), *accepted]), rejected


def _judged(vectors, f_limit):
    """Vectors and their admissibility, for `_accept`."""
    return vectors, forcelaw.admissible(vectors, f_limit)


def draw(model: ChaosModel, n: int, rng: np.random.Generator) -> tuple[np.ndarray, int]:
    """Draw vectors v from the chaos model. Those without a force law of Eq. (12) are rejected and redrawn.

    Returns
    -------
    vectors : (n, 4) float64
        Rows [e, f_max, d_max, d_limit].
    rejected : int
        Number of rejected vectors.

    Raises
    ------
    ValueError
        If more than 10 n + 1000 vectors are rejected.
    """
    return _accept(lambda k: _judged(_vectors(model, k, rng), model.f_limit), n)


def draw_laws(model: ChaosModel, n: int, rng: np.random.Generator) -> np.ndarray:
    """Draw force laws [f_max, d_max, a_left, a_right] (n, 4), those of the vectors of `draw`."""
    laws, _ = _accept(lambda k: forcelaw.coefficients_where_lawful(_vectors(model, k, rng), model.f_limit), n)
    return laws


def _vectors(model, n, rng):
    """Vectors v of uniform points (n, 4), admissible or not."""
    return model.coordinates.restore(model(rng.random((n, model.dimension))))


def draw_kernels(model: ChaosModel, vectors: np.ndarray, n: int, rng: np.random.Generator) -> tuple[np.ndarray, int]:
    """Draw vectors v from the kernel density underlying the chaos model. Returns as `draw`.

    ``vectors`` (m, 4) are the samples to which the model was fitted. The result is a reference without truncation
    error.
    """
    density = kernel_density(model.coordinates.reduce(vectors)[:, : model.dimension])
    return _accept(lambda k: _judged(model.coordinates.restore(density.draw(k, rng)), model.f_limit), n)


def resample_laws(vectors: np.ndarray, f_limit: float, n: int, rng: np.random.Generator) -> np.ndarray:
    """Draw force laws (n, 4) of the sampled vectors (m, 4) themselves, with replacement.

    The result is a reference without a stochastic model: any difference from it is due to the chaos model.
    """
    lawful = vectors[forcelaw.admissible(vectors, f_limit)]
    if not len(lawful):
        raise ValueError(f"none of {len(vectors)} samples has a force law")
    return forcelaw.coefficients(lawful[rng.integers(len(lawful), size=n)], f_limit)


# Quality of the fit


def statistics(vectors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean, standard deviation, 1 % and 99 % quantile of each component (4, 4) and correlations (4, 4) of (n, 4)."""
    low, high = np.quantile(vectors, [0.01, 0.99], axis=0)
    return np.array([vectors.mean(axis=0), vectors.std(axis=0), low, high]), np.corrcoef(vectors.T)


def fit_report(
    model: ChaosModel, vectors: np.ndarray, n: int, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """Statistics of the input, of draws from its kernel density and of draws from the chaos model.

    All three include only vectors that have a force law of Eq. (12).

    Parameters
    ----------
    model : ChaosModel
        Model fitted to ``vectors``.
    vectors : (m, 4) float64
        Input samples.
    n : int
        Number of draws.
    rng : numpy.random.Generator

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
