"""Tables of the sensitivity (Fig. 13) and of Table III under other model choices, with standard errors."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
import xarray as xr

from stiction.analysis import variants as comparison
from stiction.estimates import mean_with_error
from stiction.plan.names import by_outcome
from stiction.report import published
from stiction.report.format import MISSING, UM, percent, with_error
from stiction.report.published import value
from stiction.report.table import Table, Term, table_stage
from stiction.stages.beams.variant_beams import by_pair, cases_of

_LABELS = {
    "van_der_waals": "van der Waals: {}",
    "psd": "PSD: {}",
    "asperity": "asperity: {}",
    "every": "grid × {}",
    "spacing_nm": "grid {} nm",
    "poisson_ratio": "ν = {}",
    "strips_per_element": "elements of {} strips",
    "reach": "van der Waals: across {} gaps",
    "adsorbed_nm": "{} nm of adsorbed water",
    "contact": "{} elastic contact",
}


def variant_label(name: str) -> str:
    """Label of a variant.

    Examples
    --------
    >>> variant_label("poisson_ratio_0.18"), variant_label("base"), variant_label("contact_full")
    ('ν = 0.18', 'base', 'full elastic contact')
    """
    key, _, chosen = name.rpartition("_")
    return _LABELS[key].format(chosen) if key else name


# Sensitivity, Fig. 13


def sensitivity(datasets: Mapping[tuple[str, str], xr.Dataset], published: pd.DataFrame) -> Table:
    """Fig. 13 in numbers, beside the published slopes of the mean. Datasets by pair and shifted moment."""
    frame = pd.DataFrame([row for at, dataset in datasets.items() for row in _slopes(dataset, *at, published)])
    caption = (
        "Fig. 13: normalised sensitivity (|x|/y) dy/dx of mean and standard deviation y of the meso-scale adhesion "
        "energy to a moment x of the beam's surface, ± standard error (published value): central differences of the "
        "logarithms, and one-sided differences (|x|/y) Δy/Δx of the mean to less and to more of the moment, which are "
        "the relative change of y over that of x."
    )
    published_texts = ["" if np.isnan(slope) else f" ({slope:+g})" for slope in frame.published]
    values = [with_error(row.slope, row.slope_se, "+") for row in frame.itertuples()]
    texts = frame.assign(
        cell=list(map(str.__add__, values, published_texts)),
        relative_humidity=frame.relative_humidity.map("{:g}".format),
    )
    over = ["pair"] * (frame.pair.nunique() > 1) + ["statistic", "relative_humidity"]
    wide = texts.pivot_table("cell", over, "moment", "first", sort=False)
    return Table(frame, caption, wide.reset_index().rename_axis(columns=None))


def _slopes(dataset, pair, moment, published):
    """Slopes of mean and standard deviation at every humidity, and differences of the mean to either side."""
    less, more = dataset.moment.values
    step = 100 * (more - less) / abs(more + less)
    estimates = {name: dataset.sel(statistic=name)[["slope", "standard_error"]] for name in dataset.statistic.values}
    for side, sign in zip(dataset.side.values, "-+", strict=True):
        estimates[f"mean, {sign}{step:.3g} %"] = dataset.sel(side=side)[["difference", "difference_error"]]
    for statistic, chosen in estimates.items():
        for humidity, slope, error in zip(
            dataset.humidity.values, *(chosen[name].values for name in chosen), strict=True
        ):
            case = {"pair": pair, "relative_humidity": humidity}
            of_paper = value(published, "slope", moment=moment, **case) if statistic.startswith("mean") else np.nan
            row = case | {"statistic": statistic, "moment": moment, "slope": slope, "slope_se": error}
            yield row | {"published": of_paper}


# Model choices


def variants(datasets: Mapping[tuple[str, str], xr.Dataset], published: pd.DataFrame) -> Table:
    """Table III, model NG, under other model choices: one row of numbers per pair, variant and humidity.

    The text for reading summarises each variant: its effect at the lowest and highest humidity, and the deviation over
    all humidities. The datasets are by pair and variant, ``base`` among them; Table III has the rows of the paper's own
    pairs.
    """
    frame = pd.DataFrame([row for key in datasets for row in _rows(key, datasets, published)])
    groups = dict(list(frame.groupby(["pair", "variant"], sort=False)))
    removed = {key: _removed_fraction(group, groups[key[0], "base"]) for key, group in groups.items()}
    for k, column in enumerate(("removed_percent", "removed_se_percent")):
        frame[column] = [100 * removed[key][k] for key in zip(frame.pair, frame.variant, strict=True)]
    cells = [_summary(key, group) for key, group in frame.groupby(["pair", "variant"], sort=False)]
    caption = (
        "Table III, model NG, under other model choices: change of the mean crack length and of the mean meso-scale "
        "energy against the base case, at the lowest and at the highest humidity; root mean square over the "
        "humidities of the deviation from the published and from the measured crack length; ± standard error."
    )
    removal = (
        "reduction of the mean square deviation from the published length by the variant, negative for an increase."
    )
    return Table(frame, [caption, Term("Removed", removal)], pd.DataFrame(cells))


def _rows(key, datasets, published):
    """One variant of a pair at every humidity."""
    pair, name = key
    for (humidity, case), (_, base) in zip(cases_of(datasets[key]), cases_of(datasets[pair, "base"]), strict=True):
        lengths = {
            column: value(published, column, pair=pair, relative_humidity=humidity) for column in ("ng", "experiment")
        }
        row = {"pair": pair, "variant": name, "relative_humidity": humidity}
        yield row | _effect(case, base) | _deviations(case, published=lengths["ng"], experiment=lengths["experiment"])


def _effect(case, base):
    """Effect of a variant on one case."""
    length, by_beams, common = comparison.crack_length_with_errors(case)
    shift, shift_error = comparison.shift(case, base)
    reference, _ = comparison.mean_crack_length(base)
    energy, energy_error = mean_with_error(case.energy)
    energy_shift, energy_shift_error = comparison.energy_shift(case, base)
    return {
        "crack_length_um": length / UM,
        "crack_length_se_um": np.hypot(by_beams, common) / UM,
        "crack_length_beams_se_um": by_beams / UM,
        "crack_length_pairs_se_um": common / UM,
        "shift_percent": 100 * shift / reference,
        "shift_se_percent": 100 * shift_error / reference,
        "share_s_shape": case.stuck.mean(),
        "meso_energy_J_per_m2": energy,
        "meso_energy_se_J_per_m2": energy_error,
        "meso_energy_shift_percent": 100 * energy_shift,
        "meso_energy_shift_se_percent": 100 * energy_shift_error,
    }


def _deviations(case, **references):
    """Deviations of a case from the published and the measured crack length [µm]."""
    length = comparison.mean_crack_length(case)[0] / UM
    row = {}
    for name, reference in references.items():
        row |= {f"{name}_um": reference, f"{name}_deviation_percent": percent(length, reference)}
    return row


def _summary(key, group):
    """One variant of a pair as text."""
    pair, name = key
    base, first = name == "base", group.iloc[0]
    row = {"pair": pair, "variant": variant_label(name)}
    for air, end in (("low RH", first), ("high RH", group.iloc[-1])):
        for title, column in (("Δl_s", "shift"), ("Δē", "meso_energy_shift")):
            change = with_error(end[f"{column}_percent"], end[f"{column}_se_percent"], "+")
            row[f"{title} [%], {air}"] = MISSING if base else change
    for title, column in (("published", "published_um"), ("measured", "experiment_um")):
        rms = _rms_deviation(group, column)
        row[f"rms dev. from {title} [%]"] = with_error(*(100 * x for x in rms)) if rms else MISSING
    removed = with_error(first.removed_percent, first.removed_se_percent, "+")
    return row | {"removed [%]": MISSING if base else removed}


def _removed_fraction(group, base):
    """Fraction of the mean square deviation from the published length removed by a variant, with its error [-]."""
    compared = (group.published_um.notna() & group.crack_length_um.notna()).values & base.crack_length_um.notna().values
    if not compared.any() or group is base:
        return np.nan, np.nan
    changed, unchanged = group[compared], base[compared]
    lengths = [group_or_base.crack_length_um.values for group_or_base in (changed, unchanged)]
    errors = [changed.shift_se_percent.values / 100 * lengths[1]]
    errors += [unchanged[f"crack_length_{cause}_se_um"].values for cause in ("beams", "pairs")]
    return comparison.removed_share(*lengths, changed.published_um.values, errors)


def _rms_deviation(group, column):
    """Root mean square deviation from the references in a column and its standard error, None without references."""
    compared = group[group[column].notna() & group.crack_length_um.notna()]
    if not len(compared):
        return None
    errors = compared.crack_length_beams_se_um, compared.crack_length_pairs_se_um
    return comparison.rms_deviation(compared.crack_length_um, *errors, compared[column])


STAGES = (
    table_stage(
        "sensitivity",
        "sensitivity to the moments of a surface",
        inputs=lambda plan, at: {
            "studies": plan.sensitivities,
            "published": published.file("sensitivity"),
        },
        settings=lambda plan, at: {"of_paper": plan.paper.pairs},
        compute=lambda data, settings: sensitivity(data["studies"], published.published_rows(data, settings)),
        study="sensitivity",
        targets=("figures", "study_figures"),
    ),
    table_stage(
        "variants",
        "Table III under other model choices",
        inputs=lambda plan, at: {
            "studies": by_outcome("studies/variants", plan.variants.cases),
            "published": published.file("table_3"),
        },
        settings=lambda plan, at: {"of_paper": plan.paper.pairs},
        compute=lambda data, settings: variants(by_pair(data["studies"]), published.published_rows(data, settings)),
        study="variants",
        targets=("figures", "study_figures"),
    ),
)
