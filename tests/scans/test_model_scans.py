import dataclasses

import numpy as np
import pytest
from drawn_scans import truth
from published import SURFACES
from test_moments import CLOSED_FORM

from stiction.estimates import mean_with_error
from stiction.scans.levelling import Levelling, level
from stiction.scans.model_scans import ModelScans, SurfaceModel, draw_model_scans, summits_of_map
from stiction.scans.moments import moments, powers
from stiction.scans.scan import Frame
from stiction.streams import stream
from stiction.surface.summits import find_summits, radius_and_density

B2 = SURFACES["B2"]
FRAME = Frame((200, 200), (4e-6, 4e-6))
#: Eq. (7) ends at the Nyquist wave number of 20 nm, 157 rad/µm.
MODEL = SurfaceModel(B2.density, B2.spectrum, 1e-6, B2.rms, FRAME)


def streams(count, name="model"):
    return [stream(1, name, k) for k in range(count)]


def test_a_model_scan_has_points_rms_and_mean_of_the_surface():
    drawn = np.array([MODEL.draw(rng) for rng in streams(60)])
    assert drawn.shape == (60, 200, 200)
    mean, error = mean_with_error(drawn.mean(axis=(1, 2)))
    assert abs(mean) < 4 * error
    square, error = mean_with_error(np.mean(drawn**2, axis=(1, 2)))
    assert abs(square - B2.rms**2) < 4 * error
    np.testing.assert_array_equal(drawn[3], MODEL.draw(stream(1, "model", 3)))


def test_opposite_edges_of_a_model_scan_are_not_correlated():
    odd = dataclasses.replace(MODEL, frame=Frame((199, 199), (3.98e-6, 3.98e-6)))  # one point fewer than a fast FFT
    edges = np.array([odd.draw(rng)[[0, -1], ::10] for rng in streams(60)])
    product, error = mean_with_error(np.mean(edges[:, 0] * edges[:, 1], axis=1) / B2.rms**2)
    assert abs(product) < 4 * error
    assert error < 0.1


def test_pixels_that_are_not_square_hold_the_same_surface():
    frame = Frame((200, 100), (4e-6, 4e-6))
    oblong = dataclasses.replace(MODEL, frame=frame).draw(stream(1, "model", 0))
    square = MODEL.draw(stream(1, "model", 0))
    assert oblong.shape == (200, 100)
    np.testing.assert_array_equal(oblong[:150, :75], square[:150, ::2][:, :75])


def test_moments_and_their_covariance_are_those_of_the_density_and_the_size():
    np.testing.assert_allclose(MODEL.moments, truth("B2"), rtol=0, atol=1e-3)
    large = dataclasses.replace(MODEL, frame=Frame((500, 500), (10e-6, 10e-6)))
    np.testing.assert_allclose(np.sqrt(np.diag(large.covariance)), CLOSED_FORM["B2"][0], rtol=0.02)


def test_influence_of_the_raw_scan_has_no_mean_and_follows_the_moments():
    drawn = draw_model_scans(MODEL, Levelling("mean"), streams(60))
    mean, error = mean_with_error(drawn.influence)
    assert np.all(np.abs(mean) < 4 * error)
    found = moments(drawn.powers)
    for k in range(3):
        assert np.corrcoef(found[:, k], drawn.influence[:, k])[0, 1] > 0.9


@pytest.mark.parametrize("lines", ["none", "tilt"])
def test_the_bias_of_levelling_is_found_with_few_scans(lines):
    levelling = Levelling("plane", lines)
    many = [moments(powers(level(MODEL.draw(rng), levelling))) for rng in streams(120, "many")]
    expected, error = mean_with_error(np.array(many) - MODEL.moments)
    halves = [draw_model_scans(MODEL, levelling, streams(12, f"few{k}")).bias(MODEL.moments, 1) for k in range(6)]
    found, own = mean_with_error(halves)
    assert np.all(np.abs(found - expected) < 4 * np.hypot(error, own))
    if lines == "tilt":
        assert found[0] < -0.04
    # 12 scans without the influence functions would leave their scatter over the root of 12.
    raw = np.std(many, axis=0) / np.sqrt(12)
    assert np.all(np.std(halves, axis=0, ddof=1)[:2] < 0.85 * raw[:2])


