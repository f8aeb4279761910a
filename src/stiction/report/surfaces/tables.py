"""Tables I and II compared with the published ones: statistics and spectra of the surfaces."""

from collections.abc import Mapping
from itertools import chain

import numpy as np
import pandas as pd
import xarray as xr

from stiction.models import MOMENT_KEYS, SUMMIT_KEYS, SURFACE_MODELS
from stiction.plan.names import by_model, by_name
from stiction.plan.stage import subsection
from stiction.report import published
from stiction.report.format import NM, PER_UM2, UM, percent, signed, with_error
from stiction.report.published import rows, value
from stiction.report.table import Table, table_stage
from stiction.stages.surfaces import estimate
from stiction.stages.surfaces.character import statistics
from stiction.stages.surfaces.heights import substitution
from stiction.stages.surfaces.parameters import misfits, spectrum_of
from stiction.surface.spectrum import CutoffSelfAffine

#: Statistics of Table I and their titles for reading.
_STATISTICS = {
    "rms_nm": "rms [nm]",
    "skewness": "skewness",
    "kurtosis": "kurtosis",
    "mean_summit_radius_um": "summit radius [µm]",
    "summit_density_per_um2": "summits [µm⁻²]",
}
#: Their units in SI.
_UNITS = (NM, 1, 1, UM, PER_UM2)
#: Parameters of Eq. (7) in the order of its class, with the unit of each column in SI.
_PARAMETERS = {
    "plateau_nm4": NM**4,
    "floor_nm4": NM**4,
    "corner_rad_per_um": 1 / UM,
    "cutoff_rad_per_um": 1 / UM,
}


# Table I


def surface_statistics(character: xr.Dataset) -> tuple[dict[str, float], dict[str, float]]:
    """Statistics of Table I of simulated strips and their standard errors, in the units of the table."""
    return tuple(dict(zip(_STATISTICS, values, strict=True)) for values in statistics(character, _UNITS))


def table_1(
    characters: Mapping[tuple[str, str], xr.Dataset],
    measured: Mapping[str, Mapping],
    published: pd.DataFrame,
    substitutions: Mapping[str, str],
) -> Table:
    """Table I: simulated statistics of the surfaces, by surface and model, beside measured (AFM) and published ones.

    Measured statistics have the keys of the configuration; published rows are of the paper's own surfaces. The
    ``substitutions`` are the sentences of `stiction.stages.surfaces.heights.substitution` by surface.
    """
    rows = [_row_1(*key, characters[key], measured[key[0]], published) for key in characters]
    notes = (f" {surface}: {sentence}." for surface, sentence in substitutions.items() if sentence)
    caption = (
        "Table I: simulated value ± standard error (value simulated in the paper). The measured values (AFM) are in "
        "the columns _afm of the CSV file."
    ) + "".join(notes)
    return Table.from_rows(rows, caption, _TABLE_1)


def _row_1(surface, model, character, measured, published):
    """One surface with one height model."""
    values, errors = surface_statistics(character)
    row = {"surface": surface, "column": model}
    for name in _STATISTICS:
        of_paper = value(published, name, surface=surface, column=model)
        row |= {
            name: values[name],
            f"{name}_se": errors[name],
            f"{name}_published": of_paper,
            f"{name}_afm": measured.get(name, np.nan),
            f"{name}_deviation_percent": percent(values[name], of_paper),
        }
    return row


def _beside_published(value, error, of_paper):
    """Value ± standard error (published value) as text."""
    return with_error(value, error) + (f" ({of_paper:g})" if np.isfinite(of_paper) else "")


_TABLE_1 = {"surface": (str, "surface"), "model": (str, "column")} | {
    title: (_beside_published, name, f"{name}_se", f"{name}_published") for name, title in _STATISTICS.items()
}


# Table II


def table_2(
    identifications: Mapping[str, xr.Dataset],
    spectra: Mapping[str, xr.Dataset],
    published: pd.DataFrame,
    sources: Mapping[str, str],
) -> Table:
    """Table II: published and identified parameters of Eq. (7), and deviations of their surfaces from the target.

    The rms of published parameters is that of the spectrum alone; radius and density are those of surfaces that were
    not used to identify it. Published plateaus are the corrected ones, in rows of the paper's own surfaces. The
    sources, ``published`` or ``identified``, are of the spectra in use, whose defect is shown.
    """
    defects = {surface: {source: 100 * float(spectra[surface].defect)} for surface, source in sources.items()}
    rows_of = (_rows_2(surface, fit, published, defects[surface]) for surface, fit in identifications.items())
    caption = (
        "Table II: parameters of Eq. (7), as published (with corrected plateaus) and as identified from the summits; "
        "deviations from the measured (AFM) rms, summit radius and density, on surfaces not used to identify; defect: "
        "share of the variance that no Gaussian field provides, of the spectrum in use."
    )
    return Table.from_rows(chain.from_iterable(rows_of), caption, _TABLE_2)


