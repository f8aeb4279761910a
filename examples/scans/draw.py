"""Draw scans of two known surfaces, and write them as files of two microscopes: ``python draw.py FOLDER``.

The surfaces are B2 and Sub1 of the paper; every map is tilted, as a sample under a microscope is.
"""

import sys
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import stiction
from stiction.config.units import in_si
from stiction.stages.surfaces.heights import Settings as Moments

with warnings.catch_warnings():
    warnings.simplefilter("ignore", ImportWarning)  # of NuMPI, without mpi4py
    from SurfaceTopography import Topography

#: Grid on which a surface is drawn [m].
SPACING = 10e-9
#: Tilt along the fast and the slow axis [-].
TILT = 2e-3, -1e-3


@dataclass(frozen=True)
class Scans:
    """Files of one surface."""

    truth: str  #: name of the surface in the configuration of the paper
    name: str  #: begin of the names of the files
    ending: str  #: of the names of the files, which selects their format
    number: int
    side: float  #: of a scan [m]
    pixel: float  #: [m]


SCANS = (
    Scans("B2", "etched", "gwy", number=3, side=10e-6, pixel=20e-9),
    Scans("Sub1", "polished", "x3p", number=2, side=5e-6, pixel=10e-9),
)


def main(folder, scans=SCANS):
    """Write all files into a folder; existing ones are kept."""
    folder.mkdir(parents=True, exist_ok=True)
    config = stiction.load()
    for surface in scans:
        paths = [folder / f"{surface.name}_{number}.{surface.ending}" for number in range(1, surface.number + 1)]
        if not all(path.exists() for path in paths):
            drawn = rough_surface(config["surfaces"][surface.truth], surface.side)
            for path in paths:
                write(path, drawn.draw(stiction.stream(config["seed"], "example", path.stem)), surface)


def rough_surface(entry, side):
    """Square of a surface from its section of the configuration."""
    spectrum = in_si(stiction.CutoffSelfAffine, entry["published_psd"])
    moments = in_si(Moments, {key: entry[key] for key in ("rms_nm", "skewness", "kurtosis")})
    translation = stiction.Translation(stiction.maximum_entropy(moments.skewness, moments.kurtosis))
    underlying, _ = stiction.underlying_spectrum(spectrum, translation, SPACING)
    grid = stiction.StripGrid(side, side, SPACING, margin=1e-6)
    return stiction.RoughSurface(underlying, translation, moments.rms, grid)


def write(path, heights, surface):
    """Write every n-th height, on a tilted plane, as a file of one scan."""
    every = round(surface.pixel / SPACING)
    z = heights[::every, ::every].astype(float)
    x = surface.pixel * np.arange(len(z))
    scan = Topography(z + TILT[0] * x[:, None] + TILT[1] * x, (surface.side, surface.side), unit="m")
    {"gwy": scan.to_gwy, "x3p": scan.to_x3p}[surface.ending](str(path))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
