"""Causes of contact: voltage, shock and drying of a beam, shock and voltage of a stopper."""

import numpy as np

from stiction.config.units import from_si
from stiction.life import drying, touch
from stiction.stages.life.answers import COLLAPSE, RELEASED, SHOCK, STICK, TOUCH, VOLTAGE, Answer
from stiction.stages.life.inputs import Liquid, OfBeam, OfStopper


def beam_touched(of: OfBeam, length: float) -> list[Answer]:
    """Voltage and shock for contact of a beam of a length [m]."""
    return [_pulled_in(of, length), _shaken(of, length)]


#: Ends of beams that touch, by the number of clamps, and what is said of the upper bounds of bridges.
_ENDS, _RIGID = {1: "tip", 2: "middle"}, {1: "", 2: ", rigid clamps"}


def _pulled_in(of, length):
    """Voltage that pulls in a beam of a length [m]."""
    clamps, beam = of.clamps, of.beam(length)
    low, error = of.number(lambda beam: touch.pull_in_voltage_at_once(beam, clamps), length)
    high = touch.pull_in_voltage(beam, clamps, rigid=True, dielectric=of.dielectric.distance if of.dielectric else 0.0)
    form = {1: "V² = 0.2801 E t³ h³ / (ε₀ L⁴)", 2: "V² = λ E t³ h³ / (6 ε₀ L⁴), λ = 70.095 without tension"}[clamps]
    form += f"; at least: switched on at once, with fringes; at most: raised slowly, without fringes{_RIGID[clamps]}"
    what = f"voltage that pulls the {_ENDS[clamps]} in"
    return Answer(VOLTAGE, TOUCH, what, low, high, error, "V", form, "stiction.life.touch")


def _shaken(of, length):
    """Peak of a shock that brings down a beam of a length [m]."""
    clamps, beam = of.clamps, of.beam(length)
    slow, error = of.number(lambda beam: touch.touching_acceleration(beam, clamps, of.density), length)
    sine, rectangle = (touch.shock_factor(beam, clamps, pulse) for pulse in (touch.HALF_SINE, touch.RECTANGLE))
    high = touch.touching_acceleration(beam, clamps, of.density, rigid=True)
    form = {1: "a = 2 E t² h / (3 ρ L⁴)", 2: "a = 32 E t² h / (ρ L⁴) without tension"}[clamps]
    form += f", ρ = {of.density:g} kg/m³; {_pulses(sine, rectangle)}; at most: a slow shock{_RIGID[clamps]}"
    what = f"peak of a shock that brings the {_ENDS[clamps]} down"
    return Answer(SHOCK, TOUCH, what, slow / sine, high, error / sine, "m s-2", form, "stiction.life.touch")


def _pulses(sine, rectangle):
    """Lower bound of the peak of a half-sine, and of a rectangular pulse, in parts of a slow one."""
    return f"at least: / {sine:.3g}, any half-sine (a rectangular pulse: / {rectangle:.3g})"


def lengths_after_drying(of: OfBeam, name: str, liquid: Liquid) -> list[Answer]:
    """Lengths of beams standing while a liquid dries, and releasing afterwards."""
    clamps, adhesion, wetting = of.clamps, liquid.adhesion, (liquid.surface_tension, liquid.contact_angle)
    each, error = of.number(lambda beam: drying.longest_standing_each(beam, clamps, *wetting), 1.0)
    free, free_error = of.number(lambda beam: drying.longest_free(beam, clamps, adhesion), 1.0)
    connected = drying.longest_standing(of.beam(1.0), clamps, adhesion)
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
        Answer(
            f"{COLLAPSE}_{name}",
            TOUCH,
            f"longest beam that does not collapse while {name} dries",
            *(each, connected, error),
            *("m", standing, source),
        ),
        Answer(
            f"{RELEASED}_{name}",
            STICK,
            f"longest beam that comes free after {name} dried",
            *(free if clamps == 1 else np.nan, free, free_error),
            *("m", released, source),
        ),
    ]


def stopper_moved(of: OfStopper) -> list[Answer]:
    """Shock and voltage for contact of a stopper, as far as mass and electrode are given."""
    answers = []
    if of.mass:
        slow = of.restoring_force / of.mass
        form = f"a = F / m; {_pulses(touch.HALF_SINE, touch.RECTANGLE)}; at most: a slow shock"
        numbers = slow / touch.HALF_SINE, slow, np.nan
        what = "peak of a shock that brings it into contact"
        answers.append(Answer(SHOCK, TOUCH, what, *numbers, "m s-2", form, "stiction.life.touch"))
    if of.electrode:
        electrode = of.stiffness, of.gap, of.electrode.area, of.electrode.gap
        numbers = touch.stopper_voltage_at_once(*electrode), touch.stopper_voltage(*electrode), np.nan
        form = "V² = k u g (g - u) / (ε₀ A), at g / 2 or its way, less by fringes of a square (at least: at once); "
        form += "V² = 2 k u (g - u)² / (ε₀ A), at g / 3 or its way (at most: slowly)"
        what = "voltage on its electrode that brings it into contact"
        answers.append(Answer(VOLTAGE, TOUCH, what, *numbers, "V", form, "stiction.life.touch"))
    return answers
