"""Stages of measured surfaces: from files to the heights and the spectrum that surfaces are drawn with."""

import dataclasses
import warnings
from functools import cache

import numpy as np
import pytest
import xarray as xr
from drawn_scans import published, truth
from numpy.testing import assert_allclose, assert_array_equal
from published import SURFACES
from written_scans import SIDE, scans_of, write

from stiction.analysis.shifts import ORDERS
from stiction.errors import ScanError
from stiction.scans import estimate as evaluation
from stiction.scans.histogram import histogram, histogram_errors
from stiction.scans.moments import mode_covariance
from stiction.scans.quantiles import Feasible
from stiction.scans.reading import ScanFile, Source
from stiction.stages.surfaces import estimate, parameters, scan, surface_flags
from stiction.stages.surfaces import heights as stage_heights
from stiction.stages.surfaces import measured_heights as heights
from stiction.stages.surfaces import measured_spectrum as spectrum
from stiction.stages.surfaces import spectrum as stage_spectrum
from stiction.stages.surfaces.spectrum import SpectrumUse
from stiction.streams import stream
from stiction.surface.spectrum import CutoffSelfAffine, TabulatedSpectrum

B2 = SURFACES["B2"]
SETTINGS = estimate.Settings(3, evaluation.Settings(), 8)
USE = SpectrumUse("Etched", 1.5e-6, 1e-6)


def dataset_of(drawn, notes=()):
    """Dataset of stage scan of a scan of 5 µm."""
    return scan.layout(ScanFile(drawn, "Height", "nm", tuple(notes)))


@cache
def scans():
    return [dataset_of(drawn) for drawn in published("B2", SIDE, 2)]


