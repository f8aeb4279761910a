r"""Beam under constant axial tension N: its stiffness, its open part in closed form, its energy release rate.

.. math:: EI u'''' - N u'' = q, \quad k = \sqrt{N / EI}

A bridge, clamped at both ends, that adheres between two cracks is two cantilevers back to back: the part that adheres
is flat and passes on the tension only. ASSUME: the tension is that of the residual stress; stretching by the deflection
is left out. It would open the cracks further, by 3 % if the gap equals the thickness.

The functions are for N > 0. Compiled functions have the unknowns of `stiction.beam.equilibrium`: [u, l_e u'] of every
node.
"""

import numpy as np

from stiction.beam.cantilever import Beam
from stiction.kernels import kernel

#: Below this kL, differences of hyperbolic functions lose digits to rounding. The forces then use their series, and the
#: deflection of the open part, to 1e-5 of the gap, that without tension.
SLACK = 0.03
#: Iterations for the crack length; each at least halves its error, because the coupling grows with kL at most linearly.
_HALVINGS = 60


@kernel
def end_stiffness(kl: float) -> tuple[float, float, float, float]:
    """Stiffness of a beam of length L at its end: force by u, by u', moment by u', and moment at the other end by u'.

    In units of EI/L³, EI/L², EI/L and EI/L; argument kL > 0 [-]. Without tension 12, 6, 4 and 2.

    Examples
    --------
    >>> [round(value, 3) for value in end_stiffness(1e-3)]
    [12.0, 6.0, 4.0, 2.0]
    """
    mean = np.tanh(kl / 2) / (kl / 2)
    force = 12 / (1 - kl**2 / 10 + 17 * kl**4 / 1680) if kl < SLACK else kl**2 / (1 - mean)
    coupling = force * mean / 2
    return force, coupling, coupling / 2 + 1 / mean, coupling / 2 - 1 / mean


@kernel
def add_tension(u: np.ndarray, band: np.ndarray, force: np.ndarray, pull: float, i: int) -> None:
    """Add tension to force and stiffness of the element with unknowns from row ``i``, for ``pull`` = N/l_e [N/m]."""
    n = pull / 30
    band[i, 0] += 36 * n
    band[i, 1] += 3 * n
    band[i, 2] -= 36 * n
    band[i, 3] += 3 * n
    band[i + 1, 0] += 4 * n
    band[i + 1, 1] -= 3 * n
    band[i + 1, 2] -= n
    band[i + 2, 0] += 36 * n
    band[i + 2, 1] -= 3 * n
    band[i + 3, 0] += 4 * n
    fall = u[i] - u[i + 2]
    shear = n * (36 * fall + 3 * (u[i + 1] + u[i + 3]))
    force[i] -= shear
    force[i + 1] -= n * (3 * fall + 4 * u[i + 1] - u[i + 3])
    force[i + 2] += shear
    force[i + 3] -= n * (3 * fall - u[i + 1] + 4 * u[i + 3])


@kernel
def add_open_part_in_tension(
    u: np.ndarray, band: np.ndarray, force: np.ndarray, first: int, kl: float, stiffness: float, load: float
) -> None:
    """Add the beam from the clamp to node ``first``, at kL = ``kl``, as one exact element.

    ``stiffness`` is EI/l_e³ [N/m], ``load`` the uniform load times l_e [N].
    """
    i = 2 * first
    f, c, m, _ = end_stiffness(kl)
    clamping = load * first**2 / (2 * c)
    f, c, m = f * stiffness / first**3, c * stiffness / first**2, m * stiffness / first
    band[i, 0] += f
    band[i, 1] -= c
    band[i + 1, 0] += m
    force[i] += load * first / 2 - f * u[i] + c * u[i + 1]
    force[i + 1] += -clamping + c * u[i] - m * u[i + 1]


@kernel
def fill_open_part_in_tension(u: np.ndarray, first: int, kl: float, stiffness: float, load: float) -> None:
    """Deflect the nodes between the clamp and node ``first``. Parameters as in `add_open_part_in_tension`, kL >= 0.03.

    The deflection is written about the middle of the open part, so that every hyperbolic function is divided by the
    largest one.
    """
    end, slope = u[2 * first], u[2 * first + 1] * first
    top, coth = np.sinh(kl / 2), 1 / np.tanh(kl / 2)
    odd = (slope / 2 - end) / (kl * coth - 2)
    bow = load * first**4 / (2 * stiffness * kl**2)
    for node in range(first):
        y = node / first - 0.5
        sh, ch = np.sinh(kl * y) / top, np.cosh(kl * y) / top
        even = (ch - coth) / kl
        u[2 * node] = end * (0.5 + y) + slope / 2 * even + odd * (sh - 2 * y) + bow * (even + 0.25 - y**2)
        rate = end + slope / 2 * sh + odd * (kl * ch - 2) + bow * (sh - 2 * y)
        u[2 * node + 1] = rate / first


def _coupling(crack, beam):
    """Moment at the end of an S-shape in units of EI h / l², 6 without tension [-]. Crack length l [m], any shape."""
    return np.vectorize(end_stiffness)(beam.decay * crack)[1]


def release_rate(crack_length: float | np.ndarray, beam: Beam) -> float | np.ndarray:
    r"""Energy release rate of an S-shape under tension [J m⁻²]. Crack length s [m], any shape.

    .. math:: G = \frac{M^2}{2 w EI} = \frac{N h^2 \tanh^2 y}{2 w (s - (2/k) \tanh y)^2}, \quad y = \frac{ks}{2},

    with the moment M at the end of the crack. N → 0 gives Eq. (13), :math:`18 EI h^2 / (w s^4)`; high tension gives the
    rate of a string, :math:`N h^2 / (2 w s^2)`.

    Examples
    --------
    >>> bridge = Beam(600e-6, 30e-6, 2e-6, 164e9, 2e-6, 80, tension=200e6 * 30e-6 * 2e-6)
    >>> round(float(release_rate(393.28e-6, bridge)) * 1e3, 3)  # mJ/m²
    6.165
    """
    moment = _coupling(crack_length, beam) * beam.bending_stiffness * beam.gap / crack_length**2
    return moment**2 / (2 * beam.width * beam.bending_stiffness)


def arrest_length(energy: float | np.ndarray, beam: Beam) -> float | np.ndarray:
    """Crack length of an S-shape under tension at the adhesion energy Γ [J m⁻²], inverse of `release_rate`."""
    pull = np.sqrt(2 * beam.width * energy / beam.bending_stiffness) / beam.gap
    crack = np.sqrt(6 / pull)
    for _ in range(_HALVINGS):
        crack = np.sqrt(_coupling(crack, beam) / pull)
    return crack
