"""Schema for editors with completion and checks of YAML: for files of changed single keys."""

import json
from pathlib import Path

from stiction.config.relations import schema

#: Where the examples of a checkout expect it; ``make`` writes it there. ``stiction init`` writes it next to a study.
OF_CHECKOUT = Path(__file__).parents[1] / "config" / "schema.json"
#: Keywords of JSON Schema that hold for a complete configuration and not for a file that changes single keys.
_OF_COMPLETE = ("required", "if", "else", "then", "allOf", "minProperties")


def text() -> str:
    """Schema of files of changed single keys, as JSON for editors with completion and checks of YAML."""
    reduced = _reduced(schema()) | {"$schema": "http://json-schema.org/draft-07/schema#"}
    devices = reduced["properties"]["devices"]
    devices["properties"] |= devices["additionalProperties"]["properties"]  # beside a file of devices
    return json.dumps(reduced, indent=1) + "\n"


def _reduced(entry):
    """Part of the schema without demands on a complete configuration only."""
    if not isinstance(entry, dict):
        return entry
    fragment = {name: value for name, value in entry.items() if name not in _OF_COMPLETE}
    if "word" in fragment:
        dew_point = {"type": "object", "properties": {"dew_point_C": {"type": "number"}}, "additionalProperties": False}
        return {
            "description": fragment.pop("description"),
            "anyOf": [{"const": fragment.pop("word")}, fragment, dew_point],
        }
    for name in ("additionalProperties", "items"):
        if name in fragment:
            fragment[name] = _reduced(fragment[name])
    if "properties" in fragment:
        fragment["properties"] = {name: _reduced(value) for name, value in fragment["properties"].items()}
    return fragment


if __name__ == "__main__":
    OF_CHECKOUT.write_text(text(), encoding="utf-8")
