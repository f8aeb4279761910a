"""Tables I, II and III beside the print, one row per surface or case; Monte-Carlo figures carry standard errors."""

import numpy as np
import pandas as pd

from stiction.beam.energy import CRACK_LENGTH_POWER
from stiction.contact.forcelaw import admissible
from stiction.estimates import jackknife, mean_on_shared_samples, mean_with_error
from stiction.stages.data import STATES, ended, save_text, vectors
from stiction.surface.spectrum import CutoffSelfAffine

NM, UM, PER_UM2 = 1e-9, 1e-6, 1e12
#: Parameters of Eq. (7) in the order of its class, with the unit of each column in SI.
_TABLE_2 = {
    "plateau_nm4": NM**4,
    "floor_nm4": NM**4,
    "corner_rad_per_um": 1 / UM,
    "cutoff_rad_per_um": 1 / UM,
}
_TABLE_1 = ("rms_nm", "skewness", "kurtosis", "mean_summit_radius_um", "summit_density_per_um2")


def published(path):
    """Printed table as a frame."""
    return pd.read_csv(path, comment="#")


def save(table, markdown, paths):
    """Write a table as CSV, for reading as Markdown, and the latter for the report as HTML."""
    save_text(table.to_csv(index=False), paths.csv)
    save_text(markdown, paths.markdown)
    save_text(html(markdown), paths.html)


def html(markdown):
    """Page of a caption and a table in Markdown."""
    caption, _, grid = markdown.partition("\n\n")
    titles, _, *rows = ([cell.strip() for cell in line.strip("|").split("|")] for line in grid.strip().splitlines())
    table = pd.DataFrame(rows, columns=titles).to_html(index=False, border=0)
    style = "body { font: 13px sans-serif } td, th { padding: 1px 10px; text-align: right }"
    return f'<!DOCTYPE html>\n<meta charset="utf-8">\n<style>{style}</style>\n<p>{caption}</p>\n{table}\n'


def percent(value, reference):
    """Deviation from a reference [%]."""
    return 100 * (value / reference - 1) if reference else np.nan


def surface_statistics(character):
    """Statistics of Table I of simulated strips with standard errors: two dicts in the units of the table."""

    def estimate(mean):
        m1, m2, m3, m4, density, curvature = mean
        variance = m2 - m1**2
        third = m3 - 3 * m1 * m2 + 2 * m1**3
        fourth = m4 - 4 * m1 * m3 + 6 * m1**2 * m2 - 3 * m1**4
        rms = np.sqrt(variance)
        return np.array([rms / NM, third / rms**3, fourth / rms**4, 1 / curvature / UM, density / PER_UM2])

    columns = [
        character.power.values,
        character.summit_density.values[:, None],
        character.mean_curvature.values[:, None],
    ]
    values, errors = jackknife(estimate, np.hstack(columns))
    return dict(zip(_TABLE_1, values, strict=True)), dict(zip(_TABLE_1, errors, strict=True))


def table_1(characters, measured, printed):
    """Table I: simulated statistics of the surfaces.

    Parameters
    ----------
    characters : dict
        (surface, model) to the dataset of stage character.
    measured : dict
        Surface to its section of the configuration, the statistics that were measured (AFM).
    printed : pandas.DataFrame
        The published table.
    """
    rows = []
    for (surface, model), character in characters.items():
        values, errors = surface_statistics(character)
        match = printed[(printed.surface == surface) & (printed.column == model)]
        row = {"surface": surface, "column": model}
        for name in _TABLE_1:
            target = measured[surface].get(name, np.nan)
            print_value = float(match[name].iloc[0]) if len(match) else np.nan
            row |= {
                name: values[name],
                f"{name}_se": errors[name],
                f"{name}_published": print_value,
                f"{name}_afm": target,
                f"{name}_deviation_percent": percent(values[name], print_value),
            }
        rows.append(row)
    return pd.DataFrame(rows)


