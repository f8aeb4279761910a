"""Tips of pair b: lengths that they hold against an independent computation, on finer grids and at more slopes."""

from functools import cache

import numpy as np
import pytest
from plans import job_settings, surface_datasets

from stiction.config.cases import case_id
from stiction.config.files import load
from stiction.config.units import in_si
from stiction.contact import tilted
from stiction.contact.environment import Water
from stiction.contact.meniscus import flooded_energy
from stiction.devices import arcs, risk
from stiction.models import SHIFTS
from stiction.plan.devices import DevicePlan
from stiction.plan.plan import Plan
from stiction.stages.contact import contact, curves
from stiction.stages.devices import budget
from stiction.stages.devices.opening import DesignedBeam
from stiction.stages.life import separation
from stiction.streams import stream

WATER = Water(300.0)
DEVICE = DesignedBeam("cantilever", "b", 2.6e-6, 20e-6, 30e-6, 164e9, 1.5e-6)
BEAM = DEVICE.beam
C1 = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30}
C1 |= {"humidities": [0.44, 0.67, 0.92]}
#: Lengths that the tips of 1 in 100 and of 1 in 1000 beams hold, and their standard errors [µm]: 1696 tips with an
#: edge that carries nothing on strips of 0.3 µm, each solved by bisection over the length.
INDEPENDENT = {
    0.44: {1e-2: (302.7, 4.2), 1e-3: (263, 6)},
    0.67: {1e-2: (302.6, 2.5), 1e-3: (273, 4)},
    0.92: {1e-2: (251.0, 0.5), 1e-3: (245.5, 0.9)},
}


def settings(number, edge="rounded", radius=0.0):
    design = {"beams": 200, "tip_edge": edge, "edge_radius_um": radius}
    plan = Plan(load({"devices": {"C1": C1}, "design": design}))
    plain = job_settings(
        plan,
        f"devices/contact/tips/{DevicePlan(plan.config).tips('C1').name}",
    )
    plain["contact"] |= {"samples": number}
    return plan, plain


def drawn(plan, plain):
    surfaces = [surface_datasets(plan, name) for name in plan.sides("b")]
    return contact.compute(surfaces, "b", "NG", in_si(contact.Settings, plain))


@cache
def tips(number, edge="rounded", radius=0.0):
    """Contact of tips of pair b, 30 µm wide, with a radius of the edge [µm]."""
    return drawn(*settings(number, edge, radius))


def held(found, humidity):
    """Lengths that tips hold (n,) [m]."""
    return arcs.longest_free(*curves.tip_forces(found, humidity, WATER), BEAM)


@pytest.mark.slow
@pytest.mark.parametrize("humidity", INDEPENDENT)
def test_tips_hold_the_lengths_of_an_independent_computation(humidity):
    lengths = held(tips(600), humidity)
    for share, (length, error) in INDEPENDENT[humidity].items():
        found = risk.safe_length(lengths, share, stream(0))
        error = np.hypot(1e6 * found.error, error)
        assert abs(1e6 * found.estimate - length) < 3 * error
        assert abs(1e6 * np.quantile(lengths, 0.1) - length) > 3 * error  # control


@pytest.mark.slow
def test_no_tip_holds_shorter_beams_than_saturated_air():
    limit = arcs.arc_length(flooded_energy(WATER.temperature), BEAM)
    for humidity in INDEPENDENT:
        assert held(tips(600), humidity).min() > limit


@pytest.mark.slow
def test_on_average_steeper_tips_are_held_less():
    for humidity in (0.67, 0.92):
        _, forces = curves.tip_forces(tips(600), humidity, WATER)
        assert np.all(np.diff(forces.mean(axis=0)) < 0)


@pytest.mark.slow
def test_tips_with_a_square_edge_hold_longer_beams_only():
    for humidity in INDEPENDENT:
        square, rounded = (held(tips(200, edge), humidity) for edge in ("square", "rounded"))
        assert np.quantile(square, 0.05) > 1.03 * np.quantile(rounded, 0.05)
        assert np.median(square) > np.median(rounded)


