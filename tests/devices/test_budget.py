from dataclasses import replace

import numpy as np
import pytest
from beams import PAPER, scattered_laws
from numpy.testing import assert_allclose

from stiction.beam.release import released_beam
from stiction.devices import budget
from stiction.devices.budget import Budget

#: Errors of one 10 µm scan of the beam's surface of pair b, rms relative, skewness and kurtosis: the closed form of
#: `stiction.scans.moments`, which the scatter of 192 drawn scans confirms: 0.017, 0.044, 0.144, -0.87. Some two dozen
#: scans are too few for it: groups of 24 give 0.036 to 0.051 for the skewness and -0.76 to -0.91.
ERRORS = np.array([0.0161, 0.0433, 0.1416])
CORRELATION = np.array([[1, -0.34, 0.13], [-0.34, 1, -0.868], [0.13, -0.868, 1]])
#: Slopes of pair b at RH 0.67.
SURFACE = Budget(
    ("rms", "skewness", "kurtosis"),
    np.array([1.0, -0.76 / -0.76, 0.87 / 3.9]),
    np.outer(ERRORS, ERRORS) * CORRELATION,
)
BEAM = Budget(("thickness", "gap"), np.array([0.79, 0.50]), np.diag([0.02, 0.01]) ** 2)


def crack_lengths(beams=12, **changed):
    """Crack lengths on the same grounds, of a beam with some dimensions changed (n,) [m]."""
    beam = replace(PAPER, **changed)
    grounds = [scattered_laws(np.random.default_rng(k), 1000, 0.24) for k in range(beams)]
    return np.array([released_beam(beam, laws).crack_length for laws in grounds])


def test_the_total_is_the_scatter_of_lengths_whose_inputs_scatter():
    whole = budget.joined([SURFACE, BEAM])
    rng, n = np.random.default_rng(0), 20_000
    inputs = rng.multivariate_normal(np.zeros(5), whole.covariance, n)
    logarithms = inputs @ whole.slopes
    assert abs(logarithms.std() / whole.total - 1) < 4 / np.sqrt(2 * n)
    independent = replace(whole, covariance=np.diag(np.diag(whole.covariance)))
    assert abs(logarithms.std() / independent.total - 1) > 4 / np.sqrt(2 * n)  # control


def test_correlated_errors_of_skewness_and_kurtosis_cancel_and_independent_ones_do_not():
    # g u = 0.0433 and 0.0316, correlation -0.868: 0.0433² + 0.0316² - 2 · 0.868 · 0.0433 · 0.0316
    pair = ("skewness", "kurtosis")
    independent = replace(SURFACE, covariance=np.diag(np.diag(SURFACE.covariance)))
    assert_allclose(SURFACE.effect(pair) ** 2, 0.0433**2 + 0.03159**2 - 1.736 * 0.0433 * 0.03159, rtol=1e-3)
    assert_allclose(independent.effect(pair) ** 2, 0.0433**2 + 0.03159**2, rtol=1e-3)
    assert independent.effect(pair) > 2 * SURFACE.effect(pair)
    assert SURFACE.effect(pair) < SURFACE.effect(("skewness",))


def test_effects_of_independent_measurements_add_up_in_squares():
    whole = budget.joined([SURFACE, BEAM])
    groups = (SURFACE.names, BEAM.names)
    assert_allclose(whole.total**2, sum(whole.effect(group) ** 2 for group in groups), rtol=1e-12)
    assert_allclose(whole.effect(SURFACE.names), SURFACE.total, rtol=1e-12)
    for group, other in (groups, groups[::-1]):
        assert_allclose(whole.remaining(group), whole.effect(other), rtol=1e-9)


def test_an_input_that_is_known_tells_about_those_correlated_with_it():
    # What remains is the scatter of the length at fixed skewness: the residual of the regression on it.
    rng, n = np.random.default_rng(1), 40_000
    inputs = rng.multivariate_normal(np.zeros(3), SURFACE.covariance, n)
    logarithms, skewness = inputs @ SURFACE.slopes, inputs[:, 1]
    slope = (skewness @ logarithms) / (skewness @ skewness)
    residual = (logarithms - slope * skewness).std()
    assert abs(residual / SURFACE.remaining(("skewness",)) - 1) < 4 / np.sqrt(2 * n)
    naive = np.sqrt(SURFACE.total**2 - SURFACE.effect(("skewness",)) ** 2 + 0j).real
    assert abs(residual / naive - 1 if naive else np.inf) > 4 / np.sqrt(2 * n)  # control


def test_a_budget_without_inputs_has_no_uncertainty():
    assert Budget((), np.empty(0), np.empty((0, 0))).total == 0


