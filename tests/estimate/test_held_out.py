"""Table of the errors of the estimate: its numbers follow from the errors, and rows beside a run from its lengths."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import binom

from stiction.config.reading import read
from stiction.estimate.answer import TO_USE, answer, difficulty
from stiction.estimate.learning import errors as of_estimates
from stiction.estimate.learning import held_out
from stiction.estimate.length import NotLearnt
from stiction.estimate.promise import kept
from stiction.estimate.question import questions
from stiction.estimate.table import content

ROOT = Path(__file__).parents[2]
DEVICES, TABLES = ROOT / "examples" / "devices.yaml", ROOT / "docs" / "tables"
LENGTHS, FORCES = TABLES / "safe_lengths.csv", TABLES / "stoppers.csv"
SLOPE = 0.1


def of_surfaces(*errors, part):
    """Part to the end to use, errors in units of both parts, and a length of each surface with its error."""
    to_use, other = (part["margins"][key] * difficulty(SLOPE, part["rest"]) for key in (TO_USE, "90"))
    errors = [error * (to_use if error < 0 else other) for error in errors]
    return to_use, errors, [of_estimates.Tested(k, SLOPE, math.exp(error), 1.0) for k, error in enumerate(errors)]


def cells(line):
    return [cell.strip() for cell in line.strip("|").split("|")]


#: Parts of the table by the function that tests them.
PARTS = {"tested": "", "tested_bridges": "bridges", "tested_forces": "stoppers"}


@pytest.mark.parametrize("test", PARTS)
@pytest.mark.parametrize(("errors", "inside"), [((0.5, -0.9, 0.99), 3), ((0.5, -1.1, 0.99), 2), ((2.0, 3.0, -4.0), 0)])
def test_a_row_has_the_errors_and_the_surfaces_within_the_intervals(monkeypatch, errors, inside, test):
    part = content()[PARTS[test]] if PARTS[test] else content()
    half, logarithms, found = of_surfaces(*errors, part=part)
    for each in PARTS:
        monkeypatch.setattr(held_out, each, lambda *_: [])
    refused = of_estimates.Tested(len(errors), math.nan, 1.0, math.nan)
    monkeypatch.setattr(held_out, test, lambda folder, name, *_, **__: [*found, refused] * (name == "check_any"))
    monkeypatch.setattr(held_out, "SETS", {"check_any": "any", "check_none": "none"})
    (line,) = [line for line in held_out.lines(Path()) if line.startswith("| any")]
    assert not [line for line in held_out.lines(Path()) if line.startswith("| none")]
    words, number, of_refused, mean, rms, shown, beyond, at_90, _ = cells(line)
    assert (words, int(number), int(of_refused)) == ("any", len(errors) + 1, 1)
    assert float(mean) == pytest.approx(100 * np.mean(logarithms), abs=0.06)
    assert float(rms) == pytest.approx(100 * math.sqrt(np.mean(np.square(logarithms))), abs=0.06)
    assert float(shown) == pytest.approx(100 * half, abs=0.06)
    assert at_90 == counted(inside, len(errors))
    unsafe = sum(error < -1 for error in errors)
    assert beyond == counted(unsafe, len(errors))
    (of_all,) = [line for line in held_out.lines(Path()) if line.startswith("Of all surfaces in no decision")]
    share = f"{100 * unsafe / len(errors):.1f} %"
    assert of_all.endswith(
        f"{unsafe} of {len(errors)} lie beyond the end to use: {share}, where the promise allows 5 %."
    )


def counted(number, of_all):
    """Cell of a number of surfaces."""
    low, high = of_estimates.coverage(number, of_all)
    return f"{number} of {of_all} ({100 * low:.0f} to {100 * high:.0f} %)"


def rows_of_c1():
    """Estimates [µm] of a cantilever in the rows beside a run, by humidity, from many to few that stick."""
    found = {}
    for line in held_out.of_runs(LENGTHS, FORCES, DEVICES):
        if re.match(r"\| C1 \| 0", line):
            _, air, _, _, estimate, interval = cells(line)
            low, high = map(float, interval.split(" to "))
            assert low < float(estimate) < high
            found.setdefault(air, []).append(float(estimate))
    return found


def test_rows_beside_a_run_are_shorter_in_wetter_air_and_where_fewer_stick():
    found = rows_of_c1()
    assert found["0.92"] < found["0.67"]
    for lengths in found.values():
        assert lengths == sorted(lengths, reverse=True)


def test_rows_beside_a_run_are_of_one_touchdown(monkeypatch):
    asked = questions(read(DEVICES), content())["C1"]
    assert asked.touchdowns > 1
    found = rows_of_c1()
    monkeypatch.setattr(held_out, "questions", lambda *_: {"C1": replace(asked, touchdowns=1)})
    assert rows_of_c1() == found


def test_rows_of_a_stopper_are_forces_that_grow_where_fewer_stick():
    found = {}
    for line in held_out.of_runs(LENGTHS, FORCES, DEVICES):
        if line.startswith("| S1 | 0"):
            _, air, one_in, of_run, estimate, interval = cells(line)
            low, high = map(float, interval.split(" to "))
            assert low < float(estimate) < high
            found[float(air), int(one_in)] = float(of_run.removesuffix(" µN")), float(estimate)
    assert sorted(found) == [(air, one_in) for air in (0.44, 0.67, 0.9) for one_in in (100, 1000)]
    for air in (0.44, 0.67, 0.9):
        assert all(fewer > more for fewer, more in zip(found[air, 1000], found[air, 100], strict=True))


def test_rows_of_a_bridge_agree_with_the_run_within_their_intervals():
    found = {}
    for line in held_out.of_runs(LENGTHS, FORCES, DEVICES):
        if line.startswith("| R1 | 0"):
            _, air, one_in, of_run, estimate, interval = cells(line)
            low, high = map(float, interval.split(" to "))
            assert low < float(estimate) < high < 1.3 * low
            assert low <= float(of_run.removesuffix(" µm")) <= high
            found[air, int(one_in)] = float(estimate)
    assert list(found) == [("0.67", 100), ("0.67", 1000), ("0.67", 10_000)]
    assert sorted(found.values(), reverse=True) == list(found.values())


@pytest.mark.parametrize("name", ["", "drawn_"])
def test_the_sizes_of_a_run_inside_the_intervals_are_counted(name):
    devices = DEVICES.with_name("drawn_devices.yaml") if name else DEVICES
    files = (LENGTHS.with_name(f"{name}{LENGTHS.name}"), FORCES.with_name(f"{name}{FORCES.name}"), devices)
    *rows, count, _ = [line for line in held_out.of_runs(*map(str, files)) if line] + [""]
    inside, beyond = [], []
    for row in (cells(line) for line in rows if re.match(r"\| [A-Z]\d \|", line)):
        if row[-2] == "refused":
            continue
        low, high = map(float, row[-1].split(" to "))
        size, unit = row[3].split()
        inside += [low <= float(size) <= high] if row[2] == "1000" else []
        beyond += [float(size) > high if unit == "µN" else float(size) < low] if row[2] == "1000" else []
    assert count == (
        f"At 1 in 1000, {sum(inside)} of {len(inside)} sizes of the run are inside the interval of 90 %, "
        f"and {sum(beyond)} of {len(beyond)} lie beyond the end to use."
    )
    assert 0 < sum(inside) < len(inside) + (name == ""), "control: some drawn devices are outside"


def test_a_size_that_is_refused_is_shown_and_not_counted(monkeypatch):
    whole = list(held_out.of_runs(LENGTHS, FORCES, DEVICES))

    def refusing(question, *learnt):
        """Answer about any device but the bridge."""
        if question.name == "R1":
            raise NotLearnt
        return answer(question, *learnt)

    monkeypatch.setattr(held_out, "answer", refusing)
    rows = list(held_out.of_runs(LENGTHS, FORCES, DEVICES))
    changed = [(cells(old), cells(new)) for old, new in zip(whole, rows, strict=True) if old != new]
    assert len(changed) == 4, "three fractions and the count"
    for old, new in changed[:3]:
        assert new == [*old[:4], "refused", ""]
    assert changed[3][1][0].startswith("At 1 in 1000, 6 of 6 sizes")


def beyond_by_set():
    """Surfaces beyond the end to use and all of them, of each row of the page that decides nothing."""
    rows = [cells(line) for line in (TABLES / "estimate.md").read_text(encoding="utf-8").splitlines()]
    return [tuple(map(int, row[6].split()[:3:2])) for row in rows if row[0].endswith("in no decision")]


def test_no_set_that_decides_nothing_and_not_all_of_them_break_the_promise():
    sets, allowed = beyond_by_set(), 1 - kept("90") / 100
    every = tuple(map(sum, zip(*sets, strict=True)))
    for beyond, number in [*sets, every]:
        assert binom.sf(beyond - 1, number, allowed) > 0.05 / (len(sets) + 1)
    assert every[0] / every[1] < allowed
    assert binom.sf(every[0] - 1, every[1], allowed / 20) < 1e-4, "control: 399 of 400 would be broken"