@pytest.mark.slow
def test_lengths_between_the_slopes_are_those_of_slopes_four_times_as_dense():
    plan, plain = settings(200)
    few = plain["tilt"]["slopes"]
    plain["tilt"]["slopes"] = list(np.geomspace(few[0], few[-1], 4 * len(few) - 3))
    dense = drawn(plan, plain)
    for humidity in INDEPENDENT:
        exact = held(dense, humidity)
        stated, sparse = (np.log(held(dense.isel(slope=slice(None, None, step)), humidity) / exact) for step in (4, 16))
        assert abs(stated[np.argsort(exact)[:20]].mean()) < 0.002
        assert np.abs(sparse).mean() > 2 * np.abs(stated).mean()  # control


@pytest.mark.slow
@pytest.mark.parametrize("edge", ["rounded", "square"])
def test_lengths_do_not_depend_on_the_grid_but_they_would_with_another_weight_of_the_edge(edge, monkeypatch):
    def changes():
        """Change of ln L from 10 to 5 nm (humidities, n)."""
        found = []
        for spacing in (10, 5):
            plan, plain = settings(60, edge)
            plain["sampling"] |= {"spacing_nm": spacing, "strip_length_um": 0.4}
            found.append(drawn(plan, plain))
        return np.array([np.log(held(found[1], h) / held(found[0], h)) for h in INDEPENDENT])

    mean, errors = (lambda x: (x.mean(axis=1), x.std(axis=1) / np.sqrt(60)))(changes())
    assert np.all(np.abs(mean) < 3 * errors + 0.01)
    monkeypatch.setattr(tilted, "first_weight", lambda _: 0.5 if edge == "rounded" else 0.0)  # control
    shifted, errors = (lambda x: (x.mean(axis=1), x.std(axis=1) / np.sqrt(60)))(changes())
    assert np.all(np.abs(shifted - mean) > 0.007)
    assert np.any(np.abs(shifted) > 3 * errors + 0.01)


@pytest.mark.slow
@pytest.mark.parametrize("humidity", [0.44, 0.67])
def test_tips_that_separate_fast_hold_shorter_beams_least_so_the_strongest(humidity):
    found = tips(600)
    slow, fast = (
        arcs.longest_free(found.slope.values, forces, BEAM)
        for forces in (curves.tip_forces(found, humidity, WATER)[1], curves.fast_tip_forces(found, humidity, WATER))
    )
    factor, error = separation.factor_of_tips(separation.of_tips(found, separation.FastInAir(WATER, humidity)), DEVICE)
    assert np.all(fast <= slow)
    assert factor + 4 * error < 1
    # The tips that hold the shortest beams gain least.
    ratios = [np.quantile(fast, share) / np.quantile(slow, share) for share in (0.02, 0.1)]
    assert min(ratios) > factor + 4 * error


@pytest.mark.nightly
def test_the_slope_of_the_edge_is_that_between_tips_with_a_sharper_and_a_rounder_one():
    humidity, radius = 0.92, 1
    own = C1 | {"uncertainty": {"edge_radius_um": 0.3 * radius}}
    design = {"beams": 300, "edge_radius_um": radius, "budget_samples": 300}
    plan = Plan(load({"devices": {"C1": own}, "design": design}))
    name = plan.devices.tips("C1").name
    changed = [drawn(plan, job_settings(plan, f"devices/contact/tips/edge/{name}_{side}")) for side in SHIFTS]
    plain = job_settings(plan, f"devices/budget/{case_id('C1', humidity)}_tip")["budget"]
    base = drawn(plan, job_settings(plan, f"devices/contact/tips/{name}"))
    found = budget.compute(base, {}, {"edge_radius": tuple(changed)}, {}, {}, budget.budget_settings(plain))
    # Other strips, as long as each edge needs, without common random numbers.
    others = [held(tips(300, radius=share * radius), humidity) for share in (0.5, 1.5)]
    less, more = (risk.safe_length(lengths, 1e-3, stream(0)) for lengths in others)
    expected = np.log(more.estimate / less.estimate) / np.log(3)
    error = np.hypot(less.error / less.estimate, more.error / more.estimate) / np.log(3)
    assert found.input.values.tolist() == ["radius of the edge"]
    assert abs(found.slope.item() - expected) < 3 * np.hypot(error, found.slope_error.item()) < -0.25 * expected
    assert np.sqrt(found.covariance.item()) == pytest.approx(0.3)
