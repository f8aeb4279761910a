"""Curves of a page: numbers of the tables at computed points, curves of the stages between them, none beyond."""

import json

import numpy as np
import pytest
from drawn_curves import BEAM, SETTINGS, STOPPER, etched, mapped, rough
from numpy.testing import assert_allclose
from scipy.interpolate import PchipInterpolator

from stiction.devices.roughness import LARGEST
from stiction.report.axes import tables
from stiction.report.devices import curve_views, curves, explorer
from stiction.report.page import Page
from stiction.stages.axes.margins import known_margins

DEVICES = [(False, STOPPER), (True, BEAM)]


def states(grid, frame, *axes):
    """States of the rows of a table, with their numbers."""
    keys = [grid.axes[0].key, *axes]
    for row in frame.to_dict("records"):
        state = grid.start | {key: row[column] for key, column in zip(keys, ("value", "second_value"), strict=False)}
        yield state | {"humidity": row["relative_humidity"]}, row


def are_those_of_the_table(grid, state, row):
    """Require the size with its band, the margin and the fraction stuck of a row."""
    found, sign = grid.at(state), -1 if grid.falls else 1
    assert grid.sizes(state)[0] == pytest.approx(row["estimate"], rel=1e-9)
    assert 100 * found["stuck"] == pytest.approx(row["stuck_percent"])
    assert 100 * found["low"] == pytest.approx(row["stuck_low_percent"])
    assert 100 * found["high"] == pytest.approx(row["stuck_high_percent"])
    assert np.log(grid.sizes(state)[2] / grid.sizes(state)[1]) == pytest.approx(2 * 1.96 * found["error"], rel=1e-4)
    assert found["margin"] == pytest.approx(sign * np.log(row["estimate"] / row["required"]), abs=1e-12)


def over(kind, is_beam, section):
    """Sliders over an axis or two, the rows of their table, and the key of the second axis."""
    if kind == "process":
        curve, settings = etched(is_beam)
        return curve_views.process_view("D", section, curve, settings), tables.of_processes({"D": curve}, [], {"D": []})
    if kind == "processes":
        found, pairs = mapped()
        return (
            curve_views.map_view("D", section, found, pairs),
            tables.of_pairs({"D": found}, {}, {"D": []}),
            "bake_min",
        )
    found = rough(is_beam, others=() if kind == "roughness" else (0.0, -0.5, 0.5))
    second = [] if kind == "roughness" else ["skewness"]
    return curve_views.roughness_view("D", section, found), tables.of_roughness({"D": found}), *second


KINDS = [(kind, *device) for kind in ("process", "roughness", "roughnesses") for device in DEVICES]


@pytest.mark.parametrize(("kind", "is_beam", "section"), [*KINDS, ("processes", False, STOPPER)])
def test_a_page_has_at_computed_points_the_numbers_of_the_table(kind, is_beam, section):
    view, table, *second = over(kind, is_beam, section)
    grid, frame = view.grid, table.frame.rename(columns={"other_value": "second_value"})
    frame["value"] = frame["value"].map(lambda value: min(grid.axes[0].values, key=lambda one: abs(one - value)))
    for state, row in states(grid, frame, *second):
        are_those_of_the_table(grid, state, row)
        found, sign = grid.at(state), -1 if grid.falls else 1
        if "margin" in row:
            assert found["margin"] == pytest.approx(row["margin"], abs=1e-12)
            assert found["error"] == pytest.approx(row["margin_se"], rel=1e-9)
        if "safe" in row:
            assert row["required"] * np.exp(sign * found["safe"]) == pytest.approx(row["safe"])


def test_sliders_begin_at_the_best_setting_or_the_given_roughness():
    curve, settings = etched()
    grid = curve_views.process_view("D", STOPPER, curve, settings).grid
    assert grid.start["etch_time_s"] == pytest.approx(float(settings.best[0]), rel=1e-3)
    assert grid.start["humidity"] == 0.8, "the worst"
    assert curve_views.roughness_view("D", STOPPER, rough()).grid.start["rms_nm"] == pytest.approx(3.4)


def test_between_settings_the_margin_is_the_one_behind_the_recommendation():
    curve, settings = etched()
    grid = curve_views.process_view("D", STOPPER, curve, settings).grid
    values, known = (
        np.linspace(SETTINGS[0], SETTINGS[-1], 77),
        {at["humidity"]: one for at, one in known_margins(curve)},
    )
    for humidity, one in known.items():
        found = [grid.at(grid.start | {"etch_time_s": value, "humidity": humidity})["margin"] for value in values]
        assert_allclose(found, one.at([values]).margin, atol=1e-12)
    enough = [grid.suffices(grid.start | {"etch_time_s": value}) for value in values]
    own = settings.sel(who="D")
    safe = np.interp(values, own["value"], own.safe)
    assert enough == (safe > 0).tolist()
    assert 0 < sum(enough) < len(enough)


