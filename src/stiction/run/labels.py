"""Labels of datasets: stage, name, settings, and the settings of all datasets behind a dataset.

Other results, such as tables, have no place for a label: their logs keep its digest, `origin`.
"""

import hashlib
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from stiction.regular_files import require_regular
from stiction.run.atomic import DataError

#: Version of the names of dimensions and variables in datasets. Files of other versions are computed anew.
LAYOUT = 2


class DatasetLabel(NamedTuple):
    """Origin of a dataset."""

    stage: str | None  #: ``None`` if the file is no result of this study
    name: str | None  #: name under which the file was written, without extension
    settings: dict[str, Any]  #: settings from which the dataset was computed
    before: dict[str, dict[str, Any]]  #: settings of all datasets on which it depends, by file
    layout: int = LAYOUT  #: version of the names in the dataset

    @property
    def attributes(self) -> dict[str, Any]:
        """Label as attributes of a dataset. Equal settings give equal text."""
        texts = {key: json.dumps(getattr(self, key), sort_keys=True) for key in ("settings", "before")}
        return {"stage": self.stage, "name": self.name, "layout": self.layout} | texts


def made_from(inputs: Iterable[str | Path], stage: str, name: str, settings: dict[str, Any]) -> DatasetLabel:
    """Label of a dataset computed by a stage from other datasets.

    Datasets of the same stage are its chunks. They have its settings and are not listed, because their number does not
    affect the result.

    Raises
    ------
    DataError
        If an input cannot be read.
    """
    before = {}
    for path in inputs:
        label = read(path)
        before |= label.before | ({} if label.stage == stage else {Path(path).as_posix(): label.settings})
    return DatasetLabel(stage, name, settings, before)


def digest(value: Any) -> str:
    """SHA-256 of plain numbers, strings, lists and dicts."""
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()


def origin(settings: Any, behind: Mapping[str, str]) -> str:
    """Digest of the settings of a result without a label and of all results behind it, by file.

    Behind it are the digests of the settings of datasets, and the origins of results without a label.
    """
    return digest([settings, dict(behind)])


def read(path: str | Path) -> DatasetLabel:
    """Label of a dataset, without its numbers.

    Raises
    ------
    DataError
        If the file is truncated or no netCDF file.
    """
    import netCDF4  # not needed where the label is known

    try:
        require_regular(path)
        with netCDF4.Dataset(path) as file:
            attributes = {key: file.getncattr(key) for key in file.ncattrs()}
        settings, before = (json.loads(attributes.get(key, "{}")) for key in ("settings", "before"))
    except (OSError, RuntimeError, ValueError, TypeError, AttributeError, RecursionError) as error:
        raise unreadable(path, error) from error
    sections = [settings, before, *(before.values() if isinstance(before, dict) else ())]
    if not all(isinstance(section, dict) for section in sections):
        raise unreadable(path, ValueError("its label holds no settings"))
    return DatasetLabel(
        attributes.get("stage"), attributes.get("name"), settings, before, int(attributes.get("layout", 1))
    )


def unreadable(path: str | Path, reason: Exception) -> DataError:
    """Error of an unreadable dataset, with the remedy."""
    return DataError(f"{path} cannot be read ({reason}); delete it and start again, it will be computed anew")
