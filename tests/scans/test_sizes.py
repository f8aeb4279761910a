"""Scans of several sizes of one surface: moments by area, one spectrum, and sizes that contradict each other."""

import dataclasses
import functools

import numpy as np
import pytest
from drawn_scans import grid, truth
from published import SPACING, SURFACES

from stiction.scans.estimate import Settings, estimate, inspect
from stiction.scans.flags import UNLIKELY
from stiction.scans.periodogram import Rings, in_order
from stiction.scans.scan import Scan
from stiction.streams import stream

SEED = 2
B2 = SURFACES["B2"]


@functools.cache
def drawn(side, every, count, address=""):
    """Scans of B2: ``side`` [m], every so many points of its grid of 10 nm."""
    surface, name = B2.on(grid(side)), f"sizes {address}{1e6 * side:g} {every}"
    maps = (surface.draw(stream(1, name, k))[::every, ::every].astype(float) for k in range(count))
    return tuple(Scan(z, (side, side), f"{1e6 * side:g}um-{k}.spm") for k, z in enumerate(maps))


LARGE, MIDDLE, SMALL = drawn(10e-6, 4, 2), drawn(5e-6, 2, 3), drawn(1.5e-6, 1, 3)


@functools.cache
def of_all():
    return estimate((*SMALL, *LARGE, *MIDDLE), SEED, model_scans=8)


@functools.cache
def of_large():
    return estimate(LARGE, SEED, model_scans=8)


def test_the_truth_is_within_the_errors():
    found, fit = of_all(), of_all().inspection.fit
    errors = np.sqrt(np.diag(fit.covariance))
    assert np.all(np.abs(found.moments - truth("B2")) < 3.5 * found.errors)
    assert abs(np.log(fit.corner / B2.spectrum.corner)) < 3.5 * errors[1]
    assert abs(fit.slope - B2.spectrum.slope) < 3.5 * errors[2]


def test_small_scans_show_the_short_waves_that_large_ones_do_not():
    assert of_large().inspection.reach.end == pytest.approx(np.pi / (4 * SPACING))
    assert of_all().inspection.reach.end == pytest.approx(B2.spectrum.cutoff, abs=2 * np.pi / 1.5e-6), "a ring"
    slope = [found.inspection.fit.covariance[2, 2] for found in (of_large(), of_all())]
    assert slope[1] < slope[0] / 4
    assert of_all().summits[1] > 2 * of_large().summits[1], "summits are those of the finest scans"
    np.testing.assert_allclose(of_all().summits, of_all().model_summits, rtol=0.1)


@pytest.mark.slow
def test_moments_are_means_by_area_and_so_are_their_errors():
    inspection = of_all().inspection
    assert [maps.names[0] for maps in inspection.sizes] == ["10um-0.spm", "5um-0.spm", "1.5um-0.spm"]
    np.testing.assert_allclose(inspection.weights, np.array([200, 75]) / 275)
    expected = (200 * inspection.sizes[0].moments + 75 * inspection.sizes[1].moments) / 275
    np.testing.assert_allclose(inspection.moments, expected)
    alone = [estimate(scans, SEED, model_scans=8) for scans in (LARGE, MIDDLE)]
    large, middle, together, first = (one.errors / one.places[:3] for one in (*alone, of_all(), of_large()))
    expected = np.sqrt((200**2 * large**2 + 75**2 * middle**2) / 275**2)
    np.testing.assert_allclose(together, expected, rtol=0.1)
    assert np.all(together < first)
    assert inspection.areas == pytest.approx(275 / 200 * of_large().inspection.areas, rel=0.05)


def test_scans_without_plateau_count_for_the_spectrum_only():
    assert "scans of 1.5 x 1.5 µm show no plateau and count for the spectrum only" in of_all().flags
    alone = inspect(SMALL, Settings())
    assert alone.wavelengths < 4
    assert alone.counted == alone.sizes, "where no others show it"
    higher = tuple(dataclasses.replace(scan, heights=2 * scan.heights) for scan in SMALL)
    without, twice = (inspect((*LARGE, *scans), Settings()) for scans in (SMALL, higher))
    np.testing.assert_allclose(twice.moments, without.moments, rtol=1e-12)
    assert twice.fit.slope > without.fit.slope + 0.1


def test_the_order_of_the_files_has_no_effect():
    found = inspect((*LARGE, *MIDDLE, *SMALL), Settings())
    np.testing.assert_array_equal(found.moments, of_all().inspection.moments)
    assert found.fit.slope == of_all().inspection.fit.slope


def test_of_equal_sides_the_finer_scans_are_first_whatever_the_order_of_the_files():
    coarse = tuple(dataclasses.replace(scan, heights=scan.heights[::2, ::2]) for scan in MIDDLE)
    for scans in ((*coarse, *MIDDLE), (*MIDDLE, *coarse)):
        assert inspect(scans, Settings()).largest.frame.shape == MIDDLE[0].heights.shape


def test_directions_are_compared_where_aliases_of_the_large_scans_do_not_reach():
    errors = [found.sector_errors for found in (of_large(), of_all())]
    np.testing.assert_allclose(errors[1], errors[0], rtol=0.05, err_msg="equal numbers of waves")


@pytest.mark.slow
def test_sizes_that_contradict_each_other_are_named():
    assert np.all(of_all().agreement[1] > UNLIKELY)
    assert not any("differ" in flag or "times the spectrum" in flag for flag in of_all().flags)
    assert np.isnan(of_large().agreement[1]).all()
    higher = tuple(dataclasses.replace(scan, heights=1.25 * scan.heights) for scan in MIDDLE)
    flags = estimate((*LARGE, *higher), SEED, model_scans=8).flags
    assert "scans of 10 x 10 µm and of 5 x 5 µm differ in rms by more than their errors" in flags
    (ratio,) = (flag.split()[7] for flag in flags if "times the spectrum" in flag)
    assert float(ratio) == pytest.approx(1.25**2, rel=0.15)


def test_rings_of_several_spectra_are_in_order():
    first, second = (Rings(*(np.array(values, float) + k for k in range(4))) for values in ([1, 5], [3]))
    joined = in_order([first, second])
    np.testing.assert_array_equal(joined.wavenumber, [1, 3, 5])
    np.testing.assert_array_equal(joined.weight, [4, 6, 8])


@pytest.mark.nightly
def test_errors_cover_the_truth_as_often_as_they_say():
    found = [
        estimate((*drawn(6e-6, 4, 1, f"{k} "), *drawn(4e-6, 2, 1, f"{k} ")), SEED, model_scans=8) for k in range(40)
    ]
    deviation = np.array([(one.moments - truth("B2")) * one.places[:3] / one.errors for one in found])
    scatter = np.sqrt(np.mean(deviation**2, axis=0))
    assert np.all((scatter > 0.75) & (scatter < 1.3)), scatter
    fits = [one.inspection.fit for one in found]
    slopes = np.array([(fit.slope - B2.spectrum.slope) / np.sqrt(fit.covariance[2, 2]) for fit in fits])
    assert np.sqrt(np.mean(slopes**2)) < 1.3
    assert np.mean([likely < 0.01 for one in found for likely in one.agreement[1]]) < 0.06
