"""Studies of small size: what they compute from the stages, and the laws that it obeys."""

from dataclasses import replace

import numpy as np
import pytest
import small
from numpy.testing import assert_allclose, assert_array_equal
from plans import job_settings
from published import SURFACES
from vectors import sampled_vectors

from stiction.beam.energy import apparent_adhesion_energy
from stiction.beam.foundation import ELEMENT, foundation_length
from stiction.beam.montecarlo import Experiment, release_beam
from stiction.beam.resolution import resolved
from stiction.chaos.model import draw_laws, fit, resample_laws, truncated
from stiction.config.cases import Case, case_id
from stiction.contact.asperity import reduced_modulus
from stiction.contact.environment import Water
from stiction.contact.forcelaw import admissible, coefficients, energy, pressure
from stiction.contact.materials import Solid
from stiction.stages.beams import mesh, resampling, variant_beams
from stiction.stages.beams.cantilevers import cantilever
from stiction.stages.contact import contact as stage_contact
from stiction.stages.contact import curves, plasticity
from stiction.stages.contact.changes import moments, quantities
from stiction.stages.contact.pairs import streams_of_sides, surface_pair
from stiction.stages.laws import chaos, forces, humidity, orders, sample_sizes, sensitivity, slopes
from stiction.stages.laws import fit as study_fit
from stiction.stages.surfaces import correlation, iteration, spectrum
from stiction.streams import stream
from stiction.surface.spectrum import autocovariance
from stiction.surface.summits import find_summits

WATER = Water(300.0)


def of_vectors(vectors, limit=None):
    """Dataset of stage forces of given vectors."""
    limit = 1.1 * vectors[:, 1].max() if limit is None else limit
    return forces.layout(vectors, limit, np.zeros(1), np.zeros((1, 1)))


# Sensitivity (Fig. 13)


@pytest.fixture(scope="module")
def shifted():
    """Contacts of less and more skewness."""
    plain = job_settings(small.PLAN, "studies/sensitivity/contact/b_rms_less") | {"moments": ["skewness"]}
    return moments.compute(small.surfaces(), "b", small.settings_of(moments, plain))


def test_sensitivity_is_that_of_the_energies_at_both_values(shifted):
    settings = small.settings_of(sensitivity, job_settings(small.PLAN, "studies/sensitivity/b_rms"))
    plain = small.settings_of(moments, job_settings(small.PLAN, "studies/sensitivity/contact/b_rms_less"))
    unchanged = stage_contact.compute(small.surfaces(), "b", "NG", plain, range(3))
    found = sensitivity.compute(shifted, unchanged, settings)
    assert list(found.humidity) == [0.44, 0.55, 0.67, 0.80, 0.88, 0.92]
    assert list(found.moment) == [moments.moment(contact) for contact in shifted]
    for k, h in enumerate(found.humidity.values):
        energies = [curves.energies(contact, h, WATER) for contact in shifted]
        assert_array_equal(found.adhesion_energy[:, k], energies)
    # The slope of the mean as Fig. 13 defines it, but for the square of the step times the slope.
    less, more = found.adhesion_energy.mean("strip")
    assert_allclose(found.slope.sel(statistic="mean"), np.log(more / less) / np.log(1.1 / 0.9), rtol=1e-6)
    # Differences to either side are those of the samples in common with the unchanged contact.
    energies = found.adhesion_energy[:, :, :3].mean("strip")
    here = np.mean([curves.energies(unchanged, h, WATER) for h in found.humidity.values], axis=1)
    assert_allclose(found.difference, [(energies[0] / here - 1) / -0.1, (energies[1] / here - 1) / 0.1], rtol=1e-9)


# Slopes with common random numbers


def test_slopes_and_their_errors_are_those_of_the_chosen_quantities():
    values = np.arange(6.0).reshape(3, 2)
    dataset = slopes.layout(["rms", "skewness", "kurtosis"], (0.44, 0.88), values, 0.1 * values)
    assert_allclose(slopes.by_quantity(dataset, ["kurtosis", "rms"]), [[4, 0], [5, 1]])
    assert_allclose(slopes.errors_of(dataset, ["kurtosis", "rms"]), [[0.4, 0], [0.5, 0.1]])


