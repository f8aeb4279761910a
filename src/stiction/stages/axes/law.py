"""Stage process_law: law from the variable of a process to the description of its surface, through its settings."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from stiction.analysis.process_law import (
    QUANTITIES,
    Law,
    Parts,
    contradictions,
    fit,
    is_unique,
    jacobian,
    scaled,
    scaled_covariance,
    unscaled,
)
from stiction.analysis.shifts import STEPS, Description
from stiction.config.reading import paper
from stiction.config.scans import is_measured
from stiction.config.surfaces import process
from stiction.config.surfaces.knowledge import knowledge, slope
from stiction.config.units import from_si, to_si
from stiction.plan.stage import Stage
from stiction.stages.surfaces import estimate as stage_estimate
from stiction.surface.feasible import largest_kurtosis, least_kurtosis
from stiction.surface.spectrum import CutoffSelfAffine

#: Significant digits of the numbers of a surface on a law: the same on every machine, and those of a stated setting.
_DIGITS = 9
#: Quantities of a surface by the keys of a setting, in the order of `QUANTITIES`.
_KEYS = dict(zip(process.NUMBERS, QUANTITIES, strict=True))
#: Spectrum of a surface that does not state one; its law has none either.
_ANY = 0.0, -4.0


@dataclass(frozen=True)
class Settings:
    """Settings of a law, without the estimates of its scans."""

    variable: str  #: name with its unit
    surface: str
    values: tuple[float, ...]  #: of the variable, increasing [its unit]
    quantities: tuple[str, ...]  #: that follow the variable, of those in `stiction.analysis.process_law`
    #: At each setting, ln rms, skewness, kurtosis, ln corner and slope in SI units, and the covariance of their errors.
    #: None with scans.
    stated: tuple[dict, ...] = ()


def compute(estimates: Sequence[xr.Dataset], settings: Settings) -> xr.Dataset:
    """Law through the settings, with sentences on contradictions. There are no estimates of numbers."""
    surfaces = [_measured_quantities(surface) for surface in estimates] or [
        (np.array(surface["values"]), np.array(surface["covariance"])) for surface in settings.stated
    ]
    kept = [QUANTITIES.index(name) for name in settings.quantities]
    values, covariances = map(np.array, zip(*surfaces, strict=True))
    errors = scaled_covariance(values, covariances)[:, kept][:, :, kept]
    measured = scaled(values)[:, kept]
    law = fit(np.array(settings.values), measured, errors)
    return layout(law, measured, errors, settings)


def _measured_quantities(estimate):
    """Quantities of an estimated surface, and the covariance of their errors.

    ASSUME: the moments of the heights and the spectrum of scans err independently.
    """
    spectrum = stage_estimate.fit(estimate)
    values = [*map(float, estimate.moments), np.log(spectrum.corner), spectrum.slope]
    covariance = np.zeros((5, 5))
    covariance[:3, :3], covariance[3:, 3:] = estimate.covariance.values, spectrum.covariance[1:, 1:]
    return np.array(values), covariance


def layout(law: Law, measured: np.ndarray, errors: np.ndarray, settings: Settings) -> xr.Dataset:
    """Dataset of a law, with the scaled quantities of its settings (n, q) and the covariance of their errors."""
    over, other = ("quantity", "coefficient"), ("other_quantity", "other_coefficient")
    trial = "degree", "tried_scatter"
    return xr.Dataset(
        {
            "measured": (("setting", "quantity"), measured),
            "errors": (("setting", "quantity", "other_quantity"), errors),
            "coefficients": (over, law.coefficients),
            "covariance": ((*over, *other), law.covariance),
            "degrees": ("quantity", law.degrees),
            "scatter": ("quantity", law.scatter),
            "surprise": (("setting", "quantity"), law.surprise),
            "likely": (("quantity", *trial), law.parts.likely),
            "part_coefficients": (("quantity", *trial, "coefficient"), law.parts.coefficients),
            "part_weights": (("quantity", *trial, "coefficient", "setting"), law.parts.weights),
            "flags": ((), "\n".join(sentences(law, settings))),
        },
        coords={
            "tried_scatter": law.parts.scatters,
            "setting": ("setting", law.settings, {"units": process.unit_of(settings.variable)}),
            "quantity": list(settings.quantities),
            "other_quantity": list(settings.quantities),
        },
        attrs={"variable": settings.variable, "surface": settings.surface},
    )


def sentences(law: Law, settings: Settings) -> list[str]:
    """Sentences on settings in contradiction to the law of the others, and on an unchecked law."""
    unit, listed = process.unit_of(settings.variable), []
    if len(law.settings) == 2:
        listed.append("Two settings give straight lines, which nothing checks: measure a third one.")
    for setting, quantity in contradictions(law):
        words, far = settings.quantities[quantity], abs(law.surprise[setting, quantity])
        at = f"{law.settings[setting]:g} {unit}"
        if is_unique(law, quantity):
            listed.append(
                f"At {at} the {words} of {settings.surface} is {far:.2g} standard errors from the law of the other "
                "settings: check this setting and its scans."
            )
        else:
            listed.append(
                f"The {words} of {settings.surface} bends more than so few settings can show, by {far:.2g} standard "
                "errors; its band allows for that. One more setting would tell a bend from a wrong setting."
            )
    return listed


def law_of(dataset: xr.Dataset) -> Law:
    """Law in a dataset of this stage."""
    names = "coefficients", "covariance", "degrees", "scatter", "surprise"
    parts = Parts(
        *(dataset[name].values for name in ("likely", "part_coefficients", "part_weights", "errors", "tried_scatter"))
    )
    return Law(dataset.setting.values, *(dataset[name].values for name in names), parts)


def at_value(dataset: xr.Dataset, value: float) -> xr.Dataset:
    """Quantities of the surface at a value of the variable and their standard errors, in SI units.

    They are ln rms, skewness, kurtosis, ln corner and slope. Raises ValueError beyond the settings.
    """
    law, names = law_of(dataset), list(map(str, dataset["quantity"].values))
    (values,), (errors,) = plain(law.at(value), law.covariance_at(value), names)
    return xr.Dataset({"estimate": ("quantity", values), "error": ("quantity", errors)}, {"quantity": names})


def plain(values: np.ndarray, covariances: np.ndarray, names: Sequence[str]) -> tuple[np.ndarray, np.ndarray]:
    """Quantities back from the scale of the law (n, q), and their standard errors (n, q).

    The scaled ones of these names are (n, q), their covariance is (n, q, q).
    """
    places = [QUANTITIES.index(name) for name in names]
    full = np.zeros((len(values), len(QUANTITIES)))
    full[:, places] = values
    quantities = unscaled(full)
    slopes = jacobian(quantities)[:, places][:, :, places]
    variances = np.einsum("nqr,nrs,nqs->nq", slopes, covariances, slopes)
    return quantities[:, places], np.sqrt(variances)


def on_law(base: Description, dataset: xr.Dataset, value: float) -> Description:
    """Surface at a value of the variable: as given, with the quantities of the law.

    ASSUME: the cut-off of the spectrum is the given one at all values, with which surfaces have the same random
    numbers, and the heights are of maximum entropy. In place of a kurtosis or corner that no surface has, it has the
    nearest one.
    """
    cutoff = base.spectrum.cutoff
    quantities = np.array(
        [np.log(base.rms), base.skewness, base.kurtosis, np.log(base.spectrum.corner), slope_of(base)]
    )
    changed, names = scaled(quantities), list(map(str, dataset["quantity"].values))
    changed[[QUANTITIES.index(name) for name in names]] = law_of(dataset).at(value)[0]
    ln_rms, skewness, kurtosis, ln_corner, slope = unscaled(changed)
    surface = replace(base, form=None)
    if "rms" in names:
        surface = replace(surface, rms=to_si(_rounded(from_si(np.exp(ln_rms), "nm")), "nm"))
    if "skewness" in names:
        kurtosis = max(min(kurtosis, largest_kurtosis(abs(_rounded(skewness)))), least_kurtosis(skewness))
        surface = replace(surface, skewness=_rounded(skewness), kurtosis=_rounded(kurtosis))
    if "corner" in names or "slope" in names:
        corner = min(to_si(_rounded(from_si(np.exp(ln_corner), "rad_per_um")), "rad_per_um"), 0.95 * cutoff)
        plateau = getattr(base.spectrum, "plateau", 1.0)
        floor = plateau * (cutoff / corner) ** _rounded(slope)
        surface = replace(surface, spectrum=CutoffSelfAffine(plateau, floor, corner, cutoff))
    return surface


def slope_of(surface: Description) -> float:
    """Slope of the spectrum of a surface. Tables have none."""
    return getattr(surface.spectrum, "slope", _ANY[1])


def _rounded(value):
    return float(f"{value:.{_DIGITS}g}")


# Stage


def _settings(plan, at):
    """Variable, surface and settings of a process, in the order of the variable."""
    section, entries = plan.config["process"][at.process], plan.config["surfaces"]
    names = in_order(plan, at.process)
    common = {key: section[key] for key in ("variable", "surface")}
    common["values"] = sorted(setting["value"] for setting in section["settings"])
    if is_measured(entries[names[0]]):
        return common | {"quantities": list(QUANTITIES)}
    stated = section["settings"][0]["uncertainty"]
    quantities = [quantity for key, quantity in _KEYS.items() if key in stated]
    return common | {"quantities": quantities, "stated": [_numbers(entries[name], quantities) for name in names]}


def _numbers(entry, quantities):
    """Settings of a surface by numbers, with the errors of some quantities."""
    psd = entry.get("published_psd")
    spectrum = (np.log(to_si(psd["corner_rad_per_um"], "rad_per_um")), slope(psd)) if psd else _ANY
    values = [np.log(to_si(entry["rms_nm"], "nm")), entry["skewness"], entry["kurtosis"], *spectrum]
    errors, covariance = knowledge(entry, paper()["surfaces"]), np.diag(np.square(list(STEPS.values())[:5]))
    places = [QUANTITIES.index(name) for name in quantities]
    places_in_errors = [errors.quantities.index(name) for name in quantities]
    covariance[np.ix_(places, places)] = errors.covariance[np.ix_(places_in_errors, places_in_errors)]
    rounded = [[_rounded(number) for number in row] for row in covariance]
    return {"values": [float(f"{number:.14g}") for number in values], "covariance": rounded}


def in_order(plan: Any, name: str) -> list[str]:
    """Surfaces at the settings of a process, in the order of the variable."""
    values = [setting["value"] for setting in plan.config["process"][name]["settings"]]
    return [surface for _, surface in sorted(zip(values, process.names(plan.config, name), strict=True))]


def _inputs(plan, at):
    """Estimates of the surfaces at the settings, if they are described by scans."""
    names = in_order(plan, at.process)
    measured = [name for name in names if is_measured(plan.config["surfaces"][name])]
    return {"estimates": [f"estimate/{name}" for name in measured]}


def law_inputs(plan: Any, device: str) -> Mapping[str, list[str]]:
    """Names of the laws of the processes of a device."""
    return {"laws": [f"process/laws/{name}" for name in process.processes_of(plan.config, device)]}


STAGES = (
    Stage.writing(
        "process_law",
        "process/laws/{process}",
        inputs=_inputs,
        settings=_settings,
        kind=Settings,
        compute=compute,
        message="Law of process {process}.",
    ),
)
