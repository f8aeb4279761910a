"""Model in one picture: a rough surface, its force curves, released beams, and crack lengths against humidity."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from stiction.contact import forcelaw
from stiction.plan.names import by_outcome
from stiction.report import published
from stiction.report.format import TO_MPA, TO_NM, TO_UM
from stiction.report.published import rows
from stiction.report.style import (
    MODELS,
    PUBLISHED,
    figure_stage,
    handles,
    humidity_axis,
    is_page,
    legend_outside,
    letter,
    panels,
    places,
    styled,
)
from stiction.stages.beams.releases import ends_as, stuck_lengths
from stiction.stages.laws import forces as stage_forces

_SIZE = 7.2, 2.4
_COLOUR = MODELS["NG"]["color"]
#: Lines of all curves, and of highlighted ones.
_PALE, _FULL = {"color": "0.75", "linewidth": 0.4}, {"color": _COLOUR, "linewidth": 0.6}
#: Largest side of the shown part of the surface [m].
_SHOWN = 5e-6
#: Height of the shown part of the surface over its width on a page [-].
_ASPECT = 0.6
#: Number of highlighted force curves.
_HIGHLIGHTED = 8
#: A force curve is drawn until its attraction has decayed to the first share of the largest attraction, and up to the
#: second share of it in repulsion.
_FOLLOWED, _REPULSION = 0.02, 0.6
#: Shift of published and computed markers from their humidity [-].
_APART = 0.012
#: Largest number of crack lengths between which there is room for a legend.
_FEW = 8


@styled
def overview(
    pair: str,
    character: xr.Dataset,
    forces: xr.Dataset,
    beams: xr.Dataset,
    released: Mapping[tuple[float, str], xr.Dataset],
    published: pd.DataFrame,
) -> Figure:
    """Draw the way to a crack length: (a) surface, (b) force curves, (c) shapes of beams, (d) crack lengths of a pair.

    ``released`` has the datasets of stage beams of the pair by humidity and model, NG, GEO or both; the others are of
    one surface or case. Table III is as published, rows of the paper's own pairs.
    """
    figure, (axes,) = panels(1, 4, _SIZE, width_ratios=(1.5, 1, 1, 1.12))
    surface, curves, shapes, lengths = axes
    _surface(figure, surface, character)
    _forces(curves, forces)
    _shapes(shapes, beams)
    _lengths(lengths, released, rows(published, pair=pair))
    letter(axes, ["rough surface", "adhesive force", "released beams", "crack length"])
    if is_page():
        for panel, corner in zip(axes[1:], ("lower right", "upper right", "best"), strict=True):
            panel.legend(loc=corner)
    else:  # small panels have no room
        legend_outside(figure, handles(*axes), "lower", 8)
    return figure


def _surface(figure, panel, character):
    """Square part of the surface, on a page a wide one, seen from above."""
    spacing = float(character.x[1] - character.x[0])
    points = min(int(_SHOWN / spacing), *character.elevation.shape)
    side = TO_UM * points * spacing
    aspect = _ASPECT if is_page() else 1.0
    elevation = TO_NM * character.elevation.values[:points, : round(aspect * points)].T
    low, high = np.quantile(elevation, (0.002, 0.998))
    image = panel.imshow(elevation, origin="lower", extent=(0, side, 0, aspect * side), vmin=low, vmax=high)
    panel.set(xlabel="$x_1$ [µm]", ylabel="$x_2$ [µm]")
    figure.colorbar(image, ax=panel, label="height $z$ [nm]", fraction=0.06, pad=0.02, shrink=0.9)


def _forces(panel, forces):
    """Force curves of some samples, some highlighted, and the law of one of them by Eq. (12)."""
    distance, force = stage_forces.curves(forces)
    deepest = -force.min(axis=1)
    lines = [np.column_stack([TO_NM * distance, TO_MPA * f])[f < _REPULSION * deepest.max()] for f in force]
    panel.axhline(0, color="black", linewidth=0.5)
    for shown, style, label in ((lines, _PALE, "force on each strip"), (lines[:_HIGHLIGHTED], _FULL, "a few of them")):
        panel.add_collection(LineCollection(shown, **style, rasterized=shown is lines))
        panel.plot([], [], **style, label=label)
    vector, limit = stage_forces.vectors(forces)
    # ASSUME: the curve of median energy is the typical one.
    k = stage_forces.typical(forces)
    law = forcelaw.coefficients(vector[k][None], limit)[0]
    attracting = distance[(force < -_FOLLOWED * deepest.max()).any(axis=0)]
    first, last = attracting[[0, -1]]
    first -= 0.1 * (last - first)
    near = np.linspace(first, last, 400)
    pressure = forcelaw.pressure(law, near)
    below = pressure < _REPULSION * deepest.max()
    panel.plot(TO_NM * near[below], TO_MPA * pressure[below], color="black", linestyle="--", label="a fitted law")
    panel.set(xlim=(TO_NM * first, TO_NM * last), ylim=TO_MPA * deepest.max() * np.array([-1.08, _REPULSION]))
    panel.set(xlabel=r"distance $\bar d$ [nm]", ylabel=r"force per area $\bar f$ [MPa]")


def _shapes(panel, beams):
    """Shapes of the first beams, one S-shaped beam highlighted."""
    deflection, x = TO_UM * beams.deflection.values, TO_UM * beams.node.values
    panel.plot(x, deflection.T, **_PALE, rasterized=True)
    panel.plot([], [], **_PALE, label="shape of each beam")
    for k in np.flatnonzero(ends_as(beams, "S-shape")[: len(deflection)])[:1]:
        panel.plot(x, deflection[k], color=_COLOUR, linewidth=1.6, label="one that sticks")
    ground = deflection.max()
    panel.axhspan(ground, 1.14 * ground, color="0.35")
    panel.text(x[-1] / 2, 1.07 * ground, "substrate", color="white", ha="center", va="center", fontsize=7)
    panel.set(xlabel="position [µm]", ylabel="deflection [µm]", xlim=x[[0, -1]], ylim=(1.14 * ground, -0.06 * ground))


def _lengths(panel, released, published):
    """Crack length over the humidity: measured, published and computed here, mean ± standard deviation."""
    if len(published):
        measured = published.experiment, published.experiment_std
        style = {"fmt": "D", "color": "black", "markersize": 3, "zorder": 4, "label": "measured"}
        panel.errorbar(published.relative_humidity, *measured, **style)
        style = {"color": PUBLISHED, "markerfacecolor": "white", "fmt": "^:", "zorder": 3, "label": "published"}
        panel.errorbar(published.relative_humidity + _APART, published.geo, published.geo_std, **style)
    # Model GEO, scattered dimensions, where it was computed.
    model = "GEO" if any(beam_model == "GEO" for _, beam_model in released) else "NG"
    points = sorted(key for key in released if key[1] == model)
    stuck = [TO_UM * stuck_lengths(released[key]) for key in points]
    placed = places([*(humidity for humidity, _ in points), *published.relative_humidity])
    cases = zip((placed[humidity] for humidity, _ in points), stuck, strict=True)
    bars = [(humidity, lengths.mean(), lengths.std(ddof=1)) for humidity, lengths in cases if len(lengths) > 1]
    humidity, mean, deviation = np.reshape(bars, (-1, 3)).T
    style = {"color": _COLOUR, "markersize": 3}
    dry = humidity == placed.get(0.0)  # no line leads there
    if dry.any():
        panel.errorbar(humidity[dry], mean[dry], deviation[dry], fmt="o", **style)
    style |= {"fmt": "o-", "label": "computed here"}
    aside = _APART if len(published) else 0.0
    panel.errorbar(humidity[~dry] - aside, mean[~dry], deviation[~dry], **style)
    panel.set(xlabel="relative humidity [–]", ylabel="crack length $l_s$, mean ± std [µm]")
    panel.margins(y=0.12)
    if len(humidity) > _FEW:
        low, high = panel.get_ylim()
        panel.set_ylim(low, high + 0.3 * (high - low))  # room for the legend
    humidity_axis(panel, placed)


STAGES = (
    figure_stage(
        "overview",
        "from surfaces to crack lengths",
        "Beams (Secs. IV and V)",
        inputs=lambda plan, at: {
            "character": f"character/{plan.figure_surface}_NG",
            "forces": f"forces/{plan.figure_case}_NG",
            "beams": f"beams/{plan.figure_case}_NG",
            "released": {key[1:]: name for key, name in by_outcome("beams", plan.figure_outcomes).items()},
            "published": published.file("table_3"),
        },
        settings=lambda plan, at: plan.figure_settings | {"of_paper": plan.paper.pairs},
        compute=lambda data, settings: overview(
            settings["pair"],
            *(data[stage] for stage in ("character", "forces", "beams", "released")),
            published.published_rows(data, settings),
        ),
        targets=("figures",),
    ),
)
