import time
import tracemalloc

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.integrate import quad

from stiction.constants import HAMAKER_CONSTANT
from stiction.contact import gaps
from stiction.contact.gaps import RETARDATION, FlatAttraction, gap_pressures, work_across_film
from stiction.contact.pair import bearing_area
from stiction.contact.vanderwaals import DugdaleAttraction, attraction
from stiction.streams import stream

NM = 1e-9
STEP = 0.05 * NM
AIR, WATER = (FlatAttraction(HAMAKER_CONSTANT[medium], 100 * NM) for medium in ("dry", "water"))
AT_REST = attraction("dry").equilibrium_distance


def of_heights(heights, distance, work):
    """Pressure [Pa] and work beyond the last distance [J/m²] of a map of heights [m], from its bearing area."""
    below, above = (int(np.ceil(end / STEP)) + 1 for end in (-heights.min(), heights.max()))
    area = bearing_area(heights, STEP, below, above + 1)
    pressure, beyond = gap_pressures(area[None].astype(np.float32), -below * STEP, distance, STEP, work)
    return pressure[0], beyond[0]


# Two flats


@pytest.mark.parametrize("medium", ["water", "dry"])
@pytest.mark.parametrize("wavelength", [np.inf, 100 * NM, 1 * NM])
def test_flats_that_touch_need_the_work_of_eq_10_and_the_attraction_alone_would_need_a_third_more(medium, wavelength):
    flats = FlatAttraction(HAMAKER_CONSTANT[medium], wavelength)
    assert_allclose(flats.work(0.0), attraction(medium).work_of_adhesion, rtol=1e-14)
    without_repulsion = flats.hamaker_constant / (12 * np.pi * AT_REST**2)
    assert_allclose(without_repulsion, 4 / 3 * flats.work(0.0), rtol=1e-14)


def test_pressure_of_flats_is_that_of_lennard_jones():
    flats, gaps = FlatAttraction(HAMAKER_CONSTANT["dry"]), np.array([0.0, 0.02, 0.1, 1, 10]) * NM
    slope = (flats.work(gaps + 1e-15) - flats.work(gaps - 1e-15)) / 2e-15
    distance = AT_REST + gaps
    expected = -flats.hamaker_constant / (6 * np.pi) * (distance**-3 - AT_REST**6 / distance**9)
    assert_allclose(slope, expected, rtol=1e-6, atol=1e3)
    tension = -np.gradient(flats.work(np.linspace(0, 0.2, 20_001) * NM), 1e-5 * NM)
    assert_allclose(tension.max(), flats.largest_pressure, rtol=1e-6)


def test_summits_and_gaps_together_do_the_work_of_eq_10_on_flats():
    flat, counted = np.zeros((8, 8), np.float32), attraction("water")
    distance = STEP * np.arange(1, 2000)
    pressure, beyond = of_heights(flat, distance, lambda gap: WATER.work(gap) - counted.work(gap))
    ends = WATER.work(STEP / 2) - counted.work(STEP / 2)  # heights of a cell are spread over it
    # The rule of the trapezoid: the pressure is that of a whole step.
    done = -np.sum(pressure[1:] + pressure[:-1]) * STEP / 2 + beyond
    assert abs(done - ends) < 0.03 * counted.work_of_adhesion
    uncorrected, _ = of_heights(flat, distance, WATER.work)
    assert -np.sum(uncorrected) * STEP > 0.5 * counted.work_of_adhesion


def test_a_spacer_shifts_the_gaps():
    coated = FlatAttraction(HAMAKER_CONSTANT["dry"], 100 * NM, spacer=2.5 * NM)
    gaps = np.linspace(0, 30, 50) * NM
    assert_allclose(coated.work(gaps), AIR.work(gaps + 2.5 * NM), rtol=1e-14)


@given(st.floats(0.3, 20))
def test_summits_with_coatings_have_the_tangent_of_the_work_of_flats_so_that_nothing_counts_twice(spacer):
    """Nothing is left for gaps where coatings touch, and nowhere less; the stress of bare solids would leave less."""
    flats, counted = FlatAttraction(1e-19, spacer=spacer * NM), DugdaleAttraction(1e-19, spacer * NM)
    gaps = np.linspace(0, 4 * spacer, 400) * NM
    left = flats.work(gaps) - counted.work(gaps)
    assert_allclose(left[0], 0, atol=1e-14 * counted.work_of_adhesion)
    assert np.all(left >= -2e-3 * counted.work_of_adhesion)
    bare = DugdaleAttraction(1e-19)
    assert np.min(flats.work(gaps) - bare.work(gaps)) < -0.1 * bare.work_of_adhesion


