"""Sheet of a measured surface: map, height density, spectrum and summits with their errors, and their limits."""

import re
import textwrap
from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stiction.report.format import PER_UM2, TO_NM, TO_UM, UM, with_error
from stiction.report.style import DOUBLE, MODELS, OUTLINED, figure_stage, letter, page_width, panels, styled
from stiction.scans.flags import UNLIKELY
from stiction.scans.levelling import Levelling, level
from stiction.scans.scan import Scan
from stiction.scans.whittle import MISFIT
from stiction.stages.surfaces import estimate as stage_estimate
from stiction.stages.surfaces import surface_flags

_MEASURED, _MODEL = {"color": "black"}, {"color": MODELS["NG"]["color"]}
_BAND, _BEYOND = {"color": "0.75", "linewidth": 0}, {"color": "0.92", "linewidth": 0, "zorder": 0}
_CORNER = {"fontsize": 7, "path_effects": OUTLINED}
_SLOW = {"color": "0.5", "linewidth": 0.5}
#: Colours of the map saturate at this number of rms; decades of densities below their largest value, factor above it.
_SATURATED, _DECADES, _HEADROOM = 3, 6, 60
#: Characters of a line of sentences in two columns of a journal, height of a line and of the panels with titles [in].
_LINE, _LINE_HEIGHT, _PANELS = 150, 0.125, 5.92


@styled
def surface_sheet(surface: str, estimate: xr.Dataset, spectrum: xr.Dataset | None = None) -> Figure:
    """Sheet of one measured surface: the measured quantities, their errors, and the model drawn from them.

    The spectrum, of which the flags are shown, is that of a surface that is simulated.
    """
    lines = _lines(surface_flags.flags(*(data for data in (estimate, spectrum) if data is not None)))
    lines = [*lines, *_wrapped(_minus(_of_errors(estimate)))]
    figure, axes = panels(2, 2, (DOUBLE, _PANELS + _LINE_HEIGHT * len(lines)))
    _map(figure, axes[0, 0], estimate)
    _density(axes[0, 1], estimate)
    _spectrum(axes[1, 0], estimate)
    _summits(axes[1, 1], estimate)
    letter(axes, ["levelled heights", "density of the heights", "spectrum", "summits at the pixels of the scans"])
    figure.suptitle(_title(surface, estimate), x=0.01, ha="left", fontsize=8)
    figure.supxlabel("\n".join(lines), x=0.01, ha="left", fontsize=7, parse_math=False)
    return figure


@styled
def refused_sheet(name: str, scan: Scan | None, reasons: Sequence[str]) -> Figure:
    """Sheet of a surface without an estimate: the reasons, and the levelled map of a scan if there is one."""
    lines = _lines(reasons)
    figure, axes = panels(1, 1, (DOUBLE, (_PANELS if scan else 1) + _LINE_HEIGHT * len(lines)))
    if scan is None:
        axes[0, 0].set_axis_off()
    else:
        _heights(figure, axes[0, 0], level(scan.heights, Levelling()), scan.size)
        axes[0, 0].set_title(f"{scan.name}, less its plane", loc="left")
    figure.suptitle(f"{name}: no estimate", x=0.01, ha="left", fontsize=8)
    figure.supxlabel("\n".join(lines), x=0.01, ha="left", fontsize=7, parse_math=False)
    return figure


def _lines(sentences: Sequence[str]):
    """Sentences as lines of text, each with a mark."""
    if not sentences:
        return ["No flags."]
    return [line for sentence in sentences for line in _wrapped(sentence, "– ", "   ")]


def _wrapped(text, first="", further=""):
    """Lines of a text that fit across a figure."""
    width = int(_LINE * page_width(DOUBLE) / DOUBLE)
    return textwrap.wrap(text, width, initial_indent=first, subsequent_indent=further)


