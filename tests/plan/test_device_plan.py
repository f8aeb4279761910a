"""Stoppers and budgets in a configuration: what is computed for them, and the settings of their jobs."""

import json
import sys
from dataclasses import MISSING, fields

import pytest
import yaml
from configurations import PAPER, ROOT, problems
from plans import job_settings

from stiction.config.files import load
from stiction.config.merging import merged
from stiction.config.units import in_si
from stiction.contact.materials import OF_CONTACT
from stiction.models import MOMENT_QUANTITIES, SPECTRUM_QUANTITIES
from stiction.plan.devices import DevicePlan, patch
from stiction.plan.graph import Graph, Job, stages
from stiction.plan.plan import Plan
from stiction.plan.stage import At
from stiction.stages.contact import contact
from stiction.stages.contact.changes import variants
from stiction.stages.devices import budget, stoppers
from stiction.stages.devices import uncertain_inputs as inputs

SIZES = {"thickness_um": 2.6, "gap_um": 20, "width_um": 30}
C1 = {"kind": "cantilever", "pair": "b", "humidities": [0.67]} | SIZES
S1 = {"kind": "stopper", "pair": "b", "contact_um": [3, 2], "restoring_force_uN": 20, "humidities": [0.44, 0.9]}
STATED = {"humidity": 0.01, "young_modulus_GPa": 5, "edge_radius_um": 0.03, "scan_um": 10}
DEVICES = {"C1": C1 | {"uncertainty": STATED}, "C2": C1, "S1": S1 | {"uncertainty": {"humidity": 0.02}}}
GLASS = {"young_modulus_GPa": 70, "poisson_ratio": 0.2, "contact_angle_deg": 20}


def plan(**changes):
    return Plan(load({"devices": DEVICES}, changes))


def planned(**changes):
    return DevicePlan(plan(**changes).config)


PLAN = plan()
PATCH, TIP = "b_3000x2000", DevicePlan(PLAN.config).tips("C1").name
#: Settings in SI, and those of a job.
JOBS = [
    (stoppers.Settings, job_settings(PLAN, "devices/stoppers/S1")),
    (budget.BeamBudget, job_settings(PLAN, "devices/budget/C1_rh067")["budget"]),
    (budget.PatchBudget, job_settings(PLAN, "devices/budget/S1_rh090")["budget"]),
    (budget.TipBudget, job_settings(PLAN, "devices/budget/C1_rh067_tip")["budget"]),
    *((contact.Settings, job_settings(PLAN, f"devices/contact/{name}/{PATCH}_more")) for name in OF_CONTACT),
    *((contact.Settings, job_settings(PLAN, f"devices/contact/tips/{name}/{TIP}_more")) for name in OF_CONTACT),
    (contact.Settings, job_settings(PLAN, f"devices/contact/tips/edge/{TIP}_more")),
    (
        contact.Settings,
        job_settings(PLAN, f"devices/contact/tips/choices/{TIP}_van_der_waals_dry"),
    ),
    (
        contact.Settings,
        job_settings(PLAN, f"devices/contact/slopes/{PATCH}_B2_rms_less"),
    ),
    (variants.Settings, job_settings(PLAN, f"devices/contact/summits/{PATCH}_every_2")["base"]),
]


@pytest.mark.parametrize(("kind", "settings"), JOBS)
def test_a_stage_takes_exactly_the_settings_of_its_jobs(kind, settings):
    found = in_si(kind, settings)
    optional = {field.name for field in fields(found) if not field.default is field.default_factory is MISSING}
    assert set(vars(found)) - optional <= {key.rpartition("_um")[0] or key.removesuffix("_GPa") for key in settings} | {
        key.removesuffix("_uN").removesuffix("_GPa") for key in settings
    }
    assert json.loads(json.dumps(settings)) == settings


def test_a_stopper_sticks_with_its_whole_area_and_a_beam_with_its_strips():
    found = planned()
    assert found.ground("S1") == patch("b", 3, 2)
    assert found.ground("C1") == patch("b", 1.5, 30)
    assert found.has_strips_of_pair("C1")
    assert not found.has_strips_of_pair("S1")
    assert planned(devices={"S1": {"contact_um": [1.5, 30]}}).has_strips_of_pair("S1")
    assert found.stoppers == ["S1"]


