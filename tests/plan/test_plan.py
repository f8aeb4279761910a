"""Plan of a configuration, compared with counts and names found by hand."""

import pytest
from plans import job_settings

from stiction.config.files import load
from stiction.config.merging import merged
from stiction.config.units import in_si
from stiction.contact.environment import Water
from stiction.models import surface_model
from stiction.plan.plan import Plan
from stiction.report.studies.tables import variant_label

PAPER = Plan(load())
#: A pair like the paper's pair a under another name.
LIKE_A = {"beam": "B1", "substrate": "Sub1", "gap_um": 20, "humidities": [0.5]}


def plan(**changes):
    return Plan(load(changes))


def test_the_paper_has_three_pairs_four_surfaces_and_eighteen_cases():
    assert PAPER.pairs == ["a", "b", "c"]
    assert PAPER.surfaces == ["B1", "B2", "Sub1", "Sub2"] == PAPER.with_summits
    assert len(PAPER.cases) == 18
    assert PAPER.cases[:2] == ["a_rh045", "a_rh060"]
    assert len(PAPER.laws) == 36
    assert len(PAPER.outcomes) == 54
    assert PAPER.sides("b") == ["B2", "Sub1"]


@pytest.mark.parametrize(("model", "surfaces"), [("G", "G"), ("NG", "NG"), ("GEO", "NG")])
def test_beams_with_scattered_dimensions_have_non_gaussian_surfaces(model, surfaces):
    assert surface_model(model) == surfaces


def test_only_surfaces_of_pairs_that_run_are_drawn():
    assert plan(run={"pairs": ["b"]}).surfaces == ["B2", "Sub1"]
    assert plan(run={"pairs": ["b"]}).other_surfaces == ["Sub1"]


def test_figures_show_the_pair_of_the_configuration_or_the_first_that_runs():
    assert (PAPER.figure_pair, PAPER.figure_case, PAPER.figure_surface) == ("b", "b_rh065", "B2")
    other = plan(run={"pairs": ["c", "a"]})
    assert (other.figure_pair, other.figure_case, other.figure_surface) == ("c", "c_rh065", "B1")
    assert other.figure_cases == {"c": "c_rh065", "a": "a_rh065"}


def test_a_moment_that_is_zero_has_no_sensitivity():
    assert PAPER.shifted_moments == ["rms", "skewness", "kurtosis"]
    gaussian = plan(surfaces={"B2": {"skewness": 0, "kurtosis": 3}})
    assert "skewness" not in gaussian.shifted_moments
    assert gaussian.shifted_moments[0] == "rms"


def test_every_model_choice_is_a_variant_and_the_base_comes_first():
    names = "base van_der_waals_dry van_der_waals_none psd_identified every_2 spacing_nm_5"
    numbers = "poisson_ratio_0.18 poisson_ratio_0.28 strips_per_element_2"
    assert list(PAPER.variants.changes) == [*names.split(), *numbers.split()]
    assert PAPER.variants.changes["spacing_nm_5"] == {"sampling": {"spacing_nm": 5}}
    assert PAPER.variants.changes["strips_per_element_2"] == {"beam": {"elements": 500}}
    assert len(PAPER.variants.pairs) == 27


def test_adsorbed_water_is_a_variant_on_the_contact_of_the_base():
    films = plan(water={"adsorbed_nm": 0.2}, studies={"variants": {"adsorbed_nm": [0.5, 0.2]}}).variants
    assert films.changes["adsorbed_nm_0.5"] == {"water": {"adsorbed_nm": 0.5}}
    assert films.contact_under("adsorbed_nm_0.5") == "base"
    assert [films.water("b", name).get("adsorbed_nm") for name in ("base", "adsorbed_nm_0.5")] == [0.2, 0.5]
    assert ("b", "adsorbed_nm_0.5") in films.pairs
    assert ("b", "adsorbed_nm_0.2") not in films.pairs  # as the base
    assert "adsorbed_nm_0.5" not in films.choices("b")
    assert variant_label("adsorbed_nm_0.5") == "0.5 nm of adsorbed water"


