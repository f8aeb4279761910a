"""Changes of single keys of a configuration or of the settings of a job, and copies of entries with other values.

``compare: {surfaces.B2.rms_nm: [3, 5]}`` makes the surfaces B2Rms3 and B2Rms5, the pairs bRms3 and bRms5 of each pair b
on B2, and so on. Several keys change together, each copy with the values at one place of their lists. The copies are
entries like any others: nothing else knows of the section but tables and figures.
"""

from collections.abc import Mapping, Sequence
from functools import reduce
from itertools import chain
from operator import getitem
from typing import Any

from stiction.config.messages import ConfigError
from stiction.config.units import without_unit

#: Sections whose entries may be copied, each after those that it names, and the keys by which it names these.
_NAMED = {
    "materials": {},
    "surfaces": {"material": "materials"},
    "process": {"surface": "surfaces", "together_with": "process"},
    "pairs": {"beam": "surfaces", "substrate": "surfaces"},
    "test_beams": {"pair": "pairs", "probe": "devices"},
    "devices": {
        "pair": "pairs",
        "test_beams": "test_beams",
        "surface": "surfaces",
        "process": "process",
        "second_process": "process",
    },
}


def section_at(config: Any, *keys: str) -> Mapping[str, Any]:
    """Section of a configuration, valid or not, below some keys. Empty if there is none, or no section in its place.

    Examples
    --------
    >>> section_at({"pairs": {"b": {"gap_um": 20}}}, "pairs", "b"), section_at({"pairs": 5}, "b"), section_at(5)
    ({'gap_um': 20}, {}, {})
    """
    for key in keys:
        config = config.get(key) if isinstance(config, Mapping) else None
    return config if isinstance(config, Mapping) else {}


def texts(value: Any) -> list[str]:
    """List of texts in a configuration, valid or not. Empty if anything else is in its place.

    Examples
    --------
    >>> texts(["a.csv", "b.csv"]), texts(["a.csv", 5]), texts("a.csv")
    (['a.csv', 'b.csv'], [], [])
    """
    return value if isinstance(value, list) and all(isinstance(text, str) for text in value) else []


def merged(base: Any, overlay: Any) -> Any:
    """Mapping ``base`` changed key by key, as Snakemake does. Lists and numbers are replaced as a whole."""
    if not (isinstance(base, Mapping) and isinstance(overlay, Mapping)):
        return overlay
    return {**base, **{key: merged(base.get(key), value) for key, value in overlay.items()}}


#: Keys of a pair of the paper that make its results those of the paper. Attraction across gaps is left out, which is
#: the unsafe side on other surfaces.
_OF_PAPER = ("attraction", "coarser_mesh")


def without_inherited(config: dict[str, Any], base: Mapping[str, Any], overlays: Sequence[Any]) -> dict[str, Any]:
    """Configuration in which a pair of other surfaces than that of its name in ``base`` has no key for the paper alone.

    What an overlay states itself stays.
    """
    pairs = dict(section_at(config, "pairs"))
    for name in [name for name in base["pairs"] if section_at(pairs, name)]:
        pair_of_paper, stated = base["pairs"][name], (section_at(overlay, "pairs", name) for overlay in overlays)
        changed = dict(chain.from_iterable(pair.items() for pair in stated))
        if any(changed.get(side, pair_of_paper[side]) != pair_of_paper[side] for side in ("beam", "substrate")):
            pairs[name] = {key: value for key, value in pairs[name].items() if key in changed or key not in _OF_PAPER}
    return config | {"pairs": pairs} if pairs else config


# Values of one key, or of several together, side by side


def values(config: Mapping[str, Any]) -> dict[str, tuple[float, ...]]:
    """Compared values by the ends of the names of their copies, in alphabetical order of their keys.

    Empty without the section.

    Examples
    --------
    >>> values({"compare": {"surfaces.B2.rms_nm": [3, 2.5]}})
    {'Rms3': (3,), 'Rms2p5': (2.5,)}
    >>> values({"compare": {"surfaces.B2.skewness": [-0.5, 0], "surfaces.B2.kurtosis": [3.4, 3]}})
    {'Kurtosis3p4Skewnessm0p5': (3.4, -0.5), 'Kurtosis3Skewness0': (3, 0)}
    """
    together = zip(*([(path, value) for value in listed] for path, listed in _compared_keys(config)), strict=False)
    return {"".join(map(_end, numbers)): tuple(value for _, value in numbers) for numbers in together}


def _compared_keys(config):
    """Compared keys with their values, in alphabetical order."""
    return sorted(config.get("compare", {}).items())


def _end(number):
    """End of the name of a copy with a value of a key."""
    path, value = number
    words = without_unit(path.rpartition(".")[2]).split("_")
    key = "".join(word[:1].upper() + word[1:] for word in words)
    return key + str(value).replace("-", "m").replace(".", "p")


