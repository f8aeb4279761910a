"""Stages from their inputs to their files and back, on small studies."""

from dataclasses import replace

import numpy as np
import pytest
import small
from numpy.testing import assert_allclose, assert_array_equal
from plans import job_settings
from published import SURFACES
from vectors import sampled_vectors

from stiction.beam.energy import apparent_adhesion_energy
from stiction.beam.montecarlo import Experiment, release_beam
from stiction.beam.resolution import resolved
from stiction.chaos.model import draw, draw_laws, fit, fit_report
from stiction.config.merging import merged
from stiction.contact import forcelaw
from stiction.contact.environment import Water
from stiction.models import FIELD
from stiction.plan.plan import Plan
from stiction.stages.beams import beams, pair_warnings, releases
from stiction.stages.beams.cantilevers import cantilever, strips_along
from stiction.stages.contact import curves
from stiction.stages.laws import chaos, forces
from stiction.stages.surfaces import character, heights, identification, parameters, spectrum
from stiction.stages.surfaces.rough_surfaces import Sampling, rough_surface
from stiction.streams import stream
from stiction.surface.feasible import nearest_feasible
from stiction.surface.field import StripGrid, radial_periodogram
from stiction.surface.identify import Identification, SummitTarget
from stiction.surface.maxent import GAUSSIAN
from stiction.surface.spectrum import CutoffSelfAffine, TabulatedSpectrum, correlation_length
from stiction.surface.summits import find_summits

B2 = SURFACES["B2"]


# Heights and spectrum


def test_infeasible_moments_are_replaced_by_the_nearest_ones_and_both_are_stated(through_a_file):
    measured = heights.Settings(2e-9, -0.1, 3.05)
    nearest = nearest_feasible(-0.1, 3.05)
    with pytest.warns(
        UserWarning, match=r"skewness -0.1 and kurtosis 3.05; the heights have .* -0.1028 and 3.028, 0.21"
    ):
        found = through_a_file(heights.compute(measured))
    assert heights.moments(found) == heights.Settings(2e-9, nearest.skewness, nearest.kurtosis)
    assert heights.measured_moments(found) == (-0.1, 3.05, nearest.distance)
    density = heights.density(found, "NG")
    assert_allclose([density.moment(3), density.moment(4)], nearest[:2], rtol=1e-9)


def test_feasible_moments_leave_no_trace_of_a_substitution():
    found = small.heights_of("B2")
    assert "distance" not in found
    assert heights.measured_moments(found) == (B2.skewness, B2.kurtosis, 0.0)
    assert heights.substitution(found) == ""


def test_heights_have_the_density_of_the_moments_of_the_surface(through_a_file):
    found = through_a_file(small.heights_of("B2"))
    assert heights.density(found, "NG").multipliers == pytest.approx(B2.density.multipliers, rel=1e-14)
    assert heights.density(found, "G") == GAUSSIAN
    assert heights.moments(found) == heights.Settings(B2.rms, B2.skewness, B2.kurtosis)
    assert_allclose(found.density, B2.density(found.height.values), rtol=1e-12)
    assert_allclose(found.density.sum() * 0.02, 1, rtol=1e-6)
    assert_allclose((found.density * found.height**3).sum() * 0.02, B2.skewness, rtol=1e-4)


def test_spectrum_is_the_published_one_and_the_field_behind_it(through_a_file):
    found = through_a_file(small.spectrum_of("B2"))
    assert parameters.spectrum_of(found) == B2.published_psd
    assert float(found.defect) == pytest.approx(B2.defect, rel=1e-12)
    behind = spectrum.underlying(found, "NG")
    assert_array_equal(behind.wavenumber, B2.underlying.wavenumber)
    assert_allclose(behind.density, B2.underlying.density, rtol=1e-12)
    assert behind.cutoff == B2.published_psd.cutoff
    assert spectrum.underlying(found, "G") == B2.published_psd


