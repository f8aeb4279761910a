"""The whole model in one process: physics of the complete chain, and stages that share code."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from plans import job_settings

from stiction.beam.energy import arrest_length
from stiction.chaos.model import Truncation
from stiction.config.cases import case_id
from stiction.config.files import load
from stiction.config.merging import merged
from stiction.config.units import in_si
from stiction.contact import forcelaw
from stiction.plan.plan import Plan
from stiction.stages.beams import releases, variant_beams
from stiction.stages.contact import pairs
from stiction.stages.contact.changes import variants
from stiction.stages.laws import chaos, forces
from stiction.stages.surfaces import heights, identification, spectrum
from stiction.stages.surfaces.parameters import spectrum_of
from stiction.study import PairStudy

CONFIG = load({"contact": {"samples": 40}, "beam": {"samples": 3, "width_um": 6}, "chaos": {"order": 3}})
HUMIDITY = 0.8


@pytest.fixture(scope="module")
def study():
    return PairStudy.of(CONFIG, "b")


def under(config, name):
    """Dataset of study variant of pair b at one humidity, with the samples and beams of the main line."""
    sizes = {"variants": {"samples": 40, "beams": 3}}
    plan = Plan(merged(config, {"pairs": {"b": {"humidities": [HUMIDITY]}}, "studies": sizes}))
    plain = plan.variants.summits("b", name)
    settings = [in_si(variants.Settings, merged(plain["base"], changes)) for changes in ({}, plain["changes"])]
    summits = variants.summits_under({}, "b", *settings)
    found = variants.contact_of(summits, in_si(variants.SolidsOfPair, plan.variants.solids("b", name)))
    case = case_id("b", HUMIDITY)
    return variant_beams.compute(
        found, case, in_si(variant_beams.Settings, job_settings(plan, f"studies/variants/{case}_{name}"))
    ).isel(humidity=0)


@pytest.mark.parametrize(("humidity", "published"), [(0.55, 878), (0.67, 710), (0.80, 538), (0.88, 434), (0.92, 391)])
def test_crack_length_of_the_mean_energy_is_the_published_one(study, humidity, published):
    # The model choices that the paper leaves open (attraction in water or none, ν, grid) change the length by 10 % in
    # total; doubling the modulus, the attraction or the pressure of the water changes it by more.
    energy = study.energies(humidity).mean()
    assert_allclose(arrest_length(energy, study.beam), published * 1e-6, rtol=0.1)


def test_a_finer_grid_gives_the_same_surfaces():
    plan = Plan(CONFIG)
    plain = plan.variants.summits("b", "base")["base"]
    base = in_si(variants.Settings, plain)
    surfaces = variants.surfaces_of(base.pairs["b"], base.surfaces, base.sampling.spacing, {})
    finer = in_si(variants.Settings, merged(plain, {"sampling": {"spacing_nm": 5}}))
    coarse, fine = (
        pairs.equivalent_surface(surfaces, "NG", s).draw(*map(np.random.default_rng, (1, 2))) for s in (base, finer)
    )
    assert fine.shape == (300, 1200)
    # Single precision of the Fourier transforms, in units of the rms.
    assert_allclose(fine[::2, ::2], coarse, atol=1e-5 * 3.4e-9 * 10)


def test_humidity_makes_surfaces_stick_and_van_der_waals_forces_help(study):
    dry, wet = (study.energies(humidity).mean() for humidity in (0.5, HUMIDITY))
    assert dry < wet
    without = PairStudy.of(merged(CONFIG, {"van_der_waals": "none"}), "b")
    assert np.all(without.energies(0.5) < study.energies(0.5))


def test_energies_are_those_of_the_vectors(study):
    assert_array_equal(study.energies(HUMIDITY), study.forces(HUMIDITY).adhesion_energy)


@pytest.mark.parametrize("humidity", [np.nan, -0.5, 67, "wet"])
def test_what_is_no_humidity_is_refused_by_all_results(study, humidity):
    for result in (study.energies, study.forces, study.chaos, study.beams):
        with pytest.raises(ValueError, match=f"umidity .*{humidity}") as refused:
            result(humidity)
        assert "attraction" not in str(refused.value)


@pytest.mark.parametrize("model", ["G", "NG"])
def test_the_chaos_model_is_that_of_its_stage(model):
    study = PairStudy.of(merged(CONFIG, {"contact": {"samples": 20}}), "b", model)
    settings = chaos.Settings(Truncation(3, CONFIG["chaos"]["dimension_tolerance"]), CONFIG["seed"])
    expected, other = (chaos.compute(study.forces(HUMIDITY), "b_rh080", of, settings) for of in (model, "other"))
    found = study.chaos(HUMIDITY)
    values, of_stage, of_another = (one.reset_coords(drop=True) for one in (found, expected, other))
    assert values.equals(of_stage)
    assert not values.equals(of_another)


def test_the_base_of_the_variants_is_the_pair_itself_and_a_variant_is_not(study):
    base = under(CONFIG, "base")
    assert_array_equal(base.adhesion_energy, study.energies(HUMIDITY))
    assert_array_equal(base.crack_length, study.beams(HUMIDITY)["crack_length"])
    assert np.all(under(CONFIG, "van_der_waals_none").adhesion_energy < base.adhesion_energy)


def test_beams_do_not_depend_on_threads_and_scatter_with_their_dimensions(study):
    lengths = study.beams(HUMIDITY)["crack_length"]
    assert_array_equal(study.beams(HUMIDITY, threads=2)["crack_length"], lengths)
    assert np.all(study.beams(HUMIDITY, scatter=0.05)["crack_length"] != lengths)


@pytest.mark.slow
def test_a_spectrum_that_is_to_be_identified_is_identified_first():
    changes = {"surfaces": {"B2": {"psd": "identified"}}, "identification": {"patches": 2, "patch_um": 2}}
    plan = Plan(merged(CONFIG, changes | {"contact": {"samples": 5}}))
    density = heights.compute(in_si(heights.Settings, job_settings(plan, "heights/B2")))
    found = identification.compute(
        density, "B2", in_si(identification.Settings, job_settings(plan, "identification/B2"))
    )
    pair = PairStudy.of(plan.config, "b").surfaces
    assert pair.beam.underlying.cutoff == spectrum_of(found).cutoff != pair.substrate.underlying.cutoff
    expected = spectrum.compute(density, in_si(spectrum.Settings, job_settings(plan, "spectrum/B2")), found)
    assert_array_equal(pair.beam.underlying.density, expected.underlying)


@pytest.mark.parametrize(
    "extreme",
    [{"solid": {"poisson_ratio": -0.99}}, {"surfaces": {"B2": {"rms_nm": 30}}}, {"pairs": {"b": {"gap_um": 0.318}}}],
    ids=["stiffest solid", "rough surface", "small gap"],
)
def test_what_a_valid_configuration_allows_can_be_computed(extreme):
    found = PairStudy.of(load(CONFIG, extreme, {"contact": {"samples": 20}, "chaos": {"order": 2}}), "b")
    assert np.all(found.energies(HUMIDITY) > 0)
    lengths = found.beams(HUMIDITY)["crack_length"]
    assert np.all((lengths > 0) & (lengths <= found.beam.length))


@pytest.mark.parametrize("rms", [10, pytest.param(40, marks=pytest.mark.slow)])
def test_surfaces_on_which_no_adhesion_is_left_are_accepted_and_do_not_hold_a_beam(rms):
    few = {"run": {"pairs": ["b"]}, "figures": {"humidity": 0.67}, "contact": {"samples": 100}, "chaos": {"order": 4}}
    config = load(few, {"surfaces": {"B2": {"rms_nm": rms}}, "beam": {"samples": 5}})
    beams = PairStudy.of(config, "b").beams(0.67)
    assert not releases.ends_as(beams, "S-shape").any()
    assert np.all(beams.crack_length > 0.99 * config["beam"]["length_um"] * 1e-6)


def test_an_undefined_pair_is_reported_by_name():
    with pytest.raises(ValueError, match="there is no pair nope; the configuration has a, b, c"):
        PairStudy.of(CONFIG, "nope")


@pytest.mark.parametrize("model", ["g", "gaussian", "GEO"])
def test_an_unknown_model_of_the_heights_is_reported_with_those_that_exist(model):
    with pytest.raises(ValueError, match=f"no model {model} of the heights; the models are G, NG"):
        PairStudy.of(CONFIG, "b", model)


def test_force_curves_and_laws_have_labels_and_the_numbers_of_the_public_functions(study):
    curves, laws = study.curves(HUMIDITY), study.laws(HUMIDITY)
    assert (curves.dims, curves.units, curves.distance.units) == (("curve", "distance"), "Pa", "m")
    assert curves.sizes["curve"] == 40
    vectors, limit = forces.vectors(study.forces(HUMIDITY))
    lawful = forcelaw.admissible(vectors, limit)
    assert_array_equal(laws.strip, np.flatnonzero(lawful))
    assert_array_equal(np.column_stack(list(laws.values())), forcelaw.coefficients(vectors[lawful], limit))
    assert [laws[name].units for name in laws] == ["Pa", "m", "m-1", "m-1"]


def test_a_study_draws_a_force_curve_and_is_described_in_one_line(study):
    (panel,) = study.plot(HUMIDITY).axes
    assert panel.get_ylabel() == r"force per area $\bar f$ [MPa]"
    assert repr(study) == "PairStudy b: B2 on Sub1"
    assert repr(PairStudy("b", "G", study.results)) == "PairStudy b: B2 on Sub1, Gaussian heights"