def test_between_points_of_a_roughness_the_range_that_suffices_is_that_of_its_safe_values():
    found = rough()
    grid = curve_views.roughness_view("D", STOPPER, found).grid
    for humidity in found.humidity.values:
        line = found.safe.sel(humidity=humidity, shape="force")
        cubic = PchipInterpolator(np.log(found.roughness.values), -np.log(line.values / 28e-6))
        for value in np.linspace(1, 8, 40):
            state = grid.start | {"rms_nm": value, "humidity": float(humidity)}
            assert grid.at(state)["safe"] == pytest.approx(cubic(np.log(1e-9 * value)), abs=1e-7)
            assert grid.suffices(state) == (grid.at(state)["safe"] >= 0)


@pytest.mark.parametrize("quantity", ["etch_time_s", "rms_nm"])
def test_nothing_is_said_beyond_the_computed_points_and_next_to_one_that_could_not_be_computed(quantity):
    if quantity == "rms_nm":
        view = curve_views.roughness_view("D", STOPPER, rough(unknown=(2,)))
    else:
        view = curve_views.process_view("D", STOPPER, *etched(unknown=(60.0,)))
    grid, (axis, humidity) = view.grid, view.grid.axes
    for value in (0.99 * axis.values[0], 1.01 * axis.values[-1]):
        with pytest.raises(ValueError, match="has no answer: "):
            grid.at(grid.start | {quantity: value})
    with pytest.raises(ValueError, match=r"computed at 0\.6, 0\.8 alone; devices\.D\.humidities changes this"):
        grid.at(grid.start | {"humidity": 0.7})
    assert humidity.values == (0.6, 0.8)
    known = [np.isfinite(grid.at(grid.start | {quantity: value})["margin"]) for value in axis.values]
    assert known == [value != axis.values[2] for value in axis.values]
    for a, b in ((1, 2), (2, 3)):
        between = grid.start | {quantity: (axis.values[a] + axis.values[b]) / 2}
        assert all(np.isnan(one) for one in grid.at(between).values())


def test_a_device_that_never_sticks_has_the_largest_margin():
    found = rough(is_beam=True)
    never = found.assign(estimate=found.estimate * np.inf, safe=found.safe * np.inf, error=found.error * np.nan)
    assert curve_views.roughness_view("D", BEAM, never).grid.at({"rms_nm": 3.4, "humidity": 0.6})["margin"] == LARGEST


def test_a_device_has_a_view_for_each_of_its_studies_and_their_numbers_are_valid_json():
    curve, settings = etched(unknown=(30.0, 60.0))
    data = {"process": curve, "process_settings": settings, "roughness": rough()}
    views = curve_views.views("D", STOPPER, data)
    assert [view.title for view in views] == ["etch time", "rms of B2"]
    assert [
        view.title
        for view in curve_views.views("D", STOPPER, dict(zip(("process_map", "process_pairs"), mapped(), strict=True)))
    ] == ["etch time, bake"]
    assert curve_views.views("D", STOPPER, {}) == []
    content = explorer.content("D", STOPPER, views)
    assert "NaN" not in json.dumps(content)
    assert len(Page("D", {}, ["It is safe."], explorer=content).html) < 100_000


def test_a_study_with_another_rms_states_it_unless_scans_measure_the_surface():
    described, measured = (
        curve_views.roughness_view("D", STOPPER | known, rough()) for known in ({}, {"measured": ["B2"]})
    )
    assert (described.grid.axes[0].setting, described.words["copied"]) == ("surfaces.B2.rms_nm", "")
    assert measured.grid.axes[0].setting == ""
    assert measured.words["copied"] == "It has the rms of B2 as it is given; this address keeps the value shown"


def test_a_line_has_the_slopes_of_a_curve_through_each_run_of_known_values():
    places, values = np.array([0.0, 1.0, 2.5, 3.0, 4.0, 6.0, 7.0, 8.0]), np.array([1, 2, np.nan, 3, 5, 4, np.nan, 1])
    stored, slopes = curves.line(places, values, PchipInterpolator)
    assert_allclose(stored, values)
    for run in slice(0, 2), slice(3, 6):
        assert_allclose(slopes[run], PchipInterpolator(places[run], values[run]).derivative()(places[run]))
    assert np.isnan(slopes[[2, 6, 7]]).all()  # the last value stands alone
