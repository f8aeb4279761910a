"""Dimples under beams: sums of independent patches, the force of the beam at the row, and what life says of them."""

from dataclasses import replace

import numpy as np
import pytest
import small
import xarray as xr
from ground import R1, safe_with_tips, safe_without_tips
from lives import OF
from numpy.testing import assert_allclose, assert_array_equal
from plans import job_settings

from stiction.config.files import load
from stiction.config.units import in_si
from stiction.constants import VACUUM_PERMITTIVITY
from stiction.contact.environment import Water
from stiction.devices.stoppers import stuck_patches
from stiction.life.dimples import least_load, states
from stiction.life.fringes import edge_width
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.report.devices import life as report
from stiction.stages.contact import curves
from stiction.stages.devices import stoppers
from stiction.stages.life.answers import layout
from stiction.stages.life.beams import beam_answers
from stiction.stages.life.dimples import dimple_answers
from stiction.stages.life.inputs import BeamErrors, BeamKeys, Dimples

BEAM = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 3, "width_um": 30, "humidities": [0, 0.67]}
ROW = {"number": 3, "at_um": [80], "height_um": 1, "contact_um": [2, 1]}
OF_WATER = Water(300.0)
AT = Dimples(3, (80e-6,), 1e-6)


def forces(mean, spread=0.2, number=400, seed=3, rows=1):
    """Dataset of stage dimples with lognormal forces."""
    found = mean * np.exp(spread * np.random.default_rng(seed).standard_normal(number))
    return xr.Dataset({"pull_off": (("beam", "row"), found.reshape(-1, rows), {"units": "N"})})


@pytest.fixture(scope="module")
def lengths():
    return {0.67: safe_with_tips(2e-3 * np.exp(0.4 * np.random.default_rng(9).standard_normal(400)))}


def answers(lengths, of, dimples):
    return {one.name: one for one in [*beam_answers(lengths, {}, of), *dimple_answers(of, dimples)]}


