"""Elements and strips that resolve the end of a crack (Sec. III-C, App. C).

Behind the front of a crack a beam lies on the force laws as on an elastic foundation; its deflection decays within the
foundation length. Elements and strips that are longer hold the front and make cracks too short.
"""

from dataclasses import replace

import numpy as np

from stiction.beam.cantilever import Beam
from stiction.beam.energy import arrest_length
from stiction.beam.release import START
from stiction.contact import forcelaw

#: Largest length of a strip and of an element, in foundation lengths. Up to these the crack on a uniform law is within
#: ``ACCURACY`` of that on a fine mesh: `tests/beam/test_resolution.py`.
STRIP, ELEMENT = 0.7, 2.2
#: Largest relative error of the length of a crack on a mesh of these lengths.
ACCURACY = 0.01
#: Elements along the crack from which a beam is released: `stiction.beam.release.release` needs two, and halves that
#: crack once for a beam that adheres much more strongly than its mean law.
ALONG_START = 4


def foundation_length(beam: Beam, laws: np.ndarray) -> float:
    r"""Foundation length of a beam on force laws [m].

    .. math:: l_f = \left( \frac{E t^3}{12 \, a_\mathrm{left} f_\mathrm{max}} \right)^{1/4}
        = \left( \frac{4 E I}{k w} \right)^{1/4}, \quad k = 4 \, a_\mathrm{left} f_\mathrm{max}

    with the slope k of Eq. (12) at f = 0. Its mean over the laws (n, 4) is taken, because several strips lie within a
    foundation length.
    """
    stiffness = 4 * np.mean(laws[:, 0] * laws[:, 2])
    return float((4 * beam.bending_stiffness / (stiffness * beam.width)) ** 0.25)


def resolved(beam: Beam, points: int, laws: np.ndarray) -> Beam:
    """Beam with as many elements as its laws call for, at least its own number.

    Parameters
    ----------
    beam : Beam
    points : int
        Number of force laws along the beam; every element contains a whole number of them.
    laws : (n, 4) float64
        Sample of the force laws [f_max, d_max, a_left, a_right], SI.

    Raises
    ------
    ValueError
        If the strips are too long for these laws, whatever the elements.
    """
    length, strip = foundation_length(beam, laws), beam.length / points
    start = START * min(arrest_length(forcelaw.energy(laws).mean(), beam), beam.length)
    element = min(ELEMENT * length, start / ALONG_START)
    allowed = min(STRIP * length, element)
    if strip > allowed:
        raise ValueError(
            f"strips of {1e6 * strip:.3g} µm do not resolve a crack on these surfaces: the adhesion needs strips of at "
            f"most {1e6 * allowed:.3g} µm (foundation length {1e6 * length:.3g} µm); decrease strip_length_um, or "
            "increase the thickness or the gap of the beam"
        )
    whole = (n for n in range(beam.elements, points + 1) if points % n == 0 and beam.length / n <= element)
    return replace(beam, elements=next(whole))
