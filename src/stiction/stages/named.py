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


def key_of(name: str) -> tuple:
    """Pair, humidity and model or variant in a file name such as ``b_rh067_NG``; only the first two if it ends there.

    Examples
    --------
    >>> key_of("b_rh067_GEO"), key_of("b_rh067_van_der_waals_dry"), key_of("b_rh067")
    (('b', 0.67, 'GEO'), ('b', 0.67, 'van_der_waals_dry'), ('b', 0.67))
    """
    case, _, rest = re.fullmatch(rf"({CASE})(_(.+))?", name).groups()
    key = pair_of(case), humidity_of(case)
    return (*key, rest) if rest else key


def surface_and_model(name: str) -> tuple[str, str]:
    """Surface or pair, and model, in a file name such as ``B2_NG``.

    Examples
    --------
    >>> surface_and_model("B2_NG")
    ('B2', 'NG')
    """
    surface, _, model = name.partition("_")
    return surface, model


def surface_of(name: str) -> str:
    """Surface in a file name such as ``B2_NG``."""
    return surface_and_model(name)[0]


def model_of(name: str) -> str:
    """Model in a file name such as ``B2_NG``."""
    return surface_and_model(name)[1]


def after_pair(name: str) -> str:
    """What follows the pair in a file name: a moment, a surface or a choice.

    Examples
    --------
    >>> after_pair("b_skewness"), after_pair("b_Sub1")
    ('skewness', 'Sub1')
    """
    return name.partition("_")[2]


def surface_and_quantity(name: str) -> tuple[str, str]:
    """Surface and quantity in the file name of a contact with less or more of it.

    Examples
    --------
    >>> surface_and_quantity("b_B2_rms_less"), surface_and_quantity("b_1500x30000_B2_rms_less")
    (('B2', 'rms'), ('B2', 'rms'))
    """
    *_, surface, quantity, _ = name.split("_")
    return surface, quantity


def side_of(name: str) -> str:
    """Side in the file name of a contact with less or more of a quantity.

    Examples
    --------
    >>> side_of("b_1500x30000_less")
    'less'
    """
    return name.rpartition("_")[2]


def after_patch(name: str) -> str:
    """Choice of the model in the file name of a contact on patches.

    Examples
    --------
    >>> after_patch("b_1500x30000_van_der_waals_dry")
    'van_der_waals_dry'
    """
    return name.split("_", 2)[2]
