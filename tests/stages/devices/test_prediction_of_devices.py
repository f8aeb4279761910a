"""Prediction intervals of devices: Table III's, at the place of a length, only where the paper measured."""

from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

import numpy as np
import pandas as pd
import pytest
import xarray as xr
import yaml
from answers import beam_page
from ground import C1, lognormal_cracks, safe_with_tips, safe_without_tips, wanted
from numpy.testing import assert_allclose
from test_dry_devices import ACROSS, plan_of

from stiction.beam.energy import arrest_length
from stiction.config.cases import Case
from stiction.config.files import load
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.report.beams.prediction import ENDS
from stiction.report.beams.prediction import with_intervals as in_table_3
from stiction.report.devices import sentences
from stiction.report.devices import tables as tables_devices
from stiction.stages.contact import curves
from stiction.stages.devices import prediction, safe_lengths
from stiction.stages.devices.contact_names import contact_of
from stiction.stages.devices.opening import EITHER, S_SHAPE
from stiction.streams import stream

EXAMPLES = Path(__file__).parents[3] / "examples"
LENGTHS = pd.read_csv(prediction.PAPER_LENGTHS)
KNOWN, MIDDLE = prediction.learnt(LENGTHS, prediction.TOUCHING)
#: Contact of strips whose energies are given.
STRIPS = xr.Dataset(coords={"strip": range(3)})
PLACES = [-0.8, -0.3, 0.0, 0.2, 0.9]


@pytest.fixture(scope="module")
def cantilever():
    """Safe lengths of a cantilever with a tip, without intervals."""
    return safe_with_tips(2e-3 * np.exp(0.4 * np.random.default_rng(9).standard_normal(400)))


def at_place(dataset, place, known=KNOWN):
    """Dataset with the intervals at a place."""
    return dataset.assign(prediction.intervals(dataset, known, place))


def widths(dataset):
    """Logarithms of the ratio of both ends held by the beam, by share."""
    held = dataset.sel(shape=S_SHAPE)
    return np.log(held.prediction_high / held.prediction_low).values


def test_an_interval_lies_around_the_length_that_the_beam_holds_and_tips_have_none(cantilever):
    found = at_place(cantilever, 0.3)
    held, tips = found.sel(shape=S_SHAPE), found.sel(shape=EITHER)
    assert_allclose(np.sqrt(held.prediction_low * held.prediction_high), held.estimate)
    assert np.all((held.prediction_low < held.safe_length) & (held.estimate < held.prediction_high))
    assert np.isnan([tips.prediction_low, tips.prediction_high]).all()
    assert found.drop_vars(["prediction_low", "prediction_high"]).identical(cantilever), "no safe length is changed"


def test_intervals_widen_away_from_the_middle_of_the_paper_and_with_the_error_of_the_simulation(cantilever):
    at = {place: widths(at_place(cantilever, place)) for place in PLACES}
    assert np.all(at[0.0] < at[0.2])
    assert np.all(at[-0.3] < at[-0.8])
    assert np.all(at[-0.8] < at[0.9])
    few = cantilever.assign(beams_error=30 * cantilever.beams_error)
    assert np.all(widths(at_place(few, 0.0)) > at[0.0])


def test_lengths_without_an_estimate_or_an_error_have_no_interval(cantilever):
    for name, value in (("estimate", np.inf), ("estimate", np.nan), ("beams_error", np.nan)):
        unknown = cantilever.assign({name: cantilever[name].where(cantilever.share != 1e-3, value)})
        held = at_place(unknown, 0.3).sel(shape=S_SHAPE)
        assert np.isnan([held.prediction_low.sel(share=1e-3), held.prediction_high.sel(share=1e-3)]).all()
        assert np.isfinite(held.prediction_high.sel(share=1e-2))


def test_the_interval_of_a_case_is_that_of_table_3_learnt_from_all_three_pairs(cantilever):
    rows = LENGTHS.rename(columns={"touching_um": "crack_length_um", "measured_um": "experiment_um"})
    rows = rows.assign(model="NG", crack_length_se_um=0.01 * rows.crack_length_um)
    own = rows[rows.pair == "c"].assign(pair="mine", experiment_um=np.nan)
    table = pd.DataFrame(in_table_3(pd.concat([rows, own], ignore_index=True).to_dict("records")))
    places = np.log(own.crack_length_um) - np.log(own.crack_length_um).mean()
    for (_, row), place in zip(table[table.pair == "mine"].iterrows(), places, strict=True):
        length = 1e-6 * row.crack_length_um
        exact = cantilever.surfaces_error * np.nan
        one = cantilever.assign(
            surfaces_error=exact, estimate=exact.fillna(length), beams_error=exact.fillna(0.01 * length)
        )
        held = at_place(one, place).sel(shape=S_SHAPE, share=1e-3)
        ends = [held.prediction_low, held.prediction_high]
        assert_allclose(ends, [1e-6 * row[name] for name in ENDS[0.95]], rtol=1e-9)


