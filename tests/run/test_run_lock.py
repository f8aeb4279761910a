"""The lock on the folder of a run."""

import fcntl
import subprocess
import sys

import pytest

from stiction.run import run_lock


def test_only_one_run_uses_a_folder_until_it_ends(tmp_path):
    lock = tmp_path / "running"
    held = run_lock.reserve(lock)
    with pytest.raises(RuntimeError, match="Another run is using this folder"):
        run_lock.reserve(lock)
    held.close()
    run_lock.reserve(lock).close()


def test_other_folders_stay_free(tmp_path):
    with run_lock.reserve(tmp_path / "one"), run_lock.reserve(tmp_path / "other"):
        pass


def test_the_lock_of_a_killed_run_is_released(tmp_path):
    hold = "import sys, time; from stiction.run import run_lock; f = run_lock.reserve('running'); print(1, flush=True)"
    with subprocess.Popen(
        [sys.executable, "-c", f"{hold}; time.sleep(60)"], cwd=tmp_path, stdout=subprocess.PIPE
    ) as run:
        run.stdout.readline()
        with pytest.raises(RuntimeError, match="Another run"):
            run_lock.reserve(tmp_path / "running")
        run.kill()
    run_lock.reserve(tmp_path / "running").close()


def test_a_disk_without_locks_is_reported_with_the_remedy(tmp_path, monkeypatch):
    def flock(*_):
        raise OSError(95, "Operation not supported")

    monkeypatch.setattr(fcntl, "flock", flock)
    with pytest.raises(RuntimeError, match=r"cannot be locked \(.*not supported\)\. Choose a --directory"):
        run_lock.reserve(tmp_path / "running")


def test_a_folder_that_cannot_be_written_is_refused_in_one_sentence(tmp_path):
    run_lock.require_writable(tmp_path / ".snakemake")
    assert list((tmp_path / ".snakemake").iterdir()) == []
    (tmp_path / "file").touch()  # in place of a folder: root ignores permissions
    with pytest.raises(RuntimeError) as refused:
        run_lock.require_writable(tmp_path / "file" / ".snakemake")
    assert str(refused.value).startswith(f"{tmp_path / 'file'} cannot be written (Not a directory), which Snakemake")


def test_a_read_only_disk_is_refused(tmp_path):
    check = "from stiction.run import run_lock; run_lock.require_writable('.snakemake')"
    read_only = 'mount --bind "$0" "$0" && mount -o remount,ro,bind "$0" && cd "$0" && exec "$@"'
    words = ["unshare", "--map-root-user", "--mount", "sh", "-c", read_only, tmp_path]
    if subprocess.run([*words, "true"], capture_output=True).returncode:
        pytest.skip("mounting is not permitted on this machine")
    done = subprocess.run([*words, sys.executable, "-c", check], capture_output=True, text=True)
    (line,) = done.stderr.splitlines()[-1:]
    assert line.startswith(f"RuntimeError: {tmp_path} cannot be written (Read-only file system), which Snakemake")
    assert line.endswith("choose another --directory.")