# Retardation


def test_attraction_is_that_of_hamaker_at_small_gaps_and_falls_with_the_third_power_at_large_ones():
    """Casimir: flats at gaps far beyond the wavelength have the energy ~ 1 / D³, and that of Hamaker is ~ 1 / D²."""
    far, near = FlatAttraction(1e-19, 1 * NM), FlatAttraction(1e-19, 1.0)
    assert_allclose(far.work(1e-5), 1e-19 * NM / (12 * np.pi * RETARDATION * 1e-15), rtol=1e-3)
    assert_allclose(near.work(10 * NM), 1e-19 / (12 * np.pi * (10 * NM + AT_REST) ** 2), rtol=1e-6)
    assert_allclose(FlatAttraction(1e-19).work(10 * NM), near.work(10 * NM), rtol=1e-6)
    assert far.work(10 * NM) < 0.1 * near.work(10 * NM)


def casimir_polder(distance):
    """Attraction of two molecules with one frequency of absorption, over that of London; distance [wavelengths]."""
    k = 2 * np.pi * distance

    def at(u):
        x = u * k
        return np.exp(-2 * x) * (x**4 + 2 * x**3 + 5 * x**2 + 6 * x + 3) / (1 + u**2) ** 2

    return quad(at, 0, np.inf)[0] / (3 * np.pi / 4)


@pytest.mark.parametrize("gap", [0.01, 0.05, 0.1, 0.2, 0.5, 1.0])
def test_retarded_flats_are_retarded_molecules_added_up(gap):
    """Pairs with w(r) in two half spaces have the energy ∫ w(r) r (r - D)² dr from D, up to a factor.

    Gregory's factor is within 9 % of Casimir and Polder for gaps up to the wavelength; his logarithm, which is that of
    a sphere, would be up to 44 % too small.
    """
    added = quad(lambda s: casimir_polder(gap / s) * (1 - s) ** 2 * s, 0, 1, epsrel=1e-5)[0] * 12
    x = RETARDATION * gap
    assert_allclose(1 / (1 + x), added, rtol=0.09)
    assert abs((1 - x * np.log(1 + 1 / x)) / added - 1) > 0.14


def test_energy_of_a_sphere_is_the_logarithm_of_gregory():
    """The integral over the gap, 2πR ∫ U dg, is -ℌ R / (6 g) [1 - x ln(1 + 1/x)] with x = b g / λ."""
    for gap in (2 * NM, 20 * NM, 200 * NM):
        energy = quad(lambda s, start=gap: AIR.work(start / s) * start / s**2, 0, 1, epsrel=1e-10)[0]
        x = RETARDATION * gap / (100 * NM)
        expected = AIR.hamaker_constant / (12 * np.pi * gap) * (1 - x * np.log(1 + 1 / x))
        assert_allclose(energy, expected, rtol=2 * AT_REST / gap)


# Water and air


def test_a_film_that_vanishes_leaves_dry_air_and_one_that_fills_everything_leaves_water():
    gaps = np.linspace(0, 20, 100) * NM
    assert_allclose(work_across_film(gaps, 0.0, WATER, AIR), AIR.work(gaps), rtol=1e-14)
    everywhere = work_across_film(gaps, 1e-3, WATER, AIR)
    assert_allclose(everywhere, WATER.work(gaps), atol=1e-6 * WATER.work(0.0))
    assert AIR.work(0.0) > 1.9 * everywhere[0]  # the two limits differ


def test_flats_in_a_film_need_the_work_through_water_up_to_its_height_and_through_air_beyond():
    height = 2 * NM
    expected = WATER.work(0.0) - WATER.work(height) + AIR.work(height)
    assert_allclose(work_across_film(0.0, height, WATER, AIR), expected, rtol=1e-14)
    before, after = (float(work_across_film(height + shift, height, WATER, AIR)) for shift in (-1e-18, 1e-18))
    assert_allclose(before, after, rtol=1e-6)


# Rough surfaces


def sphere(radius, top):
    """Bearing area times its area [m²] of a paraboloid below the height of its top, from -200 nm, and first height."""
    heights = -200 * NM + STEP * np.arange(round((200 * NM + top) / STEP) + 1)
    return 2 * np.pi * radius * (top - heights), heights[0]


