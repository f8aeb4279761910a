"""Times of the commands of the README, one after the other in a folder of their own: ``make times``.

Writes a table for ``docs/tables/timings.csv``. It takes half an hour, and its numbers count on a quiet machine only.
"""

import csv
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "src"))

from stiction.run.provenance import cpu_name  # noqa: E402

BIN = Path(sys.executable).parent
CONFIG = ROOT / "config.yaml"
#: Case that is added to a finished run of the paper.
ADDED = "pairs: {b: {humidities: [0.44, 0.5, 0.55, 0.67, 0.80, 0.88, 0.92]}}\n"
#: Workflow of jobs that do nothing, started as those of the project.
EMPTY_JOBS = """
from stiction.run import snakemake_patches

onstart:
    snakemake_patches.limit_timers(workflow)
    snakemake_patches.fork_jobs()

rule all:
    input: expand("{{number}}.txt", number=range({jobs}))

rule nothing:
    output: touch("{{number}}.txt")
    script: "nothing.py"
"""


def run(*words, cwd=ROOT):
    """Seconds by the clock that a command takes."""
    environment = os.environ | {"PYTHONPATH": str(ROOT / "src")}
    start = time.perf_counter()
    subprocess.run(list(map(str, words)), cwd=cwd, env=environment, stdout=subprocess.DEVNULL, check=True)
    return time.perf_counter() - start


def workflow(folder, *words):
    """Seconds of a run of the project's workflow in a folder."""
    return run(BIN / "snakemake", *words, "--directory", folder, "--quiet")


def start_of_a_job(folder, jobs=100):
    """Seconds that a job that does nothing adds to a run on one core, mean of many."""
    (folder / "nothing.py").write_text("")
    spent = []
    for number in (0, jobs):
        (folder / "Snakefile").write_text(EMPTY_JOBS.format(jobs=number))
        spent.append(run(BIN / "snakemake", "--cores", "1", "--quiet", "all", cwd=folder))
    return (spent[1] - spent[0]) / jobs


def tests():
    """Row of ``make test``, with the number of tests and their CPU time."""
    start, before = time.perf_counter(), os.times()
    done = subprocess.run(["make", "test"], cwd=ROOT, check=True, capture_output=True, text=True)
    spent = sum(os.times()[2:4]) - sum(before[2:4])
    number = re.search(r"\d+ passed", done.stdout)[0].split()[0]
    return "tests", time.perf_counter() - start, f"make test: {number} tests, {spent:.0f} s of CPU"


def rows(scratch):
    """Name, seconds and description of every measurement."""
    paper, smoke, empty = (scratch / name for name in ("paper", "smoke", "empty"))
    added = scratch / "added.yaml"
    added.write_text(ADDED)
    yield "paper", workflow(paper, "--configfile", CONFIG), "make paper"
    yield "nothing", workflow(paper, "--configfile", CONFIG), "make paper with nothing to do"
    shutil.rmtree(paper / "results" / "figures")
    yield "figures", workflow(paper, "figures", "--configfile", CONFIG), "make figures with all figures missing"
    taken = workflow(paper, "--configfile", CONFIG, added)
    yield "humidity", taken, "make run with one humidity of pair b added, with its studies, tables and all figures"
    yield "smoke", workflow(smoke, "--configfile", CONFIG, ROOT / "workflow" / "smoke.yaml"), "make smoke"
    for name in ("example", "devices"):
        shutil.rmtree(ROOT / "runs" / name, ignore_errors=True)
        yield name, run("make", name), f"make {name}"
    yield tests()
    empty.mkdir()
    yield "start", start_of_a_job(empty), "start and end of a job that does nothing, on one core, mean of 100"


def main():
    """Print the table."""
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True).stdout
    machine = f"{cpu_name()}, {os.cpu_count()} cores"
    table = csv.writer(sys.stdout, lineterminator="\n")
    table.writerow(["name", "seconds", "what", "commit", "machine"])
    with tempfile.TemporaryDirectory() as scratch:
        for name, seconds, what in rows(Path(scratch)):
            table.writerow([name, f"{seconds:.3g}", what, commit.strip(), machine])
            sys.stdout.flush()


if __name__ == "__main__":
    main()
