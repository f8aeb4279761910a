"""Figures of the studies beside the main line: 13, 16 to 19 and the readings of what the paper leaves open."""

from itertools import cycle

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import LogNorm

from stiction.constants import HARDNESS
from stiction.contact import forcelaw
from stiction.report.style import DOUBLE, MJ, MPA, NM, OUTLINED, SINGLE, UM, handles, letter, panels, plain_log, styled
from stiction.report.tables_studies import cases_of, reading_label, with_error
from stiction.studies import convergence
from stiction.studies import variants as choices
from stiction.studies.plasticity import ONSET

GPA = 1e-9
_MARKERS = ("o", "s", "^", "v", "D", "P", "X", "<", ">")
_COLOURS = ("#0072B2", "#56B4E9", "#E69F00", "#D55E00", "#CC79A7", "#009E73", "#882255", "#7F7F00")
_DASHES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2)), (0, (1, 3)), (0, (4, 4)))
_ZERO = {"color": "0.6", "linewidth": 0.6, "zorder": 0}
#: Element length [µm] that the paper chooses and the difference of Γ from ē [%] that it states there.
_PAPER_LENGTH, _PAPER_ERROR = 7.5, 2.5
#: A single summit is a little darker than this number of them, which is white.
_FAINTEST = 0.3
_TARGET = {"color": "black", "linestyle": "--", "linewidth": 0.8}
_BOUND = {"color": "0.4", "linestyle": ":"}


def _shades(count):
    """Colours that darken from the first to the last, also in grey."""
    return colormaps["viridis_r"](np.linspace(0.15, 1, count))


# Figure 13


@styled
def sensitivities(datasets, printed):
    """Figure 13: sensitivity of the adhesion energy to the moments of a surface.

    Parameters
    ----------
    datasets : dict
        Moment to the dataset of study sensitivity.
    printed : dict
        (moment, humidity) to the slope of the mean that the paper states.
    """
    figure, (axes,) = panels(1, 2, (DOUBLE, 2.6), sharex=True)
    statistics = ("mean", "standard deviation")
    for panel, statistic in zip(axes, statistics, strict=True):
        for (moment, dataset), marker, dashes in zip(datasets.items(), _MARKERS, _DASHES, strict=False):
            found = dataset.sel(statistic=statistic)
            look = {"marker": marker, "linestyle": dashes, "label": moment}
            panel.errorbar(found.humidity, found.slope, found.standard_error, **look)
        panel.axhline(0, **_ZERO)
        panel.set(xlabel="relative humidity [–]", ylabel="normalised sensitivity [–]")
    for (moment, humidity), slope in printed.items():
        k = list(datasets).index(moment)
        axes[0].plot(humidity, slope, _MARKERS[k], color=f"C{k}", markerfacecolor="none")
        axes[0].annotate(f"paper, {moment}", (humidity, slope), (5, 0), textcoords="offset points", va="center")
    letter(axes, [rf"{statistic} of $\bar e$" for statistic in statistics])
    axes[1].legend(loc="lower right")
    return figure


# Figure 16


@styled
def summit_stresses(datasets):
    """Figure 16: largest stress of the touching summits.

    Parameters
    ----------
    datasets : dict
        Pair to the dataset of study plasticity.
    """
    figure, (axes,) = panels(1, len(datasets), (min(DOUBLE, SINGLE * len(datasets)), 2.6), sharey=True)
    onset = GPA * ONSET * HARDNESS
    top = max([1.15 * onset, *(1.05 * GPA * stress for data in datasets.values() for stress in data.stress.values)])
    counts = LogNorm(vmin=_FAINTEST)
    cells = [_cells(panel, dataset, counts, top) for panel, dataset in zip(axes, datasets.values(), strict=True)]
    # A bar from 1 to 1 has no length.
    counts.vmax = max([2, *(count for found in cells for count in found.get_array())])
    for panel, dataset in zip(axes, datasets.values(), strict=True):
        panel.axhline(onset, color="C3", linestyle="--")
        place, look = panel.get_yaxis_transform(), {"ha": "right", "va": "bottom", "path_effects": OUTLINED}
        panel.annotate(r"$0.6\,\sigma_H$", (0.95, onset), (0, 2), place, "offset points", **look)
        panel.text(0.95, 0.04, _share(dataset), transform=panel.transAxes, ha="right", path_effects=OUTLINED)
    names = [rf"pair {pair}, $\bar d$ = {NM * float(found.separation):g} nm" for pair, found in datasets.items()]
    letter(axes, names)
    axes[0].set_ylabel(r"largest stress $\sigma_{\max}$ [GPa]")
    figure.colorbar(cells[0], ax=axes, label="summits per cell [–]", pad=0.01, aspect=30).ax.set_ylim(1, None)
    return figure


