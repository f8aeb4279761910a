import numpy as np
import pandas as pd
import pytest
import xarray as xr
from legends import covering

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


def test_all_pairs_share_the_panel_of_the_error_and_titles_say_how_large_it_is():
    (errors, cases), published = DATA, pd.concat([PUBLISHED, PUBLISHED.assign(pair="b")])
    errors = errors | {"b": pair_model_error.compute(study((0.4, 0.9, 1.3)), (0.45, 0.6, 0.7, 0.9))}
    data = errors, cases | {("b", humidity): beams(700e-6) for _, humidity in cases}
    frame = model_error.table(*data, published).frame
    figure = model_error.drawn(frame)
    assert len(figure.axes) == 3
    assert [len(container[0].get_xdata()) for container in figure.axes[0].containers] == [3, 3]
    first, *others = [panel.get_title(loc="left").replace("\n", " ") for panel in figure.axes]
    most, least = frame.model_error_percent.max(), frame.model_error_percent.min()
    assert most > 10
    assert least < -5
    too_long = f"too long by up to {-least:.0f} % (unsafe)"
    assert first == f"(a) the model's cracks are too short by up to {most:.0f} % (safe) and {too_long}"
    safe = model_error.drawn(frame.assign(model_error_percent=frame.model_error_percent.clip(0)))
    assert "unsafe" not in safe.axes[0].get_title(loc="left"), "a control"
    for letter, pair, title in zip("bc", "ab", others, strict=True):
        rows = frame[(frame.pair == pair) & frame.published_um.notna()]
        summits, full = (
            np.sqrt((100 * (rows[name] / rows.published_um - 1)).pow(2).mean())
            for name in ("crack_length_um", "full_contact_um")
        )
        assert title == f"({letter}) pair {pair}: rms {summits:.1f} % off by summits, {full:.1f} % by full contact"
    assert len({panel.get_xlim() for panel in figure.axes}) == 1
    assert covering(figure) == []


def test_lengths_that_are_corrected_already_are_not_corrected_again():
    errors, released = DATA
    applied = {"a": errors["a"].assign(applied=True)}
    plain, frame = model_error.table(*DATA, PUBLISHED).frame, model_error.table(applied, released, PUBLISHED).frame
    np.testing.assert_allclose(frame.full_contact_um, 600)
    np.testing.assert_allclose(frame.crack_length_um, 600 * plain.crack_length_um / plain.full_contact_um)
