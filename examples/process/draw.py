"""Draw scans of a surface after four times of an etch, by a law that is known: ``python draw.py FOLDER``.

The etch roughens the surface and cuts pits into it, so that its skewness becomes negative. Roughness keeps a stopper
free, pits bring flat parts of it into contact: the best time is between the ends.
"""

import sys
import warnings
from pathlib import Path

import numpy as np

import stiction

with warnings.catch_warnings():
    warnings.simplefilter("ignore", ImportWarning)  # of NuMPI, without mpi4py
    from SurfaceTopography import Topography

#: Times of the etch [s], scans at each, side of a scan and distance of its points [m].
TIMES, SCANS, SIDE, PIXEL = (30, 60, 90, 120), 3, 5e-6, 20e-9
#: Wave number beyond which there is no roughness [rad/m].
CUTOFF = 125e6
#: Spectral density below the corner [m⁴]: any, because the rms alone sets the heights.
PLATEAU = 1e-32


def truth(time):
    """Surface after a time of the etch [s]: rms [m], skewness, kurtosis, corner [rad/m] and slope of the spectrum."""
    x = (time - 75) / 45
    skewness = -0.5 - 0.5 * x - 0.15 * x**2
    return 3.6e-9 * np.exp(0.5 * x - 0.35 * x**2), skewness, 3 + 1.2 * skewness**2, 13e6 * np.exp(-0.1 * x), -3.8


def rough_surface(time):
    """Square of the surface after a time of the etch [s]."""
    rms, skewness, kurtosis, corner, slope = truth(time)
    spectrum = stiction.CutoffSelfAffine(PLATEAU, PLATEAU * (CUTOFF / corner) ** slope, corner, CUTOFF)
    translation = stiction.Translation(stiction.maximum_entropy(skewness, kurtosis))
    underlying, _ = stiction.underlying_spectrum(spectrum, translation, PIXEL)
    return stiction.RoughSurface(underlying, translation, rms, stiction.StripGrid(SIDE, SIDE, PIXEL, margin=1e-6))


def main(folder, seed=1):
    """Write all files into a folder. Existing ones are kept."""
    folder.mkdir(parents=True, exist_ok=True)
    for time in TIMES:
        paths = [folder / f"etch_{time}_{number}.x3p" for number in range(1, SCANS + 1)]
        if not all(path.exists() for path in paths):
            surface = rough_surface(time)
            for path in paths:
                heights = surface.draw(stiction.stream(seed, "example", path.stem)).astype(float)
                Topography(heights, (SIDE, SIDE), unit="m").to_x3p(str(path))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
