"""Kinds of devices: the table, the schema and the mechanics of beams know the same kinds."""

import pytest

from stiction.config.kinds import COMMON, KEYS, KINDS
from stiction.config.relations import schema
from stiction.stages.devices.end_states import END_STATES
from stiction.stages.devices.opening import BEAMS

SECTION = schema()["properties"]["devices"]["additionalProperties"]["properties"]


def test_the_schema_knows_all_kinds_and_the_keys_of_each_and_no_others():
    assert SECTION["kind"]["enum"] == list(KINDS)
    keys = [*COMMON, *KEYS, *(key for kind in KINDS.values() for key in kind.optional)]
    assert set(keys) == set(SECTION)


@pytest.mark.parametrize("name", KINDS)
def test_a_kind_that_cracks_open_has_mechanics_with_a_tip_if_it_has_one(name):
    kind = KINDS[name]
    assert set(kind.keys) <= set(KEYS)
    assert kind.is_beam == (name in BEAMS)
    if kind.is_beam:
        assert kind.has_tip == BEAMS[name].has_tip
        assert {f"{size}_{unit}" for size in BEAMS[name].sizes for unit in ("um", "MPa")} >= set(kind.keys)
        assert all(END_STATES[shape].by and END_STATES[shape].legend for shape in BEAMS[name].shapes)