def energies(slope):
    """Energies of some strips, a power of a number in the humidity."""
    return lambda _contact, humidity, _water: 2e-3 * np.exp(slope * humidity) * np.array([0.5, 1.0, 1.5], np.float32)


@pytest.mark.parametrize("slope", [2.0, 8.0, -3.0])
def test_the_place_is_the_logarithm_of_the_length_by_that_in_the_middle_of_the_paper(cantilever, slope):
    with patch.object(curves, "energies", energies(slope)):
        found = prediction.with_intervals(cantilever, {"contact": STRIPS, "paper": prediction.PAPER_LENGTHS}, wanted())
    here, middle = (arrest_length(2e-3 * np.exp(slope * at), C1.beam) for at in (wanted().humidity, MIDDLE))
    expected = at_place(cantilever, float(np.log(here / middle)))
    assert_allclose(found.prediction_high, expected.prediction_high, rtol=1e-6)


@pytest.mark.parametrize("energy", [0.0, np.nan])
def test_surfaces_that_do_not_adhere_have_no_interval(cantilever, energy):
    with patch.object(curves, "energies", lambda *_: np.full(3, energy, np.float32)):
        found = prediction.with_intervals(cantilever, {"contact": STRIPS, "paper": prediction.PAPER_LENGTHS}, wanted())
    assert np.isnan(found.prediction_high).all()


def test_lengths_are_compared_with_those_of_the_same_reach_of_attraction(cantilever):
    known = prediction.learnt(LENGTHS, prediction.ACROSS_GAPS)[0]
    across = replace(wanted(), water=ACROSS)
    with patch.object(curves, "energies", energies(0.0)):
        found = prediction.with_intervals(cantilever, {"contact": STRIPS, "paper": prediction.PAPER_LENGTHS}, across)
    assert_allclose(widths(found), widths(at_place(cantilever, 0.0, known)))
    assert np.all(np.abs(widths(found) / widths(at_place(cantilever, 0.0)) - 1) > 0.1)


def test_the_middle_of_the_paper_is_where_its_pairs_have_their_mean_length():
    lines = [
        pd.DataFrame({"pair": name, "relative_humidity": at, "one_um": 500 * np.exp(-2 * at), "measured_um": 500.0})
        for name, at in (("a", np.array([0.4, 0.5, 0.6])), ("b", np.array([0.7, 0.8, 0.9])))
    ]
    assert_allclose(prediction.learnt(pd.concat(lines), "one_um")[1], 0.65)
    assert 0.7 < MIDDLE < 0.8


@pytest.mark.slow
def test_intervals_contain_drawn_truths_of_a_wrong_model_as_often_as_stated_and_those_of_the_simulation_do_not(
    cantilever,
):
    held, off = cantilever.sel(shape=S_SHAPE, share=1e-3), []
    error = float(np.hypot(held.beams_error, held.surfaces_error) / held.estimate)
    for k in range(400):
        rng, place = stream(50, "devices", k), PLACES[k % len(PLACES)]
        drawn = [of.assign(measured_um=wrong(rng, of.touching_um)) for _, of in LENGTHS.groupby("pair")]
        known = prediction.learnt(pd.concat(drawn), prediction.TOUCHING)[0]
        half = np.log(at_place(cantilever, place, known).prediction_high / cantilever.estimate)
        truth = np.log(wrong(rng, np.ones(1), place)) + error * rng.standard_normal()
        off.append(abs(truth[0]) / np.array([half.sel(shape=S_SHAPE, share=1e-3), 1.96 * error]))
    stated, alone = np.transpose(off)
    # Variances of three pairs are not exact, and allowing for that contains more truths than stated rather than fewer.
    assert 0.95 - 0.02 < np.mean(stated < 1) < 1
    assert np.mean(stated < 0.5) < 0.9
    assert np.mean(alone < 1) < 0.5


def wrong(rng, lengths, place=None):
    """Lengths of a pair that a model with a wrong factor, slope and rest computes as ``lengths``."""
    places = np.log(lengths) - np.log(lengths).mean() if place is None else place
    factor, slope = 0.1 * rng.standard_normal(), 0.3 * rng.standard_normal()
    return lengths * np.exp(factor + slope * places + 0.05 * rng.standard_normal(len(lengths)))


