"""Views of the page of a stopper: forces, stiffnesses and tilts, as its stages state them."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_stage_stoppers import SETTINGS

from stiction.report.devices import explorer
from stiction.stages.devices import stoppers

FORCES = 1e-6 * np.exp(0.2 * np.random.default_rng(4).normal(size=4000))
AXIS = np.linspace(0.5, 0.9, 5)
FACTORS = 1 + AXIS
SECTION = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "humidities": [0.88, 0.67], "tilt_deg": [0, 0.5]}
SPRING, STATED = {"stiffness_N_per_m": 2.0, "gap_um": 0.5}, {"restoring_force_uN": 1.0}


@pytest.fixture(scope="module")
def stopper():
    chosen = (1 + np.array([SETTINGS.humidities]).T) * FORCES
    return stoppers.layout(replace(SETTINGS, restoring_force=1e-6), chosen, AXIS, FACTORS[:, None] * FORCES)


@pytest.mark.parametrize(("stated", "unit"), [(STATED, 1e-6), (SPRING, 0.5e-6)])
def test_a_stopper_has_at_every_humidity_the_forces_or_stiffnesses_of_its_stage(stopper, stated, unit):
    grid = explorer.of_stopper(SECTION | stated, stopper, {}).grid
    key = next(iter(stated))
    assert grid.start[key] == pytest.approx(1e-6 / unit)
    assert grid.start["humidity"] == float(stopper.humidity[1]), "the stated one that holds most"
    for k, humidity in enumerate(AXIS):
        state = grid.start | {"humidity": humidity, "share": 1e-3}
        safe = float(stopper.safe_force_along.sel(share=1e-3)[k]) / unit
        assert grid.safe_size(state) == pytest.approx(safe, rel=1e-9)
        force = FACTORS[k] * np.quantile(FORCES, 0.8)
        share = np.mean(FACTORS[k] * FORCES > force)
        assert grid.stuck(state | {key: force / unit}).share == pytest.approx(share, abs=0.005)
    between = grid.start | {"humidity": 0.65, key: 1.65 * np.median(FORCES) / unit}
    assert grid.stuck(between).share == pytest.approx(0.5, abs=0.02)


def test_a_stopper_with_few_patches_has_fractions_and_no_sufficient_force():
    few = FORCES[:60]
    settings = replace(SETTINGS, restoring_force=1e-6)
    found = stoppers.layout(settings, np.stack([few, 2 * few]), AXIS, FACTORS[:, None] * few)
    grid = explorer.of_stopper(SECTION | STATED, found, {}).grid
    assert np.isnan(grid.safe_size(grid.start))
    assert 0 < grid.stuck(grid.start | {"humidity": 0.5, "restoring_force_uN": 1.5}).share < 1


def test_a_tilted_stopper_is_answered_at_its_tilts_and_humidities_alone(stopper):
    slopes = (0.0, 1e-3, 2e-3)
    settings = stoppers.Tilted(**vars(replace(SETTINGS, restoring_force=1e-6)), slopes=slopes)
    factors = np.array([1, 0.5, 0.25])
    pull_off = factors[:, None, None] * np.stack([FORCES, 2 * FORCES])
    tilted = stoppers.layout_tilted(settings, pull_off, np.array([3e-4, 5e-4]))
    view = explorer.of_tilted("S1", SECTION | STATED, tilted, stopper)
    tilt, humidity = view.grid.axes
    assert_allclose(np.tan(np.radians(tilt.values)), slopes, rtol=1e-5)
    for value, factor in zip(tilt.values, factors, strict=True):
        for k, rh in enumerate(humidity.values):
            force = factor * (1 + k) * np.quantile(FORCES, 0.7)
            state = view.grid.start | {"tilt_deg": value, "humidity": rh, "restoring_force_uN": 1e6 * force}
            assert view.grid.stuck(state).share == pytest.approx(0.3, abs=0.005)
            safe = tilted.safe_force.sel(part="safe", humidity=rh, share=state["share"])
            assert view.grid.safe_size(state) == pytest.approx(1e6 * float(safe[list(factors).index(factor)]), rel=1e-9)
    with pytest.raises(ValueError, match=r"devices\.S1\.tilt_deg changes this"):
        view.grid.safe_size(view.grid.start | {"tilt_deg": 0.01})
