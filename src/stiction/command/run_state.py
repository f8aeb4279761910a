"""Reports of a run of Snakemake so far: its jobs, their time, and errors.

Snakemake reports by records of the standard library's ``logging``, whose attribute ``event`` names the kind of report.
"""

import builtins
import re
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from logging import WARNING, LogRecord

from stiction.config.units import to_si

#: First line of an error of Snakemake, and the places in files that follow the message.
_ORIGIN = re.compile(r"\A\w+( in rule \S+)?( in file \"[^\n]*)?:\n|(\n  File \"[^\n]*)+\s*\Z")

#: An exception of the plan and its message, in what Snakemake writes around them.
_OF_PLAN = re.compile(r"\AError:\n  (\w+): (.*)\nWildcards:\n", re.DOTALL)

#: Rules of budgets, and of contacts that budgets alone read; study slopes reads the last one as well.
_BUDGETS = {
    *("budget", "tip_budget", "test_beam_budget", "test_beam_tip_budget"),
    *("device_slope_contact", "tip_slope_contact", "device_choice_summits", "device_choice_contact"),
    *(
        "device_member_contact",
        "tip_member_contact",
        "tip_choice_contact",
        "solid_contact",
        "tip_solid_contact",
        "tip_edge_contact",
        "slope_contact",
    ),
}


def is_fault(kind: str, *expected: type[Exception]) -> bool:
    """Whether an exception, by the name of its class, is an error of the code: built in and not an expected one.

    Examples
    --------
    >>> is_fault("KeyError"), is_fault("OSError"), is_fault("ConfigError"), is_fault("ValueError", ValueError)
    (True, False, False, False)
    """
    builtin = getattr(builtins, kind, None)
    expected = (OSError, MemoryError, *expected)
    return isinstance(builtin, type) and issubclass(builtin, Exception) and not issubclass(builtin, expected)


@dataclass(frozen=True)
class RunJob:
    """One job of a run."""

    rule: str
    message: str  #: what the job does, in words
    reason: str  #: why Snakemake runs the job
    logs: tuple[str, ...]
    started: float  #: seconds since the epoch
    seconds: float = 0.0  #: estimate of its CPU time [s]
    megabytes: float = 0.0  #: memory that it requests [MB]


