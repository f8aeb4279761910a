"""Figures of the studies for the main result: 13, 16 to 19 and the model comparison."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.transforms import offset_copy

from stiction.analysis import convergence
from stiction.analysis import variants as comparison
from stiction.analysis.plasticity import ONSET
from stiction.contact import forcelaw
from stiction.contact.air import Air
from stiction.plan.names import by_case, by_name, by_outcome
from stiction.report import dots, published
from stiction.report.format import TO_GPA, TO_MJ, TO_MPA, TO_NM, TO_UM, with_error
from stiction.report.published import rows
from stiction.report.studies.tables import variant_label
from stiction.report.style import (
    DOUBLE,
    OUTLINED,
    SINGLE,
    STUDIES,
    at_most_double,
    columns_of_panels,
    dashes,
    figure_stage,
    handles,
    humidity_axis,
    legend_below,
    legend_outside,
    legends,
    letter,
    letter_lines,
    marker,
    panels,
    plain_log,
    shades,
    styled,
)
from stiction.stages.beams.variant_beams import by_pair, cases_of
from stiction.stages.laws.stored_model import chaos_model

_ZERO = {"color": "0.6", "linewidth": 0.6, "zorder": 0}
#: Difference of Γ from ē [%] that the paper states for its elements.
_PAPER_ERROR = 2.5
#: End of the axis of the errors of meshes over their largest.
_HEADROOM = 2
#: Largest autocorrelation beyond the correlation length, as `stiction.surface.spectrum.correlation_length` has it.
_UNCORRELATED = 0.01
#: Number of summits per cell that is drawn in white; a single summit is a little darker.
_FAINTEST = 0.3
_BOUND = {"color": "0.4", "linestyle": ":"}
#: Distribution of the samples.
_SAMPLES = {"color": "0.75", "linewidth": 4, "label": "samples"}
#: Height of a legend below the panels [in].
_LEGEND = 0.3


# Figure 13


#: What the sensitivities are of.
_STATISTICS = ("mean", "standard deviation")
#: Distance of the moments at a humidity from each other [in].
_ASIDE = 0.06
#: Line between the slopes to less and to more of a moment, and mark of the latter.
_SIDES = {"linewidth": 0.8, "marker": ".", "markersize": 5}
#: The same in words.
_OF_SIDES = "one-sided slopes of the mean: moment down to moment up (dot)"


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
    moments, names_of_moments = handles(lines[0, 1])
    between = Line2D([], [], color="0.3", **_SIDES)
    legend_outside(figure, ([*moments, between], [*names_of_moments, _OF_SIDES]), "lower", 3)
    letter(lines, [rf"{statistic} of $\bar e${name}" for name in names for statistic in _STATISTICS])
    return figure


def _slopes_of_pair(axes, datasets, published):
    """Sensitivities of mean and standard deviation of one pair, by moment."""
    for panel, statistic in zip(axes, _STATISTICS, strict=True):
        for k, (moment, dataset) in enumerate(datasets.items()):
            chosen = dataset.sel(statistic=statistic)
            style = {"marker": marker(k), "linestyle": dashes(k), "label": f"{moment}, ± standard error"}
            style |= {"color": f"C{k}", "transform": _aside(panel, k, len(datasets))}
            panel.errorbar(chosen.humidity, chosen.slope, chosen.standard_error, **style)
            panel.update_datalim(np.c_[chosen.humidity, chosen.slope - chosen.standard_error])
            panel.update_datalim(np.c_[chosen.humidity, chosen.slope + chosen.standard_error])
        panel.axhline(0, **_ZERO)
        panel.set(xlabel="relative humidity [–]", ylabel="normalised sensitivity [–]")
    for k, dataset in enumerate(datasets.values()):
        style = {"color": f"C{k}", "transform": _aside(axes[0], k, len(datasets)), "markevery": [1], **_SIDES}
        for humidity, ends in zip(dataset.humidity.values, dataset.difference.values.T, strict=True):
            axes[0].plot([humidity] * 2, ends, **style)
            axes[0].update_datalim(np.c_[[humidity] * 2, ends])
    for (moment, humidity), slope in published.items():
        k = list(datasets).index(moment)
        style = {"color": f"C{k}", "transform": _aside(axes[0], k, len(datasets)), "markerfacecolor": "none"}
        axes[0].plot(humidity, slope, marker(k), **style)
        axes[0].update_datalim([(humidity, slope)])
    for panel in axes:
        panel.autoscale_view()
    humidity_axis(axes[0])
    for (moment, humidity), slope in published.items():
        _beside(axes[0], f"paper, {moment}", (humidity, slope), 5 + 36 * _ASIDE * (len(datasets) - 1))


def _aside(panel, k, count):
    """Transform of the data of moment ``k`` of some, beside the others at its humidity."""
    return offset_copy(panel.transData, panel.figure, _ASIDE * (k - (count - 1) / 2), 0)


def _beside(panel, text, point, apart):
    """Note some points to the right of a point, or to the left of one in the right half of a panel."""
    side = -1 if point[0] > np.mean(panel.get_xlim()) else 1
    style = {"textcoords": "offset points", "ha": "left" if side > 0 else "right", "va": "center"}
    panel.annotate(text, point, (apart * side, 0), path_effects=OUTLINED, **style)


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
        transform, style = panel.get_yaxis_transform(), {"ha": "right", "va": "bottom", "path_effects": OUTLINED}
        panel.annotate(f"yield, {ONSET:g} hardness", (0.95, onset), (0, 2), transform, "offset points", **style)
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
    return f"yielding: {with_error(100 * share, 100 * error)} %" if share > 0 else "none yields"


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
    most = _dimension_errors(axes[1], dimension_errors)
    axes[1].axhline(tolerance, **_BOUND, label=f"tolerance,\nabove: {most + 1} kept")
    low, high = axes[1].get_ylim()
    axes[1].set_ylim(min(low, tolerance / 2), 10 * max(high, tolerance))  # room for the legend
    _distances(axes[2], sizes)
    legends(figure, {axes[0]: {}, axes[1]: {"loc": "upper right", "ncols": 2}})
    letter(axes, [r"density of $\bar e$", f"variance lost, $N_g$ = {most}", "distance from all samples"])
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
    subsets = sizes.isel(size=slice(-1))
    count = np.geomspace(sizes["size"][0] / 1.5, 0.97 * total, 100)
    law = convergence.KOLMOGOROV_MEAN * np.sqrt(1 / count - 1 / total)
    error_of_all = convergence.sampling_distance(total)
    panel.plot(count, law, "--", color="0.4", label="independent samples")
    panel.errorbar(subsets["size"], subsets.distance, subsets.distance_error, fmt="o", label=f"m against {total}")
    panel.axhline(error_of_all, **_BOUND, label=f"error of {total}")
    panel.set(xscale="log", yscale="log", xlabel="number of samples m", ylabel="Kolmogorov distance [–]")
    panel.set_ylim(error_of_all / 8, None)
    plain_log(panel.xaxis)
    plain_log(panel.yaxis)
    panel.legend(loc="lower left")


def _dimension_errors(panel, dimension_errors):
    """Err^DR with all coordinates but one against humidity, a line for each pair; returns their number."""
    for k, pair in enumerate(dict.fromkeys(pair for pair, _ in dimension_errors)):
        points = sorted((humidity, errors[-2]) for (name, humidity), errors in dimension_errors.items() if name == pair)
        panel.plot(*zip(*points, strict=True), marker=marker(k), linestyle=dashes(k), label=f"pair {pair}")
    panel.set(xlabel="relative humidity [–]", ylabel=r"Err$^\mathrm{DR}$ [–]", yscale="log")
    humidity_axis(panel)
    return max(len(errors) for errors in dimension_errors.values()) - 1


# Figure 18


@styled
def order_convergence(orders: xr.Dataset) -> Figure:
    """Figure 18: cumulative marginals of the chaos model for polynomials of increasing order."""
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
        width = float(orders.position[1] - orders.position[0])
        panel.plot(orders.position, width * np.cumsum(of_eta.input_density.values), **_SAMPLES)
        for k, (order, shade) in enumerate(zip(shown, shades(len(shown)), strict=True)):
            style = {"color": shade, "linestyle": dashes(len(shown) - 1 - k), "label": f"$N_d$ = {order}"}
            panel.plot(orders.position, width * np.cumsum(of_eta.density.sel(order=order).values), **style)
        panel.set(xlabel=rf"$\eta_{eta}$ [–]", ylabel="cumulative probability [–]")
        panel.margins(x=0)
    used[0].legend(loc="upper left")
    _order_distances(used[-1], orders)
    letter(used, [*(rf"marginal of $\eta_{eta}$" for eta in etas), "distance from the kernel density"])
    return figure


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
    label = rf"all beyond $l^m$: ± {_UNCORRELATED:g}"
    axes[2].axhspan(-_UNCORRELATED, _UNCORRELATED, color="0.85", zorder=0, label=label)
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
    """Relative difference of Γ under every mesh from ē, beside the one stated in the paper."""
    excess = 100 * (mesh.energy.values / float(forcelaw.energy(mesh.law.values)) - 1)
    panel.axhspan(-_PAPER_ERROR, _PAPER_ERROR, color="0.92", zorder=0, label=f"paper's {_PAPER_ERROR} %")
    points = np.unique(mesh.point_distance.values)[::-1]
    for k, (point, shade) in enumerate(zip(points, shades(len(points)), strict=True)):
        chosen = mesh.point_distance.values == point
        style = {
            "marker": marker(k),
            "linestyle": dashes(k),
            "color": shade,
            "label": f"strips of {TO_UM * point:.3g} µm",
        }
        panel.plot(TO_UM * mesh.element_length.values[chosen], excess[chosen], **style)
    panel.axhline(0, **_ZERO)
    panel.set_yscale("symlog", linthresh=_PAPER_ERROR, linscale=0.5)
    panel.yaxis.set_major_formatter("{x:g}")
    panel.set_ylim(1.3 * np.nanmin(excess, initial=-1), _HEADROOM * np.nanmax(excess, initial=_PAPER_ERROR))
    panel.set(xscale="log", xlabel="element length $l_e$ [µm]", ylabel=r"$\Gamma/\bar e - 1$ [%]")
    # Set limits: a beam that does not stick under this law has no points.
    panel.set_xlim(TO_UM * mesh.element_length.values.min() / 1.2, 1.2 * TO_UM * mesh.element_length.values.max())
    plain_log(panel.xaxis)
    entries = [*handles(panel)[0], Line2D([], [], linestyle="", label=f"axis linear below {_PAPER_ERROR} %")]
    legend_below(panel, entries)


# Model choices


@styled
def variants(datasets: Mapping[tuple[str, str], xr.Dataset], published: pd.DataFrame) -> Figure:
    """Change of the crack length by each variant of the model at the lowest humidity, a panel for each pair.

    Lines: published and measured lengths. The datasets are by pair and variant, and every pair has every variant;
    Table III has the rows of the paper's own pairs.
    """
    pairs, names = (list(dict.fromkeys(parts)) for parts in zip(*datasets, strict=True))
    height = dots.AROUND + _LEGEND + dots.ROW * (1 + len(names))
    figure, columns, lines = columns_of_panels(len(pairs), 1, at_most_double(1.3 * SINGLE), height, sharey=True)
    titles = []
    for (panel,), pair in zip(columns, pairs, strict=True):
        humidity, base = next(cases_of(datasets[pair, "base"]))
        cases = {name: next(cases_of(datasets[pair, name]))[1] for name in names if name != "base"}
        length = TO_UM * comparison.mean_crack_length(base)[0]
        of_base = f"base: beams on {len(base.energy)} samples"
        dots.references(panel, length, of_base, rows(published, pair=pair, relative_humidity=humidity))
        dots.draw(panel, {variant_label(name): [_shift(case, base)] for name, case in cases.items()}, column="[%]")
        panel.set_xlabel("change of $l_s$ [%]")
        titles.append(f"pair {pair}, {Air(humidity).words}")
    letter_lines(lines, titles)
    legend_outside(figure, handles(*columns.flat), "lower", 3)
    return figure


def _shift(case, base):
    """Change of the crack length by a variant, relative to the base [%]."""
    shift, error = 100 * np.divide(comparison.shift(case, base), comparison.mean_crack_length(base)[0])
    return dots.Mark(shift, shift, "#0072B2", dots.signed(shift), error, "variant ± standard error")


def _sensitivities(data, settings):
    """Sensitivities to the moments, and the published ones."""
    stated = published.published_rows(data, settings)
    stated = stated[stated.pair.isin(settings["pairs"]) & stated.moment.isin(settings["moments"])]
    places = zip(stated.pair, stated.moment, stated.relative_humidity, strict=True)
    return sensitivities(data["studies"], dict(zip(places, stated.slope, strict=True)))


def _variants(data, settings):
    """All pairs and variants. A variant without an effect on a pair, left out of the plan, equals the base."""
    studies = by_pair(data["studies"])
    pairs, names = (dict.fromkeys(parts) for parts in zip(*studies, strict=True))
    all_studies = {(pair, name): studies.get((pair, name), studies[pair, "base"]) for pair in pairs for name in names}
    return variants(all_studies, published.published_rows(data, settings))


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
