"""Stage stoppers: pull-off force of a patch of a pair against its restoring force, over the humidity."""

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import xarray as xr
from scipy.special import ndtri

from stiction.config.cases import case_id
from stiction.contact.air import DRY_AIR, Air, has_dry, humid, is_humid
from stiction.contact.correction import NONE, ElasticChange
from stiction.contact.environment import Water
from stiction.contact.meniscus import is_wetted
from stiction.devices.risk import CONFIDENCE, SCORES, Basis, in_order, quantiles
from stiction.devices.stoppers import SafeForce, pull_off_force, safe_forces, stuck_patches, worst_humidity
from stiction.estimates import mean_with_error
from stiction.plan.stage import Running, Stage, select
from stiction.progress import progress
from stiction.stages.contact.contact import surface_rms
from stiction.stages.contact.corrections import with_correction
from stiction.stages.contact.curves import energies, freeing_potentials, pull_offs, share_flat, tilted_forces
from stiction.stages.contact.error_notes import on_patch
from stiction.stages.devices.contact_names import (
    contact_of,
    corrections_of,
    dimples_of,
    tilted_of,
)
from stiction.stages.devices.opening import at_voltage
from stiction.streams import stream

#: Shares of stuck patches for which a restoring force is stated, down to one in a million.
SHARES = (1e-2, 1e-3, 1e-4, 1e-6)
#: Distance of the humidities along the fine axis [-].
STEP = 0.01
#: Probabilities of the stored quantiles of the pull-off force.
PROBABILITIES = np.array([0.05, 0.5, 0.95])
#: Coordinates of fractions, of P(stuck) with its band, and of safe forces with their errors.
_COORDS = {"share": list(SHARES), "bound": ["estimate", "low", "high"], "part": ["safe", "estimate", "error"]}


@dataclass(frozen=True)
class Settings:
    """Settings of the forces of a stopper, without its contact."""

    seed: int
    water: Water
    contact: tuple[float, float]  #: sides of the patch [m]
    restoring_force: float = field(default=np.nan, kw_only=True)  #: of its spring, NaN without one [N]
    humidities: tuple[float, ...]  #: of the device [-]
    worst_humidities: tuple[float, float]  #: ends of the fine axis along which the worst humidity is sought [-]


def forces(contact: xr.Dataset, humidity: float, settings: Settings) -> np.ndarray:
    """Pull-off forces of all sampled patches at a relative humidity (m,) [N]."""
    area = settings.contact[0] * settings.contact[1]
    with on_patch(*settings.contact):
        return pull_off_force(pull_offs(contact, humidity, settings.water.at(humidity)), area)


def compute(contact: xr.Dataset, settings: Settings, dry: xr.Dataset | None = None) -> xr.Dataset:
    """Pull-off forces at the humidities of the device and along a fine axis, P(stuck) and the worst humidity.

    The contact is that in the wettest air of the device, and in dry air if that is one of its humidities.
    """
    axis = axis_of(settings)
    settings = replace(settings, water=settings.water.between(humid(settings.humidities), humid(axis)))
    contacts = {float(h): Air(h).choose(contact, dry) for h in (*settings.humidities, *axis)}
    at = {h: forces(ground, h, settings) for h, ground in progress(contacts.items(), "humidities", total=len(contacts))}
    of_device = np.array([at[h] for h in settings.humidities])
    along = np.array([at[float(h)] for h in axis])
    flat = max(share_flat(ground, h, settings.water.at(h)) for h, ground in contacts.items())
    of_surfaces = {"share_flat": ((), flat), "rms": ((), surface_rms(contact))}
    return layout(settings, of_device, axis, along).assign(of_surfaces)


def compute_at_voltage(contact: xr.Dataset, settings: Settings, dry: xr.Dataset | None = None) -> xr.Dataset:
    """Forces of `compute` at a voltage, and the potentials below which the spring frees each patch."""
    area, columns = settings.contact[0] * settings.contact[1], []
    for humidity in settings.humidities:
        ground, water = Air(humidity).choose(contact, dry), settings.water.at(humidity)
        with on_patch(*settings.contact):
            columns.append(freeing_potentials(ground, humidity, water, settings.restoring_force / area))
    potentials = (("humidity", "sample"), np.array(columns))
    return compute(contact, settings, dry).assign(freeing_potential=potentials)


@dataclass(frozen=True)
class Tilted(Settings):
    """Settings of a tilted stopper."""

    slopes: tuple[float, ...] = ()  #: at its tilts, increasing [-]


