"""Devices over two processes: rows of a map are curves over one process, and recommended pairs of settings suffice."""

import re

import numpy as np
import pytest
import xarray as xr
from legends import covering
from test_process_stages import BARE, BUMP, ETCH, SECTIONS, SHARE, setting

import stiction
from stiction.analysis import process_law
from stiction.analysis.process_law import fit, grid
from stiction.devices.process import Margins, recommended, unknown
from stiction.plan.graph import Results
from stiction.report.axes import figures, section, tables
from stiction.report.axes import process as sentences
from stiction.report.page import Page, Summary
from stiction.report.style import png
from stiction.stages.axes import recommended as stage

#: Smooth substrates, rougher with the time of a deposition.
DEPOSITION = {
    "variable": "deposition_time_min",
    "surface": "Sub1",
    "settings": [setting(5, rms_nm=0.4), setting(20, rms_nm=2.0)],
}
RMS = ETCH | {"settings": [setting(30, rms_nm=2.0), setting(90, rms_nm=8.0)]}
#: On summits: full contact has the changes of the surfaces of a pair as given, which differ between the two routes.
SMALL = {"contact": {"samples": 60, "model": "summits"}, "design": {"budget_samples": 60}}
VARIABLES = {"variable": "etch_time_s", "second_variable": "deposition_time_min"}
BOTH = BUMP | {"process": "etch", "second_process": "deposition"}


def config(*more, **device):
    """Configuration of a device over two processes."""
    processes = {"etch": RMS, "deposition": DEPOSITION}
    return stiction.load(SECTIONS, SMALL, {"process": processes, "devices": {"Bump": BOTH | device}}, *more)


@pytest.fixture(scope="module")
def mapped():
    return stiction.Process.of(config(), "etch")


# Points


@pytest.mark.parametrize("number", [0, 13, 34])
def test_a_point_of_a_map_is_that_of_a_curve_with_the_other_surface_as_the_second_process_makes_it(mapped, number):
    row, column = divmod(number, 7)
    time = grid([5, 20], 4)[row]
    other = {
        "surfaces": {
            "Sub1": {"rms_nm": float(np.exp(stiction.Process.of(config(), "deposition").at(time).estimate[0])) * 1e9}
        }
    }
    alone = {name: value for name, value in BOTH.items() if name != "second_process"}
    one = Results.of(stiction.load(SECTIONS, SMALL, other, {"process": {"etch": RMS}, "devices": {"Bump": alone}}))
    ours, along = mapped.results[f"process/points/Bump_{number}"], one[f"process/points/Bump_{column}"]
    assert (float(ours["value"]), float(ours.second)) == (float(along["value"]), time)
    for name in ("safe", "estimate", "error", "stuck"):
        np.testing.assert_allclose(ours[name], along[name], rtol=1e-7)


def test_points_at_the_ends_and_in_the_middle_of_both_axes_have_slopes(mapped):
    settings = [mapped.results.graph.job(f"process/points/Bump_{number}").settings for number in range(35)]
    with_slopes = [number for number, of_point in enumerate(settings) if "samples" in of_point]
    assert with_slopes == [7 * row + column for row in (0, 2, 4) for column in (0, 3, 6)]


@pytest.mark.slow
def test_a_map_joins_all_its_points_with_slopes_by_both_laws(mapped):
    found = mapped.margins("Bump")
    points = [mapped.results[f"process/points/Bump_{number}"] for number in range(35)]
    for point in points:
        at = found.sel(value=float(point["value"]), second=float(point.second))
        np.testing.assert_array_equal(at.estimate, point.estimate)
        if "slopes" in point:
            np.testing.assert_allclose(at.slopes, point.slopes)
    assert sum("slopes" in point for point in points) == 9
    assert list(found.law_process.values) == ["etch", "deposition"]
    assert np.all(found.law_error > 0)
    rough = found.margin.values[:, :, 0, 0]
    assert np.all(rough[-1] > rough[0])  # rougher substrates keep a stopper free
    pairs = mapped.pairs("Bump")
    inside = (found["value"].values[:, None] == pairs["value"].values).any(axis=0)
    shown = pairs.margin.sel(value=pairs["value"][inside], second=found.second)
    np.testing.assert_allclose(shown, rough[:, np.isin(found["value"], pairs["value"])], atol=1e-9)
    assert sentences.answers_of_pairs(pairs) == mapped.answers("Bump")
    assert png(mapped.plot("Bump"))[:4] == b"\x89PNG"
    laws = [mapped.law, stiction.Process.of(config(), "deposition").law]
    table = tables.of_pairs({"Bump": found}, {"Bump": pairs}, {"Bump": laws})
    assert len(table.frame) == len(points)
    assert "Bump: " + sentences.pairs_briefly(pairs) in table.caption
    data = {"process_map": found, "process_pairs": pairs, "process_laws": laws}
    screen = Summary(
        "good", "Suffices", "It is safe.", (), {"What decides": "RH 0.6.", "What to change": "Less."}, None
    )
    page = section.with_process(Page("Bump", {}, ["Because."], summary=screen), "Bump", data)
    assert page.answer == [sentences.pairs_briefly(pairs), "Because."]
    assert page.summary.points == {
        "What decides": "RH 0.6.",
        "What to change": f"Less. {sentences.pairs_briefly(pairs)}",
    }
    assert [one.title for one in page.sections] == [
        "Which settings of the two processes?",
        "Law of B2",
        "Law of Sub1",
    ]


