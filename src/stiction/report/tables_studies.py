"""Tables of the studies beside the main line, each number with its standard error."""

import numpy as np
import pandas as pd

from stiction.estimates import mean_with_error
from stiction.report.tables import percent
from stiction.stages.data import ended
from stiction.studies import variants as choices

UM = 1e-6
_LABELS = {
    "van_der_waals": "vdW: {}",
    "psd": "PSD: {}",
    "every": "grid × {}",
    "spacing_nm": "grid {} nm",
    "poisson_ratio": "ν = {}",
    "strips_per_element": "elements of {} strips",
}


def reading_label(name):
    """Name of a reading in words.

    Examples
    --------
    >>> reading_label("poisson_ratio_0.18"), reading_label("base")
    ('ν = 0.18', 'base')
    """
    key, _, value = name.rpartition("_")
    return _LABELS[key].format(value) if key else name


def sensitivity(datasets, pair, printed):
    """Fig. 13 in numbers.

    Parameters
    ----------
    datasets : dict
        Moment to the dataset of study sensitivity.
    pair : str
    printed : pandas.DataFrame
        The numbers that the paper states.
    """
    rows = []
    for moment, dataset in datasets.items():
        for statistic in dataset.statistic.values:
            chosen = dataset.sel(statistic=statistic)
            for humidity, slope, error in zip(
                dataset.humidity.values, chosen.slope.values, chosen.standard_error.values, strict=True
            ):
                match = printed[
                    (printed.pair == pair)
                    & (printed.moment == moment)
                    & np.isclose(printed.relative_humidity, humidity)
                    & (statistic == "mean")
                ]
                row = {"pair": pair, "relative_humidity": humidity, "statistic": statistic, "moment": moment}
                row |= {"slope": slope, "slope_se": error}
                rows.append(row | {"published": float(match.slope.iloc[0]) if len(match) else np.nan})
    return pd.DataFrame(rows)


def markdown_sensitivity(table):
    """Fig. 13 for reading: one row per statistic and humidity, one column per moment."""
    printed = ["" if np.isnan(slope) else f" ({slope:+g})" for slope in table.published]
    values = [with_error(row.slope, row.slope_se, "+") for row in table.itertuples()]
    cells = table.assign(cell=list(map(str.__add__, values, printed)))
    wide = cells.pivot_table("cell", ["statistic", "relative_humidity"], "moment", "first", sort=False)
    caption = (
        "Fig. 13: normalised sensitivity (|x|/y) dy/dx of mean and standard deviation y of the meso-scale adhesion "
        "energy to a moment x of the beam's surface, ± standard error (printed value)."
    )
    return caption + "\n\n" + wide.reset_index().to_markdown(index=False) + "\n"


def with_error(value, error, sign=""):
    """Value ± standard error as text, to the first digit of the error, or to the second if the first is 1; – for NaN.

    Examples
    --------
    >>> with_error(57.82009, 0.19801), with_error(-4.9, 0.042, "+")
    ('57.82 ± 0.20', '-4.90 ± 0.04')
    """
    if np.isnan(value):
        return "–"
    if not error > 0:
        return f"{value:{sign}g} ± {error:g}"
    first = int(np.floor(np.log10(error)))
    digits = max(0, (error < 2 * 10.0**first) - first)
    return f"{value:{sign}.{digits}f} ± {error:.{digits}f}"


def resampling(beams, resampled):
    """Crack lengths of model NG under laws drawn from the chaos model and from the samples themselves.

    Both rest on the same pairs of surfaces: their difference has the standard errors of the beams alone.

    Parameters
    ----------
    beams, resampled : dict
        (pair, humidity) to the datasets of stage beams and of study resampling.
    """
    rows = []
    for (pair, humidity), released in beams.items():
        (chaos, chaos_error), (samples, samples_error) = map(_crack_length, (released, resampled[pair, humidity]))
        row = {"pair": pair, "relative_humidity": humidity, "chaos_um": chaos, "chaos_se_um": chaos_error}
        row |= {"samples_um": samples, "samples_se_um": samples_error, "difference_percent": percent(chaos, samples)}
        rows.append(row | {"difference_se_percent": 100 * np.hypot(chaos_error, samples_error) / samples})
    return pd.DataFrame(rows)


def _crack_length(beams):
    """Mean crack length of the S-shaped beams and its standard error over beams; NaN of less than two [µm]."""
    stuck = beams.crack_length.values[ended(beams, "S-shape")] / UM
    return mean_with_error(stuck) if len(stuck) >= 2 else (np.nan, np.nan)


def markdown_resampling(table):
    """The comparison for reading."""
    rows = [
        {
            "pair": row.pair,
            "RH": f"{row.relative_humidity:g}",
            "l_s, chaos model [µm]": with_error(row.chaos_um, row.chaos_se_um),
            "l_s, samples [µm]": with_error(row.samples_um, row.samples_se_um),
            "difference [%]": with_error(row.difference_percent, row.difference_se_percent, "+"),
        }
        for row in table.itertuples()
    ]
    caption = (
        "What the chaos model does to the crack length, model NG: mean under laws drawn from it, and under laws of the "
        "sampled pairs themselves, drawn with replacement; ± standard error over beams."
    )
    return caption + "\n\n" + pd.DataFrame(rows).to_markdown(index=False) + "\n"