def test_nothing_remains_if_all_is_known_and_everything_if_nothing_is():
    assert SURFACE.remaining(SURFACE.names) < 1e-8
    assert_allclose(SURFACE.remaining(()), SURFACE.total, rtol=1e-12)
    exact = Budget(("a", "b"), np.ones(2), np.diag([0.0, 4.0]))
    assert_allclose([exact.remaining(("a",)), exact.remaining(("b",))], [2, 0], atol=1e-9)


def test_common_random_numbers_make_slopes_of_few_devices_exact():
    rng, n = np.random.default_rng(2), 40
    base = 700e-6 * np.exp(0.025 * rng.standard_normal(n))
    noise = np.exp(0.002 * rng.standard_normal(n))
    common = budget.log_slope(np.mean, base * 0.99**0.8, base * noise * 1.01**0.8, np.log(1.01 / 0.99))
    shuffled = budget.log_slope(np.mean, base * 0.99**0.8, rng.permutation(base) * 1.01**0.8, np.log(1.01 / 0.99))
    assert abs(common[0] - 0.8) < 4 * common[1]
    assert shuffled[1] > 5 * common[1]


def test_an_exact_power_has_no_error_by_rounding():
    base = np.random.default_rng(2).lognormal(size=40)
    slope, error = budget.log_slope(np.mean, 0.99**0.75 * base, 1.01**0.75 * base, np.log(1.01 / 0.99))
    assert_allclose(slope, 0.75, rtol=1e-12)
    assert error == 0


def test_the_error_of_a_slope_is_the_scatter_of_repeated_studies():
    rng, found = np.random.default_rng(3), []
    for _ in range(300):
        base = np.exp(0.025 * rng.standard_normal(60))
        found.append(budget.log_slope(np.mean, base, base * np.exp(0.1 + 0.01 * rng.standard_normal(60)), 0.1))
    slopes, errors = np.transpose(found)
    assert_allclose(np.sqrt(np.mean(errors**2)), slopes.std(ddof=1), rtol=4 / np.sqrt(600))
    assert abs(slopes.mean() - 1) < 4 * slopes.std() / np.sqrt(300)


def test_the_error_of_a_mean_of_small_differences_is_its_standard_error():
    changes = np.random.default_rng(4).standard_normal(15)
    found = budget.log_slope(np.mean, np.ones(15), 1 + 1e-6 * changes, 1e-6, groups=15)
    assert_allclose(found, [changes.mean(), changes.std(ddof=1) / np.sqrt(15)], rtol=1e-4)


def test_the_measurement_with_the_largest_gain_is_named():
    whole = budget.joined([SURFACE, BEAM])
    groups = {"the thickness": ("thickness",), "the scan of B2": SURFACE.names, "the gap": ("gap",)}
    rows = budget.ranked(whole, groups)
    assert [name for name, _, _ in rows] == ["the scan of B2", "the thickness", "the gap"]
    assert np.all(np.diff([remaining for _, _, remaining in rows]) > 0)
    assert_allclose(rows[1][1], 0.79 * 0.02, rtol=1e-12)
    assert budget.advice(whole, groups).startswith("Measure the scan of B2 better: known exactly, ")
    assert f"from {100 * whole.total:.1f} to {100 * whole.remaining(SURFACE.names):.1f} %." in budget.advice(
        whole, groups
    )
    assert "of the force would fall" in budget.advice(whole, groups, "force")


def test_what_others_compensate_is_not_worth_measuring_although_its_effect_is_largest():
    # The first two effects nearly cancel: to know one of them alone leaves most of the variance 0.2 + 0.25.
    covariance = np.array([[1.0, -0.9, 0.0], [-0.9, 1.0, 0.0], [0.0, 0.0, 0.25]]) * 1e-4
    found = Budget(("skewness", "kurtosis", "gap"), np.ones(3), covariance)
    groups = {f"the {name}": (name,) for name in found.names}
    rows = budget.ranked(found, groups)
    assert max(rows, key=lambda row: row[1])[0] != "the gap"
    assert rows[0][0] == "the gap"
    assert_allclose(rows[0][1:], 1e-2 * np.sqrt([0.25, 0.2]), rtol=1e-12)
    assert_allclose([row[2] for row in rows[1:]], 1e-2 * np.sqrt(0.19 + 0.25), rtol=1e-12)
    expected = (
        "Measure the gap better: known exactly, the standard uncertainty of the length would fall from 0.7 to 0.4 %."
    )
    assert budget.advice(found, groups) == expected


def test_a_choice_of_the_model_is_a_ratio():
    assert_allclose(budget.choice_effect(700.0, 700 * np.exp(0.042)), 0.042, rtol=1e-12)


