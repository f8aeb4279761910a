"""Figures of the studies for the main result: 13, 16 to 19 and the model comparison."""

from collections.abc import Mapping
from itertools import groupby, product

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure

from stiction.analysis import convergence
from stiction.analysis import variants as comparison
from stiction.analysis.plasticity import ONSET
from stiction.contact import forcelaw
from stiction.plan.names import by_case, by_name, by_outcome
from stiction.report import published
from stiction.report.format import TO_GPA, TO_MJ, TO_MPA, TO_NM, TO_UM, with_error
from stiction.report.published import rows
from stiction.report.studies.tables import variant_label
from stiction.report.style import (
    DOUBLE,
    OUTLINED,
    SINGLE,
    STUDIES,
    at_most_double,
    blocks_of_columns,
    columns_of_panels,
    dashes,
    figure_stage,
    handles,
    humidity_axis,
    legends,
    letter,
    letter_lines,
    marker,
    on_own_axes,
    panels,
    plain_log,
    shades,
    styled,
)
from stiction.stages.beams.variant_beams import by_pair, cases_of
from stiction.stages.laws.stored_model import chaos_model

_COLOURS = ("#0072B2", "#56B4E9", "#E69F00", "#D55E00", "#CC79A7", "#009E73", "#882255", "#7F7F00", "#332288")
_ZERO = {"color": "0.6", "linewidth": 0.6, "zorder": 0}
#: Element length [µm] chosen in the paper and the difference of Γ from ē [%] stated for it.
_PAPER_LENGTH, _PAPER_ERROR = 7.5, 2.5
#: Number of summits per cell that is drawn in white; a single summit is a little darker.
_FAINTEST = 0.3
_TARGET = {"color": "black", "linestyle": "--", "linewidth": 0.8}
_BOUND = {"color": "0.4", "linestyle": ":"}
#: Largest number of markers of a curve of the variants.
_MARKED = 9
#: What the panels of the variants show.
_DEVIATIONS = "change of $l_s$ against base", "deviation of $l_s$ from published"


# Figure 13


#: What the sensitivities are of.
_STATISTICS = ("mean", "standard deviation")


@styled
def sensitivities(
    datasets: Mapping[tuple[str, str], xr.Dataset], published: Mapping[tuple[str, str, float], float]
) -> Figure:
    """Figure 13: sensitivity of the adhesion energy to the moments of a surface, by pair and moment.

    A line of panels for each pair. Published slopes of the mean are by pair, moment and humidity, if there are some.
    """
    pairs = list(dict.fromkeys(pair for pair, _ in datasets))
    figure, lines = panels(len(pairs), 2, (DOUBLE, 2.6 * len(pairs)), sharex=True, sharey="col")
    for axes, pair in zip(lines, pairs, strict=True):
        of_pair = {moment: dataset for (name, moment), dataset in datasets.items() if name == pair}
        _slopes_of_pair(axes, of_pair, {tuple(at): slope for (name, *at), slope in published.items() if name == pair})
    names = [f", pair {pair}" for pair in pairs] if len(pairs) > 1 else [""]
    letter(lines, [rf"{statistic} of $\bar e${name}" for name in names for statistic in _STATISTICS])
    return figure


def _slopes_of_pair(axes, datasets, published):
    """Sensitivities of mean and standard deviation of one pair, by moment."""
    for panel, statistic in zip(axes, _STATISTICS, strict=True):
        for k, (moment, dataset) in enumerate(datasets.items()):
            chosen = dataset.sel(statistic=statistic)
            style = {"marker": marker(k), "linestyle": dashes(k), "label": moment}
            panel.errorbar(chosen.humidity, chosen.slope, chosen.standard_error, **style)
        panel.axhline(0, **_ZERO)
        panel.set(xlabel="relative humidity [–]", ylabel="normalised sensitivity [–]")
    for k, dataset in enumerate(datasets.values()):
        axes[0].fill_between(dataset.humidity, *dataset.difference.values, color=f"C{k}", alpha=0.15, linewidth=0)
    for (moment, humidity), slope in published.items():
        k = list(datasets).index(moment)
        axes[0].plot(humidity, slope, marker(k), color=f"C{k}", markerfacecolor="none")
    humidity_axis(axes[0])
    for (moment, humidity), slope in published.items():
        _beside(axes[0], f"paper, {moment}", (humidity, slope))
    axes[1].legend(loc="lower right")