@pytest.mark.parametrize(("number", "rows"), [(1, 1), (3, 1), (7, 1), (2, 3)])
def test_the_force_of_a_row_is_the_sum_of_other_patches(number, rows):
    settings = stoppers.DimpleForces(OF_WATER, 0.67, (1.5e-6, 6e-6), number, (80e-6,) * rows)
    held = stoppers.compute_dimples(small.contact_of_pair(), settings).pull_off.values
    single = 1.5e-6 * 6e-6 * curves.pull_offs(small.contact_of_pair(), 0.67, OF_WATER)
    assert held.shape == (len(single) // (number * rows), rows)
    assert_allclose(held[0, -1], single[(rows - 1) * number : rows * number].sum(), rtol=1e-12)
    assert_allclose(held.sum(), single[: held.size * number].sum(), rtol=1e-12)
    if number == 1:
        assert_array_equal(held[:, 0], single)


def test_a_row_holds_although_each_of_its_dimples_is_too_weak(lengths):
    of = replace(OF, length=200e-6, dimples=AT)
    pulled = answers(lengths, of, {0.67: forces(1e-6)})["dimples_force"].low
    alone, together = ({0.67: forces(factor * pulled)} for factor in (0.5, 1.5))
    assert answers(lengths, of, alone)["stuck_dimples_0.67"].high < 0.02
    assert answers(lengths, of, together)["stuck_dimples_0.67"].low > 0.9


@pytest.mark.parametrize("kind", ["cantilever", "bridge"])
def test_life_compares_the_row_with_the_force_of_the_beam_there(lengths, kind):
    of = replace(OF, length=200e-6, dimples=AT, device=OF.device if kind == "cantilever" else R1, liquids={})
    found_lengths = lengths if kind == "cantilever" else {0.67: safe_without_tips()}
    given = {0.0: forces(5e-6), 0.67: forces(2e-5, seed=4)}
    found, (bent,) = answers(found_lengths, of, given), states(of.beam(200e-6), of.clamps, AT.at)
    force = bent.pull[0] * (of.device.gap - AT.height)
    assert_allclose(found["dimples_force"].low, force, rtol=1e-12)
    for humidity, dataset in given.items():
        _, low, high = stuck_patches(dataset.pull_off.values[:, 0], np.array([force]))
        one = found[f"stuck_dimples_{humidity:g}"]
        assert (one.low, one.high) == (low[0], high[0])
    assert_allclose(found["dimples"].low, given[0.67].pull_off.mean(), rtol=1e-12)
    left = 1 - bent.deepest * (of.device.gap - AT.height) / of.device.gap
    assert_allclose(found["beside_dimples"].low, max(left, 0.0), atol=1e-12)


def test_errors_of_the_force_follow_thickness_and_gap(lengths):
    errors = BeamErrors(thickness=0.01 * OF.device.thickness, gap=0.02 * OF.device.gap)
    found = answers(lengths, replace(OF, length=200e-6, dimples=AT, uncertainty=errors), {0.67: forces(1e-5)})
    way = OF.device.gap / (OF.device.gap - AT.height)
    pulled = found["dimples_force"]
    assert_allclose(pulled.error / pulled.low, np.hypot(0.03, 0.02 * way), rtol=1e-3)


@pytest.mark.parametrize("kind", ["cantilever", "bridge"])
def test_life_has_the_voltage_and_the_liquid_that_beams_on_dimples_bear(lengths, kind):
    dimples = Dimples(3, (100e-6, 190e-6), 0.9 * (OF.device.gap if kind == "cantilever" else R1.gap))
    of = replace(OF, length=200e-6, dimples=dimples, device=OF.device if kind == "cantilever" else R1, liquids={})
    found = answers(lengths if kind == "cantilever" else {0.67: safe_without_tips()}, of, {0.67: forces(1e-5, rows=2)})
    beam, way = of.beam(200e-6), of.device.gap - dimples.height
    on_rows = states(beam, of.clamps, dimples.at)
    volts, tension = found["voltage_dimples"], found["tension_dimples"]
    # Without its edges and its end, a beam would bear more.
    load = VACUUM_PERMITTIVITY * volts.low**2 * beam.width / 2
    edge, end = edge_width(beam.gap, beam.thickness), (kind == "cantilever") * 8 / 3 / (beam.length - 190e-6)
    bears = least_load(on_rows, way, beam.gap, 2), least_load(on_rows, way, beam.gap, 1)
    assert_allclose(load * (1 + 2 * edge / beam.width) * (1 + end * edge), bears[0], rtol=1e-12)
    pull = beam.width + np.hypot(beam.width, 2 * beam.gap)
    assert_allclose(tension.low * (pull + end * beam.gap * beam.width), bears[1], rtol=1e-12)
    assert volts.low > 0
    assert np.isnan(volts.high)


def test_sentences_say_how_many_stick_and_whether_the_beam_touches_beside_its_dimples(lengths):
    for height, said in ((1e-6, "But it touches beside them"), (19e-6, "mN/m dries.")):
        of = replace(OF, length=200e-6, dimples=Dimples(3, (80e-6,), height))
        dataset = layout(list(answers(lengths, of, {0.67: forces(1e-5)}).values()), of, 200e-6)
        (sentence,) = [one for one in report.sentences(dataset) if "dimples" in one]
        assert said in sentence
        assert "of the beams stick on dimples" in sentence
    assert not any("dimples" in one for one in answers(lengths, OF, {}))


def test_life_asks_all_states_of_several_rows(lengths):
    of = replace(OF, length=200e-6, dimples=Dimples(3, (60e-6, 120e-6, 190e-6), 19e-6))
    on_rows, way = states(of.beam(200e-6), 1, of.dimples.at), of.device.gap - of.dimples.height
    needed = way * min(state.pull.max() for state in on_rows)
    held = forces(needed, number=1200, rows=3)
    found = answers(lengths, of, {0.67: held})
    assert_allclose(found["dimples_force"].low, needed, rtol=1e-12)
    stuck = np.mean([any(np.all(one[[*s.rows]] > way * s.pull) for s in on_rows) for one in held.pull_off.values])
    assert found["stuck_dimples_0.67"].low < stuck < found["stuck_dimples_0.67"].high
    assert found["beside_dimples"].low < found["beside_dimples"].high < 1
    dataset = layout(list(found.values()), of, 200e-6)
    (sentence,) = [one for one in report.sentences(dataset) if "dimples" in one]
    assert "pulls at its 3 rows of dimples is at least " in sentence


def test_a_beam_with_dimples_has_a_job_for_them_at_each_humidity():
    plan = Plan(load({"devices": {"C1": BEAM | {"length_um": 100, "dimples": ROW}, "C2": BEAM}}))
    graph = Graph(plan)
    assert list(graph.job("devices/life/C1").inputs["dimples"]) == [0, 0.67]
    assert not graph.job("devices/life/C2").inputs["dimples"]
    settings = in_si(stoppers.DimpleForces, job_settings(plan, "devices/dimples/C1_rh067"))
    assert (settings.number, settings.humidity) == (3, 0.67)
    assert_allclose(settings.contact, (2e-6, 1e-6), rtol=1e-12)
    for case, pair in (("C1_rh067", "b"), ("C1_dry", "b_dry")):
        assert graph.job(f"devices/dimples/{case}").inputs["contact"] == f"devices/contact/{pair}_2000x1000"
    of = in_si(BeamKeys, job_settings(plan, "devices/life/C1")["beam"])
    assert_allclose((of.dimples.number, *of.dimples.at, of.dimples.height), (3, 80e-6, 1e-6), rtol=1e-12)


def test_a_force_at_the_end_of_an_arm_bends_it_no_more_than_eight_thirds_of_it_spread_along_the_arm():
    x = np.linspace(0, 1, 101)[1:]
    by_force, spread = x**2 * (3 - x) / 6, x**2 * (6 - 4 * x + x**2) / 24
    assert_allclose((by_force / spread).max(), 8 / 3, rtol=1e-12)
    moments = 1, 1 / 2  # that turn the rest of the beam
    assert moments[0] / moments[1] < 8 / 3
