"""A key that the schema rejects is reported with its value and the allowed values, whatever the value is."""

import copy
import math
import re
from functools import partial, reduce
from unittest.mock import patch

import jsonschema
import pytest
import yaml
from configurations import LEAVES, NUMBERS, PAPER, ROOT, SCHEMA, changed, entries, problems, replaced, without
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from wrong_configurations import UNKNOWN, UNNAMEABLE, WRONG_VALUES

from stiction.config import messages
from stiction.config.cases import in_numbers
from stiction.config.keys import Relations
from stiction.config.kinds import KINDS
from stiction.config.merging import merged
from stiction.config.reading import read


def kind_of(part):
    """Kind of a part of the schema: messages read whether it is a fraction, and the examples of lists alone."""
    silent = {"description"} | ({"examples"} if part["type"] != "array" else set())
    return repr(({key: part[key] for key in part if key not in silent}, "as a fraction of 1" in part["description"]))


def one_of_each_kind(leaves):
    """Keys, one of each kind."""
    return list({kind_of(leaf.entry): leaf for leaf in leaves}.values())


@pytest.mark.parametrize(
    ("overlay", "key", "value", "message"), WRONG_VALUES, ids=[f"{row[1]}={row[2]}" for row in WRONG_VALUES]
)
def test_a_wrong_value_is_rejected_in_one_line_with_key_value_and_what_is_allowed(overlay, key, value, message):
    (line,) = problems(changed(overlay))
    assert line.startswith(f"{key} is {value}, must ")
    assert message in line


@pytest.mark.parametrize(("overlay", "key", "message"), UNKNOWN, ids=[row[1] for row in UNKNOWN])
def test_an_unknown_key_is_rejected_in_one_line_with_the_known_ones(overlay, key, message):
    (line,) = problems(changed(overlay))
    assert line.startswith(f"{key} is unknown (value ")
    assert message in line


@pytest.mark.parametrize("section", ["pairs", "surfaces"])
@pytest.mark.parametrize("name", UNNAMEABLE)
def test_a_name_that_is_not_safe_in_file_names_is_rejected(section, name):
    entry = next(iter(PAPER[section].values()))
    (line,) = problems(merged(PAPER, {section: {name: entry}}))
    assert line.startswith(section)
    assert "is not a valid name, must be letters and digits" in line
    assert ("YAML" in line) == (not isinstance(name, str))


@pytest.mark.parametrize("leaf", one_of_each_kind(leaf for leaf in LEAVES if leaf.required), ids=str)
def test_a_missing_key_is_named_with_what_it_must_be(leaf):
    (line,) = problems(without(leaf.path))
    assert line.startswith(f"{leaf} is missing, must be ")
    assert line.endswith(messages.description(leaf.entry))


@pytest.mark.parametrize("section", PAPER)
def test_a_missing_section_is_named(section):
    (line,) = problems(without((section,)))
    assert line.startswith(f"{section} is missing, must be ")


@pytest.mark.parametrize("leaf", one_of_each_kind(NUMBERS), ids=str)
def test_no_number_is_replaced_by_something_else(leaf):
    for junk in (None, True, False, "1.0", "", [1], {}, math.nan, math.inf, -math.inf, 10**400):
        (line,) = problems(replaced(leaf.path, junk))
        assert line.startswith(f"{leaf} is "), junk
        assert messages.description(leaf.entry) in line, junk


@pytest.mark.parametrize("section", [entry for entry in entries(SCHEMA) if len(entry.get("required", ())) > 1], ids=str)
def test_all_keys_that_a_section_lacks_are_one_fault_in_one_sentence(section):
    first, *others = section["required"]
    (line,) = dict.fromkeys(map(str, messages.schema_problems({}, section)))
    assert line.startswith(f"{first} is missing, must be ")
    assert line.endswith("missing as well")
    assert all(f" {key} " in line for key in others)


def test_a_surface_with_an_rms_alone_is_refused_once():
    (line,) = problems(changed("surfaces: {Mine: {rms_nm: 5}}"))
    assert line.startswith("surfaces.Mine")
    assert all(key in line for key in ("skewness", "kurtosis", "psd"))