def _beside(panel, text, place):
    """Note to the right of a point, or to the left of a point in the right half of a panel."""
    side = -1 if place[0] > np.mean(panel.get_xlim()) else 1
    style = {"textcoords": "offset points", "ha": "left" if side > 0 else "right", "va": "center"}
    panel.annotate(text, place, (5 * side, 0), **style)


# Figure 16


@styled
def summit_stresses(studies: Mapping[str, xr.Dataset]) -> Figure:
    """Figure 16: largest stress of the touching summits, by pair."""
    figure, axes, lines = columns_of_panels(len(studies), 1, at_most_double(SINGLE), 2.6, sharey=True)
    axes = axes[:, 0]
    onsets = [TO_GPA * ONSET * float(dataset.hardness) for dataset in studies.values()]
    top = max(
        [1.15 * max(onsets), *(1.05 * TO_GPA * stress for data in studies.values() for stress in data.stress.values)]
    )
    counts = LogNorm(vmin=_FAINTEST)
    cells = [_cells(panel, dataset, counts, top) for panel, dataset in zip(axes, studies.values(), strict=True)]
    # A bar from 1 to 1 has no length.
    counts.vmax = max([2, *(count for mesh in cells for count in mesh.get_array())])
    for panel, dataset, onset in zip(axes, studies.values(), onsets, strict=True):
        panel.axhline(onset, color="C3", linestyle="--")
        place, style = panel.get_yaxis_transform(), {"ha": "right", "va": "bottom", "path_effects": OUTLINED}
        panel.annotate(r"$0.6\,\sigma_H$", (0.95, onset), (0, 2), place, "offset points", **style)
        panel.text(0.95, 0.04, _share(dataset), transform=panel.transAxes, ha="right", path_effects=OUTLINED)
    names = [rf"pair {pair}, $\bar d$ = {TO_NM * float(dataset.separation):g} nm" for pair, dataset in studies.items()]
    letter(axes, names)
    for line in lines:
        line[0, 0].set_ylabel(r"largest stress $\sigma_{\max}$ [GPa]")
    figure.colorbar(cells[0], ax=axes, label="summits per cell [–]", pad=0.01, aspect=30).ax.set_ylim(1, None)
    return figure


def _cells(panel, dataset, counts, top):
    """Numbers of summits in cells, coloured by ``counts``. All panels reach from 0 to ``top``."""
    interference = TO_NM * dataset.interference
    extent = (0, 1.05 * interference.values.max(initial=0) or 1, 0, top)
    panel.set(xlabel=r"interference $\delta$ [nm]", xlim=extent[:2], ylim=extent[2:])
    style = {"gridsize": (40, 40), "cmap": "Greys", "mincnt": 1, "linewidths": 0.2, "norm": counts}
    return panel.hexbin(interference, TO_GPA * dataset.stress, extent=extent, **style)


def _share(dataset):
    """Fraction of yielding contact area, as text."""
    share, error = float(dataset.plastic_share), float(dataset.plastic_share_error)
    if np.isnan(share):
        return "hardly any contact"
    return f"$A_P/A$ = {with_error(100 * share, 100 * error)} %" if share > 0 else "$A_P$ = 0"


# Figure 17


