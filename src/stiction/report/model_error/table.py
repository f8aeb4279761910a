"""Table and figure of the error of the model: crack lengths of Table III, model NG, under full elastic contact."""

import textwrap
from collections.abc import Mapping

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.figure import Figure

from stiction.analysis import variants as comparison
from stiction.plan.names import CORRECTED, Outcome, by_case, by_outcome
from stiction.report import published
from stiction.report.format import UM, as_published, percent, signed, with_error
from stiction.report.model_error.column import change, marked_change
from stiction.report.published import value
from stiction.report.style import (
    DOUBLE,
    MODELS,
    PUBLISHED,
    SINGLE,
    STUDIES,
    figure_stage,
    handles,
    humidity_axis,
    is_page,
    legend_below,
    legend_outside,
    letter,
    marker,
    panels,
    shades,
    styled,
)
from stiction.report.table import PAIR, Table, Term, table_stage
from stiction.stages.beams.releases import stuck_lengths
from stiction.stages.beams.variant_beams import cases_of
from stiction.stages.contact.corrections import in_all_air

_CAPTION = (
    "Error of the model of the contact: adhesion energy ē of full elastic contact over that of the sum over summits, "
    "of the same {strips} strips, ± standard error over strips; by how much full contact lengthens the crack, and the "
    "crack lengths of Table III, model NG, without and with it."
)
_BEAMS = Term(
    "Beams",
    "the same by beams on corrected force laws, in which e and f_max of all samples are multiplied by their ratios, ± "
    "standard error over beams. It has one sign and is no random error: it is not part of any standard error. * "
    "interpolated between the humidities at which full contact was computed, with the error of the interpolation.",
)


def _rows(
    errors: Mapping[str, xr.Dataset],
    beams: Mapping[tuple[str, float], xr.Dataset],
    published: pd.DataFrame,
    variants: Mapping[Outcome, xr.Dataset] | None = None,
) -> list[dict]:
    """One row for each pair and humidity. The ratio of the energies is NaN without full contact."""
    rows = []
    for (pair, humidity), released in beams.items():
        case = {"pair": pair, "relative_humidity": humidity}
        error = errors[pair].sel(humidity=humidity)
        ratio = error.where(~error.interpolated)
        lengths = stuck_lengths(released) / UM
        length = lengths.mean() if len(lengths) >= 2 else np.nan
        longer = length * float(error.length_factor)
        if error.applied:  # the beams have the corrected laws
            length, longer = length / float(error.length_factor), length
        lengths_of_paper = {
            name: value(published, name, **case) for name in ("ng", "ng_std", "experiment", "experiment_std")
        }
        rows.append(
            case
            | {
                "strips": int(error.strips),
                "energy_ratio": float(ratio.energy_ratio),
                "energy_ratio_se": float(ratio.energy_ratio_error),
            }
            | change(error)
            | _beam_change(case, variants or {})
            | {
                "crack_length_um": length,
                "full_contact_um": longer,
                "published_um": lengths_of_paper["ng"],
                "published_std_um": lengths_of_paper["ng_std"],
                "experiment_um": lengths_of_paper["experiment"],
                "experiment_std_um": lengths_of_paper["experiment_std"],
                "deviation_percent": percent(length, lengths_of_paper["ng"]),
                "full_contact_deviation_percent": percent(longer, lengths_of_paper["ng"]),
                "experiment_deviation_percent": percent(length, lengths_of_paper["experiment"]),
                "full_contact_experiment_deviation_percent": percent(longer, lengths_of_paper["experiment"]),
            }
        )
    return rows


def _beam_change(case, variants):
    """Change of the crack length of beams on corrected force laws, if computed."""
    keys = [(*case.values(), name) for name in (CORRECTED, "base")]
    change = np.nan, np.nan
    if set(keys) <= set(variants):
        (_, full), (_, base) = (next(cases_of(variants[key])) for key in keys)
        change = 100 * np.array(comparison.shift(full, base)) / comparison.mean_crack_length(base)[0]
    return dict(zip(("beams_change_percent", "beams_change_se_percent"), map(float, change), strict=True))


#: Labels of the panels of errors and of lengths. Longer cracks under full contact leave limits by summits too short.
_ERROR, _LENGTH = (
    "crack by full contact,\nlonger than the model's by [%]",
    "crack length,\nlonger than published by [%]",
)
#: Mean width of a character of a title, and height of a panel [in].
_CHARACTER, _HIGH = 0.055, 2.6


def table(*data) -> Table:
    """Error of the model for every case. Parameters as in ``_rows``."""
    rows = _rows(*data)
    return Table.from_rows(rows, [_CAPTION.format(strips=rows[0]["strips"]), _BEAMS], _COLUMNS)


_COLUMNS = PAIR | {
    "ē full / summits": (with_error, "energy_ratio", "energy_ratio_se"),
    "model error of l_s [%]": (marked_change, "model_error_percent", "model_error_se_percent", "interpolated"),
    "beams [%]": (signed, "beams_change_percent", "beams_change_se_percent"),
    "l_s [µm]": (".1f", "crack_length_um"),
    "l_s, full contact [µm]": (".1f", "full_contact_um"),
    "published": (as_published, "published_um", "published_std_um"),
    "dev. published [%]": ("+.1f", "deviation_percent"),
    "dev., full contact [%]": ("+.1f", "full_contact_deviation_percent"),
    "measured": (as_published, "experiment_um", "experiment_std_um"),
    "dev. measured [%]": ("+.0f", "experiment_deviation_percent"),
    "dev. measured, full contact [%]": ("+.0f", "full_contact_experiment_deviation_percent"),
}


