"""Stage cracks: where the cracks of long beams of a device stop at a humidity, and the error of few sampled surfaces.

A simulation of long beams gives P(stuck) at every length (`stiction.devices.risk`). For the error due to the number of
sampled surfaces, force laws are fitted to each of some groups of the samples alone, and the beams are released again
with the same random numbers.
"""

from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.beam.cantilever import Beam
from stiction.beam.foundation import foundation_length
from stiction.chaos.model import Truncation, draw_laws
from stiction.contact import forcelaw
from stiction.designs.patches import on_patch
from stiction.designs.releases import LAWS, DesignedBeam, addresses, crack_lengths, fitted, long_beam
from stiction.stages import curves
from stiction.stages.contact import surface_rms

#: Most groups of the samples of contact, and the least number of samples in each, but always two groups.
GROUPS, PER_GROUP = 10, 50


@dataclass(frozen=True)
class Settings:
    """Everything that the cracks depend on apart from the contact."""

    seed: int
    chaos: Truncation
    water: curves.Water
    humidity: float  #: [-]
    device: DesignedBeam
    beams: int  #: number of beams


def compute(contact: xr.Dataset, settings: Settings) -> xr.Dataset:
    """Fit the force laws and release long beams, with all samples and with each group of them alone.

    Raises
    ------
    ValueError
        If the strips of the device do not resolve its cracks.
    """
    with on_patch(settings.device.strip, settings.device.width):
        vectors, limit = curves.vectors(contact, settings.humidity, settings.water)
    model = fitted(vectors, limit, settings.chaos)
    address = addresses(settings)
    laws = draw_laws(model, LAWS, address("mesh"))
    beam, points = long_beam(settings.device, laws)
    number = settings.beams * settings.device.cracks
    groups = max(2, min(GROUPS, len(vectors) // PER_GROUP))
    models = [model, *(fitted(vectors[k::groups], limit, settings.chaos) for k in range(groups))]
    released = [crack_lengths(model, beam, points, number, address) for model in models]
    return layout(released[0], released[1:], beam, laws, surface_rms(contact))


def layout(cracks: np.ndarray, of_group: list[np.ndarray], beam: Beam, laws: np.ndarray, rms: float) -> xr.Dataset:
    """Dataset of the crack lengths of a device at a humidity.

    Parameters
    ----------
    cracks : (n,) array
        Crack lengths with all samples of contact, infinite for beams that are not S-shaped [m].
    of_group : sequence of (n,) arrays
        The same with each group of the samples alone.
    beam : Beam
    laws : (k, 4) array
        Sample of the force laws [SI].
    rms : float
        Of the sum of both surfaces [m].
    """
    note = {"units": "m", "long_name": "infinite if not S-shaped"}
    lengths = {
        "foundation_length": foundation_length(beam, laws),
        "beam_length": beam.length,
        "element_length": beam.element_length,
        "rms": rms,
    }
    return xr.Dataset(
        {
            "crack_length": ("crack", cracks, note),
            "crack_length_of_group": (("group", "crack"), np.array(of_group), note),
            "mean_energy": ((), float(forcelaw.energy(laws).mean()), {"units": "J m-2"}),
        }
        | {name: ((), value, {"units": "m"}) for name, value in lengths.items()}
    )


def lengths(cracks: xr.Dataset) -> tuple[np.ndarray, np.ndarray, float]:
    """Crack lengths with all samples (n,), with each group alone (g, n), and the foundation length [m]."""
    return cracks.crack_length.values, cracks.crack_length_of_group.values, float(cracks.foundation_length)
