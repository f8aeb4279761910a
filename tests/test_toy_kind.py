"""A kind of device that the package does not have, from its registration to its page: a torsion mirror.

Its stopper touches at an arm r from the axis when the mirror has turned by θ, so that its spring of stiffness k pulls
with the force k θ / r.
"""

import json
import math

import pytest
from drawn_devices import RUN, Files

import stiction
from stiction.config.kinds import KEYS, KINDS, STOPPER, Kind, Way
from stiction.config.messages import ConfigError
from stiction.config.relations import schema
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.stages.answer.answer import answer_of
from stiction.stages.life.answers import answers_of

SPRING = "torsion_nN_m_per_rad"
#: Force for a stiffness of 1 nN m/rad [µN]: (1e-9 N m/rad) θ / (1e-6 m) = 1e-3 N = 1000 µN, for θ = 1 rad and r = 1 µm.
PER = Way((SPRING, "angle_deg", "arm_um"), lambda mirror: 1e3 * math.radians(mirror["angle_deg"]) / mirror["arm_um"])
MIRROR = Kind(words="torsion mirror", drawing="stopper.svg", keys=("contact_um",), ways=(PER,), release=STOPPER)
NUMBERS = {
    SPRING: ("torsional stiffness of the spring", "nN·m/rad"),
    "angle_deg": ("angle in contact", "°"),
    "arm_um": ("arm of the contact", "µm"),
}
COMMON = {"pair": "b", "contact_um": [1, 1], "humidities": [0.6]}
OWN = {SPRING: 0.2, "angle_deg": 3, "arm_um": 40}
FORCE = 0.2e-9 * math.radians(3) / 40e-6  # [N]
SMALL = {"run": {"pairs": [], "studies": []}, "contact": {"samples": 320, "chunks": 1}, "chaos": {"order": 2}}
SMALL |= {"studies": {"plasticity": {"strips": 2}}}


@pytest.fixture
def registered(monkeypatch):
    """Register the kind: its object, the words of its keys, and these in the schema."""
    section = schema()["properties"]["devices"]["additionalProperties"]["properties"]
    monkeypatch.setitem(KINDS, "mirror", MIRROR)
    monkeypatch.setitem(section["kind"], "enum", list(KINDS))
    for key, words in NUMBERS.items():
        monkeypatch.setitem(KEYS, key, words)
        monkeypatch.setitem(section, key, {"type": "number", "exclusiveMinimum": 0, "description": "a number"})


@pytest.mark.usefixtures("registered")
def test_a_mirror_needs_the_force_of_a_stopper_with_the_same_patch_and_force(tmp_path):
    stopper = {"kind": "stopper", "restoring_force_uN": 1e6 * FORCE}
    devices = {"Mirror": OWN | {"kind": "mirror"}, "Stopper": stopper, "Stiff": OWN | {"kind": "mirror", SPRING: 2.0}}
    config = stiction.load(SMALL | {"devices": {name: device | COMMON for name, device in devices.items()}})
    (tmp_path / "provenance.json").write_text(json.dumps([RUN]), encoding="utf-8")
    results = Files(Graph(Plan(config)), folder=tmp_path)
    mirror, stopper, stiff = (answer_of(results[f"devices/answer/{name}"]) for name in devices)
    assert mirror.size == pytest.approx(FORCE, rel=1e-12)
    assert stiff.size == pytest.approx(10 * FORCE, rel=1e-12)
    assert mirror.build == stopper.build == stiff.build > 0
    assert (mirror.stuck, mirror.kind) == (stopper.stuck, "mirror")
    asked = [{row.needs for row in answers_of(results[f"devices/life/{name}"])} for name in devices]
    assert [[any(key in needs for needs in some) for key in ("electrode", "mass_ng")] for some in asked] == [
        [False, False],
        [True, True],
        [False, False],
    ]
    assert stiff.stuck.value < mirror.stuck.value
    results.write(results.graph.job("devices/Mirror.html"))
    page = (tmp_path / "devices" / "Mirror.html").read_text(encoding="utf-8")
    assert all(words in page for words in ("torsion mirror", "torsional stiffness of the spring", "nN·m/rad"))


@pytest.mark.usefixtures("registered")
def test_a_mirror_without_its_arm_is_refused_with_its_keys():
    device = {"kind": "mirror", SPRING: 0.2, "angle_deg": 3} | COMMON
    with pytest.raises(ConfigError, match=f"must come with {SPRING} and angle_deg and arm_um"):
        stiction.load(SMALL | {"devices": {"M": device}})


def test_a_kind_that_is_not_registered_is_refused():
    with pytest.raises(ConfigError, match="kind"):
        stiction.load(SMALL | {"devices": {"M": OWN | {"kind": "mirror"} | COMMON}})
