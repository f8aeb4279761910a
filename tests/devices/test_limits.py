import re

import numpy as np
import pytest
from beams import PAPER

from stiction.constants import WATER_MOLECULE
from stiction.contact.materials import OF_COATINGS, PROPERTIES
from stiction.devices.limits import rules as limits
from stiction.report.limits.words import not_modelled, text

UM, NM = 1e-6, 1e-9

WORDS = tuple(one.words for one in PROPERTIES.values())
#: Arguments that trigger a warning, a number that its sentence must contain, and arguments that do not trigger it.
CASES = [
    (limits.long_strips, (1.5 * UM, 1.2 * UM), "1.5 µm.*1.2 µm.*stop too early.*safe side", (1.2 * UM, 1.2 * UM)),
    (limits.long_strips, (1.5 * UM, 1.2 * UM, True), "1.2 µm.*middle of this bridge", (1.2 * UM, 1.2 * UM, True)),
    (limits.long_strips, (2.5 * UM, 1.2 * UM), "nothing is simulated.*safe side", (0.5 * UM, 1.2 * UM)),
    (limits.arcs_of_elements, (0.42, 1.5 * UM), "42 %.*1.5 µm.*under `devices`", (0.0, 1.5 * UM)),
    (limits.cut_off_mean, (0.58, 1400 * UM, 1500 * UM), "58 %.*1400 µm.*1500 µm", (1.0, 700 * UM, 1500 * UM)),
    (limits.plastic_contact, (0.58, 1.04e8), "58 %.*2 %.* with 104 MPa", (0.02, 1.04e8)),
    (limits.plastic_contact, (np.nan, np.nan), "was not checked.*distance_nm", (0.0, 3e7)),
    (limits.default_material, ("gold", ("hardness",)), "4 properties of gold.*Hamaker constant", ("polysilicon", ())),
    (
        limits.default_material,
        ("gold", WORDS[1:]),
        "^1 property of gold is not.*: Young's modulus.$",
        ("gold", WORDS),
    ),
    (limits.default_material, ("gold", ()), "5 properties of gold", ("gold", WORDS)),
    (limits.spacer, ("FDTS", ("contact angle", "coating")), "coating of FDTS.* on the unsafe side", ("gold", WORDS)),
    (
        limits.spacer,
        ("FDTS", ("coating",)),
        "coating_hamaker_constant_zJ includes it",
        ("FDTS", tuple(OF_COATINGS.values())),
    ),
    (limits.flat_patches, (0.024,), "2.4 % of the patches.*safe side", (0.0,)),
    (limits.smooth_pair, (1.014 * NM, [0.5, 0.9]), "1 nm rms.* 24 ± 1 % at RH 0.9", (3.4 * NM, [0.9])),
    (limits.smooth_pair, (0.528 * NM, [0.97]), "0.53 nm rms.* 38 ± 6 % at RH 0.97", (3.4 * NM, [0.97])),
    (limits.unknown_full_contact, ([0.5],), "takes too long, at a relative humidity of 0.5.* by up to 51 %", ([],)),
    (limits.few_strips, (0.45,), "45 % of the squared error", (0.3,)),
    (limits.few_strips, (0.45,), "hardly known", (np.nan,)),
    (limits.thin_film, (1 * NM,), "1 nm high, thinner than 4 molecules, 1.12 nm", (1.13 * NM,)),
    (limits.thin_film, (1 * NM,), "dry air and for the next humidity above do not bound it", (0.0,)),
    (limits.thin_film, (0.5 * NM,), "0.5 nm high, thinner than 3 molecules.*worst of three airs", (1.13 * NM,)),
    (limits.beyond_isotherm, (0.9, 0.95), "RH 0.95 is wetter than.*RH 0.9.*unsafe side", (0.9, 0.9)),
    (
        limits.condensing,
        ([{"temperature_C": -20, "dew_point_C": 10}, {"temperature_C": 10, "dew_point_C": 10}],),
        "-20 °C with a dew point of 10 °C, 10 °C with a dew point of 10 °C.*not in the model: this is the unsafe side",
        ([{"temperature_C": 11, "dew_point_C": 10}, {"temperature_C": -20, "humidity": 0.5}],),
    ),
    (
        limits.supercooled,
        ([{"temperature_C": -5, "dew_point_C": -10}, {"temperature_C": -20, "humidity": 0.5}],),
        "^At -20 and -5 °C water counts as a supercooled liquid",
        ([{"temperature_C": 0, "humidity": 0.5}, {"temperature_C": -20, "dew_point_C": 10}],),
    ),
    (
        limits.no_water,
        (0.0, 0.45),
        "cosines .* zero or less: results at any humidity are those for dry",
        (1 * NM, 0.45),
    ),
    (limits.no_water, (0.0, 0.45), "No water condenses", (0.0, 0.0)),
    (limits.wide_meniscus, (10 * UM, (3 * UM, 3 * UM)), "10 µm.*667 %.*10 %", (0.1 * UM, (3 * UM, 3 * UM))),
    (
        limits.filled_gap,
        (2 * UM, 103 * NM, 3.4 * NM),
        "2 µm.*sum of film height and roughness, 106 nm: the water acts",
        (20 * UM, 103 * NM, 3.4 * NM),
    ),
    (
        limits.filled_gap,
        (0.05 * UM, 0.0, 3.4 * NM),
        "0.05 µm.*20 times the roughness, 3.4 nm: the attraction across gaps acts",
        (0.07 * UM, 0.0, 3.4 * NM),
    ),
    (limits.large_rotation, (40 * UM, 500 * UM), "500 µm.*0.12.*by about 0.14 %: .* safe side", (20 * UM, 700 * UM)),
    (limits.large_rotation, (200 * UM, 500 * UM), "0.6.*by more: .* safe side", (20 * UM, 700 * UM)),
    (limits.stubby_beam, (50 * UM, 2.6 * UM), "50 µm.*19.2 times.*shorten it by about 2.6 %", (52.1 * UM, 2.6 * UM)),
    (limits.wide_beam, (20 * UM, 500 * UM, 2.6 * UM, 700 * UM), "700 µm.*23.5", (20 * UM, 30 * UM, 2.6 * UM, 700 * UM)),
    (limits.resampled_strips, (500,), "from the 500 samples.*contact.samples", (0,)),
    (limits.lengths_of_sizes, (0.004,), "err by 0.4% at sizes between these", (0.0,)),
    (limits.repeated_strips, (0.44, 1.5 * UM, False), "of 1.5 µm.* 0.44.* the safe side.$", (0, 1.5 * UM, False)),
    (limits.repeated_strips, (0.44, 1.5 * UM, True), "this is the unsafe side", (0, 1.5 * UM, True)),
    (limits.strips_move_alone, (35 * NM,), "a play of 35 nm.*the unsafe side: state a device", (0.0,)),
    (limits.missed_accuracy, (0.03, 0.04, 0.02), "5 %, more than the 2 %.*more contact.samples", (0.01, 0.01, 0.02)),
    (limits.missed_accuracy, (0.03, float("nan"), 0.02), "is 3 %.*more design.beams", (0.01, float("nan"), 0.02)),
    (limits.stretched_bridge, (2 * UM, 2 * UM), "gap is equal to the thickness of", (0.9 * UM, 2 * UM)),
    (limits.stretched_bridge, (3 * UM, 2 * UM), "gap is 1.5 times the thickness of", (0.9 * UM, 2 * UM)),
]
EACH = pytest.mark.parametrize(("limit", "beyond", "number", "within"), CASES)


