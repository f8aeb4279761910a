"""Stage left_out_gaps: effect of attraction across gaps on a device with results without it.

Devices attract across gaps, unless a configuration states otherwise. The change is an effect of a choice of the model,
as in a budget: of the same devices on the same contact, whose force curves alone differ.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from stiction.config.cases import case_id
from stiction.config.units import in_si
from stiction.contact.environment import Water
from stiction.plan.stage import At, Stage
from stiction.stages.contact.corrections import with_correction
from stiction.stages.devices.budget import AnyBudget, budget_settings, effect, settings_of, settings_of_tips
from stiction.stages.devices.contact_names import contact_of, corrections_of, tips_of


def compute(contacts: Sequence[xr.Dataset], budgets: Sequence[AnyBudget], waters: Sequence[Water]) -> xr.Dataset:
    """Change of ln l, or ln F, of each budget by attraction across gaps, with its standard error [-].

    Each budget has its own contact, and the water with attraction across gaps.
    """
    changes = []
    for contact, budget, water in zip(contacts, budgets, waters, strict=True):
        state = budget.state(contact)
        across = replace(state, water=replace(water, correction=state.water.correction))
        changes.append(effect(state, across, budget.responder(state)))
    columns = np.reshape(changes, (-1, 2)).T
    responses = [budget.response for budget in budgets]
    return xr.Dataset(
        {name: ("case", column) for name, column in zip(("change", "error"), columns, strict=True)},
        coords={"humidity": ("case", [budget.humidity for budget in budgets]), "response": ("case", responses)},
    )


def _parts(plan, device):
    """Yield contact and settings of every place of adhesion of a device, at each of its humidities."""
    for humidity in plan.config["devices"][device]["humidities"]:
        case = case_id(device, humidity)
        yield contact_of(plan, case), settings_of(plan, At(case=case))["budget"]
        for contact in tips_of(plan, case).values():
            yield contact, settings_of_tips(plan, At(case=case))["budget"]


def _settings(plan, at):
    """Settings of the budgets, with water and attraction across gaps."""
    pair = plan.config["devices"][at.device]["pair"]
    across = plan.air_of_devices.across_gaps(pair)
    budgets = [budget for _, budget in _parts(plan, at.device)]
    return {
        "budgets": [{key: value for key, value in budget.items() if key != "waters"} for budget in budgets],
        "water": across,
    }


def _changes(data: Mapping[str, Any], settings: Mapping[str, Any]) -> xr.Dataset:
    """Changes of every place of adhesion of a device."""
    budgets = [with_correction(budget_settings(budget), data) for budget in settings["budgets"]]
    return compute(data["contacts"], budgets, [in_si(Water, settings["water"])] * len(budgets))


STAGES = (
    Stage.writing(
        "left_out_gaps",
        "devices/left_out_gaps/{device}",
        inputs=lambda plan, at: (
            {"contacts": [contact for contact, _ in _parts(plan, at.device)]} | corrections_of(plan, at.device)
        ),
        settings=_settings,
        compute=_changes,
        message="Effect of attraction across gaps on device {device}.",
    ),
)
