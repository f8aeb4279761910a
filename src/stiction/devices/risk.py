"""Risk of beams: the fraction of stuck beams against their length, and the safe length.

Every simulated device has a *sticking length*, the shortest one that sticks on its ground: a device of length L sticks
if and only if its sticking length is smaller than L. One simulation of long beams thus gives P(stuck) at every length.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from scipy.special import betainc, betaincinv, ndtr, ndtri

from stiction.devices.tail import FEWEST, TAIL, fit_tail, scaled_errors
from stiction.rounding import grouped

#: Length behind the end of a crack that a beam needs to stick, in foundation lengths.
HOLD = 2.0
#: Confidence of bounds and bands.
CONFIDENCE = 0.95
#: Smallest share down to which the fit of the lowest lengths has been verified by brute force: by 110 000 S-shapes and
#: 200 000 strips of 0.05 µm of the paper's pair b. ASSUME: of tilted tips, and of bridges as well, which 20 000 of them
#: confirm down to 1e-3.
VERIFIED = 1e-4
#: Expected number of samples below a length that is called fitted: one decade below the lowest sample.
DECADE = 0.1


class Basis(StrEnum):
    """Basis of a safe length."""

    SAMPLED = "sampled"  #: order statistics, no assumption about the distribution
    FITTED = "fitted"  #: line through the lowest lengths, within a decade of the samples and within what was verified
    EXTRAPOLATED = "extrapolated"  #: the same line beyond
    LONGEST = "longest"  #: the longest simulated devices, of which so few stick; longer ones may be safe, too
    FLAT = "flat"  #: flat surfaces in contact, because too few devices stick for a line


@dataclass(frozen=True)
class SafeLength:
    """Largest length with a one-sided upper bound of P(stuck) of at most ``share``."""

    share: float  #: p [-]
    length: float  #: the safe length: one-sided 95 % lower bound of ``estimate`` [m]
    estimate: float  #: length with P(stuck) = p [m]; infinite where it is beyond all known lengths
    error: float  #: standard error of the estimate due to the number of beams [m]; NaN where that is infinite
    basis: Basis
    surfaces_error: float = np.nan  #: the same due to the number of sampled surfaces [m]; NaN where they do not matter


@dataclass(frozen=True)
class LengthBounds:
    """Lengths of devices known without samples, and the end of the samples [m]."""

    reach: float = (
        np.inf
    )  #: longest simulated length: sticking lengths beyond it are unknown, those stated upper bounds
    flat: float = 0.0  #: length that sticks on flat surfaces in contact; smaller ones are safe on rough ones
    safe: float = 0.0  #: length up to which no surfaces hold a device


#: Devices of which all lengths are from samples.
NO_BOUNDS = LengthBounds()


# Sticking lengths


def sticking_lengths(crack_lengths: np.ndarray, s_shaped: np.ndarray, foundation: float) -> np.ndarray:
    """Sticking lengths of cantilevers, S-shaped, from long beams (n,) [m]: l_s + 2 l_f.

    A beam cut to L has the crack of the long beam if enough of it remains behind the crack to hold it, 7.5 ± 1.5 µm on
    pair b. Otherwise the crack runs to the tip. Crack lengths [m] are those of beams that are much longer; where these
    did not end S-shaped, the sticking length is unknown, beyond their length, and infinite here. Foundation length l_f
    [m].
    """
    return np.where(s_shaped, crack_lengths + HOLD * foundation, np.inf)


def with_arcs(s_shapes: np.ndarray, arcs: np.ndarray) -> np.ndarray:
    """Sticking lengths of cantilevers in either shape (n,) [m].

    From `sticking_lengths`, and the longest arcs that come free of n independent tips,
    `stiction.devices.arcs.arc_length`.
    """
    return np.minimum(s_shapes, arcs)


# Shares


def upper_bound(stuck: int | np.ndarray, samples: int, confidence: float = CONFIDENCE) -> float | np.ndarray:
    """One-sided upper bound of a fraction, from ``stuck`` of ``samples`` (Clopper and Pearson) [-]."""
    stuck = np.asarray(stuck)
    inner = betaincinv(np.minimum(stuck, samples - 1) + 1.0, np.maximum(samples - stuck, 1), confidence)
    return np.where(stuck < samples, inner, 1.0)[()]


def stuck_share(
    lengths: np.ndarray, sticking: np.ndarray, reach: float = np.inf
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """P(stuck) at some lengths (m,) [m], with the lower and the upper end of a pointwise 95 % band, (m,) each [-].

    From sticking lengths of n devices (n,) [m]. Beyond the ``reach`` [m] of the simulation, devices that did not stick
    there may do so: the upper end counts them as stuck.
    """
    n = len(sticking)
    stuck = np.searchsorted(np.sort(sticking), lengths, side="left")
    two_sided = (1 + CONFIDENCE) / 2
    most = np.where(np.asarray(lengths) > reach, n, stuck)
    return stuck / n, 1 - upper_bound(n - stuck, n, two_sided), upper_bound(most, n, two_sided)


#: Normal scores of the stored quantiles of sticking lengths and of forces, beyond those of one in a thousand.
SCORES = np.linspace(-3.25, 3.25, 27)


def quantiles(values: np.ndarray, reach: float = np.inf) -> np.ndarray:
    """Quantiles of samples (n,) at `SCORES`, by Hazen's positions, in the unit of the samples.

    NaN beyond the smallest and the largest sample, and beyond the ``reach`` of the samples.
    """
    n, levels = len(values), ndtr(SCORES)
    with np.errstate(invalid="ignore"):
        estimates = np.quantile(np.where(values <= reach, values, np.inf), levels, method="hazen")
    inside = (n * levels >= 0.5) & (n * (1 - levels) >= 0.5)
    return np.where(inside & np.isfinite(estimates), estimates, np.nan)


def most_stuck(sticking: np.ndarray, reach: float) -> float:
    """One-sided 95 % upper bound of P(stuck) of the longest simulated devices, from sticking lengths (n,) [m]."""
    return float(upper_bound(int(np.sum(sticking < reach)), len(sticking)))


def samples_for(share: float) -> int:
    """Smallest number of samples to bound the length of P(stuck) = share by their minimum (Wilks).

    >>> [samples_for(share) for share in (1e-2, 1e-3, 1e-4)]
    [299, 2995, 29956]
    """
    return int(np.ceil(np.log(1 - CONFIDENCE) / np.log1p(-share)))


# Safe length


def _sampled_length(ordered, share):
    """Largest order statistic with at most ``share`` of all lengths below it, with confidence."""
    n = len(ordered)
    stuck = np.arange(int(share * n) + 1)
    allowed = stuck[upper_bound(stuck, n) <= share]
    return ordered[allowed[-1]]


def _quantile(ordered, share):
    """Quantile of Harrell and Davis and its standard error by Maritz and Jarrett."""
    n = len(ordered)
    steps = betainc((n + 1) * share, (n + 1) * (1 - share), np.arange(n + 1) / n)
    weights = np.diff(steps)
    used = weights > 1e-12
    values, weights = ordered[used], weights[used]
    if not np.isfinite(values).all():
        return np.inf, np.nan
    mean = weights @ values
    return mean, np.sqrt(weights @ (values - mean) ** 2)


def sampled_bound(values: np.ndarray, share: float) -> tuple[float, float, float]:
    """Quantile of all samples (n,) at a share: one-sided 95 % lower bound, estimate and its standard error.

    The bound is an order statistic, without an assumption about the distribution. The results have the unit of the
    samples.

    Raises
    ------
    ValueError
        If there are fewer than `samples_for` samples.
    """
    if len(values) < samples_for(share):
        raise ValueError(f"a bound for a share of {share:g} needs {samples_for(share)} samples, got {len(values)}")
    ordered = np.sort(values)
    estimate, error = _quantile(ordered, share)
    return float(_sampled_length(ordered, share)), float(estimate), float(error)


def safe_length(
    sticking: np.ndarray, share: float, rng: np.random.Generator, bounds: LengthBounds = NO_BOUNDS
) -> SafeLength:
    """Safe length for one share p of stuck devices, at most 5 %, from their sticking lengths (n,) [m].

    It is sampled if there are enough devices (`samples_for`), and at most as long as they were simulated. Otherwise it
    comes from the fit of the lowest 5 %, or of those that stick if they are fewer, whose errors are simulated. Where
    too few of them stick for a fit, it is the length that sticks on flat surfaces.

    Raises
    ------
    ValueError
        If the share is out of range, or there are too few devices for a fit.
    """
    if not 0 < share <= TAIL:
        raise ValueError(f"a safe length needs a share in (0, {TAIL}], got {share}")
    bound = _sampled(sticking, share, bounds) if len(sticking) >= samples_for(share) else None
    bound = bound or _fitted(sticking, share, rng, bounds)
    return replace(bound, length=max(bound.length, bounds.safe))


def _sampled(sticking, share, bounds):
    """Safe length by order statistics."""
    bound, estimate, error = sampled_bound(sticking, share)
    if bound <= bounds.reach:
        return SafeLength(share, bound, estimate, error, Basis.SAMPLED)
    return SafeLength(share, bounds.reach, np.inf, np.nan, Basis.LONGEST)


def _fitted(sticking, share, rng, bounds):
    """Safe length by a fit of the shortest known lengths.

    Those of tips may all be known, and longer than any simulated crack: up to the length that sticks on flat surfaces,
    no crack stops.
    """
    within = np.where(sticking <= bounds.reach, sticking, np.inf)
    few = np.isfinite(within).sum() < FEWEST
    lengths = sticking if few else within
    if np.isfinite(lengths).sum() < FEWEST:
        return SafeLength(share, bounds.flat, np.inf, np.nan, Basis.FLAT)
    fitted = fit_tail(lengths)
    estimate = fitted.length(share)
    errors, pivots = scaled_errors(len(lengths), share, rng, fitted=fitted.fitted)
    bound = float(estimate * np.exp(-np.quantile(pivots, CONFIDENCE) * fitted.slope))
    if few and bound > bounds.flat:
        return SafeLength(share, bounds.flat, np.inf, np.nan, Basis.FLAT)
    basis = Basis.FITTED if share >= VERIFIED and len(lengths) * share >= DECADE else Basis.EXTRAPOLATED
    return SafeLength(share, bound, estimate, float(estimate * fitted.slope * errors.std()), basis)


def on_sampled_surfaces(safe: SafeLength, of_length: float, of_estimate: float, bounds: LengthBounds) -> SafeLength:
    """Safe length with the standard errors of itself and of its estimate due to the number of sampled surfaces [m].

    The distance of the bound from the estimate, given the surfaces, and 1.64 errors are margins of independent errors
    on a logarithmic scale: their squares are added. The error of the estimate is NaN where it does not depend on the
    surfaces: tips, one for each beam, are the same whatever the strips, and their scatter is among the errors due to
    the number of devices.
    """
    margin = max(np.log(safe.estimate / safe.length), 0.0) if np.isfinite(safe.estimate) else 0.0
    total = np.hypot(margin, ndtri(CONFIDENCE) * of_length / safe.length)
    length = max(float(safe.length * np.exp(margin - total)), bounds.safe)
    return replace(safe, length=length, surfaces_error=float(of_estimate) if of_estimate > 0 else np.nan)


# Order of bounds


def in_order(lengths: np.ndarray, shares: Sequence[float]) -> np.ndarray:
    """Safe lengths (..., shapes, shares) [m], none longer than one for a larger share or against fewer ways to stick.

    Bounds for several shares and shapes rest on other statistics, an order statistic or a fit, so that they contradict
    each other within their errors. The smaller one is safe by both. A shape holds whatever the one before it holds.
    """
    largest_first = np.argsort(shares)[::-1]
    ordered = np.fmin.accumulate(np.asarray(lengths, float)[..., largest_first], axis=-1)
    ordered = np.fmin.accumulate(ordered, axis=-2)[..., np.argsort(largest_first)]
    return np.where(np.isnan(lengths), np.nan, ordered)


def one_in(share: float) -> str:
    """Fraction of devices in words.

    Examples
    --------
    >>> one_in(1e-3), one_in(1e-6), one_in(0.03)
    ('1 in 1000', '1 in 1 000 000', '1 in 33.3333')
    """
    number = 1 / share
    if abs(number - round(number)) >= 1e-6 * number:
        return f"1 in {number:g}"
    return f"1 in {grouped(number)}"
