"""Jobs of a configuration: stage, input files and settings behind each file, and results in memory."""

import pkgutil
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
from pathlib import Path
from typing import Any

import xarray as xr

from stiction.contact.air import DRY_AIR
from stiction.plan import cost
from stiction.plan.plan import Plan
from stiction.plan.stage import FOLDERS, WILDCARDS, At, File, Names, Stage, expression, stages_of
from stiction.run.variables import described

_PACKAGE = Path(__file__).parents[1]


def modules() -> Iterator[str]:
    """Yield the names of all modules with possible stages, sorted within their folders."""
    for folder in FOLDERS:
        packaged = pkgutil.walk_packages([str(_PACKAGE / folder)], f"stiction.{folder}.")
        yield from sorted(module.name for module in packaged if not module.ispkg)


@cache
def stages() -> dict[str, tuple[Stage, str]]:
    """All stages, each with its module, by the name of its rule.

    Raises
    ------
    ValueError
        If two stages have the same name.
    """
    declarations = {}
    for module in modules():
        for stage in stages_of(module):
            if stage.name in declarations:
                raise ValueError(f"{module} and {declarations[stage.name][1]} both declare stage {stage.name}")
            declarations[stage.name] = stage, module
    return declarations


@dataclass(frozen=True)
class Job:
    """One job: a stage with the values of its wildcards."""

    stage: Stage
    at: At
    plan: Plan

    @cached_property
    def inputs(self) -> Mapping[str, Names]:
        """Names of the input files."""
        return self.stage.inputs(self.plan, self.at)

    @cached_property
    def settings(self) -> dict:
        """Plain numbers, strings, lists and dicts behind the result."""
        return self.stage.settings(self.plan, self.at)

    @property
    def names(self) -> list[str]:
        """Names of the files written by the job."""
        return [pattern.format(**vars(self.at)) for pattern in self.stage.patterns(self.plan).values()]

    @property
    def seconds(self) -> float:
        """Estimate of its CPU time [s]. A job joining chunks draws nothing."""
        if "chunks" in self.inputs:
            return cost.PER_JOB
        datasets = len(self.names) if self.stage.each else 1
        return cost.job_cost(self.settings, vars(self.at), datasets)

    def compute(self, data: Mapping[str, Any]) -> Any:
        """Result for the data of the inputs."""
        return self.stage.result(data, self.at, self.stage.converted(self.settings))


@dataclass(frozen=True)
class Graph:
    """Jobs of a configuration."""

    plan: Plan

    def __reduce__(self):
        """Pickle the plan alone. Other processes find the functions of declarations in the modules of the stages."""
        return Graph, (self.plan,)

    @cached_property
    def _expressions(self):
        """Stage and regular expression of all names of files."""
        return [
            (stage, expression(pattern, constraints(stage, self.plan)))
            for stage, _ in stages().values()
            for pattern in stage.patterns(self.plan).values()
        ]

    def job(self, file: str) -> Job:
        """Job for a file.

        Raises
        ------
        KeyError
            If the configuration has no such job.
        """
        for stage, matches in self._expressions:
            if match := matches.fullmatch(file):
                return Job(stage, At(**match.groupdict()), self.plan)
        raise KeyError(f"no stage writes {file}")

    def needed(self, *targets: str) -> list[Job]:
        """Find all jobs for some targets of the workflow, without results of an earlier run."""
        jobs, waiting = {}, []
        for stage, _ in stages().values():
            if set(targets) & set(stage.targets) and stage.patterns(self.plan):
                waiting += [Job(stage, At(**at), self.plan) for at in stage.jobs_of_targets(self.plan)]
        while waiting:
            job = waiting.pop()
            if (key := (job.stage.name, *sorted(vars(job.at).items()))) not in jobs:
                jobs[key] = job
                waiting += [self.job(name) for names in job.inputs.values() for name in _datasets(names)]
        return list(jobs.values())


def constraints(stage: Stage, plan: Plan) -> dict[str, str]:
    """Regular expressions of the wildcards of a stage.

    Both names of a pair and its surface may contain ``_``. Where no more than ``_`` is between them, the sides of the
    pair tell where its name ends.
    """
    if stage.surfaces:
        surfaces = sorted(stage.surfaces(plan))
    elif any("{pair}_{surface}" in file for file in stage.files.values()):
        contacts = ((pair, air) for pair in plan.config["pairs"] for air in ("", DRY_AIR.ending))
        surfaces = [f"(?<=/{pair}{air}_){side}" for pair, air in contacts for side in plan.sides(pair)]
    else:
        return WILDCARDS
    return WILDCARDS | {"surface": "|".join(surfaces) or "(?!)"}


@dataclass(frozen=True)
class Results:
    """Datasets of a configuration by the name of their file, computed in memory when they are first needed.

    Stages, settings and addresses of random numbers are those of the workflow, and so are the results.

    Examples
    --------
    >>> results = Results.of(stiction.load())  # doctest: +SKIP
    >>> results["forces/b_rh067_NG"].adhesion_energy  # doctest: +SKIP
    """

    graph: Graph
    _datasets: dict[str, xr.Dataset] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, config: dict) -> "Results":
        """Results of a complete configuration, from `stiction.load`."""
        return cls(Graph(Plan(config)))

    def __getitem__(self, file: str) -> xr.Dataset:
        """Dataset by the name of its file, such as ``contact/b_NG``. Raises a KeyError if no stage writes it."""
        if file in self._datasets:
            return self._datasets[file]
        job = self.graph.job(file)
        result = job.compute(self.inputs(job))
        results = [described(dataset, job.stage.stage) for dataset in job.stage.datasets(result, job.at)]
        datasets = dict(zip(job.names, results, strict=True))
        if not job.stage.running.temporary:
            self._datasets.update(datasets)
        return datasets[file]

    def has(self, file: str) -> bool:
        """Whether a dataset is computed already."""
        return file in self._datasets

    def inputs(self, job: Job) -> dict[str, Any]:
        """Data of the inputs of a job."""
        return {name: structured(files, self._read) for name, files in job.inputs.items()}

    def _read(self, file):
        """Read a dataset, or return the name of another file."""
        return file if isinstance(file, File) else self[file]


def structured(names: Names, read: Any) -> Any:
    """Data with the structure of some names: of one name, of names in an order, or by key."""
    if isinstance(names, str):
        return read(names)
    if isinstance(names, Mapping):
        return {key: read(name) for key, name in names.items()}
    return [read(name) for name in names]


def _datasets(names):
    """Names of all datasets in a structure of names."""
    flat = []
    structured(names, flat.append)
    return [name for name in flat if not isinstance(name, File)]
