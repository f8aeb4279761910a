"""A record of every run: when, where, with which code, libraries and configuration."""

import datetime
import json
import os
import platform
import subprocess
from importlib import metadata
from pathlib import Path

#: Libraries that a result may depend on.
LIBRARIES = ("numpy", "scipy", "numba", "llvmlite", "xarray", "netCDF4", "pandas", "matplotlib", "snakemake")


def record(path, checkout, config):
    """Append a run that starts now to the record of runs, which it reads and replaces whole.

    Parameters
    ----------
    path : path
        JSON file, a list of runs, oldest first.
    checkout : path
        Folder of the code.
    config : dict
        Complete configuration of the run.

    Raises
    ------
    ValueError
        If the file is there and holds no list of runs.
    """
    path = Path(path)
    runs = _recorded(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    draft = path.with_name(f".{path.name}")
    draft.write_text(json.dumps([*runs, _run(checkout, config)], indent=1, sort_keys=True) + "\n", encoding="utf-8")
    draft.replace(path)


def _recorded(path):
    """Runs in a record, none if there is no record."""
    if not path.exists():
        return []
    try:
        runs = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as reason:
        raise ValueError(f"{path} cannot be read ({reason}); delete it") from reason
    if not isinstance(runs, list):
        raise ValueError(f"{path} holds no list of runs; delete it")
    return runs


def _run(checkout, config):
    """When, where and with what a run starts."""
    return {
        "started": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "versions": {"python": platform.python_version()} | {name: metadata.version(name) for name in LIBRARIES},
        "git": git_state(checkout),
        "machine": {"host": platform.node(), "system": platform.platform(), "cpu": _cpu(), "cores": os.cpu_count()},
        "config": config,
    }


def git_state(checkout):
    """Commit of a checkout and whether its files differ from it; ``None`` where there is no git or no commit."""
    try:
        commit, changes = (
            subprocess.run(["git", "-C", checkout, *command], capture_output=True, text=True, check=True).stdout
            for command in (["rev-parse", "HEAD"], ["status", "--porcelain"])
        )
    except (OSError, subprocess.CalledProcessError):
        return None
    return {"commit": commit.strip(), "changed": bool(changes.strip())}


def _cpu():
    """Name of the processor as far as the system tells."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor()
    names = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(names, platform.processor())
