r"""Menisci of constant volume, in a separation faster than water evaporates (not in the paper).

At the distance d between the mean planes, water up to the height h wets everything above z = d - h, an area A(z). The
gaps hold the volume per area

.. math:: V(h, d) = \int_{d - h}^{d} (d - z) \, (-dA) = h A(d - h) - \int_{d - h}^{d} A \, dz ,

by parts. In equilibrium with the vapour h is h_C at every distance, and water flows to and fro. A fast separation
starts at rest, at the distance d₀ without force, and keeps V(h_C, d₀): h follows from V(h, d) = V(h_C, d₀). The tension
in the water is that of its own curvature, :math:`\gamma (\cos\theta_1 + \cos\theta_2) / h`.

At constant temperature and volume the work of separation is the difference of two free energies, and at constant
vapour pressure of two grand potentials, which are the least that any volume can have: fast separation needs more work.
It dries the whole wetted area, and beyond the highest summit exactly :math:`\gamma (\cos\theta_1 + \cos\theta_2) A(z)`
is still to be done. On 60 strips of pair b, 8, 14 and 22 % of the work at RH 0.44, 0.67 and 0.92 follow after slow
separation has ended; without them the ratio of the energies would be that much smaller. The largest force has no such
order in general. A sphere R on a flat has :math:`V = \pi R (h^2 - D^2)`, the same pull-off and twice the work; two
flats at d₀ have :math:`F d^2` constant.

ASSUME: the tension grows no further where water that flows into opening gaps becomes thinner than `THINNEST`, which is
no liquid. Water thus pulls on no wetted area harder than on flats flooded by the thinnest film. Steep summits on few
points of the grid can rest with hardly any water beside them: of 5000 patches of 2 x 2 µm of pair c, 9 would hold 3 to
140 times their slow force at RH 0.3. There this bound lowers the force of 10 % of the patches of pair c and 1 % of pair
b, at RH 0.44 of 0.5 % and none, and at RH 0.67 of none.

ASSUME: solids attract each other across gaps as in the film of equilibrium. Menisci are those of a contact at rest: one
that was pressed harder holds more water. Where adsorbed water makes the film higher, tension times height stays as it
is at rest.
"""

import numpy as np

from stiction.constants import WATER_MOLECULE
from stiction.contact.air import MOLECULES
from stiction.contact.forcelaw import limit_distance, resists
from stiction.kernels import kernel

#: Height of the thinnest water with the tension of a liquid [m].
THINNEST = MOLECULES * WATER_MOLECULE


@kernel
def _above(bearing, beyond, position):
    """Bearing area at a position, in steps from its first node, and its integral from there on [steps]."""
    if position <= 0:
        return bearing[0], beyond[0] - position * bearing[0]
    k = int(position)
    if k >= bearing.size - 1:
        return 0.0, 0.0
    fraction = position - k
    area = bearing[k] + fraction * (bearing[k + 1] - bearing[k])
    return area, beyond[k] - 0.5 * fraction * (bearing[k] + area)


@kernel
def _keep_volume(bearing, beyond, distance, equilibrium, water, force):
    """Replace the water of equilibrium in a ``force`` beyond its distance by one of constant volume.

    Lengths are in steps from the first node of the bearing area, on whose nodes the distances are. Water has a height
    and a tension in equilibrium, and a height at which its tension is largest. Returns the area wetted at the last
    distance.
    """
    height, tension, thinnest = water
    area, above = _above(bearing, beyond, equilibrium - height)
    volume = height * area - above + _above(bearing, beyond, equilibrium)[1]
    k = max(int(equilibrium - height), 0)
    for i in range(distance.size):
        d = distance[i]
        if d <= equilibrium or volume <= 0:
            continue
        force[i] += tension * _above(bearing, beyond, d - height)[0]
        filled = volume - _above(bearing, beyond, d)[1]
        # The volume over a level z falls as z rises, and the level of constant volume rises with d.
        while k + 2 < bearing.size and k + 1 < d and (d - k - 1) * bearing[k + 1] - beyond[k + 1] >= filled:
            k += 1
        fall = bearing[k] - bearing[k + 1]
        # Within a step: fall t² / 2 - (d - k) fall t + excess = 0.
        excess = (d - k) * bearing[k] - beyond[k] - filled
        root = np.sqrt(max((d - k) ** 2 - 2 * excess / fall, 0.0)) if fall > 0 else d - k
        within = min(max(2 * excess / fall / (d - k + root), 0.0), 1.0) if fall > 0 else 0.0
        area = bearing[k] - fall * within
        force[i] -= tension * height * area / max(d - k - within, thinnest)
    return area


def keep_volume(
    force: np.ndarray,
    distance: np.ndarray,
    bearing: np.ndarray,
    first: float,
    layer: tuple[float, float],
) -> tuple[np.ndarray, float] | None:
    """Force of a fast separation from a slow one's, and the work left to the water beyond the distances.

    Parameters
    ----------
    force : (n_d,) array
        Slow separation of one sample [Pa].
    distance : (n_d,) array
        Uniform grid, on the nodes of the bearing area [m].
    bearing : (n_b,) array
        Bearing area, zero at its last node [-].
    first : float
        Height at its first node [m].
    layer : tuple of 2 floats
        Height h_C [m] and tension [Pa] of the water in equilibrium.

    Returns
    -------
    tuple or None
        Force (n_d,) [Pa] and work [J m⁻²]; ``None`` if the surfaces do not resist the adhesion: they come to no rest.
    """
    if not resists(force):
        return None
    step, areas, fast = distance[1] - distance[0], bearing.astype(float), force.astype(float)
    beyond = np.append(np.cumsum((0.5 * (areas[1:] + areas[:-1]))[::-1])[::-1], 0.0)
    equilibrium = (limit_distance(distance, fast, 0.0) - first) / step
    water = layer[0] / step, layer[1], THINNEST / step
    wetted = _keep_volume(areas, beyond, (distance - first) / step, equilibrium, water, fast)
    return fast, float(layer[0] * layer[1] * wetted)
