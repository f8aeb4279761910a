"""Study humidity (Fig. 15): distribution of the adhesion energy of a strip along a fine axis of humidities."""

from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.contact.environment import Water
from stiction.plan.stage import Stage, select
from stiction.progress import progress
from stiction.stages.contact import corrections
from stiction.stages.contact.curves import energies

#: Median and bounds of the band.
_PROBABILITIES = np.array([0.05, 0.5, 0.95])


@dataclass(frozen=True)
class Settings:
    """Settings of the energies, without the contact."""

    water: Water
    points: int  #: number of humidities
    range: tuple[float, float]  #: lowest and highest humidity [-]


def compute(contact: xr.Dataset, settings: Settings) -> xr.Dataset:
    """Compute the energy of every sample at every humidity. Store the quantiles."""
    humidities = np.linspace(*settings.range, settings.points)
    of_humidities = np.array([energies(contact, float(h), settings.water) for h in progress(humidities, "humidities")])
    return layout(humidities, _PROBABILITIES, of_humidities)


def layout(humidity: np.ndarray, probabilities: np.ndarray, energies: np.ndarray) -> xr.Dataset:
    """Dataset of the distribution of the adhesion energy e over the samples, along the relative humidity.

    Humidities (n,) [-], probabilities of the stored quantiles (k,) [-], energies of all samples (n, m) [J m⁻²].
    """
    return xr.Dataset(
        {"energy_quantile": (("probability", "humidity"), np.quantile(energies, probabilities, axis=1))},
        coords={
            "humidity": ("humidity", humidity),
            "probability": ("probability", probabilities),
        },
    )


def _settings(plan, at):
    """Water and humidity axis of a pair."""
    humidities = plan.air.humid(at.pair)
    axis = {"points": plan.config["figures"]["humidity_points"], "range": [min(humidities), max(humidities)]}
    return select(Settings, plan.seen_by(at.pair) | axis)


STAGES = (
    Stage.writing(
        "humidity",
        "humidity/{pair}_{model}",
        inputs=lambda plan, at: (
            {"contact": f"contact/{at.pair}_{at.model}"}
            | corrections.corrections_of_laws(plan, at.pair, plan.air.humid(at.pair), at.model)
        ),
        settings=_settings,
        kind=Settings,
        complete=corrections.with_correction,
        compute=compute,
        message="Adhesion energy of {model} surfaces of pair {pair} against relative humidity.",
    ),
)