def test_slopes_are_those_of_the_energies_at_both_values_and_of_their_own_quantity():
    settings = small.settings_of(quantities, job_settings(small.PLAN, "studies/slopes/contact/b_B2_rms_less"))
    less, more = quantities.compute(small.surfaces(), "b", "B2", "rms", settings)
    wanted = small.settings_of(slopes, job_settings(small.PLAN, "studies/sensitivity/b_rms"))
    found = slopes.compute({"rms": less, "kurtosis": more}, {"rms": more, "kurtosis": less}, wanted)
    for k, h in enumerate(wanted.humidities):
        low, high = (curves.energies(contact, h, WATER) for contact in (less, more))
        expected = np.log(high.mean() / low.mean()) / 0.1
        assert_allclose(slopes.by_quantity(found, ["rms", "kurtosis"])[k], [expected, -expected], rtol=1e-9)
        paired = np.std(np.log(high / low) / 0.1, ddof=1) / np.sqrt(len(low))
        assert 0.3 * paired < float(found.standard_error[0, k]) < 3 * paired
    # Rougher surfaces adhere less, the more so the drier the air.
    of_rms = slopes.by_quantity(found, ["rms"])[:, 0]
    assert np.all(of_rms < 0)
    assert of_rms[0] < of_rms[-1]


# Plasticity (App. A)


def test_the_softer_of_two_materials_yields():
    settings = small.settings_of(plasticity, job_settings(small.PLAN, "studies/plasticity/b"))
    soft = replace(settings, materials={"beam": Solid(hardness=1e9)})
    hard = replace(settings, materials={"beam": Solid(hardness=1e12)})
    found = {name: plasticity.compute(small.surfaces(), "b", one) for name, one in (("soft", soft), ("hard", hard))}
    shares = {name: float(dataset.plastic_share) for name, dataset in found.items()}
    assert shares["soft"] > shares["hard"]
    assert shares["hard"] == float(plasticity.compute(small.surfaces(), "b", settings).plastic_share)
    assert float(found["soft"].hardness) == 1e9


def test_stress_of_every_touching_summit_is_that_of_eq_14():
    settings = small.settings_of(plasticity, job_settings(small.PLAN, "studies/plasticity/b"))
    found = plasticity.compute(small.surfaces(), "b", settings)
    modulus = reduced_modulus(164e9, 0.23)
    stress = 2 / np.pi * modulus * np.sqrt(found.interference / found.radius)
    assert_allclose(found.stress, stress, rtol=1e-5)
    both = surface_pair(small.surfaces(), "NG", settings)
    for k in (0, 3):
        height, curvature, _ = find_summits(both.draw(*streams_of_sides(small.SEED, "b")(k)), 10e-9)
        touching, ours = height > 5.7e-9, found.strip == k
        assert_allclose(found.interference[ours], height[touching] - 5.7e-9, rtol=1e-5)
        assert_allclose(found.radius[ours], 1 / curvature[touching], rtol=1e-5)
    assert set(found.strip.values) == {0, 1, 2, 3}
    assert float(found.separation) == pytest.approx(5.7e-9)


def test_the_mean_pressure_is_that_of_the_contact_at_the_same_distance_without_attraction():
    """Both sum the spheres of Hertz over the summits of the same strips, one of them over the nodes of a grid."""
    settings = small.settings_of(plasticity, job_settings(small.PLAN, "studies/plasticity/b"))
    found = plasticity.compute(small.surfaces(), "b", settings)
    of_pair = replace(small.settings_of(stage_contact, job_settings(small.PLAN, "contact/b_NG")), van_der_waals="none")
    there = stage_contact.compute(small.surfaces(), "b", "NG", of_pair, range(settings.strips))
    pressure = float(there.solid_pressure.mean("strip").interp(distance=settings.distance))
    assert float(found.pressure) == pytest.approx(pressure, rel=0.01)
    closer = plasticity.compute(small.surfaces(), "b", replace(settings, distance=0.9 * settings.distance))
    assert float(closer.pressure) > 1.2 * pressure


@pytest.mark.parametrize("gigapascals", [400, 700])
def test_the_plastic_share_is_that_of_the_area_above_the_onset(gigapascals):
    settings = small.settings_of(plasticity, job_settings(small.PLAN, "studies/plasticity/b"))
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
    settings = small.settings_of(study_fit, job_settings(small.PLAN, f"forces/{small.CASE}_NG"))
    found = study_fit.compute(small.contact_of_pair(), small.forces_of_case(), settings)
    vectors, limit = forces.vectors(small.forces_of_case())
    assert_array_equal(found.strip, np.flatnonzero(admissible(vectors, limit)))
    distance, curve, *_ = curves.force_curves(small.contact_of_pair(), small.HUMIDITY, WATER)
    for sample in found.strip.values[[0, -1]]:
        used = distance >= vectors[sample, 3]
        law = coefficients(vectors[[sample]], limit)[0]
        force = curve(sample)[used]
        error = np.linalg.norm(pressure(law, distance[used]) - force) / np.linalg.norm(force)
        assert_allclose(found.curve_error.sel(strip=sample), error, rtol=1e-9)
    assert np.all(found.energy_error < 1e-9)
    assert float(found.without_law) == pytest.approx(1 - len(found.strip) / 20)


