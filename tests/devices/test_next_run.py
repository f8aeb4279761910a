"""Next runs of drawn processes: margins with confidence, of the mean process and of one run, against drawn truths.

Four settings, whose runs scatter by 10 % more than their errors say, through a known law; the margin is linear.
"""

from dataclasses import replace

import numpy as np
import pytest

from stiction.analysis import process_law
from stiction.analysis.process_law import fit, grid
from stiction.devices.process import SETTINGS, Margins, recommended, run_error

SCATTER, ERROR, VALUES = 0.1, 0.014, np.array([30.0, 50.0, 70.0, 90.0])
ERRORS = np.full((len(VALUES), 1, 1), ERROR**2)


def true_margin(values, bend):
    """Margin of the mean process at values of the variable: ln rms less the one needed."""
    x = (np.asarray(values) - 60) / 30
    return 0.45 * x - 0.15 * bend * x**2


def drawn(bend, rng):
    """Recommendation from one study of four runs, and its law."""
    runs = true_margin(VALUES, bend) + SCATTER * rng.standard_normal(4) + ERROR * rng.standard_normal(4)
    law = fit(VALUES, runs[:, None], ERRORS)
    points = grid(VALUES)
    curve = Margins((points,), law.at(points)[:, 0], np.ones((len(points), 1)), np.zeros(len(points)))
    return recommended([curve], [law], [ERRORS[0]], rng), law


def covered(studies):
    """Shares of drawn studies whose band holds the true margin; of safe margins above the mean and above the next run.

    Between the first two settings, and at the settings that the study itself claims.
    """
    rng, rows, claimed = np.random.default_rng(3), [], []
    for number in range(studies):
        bend = number % 2
        found, _ = drawn(bend, rng)
        at = SETTINGS // 6
        true = true_margin(found.axes[0], bend)
        run = true + SCATTER * rng.standard_normal()
        low, high = found.band[:, at]
        rows.append((low <= true[at] <= high, found.safe_mean[at] > true[at], found.safe[at] > run[at]))
        for ends in found.sufficient[:1]:
            claimed.append(np.interp(ends[0], found.axes[0], run) < 0)
    return *np.mean(rows, axis=0), np.mean(claimed)


def errors_of_shares(share, studies):
    """Four standard errors of a share of so many studies."""
    return 4 * np.sqrt(share * (1 - share) / studies)


@pytest.mark.slow
def test_bands_and_confidence_hold_for_drawn_processes_and_for_their_next_runs():
    inside, above_mean, above_run, failed = covered(200)
    assert inside > 0.95 - errors_of_shares(0.05, 200)
    assert above_mean < 0.05 + errors_of_shares(0.05, 200)
    assert above_run < 0.05 + errors_of_shares(0.05, 200)
    assert failed < 0.05 + errors_of_shares(0.05, 200)


@pytest.mark.slow
def test_runs_that_are_taken_to_agree_fail_at_settings_that_are_said_to_suffice(monkeypatch):
    monkeypatch.setattr(process_law, "SCATTERS", np.array([1e-12]))
    inside, _, above_run, failed = covered(100)
    assert inside < 0.7
    assert above_run > 0.2
    assert failed > 0.25


def test_the_posterior_of_law_and_scatter_is_that_of_drawn_and_weighted_processes():
    """Straight laws alone: two coefficients and the scatter, drawn from their prior and weighted by the settings."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(process_law, "LARGEST_DEGREE", 1)
        law = fit(VALUES, np.array([[-0.5], [-0.1], [0.25], [0.42]]), ERRORS)
    assert law.parts.likely[0, 0].sum() < 0.05  # not constant
    straight = law.parts.likely[0, 1] / law.parts.likely[0, 1].sum()
    rng, number = np.random.default_rng(4), 400_000
    scatter = 0.1 * np.abs(rng.standard_cauchy(number))
    scatter = scatter[(scatter > 1e-4) & (scatter < 1)]
    # Flat priors of both coefficients, wide enough for all that the settings allow.
    low, high = rng.uniform(-1.5, 1.0, len(scatter)), rng.uniform(-1.0, 1.5, len(scatter))
    means = low[:, None] + (high - low)[:, None] * (VALUES - 30) / 60
    wide = np.hypot(scatter, ERROR)[:, None]
    logs = -np.sum(((np.array([-0.5, -0.1, 0.25, 0.42]) - means) / wide) ** 2 / 2 + np.log(wide), axis=1)
    weights = np.exp(logs - logs.max()) / np.exp(logs - logs.max()).sum()
    effective = 1 / np.sum(weights**2)
    assert effective > 1000
    share = np.cumsum(straight)[law.parts.scatters <= 0.1].max()
    assert abs(weights[scatter < 0.1].sum() - share) < 4 * np.sqrt(0.25 / effective) + straight.max() / 2  # half a step
    ends = np.sqrt(weights @ (low - weights @ low) ** 2)
    np.testing.assert_allclose(np.sqrt(law.covariance_at([30.0])[0, 0, 0]), ends, rtol=0.15)


def test_a_run_scatters_about_the_mean_process_and_is_never_known_exactly():
    exact = fit(VALUES, true_margin(VALUES, 1)[:, None], np.full((4, 1, 1), 1e-12))
    assert exact.scatter[0] > 1e-3
    found, law = drawn(0, np.random.default_rng(5))
    assert np.all(found.safe < found.safe_mean)
    curve = Margins((VALUES,), law.at(VALUES)[:, 0], np.full((4, 1), 2.0), np.zeros(4))
    np.testing.assert_allclose(run_error(curve, [law]), 2 * law.scatter[0])
    _, runs = law.draw(40_000, np.random.default_rng(6))
    np.testing.assert_allclose(runs.std(), law.scatter[0], rtol=0.05)
    calm = replace(law, scatter=np.zeros(1))
    np.testing.assert_array_equal(run_error(curve, [calm]), 0)
