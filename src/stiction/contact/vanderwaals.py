"""Van der Waals attraction of two half spaces as a Dugdale stress (Sec. III-A1).

ASSUME: it acts through water, in which the touching summits stand; a setting, see the study of the readings.
"""

from dataclasses import dataclass

import numpy as np

from stiction.constants import HAMAKER_CONSTANT, MOLECULAR_DISTANCE


@dataclass(frozen=True)
class Attraction:
    """Constant stress up to a cut-off distance; none at all if the Hamaker constant is 0."""

    hamaker_constant: float  #: ℌ [J]

    @property
    def equilibrium_distance(self):
        """Distance D₀ at which two half spaces feel no force [m]."""
        return (2 / 15) ** (1 / 6) * MOLECULAR_DISTANCE

    @property
    def work_of_adhesion(self):
        """Work per area ω_vdW to separate two half spaces, Eq. (10) [J m⁻²]."""
        return self.hamaker_constant / (16 * np.pi * self.equilibrium_distance**2)

    @property
    def range(self):
        """Distance h_vdW beyond which the stress vanishes [m]."""
        return 0.97 * 2 ** (1 / 6) * MOLECULAR_DISTANCE

    @property
    def stress(self):
        """Tension -σ_vdW = ω_vdW / h_vdW within the range, positive [Pa]."""
        return self.work_of_adhesion / self.range


def attraction(through):
    """Attraction of polysilicon through ``"water"`` or ``"dry"`` air, or ``"none"``; ValueError for anything else."""
    if through not in ("none", *HAMAKER_CONSTANT):
        raise ValueError(f"attraction acts through {', '.join(HAMAKER_CONSTANT)} or none, got {through!r}")
    return Attraction(0.0 if through == "none" else HAMAKER_CONSTANT[through])
