"""Configuration files: reading, overlays on the configuration of the paper, and the normal form."""

import functools
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from stiction.config import test_beams
from stiction.config.cases import in_numbers
from stiction.config.merging import expanded, merged, without_inherited
from stiction.config.reading import PAPER, paper, read
from stiction.config.scans import complete, resolve_scan_paths
from stiction.config.surfaces import described, process


def load(*overlays: str | Path | Mapping) -> dict:
    """Configuration of the paper, changed by overlays, checked and in normal form.

    Parameters
    ----------
    *overlays : path of a YAML file, or mapping
        Each changes single keys of the preceding configuration, like ``CONFIG=mine.yaml`` in the workflow. Files of
        scans and of test beams are relative to the folder of the YAML file, in a mapping to the working directory.

    Raises
    ------
    ConfigError
        If the configuration is invalid; lists all problems.

    Examples
    --------
    >>> load({"run": {"pairs": ["b"]}})["run"]
    {'pairs': ['b']}
    """
    # Imports the physics, which reading alone does not need.
    from stiction.config.surfaces.grid import completed
    from stiction.config.validation import validate

    config = joined(*overlays)
    estimates = validate(config)
    return normalised(completed(normalised(config), estimates))


def joined(*overlays: str | Path | Mapping) -> dict:
    """Configuration of the paper, changed by overlays as in `load`, as it is: neither checked nor in normal form."""
    changes = [_in_memory(one) if isinstance(one, Mapping) else located(one) for one in overlays]
    whole = functools.reduce(merged, changes, read(PAPER))
    return process.with_surfaces(expanded(without_inherited(whole, paper(), changes)))


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


def located(path: str | Path) -> dict:
    """Mapping in one YAML file, with the files of scans relative to its folder and the data of test beams in files.

    Raises
    ------
    ConfigError
        As `stiction.config.reading.read`.
    """
    content = read(path)
    folder = Path(path).parent
    located = process.resolve_scan_paths(resolve_scan_paths(content, content, folder), content, folder)
    return test_beams.with_files(located, content, folder)


def normalised(config: dict) -> dict:
    """Complete and valid configuration in normal form: equivalent settings are equal, whatever their order in the file.

    Keys are sorted, so that the parameters of a rule do not depend on their order. The humidities of each pair and
    device are sorted as well, so that tables and curves begin with the lowest. Surfaces by scans, or described as in
    papers, get all their keys. Dry air has the humidity 0. Data of test beams are without the files of their beams.
    """
    config = in_numbers(test_beams.without_files(config))
    named = {section: config[section] for section in ("pairs", "devices") if section in config}
    library = paper()["surfaces"]
    surfaces = {name: complete(described.complete(entry, library)) for name, entry in config["surfaces"].items()}
    in_order = {section: _sorted(entries) for section, entries in named.items()}
    return _in_order(config | in_order | {"surfaces": surfaces})


def _sorted(entries):
    """Pairs or devices with their humidities sorted."""
    return {name: entry | {"humidities": sorted(entry["humidities"])} for name, entry in entries.items()}


def _in_order(value):
    """Value with the keys of all nested sections sorted."""
    return {key: _in_order(value[key]) for key in sorted(value)} if isinstance(value, dict) else value