def test_spectra_have_unit_variance_and_the_heights_get_what_was_asked_for():
    found = small.spectrum_of("B2")
    zeta = found.wavenumber.values
    for name in ("target", "underlying", "achieved"):
        # Isotropic: the variance is 2π ∫ ζ s dζ. Rings of the grid integrate it to a few percent.
        assert_allclose(2 * np.pi * np.trapezoid(zeta * found[name], zeta), 1, rtol=0.05)
    inside = zeta < 0.5 * B2.published_psd.cutoff
    assert_allclose(spectrum.achieved(found, zeta[inside]), found.target[inside], rtol=0.05)
    within = found.target > 0  # the last ring of the grid is beyond the cutoff
    assert np.abs(found.underlying / found.target - 1).where(within).max() > 0.05
    # No Gaussian field provides all of it.
    assert np.abs(found.achieved / found.target - 1).where(within).max() > 1e-3
    assert_array_equal(spectrum.achieved(found, zeta), found.achieved)
    between = 0.5 * (zeta[3] + zeta[4])
    assert spectrum.achieved(found, between) == pytest.approx(float(found.achieved[3:5].mean()))


def test_an_identified_spectrum_comes_from_its_stage_and_a_published_one_does_not():
    other = CutoffSelfAffine(plateau=1e-32, floor=1e-36, corner=2e7, cutoff=1e8)
    settings = spectrum.Settings(10e-9, "identified")
    identified = spectrum.compute(small.heights_of("B2"), settings, parameters.variables(other))
    assert parameters.spectrum_of(identified) == other
    assert spectrum.underlying(identified, "NG").cutoff == other.cutoff


def identified(radius=1.0, density=1.0, corner=32e6):
    """Dataset of stage identification with ratios to the measured summits, of a spectrum with this corner [rad m⁻¹]."""
    psd = CutoffSelfAffine(525e-36, 0.8e-36, corner, 138e6)
    found = Identification(psd, 9, radius * 4e-7, density * 7e13, 1e-9, 1e12)
    return identification.layout(found, SummitTarget(1.7e-9, 4e-7, 7e13, 20e-9))


USE = spectrum.SpectrumUse("Mine", 1.5e-6, 1e-6)


@pytest.mark.slow
def test_an_identified_spectrum_is_used_for_strips_of_any_length_with_margins_longer_than_its_correlation():
    for corner in np.geomspace(3e6, 60e6, 9):
        bound = correlation_length(CutoffSelfAffine(525e-36, 0.8e-36, corner, 138e6))
        message = f"sampling.margin_um is .* surface Mine, {1e6 * bound:.3g} µm for the .* identified"
        for length in (bound * 0.99, bound * 1.01):
            spectrum.refuse_misuse(identified(corner=corner), spectrum.SpectrumUse("Mine", length, bound * 1.01))
            with pytest.raises(ValueError, match=message):
                spectrum.refuse_misuse(identified(corner=corner), spectrum.SpectrumUse("Mine", length, bound * 0.99))


def test_a_patch_is_longer_than_the_correlation_of_the_identified_spectrum(monkeypatch):
    settings = small.settings_of(identification, job_settings(small.PLAN, "identification/B2"))
    wide = Identification(CutoffSelfAffine(1e-30, 1e-38, 1e6, 138e6), 9, 4e-7, 7e13, 1e-9, 1e12)
    monkeypatch.setattr(identification, "identify", lambda *_: wide)
    with pytest.raises(
        ValueError, match=r"identification.patch_um is 2, must be above the correlation .* surface B2, "
    ):
        identification.compute(small.heights_of("B2"), "B2", settings)


@pytest.mark.parametrize("off", [0.51, 1.0, 1.99])
@pytest.mark.parametrize("name", ["radius", "density"])
def test_a_spectrum_whose_summits_do_not_resemble_the_measured_ones_is_not_used(name, off):
    spectrum.refuse_misuse(identified(**{name: off}), USE)
    for factor in (0.4, 1.3, 4.1):
        ratio = off * factor
        if not 0.5 <= ratio <= 2:
            with pytest.raises(ValueError, match="no spectrum .* has the summits of surface Mine: at best"):
                spectrum.refuse_misuse(identified(**{name: ratio}), USE)


