"""Studies of devices: messages name what they state, never figures, chaos model and beam of the paper."""

import math
from fractions import Fraction

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
LENGTHS = (("beam", "length_um"), ("sampling", "strip_length_um"), ("beam", "width_um"))


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


#: The same with the pair in the run, as in the first study of the README.
WITH_PAIR = {"run": {"pairs": ["mine"]}}
#: What a user would have to state for a refusal of the beam, the chaos model and the figures.
STATED = {"beam": {"length_um": 1501}, "chaos": {"order": 11}, "figures": {"humidity": 0.02}}


@pytest.mark.parametrize("more", [{}, WITH_PAIR], ids=["alone", "with pair"])
@pytest.mark.parametrize("number", range(24))
def test_no_message_names_what_the_study_does_not_state(number, more):
    lines = problems(joined(drawn(number), more))
    assert not [line for line in lines if line.startswith(OF_THE_PAPER)]


def test_the_drawn_studies_have_problems_with_what_they_state():
    """The control: the same studies with a beam, a chaos model and an air of figures that suit none of them."""
    lines = [line for number in range(24) for line in problems(joined(drawn(number), WITH_PAIR | STATED))]
    for section in OF_THE_PAPER:
        assert any(line.startswith(section) for line in lines), section
    assert any(problems(joined(drawn(number))) for number in range(24))


@pytest.mark.parametrize("number", range(24))
def test_lengths_that_are_not_stated_are_whole(number):
    study = merged(PAPER, drawn(number) | WITH_PAIR)
    rng = np.random.default_rng([99, number])
    study = merged(study, {"beam": {"elements": int(rng.integers(2, 400))}})
    if rng.uniform() < 0.5:
        study["sampling"]["strip_length_um"] = 1.5
    found = grid.completed(
        study | {"sampling": {k: study["sampling"][k] for k in ("spacing_nm", "strip_length_um")}}, {}
    )
    # The second route: whole picometres.
    picometres = [round(Fraction(str(found[section][key])) * 10**6) for section, key in LENGTHS]
    step = round(Fraction(found["sampling"]["spacing_nm"] * found["contact"]["every"]) * 1000)
    length, strip, width = picometres
    assert length % (strip * found["beam"]["elements"]) == 0
    assert strip % step == 0 or found["sampling"]["strip_length_um"] == study["sampling"]["strip_length_um"]
    assert width % step == 0


def test_strips_fit_a_beam_that_is_stated():
    found = grid.completed(merged(PAPER, {"beam": {"length_um": 1300}}), {})
    assert (found["sampling"]["strip_length_um"], found["beam"]["elements"]) == (1.3, 200)
    unfit = grid.completed(merged(PAPER, {"beam": {"length_um": 1301}}), {})
    assert unfit["sampling"]["strip_length_um"] == 1.5


def test_figures_show_an_air_of_their_pair_where_the_usual_one_has_no_film():
    coated = {
        "run": {"pairs": ["mine"], "studies": []},
        "materials": {"Mono": {"contact_angle_deg": 110}},
        "surfaces": {"B2": {"material": "Mono"}},
        "pairs": {"mine": {"beam": "B2", "substrate": "Sub1", "gap_um": 20, "humidities": [0.67, 0.8, 0.92]}},
    }
    assert stiction.load(coated)["figures"]["humidity"] == 0.67
    assert (
        stiction.load(merged(coated, {"materials": {"Mono": {"contact_angle_deg": 60}}}))["figures"]["humidity"] == 0.65
    )
    refused = problems(joined(coated, {"figures": {"humidity": 0.64}}))
    assert [line.partition(" ")[0] for line in refused] == ["figures.humidity"]


@pytest.mark.parametrize("samples", [5, 60, 300, 1819, 1820, 5000])
def test_devices_alone_have_the_largest_order_that_their_samples_carry(samples):
    study = merged(PAPER, {"run": {"pairs": []}, "contact": {"samples": samples, "chunks": 1}})
    order = grid.completed(study, {})["chaos"]["order"]
    # The second route: monomials of four variables, counted one by one.
    number = {top: sum(sum(powers) <= top for powers in np.ndindex(*[top + 1] * 4)) for top in (order, order + 1)}
    assert number[order] <= samples
    assert order == 12 or number[order + 1] > samples
    assert number[order] == math.comb(order + 4, 4)


def test_a_stated_order_stays():
    few = {
        "contact": {"samples": 300, "chunks": 1},
        "devices": {"C": DEVICES["C"] | {"pair": "b", "humidities": [0.5]}},
    }
    for study in (few, few | {"run": {"pairs": []}}):
        assert stiction.load(study)["chaos"]["order"] == 6
        assert stiction.load(study, {"chaos": {"order": 4}})["chaos"]["order"] == 4
        assert any(line.startswith("chaos.order is 7") for line in problems(joined(study, {"chaos": {"order": 7}})))