def compute_tilted(data: Mapping[str, xr.Dataset], settings: Tilted) -> xr.Dataset:
    r"""Pull-off forces of a stopper at its tilts, and the slope at the transition to a wedge.

    Without tilt, the patches are those of `compute`. A tilted one touches with an edge of its first side a, as long as
    its second side w. Smooth surfaces with the adhesion energy e then hold the force :math:`w e / s` at the slope s,
    without a. It equals the force f_max w a of parallel ones at the slope :math:`e / f_\mathrm{max} a`. On rough
    surfaces, whose wedge has few summits, each patch finds a distance of its own and holds more. The data are the
    contacts of parallel and of tilted patches, in the wettest air and in dry air. A patch is the same at all tilts.
    """
    width, by_air, wedges = settings.contact[1], [], []
    for humidity in settings.humidities:
        air, water = Air(humidity), settings.water.at(humidity)
        parallel = air.choose(data["contact"], data.get("dry"))
        tilted = air.choose(data.get("tilted"), data.get("tilted_dry"))
        flat = forces(parallel, humidity, settings)
        rows = [] if settings.slopes[0] else [flat]
        if tilted is not None:
            at_slopes = tilted.sel(slope=[slope for slope in settings.slopes if slope], method="nearest")
            rows += list(width * tilted_forces(at_slopes, humidity, water).T)
        by_air.append(rows)
        wedges.append(energies(parallel, humidity, water).mean() * width / flat.mean())
    return layout_tilted(settings, np.swapaxes(by_air, 0, 1), np.array(wedges))


#: Statistics of a tilted stopper, at each tilt and of the largest force of every patch over all tilts.
_OVER_TILTS = ("mean", "mean_error", "stuck", "safe_force")


def layout_tilted(settings: Tilted, pull_off: np.ndarray, wedges: np.ndarray) -> xr.Dataset:
    """Dataset of a tilted stopper: forces (tilts, n_rh, m) [N], and slopes at the transition to a wedge (n_rh,) [-].

    Variables ``largest_...`` are those of stoppers that land at any of the tilts, and then hold most at one of them.
    """
    statistics = _statistics(settings, np.append(pull_off, pull_off.max(axis=0, keepdims=True), axis=0))
    largest = statistics[[*_OVER_TILTS]].isel(tilt=-1)
    of_tilts = statistics.isel(tilt=slice(-1)).assign_coords(tilt=("tilt", np.arctan(settings.slopes)))
    return of_tilts.assign(
        {f"largest_{name}": values for name, values in largest.items()}
        | {"pull_off": (("tilt", "humidity", "sample"), pull_off)}
        | {"wedge": ("humidity", wedges)}
    )


def _statistics(settings, pull_off):
    """Mean forces, P(stuck) and safe forces of rows of patches (rows, n_rh, m) [N]."""
    over, changes = ("tilt", "humidity"), _changes(settings, settings.humidities)
    stuck = [_stuck(rows, settings, changes) for rows in pull_off]
    safe, bases = zip(*(_safe(rows, settings.seed, changes) for rows in pull_off), strict=True)
    mean, error = mean_with_error(np.moveaxis(pull_off, -1, 0))
    return xr.Dataset(
        {
            "mean": (over, mean),
            "mean_error": (over, np.hypot(error, mean * _ratio_errors(changes))),
            "stuck": (("bound", *over), np.moveaxis(stuck, 1, 0)),
            "safe_force": (("part", *over, "share"), np.moveaxis(safe, 0, 1)),
            "basis": ("share", bases[0]),
        },
        coords={"humidity": list(settings.humidities)} | _COORDS,
    )


@dataclass(frozen=True)
class DimpleForces:
    """Settings of the forces of rows of dimples, without the contact of one."""

    water: Water
    humidity: float  #: [-]
    contact: tuple[float, float]  #: sides of the area of a dimple [m]
    number: int  #: of dimples in each row
    at: tuple[float, ...]  #: distances of the rows from a clamp [m], of which only the number counts here


def compute_dimples(contact: xr.Dataset, settings: DimpleForces) -> xr.Dataset:
    """Pull-off forces of the rows of dimples of beams, each row the sum of other patches."""
    with on_patch(*settings.contact):
        single = pull_offs(contact, settings.humidity, settings.water)
    forces = pull_off_force(single, settings.contact[0] * settings.contact[1])
    shape = -1, len(settings.at), settings.number
    used_patches = len(forces) // (shape[1] * shape[2]) * shape[1] * shape[2]
    row_forces = forces[:used_patches].reshape(shape).sum(axis=2)
    return xr.Dataset({"pull_off": (("beam", "row"), row_forces)})


