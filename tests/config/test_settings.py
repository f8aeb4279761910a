"""A configuration that cannot run is refused with key, value and what would be allowed; any other runs."""

import copy
import math
import re
from functools import cache, reduce
from pathlib import Path
from typing import NamedTuple

import jsonschema
import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from wrong_configurations import UNKNOWN, UNNAMEABLE, WRONG

from stiction.chaos.model import MAX_ORDER
from stiction.config.cases import merged
from stiction.config.settings import ConfigError, load, read, validate
from stiction.surface import maxent

ROOT = Path(__file__).parents[2]
PAPER = read(ROOT / "config.yaml")
SCHEMA = read(ROOT / "workflow/schemas/config.schema.yaml")


@pytest.fixture(autouse=True, scope="module")
def known_densities():
    """Solve the densities of the paper once: a thousand configurations ask for them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(maxent, "solve", cache(maxent.solve))
        yield


def changed(overlay):
    """The paper's configuration under an overlay in YAML."""
    return merged(PAPER, yaml.safe_load(overlay))


def problems(config):
    """Lines about a configuration; none if it can run."""
    try:
        validate(config, SCHEMA)
    except ConfigError as error:
        return error.problems
    return ()


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
    found = []
    for key, value in config.items():
        entry = schema.get("properties", {}).get(key) or schema["additionalProperties"]
        found += leaves(value, entry, (*path, key), key in schema.get("required", ()))
    return found


def entries(schema):
    """Every part of the schema that describes a section or a value."""
    inside = [*schema.get("properties", {}).values()]
    inside += [schema[key] for key in ("additionalProperties", "items") if isinstance(schema.get(key), dict)]
    return [schema, *(entry for part in inside for entry in entries(part))]


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


# One surface, pair or reading stands for all.
LEAVES = list({id(leaf.entry): leaf for leaf in reversed(leaves(PAPER, SCHEMA))}.values())[::-1]
NUMBERS = [leaf for leaf in LEAVES if leaf.entry["type"] in ("number", "integer")]


def test_the_case_study_of_the_paper_can_run():
    assert problems(PAPER) == ()


@pytest.mark.parametrize(("overlay", "key", "value", "said"), WRONG, ids=[f"{row[1]}={row[2]}" for row in WRONG])
def test_a_wrong_value_is_refused_in_one_line_with_key_value_and_what_is_allowed(overlay, key, value, said):
    (line,) = problems(changed(overlay))
    assert line.startswith(f"{key} is {value}, must ")
    assert said in line


@pytest.mark.parametrize(("overlay", "key", "said"), UNKNOWN, ids=[row[1] for row in UNKNOWN])
def test_an_unknown_key_is_refused_in_one_line_with_the_known_ones(overlay, key, said):
    (line,) = problems(changed(overlay))
    assert line.startswith(f"{key} is unknown (value ")
    assert said in line


@pytest.mark.parametrize("name", UNNAMEABLE)
@pytest.mark.parametrize("section", ["surfaces", "pairs"])
def test_a_name_that_would_not_survive_as_a_file_name_is_refused(section, name):
    entry = next(iter(PAPER[section].values()))
    (line,) = problems(merged(PAPER, {section: {name: entry}}))
    assert line.startswith(section)
    assert "is no name, must be letters and digits" in line
    assert ("YAML" in line) == (not isinstance(name, str))


def test_there_are_at_least_sixty_wrong_configurations():
    assert len(WRONG) + len(UNKNOWN) >= 60


@pytest.mark.parametrize("leaf", [leaf for leaf in LEAVES if leaf.required], ids=str)
def test_a_missing_key_is_named_with_what_it_must_be(leaf):
    (line,) = problems(without(leaf.path))
    assert line.startswith(f"{leaf} is missing, must be ")
    assert line.endswith(leaf.entry["description"])


@pytest.mark.parametrize("section", PAPER)
def test_a_missing_section_is_named(section):
    (line,) = problems(without((section,)))
    assert line.startswith(f"{section} is missing, must be ")


@pytest.mark.parametrize("leaf", NUMBERS, ids=str)
@pytest.mark.parametrize("junk", [None, True, False, "1.0", "", [1], {}, math.nan, math.inf, -math.inf, 10**400])
def test_no_number_is_replaced_by_something_else(leaf, junk):
    (line,) = problems(replaced(leaf.path, junk))
    assert line.startswith(f"{leaf} is ")
    assert leaf.entry["description"] in line


@pytest.mark.parametrize("leaf", NUMBERS, ids=str)
def test_a_number_is_refused_outside_its_bounds_and_not_inside(leaf):
    refusal = re.compile(rf"{re.escape(str(leaf))} is .*: {re.escape(leaf.entry['description'])}$")
    for side, outward in (("inimum", -1), ("aximum", 1)):
        closed = f"m{side}" in leaf.entry
        bound = leaf.entry[f"m{side}" if closed else f"exclusiveM{side}"]
        step = outward if leaf.entry["type"] == "integer" else outward * 1e-6 * max(1, abs(bound))
        values = (bound - step, bound, bound + step)
        refused = [any(map(refusal.match, problems(replaced(leaf.path, value)))) for value in values]
        assert refused == [False, not closed, True]


