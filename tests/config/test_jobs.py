"""Settings of jobs: what they contain, what they must not contain, and that the stages accept them."""

import json
from dataclasses import MISSING, fields
from pathlib import Path

import pytest

from stiction import studies, variants
from stiction.config import jobs
from stiction.config.designs import Designs
from stiction.config.files import load
from stiction.config.merging import merged
from stiction.config.plan import Plan
from stiction.config.units import typed
from stiction.stages import beams, chaos, character, contact, forces, heights, identification, spectrum
from stiction.stages.cantilevers import Cantilevers
from stiction.studies import (
    correlation,
    fit,
    humidity,
    iteration,
    mesh,
    orders,
    plasticity,
    resampling,
    sample_sizes,
    scan_uncertainty,
    sensitivity,
    sensitivity_contact,
    slope_contact,
    slopes,
)
from stiction.variants import beams as variant_beams
from stiction.variants import contact as variant_contact
from stiction.variants import summits

PLAN = Plan(load())
#: Stage and the settings of one of its jobs.
JOBS = {
    heights: jobs.heights(PLAN, "B2"),
    identification: jobs.identification(PLAN, "B2"),
    spectrum: jobs.spectrum(Plan(load({"surfaces": {"B2": {"psd": "identified"}}})), "B2"),
    iteration: jobs.iteration(PLAN),
    character: jobs.character(PLAN),
    contact: jobs.contact(PLAN, "b"),
    forces: jobs.forces(PLAN, "b_rh067"),
    fit: jobs.forces(PLAN, "b_rh067"),
    chaos: jobs.chaos(PLAN),
    humidity: jobs.humidity(PLAN, "b"),
    beams: jobs.beams(PLAN, "b_rh067", "GEO"),
    sensitivity_contact: jobs.sensitivity_contact(PLAN, "b"),
    sensitivity: jobs.sensitivity(PLAN, "b"),
    slope_contact: jobs.slope_contact(PLAN, "b"),
    slopes: jobs.sensitivity(PLAN, "b"),
    scan_uncertainty: jobs.sensitivity(PLAN, "b"),
    plasticity: jobs.plasticity(PLAN, "b"),
    sample_sizes: jobs.sample_sizes(PLAN),
    orders: jobs.orders(PLAN),
    mesh: jobs.mesh(PLAN),
    correlation: {"surfaces": PLAN.surfaces},
    resampling: jobs.resampling(PLAN, "b_rh067"),
    summits: PLAN.variant_summits("b", "base")["base"],
    variant_contact: PLAN.variant_contact("b", "base"),
    variant_beams: jobs.variant(PLAN, "b_rh067", "base"),
}
each_job = pytest.mark.parametrize(
    ("stage", "settings"), JOBS.items(), ids=[stage.__name__.rpartition(".")[2] for stage in JOBS]
)


@each_job
def test_a_stage_takes_exactly_the_settings_of_its_jobs(stage, settings):
    found = typed(stage.Settings, settings)
    optional = {field.name for field in fields(found) if not field.default is field.default_factory is MISSING}
    assert set(vars(found)) - optional == {key.removesuffix("_nm") for key in settings} - optional


@each_job
def test_settings_are_plain_so_that_snakemake_compares_them(stage, settings):  # noqa: ARG001
    assert json.loads(json.dumps(settings)) == settings


def test_settings_of_contact_do_not_depend_on_humidity_gap_and_chunks():
    other = {"pairs": {"b": {"humidities": [0.5], "gap_um": 10}}, "contact": {"chunks": 7}}
    dry = Plan(load(other | {"water": {"temperature_K": 310}}))
    assert jobs.contact(dry, "b") == jobs.contact(PLAN, "b")
    assert dry.variant_summits("b", "base") == PLAN.variant_summits("b", "base")
    assert jobs.plasticity(dry, "b") == jobs.plasticity(PLAN, "b")


def test_only_model_geo_has_scattered_dimensions():
    assert jobs.beams(PLAN, "b_rh067", "GEO")["scatter"] == 0.025
    assert jobs.beams(PLAN, "b_rh067", "NG")["scatter"] == jobs.beams(PLAN, "b_rh067", "G")["scatter"] == 0


def test_a_variant_of_the_mesh_changes_only_the_number_of_elements():
    base, finer = (jobs.variant(PLAN, "b_rh067", name) for name in ("base", "strips_per_element_2"))
    assert finer == merged(base, {"beam": {"elements": 500}})
    sizes = PLAN.config["studies"]["variants"]
    assert (base["samples"], base["beam"]["samples"]) == (sizes["samples"], sizes["beams"])


def test_elements_follow_the_force_laws_except_on_the_mesh_of_the_paper():
    other = Plan(load({"pairs": {"b": {"humidities": [0.67, 0.95]}}}))
    assert "refined" not in jobs.beams(other, "b_rh067", "GEO")
    assert jobs.beams(other, "b_rh095", "GEO")["refined"] is True
    assert "refined" not in jobs.resampling(other, "b_rh067")
    assert jobs.resampling(other, "b_rh095")["refined"] is True
    assert jobs.variant(other, "b_rh095", "strips_per_element_2")["refined"] is True
    assert "refined" not in jobs.variant(other, "b_rh067", "base")
    assert set(jobs.checks(other)["on_mesh_of_paper"]) == {*PLAN.cases} - {*PLAN.cases[6:12]} | {"b_rh067"}


