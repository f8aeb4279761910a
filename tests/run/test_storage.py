import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from stiction.run import atomic, storage


def dataset():
    return xr.Dataset({"limit": ("strip", np.linspace(0, 1, 20_000))})


def test_a_dataset_is_read_as_it_was_written_with_its_settings(tmp_path):
    storage.save(dataset(), tmp_path / "x.nc", "forces", {"seed": 1, "water": {"temperature_K": 300}})
    loaded = storage.load(tmp_path / "x.nc", "forces")
    np.testing.assert_array_equal(loaded.limit, dataset().limit)
    assert loaded.attrs["settings"] == '{"seed": 1, "water": {"temperature_K": 300}}'


def test_a_part_of_a_dataset_is_read_alone(tmp_path):
    storage.save(dataset(), tmp_path / "x.nc", "forces", {})
    part = storage.load(tmp_path / "x.nc", "forces", strip=slice(5))
    np.testing.assert_array_equal(part.limit, dataset().limit[:5])


def test_a_file_of_another_stage_without_the_dimension_is_rejected_by_name(tmp_path):
    storage.save(dataset().rename(strip="node"), tmp_path / "x.nc", "beams", {})
    with pytest.raises(storage.DataError, match=r"x\.nc holds beams of x, not forces of x"):
        storage.load(tmp_path / "x.nc", "forces", strip=slice(5))


def test_a_dataset_names_the_settings_of_its_inputs(tmp_path):
    storage.save(dataset(), tmp_path / "x.nc", "contact", {"samples": 9})
    storage.save(dataset(), tmp_path / "y.nc", "forces", {}, [tmp_path / "x.nc"])
    before = storage.load(tmp_path / "y.nc", "forces").attrs["before"]
    assert json.loads(before) == {(tmp_path / "x.nc").as_posix(): {"samples": 9}}


def test_equal_data_give_equal_bytes(tmp_path):
    for name, settings in (("one", {"b": 1, "a": 2}), ("two", {"a": 2, "b": 1})):
        storage.save(dataset(), tmp_path / name / "a.nc", "forces", settings)
    assert (tmp_path / "one" / "a.nc").read_bytes() == (tmp_path / "two" / "a.nc").read_bytes()


def test_a_file_of_another_stage_is_rejected_by_name(tmp_path):
    storage.save(dataset(), tmp_path / "x.nc", "forces", {})
    with pytest.raises(storage.DataError, match=r"x\.nc holds forces of x, not beams of x"):
        storage.load(tmp_path / "x.nc", "beams")


def test_a_file_of_another_case_is_rejected_by_name(tmp_path):
    storage.save(dataset(), tmp_path / "b_rh067_NG.nc", "forces", {})
    (tmp_path / "b_rh067_NG.nc").rename(tmp_path / "b_rh088_NG.nc")
    with pytest.raises(storage.DataError, match=r"holds forces of b_rh067_NG, not forces of b_rh088_NG"):
        storage.load(tmp_path / "b_rh088_NG.nc", "forces")


@pytest.mark.parametrize("size", [0, 100, 5000])
def test_a_truncated_file_is_rejected_by_name(tmp_path, size):
    storage.save(dataset(), tmp_path / "x.nc", "forces", {})
    whole = (tmp_path / "x.nc").read_bytes()
    assert len(whole) > 5000
    (tmp_path / "x.nc").write_bytes(whole[:size])
    with pytest.raises(storage.DataError, match=r"x\.nc cannot be read"):
        storage.load(tmp_path / "x.nc", "forces")


@pytest.mark.parametrize("stage", ["", "forces"])
def test_a_foreign_file_is_rejected(tmp_path, stage):
    dataset().assign_attrs(stage=stage).to_netcdf(tmp_path / "x.nc")
    with pytest.raises(storage.DataError, match="no result of this study"):
        storage.load(tmp_path / "x.nc", "forces")


