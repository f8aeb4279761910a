import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from stiction.contact.forcelaw import (
    adhesion_energies,
    adhesion_energy,
    admissible,
    apparent_force,
    coefficients,
    energy,
    extremum,
    fit_errors,
    humid_curves,
    limit_distance,
    parametrise,
    pressure,
    pull_offs,
    share_flat,
)
from stiction.streams import stream

NM = 1e-9
F_LIMIT = 3e6
VECTORS = np.array([[7e-3, 2e6, 8e-9, 6.5e-9], [9e-3, 3e6, 7.5e-9, 6.2e-9], [5e-3, 1e6, 8.3e-9, 6.9e-9]])
SMOOTH = np.array([2e6, 8e-9, 6e8, 6e8])  # equal steepness on both sides: the curve has no kink at d_max
STEP = 0.05 * NM


def grid(step, end=60 * NM):
    return step * np.arange(round(end / step))


# Eq. (12)


def test_force_law_has_its_minimum_minus_f_max_at_d_max():
    for law in coefficients(VECTORS, F_LIMIT):
        around = law[1] + np.linspace(-1, 1, 201) * NM
        assert np.argmin(pressure(law, around)) == 100
        np.testing.assert_allclose(pressure(law, law[1]), -law[0], rtol=1e-14)


def test_force_law_reaches_f_limit_at_d_limit():
    np.testing.assert_allclose(pressure(coefficients(VECTORS, F_LIMIT), VECTORS[:, 3]), F_LIMIT, rtol=1e-12)


def test_integral_of_the_attraction_of_a_force_law_is_e():
    for vector, law in zip(VECTORS, coefficients(VECTORS, F_LIMIT), strict=True):
        crossing = law[1] - np.log(2) / law[2]
        assert abs(pressure(law, crossing)) < 1e-9 * law[0]
        left = quad(lambda d, law=law: -pressure(law, d), crossing, law[1], epsrel=1e-12)[0]
        right = quad(lambda d, law=law: -pressure(law, d), law[1], law[1] + 60 / law[3], epsrel=1e-12)[0]
        np.testing.assert_allclose(left + right, vector[0], rtol=1e-9)
        np.testing.assert_allclose(energy(law), vector[0], rtol=1e-12)


def test_pressure_of_many_laws_is_that_of_each():
    laws, distance = coefficients(VECTORS, F_LIMIT), np.linspace(6, 12, 50) * NM
    together = pressure(laws[:, None], distance)
    assert together.shape == (3, 50)
    np.testing.assert_array_equal(together, [pressure(law, distance) for law in laws])


@given(st.floats(0.2, 5), st.floats(0.3, 3), st.floats(0.1, 4), st.floats(0.05, 20))
def test_a_vector_has_a_force_law_exactly_if_its_energy_exceeds_that_of_the_left_branch(f_max, gap, limit, share):
    a_left = np.log(1 + np.sqrt(1 + limit / f_max)) / (gap * NM)
    left = 0.5 * f_max * 1e6 / a_left
    vector = np.array([[share * left, f_max * 1e6, 8 * NM, (8 - gap) * NM]])
    if abs(share - 1) < 1e-6:
        return
    assert admissible(vector, limit * 1e6)[0] == (share > 1)
    if share > 1:
        law = coefficients(vector, limit * 1e6)
        assert law[0, 3] > 0
        np.testing.assert_allclose(energy(law), vector[:, 0], rtol=1e-8)


def test_a_vector_without_a_force_law_is_an_error_with_its_number():
    poor = VECTORS.copy()
    poor[1, 0] = 1e-4
    assert admissible(poor, F_LIMIT).tolist() == [True, False, True]
    with pytest.raises(ValueError, match="vector 1 has no law: its energy e = 0.0001 J/m²") as refused:
        coefficients(poor, F_LIMIT)
    least = float(str(refused.value).split()[-2])  # with three digits
    for share in (0.99, 1.01):
        poor[1, 0] = share * least
        assert admissible(poor, F_LIMIT)[1] == (share > 1)


# parameters of sampled curves


def errors(step, phase):
    """Deviation of e, f_max, d_max, d_limit found on a grid from those of the law, relative to f_max and its width."""
    distance = grid(step) + phase * step
    force = pressure(SMOOTH, distance)
    d_max, f_max = extremum(distance, force)
    d_limit = SMOOTH[1] - np.log(1 + np.sqrt(1 + F_LIMIT / SMOOTH[0])) / SMOOTH[2]
    return np.array(
        [
            adhesion_energy(distance, force) / energy(SMOOTH) - 1,
            f_max / SMOOTH[0] - 1,
            (d_max - SMOOTH[1]) * SMOOTH[2],
            (limit_distance(distance, force, F_LIMIT) - d_limit) * SMOOTH[2],
        ]
    )