@pytest.mark.parametrize(
    "overlay",
    [
        (ROOT / "workflow/smoke.yaml").read_text(encoding="utf-8"),
        "surfaces: {Mine: {rms_nm: 2, skewness: -0.5, kurtosis: 3.5, psd: identified, mean_summit_radius_um: 0.5, "
        "summit_density_per_um2: 30}}\npairs: {d: {beam: Mine, substrate: Sub2, gap_um: 3.5, humidities: [0.675]}}\n"
        "run: {pairs: [d]}",
        "surfaces: {B1: {skewness: 0, kurtosis: 3}}",
        "surfaces: {B1: {skewness: 0, kurtosis: 2}}",
        "surfaces: {B1: {kurtosis: 1.7}}",
        "surfaces: {B1: {psd: identified}}",
        "surfaces: {B1: {published_psd: {cutoff_rad_per_um: 314.159}}}",
        "surfaces: {B1: {published_psd: {corner_rad_per_um: 137.9, floor_nm4: 524}}}",
        "sampling: {margin_um: 0.9}",
        "sampling: {strip_length_um: 1.25}\nstudies: {readings: {every: []}}",
        "sampling: {spacing_nm: 5}",
        "character: {spacing_nm: 10}",
        "character: {spacing_nm: 500}",
        "identification: {patch_um: 0.9}",
        "contact: {every: 2}",
        "studies: {readings: {every: [3, 10], spacing_nm: [7.5, 11.71875]}}",
        "studies: {readings: {every: [], spacing_nm: []}}",
        "studies: {mesh: {elements_um: [7, 30], strips_um: [4, 3]}}",
        "contact: {chunks: 5000}",
        "contact: {samples: 1820}",
        "chaos: {order: 1}",
        "beam: {elements: 1000}",
        "beam: {scatter: 0}",
        "beam: {length_um: 21, width_um: 20.98, elements: 7}",
        "pairs: {a: {humidities: [0.0001, 0.9999, 0.5]}}",
        "pairs: {a: {substrate: B1}}",
        "van_der_waals: none",
        "run: {pairs: [c, a]}",
    ],
)
def test_what_just_obeys_the_laws_can_run(overlay):
    assert problems(changed(overlay)) == ()


def test_all_problems_are_found_at_once_and_each_only_once():
    lines = problems(
        changed(
            "surfaces: {B1: {rms_nm: -1}, B2: {kurtosis: 1.5}}\npairs: {a: {beam: B9, gap: 3}}\n"
            "contact: {chunks: 1.0}\nchaos: {order: 20}"
        )
    )
    keys = {line.split()[0] for line in lines}
    expected = {
        "surfaces.B1.rms_nm",
        "surfaces.B2.kurtosis",
        "pairs.a.beam",
        "pairs.a.gap",
        "contact.chunks",
        "chaos.order",
    }
    assert (keys, len(lines)) == (expected, 6)


def test_one_that_is_referred_to_is_sought_among_all_that_have_a_proper_name():
    lines = problems(changed("surfaces: {1: {}}\npairs: {a: {beam: B9}}\nfigures: {pair: d}"))
    assert "figures.pair is 'd', must be one of a, b, c" in lines
    assert "pairs.a.beam is 'B9', must be one of B1, B2, Sub1, Sub2" in lines


def test_an_identified_spectrum_needs_its_targets_and_a_published_one_its_parameters():
    identified = without(("surfaces", "B1", "mean_summit_radius_um"))
    identified["surfaces"]["B1"]["psd"] = "identified"
    (line,) = problems(identified)
    assert line.startswith("surfaces.B1.mean_summit_radius_um is missing")
    (line,) = problems(without(("surfaces", "B1", "published_psd")))
    assert line.startswith("surfaces.B1.published_psd is missing")


