"""Changes of single keys of a configuration or of the settings of a job, and copies of entries with other values.

``compare: {surfaces.B2.rms_nm: [3, 5]}`` makes the surfaces B2Rms3 and B2Rms5, the pairs bRms3 and bRms5 of each pair b
on B2, and so on. The copies are entries like any others: nothing else knows of the section but tables and figures.
"""

from collections.abc import Mapping
from typing import Any

from stiction.config.messages import ConfigError
from stiction.config.units import without_unit

#: Sections whose entries may be copied, each after those that it names, and the keys by which it names these.
_NAMED = {
    "materials": {},
    "surfaces": {"material": "materials"},
    "pairs": {"beam": "surfaces", "substrate": "surfaces"},
    "test_beams": {"pair": "pairs"},
    "devices": {"pair": "pairs", "test_beams": "test_beams", "surface": "surfaces"},
}


def merged(base: Any, overlay: Any) -> Any:
    """Mapping ``base`` changed key by key, as Snakemake does; lists and numbers are replaced as a whole."""
    if not (isinstance(base, Mapping) and isinstance(overlay, Mapping)):
        return overlay
    return {**base, **{key: merged(base.get(key), value) for key, value in overlay.items()}}


# Values of one key side by side


def values(config: Mapping[str, Any]) -> dict[str, float]:
    """Compared values by the ends of the names of their copies; empty without the section.

    Examples
    --------
    >>> values({"compare": {"surfaces.B2.rms_nm": [3, 2.5]}}), values({"compare": {"surfaces.B2.skewness": [-0.5]}})
    ({'Rms3': 3, 'Rms2p5': 2.5}, {'Skewnessm0p5': -0.5})
    """
    for path, listed in config.get("compare", {}).items():
        words = without_unit(path.rpartition(".")[2]).split("_")
        key = "".join(word[:1].upper() + word[1:] for word in words)
        return {key + str(value).replace("-", "m").replace(".", "p"): value for value in listed}
    return {}


def expanded(config: dict[str, Any]) -> dict[str, Any]:
    """Configuration with a copy of each entry for each value of section ``compare``; itself without such a section.

    Copies take the place of pairs that run and of devices, which all run. A section that the schema refuses is left to
    it.

    Raises
    ------
    ConfigError
        If the key does not describe an entry of one of the sections whose entries are copied.
    """
    if not _is_valid(config.get("compare")):
        return config
    (path,) = config["compare"]
    section, _, rest = path.partition(".")
    name, _, keys = rest.partition(".")
    entries = config.get(section) if section in _NAMED else None
    if not isinstance(entries, dict) or not isinstance(entries.get(name), dict) or not keys:
        known = {one: config[one] for one in _NAMED if isinstance(config.get(one), dict)}
        if isinstance(entries, dict):
            known = {section: entries}
        listed = "; ".join(f"{one}.NAME.KEY with NAME {' or '.join(map(str, names))}" for one, names in known.items())
        raise ConfigError(f"compare.{path} is no key of an entry that exists, must be {listed}")
    copied = _affected(config, section, name)
    for end, value in values(config).items():
        config = _with_copies(config, copied, end)
        change = value
        for key in reversed(keys.split(".")):
            change = {key: change}
        config = merged(config, {section: {name + end: change}})
    runs = _list(config, "run", "pairs")
    ends = values(config)
    pairs = [one + end for one in runs for end in (ends if one in copied["pairs"] else [""])]
    devices = {key: device for key, device in config.get("devices", {}).items() if key not in copied["devices"]}
    return merged(config, {"run": {"pairs": pairs}}) | ({"devices": devices} if devices else {})


def _is_valid(compare):
    """Whether section ``compare`` is as the schema demands, as far as its use here needs it."""
    return (
        isinstance(compare, dict)
        and len(compare) == 1
        and all(isinstance(path, str) for path in compare)
        and all(isinstance(listed, list) for listed in compare.values())
    )


def _list(config, section, key):
    """Names in a list of a section, empty if there are none."""
    found = config.get(section)
    found = found.get(key) if isinstance(found, dict) else None
    return [one for one in found if isinstance(one, str)] if isinstance(found, list) else []


def _affected(config, section, name):
    """Names by section of an entry and of all that use it."""
    copied = {one: [] for one in _NAMED}
    copied[section] = [name]
    for one in _NAMED:
        entries = config.get(one)
        for other, entry in entries.items() if isinstance(entries, dict) else ():
            if other not in copied[one] and _renamed(entry, one, copied, "x") != entry:
                copied[one].append(other)
    return copied


def _renamed(entry, section, copied, end):
    """Entry in which names of copied entries have an end, also one level below."""
    if not isinstance(entry, dict):
        return entry

    def new(key, value):
        if isinstance(value, dict):
            return {inner: new(inner, below) for inner, below in value.items()}
        names = copied[_NAMED[section][key]] if key in _NAMED[section] else ()
        if isinstance(value, list):
            return [one + end if one in names else one for one in value]
        return value + end if isinstance(value, str) and value in names else value

    return {key: new(key, value) for key, value in entry.items()}


def _with_copies(config, copied, end):
    """Configuration with a copy of every affected entry, and of what studies state by the name of a pair."""
    added = {
        section: {name + end: _renamed(config[section][name], section, copied, end) for name in names}
        for section, names in copied.items()
        if names
    }
    studies = {
        study: {
            key: {name + end: value[name] for name in copied["pairs"] if name in value}
            for key, value in section.items()
            if isinstance(value, dict)
        }
        for study, section in (config.get("studies") or {}).items()
        if isinstance(section, dict)
    }
    return merged(config, added | {"studies": studies})
