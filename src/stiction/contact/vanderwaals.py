"""Van der Waals attraction of two half spaces as a Dugdale stress (Sec. III-A1).

ASSUME: the attraction acts through water, which surrounds the touching summits; the medium is a setting and one of the
variants.
"""

from dataclasses import dataclass

import numpy as np

from stiction.constants import HAMAKER_CONSTANT, MOLECULAR_DISTANCE


@dataclass(frozen=True)
class DugdaleAttraction:
    """Constant stress up to a cut-off distance; a `stiction.contact.asperity.Attraction`."""

    hamaker_constant: float  #: ℌ [J]

    def __post_init__(self):
        if not self.hamaker_constant > 0:
            raise ValueError(f"need a positive Hamaker constant, got {self.hamaker_constant:.3g} J")

    @property
    def equilibrium_distance(self) -> float:
        """Distance D₀ at which the force between two half spaces vanishes [m]."""
        return (2 / 15) ** (1 / 6) * MOLECULAR_DISTANCE

    @property
    def work_of_adhesion(self) -> float:
        """Work per area ω_vdW to separate two half spaces, Eq. (10) [J m⁻²]."""
        return self.hamaker_constant / (16 * np.pi * self.equilibrium_distance**2)

    @property
    def range(self) -> float:
        """Distance h_vdW beyond which the stress vanishes [m]."""
        return 0.97 * 2 ** (1 / 6) * MOLECULAR_DISTANCE

    @property
    def stress(self) -> float:
        """Tension -σ_vdW = ω_vdW / h_vdW within the range, positive [Pa]."""
        return self.work_of_adhesion / self.range

    def work(self, gap: float | np.ndarray) -> float | np.ndarray:
        """Work per area to separate the flats from a gap >= 0 to infinity [J m⁻²]; gap [m], any shape."""
        return self.work_of_adhesion * np.maximum(1 - gap / self.range, 0.0)


def attraction(through: str, hamaker_constant: float | None = None) -> DugdaleAttraction | None:
    """Attraction through ``"water"`` or ``"dry"`` air; ``None`` for ``"none"``.

    ``hamaker_constant`` is that of the two solids through this medium [J]; without it, that of polysilicon.

    Raises
    ------
    ValueError
        For any other medium.
    """
    if through not in ("none", *HAMAKER_CONSTANT):
        raise ValueError(f"attraction acts through {', '.join(HAMAKER_CONSTANT)} or none, got {through!r}")
    if through == "none":
        return None
    return DugdaleAttraction(HAMAKER_CONSTANT[through] if hamaker_constant is None else hamaker_constant)
