"""Results of a finished run as a tree of datasets. Numbers are read from their files when they are used."""

from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from xarray.backends import BackendArray
from xarray.core import indexing

from stiction.run import labels
from stiction.run.atomic import DataError

#: Coordinates that tell the files of a folder apart.
_AXES = ("pair", "surface", "relative_humidity", "model", "variant")
#: Attributes that all files of a folder share.
_ATTRIBUTES = ("title", "Conventions", "source", "references")


class _File(NamedTuple):
    """Result file without its numbers."""

    path: Path
    coords: xr.Dataset  #: in memory
    variables: dict[str, xr.Variable]  #: neither coordinates nor numbers in memory


class _Joined(BackendArray):
    """Variable of several files on a grid, in which `None` stands for missing ones. Missing numbers are NaN."""

    def __init__(self, files: np.ndarray, name: str, of_files: Sequence[xr.Variable]):
        self.files, self.name = files, name
        self.sizes = tuple(np.max([variable.shape for variable in of_files], axis=0).astype(int))
        same = len(of_files) == files.size and all(variable.shape == self.sizes for variable in of_files)
        kinds = {variable.dtype.kind for variable in of_files}
        self.dtype = np.dtype(object)
        if kinds <= set("fiub"):
            common = np.result_type(*(variable.dtype for variable in of_files))
            self.dtype = common if same or common.kind == "f" else np.dtype(float)
        self.shape = files.shape + self.sizes

    def __getitem__(self, key: indexing.ExplicitIndexer) -> Any:
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.OUTER, self._read)

    def _read(self, key):
        files = np.array(_outer(self.files, key[: self.files.ndim]), object)
        values = np.array([_outer(self._filled(file), key[self.files.ndim :]) for file in files.flat], self.dtype)
        return values.reshape(files.shape + values.shape[1:])

    def _filled(self, path):
        """Numbers of one file, filled up to the largest size."""
        filled = np.full(
            self.sizes, "" if self.dtype == object else np.nan if self.dtype.kind == "f" else 0, self.dtype
        )
        if path is not None:
            with _opened(path) as dataset:
                if self.name in dataset:
                    values = dataset[self.name].values
                    filled[tuple(map(slice, values.shape))] = values
        return filled


def open(folder: str | Path = "results") -> xr.DataTree:  # noqa: A001 - stiction.open, as xarray.open_dataset
    """Open the results of a finished run, without reading numbers.

    The tree has a node for each folder, such as ``tree["beams"]``. Its files are joined along the coordinates ``pair``,
    ``surface``, ``relative_humidity``, ``model`` and ``variant`` that they have, and combinations without a file are
    NaN. Files that these coordinates do not tell apart, as those of devices, are nodes of their own. A dimension whose
    coordinate differs between files has no index: its coordinate is a variable.

    Raises
    ------
    DataError
        If the folder has no results, or if a file is damaged or was written by another version.
    """
    paths = sorted(Path(folder).rglob("*.nc"), key=lambda path: (path.parent, path.name))
    if not paths:
        raise DataError(f"{folder} holds no datasets; give the folder results of a finished run")
    nodes: dict[str, xr.Dataset] = {}
    for parent, files in groupby(paths, key=lambda path: path.parent):
        for name, dataset in _nodes(parent.relative_to(folder).as_posix(), list(map(_structure, files))):
            above = next((node for node in nodes if name.startswith(f"{node}/")), None)
            nodes[name if above is None else f"{above}_{name[len(above) + 1 :]}"] = dataset
    return xr.DataTree.from_dict(nodes)


def _outer(array, key):
    """Part of an array, axis by axis. An integer removes its axis."""
    for axis in reversed(range(len(key))):
        array = array[(slice(None),) * axis + (key[axis],)]
    return array


def _opened(path):
    """Dataset of a file."""
    return xr.open_dataset(path, engine="netcdf4")


def _structure(path):
    """Structure of a file, after a look at its label."""
    if (label := labels.read(path)).layout != labels.LAYOUT or label.stage is None:
        by = "another version" if label.stage else "another program"
        raise DataError(f"{path} was written by {by}; give the folder results of a run of this version")
    with _opened(path) as dataset:
        coords = dataset.drop_vars(dataset.data_vars).load()
        return _File(path, coords, {name: variable.variable for name, variable in dataset.data_vars.items()})


def _nodes(name: str, files: list[_File]) -> Iterator[tuple[str, xr.Dataset]]:
    """Yield the node of a folder, or those of its files, by name."""
    axes = [axis for axis in _AXES if all(axis in file.coords and not file.coords[axis].ndim for file in files)]
    if axes and len({_coordinates(file, axes) for file in files}) == len(files) and _alike(files):
        yield name, _join(files, axes)
    else:
        for file in files:
            yield f"{name}/{file.path.stem}", _join([file], [])


def _coordinates(file, axes):
    """Values of the coordinates of a file."""
    return tuple(file.coords[axis].item() for axis in axes)


def _alike(files):
    """Whether every variable has the same dimensions in all files."""
    dims = {(name, variable.dims) for file in files for name, variable in _variables(file).items()}
    return len(dict(dims)) == len(dims)


def _variables(file):
    """Variables and coordinates of a file."""
    return file.variables | {name: coord.variable for name, coord in file.coords.coords.items()}


def _join(files: list[_File], axes: list[str]) -> xr.Dataset:
    """Dataset of files along some of their coordinates."""
    coordinates = [_coordinates(file, axes) for file in files]
    values = [sorted(set(column)) for column in zip(*coordinates, strict=True)]
    grid = np.full([len(of_axis) for of_axis in values], None, object)
    for file, position in zip(files, coordinates, strict=True):
        grid[tuple(of_axis.index(value) for of_axis, value in zip(values, position, strict=True))] = file.path
    first = files[0].coords
    shared = [
        name
        for name in first.coords
        if name not in axes and all(first[name].equals(file.coords.get(name)) for file in files)
    ]
    joined = {}
    for name in dict.fromkeys(name for file in files for name in _variables(file)):
        if name not in (*axes, *shared):
            joined[name] = _variable(
                grid, axes, name, [_variables(file)[name] for file in files if name in _variables(file)]
            )
    coords = {axis: (axis, of_axis, first[axis].attrs) for axis, of_axis in zip(axes, values, strict=True)}
    attributes = {name: first.attrs[name] for name in _ATTRIBUTES}
    empty = first.drop_vars([name for name in first.coords if name not in shared]).drop_attrs(deep=False)
    return empty.assign(joined).assign_coords(coords).assign_attrs(attributes)


def _variable(grid, axes, name, of_files):
    """Variable of files along their coordinates, which reads numbers when they are used."""
    data = indexing.LazilyIndexedArray(_Joined(grid, name, of_files))
    return xr.Variable((*axes, *of_files[0].dims), data, of_files[0].attrs)
