"""Logs of jobs."""

import re
import resource
import subprocess
import sys
import threading
import time
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
    took = re.fullmatch(r"took ([\d.]+) s of CPU time, ([\d.]+) s in all, (\d+) MB", log.splitlines()[-1])
    assert float(took[1]) >= 0 <= float(took[2])
    assert int(took[3]) > 20  # an interpreter with its libraries


def test_cpu_time_is_that_of_work_in_this_process_its_threads_and_its_children_and_not_that_of_waiting(tmp_path):
    def spent(work):
        with logged(tmp_path / "job.log"):
            work()
        return tuple(map(float, re.findall(r"([\d.]+) s", (tmp_path / "job.log").read_text().splitlines()[-1])))

    def busy(seconds=0.4):
        start = time.thread_time()
        while time.thread_time() - start < seconds:
            pass

    def threads():
        for thread in (running := [threading.Thread(target=busy) for _ in range(2)]):
            thread.start()
        for thread in running:
            thread.join()

    def child():
        subprocess.run([sys.executable, "-c", "import time\nwhile time.process_time() < 0.4: pass"], check=True)

    assert spent(busy)[0] == pytest.approx(0.4, abs=0.15)
    assert spent(threads)[0] == pytest.approx(0.8, abs=0.2)
    assert 0.4 <= spent(child)[0] + 0.1 < 0.8
    cpu, clock = spent(lambda: time.sleep(0.5))
    assert cpu < 0.3 < 0.5 <= clock


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
