"""Closed forms of the life of beams in plain Python: those of the engine, at 200 random beams."""

import math
from dataclasses import replace

import numpy as np
import pytest

from stiction.beam.cantilever import Beam
from stiction.estimate.closed import bending
from stiction.estimate.closed.beams import HALF_SINE, DryingLiquid, SlenderBeam
from stiction.life import drying, touch
from stiction.life.bending import Bent

DENSITY = 2330.0
#: Numbers of random beams with one and two clamps: together 200.
NUMBER = 100
#: Where the pinned angle of a liquid ends its surface has a kink, across which both integrate at their own points.
KINK = 1e-6
#: The engine sums the modes of a bridge that its polynomials have, which leaves out some.
MODES = 4e-4


def drawn(clamps, rng):
    """Random beam without and with a stress, a length [m], and a liquid that is pinned everywhere."""
    gap = rng.uniform(1e-6, 25e-6) if clamps == 1 else rng.uniform(0.5e-6, 5e-6)
    stress = 0.0 if clamps == 1 else float(rng.choice([0.0, 10 ** rng.uniform(3, 8.3)]))
    beam = SlenderBeam(
        clamps, rng.uniform(0.8e-6, 6e-6), gap, rng.uniform(5e-6, 40e-6), rng.uniform(60e9, 400e9), stress
    )
    return beam, rng.uniform(5e-5, 8e-4), DryingLiquid(10 ** rng.uniform(-2, -1))


def of_engine(beam, length=1.0):
    """Beam of the engine."""
    tension = beam.stress * beam.width * beam.thickness
    return Beam(length, beam.width, beam.thickness, beam.modulus, beam.gap, 1, tension)


def lengths(beam, liquid):
    """Lengths of the engine for a liquid: safe, of a connected liquid, and released."""
    engine, wetting = of_engine(beam), (liquid.surface_tension, liquid.contact_angle)
    return (
        drying.longest_standing_each(engine, beam.clamps, *wetting),
        drying.longest_standing(engine, beam.clamps, liquid.adhesion),
        drying.longest_free(engine, beam.clamps, liquid.adhesion),
    )


def touching(beam, length):
    """Slow shock and voltage at once of the engine."""
    engine = of_engine(beam, length)
    return touch.touching_acceleration(engine, beam.clamps, DENSITY), touch.pull_in_voltage_at_once(engine, beam.clamps)


@pytest.mark.parametrize("clamps", [1, 2])
def test_200_beams_have_the_lengths_shocks_and_voltages_of_the_engine(clamps):
    rng = np.random.default_rng(clamps)
    for _ in range(NUMBER):
        beam, length, liquid = drawn(clamps, rng)
        computed = beam.standing_each(liquid), beam.standing(liquid), beam.released(liquid)
        np.testing.assert_allclose(computed, lengths(beam, liquid), rtol=1e-9)
        shock, voltage = touching(beam, length)
        assert beam.slow_shock(length, DENSITY) == pytest.approx(shock, rel=1e-9 if clamps == 1 else 1e-6)
        assert beam.pull_in_at_once(length) == pytest.approx(voltage, rel=1e-9)


@pytest.mark.parametrize("clamps", [1, 2])
def test_a_half_sine_shock_is_that_of_the_engine_or_less(clamps):
    rng = np.random.default_rng(10 + clamps)
    for _ in range(NUMBER):
        beam, length, _ = drawn(clamps, rng)
        engine = of_engine(beam, length)
        shock = touch.touching_acceleration(engine, clamps, DENSITY) / touch.shock_factor(engine, clamps)
        computed = beam.half_sine_shock(length, DENSITY)
        assert (1 - (MODES if clamps == 2 else 1e-9)) * shock < computed < (1 + 1e-9) * shock


@pytest.mark.parametrize("clamps", [1, 2])
def test_the_equality_sees_a_load_at_the_free_end_a_stress_and_a_width(clamps):
    beam, _, liquid = drawn(clamps, np.random.default_rng(3))
    beam = replace(beam, stress=50e6 if clamps == 2 else 0.0)
    (expected, connected, _), other = lengths(beam, liquid), replace(beam, width=1.001 * beam.width)
    assert other.standing_each(liquid) != pytest.approx(expected, rel=1e-6)
    if clamps == 2:
        loose = replace(beam, stress=0.999 * beam.stress)
        assert loose.standing(liquid) != pytest.approx(connected, rel=1e-6)
        assert loose.standing_each(liquid) != pytest.approx(expected, rel=1e-6)


def test_the_surface_of_a_liquid_with_an_angle_has_a_kink():
    rng = np.random.default_rng(5)
    for clamps in (1, 2) * 10:
        beam, _, liquid = drawn(clamps, rng)
        partly = replace(liquid, contact_angle=rng.uniform(0, 1.5))
        np.testing.assert_allclose(beam.standing_each(partly), lengths(beam, partly)[0], rtol=KINK)
        assert partly.pull(0.7) == pytest.approx(float(drying.pull_of_liquid(0.7, partly.contact_angle)), rel=1e-12)


def test_a_liquid_that_does_not_wet_a_beam_leaves_it():
    beam, _, liquid = drawn(1, np.random.default_rng(6))
    dewetting = replace(liquid, contact_angle=math.pi / 2 + 0.1)
    assert {beam.standing_each(dewetting), beam.standing(dewetting), beam.released(dewetting)} == {math.inf}


def test_a_cantilever_overshoots_as_its_modes_say():
    beam = SlenderBeam(1, 2e-6, 2e-6, 20e-6, 164e9)
    ratio = beam.slow_shock(1e-4, DENSITY) / beam.half_sine_shock(1e-4, DENSITY)
    assert ratio == pytest.approx(HALF_SINE * Bent(1).overshoot(), rel=1e-12)
    assert HALF_SINE == touch.HALF_SINE


@pytest.mark.parametrize(("clamps", "tension"), [(1, 0.0), (2, 0.0), (2, 30.0), (2, 3000.0)])
def test_folds_are_those_of_the_same_polynomials(clamps, tension):
    plain, engine = bending.BentBeam(clamps, tension), Bent(clamps, tension)
    assert plain.fold_of_drop() == pytest.approx(engine.fold_of_drop(), rel=1e-9)
    plates = bending.GrowingLoad(lambda u: (1 - u) ** -2)
    assert plain.fold_at_once(plates) == pytest.approx(engine.fold_at_once(lambda u: (1 - u) ** -2), rel=1e-9)
    factor, _ = plain.under(plates, 0.4)
    assert factor == pytest.approx(engine.under(lambda u: (1 - u) ** -2, 0.4)[0], rel=1e-9)
    loaded = bending.GrowingLoad(plates.along, lambda u: 1.0)
    assert (plain.under(loaded, 0.4)[0] == factor) == (clamps == 2), "a bridge has no free end"


def test_what_does_not_settle_says_so():
    with pytest.raises(bending.NotConverged, match="deflection or length of a beam"):
        bending.settled(lambda numbers: [numbers[0] + 1], [0.0])
    with pytest.raises(bending.NotConverged, match="root of a function"):
        bending.root(lambda x: math.nan, 0.0, 1.0)