def test_a_tabulated_spectrum_comes_back_from_its_dataset(through_a_file):
    table = TabulatedSpectrum(np.linspace(0, 2e8, 5), np.array([4.0, 4.0, 2.0, 1.0, 0.5]) * 1e-34, 1.5e8)
    found = parameters.spectrum_of(through_a_file(parameters.variables(table)))
    assert_array_equal(found.wavenumber, table.wavenumber)
    assert_array_equal(found.density, table.density)
    assert found.cutoff == table.cutoff


def test_misfits_are_the_deviations_from_the_measured_summits():
    found = parameters.misfits(identified(radius=1.2, density=0.7))
    assert found["radius"] == pytest.approx((20, 1e-7 / 4e-7))
    assert found["density"] == pytest.approx((-30, 1e14 / 7e13))


def test_the_spectrum_of_a_job_is_checked_where_it_is_identified():
    plan = Plan(merged(small.PLAN.config, {"surfaces": {"B2": {"psd": "identified"}}, "sampling": {"margin_um": 0.2}}))
    settings = small.settings_of(spectrum, job_settings(plan, "spectrum/B2"))
    assert settings.identified == spectrum.SpectrumUse("B2", 1.5e-6, pytest.approx(0.2e-6))
    with pytest.raises(ValueError, match=r"sampling.margin_um is 0.2, .* surface B2"):
        spectrum.compute(small.heights_of("B2"), settings, identified())


def test_identification_finds_what_the_surface_was_asked_for(through_a_file):
    settings = small.settings_of(identification, job_settings(small.PLAN, "identification/B2"))
    found = through_a_file(identification.compute(small.heights_of("B2"), "B2", settings))
    target = found.target_mean_radius, found.target_summit_density, found.target_rms
    assert tuple(map(float, target)) == (B2.mean_summit_radius, B2.summit_density, B2.rms)
    # Two patches of 2 µm hold some 160 summits.
    assert abs(found.mean_radius - B2.mean_summit_radius) < 5 * found.mean_radius_error
    assert abs(found.summit_density - B2.summit_density) < 5 * found.summit_density_error
    assert parameters.spectrum_of(found).variance == pytest.approx(B2.rms**2, rel=1e-9)


def test_identification_searches_on_patches_with_streams_of_their_own(monkeypatch):
    asked = []
    found = Identification(B2.published_psd, 7, 1.0, 2.0, 0.1, 0.2)
    monkeypatch.setattr(identification, "identify", lambda *asked_for: asked.extend(asked_for) or found)
    settings = small.settings_of(identification, job_settings(small.PLAN, "identification/B2"))
    dataset = identification.compute(small.heights_of("B2"), "B2", settings)
    target, translation, grid, *streams = asked
    assert target.spacing == pytest.approx(20e-9)
    assert translation.density.multipliers == pytest.approx(B2.density.multipliers, rel=1e-14)
    assert grid == StripGrid(2e-6, 2e-6, 10e-9, margin=0.0)
    for rngs, address in zip(streams, ((), ("control",)), strict=True):
        drawn = [rng.random() for rng in rngs()]
        assert drawn == [stream(small.SEED, "identification", "B2", *address, k).random() for k in range(2)]
        assert drawn == [rng.random() for rng in rngs()]
    numbers = [dataset.mean_radius, dataset.mean_radius_error, dataset.summit_density, dataset.summit_density_error]
    assert [*map(float, numbers), int(dataset.evaluations)] == [1.0, 0.1, 2.0, 0.2, 7]


# Character


@pytest.fixture(scope="module")
def of_strips():
    settings = small.settings_of(character, job_settings(small.PLAN, "character/B2_NG"))
    return character.compute(small.heights_of("B2"), small.spectrum_of("B2"), "B2", "NG", settings), settings