def test_only_devices_with_an_uncertain_input_have_a_budget_and_cantilevers_one_of_their_tips():
    found = planned()
    assert found.with_budget == ["C1", "S1"]
    assert found.budgets() == ["C1_rh067", "C1_rh067_tip", "S1_rh044", "S1_rh090"]
    assert found.budgets("C2") == ["C2_rh067", "C2_rh067_tip"]
    assert planned(devices={"S1": {"uncertainty": {"humidity": 0}}}).with_budget == ["C1"]


def test_a_device_on_scans_has_a_budget_without_a_stated_uncertainty():
    scanned = {"scans": {"files": ["a.npy"]}, "heights": "moments", "psd": "fitted"}
    found = DevicePlan(merged(PLAN.config, {"surfaces": {"B2": scanned}}))
    assert found.with_budget == ["C1", "C2", "S1"]
    assert found.quantities("C2") == [("B2", quantity) for quantity in MOMENT_QUANTITIES + SPECTRUM_QUANTITIES]
    assert (
        budget.budget_settings(job_settings(PLAN, "devices/budget/C2_rh067")["budget"]).uncertainty
        == inputs.Uncertainty()
    )


def test_heights_are_uncertain_if_a_scan_is_stated():
    found = planned()
    assert found.quantities("C1") == [(name, quantity) for name in ("B2", "Sub1") for quantity in MOMENT_QUANTITIES]
    assert found.quantities("S1") == []
    same = planned(pairs={"b": {"substrate": "B2"}})
    assert {name for name, _ in same.quantities("C1")} == {"B2"}


def test_choices_of_the_model_change_the_contact_and_leave_the_mesh():
    found = PLAN.variants.choices("b")
    assert {"van_der_waals_dry", "psd_identified", "spacing_nm_5"} < set(found)
    assert not set(found) & {"base", *PLAN.variants.finer_beams}
    identified = plan(surfaces={name: {"psd": "identified"} for name in ("B2", "Sub1")})
    assert "psd_identified" not in identified.variants.choices("b")


def test_choices_of_solids_leave_the_surfaces_as_they_are():
    found = PLAN.variants.choices_of_solids("b")
    assert found == [f"van_der_waals_{medium}" for medium in ("dry", "none")] + [
        "poisson_ratio_0.18",
        "poisson_ratio_0.28",
    ]
    settings = job_settings(PLAN, f"devices/contact/tips/choices/{TIP}_poisson_ratio_0.28")
    few = {"contact": {"samples": PLAN.config["design"]["budget_samples"]}, "solid": {"poisson_ratio": 0.28}}
    assert settings == merged(job_settings(PLAN, f"devices/contact/tips/{TIP}"), few)


def test_a_budget_of_tips_is_for_the_middle_share_on_as_many_changed_tips_as_samples_of_budgets():
    found = job_settings(PLAN, "devices/budget/C1_rh067_tip")
    of_beam = job_settings(PLAN, "devices/budget/C1_rh067")
    assert found["budget"].pop("share") == 1e-3
    assert found["budget"].pop("edge_radius_um") == PLAN.config["design"]["edge_radius_um"]
    both = of_beam["budget"] | {"uncertainty": STATED}  # the edge is one of tips alone
    assert of_beam["budget"]["uncertainty"].keys() == STATED.keys() - {"edge_radius_um"}
    assert found["budget"] == {key: value for key, value in both.items() if key != "beams"}
    assert (found["quantities"], found["choices"]) == (
        of_beam["quantities"],
        PLAN.variants.choices_of_solids("b"),
    )
    number = PLAN.config["design"]["budget_samples"]
    assert number < PLAN.config["design"]["beams"]
    for name in OF_CONTACT:
        tips, strips = (job_settings(PLAN, f"devices/contact/{folder}{name}/{TIP}_less") for folder in ("tips/", ""))
        assert tips["contact"]["samples"] == number
        assert tips == strips | {"contact": tips["contact"], "tilt": tips["tilt"]}


def test_tips_with_another_edge_have_its_radius_and_the_points_and_samples_of_those_with_other_solids():
    base = job_settings(PLAN, f"devices/contact/tips/poisson_ratio/{TIP}_less")["tilt"]
    less, more = (job_settings(PLAN, f"devices/contact/tips/edge/{TIP}_{side}")["tilt"] for side in ("less", "more"))
    assert (less.pop("radius_um"), more.pop("radius_um")) == pytest.approx((0.05, 0.15))
    assert less.pop("room_um") == more.pop("room_um") == pytest.approx(0.15)
    assert base.pop("radius_um") == 0.1
    assert less == more == base
    inputs = PLAN.devices.has_uncertain_edge("C1"), PLAN.devices.has_uncertain_edge("C2")
    assert inputs == (True, False), "control"


