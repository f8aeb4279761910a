"""Study sensitivity (Fig. 13): adhesion energies of a pair at two values of one moment of the beam's surface."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.analysis.sensitivity import energy_sensitivity, one_sided
from stiction.contact.environment import Water
from stiction.models import SHIFTS
from stiction.plan.stage import Stage, select
from stiction.stages.contact.changes.moments import moment
from stiction.stages.contact.contact import first
from stiction.stages.contact.curves import energies

_STATISTICS = ("mean", "standard deviation")
#: Directions of one-sided differences.
_SIDES = list(SHIFTS)


@dataclass(frozen=True)
class Settings:
    """Settings of the sensitivity, without the contact."""

    water: Water
    humidities: tuple[float, ...]  #: [-]


def compute(contacts: Sequence[xr.Dataset], unchanged: xr.Dataset, settings: Settings) -> xr.Dataset:
    """Compare samples drawn with the same random numbers at the two values of the moment and between them.

    The unchanged contact may have more samples or fewer: those in all three make the one-sided differences.
    """
    at = [moment(contact) for contact in contacts]
    changed = [[energies(contact, h, settings.water) for h in settings.humidities] for contact in contacts]
    between = first(unchanged, contacts[0].sizes["strip"])
    base = np.array([energies(between, h, settings.water) for h in settings.humidities]).T
    means = np.array(changed)
    of_samples = means.swapaxes(1, 2)
    sides = one_sided(of_samples[:, : len(base)], base, at)
    return layout(means, at, energy_sensitivity(of_samples, at), sides, settings.humidities)


def layout(
    energies: np.ndarray, at: Sequence[float], estimate: tuple, sides: tuple, humidities: Sequence[float]
) -> xr.Dataset:
    """Adhesion energies at two values of one moment, and sensitivities of their mean and standard deviation.

    Energies e (2, n_rh, m) [J m⁻²] at two values [SI]; normalised slopes and standard errors, (2, n_rh) each [-], and
    one-sided differences of the mean to less and to more of the moment with their errors, (2, n_rh) each [-].
    """
    (slopes, errors), (differences, their_errors) = estimate, sides
    return xr.Dataset(
        {
            "adhesion_energy": (("moment", "humidity", "strip"), energies),
            "slope": (("statistic", "humidity"), slopes),
            "standard_error": (("statistic", "humidity"), errors),
            "difference": (("side", "humidity"), differences),
            "difference_error": (("side", "humidity"), their_errors),
        },
        coords={"moment": list(at), "humidity": list(humidities), "statistic": list(_STATISTICS), "side": _SIDES},
    )


STAGES = (
    Stage.writing(
        "sensitivity",
        "studies/sensitivity/{pair}_{moment}",
        inputs=lambda plan, at: {
            "contacts": [f"studies/sensitivity/contact/{at.pair}_{at.moment}_{shift}" for shift in SHIFTS],
            "unchanged": f"contact/{at.pair}_NG",
        },
        settings=lambda plan, at: select(Settings, plan.over_humidities(at.pair)),
        kind=Settings,
        compute=compute,
        message="Sensitivity of the adhesion of pair {pair} to {moment} (Fig. 13).",
    ),
)
