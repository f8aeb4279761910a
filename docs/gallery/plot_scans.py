"""
From scans to a surface with error bars
=======================================

Scans are finite pieces of a random surface, so what they tell has errors. Here two large scans and two small ones are
drawn from a surface that is known, and its moments and its spectrum are estimated from them. With files,
``stiction.read_scan`` replaces the drawing.
"""

import matplotlib.pyplot as plt
import numpy as np

import stiction

# %%
# A surface and its scans
# -----------------------
# Its spectrum is flat for long waves, then a power law, and ends at a wavelength of 50 nm.

spectrum = stiction.CutoffSelfAffine(plateau=1.3e-32, floor=2.7e-37, corner=1.2e7, cutoff=1.25e8)
density = stiction.maximum_entropy(skewness=-0.76, kurtosis=3.9)
translation = stiction.Translation(density)
underlying, _ = stiction.underlying_spectrum(spectrum, translation, 10e-9)


def scans(side, every, count):
    """Square scans of a side [m], of every so many points of a grid of 10 nm."""
    grid = stiction.StripGrid(side, side, 10e-9, margin=1e-6)
    surface = stiction.RoughSurface(underlying, translation, 3.4e-9, grid)
    maps = [surface.draw(stiction.stream(1, "gallery", every, k))[::every, ::every] for k in range(count)]
    return [stiction.Scan(z.astype(float), (side, side), f"{1e6 * side:g} um, {k}") for k, z in enumerate(maps)]


large, small = scans(10e-6, 4, 2), scans(2e-6, 1, 2)

# %%
# Moments
# -------
# Errors follow from the spectrum: neighbouring points are correlated, and far fewer heights are independent than
# there are pixels.

estimate = stiction.estimate_surface([*large, *small], seed=1)
truth = np.log(3.4e-9), -0.76, 3.9
for name, value, error, true in zip(
    ("ln rms", "skewness", "kurtosis"), estimate.moments, estimate.errors, truth, strict=True
):
    print(f"{name}: {value:.3f} ± {error:.3f}, true value {true:.3f}")

# %%
# Limits of the scans are stated in words.

print("\n".join(estimate.flags))

# %%
# Spectrum
# --------
# The large scans end at waves of two of their pixels. The small ones show where the roughness ends.

plt.rc("font", size=15)
figure = plt.figure(figsize=(6.4, 5.6), layout="constrained")
for label, part in (("large", large), ("large and small", [*large, *small])):
    inspection = stiction.estimate_surface(part, seed=1, model_scans=8).inspection
    inside = inspection.rings.between(inspection.reach.low, inspection.reach.nyquist)
    plt.loglog(1e-6 * inside.wavenumber, 1e36 * inside.density, label=label)
    print(f"{label}: the spectrum is known up to {1e-6 * inspection.reach.end:.0f} rad/µm")
wave = np.geomspace(1e6, 1.25e8, 200)
plt.loglog(1e-6 * wave, 1e36 * spectrum(wave), "k--", label="truth")
plt.xlabel("wave number [rad/µm]")
plt.ylabel("spectrum [nm⁴]")
plt.ylim(1e-4, None)
figure.legend(loc="outside lower center", ncols=2)
plt.show()
