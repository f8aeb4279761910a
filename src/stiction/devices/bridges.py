"""Bridges: beams clamped at both ends, under the tension of a residual stress.

Between its two cracks a bridge adheres and is flat; each crack is that of a cantilever under the same tension
(`stiction.beam.tension`). A bridge of length L therefore sticks if the two crack lengths add up to less than L.

ASSUME: the two cracks stop independently. The part that adheres may be arbitrarily short, which is conservative: the
ends of two cracks need a few foundation lengths. Compression (buckling) is left out.
"""

from dataclasses import replace

import numpy as np

from stiction.beam.cantilever import Beam


def half_of_bridge(beam: Beam, residual_stress: float) -> Beam:
    """Cantilever under the tension of a bridge with this residual stress [Pa].

    Raises
    ------
    ValueError
        If the stress is compressive: the bridge may buckle, which is not in the model.
    """
    if not residual_stress >= 0:
        raise ValueError(
            f"a residual stress of {residual_stress / 1e6:.3g} MPa is compressive: buckling is not in the model"
        )
    return replace(beam, tension=residual_stress * beam.width * beam.thickness)


def sticking_lengths(crack_lengths: np.ndarray) -> np.ndarray:
    """Shortest bridge that sticks, s₁ + s₂, from 2n crack lengths of its half, taken in pairs (n,) [m].

    Raises
    ------
    ValueError
        If the number of cracks is odd.
    """
    if len(crack_lengths) % 2:
        raise ValueError(f"bridges have two cracks each, got {len(crack_lengths)} cracks")
    return np.asarray(crack_lengths).reshape(-1, 2).sum(axis=1)