def test_bias_of_scans_is_that_of_their_mean_powers():
    rng = stream(1, "powers")
    rows = ModelScans(
        powers=np.array([0.0, 1.0, 0.3, 4.0]) + 0.1 * rng.standard_normal((7, 4)),
        influence=rng.standard_normal((7, 3)),
        quantiles=np.empty((7, 49)),
        levelled_off=np.empty((7, 49)),
        summits=np.empty((7, 2)),
    )
    pairs = [slice(0, 2), slice(2, 4), slice(4, 6)]  # the seventh has no partner
    expected = [moments(rows.powers[p].mean(axis=0)) - rows.influence[p].mean(axis=0) for p in pairs]
    np.testing.assert_allclose(rows.bias(np.array([0.1, 0.2, 3.0]), 2), np.mean(expected, axis=0) - [0.1, 0.2, 3.0])


def test_bias_of_scans_taken_together_is_smaller_but_that_of_levelling_is_not():
    drawn = draw_model_scans(MODEL, Levelling("plane"), streams(48))
    one, four = drawn.bias(MODEL.moments, 1), drawn.bias(MODEL.moments, 4)
    assert abs(four[2]) < abs(one[2])
    tilted = draw_model_scans(MODEL, Levelling("plane", "bow"), streams(24))
    np.testing.assert_allclose(tilted.bias(MODEL.moments, 4)[0], tilted.bias(MODEL.moments, 1)[0], rtol=0.3)


@pytest.mark.slow
def test_the_error_of_the_bias_is_its_scatter_between_sets_of_model_scans():
    sets = [draw_model_scans(MODEL, Levelling("plane", "tilt"), streams(12, f"set{k}")) for k in range(40)]
    scatter = np.std([one.bias(MODEL.moments, 2) for one in sets], axis=0, ddof=1)
    errors = np.sqrt(np.mean([np.diag(one.bias_covariance) for one in sets], axis=0))
    # Single scans vary a bit more than the pairs of the bias do.
    assert np.all((scatter / errors > 0.6) & (scatter / errors < 1.25)), scatter / errors
    assert errors[0] < 0.7 * np.sqrt(MODEL.covariance[0, 0] / 12)


def test_levelling_changes_the_quantiles_by_what_is_levelled_off():
    drawn = draw_model_scans(MODEL, Levelling("plane", "tilt"), streams(40))
    raw = draw_model_scans(MODEL, Levelling("mean"), streams(40))
    np.testing.assert_allclose(drawn.quantiles - drawn.levelled_off, raw.quantiles, atol=1e-12)
    np.testing.assert_allclose(raw.levelled_off, 0, atol=1e-12)
    mean, error = mean_with_error(drawn.levelled_off)
    assert np.any(np.abs(mean) > 5 * error)


def test_quantiles_of_model_scans_are_those_of_the_density():
    drawn = draw_model_scans(MODEL, Levelling("mean"), streams(40))
    mean, error = mean_with_error(drawn.quantiles[:, 8:41:8])  # scores of -2, -1, 0, 1, 2
    expected = B2.density.quantile_of_normal(np.arange(-2.0, 3.0))
    # Standardising by the rms of the scan itself has a bias of the order of its variance, 0.04².
    np.testing.assert_allclose(mean, expected, rtol=0, atol=4 * error.max() + 0.01)


def test_summits_are_counted_per_area_where_pixels_are_square():
    z = MODEL.draw(stream(1, "model", 0))
    _, curvature, density = find_summits(z, 20e-9)
    np.testing.assert_allclose(
        radius_and_density(summits_of_map(z, FRAME)), [1 / curvature.mean(), density], rtol=1e-12
    )
    assert np.isnan(summits_of_map(z, Frame((200, 200), (4e-6, 4.1e-6)))).all()


def test_a_map_without_summits_has_none_of_them_and_no_radius():
    slope = np.add.outer(np.arange(40.0), np.arange(40.0))
    found = summits_of_map(slope, Frame((40, 40), (1e-6, 1e-6)))
    np.testing.assert_array_equal(found, [0, 0])
    assert np.isnan(radius_and_density(found)).all()


@pytest.mark.parametrize(("side", "pixel"), [(4e-6, 20e-9), (20e-6, 5e-9)])
def test_the_transforms_hold_the_whole_correlation(side, pixel):
    points = round(side / pixel)
    wide = dataclasses.replace(MODEL, frame=Frame((points, points), (side, side)))
    period = 2 * np.pi / wide.underlying.wavenumber[1]
    least = max(8 * MODEL.correlation, 512 * pixel)
    assert least <= period * (1 + 1e-9) < 1.1 * least
    # 16 wavelengths of the corner give about as many wave numbers on the plateau.
    assert np.sum(wide.underlying.wavenumber < B2.spectrum.corner) >= 15