def test_only_cantilevers_in_humid_air_are_compared_with_the_paper():
    plan = plan_of(["dry", 0.67])
    inputs = {case: Graph(plan).job(f"devices/safe_lengths/{case}").inputs for case in ("C1_rh067", "C1_dry")}
    assert inputs["C1_rh067"]["paper"] == prediction.PAPER_LENGTHS.as_posix()
    assert inputs["C1_rh067"]["contact"] == contact_of(plan, Case("C1_rh067"))
    assert not {"paper", "contact"} & set(inputs["C1_dry"])
    example = Graph(Plan(load(yaml.safe_load((EXAMPLES / "devices.yaml").read_text()))))
    assert set(example.job("devices/safe_lengths/R1_rh067").inputs) == {"cracks"}
    assert set(example.job("devices/touchdowns/C1_rh067").inputs) == {"cracks", "tips", "model_error"}
    without = safe_without_tips()
    assert prediction.with_intervals(without, {"cracks": lognormal_cracks()}, wanted()) is without


def test_test_beams_of_a_device_replace_the_lengths_of_the_paper():
    graph = Graph(Plan(load(yaml.safe_load((EXAMPLES / "test_beams.yaml").read_text()))))
    assert not {"paper", "contact"} & set(graph.job("devices/safe_lengths/onB_rh067").inputs)


def test_the_stage_writes_the_intervals_of_its_inputs(cantilever):
    stage = safe_lengths.STAGES[0]
    data = {"cracks": None, "contact": STRIPS, "paper": prediction.PAPER_LENGTHS}
    with patch.object(safe_lengths, "compute", lambda *_: cantilever), patch.object(curves, "energies", energies(2.0)):
        assert np.isfinite(widths(stage.compute(data, wanted()))).all()


# Page and table

SILENT = {("C1", humidity, shape): [] for humidity in (0.44, 0.67) for shape in (S_SHAPE, EITHER)}
SECTION = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30}
SECTION |= {"humidities": [0.44, 0.67]}


def test_the_answer_has_one_line_about_the_shortest_length_and_names_its_air(cantilever):
    shorter = cantilever.assign(estimate=0.9 * cantilever.estimate)
    cases = {0.44: at_place(cantilever, 0.4), 0.67: at_place(shorter, 0.1)}
    (said,) = sentences.prediction_sentences(cases)
    share = float(cantilever.share[1])
    held = cases[0.67].sel(shape=S_SHAPE, share=share)
    low, high = 1e6 * float(held.prediction_low), 1e6 * float(held.prediction_high)
    assert said.startswith(
        f"At a relative humidity of 0.67, 1 in {1 / share:.0f} sticks along its beam at a length of "
    )
    assert f"this length lies between {low:.0f} and {high:.0f} µm (95 %)" in said
    page = beam_page(SECTION, cases)
    assert page.answer.count(said) == page.more.count(said) == 1
    assert said.replace("'", "&#39;") in page.html


def test_without_intervals_neither_answer_nor_table_speaks_of_them(cantilever):
    cases = {0.44: cantilever, 0.67: cantilever}
    page = beam_page(SECTION, cases)
    assert not [line for line in page.lines if "errs" in line]
    table = tables_devices.safe_lengths({("C1", at): one for at, one in cases.items()}, SILENT)
    assert not [name for name in table.frame if name.startswith("prediction")]
    assert "errs" not in table.caption


def test_the_table_has_both_ends_where_the_beam_holds_and_none_for_tips_and_other_devices(cantilever):
    found = at_place(cantilever, 0.3)
    warned = SILENT | {("R1", 0.67, "middle"): []}
    table = tables_devices.safe_lengths({("C1", 0.67): found, ("R1", 0.67): safe_without_tips()}, warned)
    (column,) = [name for name in table.cells if name.startswith("95 %")]
    by = table.frame.assign(shown=table.cells[column]).groupby("held_by", sort=False)
    beam = by.get_group("beam")
    assert_allclose(beam.prediction_low_um, 1e6 * found.prediction_low.sel(shape=S_SHAPE))
    assert_allclose(beam.prediction_high_um, 1e6 * found.prediction_high.sel(shape=S_SHAPE))
    ends = beam[["prediction_low_um", "prediction_high_um"]].values
    assert list(beam.shown) == [f"{low:.0f} to {high:.0f}" for low, high in ends]
    for others in ("beam or tip", "middle"):
        assert set(by.get_group(others).shown) == {"–"}
    assert "form of the model" in table.caption
