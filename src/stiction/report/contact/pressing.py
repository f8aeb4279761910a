"""Table and figure of study pressing: adhesion after pressing surfaces together, relative to before."""

from collections.abc import Iterator, Mapping

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.transforms import offset_copy

from stiction.estimates import jackknife, mean_with_error
from stiction.plan.names import by_name
from stiction.report.format import TO_MPA, TO_NM, with_error
from stiction.report.style import (
    SINGLE,
    STUDIES,
    at_most_double,
    columns_of_panels,
    dashes,
    figure_stage,
    humidity_colours,
    letter_lines,
    marker,
    styled,
)
from stiction.report.table import Table, Term, table_stage

#: Distance of the bars of a humidity from those of the one before [in].
_ASIDE = 0.05

_STRIPS = (
    "Adhesion after surfaces were pressed together once: ratio of the mean adhesion energy ē to that before, at each "
    "relative humidity, ± standard error over {strips} strips; by full contact with pressures up to the hardness, and "
    "flattening that remains. The first line of a pair is what its adhesion alone does."
)
_PRESSURE = Term(
    "Pressure",
    "mean of the strips; at H: share of the elements in contact at the hardness; flattening: largest of an element, "
    "mean of the strips.",
)


def _rows(studies: Mapping[str, xr.Dataset]) -> Iterator[dict]:
    """One row for each pair, press and humidity. The first press is adhesion alone, without pressure."""
    for pair, study in studies.items():
        fresh = study.fresh_energy.values
        after = [study.adhered_energy.values, *study.pressed_energy.transpose("step", "strip", "humidity").values]
        for number, energies in enumerate(after):
            press = {"pair": pair, "press": number, "strips": len(fresh)} | _press(study, number)
            of_both = np.hstack([energies, fresh])
            ratios, errors = jackknife(lambda means: np.divide(*np.split(means, 2)), of_both)
            for humidity, ratio, error in zip(study.humidity.values, ratios, errors, strict=True):
                yield press | {"relative_humidity": humidity, "energy_ratio": ratio, "energy_ratio_se": error}


def _press(study, number):
    """Means over the strips of a press. Only its pressure, 0, if it is adhesion alone."""
    columns = {"pressure_MPa": ("pressure", TO_MPA), "distance_nm": ("separation", TO_NM)}
    columns |= {"contact_percent": ("contact_share", 100), "at_hardness_percent": ("hardness_share", 100)}
    ratios = {}
    for column, (name, unit) in (columns | {"flattening_nm": ("flattening", TO_NM)}).items():
        mean, error = mean_with_error(unit * study[name].values)
        without_press = 0.0 if column == "pressure_MPa" else np.nan
        of_press = (mean[number - 1], error[number - 1]) if number else (without_press, without_press)
        ratios |= dict(zip((column, f"{column}_se"), of_press, strict=True))
    return ratios


def table(studies: Mapping[str, xr.Dataset]) -> Table:
    """Numbers of every press and humidity, and a line for each press. Parameters as in ``_rows``."""
    frame = pd.DataFrame(_rows(studies))
    lines = [_line(*group) for group in frame.groupby(["pair", "press"], sort=False)]
    return Table(frame, [_STRIPS.format(strips=frame.strips.max()), _PRESSURE], pd.DataFrame(lines))


def _line(key, rows):
    """One press of a pair as text."""
    pair, number = key
    first, shown = rows.iloc[0], {"pair": pair}
    shown["pressure [MPa]"] = with_error(first.pressure_MPa, first.pressure_MPa_se) if number else "adhesion alone"
    titles = {"distance [nm]": "distance_nm", "contact [%]": "contact_percent", "at H [%]": "at_hardness_percent"}
    for title, column in (titles | {"flattening [nm]": "flattening_nm"}).items():
        shown[title] = with_error(first[column], first[f"{column}_se"])
    for row in rows.itertuples():
        shown[f"ē after / before, RH {row.relative_humidity:g}"] = with_error(row.energy_ratio, row.energy_ratio_se)
    return shown


def figure(studies: Mapping[str, xr.Dataset]) -> Figure:
    """Ratio of the energies against the mean pressure, for each humidity. Parameters as in ``_rows``."""
    return drawn(pd.DataFrame(_rows(studies)))


@styled
def drawn(frame: pd.DataFrame) -> Figure:
    """Ratio of the energies against the mean pressure, for each humidity, from the frame of the table."""
    pairs = frame.pair.unique()
    figure, columns, lines = columns_of_panels(len(pairs), 1, at_most_double(1.3 * SINGLE), 3.0)
    for (panel,), pair in zip(columns, pairs, strict=True):
        of_pair = frame[frame.pair == pair]
        for k, (humidity, colour) in enumerate(humidity_colours(of_pair.relative_humidity).items()):
            curve = of_pair[of_pair.relative_humidity == humidity]
            style = {
                "color": colour,
                "marker": marker(k),
                "linestyle": dashes(k),
                "label": f"RH {humidity:g}",
            }
            aside = offset_copy(panel.transData, figure, k * _ASIDE, 0)
            errors = {"xerr": curve.pressure_MPa_se, "yerr": curve.energy_ratio_se}
            panel.errorbar(curve.pressure_MPa, curve.energy_ratio, **errors, **style, transform=aside)
            panel.update_datalim(np.c_[curve.pressure_MPa, curve.energy_ratio + curve.energy_ratio_se])
        panel.autoscale_view()
        panel.axhline(1, color="0.6", linewidth=0.6, zorder=0)
        panel.set_xlabel("mean pressure [MPa]")
        panel.legend(title="bars: ± standard error, shifted")
    for line in lines:
        line[0, 0].set_ylabel(r"$\bar e$ after / before pressing [–]")
    letter_lines(lines, [f"pair {pair}" for pair in pairs])
    return figure


def _pairs(plan):
    """Pairs in the run and in the study of pressing."""
    distances = plan.config["studies"]["pressing"]["distance_nm"]
    return [pair for pair in plan.humid_pairs if pair in distances]


def _stage(kind, shows, draw, **declared):
    """Table or figure of study pressing."""
    return kind(
        "pressing",
        shows,
        inputs=lambda plan, at: {"studies": by_name("studies/pressing", _pairs(plan))},
        compute=lambda data: draw(data["studies"]),
        jobs=lambda plan: [{}] if _pairs(plan) else [],
        study="pressing",
        targets=("pressing",),
        **declared,
    )


STAGES = (
    _stage(table_stage, "adhesion after surfaces were pressed together", table),
    _stage(figure_stage, "adhesion after surfaces were pressed together", figure, category=STUDIES),
)