@pytest.mark.parametrize("gap", [3 * NM, 10 * NM])
def test_far_sphere_is_attracted_with_the_force_of_hamaker(gap):
    """-ℌ R / (6 D²); the sphere ends 200 nm below its top, where flats have 1 / 200² of this."""
    radius, flats = 400 * NM, FlatAttraction(HAMAKER_CONSTANT["dry"])
    area, first = sphere(radius, 5 * NM)
    force = gap_pressures(area[None], first, np.array([5 * NM + gap]), STEP, flats.work)[0][0, 0]
    cut = (gap / (200 * NM)) ** 2
    assert_allclose(force, -flats.hamaker_constant * radius / (6 * (gap + AT_REST) ** 2), rtol=1.2 * cut + 1e-4)
    assert abs(force / (-flats.hamaker_constant * radius / (6 * (gap - AT_REST) ** 2)) - 1) > 0.02


@pytest.mark.parametrize("spacer", [0, 2.4 * NM])
@pytest.mark.parametrize("medium", ["water", "dry"])
def test_touching_sphere_has_the_pull_off_of_derjaguin_muller_and_toporov(medium, spacer):
    """2πRω: that of the Dugdale stress, to which the gaps add nothing, and without the correction far too much."""
    counted = attraction(medium, spacer=spacer)
    radius, flats = 400 * NM, FlatAttraction(HAMAKER_CONSTANT[medium], spacer=spacer)
    area, first = sphere(radius, 5 * NM)
    at = np.array([5 * NM])
    pull = 2 * np.pi * radius * counted.work_of_adhesion
    added = gap_pressures(area[None], first, at, STEP, lambda gap: flats.work(gap) - counted.work(gap))[0][0, 0]
    cut = (spacer / (200 * NM)) ** 2  # the sphere ends 200 nm below its top
    assert abs(added) < (1e-4 + cut) * pull
    twice = gap_pressures(area[None], first, at, STEP, flats.work)[0][0, 0]
    assert_allclose(twice, -pull, rtol=1e-4 + 1.2 * cut)


def test_energy_of_slightly_rough_surfaces_is_inverse_to_the_square_of_the_distance():
    """⟨(D - z)⁻²⟩ = D⁻² (1 + 3σ²/D²) of heights with the standard deviation σ, to the order of (σ/D)⁴."""
    rms, flats = 0.5 * NM, FlatAttraction(HAMAKER_CONSTANT["dry"])
    heights = (rms * stream(0, "gaps").standard_normal((600, 600))).astype(np.float32)
    for distance in (8 * NM, 16 * NM):
        _, energy = of_heights(heights, np.array([distance]), flats.work)
        smooth = flats.hamaker_constant / (12 * np.pi * (distance + AT_REST) ** 2)
        order = (rms / (distance + AT_REST)) ** 2
        assert_allclose(energy / smooth, 1 + 3 * order, rtol=20 * order**2 + 3e-4)
    assert abs(energy / smooth * (16 / 8) ** 2 - 1) > 1  # one over the distance to another power


@pytest.mark.parametrize("flats", [AIR, FlatAttraction(HAMAKER_CONSTANT["dry"], 100 * NM, spacer=2.4 * NM)])
def test_bearing_area_gives_the_pressure_of_the_map_point_by_point(flats):
    rng = stream(1, "gaps")
    heights = (3 * NM * rng.standard_normal((400, 400))).astype(np.float32)
    distance = heights.max() + np.array([2, 5, 10]) * NM  # nearer, the few highest points are spread over their step
    pressure = np.concatenate([of_heights(heights, at, flats.work)[0] for at in distance[:, None]])
    half = 0.01 * NM
    gaps = distance[:, None, None] - heights.astype(float)
    one_by_one = np.mean(flats.work(gaps + half) - flats.work(gaps - half), axis=(1, 2)) / (2 * half)
    assert_allclose(pressure, one_by_one, rtol=1e-4)
    mean_plane = (flats.work(distance + half) - flats.work(distance - half)) / (2 * half)
    assert np.all(pressure < 1.1 * mean_plane)  # roughness attracts more: its mean plane alone is not enough


def test_points_that_the_flat_has_passed_attract_nothing():
    heights = np.zeros((20, 20), np.float32)
    heights[:10] = 30 * NM
    half, _ = of_heights(heights, np.array([5 * NM]), AIR.work)
    flat, _ = of_heights(np.zeros((20, 20), np.float32), np.array([5 * NM]), AIR.work)
    assert_allclose(half, 0.5 * flat, rtol=1e-6)


