"""Errors at another place of a surface, from scans at several: drawn sets of scans against the truth.

The control is the old rule, errors of one homogeneous surface.
"""

import dataclasses

import numpy as np
import pytest
from drawn_scans import Cubic
from published import SURFACES
from scipy import stats

from stiction.scans import moments
from stiction.scans.estimate import estimate
from stiction.scans.moments import growth
from stiction.scans.scan import Scan

PIXEL = 20e-9
B2 = SURFACES["B2"]


def equal(count):
    """Variances and weights of scans of one size."""
    return np.ones(count), np.full(count, 1 / count)


@pytest.mark.parametrize("count", [3, 5, 10])
def test_clear_differences_give_the_interval_of_students_t(count):
    values = np.random.default_rng(count).standard_normal(count)
    values *= 8 / values.std(ddof=1)
    interval = stats.t.ppf(0.975, count - 1) * 8 * np.sqrt(1 + 1 / count)
    ours = 1.96 * growth(values, *equal(count)) / np.sqrt(count)
    assert ours == pytest.approx(interval, rel=0.1)
    assert 1.96 * 8 / np.sqrt(count) < 0.7 * interval, "control: the error of the mean of these places alone"


def drawn(rng, count, scatter, sets):
    """Growth for sets of scans, whether both intervals hold another place, (sets, 3)."""
    rows = []
    for tau in np.broadcast_to(scatter, sets):
        variances, weights = rng.uniform(0.5, 2, count), rng.dirichlet(np.full(count, 20.0))
        values = tau * rng.standard_normal(count) + np.sqrt(variances) * rng.standard_normal(count)
        off = abs(weights @ values - tau * rng.standard_normal()) / np.sqrt(weights**2 @ variances)
        grown = growth(values, variances, weights)
        rows.append((grown, off < 1.96 * grown, off < 1.96))
    return np.array(rows)


def test_another_place_is_in_95_percent_of_the_intervals_of_places_as_assumed():
    rng, sets = np.random.default_rng(1), 800
    logarithms = rng.uniform(*np.log(moments._SCATTER), sets)
    scatter = np.where(rng.random(sets) < moments.DIFFER, np.exp(logarithms), 0.0)
    _, ours, old = drawn(rng, 3, scatter, sets).T
    assert abs(ours.mean() - 0.95) < 4 * np.sqrt(0.95 * 0.05 / sets)
    assert old.mean() < 0.85, "control"


@pytest.mark.parametrize(("count", "median"), [(2, 1.17), (3, 1.09), (5, 1.07), (10, 1.06)])
def test_homogeneous_scans_keep_their_errors_but_for_the_stated_growth(count, median):
    grown, ours, old = drawn(np.random.default_rng(2), count, 0.0, 200).T
    assert np.median(grown) == pytest.approx(median, abs=0.08)
    assert np.all(grown >= 1)
    assert 0.92 < old.mean() <= ours.mean()


@pytest.mark.parametrize(("count", "scatter"), [(3, 15.0), (6, 15.0), (3, 300.0)])
def test_places_that_clearly_differ_are_covered_and_the_old_rule_fails(count, scatter):
    _, ours, old = drawn(np.random.default_rng(3), count, scatter, 200).T
    assert ours.mean() > 0.95 - 4 * np.sqrt(0.95 * 0.05 / 200) - 0.02  # 0.02: τ of few scans has a prior
    assert old.mean() < 0.3, "control"


def test_one_scan_shows_no_other_place_and_scans_of_no_weight_do_not_count():
    assert growth(np.array([3.0]), np.ones(1), np.ones(1)) == 1
    order = np.array([2, 0, 1])
    values, variances, weights = np.array([1.0, -2.0, 4.0]), np.array([1.0, 2.0, 0.5]), np.array([0.5, 0.2, 0.3])
    first = growth(values, variances, weights)
    assert growth(values[order], variances[order], weights[order]) == pytest.approx(first)
    assert growth(7 - 3 * values, 9 * variances, weights) == pytest.approx(first), "units and zero have no effect"


