"""Planned jobs of many runs: a process that has imported Snakemake and the configuration forks for every query."""

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

#: Samples that decide numbers of beams and samples, few because a plan needs no good ones.
PILOT = 40
SERVER = """
import gc, json, os, sys
from pathlib import Path
import jsonschema, netCDF4, numba, scipy.integrate, scipy.interpolate, scipy.optimize, scipy.stats, smart_open, xarray
import snakemake.cli
import stiction.accuracy, stiction.config.validation, stiction.run.snakemake_patches, stiction.run.stale_results
from snakemake.executors.touch import Executor
from stiction.config.files import load
from stiction.plan.graph import stages
from stiction.run.disk_cache import DiskCache
from stiction.run.fingerprint import fingerprint

class Keeping(DiskCache):
    def save(self):
        if self._path.name in ("pilot.json", "accuracy.json"):  # of samples, for a plan that returns to them
            self._used = self._known | self._used
        super().save()

stiction.run.disk_cache.DiskCache = Keeping
stiction.accuracy.PILOT = int(sys.argv[1])
gc.disable()  # a plan is short, and its process ends with it
load()  # what relations compute of the paper's numbers is kept
Executor.SLEEPING_TIME = 0  # [s] for each job that is only touched; files touched in one tick count as up to date
snakemake.cli.get_argument_parser()  # imports all plugins
stages()
for module in Path("src", "stiction").resolve().rglob("*.py"):  # kept for files that do not change
    fingerprint(module)

for line in sys.stdin:
    folder, arguments, path = json.loads(line)
    if (child := os.fork()) == 0:
        os.chdir(folder)
        for number, file in enumerate((os.devnull, path, path)):
            os.dup2(os.open(file, os.O_RDWR | os.O_CREAT | os.O_APPEND), number)
        snakemake.cli.main(arguments)
        sys.exit("Snakemake went on")
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
"""


class Planner:
    """Snakemake in one folder, called by its command line.

    Parameters
    ----------
    folder : path
        Working directory, in which the Snakefile is found.
    scratch : path
        Folder for the printed output.
    """

    def __init__(self, folder, scratch):
        self.folder, self.printed = folder, Path(scratch) / "printed.txt"
        environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTEST")}
        environment["PYTHONPATH"] = str(Path(folder) / "src")
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        self.server = subprocess.Popen([sys.executable, "-c", SERVER, str(PILOT)], **pipes, cwd=folder, env=environment)

    def __call__(self, *arguments, config=(), folder=None):
        """Exit status and printed output."""
        self.printed.unlink(missing_ok=True)
        command = [*map(str, arguments), "--configfile", "config.yaml", *map(str, config)]
        self.server.stdin.write(json.dumps([str(folder or self.folder), command, str(self.printed)]) + "\n")
        self.server.stdin.flush()
        return int(self.server.stdout.readline()), self.printed.read_text()

    def outputs(self, *arguments, config=()):
        """Rule of every planned file, and whether a run would update the file."""
        status, printed = self("--summary", *arguments, config=config)
        assert status == 0, printed
        table = csv.DictReader(printed[printed.index("output_file\t") :].splitlines(), delimiter="\t")
        return {row["output_file"]: (row["rule"], row["plan"] == "update pending") for row in table}

    def close(self):
        """End the server."""
        self.server.stdin.close()
        self.server.wait()
        self.server.stdout.close()
