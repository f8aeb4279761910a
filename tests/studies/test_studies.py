"""Studies of small size: what they compute from the stages, and the laws that it obeys."""

from dataclasses import replace

import numpy as np
import pytest
import small
from numpy.testing import assert_allclose, assert_array_equal
from published import SURFACES
from vectors import sampled_vectors

from stiction.analysis.sensitivity import energy_sensitivity
from stiction.beam.energy import apparent_adhesion_energy
from stiction.beam.foundation import ELEMENT, foundation_length
from stiction.beam.montecarlo import Experiment, release_beam
from stiction.beam.resolution import resolved
from stiction.chaos.model import draw_laws, fit, resample_laws, truncated
from stiction.config import jobs
from stiction.config.cases import case_id
from stiction.contact.asperity import reduced_modulus
from stiction.contact.forcelaw import admissible, coefficients, energy, pressure
from stiction.stages import chaos, curves, forces, heights, parameters, spectrum
from stiction.stages import contact as stage_contact
from stiction.stages.cantilevers import cantilever
from stiction.stages.pairs import streams_of_sides, surface_pair
from stiction.streams import stream
from stiction.studies import (
    correlation,
    humidity,
    iteration,
    mesh,
    orders,
    plasticity,
    resampling,
    sample_sizes,
    sensitivity,
    sensitivity_contact,
    variant,
    variant_contact,
)
from stiction.studies import fit as study_fit
from stiction.surface.spectrum import autocovariance
from stiction.surface.summits import find_summits

WATER = curves.Water(300.0)


def of_vectors(vectors, limit=None):
    """Dataset of stage forces of given vectors."""
    limit = 1.1 * vectors[:, 1].max() if limit is None else limit
    return forces.layout(vectors, limit, np.zeros(1), np.zeros((1, 1)))


# Sensitivity (Fig. 13)


@pytest.fixture(scope="module")
def shifted():
    """Datasets of less and more skewness, and their settings."""
    plain = jobs.sensitivity_contact(small.PLAN, "b")
    settings = small.settings_of(sensitivity_contact, plain)
    sides = ("less", "more")
    return [sensitivity_contact.compute(small.surfaces(), "b", "skewness", side, settings) for side in sides], settings


def test_less_and_more_of_a_moment_bracket_that_of_the_surface(shifted):
    less, more = map(sensitivity_contact.moment, shifted[0])
    assert (less, more) == pytest.approx((-0.76 * 1.05, -0.76 * 0.95))


@pytest.mark.parametrize(("moment", "side", "factor"), [("rms", "less", 0.95), ("kurtosis", "more", 1.05)])
def test_a_shifted_moment_changes_that_of_the_beams_surface_alone(monkeypatch, shifted, moment, side, factor):
    asked, contact = [], small.contact_of_pair()
    monkeypatch.setattr(stage_contact, "compute", lambda *given: asked.extend(given) or contact)
    found = sensitivity_contact.compute(small.surfaces(), "b", moment, side, shifted[1])
    ((changed, shape), substrate), pair, model, _ = asked
    before = heights.moments(small.heights_of("B2"))
    assert heights.moments(changed) == replace(before, **{moment: getattr(before, moment) * factor})
    assert sensitivity_contact.moment(found) == pytest.approx(getattr(before, moment) * factor, rel=1e-14)
    assert parameters.spectrum_of(shape) == SURFACES["B2"].published_psd
    assert_array_equal(shape.wavenumber, small.spectrum_of("B2").wavenumber)
    assert all(ours is theirs for ours, theirs in zip(substrate, small.surfaces()[1], strict=True))
    assert (pair, model) == ("b", "NG")


def test_a_step_of_nothing_is_the_contact_of_the_pair(shifted):
    settings = replace(shifted[1], step=0.0)
    found = sensitivity_contact.compute(small.surfaces(), "b", "rms", "more", settings)
    assert_allclose(found.solid_pressure, small.contact_of_pair().solid_pressure[:4], rtol=1e-5, atol=1)
    assert_allclose(found.bearing_area, small.contact_of_pair().bearing_area[:4], rtol=1e-6)