def test_fit_leaves_out_samples_without_a_law():
    settings = small.settings_of(study_fit, job_settings(small.PLAN, f"forces/{small.CASE}_NG"))
    lawless = small.forces_of_case().copy(deep=True)
    lawless.adhesion_energy[:5] = 1e-6
    found = study_fit.compute(small.contact_of_pair(), lawless, settings)
    assert found.strip.min() >= 5
    assert float(found.without_law) >= 0.25
    whole = study_fit.compute(small.contact_of_pair(), small.forces_of_case(), settings)
    assert_array_equal(found.curve_error, whole.curve_error.sel(strip=found.strip))


# Humidity (Fig. 15)


def test_energies_along_the_humidity_are_those_at_each_humidity_and_grow_at_high_ones():
    settings = small.settings_of(humidity, job_settings(small.PLAN, "humidity/b_NG"))
    found = humidity.compute(small.contact_of_pair(), settings)
    assert_allclose(found.humidity, np.linspace(0.44, 0.92, 25))
    for k in (0, 12, 24):
        energies = curves.energies(small.contact_of_pair(), float(found.humidity[k]), WATER)
        assert_allclose(found.energy_quantile[:, k], np.quantile(energies, [0.05, 0.5, 0.95]), rtol=1e-12)
    assert np.all(np.diff(found.energy_quantile[:, 12:]) > 0)
    assert np.all(np.diff(found.energy_quantile, axis=0) > 0)


# Iteration (Figs. 4 and 10)


def test_iteration_corrects_each_spectrum_by_what_its_fields_show():
    settings = small.settings_of(iteration, job_settings(small.PLAN, "iteration/B2"))
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
    settings = small.settings_of(iteration, job_settings(small.PLAN, "iteration/B2"))
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
    found = sample_sizes.compute(of_vectors(vectors), (0.001, 0.1, 0.5))
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
    settings = job_settings(small.PLAN, "studies/orders")
    model = fit(vectors, 1.1 * vectors[:, 1].max(), 2, 0.2)
    assert model.dimension < 4
    dataset = chaos.layout(model, (np.zeros((3, 4, 4)), np.zeros((3, 4, 4))), 0.0)
    found = orders.compute(of_vectors(vectors), dataset, **settings)
    assert list(found.order) == [1, 2]
    assert (found.samples, found.draws) == (300, 2000)
    eta = model.coordinates.reduce(vectors)[:, : model.dimension]
    edges = np.linspace(-4, 4, 65)
    for order in (1, 2):
        xi = stream(small.SEED, "orders", settings["case"]).random((2000, model.dimension))
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
    close = found.distance.sel(target="kernels") <= 0.869 * np.sqrt(1 / 300 + 1 / 2000)
    for k, column in enumerate(close.values.T):
        expected = 0 if not column[1] else 1 if column[0] else 2
        assert found.converged_order[k] == expected


@pytest.mark.parametrize(("distance", "converged"), [(0.0, 1), (1.0, 0)])
def test_an_order_has_converged_if_its_marginals_are_near_the_kernels(monkeypatch, distance, converged):
    monkeypatch.setattr(orders.convergence, "distance_to", lambda *_: distance)
    vectors = sampled_vectors(300)
    model = fit(vectors, 1.1 * vectors[:, 1].max(), 2, 0.2)
    dataset = chaos.layout(model, (np.zeros((3, 4, 4)), np.zeros((3, 4, 4))), 0.0)
    found = orders.compute(of_vectors(vectors), dataset, **job_settings(small.PLAN, "studies/orders"))
    assert_array_equal(found.converged_order, converged)


# Mesh (App. C)


def test_fine_elements_find_the_energy_of_the_law_and_the_case_of_median_energy():
    settings = small.settings_of(mesh, job_settings(small.PLAN, "studies/mesh"))
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
    ("factor", "length", "reason"), [(300, 150, "do not resolve a crack"), (3e5, 1.5, "do not resolve a crack")]
)
def test_meshes_that_do_not_resolve_the_crack_are_left_out_and_none_is_an_error(factor, length, reason):
    settings = small.settings_of(mesh, job_settings(small.PLAN, "studies/mesh"))
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
    settings = replace(
        small.settings_of(mesh, job_settings(small.PLAN, "studies/mesh")), mesh=mesh.Meshes((150e-6, 1.5e-6), (1.5e-6,))
    )
    with pytest.warns(UserWarning, match="left out elements of 150 µm"):
        found = mesh.compute(strong_forces(30), settings)
    assert_allclose(found.element_length, [1.5e-6])


# Correlation (App. C)