def axis_of(settings: Settings) -> np.ndarray:
    """Humidities in the search of the worst: the fine axis and, before it, dry air if the device has it [-].

    A device in dry air alone, or with surfaces that no water wets, has no other air.
    """
    is_wet = bool(humid(settings.humidities)) and is_wetted(settings.water.contact_angles)
    dry = [DRY_AIR.humidity] * (has_dry(settings.humidities) or not is_wet)
    return np.array([*dry, *(fine_axis(*settings.worst_humidities) if is_wet else ())])


def fine_axis(low: float, high: float) -> np.ndarray:
    """Humidities from the lowest to the highest, about `STEP` apart, or one if they are equal [-]."""
    return np.linspace(low, high, max(3, round((high - low) / STEP) + 1) if high > low else 1)


def search_ends(design: Mapping[str, Any], stopper: Mapping[str, Any]) -> list[float]:
    """Ends of the humidities in which the worst one is sought: the stated ones, or those of the stopper [-].

    Examples
    --------
    >>> search_ends({}, {"humidities": [0.0, 0.44, 0.9]})
    [0.44, 0.9]
    >>> search_ends({"worst_humidities": [0.4, 0.98]}, {"humidities": [0.5]})
    [0.4, 0.98]
    """
    humid_airs = humid(stopper["humidities"])
    return design.get("worst_humidities") or [min(humid_airs, default=0.0), max(humid_airs, default=0.0)]


def layout(settings: Settings, of_device: np.ndarray, axis: np.ndarray, along: np.ndarray) -> xr.Dataset:
    """Dataset of the pull-off forces of a stopper.

    Forces at the humidities of the device (n_rh, m), and along (n, m) a fine axis of humidities, which dry air may
    precede (n,) [N], [-].
    """
    changes = _changes(settings, settings.humidities)
    safe, basis = _safe(of_device, settings.seed, changes)
    at = {"humidity": list(settings.humidities), "axis": axis, "share": _COORDS["share"]}
    return xr.Dataset(
        {
            "pull_off": (("humidity", "sample"), of_device),
            "full_contact_error": ("humidity", _ratio_errors(changes)),
            "full_contact_power_error": ("humidity", [each.power_error / each.power for each in changes]),
            "stuck": (("bound", "humidity"), _stuck(of_device, settings, changes)),
            "safe_force": (("part", "humidity", "share"), safe),
            "basis": ("share", basis),
            "restoring_force": ((), settings.restoring_force),
        }
        | _along(settings, axis, along),
        coords=at | {"probability": PROBABILITIES, "score": SCORES} | _COORDS,
    )


def _along(settings, axis, along):
    """Variables of the forces (n, m) [N] along the fine axis of humidities (n,) [-]."""
    changes = _changes(settings, axis)
    worst, worst_error = _worst(axis, along)
    (safe, *_), _ = _safe(along, settings.seed, changes)
    mean, error = mean_with_error(along.T)
    return {
        "mean_along": ("axis", mean),
        "mean_along_error": ("axis", np.hypot(error, mean * _ratio_errors(changes))),
        "quantile_along": (("probability", "axis"), np.quantile(along, PROBABILITIES, axis=1)),
        "stuck_along": (("bound", "axis"), _stuck(along, settings, changes)),
        "scored_along": (("axis", "score"), [quantiles(row) for row in along]),
        "safe_force_along": (("axis", "share"), safe),
        "worst_humidity": ((), worst),
        "worst_humidity_error": ((), worst_error),
    }


def _stuck(rows, settings, changes):
    """P(stuck) of rows of patches (n, m) [N] with its band (3, n) [-]."""
    force = settings.restoring_force
    return np.array([stuck_with_band(row, force, change) for row, change in zip(rows, changes, strict=True)]).T


def _worst(axis, along):
    """Worst humidity and its standard error, with the error of a place between two points of the axis.

    The latter is their distance / √12. Dry air, if it is worse than all humid air, has no error.
    """
    wet, means = is_humid(axis), along.mean(axis=1)
    if means[~wet].max(initial=0.0) >= means[wet].max(initial=0.0):
        return DRY_AIR.humidity, 0.0
    if wet.sum() == 1:
        return float(axis[wet][0]), 0.0
    worst, scatter = worst_humidity(axis[wet], along[wet].T)
    return worst, float(np.hypot(scatter, np.diff(axis[wet])[0] / np.sqrt(12)))