@pytest.mark.parametrize("percent", ["60", "60%", "60 %", "'60'"])
def test_a_humidity_in_percent_is_shown_as_a_fraction(percent):
    for key in ("pairs: {a: {humidities: [%s]}}", "figures: {humidity: %s}", "design: {worst_humidities: [0.4, %s]}"):
        (line,) = problems(changed(key % percent))
        assert line.endswith("; write 0.6") == (percent != "'60'"), line
    (saturated,) = problems(changed("figures: {humidity: 1}"))
    assert "write" not in saturated


@pytest.mark.parametrize("word", ["nitrogen", "vacuum", "N2", "Dry"])
def test_air_without_water_is_called_dry(word):
    (line,) = problems(changed(f"pairs: {{a: {{humidities: [0.5, {word}]}}}}"))
    assert line.endswith("; write dry for nitrogen, vacuum and other air without water")


@pytest.mark.parametrize("kind", KINDS)
def test_a_device_with_an_unknown_key_gets_the_keys_of_its_kind_in_one_sentence(kind):
    # Without the key that was meant, whose absence is the same fault.
    (line,) = problems(changed(f"devices: {{D: {{kind: {kind}, pair: b, humidities: [0.5], gap: 3}}}}"))
    assert line.startswith("devices.D.gap is unknown (value 3), must be one of kind, pair, humidities")
    known = line.partition("one of ")[2].partition(";")[0].split(", ")
    assert known == list(KINDS[kind].allowed_keys)
    assert line.endswith("; did you mean gap_um? Keys carry their unit.")


def test_no_message_ends_with_what_only_stands_for_a_unit():
    for entry in entries(SCHEMA):
        said = (
            str(messages.Problem(("key",), f"must be {messages._allowed_values(entry)}"))
            if entry["type"] != "object"
            else ""
        )
        assert not re.search(r"\[(choice|name|path)\]", said)


@pytest.mark.parametrize("leaf", one_of_each_kind(NUMBERS), ids=str)
def test_a_number_is_rejected_outside_its_bounds_and_not_inside(leaf):
    refusal = re.compile(rf"{re.escape(str(leaf))} is .*: {re.escape(leaf.entry['description'])}(;.*)?$")
    for side, outward in (("inimum", -1), ("aximum", 1)):
        closed = f"m{side}" in leaf.entry
        bound = leaf.entry[f"m{side}" if closed else f"exclusiveM{side}"]
        step = outward if leaf.entry["type"] == "integer" else outward * 1e-6 * max(1, abs(bound))
        values = (bound - step, bound, bound + step)
        refused = [any(map(refusal.match, problems(replaced(leaf.path, value)))) for value in values]
        assert refused == [False, not closed, True]


def test_the_schema_is_a_valid_json_schema():
    jsonschema.Draft202012Validator.check_schema(SCHEMA)


def test_every_section_rejects_unknown_keys():
    sections = [entry for entry in entries(SCHEMA) if entry["type"] == "object"]
    assert len(sections) > 10
    for section in sections:
        assert section["additionalProperties"] is False or "propertyNames" in section


UNITS = {
    "_nm": "[nm]",
    "_um": "[µm]",
    "_nm4": "[nm⁴]",
    "_rad_per_um": "[rad/µm]",
    "_per_um2": "[1/µm²]",
    "_GPa": "[GPa]",
    "_MPa": "[MPa]",
    "_uN": "[µN]",
    "_nN": "[nN]",
    "_zJ": "[zJ]",
    "_um2": "[µm²]",
    "_N_per_m": "[N/m]",
    "_mN_per_m": "[mN/m]",
    "_kg_per_m3": "[kg/m³]",
    "_ng": "[ng]",
    "_V": "[V]",
    "_deg": "[°]",
    "_K": "[K]",
    "_C": "[°C]",
    "_g": "[g]",
}


def keys_with_values(schema, path=()):
    """Every key of the schema that holds a value, as a path, with its part. Names chosen by users are NAME."""
    if schema["type"] == "array" and schema["items"]["type"] == "object":
        return keys_with_values(schema["items"], path)
    if schema["type"] != "object":
        return {path: schema}
    inside = schema.get("properties", {}).items()
    named = [("NAME", schema["additionalProperties"])] if isinstance(schema.get("additionalProperties"), dict) else []
    return {
        key: value for name, part in (*inside, *named) for key, value in keys_with_values(part, (*path, name)).items()
    }


