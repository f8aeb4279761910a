"""Probes: against plain sums over pixels, a solver of their elastic contact of its own, and known limits."""

from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose
from published import SPACING, SURFACES

from stiction.contact import forcelaw
from stiction.contact.asperity import HertzAsperity, MaugisTable, reduced_modulus
from stiction.contact.full.elements import Adhesion
from stiction.contact.full.halfspace import HalfSpace
from stiction.contact.gaps import FlatAttraction, gap_pressures
from stiction.contact.meniscus import film
from stiction.contact.pair import SurfacePair
from stiction.contact.probes.pair import ProbedPair
from stiction.contact.probes.shape import RISE, Probe
from stiction.contact.vanderwaals import attraction
from stiction.stages.contact import full_contact
from stiction.streams import stream
from stiction.surface.field import RoughSurface, StripGrid
from stiction.surface.spectrum import CutoffSelfAffine

E = reduced_modulus(164e9, 0.23)
HERTZ, STEP, NM = HertzAsperity(E), 0.05e-9, 1e-9
HUMIDITIES = (0.4, 0.55, 0.7, 0.85, 0.92)


def grid(side, spacing=SPACING):
    return StripGrid(side, side, spacing, margin=0.3e-6)


def pair(probe, side=None, asperity=HERTZ, step=STEP):
    """Probe with Sub1 on B2, on a patch as wide as by default or smaller."""
    own = grid(side or np.ceil(probe.side / SPACING) * SPACING)
    return ProbedPair(SURFACES["B2"].on(own), SURFACES["Sub1"].on(own), step, asperity=asperity, probe=probe)


def place(found, number=0):
    return found.draw(stream(3, "beam", number), stream(3, "substrate", number))


def curve(found, heights, humidity):
    """Distances [m] and forces [N] under water alone."""
    solid, bearing = (each[None] for each in found.contact(heights))
    starts = found.distances.solid[0], found.distances.bearing[0]
    distance, force = forcelaw.humid_curves(solid, bearing, starts, found.step, film(humidity, 300.0))
    return distance, force(0) * heights.size * found.spacing**2


def pull_off(found, heights, humidity):
    return forcelaw.extremum(*curve(found, heights, humidity))[1]


# Brute force: every pixel with its own gap


def kelvin(humidity):
    """Height [m] and tension [Pa] of water between flats at 300 K, Eqs. (8) and (9)."""
    tension = -8.314462618 * 300 * np.log(humidity) / 1.8e-5
    return 2 * 0.072 / tension, tension


