"""Error messages about a configuration: key, value, allowed values and a suggestion.

The messages do not affect the results: `stiction.run.fingerprint` leaves this module out.
"""

import difflib
import math
import re
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache

import yaml

from stiction.config.cases import in_words
from stiction.config.kinds import KINDS
from stiction.config.units import from_si, to_si


class ConfigError(ValueError):
    """Error of a configuration, with one line per problem."""

    @property
    def problems(self) -> tuple[str, ...]:
        """Problems, one line each, beginning with the key."""
        return self.args

    def __str__(self):
        return "\n".join(self.problems)


@dataclass(frozen=True)
class Problem:
    """Problem with one key."""

    path: tuple  #: keys and list indices from the root
    message: str  #: continues the sentence that begins with the path
    others: tuple[tuple, ...] = ()  #: further paths with the same problem

    def __str__(self):
        return f"{dotted(self.path)} {self.message}"


def schema_problems(config: object, schema: dict) -> list[Problem]:
    """Problems of single keys, found with the schema."""
    try:
        return [problem for error in _strict()(schema).iter_errors(config) for problem in _problems_of(error, schema)]
    except (ValueError, RecursionError) as reason:
        # Each error of jsonschema prints the value, and Python cannot print very long integers or very deep nesting.
        return [Problem((), f"cannot be printed ({reason}): must contain short numbers and few levels of nesting")]


