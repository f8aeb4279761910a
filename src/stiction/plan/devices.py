"""Plan of the devices of a configuration: their cases, their strips of contact, the axes of their charts."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import NamedTuple

import numpy as np

from stiction.beam.cantilever import Beam
from stiction.config import test_beams
from stiction.config.cases import PairInAir, case_id
from stiction.config.kinds import BEAM, ROUGHNESSES, STOPPER, Kind, kind_of
from stiction.config.materials import Materials
from stiction.config.mission.adsorption import adsorbed_heights
from stiction.config.mission.conditions import temperatures
from stiction.config.reading import is_stated, paper
from stiction.config.scans import is_measured, preliminary_estimates, quantities
from stiction.config.surfaces.knowledge import Knowledge, assumed, knowledge, stated
from stiction.config.surfaces.members import is_itself, like, members
from stiction.config.units import NM_PER_UM, from_si, to_si
from stiction.contact.air import DRY_AIR, has_dry, humid
from stiction.contact.materials import OF_PAIRS, InputStep
from stiction.contact.meniscus import flooded_energy, meniscus_height
from stiction.contact.tilt import EDGE_RADIUS, Edge, length_of_edge
from stiction.devices.arcs import arc_length, slopes_of_tips, tip_slope
from stiction.models import MOMENT_QUANTITIES, SIDES, SPECTRUM_QUANTITIES
from stiction.plan.stage import subsection
from stiction.rounding import is_at_most

#: Steps of the distance for the contact of tips, in those of section contact. ASSUME: they suffice for the largest
#: attraction, the vertex of a parabola: with four, lengths of pair b are 0.02 to 0.19 % longer than with one.
OF_TIPS = 2
#: Gaps across which solids attract a tilted stopper at most [nm]. Retarded attraction has 0.05 % of its work at 5 nm.
FAR = 100.0
#: Tilts of a range at which a stopper is computed, its ends among them. ASSUME: patches between them hold little more.
#: Among 150 to 300 patches at 19 tilts from 0 to 20 rms a side, P(stuck) of the largest force of each is up to 0.01
#: (pair a), 0.02 (b) and 0.07 (c) above that at the nine of `tilts_of`, 0.05, 0.12 and 0.14 above that at even ones.
TILTS = 9
#: Number of cantilevers on a ground from which on their lengths follow those of a few sizes (`stiction.devices.sizes`).
MANY = 20
#: Points of a tip in full elastic contact, which then takes a few seconds: those of a width of 30 µm at 6.8 nm rms.
MOST_POINTS = 640_000
#: Quantities of a surface by numbers, in the order of budgets.
ALL_QUANTITIES = MOMENT_QUANTITIES + SPECTRUM_QUANTITIES


def ends_and_middle(values: Sequence[float]) -> list[float]:
    """Smallest, geometric middle and largest of some dimensions, or the only one.

    Examples
    --------
    >>> ends_and_middle([4.0, 1.0, 3.0]), ends_and_middle([2.0, 2.0])
    ([1.0, 2.0, 4.0], [2.0])
    """
    low, high = min(values), max(values)
    return [low] if is_at_most(high, low) else [low, round(float(np.sqrt(low * high)), 6), high]


def tilts_of(low: float, high: float, near: float) -> list[float]:
    """Tilts of a range, `TILTS` of them: half up to ``near`` above the lowest, the others ever farther apart.

    Near is the tilt at which the far side is higher by the rms of the heights. Up to there other summits touch first;
    beyond it, a stopper becomes a wedge.

    Examples
    --------
    >>> tilts_of(0.0, 8.0, 9.0), [round(tilt, 9) for tilt in tilts_of(0.0, 16.0, 1.0)]
    ([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0], [0.0, 0.25, 0.5, 0.75, 1.0, 2.0, 4.0, 8.0, 16.0])
    """
    if high - low <= near:
        return np.linspace(low, high, TILTS).tolist()
    half = TILTS // 2
    steps = np.append(np.linspace(0, near, half, endpoint=False), np.geomspace(near, high - low, half + 1))
    return (low + steps).tolist()


class Patch(NamedTuple):
    """Area of contact of the two surfaces of a pair, in whole nanometres as in the names of files."""

    pair: str
    length: int  #: along a beam [nm]
    width: int  #: [nm]

    @property
    def name(self) -> str:
        """Part of the names of files.

        Examples
        --------
        >>> Patch("b", 1500, 30000).name
        'b_1500x30000'
        """
        return f"{self.pair}_{self.length}x{self.width}"


def patch(pair: str, length_um: float, width_um: float) -> Patch:
    """Patch of a pair with sides in µm."""
    return Patch(pair, round(length_um * NM_PER_UM), round(width_um * NM_PER_UM))


@dataclass(frozen=True)
class DevicePlan:
    """Names of all results for the devices of one configuration."""

    config: dict  #: complete and valid

    @property
    def sections(self) -> dict[str, dict]:
        """Sections of all devices by name. Empty if the configuration has none."""
        return self.config.get("devices", {})

    @property
    def in_order(self) -> list[str]:
        """Names of all devices: those of a file in its order, then all others."""
        of_file = [name for name in self.config["design"].get("order", ()) if name in self.sections]
        return list(dict.fromkeys([*of_file, *self.sections]))

    def kind(self, device: str) -> Kind:
        """Kind of a device."""
        return kind_of(self.sections[device])

    def stated(self, device: str) -> dict:
        """Section of a device, with the restoring force of one without a length."""
        return self.kind(device).stated(self.sections[device])

    @cached_property
    def beams(self) -> list[str]:
        """Devices opening by a crack."""
        return self._released_as(BEAM)

    @cached_property
    def stoppers(self) -> list[str]:
        """Devices touching with their whole area."""
        return self._released_as(STOPPER)

    def _released_as(self, release):
        """Devices with one release."""
        return [name for name in self.sections if self.kind(name).release is release]

    def question(self, device: str) -> str:
        """Question about a device, a name of tables."""
        return self.kind(device).question(self.sections[device])

    @cached_property
    def with_life(self) -> list[str]:
        """Devices that stick and are freed: without a spring, they are asked for their pull-off force alone."""
        return [name for name in self.sections if self.question(name) == self.kind(name).release.name]

    @cached_property
    def with_tips(self) -> list[str]:
        """Devices with a free end able to stick."""
        return [name for name in self.sections if self.kind(name).has_tip]

    @cached_property
    def cases(self) -> list[str]:
        """Cases of every beam at each of its humidities."""
        return [case_id(name, humidity) for name in self.beams for humidity in self.sections[name]["humidities"]]

    @cached_property
    def with_chart(self) -> list[str]:
        """Devices with a chart."""
        return [name for name in self.beams if "chart" in self.sections[name]]

    def chart_cases(self, device: str) -> list[str]:
        """Cases of a device at each humidity along the axis of its chart, and in dry air if listed."""
        dry = [DRY_AIR.humidity] * has_dry(self.sections[device]["humidities"])
        return [case_id(device, humidity) for humidity in [*dry, *self.axis(device)]]

    def axis(self, device: str) -> list[float]:
        """Humidities along the axis of the chart of a device, with at most four decimals, and its own between them."""
        low, high = ends = self.sections[device]["chart"]["humidities"]
        axis = np.linspace(*ends, self.config["design"]["chart_points"])
        humidities = {humidity for humidity in self.sections[device]["humidities"] if low < humidity < high}
        return sorted({round(float(humidity), 4) for humidity in axis} | humidities)

    @property
    def pressed_pairs(self) -> list[str]:
        """Pairs of beams in the study of plasticity."""
        return self.pairs_of_plasticity(*self.beams)

    def pairs_of_plasticity(self, *devices: str) -> list[str]:
        """Pairs of some devices in the study of plasticity."""
        pairs = dict.fromkeys(self.sections[name]["pair"] for name in devices)
        return [pair for pair in pairs if pair in self.config["studies"]["plasticity"]["distance_nm"]]

    def strip(self, device: str) -> float:
        """Length of the strips along a device [µm]."""
        return self.kind(device).strip(self.sections[device], self.config["sampling"]["strip_length_um"])

    def ground(self, device: str) -> Patch:
        """Patch of contact of a device: strips along a beam, or the whole area of a stopper."""
        section = self.sections[device]
        return patch(section["pair"], *self.kind(device).sides(section, self.config["sampling"]["strip_length_um"]))

    @cached_property
    def cantilevers_on(self) -> dict[tuple[Patch, float], list[str]]:
        """Cantilevers on every patch of contact at a humidity."""
        by_ground = {}
        for name in self.with_tips:
            for humidity in self.sections[name]["humidities"]:
                by_ground.setdefault((self.ground(name), humidity), []).append(name)
        return by_ground

    def sizes(self, device: str, humidity: float) -> dict[str, list[float]]:
        """Thicknesses and gaps from which the lengths of a device follow, empty if it is simulated by itself."""
        return self._sizes_on.get((self.ground(device), humidity), {}) if self.kind(device).has_tip else {}

    @cached_property
    def _sizes_on(self):
        """Sizes on every patch of contact with `MANY` cantilevers at a humidity."""
        axes = {"thicknesses_um": "thickness_um", "gaps_um": "gap_um"}
        return {
            ground: {axis: ends_and_middle([self.sections[name][key] for name in users]) for axis, key in axes.items()}
            for ground, users in self.cantilevers_on.items()
            if len(users) >= MANY
        }

    def capacitor(self, device: str) -> dict:
        """Voltage of a device and its dielectric, empty without a voltage."""
        return subsection(self.sections[device], ("voltage_V", "offset_V", "dielectric"))

    @property
    def has_open_numbers(self) -> bool:
        """Whether a pilot has to decide numbers of samples, and of beams for an accuracy, see `stiction.accuracy`."""
        design = self.config["design"]
        if "samples_of_patches" in design:
            return False
        return "accuracy" in design or bool(self.beams) and not is_stated(self.config, "contact", "samples")

    @property
    def _samples_of_patches(self):
        """Numbers of samples for the errors of lengths, by the name of the patch, see `stiction.accuracy`.

        Raises
        ------
        ValueError
            If an accuracy has not decided them yet.
        """
        design = self.config["design"]
        if "accuracy" in design and "samples_of_patches" not in design:
            raise ValueError("design.accuracy has decided no numbers: use stiction.accuracy.decided(config)")
        return design.get("samples_of_patches", {})

    def samples(self, ground: Patch) -> int:
        """Number of samples of a patch, in any air."""
        name = ground._replace(pair=PairInAir(ground.pair).pair).name
        return self._samples_of_patches.get(name, self.config["contact"]["samples"])

    def has_strips_of_pair(self, device: str) -> bool:
        """Whether a device sticks on the strips of its pair in the main line, and so shares their contact.

        Devices whose samples follow from the errors of their lengths have their own.
        """
        if self.ground(device).name in self._samples_of_patches:
            return False
        main = self.config["sampling"]["strip_length_um"], self.config["beam"]["width_um"]
        return not self.kind(device).shape and self.ground(device) == patch(self.sections[device]["pair"], *main)

    def probe(self, area: Patch) -> dict:
        """Setting ``probe`` of the contact of a patch, empty under what is flat."""
        area = area._replace(pair=PairInAir(area.pair).pair)
        shapes = (self.kind(name).shape_of(self.sections[name]) for name in self.stoppers if self.ground(name) == area)
        return {"probe": shape} if (shape := next(filter(None, shapes), None)) else {}

    # Tilted stoppers

    def slopes(self, device: str) -> list[float]:
        """Slopes of a stopper at its tilt or at `TILTS` tilts of its range, increasing [-], none without a tilt."""
        section = self.sections[device]
        tilts = section.get("tilt_deg", ())
        if len(tilts) == 2:
            rms = self._rms_of_both(section["pair"])
            tilts = tilts_of(*tilts, math.degrees(math.atan(rms / (NM_PER_UM * section["contact_um"][0]))))
        return [math.tan(to_si(tilt, "deg")) for tilt in tilts]

    def inclination(self, area: Patch) -> dict:
        """Slopes and reach of the contact of tilted stoppers with this area.

        The reach covers film, heights of six times the rms of both surfaces, and the gaps to the far side of the
        stopper. ASSUME: no attraction across gaps beyond `FAR`.
        """
        area = area._replace(pair=PairInAir(area.pair).pair)
        users = [name for name in self.stoppers if self.ground(name) == area]
        slopes = sorted({slope for name in users for slope in self.slopes(name) if slope})
        reach = (
            max(map(self._reach, users)) + 3 * self._roughest_of_both(area.pair) + min(slopes[-1] * area.length, FAR)
        )
        return {"slopes": slopes, "reach_nm": reach}

    # Tips of cantilevers

    def tips(self, device: str) -> Patch:
        """Tilted strips at the tips of the beams of a device: the edge, and the wedge with the smallest slope."""
        section, point = self.sections[device], self._point
        reach, slopes = self._reach(device), self._slopes(device)
        before = length_of_edge(self._edge_radius * NM_PER_UM, reach, slopes[-1])
        points = math.ceil(reach / slopes[0] / point) + round(before / point)
        return patch(section["pair"], points * point / NM_PER_UM, section["width_um"])

    def tilt(self, tips: Patch) -> dict:
        """Slopes, reach and edge of the strips at the tips of devices and of counted test beams.

        Raises
        ------
        KeyError
            If no tip has these strips.
        """
        tips = tips._replace(pair=PairInAir(tips.pair).pair)
        users = self._by_tips.get(tips, [])
        if not users:
            raise KeyError(f"no device has tips on strips {tips.name}")
        return self._tilt(users, sorted({float(slope) for plan, name in users for slope in plan._slopes(name)}))

    @cached_property
    def _by_tips(self):
        """Devices and counted test beams, each with its plan, by the strips of their tips."""
        users = {}
        for plan, name in self._with_tips:
            users.setdefault(plan.tips(name), []).append((plan, name))
        return users

    def all_tips(self, pair: str) -> dict:
        """Settings of strips for all tips on a pair: the least width, and the slopes at both ends and in the middle.

        ASSUME: strips of more than `MOST_POINTS` may be narrower, down to 2 µm.

        Raises
        ------
        KeyError
            If no tip is on the pair.
        """
        users = [(plan, name) for plan, name in self._with_tips if plan.sections[name]["pair"] == pair]
        if not users:
            raise KeyError(f"no device has tips on pair {pair}")
        ends = {float(plan._slopes(name)[k]) for plan, name in users for k in (0, -1)}
        slopes = [min(ends), round(math.sqrt(min(ends) * max(ends)), 6), max(ends)]
        tilt, width = self._tilt(users, slopes), min(plan.sections[name]["width_um"] for plan, name in users)
        points = MOST_POINTS * self._point / (tilt["reach_nm"] / slopes[0])  # across the longest strip
        affordable = max(2.0, points * self._point / NM_PER_UM)
        return {"beam": {"width_um": min(width, round(affordable, 3))}, "tilt": tilt}

    def has_tips(self, pair: str) -> bool:
        """Whether any tip is on a pair."""
        return any(plan.sections[name]["pair"] == pair for plan, name in self._with_tips)

    def airs_of_tips(self, pair: str) -> list[float]:
        """Humidities, with water, of devices and counted test beams with tips on a pair, increasing."""
        sections = [plan.sections[name] for plan, name in self._with_tips]
        return humid(sorted({rh for section in sections if section["pair"] == pair for rh in section["humidities"]}))

    def airs_of_forces(self, pair: str) -> list[float]:
        """Humidities, with water, of stoppers, bridges and dimples on a pair, and the wettest of charts and searches.

        ASSUME: changes between these are interpolated, and in drier air are those in the driest, the safe side: ratios
        of full contact to summits grow with the humidity.
        """
        airs = set()
        for name, section in self.sections.items():
            is_flat = not self.kind(name).has_tip or "dimples" in section
            if section["pair"] == pair and is_flat:
                of_chart = section.get("chart", {}).get("humidities", [])
                further = self._searched if self.kind(name).release.in_any_air else of_chart
                airs |= {*section["humidities"], max(further, default=0)}
        return humid(sorted(airs))

    @property
    def _searched(self):
        """Ends of the search of the worst humidity of stoppers, if they are stated."""
        return self.config["design"].get("worst_humidities", [])

    @cached_property
    def _with_tips(self):
        """Plan and name of each device and of each counted test beam with a tip."""
        counted = DevicePlan(self.config | {"devices": test_beams.counts_as_devices(self.config)})
        return [(plan, name) for plan in (self, counted) for name in plan.with_tips]

    def _tilt(self, users, slopes):
        """Slopes of strips, and reach and edge of the tips of some devices."""
        reach = max(plan._reach(name) for plan, name in users)
        edge = {"edge": self.config["design"]["tip_edge"], "radius_um": self._edge_radius}
        return {"slopes": slopes, "reach_nm": reach} | edge

    @property
    def _point(self):
        """Spacing of the grid of the contact [nm]."""
        return self.config["sampling"]["spacing_nm"] * self.config["contact"]["every"]

    @property
    def _edge_radius(self):
        """Radius of the edges of tips [µm], 0 for square ones."""
        design = self.config["design"]
        return design["edge_radius_um"] if design["tip_edge"] == Edge.ROUNDED else 0.0

    def edge_radius(self, device: str) -> float:
        """Radius of the edge of the tip of a device [µm], 0 without one or for a square one."""
        return self._edge_radius if device in self.with_tips else 0.0

    @property
    def edge_in_words(self) -> str:
        """Edge of the tips for a reader."""
        if radius := self._edge_radius:
            return f"rounded, radius {radius:g} µm; rounder ones hold shorter beams"
        return "square" if self.config["design"]["tip_edge"] == Edge.SQUARE else "sharp"

    def _slopes(self, device):
        """Slopes of the tips of a device and of the beams of its chart."""
        section = self.sections[device]
        chart = section.get("chart", {})
        sizes = product(
            [section["thickness_um"], *chart.get("thicknesses_um", [])], [section["gap_um"], *chart.get("gaps_um", [])]
        )
        return slopes_of_tips(*(self._saturated_slope(section, *size) for size in sizes))

    def _saturated_slope(self, device, thickness, gap):
        """Slope of the tip of a beam [µm] at its shortest length of adhesion in saturated, perfectly wetting air."""
        modulus = Materials(self.config).modulus(device["pair"])
        sizes = to_si(device["width_um"], "um"), to_si(thickness, "um")
        beam = Beam(1.0, *sizes, to_si(modulus["young_modulus_GPa"], "GPa"), to_si(gap, "um"), 1)
        return tip_slope(arc_length(flooded_energy(min(self._temperatures(device).values())), beam), beam.gap)

    def _reach(self, device):
        """Depth of a wet tip below the mean plane of its edge: film in the wettest air and peaks [nm].

        A power of two to the 1/4, so that small changes of the air and of the surfaces leave the strips as they are.
        ASSUME: peaks of three times the rms of both surfaces.
        """
        section = self.sections[device]
        at = self._temperatures(section)
        wet, water = humid(at), self.config["water"]
        grown = adsorbed_heights(water, wet)
        films = [
            from_si(float(meniscus_height(air, at[air])) + more, "nm") for air, more in zip(wet, grown, strict=True)
        ]
        adsorbed = water.get("adsorbed_nm", 0) if films else 0
        least = max(films, default=0.0) + adsorbed + 3 * self._roughest_of_both(section["pair"])
        return round(2 ** (math.ceil(4 * math.log2(least)) / 4), 3)

    def _temperatures(self, section):
        """Temperatures of the water of a device by humidity, those of its chart and dry air among them [K]."""
        humidities = section["humidities"] + section.get("chart", {}).get("humidities", [])
        by_humidity = self._in_conditions.get(section["pair"], {})
        return {air: by_humidity.get(air, self.config["water"]["temperature_K"]) for air in humidities}

    @cached_property
    def _in_conditions(self):
        """Temperatures of the water in conditions of devices, by pair and humidity [K]."""
        pairs = {device["pair"] for device in self.config.get("devices", {}).values()}
        return {pair: temperatures(self.config, pair) for pair in pairs}

    def _rms_of_both(self, pair):
        """Standard deviation of the sum of the heights of both surfaces of a pair [nm]."""
        return math.hypot(*(self.rms(self.config["pairs"][pair][side]) for side in SIDES))

    def _roughest_of_both(self, pair):
        """As `_rms_of_both`, of the roughest members [nm]."""
        names = [self.config["pairs"][pair][side] for side in SIDES]
        rms_of_members = [[member.get("rms", 0.0) for member in self.members_of(name).values()] for name in names]
        return math.hypot(*(max(self.rms(name), *rms, 0.0) for name, rms in zip(names, rms_of_members, strict=True)))

    def rms(self, surface: str) -> float:
        """Standard deviation of the heights of a surface, preliminary if it is described by scans [nm]."""
        entry = self.config["surfaces"][surface]
        return (self._preliminary[surface] if is_measured(entry) else entry)["rms_nm"]

    @cached_property
    def _preliminary(self):
        """Preliminary numbers of the measured surfaces."""
        return preliminary_estimates(self.config)[0]

    # Budgets

    @cached_property
    def with_test_beams(self) -> list[str]:
        """Devices with test beams."""
        return [name for name, device in self.sections.items() if "test_beams" in device]

    @cached_property
    def over_roughness(self) -> list[str]:
        """Devices computed along the roughness of a surface."""
        return [name for name, device in self.sections.items() if "roughness" in device]

    @cached_property
    def over_two_quantities(self) -> list[str]:
        """Devices of `over_roughness` computed along two quantities."""
        return [name for name in self.over_roughness if len(ROUGHNESSES.keys() & self.sections[name]["roughness"]) > 1]

    @cached_property
    def over_process(self) -> list[str]:
        """Devices computed over the variable of a process."""
        return [name for name in self._over_processes if name not in self.processed_twice]

    @cached_property
    def processed_twice(self) -> list[str]:
        """Devices computed over the variables of two processes."""
        return [name for name in self._over_processes if "second_process" in self.sections[name]]

    @property
    def _over_processes(self):
        """Devices with a process."""
        return [name for name, device in self.sections.items() if "process" in device]

    @cached_property
    def with_budget(self) -> list[str]:
        """Devices with an uncertain input: with a stated uncertainty, or on a surface described by scans."""
        is_uncertain = {name: any(device.get("uncertainty", {}).values()) for name, device in self.sections.items()}
        return [name for name in self.sections if is_uncertain[name] or self.quantities(name) or self.members(name)]

    def uncertain_properties(self, device: str) -> list[str]:
        """Uncertain properties of the contact of a device, keys of ``OF_PAIRS``."""
        uncertainty = self.sections[device].get("uncertainty", {})
        return [name for name, entry in OF_PAIRS.items() if uncertainty.get(entry.key)]

    def step(self, pair: str, name: str) -> InputStep:
        """Step of a property of the contact of a pair, a key of ``OF_PAIRS``. Devices and test beams on it share it."""
        users = (*self.sections.values(), *test_beams.as_cantilevers(self.config).values())
        uncertainties = [user.get("uncertainty", {}) for user in users if user["pair"] == PairInAir(pair).pair]
        deviations = [uncertainty.get(OF_PAIRS[name].key, 0.0) for uncertainty in uncertainties]
        return OF_PAIRS[name].step.by(max(deviations, default=0.0))

    def has_uncertain_edge(self, device: str) -> bool:
        """Whether the tip of a device has a rounded edge with an uncertain radius."""
        return bool(self.edge_radius(device) and self.sections[device].get("uncertainty", {}).get(EDGE_RADIUS.key))

    def budgets(self, *devices: str) -> list[str]:
        """Budgets of devices, of all with an uncertain input by default: at each humidity, and those of tips."""
        names = []
        for name in devices or self.with_budget:
            suffixes = ("", "_tip") if self.kind(name).has_tip else ("",)
            cases = [case_id(name, humidity) for humidity in self.sections[name]["humidities"]]
            names += [case + suffix for suffix in suffixes for case in cases]
        return names

    def members(self, device: str) -> dict[str, dict[str, dict[str, float]]]:
        """Members in place of each partly assumed surface of a device, by surface, as of `members`.

        None with test beams.

        ASSUME: test beams correct the quantities of surfaces, about which whole surfaces say too little: devices with
        test beams, these, and their probes have slopes of assumed quantities, too.
        """
        if self.sections[device].get("test_beams") or device in self._pulled:
            return {}
        by_surface = {name: self.members_of(name) for name in self._surfaces(device)}
        return {name: typical for name, typical in by_surface.items() if typical}

    @cached_property
    def _pulled(self):
        """Probes with pull-off forces among the test beams."""
        return {array["probe"] for array in self.config.get("test_beams", {}).values() if "probe" in array}

    def members_of(self, surface: str) -> dict[str, dict[str, float]]:
        """Members in place of a surface, none if all of it is known."""
        return self._members[surface]

    @cached_property
    def _members(self):
        """Members in place of every surface."""
        library, end = paper()["surfaces"], self.nyquist
        return {name: members(entry, library, end) for name, entry in self.config["surfaces"].items()}

    def is_itself(self, surface: str, member: str) -> bool:
        """Whether a member of a surface is the surface as stated."""
        return is_itself(self.config["surfaces"][surface], self.members_of(surface)[member])

    @property
    def nyquist(self) -> float:
        """Largest wave number of the grid [rad/µm]."""
        return math.pi * NM_PER_UM / self.config["sampling"]["spacing_nm"]

    def quantities(self, device: str) -> list[tuple[str, str]]:
        """Surfaces of a device and their uncertain quantities: from scans, or stated to be uncertain.

        The heights of surfaces without scans are, too, if the size of one scan is stated. Those that are assumed are,
        unless there are `members`.

        ASSUME: without scans, a spectrum counts as exact unless its uncertainty is stated; the error of one scan's
        spectrum changes a length by 0.2 %.
        """
        of_heights = set(MOMENT_QUANTITIES if self.sections[device].get("uncertainty", {}).get("scan_um") else ())
        errors = self.surface_errors(device)
        by_surface = {
            name: quantities(entry)
            if is_measured(entry)
            else [quantity for quantity in ALL_QUANTITIES if quantity in of_heights.union(errors[name].quantities)]
            for name, entry in self._surfaces(device).items()
        }
        return [(name, quantity) for name, of_surface in by_surface.items() for quantity in of_surface]

    def surface_errors(self, device: str) -> dict[str, Knowledge]:
        """Errors of the quantities of each surface of a device without scans: stated ones, and of assumed quantities.

        The latter have none where `members` are in their place.
        """
        library, by_members = paper()["surfaces"], self.members(device)
        return {
            name: stated(entry) if name in by_members else knowledge(entry, library)
            for name, entry in self._surfaces(device).items()
            if not is_measured(entry)
        }

    def assumed_inputs(self, device: str) -> list[str]:
        """Inputs of the budget of a device assumed without measurement, such as ``B2 like Sub1``."""
        by_members = self.members(device)
        return [
            *(like(name, other) for name, typical in by_members.items() for other in typical),
            *(
                f"{word} of {name}"
                for name, entry in self._surfaces(device).items()
                if name not in by_members
                for word in assumed(entry)
            ),
        ]

    def _surfaces(self, device):
        """Sections of the surfaces of a device by name, each once."""
        pair = self.config["pairs"][self.sections[device]["pair"]]
        return {pair[side]: self.config["surfaces"][pair[side]] for side in SIDES}
