"""An interrupted run loses only the jobs in progress, whenever and however it is interrupted."""

import contextlib
import fcntl
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import time
from itertools import cycle

import netCDF4
import pytest
import xarray as xr
from conftest import BEAMS, command, copied, datasets, snakemake

#: Targets that require every stage; without the verdict, because checks may fail with so few samples.
ALL = ["tables", "figures", "results/checks.csv"]
#: Stages by the names of their logs; the last has many jobs, so that the run can be interrupted before it finishes.
STAGES = ["heights", "identification", "spectrum", "character", "iteration", "contact", "forces", "fit", "chaos"]
STAGES += ["humidity", "beams", "studies", "tables", "checks", "figures"]

#: A stage for every way of writing: a dataset, parts of one, several of one job, texts, pictures.
WRITERS = ["heights", "contact", "studies", "tables", "figures"]


@pytest.fixture(scope="session")
def everything(shared, tiny):
    """Folder of a finished run of all stages of one tiny case."""
    return shared("everything", lambda folder: snakemake(folder, *ALL, configs=[tiny]))


def files_of(stage, folder):
    """Files of a stage in a folder of results or of logs."""
    return [
        path for path in folder.rglob("*.*") if path.is_file() and path.relative_to(folder).parts[0].startswith(stage)
    ]


def logs_of(stage, folder):
    """Modification times of the logs of a stage, by path."""
    times = {}
    for path in files_of(stage, folder / "results" / "logs"):
        with contextlib.suppress(FileNotFoundError):  # Snakemake removes the log before its job starts
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
    assert status != 0, f"the run finished before its interruption in {stage}:\n{(folder / 'printed.txt').read_text()}"


def drafts(folder):
    """Partly written temporary files."""
    return [path for path in (folder / "results").rglob(".*") if path.is_file()]


def assert_only_whole_files(folder, reference):
    """Every file with the name of a result has the content of the result."""
    whole = datasets(reference)
    for name, content in datasets(folder).items():
        # Chunks are temporary and missing from the reference run.
        assert content == whole.get(name, content), f"{name} is half-written"
        if name.endswith(".nc"):
            xr.load_dataset(folder / "results" / name).close()


def assert_resumed(folder, reference, targets, tiny):
    """Started again without further options, the run gives the files of the undisturbed run and no others."""
    done = snakemake(folder, *targets, configs=[tiny])
    assert "unlock" not in done.stdout
    assert datasets(folder) == datasets(reference)
    assert drafts(folder) == []


@pytest.mark.slow
def test_a_run_killed_in_its_longest_stage_resumes_without_unlocking(undisturbed, tiny, tmp_path):
    end_in_stage("contact", signal.SIGKILL, tmp_path, [BEAMS], tiny, after=0.1)
    assert_only_whole_files(tmp_path, undisturbed)
    end_in_stage("beams", signal.SIGTERM, tmp_path, [BEAMS], tiny, after=0.0)
    assert_resumed(tmp_path, undisturbed, [BEAMS], tiny)


@pytest.mark.nightly
def test_a_run_interrupted_in_every_stage_gives_the_same_bytes(everything, tiny, tmp_path):
    moments, signals = cycle((0.0, 0.7, 1.4)), cycle((signal.SIGKILL, signal.SIGTERM))
    for stage in STAGES:
        # Results of earlier jobs, also of later stages: without them, the run does not end before its signal.
        for path in (path for later in STAGES[STAGES.index(stage) :] for path in files_of(later, tmp_path / "results")):
            path.unlink()
        end_in_stage(stage, next(signals), tmp_path, ALL, tiny, next(moments) if stage != "checks" else 0.0)
        assert_only_whole_files(tmp_path, everything)
    assert_resumed(tmp_path, everything, ALL, tiny)


@pytest.mark.nightly
def test_a_full_disk_is_reported_whatever_is_written_and_leaves_no_partly_written_file(everything, tiny, tmp_path):
    on_small_disk = ["unshare", "--map-root-user", "--mount", "sh", "-c"]
    on_small_disk += [
        'mount -t tmpfs -o size=4k none "$0" && { "$@"; ended=$?; find "$0" -type f -name "*.*"; exit $ended; }'
    ]
    if subprocess.run([*on_small_disk, tmp_path, "true"]).returncode:
        pytest.skip("mounting a small disk is not permitted on this machine")
    for stage in WRITERS:
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


@pytest.mark.slow
def test_a_full_disk_is_reported_and_leaves_no_partly_written_file(undisturbed, tiny, tmp_path):
    folder = copied(undisturbed, tmp_path / "run", ["beams"])
    (folder / "results" / "provenance.json").unlink()
    full = 17_000  # bytes; datasets are longer, all other files are shorter
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
    """Remove the last byte of a file."""
    path.write_bytes(path.read_bytes()[:-1])


def empty(path):
    """Make a file empty."""
    path.write_bytes(b"")


def foreign(path):
    """Replace a file by an unrelated dataset."""
    xr.Dataset({"force": ("x", [1.0, 2.0])}).to_netcdf(path)


def of_another_stage(path):
    """Replace a file by a result of another stage."""
    shutil.copy2(path.parents[1] / "heights" / "B2.nc", path)
    path.touch()


def of_another_order(path):
    """Replace a file by a result of the same case with other settings."""
    shutil.copy2(path, kept := path.with_suffix(".old"))
    with netCDF4.Dataset(path, "r+") as file:
        file.setncattr("settings", file.getncattr("settings").replace('"order": 2', '"order": 3'))
    assert path.read_bytes() != kept.read_bytes()
    kept.unlink()


