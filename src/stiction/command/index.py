"""Index of the results of a run: devices, surfaces, figures, tables, checks, warnings and provenance on one page.

It is no rule of the workflow: a rule would compute everything that it lists, also what a run was not asked for. It
lists what the configuration of the last run wants and the folder holds, and is written only if that has changed.
"""

import contextlib
import csv
import json
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from stiction.command import front_page
from stiction.command.present import RESULTS, Present
from stiction.config.kinds import kind_of
from stiction.config.materials import Materials
from stiction.config.merging import differing
from stiction.config.reading import paper
from stiction.models import SIDES
from stiction.plan.planner import Planner, hashes
from stiction.plan.stage import WILDCARDS, expression
from stiction.report.drawings import device_drawing
from stiction.report.html import rendered
from stiction.report.surfaces.words import surface_in_words
from stiction.run import stale_results
from stiction.run.atomic import save_text
from stiction.run.disk_cache import Caches, DiskCache
from stiction.run.provenance import code_of, recorded_runs, start_of

#: Name of the page.
INDEX = "index.html"
#: Tables of the paper, by the pages that lists show.
_FIRST = tuple(f"tables/table_{number}.html" for number in (1, 2, 3))
#: Most devices that are cards with drawings. More are rows of a table.
_CARDS = 20
#: Complete configuration of the last run, among the files of Snakemake.
_PLANNED = "configuration.json"


@dataclass(frozen=True)
class Item:
    """Result of a stage: a figure, a table, a page of a device."""

    category: str
    title: str
    shown: str  #: file that shows it, relative to the page
    files: Mapping[str, str]  #: all its files by their endings


def write(results: Path, rules: Iterable[Mapping[str, Any]], unlike: Collection[str] = ()) -> None:
    """Write the index of a folder of results unless it is there already.

    Rules are those of the planner. Files ``unlike`` the last run are left out.
    """
    page = index(results, rules, unlike)
    if Present(results).text(INDEX) != page:
        save_text(page, results / INDEX)


def write_for_last_run(results: Path) -> Path | None:
    """Write the index of a folder by the configuration of its last run, and name it. Nothing without a run.

    Runs of which a job failed, or that were stopped, write no index themselves. A page is kept until a file of the
    folder or the code changes.

    Raises
    ------
    ValueError
        If the record of runs is damaged.
    """
    caches = results.parent / ".snakemake"
    with Caches(caches if caches.is_dir() else None).cache("index.json") as remember:
        page = remember([_states(results), hashes("*.py", "*.yaml", "*.html", "*.css")], lambda: _page(results))
    if page and Present(results).text(INDEX) != page:
        save_text(page, results / INDEX)
    return results / INDEX if page else None


def _page(results):
    """Index of a folder by the configuration of its last run, empty without a run."""
    if not (runs := recorded_runs(results / "provenance.json")):
        return ""
    return index(results, _planner(results, runs[-1]["config"]).rules, unlike_last_run(results))


def _states(results):
    """Times and sizes of the files that the index of a folder depends on, by file."""
    files = [results.parent / ".snakemake" / _PLANNED, *filter(Path.is_file, results.rglob("*"))]
    states = ((file, file.stat()) for file in files if file.is_file() and file.name != INDEX)
    return {str(file): [state.st_mtime_ns, state.st_ctime_ns, state.st_size] for file, state in states}


def unlike_last_run(results: Path) -> dict[str, str]:
    """Results without a label that were made with other settings than the last run's, each with the reason.

    Without judgement on a folder that no longer has the plan of its last run.
    """
    config = recorded_runs(results / "provenance.json")[-1]["config"]
    planner = _planner(results, config)
    if planner.plan.preliminary is None:
        return {}
    with contextlib.chdir(results.parent):
        return dict(stale_results.made_otherwise("results/logs", planner.origin))


def _planner(results, config):
    """Planner of the last run of a folder, with its numbers of measured surfaces if they are still there."""
    caches, preliminary = results.parent / ".snakemake", None
    with contextlib.suppress(OSError, ValueError, TypeError, KeyError):
        planned, numbers = json.loads(Present(caches).text(_PLANNED))["planned"]
        preliminary = numbers if planned == config and isinstance(numbers, dict) else None
    return Planner(config, preliminary, _now, DiskCache(caches / "jobs.json"))


def _now(_key: Any, compute: Callable[[], Any]) -> Any:
    """Compute a planner's value without keeping it."""
    return compute()


