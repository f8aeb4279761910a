"""Datasets keyed by the case in their file names, so that files are never confused because of their order."""

import re
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import xarray as xr

from stiction.config.cases import CASE, humidity_of, pair_of
from stiction.stages.storage import load

#: A case: pair, relative humidity [-] and model.
Case = tuple[str, float, str]


def load_named(paths: Iterable[str | Path], stage: str, key: Callable[[str], Any] = str) -> dict[Any, xr.Dataset]:
    """Datasets of a stage by file name without extension, or by the result of ``key`` for this name."""
    return {key(Path(path).stem): load(path, stage) for path in paths}


def key_of(path: str | Path) -> tuple:
    """Pair, humidity and model of a file such as ``beams/b_rh067_NG.nc``; no model if the file name has none.

    Examples
    --------
    >>> key_of("results/beams/b_rh067_GEO.nc"), key_of("b_rh067.nc")
    (('b', 0.67, 'GEO'), ('b', 0.67))
    """
    case, _, model = re.fullmatch(rf"({CASE})(_(\w+))?", Path(path).stem).groups()
    key = pair_of(case), humidity_of(case)
    return (*key, model) if model else key


def surface_of(name: str) -> str:
    """Surface or pair in a file name such as ``B2_NG``.

    Examples
    --------
    >>> surface_of("B2_NG"), model_of("B2_NG")
    ('B2', 'NG')
    """
    return name.partition("_")[0]


def model_of(name: str) -> str:
    """Model in a file name such as ``B2_NG``."""
    return name.rpartition("_")[2]
