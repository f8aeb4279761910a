"""Figures of the force laws (Secs. III-B and IV-B): 5 and 12."""

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from stiction.contact import forcelaw
from stiction.models import SURFACE_MODELS
from stiction.report.format import TO_MJ, TO_MPA, TO_NM
from stiction.report.style import (
    DOUBLE,
    MODELS,
    SINGLE,
    figure_stage,
    is_page,
    legend_outside,
    letter,
    panels,
    styled,
)
from stiction.rounding import in_percent
from stiction.stages.laws import forces as stage_forces
from stiction.stages.laws.chaos import generated_laws

#: Number of highlighted curves in Figure 12.
_HIGHLIGHTED = 20
#: Lines of highlighted and of all curves.
_FEW, _ALL = {"color": MODELS["NG"]["color"], "linewidth": 0.6}, {"color": "0.75", "linewidth": 0.3}
#: A curve is drawn until its attraction has decayed to this share of the largest attraction.
_FOLLOWED = 0.01
#: Range of the forces in Figure 12, relative to the largest attraction of a pair.
_RANGE = np.array([-1.1, 0.6])
#: Curves are also shown enlarged if their attraction stays below this share of the largest attraction of the pair.
_SHALLOW = 0.2
_DOTTED = {"color": "0.3", "linestyle": ":", "linewidth": 0.8}


# Figure 5