def _changes(settings, humidities):
    """Changes of forces by full elastic contact at some humidities, of which few strips are computed."""
    return [settings.water.changes(humidity)[1] for humidity in humidities]


def _ratio_errors(changes):
    """Relative standard errors of mean forces by them (h,) [-]."""
    return np.array([change.ratio_error for change in changes])


def _error_at(force, pull_off, change):
    """Relative standard error of a force [N] of a distribution (m,) due to few strips in full contact [-].

    That of the ratio moves all forces, that of the power those far from the median.
    """
    if change == NONE or force <= 0:
        return 0.0
    return float(np.hypot(change.ratio_error, np.log(force / np.median(pull_off)) * change.power_error / change.power))


def stuck_with_band(pull_off: np.ndarray, force: float, change: ElasticChange) -> list[float]:
    """P(stuck) of patches (n,) at one restoring force [N] and the ends of its band, (3,) [-].

    The ends are those at forces that are smaller and larger by as much as their common relative error allows.
    """
    if np.isnan(force):
        return [np.nan] * 3
    factor = np.exp(_error_at(force, pull_off, change) * ndtri((1 + CONFIDENCE) / 2))
    estimate, low, high = (
        stuck_patches(pull_off, np.array([force]) * each)[k] for k, each in enumerate((1.0, factor, 1 / factor))
    )
    return [float(values[0]) for values in (estimate, low, high)]


def stuck_over(stopper: xr.Dataset, humidity: float, restoring: Iterable[float]) -> np.ndarray:
    """P(stuck) of a dataset of this stage over restoring forces (n,) [N], and the ends of its band, (3, n) [-].

    At the restoring force of the device they are those that the dataset states.
    """
    of_air = stopper.sel(humidity=humidity)
    errors = float(of_air.full_contact_error), float(of_air.full_contact_power_error)
    change = ElasticChange(ratio_error=errors[0], power_error=errors[1])
    return np.transpose([stuck_with_band(of_air.pull_off.values, force, change) for force in restoring])


def numbers_of_fits(seed: int) -> np.random.Generator:
    """Random numbers of the errors of fitted forces: the same for all stoppers, for comparable errors."""
    return stream(seed, "safe force")


def safe_forces_of(rows: np.ndarray, share: float, seed: int, changes: Sequence[ElasticChange]) -> list[SafeForce]:
    """Safe force for a share from each row of forces (rows, n) [N], with the errors of their changes.

    Margins of independent errors add by their squares on a logarithmic scale. Errors as of
    `stiction.devices.stoppers.safe_forces`.
    """
    estimates = safe_forces(rows, share, numbers_of_fits(seed))
    return [
        _with_error(safe, _error_at(safe.estimate, row, change))
        for safe, row, change in zip(estimates, rows, changes, strict=True)
    ]


def _with_error(safe, error):
    """Safe force with a further relative error [-]."""
    margin = np.log(safe.force / safe.estimate) if safe.estimate > 0 else 0.0
    more = np.hypot(margin, ndtri(CONFIDENCE) * error) - margin
    return replace(safe, force=safe.force * np.exp(more), error=np.hypot(safe.error, error * safe.estimate))


def _safe(rows, seed, changes):
    """Safe forces of rows of patches, their estimates and errors (3, rows, shares) [N], and the basis of each share.

    NaN, resting on nothing, for shares for which there are too few patches. No force is smaller than that for a larger
    share: a fit of all forces and an order statistic contradict each other within their errors.
    """
    numbers, bases = np.full((3, len(rows), len(SHARES)), np.nan), [""] * len(SHARES)
    for k, share in enumerate(SHARES):
        with suppress(ValueError):
            estimates = safe_forces_of(rows, share, seed, changes)
            numbers[..., k] = np.transpose([(safe.force, safe.estimate, safe.error) for safe in estimates])
            bases[k] = str(estimates[0].basis)
    numbers[0] = -in_order(-numbers[0, :, None], SHARES)[:, 0]
    return numbers, bases


def is_at_an_end(dataset: xr.Dataset) -> bool:
    """Whether the worst humidity is an end of the fine axis. The largest force may then lie beyond it."""
    return float(dataset.worst_humidity) in ends(dataset)


def ends(dataset: xr.Dataset) -> tuple[float, ...]:
    """Lowest and highest humidity of the fine axis [-]. None if the device has a single air, or dry air alone."""
    wet = dataset.axis.values[is_humid(dataset.axis.values)]
    return tuple(map(float, wet[[0, -1]])) if wet.size > 1 else ()