def test_no_adsorbed_water_is_no_setting():
    none, some = (plan(water={"adsorbed_nm": height}) for height in (0, 0.3))
    for name in ("forces/b_rh067_NG", "humidity/b_NG", "studies/variants/b_rh067_base"):
        assert job_settings(none, name) == job_settings(PAPER, name) != job_settings(some, name)
    assert job_settings(some, "contact/b_NG") == job_settings(PAPER, "contact/b_NG")
    assert in_si(Water, some.air.water("b")) == Water(300.0, adsorbed=0.3e-9)


def test_a_variant_that_changes_nothing_about_a_pair_is_left_out():
    identified = plan(surfaces={name: {"psd": "identified"} for name in PAPER.surfaces})
    assert ("a", "psd_identified") not in identified.variants.pairs
    assert ("a", "base") in identified.variants.pairs
    assert ("a", "psd_identified") in PAPER.variants.pairs
    assert "strips_per_element_5" not in plan(studies={"variants": {"strips_per_element": [5]}}).variants.changes


def test_a_variant_uses_an_identified_spectrum_only_where_summits_were_measured():
    settings = PAPER.variants.summits("a", "psd_identified")
    assert settings["identified"] == ["B1", "Sub1"]
    assert "published_psd" not in settings["base"]["surfaces"]["B1"]
    assert PAPER.variants.summits("a", "base")["identified"] == []


def test_variants_of_the_solids_share_the_summits_of_the_base_and_no_others_do():
    shared = {name for name in PAPER.variants.changes if PAPER.variants.with_summits_of("b", name) == "base"}
    solids = {"van_der_waals_dry", "van_der_waals_none", "poisson_ratio_0.18", "poisson_ratio_0.28"}
    assert shared == {"base", *solids, *PAPER.variants.finer_beams}
    assert PAPER.variants.with_summits_of("b", "every_2") == "every_2"
    assert PAPER.variants.solids("b", "poisson_ratio_0.18")["solid"]["poisson_ratio"] == 0.18
    assert PAPER.variants.solids("b", "base") == {key: PAPER.config[key] for key in ("solid", "van_der_waals")}


def test_a_variant_of_the_solid_changes_what_a_material_does_not_state_and_nothing_else():
    oxide = {"materials": {"Oxide": {"young_modulus_GPa": 70}}, "surfaces": {"Sub1": {"material": "Oxide"}}}
    found = plan(**oxide).variants.solids("b", "poisson_ratio_0.18")["materials"]
    assert [found[side]["poisson_ratio"] for side in ("beam", "substrate")] == [0.18, 0.18]
    assert [found[side]["young_modulus_GPa"] for side in ("beam", "substrate")] == [164, 70]
    assert "poisson_ratio_0.18" in plan(**oxide).variants.choices("b")
    stated = {"materials": {"Oxide": {"poisson_ratio": 0.17}}}
    whole = plan(**stated, surfaces={name: {"material": "Oxide"} for name in ("B2", "Sub1")})
    changing = {name for name in PAPER.variants.choices("b") if not name.startswith("poisson_ratio")}
    assert set(whole.variants.choices("b")) == changing
    others = {"base", *PAPER.variants.finer_beams}
    assert {variant for pair, variant in whole.variants.pairs if pair == "b"} == changing | others
    assert ("c", "poisson_ratio_0.18") in whole.variants.pairs


def test_the_choices_of_a_pair_do_not_depend_on_the_pairs_that_run():
    assert plan(run={"pairs": ["c"]}).variants.choices("b") == PAPER.variants.choices("b")
    assert "psd_identified" in PAPER.variants.choices("b")


def test_devices_have_summits_under_all_choices_of_the_model():
    wanted = plan(studies={"variants": {"asperity": ["island"]}})
    assert "asperity_island" in wanted.variants.changes
    assert wanted.variants.choices("b") == PAPER.variants.choices("b")
    assert wanted.variants.has_islands("asperity_island")
    assert not wanted.variants.has_islands("base")
    of_islands = plan(contact={"asperity": "island"}, studies={"variants": {"asperity": ["summit"]}})
    assert of_islands.variants.has_islands("every_2")
    assert not of_islands.variants.has_islands("asperity_summit")


