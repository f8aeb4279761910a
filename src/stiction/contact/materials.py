"""Materials: a solid body, its properties by name, and the steps of their slopes in a budget.

What a configuration states of materials is in `stiction.config.materials`, two bodies in contact in
`stiction.contact.solids`.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from stiction.constants import HAMAKER_CONSTANT, HARDNESS, POISSON_RATIO, YOUNG_MODULUS


@dataclass(frozen=True)
class Solid:
    """Material of one body. Polysilicon unless stated otherwise."""

    young_modulus: float = YOUNG_MODULUS  #: E [Pa]
    poisson_ratio: float = POISSON_RATIO  #: ν [-]
    hardness: float = HARDNESS  #: σ_H [Pa]
    #: Hamaker constant of two bodies of this material through each medium [J]
    hamaker_constant: Mapping[str, float] = field(default_factory=lambda: dict(HAMAKER_CONSTANT))
    contact_angle: float = 0.0  #: of water θ on the body, or on its coating [rad]
    coating: float = 0.0  #: thickness of its coating [m]
    #: Hamaker constant of two thick coatings through each medium [J]; without it, coatings attract as the medium does
    coating_hamaker_constant: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self):
        constants = {f"Hamaker constant ({medium})": value for medium, value in self.hamaker_constant.items()}
        positive = {"Young's modulus": self.young_modulus, "hardness": self.hardness} | constants
        for name, value in positive.items():
            if not (value > 0 and np.isfinite(value)):
                raise ValueError(f"{name} of a solid must be positive, got {value}")
        if not -1 < self.poisson_ratio <= 0.5:
            raise ValueError(f"Poisson's ratio of a solid must be in (-1, 0.5], got {self.poisson_ratio}")
        if not 0 <= self.contact_angle <= np.pi:
            raise ValueError(f"the contact angle of a solid must be in [0, π] rad, got {self.contact_angle}")
        if not 0 <= self.coating < np.inf:
            raise ValueError(f"the coating of a solid must not be thinner than nothing, got {self.coating} m")
        for medium, value in self.coating_hamaker_constant.items():
            if not 0 <= value <= self.hamaker_constant[medium]:
                raise ValueError(
                    f"the Hamaker constant of a coating ({medium}) must be from 0 to that of its solid, got {value} J"
                )

    def attracting(self, factor: float) -> "Solid":
        """Solid with a factor of its Hamaker constants. Those of its coating stay."""
        scaled = {medium: factor * constant for medium, constant in self.hamaker_constant.items()}
        return replace(self, hamaker_constant=scaled)


@dataclass(frozen=True)
class InputStep:
    """Change of an input in either direction for its slope."""

    size: float  #: of the value of the input if it is relative, otherwise in its unit
    relative: bool = True  #: the slope is then that in the logarithm of the input

    def ends(self, value: float) -> tuple[float, float]:
        """Less and more of an input of this value."""
        if self.relative:
            return (1 - self.size) * value, (1 + self.size) * value
        return value - self.size, value + self.size

    def moved(self, value: float, by: float) -> float:
        """Value shifted by an error. Relative errors shift its logarithm.

        Examples
        --------
        >>> InputStep(0.05).moved(2.0, np.log(1.5)), InputStep(0.05, relative=False).moved(2.0, 0.5)
        (3.0, 2.5)
        """
        return float(value * np.exp(by)) if self.relative else value + by

    def error(self, value: float, deviation: float) -> float:
        """Error of an input of this value with a standard uncertainty, of its logarithm if the step is relative."""
        return deviation / value if self.relative else deviation

    @property
    def difference(self) -> float:
        """Difference of the logarithm of the input between both ends, or of the input."""
        return float(np.log((1 + self.size) / (1 - self.size))) if self.relative else 2 * self.size

    def around(self, _value: float) -> float:
        """Difference between both ends of an input of this value."""
        return self.difference

    def limits(self, _value: float) -> tuple[float, float]:
        """Errors of an input of this value that count: all."""
        return -np.inf, np.inf

    def by(self, _deviation: float) -> "InputStep":
        """Step for an input with a standard uncertainty in its unit."""
        return self


@dataclass(frozen=True)
class StepOfRest(InputStep):
    """Change of a share, relative in the rest of one: less of the share is more of the rest."""

    def ends(self, value: float) -> tuple[float, float]:
        """Less and more of a share.

        Examples
        --------
        >>> [round(end, 3) for end in StepOfRest(0.2).ends(0.9)]
        [0.88, 0.92]
        """
        less, more = super().ends(1 - value)
        return 1 - more, 1 - less

    def moved(self, value: float, by: float) -> float:
        """Share whose rest has another logarithm, smaller by an error."""
        return 1 - super().moved(1 - value, -by)

    def error(self, value: float, deviation: float) -> float:
        """Error of the logarithm of the rest."""
        return super().error(1 - value, deviation)


@dataclass(frozen=True)
class StepOfError(InputStep):
    """Change of a length by its standard uncertainty, the unit of its errors. It is never below zero.

    ASSUME: beyond one standard uncertainty more, errors count as that. Where more of it is safe, this is the safe side.
    """

    size: float = np.nan
    relative: bool = False

    def by(self, deviation: float) -> "StepOfError":
        """Step for a length with a standard uncertainty in its unit."""
        return StepOfError(deviation)

    def ends(self, value: float) -> tuple[float, float]:
        """Less and more of a length.

        Examples
        --------
        >>> StepOfError(5.0).ends(20.0), StepOfError(50.0).ends(20.0), StepOfError(50.0).limits(20.0)
        ((15.0, 25.0), (0.0, 70.0), (-0.4, 1.0))
        """
        return max(value - self.size, 0.0), value + self.size

    def around(self, value: float) -> float:
        """Difference between both ends in standard uncertainties."""
        less, more = self.ends(value)
        return (more - less) / self.size

    def limits(self, value: float) -> tuple[float, float]:
        """Errors at which the length is zero, and where it is not computed any more."""
        return -value / self.size, 1.0

    def moved(self, value: float, by: float) -> float:
        """Length after an error."""
        return max(float(value + np.clip(by, *self.limits(value)) * self.size), 0.0)

    def error(self, _value: float, deviation: float) -> float:
        """Error in standard uncertainties."""
        return deviation / self.size


@dataclass(frozen=True)
class Property:
    """Property of a body, of its edge, or of both surfaces."""

    key: str  #: of the configuration, where materials and uncertainties have it
    words: str
    step: InputStep | None = None  #: for its slope, if the contact of surfaces depends on it

    @property
    def group(self) -> str:
        """Name of a measurement for it, for reading."""
        return self.words if "'s " in self.words else f"the {self.words}"


#: All properties by name, which those of uncertain ones have in names of files. Poisson's ratio may be zero. The larger
#: step of the Hamaker constant, on which lengths depend little, halves the error of its slope.
PROPERTIES = {
    "modulus": Property("young_modulus_GPa", "Young's modulus", InputStep(0.05)),
    "poisson_ratio": Property("poisson_ratio", "Poisson's ratio", InputStep(0.05, relative=False)),
    "hardness": Property("hardness_GPa", "hardness"),
    "hamaker_constant": Property("hamaker_constant_zJ", "Hamaker constant", InputStep(0.2)),
    "contact_angle": Property("contact_angle_deg", "contact angle"),
}
#: Properties of a coating, which only some materials have, in words: its thickness, and the attraction of its own.
COATING, COATING_ATTRACTION = "coating_nm", "coating_hamaker_constant_zJ"
OF_COATINGS = {COATING: "coating", COATING_ATTRACTION: "Hamaker constant of the coating"}
#: Those on which contact depends and that may be uncertain, and the keys of all on which it depends.
OF_CONTACT = {name: entry for name, entry in PROPERTIES.items() if entry.step}
ELASTIC = (*(entry.key for entry in OF_CONTACT.values()), *OF_COATINGS)
#: Coherence of the heights of two surfaces that follow each other: the variance of z₁ + z₂ falls like its rest of one.
COHERENCE = Property("coherence", "coherence of both surfaces", StepOfRest(0.2))
#: Play of a beam above a surface that it follows. In register it sticks most, far away as on independent surfaces.
PLAY = Property("play_nm", "play in the plane", StepOfError())
#: What may be uncertain in two surfaces that follow each other, and in the contact of a pair, without tips, by name.
OF_REPLICAS = {"coherence": COHERENCE, "play": PLAY}
OF_PAIRS = OF_CONTACT | OF_REPLICAS
