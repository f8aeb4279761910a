"""Which keys of a configuration hold any text: all others refuse what is no word or name that they know."""

import copy
import re

import pytest
from configurations import SCHEMA, changed, problems
from hostile import HOSTILE

#: Keys whose text a user chooses. Where it is shown, it is looked at by the tests that import `hostile`: those of the
#: front page, tables, pages and figures, and tests/workflow/test_hostile_text.py for a whole report.
FREE = (
    {f"surfaces.NAME.scans.{key}" for key in ("files.0", "channel", "left_out.0")}
    | {"surfaces.NAME.profiles.files.0"}
    | {"test_beams.NAME.file"}
)
FREE |= {"process.NAME.settings.0.scans.0"}
#: A configuration that has all other keys with names of its own parts.
FULL = """
materials: {Oxide: {}}
surfaces: {B2: {material: Oxide}}
studies: {plasticity: {distance_nm: {b: 4}}, pressing: {distance_nm: {b: 4}}}
test_beams:
  A: {pair: b, length_um: 1500, thickness_um: 2.5, gap_um: 2, width_um: 30,
      crack_lengths: [{humidity: 0.67, mean_um: 700, std_um: 20, beams: 9}]}
  D: {probe: P, pull_offs: [{humidity: 0.67, forces_nN: [3000], error_nN: 300}]}
devices:
  P: {kind: probe, pair: b, humidities: [0.67], radius_um: 10}
  C: {kind: cantilever, pair: b, humidities: [0.67], thickness_um: 2.5, gap_um: 2, width_um: 30, test_beams: [A],
      uncertainty: {thickness_um: 0.1}, requirement: {share: 0.01, length_um: 300},
      roughness: {surface: B2, rms_nm: [3, 5]}, process: etch}
process:
  etch: {variable: etch_time_s, surface: B2, settings: [{value: 30, rms_nm: 3, uncertainty: {rms_nm: 0.1}},
    {value: 60, rms_nm: 4, uncertainty: {rms_nm: 0.1}}]}
  polish: {variable: etch_time_s, surface: Sub1, settings: [{value: 30, rms_nm: 0.2, uncertainty: {rms_nm: 0.01}},
    {value: 60, rms_nm: 0.3, uncertainty: {rms_nm: 0.01}}], together_with: etch}
"""


def texts(entry, path=()):
    """Every key, or name of a key, that the schema takes as text without a list of its values: path and pattern."""
    if entry.get("type") == "string" and "enum" not in entry:
        yield ".".join(path), entry.get("pattern")
    if "propertyNames" in entry:
        yield ".".join((*path, "NAME")), entry["propertyNames"]["pattern"]
    for key, inside in entry.get("properties", {}).items():
        yield from texts(inside, (*path, key))
    for part, key in (("additionalProperties", "NAME"), ("items", "0")):
        if isinstance(entry.get(part), dict):
            yield from texts(entry[part], (*path, key))


TEXTS = dict(texts(SCHEMA))


def test_every_text_of_the_schema_is_here():
    assert TEXTS.keys() >= FREE
    assert {"run.pairs.0", "devices.NAME", "materials.NAME"} <= TEXTS.keys()


@pytest.mark.parametrize("path", [path for path, pattern in TEXTS.items() if pattern])
def test_a_name_has_no_sign_with_a_meaning(path):
    accepted = next(text for text in ("b", "surfaces.B2.rms_nm") if re.search(TEXTS[path], text))
    for sign in {*HOSTILE} - {*"_."} - {*filter(str.isalnum, HOSTILE)}:
        for end in range(len(accepted) + 1):
            assert not re.search(TEXTS[path], f"{accepted[:end]}{sign}{accepted[end:]}")


@pytest.mark.parametrize("path", [path for path, pattern in TEXTS.items() if not pattern and path not in FREE])
def test_a_key_that_names_a_part_of_the_configuration_refuses_other_text(path):
    config = copy.deepcopy(changed(FULL))
    assert problems(config) == ()
    *keys, last = (int(key) if key.isdigit() else key for key in path.split("."))
    section = config
    for key in keys:
        own = [name for name in section if last in section[name]] if key == "NAME" else []
        section = section[(own or [*section])[-1] if key == "NAME" else key]
    section[last] = HOSTILE
    assert repr(HOSTILE)[:40] in "\n".join(problems(config))
