"""Jobs of a run and their reasons in words, from a dry run of Snakemake."""

import ast
import re
from collections import Counter
from collections.abc import Iterator

from stiction.command.run_state import Run, RunJob
from stiction.plan import cost

#: A reason of Snakemake, by its first words, and what it says.
_REASONS = {
    "Missing output files": "results are missing",
    "Input files updated by another job": "",  # follows from another job
    "Updated input files: .snakemake/stale": "results that this run does not use",  # see workflow/rules/common.smk
    "Updated input files": "an input file is newer",
    "Forced execution": "an option forces them",
    "Incomplete": "an earlier run was stopped while the job was running",
    "Software environment": "the software environment changed",
    "Code has changed": "the code changed",
}
_CHANGED = re.compile(r"before: (.*?) now: (.*)", re.DOTALL)


def explained(run: Run) -> Iterator[str]:
    """Yield lines on the jobs of a run and their reasons, from all reports of a dry run. The first counts the jobs."""
    jobs = [job for job in run.jobs.values() if job.logs]  # the others only collect files
    if run.planned and not run.jobs:
        yield f"At most {run.total} jobs would run: without --quiet, this says which and why."
        return
    if not jobs:
        yield "Nothing would be computed: all results are up to date."
        return
    causes = Counter((job.rule, "; ".join(reasons(job))) for job in jobs)
    yield f"{len(jobs)} jobs would run{_cost(jobs)}."
    yield from run.warnings
    for cause in sorted({cause for _, cause in causes}, key=lambda cause: (not cause, cause)):
        rules = Counter({rule: number for (rule, why), number in causes.items() if why == cause})
        yield f"{cause or 'follow from the jobs above'}: {count_jobs(rules)}"


def _cost(jobs):
    """CPU time and memory of jobs, for the end of a sentence, or nothing if unknown."""
    seconds = sum(job.seconds for job in jobs)
    return f", {cost.in_words(seconds, max(job.megabytes for job in jobs))}" if seconds else ""


def count_jobs(rules: Counter) -> str:
    """Rules with the numbers of their jobs, in the order of their first occurrence."""
    return ", ".join(f"{rule} ({number})" if number > 1 else rule for rule, number in rules.items())


def reasons(job: RunJob) -> Iterator[str]:
    """Yield the reasons of a job in words, apart from jobs before it."""
    other_reasons, params, values = job.reason.partition("Params have changed")
    if params:  # also explains results that are missing because they were temporary
        yield what_changed(values)
        return
    for reason in filter(None, other_reasons.split("; ")):
        texts = [words for start, words in _REASONS.items() if reason.startswith(start)]
        yield from filter(None, texts[:1] or [reason])


def what_changed(reason: str) -> str:
    """Code or settings changed for a job, in words, from the parameters printed by Snakemake."""
    try:
        before, now = map(_printed_parameters, _CHANGED.search(reason).groups())
    except (AttributeError, SyntaxError, ValueError, TypeError):
        return "settings or code changed"
    differing = [key for key in sorted({*before, *now}) if before.get(key) != now.get(key)]
    code = [key for key in differing if key.startswith("stiction.") or key.endswith(".py")]
    settings = [
        f"{key}: {before.get(key, 'nothing')} → {now.get(key, 'nothing')}" for key in differing if key not in code
    ]
    changes = [f"the code of {', '.join(code)}"] * bool(code) + [f"settings: {', '.join(settings)}"] * bool(settings)
    return " and ".join(changes) or "settings or code changed"


def _printed_parameters(text):
    """Parameters printed one after the other, as one dictionary with dotted keys."""
    none = "<nothing exclusive>"
    printed = () if text.strip() == none else ast.literal_eval(f"[{text.strip()}]")
    return {key: value for parameters in printed for key, value in _dotted_entries(parameters)}


def _dotted_entries(section, path=()):
    """Dotted key and value of every entry of nested sections."""
    for key, value in section.items():
        if isinstance(value, dict):
            yield from _dotted_entries(value, (*path, str(key)))
        else:
            yield ".".join((*path, str(key))), value
