"""Exceptions of the package: each survives the way back from another process."""

import copy
import importlib
import multiprocessing
import pickle
import warnings

import pytest
from test_architecture import MODULES

from stiction.errors import NotConverged, ScanError

with warnings.catch_warnings():
    warnings.simplefilter("ignore", ImportWarning)  # of libraries
    _IMPORTED = [importlib.import_module(f"stiction.{name}") for name in MODULES]
EXCEPTIONS = sorted(
    {
        value
        for module in _IMPORTED
        for value in vars(module).values()
        if isinstance(value, type) and issubclass(value, BaseException) and value.__module__.startswith("stiction.")
    },
    key=str,
)
#: Arguments of those that do not take sentences alone.
ARGUMENTS = {NotConverged: ("equilibrium [N]", 1e-3, 1e-9, 50), ScanError: ("a.spm", "files", "is empty")}


def raised(kind):
    """Raise an exception of a class; for another process."""
    raise kind(*ARGUMENTS.get(kind, ("one sentence", "another")))


def same(found, error):
    return type(found) is type(error) and vars(found) == vars(error) and str(found) == str(error)


@pytest.mark.parametrize("kind", EXCEPTIONS, ids=lambda kind: kind.__name__)
def test_every_exception_survives_pickling_and_copies(kind):
    with pytest.raises(kind) as caught:
        raised(kind)
    error = caught.value
    assert str(error)
    assert all(same(found, error) for found in (pickle.loads(pickle.dumps(error)), copy.copy(error)))


def test_all_exceptions_of_the_package_are_tested():
    assert {"NotConverged", "ScanError", "ConfigError", "DataError", "NotPlanned"} <= {k.__name__ for k in EXCEPTIONS}


def test_an_exception_with_a_message_in_place_of_its_arguments_would_not_survive():
    class Lossy(ValueError):
        def __init__(self, file, reason):
            super().__init__(f"{file} {reason}")

    function, arguments, *_ = Lossy("a", "b").__reduce__()
    with pytest.raises(TypeError):
        function(*arguments)


@pytest.mark.slow
def test_a_pool_raises_what_its_processes_raise():
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        for kind in (NotConverged, ScanError):
            with pytest.raises(kind):
                pool.apply_async(raised, (kind,)).get(timeout=120)
