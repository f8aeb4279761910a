"""Configuration files: reading, overlays on the configuration of the paper, and the normal form."""

import functools
from collections.abc import Mapping
from pathlib import Path

import yaml

from stiction.config.merging import merged
from stiction.config.messages import ConfigError, duplicates, shown
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


def read(path: str | Path) -> dict:
    """Mapping in one YAML file.

    Raises
    ------
    ConfigError
        If the file cannot be read, is not a mapping, or contains a key twice.
    """
    try:
        with Path(path).open(encoding="utf-8") as file:
            content = yaml.load(file, _UniqueKeys)
    except Exception as reason:  # PyYAML does not wrap all exceptions: !!bool x raises a KeyError
        raise ConfigError(f"{path} cannot be read: {' '.join(str(reason).split())}") from reason
    if not isinstance(content, dict):
        raise ConfigError(f"{path} holds {shown(content)}, must be sections such as 'contact: {{samples: 5000}}'")
    return content


class _UniqueKeys(yaml.SafeLoader):
    """YAML loader that rejects duplicate keys; PyYAML would silently drop the first value."""

    def construct_mapping(self, node, deep=False):  # noqa: ARG002
        keys = [key for key, _ in node.value if key.tag != "tag:yaml.org,2002:merge"]
        # Deep construction also rejects a mapping that contains itself.
        mapping = super().construct_mapping(node, deep=True)
        for key in duplicates(self.construct_object(key, deep=True) for key in keys):
            raise yaml.constructor.ConstructorError(None, None, f"key {key!r} is given twice", node.start_mark)
        return mapping


_UniqueKeys.add_constructor("tag:yaml.org,2002:map", _UniqueKeys.construct_mapping)


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
