"""Stages device_estimate and stopper_estimate: the estimate at once of a device beside the sizes of its run.

Both are lengths or forces at one touchdown, without voltage, for exact inputs and the surfaces as stated. The datasets
have all inputs of the estimate, so that runs test it, and can teach it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any

import numpy as np
import xarray as xr

from stiction.config.units import from_si
from stiction.constants import REFERENCE_TEMPERATURE
from stiction.estimate.answer import CONFIDENCES, in_one_air
from stiction.estimate.bridge import Bridge
from stiction.estimate.complete import question_of
from stiction.estimate.force import Stopper
from stiction.estimate.length import NotLearnt
from stiction.estimate.question import Question
from stiction.estimate.solids import SolidPair
from stiction.estimate.statistics import Heights, moments_of
from stiction.estimate.table import FILE, known
from stiction.models import SIDES
from stiction.plan.stage import File, Stage, select
from stiction.stages.devices.results import results_of
from stiction.surface.spectrum import CutoffSelfAffine

#: Confidence of the intervals.
CONFIDENCE = CONFIDENCES[0]


@dataclass(frozen=True)
class AskedSurface:
    """One surface."""

    rms: float  #: [m]
    skewness: float  #: [-]
    kurtosis: float  #: [-]
    published_psd: CutoffSelfAffine

    @property
    def heights(self) -> Heights:
        """Statistics of its heights."""
        psd = self.published_psd
        return Heights(self.rms, self.skewness, self.kurtosis, moments_of(psd.corner, psd.cutoff, float(psd.slope)))

    @property
    def numbers(self) -> dict[str, float]:
        """All of its numbers by name, in SI."""
        numbers = asdict(self)
        return numbers.pop("published_psd") | numbers


@dataclass(frozen=True, kw_only=True)
class AskedSolids:
    """SolidPair and water of a device, those that differ from polysilicon at 300 K."""

    hamaker_constant: float = SolidPair.in_dry_air  #: of the solids in dry air [J]
    hamaker_constant_in_water: float = SolidPair.through_water  #: of the solids [J]
    modulus: float = SolidPair.modulus  #: as of `stiction.estimate.solids.SolidPair` [Pa]
    beam_modulus: float = SolidPair.beam_modulus  #: [Pa]
    wetting: float = SolidPair.wetting  #: sum of the cosines of both contact angles [-]
    temperature: float = REFERENCE_TEMPERATURE  #: [K]

    @property
    def solids(self) -> dict[str, Any]:
        """SolidPair and temperature of a question by name."""
        attraction = {"through_water": self.hamaker_constant_in_water, "in_dry_air": self.hamaker_constant}
        solids = SolidPair(self.modulus, self.beam_modulus, **attraction, wetting=self.wetting)
        return {"solids": solids, "temperature": self.temperature}

    @property
    def of_solids(self) -> dict[str, Any]:
        """Variables of the numbers that differ from those of polysilicon at 300 K."""
        numbers = ((each.name, getattr(self, each.name), each.default) for each in fields(AskedSolids))
        return {name: ((), value) for name, value, default in numbers if value != default}


@dataclass(frozen=True)
class AskedBeam(AskedSolids):
    """Cantilever or bridge on two surfaces, as the estimate knows it."""

    beam: AskedSurface
    substrate: AskedSurface
    thickness: float  #: [m]
    gap: float  #: [m]
    width: float  #: [m]
    residual_stress: float | None = None  #: of a bridge [Pa]

    @property
    def sides(self) -> list[AskedSurface]:
        """Both surfaces, in the order of `stiction.models.SIDES`."""
        return [getattr(self, side) for side in SIDES]

    @property
    def sizes(self) -> dict[str, Any]:
        """Variables of its own numbers."""
        stated = {name: getattr(self, name) for name in ("thickness", "gap", "width", "residual_stress")}
        return {name: ((), value) for name, value in stated.items() if value is not None} | self.of_solids

    def question(self, air: float) -> Question | Bridge:
        """Question about one air [-]."""
        surfaces = tuple(side.heights for side in self.sides)
        stated = "", surfaces, ({}, {}), (air,), self.thickness, self.gap, self.width
        if self.residual_stress is None:
            return Question(*stated, **self.solids)
        return Bridge(*stated, self.residual_stress, **self.solids)


@dataclass(frozen=True)
class Settings:
    """Numbers of a beam, or why the estimate refuses its configuration."""

    asked: AskedBeam | None = None
    refused: str = ""


@dataclass(frozen=True)
class AskedStopper(AskedSolids):
    """Stopper on two surfaces, as the estimate knows it."""

    beam: AskedSurface
    substrate: AskedSurface
    contact: tuple[float, float]  #: sides of its area [m]

    @property
    def sides(self) -> list[AskedSurface]:
        """Both surfaces, in the order of `stiction.models.SIDES`."""
        return [getattr(self, side) for side in SIDES]

    @property
    def sizes(self) -> dict[str, Any]:
        """Variables of its own numbers."""
        return {"contact": ("direction", list(self.contact)), "direction": ["x", "y"]} | self.of_solids

    def question(self, air: float) -> Stopper:
        """Question about one air [-]."""
        surfaces = tuple(side.heights for side in self.sides)
        return Stopper("", surfaces, ({}, {}), (air,), self.contact, **self.solids)


@dataclass(frozen=True)
class SettingsOfStopper:
    """Numbers of a stopper, or why the estimate refuses its configuration."""

    asked: AskedStopper | None = None
    refused: str = ""


#: Sizes of a run and their standard errors for fractions of stuck devices, by air.
Runs = Mapping[float, tuple[xr.DataArray, xr.DataArray]]


def compute(lengths: Mapping[float, xr.Dataset], settings: Settings) -> xr.Dataset:
    """Lengths of a run and of the estimate, by humidity and fraction of stuck devices."""
    runs = {}
    for air, of_air in lengths.items():
        by_any = of_air.isel(shape=-1)  # whatever holds it
        error = np.hypot(by_any.beams_error, by_any.surfaces_error.fillna(0))
        runs[air] = by_any.estimate.where(np.isfinite(by_any.estimate)), error
    return _beside(runs, settings, "length")


def compute_stopper(stopper: xr.Dataset, settings: SettingsOfStopper) -> xr.Dataset:
    """Forces of a run and of the estimate, by humidity and fraction of stuck devices."""
    forces = stopper.safe_force
    runs = {air: tuple(forces.sel(humidity=air, part=["estimate", "error"])) for air in forces.humidity.values}
    return _beside(runs, settings, "force")


def _beside(runs: Runs, settings: Settings | SettingsOfStopper, name: str) -> xr.Dataset:
    """Sizes of a run, with their name, and of the estimate."""
    shares = next(iter(runs.values()))[0].share.values
    refused, estimates = zip(*(_estimated(settings, air, shares) for air in runs), strict=True)
    over = ("humidity", "share")
    sizes, errors = zip(*runs.values(), strict=True)
    columns = {name: sizes, f"{name}_error": errors}
    columns |= dict(zip(("estimate", "low", "high"), np.moveaxis(np.array(estimates), 2, 0), strict=True))
    dataset = xr.Dataset(
        {name: (over, np.array(values)) for name, values in columns.items()} | {"refused": ("humidity", list(refused))},
        {"humidity": ("humidity", list(runs)), "share": ("share", shares)},
    )
    return dataset.assign(_inputs_of(settings.asked) if settings.asked else {})


def _estimated(settings, air, shares) -> tuple[str, Sequence]:
    """Why the estimate refuses an air, if it does, and its sizes with the ends of their intervals (shares, 3) [SI]."""
    try:
        if settings.asked is None:
            raise NotLearnt(settings.refused)
        rows = in_one_air(settings.asked.question(air), air, shares, *known())
    except NotLearnt as reason:
        return str(reason), np.full((len(shares), 3), np.nan)
    return "", [(row.size, *row.intervals[CONFIDENCE]) for row in rows]


def _inputs_of(asked):
    """Variables of all inputs but the humidity."""
    numbers = [side.numbers for side in asked.sides]
    return (
        asked.sizes | {name: ("side", [side[name] for side in numbers]) for name in numbers[0]} | {"side": list(SIDES)}
    )


def estimated(plan: Any, stage: str) -> list[str]:
    """Devices whose estimate is of one of the stages."""
    return [name for name in plan.devices.sections if stage_of(plan, name) == stage]


def stage_of(plan: Any, device: str) -> str | None:
    """Stage of the estimate of a device, none of a kind that the estimate does not know."""
    kind = plan.devices.kind(device)
    if kind.has_tip or kind.has_short_strips:
        return LENGTHS
    return FORCES if kind.is_patch else None


def file_of(plan: Any, device: str) -> str | None:
    """Dataset of the estimate of a device, as `stage_of`."""
    stage = stage_of(plan, device)
    return stage and f"{_FOLDERS[stage]}/{device}"


#: Names of the stages, and their folders.
LENGTHS, FORCES = "device_estimate", "stopper_estimate"
_FOLDERS = {LENGTHS: "devices/estimate", FORCES: "devices/estimate_of_force"}


def _settings(kind_of_numbers):
    """Settings of a stage by the class of its numbers: these of a device, or why the estimate refuses it."""

    def settings(plan, at):
        """Settings of a device."""
        section = plan.config["devices"][at.device]
        question = question_of(plan.config, at.device, section)
        if isinstance(question, NotLearnt):
            return {"refused": str(question)}
        pair, surfaces = plan.config["pairs"][section["pair"]], plan.config["surfaces"]
        sides = {side: surfaces[pair[side]] for side in SIDES}
        of_solids = _of_solids(question, any("material" in side for side in sides.values()))
        return {"asked": select(kind_of_numbers, section | sides | of_solids)}

    return settings


def _of_solids(question, has_material):
    """Keys of solids and water that differ from polysilicon at 300 K. All materials have the constant in dry air."""
    solids, polysilicon = question.solids, AskedSolids()
    moduli = {"modulus": (solids.modulus, "GPa"), "beam_modulus": (solids.beam_modulus, "GPa")}
    of_water = {
        "hamaker_constant_in_water": (solids.through_water, "zJ"),
        "wetting": (solids.wetting, ""),
        "temperature": (question.temperature, "K"),
    }
    numbers = moduli if all(map(question.is_dry, question.humidities)) else moduli | of_water
    differing = {name: number for name, number in numbers.items() if number[0] != getattr(polysilicon, name)}
    differing |= {"hamaker_constant": (solids.in_dry_air, "zJ")} if has_material else {}
    return dict(_in_files(name, *number) for name, number in differing.items())


def _in_files(name, value, unit):
    """Key of a number in files, and its value there."""
    return (f"{name}_{unit}", round(from_si(value, unit), 9)) if unit else (name, round(value, 12))


def _stage(name, kind_of_numbers, kind, result, compute):
    """Stage of the estimates of some devices beside a result of their runs."""
    return Stage.writing(
        name,
        f"{_FOLDERS[name]}/{{device}}",
        inputs=lambda plan, at: results_of(plan, at.device, result) | {"table": File(FILE)},
        settings=_settings(kind_of_numbers),
        kind=kind,
        compute=compute,
        message="Estimate at once of {device} beside its run.",
    )


STAGES = (
    _stage(LENGTHS, AskedBeam, Settings, "lengths", compute),
    _stage(FORCES, AskedStopper, SettingsOfStopper, "stopper", compute_stopper),
)