def test_autocorrelation_starts_at_one_and_ends_below_its_threshold():
    names = ("B2", "Sub1")
    found = correlation.compute({name: small.spectrum_of(name) for name in names}, names)
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
    settings = small.settings_of(resampling, job_settings(small.PLAN, f"studies/resampling/{small.CASE}"))
    found = resampling.compute(small.forces_of_case(), small.CASE, settings)
    vectors, limit = forces.vectors(small.forces_of_case())
    experiment = Experiment(cantilever(settings, "b"), 1000, lambda n, rng: resample_laws(vectors, limit, n, rng))
    assert_array_equal(found.beam, range(3))
    for k in (0, 2):
        beam = release_beam(experiment, k, stream(small.SEED, "resampling", small.CASE, k))
        assert (found.state[k], found.crack_length[k]) == (beam.state, beam.crack_length)


@pytest.mark.parametrize("h", [0.55, 0.8])
def test_a_variant_is_the_chain_behind_its_contact(h):
    case = case_id("b", h)
    settings = small.settings_of(variant_beams, job_settings(small.PLAN, f"studies/variants/{case}_base"))
    found = variant_beams.compute(small.contact_of_pair(), case, settings).isel(humidity=0)
    vectors, limit = curves.vectors(small.contact_of_pair(), h, WATER)
    assert found.humidity == h
    assert_array_equal(found.adhesion_energy, vectors[:, 0])
    model = fit(vectors, limit, 2, 0.001)
    experiment = Experiment(cantilever(settings, "b"), 1000, lambda n, rng: draw_laws(model, n, rng))
    for number in (0, 1):
        beam = release_beam(experiment, number, stream(small.SEED, "beams", case, number))
        assert found.crack_length[number] == beam.crack_length
        assert found.state[number] == beam.state
    assert found.sizes["beam"] == 2


def test_a_variant_has_the_first_samples_of_a_larger_contact():
    settings = small.settings_of(variant_beams, job_settings(small.PLAN, f"studies/variants/{small.CASE}_base"))
    found = variant_beams.compute(small.contact_of_pair(), small.CASE, replace(settings, samples=18))
    first = variant_beams.compute(small.contact_of_pair().isel(strip=range(18)), small.CASE, settings)
    assert found.sizes["strip"] == 18
    for name in ("adhesion_energy", "crack_length", "state"):
        assert_array_equal(found[name], first[name])


def test_elements_of_a_variant_and_of_resampled_beams_follow_the_laws_if_asked():
    settings = small.settings_of(variant_beams, job_settings(small.PLAN, "studies/variants/b_rh080_base"))
    base, finer = (
        variant_beams.compute(small.contact_of_pair(), Case("b_rh080"), replace(settings, coarser_mesh=coarser))
        for coarser in (1.7, 1.0)
    )
    assert np.all(finer.crack_length != base.crack_length)
    settings = small.settings_of(resampling, job_settings(small.PLAN, f"studies/resampling/{small.CASE}"))
    vectors, limit = forces.vectors(small.forces_of_case())
    laws = resample_laws(vectors, limit, 10_000, stream(small.SEED, "resampling", small.CASE, "mesh"))
    refined = resolved(cantilever(settings, "b"), 1000, laws)
    found = resampling.compute(small.forces_of_case(), small.CASE, replace(settings, coarser_mesh=1.0))
    experiment = Experiment(refined, 1000, lambda n, rng: resample_laws(vectors, limit, n, rng))
    beam = release_beam(experiment, 1, stream(small.SEED, "resampling", small.CASE, 1))
    assert refined.elements > 200
    assert found.crack_length[1] == beam.crack_length


def test_cases_of_a_variant_keep_the_beams_that_stick():
    beams = [{"crack_length": np.array([1.0, 2.0]) * k, "state": np.array([0, k])} for k in (1, 2)]
    found = variant_beams.layout((0.5, 0.6), [[1e-3, 2e-3], [3e-3, 4e-3]], beams)
    (h, first), (_, second) = variant_beams.cases_of(found)
    assert h == 0.5
    assert_array_equal([*vars(first).values()][0], [1e-3, 2e-3])
    assert_array_equal([*vars(second).values()][1], [2.0, 4.0])
    assert_array_equal([*vars(second).values()][2], [True, False])


def test_cases_of_a_pair_are_joined_from_dry_to_humid():
    def case(humidity):
        beams = [{"crack_length": np.array([humidity, 2 * humidity]), "state": np.array([0, 1])}]
        dataset = variant_beams.layout([humidity], [[1e-3 * humidity]], beams)
        return dataset.assign_coords(pair="b", relative_humidity=humidity)  # the identity of its job

    found = variant_beams.by_pair(
        {("b", 0.8, "dry"): case(0.8), ("b", 0.655, "dry"): case(0.655), ("a", 0.9, "base"): case(0.9)}
    )
    assert list(found) == [("b", "dry"), ("a", "base")]
    assert_array_equal(found["b", "dry"].humidity, [0.655, 0.8])
    assert_array_equal(found["b", "dry"].relative_humidity, [0.655, 0.8])
    assert_array_equal(found["b", "dry"].crack_length[:, 1], [1.31, 1.6])
