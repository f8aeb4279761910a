"""Order of the numbers of a device: a smaller fraction, more water, more touchdowns or a voltage allow no longer beam.

Bounds of one table rest on other fits and samples. Drawn devices show how often they contradict each other by chance.
"""

from dataclasses import replace
from functools import cache
from unittest.mock import patch

import numpy as np
import pytest
import small
import xarray as xr
from answers import stopper_dataset
from ground import SURFACES, WATER, lognormal_cracks, smooth_tips, wanted
from lives import OF, STOPPER
from test_stage_life import answers, at_voltage

from stiction.config.files import load
from stiction.contact.correction import NONE
from stiction.contact.voltage import Dielectric
from stiction.devices.risk import in_order
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.stages.contact import curves
from stiction.stages.devices import safe_lengths, sticking, stoppers
from stiction.stages.devices.opening import S_SHAPE
from stiction.streams import stream

#: Fractions in no order.
SHARES = (1e-3, 5e-2, 1e-4, 1e-2)
DRAWS = 16


@cache
def drawn(number, shares=SHARES, factor=1.0):
    """Safe lengths of a drawn cantilever with few beams, at an energy of its strips that is larger by a factor."""
    rng = stream(67, "order", number)
    beams, spread = int(rng.integers(200, 700)), float(rng.uniform(0.01, 0.3))
    tips = 2e-2 * np.exp(rng.uniform(0.1, 2.0) * rng.standard_normal(beams) - rng.uniform(0, 8))
    cracks = lognormal_cracks(number=beams, spread=spread, seed=number, surfaces=SURFACES)
    cracks = cracks.assign(crack_length=cracks.crack_length * factor**-0.25, mean_energy=factor * cracks.mean_energy)
    with patch.object(curves, "tip_forces", lambda *_: smooth_tips(tips)):
        return safe_lengths.compute(cracks, wanted(shares=shares), xr.Dataset())


def is_ordered(dataset):
    """Whether no length is longer than one for a larger fraction, or with fewer ways to stick."""
    lengths = dataset.safe_length.sortby("share")
    return bool((lengths.diff("share") >= 0).all() and (lengths.diff("shape") <= 0).all())


def test_a_smaller_fraction_and_a_further_way_to_stick_never_allow_longer_beams():
    assert all(is_ordered(drawn(number)) for number in range(DRAWS))
    with patch.object(sticking, "_in_order", lambda found: found):
        assert not all(is_ordered(drawn.__wrapped__(number)) for number in range(DRAWS)), "by their fits alone, some do"


def test_order_only_shortens_and_keeps_what_is_unknown():
    rng = np.random.default_rng(1)
    lengths = rng.uniform(size=(50, 2, len(SHARES)))
    lengths[rng.uniform(size=lengths.shape) < 0.1] = np.nan
    ordered = in_order(lengths, SHARES)
    assert np.all((ordered <= lengths) | np.isnan(lengths))
    assert np.array_equal(np.isnan(ordered), np.isnan(lengths))
    for row, column in np.ndindex(2, len(SHARES)):
        # Each is the least of all that it must not exceed: a larger fraction, the same way to stick or one less.
        others = lengths[:, : row + 1][:, :, np.array(SHARES) >= SHARES[column]].reshape(50, -1)
        known = ~np.isnan(ordered[:, row, column])
        assert np.array_equal(ordered[known, row, column], np.nanmin(others[known], axis=1))


@pytest.mark.parametrize("factor", [1.0, 1.05])
def test_cracks_in_wetter_air_are_never_longer_where_strips_hold_more(factor):
    longer = 0
    for number in range(DRAWS):
        drier, wetter = drawn(number), drawn(number + DRAWS, factor=factor)
        found = safe_lengths.no_longer_than_in_drier_air(wetter, drier)
        longer += bool((wetter.safe_length > drier.safe_length).sel(shape=S_SHAPE).any())
        assert is_ordered(found)
        assert bool((found.safe_length <= drier.safe_length).sel(shape=S_SHAPE).all())
    assert longer, "by their samples alone, some are"


