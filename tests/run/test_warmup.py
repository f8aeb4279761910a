"""Kernels of the paper are compiled before jobs run in parallel."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from stiction.run import warmup

#: Modules of studies that the paper does not need: the first of their jobs compile the kernels.
OF_STUDIES = {
    "stiction.contact.regions",
    "stiction.surface.islands",
}
SOURCE = Path(__file__).parents[2] / "src"
#: Prints the signatures of every kernel, and the kernels that it calls, after the warm-up and after a study as well.
PROGRAM = """
import importlib, json, pkgutil
from numba.core.registry import CPUDispatcher
import stiction
from stiction.beam import tension
from stiction.devices import bridges
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

warmed = []
for part in warmup.PARTS:
    before = signatures()
    part()
    warmed.append([name for name, found in signatures().items() if found != before[name]])
warm = signatures()
small = {"contact": {"samples": 40}, "chaos": {"order": 3}, "beam": {"samples": 3, "width_um": 6}}
for through in ("water", "none"):
    config = stiction.load(small, {"van_der_waals": through})
    study = stiction.PairStudy.of(config, "b")
    study.energies(0.8)
study.beams(0.8, scatter=0.02)
tension.release_rate(1e-4, bridges.half_of_bridge(study.beam, 5e7))
calls = {name: called(kernel) for name, kernel in kernels.items()}
print(json.dumps([warm, signatures(), calls, warmed]))
"""


@pytest.fixture(scope="module")
def compiled():
    """Signatures of all kernels after the warm-up and after a study as well, calls of each, kernels of each part."""
    environment = os.environ | {"PYTHONPATH": str(SOURCE)}
    done = subprocess.run([sys.executable, "-c", PROGRAM], env=environment, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def with_those_they_call(kernels, called):
    """Kernels and all that they call: one from the cache includes those it calls, which then have no signature."""
    ready, found = set(), list(kernels)
    while found:
        ready.add(kernel := found.pop())
        found += set(called[kernel]) - ready
    return ready


@pytest.mark.slow
def test_the_warm_up_compiles_every_kernel_that_the_paper_needs(compiled):
    warm, _, called, parts = compiled
    paper = {name for name in warm if name.rpartition(".")[0] not in OF_STUDIES}
    assert len(paper) > 30
    assert paper - with_those_they_call(sum(parts, []), called) == set()


@pytest.mark.slow
def test_no_kernel_is_compiled_by_two_parts_of_the_warm_up_which_run_at_the_same_time(compiled):
    _, _, called, parts = compiled
    compiled_by = [with_those_they_call(part, called) for part in parts]
    assert sum(map(len, compiled_by)) == len(set().union(*compiled_by))


def caches(folder):
    """Names and contents of the indices of a cache of compiled kernels."""
    return {path.name: path.read_bytes() for path in folder.rglob("*.nbi")}


#: Prints how many passes of the compiler ran in this process during the warm-up, and how often a kernel is loaded then.
WARM_UP = """
from numba.core.event import RecordingListener, install_listener
from stiction.beam.tension import end_stiffness
from stiction.run import warmup

passes = RecordingListener()
with install_listener("numba:run_pass", passes):
    warmup.main()
print(len(passes.buffer), len(end_stiffness.signatures))
"""


@pytest.mark.nightly
def test_the_warm_up_compiles_in_other_processes_and_leaves_all_kernels_in_the_cache(tmp_path):
    environment = os.environ | {"PYTHONPATH": str(SOURCE), "NUMBA_CACHE_DIR": str(tmp_path)}
    for _ in range(2):
        before = caches(tmp_path)
        command = [sys.executable, "-c", WARM_UP]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
        assert done.stdout == "0 1\n"
    assert len(before) > 30
    assert caches(tmp_path) == before  # the second time nothing was compiled


def broken():
    raise ValueError("this part cannot be compiled")


# Workers of pytest have threads; the warm-up itself runs in processes that have none.
@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded:DeprecationWarning")
@pytest.mark.parametrize("parts", [(broken,), (int, broken)], ids=["other process", "this process"])
def test_an_error_of_a_part_is_an_error_of_the_warm_up(monkeypatch, parts):
    monkeypatch.setattr(warmup, "PARTS", parts)
    with pytest.raises(ValueError, match="this part cannot be compiled"):
        warmup.main()


@pytest.mark.slow
def test_a_study_and_a_bridge_compile_nothing_more(compiled):
    warm, used, _, _ = compiled
    assert used == warm
