"""Stage process_point: a device on the surfaces of a process at one value of its variable.

The device is computed as along a roughness (`stiction.stages.roughness.curves`), with the same random numbers at all
values. At some values, its slopes by the quantities of the law are computed as well.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from stiction.analysis.process_law import QUANTITIES, grid, jacobian
from stiction.analysis.shifts import Description, bracketed
from stiction.config.surfaces import process
from stiction.devices.roughness import LARGEST, margins
from stiction.devices.tail import FEWEST, TAIL
from stiction.plan.stage import Running, Stage
from stiction.stages.contact import contact as stage_contact
from stiction.stages.contact import pairs
from stiction.stages.contact.corrections import with_correction
from stiction.stages.devices.contact_names import corrections_of
from stiction.stages.process.law import in_order, law_inputs, on_law
from stiction.stages.roughness import curves
from stiction.stages.roughness.contacts import patch_settings, tip_settings
from stiction.stages.roughness.curves import OfBeam, OfStopper
from stiction.stages.surfaces.descriptions import description, drawn_as
from stiction.stages.surfaces.rough_surfaces import both, surface_inputs

#: Fewest patches of which a safe force can be fitted.
FEWEST_OF_FIT = round(FEWEST / TAIL)
#: Fewest intervals between values of the variable of a second process.
SECOND = 4

Surfaces = Sequence[tuple[xr.Dataset, xr.Dataset]]


@dataclass(frozen=True)
class Contacts:
    """Settings of the contacts of a device in one air."""

    contact: pairs.Settings  #: of its patch
    tips: pairs.Settings | None = None  #: of the tips of a cantilever


@dataclass(frozen=True)
class Settings:
    """Settings of a point, without the surfaces and the laws."""

    pair: str  #: part of the addresses of random numbers
    value: float  #: of the variable [its unit]
    second: float | None = None  #: of that of a second process [its unit]
    beam: OfBeam | None = None  #: of a beam
    stopper: OfStopper | None = None  #: of a stopper
    humid: Contacts | None = None  #: contacts in humid air
    dry: Contacts | None = None  #: contacts in dry air
    samples: int = 0  #: patches for the slopes, none at values without slopes

    @property
    def device(self) -> OfBeam | OfStopper:
        """Settings of the device."""
        return self.beam or self.stopper

    @property
    def airs(self) -> dict[bool, Contacts]:
        """Contacts in humid air (true) and in dry air."""
        return {is_humid: found for is_humid, found in ((True, self.humid), (False, self.dry)) if found}


def compute(surfaces: Surfaces, laws: Sequence[xr.Dataset], settings: Settings) -> xr.Dataset:
    """Dataset of stage roughness_point, with slopes of the margin by the scaled quantities of the laws.

    The surfaces are datasets (heights, spectrum) of the pair, that of the beam first.
    """
    names = next(iter(settings.airs.values())).contact.surfaces
    given = {name: description(*one) for name, one in zip(names, surfaces, strict=True)}
    made = {}
    second = settings.value if settings.second is None else settings.second
    for law, value in zip(laws, (settings.value, second), strict=False):
        surface = str(law.surface)
        made[surface] = on_law(given[surface], law, value)
    (point,) = _points(surfaces, [made], settings)
    rms, rms_given = (np.hypot(*(each[name].rms for name in names)) for each in (given | made, given))
    points = curves.flagged(point, bool(rms < rms_given)).assign(value=settings.value)
    if settings.second is not None:
        points = points.assign(second=second)
    if not settings.samples:
        return points
    few = _with_samples(settings)
    slopes = [_slopes(surfaces, made, law, few) for law in laws]
    # ASSUME: slopes are linear between these values: both ends and the middle.
    return points.assign(slopes=(("humidity", "shape", "law_quantity"), np.concatenate(slopes, axis=-1)))


def _slopes(surfaces, made, law, settings):
    """Slopes of the margins by the scaled quantities of one law, (n_rh, shapes, q)."""
    own, names = made[str(law.surface)], list(map(str, law["quantity"].values))
    pairs_of, differences = zip(*(bracketed(own, name) for name in names), strict=True)
    sides = [made | {str(law.surface): side} for both_sides in pairs_of for side in both_sides]
    found = np.array([_margin(point) for point in _points(surfaces, sides, settings)])
    found[np.abs(found) >= LARGEST] = np.nan
    by_plain = (found[1::2] - found[::2]) / np.reshape(differences, (-1, 1, 1))
    places = [QUANTITIES.index(name) for name in names]
    at = [np.log(own.rms), own.skewness, own.kurtosis, np.log(own.spectrum.corner), _slope(own)]
    return np.einsum("jhs,jk->hsk", by_plain, jacobian(np.array(at))[np.ix_(places, places)])


def _slope(surface):
    """Slope of a spectrum, or any number for a table."""
    return getattr(surface.spectrum, "slope", -1.0)


def _margin(point):
    """Margins of a point to the requirement, (n_rh, shapes)."""
    return margins(point.estimate.values, float(point.required), point.required.attrs["units"] == "m")


def _points(
    surfaces: Surfaces, changed: Sequence[Mapping[str, Description]], settings: Settings
) -> Iterator[xr.Dataset]:
    """Yield the device on surfaces of several descriptions by name, with the same random numbers."""
    names = next(iter(settings.airs.values())).contact.surfaces
    spacing = next(iter(settings.airs.values())).contact.sampling.spacing
    drawn = {id(one): drawn_as(one, spacing) for some in changed for one in some.values()}
    alternatives = [
        [drawn[id(some[name])] if name in some else same for name, same in zip(names, surfaces, strict=True)]
        for some in changed
    ]
    patches = {humid: _contacts(alternatives, settings, of.contact) for humid, of in settings.airs.items()}
    tips = {humid: _contacts(alternatives, settings, of.tips) for humid, of in settings.airs.items() if of.tips}
    for number in range(len(changed)):
        at, tip = ({humid: some[number] for humid, some in of.items()} for of in (patches, tips))
        yield curves.compute(
            {humid: one.assign(roughness=settings.value) for humid, one in at.items()}, settings.device, tip
        )


def _contacts(alternatives, settings, of):
    """Contacts of one kind on alternative surfaces."""
    contacts = stage_contact.compute_each(alternatives, settings.pair, "NG", of)
    sides = pairs.sides_of_strip(of)
    return [stage_contact.with_correlations(*one, sides) for one in zip(contacts, alternatives, strict=True)]


def _with_samples(settings):
    """Settings with the number of patches for slopes."""

    def few(of):
        """Contacts with fewer patches, and as many tips."""
        number = min(max(settings.samples, FEWEST_OF_FIT), of.contact.contact.samples)
        return replace(of, contact=replace(of.contact, contact=replace(of.contact.contact, samples=number)))

    return replace(settings, **{name: few(of) for name, of in (("humid", settings.humid), ("dry", settings.dry)) if of})


# Plan


def values_of(plan: Any, device: str) -> list[float]:
    """Computed values of the variable, within the settings of all processes of a device."""
    known = plan.config["process"]
    named = process.processes_of(plan.config, device)
    settings = [sorted(setting["value"] for setting in known[name]["settings"]) for name in named]
    low, high = max(one[0] for one in settings), min(one[-1] for one in settings)
    inside = {value for one in settings for value in one if low <= value <= high}
    return grid(sorted(inside | {low, high})).tolist()


def axes_of(plan: Any, device: str) -> list[list[float]]:
    """Values of the variable, and of the variable of a second process."""
    if not process.is_mapped(plan.config, device):
        return [values_of(plan, device)]
    first, second = (
        sorted(setting["value"] for setting in plan.config["process"][name]["settings"])
        for name in process.processes_of(plan.config, device)
    )
    return [grid(first).tolist(), grid(second, SECOND).tolist()]


def points_of(plan: Any, device: str) -> range:
    """Numbers of the points of a device, at one value of a second process after the other."""
    return range(math.prod(map(len, axes_of(plan, device))))


def _settings(plan, at):
    """Settings of a point of a device."""
    section, axes = plan.config["devices"][at.device], axes_of(plan, at.device)
    row, column = divmod(int(at.number), len(axes[0]))
    own = curves.settings_of(plan, at)
    values = [axis[number] for axis, number in zip(axes, (column, row), strict=False)]
    settings = {"pair": section["pair"], "value": values[0]} | dict(zip(["second"], values[1:], strict=False))
    settings["beam" if plan.devices.kind(at.device).is_beam else "stopper"] = own
    rough = _as_rough(plan, at.device, values[0], values[-1])
    for humidity in section["humidities"]:
        air = plan.air_of_devices.contact(section["pair"], humidity)
        tips = {"tips": tip_settings(rough, air, at.device)} if plan.devices.kind(at.device).has_tip else {}
        settings["humid" if humidity > 0 else "dry"] = {"contact": patch_settings(plan, air, at.device)} | tips
    at_places = all(number in _places(axis) for axis, number in zip(axes, (column, row), strict=False))
    return settings | ({"samples": plan.config["studies"]["slopes"]["samples"]} if at_places else {})


def _places(axis):
    """Numbers of the values with slopes."""
    return 0, (len(axis) - 1) // 2, len(axis) - 1


def _as_rough(plan, device, *at):
    """Plan with the rms of the surfaces at a value of the variable, on which the length of tips depends.

    It is preliminary: on straight lines through the logarithms at the settings.
    """
    for name, value in zip(process.processes_of(plan.config, device), at, strict=False):
        section, surfaces = plan.config["process"][name], plan.config["surfaces"]
        values = sorted(setting["value"] for setting in section["settings"])
        known = np.log([plan.devices.rms(one) for one in in_order(plan, name)])
        entry = {key: kept for key, kept in surfaces[section["surface"]].items() if key != "scans"}
        entry["rms_nm"] = float(np.exp(np.interp(value, values, known)).round(9))
        plan = replace(plan, config=plan.config | {"surfaces": surfaces | {section["surface"]: entry}})
    return plan


STAGES = (
    Stage.writing(
        "process_point",
        "process/points/{device}_{number}",
        # ASSUME: a correction is that of the given surfaces at every setting; smoother ones are flagged.
        inputs=lambda plan, at: (
            surface_inputs(plan, plan.config["devices"][at.device]["pair"])
            | law_inputs(plan, at.device)
            | corrections_of(plan, at.device)
        ),
        settings=_settings,
        kind=Settings,
        compute=lambda data, settings: compute(both(data), data["laws"], device_with_correction(settings, data)),
        message="Device {device} at value {number} of its process.",
        running=Running(minutes=120),
    ),
)


def device_with_correction(settings: Settings, data: Mapping[str, Any]) -> Settings:
    """Settings with the correction to full elastic contact from its input."""
    return replace(settings, **{"beam" if settings.beam else "stopper": with_correction(settings.device, data)})
