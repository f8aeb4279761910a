"""Error of the model of the contact in the lengths and forces of a device: the effect of full elastic contact."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.analysis.model_error import factors
from stiction.plan.stage import Stage, select
from stiction.stages.contact import full_contact
from stiction.stages.contact.corrections import study_of
from stiction.stages.devices.opening import EITHER, FORCE, MIDDLE, S_SHAPE, DesignedBeam, section_of_beam


@dataclass(frozen=True)
class Settings:
    """Humidities of a device, and its dimensions if it is a beam."""

    humidities: tuple[float, ...]  #: [-]
    device: DesignedBeam | None = None  #: none for a stopper
    applied: tuple[float, ...] = ()  #: those at which the predictions are corrected [-]
    across_gaps: bool = False  #: whether solids attract each other across gaps, in both models
    condenses: bool = True  #: whether water condenses between the surfaces; otherwise all air is dry

    @property
    def airs(self) -> np.ndarray:
        """Humidities, 0 where no water condenses (h,) [-]."""
        return np.array(self.humidities) * self.condenses


def response(shape: str, means: np.ndarray, device: DesignedBeam | None) -> np.ndarray:
    """Length of adhesion of a beam [m], or pull-off pressure of a stopper [Pa], at each humidity (h,).

    The means are those of the energy e [J m⁻²] and of the largest attraction f_max [Pa], (h, 2).

    ASSUME: the strips of the pair give the ratios of a patch of any size, and a safe length changes like the length on
    the mean contact. What tips hold is not known: their strips are tilted, on which full contact is not computed.
    """
    if shape == FORCE:
        return means[:, 1]
    if shape == EITHER:
        return np.full(len(means), np.nan)
    samples = {S_SHAPE: means[:, :1], MIDDLE: means[:, None]}[shape]
    return np.array([device.opening.length_on_mean(sample, device.beam) for sample in samples])


def compute(study: xr.Dataset, settings: Settings) -> xr.Dataset:
    """Factor of every length, or of the force, at the humidities of a device."""
    computed, models = study.humidity.values, full_contact.moved_models(study)
    device, at = settings.device, settings.airs
    shapes = device.opening.shapes if device else (FORCE,)
    of_shapes = [
        factors(lambda means, of=shape: response(of, means, device), *models, computed, at) for shape in shapes
    ]
    values, errors = np.moveaxis(of_shapes, 1, 0)
    return layout(values, errors, shapes, settings, computed)


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
            "across_gaps": ((), settings.across_gaps),
        },
        coords={"shape": list(shapes), "humidity": ("humidity", list(settings.humidities), {"units": "1"})},
    )


def _inputs(plan, at):
    """Study of the pair of a device, with the attraction across gaps that the device has."""
    pair = plan.config["devices"][at.device]["pair"]
    return {"study": study_of(plan, "studies/full_contact", pair, plan.air_of_devices.water(pair))}


def _settings(plan, at):
    """Humidities of a device, and its dimensions."""
    section = plan.config["devices"][at.device]
    own = {"device": section_of_beam(plan, at.device)} if plan.devices.kind(at.device).is_beam else {}
    applied = plan.variants.corrected(section["pair"], section["humidities"])
    gaps = {"across_gaps": True} if "gaps" in plan.air_of_devices.water(section["pair"]) else {}
    dry = {} if plan.air_of_devices.is_wetted(section["pair"]) else {"condenses": False}
    said = {"humidities": section["humidities"]} | ({"applied": applied} if applied else {})
    return select(Settings, said | own | gaps | dry)


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