def test_sensitivity_is_that_of_the_energies_at_both_values(shifted):
    settings = small.settings_of(sensitivity, jobs.sensitivity(small.PLAN, "b"))
    found = sensitivity.compute(shifted[0], settings)
    assert list(found.humidity) == [0.44, 0.55, 0.67, 0.80, 0.88, 0.92]
    assert list(found.moment) == [sensitivity_contact.moment(contact) for contact in shifted[0]]
    for k, h in enumerate(found.humidity.values):
        energies = [curves.energies(contact, h, WATER) for contact in shifted[0]]
        assert_array_equal(found.adhesion_energy[:, k], energies)
        slopes, errors = energy_sensitivity(energies, list(found.moment.values))
        assert_allclose(found.slope[:, k], slopes, rtol=1e-9)
        assert_allclose(found.standard_error[:, k], errors, rtol=1e-9)
    # The slope of the mean as Fig. 13 defines it, to the first order of the step.
    less, more = found.adhesion_energy.mean("sample")
    plain = (more - less) / (0.5 * (more + less)) / 0.1
    assert_allclose(found.slope.sel(statistic="mean"), plain, rtol=0.02, atol=0.02)


# Plasticity (App. A)


def test_stress_of_every_touching_summit_is_that_of_eq_14():
    settings = small.settings_of(plasticity, jobs.plasticity(small.PLAN, "b"))
    found = plasticity.compute(small.surfaces(), "b", settings)
    modulus = reduced_modulus(164e9, 0.23)
    stress = 2 / np.pi * modulus * np.sqrt(found.interference / found.radius)
    assert_allclose(found.stress, stress, rtol=1e-5)
    meeting = surface_pair(small.surfaces(), "NG", settings)
    for k in (0, 3):
        height, curvature, _ = find_summits(meeting.draw(*streams_of_sides(small.SEED, "b")(k)), 10e-9)
        touching, ours = height > 5.7e-9, found.strip == k
        assert_allclose(found.interference[ours], height[touching] - 5.7e-9, rtol=1e-5)
        assert_allclose(found.radius[ours], 1 / curvature[touching], rtol=1e-5)
    assert set(found.strip.values) == {0, 1, 2, 3}
    assert float(found.separation) == pytest.approx(5.7e-9)


@pytest.mark.parametrize("gigapascals", [400, 700])
def test_the_plastic_share_is_that_of_the_area_above_the_onset(gigapascals):
    settings = small.settings_of(plasticity, jobs.plasticity(small.PLAN, "b"))
    stiff = replace(settings, solid=replace(settings.solid, young_modulus=gigapascals * 1e9), distance=3e-9)
    found = plasticity.compute(small.surfaces(), "b", stiff)
    area = found.radius * found.interference
    plastic = found.stress > 0.6 * 12.8e9
    assert 0 < plastic.mean() < 1
    assert float(found.plastic_share) == pytest.approx(float(area[plastic].sum() / area.sum()), rel=1e-5)
    assert 0 < found.plastic_share < 1
    assert 0 < found.plastic_share_error < 0.5


# Fit (Fig. 5)


def test_fit_compares_every_curve_that_has_a_law_with_its_law():
    settings = small.settings_of(study_fit, jobs.forces(small.PLAN, small.CASE))
    found = study_fit.compute(small.contact_of_pair(), small.forces_of_case(), settings)
    vectors, limit = forces.vectors(small.forces_of_case())
    assert_array_equal(found.sample, np.flatnonzero(admissible(vectors, limit)))
    distance, curve = curves.force_curves(small.contact_of_pair(), small.HUMIDITY, WATER)
    for sample in found.sample.values[[0, -1]]:
        used = distance >= vectors[sample, 3]
        law = coefficients(vectors[[sample]], limit)[0]
        force = curve(sample)[used]
        error = np.linalg.norm(pressure(law, distance[used]) - force) / np.linalg.norm(force)
        assert_allclose(found.curve_error.sel(sample=sample), error, rtol=1e-9)
    assert np.all(found.energy_error < 1e-9)
    assert float(found.without_law) == pytest.approx(1 - len(found.sample) / 20)


def test_fit_leaves_out_samples_without_a_law():
    settings = small.settings_of(study_fit, jobs.forces(small.PLAN, small.CASE))
    lawless = small.forces_of_case().copy(deep=True)
    lawless.adhesion_energy[:5] = 1e-6
    found = study_fit.compute(small.contact_of_pair(), lawless, settings)
    assert found.sample.min() >= 5
    assert float(found.without_law) >= 0.25
    whole = study_fit.compute(small.contact_of_pair(), small.forces_of_case(), settings)
    assert_array_equal(found.curve_error, whole.curve_error.sel(sample=found.sample))


# Humidity (Fig. 15)


