"""Settings of all tests."""

import gc
import os
import pickle

import pytest
from hypothesis import settings

# Need libraries of the extra peers.
collect_ignore = ["benchmarks/peers.py", "benchmarks/peer_chain.py"]

# Nearly everything that a collection of thousands of tests creates remains; looking for garbage takes a quarter of it.
gc.disable()

# No deadline, because machines are shared and timings vary; the same examples in every run.
settings.register_profile("steady", deadline=None, derandomize=True)
settings.load_profile("steady")

# One thread for each process, as in jobs: with a process on every core, more threads only wait for each other.
for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "DUCC0_NUM_THREADS"):
    os.environ.setdefault(name, "1")

# The output of a process is buffered, as that of most users is.
os.environ.pop("PYTHONUNBUFFERED", None)


def pytest_collection_finish():
    """Look for garbage again, but not among what was created so far."""
    gc.freeze()
    gc.enable()


def pytest_collection_modifyitems(items):
    """Begin with the files that take longest, so that no process works alone at the end."""
    first = ["test_reruns.py", "test_run.py", "test_surface_estimate.py", "test_resume.py", "test_scan_uncertainty.py"]
    first += ["test_docs.py", "test_documented.py", "test_feasible.py", "test_messages.py"]
    first += ["test_study.py", "test_device.py", "test_wheel.py"]
    items.sort(key=lambda item: (item.path.name not in first, item.path.parent.name != "workflow"))


@pytest.fixture(autouse=True, scope="session")
def spectra_on_grids():
    """Invert the translation once for each surface and grid, which takes 0.2 s: many tests begin with the same ones."""
    from stiction.stages.surfaces import heights, spectrum

    spectra, on_grid = {}, spectrum.on_grid

    def remembered(target, heights_of_surface, spacing):
        key = pickle.dumps((target, heights.density(heights_of_surface, "NG"), spacing))
        if key not in spectra:
            spectra[key] = on_grid(target, heights_of_surface, spacing)
        return spectra[key].copy(deep=True)

    spectrum.on_grid = remembered
    yield
    spectrum.on_grid = on_grid


@pytest.fixture
def any_variable(monkeypatch):
    """Datasets of made-up stages, whose variables have no row in the table."""
    from stiction.run import variables

    monkeypatch.setattr(variables, "_row", lambda stage, name: variables.VariableAttributes("1", "", "", name or stage))


@pytest.fixture
def through_a_file(tmp_path, any_variable):  # noqa: ARG001
    """The dataset that comes back from the file of another."""
    from stiction.run import storage

    def through(dataset):
        storage.save(dataset, tmp_path / "name.nc", "stage", {})
        return storage.load(tmp_path / "name.nc", "stage")

    return through