def test_the_description_of_a_key_ends_with_the_unit_of_its_name():
    keys = keys_with_values(SCHEMA)
    assert len(keys) > 200, len(keys)
    for path, entry in keys.items():
        # The last key on the path with a unit; the keys below it are names chosen by the user.
        units = [UNITS[suffix] for key in path for suffix in sorted(UNITS, key=len) if key.endswith(suffix)][-1:]
        text = {"string", "boolean"} & {entry["type"], entry.get("items", {}).get("type")}
        others = (
            ("[name]", "[choice]", "[path]", "[text]")
            if text
            else ("[-]", "[unit of the key]", "[unit of the variable]")
        )
        assert entry["description"].endswith(tuple(units) or others), path


@pytest.mark.parametrize("config", [None, [], 5, "seed: 1", {}, {None: 1}, math.nan, True])
def test_objects_other_than_configurations_are_rejected(config):
    lines = problems(config)
    assert lines
    assert all(" must be " in line for line in lines)


UNPRINTABLE = {
    "number": 10**5000,
    "item": [10**5000],
    "key": {10**5000: 1},
    "value": {"x": 10**5000},
    "depth": reduce(lambda inner, _: [inner], range(100_000), 0),
}


@pytest.mark.parametrize("junk", UNPRINTABLE)
@pytest.mark.parametrize("path", [("seed",), ("beam",), ("beam", "elements"), ("van_der_waals",), ("surfaces", "B1")])
def test_values_that_python_cannot_print_are_rejected(path, junk):
    (line,) = problems(replaced(path, UNPRINTABLE[junk]))
    assert "cannot be printed" in line


#: Values of every wrong kind, as a YAML file may hold them.
MISWRITTEN = [
    "5,000",
    "5,5",
    "1,234,567",
    "12 000",
    "5'000",
    "1e3",
    "1.5e-3",
    "2 nm",
    "2.6 um",
    "2600 nm",
    "3 kg",
    "-1",
]
MISWRITTEN += [
    3,
    0.5,
    2.5e-9,
    2e-5,
    1.64e11,
    5000.0,
    10**9,
    -1,
    "a",
    "B1, B2",
    {"b": None},
    {"b": 1},
    {"a": None, "b": None},
]
ADVICE = re.compile(r"; (?:YAML reads .* as text, )?write (?:it without a decimal point: )?(.*)$")


VALUES = {kind_of(part): part for part in entries(SCHEMA) if part["type"] != "object"}


@pytest.mark.parametrize("entry", VALUES.values(), ids=str)
def test_what_a_message_advises_to_write_is_accepted(entry):
    strict = partial(messages.schema_problems, schema=entry)
    for value in filter(strict, MISWRITTEN):
        for path in ("thickness_um", "rms_nm", "young_modulus_GPa", "name"):
            hint = messages._hint((path,), value, entry)
            if advice := ADVICE.match(hint):
                words = re.split(r" without |, the value| if | for ", advice[1])[0]
                for text in words.split(" or "):
                    assert strict(in_numbers(yaml.safe_load(text))) == [], (value, hint)


def test_advice_is_given_where_there_is_a_value_to_advise():
    pair = {"type": "array", "minItems": 2, "maxItems": 2, "items": {"type": "number", "minimum": 0}}
    assert messages._hint(("contact_um",), 3, pair) == "; write [3, 3]"
    assert messages._hint(("size_um",), 3, pair | {"examples": [[5, 5]]}) == "; write [3, 3]"
    names = {"type": "array", "items": {"type": "string"}}
    assert messages._hint(("pairs",), {"b": None}, names) == "; write [b]"
    assert messages._hint(("pairs",), {"b": {"gap_um": 2}}, names) == ""
    ends = pair | {"examples": [[1, 8]]}
    assert [messages._hint(("rms_nm",), value, ends) == "" for value in (3, [3, 3, 3])] == [False, True]
    assert messages._hint(("pairs",), "no", names) == "; write ['no']", "YAML reads no as a truth value"


def test_a_long_value_is_cut_off_in_a_message():
    (line,) = problems(replaced(("van_der_waals",), "w" * 5000))
    assert "www …" in line
    assert len(line) < 400
    (line,) = problems(replaced(("van_der_waals",), "w" * 90))
    assert "w" * 90 in line


