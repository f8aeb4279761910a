"""A device on synthetic force laws of the size of pair b: its settings, and datasets of its stages."""

from unittest.mock import patch

import numpy as np
import xarray as xr
from scipy.stats import norm
from vectors import sampled_vectors

from stiction.beam.cantilever import Beam
from stiction.beam.foundation import foundation_length
from stiction.chaos.model import Truncation
from stiction.contact import forcelaw
from stiction.contact.environment import Water
from stiction.devices.sampling import SampledSurfaces
from stiction.stages.contact import curves
from stiction.stages.devices import cracks, ground, safe_lengths
from stiction.stages.devices.opening import DesignedBeam
from stiction.stages.devices.sticking import Released
from stiction.stages.surfaces.parameters import variables
from stiction.streams import stream
from stiction.surface.spectrum import CutoffSelfAffine

UM = 1e-6
WATER = Water(300.0)
C1 = DesignedBeam("cantilever", "b", 2.6 * UM, 20 * UM, 30 * UM, 164e9, 1.5 * UM)
R1 = DesignedBeam(
    "bridge", "b", 2 * UM, 2 * UM, 30 * UM, 164e9, 0.5 * UM, residual_stress=50e6, hamaker_constant=9.75e-20
)
#: Slopes of the tips.
SLOPES = np.geomspace(0.005, 2, 40)
#: Root mean square of the heights of both surfaces [m].
RMS = 3.4e-9


def settings(device=C1, beams=200):
    return cracks.Settings(2021, device, beams)


def contact():
    """Dataset of stage contact as far as the stages of devices look into it: bearing areas of normal heights."""
    height = 0.05e-9 * np.arange(-500, 501)
    area = np.tile(norm.sf(height, scale=RMS), (3, 1))
    return xr.Dataset({"bearing_area": (("strip", "height"), area), "step": 0.05e-9}, coords={"height": height})


VECTORS = sampled_vectors(400, 0.24)


def surfaces(corner=12e6):
    """Datasets of both surfaces of a pair, by stage."""
    heights = xr.Dataset({"rms": RMS, "skewness": 0.0, "kurtosis": 3.0})
    spectrum = variables(CutoffSelfAffine(14380e-36, 0.3e-36, corner, 12 * corner))
    return {"heights": [heights] * 2, "spectrum": [spectrum] * 2}


def ground_dataset(device=C1, vectors=VECTORS, limit=None, corner=12e6):
    """Dataset of stage ground on given vectors and surfaces with this corner of their spectrum."""
    limit = limit or 1.2 * vectors[:, 1].max()
    drawn = {"vectors": lambda *_: (vectors, limit), "share_flat": lambda *_: 0.0}
    with patch.multiple(curves, **drawn):
        wanted = ground.Settings(Truncation(6, 0.001), WATER, 0.67, device.strip, device.width)
        return ground.compute({"contact": contact()} | surfaces(corner), wanted)


def computed(wanted, vectors, limit=None):
    """Dataset of stage cracks on given vectors."""
    return cracks.compute(ground_dataset(wanted.device, vectors, limit), wanted)


#: Errors of mean and scatter of the samples.
SURFACES = SampledSurfaces(750 * UM, np.array([[4e-6, -3e-6], [-3e-6, 4e-4]]))


def exactly(lengths, tips=np.inf):
    """Released cantilevers that stick at lengths (n,), or by their tips from others, with no error of the surfaces."""
    exact = SampledSurfaces(1e-3, np.zeros((2, 2)))
    return Released(C1, lengths, np.inf, 0.0, exact, np.broadcast_to(tips, lengths.shape))


def lognormal_cracks(device=C1, number=400, spread=0.025, seed=1, surfaces=SURFACES):
    """Dataset of stage cracks with lognormal lengths around 700 µm."""
    rng = np.random.default_rng(seed)
    crack_lengths = 700 * UM * np.exp(spread * rng.standard_normal(number))
    laws = forcelaw.coefficients(VECTORS[:50], 1.2 * VECTORS[:, 1].max())
    beam = Beam(1500 * UM, 30 * UM, 2.6 * UM, 164e9, 20 * UM, 200)
    beams = Released(device, crack_lengths, np.inf, foundation_length(beam, laws), surfaces, None)
    return cracks.layout(beams, beam, laws, RMS).assign(
        share_flat=0.0, longest_strip=device.strip, resampled=0, repetition=0.0, size_error=0.0
    )


def wanted(device=C1, shares=(1e-2, 1e-3)):
    return safe_lengths.Settings(2021, WATER, 0.67, device, shares, 0.0)


def flats(settings):
    """Arguments of lengths of flats."""
    return settings.device, settings.water, settings.humidity, settings.edge_radius


def safe_without_tips(device=R1, **more):
    """Dataset of stage safe_lengths of a bridge."""
    return safe_lengths.compute(lognormal_cracks(device, **more), wanted(device))


def smooth_tips(energies):
    """Slopes and forces of smooth tips that have given adhesion energies (n,) [J m⁻²]."""
    return SLOPES, energies[:, None] / SLOPES


def safe_with_tips(energies, **more):
    """Dataset of stage safe_lengths of a cantilever whose tips have given adhesion energies (n,) [J m⁻²]."""
    with patch.object(curves, "tip_forces", lambda *_: smooth_tips(energies)):
        return safe_lengths.compute(lognormal_cracks(number=len(energies), **more), wanted(), xr.Dataset())


def rng(*address):
    return stream(7, *address)
