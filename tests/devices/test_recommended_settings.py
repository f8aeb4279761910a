"""Recommended settings: known processes are covered, bands are exact for linear margins, and advice comes true.

The margins are those of a formula in place of simulated devices; laws, draws and recommendations are those of a run.
"""

import numpy as np
import pytest

from stiction.analysis import process_law
from stiction.analysis.process_law import fit, grid, scaled, scaled_covariance, unscaled
from stiction.devices.process import Margins, law_error, recommended

SETTINGS, FINE = np.array([30.0, 50.0, 70.0, 90.0]), np.linspace(30, 90, 301)
#: Errors of three scans of 10 µm: ln rms, skewness, kurtosis, ln corner, slope.
_ERRORS = np.array([0.014, 0.037, 0.115, 0.06, 0.06]) / np.sqrt(3)
COVARIANCE = np.outer(_ERRORS, _ERRORS) * np.eye(5)
COVARIANCE[1, 2] = COVARIANCE[2, 1] = -0.8 * _ERRORS[1] * _ERRORS[2]


@pytest.fixture(autouse=True)
def without_scatter(request, monkeypatch):
    """Runs of these processes agree, and are known to but where a test is slow."""
    if request.node.get_closest_marker("slow"):
        return
    monkeypatch.setattr(process_law, "SCATTERS", np.array([1e-12]))


def truth(time, bend):
    """Surface of a known process, whose quantities bend more or less: rougher and with deeper pits, (n, 5)."""
    x = (time - 60) / 30
    skewness = -0.6 - 0.25 * x - bend * 0.1 * x**2
    rms, corner = np.log(3.5) + 0.45 * x - bend * 0.12 * x**2, np.log(18) - 0.1 * x + bend * 0.05 * x**2
    return np.stack([rms, skewness, 1 + skewness**2 + 1.9 * np.exp(bend * 0.1 * x), corner, -4.4 + 0 * x], axis=-1)


def margin(surface):
    """Margin of a device on surfaces (n, 5), with the largest one between the ends of the settings."""
    rms, skewness, kurtosis, corner, _ = np.moveaxis(surface, -1, 0)
    rough = rms - np.log(3.5)
    pits = 1.6 * (skewness + 0.6) - 0.25 * (kurtosis - 3.3)
    return 1.5 * rough - 0.7 * np.maximum(rough + 0.3, 0) ** 2 + pits - 0.1 * (corner - np.log(18)) - 0.1


def curve_of(law, error=0.02):
    """Curve on a law, with slopes by central differences."""
    points = grid(law.settings)
    base, step = law.at(points), 1e-4 * np.eye(5)
    slopes = [(margin(unscaled(base + one)) - margin(unscaled(base - one))) / 2e-4 for one in step]
    return Margins((points,), margin(unscaled(base)), np.transpose(slopes), np.full(len(points), error))


def drawn(bend, rng, settings=SETTINGS):
    """Recommendation from one draw of scans of a known process."""
    values = truth(settings, bend) + rng.multivariate_normal(np.zeros(5), COVARIANCE, len(settings))
    errors = np.array([scaled_covariance(one, COVARIANCE) for one in values])
    law = fit(settings, scaled(values), errors)
    return recommended([curve_of(law)], [law], [errors.mean(axis=0)], rng), law


@pytest.mark.slow
@pytest.mark.parametrize("bend", [0.0, 1.0])
def test_the_best_setting_of_a_known_process_is_in_its_interval_in_93_of_100_draws(bend):
    rng, best = np.random.default_rng(6), FINE[np.argmax(margin(truth(FINE, bend)))]
    assert 35 < best < 85
    found = [drawn(bend, rng)[0] for _ in range(100)]
    inside = [low - 0.1 <= best <= high + 0.1 for low, high in np.vstack([one.interval for one in found])]
    assert sum(inside) >= 93
    width = np.mean([np.ptp(one.interval) for one in found])
    # Four settings hardly show how much runs scatter, and an interval that says nothing would hold all 95 % of them.
    assert width < 0.85 * np.ptp(SETTINGS)
    eighth = [abs(one.best[0] - best) < np.ptp(one.interval) / 16 for one in found]
    assert sum(eighth) < 93  # control: an eighth of the interval does not


def test_settings_said_to_suffice_do():
    rng = np.random.default_rng(7)
    wrong = 0
    for _ in range(20):
        found, _ = drawn(0.0, rng)
        for low, high in found.sufficient:
            inside = (low <= FINE) & (high >= FINE)
            wrong += bool(np.any(margin(truth(FINE[inside], 0.0)) < 0))
    assert wrong <= 4  # 5 % at each of two ends: 2 expected


def exact(slope=1.0, error=0.1, at=60.0):
    """Curve that depends on one quantity of a straight law alone, and the law."""
    law = fit(np.array([30.0, 90.0]), np.array([[-1.0], [1.0]]), np.full((2, 1, 1), error**2))
    points = grid(law.settings)
    values = (points - at) / 30
    return Margins((points,), slope * values, np.full((len(points), 1), slope), np.zeros(len(points))), law


def test_a_straight_margin_crosses_with_the_error_of_its_law():
    curve, law = exact()
    found = recommended([curve], [law], [np.array([[0.01]])], np.random.default_rng(8))
    (crossing,) = found.crossings
    np.testing.assert_allclose(crossing.coordinate, 60, atol=1e-6)
    np.testing.assert_allclose(crossing.error, 30 * 0.1 / np.sqrt(2), rtol=0.08)  # of 1000 draws
    np.testing.assert_allclose(law_error(curve, [law])[3], 0.1 / np.sqrt(2))
    ((low, high),) = found.sufficient
    assert high == 90
    np.testing.assert_allclose(low, 60 + 1.645 * crossing.error, atol=0.5)


def test_the_margin_of_several_devices_is_the_smallest_and_what_serves_all_is_in_the_range_of_each():
    (rising, law), (falling, _) = exact(), exact(slope=-1.0, at=75.0)
    both = recommended([rising, falling], [law], [np.array([[0.01]])], np.random.default_rng(9))
    np.testing.assert_allclose(both.best, 67.5, atol=0.2)
    np.testing.assert_allclose(both.margin, np.minimum((both.axes[0] - 60) / 30, (75 - both.axes[0]) / 30), atol=1e-9)


def test_without_errors_what_suffices_is_known_exactly():
    curve, law = exact(error=1e-9)
    found = recommended([curve], [law], [np.array([[1e-18]])], np.random.default_rng(10))
    np.testing.assert_allclose(found.sufficient, [(60, 90)], atol=1e-6)
    assert found.interval.tolist() == [[90, 90]]


def test_the_setting_to_measure_next_shrinks_the_error_as_said():
    rng = np.random.default_rng(11)
    found, law = drawn(0.0, rng)
    assert found.subject == "best"
    assert found.again == (found.next in SETTINGS)
    assert law.settings[0] <= found.next <= law.settings[-1]
    assert 0.3 * found.before < found.after < found.before
    before, after = (
        [drawn(0.0, rng, np.sort(some))[0].error[0] for _ in range(12)]
        for some in (SETTINGS, [*SETTINGS, found.next[0] + 1e-3])
    )
    assert np.median(after) < np.median(before)


def test_where_the_best_setting_is_an_end_the_length_of_the_range_is_what_the_next_one_tells():
    curve, law = exact()
    found = recommended([curve], [law], [np.array([[0.01]])], np.random.default_rng(12))
    assert found.best == 90
    assert found.subject == "range"
    assert found.after < found.before
    assert (found.next, found.again) == (60, False)  # between the settings