def _rows_2(surface, fit, published, defects):
    """Published parameters of a surface, if any, and the identified ones, with the defect of those in use."""
    match = rows(published, surface=surface)
    if len(match):
        of_paper = match[list(_PARAMETERS)].iloc[0].to_dict()
        as_printed = {"plateau_nm4_as_printed": float(match.plateau_nm4_as_printed.iloc[0])}
        yield (
            {"surface": surface, "psd": "published"}
            | _shape(of_paper, fit, defects.get("published", np.nan))
            | as_printed
        )
    spectrum = spectrum_of(fit)
    identified = {name: getattr(spectrum, name.split("_")[0]) / unit for name, unit in _PARAMETERS.items()}
    row = {"surface": surface, "psd": "identified"} | _shape(identified, fit, defects.get("identified", np.nan))
    yield row | _residuals(fit)


def _shape(parameters, fit, defect):
    """Parameters of Eq. (7) in the units of the table, the deviation of their rms from the measured one, the defect."""
    shape = CutoffSelfAffine(**{name.split("_")[0]: parameters[name] * unit for name, unit in _PARAMETERS.items()})
    residual = percent(np.sqrt(shape.variance), float(fit.target_rms))
    return parameters | {"rms_residual_percent": residual, "gaussian_defect_percent": defect}


def _residuals(fit):
    """Deviations of radius and density from the measured ones after identification, with standard errors [%]."""
    row = {}
    for column, (off, error) in misfits(fit).items():
        row |= {f"{column}_residual_percent": off, f"{column}_residual_se_percent": error}
    return row


_TABLE_2 = {
    "surface": (str, "surface"),
    "psd": (str, "psd"),
    "s⁰ [nm⁴]": (".4g", "plateau_nm4"),
    "s¹ [nm⁴]": (".3g", "floor_nm4"),
    "ζ₀ [rad/µm]": (".3g", "corner_rad_per_um"),
    "ζ_max [rad/µm]": (".3g", "cutoff_rad_per_um"),
    "rms off by [%]": ("+.2f", "rms_residual_percent"),
    "radius off by [%]": (signed, "radius_residual_percent", "radius_residual_se_percent"),
    "density off by [%]": (signed, "density_residual_percent", "density_residual_se_percent"),
    "defect [%]": (".2g", "gaussian_defect_percent"),
}


def _table_1(data, settings):
    """Simulated, published and measured statistics."""
    substitutions = {name: substitution(heights) for name, heights in data["heights"].items()}
    measured = settings["measured"] | {
        name: estimate.statistics(dataset) for name, dataset in data["estimates"].items()
    }
    return table_1(data["characters"], measured, published.published_rows(data, settings), substitutions)


def _measured_statistics(plan):
    """Measured statistics of all surfaces without scans."""
    keys = (*MOMENT_KEYS, *SUMMIT_KEYS)
    return {name: subsection(plan.config["surfaces"][name], keys) for name in plan.surfaces_by_numbers}


STAGES = (
    table_stage(
        "table_1",
        "statistics of the surfaces",
        inputs=lambda plan, at: {
            "estimates": by_name("estimate", plan.surfaces_with_scans),
            "heights": by_name("heights", plan.surfaces),
            "characters": by_model("character", plan.surfaces, SURFACE_MODELS[::-1]),
            "published": published.file("table_1"),
        },
        settings=lambda plan, at: {"measured": _measured_statistics(plan), "of_paper": plan.paper.surfaces},
        compute=_table_1,
        targets=("tables",),
    ),
    table_stage(
        "table_2",
        "spectra and their identification",
        inputs=lambda plan, at: {
            "identifications": by_name("identification", plan.with_summits),
            "spectra": by_name("spectrum", plan.with_summits),
            "published": published.file("table_2"),
        },
        settings=lambda plan, at: {
            "sources": {name: plan.config["surfaces"][name]["psd"] for name in plan.with_summits},
            "of_paper": plan.paper.surfaces,
        },
        compute=lambda data, settings: table_2(
            data["identifications"], data["spectra"], published.published_rows(data, settings), settings["sources"]
        ),
        jobs=lambda plan: [{}] if plan.with_summits else [],
        targets=("tables",),
    ),
)
