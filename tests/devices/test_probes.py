"""Whether a measured pull-off force fits: against normal forces, whose answer is a closed form."""

import numpy as np
import pytest
from scipy.stats import norm

from stiction.devices.probes import fits, share_above


@pytest.mark.parametrize("measured", [0.6, 1.0, 1.5])
def test_errors_of_the_measurement_add_to_the_scatter_by_their_squares(measured):
    forces = norm.ppf((np.arange(4000) + 0.5) / 4000, 1.0, 0.15)
    for error in (0.0, 0.1, 0.3):
        expected = norm.sf(measured, 1.0, np.hypot(0.15, error))
        assert share_above(forces, 0.0, measured, error) == pytest.approx(expected, abs=4e-3)


def test_errors_of_the_inputs_move_the_logarithm_of_all_forces():
    found = [share_above(np.ones(1), error, 1.5, 0.0) for error in (0.01, 0.3, 1.0)]
    assert found == pytest.approx([0.0, norm.sf(np.log(1.5), scale=0.3), norm.sf(np.log(1.5))], abs=0.01)


def test_a_force_fits_between_the_outer_fractions():
    forces = norm.ppf((np.arange(4000) + 0.5) / 4000, 1.0, 0.1)
    known = {measured: fits(share_above(forces, 0.0, measured, 0.0)) for measured in (0.79, 0.82, 1.0, 1.18, 1.21)}
    assert known == {0.79: False, 0.82: True, 1.0: True, 1.18: True, 1.21: False}
    assert fits(share_above(forces, 0.0, 1.3, 0.15))  # within the error of the measurement