def cases_of(dataset):
    """Every case of a dataset of study readings: (humidity, `stiction.studies.variants.Reading`)."""
    for k, humidity in enumerate(dataset.humidity.values):
        chosen = dataset.isel(humidity=k)
        yield (
            float(humidity),
            choices.Reading(chosen.adhesion_energy.values, chosen.crack_length.values, ended(chosen, "S-shape")),
        )


def readings(datasets, printed):
    """Table III, model NG, under several readings of the paper: one row per pair, reading and humidity.

    Parameters
    ----------
    datasets : dict
        (pair, reading) to the dataset of study readings; each pair has the reading ``base``.
    printed : pandas.DataFrame
        Table III as published.
    """
    rows = []
    for (pair, name), dataset in datasets.items():
        for (humidity, case), (_, base) in zip(cases_of(dataset), cases_of(datasets[pair, "base"]), strict=True):
            match = printed[(printed.pair == pair) & np.isclose(printed.relative_humidity, humidity)]
            row = {"pair": pair, "reading": name, "relative_humidity": humidity}
            rows.append(row | _effect(case, base) | _compared(case, match))
    return pd.DataFrame(rows)


def _effect(case, base):
    """What a reading does to one case."""
    length, own, common = choices.crack_length_with_errors(case)
    shift, shift_error = choices.shift(case, base)
    reference, _ = choices.mean_crack_length(base)
    energy, energy_error = mean_with_error(case.energy)
    energy_shift, energy_shift_error = choices.energy_shift(case, base)
    return {
        "crack_length_um": length / UM,
        "crack_length_se_um": np.hypot(own, common) / UM,
        "crack_length_beams_se_um": own / UM,
        "crack_length_pairs_se_um": common / UM,
        "shift_percent": 100 * shift / reference,
        "shift_se_percent": 100 * shift_error / reference,
        "share_s_shape": case.stuck.mean(),
        "meso_energy_J_per_m2": energy,
        "meso_energy_se_J_per_m2": energy_error,
        "meso_energy_shift_percent": 100 * energy_shift,
        "meso_energy_shift_se_percent": 100 * energy_shift_error,
    }


def _compared(case, match):
    """Deviation of a case from the printed and the measured crack length."""
    length = choices.mean_crack_length(case)[0] / UM
    row = {}
    for column, name in (("ng", "published"), ("experiment", "experiment")):
        reference = float(match[column].iloc[0]) if len(match) else np.nan
        row |= {f"{name}_um": reference, f"{name}_deviation_percent": percent(length, reference)}
    return row


def markdown_readings(table):
    """Summary for reading: effect at the lowest and highest humidity, deviation over all humidities."""
    groups = dict(list(table.groupby(["pair", "reading"], sort=False)))
    rows = [_summary(*key, group, groups[key[0], "base"]) for key, group in groups.items()]
    caption = (
        "Table III, model NG, under other readings of the paper: change of the mean crack length and of the mean "
        "meso-scale energy against the base reading, at the lowest and at the highest humidity; root mean square over "
        "the humidities of the deviation from the printed and from the measured crack length; ± standard error. "
        "Removed: share of the mean square deviation from print that vanishes with the reading; negative: that it adds."
    )
    return caption + "\n\n" + pd.DataFrame(rows).to_markdown(index=False) + "\n"


def _summary(pair, name, group, base):
    """One row of the summary."""
    row = {"pair": pair, "reading": reading_label(name)}
    for which, end in (("low RH", group.iloc[0]), ("high RH", group.iloc[-1])):
        for title, column in (("Δl_s", "shift"), ("Δē", "meso_energy_shift")):
            change = with_error(end[f"{column}_percent"], end[f"{column}_se_percent"], "+")
            row[f"{title} [%], {which}"] = "–" if name == "base" else change
    for title, column in (("print", "published_um"), ("experiment", "experiment_um")):
        rms = _rms_deviation(group, column)
        row[f"rms dev. from {title} [%]"] = with_error(*(100 * x for x in rms)) if rms else "–"
    return row | {"removed [%]": "–" if name == "base" else _removed(group, base)}


def _removed(group, base):
    """Share of the mean square deviation from print that a reading removes, as text [%]."""
    known = (group.published_um.notna() & group.crack_length_um.notna()).values & base.crack_length_um.notna().values
    if not known.any():
        return "–"
    here, there = group[known], base[known]
    lengths = [of.crack_length_um.values for of in (here, there)]
    errors = [here.shift_se_percent.values / 100 * lengths[1]]
    errors += [there[f"crack_length_{part}_se_um"].values for part in ("beams", "pairs")]
    share, error = choices.removed_share(*lengths, here.published_um.values, errors)
    return with_error(100 * share, 100 * error, "+")


def _rms_deviation(group, column):
    """Root mean square deviation from the references in a column and its standard error; None without references."""
    known = group[group[column].notna() & group.crack_length_um.notna()]
    if not len(known):
        return None
    errors = known.crack_length_beams_se_um, known.crack_length_pairs_se_um
    return choices.rms_deviation(known.crack_length_um, *errors, known[column])
