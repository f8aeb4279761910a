"""Figures of the beams (Secs. IV-B to V): 14 and 15."""

import numpy as np
from matplotlib.transforms import ScaledTranslation

from stiction.beam.energy import adhesion_energy
from stiction.constants import WATER_SURFACE_ENERGY
from stiction.report.style import DOUBLE, MJ, MODELS, OUTLINED, UM, handles, letter, panels, styled
from stiction.stages.data import ended

#: Work of adhesion of two flats with water between them, 2γ [J m⁻²].
THEORETICAL = 2 * WATER_SURFACE_ENERGY


# Figure 14


@styled
def beam_shapes(beams):
    """Figure 14: shapes of some released beams, one highlighted; histogram of the crack lengths of S-shapes."""
    figure, ((shapes, histogram),) = panels(1, 2, (DOUBLE, 2.5))
    stuck = ended(beams, "S-shape")
    deflection, x = UM * beams.deflection.values, UM * beams.node.values
    shapes.plot(x, deflection.T, color="0.7", linewidth=0.4, rasterized=True)
    for k in np.flatnonzero(stuck[: len(deflection)])[:1]:
        shapes.plot(x, deflection[k], color="black", linewidth=1.4)
    shapes.set(xlabel="position [µm]", ylabel="deflection [µm]", xlim=x[[0, -1]])
    shapes.invert_yaxis()
    crack = UM * beams.crack_length.values[stuck]
    histogram.hist(crack, bins="auto", color="0.75", edgecolor="black")
    histogram.set(xlabel="crack length $l_s$ [µm]", ylabel="number of beams")
    histogram.margins(y=0.15)
    histogram.text(0.97, 0.95, _summary(crack, len(stuck)), ha="right", va="top", transform=histogram.transAxes)
    letter([shapes, histogram], [f"first {len(deflection)} of {len(stuck)} beams", "all beams"])
    return figure


def _summary(crack, total):
    """Number, mean and standard deviation of crack lengths [µm] in words."""
    number = f"{len(crack)} of {total} beams S-shaped"
    return f"{number}\n{crack.mean():.0f} ± {crack.std(ddof=1):.0f} µm" if len(crack) > 1 else number


# Figure 15


def converted(crack_length, deviation, beam):
    """Energies of Eq. (13), and how far below and above them the crack lengths ± ``deviation`` lie.

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
        Below and above: longer cracks are weaker adhesion [J m⁻²].
    """
    energy, low, high = (adhesion_energy(crack_length + sign * deviation, beam) for sign in (0, 1, -1))
    return energy, np.array([energy - low, high - energy])


#: Models of the two columns.
_COLUMNS = ("G", "NG"), ("GEO",)
#: Form of a model, filled where simulated and open where printed, and colour of its simulated markers.
_MARKERS = {"G": ("s", MODELS["G"]["color"]), "NG": ("o", MODELS["NG"]["color"]), "GEO": ("^", "#009E73")}
_PRINTED = "#D55E00"
#: Simulated markers stand this far to the left of their humidity, printed ones to the right, the experiment on it [pt].
_ASIDE = 3


@styled
def adhesion_energies(pairs, printed):
    """Figure 15: apparent adhesion energy over the humidity; models G and NG on the left, GEO on the right.

    Parameters
    ----------
    pairs : dict
        Pair to its nominal beam, a dict of (humidity, model) to the dataset of stage beams, and a dict of model (G, NG)
        to the dataset of stage humidity.
    printed : pandas.DataFrame
        The published Table III.
    """
    figure, axes = panels(len(pairs), 2, (DOUBLE, 2.2 * len(pairs) + 0.6), sharex="row", sharey="row")
    for row, (pair, (beam, released, bands)) in zip(axes, pairs.items(), strict=True):
        weakest = adhesion_energy(beam.length, beam)
        lowest = min(weakest, *(float(axis.energy_quantile.sel(probability=0.5).min()) for axis in bands.values()))
        row[0].set(yscale="log", ylim=(MJ * lowest / 2, 2 * MJ * max(THEORETICAL, weakest)))
        row[0].set_ylabel(r"adhesion energy $\Gamma$ [mJ/m²]")
        for panel, models in zip(row, _COLUMNS, strict=True):
            _bounds(panel, weakest)
            for surface in ("G", "NG") if "G" in models else ("NG",):
                _band(panel, bands[surface], surface)
            _known(panel, printed[printed.pair == pair], beam, models)
            for model in models:
                _released(panel, released, model, weakest)
        row[0].margins(x=0.06)
    for panel in axes[-1]:
        panel.set_xlabel("relative humidity RH [–]")
    letter(axes, [f"pair {pair}, {' and '.join(models)}" for pair in pairs for models in _COLUMNS])
    figure.legend(*handles(*axes.flat), loc="outside upper center", ncols=5, columnspacing=1.2)
    return figure


