"""Contacts of devices: every declared one has the patch, the solids and the samples that its name states."""

import pytest
from plans import job_settings

from stiction.config.cases import Case
from stiction.config.files import load
from stiction.models import SIDES
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.stages.contact.changes import table
from stiction.stages.devices import contact_names

BEAM = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 20, "humidities": [0.67]}
BEAM |= {"uncertainty": {"scan_um": 10, "young_modulus_GPa": 5, "poisson_ratio": 0.02, "hamaker_constant_zJ": 20}}
PLAN = Plan(load({"devices": {"C1": BEAM}, "design": {"beams": 700, "budget_samples": 90}}))
GRAPH = Graph(PLAN)


def of_budget(contacts_of):
    """Names of all contacts of a budget."""
    groups = contacts_of(PLAN, Case("C1_rh067")).values()
    return [name for group in groups for name in ([group] if isinstance(group, str) else group.values())]


@pytest.mark.parametrize("contacts_of", [contact_names.contacts_of_budget, contact_names.contacts_of_tip_budget])
def test_all_contacts_of_a_budget_are_declared_by_stages_of_contacts_of_devices(contacts_of):
    declared = {stage.name for stage in table.STAGES}
    named = of_budget(contacts_of)
    assert len(named) == len(set(named)) > 12
    assert {GRAPH.job(name).stage.name for name in named} <= declared | {"model_error_of_devices"}


def test_tips_have_as_many_samples_as_beams_or_budgets_if_changed_and_a_tilt_and_strips_have_none():
    unchanged = contact_names.contacts_of_tip_budget(PLAN, Case("C1_rh067"))["contact"]
    for name in of_budget(contact_names.contacts_of_tip_budget):
        settings = job_settings(PLAN, name)
        assert settings["contact"]["samples"] == (700 if name == unchanged else 90)
        assert settings["tilt"]["slopes"]
    for name in contact_names.contacts_of_budget(PLAN, Case("C1_rh067"))["less"].values():
        settings = job_settings(PLAN, name)
        assert settings["contact"]["samples"] == 90
        assert "tilt" not in settings
        assert settings["beam"] == {"width_um": 20}


def test_less_and_more_of_a_property_change_it_in_both_bodies_of_polysilicon_by_opposite_steps():
    solid = PLAN.config["solid"]["young_modulus_GPa"]
    less, more = (
        job_settings(PLAN, contact_names.contacts_of_budget(PLAN, Case("C1_rh067"))[f"properties_{side}"]["modulus"])
        for side in ("less", "more")
    )
    assert less["solid"]["young_modulus_GPa"] + more["solid"]["young_modulus_GPa"] == pytest.approx(2 * solid)
    assert less["solid"]["young_modulus_GPa"] < solid
    hamaker = contact_names.contacts_of_budget(PLAN, Case("C1_rh067"))["properties_less"]["hamaker_constant"]
    assert job_settings(PLAN, hamaker)["materials"].keys() == set(SIDES)
