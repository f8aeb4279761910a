"""Stage stoppers: pull-off force of a patch of a pair against its restoring force, over the humidity."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.contact.environment import Water
from stiction.devices.risk import samples_for
from stiction.devices.stoppers import pull_off_force, safe_force, stuck_patches, worst_humidity
from stiction.estimates import mean_with_error
from stiction.plan.stage import Stage, select
from stiction.progress import progress
from stiction.stages.contact.corrections import corrected
from stiction.stages.contact.curves import pull_offs
from stiction.stages.contact.error_notes import on_patch
from stiction.stages.devices.patch_settings import contact_of, corrections_of

#: Shares of stuck patches for which a restoring force is stated, as far as there are enough patches.
SHARES = (1e-2, 1e-3, 1e-4)
#: Distance of the humidities along the fine axis [-].
STEP = 0.01
#: Probabilities of the stored quantiles of the pull-off force.
PROBABILITIES = np.array([0.05, 0.5, 0.95])


@dataclass(frozen=True)
class Settings:
    """Everything that the forces of a stopper depend on apart from its contact."""

    water: Water
    contact: tuple[float, float]  #: sides of the patch [m]
    restoring_force: float  #: [N]
    humidities: tuple[float, ...]  #: of the device [-]
    worst_humidities: tuple[float, float]  #: ends of the fine axis along which the worst humidity is sought [-]


def forces(contact: xr.Dataset, humidity: float, settings: Settings) -> np.ndarray:
    """Pull-off forces of all sampled patches at a relative humidity (m,) [N]."""
    area = settings.contact[0] * settings.contact[1]
    with on_patch(*settings.contact):
        return pull_off_force(pull_offs(contact, humidity, settings.water), area)


def compute(contact: xr.Dataset, settings: Settings) -> xr.Dataset:
    """Pull-off forces at the humidities of the device and along a fine axis, P(stuck) and the worst humidity."""
    axis = fine_axis(*settings.worst_humidities)
    at = {float(h): forces(contact, float(h), settings) for h in progress([*settings.humidities, *axis], "humidities")}
    chosen = np.array([at[h] for h in settings.humidities])
    along = np.array([at[float(h)] for h in axis])
    return layout(settings, chosen, axis, along)


def fine_axis(low: float, high: float) -> np.ndarray:
    """Humidities from the lowest to the highest, about `STEP` apart [-]."""
    return np.linspace(low, high, max(3, round((high - low) / STEP) + 1))


def layout(settings: Settings, chosen: np.ndarray, axis: np.ndarray, along: np.ndarray) -> xr.Dataset:
    """Dataset of the pull-off forces of a stopper.

    The error of the worst humidity contains that of a place between two points of the axis, their distance / √12.

    Parameters
    ----------
    settings : Settings
    chosen : (n_rh, m) array
        Pull-off forces at the humidities of the device [N].
    axis : (n,) array
        Humidities of the fine axis [-].
    along : (n, m) array
        Pull-off forces along it [N].
    """
    newton, none = {"units": "N"}, {"units": "1"}
    worst, scatter = worst_humidity(axis, along.T)
    worst_error = float(np.hypot(scatter, (axis[1] - axis[0]) / np.sqrt(12)))
    stuck = np.array([_stuck(row, settings.restoring_force) for row in along]).T
    stuck_chosen = np.array([_stuck(row, settings.restoring_force) for row in chosen]).T
    safe, safe_along = (np.array([[_safe(row, p) for p in SHARES] for row in rows]) for rows in (chosen, along))
    mean, error = mean_with_error(along.T)
    return xr.Dataset(
        {
            "pull_off": (("humidity", "sample"), chosen, newton),
            "stuck": (("bound", "humidity"), stuck_chosen, none | {"long_name": "P(stuck) and its 95 % band"}),
            "safe_force": (("part", "humidity", "share"), np.moveaxis(safe, -1, 0), newton),
            "restoring_force": ((), settings.restoring_force, newton),
            "mean_along": ("axis", mean, newton),
            "mean_along_error": ("axis", error, newton),
            "quantile_along": (("probability", "axis"), np.quantile(along, PROBABILITIES, axis=1), newton),
            "stuck_along": (("bound", "axis"), stuck, none),
            "safe_force_along": (("axis", "share"), safe_along[..., 0], newton),
            "worst_humidity": ((), worst, none),
            "worst_humidity_error": ((), worst_error, none),
        },
        coords={
            "humidity": list(settings.humidities),
            "axis": axis,
            "share": list(SHARES),
            "probability": PROBABILITIES,
            "bound": ["estimate", "low", "high"],
            "part": ["safe", "estimate", "error"],
        },
    )


def _stuck(pull_off, force):
    """P(stuck) at one restoring force and the ends of its band, (3,) [-]."""
    return [float(part[0]) for part in stuck_patches(pull_off, np.array([force]))]


def _safe(pull_off, share):
    """`safe_force`; NaN if there are too few patches for this share."""
    return safe_force(pull_off, share) if len(pull_off) >= samples_for(share) else (np.nan,) * 3


def is_at_an_end(dataset: xr.Dataset) -> bool:
    """Whether the worst humidity is an end of the fine axis, so that the largest force may lie beyond it."""
    return float(dataset.worst_humidity) in (float(dataset.axis[0]), float(dataset.axis[-1]))


def in_any_air(dataset: xr.Dataset) -> tuple[tuple[float, float, float], xr.DataArray]:
    """Largest P(stuck) along the fine axis with the ends of its band, and largest safe force for every share [N]."""
    worst = dataset.stuck_along.isel(axis=int(dataset.stuck_along.sel(bound="estimate").argmax("axis")))
    return tuple(map(float, worst)), dataset.safe_force_along.max("axis", skipna=False)


def shares_stuck(dataset: xr.Dataset) -> Sequence[tuple[float, float, float, float]]:
    """Humidity, P(stuck) and the ends of its 95 % band, at every humidity of the device."""
    return [(float(h), *map(float, dataset.stuck.sel(humidity=h))) for h in dataset.humidity.values]


def _settings(plan, at):
    """Water, patch, restoring force and humidities of a stopper, and its fine axis of humidities."""
    section = plan.config["devices"][at.device]
    return select(Settings, plan.config["design"] | section | {"water": plan.water(section["pair"])})


STAGES = (
    Stage.writing(
        "stoppers",
        "devices/stoppers/{device}",
        inputs=lambda plan, at: {"contact": contact_of(plan, at.device)} | corrections_of(plan, at.device),
        settings=_settings,
        kind=Settings,
        compute=lambda data, at, settings: compute(data["contact"], corrected(settings, data)),
        message="Pull-off force of stopper {device}.",
    ),
)