@pytest.mark.slow
@pytest.mark.parametrize("pair", ["best", (47.0, 8.0)])  # the latter is between the computed ones
def test_the_margin_at_a_pair_is_that_of_other_samples_on_both_surfaces(mapped, pair):
    found, pairs = mapped.margins("Bump"), mapped.pairs("Bump")
    at = pairs.best.values.tolist() if pair == "best" else pair
    processes = {"B2": mapped, "Sub1": stiction.Process.of(config(), "deposition")}
    surfaces = {
        surface: {"rms_nm": 1e9 * float(np.exp(process.at(value).estimate[0]))}
        for (surface, process), value in zip(processes.items(), at, strict=True)
    }
    brute = stiction.load(
        SECTIONS, {"surfaces": surfaces, "devices": {"Bump": BARE}, "seed": 7}, {"contact": {"samples": 1000}}
    )
    forces = stiction.Device("Bump", Results.of(brute)).forces().pull_off.values[0]
    margin = -np.log(np.quantile(forces, 1 - SHARE) / 8e-6)
    promised, error = (
        float(one.interp(value=at[0], second=at[1]).squeeze()) for one in (pairs.margin, found.simulation_error)
    )
    assert abs(margin - promised) < 3 * error
    assert abs(margin - promised + 10 * error) > 3 * error  # control


def test_processes_know_their_devices_over_two_of_them():
    both = config()
    for name in ("etch", "deposition"):
        assert stiction.Process.of(both, name).devices == ["Bump"]
    etch = stiction.Process.of(both, "etch")
    with pytest.raises(ValueError, match="no device has process etch alone"):
        etch.settings()
    with pytest.raises(ValueError, match="device Pad has no second_process beside etch"):
        etch.pairs("Pad")


# Pairs


