r"""Correlation of the mean heights of neighbouring strips, in closed form from the spectra of the surfaces.

The mean over a strip of sides l and w weights a wave of heights by :math:`\mathrm{sinc}^2(\zeta_1 l / 2) \,
\mathrm{sinc}^2(\zeta_2 w / 2)`, and between strips k apart its phase turns by :math:`\zeta_1 k l`.
"""

from collections.abc import Sequence

import numpy as np

from stiction.surface.spectrum import Spectrum

#: Lobes of the weight along and across the strip; waves beyond add less than 1e-3 to a correlation.
_LOBES = 16
#: Waves on a lobe across the strip, and on a turn of the phase between the strips farthest apart.
_WAVES = 16


def mean_height_correlations(
    surfaces: Sequence[tuple[Spectrum, float]], sides: tuple[float, float], lags: int
) -> np.ndarray:
    """Correlations of the mean heights of strips 1, 2, ... apart, of the sum of both surfaces (lags,) [-].

    Parameters
    ----------
    surfaces : sequence of (spectrum, rms)
        Spectrum of the heights up to a factor, and rms of the heights [m], of each surface.
    sides : (float, float)
        Length of a strip along the beam and its width [m]; an infinite width leaves waves along the beam alone.
    lags : int
        Number of correlations.
    """
    length, width = sides
    cutoff = max(spectrum.cutoff for spectrum, _ in surfaces)
    lobe_1, lobe_2 = 2 * np.pi / length, 2 * np.pi / width
    along = _midpoints(min(cutoff, _LOBES * lobe_1), lobe_1 / (_WAVES * (lags + 1)))
    across = _midpoints(min(cutoff, _LOBES * lobe_2), lobe_2 / _WAVES) if lobe_2 else np.zeros(1)
    zeta = np.hypot(along[:, None], across)
    density = sum(rms**2 / spectrum.variance * spectrum(zeta) for spectrum, rms in surfaces)
    weight_across = np.sinc(across / lobe_2) ** 2 if lobe_2 else np.ones(1)
    weighted = np.sinc(along / lobe_1) ** 2 * (density @ weight_across)
    return np.cos(np.outer(np.arange(1, lags + 1), along * length)) @ weighted / weighted.sum()


def _midpoints(end, step):
    """Midpoints of cells of about a size between 0 and an end (n,) [rad m⁻¹]."""
    cells = int(np.ceil(end / step))
    return end / cells * (np.arange(cells) + 0.5)