def test_the_contact_of_a_device_has_the_samples_of_a_pair_and_that_of_its_tips_one_for_each_beam():
    samples, beams = PLAN.config["contact"]["samples"], PLAN.config["design"]["beams"]
    assert samples != beams
    assert job_settings(PLAN, f"devices/contact/{PATCH}")["contact"]["samples"] == samples
    tips = job_settings(PLAN, f"devices/contact/tips/{TIP}")["contact"]
    assert (tips["samples"], tips["distance_step_nm"]) == (beams, 2 * PLAN.config["contact"]["distance_step_nm"])


def test_contacts_of_a_budget_are_on_the_patch_of_the_device_with_the_samples_of_budgets():
    samples = PLAN.config["design"]["budget_samples"]
    for settings in (
        job_settings(PLAN, f"devices/contact/modulus/{PATCH}_less"),
        job_settings(PLAN, f"devices/contact/summits/{PATCH}_every_2")["base"],
    ):
        assert settings["contact"]["samples"] == samples
        assert (settings["sampling"]["strip_length_um"], settings["beam"]["width_um"]) == (3, 2)
    few = plan(contact={"samples": samples - 1, "chunks": 1}, chaos={"order": 4})
    assert job_settings(few, f"devices/contact/summits/{PATCH}_every_2")["base"]["contact"]["samples"] == samples - 1


def test_youngs_modulus_changes_in_every_body_of_the_material_of_the_beam():
    def changed(plan, side):
        return job_settings(plan, f"devices/contact/modulus/{PATCH}_{side}")

    less, more = (changed(PLAN, side)["solid"]["young_modulus_GPa"] for side in ("less", "more"))
    assert (less, more) == pytest.approx((0.95 * 164, 1.05 * 164))
    of_glass = {"materials": {"Glass": GLASS}, "surfaces": {"B2": {"material": "Glass"}}}
    glass = changed(plan(**of_glass), "more")["materials"]
    assert glass["beam"]["young_modulus_GPa"] == pytest.approx(1.05 * 70)
    assert glass["substrate"]["young_modulus_GPa"] == 164
    both = merged(of_glass, {"surfaces": {"Sub1": {"material": "Glass"}}})
    assert len({one["young_modulus_GPa"] for one in changed(plan(**both), "more")["materials"].values()}) == 1
    assert job_settings(plan(**of_glass), "devices/budget/C1_rh067")["budget"]["young_modulus_GPa"] == 70
    assert job_settings(plan(**of_glass), "devices/budget/S1_rh090")["budget"]["water"]["contact_angles_deg"] == [20, 0]


@pytest.mark.parametrize(("medium", "expected"), [("water", 97.5), ("dry", 186.5), ("none", 186.5)])
def test_a_budget_has_the_hamaker_constant_through_the_medium_if_it_is_uncertain(medium, expected):
    stated = {"devices": {"S1": {"uncertainty": {"hamaker_constant_zJ": 3}}}, "van_der_waals": medium}
    found = job_settings(plan(**stated), "devices/budget/S1_rh090")["budget"]
    assert found["hamaker_constant_zJ"] == pytest.approx(expected)
    assert budget.budget_settings(found).uncertainty.hamaker_constant == pytest.approx(3e-21)
    assert "hamaker_constant_zJ" not in job_settings(PLAN, "devices/budget/S1_rh090")["budget"]
    constants = {"hamaker_constant_zJ": {"water": 5, "dry": 65}}
    of_glass = {"materials": {"Glass": GLASS | constants}, "surfaces": {"B2": {"material": "Glass"}}}
    glass = job_settings(plan(**stated, **of_glass), "devices/budget/S1_rh090")["budget"]["hamaker_constant_zJ"]
    assert glass == {"water": 5, "dry": 65, "none": 65}[medium]


def test_the_warnings_of_a_stopper_have_its_water_its_patch_and_all_humidities_that_it_meets():
    section = PLAN.config["devices"]["S1"]
    assert job_settings(PLAN, "devices/warnings/S1.json")["stopper"] == {
        "pair": "b",
        "materials": [],
        "water": PLAN.air_of_devices.water("b"),
        "on_summits": section["humidities"],
        "contact_um": section["contact_um"],
        "humidities": section["humidities"],
        "worst_humidities": [min(section["humidities"]), max(section["humidities"])],
    }


def test_the_page_of_a_device_has_its_section_and_its_warnings_alone():
    page = Graph(PLAN).job("devices/S1.html")
    assert page.settings.items() >= PLAN.config["devices"]["S1"].items()
    assert page.inputs["warnings"] == "results/devices/warnings/S1.json"


