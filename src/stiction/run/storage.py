"""Result files: written atomically and labelled with their origin."""

from collections.abc import Iterable
from importlib.metadata import version
from pathlib import Path
from typing import Any

import xarray as xr

from stiction.run import labels
from stiction.run.atomic import DataError, replacing
from stiction.run.variables import described

#: Origin of all files. Equal results have equal bytes, so neither time nor machine is part of it.
_ORIGIN = {
    "Conventions": "CF-1.10",
    "source": f"stiction {version('stiction')}",
    "references": "Hoang, Wu, Golinval, Arnst, Noels: Stochastic multiscale model of MEMS stiction accounting for high "
    "order statistical moments of non-Gaussian contacting surfaces",
}

#: Size of the chunks in which a file is written [bytes].
_CHUNK = 2**20


def save(
    dataset: xr.Dataset, path: str | Path, stage: str, settings: dict[str, Any], inputs: Iterable[str | Path] = ()
) -> None:
    """Write a dataset atomically, described by `stiction.run.variables`, with its stage, its name and its settings.

    :func:`load` checks the stage, and that the file has the name under which it was written. Settings are plain,
    without time and machine, so that equal ones give equal files; those of the datasets from which it was computed, the
    ``inputs``, become part of the label.

    Raises
    ------
    DataError
        If the disk is full, the folder cannot be written or an input cannot be read.
    """
    path = Path(path)
    label = labels.made_from(inputs, stage, path.stem, settings)
    labelled = described(dataset, stage).assign_attrs(_ORIGIN | label.attributes)
    encoding = {name: {"zlib": True, "complevel": 1} for name, values in labelled.items() if values.size > 10_000}
    encoding |= {name: {"_FillValue": None} for name in labelled.coords}  # CF: a coordinate has no missing values
    with replacing(path) as draft:
        _fill(draft, labelled.nbytes + 2**16)  # detects a full disk; HDF5 would not name the cause
        labelled.to_netcdf(draft, engine="netcdf4", encoding=encoding)


def _fill(path, size):
    """Write a file of ``size`` zeros in parts, so large files take no memory."""
    with path.open("wb") as file:
        for start in range(0, size, _CHUNK):
            file.write(bytes(min(_CHUNK, size - start)))


def load(path: str | Path, stage: str, **parts: slice) -> xr.Dataset:
    """Read the dataset of a stage into memory, or a part of a dimension, for example ``strip=slice(100)``.

    Raises
    ------
    DataError
        If the file is truncated, was not written by `save`, or belongs to another stage or case.
    """
    expected = stage, Path(path).stem
    try:
        with xr.open_dataset(path, engine="netcdf4") as dataset:
            label = dataset.attrs.get("stage"), dataset.attrs.get("name")
            layout = dataset.attrs.get("layout")
            loaded = dataset.isel(parts, missing_dims="ignore").load()
    except (OSError, ValueError, RuntimeError, AttributeError) as error:
        raise labels.unreadable(path, error) from error
    if label != expected:
        content = "{} of {}".format(*label) if all(label) else "no result of this study"
        raise DataError(f"{path} holds {content}, not {stage} of {expected[1]}; delete it and start again")
    if layout != labels.LAYOUT:
        raise DataError(f"{path} was written by another version; delete it and start again")
    return loaded
