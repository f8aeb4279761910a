"""Studies of devices alone: messages name what they state, never figures, chaos model and beam of the paper."""

import math

import numpy as np
import pytest
from configurations import PAPER, problems

import stiction
from stiction.config.files import joined
from stiction.config.merging import merged
from stiction.config.surfaces import grid

BEAM = {"pair": "mine", "thickness_um": 2, "gap_um": 2, "width_um": 5}
DEVICES = {
    "C": BEAM | {"kind": "cantilever"},
    "R": BEAM | {"kind": "bridge", "residual_stress_MPa": 50},
    "S": {"pair": "mine", "kind": "stopper", "contact_um": [3, 3], "restoring_force_uN": 5},
}
#: Sections of the paper of which a study of devices has no part, unless it states them.
OF_THE_PAPER = ("figures.", "chaos.", "beam.")


def drawn(number):
    """Study of devices in any air, on few samples, grids and strips that fit and that do not."""
    rng = np.random.default_rng([98, number])
    names = rng.choice(list(DEVICES), rng.integers(1, 4), replace=False)
    airs = [[0.5], [0.95], [0.1, 0.3], ["dry"], ["dry", 0.8]]
    air = airs[rng.integers(len(airs))]
    angle = int(rng.choice([0, 40, 80, 120]))
    sampling = {"strip_length_um": float(rng.choice([1.5, 0.8, 0.7, 0.75]))}
    sampling |= {"spacing_nm": int(rng.choice([5, 7, 10, 20]))} if rng.uniform() < 0.5 else {}
    psd = {"psd": "identified"} if rng.uniform() < 0.3 else {}
    return {
        "run": {"pairs": [], "studies": []},
        "materials": {"Mine": {"contact_angle_deg": angle}},
        "surfaces": {"B2": {"material": "Mine"} | psd, "Sub1": {"material": "Mine"}},
        "pairs": {"mine": {"beam": "B2", "substrate": "Sub1", "gap_um": 2, "humidities": air}},
        "water": {"temperature_K": int(rng.choice([280, 300, 360]))},
        "contact": {"samples": int(rng.choice([5, 60, 300, 1819, 5000])), "chunks": 1},
        "sampling": sampling,
        "character": {"spacing_nm": int(rng.choice([10, 20, 500]))},
        "devices": {name: DEVICES[name] | {"humidities": air} for name in map(str, names)},
    }


@pytest.mark.parametrize("number", range(24))
def test_no_message_names_what_the_study_has_no_part_of(number):
    lines = problems(joined(drawn(number)))
    assert not [line for line in lines if any(section in line for section in OF_THE_PAPER)]


def test_the_drawn_studies_have_problems_that_pairs_of_the_paper_would_add_to():
    """The control: the same studies with a pair in the run are told of its beam, chaos model and figures."""
    lines = [line for number in range(24) for line in problems(joined(drawn(number), {"run": {"pairs": ["mine"]}}))]
    for section in OF_THE_PAPER:
        assert any(section in line for line in lines), section
    assert any(problems(joined(drawn(number))) for number in range(24))


@pytest.mark.parametrize("samples", [5, 60, 300, 1819, 1820, 5000])
def test_devices_alone_have_the_largest_order_that_their_samples_carry(samples):
    study = merged(PAPER, {"run": {"pairs": []}, "contact": {"samples": samples, "chunks": 1}})
    order = grid.completed(study, {})["chaos"]["order"]
    # The second route: monomials of four variables, counted one by one.
    number = {top: sum(sum(powers) <= top for powers in np.ndindex(*[top + 1] * 4)) for top in (order, order + 1)}
    assert number[order] <= samples
    assert order == 12 or number[order + 1] > samples
    assert number[order] == math.comb(order + 4, 4)


def test_a_stated_order_stays_and_so_does_that_of_pairs():
    few = {
        "contact": {"samples": 300, "chunks": 1},
        "devices": {"C": DEVICES["C"] | {"pair": "b", "humidities": [0.5]}},
    }
    alone = few | {"run": {"pairs": []}}
    assert stiction.load(alone)["chaos"]["order"] == 6
    assert stiction.load(alone, {"chaos": {"order": 4}})["chaos"]["order"] == 4
    assert any(line.startswith("chaos.order is 7") for line in problems(joined(alone, {"chaos": {"order": 7}})))
    assert any(line.startswith("chaos.order is 12") for line in problems(joined(few)))