def test_strips_have_the_moments_and_summits_of_the_drawn_heights(of_strips):
    found, settings = of_strips
    surface = rough_surface(*small.surfaces()[0], "NG", settings.sampling.strips(6e-6))
    for k in range(3):
        z = surface.draw(stream(small.SEED, "character", "B2", k))[::2, ::2].astype(float)
        assert_allclose(found.power[k], [np.mean(z**order) for order in (1, 2, 3, 4)], rtol=1e-6)
        height, curvature, density = find_summits(z.astype(np.float32), 20e-9)
        assert_allclose(found.summit_density[k], density, rtol=1e-12)
        assert_allclose(found.mean_curvature[k], curvature.mean(), rtol=1e-6)
        if k == 0:
            assert_allclose(found.summit_height[: len(height)], height, rtol=1e-6)
    assert_allclose(found.summit_height[-len(height) :], height, rtol=1e-6)
    assert_allclose(found.summit_curvature[-len(height) :], curvature, rtol=1e-6)


def test_strips_look_like_the_surface(of_strips):
    power = of_strips[0].power.mean("strip")
    assert abs(power[0]) < 0.2 * B2.rms
    assert power[1] == pytest.approx(B2.rms**2, rel=0.3)
    assert power[2] < 0


def test_spectrum_and_picture_are_of_periodic_fields(of_strips, through_a_file):
    found = through_a_file(of_strips[0])
    field = rough_surface(*small.surfaces()[0], "NG", StripGrid(FIELD, FIELD, 10e-9, margin=0.0))
    for k in (0, 7):
        z = field.draw(stream(small.SEED, "character", "B2", "field", k))
        zeta, density = radial_periodogram(z, 10e-9)
        assert_allclose(found.periodogram[k], density, rtol=1e-5)
        if k == 0:
            assert_array_equal(found.elevation, z[:300, :300])
    assert_allclose(found.wavenumber, zeta)
    assert found.periodogram.sizes["field"] == 8
    assert_allclose(found.x, np.arange(300) * 10e-9)


# Forces and chaos


def test_forces_are_those_of_the_curves_at_the_humidity(through_a_file):
    found = through_a_file(small.forces_of_case())
    distance, curve, *_ = curves.force_curves(small.contact_of_pair(), small.HUMIDITY, Water(300))
    assert_array_equal(found.distance, distance)
    for k in (0, 19):
        assert_allclose(found.force[k], curve(k), rtol=1e-6)
        # Pull-off is the strongest attraction, at its distance.
        assert found.pull_off[k] == pytest.approx(-float(found.force[k].min()), rel=1e-2)
        # The energy is the work against the attraction, Eq. (11).
        work = np.trapezoid(np.maximum(-found.force[k], 0), found.distance)
        assert found.adhesion_energy[k] == pytest.approx(float(work), rel=2e-2)
    assert np.all(found.limit_distance < found.pull_off_distance)


def test_the_typical_sample_has_a_curve_a_law_and_the_median_energy_of_such_samples():
    vectors = sampled_vectors(9)
    limit, order = vectors[:, 1].max(), np.argsort(vectors[:7, 0])
    # Seven have a stored curve; without law and with next to no energy, the lowest moves the median by half a place.
    dataset = forces.layout(vectors, limit, np.zeros(1), np.zeros((7, 1)))
    assert forces.typical(dataset) == order[3]
    dataset.adhesion_energy[order[3]] = 1e-9
    assert forces.typical(dataset) == order[4]
    dataset.adhesion_energy[[7, 8]] = 1.0
    assert forces.typical(dataset) == order[4]


def test_chaos_model_draws_what_the_fitted_one_does(through_a_file):
    found = through_a_file(small.chaos_of_case())
    fitted = fit(*forces.vectors(small.forces_of_case()), 2, small.PLAN.config["chaos"]["dimension_tolerance"])
    laws = [draw_laws(model, 50, np.random.default_rng(1)) for model in (fitted, chaos.chaos_model(found))]
    assert_array_equal(*laws)
    assert_array_equal(found.dimension_error, fitted.dimension_error)
    assert_array_equal(found.truncation_error, fitted.truncation_error)