@pytest.mark.parametrize(
    ("slopes", "covariance", "message"),
    [
        (np.ones(3), np.eye(2), "2 inputs need"),
        (np.ones(2), np.eye(3), "2 inputs need"),
        (np.ones(2), np.array([[1, 2], [2, 1]]), "negative eigenvalues"),
        (np.ones(2), np.array([[1, 0.5], [0.4, 1]]), "symmetric"),
    ],
)
def test_a_budget_is_checked_at_once(slopes, covariance, message):
    with pytest.raises(ValueError, match=message):
        Budget(("a", "b"), slopes, covariance)


def test_three_joint_shifts_of_a_beam_are_the_sum_of_single_ones():
    shifts, step = {"thickness": 0.06, "gap": 0.12, "young_modulus": 0.1}, 0.03

    def scaled(factors):
        return crack_lengths(80, **{name: getattr(PAPER, name) * np.exp(shift) for name, shift in factors.items()})

    slopes, errors = np.transpose(
        [budget.log_slope(np.mean, scaled({x: -step}), scaled({x: step}), 2 * step) for x in shifts]
    )
    joint, joint_error = budget.log_slope(np.mean, scaled({}), scaled(shifts), 1.0)
    single = list(shifts.values())
    error = np.hypot(joint_error, np.linalg.norm(errors * single))
    assert abs(joint - slopes @ single) < 4 * error
    assert abs(joint - 0.06 * slopes[0]) > 4 * error  # control: without gap and modulus
    assert np.all(np.abs(slopes - [0.79, 0.5, 0.26]) < 4 * errors + 0.03)  # Eq. (13), and a little more for more places


def test_the_error_of_an_effect_is_the_scatter_of_effects_with_scattered_slopes():
    rng, errors = np.random.default_rng(5), np.array([0.02, 0.05, 0.03])
    repeats = [replace(SURFACE, slopes=SURFACE.slopes + errors * rng.standard_normal(3)) for _ in range(2000)]
    for group in (SURFACE.names, ("rms",), ("skewness", "kurtosis")):
        scatter = np.std([found.effect(group) for found in repeats])
        assert_allclose(SURFACE.error_of_effect(group, errors), scatter, rtol=0.08)
    exact = Budget(("a",), np.ones(1), np.zeros((1, 1)))
    assert exact.error_of_effect(("a",), np.ones(1)) == 0


def test_a_budget_without_correlations_keeps_the_uncertainties():
    plain = SURFACE.uncorrelated
    assert_allclose(np.diag(plain.covariance), np.diag(SURFACE.covariance))
    assert_allclose(plain.total**2, np.sum(SURFACE.slopes**2 * np.diag(SURFACE.covariance)), rtol=1e-12)
    assert plain.total > 1.5 * SURFACE.total


# Curvature

#: Share of normal numbers beyond two standard deviations.
BEYOND = 0.0228


def beyond_margin(bends, covers, slopes, covariance):
    """Share of drawn truths ln l = -(g x + b x²) below a margin of twice a total, and its standard error."""
    drawn = np.random.default_rng(8).multivariate_normal(np.zeros(len(slopes)), covariance, 200_000)
    found = Budget(tuple(map(str, range(len(slopes)))), slopes, covariance)
    change = drawn @ slopes + drawn**2 @ bends
    return np.mean(change > 2 * covers(found)), np.sqrt(BEYOND / len(drawn))


@pytest.mark.parametrize("seed", range(12))
def test_a_margin_with_curvature_covers_drawn_truths_whose_response_is_curved(seed):
    # At a slope of zero alone, 2.5 % of the truths are beyond five times b σ²: the 2.28 % of a normal number and 0.3.
    rng = np.random.default_rng(seed)
    k, deviations = int(rng.integers(1, 5)), 0.9
    slopes, bends = rng.uniform(-0.3, 0.3, k), rng.uniform(-0.1, 0.3, k)
    covariance = np.diag(np.full(k, deviations**2))
    curved, error = beyond_margin(bends, lambda found: found.unsafe_total(bends), slopes, covariance)
    assert curved < BEYOND + 0.003 + 4 * error
    if np.max(bends) > 0.1:
        linear, _ = beyond_margin(bends, lambda found: found.total, slopes, covariance)
        assert linear > 1.3 * BEYOND  # control


def test_a_linear_response_and_one_that_bends_to_the_safe_side_keep_the_linear_margin():
    for bends in (np.zeros(3), np.array([-1.0, -2.0, 0.0])):
        assert SURFACE.unsafe_total(bends) == SURFACE.total
    assert SURFACE.unsafe_total(np.array([0.0, 0.1, 0.0])) > SURFACE.total


def test_one_curved_input_takes_the_change_at_two_standard_uncertainties_and_half_of_one_of_its_bend():
    for slope in (-0.3, 0.3):
        found = Budget(("corner",), np.array([slope]), np.array([[0.64]]))
        taken = 2 * found.unsafe_total(np.array([0.2]))
        assert_allclose(taken, 0.3 * 1.6 + 0.2 * 1.6**2 + 0.2 * 0.8**2, rtol=1e-12)
