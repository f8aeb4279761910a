"""Nearest feasible moments of surfaces, kept among the files of this user.

They take 0.6 s for a nearly Gaussian surface, at every change of a file that describes it.
"""

from functools import cache
from typing import Any

from stiction.run.disk_cache import DiskCache
from stiction.run.fingerprint import PACKAGE, fingerprint
from stiction.run.provenance import version_of
from stiction.temporary import own_folder


@cache
def nearest_shape(skewness: float, kurtosis: float) -> tuple[float, float]:
    """Skewness and kurtosis of `stiction.surface.feasible.nearest_feasible`, with its errors, which are not kept.

    Each shape has a file of its own, because processes that write one file lose what the others found.
    """
    remember = DiskCache(own_folder() / "moments" / f"{skewness!r}_{kurtosis!r}.json")
    shape = remember([skewness, kurtosis, _code()], lambda: _computed(skewness, kurtosis))
    remember.save()
    return tuple(shape)


@cache
def _code():
    """Fingerprint of the computation, and version of its library."""
    module = PACKAGE / "surface" / "feasible.py"
    return [fingerprint(module, DiskCache(own_folder() / "code.json"), silent=()), version_of("scipy")]


def _computed(skewness: float, kurtosis: float) -> list[Any]:
    """Nearest feasible moments, computed now."""
    from stiction.surface.feasible import nearest_feasible  # imports SciPy, which a plan of known moments does not need

    nearest = nearest_feasible(skewness, kurtosis)
    return [nearest.skewness, nearest.kurtosis]
