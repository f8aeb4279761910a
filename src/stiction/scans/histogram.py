r"""Histogram of the heights of finite scans, with its standard errors in closed form.

The share of a bin is the mean over the scan of its indicator function, so that its variance follows like that of the
moments in `stiction.scans.moments`, :math:`\sum_k a_k^2 I_k` with the Hermite coefficients a of the indicator.
"""

from collections.abc import Sequence

import numpy as np

from stiction.scans.model_scans import SurfaceModel
from stiction.surface.translation import LARGEST_SCORE, hermite_coefficients

#: Edges of the bins, in units of the rms.
EDGES = np.linspace(-6, 6, 61)


def histogram(scans: Sequence[np.ndarray], measured: np.ndarray, corrected: np.ndarray) -> np.ndarray:
    """Density of the standardised heights of all scans in the bins of `EDGES`, (60,) [-], from levelled heights [m].

    Between two of their `stiction.scans.quantiles.quantiles`, as ``measured`` and without the bias of levelling, (49,)
    each [-], all heights move with these.
    """
    z = np.concatenate([scan[np.isfinite(scan)] for scan in scans])
    z = (z - z.mean()) / z.std()
    counts, _ = np.histogram(z + np.interp(z, measured, corrected - measured), EDGES)
    return counts / len(z) / np.diff(EDGES)


def histogram_errors(model: SurfaceModel) -> np.ndarray:
    """Standard errors of the densities of one scan of a surface with its true mean and rms, (60,) [-].

    The part of an indicator beyond the last Hermite polynomial counts with the overlap integral of that polynomial, the
    largest that it can have.
    """
    table = model.translation.table
    inside = ((table >= EDGES[:-1, None]) & (table < EDGES[1:, None])).astype(float)
    power = hermite_coefficients(inside) ** 2
    share = _mean_of_normal(inside)
    beyond = np.maximum(share * (1 - share) - power.sum(axis=0), 0)
    return np.sqrt(model.overlaps @ power + model.overlaps[-1] * beyond) / np.diff(EDGES)


def _mean_of_normal(values):
    """Expectations of functions of a normal score, tabulated like `Translation.table`, (..., 4097) -> (...)."""
    score = np.linspace(-LARGEST_SCORE, LARGEST_SCORE, values.shape[-1])
    weight = np.exp(-(score**2) / 2)
    return values @ (weight / weight.sum())
