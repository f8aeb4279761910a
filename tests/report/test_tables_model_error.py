import numpy as np
import pandas as pd
import pytest
import xarray as xr

from stiction.config.files import load
from stiction.plan.plan import Plan
from stiction.report import style
from stiction.report.model_error import table as model_error
from stiction.stages.contact import full_contact, pair_model_error

HUMIDITIES = [0.45, 0.7, 0.9]
PUBLISHED = pd.DataFrame(
    {
        "pair": "a",
        "relative_humidity": [0.45, 0.7, 0.9],
        "ng": [700.0, 490, 350],
        "ng_std": [9.0, 4, 3],
        "experiment": [718.0, 582, 362],
        "experiment_std": [28.0, 24, 18],
    }
)


def study(ratios=(0.6, 0.9, 1.0), strips=6):
    values = np.ones((strips, 3, 9))
    values[..., 2] = np.random.default_rng(3).gamma(9, size=(strips, 3))
    values[..., 0] = values[..., 2] * ratios * np.random.default_rng(4).normal(1, 0.02, (strips, 3))
    return full_contact.layout(values, HUMIDITIES, 1e-8)


def beams(length=600e-6):
    lengths, states = np.array([length, length, np.nan]), [0, 0, 1]
    return xr.Dataset({"crack_length": ("beam", lengths), "state": ("beam", states)})


DATA = (
    {"a": pair_model_error.compute(study(), (0.45, 0.6, 0.7, 0.9))},
    {("a", humidity): beams() for humidity in (0.45, 0.6, 0.7, 0.9)},
)


def test_the_table_states_the_error_of_every_case_and_marks_interpolated_ones():
    table = model_error.table(*DATA, PUBLISHED)
    frame = table.frame.set_index("relative_humidity")
    assert frame.interpolated.tolist() == [False, True, False, False]
    np.testing.assert_allclose(frame.full_contact_um, 600 * (1 + frame.model_error_percent / 100))
    dry = frame.loc[0.45]
    assert dry.model_error_percent == pytest.approx(100 * (dry.energy_ratio**-0.25 - 1))
    assert dry.full_contact_deviation_percent == pytest.approx(100 * (dry.full_contact_um / 700 - 1))
    assert np.isnan(frame.loc[0.6].energy_ratio)
    marks = table.cells["model error of l_s [%]"].str.endswith("*")
    assert marks.tolist() == frame.interpolated.tolist()
    assert "6 strips" in table.caption


def test_the_table_takes_the_error_of_every_pair_from_its_study():
    stage, plan = model_error.STAGES[0], Plan(load({"run": {"pairs": ["a", "b"]}}))
    assert stage.inputs(plan, None)["errors"] == {pair: f"studies/model_error/{pair}" for pair in ("a", "b")}


def test_pairs_that_are_not_published_are_compared_with_nothing():
    frame = model_error.table(*DATA, PUBLISHED[:0]).frame
    assert frame.full_contact_deviation_percent.isna().all()
    assert frame.full_contact_um.notna().all()


@pytest.mark.parametrize(("published", "panels"), [(PUBLISHED, 2), (PUBLISHED[:0], 1)])
def test_the_figure_shows_the_error_and_deviations_from_published_lengths(published, panels):
    figure = model_error.figure(*DATA, published)
    assert len(figure.axes) == panels
    points, *_ = figure.axes[0].containers[0]
    np.testing.assert_allclose(np.asarray(points.get_xdata(), float), HUMIDITIES)
    assert points.get_ydata()[0] > 10
    assert style.png(figure) == style.png(model_error.figure(*DATA, published))


def test_lengths_that_are_corrected_already_are_not_corrected_again():
    errors, released = DATA
    applied = {"a": errors["a"].assign(applied=True)}
    plain, frame = model_error.table(*DATA, PUBLISHED).frame, model_error.table(applied, released, PUBLISHED).frame
    np.testing.assert_allclose(frame.full_contact_um, 600)
    np.testing.assert_allclose(frame.crack_length_um, 600 * plain.crack_length_um / plain.full_contact_um)
