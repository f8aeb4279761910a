"""The paper's configuration with single changes, and the problems reported for the result."""

import copy
import importlib.util
import sys
from functools import cache, reduce
from pathlib import Path
from typing import NamedTuple
from unittest.mock import patch

import yaml

from stiction.config.files import read
from stiction.config.merging import merged
from stiction.config.messages import ConfigError
from stiction.config.relations import schema
from stiction.config.surfaces.grid import completed
from stiction.config.validation import checked, normalised
from stiction.surface import maxent

ROOT = Path(__file__).parents[1]
PAPER = completed(read(ROOT / "config.yaml"), {})
SCHEMA = schema()
SOLVED_ONCE = cache(maxent.solve)  # the tests validate thousands of configurations with the same densities


def changed(overlay):
    """The paper's configuration under an overlay in YAML."""
    return merged(PAPER, yaml.safe_load(overlay))


def problems(config):
    """Problems of a configuration, one line each; empty if it is valid."""
    try:
        with patch.object(maxent, "solve", SOLVED_ONCE):
            checked(config)
    except ConfigError as error:
        return error.problems
    return ()


def configured(*overlays):
    """Normal form of the paper's configuration under overlays in YAML, which have no problems."""
    config = reduce(merged, map(yaml.safe_load, overlays), PAPER)
    assert problems(config) == ()
    return normalised(config)


class Leaf(NamedTuple):
    """A key that holds a value."""

    path: tuple
    entry: dict  # its part of the schema
    required: bool

    def __str__(self):
        return ".".join(self.path)


def leaves(config, schema, path=(), required=True):
    """All keys of a configuration that hold a value."""
    if schema["type"] != "object":
        return [Leaf(path, schema, required)]
    leaves_found = []
    for key, value in config.items():
        entry = schema.get("properties", {}).get(key) or schema["additionalProperties"]
        leaves_found += leaves(value, entry, (*path, key), key in schema.get("required", ()))
    return leaves_found


def entries(schema):
    """Every part of the schema that describes a section or a value."""
    inside = [*schema.get("properties", {}).values()]
    inside += [schema[key] for key in ("additionalProperties", "items") if isinstance(schema.get(key), dict)]
    return [schema, *(entry for branch in inside for entry in entries(branch))]


def replaced(path, value):
    """The paper's configuration with another value at a path."""
    config = copy.deepcopy(PAPER)
    section = config
    for key in path[:-1]:
        section = section[key]
    section[path[-1]] = value
    return config


def without(path):
    """The paper's configuration without the key at a path."""
    config = replaced(path, None)
    section = config
    for key in path[:-1]:
        section = section[key]
    del section[path[-1]]
    return config


# One surface, pair or variant represents all.
LEAVES = list({id(leaf.entry): leaf for leaf in reversed(leaves(PAPER, SCHEMA))}.values())[::-1]
NUMBERS = [leaf for leaf in LEAVES if leaf.entry["type"] in ("number", "integer")]


def module(path):
    """Import a module that is not part of the package."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    loaded = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = loaded  # dataclasses look their module up
    spec.loader.exec_module(loaded)
    return loaded
