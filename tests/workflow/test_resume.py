"""A run that is ended anywhere, in any way, loses what it was at and nothing else."""

import contextlib
import fcntl
import os
import resource
import shutil
import signal
import subprocess
import time
from itertools import cycle

import pytest
import xarray as xr
from conftest import BEAMS, command, datasets, snakemake

#: Targets that need every stage, without a verdict on so few samples.
ALL = ["tables", "figures", "results/checks.csv"]
#: Stages by the names of their logs; the last has many jobs, so that no run ends before it can be ended.
STAGES = ["heights", "identification", "spectrum", "character", "iteration", "contact", "forces", "fit", "chaos"]
STAGES += ["humidity", "beams", "studies", "tables", "checks", "figures"]


@pytest.fixture(scope="session")
def everything(tmp_path_factory, tiny):
    """Folder of a finished run of all stages of one tiny case."""
    folder = tmp_path_factory.mktemp("everything")
    snakemake(folder, *ALL, configs=[tiny])
    return folder


def files_of(stage, folder):
    """Files of a stage in a folder of results or of logs."""
    return [
        path for path in folder.rglob("*.*") if path.is_file() and path.relative_to(folder).parts[0].startswith(stage)
    ]


def logs_of(stage, folder):
    """When the logs of a stage were last written to, by path."""
    times = {}
    for path in files_of(stage, folder / "results" / "logs"):
        with contextlib.suppress(FileNotFoundError):  # Snakemake has just removed it, before its job starts
            times[path] = path.stat().st_mtime_ns
    return times


def end_in_stage(stage, how, folder, targets, tiny, after=0.0):
    """Start a run; when a job of a stage has opened its log, wait [s] and send its process group a signal."""
    before = logs_of(stage, folder)
    with (folder / "printed.txt").open("w") as printed:
        run = subprocess.Popen(
            **command(folder, *targets, configs=[tiny]), stdout=printed, stderr=printed, start_new_session=True
        )
        while run.poll() is None:
            if logs_of(stage, folder).items() - before.items():
                time.sleep(after)
                os.killpg(run.pid, how)
                break
            time.sleep(0.01)
        status = run.wait(60)
    assert status != 0, f"the run ended before it could be ended in {stage}:\n{(folder / 'printed.txt').read_text()}"


def drafts(folder):
    """Half-written files."""
    return [path for path in (folder / "results").rglob(".*") if path.is_file()]


def assert_only_whole_files(folder, reference):
    """Whatever stands under the name of a result is the result."""
    whole = datasets(reference)
    for name, content in datasets(folder).items():
        # Chunks are gone when a run has ended.
        assert content == whole.get(name, content), f"{name} is half-written"
        if name.endswith(".nc"):
            xr.load_dataset(folder / "results" / name).close()


def assert_resumed(folder, reference, targets, tiny):
    """Started again without a word, the run ends with the files of the undisturbed one, and leaves nothing else."""
    done = snakemake(folder, *targets, configs=[tiny])
    assert "unlock" not in done.stdout
    assert datasets(folder) == datasets(reference)
    assert drafts(folder) == []


def test_a_run_killed_in_its_longest_stage_goes_on_without_unlocking(undisturbed, tiny, tmp_path):
    end_in_stage("contact", signal.SIGKILL, tmp_path, [BEAMS], tiny, after=1.0)
    assert_only_whole_files(tmp_path, undisturbed)
    end_in_stage("beams", signal.SIGTERM, tmp_path, [BEAMS], tiny, after=0.5)
    assert_resumed(tmp_path, undisturbed, [BEAMS], tiny)


@pytest.mark.slow
def test_a_run_ended_in_every_stage_ends_with_the_same_bytes(everything, tiny, tmp_path):
    moments = cycle((0.0, 0.7, 1.4))
    for stage in STAGES:
        for how in (signal.SIGKILL, signal.SIGTERM):
            for path in files_of(stage, tmp_path / "results"):  # of jobs that ended earlier
                path.unlink()
            end_in_stage(stage, how, tmp_path, ALL, tiny, next(moments) if stage != "checks" else 0.0)
            assert_only_whole_files(tmp_path, everything)
    assert_resumed(tmp_path, everything, ALL, tiny)


