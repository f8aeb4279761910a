"""Adhesion and pull of a beam in contact, and what frees a stopper."""

import numpy as np
import xarray as xr

from stiction.beam.energy import apparent_adhesion_energy
from stiction.config.cases import Air
from stiction.devices.risk import Basis, one_in
from stiction.devices.stoppers import safe_force
from stiction.life import freeing
from stiction.stages.life.answers import FREE, FREED, HELD, HOLD, PULL, RESTORING, Answer
from stiction.stages.life.inputs import OfBeam, OfStopper


def beam_held(of: OfBeam, length: float) -> list[Answer]:
    """Adhesion of a stuck beam of a length [m], and its pulling force."""
    clamps = of.clamps
    along, error = of.number(lambda beam: float(apparent_adhesion_energy(length / clamps, beam)), length)
    force, force_error = of.number(lambda beam: freeing.force_at_contact(beam, clamps), length)
    forms = {
        1: ("Γ = 3 E t³ h² / (2 L⁴), Eq. (13)", "F = 3 E I h / L³"),
        2: ("energy at which two cracks meet; more if rigid clamps stretch it",)
        + ("F = 192 E I h / L³ without tension; more if rigid clamps stretch it",),
    }[clamps]
    most, most_force = (along, force) if clamps == 1 else (np.nan, np.nan)
    answers = [
        Answer(
            HELD,
            HOLD,
            "adhesion energy that holds it along the beam" if clamps == 1 else "adhesion energy that holds both cracks",
            *(along, most, error, "J m-2", forms[0], "stiction.beam.energy"),
        ),
        Answer(
            PULL,
            FREE,
            f"force with which it pulls at its {'tip' if clamps == 1 else 'middle'}",
            *(force, most_force, force_error, "N", forms[1], "stiction.life.freeing"),
        ),
    ]
    if clamps == 1:
        tip, form = along / 4, "Γ = 3 E t³ h² / (8 L⁴)"
        what = "adhesion energy that holds its tip, on uniform surfaces"
        answers.append(Answer("tip", HOLD, what, tip, tip, error / 4, "J m-2", form, "stiction.devices.arcs"))
    return answers


def stopper_freed(stopper: xr.Dataset, of: OfStopper, separation: xr.Dataset | None) -> list[Answer]:
    """Restoring force, stiffness and shock that free all but a small fraction of the stoppers, slowly and fast."""
    bounded = [float(share) for share in stopper.share[stopper.basis == Basis.SAMPLED]]
    if not bounded:
        return []
    at = stopper.safe_force.sel(share=min(bounded))
    at = at.isel(humidity=int(at.sel(part="safe").argmax("humidity")))
    force, error = float(at.sel(part="safe")), float(at.sel(part="error"))
    fast = [] if separation is None else [safe_force(row, min(bounded))[0] for row in separation.pull_off.values]
    most = max([force, *fast]) if np.isfinite(fast).all() else np.nan
    but = f"all but {one_in(min(bounded))}, {Air(float(at.humidity)).where}"
    source, bound = "stages stoppers and separation", "faster than water evaporates, in any of its air (at most)"
    form = f"quantile of the pull-off force, 95 %; {bound}"
    answers = [Answer(RESTORING, FREE, f"restoring force that frees {but}", force, most, error, "N", form, source)]
    if of.gap:
        what, form = f"stiffness of the spring that frees {but}", f"k = F / gap; {bound}"
        numbers = (number / of.gap for number in (force, most, error))
        answers.append(Answer("stiffness", FREE, what, *numbers, "N m-1", form, source))
    if of.mass:
        shocks = (freeing.freeing_acceleration(hold, of.restoring_force, of.mass) for hold in (force, most))
        what, form = f"shock that frees {but}", f"a = (F_hold - F) / m; {bound}"
        numbers = *shocks, error / of.mass
        answers.append(Answer(FREED, FREE, what, *numbers, "m s-2", form, "stiction.life.freeing"))
    return answers
