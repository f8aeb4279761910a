"""Figures of the beams (Secs. IV-B to V): 14 and 15."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.transforms import ScaledTranslation

from stiction.beam.cantilever import Beam
from stiction.beam.energy import apparent_adhesion_energy
from stiction.config.units import in_si
from stiction.contact.environment import Water
from stiction.contact.meniscus import flooded_energy
from stiction.models import SURFACE_MODELS
from stiction.plan.names import by_model, by_outcome
from stiction.report import published
from stiction.report.format import TO_MJ, TO_UM, with_error
from stiction.report.published import rows
from stiction.report.style import (
    DOUBLE,
    MODELS,
    OUTLINED,
    PUBLISHED,
    dry_tick,
    figure_stage,
    handles,
    humidity_axis,
    is_page,
    letter,
    panels,
    places,
    styled,
)
from stiction.rounding import in_percent
from stiction.stages.beams.cantilevers import Cantilevers, cantilever, sections
from stiction.stages.beams.releases import ends_as, stuck_energies, stuck_lengths

# Figure 14


#: Share of the gap that is drawn below it, as substrate, and above it.
_SUBSTRATE = 0.06


@styled
def beam_shapes(beams: xr.Dataset) -> Figure:
    """Figure 14: shapes of some released beams, one highlighted. Histogram of the crack lengths of S-shapes."""
    figure, ((shapes, histogram),) = panels(1, 2, (DOUBLE, 2.5))
    stuck = ends_as(beams, "S-shape")
    deflection, x = TO_UM * beams.deflection.values, TO_UM * beams.node.values
    shapes.plot(x, deflection.T, color="0.7", linewidth=0.4, rasterized=True)
    shapes.plot([], [], color="0.7", label="each beam")
    for k in np.flatnonzero(stuck[: len(deflection)])[:1]:
        shapes.plot(x, deflection[k], color="black", linewidth=1.4, label="one S-shaped beam")
    ground = deflection.max()
    shapes.axhspan(ground, (1 + _SUBSTRATE) * ground, color="0.35", label="substrate")
    shapes.set(xlabel="position [µm]", ylabel="deflection [µm]", xlim=x[[0, -1]])
    shapes.set_ylim((1 + _SUBSTRATE) * ground, -_SUBSTRATE * ground)
    shapes.legend(loc="upper right")
    crack = TO_UM * stuck_lengths(beams)
    histogram.hist(crack, bins="auto", color="0.75", edgecolor="black")
    histogram.set(xlabel="crack length $l_s$ [µm]", ylabel="number of beams")
    histogram.margins(y=0.3)
    histogram.text(0.97, 0.95, _summary(crack, len(stuck)), ha="right", va="top", transform=histogram.transAxes)
    letter([shapes, histogram], [f"first {len(deflection)} of {len(stuck)} beams", "all beams"])
    return figure


def _summary(crack, total):
    """Number, mean and standard deviation of crack lengths [µm] as text."""
    number = f"{len(crack)} of {total} beams S-shaped"
    return f"{number}\nmean ± std: {with_error(crack.mean(), crack.std(ddof=1))} µm" if len(crack) > 1 else number


# Figure 15


def energies_with_bars(crack_length: np.ndarray, deviation: np.ndarray, beam: Beam) -> tuple[np.ndarray, np.ndarray]:
    """Energies of Eq. (13), and the lengths of their error bars for crack lengths ± ``deviation``.

    Parameters
    ----------
    crack_length, deviation : (n,) arrays
        [m]
    beam : Beam
        Nominal dimensions.

    Returns
    -------
    energy : (n,) array
        [J m⁻²]
    bars : (2, n) array
        Below and above; a longer crack means a lower energy [J m⁻²].
    """
    energy, low, high = (apparent_adhesion_energy(crack_length + sign * deviation, beam) for sign in (0, 1, -1))
    return energy, np.array([energy - low, high - energy])


#: Models of the two columns.
_COLUMNS = SURFACE_MODELS, ("GEO",)
#: Marker of a model, filled for simulated and open for published values, and colour of simulated values.
_MARKERS = {"G": ("s", MODELS["G"]["color"]), "NG": ("o", MODELS["NG"]["color"]), "GEO": ("^", "#009E73")}
#: Simulated markers are shifted this far to the left of their humidity, published ones to the right [pt].
_ASIDE = 3
#: Heights of the panels of energies and of shares [in].
_HEIGHTS = 2.2, 0.9
#: Labels of shares are closer to each other than their width if closer than this part of the axis.
_CLOSE = 0.12


@styled
def adhesion_energies(pairs: Mapping[str, tuple], published: pd.DataFrame, flat: Mapping[str, float]) -> Figure:
    """Figure 15: apparent adhesion energy against humidity. Models G and NG on the left, GEO on the right.

    The share of S-shapes is stated at each mean if it is below 100 %; if such labels of a pair would cover each other,
    the shares have panels of their own below those of the energies. Beams in dry air are beside the axis.

    Parameters
    ----------
    pairs : dict
        Pair to its nominal beam, a dict of (humidity, model) to the dataset of stage beams, and a dict of model (G, NG)
        to the dataset of stage humidity, empty for surfaces in dry air alone.
    published : pandas.DataFrame
        The published Table III, rows of the paper's own pairs.
    flat : dict
        Pair to the adhesion energy of its flats in saturated air [J m⁻²]; pairs in dry air alone are missing.
    """
    figure, axes, rows_of_pairs = _rows_of_panels(pairs, published)
    for (row, below), (pair, (beam, released, bands)) in zip(rows_of_pairs, pairs.items(), strict=True):
        weakest = apparent_adhesion_energy(beam.length, beam)
        published_rows = rows(published, pair=pair)
        placed = places([*(humidity for humidity, _ in released), *published_rows.relative_humidity])
        released = {(placed[humidity], model): beams for (humidity, model), beams in released.items()}
        lowest = min([weakest, *(float(axis.energy_quantile.sel(probability=0.5).min()) for axis in bands.values())])
        highest = max(2 * flat.get(pair, 0.0), 2 * weakest, *map(_reach, released.values()))
        row[0].set(yscale="log", ylim=(TO_MJ * lowest / 2, TO_MJ * highest))
        row[0].set_ylabel(r"adhesion energy $\Gamma$ [mJ/m²]")
        for panel, models in zip(row, _COLUMNS, strict=True):
            _bounds(panel, flat.get(pair), weakest)
            for surface in sorted(bands.keys() & (SURFACE_MODELS if "G" in models else ("NG",))):
                _band(panel, bands[surface], surface)
            _draw_measured(panel, published_rows, beam, models)
            for model in models:
                _draw_simulated(panel, released, model)
                if below is None:
                    _labels(panel, released, model, TO_MJ * weakest)
        # Markers beside their places are no data to the axis.
        row[0].update_datalim([(position, TO_MJ * weakest) for position in placed.values()], updatey=False)
        row[0].margins(x=0.12 if is_page() else 0.06)
        humidity_axis(row[0], placed)
        if below is not None:
            _panels_of_shares(below, released, row[0].get_xlim())
            dry_tick(below[0], placed)
    for panel in axes[-1]:
        panel.set_xlabel("relative humidity RH [–]")
    kinds = [(pair, kind) for pair, (_, below) in zip(pairs, rows_of_pairs, strict=True) for kind in _kinds(below)]
    letter(axes, [f"pair {pair}, {' and '.join(models)}{kind}" for pair, kind in kinds for models in _COLUMNS])
    _legend_above(figure, axes)
    return figure


def _legend_above(figure, axes):
    """Legend of all panels, with as many columns as fit across the figure."""
    entries, labels = handles(*axes.flat)
    notes = ["beams left of RH, published right"]
    if any(text.get_text().endswith("%") for panel in axes.flat for text in panel.texts):
        notes += ["58 %: share of S-shapes, if not all", "small marks: no S-shape"]
    entries += [Line2D([], [], linestyle="") for _ in notes]
    labels += notes
    style = {"loc": "outside upper center", "columnspacing": 1.2}
    for columns in (5, 4, 3, 2, 1):
        legend = figure.legend(entries, labels, ncols=columns, **style)
        if columns == 1 or legend.get_window_extent().width <= figure.bbox.width:
            return
        legend.remove()


def _rows_of_panels(pairs, published):
    """New figure, its axes, and for each pair its row of energies and its row of shares, None without such a row."""
    apart = [_labels_meet(released, rows(published, pair=pair)) for pair, (_, released, _) in pairs.items()]
    heights = [height for has_shares in apart for height in _HEIGHTS[: 1 + has_shares]]
    size = DOUBLE, sum(heights) + 0.6
    figure, axes = panels(len(heights), 2, size, beside=True, sharex="row", sharey="row", height_ratios=heights)
    unused = iter(axes)
    return figure, axes, [(next(unused), next(unused) if has_shares else None) for has_shares in apart]


def _kinds(below):
    """Contents of the rows of a pair, as the end of their titles."""
    return ("",) if below is None else ("", ": share of S-shapes")


def _labels_meet(released, published):
    """Whether labels of the fractions of a pair would cover each other in a panel."""
    humidities = np.array([*(humidity for humidity, _ in released), *published.relative_humidity])
    length = max(np.ptp(humidities), 0.1)
    for models in _COLUMNS:
        labelled = sorted(h for model in models for h, share in _shares(released, model) if share < 1)
        if len(labelled) > 1 and np.diff(labelled).min() < _CLOSE * length:
            return True
    return False


def _shares(released, model):
    """Share of S-shaped beams at every humidity [-]."""
    by_humidity = sorted((humidity, beams) for (humidity, beam_model), beams in released.items() if beam_model == model)
    return [(humidity, float(ends_as(beams, "S-shape").mean())) for humidity, beams in by_humidity]


def _panels_of_shares(row, released, limits):
    """Shares of S-shaped beams over the humidity."""
    for panel, models in zip(row, _COLUMNS, strict=True):
        for model in models:
            marker, colour = _MARKERS[model]
            humidity, share = np.reshape(_shares(released, model), (-1, 2)).T
            panel.plot(humidity, 100 * share, marker, color=colour, markeredgecolor="black", markeredgewidth=0.4)
    row[0].set(xlim=limits, ylim=(-12, 112), yticks=(0, 50, 100), ylabel="share [%]")


def _aside(panel, points):
    """Transform of data with a shift to the right in points, independent of the limits of the axes."""
    return panel.transData + ScaledTranslation(points / 72, 0, panel.figure.dpi_scale_trans)


def _bounds(panel, flat, weakest):
    """Energy of flat surfaces in saturated air, if any, and of the longest crack within the beam [J m⁻²]."""
    style = {"color": "black", "linewidth": 0.8}
    if flat:
        panel.axhline(TO_MJ * flat, linestyle="-.", label="flat surfaces in saturated air", **style)
    panel.axhline(TO_MJ * weakest, linestyle=":", label="crack as long as the beam", **style)


def _draw_measured(panel, published, beam, models):
    """Measured and published results of Table III, if any."""
    if published.empty:
        return
    humidity = published.relative_humidity.to_numpy()
    energy, bars = energies_with_bars(
        published.experiment.to_numpy() / TO_UM, published.experiment_std.to_numpy() / TO_UM, beam
    )
    style = {"fmt": "D", "color": "black", "markersize": 3, "zorder": 5}
    panel.errorbar(humidity, TO_MJ * energy, TO_MJ * bars, label="measured, mean ± std", **style)
    for model in {"NG", "GEO"}.intersection(models):
        energy = apparent_adhesion_energy(published[model.lower()].to_numpy() / TO_UM, beam)
        style = {"fmt": _MARKERS[model][0], "fillstyle": "none", "color": PUBLISHED, "zorder": 4}
        panel.errorbar(humidity, TO_MJ * energy, transform=_aside(panel, _ASIDE), label=f"{model}: published", **style)


def _band(panel, axis, model):
    """Median and 5-95 % of the energy of the samples, along the humidity."""
    low, median, high = TO_MJ * axis.energy_quantile.transpose("probability", "humidity").values
    style = {"color": MODELS[model]["color"], "label": rf"{model}: median and 5–95 % of $\bar e$"}
    if np.ptp(axis.humidity.values) == 0:
        panel.errorbar(
            axis.humidity[:1],
            median[:1],
            [(median - low)[:1], (high - median)[:1]],
            fmt="_",
            elinewidth=3,
            alpha=0.6,
            **style,
        )
        return
    panel.fill_between(axis.humidity, low, high, alpha=0.25, linewidth=0, color=style["color"])
    panel.plot(axis.humidity, median, linestyle=MODELS[model]["linestyle"], **style)


def _reach(beams):
    """Energy on an axis high enough for the mean and standard deviation of some beams [J m⁻²]."""
    energies = stuck_energies(beams)
    return 1.1 * (energies.mean() + energies.std()) if len(energies) else 0.0


def _draw_simulated(panel, released, model):
    """Mean and standard deviation over the S-shaped beams of every humidity."""
    marker, colour = _MARKERS[model]
    points = [(humidity, _energies(beams)) for (humidity, beam_model), beams in released.items() if beam_model == model]
    bars = [(humidity, e.mean(), e.std(ddof=1)) for humidity, e in points if len(e) > 1]
    humidities, means, deviations = np.reshape(bars, (-1, 3)).T
    style = {"fmt": marker, "color": colour, "markeredgecolor": "black", "markeredgewidth": 0.4}
    style |= {"transform": _aside(panel, -_ASIDE), "zorder": 3, "label": f"{model}: beams, mean ± std"}
    panel.errorbar(humidities, means, deviations, **style)


def _energies(beams):
    """Energies of the S-shaped beams [mJ m⁻²]."""
    return TO_MJ * stuck_energies(beams)


def _labels(panel, released, model, weakest):
    """Annotate shares of S-shaped beams below 100 %.

    Beams of which none is S-shaped get a smaller marker at the energy of the longest crack [mJ m⁻²], and a label below.
    """
    style = {"fontsize": 7, "ha": "left", "path_effects": OUTLINED, "zorder": 6, "textcoords": "offset points"}
    for humidity, share in _shares(released, model):
        if share < 1:
            energies = _energies(released[humidity, model])
            height, below = (energies.mean(), False) if len(energies) else (weakest, True)
            if below:
                marker, colour = _MARKERS[model]
                small = {"markersize": 3, "color": colour, "zorder": 3, "transform": _aside(panel, -_ASIDE)}
                panel.plot(humidity, height, marker, **small)
            away = {"xytext": (-2 * _ASIDE, -4 if below else 4), "va": "top" if below else "bottom"}
            panel.annotate(_percent(share), (humidity, height), **away, **style)


def _percent(share):
    """Fraction below one as text, of two digits."""
    return in_percent(share) if share < 0.995 else "> 99 %"


def _adhesion_energies(data, settings):
    """Energies of all pairs over the humidity, with the published and measured ones."""
    nominal = in_si(Cantilevers, {name: settings[name] for name in ("solid", "beam", "pairs")})
    waters = {pair: in_si(Water, water) for pair, water in settings["water"].items()}
    flat = {pair: flooded_energy(water.temperature, water.contact_angles) for pair, water in waters.items()}
    pairs = {}
    for pair in settings["pairs"]:
        released = {key[1:]: beams for key, beams in data["beams"].items() if key[0] == pair}
        bands = {model: band for (name, model), band in data["humidity"].items() if name == pair}
        pairs[pair] = cantilever(nominal, pair), released, bands
    return adhesion_energies(pairs, published.published_rows(data, settings), flat)


_CATEGORY = "Beams (Secs. IV and V)"
STAGES = (
    figure_stage(
        "figure_14",
        "shapes and crack lengths of beams",
        _CATEGORY,
        inputs=lambda plan, at: {"beams": f"beams/{plan.figure_case}_NG"},
        settings=lambda plan, at: plan.figure_settings,
        compute=beam_shapes,
        targets=("figures",),
    ),
    figure_stage(
        "figure_15",
        "adhesion energy against relative humidity",
        _CATEGORY,
        inputs=lambda plan, at: {
            "beams": by_outcome("beams", plan.outcomes),
            "humidity": by_model("humidity", plan.humid_pairs, SURFACE_MODELS),
            "published": published.file("table_3"),
        },
        settings=lambda plan, at: (
            {"of_paper": plan.paper.pairs}
            | {"water": {pair: plan.air.water(pair) for pair in plan.humid_pairs}}
            | sections(plan, *plan.pairs)
        ),
        compute=_adhesion_energies,
        targets=("figures",),
    ),
)