def straight(low, high, error=0.1):
    """Straight law of one quantity, from -1 to 1, of a process whose runs agree."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(process_law, "SCATTERS", np.array([1e-12]))
        return fit(np.array([low, high]), np.array([[-1.0], [1.0]]), np.full((2, 1, 1), error**2))


LAWS = [straight(30.0, 90.0), straight(5.0, 20.0)]
#: Covariance of the errors of a setting of each process.
ERRORS = [np.array([[0.01]])] * 2


def plane(a=1.0, b=1.0, c=0.0, common=0.0):
    """Map of a margin that is linear in the quantities of both surfaces."""
    values, seconds = grid([30.0, 90.0]), grid([5.0, 20.0], 4)
    x, y = (values - 60) / 30, (seconds - 12.5) / 7.5
    margin = a * x + b * y[:, None] + c
    slopes = np.broadcast_to([a, b], (*margin.shape, 2))
    return Margins((seconds, values), margin, slopes, np.full(margin.shape, common))


def test_pairs_that_suffice_are_beyond_the_line_of_the_requirement_by_the_error_of_both_laws():
    found = recommended([plane()], LAWS, ERRORS, np.random.default_rng(1))
    x, y = (found.axes[1] - 60) / 30, (found.axes[0][:, None] - 12.5) / 7.5
    np.testing.assert_allclose(found.margin, x + y, atol=1e-9)
    variance = [0.1**2 * ((1 - one) ** 2 + (1 + one) ** 2) / 4 for one in (x, y)]  # of a line through both settings
    np.testing.assert_allclose(found.safe, x + y - 1.645 * np.sqrt(sum(variance)), atol=0.03)
    assert found.best.tolist() == [90, 20]


def test_the_best_pair_of_two_maps_is_on_their_common_line():
    maps_of = [plane(1, 0, 0.2), plane(-1, 0, 0.2)]
    found = recommended(maps_of, LAWS, ERRORS, np.random.default_rng(2))
    np.testing.assert_allclose(found.best, [60, 12.5], atol=1e-6)  # any second setting, hence the middle
    np.testing.assert_allclose(found.error[0], 30 * 0.1 / np.sqrt(2), rtol=0.1)
    assert found.interval[0, 0] < 60 < found.interval[0, 1]


def test_the_error_of_simulation_and_model_is_common_to_all_pairs():
    laws = [straight(30.0, 90.0, 1e-9), straight(5.0, 20.0, 1e-9)]
    found = recommended([plane(common=0.5)], laws, ERRORS, np.random.default_rng(3))
    np.testing.assert_allclose(found.margin - found.safe, 1.645 * 0.5, atol=0.06)
    assert np.ptp(found.margin - found.safe) < 1e-6
    assert found.error.tolist() == [0, 0]


def bent(quantity):
    """Part of a margin with the largest value inside, and its slope."""
    beyond = np.maximum(quantity + 0.2, 0)
    return 1.2 * quantity - 0.9 * beyond**2, 1.2 - 1.8 * beyond


def drawn_pair(rng, number=4, error=0.06):
    """Recommended pairs from one draw of two known processes, whose quantities go from -0.9 to 0.9."""
    laws = []
    for ends in ((30.0, 90.0), (5.0, 20.0)):
        values = np.linspace(-0.9, 0.9, number)[:, None] + error * rng.standard_normal((number, 1))
        laws.append(fit(np.linspace(*ends, number), values, np.full((number, 1, 1), error**2)))
    values, seconds = grid(laws[0].settings), grid(laws[1].settings, 4)
    (first, a), (second, b) = (bent(law.at(at)[:, 0]) for law, at in zip(laws, (values, seconds), strict=True))
    margin = first + second[:, None]
    slopes = np.stack(np.broadcast_arrays(a, b[:, None]), axis=-1)
    return recommended(
        [Margins((seconds, values), margin, slopes, np.full(margin.shape, 0.02))],
        laws,
        [np.array([[error**2]])] * 2,
        rng,
    )


def test_the_next_setting_of_each_process_is_that_of_this_process_alone_where_the_margins_add():
    laws = [law_of_bend(ends) for ends in ((30.0, 90.0), (5.0, 20.0))]
    values, seconds = grid(laws[0].settings), grid(laws[1].settings, 4)
    (first, a), (second, b) = (bent(law.at(at)[:, 0]) for law, at in zip(laws, (values, seconds), strict=True))
    slopes = np.stack(np.broadcast_arrays(a, b[:, None]), axis=-1)
    none = np.zeros(slopes.shape[:2])
    found = recommended(
        [Margins((seconds, values), first + second[:, None], slopes, none)], laws, ERRORS, np.random.default_rng(6)
    )
    curves = Margins((values,), first, a[:, None], none[0]), Margins((seconds,), second, b[:, None], none[:, 0])
    for k, (curve, law) in enumerate(zip(curves, laws, strict=True)):
        alone = recommended([curve], [law], ERRORS[:1], np.random.default_rng(7))
        assert (found.next[k], found.again[k]) == (alone.next[0], alone.again[0])
        np.testing.assert_allclose([found.error[k], found.after[k]], [alone.before[0], alone.after[0]], rtol=0.2)
        assert found.after[k] < found.error[k]
    *_, last = sentences.answers_of_pairs(laid_out(found, laws[1].settings))
    when = "again" if found.again[1] else "next"
    assert last.startswith(f"Deposition time: measure {found.next[1]:g} min {when}: this is expected to shrink")


def law_of_bend(ends):
    """Law of one quantity, from -0.9 to 0.9 at four settings."""
    values = np.linspace(-0.9, 0.9, 4)[:, None]
    return fit(np.linspace(*ends, 4), values, np.full((4, 1, 1), 0.01))


@pytest.mark.slow
def test_the_best_pair_of_known_processes_is_in_its_intervals():
    part, rng = (1.2 / 1.8 - 0.2) / 0.9, np.random.default_rng(5)
    best, step = np.array([60 + 30 * part, 12.5 + 7.5 * part]), np.array([1.0, 0.25])  # of the compared settings
    found = [drawn_pair(rng) for _ in range(60)]
    apart = np.array([np.abs(one.best - best) / (np.ptp(one.interval, axis=1) / 2 + step / 2) for one in found])
    inside = np.array(
        [(one.interval[:, 0] - step / 2 <= best) & (best <= one.interval[:, 1] + step / 2) for one in found]
    )
    assert np.all(inside.sum(axis=0) >= 53)  # 57 expected, 1 in 50 times fewer
    assert np.all((apart < 1 / 3).sum(axis=0) < 53)  # control: a third of an interval does not hold it
    assert np.all(np.mean([np.ptp(one.interval, axis=1) for one in found], axis=0) < [30, 7.5])


def laid_out(pairs, measured):
    """Dataset of pairs with the measured settings of the second process."""
    return stage.layout(pairs).assign(second_settings=("setting", measured), share=0.05).assign_attrs(VARIABLES)


# Answers


def told(c=0.0, known=True):
    """Recommended pairs as a dataset, and their map."""
    found = plane(c=c)
    pairs = (
        recommended([found], LAWS, ERRORS, np.random.default_rng(1))
        if known
        else unknown(LAWS[1].settings, np.linspace(30, 90, 5))
    )
    coords = dict(zip(("second", "value"), found.axes, strict=True))
    return laid_out(pairs, LAWS[1].settings), xr.Dataset(coords=coords, attrs=VARIABLES)


def test_answers_name_the_pairs_that_suffice_and_the_best_one():
    first, *more = sentences.answers_of_pairs(told()[0])
    assert first.startswith(
        "Pairs of the etch time and the deposition time leave at most 1 in 20 stuck in the next runs (95 % confidence)"
    )
    low, best = re.search(r"time is (\S+) to 20 min \(mean process: \S+ to 20 min\), best (.*)\.$", first).groups()
    assert 5 < float(low) < 8  # 12.5 - 7.5, and 1.645 errors of 0.75 min
    assert best == "90 s with 20 min"
    assert more[0] == "Where the deposition time is 5 min, no etch time is sure to suffice."
    assert more[1].startswith("Where the deposition time is 20 min, an etch time of 3")
    assert more[1].endswith(" to 90 s suffices.")
    assert more[2].startswith("Etch time: it may lie beyond 90 s")


def test_without_pairs_that_suffice_the_best_is_named_and_settings_beyond_it():
    assert sentences.answers_of_pairs(told(c=-4.0)[0]) == [
        "No pair of the etch time from 30 to 90 s and the deposition time from 5 to 20 min is sure to leave at most "
        "1 in 20 stuck in the next runs (deposition time, mean process: none); the best is 90 s with 20 min.",
        "Etch time: the best setting is the end of the measured range: measure settings above 90 s.",
        "Deposition time: the best setting is the end of the measured range: measure settings above 20 min.",
    ]


def test_where_a_margin_is_unknown_no_pair_is():
    (said,) = sentences.answers_of_pairs(told(known=False)[0])
    assert (
        said == "Pairs of the etch time and the deposition time that suffice are not known: not all could be computed."
    )


@pytest.mark.parametrize("pairs", [{}, {"c": -4.0}, {"known": False}])
def test_a_map_is_drawn_whatever_is_known(pairs):
    told_pairs, found = told(**pairs)
    figure = figures.process_map(found, told_pairs)
    assert covering(figure) == []
    assert png(figure)[:4] == b"\x89PNG"


def test_a_device_over_two_processes_has_a_page_a_table_and_a_figure_of_them():
    graph = Results.of(config()).graph
    page = graph.job("devices/Bump.html")
    assert {"process_map", "process_pairs", "process_laws"} <= page.inputs.keys()
    assert graph.job("figures/process_map_Bump.png").inputs.keys() > {"map", "pairs"}
    devices = graph.plan.devices
    assert (devices.over_process, devices.processed_twice) == ([], ["Bump"])
    needed = {job.stage.name for job in graph.needed("devices")}
    assert {"table_process_map", "figure_process_map", "figure_process_law"} <= needed
    assert not {"process_curve", "process_settings", "table_process", "figure_process"} & needed