def test_chaos_reports_draws_of_its_own_addresses(monkeypatch):
    monkeypatch.setattr(chaos, "_DRAWS", 500)
    # Of so little energy that some draws have no law.
    samples = sampled_vectors(200) * [0.3, 1, 1, 1]
    limit = samples[:, 1].max()
    settings = small.settings_of(chaos, job_settings(small.PLAN, "chaos/b_rh067_NG"))
    found = chaos.compute(forces.layout(samples, limit, np.zeros(1), np.zeros((1, 1))), small.CASE, "G", settings)
    model = chaos.chaos_model(found)
    statistics, correlations = fit_report(model, samples, 500, stream(small.SEED, "chaos", small.CASE, "G"))
    assert_allclose(found.statistics, statistics, rtol=1e-12)
    assert_allclose(found.correlation, correlations, rtol=1e-12)
    _, rejected = draw(model, 500, stream(small.SEED, "rejection", small.CASE, "G"))
    assert rejected > 0
    assert float(found.rejected) == rejected / (500 + rejected)
    assert found.limit == limit


# Beams


def of_beams(model="NG"):
    return small.settings_of(beams, job_settings(small.PLAN, f"beams/{small.CASE}_{model}"))


def by_hand(k, settings):
    """Beam k, released from the streams and settings of its case."""
    model = chaos.chaos_model(small.chaos_of_case())
    nominal = cantilever(settings, "b")
    experiment = Experiment(nominal, 1000, lambda n, rng: draw_laws(model, n, rng), settings.scatter)
    return release_beam(experiment, k, stream(small.SEED, "beams", small.CASE, k))


@pytest.mark.parametrize("model", ["NG", "GEO"])
def test_beams_are_released_from_streams_of_their_own(through_a_file, model):
    settings = of_beams(model)
    found = through_a_file(beams.compute(small.chaos_of_case(), small.CASE, settings))
    assert_array_equal(found.beam, range(3))
    for k in (0, 2):
        beam = by_hand(k, settings)
        assert found.state[k] == beam.state
        assert found.crack_length[k] == beam.crack_length
        assert found.apparent_energy[k] == beam.energy
        assert found.imbalance[k] == beam.imbalance
        assert found.iterations[k] == beam.iterations
        assert_allclose(found.deflection[k], beam.deflection, rtol=1e-6, atol=1e-15)
    assert_allclose(found.node, np.linspace(0, 1500e-6, 201), atol=1e-15)


def test_elements_follow_the_force_laws_of_the_case(through_a_file):
    settings = replace(of_beams("GEO"), coarser_mesh=1.0)
    coarse = replace(settings, beam=replace(settings.beam, elements=2))
    model = chaos.chaos_model(small.chaos_of_case())
    laws = draw_laws(model, 10_000, stream(small.SEED, "beams", small.CASE, "mesh"))
    nominal = resolved(cantilever(coarse, "b"), 1000, laws)
    assert nominal.elements > 2
    found = through_a_file(beams.compute(small.chaos_of_case(), small.CASE, coarse))
    assert_allclose(found.node, nominal.nodes, atol=1e-15)
    experiment = Experiment(nominal, 1000, lambda n, rng: draw_laws(model, n, rng), settings.scatter)
    last = release_beam(experiment, 2, stream(small.SEED, "beams", small.CASE, 2))
    assert found.crack_length[2] == last.crack_length
    fine = replace(settings, beam=replace(settings.beam, elements=500))
    kept = beams.compute(small.chaos_of_case(), small.CASE, fine)
    assert kept.sizes["node"] == 501
    coarser = beams.compute(small.chaos_of_case(), small.CASE, replace(coarse, coarser_mesh=1.7))
    assert 2 < coarser.sizes["node"] < found.sizes["node"]


def test_elements_are_chosen_with_laws_that_no_beam_uses():
    settings, model = replace(of_beams(), coarser_mesh=1.0), chaos.chaos_model(small.chaos_of_case())
    asked = []

    def address(k):
        asked.append(k)
        return stream(small.SEED, k)

    releases.released_on(lambda n, rng: draw_laws(model, n, rng), small.CASE, settings, address)
    assert asked == ["mesh", *range(settings.samples)]


