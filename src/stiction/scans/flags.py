"""Sentences on all limits of the estimate of a surface from its scans.

Each function takes a `stiction.scans.estimate.SurfaceEstimate` and returns its sentence, which is empty if all is well.
"""

from typing import Any

import numpy as np
from scipy.special import chdtrc

from stiction.rounding import in_percent
from stiction.scans import periodogram as spectra
from stiction.scans.inspection import FEWEST_WAVELENGTHS
from stiction.scans.levelling import LEVELS

#: Wavelengths of the corner along a scan from which errors are reliable.
ENOUGH_WAVELENGTHS = 10
#: Limits: error by tiles over that of the closed form, sector ratio, p, step between lines over step along them, and
#: difference of the summits in standard errors.
_TILES, _ANISOTROPY, UNLIKELY, _JUMP, _SUMMITS = 2.0, 1.5, 0.01, 2.0, 4.0
#: Relative difference of summits from which two digits show it [-].
_ALIKE = 0.05
#: Names of the moments, and a factor of an error that is worth a flag.
_MOMENTS, _WIDER = ("rms", "skewness", "kurtosis"), 1.1
#: Quantities with errors at other places, and their growth that is worth a flag.
_QUANTITIES, _ELSEWHERE = (*_MOMENTS, "corner", "slope"), 1.5
#: Ratio of the spectra of scans of different sizes that is worth a flag.
_STEP = 1.1
#: Change of a moment by noise in standard errors that is worth a flag.
_NOISE = 0.1
#: Difference of the largest and the smallest of 8 normal values that is exceeded with the probability 0.01, in standard
#: deviations (studentized range).
_RANGE_OF_SECTORS = 4.99


def by_kind(estimate: Any) -> dict[str, str]:
    """Sentences on an estimate by the kind of their limit, the most serious causes first."""
    return {flag.__name__[1:]: sentence for flag in _FLAGS if (sentence := flag(estimate))}


def infeasible(estimate: Any) -> str:
    """Name the measured moments without a maximum-entropy density."""
    _, skewness, kurtosis = estimate.moments
    return f"skewness {skewness:.3g} with kurtosis {kurtosis:.3g} has no maximum-entropy density"


def _no_plateau(estimate):
    inspection = estimate.inspection
    number, side = inspection.wavelengths, 1e6 * min(inspection.largest.frame.size)
    if number >= FEWEST_WAVELENGTHS:
        return ""
    return (
        f"the scans show no plateau of the spectrum: {number:.2g} wavelengths of its corner fit into {side:.3g} µm, "
        f"{FEWEST_WAVELENGTHS} are needed, as on a side of {FEWEST_WAVELENGTHS * side / number:.2g} µm or more. Longer "
        "waves are left out, so that surfaces are too smooth and stick more, the safe side; skewness and kurtosis are "
        "hardly known"
    )


def _few_wavelengths(estimate):
    number = estimate.inspection.wavelengths
    if FEWEST_WAVELENGTHS <= number < ENOUGH_WAVELENGTHS:
        return f"only {number:.2g} wavelengths of the corner fit into the scan; errors are reliable from 10 on"
    return ""


def _not_homogeneous(estimate):
    ratio = np.max(estimate.tile_errors / estimate.closed_form_errors)
    if ratio > _TILES:
        reason = "bow, particles or marks"
        return f"parts of a scan differ {ratio:.2g} times as much as those of one homogeneous surface ({reason})"
    return ""


def _bowed(estimate):
    inspection = estimate.inspection
    left = [remainder for remainder in inspection.remainders if remainder.likely < UNLIKELY]
    if not left:
        return ""
    size = left[-1].rms / np.exp(inspection.moments[0])
    shape = "tilt" if LEVELS[left[-1].level] == 1 else "bow"
    left_over = f"levelling leaves a {shape} of {size:.2g} rms (p {left[-1].likely:.1g})"
    return f"{left_over}, which counts as roughness, the unsafe side; level: {left[-1].level} removes it"


def _holes(estimate):
    inspection = estimate.inspection
    parts = [maps.part_in_words for maps in inspection.sizes if maps.complete_frame.shape != maps.frame.shape]
    share = f"{in_percent(inspection.filled_share)} of the points"
    if parts:
        return (
            f"{share} are undefined: moments are those of the others, and the spectrum is that of the largest part "
            f"without wide holes, {' and '.join(parts)}; if holes are steep or deep places, rms and skewness err"
        )
    return f"{share} were undefined and are filled from their neighbours" if inspection.filled_share else ""


