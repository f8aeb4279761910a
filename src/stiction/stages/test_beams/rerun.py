"""Stage test_beams_rerun: test beams and their device again, with the inputs from the test beams.

The update of stage test_beams is linear in the inputs. Here, surfaces, solids, air and dimensions are those of its
result, with the random numbers of the slopes. Lengths that tips hold are left out: they need a contact of their own.
"""

import traceback
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from stiction.analysis.shifts import moved
from stiction.config.cases import Case
from stiction.config.units import in_si
from stiction.contact.materials import OF_PAIRS
from stiction.errors import NotConverged
from stiction.plan.stage import At, Running, Stage
from stiction.stages.contact import contact as stage_contact
from stiction.stages.contact.changes.patches import GROUND
from stiction.stages.contact.changes.solids import with_property
from stiction.stages.contact.contact import first
from stiction.stages.contact.corrections import with_correction
from stiction.stages.contact.pairs import Settings
from stiction.stages.devices import budget as stage_budget
from stiction.stages.devices.budget import (
    AnyBudget,
    budget_settings,
    budgets_of,
    budgets_of_arrays,
    budgets_of_pull_offs,
    effect,
)
from stiction.stages.devices.contact_names import contact_of, corrections_of, patch_of
from stiction.stages.devices.uncertain_inputs import changed
from stiction.stages.surfaces.descriptions import description, drawn_as
from stiction.stages.test_beams.inference import Result

#: Changes of ln l, or ln F, of a result, and their standard errors [-].
NUMBERS = ("linear", "linear_error", "rerun", "rerun_error")


def compute(
    update: xr.Dataset,
    budgets: Mapping[tuple[str, float], xr.Dataset],
    patches: Sequence[str],
    contacts: Mapping[str, tuple[xr.Dataset, xr.Dataset]],
    settings: Sequence[AnyBudget],
) -> xr.Dataset:
    """Update of stage test_beams, with the linear changes of some results and their recomputed changes.

    The budgets are by device or array, and humidity; each has the name of its patch and its settings. A patch has the
    contact with the stated inputs and that of its first samples with the errors of the update.
    """
    errors, names, rows = errors_of(update), [], []
    for (key, budget), patch, budget_of in zip(budgets.items(), patches, settings, strict=True):
        result = Result(*key, budget, None)
        names.append(result.condition)
        rows.append(change_of_response(result, *contacts[patch], errors, budget_of))
    return with_reruns(update, names, rows)


def errors_of(update: xr.Dataset) -> dict[str, float]:
    """Expected errors of all inputs after the measurement, by their names."""
    return dict(zip(map(str, update.input.values), update["shift"].values.tolist(), strict=True))


def change_of_response(
    result: Result, contact: xr.Dataset, moved_contact: xr.Dataset, errors: Mapping[str, float], settings: AnyBudget
) -> tuple[float, ...]:
    """Change of ln l, or ln F, by the errors of the inputs: linear and computed again, with standard errors [-].

    ASSUME: slopes err independently.
    """
    budget = result.budget
    by_input = dict(zip(map(str, budget.input.values), (errors[name] for name in result.names), strict=True))
    shifts = np.array(list(by_input.values()))
    linear = float(budget.slope.values @ shifts), float(np.linalg.norm(budget.slope_error.values * shifts))
    state = settings.state(first(contact, moved_contact.sizes["strip"]))
    return *linear, *effect(state, changed(replace(state, contact=moved_contact), by_input), settings.responder(state))


def at_mean(
    surfaces: Mapping[str, tuple[xr.Dataset, xr.Dataset]],
    pair: str,
    base: dict[str, Any],
    errors: Mapping[str, float],
    uncertainty: Mapping[str, float],
) -> xr.Dataset:
    """Contact of a pair after errors of surfaces and solids, by the name of the input, such as ``rms of B2``.

    The surfaces are datasets (heights, spectrum) by name; ``base`` has the settings of the contact with the stated
    inputs, and ``uncertainty`` those of a device, as of a job. The name of the pair is part of the addresses of random
    numbers.
    """
    for name, entry in OF_PAIRS.items():
        if entry.words in errors:
            step = entry.step.by(uncertainty.get(entry.key, 0.0))
            base = with_property(base, name, partial(step.moved, by=errors[entry.words]))
    settings, shifted = in_si(Settings, base), {}
    for name in settings.surfaces:
        surface = description(*surfaces[name])
        surface_errors = {key: errors[f"{key} of {name}"] for key in surface.quantities if f"{key} of {name}" in errors}
        shifted[name] = (
            drawn_as(moved(surface, surface_errors), settings.sampling.spacing) if surface_errors else surfaces[name]
        )
    return stage_contact.compute([shifted[name] for name in settings.surfaces], pair, "NG", settings)


