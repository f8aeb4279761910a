"""Bridges of the design: lengths that their middle holds, on summits and changed by full contact as a run does it.

As `stiction.estimate.learning.training`, whose surfaces and air they have, and after
`stiction.estimate.learning.patches`, which have the change of largest attractions.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from stiction.analysis import levels
from stiction.chaos.model import Truncation
from stiction.config.cases import Case, case_id
from stiction.config.files import load
from stiction.config.units import in_si, to_si
from stiction.contact.correction import Correction, ElasticChange
from stiction.contact.environment import Water
from stiction.contact.full.effort import TooLong
from stiction.errors import NotConverged
from stiction.estimate.learning import patches
from stiction.estimate.learning.design import RANGES as OF_ALL
from stiction.estimate.learning.design import Point, SurfaceLaw, states
from stiction.estimate.learning.files import numbers_of
from stiction.estimate.learning.training import HUMIDITIES, PAIR, SETS, air_of, surfaces_of, water_of
from stiction.plan.plan import Plan
from stiction.plan.stage import At
from stiction.stages.contact import contact, full_energy
from stiction.stages.contact.changes.patches import GROUND
from stiction.stages.contact.contact import with_correlations
from stiction.stages.contact.pairs import Settings
from stiction.stages.devices import opening, sticking
from stiction.stages.devices.contact_names import patch_of
from stiction.stages.devices.opening import DesignedBeam, section_of_beam
from stiction.streams import stream

#: Folder of the bridges beside the sets of the tips.
FOLDER = "bridges"
#: Name of the device.
_DEVICE = "R"
#: Ranges of the bridges and their units. Logarithms of thickness and gap are even, and stresses.
RANGES = {"thickness": (0.7, 6.0, "um"), "gap": (0.3, 6.0, "um"), "stress": (0.0, 200.0, "MPa")}
RANGES |= {"width": (*OF_ALL["ln_width"], "um")}
#: Bridge on surfaces of the paper, in these units.
_OF_PAPER = (2.0, 2.0, 50.0)
#: Strips of a point, from which its force laws are learnt as in a run.
STRIPS = 600
#: One of so many points of a set has bridges, all of those that decide.
EVERY = {"learn_any": 2, "learn_typical": 2, "check_typical": 2, "check_any": 2}
#: Width of strips in full contact [m], and relative error of the ratio of energies for which strips are drawn.
_WIDTH, _ERROR = to_si(6, "um"), 0.08


def base(airs: Sequence[float | str] = HUMIDITIES) -> dict[str, Any]:
    """Configuration of the points in some airs: all that bridges have by default."""
    device = {"kind": "bridge", "pair": PAIR} | dict(zip(_SIZES, _OF_PAPER, strict=True)) | {"width_um": 30}
    pair = {"beam": "S", "substrate": "T", "gap_um": 2, "humidities": [*airs]}
    return load(
        {
            "run": {"pairs": [], "studies": []},
            "surfaces": {"S": {"rms_nm": 3, "like": "B2"}, "T": {"rms_nm": 0.2, "like": "Sub1"}},
            "pairs": {PAIR: pair},
            "devices": {_DEVICE: device | {"humidities": [*airs]}},
        }
    )


#: Keys of what differs between the bridges of a point.
_SIZES = ("thickness_um", "gap_um", "residual_stress_MPa")


def sizes_of(point: Point, name: str) -> np.ndarray:
    """Thickness [m], gap [m] and stress [Pa] of the bridge in each air of a point of a set (airs, 3)."""
    effort = SETS[name]
    if effort.law is SurfaceLaw.PAPER:
        drawn = np.tile(_OF_PAPER, (effort.states, 1))
    else:
        rng = stream(effort.seed, "estimate", "bridges", point.number)
        low, high = zip(*(RANGES[name][:2] for name in ("thickness", "gap", "stress")), strict=True)
        low, high = ([math.log(thickness), math.log(gap), stress] for thickness, gap, stress in (low, high))
        drawn = rng.uniform(low, high, (effort.states, 3))
        drawn[:, :2] = np.exp(drawn[:, :2])
    units = [to_si(1.0, unit) for unit in ("um", "um", "MPa")]
    return np.round(drawn, 3) * units


def plan_of(point: Point, valid: dict[str, Any]) -> Plan:
    """Plan of a point, from a valid configuration with one pair and one device."""
    surfaces = valid["surfaces"] | dict(zip("ST", point.sides, strict=True))
    device = valid["devices"][_DEVICE] | {"width_um": point.width}
    return Plan(valid | {"surfaces": surfaces, "devices": {_DEVICE: device}})


@dataclass(frozen=True)
class TrainingStrips:
    """Strips of ground below the bridges of a point."""

    contact: xr.Dataset
    water: Water
    device: DesignedBeam
    chaos: Truncation
    seed: int
    number: int  #: of the point

    @classmethod
    def of(cls, point: Point, plan: Plan, strips: int, seed: int, air: float = HUMIDITIES[0]) -> "TrainingStrips":
        """Draw a number of strips, of a device that meets an air."""
        device = in_si(DesignedBeam, section_of_beam(plan, _DEVICE))
        patch = patch_of(plan, Case(case_id(_DEVICE, air)))
        at = At(**{name: str(value) for name, value in patch._asdict().items()})
        settings = replace(in_si(Settings, GROUND.settings(plan, at, strips)), seed=seed)
        surfaces = surfaces_of(plan)
        strips_drawn = contact.compute(surfaces, f"estimate{point.number}", "NG", settings)
        strips = with_correlations(strips_drawn, surfaces, (device.strip, device.width))
        return cls(strips, water_of(plan), device, Truncation(**plan.config["chaos"]), seed, point.number)

    def lengths(self, height: float, sizes: np.ndarray, number: int, change: Correction | None = None) -> np.ndarray:
        """Lengths that the middle of a number of bridges holds in a film of a height [m], of sizes (3,) [SI]."""
        return self.lengths_in(air_of(height, 1.0, self.water.temperature)[0], sizes, number, change)

    def lengths_in(self, air: float, sizes: np.ndarray, number: int, change: Correction | None = None) -> np.ndarray:
        """Lengths as of `lengths` at a humidity [-]."""
        corrected = replace(self, water=replace(self.water, correction=change))
        laws = sticking.fitted_laws(corrected.contact, air, corrected, (self.device.strip, self.device.width))
        bridge = replace(self.device, **dict(zip(("thickness", "gap", "residual_stress"), sizes, strict=True)))
        drawn = laws.draw(opening.LAWS, stream(self.seed, "estimate", "mesh", self.number))

        def address(k):
            """Stream of bridge k."""
            return stream(self.seed, "estimate", "bridges", self.number, f"{air:.6f}", k)

        return opening.arrests(bridge, opening.ground_of(bridge, drawn), laws.in_row(bridge), number, address)


def ratio_of_energies(point: Point, plan: Plan, height: float, seed: int) -> levels.Ratio:
    """Ratio of mean energies in full contact to those on summits, unknown if not found."""
    air, _ = air_of(height, 1.0, water_of(plan).temperature)
    stated = full_energy.settings_of(plan, At(case=Case(case_id(PAIR, round(air, 4)))))
    settings = replace(in_si(full_energy.Settings, stated), forces=False, seed=seed)
    settings = replace(settings, beam=replace(settings.beam, width=_WIDTH))
    try:
        strips = full_energy.strips_of(surfaces_of(plan), f"estimate{point.number}", settings)
        return full_energy.ratio_of_energies(strips, _ERROR, seed, point.number)
    except (NotConverged, TooLong, ValueError):
        return full_energy.UNKNOWN


def correction_of(energy: levels.Ratio, of_patches: Mapping[str, Any], height: float, water: Water) -> Correction:
    """Changes of energies and of largest attractions that a run applies."""
    changes = [
        ElasticChange(numbers["ratio"], max(float(numbers["power"]), 1.0)) for numbers in (vars(energy), of_patches)
    ]
    in_air = [ElasticChange(np.array([change.ratio]), np.array([change.power])) for change in changes]
    return Correction(np.array([air_of(height, 1.0, water.temperature)[0]]), *in_air, nearest=True)


def computed(point: Point, name: str, valid: dict[str, Any]) -> dict[str, Any]:
    """Numbers of one point of a set, with those of its patch, which are in the working directory."""
    effort, plan, sizes = SETS[name], plan_of(point, valid), sizes_of(point, name)
    airs = states(effort.states, point.number, effort.seed)
    strips = TrainingStrips.of(point, plan, STRIPS, effort.seed)
    each = zip(airs[:, 0], sizes, strict=True)
    lengths = np.array([strips.lengths(height, size, effort.patches) for height, size in each])
    results = {"airs": airs, "sizes": sizes, "lengths": lengths.astype(np.float32)}
    if point.number % effort.every == 0:
        energy = ratio_of_energies(point, plan, airs[0, 0], effort.seed)
        results |= {"ratio": energy.ratio, "ratio_error": energy.error, "power": energy.power}
        of_patch = numbers_of(Path(patches.FOLDER) / name, point.number)
        change = correction_of(energy, of_patch, airs[0, 0], strips.water)
        if np.isfinite([change.energy.ratio, change.pull_off.ratio]).all():
            changed = strips.lengths(airs[0, 0], sizes[0], effort.patches, change)
            results["changed"] = changed.astype(np.float32)
    return results
