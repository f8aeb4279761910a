"""Van der Waals attraction of two half spaces as a Dugdale stress (Sec. III-A1).

ASSUME: the attraction acts through water, which surrounds the touching summits; the medium is a setting and one of the
variants. Coatings keep the solids apart and are as stiff and as hard as they; without a Hamaker constant of their own,
they attract no more than the medium.
"""

from dataclasses import dataclass

import numpy as np

from stiction.constants import HAMAKER_CONSTANT, MOLECULAR_DISTANCE


def combined(first: float, second: float) -> float:
    r"""Hamaker constant of two different bodies, :math:`A_{132} = \sqrt{A_{131} A_{232}}`, in the unit of theirs.

    Bodies and medium have :math:`A_{131} = \bigl(\sqrt{A_{11}} - \sqrt{A_{33}}\bigr)^2` by their constants in vacuum
    (J. N. Israelachvili, Intermolecular and Surface Forces, combining relations).

    ASSUME: both bodies have a larger constant in vacuum than the medium; otherwise they may repel each other. The
    combination is then exact in the approximation of Berthelot.
    """
    return float(np.sqrt(first * second))


@dataclass(frozen=True)
class DugdaleAttraction:
    """Constant stress up to a cut-off distance. A `stiction.contact.asperity.Attraction`."""

    hamaker_constant: float  #: ℌ [J]
    spacer: float = 0.0  #: thickness t of both coatings, which keep the solids apart [m]

    def __post_init__(self):
        if not self.hamaker_constant > 0:
            raise ValueError(f"need a positive Hamaker constant, got {self.hamaker_constant:.3g} J")
        if not 0 <= self.spacer < np.inf:
            raise ValueError(f"the thickness of a coating must not be negative, got {self.spacer:.3g} m")

    @property
    def equilibrium_distance(self) -> float:
        """Distance D₀ of zero force between two half spaces [m]."""
        return (2 / 15) ** (1 / 6) * MOLECULAR_DISTANCE

    @property
    def closest_distance(self) -> float:
        """Distance D = D₀ + t of half spaces with coatings in contact [m]."""
        return self.equilibrium_distance + self.spacer

    @property
    def work_of_adhesion(self) -> float:
        r"""Work ω_vdW per area to separate half spaces with coatings in contact, Eq. (10) without coatings [J m⁻²].

        The work of the attraction from D on, less that of the repulsion, which is a quarter of it at D = D₀ and 0.2 %
        for a spacer of 0.2 nm:

        .. math:: \omega = \frac{\mathfrak{H}}{12 \pi D^2} \Bigl( 1 - \frac{D_0^6}{4 D^6} \Bigr)
        """
        near = self.equilibrium_distance / self.closest_distance
        return self.hamaker_constant / (16 * np.pi * self.closest_distance**2) * ((4 - near**6) / 3)

    @property
    def range(self) -> float:
        """Distance h_vdW at the end of the stress [m].

        With coatings the stress is the attraction of half spaces at the distance D, 2 ω / D, which repulsion does not
        weaken there. It thus ends at the distance D / 2, and not before that of touching solids: the tangent of the
        work, so that gaps have the rest of the work, which is nowhere negative.
        """
        return max(0.97 * 2 ** (1 / 6) * MOLECULAR_DISTANCE, self.closest_distance / 2)

    @property
    def stress(self) -> float:
        """Tension -σ_vdW = ω_vdW / h_vdW within the range, positive [Pa]."""
        return self.work_of_adhesion / self.range

    def work(self, gap: float | np.ndarray) -> float | np.ndarray:
        """Work per area to separate the flats from a gap >= 0 to infinity [J m⁻²]. Gap [m], any shape."""
        return self.work_of_adhesion * np.maximum(1 - gap / self.range, 0.0)


@dataclass(frozen=True)
class LayeredAttraction:
    """Attraction of coated half spaces: all pairs of their interfaces, `stiction.contact.solids.interfaces`, added up.

    A constant stress again, the tangent of the work where the coatings touch.
    """

    pairs: tuple[DugdaleAttraction, ...]

    @property
    def work_of_adhesion(self) -> float:
        """Work per area to separate the half spaces [J m⁻²]."""
        return sum(pair.work_of_adhesion for pair in self.pairs)

    @property
    def stress(self) -> float:
        """Tension within the range, positive [Pa]."""
        return sum(pair.stress for pair in self.pairs)

    @property
    def range(self) -> float:
        """Distance at the end of the stress [m]."""
        return self.work_of_adhesion / self.stress

    work = DugdaleAttraction.work


def attraction(through: str, hamaker_constant: float | None = None, spacer: float = 0.0) -> DugdaleAttraction | None:
    """Attraction through ``"water"`` or ``"dry"`` air, ``None`` for ``"none"``.

    ``hamaker_constant`` is that of the two solids through this medium [J]; without it, that of polysilicon. Coatings of
    the thickness ``spacer`` [m] keep them apart.

    Raises
    ------
    ValueError
        For any other medium.
    """
    if through not in ("none", *HAMAKER_CONSTANT):
        raise ValueError(f"attraction acts through {', '.join(HAMAKER_CONSTANT)} or none, got {through!r}")
    if through == "none":
        return None
    return DugdaleAttraction(HAMAKER_CONSTANT[through] if hamaker_constant is None else hamaker_constant, spacer)
