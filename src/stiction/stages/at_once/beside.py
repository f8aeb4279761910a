"""Stage device_estimate: the estimate at once of a cantilever beside the lengths of its run.

Both are lengths at one touchdown, without voltage, for exact inputs and the surfaces as stated. The datasets have all
inputs of the estimate, so that runs test it, and can teach it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import xarray as xr

from stiction.contact.air import humid
from stiction.estimate.answer import CONFIDENCES, in_one_air
from stiction.estimate.complete import question_of
from stiction.estimate.length import NotLearnt
from stiction.estimate.question import Question
from stiction.estimate.statistics import Heights, moments_of
from stiction.estimate.table import FILE, known
from stiction.models import SIDES
from stiction.plan.stage import File, Stage, select
from stiction.stages.devices.opening import EITHER
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
        own = asdict(self)
        return own.pop("published_psd") | own


@dataclass(frozen=True)
class AskedCantilever:
    """Cantilever on two surfaces, as the estimate knows it."""

    beam: AskedSurface
    substrate: AskedSurface
    thickness: float  #: [m]
    gap: float  #: [m]
    width: float  #: [m]

    @property
    def sides(self) -> list[AskedSurface]:
        """Both surfaces, in the order of `stiction.models.SIDES`."""
        return [getattr(self, side) for side in SIDES]

    def question(self, air: float) -> Question:
        """Question about one air [-]."""
        surfaces, exact = tuple(side.heights for side in self.sides), ({}, {})
        return Question("", surfaces, exact, (air,), self.thickness, self.gap, self.width)


@dataclass(frozen=True)
class Settings:
    """Numbers of a cantilever, or why the estimate refuses its configuration."""

    asked: AskedCantilever | None = None
    refused: str = ""


def compute(lengths: Mapping[float, xr.Dataset], settings: Settings) -> xr.Dataset:
    """Lengths of a run and of the estimate, by humidity and fraction of stuck devices."""
    runs = [one.sel(shape=EITHER) for one in lengths.values()]
    refused, estimates = zip(
        *(_estimated(settings, air, one.share.values) for air, one in lengths.items()), strict=True
    )
    over, metres, none = ("humidity", "share"), {"units": "m"}, {"units": "1"}
    errors = [np.hypot(one.beams_error, one.surfaces_error.fillna(0)) for one in runs]
    found = {"length": [one.estimate.where(np.isfinite(one.estimate)) for one in runs], "length_error": errors}
    found |= dict(zip(("estimate", "low", "high"), np.moveaxis(np.array(estimates), 2, 0), strict=True))
    dataset = xr.Dataset(
        {name: (over, np.array(values), metres) for name, values in found.items()}
        | {"refused": ("humidity", list(refused))},
        {"humidity": ("humidity", list(lengths), none), "share": ("share", runs[0].share.values, none)},
    )
    return dataset.assign(_inputs_of(settings.asked) if settings.asked else {})


def _estimated(settings, air, shares) -> tuple[str, Sequence]:
    """Why the estimate refuses an air, if it does, and its lengths with the ends of their intervals (shares, 3) [m]."""
    try:
        if settings.asked is None:
            raise NotLearnt(settings.refused)
        rows = in_one_air(settings.asked.question(air), air, shares, *known())
    except NotLearnt as reason:
        return str(reason), np.full((len(shares), 3), np.nan)
    return "", [(row.length, *row.intervals[CONFIDENCE]) for row in rows]


def _inputs_of(asked):
    """Variables of all inputs but the humidity."""
    own, numbers = asdict(asked), [side.numbers for side in asked.sides]
    sizes = {name: ((), own[name]) for name in ("thickness", "gap", "width")}
    return sizes | {name: ("side", [side[name] for side in numbers]) for name in numbers[0]} | {"side": list(SIDES)}


def estimated(plan: Any) -> list[str]:
    """Devices of a kind that the estimate knows: with a tip, in humid air."""
    return [name for name in plan.devices.sections if is_estimated(plan, name)]


def is_estimated(plan: Any, device: str) -> bool:
    """Whether a device is of a kind that the estimate knows."""
    return plan.devices.kind(device).has_tip and bool(humid(plan.devices.sections[device]["humidities"]))


def _settings(plan, at):
    """Numbers of a device, or why the estimate refuses it."""
    section = plan.config["devices"][at.device]
    question = question_of(plan.config, at.device, section | {"humidities": humid(section["humidities"])})
    if isinstance(question, NotLearnt):
        return {"refused": str(question)}
    pair, surfaces = plan.config["pairs"][section["pair"]], plan.config["surfaces"]
    return {"asked": select(AskedCantilever, section | {side: surfaces[pair[side]] for side in SIDES})}


STAGES = (
    Stage.writing(
        "device_estimate",
        "devices/estimate/{device}",
        inputs=lambda plan, at: results_of(plan, at.device, "lengths") | {"table": File(FILE)},
        settings=_settings,
        kind=Settings,
        compute=compute,
        message="Estimate at once of {device} beside its run.",
    ),
)
