"""Findings about a configuration are kept whole until the configuration, its surfaces or the code change."""

from unittest.mock import patch

import pytest

from stiction import accuracy, pilot
from stiction.command import prepared as module
from stiction.command.prepared import prepared, problems_of_samples
from stiction.config.files import joined
from stiction.config.messages import Problem
from stiction.plan.numbers import Numbers
from stiction.run.disk_cache import NOWHERE, Caches
from stiction.run.fingerprint import PACKAGE, fingerprint

FOUND = [Problem(("devices", "C1", "humidities", 0), "is weak", (("seed",),)), Problem(("seed",), "is bad")]
BEAM = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 10, "width_um": 30, "humidities": [0.67]}
OPEN = {"run": {"pairs": [], "studies": []}, "devices": {"C1": BEAM}}
OTHER_CODE = patch.object(module, "fingerprint", lambda *_, **__: {"stiction.plan.plan": "changed"})


def counted(target, name, found):
    """Replace a function by one that returns something found, and count its calls."""
    return patch.object(target, name, side_effect=lambda *_: found)


def test_problems_of_samples_are_found_once(tmp_path):
    kept = Caches(tmp_path)
    with counted(pilot, "problems", FOUND) as found:
        for config, estimates in (({"seed": 1}, {}), ({"seed": 2}, {}), ({"seed": 2}, {"B2": {"rms_nm": 3}})):
            assert [problems_of_samples(config, estimates, kept) for _ in range(2)] == [FOUND] * 2
        assert found.call_count == 3
        with OTHER_CODE:
            problems_of_samples({"seed": 2}, {"B2": {"rms_nm": 3}}, kept)
        assert found.call_count == 4
        assert [problems_of_samples({"seed": 1}, {}, NOWHERE) for _ in range(2)] == [FOUND] * 2
        assert found.call_count == 6, "nothing is kept without a folder"


def test_numbers_are_decided_once(tmp_path):
    numbers = Numbers(None, 1000, {"b_1500x30000": 400}, {})
    with counted(accuracy, "numbers", numbers) as decided:
        first, again = (prepared(joined(OPEN), Caches(tmp_path)) for _ in range(2))
        assert first == again
        assert first.numbers == numbers
        assert first.config["design"]["samples_of_patches"] == {"b_1500x30000": 400}
        assert decided.call_count == 1
        thinner = OPEN | {"devices": {"C1": BEAM | {"thickness_um": 2.5}}}
        prepared(joined(thinner), Caches(tmp_path))
        assert decided.call_count == 2
        with OTHER_CODE:
            prepared(joined(thinner), Caches(tmp_path))
        assert decided.call_count == 3


@pytest.mark.parametrize("name", ["pilot", "accuracy"])
def test_the_code_of_findings_is_all_that_they_import(name):
    code = fingerprint(PACKAGE / f"{name}.py", silent=())
    assert {"stiction.plan.plan", "stiction.plan.stage", "stiction.contact.forcelaw"} <= code.keys()