def test_parameters_converge_with_the_square_of_the_grid_step():
    coarse, fine = (
        np.max([np.abs(errors(step, p)) for p in (0.1, 0.3, 0.5, 0.8)], axis=0) for step in (STEP * 2, STEP)
    )
    assert np.all(fine < 1e-3)
    assert np.all(coarse / fine > 3.2)  # second order: 4, up to higher orders


def test_parameters_shift_with_the_curve_by_fractions_of_a_step():
    distance, shift = grid(STEP), 0.37 * STEP
    for shifted in (0.0, shift):
        law = SMOOTH + [0, shifted, 0, 0]
        force = pressure(law, distance)
        # a parabola misplaces the minimum by at most step² |f'''| / 6 f'' = a step² / 2: here 1.5 % of a step
        assert abs(extremum(distance, force)[0] - law[1]) < 0.016 * STEP


def test_minimum_of_a_parabola_is_found_exactly():
    distance = grid(STEP, 20 * NM)
    force = -2e6 + 1e24 * (distance - 8.013 * NM) ** 2
    np.testing.assert_allclose(extremum(distance, force), [8.013 * NM, 2e6], rtol=1e-9)


def test_straight_lines_are_integrated_and_crossed_exactly():
    distance = grid(STEP, 20 * NM)
    corner = 7 * NM  # on a node; a triangular well of depth 2 MPa between 6.03 and 12 nm
    left = -2e6 * (distance - 6.03 * NM) / (corner - 6.03 * NM)
    force = np.where(distance < corner, left, np.minimum(-2e6 * (12 * NM - distance) / (5 * NM), 0.0))
    np.testing.assert_allclose(adhesion_energy(distance, force), 0.5 * 2e6 * 5.97 * NM, rtol=1e-9)
    expected = 6.03 * NM - F_LIMIT / 2e6 * 0.97 * NM
    np.testing.assert_allclose(limit_distance(distance, force, F_LIMIT), expected, rtol=1e-9)


def test_d_limit_is_the_first_crossing_left_of_the_minimum():
    distance = grid(STEP)
    force = pressure(SMOOTH, distance)
    energy_before = adhesion_energy(distance, force)
    d_limit = limit_distance(distance, force, F_LIMIT)
    beyond = distance < d_limit - NM
    force[beyond] = -1e5  # another attractive interval at smaller distances, behind the repulsion
    assert adhesion_energy(distance, force) == energy_before
    assert limit_distance(distance, force, F_LIMIT) == d_limit


def test_f_limit_is_the_deepest_sample_and_d_limit_is_where_each_curve_reaches_it():
    distance, laws = grid(STEP), coefficients(VECTORS, F_LIMIT)
    vectors, f_limit = parametrise(distance, lambda k: pressure(laws[k], distance), 3)
    assert f_limit == vectors[:, 1].max()
    # e and f_max: (a step)² = 1e-3; d_max: the curvature jumps there, so that the error is up to half a step
    np.testing.assert_allclose(vectors[:, :2], VECTORS[:, :2], rtol=2e-3)
    np.testing.assert_allclose(vectors[:, 2], VECTORS[:, 2], atol=0.5 * STEP)
    reached = [pressure(law, d) for law, d in zip(laws, vectors[:, 3], strict=True)]
    np.testing.assert_allclose(reached, f_limit, rtol=2e-3)


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda f: np.abs(f), "nowhere attractive"),
        (lambda f: np.where(f > 0, -1.0, f), "does not rise"),
        (lambda f: np.minimum(f, 1e6), "does not rise"),
        (lambda f: f - 1e4, "has not decayed"),
        (lambda f: np.linspace(1e6, -1e6, f.size), "minimum of the force is at an end"),
        (lambda f: np.full(f.size, np.nan), "nowhere attractive"),
    ],
)
def test_a_curve_that_lacks_a_parameter_is_an_error_with_the_number_of_the_sample(spoil, message):
    distance = grid(STEP)
    force = pressure(SMOOTH, distance)
    deeper = 1.5 * force  # raises f_limit to 3 MPa
    curves = [force, deeper, spoil(force)]
    with pytest.raises(ValueError, match=rf"sample 2: .*({message}).* Pa"):
        parametrise(distance, lambda k: curves[k], 3)


