"""Surface with quantities of another one: closed forms of the spectrum are the second route."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from published import SURFACES

from stiction.analysis.shifts import Description, like

B2, SUB2 = (Description(3e-9, -0.76, 3.9, SURFACES[name].published_psd) for name in ("B2", "Sub2"))


def test_moments_alone_leave_the_spectrum_as_it_is():
    found = like(B2, {"rms": 5e-9, "skewness": -1.1})
    assert (found.rms, found.skewness, found.kurtosis) == (5e-9, -1.1, 3.9)
    assert found.spectrum is B2.spectrum


@pytest.mark.parametrize("names", [("corner",), ("slope",), ("cutoff",), ("slope", "corner", "cutoff")])
def test_a_spectrum_has_the_quantities_of_the_other_and_keeps_its_own_others(names):
    other = SUB2.spectrum
    found = like(B2, {name: getattr(other, name) for name in names})
    for name in ("slope", "corner", "cutoff"):
        assert_allclose(
            getattr(found.spectrum, name), getattr(other if name in names else B2.spectrum, name), rtol=1e-9
        )
    assert_allclose(found.spectrum.variance, 9e-18, rtol=1e-9)
    assert found.form is None


def test_all_of_another_spectrum_is_that_up_to_a_factor():
    found = like(B2, {name: getattr(SUB2.spectrum, name) for name in ("slope", "corner", "cutoff")})
    zeta = np.geomspace(1e6, 156e6, 20)
    ratio = found.spectrum(zeta) / SUB2.spectrum(zeta)
    assert_allclose(ratio, ratio[0], rtol=1e-9)


def test_a_corner_beyond_the_cutoff_is_a_little_below_it_and_none_other_moves():
    assert_allclose(like(B2, {"corner": 300e6}).spectrum.corner, 125e6 * np.exp(-0.05))
    near = like(B2, {"corner": 124.9e6})
    assert near.spectrum.corner == 124.9e6
    assert like(near, {"slope": -3.0}).spectrum.corner == 124.9e6
