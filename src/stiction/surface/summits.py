"""Summits of a sampled surface: the asperities in contact and the statistics of Table I."""

import numpy as np

from stiction.kernels import kernel


@kernel
def mark_summits(z: np.ndarray, i: int, marks: np.ndarray) -> None:
    """Mark in ``marks`` (n2,) the points of the inner row i of z (n1, n2) above all eight neighbours.

    The ends of the row, which are no inner points, are not written.
    """
    above, row, below = z[i - 1], z[i], z[i + 1]
    for j in range(1, row.size - 1):
        # All comparisons, without branches: most points fail an early one, but several are compared at a time.
        h = row[j]
        sides = (h > row[j - 1]) & (h > row[j + 1]) & (h > above[j]) & (h > below[j])
        corners = (h > above[j - 1]) & (h > above[j + 1]) & (h > below[j - 1]) & (h > below[j + 1])
        marks[j] = sides & corners


@kernel(inline="always")
def mean_curvature(z: np.ndarray, i: int, j: int, spacing: float) -> float:
    """Mean of the two three-point second differences, positive on a summit [m⁻¹]."""
    h = np.float64(z[i, j])
    return (4 * h - z[i, j - 1] - z[i, j + 1] - z[i - 1, j] - z[i + 1, j]) / (2 * spacing * spacing)


@kernel
def _collect(z, spacing, height, curvature):
    count, summits = 0, np.empty(z.shape[1], np.bool_)
    for i in range(1, z.shape[0] - 1):
        mark_summits(z, i, summits)
        for j in range(1, z.shape[1] - 1):
            if summits[j]:
                height[count] = z[i, j]
                curvature[count] = mean_curvature(z, i, j, spacing)
                count += 1
    return count


def find_summits(heights: np.ndarray, spacing: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Find all summits of a surface, except on its edge.

    Parameters
    ----------
    heights : (n1, n2) array
        [m]
    spacing : float
        Of the points [m].

    Returns
    -------
    height, curvature : (n,) arrays
        Of each summit [m], [m⁻¹].
    density : float
        Number of summits per area in which a summit is possible [m⁻²].
    """
    z = np.ascontiguousarray(heights, np.float32)
    inner = (z.shape[0] - 2) * (z.shape[1] - 2)
    height, curvature = np.empty(inner), np.empty(inner)
    count = _collect(z, spacing, height, curvature)
    return height[:count].copy(), curvature[:count].copy(), count / (inner * spacing**2)


def summits_per_area(heights: np.ndarray, spacing: float) -> np.ndarray:
    """Number and total curvature of the summits of a surface per area, (2,) [m⁻²], [m⁻³]. Arguments of `find_summits`.

    Unlike the mean curvature, both are known without a summit, and their means over surfaces have no bias.
    """
    _, curvature, density = find_summits(heights, spacing)
    return np.array([density, density * curvature.mean()]) if len(curvature) else np.zeros(2)


def radius_and_density(per_area: np.ndarray) -> np.ndarray:
    """Radius 1 / mean curvature [m] and density [m⁻²] of summits from `summits_per_area`, (2,), ``nan`` without any."""
    number, curvature = per_area
    return np.array([number / curvature, number]) if curvature > 0 else np.full(2, np.nan)
