"""Identification of the spectrum from the statistics of the summits (Sec. II-C)."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from stiction.errors import NotConverged
from stiction.estimates import jackknife
from stiction.surface.field import RoughSurface, StripGrid
from stiction.surface.spectrum import CutoffSelfAffine, NayakSummits
from stiction.surface.summits import radius_and_density, summits_per_area
from stiction.surface.translation import TranslationMap, underlying_spectrum

#: Range of the search: exponent of the power law, with its sign reversed, and corner relative to the cut-off [-].
_SLOPES = (1.0, 40.0)
_CORNERS = (0.01, 0.95)
#: Step of both logarithms in a difference quotient: large enough to change many summits.
_STEP = 0.04
#: Change of the logarithms below which the search ends, and largest number of its iterations.
_TOLERANCE, _MAX_EVALUATIONS = 1e-4, 40
#: Plateau of a spectrum before its rms is known [m⁴]: a power of two, by which numbers are multiplied without rounding.
_TRIAL = 2.0**-110


@dataclass(frozen=True)
class SummitTarget:
    """Measured statistics of a surface, at the sampling interval of the microscope."""

    rms: float  #: [m]
    mean_radius: float  #: 1 / mean curvature [m]
    density: float  #: [m⁻²]
    spacing: float  #: of the measured points [m]

    @property
    def cutoff(self) -> float:
        """Cut-off of the spectrum [rad m⁻¹].

        ASSUME: three targets fix three of the four parameters of Eq. (7); the fourth is the Nyquist wave number of the
        microscope, which does not resolve finer roughness.
        """
        return np.pi / self.spacing


@dataclass(frozen=True)
class Identification:
    """Identified spectrum and the statistics of its surfaces, to compare with the target."""

    spectrum: CutoffSelfAffine
    evaluations: int  #: number of spectra whose surfaces were simulated in the search
    mean_radius: float  #: of summits, on surfaces that were not used in the search [m]
    density: float  #: of these summits [m⁻²]
    mean_radius_error: float  #: standard error [m]
    density_error: float  #: standard error [m⁻²]


def identify(
    target: SummitTarget,
    translation: TranslationMap,
    grid: StripGrid,
    rngs: Callable[[], Iterable[np.random.Generator]],
    control: Callable[[], Iterable[np.random.Generator]],
) -> Identification:
    """Fit corner and slope to radius and density of simulated summits. The plateau follows from the rms.

    The surfaces of every trial spectrum are drawn from the same streams, so that the simulated statistics are smooth
    functions of the parameters. If no spectrum of the form of Eq. (7) matches both targets (Sub2), the result is the
    least-squares compromise.

    Parameters
    ----------
    target : SummitTarget
    translation : TranslationMap
    grid : StripGrid
        Patch of surface, without margin; the spacing of the target is a multiple of its spacing.
    rngs, control : callable
        Return the streams of the patches, one per patch and the same at every call: ``rngs`` those of the search,
        ``control`` at least two others, on which the result is tested.

    Raises
    ------
    NotConverged
        If the search does not converge.
    ValueError
        If no patch of a trial has a summit.
    """

    def simulated(parameters, streams):
        """Number and curvature of summits per area of simulated surfaces, by stream."""
        underlying, _ = underlying_spectrum(_spectrum(parameters, target), translation, grid.spacing, points=512)
        surface = RoughSurface(underlying, translation, target.rms, grid)
        return _summits_per_area(surface, target.spacing, streams)

    misfits = {}

    def misfit(parameters):
        """Logarithm of radius and density over their targets (2,)."""
        key = tuple(parameters)
        if key not in misfits:
            radius, density = radius_and_density(simulated(parameters, rngs()).mean(axis=0))
            misfits[key] = np.log([radius / target.mean_radius, density / target.density])
        return misfits[key]

    def slopes(parameters):
        """Derivatives of the misfit by the parameters (2, 2), as differences."""
        ahead = [misfit(parameters + step) for step in _STEP * np.eye(2)]
        return (np.transpose(ahead) - misfit(parameters)[:, None]) / _STEP

    bounds = np.log([_CORNERS, _SLOPES]).T
    fit = least_squares(misfit, _start(target), slopes, bounds, xtol=_TOLERANCE, max_nfev=_MAX_EVALUATIONS)
    if not fit.success:
        raise NotConverged("identified spectrum, gradient of the misfit", fit.optimality, _TOLERANCE, fit.nfev)
    values, errors = jackknife(radius_and_density, simulated(fit.x, control()))
    return Identification(_spectrum(fit.x, target), len(misfits), *map(float, (*values, *errors)))


def estimated_spectrum(target: SummitTarget) -> CutoffSelfAffine:
    """Spectrum at the start of the search. Its correlation length is at most 1.5 times the result's."""
    return _spectrum(_start(target), target)


def _spectrum(parameters, target):
    """Eq. (7) with (ln of corner / cut-off, ln -slope) and the rms and cut-off of the target."""
    corner, slope = np.exp(parameters) * [target.cutoff, 1.0]
    floor = (target.cutoff / corner) ** -slope
    shape = CutoffSelfAffine(_TRIAL, floor * _TRIAL, corner, target.cutoff)
    plateau = target.rms**2 / (shape.variance / _TRIAL)
    return CutoffSelfAffine(plateau, floor * plateau, corner, target.cutoff)


def _start(target):
    """Point of a coarse lattice with summits on a continuous Gaussian surface (Nayak) closest to the target."""
    corners, slopes = (np.log(np.geomspace(*ends, 30)[1:-1]) for ends in (_CORNERS, _SLOPES))
    lattice = [(corner, slope) for corner in corners for slope in slopes]

    def distance(parameters):
        """Distance of ln radius and ln density of Nayak's summits from the target."""
        summits = NayakSummits(_spectrum(parameters, target))
        misfit = np.log([summits.mean_curvature * target.mean_radius, summits.density / target.density])
        return np.hypot(*misfit)

    return np.array(min(lattice, key=distance))


def _summits_per_area(surface, spacing, streams):
    """Number and total curvature of the summits per area of every patch, (patches, 2) [m⁻²], [m⁻³]."""
    every = round(spacing / surface.grid.spacing)
    rows = []
    for rng in streams:
        rows.append(summits_per_area(surface.draw(rng)[::every, ::every], spacing))
    if not np.any(rows):
        raise ValueError("no patch has a summit: increase identification.patch_um or decrease character.spacing_nm")
    return np.array(rows)
