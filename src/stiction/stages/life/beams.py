"""Life of a beam: what brings it down, holds and frees it, from its safe lengths.

Numbers of a length are those of the stated one, or of the least safe length.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from stiction.beam.energy import apparent_adhesion_energy
from stiction.config.units import from_si
from stiction.contact.air import Air
from stiction.devices.risk import one_in
from stiction.life import drying, freeing, holding, touch
from stiction.stages.devices.safe_lengths import chosen_share
from stiction.stages.life import answers as shared
from stiction.stages.life.answers import FREE, HOLD, STICK, TOUCH, LifeRow, Name, in_order, layout
from stiction.stages.life.dimples import dimple_answers
from stiction.stages.life.inputs import BeamKeys, Liquid
from stiction.stages.life.separation import of_beam

#: Forms of the rows of a beam with play.
_NEAREST = "beams on the samples nearest to their register"
_OFFSETS = "the same offset each time (at least); 1 - (1 - p)^n, another one each time (at most)"
#: Relative step of a length for the derivative of the one at a voltage.
_STEP = 1e-4
#: Rows of a beam: name, question, what, unit and keys.
_BEAM = (
    (Name.VOLTAGE, TOUCH, "voltage that pulls it in", "V", "length_um"),
    (Name.SHOCK, TOUCH, "peak of a shock that brings it down", "m s-2", "length_um"),
    (Name.HELD, HOLD, "adhesion energy that holds it along the beam", "J m-2", "length_um"),
    (Name.PULL, FREE, "force with which it pulls at its contact", "N", "length_um"),
    (Name.VOLTAGE_ENERGY, HOLD, "adhesion energy that a voltage adds", "J m-2", shared.BY_VOLTAGE),
)


def dataset(data: Mapping[str, Any], keys: BeamKeys) -> xr.Dataset:
    """Dataset of the answers about a beam, from its safe lengths."""
    strips, tips = (data.get(name, {}) for name in ("fast_strips", "fast_tips"))
    fast = of_beam(strips, tips, keys.device) if strips else None
    answers = beam_answers(data["lengths"], data.get("after", {}), keys, data.get("biased"), fast)
    answers += dimple_answers(keys, data.get("dimples", {}))
    return layout(in_order(answers), keys, length_of(data["lengths"], keys))


def beam_answers(
    lengths: Mapping[float, xr.Dataset],
    after: Mapping[float, xr.Dataset],
    keys: BeamKeys,
    biased: Mapping[float, xr.Dataset] | None = None,
    separation: xr.Dataset | None = None,
) -> list[LifeRow]:
    """Answers about a beam from its safe lengths by humidity: for one touchdown, after all, and at its voltage.

    The dataset of its fast separation is needed where water condenses.
    """
    share = chosen_share(next(iter(lengths.values())))
    safe = {humidity: least_safe(dataset, share) for humidity, dataset in lengths.items()}
    length = length_of(lengths, keys)
    answers = [
        LifeRow(
            f"{Name.SAFE}{humidity:g}",
            STICK,
            f"simulated limit {Air(humidity).where}: at most {one_in(share)} sticks after one touchdown",
            *(value, value, error),
            *("m", f"bound of random beams, 95 %, {basis}", "stage safe_lengths"),
        )
        for humidity, (value, error, basis) in safe.items()
    ]
    answers += beam_touched(keys, length) + beam_held(keys, length) if 0 < length < np.inf else []
    answers += [answer for name, liquid in keys.liquids.items() for answer in lengths_after_drying(keys, name, liquid)]
    answers += beam_after_touchdowns(keys, share, min(safe.values()), after) if after else []
    answers += beam_at_registers(keys, length, lengths)
    answers += separated_fast(lengths, separation) if separation is not None else []
    answers += beam_at_voltage(keys, min(safe.values()), biased)
    return in_order(answers + shared.missing(answers, _BEAM))


def length_of(lengths: Mapping[float, xr.Dataset], keys: BeamKeys) -> float:
    """Length of a beam for voltage and shock [m]: the given one, or its least safe length."""
    return keys.length or min(least_safe(dataset, chosen_share(dataset))[0] for dataset in lengths.values())


def least_safe(dataset: xr.Dataset, share: float) -> tuple[float, float, str]:
    """Least safe length of all end states [m], the standard error of its estimate, and its basis."""
    shapes = dataset.sel(share=share)
    worst = shapes.isel(shape=int(shapes.safe_length.argmin("shape")))
    return *length_and_error(worst), str(worst.basis.values)


def length_and_error(state: xr.Dataset) -> tuple[float, float]:
    """Safe length of one end state [m], and the standard error of its estimate; NaN if none is known."""
    errors = [float(state[name]) for name in ("beams_error", "surfaces_error")]
    return float(state.safe_length), float(np.sqrt(np.nansum(np.square(errors)))) or np.nan


def beam_touched(keys: BeamKeys, length: float) -> list[LifeRow]:
    """Voltage and shock for contact of a beam of a length [m]."""
    return [_pulled_in(keys, length), _shaken(keys, length)]


#: Ends of beams that touch, by the number of clamps, and what is said of the upper bounds of bridges.
_ENDS, _RIGID = {1: "tip", 2: "middle"}, {1: "", 2: ", rigid clamps"}


def _pulled_in(keys, length):
    """Voltage that pulls in a beam of a length [m]."""
    clamps, beam = keys.clamps, keys.beam(length)
    low, error = keys.number(lambda beam: touch.pull_in_voltage_at_once(beam, clamps), length)
    high = touch.pull_in_voltage(
        beam, clamps, rigid=True, dielectric=keys.dielectric.distance if keys.dielectric else 0.0
    )
    form = {1: "V² = 0.2801 E t³ h³ / (ε₀ L⁴)", 2: "V² = λ E t³ h³ / (6 ε₀ L⁴), λ = 70.095 without tension"}[clamps]
    form += f"; at least: switched on at once, with fringes; at most: raised slowly, without fringes{_RIGID[clamps]}"
    subject = f"voltage that pulls the {_ENDS[clamps]} in"
    return LifeRow(Name.VOLTAGE, TOUCH, subject, low, high, error, "V", form, "stiction.life.touch")


def _shaken(keys, length):
    """Peak of a shock that brings down a beam of a length [m]."""
    clamps, beam = keys.clamps, keys.beam(length)
    slow, error = keys.number(lambda beam: touch.touching_acceleration(beam, clamps, keys.density), length)
    sine, rectangle = (touch.shock_factor(beam, clamps, pulse) for pulse in (touch.HALF_SINE, touch.RECTANGLE))
    high = touch.touching_acceleration(beam, clamps, keys.density, rigid=True)
    form = {1: "a = 2 E t² h / (3 ρ L⁴)", 2: "a = 32 E t² h / (ρ L⁴) without tension"}[clamps]
    form += f", ρ = {keys.density:g} kg/m³; {shared.pulses(sine, rectangle)}; at most: a slow shock{_RIGID[clamps]}"
    subject = f"peak of a shock that brings the {_ENDS[clamps]} down"
    return LifeRow(Name.SHOCK, TOUCH, subject, slow / sine, high, error / sine, "m s-2", form, "stiction.life.touch")


def lengths_after_drying(keys: BeamKeys, name: str, liquid: Liquid) -> list[LifeRow]:
    """Lengths of beams standing while a liquid dries, and releasing afterwards."""
    clamps, adhesion, wetting = keys.clamps, liquid.adhesion, (liquid.surface_tension, liquid.contact_angle)
    each, error = keys.number(lambda beam: drying.longest_standing_each(beam, clamps, *wetting), 1.0)
    free, free_error = keys.number(lambda beam: drying.longest_free(beam, clamps, adhesion), 1.0)
    connected = drying.longest_standing(keys.beam(1.0), clamps, adhesion)
    standing, released = {
        1: ("L⁴ = N E t³ h² / (γ cos θ), N = 0.2295 (connected, at most)", "L⁴ = 3 E t³ h² / (16 γ cos θ)"),
        2: (
            "L⁴ = N E t³ h² / (γ cos θ), N = 8.466 (connected, at most) without tension",
            "two cracks meet at the energy 2 γ cos θ; shorter bridges may be held by their middle",
        ),
    }[clamps]
    standing += "; liquid everywhere, pinned at the edges (at least)"
    source = f"stiction.life.drying, γ cos θ = {from_si(adhesion, 'mN_per_m'):.3g} mN/m"
    return [
        LifeRow(
            f"{Name.COLLAPSE}_{name}",
            TOUCH,
            f"longest beam that does not collapse while {name} dries",
            *(each, connected, error),
            *("m", standing, source),
        ),
        LifeRow(
            f"{Name.RELEASED}_{name}",
            STICK,
            f"longest beam that comes free after {name} dried",
            *(free if clamps == 1 else np.nan, free, free_error),
            *("m", released, source),
        ),
    ]


def beam_held(keys: BeamKeys, length: float) -> list[LifeRow]:
    """Adhesion of a stuck beam of a length [m], and its pulling force."""
    clamps = keys.clamps
    along, error = keys.number(lambda beam: float(apparent_adhesion_energy(length / clamps, beam)), length)
    force, force_error = keys.number(lambda beam: freeing.force_at_contact(beam, clamps), length)
    forms = {
        1: ("Γ = 3 E t³ h² / (2 L⁴), Eq. (13)", "F = 3 E I h / L³"),
        2: ("energy at which two cracks meet; more if rigid clamps stretch it",)
        + ("F = 192 E I h / L³ without tension; more if rigid clamps stretch it",),
    }[clamps]
    most, most_force = (along, force) if clamps == 1 else (np.nan, np.nan)
    answers = [
        LifeRow(
            Name.HELD,
            HOLD,
            "adhesion energy that holds it along the beam" if clamps == 1 else "adhesion energy that holds both cracks",
            *(along, most, error, "J m-2", forms[0], "stiction.beam.energy"),
        ),
        LifeRow(
            Name.PULL,
            FREE,
            f"force with which it pulls at its {'tip' if clamps == 1 else 'middle'}",
            *(force, most_force, force_error, "N", forms[1], "stiction.life.freeing"),
        ),
    ]
    if clamps == 1:
        tip, form = along / 4, "Γ = 3 E t³ h² / (8 L⁴)"
        subject = "adhesion energy that holds its tip, on uniform surfaces"
        answers.append(LifeRow("tip", HOLD, subject, tip, tip, error / 4, "J m-2", form, "stiction.devices.arcs"))
    return answers


def beam_after_touchdowns(
    keys: BeamKeys, share: float, once: tuple[float, float, str], after: Mapping[float, xr.Dataset]
) -> list[LifeRow]:
    """Safe length and P(stuck) after all touchdowns, from the safe length of one, and its standard error [m].

    Both bounds have errors of the simulation. More touchdowns never allow a longer beam.
    """
    independent = min(once, *(least_safe(dataset, chosen_share(dataset)) for dataset in after.values()))
    stuck = freeing.stuck_after(share, keys.touchdowns)
    numbers = f"{keys.touchdowns} touchdowns"
    return [
        LifeRow(
            Name.AFTER,
            FREE,
            f"simulated limit for {numbers}: at most {one_in(share)} sticks after all of them",
            *(independent[0], once[0], independent[1], "m"),
            "P of one = 1 - (1 - p)^(1/n) (at least); the same summits each time (at most)",
            "stage touchdowns",
        ),
        LifeRow(
            "stuck_after",
            FREE,
            f"probability of sticking after {numbers} at the limit of one",
            *(np.nan, stuck, np.nan, "1", "1 - (1 - p)^n; p with the same summits each time", "stiction.life.freeing"),
        ),
    ]


def beam_at_registers(keys: BeamKeys, length: float, lengths: Mapping[float, xr.Dataset]) -> list[LifeRow]:
    """P(stuck) along a beam of a length [m] with play: in register, at a random offset, and after all touchdowns.

    The worst of all airs counts. ASSUME: each touchdown has an offset of its own, and is then another meeting. Of ten
    touchdowns of strips like B2 with a coherence of 0.9, 10 ± 1 count at a play of 20 nm, and 6 ± 1 at 5 nm.
    """
    with_play = [dataset for dataset in lengths.values() if "register_sticking_length" in dataset]
    if not with_play:
        return []
    shares = [[each.register_sticking_length, each.sticking_length[0]] for each in with_play]
    (register, once), number = np.max(np.mean(np.less(shares, length), axis=-1), axis=0), keys.touchdowns
    stuck, many = freeing.stuck_after(once, number), f"{number} touchdowns" if number > 1 else "one touchdown"
    errors = [float(np.sqrt(p * (1 - p) / with_play[0].sizes["device"])) for p in (register, once)]
    subject = "probability of sticking along the beam"
    return [
        LifeRow(
            "register", FREE, f"{subject} in register", register, register, errors[0], "1", _NEAREST, "stage cracks"
        ),
        LifeRow("offsets", FREE, f"{subject} after {many}", once, stuck, errors[1], "1", _OFFSETS, "stage cracks"),
    ]


def separated_fast(lengths: Mapping[float, xr.Dataset], separation: xr.Dataset) -> list[LifeRow]:
    """Safe length of a beam that separates faster than water evaporates, by humidity and end state, in the worst one.

    It is at most that of slow separation.
    """
    slow, fast = [], []
    for humidity, dataset in lengths.items():
        shapes = dataset.sel(share=chosen_share(dataset))
        for shape in map(str, shapes["shape"].values):
            length, spread = length_and_error(shapes.sel(shape=shape))
            factor, error = 1.0, 0.0  # in air without water
            if humidity in separation.humidity.values:
                at = separation.sel(humidity=humidity, shape=shape)
                factor, error = float(at.factor), float(at.factor_error)
            slow.append(length)
            shorter = length * factor if factor else 0.0
            fast.append((shorter, float(np.hypot(spread * factor, length * error)), factor, Air(humidity).where))
    shorter, error, factor, air = min(fast)
    form = f"L x {factor:.3g} {air}, by (e / e_V)^(1/4) of strips or lengths of tips (at least); slow (at most)"
    subject = "simulated limit if it separates faster than water evaporates"
    numbers = (shorter, min(slow), error) if 0 < shorter < np.inf else (np.nan, min(slow), np.nan)
    return [LifeRow(Name.FAST, FREE, subject, *numbers, "m", form, "stage separation")]


def beam_at_voltage(
    keys: BeamKeys, safe: tuple[float, float, str], biased: Mapping[float, xr.Dataset] | None
) -> list[LifeRow]:
    """Effect of a voltage, and the length safe with it, from the safe length without it and its error [m].

    On flats in contact, and on rough surfaces from the safe lengths at the voltage by humidity, if there are any.
    """
    if not keys.capacitor:
        return []
    added = holding.energy_of_voltage(keys.capacitor, keys.device.gap)
    distance = from_si(keys.dielectric.distance, "nm")
    form = f"mean over samples (at least); Γ_V = ε₀ V² / 2 (1 / D - 1 / (D + h)), D = {distance:.3g} nm (at most)"
    at_voltage = list((biased or {}).values())
    gained = [(float(dataset.voltage_energy), float(dataset.voltage_error)) for dataset in at_voltage]
    low, error = max(gained, default=(np.nan, np.nan))
    subject = f"adhesion energy that {keys.potential:g} V add"
    numbers = min(low, added), added, error
    added_energy = LifeRow(Name.VOLTAGE_ENERGY, HOLD, subject, *numbers, "J m-2", form, shared.HELD_BY)
    answers = [added_energy, shared.field_in_dielectric(keys)]
    numbers = _shorter(keys, added, safe, [least_safe(dataset, chosen_share(dataset)) for dataset in at_voltage])
    if np.isnan(numbers).all():
        return answers
    subject = f"simulated limit while {keys.potential:g} V are on"
    form = "(L / L_V)³ = 1 + 8 Γ_V L_V L³ / (3 E t³ h²), flats (at least); gaps of rough surfaces, L (at most)"
    return [*answers, LifeRow(Name.AT_VOLTAGE, HOLD, subject, *numbers, "m", form, shared.HELD_BY)]


def _shorter(keys, added, safe, rough):
    """Safe length at a voltage [m]: on flats, on rough surfaces, and an error of the first, or of the latter alone.

    NaN for bridges on flats, and on rough surfaces that were not computed. Tips are held at steeper slopes by more of
    their surfaces, so that rough ones can have the least length. A voltage holds more, so that no length is longer than
    without it, as far as bounds of other fits say so.
    """
    length, flat, error = safe[0], np.nan, np.nan
    high, high_error, _ = min(safe, *rough) if rough else (np.nan, np.nan, "")
    if keys.device.opening.has_tip and 0 < length < np.inf:
        flat, longer = (holding.tip_length_at_voltage(by * length, keys.beam(1.0), added) for by in (1, 1 + _STEP))
        error = safe[1] * (longer - flat) / (_STEP * length)
    if high < flat:
        return high, high, high_error
    return flat, high, high_error if np.isnan(flat) else error
