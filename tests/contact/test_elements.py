from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from unittest.mock import Mock

import numpy as np
import pytest
from published import SPACING, SURFACES

from stiction.contact import forcelaw
from stiction.contact.asperity import MaugisTable, hertz_force, reduced_modulus
from stiction.contact.full import elements
from stiction.contact.full.elements import Adhesion, equilibrium, separation
from stiction.contact.full.halfspace import HalfSpace
from stiction.contact.meniscus import film
from stiction.contact.pair import SurfacePair
from stiction.contact.vanderwaals import attraction
from stiction.errors import NotConverged
from stiction.streams import stream
from stiction.surface.field import StripGrid

E = reduced_modulus(164e9, 0.23)
WATER = attraction("water")
NM = 1e-9
NONE = Adhesion(0.0, 0.0)
#: Forces and energies of states that settled: attraction to 2e-3, gaps to 1 % of the range of van der Waals forces.
STATE = 5e-3


def sphere(points, spacing, radius, centre=(0.0, 0.0)):
    """Paraboloid with its top at height 0, away from the middle by a share of the spacing."""
    x, y = ((np.arange(points) - points // 2 - shift) * spacing for shift in centre)
    return (-(x[:, None] ** 2 + y**2) / (2 * radius)).astype(np.float32)


def points_around(radius, depth, spacing):
    """Elements across a square in which a sphere touches or attracts down to a depth."""
    return int(2 * np.ceil(1.6 * np.sqrt(2 * radius * depth) / spacing) + 6)


def forces_of_spheres(radius, overlap, spacing, adhesion=None, positions=12):
    """Forces of isolated spheres on the flat [N], with their tops at random places between the elements."""
    rng = np.random.default_rng(7)
    points = points_around(radius, max(overlap, 0) + (0.5 * NM if adhesion else 0), spacing)
    space = HalfSpace((points, points), spacing, E, periodic=False)
    found = []
    for _ in range(positions):
        z = sphere(points, spacing, radius, rng.uniform(-0.5, 0.5, 2))
        state = equilibrium(space, z, -overlap, adhesion and Adhesion.from_film((0.0, 0.0), WATER, space))
        found.append(state.force * points**2 * spacing**2)
    return np.array(found)


# One sphere


@pytest.mark.parametrize(("spacing", "allowed"), [(10 * NM, 0.015), (5 * NM, 0.004), (2.5 * NM, 0.002)])
def test_a_sphere_without_attraction_is_hertz_on_ever_finer_grids(spacing, allowed):
    for radius, overlap in ((400 * NM, 1 * NM), (800 * NM, 1 * NM)):
        mean = forces_of_spheres(radius, overlap, spacing).mean()
        assert mean == pytest.approx(hertz_force(overlap, radius, E), rel=allowed)
        assert mean != pytest.approx(hertz_force(1.03 * overlap, radius, E), rel=allowed)


@pytest.mark.parametrize(("spacing", "allowed"), [(10 * NM, 0.25), (5 * NM, 0.08), (2.5 * NM, 0.03)])
def test_a_sphere_with_van_der_waals_forces_is_maugis_on_ever_finer_grids(spacing, allowed):
    """In units of πwR, of which a sphere pulls off with 1.5 to 2."""
    radius, table = 400 * NM, MaugisTable(E, WATER)
    scale = np.pi * WATER.work_of_adhesion * radius
    for overlap in (-0.1 * NM, 0.0, 0.3 * NM, 1 * NM):
        mean = forces_of_spheres(radius, overlap, spacing, adhesion=True).mean()
        assert mean / scale == pytest.approx(float(table.force(overlap, radius)) / scale, abs=allowed)


def test_attraction_that_displaces_nothing_is_not_maugis():
    """A control: van der Waals forces over the gap of Hertz, which is the common DMT approximation."""
    radius, overlap, spacing = 400 * NM, 1 * NM, 5 * NM
    points = points_around(radius, 1.5 * NM, spacing)
    space = HalfSpace((points, points), spacing, E, periodic=False)
    state = equilibrium(space, sphere(points, spacing, radius), -overlap)
    adhesion = Adhesion.from_film((0.0, 0.0), WATER, space)
    force = (state.pressure.mean(dtype=float) - adhesion.traction(state.gap).mean(dtype=float)) * (
        points * spacing
    ) ** 2
    exact = MaugisTable(E, WATER).force(overlap, radius)
    assert abs(force - exact) > 0.4 * np.pi * WATER.work_of_adhesion * radius


# Elements that act on each other


def test_two_spheres_lift_each_other_by_the_displacement_of_point_forces():
    radius, overlap, spacing = 400 * NM, 1 * NM, 5 * NM
    x, y = np.arange(40)[:, None] * spacing, np.arange(140) * spacing

    def at(place):
        return -((x - 100 * NM) ** 2 + (y - place) ** 2) / (2 * radius)

    space = HalfSpace((40, 140), spacing, E, periodic=False)
    alone = equilibrium(space, at(150 * NM).astype(np.float32), -overlap).force
    for between in (200 * NM, 400 * NM):
        z = np.maximum(at(150 * NM), at(150 * NM + between)).astype(np.float32)
        both = equilibrium(space, z, -overlap).force / 2
        force = hertz_force(overlap, radius, E)
        for _ in range(50):
            force = hertz_force(overlap - force / (np.pi * E * between), radius, E)
        expected = force / hertz_force(overlap, radius, E)
        assert both / alone == pytest.approx(expected, abs=3e-3)
        assert abs(expected - 1) > 6 * 3e-3  # without interaction


def test_a_periodic_sphere_approaches_the_mean_plane_less_than_hertz():
    """By 1 - 1.655 a/L: K. L. Johnson, J. A. Greenwood and J. G. Higginson, Int. J. Mech. Sci. 27, 383 (1985)."""
    points, spacing, radius = 200, 5 * NM, 400 * NM
    space = HalfSpace((points, points), spacing, E)
    z = sphere(points, spacing, radius)
    for distance in (-0.5 * NM, -1.5 * NM):
        force = equilibrium(space, z, distance).force * (points * spacing) ** 2
        contact = (3 * force * radius / (4 * E)) ** (1 / 3)
        share = 1 - 1.655 * contact / (points * spacing)
        assert -distance * radius / contact**2 == pytest.approx(share, abs=3e-3)
        assert 1 - share > 2 * 3e-3


def waves(points=64):
    """A patch given by a formula, for comparison with another program (n, n) [m]."""
    x, y = np.arange(points)[:, None] / points, np.arange(points) / points
    known = ((1, 2, 0.3), (3, -1, 1.1), (2, 5, 2.0), (-5, 3, 0.7), (7, 6, 2.9), (4, -8, 1.7))
    return NM * sum(np.cos(2 * np.pi * (a * x + b * y) + phase) / np.hypot(a, b) for a, b, phase in known)


@pytest.mark.parametrize(
    ("distance", "pressure", "largest", "elements_in_contact"),
    [(0.9 * NM, 3215832.395, 1201758504, 33), (0.6 * NM, 18297547.248, 1561878901, 140)],
)
def test_an_isolated_patch_is_that_of_another_program(monkeypatch, distance, pressure, largest, elements_in_contact):
    """ContactMechanics 1.8.3, FreeFFTElasticHalfSpace with E' = 86.6 GPa and 10 nm, minimize_proxy, pentol 1e-14."""
    space, z = HalfSpace((64, 64), 10 * NM, 86.6e9, periodic=False), waves().astype(np.float32)
    usual = equilibrium(space, z, distance)
    assert usual.force == pytest.approx(pressure, rel=1e-3)
    monkeypatch.setattr(elements, "TOLERANCE", 1e-14)
    exact = equilibrium(space, z, distance)
    assert exact.force == pytest.approx(pressure, rel=1e-4)
    assert exact.pressure.max() == pytest.approx(largest, rel=1e-4)
    assert np.sum(exact.pressure > 0) == elements_in_contact
    waves_alone = replace(space, periodic=True)  # other surroundings must differ
    assert equilibrium(waves_alone, z, distance).force != pytest.approx(pressure, rel=1e-2)


# Rough strips


STRIP = StripGrid(0.6e-6, 1.2e-6, SPACING, margin=0.2e-6)
PAIR = SurfacePair(SURFACES["B1"].on(STRIP), SURFACES["Sub1"].on(STRIP), 0.05 * NM, asperity=MaugisTable(E, WATER))


@cache
def rough(number=0):
    return PAIR.draw(stream(5, "beam", number), stream(5, "substrate", number))


@cache
def space_of(periodic=True, modulus=E):
    return HalfSpace(STRIP.shape, SPACING, modulus, periodic)


def adhesion_at(humidity, space=None):
    return Adhesion.from_film(film(humidity, 300.0), WATER, space or space_of())


def by_summits(number, humidity):
    """Energy, largest attraction, and distances and forces of the sum over summits."""
    solid, bearing = PAIR.contact(rough(number))
    starts = PAIR.distances.solid[0], PAIR.distances.bearing[0]
    distance, curve = forcelaw.humid_curves(solid[None], bearing[None], starts, PAIR.step, film(humidity, 300.0))
    _, pull_off = forcelaw.extremum(distance, curve(0))
    return forcelaw.adhesion_energy(distance, curve(0)), pull_off, (distance, curve(0))


def other_model(at_rest, farthest):
    """Distances and forces of a curve without force at a distance and with the largest attraction at another."""
    step = farthest - at_rest
    return at_rest + step * np.arange(-1, 3), np.array([1.0, 0.0, -1.0, -0.5])


@cache
def separated(number=0, humidity=0.7, periodic=True):
    space = space_of(periodic)
    return separation(space, rough(number), adhesion_at(humidity, space), by_summits(number, humidity)[2])


@pytest.mark.parametrize("humidity", [0.45, 0.7])
def test_contact_and_gap_exclude_each_other(humidity):
    state = separated(0, humidity).closed
    assert np.all(state.pressure >= 0)
    assert np.any(state.pressure > 0)
    assert state.residual <= 5 * elements.TOLERANCE
    assert state.residual == pytest.approx(np.abs(state.gap[state.pressure > 0]).max())
    settled = np.abs(adhesion_at(humidity).traction(state.gap) - state.attraction).mean()
    assert settled <= elements.SETTLED * np.abs(state.attraction).mean() * 1.01


@pytest.mark.parametrize(("humidity", "hysteresis"), [(0.45, 0.06), (0.7, 0.006), (0.9, 0.006)])
def test_the_energy_of_the_state_without_force_lies_between_the_work_of_approach_and_of_separation(
    humidity, hysteresis
):
    """Both are the integral of the force, and differ by what jumps of the solids into and out of contact dissipate."""
    found, adhesion, step = separated(0, humidity), adhesion_at(humidity), 0.05 * NM
    distances = np.arange(found.closed.distance, float(rough().max()) + adhesion.height + 0.3 * NM, step)
    approach, separation, state = [], [], found.closed
    for distance in distances:
        state = equilibrium(space_of(), rough(), distance, adhesion, state)
        separation.append(state.force)
        approach.append(equilibrium(space_of(), rough(), distance, adhesion).force)
    approached, work = (-np.trapezoid(curve, distances) for curve in (approach, separation))
    assert approached - 1e-3 * work < found.adhesion_energy < work * 1.001
    assert work / approached == pytest.approx(1, abs=hysteresis)
    assert -min(separation) == pytest.approx(found.pull_off, rel=0.02)
    assert -min(separation) > -min(approach) * 0.999


def test_energy_and_pull_off_are_the_same_in_isolation_and_the_distance_is_not():
    for humidity in (0.7, 0.9):
        periodic, alone = separated(0, humidity), separated(0, humidity, periodic=False)
        assert alone.adhesion_energy == pytest.approx(periodic.adhesion_energy, rel=0.02)
        assert alone.pull_off == pytest.approx(periodic.pull_off, rel=0.05)
        assert abs(alone.closed.distance - periodic.closed.distance) > 0.001 * NM


def test_attraction_that_displaces_nothing_depends_on_the_surroundings():
    """A control: the energy of contact without the displacement by the attraction, at the same humidity."""

    def energy(periodic):
        space, adhesion = space_of(periodic), adhesion_at(0.7)
        distances, forces = np.arange(1.0, 9.0, 0.1) * NM, []
        for distance in distances:
            state = equilibrium(space, rough(), distance)
            forces.append(state.pressure.mean(dtype=float) - adhesion.traction(state.gap).mean(dtype=float))
        return forcelaw.adhesion_energy(distances, np.array(forces))

    assert abs(energy(False) / energy(True) - 1) > 0.1


def test_a_shift_of_a_periodic_strip_by_whole_elements_changes_nothing():
    moved, distance = np.roll(rough(), (17, 40), (0, 1)), 2.6 * NM
    for periodic, same in ((True, True), (False, False)):  # an isolated strip has ends
        space = space_of(periodic)
        one, other = (equilibrium(space, z, distance, adhesion_at(0.7, space)).force for z in (rough(), moved))
        assert (one == pytest.approx(other, rel=2e-3)) == same


# Limits


def test_flooded_flats_have_the_tension_times_the_height_of_the_film():
    height, tension = film(0.8, 300.0)
    flat = np.zeros((16, 16), np.float32)
    space, adhesion = HalfSpace(flat.shape, SPACING, E), Adhesion(height, tension)
    for distance in (0.1 * NM, 0.5 * height):
        state = equilibrium(space, flat, distance, adhesion)
        assert state.force == pytest.approx(-tension)
        assert state.energy(flat, adhesion) == pytest.approx(-tension * (height - distance), rel=1e-5)
    assert equilibrium(space, flat, 1.1 * height, adhesion).force == 0


def test_the_ramp_of_van_der_waals_forces_keeps_their_work():
    adhesion = Adhesion.from_film((0.0, 0.0), WATER, space_of())
    gaps = np.linspace(0, 0.4 * NM, 4001)
    assert adhesion.energy(0.0) == pytest.approx(-WATER.work_of_adhesion, rel=1e-12)
    np.testing.assert_allclose(
        np.gradient(adhesion.energy(gaps), gaps)[1:-1], adhesion.traction(gaps)[1:-1], atol=2e-3 * WATER.stress
    )
    assert 0 < adhesion.ramp < WATER.range


def test_rigid_surfaces_touch_at_one_point_and_have_the_energy_of_the_gap_there():
    height, tension = film(0.8, 300.0)
    space, adhesion = space_of(modulus=1e3 * E), Adhesion(height, tension)
    top = float(rough().max())
    found = separation(space, rough(), adhesion, other_model(top - 0.03 * NM, top + 0.03 * NM))
    expected = tension * np.clip(height - (top - rough().astype(float)), 0, None).mean()
    assert found.adhesion_energy == pytest.approx(expected, rel=0.01)
    assert np.sum(found.closed.pressure > 0) < 10
    soft = separation(space_of(), rough(), adhesion, by_summits(0, 0.8)[2])
    assert soft.adhesion_energy > 1.5 * expected


def test_full_contact_tends_to_the_sum_over_summits_as_the_water_floods_everything():
    ratios = [
        separated(0, humidity).adhesion_energy / by_summits(0, humidity)[0] for humidity in (0.45, 0.7, 0.9, 0.97)
    ]
    distances = np.abs(np.array(ratios) - 1)
    assert np.all(np.diff(distances) < 0)
    assert distances[-1] < 0.005 < 0.2 < distances[0]


def test_the_largest_attraction_of_a_film_that_floods_everything_is_its_tension_and_is_found_before_the_film_ends(
    monkeypatch,
):
    """The force is the same over most of the 51 nm of the film, in which the search must not walk on."""
    (height, tension), at = film(0.98, 300.0), Mock(wraps=equilibrium)
    monkeypatch.setattr(elements, "equilibrium", at)
    found = separation(space_of(), rough(), Adhesion(height, tension), by_summits(0, 0.98)[2])
    assert found.pull_off == pytest.approx(tension, rel=0.01)  # of the parabola through three distances
    assert found.states == at.call_count < 15


@pytest.mark.parametrize("lower", [0.3, 1.0])
def test_the_curve_of_higher_summits_leads_to_the_same_state(lower):
    """As after pressing: at the distance where the summits rest that were there before, nothing touches."""
    flat = np.minimum(rough(), rough().max() - np.float32(lower * NM))
    adhesion, (distance, force) = adhesion_at(0.7), by_summits(0, 0.7)[2]
    far = elements.at_rest(space_of(), flat, adhesion, (distance + 5 * NM, force))[0]
    near = elements.at_rest(space_of(), flat, adhesion, (distance, force))[0]
    assert far.energy(flat, adhesion) == pytest.approx(near.energy(flat, adhesion), rel=3e-3)
    assert far.distance == pytest.approx(near.distance, abs=0.05 * NM)  # of a thousandth of the energy


@pytest.mark.parametrize("below", [1.0, 5.0])
def test_a_force_that_jumps_past_zero_is_found_at_its_jump(below):
    """A made-up strip of which a contact opens at 1 nm: secants through the last two states lead astray."""
    asked, energy = [], 1e-9

    def at(distance, *_):
        asked.append(distance)
        force = 1.2 - 0.2 * distance / NM if distance < 1 * NM else -below
        return SimpleNamespace(distance=distance, force=force)

    state, states = elements._without_force(at, other_model(0.2 * NM, 2 * NM), lambda state: energy)
    assert states == len(asked) < 20
    assert asked[0] == pytest.approx(0.2 * NM)  # where the other model has no force
    between = 2 * elements.ENERGY_LEFT * energy * (1 + below) / state.force**2
    assert abs(state.distance - 1 * NM) < between < 0.02 * NM


# What is refused


def test_elements_too_large_for_van_der_waals_forces_are_refused():
    with pytest.raises(ValueError, match="needs a finer grid") as caught:
        Adhesion.from_film((1 * NM, 1e7), WATER, HalfSpace((8, 8), 60 * NM, E))
    enough = float(str(caught.value).rpartition("decrease sampling.spacing_nm to ")[2])
    assert Adhesion.from_film((1 * NM, 1e7), WATER, HalfSpace((8, 8), enough * NM, E)).stress > 0
    with pytest.raises(ValueError, match="needs a finer grid"):
        Adhesion.from_film((1 * NM, 1e7), WATER, HalfSpace((8, 8), 1.03 * enough * NM, E))
    assert Adhesion.from_film((1 * NM, 1e7), None, HalfSpace((8, 8), 60 * NM, E)) == Adhesion(1 * NM, 1e7)


def test_surfaces_too_smooth_to_resist_the_adhesion_are_refused():
    smooth = (1e-3 * rough()).astype(np.float32)
    with pytest.raises((ValueError, NotConverged), match="full elastic contact .* too smooth or .* too soft"):
        separation(space_of(), smooth, adhesion_at(0.9), other_model(0.05 * NM, 1 * NM))


# Search for states


def separated_by(law, curve, **far):
    """Separation of a strip with a law of its force [Pa] over the distance and the state before it, led by a curve."""

    def settle(_space, _heights, distance, _adhesion, before, **_coarser):
        force = np.full((1, 1), law(distance, before), np.float32)
        return elements.State(distance, force.clip(0), (-force).clip(0), np.full((1, 1), distance, np.float32), 1)

    whole = SimpleNamespace(energy=lambda gap: np.full(gap.shape, -1e-2))
    return separation(None, np.zeros((1, 1), np.float32), whole, curve, settle, **far)


def curve_of(rest, width):
    """Curve without force at a distance, and with the largest attraction of 1 MPa a width beyond it."""
    distances = np.linspace(-2 * NM, 8 * NM, 1001)
    x = (distances - rest) / width
    return distances, 1e6 * np.where(x < 0, -5 * x, -x * np.exp(1 - x))


def law_of(distances, forces):
    """Law of linear pieces, at distances [nm]."""
    return lambda distance, _before: np.interp(distance, np.array(distances) * NM, forces)


def test_a_larger_attraction_beyond_the_first_one_is_found_if_it_is_sought():
    led = curve_of(1 * NM, 0.3 * NM)
    two = law_of([0, 1, 1.3, 1.31, 2, 2.5, 9], [3e6, 0, -1e6, -2e5, -2e5, -2e6, 0])
    assert separated_by(two, led, end=3 * NM).pull_off == pytest.approx(2e6, rel=0.1)
    assert separated_by(two, led).pull_off == pytest.approx(1e6, rel=0.1), "control: nobody seeks beyond"


def test_a_touch_of_attraction_before_repulsion_is_not_the_largest_one():
    led = curve_of(1 * NM, 0.3 * NM)
    touch = law_of([0, 1, 1.3, 1.31, 2, 2.5, 9], [3e6, 0, -1e3, 2e5, 2e5, -2e6, 0])
    assert separated_by(touch, led).pull_off == pytest.approx(2e6, rel=0.1)


@pytest.mark.parametrize("far", [{"end": 6 * NM}, {}])
@pytest.mark.parametrize("width", [0.03, 0.1])
def test_rest_is_found_far_from_where_another_model_has_it(width, far):
    law, led = law_of([0, 5, 5 + width, 9], [4e6, 0, -1e6, 0]), curve_of(1 * NM, width * NM)
    found = separated_by(law, led, **far)
    assert found.closed.force == pytest.approx(0, abs=2e5)
    assert found.closed.distance == pytest.approx(5 * NM, abs=0.1 * NM)
    assert found.pull_off == pytest.approx(1e6, rel=0.1)


def test_rest_is_not_sought_beyond_where_nothing_resists():
    with pytest.raises(ValueError, match="finds no distance at which the surfaces come to rest"):
        separated_by(law_of([0, 9], [-1e6, 0]), curve_of(1 * NM, 0.1 * NM))


@pytest.mark.parametrize("beyond", [0.4, 1.3, 3.0])
def test_rest_is_not_in_the_tail_of_the_attraction_where_another_model_leads(beyond):
    """Far from a narrow well, hardly any force is left, less than a line from contact would have."""
    law = law_of([0, 1, 1.1, 1.3, 9], [3e6, 0, -1e6, -1e3, 0])
    found = separated_by(law, curve_of((1 + beyond) * NM, 0.3 * NM))
    assert found.closed.distance == pytest.approx(1 * NM, abs=0.05 * NM)
    assert found.pull_off == pytest.approx(1e6, rel=0.1)


def test_the_attraction_of_coarse_steps_stays_where_finer_ones_jump_off_at_once():
    led = curve_of(1 * NM, 0.3 * NM)

    def jumping(distance, before):
        is_beside = before is not None and 0 < distance - before.distance < 0.07 * NM  # a third of a step
        return -1e3 if is_beside else np.interp(distance, *led)

    assert separated_by(jumping, led).pull_off == pytest.approx(1e6, rel=0.1)
