"""Results of devices beyond the limits of the model, by the rules of `stiction.devices.limits.rules`."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

import xarray as xr

from stiction.config.units import from_si, in_si
from stiction.contact.air import Air, humid
from stiction.contact.environment import Water
from stiction.devices.limits import rules
from stiction.devices.limits.limit import Limit, restored
from stiction.plan.names import by_case, by_name
from stiction.plan.stage import File, Stage, select
from stiction.run.atomic import save_text
from stiction.stages.beams.pair_warnings import (
    NOT_STUDIED,
    Limits,
    Plastic,
    StatedProperties,
    Subject,
    contact_warnings,
    plastic_contact,
)
from stiction.stages.devices.contact_names import corrections_of
from stiction.stages.devices.end_states import END_STATES
from stiction.stages.devices.opening import ARC, EITHER, FORCE, S_SHAPE, SOUGHT_BY, DesignedBeam, own_section
from stiction.stages.devices.results import results_of
from stiction.stages.devices.safe_lengths import chosen_share
from stiction.stages.devices.stoppers import search_ends
from stiction.stages.surfaces import surface_flags

#: Limits by end state.
ByShape = dict[str, list[Limit]]


@dataclass(frozen=True)
class Accuracy:
    """Accuracy that a configuration asks for, see `stiction.accuracy`."""

    length: float  #: relative standard error [-]


@dataclass(frozen=True)
class OfDevice:
    """Device and its pair."""

    device: DesignedBeam
    accuracy: Accuracy | None = None  #: of its lengths
    materials: StatedProperties = ()  #: of its pair
    learns: bool = False  #: whether it has test beams
    on_summits: tuple[float, ...] = ()  #: humidities with water at which summits alone make its forces [-]
    unknown: tuple[float, ...] = ()  #: those of these at which full contact of its forces is not known [-]
    has_dimples: bool = False  #: whether forces of dimples decide about all shapes
    conditions: tuple[dict, ...] = ()  #: of its mission, as in the configuration

    @property
    def pair(self) -> str:
        """Name of its pair."""
        return self.device.pair

    @property
    def changes_of_forces(self) -> tuple[str, ...]:
        """Flags of the changes of its forces, of a dataset of stage model_error_of_devices."""
        has_tip = EITHER in self.device.opening.shapes
        return ("tip_applied",) * has_tip + ("pull_off_applied",) * (self.has_dimples or not has_tip)

    @property
    def ratios_of_forces(self) -> tuple[str, ...]:
        """Ratios of these changes."""
        return tuple(flag.replace("applied", "ratio") for flag in self.changes_of_forces)

    def limits(self, dataset: xr.Dataset, plastic: Plastic = NOT_STUDIED, humidity: float = 0.0) -> ByShape:
        """Limits at a humidity by end state, from the dataset of stage safe_lengths.

        Each state is checked at the shortest of its lengths, where slopes are largest. That no water condenses is worth
        a warning at a humidity, but not in dry air.
        """
        shortest = dataset.safe_length.min("share")
        without = rules.triggered(
            rules.no_water(float(dataset.film), humidity),
            rules.flat_patches(float(dataset.share_flat)),
            rules.lengths_of_sizes(float(dataset.size_error)),
            rules.condensing(self.conditions),
            rules.supercooled(self.conditions),
        )
        on_summits, unknown = ([humidity] if humidity in airs else [] for airs in (self.on_summits, self.unknown))
        of_forces = rules.triggered(
            rules.smooth_pair(float(dataset.rms), on_summits), rules.unknown_full_contact(unknown)
        )
        return {
            shape: without
            + of_forces * (self.has_dimples or shape != S_SHAPE)
            + _length_warnings(float(shortest.sel(shape=shape)), dataset, self, plastic)
            + _accuracy_warnings(dataset.sel(shape=shape), self)
            for shape in map(str, dataset["shape"].values)
        }


@dataclass(frozen=True)
class StopperOnPair:
    """Stopper and its pair."""

    pair: str
    water: Water
    contact: tuple[float, float]  #: sides of the patch [m]
    humidities: tuple[float, ...]  #: of the stopper [-]
    worst_humidities: tuple[float, float]  #: ends of the axis along which the worst humidity is sought [-]
    materials: StatedProperties = ()  #: of its pair
    on_summits: tuple[float, ...] = ()  #: humidities with water at which summits alone make its forces [-]
    unknown: tuple[float, ...] = ()  #: those of these at which full contact of its forces is not known [-]
    conditions: tuple[dict, ...] = ()  #: of its mission, as in the configuration
    changes_of_forces: ClassVar[tuple[str, ...]] = ("pull_off_applied",)  #: as of `OfDevice`
    ratios_of_forces: ClassVar[tuple[str, ...]] = ("pull_off_ratio",)  #: as of `OfDevice`

    def limits(self, dataset: xr.Dataset, plastic: Plastic = NOT_STUDIED, _humidity: float = 0.0) -> ByShape:
        """Limits, from the dataset of stage stoppers. Other parameters as of `OfDevice.limits`."""
        humid_airs = humid(self.humidities)
        airs = (*humid_airs, *(self.worst_humidities if humid_airs else ()))
        water = self.water.between(humid_airs, airs)
        films = [water.film(rh)[0] for rh in airs] or [0.0]
        limits = rules.triggered(
            rules.no_water(max(films), max(self.humidities)),
            rules.thin_film(min(films)),
            rules.condensing(self.conditions),
            rules.supercooled(self.conditions),
            rules.wide_meniscus(max(films), self.contact),
            rules.flat_patches(float(dataset.share_flat)),
            rules.smooth_pair(float(dataset.rms), self.on_summits),
            rules.unknown_full_contact(self.unknown),
            *contact_warnings(plastic, self.materials, is_stopper=True),
        )
        return {FORCE: limits}


#: By the name of the release.
_OF_RELEASE = {"beam": OfDevice, "stopper": StopperOnPair}


def of_settings(settings: Mapping[str, Any]) -> OfDevice | StopperOnPair:
    """Device and its pair from the settings of a job."""
    (subject,) = (in_si(kind, settings[release]) for release, kind in _OF_RELEASE.items() if release in settings)
    return subject


def _accuracy_warnings(safe_lengths, subject):
    """Warning about the error of the length of one shape at the share that pages speak of, if an accuracy is stated."""
    if subject.accuracy is None:
        return []
    state = safe_lengths.sel(share=chosen_share(safe_lengths))
    errors = [float(state[name] / state.estimate) for name in ("beams_error", "surfaces_error")]
    return rules.triggered(rules.missed_accuracy(*errors, subject.accuracy.length))


def chart_warnings(
    charts: Sequence[xr.Dataset], subject: OfDevice, plastic: Plastic = NOT_STUDIED
) -> dict[tuple[float, float, str], list[Limit]]:
    """Limits of the chart of a device by thickness [m], gap [m] and shape. A dataset of stage chart per humidity.

    Each curve is checked at its shortest length.
    """
    by_curve = {}
    for thickness, gap, shape in curves(charts[0]):
        along = [curve.sel(thickness=thickness, gap=gap, shape=shape) for curve in charts]
        shortest = min(along, key=lambda curve: float(curve.safe_length.min()))
        shortest = shortest.assign(longest_strip=min(curve.longest_strip for curve in along))
        shortest = shortest.assign(resampled=max(curve.resampled for curve in along))
        of_size = replace(subject, device=replace(subject.device, thickness=thickness, gap=gap))
        length = float(shortest.safe_length.min())
        by_curve[thickness, gap, shape] = _length_warnings(
            length, shortest, of_size, plastic, min(filter(None, (float(curve.film) for curve in along)), default=0.0)
        )
    return by_curve


def curves(chart: xr.Dataset) -> list[tuple[float, float, str]]:
    """Thickness [m], gap [m] and shape of every curve of a dataset of stage chart."""
    return list(product(*(chart[name].values.tolist() for name in ("thickness", "gap", "shape"))))


def _length_warnings(length, dataset, subject, plastic, thinnest=None):
    """Warnings about a device of a length [m]. Film, rms and longest strip from a dataset.

    The thinnest film [m] is that of the dataset, or along the axis of a chart.
    """
    device = subject.device
    sizes = device.gap, device.width, device.thickness, length / device.opening.arms
    is_bridge = device.opening.arms == 2
    return rules.beam_warnings(*sizes, float(dataset.film), float(dataset.rms)) + rules.triggered(
        rules.long_strips(device.strip, float(dataset.longest_strip), is_bridge),
        rules.resampled_strips(int(dataset.resampled)),
        rules.repeated_strips(float(dataset.repetition), device.strip, subject.learns),
        rules.thin_film(thinnest or float(dataset.film)),
        rules.stretched_bridge(device.gap, device.thickness) if is_bridge else None,
        *contact_warnings(plastic, subject.materials),
    )


class OfDevices(NamedTuple):
    """Limits of devices."""

    lengths: dict[tuple[str, float, str], list[Limit]]  #: by name, humidity and shape
    curves: dict[tuple[str, float, float, str], list[Limit]]  #: of charts, by name, thickness [m], gap [m] and shape
    patches: dict[str, list[Limit]]  #: of stoppers, by name


def read(files: Mapping[str, str]) -> OfDevices:
    """Limits of devices from their files, by name."""
    joined = OfDevices({}, {}, {})
    for name, path in files.items():
        for by_subject, stored in zip(joined, json.loads(Path(path).read_text(encoding="utf-8")), strict=True):
            by_subject.update({(name, *key) if key else name: list(map(restored, limits)) for key, limits in stored})
    return joined


def subjects(of_devices: OfDevices) -> Limits:
    """Limits of devices by their subjects in words."""
    by_subject = {
        Subject(name, (Air(humidity).words, f"held by the {END_STATES[shape].by}")): limits_of_length
        for (name, humidity, shape), limits_of_length in of_devices.lengths.items()
    }
    for (name, thickness, gap, shape), limits_of_curve in of_devices.curves.items():
        size = f"{from_si(thickness, 'um'):g} µm thick", f"gap {from_si(gap, 'um'):g} µm"
        by_subject[Subject(name, ("chart", *size, f"held by the {END_STATES[shape].by}"))] = limits_of_curve
    return by_subject | {Subject(name): limits_of_patch for name, limits_of_patch in of_devices.patches.items()}


# Stages


def left_out_changes(dataset: xr.Dataset) -> dict[tuple[float, str], tuple[float, float]]:
    """Change and its standard error by humidity and response, from a dataset of stage left_out_gaps.

    Responses are those of `stiction.stages.devices.budget.response_of`.
    """
    keys = zip(map(float, dataset.humidity.values), map(str, dataset.response.values), strict=True)
    return dict(zip(keys, zip(dataset.change.values.tolist(), dataset.error.values.tolist(), strict=True), strict=True))


def gap_warnings(changes: Mapping[tuple[float, str], tuple[float, float]], shape: str) -> list[Limit]:
    """Limit by the effect of attraction across gaps on adhesion in a shape, from `left_out_changes`."""
    response = ARC if shape == EITHER else shape
    of_shape = {humidity: change for (humidity, end_state), change in changes.items() if end_state == response}
    return rules.triggered(rules.without_gaps(of_shape, shorter=not SOUGHT_BY[shape].more_is_better))


def left_out_gaps(plan: Any, device: str) -> dict[str, str]:
    """Dataset of a device with results without attraction across gaps, as input of a stage, none for others."""
    pair = plan.config["devices"][device]["pair"]
    is_left_out = plan.air_of_devices.reach(pair) == "touching" and plan.config["van_der_waals"] != "none"
    return {"left_out_gaps": f"devices/left_out_gaps/{device}"} if is_left_out else {}


def _inputs(plan, at):
    """Inputs of the warnings about a device."""
    devices, results = plan.devices, results_of(plan, at.device, "lengths", "stopper")
    charts = devices.chart_cases(at.device) if at.device in devices.with_chart else []
    limited = {
        "lengths": {(at.device, humidity): name for humidity, name in results.get("lengths", {}).items()},
        "stoppers": {at.device: results["stopper"]} if "stopper" in results else {},
        "charts": by_case("devices/chart", charts),
        "plasticity": by_name("studies/plasticity", devices.pairs_of_plasticity(at.device)),
    }
    changes = {} if "model" in plan.config["contact"] else corrections_of(plan, at.device)
    flags = surface_flags.inputs(plan, devices.sections[at.device]["pair"])
    return limited | changes | left_out_gaps(plan, at.device) | flags


def _settings(plan, at):
    """Device, its pair and the stated properties of its materials."""
    section = plan.config["devices"][at.device]
    values = {"materials": plan.materials.in_words(section["pair"])} | plan.config["design"]
    values |= ({"learns": True} if "test_beams" in section else {}) | _on_summits(plan, at.device)
    values |= section | {"water": plan.air_of_devices.water(section["pair"])} | own_section(plan, at.device)
    values |= {"worst_humidities": search_ends(plan.config["design"], section)}
    assumed = plan.assumptions(section["pair"]).get(section["pair"], []) + _unmeasured(plan, at.device)
    release = plan.devices.kind(at.device).release.name
    return ({"assumed": assumed} if assumed else {}) | {release: select(_OF_RELEASE[release], values)}


def _unmeasured(plan, device):
    """Stored limit of a device in wetter air than that of the isotherm, also along its chart or search."""
    section = plan.config["devices"][device]
    searched = search_ends(plan.config["design"], section) if plan.devices.kind(device).release.in_any_air else []
    airs = [*section["humidities"], *section.get("chart", {}).get("humidities", []), *searched]
    return plan.unmeasured_films(plan.air_of_devices.wet(section["pair"], airs))


def _on_summits(plan, device):
    """Humidities with water at which forces of a stopper, tip, bridge or dimples are those on summits alone."""
    section = plan.config["devices"][device]
    pair, air = section["pair"], plan.air_of_devices
    corrected = air.corrected(pair, section["humidities"])
    alone = [rh for rh in air.wet(pair, section["humidities"]) if rh not in corrected]
    return ({"on_summits": alone} if alone else {}) | ({"has_dimples": True} if "dimples" in section else {})


def _left_on_summits(subject, data):
    """Device or stopper with those humidities alone at which full contact has not changed all of its forces."""
    if "model_error" not in data or "nearest" not in data["model_error"]:
        return subject
    error = data["model_error"].sel(humidity=list(subject.on_summits))
    remaining = ~error[list(subject.changes_of_forces)].to_array().all("variable")
    unknown = remaining & xr.concat([_is_unknown(error, name) for name in subject.ratios_of_forces], "of").any("of")
    on_summits, unknown = (tuple(error.humidity.values[flags.values].tolist()) for flags in (remaining, unknown))
    return replace(subject, on_summits=on_summits, unknown=unknown)


def _is_unknown(error, ratio):
    """Whether a ratio of full contact to summits is missing, at some slope if it is one of tips (h,) bool."""
    if ratio not in error:
        return xr.full_like(error.humidity, True, bool)
    missing = error[ratio].isnull()
    return missing.any([name for name in missing.dims if name != "humidity"])


def _few_strips(data, *humidities, prefix=""):
    """Limit by the strips in full contact on which a change of energies, or of forces, at some humidities rests."""
    if "model_error" not in data or "nearest" not in data["model_error"]:
        return []
    errors = data["model_error"].reindex(humidity=list(humidities))
    residuals = errors[f"{prefix}largest_residual"].where(errors[f"{prefix}applied"] > 0)
    return rules.triggered(rules.few_strips(float(residuals.max())))


def _device_warnings(data, settings):
    """Limits of a device: of its lengths, its curves and its patch, each with a suffix to its name."""
    flags = surface_flags.together(data) + list(map(restored, settings.get("assumed", [])))
    changes = left_out_changes(data["left_out_gaps"]) if "left_out_gaps" in data else {}
    subject, charts = _left_on_summits(of_settings(settings), data), list(data["charts"].values())
    plastic = plastic_contact(data["plasticity"], subject.pair)
    few = {humidity: _few_strips(data, humidity) for _, humidity in data["lengths"]}
    lengths = [
        [
            [humidity, shape],
            limits
            + gap_warnings({key: changes[key] for key in changes if key[0] == humidity}, shape)
            + few[humidity] * (shape != EITHER)
            + flags,
        ]
        for (_, humidity), dataset in data["lengths"].items()
        for shape, limits in subject.limits(dataset, plastic, humidity).items()
    ]
    patches = [
        [[], limits + gap_warnings(changes, shape) + _few_strips(data, *subject.humidities, prefix="pull_off_") + flags]
        for dataset in data["stoppers"].values()
        for shape, limits in subject.limits(dataset, plastic).items()
    ]
    of_curves = chart_warnings(charts, subject, plastic) if charts else {}
    return lengths, [[curve, limits + flags] for curve, limits in of_curves.items()], patches


def _save(groups, paths):
    """Write limits as JSON."""
    stored = [[[key, [limit.stored() for limit in limits]] for key, limits in group] for group in groups]
    save_text(json.dumps(stored, ensure_ascii=False, indent=1, allow_nan=False), paths["json"])


def not_modelled(plan: Any, *devices: str) -> dict[str, Any]:
    """Effects missing in the results of some devices, for `stiction.report.limits.words`."""
    sections = (plan.config["devices"][name] for name in devices)
    cases = ((section["pair"], humidity) for section in sections for humidity in section["humidities"])
    return plan.air_of_devices.not_modelled(cases)


def files_of(*devices: str) -> dict[str, File]:
    """Files of the warnings about devices, for `read`."""
    return {name: File(f"results/devices/warnings/{name}.json") for name in devices}


STAGES = (
    Stage(
        name="device_warnings",
        files={"json": "devices/warnings/{device}.json"},
        inputs=_inputs,
        settings=_settings,
        compute=_device_warnings,
        save=_save,
        message="Limits of the model that device {device} exceeds.",
    ),
)
