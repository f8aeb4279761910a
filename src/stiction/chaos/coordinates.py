"""Principal coordinates of the vectors v of Eq. (11): input data processing (App. B-A)."""

from dataclasses import dataclass

import numpy as np

from stiction.kernels import kernel


def unconstrained(vectors: np.ndarray) -> np.ndarray:
    """Unbounded variables log e, log f_max, d_max, log(d_max - d_limit) of vectors v, (m, 4). Eq. (15) times σ."""
    e, f_max, d_max, d_limit = np.asarray(vectors, float).T
    return np.column_stack([np.log(e), np.log(f_max), d_max, np.log(d_max - d_limit)])


def constrained(free: np.ndarray) -> np.ndarray:
    """Inverse of `unconstrained`: vectors v (m, 4) with e > 0, f_max > 0 and d_max > d_limit."""
    log_e, log_f_max, d_max, log_gap = free.T
    return np.array([np.exp(log_e), np.exp(log_f_max), d_max, d_max - np.exp(log_gap)]).T


def dimension_error(variances: np.ndarray) -> np.ndarray:
    """Fraction Err^DR of the variance lost by keeping only 1, 2, ... coordinates (4,) [-]."""
    return np.append(np.cumsum(variances[:0:-1])[::-1], 0.0) / np.sum(variances)


@kernel
def _shift_and_scale(eta, steps, mean, scale, free):
    """Write (mean + Σ steps · η) · scale, (4, m), from coordinates (N_g, m)."""
    # A sum over coordinates: the rounding of a matrix product would depend on the number of vectors.
    for c in range(len(free)):
        for i in range(eta.shape[1]):
            free[c, i] = steps[c, 0] * eta[0, i]
        for k in range(1, len(eta)):
            for i in range(eta.shape[1]):
                free[c, i] += steps[c, k] * eta[k, i]
        for i in range(eta.shape[1]):
            free[c, i] = (mean[c] + free[c, i]) * scale[c]


@dataclass(frozen=True)
class PrincipalCoordinates:
    """Transformation between vectors v and uncorrelated coordinates η of unit variance, Eqs. (15)-(17)."""

    scale: np.ndarray  #: standard deviations σ of Eq. (15) (4,)
    mean: np.ndarray  #: mean of q (4,)
    variances: np.ndarray  #: eigenvalues λ of the covariance of q, largest first (4,)
    axes: np.ndarray  #: eigenvectors A, one per column (4, 4)

    def reduce(self, vectors: np.ndarray) -> np.ndarray:
        """Coordinates η (m, 4) of vectors v (m, 4), Eq. (16)."""
        return (unconstrained(vectors) / self.scale - self.mean) @ self.axes / np.sqrt(self.variances)

    def restore(self, eta: np.ndarray) -> np.ndarray:
        """Vectors v (m, 4) from the first coordinates η (m, N_g), with the others at their mean, Eq. (17)."""
        steps = self.axes[:, : eta.shape[1]] * np.sqrt(self.variances[: eta.shape[1]])
        free = np.empty((len(steps), len(eta)))
        _shift_and_scale(*map(np.ascontiguousarray, (eta.T, steps, self.mean, self.scale)), free)
        return constrained(free.T)


def principal_coordinates(vectors: np.ndarray) -> PrincipalCoordinates:
    """Fit the coordinates of Eqs. (15)-(16) to vectors v (m, 4).

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
        raise ValueError(f"the components of v are linearly dependent: eigenvalues {variances}")
    # The sign of an eigenvector is arbitrary: fix it, so that draws do not depend on the linear algebra library.
    signs = np.sign(axes[np.abs(axes).argmax(axis=0), np.arange(4)])
    return PrincipalCoordinates(scale, q.mean(axis=0), variances.copy(), axes * signs)


def _checked(vectors):
    """Unbounded variables (m, 4) of vectors, after a check of the constraints."""
    e, f_max, d_max, d_limit = vectors.T
    bad = ~((e > 0) & (f_max > 0) & (d_max > d_limit) & np.isfinite(vectors).all(axis=1))
    if bad.any():
        k = int(bad.argmax())
        raise ValueError(f"sample {k} of {len(bad)} violates e > 0, f_max > 0 or d_max > d_limit: v = {vectors[k]}")
    free = unconstrained(vectors)
    if not np.all(np.ptp(free, axis=0) > 0):
        raise ValueError(f"a component of v does not vary: ranges {np.ptp(free, axis=0)}")
    return free
