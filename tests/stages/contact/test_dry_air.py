"""Surfaces in dry air: nothing but attraction of the solids, where summits touch and across gaps."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from plans import job_settings
from small import surfaces

from stiction.config.files import load
from stiction.config.units import in_si
from stiction.contact.environment import Water, flooded_law
from stiction.contact.vanderwaals import attraction
from stiction.estimates import mean_with_error
from stiction.plan.graph import Results
from stiction.plan.plan import Plan
from stiction.stages.contact import contact, pair_model_error
from stiction.stages.contact.curves import energies, pull_offs
from stiction.stages.laws import forces
from stiction.study import PairStudy

SIZES = {
    "run": {"pairs": ["b"]},
    "contact": {"samples": 24, "chunks": 1},
    "beam": {"width_um": 6, "samples": 2},
    "chaos": {"order": 2},
}
ACROSS = {"attraction": {"reach": "all"}, "pairs": {"b": {"humidities": ["dry", 0.44, 0.67]}}}
WAX = {"materials": {"Wax": {"contact_angle_deg": 110}}, "surfaces": {n: {"material": "Wax"} for n in ("B2", "Sub1")}}
PLAN = Plan(load(SIZES, ACROSS))


def water_of(pair, plan=PLAN):
    return in_si(Water, plan.air.water(pair))


def contact_of(pair, plan=PLAN, of=surfaces):
    """Contact of pair b in the air that its name says."""
    return contact.compute(of(), pair, "NG", in_si(contact.Settings, job_settings(plan, f"contact/{pair}_NG")))


@pytest.fixture(scope="module")
def dry():
    return contact_of("b_dry")


@pytest.fixture(scope="module")
def humid():
    return contact_of("b")


def test_the_same_surfaces_meet_in_dry_and_in_humid_air_and_attract_each_other_more_through_air(dry, humid):
    assert_array_equal(dry.bearing_area, humid.bearing_area)
    assert dry.solid_pressure.values.min() < 1.5 * humid.solid_pressure.values.min() < 0


@dataclass(frozen=True)
class Filmed(Water):
    """Water whose film has any height [m] and tension [Pa]."""

    layer: tuple[float, float] = (0.0, 0.0)

    def film(self, humidity):  # noqa: ARG002
        return self.layer


def test_dry_air_is_the_limit_of_a_film_that_vanishes(dry):
    """The solids attract each other through the film as through air, so that what its tension adds vanishes with it."""
    in_air, molecule = energies(dry, 0.0, water_of("b_dry")), 0.28e-9
    strong, weak = (
        energies(dry, 0.5, Filmed(**vars(water_of("b_dry")), layer=(molecule, tension))) - in_air
        for tension in (2e5, 1e5)
    )
    assert_allclose(strong, 2 * weak, rtol=0.01)
    assert np.all((weak > 1e-4 * in_air) & (weak < 0.01 * in_air))


def test_summits_that_attract_through_water_would_hold_dry_surfaces_too_strongly(dry, humid):
    """What the summits lack of the work through air would act across gaps that the summits have closed already."""
    wrong = energies(humid, 0.0, water_of("b"))
    more, error = mean_with_error(wrong / energies(dry, 0.0, water_of("b_dry")) - 1)
    assert more - 4 * error > 0.05


def test_flats_in_dry_air_need_the_work_of_eq_10_and_no_rough_surface_needs_as_much(dry):
    constant = PLAN.air.hamaker_constant("b_dry") * 1e-21
    energy, pull = flooded_law(0.0, water_of("b_dry"), constant)
    assert energy == pytest.approx(attraction("dry").work_of_adhesion, rel=1e-12)
    assert np.all(energies(dry, 0.0, water_of("b_dry")) < energy)
    assert np.all(pull_offs(dry, 0.0, water_of("b_dry")) < pull)


def test_most_of_the_energy_of_dry_surfaces_is_between_points_that_do_not_touch(dry):
    touching = energies(dry, 0.0, replace(water_of("b_dry"), gaps=None))
    assert np.median(energies(dry, 0.0, water_of("b_dry")) / touching) > 3


def test_the_energy_of_every_dry_sample_grows_with_the_hamaker_constant(dry):
    """By more than the constant, because the solids come closer."""
    stronger = {"hamaker_constant_zJ": {"water": 1.1 * 97.5, "dry": 1.1 * 186.5}}
    named = {"materials": {"Strong": stronger}, "surfaces": {name: {"material": "Strong"} for name in ("B2", "Sub1")}}
    plan = Plan(load(SIZES, ACROSS, named))
    more = energies(contact_of("b_dry", plan), 0.0, water_of("b_dry", plan))
    assert np.all(more > 1.09 * energies(dry, 0.0, water_of("b_dry")))


def test_rough_surfaces_stick_less_in_dry_air(dry):
    """With the same random numbers, all heights are larger in the same proportion."""
    less, _ = rougher(1.3)
    ratio, error = mean_with_error(less / energies(dry, 0.0, water_of("b_dry")))
    assert ratio + 4 * error < 0.9


def rougher(factor):
    """Energies of the samples of pair b in dry air with heights so many times as large, and of their summits alone."""
    results = Results.of(load(SIZES, ACROSS, {"surfaces": {"B2": {"rms_nm": factor * 3.4}}}))
    drawn = tuple((results[f"heights/{name}"], results[f"spectrum/{name}"]) for name in ("B2", "Sub1"))
    found, water = contact_of("b_dry", of=lambda: drawn), water_of("b_dry")
    return energies(found, 0.0, water), energies(found, 0.0, replace(water, gaps=None))


@pytest.mark.slow
def test_summits_take_over_on_rough_surfaces_so_that_energies_fall_more_slowly_than_one_over_the_square():
    (rough, of_summits), (roughest, of_highest) = (np.log(rougher(factor)) for factor in (2, 8))
    fall, error = mean_with_error(rough - roughest)
    assert fall + 4 * error < 2 * np.log(8 / 2)
    more, error = mean_with_error((rough - of_summits) - (roughest - of_highest))
    assert more > 4 * error


def test_water_holds_surfaces_more_strongly_than_dry_air(dry, humid):
    assert np.all(energies(humid, 0.44, water_of("b")) > energies(dry, 0.0, water_of("b_dry")))


# Names and settings


def test_humid_cases_are_as_without_dry_air():
    without = Plan(load(SIZES, ACROSS, {"pairs": {"b": {"humidities": [0.44, 0.67]}}}))
    for name in ("contact/b_NG", "forces/b_rh044_NG", "chaos/b_rh067_NG", "beams/b_rh044_GEO", "humidity/b_NG"):
        assert job_settings(PLAN, name) == job_settings(without, name)
    assert [case for case in PLAN.cases if case != "b_dry"] == without.cases
    assert PLAN.variants.cases == without.variants.cases


def test_a_case_in_dry_air_has_the_contact_in_dry_air():
    graph = Results.of(PLAN.config).graph
    corrected = {"model_error": "studies/model_error/dry/b"}
    assert graph.job("forces/b_dry_NG").inputs == {"contact": "contact/b_dry_NG"} | corrected
    assert graph.job("forces/b_rh044_NG").inputs == {"contact": "contact/b_NG"}
    contacts = [graph.job(f"contact/{pair}_NG").settings for pair in ("b_dry", "b")]
    assert contacts[0] == contacts[1] | {"van_der_waals": "dry"}
    assert graph.job("forces/b_dry_NG").settings["water"]["gaps"]["summits"] == "dry"


def test_one_contact_is_enough_if_summits_attract_through_air_at_any_humidity():
    plan = Plan(load(SIZES, ACROSS, {"van_der_waals": "dry"}))
    assert (plan.air.contact("b", 0.0), plan.air.contact("b", 0.44)) == ("b", "b")


def test_surfaces_that_water_does_not_wet_are_dry_at_any_humidity():
    plan = Plan(load(SIZES, ACROSS, WAX))
    settings = [job_settings(plan, f"forces/{case}_NG") for case in ("b_dry", "b_rh044")]
    assert settings[0] | {"humidity": 0.44} == settings[1]
    assert [plan.air.contact("b", humidity) for humidity in (0.0, 0.44)] == ["b_dry", "b_dry"]
    assert water_of("b_dry", plan).film(0.44) == (0.0, 0.0)
    assert (plan.humid_pairs, plan.humid_cases, plan.variants.cases) == ([], [], [])
    assert not {"sensitivity", "full_contact", "asperities", "pressing", "variants"} & set(plan.studies)
    assert {"orders", "mesh"} < set(plan.studies)


def test_a_study_of_a_pair_takes_the_word_and_the_number(dry):
    study = PairStudy("b", "NG", Results.of(PLAN.config))
    study.results._datasets.update({"contact/b_dry_NG": dry})  # noqa: SLF001 - computed above
    ratios = {f"{of}_ratio": ([ratio], [0.0]) for of, ratio in (("energy", 1.5), ("pull_off", 2.0))}
    ratios |= {f"{of}_power": ([1.0], [0.0]) for of in ("energy", "pull_off")}
    study.results._datasets["studies/model_error/dry/b"] = pair_model_error.layout(ratios, [0.0], [0.0], 6, [0.0])  # noqa: SLF001
    found = study.energies("dry")
    assert_allclose(found, 1.5 * energies(dry, 0.0, water_of("b_dry")))
    assert_array_equal(found, study.energies(0))
    assert_array_equal(found, forces.energies(study.forces("dry")))


def test_dry_air_without_attraction_across_gaps_is_refused_with_its_error():
    plan = Plan(load(SIZES, {"attraction": {"reach": "touching"}}))
    with pytest.raises(ValueError, match=r"pair b in dry air needs attraction.reach: all: .* 5 to 30 times too small"):
        plan.air.contact("b", 0.0)