def test_energies_along_the_humidity_are_those_at_each_humidity_and_grow_at_high_ones():
    settings = small.settings_of(humidity, jobs.humidity(small.PLAN, "b"))
    found = humidity.compute(small.contact_of_pair(), settings)
    assert_allclose(found.humidity, np.linspace(0.44, 0.92, 25))
    for k in (0, 12, 24):
        energies = curves.energies(small.contact_of_pair(), float(found.humidity[k]), WATER)
        assert_allclose(found.energy_mean[k], energies.mean(), rtol=1e-12)
        assert_allclose(found.energy_mean_error[k], energies.std(ddof=1) / np.sqrt(20), rtol=1e-12)
        assert_allclose(found.energy_quantile[:, k], np.quantile(energies, [0.05, 0.5, 0.95]), rtol=1e-12)
    assert np.all(np.diff(found.energy_mean[12:]) > 0)
    assert np.all(np.diff(found.energy_quantile, axis=0) > 0)


# Iteration (Figs. 4 and 10)


def test_iteration_corrects_each_spectrum_by_what_its_fields_show():
    settings = small.settings_of(iteration, jobs.iteration(small.PLAN))
    found = iteration.compute(small.heights_of("B2"), small.spectrum_of("B2"), "B2", settings)
    assert dict(found.sizes)["iteration"] == dict(found.sizes)["field"] == 2
    target = SURFACES["B2"].published_psd
    assert_allclose(found.underlying[0], target(found.wavenumber.values) / target.variance, rtol=1e-12)
    estimate = found.periodogram.mean("field")
    assert_allclose(found.underlying[1], found.underlying[0] * found.target / estimate[0], rtol=1e-9)
    assert_allclose(found.misfit, np.abs(np.log(estimate / found.target)).mean("wavenumber"), rtol=1e-9)
    assert found.misfit[1] < found.misfit[0]
    closed = spectrum.achieved(small.spectrum_of("B2"), found.wavenumber.values)
    assert_allclose(found.closed_form_misfit, np.abs(np.log(closed / found.target)).mean(), rtol=1e-9)
    relative = (found.periodogram.std("field", ddof=1) / estimate).mean("wavenumber")
    assert_allclose(found.sampling_misfit, np.sqrt(2 / np.pi / 2) * relative, rtol=1e-9)


def test_the_fields_of_an_iteration_are_drawn_from_the_stream_of_the_surface():
    settings = small.settings_of(iteration, jobs.iteration(small.PLAN))
    one = replace(settings, iteration=iteration.Steps(1, 2))
    found = iteration.compute(small.heights_of("B2"), small.spectrum_of("B2"), "B2", one)
    steps = iteration.iterate(
        SURFACES["B2"].published_psd,
        SURFACES["B2"].translation,
        iteration.StripGrid(10.24e-6, 10.24e-6, 10e-9, margin=0.0),
        2,
        stream(small.SEED, "iteration", "B2"),
    )
    assert_allclose(found.periodogram[0], next(steps)[1], rtol=1e-5)


# Sample sizes and orders (App. B)


def test_all_samples_are_at_no_distance_from_themselves_and_densities_hold_one():
    vectors = sampled_vectors(400)
    found = sample_sizes.compute(of_vectors(vectors), sample_sizes.Settings((0.001, 0.1, 0.5), small.CASE))
    assert list(found["size"]) == [2, 40, 200, 400]
    assert found.distance[-1] == 0
    assert found.distance_error[-1] == 0
    assert np.all(np.diff(found.distance) < 0)
    # Independent samples give 0.869 √(1/size - 1/n).
    expected = 0.869 * np.sqrt(1 / 40 - 1 / 400)
    assert abs(found.distance[1] - expected) < 4 * found.distance_error[1]
    integral = found.density.sum("energy") * float(found.energy[1] - found.energy[0])
    assert_allclose(integral[1:], 1, rtol=0.02)
    assert float(found.energy[-1]) == pytest.approx(1.2 * vectors[:, 0].max())
    moment = (found.density[1] * found.energy).sum() * float(found.energy[1])
    assert_allclose(moment, vectors[:40, 0].mean(), rtol=0.02)