def _aside(panel, points):
    """Transform of data that draws them some points to the right of their place, whatever the limits."""
    return panel.transData + ScaledTranslation(points / 72, 0, panel.figure.dpi_scale_trans)


def _bounds(panel, weakest):
    """Energy of flat surfaces and of the longest crack that fits into the beam [J m⁻²]."""
    look = {"color": "black", "linewidth": 0.8}
    panel.axhline(MJ * THEORETICAL, linestyle="-.", label=r"flat surfaces, $2\gamma_{LG}$", **look)
    panel.axhline(MJ * weakest, linestyle=":", label="crack as long as the beam", **look)


def _known(panel, printed, beam, models):
    """Experiment and printed results of Table III, where there are any."""
    if printed.empty:
        return
    humidity = printed.relative_humidity.to_numpy()
    energy, bars = converted(printed.experiment.to_numpy() / UM, printed.experiment_std.to_numpy() / UM, beam)
    look = {"fmt": "D", "color": "black", "markersize": 3, "zorder": 5}
    panel.errorbar(humidity, MJ * energy, MJ * bars, label="experiment", **look)
    for model in {"NG", "GEO"}.intersection(models):
        energy = adhesion_energy(printed[model.lower()].to_numpy() / UM, beam)
        look = {"fmt": _MARKERS[model][0], "fillstyle": "none", "color": _PRINTED, "zorder": 4}
        panel.errorbar(humidity, MJ * energy, transform=_aside(panel, _ASIDE), label=f"{model}: printed", **look)


def _band(panel, axis, model):
    """Median and 5-95 % of the energy of the pieces of surface, along the humidity."""
    low, median, high = MJ * axis.energy_quantile.transpose("probability", "humidity").values
    look = {"color": MODELS[model]["color"], "label": rf"{model}: median and 5–95 % of $\bar e$"}
    if axis.sizes["humidity"] == 1:
        panel.errorbar(axis.humidity, median, [median - low, high - median], fmt="_", elinewidth=3, alpha=0.6, **look)
        return
    panel.fill_between(axis.humidity, low, high, alpha=0.25, linewidth=0, color=look["color"])
    panel.plot(axis.humidity, median, linestyle=MODELS[model]["linestyle"], **look)


def _released(panel, released, model, weakest):
    """Mean and standard deviation over the S-shaped beams of every humidity, and their share where it is not all."""
    marker, colour = _MARKERS[model]
    points = [(humidity, beams) for (humidity, which), beams in released.items() if which == model]
    stuck = [MJ * beams.adhesion_energy.values[ended(beams, "S-shape")] for _, beams in points]
    bars = [(humidity, e.mean(), e.std(ddof=1)) for (humidity, _), e in zip(points, stuck, strict=True) if len(e) > 1]
    humidities, means, deviations = np.reshape(bars, (-1, 3)).T
    look = {"fmt": marker, "color": colour, "markeredgecolor": "black", "markeredgewidth": 0.4}
    look |= {"transform": _aside(panel, -_ASIDE), "zorder": 3, "label": f"{model}: beams, mean ± std"}
    panel.errorbar(humidities, means, deviations, **look)
    for (humidity, beams), energies in zip(points, stuck, strict=True):
        _share(
            panel, (humidity, energies.mean() if len(energies) else MJ * weakest), len(energies) / beams.sizes["sample"]
        )


def _share(panel, place, share):
    """Annotate the share of S-shaped beams, unless it is all; where none is, at the energy that none reaches."""
    if share < 1:
        look = {"fontsize": 6, "ha": "center", "path_effects": OUTLINED, "zorder": 6}
        panel.annotate(f"{100 * share:.2g} %", place, (-_ASIDE, 4), textcoords="offset points", **look)
