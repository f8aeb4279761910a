from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import small
from numpy.testing import assert_array_equal
from plans import job_settings

from stiction.analysis import model_error
from stiction.analysis.model_error import interpolation_error, mean_ratios
from stiction.config.cases import case_id, in_numbers
from stiction.config.files import load
from stiction.config.merging import merged
from stiction.config.units import in_si
from stiction.contact.environment import Water
from stiction.contact.full import elements
from stiction.plan.graph import Graph, Results
from stiction.plan.plan import Plan
from stiction.stages.contact import curves, full_contact, pair_model_error
from stiction.stages.contact.pairs import bodies
from stiction.stages.laws import forces
from stiction.stages.surfaces.rough_surfaces import sides_of

#: Configuration with fewer strips than a study must have.
FEW = merged(small.PLAN.config, {"studies": {"full_contact": {"samples": 2}}})
#: The same in dry air, with attraction across gaps.
DRY = {"pairs": {"b": {"humidities": ["dry"]}}, "run": {"pairs": ["b"]}, "attraction": {"reach": "all"}}
SETTINGS = small.settings_of(full_contact, job_settings(Plan(FEW), "studies/full_contact/b"))
SETTINGS_IN_DRY_AIR = small.settings_of(
    full_contact, job_settings(Plan(merged(FEW, in_numbers(DRY))), "studies/full_contact/dry/b") | {"most": 0}
)


@cache
def study():
    return Results.of(FEW)["studies/full_contact/b"]


def test_the_humidities_are_the_lowest_the_middle_and_the_highest_of_the_pair():
    assert SETTINGS.humidities == (0.44, 0.67, 0.92)
    assert_array_equal(study().humidity, SETTINGS.humidities)
    assert float(study().spacing) == 10e-9


def test_the_sum_over_summits_is_that_of_the_first_samples_of_the_contact():
    of_case = forces.vectors(small.forces_of_case())[0][:2]
    there = study().sel(humidity=small.HUMIDITY)
    np.testing.assert_allclose(there.summit_energy, of_case[:, 0], rtol=1e-12)
    np.testing.assert_allclose(there.summit_pull_off, of_case[:, 1], rtol=1e-12)
    assert not np.allclose(there.adhesion_energy, of_case[:, 0], rtol=1e-3)


def test_a_sample_does_not_depend_on_the_others():
    alone = full_contact.compute(small.surfaces(), "b", replace(SETTINGS, strips=1))
    assert alone.equals(study().drop_vars("pair").isel(strip=slice(1)))


@pytest.mark.slow
@pytest.mark.parametrize(("of_ratios", "of_largest", "number"), [(0, np.inf, 9), (np.inf, 0, 9), (np.inf, np.inf, 4)])
def test_strips_are_drawn_until_both_accuracies_or_the_most(monkeypatch, of_ratios, of_largest, number):
    monkeypatch.setattr(full_contact, "OF_RATIOS", of_ratios)
    monkeypatch.setattr(full_contact, "OF_LARGEST", of_largest)
    air = replace(SETTINGS, humidities=(0.92,), strips=4, most=9)
    found = full_contact.compute(small.surfaces(), "b", air)
    assert found.sizes["strip"] == number
    assert found.isel(strip=slice(2)).equals(study().drop_vars("pair").isel(strip=slice(2)).sel(humidity=[0.92]))


@pytest.mark.slow
def test_means_in_dry_air_are_those_beside_the_summits_of_more_strips(monkeypatch):
    monkeypatch.setattr(model_error, "STRIPS_PER_SLOPE", 3)
    few = replace(SETTINGS_IN_DRY_AIR, strips=6)
    alone, beside = (full_contact.compute(small.surfaces(), "b", replace(few, on_summits=n)) for n in (0, 60))
    assert beside.drop_vars("more").equals(alone)
    assert_array_equal(beside.more[:6, 0], np.stack([alone.summit_energy, alone.summit_pull_off], axis=-1)[:, 0])
    _, summits = full_contact.moved_models(beside)
    np.testing.assert_allclose(summits.mean(axis=0), beside.more.mean("more_samples"))
    assert_array_equal(full_contact.moved_models(alone)[1, ..., 0], alone.summit_energy)
    ratio, plain = (float(pair_model_error.compute(each, [0.0]).energy_ratio[0]) for each in (beside, alone))
    full, summits = full_contact.moved_models(beside).mean(axis=1)[:, 0, 0]
    assert ratio == pytest.approx(full / summits)
    assert ratio != pytest.approx(plain, rel=1e-3)


