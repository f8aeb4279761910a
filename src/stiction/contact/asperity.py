r"""Contact of one sphere with a flat: Hertz and, with a Dugdale attraction, Maugis (Sec. III-A2).

Forces are positive in repulsion, interferences positive in overlap. Maugis' theory is written in

.. math:: \bar P = \frac{P}{\pi w R}, \quad \bar a = \frac{a}{(\pi w R^2/K)^{1/3}}, \quad
          \bar\delta = \frac{\delta}{(\pi^2 w^2 R/K^2)^{1/3}}, \quad
          \lambda = 2\sigma_0 \left(\frac{R}{\pi w K^2}\right)^{1/3}, \quad K = \tfrac43 E' ;

λ → 0 is DMT, λ → ∞ is JKR. ASSUME: where several states share an interference, the sphere is in that with the largest
contact, as on the way out.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np


def reduced_modulus(young_modulus, poisson_ratio):
    """Modulus E' of two equal bodies, below Eq. (14) [Pa]."""
    return young_modulus / (2 * (1 - poisson_ratio**2))


def hertz_force(interference, radius, modulus):
    """Elastic force of a sphere on a flat [N]; interference [m], radius [m], reduced modulus [Pa]."""
    return 4 / 3 * modulus * np.sqrt(radius) * np.maximum(interference, 0) ** 1.5


def hertz_maximum_stress(interference, radius, modulus):
    """Largest contact stress, Eq. (14) [Pa]; interference [m], radius [m], reduced modulus [Pa]."""
    return 2 / np.pi * modulus * np.sqrt(np.maximum(interference, 0) / radius)


def transition_parameter(radius, modulus, attraction):
    """Maugis' λ of a sphere of ``radius`` [m] [-]."""
    stiffness = 4 / 3 * modulus
    return 2 * attraction.stress * (radius / (np.pi * attraction.work_of_adhesion * stiffness**2)) ** (1 / 3)


def interference_scale(radius, modulus, attraction):
    """Interference that is 1 in Maugis' units [m]."""
    return (np.pi**2 * attraction.work_of_adhesion**2 * radius / (4 / 3 * modulus) ** 2) ** (1 / 3)


def maugis_in_contact(spread, transition):
    """State of a sphere in contact, in closed form.

    Parameters
    ----------
    spread : (n,) array
        √(m² - 1) with m = c/a, the ratio of adhesive to contact radius [-].
    transition : float
        λ [-].

    Returns
    -------
    load, interference : (n,) arrays
        P̄ and δ̄ [-].
    """
    u, t, m = spread, np.arctan(spread), np.hypot(spread, 1)
    quadratic = 0.5 * transition * (u + (u**2 - 1) * t)
    linear = 4 / 3 * transition**2 * (u * t - m + 1)
    a = 2 / (linear + np.sqrt(linear**2 + 4 * quadratic))
    load = a**3 - transition * a**2 * (u + m**2 * t)
    return load, a**2 - 4 / 3 * transition * a * u


def maugis_apart(adhesive_radius, transition):
    """State of a sphere held by the attraction alone: P̄ and δ̄ for the radius c̄, (n,) [-]."""
    c = adhesive_radius
    load = -0.5 * np.pi * transition * c**2
    return load, 0.5 * c**2 - 8 / (3 * np.pi) * transition * c - 2 / (np.pi * transition)


def touching_radius(transition):
    """Adhesive radius c̄ at which the sphere comes to touch: the limit m → ∞ of the closure [-]."""
    quadratic, linear = 0.25 * np.pi * transition, 4 / 3 * transition**2 * (0.5 * np.pi - 1)
    return 2 / (linear + np.sqrt(linear**2 + 4 * quadratic))


def maugis_branch(transition, points=6000):
    """Loads and interferences from deep contact to separation, ordered by interference.

    Returns
    -------
    load, interference : (n,) arrays
        P̄ and δ̄ of the stable states [-]; the first is the one at which the sphere snaps off.
    """
    # Deep contact has a small spread; there the closure cancels to u³, so it starts at 1e-2 (δ̄ ~ 1e3 for any λ here).
    spread = np.geomspace(1e-2, 1e4, points)
    touching = touching_radius(transition)
    radius = np.linspace(touching, min(touching, 8 * transition / (3 * np.pi)), points)
    load, interference = np.hstack([maugis_in_contact(spread, transition), maugis_apart(radius, transition)])
    fold = np.argmin(interference)
    return load[fold::-1], interference[fold::-1]


@dataclass(frozen=True)
class MaugisTable:
    """Load of a sphere for any radius and interference, tabulated over ln λ and √(δ̄ - δ̄_min).

    The root removes the vertical tangent with which the load leaves the point of snap-off.
    """

    modulus: float  #: reduced modulus E' [Pa]
    attraction: object  #: van der Waals :class:`~stiction.contact.vanderwaals.Attraction`

    #: Range of λ and of √(δ̄ - δ̄_min), and their numbers of points.
    transitions = (0.03, 6.0, 128)
    roots = (0.0, 30.0, 4096)

    @cached_property
    def _branches(self):
        low, high, n = self.transitions
        return [maugis_branch(x) for x in np.geomspace(low, high, n)]

    @cached_property
    def snap_off(self):
        """Interference δ̄_min of every tabulated λ, (n_λ,) [-]."""
        return np.array([interference[0] for _, interference in self._branches])

    @cached_property
    def load(self):
        """Load P̄, (n_λ, n_root) [-]."""
        root = np.linspace(*self.roots)
        return np.array([np.interp(root, np.sqrt(delta - delta[0]), load) for load, delta in self._branches])

    @property
    def dimensional(self):
        """Scales of a sphere of radius 1 m and the spacing of the table.

        ln λ [-], interference [m] and force πw [N]; first ln λ and its step, step of the root [-].
        """
        low, high, n = self.transitions
        return (
            float(np.log(transition_parameter(1.0, self.modulus, self.attraction))),
            float(interference_scale(1.0, self.modulus, self.attraction)),
            float(np.pi * self.attraction.work_of_adhesion),
            float(np.log(low)),
            float(np.log(high / low) / (n - 1)),
            float(self.roots[1] / (self.roots[2] - 1)),
        )

    def force(self, interference, radius):
        """Force of one sphere, exactly [N]; 0 beyond snap-off. Interference (n,) [m], radius [m]."""
        load, delta = maugis_branch(transition_parameter(radius, self.modulus, self.attraction), 20000)
        scaled = np.asarray(interference) / interference_scale(radius, self.modulus, self.attraction)
        held = np.interp(np.sqrt(np.maximum(scaled - delta[0], 0)), np.sqrt(delta - delta[0]), load)
        return np.pi * self.attraction.work_of_adhesion * radius * np.where(scaled < delta[0], 0.0, held)