@pytest.mark.parametrize(
    ("changes", "known"),
    [
        ({}, ["a", "b", "c"]),
        ({"pairs": {"a": {"humidities": [0.5]}}, "van_der_waals": "dry"}, ["a", "b", "c"]),
        ({"water": {"temperature_K": 310}}, ["a", "b", "c"]),
        ({"surfaces": {"B1": {"psd": "identified"}}}, ["a", "b", "c"]),
        ({"surfaces": {"B1": {"kurtosis": 4.5}}}, ["b"]),
        ({"pairs": {"a": {"beam": "B2"}}}, ["b", "c"]),
        ({"pairs": {"b": {"gap_um": 10}}}, ["a", "c"]),
        ({"beam": {"thickness_um": 2.0}}, []),
        ({"solid": {"young_modulus_GPa": 150}}, []),
        ({"run": {"pairs": ["pair"]}, "pairs": {"pair": LIKE_A}}, []),
    ],
)
def test_only_pairs_of_the_paper_are_compared_with_published_values(changes, known):
    assert plan(**changes).paper.pairs == known


def test_a_redefined_surface_is_not_one_of_the_paper():
    assert PAPER.paper.surfaces == PAPER.surfaces
    assert plan(surfaces={"Sub1": {"rms_nm": 0.2}}).paper.surfaces == ["B1", "B2", "Sub2"]
    assert plan(surfaces={"B1": {"published_psd": {"floor_nm4": 0.9}}}).paper.surfaces == ["B2", "Sub1", "Sub2"]


def test_cases_are_those_of_the_pairs_that_run():
    assert {case[0] for case in plan(run={"pairs": ["b"]}).cases} == {"b"}


def test_a_surface_without_summits_keeps_its_published_spectrum_under_every_variant():
    known = PAPER.config["surfaces"]["B1"]
    bare = {key: known[key] for key in ("rms_nm", "skewness", "kurtosis", "psd", "published_psd")}
    mine = plan(run={"pairs": ["mine"]}, surfaces={"Bare": bare}, pairs={"mine": LIKE_A | {"beam": "Bare"}})
    settings = mine.variants.summits("mine", "psd_identified")
    assert settings["base"]["surfaces"]["Bare"]["psd"] == "published"
    assert settings["identified"] == ["Sub1"]


@pytest.mark.parametrize(("samples", "enough"), [(599, False), (600, True), (5000, True)])
def test_the_main_line_has_the_samples_of_the_variants_if_it_has_as_many(samples, enough):
    assert plan(contact={"samples": samples}, chaos={"order": 1}).variants.has_samples is enough


def test_moments_are_shifted_from_feasible_ones():
    border = plan(surfaces={"B2": {"skewness": -0.3, "kurtosis": 3.5}})
    assert border.shifted_moments == ["rms"]  # on the border, less skewness or more kurtosis is infeasible
    assert plan(surfaces={"B2": {"skewness": -0.3, "kurtosis": 2.9}}).shifted_moments == PAPER.shifted_moments


def test_only_attraction_across_gaps_changes_the_water_of_a_pair_and_nothing_else_of_its_contact():
    across = plan(attraction={"reach": "all"})
    assert plan(attraction={"wavelength_nm": 50}).air.water("b") == PAPER.air.water("b") == {"temperature_K": 300}
    gaps = {"hamaker_constant_zJ": {"water": 97.5, "dry": 186.5}, "summits": "water", "wavelength_nm": 100}
    assert across.air.water("b") == {"temperature_K": 300, "gaps": gaps}
    unretarded = plan(attraction={"reach": "all", "retarded": False}).air.water("b")["gaps"]
    assert unretarded == {key: gaps[key] for key in ("hamaker_constant_zJ", "summits")}
    contact = {key: PAPER.seen_by("b")[key] for key in ("solid", "van_der_waals", "contact", "surfaces")}
    assert {key: across.seen_by("b")[key] for key in contact} == contact


