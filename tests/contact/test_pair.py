import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from published import IDENTITY, SPACING, SURFACES, streams
from scipy.stats import norm
from standard_errors import ALLOWED, errors_off

from stiction.contact.asperity import HertzAsperity, MaugisTable, hertz_force, reduced_modulus
from stiction.contact.pair import DistanceGrid, SurfacePair, bearing_area, contacts_of_samples
from stiction.contact.vanderwaals import attraction
from stiction.streams import stream
from stiction.surface import maxent
from stiction.surface.field import StripGrid
from stiction.surface.summits import find_summits
from stiction.surface.translation import Translation

POLYSILICON = reduced_modulus(164e9, 0.23)
WATER, NONE = MaugisTable(POLYSILICON, attraction("water")), HertzAsperity(POLYSILICON)
STRIP = StripGrid(0.6e-6, 0.8e-6, SPACING, margin=0.2e-6)
STEP = 0.05e-9
PAIR = SurfacePair(SURFACES["B1"].on(STRIP), SURFACES["Sub1"].on(STRIP), STEP, asperity=WATER)
HERTZ = dataclasses.replace(PAIR, asperity=NONE)
#: The table interpolates between rows of λ: error of 1.5 % of the force scale πwR at first contact, 1e-4 of a
#: large load.
TABLE, TABLE_DEEP = 0.015, 1e-4


def rough(number=0, pair=PAIR):
    return pair.draw(*streams(number))


def spheres(*tops, radius=3e-7, shape=(61, 61), spacing=SPACING):
    """Flat far below, with spherical caps (paraboloids) at places (i, j) of these heights [m]."""
    i, j = (np.arange(n) * spacing for n in shape)
    caps = [z - ((i[:, None] - i[a]) ** 2 + (j - j[b]) ** 2) / (2 * radius) for a, b, z in tops]
    return np.max(caps, axis=0).astype(np.float32)


def area_inside(heights, spacing=SPACING):
    """Area of the points with eight neighbours, which can be summits [m²]."""
    return (heights.shape[0] - 2) * (heights.shape[1] - 2) * spacing**2


def force_scale(radius):
    return np.pi * WATER.attraction.work_of_adhesion * radius


def next_to_snap_off(forces):
    """Mask of the distances, last axis, at which a sphere snaps off: in the table this may be one step off."""
    snaps = np.diff((forces != 0).astype(int), append=0) != 0
    early, late = np.roll(snaps, -1, axis=-1), np.roll(snaps, 1, axis=-1)
    return np.any(np.atleast_2d(snaps | early | late), axis=0)


@pytest.mark.parametrize("radius", [3e-8, 3e-7, 3e-6])
def test_one_spherical_bump_without_attraction_is_hertz(radius):
    z = spheres((30, 30, 5e-9), radius=radius)
    pressure, _ = HERTZ.contact(z)
    overlap = float(z.max()) - HERTZ.distances.solid
    # The curvature is a difference of heights, which are accurate to 2⁻²⁴ of 5 nm.
    rounding = 2 * 5e-9 * 2.0**-24 * radius / SPACING**2
    np.testing.assert_allclose(
        pressure * area_inside(z), hertz_force(overlap, radius, POLYSILICON), rtol=1e-9 + rounding
    )


@pytest.mark.parametrize("radius", [3e-8, 1e-7, 3e-7, 1e-6, 3e-6])
def test_one_spherical_bump_with_attraction_is_maugis(radius):
    z = spheres((30, 30, 5e-9), radius=radius)
    force = PAIR.contact(z)[0] * area_inside(z)
    exact = WATER.force(float(z.max()) - PAIR.distances.solid, radius)
    allowed = TABLE * force_scale(radius) * (exact != 0) + TABLE_DEEP * np.abs(exact)
    assert np.all((np.abs(force - exact) <= allowed)[~next_to_snap_off(exact)])
    assert -force.min() > 1.4 * force_scale(radius)