def test_an_error_on_weak_samples_says_which_area_would_do():
    distance = grid(STEP)
    strong = pressure(SMOOTH, distance)
    weak = np.minimum(strong, 1e6)  # less than the largest attraction, 2 MPa
    for curves, times in (([weak, strong] * 4, 2), ([weak, weak, weak, strong] * 2, 4), ([weak] * 4, None)):
        means = np.mean(np.reshape(curves, (-1, times or 4, distance.size)), axis=1)
        if times:
            parametrise(distance, means.__getitem__, len(means))  # what the message promises
        with pytest.raises(ValueError, match="does not rise") as caught:
            parametrise(distance, curves.__getitem__, len(curves))
        said = [f"As far as these samples show, {times} times the area of the patch would do."] if times else []
        assert getattr(caught.value, "__notes__", []) == said


def test_a_minimum_at_the_end_of_the_grid_is_an_error():
    distance = grid(STEP)
    with pytest.raises(ValueError, match="end of its grid"):
        extremum(distance, -np.exp(-distance / NM))


# Sec. III-A: solid contact and film


def film_curve(offset, tension, shift):
    """Curve of a bearing area that falls from 1 to 0 on a line, under a solid pressure that falls to 0 on another."""
    solid = np.linspace(4e6, 0.0, 81)  # zero from 80 steps on
    bearing = np.linspace(1.0, 0.0, 121)  # from -20 to 100 steps
    out = np.empty(300)
    apparent_force(solid, bearing, (0.0, -20 * STEP, offset * STEP), STEP, shift * STEP, tension, out)
    return offset + np.arange(300), out


@pytest.mark.parametrize("offset", [0.0, 7.0, 0.4])
@pytest.mark.parametrize("shift", [0.0, 48.0, 48.27, 150.6])
def test_film_attracts_with_its_tension_times_the_area_at_the_distance_less_its_height(offset, shift):
    d, force = film_curve(offset, 6e7, shift)
    solid = np.interp(d, [0, 80], [4e6, 0])
    area = np.interp(d - shift, [-20, 100], [1, 0])
    np.testing.assert_allclose(force, solid - 6e7 * area, atol=1e-6)


def test_a_film_adds_energy_in_proportion_to_its_tension():
    _, dry = film_curve(0.0, 0.0, 48.3)
    _, wet = film_curve(0.0, 1e7, 48.3)
    _, wetter = film_curve(0.0, 3e7, 48.3)
    np.testing.assert_allclose(wetter - dry, 3 * (wet - dry), atol=1e-6)
    # on and above the grid the film covers 48.3 + 20 - 20 steps fully, then 120 steps by half
    np.testing.assert_allclose(np.sum(wet - dry), -1e7 * (28.3 + 60 + 0.5), rtol=1e-3)


def test_distances_below_the_solid_grid_are_an_error():
    with pytest.raises(ValueError, match="not known"):
        film_curve(-1.0, 6e7, 48.0)


def test_curves_of_a_humidity_run_until_the_film_of_the_highest_point_breaks():
    solid = np.linspace(4e6, 0.0, 81)[None].repeat(2, 0).astype(np.float32)
    bearing = np.linspace(1.0, 0.0, 121)[None].repeat(2, 0).astype(np.float32)
    distance, curve = humid_curves(solid, bearing, (0.0, -20 * STEP), STEP, (48.3 * STEP, 6e7))
    force = curve(1)
    _, expected = film_curve(0.0, 6e7, 48.3)
    np.testing.assert_allclose(force, expected[: force.size], atol=10)  # single precision of 6e7 Pa
    np.testing.assert_allclose(np.diff(distance), STEP)
    assert force[-1] == 0
    assert distance[0] == 0


def test_inputs_in_single_precision_give_the_bits_of_their_copies_in_double_precision():
    stored = [stream(k).random((1, n), np.float32) for k, n in enumerate((81, 121))]
    (_, single), (_, double) = (
        humid_curves(*inputs, (0.0, -20 * STEP), STEP, (48.3 * STEP, 6e7))
        for inputs in (stored, [values.astype(float) for values in stored])
    )
    np.testing.assert_array_equal(single(0), double(0))


def test_energies_of_all_curves_are_the_first_column_of_their_vectors():
    distance, curves = grid(STEP), pressure(coefficients(VECTORS, F_LIMIT)[:, None], grid(STEP))
    vectors, _ = parametrise(distance, lambda k: curves[k], 3)
    np.testing.assert_array_equal(adhesion_energies(distance, lambda k: curves[k], 3), vectors[:, 0])


