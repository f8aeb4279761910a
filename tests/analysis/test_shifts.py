"""Both values of a quantity are around that of the surface, and nothing else of the surface changes."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from published import SURFACES
from scipy.special import ndtr

from stiction.analysis.shifts import ORDERS, STEPS, Description, bracketed, moved, value_of, with_value
from stiction.models import MODE_QUANTITIES, MOMENT_QUANTITIES, SPECTRUM_QUANTITIES
from stiction.scans.quantiles import SCORES
from stiction.surface.empirical import MeasuredDensity
from stiction.surface.feasible import is_feasible, largest_kurtosis, least_kurtosis
from stiction.surface.spectrum import CutoffSelfAffine, TabulatedSpectrum

B2 = Description(3.4e-9, -0.76, 3.9, SURFACES["B2"].spectrum)
GAUSSIAN = replace(B2, skewness=0.0, kurtosis=3.0)


def quantities(surface):
    """All quantities of a surface, in the units of their steps."""
    return {
        "rms": np.log(surface.rms),
        "skewness": surface.skewness,
        "kurtosis": surface.kurtosis,
        "corner": np.log(surface.spectrum.corner),
        "slope": surface.spectrum.slope,
    }


@pytest.mark.parametrize("quantity", MOMENT_QUANTITIES + SPECTRUM_QUANTITIES)
@pytest.mark.parametrize("surface", [B2, GAUSSIAN], ids=["skewed", "Gaussian"])
def test_one_quantity_differs_by_the_stated_difference_and_no_other(surface, quantity):
    (less, more), difference = bracketed(surface, quantity)
    change = {name: at - quantities(less)[name] for name, at in quantities(more).items()}
    assert_allclose(change.pop(quantity), difference, rtol=1e-9)
    assert difference == 2 * STEPS[quantity]
    assert_allclose(list(change.values()), 0, atol=1e-12)
    assert more.spectrum.cutoff == less.spectrum.cutoff == surface.spectrum.cutoff


@pytest.mark.parametrize("quantity", MOMENT_QUANTITIES + SPECTRUM_QUANTITIES)
def test_both_values_are_around_that_of_the_surface(quantity):
    both, _ = bracketed(B2, quantity)
    assert_allclose(np.mean([quantities(one)[quantity] for one in both]), quantities(B2)[quantity], rtol=1e-9)


@pytest.mark.parametrize("quantity", MOMENT_QUANTITIES + SPECTRUM_QUANTITIES)
def test_a_surface_that_errs_by_a_step_is_one_of_both(quantity):
    both, _ = bracketed(B2, quantity)
    erring = [moved(B2, {quantity: sign * STEPS[quantity]}) for sign in (-1, 1)]
    assert_allclose(*([list(quantities(each).values()) for each in surfaces] for surfaces in (erring, both)), rtol=1e-9)


@pytest.mark.parametrize("surface", [GAUSSIAN, replace(B2, skewness=0.3, kurtosis=3.24)], ids=["Gaussian", "skewed"])
@pytest.mark.parametrize("quantity", MOMENT_QUANTITIES)
def test_at_the_border_of_the_feasible_moments_both_values_have_a_density(surface, quantity):
    both, _ = bracketed(surface, quantity)
    assert all(is_feasible(one.skewness, one.kurtosis) for one in both)
    assert max(one.kurtosis for one in both) <= surface.kurtosis + STEPS["kurtosis"]
    assert not is_feasible(surface.skewness, surface.kurtosis + STEPS["kurtosis"])


@pytest.mark.parametrize("quantity", SPECTRUM_QUANTITIES)
def test_at_the_limits_of_eq_7_both_values_have_a_spectrum(quantity):
    steep = CutoffSelfAffine(1e-33, 0.999e-33, 0.99e8, 1e8)
    flat = CutoffSelfAffine(1e-33, 1e-33, 0.5e8, 1e8)
    for spectrum in (steep, flat):
        (less, more), difference = bracketed(replace(B2, spectrum=spectrum), quantity)
        assert_allclose(quantities(more)[quantity] - quantities(less)[quantity], difference, rtol=1e-9)


# Measured densities and tables

INNER = SCORES[np.abs(SCORES) <= 2.5]
FORM = MeasuredDensity(INNER, SURFACES["B2"].density.quantile_of_normal(INNER))
MEASURED = replace(B2, form=FORM)


def test_quantities_are_those_of_the_density_and_of_the_spectrum():
    assert B2.quantities == MOMENT_QUANTITIES + SPECTRUM_QUANTITIES
    assert MEASURED.quantities == MODE_QUANTITIES + SPECTRUM_QUANTITIES
    assert {*B2.quantities, *MEASURED.quantities} == set(STEPS)


def hermite(order, u):
    """Orthonormal Hermite polynomial by its recursion."""
    previous, current = np.zeros_like(u), np.ones_like(u)
    for k in range(1, order + 1):
        previous, current = current, (u * current - np.sqrt(k - 1) * previous) / np.sqrt(k)
    return current


@pytest.mark.parametrize(("quantity", "order"), list(zip(MODE_QUANTITIES[1:], ORDERS, strict=True)))
def test_a_mode_is_a_mean_of_its_hermite_polynomial(quantity, order):
    # Scores of the density phi (1 + x h_k) have the mean x of h_k, and of no other polynomial.
    mean = STEPS[quantity]
    u = np.linspace(-8, 8, 200_001)
    share = np.cumsum(np.exp(-(u**2) / 2) * (1 + mean * hermite(order, u)))
    scores = np.interp(ndtr(SCORES), share / share[-1], u)
    inside = np.abs(SCORES) <= 2
    (less, more), _ = bracketed(MEASURED, quantity)
    found = np.diff([one.form.heights for one in (less, more)], axis=0)[0][np.abs(INNER) <= 2] / 2
    expected = (FORM.quantile_of_normal(scores) - FORM.quantile_of_normal(SCORES))[inside]
    # Heights of a form are up to scale and mean.
    basis = np.column_stack([np.ones(inside.sum()), FORM.quantile_of_normal(SCORES[inside])])
    found, expected = (part - basis @ np.linalg.lstsq(basis, part)[0] for part in (found, expected))
    assert np.abs(found - expected).max() < 0.1 * np.abs(expected).max() + 2 * mean**2  # second order


@pytest.mark.parametrize("quantity", MODE_QUANTITIES[1:])
def test_a_mode_changes_the_form_alone_and_is_around_it(quantity):
    (less, more), difference = bracketed(MEASURED, quantity)
    assert difference == 2 * STEPS[quantity]
    for one in (less, more):
        assert replace(one, form=FORM) == MEASURED
    middle = (less.form.heights + more.form.heights) / 2
    apart = np.abs(more.form.heights - less.form.heights).max()
    assert np.abs(middle - FORM.quantile_of_normal(INNER)).max() < 0.05 * apart


@pytest.mark.parametrize("quantity", SPECTRUM_QUANTITIES)
def test_a_table_is_bent_like_eq_7(quantity):
    known = np.linspace(0, B2.spectrum.cutoff, 2000)
    table = TabulatedSpectrum(known, B2.spectrum(known), B2.spectrum.cutoff)
    both, difference = bracketed(replace(B2, spectrum=table), quantity)
    zeta = np.array([1e6, 40e6, 100e6])
    ratio = both[1].spectrum(zeta) / both[0].spectrum(zeta)
    assert ratio[0] == pytest.approx(1)
    if quantity == "corner":
        np.testing.assert_allclose(ratio[1:], np.exp(-B2.spectrum.slope * difference), rtol=0.01)
    else:
        np.testing.assert_allclose(ratio[2] / ratio[1], 2.5**difference, rtol=0.01)
    assert {one.spectrum.cutoff for one in both} == {table.cutoff}


@pytest.mark.parametrize(("quantity", "value"), [("rms", 8e-9), ("skewness", -0.2), ("corner", 2e7)])
def test_another_value_of_a_quantity_leaves_the_form_of_the_surface(quantity, value):
    changed = with_value(B2, quantity, value)
    assert_allclose(value_of(changed, quantity), value, rtol=1e-12)
    kept = set(quantities(B2)) - {quantity} - ({"kurtosis"} if quantity == "skewness" else set())
    assert_allclose([quantities(changed)[name] for name in kept], [quantities(B2)[name] for name in kept], rtol=1e-12)
    assert changed.spectrum.cutoff == B2.spectrum.cutoff
    assert is_feasible(changed.skewness, changed.kurtosis)
    assert with_value(B2, quantity, value_of(B2, quantity)).rms == B2.rms


def test_a_skewness_without_the_kurtosis_has_the_largest_feasible_one():
    assert with_value(B2, "skewness", -1.2).kurtosis == B2.kurtosis
    assert with_value(B2, "skewness", 0.0).kurtosis == pytest.approx(3, abs=1e-4)


@pytest.mark.parametrize("quantity", ["skewness", "kurtosis"])
@pytest.mark.parametrize(("skewness", "above"), [(0.288, 0.115), (-1.5, 0.06), (0.0, 0.5)])
def test_both_sides_of_heights_with_nearly_two_levels_have_a_density(quantity, skewness, above):
    surface = Description(1e-9, skewness, skewness**2 + 1 + above, None)
    (less, more), difference = bracketed(surface, quantity)
    assert is_feasible(less.skewness, less.kurtosis)
    assert is_feasible(more.skewness, more.kurtosis)
    assert_allclose(getattr(more, quantity) - getattr(less, quantity), difference, rtol=1e-9)


# Large uncertainties


@pytest.mark.parametrize("quantity", MOMENT_QUANTITIES + SPECTRUM_QUANTITIES)
@pytest.mark.parametrize("deviation", [0.0, 0.03, 0.3, 1.0, 3.0])
def test_a_large_uncertainty_is_the_step_as_far_as_surfaces_go_on_both_sides(quantity, deviation):
    rng, far = np.random.default_rng(4), 0
    for _ in range(20):
        skewness, cutoff = rng.uniform(-1, 0), 1.25e8
        low, high = least_kurtosis(skewness), largest_kurtosis(abs(skewness))
        kurtosis = low + rng.uniform(0.2, 0.9) * (high - low)
        spectrum = CutoffSelfAffine(1e-32, 1e-32 * 10 ** rng.uniform(-6, -1), cutoff * rng.uniform(0.05, 0.5), cutoff)
        surface = replace(B2, skewness=skewness, kurtosis=kurtosis, spectrum=spectrum)
        (less, more), difference = bracketed(surface, quantity, deviation)
        assert STEPS[quantity] <= difference / 2 <= max(STEPS[quantity], deviation)
        ends = [quantities(one)[quantity] for one in (less, more)]
        assert_allclose(np.diff(ends)[0], difference, rtol=1e-6)
        if difference > 2 * STEPS[quantity]:
            far += 1
            assert_allclose(np.mean(ends), quantities(surface)[quantity], rtol=1e-6)
            assert all(is_feasible(one.skewness, one.kurtosis) for one in (less, more))
    assert bool(far) == (deviation > STEPS[quantity] and quantity != "skewness")
