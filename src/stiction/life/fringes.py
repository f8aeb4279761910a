r"""Fringes of the field between a plate and a larger plane: the width that an edge of the plate adds to it.

Solids at the gap g attract each other with :math:`\epsilon_0 V^2 / 2 g^2` per area of plates. By the map of Schwarz and
Christoffel of a half plane to the outside of a plate of thickness t that ends above a plane, its capacity per length of
the edge grows with the gap as that of a wider plate, by

.. math:: b(g) = \frac{g}{\pi} \left( 1 + \frac{t}{2 g} \ln \left( 1 + \frac{2 g}{t} \right) \right) ,

0.32 g of a thin and 0.64 g of a thick one. Opposite edges of a narrow plate share their field: they add less.

ASSUME: the plane reaches farther than the field, the worst case. At its corners, a plate has the field of a rectangle
that is wider by b at every edge, as well the worst case.
"""

import numpy as np


def edge_width(gap: float | np.ndarray, thickness: float) -> float | np.ndarray:
    """Width that the field at an edge adds to a plate of a thickness at a gap [m], any shape.

    Examples
    --------
    >>> [round(float(edge_width(2e-6, thickness) * 1e6), 2) for thickness in (1e-12, 2.6e-6, 1.0)]  # µm
    [0.64, 1.02, 1.27]
    """
    ratio = 2 * gap / thickness
    return gap / np.pi * (1 + np.log1p(ratio) / ratio)