def index(folder: Path, rules: Iterable[Mapping[str, Any]], unlike: Collection[str] = ()) -> str:
    """Page with the results of the last run of a folder, without the files ``unlike`` this run."""
    runs, results = recorded_runs(folder / "provenance.json"), Present(folder, unlike)
    last, config, all_items = runs[-1], runs[-1]["config"], list(items(results, rules))
    shown = _computed(results, config)
    changes, checks = differing(config, paper()), list(csv.DictReader(results.text("checks.csv").splitlines()))
    return rendered(
        "index.html",
        title=front_page.subjects(shown) or f"surfaces {', '.join(_surfaces_of_run(shown))}",
        made=f"Last run: {start_of(last)}, {next(code_of(last))}.",
        devices=list(_devices(results, config, all_items)),
        pairs=front_page.pairs(results),
        length=config["beam"]["length_um"],
        models=front_page.MODELS_IN_WORDS,
        surfaces=list(_surfaces(results, shown)),
        figures=_by_category(item for item in all_items if item.shown.endswith(".png")),
        tables=sorted((item for item in all_items if item.category == "Tables"), key=_order),
        verdict=results.text("verdict.txt").strip() or _failed(checks),
        checks=checks,
        judged=bool(front_page.warning_pages(results, config)),
        warnings=list(front_page.warnings(results, config)),
        provenance=list(front_page.provenance(last, len(runs))),
        changes=yaml.safe_dump(changes, allow_unicode=True, sort_keys=False) if changes else "",
    )


def _computed(results, config):
    """Configuration without its pairs if a run of devices left them out."""
    if results.text("tables/table_3.csv") or not config.get("devices"):
        return config
    return config | {"run": config["run"] | {"pairs": []}}


def _failed(checks):
    """Sentences about checks of which some failed, as those of `stiction.report.checks.verdict`; empty without."""
    failed = [f"{check['name']}: {check['case']}: {check['message']}" for check in checks if check["passed"] != "True"]
    counted = f"{len(failed)} of {len(checks)} checks of the results failed. "
    return counted + "; ".join(failed) if failed else ""


def items(results: Present, rules: Iterable[Mapping[str, Any]]) -> Iterator[Item]:
    """Results wanted by the targets of a configuration, as far as the folder holds them."""
    for rule in rules:
        if not rule["shown"]:
            continue
        key, patterns = rule["shown"]["file"], rule["files"]
        targets = [path.removeprefix(RESULTS) for path in rule["wanted"]]
        for paths in zip(*(targets[k :: len(patterns)] for k in range(len(patterns))), strict=True):
            files = dict(zip(patterns, paths, strict=True))
            if results.has(files[key]):
                at = expression(patterns[key], WILDCARDS).fullmatch(RESULTS + files[key]).groupdict()
                ends = {Path(file).suffix[1:]: file for file in files.values() if results.has(file)}
                yield Item(rule["shown"]["category"], rule["shown"]["title"].format(**at), files[key], ends)


def _order(table):
    """Key that puts tables of the paper first and keeps the order of all others."""
    return _FIRST.index(table.shown) if table.shown in _FIRST else len(_FIRST)


def _by_category(figures: Iterable[Item]) -> dict[str, list[Item]]:
    """Figures by their category, in the order of the rules."""
    ordered: dict[str, list[Item]] = {}
    for figure in figures:
        ordered.setdefault(figure.category, []).append(figure)
    return ordered


def _devices(results: Present, config: Mapping, all_items: Sequence[Item]) -> Iterator[dict[str, Any]]:
    """Devices with their first answer, their page and the number of warnings, and a few with drawings."""
    pages, sections = {item.shown for item in all_items}, config.get("devices", {})
    from stiction.report.limits.words import line_of  # imports the physics

    limits = front_page.limits(results, config)
    lines = {(device.name, line_of(limit)) for limit, subjects in limits for device in subjects}
    warned = Counter(name for name, _ in lines)
    verdicts = {row["device"]: row for row in csv.DictReader(results.text("tables/devices.csv").splitlines())}
    for name, section in sections.items():
        verdict = verdicts.get(name, {})
        page, (answer, *_) = f"devices/{name}.html", [*results.text(f"devices/{name}.txt").splitlines(), ""]
        yield {
            "name": name,
            "kind": kind_of(section).words,
            "drawing": device_drawing(section, verdict.get("by_tip") == "True") if len(sections) <= _CARDS else "",
            "page": page if page in pages else "",
            "answer": answer,
            "tone": verdict.get("tone", ""),
            "warnings": warned[name],
        }


def _surfaces(results: Present, config: Mapping) -> Iterator[dict[str, Any]]:
    """Surfaces of the run: measured ones with their sheet and flags, others by their numbers."""
    flags = [flag.partition(": ") for flag in front_page.list_items(results.text("tables/scans.md"))]
    materials = Materials(config)
    for name in _surfaces_of_run(config):
        section, sheet = config["surfaces"][name], f"figures/surface_sheet_{name}.png"
        yield {
            "name": name,
            "described": surface_in_words(section, materials.stated(name)),
            "flags": [flag for surface, _, flag in flags if surface == name],
            "sheet": sheet if results.has(sheet) else "",
        }


def _surfaces_of_run(config: Mapping) -> list[str]:
    """Surfaces of the pairs and devices of a run, or those with scans if it has neither."""
    pairs = [*config["run"]["pairs"], *(device["pair"] for device in config.get("devices", {}).values())]
    sides = [config["pairs"][pair][side] for pair in pairs for side in SIDES]
    scanned = [name for name, section in config["surfaces"].items() if "scans" in section]
    return list(dict.fromkeys([*sides, *scanned]))
