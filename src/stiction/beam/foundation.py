"""Foundation length of a beam on its force laws, and how long elements and strips may be (Sec. III-C, App. C).

Behind the front of a crack a beam lies on the force laws as on an elastic foundation; its deflection decays within the
foundation length. Elements and strips that are longer hold the front and make cracks too short.
"""

import numpy as np

from stiction.beam.cantilever import Beam

#: Largest length of a strip and of an element, in foundation lengths. Up to these the crack on a uniform law is within
#: ``ACCURACY`` of that on a fine mesh: ``tests/beam/test_foundation.py``.
STRIP, ELEMENT = 0.7, 2.2
#: Largest relative error of the length of a crack on a mesh of these lengths.
ACCURACY = 0.01
#: Strips that are longer by up to this factor still stop cracks, but too early: by at most this part of their length.
LONGER, TOO_EARLY = 2.0, 0.06


def decay_length(bending: float, stiffness: float) -> float:
    """Decay length of the deflection of a plate on an elastic foundation, (4 D / k)^(1/4) [m].

    D = E t³ / 12 is the bending stiffness per width [N m], k the stiffness of the foundation per area [Pa/m].
    """
    return float((4 * bending / stiffness) ** 0.25)


def ground_stiffness(f_max: float | np.ndarray, a_left: float | np.ndarray) -> float | np.ndarray:
    """Stiffness of a force law per area, the slope of Eq. (12) at f = 0: 4 a_left f_max [Pa/m]."""
    return 4 * a_left * f_max


def foundation_length(beam: Beam, laws: np.ndarray) -> float:
    r"""Foundation length of a beam on force laws (n, 4) [m].

    .. math:: l_f = \left( \frac{E t^3}{12 \, a_\mathrm{left} f_\mathrm{max}} \right)^{1/4}

    The mean stiffness of the laws is taken, because several strips lie within a foundation length.
    """
    stiffness = np.mean(ground_stiffness(laws[:, 0], laws[:, 2]))
    return decay_length(beam.bending_stiffness / beam.width, stiffness)