def with_reruns(
    update: xr.Dataset, names: Sequence[str] = (), rows: Sequence[Sequence[float]] = (), refused: str = ""
) -> xr.Dataset:
    """Dataset of an update with its reruns, or with the reason why there are none."""
    columns = np.reshape(rows, (-1, len(NUMBERS))).T
    numbers = {name: ("again", column) for name, column in zip(NUMBERS, columns, strict=True)}
    return update.assign(numbers).assign_coords(again=np.array(names, str)).assign_attrs(refused=refused)


# Stage


def _cases(plan, device):
    """Plan and case of all budgets of a device and its test beams, except tips, by their names and humidity."""
    of_devices = budgets_of(plan, device) | budgets_of_pull_offs(plan, device)
    plans = (plan, of_devices), (plan.with_test_beams, budgets_of_arrays(plan, device))
    return {
        key: (plan_of_budget, Case(name.rpartition("/")[2]), name)
        for plan_of_budget, budgets in plans
        for key, name in budgets.items()
        if len(key) == 2
    }


def _inputs(plan, at):
    """Update, the budgets, and the surfaces and contacts with the stated inputs."""
    cases = _cases(plan, at.device)
    patches = {patch_of(case_plan, case): (case_plan, case) for case_plan, case, _ in cases.values()}
    sides = dict.fromkeys(side for patch in patches for side in plan.sides(patch.pair))
    ratios = {
        patch_of(case_plan, case).name: ratio
        for case_plan, case, _ in cases.values()
        for ratio in corrections_of(case_plan, case.device, case.humidity).values()
    }
    return {
        "updated": f"devices/test_beams/{at.device}",
        "budgets": {key: name for key, (*_, name) in cases.items()},
        "contacts": {patch.name: contact_of(case_plan, case) for patch, (case_plan, case) in patches.items()},
        "by_levels": {patch: ratio for patch, ratio in ratios.items() if "/devices/" in ratio},  # of another stage
        "model_errors": {patch: ratio for patch, ratio in ratios.items() if "/devices/" not in ratio},
        "heights": {side: f"heights/{side}" for side in sides},
        "spectrum": {side: f"spectrum/{side}" for side in sides},
    }


def _settings(plan, at):
    """Settings of every budget with the name of its patch, and those of every contact."""
    cases = _cases(plan, at.device).values()
    patches = [patch_of(case_plan, case) for case_plan, case, _ in cases]
    at = {patch: At(**patch._asdict()) for patch in patches}  # samples as in a comparison with the first of a patch
    return {
        "budgets": [stage_budget.settings_of(case_plan, At(case=case))["budget"] for case_plan, case, _ in cases],
        "patches": [patch.name for patch in patches],
        "contacts": {
            patch.name: [str(patch.pair), GROUND.settings(plan, at[patch], GROUND.fewer(plan, at[patch]))]
            for patch in patches
        },
    }


def _rerun(data, settings):
    """Contacts with the errors of the update, and all recomputed results, or the reason against them."""
    surfaces = {name: (heights, data["spectrum"][name]) for name, heights in data["heights"].items()}
    update, uncertainty = data["updated"], settings["budgets"][0]["uncertainty"]
    errors, contacts, model_errors = errors_of(update), {}, data["by_levels"] | data["model_errors"]
    budgets = [
        with_correction(budget_settings(section), {"model_error": model_errors[patch]} if patch in model_errors else {})
        for section, patch in zip(settings["budgets"], settings["patches"], strict=True)
    ]
    try:
        for name, (pair, section) in settings["contacts"].items():
            contacts[name] = data["contacts"][name], at_mean(surfaces, pair, section, errors, uncertainty)
        return compute(update, data["budgets"], settings["patches"], contacts, budgets)
    except (ValueError, NotConverged) as reason:
        traceback.print_exc()  # the log keeps where the reason arose, should it be an error of the code
        return with_reruns(update, refused=str(reason))


STAGES = (
    Stage.writing(
        "test_beams_rerun",
        "devices/test_beams/rerun/{device}",
        inputs=_inputs,
        settings=_settings,
        compute=_rerun,
        message="Device {device} at the inputs that its test beams suggest.",
        running=Running(minutes=10),
    ),
)
