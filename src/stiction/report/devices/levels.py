"""Levels of controls: sizes at which P(stuck), and both ends of its band, reach given fractions.

Layers are P(stuck), the lower and the upper end of its 95 % band. Fractions are normal scores, which increase with
P(stuck): the sizes of beams increase along them, the forces of stoppers fall.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr, ndtri

from stiction.answer.data import Answer, AnswerInAir
from stiction.devices.risk import SCORES

#: Normal scores of shown fractions, from 3e-7 on, and that of a band of 95 %.
SHOWN, Z95 = np.linspace(-5, 5, 41), float(ndtri(0.975))
#: Scores of fractions that are 0 or 1 as far as a double can tell.
_NONE, _ALL = -37.0, 8.2


@dataclass(frozen=True)
class Simulated:
    """Simulation of one or several states of a device."""

    quantiles: np.ndarray  #: sizes with P(stuck) at `stiction.devices.risk.SCORES`, NaN if unknown (..., scores)
    limit: np.ndarray  #: simulated limit for the allowed fraction (...)


@dataclass(frozen=True)
class Levels:
    """Levels of some states."""

    scores: np.ndarray  #: increasing (n,)
    sizes: np.ndarray  #: of the layers, NaN if unknown (3, ..., n)
    first: np.ndarray  #: size from which a lower end is known (..., 1)
    factor: np.ndarray  #: size to build over the simulated limit (..., 1)


def counted(quantiles: np.ndarray, samples: int) -> np.ndarray:
    """Layers of simulated devices at `SHOWN` (3, ..., n), from sizes at `stiction.devices.risk.SCORES` (..., scores).

    A band by Wilson: the fraction p is an end of that of a counted one if they differ by 1.96 sqrt(p (1 - p) / n).
    """
    shares = ndtr(SHOWN)
    half = Z95 * np.sqrt(shares * (1 - shares) / samples)
    at = [np.clip(shares + sign * half, 0, 1) for sign in (0, 1, -1)]
    return np.array(
        [np.exp(np.apply_along_axis(_at, -1, np.log(quantiles), np.round(ndtri(levels), 9))) for levels in at]
    )


def _at(row, scores):
    """Values of a row at `stiction.devices.risk.SCORES` (scores,) at others, NaN beyond the known ones."""
    finite = np.isfinite(row)
    if not finite.any():
        return np.full(len(scores), np.nan)
    return np.interp(scores, SCORES[finite], row[finite], left=np.nan, right=np.nan)


def of_answer(
    answer: Answer, humidities: Sequence[float], states: Simulated, of_device: Mapping[float, Simulated]
) -> Levels:
    """Levels at states in some airs (m, ...) by an answer, and by the simulation of the device itself in its own airs.

    In the air that decides, they are those of the answer for all airs together.

    ASSUME: at other sizes, and in other air, all causes inside the answer change sizes by as much as at its own. What
    they do in two stated airs is interpolated between them.
    """
    at = {air.humidity: air for air in answer.airs if air.humidity in of_device} | {
        answer.together.humidity: answer.together
    }
    airs = [at[humidity] for humidity in sorted(of_device.keys() & at.keys())]
    scores = _scores(answer, airs)
    stated = [air.humidity for air in airs]
    weights = [np.interp(humidities, stated, row) for row in np.eye(len(airs))]
    ratios = [_ratio(states, of_device[humidity], scores) for humidity in stated]
    inverted = [_inverted(answer, air, scores) for air in airs]
    sizes = [_joined(weights, [np.log(rows[layer]) for rows in inverted], ratios) for layer in range(3)]
    lowest = [ratio[..., :1] for ratio in ratios]
    first = _joined(weights, [np.log(air.first) for air in airs], lowest)
    beside = [np.log(air.build / of_device[air.humidity].limit) for air in airs]
    factor = _joined(weights, beside, [0 * ratio for ratio in lowest])
    return Levels(scores, np.array(sizes), first, factor)


def of_places(answer: Answer, airs: Sequence[AnswerInAir]) -> tuple[np.ndarray, np.ndarray]:
    """Scores (n,), and levels of the layers in some airs by an answer alone (3, m, n)."""
    scores = _scores(answer, airs)
    return scores, np.array([_inverted(answer, air, scores) for air in airs]).swapaxes(0, 1)


def _scores(answer, airs):
    """Scores of levels (n,).

    Those at the stated size and the allowed fraction are among them, so that the stated size and the size to build have
    exactly what the answer says.
    """
    shares = [number for air in airs if air.stuck for number in (air.stuck.value, air.stuck.low, air.stuck.high)]
    scores = ndtri([*shares, *([answer.share] if np.isfinite(answer.share) else [])])
    return np.unique(np.append(SHOWN, scores[np.abs(scores) < SHOWN[-1]]))


def _inverted(answer, air, scores):
    """Sizes at which the layers of one air reach scores (3, n), NaN beyond its curve."""
    if not len(answer.sizes):
        return np.full((3, len(scores)), np.nan)
    sign = answer.sought.sign
    v, rows = sign * np.log(answer.sizes), air.curve
    if air.stuck is not None:
        k = np.searchsorted(v, sign * np.log(answer.size))
        rows = np.insert(rows, k, (air.stuck.value, air.stuck.low, air.stuck.high), axis=1)
        v = np.insert(v, k, sign * np.log(answer.size))
    curves = [(v, np.clip(ndtri(row), _NONE, _ALL)) for row in rows]
    if (build := sign * np.log(air.build)) < sign * np.log(air.first):  # the upper end is the allowed fraction there
        k = np.searchsorted(v, build)
        curves[2] = np.insert(v, k, build), np.insert(curves[2][1], k, ndtri(answer.share))
    rising = [(at, np.maximum.accumulate(heights)) for at, heights in curves]
    sizes = np.exp([sign * np.interp(scores, heights, at, left=np.nan, right=np.nan) for at, heights in rising])
    if air.stuck is not None:  # also where the curve is flat, without devices that begin to stick near this size
        stated = ndtri([air.stuck.value, air.stuck.low, air.stuck.high])
        sizes = np.where(scores == stated[:, None], answer.size, sizes)
    return sizes


def _ratio(states: Simulated, of_device: Simulated, scores: np.ndarray) -> np.ndarray:
    """Logarithm of simulated sizes at states over those of the device itself, at scores (..., n).

    Beyond the simulated fractions it is that of the last of them; without any, that of the limits.
    """
    ratios = np.log(states.quantiles) - np.log(of_device.quantiles)
    at_scores = np.apply_along_axis(_nearest, -1, ratios, scores)
    return np.where(np.isnan(at_scores), np.log(states.limit / of_device.limit)[..., None], at_scores)


def _nearest(row, scores):
    """Values of a row at `stiction.devices.risk.SCORES` at others, beyond the known ones the last of them."""
    finite = np.isfinite(row)
    return np.interp(scores, SCORES[finite], row[finite]) if finite.any() else np.full(len(scores), np.nan)


def _joined(weights, logarithms, ratios):
    """Sizes at states (m, ..., n) from those in the stated airs and ratios to them, by the weights of these (m,)."""
    total = 0.0
    for weight, logarithm, ratio in zip(weights, logarithms, ratios, strict=True):
        weight = weight.reshape(-1, *[1] * (ratio.ndim - 1))
        total = total + np.where(weight > 0, weight * (logarithm + ratio), 0)
    return np.exp(total)
