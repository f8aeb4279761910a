"""Plan of the devices of a configuration: their cases, the strips on which they stick, the axes of their charts."""

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import NamedTuple

import numpy as np

from stiction.beam.cantilever import Beam
from stiction.config import arrays
from stiction.config.cases import case_id, in_any_air
from stiction.config.kinds import Kind, kind_of
from stiction.config.measured import is_measured, preliminary_estimates, quantities
from stiction.config.units import NM_PER_UM, from_si, to_si
from stiction.constants import HAMAKER_CONSTANT
from stiction.contact.meniscus import flooded_energy, meniscus_height
from stiction.devices.arcs import arc_length, slopes_of_tips, tip_slope
from stiction.devices.materials import OF_CONTACT
from stiction.models import MOMENT_QUANTITIES, SIDES

#: Steps of the distance for the contact of tips, in those of section contact. ASSUME: they suffice for the largest
#: attraction, the vertex of a parabola: with four, lengths of pair b are 0.02 to 0.19 % longer than with one.
OF_TIPS = 2


def hamaker_constants(material: dict) -> dict[str, float]:
    """Hamaker constant of two bodies of a material by medium [zJ]: as stated, or that of polysilicon."""
    polysilicon = {medium: from_si(constant, "zJ") for medium, constant in HAMAKER_CONSTANT.items()}
    return material.get("hamaker_constant_zJ", polysilicon)


def hamaker_constant(material: dict, medium: str) -> float:
    """That through a medium [zJ]; without van der Waals forces, where none acts, that through dry air.

    Examples
    --------
    >>> hamaker_constant({}, "water"), hamaker_constant({"hamaker_constant_zJ": {"water": 5, "dry": 65}}, "none")
    (97.5, 65)
    """
    constants = hamaker_constants(material)
    return constants.get(medium, constants["dry"])


class Patch(NamedTuple):
    """Area in which the two surfaces of a pair meet, in whole nanometres as in the names of files."""

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

    @property
    def in_any_air(self) -> "Patch":
        """The patch by the name of its pair alone, see `stiction.config.cases.in_dry_air`."""
        return self._replace(pair=in_any_air(self.pair))


def patch(pair: str, length_um: float, width_um: float) -> Patch:
    """Patch of a pair with sides in µm."""
    return Patch(pair, round(length_um * NM_PER_UM), round(width_um * NM_PER_UM))