@styled
def sample_convergence(
    sizes: xr.Dataset, dimension_errors: Mapping[tuple[str, float], np.ndarray], tolerance: float
) -> Figure:
    """Figure 17: convergence in the number of samples and of coordinates.

    ``dimension_errors`` are Err^DR for 1 ... 4 coordinates by pair and humidity, and ``tolerance`` the largest one that
    the model allows [-].
    """
    figure, (axes,) = panels(1, 3, (DOUBLE, 2.4), width_ratios=(1.3, 1, 1))
    _densities(axes[0], sizes)
    shown = _dimension_errors(axes[1], dimension_errors)
    figure.colorbar(shown, ax=axes[1], label="relative humidity [–]", pad=0.02)
    axes[1].axhline(tolerance, **_BOUND, label="tolerance")
    low, high = axes[1].get_ylim()
    axes[1].set_ylim(min(low, tolerance / 2), 3 * high)  # room for the legend
    _distances(axes[2], sizes)
    legends(figure, {axes[0]: {}, axes[1]: {"loc": "upper right"}})
    letter(axes, [r"density of $\bar e$", "variance lost", "distance from all samples"])
    return figure


def _densities(panel, sizes):
    """Densities of ē for increasing numbers of samples."""
    numbers = sizes["size"].values
    for k, (size, shade) in enumerate(zip(numbers, shades(len(numbers)), strict=True)):
        density = sizes.density.sel(size=size)
        style = {"color": shade, "linestyle": dashes(len(numbers) - 1 - k), "label": f"m = {size}"}
        panel.plot(TO_MJ * sizes.energy, density / TO_MJ, **style)
    panel.set(xlabel=r"$\bar e$ [mJ/m²]", ylabel="density [m²/mJ]", ylim=(0, None))


def _distances(panel, sizes):
    """Kolmogorov's distances to all samples and those of independent samples."""
    total = int(sizes["size"][-1])
    part = sizes.isel(size=slice(-1))
    count = np.geomspace(sizes["size"][0] / 1.5, 0.97 * total, 100)
    law = convergence.KOLMOGOROV_MEAN * np.sqrt(1 / count - 1 / total)
    own = convergence.sampling_distance(total)
    panel.plot(count, law, "--", color="0.4", label="independent samples")
    panel.errorbar(part["size"], part.distance, part.distance_error, fmt="o", label=f"m against {total}")
    panel.axhline(own, **_BOUND, label=f"error of {total}")
    panel.set(xscale="log", yscale="log", xlabel="number of samples m", ylabel="Kolmogorov distance [–]")
    panel.set_ylim(own / 8, None)
    plain_log(panel.xaxis)
    plain_log(panel.yaxis)
    panel.legend(loc="lower left")


def _dimension_errors(panel, dimension_errors):
    """Err^DR of every case, one style for each pair and one colour for each humidity; returns the colours."""
    pairs, humidities = (list(dict.fromkeys(parts)) for parts in zip(*dimension_errors, strict=True))
    colours = ScalarMappable(Normalize(min(humidities), max(humidities)), "viridis_r")
    for (pair, humidity), errors in dimension_errors.items():
        k = pairs.index(pair)
        style = {"color": colours.to_rgba(humidity), "marker": marker(k), "linestyle": dashes(k), "markersize": 4}
        panel.plot(range(1, len(errors)), errors[:-1], **style)
    for k, pair in enumerate(pairs):
        panel.plot([], [], color="0.3", marker=marker(k), linestyle=dashes(k), markersize=4, label=f"pair {pair}")
    panel.set(xlabel="number of coordinates $N_g$", ylabel=r"Err$^\mathrm{DR}$ [–]", yscale="log")
    panel.set_xticks(range(1, len(errors)))
    return colours


# Figure 18


