"""Sheet and tables of measured surfaces show the numbers of their datasets."""

import warnings
from functools import cache

import numpy as np
import pytest
import xarray as xr
from drawn_scans import published
from hostile import HOSTILE, HOSTILE_FILE
from matplotlib.text import Text
from numpy.testing import assert_allclose

from stiction.report.format import with_error
from stiction.report.scans.figures import surface_sheet
from stiction.report.scans.tables import scan_uncertainty, scans
from stiction.report.style import save
from stiction.scans.estimate import Settings
from stiction.scans.reading import ScanFile
from stiction.stages.laws import scan_uncertainty as study
from stiction.stages.surfaces import estimate as stage_estimate
from stiction.stages.surfaces import scan as stage_scan
from stiction.surface import maxent

SIDE = 5e-6


@cache
def maps():
    return [stage_scan.layout(ScanFile(scan, "Height", "nm", ())) for scan in published("B2", SIDE, 2)]


@cache
def estimated():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return stage_estimate.compute(maps(), "Etched", stage_estimate.Settings(1, Settings(), 8))


def changed(**values):
    """Estimate with other values."""
    return estimated().assign(**{name: (estimated()[name].dims, value) for name, value in values.items()})


LONG = "\n".join([
    "skewness -5.17 with kurtosis 96.2 has no maximum-entropy density, nor have others within their errors; only "
    "heights: measured can be used, and this sentence goes on until it needs a second line $ of _ the sheet",
    "lines jump by 1.2 nm, against steps of 0.069 nm along a line; lines: offset levels them",
] * 4)  # fmt: skip
#: Estimates whose sheets differ most.
SHEETS = {
    "plain": {},
    "long flags": {"flags": LONG},
    "no flags": {"flags": ""},
    "without density": {"feasible": np.full(3, np.nan), "goodness_chi2": np.nan, "goodness_p": np.nan},
    "not square": {name: np.full(2, np.nan) for name in ("summits", "summit_errors", "model_summits")}
    | {"points": np.array([[250, 125]]), "pixel": np.array([[20e-9, 40e-9]])},
    "many digits": {"covariance": 1e-10 * np.eye(3)},
    "too few summits": {"summits": np.full(2, np.nan)},
}
#: Flag of stage spectrum.
CLIPPED = "the spectrum ends at the Nyquist wave number of the grid"


def spectrum(sentences=""):
    return xr.Dataset({"flags": ((), sentences)})


@cache
def sheet(name):
    return surface_sheet("Etched", changed(**SHEETS[name]), spectrum())


def panel(figure, title):
    """Panel whose title contains a text."""
    (found,) = [axes for axes in figure.axes if title in axes.get_title("left")]
    return found


#: The sheet with most text; the others are slow tests.
FULL = {"long flags"}
ROWS = [pytest.param(name, marks=[pytest.mark.slow] * (name not in FULL)) for name in SHEETS]


@pytest.mark.parametrize("name", ROWS)
def test_no_text_of_a_sheet_covers_another_or_leaves_it(name, tmp_path):
    figure = surface_sheet("Etched", changed(**SHEETS[name]), spectrum(CLIPPED))
    save(figure, tmp_path / "sheet.png")
    boxes = [figure._suptitle.get_window_extent(), figure._supxlabel.get_window_extent()]
    for axes in figure.axes:
        shown = [axes._left_title, axes.xaxis.label, axes.yaxis.label]
        boxes += [text.get_window_extent() for text in shown if text.get_text()]
    width, height = figure.get_size_inches() * figure.dpi
    for k, box in enumerate(boxes):
        assert -2 < box.x0 < box.x1 < width + 2
        assert -2 < box.y0 < box.y1 < height + 2
        assert not any(box.shrunk(0.98, 0.9).overlaps(other) for other in boxes[:k])


@pytest.mark.slow
def test_equal_estimates_give_equal_sheets(tmp_path):
    for name in ("first.pdf", "second.pdf", "first.png", "second.png"):
        save(surface_sheet("Etched", estimated(), spectrum()), tmp_path / name)
    for kind in ("pdf", "png"):
        assert (tmp_path / f"first.{kind}").read_bytes() == (tmp_path / f"second.{kind}").read_bytes()


