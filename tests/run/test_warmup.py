"""All kernels are compiled before jobs run in parallel."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[2] / "src"
#: Prints the signatures of every kernel, and the kernels that it calls, after the warm-up and after a study as well.
PROGRAM = """
import importlib, json, pkgutil
from numba.core.registry import CPUDispatcher
import stiction
from stiction.run import warmup

kernels = {}
for module in pkgutil.walk_packages(stiction.__path__, "stiction."):
    for value in vars(importlib.import_module(module.name)).values():
        if isinstance(value, CPUDispatcher) and value.targetoptions.get("inline") != "always":
            kernels[f"{value.py_func.__module__}.{value.py_func.__name__}"] = value

def called(kernel):
    named = [kernel.py_func.__globals__.get(name) for name in kernel.py_func.__code__.co_names]
    return [name for name, other in kernels.items() if any(other is one for one in named)]

def signatures():
    return {name: list(map(str, kernel.signatures)) for name, kernel in kernels.items()}

warmup.main()
warm = signatures()
small = {"contact": {"samples": 40}, "chaos": {"order": 3}, "beam": {"samples": 3, "width_um": 6}}
for through in ("water", "none"):
    config = stiction.load(small, {"van_der_waals": through})
    study = stiction.PairStudy.of(config, "b")
    study.energies(0.8)
study.beams(0.8, scatter=0.02)
print(json.dumps([warm, signatures(), {name: called(kernel) for name, kernel in kernels.items()}]))
"""


@pytest.fixture(scope="module")
def compiled():
    """Signatures of all kernels after the warm-up, after a study as well, and the kernels that each of them calls."""
    environment = os.environ | {"PYTHONPATH": str(SOURCE)}
    done = subprocess.run([sys.executable, "-c", PROGRAM], env=environment, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def test_the_warm_up_compiles_every_kernel(compiled):
    warm, _, called = compiled
    assert len(warm) > 30
    ready, found = set(), [name for name, signatures in warm.items() if signatures]
    while found:  # a kernel from the cache includes those it calls, which then have no signature
        ready.add(kernel := found.pop())
        found += set(called[kernel]) - ready
    assert set(warm) - ready == set()


def test_a_study_compiles_nothing_more(compiled):
    warm, used, _ = compiled
    assert used == warm
