"""Materials by name: numbers with their sources, within the relations of theory, and the same as when stated."""

import numpy as np
import pytest
from configurations import ROOT, SCHEMA, problems
from jsonschema import Draft202012Validator
from scipy.constants import Planck

import stiction
from stiction.config.files import joined
from stiction.config.materials import sourced_properties
from stiction.config.units import in_si
from stiction.contact.materials import PROPERTIES, Solid

NAMED = sourced_properties()
ENTRIES = SCHEMA["properties"]["materials"]["additionalProperties"]["properties"]
#: Hamaker constant of water in vacuum [zJ]; Israelachvili, Intermolecular and Surface Forces.
WATER = 37.0
each_material = pytest.mark.parametrize("name", NAMED)


def values(name):
    """Values of a material as a configuration states them."""
    return {key: entry["value"] for key, entry in NAMED[name].items()}


def through_water(dry):
    """Hamaker constant through water by the combining relation of textbooks [zJ]."""
    return (np.sqrt(dry) - np.sqrt(WATER)) ** 2


@each_material
def test_every_property_is_allowed_and_has_a_source(name):
    wanted = {entry.key for entry in PROPERTIES.values()} - {"contact_angle_deg"} | {"density_kg_per_m3"}
    assert set(NAMED[name]) == wanted  # angles depend on the state of a surface more than on its material
    for key, entry in NAMED[name].items():
        assert Draft202012Validator(ENTRIES[key]).is_valid(entry["value"])
        assert len(entry["source"]) > 8
        assert entry.get("read", "table").split()[0] in ("abstract", "table", "quoted")
    solid = in_si(Solid, {key: value for key, value in values(name).items() if key != "density_kg_per_m3"})
    assert solid.hardness < solid.young_modulus / 5  # bonds break at strains of 0.1


@each_material
def test_attraction_through_water_is_near_the_combining_relation(name):
    constants = values(name)["hamaker_constant_zJ"]
    expected = through_water(constants["dry"])
    assert expected / 1.5 < constants["water"] < 2.5 * expected
    swapped = through_water(constants["water"])  # the control
    assert not swapped / 1.5 < constants["dry"] < 2.5 * swapped


def test_constants_that_nobody_measured_are_those_of_their_relations():
    assert values("gold")["hamaker_constant_zJ"]["dry"] == pytest.approx((np.sqrt(250) + np.sqrt(WATER)) ** 2, abs=0.5)
    metal = 1e21 * 3 * Planck * 4e15 / (16 * np.sqrt(2))
    for name in ("aluminium", "nickel"):
        constants = values(name)["hamaker_constant_zJ"]
        assert constants["dry"] == pytest.approx(metal, abs=0.5)
        assert constants["water"] == pytest.approx(through_water(metal), abs=0.5)


def test_the_schema_names_all_materials():
    assert set(ENTRIES["like"]["enum"]) == set(NAMED)


@each_material
def test_a_name_stands_for_its_numbers(name):
    by_name = stiction.load({"surfaces": {"B2": {"material": name}}})
    assert by_name == stiction.load({"surfaces": {"B2": {"material": name}}, "materials": {name: values(name)}})
    mine = {"contact_angle_deg": 60, "young_modulus_GPa": 55}
    like = stiction.load({"surfaces": {"B2": {"material": "Mine"}}, "materials": {"Mine": {"like": name} | mine}})
    assert like["materials"] == {"Mine": values(name) | mine}


def test_own_materials_come_first_and_unknown_names_are_refused():
    own = {"surfaces": {"B2": {"material": "gold"}}, "materials": {"gold": {"young_modulus_GPa": 60}}}
    assert stiction.load(own)["materials"] == {"gold": {"young_modulus_GPa": 60}}
    (line,) = problems(joined({"surfaces": {"B2": {"material": "golt"}}}))
    assert line.startswith("surfaces.B2.material is 'golt', must be one of gold, ")
    assert line.endswith("did you mean gold?")
    (line,) = problems(joined({"materials": {"Mine": {"like": "golt"}}}))
    assert line.startswith("materials.Mine.like is 'golt', must be one of gold, ")


def test_the_switch_of_the_example_is_heavy_gold_over_nitride():
    config = stiction.load(ROOT / "examples" / "switch.yaml")
    lines = (ROOT / "examples" / "switch.yaml").read_text().splitlines()
    assert sum(bool(line) and not line.startswith("#") for line in lines) <= 10
    assert config["materials"]["gold"]["density_kg_per_m3"] == 19300
    assert config["devices"]["Charged"]["pair"] == "switch"
