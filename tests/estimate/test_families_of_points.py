"""Points of the estimate in chunks: each point is in one chunk, and control numbers decide if they are valid."""

import json
import os
from dataclasses import replace

import numpy as np
import pytest

from stiction.estimate.learning import training
from stiction.estimate.learning.files import CHUNK, numbers_of, path_of
from stiction.estimate.learning.jobs import control, families
from stiction.estimate.learning.jobs.families import FAMILIES, Family

SETS = {"learn_any": training.SETS["control"], "control": training.SETS["control"]}


def numbers_for(points, every=1):
    """Family whose points have their number alone, and the set of these numbers."""
    sets = {name: replace(effort, points=points) for name, effort in SETS.items()}
    compute = lambda point, name, valid: {"of": np.array(point.number)}  # noqa: ARG005, E731
    return Family("f", sets, dict, compute, {"learn_any": every})


@pytest.mark.parametrize(("points", "every"), [(1, 1), (CHUNK, 1), (CHUNK + 1, 1), (2 * CHUNK + 5, 2), (3 * CHUNK, 4)])
def test_chunks_have_every_point_once(tmp_path, monkeypatch, points, every):
    monkeypatch.chdir(tmp_path)
    family = numbers_for(points, every)
    monkeypatch.setitem(FAMILIES, "f", family)
    assert len(set(family.chunks())) == -(-points // CHUNK)
    for chunk in family.chunks():
        families.main(chunk)
        assert (tmp_path / chunk).is_dir()
    folder = tmp_path / "f" / "learn_any"
    found = sorted(int(path.stem) for path in folder.rglob("*.npz"))
    assert found == list(range(0, points, every))
    assert all(numbers_of(folder, number)["of"] == number for number in found)
    assert not (tmp_path / "f" / "control").exists()


def test_a_family_reads_points_of_the_same_chunk():
    after = [family for family in FAMILIES.values() if family.after]
    assert after
    for family in after:
        before = set(FAMILIES[family.after].chunks())
        assert {chunk.replace(family.folder, family.after) for chunk in family.chunks()} <= before
        assert all(set(family.numbers(name)) <= set(FAMILIES[family.after].numbers(name)) for name in family.sets)


def test_every_set_of_the_table_has_a_family():
    assert [family.folder for family in FAMILIES.values()] == list(FAMILIES)
    chunks = [chunk for family in FAMILIES.values() for chunk in family.chunks()]
    assert len(chunks) == len(set(chunks))
    assert not [chunk for chunk in chunks if "control" in chunk]


def test_points_of_a_number_have_one_file(tmp_path):
    paths = {path_of(tmp_path, number) for number in range(100)}
    assert len(paths) == 100
    assert {path.parent.name for path in paths} == {f"{first:04}" for first in range(0, 100, CHUNK)}


NUMBERS = {"humid": {"slopes": [1.0, 2.0], "forces": [3.0]}, "dry": {"ratio": [float("nan")], "full": [4.0]}}


@pytest.mark.parametrize(
    ("air", "change", "agree"),
    [
        ("humid", {}, True),
        ("humid", {"slopes": [1.00005, 2.0]}, True),
        ("humid", {"slopes": [1.0, 2.0005]}, False),
        ("humid", {"slopes": [1.0]}, False),
        ("humid", {"more": [1.0]}, False),
        ("dry", {"full": [4.01]}, False),
        ("dry", {"ratio": [1.0]}, False),
    ],
)
def test_points_stay_while_control_numbers_agree(tmp_path, monkeypatch, air, change, agree):
    """A file that agrees keeps its time, by which the points are valid."""
    file, found = tmp_path / "new" / "control.json", NUMBERS | {air: NUMBERS[air] | change}
    monkeypatch.setattr(control, "numbers", lambda: NUMBERS)
    control.save(file)
    os.utime(file, (1, 1))
    monkeypatch.setattr(control, "numbers", lambda: found)
    control.save(file)
    assert (file.stat().st_mtime == 1) == agree == control.agree(NUMBERS, found)
    assert control.agree(json.loads(file.read_text()), found)
