"""Fraction stuck at a stated size beside the table of sizes, and limits that all estimates keep."""

import math

import pytest

from stiction.command.at_once import estimate
from stiction.estimate.answer import answer
from stiction.estimate.force import Stopper
from stiction.estimate.table import content, known

CANTILEVER = "--rms 3 --rh 0.6 --thickness 2.6 --gap 20"
STOPPER = "--rms 3 --rh 0.6 --contact 3 3"


def found(words):
    """Answer to the options of some words."""
    parser = estimate.argparse.ArgumentParser()
    estimate.add_options(parser)
    return answer(estimate._of_options(parser.parse_args(words.split()), content()["library"]), *known())


def stuck_at(words, size):
    """Fraction stuck at a size [m or N], with its ends of 95 %."""
    return found(f"{words} {'--force' if 'contact' in words else '--length'} {1e6 * size}").stuck


@pytest.mark.parametrize("often", [1, 100])
@pytest.mark.parametrize("like", ["", "--like B2"])
@pytest.mark.parametrize("device", [CANTILEVER, STOPPER])
def test_the_fraction_at_a_size_of_the_table_is_that_of_its_row(device, like, often):
    words = f"{device} {like} --touchdowns {often}"
    estimated = found(words)
    for row in estimated.rows[1:]:
        safe, other = sorted(row.intervals["95"], reverse=isinstance(estimated.question, Stopper))
        assert stuck_at(words, row.size)[0] == pytest.approx(row.fraction, rel=1e-6)
        assert stuck_at(words, safe)[2] == pytest.approx(row.fraction, rel=1e-6)
        assert stuck_at(words, other)[1] <= row.fraction * (1 + 1e-6)
        assert stuck_at(words, safe)[0] < 0.8 * row.fraction, "the control: the middle is another number"


@pytest.mark.parametrize("surface", ["--rms 1.7 --like B1", "--rms 3 --like B2", "--rms 5 --like B2"])
@pytest.mark.parametrize("air", [0.45, 0.6])
def test_lengths_have_the_exponents_of_tips_between_flooded_ones_and_those_of_equal_attraction(surface, air):
    def chosen(thickness, gap):
        return found(f"{surface} --rh {air} --thickness {thickness} --gap {gap}").chosen.size

    by_thickness = math.log(chosen(3.2, 20) / chosen(2.2, 20)) / math.log(3.2 / 2.2)
    by_gap = math.log(chosen(2.6, 25) / chosen(2.6, 15)) / math.log(25 / 15)
    assert 3 / 4 < by_thickness < 1.05
    assert 0.95 / 3 - 0.02 < by_gap < 1 / 2
    assert 2 * by_thickness / 3 + by_gap == pytest.approx(1, abs=0.02)  # only t³/h² matters beside the gap


@pytest.mark.parametrize("air", [0.45, 0.6, 0.8])
def test_forces_grow_with_area_at_most_as_fast(air):
    forces = [found(f"--rms 3 --like B2 --rh {air} --contact {side} {side}").chosen.size for side in (1.5, 2, 3, 4, 5)]
    exponents = [math.log(b / a) for a, b in zip(forces, forces[1:], strict=False)]
    steps = [2 * math.log(b / a) for a, b in zip((1.5, 2, 3, 4), (2, 3, 4, 5), strict=True)]
    assert all(0.5 < e / s < 1 for e, s in zip(exponents, steps, strict=True))


@pytest.mark.parametrize("device", [CANTILEVER, STOPPER])
def test_twice_the_touchdowns_stick_twice_as_many(device):
    size = found(device).chosen.size
    once, twice = (stuck_at(f"{device} --touchdowns {n}", size)[0] for n in (1, 2))
    assert twice == pytest.approx(2 * once - once**2, rel=1e-9)
