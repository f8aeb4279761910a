"""Conditions of a device and errors of its inputs, from the datasets of its stages."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from itertools import product

import numpy as np
import xarray as xr

from stiction.answer.data import Cause
from stiction.answer.unknowns import Exact, Members, OfBudgets, OfTestBeams, Slopes, Unknowns
from stiction.answer.worlds import Condition, Sampled, StatedSize
from stiction.devices.risk import sampled_bound
from stiction.life import holding
from stiction.stages.devices.budget import members_of, response_of
from stiction.stages.devices.opening import EITHER, FORCE, SOUGHT_BY, DesignedBeam
from stiction.stages.devices.safe_lengths import chosen_share
from stiction.stages.life.answers import Name, answers_of
from stiction.stages.life.separation import of_beam
from stiction.stages.test_beams.inference import is_reliable, shape_of

# Beams


def of_lengths(
    lengths: Mapping[float, xr.Dataset], cause: Cause, source: str, after: Mapping[float, xr.Dataset] | None = None
) -> Iterator[Condition]:
    """Yield conditions of a beam from its safe lengths by humidity, one for each end state.

    ``after`` are those for many touchdowns, if there are some.
    """
    for humidity, dataset in lengths.items():
        for shape in map(str, dataset["shape"].values):
            datasets = [dataset.sel(share=chosen_share(dataset)), *([after[humidity].isel(share=0)] if after else [])]
            sampled = _sampled_lengths(*(dataset_of_share.sel(shape=shape) for dataset_of_share in datasets))
            yield Condition(humidity, shape, cause, source, sampled)


def _sampled_lengths(once, *more):
    """Sticking lengths in one end state, with the safe lengths for one touchdown and more."""
    sizes = tuple(_stated_length(*(float(row[name]) for name in _STATED)) for row in (once, *more))
    ends = (_log(end) for end in (once.reach, once.floor, once.flooded_length))
    error = float(once.surfaces_error / once.estimate) if np.isfinite(once.estimate) else 0.0
    return Sampled(_log(once.sticking_length.values), sizes, *map(float, ends), float(np.nan_to_num(error)))


#: Fraction, estimate and bound of lengths in their datasets.
_STATED = ("share", "estimate", "safe_length")


def _stated_length(share, estimate, bound):
    """Safe length as v."""
    estimate, bound = _log(estimate), _log(bound)
    return StatedSize(share, float(max(estimate, bound)), float(bound))


def _log(sizes):
    """Logarithm of sizes, minus infinity of zero."""
    with np.errstate(divide="ignore"):
        return np.log(np.asarray(sizes, float))


def separated_fast(
    slow: Iterable[Condition],
    strips: Mapping[float, xr.Dataset],
    tips: Mapping[float, xr.Dataset],
    device: DesignedBeam,
) -> list[Condition]:
    """Conditions of a beam that separates faster than water evaporates; none where nothing bounds one of them."""
    factors = of_beam(strips, tips, device) if strips else None
    if factors is None or not (factors.factor > 0).all():
        return []
    conditions = [condition for condition in slow if condition.humidity in factors.humidity]
    shifted = []
    for condition in conditions:
        change = factors.sel(humidity=condition.humidity, shape=condition.shape)
        factor, error = float(change.factor), float(change.factor_error)
        source = "fast_tips" if condition.shape == EITHER else "fast_strips"
        shifted.append(replace(condition, cause=Cause.FAST, source=source, shift=np.log(factor), error=error / factor))
    return shifted


def at_voltage_on_flats(slow: Iterable[Condition], life: xr.Dataset, device: DesignedBeam) -> Iterator[Condition]:
    """Yield conditions of tips at a voltage as if flats were at the distance of the dielectric."""
    added = max((row.high for row in answers_of(life) if row.name == Name.VOLTAGE_ENERGY), default=np.nan)
    for condition in slow:
        if added > 0 and condition.shape == EITHER:
            at = condition.sampled.moved(lambda v: _log(holding.tip_length_at_voltage(np.exp(v), device.beam, added)))
            yield replace(condition, cause=Cause.VOLTAGE, source="life", sampled=at)


def drying(life: xr.Dataset, liquids: Iterable[str], humidities: Iterable[float]) -> Iterator[Condition]:
    """Yield bounds of the length of a beam that dries in stated liquids, whatever air it meets afterwards.

    Their errors are those of the dimensions.
    """
    names = {f"{Name.COLLAPSE}_{liquid}" for liquid in liquids}
    rows = [row for row in answers_of(life) if row.name in names and 0 < row.low < np.inf]
    for humidity, row in product(humidities, rows):
        error = float(np.nan_to_num(row.error / row.low))
        yield Condition(humidity, row.name, Cause.DRYING, "life", bound=float(np.log(row.low)), error=error)


# Stoppers


def of_forces(
    forces: xr.DataArray, share: float | None, safe: xr.DataArray | None, errors: xr.DataArray | None, cause: Cause
) -> Iterator[Condition]:
    """Yield conditions of a stopper from its forces by humidity (n_rh, m) [N].

    ``safe`` has the forces for a fraction as a dataset states them, and ``errors`` the relative errors of all forces.
    """
    for humidity in map(float, forces.humidity.values):
        values = np.sort(-_log(forces.sel(humidity=humidity).values))
        error = 0.0 if errors is None else float(errors.sel(humidity=humidity))
        sizes = _stated_force(values, share, None if safe is None else safe.sel(humidity=humidity))
        yield Condition(
            humidity,
            FORCE,
            cause,
            "stoppers",
            Sampled(values, sizes, surfaces_error=error, is_bounded=share is not None),
        )


def _stated_force(values, share, safe):
    """Force for a fraction as v: as stated, or by order statistics; none is known without enough patches."""
    if share is None:
        return ()
    if safe is None:
        bound, estimate, _ = sampled_bound(values, share)
    else:
        bound, estimate = -_log(safe.sel(share=share, part=["safe", "estimate"]).values)
    return (StatedSize(share, max(float(estimate), float(bound)), float(bound)),)


def at_voltage_on_flat_patches(stopper: Iterable[Condition], life: xr.Dataset) -> Iterator[Condition]:
    """Yield conditions of a stopper at a voltage as if flats were at the distance of the dielectric."""
    added = max((row.high for row in answers_of(life) if row.name == Name.AT_VOLTAGE), default=np.nan)
    for condition in stopper:
        if added > 0:
            at = condition.sampled.moved(lambda v: -_log(np.exp(-v) + added))
            yield replace(condition, cause=Cause.VOLTAGE, source="life", sampled=at)


# Inputs


def of_budgets(budgets: Iterable[xr.Dataset], humidities: Iterable[float]) -> Unknowns:
    """Errors of the inputs of a device by its budgets at some humidities."""
    slopes = {}
    for humidity, dataset in zip(humidities, budgets, strict=True):
        response, _ = response_of(dataset)
        if dataset.sizes["input"] or "member" in dataset.dims:
            slopes[humidity, shape_of(response)] = _slopes(dataset, SOUGHT_BY[response].sign)
    return OfBudgets(slopes) if slopes else Exact()


def of_test_beams(update: xr.Dataset | None) -> Unknowns | None:
    """Errors as test beams leave them; none if nothing explains their data, or they show nothing about a result."""
    if update is None or not is_reliable(update) or update.result_after.isnull().any():
        return None
    quantiles = {}
    rows = zip(update.humidity_of_result.values, update.response.values, update.result_quantile.values, strict=True)
    for humidity, response, row in rows:
        quantiles[float(humidity), shape_of(str(response))] = (
            -row[::-1] if SOUGHT_BY[str(response)].more_is_better else row
        )
    return OfTestBeams(update.score.values, quantiles)


def _slopes(dataset, sign):
    """Slopes of v by the inputs of a budget."""
    names, groups = (tuple(map(str, dataset[name].values)) for name in ("input", "group"))
    numbers = sign * dataset.slope.values, dataset.slope_error.values, sign * dataset.bend.values
    members = ()
    if "member" in dataset.dims:
        members = tuple(
            Members(str(name), sign * member.member_shift.values, member.member_error.values)
            for name, member in members_of(dataset).items()
        )
    limits = dataset.limit.values if "limit" in dataset else None
    return Slopes(names, groups, *numbers, dataset.covariance.values, members, limits)
