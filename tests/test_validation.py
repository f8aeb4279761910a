"""Benchmark of stiction: files of experiments, laws, coverage of intervals, tables."""

import doctest
import json
import re
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from numpy.testing import assert_allclose

import stiction
from stiction.streams import stream

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "examples" / "validation"))
import comparison  # noqa: E402
import experiment  # noqa: E402
import figure  # noqa: E402
import prediction  # noqa: E402

sys.path.remove(str(ROOT / "examples" / "validation"))
EXPERIMENTS = experiment.experiments()
TABLES = ROOT / "docs" / "tables"


@pytest.fixture
def film():
    """Experiment on the height of the film at an unknown humidity, which costs nothing to predict."""
    return experiment.read(experiment.FOLDER / "mit_bonding.yaml")


# Files


def test_examples_in_docstrings_hold():
    for module in (experiment, prediction):
        found = doctest.testmod(module)
        assert found.attempted > 0
        assert not found.failed


def test_the_collection_has_twenty_experiments_of_ten_laboratories_with_sources_and_reasons_for_every_assumption():
    computed = [each for each in EXPERIMENTS if each.setup]
    assert len(computed) >= 20
    assert len({each.laboratory for each in computed if not each.laboratory.startswith("not shown")}) >= 10
    for each in EXPERIMENTS:
        assert each.source["cite"]
        assert all(assumed.why for assumed in each.assumed.values())


WRONG = {
    "strange": (lambda entry: entry.update(titel="x"), "titel is unknown"),
    "strange_in_a_row": (lambda entry: entry["measured"][0].update(valeu=1), "valeu is unknown"),
    "missing": (lambda entry: entry.pop("laboratory"), "laboratory is missing"),
    "unit": (lambda entry: entry["measured"][0].update(unit="inch"), "unit is 'inch', must be one of"),
    "no_address": (lambda entry: entry["source"].pop("link"), "must have a doi or a link"),
    "not_used": (lambda entry: entry["assumed"].update(rms={"range": [1, 2], "why": "x"}), "rms is used nowhere"),
    "not_defined": (lambda entry: entry["setup"].update(factor="$model"), "leaves $model without a value"),
    "two_values": (lambda entry: entry["measured"][0].update(at_most=2), "must have one of value, at_most, at_least"),
    "no_value": (lambda entry: entry["measured"][0].pop("value"), "must have one of value, at_most, at_least"),
    "no_range": (lambda entry: entry["assumed"]["humidity"].pop("range"), "must have either range or one_of"),
    "logarithm": (lambda entry: entry["assumed"]["humidity"].update(range=[0, 1], scale="log"), "must be positive"),
    "no_states": (
        lambda entry: entry["measured"][0].update(kind="ratio"),
        "is a level without along, or a law with it",
    ),
    "threshold": (lambda entry: entry["measured"][0].update(falls_to=0.5), "must have falls_to for a threshold"),
    "no_probe": (lambda entry: entry["setup"].update(radius_um=1), "radius_um for a probe, and only for one"),
    "no_radius": (lambda entry: entry["setup"].update(observable="probe"), "radius_um for a probe, and only for one"),
    "no_setup": (lambda entry: entry.pop("setup"), "write either setup or not_computed"),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_files_are_refused_in_one_sentence_that_names_file_and_key(tmp_path, name):
    change, words = WRONG[name]
    entry = yaml.safe_load((experiment.FOLDER / "mit_bonding.yaml").read_text(encoding="utf-8"))
    change(entry)
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump(entry, allow_unicode=True), encoding="utf-8")
    with pytest.raises(ValueError, match=re.escape(words)) as refused:
        experiment.read(path)
    assert str(refused.value).startswith("mine.yaml: ")
    assert "\n" not in str(refused.value)


def test_neither_measured_values_nor_reasons_change_what_a_prediction_depends_on(tmp_path):
    text = (experiment.FOLDER / "delft_sidewall.yaml").read_text(encoding="utf-8")
    path = tmp_path / "mine.yaml"

    def depends_on(text):
        path.write_text(text, encoding="utf-8")
        return experiment.predicted_from(path)

    stated = depends_on(text)
    assert depends_on(text.replace("value: 10", "value: 99").replace("area and tilt", "nothing")) == stated
    assert depends_on(text.replace("[1, 20]", "[1, 21]")) != stated


