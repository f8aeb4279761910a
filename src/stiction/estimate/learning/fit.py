r"""Fit of the processes of `stiction.estimate.table` to a design: subset of regressors of a Gaussian process.

With the terms B of the trend, the kernels K of all rows against some nodes, and the kernels M among the nodes, the
coefficients minimise

.. math:: |y - B a - K w|^2 / \sigma^2 + w^T M w .

Lengths of the kernel maximise the likelihood of one row of each surface, because rows of one surface err together. The
noise σ of all rows is that with the least weighted error on surfaces that are left out.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import minimize

#: Nodes, groups of surfaces that are left out in turn, and noises among which they decide, over that of one row.
NODES, FOLDS, NOISES = 450, 7, (1.0, 3.0, 6.0, 12.0)
#: ASSUME: so far beyond the design, in scatters of a coordinate, the process is trusted if a node is near.
BEYOND = 0.5
#: Digits of the numbers of the table.
_DIGITS = 7
#: Added to kernels among nodes, and to squares of coefficients of the trend.
_JITTER, _RIDGE = 1e-6, 1e-6


@dataclass(frozen=True)
class DesignRows:
    """Rows of a design."""

    coordinates: np.ndarray  #: (n, c)
    values: dict[str, np.ndarray]  #: (n,) each
    surface: np.ndarray  #: number of the point of the design (n,)
    noise: np.ndarray  #: of the rows, in any unit (n,)

    @property
    def weights(self) -> np.ndarray:
        """Weights of the rows by their noise in units of its median, which is no less than a third (n,)."""
        return 1 / np.maximum(self.noise / np.median(self.noise), 1 / 3)

    def of(self, chosen: np.ndarray) -> "DesignRows":
        """Some of the rows (n,) bool or numbers."""
        values = {name: y[chosen] for name, y in self.values.items()}
        return DesignRows(self.coordinates[chosen], values, self.surface[chosen], self.noise[chosen])


@dataclass(frozen=True)
class Kernel:
    """Kernel and noise of a process."""

    centre: np.ndarray
    scale: np.ndarray
    lengths: np.ndarray
    noise: float  #: over the scatter of the process

    def standard(self, coordinates: np.ndarray) -> np.ndarray:
        """Coordinates in their scatter (n, c)."""
        return (coordinates - self.centre) / self.scale

    def between(self, left: np.ndarray, right: np.ndarray) -> np.ndarray:
        """Kernels between standard coordinates (n, c) and (m, c)."""
        return np.exp(-0.5 * np.maximum(self.squares(left, right), 0))

    def squares(self, left: np.ndarray, right: np.ndarray) -> np.ndarray:
        """Squares of distances, in the lengths of the kernel (n, m)."""
        left, right = left / self.lengths, right / self.lengths
        return (left**2).sum(1)[:, None] + (right**2).sum(1) - 2 * left @ right.T


def terms(standard: np.ndarray) -> np.ndarray:
    """Terms of the trend at standard coordinates (n, c): 1 and these (n, c + 1)."""
    return np.column_stack([np.ones(len(standard)), standard])


def kernel_of(rows: DesignRows, name: str) -> Kernel:
    """Kernel of greatest likelihood for one quantity on one row of each surface."""
    centre, scale = rows.coordinates.mean(axis=0), rows.coordinates.std(axis=0)
    _, first = np.unique(rows.surface, return_index=True)
    z, y, inverse = ((rows.coordinates - centre) / scale)[first], rows.values[name][first], rows.weights[first] ** -2
    b, c = terms(z), z.shape[1]

    def cost(p):
        """Negative logarithm of the likelihood, the scatter at its best and the trend by least squares."""
        kernel = Kernel(np.zeros(c), np.ones(c), np.exp(p[:c]), np.exp(p[c]))
        try:
            factor = cho_factor(kernel.between(z, z) + kernel.noise**2 * np.diag(inverse), lower=True)
        except np.linalg.LinAlgError:
            return 1e9
        rest = y - b @ np.linalg.lstsq(b, y, rcond=None)[0]
        return 0.5 * len(z) * np.log(rest @ cho_solve(factor, rest)) + np.log(np.diag(factor[0])).sum()

    start = np.append(np.full(c, 1.0), -1.0)
    best = minimize(cost, start, method="L-BFGS-B", options={"maxiter": 25}, bounds=[(0, 3)] * c + [(-4, 1)]).x
    return Kernel(centre, scale, np.exp(best[:c]), float(np.exp(best[c])))


def nodes_of(kernel: Kernel, standard: np.ndarray, number: int) -> np.ndarray:
    """Rows (number,) that explain most of the process, one after the other: a pivoted Cholesky decomposition."""
    rest, chosen, columns = np.ones(len(standard)), [], np.empty((len(standard), 0))
    for _ in range(min(number, len(standard))):
        best = int(np.argmax(rest))
        if rest[best] < 1e-4:
            break
        column = kernel.between(standard, standard[best : best + 1])[:, 0] - columns @ columns[best]
        columns = np.column_stack([columns, column / np.sqrt(rest[best])])
        rest = np.maximum(rest - columns[:, -1] ** 2, 0)
        rest[best] = 0
        chosen.append(best)
    return np.array(chosen)


def coefficients(kernel: Kernel, rows: DesignRows, nodes: np.ndarray) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Coefficients of the trend and weights of nodes (m, c) for all quantities."""
    z = kernel.standard(rows.coordinates)
    b, k = terms(z), kernel.between(z, nodes)
    features = rows.weights[:, None] * np.hstack([b, k])
    penalty = np.zeros((features.shape[1],) * 2)
    t = b.shape[1]
    penalty[:t, :t] = _RIDGE * len(z) * np.eye(t)
    penalty[t:, t:] = kernel.noise**2 * (kernel.between(nodes, nodes) + _JITTER * np.eye(len(nodes)))
    factor = cho_factor(features.T @ features + penalty)
    solutions = {name: cho_solve(factor, features.T @ (rows.weights * y)) for name, y in rows.values.items()}
    return {name: (each[:t], each[t:]) for name, each in solutions.items()}


