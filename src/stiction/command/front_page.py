"""Front page of the report: the answer in words, the first files to open, checks, warnings and provenance.

Snakemake fills the page in as a template, with all that Jinja can do. Text of configurations, files and names is on the
page only as characters: HTML shows it as it is, and Jinja finds no brace in it.
"""

import csv
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from stiction.command.present import Present
from stiction.config.merging import differing
from stiction.config.reading import paper
from stiction.report.format import humidity_text, with_error
from stiction.report.html import rendered
from stiction.run.markdown import plain
from stiction.run.provenance import code_of, recorded_runs, start_of

if TYPE_CHECKING:
    from stiction.devices.limits.limit import Limit
    from stiction.stages.beams.pair_warnings import Subject

#: Where the command leaves the page for Snakemake, relative to the folder of the run.
FRONT = Path(".snakemake", "front.rst")
#: Braces as HTML reads them, but not Jinja.
_BRACES = str.maketrans({"{": "&#123;", "}": "&#125;"})
#: Stages whose results to open first: those of devices, if there are any, and of pairs.
_OF_DEVICES = ("device_page", "table_devices", "table_safe_lengths", "table_stoppers", "figure_risk")
_OF_PAIRS = ("table_3", "figure_overview", "table_scans", "table_1")
#: Surfaces and beams of the models, in words.
MODELS_IN_WORDS = {
    "G": "Gaussian surfaces",
    "NG": "non-Gaussian surfaces",
    "GEO": "non-Gaussian surfaces and beams of scattered dimensions",
}


def front_page(folder: Path) -> str:
    """Front page of the results of a finished run, as Snakemake takes it: HTML within reStructuredText."""
    runs, results = recorded_runs(folder / "provenance.json"), Present(folder)
    last, config = runs[-1], runs[-1]["config"]
    changes = differing(config, paper())
    page = rendered(
        "front.html",
        subjects=subjects(config),
        answers=list(answers(results, config)),
        pairs=pairs(results) if config["run"]["pairs"] else [],
        length=config["beam"]["length_um"],
        models=MODELS_IN_WORDS,
        opened=_first_results(results, config),
        checks=results.text("verdict.txt").strip() if config["run"]["pairs"] else None,
        warnings=list(warnings(results, config)),
        provenance=provenance(last, len(runs)),
        changes=yaml.safe_dump(changes, allow_unicode=True, sort_keys=False) if changes else "",
    )
    indented = "\n".join(f"   {line}" for line in page.splitlines())
    return f".. raw:: html\n\n{indented.translate(_BRACES)}\n"


def is_finished(results: Path) -> bool:
    """Whether a run has computed all pairs and devices of its configuration."""
    runs = recorded_runs(results / "provenance.json")
    if not runs:
        return False
    has_pairs = runs[-1]["config"]["run"]["pairs"]
    return (results / ("verdict.txt" if has_pairs else "devices/warnings.md")).exists()


def subjects(config: Mapping[str, Any]) -> str:
    """Pairs and devices of a configuration in words."""
    by_kind = {"pair": config["run"]["pairs"], "device": config.get("devices", {})}
    return " and ".join(
        f"{kind}{'s' * (len(names) > 1)} {', '.join(names)}" for kind, names in by_kind.items() if names
    )


def answers(results: Present, config: Mapping[str, Any]) -> Iterator[str]:
    """Yield the results about every device, a sentence each."""
    for name in config.get("devices", {}):
        yield f"Device {name}: {next(iter(results.text(f'devices/{name}.txt').splitlines()), 'not computed')}"


def pairs(results: Present) -> list[dict[str, str]]:
    """Ends of the beams of every pair in each air: a row of a table each, or nothing before Table III is computed."""
    rows = csv.DictReader(results.text("tables/table_3.csv").splitlines())
    return [ends(row) for row in rows if row["model"] == "NG"]


def ends(row: Mapping[str, str]) -> dict[str, str]:
    """Ends of the beams of a pair in one air, from their row of Table III.

    Examples
    --------
    >>> shares = {"share_s_shape": "0.98", "share_arc": "0.02", "share_free": "0"}
    >>> row = {"pair": "b", "relative_humidity": "0.67", "crack_length_um": "685.7", "crack_length_std_um": "16.28"}
    >>> list(ends(row | shares).values())
    ['b', '0.67', '98', '686 ± 16', '2']
    """
    stuck, arcs = (f"{100 * float(row[f'share_{state}']):.3g}" for state in ("s_shape", "arc"))
    crack = (float(row[name] or "nan") for name in ("crack_length_um", "crack_length_std_um"))
    return {
        "pair": row["pair"],
        "RH": humidity_text(float(row["relative_humidity"])),
        "stuck behind a crack (S-shape) [%]": stuck,
        "crack [µm]": with_error(*crack),
        "stuck at the tip alone (arc) [%]": arcs,
    }


def _first_results(results, config):
    """Results to open first, by category and title in the menu of the report."""
    from stiction.plan.graph import stages  # imports the physics

    devices = config.get("devices", {})
    for name in (*(_OF_DEVICES if devices else ()), *(_OF_PAIRS if config["run"]["pairs"] else ())):
        stage, _ = stages()[name]
        file, title = stage.files[stage.shown.file], stage.shown.title
        for device in devices if "{device}" in file else [""]:
            if results.has(file.format(device=device)):
                yield f"{stage.shown.category} › {title.format(device=device)}"


def warnings(results: Present, config: Mapping[str, Any]) -> list[str]:
    """Sentences about results beyond the limits of the model."""
    from stiction.report.limits.pages import sentences  # imports the physics

    return sentences(dict(limits(results, config)))


def limits(results: Present, config: Mapping[str, Any]) -> Iterator["tuple[Limit, list[Subject]]"]:
    """Limits of results, each with its subjects."""
    from stiction.report.limits.pages import of_json  # imports the physics

    for page in warning_pages(results, config):
        yield from of_json(results.text(str(Path(page).with_suffix(".json"))))


def warning_pages(results: Present, config: Mapping[str, Any]) -> list[str]:
    """Pages of warnings about the pairs and devices of a configuration, as far as they have been written."""
    pages = {"warnings.md": config["run"]["pairs"], "devices/warnings.md": config.get("devices")}
    return [page for page, subjects in pages.items() if subjects and results.has(page)]


def list_items(markdown: str) -> Iterator[str]:
    """Items of the lists of a page in Markdown, as their characters."""
    return (plain(line.removeprefix("- ")) for line in markdown.splitlines() if line.startswith("- "))


def provenance(run: Mapping[str, Any], number: int) -> Iterator[str]:
    """Date, code, machine and scans of a run from its record, the last of a number of runs."""
    before = f", the last of {number} runs" if number > 1 else ""
    yield f"Started {start_of(run)}{before}; all are in results/provenance.json."
    yield from code_of(run)
    if run["git"] and run["git"]["untracked"]:
        yield f"Files that are untracked in its folder: {', '.join(run['git']['untracked'])}"
    yield f"{run['machine']['system']}, {run['machine']['cpu']}, {run['machine']['cores']} cores"
    libraries = {name: version for name, version in run["versions"].items() if version and name != "stiction"}
    yield ", ".join(f"{name} {version}" for name, version in libraries.items())
    for name, surface in run["config"]["surfaces"].items():
        if "scans" in surface:
            yield f"Scans of {name}: {', '.join(Path(file).name for file in surface['scans']['files'])}"
