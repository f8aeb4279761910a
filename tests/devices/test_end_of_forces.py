"""The largest pull-off forces of many patches, by brute force, against the line through those of few."""

from functools import cache

import numpy as np
import pytest

import stiction
from stiction.config.units import in_si
from stiction.devices.stoppers import safe_forces
from stiction.plan.graph import Results
from stiction.stages.contact import contact, pairs
from stiction.stages.devices import stoppers
from stiction.stages.surfaces.rough_surfaces import sides_of, surface_inputs

FEW = 1000
BUMP = {"kind": "stopper", "pair": "b", "contact_um": [1.5, 1.5], "restoring_force_uN": 5, "humidities": [0.67]}


@cache
def drawn_forces(patches):
    """Pull-off forces of patches of pair b [N]."""
    results = Results.of(stiction.load({"devices": {"S1": BUMP}}))
    graph, names = results.graph, surface_inputs(results.graph.plan, "b")
    surfaces = sides_of({stage: [results[name] for name in files] for stage, files in names.items()})
    own = in_si(pairs.Settings, graph.job("devices/contact/b_1500x1500").settings)
    settings = in_si(stoppers.Settings, graph.job("devices/stoppers/S1").settings)
    chunks = (range(start, start + 2000) for start in range(0, patches, 2000))
    drawn = (contact.compute(surfaces, "b", "NG", own, chunk) for chunk in chunks)
    return np.concatenate([stoppers.forces(one, 0.67, settings) for one in drawn])


@pytest.mark.parametrize(
    ("patches", "share"),
    [
        pytest.param(20_000, 1e-3, marks=pytest.mark.slow),
        *(pytest.param(60_000, share, marks=pytest.mark.nightly) for share in (1e-3, 1e-4)),
    ],
)
def test_a_line_through_the_largest_forces_of_few_patches_bounds_what_many_hold(patches, share):
    forces = drawn_forces(patches)
    found = safe_forces(forces.reshape(-1, FEW), share, np.random.default_rng(0))
    held = np.array([np.mean(forces > one.force) for one in found])
    assert np.mean(held <= share) > 0.95 - 4 * np.sqrt(0.95 * 0.05 / len(found))
    # On average, the estimates err to the safe side, by less than 15 %.
    true = np.quantile(forces, 1 - share)
    assert 1 < np.mean([one.estimate for one in found]) / true < 1.15
