"""Configuration files: reading, and overlays on the configuration of the paper."""

import functools
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from stiction.config import scans, test_beams
from stiction.config.merging import merged, without_inherited
from stiction.config.reading import PAPER, paper, read
from stiction.config.surfaces import process
from stiction.config.tables import device_table


def load(*overlays: str | Path | Mapping) -> dict:
    """Configuration of the paper, changed by overlays, checked and in normal form.

    Parameters
    ----------
    *overlays : path of a YAML file, or mapping
        Each changes single keys of the preceding configuration, like ``CONFIG=mine.yaml`` in the workflow. Files of
        scans, test beams and devices are relative to the folder of the YAML file, in a mapping to the current folder.

    Raises
    ------
    ConfigError
        If the configuration is invalid; lists all problems.

    Examples
    --------
    >>> load({"run": {"pairs": ["b"]}})["run"]
    {'pairs': ['b']}
    """
    from stiction.config.validation import checked  # imports the physics, which reading alone does not need

    return checked(joined(*overlays)).config


def joined(*overlays: str | Path | Mapping) -> dict:
    """Configuration of the paper, changed by overlays as in `load`, as it is stated: not checked."""
    changes = [_in_memory(overlay) if isinstance(overlay, Mapping) else read_located(overlay) for overlay in overlays]
    config = functools.reduce(merged, changes, read(PAPER))
    return device_table.with_rows(without_inherited(config, paper(), changes))


def _in_memory(overlay):
    """Mapping as YAML would give it, with the data of test beams in files."""
    content = plain(overlay)
    return test_beams.with_files(content, content, Path())


def plain(value: Any) -> Any:
    """Value as YAML would give it: lists for arrays and tuples, and numbers of Python for those of NumPy.

    A number in single precision becomes the one that it shows.
    """
    if isinstance(value, Mapping):
        return {plain(key): plain(inner) for key, inner in value.items()}
    if getattr(value, "ndim", None) == 0:  # a number or an array of NumPy, which this module need not import
        return float(str(value)) if value.dtype.kind == "f" else value.item()
    return list(map(plain, value)) if isinstance(value, list | tuple) or hasattr(value, "ndim") else value


def read_located(path: str | Path) -> dict:
    """Mapping in one YAML file, with its files as of `located`.

    Raises
    ------
    ConfigError
        As `stiction.config.reading.read`.
    """
    content = read(path)
    return located(content, content, Path(path).parent)


def located(config: dict, named: Mapping[str, Any], folder: str | Path) -> dict:
    """Configuration, valid or not, with the files that one of its files names.

    Those of scans and devices are in the folder of this file, in place of relative to it. Test beams have the data in
    their files.
    """
    config = device_table.in_folder(config, named, folder)
    config = scans.resolve_scan_paths(config, named, folder)
    return test_beams.with_files(process.resolve_scan_paths(config, named, folder), named, folder)
