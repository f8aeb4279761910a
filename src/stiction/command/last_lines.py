"""Last lines of a command, and its exit status."""

import csv
import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from enum import IntEnum
from pathlib import Path

from stiction.command.present import Present
from stiction.command.progress_line import duration
from stiction.command.run_state import Run, RunJob, is_fault
from stiction.run import stale_results


class Status(IntEnum):
    """Exit status of the command."""

    DONE = 0  #: everything is up to date
    FAILED = 1  #: a job failed, or the command itself
    REFUSED = 2  #: nothing was computed: wrong input, or another run uses the folder
    CHECKS = 3  #: everything was computed, but checks of the results failed
    STOPPED = 130  #: by Ctrl-C or SIGTERM


#: Job that fails if a check of the results does.
_VERDICT = "verdict"
#: Pages and tables of results to open first, the most important one first.
_PAGES = ("devices/*.html", "figures/overview.png", "figures/surface_sheet_*.png", "figures/*.png")
_TABLES = tuple(
    f"tables/{name}.md"
    for name in (
        "devices",
        "process",
        "process_map",
        "roughness",
        "test_beams",
        "safe_lengths",
        "stoppers",
        "table_3",
        "scans",
    )
)
#: Pages of warnings.
_WARNINGS = ("warnings.md", "devices/warnings.md")
#: Where everything goes that Snakemake and its jobs print, relative to the folder of the run.
PRINTED = Path(".snakemake", "printed.log")
#: What to do about an error of the code.
FAULT = "This is an error of stiction itself: please report it with this log as an issue, see CONTRIBUTING.md."
#: Head of a line of a traceback that names an error, with the modules of its class.
_MODULES = re.compile(r"\A(?:\w+\.)+(?=\w+:)")


def status(run: Run, code: int, stopped: bool) -> Status:
    """Exit status of a run, from Snakemake's code."""
    if stopped:
        return Status.STOPPED
    if code == 0:
        return Status.DONE
    if {job.rule for job in run.failures.values()} == {_VERDICT}:
        return Status.CHECKS
    failed = run.failures or run.jobs or run.fault or (run.planned and not run.refusal)
    return Status.FAILED if failed else Status.REFUSED


def last_lines(
    run: Run, ended: Status, directory: Path, printed: str = "", targets: Sequence[str] = ()
) -> Iterator[str]:
    """Yield the last lines for a user at the end of a run in a folder.

    ``printed`` is what Snakemake printed last, for errors that it does not report otherwise. Figures and tables with
    the name of a target, which may contain wildcards of the shell, come first.
    """
    if ended == Status.STOPPED:
        after = f" after {run.done} of {run.total} jobs" if run.planned else ""
        yield f"stopped{after}; run the same command to continue"
    elif ended == Status.CHECKS:
        yield from _failed_checks(short_path(directory / "results"))
        yield from where_to_look(short_path(directory / "results"), targets, run.unlike)
    elif run.failures:
        yield from _first_error(list(run.failures.values()), directory)
    elif ended != Status.DONE:
        yield run.refusal or printed or "Snakemake stopped without a message"
        if run.fault:
            yield from fault(directory / PRINTED)
    elif run.planned or run.up_to_date:
        yield _report_end(run)
        yield from where_to_look(short_path(directory / "results"), targets, run.unlike)


def fault(log: Path) -> Iterator[str]:
    """Last lines after an error of the code."""
    yield FAULT
    yield f"log: {short_path(log)}"


def short_path(path: Path) -> Path:
    """Path relative to the present folder, if below it, else from the root.

    Examples
    --------
    >>> short_path(Path("runs/results")), short_path(Path("/a/b"))
    (PosixPath('runs/results'), PosixPath('/a/b'))
    """
    return path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path


def _report_end(run):
    """Report the end of a run and its duration."""
    if run.up_to_date:
        return "Nothing to do: all results are up to date."
    spent = {rule: sum(seconds) for rule, seconds in run.seconds.items()}
    share = sum(spent.get(rule, 0) for rule in run.budgets) / max(sum(spent.values()), 1)
    of_budgets = f", {100 * share:.0f} % of their time for budgets" if run.budgets else ""
    return f"Done: {run.done} jobs in {duration(run.last - run.started)}{of_budgets}."


def where_to_look(results: Path, targets: Sequence[str] = (), unlike: Mapping[str, str] | None = None) -> Iterator[str]:
    """Verdict, warnings, and the files to open first, of a folder of results, without files ``unlike`` the run."""
    present = Present(results, unlike or {})
    if present.has("verdict.txt"):
        yield f"{present.text('verdict.txt').strip()} The numbers are in {results / 'checks.md'}."
    numbers = {page: _number_of_warnings(present, page) for page in _WARNINGS}
    if counted := [f"{number} in {results / page}" for page, number in numbers.items() if number]:
        yield f"Warnings about results beyond the limits of the model: {', '.join(counted)}."
    pages = [*(f"figures/{name}.png" for name in targets), *_PAGES]
    tables = [*(f"tables/{name}.md" for name in targets), *_TABLES]
    if first := [*_first(present, pages), *_first(present, tables)]:
        yield f"Open first: {' and '.join(map(str, first))}."
    if present.has("index.html"):
        yield f"All results: {results / 'index.html'}; stiction show opens it."
    if unlike:
        yield f"Not computed in this run: {stale_results.in_words(unlike)}."


def _number_of_warnings(present, page):
    """Number of warnings on a page, from the file beside it."""
    limits = present.text(str(Path(page).with_suffix(".json"))) if present.has(page) else ""
    return len(json.loads(limits or "[]"))


def _first(present, patterns):
    """First file for the first pattern with any file, empty without one."""
    return next(filter(None, map(present.first, patterns)), [])


def _failed_checks(results):
    """Yield the first failed check, and the place of the others."""
    with (results / "checks.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    failed = [row for row in rows if row["passed"] != "True"]
    yield "; ".join(f"{row['name']}: {row['case']}: {row['message']}" for row in failed[:1])
    yield f"{len(failed)} of {len(rows)} checks of the results failed: {results / 'checks.md'}"


def _first_error(jobs: list[RunJob], directory: Path) -> Iterator[str]:
    """Yield the error of the first failed job, and its log."""
    first, logs = jobs[0], list(_existing(jobs[0].logs, directory))
    more = f" (and {len(jobs) - 1} more)" if len(jobs) > 1 else ""
    yield f"failed: {first.message}{more}"
    error = next(
        filter(None, map(sentence, logs)), "the job ended without a message: was it killed, or the memory full?"
    )
    yield error
    if is_fault(error.partition(":")[0], ValueError, RuntimeError):
        yield FAULT
    yield f"log: {logs[0] if logs else short_path(directory / 'results' / 'logs')}"


def _existing(logs: Iterable[str], directory: Path) -> Iterator[Path]:
    """Yield existing logs. Their paths are relative to the folder of the run."""
    for log in logs:
        if (directory / log).is_file():
            yield short_path(directory / log)


def sentence(log: Path) -> str:
    """Error at the end of a log, without its traceback, or nothing."""
    lines = log.read_text(encoding="utf-8", errors="replace").splitlines()
    frames = [number for number, text in enumerate(lines) if text.startswith("  File ")]
    last = (text for text in lines[frames[-1] :] if not text.startswith("  ")) if frames else ()
    return _MODULES.sub("", " ".join(" ".join(last).split()))
