"""Identification of the spectrum from the statistics of the summits (Sec. II-C)."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from stiction.errors import NotConverged
from stiction.estimates import jackknife
from stiction.surface.field import RoughSurface
from stiction.surface.spectrum import CutoffSelfAffine, NayakSummits
from stiction.surface.summits import find_summits
from stiction.surface.translation import underlying_spectrum

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
    evaluations: int
    mean_radius: float  #: of the summits of surfaces that were not used in the search [m]
    density: float  #: of these summits [m⁻²]
    mean_radius_error: float  #: standard error [m]
    density_error: float  #: standard error [m⁻²]


def identify(target, translation, grid, rngs, control):
    """Fit corner and slope to radius and density of simulated summits; the plateau follows from the rms.

    Every trial spectrum draws its surfaces from the same streams, so the simulated statistics are smooth functions of
    the parameters. Where no spectrum of the form of Eq. (7) reaches both (Sub2), the result is the best compromise.

    Parameters
    ----------
    target : SummitTarget
    translation : Translation
    grid : StripGrid
        Patch of surface, without margin; its spacing divides that of the target.
    rngs, control : callable
        Make the streams of the patches, one each, the same at every call: those of the search, and others, two at
        least, on which the result is judged.

    Returns
    -------
    Identification

    Raises
    ------
    NotConverged
        If the search does not come to rest.
    """

    def simulated(parameters, streams):
        underlying, _ = underlying_spectrum(_spectrum(parameters, target), translation, grid.spacing, points=512)
        surface = RoughSurface(underlying, translation, target.rms, grid)
        return _summits_per_area(surface, target.spacing, streams)

    def misfit(parameters):
        radius, density = _radius_and_density(simulated(parameters, rngs()).mean(axis=0))
        return np.log([radius / target.mean_radius, density / target.density])

    def slopes(parameters):
        there = [misfit(parameters + step) for step in _STEP * np.eye(2)]
        return (np.transpose(there) - misfit(parameters)[:, None]) / _STEP

    bounds = np.log([_CORNERS, _SLOPES]).T
    fit = least_squares(misfit, _start(target), slopes, bounds, xtol=_TOLERANCE, max_nfev=_MAX_EVALUATIONS)
    if not fit.success:
        raise NotConverged("identified spectrum, gradient of the misfit", fit.optimality, _TOLERANCE, fit.nfev)
    values, errors = jackknife(_radius_and_density, simulated(fit.x, control()))
    return Identification(_spectrum(fit.x, target), fit.nfev, *map(float, (*values, *errors)))


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


def _summits_per_area(surface, spacing, streams):
    """Number and total curvature of the summits per area of every patch, (patches, 2) [m⁻²], [m⁻³]."""
    every = round(spacing / surface.grid.spacing)
    rows = []
    for rng in streams:
        _, curvature, density = find_summits(surface.draw(rng)[::every, ::every], spacing)
        rows.append((density, density * curvature.mean()))
    return np.array(rows)


def _radius_and_density(per_area):
    """Radius 1 / mean curvature [m] and density [m⁻²] from number and total curvature of summits per area, (2,)."""
    density, curvature = per_area
    return np.array([density / curvature, density])
