"""Conditions of a device and errors of its inputs, from the datasets of its stages."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

import numpy as np
import xarray as xr

from stiction.answer.data import Cause
from stiction.answer.unknowns import Exact, Members, OfBudgets, OfTestBeams, Slopes, Unknowns
from stiction.answer.worlds import Condition, Sampled, Stated
from stiction.devices.risk import Basis, sampled_bound, samples_for
from stiction.devices.tail import FEWEST, TAIL, fit_tail
from stiction.stages.devices.budget import response_of
from stiction.stages.devices.opening import EITHER, FORCE, DesignedBeam
from stiction.stages.devices.safe_lengths import chosen_share
from stiction.stages.life.answers import AFTER, AT_VOLTAGE, COLLAPSE, answers_of
from stiction.stages.life.separation import of_beam
from stiction.stages.test_beams.inference import is_reliable, shape_of

#: Smallest number, in place of a force of zero.
_TINY = np.finfo(float).tiny


# Beams


def of_lengths(lengths: Mapping[float, xr.Dataset], cause: Cause, source: str) -> Iterator[Condition]:
    """Yield conditions of a beam from its safe lengths by humidity, one for each end state."""
    for humidity, dataset in lengths.items():
        for shape in map(str, dataset["shape"].values):
            yield Condition(humidity, shape, cause, source, _sampled_lengths(dataset.sel(shape=shape)))


def _sampled_lengths(one):
    """Sticking lengths in one end state with the safe length for the chosen fraction."""
    at = one.sel(share=chosen_share(one))
    values, reach = np.log(one.sticking_length.values), float(np.log(one.reach))
    estimate, bound, floor = (float(np.log(np.maximum(of, _TINY))) for of in (at.estimate, at.safe_length, one.floor))
    within = np.where(values <= reach, values, np.inf)
    is_line = str(at.basis.values) not in (Basis.LONGEST, Basis.FLAT) and np.isfinite(within).sum() >= FEWEST
    stated = Stated(float(at.share), max(estimate, bound) if is_line else bound, bound)
    tail = fit_tail(np.exp(within)) if is_line else None
    error = float(np.nan_to_num(at.surfaces_error / at.estimate)) if is_line else 0.0
    return Sampled(values, tail, stated, reach, floor, error)


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
    wet = [one for one in slow if one.humidity in factors.humidity]
    found = []
    for one in wet:
        of = factors.sel(humidity=one.humidity, shape=one.shape)
        factor, error = float(of.factor), float(of.factor_error)
        source = "fast_tips" if one.shape == EITHER else "fast_strips"
        found.append(replace(one, cause=Cause.FAST, source=source, shift=np.log(factor), error=error / factor))
    return found


def of_life(life: xr.Dataset, liquids: Iterable[str], worst: Condition) -> Iterator[Condition]:
    """Yield bounds of the length of a beam by other routes: at its voltage, after touchdowns, in stated liquids.

    The first two have the air and the end state of the worst condition, whose inputs they share.
    """
    named = {AFTER: Cause.TOUCHDOWNS, AT_VOLTAGE: Cause.VOLTAGE}
    named |= {f"{COLLAPSE}_{liquid}": Cause.DRYING for liquid in liquids}
    for row in answers_of(life):
        if row.name not in named or not 0 < row.low < np.inf:
            continue
        cause, low = named[row.name], float(np.log(row.low))
        if cause is Cause.DRYING:  # whose uncertainty is due to inputs of its own
            error = float(np.nan_to_num(row.error / row.low))
            yield Condition(worst.humidity, row.name, cause, "life", bound=low, error=error)
        else:
            yield Condition(worst.humidity, worst.shape, cause, "life", bound=low)


# Stoppers


def of_forces(
    forces: xr.DataArray, share: float | None, safe: xr.DataArray | None, errors: xr.DataArray | None, cause: Cause
) -> Iterator[Condition]:
    """Yield conditions of a stopper from its forces by humidity (n_rh, m) [N].

    ``safe`` has the forces for a fraction as a dataset states them, and ``errors`` the relative errors of all forces.
    """
    for humidity in map(float, forces.humidity.values):
        values = np.sort(-np.log(np.maximum(forces.sel(humidity=humidity).values, _TINY)))
        error = 0.0 if errors is None else float(errors.sel(humidity=humidity))
        stated = _stated_force(values, share, None if safe is None else safe.sel(humidity=humidity))
        is_line = share is not None and TAIL * len(values) >= FEWEST
        tail = fit_tail(np.exp(values)) if is_line else None
        yield Condition(humidity, FORCE, cause, "stoppers", Sampled(values, tail, stated, surfaces_error=error))


def _stated_force(values, share, safe):
    """Force for a fraction as v: as stated, or by order statistics; none is known without enough patches."""
    if share is None or len(values) < samples_for(share):
        return Stated(share or 0.5, -np.inf, -np.inf)
    if safe is None:
        bound, estimate, _ = sampled_bound(values, share)
    else:
        bound, estimate = -np.log(np.maximum(safe.sel(share=share, part=["safe", "estimate"]).values, _TINY))
    return Stated(share, max(float(estimate), float(bound)), float(bound))


def at_voltage_on_flats(stopper: xr.Dataset, life: xr.Dataset, share: float | None) -> Iterator[Condition]:
    """Yield the force that suffices at a voltage if flats were at the distance of the dielectric."""
    rows = {row.name: row for row in answers_of(life)}
    if share is None or AT_VOLTAGE not in rows or not np.isfinite(rows[AT_VOLTAGE].high):
        return
    safe = stopper.safe_force.sel(part="safe", share=share)
    worst = float(stopper.humidity[int(safe.argmax("humidity"))])
    force = float(safe.max()) + rows[AT_VOLTAGE].high
    yield Condition(worst, FORCE, Cause.VOLTAGE, "life", bound=float(-np.log(force)))


# Inputs


def of_budgets(budgets: Iterable[xr.Dataset], humidities: Iterable[float]) -> Unknowns:
    """Errors of the inputs of a device by its budgets at some humidities."""
    found = {}
    for humidity, dataset in zip(humidities, budgets, strict=True):
        response, _ = response_of(dataset)
        if dataset.sizes["input"] or "member" in dataset.dims:
            found[humidity, shape_of(response)] = _slopes(dataset, -1.0 if response == FORCE else 1.0)
    return OfBudgets(found) if found else Exact()


def of_test_beams(update: xr.Dataset | None) -> Unknowns | None:
    """Errors as test beams leave them; none if nothing explains their data, or they show nothing about a result."""
    if update is None or not is_reliable(update) or update.result_after.isnull().any():
        return None
    quantiles = {}
    rows = zip(update.humidity_of_result.values, update.response.values, update.result_quantile.values, strict=True)
    for humidity, response, row in rows:
        quantiles[float(humidity), shape_of(str(response))] = -row[::-1] if response == FORCE else row
    return OfTestBeams(update.score.values, quantiles)


def _slopes(dataset, sign):
    """Slopes of v by the inputs of a budget."""
    names, groups = (tuple(map(str, dataset[name].values)) for name in ("input", "group"))
    numbers = sign * dataset.slope.values, dataset.slope_error.values, sign * dataset.bend.values
    members = ()
    if "member" in dataset.dims:
        by_surface = dataset.member_shift.groupby("member_of")
        members = tuple(Members(str(name), sign * shifts.values) for name, shifts in by_surface)
    return Slopes(names, groups, *numbers, dataset.covariance.values, members)
