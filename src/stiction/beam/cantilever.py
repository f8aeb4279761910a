r"""Micro cantilever on a rough substrate (Sec. III-C): one random force law per contact point.

Conventions of this folder: x runs from the clamp (x = 0) to the free end (x = L); the deflection u is positive towards
the substrate, so that the distance is ``d = gap - u``; the pressure of a force law is positive in repulsion (Eq. 12).
A deflection is the array of ``[u, u']`` [m, -] at every node, (elements + 1, 2).

Laws are rows ``[f_max, d_max, a_left, a_right]`` (SI) of shape (points, 4). Point r is in the middle of the r-th of
``points`` equal segments of the beam; ``points`` is a multiple of ``elements``. An array of shape (0, 4) means a beam
without contact.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Beam:
    """Cantilever above a substrate and its mesh, Fig. 1 and Sec. IV."""

    length: float  #: L [m]
    width: float  #: w [m]
    thickness: float  #: t [m]
    young_modulus: float  #: E [Pa]
    gap: float  #: h, height of the clamp above the substrate [m]
    elements: int  #: N_e [-]
    tension: float = 0.0  #: N, constant along the beam; of a bridge under residual stress [N]

    def __post_init__(self):
        if not (self.tension >= 0 and np.isfinite(self.tension)):
            raise ValueError(f"tension of a beam must not be negative, got {self.tension}")
        for name, value in vars(self).items():
            if name != "tension" and not (value > 0 and np.isfinite(value)):
                raise ValueError(f"{name} of a beam must be positive, got {value}")
        if self.elements != int(self.elements):
            raise ValueError(f"a beam needs a whole number of elements, got {self.elements}")

    @property
    def second_moment(self) -> float:
        """Second moment of area, w t³ / 12 [m⁴]."""
        return self.width * self.thickness**3 / 12

    @property
    def bending_stiffness(self) -> float:
        """E I [N m²]."""
        return self.young_modulus * self.second_moment

    @property
    def decay(self) -> float:
        """Wave number √(N/EI) of the decay of bending under tension, 0 without tension [m⁻¹]."""
        return float(np.sqrt(self.tension / self.bending_stiffness))

    @property
    def element_length(self) -> float:
        """l_e [m]."""
        return self.length / self.elements

    @property
    def nodes(self) -> np.ndarray:
        """Positions of the nodes, (elements + 1,) [m]."""
        return np.linspace(0, self.length, self.elements + 1)
