"""Study variant: crack lengths of a pair under one variant, i.e. one model choice changed, from its contact."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from stiction.analysis.variants import Variant
from stiction.chaos.model import Truncation, fit
from stiction.config.cases import case_id
from stiction.stages import curves, releases
from stiction.stages.cantilevers import Dimensions, Gap, Stiffness, StripLength


@dataclass(frozen=True)
class Settings:
    """Settings of the stages after contact: water, force laws and beams without scatter, at all humidities."""

    seed: int
    water: curves.Water
    chaos: Truncation
    solid: Stiffness
    beam: Dimensions
    pairs: dict[str, Gap]
    sampling: StripLength
    refined: tuple[float, ...] = ()  #: humidities at which the elements follow the force laws [-]


def compute(contact: xr.Dataset, pair: str, settings: Settings) -> xr.Dataset:
    """Run the stages after contact at all humidities; model NG, nominal dimensions."""
    humidities, sampling = settings.pairs[pair].humidities, settings.sampling
    number = settings.beam.samples
    beams = releases.Settings(
        settings.seed, settings.solid, settings.beam, settings.pairs, sampling, samples=number, scatter=0
    )
    energies, ended = [], []
    for humidity in humidities:
        vectors, limit = curves.vectors(contact, humidity, settings.water)
        model = fit(vectors, limit, settings.chaos.order, settings.chaos.dimension_tolerance)
        energies.append(vectors[:, 0])
        refined = replace(beams, refined=humidity in settings.refined)
        ended.append(releases.released(model, case_id(pair, humidity), refined))
    return layout(humidities, energies, ended)


def layout(humidities: Sequence[float], energies: Sequence, beams: Sequence[dict]) -> xr.Dataset:
    """Dataset of the crack lengths of a pair under one variant.

    Parameters
    ----------
    humidities : sequence
        Relative humidities RH [-].
    energies : (n_rh, m) array
        Adhesion energies of the sampled pairs [J m⁻²].
    beams : sequence of n_rh dicts
        Arrays of :func:`stiction.beam.montecarlo.columns`.
    """
    return xr.Dataset(
        {
            "adhesion_energy": (("humidity", "sample"), energies, {"units": "J m-2"}),
            "crack_length": (("humidity", "beam"), [b["crack_length"] for b in beams], {"units": "m"}),
            "state": (("humidity", "beam"), np.array([b["state"] for b in beams], np.int8)),
        },
        coords={"humidity": list(humidities)},
    )


def cases_of(dataset: xr.Dataset) -> Iterator[tuple[float, Variant]]:
    """Every case of the dataset: relative humidity [-] and the results under the variant."""
    for k, humidity in enumerate(dataset.humidity.values):
        chosen = dataset.isel(humidity=k)
        stuck = releases.ended(chosen, "S-shape")
        yield float(humidity), Variant(chosen.adhesion_energy.values, chosen.crack_length.values, stuck)
