"""Rules, input files and settings of jobs for Snakemake, from the declared stages.

Declarations are in the modules of the stages, whose libraries take longer to import than a plan takes. What follows
from them is therefore kept between plans, as long as neither code nor configuration change.
"""

import contextlib
import hashlib
import json
import re
from collections.abc import Callable, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

from stiction.plan import memory
from stiction.plan.cost import USUAL_MINUTES
from stiction.plan.plan import Plan
from stiction.plan.stage import WILDCARDS, At, expression
from stiction.run import labels
from stiction.run.fingerprint import PACKAGE, fingerprint
from stiction.run.provenance import version_of

#: Folder of all results, and ending of datasets.
RESULTS, DATASET = "results/", ".nc"
#: Targets of a run without named ones.
ALL_TARGETS = ("tables", "figures", "devices", "all")


class NotPlanned(ValueError):
    """Error for a requested file without a job of the configuration."""


class Planner:
    """Rules and jobs of one configuration: complete, valid and in normal form.

    Preliminary numbers of measured surfaces are those of `stiction.config.scans`. Fingerprints and jobs are kept
    between plans, each by a `stiction.run.disk_cache.DiskCache`.
    """

    def __init__(self, config: dict, preliminary: Mapping[str, Any], remember: Callable, remember_jobs: Callable):
        self.plan, self._remember, self._remember_jobs = Plan(config, preliminary), remember, remember_jobs
        self._codes, self._jobs, self._behind_datasets, self._known = {}, {}, {}, {}

    @cached_property
    def _determined_by(self):
        """Hash of all sources of the jobs: code, configuration and files of scans."""
        scans = [Path(file) for surface in self.plan.scans.surfaces for file in self.plan.scans.files(surface).values()]
        states = [(str(file), *_state(file)) for file in scans]
        numbers = dict(self.plan.preliminary or {})
        # Files of the package are inputs by their paths, which are others in another checkout.
        text = json.dumps(
            [str(PACKAGE), hashes("*.py", "*.yaml"), self.plan.config, states, numbers], sort_keys=True, default=str
        )
        return hashlib.sha256(text.encode()).hexdigest()

    def _code(self, file):
        """Fingerprint of a module of the package."""
        if file not in self._codes:
            self._codes[file] = fingerprint(file, self._remember)
        return self._codes[file]

    def _kept(self, key, compute):
        """Value kept under a key, or computed now: plain numbers, strings, lists and dicts."""
        if key not in self._known:  # Snakemake asks five times for every job
            self._known[key] = self._remember_jobs([self._determined_by, key], compute)
        return self._known[key]

    @cached_property
    def _graph(self):
        """Graph of all declarations. Their modules are imported here."""
        from stiction.plan.graph import Graph

        return Graph(self.plan)

    # Rules

    @cached_property
    def rules(self) -> list[dict]:
        """Rules, without the inputs and settings of their jobs."""
        return self._kept("rules", self._rules)

    def _rules(self):
        """Rules of all declared stages with a file under this configuration."""
        from stiction.plan.graph import stages

        return [self._rule(stage, module) for stage, module in stages().values() if stage.patterns(self.plan)]

    def _rule(self, stage, module):
        """Rule of one stage."""
        from stiction.plan.graph import constraints

        running = stage.running
        return {key: getattr(stage, key) for key in ("name", "targets", "libraries")} | {
            "module": module,
            "code": stage.code,
            "cluster": running.minutes is not None,
            "minutes": running.minutes or USUAL_MINUTES,
            "memory": running.memory(self.plan) if running.memory else 0,
            "priority": running.priority,
            "last": running.last,
            "temporary": running.temporary,
            "stage": stage.stage,
            "files": {key: path_of(stage, name) for key, name in stage.patterns(self.plan).items()},
            "wanted": [
                path_of(stage, name.format(**at))
                for at in stage.jobs_of_targets(self.plan)
                for name in stage.files.values()
            ],
            "log": f"{RESULTS}logs/{stage.log}.log",
            "constraints": {
                key: pattern for key, pattern in constraints(stage, self.plan).items() if pattern != WILDCARDS[key]
            },
            "message": re.sub(r"{(\w+)}", r"{wildcards.\1}", stage.message),
            "shown": vars(stage.shown) if stage.shown else None,
        }

    def files_of(self, target: str) -> list[str]:
        """Files wanted by a target of the workflow."""
        return [file for rule in self.rules if target in rule["targets"] for file in rule["wanted"]]

    @property
    def cost(self) -> tuple[float, int]:
        """CPU time [s] of all jobs of a whole run, and memory [MB] of its largest one."""
        return tuple(self._kept("cost", self._cost))

    def _cost(self):
        """Sum over the jobs, see `cost`."""
        jobs = self._graph.needed(*ALL_TARGETS)
        of_stages = {job.stage.name: job.stage.running.memory for job in jobs}
        memories = (round(needs(self.plan)) for needs in of_stages.values() if needs)
        megabytes = max(memory.job_memory(self.plan.config), *memories, 0)
        return sum(job.seconds for job in jobs), megabytes

    @cached_property
    def before_last(self) -> list[str]:
        """Files of a whole run for which the last jobs wait."""
        return [
            file
            for rule in self.rules
            if {*ALL_TARGETS} & {*rule["targets"]} and not rule["last"]
            for file in rule["wanted"]
        ]

    def code(self, rule: Mapping[str, Any]) -> dict[str, str | None]:
        """Fingerprint of the module of the computation of a stage and of all its imports, and versions of libraries."""
        file = PACKAGE.joinpath(*rule["code"].split(".")[1:]).with_suffix(".py")
        return self._code(str(file)) | {name: version_of(name) for name in rule["libraries"]}

    # Jobs

    def job(self, rule: str, wildcards: Mapping[str, str]) -> dict:
        """Files and structure of the inputs and settings of a job."""
        return self._kept(f"{rule} {sorted(wildcards.items())}", lambda: self._job(rule, wildcards))

    def _job(self, rule, wildcards):
        """Job from the declaration, see `job`."""
        from stiction.plan.graph import Job, stages

        job = Job(stages()[rule][0], At(**wildcards), self.plan)
        inputs = {name: self._input(names) for name, names in job.inputs.items()}
        return {
            "files": {name: files for name, (files, _, _) in inputs.items()},
            "inputs": {name: [label, keys] for name, (_, label, keys) in inputs.items()},
            "settings": job.settings,
            "seconds": job.seconds,
        }

    def inputs(self, rule: Mapping[str, Any], wildcards: Mapping[str, str]) -> dict[str, list[str]]:
        """Input files of a job of a rule.

        Raises
        ------
        NotPlanned
            If the configuration does not have a name that the files of the job have.
        """
        try:
            return self.job(rule["name"], wildcards)["files"]
        except KeyError as missing:
            (name,) = missing.args
            if not any(f"{value}_".startswith(f"{name}_") for value in wildcards.values()):
                raise
            file = next(iter(rule["files"].values())).format(**wildcards)
            raise NotPlanned(f"{file} cannot be computed: the configuration has no {name!r} for it") from missing

    def _input(self, names):
        """Files of an input, name of the stage of its datasets, and its structure."""
        from stiction.plan.stage import File

        if isinstance(names, str):
            listed, keys = [names], None
        elif isinstance(names, Mapping):
            listed, keys = list(names.values()), list(names)
        else:
            listed, keys = list(names), True
        if not listed or isinstance(listed[0], File):
            return listed, None, keys
        labels = {self._graph.job(name).stage.stage for name in listed}
        (label,) = labels
        return [f"{RESULTS}{name}{DATASET}" for name in listed], label, keys

    def settings(self, path: str) -> dict | None:
        """Settings of the job for a file, ``None`` without such a job in the configuration."""
        _, job = self._job_of(path)
        return job and job["settings"]

    def origin(self, path: str) -> str | None:
        """Origin of a file without a label, see `stiction.run.labels.origin`. ``None`` without such a job."""
        _, job = self._job_of(path)
        return job and self._kept(f"origin of {path}", lambda: labels.origin(job["settings"], self._behind(path)))

    def _behind(self, path):
        """Digests of all results behind a file, by file."""
        behind = dict(self._datasets_behind(path))
        texts = (file for file, label in self._inputs_of(path) if not label)
        return behind | {file: origin for file in texts if (origin := self.origin(file))}

    def _datasets_behind(self, path):
        """Digests of the settings of all datasets behind a file, by file, without its chunks."""
        if path not in self._behind_datasets:
            rule, _ = self._job_of(path)
            digests = self._behind_datasets[path] = {}
            for file, label in self._inputs_of(path):
                digests |= self._datasets_behind(file) if label else {}
                digests |= {file: labels.digest(self.settings(file))} if label not in (None, rule["stage"]) else {}
        return self._behind_datasets[path]

    def _inputs_of(self, path):
        """Yield the inputs of the job of a file, each with the stage of datasets, ``None`` for other files."""
        _, job = self._job_of(path)
        for name, (label, _) in job["inputs"].items():
            yield from ((file, label) for file in job["files"][name])

    def _job_of(self, path):
        """Rule and job of a file, both ``None`` without such a job in the configuration."""
        if path not in self._jobs:
            self._jobs[path] = self._matched(path)
        return self._jobs[path]

    def _matched(self, path):
        """Rule and job of a file, see `_job_of`."""
        for rule, matches in self._expressions:
            if match := matches.fullmatch(path):
                try:
                    return rule, self.job(rule["name"], match.groupdict())
                except (KeyError, OSError):  # a scan can have moved
                    break
        return None, None

    @cached_property
    def _expressions(self):
        """Rule and regular expression of the names of all files."""
        return [
            (rule, expression(file, WILDCARDS | rule["constraints"]))
            for rule in self.rules
            for file in rule["files"].values()
        ]


def hashes(*patterns: str) -> dict[str, str]:
    """SHA-256 of all files of the package with names of these patterns, by file."""
    files = (file for pattern in patterns for file in PACKAGE.rglob(pattern))
    return {str(file.relative_to(PACKAGE)): hashlib.sha256(file.read_bytes()).hexdigest() for file in files}


def _state(file):
    """Time and size of a file. Empty if it is missing, as after a move."""
    with contextlib.suppress(OSError):
        return file.stat().st_mtime_ns, file.stat().st_size
    return ()


def path_of(stage: Any, name: str) -> str:
    """Path of a file of a stage."""
    return RESULTS + name + (DATASET if stage.save is None else "")
