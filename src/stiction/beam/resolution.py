"""Elements fine enough for the cracks on given force laws (Sec. III-C, App. C)."""

from dataclasses import replace

import numpy as np

from stiction.beam.cantilever import Beam
from stiction.beam.energy import arrest_length
from stiction.beam.foundation import ELEMENT, LONGER, STRIP, foundation_length
from stiction.contact import forcelaw

#: Elements along the shortest crack that a mesh resolves, and that crack relative to the one that Eq. (13) predicts
#: from the mean adhesion energy: `stiction.beam.release.release` needs two elements.
ALONG_SHORTEST, SHORTEST = 4, 1 / 3


def longest(beam: Beam, laws: np.ndarray) -> tuple[float, float]:
    """Longest strip and longest element to resolve a crack on force laws (n, 4) [m]."""
    foundation = foundation_length(beam, laws)
    shortest = SHORTEST * min(arrest_length(forcelaw.energy(laws).mean(), beam), beam.length)
    element = min(ELEMENT * foundation, shortest / ALONG_SHORTEST)
    return min(STRIP * foundation, element), element


def resolved(beam: Beam, points: int, laws: np.ndarray, coarser: float = 1.0) -> Beam:
    """Beam with as many elements as its laws require, and at least its original number.

    Every element contains a whole number of the ``points`` along the beam, each with a force law; a sample of these has
    rows [f_max, d_max, a_left, a_right] (n, 4), SI. Elements and strips may be longer than `longest` allows by the
    factor ``coarser`` [-], at most 2. Where strips are longer still, but not by more than the factor
    `stiction.beam.foundation.LONGER`, each is an element.

    Raises
    ------
    ValueError
        If the strips are too long for these laws, whatever the elements.
    """
    length, strip, (allowed, element) = foundation_length(beam, laws), beam.length / points, longest(beam, laws)
    if strip > LONGER * allowed:
        raise ValueError(
            f"strips of {1e6 * strip:.3g} µm do not resolve a crack on these surfaces: the adhesion needs strips of at "
            f"most {1e6 * allowed:.3g} µm (foundation length {1e6 * length:.3g} µm); decrease strip_length_um, or "
            "increase the thickness or the gap of the beam"
        )
    if strip > coarser * allowed:
        return replace(beam, elements=points)
    multiples = (
        n for n in range(beam.elements, points + 1) if points % n == 0 and beam.length / n <= coarser * element
    )
    return replace(beam, elements=next(multiples))