@dataclass(frozen=True)
class Designs:
    """Names of everything that is computed for the devices of one configuration."""

    config: dict  #: complete and valid

    @property
    def devices(self) -> dict[str, dict]:
        """Sections of all devices by name; empty if the configuration has none."""
        return self.config.get("devices", {})

    def kind(self, device: str) -> Kind:
        """Kind of a device."""
        return kind_of(self.devices[device])

    @property
    def beams(self) -> list[str]:
        """Devices that crack open."""
        return [name for name in self.devices if self.kind(name).is_beam]

    @property
    def stoppers(self) -> list[str]:
        """Devices that touch with their whole area."""
        return [name for name in self.devices if not self.kind(name).is_beam]

    @property
    def with_tips(self) -> list[str]:
        """Devices that a free end may hold."""
        return [name for name in self.devices if self.kind(name).has_tip]

    @property
    def cases(self) -> list[str]:
        """Every beam at each of its humidities."""
        return [case_id(name, humidity) for name in self.beams for humidity in self.devices[name]["humidities"]]

    @property
    def charted(self) -> list[str]:
        """Devices with a chart."""
        return [name for name in self.beams if "chart" in self.devices[name]]

    def chart_cases(self, device: str) -> list[str]:
        """A device at each humidity along the axis of its chart, and in dry air, beside the axis, if it states that."""
        dry = [humidity for humidity in self.devices[device]["humidities"] if humidity == 0]
        return [case_id(device, humidity) for humidity in [*dry, *self.axis(device)]]

    def axis(self, device: str) -> list[float]:
        """Humidities along the axis of the chart of a device, with at most four decimals."""
        ends = self.devices[device]["chart"]["humidities"]
        axis = np.linspace(*ends, self.config["design"]["chart_points"])
        return sorted({round(float(humidity), 4) for humidity in axis})

    @property
    def pressed_pairs(self) -> list[str]:
        """Pairs of beams whose plasticity is studied."""
        return self.pressed(*self.beams)

    def pressed(self, *devices: str) -> list[str]:
        """Pairs of some devices whose plasticity is studied."""
        pairs = dict.fromkeys(self.devices[name]["pair"] for name in devices)
        return [pair for pair in pairs if pair in self.config["studies"]["plasticity"]["distance_nm"]]

    def strip(self, device: str) -> float:
        """Length of the strips along a device [µm]."""
        return self.kind(device).strip(self.devices[device], self.config["sampling"]["strip_length_um"])

    def ground(self, device: str) -> Patch:
        """Patch on which a device sticks: strips along a beam, or the whole area of a stopper."""
        section = self.devices[device]
        return patch(section["pair"], *self.kind(device).sides(section, self.config["sampling"]["strip_length_um"]))

    def has_strips_of_pair(self, device: str) -> bool:
        """Whether a device sticks on the strips of its pair in the main line, whose contact it then shares."""
        main = self.config["sampling"]["strip_length_um"], self.config["beam"]["width_um"]
        return self.ground(device) == patch(self.devices[device]["pair"], *main)

    # Tips of cantilevers

    def tips(self, device: str) -> Patch:
        """Tilted strips that hold the tips of the beams of a device: as long as the wedge with the smallest slope."""
        section, point = self.devices[device], self.config["sampling"]["spacing_nm"] * self.config["contact"]["every"]
        points = math.ceil(self._reach(device) / self._slopes(device)[0] / point)
        return patch(section["pair"], points * point / NM_PER_UM, section["width_um"])

    def tilt(self, tips: Patch) -> dict:
        """Slopes, reach and edge of the strips that hold the tips of devices and of counted test beams.

        Raises
        ------
        KeyError
            If no tip has these strips.
        """
        counted = Designs(self.config | {"devices": arrays.counted(self.config)})
        users = [(one, name) for one in (self, counted) for name in one.with_tips if one.tips(name) == tips.in_any_air]
        if not users:
            raise KeyError(f"no device has tips on strips {tips.name}")
        slopes = {float(slope) for one, name in users for slope in one._slopes(name)}
        reach = max(one._reach(name) for one, name in users)
        return {"slopes": sorted(slopes), "reach_nm": reach, "edge": self.config["design"]["tip_edge"]}

    def _slopes(self, device):
        """Slopes of the tips of a device and of the beams of its chart."""
        section = self.devices[device]
        chart = section.get("chart", {})
        sizes = product(
            [section["thickness_um"], *chart.get("thicknesses_um", [])], [section["gap_um"], *chart.get("gaps_um", [])]
        )
        return slopes_of_tips(*(self._saturated_slope(section, *size) for size in sizes))

    def _saturated_slope(self, device, thickness, gap):
        """Slope of the tip of a beam [µm] at the length that it holds in saturated air, perfectly wetting."""
        solid = self.config["solid"] | self._material(self.config["pairs"][device["pair"]]["beam"])
        sizes = to_si(device["width_um"], "um"), to_si(thickness, "um")
        beam = Beam(1.0, *sizes, to_si(solid["young_modulus_GPa"], "GPa"), to_si(gap, "um"), 1)
        return tip_slope(arc_length(flooded_energy(self.config["water"]["temperature_K"]), beam), beam.gap)

    def _material(self, surface):
        """Stated properties of the material of a surface."""
        return self.config.get("materials", {}).get(self.config["surfaces"][surface].get("material"), {})

    def _reach(self, device):
        """How far below the mean plane of its edge a tip can be wet: film in the wettest air and peaks [nm].

        A power of two to the 1/4, so that small changes of the air and of the surfaces leave the strips as they are.
        ASSUME: peaks of three times the rms of both surfaces.
        """
        section = self.devices[device]
        wettest = max(section["humidities"] + section.get("chart", {}).get("humidities", []))
        rms = [self._rms(self.config["pairs"][section["pair"]][side]) for side in SIDES]
        film = float(meniscus_height(wettest, self.config["water"]["temperature_K"])) if wettest else 0.0
        least = from_si(film, "nm") + 3 * math.hypot(*rms)
        return round(2 ** (math.ceil(4 * math.log2(least)) / 4), 3)

    def _rms(self, surface):
        """Standard deviation of the heights of a surface, preliminary if it is described by scans [nm]."""
        entry = self.config["surfaces"][surface]
        return (self._preliminary[surface] if is_measured(entry) else entry)["rms_nm"]

    @cached_property
    def _preliminary(self):
        """Preliminary numbers of the measured surfaces."""
        return preliminary_estimates(self.config)[0]

    # Budgets

    @property
    def tested(self) -> list[str]:
        """Devices with test beams."""
        return [name for name, device in self.devices.items() if "test_beams" in device]

    @property
    def roughened(self) -> list[str]:
        """Devices that are computed over the roughness of a surface."""
        return [name for name, device in self.devices.items() if "roughness" in device]

    @property
    def budgeted(self) -> list[str]:
        """Devices with an uncertain input: with a stated uncertainty, or on a surface described by scans."""
        stated = {name: any(device.get("uncertainty", {}).values()) for name, device in self.devices.items()}
        return [name for name in self.devices if stated[name] or self.quantities(name)]

    def uncertain_solids(self, device: str) -> list[str]:
        """Properties of the material of a device that are uncertain, keys of ``OF_CONTACT``."""
        stated = self.devices[device].get("uncertainty", {})
        return [name for name, one in OF_CONTACT.items() if stated.get(one.key)]

    def budgets(self, *devices: str) -> list[str]:
        """Budgets of devices, of all with an uncertain input by default: at each humidity, and those of tips."""
        found = []
        for name in devices or self.budgeted:
            parts = ("", "_tip") if self.kind(name).has_tip else ("",)
            found += [case_id(name, humidity) + part for part in parts for humidity in self.devices[name]["humidities"]]
        return found

    def quantities(self, device: str) -> list[tuple[str, str]]:
        """Surfaces of a device and their uncertain quantities: of all scans, or of the heights alone if one is stated.

        ASSUME: without scans, the spectrum counts as exact; the error of one scan's spectrum changes a length by 0.2 %.
        """
        pair = self.config["pairs"][self.devices[device]["pair"]]
        stated = MOMENT_QUANTITIES if self.devices[device].get("uncertainty", {}).get("scan_um") else ()
        surfaces = dict.fromkeys(pair[side] for side in SIDES)
        entries = {name: self.config["surfaces"][name] for name in surfaces}
        found = {name: quantities(entry) if is_measured(entry) else stated for name, entry in entries.items()}
        return [(name, quantity) for name, of_surface in found.items() for quantity in of_surface]