def figure(*data) -> Figure:
    """Error of the model against humidity, and deviations from the published lengths. Parameters as in ``_rows``."""
    return drawn(pd.DataFrame(_rows(*data)))


@styled
def drawn(frame: pd.DataFrame) -> Figure:
    """Error of the model against humidity, of all pairs on one axis, and deviations from the published lengths.

    Parameters
    ----------
    frame
        Of the table. Each pair with published lengths has a panel.
    """
    compared = frame[frame.published_um.notna()]
    pairs = list(dict.fromkeys(compared.pair))
    figure, (error, *deviations), width = _arranged(1 + len(pairs))
    _errors(error, frame)
    for panel, pair in zip(deviations, pairs, strict=True):
        _deviations(panel, compared[compared.pair == pair])
    for panel in (error, *deviations):
        panel.axhline(0, color="0.6", linewidth=0.6, zorder=0)
        panel.set(xlabel="relative humidity [–]", xlim=error.get_xlim())
        humidity_axis(panel)
    legend_below(error, handles(error)[0])
    legend_outside(figure, handles(*deviations), "lower", 3)
    titles = [_in_words(frame.model_error_percent), *(_off(compared[compared.pair == pair]) for pair in pairs)]
    letter([error, *deviations], [textwrap.fill(title, int(width / _CHARACTER)) for title in titles])
    return figure


def _arranged(count):
    """Figure with some panels in two columns, or below each other on a page, and the width of a column [in]."""
    across = 1 if is_page() else min(count, 2)
    rows = -(-count // across)
    figure, axes = panels(rows, across, (min(DOUBLE, 1.3 * SINGLE * across), _HIGH * rows))
    shown, unused = np.split(axes.ravel(), [count])
    for panel in unused:
        panel.remove()
    return figure, shown, figure.get_figwidth() / across


def _in_words(errors):
    """Largest errors of the model in both directions, each with its side."""
    sides = (errors.max(), "too short", "safe"), (-errors.min(), "too long", "unsafe")
    said = [f"{way} by up to {size:.0f} % ({side})" for size, way, side in sides if round(size)]
    return f"the model's cracks are {' and '.join(said) or 'right'}"


def _off(rows):
    """Root mean square of the deviations of a pair, by summits and by full contact."""
    summits, full = (np.sqrt(np.mean(rows[f"{name}deviation_percent"] ** 2)) for name in ("", "full_contact_"))
    return f"pair {rows.pair.iloc[0]}: rms {summits:.1f} % off by summits, {full:.1f} % by full contact"


def _errors(panel, frame):
    """Error of the model of each pair, at the computed humidities and between them, and by beams on corrected laws."""
    pairs = list(dict.fromkeys(frame.pair))
    for k, (pair, shade) in enumerate(zip(pairs, shades(len(pairs)), strict=True)):
        rows = frame[frame.pair == pair]
        computed = rows[~rows.interpolated]
        panel.plot(rows.relative_humidity, rows.model_error_percent, ":", color=shade)
        points = computed.relative_humidity, computed.model_error_percent, computed.model_error_se_percent
        panel.errorbar(*points, fmt=marker(k), color=shade, label=f"pair {pair}, ± standard error")
        of_beams = rows.relative_humidity, rows.beams_change_percent, rows.beams_change_se_percent
        if rows.beams_change_percent.notna().any():
            panel.errorbar(*of_beams, fmt="x", color=shade)
    panel.plot([], [], ":", color="0.3", label="interpolated")
    if frame.beams_change_percent.notna().any():
        panel.plot([], [], "x", color="0.3", label="by beams computed with full contact")
    panel.set_ylabel(_ERROR)


def _deviations(panel, rows):
    """Deviation of the lengths of one pair from the published ones, by both models and as measured."""
    style = {"color": MODELS["NG"]["color"]}
    summits = {"linestyle": "--", "marker": "s", "markerfacecolor": "white", "label": "model: sum over summits"}
    panel.plot(rows.relative_humidity, rows.deviation_percent, **summits, **style)
    full = {"linestyle": "-", "marker": "o", "label": "full contact"}
    panel.plot(rows.relative_humidity, rows.full_contact_deviation_percent, **full, **style)
    measured = percent(rows.experiment_um / rows.published_um, 1), 100 * rows.experiment_std_um / rows.published_um
    label = "measured ± std; below the lines: unsafe"
    panel.errorbar(rows.relative_humidity, *measured, fmt="*", color=PUBLISHED, label=label)
    panel.set_ylabel(_LENGTH)


def _stage(kind, shows, draw, **declared):
    """Table or figure of the error of the model."""
    return kind(
        "model_error",
        shows,
        inputs=lambda plan, at: {
            "errors": {
                pair: in_all_air("studies/model_error", pair, plan.air.water(pair)) for pair in plan.humid_pairs
            },
            "beams": by_case("beams", plan.humid_cases, "_NG"),
            "published": published.file("table_3"),
            "variants": by_outcome(
                "studies/variants",
                [
                    (case, name)
                    for case, variant in plan.variants.cases
                    if variant == CORRECTED
                    for name in ("base", variant)
                ],
            ),
        },
        settings=lambda plan, at: {"of_paper": plan.paper.pairs},
        compute=lambda data, settings: draw(
            data["errors"], data["beams"], published.published_rows(data, settings), data["variants"]
        ),
        study="full_contact",
        targets=("model_error", "figures", "study_figures"),
        **declared,
    )


STAGES = (
    _stage(table_stage, "Table III under full elastic contact", table),
    _stage(figure_stage, "crack lengths under full elastic contact", figure, category=STUDIES),
)