def typical(fit: xr.Dataset, count: int) -> int:
    """Number of the sample of median error among the first ``count``."""
    # ASSUME: the paper's typical curve is one of median error.
    errors = fit.curve_error.sel(strip=slice(0, count - 1))
    return int(errors.strip[np.argsort(errors.values)[errors.size // 2]])


@styled
def fitted_curve(forces: xr.Dataset, fit: xr.Dataset) -> Figure:
    """Figure 5: a typical force curve of a case, its law by Eq. (12) and the four components of v, Eq. (11)."""
    k = typical(fit, forces.sizes["curve"])
    samples, limit = stage_forces.vectors_of_curves(forces)
    vector = samples[k]
    law = forcelaw.coefficients(vector[None], limit)[0]
    far = law[1] + np.log(2 / _FOLLOWED) / law[3]
    distance = np.linspace(vector[3] - 0.35 * (far - vector[3]), far, 500)
    pressure = TO_MPA * forcelaw.pressure(law, distance)
    figure, ((panel,),) = panels(1, 1, (SINGLE, 2.7))
    panel.axhline(0, color="black", linewidth=0.6)
    shade = {"color": MODELS["NG"]["color"], "alpha": 0.18, "linewidth": 0}
    panel.fill_between(TO_NM * distance, np.minimum(pressure, 0), 0, **shade)
    panel.plot(TO_NM * forces.distance, TO_MPA * forces.force[k], color="0.55", linewidth=2.5, label="contact")
    panel.plot(TO_NM * distance, pressure, "k--", label="Eq. (12)")
    panel.set(xlim=TO_NM * distance[[0, -1]], ylim=TO_MPA * np.array([-1.2 * law[0], 1.3 * limit]))
    panel.set(xlabel=r"distance $\bar d$ [nm]", ylabel=r"force per area $\bar f$ [MPa]")
    _components(panel, vector, limit)
    error = 100 * float(fit.curve_error.sel(strip=k))
    panel.legend(title=f"sample {k}, error {in_percent(error / 100)}", loc="upper right")
    return figure


def _components(panel, vector, limit):
    """Mark f_limit and the four components of v, each with its value."""
    energy, f_max, d_max, d_limit = vector * [TO_MJ, TO_MPA, TO_NM, TO_NM]
    left, right = panel.get_xlim()
    panel.plot([left, d_limit, d_limit], [TO_MPA * limit, TO_MPA * limit, 0], **_DOTTED)
    panel.plot([d_max, d_max, right], [0, -f_max, -f_max], **_DOTTED)
    panel.plot([d_limit, d_max], [TO_MPA * limit, -f_max], "ko", markersize=3)
    note = {"textcoords": "offset points", "fontsize": 7}
    panel.annotate(rf"$\bar f_\mathrm{{limit}}$ = {TO_MPA * limit:.3g} MPa", (left, TO_MPA * limit), (3, 3), **note)
    panel.annotate(rf"$\bar d_\mathrm{{limit}}$ = {d_limit:.3g} nm", (d_limit, 0), (-3, -9), ha="right", **note)
    panel.annotate(rf"$\bar d_\mathrm{{max}}$ = {d_max:.3g} nm", (d_max, 0), (-8, 4), **note)
    panel.annotate(rf"$\bar f_\mathrm{{max}}$ = {f_max:.3g} MPa", (right, -f_max), (-3, 3), ha="right", **note)
    position = d_max + 0.12 * (right - d_max), -0.25 * f_max
    text = right - 0.02 * (right - left), -0.6 * f_max
    arrow = {"arrowstyle": "-", "linewidth": 0.6}
    panel.annotate(rf"$\bar e$ = {energy:.3g} mJ/m²", position, text, ha="right", fontsize=7, arrowprops=arrow)


# Figure 12


@styled
def force_curves(pairs: Mapping[str, tuple[xr.Dataset, xr.Dataset, np.ndarray]]) -> Figure:
    """Figure 12: force curves of Gaussian and of non-Gaussian surfaces, and curves from the chaos model.

    Each pair has its datasets of stage forces for models G and NG, and the generated laws (n, 4).
    """
    size = DOUBLE, 1.9 * len(pairs) + 0.4
    figure, axes = panels(len(pairs), 3, size, beside=True, sharex="row", sharey="row")
    for row, (gaussian, other, laws) in zip(axes, pairs.values(), strict=True):
        window, depth = _window(gaussian, other)
        distance = np.linspace(*window, 400)
        generated = forcelaw.pressure(laws[:, None], distance)
        depth = max(depth, -generated.min())
        populations = [stage_forces.curves(forces) for forces in (gaussian, other)]
        for panel, population in zip(row, [*populations, (distance, generated)], strict=True):
            _curves(panel, *population, 2 * depth)
        row[0].set(xlim=TO_NM * np.array(window), ylim=TO_MPA * depth * _RANGE)
        row[0].set_ylabel(r"force per area $\bar f$ [MPa]")
        _enlarged(row[0], gaussian, depth)
    for panel in axes[-1]:
        panel.set_xlabel(r"distance $\bar d$ [nm]")
    kinds = (*(MODELS[model]["label"] for model in SURFACE_MODELS), "generated")
    letter(axes, [f"pair {pair},\n{kind}" for pair in pairs for kind in kinds])
    shown = [
        Line2D([], [], **style, label=label)
        for style, label in ((_FEW, f"the first {_HIGHLIGHTED}"), (_ALL, "all curves"))
    ]
    legend_outside(figure, (shown, [line.get_label() for line in shown]), "lower", 2)
    return figure


def _enlarged(panel, forces, depth):
    """Enlarged attraction of shallow curves, in the space below them."""
    deepest = -float(forces.force.min())
    if deepest < _SHALLOW * depth:
        below = (-deepest / depth - _RANGE[0]) / np.ptp(_RANGE)
        inset = panel.inset_axes([0.28, 0.13, 0.66, below - 0.16])
        _curves(inset, *stage_forces.curves(forces), deepest)
        inset.set(xlim=TO_NM * np.array(_window(forces)[0]), ylim=TO_MPA * deepest * _RANGE)
        inset.locator_params(nbins=2 if is_page() else 4)
        inset.tick_params(pad=2)
        inset.text(0.94, 0.06, "enlarged", ha="right", fontsize=7, transform=inset.transAxes)


def _window(*cases):
    """Distances (2,) of attraction or approach to f_limit of the kept curves of some cases, and their deepest force."""
    first = min(float(forces.limit_distance[: forces.sizes["curve"]].min()) for forces in cases)
    depth = max(-float(forces.force.min()) for forces in cases)
    reach = [forces.distance[(forces.force < -_FOLLOWED * depth).any("curve")].max() for forces in cases]
    last = float(max(reach))
    return (first - 0.05 * (last - first), last), depth


def _curves(panel, distance, curves, highest):
    """Draw curves up to a force: the first ones highlighted, the others faint."""
    lines = [np.column_stack([TO_NM * distance, TO_MPA * f])[f < highest] for f in curves]
    panel.add_collection(LineCollection(lines, **_ALL, rasterized=True))
    panel.add_collection(LineCollection(lines[:_HIGHLIGHTED], **_FEW))
    panel.axhline(0, color="black", linewidth=0.5)


def _force_curves(data, settings):
    """Computed curves of every pair, and as many generated force laws as curves were kept."""
    drawn = {}
    for pair, case in settings["cases"].items():
        count = data["other"][pair].sizes["curve"]
        generated = generated_laws(data["chaos"][pair], count, case, settings["seed"])
        drawn[pair] = data["gaussian"][pair], data["other"][pair], generated
    return force_curves(drawn)


_CATEGORY = "Contact forces (Sec. III)"
STAGES = (
    figure_stage(
        "figure_05",
        "a force curve, its force law and its parameters",
        _CATEGORY,
        inputs=lambda plan, at: {stage: f"{stage}/{plan.figure_case}_NG" for stage in ("forces", "fit")},
        settings=lambda plan, at: plan.figure_settings,
        compute=fitted_curve,
        targets=("figures",),
    ),
    figure_stage(
        "figure_12",
        "computed and generated force curves",
        _CATEGORY,
        inputs=lambda plan, at: {
            name: {pair: f"{stage}/{case}_{model}" for pair, case in plan.figure_cases.items()}
            for name, stage, model in (("gaussian", "forces", "G"), ("other", "forces", "NG"), ("chaos", "chaos", "NG"))
        },
        settings=lambda plan, at: {"seed": plan.config["seed"], "cases": plan.figure_cases},
        compute=_force_curves,
        targets=("figures",),
    ),
)