#: Without its grid, which then follows the surfaces.
WITHOUT_GRID = read(ROOT / "config.yaml")
#: With devices in conditions and at dew points, test beams, settings of a process, and copies.
WITH_DEVICES = merged(
    WITHOUT_GRID,
    yaml.safe_load("""
        devices:
          Lever: {kind: cantilever, pair: b, thickness_um: 2.6, width_um: 30, gap_um: 20, process: etch,
                  requirement: {length_um: 100, share: 0.01}, test_beams: [Array],
                  conditions: [{temperature_C: 25, humidity: {dew_point_C: 10}}, {temperature_C: 60, humidity: 0.6}]}
          Stop: {kind: stopper, pair: b, contact_um: [1, 1], restoring_force_uN: 2, humidities: [{dew_point_C: 10}]}
        test_beams:
          Array: {pair: b, length_um: 1500, thickness_um: 2.5, gap_um: 2, width_um: 30,
                  crack_lengths: [{humidity: 0.67, mean_um: 700, std_um: 20, beams: 9}]}
        process:
          etch: {variable: etch_time_s, surface: B2, settings: [{value: 30, rms_nm: 2, uncertainty: {rms_nm: 0.1}},
                                                               {value: 60, rms_nm: 3, uncertainty: {rms_nm: 0.1}}]}
        compare: {devices.Stop.restoring_force_uN: [1, 2]}
    """),
)
FUZZ = settings(max_examples=120, suppress_health_check=[HealthCheck.too_slow])
JUNK = st.recursive(
    st.one_of(
        st.none(),
        st.booleans(),
        st.integers(),
        st.floats(),
        st.text(max_size=5),
        st.dates(),
        st.sampled_from([10**400, "B1", "a", "1e-3", 5000.0, 0.65, 1e-320, 1e308, "published", "identified"]),
    ),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.text(max_size=3) | st.integers() | st.none() | st.booleans() | st.floats(), inner, max_size=3
        )
    ),
    max_leaves=5,
)


BASES = [PAPER, WITHOUT_GRID, WITH_DEVICES]


@st.composite
def mutilated(draw):
    """A valid configuration with up to four errors: values replaced or scaled, keys removed or added."""
    config = {"root": copy.deepcopy(draw(st.sampled_from(BASES)))}
    for _ in range(draw(st.integers(1, 4))):
        section, key = config, "root"
        while isinstance(section[key], dict) and section[key] and draw(st.integers(0, 9)):
            section = section[key]
            key = draw(st.sampled_from(list(section)))
        accident = draw(st.sampled_from(["replace", "scale", "lose", "add"]))
        if accident == "scale" and isinstance(section[key], int | float) and abs(section[key]) < 1e300:
            section[key] = section[key] * draw(st.floats(0, 10))
        elif accident == "lose" and section is not config:
            del section[key]
        elif accident == "add" and isinstance(section[key], dict):
            section[key][draw(st.text(max_size=3) | st.integers() | st.none())] = draw(JUNK)
        else:
            section[key] = draw(JUNK)
    return config["root"]


@FUZZ
@given(mutilated())
def test_any_configuration_runs_or_is_rejected_in_lines_that_name_a_key(config):
    for line in problems(config):
        assert re.match(r"\S.* (is|cannot) .*must ", line)
        assert "\n" not in line


@pytest.mark.parametrize("config", BASES)
def test_configurations_to_break_are_valid(config):
    assert problems(config) == ()


@FUZZ
@given(mutilated())
def test_relations_see_nothing_that_the_schema_refuses(config):
    """A violation of the schema ends the check before any relation."""
    relate = Relations.problems

    def relate_what_is_valid(self, keys):
        """Problems of keys of a configuration that agrees with the schema."""
        of_schema = messages.schema_problems({key: value for key, value in keys.config.items() if value != {}}, SCHEMA)
        assert [str(problem) for problem in of_schema if problem.path[0] != "run"] == []
        return relate(self, keys)

    with patch.object(Relations, "problems", relate_what_is_valid):
        problems(config)


@pytest.mark.parametrize(
    ("former", "now"),
    [
        ("studies: {readings: {samples: 600}}", "studies.readings is called studies.variants since version"),
        ("design: {tip_um: 1}", "design.tip_um is no longer needed, must be left out: "),
        ("menisci: {keep: volume}", "menisci is no key, must be left out: table life has both bounds, "),
        ("contact: {menisci: {keep: volume}}", "contact.menisci is no key, must be left out: table life has both "),
    ],
)
def test_a_key_of_an_older_version_is_refused_with_what_it_is_called_now(former, now):
    (line,) = problems(changed(former))
    assert line.startswith(now)
    assert "did you mean" not in line
