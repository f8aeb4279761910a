"""CPU time and memory of the jobs of a run, rule by rule, from their logs: ``make jobs``. Prints a table."""

import json
import re
import sys
from pathlib import Path

from stiction.plan import memory
from stiction.plan.cost import USUAL_MINUTES
from stiction.plan.graph import stages
from stiction.plan.plan import Plan
from stiction.plan.stage import WILDCARDS, expression

ROOT = Path(__file__).parents[2]
TOOK = re.compile(r"^took ([\d.]+) s of CPU time, [\d.]+ s in all, (\d+) MB$", re.MULTILINE)


def rules(results):
    """For every stage: name, pattern of its logs, and the memory [MB] and minutes that its last run requested."""
    config = json.loads((results / "provenance.json").read_text(encoding="utf-8"))[-1]["config"]
    plan, usual = Plan(config), memory.job_memory(config)
    for name, (stage, _) in sorted(stages().items()):
        least = stage.running.memory(plan) if stage.running.memory else 0.0
        yield name, expression(stage.log, WILDCARDS), max(usual, round(least)), stage.running.minutes or USUAL_MINUTES


def costs(results):
    """For every rule that ran: name, jobs, most and all CPU seconds, most memory [MB], requested MB and minutes."""
    logs = {
        str(path.relative_to(results / "logs"))[:-4]: path.read_text() for path in (results / "logs").rglob("*.log")
    }
    for name, pattern, requested, minutes in rules(results):
        own = [log for log in logs if pattern.fullmatch(log)]  # other rules may write logs of the same names
        took = [TOOK.findall(text)[-1] for log in own if TOOK.search(text := logs.pop(log))]
        if took:
            seconds, megabytes = (list(map(float, column)) for column in zip(*took, strict=True))
            yield name, len(took), max(seconds), sum(seconds), max(megabytes), requested, minutes


def table(results):
    """The table in Markdown."""
    lines = ["| rule | jobs | longest [CPU s] | all [CPU s] | most memory [MB] | requested [MB] | requested [min] |"]
    lines += ["|---|---|---|---|---|---|---|"]
    for name, jobs, longest, seconds, megabytes, requested, minutes in costs(results):
        lines += [f"| {name} | {jobs} | {longest:.1f} | {seconds:.0f} | {megabytes:.0f} | {requested} | {minutes} |"]
    return "\n".join(lines) + "\n"


def main():
    """Print the table."""
    print(table(Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "results")), end="")  # noqa: T201


if __name__ == "__main__":
    main()
