"""Iterative algorithm of Fig. 4: correct a Gaussian spectrum until its translated fields have the target spectrum.

For comparison only: surfaces are drawn from the closed form of :mod:`stiction.surface.translation`.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy import fft

from stiction.surface.field import RoughSurface, StripGrid, radial_periodogram
from stiction.surface.spectrum import Spectrum, TabulatedSpectrum, radial_spectrum
from stiction.surface.translation import TranslationMap


def target_rings(target: Spectrum, grid: StripGrid) -> tuple[np.ndarray, np.ndarray]:
    """Target spectrum s_Z of unit variance, averaged over the rings of the periodogram of a field of ``grid``.

    Returns
    -------
    wavenumber, spectrum : (n,) arrays
        Rings up to the cut-off of the target [rad m⁻¹], [m²].

    Raises
    ------
    ValueError
        If the grid is no whole period.
    """
    if grid.shape != grid.field_shape:
        raise ValueError(
            f"a strip of {grid.shape} points is cut from a period of {grid.field_shape}: use StripGrid.periodic"
        )
    step = grid.wavenumber_steps[0]
    axis = step * fft.fftfreq(grid.shape[0], 1 / grid.shape[0])
    square = target(np.hypot(axis[:, None], axis))
    wavenumber, spectrum = radial_spectrum(square / (square.sum() * step**2), step)
    inside = wavenumber <= target.cutoff
    return wavenumber[inside], spectrum[inside]


def iterate(
    target: Spectrum, translation: TranslationMap, grid: StripGrid, fields: int, rng: np.random.Generator
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    r"""Iterations of Fig. 4, as an infinite generator.

    .. math:: s_{Z_G}^{(i+1)} = s_{Z_G}^{(i)} \, s_Z / s_Z^{(i)}

    Parameters
    ----------
    target : Spectrum
        Spectrum s_Z of the heights; its scale has no effect.
    translation : TranslationMap
        Eq. (5).
    grid : StripGrid
        `stiction.surface.field.StripGrid.periodic`.
    fields : int
        Number of new fields drawn for each estimate s_Z^(i).
    rng : numpy.random.Generator

    Yields
    ------
    underlying : (n,) array
        Spectrum s_ZG^(i) on the rings of `target_rings`; the first is the target [m²].
    periodograms : (fields, n) array
        Spectra of the fields translated from it, of unit variance [m²].
    """
    wavenumber, densities = target_rings(target, grid)
    spectrum = TabulatedSpectrum(wavenumber, target(wavenumber) / target.variance, target.cutoff)
    while True:
        surface = RoughSurface(spectrum, translation, 1.0, grid)
        # DEPARTS: averages over rings and fields; with the raw periodogram of one field, as in Fig. 4, noise would be
        # divided by noise.
        samples = [radial_periodogram(surface.draw(rng), grid.spacing)[1] for _ in range(fields)]
        periodograms = np.array(samples)[:, : len(wavenumber)]
        yield spectrum.density, periodograms
        spectrum = replace(spectrum, density=spectrum.density * densities / periodograms.mean(axis=0))


def misfit(spectrum: np.ndarray, target: np.ndarray) -> float | np.ndarray:
    """Error |ln(s / s_Z)| of a spectrum (..., n), the mean over its rings [-]."""
    return np.abs(np.log(spectrum / target)).mean(axis=-1)


def sampling_misfit(periodograms: np.ndarray) -> float | np.ndarray:
    """Expected `misfit` of an exact spectrum after its estimation from periodograms (..., fields, n) [-]."""
    deviation = periodograms.std(axis=-2, ddof=1) / periodograms.mean(axis=-2)
    return np.sqrt(2 / np.pi / periodograms.shape[-2]) * deviation.mean(axis=-1)
