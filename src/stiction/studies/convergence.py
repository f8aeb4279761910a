r"""How many samples, polynomials and elements are enough (App. B-C and C).

Distributions are compared by Kolmogorov's distance :math:`D = \sup |F - G|`. The distance of m samples from their own
distribution is a random number, of mean 0.869 / √m: what lies below it cannot be seen with m samples.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr

from stiction.beam.cantilever import EndState, crack_length, end_state, release
from stiction.beam.energy import adhesion_energy, arrest_length
from stiction.beam.montecarlo import START
from stiction.chaos.model import silverman_bandwidth
from stiction.contact.forcelaw import energy

#: Mean and standard deviation of Kolmogorov's limit distribution, √m D of m samples: √(π/2) ln 2, √(π²/12 - mean²).
KOLMOGOROV_MEAN = np.sqrt(np.pi / 2) * np.log(2)
KOLMOGOROV_DEVIATION = np.sqrt(np.pi**2 / 12 - KOLMOGOROV_MEAN**2)


def sampling_distance(samples):
    """Expected distance of ``samples`` independent draws from their distribution [-].

    Examples
    --------
    >>> round(float(sampling_distance(5000)), 4)
    0.0123
    """
    return KOLMOGOROV_MEAN / np.sqrt(samples)


def distance_to(samples, distribution):
    """Kolmogorov's distance of samples (n,) from a continuous distribution function, called with sorted samples [-]."""
    n = len(samples)
    expected = distribution(np.sort(samples))
    return max(np.max(np.arange(1, n + 1) / n - expected), np.max(expected - np.arange(n) / n))


def distance_between(samples, others):
    """Kolmogorov's distance between the empirical distributions of two sets of samples, (n,) and (m,) [-]."""
    at = np.sort(np.concatenate([samples, others]))
    shares = [np.searchsorted(np.sort(s), at, side="right") / len(s) for s in (samples, others)]
    return np.max(np.abs(shares[0] - shares[1]))


def distance_of_parts(samples, size):
    """Mean distance of parts of ``size`` samples from all of them, with its standard error by Kolmogorov's law [-].

    The parts are consecutive and do not overlap; independent samples give 0.869 √(1/size - 1/n).
    """
    parts = [samples[k : k + size] for k in range(0, len(samples) - size + 1, size)]
    if not parts:
        raise ValueError(f"{len(samples)} samples have no part of {size}")
    error = KOLMOGOROV_DEVIATION * np.sqrt((1 / size - 1 / len(samples)) / len(parts))
    return np.mean([distance_between(part, samples) for part in parts]), error


def kernel_distribution(centres, bandwidth, points=2000):
    """Distribution function of equal Gaussian kernels around ``centres`` (m,), linear between ``points`` values."""
    table = np.linspace(centres.min() - 8 * bandwidth, centres.max() + 8 * bandwidth, points)
    values = np.array([ndtr((x - centres) / bandwidth).mean() for x in table])
    return lambda x: np.interp(x, table, values)


def kernel_estimate(samples, at):
    """Density of samples (n,) at given values, by Gaussian kernels of Silverman's width; in 1 / unit of the samples."""
    width = silverman_bandwidth(len(samples), 1) * np.std(samples)
    return np.array([np.exp(-(((x - samples) / width) ** 2) / 2).mean() for x in at]) / (np.sqrt(2 * np.pi) * width)


def converged_order(orders, distances, samples):
    """Smallest order from which on a marginal is no farther off than ``samples`` draws would be; 0 if there is none.

    Parameters
    ----------
    orders : (n,) array
        Increasing.
    distances : (n,) array
        Kolmogorov's distance of the marginal from its target at every order [-].
    samples : int

    Examples
    --------
    >>> converged_order([1, 2, 3, 4], [0.2, 0.01, 0.1, 0.01], 1000)
    4
    """
    far = np.flatnonzero(np.asarray(distances) > sampling_distance(samples))
    first = far[-1] + 1 if len(far) else 0
    return int(orders[first]) if first < len(orders) else 0


@dataclass(frozen=True)
class Arrest:
    """Where the crack of a beam on uniform ground stops."""

    crack_length: float  #: l_s [m]
    energy: float  #: Γ of Eq. (13) [J m⁻²]


def arrest_on_uniform_ground(beam, law, points):
    """Release a beam whose ``points`` contact points all have one law [f_max, d_max, a_left, a_right], Arrest.

    Both numbers are NaN where the beam does not stick in an S-shape.

    Raises
    ------
    ValueError
        If the crack is too short for the elements.
    """
    laws = np.tile(law, (points, 1))
    start = START * min(float(arrest_length(energy(law), beam)), beam.length)
    deflection = release(beam, laws, start).deflection
    if end_state(beam, laws, deflection) != EndState.S_SHAPE:
        return Arrest(np.nan, np.nan)
    crack = crack_length(beam, laws, deflection)
    return Arrest(crack, adhesion_energy(crack, beam))


def whole_meshes(length, element_lengths, point_distances):
    """Pairs (element length, distance of points) [m] that fill each other and a beam of this length [m].

    Raises
    ------
    ValueError
        If there is none.
    """
    pairs = [(element, point) for point in point_distances for element in element_lengths]
    whole = [(e, p) for e, p in pairs if _fills(e, length) and _fills(p, e)]
    if not whole:
        raise ValueError(f"none of the elements {element_lengths} m and points {point_distances} m fill {length} m")
    return whole


def _fills(part, whole):
    """Whether ``whole`` is 1, 2, 3 ... times ``part`` but for rounding."""
    return np.isclose(whole / part, max(1, round(whole / part)), rtol=1e-9)
