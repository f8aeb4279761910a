import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from published import SURFACES
from standard_errors import ALLOWED

from stiction.analysis import sensitivity
from stiction.contact.asperity import MaugisTable, reduced_modulus
from stiction.contact.forcelaw import humid_curves, parametrise
from stiction.contact.meniscus import film
from stiction.contact.pair import SurfacePair, contacts_of_samples
from stiction.contact.vanderwaals import attraction
from stiction.streams import stream
from stiction.surface.field import RoughSurface, StripGrid
from stiction.surface.maxent import solve
from stiction.surface.translation import Translation, underlying_spectrum

EXPONENTS = st.floats(-9, 9).filter(lambda n: abs(n) > 1e-3)
B2, SUB1 = SURFACES["B2"], SURFACES["Sub1"]
#: Pieces of surface large enough to stick and small enough for a test.
GRID = StripGrid(1.5e-6, 6e-6, 10e-9, 1e-6)


@given(EXPONENTS, st.floats(0.01, 0.3), st.floats(1e-9, 1e9))
def test_the_sensitivity_of_a_power_law_is_its_exponent(exponent, step, moment):
    at = sensitivity.shifted(moment, step)
    values = [3.7 * x**exponent for x in np.divide(at, moment)]
    assert_allclose(sensitivity.normalised_slope(values, at), exponent, rtol=1e-9)


@given(st.floats(0.01, 0.3))
def test_more_of_a_negative_moment_is_closer_to_zero(step):
    low, high = sensitivity.shifted(-0.76, step)
    assert low < -0.76 < high < 0
    falling = sensitivity.normalised_slope((2.0, 1.0), (low, high))
    assert falling < 0
    assert_allclose(falling, sensitivity.normalised_slope((1.0, 2.0), sensitivity.shifted(0.76, step)) * -1)


def test_a_moment_that_may_be_zero_has_no_normalised_sensitivity():
    with pytest.raises(ValueError, match="between -0.01 and 0.01"):
        sensitivity.normalised_slope((1.0, 2.0), (-0.01, 0.01))


def test_mean_and_standard_deviation_have_separate_sensitivities():
    at, rng = (0.95, 1.05), np.random.default_rng(0)
    noise = rng.standard_normal(500) / 10
    energies = [x**-6 + x**2 * (noise - noise.mean()) for x in at]
    slopes, errors = sensitivity.energy_sensitivity(energies, at)
    assert_allclose(slopes, (-6, 2), rtol=1e-9)
    # The noise is the same at both values: its standard deviation is a power law without error, its mean is not.
    assert errors[1] < 1e-9 < errors[0]


def synthetic(rng, shared):
    """Energies of 400 samples at two values of a moment: e ~ x⁻⁵ times lognormal noise, shared or not."""
    noises = np.exp(0.4 * rng.standard_normal((2, 400)))
    return [x**-5 * noises[0 if shared else k] for k, x in enumerate((0.95, 1.05))]


def test_standard_errors_are_the_scatter_of_repeated_studies_and_common_random_numbers_reduce_it():
    at, found = (0.95, 1.05), {}
    for shared in (True, False):
        studies = [sensitivity.energy_sensitivity(synthetic(stream(1, k), shared), at) for k in range(60)]
        slopes, errors = np.array(studies)[:, :, 0].T
        spread = slopes.std(ddof=1)
        assert abs(slopes.mean() + 5) < ALLOWED * max(spread, 1e-12) / np.sqrt(60)
        # The relative standard error of a standard deviation of 60 values is 1/√118.
        assert spread == pytest.approx(errors.mean(), rel=ALLOWED / np.sqrt(118), abs=1e-9)
        found[shared] = spread
    assert found[True] < 0.01 * found[False]


def test_differences_to_either_side_enclose_the_slope_of_a_falling_convex_curve():
    at = sensitivity.shifted(-2.0, 0.1)
    curve = lambda x: np.exp(-3.0 * (x + 2.0))  # noqa: E731
    samples = np.linspace(0.5, 1.5, 40)
    differences, errors = sensitivity.one_sided([curve(x) * samples for x in at], curve(-2.0) * samples, at)
    # At x = -2, the normalised slope is 2 · (-3): a tenth more changes the curve by exp(-0.6) - 1.
    assert_allclose(differences, [(np.exp(0.6) - 1) / -0.1, (np.exp(-0.6) - 1) / 0.1])
    assert differences[0] < -6 < differences[1]
    assert (errors < 1e-9).all()


def test_errors_of_differences_are_the_scatter_of_repeated_studies():
    at, found = (0.9, 1.1), []
    for k in range(60):
        noises = np.exp(0.4 * stream(2, k).standard_normal((3, 400)))
        found.append(
            sensitivity.one_sided([x**-5 * noise for x, noise in zip(at, noises, strict=False)], noises[2], at)
        )
    differences, errors = np.array(found).swapaxes(0, 1)
    assert_allclose(differences.std(axis=0, ddof=1), errors.mean(axis=0), rtol=ALLOWED / np.sqrt(118))


def energies(moments, seeds):
    """Adhesion energies (m,) of a pair whose beam surface has other moments; one seed per sample."""
    rms, skewness, kurtosis = moments
    translation = Translation(solve(skewness, kurtosis))
    underlying = underlying_spectrum(B2.spectrum, translation, GRID.spacing)[0]
    solid = MaugisTable(reduced_modulus(164e9, 0.23), attraction("water"))
    pair = SurfacePair(RoughSurface(underlying, translation, rms, GRID), SUB1.on(GRID), 5e-11, asperity=solid)
    curves = contacts_of_samples([pair], lambda k: (stream(k, "beam"), stream(k, "substrate")), seeds)[0]
    starts = pair.distances.solid[0], pair.distances.bearing[0]
    return parametrise(*humid_curves(*curves, starts, pair.step, film(0.67, 300.0)), len(seeds))[0][:, 0]


@pytest.mark.slow
def test_rougher_and_more_peaked_surfaces_adhere_less_and_common_random_numbers_resolve_it():
    here, seeds = (B2.rms, B2.skewness, B2.kurtosis), range(24)
    for k in range(3):
        at = sensitivity.shifted(here[k], 0.05)
        low, high = (tuple(x if i == k else m for i, m in enumerate(here)) for x in at)
        slopes, errors = sensitivity.energy_sensitivity([energies(low, seeds), energies(high, seeds)], at)
        assert slopes[0] < -ALLOWED * errors[0]
        if k == 0:
            others = sensitivity.energy_sensitivity([energies(low, seeds), energies(high, range(100, 124))], at)
            assert errors[0] < 0.3 * others[1][0]