# Laws


def law(kind, values, of, **more):
    """Quantity of a law from values at places."""
    row = experiment.Row("", kind, "-", along={"name": "x", "values": tuple(values)}, **more)
    return prediction.law(row, np.asarray(of, float))


def test_laws_of_a_power_are_its_exponent_its_ratios_and_its_crossing():
    places, exponent = np.array([0.3, 1.0, 2.0, 7.0]), -1.7
    values = 5 * places**exponent
    assert_allclose(law("exponent", places, values), exponent)
    assert_allclose(law("ratio", places[:2], values[:2]), (0.3 / 1.0) ** exponent)
    middle = [np.sqrt(0.3 * 7.0), 0.3, 7.0]  # a power law is its own geometric mean
    assert_allclose(law("ratio", middle, 5 * np.array(middle) ** exponent, powers=(1, -0.5, -0.5)), 1)
    assert_allclose(law("threshold", places, values, falls_to=0.1), 0.3 * 0.1 ** (1 / exponent))
    assert law("threshold", places, np.ones(4), falls_to=0.1) == 7.0
    assert law("maximum", places, [1, 3, 4, 2]) == 2.0


# Intervals


def covered(of, truths, drawn_from=None):
    """Fraction of experiments with a drawn truth whose interval contains the drawn measurement."""
    row, inside = replace(of.rows[0], error=0.05), 0
    for number in range(truths):
        rng = stream(1, "truth", number)
        inputs = {name: each.at(rng.random()) for name, each in of.assumed.items()}
        (state,) = of.states(row, inputs)
        truth = 1e9 * prediction.value(state, None)[0]
        value = truth * np.exp(0.05 / truth * rng.standard_normal())
        predicted = prediction.predicted(replace(drawn_from or of, name=f"number {number}"))
        draws = 1e9 * np.array(predicted[0]["draws"])
        inside += comparison.compared(replace(row, value=value), draws, rng)["inside"]
    return inside / truths


def test_intervals_contain_truths_drawn_from_the_assumed_inputs_as_often_as_stated_and_too_narrow_ones_do_not(film):
    stated, truths = (prediction.DRAWS - 1) / (prediction.DRAWS + 1), 150
    error = np.sqrt(stated * (1 - stated) / truths)
    found = covered(film, truths)
    # Evenly spread draws have a range above that of independent ones, which holds another draw as often as stated.
    assert stated - 4 * error < found < 1
    narrow = {"humidity": replace(film.assumed["humidity"], range=(0.44, 0.46))}
    assert covered(film, truths, replace(film, assumed=film.assumed | narrow)) < stated - 4 * error


def test_bounds_are_exceeded_only_if_no_draw_obeys_them():
    draws, rng = np.geomspace(1, 10, 19), np.random.default_rng(1)
    upper, lower = ({"at_most": 0.9}, {"at_most": 1.1}), ({"at_least": 11}, {"at_least": 9})
    for (broken, obeyed), sign in ((upper, -1), (lower, 1)):
        outside, inside = (
            comparison.compared(experiment.Row("", "level", "-", **bound), draws, rng) for bound in (broken, obeyed)
        )
        assert not outside["inside"]
        assert inside["inside"]
        assert sign * outside["apart"] > 1


def test_distances_are_standard_deviations_of_logarithms_or_of_exponents():
    draws, rng = np.exp(np.linspace(-1, 1, 19)), np.random.default_rng(1)
    deviation = np.linspace(-1, 1, 19).std(ddof=1)
    level = comparison.compared(experiment.Row("", "level", "-", value=np.exp(3 * deviation)), draws, rng)
    assert_allclose(level["apart"], 3)
    power = comparison.compared(experiment.Row("", "exponent", "-", value=-2 * deviation), np.log(draws), rng)
    assert_allclose(power["apart"], -2)


def test_errors_of_the_measurement_widen_the_interval_by_their_size():
    row = experiment.Row("", "level", "-", value=2.0, error=0.2)
    noisy = np.log(comparison.noisy(row, np.ones(2001), np.random.default_rng(1)))
    assert_allclose([noisy.mean(), noisy.std()], [0, 0.1], atol=1e-3)


