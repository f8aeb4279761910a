"""The beam of the paper, force laws of the size of pair b, and the bending energy of a deflection."""

import numpy as np

from stiction.beam.cantilever import Beam
from stiction.contact import forcelaw

PAPER = Beam(1500e-6, 30e-6, 2.6e-6, 164e9, 20e-6, 200)
E_BAR = 6.8e-3


def uniform_laws(points, energy=E_BAR, f_max=2e6, reach=1.0):
    """The same law at every point, of the size of pair b's; ``reach`` scales its distances at constant energy."""
    vector = np.array([[energy, f_max / reach, 8e-9 * reach, 6.5e-9 * reach]])
    return np.repeat(forcelaw.coefficients(vector, 2 * f_max / reach), points, axis=0)


def lognormal(rng, mean, variation, n):
    spread = np.sqrt(np.log1p(variation**2))
    return mean * np.exp(spread * rng.standard_normal(n) - spread**2 / 2)


def scattered_laws(rng, points, variation, energy=7e-3, f_max=2e6):
    """Independent laws whose energies have the coefficient of variation ``variation``."""
    e = lognormal(rng, energy, variation, points)
    f = f_max * (e / energy) ** 0.9 * lognormal(rng, 1, 0.05, points)
    d_max = 8e-9 + 1e-9 * min(1, 2 * variation) * rng.standard_normal(points)
    vectors = np.stack([e, f, d_max, d_max - lognormal(rng, 1.5e-9, 0.1, points)], axis=-1)
    return forcelaw.coefficients(vectors, f.max())


def bending_energy(beam, deflection):
    """∫ EI u''² / 2, exact for cubics by two Gauss points in each element [J]."""
    s = 0.5 + np.array([-1, 1]) / np.sqrt(12)
    curvature = np.stack([12 * s - 6, 6 * s - 4, 6 - 12 * s, 6 * s - 2], axis=-1) / beam.element_length**2
    ends = deflection * [1, beam.element_length]
    bend = np.hstack([ends[:-1], ends[1:]]) @ curvature.T
    return beam.bending_stiffness * beam.element_length / 4 * np.sum(bend**2)
