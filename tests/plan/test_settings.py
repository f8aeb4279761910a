"""Settings of jobs: what they contain, and what they must not contain."""

import pytest
from plans import job_settings

from stiction.config.files import load
from stiction.config.merging import merged
from stiction.config.units import in_si
from stiction.plan.devices import DevicePlan
from stiction.plan.plan import Plan
from stiction.stages.beams.cantilevers import Cantilevers, sections
from stiction.stages.contact import contact

PLAN = Plan(load())


def test_settings_of_contact_do_not_depend_on_humidity_gap_and_chunks():
    other = {"pairs": {"b": {"humidities": [0.5], "gap_um": 10}}, "contact": {"chunks": 7}}
    dry = Plan(load(other | {"water": {"temperature_K": 310}}))
    assert job_settings(dry, "contact/b_NG") == job_settings(PLAN, "contact/b_NG")
    assert dry.variants.summits("b", "base") == PLAN.variants.summits("b", "base")
    assert job_settings(dry, "studies/plasticity/b") == job_settings(PLAN, "studies/plasticity/b")


def test_only_model_geo_has_scattered_dimensions():
    assert job_settings(PLAN, "beams/b_rh067_GEO")["scatter"] == 0.025
    assert job_settings(PLAN, "beams/b_rh067_NG")["scatter"] == job_settings(PLAN, "beams/b_rh067_G")["scatter"] == 0


def test_a_variant_of_the_mesh_changes_only_the_number_of_elements():
    base, finer = (job_settings(PLAN, f"studies/variants/b_rh067_{name}") for name in ("base", "strips_per_element_2"))
    assert finer == merged(base, {"beam": {"elements": 500}})
    sizes = PLAN.config["studies"]["variants"]
    assert (base["samples"], base["beam"]["samples"]) == (sizes["samples"], sizes["beams"])


def test_all_beams_of_a_pair_have_its_mesh():
    other = Plan(load({"pairs": {"b": {"coarser_mesh": 1.5}}}))
    for name in ("beams/b_rh067_GEO", "studies/resampling/b_rh067", "studies/variants/b_rh067_strips_per_element_2"):
        assert job_settings(other, name)["coarser_mesh"] == 1.5
    assert job_settings(other, "checks.csv")["coarser"] == ["a", "b", "c"]
    assert job_settings(Plan(load({"pairs": {"b": {"coarser_mesh": 1}}})), "checks.csv")["coarser"] == ["a", "c"]


def test_si_values_are_those_of_the_paper():
    beam = in_si(Cantilevers, sections(PLAN, "b")).beam
    assert (beam.length, beam.thickness) == pytest.approx((1500e-6, 2.6e-6), rel=1e-15)
    wanted = in_si(contact.Settings, job_settings(PLAN, "contact/b_NG"))
    assert wanted.sampling.strips(wanted.beam.width).shape == (150, 3000)
    assert wanted.solid.young_modulus == pytest.approx(164e9)


def test_negative_skewness_is_checked_only_for_pairs_without_positive_skewness():
    assert job_settings(PLAN, "checks.csv")["skewed"] == ["a", "b", "c"]
    other = Plan(load({"surfaces": {"Sub1": {"skewness": 0.3, "kurtosis": 3.2}}}))
    assert job_settings(other, "checks.csv")["skewed"] == ["c"]


def test_the_axis_of_humidities_runs_from_the_driest_to_the_most_humid():
    assert job_settings(PLAN, "humidity/b_NG")["range"] == [0.44, 0.92]


@pytest.mark.parametrize(
    ("name", "stated"),
    [
        ("sensitivity/contact/b_rms_less", PLAN.config["studies"]["sensitivity"]["samples"]),
        ("slopes/contact/b_B2_rms_less", PLAN.config["design"]["budget_samples"]),
    ],
)
def test_studies_with_shifted_surfaces_have_their_own_number_of_samples(name, stated):
    samples = job_settings(PLAN, f"studies/{name}")["contact"]["samples"]
    assert samples == stated != PLAN.config["contact"]["samples"]


@pytest.mark.parametrize(("modulus", "known"), [(164, True), (150, True), (178, True), (140, False), (190, False)])
def test_a_solid_counts_as_polysilicon_if_its_modulus_is_near_that_of_the_paper(modulus, known):
    found = job_settings(Plan(load({"solid": {"young_modulus_GPa": modulus}})), "warnings.md")["materials"]
    assert found == dict.fromkeys("abc", [] if known else [["the solid", ["Poisson's ratio", "Young's modulus"]]])


# Uncertain properties of the solids

BEAM = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 2, "humidities": [0.67]}
C1 = {"devices": {"C1": BEAM}}
TIPS = DevicePlan(load(C1)).tips("C1").name
#: Beginnings of the names of contacts with less and more of a property, on a patch and at the tips of a device.
CHANGED = ("devices/contact/{}/b_3000x2000", f"devices/contact/tips/{{}}/{TIPS}")
GLASS = {"poisson_ratio": 0.2, "hamaker_constant_zJ": {"water": 5, "dry": 65}}
OF_GLASS = {"materials": {"Glass": GLASS}, "surfaces": {"B2": {"material": "Glass"}}}


@pytest.mark.parametrize("ratio", [0.23, 0, -0.3])
def test_poissons_ratio_changes_by_the_same_amount_whatever_its_value(ratio):
    plan = Plan(load(C1, {"solid": {"poisson_ratio": ratio}}))
    for name in (begin.format("poisson_ratio") for begin in CHANGED):
        less, more = (job_settings(plan, f"{name}_{side}")["solid"] for side in ("less", "more"))
        assert (less["poisson_ratio"], more["poisson_ratio"]) == pytest.approx((ratio - 0.05, ratio + 0.05))
        assert less["young_modulus_GPa"] == more["young_modulus_GPa"] == 164


@pytest.mark.parametrize("name", CHANGED)
def test_the_hamaker_constant_of_polysilicon_changes_in_both_bodies_and_that_of_glass_in_the_beam_alone(name):
    def changed(plan, side):
        return job_settings(plan, f"{name.format('hamaker_constant')}_{side}")["materials"]

    less, more, solid = changed(Plan(load(C1)), "less"), changed(Plan(load(C1)), "more"), PLAN.config["solid"]
    for body in ("beam", "substrate"):
        assert less[body] == solid | {"hamaker_constant_zJ": pytest.approx({"water": 78, "dry": 149.2})}
        assert more[body] == solid | {"hamaker_constant_zJ": pytest.approx({"water": 117, "dry": 223.8})}
    glass = changed(Plan(load(C1, OF_GLASS)), "more")
    assert glass["beam"]["hamaker_constant_zJ"] == pytest.approx({"water": 6, "dry": 78})
    assert glass["substrate"] == solid
    both = merged(OF_GLASS, {"surfaces": {"Sub1": {"material": "Glass"}}})
    assert changed(Plan(load(C1, both)), "more")["substrate"] == glass["beam"]
