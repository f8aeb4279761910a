"""The Python interface in several processes: what is sent to them, and what comes back."""

import json
import pickle
import subprocess
import sys

import pytest
import xarray as xr

import stiction

#: Configuration of a small pair and a small device.
CHANGES = {
    "contact": {"samples": 12},
    "beam": {"samples": 2, "width_um": 6},
    "chaos": {"order": 1},
    "devices": {
        "S1": {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "restoring_force_uN": 1, "humidities": [0.5]}
    },
}
#: A user's script: beams over humidities, and beams that do not converge, in pools and executors of all kinds.
SCRIPT = """
import concurrent.futures
import functools
import json
import multiprocessing
import sys
from unittest import mock

import numpy as np

import stiction
from stiction.beam import equilibrium
HUMIDITIES = (0.8, 0.67)


def lengths(study, humidity):
    return study.beams(humidity).crack_length.values


def without_end(study, humidity):
    with mock.patch.object(equilibrium, "allowed_imbalance", return_value=-1.0):
        return lengths(study, humidity)


if __name__ == "__main__":
    study = stiction.PairStudy.of(stiction.load(json.loads(sys.argv[1])), "b")
    here = [lengths(study, humidity) for humidity in HUMIDITIES]
    for method in ("fork", "spawn"):
        context = multiprocessing.get_context(method)
        with context.Pool(1) as pool, concurrent.futures.ProcessPoolExecutor(1, context) as executor:
            there = pool.map_async(functools.partial(lengths, study), HUMIDITIES).get(60)
            np.testing.assert_array_equal(there, here)
            there = executor.map(functools.partial(lengths, study), HUMIDITIES, timeout=60)
            np.testing.assert_array_equal(list(there), here)
            asked = pool.apply_async(without_end, (study, 0.8)), executor.submit(without_end, study, 0.8)
            for answer in (asked[0].get, asked[1].result):
                try:
                    answer(60)
                except RuntimeError as error:
                    print(method, type(error).__name__, *error.__notes__)
"""


def test_a_study_and_a_device_that_were_used_are_the_same_in_another_process():
    config = stiction.load(CHANGES)
    study, device = stiction.PairStudy.of(config, "b"), stiction.Device.of(config, "S1")
    beams, forces = study.beams(0.8), device.forces()
    study_there, device_there = pickle.loads(pickle.dumps([study, device]))
    assert study_there.results._datasets.keys() == study.results._datasets.keys(), "what is known is not computed again"
    xr.testing.assert_identical(study_there.beams(0.8), beams)
    xr.testing.assert_identical(device_there.forces(), forces)


@pytest.mark.slow
def test_beams_in_other_processes_are_those_of_this_one_and_those_without_end_raise_their_error(tmp_path):
    (tmp_path / "script.py").write_text(SCRIPT)
    done = subprocess.run(
        [sys.executable, tmp_path / "script.py", json.dumps(CHANGES)], capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr
    ends = [f"{method} NotConverged in beam 0" for method in ("fork", "spawn") for _ in range(2)]
    assert done.stdout.splitlines() == ends
