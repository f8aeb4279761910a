"""From spectra to crack lengths with public libraries alone, as their user would write it.

SurfaceTopography draws Gaussian surfaces, ContactMechanics presses them, OpenTURNS has the density of the parameters of
force curves, and scipy releases beams.

ASSUME: a film pulls where the gaps of the contact without it are narrower, and deforms nothing. A beam creeps to its
equilibrium, with a friction that only sets the time.
"""

from dataclasses import dataclass

import ContactMechanics
import numpy as np
import openturns
import SurfaceTopography
from scipy.integrate import solve_ivp
from scipy.interpolate import PchipInterpolator
from SurfaceTopography.Generation import fourier_synthesis

from stiction.beam.cantilever import Beam
from stiction.surface.spectrum import CutoffSelfAffine

#: Mean pressures of the contact [Pa], from high to low, and points of a curve between them.
PRESSURES, FINE = np.geomspace(1e8, 1e4, 9), 2000
#: Time at which beams have long stopped, in that in which the film alone would close a gap of its height.
END = 1e12


def drawn(spectra: list[CutoffSelfAffine], points: tuple[int, int], spacing: float, seed: int) -> np.ndarray:
    """Sum of one surface of each spectrum (n1, n2) [m]. The library's spectra are 4 π² times ours."""
    sides, rng = tuple(n * spacing for n in points), np.random.default_rng(seed)
    each = (
        fourier_synthesis(points, sides, psd=lambda q, of=of: 4 * np.pi**2 * of(q), rng=rng, progress_callback=_quiet)
        for of in spectra
    )
    return sum(surface.heights() for surface in each)


def _quiet(*_):
    """Show no progress."""


@dataclass(frozen=True)
class Patch:
    """Patch of two surfaces under a film."""

    points: tuple[int, int]  #: of its grid
    spacing: float  #: [m]
    modulus: float  #: E' [Pa]
    film: tuple[float, float]  #: height [m] and tension [Pa]

    def curve(self, heights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Distances of the mean planes [m] and forces [Pa], positive in repulsion, of heights (n1, n2) [m]."""
        sides = tuple(n * self.spacing for n in self.points)
        surface = SurfaceTopography.Topography(heights, sides, periodic=True)
        half_space = ContactMechanics.PeriodicFFTElasticHalfSpace(self.points, self.modulus, sides)
        system = ContactMechanics.make_system(substrate=half_space, surface=surface)
        states = [self._pressed(system, heights, pressure) for pressure in PRESSURES]
        last, flat = states[-1][0], heights - heights.mean()
        apart = np.linspace(last, flat.max() + self.film[0], len(PRESSURES))[1:]
        distance, force = np.array(states + [(d, -self._pull(d - flat)) for d in apart]).T
        fine = np.linspace(distance[0], distance[-1], FINE)
        return fine, PchipInterpolator(distance, force)(fine)

    def _pressed(self, system, heights, pressure):
        """Distance and force of the contact at a mean pressure."""
        area = np.prod(self.points) * self.spacing**2
        found = system.minimize_proxy(external_force=pressure * area, pentol=2e-12)
        gap = system.disp[: self.points[0], : self.points[1]] - heights
        gap -= gap[found.jac > 0].mean()
        return float(gap.mean()), pressure - self._pull(gap)

    def _pull(self, gap):
        """Attraction of the film at gaps (n1, n2) [Pa]."""
        height, tension = self.film
        return tension * np.mean(gap < height)


def vectors(curves: list[tuple[np.ndarray, np.ndarray]]) -> tuple[np.ndarray, float]:
    """Rows e [J m⁻²], f_max [Pa], d_max and d_limit [m] of curves (n, 4), and f_limit, the largest f_max [Pa]."""
    limit = max(-force.min() for _, force in curves)
    return np.array([_vector(*curve, limit) for curve in curves]), limit


def _vector(distance, force, limit):
    """Row of `vectors`."""
    lowest = force.argmin()
    first, before = (np.flatnonzero(force[:lowest] >= level)[-1] for level in (0, limit))
    energy = np.trapezoid(np.maximum(-force[first:], 0), distance[first:])
    return energy, -force[lowest], distance[lowest], distance[before]


def laws(rows: np.ndarray, limit: float, number: int) -> np.ndarray:
    """Force laws of Eq. (12) of draws of the density of rows of `vectors` (number, 4), without those that have no law.

    Kernels are on the principal coordinates of ln e, ln f_max, d_max and ln(d_max - d_limit), whose variances stay.
    """
    e, largest, at, left = rows.T
    sample = np.column_stack([np.log(e), np.log(largest), at, np.log(at - left)])
    scale, mean = sample.std(axis=0), sample.mean(axis=0)
    variances, axes = np.linalg.eigh(np.corrcoef(sample.T))
    coordinates = (sample - mean) / scale @ axes / np.sqrt(variances)
    draws = np.array(openturns.KernelSmoothing().build(coordinates).getSample(2 * number))
    draws = mean + draws / draws.std(axis=0) * np.sqrt(variances) @ axes.T * scale
    (e, largest, span), at = np.exp(draws[:, [0, 1, 3]]).T, draws[:, 2]
    before = np.log(1 + np.sqrt(1 + limit / largest)) / span
    rest = e / largest - 0.5 / before
    is_lawful = rest > 0
    return np.column_stack([largest, at, before, 1.5 / np.where(is_lawful, rest, 1)])[is_lawful][:number]


def attraction(law: np.ndarray, distance: np.ndarray) -> np.ndarray:
    """Attraction at distances by force laws, Eq. (12) [Pa]. A law (4,), or one of each distance (n, 4)."""
    largest, at, before, beyond = law.T
    rate = np.where(distance < at, before, beyond)
    e = np.exp(-np.clip(rate * (distance - at), -20, 60))
    return largest * e * (2 - e)


def crack(beam: Beam, along: np.ndarray) -> float:
    """Length over which a cantilever does not touch after it was released, with force laws (n, 4) along it [m].

    Finite differences: clamped at 0, free at the end, and one law at each point. No place arrests its first crack.
    """
    largest, at, before, beyond = along.T
    x, step = np.linspace(0, beam.length, len(along) + 1)[1:], beam.length / len(along)
    stiffness, energy = beam.bending_stiffness / beam.width, np.max(largest * (1.5 / beyond + 0.5 / before))
    s = np.minimum(x / (0.7 * (18 * stiffness * beam.gap**2 / energy) ** 0.25), 1)

    friction = at.mean() / largest.mean()

    def rate(_, u):
        with_ends = np.concatenate([[u[0], 0], u, [2 * u[-1] - u[-2], 3 * u[-1] - 2 * u[-2]]])
        bend = np.convolve(with_ends, [1, -4, 6, -4, 1], "valid")
        return (attraction(along, beam.gap - u) - stiffness / step**4 * bend) * friction

    start = (beam.gap - max(at - 0.5 / before)) * s**2 * (3 - 2 * s)
    end = solve_ivp(rate, (0, END), start, "LSODA", [END], lband=2, uband=2, rtol=1e-6, atol=1e-5 * at.mean()).y[:, 0]
    touches = beam.gap - end < at
    return x[touches.argmax()] if touches.any() else beam.length
