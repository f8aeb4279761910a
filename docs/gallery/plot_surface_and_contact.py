"""
From four moments to an adhesive force
======================================

A rough surface is described by rms, skewness and kurtosis of its heights and by its spectrum. Here: the height
density of largest entropy, a surface that has it, and the force with which two surfaces attract each other.
"""

import matplotlib.pyplot as plt
import numpy as np

import stiction

# %%
# Heights
# -------
# Surface B2 of the paper has a long tail of valleys: its skewness is negative. Few summits are high, and only the
# highest touch.

density = stiction.maximum_entropy(skewness=-0.76, kurtosis=3.9)
z = np.linspace(-5, 4, 400)
plt.rc("font", size=15)
plt.rc("figure.constrained_layout", use=True)
figure = plt.figure()
plt.plot(z, density(z), label="maximum entropy")
plt.plot(z, np.exp(-(z**2) / 2) / np.sqrt(2 * np.pi), "--", label="Gaussian")
plt.xlabel("height over rms [–]")
plt.ylabel("density [–]")
figure.legend(loc="outside lower center", ncols=2)
plt.show()

# %%
# A drawn surface
# ---------------
# ``PairStudy`` draws the two surfaces of a pair of the paper. Everything is in SI units, and a seed and names
# determine every number.

config = stiction.load({"run": {"pairs": ["b"]}, "contact": {"samples": 200}, "chaos": {"order": 4}})
study = stiction.PairStudy.of(config, "b")
heights = study.surfaces.beam.draw(stiction.stream(1, "gallery"))
print(f"{heights.shape[0]} x {heights.shape[1]} points, rms {1e9 * heights.std():.2f} nm")
plt.imshow(1e9 * heights[:, :300], origin="lower", extent=[0, 3, 0, 1.5], cmap="RdBu_r")
plt.colorbar(label="height [nm]", orientation="horizontal")
plt.xlabel("across the beam [µm]")
plt.ylabel("along it [µm]")
plt.show()

# %%
# Adhesion
# --------
# Every sample, two facing strips, has an adhesion energy: the attractive part of the area under its force curve. It
# scatters from sample to sample, which is why one device sticks and another one does not.

figure = plt.figure(figsize=(6.4, 5.6))
for humidity in (0.44, 0.67, 0.92):
    energies = 1e3 * study.energies(humidity)
    error = energies.std(ddof=1) / np.sqrt(len(energies))
    print(f"RH {humidity}: {energies.mean():.2f} ± {error:.2f} mJ/m², scatter {energies.std(ddof=1):.2f} mJ/m²")
    plt.hist(energies, bins=30, alpha=0.6, label=f"RH {humidity}")
plt.xlabel("adhesion energy of a sample [mJ/m²]")
plt.ylabel("samples")
plt.xscale("log")
figure.legend(loc="outside lower center", ncols=3)
plt.show()
