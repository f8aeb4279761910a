"""Slopes of the estimate beside those that the run of a cantilever computed for its tips."""

import csv
import math
from dataclasses import replace
from pathlib import Path

import pytest

from stiction.config.reading import read
from stiction.estimate.answer import in_one_air
from stiction.estimate.question import questions
from stiction.estimate.solids import OF_POLYSILICON, SolidPair
from stiction.estimate.table import content, known

ROOT = Path(__file__).parents[2]
AIRS = (0.44, 0.67, 0.92)
#: Half of the step of a difference.
STEP = 0.01


def computed(air, held_by="tip"):
    """Slopes of the logarithm of the length of C1 with their standard errors, by input."""
    with (ROOT / "docs" / "tables" / "budget.csv").open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if (row["device"], row["part"]) == ("C1", "input")]
    of = [row for row in rows if row["held_by"] == held_by and float(row["relative_humidity"]) == air]
    return {row["name"]: (float(row["slope"]), float(row["slope_se"])) for row in of}


def estimated(air):
    """Slopes of the estimate, relative ones but for that by humidity."""
    asked = replace(questions(read(ROOT / "examples" / "devices.yaml"), content())["C1"], touchdowns=1)

    def logarithm(moved, change):
        """Logarithm of the length with one input changed."""
        factor = math.exp(change)
        sizes = {moved: factor * getattr(asked, moved)} if moved in ("thickness", "gap") else {}
        if moved == "Young's modulus":
            moduli = {name: factor * getattr(asked.solids, name) for name in ("modulus", "beam_modulus")}
            sizes = {"solids": replace(asked.solids, **moduli)}
        wet = air + (change if moved == "humidity" else 0.0)
        return math.log(in_one_air(replace(asked, **sizes), wet, [1e-3], *known())[0].length)

    inputs = ("thickness", "gap", "Young's modulus", "humidity")
    return {name: (logarithm(name, STEP) - logarithm(name, -STEP)) / (2 * STEP) for name in inputs}


@pytest.mark.parametrize("air", AIRS)
def test_thickness_and_gap_act_by_one_stiffness_in_the_estimate_and_in_tips_of_the_run(air):
    own, run, beam = estimated(air), computed(air), computed(air, "beam")
    assert own["gap"] == pytest.approx(1 - 2 / 3 * own["thickness"], abs=1e-3)
    (thick, thick_se), (gap, gap_se) = run["thickness"], run["gap"]
    assert abs(gap - (1 - 2 / 3 * thick)) < 4 * math.hypot(gap_se, 2 / 3 * thick_se)
    assert own["thickness"] == pytest.approx(thick, abs=0.1)
    assert own["thickness"] != pytest.approx(beam["thickness"][0], abs=0.1), "the control: cracks follow another power"


def test_the_estimate_replaces_no_budget_as_the_docs_say():
    own, (slope, error) = estimated(0.92)["humidity"], computed(0.92)["humidity"]
    assert own / slope == pytest.approx(1.34, abs=0.1)
    assert abs(own - slope) > 2.5 * error


@pytest.mark.parametrize("air", AIRS)
def test_the_modulus_of_both_solids_acts_as_in_a_run(air):
    own, (slope, error) = estimated(air)["Young's modulus"], computed(air)["Young's modulus"]
    assert abs(own - slope) < 2 * error


def test_a_modulus_beside_water_is_not_that_of_another_film(monkeypatch):
    """The control: solids taken as polysilicon below a film of another energy, of which nothing was learnt."""
    monkeypatch.setattr(SolidPair, "beside_water", lambda *_: OF_POLYSILICON)
    own, (slope, error) = estimated(0.92)["Young's modulus"], computed(0.92)["Young's modulus"]
    assert abs(own - slope) > 4 * error
