"""Study sensitivity (Fig. 13): adhesion energies of a pair at two values of one moment of the beam's surface."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.analysis.sensitivity import energy_sensitivity
from stiction.contact.environment import Water
from stiction.models import SHIFTS
from stiction.plan.stage import Stage, select
from stiction.stages.contact.changes.moments import moment
from stiction.stages.contact.curves import energies

_STATISTICS = ("mean", "standard deviation")


@dataclass(frozen=True)
class Settings:
    """Settings of the sensitivity, without the contact."""

    water: Water
    humidities: tuple[float, ...]  #: [-]


def compute(contacts: Sequence[xr.Dataset], settings: Settings) -> xr.Dataset:
    """Compare samples drawn with the same random numbers at the two values of the moment."""
    at = [moment(contact) for contact in contacts]
    means = np.array([[energies(contact, h, settings.water) for h in settings.humidities] for contact in contacts])
    return layout(means, at, energy_sensitivity(means.swapaxes(1, 2), at), settings.humidities)


def layout(energies: np.ndarray, at: Sequence[float], estimate: tuple, humidities: Sequence[float]) -> xr.Dataset:
    """Adhesion energies at two values of one moment, and sensitivities of their mean and standard deviation.

    Energies e (2, n_rh, m) [J m⁻²] at two values [SI]; normalised slopes and standard errors, (2, n_rh) each [-].
    """
    slopes, errors = estimate
    return xr.Dataset(
        {
            "adhesion_energy": (("moment", "humidity", "sample"), energies, {"units": "J m-2"}),
            "slope": (("statistic", "humidity"), slopes, {"units": "1", "long_name": "(|x|/y) dy/dx"}),
            "standard_error": (("statistic", "humidity"), errors, {"units": "1"}),
        },
        coords={"moment": list(at), "humidity": list(humidities), "statistic": list(_STATISTICS)},
    )


STAGES = (
    Stage.writing(
        "sensitivity",
        "studies/sensitivity/{pair}_{moment}",
        inputs=lambda plan, at: {
            "contacts": [f"studies/sensitivity/contact/{at.pair}_{at.moment}_{shift}" for shift in SHIFTS]
        },
        settings=lambda plan, at: select(Settings, plan.over_humidities(at.pair)),
        kind=Settings,
        compute=compute,
        message="Sensitivity of the adhesion of pair {pair} to {moment} (Fig. 13).",
    ),
)
