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
from stiction.stages.devices.contact_names import changes_of_probe
from stiction.stages.devices.opening import EITHER, FORCE, MIDDLE, S_SHAPE, DesignedBeam, own_section


@dataclass(frozen=True)
class Settings:
    """Humidities of a device, and its dimensions if it is a beam."""

    humidities: tuple[float, ...]  #: [-]
    device: DesignedBeam | None = None  #: none for a stopper
    applied: tuple[float, ...] = ()  #: those at which the predictions are corrected [-]
    across_gaps: bool = False  #: whether solids attract each other across gaps, in both models
    condenses: bool = True  #: whether water condenses between the surfaces; otherwise all air is dry
    by_levels: bool = False  #: whether changes in humid air are those for devices, by levels

    @property
    def airs(self) -> np.ndarray:
        """Humidities, 0 where no water condenses (h,) [-]."""
        return np.array(self.humidities) * self.condenses

    @property
    def is_by_levels(self) -> np.ndarray:
        """Humidities at which changes are by levels (h,) bool."""
        return self.by_levels & is_humid(self.airs)

    @property
    def shapes(self) -> tuple[str, ...]:
        """End states, the force of a stopper in place of these."""
        return self.device.opening.shapes if self.device else (FORCE,)


def response(shape: str, means: np.ndarray, device: DesignedBeam | None) -> np.ndarray:
    """Length of adhesion of a beam [m], or pull-off pressure of a stopper [Pa], at each humidity (h,).

    The means are those of the energy e [J m⁻²] and of the largest attraction f_max [Pa], (h, 2).

    ASSUME: the strips of the pair give the ratios of a patch of any size, and a safe length changes like the length on
    the mean contact. Tips have no factor of their own: each slope has another one.
    """
    if device is None:
        return means[:, 1]
    if shape == EITHER:
        return np.full(len(means), np.nan)
    samples = {S_SHAPE: means[:, :1], MIDDLE: means[:, None]}[shape]
    return np.array([device.opening.length_on_mean(sample, device.beam) for sample in samples])


def compute(settings: Settings, study: xr.Dataset | None = None, by_levels: xr.Dataset | None = None) -> xr.Dataset:
    """Factor of every length, or of the force, at the humidities of a device.

    ``study`` has strips in full contact, at all humidities or in dry air. ``by_levels`` has the changes in humid air,
    from stage model_error_of_devices, if these are by levels.
    """
    of_strips = None if study is None else _of_strips(study, settings)
    if by_levels is None:
        return layout(*of_strips, settings.shapes, settings, study.humidity.values)
    missing = dict.fromkeys(_FLAGS, False)
    changes = by_levels.reindex(humidity=list(settings.airs), fill_value=missing)
    numbers = _of_ratios(changes, settings)
    if study is not None:
        numbers = [np.where(is_humid(settings.airs), *each) for each in zip(numbers, of_strips, strict=True)]
    applied = np.all([changes[flag].values for flag in _FLAGS_OF[settings.shapes[0]]], axis=0)
    corrected = replace(settings, applied=tuple(np.array(settings.humidities)[applied]))
    return layout(*numbers, settings.shapes, corrected, settings.airs).assign(_of_tips(changes))


#: Whether changes of energies, of forces and of tips are applied, and those of these on which a response rests.
_FLAGS = ("applied", "pull_off_applied", "tip_applied")
_FLAGS_OF = {S_SHAPE: _FLAGS[:1], MIDDLE: _FLAGS[:2], FORCE: _FLAGS[1:2]}


def _of_tips(changes):
    """Least and largest ratio of tips over the slopes, and whether it is applied, if the pair has tips."""
    if "tip_ratio" not in changes:
        return {}
    ends = changes.tip_ratio.where(changes.tip_applied)
    return {
        "least_of_tips": ends.min("slope"),
        "largest_of_tips": ends.max("slope"),
        "tips_applied": changes.tip_applied,
    }


def _of_strips(study, settings):
    """Factors by strips in full contact, and their errors (shapes, humidities) [-]."""
    computed_at, models = study.humidity.values, full_contact.moved_models(study)
    of_shapes = [
        factors(
            lambda means, end_state=shape: response(end_state, means, settings.device),
            *models,
            computed_at,
            settings.airs,
        )
        for shape in settings.shapes
    ]
    return np.moveaxis(of_shapes, 1, 0)


def _of_ratios(by_humidity, settings):
    """Factors of lengths or of the force by changes by levels, and their errors (shapes, humidities) [-]."""
    results = np.full((2, len(settings.shapes), by_humidity.sizes["humidity"]), np.nan)
    at = np.isfinite(by_humidity.energy_ratio)
    means, ratios, errors = (
        np.stack([by_humidity[f"{prefix}{quantity}{suffix}"].values[at] for quantity in ("energy", "pull_off")], axis=1)
        for prefix, suffix in (("summit_", ""), ("", "_ratio"), ("", "_ratio_error"))
    )

    def responses(changes):
        """Responses with some changes of both means (shapes, humidities)."""
        return np.array([response(shape, means * changes, settings.device) for shape in settings.shapes])

    base, changed = responses(np.ones_like(ratios)), responses(ratios)
    variations = [responses(ratios + errors * direction) - changed for direction in np.eye(2)]
    results[:, :, at] = changed / base, np.hypot(*variations) / base
    return results


def layout(
    values: np.ndarray, errors: np.ndarray, shapes: Sequence[str], settings: Settings, computed_at: np.ndarray
) -> xr.Dataset:
    """Dataset of the factors and their standard errors by end state, (shapes, humidities) each [-].

    ``computed_at`` are the humidities of full contact [-].
    """
    names = ("shape", "humidity")
    return xr.Dataset(
        {
            "factor": (names, values),
            "factor_error": (names, errors),
            "interpolated": ("humidity", ~np.isin(settings.airs, computed_at)),
            "applied": ("humidity", np.isin(settings.humidities, settings.applied)),
            "by_levels": ("humidity", settings.is_by_levels),
            "across_gaps": ((), settings.across_gaps),
        },
        coords={"shape": list(shapes), "humidity": ("humidity", list(settings.humidities))},
    )


def _inputs(plan, at):
    """Study of the pair of a device, with the attraction across gaps that the device has, and its changes by levels."""
    section = plan.config["devices"][at.device]
    pair, water = section["pair"], plan.air_of_devices.water(section["pair"])
    if plan.devices.kind(at.device).shape:
        return {"study": f"studies/full_contact/probes/{at.device}"}
    study = {"study": study_of(plan, "studies/full_contact", pair, water)}
    if not plan.air_of_devices.by_levels(pair, section["humidities"]):
        return study
    return (study if has_dry(section["humidities"]) else {}) | {"by_levels": f"studies/model_error/devices/{pair}"}


def _settings(plan, at):
    """Humidities of a device, and its dimensions."""
    section = plan.config["devices"][at.device]
    is_changed = bool(changes_of_probe(plan, at.device))
    applied = section["humidities"] if is_changed else plan.variants.corrected(section["pair"], section["humidities"])
    gaps = {"across_gaps": True} if "gaps" in plan.air_of_devices.water(section["pair"]) else {}
    dry = {} if plan.air_of_devices.is_wetted(section["pair"]) else {"condenses": False}
    airs = {"humidities": section["humidities"]} | ({"applied": applied} if applied else {})
    by_levels = {"by_levels": True} if plan.air_of_devices.by_levels(section["pair"], section["humidities"]) else {}
    return select(Settings, airs | own_section(plan, at.device) | gaps | dry | by_levels)


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