def _cells(panel, dataset, counts, top):
    """Numbers of summits in cells, coloured by ``counts``; all panels reach from 0 to ``top``."""
    interference = NM * dataset.interference
    extent = (0, 1.05 * interference.values.max(initial=0) or 1, 0, top)
    panel.set(xlabel=r"interference $\delta$ [nm]", xlim=extent[:2], ylim=extent[2:])
    look = {"gridsize": (40, 40), "cmap": "Greys", "mincnt": 1, "linewidths": 0.2, "norm": counts}
    return panel.hexbin(interference, GPA * dataset.stress, extent=extent, **look)


def _share(dataset):
    """Share of the contact area that yields, in words."""
    share, error = float(dataset.plastic_share), float(dataset.plastic_share_error)
    if np.isnan(share):
        return "hardly any contact"
    return f"$A_P/A$ = {with_error(100 * share, 100 * error)} %" if share > 0 else "$A_P$ = 0"


# Figure 17


@styled
def sample_convergence(sizes, dimension_errors, tolerance):
    """Figure 17: convergence in the number of samples and of coordinates.

    Parameters
    ----------
    sizes : Dataset
        Study sample_sizes.
    dimension_errors : dict
        (pair, humidity) to Err^DR for 1 ... 4 coordinates [-].
    tolerance : float
        Err^DR that the model may have [-].
    """
    figure, (axes,) = panels(1, 3, (DOUBLE, 2.4), width_ratios=(1.3, 1, 1))
    _densities(axes[0], sizes)
    _dimension_errors(axes[1], dimension_errors)
    axes[1].axhline(tolerance, **_BOUND, label="tolerance")
    low, high = axes[1].get_ylim()
    axes[1].set_ylim(min(low, tolerance / 2), 3 * high)  # room for the legend
    axes[1].legend(loc="upper right")
    _distances(axes[2], sizes)
    letter(axes, [r"density of $\bar e$", "variance lost", "distance from all samples"])
    return figure


def _densities(panel, sizes):
    """Densities of ē for more and more samples."""
    numbers = sizes["size"].values
    for size, shade, dashes in zip(numbers, _shades(len(numbers)), _DASHES[len(numbers) - 1 :: -1], strict=False):
        density = sizes.density.sel(size=size)
        panel.plot(MJ * sizes.energy, density / MJ, color=shade, linestyle=dashes, label=f"m = {size}")
    panel.set(xlabel=r"$\bar e$ [mJ/m²]", ylabel="density [m²/mJ]", ylim=(0, None))
    panel.legend()


def _distances(panel, sizes):
    """Kolmogorov's distances to all samples and what independent samples give."""
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
    """Err^DR of every case, one look per pair."""
    pairs = list(dict.fromkeys(pair for pair, _ in dimension_errors))
    seen = set()
    for (pair, _), errors in dimension_errors.items():
        k = pairs.index(pair)
        label = {"label": f"pair {pair}"} if pair not in seen else {}
        panel.plot(range(1, len(errors)), errors[:-1], color=f"C{k}", marker=_MARKERS[k], linestyle=_DASHES[k], **label)
        seen.add(pair)
    panel.set(xlabel="number of coordinates $N_g$", ylabel=r"Err$^\mathrm{DR}$ [–]", yscale="log")
    panel.set_xticks(range(1, len(errors)))


# Figure 18