def test_strips_whose_summits_do_not_resist_are_not_among_the_more(monkeypatch):
    wanted = replace(SETTINGS_IN_DRY_AIR, strips=2, on_summits=12)
    all_resist = full_contact.compute(small.surfaces(), "b", wanted).more
    weakest = all_resist[:, 0, 1].min()
    monkeypatch.setattr(full_contact.forcelaw, "resists", lambda force: -force.min() > 1.0001 * float(weakest))
    assert full_contact.compute(small.surfaces(), "b", wanted).sizes["more_samples"] == len(all_resist) - 1 == 11


def test_only_an_unstated_number_of_strips_in_dry_air_grows():

    def most(studies, file="dry/b"):
        return job_settings(Plan(load(DRY | studies)), f"studies/full_contact/{file}").get("most", 0)

    assert most({}) == full_contact.MOST
    assert most({"studies": {"full_contact": {"samples": 30}}}) == most({}, "across/b") == 0


def test_both_models_agree_in_wet_air_and_not_in_dry_air():
    ratio = (study().adhesion_energy.mean("strip") / study().summit_energy.mean("strip")).values
    assert abs(ratio[2] - 1) < 0.05 < abs(ratio[0] - 1)


def test_shares_count_the_elements_in_contact_above_a_pressure():
    assert np.all(
        (study().hardness_share >= 0) & (study().hardness_share <= study().onset_share) & (study().onset_share <= 1)
    )
    assert np.all((study().contact_share > 0) & (study().contact_share < 0.1))
    soft = replace(bodies(SETTINGS)[0], hardness=3e9)
    yielding = replace(SETTINGS, strips=1, materials={"beam": soft}, humidities=(0.67,))
    found = full_contact.compute(small.surfaces(), "b", yielding).isel(strip=0, humidity=0)
    assert float(found.onset_share) > float(found.hardness_share) > 0
    assert float(found.adhesion_energy) == float(study().adhesion_energy[0, 1])


def test_states_are_in_equilibrium():
    assert float(study().residual.max()) <= 5 * elements.TOLERANCE
    assert float(study().states.max()) < elements.STATES


def test_without_van_der_waals_forces_both_models_adhere_less():
    none = replace(SETTINGS, strips=1, van_der_waals="none", humidities=(0.67,))
    found = full_contact.compute(small.surfaces(), "b", none)
    for name in ("adhesion_energy", "summit_energy"):
        assert float(found[name][0, 0]) < 0.97 * float(study()[name][0, 1])


def test_a_grid_too_coarse_for_soft_solids_is_refused_in_one_sentence():
    soft = replace(SETTINGS, strips=1, solid=replace(SETTINGS.solid, young_modulus=2e9))
    with pytest.raises(ValueError, match="full elastic contact needs a finer grid"):
        full_contact.compute(small.surfaces(), "b", soft)


# With attraction across gaps


OF_BOTH_MODELS = (("adhesion_energy", "summit_energy"), ("pull_off", "summit_pull_off"))


IN_ALL_AIR = {"attraction": {"reach": "all"}, "pairs": {"b": {"humidities": ["dry", 0.44, 0.92]}}}
IN_ALL_AIR |= {"contact": {"model": "full"}}


@cache
def across():
    return Results.of(merged(FEW, in_numbers(IN_ALL_AIR)))


@cache
def study_across():
    return across()["studies/full_contact/across/b"]


