"""Fit spectra of scans of known surfaces with several pixels, noise, tips and filters: ``python spectra.py SEEDS``.

Prints corner, slope, end of the spectrum, χ² per degree of freedom, noise [pm] and rms [nm] that the scans give, and
for B2 the mean adhesion energy of pair b at RH 0.44 over that of the true spectrum, on the same random numbers. Means
over the seeds ± their scatter, wave numbers in rad/µm. The table of docs/measured-surfaces.md is of three seeds.
"""

import sys
from collections import defaultdict
from dataclasses import replace
from functools import cache

import numpy as np
from scipy import ndimage

import stiction
from stiction.config.units import in_si
from stiction.scans.inspection import Settings, inspect
from stiction.scans.scan import Scan
from stiction.stages.surfaces.heights import Settings as Moments

TIP, FILTER, STEP, SAMPLES = 20e-9, 80e6, 0.1e-9, 200


def main(seeds):
    """Print a line per kind of scan."""
    found = defaultdict(list)
    for seed in range(seeds):
        for name, scans in kinds(seed):
            inspection = inspect(scans, Settings())
            fit = inspection.fit
            row = fit.corner / 1e6, fit.slope, inspection.reach.end / 1e6, fit.misfit, 1e12 * inspection.finest.noise
            spectrum = fit.plateau, fit.corner, fit.slope, inspection.reach.end
            ratio = energy(*spectrum) / energy() if name.startswith("B2, ") else np.nan
            found[name].append([*row, 1e9 * np.exp(inspection.moments[0]), ratio])
    for name, rows in found.items():
        mean, scatter = np.mean(rows, axis=0), np.std(rows, axis=0, ddof=1)
        shown = (f"{m:.4g} ± {s:.2g}" for m, s in zip(mean, scatter, strict=True))
        print("|", name, "|", " | ".join(shown), "|")  # noqa: T201


@cache
def energy(*fitted):
    """Mean adhesion energy of pair b at RH 0.44 [J/m²] with the spectrum of B2, true or fitted: plateau ... end."""
    changes = {"attraction": {"reach": "all"}, "chaos": {"order": 5}, "contact": {"samples": SAMPLES}}
    if fitted:
        plateau, corner, slope, end = fitted
        psd = {"plateau_nm4": 1e36 * plateau, "floor_nm4": 1e36 * plateau * (end / corner) ** slope}
        psd |= {"corner_rad_per_um": 1e-6 * corner, "cutoff_rad_per_um": 1e-6 * end}
        changes |= {"surfaces": {"B2": {"published_psd": {key: float(value) for key, value in psd.items()}}}}
    study = stiction.PairStudy.of(
        stiction.load({"chaos": {"order": 5}, "contact": {"samples": SAMPLES}} | changes), "b"
    )
    return study.energies(0.44).mean()


def kinds(seed):
    """Names and scans of every kind."""
    rng = stiction.stream(1, "noise", seed)

    def scan(z, side=10e-6, noise=0.0):
        return Scan(z + noise * rng.standard_normal(z.shape), (side, side))

    b2 = drawn("B2", 10e-6, 5e-9, seed)
    versions = {
        "tip of 20 nm": touched(b2, 5e-9),
        "low-pass filter": filtered(b2, 5e-9),
        "rounded to 0.1 nm": np.round(b2 / STEP) * STEP,
    }
    for every in (4, 2, 1):
        for noise in (0, 3e-12, 30e-12):
            yield f"B2, {5 * every} nm, noise {1e12 * noise:g} pm", [scan(b2[::every, ::every], noise=noise)]
        yield from ((f"B2, {5 * every} nm, {name}", [scan(z[::every, ::every])]) for name, z in versions.items())
    yield "B2, 10 µm at 20 nm and 2 µm at 4 nm", [scan(b2[::4, ::4]), scan(drawn("B2", 2e-6, 4e-9, seed), 2e-6)]
    yield "B2 up to 60 rad/µm, 10 nm", [scan(drawn("B2", 10e-6, 10e-9, seed, end=60e6))]
    for end in (30, 35):
        z = drawn("B2", 10.24e-6, 40e-9, seed, end=1e6 * end, corner=4e6, slope=-4.0)
        yield f"corner 4, slope -4, up to {end} rad/µm, 40 nm", [scan(z, 10.24e-6)]
    sub1 = drawn("Sub1", 10e-6, 10e-9, seed)
    for every in (2, 1):
        for noise in (0, 50e-12):
            yield f"Sub1, {10 * every} nm, noise {1e12 * noise:g} pm", [scan(sub1[::every, ::every], noise=noise)]


def drawn(name, side, pixel, seed, end=None, corner=None, slope=None):  # noqa: PLR0913
    """Map of a surface of the paper [m], also with another spectrum [rad/m]."""
    entry = stiction.load()["surfaces"][name]
    spectrum = in_si(stiction.CutoffSelfAffine, entry["published_psd"])
    if end is not None:
        corner, slope = corner or spectrum.corner, slope or spectrum.slope
        floor = spectrum.plateau * (end / corner) ** slope
        spectrum = replace(spectrum, corner=corner, cutoff=end, floor=floor)
    moments = in_si(Moments, {key: entry[key] for key in ("rms_nm", "skewness", "kurtosis")})
    translation = stiction.Translation(stiction.maximum_entropy(moments.skewness, moments.kurtosis))
    underlying, _ = stiction.underlying_spectrum(spectrum, translation, pixel)
    surface = stiction.RoughSurface(underlying, translation, moments.rms, stiction.StripGrid(side, side, pixel, 1e-6))
    address = stiction.stream(1, "spectra", name, round(1e9 * side), round(1e-6 * (end or 0)), seed)
    return surface.draw(address).astype(float)


def touched(z, pixel):
    """Map that a spherical tip makes of another: dilation."""
    x = pixel * np.arange(-(n := int(0.8 * TIP / pixel)), n + 1)
    square = x[:, None] ** 2 + x**2
    inside = square <= (n * pixel) ** 2
    return ndimage.grey_dilation(
        z, footprint=inside, structure=np.where(inside, np.sqrt(TIP**2 - square * inside) - TIP, 0)
    )


def filtered(z, pixel):
    """Map after a Butterworth filter of second order along the lines."""
    wavenumber = 2 * np.pi * np.fft.fftfreq(len(z), pixel)[:, None]
    return np.fft.ifft(np.fft.fft(z, axis=0) / np.sqrt(1 + (wavenumber / FILTER) ** 4), axis=0).real


if __name__ == "__main__":
    main(int(sys.argv[1]))
