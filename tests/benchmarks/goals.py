"""CPU of what a user waits for, beside goals and an earlier version: ``python tests/benchmarks/goals.py [NAME...]``.

CPU is user and system time of a command with all its processes, on one core at a time, so that other work on a machine
counts little. The loop before each command tells how fast the machine is: the time of a command over that of the loop
compares machines. Prints rows of docs/tables/goals.md. ``--source FOLDER`` measures another checkout.
"""

import argparse
import contextlib
import ctypes
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import yaml

import stiction
from stiction.accuracy import decided

ROOT = Path(__file__).parents[2]
#: A cantilever of the paper, and a target of a run that states its safe length.
BEAM = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30}
ONE, LENGTHS = (
    {"run": {"pairs": []}, "devices": {"C1": BEAM | {"humidities": [0.67]}}},
    "results/tables/safe_lengths.md",
)
#: Side of a scan of 512² points [µm].
SIDE = 10.24
#: Few samples and beams, for a first answer.
FEW = {"contact": {"samples": 500}, "chaos": {"order": 6}, "design": {"beams": 300}}
MORE = {"run": {"pairs": []}, "devices": {"C1": BEAM | {"humidities": [0.67, 0.8]}}}


def of_many(number, humidities=(0.44, 0.6, 0.75, 0.9)):
    """Study of cantilevers of as many thicknesses, by default at four humidities each."""
    beams = {
        f"D{k}": BEAM | {"thickness_um": round(2 + 0.001 * k, 3), "humidities": [*humidities]} for k in range(number)
    }
    return {"run": {"pairs": []}, "devices": beams}


def of_pairs(number):
    """Study of cantilevers at one humidity, each on a pair of its own, of which only the rms is known."""
    return _of_surfaces([{"like": "B2", "rms_nm": round(2.4 + 0.6 * k / number, 4)} for k in range(number)])


def of_scans(number):
    """Study of cantilevers at one humidity, each on a surface of which there is one scan."""
    given = {"size_um": [SIDE, SIDE], "height_unit": "nm"}
    return _of_surfaces([{"scans": {"files": [f"scan_{k}.npy"]} | given} for k in range(number)])


def _of_surfaces(entries):
    """Study of a cantilever on each surface of a configuration."""
    surfaces = {f"M{k}": entry for k, entry in enumerate(entries)}
    pair = {"substrate": "Sub1", "gap_um": 20, "humidities": [0.67]}
    pairs = {f"p{k}": pair | {"beam": name} for k, name in enumerate(surfaces)}
    beams = {f"D{k}": BEAM | {"pair": name, "length_um": 250, "humidities": [0.67]} for k, name in enumerate(pairs)}
    return {"run": {"pairs": [*pairs], "studies": []}, "surfaces": surfaces, "pairs": pairs, "devices": beams}


def write_scans(study, folder):
    """Draw the scans that a study reads, on the surface B2 of the paper."""
    surface = stiction.PairStudy.of(
        stiction.load({"contact": {"samples": 5}, "chaos": {"order": 1}}), "b"
    ).surfaces.beam
    square = replace(surface, grid=stiction.StripGrid(SIDE * 1e-6, SIDE * 1e-6, surface.grid.spacing, 1e-6))
    for number, entry in enumerate(study.get("surfaces", {}).values()):
        for name in entry.get("scans", {}).get("files", ()):
            np.save(folder / name, 1e9 * square.draw(stiction.stream(1, "goals", number))[::2, ::2])


#: What is measured: configurations one after the other in one folder, of which the last counts, and arguments.
RUNS = {
    "first safe length": ([ONE], [LENGTHS]),
    "first safe length, 500 samples, 300 beams": ([ONE | FEW], [LENGTHS]),
    "one more humidity": ([ONE, MORE], [LENGTHS]),
    "plan of 250 devices at 4 humidities": ([of_many(250)], ["-n"]),
    "plan of 2500 devices at 4 humidities": ([of_many(2500)], ["-n"]),
    "plan of 5000 devices at one humidity": ([of_many(5000, [0.67])], ["-n"]),
    "2 pairs with their budgets": ([of_pairs(2)], []),
    "2 pairs of scans with their budgets": ([of_scans(2)], []),
    "plan of 100 pairs": ([of_pairs(100)], ["-n"]),
    "plan of 100 scans": ([of_scans(100)], ["-n"]),
    "make devices": (["examples/devices.yaml"], []),
}
#: Linux: orphans become children of this process, which counts their time.
_SUBREAPER = 36
#: Measured by `of_step`.
STEP = "plan of a job on a cluster, 2500 devices"


def loop():
    """CPU of a loop in Python, best of three [s]."""

    def once():
        """CPU of one loop [s]."""
        start = time.process_time()
        sum(k * k for k in range(3_000_000))
        return time.process_time() - start

    return min(once() for _ in range(3))


def cpu_of(words, source, folder):
    """CPU of a Python command and all its processes [s], and the memory of the largest process so far [MB]."""
    environment = os.environ | {"PYTHONPATH": str(source / "src"), "OMP_NUM_THREADS": "1"}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [sys.executable, *map(str, words)]
    subprocess.run(
        command, env=environment, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True
    )
    with contextlib.suppress(ChildProcessError):
        while True:  # servers of jobs that outlive the command
            os.waitpid(-1, 0)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, after.ru_maxrss / 1024


def measured(name, source):
    """CPU, loops and memory of the last run of an entry of `RUNS`."""
    configurations, arguments = RUNS[name]
    with tempfile.TemporaryDirectory() as folder:
        for number, one in enumerate(configurations):
            path = source / one if isinstance(one, str) else Path(folder) / f"{number}.yaml"
            if not isinstance(one, str):
                path.write_text(yaml.safe_dump(one), encoding="utf-8")
                write_scans(one, path.parent)
            unit = loop()
            words = ["devices", path, "--directory", Path(folder) / "run", "--", *arguments, "--cores", "1"]
            seconds, megabytes = cpu_of(["-m", "stiction.command.main", *words], source, folder)
    return seconds, seconds / unit, megabytes


def of_step(source, number=2500):
    """As `measured`, of the plan that each job of a study of many devices makes on a cluster, after that of its run."""
    with tempfile.TemporaryDirectory() as folder:
        study = Path(folder) / "many.yaml"
        study.write_text(yaml.safe_dump(of_many(number)), encoding="utf-8")
        whole = ["-m", "stiction.command.main", "devices", study, "--directory", folder, "--", "-n", "--cores", "1"]
        cpu_of(whole, source, folder)
        handed = Path(folder) / "configuration.json"
        handed.write_text(json.dumps({"planned": [decided(stiction.load(of_many(number))), {}]}), encoding="utf-8")
        words = ["-m", "snakemake", "results/devices/cracks/D0_rh044.nc", "--snakefile", source / "Snakefile"]
        words += ["--directory", folder, "--configfile", handed, "--mode", "remote", "--cores", "1", "--nolock", "-n"]
        unit = loop()
        seconds, megabytes = cpu_of(words, source, folder)
    return seconds, seconds / unit, megabytes


def main():
    """Print the rows."""
    ctypes.CDLL(None).prctl(_SUBREAPER, 1)
    options = argparse.ArgumentParser()
    options.add_argument("names", nargs="*", default=[*RUNS, STEP])
    options.add_argument("--source", type=Path, default=ROOT)
    given = options.parse_args()
    for name in given.names:
        source = given.source.resolve()
        seconds, loops, megabytes = of_step(source) if name == STEP else measured(name, source)
        print(f"| {name} | {seconds:.1f} | {loops:.0f} | {megabytes:.0f} |", flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