@styled
def order_convergence(orders: xr.Dataset) -> Figure:
    """Figure 18: marginals of the chaos model for polynomials of increasing order."""
    etas = orders.eta.values[:3]
    lines = len(etas) // 2 + 1
    figure, axes = panels(lines, 2, (DOUBLE, 2.2 * lines))
    used, unused = np.split(axes.ravel(), [len(etas) + 1])
    for panel in unused:
        panel.remove()
    last = int(orders.order[-1])
    shown = sorted({-(-last * share // 6) for share in (1, 2, 4, 6)})  # 2, 4, 8 and 12 of 12
    for panel, eta in zip(used[:-1], etas, strict=True):
        of_eta = orders.sel(eta=eta)
        panel.fill_between(orders.position, of_eta.input_density, step="mid", color="0.85", label="samples")
        for k, (order, shade) in enumerate(zip(shown, shades(len(shown)), strict=True)):
            style = {"color": shade, "linestyle": dashes(len(shown) - 1 - k), "label": f"$N_d$ = {order}"}
            panel.step(orders.position, of_eta.density.sel(order=order), where="mid", **style)
        panel.set(xlabel=rf"$\eta_{eta}$ [–]", ylabel="density [–]", ylim=(0, None))
        panel.margins(x=0)
    _cumulative(used[0], orders.sel(eta=etas[0]), shown)
    used[0].legend(loc="upper right")
    _order_distances(used[-1], orders)
    letter(used, [*(rf"marginal of $\eta_{eta}$" for eta in etas), "distance from the kernel density"])
    return figure


def _cumulative(panel, of_eta, shown):
    """Inset of the differences of cumulative probabilities, which converge although the density has spikes."""
    inset, position = panel.inset_axes([0.13, 0.47, 0.2, 0.4]), of_eta.position.values
    width = position[1] - position[0]
    for k, (order, shade) in enumerate(zip(shown, shades(len(shown)), strict=True)):
        more = np.cumsum(of_eta.density.sel(order=order).values - of_eta.input_density.values)
        inset.plot(position, 100 * width * more, color=shade, linestyle=dashes(len(shown) - 1 - k), linewidth=0.8)
    inset.set_xlim(position[0], position[-1])
    inset.axhline(0, **_ZERO)
    inset.set_title("cumulative, less samples [%]", fontsize=6, pad=2)
    inset.tick_params(labelsize=6, pad=2)


def _order_distances(panel, orders):
    """Distance of the marginals from the kernel density at every order."""
    for k, eta in enumerate(orders.eta.values):
        distance = orders.distance.sel(target="kernels", eta=eta)
        panel.plot(orders.order, distance, marker=marker(k), linestyle=dashes(k), label=rf"$\eta_{eta}$")
    bound = convergence.sampling_distance(int(orders.samples), int(orders.draws))
    panel.axhline(bound, **_BOUND, label=f"error of {int(orders.samples)} samples")
    panel.set(xlabel="order $N_d$", ylabel="Kolmogorov distance [–]", yscale="log")
    panel.xaxis.get_major_locator().set_params(integer=True)
    panel.set_ylim(bottom=0.25 * min(bound, float(orders.distance.sel(target="kernels").min())))
    plain_log(panel.yaxis)
    panel.legend(loc="lower left", ncols=2)


# Figure 19


@styled
def mesh_convergence(mesh: xr.Dataset, correlation: xr.Dataset) -> Figure:
    """Figure 19: law of the ground, convergence of the mesh, autocorrelation of the surfaces."""
    figure, (axes,) = panels(1, 3, (DOUBLE, 2.9), width_ratios=(1, 1.4, 1))
    _ground(axes[0], mesh)
    _meshes(axes[1], mesh)
    lengths = TO_UM * correlation.correlation_length.values
    for k, (surface, length) in enumerate(zip(correlation.surface.values, lengths, strict=True)):
        curve = correlation.autocorrelation.sel(surface=surface)
        axes[2].plot(TO_UM * correlation.lag, curve, linestyle=dashes(k), label=f"{surface}: $l^m$ = {length:.2f} µm")
    axes[2].axhspan(-0.01, 0.01, color="0.85", zorder=0)
    axes[2].set(xlabel=r"distance $\tau$ [µm]", ylabel=r"$r_Z / m_2$ [–]", xlim=(0, TO_UM * float(correlation.lag[-1])))
    legends(figure, {axes[2]: {}})
    letter(axes, ["force law of a strip", "convergence of the mesh", "autocorrelation"])
    return figure


def _ground(panel, mesh):
    """Computed force curve and its force law."""
    law, distance = mesh.law.values, mesh.distance.values
    near = (distance > law[1] - 1.2 / law[2]) & (distance < law[1] + 6 / law[3])
    panel.plot(TO_NM * distance[near], TO_MPA * mesh.force.values[near], color="0.6", linewidth=3, label="contact")
    panel.plot(
        TO_NM * distance[near], TO_MPA * forcelaw.pressure(law, distance[near]), "k--", label="force law, Eq. (12)"
    )
    panel.axhline(0, **_ZERO)
    panel.set(xlabel=r"distance $\bar d$ [nm]", ylabel=r"force per area $\bar f$ [MPa]")
    panel.legend()


def _meshes(panel, mesh):
    """Energy Γ under every mesh and ē, with an inset of small differences."""
    target = float(forcelaw.energy(mesh.law.values))
    excess = 100 * (mesh.energy.values / target - 1)
    inset = _small_differences(panel, excess, TO_UM * mesh.element_length.values)
    points = np.unique(mesh.point_distance.values)[::-1]
    for k, (point, shade) in enumerate(zip(points, shades(len(points)), strict=True)):
        chosen = mesh.point_distance.values == point
        length, energy = TO_UM * mesh.element_length.values[chosen], TO_MJ * mesh.energy.values[chosen]
        style = {"marker": marker(k), "linestyle": dashes(k), "color": shade, "label": f"{TO_UM * point:.3g}"}
        panel.plot(length, energy, **style)
        inset.plot(length, excess[chosen], **style)
    panel.axhline(TO_MJ * target, label=r"$\bar e$", **_TARGET)
    panel.set(xscale="log", xlabel="element length $l_e$ [µm]", ylabel=r"$\Gamma$ [mJ/m²]", ylim=(0, None))
    # Set limits: if the beam does not stick under this law, ē is the only curve.
    panel.set_xlim(TO_UM * mesh.element_length.values.min() / 1.2, 1.2 * TO_UM * mesh.element_length.values.max())
    plain_log(panel.xaxis)
    panel.legend(loc="upper left", title=r"strips $l^\mathrm{meso}$ [µm]", ncols=2, columnspacing=1, handlelength=1.8)


def _small_differences(panel, excess, lengths):
    """Inset for the differences of Γ from ē about as small as the paper's, which is shaded [%]."""
    inset = panel.inset_axes([0.19, 0.31, 0.52, 0.38])
    near = excess[np.abs(excess) < 1.5 * _PAPER_ERROR]
    low, high = min([0, *near]), max([_PAPER_ERROR, *near])
    inset.axhline(0, **_TARGET)
    inset.axhspan(-_PAPER_ERROR, _PAPER_ERROR, color="0.92", zorder=0)
    inset.annotate(
        f"{_PAPER_ERROR} %, paper", (0.03, _PAPER_ERROR), (0, 2), ("axes fraction", "data"), "offset points", fontsize=6
    )
    limits = lengths.min() / 1.3, 1.3 * max(_PAPER_LENGTH, lengths.min())  # all elements may be longer than the paper's
    inset.set(xscale="log", xlim=limits, ylim=(1.2 * low - 0.2 * high, 1.3 * high))
    inset.set_ylabel(r"$\Gamma/\bar e - 1$ [%]", fontsize=6)
    inset.tick_params(labelsize=6, pad=2)
    plain_log(inset.xaxis)
    return inset


# Model choices


@styled
def variants(datasets: Mapping[tuple[str, str], xr.Dataset], published: pd.DataFrame) -> Figure:
    """Crack lengths under several variants of the model, compared with the base, the paper and measurements.

    More choices than there are colours continue in further panels below, each group of choices with its legend. The
    datasets are by pair and variant, and every pair has every variant; Table III has the rows of the paper's own pairs.
    """
    pairs, names = (list(dict.fromkeys(parts)) for parts in zip(*datasets, strict=True))
    count = 2 if published.pair.isin(pairs).any() else 1
    groups = _groups([name for name in names if name != "base"])
    figure, blocks = blocks_of_columns(
        len(groups), len(pairs), count, at_most_double(1.3 * SINGLE), 1 + 1.8 * count, sharex="col"
    )
    for group, (part, columns, lines) in zip(groups, blocks, strict=True):
        for column, pair in zip(columns, pairs, strict=True):
            chosen = {name: datasets[pair, name] for name in ("base", *group)}
            _column_of_variants(column, chosen, rows(published, pair=pair))
        for line, k in product(lines, range(count)):
            line[k, 0].set_ylabel(on_own_axes(f"{_DEVIATIONS[k]} [%]", line))
        part.legend(*handles(*columns.flat), loc="outside lower center", ncols=5 if len(pairs) > 1 else 3)
    lines = [line for _, _, lines in blocks for line in lines]
    letter_lines(lines, [f"pair {pair}" for pair in pairs] * len(groups))
    return figure


def _groups(names):
    """Choices in groups of at most as many as there are colours. Choices of one key stay together if possible."""
    groups, most = [[]], len(_COLOURS)
    for _, names_of_key in groupby(names, lambda name: name.rpartition("_")[0]):
        of_key = list(names_of_key)
        for part in (of_key[k : k + most] for k in range(0, len(of_key), most)):
            if len(groups[-1]) + len(part) > most:
                groups.append([])
            groups[-1] += part
    return groups


def _column_of_variants(column, datasets, table):
    """Panels of one pair: change against the base and, if the panel is there, deviation from the published length."""
    for name, style in _styles(datasets).items():
        _shift(column[0], datasets[name], datasets["base"], style)
        if len(table):
            _deviation(column[1], datasets[name], table, style)
    if len(table):
        _experiment(column[1], table)
    elif len(column) > 1:  # what is not published needs no panel
        column[1].remove()
        column = column[:1]
        column[0].tick_params(labelbottom=True)
    column[-1].set_xlabel("relative humidity [–]")
    for panel in column:
        panel.axhline(0, **_ZERO)
    humidity_axis(column[0])


def _experiment(panel, table):
    """Deviation of the measured crack length from the published one."""
    measured = 100 * (table.experiment / table.ng - 1), 100 * table.experiment_std / table.ng
    style = {"color": "black", "markerfacecolor": "white", "markersize": 6, "label": "measured", "zorder": 4}
    panel.errorbar(table.relative_humidity, *measured, fmt="*", **style)


def _styles(names):
    """Colour, line and marker of every variant, the base's black and above the others."""
    styles = {"base": {"color": "black", "marker": "o", "linestyle": "-", "label": "base", "zorder": 3}}
    for k, name in enumerate(name for name in names if name != "base"):
        # No more names than colours; the eight other markers and the seven other line styles.
        style = {"color": _COLOURS[k], "marker": marker(1 + k), "linestyle": dashes(1 + k % 7)}
        styles[name] = style | {"label": variant_label(name)}
    return styles


def _shift(panel, dataset, base, style):
    """Change of the crack length by a variant, relative to the base."""
    pairs = zip(cases_of(dataset), cases_of(base), strict=True)
    shifts = [
        (h, *np.divide(comparison.shift(case, of), comparison.mean_crack_length(of)[0])) for (h, case), (_, of) in pairs
    ]
    humidity, shift, error = np.transpose(shifts)
    if dataset is not base:
        _curve(panel, humidity, shift, error, style)


def _deviation(panel, dataset, table, style):
    """Deviation of the crack length from the published one, at humidities with a published value."""
    cases = dict(cases_of(dataset))
    known = {h: length / TO_UM for h, length in zip(table.relative_humidity, table.ng, strict=True) if h in cases}
    if known:
        lengths = [np.divide(comparison.mean_crack_length(cases[h]), length) for h, length in known.items()]
        ratio, error = np.transpose(lengths)
        _curve(panel, [*known], ratio - 1, error, style)


def _curve(panel, humidity, change, error, style):
    """Relative changes as a curve, with markers and error bars of at most `_MARKED` points, for legibility."""
    known = np.flatnonzero(np.isfinite(change))
    marked = known[:: max(1, -(-len(known) // _MARKED))].tolist()
    panel.errorbar(humidity, 100 * change, 100 * error, markevery=marked, errorevery=marked, **style)


def _sensitivities(data, settings):
    """Sensitivities to the moments, and the published ones."""
    stated = published.published_rows(data, settings)
    stated = stated[stated.pair.isin(settings["pairs"]) & stated.moment.isin(settings["moments"])]
    places = zip(stated.pair, stated.moment, stated.relative_humidity, strict=True)
    return sensitivities(data["studies"], dict(zip(places, stated.slope, strict=True)))


def _variants(data, settings):
    """All pairs and variants. A variant without an effect on a pair, left out of the plan, equals the base."""
    known = by_pair(data["studies"])
    pairs, names = (dict.fromkeys(parts) for parts in zip(*known, strict=True))
    whole = {(pair, name): known.get((pair, name), known[pair, "base"]) for pair in pairs for name in names}
    return variants(whole, published.published_rows(data, settings))


def _study(name, shows, **declared):
    """Figure of a study."""
    return figure_stage(
        name,
        shows,
        STUDIES,
        targets=("figures", "study_figures"),
        **declared,
    )


STAGES = (
    _study(
        "figure_13",
        "sensitivity to the moments of a surface",
        study="sensitivity",
        inputs=lambda plan, at: {
            "studies": plan.sensitivities,
            "published": published.file("sensitivity"),
        },
        settings=lambda plan, at: {
            "pairs": plan.figure_pairs,
            "moments": plan.shifted_moments,
            "of_paper": plan.paper.pairs,
        },
        compute=_sensitivities,
    ),
    _study(
        "figure_16",
        "stress of the touching summits",
        study="plasticity",
        inputs=lambda plan, at: {"studies": by_name("studies/plasticity", plan.pressed_pairs)},
        compute=summit_stresses,
        jobs=lambda plan: [{}] if plan.pressed_pairs else [],
    ),
    _study(
        "figure_17",
        "convergence in samples and coordinates",
        study="sample_shares",
        inputs=lambda plan, at: {"sizes": "studies/sample_sizes", "chaos": by_case("chaos", plan.cases, "_NG")},
        settings=lambda plan, at: plan.figure_settings | {"tolerance": plan.config["chaos"]["dimension_tolerance"]},
        compute=lambda data, settings: sample_convergence(
            data["sizes"],
            {key: chaos_model(chaos).dimension_error for key, chaos in data["chaos"].items()},
            settings["tolerance"],
        ),
    ),
    _study(
        "figure_18",
        "convergence in the order of the polynomials",
        study="orders",
        inputs=lambda plan, at: {"orders": "studies/orders"},
        settings=lambda plan, at: plan.figure_settings,
        compute=order_convergence,
    ),
    _study(
        "figure_19",
        "convergence of the mesh, autocorrelation",
        study="mesh",
        inputs=lambda plan, at: {"mesh": "studies/mesh", "correlation": "studies/correlation"},
        settings=lambda plan, at: plan.figure_settings,
        compute=mesh_convergence,
    ),
    _study(
        "variants",
        "Table III under other model choices",
        study="variants",
        inputs=lambda plan, at: {
            "studies": by_outcome("studies/variants", plan.variants.cases),
            "published": published.file("table_3"),
        },
        settings=lambda plan, at: {"of_paper": plan.paper.pairs},
        compute=_variants,
    ),
)