def test_flags_with_signs_of_formulas_are_shown_as_they_are(tmp_path):
    figure = surface_sheet("Etched", changed(flags=HOSTILE), spectrum(HOSTILE_FILE))
    shown = [text for text in figure.findobj(Text) if "alert" in text.get_text()]
    (said,) = (" ".join(text.get_text().split()) for text in shown)
    assert said.startswith(f"– {HOSTILE} – {HOSTILE_FILE} Errors between parts")
    assert not shown[0].get_parse_math()
    save(figure, tmp_path / "sheet.png")


def test_the_title_shows_the_moments_with_their_errors_and_the_scans():
    title = sheet("plain")._suptitle.get_text()
    assert "Etched: 2 scans of 5 × 5 µm, 250 × 250 points" in title
    rms, errors = 1e9 * stage_estimate.rms(estimated()), np.sqrt(np.diag(estimated().covariance))
    assert f"rms {rms:.3f} ± {rms * errors[0]:.3f} nm" in title
    assert f"skewness −{abs(float(estimated().moments[1])):.3f} ± {errors[1]:.3f}" in title
    assert f"kurtosis {float(estimated().moments[2]):.2f} ± {errors[2]:.2f}" in title
    sectors, error = estimated().sectors.values, estimated().sector_errors.values.max()
    ratio = sectors.max() / sectors.min()
    below = sheet("plain")._supxlabel.get_text()
    assert f"largest over smallest direction: {ratio:.3f} ± {np.sqrt(2) * ratio * error:.3f}." in below


def test_the_map_is_levelled_and_white_at_its_mean():
    (image,) = panel(sheet("plain"), "levelled heights").images
    shown = image.get_array()
    assert_allclose(shown, 1e9 * estimated().elevation.values.T, rtol=1e-6)
    assert abs(shown.mean()) < 0.01
    low, high = image.get_clim()
    assert low == -high
    assert_allclose(image.cmap(0.5)[:3], 1, atol=0.05)
    assert_allclose(image.get_extent(), [0, 5, 0, 5])


def test_undefined_points_are_grey():
    z = estimated().elevation.values.copy()
    z[10:20, 30:50] = np.nan
    figure = surface_sheet("Etched", changed(elevation=z), spectrum())
    (image,) = panel(figure, "levelled heights").images
    assert image.get_array().mask[30:50, 10:20].all()
    assert image.get_array().mask.sum() == 200
    red, green, blue, _ = image.cmap(np.ma.masked_all(1))[0]
    assert red == green == blue < 0.8


def test_densities_integrate_to_one_and_the_band_is_one_error_wide():
    axes = panel(sheet("plain"), "density of the heights")
    stairs = {patch.get_label(): patch.get_data() for patch in axes.patches}
    measured = next(data for label, data in stairs.items() if label.startswith("measured"))
    assert_allclose(np.sum(measured.values * np.diff(measured.edges)), 1, rtol=1e-6)
    band = next(data for label, data in stairs.items() if not label.startswith("measured"))
    inside = band.baseline > 0
    assert inside.mean() > 0.5
    error = estimated().histogram_error.values / (1e9 * stage_estimate.rms(estimated()))
    assert_allclose((band.values - band.baseline)[inside], 2 * error[inside], rtol=1e-9)
    curves = {line.get_label(): line.get_xydata() for line in axes.lines}
    for name, density in (
        ("Gaussian", maxent.GAUSSIAN),
        ("maximum entropy", stage_estimate.density(estimated(), "moments")),
    ):
        z, p = curves[name].T
        assert_allclose(np.trapezoid(p, z), 1, rtol=1e-3)
        rms = 1e9 * stage_estimate.rms(estimated())
        assert_allclose(p, density(z / rms) / rms, rtol=1e-6)
    (shown,) = (text.get_text() for text in axes.texts)
    assert (
        shown
        == f"$T^2$ = {float(estimated().goodness_chi2):.3g}, p = {float(estimated().goodness_p):.2g} (flag below 0.01)"
    )
    assert "maximum entropy" not in {line.get_label() for line in panel(sheet("without density"), "density").lines}


