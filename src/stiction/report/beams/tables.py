"""Tables of force laws and beams: Table III compared with the published one, the fit by Eq. (12), the chaos model."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
import xarray as xr

from stiction.beam.energy import CRACK_LENGTH_POWER
from stiction.config.units import in_si
from stiction.contact.environment import Water
from stiction.contact.forcelaw import admissible
from stiction.estimates import mean_on_shared_samples, mean_with_error
from stiction.models import surface_model
from stiction.plan.names import Outcome, by_case, by_name, by_outcome
from stiction.report import published
from stiction.report.beams import prediction
from stiction.report.format import TO_MJ, UM, as_published, error_alone, number, percent, signed, with_error
from stiction.report.limits.words import texts
from stiction.report.model_error import column as beside
from stiction.report.published import value
from stiction.report.table import PAIR, Table, Term, table_stage, warned
from stiction.stages.beams import pair_warnings
from stiction.stages.beams.releases import STATES, ends_as, stuck_energies, stuck_lengths
from stiction.stages.laws import forces as stage_forces
from stiction.stages.laws.scan_uncertainty import pair_errors
from stiction.stages.surfaces import surface_flags

#: Columns of the published Table III: mean and standard deviation of each model.
_PUBLISHED = {"NG": ("ng", "ng_std"), "GEO": ("geo", "geo_std")}


# Table III


def table_3(
    beams: Mapping[Outcome, xr.Dataset],
    forces: Mapping[Outcome, xr.Dataset],
    published: pd.DataFrame,
    by_scans: Mapping[tuple[str, float], float] | None = None,
    warnings: Sequence[str] = (),
    errors: Mapping[str, xr.Dataset] | None = None,
) -> Table:
    """Table III: crack lengths and adhesion energies of released beams. Beams of model GEO have the forces of NG.

    The published table has the rows of the paper's own pairs. ``by_scans`` are relative standard errors of ē due to
    finite scans, by pair and humidity, of pairs with measured surfaces; warnings are sentences about single cases;
    errors of the model are by pair.
    """
    rows = [_row_3(key, beams[key], forces[*key[:2], surface_model(key[2])], published) for key in beams]
    if by_scans:
        rows = [row | _by_scans(row, by_scans) for row in rows]
    if errors:
        rows = [row | _by_model(row, errors) for row in rows]
    rows = prediction.with_intervals(rows)
    predicted = pd.DataFrame(rows) if prediction.ENDS[prediction.COVERAGES[0]][0] in rows[0] else None
    shows = [
        *_TABLE_3_SHOWS,
        *([_SCANS] if by_scans else []),
        *([beside.caption(errors)] if errors else []),
        *([] if predicted is None else [prediction.caption(predicted)]),
        *warned(warnings),
    ]
    columns = {title: column for title, column in _TABLE_3.items() if by_scans or "scans" not in title}
    columns |= (beside.COLUMN if errors else {}) | (prediction.COLUMNS if predicted is not None else {})
    return Table.from_rows(rows, shows, columns)


#: What columns of Table III show.
_TABLE_3_SHOWS = (
    "Table III: crack length of the S-shaped beams, mean ± standard deviation over the beams; se: standard error of "
    "the mean, over beams and samples; deviations from the published and from the measured length.",
    Term(
        "Published bias",
        "absolute deviation of the paper's model NG from the measured length, as the paper states it.",
    ),
    Term(
        "Γ",
        "mean apparent adhesion energy of the S-shaped beams, Eq. (13); ē: mean energy of the samples; cv(ē): their "
        "standard deviation over their mean.",
    ),
    Term(
        "S/arc/free",
        "shares of the end states of the beams; an arc is held by its tip alone. The share of arcs depends on the "
        "length of the strips and is no prediction. Where the share of S-shapes is small, se is the error of these "
        "few beams, not of the mean over all beams.",
    ),
)
_SCANS = Term("Scans", "standard error of the mean due to the finite scans of measured surfaces.")


def _row_3(key, beams, forces, published):
    """One case: computed, published and measured.

    ASSUME: averages are over S-shaped beams; crack length and energy of any other end state are not meaningful.
    """
    pair, humidity, model = key
    case = {"pair": pair, "relative_humidity": humidity}
    row = case | {"model": model} | _simulated_numbers(beams, forces)
    for name, columns in (("published", _PUBLISHED.get(model)), ("experiment", ("experiment", "experiment_std"))):
        numbers = [value(published, column, **case) for column in columns] if columns else [np.nan, np.nan]
        row |= dict(zip((f"{name}_um", f"{name}_std_um"), numbers, strict=True))
    for name, reference in (("deviation", "published_um"), ("experiment_deviation", "experiment_um")):
        row[f"{name}_percent"] = percent(row["crack_length_um"], row[reference])
    # The bias error of the paper: the absolute deviation of its own model NG from experiment.
    bias = value(published, "bias_error_percent", **case) if model == "NG" else np.nan
    return row | {"published_bias_error_percent": bias}


def _simulated_numbers(beams, forces):
    """Crack length and energies of one case, with errors over beams and over their common samples."""
    meso = stage_forces.energies(forces)
    quantities = {
        "crack_length": ("um", stuck_lengths(beams) / UM, CRACK_LENGTH_POWER),
        "adhesion_energy": ("J_per_m2", stuck_energies(beams), 1),
    }
    row = {}
    for name, (unit, values, power) in quantities.items():
        mean = spread = error = np.nan
        if len(values) >= 2:
            mean, *errors = mean_on_shared_samples(values, meso, power)
            spread, error = values.std(ddof=1), np.hypot(*errors)
        row |= {f"{name}_{unit}": mean, f"{name}_std_{unit}": spread, f"{name}_se_{unit}": error}
    mean, error = mean_with_error(meso)
    row |= {"meso_energy_J_per_m2": mean, "meso_energy_se_J_per_m2": error, "meso_energy_cv": meso.std(ddof=1) / mean}
    # Beams are released only on samples that have a force law of Eq. (12).
    lawful = admissible(*stage_forces.vectors(forces))
    row |= {"share_without_law": float(np.mean(~lawful)), "meso_energy_lawful_J_per_m2": meso[lawful].mean()}
    return row | {_share(state): float(ends_as(beams, state).mean()) for state in STATES}


def _by_scans(row, relative):
    """Standard errors of the means of one case due to finite scans.

    They are those of the surfaces in use: there are none for Gaussian heights.
    """
    error = relative.get((row["pair"], row["relative_humidity"]), np.nan) if row["model"] != "G" else np.nan
    return {
        "crack_length_scans_se_um": abs(CRACK_LENGTH_POWER) * error * row["crack_length_um"],
        "adhesion_energy_scans_se_J_per_m2": error * row["adhesion_energy_J_per_m2"],
        "meso_energy_scans_se_J_per_m2": error * row["meso_energy_J_per_m2"],
    }


def _by_model(row, errors):
    """Error of the model of one case. For Gaussian heights it was not computed."""
    is_known = row["model"] != "G" and row["pair"] in errors
    return beside.change(errors[row["pair"]].sel(humidity=row["relative_humidity"]) if is_known else None)


def _share(state):
    """Name of the column with the share of an end state."""
    return f"share_{state.lower().replace('-', '_')}"


def _in_mJ(energy):
    """Energy per area as text [mJ m⁻²]."""
    return number(TO_MJ * energy, ".3g")


_TABLE_3 = PAIR | {
    "model": (str, "model"),
    "l_s [µm]": (with_error, "crack_length_um", "crack_length_std_um"),
    "se": (error_alone, "crack_length_se_um"),
    "se, scans": (error_alone, "crack_length_scans_se_um"),
    "published": (as_published, "published_um", "published_std_um"),
    "dev. published [%]": ("+.1f", "deviation_percent"),
    "measured": (as_published, "experiment_um", "experiment_std_um"),
    "dev. measured [%]": ("+.0f", "experiment_deviation_percent"),
    "published bias [%]": ("g", "published_bias_error_percent"),
    "Γ [mJ/m²]": (_in_mJ, "adhesion_energy_J_per_m2"),
    "ē [mJ/m²]": (_in_mJ, "meso_energy_J_per_m2"),
    "se of ē, scans": (lambda error: error_alone(TO_MJ * error), "meso_energy_scans_se_J_per_m2"),
    "cv(ē)": (".3f", "meso_energy_cv"),
    "S/arc/free [%]": (lambda *shares: "/".join(f"{100 * share:.3g}" for share in shares), *map(_share, STATES)),
}


# Fit by Eq. (12), Fig. 5


def fit_quality(fits: Mapping[Outcome, xr.Dataset]) -> Table:
    """Relative errors of curve and energy by Eq. (12) over all samples, one row per case and model."""
    caption = (
        "Fit by Eq. (12): relative error of the curve for d ≥ d_limit, mean ± standard error, and of the energy ē."
    )
    return Table.from_rows((_row_fit(key, fit) for key, fit in fits.items()), caption, _FIT)


def _row_fit(key, fit):
    """Case, fraction of samples without a law, and errors of the others, NaN for fewer than two."""
    row = dict(zip(("pair", "relative_humidity", "model"), key, strict=True))
    curve, energy = 100 * fit.curve_error.values, 100 * fit.energy_error.values
    mean = error = median = high = largest = np.nan
    if len(curve) >= 2:
        mean, error = mean_with_error(curve)
        median, high, largest = np.median(curve), np.quantile(curve, 0.95), energy.max()
    return row | {
        "samples": len(curve),
        "share_without_law": float(fit.without_law),
        "curve_error_percent": mean,
        "curve_error_se_percent": error,
        "curve_error_median_percent": median,
        "curve_error_95_percent": high,
        "energy_error_max_percent": largest,
    }


_FIT = PAIR | {
    "model": (str, "model"),
    "curve [%]": (with_error, "curve_error_percent", "curve_error_se_percent"),
    "median [%]": (".2f", "curve_error_median_percent"),
    "95 % of samples below [%]": (".1f", "curve_error_95_percent"),
    "ē at most [%]": (".0e", "energy_error_max_percent"),
    "without law [%]": (lambda share: number(100 * share, ".2g"), "share_without_law"),
}


# Chaos model, App. B


def resampling(
    beams: Mapping[tuple[str, float], xr.Dataset], resampled: Mapping[tuple[str, float], xr.Dataset]
) -> Table:
    """Crack lengths of model NG under laws drawn from the chaos model and from the samples themselves.

    Both use the same pairs of surfaces, so that the standard error of their difference is that of the beams alone.
    Datasets are by pair and humidity.
    """
    caption = (
        "Effect of the chaos model on the crack length, model NG: mean under laws drawn from it, and under laws of the "
        "samples themselves, drawn with replacement; ± standard error over beams."
    )
    return Table.from_rows((_row_resampling(key, beams[key], resampled[key]) for key in beams), caption, _RESAMPLING)


def _row_resampling(key, beams, resampled):
    """One case: both crack lengths and their difference."""
    (chaos, chaos_error), (samples, samples_error) = map(_crack_length, (beams, resampled))
    return {
        "pair": key[0],
        "relative_humidity": key[1],
        "chaos_um": chaos,
        "chaos_se_um": chaos_error,
        "samples_um": samples,
        "samples_se_um": samples_error,
        "difference_percent": percent(chaos, samples),
        "difference_se_percent": 100 * np.hypot(chaos_error, samples_error) / samples,
    }


def _crack_length(beams):
    """Mean crack length of the S-shaped beams and its standard error over beams, NaN for fewer than two [µm]."""
    stuck = stuck_lengths(beams) / UM
    return mean_with_error(stuck) if len(stuck) >= 2 else (np.nan, np.nan)


_RESAMPLING = PAIR | {
    "l_s, chaos model [µm]": (with_error, "chaos_um", "chaos_se_um"),
    "l_s, samples [µm]": (with_error, "samples_um", "samples_se_um"),
    "difference [%]": (signed, "difference_percent", "difference_se_percent"),
}


def _table_3(data, settings):
    """Averages over the beams of every case, with published and measured lengths."""
    scanned = ((pair, pair_errors(study)) for pair, study in data["by_scans"].items())
    by_scans = {(pair, humidity): error for pair, errors in scanned for humidity, error in errors.items()}
    water = {pair: in_si(Water, section) for pair, section in settings["water"].items()}
    films = pair_warnings.film_warnings(data["beams"], water)
    flags = pair_warnings.surface_notes(data, settings["surfaces"], settings["assumed"])
    listed = [*films.items(), *((f"Pair {pair}", limits) for pair, limits in flags.items())]
    warnings = [f"{subject}: {sentence}" for subject, limits in listed for sentence in texts(limits)]
    paper = published.published_rows(data, settings)
    return table_3(data["beams"], data["forces"], paper, by_scans, warnings, data.get("errors"))


STAGES = (
    table_stage(
        "table_3",
        "crack lengths and adhesion energies",
        inputs=lambda plan, at: (
            {
                "beams": by_outcome("beams", plan.outcomes),
                "forces": by_outcome("forces", plan.laws),
                "by_scans": by_name("studies/scan_uncertainty", plan.scanned_pairs),
                "published": published.file("table_3"),
            }
            | beside.error_inputs(plan)
            | surface_flags.inputs(plan, *plan.pairs)
        ),
        settings=lambda plan, at: {
            "of_paper": plan.paper.pairs,
            "surfaces": {pair: plan.scans.sides(pair) for pair in plan.pairs},
            "assumed": plan.limits_of_pairs(),
            "water": {pair: plan.air.water(pair) for pair in plan.pairs},
        },
        compute=_table_3,
        targets=("tables", "measured"),
    ),
    table_stage(
        "fit_quality",
        "fit of the force curves by Eq. (12)",
        name="fit_quality",
        inputs=lambda plan, at: {"fits": by_outcome("fit", plan.laws)},
        compute=fit_quality,
        targets=("figures",),
    ),
    table_stage(
        "resampling",
        "effect of the chaos model on the crack length",
        inputs=lambda plan, at: {
            "beams": by_case("beams", plan.cases, "_NG"),
            "resampled": by_case("studies/resampling", plan.cases),
        },
        compute=resampling,
        study="resampling",
        targets=("figures", "study_figures"),
    ),
)
