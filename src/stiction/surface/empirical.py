"""Height density given by measured quantiles (Sec. II-A): heights at normal scores u, as in Eq. (5)."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import ndtr

from stiction.surface.translation import LARGEST_SCORE

#: Range of scores over which the slope beyond the outermost quantile is taken.
_SLOPE_RANGE = 0.5
#: Scores at which the whole density is tabulated.
_SCORES = np.linspace(-LARGEST_SCORE, LARGEST_SCORE, 4097)
#: Half of the interval of heights over which a probability density is a mean [rms].
_INTERVAL = 0.01


@dataclass(frozen=True)
class MeasuredDensity:
    """`stiction.surface.translation.Density` of measured quantiles.

    ASSUME: beyond the outermost quantiles that have enough of the scan beyond them, heights are linear in the
    score, with the slope of the last part.
    """

    scores: np.ndarray  #: increasing, (n,)
    heights: np.ndarray  #: at the scores, in any unit, (n,)

    def __call__(self, height: float | np.ndarray) -> float | np.ndarray:
        """Probability density at the standardised ``height``, mean over a hundredth of the rms on both sides [-]."""
        table = self.quantile_of_normal(_SCORES)
        below, above = (ndtr(np.interp(height + step, table, _SCORES)) for step in (-_INTERVAL, _INTERVAL))
        return (above - below) / (2 * _INTERVAL)

    def quantile_of_normal(self, score: float | np.ndarray) -> np.ndarray:
        """Standardised height of the normal score u, any shape [-]."""
        mean, deviation = self._mean_and_deviation
        return (self._height(score) - mean) / deviation

    def _height(self, score):
        inner = np.interp(score, self.scores, self.heights)
        below, above = np.minimum(score - self.scores[0], 0), np.maximum(score - self.scores[-1], 0)
        return inner + self._slope(slice(None)) * below + self._slope(slice(None, None, -1)) * above

    def _slope(self, order):
        """Mean slope of the outermost part, at the first of the scores in this order."""
        score, height = self.scores[order], self.heights[order]
        inner = np.flatnonzero(np.abs(score - score[0]) >= _SLOPE_RANGE)[0]
        return (height[inner] - height[0]) / (score[inner] - score[0])

    @cached_property
    def _mean_and_deviation(self):
        share = np.exp(-(_SCORES**2) / 2) / np.exp(-(_SCORES**2) / 2).sum()
        height = self._height(_SCORES)
        mean = share @ height
        return mean, np.sqrt(share @ (height - mean) ** 2)