def _scans_differ(estimate):
    likely = estimate.homogeneity[1]
    names = [name for name, p in zip(_MOMENTS, likely, strict=True) if p < UNLIKELY]
    return f"the scans differ in {', '.join(names)} by more than their errors" if names else ""


def _places_differ(estimate):
    grown = [
        f"{name} × {ratio:.2g}" for name, ratio in zip(_QUANTITIES, estimate.places, strict=True) if ratio > _ELSEWHERE
    ]
    if not grown:
        return ""
    vary = "the scans vary more than one homogeneous surface would"
    return f"places may differ: {vary}, errors are those of another place ({', '.join(grown)})"


def _sizes_differ(estimate):
    """Disagreement of scans of different sizes as of several surfaces."""
    likely = estimate.agreement[1]
    names = [name for name, p in zip(_MOMENTS, likely, strict=True) if p < UNLIKELY]
    sizes = " and of ".join(maps.size for maps in estimate.inspection.counted)
    return f"scans of {sizes} differ in {', '.join(names)} by more than their errors" if names else ""


def _spectra_differ(estimate):
    steps = [
        f"scans of {second.size} have {ratio:.2g} times the spectrum of those of {first.size} where both resolve it"
        for first, second, ratio, error in estimate.inspection.spectral_steps
        if chdtrc(1, ((ratio - 1) / error) ** 2) < UNLIKELY and not 1 / _STEP < ratio < _STEP
    ]
    return "; ".join(steps)


def _small_scans(estimate):
    inspection = estimate.inspection
    small = [maps.size for maps in inspection.sizes[len(inspection.counted) :]]
    return f"scans of {', '.join(small)} show no plateau and count for the spectrum only" if small else ""


def _spectrum_misfits(estimate):
    fit = estimate.inspection.fit
    if fit.contradicted:
        reason = "the measured spectrum is used instead, as with psd: tabulated"
        return f"the spectrum is not of the form of Eq. (7) (chi²/dof {fit.misfit:.2g}); {reason}"
    return ""


def _noise(estimate):
    """White noise with a change of the moments above a small part of their errors."""
    noisy = [maps for maps in estimate.inspection.counted if np.any(_by_noise(maps) > _NOISE * estimate.errors)]
    if not noisy:
        return ""
    levels = " and ".join(
        f"{_in_scans(maps, maps.floor)}, {in_percent(_share(maps))} of their variance," for maps in noisy
    )
    return (
        f"white noise of {levels} is subtracted from rms, skewness, kurtosis and spectrum, not from heights: measured"
    )


def _noise_stays(estimate):
    """Floor in the heights like noise, which stays there."""
    levels = [_in_scans(maps, maps.floor_left) for maps in estimate.inspection.sizes if maps.floor_left.density > 0]
    if not levels:
        return ""
    return (
        f"a floor of the spectrum like white noise of {' and '.join(levels)} is not subtracted, because no heights "
        "have the remaining moments; if it is noise, the surface is smoother than computed and sticks more"
    )


def _in_scans(maps, floor):
    """Rms of noise in words."""
    return f"{1e9 * np.sqrt(floor.variance(maps.frame.pixel)[0]):.2g} nm in scans of {maps.size}"


def _share(maps):
    """Share of noise in the variance of scans [-]."""
    return maps.noise**2 / np.exp(2 * maps.noisy_moments[0])


def _by_noise(maps):
    """Change of the moments by white noise, (3,)."""
    return np.abs(maps.noisy_moments - maps.moments)


def _spectrum_ends(estimate):
    within = estimate.inspection.reach
    if within.end == within.nyquist or not estimate.inspection.is_resolved:
        return ""
    return (
        f"beyond {1e-6 * within.end:.3g} rad/µm the scans show less than half of the power law: either surface or "
        "microscope has no shorter waves, or the spectrum becomes steeper; with key beyond: cut these waves are left "
        "out"
    )


def _power_law_is_not_resolved(estimate):
    inspection = estimate.inspection
    if inspection.is_resolved:
        return ""
    pixel, within = 1e9 * np.pi / inspection.reach.nyquist, inspection.reach
    return (
        f"pixels of {pixel:.3g} nm do not resolve the power law of the spectrum, which falls by less than half up to "
        f"{1e-6 * within.high:.3g} rad/µm: corner and slope are not measured; roughness beyond {1e-6 * within.end:.3g} "
        "rad/µm is left out, so that surfaces are too smooth and stick more, the safe side"
    )


