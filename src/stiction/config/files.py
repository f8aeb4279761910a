"""Configuration files: reading, overlays on the configuration of the paper, and the normal form."""

import functools
from collections.abc import Mapping
from pathlib import Path

from stiction.config.merging import merged
from stiction.config.reading import read
from stiction.config.relations import validate

#: Configuration of the paper; in a checkout, a link to ``config.yaml`` in the root folder.
PAPER = Path(__file__).with_name("paper.yaml")


def load(*overlays: str | Path | Mapping) -> dict:
    """Configuration of the paper, changed by overlays, checked and in normal form.

    Parameters
    ----------
    *overlays : path of a YAML file, or mapping
        Each changes single keys of the preceding configuration, like ``CONFIG=mine.yaml`` in the workflow.

    Raises
    ------
    ConfigError
        If the configuration is invalid; lists all problems.

    Examples
    --------
    >>> load({"run": {"pairs": ["b"]}})["run"]
    {'pairs': ['b']}
    """
    changes = (overlay if isinstance(overlay, Mapping) else read(overlay) for overlay in overlays)
    config = functools.reduce(merged, changes, read(PAPER))
    validate(config)
    return normalised(config)


@functools.cache
def paper() -> dict:
    """Configuration of the paper, read once, for comparison."""
    return read(PAPER)


def normalised(config: dict) -> dict:
    """Configuration in normal form: equivalent settings are equal, whatever their order in the file.

    Keys are sorted, so that the parameters of a rule do not depend on their order. The humidities of each pair are
    sorted as well, so that tables and curves begin with the lowest.

    Parameters
    ----------
    config : dict
        Complete configuration that `stiction.config.relations.validate` accepts.
    """
    pairs = {name: pair | {"humidities": sorted(pair["humidities"])} for name, pair in config["pairs"].items()}
    return _in_order(config | {"pairs": pairs})


def _in_order(value):
    """Value with the keys of all nested sections sorted."""
    return {key: _in_order(value[key]) for key in sorted(value)} if isinstance(value, dict) else value