def expanded(config: dict[str, Any]) -> dict[str, Any]:
    """Configuration with a copy of each entry for each value of section ``compare``. Itself without such a section.

    Copies take the place of pairs that run and of devices, which all run.

    Raises
    ------
    ConfigError
        If a key does not describe an entry of one of the sections whose entries are copied, or if an entry has the name
        of a copy.
    """
    if "compare" not in config:
        return config
    paths = [_parts_of_path(config, path) for path, _ in _compared_keys(config)]
    copied, stated, ends = _users_of(config, *((section, name) for section, name, _ in paths)), config, values(config)
    for end, numbers in ends.items():
        config = _with_copies(config, copied, end)
        for (section, name, keys), number in zip(paths, numbers, strict=True):
            config = merged(config, _only_at(number, section, name + end, *keys.split(".")))
    if replaced := next(_changed_entries(stated, config), None):
        compared = " and ".join(f"compare.{path}" for path, _ in _compared_keys(stated))
        raise ConfigError(f"{replaced} must have another name: {compared} makes a copy of this name")
    return _in_place(config, copied, ends)


def _changed_entries(before, after):
    """Yield dotted names of entries different in two configurations, also below studies."""
    for path in _paths(before):
        entries, now = reduce(getitem, path, before), reduce(getitem, path, after)
        yield from (".".join((*path, name)) for name in now if name in entries and entries[name] != now[name])


def _in_place(config, copied, ends):
    """Configuration with copies in place of pairs in the run, of devices and of pull-off forces of these."""
    copies = ([pair + end for end in ends] if pair in copied["pairs"] else [pair] for pair in config["run"]["pairs"])
    config = merged(config, {"run": {"pairs": list(chain.from_iterable(copies))}})
    if copied["devices"]:
        devices = {name: device for name, device in config["devices"].items() if name not in copied["devices"]}
        config = config | {"devices": devices}
    if pulled := [name for name in copied["test_beams"] if "probe" in config["test_beams"][name]]:
        arrays = {name: array for name, array in config["test_beams"].items() if name not in pulled}
        config = config | {"test_beams": arrays}  # their probes are devices in whose place are copies
    return config


def _parts_of_path(config, path):
    """Section, name of the entry, and key below it of a compared key. Raises a ConfigError without such an entry."""
    section, _, below = path.partition(".")
    name, _, keys = below.partition(".")
    sections = {kind: config[kind] for kind in _NAMED if kind in config}
    if name in sections.get(section, ()):
        return section, name, keys
    allowed = {section: sections[section]} if section in sections else sections
    listed = "; ".join(f"{kind}.NAME.KEY with NAME {' or '.join(names)}" for kind, names in allowed.items())
    raise ConfigError(f"compare.{path} is no key of an entry that exists, must be {listed}")


def _only_at(value, *path):
    """Configuration with nothing but a value at a path."""
    for name in reversed(path):
        value = {name: value}
    return value


def _paths(config):
    """Yield paths of sections with entries to copy, and of sections keyed by the name of a pair."""
    yield from ((section,) for section in _NAMED if section in config)
    for study in config["studies"]:
        by_key = section_at(config, "studies", study).items()
        yield from (("studies", study, key) for key, value in by_key if isinstance(value, dict))


def _users_of(config, *entries):
    """Names by section of some entries and of all their users."""
    copied = {kind: list(dict.fromkeys(name for section, name in entries if section == kind)) for kind in _NAMED}
    for kind in (*_NAMED, *_NAMED):  # twice: test beams name probes, and devices test beams
        for other, entry in config.get(kind, {}).items():
            if other not in copied[kind] and _with_suffixes(entry, kind, copied, "x") != entry:
                copied[kind].append(other)
    return copied


def _with_suffixes(entry, section, copied, end):
    """Append a suffix to the names of copied entries in an entry, nested sections included."""

    def new(key, value):
        """Value with the suffix on names of copies, nested sections and lists included."""
        if isinstance(value, dict):
            return {inner: new(inner, below) for inner, below in value.items()}
        names = copied[_NAMED[section][key]] if key in _NAMED[section] else ()
        if isinstance(value, list):
            return [name + end if name in names else name for name in value]
        return value + end if isinstance(value, str) and value in names else value

    return {key: new(key, value) for key, value in entry.items()}


def _with_copies(config, copied, end):
    """Configuration with a copy of every affected entry, and of settings of studies by the name of a pair."""
    added = {
        section: {name + end: _with_suffixes(config[section][name], section, copied, end) for name in names}
        for section, names in copied.items()
        if names
    }
    config = merged(config, added)
    for path in _paths(config):
        stated = reduce(getitem, path, config) if path[0] == "studies" else {}
        if of_copies := {name + end: stated[name] for name in copied["pairs"] if name in stated}:
            config = merged(config, _only_at(of_copies, *path))
    return config


def differing(config: Mapping[str, Any], base: Mapping[str, Any]) -> dict[str, Any]:
    """Keys of nested sections with other values than in another configuration.

    Examples
    --------
    >>> differing({"seed": 1, "beam": {"width": 3, "samples": 2}}, {"seed": 1, "beam": {"width": 30, "samples": 2}})
    {'beam': {'width': 3}}
    """
    pairs = ((key, value, base.get(key)) for key, value in config.items())
    return {
        key: differing(value, other) if isinstance(value, Mapping) and isinstance(other, Mapping) else value
        for key, value, other in pairs
        if value != other
    }