@dataclass(frozen=True)
class Fitted:
    """Process that is fitted to rows, with those that are fitted without some surfaces."""

    content: dict[str, Any]  #: for the table
    without: tuple[dict[str, Any], ...]  #: contents without the surfaces of each group
    errors: dict[str, np.ndarray]  #: of all quantities on rows whose surface is left out (n,)

    @property
    def scatter(self) -> dict[str, float]:
        """Scatter of the errors by quantity."""
        return {name: float(np.std(errors)) for name, errors in self.errors.items()}


def group(surface: Any) -> Any:
    """Group of a surface, or of some (n,), by its number. Those of a group are left out together."""
    return surface % FOLDS


def content_of(kernel: Kernel, rows: DesignRows, columns: Sequence[int], number: int) -> dict[str, Any]:
    """Content of a process over rows of some columns of the coordinates, that is trusted at every distance."""
    z = kernel.standard(rows.coordinates)
    nodes = z[nodes_of(kernel, z, number)]
    fitted_values = coefficients(kernel, rows, nodes)
    return {
        "columns": list(columns),
        "centre": kernel.centre,
        "scale": kernel.scale,
        "lengths": kernel.lengths,
        "nodes": nodes / kernel.lengths,
        "trend": {key: trend for key, (trend, _) in fitted_values.items()},
        "weights": {key: weights for key, (_, weights) in fitted_values.items()},
        "low": rows.coordinates.min(axis=0) - BEYOND * kernel.scale,
        "high": rows.coordinates.max(axis=0) + BEYOND * kernel.scale,
        "farthest": math.inf,
    }


def predicted(kernel: Kernel, content: Mapping[str, Any], at: np.ndarray) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Quantities of a process at coordinates, and their distances from the nearest node (n,)."""
    z, nodes = kernel.standard(at), content["nodes"] * kernel.lengths
    b, k = terms(z), kernel.between(z, nodes)
    values = {name: b @ trend + k @ content["weights"][name] for name, trend in content["trend"].items()}
    return values, np.sqrt(np.maximum(kernel.squares(z, nodes), 0).min(axis=1))


def left_out(kernel: Kernel, rows: DesignRows, columns: Sequence[int], number: int) -> Fitted:
    """Process that is trusted up to the farthest row when its surface is left out."""
    errors = {name: np.empty(len(rows.surface)) for name in rows.values}
    without, farthest = [], 0.0
    for fold in range(FOLDS):
        out = group(rows.surface) == fold
        without.append(content_of(kernel, rows.of(~out), columns, number))
        values, distances = predicted(kernel, without[-1], rows.coordinates[out])
        farthest = max(farthest, float(distances.max()))
        for name, value in values.items():
            errors[name][out] = rows.values[name][out] - value
    content = content_of(kernel, rows, columns, number) | {"farthest": farthest}
    return Fitted(rounded(content), tuple(without), errors)


def fitted(rows: DesignRows, name: str, columns: Sequence[int], number: int = NODES) -> Fitted:
    """Process over some columns of the coordinates. The quantity with this name decides the kernel."""
    rows = replace(rows, coordinates=rows.coordinates[:, columns])
    start = kernel_of(rows, name)
    kernels = [Kernel(start.centre, start.scale, start.lengths, start.noise * factor) for factor in NOISES]
    tried = [left_out(kernel, rows, columns, number) for kernel in kernels]
    return min(tried, key=lambda process: np.std(rows.weights * process.errors[name]))


def everywhere(process: Fitted) -> Fitted:
    """Process that is trusted all over its design. ASSUME: gaps between the nodes of few coordinates do not matter."""
    content = process.content
    ends = zip(*(content[name] for name in ("low", "high", "scale", "lengths")), strict=True)
    across = math.hypot(*((high - low) / (scale * length) for low, high, scale, length in ends))
    return replace(process, content=rounded(content | {"farthest": across}))


def rounded(content: Any) -> Any:
    """Content with numbers of few digits, equal on all machines as far as their rounding allows."""
    if isinstance(content, Mapping):
        return {key: rounded(value) for key, value in content.items()}
    if isinstance(content, list | tuple | np.ndarray):
        return [rounded(value) for value in content]
    return float(f"{content:.{_DIGITS}g}") if isinstance(content, float) else content