def in_any_air(dataset: xr.Dataset) -> tuple[tuple[float, float, float], xr.DataArray]:
    """Largest P(stuck) along the fine axis with the ends of its band, and largest safe force for every share [N]."""
    worst = dataset.stuck_along.isel(axis=int(dataset.stuck_along.sel(bound="estimate").argmax("axis")))
    return tuple(map(float, worst)), dataset.safe_force_along.max("axis", skipna=False)


def shares_stuck(dataset: xr.Dataset) -> Sequence[tuple[float, float, float, float]]:
    """Humidity, P(stuck) and the ends of its 95 % band, at every humidity of the device."""
    return [(float(h), *map(float, dataset.stuck.sel(humidity=h))) for h in dataset.humidity.values]


def bounded_share(stopper: xr.Dataset) -> float | None:
    """Smallest fraction with a bound from the patches of a stopper alone at all its humidities, or none."""
    bounds = stopper.safe_force.sel(part="safe").max("humidity", skipna=False)
    sampled = bounds.where(stopper.basis == Basis.SAMPLED)
    return min((float(share) for share in stopper.share if np.isfinite(sampled.sel(share=share))), default=None)


def _settings(plan, at):
    """Water, patch, restoring force and humidities of a stopper, and its fine axis of humidities."""
    section, air = plan.config["devices"][at.device], plan.air_of_devices
    pair = air.contact(section["pair"], max(section["humidities"]))
    values = {"seed": plan.config["seed"], "water": air.water(pair)}
    values |= {"worst_humidities": search_ends(plan.config["design"], section)}
    return select(Settings, plan.devices.stated(at.device) | values)


def _inputs(plan, at):
    """Contact in the wettest air of a stopper, and in dry air if it is one of its humidities."""
    humidities = plan.config["devices"][at.device]["humidities"]
    wettest, driest = (case_id(at.device, end(humidities)) for end in (max, min))
    dry = {"dry": contact_of(plan, driest)} if has_dry(humidities) else {}
    return {"contact": contact_of(plan, wettest)} | dry | corrections_of(plan, at.device, *humidities)


_STOPPERS = Stage.writing(
    "stoppers",
    "devices/stoppers/{device}",
    inputs=_inputs,
    settings=_settings,
    kind=Settings,
    complete=with_correction,
    compute=compute,
    message="Pull-off force of stopper {device}.",
    running=Running(priority=1),
)


def _inputs_tilted(plan, at):
    """Inputs of a stopper, with the contacts of tilted patches if a tilt is not zero, see `_inputs`."""
    inputs, humidities = _inputs(plan, at), plan.config["devices"][at.device]["humidities"]
    if not any(plan.devices.slopes(at.device)):
        return inputs
    dry = {"tilted_dry": tilted_of(plan, case_id(at.device, 0))} if has_dry(humidities) else {}
    return inputs | {"tilted": tilted_of(plan, case_id(at.device, max(humidities)))} | dry


def _settings_of_dimples(plan, at):
    """Water, humidity and dimples of a beam."""
    water = plan.air_of_devices.water(plan.contact_of_device(at.case))
    dimples = plan.devices.sections[at.case.device]["dimples"]
    return select(DimpleForces, dimples | {"water": water, "humidity": at.case.humidity})


STAGES = (
    _STOPPERS,
    Stage.writing(
        "dimples",
        "devices/dimples/{case}",
        inputs=lambda plan, at: (
            {"contact": dimples_of(plan, at.case)} | corrections_of(plan, at.case.device, at.case.humidity)
        ),
        settings=_settings_of_dimples,
        kind=DimpleForces,
        complete=with_correction,
        compute=compute_dimples,
        message="Pull-off force of the dimples of {case}.",
    ),
    replace(
        _STOPPERS,
        name="tilted_stoppers",
        files={"dataset": "devices/tilted/{device}"},
        inputs=_inputs_tilted,
        settings=lambda plan, at: _settings(plan, at) | {"slopes": plan.devices.slopes(at.device)},
        kind=Tilted,
        compute=compute_tilted,
        message="Pull-off force of tilted stopper {device}.",
    ),
    replace(
        _STOPPERS,
        name="stoppers_at_voltage",
        files={"dataset": "devices/at_voltage/{device}"},
        settings=lambda plan, at: at_voltage(plan, at.device, _settings(plan, at)),
        compute=compute_at_voltage,
        message="Pull-off force of stopper {device} at its voltage.",
    ),
)
