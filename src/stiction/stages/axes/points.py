"""Points of an axis: a device on changed surfaces of its pair, with the same random numbers on all of them."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import xarray as xr

from stiction.analysis.shifts import Description
from stiction.contact.air import KINDS_OF_AIR, Air
from stiction.devices.risk import VERIFIED, samples_for
from stiction.devices.tail import FEWEST, TAIL
from stiction.plan.stage import At
from stiction.stages.axes import requirement
from stiction.stages.axes.requirement import RequiredBeam, RequiredStopper
from stiction.stages.contact import contact as stage_contact
from stiction.stages.contact import pairs
from stiction.stages.contact.changes.patches import GROUND, TIPS
from stiction.stages.contact.corrections import with_correction
from stiction.stages.devices.contact_names import corrections_of
from stiction.stages.surfaces.descriptions import description, drawn_as
from stiction.stages.surfaces.rough_surfaces import surface_inputs

#: Fewest samples of which the lowest can be fitted.
FEWEST_OF_FIT = round(FEWEST / TAIL)
#: Variables of a device that all its points share.
_SHARED = ["required", "share", "samples"]

#: Datasets of heights and spectrum of both surfaces of a pair, that of the beam first.
Surfaces = Sequence[tuple[xr.Dataset, xr.Dataset]]


@dataclass(frozen=True)
class Contacts:
    """Settings of the contacts of a device in one air."""

    contact: pairs.Settings  #: of its patch
    tips: pairs.Settings | None = None  #: of the tips of a cantilever


@dataclass(frozen=True)
class DeviceAtPoint:
    """Settings of a device at a point, without the surfaces."""

    pair: str  #: part of the addresses of random numbers
    beam: RequiredBeam | None = None
    stopper: RequiredStopper | None = None
    humid: Contacts | None = None  #: contacts in humid air
    dry: Contacts | None = None  #: contacts in dry air

    @property
    def airs(self) -> dict[str, Contacts]:
        """Contacts by the kind of air."""
        return {kind: contacts for kind in KINDS_OF_AIR if (contacts := getattr(self, kind))}

    @property
    def patch(self) -> pairs.Settings:
        """Settings of the contact of its patch in any air."""
        return next(iter(self.airs.values())).contact

    def described(self, surfaces: Surfaces) -> dict[str, Description]:
        """Surfaces of the pair by name."""
        return {name: description(*surface) for name, surface in zip(self.patch.surfaces, surfaces, strict=True)}

    def on(self, surfaces: Surfaces, changed: Sequence[Mapping[str, Description]]) -> Iterator[xr.Dataset]:
        """Yield the device on the surfaces of the pair, with changed ones by name."""
        names, spacing = self.patch.surfaces, self.patch.sampling.spacing
        drawn = {id(surface): drawn_as(surface, spacing) for change in changed for surface in change.values()}
        alternatives = [
            [drawn[id(change[name])] if name in change else same for name, same in zip(names, surfaces, strict=True)]
            for change in changed
        ]
        patches = {kind: self._contacts(alternatives, contacts.contact) for kind, contacts in self.airs.items()}
        tips = {
            kind: self._contacts(alternatives, contacts.tips) for kind, contacts in self.airs.items() if contacts.tips
        }
        for number in range(len(changed)):
            at, tip = ({kind: datasets[number] for kind, datasets in by_kind.items()} for by_kind in (patches, tips))
            yield requirement.compute(at, self.beam or self.stopper, tip)

    def _contacts(self, alternatives, settings):
        """Contacts of one kind on alternative surfaces."""
        contacts = stage_contact.compute_each(alternatives, self.pair, "NG", settings)
        sides = pairs.sides_of_strip(settings)
        return [stage_contact.with_correlations(*each, sides) for each in zip(contacts, alternatives, strict=True)]

    def with_samples(self, number: int) -> "DeviceAtPoint":
        """Device with fewer patches, and as many tips."""

        def few(contacts):
            """Contacts with fewer patches."""
            patch = contacts.contact
            samples = min(max(number, FEWEST_OF_FIT), patch.contact.samples)
            return replace(contacts, contact=replace(patch, contact=replace(patch.contact, samples=samples)))

        return replace(self, **{kind: few(contacts) for kind, contacts in self.airs.items()})

    def corrected(self, data: Mapping[str, Any]) -> "DeviceAtPoint":
        """Device with the correction to full elastic contact from its input."""
        return replace(
            self,
            **{
                name: with_correction(settings, data)
                for name in ("beam", "stopper")
                if (settings := getattr(self, name))
            },
        )


def joined(points: Sequence[xr.Dataset], *dimensions: str) -> xr.Dataset:
    """Points along the last dimension, in rows along the one before it if there is one."""
    *rows, along = dimensions
    if not rows:
        over = [point.drop_vars(_SHARED).set_coords(along) for point in points]
        return xr.concat(over, along).assign(points[0][_SHARED])
    values = list(dict.fromkeys(float(point[rows[0]]) for point in points))
    of_each = [[point.drop_vars(rows) for point in points if float(point[rows[0]]) == value] for value in values]
    curves = [joined(each, along) for each in of_each]
    varied = [name for name in curves[0].data_vars if along in curves[0][name].dims]
    points_in_rows = xr.concat(curves, rows[0], data_vars=varied, coords="minimal", compat="equals", join="exact")
    return points_in_rows.assign_coords({rows[0]: values})


# Plan


def names(folder: str, device: str, axes: Iterable[Sequence]) -> list[str]:
    """Names of the points of a device, along the first axis at one value of the second after the other."""
    return [f"{folder}/{device}_{number}" for number in range(math.prod(map(len, axes)))]


def places(number: str, axes: Sequence[Sequence]) -> list[int]:
    """Number of the value of a point along each axis, see `names`."""
    return list(divmod(int(number), len(axes[0])))[::-1][: len(axes)]


def values_at(number: str, axes: Sequence[Sequence]) -> list:
    """Value of a point along each axis, see `names`."""
    return [axis[index] for axis, index in zip(axes, places(number, axes), strict=True)]


def inputs(plan: Any, device: str) -> dict[str, Any]:
    """Surfaces of the pair of a device, and its correction.

    ASSUME: a correction to full elastic contact is that of the given surfaces at every point.
    """
    return surface_inputs(plan, plan.config["devices"][device]["pair"]) | corrections_of(plan, device)


def settings_of(plan: Any, device: str, rough: Any) -> dict[str, Any]:
    """Settings of a device. A plan with the changed surfaces is ``rough``: the reach of tips depends on them."""
    section, kind = plan.config["devices"][device], plan.devices.kind(device)
    settings = {"pair": section["pair"], kind.release.name: requirement.settings_of(plan, device)}
    for humidity in section["humidities"]:
        pair = plan.air_of_devices.contact(section["pair"], humidity)
        tips = {"tips": _of_tips(rough, pair, device)} if kind.has_tip else {}
        settings[Air(humidity).kind] = {"contact": _of_patch(plan, pair, device)} | tips
    return settings


def _of_patch(plan, pair, device):
    """Settings of the contact of the patch of a device, with as many stoppers as its share of stuck ones needs.

    Those of smaller shares than have been verified are extrapolated. The pair is that of the device in its air.
    """
    ground, share = plan.devices.ground(device), plan.config["devices"][device]["requirement"]["share"]
    samples = plan.devices.samples(ground)
    if not plan.devices.kind(device).release.has_laws:
        samples = max(samples, samples_for(max(share, VERIFIED)))
    return GROUND.settings(plan, At(**ground._replace(pair=pair)._asdict()), samples)


def _of_tips(plan, pair, device):
    """Settings of the tips of a cantilever, see `_of_patch`."""
    tips = plan.devices.tips(device)._replace(pair=pair)
    return TIPS.settings(plan, At(**tips._asdict()), plan.config["design"]["beams"])