def field(points, corner, rng):
    """Gaussian field of unit variance on average with the slope of B2, part of a period, (points, points)."""
    wave = 2 * np.pi * np.fft.fftfreq(2 * points, PIXEL)
    radius = np.hypot(wave[:, None], wave)
    power = np.maximum(radius / corner, 1.0) ** B2.spectrum.slope * (radius > 0)
    waves = np.fft.fft2(rng.standard_normal(radius.shape))
    return np.fft.ifft2(np.sqrt(power / power.mean()) * waves).real[:points, :points]


@dataclasses.dataclass(frozen=True)
class Place:
    """Truth at one place."""

    rms: float  #: [m]
    corner: float  #: [rad/m]
    skewness: float


#: Standard deviations between places of ln rms, skewness and ln corner, where they scatter.
SCATTER = {"rms": 0.2, "skewness": 0.4, "corner": 0.4}


def place(kind, rng):
    """Place of a surface of which one quantity scatters."""
    rms, skewness, corner = rng.standard_normal() * np.array([SCATTER[name] * (name == kind) for name in SCATTER])
    return Place(B2.rms * np.exp(rms), B2.spectrum.corner * np.exp(corner), skewness)


def scan(at, points, rng):
    """Scan at a place."""
    heights = Cubic(at.skewness, 3 + 1.5 * at.skewness**2).quantile_of_normal(field(points, at.corner, rng))
    return Scan(at.rms * heights, (points * PIXEL,) * 2)


def estimated(kind, rng, points):
    """Estimate from three places, deviation of rms, skewness and corner from a fourth, its errors, old ones."""
    found = estimate([scan(place(kind, rng), points, rng) for _ in range(3)], 1, model_scans=6)
    truth = place(kind, rng)
    off = [found.moments[0] - np.log(truth.rms), found.moments[1] - truth.skewness]
    off += [np.log(found.inspection.fit.corner / truth.corner)]
    errors = np.array([*found.errors[:2], np.sqrt(found.fit_covariance[1, 1])])
    return found, np.abs(off), errors, errors / found.places[[0, 1, 3]]


def test_three_scans_whose_rms_differ_by_a_tenth_have_errors_that_hold_their_difference():
    rng = np.random.default_rng(4)
    at = [Place(B2.rms * factor, B2.spectrum.corner, 0.0) for factor in (0.9, 1.0, 1.1)]
    found = estimate([scan(one, 160, rng) for one in at], 1, model_scans=6)
    assert found.places[0] > 1.5
    assert found.errors[0] > 0.1 * np.sqrt(1 + 1 / 3), "scatter of the places and that of another one"
    assert found.errors[0] / found.places[0] < 0.06, "control: errors of one homogeneous surface"
    assert any("places may differ: the scans vary more" in flag for flag in found.flags)
    assert np.all(np.linalg.eigvalsh(found.covariance) > 0)
    spectra = np.array(found.inspection.spectra_of_scans)
    of_mean = spectra[:, 4] ** 2 @ spectra[:, 2:4]
    np.testing.assert_allclose(of_mean, np.diag(found.inspection.fit.covariance)[1:], err_msg="error of the fit to all")


def is_likely(covered, share, sets):
    """Whether as few intervals as these hold the truth with a probability of more than 0.001."""
    return stats.binom.cdf(covered, sets, share) > 1e-3


@pytest.mark.nightly
@pytest.mark.parametrize("kind", [*SCATTER, "none"])
def test_errors_cover_a_fourth_place_as_often_as_those_of_drawn_numbers(kind):
    rng, sets = np.random.default_rng([5, *kind.encode()]), 20
    _, off, errors, old = map(np.array, zip(*(estimated(kind, rng, 250) for _ in range(sets)), strict=True))
    covered, before = (np.sum(off < 1.96 * each, axis=0) for each in (errors, old))
    for column, quantity in enumerate(SCATTER):
        # Three scans of `drawn` have the variance 1.25 on average, the error of their mean is √(1.25 / 3).
        scatter = SCATTER[quantity] * (quantity == kind) * np.sqrt(1.25 / 3) / np.median(old[:, column])
        share = drawn(rng, 3, scatter, 2000)[:, 1].mean()
        assert is_likely(covered[column], share, sets), (quantity, share)
        if quantity == kind:
            assert not is_likely(before[column], share, sets), "control: the old rule"
    if kind == "none":
        assert np.median(errors / old) < 1.3, "homogeneous scans keep their errors"
