"""The command ``stiction`` as a user runs it, in a folder of its own: last lines, exit status, files."""

import fcntl
import os
import re
import signal
import subprocess
import sys
import time

import pytest
from conftest import BEAMS, ROOT, SMOKE, copied, datasets


def words(folder, command, *arguments):
    """Arguments of a process that runs the command in a folder."""
    call = [sys.executable, "-m", "stiction.command.main", command, *map(str, arguments)]
    environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTEST")}
    return {"args": call, "cwd": folder, "env": environment, "text": True}


def stiction(folder, command, *arguments):
    """Exit status and printed lines of the command in a folder; no traceback, whatever happens."""
    done = subprocess.run(**words(folder, command, *arguments), stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    assert "Traceback" not in done.stdout
    return done.returncode, done.stdout.splitlines()


def test_a_refusal_of_the_configuration_is_the_last_line_and_leaves_no_results(tmp_path, overlay):
    status, printed = stiction(tmp_path, "run", overlay("chaos: {ordr: 3}\n"))
    assert status == 2
    assert printed == [
        "The configuration is invalid:",
        "chaos.ordr is unknown (value 3), must be one of order, dimension_tolerance; did you mean order?",
    ]
    assert not (tmp_path / "results").exists()


@pytest.mark.slow
def test_an_option_or_a_target_that_snakemake_does_not_know_is_refused_in_the_last_line(tmp_path, tiny):
    status, printed = stiction(tmp_path, "run", tiny, "--", "--nonsense")
    assert status == 2
    assert printed == ["main.py: error: unrecognized arguments: --nonsense"]
    status, printed = stiction(tmp_path, "run", tiny, "--", "results/none.nc")
    assert status == 2
    assert printed[-1].startswith("No rule to produce results/none.nc")


@pytest.mark.slow
def test_an_answer_of_snakemake_is_printed_unchanged(tmp_path, tiny):
    status, printed = stiction(tmp_path, "run", tiny, "--", "--list-target-rules")
    assert status == 0
    assert any(line.split(" ")[0] == "verdict" for line in printed)


@pytest.mark.slow
def test_a_run_in_a_folder_gives_the_files_of_snakemake_and_then_has_nothing_to_do(undisturbed, tiny, tmp_path):
    status, printed = stiction(tmp_path, "run", tiny, "--cores", 2, "--", BEAMS)
    assert status == 0
    assert printed[0].startswith("0 of 10 jobs: ")
    assert printed[-2].startswith("Done: 10 jobs in ")
    assert printed[-1] == (index := "All results: results/index.html; stiction show opens it.")
    assert "Results of pair b" in (tmp_path / "results" / "index.html").read_text(encoding="utf-8")
    assert datasets(tmp_path) == datasets(undisturbed)
    (log,) = (tmp_path / ".snakemake" / "log").glob("*.log")
    assert "Finished jobid" in log.read_text()
    assert stiction(tmp_path, "run", tiny, "--", BEAMS) == (
        0,
        ["Nothing to do: all results are up to date.", index],
    )
    assert stiction(tmp_path, "explain", tiny, "--", BEAMS) == (
        0,
        ["Nothing would be computed: all results are up to date."],
    )


@pytest.mark.slow
@pytest.mark.parametrize("example", [SMOKE, ROOT / "examples" / "life.yaml"])
def test_a_check_and_a_dry_run_of_the_same_file_forecast_the_same_time_and_memory(tmp_path, example):
    _, checked = stiction(tmp_path, "check", example)
    _, planned = stiction(tmp_path, "explain", example)
    forecast = re.compile(r"about ([\d.]+) (\w+) of CPU time and (\d+) MB")
    (said,) = filter(None, map(forecast.search, checked))
    time, *others = forecast.search(planned[0]).groups()
    assert others == [*said.groups()[1:]]
    # A dry run counts the jobs that say the verdict as well, and both have two digits.
    assert float(time) == pytest.approx(float(said[1]), rel=0.05)


@pytest.mark.slow
def test_a_change_is_explained_by_its_key_and_computes_nothing(undisturbed, tiny, tmp_path, overlay):
    folder = copied(undisturbed, tmp_path / "run")
    status, printed = stiction(folder, "explain", tiny, overlay("chaos: {order: 1}\n"), "--", BEAMS)
    assert status == 0
    assert printed[0].startswith("2 jobs would run, about ")
    assert printed[1].startswith(
        "results/beams/b_rh088_NG.nc depends on results/chaos/b_rh088_NG.nc with chaos.order: 2"
    )
    assert "results/chaos/b_rh088_NG.nc was computed with chaos.order: 2 instead of 1" in printed[2]
    assert printed[3:] == ["results that this run does not use: chaos", "follow from the jobs above: beams"]
    assert datasets(folder) == datasets(undisturbed)


@pytest.mark.slow
def test_a_failed_job_ends_with_its_sentence_and_its_log(undisturbed, tiny, tmp_path):
    folder = copied(undisturbed, tmp_path / "run", ["beams"])
    (folder / "results" / "chaos" / "b_rh088_NG.nc").write_bytes(b"damaged")
    status, printed = stiction(folder, "run", tiny, "--", BEAMS, "--allowed-rules", "beams")
    assert status == 1
    assert printed[-3] == "failed: Release the beams of b_rh088, NG (Sec. III-C)."
    assert printed[-2].startswith("DataError: results/chaos/b_rh088_NG.nc cannot be read")
    assert printed[-1] == "log: results/logs/beams/b_rh088_NG.log"
    assert len(printed) < 6


@pytest.mark.slow
def test_verbose_shows_what_snakemake_prints_and_ends_alike(undisturbed, tiny, tmp_path):
    folder = copied(undisturbed, tmp_path / "run", ["beams"])
    status, printed = stiction(folder, "run", tiny, "--verbose", "--", BEAMS)
    assert status == 0
    assert "1 of 1 steps (100%) done" in printed
    assert printed[-2].startswith("Done: 1 jobs in ")


@pytest.mark.slow
def test_a_second_run_in_the_same_folder_is_refused_in_the_last_line(undisturbed, tiny, tmp_path):
    folder = copied(undisturbed, tmp_path / "run", ["beams"])
    with (folder / ".snakemake" / "running").open("w") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        status, printed = stiction(folder, "run", tiny, "--", BEAMS)
    assert status == 2
    assert printed[-1] == "Another run is using this folder. Wait until it has finished, or stop it."
    assert not (folder / BEAMS).exists()


@pytest.mark.slow
def test_a_failed_check_has_a_status_of_its_own_and_all_results_are_named(smoke, tmp_path):
    results = copied(smoke, tmp_path / "run") / "results"
    text = (results / "checks.csv").read_text()
    (results / "checks.csv").write_text(text.replace(",True,", ",False,", 1))
    status, printed = stiction(results.parent, "run", SMOKE, "--", "all", "--allowed-rules", "all", "verdict")
    assert status == 3
    counted = f"1 of {len(text.splitlines()) - 1} checks of the results failed: results/checks.md"
    assert printed[-1] == "All results: results/index.html; stiction show opens it."
    assert counted in printed
    assert "checks of the results failed." in (results / "index.html").read_text()


@pytest.mark.slow
def test_the_end_of_a_whole_run_names_verdict_warnings_and_what_to_open(smoke, tmp_path):
    status, printed = stiction(copied(smoke, tmp_path / "run"), "run", SMOKE)
    assert status == 0
    nothing, verdict, warnings, first, index = printed
    assert nothing == "Nothing to do: all results are up to date."
    assert verdict.startswith("All ")
    assert "in results/warnings.md" in warnings
    assert first == "Open first: results/figures/overview.png and results/tables/table_3.md."
    assert index == "All results: results/index.html; stiction show opens it."


@pytest.mark.parametrize(
    ("stage", "send", "number"),
    [
        pytest.param("contact", os.killpg, signal.SIGINT, marks=pytest.mark.slow),
        pytest.param("heights", os.kill, signal.SIGTERM, marks=pytest.mark.slow),
        pytest.param("heights", os.killpg, signal.SIGINT, marks=pytest.mark.nightly),
        pytest.param("contact", os.killpg, signal.SIGTERM, marks=pytest.mark.nightly),
    ],
)
def test_a_run_that_is_stopped_says_how_to_continue_and_continuing_gives_the_same_bytes(
    undisturbed, tiny, tmp_path, stage, send, number
):
    run = subprocess.Popen(
        **words(tmp_path, "run", tiny, "--", BEAMS),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        start_new_session=True,
    )
    while run.poll() is None and not (tmp_path / "results" / "logs" / stage).exists():
        time.sleep(0.01)
    send(run.pid, number)
    printed, _ = run.communicate(timeout=60)
    assert run.returncode == 130
    last = printed.splitlines()[-1]
    assert last.startswith("stopped after ")
    assert last.endswith(" of 10 jobs; run the same command to continue")
    assert not (tmp_path / BEAMS).exists()
    assert stiction(tmp_path, "run", tiny, "--", BEAMS)[0] == 0
    assert datasets(tmp_path) == datasets(undisturbed)