def test_dry_air_comes_before_the_humidities_of_a_pair():
    assert_array_equal(study_across().humidity, [0, 0.44, 0.92])
    touching = across().graph.job("studies/full_contact/b").settings
    assert touching["humidities"] == [0.44, 0.92]
    assert "gaps" not in touching["water"]
    plain = Results.of(merged(small.PLAN.config, {"attraction": {"reach": "touching"}}))
    assert plain.graph.job("studies/full_contact/across/b").settings["humidities"] == [0.44, 0.67, 0.92]


@pytest.mark.parametrize(
    ("own", "shown", "touching", "across"),
    [
        ([0.44, 0.67, 0.92], 0.65, [0.44, 0.67, 0.92], [0.44, 0.67, 0.92]),
        ([0.7, 0.92], 0.65, [0.65, 0.7, 0.92], [0.65, 0.7, 0.92]),
        (["dry"], 0.65, [0.65], [0, 0.65]),
        (["dry"], "dry", [], [0]),
        ([0.5, 0.8], "dry", [0.5, 0.8], [0, 0.5, 0.8]),
    ],
)
def test_full_contact_reaches_the_humidity_of_the_figures(own, shown, touching, across):
    pair = {"beam": "B2", "substrate": "Sub1", "gap_um": 20, "humidities": own}
    study = {"run": {"pairs": ["mine"], "studies": []}, "contact": {"model": "full"}, "figures": {"humidity": shown}}
    plan = Plan(load(study | {"pairs": {"mine": pair}}))
    for folder, humidities in ("studies/full_contact", touching), ("studies/full_contact/across", across):
        job = Graph(plan).job(f"{folder}/mine")
        assert list(job.settings["humidities"]) == humidities
    corrected = Graph(plan).job("studies/model_error/across/mine").settings["humidities"]
    assert set(across) <= set(corrected), "every law of the pair has a ratio"


@pytest.mark.parametrize("humidity", [0, 0.44, 0.92])
def test_the_sum_over_summits_is_that_of_the_laws_with_attraction_across_gaps(humidity):
    plan = across().graph.plan
    name = plan.air.contact("b", humidity)
    contact, water = across()[f"contact/{name}_NG"], in_si(Water, plan.air.water(name))
    there = study_across().sel(humidity=humidity)
    np.testing.assert_allclose(there.summit_energy, curves.energies(contact, humidity, water)[:2], rtol=1e-6)
    np.testing.assert_allclose(there.summit_pull_off, curves.pull_offs(contact, humidity, water)[:2], rtol=1e-6)


def test_attraction_across_gaps_adds_to_both_models_less_where_water_floods_them():
    more = study_across().sel(humidity=[0.44, 0.92]) / study().sel(humidity=[0.44, 0.92])
    for name in ("adhesion_energy", "pull_off", "summit_energy", "summit_pull_off"):
        assert np.all(more[name] > 1)
        assert np.all(more[name][:, 0] > more[name][:, 1])
    assert float(study_across().residual.max()) <= 5 * elements.TOLERANCE


@pytest.mark.parametrize("humidity", [0, 0.44])
def test_energies_and_forces_of_laws_have_their_own_changes_in_dry_air_and_in_humid_air(humidity):
    """With the mean of full contact over that on summits, and with as much more scatter."""
    plan, strips = across().graph.plan, study_across().sel(humidity=humidity)
    name, case = plan.air.contact("b", humidity), case_id("b", humidity)
    given = across()[f"contact/{name}_NG"], humidity, in_si(Water, plan.air.water(name))
    found, _ = forces.vectors(across()[f"forces/{case}_NG"])
    ratios = [float(strips[full].mean() / strips[by].mean()) for full, by in OF_BOTH_MODELS]
    powers = [max(1, float(np.log(strips[full]).std() / np.log(strips[by]).std())) for full, by in OF_BOTH_MODELS]
    on_summits = replace(given[2], correction=None)
    for k, values in enumerate((curves.energies(*given[:2], on_summits), curves.pull_offs(*given[:2], on_summits))):
        np.testing.assert_allclose(found[:, k].mean(), ratios[k] * values.mean(), rtol=1e-6)
        np.testing.assert_allclose(np.log(found[:, k]).std(), powers[k] * np.log(values).std(), rtol=1e-6)
    assert abs(ratios[0] / ratios[1] - 1) > 0.01
    assert (max(powers) > 1.01) == (humidity == 0), "in humid air summits scatter more"