def test_the_spectrum_is_grey_beyond_its_reach_and_shows_the_fit():
    axes = panel(sheet("plain"), "spectrum")
    measured, slow, fitted = (line.get_xydata().T for line in axes.lines)
    rings, reach, fit = (of(estimated()) for of in (stage_estimate.rings, stage_estimate.reach, stage_estimate.fit))
    assert_allclose(measured[0], 1e-6 * rings.wavenumber[rings.wavenumber > 0])
    assert_allclose(measured[1], 1e36 * rings.density[rings.wavenumber > 0])
    modes = rings.modes[rings.wavenumber > 0]
    (band,) = (collection.get_paths()[0].vertices for collection in axes.collections)
    for wavenumber, density, number in zip(*measured, modes, strict=True):
        ends = band[band[:, 0] == wavenumber, 1]
        # A standard error, but no more than the axis of logarithms shows.
        assert_allclose([ends.min(), ends.max()], density * np.array([max(1 - number**-0.5, 0.1), 1 + number**-0.5]))
    assert_allclose(slow, [1e-6 * estimated().slow_wavenumber[1:], 1e36 * estimated().slow_density[1:]])
    inside = fitted[0] < 1e-6 * reach.nyquist
    assert_allclose(fitted[1][inside], 1e36 * fit.spectrum(reach.nyquist)(1e6 * fitted[0][inside]), rtol=1e-9)
    grey = sorted(
        tuple(np.sort(patch.get_extents().transformed(axes.transData.inverted()).intervalx)) for patch in axes.patches
    )
    assert_allclose([grey[0][1], grey[1][0]], [1e-6 * reach.low, 1e-6 * reach.high], rtol=1e-6)
    assert_allclose([grey[0][0], grey[1][1]], axes.get_xlim())
    assert np.all(np.diff(grey) > 0)
    error = 1e-6 * fit.corner * np.sqrt(fit.covariance[1, 1])
    assert axes.texts[0].get_text().startswith(f"corner {with_error(1e-6 * fit.corner, error)} rad/µm\n")
    assert axes.texts[0].get_text().endswith(" (flag above 2)")


def test_summits_of_scans_and_model_have_their_errors():
    axes = panel(sheet("plain"), "summits")
    for container, kind in zip(axes.containers, ("summit", "model_summit"), strict=True):
        (radius, density), (error, density_error) = estimated()[f"{kind}s"].values, estimated()[f"{kind}_errors"].values
        assert_allclose(container[0].get_xydata()[0], [1e6 * radius, 1e-12 * density])
        bars = [np.ptp(bar.get_segments()[0], axis=0) / 2 for bar in container[2]]
        assert_allclose(np.max(bars, axis=0), [1e6 * error, 1e-12 * density_error])
    for name, reason in (("not square", "pixels are not square"), ("too few summits", "too few summits")):
        axes = panel(sheet(name), "summits")
        assert not axes.containers
        assert axes.texts[0].get_text().startswith(reason)


def test_every_flag_is_shown_in_full():
    shown = " ".join(sheet("long flags")._supxlabel.get_text().split())
    for flag in LONG.splitlines():
        assert " ".join(flag.split()) in shown
    assert sheet("no flags")._supxlabel.get_text().splitlines()[:-1] == ["No flags."]
    clipped = surface_sheet("Etched", changed(flags=""), spectrum(CLIPPED))._supxlabel.get_text()
    assert clipped.startswith("– the spectrum ends at the Nyquist wave number")


# Tables


