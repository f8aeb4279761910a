"""All keys of the configuration, from its schema: tables of the docs."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from stiction.config.materials import sourced_properties
from stiction.config.messages import number_of_items
from stiction.config.reading import read
from stiction.config.relations import schema

ROOT = Path(__file__).parents[1]
#: Complete configuration of the paper: its values are the defaults.
PAPER = read(ROOT / "config.yaml")
#: Further values to show as examples, in the order in which they are tried.
EXAMPLES = [
    PAPER,
    *(
        read(ROOT / "examples" / f"{name}.yaml")
        for name in ("devices", "scans/mine", "test_beams", "roughness", "process/mine")
    ),
]


#: Sections that a study of a device rarely states, in a table of their own.
OF_SIMULATION = (
    "seed",
    "scans",
    "sampling",
    "character",
    "identification",
    "solid",
    "van_der_waals",
    "attraction",
    "water",
    "contact",
    "chaos",
    "beam",
    "figures",
    "studies",
)


class Key(NamedTuple):
    """One key that holds a value; ``*`` stands for names in its path."""

    path: tuple[str, ...]
    entry: dict  #: its part of the schema

    @property
    def meaning(self) -> str:
        """Description without the unit."""
        return self.entry["description"].rpartition(" [")[0] or self.entry["description"]

    @property
    def example(self) -> Any:
        """Value in the paper's configuration, in an example or in the schema, or the first choice."""
        values = [value for config in EXAMPLES for value in _values(config, self.path)]
        choices = [*self.entry.get("enum", ()), *([choice] for choice in self.entry.get("items", {}).get("enum", ()))]
        return [*values, *self.entry.get("examples", ()), *choices, None][0]


def keys(entry: dict, path: tuple[str, ...] = ()) -> Iterator[Key]:
    """All keys that hold a value, in the order of the schema."""
    if entry["type"] != "object":
        yield Key(path, entry)
        return
    for name, inner in entry.get("properties", {}).items():
        yield from keys(inner, (*path, name))
    if isinstance(named := entry["additionalProperties"], dict):
        yield from keys(named, (*path, "*"))


def _values(config, path):
    """Values of a configuration at a path, for every name in place of ``*``."""
    if not path:
        yield config
    elif isinstance(config, dict):
        for name in config if path[0] == "*" else [path[0]] * (path[0] in config):
            yield from _values(config[name], path[1:])


def allowed(entry: dict) -> str:
    """Allowed values in short.

    Examples
    --------
    >>> allowed({"type": "number", "exclusiveMinimum": 0, "maximum": 5})
    '>0, ≤5'
    >>> allowed({"type": "integer", "minimum": 2, "maximum": 5})
    'integer, 2–5'
    """
    if entry["type"] == "array":
        number = f"{number_of_items(entry)} entries" if "maxItems" in entry else "list"
        return f"{number}: {allowed(entry['items'])}"
    if "enum" in entry:
        return ", ".join(f"`{choice}`" for choice in entry["enum"])
    if entry["type"] in ("string", "object", "boolean"):
        return {"string": "text", "object": "sections", "boolean": "`true`, `false`"}[entry["type"]]
    signs = {"exclusiveMinimum": ">", "minimum": "≥", "exclusiveMaximum": "<", "maximum": "≤"}
    bounds = ", ".join(f"{sign}{entry[bound]}" for bound, sign in signs.items() if bound in entry) or "number"
    if "maximum" in entry and entry.get("minimum", -1) >= 0:
        bounds = f"{entry['minimum']}–{entry['maximum']}"
    bounds += f", or `{entry['word']}`" if "word" in entry else ""
    return f"integer, {bounds}" if entry["type"] == "integer" else bounds


def page() -> str:
    """Sections and tables of the keys of surfaces and devices in Markdown."""
    return _tables([name for name in schema()["properties"] if name not in OF_SIMULATION])


def of_simulation() -> str:
    """Sections and tables of all other keys in Markdown."""
    return _tables(OF_SIMULATION)


def materials() -> str:
    """Table of the materials by name in Markdown: every property with its source."""
    head = (
        "Materials by name, for `surfaces.NAME.material` and `materials.NAME.like`. Measure your own films. The last "
    )
    head += (
        "column says what was read again of a source: –, nothing, the value is as in a handbook or paper before.\n\n"
    )
    rows = [
        f"| {name} | `{key}` | {_in_short(entry['value'])} | {entry['source']} | {entry.get('read', '–')} |"
        for name, properties in sourced_properties().items()
        for key, entry in properties.items()
    ]
    return head + "\n".join(["| material | property | value | source | read again |", "|---|---|---|---|---|", *rows])


def _in_short(value):
    """Value, or values by name without quotes."""
    return json.dumps(value).replace('"', "").strip("{}")


def _tables(names):
    """Sections of these names and their tables in Markdown."""
    parts = []
    for name in names:
        entry = schema()["properties"][name]
        named = isinstance(entry.get("additionalProperties"), dict)
        rows = [_row(key, 1 + named) for key in keys(entry, (name,))]
        head = [f"| {name}{'.NAME' * named} | meaning | allowed |", "|---|---|---|"]
        about = entry["description"].partition(" [")[0]
        said = [f"{about[0].upper()}{about[1:]}.", ""] if entry["type"] == "object" else []
        parts.append("\n".join([f"## {name}", "", *said, *head, *rows]))
    return "\n\n".join(parts)


def sections() -> str:
    """Table of the sections and their subjects in Markdown."""
    subjects = {name: entry["description"].partition(" [")[0] for name, entry in schema()["properties"].items()}
    rows = [f"| `{name}` | {about[0].upper()}{about[1:]} |" for name, about in subjects.items()]
    return "\n".join(["| section | subject |", "|---|---|", *rows])


def _row(key, above):
    """Row of one key, without the first names of its path; defaults hold without a file of one's own."""
    default = "" if "*" in key.path else next((_yaml(value) for value in _values(PAPER, key.path)), "")
    name = ".".join(key.path[above:] or key.path).replace("*", "NAME")
    value = f"; {default}" if default else f" ({_yaml(_first(key.example))})"
    return f"| `{name}` | {key.meaning} | {allowed(key.entry)}{value} |"


def _first(value):
    """First of several sections; any other value as it is."""
    return value[:1] if isinstance(value, list) and isinstance(value[0] if value else None, dict) else value


def _yaml(value):
    """A value in one line of YAML."""
    return f"`{json.dumps(value, ensure_ascii=False)}`" if not isinstance(value, str) else f"`{value}`"
