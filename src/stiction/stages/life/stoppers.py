"""Life of a stopper: what brings it into contact, holds and frees it, from its pull-off forces."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from stiction.config.units import from_si
from stiction.contact.air import Air
from stiction.devices.risk import Basis, one_in, sampled_bound, samples_for
from stiction.devices.stoppers import safe_force
from stiction.estimates import mean_with_error
from stiction.life import freeing, touch
from stiction.stages.life import answers as shared
from stiction.stages.life.answers import FREE, HOLD, STICK, TOUCH, LifeRow, Name, in_order, layout
from stiction.stages.life.inputs import StopperKeys


def dataset(data: Mapping[str, Any], keys: StopperKeys) -> xr.Dataset:
    """Dataset of the answers about a stopper, from its forces."""
    more = (data.get(name) for name in ("biased", "tilted", "separation"))
    return layout(stopper_answers(data["stopper"], keys, *more), keys)


def stopper_answers(
    stopper: xr.Dataset,
    keys: StopperKeys,
    biased: xr.Dataset | None = None,
    tilted: xr.Dataset | None = None,
    separation: xr.Dataset | None = None,
) -> list[LifeRow]:
    """Answers about a stopper from the datasets of its pull-off forces: as it is, at its voltage, tilted, and fast."""
    worst = int(stopper.mean_along.argmax("axis"))
    mean, error = (float(stopper[name][worst]) for name in ("mean_along", "mean_along_error"))
    where = Air(round(float(stopper.worst_humidity), 2)).where
    answers = [
        LifeRow(
            f"stuck_{float(humidity):g}",
            STICK,
            f"probability of sticking after one touchdown {Air(float(humidity)).where}",
            *map(float, stopper.stuck.sel(humidity=humidity, bound=["low", "high"])),
            *(np.nan, "1", "fraction of random patches, 95 %", "stage stoppers"),
        )
        for humidity in stopper.humidity.values
    ]
    subject = f"mean pull-off force {where}{', its largest' * (stopper.sizes['axis'] > 1)}"
    answers.append(
        LifeRow("force", HOLD, subject, mean, mean, error, "N", "largest attraction x area", "stage stoppers")
    )
    answers += stopper_moved(keys) + stopper_freed(stopper, keys, separation) + stopper_after_touchdowns(stopper, keys)
    answers += [] if tilted is None else tilted_answers(tilted)
    answers += stopper_at_voltage(stopper, keys, biased) if keys.capacitor else []
    return in_order(answers + stopper_unknown(answers, keys, float(stopper.share.max())))


def stopper_unknown(answers: Sequence[LifeRow], keys: StopperKeys, share: float) -> list[LifeRow]:
    """Rows for everything that a stopper does not say, with the keys that say it, first the one of it alone.

    ``share`` is the largest fraction of stuck stoppers that its forces are asked for.
    """
    samples = f"contact.samples of {samples_for(share)} or more"
    spring = "" if keys.stiffness else ", stiffness_N_per_m and gap_um"
    rows = (
        (Name.SHOCK, TOUCH, "peak of a shock that brings it into contact", "m s-2", "mass_ng"),
        (Name.VOLTAGE, TOUCH, "voltage on its electrode that brings it into contact", "V", f"electrode{spring}"),
        (Name.AT_VOLTAGE, HOLD, "force that a voltage adds", "N", shared.BY_VOLTAGE),
        (Name.RESTORING, FREE, "restoring force that frees nearly all", "N", samples),
        (Name.FREED, FREE, "shock that frees nearly all", "m s-2", samples if keys.mass else "mass_ng"),
    )
    return shared.missing(answers, [row for row in rows if not row[-1].startswith(keys.unasked)])


def stopper_moved(keys: StopperKeys) -> list[LifeRow]:
    """Shock and voltage for contact of a stopper, as far as mass and electrode are given."""
    answers = []
    if keys.mass:
        slow = keys.restoring_force / keys.mass
        form = f"a = F / m; {shared.pulses(touch.HALF_SINE, touch.RECTANGLE)}; at most: a slow shock"
        numbers = slow / touch.HALF_SINE, slow, np.nan
        subject = "peak of a shock that brings it into contact"
        answers.append(LifeRow(Name.SHOCK, TOUCH, subject, *numbers, "m s-2", form, "stiction.life.touch"))
    if keys.electrode:
        electrode = keys.stiffness, keys.gap, keys.electrode.area, keys.electrode.gap
        numbers = touch.stopper_voltage_at_once(*electrode), touch.stopper_voltage(*electrode), np.nan
        form = "V² = k u g (g - u) / (ε₀ A), at g / 2 or its way, less by fringes of a square (at least: at once); "
        form += "V² = 2 k u (g - u)² / (ε₀ A), at g / 3 or its way (at most: slowly)"
        subject = "voltage on its electrode that brings it into contact"
        answers.append(LifeRow(Name.VOLTAGE, TOUCH, subject, *numbers, "V", form, "stiction.life.touch"))
    return answers


def _fewest_bounded(dataset):
    """Smallest fraction that the patches of a stopper bound by themselves, or none."""
    return min(map(float, dataset.share[dataset.basis == Basis.SAMPLED]), default=None)


def _worst_force(stopper, share):
    """Largest safe force for a fraction [N], the error of its estimate [N], and its humidity [-]."""
    at = stopper.safe_force.sel(share=share)
    at = at.isel(humidity=int(at.sel(part="safe").argmax("humidity")))
    return float(at.sel(part="safe")), float(at.sel(part="error")), float(at.humidity)


def stopper_freed(stopper: xr.Dataset, keys: StopperKeys, separation: xr.Dataset | None) -> list[LifeRow]:
    """Restoring force, stiffness and shock that free all but a small fraction of the stoppers, slowly and fast."""
    if (share := _fewest_bounded(stopper)) is None:
        return []
    force, error, humidity = _worst_force(stopper, share)
    fast = [] if separation is None else [safe_force(row, share)[0] for row in separation.pull_off.values]
    most = max([force, *fast]) if np.isfinite(fast).all() else np.nan
    but = f"all but {one_in(share)}, {Air(humidity).where}"
    source, bound = "stages stoppers and separation", "faster than water evaporates, in any of its air (at most)"
    form = f"quantile of the pull-off force, 95 %; {bound}"
    answers = [
        LifeRow(Name.RESTORING, FREE, f"restoring force that frees {but}", force, most, error, "N", form, source)
    ]
    if keys.gap:
        subject, form = f"stiffness of the spring that frees {but}", f"k = F / gap; {bound}"
        numbers = (number / keys.gap for number in (force, most, error))
        answers.append(LifeRow("stiffness", FREE, subject, *numbers, "N m-1", form, source))
    if keys.mass:
        shocks = (freeing.freeing_acceleration(hold, keys.restoring_force, keys.mass) for hold in (force, most))
        subject, form = f"shock that frees {but}", f"a = (F_hold - F) / m; {bound}"
        numbers = *shocks, error / keys.mass
        answers.append(LifeRow(Name.FREED, FREE, subject, *numbers, "m s-2", form, "stiction.life.freeing"))
    return answers


def stopper_after_touchdowns(stopper: xr.Dataset, keys: StopperKeys) -> list[LifeRow]:
    """P(stuck) after all touchdowns in the worst given air, and the force for a small fraction stuck.

    The bounds are those of the 95 % band of P: what none of the patches do bounds it from above alone.
    """
    if keys.touchdowns == 1:
        return []
    once, most = (float(stopper.stuck.sel(bound=bound).max()) for bound in ("low", "high"))
    form = "P (at least) and 1 - (1 - P)^n (at most), of the 95 % band of P"
    numbers, after = f"{keys.touchdowns} touchdowns", freeing.stuck_after(most, keys.touchdowns)
    subject = f"probability of sticking after {numbers}"
    answers = [LifeRow("stuck_after", FREE, subject, once, after, np.nan, "1", form, "stiction.life.freeing")]
    share = float(stopper.share.max())
    rare = freeing.probability_for(share, keys.touchdowns)
    if stopper.sizes["sample"] >= samples_for(rare):
        few, many = (max(safe_force(row, p)[::2] for row in stopper.pull_off.values) for p in (share, rare))
        subject = f"restoring force that frees all but {one_in(share)} after {numbers}"
        form = "the same summits each time (at least); P of one = 1 - (1 - p)^(1/n) (at most)"
        answers.append(LifeRow(Name.AFTER, FREE, subject, few[0], many[0], few[1], "N", form, "stage stoppers"))
    return answers


def tilted_answers(tilted: xr.Dataset) -> list[LifeRow]:
    """Fraction of stoppers stuck at their tilts, the force on them, and the tilt at the transition to a wedge.

    At most counts every patch at the tilt at which it holds most, as if it landed at all of them.
    """
    tilts = [f"{from_si(float(tilt), 'deg'):.3g}" for tilt in tilted.tilt.values]
    by = f"tilted by {' to '.join(dict.fromkeys((tilts[0], tilts[-1])))}°"
    each = f"least of {len(tilts)} tilts, and each patch at its worst; " if len(tilts) > 1 else ""
    answers = [
        LifeRow(
            f"stuck_tilted_{float(humidity):g}",
            STICK,
            f"probability of sticking {by}, {Air(float(humidity)).where}",
            float(tilted.stuck.sel(humidity=humidity, bound="low").min()),
            float(tilted.largest_stuck.sel(humidity=humidity, bound="high")),
            *(np.nan, "1", f"{each}fraction of random patches, 95 %", "stage tilted_stoppers"),
        )
        for humidity in tilted.humidity.values
    ]
    most = tilted.isel(humidity=int(tilted.largest_mean.argmax("humidity")))
    low, air = int(most["mean"].argmin("tilt")), Air(float(most.humidity)).where
    numbers = float(most["mean"][low]), float(most.largest_mean), float(most.mean_error[low])
    form = f"{each}random patches; w e / s on smooth surfaces beyond the tilt of a wedge"
    answers.append(
        LifeRow(Name.TILTED, HOLD, f"mean pull-off force {by}, {air}", *numbers, "N", form, "stage tilted_stoppers")
    )
    subject, form = "tilt beyond which a longer first side hardly holds more", "e / (f_max a), parallel patches"
    numbers = float(tilted.wedge.min()), float(tilted.wedge.max()), np.nan
    answers.append(LifeRow(Name.WEDGE, HOLD, subject, *numbers, "rad", form, "stage tilted_stoppers"))
    return answers + _freed_tilted(tilted, by, f"{each}quantile of the force, 95 %")


def _freed_tilted(tilted, by, form):
    """Restoring force that frees all but a small fraction of the stoppers, none with too few patches."""
    if (share := _fewest_bounded(tilted)) is None:
        return []
    force, most = (tilted[name].sel(share=share).max("humidity") for name in ("safe_force", "largest_safe_force"))
    low = int(force.sel(part="safe").argmin("tilt"))
    numbers = float(force.sel(part="safe")[low]), float(most.sel(part="safe")), float(force.sel(part="error")[low])
    subject = f"restoring force that frees all but {one_in(share)}, {by}"
    return [LifeRow("restoring_force_tilted", FREE, subject, *numbers, "N", form, "stage tilted_stoppers")]


def stopper_at_voltage(stopper: xr.Dataset, keys: StopperKeys, biased: xr.Dataset | None) -> list[LifeRow]:
    """Force of a voltage in addition to that on a stopper, and the fraction stuck while it is on."""
    flat = keys.capacitor.largest_pressure * keys.contact[0] * keys.contact[1]
    low, error, sticking = np.nan, np.nan, []
    if biased is not None:
        gained = [mean_with_error(row) for row in (biased.pull_off - stopper.pull_off).values]
        low, error = max(gained)
        stuck = np.maximum(biased.stuck, stopper.stuck)
        worst = stuck.isel(humidity=int(stuck.sel(bound="estimate").argmax("humidity")))
        subject = f"probability of sticking while {keys.potential:g} V are on, {Air(float(worst.humidity)).where}"
        numbers = *map(float, worst.sel(bound=["low", "high"])), np.nan
        sticking = [
            LifeRow(
                "stuck_at_voltage",
                HOLD,
                subject,
                *numbers,
                "1",
                "as without voltage",
                shared.HELD_BY,
            )
        ]
    subject = f"force that {keys.potential:g} V add"
    form = "mean of rough patches (at least); ε₀ V² A / (2 D²) (at most)"
    added = LifeRow(Name.AT_VOLTAGE, HOLD, subject, min(low, flat), flat, error, "N", form, shared.HELD_BY)
    return [added, *sticking, shared.field_in_dielectric(keys), *_freeing_voltage(stopper, keys, biased)]


def _freeing_voltage(stopper, keys, biased):
    """Voltage below which the spring frees all but a small fraction: of flats, and of rough patches if there are any.

    An offset adds to the voltage, so that the voltage is lower by as much.
    """
    if (share := _fewest_bounded(stopper)) is None:
        return []
    area, (holding_force, error, _) = keys.contact[0] * keys.contact[1], _worst_force(stopper, share)
    low, high = freeing.freeing_potential_of_flats(keys.restoring_force - holding_force, keys.capacitor, area), np.nan
    if biased is not None:
        high = min(sampled_bound(row, share)[0] for row in biased.freeing_potential.values)
    spread = error / (2 * low * area * keys.capacitor.per_volt.largest_pressure) if low else np.nan
    numbers = *(max(potential - abs(keys.offset), 0.0) for potential in (low, high)), spread
    subject = f"voltage below which its spring frees all but {one_in(share)}"
    form = "V² = (F - F_hold) 2 D² / (ε₀ A), flats (at least); V² = min (p - f) / g of rough patches (at most)"
    return [LifeRow(Name.FREEING, FREE, subject, *numbers, "V", form, shared.HELD_BY)]
