"""Streams that are full, closed or without a reader are told in one sentence by every command."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from test_front_page import finished

from stiction.command import launch
from stiction.command.last_lines import FAULT
from stiction.command.main import main

#: Commands that print something, and their exit status in a folder with a file of devices on scans and results.
COMMANDS = {
    "--version": 0,
    "--help": 0,
    "run --help": 0,
    "init -d new": 0,
    "init --test-beams -d new": 0,
    "check mine.yaml": 0,
    "run mine.yaml -n": 0,
    "paper -n": 0,
    "devices -n": 0,
    "figures -n": 0,
    "explain": 0,
    "report": 0,
    "check nowhere.yaml": 2,
    "scans mine.yaml": 2,
    "report -d new": 2,
}
each_command = pytest.mark.parametrize("words", COMMANDS)


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Folder with a configuration and results of a run; Snakemake does not run."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(launch, "snakemake", lambda *_, **__: (0, False))
    monkeypatch.setattr("stiction.pilot.problems", lambda *_: [])
    Path("mine.yaml").write_text("run: {pairs: [b]}\n")
    finished(tmp_path / "results")
    return tmp_path


def status(words):
    """Exit status of a command."""
    try:
        return int(main(words.split()))
    except SystemExit as end:
        return end.code


def full():
    return Path("/dev/full").open("w")  # noqa: SIM115


def without_a_reader():
    read, write = os.pipe()
    os.close(read)
    return os.fdopen(write, "w")


@pytest.fixture
def broken(monkeypatch):
    """Puts a stream in place of a standard one; closing it shows that it holds nothing that would fail once more."""
    put = []

    def broken(name, stream):
        put.append(stream)
        monkeypatch.setattr(sys, name, stream)

    yield broken
    for stream in put:
        stream.close()


@each_command
def test_a_full_disk_is_said_in_one_sentence(broken, capsys, words):
    broken("stdout", full())
    expected = COMMANDS[words]
    assert status(words) == (expected or 1)
    said = capsys.readouterr().err
    assert FAULT not in said
    if not expected:
        assert said == "standard output cannot be written: No space left on device\n"


@each_command
@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_a_reader_that_has_seen_enough_changes_nothing(broken, capsys, words, stream):
    broken(stream, without_a_reader())
    assert status(words) == COMMANDS[words]
    said = capsys.readouterr()
    if stream == "stdout":
        assert bool(said.err) == bool(COMMANDS[words])
    assert FAULT not in said.err


@each_command
def test_errors_need_no_stream(broken, words):
    broken("stderr", full())
    assert status(words) == COMMANDS[words]


CLOSED = {"<&-": 0, ">&-": 1, "2>&-": 2, "<&- >&- 2>&-": None}


@pytest.mark.slow
@pytest.mark.parametrize("closed", CLOSED)
@pytest.mark.parametrize("words", ["--version", "check mine.yaml", "run mine.yaml -n", "check nowhere.yaml"])
def test_closed_streams_change_no_status(words, closed):
    command = f"{sys.executable} -m stiction.command.main {words} {closed}"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True)
    assert done.returncode == COMMANDS[words]
    assert "Traceback" not in done.stdout + done.stderr
    assert (
        not Path(".snakemake", "printed.log").exists() or "Traceback" not in Path(".snakemake/printed.log").read_text()
    )
