"""Inputs of the life of a device beside its ground: its own keys, liquids and uncertainties."""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np

from stiction.beam.cantilever import Beam
from stiction.contact.voltage import Capacitor, Dielectric
from stiction.devices.bridges import half_of_bridge
from stiction.stages.devices.opening import DesignedBeam


@dataclass(frozen=True)
class Liquid:
    """Liquid for the release of devices."""

    surface_tension: float  #: γ [N m⁻¹]
    contact_angle: float = 0.0  #: θ on the device [rad]. ASSUME: 0, the safe side, where it is not stated

    @property
    def adhesion(self) -> float:
        """Adhesion tension γ cos θ [N m⁻¹]."""
        return float(self.surface_tension * np.cos(self.contact_angle))


@dataclass(frozen=True)
class BeamErrors:
    """Standard uncertainties of the inputs of a beam."""

    thickness: float = 0.0  #: [m]
    gap: float = 0.0  #: [m]
    young_modulus: float = 0.0  #: [Pa]
    residual_stress: float = 0.0  #: [Pa]


@dataclass(frozen=True, kw_only=True)
class DeviceKeys:
    """Keys of any device beside its dimensions."""

    touchdowns: int = 1
    voltage: float = 0.0  #: [V]
    offset: float = 0.0  #: by charge and contact potential [V]
    dielectric: Dielectric | None = None
    shock: float = 0.0  #: peak [m s⁻²]

    @property
    def capacitor(self) -> Capacitor | None:
        """Device and substrate at their voltage, if there is any."""
        return self.dielectric and Capacitor(self.dielectric, self.voltage, self.offset)

    @property
    def potential(self) -> float:
        """Largest difference of potential [V]."""
        return self.capacitor.potential if self.capacitor else 0.0


@dataclass(frozen=True)
class Dimples:
    """Rows of dimples across a beam."""

    number: int  #: in each row
    at: tuple[float, ...]  #: increasing distances from a clamp [m]
    height: float  #: [m]


@dataclass(frozen=True, kw_only=True)
class BeamKeys(DeviceKeys):
    """Beam and its surroundings beside its ground."""

    device: DesignedBeam
    density: float  #: ρ [kg m⁻³]
    liquids: dict[str, Liquid]
    uncertainty: BeamErrors
    length: float = 0.0  #: as stated [m]; otherwise the least safe length counts
    dimples: Dimples | None = None

    @property
    def clamps(self) -> int:
        """Number of its clamps."""
        return self.device.opening.arms

    def beam(self, length: float, **changed: float) -> Beam:
        """Beam of a length [m] under its tension, with some inputs changed."""
        device = replace(self.device, **changed)
        sizes = length, device.width, device.thickness, device.young_modulus, device.gap
        return half_of_bridge(Beam(*sizes, elements=1), device.residual_stress)

    def number(self, quantity: Callable[[Beam], float], length: float) -> tuple[float, float]:
        """Number of the beam, and its standard uncertainty to first order, NaN if no input has any."""
        squares, value = 0.0, quantity(self.beam(length))
        for field in fields(self.uncertainty):
            mean, error = getattr(self.device, field.name), getattr(self.uncertainty, field.name)
            if error and np.isfinite(value):
                ends = max(mean - error, 0.0), mean + error
                low, high = (quantity(self.beam(length, **{field.name: end})) for end in ends)
                squares += ((high - low) / 2) ** 2
        return value, squares**0.5 or np.nan


@dataclass(frozen=True)
class Electrode:
    """Electrode for pulling a stopper down."""

    area: float  #: [m²]
    gap: float  #: from the moving part at rest [m]


@dataclass(frozen=True, kw_only=True)
class StopperKeys(DeviceKeys):
    """Stopper and its surroundings beside its ground, zero if not given."""

    restoring_force: float  #: [N]
    contact: tuple[float, float]  #: sides of its area [m]
    stiffness: float = 0.0  #: of its spring [N m⁻¹]
    gap: float = 0.0  #: way to the contact [m]
    mass: float = 0.0  #: that moves [kg]
    unasked: tuple[str, ...] = ()  #: keys that say nothing about it
    electrode: Electrode | None = None
