"""Causes of contact: voltage, shock and drying of a beam, shock and voltage of a stopper."""

import numpy as np

from stiction.config.units import from_si
from stiction.life import drying, touch
from stiction.stages.life.answers import COLLAPSE, RELEASED, SHOCK, STICK, TOUCH, VOLTAGE, Answer
from stiction.stages.life.inputs import OfBeam, OfStopper


def beam_touched(of: OfBeam, length: float) -> list[Answer]:
    """Voltage and shock for contact of a beam of a length [m]."""
    clamps, end = of.clamps, "tip" if of.clamps == 1 else "middle"
    forms = {
        1: ("V² = 0.2801 E t³ h³ / (ε₀ L⁴)", "a = 2 E t² h / (3 ρ L⁴)"),
        2: (
            "V² = λ E t³ h³ / (6 ε₀ L⁴), λ = 70.095 without tension",
            "a = 32 E t² h / (ρ L⁴) without tension",
        ),
    }[clamps]
    rigid = "" if clamps == 1 else "; at most: rigid clamps"
    voltage, error = of.number(lambda beam: touch.pull_in_voltage(beam, clamps), length)
    shock, shock_error = of.number(lambda beam: touch.touching_acceleration(beam, clamps, of.density), length)
    factor, beam = touch.half_sine_factor(of.beam(length), clamps), of.beam(length)
    return [
        Answer(
            VOLTAGE,
            TOUCH,
            f"voltage that pulls the {end} in",
            *(voltage, touch.pull_in_voltage(beam, clamps, rigid=True), error),
            *("V", forms[0] + rigid, "stiction.life.touch"),
        ),
        Answer(
            SHOCK,
            TOUCH,
            f"peak of a shock that brings the {end} down",
            *(shock / factor, touch.touching_acceleration(beam, clamps, of.density, rigid=True), shock_error / factor),
            "m s-2",
            f"{forms[1]}, ρ = {of.density:g} kg/m³; at least: / {factor:.2f}, any half-sine{rigid}",
            "stiction.life.touch",
        ),
    ]


def lengths_after_drying(of: OfBeam, liquid: str, adhesion: float) -> list[Answer]:
    """Lengths of beams standing while a liquid dries, and releasing afterwards."""
    clamps = of.clamps
    each, error = of.number(lambda beam: drying.longest_standing_each(beam, clamps, adhesion), 1.0)
    free, free_error = of.number(lambda beam: drying.longest_free(beam, clamps, adhesion), 1.0)
    connected = drying.longest_standing(of.beam(1.0), clamps, adhesion)
    standing, released = {
        1: ("L⁴ = N E t³ h² / (γ cos θ), N = 0.1160 or 0.2295 (connected)", "L⁴ = 3 E t³ h² / (16 γ cos θ)"),
        2: (
            "L⁴ = N E t³ h² / (γ cos θ), N = 4.873 or 8.466 (connected) without tension",
            "two cracks meet at the energy 2 γ cos θ; shorter bridges may be held by their middle",
        ),
    }[clamps]
    source = f"stiction.life.drying, γ cos θ = {from_si(adhesion, 'mN_per_m'):.3g} mN/m"
    return [
        Answer(
            f"{COLLAPSE}_{liquid}",
            TOUCH,
            f"longest beam that does not collapse while {liquid} dries",
            *(each, connected, error),
            *("m", standing, source),
        ),
        Answer(
            f"{RELEASED}_{liquid}",
            STICK,
            f"longest beam that comes free after {liquid} dried",
            *(free if clamps == 1 else np.nan, free, free_error),
            *("m", released, source),
        ),
    ]


def stopper_moved(of: OfStopper) -> list[Answer]:
    """Shock and voltage for contact of a stopper, as far as mass and electrode are given."""
    answers = []
    if of.mass:
        slow = of.restoring_force / of.mass
        form = f"a = F / m; at least: / {touch.HALF_SINE:.3g}, any half-sine"
        numbers = slow / touch.HALF_SINE, slow, np.nan
        what = "peak of a shock that brings it into contact"
        answers.append(Answer(SHOCK, TOUCH, what, *numbers, "m s-2", form, "stiction.life.touch"))
    if of.electrode:
        voltage = touch.stopper_voltage(of.stiffness, of.gap, of.electrode.area, of.electrode.gap)
        form = "V² = 8 k g³ / (27 ε₀ A), or that of its way if it touches before g / 3"
        what = "voltage on its electrode that brings it into contact"
        answers.append(Answer(VOLTAGE, TOUCH, what, voltage, voltage, np.nan, "V", form, "stiction.life.touch"))
    return answers
