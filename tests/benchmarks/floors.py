"""Floors of the stages: work that the same algorithm with the same random numbers cannot avoid.

Each function does this work and nothing else, compiled, on numbers of the same size. It leaves out what a stage does
besides: a stage close to its floor cannot become much faster without other results.
"""

from math import comb
from unittest import mock

import numpy as np
from numba import njit
from scipy import fft

from stiction.beam import equilibrium
from stiction.beam.montecarlo import simulate
from stiction.chaos.polynomials import MAX_ORDER, NODES, legendre
from stiction.surface.normals import standard_normal

#: Force laws summed at a time, few enough that their polynomials stay in the first-level cache.
_BLOCK = 64


def surface(rough, rng):
    """One rough surface: its normal numbers and its inverse FFTs, of input that is not copied."""
    _, amplitude, columns = rough.modes
    grid = rough.grid
    standard_normal(rng, 2 * len(amplitude))
    waves = np.zeros((columns, grid.field_shape[0]), np.complex64)
    fft.ifft(waves, axis=1, overwrite_x=True)
    waves = np.zeros((grid.shape[0], grid.field_shape[1] // 2 + 1), np.complex64)
    fft.irfft(waves, n=grid.field_shape[1], axis=1)


def forces(contact, film):
    """Force curves of all samples: every stored pressure and area that counts read once, and the water added."""
    solid, bearing, (begin, lowest), step = contact
    height, tension = film
    first = max(int((begin - height - lowest) / step), 0)
    _add_water(solid, bearing[:, first:], tension, np.zeros(solid.shape[1] + bearing.shape[1]))


@njit
def _add_water(solid, bearing, tension, force):
    for k in range(len(solid)):
        for i in range(bearing.shape[1]):
            force[i] = -tension * bearing[k, i]
        for i in range(solid.shape[1]):
            force[i] += solid[k, i]


def chaos(samples, dimension):
    """Chaos model: one exponential for every sample in every conditional density of the coordinates."""
    _exponentials(sum(NODES**k for k in range(dimension)), np.linspace(0, 40, samples), np.empty(samples))


@njit
def _exponentials(densities, squares, weights):
    for _ in range(densities):
        for i in range(squares.size):
            weights[i] = np.exp(-0.5 * squares[i])


def laws(model, number, rng):
    """Force laws of a model of order MAX_ORDER.

    Their uniform numbers, the Legendre polynomials, and one multiply-add per law and term of Eq. (19).
    """
    xi = rng.random((model.dimension, number))
    terms = np.array([comb(MAX_ORDER + k, k) for k in range(1, model.dimension + 1)])
    _sums(xi, terms, model.coefficients, np.empty((MAX_ORDER + 1, _BLOCK)))


@njit(fastmath={"contract"})
def _sums(xi, terms, coefficients, values):
    eta = np.empty(_BLOCK)
    for start in range(0, xi.shape[1], _BLOCK):
        for k in range(len(terms)):
            part = xi[k, start : start + _BLOCK]
            legendre(part, values[:, : part.size])
            eta[:] = 0.0
            for n in range(0, terms[k] - 3, 4):  # four terms at a time: the sum is written once for all of them
                c = coefficients[k, n : n + 4]
                for i in range(_BLOCK):
                    eta[i] += c[0] * values[0, i] + c[1] * values[1, i] + c[2] * values[2, i] + c[3] * values[3, i]


def beams(steps, size):
    """Releases of beams: in each Newton step, an exponential per point in reach and the solution of the banded system.

    ``steps`` are from `newton_steps`, ``size`` is the largest number of points and of rows.
    """
    band, force = np.empty((size + 3, 4)), np.empty(size + 3)
    _newton(steps, np.linspace(-1, 5, size), np.empty(size), np.array([7.0, -4.0, 1.0, 0.0]), band, force)


@njit
def _newton(steps, stretch, decay, stencil, band, force):
    for n in range(len(steps)):
        points, rows = steps[n, 0], steps[n, 1]
        for p in range(points):
            decay[p] = np.exp(-stretch[p])
        for i in range(rows + 3):
            force[i] = 1.0
            for k in range(4):
                band[i, k] = stencil[k]
        equilibrium.solve(band, force, 0, rows)


def newton_steps(experiment, numbers, stream):
    """Points in reach of their laws and rows of the system in each Newton step of these beams, (steps, 2)."""
    steps, assemble = [], equilibrium._assemble

    def recorded(u, laws, system, mesh, window, viscosity):
        residual = assemble(u, laws, system, mesh, window, viscosity)
        first, last = (mesh.points_per_element * element for element in window)
        reached = np.count_nonzero(system.stretch[first:last] < equilibrium.REACH)
        steps.append((reached, 2 * (window[1] - window[0] + 1)))
        return residual

    # Interpreted, so that the compiled function that assembles a step can be replaced.
    with mock.patch.multiple(equilibrium, _relax=equilibrium._relax.py_func, _assemble=recorded):
        list(simulate(experiment, numbers, stream))
    return np.array(steps)
