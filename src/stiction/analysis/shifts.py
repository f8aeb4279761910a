r"""Surface with one of its quantities slightly decreased and increased, for slopes with common random numbers.

The quantities are those that a measurement of a surface determines: ln rms and form of the heights, and ln corner and
slope of its spectrum. The form of maximum-entropy heights is given by skewness and kurtosis. That of measured heights
has modes: the mean over a scan of the Hermite polynomial h_k of the Gaussian field is 0 on the surface; if it is x_k on
the scan, the measured heights are, to first order,

.. math:: z(u + x_k \, h_{k-1}(u) / \sqrt{k}) .

The plateau of the spectrum is not among the quantities, because the rms alone sets the heights. The cut-off stays: a
changed one would renumber the waves, so that both surfaces would not have the same random numbers any more.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import factorial

import numpy as np
from scipy.special import eval_hermitenorm

from stiction.models import FAR_QUANTITIES, MODE_QUANTITIES, MOMENT_QUANTITIES, SPECTRUM_QUANTITIES
from stiction.surface import self_affine
from stiction.surface.empirical import MeasuredDensity
from stiction.surface.feasible import largest_kurtosis, least_kurtosis
from stiction.surface.spectrum import CutoffSelfAffine, Spectrum

#: Orders k of the modes. ASSUME: higher ones change only heights beyond those that touch or that a scan determines.
ORDERS = [int(name.removeprefix("mode")) for name in MODE_QUANTITIES[1:]]
#: Steps of the central differences in either direction; those of rms and corner are logarithmic.
STEPS = {"rms": 0.05, "skewness": 0.04, "kurtosis": 0.15, "corner": 0.05, "slope": 0.1}
STEPS |= dict.fromkeys(MODE_QUANTITIES[1:], 0.02)


@dataclass(frozen=True)
class Description:
    """Heights and spectrum of a surface."""

    rms: float  #: [m]
    skewness: float  #: [-]
    kurtosis: float  #: [-]
    spectrum: Spectrum  #: of the heights, used up to a factor
    form: MeasuredDensity | None = None  #: of the heights, maximum entropy of the moments by default

    @property
    def quantities(self) -> tuple[str, ...]:
        """Names of the quantities, keys of `STEPS`."""
        return (MOMENT_QUANTITIES if self.form is None else MODE_QUANTITIES) + SPECTRUM_QUANTITIES


#: Largest step of ln rms [-]. ASSUME: rougher surfaces may hold no device, so that a slope by them is not known.
FARTHEST_RMS = 0.3


def step_of(surface: Description, quantity: str, deviation: float) -> float:
    """Step of a quantity in either direction: its standard uncertainty, if that is larger than its step of `STEPS`.

    A slope over a small step says little about a large error. ASSUME: where no surfaces are as far away on both sides,
    the step is as large as they allow, and that of a skewness is small: its kurtosis would have to move as well.
    """
    return max(STEPS[quantity], min(deviation, _room(surface, quantity)) if quantity in FAR_QUANTITIES else 0.0)


def _room(surface, quantity):
    """Largest step around a surface with a surface at both ends."""
    shape, size = surface.spectrum, abs(surface.skewness)
    if quantity == "corner":
        return np.log(shape.cutoff / shape.corner) / 2
    if quantity == "slope":
        return -shape.slope if isinstance(shape, CutoffSelfAffine) else np.inf
    if quantity == "kurtosis":
        return min(largest_kurtosis(size) - surface.kurtosis, surface.kurtosis - least_kurtosis(size))
    return FARTHEST_RMS


def bracketed(
    surface: Description, quantity: str, deviation: float = 0.0
) -> tuple[tuple[Description, Description], float]:
    """Bracket a surface: two with one quantity lower and higher, and the difference of the quantity.

    ASSUME: where no surface has the increased quantity, both values are lower, and where none has the decreased one,
    both are higher, so that the slope is that of a near surface. This concerns skewness and kurtosis of nearly Gaussian
    heights, whose kurtosis is the largest that is feasible, and of heights with two levels, whose kurtosis is the
    least, a corner at the cut-off and a flat spectrum.

    Parameters
    ----------
    surface : Description
    quantity : str
        One of its quantities.
    deviation : float
        Standard uncertainty of the quantity, see `step_of` [-].

    Returns
    -------
    (less, more) : tuple of Description
    difference : float
        Of ln rms, skewness, kurtosis, x_k, ln corner or slope [-].
    """
    step = step_of(surface, quantity, deviation)
    if quantity in MODE_QUANTITIES[1:]:
        shifted = _mode(surface, step, ORDERS[MODE_QUANTITIES.index(quantity) - 1])
    else:
        makers = {"rms": _rms, "skewness": _skewness, "kurtosis": _kurtosis, "corner": _corner, "slope": _slope}
        shifted = makers[quantity](surface, step)
    return tuple(shifted), 2 * step


def value_of(surface: Description, quantity: str) -> float:
    """Rms [m], skewness, or corner [rad m⁻¹] of a surface."""
    return surface.spectrum.corner if quantity == "corner" else getattr(surface, quantity)


def with_value(surface: Description, quantity: str, value: float) -> Description:
    """Surface with another rms [m], skewness, or corner of its spectrum [rad m⁻¹], and its form otherwise.

    ASSUME: a skewness at which no surface has the kurtosis comes with the nearest one that is feasible.
    """
    if quantity == "corner":
        return replace(surface, spectrum=_bent(surface.spectrum, value, 0.0))
    if quantity == "skewness":
        kurtosis = max(min(surface.kurtosis, largest_kurtosis(abs(value))), least_kurtosis(value))
        return replace(surface, skewness=value, kurtosis=kurtosis)
    return replace(surface, rms=value)


def moved(surface: Description, errors: Mapping[str, float]) -> Description:
    """Surface after errors of its quantities, in the units of `bracketed`.

    ASSUME: modes are added one after the other, which differs from their sum at second order. A kurtosis and a corner
    that no surface has come with their nearest one.
    """
    changed = replace(surface, rms=float(np.exp(np.log(surface.rms) + errors["rms"]))) if "rms" in errors else surface
    if "skewness" in errors or "kurtosis" in errors:
        skewness, kurtosis = (getattr(surface, name) + errors.get(name, 0.0) for name in ("skewness", "kurtosis"))
        kurtosis = max(min(kurtosis, largest_kurtosis(abs(skewness))), least_kurtosis(skewness))
        changed = replace(changed, skewness=skewness, kurtosis=kurtosis)
    for name in MODE_QUANTITIES[1:]:
        if name in errors:
            changed = _mode(changed, errors[name], ORDERS[MODE_QUANTITIES.index(name) - 1])[1]
    if "corner" in errors or "slope" in errors:
        shape = surface.spectrum
        corner = min(shape.corner * np.exp(errors.get("corner", 0.0)), shape.cutoff * np.exp(-STEPS["corner"]))
        changed = replace(changed, spectrum=_bent(shape, float(corner), errors.get("slope", 0.0)))
    return changed


def like(surface: Description, member: Mapping[str, float]) -> Description:
    """Surface with the quantities of another one among rms [m], skewness, kurtosis, corner, slope and cut-off.

    Wave numbers are in rad m⁻¹; a changed spectrum is of the form of Eq. (7). With another cut-off, the waves have
    other random numbers.

    ASSUME: a corner beyond the cut-off comes with the nearest one below it.
    """
    changed = replace(surface, **{name: member[name] for name in MOMENT_QUANTITIES if name in member})
    if member.keys() <= set(MOMENT_QUANTITIES):
        return changed
    slope, corner, cutoff = (
        member.get(name, getattr(surface.spectrum, name)) for name in ("slope", "corner", "cutoff")
    )
    corner = corner if corner < cutoff else float(cutoff * np.exp(-STEPS["corner"]))
    return replace(changed, spectrum=self_affine.spectrum(surface.rms, slope, corner, cutoff))


def _around(value, step, largest=np.inf, least=-np.inf):
    """Two values a step below and above the given one, or below the largest or above the least one."""
    centre = max(min(value, largest - step), least + step)
    return centre - step, centre + step


def _rms(surface, step):
    return [replace(surface, rms=float(np.exp(at))) for at in _around(np.log(surface.rms), step)]


def _skewness(surface, step):
    size = abs(surface.skewness)
    kurtosis = max(min(surface.kurtosis, largest_kurtosis(max(size - step, 0.0))), least_kurtosis(size + step))
    return [replace(surface, skewness=at, kurtosis=kurtosis) for at in _around(surface.skewness, step)]


def _kurtosis(surface, step):
    size = abs(surface.skewness)
    values = _around(surface.kurtosis, step, largest_kurtosis(size), least_kurtosis(size))
    return [replace(surface, kurtosis=at) for at in values]


def _mode(surface, step, order):
    score = surface.form.scores
    polynomial = eval_hermitenorm(order - 1, score) / np.sqrt(factorial(order - 1) * order)
    heights = [surface.form.quantile_of_normal(score + at * polynomial) for at in (-step, step)]
    return [replace(surface, form=MeasuredDensity(score, at)) for at in heights]


def _corner(surface, step):
    shape = surface.spectrum
    at = _around(np.log(shape.corner), step, np.log(shape.cutoff) - step)
    return [replace(surface, spectrum=_bent(shape, float(np.exp(value)), 0.0)) for value in at]


def _slope(surface, step):
    shape = surface.spectrum
    largest = -shape.slope if isinstance(shape, CutoffSelfAffine) else np.inf
    return [replace(surface, spectrum=_bent(shape, shape.corner, by)) for by in _around(0.0, step, largest)]


def _bent(spectrum, corner, steeper):
    """Spectrum with another corner [rad m⁻¹] and with ``steeper`` added to its slope beyond the corner."""
    if isinstance(spectrum, CutoffSelfAffine):
        floor = spectrum.plateau * (spectrum.cutoff / corner) ** (spectrum.slope + steeper)
        return CutoffSelfAffine(spectrum.plateau, floor, corner, spectrum.cutoff)
    wavenumber = spectrum.wavenumber
    density = np.interp(wavenumber * spectrum.corner / corner, wavenumber, spectrum.density)
    return replace(spectrum, density=density * np.maximum(wavenumber / corner, 1.0) ** steeper)