@pytest.mark.parametrize(("top", "carries"), [(-STEP, False), (STEP, True)])
def test_only_a_summit_above_the_mean_plane_carries(top, carries):
    assert np.any(PAIR.contact(spheres((30, 30, top)))[0]) == carries


def test_two_bumps_carry_the_sum_of_their_forces():
    both = spheres((15, 15, 5e-9), (45, 40, 3e-9), radius=1e-7)
    alone = [spheres(top, radius=1e-7) for top in ((15, 15, 5e-9), (45, 40, 3e-9))]
    for pair in (PAIR, HERTZ):
        np.testing.assert_allclose(
            pair.contact(both)[0],
            sum(pair.contact(z)[0] for z in alone),
            rtol=1e-5,
            atol=1e-9 * pair.contact(both)[0].max(),
        )


def test_hertz_pressure_of_a_rough_surface_is_the_plain_sum_over_its_summits():
    z = rough()
    height, curvature, _ = find_summits(z, SPACING)
    overlap = height[:, None] - HERTZ.distances.solid
    plain = np.sum(hertz_force(overlap, 1 / curvature[:, None], POLYSILICON), axis=0) / area_inside(z)
    np.testing.assert_allclose(HERTZ.contact(z)[0], plain, rtol=1e-9, atol=1e-9)


def test_maugis_pressure_of_a_rough_surface_is_the_plain_sum_over_its_summits():
    z = rough()
    height, curvature, _ = find_summits(z, SPACING)
    assert len(height) > 20
    distance = PAIR.distances.solid
    forces = np.array([WATER.force(h - distance, 1 / k) for h, k in zip(height, curvature, strict=True)])
    error = np.abs(PAIR.contact(z)[0] * area_inside(z) - forces.sum(axis=0))
    allowed = TABLE * force_scale(1 / curvature) @ (forces != 0) + TABLE_DEEP * np.abs(forces).sum(axis=0)
    assert np.all((error <= allowed)[~next_to_snap_off(forces)])
    assert np.sum(~next_to_snap_off(forces)) > 100
    assert np.abs(forces).sum(axis=0).max() > 100 * allowed.max()


def test_hertz_pressure_falls_with_the_distance_and_ends_at_the_highest_summit():
    z = rough()
    pressure, _ = HERTZ.contact(z)
    assert np.all(np.diff(pressure) <= 0)
    highest = find_summits(z, SPACING)[0].max()
    distance = HERTZ.distances.solid
    assert np.all(pressure[distance < highest] > 0)
    assert np.all(pressure[distance > highest] == 0)


def test_attraction_lowers_the_pressure_and_has_a_longer_range_than_elasticity():
    z = rough()
    adhesive, elastic = PAIR.contact(z)[0], HERTZ.contact(z)[0]
    assert np.all(adhesive[elastic > 0] < elastic[elastic > 0])
    beyond = PAIR.distances.solid > find_summits(z, SPACING)[0].max()
    assert adhesive[beyond].min() < 0
    assert np.all(adhesive[PAIR.distances.solid > z.max() + 1e-9] == 0)


@given(st.floats(0.1, 10))
@settings(max_examples=10)
def test_hertz_pressure_is_proportional_to_the_modulus(factor):
    stiffer = dataclasses.replace(HERTZ, asperity=HertzAsperity(factor * POLYSILICON))
    z = rough()
    np.testing.assert_allclose(stiffer.contact(z)[0], factor * HERTZ.contact(z)[0], rtol=1e-12)


@pytest.mark.parametrize("pair", [PAIR, HERTZ], ids=["Maugis", "Hertz"])
def test_lifting_the_surface_by_some_steps_shifts_both_curves_by_these_steps(pair):
    z, steps = rough(), 40
    pressure, area = pair.contact(z)
    lifted_pressure, lifted_area = pair.contact(z + np.float32(steps * STEP))
    scale = np.abs(pressure).max()
    # Summits just below the mean plane attract a flat at distances > 0 only: leave out the range of the attraction.
    np.testing.assert_allclose(lifted_pressure[steps + 10 :], pressure[10:-steps], rtol=1e-4, atol=1e-5 * scale)
    np.testing.assert_allclose(
        lifted_area[steps:], area[:-steps], atol=2 / z.size
    )  # a point on a step may fall on either side


