r"""Drying of beams released in a liquid: collapsing beams, and releasing ones among them.

**Collapse.** A liquid under the beam is connected, so that its pressure is the same everywhere, that of its meniscus at
x = a: :math:`p = 2 \gamma \cos\theta / g(a)`. It retreats towards the tip, or the middle of a bridge, while it dries.
With :math:`\lambda = 2 \gamma \cos\theta w L^4 / EI h^2 = 24 \gamma \cos\theta L^4 / E t^3 h^2`, the beam collapses if
λ exceeds the smallest fold over all a: for a cantilever :math:`3 / (\alpha^2 (1 - \alpha)(3 + \alpha)) = 5.5079` at
:math:`\alpha = (\sqrt{33} - 3) / 4`, for a bridge without tension 203.175, with the liquid on its middle 39 %. Thus

.. math:: L^4 < 0.2295 \frac{E t^3 h^2}{\gamma \cos\theta} \text{ (cantilever)}, \quad
    8.466 \frac{E t^3 h^2}{\gamma \cos\theta} \text{ (bridge)} .

If each cross-section had liquid of its own, with the pressure :math:`2 \gamma \cos\theta / g(x)`, λ would be 2.7845 and
116.95 (0.1160 and 4.873 in place of 0.2295 and 8.466): lengths 16 and 13 % shorter. This is the safe bound.

**After drying**, what collapsed is held by the liquid down to its last film. If it wets both sides, it holds with the
energy :math:`2 \gamma \cos\theta`, and a cantilever comes free of its tip up to :math:`L^4 = 3 E t^3 h^2 / 16 \gamma
\cos\theta`, see `stiction.devices.arcs`. Two cracks in a bridge meet at twice the crack length of this energy; longer
bridges stay, and shorter ones may be held by their middle.

ASSUME: no residues, which hold once the film is gone, and no curl. Holes for the release, stretching of a bridge and
the weight of the liquid are left out.
"""

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from stiction.beam.cantilever import Beam
from stiction.beam.energy import arrest_length
from stiction.devices.arcs import arc_length
from stiction.life.bending import Bent


def longest_standing(beam: Beam, clamps: int, adhesion: float) -> float:
    """Longest beam to stand while a connected liquid dries [m].

    ``adhesion`` is the adhesion tension γ cos θ of the liquid [N m⁻¹]. Infinite if it does not wet the beam.

    Examples
    --------
    >>> beam = Beam(1e-3, 30e-6, 2.6e-6, 164e9, 20e-6, 1)
    >>> round(longest_standing(beam, 1, 0.072) * 1e6)  # µm, water
    246
    """
    return _longest(beam, clamps, adhesion, Bent.fold_of_drop)


def longest_standing_each(beam: Beam, clamps: int, adhesion: float) -> float:
    """Longest beam to stand if each cross-section has its own liquid: the safe bound of `longest_standing` [m]."""
    return _longest(beam, clamps, adhesion, lambda one: one.fold(1))


def _longest(beam: Beam, clamps: int, adhesion: float, fold: Callable[[Bent], float]) -> float:
    """Length with λ at its fold. With tension, the fold depends on the length."""
    if adhesion <= 0:
        return np.inf
    by_fold = beam.bending_stiffness * beam.gap**2 / (2 * adhesion * beam.width)
    slack = (fold(Bent(clamps)) * by_fold) ** (1 / 4)
    if not beam.tension:
        return float(slack)

    def excess(length):
        """Load factor at the fold over the beam's, less 1, at a length [m]."""
        return fold(Bent(clamps, (beam.decay * length) ** 2)) * by_fold / length**4 - 1

    longer = slack
    while excess(longer) > 0:
        longer *= 2
    return float(brentq(excess, slack, longer))


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