def test_si_values_are_those_of_the_paper():
    beam = typed(Cantilevers, jobs.cantilevers(PLAN, "b")).beam
    assert (beam.length, beam.thickness) == pytest.approx((1500e-6, 2.6e-6), rel=1e-15)
    wanted = typed(contact.Settings, jobs.contact(PLAN, "b"))
    assert wanted.sampling.strips(wanted.beam.width).shape == (150, 3000)
    assert wanted.solid.young_modulus == pytest.approx(164e9)


def test_negative_skewness_is_checked_only_for_pairs_without_positive_skewness():
    assert jobs.skewed(PLAN, PLAN.paper_pairs) == ["a", "b", "c"]
    other = Plan(load({"surfaces": {"Sub1": {"skewness": 0.3, "kurtosis": 3.2}}}))
    assert jobs.skewed(other, other.pairs) == ["c"]
    assert jobs.checks(other)["skewed"] == ["c"]


@pytest.mark.parametrize("folder", [studies, variants], ids=lambda folder: folder.__name__)
def test_every_study_and_variant_is_tested_here(folder):
    names = {module.__name__ for module in JOBS if module.__name__.startswith(f"{folder.__name__}.")}
    modules = [path for path in Path(folder.__file__).parent.glob("[!_]*.py") if "def compute(" in path.read_text()]
    assert names == {f"{folder.__name__}.{path.stem}" for path in modules}


def test_the_axis_of_humidities_runs_from_the_driest_to_the_most_humid():
    assert jobs.humidity(PLAN, "b")["range"] == [0.44, 0.92]


@pytest.mark.parametrize(
    ("settings", "study"), [(jobs.sensitivity_contact, "sensitivity"), (jobs.slope_contact, "slopes")]
)
def test_studies_with_shifted_surfaces_have_their_own_number_of_samples(settings, study):
    samples = settings(PLAN, "b")["contact"]["samples"]
    assert samples == PLAN.config["studies"][study]["samples"] != PLAN.config["contact"]["samples"]


@pytest.mark.parametrize(("modulus", "known"), [(164, True), (150, True), (178, True), (140, False), (190, False)])
def test_a_solid_counts_as_polysilicon_if_its_modulus_is_near_that_of_the_paper(modulus, known):
    found = jobs.model_limits(Plan(load({"solid": {"young_modulus_GPa": modulus}})))["materials"]
    assert found == dict.fromkeys("abc", [] if known else [["the solid", ["Poisson's ratio", "Young's modulus"]]])


# Uncertain properties of the solids

GLASS = {"poisson_ratio": 0.2, "hamaker_constant_zJ": {"water": 5, "dry": 65}}
OF_GLASS = {"materials": {"Glass": GLASS}, "surfaces": {"B2": {"material": "Glass"}}}
BEAM = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.67]}
WITH_BEAM = {"devices": {"C1": BEAM}}
TIPS = Designs(load(WITH_BEAM)).tips("C1")


@pytest.mark.parametrize("ratio", [0.23, 0, -0.3])
def test_poissons_ratio_changes_by_the_same_amount_whatever_its_value(ratio):
    plan = Plan(load(WITH_BEAM, {"solid": {"poisson_ratio": ratio}}))
    for contact_of in (jobs.solid_contact, jobs.tip_solid_contact):
        less, more = (contact_of(plan, *TIPS, "poisson_ratio", side)["solid"] for side in ("less", "more"))
        assert (less["poisson_ratio"], more["poisson_ratio"]) == pytest.approx((ratio - 0.05, ratio + 0.05))
        assert less["young_modulus_GPa"] == more["young_modulus_GPa"] == 164


@pytest.mark.parametrize("contact_of", [jobs.solid_contact, jobs.tip_solid_contact])
def test_the_hamaker_constant_of_polysilicon_changes_in_both_bodies_and_that_of_glass_in_the_beam_alone(contact_of):
    def changed(plan, side):
        return contact_of(plan, *TIPS, "hamaker_constant", side)["materials"]

    plan = Plan(load(WITH_BEAM))
    less, more, solid = changed(plan, "less"), changed(plan, "more"), plan.config["solid"]
    for body in ("beam", "substrate"):
        assert less[body] == solid | {"hamaker_constant_zJ": pytest.approx({"water": 78, "dry": 149.2})}
        assert more[body] == solid | {"hamaker_constant_zJ": pytest.approx({"water": 117, "dry": 223.8})}
    glass = changed(Plan(load(WITH_BEAM, OF_GLASS)), "more")
    assert glass["beam"]["hamaker_constant_zJ"] == pytest.approx({"water": 6, "dry": 78})
    assert glass["substrate"] == solid
    both = merged(WITH_BEAM | OF_GLASS, {"surfaces": {"Sub1": {"material": "Glass"}}})
    assert changed(Plan(load(both)), "more")["substrate"] == glass["beam"]