@pytest.mark.parametrize("pair", [PAIR, HERTZ], ids=["Maugis", "Hertz"])
def test_rotating_the_pair_changes_nothing(pair):
    z = rough()
    for one, other in zip(pair.contact(z), pair.contact(np.ascontiguousarray(z.T)), strict=True):
        np.testing.assert_allclose(other, one, rtol=1e-9, atol=1e-9 * np.abs(one).max())


@pytest.mark.parametrize("pair", [PAIR, HERTZ], ids=["Maugis", "Hertz"])
def test_finer_steps_of_the_distance_add_points_and_change_none(pair):
    z = rough()
    finer = dataclasses.replace(pair, step=STEP / 2)
    coarse, fine = pair.contact(z)[0], finer.contact(z)[0][::2]
    n = min(len(coarse), len(fine))
    np.testing.assert_allclose(fine[:n], coarse[:n], rtol=1e-9, atol=1e-9 * np.abs(coarse).max())


def test_every_other_point_is_the_same_contact_on_a_coarser_grid():
    halved = dataclasses.replace(PAIR, every=2)
    z = rough()
    np.testing.assert_array_equal(rough(pair=halved), z[::2, ::2])
    fine, coarse = spheres((30, 30, 5e-9)), spheres((15, 15, 5e-9), shape=(31, 31), spacing=2 * SPACING)
    forces = PAIR.contact(fine)[0] * area_inside(fine), halved.contact(coarse)[0] * area_inside(coarse, 2 * SPACING)
    np.testing.assert_allclose(forces[1], forces[0], rtol=1e-4, atol=1e-4 * force_scale(3e-7))


@pytest.mark.parametrize("modulus", [POLYSILICON, 1e7, 4e11])
@pytest.mark.parametrize("top", [5e-9, 2e-7])
def test_one_bump_of_any_solid_is_the_exact_solution_however_deep(modulus, top):
    pair = dataclasses.replace(PAIR, asperity=MaugisTable(modulus, attraction("water")))
    z = spheres((30, 30, top))
    pressure, _ = pair.contact(z)
    overlap = float(z.max()) - pair.distances.solid
    exact = pair.asperity.force(overlap, 3e-7)
    found = pressure * area_inside(z)
    clear = ~next_to_snap_off(np.array([exact]))
    np.testing.assert_allclose(found[clear], exact[clear], rtol=3e-4, atol=TABLE * force_scale(3e-7))


@pytest.mark.parametrize("rms", [35e-9, 80e-9])
@pytest.mark.parametrize("constant", [attraction("water").hamaker_constant, 1e-22], ids=["strong", "weak"])
def test_rough_surfaces_have_a_contact_with_strong_and_with_weak_attraction(rms, constant):
    beam = dataclasses.replace(PAIR.beam, rms=rms)
    solid = MaugisTable(POLYSILICON, attraction("water", constant))
    (pressure,), (area,) = contacts_of_samples(
        [dataclasses.replace(PAIR, beam=beam, step=1e-9, asperity=solid)], streams, [0]
    )[0]
    hertz, _ = contacts_of_samples([dataclasses.replace(PAIR, beam=beam, step=1e-9, asperity=NONE)], streams, [0])[0]
    assert np.all(np.diff(area) <= 0)
    np.testing.assert_allclose(pressure[0], hertz[0, 0], rtol=0.05)
    assert np.all(pressure <= 1.0001 * hertz[0] + 1)


@given(arrays.arrays(np.float32, (6, 7), elements=st.integers(-7000, 6000).map(lambda k: k * 1e-12)))
def test_bearing_area_is_the_count_of_higher_points(heights):
    below, above = 60, 50
    distance = 1e-10 * np.arange(-below, above)
    found = bearing_area(heights, 1e-10, below, above)
    # Points within single precision of a distance may be counted or not.
    slack = 1e-15
    least = np.mean(heights[..., None] > distance + slack, axis=(0, 1))
    most = np.mean(heights[..., None] > distance - slack, axis=(0, 1))
    assert np.all((least - 1e-12 <= found) & (found <= most + 1e-12))