def test_a_failed_write_leaves_the_old_file_and_no_temporary_file(tmp_path):
    storage.save(dataset(), tmp_path / "x.nc", "forces", {})
    before = (tmp_path / "x.nc").read_bytes()
    unwritable = xr.Dataset({"limit": ("strip", np.array([object()], object))})
    with pytest.raises((TypeError, ValueError)):
        storage.save(unwritable, tmp_path / "x.nc", "forces", {})
    assert (tmp_path / "x.nc").read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["x.nc"]


def test_a_folder_that_cannot_be_created_is_reported_by_name(tmp_path):
    (tmp_path / "results").write_text("mine")  # also stops root, which ignores permissions
    with pytest.raises(storage.DataError, match=r"folder .*results cannot be written .*; make it writable"):
        storage.save(dataset(), tmp_path / "results" / "x.nc", "forces", {})


def test_a_disk_error_on_closing_a_file_leaves_no_temporary_file(tmp_path, monkeypatch):
    def fail(_):
        raise OSError("input/output error")

    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(storage.DataError, match=r"x\.txt cannot be written \(input/output error\)"):
        atomic.save_text("Δ", tmp_path / "x.txt")
    assert not list(tmp_path.iterdir())


def test_files_have_the_permissions_that_the_user_gives_all_files(tmp_path):
    before = os.umask(0o027)
    try:
        storage.save(dataset(), tmp_path / "x.nc", "forces", {})
        atomic.save_text("Δ", tmp_path / "x.txt")
    finally:
        os.umask(before)
    assert {path.stat().st_mode & 0o777 for path in tmp_path.iterdir()} == {0o640}
    assert (tmp_path / "x.txt").read_bytes() == b"\xce\x94"


#: Forks jobs that save 20 MB, interrupts each at a moment of its write, and prints how and when it ended.
INTERRUPTED = """
import os, runpy, signal, sys, time
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import xarray as xr

from stiction.plan import running
from stiction.run import storage

script, file, *moments = sys.argv[1:]
fields = np.random.default_rng(1).standard_normal((5, 500_000))
names = ["limit", "rms", "film", "share", "plateau"]
data = xr.Dataset({name: ("strip", values) for name, values in zip(names, fields)})
storage.save(data[["rms"]], file, "forces", {})
running.run = lambda job: storage.save(data, file, "forces", {})
for moment in map(float, moments):
    before = set(Path(file).parent.glob(".*"))
    job = os.fork()
    if job == 0:
        signal.alarm(10)
        runpy.run_path(script, {"snakemake": SimpleNamespace(log=[f"{file}.log"], output=[file])}, "__main__")
        os._exit(0)
    while set(Path(file).parent.glob(".*")) <= before:
        time.sleep(0.001)
    time.sleep(moment)
    os.kill(job, signal.SIGINT)
    sent = time.perf_counter()
    _, status = os.waitpid(job, 0)
    print(os.waitstatus_to_exitcode(status), time.perf_counter() - sent)
storage.save(data[["limit"]], file, "forces", {})
"""


@pytest.mark.slow
def test_a_job_that_is_interrupted_while_it_saves_ends_within_a_second_and_leaves_its_draft_to_the_next(tmp_path):
    script = Path(__file__).parents[2] / "workflow" / "scripts" / "stage.py"
    moments = ["0.0", "0.05", "0.1", "0.15", "0.2", "0.25"]
    words = [sys.executable, "-c", INTERRUPTED, script, tmp_path / "x.nc", *moments]
    ends = [line.split() for line in subprocess.check_output(list(map(str, words)), text=True).splitlines()]
    assert [int(status) for status, _ in ends] == [-signal.SIGINT] * len(moments)
    assert max(float(seconds) for _, seconds in ends) < 1
    assert {path.name for path in tmp_path.iterdir()} == {"x.nc", "x.nc.log"}
    assert list(storage.load(tmp_path / "x.nc", "forces")) == ["limit"]