def estimated(settings=SETTINGS, found=None, surface="Etched"):
    """Dataset of stage estimate, without its warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return estimate.compute(found or scans(), surface, settings)


@cache
def b2():
    return estimated()


@cache
def object_of_b2():
    """The estimate as an object, from the same scans and streams."""
    maps = [scan.scan_of(dataset) for dataset in scans()]
    return evaluation.estimate(maps, 3, SETTINGS.evaluation, "Etched", 8)


# Scan


def test_a_scan_keeps_heights_size_name_and_what_is_undefined(tmp_path, through_a_file):
    z = published("B2", SIDE, 1)[0].heights + 4e-6
    z[3:6, 7] = np.nan
    path = write(tmp_path / "etched.gwy", z)
    with pytest.warns(UserWarning, match="etched.gwy: 3 points .* under a mask in the file count as undefined"):
        computed = scan.compute(path, scan.Settings("etched.gwy", "0"))
    found = through_a_file(computed)
    back = scan.scan_of(found)
    assert (back.size, back.name) == (pytest.approx((SIDE, SIDE)), "etched.gwy")
    assert_array_equal(back.defined, np.isfinite(z))
    # Single precision of heights without their mean, which may be far larger.
    assert_allclose(back.heights, z - np.nanmean(z), rtol=0, atol=1e-6 * B2.rms, equal_nan=True)
    assert (found.elevation.dtype, found.elevation.dims) == (np.float32, ("fast", "slow"))
    assert_allclose(np.diff(found.fast), SIDE / len(z))
    assert str(found.unit.item()) == "m"


def test_a_scan_is_read_as_the_configuration_says(tmp_path):
    z = np.outer(np.arange(1.0, 41), np.linspace(0.5, 1, 64)) ** 2
    np.save(tmp_path / "z.npy", z)
    source = Source(fast_axis="y", size=(4e-6, 6.4e-6), height_unit="nm")
    found = scan.scan_of(scan.compute(tmp_path / "z.npy", scan.Settings("z.npy", "0", source)))
    assert_allclose(found.heights, 1e-9 * (z - z.mean()).T, rtol=1e-6, atol=1e-15)
    assert found.size == pytest.approx((6.4e-6, 4e-6))


def test_notes_on_a_file_are_warnings_and_are_kept(tmp_path, through_a_file, monkeypatch):
    notes = ("a.spm: channel Height#1 was read; the file also has Height#2", "a.spm: levelled already")
    drawn = published("B2", SIDE, 1)[0]
    monkeypatch.setattr(scan.reading, "read", lambda *_: ScanFile(drawn, "Height#1", "nm", notes))
    with pytest.warns(UserWarning, match="^a.spm: ") as caught:
        found = through_a_file(scan.compute(tmp_path / "a.spm", scan.Settings("a.spm", "0")))
    assert len(caught) == 2
    assert scan.notes(found) == notes
    assert scan.notes(scans()[0]) == ()
    flags = surface_flags.flags(estimate.layout(object_of_b2(), scan.notes(found)))
    assert flags == [*object_of_b2().flags, *notes]


# Estimate


def test_an_estimate_comes_back_from_its_dataset(through_a_file):
    found, expected = through_a_file(b2()), object_of_b2()
    assert_array_equal(found.moments, expected.moments)
    assert_array_equal(found.covariance, expected.covariance)
    assert_array_equal(found.raw_moments, expected.inspection.moments)
    assert found.scan_moments.shape == (2, 3)
    assert estimate.files(found) == ("B2-scan-0.spm", "B2-scan-1.spm")
    assert surface_flags.flags(found) == list(expected.flags)
    fit, of_places = (
        estimate.fit(found),
        dataclasses.replace(expected.inspection.fit, covariance=expected.fit_covariance),
    )
    for field in dataclasses.fields(fit):
        assert_array_equal(getattr(fit, field.name), getattr(of_places, field.name))
    assert estimate.reach(found) == expected.inspection.reach
    for name in ("wavenumber", "density", "modes", "weight"):
        assert_array_equal(getattr(estimate.rings(found), name), getattr(expected.inspection.rings, name))
    ((count, frame),) = estimate.frames(found)
    assert (count, frame.shape) == (len(expected.inspection.names), expected.inspection.largest.frame.shape)
    assert_allclose(frame.size, expected.inspection.largest.frame.size, rtol=1e-12)
    assert_array_equal(found.sector_errors, expected.sector_errors)
    levelled = expected.inspection.largest.levelled
    assert_allclose(found.histogram, histogram(levelled, expected.inspection.quantiles, expected.quantiles))
    assert estimate.density(found, "moments") == expected.density("moments")
    assert_array_equal(estimate.density(found, "measured").heights, expected.density("measured").heights)
    for psd in ("fitted", "tabulated"):
        zeta = np.linspace(0, 1.3e8, 50)
        assert_array_equal(estimate.spectrum(found, psd, 1.2e8)(zeta), expected.spectrum(psd, 1.2e8)(zeta))
    assert float(found.areas) == expected.inspection.areas
    assert_array_equal(found.line_jump, expected.line_jump[::-1])


def test_an_estimate_states_how_well_scans_of_one_size_and_sizes_agree():
    stated = np.arange(12.0).reshape(2, 2, 3)
    found = estimate.layout(dataclasses.replace(object_of_b2(), homogeneity=stated[0], agreement=stated[1]))
    for name, (chi2, p) in zip(("homogeneity", "agreement"), stated, strict=True):
        assert_array_equal([found[f"{name}_chi2"], found[f"{name}_p"]], [chi2, p])


def test_an_estimate_of_a_published_surface_is_within_its_errors():
    error = np.sqrt(np.diag(b2().covariance))
    assert np.all(np.abs(b2().moments - truth("B2")) < 4 * error)
    statistics = estimate.statistics(b2())
    assert statistics["rms_nm"] == pytest.approx(1e9 * B2.rms, rel=4 * error[0])
    assert statistics["skewness"] == float(b2().moments[1])
    assert statistics["mean_summit_radius_um"] == pytest.approx(1e6 * float(b2().summits.sel(summit="radius")))
    assert statistics["summit_density_per_um2"] == pytest.approx(1e-12 * float(b2().summits.sel(summit="density")))


def test_limits_of_an_estimate_are_warnings():
    (sentence,) = (flag for flag in surface_flags.flags(b2()) if flag.startswith("only 9"))
    with pytest.warns(UserWarning, match="^surface Etched: ") as caught:
        estimate.compute(scans(), "Etched", SETTINGS)
    assert {str(one.message) for one in caught} == {f"surface Etched: {flag}" for flag in surface_flags.flags(b2())}
    assert f"surface Etched: {sentence}" in {str(one.message) for one in caught}


@pytest.mark.slow
def test_random_numbers_depend_on_seed_and_surface_and_not_on_the_names_of_files():
    moments = b2().moments.values
    assert_array_equal(estimated(dataclasses.replace(SETTINGS, files=("x.spm",))).moments, moments)
    assert np.all(estimated(surface="Other").moments != moments)
    assert np.all(estimated(dataclasses.replace(SETTINGS, seed=4)).moments != moments)


def test_an_estimate_has_the_model_scans_that_are_asked_for(monkeypatch):
    asked = []
    monkeypatch.setattr(evaluation, "estimate", lambda *given: asked.extend(given[1:]) or object_of_b2())
    estimated(dataclasses.replace(SETTINGS, seed=5, model_scans=17), surface="Other")
    assert asked == [5, SETTINGS.evaluation, "Other", 17]


@pytest.mark.slow
def test_the_band_near_the_slow_axis_holds_jumps_of_lines():
    z = published("B2", SIDE, 1)[0]
    jumps = 0.3 * B2.rms * stream(1, "lines").standard_normal(z.heights.shape[1])
    jumping = estimated(found=[dataset_of(dataclasses.replace(z, heights=z.heights + jumps))])
    clean = estimated(found=[dataset_of(z)])
    far = jumping.slow_wavenumber.values > 5e7
    assert np.median(jumping.slow_density.values[far] / clean.slow_density.values[far]) > 20
    inside = clean.wavenumber.values < 5e7
    assert_allclose(jumping.density[inside], clean.density[inside], rtol=0.05)


def test_errors_of_modes_and_moments_agree_on_the_rms():
    assert float(b2().mode_covariance[0, 0]) == float(b2().covariance[0, 0])


def test_errors_of_two_scans_are_those_of_one_over_the_root_of_two():
    found, model = b2(), object_of_b2().model
    assert_allclose(np.sqrt(2) * found.histogram_error, histogram_errors(model), rtol=1e-9)
    rms, *shape = found.places.values[:3]
    grown = np.array([rms, *[max(shape)] * len(ORDERS)])
    assert np.all(grown > 1), "by the difference between places"
    modes = mode_covariance(model.translation, model.overlaps, ORDERS) * np.outer(grown, grown)
    assert_allclose(2 * found.mode_covariance.values[1:, 1:], modes[1:, 1:], rtol=1e-9, atol=1e-15)
    assert_allclose(2 * found.mode_covariance.values[0, 1:], modes[0, 1:], rtol=1e-9)


# Heights


def test_heights_have_the_density_of_the_estimated_moments(through_a_file):
    found = through_a_file(heights.compute(b2(), "Etched", "moments"))
    assert stage_heights.density(found, "NG") == estimate.density(b2(), "moments")
    moments = stage_heights.moments(found)
    assert_allclose([np.log(moments.rms), moments.skewness, moments.kurtosis], b2().moments, rtol=1e-12)
    assert stage_heights.measured_moments(found) == (moments.skewness, moments.kurtosis, 0.0)
    assert stage_heights.substitution(found) == ""


def infeasible(feasible):
    """Estimate with a kurtosis that no maximum-entropy density has."""
    moments = np.array([np.log(B2.rms), -0.1, 3.3])
    return estimate.layout(dataclasses.replace(object_of_b2(), moments=moments, feasible=feasible))


def test_moments_near_a_density_are_replaced_and_both_are_stated():
    nearest = Feasible(None, -0.3, 3.2, 1.5)
    found = heights.compute(infeasible(nearest), "Etched", "moments")
    assert stage_heights.moments(found).kurtosis == 3.2
    assert stage_heights.measured_moments(found) == (-0.1, 3.3, 1.5)
    assert "skewness -0.1 and kurtosis 3.3" in stage_heights.substitution(found)


def test_without_a_density_of_the_moments_the_error_names_surface_files_and_remedy():
    message = "surfaces.Etched.heights is moments, but no .* skewness -0.1 and kurtosis 3.3 of B2-scan-0.spm, B2-scan-1"
    with pytest.raises(ValueError, match=message + ".*; heights: measured does not need one"):
        heights.compute(infeasible(None), "Etched", "moments")
    found = heights.compute(infeasible(None), "Etched", "measured")
    assert stage_heights.measured_moments(found).distance == 0


def test_measured_heights_are_the_quantiles_of_the_scans(through_a_file):
    found = through_a_file(heights.compute(b2(), "Etched", "measured"))
    density = stage_heights.density(found, "NG")
    inside = np.abs(b2().score) <= density.scores[-1]
    assert_allclose(density.quantile_of_normal(density.scores), b2()["quantile"][inside], atol=0.02)
    assert_allclose(found.density, density(found.height.values))
    assert stage_heights.density(found, "G").multipliers == (0.0, 0.5, 0.0, 0.0)
    # The tails beyond the scan are straight lines: skewness and kurtosis are near those of the scans.
    moments = stage_heights.moments(found)
    assert moments.rms == estimate.rms(b2())
    assert_allclose([moments.skewness, moments.kurtosis], b2().raw_moments[1:], rtol=0.1)


# Spectrum


def spectrum_with(found=None, use=USE, spacing=10e-9, **choices):
    """Dataset of the spectrum of B2, fitted and cut unless chosen otherwise."""
    found = b2() if found is None else found
    drawn = heights.compute(found, "Etched", choices.pop("heights", "moments"))
    return spectrum.compute(
        found, drawn, spectrum.Settings(**{"psd": "fitted", "beyond": "cut"} | choices, spacing=spacing, use=use)
    )


def test_a_fitted_spectrum_ends_where_that_of_the_scans_does_or_at_the_nyquist_number_of_the_grid(through_a_file):
    cut, continued = through_a_file(spectrum_with()), spectrum_with(beyond="continued")
    assert parameters.spectrum_of(cut) == estimate.fit(b2()).spectrum(estimate.reach(b2()).end)
    assert parameters.spectrum_of(cut).cutoff == pytest.approx(B2.spectrum.cutoff, rel=0.01)
    assert parameters.spectrum_of(continued) == estimate.fit(b2()).spectrum(np.pi / 10e-9)
    assert str(cut["flags"].item()) == ""
    assert isinstance(stage_spectrum.underlying(cut, "G"), CutoffSelfAffine)


def test_a_tabulated_spectrum_is_that_of_the_rings(through_a_file):
    found = through_a_file(spectrum_with(psd="tabulated"))
    table = parameters.spectrum_of(found)
    assert isinstance(table, TabulatedSpectrum)
    rings = estimate.rings(b2())
    inside = (rings.wavenumber > 8e6) & (rings.wavenumber < 70e6)
    assert_allclose(table(rings.wavenumber[inside]), rings.density[inside], rtol=0.05)
    zeta = found.wavenumber.values
    assert_allclose(2 * np.pi * np.trapezoid(zeta * found.target, zeta), 1, rtol=0.05)
    assert stage_spectrum.underlying(found, "G").cutoff == table.cutoff == estimate.reach(b2()).end


@pytest.mark.parametrize("choice", ["moments", "measured"])
def test_the_field_behind_measured_heights_gives_the_spectrum_that_was_asked_for(choice):
    found = spectrum_with(heights=choice)
    zeta = found.wavenumber.values
    inside = (zeta > 0) & (zeta < 80e6)
    assert_allclose(stage_spectrum.achieved(found, zeta[inside]), found.target[inside], rtol=0.05)


def test_a_grid_that_cuts_the_spectrum_off_is_a_warning():
    with pytest.warns(
        UserWarning, match="surface Etched: the spectrum ends at the Nyquist wave number of the grid, 104.7 ra"
    ):
        found = spectrum_with(spacing=30e-9)
    assert float(found.cutoff) == pytest.approx(np.pi / 30e-9)
    (sentence,) = surface_flags.flags(found)
    assert sentence.endswith("before that of the scans, 125.1 rad/µm; a finer sampling.spacing_nm keeps more")
    assert surface_flags.flags(spectrum_with()) == []


@pytest.mark.filterwarnings("ignore:surface Etched")
@pytest.mark.parametrize("psd", ["fitted", "tabulated"])
@pytest.mark.parametrize(
    ("key", "words"), [("strip_length", "strips of 0.3 µm count as"), ("margin", "of 0.3 µm makes")]
)
def test_strips_and_margins_within_the_correlation_length_are_named(psd, key, words):
    found = spectrum_with(use=dataclasses.replace(USE, **{key: 0.3e-6}), psd=psd)
    (sentence,) = surface_flags.flags(found)
    assert sentence.startswith("heights are correlated over 0.")
    assert words in sentence
    assert "unsafe" not in sentence


@pytest.mark.filterwarnings("ignore:surface Etched")
def test_strips_that_long_waves_raise_as_a_whole_repeat_laws_under_devices():
    found = spectrum_with(use=dataclasses.replace(USE, strip_length=0.05e-6))
    (sentence,) = surface_flags.flags(found)
    assert "strips of 0.05 µm count as independent under the beams of pairs" in sentence
    assert "under devices strips repeat the law of their neighbour" in sentence
    assert sentence.endswith("the safe side")
    (limit,) = surface_flags.limits_of({"estimates": {"E": b2()}, "spectra": {"E": found}})["E"][-1:]
    assert not limit.forbids


@pytest.mark.filterwarnings("ignore:surface Etched")
def test_heights_that_never_become_uncorrelated_are_named_for_strips_and_margins(monkeypatch):
    wave = TabulatedSpectrum(np.array([0.99e7, 1e7, 1.01e7]), np.array([0.0, 1e-32, 0.0]), 1.01e7)
    monkeypatch.setattr(spectrum.stage_estimate, "spectrum", lambda *_: wave)
    monkeypatch.setattr(spectrum.stage_spectrum, "on_grid", lambda *_: xr.Dataset())
    strips, margin = surface_flags.flags(spectrum_with())
    assert strips.startswith("heights are correlated over 3.7 µm; strips of 1.5 µm count as independent")
    assert margin.startswith("heights are correlated over 3.7 µm, so that a margin of 1 µm makes opposite edges")


def test_a_spectrum_that_cannot_be_drawn_is_refused_with_surface_and_files():
    coarse = b2().assign(corner=((), 2e8))
    with pytest.raises(
        ValueError, match="surface Etched from B2-scan-0.spm, .* cannot be drawn: need 0 < corner < cut"
    ):
        spectrum_with(found=coarse)


def test_a_scan_that_cannot_be_used_is_refused():
    whole = published("B2", SIDE, 1)[0]
    small = dataset_of(dataclasses.replace(whole, heights=whole.heights[:40, :40], size=(0.8e-6, 0.8e-6)))
    with pytest.raises(ScanError):
        estimated(found=[small])


@pytest.mark.slow
def test_files_of_equal_content_in_two_formats_give_the_same_estimate(tmp_path):
    z = published("B2", SIDE, 1)[0].heights
    first, second = (
        estimated(found=[scan.compute(write(tmp_path / f"a.{ending}", z), scan.Settings("a", "0"))])
        for ending in ("gwy", "x3p")
    )
    assert_array_equal(first.moments, second.moments)


def test_scans_written_to_files_are_the_scans_that_were_drawn(tmp_path):
    for path, drawn in zip(scans_of(tmp_path, count=2), published("B2", SIDE, 2), strict=True):
        found = scan.scan_of(scan.compute(path, scan.Settings(path.name, "0")))
        assert_allclose(found.heights, drawn.heights - drawn.heights.mean(), rtol=0, atol=1e-6 * B2.rms)
