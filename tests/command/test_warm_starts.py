"""A command repeated on the same files imports no library for numbers, labels or figures."""

import subprocess
import sys

import pytest
import yaml

HEAVY = {"matplotlib", "numba", "pandas", "scipy", "xarray"}
#: Runs a command, then prints the imported libraries on the last line.
SCRIPT = """
import sys
from stiction.command.main import main
status = main(sys.argv[1:])
print()
print(status, *sorted({name.split(".")[0] for name in sys.modules}))
"""
#: Imports Snakemake's plugins for executors as it does; with SLURM's come libraries for its reports.
PLUGINS = """
import sys
from snakemake_interface_executor_plugins.registry import ExecutorPluginRegistry
ExecutorPluginRegistry()
print(*{name.split(".")[0] for name in sys.modules})
"""
SMALL = {
    "run": {"pairs": ["b"], "studies": []},
    "pairs": {"b": {"humidities": [0.67]}},
    "contact": {"samples": 40},
    "studies": {"slopes": {"samples": 20}, "variants": {"samples": 20}, "full_contact": {"samples": 8}},
    "chaos": {"order": 2},
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Folder with a small study of one pair."""
    made = tmp_path_factory.mktemp("starts")
    (made / "mine.yaml").write_text(yaml.safe_dump(SMALL))
    return made


def imported(folder, *words):
    """Lines that a command prints, and the libraries that its process imports."""
    command = [sys.executable, "-c", SCRIPT, *words, "--directory", str(folder)]
    *printed, last = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    status, *libraries = last.split()
    assert status == "0", printed
    return printed, set(libraries)


@pytest.mark.parametrize(
    ("command", "options"),
    [("check", ()), pytest.param("explain", ("--cores", "1"), marks=pytest.mark.slow)],
)
def test_a_repeated_command_imports_no_library_for_numbers(folder, command, options):
    (first, before), (again, now) = (imported(folder, command, str(folder / "mine.yaml"), *options) for _ in range(2))
    assert again[0] == first[0]
    assert before >= HEAVY, "control: the first command needs them"
    assert "numpy" in now
    of_plugins = subprocess.run([sys.executable, "-c", PLUGINS], check=True, capture_output=True, text=True).stdout
    assert not now & (HEAVY - set(of_plugins.split()))


def test_a_changed_file_is_checked_again(folder):
    rougher = SMALL | {"surfaces": {"B2": {"rms_nm": 6}}}
    (folder / "rougher.yaml").write_text(yaml.safe_dump(rougher))
    assert imported(folder, "check", str(folder / "rougher.yaml"))[1] >= HEAVY
