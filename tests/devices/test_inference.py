"""Laws of inference from test beams: with analytic responses, and on the lengths that the paper measured."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.optimize import minimize
from scipy.special import chdtrc, logsumexp, ndtr, ndtri, softmax

from stiction.devices import inference
from stiction.devices.budget import Budget
from stiction.devices.inference import Counts, CrackData, DiscrepancyOfModel, KnownInputs, given_lengths, update
from stiction.report import published
from stiction.streams import stream

NAMES = ("rms", "skewness", "modulus", "thickness of test beams", "thickness")
#: Skewness is correlated with the rms, as errors from one scan are.
PRIOR = KnownInputs(NAMES, np.zeros(5), np.diag([0.05, 0.04, 0.03, 0.02, 0.02]) ** 2)
PRIOR.covariance[0, 1] = PRIOR.covariance[1, 0] = 0.6 * 0.05 * 0.04
#: Responses of test beams at three humidities, and of a device at two.
BEAMS = np.array([[1.0, 0.9, 0.56, 0.76, 0], [1.3, 1.1, 0.5, 0.76, 0], [0.4, 0.3, 0.3, 0.75, 0]])
DEVICE = np.array([[1.0, 0.9, 0.56, 0, 0.76], [0.6, 0.5, 0.4, 0, 0.75]])
DATA = CrackData(BEAMS, np.array([0.08, 0.11, -0.01]), np.array([0.01, 0.02, 0.015]))
#: The default of the configuration.
STATED = DiscrepancyOfModel(factor=0.1, slope=0.3, rest=0.05)


def part(data, *places):
    """Some of the data, in an order."""
    return type(data)(**{name: values[list(places)] for name, values in vars(data).items()})


def assert_equal(one, other, rtol=1e-9):
    assert_allclose(one.mean, other.mean, rtol, atol=1e-14)
    assert_allclose(one.covariance, other.covariance, rtol, atol=1e-16)


def test_without_data_the_posterior_is_the_prior():
    found = update(PRIOR, part(DATA))
    assert_array_equal(found.mean, PRIOR.mean)
    assert_array_equal(found.covariance, PRIOR.covariance)
    assert not np.allclose(update(PRIOR, part(DATA, 0)).covariance, PRIOR.covariance)  # control


def test_an_input_measured_exactly_leaves_the_conditional_distribution():
    # Of the rms alone: E[x | x_0 = d] = C[:, 0] d / C[0, 0], and the budget's own remaining uncertainty.
    exact = update(PRIOR, CrackData(np.eye(5)[:1], np.array([0.03]), np.zeros(1)))
    assert_allclose(exact.mean, PRIOR.covariance[:, 0] * 0.03 / PRIOR.covariance[0, 0], rtol=1e-12)
    budget = Budget(NAMES, DEVICE[0], PRIOR.covariance)
    assert_allclose(exact.response_moments(DEVICE[0])[1], budget.remaining(["rms"]), rtol=1e-9)
    assert abs(exact.response_moments(DEVICE[0])[1] / budget.remaining(["modulus"]) - 1) > 0.1  # control


def test_equal_data_twice_are_data_of_twice_as_many_beams():
    twice = update(PRIOR, part(DATA, 0, 1, 2, 0, 1, 2))
    assert_equal(twice, update(PRIOR, replace(DATA, errors=DATA.errors / np.sqrt(2))))
    with pytest.raises(AssertionError):
        assert_equal(twice, update(PRIOR, DATA))


def test_the_order_of_the_data_does_not_matter_nor_whether_they_come_at_once():
    assert_equal(update(PRIOR, DATA), update(PRIOR, part(DATA, 2, 0, 1)))
    assert_equal(update(PRIOR, DATA), update(update(PRIOR, part(DATA, 0)), part(DATA, 1, 2)))


@pytest.mark.parametrize("seed", range(5))
def test_more_beams_widen_no_interval(seed):
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(5, 5))
    known = KnownInputs(NAMES, np.zeros(5), root @ root.T)
    results = rng.normal(size=(20, 5))
    widths = [known.response_moments(results)[1]]
    for response in rng.normal(size=(6, 5)):
        known = update(known, CrackData(response[None], rng.normal(size=1), np.array([0.3])))
        widths.append(known.response_moments(results)[1])
    assert np.all(np.diff(widths, axis=0) <= 1e-12)
    assert widths[-1].max() < 0.9 * widths[0].max()


def test_shared_inputs_tell_about_the_device_and_inputs_of_the_test_beams_alone_do_not():
    found = update(PRIOR, DATA)
    assert found.response_moments(DEVICE[0])[1] < 0.5 * PRIOR.response_moments(DEVICE[0])[1]
    assert_allclose(found.deviations[-1], PRIOR.deviations[-1], rtol=1e-12)  # thickness of the device
    apart = CrackData(BEAMS * (np.array(NAMES) == "thickness of test beams"), DATA.differences, DATA.errors)
    assert_allclose(update(PRIOR, apart).response_moments(DEVICE[0]), PRIOR.response_moments(DEVICE[0]), rtol=1e-12)


# Known truth


def drawn(rng, truth, beams=12, scatter=0.05):
    """Mean crack lengths of test beams with these inputs, and their standard errors as an engineer states them."""
    single = DATA.responses @ truth + scatter * rng.normal(size=(beams, len(DATA.responses)))
    return CrackData(DATA.responses, single.mean(axis=0), single.std(axis=0, ddof=1) / np.sqrt(beams))


def coverage(posterior, repeats=100):
    """Shares of true lengths of the device inside the stated intervals of 68 and 95 %."""
    scores = []
    for k in range(repeats):
        rng = np.random.default_rng(k)
        truth = rng.multivariate_normal(np.zeros(5), PRIOR.covariance)
        mean, deviation = posterior(drawn(rng, truth)).response_moments(DEVICE)
        scores.append((DEVICE @ truth - mean) / deviation)
    return np.mean(np.abs(scores) < 1), np.mean(np.abs(scores) < 1.96)


def test_stated_intervals_hold_the_true_lengths_of_drawn_test_beams():
    inner, outer = coverage(lambda data: update(PRIOR, data))
    assert abs(inner - 0.68) <= 0.10
    assert abs(outer - 0.95) <= 0.04


def test_intervals_that_forget_the_scatter_between_beams_do_not():
    inner, outer = coverage(lambda data: update(PRIOR, replace(data, errors=data.errors / 5)))
    assert inner < 0.58
    assert outer < 0.91


# Counts


#: No crack lengths of beams with five inputs, or with the logarithm of their length alone.
NOTHING = part(DATA)
OF_LENGTH = CrackData(np.empty((0, 1)), np.empty(0), np.empty(0))


def one_shape(responses, margins, scatter, stuck, beams):
    """Counts of beams that one shape holds, with lengths of ln = margin above that of half of the beams."""
    scores = [[inference.lognormal(1.0, scatter)]] * len(stuck)
    return Counts(np.array(responses)[:, None], np.exp(margins)[:, None], scores, np.array(stuck), np.array(beams))


#: Beams that an S-shape or an arc may hold; arcs respond half as much and scatter more, with a long upper end.
ARCS = inference.score(1.1 * np.exp(0.12 * np.abs(np.random.default_rng(0).normal(-0.5, 1, 2000)) ** 1.3))
TWO_SHAPES = Counts(
    np.stack([BEAMS, BEAMS / 2], axis=1)[:2],
    np.exp([[0.05, 0.15], [-0.08, 0.05]]),
    [[inference.lognormal(1.0, 0.06), ARCS]] * 2,
    np.array([17, 4]),
    np.array([20, 20]),
)
ONE_SHAPE = one_shape(BEAMS[:2], np.array([0.05, -0.08]), 0.06, [17, 4], [20, 20])


#: Equally weighted draws that the knowledge after counts is worth at least.
WORTH = 2048


def after(prior, lengths, counts):
    return update(prior, lengths, counts, stream(0, "test"))


def stuck_of(counts, stuck):
    """The same beams, of which so many stick."""
    return replace(counts, stuck=np.array(stuck))


def most_probable(prior, counts):
    """Normal distribution around the most probable errors of the inputs with the curvature there (Laplace)."""
    root = np.linalg.cholesky(prior.covariance)

    def slope(z):
        return z + counts.slope(root @ z) @ root / 2

    best = minimize(lambda z: z @ z / 2 + counts.deviance(root @ z) / 2, np.zeros(len(root)), jac=slope).x
    steps = 1e-4 * np.eye(len(root))
    curvature = np.array([(slope(best + step) - slope(best - step)) / 2e-4 for step in steps])
    return KnownInputs(prior.names, root @ best, root @ np.linalg.inv((curvature + curvature.T) / 2) @ root.T)


def on_grid(known, counts, points=301):
    """Lengths ln l of two counted groups on a grid (m, 2), and their probabilities after the measurement (m,)."""
    mean, covariance = BEAMS[:2] @ known.mean, BEAMS[:2] @ known.covariance @ BEAMS[:2].T
    root = np.linalg.cholesky(covariance)
    z = np.stack(np.meshgrid(*[np.linspace(-6, 6, points)] * 2, indexing="ij"), axis=-1).reshape(-1, 2)
    errors = known.mean + z @ np.linalg.solve(root, BEAMS[:2] @ known.covariance)
    logarithms = -(z**2).sum(axis=1) / 2 - counts.deviance(errors) / 2
    return mean + z @ root.T, np.exp(logarithms - logsumexp(logarithms))


@pytest.mark.parametrize("stuck", [(17, 4), (20, 20), (0, 0), (20, 0)])
@pytest.mark.parametrize("counts", [ONE_SHAPE, TWO_SHAPES], ids=["one shape", "two shapes"])
def test_the_knowledge_after_counts_is_that_of_quadrature(counts, stuck):
    counts = stuck_of(counts, stuck)
    known = given_lengths(PRIOR, part(DATA, 2))
    found = after(PRIOR, part(DATA, 2), counts)
    at, chances = on_grid(known, counts)
    mean = chances @ at
    deviations = np.sqrt(chances @ (at - mean) ** 2)
    for number, exact, tolerance in zip(found.response_moments(BEAMS[:2]), (mean, deviations), (1, 2), strict=True):
        assert_allclose(number, exact, atol=4 * tolerance * deviations.max() / np.sqrt(WORTH))
    for length, quantiles in zip(at.T, found.quantiles(BEAMS[:2], np.array([-2, 0, 2])), strict=True):
        for quantile, share in zip(quantiles, ndtr([-2, 0, 2]), strict=True):
            below = chances[length < quantile].sum()
            assert abs(below - share) < 4 * np.sqrt(share * (1 - share) / WORTH) + 0.005  # and half a step of the grid


@pytest.mark.parametrize("stuck", [0, 40])
def test_intervals_hold_what_is_probable_where_all_or_no_beams_stick_and_those_of_the_curvature_do_not(stuck):
    prior = KnownInputs(("ln l",), np.zeros(1), np.full((1, 1), 0.12**2))
    counts = one_shape(np.ones((1, 1)), np.zeros(1), 0.03, [stuck], [40])
    at = np.linspace(-0.8, 0.8, 4001)[:, None]
    chances = softmax(-((at[:, 0] / 0.12) ** 2) / 2 - counts.deviance(at) / 2)

    def held(known):
        mean, deviation = known.response_moments(np.ones((1, 1)))
        return chances[np.abs(at[:, 0] - mean) < 1.96 * deviation].sum()

    found = after(prior, OF_LENGTH, counts)
    low, high = found.quantiles(np.ones((1, 1)), np.array([-1.96, 1.96]))[0]
    assert abs(held(found) - 0.95) <= 0.025
    assert abs(chances[(low < at[:, 0]) & (at[:, 0] < high)].sum() - 0.95) <= 0.01
    assert held(most_probable(prior, counts)) < 0.90  # control


@pytest.mark.parametrize("stuck", [0, 5, 20])
@pytest.mark.parametrize("scatter", [0.005, 0.06])
@pytest.mark.parametrize("margin", [-0.5, 0.1, 0.6])
def test_no_errors_of_the_inputs_are_more_probable_than_those_of_the_least_misfit(margin, scatter, stuck):
    """Also of counts that contradict the prior, in which lengths err by 10 %."""
    shapes = [[inference.lognormal(1.0, scatter), ARCS]]
    counts = Counts(
        TWO_SHAPES.responses[:1], np.exp([[margin, margin + 0.1]]), shapes, np.array([stuck]), np.array([20])
    )
    errors = after(PRIOR, DATA, counts).draws.centres
    errors = np.concatenate([errors + (share - 1) * (errors - errors.mean(axis=0)) for share in (0, 0.5, 1)])
    pulls = (DATA.differences - errors @ DATA.responses.T) / DATA.errors
    inputs = np.einsum("mi,ij,mj->m", errors, np.linalg.inv(PRIOR.covariance), errors)
    misfits = (pulls**2).sum(axis=1) + inputs + counts.deviance(errors)
    least = sum(misfit for misfit, _ in inference.least_misfits(PRIOR, DATA, counts))
    assert least <= misfits.min() + 1e-3


@pytest.mark.parametrize("counts", [ONE_SHAPE, TWO_SHAPES], ids=["one shape", "two shapes"])
@pytest.mark.parametrize("stuck", [(17, 4), (20, 0)])
def test_the_slope_of_the_deviance_is_its_derivative(counts, stuck):
    counts, at = stuck_of(counts, stuck), 0.4 * PRIOR.deviations
    steps = 1e-6 * np.eye(5)
    slope = [(counts.deviance(at + step) - counts.deviance(at - step)) / 2e-6 for step in steps]
    assert_allclose(counts.slope(at), slope, rtol=1e-5, atol=1e-6)


def test_equal_streams_give_equal_knowledge_bit_for_bit():
    one, other = (after(PRIOR, DATA, TWO_SHAPES) for _ in range(2))
    assert_array_equal(one.mean, other.mean)
    assert_array_equal(one.draws.centres, other.draws.centres)


def test_counts_say_what_the_lengths_of_the_same_beams_say():
    # Of N beams with measured lengths and scatter s, ln l is known to s/√N; counted at the median length, it is known
    # to √(π/2) s/√N (a probit at Φ = 1/2).
    number, scatter = 4000, 0.06
    rng, response = np.random.default_rng(3), np.ones((1, 1))
    flat = KnownInputs(("ln l",), np.zeros(1), np.ones((1, 1)))
    single = 0.1 + scatter * rng.normal(size=number)
    measured = update(flat, CrackData(response, single.mean(keepdims=True), np.array([scatter / np.sqrt(number)])))
    counts = one_shape(response, np.array([0.1]), scatter, [np.sum(single < 0.1)], [number])
    counted = after(flat, OF_LENGTH, counts)
    assert_allclose(counted.deviations / measured.deviations, np.sqrt(np.pi / 2), rtol=4 / np.sqrt(2 * WORTH))
    assert abs(counted.mean - measured.mean)[0] < 4 * counted.deviations[0]


@pytest.mark.parametrize(("stuck", "sign"), [(0, 1), (20, -1)])
def test_beams_that_all_stick_or_all_come_free_bound_the_length_on_one_side(stuck, sign):
    flat = KnownInputs(("ln l",), np.zeros(1), np.full((1, 1), 0.2**2))
    found = after(flat, OF_LENGTH, one_shape(np.ones((1, 1)), np.zeros(1), 0.05, [stuck], [20]))
    assert sign * found.mean[0] > found.deviations[0]
    assert found.deviations[0] < 0.2


def test_of_two_shapes_the_weaker_one_changes_nothing():
    # Arcs of beams that are much shorter than all arcs hold none of them: what remains is the S-shape alone.
    short = replace(TWO_SHAPES, lengths=TWO_SHAPES.lengths * [1, 1e-3])
    errors = PRIOR.deviations * np.random.default_rng(0).normal(size=(20, 5))
    assert_allclose(short.deviance(errors), ONE_SHAPE.deviance(errors), rtol=1e-9)
    assert np.all(np.abs(TWO_SHAPES.deviance(errors) - ONE_SHAPE.deviance(errors)) > 0.01)  # control


def test_a_beam_is_free_if_no_shape_holds_it():
    logarithms = TWO_SHAPES.logarithms(0.3 * PRIOR.deviations)
    free = ndtr(-TWO_SHAPES.scored(0.3 * PRIOR.deviations)).prod(axis=1)
    assert_allclose(np.exp(logarithms), [1 - free, free], rtol=1e-12)
    # Also of beams so long, or so short, that one of both rounds to nothing.
    extreme = replace(TWO_SHAPES, lengths=np.array([[9.0, 9.0], [0.1, 0.1]]))
    assert np.all(np.isfinite(extreme.logarithms(np.zeros(5))))


def test_normal_scores_are_those_of_the_lengths():
    lengths = np.random.default_rng(1).lognormal(0.2, 0.1, 100_000)
    at = 0.2 + 0.1 * np.array([-5, -2.5, -1, 0, 1, 2, 4])
    assert_allclose(inference.score(lengths)(at), inference.lognormal(np.exp(0.2), 0.1)(at), rtol=0.05, atol=0.02)
    few = np.exp(0.2 + 0.1 * ndtri((np.arange(400) + 0.5) / 400))  # goes on beyond the longest one, at 3.0
    assert_allclose(inference.score(few)(0.2 + 0.1 * np.array([2, 3, 4])), [2, 3, 4], rtol=0.02)
    skewed = np.sort(np.exp(np.random.default_rng(2).exponential(0.2, 10_000)))
    shares = ndtr(inference.score(skewed)(np.log(skewed[[500, 5000, 9000]])))
    assert_allclose(shares, [0.05, 0.5, 0.9], atol=0.01)
    assert np.all(np.diff(inference.score(skewed)(np.linspace(-3, 3, 500))) > 0)


def test_p_values_of_counts_that_err_as_stated_are_nearly_uniform_and_those_of_others_small():
    rng, values = np.random.default_rng(4), []
    for _ in range(200):
        truth = rng.multivariate_normal(np.zeros(5), PRIOR.covariance)
        lengths = replace(DATA, differences=BEAMS @ truth + DATA.errors * rng.normal(size=3))
        stuck = np.sum(BEAMS[:2] @ truth + 0.06 * rng.normal(size=(20, 2)) < 0.02, axis=0)
        counts = one_shape(BEAMS[:2], np.full(2, 0.02), 0.06, stuck, [20, 20])
        values.append(inference.p_value(PRIOR, lengths, counts))
    assert abs(np.mean(values) - 1 / 2) < 4 / np.sqrt(12 * 200)
    # Beams shorter than measured cracks that all stick.
    wrong = one_shape(BEAMS[:1], np.array([-0.3]), 0.06, [20], [20])
    assert inference.p_value(PRIOR, DATA, wrong) < 1e-4


def test_exactly_known_inputs_explain_counts_by_chance_alone():
    exact, none = KnownInputs((), np.zeros(0), np.zeros((0, 0))), CrackData(np.empty((0, 0)), np.empty(0), np.empty(0))
    for stuck in ([12, 5], [20, 0]):
        counts = one_shape(BEAMS[:2, :0], np.array([0.02, -0.05]), 0.06, stuck, [20, 20])
        expected = chdtrc(2, counts.deviance(np.zeros(0)))
        assert inference.p_value(exact, none, counts) == pytest.approx(expected)
        # As with an input of which beams know nothing.
        unrelated = one_shape(np.zeros((2, 1)), np.array([0.02, -0.05]), 0.06, stuck, [20, 20])
        assert inference.p_value(KnownInputs(("x",), np.zeros(1), np.eye(1)), OF_LENGTH, unrelated) == pytest.approx(
            expected
        )
        assert after(exact, none, counts).mean.shape == (0,)


def test_counts_that_all_lengths_explain_hide_no_contradiction_between_lengths():
    wrong = replace(DATA, differences=0.06 * np.array([1.0, -1.0, 0.0]))
    assert inference.p_value(PRIOR, wrong) < 1e-5
    sure = one_shape(np.repeat(BEAMS[:1], 20, axis=0), np.full(20, 1.0), 0.06, [10] * 20, [10] * 20)
    assert inference.p_value(PRIOR, wrong, sure) < 1e-5


# What the data say


def test_p_values_of_data_that_err_as_stated_are_uniform_and_those_of_others_small():
    rng = np.random.default_rng(0)
    values = []
    for _ in range(400):
        truth = rng.multivariate_normal(np.zeros(5), PRIOR.covariance)
        values.append(
            inference.p_value(PRIOR, replace(DATA, differences=BEAMS @ truth + DATA.errors * rng.normal(size=3)))
        )
    assert abs(np.mean(values) - 1 / 2) < 4 / np.sqrt(12 * 400)
    assert abs(np.mean(np.array(values) < 0.1) - 0.1) < 4 * np.sqrt(0.09 / 400)
    # Opposite differences at two humidities at which all inputs act alike.
    assert inference.p_value(PRIOR, replace(DATA, differences=np.array([0.2, -0.2, 0]))) < 1e-4


def test_one_length_determines_one_combination_and_leaves_its_inputs_on_a_line():
    independent = replace(PRIOR, covariance=np.diag(np.diag(PRIOR.covariance)))
    first, *others = inference.combinations(independent, update(independent, part(DATA, 0)))
    assert_allclose([one.remaining for one in others], 1, rtol=1e-9)
    # Correlation of input k with h^T x: h_k σ_k / |h σ|.
    effects = BEAMS[0] * independent.deviations
    assert_allclose(first.correlations, effects / np.linalg.norm(effects), atol=1e-9)
    assert_allclose(first.remaining**2, 1 / (1 + (np.linalg.norm(effects) / DATA.errors[0]) ** 2), rtol=1e-9)


def test_combinations_leave_out_what_is_known_and_what_is_fully_correlated():
    covariance = np.diag([0.0, 1, 1])
    covariance[1, 2] = covariance[2, 1] = 1
    known = KnownInputs(("exact", "angle", "other angle"), np.zeros(3), covariance)
    data = CrackData(np.array([[1.0, 1, 1]]), np.zeros(1), np.ones(1))
    (only,) = inference.combinations(known, update(known, data))
    assert_allclose(only.correlations, [0, 1, 1], atol=1e-9)
    assert_allclose(only.remaining**2, 1 / (1 + 4), rtol=1e-9)


def test_the_expected_gain_of_further_beams_is_that_of_the_update_with_them():
    found = update(PRIOR, DATA)
    expected = inference.further_beams(found, DEVICE[0], BEAMS[2], 0.01)
    later = update(found, CrackData(BEAMS[2:], np.array([0.3]), np.array([0.01])))
    assert_allclose(expected, later.response_moments(DEVICE[0])[1], rtol=1e-12)
    assert expected < found.response_moments(DEVICE[0])[1]
    assert_allclose(
        inference.further_beams(found, DEVICE[0], np.zeros(5), 0.01), found.response_moments(DEVICE[0])[1], rtol=1e-12
    )


# The lengths that the paper measured, beside those of its model NG


def measured(pair, *places):
    """ln(measured / computed), standard deviations between beams and ln computed at some humidities of a pair."""
    table = published.read(published.file("table_3"))
    rows = table[table.pair == pair].iloc[list(places)] if places else table[table.pair == pair]
    return (
        np.log(rows.experiment / rows.ng).to_numpy(),
        (rows.experiment_std / rows.experiment).to_numpy(),
        np.log(rows.ng).to_numpy(),
    )


def predicted(known, asked, stated=STATED, beams=1):
    """Errors of lengths predicted from others, their stated deviations, and the p value of the others.

    All beams of the paper have the same dimensions, so that ln l may replace u. The number of beams is not published.
    """
    (differences, errors, logarithms), (truth, scatter, others) = known, asked
    n = len(differences)
    reduced = np.concatenate([logarithms, others]) - logarithms.mean()
    nothing = KnownInputs((), np.zeros(0), np.zeros((0, 0)))
    prior, responses = inference.with_discrepancy(
        nothing, np.zeros((len(reduced), 0)), reduced, list(range(len(reduced))), stated
    )
    data = CrackData(responses[:n], differences, errors / np.sqrt(beams))
    mean, deviation = update(prior, data).response_moments(responses[n:])
    return truth - mean, np.hypot(deviation, scatter / np.sqrt(beams)), inference.p_value(prior, data)


def of_halves(pair, **given):
    """Every second humidity from the others: errors of all six, their scores, p values of both halves."""
    halves = [(0, 2, 4), (1, 3, 5)]
    found = [predicted(measured(pair, *one), measured(pair, *other), **given) for one, other in (halves, halves[::-1])]
    errors, deviations = (np.concatenate(values) for values in list(zip(*found, strict=True))[:2])
    return errors, errors / deviations, [p for *_, p in found]


def rms(values):
    return np.sqrt(np.mean(np.square(values)))


@pytest.mark.parametrize("beams", [1, 10])
@pytest.mark.parametrize("pair", ["a", "b", "c"])
def test_three_humidities_predict_the_other_three_within_8_percent(pair, beams):
    errors, scores, p_values = of_halves(pair, beams=beams)
    assert rms(errors) <= 0.08
    assert np.max(np.abs(scores)) < 3
    assert min(p_values) > 0.05


@pytest.mark.parametrize("beams", [1, 10])
def test_test_beams_of_pair_a_predict_pair_b_within_7_percent(beams):
    errors, scores, _ = predicted(measured("a"), measured("b"), beams=beams)
    assert rms(errors) <= 0.07
    assert np.max(np.abs(scores)) < 2


def test_one_common_factor_makes_pair_c_worse_and_its_data_say_so():
    as_computed = rms(measured("c")[0])
    factor = replace(STATED, slope=0.0)
    errors, _, p_values = of_halves("c", stated=factor)
    assert rms(errors) > as_computed > 0.27
    assert max(p_values) < 1e-3
    assert min(of_halves("a", stated=factor)[2]) > 0.05  # control: pair a needs no slope


def test_without_a_rest_of_the_model_ten_beams_promise_too_much():
    exact = replace(STATED, rest=0.0)
    for pair in "ab":
        _, scores, _ = of_halves(pair, stated=exact, beams=10)
        assert np.max(np.abs(scores)) > 3
        assert predicted(measured(pair), measured(pair), stated=exact, beams=10)[2] < 1e-6