def is_number(value: object) -> bool:
    """Whether a value is a finite real number. Truth values, NaN and infinities are not."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e300


@cache
def _strict():
    """Class of the validator. Its library is imported here because a plan of a known configuration does not need it."""
    from jsonschema import Draft202012Validator, validators

    types = Draft202012Validator.TYPE_CHECKER.redefine_many(
        {
            "number": lambda _, value: is_number(value),
            "integer": lambda _, value: is_number(value) and isinstance(value, int),  # as written: 5000 is, 5000.0 not
        }
    )
    return validators.extend(Draft202012Validator, type_checker=types)


#: Keys of section compare.
_COMPARED = "the section, the name of an entry and its key with dots between, such as surfaces.B2.rms_nm"


def _problems_of(error, schema):
    """Problems for one error of jsonschema."""
    path, value = tuple(error.absolute_path), error.instance
    if "propertyNames" in error.absolute_schema_path:
        if path == ("compare",):
            return [Problem((*path, value), f"is no key, must be {_COMPARED}")]
        allowed = _entry(schema, path)["propertyNames"]
        hint = _name_hint(value, allowed["maxLength"])
        return [Problem((*path, value), f"is not a valid name, must be {allowed['description']}{hint}")]
    if error.validator == "required":
        missing, *more = [key for key in error.validator_value if key not in value]
        as_well = f"; {' and '.join(more)} {'is' if len(more) == 1 else 'are'} missing as well" if more else ""
        message = f"is missing, must be {_allowed_values(_entry(schema, (*path, missing)))}{as_well}"
        return [Problem((*path, missing), message, tuple((*path, key) for key in more))]
    if error.validator == "additionalProperties":
        strange = [(*path, key) for key in value if key not in error.schema["properties"]]
        allowed_keys = _keys_of_kind(path, value) or list(error.schema["properties"])
        answers = ((strange_key, _FORMER.get(strange_key) or _NEVER.get(strange_key[-1])) for strange_key in strange)
        return [
            Problem(strange_key, answer or _unknown(strange_key[-1], value[strange_key[-1]], allowed_keys))
            for strange_key, answer in answers
        ]
    stated = one_line(in_words(value, path))
    return [Problem(path, f"is {stated}, must be {_allowed_values(error.schema)}{_hint(path, value, error.schema)}")]


def _keys_of_kind(path, section):
    """Keys of a device of a known kind. None for other sections."""
    kind = section.get("kind") if path[:1] == ("devices",) and len(path) == 2 else None
    return KINDS[kind].allowed_keys if isinstance(kind, str) and kind in KINDS else ()


def _entry(schema, path):
    """Part of the schema about the key at ``path``."""
    for key in path:
        schema = schema.get("items") or schema.get("properties", {}).get(key) or schema["additionalProperties"]
    return schema


#: Keywords of the schema in words.
_KINDS = {"array": "a list", "integer": "a whole number", "number": "a number", "object": "a section", "string": "text"}
_KINDS |= {"boolean": "true or false"}
_BOUNDS = {"exclusiveMinimum": "above", "minimum": "at least", "exclusiveMaximum": "below", "maximum": "at most"}


def _allowed_values(entry):
    """Allowed values of a schema entry in words, with description and unit."""
    words = [f"one of {', '.join(entry['enum'])}" if "enum" in entry else _KINDS[entry["type"]]]
    words.append(" and ".join(f"{word} {entry[bound]}" for bound, word in _BOUNDS.items() if bound in entry))
    words.append(f"or {entry['word']}" if "word" in entry else "")
    if entry.get("properties"):
        words.append(f"with the keys {', '.join(entry['properties'])}")
    if "maxItems" in entry:
        words.append(f"with {number_of_items(entry)} entries")
    elif least := entry.get("minItems", entry.get("minProperties")):
        words.append("with at least one entry" if least == 1 else f"with at least {least} entries")
    return f"{' '.join(filter(None, words))}: {description(entry)}"


def number_of_items(entry: Mapping) -> str:
    """How many items a list of limited length has, in words.

    Examples
    --------
    >>> [number_of_items({"minItems": least, "maxItems": most}) for least, most in ((2, 2), (1, 2), (1, 8))]
    ['2', '1 or 2', '1 to 8']
    >>> number_of_items({"maxItems": 8})
    '0 to 8'
    """
    most = entry["maxItems"]
    least = entry.get("minItems", 0)
    return {0: f"{most}", 1: f"{least} or {most}"}.get(most - least, f"{least} to {most}")


def description(entry: Mapping) -> str:
    """Description of a part of the schema, with its unit, but without a mark for texts."""
    return re.sub(r" \[(choice|name|path)\]$", "", entry["description"])


#: Keys of older versions, and what they are called now.
_FORMER = {
    ("studies", "readings"): "is called studies.variants since version 0.2",
    ("design", "tip_um"): "is no longer needed, must be left out: the contact of a tip follows from its slope",
}


#: What to read in place of keys that were never there, by the last part of their path.
_NEVER = {
    "menisci": "is no key, must be left out: table life has both bounds, menisci of constant pressure (slow "
    "separation) and of constant volume (fast separation)"
}


def _unknown(key, value, keys):
    """Message about a key not in the schema."""
    with_unit = [name for name in keys if name.startswith(f"{key}_")]
    question = _question(with_unit) or did_you_mean(key, keys)
    unit = " Keys carry their unit." if with_unit else ""
    return f"is unknown (value {one_line(value)}), must be one of {', '.join(keys)}{question}{unit}"


def did_you_mean(word: object, names: Iterable[str]) -> str:
    """Suggest the known name most similar to ``word``, or nothing."""
    return _question(difflib.get_close_matches(str(word), names, n=1))


def _question(meant):
    """Suggest the first entry of ``meant``. Empty if there is none."""
    return f"; did you mean {meant[0]}?" if meant else ""


def _hint(path, value, entry):
    """Likely cause of a value of the wrong type or size, possibly empty."""
    if value is None:
        return "; there is no value after the key"
    if isinstance(value, bool):
        return "; YAML reads yes, no, on, off, true and false as truth values"
    if entry["type"] == "array" and not isinstance(value, list):
        return _list_hint(value, entry)
    if isinstance(value, str):
        return did_you_mean(value.lower(), entry["enum"]) if "enum" in entry else _number_hint(path, value, entry)
    if isinstance(value, float) and entry["type"] == "integer" and value.is_integer():
        return _advice(entry, f"{value:.15g}", "write it without a decimal point: {}")
    return _percent_hint(value, entry) or _unit_hint(path, value, entry)


def _accepts(entry, value):
    """Whether a value agrees with its part of the schema. Only then a message may advise to write it."""
    return _strict()(entry).is_valid(value)


def _advice(entry, text, sentence="write {}"):
    """Advice to write a value as this text in YAML. Empty if it would be refused as well."""
    return f"; {sentence.format(text)}" if _accepts(entry, yaml.safe_load(text)) else ""


def _list_hint(value, entry):
    """Advice to write one value, or keys without values, as a list of the least length, or an example of several."""
    for example in entry.get("examples", ()):
        if entry.get("minItems", 1) > 1 and len(set(example)) > 1:
            return f"; {'both ends' if 'maxItems' in entry else 'several values'} are wanted, as in {example}"
    keys = isinstance(value, dict) and not any(value.values())
    items = list(value) if keys else [value] * entry.get("minItems", 1)
    if not _accepts(entry, items):
        return ""
    return f"; write {yaml.safe_dump(items, default_flow_style=True, allow_unicode=True, width=math.inf).strip()}"


#: Units of keys whose values in SI lie outside the bounds of the schema, and the names of these values.
_IN_SI = {"nm": "metres", "um": "metres", "GPa": "pascals", "MPa": "pascals", "uN": "newtons", "mN_per_m": "N/m"}


def _unit_of(path):
    """Unit in the last key of a path with a unit, empty if none has one."""
    keys = (key for key in reversed(path) if isinstance(key, str))
    return next((unit for key in keys for unit in _IN_SI if key.endswith(f"_{unit}")), "")


def _unit_hint(path, value, entry):
    """Advice on a number in SI units: its value in the unit of the key."""
    unit = _unit_of(path)
    if not unit or not is_number(value):
        return ""
    return _advice(entry, f"{from_si(value, unit):.12g}", f"write {{}} if {value:g} is in {_IN_SI[unit]}")


#: A number with separators of thousands; one as YAML reads it or with a decimal comma, its exponent and its unit.
_GROUPED = re.compile(r"([-+]?\d{1,3}(?:([,' ])\d{3})(?:\2\d{3})*)")
_PERCENT = re.compile(r"(\d+(?:[.,]\d+)?)\s*%")
_WRITTEN = re.compile(r"([-+]?\d+(?:[.,]\d*)?)(?:[eE]([-+]?\d{1,2}))?\s*([^\W\d][^%]*)?")


def _percent_hint(value, entry):
    """Advice on a fraction in percent: its value as a fraction."""
    if not is_number(value) or value <= 1 or "as a fraction of 1" not in entry["description"]:
        return ""
    return _advice(entry, f"{value / 100:.12g}")


def _number_hint(path, text, entry):
    """Advice on a number read as text by YAML."""
    if entry["type"] not in ("number", "integer"):
        return ""
    if _GROUPED.fullmatch(text):
        return _grouped_hint(text, entry)
    if percent := _PERCENT.fullmatch(text):
        return _percent_hint(float(percent[1].replace(",", ".")), entry)
    if not (parts := _WRITTEN.fullmatch(text)):
        return f"; write {entry['word']} for {entry['where']}" if "word" in entry else ""
    mantissa, exponent, unit = parts[1].replace(",", "."), parts[2], (parts[3] or "").replace("µ", "u")
    if unit and unit != _unit_of(path):
        return _converted_hint(float(f"{mantissa}e{exponent or 0}"), unit, path, entry)
    written = _in_yaml(mantissa, exponent, entry)
    if exponent and not unit:
        return _advice(entry, written, f"YAML reads {text} as text, write {{}}")
    return _advice(entry, written, "write {} without quotes, unit or decimal comma")


def _in_yaml(mantissa, exponent, entry):
    """Number as YAML reads it: without an exponent if it is to be whole, otherwise with a point and a sign."""
    value = float(f"{mantissa}e{exponent or 0}")
    if entry["type"] == "integer" and value.is_integer():
        return f"{value:.15g}"
    return f"{float(mantissa)}e{int(exponent):+d}" if exponent else mantissa


def _grouped_hint(text, entry):
    """Advice on a number such as 5,000: without separators, or with a decimal point if both can be meant."""
    digits, decimal = re.sub(r"[,' ]", "", text), text.replace(",", ".")
    readings = [digits] if decimal.count(".") != 1 else [digits, decimal]
    allowed = [reading for reading in readings if _accepts(entry, yaml.safe_load(reading))]
    return f"; write {' or '.join(allowed)} without a separator of thousands" if allowed else ""


def _converted_hint(value, unit, path, entry):
    """Advice on a number in another unit than its key's, empty unless it is a length, stress or force."""
    kind, unit_of_key = _IN_SI.get(unit), _unit_of(path)
    if kind is None or kind != _IN_SI.get(unit_of_key):
        return ""
    return _advice(entry, f"{from_si(to_si(value, unit), unit_of_key):.12g}", f"write {{}}, the value in {unit_of_key}")


def _name_hint(name, longest):
    """Largest number of characters of a name, or likely reason why YAML did not read it as text."""
    if isinstance(name, bool):
        return "; YAML reads yes, no, on, off, true and false as truth values"
    return f", at most {longest} characters" if isinstance(name, str) else "; YAML read it as something other than text"


def dotted(path: tuple) -> str:
    """Path as in ``pairs.a.humidities[1]``."""
    text = "".join(f"[{key}]" if type(key) is int else f".{_plain(key)}" for key in path)
    return text.removeprefix(".") or "configuration"


def _plain(key):
    """Key as it is if it is a single word, otherwise its Python representation."""
    return key if isinstance(key, str) and re.fullmatch(r"[\w-]+", key) else one_line(key)


def one_line(value: object) -> str:
    """Value as one short line."""
    text = repr(value)
    return text if len(text) <= 100 else f"{text[:80]} …"


def duplicates(items: Iterable) -> list:
    """Items listed more than once."""
    return [item for item, count in Counter(items).items() if count > 1]