def _anisotropic(estimate):
    ratio = estimate.sectors.max() / estimate.sectors.min()
    if not np.log(ratio) > max(np.log(_ANISOTROPY), _RANGE_OF_SECTORS * estimate.sector_errors.max()):
        return ""
    width = 180 / spectra.SECTORS
    direction = (np.argmax(estimate.sectors) + 0.5) * width
    return (
        f"the spectrum is {ratio:.2g} times as large at {direction:.0f}° to the fast axis as in the weakest direction"
    )


def _moments_have_no_density(estimate):
    if estimate.feasible is None:
        return f"{infeasible(estimate)}, nor have others within their errors; the measured density is used instead"
    if estimate.feasible.distance > 0:
        near = f"skewness {estimate.feasible.skewness:.3g} with kurtosis {estimate.feasible.kurtosis:.3g}"
        return (
            f"{infeasible(estimate)}; {near}, which is {estimate.feasible.distance:.2g} standard errors away, is used"
        )
    return ""


def _moments_do_not_describe(estimate):
    distance, likely = estimate.goodness
    if likely < UNLIKELY:
        return f"four moments do not describe the heights (T² {distance:.3g}, p {likely:.1g}); heights: measured does"
    return ""


def _errors_are_wider(estimate):
    ratio = estimate.errors / estimate.places[:3] / estimate.closed_form_errors
    names = [name for name, r in zip(_MOMENTS, ratio, strict=True) if r > _WIDER]
    if not names:
        return ""
    return f"errors of {', '.join(names)} are those by tiles, up to {ratio.max():.2g} times those in closed form"


def _tip_rounds(estimate):
    within = estimate.inspection.reach
    if within.tip < within.nyquist:
        return f"the tip rounds waves shorter than {2e9 * np.pi / within.tip:.3g} nm"
    return ""


def _lines_jump(estimate):
    slow, fast = estimate.line_jump
    if slow > _JUMP * fast:
        steps = f"{1e9 * slow:.2g} nm, against steps of {1e9 * fast:.2g} nm along a line"
        is_levelled = estimate.inspection.settings.levelling.lines != "none"
        remedy = "lines: tilt or bow may level them" if is_levelled else "lines: offset levels them"
        return f"lines jump by {steps}; {remedy}"
    return ""


def _summits_differ(estimate):
    # ASSUME: the spectrum of the model errs as much as the summits of its scans scatter; its rms changes all radii.
    variance = estimate.summit_errors**2 + estimate.model_summit_errors**2 / len(estimate.inspection.finest.names)
    variance[0] += (estimate.errors[0] * estimate.summits[0]) ** 2
    if not np.any(np.abs(estimate.summits - estimate.model_summits) > _SUMMITS * np.sqrt(variance)):
        return ""
    radius, density = ratios = estimate.summits / estimate.model_summits
    if np.all(np.abs(np.log(ratios)) < _ALIKE):
        return ""
    sharper = radius < 1 < density
    reason = "noise, or short waves that the fit does not have" if sharper else "its short waves differ from the scans"
    return f"summits have {radius:.2g} times the radius and {density:.2g} times the density of the model: {reason}"


def _no_summits(estimate):
    if np.isfinite(estimate.summits + estimate.summit_errors).all():
        return ""
    reason = "there are too few" if estimate.inspection.finest.frame.square else "pixels are not square"
    return f"{reason}: summits are not compared"


_FLAGS = (
    _no_plateau,
    _few_wavelengths,
    _bowed,
    _holes,
    _not_homogeneous,
    _scans_differ,
    _sizes_differ,
    _places_differ,
    _spectra_differ,
    _small_scans,
    _power_law_is_not_resolved,
    _spectrum_misfits,
    _noise,
    _noise_stays,
    _spectrum_ends,
    _anisotropic,
    _moments_have_no_density,
    _moments_do_not_describe,
    _errors_are_wider,
    _tip_rounds,
    _lines_jump,
    _summits_differ,
    _no_summits,
)

#: Kinds of all flags.
KINDS = tuple(flag.__name__[1:] for flag in _FLAGS)
