"""Validity of elastic contact: stress and contact area of every touching summit (App. A)."""

import numpy as np

from stiction.constants import HARDNESS
from stiction.estimates import jackknife

#: Share of the hardness at which a sphere starts to yield (Tabor); paper, App. A.
ONSET = 0.6


def touching(height: np.ndarray, curvature: np.ndarray, distance: float) -> tuple[np.ndarray, np.ndarray]:
    """Summits in contact with a flat: interference δ [m] and radius R [m], (n_touching,) each.

    Heights [m] and curvatures [m⁻¹] are those of all summits (n,), the distance is that of the flat from the mean plane
    [m].
    """
    reaching = height > distance
    return height[reaching] - distance, 1 / curvature[reaching]


def contact_area(interference: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """Hertzian contact area of a sphere, π R δ [m²], from interference and radius [m]."""
    return np.pi * radius * interference


def yields(stress: float | np.ndarray, hardness: float = HARDNESS) -> bool | np.ndarray:
    """Whether a summit yields at its largest stress [Pa]. Hardness of the softer body [Pa]."""
    return stress > ONSET * hardness


def plastic_share(
    area: np.ndarray, stress: np.ndarray, strip: np.ndarray, strips: int, hardness: float = HARDNESS
) -> tuple[float, float]:
    """Plastic share A_P / A of the contact area, with its jackknife standard error over strips.

    Both are NaN if fewer than two strips have a touching summit. Areas [m²] and stresses [Pa] of all touching summits
    come with the number of their strip, from 0, (n,) each; the hardness is that of the softer body [Pa].
    """
    if len(np.unique(strip)) < 2:
        return np.nan, np.nan
    sums = [np.bincount(strip, weights, strips) for weights in (area * yields(stress, hardness), area)]
    return jackknife(lambda mean: mean[0] / mean[1], np.column_stack(sums) / np.sum(area))