def by_pixels(heights, radius, humidity):
    """Pull-off force of a sphere on springs of Hertz, from the gap of every pixel [N]."""
    n = len(heights)
    x = SPACING * (np.arange(n) - n // 2)
    met = heights.astype(float) - (x[:, None] ** 2 + x**2) / (2 * radius)
    inner = met[1:-1, 1:-1]
    around = [met[1 + i : n - 1 + i, 1 + j : n - 1 + j] for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j]
    top = np.all([inner > each for each in around], axis=0)
    sides = met[:-2, 1:-1], met[2:, 1:-1], met[1:-1, :-2], met[1:-1, 2:]
    curvature = ((4 * inner - sum(sides)) / (2 * SPACING**2))[top]
    (height, tension), forces = kelvin(humidity), []
    for distance in met.max() + np.arange(-2e-9, height + STEP, STEP):
        overlap = np.maximum(inner[top] - distance, 0)
        solids = np.sum(4 / 3 * E * overlap**1.5 / np.sqrt(curvature))
        forces.append(solids - tension * SPACING**2 * np.sum(distance - met < height))
    return -min(forces)


@pytest.mark.parametrize("humidity", HUMIDITIES)
@pytest.mark.parametrize("radius", [0.5e-6, 5e-6])
def test_a_probe_holds_what_a_sum_over_its_pixels_holds(radius, humidity):
    found = pair(Probe(radius))
    for number in range(3):
        heights = place(found, number)
        kind, pixels = pull_off(found, heights, humidity), by_pixels(heights, radius, humidity)
        # Distances of both are on other nodes, between which the water reaches a pixel, of which there are 32 to 3000.
        assert_allclose(kind, pixels, rtol=0.02)
        assert by_pixels(heights, np.inf, humidity) > 1.1 * kind  # control: without r²/2R
        if not number:
            assert abs(by_pixels(heights, radius / 2, humidity) / kind - 1) > 0.05  # control: another sphere


# Brute force: full elastic contact


def love(n):
    """Displacement of squares at all offsets under unit pressure on one (n, n) [m Pa⁻¹], for the modulus E'."""
    a, x = SPACING / 2, SPACING * np.arange(n)[:, None]
    y, found = x.T, 0.0
    for u, v, w in ((x + a, y + a, y - a), (y + a, x + a, x - a)):
        found = found + u * np.log((v + np.hypot(u, v)) / (w + np.hypot(u, w)))
    for u, v, w in ((x - a, y - a, y + a), (y - a, x - a, x + a)):
        found = found + u * np.log((v + np.hypot(u, v)) / (w + np.hypot(u, w)))
    return found / np.pi


def matrix(n):
    """Displacement of every pixel by every other (n², n²) [m Pa⁻¹] under E' = 1."""
    i, j = (index.ravel() for index in np.indices((n, n)))
    return love(n)[abs(i[:, None] - i), abs(j[:, None] - j)]


def supported(gap, displaced, start):
    """Pressure p >= 0 [Pa] and gap >= 0 [m], by the set of pixels that touch."""
    touching = start.copy()
    for _ in range(200):
        pressure = np.zeros_like(gap)
        pressure[touching] = np.linalg.solve(displaced[np.ix_(touching, touching)], -gap[touching])
        now = gap + displaced[:, touching] @ pressure[touching]
        wrong = (pressure < 0) | (~touching & (now < -1e-14))
        if not wrong.any():
            return pressure, now, touching
        touching = touching & (pressure >= 0) | (now < -1e-14) & ~touching
    raise AssertionError("no set of touching pixels found")


def elastically(met, humidity, modulus):
    """Pull-off force by a dense solution, from a film that floods what it can while the probe is pulled up [N]."""
    (height, tension), z = kelvin(humidity), met.ravel().astype(float)
    displaced = matrix(len(met)) / modulus
    wet, touching, forces = np.zeros(z.size, bool), np.zeros(z.size, bool), []
    for distance in z.max() + np.arange(-1.0e-9, 2 * height, 0.1e-9):
        for _ in range(100):
            gap = distance - z - tension * displaced[:, wet].sum(axis=1)
            pressure, now, touching = supported(gap, displaced, touching)
            if np.array_equal(now < height, wet):
                break
            wet = now < height
        forces.append((pressure.sum() - tension * wet.sum()) * SPACING**2)
        if len(forces) > 5 and forces[-1] > 0.5 * min(forces) and min(forces) < 0:
            break
    return -min(forces)


@cache
def in_full_contact(modulus):
    """Pull-off forces of two places by the package, the dense solution, and springs of Hertz [N]."""
    found = pair(Probe(0.5e-6), side=0.42e-6, asperity=HertzAsperity(modulus))
    rows = []
    for number in range(2):
        met = found.under_flat(heights := place(found, number))
        space = HalfSpace(met.shape, SPACING, modulus, periodic=False)
        distance, force = curve(found, heights, 0.7)
        area = met.size * SPACING**2
        case = full_contact.StripInAir(Adhesion(*film(0.7, 300.0)), (distance, force / area), 0.0)
        package = full_contact.separated(space, met, case).pull_off * area
        rows.append((package, elastically(met, 0.7, modulus), pull_off(found, heights, 0.7)))
    return np.array(rows)


@pytest.mark.parametrize(("softer", "at_least"), [(1, 0.0), (20, 0.08)])
def test_full_contact_of_a_probe_is_that_of_a_dense_solution(softer, at_least):
    package, dense, springs = in_full_contact(E / softer).T
    assert_allclose(package, dense, rtol=0.03)  # two pixels of water
    assert np.all(springs > (1 + at_least) * dense)  # control: soft pixels that do not displace each other hold more


# Limits


def smooth(probe, asperity, step=STEP):
    return pair(probe, asperity=asperity, step=step), np.zeros((round(np.ceil(probe.side / SPACING)),) * 2, np.float32)


@pytest.mark.parametrize("humidity", [0.5, 0.9])
def test_a_smooth_sphere_in_humid_air_holds_4_pi_r_gamma(humidity):
    height, tension = film(humidity, 300.0)
    for radius in (2e-6, 10e-6):
        limit, force = 4 * np.pi * radius * 0.072, pull_off(*smooth(Probe(radius), HERTZ), humidity)
        # It sinks by δ = (π √R σ / E')², which wets 2πR δ more and leaves a third of that.
        sunk = (np.pi * np.sqrt(radius) * tension / E) ** 2
        assert_allclose(force, limit * (1 + sunk / height / 3), rtol=0.02)


def test_a_smooth_punch_holds_its_flat_and_a_ring_of_its_rim():
    radius, flat = 2e-6, 0.5e-6
    found, heights = smooth(Probe(radius, flat), HertzAsperity(100 * E))
    met = found.under_flat(heights + 1e-12 * np.random.default_rng(1).uniform(size=heights.shape).astype(np.float32))
    height, tension = film(0.8, 300.0)
    wet = np.sum(met > met.max() - height) * SPACING**2
    assert_allclose(wet, np.pi * (flat + np.sqrt(2 * radius * height)) ** 2, rtol=0.01)
    assert wet > 1.5 * np.pi * flat**2  # control: the rim counts


def test_a_smooth_stiff_sphere_in_dry_air_holds_2_pi_r_w():
    """What the summit has and what is left across gaps add up to the work of Eq. (10) of flats (DMT)."""
    dry, radius = attraction("dry"), 0.3e-6
    found, heights = smooth(Probe(radius), MaugisTable(1e4 * E, dry), 0.02e-9)
    flats = FlatAttraction(dry.hamaker_constant)
    solid, bearing = (each[None] for each in found.contact(heights))
    distance = found.distances.solid
    across = gap_pressures(
        bearing, found.distances.bearing[0], distance, found.step, lambda gap: flats.work(gap) - dry.work(gap)
    )[0][0]
    forces = (solid[0] + across) * heights.size * SPACING**2
    assert_allclose(-forces.min(), 2 * np.pi * radius * dry.work_of_adhesion, rtol=0.03)
    assert abs(across.min() / forces.min()) * heights.size * SPACING**2 > 0.1  # control: gaps hold a part


def fine(side, rms, cls=SurfacePair, **more):
    """Gaussian surfaces of one rms, with waves of 30 to 100 nm alone."""
    spectrum = CutoffSelfAffine(1e-36, 0.3e-36, 6e7, 2e8)
    own = grid(side, 5 * NM)
    rough = RoughSurface(spectrum, SURFACES["B2"].with_gaussian_heights(own).translation, rms, own)
    flat = RoughSurface(spectrum, rough.translation, rms / 100, own)
    return cls(rough, flat, 2 * STEP, asperity=HERTZ, **more)


def energy_of_mean_curve(rms, humidity, samples=20):
    """Work [J m⁻²] against the mean force of many patches at common distances: what a zone of many of them needs."""
    found, curves = fine(1e-6, rms), []
    for number in range(samples):
        solid, bearing = (each[None] for each in found.contact(place(found, number)))
        starts = found.distances.solid[0], found.distances.bearing[0]
        distance, force = forcelaw.humid_curves(solid, bearing, starts, found.step, film(humidity, 300.0))
        curves.append(force(0).copy())
    return forcelaw.adhesion_energy(distance, np.mean(curves, axis=0))


def mean_force(radius, rms, humidity, samples):
    """Mean pull-off force of a probe at some places over its radius, and its standard error [N m⁻¹]."""
    probe = Probe(radius)
    found = fine(np.ceil(probe.side / 1e-8) * 1e-8, rms, ProbedPair, probe=probe)
    forces = np.array([pull_off(found, place(found, k), humidity) for k in range(samples)]) / radius
    return forces.mean(), forces.std(ddof=1) / np.sqrt(samples)


def test_a_wide_zone_holds_by_derjaguin_whatever_the_radius_and_a_narrow_one_more():
    limit = 2 * np.pi * energy_of_mean_curve(2 * NM, 0.85)
    for radius, places in ((20e-6, 24), (50e-6, 16)):
        mean, error = mean_force(radius, 2 * NM, 0.85, places)
        assert abs(mean - limit) < 4 * error < 0.3 * limit
    mean, error = mean_force(0.2e-6, 2 * NM, 0.85, 30)
    assert mean - 4 * error > 2 * limit  # control: a tip as narrow as the waves


def test_roughness_takes_force_from_a_probe():
    forces = [mean_force(2e-6, rms * NM, 0.6, 12) for rms in (0.5, 1, 2, 4)]
    for (smoother, _), (rougher, _) in zip(forces, forces[1:], strict=False):
        assert rougher < 0.5 * smoother


def test_the_patch_ends_where_the_probe_has_risen_to_its_reach():
    probe = Probe(3e-6, 0.4e-6)
    rise = probe.rise((201, 201), probe.side / 200)
    assert_allclose(rise[0, 100], RISE, rtol=1e-6)
    assert rise[100, 100] == rise[100, 110] == 0
    assert pair(probe).under_flat(np.zeros((50, 50), np.float32)).max() == pytest.approx(pair(probe).depth)
