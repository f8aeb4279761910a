import numpy as np
import pytest

from stiction.analysis.asperities import rms_deviation


def test_the_rms_deviation_is_that_of_the_crack_lengths():
    """Of energies that differ by a factor at each humidity, so that it has no error."""
    others = np.random.default_rng(2).uniform(1, 2, (8, 2))
    rms, error = rms_deviation(others * [0.5, 2.0], others)
    assert rms == pytest.approx(np.sqrt(((2**0.25 - 1) ** 2 + (2**-0.25 - 1) ** 2) / 2))
    assert error < 1e-12
    shorter, _ = rms_deviation(others * [0.5, 2.0], others, np.array([2**-0.25, 2**0.25]))
    assert shorter == pytest.approx(0, abs=1e-12)
    _, scattering = rms_deviation(others[::-1], others)
    assert scattering > 1e-3
