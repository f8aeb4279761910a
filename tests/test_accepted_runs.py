"""What ``check`` accepts, a small run computes: odd stoppers in dry and in humid air, smooth or of strange solids."""

import numpy as np
import pytest
from drawn_devices import SMALL

import stiction
from stiction import pilot
from stiction.config.merging import merged
from stiction.plan.graph import Results
from stiction.run.disk_cache import DiskCache

#: Narrow strips, and as few as a study of full contact may have.
FEW = {"studies": {"full_contact": {"samples": 8}}, "beam": {"width_um": 3}, "contact": {"samples": 60}}


def odd(number):
    """Stopper on surfaces between smooth and rough, of solids from soft to strongly attractive."""
    rng = np.random.default_rng([24, number])
    rms, hamaker = 10 ** rng.uniform(-0.7, 0.6), 10 ** rng.uniform(1.5, 4)
    air = "dry" if rng.uniform() < 0.7 else 0.5
    side = float(rng.choice([1, 3, 6]))
    solid = {"hamaker_constant_zJ": {"water": round(hamaker / 2, 1), "dry": round(hamaker, 1)}}
    solid |= {"young_modulus_GPa": float(rng.choice([3, 70, 164, 1000]))}
    device = {
        "kind": "stopper",
        "pair": "odd",
        "contact_um": [side, side],
        "restoring_force_uN": 20,
        "humidities": [air],
    }
    return {
        "materials": {"Odd": solid},
        "surfaces": {"B2": {"rms_nm": round(rms, 3), "material": "Odd"}, "Sub1": {"material": "Odd"}},
        "pairs": {"odd": {"beam": "B2", "substrate": "Sub1", "gap_um": 2, "humidities": [air]}},
        "devices": {"D": device},
    }


def outcome(*overlays):
    """Sentences of check, or P(stuck) of a small run."""
    config = stiction.load(merged(SMALL, FEW), *overlays)
    refused = list(map(str, pilot.problems(config, {}, "code", DiskCache("none"))))
    return refused or float(Results.of(config)["devices/stoppers/D"].stuck.max())


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("number", range(2, 8))
def test_odd_stoppers_are_refused_in_a_sentence_or_computed(number):
    found = outcome(odd(number))
    if isinstance(found, list):
        assert all(", must " in line for line in found)
    else:
        assert 0 <= found <= 1


@pytest.mark.slow
@pytest.mark.parametrize(
    "changes", [{"B2": {"rms_nm": 0.3}}, {"B2": {"material": "Strong"}, "Sub1": {"material": "Strong"}}]
)
def test_strips_that_full_contact_cannot_correct_are_refused_before_the_run(changes):
    """At 0.3 nm rms, or with 10 000 zJ, patches of a stopper may resist where no strip does."""
    strong = {"Strong": {"hamaker_constant_zJ": {"water": 5000, "dry": 10000}}}
    of = odd(0) | {"materials": strong, "surfaces": changes}
    of["devices"] = {"D": of["devices"]["D"] | {"contact_um": [3, 3], "humidities": ["dry"]}}
    (line,) = outcome(of)
    assert line.startswith("devices.D.pair is 'odd', must have ")
    assert "contact.model: summits" in line
