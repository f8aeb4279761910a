"""Menisci of constant volume: closed forms of spheres, wedges and flats, and rough surfaces from their heights."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from published import SPACING, SURFACES
from scipy.integrate import trapezoid
from scipy.optimize import brentq

from stiction.contact import separation
from stiction.contact.forcelaw import humid_curves, limit_distance
from stiction.contact.meniscus import film, flooded_energy
from stiction.contact.pair import bearing_area
from stiction.contact.separation import keep_volume
from stiction.streams import stream
from stiction.surface.field import StripGrid

NM = 1e-9
STEP = 0.05 * NM
LAYER = film(0.65, 300.0)
HEIGHT, TENSION = LAYER


def slow_curve(area, first, distance, wall=1e9):
    """Curve of stiff solids that touch at distance 0, between the first two nodes at most, in equilibrium [Pa]."""
    nodes = first + STEP * np.arange(len(area))
    solid = np.where(distance < -0.5 * STEP, wall, 0.0)
    return solid - TENSION * np.interp(distance - HEIGHT, nodes, area, left=1.0, right=0.0)


def separated(area, first, reach=300 * NM):
    """Distances, slow and fast curves, and the work left to the fast one, of stiff solids that rest just below 0."""
    distance = STEP * np.arange(-1, round(reach / STEP))
    slow = slow_curve(area, first, distance)
    fast, left = keep_volume(slow, distance, area, first, LAYER)
    return distance, slow, fast, left


def profile(power):
    """Bearing area of a body, a power of the depth below its summit, and the height of its first node [m]."""
    heights = STEP * np.arange(-2000, 3)
    return np.maximum(-heights / (200 * NM), 0.0) ** power, heights[0]


def test_a_sphere_has_the_same_pull_off_and_twice_the_work():
    area, first = profile(1)  # 2 π R z over the area
    distance, slow, fast, left = separated(area, first)
    out = distance >= 0
    exact = slow[1] * (1 - distance[out] / np.hypot(HEIGHT, distance[out]))
    assert_allclose(fast[out], exact, rtol=1e-4)
    assert_allclose(fast.min(), slow.min(), rtol=1e-4)
    work = [-trapezoid(curve[out], distance[out]) for curve in (slow, fast)]
    assert_allclose((work[1] + left) / work[0], 2, rtol=1e-3)


def test_a_wedge_has_the_same_pull_off():
    # A strip tilted by a slope s holds V = (h² - D²) / 2 s, as a sphere does up to a factor.
    area, first = profile(1)
    steeper = separated(area / 3, first)
    assert_allclose(steeper[2][1:], separated(area, first)[2][1:] / 3, rtol=1e-6)


def test_two_flats_pull_inversely_to_the_square_of_their_distance_and_need_all_of_their_surface_energy():
    gap, area = 2 * NM, np.array([1.0, 0.0])  # higher stops touch while the flats are a gap apart
    first = -gap - STEP / 2
    distance = first + STEP * np.arange(30, 40_000)
    slow = slow_curve(area, first, distance)
    at_rest = limit_distance(distance, slow, 0.0) + gap
    fast, left = keep_volume(slow, distance, area, first, LAYER)
    far = distance > 0
    # The steep edge of the flats is half a step wide on either side.
    assert_allclose(-fast[far], flooded_energy(300.0) * at_rest / (distance[far] + gap) ** 2, rtol=0.03)
    assert_allclose(-trapezoid(fast[far], distance[far]) + left, flooded_energy(300.0), rtol=0.03)
    assert -fast.min() > TENSION * 1.05  # control: more than in equilibrium


def rough(seed):
    """Map of normal heights [m]; its bearing area and the height of its first node [m]."""
    heights = 2 * NM * stream(7, seed).standard_normal((20, 20))
    below, above = (int(np.ceil(end / STEP)) + 1 for end in (-heights.min(), heights.max()))
    return heights, bearing_area(heights, STEP, below, above + 1).astype(np.float32), -below * STEP


def volume(heights, height, distance):
    """Water up to a height in the gaps of a map, per area [m]."""
    gaps = distance - heights
    return np.mean(np.where((gaps > 0) & (gaps < height), gaps, 0.0))


def rough_curves(seed, softness=2e6):
    """Heights, distances, slow and fast curve of a map whose solids resist as an exponential."""
    heights, area, first = rough(seed)
    solid = softness * np.exp(-(STEP * np.arange(len(area) + round(first / STEP)) / (1.2 * NM)) + 4)
    distance, curve = humid_curves(solid[None], area[None], (0.0, first), STEP, LAYER)
    slow = curve(0).copy()
    return heights, distance, slow, *keep_volume(slow, distance, area, first, LAYER)


@pytest.mark.parametrize("seed", range(3))
def test_rough_surfaces_keep_the_volume_of_water_that_their_gaps_hold_at_rest(seed):
    heights, distance, slow, fast, _ = rough_curves(seed)
    rest = limit_distance(distance, slow, 0.0)
    kept, energy = volume(heights, HEIGHT, rest), flooded_energy(300.0)
    off = []
    for at in np.searchsorted(distance, rest + np.array([0.3, 1, 3, 6]) * NM):
        d = distance[at]
        height = brentq(lambda h, d=d: volume(heights, h, d) - kept, 1e-12, d - heights.min())
        water = slow[at] + TENSION * np.mean(heights > d - HEIGHT) - fast[at]
        off.append(water / (energy / height * np.mean(heights > d - height)) - 1)
    # A point of 400 is a volume or an area of 0.25 %, and some of the wetted points are few.
    assert np.max(np.abs(off)) < 0.1
    assert np.all(slow[distance <= rest] == fast[distance <= rest])


@pytest.mark.parametrize("seed", range(5))
def test_fast_separation_needs_more_work_and_dries_the_whole_wetted_area(seed):
    heights, distance, slow, fast, left = rough_curves(seed)
    rest = limit_distance(distance, slow, 0.0)
    out = distance >= rest
    more = trapezoid((slow - fast)[out], distance[out]) + left
    assert more > 0.2 * -trapezoid(slow[out], distance[out])
    # Work of the water: that of drying, and of the tension on what the flat has passed.
    water = TENSION * np.mean(heights > distance[out][:, None, None] - HEIGHT, axis=(1, 2)) + (slow - fast)[out]
    passed = np.mean(heights > distance[out][:, None, None], axis=(1, 2))
    dried = flooded_energy(300.0) * np.mean(heights > rest - HEIGHT)
    least, most = dried, dried + 2 * trapezoid(TENSION * passed, distance[out])
    assert 0.97 * least < trapezoid(water, distance[out]) + left < 1.03 * most


class Pixels:
    """Water between a flat and a map of heights, summed over its pixels, which need no bearing area."""

    def __init__(self, heights):
        self.heights = np.sort(heights.ravel())
        self.sums = np.append(0.0, np.cumsum(self.heights))

    def wetted(self, level):
        """Fraction of the pixels above a level [-]."""
        return 1 - np.searchsorted(self.heights, level) / self.heights.size

    def volume(self, height, distance):
        """Water up to a height in all open gaps, per area [m]."""
        low, high = np.searchsorted(self.heights, [distance - height, distance])
        return ((high - low) * distance - (self.sums[high] - self.sums[low])) / self.heights.size

    def work(self, rest, layer, energy):
        """Work of the water of constant volume, and of constant pressure, from rest on to a micrometre [J m⁻²]."""
        distance = rest + np.append(np.arange(0, 20, 0.02), np.geomspace(20, 1000, 400)) * NM
        kept, fast = self.volume(layer[0], rest), []
        for d in distance:
            height = brentq(lambda h, d=d: self.volume(h, d) - kept, 1e-3 * NM, d - self.heights[0], rtol=1e-12)
            fast.append(energy / height * self.wetted(d - height))
        slow = layer[1] * self.wetted(distance - layer[0])
        return trapezoid(fast, distance) + energy * self.wetted(distance[-1] - height), trapezoid(slow, distance)


@pytest.mark.parametrize("humidity", [0.44, 0.67, 0.92])
def test_the_work_of_constant_volume_is_that_of_the_sum_over_all_pixels_of_drawn_surfaces(humidity):
    layer, energy, ratios = film(humidity, 300.0), flooded_energy(300.0), []
    for seed in range(3):
        heights = SURFACES["B2"].on(StripGrid(2e-6, 2e-6, SPACING, 1e-6)).draw(stream(7, "drawn", seed)).astype(float)
        below, above = (int(np.ceil(end / STEP)) + 1 for end in (-heights.min(), heights.max()))
        area, first = bearing_area(heights, STEP, below, above + 1).astype(np.float32), -below * STEP
        solid = 1e9 * np.exp(-STEP * np.arange(above + 1) / NM)
        distance, curve = humid_curves(solid[None], area[None], (0.0, first), STEP, layer)
        slow = curve(0).copy()
        fast, left = keep_volume(slow, distance, area, first, layer)
        rest = limit_distance(distance, slow, 0.0)
        of_volume, of_pressure = Pixels(heights).work(rest, layer, energy)
        more = trapezoid((slow - fast)[distance >= rest], distance[distance >= rest])
        ratios.append(((more + left) / (of_volume - of_pressure), more / (of_volume - of_pressure)))
    whole, ended = np.mean(ratios, axis=0)
    assert_allclose(whole, 1, rtol=3e-3)
    assert ended < 0.9, "control: a good part is done beyond the distances of slow separation"


def test_surfaces_that_no_summits_stop_come_to_no_rest():
    area, first = profile(1)
    distance = STEP * np.arange(200)
    assert keep_volume(slow_curve(area, first, distance), distance, area, first, LAYER) is None


def test_water_that_cannot_flow_holds_as_in_equilibrium_where_it_fills_no_gap():
    area, first = profile(1)
    distance, slow, _, _ = separated(area, first)
    dry, left = keep_volume(slow, distance, area, first, (0.0, 0.0))
    assert np.all(dry == slow)
    assert left == 0


# Patches that hold hardly any water


def largest_ratio_of_steep_summits(humidity):
    """Largest ratio of the pull-offs, fast over slow, of 60 soft steep spheres at drawn places on a grid [-]."""
    radius, point, side, layer = 60 * NM, 10 * NM, 40, film(humidity, 300.0)
    x, distance, ratios = point * np.arange(-side // 2, side // 2), STEP * np.arange(-40, 400), []
    hertz = 4 / 3 * 2e10 * np.sqrt(radius) * np.maximum(-distance, 0) ** 1.5 / (point * side) ** 2
    for number in range(60):
        place = point * stream(11, "summit", number).uniform(-0.5, 0.5, 2)
        heights = -((x[:, None] - place[0]) ** 2 + (x - place[1]) ** 2) / (2 * radius)
        area, nodes = bearing_area(heights, STEP, 2000, 2).astype(np.float32), STEP * np.arange(-2000, 2)
        slow = hertz - layer[1] * np.interp(distance - layer[0], nodes, area, left=1.0, right=0.0)
        fast, _ = keep_volume(slow, distance, area, nodes[0], layer)
        ratios.append(fast.min() / slow.min())
    return max(ratios)


def test_a_steep_sphere_on_a_coarse_grid_holds_about_as_much_as_the_sphere_itself(monkeypatch):
    """The sphere has the same pull-off slowly and fast. Its grid resolves the water beside it by a few points."""
    assert max(map(largest_ratio_of_steep_summits, (0.3, 0.44, 0.67))) < 2
    monkeypatch.setattr(separation, "THINNEST", 1e-4 * NM)
    assert largest_ratio_of_steep_summits(0.3) > 20, "control: a film of a picometre pulls without limit"


def largest_pull_of_water(number):
    """Largest pull of constant volume on a drawn map of 0.05 to 2 nm rms that rests deep in itself [Pa]."""
    rng = stream(11, "map", number)
    layer, heights = film(rng.uniform(0.3, 0.95), 300.0), NM * rng.uniform(0.05, 2) * rng.standard_normal((20, 20))
    below, above = (int(np.ceil(end / STEP)) + 1 for end in (-heights.min(), heights.max()))
    area, first = bearing_area(heights, STEP, below, above + 1).astype(np.float32), -below * STEP
    distance, rest = first + STEP * np.arange(round(20 * NM / STEP)), rng.uniform(heights.min(), heights.max())
    level = (distance - layer[0] - first) / STEP
    water = layer[1] * np.interp(level, np.arange(len(area)), area.astype(float), left=1.0, right=0.0)
    solid = np.where(distance < rest, 2 * layer[1], 0.0)
    fast, _ = keep_volume(solid - water, distance, area, first, layer)
    return (solid - fast).max()


def test_water_pulls_on_no_surfaces_harder_than_on_flats_flooded_by_the_thinnest_liquid(monkeypatch):
    flats = flooded_energy(300.0) / (3 * 0.28 * NM)
    assert max(map(largest_pull_of_water, range(200))) <= flats * (1 + 1e-6)
    monkeypatch.setattr(separation, "THINNEST", 1e-4 * NM)
    assert max(map(largest_pull_of_water, range(200))) > 10 * flats, "control"


def test_flats_reach_this_bound_where_they_rest_the_thinnest_liquid_apart():
    gap, area = 3 * 0.28 * NM, np.array([1.0, 0.0])
    first = -gap - STEP / 2
    distance = first + STEP * np.arange(4, 4000)
    slow = slow_curve(area, first, distance)
    fast, _ = keep_volume(slow, distance, area, first, LAYER)
    resting = limit_distance(distance, slow, 0.0) + gap
    assert_allclose(-fast.min(), flooded_energy(300.0) / resting, rtol=0.05)  # half a step before the edge
