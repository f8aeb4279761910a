"""Contacts of a device at several roughnesses of one of its surfaces: of its patch and, for cantilevers, of its tips.

The samples of all contacts have the same random numbers. Form of the heights and shape of the spectrum stay.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from stiction.analysis.shifts import value_of, with_value
from stiction.config.cases import DRY_AIR, PairInAir
from stiction.config.kinds import ROUGHNESSES
from stiction.config.merging import merged
from stiction.config.units import without_unit
from stiction.devices.risk import VERIFIED, samples_for
from stiction.plan.stage import At, Running, Stage
from stiction.stages.contact import contact as stage_contact
from stiction.stages.contact import pairs
from stiction.stages.contact.changes.patches import GROUND, TIPS
from stiction.stages.surfaces.descriptions import description, drawn_as
from stiction.stages.surfaces.rough_surfaces import both, surface_inputs

#: Folder of the contacts of patches; those of tips have one in it.
FOLDER = "devices/contact"
#: Points of a curve, the last of which has the surface as it is given.
POINTS = 8
#: Curves of a map over two quantities, the first of which has the second quantity as it is given.
CURVES = 5


class Varied(NamedTuple):
    """Varied quantity: one key of section ``roughness`` of a device."""

    surface: str
    key: str  #: of `stiction.config.kinds.ROUGHNESSES`
    low: float  #: ends of the range, in the unit of the key
    high: float

    def value(self, number: int) -> float | None:
        """Value of a point in the unit of the key, ``None`` as it is given. Evenly spaced, or by equal factors."""
        return None if number == POINTS - 1 else self._spaced(number, POINTS - 1)

    def value_of_curve(self, number: int) -> float | None:
        """Value of a curve of a map, see `value`."""
        return None if number == 0 else self._spaced(number - 1, CURVES - 1)

    def _spaced(self, number, count):
        spaced = np.geomspace if ROUGHNESSES[self.key].logarithmic else np.linspace
        return float(spaced(self.low, self.high, count)[number].round(9))

    def named(self, name: str, value: float | None) -> dict[str, float | None]:
        """Value by a name with the unit of the key."""
        unit = self.key.removeprefix(without_unit(self.key))
        return {name + unit * (value is not None): value}


@dataclass(frozen=True)
class Settings:
    """Settings of such a contact, without its surfaces."""

    contact: pairs.Settings
    pair: str  #: part of the addresses of random numbers
    surface: str  #: the one that is changed; on both sides of the pair if both have it
    quantity: str  #: rms, skewness or corner
    value: float | None  #: [SI]; none for the surface as it is given
    other: str = ""  #: another quantity that is changed as well
    other_value: float | None = None  #: [SI]


def compute(surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], settings: Settings) -> xr.Dataset:
    """Dataset of stage contact with the value of the quantity, and of an unchanged second one, as variables.

    So is the kurtosis, which may change with the skewness, see `stiction.analysis.shifts.with_value`.
    """
    names = settings.contact.surfaces
    given = changed = description(*surfaces[names.index(settings.surface)])
    wanted = {settings.quantity: settings.value, settings.other: settings.other_value}
    for quantity, value in wanted.items():
        if value is not None:
            changed = with_value(changed, quantity, value)
    if changed is not given:
        drawn = drawn_as(changed, settings.contact.sampling.spacing)
        surfaces = [drawn if name == settings.surface else same for name, same in zip(names, surfaces, strict=True)]
    contact = stage_contact.compute(surfaces, settings.pair, "NG", settings.contact)
    contact = stage_contact.with_correlations(contact, surfaces, pairs.sides_of_strip(settings.contact))
    values = {"roughness": value_of(changed, settings.quantity), "kurtosis": changed.kurtosis}
    contact = contact.assign({name: float(value) for name, value in values.items()})
    if not settings.other:
        return contact
    others = {"other": changed, "other_given": given}
    return contact.assign({name: float(value_of(surface, settings.other)) for name, surface in others.items()})


def roughness_of(contact: xr.Dataset) -> float:
    """Value of the varied quantity of the surface of a contact [SI]."""
    return float(contact.roughness)


def varied_quantities(plan: Any, device: str) -> list[Varied]:
    """Varied quantities of the surfaces of a device: along its curves and, for a map, from curve to curve."""
    section = plan.config["devices"][device]["roughness"]
    return [Varied(section["surface"], key, *section[key]) for key in ROUGHNESSES if key in section]


def points_of(plan: Any, device: str) -> range:
    """Numbers of the points of a device, curve by curve."""
    return range(POINTS * (CURVES if len(varied_quantities(plan, device)) > 1 else 1))


def contacts_of(plan: Any, device: str, number: int) -> dict[str, dict[bool, str]]:
    """Names of the contacts of a point, in humid air (true) and in dry air: of the patch, and of tips if there are any.

    Where no water condenses, both are that in dry air.
    """
    section = plan.config["devices"][device]
    folders = {"contact": FOLDER} | ({"tips": f"{FOLDER}/tips"} if plan.devices.kind(device).has_tip else {})
    airs = {humidity > 0: plan.air_of_devices.contact(section["pair"], humidity) for humidity in section["humidities"]}
    names = {is_humid: f"{device}{pair.ending}_{number}" for is_humid, pair in airs.items()}
    return {
        kind: {is_humid: f"{folder}/roughness/{name}" for is_humid, name in names.items()}
        for kind, folder in folders.items()
    }


def patch_settings(plan: Any, pair: str, device: str) -> dict[str, Any]:
    """Settings of the contact of the patch of a device, with as many stoppers as its share of stuck ones needs.

    Those of smaller shares than have been verified are extrapolated. The pair is that of the device in its air.
    """
    ground, share = plan.devices.ground(device), plan.config["devices"][device]["requirement"]["share"]
    samples = plan.devices.samples(ground)
    if not plan.devices.kind(device).is_beam:
        samples = max(samples, samples_for(max(share, VERIFIED)))
    return GROUND.settings(plan, At(**ground._replace(pair=pair)._asdict()), samples)


def tip_settings(plan: Any, pair: str, device: str) -> dict[str, Any]:
    """Settings of the tips of a cantilever, see `patch_settings`."""
    tips = plan.devices.tips(device)._replace(pair=pair)
    return TIPS.settings(plan, At(**tips._asdict()), plan.config["design"]["beams"])


def _stage(name, folder, contact, words, ending=""):
    """Stage of one contact of a point. ``contact`` gives its settings by plan, pair in its air and device."""

    def settings(plan, at):
        """Settings of the contact of a point, with its values of the varied quantities."""
        pair = plan.config["devices"][at.device]["pair"]
        what, *others = varied_quantities(plan, at.device)
        curve, point = divmod(int(at.number), POINTS)
        values = [(what, what.value(point)), *((other, other.value_of_curve(curve)) for other in others)]
        own = plan.config["surfaces"][what.surface]
        surface = {one.key: value for one, value in values if value is not None and one.key in own}
        if surface:  # on which the reach of tips depends
            plan = replace(plan, config=merged(plan.config, {"surfaces": {what.surface: surface}}))
        settings = {"contact": contact(plan, PairInAir(pair + ending), at.device), "pair": pair}
        settings |= {"surface": what.surface, "quantity": without_unit(what.key)} | what.named("value", values[0][1])
        for other, value in values[1:] if curve else ():
            settings |= {"other": without_unit(other.key)} | other.named("other_value", value)
        return settings

    return Stage.writing(
        name,
        f"{folder}/roughness/{{device}}{ending}_{{number}}",
        inputs=lambda plan, at: surface_inputs(plan, plan.config["devices"][at.device]["pair"]),
        settings=settings,
        kind=Settings,
        compute=lambda data, settings: compute(both(data), settings),
        label="contact",
        message=f"Contact of {words} of {{device}}, roughness {{number}}.",
        running=Running(minutes=120, temporary=True),
    )


STAGES = (
    _stage("roughness_contact", FOLDER, patch_settings, "the patch"),
    _stage("roughness_tip_contact", f"{FOLDER}/tips", tip_settings, "the tips"),
    _stage("roughness_dry_contact", FOLDER, patch_settings, "the patch, in dry air,", DRY_AIR.ending),
    _stage("roughness_dry_tip_contact", f"{FOLDER}/tips", tip_settings, "the tips, in dry air,", DRY_AIR.ending),
)
