"""Figures of the beams (Secs. IV-B to V): 14 and 15."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.transforms import ScaledTranslation

from stiction.beam.cantilever import Beam
from stiction.beam.energy import apparent_adhesion_energy
from stiction.models import SURFACE_MODELS
from stiction.report.format import TO_MJ, TO_UM, with_error
from stiction.report.published import rows
from stiction.report.style import (
    DOUBLE,
    MODELS,
    OUTLINED,
    PUBLISHED,
    handles,
    humidity_axis,
    letter,
    panels,
    styled,
)
from stiction.stages.releases import ended, stuck_energies, stuck_lengths

# Figure 14


@styled
def beam_shapes(beams: xr.Dataset) -> Figure:
    """Figure 14: shapes of some released beams, one highlighted; histogram of the crack lengths of S-shapes."""
    figure, ((shapes, histogram),) = panels(1, 2, (DOUBLE, 2.5))
    stuck = ended(beams, "S-shape")
    deflection, x = TO_UM * beams.deflection.values, TO_UM * beams.node.values
    shapes.plot(x, deflection.T, color="0.7", linewidth=0.4, rasterized=True)
    for k in np.flatnonzero(stuck[: len(deflection)])[:1]:
        shapes.plot(x, deflection[k], color="black", linewidth=1.4)
    shapes.set(xlabel="position [µm]", ylabel="deflection [µm]", xlim=x[[0, -1]])
    shapes.invert_yaxis()
    crack = TO_UM * stuck_lengths(beams)
    histogram.hist(crack, bins="auto", color="0.75", edgecolor="black")
    histogram.set(xlabel="crack length $l_s$ [µm]", ylabel="number of beams")
    histogram.margins(y=0.15)
    histogram.text(0.97, 0.95, _summary(crack, len(stuck)), ha="right", va="top", transform=histogram.transAxes)
    letter([shapes, histogram], [f"first {len(deflection)} of {len(stuck)} beams", "all beams"])
    return figure


def _summary(crack, total):
    """Number, mean and standard deviation of crack lengths [µm] as text."""
    number = f"{len(crack)} of {total} beams S-shaped"
    return f"{number}\n{with_error(crack.mean(), crack.std(ddof=1))} µm" if len(crack) > 1 else number


# Figure 15


def converted(crack_length: np.ndarray, deviation: np.ndarray, beam: Beam) -> tuple[np.ndarray, np.ndarray]:
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


@styled
def adhesion_energies(pairs: Mapping[str, tuple], published: pd.DataFrame, flat: float) -> Figure:
    """Figure 15: apparent adhesion energy over the humidity; models G and NG on the left, GEO on the right.

    Parameters
    ----------
    pairs : dict
        Pair to its nominal beam, a dict of (humidity, model) to the dataset of stage beams, and a dict of model (G, NG)
        to the dataset of stage humidity.
    published : pandas.DataFrame
        The published Table III, rows of the paper's own pairs.
    flat : float
        Work of adhesion of two flats with water between them, 2γ [J m⁻²].
    """
    figure, axes = panels(len(pairs), 2, (DOUBLE, 2.2 * len(pairs) + 0.6), sharex="row", sharey="row")
    for row, (pair, (beam, released, bands)) in zip(axes, pairs.items(), strict=True):
        weakest = apparent_adhesion_energy(beam.length, beam)
        lowest = min(weakest, *(float(axis.energy_quantile.sel(probability=0.5).min()) for axis in bands.values()))
        highest = max(2 * flat, 2 * weakest, *map(_reach, released.values()))
        row[0].set(yscale="log", ylim=(TO_MJ * lowest / 2, TO_MJ * highest))
        row[0].set_ylabel(r"adhesion energy $\Gamma$ [mJ/m²]")
        for panel, models in zip(row, _COLUMNS, strict=True):
            _bounds(panel, flat, weakest)
            for surface in SURFACE_MODELS if "G" in models else ("NG",):
                _band(panel, bands[surface], surface)
            _known(panel, rows(published, pair=pair), beam, models)
            for model in models:
                _released(panel, released, model, weakest)
        row[0].margins(x=0.06)
        humidity_axis(row[0])
    for panel in axes[-1]:
        panel.set_xlabel("relative humidity RH [–]")
    letter(axes, [f"pair {pair}, {' and '.join(models)}" for pair in pairs for models in _COLUMNS])
    figure.legend(*handles(*axes.flat), loc="outside upper center", ncols=5, columnspacing=1.2)
    return figure


def _aside(panel, points):
    """Transform of data with a shift to the right in points, which does not depend on the limits of the axes."""
    return panel.transData + ScaledTranslation(points / 72, 0, panel.figure.dpi_scale_trans)


def _bounds(panel, flat, weakest):
    """Energy of flat surfaces and of the longest crack that fits into the beam [J m⁻²]."""
    style = {"color": "black", "linewidth": 0.8}
    panel.axhline(TO_MJ * flat, linestyle="-.", label=r"flat surfaces, $2\gamma_{LG}$", **style)
    panel.axhline(TO_MJ * weakest, linestyle=":", label="crack as long as the beam", **style)


def _known(panel, published, beam, models):
    """Measured and published results of Table III, if any."""
    if published.empty:
        return
    humidity = published.relative_humidity.to_numpy()
    energy, bars = converted(published.experiment.to_numpy() / TO_UM, published.experiment_std.to_numpy() / TO_UM, beam)
    style = {"fmt": "D", "color": "black", "markersize": 3, "zorder": 5}
    panel.errorbar(humidity, TO_MJ * energy, TO_MJ * bars, label="measured", **style)
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
    """Energy that an axis must reach to show the mean and standard deviation of some beams [J m⁻²]."""
    energies = stuck_energies(beams)
    return 1.1 * (energies.mean() + energies.std()) if len(energies) else 0.0


def _released(panel, released, model, weakest):
    """Mean and standard deviation over the S-shaped beams of every humidity, and their share if below 100 %."""
    marker, colour = _MARKERS[model]
    points = [(humidity, beams) for (humidity, which), beams in released.items() if which == model]
    stuck = [TO_MJ * stuck_energies(beams) for _, beams in points]
    bars = [(humidity, e.mean(), e.std(ddof=1)) for (humidity, _), e in zip(points, stuck, strict=True) if len(e) > 1]
    humidities, means, deviations = np.reshape(bars, (-1, 3)).T
    style = {"fmt": marker, "color": colour, "markeredgecolor": "black", "markeredgewidth": 0.4}
    style |= {"transform": _aside(panel, -_ASIDE), "zorder": 3, "label": f"{model}: beams, mean ± std"}
    panel.errorbar(humidities, means, deviations, **style)
    for (humidity, beams), energies in zip(points, stuck, strict=True):
        height = energies.mean() if len(energies) else TO_MJ * weakest
        _share(panel, (humidity, height), len(energies) / beams.sizes["sample"])


def _share(panel, place, share):
    """Annotate the share of S-shaped beams if below 100 %; of a share of 0 %, at the energy of the longest crack."""
    if share < 1:
        style = {"fontsize": 6, "ha": "center", "path_effects": OUTLINED, "zorder": 6}
        panel.annotate(f"{100 * share:.2g} %", place, (-_ASIDE, 4), textcoords="offset points", **style)
