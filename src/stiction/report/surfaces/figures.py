"""Figures of the surfaces (Secs. II and IV-A): 7 to 11."""

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from stiction.models import SURFACE_MODELS
from stiction.plan.names import by_name
from stiction.report.format import TO_NM, TO_UM
from stiction.report.style import (
    DOUBLE,
    MODELS,
    OUTLINED,
    SINGLE,
    columns_of_panels,
    dashes,
    figure_stage,
    handles,
    is_page,
    legend_outside,
    letter,
    letter_lines,
    marker,
    panels,
    plain_log,
    shades,
    styled,
)

#: Bins along either axis of the joint density of summits.
_BINS = 40
#: Height of a line of densities on a page, and of maps of surfaces [in].
_HIGH, _MAP = 1.5, 2.2
#: Decades of the densities of the heights below their largest value.
_DECADES = 6


# Figure 7


@styled
def height_densities(heights: Mapping[str, xr.Dataset]) -> Figure:
    """Figure 7: maximum-entropy density of the heights and the Gaussian one, linear above and logarithmic below.

    The datasets are by surface, each in a column.
    """
    if is_page():  # both panels of a surface side by side
        figure, columns = panels(len(heights), 2, (DOUBLE, _HIGH * len(heights)), beside=True)
        lines = [row[None] for row in columns]
    else:
        figure, columns, lines = columns_of_panels(len(heights), 2, _width, 3.4, sharex="col")
    for column, dataset in zip(columns, heights.values(), strict=True):
        for panel in column:
            _density(panel, dataset)
        column[1].set_yscale("log")
        column[1].set_ylim(10.0**-_DECADES * float(dataset.density.max()) / (TO_NM * float(dataset.rms)), None)
        column[1].set_xlabel("height $z$ [nm]")
    for panel in np.concatenate([line[:, 0] for line in lines]):
        panel.set_ylabel("density $p_Z$ [nm$^{-1}$]")
    if is_page():
        letter(columns, [f"{name}{scale}" for name in heights for scale in ("", ", logarithmic")])
    else:
        letter_lines(lines, heights)
    figure.legend(*columns[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=2)
    return figure


def _density(panel, heights):
    """Both densities of one surface."""
    rms, z = TO_NM * float(heights.rms), heights.height.values
    panel.plot(rms * z, np.exp(-(z**2) / 2) / np.sqrt(2 * np.pi) / rms, **MODELS["G"])
    panel.plot(rms * z, heights.density.values / rms, **MODELS["NG"] | {"label": "maximum entropy"})


@styled
def surface(strip: xr.DataArray, heights: xr.Dataset, spectrum: xr.DataArray) -> Figure:
    """One surface: a drawn strip, the densities of its heights and its spectrum.

    The strip is a map of heights [m] over x and y [m]; the spectrum [m⁴] is over the wave number [rad/m].
    """
    figure, ((above, density, falling),) = panels(1, 3, (DOUBLE, 2.6))
    square = strip[:, : strip.sizes["x"]]
    sides = [TO_UM * float(square[axis][-1] + square[axis][1]) for axis in ("x", "y")]
    image = above.imshow(TO_NM * square.values.T, origin="lower", extent=[0, sides[0], 0, sides[1]])
    figure.colorbar(image, ax=above, label="height $z$ [nm]", shrink=0.9)
    above.set(xlabel="$x_1$ [µm]", ylabel="$x_2$ [µm]")
    _density(density, heights)
    density.set(xlabel="height $z$ [nm]", ylabel="density $p_Z$ [nm$^{-1}$]")
    figure.legend(*handles(density), loc="outside upper center", ncols=2)
    positive = spectrum[spectrum.values > 0]
    falling.loglog(positive.wavenumber / TO_UM, TO_NM**4 * positive, **MODELS["NG"])
    falling.set(xlabel="wave number [rad/µm]", ylabel="spectrum $s_Z$ [nm$^4$]")
    return figure


def _width(columns):
    """Width of a figure with this number of columns [in]."""
    return DOUBLE / 4 * columns + 0.2


# Figures 8 and 9


@styled
def elevation_maps(characters: Mapping[str, xr.Dataset]) -> Figure:
    """Figure 8: a piece of every simulated surface, by its name, seen from above."""
    columns = min(2, len(characters))
    rows = -(-len(characters) // columns)
    figure, axes = panels(rows, columns, (SINGLE * columns / 2, _MAP * rows), beside=True)
    for panel, dataset in zip(axes.flat, characters.values(), strict=False):
        extent = [0, TO_UM * float(dataset.x[-1] + dataset.x[1]), 0, TO_UM * float(dataset.y[-1] + dataset.y[1])]
        image = panel.imshow(TO_NM * dataset.elevation.values.T, origin="lower", extent=extent)
        bar = figure.colorbar(image, ax=panel, label="height $z$ [nm]", orientation="horizontal", pad=0.02, aspect=14)
        bar.ax.xaxis.set_major_locator(MaxNLocator(4))
        panel.set(xlabel="$x_1$ [µm]", ylabel="$x_2$ [µm]")
        panel.locator_params(nbins=3)
    letter(axes.flat[: len(characters)], list(characters))
    for unused in axes.flat[len(characters) :]:
        unused.remove()
    return figure


@styled
def profiles(name: str, characters: Mapping[str, xr.Dataset]) -> Figure:
    """Figure 9: one profile of a Gaussian and of a non-Gaussian surface made from the same random numbers.

    ``name`` is that of the surface; its datasets are by model, G and NG.
    """
    figure, ((panel,),) = panels(1, 1, (SINGLE, 2.4))
    panel.axhline(0, color="0.7", linewidth=0.6)
    for model in SURFACE_MODELS:
        dataset = characters[model]
        panel.plot(TO_UM * dataset.x, TO_NM * dataset.elevation[:, dataset.sizes["y"] // 2], **MODELS[model])
    panel.set(xlabel="$x_1$ [µm]", ylabel="height $z$ [nm]", xlim=TO_UM * dataset.x[[0, -1]])
    panel.set_title(name, loc="left")
    legend_outside(figure, handles(panel), "lower", 2)
    return figure


# Figure 10

#: Label of the wave number.
_ZETA = r"wave number $\zeta$ [rad/µm]"
#: Line of the error of the closed form.
_CLOSED = {"linestyle": "-", "linewidth": 0.6}


@styled
def spectra(surfaces: Mapping[str, tuple[xr.Dataset, xr.Dataset, xr.Dataset, xr.Dataset]]) -> Figure:
    """Figure 10: spectra of all surfaces over their targets, closed form over target, and error by iteration.

    Each surface has its datasets of stages heights, spectrum, character (non-Gaussian) and iteration, in this order.
    """
    figure, ((density, ratio, error),) = panels(1, 3, (DOUBLE, 2.8))
    for k, (name, datasets) in enumerate(surfaces.items()):
        style = {"color": shades(len(surfaces))[k], "linestyle": dashes(k), "label": name}
        _spectra(density, datasets, style)
        _relation(ratio, datasets[1], style)
        _misfits(error, datasets[3], style | {"marker": marker(k)})
    density.set(xlabel=_ZETA, ylabel="spectrum $s_Z$ [nm$^4$]", xscale="log", yscale="log")
    ratio.set(xlabel=_ZETA, ylabel="closed form / target [–]", xscale="log")
    error.set(xlabel="iteration", ylabel="mean error per ring [%]", yscale="log")
    error.xaxis.set_major_locator(MaxNLocator(integer=True))
    plain_log(error.yaxis)
    error.plot([], [], color="0.3", label="closed form, without marks", **_CLOSED)
    letter((density, ratio, error), ["drawn surfaces, target grey", "closed form", "iterative algorithm"])
    legend_outside(figure, handles(error), "lower", 6)
    return figure


def _spectra(panel, datasets, style):
    """Target of one surface, and the mean spectrum of those drawn from the closed form."""
    heights, spectrum, character, _ = datasets
    target = TO_NM**4 * float(heights.rms) ** 2 * spectrum.target[1:]
    drawn = TO_NM**4 * character.periodogram.mean("field")
    panel.plot(spectrum.wavenumber[1:] / TO_UM, target.where(target > 0), color="0.8", linewidth=3.5, zorder=0)
    panel.plot(character.wavenumber / TO_UM, drawn.where(drawn > 0.05 * float(target[-2])), **style)


def _relation(panel, spectrum, style):
    """Expected spectrum of the closed form over the target."""
    zeta, target = _whole_rings(spectrum)
    panel.plot(zeta / TO_UM, spectrum.achieved[1 : len(zeta) + 1] / target, **style)


def _whole_rings(spectrum):
    """Wave numbers and target of the rings without 0 and not across the cut-off."""
    zeta, target = spectrum.wavenumber.values, spectrum.target.values
    inside = (zeta > 0) & (zeta + zeta[1] / 2 <= float(spectrum.cutoff))
    return zeta[inside], target[inside]


def _misfits(panel, iteration, style):
    """Error of the iterated spectra by iteration, and of the closed form."""
    panel.plot(iteration.iteration, 100 * iteration.misfit, **style)
    panel.axhline(100 * float(iteration.closed_form_misfit), color=style["color"], **_CLOSED)


# Figure 11


@styled
def summits(characters: Mapping[str, Mapping[str, xr.Dataset]]) -> Figure:
    """Figure 11: joint density of heights and radii of summits, Gaussian on the left, non-Gaussian on the right.

    The datasets are by surface, and for each of them by model, G and NG.
    """
    figure, axes = panels(len(characters), 2, (1.4 * SINGLE, 2.2 * len(characters)), sharex="row", sharey="row")
    for row, models in zip(axes, characters.values(), strict=True):
        points = [_summits(models[model]) for model in SURFACE_MODELS]
        edges = [np.histogram_bin_edges(np.concatenate(pair), _BINS) for pair in zip(*points, strict=True)]
        densities = [np.histogram2d(*pair, edges, density=True)[0] for pair in points]
        shades = LogNorm(min(d[d > 0].min() for d in densities), np.max(densities))
        for panel, density, pair in zip(row, densities, points, strict=True):
            filled = np.ma.masked_equal(density.T, 0)
            image = panel.pcolormesh(edges[0], 10 ** edges[1], filled, norm=shades, cmap="cividis_r")
            panel.set(yscale="log", xlabel="summit height [nm]")
            plain_log(panel.yaxis)
            panel.set_ylabel("summit radius [µm]")
            _mean_radius(panel, 1 / np.mean(10 ** -pair[1]))
        figure.colorbar(image, ax=row, label="density [nm$^{-1}$ decade$^{-1}$]")
    letter(axes, [f"{name}, {MODELS[model]['label']}" for name in characters for model in SURFACE_MODELS])
    return figure


def _summits(character):
    """Heights [nm] and decimal logarithms of the radii [µm] of the summits kept."""
    return TO_NM * character.summit_height.values, -np.log10(character.summit_curvature.values / TO_UM)


def _mean_radius(panel, radius):
    """Mark one over the mean curvature [µm], the radius of Table I."""
    panel.axhline(radius, color="black", linestyle="--", linewidth=0.8, path_effects=OUTLINED)
    number = f"{radius:#.2g}".rstrip(".")
    transform, style = (
        panel.get_yaxis_transform(),
        {"ha": "right", "va": "bottom", "fontsize": 7, "path_effects": OUTLINED},
    )
    panel.annotate(f"1 / mean curvature: {number} µm", (0.98, radius), (0, 3), transform, "offset points", **style)


def _datasets_by_surface(data):
    """Datasets of several stages by surface."""
    return {name: tuple(data[stage][name] for stage in data if stage != "style") for name in data["heights"]}


def _figure_11(file, shows, surfaces):
    """Figure 11 of some surfaces."""
    return figure_stage(
        file,
        shows,
        _CATEGORY,
        caption="figure_11",
        inputs=lambda plan, at: {
            "gaussian": by_name("character", surfaces(plan), "_G"),
            "other": by_name("character", surfaces(plan), "_NG"),
        },
        compute=lambda data: summits(
            {name: {"G": gaussian, "NG": data["other"][name]} for name, gaussian in data["gaussian"].items()}
        ),
        jobs=lambda plan: [{}] if plan.pairs and surfaces(plan) else [],
        targets=("figures",),
    )


_CATEGORY = "Surfaces (Sec. II)"
STAGES = (
    figure_stage(
        "figure_07",
        "densities of the heights",
        _CATEGORY,
        inputs=lambda plan, at: {"heights": by_name("heights", plan.surfaces)},
        compute=height_densities,
        targets=("figures",),
    ),
    figure_stage(
        "figure_08",
        "simulated surfaces",
        _CATEGORY,
        inputs=lambda plan, at: {"characters": by_name("character", plan.surfaces, "_NG")},
        compute=elevation_maps,
        targets=("figures",),
    ),
    figure_stage(
        "figure_09",
        "Gaussian and non-Gaussian profile",
        _CATEGORY,
        inputs=lambda plan, at: {
            "characters": {model: f"character/{plan.figure_surface}_{model}" for model in SURFACE_MODELS}
        },
        settings=lambda plan, at: {"surface": plan.figure_surface},
        compute=lambda data, settings: profiles(settings["surface"], data["characters"]),
        targets=("figures",),
    ),
    figure_stage(
        "figure_10",
        "spectra of simulated surfaces",
        _CATEGORY,
        inputs=lambda plan, at: {
            "heights": by_name("heights", plan.surfaces),
            "spectrum": by_name("spectrum", plan.surfaces),
            "character": by_name("character", plan.surfaces, "_NG"),
            "iteration": by_name("iteration", plan.surfaces),
        },
        compute=lambda data: spectra(_datasets_by_surface(data)),
        study="iteration",
        targets=("figures",),
    ),
    _figure_11("figure_11", "heights and radii of summits", lambda plan: [plan.figure_surface]),
    _figure_11(
        "figure_11_supplement",
        "heights and radii of summits, other surfaces",
        lambda plan: plan.other_surfaces,
    ),
)
