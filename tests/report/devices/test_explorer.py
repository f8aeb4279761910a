"""Explorer of a page: its grid answers as devices of other sizes, in other air, which were not computed for it."""

from dataclasses import replace

import numpy as np
import pytest

import stiction
from stiction.config.cases import case_id
from stiction.report.devices import explorer
from stiction.stages.devices import sticking
from stiction.stages.devices.ground import ground_from

pytestmark = pytest.mark.slow

UM, BEAMS = 1e-6, 300
BEAM = {"kind": "cantilever", "pair": "b", "thickness_um": 2.5, "gap_um": 15, "width_um": 30, "humidities": [0.67]}
SIZES = {"thicknesses_um": [2, 4], "gaps_um": [10, 20], "humidities": [0.6, 0.86]}
SMALL = {
    "contact": {"samples": 60, "chunks": 2, "distance_step_nm": 0.2, "model": "summits"},
    "chaos": {"order": 2},
    "design": {"beams": BEAMS, "shares": [0.05, 0.01], "chart_points": 5},
    "devices": {"C1": BEAM | {"chart": SIZES}},
}
#: Random humidities, sizes at each of them, and fractions and lengths at each of these.
AIRS, OF_AIR, OF_SIZE = 5, 2, 5


@pytest.fixture(scope="module")
def device():
    return stiction.Device.of(stiction.load(SMALL), "C1")


@pytest.fixture(scope="module")
def grid(device):
    charts = {humidity: device.chart(humidity) for humidity in np.linspace(*SIZES["humidities"], 5).round(4).tolist()}
    section = SMALL["devices"]["C1"]
    return explorer.beam_view("C1", section, {0.67: device.safe_lengths(0.67)}, charts, device.answer()).grid


def settings_of(device, humidity):
    """Settings of a chart at a humidity, and its ground."""
    results = device.results
    job = results.graph.job(f"devices/chart/{case_id('C1', humidity)}")
    inputs, settings = results.inputs(job), job.stage.converted(job.settings)
    met = ground_from(inputs["ground"], settings)
    return settings, sticking.with_tips(met, inputs["tips"], humidity, settings.water)


def resized(settings, ground, thickness, gap):
    """Device of another size [µm], and its beams."""
    beam = replace(settings.device, thickness=thickness * UM, gap=gap * UM)
    return beam, sticking.release_beams(beam, ground, settings)


def deviation(found, expected, error):
    """Deviation of a number in units of its standard error, of at least half a percent of the number."""
    return (found - expected) / max(0.005 * abs(expected), error, 1e-12)


def test_random_states_are_those_of_devices_that_were_not_computed_for_the_grid(device, grid):
    rng, far, deviations = np.random.default_rng(7), 0, []
    for _ in range(AIRS):
        humidity = round(rng.uniform(*SIZES["humidities"]), 3)
        settings, ground = settings_of(device, humidity)
        for thickness, gap in zip(rng.uniform(2, 4, OF_AIR), rng.uniform(10, 20, OF_AIR), strict=True):
            beam, released = resized(settings, ground, thickness, gap)
            known = sticking.lengths_without_samples(beam, *settings.flats, released.reach)
            *_, sticks = released.lengths.values()
            for share, rank in zip(rng.uniform(0.01, 0.05, OF_SIZE), rng.uniform(0.03, 0.97, OF_SIZE), strict=True):
                length = np.quantile(sticks, rank, method="lower")
                at = {"humidity": humidity, "thickness_um": thickness, "gap_um": gap}
                state = at | {"share": share, "length_um": length / UM}
                stuck, of_all = grid.stuck(state), np.mean(sticks < length)
                far += abs(stuck.share - grid.stuck(state | {"humidity": SIZES["humidities"][0]}).share) > 0.05
                of_share = deviation(stuck.share, of_all, np.sqrt(of_all * (1 - of_all) / BEAMS))
                *_, (safe,) = sticking.by_shape(released, replace(settings, shares=(share,)), known).values()
                error = 0.0 if np.isnan(safe.error) else safe.error
                deviations.append((of_share, deviation(grid.safe_size(state) * UM, safe.length, error)))
    assert np.shape(deviations) == (50, 2)
    # Of 100 deviations, one of more than three standard errors is expected in a quarter of such tests.
    assert np.abs(deviations).max() < 3
    assert np.sqrt(np.mean(np.square(deviations))) < 1.4
    assert np.mean(deviations, axis=0)[1] < 0.5, "lengths are not on the unsafe side"
    assert far > 10, "the humidity matters"