@pytest.mark.parametrize("model", ["NG", "GEO"])
def test_beams_whose_strips_are_far_too_long_stick_as_on_their_strongest_patch(model):
    usual = beams.compute(small.chaos_of_case(), small.CASE, of_beams(model))
    settings = replace(of_beams(model), sampling=replace(of_beams().sampling, strip_length=7.5e-6))
    found = beams.compute(small.chaos_of_case(), small.CASE, settings)
    assert pair_warnings.beam_warnings(found, cantilever(settings, "b"), 7.5e-6)[0].kind == "nothing_simulated"
    assert np.all(found.state == 0)
    assert np.all(found.crack_length < usual.crack_length.min()), "the safe side"
    assert_allclose(found.deflection.max("node"), found.deflection.isel(node=-1))
    laws = draw_laws(chaos.chaos_model(small.chaos_of_case()), 10_000, stream(small.SEED, "beams", small.CASE, "mesh"))
    nominal, energy = cantilever(settings, "b"), forcelaw.energy(laws).max()
    alike = np.abs(found.apparent_energy / energy - 1).values < 1e-9
    assert np.all(alike) == (model == "NG")
    assert_allclose(found.apparent_energy, apparent_adhesion_energy(found.crack_length.values, nominal), rtol=1e-12)


def test_the_nominal_beam_is_that_of_the_settings():
    beam = cantilever(of_beams(), "b")
    assert (beam.length, beam.width, beam.thickness, beam.gap) == pytest.approx((1500e-6, 6e-6, 2.6e-6, 20e-6))
    assert beam.young_modulus == pytest.approx(164e9)
    assert strips_along(of_beams().beam, of_beams().sampling) == 1000


def test_no_scatter_is_model_ng_and_scatter_is_not():
    ng, geo = (beams.compute(small.chaos_of_case(), small.CASE, of_beams(model)) for model in ("NG", "GEO"))
    none = beams.compute(small.chaos_of_case(), small.CASE, replace(of_beams("GEO"), scatter=0))
    assert_array_equal(none.crack_length, ng.crack_length)
    assert np.all(geo.crack_length != ng.crack_length)


def test_beams_are_selected_by_the_name_of_their_state():
    nodes, numbers = np.linspace(0, 1, 3), np.arange(4.0)
    columns = dict.fromkeys(("imbalance", "iterations"), numbers) | {"crack_length": 1 + numbers, "energy": 5 + numbers}
    found = beams.layout(columns | {"sample": range(4), "state": [0, 1, 2, 0], "deflection": np.zeros((1, 3))}, nodes)
    assert releases.stuck_lengths(found).tolist() == [1, 4]
    assert releases.stuck_energies(found).tolist() == [5, 8]
    assert_array_equal(releases.ends_as(found, "S-shape"), [True, False, False, True])
    assert_array_equal(releases.ends_as(found, "arc"), [False, True, False, False])
    assert_array_equal(releases.ends_as(found, "free"), [False, False, True, False])
    assert found.state.attrs["flag_meanings"] == "S-shape arc free"


def test_statistics_of_exponential_heights_are_those_of_their_distribution():
    z = 2e-9 * np.random.default_rng(5).standard_exponential((100, 4000))
    strips = {"power": np.stack([np.mean(z**order, axis=1) for order in (1, 2, 3, 4)], axis=1)}
    strips |= {"summit_density": np.linspace(60e12, 70e12, 100), "mean_curvature": np.linspace(2.4e6, 2.6e6, 100)}
    nothing = np.zeros(1), np.zeros((1, 1))
    found = character.layout(strips, nothing, np.zeros((2, 1)), (1e-9, np.zeros((1, 1))))
    values, errors = character.statistics(found, (1e-9, 1, 1, 1e-6, 1e12))
    assert np.all(np.abs(values - [2, 2, 9, 0.4, 65]) < 4 * errors)
    assert np.all(errors < 0.05 * values)
    assert_allclose(character.statistics(found)[0], values * [1e-9, 1, 1, 1e-6, 1e12])


def test_strips_have_the_margin_spacing_and_length_of_the_configuration():
    assert Sampling(7.5e-9, 1.5e-6, 1e-6).strips(30e-6) == StripGrid(1.5e-6, 30e-6, 7.5e-9, margin=1e-6)
