"""Section of the page of a device on its process."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import xarray as xr

from stiction.config.surfaces import process
from stiction.report.axes import figures, tables
from stiction.report.axes import process as sentences
from stiction.report.page import Page, Section
from stiction.stages.axes.recommended import ALL

#: Point of the first screen that has the settings.
CHANGE = "What to change"


def inputs(plan: Any, device: str) -> dict[str, Any]:
    """Names of the datasets of the process of a device, none without one."""
    named = process.processes_of(plan.config, device)
    if not named:
        return {}
    if process.is_mapped(plan.config, device):
        of_map = {"process_map": f"process/maps/{device}", "process_pairs": f"process/pairs/{device}"}
        return of_map | {"process_laws": [f"process/laws/{name}" for name in named]}
    variable = process.variable_of(plan.config, device)
    return {
        "process": f"process/curves/{device}",
        "process_settings": f"process/settings/{variable}",
        "process_laws": [f"process/laws/{name}" for name in named],
    }


def with_process(page: Page, device: str, data: Mapping[str, Any]) -> Page:
    """Page with the sufficient settings for its device, also on its first screen, or itself without a process."""
    if "process_laws" not in data:
        return page
    laws = data["process_laws"]
    if "process_map" in data:
        section = _of_pairs(device, data["process_map"], data["process_pairs"], laws)
        answer = sentences.pairs_briefly(data["process_pairs"])
    else:
        section = _section(device, data["process"], data["process_settings"], laws)
        answer = sentences.briefly(data["process_settings"], device)
    pictures = [Section(f"Law of {law.surface}", (), None, figures.laws(law)) for law in laws]
    summary = page.summary
    if summary and not page.is_forbidden:
        advice = " ".join(filter(None, [summary.points.get(CHANGE, ""), answer]))
        summary = replace(summary, points=summary.points | {CHANGE: advice})
    sections = [*page.sections, section, *pictures]
    return replace(page, summary=summary, answer=[answer, *page.answer], sections=sections)


def _of_pairs(device, curves, pairs, laws):
    """Answers about a device over two processes, with table and figure."""
    cells = tables.of_pairs({device: curves}, {}, {device: laws}).cells.drop(columns="device")
    texts = [*sentences.answers_of_pairs(pairs), *sentences.notes(curves, laws)]
    return Section("Which settings of the two processes?", texts, cells, figures.process_map(curves, pairs))


def _section(device: str, curve: xr.Dataset, settings: xr.Dataset, laws: Sequence[xr.Dataset]) -> Section:
    """Answers about one device and about all devices of its process, with table and figure."""
    who = [device, *([ALL] if ALL in settings.who.values else [])]
    texts = [sentence for name in who for sentence in sentences.answers(settings, name)]
    cells = tables.of_processes({device: curve}, [], {device: laws}).cells.drop(columns="device")
    figure = figures.devices(curve, settings, device)
    return Section("Which setting of the process?", [*texts, *sentences.notes(curve, laws)], cells, figure)
