"""Budgets of devices on partly assumed surfaces: studies of each whole typical surface are the second route."""

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

from stiction.config.cases import Case
from stiction.config.files import load
from stiction.config.merging import merged
from stiction.devices.stoppers import pull_off_force
from stiction.plan.graph import Graph, Results
from stiction.plan.plan import Plan
from stiction.report.budget import figures, tables
from stiction.stages.contact import curves
from stiction.stages.devices import budget
from stiction.stages.devices.contact_names import contacts_of_budget
from stiction.stages.devices.opening import LONG

SAMPLES, HUMIDITY, AREA = 30, 0.67, 1e-12
LIKE = {"like": "B2", "rms_nm": 3}
STOPPER = {"kind": "stopper", "pair": "mine", "contact_um": [1, 1], "restoring_force_uN": 1, "humidities": [HUMIDITY]}
LEVER = {"kind": "cantilever", "pair": "mine", "thickness_um": 2.6, "width_um": 2, "gap_um": 20}
LEVER |= {"humidities": [HUMIDITY]}
LIBRARY = ["B1", "B2", "Sub1", "Sub2"]


def study(beam=LIKE, substrate=None, **more):
    """Plan of a stopper on an etched surface, with few samples and without variants of the model."""
    surfaces = {"Etched": beam} | ({"Grown": substrate} if substrate else {})
    config = {
        "run": {"pairs": [], "studies": []},
        "surfaces": surfaces,
        "pairs": {
            "mine": {"beam": "Etched", "substrate": list(surfaces)[-1], "gap_um": 20, "humidities": [HUMIDITY]},
        },
        "contact": {"samples": SAMPLES, "chunks": 1, "model": "summits"},
        "design": {"budget_samples": SAMPLES},
        "devices": {"S1": STOPPER},
    }
    complete = load(merged(config, more))
    variants = {key: value if isinstance(value, int) else [] for key, value in complete["studies"]["variants"].items()}
    return Plan(merged(complete, {"studies": {"variants": variants}}))


def budget_of(plan, case="S1_rh067"):
    """Budget of a case."""
    return Results(Graph(plan))[f"devices/budget/{case}"]


def log_force(plan):
    """Logarithm of the mean pull-off force of the stopper of a study [-]."""
    contact = Results(Graph(plan))[contacts_of_budget(plan, Case("S1_rh067"))["contact"]]
    water = budget.budget_settings(Graph(plan).job("devices/budget/S1_rh067").settings["budget"]).water
    return np.log(pull_off_force(curves.pull_offs(contact, HUMIDITY, water), AREA).mean())


@pytest.fixture(scope="module")
def found():
    """Budget of the stopper on one assumed surface against itself."""
    return budget_of(study())


def test_shifts_are_those_of_studies_of_each_typical_surface_on_both_sides(found):
    """Numbers of surfaces in normal form have nine digits; contacts are in single precision."""
    given = log_force(study())
    direct = [log_force(study(LIKE | {"like": name})) - given for name in LIBRARY]
    assert found.member.values.tolist() == LIBRARY
    assert set(found.member_of.values) == {"Etched"}
    assert_allclose(found.member_shift, direct, atol=2e-3)
    assert np.ptp(direct) > 0.1  # control: the surfaces differ


def test_the_named_surface_has_neither_shift_nor_error_and_the_others_have(found):
    named = found.isel(member=LIBRARY.index("B2"))
    assert (float(named.member_shift), float(named.member_error)) == (0, 0)
    others = found.isel(member=[0, 2, 3])
    assert (others.member_error > 0).all()
    assert (abs(others.member_shift) > 4 * others.member_error).any()
    assert found.sizes["input"] == 0


def test_equal_members_have_no_shift():
    plan = study()
    graph = Graph(plan)
    job = graph.job("devices/budget/S1_rh067")
    contact = Results(graph)[job.inputs["contact"]]
    settings = budget.budget_settings(job.settings["budget"])
    names = [("Etched", name) for name in LIBRARY]
    found = budget.with_members(xr.Dataset(), contact, dict.fromkeys(names, contact), names, settings)
    assert not found.member_shift.any()
    assert not found.member_error.any()


def test_two_assumed_surfaces_are_two_kinds_and_two_measurements():
    found = budget_of(study(substrate={"like": "Sub1", "rms_nm": 1, "hurst": 0.8}))
    assert found.member.values.tolist() == LIBRARY * 2
    assert found.member_of.values.tolist() == ["Etched"] * 4 + ["Grown"] * 4
    whole, groups = budget.budget_of(found), budget.groups_of(found)
    assert list(groups) == ["the surface Etched", "the surface Grown"]
    assert_allclose(whole.total, np.hypot(*map(whole.effect, groups.values())))
    assert set(found.exact.values) >= {"the rms of Etched", "the rms of Grown"}
    table = tables.budget({("S1", HUMIDITY): found})
    assert "Measure the surface" in table.caption
    assert (table.frame.part == "member").sum() == 8
    assert figures.budget({("S1", HUMIDITY): found}).axes