def test_coatings_of_both_surfaces_keep_solids_apart_in_the_gaps_and_each_its_own_body_in_contact():
    bodies = {"Thin": {"coating_nm": 1.2}, "Thick": {"coating_nm": 2.0, "contact_angle_deg": 30}}
    sides = {"B2": {"material": "Thin"}, "Sub1": {"material": "Thick"}}
    coated = plan(materials=bodies, surfaces=sides, attraction={"reach": "all"})
    assert coated.air.water("b")["gaps"]["spacer_nm"] == 3.2
    assert {side: body["coating_nm"] for side, body in coated.seen_by("b")["materials"].items()} == {
        "beam": 1.2,
        "substrate": 2.0,
    }
    assert coated.seen_by("b")["materials"]["beam"]["young_modulus_GPa"] == 164
    assert coated.air.water("c") == plan(attraction={"reach": "all"}).air.water("c")
    none = plan(
        materials={"Thin": {"coating_nm": 0}}, surfaces={"B2": {"material": "Thin"}}, attraction={"reach": "all"}
    )
    assert none.air.water("b") == plan(attraction={"reach": "all"}).air.water("b")
    assert coated.materials.in_words("b") == [["Thin", ["coating"]], ["Thick", ["coating", "contact angle"]]]
    assert none.materials.in_words("b") == [["Thin", []]]
    soft = plan(materials=bodies, surfaces={"B2": {"material": "Thin"}}, solid={"young_modulus_GPa": 70})
    elastic = ["Poisson's ratio", "Young's modulus"]
    assert soft.materials.in_words("b") == [["Thin", ["coating"]], ["the solid", elastic]]


def test_coatings_that_attract_are_stated_for_the_gaps_and_for_the_summits_and_change_nothing_else():
    own = {"coating_hamaker_constant_zJ": {"water": 4, "dry": 50}}

    def coated(**more):
        sides = {"B2": {"material": "SAM"}, "Sub1": {"material": "SAM"}}
        return plan(materials={"SAM": {"coating_nm": 1.2, **more}}, surfaces=sides, attraction={"reach": "all"})

    spacer, attracts = coated(), coated(**own)
    gaps = attracts.air.water("b")["gaps"]
    assert gaps.pop("bodies") == {side: {"coating_nm": 1.2, **own} for side in ("beam", "substrate")}
    assert gaps == spacer.air.water("b")["gaps"]
    assert attracts.seen_by("b")["materials"]["beam"] == spacer.seen_by("b")["materials"]["beam"] | own
    assert attracts.materials.in_words("b") == [["SAM", ["Hamaker constant of the coating", "coating"]]]
    less, more = (in_si(Water, one.air.water("b")).gaps.through("dry").work(5e-9) for one in (spacer, attracts))
    assert more > 1.2 * less


def test_attraction_across_gaps_is_a_variant_on_the_contact_of_the_base():
    varied = plan(studies={"variants": {"reach": ["all"]}})
    assert ("b", "reach_all") in varied.variants.pairs
    assert ("b", "reach_all") not in plan(
        attraction={"reach": "all"}, studies={"variants": {"reach": ["all"]}}
    ).variants.pairs
    assert varied.variants.contact_under("reach_all") == "base"
    assert varied.variants.water("b", "reach_all") == plan(attraction={"reach": "all"}).air.water("b")
    assert "reach_all" not in varied.variants.choices("b")
    dry = plan(attraction={"reach": "all"}).variants.water("b", "van_der_waals_dry")["gaps"]
    assert dry["summits"] == "dry"
    assert "gaps" not in plan(attraction={"reach": "all"}).variants.water("b", "van_der_waals_none")


def test_the_error_of_the_model_is_stated_where_its_study_is_named_and_nowhere_else():
    named = plan(run={"studies": ["variants", "full_contact"]})
    at = "b", [0.67]
    assert not PAPER.states_model_error(*at)
    assert "full_contact" not in PAPER.studies
    assert named.states_model_error(*at)
    assert plan(contact={"model": "full"}).states_model_error(*at)
    assert PAPER.states_model_error("b", [0.0, 0.67]), "predictions in dry air are corrected"
    assert not plan(contact={"model": "summits"}).states_model_error("b", [0.0, 0.67])
    assert [name for name in named.variants.changes if name not in PAPER.variants.changes] == ["contact_full"]


def test_full_elastic_contact_is_a_variant_on_the_contact_of_the_base():
    named = plan(run={"studies": ["full_contact"]})
    assert named.variants.contact_under("contact_full") == "base"
    assert ("b", "contact_full") in named.variants.pairs
    assert [name for name in named.variants.changes if named.variants.corrected("b", [0.67], name)] == ["contact_full"]
    assert named.variants.with_summits_of("b", "contact_full") == "base"
    assert named.variants.choices("b") == PAPER.variants.choices("b")
    corrected = plan(run={"studies": ["full_contact"]}, contact={"model": "full"})
    assert ("b", "contact_full") not in corrected.variants.pairs