def test_every_scan_has_its_row_with_the_error_of_one_scan():
    table = scans({"Etched": changed(flags="a flag")}, {"Etched": spectrum(CLIPPED)}, {"Etched": maps()})
    assert list(table.frame.file) == ["B2-scan-0.spm", "B2-scan-1.spm"]
    for row, scan in zip(table.frame.itertuples(), published("B2", SIDE, 2), strict=True):
        assert row.rms_nm == pytest.approx(1e9 * scan.heights.std(), rel=0.02)  # levelled
        assert (row.channel, row.points_fast, row.points_slow, row.undefined_percent) == ("Height", 250, 250, 0)
        assert (row.size_fast_um, row.size_slow_um) == pytest.approx((5, 5))
        rms, skewness = (np.sqrt(np.diag(estimated().covariance)) / estimated().places.values[:3])[:2]
        assert row.skewness_se == pytest.approx(np.sqrt(2) * skewness)
        assert row.rms_se_nm == pytest.approx(row.rms_nm * np.sqrt(2) * rms)
        assert row.flags == f"a flag; {CLIPPED}"
    assert f"- Etched: a flag\n- Etched: {CLIPPED}" in table.markdown


@pytest.mark.slow
def test_a_surface_of_scans_of_two_sizes_has_the_errors_of_each():
    smaller = [stage_scan.layout(ScanFile(scan, "Height", "nm", ())) for scan in published("B2", 4e-6, 1)]
    datasets = [*smaller, *maps()]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        estimate = stage_estimate.compute(datasets, "Etched", stage_estimate.Settings(1, Settings(), 8))
    table = scans({"Etched": estimate}, {"Etched": spectrum()}, {"Etched": datasets})
    assert list(table.frame.file) == ["B2-scan-0.spm", "B2-scan-0.spm", "B2-scan-1.spm"]
    assert list(table.frame.size_fast_um) == pytest.approx([4, 5, 5])
    assert_allclose(table.frame.rms_nm, [1e9 * scan.elevation.values.std() for scan in datasets], rtol=0.02)
    at_one_place = float(estimate.covariance[1, 1]) / float(estimate.places[1]) ** 2
    total = at_one_place * (2 * 25 + 16)
    assert_allclose(table.frame.skewness_se, np.sqrt(total / np.array([16, 25, 25])))
    title = surface_sheet("Etched", estimate, spectrum())._suptitle.get_text()
    assert "Etched: 2 scans of 5 × 5 µm, 250 × 250 points and 1 scan of 4 × 4 µm, 200 × 200 points" in title


def uncertainty():
    errors = np.array([[[0.1, 0.05], [0.02, 0.01], [0.01, 0.005], [0.08, 0.05]]])
    found = study.Uncertainty(errors, np.array([[0.004, 0.002]]), np.array([[0.15, 0.05]]))
    choices = {"beyond": [(-0.2, 0.02), (-0.05, 0.01)], "heights": [(0.1, 0.08), (0.02, 0.01)]}
    return study.layout(["Etched"], (0.44, 0.88), found, [3], choices)


def test_errors_by_scans_are_tabulated_by_surface_and_for_the_pair():
    table = scan_uncertainty({"mine": uncertainty()})
    assert list(table.frame.surface) == ["Etched", "all"] * 2
    first, both = table.frame.iloc[0], table.frame.iloc[1]
    assert_allclose(
        first[["rms_percent", "shape_percent", "spectrum_percent", "total_percent"]].astype(float), [10, 2, 1, 8]
    )
    assert_allclose([first.crack_length_percent, both.crack_length_percent], 2)
    assert (first.scans, first.scans_needed) == (both.scans, both.scans_needed) == (3, 8)
    assert_allclose([first.total_se_percent, both.total_se_percent], 0.4)
    assert_allclose([both.beyond_percent, both.beyond_se_percent], [-20, 2])
    assert_allclose([both.heights_percent, both.heights_se_percent], [10, 17])
    assert np.isnan(first.beyond_percent)
    cells = table.cells.iloc[1]
    assert cells["other beyond [%]"] == "-20.0 ± 2.0"
    assert cells["other heights [%]"] == "+10 ± 17"
    assert cells["ē: total [%]"] == "8.00 ± 0.40"
    assert cells["ē: rms [%]"] == "–"
    assert cells["needed"] == "8"
