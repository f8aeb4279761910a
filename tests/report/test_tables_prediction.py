"""Prediction intervals of Table III: learnt from other pairs, around the computed lengths, beside all other columns."""

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_allclose

from stiction.config.files import load
from stiction.plan.plan import Plan
from stiction.report import published
from stiction.report.beams import prediction
from stiction.report.style import save
from stiction.streams import stream

PUBLISHED = published.read(published.file("table_3"))


def table(pairs="abc", models=("G", "NG", "GEO"), **changed):
    """Rows of Table III whose computed lengths are the published ones of model NG."""
    known = PUBLISHED[PUBLISHED.pair.isin(list(pairs))]
    rows = pd.DataFrame(
        {
            "pair": known.pair,
            "relative_humidity": known.relative_humidity,
            "crack_length_um": known.ng,
            "crack_length_se_um": 0.002 * known.ng,
            "experiment_um": known.experiment,
            "experiment_std_um": known.experiment_std,
        }
    ).assign(**changed)
    return pd.concat([rows.assign(model=model) for model in models], ignore_index=True)


def ends(frame, coverage=0.95, pair="a", model="NG"):
    """Ends of the intervals of a pair."""
    rows = frame[(frame.pair == pair) & (frame.model == model)]
    return rows[list(prediction.ENDS[coverage])].values


def with_intervals(frame):
    return pd.DataFrame(prediction.with_intervals(frame.to_dict("records")))


def test_measured_lengths_of_a_pair_take_no_part_in_its_own_interval_but_in_those_of_others():
    given = table()
    other = given.assign(experiment_um=np.where(given.pair == "a", 2.0, 1.0) * given.experiment_um)
    found, changed = map(with_intervals, (given, other))
    assert_allclose(ends(changed), ends(found), rtol=1e-12)
    low, high = (ends(one, pair="b").T for one in (found, changed))
    assert (high[1] / high[0] > low[1] / low[0]).all()


def test_intervals_lie_around_the_computed_length_and_grow_with_their_probability():
    found = with_intervals(table())
    narrow, wide = (ends(found, coverage) for coverage in prediction.COVERAGES)
    lengths = found[(found.pair == "a") & (found.model == "NG")].crack_length_um
    for of in (narrow, wide):
        assert_allclose(np.sqrt(of.prod(axis=1)), lengths)
    assert (wide[:, 0] < narrow[:, 0]).all()
    assert (wide[:, 1] > narrow[:, 1]).all()


def test_all_other_columns_stay_and_gaussian_surfaces_have_no_interval():
    given = table()
    found = with_intervals(given)
    pd.testing.assert_frame_equal(found[list(given)], given)
    assert np.isnan(ends(found, model="G")).all()
    assert_allclose(ends(found, model="GEO"), ends(found))


def test_a_pair_without_measured_lengths_is_predicted_by_all_pairs_with_them():
    own = table("a", crack_length_um=500.0 * np.exp(-0.1 * np.arange(6)), experiment_um=np.nan).assign(pair="mine")
    found = with_intervals(pd.concat([table(), own], ignore_index=True))
    assert np.isfinite(ends(found, pair="mine")).all()
    # Six lengths more do not change how far the model errs on the others.
    assert_allclose(ends(found), ends(with_intervals(table())), rtol=1e-12)


@pytest.mark.parametrize("frame", [table("b"), table("ab"), table("bc", models=("G",))], ids=["one", "two", "Gaussian"])
def test_without_two_other_measured_pairs_the_table_is_as_before(frame, tmp_path):
    assert list(with_intervals(frame)) == list(frame)
    save(prediction.intervals(with_intervals(frame)), tmp_path / "prediction.png")


def test_dry_air_and_cases_without_cracks_have_no_interval():
    given = table()
    dry = given.assign(relative_humidity=np.where(given.index == 6 * 3, 0.0, given.relative_humidity))
    free = dry.assign(crack_length_um=dry.crack_length_um.where(dry.index != 6 * 3 + 1))
    found = with_intervals(free)
    assert np.isnan(ends(found)[:2]).all()
    assert np.isfinite(ends(found)[2:]).all()


def test_the_caption_counts_the_measured_lengths_in_their_intervals():
    found = with_intervals(table())
    assert prediction.count_contained(found, 0.95) == (18, 18)
    far = found.assign(experiment_um=np.where(found.pair == "a", 9e9, found.experiment_um))
    assert prediction.count_contained(far, 0.95) == (12, 18)
    assert "and 12 of 18 measured lengths" in str(prediction.caption(far))


def test_scattered_measurements_make_wide_intervals():
    given = table()
    scatter = np.exp(0.2 * stream(1, "scatter").standard_normal(len(given)))
    low, high = (ends(with_intervals(given.assign(experiment_um=one))).T for one in (
        given.crack_length_um * scatter**0.1, given.crack_length_um * scatter))  # fmt: skip
    assert (np.log(high[1] / high[0]) > 5 * np.log(low[1] / low[0])).all()


@pytest.mark.parametrize(
    ("changed", "jobs"),
    [
        ({}, 1),
        ({"run": {"pairs": ["a", "b"]}}, 0),
        ({"pairs": {"a": {"humidities": [0.45, 0.9]}, "b": {"humidities": [0.44]}}}, 0),
    ],
    ids=["paper", "two pairs", "few humidities"],
)
def test_intervals_are_drawn_where_enough_pairs_have_measured_lengths(changed, jobs):
    plan = Plan(load(changed))
    assert len(prediction.STAGES[0].jobs(plan)) == jobs