def test_choices_of_the_medium_change_the_attraction_of_devices_across_gaps_as_well():
    choices = PAPER.variants.choices("b")
    waters = PAPER.variants.water_of_choices("b", choices)
    assert [name for name in choices if name.startswith("van_der_waals")] == list(waters)
    for medium in ("dry", "none"):
        expected = plan(van_der_waals=medium).air_of_devices.water("b")
        assert waters[f"van_der_waals_{medium}"] == expected != PAPER.air_of_devices.water("b")
    assert plan(attraction={"reach": "touching"}).variants.water_of_choices("b", choices) == {}


@pytest.mark.parametrize(
    ("changes", "pairs", "devices"),
    [
        ({}, "touching", "all"),
        ({"contact": {"samples": 9}, "chaos": {"order": 1}, "seed": 3}, "touching", "all"),
        ({"pairs": {"b": {"gap_um": 10, "humidities": ["dry", 0.5]}}}, "touching", "all"),
        ({"figures": {"humidity": "dry"}}, "touching", "all"),
        ({"surfaces": {"B2": {"rms_nm": 3}}, "beam": {"width_um": 20}}, "touching", "all"),
        ({"pairs": {"b": {"attraction": "all"}}}, "all", "all"),
        ({"attraction": {"reach": "touching"}, "beam": {"width_um": 20}}, "touching", "touching"),
        ({"attraction": {"reach": "all"}}, "all", "all"),
        ({"contact": {"model": "full"}}, "touching", "all"),
        ({"materials": {"Wax": {"contact_angle_deg": 180}}, "surfaces": {"B2": {"material": "Wax"}}}, "all", "all"),
    ],
)
def test_solids_attract_across_gaps_unless_a_pair_states_otherwise_for_humid_air(changes, pairs, devices):
    found = plan(**changes)
    assert (found.air.reach("b"), found.air_of_devices.reach("b")) == (pairs, devices)
    for air, reach in ((found.air, pairs), (found.air_of_devices, devices)):
        explicit = plan(**merged(changes, {"attraction": {"reach": reach}})) if reach == "all" else None
        assert ("gaps" in air.water("b")) == (reach == "all")
        assert explicit is None or air.water("b") == explicit.air.water("b")


@pytest.mark.parametrize("medium", ["water", "dry"])
def test_a_pair_has_attraction_across_gaps_in_dry_air_whatever_it_states_for_humid_air(medium):
    air = plan(van_der_waals=medium, pairs={"b": {"humidities": ["dry", 0.5]}}).air
    humid, dry = air.contact("b", 0.5), air.contact("b", 0.0)
    assert (humid, dry) == ("b", "b_dry")
    assert "gaps" not in air.water(humid)
    assert air.water(dry)["gaps"] == plan(van_der_waals="dry", attraction={"reach": "all"}).air.water("b")["gaps"]
    assert "gaps" in air.not_modelled([("b", 0.5), ("b", 0.0)])["left_out"]
    assert "gaps" not in air.not_modelled([("b", 0.0)])["left_out"]


def test_pairs_that_state_nothing_have_attraction_across_gaps_and_the_finer_mesh():
    mine = plan(pairs={"mine": LIKE_A}, run={"pairs": ["mine"]})
    assert mine.air.reach("mine") == "all"
    assert "coarser_mesh" not in job_settings(mine, "beams/mine_rh050_NG")
    assert job_settings(PAPER, "beams/b_rh067_NG")["coarser_mesh"] == PAPER.config["pairs"]["b"]["coarser_mesh"] > 1


@pytest.mark.parametrize(
    ("changes", "compared"),
    [
        ({}, "abc"),
        ({"beam": {"thickness_um": 2.6 * (1 + 1e-7)}}, "abc"),
        ({"beam": {"thickness_um": 2.7}}, ""),
        ({"pairs": {"b": {"gap_um": 19}}}, "ac"),
        ({"surfaces": {"Sub2": {"rms_nm": 5}}}, "ab"),
    ],
)
def test_only_pairs_with_all_numbers_of_the_paper_are_compared_with_published_values(changes, compared):
    assert "".join(plan(**changes).paper.pairs) == compared
