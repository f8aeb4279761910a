"""Samples of changed contacts: devices read those of budgets, and errors of measured surfaces those of slopes."""

import every_stage
import pytest
from plans import job_settings

from stiction.config.files import load
from stiction.config.merging import merged
from stiction.config.validation import normalised
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan

#: Stages of contacts with a changed input, of their comparison with the unchanged one, and of slopes along a process.
OF_DEVICES = {"device_slope_contact", "tip_slope_contact", "device_member_contact", "tip_member_contact"}
OF_DEVICES |= {"solid_contact", "tip_solid_contact", "tip_edge_contact", "tip_choice_contact", "slope_contact"}
OF_DEVICES |= {"device_choice_summits", "process_point", "test_beams_rerun"}
#: A device with members, and one on the strips of its pair with an uncertain quantity of a surface.
LEVER = {"kind": "cantilever", "pair": "mine", "thickness_um": 2.6, "gap_um": 20, "width_um": 20, "humidities": [0.67]}
MORE = {
    "surfaces": {"Etched": {"like": "B2", "rms_nm": 3}},
    "pairs": {"mine": {"beam": "Etched", "substrate": "Sub1", "gap_um": 20, "humidities": [0.67]}},
    "devices": {"Mine": LEVER, "Strips": LEVER | {"pair": "b", "width_um": 30, "uncertainty": {"scan_um": 10}}},
}
STOPPER = {"kind": "stopper", "pair": "b", "contact_um": [3, 2], "restoring_force_uN": 20, "humidities": [0.67]}
AREA = "devices/contact/slopes/b_3000x2000"
OTHER = {"design": {"budget_samples": 199}}, {"studies": {"slopes": {"samples": 98}}}


def moved(plan, change):
    """Stages whose settings a change of the configuration moves."""
    other = Graph(Plan(normalised(merged(plan.config, change))))
    jobs = every_stage.behind(Graph(plan))
    return {job.stage.name for job in jobs if job.settings != other.job(job.names[0]).settings}


@pytest.fixture(scope="module")
def plan():
    """Plan of the paper, of devices of the examples, and of two more."""
    more = {section: load(MORE)[section] for section in MORE}
    return Plan(normalised(merged(every_stage.of_paper_and_devices().config, more)))


def test_all_changed_contacts_of_devices_and_nothing_else_have_the_samples_of_budgets(plan):
    assert moved(plan, OTHER[0]) == OF_DEVICES


def test_no_device_on_surfaces_by_numbers_has_the_samples_of_slopes(plan):
    assert moved(plan, OTHER[1]) == set()


def test_the_paper_has_neither():
    assert [moved(Plan(load()), change) for change in OTHER] == [set(), set()]


def test_a_device_on_strips_of_a_measured_pair_shares_their_files_and_their_samples():
    scans = every_stage.of_scans()
    config = merged(load({"devices": {"S": STOPPER}}), scans.config)
    plan = Plan(merged(config, merged(*OTHER)), scans.preliminary)
    names = ("studies/slopes/contact/b_Etched_rms_less", "studies/choices/b_beyond", f"{AREA}_Etched_rms_less")
    settings = [job_settings(plan, name)["contact"]["samples"] for name in names]
    assert settings == [98, 98, 199]


def test_a_contact_compared_with_the_unchanged_one_has_no_more_samples():
    few = {"design": {"budget_samples": 900, "samples_of_patches": {"b_3000x2000": 700}}}
    plan = Plan(merged(load({"devices": {"S": STOPPER}}), few))
    name = "devices/contact/modulus/b_3000x2000_less"
    assert job_settings(plan, name)["contact"]["samples"] == 700
    assert job_settings(Plan(merged(plan.config, OTHER[0])), name)["contact"]["samples"] == 199, "control"


def test_members_on_tips_have_three_times_as_many_but_no_more_than_the_unchanged_contact(plan):
    tips, ground = (
        f"{patch.name}_Etched_like_Sub1" for patch in (plan.devices.tips("Mine"), plan.devices.ground("Mine"))
    )
    names = f"devices/contact/tips/members/{tips}", f"devices/contact/members/{ground}"
    of_mine = (
        f"devices/contact/tips/{plan.devices.tips('Mine').name}",
        f"devices/contact/{plan.devices.ground('Mine').name}",
    )
    unchanged = [job_settings(plan, name)["contact"]["samples"] for name in of_mine]
    for samples, expected in ((100, [300, 100]), (199, [597, 199]), (10_000, unchanged)):
        other = Plan(merged(plan.config, {"design": {"budget_samples": samples}}))
        found = [job_settings(other, name)["contact"]["samples"] for name in names]
        assert found == expected