def test_bearing_area_of_a_flat_is_one_below_it_and_zero_above():
    flat = np.full((20, 20), 1.02e-9, np.float32)
    pressure, area = PAIR.contact(flat)
    np.testing.assert_array_equal(area, PAIR.distances.bearing < 1.02e-9)
    np.testing.assert_array_equal(pressure, 0)  # no summit


def test_bearing_area_of_a_ramp_falls_linearly():
    ramp = np.linspace(-2e-9, 2e-9, 40_001, dtype=np.float32).reshape(1, -1)
    area = bearing_area(ramp, 1e-10, 30, 30)
    distance = 1e-10 * np.arange(-30, 30)
    np.testing.assert_allclose(area, np.clip(0.5 - distance / 4e-9, 0, 1), atol=1e-4)


def test_bearing_area_of_a_rough_surface_falls_from_one_to_zero():
    _, area = PAIR.contact(rough())
    assert area[0] == 1
    assert area[-1] == 0
    assert np.all(np.diff(area) <= 0)


def test_integral_of_the_bearing_area_is_the_mean_height_above_the_lowest_distance():
    z = rough()
    grid = PAIR.distances
    _, area = PAIR.contact(z)
    # Every point counts at one distance more than the steps below it: half a step on average.
    mean = STEP * area.sum() + grid.bearing[0] - STEP / 2
    spread = STEP / np.sqrt(12 * z.size)
    np.testing.assert_allclose(mean, z.mean(dtype=float), rtol=0, atol=4 * spread)


def test_mean_bearing_area_is_the_upper_tail_of_the_height_density_with_a_control_that_fails():
    surface = SURFACES["Sub2"]
    polished = dataclasses.replace(SURFACES["Sub1"].on(STRIP), rms=1e-15)
    pair = SurfacePair(surface.on(STRIP), polished, STEP, asperity=NONE)
    places = pair.distances.below + np.array([-100, 0, 100, 200])
    areas = np.array([pair.contact(rough(k, pair))[1][places] for k in range(100)])
    scores = np.linspace(-8, 8, 160_001)
    share = norm.pdf(scores) * (scores[1] - scores[0])
    tail = [share @ (surface.translation(scores) > d / surface.rms) for d in pair.distances.bearing[places]]
    assert errors_off(areas, tail) < ALLOWED
    assert errors_off(areas, norm.sf(pair.distances.bearing[places] / surface.rms)) > ALLOWED


def test_distances_cover_the_surface_on_both_sides_and_contain_zero():
    grid = DistanceGrid.covering(-16e-9, 15e-9, 0.4e-9)
    assert grid.bearing[grid.below] == 0
    assert grid.bearing[0] <= -16e-9 < grid.bearing[1]
    assert grid.bearing[-2] < 15e-9 <= grid.bearing[-1]
    np.testing.assert_array_equal(grid.solid, grid.bearing[grid.below :])
    np.testing.assert_allclose(np.diff(grid.bearing), 0.4e-9, rtol=1e-9)


def test_distances_cover_all_heights_of_a_surface_with_a_long_upper_tail():
    mirrored = Translation(maxent.solve(0.78, 4.6))
    beam = dataclasses.replace(SURFACES["B1"].on(STRIP), translation=mirrored)
    pair = dataclasses.replace(PAIR, beam=beam)
    highest = max(rough(k, pair).max() for k in range(40))
    assert highest > 7 * beam.rms  # the end of a grid for Gaussian surfaces
    assert pair.distances.solid[-1] > highest
    _, area = pair.contact(rough(0, pair))
    assert area[0] == 1
    assert area[-1] == 0


