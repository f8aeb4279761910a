"""Study slopes: effect of the measured quantities of one surface on the mean adhesion energy of a pair."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.contact.environment import Water
from stiction.devices.budget import log_slope
from stiction.models import SHIFTS
from stiction.plan.stage import Stage, select
from stiction.stages.contact.changes.quantities import difference
from stiction.stages.contact.curves import energies


@dataclass(frozen=True)
class Settings:
    """Settings of the slopes, without the contact."""

    water: Water
    humidities: tuple[float, ...]  #: [-]


def compute(less: Mapping[str, xr.Dataset], more: Mapping[str, xr.Dataset], settings: Settings) -> xr.Dataset:
    """Slopes of ln ē by central differences.

    The contacts have less and more of a quantity, a key of `stiction.analysis.shifts.STEPS`.
    """
    with_errors = np.array(
        [[_slope(less[name], more[name], h, settings.water) for h in settings.humidities] for name in less]
    )
    return layout(list(less), settings.humidities, *np.moveaxis(with_errors, -1, 0))


def _slope(less, more, humidity, water):
    """Slope of ln ē and its standard error at a humidity."""
    samples = (energies(contact, humidity, water) for contact in (less, more))
    return log_slope(np.mean, *samples, difference(less))


def layout(
    quantities: Sequence[str], humidities: Sequence[float], slopes: np.ndarray, errors: np.ndarray
) -> xr.Dataset:
    """Dataset of the slopes of ln ē and their standard errors, (n_quantities, n_rh) [-]."""
    return xr.Dataset(
        {
            "slope": (("quantity", "humidity"), slopes),
            "standard_error": (("quantity", "humidity"), errors),
        },
        coords={"quantity": list(quantities), "humidity": list(humidities)},
    )


def quantities(dataset: xr.Dataset) -> tuple[str, ...]:
    """Quantities with slopes in the dataset, keys of `stiction.analysis.shifts.STEPS`."""
    return tuple(dataset["quantity"].values.tolist())


def by_quantity(dataset: xr.Dataset, quantities: Sequence[str]) -> np.ndarray:
    """Slopes of ln ē with respect to some quantities at every humidity, (n_rh, n_quantities) [-]."""
    return dataset.slope.sel(quantity=list(quantities)).values.T


def errors_of(dataset: xr.Dataset, quantities: Sequence[str]) -> np.ndarray:
    """Standard errors of these slopes, (n_rh, n_quantities) [-]."""
    return dataset.standard_error.sel(quantity=list(quantities)).values.T


def _inputs(plan, at):
    """Contacts of a pair with less and with more of every quantity of a surface."""
    contact = f"studies/slopes/contact/{at.pair}_{at.surface}"
    return {shift: {name: f"{contact}_{name}_{shift}" for name in plan.quantities(at.surface)} for shift in SHIFTS}


STAGES = (
    Stage.writing(
        "slopes",
        "studies/slopes/{pair}_{surface}",
        inputs=_inputs,
        settings=lambda plan, at: select(Settings, plan.over_humidities(at.pair)),
        kind=Settings,
        compute=compute,
        message="Slopes of the adhesion of pair {pair} to the quantities of {surface}.",
    ),
)