def test_stated_uncertainties_keep_their_slopes_beside_members():
    stated = LIKE | {"uncertainty": {"rms_nm": 0.3, "corner_rad_per_um": 1.0}}
    plan = study(stated, devices={"S1": {"uncertainty": {"humidity": 0.01}}})
    found = budget_of(plan)
    assert found.input.values.tolist() == ["rms of Etched", "corner of Etched", "humidity"]
    assert_allclose(np.sqrt(np.diag(found.covariance)), [0.1, 1 / 12, 0.01], rtol=1e-8)
    assert not [name for name in found.exact.values if "Etched" in name]
    linear = found.drop_dims("member")
    assert_allclose(budget.budget_of(linear).total, budget.budget_of(found).effect(linear.input.values))
    with_corner = plan.devices.members_of("Etched")["Sub1"]
    assert "corner" not in with_corner
    assert set(with_corner) == {"skewness", "kurtosis", "hurst", "cutoff"}


class Beams:
    """Beams of a study and its members."""

    def __init__(self, plan, case="Lever_rh067"):
        graph = Graph(plan)
        job, results = graph.job(f"devices/budget/{case}"), Results(graph)
        self.settings, self.contact = budget.budget_settings(job.settings["budget"]), results[job.inputs["contact"]]
        self.members = {key: results[name] for key, name in job.inputs["members"].items()}

    @property
    def shifts(self):
        """Shifts and their errors on the members, in the order of the library."""
        names = [("Etched", name) for name in LIBRARY]
        found = budget.with_members(xr.Dataset(), self.contact, self.members, names, self.settings)
        return found.member_shift.values, found.member_error.values

    @property
    def log_length(self):
        """Logarithm of the length of all [-]."""
        state = self.settings.state(self.contact)
        responses = self.settings.responder(state)([state])
        return np.log(responses.centre(responses.values[0]))


@pytest.mark.parametrize("kind", ["cantilever", pytest.param("bridge", marks=pytest.mark.slow)])
def test_beams_on_members_stick_at_lengths_of_studies_of_these_surfaces_however_long(kind):
    """Cracks on Sub1 are beyond the beams that suffice for B2. In both studies, beams meet the same strips."""
    sizes = {"kind": kind, "width_um": 6} | ({"residual_stress_MPa": 5} if kind == "bridge" else {})
    lever = {"devices": {"Lever": LEVER | sizes}, "design": {"budget_beams": 20}}
    given, direct = Beams(study(**lever)), Beams(study(LIKE | {"like": "Sub1"}, **lever))
    shifts, errors = given.shifts
    change = direct.log_length - given.log_length
    assert abs(shifts[2] - change) < 4 * errors[2]
    assert change > np.log(LONG if kind == "cantilever" else 1.1)


@pytest.mark.slow
def test_tips_on_members_hold_lengths_of_studies_of_these_surfaces():
    design = {"design": {"beams": 200, "budget_samples": 200}, "devices": {"Lever": LEVER}}
    given, direct = (Beams(study(LIKE | {"like": one}, **design), "Lever_rh067_tip") for one in ("B2", "Sub2"))
    (shifts, _), (back, _) = given.shifts, direct.shifts
    assert shifts[3] == pytest.approx(-back[1], abs=3e-3)
    assert shifts[3] == pytest.approx(direct.log_length - given.log_length, abs=3e-3)
    assert back[3] == 0


# Plan


def test_devices_with_test_beams_and_these_keep_slopes_of_what_is_assumed():
    assumed = [("Etched", name) for name in ("skewness", "kurtosis", "corner", "slope")]
    plain = study().devices
    assert (list(plain.members("S1")), plain.quantities("S1")) == (["Etched"], [])
    array = {"pair": "mine", "thickness_um": 2.6, "gap_um": 20, "width_um": 6, "length_um": 1000}
    array |= {"crack_lengths": [{"humidity": HUMIDITY, "mean_um": 500, "std_um": 20, "beams": 9}]}
    plan = study(test_beams={"T": array}, devices={"S1": {"test_beams": ["T"]}})
    for devices, name in ((plan.devices, "S1"), (plan.with_test_beams.devices, "T")):
        assert (devices.members(name), devices.quantities(name)) == ({}, assumed)
        assert {part for _, part in contacts_of_budget(plan, Case("S1_rh067"))["less"]} == {q for _, q in assumed}


def test_tips_have_room_for_the_roughest_member_if_the_rms_is_assumed():
    own = {"rms_nm": 3.0, "skewness": -0.76, "kurtosis": 3.9, "psd": "published"}
    own |= {"published_psd": {"plateau_nm4": 11254, "floor_nm4": 0.2348, "corner_rad_per_um": 12}}
    own["published_psd"]["cutoff_rad_per_um"] = 125
    reach = {}
    for rms, unknown in ((3.0, ["rms"]), (3.0, []), (5.5, [])):
        devices = study(own | {"rms_nm": rms, "unknown": unknown}, devices={"Lever": LEVER}).devices
        reach[rms, bool(unknown)] = devices.tilt(devices.tips("Lever"))["reach_nm"]
    assert reach[3.0, True] == reach[5.5, False] > reach[3.0, False]