def test_marginals_of_every_order_are_drawn_from_the_model_cut_there():
    vectors = sampled_vectors(300)
    settings = small.settings_of(orders, jobs.orders(small.PLAN))
    model = fit(vectors, 1.1 * vectors[:, 1].max(), 2, 0.2)
    assert model.dimension < 4
    dataset = chaos.layout(model, (np.zeros((3, 4, 4)), np.zeros((3, 4, 4))), 0.0)
    found = orders.compute(of_vectors(vectors), dataset, settings)
    assert list(found.order) == [1, 2]
    assert found.samples == 300
    eta = model.coordinates.reduce(vectors)[:, : model.dimension]
    edges = np.linspace(-4, 4, 65)
    for order in (1, 2):
        xi = stream(small.SEED, "orders", settings.case).random((2000, model.dimension))
        drawn = truncated(model, order)(xi)
        for k in range(model.dimension):
            chosen = found.sel(order=order, eta=k + 1)
            assert_allclose(chosen.density, np.histogram(drawn[:, k], edges, density=True)[0])
            at = np.sort(np.concatenate([drawn[:, k], eta[:, k]]))
            shares = [np.searchsorted(np.sort(s), at, side="right") / len(s) for s in (drawn[:, k], eta[:, k])]
            assert_allclose(chosen.distance.sel(target="input"), np.abs(np.subtract(*shares)).max())
    # Both targets have nearly one distribution.
    assert_allclose(*(found.distance.sel(target=name) for name in ("kernels", "input")), atol=0.1)
    assert np.all(found.distance.sel(target="kernels") != found.distance.sel(target="input"))
    assert_allclose(found.input_density.sum("position") / 8, 1)
    close = found.distance.sel(target="kernels") <= 0.869 / np.sqrt(300)
    for k, column in enumerate(close.values.T):
        expected = 0 if not column[1] else 1 if column[0] else 2
        assert found.converged_order[k] == expected


# Mesh (App. C)


def test_fine_elements_find_the_energy_of_the_law_and_the_case_of_median_energy():
    settings = small.settings_of(mesh, jobs.mesh(small.PLAN))
    fine = replace(settings, mesh=mesh.Meshes((7.5e-6, 3.75e-6), (1.5e-6, 0.75e-6)))
    found = mesh.compute(small.forces_of_case(), fine)
    pairs = list(zip(found.element_length.values, found.point_distance.values, strict=True))
    assert pairs == [(7.5e-6, 1.5e-6), (7.5e-6, 0.75e-6), (3.75e-6, 0.75e-6)]
    vectors, limit = forces.vectors(small.forces_of_case())
    sample = np.argsort(vectors[:, 0])[10]
    assert_array_equal(found.law, coefficients(vectors[[sample]], limit)[0])
    assert_allclose(found.energy[-1], energy(found.law.values), rtol=0.05)
    assert_allclose(found.energy[-1], vectors[sample, 0], rtol=0.05)
    assert_array_equal(found.force, small.forces_of_case().force[sample])
    beam = cantilever(settings, "b")
    assert_allclose(found.energy, apparent_adhesion_energy(found.crack_length.values, beam), rtol=1e-9)
    assert len({*found.crack_length.values}) == 3


def strong_forces(factor):
    """Forces of the case, on surfaces that adhere more strongly by a factor."""
    found = small.forces_of_case()
    stronger = {name: factor * found[name] for name in ("adhesion_energy", "pull_off", "limit")}
    return found.assign(stronger)


