"""Jobs that compute test beams again, of devices in dry and in humid air: each result has the correction of its own."""

import pytest

from stiction.config.files import load
from stiction.plan.planner import Planner
from stiction.run.disk_cache import not_kept
from stiction.stages.devices.contact_names import patch_of
from stiction.stages.test_beams.rerun import _cases

SIZES = {"pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30}


def planner(of_device, of_array):
    """Plan of a lever at some humidities, with cracks of an array at others."""
    cracks = [{"humidity": air, "mean_um": 1000, "std_um": 40, "beams": 10} for air in of_array]
    device = SIZES | {"kind": "cantilever", "humidities": of_device, "test_beams": ["T"]}
    device["uncertainty"] = {"thickness_um": 0.05}
    array = SIZES | {"length_um": 3000, "crack_lengths": cracks}
    changes = {"run": {"pairs": [], "studies": []}}
    changes |= {"contact": {"samples": 2000}, "devices": {"L": device}, "test_beams": {"T": array}}
    return Planner(load(changes), {}, not_kept, not_kept)


@pytest.mark.parametrize(
    ("of_device", "of_array", "stages"),
    [
        ((0.6,), (0.6,), {"by_levels"}),
        (("dry",), ("dry",), {"model_errors"}),
        (("dry", 0.6), (0.6,), {"by_levels", "model_errors"}),
        ((0.6,), ("dry", 0.6), {"by_levels", "model_errors"}),
    ],
)
def test_each_result_has_the_correction_of_its_own_budget(of_device, of_array, stages):
    planned = planner(list(of_device), list(of_array))
    job = planned.job("test_beams_rerun", {"device": "L"})
    assert {name for name in ("by_levels", "model_errors") if job["files"][name]} == stages
    found = {}
    for name in stages:
        _, patches = job["inputs"][name]
        found |= dict(zip(patches, job["files"][name], strict=True))
    for of, case, budget in _cases(planned.plan, "L").values():
        _, own = planned._job_of(f"results/{budget}.nc")
        assert [found[patch_of(of, case).name]] == own["files"]["model_error"]
