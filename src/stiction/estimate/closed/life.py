"""Life of a device in closed forms, beside what the estimate has learnt: drying, shock and voltage. SI units.

The numbers of `stiction.stages.life`, for exact inputs, in plain Python.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from stiction.config.units import to_si
from stiction.constants import DENSITY, VACUUM_PERMITTIVITY
from stiction.estimate.closed.beams import HALF_SINE, DryingLiquid, SlenderBeam
from stiction.estimate.closed.bending import largest
from stiction.estimate.voltage import potential_of

#: Part of the gap of an electrode up to which a stopper is moved.
_NEARLY = 0.98


@dataclass(frozen=True)
class Dried:
    """Beams after a liquid dried."""

    stands: float  #: longest to stand for certain [m]
    collapses: float  #: longest that can stand [m]
    released: float  #: longest to come free after a collapse [m]
    is_released: bool  #: whether all shorter ones do: the middle of a bridge may hold it

    @property
    def lengths(self) -> tuple[float, float, float]:
        """Its lengths [m]."""
        return self.stands, self.collapses, self.released


@dataclass(frozen=True)
class Touching:
    """Causes of the contact of a device of a size, infinite or NaN where none is known."""

    size: float  #: length or restoring force [SI]
    shock: float = math.nan  #: peak of a half-sine below which it does not touch [m s⁻²]
    slow_shock: float = math.inf  #: at which it touches for certain [m s⁻²]
    voltage: float = math.nan  #: below which it does not touch [V]


@dataclass(frozen=True)
class SquareElectrode:
    """Electrode that pulls down a stopper on a spring."""

    area: float  #: [m²]
    gap: float  #: from the moving part at rest [m]
    stiffness: float  #: of the spring [N m⁻¹]
    way: float  #: to the contact [m]

    def pull_in_at_once(self) -> float:
        r"""Voltage switched on at once that does not bring the stopper into contact, with fringes at a square [V].

        With :math:`s = \sqrt A` and the way u to the distance l = g - u, `stiction.life.touch.stopper_voltage_at_once`
        is the largest of

        .. math:: V^2 = \frac{k u^2}{\epsilon_0} / \int_l^g \Bigl( \frac{s}{x} + \frac{4}{\pi} \Bigr)^2 dx .

        Examples
        --------
        >>> round(SquareElectrode(1e-8, 3e-6, 2.0, 1e-6).pull_in_at_once(), 2)
        11.29
        """
        side, fringe = math.sqrt(self.area), 4 / math.pi

        def squared(moved):
            """Squared voltage that does the work of the spring on a way [V²]."""
            left = self.gap - moved
            plates = side**2 * (1 / left - 1 / self.gap) + 2 * side * fringe * math.log(self.gap / left)
            return self.stiffness * moved**2 / (VACUUM_PERMITTIVITY * (plates + fringe**2 * moved))

        way = min(self.way, _NEARLY * self.gap)
        return math.sqrt(max(largest(squared, way), squared(way)))


@dataclass(frozen=True)
class Surroundings:
    """What happens to a device beside its contact in air."""

    liquids: Mapping[str, DryingLiquid] = field(default_factory=dict)  #: that dry on beams, by name
    shock: float = 0.0  #: peak of its shocks [m s⁻²]
    potential: float | None = None  #: largest difference of potential, none without a dielectric [V]
    density: float = DENSITY  #: of a beam [kg m⁻³]
    mass: float = 0.0  #: that moves with a stopper, zero if it is not stated [kg]
    electrode: SquareElectrode | None = None

    @classmethod
    def of_device(cls, device: Mapping[str, Any], content: Mapping[str, Any], material: Mapping) -> "Surroundings":
        """Surroundings of a device by its section, the content of its file, and the section of its material."""
        liquids = {name: _liquid(entry) for name, entry in content.get("liquids", {}).items()}
        potential = potential_of(device) if "dielectric" in device else None
        density = to_si(material.get("density_kg_per_m3", DENSITY), "kg_per_m3")
        shock, mass = to_si(device.get("shock_g", 0.0), "g"), to_si(device.get("mass_ng", 0.0), "ng")
        return cls(liquids, shock, potential, density, mass, _electrode(device))


@dataclass(frozen=True)
class BeamLife:
    """Life of a beam of any length."""

    beam: SlenderBeam
    surroundings: Surroundings

    def dried(self) -> dict[str, Dried]:
        """Lengths of beams that dry, by liquid."""
        beam, liquids = self.beam, self.surroundings.liquids.items()
        return {
            name: Dried(beam.standing_each(liquid), beam.standing(liquid), beam.released(liquid), beam.clamps == 1)
            for name, liquid in liquids
        }

    def touching(self, length: float) -> Touching:
        """Causes of the contact of a beam of a length [m]. Rigid clamps stretch a bridge: no shock is sure to do it."""
        beam, density = self.beam, self.surroundings.density
        slow = beam.slow_shock(length, density) if beam.clamps == 1 else math.inf
        voltage = math.nan if self.surroundings.potential is None else beam.pull_in_at_once(length)
        return Touching(length, beam.half_sine_shock(length, density), slow, voltage)


@dataclass(frozen=True)
class StopperLife:
    """Life of a stopper."""

    surroundings: Surroundings

    def dried(self) -> dict[str, Dried]:
        """Nothing: no beam collapses."""
        return {}

    def touching(self, force: float) -> Touching:
        """Causes of the contact of a stopper with a restoring force [N]."""
        mass, electrode = self.surroundings.mass, self.surroundings.electrode
        voltage = electrode.pull_in_at_once() if electrode else math.nan
        return (
            Touching(force, force / mass / HALF_SINE, force / mass, voltage)
            if mass
            else Touching(force, voltage=voltage)
        )


def _liquid(entry):
    """Liquid of a section."""
    angle = to_si(entry.get("contact_angle_deg", 0.0), "deg")
    return DryingLiquid(to_si(entry["surface_tension_mN_per_m"], "mN_per_m"), angle)


def _electrode(device):
    """Electrode of a stopper with a spring, none without both."""
    if not device.keys() >= {"electrode", "stiffness_N_per_m", "gap_um"}:
        return None
    electrode, stiffness = device["electrode"], to_si(device["stiffness_N_per_m"], "N_per_m")
    sizes = to_si(electrode["area_um2"], "um2"), to_si(electrode["gap_um"], "um")
    return SquareElectrode(*sizes, stiffness, to_si(device["gap_um"], "um"))
