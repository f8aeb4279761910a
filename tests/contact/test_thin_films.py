"""Films that are no liquid: whatever their structure, two heights bound what they hold."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.stats import norm

from stiction.config.files import load
from stiction.constants import WATER_MOLECULE
from stiction.contact.air import MOLECULES
from stiction.contact.environment import Water
from stiction.contact.forcelaw import humid_curves
from stiction.contact.meniscus import (
    BRIDGE,
    STRENGTH,
    film,
    flooded_energy,
    laplace_pressure,
    least_humidity,
    meniscus_height,
)
from stiction.plan.plan import Plan

NM, STEP = 1e-9, 0.05e-9
ONE_SIDE = (0.0, np.radians(110))
HEIGHTS = np.arange(-25, 25, STEP / NM) * NM


def rough(rng):
    """Solid pressure and bearing area of a pair of drawn rms, stiffness and density of summits."""
    rms = rng.uniform(1.5, 10) * NM
    bearing = norm.sf(HEIGHTS / rms)
    summits = norm.pdf(HEIGHTS / rms) / rms * STEP
    depth = np.clip(-HEIGHTS[:, None] + HEIGHTS[None, :], 0, None)
    solid = 10 ** rng.uniform(23.5, 25) * (depth**1.5) @ summits
    return solid, bearing


def held(solid, bearing, films):
    """Energy [J m⁻²] and largest force [Pa] under a mixture of films: weight of the work, height, tension."""
    force = 0.0
    for weight, height, tension in films:
        distance, curve = humid_curves(solid[None], bearing[None], (HEIGHTS[0],) * 2, STEP, (height, tension))
        one = np.zeros(len(HEIGHTS) + 50)
        one[: len(distance)] = curve(0)
        force = force + weight * one
    pull = np.clip(-force, 0, None)
    return pull.sum() * STEP, pull.max()


def of_height(height, angles=ONE_SIDE):
    """Film of a height whose work between flats is that of Eqs. (8) and (9)."""
    return height, flooded_energy(300.0, angles) / height


def drawn_mixture(rng, low, high):
    """Films with heights in a range, whose works add up to that between flats."""
    weights = rng.dirichlet(np.ones(4) * 0.5)
    return [(weight, *of_height(height)) for weight, height in zip(weights, rng.uniform(low, high, 4), strict=True)]


@pytest.mark.parametrize("humidity", [0.31, 0.45, 0.6])
def test_both_ends_bound_every_structure_of_a_thin_film_on_drawn_pairs(humidity):
    """By hand, not by the stages: mixtures of films on drawn surfaces."""
    rng, ends = np.random.default_rng(5), (humidity, least_humidity(300.0, ONE_SIDE))
    heights = [film(air, 300.0, ONE_SIDE)[0] for air in ends]
    for _ in range(12):
        pair = rough(rng)
        bounds = np.max([held(*pair, [(1.0, *film(air, 300.0, ONE_SIDE))]) for air in ends], axis=0)
        found = np.max([held(*pair, drawn_mixture(rng, *heights)) for _ in range(6)], axis=0)
        assert np.all(found <= bounds * (1 + 1e-3))


def test_films_thinner_than_that_of_the_humidity_are_not_bounded():
    """Control: with a higher tension than the humidity has, the largest force exceeds the bound."""
    pair, ends = rough(np.random.default_rng(1)), (0.6, least_humidity(300.0, ONE_SIDE))
    bounds = np.max([held(*pair, [(1.0, *film(air, 300.0, ONE_SIDE))]) for air in ends], axis=0)
    assert held(*pair, [(1.0, *of_height(0.3 * NM))])[1] > 1.02 * bounds[1]


def test_neither_end_bounds_alone():
    """The drier end has the larger force on some pairs, the wetter one the larger energy on others."""
    rng, ends = np.random.default_rng(3), (0.45, least_humidity(300.0, ONE_SIDE))
    found = []
    for _ in range(20):
        pair = rough(rng)
        found.append([held(*pair, [(1.0, *film(air, 300.0, ONE_SIDE))]) for air in ends])
    dry, wet = np.array(found).transpose(1, 2, 0)  # energy and force of all pairs
    assert (dry > wet).any()
    assert (wet > dry).any()


@pytest.mark.parametrize(("humidity", "angles"), [(0.45, ONE_SIDE), (0.1, (0.0, 0.0)), (0.2, (0.5, 0.9))])
def test_a_thin_film_needs_the_work_of_a_liquid_between_flats(humidity, angles):
    height, tension = film(humidity, 300.0, angles)
    assert BRIDGE * WATER_MOLECULE < height < MOLECULES * WATER_MOLECULE
    assert height * tension == pytest.approx(flooded_energy(300.0, angles))
    assert tension == pytest.approx(min(STRENGTH, -laplace_pressure(humidity, 300.0)))


@given(st.floats(0.003, 0.999), st.floats(233, 373), st.tuples(st.floats(0, 120), st.floats(0, 120)))
def test_films_have_no_jump_where_they_stop_to_be_a_liquid(humidity, temperature, degrees):
    """Height and tension of the nearest liquid on one side, of a film that is none on the other."""
    angles = tuple(map(float, np.radians(degrees)))
    assume(np.cos(angles).sum() > 0.02)
    least = least_humidity(temperature, angles)
    sides = [film(least * change, temperature, angles) for change in (1 - 1e-9, 1 + 1e-9)]
    np.testing.assert_allclose(*sides, rtol=1e-6)
    assume(least_humidity(temperature, angles, BRIDGE) <= humidity)
    height, tension = film(humidity, temperature, angles)
    assert height <= max(meniscus_height(humidity, temperature, angles), MOLECULES * WATER_MOLECULE * (1 + 1e-9))
    assert tension <= -laplace_pressure(humidity, temperature)


def test_films_that_are_no_liquid_are_computed_with_what_bounds_them_alone():
    water, thin = Water(300.0), least_humidity(300.0) - 0.01
    with pytest.raises(ValueError, match="thinner than 3 molecules"):
        water.film(thin)
    assert Water(300.0, bounded=True).film(thin) == film(thin, 300.0)
    assert water.film(0.3) == Water(300.0, bounded=True).film(0.3)


@pytest.mark.parametrize(("humidities", "bounded"), [([0.45], {}), ([0.2, 0.45], {"bounded": True}), (["dry"], {})])
def test_a_pair_has_such_films_where_a_device_has(humidities, bounded):
    stopper = {"kind": "stopper", "pair": "b", "contact_um": [2, 2], "restoring_force_uN": 5, "humidities": humidities}
    plan = Plan(load({"devices": {"S": stopper}}))
    of_devices = plan.air_of_devices.water("b")
    assert {key: of_devices[key] for key in ("bounded",) if key in of_devices} == bounded
    assert "bounded" not in plan.air.water("b"), "the paper's own"
