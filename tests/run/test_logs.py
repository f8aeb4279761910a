"""Logs of jobs."""

import resource
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from stiction.progress import progress
from stiction.run.logs import logged, peak_memory, recorded_checksums


def test_a_successful_job_logs_progress_warnings_time_and_memory(tmp_path):
    with logged(tmp_path / "logs" / "job.log"):
        sys.stderr.write("Warning: rather small\n")
        assert sum(progress(range(3), "steps")) == 3
    log = (tmp_path / "logs" / "job.log").read_text()
    assert "rather small" in log
    assert "steps: 100%" in log
    seconds, _, megabytes, _ = log.splitlines()[-1].removeprefix("took ").split()
    assert float(seconds) >= 0
    assert int(megabytes) > 20  # an interpreter with its libraries


def test_a_log_records_the_checksums_of_the_final_results_of_its_job(tmp_path):
    result = tmp_path / "table 1.csv"
    with logged(tmp_path / "logs" / "tables" / "table_1.log", [str(result)]):
        result.write_bytes(b"abc")
    # SHA-256 of "abc", FIPS 180-2, App. B.1.
    known = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    assert recorded_checksums(tmp_path / "logs") == {str(result): known}


def test_the_logged_memory_is_the_peak(tmp_path):
    def peak(megabytes):
        job = f"from stiction.run.logs import logged\nwith logged('job.log'):\n    b'x' * ({megabytes} * 2**20)"
        subprocess.run([sys.executable, "-c", job], cwd=tmp_path, check=True)
        return int((tmp_path / "job.log").read_text().split()[-2])

    assert peak(128) - peak(0) == pytest.approx(128, abs=5)


@pytest.mark.parametrize(("platform", "unit"), [("darwin", 1), ("linux", 1024)])
def test_the_peak_that_the_system_counts_is_in_megabytes_on_every_platform(monkeypatch, platform, unit):
    monkeypatch.setattr(Path, "exists", lambda _: False)
    monkeypatch.setattr(sys, "platform", platform)
    monkeypatch.setattr(resource, "getrusage", lambda _: SimpleNamespace(ru_maxrss=300 * 2**20 // unit))
    assert peak_memory() == 300


def test_a_failed_job_logs_its_traceback_and_prints_one_line(tmp_path):
    error = ValueError("negative rms")
    error.add_note("It was -1 nm.")
    with pytest.raises(SystemExit, match=r"^ValueError: negative rms It was -1 nm\.$"), logged(tmp_path / "job.log"):
        raise error
    log = (tmp_path / "job.log").read_text()
    assert "Traceback" in log
    assert "took" not in log


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
def test_on_a_full_disk_the_error_is_still_printed():
    with pytest.raises(SystemExit, match="^ValueError: negative rms$"), logged("/dev/full"):
        raise ValueError("negative rms")
    with logged("/dev/full"):
        sys.stdout.write("done\n")