@pytest.mark.parametrize(
    ("change", "key", "message"),
    [
        ({"C1": {"uncertainty": {"thickness_um": 2.6}}}, "devices.C1.uncertainty.thickness_um", "below the dimension"),
        ({"C1": {"uncertainty": {"gap_um": 21}}}, "devices.C1.uncertainty.gap_um", "below the dimension"),
        ({"C1": {"uncertainty": {"residual_stress_MPa": 1}}}, "devices.C1.uncertainty", "without residual_stress_MPa"),
        ({"S1": {"uncertainty": {"gap_um": 1}}}, "devices.S1.uncertainty", "without gap_um"),
        (
            {"C1": {"uncertainty": {"young_modulus_GPa": 164}}},
            "devices.C1.uncertainty.young_modulus_GPa",
            "below Young's modulus itself, 164 GPa",
        ),
        (
            {"C1": {"uncertainty": {"poisson_ratio": 0.27}}},
            "devices.C1.uncertainty.poisson_ratio",
            "above -1 and below 0.5: its budget needs 0.23 ± 0.27",
        ),
        (
            {"C1": {"uncertainty": {"hamaker_constant_zJ": 97.5}}},
            "devices.C1.uncertainty.hamaker_constant_zJ",
            "below the Hamaker constant itself, 97.5 zJ",
        ),
        ({"S1": {"uncertainty": {"humidity": 0.1}}}, "devices.S1.uncertainty.humidity", "above 0 and below 1"),
    ],
)
def test_an_uncertainty_that_a_device_cannot_have_is_refused(change, key, message):
    (line,) = problems(merged(PAPER, {"devices": merged(DEVICES, change)}))
    assert line.startswith(key)
    assert message in line


def test_the_axis_of_the_worst_humidity_increases():
    (line,) = problems(merged(PAPER, {"design": {"worst_humidities": [0.9, 0.4]}}))
    assert line.startswith("design.worst_humidities")


def test_the_plan_of_a_device_takes_as_long_among_many_devices_as_among_few():
    """Counted in calls of functions, for all jobs but the few that read those of all devices."""

    def calls_for_each_of(number):
        stated = {"uncertainty": {"humidity": 0.01}}
        sections = {f"C{k}": PLAN.config["devices"]["C1"] | stated for k in range(number)}
        of_many = Plan(PLAN.config | {"devices": sections})
        jobs = [
            Job(stage, At(**at), of_many) for stage, _ in stages().values() for at in stage.jobs_of_targets(of_many)
        ]
        each = [job for job in jobs if vars(job.at).keys() & {"device", "case"}]
        assert len(each) >= number
        counted = []
        sys.setprofile(lambda frame, event, argument: counted.append(event) if event == "call" else None)
        for job in each:
            _ = job.inputs, job.settings
        sys.setprofile(None)
        return len(counted) / number

    calls_for_each_of(2)  # what is kept from then on
    assert calls_for_each_of(32) < 1.2 * calls_for_each_of(8)


def test_the_tips_of_a_device_are_looked_up_once_for_all_jobs_that_ask_for_them(monkeypatch):
    calls, tips = [], DevicePlan.tips

    def counted(self, device):
        calls.append(device)
        return tips(self, device)

    many = {f"C{k}": C1 | {"thickness_um": 2 + 0.01 * k} for k in range(20)}
    found = DevicePlan(load({"devices": many}))
    strips = [found.tips(name) for name in many]
    monkeypatch.setattr(DevicePlan, "tips", counted)
    slopes = [found.tilt(each)["slopes"] for each in strips]
    assert len(calls) == 20
    assert len({tuple(each) for each in slopes}) == len(set(strips))


def test_devices_do_not_depend_on_the_pairs_of_the_run():
    example = yaml.safe_load((ROOT / "examples" / "roughness.yaml").read_text(encoding="utf-8"))
    of_runs = [jobs_of_devices(example | {"run": {"pairs": pairs}}) for pairs in ([], ["a", "b", "c"], ["b"])]
    assert of_runs[0] == of_runs[1] == of_runs[2]
    assert jobs_of_devices(example | {"run": {"pairs": []}, "seed": 5}) != of_runs[0], "control"


def jobs_of_devices(study):
    """Settings and inputs of all jobs of the devices of a study, by the names of their files."""
    jobs = Graph(Plan(load(study))).needed("devices")
    return {name: (job.settings, dict(job.inputs)) for job in jobs for name in job.names}