def flipped(path):
    """Flip one bit of the numbers of a dataset and give the file its old time."""
    before, content = path.stat(), bytearray(path.read_bytes())
    with xr.open_dataset(path) as dataset:
        numbers = max((values.values for values in dataset.values()), key=lambda values: values.nbytes)
    content[content.index(numbers.tobytes()[:64]) + 8] ^= 1
    path.write_bytes(content)
    os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))


SPOILS = {
    flipped: "is not as its job wrote it",
    truncated: "cannot be read",
    empty: "cannot be read",
    foreign: "holds no result of this study",
    of_another_stage: "holds heights of B2",
    of_another_order: "was computed with chaos.order: 3 instead of 2",
}


@pytest.mark.parametrize(
    "spoil",
    [
        pytest.param(spoil, marks=pytest.mark.nightly if spoil in (empty, of_another_stage) else pytest.mark.slow)
        for spoil in SPOILS
    ],
)
def test_a_dataset_that_is_damaged_or_of_other_settings_is_computed_again(undisturbed, tiny, tmp_path, spoil):
    folder = copied(undisturbed, tmp_path / "run")
    shutil.rmtree(folder / ".snakemake" / "metadata")  # as in results copied from another folder
    spoil(folder / "results" / "chaos" / "b_rh088_NG.nc")
    done = snakemake(folder, BEAMS, configs=[tiny])
    assert f"results/chaos/b_rh088_NG.nc {SPOILS[spoil]}; this run does not use it." in done.stdout
    assert "rule contact" not in done.stdout
    assert datasets(folder) == datasets(undisturbed)


@pytest.mark.nightly
def test_a_dataset_that_is_damaged_a_second_time_is_computed_a_second_time(undisturbed, tiny, tmp_path):
    folder = copied(undisturbed, tmp_path / "run")
    for _ in range(2):
        flipped(folder / "results" / "chaos" / "b_rh088_NG.nc")
        snakemake(folder, BEAMS, configs=[tiny])
        assert datasets(folder) == datasets(undisturbed)


@pytest.mark.slow
def test_datasets_of_another_seed_are_not_used_because_snakemake_touched_them(undisturbed, tiny, tmp_path, overlay):
    folder, configs = copied(undisturbed, tmp_path / "run"), [tiny, overlay("seed: 2\n")]

    def planned():
        printed = snakemake(folder, BEAMS, "-n", configs=configs).stdout
        return re.findall(r"^total +(\d+)$", printed, re.MULTILINE), printed.count("this run does not use it")

    before = planned()
    assert before[1] > 0
    snakemake(folder, BEAMS, "--touch", "--no-hooks", configs=configs)  # with its hooks, the workflow refuses
    assert planned() == before


@pytest.mark.slow
def test_a_file_that_is_damaged_during_a_run_is_reported_and_never_used(undisturbed, tiny, tmp_path):
    folder = copied(undisturbed, tmp_path / "run", ["beams"])
    truncated(folder / "results" / "chaos" / "b_rh088_NG.nc")
    # Only the last rule may run, as if the file had been whole when the run was planned.
    done = snakemake(folder, BEAMS, "--allowed-rules", "beams", configs=[tiny], check=False)
    assert done.returncode != 0
    assert "DataError: results/chaos/b_rh088_NG.nc" in done.stdout
    assert "delete it and start again" in done.stdout
    assert not (folder / BEAMS).exists()


#: One damaged result of each kind.
DAMAGED = ["tables/fit_quality.csv", "tables/variants.md", "tables/resampling.html"]
DAMAGED += ["figures/figure_14.pdf", "figures/figure_07.png"]


@pytest.mark.slow
def test_a_table_or_figure_that_was_cut_off_is_made_again_and_nothing_else(smoke, tmp_path):
    folder = copied(smoke, tmp_path / "run")
    for name in DAMAGED:
        truncated(folder / "results" / name)
    done = snakemake(folder, *(f"results/{name}" for name in DAMAGED))
    for name in ("figures/figure_07.png", "tables/fit_quality.csv"):  # the first of each folder
        assert f"results/{name} is not as its job wrote it" in done.stdout
    for name in DAMAGED:
        assert (folder / "results" / name).read_bytes() == (smoke / "results" / name).read_bytes()
    assert "5 of 5 steps (100%) done" in done.stdout


@pytest.mark.slow
def test_every_dataset_of_other_settings_is_recognised(smoke, tmp_path):
    folder = copied(smoke, tmp_path / "run")
    numbers = {}
    for path in (folder / "results").rglob("*.nc"):
        with netCDF4.Dataset(path, "r+") as file:
            file.setncattr("settings", json.dumps(json.loads(file.getncattr("settings")) | {"other": 1}))
        numbers[path.parent] = numbers.get(path.parent, 0) + 1
    printed = snakemake(folder, "-n").stdout
    named = re.findall(
        r"(\S+)/\S+\.nc was computed with other: 1 instead of nothing; .*?(?:nor (\d+) more.*)?\n", printed
    )
    assert {folder / of: 1 + int(more or 0) for of, more in named} == numbers


@pytest.mark.slow
def test_a_second_run_in_the_same_folder_is_rejected(undisturbed, tiny, tmp_path):
    folder = copied(undisturbed, tmp_path / "run", ["beams"])
    with (folder / ".snakemake" / "running").open("w") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        done = snakemake(folder, BEAMS, configs=[tiny], check=False)
    assert done.returncode != 0
    assert "Another run is using this folder" in done.stdout
    assert not (folder / BEAMS).exists()