@given(st.floats(0, 5), st.floats(0.1, 5), st.floats(1.1, 3))
def test_attraction_grows_with_the_hamaker_constant_and_falls_with_gap_spacer_and_retardation(gap, more, factor):
    gap = gap * NM

    def work(gap=gap, constant=1e-19, wavelength=100 * NM, spacer=1 * NM):
        return FlatAttraction(constant, wavelength, spacer).work(gap)

    assert work(gap + more * NM) < work() < work(wavelength=np.inf)
    assert work(spacer=(1 + more) * NM) < work() < work(constant=1e-19 * factor)
    assert_allclose(work(constant=1e-19 * factor), factor * work(), rtol=1e-12)


def test_attraction_grows_with_the_roughness_at_the_same_distance():
    shape = stream(2, "gaps").standard_normal((300, 300)).astype(np.float32)
    energies = [of_heights(np.float32(rms * NM) * shape, np.array([20 * NM]), AIR.work)[1] for rms in (0.1, 1, 2, 3)]
    assert np.all(np.diff(energies) > 0)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"wavelength": 0.0}, "wavelength of the retardation must be positive, got 0 m"),
        ({"wavelength": np.nan}, "wavelength of the retardation must be positive, got nan m"),
        ({"spacer": -1e-9}, "thickness of a coating must not be negative, got -1e-09 m"),
    ],
)
def test_impossible_attraction_is_refused(wrong, message):
    with pytest.raises(ValueError, match=message):
        FlatAttraction(1e-19, **wrong)


# Cost


def areas(steps, samples=3):
    """Bearing areas of samples on a number of steps."""
    return np.sort(stream(2, "gaps").random((samples, steps + 1)), axis=1)[:, ::-1].astype(np.float32)


def test_pressures_do_not_depend_on_how_many_are_convolved_at_once(monkeypatch):
    arguments = areas(500), -250 * STEP, STEP * np.arange(300), STEP, AIR.work
    whole, beyond = gap_pressures(*arguments)
    monkeypatch.setattr(gaps, "_BLOCK", 1)
    parts, the_same = gap_pressures(*arguments)
    assert_allclose(parts, whole, rtol=1e-6)
    assert_allclose(the_same, beyond, rtol=1e-12)


def test_pressures_are_the_sum_over_the_bearing_area_however_small_they_are():
    """Direct sums, also far from the summits, where pressures are 1e-9 of those where the flat passes them."""
    first, distance = -250 * STEP, 200 * NM + STEP * np.arange(-3990, 50)
    area = areas(500)
    pressure, _ = gap_pressures(area, first, distance, STEP, AIR.work)
    needed = AIR.work(np.maximum(distance[:, None] - first - STEP * np.arange(501), 0.0))
    direct = np.diff(needed, axis=1) / STEP @ np.diff(area.astype(float), axis=1).T
    assert np.abs(direct[-1]).max() < 1e-4 * np.abs(direct).max()
    assert_allclose(pressure, direct.T, rtol=1e-6)


def test_memory_beyond_the_pressures_is_that_of_a_block_of_samples(monkeypatch):
    monkeypatch.setattr(gaps, "_BLOCK", 2**14)
    peaks = []
    for samples in (32, 256):
        arguments = areas(2**10, samples), -(2**9) * STEP, STEP * np.arange(2**9), STEP, AIR.work
        tracemalloc.start()
        pressure, _ = gap_pressures(*arguments)
        peaks.append(tracemalloc.get_traced_memory()[1] - pressure.nbytes)
        tracemalloc.stop()
    assert peaks[1] < 1.1 * peaks[0]


def test_time_of_rough_surfaces_does_not_grow_with_the_square_of_their_heights():
    """Sixteen times the points take 16 times the time and a little more; sums over all pairs would take 256 times."""
    times = []
    for steps in (2**11, 2**15):
        arguments = areas(steps), -steps / 2 * STEP, STEP * np.arange(steps // 2), STEP, AIR.work
        times.append(min(timed(gap_pressures, arguments) for _ in range(3)))
    assert times[1] < 64 * times[0]


def timed(function, arguments):
    """Processor time of a call [s]."""
    start = time.process_time()
    function(*arguments)
    return time.process_time() - start


def test_distances_of_another_step_are_refused():
    for distance in (STEP * np.arange(3) * 2, STEP * np.array([0, 1, 3])):
        with pytest.raises(ValueError, match="distances must be 5e-11 m apart"):
            gap_pressures(areas(10), 0.0, distance, STEP, AIR.work)
