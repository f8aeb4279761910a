"""Table and figure of the error of the model: crack lengths of Table III, model NG, under full elastic contact."""

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
    MODELS,
    PUBLISHED,
    SINGLE,
    STUDIES,
    at_most_double,
    columns_of_panels,
    figure_stage,
    handles,
    humidity_axis,
    legend_outside,
    letter_lines,
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


#: Labels of the panels of a pair. Longer cracks under full contact leave limits by summits too short.
_SHOWN = (
    "crack by full contact\nover the model's [%]\n+: model too short (safe)",
    "crack length\nover published [%]\nstars below 0: unsafe",
)
#: What these panels show, after the name of the pair.
_TITLES = ": full contact beside summits", ": both beside published and measured"


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
    """Error of the model against humidity, and deviations from the published lengths, from the frame of the table."""
    pairs = list(dict.fromkeys(frame.pair))
    count = 2 if frame.published_um.notna().any() else 1
    figure, columns, lines = columns_of_panels(
        len(pairs), count, at_most_double(1.3 * SINGLE), 0.8 + 1.7 * count, sharex="col"
    )
    for column, pair in zip(columns, pairs, strict=True):
        _panels(column, frame[frame.pair == pair])
    for line in lines:
        for panel, shows in zip(line[:, 0], _SHOWN, strict=False):
            panel.set_ylabel(shows)
    legend_outside(figure, handles(*columns.flat), "upper", 3)
    letter_lines(lines, [f"pair {pair}" for pair in pairs], _TITLES[:count])
    return figure


def _panels(column, rows):
    """Panels of one pair."""
    computed, compared = rows[~rows.interpolated], rows[rows.published_um.notna()]
    style = {"color": MODELS["NG"]["color"]}
    column[0].plot(rows.relative_humidity, rows.model_error_percent, linestyle=":", label="interpolated", **style)
    points = computed.relative_humidity, computed.model_error_percent, computed.model_error_se_percent
    column[0].errorbar(*points, fmt="o", label="full contact, correction ± standard error", **style)
    of_beams = rows.relative_humidity, rows.beams_change_percent, rows.beams_change_se_percent
    if rows.beams_change_percent.notna().any():
        column[0].errorbar(*of_beams, fmt="x", color="black", label="beams computed with full contact ± standard error")
    if len(column) > 1:
        summits = {
            "linestyle": "--",
            "marker": "s",
            "markerfacecolor": "white",
            "label": "sum over summits, crack length",
        }
        column[1].plot(compared.relative_humidity, compared.deviation_percent, **summits, **style)
        full = {"linestyle": "-", "marker": "o", "label": "full contact, crack length"}
        column[1].plot(compared.relative_humidity, compared.full_contact_deviation_percent, **full, **style)
        measured = (
            percent(compared.experiment_um / compared.published_um, 1),
            100 * compared.experiment_std_um / compared.published_um,
        )
        column[1].errorbar(compared.relative_humidity, *measured, fmt="*", color=PUBLISHED, label="measured ± std")
    column[-1].set_xlabel("relative humidity [–]")
    for panel in column:
        panel.axhline(0, color="0.6", linewidth=0.6, zorder=0)
    humidity_axis(column[0])


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
