"""Stricter sizes beside the size to build: between the stated airs, and of what nothing stated asks for."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from answers import BRIDGE, BUDGETS, CANTILEVER, STOPPER, STOPPERS, beam_answer, safe, stopper_answer
from numpy.testing import assert_equal

from stiction.answer.data import Answer, AnswerInAir, Between, Cause, Stay, Step, Unasked, Verdict
from stiction.answer.sought import FORCE, LENGTH
from stiction.report.answer import screen, tables, words
from stiction.report.devices import explorer
from stiction.report.format import safe_size
from stiction.stages.answer import beside
from stiction.stages.answer.answer import answer_of, layout
from stiction.stages.life.answers import LifeRow, Name

LENGTHS = {0.44: safe(), 0.67: safe(longest=500e-6)}


def peaked(at, force=60e-6):
    """Stopper whose places hold most in one air of its fine axis."""
    stopper = STOPPERS["S1"]
    along = stopper.safe_force_along.fillna(1e-6)
    return stopper.assign(safe_force_along=along.where(~np.isclose(stopper.axis, at)[:, None], force))


def chart(kind, longest, thickness=2.6e-6):
    """Chart of devices of two thicknesses in one air."""
    limits = safe(kind, longest)[["safe_length"]]
    return limits.expand_dims(thickness=[thickness, 4 * thickness], gap=[20e-6])


def test_the_headline_of_a_stopper_names_a_larger_force_between_its_airs_as_its_controls_do():
    stopper = peaked(0.55)
    answer = stopper_answer(stopper, {(0.44,): BUDGETS["S1", 0.67]})
    assert answer.between.humidity == pytest.approx(0.55)
    assert answer.between.size > 1.002 * 60e-6 > answer.build, "the uncertainty of the inputs is inside"
    view = explorer.stopper_view(STOPPER, stopper, answer)
    grid, all_airs = view.grid, float(view.words["all_airs"])
    assert all_airs == answer.together.humidity, "where the controls have the answer for all airs"
    forces, airs = grid.safe[:, grid.share.values.index(answer.share)], np.array(grid.axes[0].values)
    inside = (airs > 0.44) & (airs < 0.67)
    assert 1e6 * answer.between.size == pytest.approx(forces[inside].max())
    beside_it = (
        f"{safe_size(answer.between.size, answer.sought)} between these airs (interpolated at RH 0.55: compute it)"
    )
    assert screen.headline(answer).startswith(
        f"At least {safe_size(answer.build, answer.sought)}, but {beside_it}; with your "
    )
    row = tables.devices({"S1": answer}).frame.iloc[0]
    assert row["stricter"] == beside_it
    assert row["between"] == pytest.approx(1e6 * answer.between.size)


@pytest.mark.parametrize(
    ("longest", "is_named"), [(200.49e-6, False), (200.2e-6, True), (199.99e-6, True), (200.51e-6, False)]
)
def test_a_length_between_the_airs_is_compared_as_a_number_and_not_as_it_reads(longest, is_named):
    """Of 200.51 µm, 200.49 µm differs by rounding and reads as 200 µm, not 201. 200.2 µm differs by more."""
    steps = (Step(Cause.ESTIMATE, 200.51e-6, 1.0, 0.6, "tip", "", True),)
    airs = tuple(AnswerInAir(humidity, 200.51e-6, np.nan, None) for humidity in (0.4, 0.6))
    answer = Answer("C1", "cantilever", 1e-3, "m", 200.51e-6, 200.51e-6, steps, airs)
    limits = {0.4: 200.51e-6, 0.5: longest, 0.6: 200.51e-6}
    assert bool(beside.between(answer, limits)) == is_named
    # Control: as they read, the first two are as different from the size to build.
    reads = answer.in_words(longest) != answer.in_words(answer.build)
    assert reads == (longest < 200.5e-6)


@pytest.mark.parametrize("sought", [LENGTH, FORCE], ids=lambda sought: sought.name)
def test_a_size_is_stricter_if_the_size_to_build_reads_otherwise(sought):
    rng = np.random.default_rng(3)
    sizes = sought.scale * 10 ** rng.uniform(-1, 4, (400, 1)) * (1 + rng.uniform(-3e-3, 3e-3, (1, 2)))
    stricter = [sought.is_stricter(size, build) for size, build in sizes]
    differ = [safe_size(size, sought) != safe_size(build, sought) for size, build in sizes]
    assert_equal(stricter, np.array(differ) & (sought.sign * (sizes[:, 0] - sizes[:, 1]) < 0))
    assert 20 < sum(differ) < 380, "both kinds are drawn"
    assert not any(sought.is_stricter(*pair) for pair in ((1e-4, 1e-4), (np.nan, 1e-4), (1e-4, np.nan)))


@pytest.mark.parametrize("at", [0.44, 0.85])
def test_no_force_is_named_of_airs_that_are_not_between_the_stated_ones(at):
    answer = stopper_answer(peaked(at))
    assert answer.between is None
    one = stopper_answer(peaked(at).sel(humidity=[0.44]))
    assert "all_airs" not in explorer.stopper_view(STOPPER, peaked(at).sel(humidity=[0.44]), one).words
    assert "between" not in screen.headline(answer)


def test_a_force_that_suffices_in_the_stated_airs_alone_is_not_called_safe():
    needed = stopper_answer(peaked(0.55))
    assert needed.between.safe > needed.between.size, "inputs count for more in the drier air"
    for force, tone, change in (
        (needed.build, "open", "A restoring"),
        (needed.between.size, "open", "A restoring"),
        (needed.between.safe, "good", "Nothing."),
    ):
        answer = replace(needed, size=force, stuck=replace(needed.stuck, low=0.0))
        assert answer.verdict is Verdict.SAFE
        assert words.sign_of(answer)[0] == tone
        assert screen.change(answer, STOPPER).startswith(change)


@pytest.mark.parametrize("section", [CANTILEVER, BRIDGE], ids=lambda section: section["kind"])
@pytest.mark.parametrize(
    ("longest", "thickness", "is_named"), [(3e-4, 2.6e-6, True), (9e-4, 2.6e-6, False), (3e-4, 2e-6, False)]
)
def test_the_headline_of_a_beam_names_a_shorter_length_of_its_chart_between_its_airs(
    section, longest, thickness, is_named
):
    kind = section["kind"]
    lengths = {rh: safe(kind, longest=longest_of_air) for rh, longest_of_air in ((0.44, 6e-4), (0.67, 5e-4))}
    answer = beam_answer(section, lengths, charts={0.5: chart(kind, longest, thickness)})
    assert bool(answer.between) == is_named
    assert (" µm between these airs (interpolated at RH 0.5: compute it)" in screen.headline(answer)) == is_named
    if is_named:  # by factors of about one: all inputs count as exact
        limit = float(safe(kind, longest).isel(shape=-1).safe_length.sel(share=answer.share))
        assert answer.between.size == pytest.approx(limit, rel=1e-2)


def test_a_headline_names_what_nothing_stated_asks_for_if_it_is_stricter():
    answer = replace(beam_answer(CANTILEVER, LENGTHS), unasked=())
    build = safe_size(answer.build, answer.sought)
    assert screen.headline(answer) == f"No longer than {build}."
    limits = [(Name.FAST, "", 1e-4), (f"{Name.COLLAPSE}_water", "", 1.2e-4), ("other", "held length: more", 1.3e-4)]
    stricter = replace(answer, unasked=tuple(Unasked(*limit) for limit in limits))
    assert screen.headline(stricter) == (
        f"No longer than {build}, but 100 µm if it separates fast, 120 µm if water dries on it and 130 µm by its held "
        "length."
    )


def test_stricter_sizes_come_back_from_the_dataset_of_an_answer():
    answer = replace(
        beam_answer(CANTILEVER, LENGTHS), between=Between(0.5, 1e-4, 9e-5), unasked=(Unasked("fast", "what", 9e-5),)
    )
    again = answer_of(layout(answer))
    assert (again.between, again.unasked) == (answer.between, answer.unasked)
    without = replace(answer, between=None, unasked=())
    assert not {"between_size", "unasked_size"} & set(layout(without).variables)


def test_limits_of_forces_are_those_of_the_stated_airs_and_of_the_fine_axis():
    stopper = peaked(0.55)
    limits = beside.of_forces(stopper, 1e-2)
    assert_equal(sorted(limits), np.unique([*stopper.humidity.values, *stopper.axis.values]))


def test_what_nothing_stated_asks_for_has_the_errors_of_the_inputs():
    rows = [
        ("fast", 2e-4, 2.2e-4, 1e-6),
        ("collapse_water", 2.3e-4, 3e-4, 2e-5),
        ("safe_length_0.5", 2.2e-4, 2.2e-4, 2e-5),
    ]
    rows = [LifeRow(name, "stick", name, low, high, error, "m", "", "") for name, low, high, error in rows]
    life = xr.Dataset({field: ("answer", [getattr(row, field) for row in rows]) for field in LifeRow._fields[1:]})
    life = life.assign_coords(answer=[row.name for row in rows])
    steps = tuple(Step(cause, size, factor, 0.5, "tip", "", stated) for cause, size, factor, stated in STEPS)
    answer = Answer("C1", "cantilever", 1e-3, "m", 2.1e-4, 2.2e-4, steps, ())
    found = {limit.name: limit.size for limit in beside.unasked(life, answer)}
    assert found == pytest.approx({"fast": 0.9 * 2.1e-4, "collapse_water": 2.3e-4 - 1.6449 * 2e-5}, rel=1e-4)
    # Control: with exact inputs, drying would allow the size, and one that is asked for is inside the size to build.
    assert not beside.is_short(rows[1], answer.build)
    asked = tuple(replace(step, stated=True) for step in steps)
    assert {limit.name: limit.size for limit in beside.unasked(life, replace(answer, steps=asked))}["fast"] == 2e-4


#: Steps of an answer: cause, size, factor, and whether it is stated.
STEPS = [(Cause.ESTIMATE, 2.3e-4, 1.0, True), (Cause.FAST, 2.07e-4, 0.9, False), (Cause.INPUTS, 2.1e-4, 0.95, True)]


def test_a_mission_does_not_ask_for_all_touchdowns_in_the_worst_air():
    rows = [
        LifeRow(str(name), "stick", "", low, 3e-4, np.nan, "m", "", "")
        for name, low in ((Name.AFTER, 1e-4), (Name.FAST, 2e-4))
    ]
    life = xr.Dataset({field: ("answer", [getattr(row, field) for row in rows]) for field in LifeRow._fields[1:]})
    life = life.assign_coords(answer=[row.name for row in rows])
    answer = Answer("C1", "cantilever", 1e-3, "m", 2.5e-4, 2.5e-4, (), ())
    of_mission = replace(answer, stays=(Stay((0.5,), 9.0),))
    assert [one.name for one in beside.unasked(life, answer)] == [Name.AFTER, Name.FAST]
    assert [one.size for one in beside.unasked(life, of_mission)] == [2e-4]
    assert not beside.unasked(life, replace(answer, build=np.nan))