# Tables of the docs


@pytest.fixture(scope="module")
def frame():
    """Rows of the table of the docs."""
    return pd.read_csv(TABLES / "validation.csv", skiprows=1)


def test_tables_of_the_docs_are_those_of_their_csv_with_a_licence(frame):
    assert (TABLES / "validation.csv").read_text(encoding="utf-8").startswith("# Licence: CC BY 4.0")
    assert (TABLES / "validation.md").read_text(encoding="utf-8") == comparison.table(frame)
    assert (TABLES / "validation_misses.md").read_text(encoding="utf-8") == comparison.misses(frame)


def test_every_row_of_every_experiment_is_in_the_table_and_each_miss_has_a_side_and_a_reason(frame):
    listed = [(each.name, row.quantity) for each in EXPERIMENTS for row in each.rows]
    assert listed == list(zip(frame.experiment, frame.quantity, strict=True))
    outside = frame[frame.inside.eq(False)]
    assert len(outside) > 0
    assert outside[["reason", "side"]].notna().all(axis=None)
    assert frame[frame.inside.eq(True)].reason.isna().all()


def test_the_score_of_the_page_is_that_of_the_table(frame):
    page = (ROOT / "docs" / "experiments.md").read_text(encoding="utf-8")
    known = frame[frame.predicted.notna() & frame.value.notna()]
    inside = int(known.value.between(known.low, known.high).sum())
    assert f"{inside} of {len(known)} measured values" in page


# Predictions


def test_levels_are_in_their_unit_and_places_of_laws_in_that_of_their_states(film, tmp_path):
    level = film.rows[0]
    places = replace(level, kind="threshold", along={"name": "humidity", "values": (0.4, 0.5)}, falls_to=0.5)
    for row, draws, expected in ((level, [1.4e-9] * 2, 1.4), (places, [1.4] * 2, 1.4)):
        (tmp_path / f"{film.name}.json").write_text(
            json.dumps([{"draws": draws, "monte_carlo": 0.0}]), encoding="utf-8"
        )
        (found,) = comparison.rows(replace(film, rows=(row,)), tmp_path)
        assert_allclose(found["predicted"], expected)


def test_two_experiments_are_predicted_and_compared(tmp_path):
    sidewall, wafers = (
        experiment.read(experiment.FOLDER / f"{name}.yaml") for name in ("delft_sidewall", "mit_bonding")
    )
    for each in (sidewall, wafers):
        found = prediction.predicted(each, draws=2)
        assert found == prediction.predicted(each, draws=2)
        (tmp_path / f"{each.name}.json").write_text(json.dumps(found), encoding="utf-8")
    frame = pd.DataFrame([row for each in (sidewall, wafers) for row in comparison.rows(each, tmp_path)])
    assert frame.laboratory.nunique() == 2
    assert (frame.low <= frame.predicted).all()
    assert 1e-2 < frame.predicted[0] / 10 < 1e2  # nN
    assert 1.1 < frame.predicted[1] < 1.6  # nm, film at RH 0.4 to 0.5
    lines = comparison.table(frame).splitlines()
    assert len(lines) == 4
    assert "†" not in lines[2]
    assert "†" in lines[3]


FACE = {"rms_nm": 1.0, "hurst": 0.8, "correlation_length_nm": 20, "cutoff_rad_per_um": 300, "like": "B2"}
TIP = {
    "observable": "probe",
    "radius_um": 0.02,
    "faces": [FACE, FACE],
    "air": 0.45,
    "strips": 8,
    "settings": {"sampling": {"spacing_nm": 0.5, "margin_um": 0.2}, "van_der_waals": "none"},
}


def test_probes_are_devices_of_the_kind_probe_and_flat_patches_are_not():
    config = stiction.load(prediction.configuration(TIP, (0.45, 0.6), 1))
    of_device = stiction.Device.of(config, prediction.PROBE).forces().pull_off
    contacts = prediction.Contacts([TIP, TIP | {"air": 0.6}], seed=1)
    for humidity in (0.45, 0.6):
        assert_allclose(contacts.of(TIP | {"air": humidity}), of_device.sel(humidity=humidity))
    flat = {"observable": "force", "faces": [FACE, FACE], "air": 0.45, "area_um2": 0.01, "strips": 8}
    (force, error), (of_flat, _) = (prediction.value(state, prediction.Contacts([state], 1)) for state in (TIP, flat))
    assert abs(of_flat / force - 1) > 4 * error  # control: the shape counts