# Quality of the fit


def errors_of(curves, samples=(0, 1, 2)):
    return fit_errors(grid(STEP), lambda k: curves[k], samples, VECTORS[list(samples)], F_LIMIT)


def test_law_of_eq_12_fits_itself_and_keeps_the_energy():
    curve_error, energy_error = errors_of(pressure(coefficients(VECTORS, F_LIMIT)[:, None], grid(STEP)))
    np.testing.assert_array_equal(curve_error, 0)
    assert np.all(energy_error < 1e-14)


def test_error_of_a_curve_is_relative_to_the_curve_whatever_the_length_of_its_tail():
    laws = pressure(coefficients(VECTORS, F_LIMIT)[:, None], grid(STEP))
    np.testing.assert_allclose(errors_of(1.25 * laws)[0], 0.25 / 1.25)
    short = grid(STEP, 30 * NM)
    shorter, _ = fit_errors(short, lambda k: 1.25 * laws[k, : len(short)], (2,), VECTORS[[2]], F_LIMIT)
    np.testing.assert_allclose(shorter, 0.2, rtol=1e-6)


def test_fit_error_includes_only_distances_beyond_d_limit():
    laws = pressure(coefficients(VECTORS, F_LIMIT)[:, None], grid(STEP))
    stiffer = np.where(grid(STEP) < VECTORS[:, 3:], 2 * laws, laws)
    np.testing.assert_array_equal(errors_of(stiffer)[0], 0)
    softer = np.where(grid(STEP) < VECTORS[:, 3:] + STEP, 2 * laws, laws)
    assert np.all(errors_of(softer)[0] > 0)


def test_every_vector_is_compared_with_the_curve_of_its_sample():
    laws = pressure(coefficients(VECTORS, F_LIMIT)[:, None], grid(STEP))
    np.testing.assert_array_equal(errors_of(laws, (2, 0))[0], 0)
    assert errors_of(laws[[1, 1, 1]], (2,))[0] > 0.1


# Samples whose summits do not resist the adhesion


FLAT = 20e-3, 30e6  # bounds of e and f_max of any surfaces


def test_samples_that_do_not_resist_have_the_energy_and_pull_off_of_flat_surfaces():
    distance = grid(STEP)
    strong = pressure(SMOOTH, distance)
    pressed = np.minimum(strong, -1e5)
    curves = [strong, pressed, strong]
    alone, limit = parametrise(distance, [strong, strong].__getitem__, 2)
    vectors, f_limit = parametrise(distance, curves.__getitem__, 3, None, FLAT)
    np.testing.assert_array_equal(vectors[[0, 2]], alone)
    assert f_limit == limit  # flat surfaces do not move the threshold of the others
    np.testing.assert_array_equal(vectors[1, :2], FLAT)
    law = coefficients(vectors, f_limit)[1]
    assert law[0] == FLAT[1]
    np.testing.assert_allclose(energy(law), FLAT[0], rtol=1e-12)
    np.testing.assert_allclose(pressure(law, vectors[1, 3]), f_limit, rtol=1e-9)
    np.testing.assert_array_equal(adhesion_energies(distance, curves.__getitem__, 3, None, FLAT), vectors[:, 0])
    np.testing.assert_array_equal(pull_offs(distance, curves.__getitem__, 3, FLAT), vectors[:, 1])
    assert share_flat(curves.__getitem__, 3) == 1 / 3
    with pytest.raises(ValueError, match="sample 1"):
        parametrise(distance, curves.__getitem__, 3)


def test_a_curve_that_ends_below_f_limit_has_the_law_of_a_longer_one():
    distance = grid(STEP)
    law = coefficients(np.array([[7e-3, 2e6, 8e-9, 6.5e-9]]), 3e6)[0]
    whole, deeper = pressure(law, distance), 1.5 * pressure(law, distance)
    cut = np.minimum(whole, 1e6)
    (_, short), limit = parametrise(distance, [deeper, cut].__getitem__, 2, None, FLAT)
    (_, long), _ = parametrise(distance, [deeper, whole].__getitem__, 2)
    np.testing.assert_allclose(short, long, rtol=2e-3)  # of the parabola through the nodes
    assert limit > 1e6


def test_where_no_sample_resists_all_are_flat():
    distance = grid(STEP)
    vectors, limit = parametrise(distance, lambda _: -np.exp(-distance / NM), 2, None, FLAT)
    np.testing.assert_array_equal(vectors[:, :2], [FLAT] * 2)
    assert limit == FLAT[1]
    assert np.all(admissible(vectors, limit))