def test_files_are_merged_key_by_key_and_lists_replaced(tmp_path):
    overlay = tmp_path / "mine.yaml"
    overlay.write_text("run: {pairs: [b]}\ncontact: {samples: 2000}\n", encoding="utf-8")
    config = load([ROOT / "config.yaml", overlay], SCHEMA)
    assert config["run"]["pairs"] == ["b"]
    assert config["contact"] == PAPER["contact"] | {"samples": 2000}
    assert config["surfaces"] == PAPER["surfaces"]


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"seed: 1\nbeam: {elements: 2}\nseed: 2\n", "key 'seed' is given twice"),
        (b"beam:\n  elements: 2\n  elements: 2\n", "line 2, column 3"),
        (b"", "holds None, must be sections"),
        (b"- 1\n", "holds [1], must be sections"),
        (b"5000\n", "holds 5000, must be sections"),
        (b"a: [1\n", "expected ',' or ']'"),
        (b"a:\n\tb: 1\n", "cannot start any token"),
        (b"a: \xff\n", "cannot be read"),
        (b"a: \x00\n", "cannot be read"),
        (b"a: &x {b: *x}\n", "recursive"),
        (b"a: &x {b: [*x]}\n", "recursive"),
        (b"a: &x [*x]\n", "recursive"),
        (b"a: *x\n", "undefined alias"),
        (b"{[1]: 2}\n", "unhashable key"),
        (b"a: !!bool x\n", "cannot be read"),
        (b"a: !!python/object:os.system x\n", "could not determine a constructor"),
        (b"a: 2021-13-45\n", "cannot be read"),
        (b"a: 1\n---\na: 2\n", "expected a single document"),
        (b"a: " + b"1" * 5000, "cannot be read"),
        (b"[" * 2000, "cannot be read"),
    ],
)
def test_a_file_that_is_no_configuration_is_refused_in_one_line_with_its_name(tmp_path, content, said):
    path = tmp_path / "mine.yaml"
    path.write_bytes(content)
    with pytest.raises(ConfigError) as refused:
        read(path)
    assert str(path) in str(refused.value)
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(ConfigError, match=r"nowhere\.yaml cannot be read: .*No such file"):
        read(tmp_path / "nowhere.yaml")


def test_an_anchor_may_be_changed_key_by_key(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("base: &b {x: 1, y: 2}\nmine: {<<: *b, y: 3}\n", encoding="utf-8")
    assert read(path)["mine"] == {"x": 1, "y": 3}


def test_the_highest_order_is_that_of_the_chaos_model():
    assert SCHEMA["properties"]["chaos"]["properties"]["order"]["maximum"] == MAX_ORDER


def test_the_schema_is_one():
    jsonschema.Draft202012Validator.check_schema(SCHEMA)


def test_every_section_is_closed():
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
    "_K": "[K]",
}


@pytest.mark.parametrize("leaf", LEAVES, ids=str)
def test_the_description_of_a_key_ends_with_the_unit_of_its_name(leaf):
    # The last key on the path that has a unit; below it are free names.
    units = [UNITS[suffix] for key in leaf.path for suffix in sorted(UNITS, key=len) if key.endswith(suffix)][-1:]
    text = "string" in (leaf.entry["type"], leaf.entry.get("items", {}).get("type"))
    assert leaf.entry["description"].endswith(tuple(units or (["[name]", "[choice]"] if text else ["[-]"])))


@pytest.mark.parametrize("config", [None, [], 5, "seed: 1", {}, {None: 1}, math.nan, True])
def test_what_is_no_configuration_at_all_is_refused(config):
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
def test_what_python_cannot_print_is_refused(path, junk):
    (line,) = problems(replaced(path, UNPRINTABLE[junk]))
    assert "cannot be printed" in line


FUZZ = settings(max_examples=250, suppress_health_check=[HealthCheck.too_slow])
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


@st.composite
def mutilated(draw):
    """The paper's configuration after up to four accidents: values replaced, moved into range, keys lost or added."""
    config = {"root": copy.deepcopy(PAPER)}
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
def test_any_configuration_runs_or_is_refused_in_lines_that_name_a_key(config):
    for line in problems(config):
        assert re.match(r"\S.* (is|cannot) .*must ", line)
        assert "\n" not in line


def within(entry):
    """Values that the schema allows."""
    if "enum" in entry:
        return st.sampled_from(entry["enum"])
    if entry["type"] == "integer":
        return st.integers(entry["minimum"], entry["maximum"])
    return st.floats(
        entry.get("minimum", entry.get("exclusiveMinimum")),
        entry.get("maximum", entry.get("exclusiveMaximum")),
        exclude_min="exclusiveMinimum" in entry,
        exclude_max="exclusiveMaximum" in entry,
    )


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.text(alphabet="abé1.-~: {}[]\n\t,'\"&*!<>?|%@#=0e") | st.text())
def test_any_text_is_read_as_sections_or_refused_in_one_line(tmp_path, text):
    path = tmp_path / "mine.yaml"
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    try:
        assert isinstance(read(path), dict)
    except ConfigError as error:
        refused = str(error)
    else:
        return
    assert refused.startswith(str(path))
    assert len(refused.splitlines()) == 1


SCALARS = NUMBERS + [leaf for leaf in LEAVES if "enum" in leaf.entry]


@FUZZ
@given(
    st.lists(
        st.sampled_from(SCALARS).flatmap(lambda leaf: st.tuples(st.just(leaf.path), within(leaf.entry))), max_size=8
    )
)
def test_values_that_the_schema_allows_meet_only_laws(values):
    config = copy.deepcopy(PAPER)
    for path, value in values:
        section = config
        for key in path[:-1]:
            section = section[key]
        section[path[-1]] = value
    for line in problems(config):
        assert re.match(r"[\w.\[\]]+ is .*, must ", line)
        assert not any(leaf.entry["description"] in line for leaf in SCALARS)