def test_mean_pressure_does_not_depend_on_the_size_of_the_strip_with_a_control_that_fails():
    narrow = dataclasses.replace(STRIP, length=5 * SPACING)
    pairs = PAIR, dataclasses.replace(PAIR, beam=SURFACES["B1"].on(narrow), substrate=SURFACES["Sub1"].on(narrow))
    place = PAIR.distances.solid.searchsorted(1e-9)
    wide, slim = (
        np.array([pair.contact(rough(k, pair))[0][place] for k in range(samples)])
        for pair, samples in zip(pairs, (100, 1200), strict=True)
    )
    error = np.hypot(*(x.std(ddof=1) / np.sqrt(len(x)) for x in (wide, slim)))
    assert abs(wide.mean() - slim.mean()) < ALLOWED * error
    inside = area_inside(rough(0, pairs[1])) / (narrow.shape[0] * narrow.shape[1] * SPACING**2)
    assert wide.mean() - slim.mean() * inside > ALLOWED * error


def test_equivalent_surface_is_the_sum_of_the_two_surfaces():
    z = rough()
    parts = PAIR.beam.draw(stream(2021, "beam", 0)) + PAIR.substrate.draw(stream(2021, "substrate", 0))
    np.testing.assert_allclose(z, parts, rtol=0, atol=1e-15)
    assert z.flags.c_contiguous
    assert z.dtype == np.float32
    other = PAIR.draw(stream(2021, "beam", 0), stream(2021, "substrate", 1))
    assert np.abs(other - z).max() > 1e-10


def test_contact_of_a_sample_does_not_depend_on_the_samples_it_is_computed_with():
    together = contacts_of_samples([PAIR], streams, range(4))[0]
    apart = [contacts_of_samples([PAIR], streams, chunk)[0] for chunk in ([2, 3], [0, 1])]
    for which in range(2):
        assert together[which].dtype == np.float32
        np.testing.assert_array_equal(together[which], np.concatenate([apart[1][which], apart[0][which]]))
        np.testing.assert_allclose(together[which][3], PAIR.contact(rough(3))[which], rtol=1e-6)


@pytest.mark.parametrize("shared", [True, False])
def test_pairs_with_a_common_surface_have_the_contact_of_each_alone(shared):
    rougher = dataclasses.replace(PAIR.beam, rms=2 * PAIR.beam.rms)
    substrate = PAIR.substrate if shared else dataclasses.replace(PAIR.substrate)
    others = [dataclasses.replace(PAIR, beam=rougher, substrate=substrate), dataclasses.replace(HERTZ, every=2)]
    for pair, found in zip([PAIR, *others], contacts_of_samples([PAIR, *others], streams, range(3)), strict=True):
        for curves, alone in zip(found, contacts_of_samples([pair], streams, range(3))[0], strict=True):
            np.testing.assert_array_equal(curves, alone)


def test_a_common_surface_is_drawn_once_for_each_side_and_sample():
    asked = []

    def counted(k):
        asked.append(k)
        return streams(k)

    rougher = dataclasses.replace(PAIR.beam, rms=2 * PAIR.beam.rms)
    contacts_of_samples([PAIR, dataclasses.replace(PAIR, beam=rougher)], counted, range(2))
    assert asked == [0, 0, 0, 1, 1, 1]


@pytest.mark.parametrize("change", [{"length": 0.5e-6}, {"length": 0.48e-6, "width": 0.64e-6, "spacing": 8e-9}])
def test_surfaces_on_different_points_are_refused(change):
    other = SURFACES["Sub1"].with_gaussian_heights(dataclasses.replace(STRIP, **change))
    with pytest.raises(ValueError, match="must have the same points"):
        dataclasses.replace(PAIR, substrate=other)


def test_surfaces_with_different_margins_are_accepted():
    wider = dataclasses.replace(STRIP, margin=0.4e-6)
    pair = dataclasses.replace(PAIR, substrate=SURFACES["Sub1"].with_gaussian_heights(wider))
    assert rough(pair=pair).shape == STRIP.shape
    assert pair.substrate.translation is IDENTITY
