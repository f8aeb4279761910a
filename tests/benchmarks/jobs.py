"""Time and memory of the jobs of a run, rule by rule, from their logs: ``make jobs``. Prints a table."""

import re
import sys
from pathlib import Path

from stiction.plan.graph import stages

ROOT = Path(__file__).parents[2]
TOOK = re.compile(r"^took ([\d.]+) s, (\d+) MB$", re.MULTILINE)


def rules():
    """For every stage: name, pattern of its logs, and the requested memory [MB] and minutes."""
    default = (ROOT / "profiles" / "default" / "config.yaml").read_text()
    memory = int(re.search(r"mem_mb=(\d+)", default)[1])
    for name, (stage, _) in sorted(stages().items()):
        yield name, re.compile(re.sub(r"{\w+}", "[^/]+", stage.log)), memory, stage.minutes


def costs(results):
    """For every rule that ran: name, jobs, most and all seconds, most memory [MB], requested MB and minutes."""
    logs = {
        str(path.relative_to(results / "logs"))[:-4]: path.read_text() for path in (results / "logs").rglob("*.log")
    }
    for name, pattern, memory, minutes in rules():
        own = [log for log in logs if pattern.fullmatch(log)]  # other rules may write logs of the same names
        took = [TOOK.findall(text)[-1] for log in own if TOOK.search(text := logs.pop(log))]
        if took:
            seconds, megabytes = (list(map(float, column)) for column in zip(*took, strict=True))
            yield name, len(took), max(seconds), sum(seconds), max(megabytes), memory, minutes


def table(results):
    """The table in Markdown."""
    lines = ["| rule | jobs | longest [s] | all [s] | most memory [MB] | requested [MB] | requested [min] |"]
    lines += ["|---|---|---|---|---|---|---|"]
    for name, jobs, longest, seconds, megabytes, memory, minutes in costs(results):
        lines += [f"| {name} | {jobs} | {longest:.1f} | {seconds:.0f} | {megabytes:.0f} | {memory} | {minutes} |"]
    return "\n".join(lines) + "\n"


def main():
    """Print the table."""
    print(table(Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "results")), end="")  # noqa: T201


if __name__ == "__main__":
    main()
