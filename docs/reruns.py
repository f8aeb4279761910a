"""Which keys of the configuration rerun which rules, from the settings and inputs of the jobs of a plan."""

import json
import sys
from collections import defaultdict
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

from stiction.config.files import load
from stiction.config.merging import merged
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1] / "tests")]
import every_stage  # noqa: E402
import rules  # noqa: E402

#: Pair b at one humidity, with the studies of the paper: the surfaces, pairs and cases of all others are alike.
CONFIG = load({"run": {"pairs": ["b"]}, "pairs": {"b": {"humidities": [0.67]}}, "figures": {"pair": "b"}})
#: Entries that this pair uses, by their section; others of the section are left out.
USED = {"surfaces": "B2", "pairs": "b"}
#: Sections without a number of a computation: what to compute, and what to draw.
LEFT_OUT = ("run", "figures", "devices", "test_beams", "process", "scans")


def numbers(value: Any, path: tuple = ()) -> Iterator[tuple[tuple, Any]]:
    """Yield path and value of every number, or list of numbers, of the entries that pair b uses."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if key not in LEFT_OUT and (len(path) != 1 or USED.get(path[0], key) == key):
                yield from numbers(inner, (*path, key))
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield path, _larger(value)
    elif isinstance(value, list) and value and all(isinstance(one, int | float) for one in value):
        yield path, [*value[:-1], _larger(value[-1])]


def _larger(number):
    """Slightly larger number; a humidity has four decimals at most."""
    return number + 1 if isinstance(number, int) else round(1.01 * number, 4) if number > 0.1 else 1.01 * number


def jobs(config: dict) -> dict[str, set[str]]:
    """Jobs of each rule with a dataset that is kept: names of their files and settings, as text."""
    found = defaultdict(set)
    for job in Graph(Plan(config)).needed("tables", "figures", "all"):
        if job.stage.save is None and not job.stage.running.temporary:
            found[job.stage.name].add(json.dumps([job.names, job.settings], sort_keys=True))
    return found


def first_rules() -> dict[str, tuple[str, ...]]:
    """Rules with a new job after a change of a key, by the key. Rules that read their results follow."""
    before, first = jobs(CONFIG), {}
    for path, value in numbers(CONFIG):
        change = value
        for key in reversed(path):
            change = {key: change}
        after = jobs(merged(CONFIG, change))
        first[".".join(path)] = tuple(name for name in after if after[name] - before[name])
    return first


@cache
def links() -> set[tuple[str, str]]:
    """Pairs of rules of this plan, each with one that reads its results."""
    graph = Graph(Plan(CONFIG))
    return {
        (graph.job(name).stage.name, job.stage.name)
        for job in graph.needed("tables", "figures", "all")
        for names in job.inputs.values()
        for name in every_stage.results(names)
    }


def following(names: Iterable[str]) -> list[str]:
    """Rules of the chain that read results of some rules, directly or through others."""
    found = {*names}
    for _ in rules.CHAIN:
        found |= {after for before, after in links() if before in found}
    return [name for name in rules.CHAIN if name in found - {*names}]


def table() -> str:
    """Table in Markdown: keys, the rules that a change reruns first, and rules of the chain that follow."""
    keys = defaultdict(list)
    for key, names in first_rules().items():
        keys[tuple(sorted(names, key=_place))].append(key)
    lines = [
        f"| {', '.join(f'`{key}`' for key in changed)} | {_listed(first)} | {_listed(following(first))} |"
        for first, changed in keys.items()
        if first
    ]
    head = ["| a larger number of | reruns first | then, of the chain |", "|---|---|---|"]
    return "\n".join([ABOUT, *head, *lines]) + "\n"


def _place(name):
    """Place of a rule in a row: first those of the chain."""
    return [*rules.CHAIN, *rules.stages()].index(name)


def _listed(names):
    """Names in Markdown."""
    return ", ".join(f"`{name}`" for name in names)


TABLE = Path(__file__).parent / "tables" / "reruns.md"
ABOUT = """Keys of pair b and of its surface B2, in a run of pair b at RH 0.67 with the studies of the paper.
Other pairs and surfaces are alike. Keys that are not listed change no result of this run. Tables and figures follow.
"""


def written() -> dict[Path, str]:
    """Text of the table by its file."""
    return {TABLE: table()}


if __name__ == "__main__":
    TABLE.write_text(table(), encoding="utf-8")