def _title(name, estimate):
    """Scans and numbers with their errors."""
    rms, errors = TO_NM * stage_estimate.rms(estimate), np.sqrt(np.diag(estimate.covariance))
    skewness, kurtosis = stage_estimate.shape(estimate)
    numbers = (
        f"rms {with_error(rms, rms * errors[0])} nm, skewness {with_error(skewness, errors[1])}, "
        f"kurtosis {with_error(kurtosis, errors[2])}"
    )
    scans = " and ".join(_scans(*each) for each in stage_estimate.frames(estimate))
    return "\n".join([*_wrapped(f"{name}: {scans}"), *_wrapped(_minus(numbers))])


def _of_errors(estimate):
    """Errors by two routes, and whether the surface is the same in all directions."""
    tiles = np.max(estimate.tile_errors.values / estimate.closed_form_errors.values)
    sectors = float(estimate.sectors.max() / estimate.sectors.min())
    sector_error = np.sqrt(2) * sectors * float(estimate.sector_errors.max())
    return (
        f"Errors between parts of the scans over those computed from the spectrum: at most {tiles:.2g}. "
        f"Spectrum, largest over smallest direction: {with_error(sectors, sector_error)}."
    )


def _scans(count, frame):
    """Number, size and points of scans of one size."""
    size, points = " × ".join(f"{TO_UM * length:.4g}" for length in frame.size), " × ".join(map(str, frame.shape))
    return f"{count} scan{'s' * (count > 1)} of {size} µm, {points} points"


def _minus(text):
    """Text with minus signs in place of hyphens before numbers."""
    return re.sub(r"-(?=\d)", "\N{MINUS SIGN}", text)


def _map(figure: Figure, panel: Axes, estimate):
    """Levelled heights of the first of the largest scans."""
    _heights(figure, panel, estimate.elevation.values, stage_estimate.frames(estimate)[0][1].size)


def _heights(figure: Figure, panel: Axes, heights, size):
    """Map of heights [m]: blue below and red above the mean, undefined points grey. Sides [m]."""
    z = TO_NM * heights
    limit = _SATURATED * np.nanstd(z)
    extent = [0, TO_UM * size[0], 0, TO_UM * size[1]]
    colours = colormaps["RdBu_r"].with_extremes(bad="0.6")
    shades = {"cmap": colours, "vmin": -limit, "vmax": limit}
    image = panel.imshow(np.ma.masked_invalid(z.T), origin="lower", extent=extent, interpolation="nearest", **shades)
    figure.colorbar(image, ax=panel, label="height $z$ [nm]", shrink=0.9, extend="both")
    panel.set(xlabel="fast axis $x_1$ [µm]", ylabel="slow axis $x_2$ [µm]")


def _density(panel, estimate):
    """Histogram with its errors, maximum entropy and Gaussian density."""
    rms, z = TO_NM * stage_estimate.rms(estimate), np.linspace(-6, 6, 601)
    edges, density, error = (estimate[name].values for name in ("edge", "histogram", "histogram_error"))
    largest = density.max() / rms
    panel.stairs(
        (density + error) / rms, rms * edges, baseline=np.maximum(density - error, 0) / rms, fill=True, **_BAND
    )
    panel.stairs(density / rms, rms * edges, baseline=None, label="measured, ± 1 standard error", **_MEASURED)
    panel.plot(rms * z, np.exp(-(z**2) / 2) / np.sqrt(2 * np.pi) / rms, **MODELS["G"])
    if not np.isnan(stage_estimate.distance(estimate)):
        entropy = stage_estimate.density(estimate, "moments")(z) / rms
        panel.plot(rms * z, entropy, **_MODEL, label="maximum entropy")
        likely = f"p = {float(estimate.goodness_p):.2g} (flag below {UNLIKELY:g})"
        text = rf"$T^2$ = {float(estimate.goodness_chi2):.3g}, {likely}"
        panel.text(0.5, 0.04, text, transform=panel.transAxes, ha="center", **_CORNER)
    panel.set(yscale="log", ylim=(largest / 10**_DECADES, _HEADROOM * largest), xlim=(-6 * rms, 6 * rms))
    panel.set(xlabel="height $z$ [nm]", ylabel="density $p_Z$ [nm$^{-1}$]")
    panel.legend(loc="upper right")


