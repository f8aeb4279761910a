r"""Drying of beams released in a liquid: collapsing beams, and releasing ones among them.

**Collapse.** A liquid under the beam is connected, so that its pressure is the same everywhere, that of its meniscus at
x = a: :math:`p = 2 \gamma \cos\theta / g(a)`. It retreats towards the tip, or the middle of a bridge, while it dries.
With :math:`\lambda = 2 \gamma \cos\theta w L^4 / EI h^2 = 24 \gamma \cos\theta L^4 / E t^3 h^2`, the beam collapses if
λ exceeds the smallest fold over all a: for a cantilever :math:`3 / (\alpha^2 (1 - \alpha)(3 + \alpha)) = 5.5079` at
:math:`\alpha = (\sqrt{33} - 3) / 4`, for a bridge without tension 203.175, with the liquid on its middle 39 %. Thus

.. math:: L^4 < 0.2295 \frac{E t^3 h^2}{\gamma \cos\theta} \text{ (cantilever)}, \quad
    8.466 \frac{E t^3 h^2}{\gamma \cos\theta} \text{ (bridge)} .

**The safe bound** counts liquid of its own at every cross-section, up to the edges of the beam. There it is pinned: its
surface leaves the beam at any angle :math:`\phi \ge \theta` to the underside, and pulls per length of the beam with

.. math:: \gamma \left( \frac{w}{g} (\cos\theta + \cos\phi) + 2 \sin\phi \right) .

The worst angle has :math:`\tan\phi = 2 g / w` (`pull_of_liquid`); with θ = 0 it is
:math:`\gamma (w/g + \sqrt{(w/g)^2 + 4})`. At the edge of a free end the surface pulls with at most :math:`\gamma w`
more. On beams much wider than the gap, :math:`2 \gamma \cos\theta \, w / g` remains, and λ is 2.7845 and 116.95
(0.1160 and 4.873 in place of 0.2295 and 8.466): lengths 16 and 13 % shorter than those of a connected liquid.

**After drying**, what collapsed is held by the liquid down to its last film. If it wets both sides, it holds with the
energy :math:`2 \gamma \cos\theta`, and a cantilever comes free of its tip up to :math:`L^4 = 3 E t^3 h^2 / 16 \gamma
\cos\theta`, see `stiction.devices.arcs`. Two cracks in a bridge meet at twice the crack length of this energy; longer
bridges stay, and shorter ones may be held by their middle.

ASSUME: no residues, which hold once the film is gone, and no curl. Holes for the release, stretching of a bridge and
the weight of the liquid are left out.
"""

from collections.abc import Callable

import numpy as np
from scipy.optimize import newton

from stiction.beam.cantilever import Beam
from stiction.beam.energy import arrest_length
from stiction.devices.arcs import arc_length
from stiction.life.bending import Bent, Load


def longest_standing(beam: Beam, clamps: int, adhesion: float) -> float:
    """Longest beam to stand while a connected liquid dries [m].

    ``adhesion`` is the adhesion tension γ cos θ of the liquid [N m⁻¹]. Infinite if it does not wet the beam.

    Examples
    --------
    >>> beam = Beam(1e-3, 30e-6, 2.6e-6, 164e9, 20e-6, 1)
    >>> round(longest_standing(beam, 1, 0.072) * 1e6)  # µm, water
    246
    """
    return _longest(beam, clamps, adhesion, lambda bent, _: bent.fold_of_drop())


def longest_standing_each(beam: Beam, clamps: int, tension: float, angle: float = 0.0) -> float:
    """Longest beam to stand if each cross-section has its own liquid: the safe bound of `longest_standing` [m].

    ``tension`` is the surface tension γ of the liquid [N m⁻¹], ``angle`` its contact angle θ on the beam [rad].

    Examples
    --------
    >>> beam = Beam(1e-3, 30e-6, 2.6e-6, 164e9, 20e-6, 1)
    >>> round(longest_standing_each(beam, 1, 0.072) * 1e6)  # µm, water
    199
    """
    adhesion = tension * np.cos(angle)
    if adhesion <= 0:
        return np.inf

    def along(u):
        """Load per length over that of the open gap on a wide beam [-]."""
        return pull_of_liquid(beam.width / (beam.gap * (1 - u)), angle) * beam.gap / (2 * np.cos(angle) * beam.width)

    def fold(bent, length):
        """Load factor at the fold of a beam of a length [m]."""
        end = beam.gap / (2 * np.cos(angle) * length)
        return bent.fold(Load(along, lambda u: end + 0 * u))

    return _longest(beam, clamps, adhesion, fold)


def pull_of_liquid(width_by_gap: float | np.ndarray, angle: float = 0.0) -> float | np.ndarray:
    """Largest pull of liquid pinned at both edges, per length and surface tension [-], any shape.

    Examples
    --------
    >>> float(pull_of_liquid(1.5))  # 1.5 + √(1.5² + 4); twice the first of wide beams
    4.0
    """
    pinned = np.maximum(angle, np.arctan2(2, width_by_gap))
    return width_by_gap * (np.cos(angle) + np.cos(pinned)) + 2 * np.sin(pinned)


def _longest(beam: Beam, clamps: int, adhesion: float, fold: Callable[[Bent, float], float]) -> float:
    """Length with λ at its fold, which depends on the length with tension, or a load at the end."""
    if adhesion <= 0:
        return np.inf
    by_fold = beam.bending_stiffness * beam.gap**2 / (2 * adhesion * beam.width)

    def excess(logarithm):
        """Logarithm of the load factor at the fold over the beam's, at that of its length [m]."""
        length = np.exp(logarithm)
        return np.log(fold(Bent(clamps, (beam.decay * length) ** 2), length) * by_fold) - 4 * logarithm

    start = np.log(by_fold) / 4
    return float(np.exp(newton(excess, start, x1=start + excess(start) / 4, tol=1e-10)))


def longest_free(beam: Beam, clamps: int, adhesion: float) -> float:
    """Longest beam to release after a liquid has dried, for bridges the length of two meeting cracks [m].

    Infinite if the liquid does not wet the beam. ASSUME: the tip has a sharp edge. What a rounded one holds in the air
    of the room is part of the safe lengths.

    Examples
    --------
    >>> beam = Beam(1e-3, 30e-6, 2.6e-6, 164e9, 20e-6, 1)
    >>> round(longest_free(beam, 1, 0.072) * 1e6)  # µm, water
    234
    """
    if adhesion <= 0:
        return np.inf
    energy = 2 * adhesion
    return float(arc_length(energy, beam) if clamps == 1 else 2 * arrest_length(energy, beam))