def table_2(identifications, spectra, printed):
    """Table II: published and identified parameters of Eq. (7), and what the identification leaves.

    The rms of published parameters is that of the spectrum alone; radius and density are those of surfaces that were
    not used to identify it.

    Parameters
    ----------
    identifications, spectra : dict
        Surface to the datasets of stages identification and spectrum.
    printed : pandas.DataFrame
        The published table, with corrected plateaus.
    """
    rows = []
    for surface, found in identifications.items():
        match = printed[printed.surface == surface]
        if len(match):
            rows.append(_row_2(surface, "published", match[list(_TABLE_2)].iloc[0].to_dict(), found, spectra[surface]))
            rows[-1]["plateau_nm4_as_printed"] = float(match.plateau_nm4_as_printed.iloc[0])
        parameters = {name: float(found[name.split("_")[0]]) / unit for name, unit in _TABLE_2.items()}
        rows.append(_row_2(surface, "identified", parameters, found, spectra[surface]) | _residuals(found))
    return pd.DataFrame(rows)


def _row_2(surface, source, parameters, found, spectrum):
    """Parameters of Eq. (7) in the units of the table, their rms, and the defect if it is they that are used."""
    shape = CutoffSelfAffine(**{name.split("_")[0]: parameters[name] * unit for name, unit in _TABLE_2.items()})
    row = {"surface": surface, "psd": source} | parameters
    row["rms_residual_percent"] = percent(np.sqrt(shape.variance), float(found.target_rms))
    used = np.allclose([shape.corner / float(spectrum.corner), shape.slope / _slope(spectrum)], 1, rtol=1e-9)
    return row | {"gaussian_defect_percent": 100 * float(spectrum.defect) if used else np.nan}


def _slope(spectrum):
    """Exponent of the power law of a dataset of stage spectrum [-]."""
    return CutoffSelfAffine(*(float(spectrum[name.split("_")[0]]) for name in _TABLE_2)).slope


def _residuals(found):
    """What an identification leaves of radius and density, with standard errors [%]."""
    row = {}
    for column, name in (("radius", "mean_radius"), ("density", "summit_density")):
        target = float(found[f"target_{name}"])
        row[f"{column}_residual_percent"] = percent(float(found[name]), target)
        row[f"{column}_residual_se_percent"] = 100 * float(found[f"{name}_error"]) / target
    return row


def table_3(beams, forces, printed):
    """Table III: crack lengths and adhesion energies of released beams.

    Parameters
    ----------
    beams, forces : dict
        (pair, humidity, model) to the datasets of stages beams and forces.
    printed : pandas.DataFrame
        The published table.
    """
    return pd.DataFrame([_row_3(key, beams[key], forces[key], printed) for key in beams])


def _row_3(key, beams, forces, printed):
    """One case: what was computed, what was printed, what was measured.

    ASSUME: averages are those of S-shaped beams; crack length and energy of another end state mean nothing.
    """
    pair, humidity, model = key
    row = {"pair": pair, "relative_humidity": humidity, "model": model} | _simulated(beams, forces)
    match = printed[(printed.pair == pair) & np.isclose(printed.relative_humidity, humidity)]
    print_of = {"NG": ("ng", "ng_std"), "GEO": ("geo", "geo_std")}.get(model)
    for name, columns in (("published", print_of), ("experiment", ("experiment", "experiment_std"))):
        row |= dict(zip((f"{name}_um", f"{name}_std_um"), _printed(match, columns), strict=True))
    for name, reference in (("deviation", "published_um"), ("experiment_deviation", "experiment_um")):
        row[f"{name}_percent"] = percent(row["crack_length_um"], row[reference])
    # What the paper calls bias error: the size of the deviation of its own model NG from experiment.
    bias = float(match.bias_error_percent.iloc[0]) if model == "NG" and len(match) else np.nan
    return row | {"published_bias_error_percent": bias}


