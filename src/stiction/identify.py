"""Identification of the spectrum from the statistics of the summits (Sec. II-C)."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from stiction.errors import NotConverged
from stiction.spectrum import CutoffSelfAffine, NayakSummits
from stiction.summits import find_summits
from stiction.surfaces import RoughSurface
from stiction.translation import underlying_spectrum

#: Flattest and steepest power law and lowest corner (as a share of the cut-off) among which is searched.
_SLOPES = (1.0, 40.0)
_CORNERS = (0.01, 0.95)
#: Step of both logarithms in a difference quotient: wide enough that the count of summits changes by many.
_STEP = 0.04
#: Change of the logarithms below which the search ends, and evaluations after which it is given up.
_TOLERANCE, _MAX_EVALUATIONS = 1e-4, 40


@dataclass(frozen=True)
class SummitTarget:
    """What the microscope reported of a surface, at the distance of its points."""

    rms: float  #: [m]
    mean_radius: float  #: 1 / mean curvature [m]
    density: float  #: [m⁻²]
    spacing: float  #: distance of the measured points [m]

    @property
    def cutoff(self):
        """Cut-off of the spectrum [rad m⁻¹].

        ASSUME: three targets fix three of the four parameters of Eq. (7); the fourth is the Nyquist number of the
        microscope, which saw nothing finer.
        """
        return np.pi / self.spacing


@dataclass(frozen=True)
class Identification:
    """The spectrum found and how well its surfaces meet the target."""

    spectrum: CutoffSelfAffine
    mean_radius: float  #: of the simulated summits [m]
    density: float  #: of the simulated summits [m⁻²]
    evaluations: int


def identify(target, translation, grid, rngs):
    """Fit corner and slope to radius and density of simulated summits; the plateau follows from the rms.

    Every trial spectrum draws its surfaces from the same streams, so the simulated statistics are smooth functions of
    the parameters. Where no spectrum of the form of Eq. (7) reaches both (Sub2), the result is the best compromise.

    Parameters
    ----------
    target : SummitTarget
    translation : Translation
    grid : StripGrid
        Patch of surface, without margin; its spacing divides that of the target.
    rngs : callable
        Makes the streams of the patches, one each, the same at every call.

    Returns
    -------
    Identification

    Raises
    ------
    NotConverged
        If the search does not come to rest.
    """
    every = round(target.spacing / grid.spacing)

    def simulated(parameters):
        spectrum = _spectrum(parameters, target)
        underlying, _ = underlying_spectrum(spectrum, translation, grid.spacing, points=512)
        surface = RoughSurface(underlying, translation, target.rms, grid)
        return _summit_statistics((surface.draw(rng)[::every, ::every] for rng in rngs()), target.spacing)

    def misfit(parameters):
        radius, density = simulated(parameters)
        return np.log([radius / target.mean_radius, density / target.density])

    def slopes(parameters):
        there = [misfit(parameters + step) for step in _STEP * np.eye(2)]
        return (np.transpose(there) - misfit(parameters)[:, None]) / _STEP

    bounds = np.log([_CORNERS, _SLOPES]).T
    fit = least_squares(misfit, _start(target), slopes, bounds, xtol=_TOLERANCE, max_nfev=_MAX_EVALUATIONS)
    if not fit.success:
        raise NotConverged("identified spectrum, gradient of the misfit", fit.optimality, _TOLERANCE, fit.nfev)
    radius, density = simulated(fit.x)
    return Identification(_spectrum(fit.x, target), radius, density, fit.nfev)


def _spectrum(parameters, target):
    """Eq. (7) with (ln of corner / cut-off, ln -slope) and the rms and cut-off of the target."""
    corner, slope = np.exp(parameters) * [target.cutoff, 1.0]
    floor = (target.cutoff / corner) ** -slope
    shape = CutoffSelfAffine(1.0, floor, corner, target.cutoff)
    plateau = target.rms**2 / shape.variance
    return CutoffSelfAffine(plateau, floor * plateau, corner, target.cutoff)


def _start(target):
    """Corner and slope, on a coarse lattice, whose continuous Gaussian summits come closest (Nayak)."""
    corners, slopes = (np.log(np.geomspace(*ends, 30)[1:-1]) for ends in (_CORNERS, _SLOPES))
    lattice = [(corner, slope) for corner in corners for slope in slopes]

    def distance(parameters):
        summits = NayakSummits(_spectrum(parameters, target))
        misfit = np.log([summits.mean_curvature * target.mean_radius, summits.density / target.density])
        return np.hypot(*misfit)

    return np.array(min(lattice, key=distance))


def _summit_statistics(patches, spacing):
    """Mean radius 1 / mean curvature [m] and density [m⁻²] of the summits of all patches."""
    found = [find_summits(patch, spacing) for patch in patches]
    curvature = np.concatenate([curvature for _, curvature, _ in found])
    return 1 / curvature.mean(), float(np.mean([density for _, _, density in found]))
