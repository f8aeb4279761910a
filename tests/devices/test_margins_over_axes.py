"""Margins over one axis and over two: the same numbers wherever the second axis changes nothing."""

import numpy as np
import pytest

from stiction.analysis.process_law import fit, grid
from stiction.devices import process
from stiction.devices.process import Margins, law_error, recommended, run_error

SETTINGS, SECONDS = np.array([30.0, 50.0, 70.0, 90.0]), np.array([5.0, 12.0, 20.0])
ERROR = np.array([[0.01]])


def law(settings):
    """Law of one quantity, from -0.9 to 0.9, with errors of 0.1 at each setting."""
    return fit(settings, np.linspace(-0.9, 0.9, len(settings))[:, None], np.full((len(settings), 1, 1), 0.01))


LAWS = [law(SETTINGS), law(SECONDS)]


def over_one(bend=0.9):
    """Margin with its largest value inside the settings, and its slopes."""
    values = grid(SETTINGS)
    quantity = LAWS[0].at(values)[:, 0]
    margin, slopes = 0.3 + 0.5 * quantity - bend * quantity**2, 0.5 - 2 * bend * quantity
    return Margins((values,), margin, slopes[:, None], np.zeros(len(values)))


def over_two(effect=0.0):
    """The same margin at settings of a second process, which adds its quantity times an effect."""
    one, seconds = over_one(), grid(SECONDS, 4)
    added = effect * LAWS[1].at(seconds)[:, 0]
    slopes = [np.broadcast_to(one.slopes[:, 0], (len(seconds), len(one.margin))), np.full((len(seconds), 1), effect)]
    stacked = np.stack(np.broadcast_arrays(*slopes), axis=-1)
    return Margins((seconds, *one.axes), one.margin + added[:, None], stacked, np.zeros(stacked.shape[:2]))


@pytest.mark.parametrize("effect", [0.0, 0.4])
def test_a_second_process_changes_what_is_said_of_the_first_only_if_it_has_an_effect(effect, monkeypatch):
    monkeypatch.setattr(process, "SETTINGS", process.PAIRS)
    alone = recommended([over_one()], LAWS[:1], [ERROR], np.random.default_rng(1))
    both = recommended([over_two(effect)], LAWS, [ERROR, ERROR], np.random.default_rng(1))
    for name in ("margin", "safe", "safe_mean", "spread"):
        rows = getattr(both, name)
        assert np.allclose(rows, getattr(alone, name), atol=1e-9) is (effect == 0)
    np.testing.assert_array_equal(both.best[0], alone.best[0])  # margins add: the best is the same either way
    for name in ("error", "interval", "next", "again", "before", "after"):
        np.testing.assert_allclose(getattr(both, name)[0], getattr(alone, name)[0], rtol=1e-9)


def test_margins_between_settings_are_exact_where_they_are_linear_along_both_axes():
    two = over_two()
    x, y = two.axes[1], two.axes[0][:, None]
    plane = Margins(two.axes, 0.01 * x - 0.02 * y, two.slopes, 0.001 * x * y)
    values, seconds = np.linspace(31, 89, 7), np.array([5.5, 13.0])
    found = plane.at([seconds, values])
    np.testing.assert_allclose(found.margin, 0.01 * values - 0.02 * seconds[:, None], atol=1e-12)
    np.testing.assert_allclose(found.error, 0.001 * values * seconds[:, None])
    np.testing.assert_allclose(two.at(two.axes).margin, two.margin)


def test_errors_of_laws_and_runs_add_in_squares_over_both_axes():
    two, first = over_two(0.4), over_one()
    of_second = 0.4**2 * LAWS[1].covariance_at(two.axes[0])[:, 0, 0]
    np.testing.assert_allclose(law_error(two, LAWS) ** 2, law_error(first, LAWS[:1]) ** 2 + of_second[:, None])
    scatter = [one.scatter[0] for one in LAWS]
    expected = (first.slopes[:, 0] * scatter[0]) ** 2 + (0.4 * scatter[1]) ** 2
    np.testing.assert_allclose(run_error(two, LAWS) ** 2, np.broadcast_to(expected, two.margin.shape))
