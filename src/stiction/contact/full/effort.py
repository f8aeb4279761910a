"""Elements that count how often they are displaced, which costs nearly all time of full contact, and have a limit.

The count is the same on every machine, where a time is not.
"""

from dataclasses import dataclass, field, fields

import numpy as np

from stiction.contact.full.halfspace import HalfSpace


class TooLong(Exception):
    """The displacements are more than the limit."""


@dataclass
class Effort:
    """Displaced elements: those so far, and the most."""

    most: float  #: [-]
    spent: int = 0  #: [-]

    def spend(self, elements: int) -> None:
        """Count elements that are displaced.

        Raises
        ------
        TooLong
            If they are more than the limit.
        """
        self.spent += elements
        self.require(self.spent)

    def require(self, elements: float) -> None:
        """Raise `TooLong` if a number of displaced elements is more than the limit."""
        if elements > self.most:
            raise TooLong("full elastic contact takes too long on so smooth or so large surfaces")


@dataclass(frozen=True)
class CountedHalfSpace(HalfSpace):
    """Half-space that counts its displacements."""

    effort: Effort = field(kw_only=True)

    @classmethod
    def from_space(cls, space: HalfSpace, effort: Effort) -> "CountedHalfSpace":
        """Half-space like another one."""
        return cls(**{each.name: getattr(space, each.name) for each in fields(space)}, effort=effort)

    def displacement(self, pressure: np.ndarray) -> np.ndarray:
        """Count, and displace as any half-space does."""
        self.effort.spend(pressure.size)
        return super().displacement(pressure)

    def traction(self, displacement: np.ndarray) -> np.ndarray:
        """Count, and displace as any half-space does."""
        self.effort.spend(displacement.size)
        return super().traction(displacement)

    def displacement_on_springs(self, pressure: np.ndarray) -> np.ndarray:
        """Count, and displace as any half-space does."""
        self.effort.spend(pressure.size)
        return super().displacement_on_springs(pressure)