def _spectrum(panel, estimate):
    """Rings with their errors, the band near the slow axis and Eq. (7). Grey beyond the reach of the microscope."""
    rings, reach = stage_estimate.rings(estimate), stage_estimate.reach(estimate)
    inside = (rings.wavenumber > 0) & (rings.density > 0)  # the others are hidden by noise
    zeta, density = rings.wavenumber[inside] / TO_UM, TO_NM**4 * rings.density[inside]
    error = density / np.sqrt(rings.modes[inside])
    panel.fill_between(zeta, np.maximum(density - error, density / 10), density + error, **_BAND)
    panel.plot(zeta, density, **_MEASURED, label="measured, ± 1 standard error")
    slow = estimate.isel(slow_ring=slice(1, None))
    panel.plot(slow.slow_wavenumber / TO_UM, TO_NM**4 * slow.slow_density, **_SLOW, label="near the slow axis")
    fit = stage_estimate.fit(estimate)
    fitted = TO_NM**4 * fit.spectrum(2 * TO_UM * zeta[-1])(TO_UM * zeta)
    panel.plot(zeta, fitted, **_MODEL, label="Eq. (7)")
    low, high = reach.low / TO_UM, reach.high / TO_UM
    ends = low / 2, zeta[-1]
    panel.axvspan(ends[0], low, **_BEYOND)
    panel.axvspan(high, ends[1], **_BEYOND, label="beyond the reach")
    limits = fitted[-1] / _HEADROOM, 10 * _HEADROOM * fitted[0]
    panel.set(xscale="log", yscale="log", xlim=ends, ylim=limits)
    panel.set(xlabel=r"wave number $\zeta$ [rad/µm]", ylabel="spectrum $s_Z$ [nm$^4$]")
    panel.text(0.04, 0.04, _minus(_fit(fit)), transform=panel.transAxes, linespacing=1.4, **_CORNER)
    panel.legend(loc="upper right")


def _fit(fit):
    """Parameters of Eq. (7) with their errors."""
    corner, (_, corner_error, slope_error) = fit.corner / TO_UM, fit.errors
    corner_text, slope_text = with_error(corner, corner * corner_error), with_error(fit.slope, slope_error)
    return (
        f"corner {corner_text} rad/µm\nslope {slope_text}\n"
        + rf"$\chi^2$/dof = {fit.chi2 / fit.freedom:.2g} (flag above {MISFIT:g})"
    )


def _summits(panel, estimate):
    """Radius and density of the summits of the scans, and of scans drawn from the model."""
    panel.set(xlabel="summit radius [µm]", ylabel="summit density [µm$^{-2}$]")
    if np.isnan(estimate.summits).any():
        finest = min((frame for _, frame in stage_estimate.frames(estimate)), key=lambda frame: max(frame.pixel))
        reason = "too few summits" if finest.square else "pixels are not square:\nno summits"
        panel.text(0.5, 0.5, reason, transform=panel.transAxes, ha="center", va="center")
        return
    for kind, style, mark, label in (
        ("summit", _MEASURED, "o", "measured, ± 1 standard error"),
        ("model_summit", _MODEL, "s", "drawn from the model, ± scatter"),
    ):
        units = np.array([UM, PER_UM2])
        values, errors = estimate[f"{kind}s"].values / units, estimate[f"{kind}_errors"].values / units
        bars = {"marker": mark, "linestyle": "", "label": label} | style
        panel.errorbar(values[0], values[1], errors[1], errors[0], **bars)
    panel.margins(0.4)
    panel.legend(loc="best")


STAGES = (
    figure_stage(
        "surface_sheet_{surface}",
        "scans of {surface}",
        "Surfaces (Sec. II)",
        name="surface_sheet",
        inputs=lambda plan, at: {
            stage: f"{stage}/{at.surface}" for stage in ("estimate", *["spectrum"] * plan.is_drawn(at.surface))
        },
        compute=surface_sheet,
        jobs=lambda plan: [{"surface": name} for name in plan.scans.surfaces],
        targets=("figures", "measured", "scans"),
    ),
)
