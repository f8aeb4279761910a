"""Results change as little as the numbers of the configuration do: no number is a hidden switch."""

import sys
from pathlib import Path

import numpy as np
import pytest

from stiction.analysis.mesh import whole_meshes
from stiction.config.files import load
from stiction.config.merging import merged
from stiction.config.reading import paper
from stiction.plan.graph import Results

sys.path.insert(0, str(Path(__file__).parents[1] / "plan"))
from test_small_changes import STEP, can_change, is_humidity, numbers, shifted  # noqa: E402

#: The paper's pair b with few samples, because in about one strip of a hundred two neighbouring heights are so near to
#: each other that a summit appears or vanishes.
SMALL = merged(
    paper(),
    {
        "run": {"pairs": ["b"]},
        "pairs": {"b": {"humidities": [0.67]}},
        "figures": {"humidity": 0.67, "humidity_points": 5},
        "contact": {"samples": 40},
        "chaos": {"order": 3},
        "beam": {"samples": 6, "width_um": 6},
        "character": {"strips": 3},
        "identification": {"patches": 2, "patch_um": 2},
        "studies": {
            "iteration": {"iterations": 2, "fields": 2},
            "sensitivity": {"samples": 3, "step": 0.08},
            "plasticity": {"strips": 4},
            "orders": {"draws": 2000},
            "resampling": {"beams": 3},
            "mesh": {"elements_um": [15, 7.5], "strips_um": [7.5, 1.5]},
            "variants": {
                "samples": 20,
                "beams": 2,
                "van_der_waals": ["dry"],
                "psd": [],
                "every": [],
                "spacing_nm": [],
                "poisson_ratio": [],
                "strips_per_element": [],
            },
        },
    },
)
#: How far iterations were from their end, near the precision of a number.
RESIDUALS = {"imbalance", "iterations", "energy_error"}


def results(config):
    """Values of all variables of the datasets of a run, by dataset and variable."""
    found = Results.of(load(config))
    kept = (job for job in found.graph.needed("tables", "figures") if job.stage.save is None)
    names = sorted({name for job in kept if not job.stage.running.temporary for name in job.names})
    return {(name, key): value.values for name in names for key, value in found[name].data_vars.items()}


def changes(before, after):
    """Largest change of each variable with numbers, relative to its largest value."""
    assert before.keys() == after.keys()
    numeric = {key for key, value in before.items() if value.dtype.kind in "fi" and key[1] not in RESIDUALS}
    return {key: change for key in numeric if (change := _change(before[key], after[key])) > 0}


def _change(value, other):
    """Largest difference relative to the largest value, infinite if there are other values than before."""
    if value.shape != other.shape or not np.array_equal(np.isfinite(value), np.isfinite(other)):
        return np.inf
    known = np.isfinite(value)
    largest = np.abs(value, where=known, out=np.zeros(value.shape)).max(initial=0)
    return (
        float(np.abs(value - other, where=known, out=np.zeros(value.shape)).max(initial=0) / largest) if largest else 0
    )


@pytest.fixture(scope="module")
def unchanged():
    return results(SMALL)


@pytest.mark.slow
def test_small_changes_of_all_numbers_are_small_changes_of_all_results(unchanged):
    keys = {path for path, value in numbers(SMALL) if can_change(path, value) and not is_humidity(path)}
    found = changes(unchanged, results(shifted(SMALL, keys)))
    assert len(found) > 100
    assert {key: change for key, change in found.items() if change > 1000 * STEP} == {}


@pytest.mark.slow
def test_a_switch_is_found(unchanged):
    found = changes(unchanged, results(merged(SMALL, {"pairs": {"b": {"attraction": "all"}}})))
    assert found["beams/b_rh067_NG", "crack_length"] > 1e-3


@pytest.mark.parametrize("place", range(4))
def test_a_length_that_fits_no_mesh_leaves_all_other_meshes_as_they_were(place):
    study, length = paper()["studies"]["mesh"], paper()["beam"]["length_um"]
    strips = [one * (1 + STEP * (k == place)) for k, one in enumerate(study["strips_um"])]
    before, after = (list(whole_meshes(length, study["elements_um"], each)) for each in (study["strips_um"], strips))
    assert after == [mesh for mesh in before if mesh[1] != study["strips_um"][place]]
    assert 0 < len(after) < len(before)