def test_a_smooth_tip_holds_4_pi_r_gamma_and_a_rough_sphere_far_less():
    def relative(state):
        """Force over that of a smooth sphere."""
        return prediction.value(state, prediction.Contacts([state], 1))[0] / (4e-6 * np.pi * state["radius_um"] * 0.072)

    assert_allclose(
        relative(TIP | {"faces": [FACE | {"rms_nm": 0.02}] * 2}), 1, rtol=0.04
    )  # by 200 pixels in the water
    sphere = {"radius_um": 5, "faces": [FACE | {"rms_nm": 3.0}] * 2, "settings": {"van_der_waals": "none"}}
    assert relative(TIP | sphere) < 0.5  # control


def test_quantiles_of_a_crack_length_are_ends_of_the_intervals_of_table_3():
    table = pd.read_csv(TABLES / "table_3.csv", dtype={"pair": str})
    row = table[(table.pair == "b") & (table.model == "NG") & np.isclose(table.relative_humidity, 0.67)].iloc[0]
    ends = [1e6 * prediction.crack("b", 0.67, quantile) for quantile in (0.025, 0.5, 0.975)]
    # Lengths in the package are rounded to 0.1 µm, and the table has the error of the simulation as well.
    assert_allclose(ends, [row.prediction_95_low_um, row.crack_length_um, row.prediction_95_high_um], rtol=2e-3)


def test_assumed_inputs_are_evenly_spread(film):
    humidities = sorted(each["humidity"] for each in prediction.assumed(film, 64))
    assert_allclose(humidities, 0.4 + 0.1 * (np.arange(64) + 0.5) / 64, atol=0.1 / 32)


def test_the_figure_counts_what_the_table_counts_and_its_misses_are_first():
    frame = pd.read_csv(ROOT / "docs" / "tables" / "validation.csv", comment="#")
    panels = figure.drawn(frame).axes
    titles = [panel.get_title(loc="left").rpartition(": ")[2] for panel in panels]
    known = frame[frame.predicted.notna()]
    found = [[int(number) for number in re.findall(r"\d+", title)] for title in titles]
    measured, bounds = known[known.value.notna()], known[known.value.isna()]
    assert [sum(one[k] for one in found) for k in (0, 1)] == [measured.inside.sum(), len(measured)]
    assert [sum(one[k] for one in found if len(one) > 2) for k in (2, 3)] == [bounds.inside.sum(), len(bounds)]
    for panel in panels:
        marks = [line for line in panel.lines if len(line.get_xdata()) == 1]
        names = [name.get_text() for name in panel.texts]
        assert len(marks) == len(names) == len(set(names))
        assert not any("…" in name for name in names)
        missed = [line.get_color() == figure.OUTSIDE[0] for line in marks]
        assert missed == sorted(missed, reverse=True)
        assert any(missed)
        assert not all(missed)
        for is_missed in (True, False):
            along = [line.get_xdata()[0] for line, one in zip(marks, missed, strict=True) if one == is_missed]
            assert along == sorted(along, reverse=True), "from above the prediction to below"


def test_names_of_the_figure_are_whole_beside_their_bars_and_inside_of_their_panel():
    frame = pd.read_csv(ROOT / "docs" / "tables" / "validation.csv", comment="#")
    drawn = figure.drawn(frame)
    drawn.draw_without_rendering()
    for panel in drawn.axes:
        frame_of_panel, marks = panel.bbox, [line for line in panel.lines if len(line.get_xdata()) == 1]
        for name, mark, following in zip(panel.texts, marks, [*panel.texts[1:], None], strict=True):
            box, height = name.get_window_extent(), panel.transData.transform((0, mark.get_ydata()[0]))[1]
            assert frame_of_panel.x0 <= box.x0 < box.x1 <= frame_of_panel.x1
            assert box.y0 > height, "above its bar"
            assert following is None or following.get_window_extent().y1 < height
