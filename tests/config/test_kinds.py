"""Kinds of devices: the table, the schema and the mechanics of beams know the same kinds."""

from itertools import chain, combinations

import pytest

from stiction.config.kinds import BEAM, COMMON, KEYS, KINDS, OF_SPRINGS, PULL_OFF
from stiction.config.relations import schema
from stiction.stages.devices.end_states import END_STATES
from stiction.stages.devices.opening import BEAMS

SECTION = schema()["properties"]["devices"]["additionalProperties"]["properties"]
KNOWN = {key for kind in KINDS.values() for key in kind.allowed_keys}


def test_the_schema_knows_all_kinds_and_the_keys_of_each_and_no_others():
    assert SECTION["kind"]["enum"] == list(KINDS)
    assert set(SECTION) == KNOWN
    assert {*COMMON, *KEYS} <= KNOWN


@pytest.mark.parametrize("name", KINDS)
def test_a_kind_that_cracks_open_has_mechanics_with_a_tip_if_it_has_one(name):
    kind = KINDS[name]
    assert {*kind.keys, *chain.from_iterable(way.keys for way in kind.ways)} <= set(KEYS)
    assert (kind.release is BEAM) == (name in BEAMS)
    if kind.release is BEAM:
        assert kind.has_tip == BEAMS[name].has_tip
        assert {f"{size}_{unit}" for size in BEAMS[name].sizes for unit in ("um", "MPa")} >= set(kind.keys)
        assert all(END_STATES[shape].by and END_STATES[shape].legend for shape in BEAMS[name].shapes)


def test_a_device_states_its_force_in_exactly_one_way():
    kind, ways = KINDS["stopper"], [{"restoring_force_uN"}, {"stiffness_N_per_m", "gap_um"}]
    stated = sorted(set().union(*ways))
    for number in range(len(stated) + 1):
        for keys in combinations(stated, number):
            refusal = kind.refusal(["kind", "pair", "humidities", "contact_um", *keys])
            assert (refusal is None) == (set(keys) in ways), keys
            assert refusal is None or "either restoring_force_uN, or stiffness_N_per_m and gap_um" in refusal


def test_a_probe_without_a_spring_is_asked_for_its_pull_off_force_and_has_no_keys_of_springs():
    kind, own = KINDS["probe"], ["kind", "pair", "humidities", "radius_um"]
    for keys, question in (
        ([], PULL_OFF),
        (["measured_nN", "measured_error_nN"], PULL_OFF),
        (["restoring_force_uN"], "stopper"),
        (["stiffness_N_per_m", "gap_um"], "stopper"),
    ):
        assert kind.refusal([*own, *keys]) is None
        assert kind.question(dict.fromkeys([*own, *keys], 1)) == question
        assert ("restoring_force_uN" in kind.stated(dict.fromkeys([*own, *keys], 1))) == (question == "stopper")
        for key in OF_SPRINGS:
            refusal = kind.refusal([*own, *keys, key])
            assert (refusal is None) == (question == "stopper")
            assert refusal is None or refusal.startswith(
                f"must come without {key}, or with a spring: restoring_force_uN, or"
            )
    assert "must come with either restoring_force_uN, or" in kind.refusal([*own, "measured_nN"])
    assert all(one.question({}) == one.release.name for one in KINDS.values() if not one.ways)


@pytest.mark.parametrize("name", KINDS)
def test_a_key_of_another_kind_is_refused_with_the_keys_of_this_one(name):
    kind = KINDS[name]
    for strange in sorted(KNOWN - {*kind.allowed_keys}):
        refusal = kind.refusal([*kind.keys, strange])
        assert refusal == f"must come without {strange}: its keys are {', '.join(kind.allowed_keys)}"


def test_the_force_of_a_spring_is_its_stiffness_times_its_deflection():
    for stiffness, gap in ((2, 1.5), (0.1, 3), (40, 0.2)):
        stated = KINDS["stopper"].stated({"stiffness_N_per_m": stiffness, "gap_um": gap})
        assert stated["restoring_force_uN"] * 1e-6 == pytest.approx(stiffness * gap * 1e-6, rel=1e-15)