@pytest.mark.parametrize(
    ("factor", "length", "reason"), [(300, 150, "do not resolve a crack"), (3e5, 1.5, "equilibrium of the beam")]
)
def test_meshes_that_do_not_resolve_the_crack_are_left_out_and_none_is_an_error(factor, length, reason):
    settings = small.settings_of(mesh, jobs.mesh(small.PLAN))
    coarse = replace(settings, mesh=mesh.Meshes((1e-6 * length,), (1.5e-6,)))
    samples, limit = forces.vectors(strong_forces(factor))
    laws = coefficients(samples, limit)
    median = np.argsort(samples[:, 0])[len(laws) // 2]
    element = 1e6 * ELEMENT * foundation_length(cantilever(settings, "b"), laws[[median]])
    with (
        pytest.warns(UserWarning, match=f"left out elements of {length} µm: .*{reason}"),
        pytest.raises(ValueError, match=f"elements of at most {element:.3g} µm"),
    ):
        mesh.compute(strong_forces(factor), coarse)


def test_the_meshes_that_resolve_the_crack_remain():
    settings = replace(small.settings_of(mesh, jobs.mesh(small.PLAN)), mesh=mesh.Meshes((150e-6, 1.5e-6), (1.5e-6,)))
    with pytest.warns(UserWarning, match="left out elements of 150 µm"):
        found = mesh.compute(strong_forces(30), settings)
    assert_allclose(found.element_length, [1.5e-6])


# Correlation (App. C)


def test_autocorrelation_starts_at_one_and_ends_below_its_threshold():
    names = ("B2", "Sub1")
    found = correlation.compute({name: small.spectrum_of(name) for name in names}, correlation.Settings(names))
    assert_allclose(found.autocorrelation[:, 0], 1, rtol=1e-14)
    for name in names:
        chosen = found.sel(surface=name)
        target = SURFACES[name].published_psd
        covariance = autocovariance(target, found.lag.values)
        assert_allclose(chosen.autocorrelation, covariance / target.variance, atol=2e-3)
        # To the resolution of the distances.
        beyond = found.lag > chosen.correlation_length
        assert chosen.autocorrelation[beyond].max() < 0.0105
        assert chosen.autocorrelation[~beyond][-1] > 0.0095
    assert float(found.lag[-1]) == pytest.approx(1e-6)


# Beams of other laws


def test_resampled_beams_are_released_on_laws_of_the_samples_from_streams_of_their_own():
    settings = small.settings_of(resampling, jobs.resampling(small.PLAN, small.CASE))
    found = resampling.compute(small.forces_of_case(), small.CASE, settings)
    vectors, limit = forces.vectors(small.forces_of_case())
    experiment = Experiment(cantilever(settings, "b"), 1000, lambda n, rng: resample_laws(vectors, limit, n, rng))
    assert_array_equal(found.sample, range(3))
    for k in (0, 2):
        beam = release_beam(experiment, k, stream(small.SEED, "resampling", small.CASE, k))
        assert (found.state[k], found.crack_length[k]) == (beam.state, beam.crack_length)


def test_a_variant_is_the_chain_behind_its_contact():
    settings = small.settings_of(variant, jobs.variant(small.PLAN, "b", "base"))
    pair = replace(settings.pairs["b"], humidities=(0.55, 0.8))
    found = variant.compute(small.contact_of_pair(), "b", replace(settings, pairs={"b": pair}))
    for k, h in enumerate((0.55, 0.8)):
        vectors, limit = curves.vectors(small.contact_of_pair(), h, WATER)
        assert_array_equal(found.adhesion_energy[k], vectors[:, 0])
        model = fit(vectors, limit, 2, 0.001)
        experiment = Experiment(cantilever(settings, "b"), 1000, lambda n, rng, m=model: draw_laws(m, n, rng))
        for number in (0, 1):
            beam = release_beam(experiment, number, stream(small.SEED, "beams", case_id("b", h), number))
            assert found.crack_length[k, number] == beam.crack_length
            assert found.state[k, number] == beam.state
    assert found.sizes["beam"] == 2


def test_elements_of_a_variant_follow_the_laws_at_some_humidities_and_of_resampled_beams_in_some_cases():
    settings = small.settings_of(variant, jobs.variant(small.PLAN, "b", "base"))
    pair = replace(settings.pairs["b"], humidities=(0.55, 0.8))
    base = variant.compute(small.contact_of_pair(), "b", replace(settings, pairs={"b": pair}))
    mixed = variant.compute(small.contact_of_pair(), "b", replace(settings, pairs={"b": pair}, refined=(0.8,)))
    assert_array_equal(mixed.crack_length[0], base.crack_length[0])
    assert np.all(mixed.crack_length[1] != base.crack_length[1])
    settings = small.settings_of(resampling, jobs.resampling(small.PLAN, small.CASE))
    vectors, limit = forces.vectors(small.forces_of_case())
    laws = resample_laws(vectors, limit, 10_000, stream(small.SEED, "resampling", small.CASE, "mesh"))
    refined = resolved(cantilever(settings, "b"), 1000, laws)
    found = resampling.compute(small.forces_of_case(), small.CASE, replace(settings, refined=True))
    experiment = Experiment(refined, 1000, lambda n, rng: resample_laws(vectors, limit, n, rng))
    beam = release_beam(experiment, 1, stream(small.SEED, "resampling", small.CASE, 1))
    assert refined.elements > 200
    assert found.crack_length[1] == beam.crack_length


def test_cases_of_a_variant_keep_the_beams_that_stick():
    beams = [{"crack_length": np.array([1.0, 2.0]) * k, "state": np.array([0, k])} for k in (1, 2)]
    found = variant.layout((0.5, 0.6), [[1e-3, 2e-3], [3e-3, 4e-3]], beams)
    (h, first), (_, second) = variant.cases_of(found)
    assert h == 0.5
    assert_array_equal([*vars(first).values()][0], [1e-3, 2e-3])
    assert_array_equal([*vars(second).values()][1], [2.0, 4.0])
    assert_array_equal([*vars(second).values()][2], [True, False])


def test_the_contact_of_the_base_variant_is_that_of_the_pair():
    plain = small.PLAN.variant_contact("b", "base")
    base = small.settings_of(variant_contact, plain["base"])
    found = variant_contact.compute({}, "b", base, replace(base, contact=replace(base.contact, samples=3)))
    assert_array_equal(found.solid_pressure, small.contact_of_pair().solid_pressure[:3])
