"""Table and figure of the readings of an asperity: crack lengths of Table III, model NG, under each of them."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from stiction.analysis.model_error import length_factors, rms_deviation
from stiction.contact.air import Air
from stiction.plan.names import by_case, by_name
from stiction.report import dots, published
from stiction.report.budget.tables import choice_label
from stiction.report.format import TO_NM, UM, number, percent, signed, with_error
from stiction.report.published import rows as rows_of
from stiction.report.published import value
from stiction.report.style import (
    STUDIES,
    columns_of_panels,
    figure_stage,
    handles,
    legend_outside,
    letter_lines,
    styled,
)
from stiction.report.table import PAIR, Table, Term, table_stage
from stiction.stages.beams.releases import stuck_lengths
from stiction.stages.contact import full_contact
from stiction.stages.contact.asperities import cost, energies_of_readings

_CAPTION = (
    "Crack lengths of Table III, model NG, under several readings of an asperity, from the ratio of the mean adhesion "
    "energies of the same strips to the power -1/4: change against spheres on summits, on the grid of the contact and "
    "with attraction of the solids, at the lowest and at the highest humidity; root mean square over the humidities of "
    "the deviation from the published length, and from the length under full elastic contact, if computed; "
    "processor time of a strip over that of spheres on summits; ± standard error over strips.",
    Term(
        "Island",
        "a sphere of the area of every island; fitted: a sphere by least squares; shape: every island with its true "
        "shape, solved alone.",
    ),
    Term("Van der Waals", "the medium through which the solids attract, or none."),
)


def _rows(
    studies: Mapping[str, xr.Dataset],
    full: Mapping[str, xr.Dataset],
    beams: Mapping[tuple[str, float], xr.Dataset],
    published: pd.DataFrame,
) -> list[dict]:
    """One row for each pair, reading, grid, attraction and humidity."""
    rows = []
    for pair, study in studies.items():
        humidities, base = study.humidity.values, None
        cases = [{"pair": pair, "relative_humidity": humidity} for humidity in humidities]
        lengths = np.array([stuck_lengths(beams[pair, humidity]).mean() / UM for humidity in humidities])
        published_lengths = np.array([value(published, "ng", **case) for case in cases])
        for labels, energies in energies_of_readings(study):
            base = energies if base is None else base  # the first reading
            others, count = base[: len(energies)], {"strips": len(energies)}
            of_reading = {"time_over_summits": cost(study, **labels)}
            of_reading |= _rms("published", energies, others, lengths / published_lengths)
            of_reading |= _rms("full_contact", *_common_energies(energies, humidities, full[pair]))
            labels = {
                "reading": labels["reading"],
                "spacing_nm": TO_NM * labels["spacing"],
                "vdw": labels["attraction"],
            }
            factors = length_factors(energies, others, humidities, humidities)
            for case, length, of_paper, factor, error in zip(cases, lengths, published_lengths, *factors, strict=True):
                row = {"change_percent": 100 * (factor - 1), "change_se_percent": 100 * error}
                row |= {"crack_length_um": length * factor, "published_um": of_paper}
                row |= {"deviation_percent": percent(length * factor, of_paper)}
                rows.append(case | labels | count | row | of_reading)
    return rows


def _rms(name, *compared):
    """Columns of a root mean square deviation [%]."""
    rms, error = rms_deviation(*compared)
    return {f"rms_{name}_percent": 100 * rms, f"rms_{name}_se_percent": 100 * error}


def _common_energies(energies, humidities, study):
    """Energies of a reading and of full contact, in common strips and at common humidities."""
    at, full, _ = full_contact.energies(study)
    strips = min(len(energies), len(full))
    return energies[:strips, np.isin(humidities, at)], full[:strips]


def table(*data) -> Table:
    """Numbers of every case, and a line for each reading. Parameters as in ``_rows``."""
    frame = pd.DataFrame(_rows(*data))
    lines = frame.groupby(["pair", "vdw", "reading", "spacing_nm"], sort=False)
    return Table(frame, _CAPTION, pd.DataFrame([_line(*group) for group in lines]))


def _line(labels, rows):
    """One reading of a pair as text."""
    pair, vdw, reading, spacing = labels
    first, last = rows.iloc[0], rows.iloc[-1]
    shown = {
        "pair": pair,
        "asperity": reading,
        "grid [nm]": f"{spacing:g}",
        "van der Waals": vdw,
        "strips": str(first.strips),
    }
    for title, end in (("low RH", first), ("high RH", last)):
        shown[f"Δl_s [%], {title}"] = signed(end.change_percent, end.change_se_percent)
    for title, name in (("published", "published"), ("full contact", "full_contact")):
        rms, error = first[f"rms_{name}_percent"], first[f"rms_{name}_se_percent"]
        fixed = error < _ROUNDING  # that of the base from print does not depend on the strips
        shown[f"rms dev. from {title} [%]"] = number(rms, ".2f") if fixed else with_error(rms, error)
    return shown | {"time / summits": f"{float(f'{first.time_over_summits:.2g}'):g}"}


_PARTS = (
    "Parts of the error of the model of the contact, as changes of the crack length [%], of the same strips, ± "
    "standard error: from spheres on summits to islands of their true shape, each alone; from these to full elastic "
    "contact, in which islands act on each other and water deforms them; both together; and a grid twice as fine for "
    "spheres on summits, for comparison. With attraction of the solids. Factors multiply."
)
#: Two models of the contact for each part, named as in `_energies_of_models`: the change is that from the second.
_MODELS_OF_PARTS = {
    "shape": ("shape", "summit"),
    "interaction": ("full", "shape"),
    "together": ("full", "summit"),
    "grid": ("fine", "summit"),
}
_COLUMNS_OF_PARTS = {
    "strips": ("d", "strips"),
    "true shape": (signed, "shape_percent", "shape_se_percent"),
    "interaction, water": (signed, "interaction_percent", "interaction_se_percent"),
    "together": (signed, "together_percent", "together_se_percent"),
    "grid": (signed, "grid_percent", "grid_se_percent"),
}


def parts(studies: Mapping[str, xr.Dataset], full: Mapping[str, xr.Dataset]) -> Table:
    """Parts of the error of the model at every humidity of full contact. Parameters as in ``_rows``."""
    rows = []
    for pair, study in studies.items():
        humidities, of_models = _energies_of_models(study, full[pair])
        factors = {
            cause: length_factors(of_models[model], of_models[other], humidities, humidities)
            for cause, (model, other) in _MODELS_OF_PARTS.items()
        }
        for k, humidity in enumerate(humidities):
            row = {"pair": pair, "relative_humidity": humidity, "strips": len(of_models["full"])}
            for cause, (factor, error) in factors.items():
                row |= {f"{cause}_percent": 100 * (factor[k] - 1), f"{cause}_se_percent": 100 * error[k]}
            rows.append(row)
    return Table.from_rows(rows, _PARTS, PAIR | _COLUMNS_OF_PARTS)


def _energies_of_models(study, of_full):
    """Humidities of full contact, and energies of the strips common to all models, with attraction of the solids."""
    at, full, _ = full_contact.energies(of_full)
    common, by_model = np.isin(study.humidity.values, at), {"full": full}
    coarse, fine = (float(study.spacing[k]) for k in (0, -1))
    names = {("summit", coarse): "summit", ("summit", fine): "fine", ("shape", coarse): "shape"}
    for labels, energies in energies_of_readings(study):
        if labels["attraction"] == study.attraction[0] and (labels["reading"], labels["spacing"]) in names:
            by_model[names[labels["reading"], labels["spacing"]]] = energies[:, common]
    strips = min(map(len, by_model.values()))
    return at, {name: energies[:strips] for name, energies in by_model.items()}


#: Error that is due to rounding [%].
_ROUNDING = 1e-10
#: Height of the legend below the panels, width of the labels of rows, and of a panel [in].
_LEGEND, _LABELS, _PANEL = 1.0, 0.75, 1.4
#: Colours by the attraction of the solids, the first one filled.
_COLOURS = ("#0072B2", "#C98500")


def figure(*data) -> Figure:
    """Changes by each reading, as `changes_drawn`, of the data of ``_rows``."""
    _, full, _, published = data
    changes = {}
    for pair, study in full.items():
        humidities, *energies = full_contact.energies(study)
        (factor, *_), (error, *_) = length_factors(*energies, humidities, humidities)
        changes[pair] = 100 * (factor - 1), 100 * error
    return changes_drawn(pd.DataFrame(_rows(*data)), changes, published)


@styled
def changes_drawn(frame: pd.DataFrame, full: Mapping[str, tuple[float, float]], published: pd.DataFrame) -> Figure:
    """Change of the crack length by each reading at the lowest humidity, a panel for each pair.

    Below them full elastic contact, lines for published and measured lengths.

    Parameters
    ----------
    frame : DataFrame
        Of the table.
    full : dict
        Change by full elastic contact at the lowest humidity, and its standard error [%], by pair.
    published : DataFrame
        Rows of Table III.
    """
    lowest = frame[frame.relative_humidity == frame.groupby("pair").relative_humidity.transform("min")]
    pairs, most = frame.pair.unique(), len(frame[["reading", "spacing_nm"]].drop_duplicates())
    height = dots.AROUND + _LEGEND + dots.ROW * (2 + most)
    figure, columns, lines = columns_of_panels(len(pairs), 1, _width, height, sharey=True)
    titles = []
    for (panel,), pair in zip(columns, pairs, strict=True):
        of_pair = lowest[lowest.pair == pair]
        base = of_pair.iloc[0]
        reference = rows_of(published, pair=pair, relative_humidity=base.relative_humidity)
        length = base.crack_length_um / (1 + base.change_percent / 100)
        of_base = f"base: {_label(base)}, energies of {base.strips} strips"
        dots.references(panel, length, of_base, reference)
        change, error = full[pair]
        of_full_contact = dots.Mark(change, change, "black", dots.signed(change), error, "full elastic contact")
        attraction = choice_label(f"van_der_waals_{base.vdw}").removeprefix("van der Waals ") + " [%]"
        dots.draw(panel, _readings(of_pair) | {"full contact": [of_full_contact]}, column=attraction)
        panel.xaxis.set_major_locator(MaxNLocator(3))
        panel.set_xlabel("change of $l_s$ [%]")
        titles.append(f"pair {pair}, {Air(base.relative_humidity).words}")
    low, high = np.transpose([panel.get_xlim() for panel in columns.flat])
    for panel in columns.flat:
        panel.set_xlim(low.min(), high.max())
    letter_lines(lines, titles)
    entries, labels = handles(*columns.flat)
    entries.append(Line2D([], [], linestyle="", label="bars: ± standard error"))
    legend_outside(figure, (entries, [*labels, entries[-1].get_label()]), "lower", 2)
    return figure


def _width(columns):
    """Width of a figure of some pairs [in]."""
    return _LABELS + _PANEL * columns


def _label(row):
    """Reading and grid of a row."""
    return f"{row.reading}, {row.spacing_nm:g} nm"


def _readings(rows):
    """Marks of the readings of a pair by their label: with attraction of the solids and its number, and without."""
    media, marks = rows.vdw.unique().tolist(), {}
    for row in rows.itertuples():
        k, change = media.index(row.vdw), row.change_percent
        label = choice_label(f"van_der_waals_{row.vdw}")
        shown = {"error": row.change_se_percent, "label": label, "filled": k == 0}
        mark = dots.Mark(change, change, _COLOURS[k], dots.signed(change) * (k == 0), **shown)
        marks.setdefault(_label(row), []).append(mark)
    return marks


def _stage(kind, shows, draw, **declared):
    """Table or figure of the readings of an asperity."""
    return kind(
        "asperities",
        shows,
        inputs=lambda plan, at: {
            "studies": by_name("studies/asperities", plan.humid_pairs),
            "full": by_name("studies/full_contact", plan.humid_pairs),
            "beams": by_case("beams", plan.humid_cases, "_NG"),
            "published": published.file("table_3"),
        },
        settings=lambda plan, at: {"of_paper": plan.paper.pairs},
        compute=lambda data, settings: draw(
            data["studies"], data["full"], data["beams"], published.published_rows(data, settings)
        ),
        study="asperities",
        targets=("asperities",),
        **declared,
    )


STAGES = (
    _stage(table_stage, "Table III under several readings of an asperity", table),
    table_stage(
        "model_error_parts",
        "parts of the error of the model",
        inputs=lambda plan, at: {
            "studies": by_name("studies/asperities", plan.humid_pairs),
            "full": by_name("studies/full_contact", plan.humid_pairs),
        },
        compute=parts,
        study="asperities",
        targets=("asperities",),
    ),
    _stage(figure_stage, "crack lengths under several readings of an asperity", figure, category=STUDIES),
)
