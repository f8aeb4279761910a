"""Error of the model of the contact in the lengths and forces of a device: the effect of full elastic contact."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from stiction.analysis.model_error import factors
from stiction.contact.air import has_dry, is_humid
from stiction.plan.stage import Stage, select
from stiction.stages.contact import full_contact
from stiction.stages.contact.corrections import study_of
from stiction.stages.devices.opening import EITHER, FORCE, MIDDLE, S_SHAPE, DesignedBeam, own_section


@dataclass(frozen=True)
class Settings:
    """Humidities of a device, and its dimensions if it is a beam."""

    humidities: tuple[float, ...]  #: [-]
    device: DesignedBeam | None = None  #: none for a stopper
    applied: tuple[float, ...] = ()  #: those at which the predictions are corrected [-]
    across_gaps: bool = False  #: whether solids attract each other across gaps, in both models
    condenses: bool = True  #: whether water condenses between the surfaces; otherwise all air is dry
    by_levels: bool = False  #: whether energies alone are corrected in humid air

    @property
    def airs(self) -> np.ndarray:
        """Humidities, 0 where no water condenses (h,) [-]."""
        return np.array(self.humidities) * self.condenses

    @property
    def is_by_levels(self) -> np.ndarray:
        """Humidities at which energies alone are corrected (h,) bool."""
        return self.by_levels & is_humid(self.airs)


def response(shape: str, means: np.ndarray, device: DesignedBeam | None) -> np.ndarray:
    """Length of adhesion of a beam [m], or pull-off pressure of a stopper [Pa], at each humidity (h,).

    The means are those of the energy e [J m⁻²] and of the largest attraction f_max [Pa], (h, 2).

    ASSUME: the strips of the pair give the ratios of a patch of any size, and a safe length changes like the length on
    the mean contact. What tips hold is not known: their strips are tilted, on which full contact is not computed.
    """
    if device is None:
        return means[:, 1]
    if shape == EITHER:
        return np.full(len(means), np.nan)
    samples = {S_SHAPE: means[:, :1], MIDDLE: means[:, None]}[shape]
    return np.array([device.opening.length_on_mean(sample, device.beam) for sample in samples])


def compute(settings: Settings, study: xr.Dataset | None = None, by_levels: xr.Dataset | None = None) -> xr.Dataset:
    """Factor of every length, or of the force, at the humidities of a device.

    ``study`` has strips in full contact, at all humidities or in dry air. ``by_levels`` has the energies of beams in
    humid air, from stage model_error_of_devices, if these are corrected by levels.
    """
    shapes = settings.device.opening.shapes if settings.device else (FORCE,)
    of_strips = None if study is None else _of_strips(study, shapes, settings)
    if by_levels is None:
        return layout(*of_strips, shapes, settings, study.humidity.values)
    known = by_levels.reindex(humidity=list(settings.airs), fill_value={"applied": False})
    found = _of_energies(known, shapes, settings)
    if study is not None:
        found = [np.where(is_humid(settings.airs), *each) for each in zip(found, of_strips, strict=True)]
    own = replace(settings, applied=tuple(np.array(settings.humidities)[known.applied.values]))
    return layout(*found, shapes, own, settings.airs)


def _of_strips(study, shapes, settings):
    """Factors by strips in full contact, and their errors (shapes, humidities) [-]."""
    computed, models = study.humidity.values, full_contact.moved_models(study)
    of_shapes = [
        factors(lambda means, of=shape: response(of, means, settings.device), *models, computed, settings.airs)
        for shape in shapes
    ]
    return np.moveaxis(of_shapes, 1, 0)


def _of_energies(known, shapes, settings):
    """Factors of the lengths of a beam with corrected energies, and their errors (shapes, humidities) [-]."""
    found, at = np.full((2, len(shapes), known.sizes["humidity"]), np.nan), np.isfinite(known.summit_energy.values)
    means = np.stack([known.summit_energy.values, known.summit_pull_off.values], axis=1)[at]

    def lengths(ratio):
        """Lengths with a ratio of the energies at each humidity (shapes, humidities) [m]."""
        changed = means * np.stack([ratio, np.ones(len(ratio))], axis=1)
        return np.array([response(shape, changed, settings.device) for shape in shapes])

    ratio, error = known.energy_ratio.values[at], known.energy_ratio_error.values[at]
    changed, base = lengths(ratio), lengths(np.ones(len(ratio)))
    found[:, :, at] = changed / base, np.abs(lengths(ratio + error) - changed) / base
    return found


def layout(
    values: np.ndarray, errors: np.ndarray, shapes: Sequence[str], settings: Settings, computed: np.ndarray
) -> xr.Dataset:
    """Dataset of the factors and their standard errors by end state, (shapes, humidities) each [-].

    Full contact was ``computed`` at these humidities [-].
    """
    names = ("shape", "humidity")
    return xr.Dataset(
        {
            "factor": (names, values, {"units": "1"}),
            "factor_error": (names, errors, {"units": "1"}),
            "interpolated": ("humidity", ~np.isin(settings.airs, computed)),
            "applied": ("humidity", np.isin(settings.humidities, settings.applied)),
            "energies_alone": ("humidity", settings.is_by_levels),
            "across_gaps": ((), settings.across_gaps),
        },
        coords={"shape": list(shapes), "humidity": ("humidity", list(settings.humidities), {"units": "1"})},
    )


def _inputs(plan, at):
    """Study of the pair of a device, with the attraction across gaps that the device has, and energies by levels."""
    section = plan.config["devices"][at.device]
    pair, water = section["pair"], plan.air_of_devices.water(section["pair"])
    study = {"study": study_of(plan, "studies/full_contact", pair, water)}
    if not plan.by_levels(at.device):
        return study
    return (study if has_dry(section["humidities"]) else {}) | {"by_levels": f"studies/model_error/devices/{pair}"}


def _settings(plan, at):
    """Humidities of a device, and its dimensions."""
    section = plan.config["devices"][at.device]
    applied = plan.variants.corrected(section["pair"], section["humidities"])
    gaps = {"across_gaps": True} if "gaps" in plan.air_of_devices.water(section["pair"]) else {}
    dry = {} if plan.air_of_devices.is_wetted(section["pair"]) else {"condenses": False}
    said = {"humidities": section["humidities"]} | ({"applied": applied} if applied else {})
    by_levels = {"by_levels": True} if plan.by_levels(at.device) else {}
    return select(Settings, said | own_section(plan, at.device) | gaps | dry | by_levels)


STAGES = (
    Stage.writing(
        "device_model_error",
        "devices/model_error/{device}",
        inputs=_inputs,
        settings=_settings,
        kind=Settings,
        compute=compute,
        message="Error of the model of the contact in the predictions of {device}.",
    ),
)