@dataclass
class Run:
    """Run, from the reports of Snakemake.

    Attributes
    ----------
    planned : Counter
        Number of jobs by rule, of all that this run needs.
    jobs : dict
        Jobs that have started, by their number; in a dry run, all of them.
    seconds : dict
        Durations of the finished jobs, by rule [s].
    first : dict
        First finished job, by rule.
    failures : dict
        Jobs that failed, by their number.
    refusal : str
        Last error of Snakemake that concerns no job, without its place in a file; empty if there was none.
    fault : str
        Class and places of this error if it is one of the code, no refusal; empty otherwise.
    warnings : list of str
        Warnings about the results that are present.
    unlike : dict
        Results in the folder that are not of this run, each with the reason.
    up_to_date : bool
        Whether there was nothing to do.
    started, last : float
        Times of the first and the last report [s since the epoch].
    ended : float
        Time at which the last job finished [s since the epoch].
    quiet : bool
        Whether Snakemake prints nothing itself.
    changed : callable
        Called with the time of each report.
    """

    planned: Counter = field(default_factory=Counter)
    jobs: dict[int, RunJob] = field(default_factory=dict)
    seconds: dict[str, list[float]] = field(default_factory=dict)
    first: dict[str, RunJob] = field(default_factory=dict)
    failures: dict[int, RunJob] = field(default_factory=dict)
    refusal: str = ""
    fault: str = ""
    warnings: list[str] = field(default_factory=list)
    unlike: Mapping[str, str] = field(default_factory=dict)
    up_to_date: bool = False
    started: float | None = None
    last: float = 0.0
    ended: float = 0.0
    quiet: bool = True
    changed: Callable[[float], None] | None = None

    @property
    def done(self) -> int:
        """Number of finished jobs."""
        return sum(map(len, list(self.seconds.values())))

    @property
    def total(self) -> int:
        """Number of jobs of this run."""
        return self.planned.total()

    @property
    def budgets(self) -> set[str]:
        """Rules of this run with jobs for budgets alone."""
        return _BUDGETS & self.planned.keys() - ({"slope_contact"} if "slopes" in self.planned else set())

    def hear(self, record: LogRecord) -> None:
        """Follow one report of Snakemake. Reports of unknown kinds are left out."""
        event = getattr(record, "event", None)
        self.last = record.created
        self.started = record.created if self.started is None else self.started
        if follow := _EVENTS.get(str(event)):
            follow(self, record)
        elif event is None:
            self._hear_text(record)
        if self.changed:
            self.changed(record.created)

    def _hear_text(self, record):
        """Note a report without a kind."""
        text = str(record.msg)
        self.up_to_date |= text.startswith("Nothing to be done")
        if record.levelno == WARNING:
            self.warnings.append(text)

    def _hear_plan(self, record):
        """Number of jobs of each rule."""
        self.planned = Counter({rule: int(number) for rule, number in record.stats.items() if rule != "total"})

    def _hear_start(self, record):
        """Note the start of a job, perhaps its second."""
        logs = tuple(map(str, record.log))
        message = " ".join(str(record.rule_msg or record.rule_name).split())
        resources = getattr(record, "resources", None) or {}
        seconds, megabytes = to_si(float(resources.get("cpu_ms", 0)), "ms"), float(resources.get("mem_mb", 0))
        self.jobs[record.jobid] = RunJob(
            record.rule_name, message, str(record.reason), logs, record.created, seconds, megabytes
        )
        self.failures.pop(record.jobid, None)

    def _hear_end(self, record):
        """Note the end of a job."""
        self.ended = record.created
        job = self.jobs[record.job_id]
        self.first.setdefault(job.rule, job)
        self.seconds.setdefault(job.rule, []).append(record.created - job.started)

    def _hear_failure(self, record):
        """Note the failure of a job. Its logs include the cluster's."""
        job = self.jobs.get(record.jobid, RunJob(record.rule_name, record.rule_name, "", (), record.created))
        self.failures[record.jobid] = replace(job, logs=tuple(map(str, record.log)))

    def _hear_error(self, record):
        """Note an error of the run itself. For a command started by a run, the command's own output says more."""
        kind = getattr(record, "exception", "")
        if kind != "CalledProcessError":
            text = _ORIGIN.sub("", str(record.msg)).strip()
            if of_plan := _OF_PLAN.match(text):
                kind, text = of_plan.groups()
            self.fault = str(record.msg) if is_fault(kind) else ""
            self.refusal = f"{kind}: {text}" if self.fault else text

    def seconds_left(self, now: float) -> float | None:
        """Estimate of the time left [s], ``None`` while too little is known, or at the end.

        A job is expected to take as long as the finished jobs of its rule, or else as long as all jobs so far. The
        speed is that of the run until a job finished last, so that the estimate includes the number of cores.
        """
        elapsed = self.ended - min((job.started for job in list(self.jobs.values())), default=now)
        finished = sum(map(sum, list(self.seconds.values())))
        if self.done < 3 or elapsed < 5 or not finished:
            return None
        remaining = elapsed * self._time_left(finished / self.done) / finished - (now - self.ended)
        return remaining if remaining >= 0 else None

    def _time_left(self, mean):
        """Time of all unfinished jobs [s]. The mean is for rules without a finished job."""
        spent = ((number, self.seconds.get(rule, ())) for rule, number in self.planned.items())
        return sum((number - len(times)) * (sum(times) / len(times) if times else mean) for number, times in spent)


_EVENTS = {
    "run_info": Run._hear_plan,
    "job_info": Run._hear_start,
    "job_finished": Run._hear_end,
    "job_error": Run._hear_failure,
    "error": Run._hear_error,
}
#: The run that this process follows: a process of Snakemake has one.
RUN = Run()