def test_dry_surfaces_have_less_than_humid_ones_in_both_models():
    dry, humid = (study_across().sel(humidity=humidity) for humidity in (0, 0.44))
    for name in ("adhesion_energy", "summit_energy"):
        assert np.all(dry[name] < humid[name])


@pytest.mark.parametrize(
    ("pair", "strips", "width", "between"),
    [
        pytest.param("a", 2, 3, (0.5, 0.575, 0.65, 0.75, 0.80, 0.85), marks=pytest.mark.slow),
        pytest.param("b", 6, 3, (0.5, 0.55, 0.61, 0.735, 0.80, 0.86), marks=pytest.mark.slow),
        pytest.param("c", 8, 30, (0.65, 0.76, 0.80, 0.85), marks=pytest.mark.nightly),
    ],
)
def test_between_humidities_the_true_ratios_are_within_two_stated_errors(pair, strips, width, between):
    config = {"run": {"pairs": [pair]}, "figures": {"pair": pair}, "beam": {"width_um": width}}
    results = Results.of(merged(small.PLAN.config, config))
    job = results.graph.job(f"studies/full_contact/{pair}")
    at = tuple(sorted((*job.settings["humidities"], *between)))
    settings = replace(small.settings_of(full_contact, job.settings), humidities=at, strips=strips)
    found = full_contact.compute(sides_of(results.inputs(job)), pair, settings)
    of_interpolation = []
    for quantity in (full_contact.energies, full_contact.pull_offs):
        humidities, *models = quantity(found)
        computed = np.isin(humidities, job.settings["humidities"])
        truth, _ = mean_ratios(*models, humidities, humidities)
        ratios, errors = mean_ratios(*(of[:, computed] for of in models), humidities[computed], humidities)
        interpolation = ratios * interpolation_error(np.log(ratios[computed]), humidities[computed], humidities)
        off = np.abs(ratios - truth)[~computed]
        assert np.all(off < 2 * errors[~computed])
        of_interpolation.extend(off / interpolation[~computed])
    assert np.median(of_interpolation) > 1 / 3  # it is no bound that says nothing


def test_strips_whose_summits_do_not_resist_are_not_compared(monkeypatch):
    """The second route: strips drawn one by one. No elements are needed to see which of them are compared."""
    air, resists = replace(SETTINGS_IN_DRY_AIR, strips=3), full_contact.forcelaw.resists
    drawn = [cases[0] for *_, cases in full_contact.strips(small.surfaces(), "b", air)]
    curves_of = [case.curve[1].copy() for case in drawn]
    assert all(map(resists, curves_of))
    monkeypatch.setattr(full_contact, "_both_models", lambda _, case, __: [*case.on_summits * 2, 0, 0, 0, 0, 1])

    def compared(*numbers):
        """Energies of the strips that are compared if these resist."""
        of = [curves_of[number] for number in numbers]
        monkeypatch.setattr(
            full_contact.forcelaw, "resists", lambda force: any(np.array_equal(force, one) for one in of)
        )
        return full_contact.compute(small.surfaces(), "b", air).summit_energy.values[:, 0]

    energies = [case.on_summits[0] for case in drawn]
    for numbers in ((0, 1, 2), (0, 2), (1, 2)):
        assert_array_equal(compared(*numbers), [energies[number] for number in numbers])
    with pytest.raises(ValueError, match="the summits of 1 of 3 strips resist"):
        compared(1)