def _simulated(beams, forces):
    """Crack length and energies of one case; errors are over beams and over the sampled pairs that all beams share."""
    stuck, meso = ended(beams, "S-shape"), forces.adhesion_energy.values
    quantities = {
        "crack_length": ("um", beams.crack_length.values[stuck] / UM, CRACK_LENGTH_POWER),
        "adhesion_energy": ("J_per_m2", beams.adhesion_energy.values[stuck], 1),
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
    # Beams meet only those pairs that Eq. (12) can follow.
    lawful = admissible(vectors(forces), float(forces.limit))
    row |= {"share_without_law": float(np.mean(~lawful)), "meso_energy_lawful_J_per_m2": meso[lawful].mean()}
    return row | {f"share_{state.lower().replace('-', '_')}": float(ended(beams, state).mean()) for state in STATES}


def _printed(match, columns):
    """Two printed numbers, or none where the paper has none."""
    if columns is None or not len(match):
        return np.nan, np.nan
    return tuple(match[list(columns)].iloc[0].astype(float))


def markdown_1(table):
    """Table I for reading: value ± standard error (print)."""

    def cell(row, name):
        value, error, printed = row[name], row[f"{name}_se"], row[f"{name}_published"]
        digits = max(0, 1 - int(np.floor(np.log10(error))))
        return f"{value:.{digits}f} ± {error:.{digits}f}" + (f" ({printed:g})" if np.isfinite(printed) else "")

    columns = ["surface", "model", "rms [nm]", "skewness", "kurtosis", "summit radius [µm]", "summits [µm⁻²]"]
    rows = [[row.surface, row.column] + [cell(row, name) for name in _TABLE_1] for _, row in table.iterrows()]
    caption = "Table I: simulated value ± standard error (printed value)."
    return caption + "\n\n" + pd.DataFrame(rows, columns=columns).to_markdown(index=False) + "\n"


def markdown_2(table):
    """Table II for reading."""

    def residual(row, name):
        value, error = row[f"{name}_residual_percent"], row[f"{name}_residual_se_percent"]
        return "–" if np.isnan(value) else f"{value:+.2f} ± {error:.2f}"

    rows = [
        {
            "surface": row.surface,
            "psd": row.psd,
            "s⁰ [nm⁴]": f"{row.plateau_nm4:.4g}",
            "s¹ [nm⁴]": f"{row.floor_nm4:.3g}",
            "ζ₀ [rad/µm]": f"{row.corner_rad_per_um:.3g}",
            "ζ_max [rad/µm]": f"{row.cutoff_rad_per_um:.3g}",
            "rms off by [%]": f"{round(row.rms_residual_percent, 2) + 0.0:+.2f}",
            "radius off by [%]": residual(row, "radius"),
            "density off by [%]": residual(row, "density"),
            "defect [%]": "–" if np.isnan(row.gaussian_defect_percent) else f"{row.gaussian_defect_percent:.2g}",
        }
        for _, row in table.iterrows()
    ]
    caption = (
        "Table II: parameters of Eq. (7), as published (with corrected plateaus) and as identified from the summits; "
        "deviations from the measured (AFM) rms, summit radius and density, on surfaces not used to identify; defect: "
        "share of the variance that no Gaussian field provides, of the spectrum in use."
    )
    return caption + "\n\n" + pd.DataFrame(rows).to_markdown(index=False) + "\n"


def markdown_3(table):
    """Table III for reading: crack length of S-shaped beams, mean ± standard deviation."""

    def number(value, form):
        return "–" if np.isnan(value) else format(value, form)

    def spread(mean, deviation):
        return "–" if np.isnan(mean) else f"{mean:.0f} ± {number(deviation, '.0f')}"

    rows = [
        {
            "pair": row.pair,
            "RH": f"{row.relative_humidity:g}",
            "model": row.model,
            "l_s [µm]": spread(row.crack_length_um, row.crack_length_std_um),
            "se": number(row.crack_length_se_um, ".1f"),
            "printed": spread(row.published_um, row.published_std_um),
            "dev. print [%]": number(row.deviation_percent, "+.1f"),
            "experiment": spread(row.experiment_um, row.experiment_std_um),
            "dev. exp. [%]": number(row.experiment_deviation_percent, "+.0f"),
            "printed bias [%]": number(row.published_bias_error_percent, "g"),
            "Γ [mJ/m²]": number(1e3 * row.adhesion_energy_J_per_m2, ".3g"),
            "ē [mJ/m²]": number(1e3 * row.meso_energy_J_per_m2, ".3g"),
            "cv(ē)": number(row.meso_energy_cv, ".3f"),
            "S/arc/free [%]": "/".join(f"{100 * row[f'share_{state}']:.3g}" for state in ("s_shape", "arc", "free")),
        }
        for _, row in table.iterrows()
    ]
    caption = (
        "Table III: crack length of the S-shaped beams, mean ± standard deviation over the beams; se: standard error of"
        " the mean, over beams and sampled pairs of surfaces; deviations from the printed and from the measured length."
    )
    return caption + "\n\n" + pd.DataFrame(rows).to_markdown(index=False) + "\n"
