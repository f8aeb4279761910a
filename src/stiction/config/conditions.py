"""Relations between keys of a configuration: how they are stated, and which of them a configuration violates."""

import itertools
from collections.abc import Callable
from pathlib import Path

from stiction.config.messages import Problem, dotted, shown


class Relations(list):
    """Keys and relation between their values, for each of some relations; it also is the decorator that adds them."""

    def __call__(self, *keys: str) -> Callable:
        """Add a relation between keys; it is only checked for values that the schema accepts.

        The values are the arguments of the relation, in order; error messages are about the first key. In a key, ``*``
        stands for each name in a section or each index of a list in turn, the same in all keys, ``#`` for the list of
        names in a section, and ``@`` for the name of a section.
        """

        def add(holds):
            self.append((keys, holds))
            return holds

        return add


def violated(relations: Relations, config: dict, faults: list[tuple], files: dict | None = None) -> list[Problem]:
    """Violated relations between keys that are valid on their own.

    Parameters
    ----------
    relations : Relations
    config : dict
        Configuration.
    faults : list of tuple
        Keys that are wrong on their own.
    files : dict, optional
        Files of the measured surfaces by name.
    """
    cases = ((holds, paths) for keys, holds in relations for paths in _spelled_out(keys, config))
    return [problem for holds, paths in cases for problem in _checked(holds, paths, config, faults, files or {})]


def _spelled_out(keys, config):
    """Paths of the keys, for each combination of the members that ``*`` stands for."""
    paths = [tuple(key.split(".")) for key in keys]
    sections = list(dict.fromkeys(path[: path.index("*")] for path in paths if "*" in path))
    choices = itertools.product(*(_members(config, section) for section in sections))
    return [[_chosen(path, dict(zip(sections, choice, strict=True))) for path in paths] for choice in choices]


def _chosen(path, members):
    """Path in which ``*`` is replaced by the chosen member of its section."""
    if "*" not in path:
        return path
    depth = path.index("*")
    return (*path[:depth], members[path[:depth]], *path[depth + 1 :])


def _members(config, path):
    """Names in a section or indices of a list; empty if there is neither."""
    try:
        found = _value(config, path)
    except (KeyError, TypeError):
        return []
    return range(len(found)) if isinstance(found, list) else _names(found)


def _checked(holds, paths, config, faults, files):
    """Problem, if any, of one relation at the values of the paths."""
    if any(_overlap(path, fault) for path in paths for fault in faults):
        return []
    try:
        values = [_value(config, path) for path in paths]
    except KeyError:  # an optional key that is not given
        return []
    message = holds(*values)
    if message is None:
        return []
    path, value = _known(paths[0], values[0], files)
    number = "" if path == paths[0] else f", which gives {paths[0][-1]} = {values[0]:.4g}"
    return [Problem(path, f"is {shown(value)}{number}, {message}{_given(paths, values, files)}")]


def _known(path, value, files):
    """Key and value as given by the user: the numbers of a measured surface come from its files."""
    if path[0] == "surfaces" and path[1] in files:
        return (*path[:2], "scans", "files"), [Path(file).name for file in files[path[1]]]
    return path, value


def _given(paths, values, files):
    """The other values of a violated relation, except names and whole sections of the configuration."""
    given = [
        _known(path, value, files)
        for path, value in zip(paths[1:], values[1:], strict=True)
        if path[-1] not in ("#", "@") and (len(path) > 1 or not isinstance(value, dict))
    ]
    if ("surfaces",) in paths:
        given += [_known(("surfaces", name, "rms_nm"), None, files) for name in files if name in _met(paths, values)]
    others = [f"{dotted(path)} = {shown(value)}" for path, value in given]
    return f" (given {', '.join(dict.fromkeys(others))})" if others else ""


def _met(paths, values):
    """Names among the values of a relation, and those to which the devices and pairs of these names refer."""
    sections = {path: value for path, value in zip(paths, values, strict=True) if isinstance(value, dict)}
    names = {value for value in values if isinstance(value, str)}
    for section in (("devices",), ("pairs",)):
        entries = [entry for name, entry in sections.get(section, {}).items() if name in names]
        names |= {value for entry in entries for value in entry.values() if isinstance(value, str)}
    return names


def _overlap(path, fault):
    """Whether a fault lies at, above or below a path."""
    depth = min(len(path), len(fault))
    return path[:depth] == fault[:depth]


def _value(config, path):
    """Value at a path; ``#`` stands for the names in a section, ``@`` for the name of the section itself."""
    for before, key in zip((None, *path), path, strict=False):
        config = _names(config) if key == "#" else before if key == "@" else config[key]
    return config


def _names(section):
    """Names in a section; empty if it is not a section."""
    return [name for name in section if isinstance(name, str)] if isinstance(section, dict) else []
