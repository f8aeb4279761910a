"""Scans without a simulation: a configuration of their surfaces alone, and sheets of refused ones."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from stiction.config import files, scans
from stiction.config.keys import Keys, Relations
from stiction.config.merging import expanded
from stiction.config.messages import ConfigError, schema_problems
from stiction.config.reading import paper
from stiction.config.relations import schema
from stiction.config.surfaces import process, profiles
from stiction.config.surfaces.process_relations import surfaces_of_processes_are_defined
from stiction.run.atomic import save_text

#: Configuration of the surfaces, and folder of their preliminary numbers, below the folder of a run.
_CONFIGURATION, _KEPT = Path(".snakemake", "scans.yaml"), Path(".snakemake", "scans")
#: Sections of a configuration that say what its surfaces are.
_ABOUT_SURFACES = ("surfaces", "scans", "seed", "process", "compare")


@dataclass(frozen=True)
class Alone:
    """Measured surfaces of a configuration."""

    overlay: dict[str, Any]  #: changes of the configuration of the paper: the surfaces that can be estimated
    refused: dict[str, tuple[dict, list[str]]]  #: section of every other surface, and why it cannot be estimated
    lines: tuple[str, ...] = ()  #: numbers of surfaces measured along lines, in words

    def write(self, directory: Path) -> str:
        """Write the configuration into the folder of a run, and return its path."""
        path = directory / _CONFIGURATION
        path.parent.mkdir(parents=True, exist_ok=True)
        save_text(yaml.safe_dump(self.overlay, allow_unicode=True), path)
        return str(path)


def alone(overlays: Iterable[str], directory: Path) -> Alone:
    """Surfaces described by scans in files of a configuration, those of settings included, each with its usable files.

    Raises
    ------
    ConfigError
        If a key of a surface or of a process is wrong on its own, or a process has no surface.
    """
    config, lines = _of_surfaces(files.joined(*overlays), directory / _KEPT)
    measured = {name: _entry(entry) for name, entry in config["surfaces"].items() if scans.is_measured(entry)}
    overlay = {"surfaces": measured, "scans": config["scans"], "seed": config["seed"], "run": {"pairs": []}}
    usable_entries, refused = {}, {}
    for name, entry in measured.items():
        usable, reasons = scans.usable(entry, config["scans"], directory / _KEPT)
        if usable is None:
            refused[name] = entry, reasons
        else:
            usable_entries[name] = usable
    return Alone(overlay | {"surfaces": usable_entries}, refused, lines)


def _of_surfaces(contents, folder):
    """Sections of the paper, with those about surfaces from a configuration and what it makes, and words of lines."""
    sections = paper() | {key: contents[key] for key in _ABOUT_SURFACES if key in contents} | {"run": {"pairs": []}}
    if faults := schema_problems(sections, schema()):
        raise ConfigError(*map(str, faults))
    of_lines, faults = profiles.evaluated(sections, folder)
    if faults:
        raise ConfigError(*map(str, faults))
    sections, _ = profiles.with_numbers(sections, folder)
    if compare := sections.pop("compare", None):
        changed = {path: values for path, values in compare.items() if path.partition(".")[0] in _ABOUT_SURFACES}
        sections |= {"compare": changed} if changed else {}
    config = process.with_surfaces(expanded(sections))
    faults = [
        *schema_problems(config, schema()),
        *Relations([surfaces_of_processes_are_defined]).problems(Keys({"process": {}} | config)),
    ]
    if faults:
        raise ConfigError(*process.in_settings(faults, config))
    return config, tuple(profiles.in_words(*line) for line in of_lines.items())


def _entry(entry: Mapping[str, Any]) -> dict[str, Any]:
    """Section of a surface without its material. Scans do not need it."""
    return {key: value for key, value in entry.items() if key != "material"}


def draw_refused(name: str, entry: Mapping[str, Any], reasons: Sequence[str], results: Path) -> Path:
    """Draw the sheet of a surface without an estimate, with the map of its first scan if one is readable."""
    from stiction.config.scans import readable
    from stiction.report.scans.figures import refused_sheet
    from stiction.report.style import save

    paths = [results / "figures" / f"surface_sheet_{name}.{ending}" for ending in ("pdf", "png")]
    paths[0].parent.mkdir(parents=True, exist_ok=True)
    save(refused_sheet(name, readable(entry), reasons), *paths)
    return paths[1]