@pytest.mark.slow
def test_a_disk_that_is_full_in_any_stage_is_told_and_leaves_no_half_written_file(everything, tiny, tmp_path):
    on_small_disk = ["unshare", "--map-root-user", "--mount", "sh", "-c"]
    on_small_disk += [
        'mount -t tmpfs -o size=4k none "$0" && { "$@"; ended=$?; find "$0" -type f -name "*.*"; exit $ended; }'
    ]
    if subprocess.run([*on_small_disk, tmp_path, "true"]).returncode:
        pytest.skip("a small disk can be mounted neither here nor in a namespace")
    for stage in STAGES:
        if stage == "checks":  # files beside those folders
            continue
        disk = tmp_path / "results" / stage
        disk.mkdir(parents=True, exist_ok=True)
        run = command(tmp_path, *ALL, configs=[tiny])
        done = subprocess.run(
            **run | {"args": [*on_small_disk, disk, *run["args"]]}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
        )
        assert done.returncode == 1, done.stdout
        assert "is the disk full?" in done.stdout, done.stdout
        assert str(disk) not in done.stdout.splitlines()[-1], "a file stayed on the full disk"
        assert_only_whole_files(tmp_path, everything)
    assert_resumed(tmp_path, everything, ALL, tiny)


def copied(folder, target, stages=()):
    """A finished run, copied with its record, without the files of some stages."""
    shutil.copytree(folder, target, dirs_exist_ok=True)
    for stage in stages:
        shutil.rmtree(target / "results" / stage)
    return target


def test_a_full_disk_is_told_and_leaves_no_half_written_file(undisturbed, tiny, tmp_path):
    folder = copied(undisturbed, tmp_path / "run", ["beams"])
    (folder / "results" / "provenance.json").unlink()
    full = 17_000  # bytes; every dataset is longer, and nothing else is
    done = subprocess.run(
        **command(folder, BEAMS, configs=[tiny]),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (full, resource.RLIM_INFINITY)),
    )
    assert done.returncode != 0
    assert "is the disk full?" in done.stdout
    assert not (folder / BEAMS).exists()
    assert drafts(folder) == []
    assert_resumed(folder, undisturbed, [BEAMS], tiny)


def truncated(path):
    """All but the last byte."""
    path.write_bytes(path.read_bytes()[:-1])


def empty(path):
    """Nothing."""
    path.write_bytes(b"")


def foreign(path):
    """A dataset of something else."""
    xr.Dataset({"force": ("x", [1.0, 2.0])}).to_netcdf(path)


def of_another_stage(path):
    """A result, but not this one."""
    shutil.copy2(path.parents[1] / "heights" / "B2.nc", path)
    path.touch()


@pytest.mark.parametrize("spoil", [truncated, pytest.param(foreign, marks=pytest.mark.slow),
                                   pytest.param(empty, marks=pytest.mark.slow),
                                   pytest.param(of_another_stage, marks=pytest.mark.slow)])  # fmt: skip
def test_a_file_that_is_no_result_is_named_and_never_used(undisturbed, tiny, tmp_path, spoil):
    folder = copied(undisturbed, tmp_path / "run")
    spoiled = folder / "results" / "chaos" / "b_rh088_NG.nc"
    spoil(spoiled)
    done = snakemake(folder, BEAMS, configs=[tiny], check=False)
    assert done.returncode != 0
    assert "DataError: results/chaos/b_rh088_NG.nc" in done.stdout
    assert "delete it and start again" in done.stdout
    assert not (folder / BEAMS).exists()
    spoiled.unlink()
    assert_resumed(folder, undisturbed, [BEAMS], tiny)


def test_two_runs_in_one_folder_do_not_meet(undisturbed, tiny, tmp_path):
    folder = copied(undisturbed, tmp_path / "run", ["beams"])
    with (folder / ".snakemake" / "running").open("w") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        done = snakemake(folder, BEAMS, configs=[tiny], check=False)
    assert done.returncode != 0
    assert "Another run works in this folder" in done.stdout
    assert not (folder / BEAMS).exists()