@EACH
def test_beyond_a_limit_the_warning_is_a_sentence_with_the_number_and_within_there_is_none(
    limit, beyond, number, within
):
    found = limit(*beyond)
    assert limits.triggered(found, None) == [found]
    sentence = text(found)
    assert re.search(number, sentence), sentence
    assert sentence[-1] == "."
    assert limit(*within) is None


def test_every_limit_is_tested():
    functions = {
        value for name, value in vars(limits).items() if callable(value) and value.__module__ == limits.__name__
    }
    assert functions == {case[0] for case in CASES} | {
        limits.triggered,
        limits.beam_warnings,
        limits.length_warnings,
        limits.least_gap,
        limits.without_gaps,
    }


#: Ratio, as a function of the limit, of a quantity that scales with one argument; its warning appears just beyond it.
@pytest.mark.parametrize(
    ("limit", "at"),
    [
        (lambda x: limits.large_rotation(x, 1.0), 0.1 / 1.5),
        (lambda x: limits.wide_beam(x, 1.0, 1.0, 1.0), 10 / 6),
        (lambda x: limits.stubby_beam(1 / x, 1.0), 1 / 20),
        (lambda x: limits.filled_gap(1 / x, 0.3, 0.7), 1 / 20),
        (lambda x: limits.plastic_contact(x, 3e7), 0.02),
        (lambda x: limits.stretched_bridge(x, 1.0), 0.5),
        (lambda x: limits.thin_film(4 * WATER_MOLECULE / x), 1.0),
        (lambda x: limits.wide_meniscus(x, (0.3, 0.6)), 0.1 / 5),
        (lambda x: limits.beyond_isotherm(0.9, x), 0.9),
    ],
)
def test_a_warning_appears_at_its_limit(limit, at):
    assert limit(at * (1 - 1e-9)) is None
    assert limit(at * (1 + 1e-9)) is not None


def test_the_paper_s_beam_and_its_humidities_are_within_the_limits():
    for crack, film in ((952 * UM, 1.3 * NM), (387 * UM, 12.5 * NM)):
        assert limits.beam_warnings(PAPER.gap, PAPER.width, PAPER.thickness, crack, film, 3.4 * NM) == []


def test_a_beam_beyond_all_limits_has_all_warnings():
    assert len(limits.beam_warnings(20 * UM, 100 * UM, 10 * UM, 100 * UM, 2e-6, 3.4 * NM)) == 4


def test_what_is_not_in_the_model_is_said():
    for word in ("drying", "charge", "wear", "curl", "condense", "separate faster"):
        assert word in not_modelled()
    dry = not_modelled(["bent"], humid=False)
    assert "bending of surfaces" in dry
    assert "water" not in dry