def test_strips_that_hold_less_in_wetter_air_and_bridges_are_left_as_they_are():
    drier, wetter = drawn(1), drawn(2, factor=0.9)
    xr.testing.assert_identical(safe_lengths.no_longer_than_in_drier_air(wetter, drier), wetter)
    xr.testing.assert_identical(safe_lengths.no_longer_than_in_drier_air(wetter, None), wetter)
    devices = {
        "C": {"kind": "cantilever", "thickness_um": 2, "gap_um": 2, "humidities": [0.8, "dry", 0.5]},
        "B": {"kind": "bridge", "residual_stress_MPa": 50, "thickness_um": 2, "gap_um": 2, "humidities": [0.5, 0.8]},
    }
    graph = Graph(Plan(load({"devices": {name: {"pair": "b", "width_um": 5} | one for name, one in devices.items()}})))
    drier = {
        case: graph.job(f"devices/safe_lengths/{case}").inputs.get("drier")
        for case in ("C_rh080", "C_rh050", "C_dry", "B_rh080")
    }
    assert drier == {"C_rh080": "devices/safe_lengths/C_rh050", "C_rh050": None, "C_dry": None, "B_rh080": None}


def test_every_strip_of_pair_b_holds_more_in_wetter_air_but_no_patch_pulls_more():
    # The second route to the order of cracks: from RH 0.4 on, the energy of each strip grows, but not its attraction.
    contact, airs = small.contact_of_pair(), (0.4, 0.5, 0.67, 0.8, 0.9, 0.95)
    energies, forces = (
        np.array([of(contact, humidity, WATER) for humidity in airs]) for of in (curves.energies, curves.pull_offs)
    )
    assert np.all(np.diff(energies, axis=0) > 0)
    assert not np.all(np.diff(forces, axis=0) > 0)


@pytest.fixture(scope="module")
def lengths():
    return {0.44: drawn(3, (1e-2, 1e-3)), 0.67: drawn(4, (1e-2, 1e-3))}


@pytest.mark.parametrize("seed", range(20))
def test_a_voltage_and_more_touchdowns_never_allow_longer_beams(lengths, seed):
    rng = np.random.default_rng(seed)
    chance = {humidity: float(np.exp(0.1 * rng.standard_normal())) for humidity in lengths}
    of = replace(OF, voltage=float(rng.uniform(0.1, 10)), touchdowns=1000, dielectric=Dielectric(100e-9, 4.0))
    other = {key: at_voltage({key: one}, chance[key], 1e-6)[key] for key, one in lengths.items()}
    found = answers(of, lengths, after=other, biased=other)
    least = min(one.low for name, one in found.items() if name.startswith("safe_length"))
    for name in ("at_voltage", "after"):
        assert found[name].low <= found[name].high <= least
    by_chance = min(float(one.safe_length.isel(share=1).min()) for one in other.values())
    assert found["after"].low == min(by_chance, least)
    assert found["after"].high == least


def test_a_voltage_never_frees_stoppers():
    rng, dataset = np.random.default_rng(3), stopper_dataset()
    of, most = replace(STOPPER, voltage=5.0, dielectric=Dielectric(100e-9, 4.0)), []
    without = max((one.low, one.high) for name, one in answers(of).items() if name.startswith("stuck_0"))
    for _ in range(10):
        stuck = np.clip(dataset.stuck + 0.02 * rng.standard_normal(), 0, 1)
        biased = dataset.assign(stuck=stuck, freeing_potential=0 * dataset.pull_off)
        at = answers(of, biased=biased)["stuck_at_voltage"]
        assert (at.low, at.high) >= without
        most.append(float(stuck.sel(bound="low").max()) < without[0])
    assert any(most), "by chance, some do"


def test_a_smaller_fraction_of_stoppers_never_needs_less_force():
    contradicted = 0
    for seed in range(DRAWS):
        rng = np.random.default_rng(seed)
        forces = np.exp(0.1 * rng.standard_normal((3, 350)))
        forces[:, 0] *= rng.uniform(1, 3)  # one patch that holds more than all others
        found, _ = stoppers._safe(forces, seed, [NONE] * 3)
        assert np.all(np.diff(found[0], axis=1) >= 0)
        with patch.object(stoppers, "in_order", lambda values, _: values):
            contradicted += bool(np.any(np.diff(stoppers._safe(forces, seed, [NONE] * 3)[0][0], axis=1) < 0))
    assert contradicted, "by order statistic and fit alone, some do"