@styled
def order_convergence(orders):
    """Figure 18: marginals of the chaos model for polynomials of increasing order.

    Parameters
    ----------
    orders : Dataset
        Study orders.
    """
    figure, axes = panels(2, 2, (DOUBLE, 4.4))
    last = int(orders.order[-1])
    shown = sorted({-(-last * share // 6) for share in (1, 2, 4, 6)})  # 2, 4, 8 and 12 of 12
    for panel, eta in zip(axes.flat, orders.eta.values[:3], strict=False):
        found = orders.sel(eta=eta)
        panel.fill_between(orders.position, found.input_density, step="mid", color="0.85", label="samples")
        for order, shade, dashes in zip(shown, _shades(len(shown)), _DASHES[len(shown) - 1 :: -1], strict=False):
            look = {"color": shade, "linestyle": dashes, "label": f"$N_d$ = {order}"}
            panel.step(orders.position, found.density.sel(order=order), where="mid", **look)
        panel.set(xlabel=rf"$\eta_{eta}$ [–]", ylabel="density [–]", ylim=(0, None))
        panel.margins(x=0)
    axes[0, 0].legend()
    _order_distances(axes[1, 1], orders)
    letter(axes, [*(rf"marginal of $\eta_{k}$" for k in (1, 2, 3)), "distance from the kernel density"])
    return figure


def _order_distances(panel, orders):
    """Distance of the marginals to the kernel density at every order."""
    for eta, marker, dashes in zip(orders.eta.values, _MARKERS, _DASHES, strict=False):
        distance = orders.distance.sel(target="kernels", eta=eta)
        panel.plot(orders.order, distance, marker=marker, linestyle=dashes, label=rf"$\eta_{eta}$")
    bound = convergence.sampling_distance(int(orders.samples))
    panel.axhline(bound, **_BOUND, label=f"error of {int(orders.samples)} samples")
    panel.set(xlabel="order $N_d$", ylabel="Kolmogorov distance [–]", yscale="log")
    panel.xaxis.get_major_locator().set_params(integer=True)
    panel.set_ylim(bottom=0.25 * min(bound, float(orders.distance.sel(target="kernels").min())))
    plain_log(panel.yaxis)
    panel.legend(loc="lower left", ncols=2)


# Figure 19


@styled
def mesh_convergence(mesh, correlation):
    """Figure 19: law of the ground, convergence of the mesh, autocorrelation of the surfaces.

    Parameters
    ----------
    mesh, correlation : Dataset
        Studies of these names.
    """
    figure, (axes,) = panels(1, 3, (DOUBLE, 2.9), width_ratios=(1, 1.4, 1))
    _ground(axes[0], mesh)
    _meshes(axes[1], mesh)
    lengths = UM * correlation.correlation_length.values
    for surface, length, dashes in zip(correlation.surface.values, lengths, _DASHES, strict=False):
        curve = correlation.autocorrelation.sel(surface=surface)
        axes[2].plot(UM * correlation.lag, curve, linestyle=dashes, label=f"{surface}: $l^m$ = {length:.2f} µm")
    axes[2].axhspan(-0.01, 0.01, color="0.85", zorder=0)
    axes[2].set(xlabel=r"distance $\tau$ [µm]", ylabel=r"$r_Z / m_2$ [–]", xlim=(0, UM * float(correlation.lag[-1])))
    axes[2].legend()
    letter(axes, ["law of the ground", "energy under every mesh", "autocorrelation"])
    return figure


def _ground(panel, mesh):
    """Computed curve and the law that stands for it."""
    law, distance = mesh.law.values, mesh.distance.values
    near = (distance > law[1] - 1.2 / law[2]) & (distance < law[1] + 6 / law[3])
    panel.plot(NM * distance[near], MPA * mesh.force.values[near], color="0.6", linewidth=3, label="contact")
    panel.plot(NM * distance[near], MPA * forcelaw.pressure(law, distance[near]), "k--", label="Eq. (12)")
    panel.axhline(0, **_ZERO)
    panel.set(xlabel=r"distance $\bar d$ [nm]", ylabel=r"force per area $\bar f$ [MPa]")
    panel.legend()


def _meshes(panel, mesh):
    """Energy Γ under every mesh beside ē; in an inset the difference where it is small."""
    target = float(forcelaw.energy(mesh.law.values))
    excess = 100 * (mesh.energy.values / target - 1)
    inset = _small_differences(panel, excess, UM * mesh.element_length.values)
    points = np.unique(mesh.point_distance.values)[::-1]
    for point, shade, marker, dashes in zip(points, _shades(len(points)), _MARKERS, _DASHES, strict=False):
        chosen = mesh.point_distance.values == point
        length, energy = UM * mesh.element_length.values[chosen], MJ * mesh.energy.values[chosen]
        look = {"marker": marker, "linestyle": dashes, "color": shade, "label": f"{UM * point:.3g}"}
        panel.plot(length, energy, **look)
        inset.plot(length, excess[chosen], **look)
    panel.axhline(MJ * target, label=r"$\bar e$", **_TARGET)
    panel.set(xscale="log", xlabel="element length $l_e$ [µm]", ylabel=r"$\Gamma$ [mJ/m²]", ylim=(0, None))
    # Limits of its own: under a law that lets the beam go there is nothing but ē to draw.
    panel.set_xlim(UM * mesh.element_length.values.min() / 1.2, 1.2 * UM * mesh.element_length.values.max())
    plain_log(panel.xaxis)
    panel.legend(loc="upper left", title=r"$l^\mathrm{meso}$ [µm]", ncols=2, columnspacing=1, handlelength=1.8)


def _small_differences(panel, excess, lengths):
    """Inset for the differences of Γ from ē [%] that are about as small as the paper's, which it shades."""
    inset = panel.inset_axes([0.19, 0.31, 0.52, 0.38])
    near = excess[np.abs(excess) < 1.5 * _PAPER_ERROR]
    low, high = min([0, *near]), max([_PAPER_ERROR, *near])
    inset.axhline(0, **_TARGET)
    inset.axhspan(-_PAPER_ERROR, _PAPER_ERROR, color="0.92", zorder=0)
    inset.annotate(
        f"{_PAPER_ERROR} %, paper", (0.03, _PAPER_ERROR), (0, 2), ("axes fraction", "data"), "offset points", fontsize=6
    )
    inset.set(xscale="log", xlim=(lengths.min() / 1.3, 1.3 * _PAPER_LENGTH), ylim=(1.2 * low - 0.2 * high, 1.3 * high))
    inset.set_ylabel(r"$\Gamma/\bar e - 1$ [%]", fontsize=6)
    inset.tick_params(labelsize=6, pad=2)
    plain_log(inset.xaxis)
    return inset


# Readings of what the paper leaves open


@styled
def readings(datasets, printed):
    """Crack lengths under several readings, against the base reading and against print and experiment.

    Parameters
    ----------
    datasets : dict
        (pair, reading) to the dataset of study readings.
    printed : pandas.DataFrame
        Table III as published.
    """
    pairs, names = (list(dict.fromkeys(parts)) for parts in zip(*datasets, strict=True))
    rows = 2 if printed.pair.isin(pairs).any() else 1
    figure, axes = panels(rows, len(pairs), (min(DOUBLE, 1.3 * SINGLE * len(pairs)), 1 + 1.8 * rows), sharex="col")
    for column, pair in zip(axes.T, pairs, strict=True):
        table = printed[printed.pair == pair]
        for name, look in _looks(names).items():
            _shift(column[0], datasets[pair, name], datasets[pair, "base"], look)
            if len(table):
                _deviation(column[1], datasets[pair, name], table, look)
        if len(table):
            _experiment(column[1], table)
        elif rows > 1:
            column[1].text(0.5, 0.6, "not printed", transform=column[1].transAxes, ha="center", color="0.5")
        column[-1].set_xlabel("relative humidity [–]")
        for panel in column:
            panel.axhline(0, **_ZERO)
    for panel, deviation in zip(
        axes[:, 0], ("change of $l_s$ against base", "deviation of $l_s$ from print"), strict=False
    ):
        panel.set_ylabel(f"{deviation} [%]")
    letter(axes, [f"pair {pair}" for pair in pairs] * rows)
    figure.legend(*handles(*axes.flat), loc="outside lower center", ncols=5)
    return figure


def _experiment(panel, table):
    """Deviation of the measured crack length from the printed one."""
    measured = 100 * (table.experiment / table.ng - 1), 100 * table.experiment_std / table.ng
    look = {"color": "black", "markerfacecolor": "white", "markersize": 6, "label": "experiment", "zorder": 4}
    panel.errorbar(table.relative_humidity, *measured, fmt="*", **look)


def _looks(names):
    """Colour, line and marker of every reading; base black and above the others."""
    looks = {"base": {"color": "black", "marker": "o", "linestyle": "-", "label": "base", "zorder": 3}}
    others = [name for name in names if name != "base"]
    for name, colour, marker, dashes in zip(
        others, cycle(_COLOURS), cycle(_MARKERS[1:]), cycle(_DASHES[1:]), strict=False
    ):
        looks[name] = {"color": colour, "marker": marker, "linestyle": dashes, "label": reading_label(name)}
    return looks


def _shift(panel, dataset, base, look):
    """Change of the crack length by a reading, relative to the base."""
    both = zip(cases_of(dataset), cases_of(base), strict=True)
    shifts = [(h, *np.divide(choices.shift(case, of), choices.mean_crack_length(of)[0])) for (h, case), (_, of) in both]
    humidity, shift, error = np.transpose(shifts)
    if dataset is not base:
        panel.errorbar(humidity, 100 * shift, 100 * error, **look)


def _deviation(panel, dataset, table, look):
    """Deviation of the crack length from the printed one, where there is one."""
    cases = dict(cases_of(dataset))
    of_print = {h: length / UM for h, length in zip(table.relative_humidity, table.ng, strict=True) if h in cases}
    if of_print:
        lengths = [np.divide(choices.mean_crack_length(cases[h]), length) for h, length in of_print.items()]
        ratio, error = np.transpose(lengths)
        panel.errorbar([*of_print], 100 * (ratio - 1), 100 * error, **look)
