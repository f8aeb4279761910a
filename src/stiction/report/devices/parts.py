"""Parts of the page of a device that its release decides: inputs, simulation, words, and controls."""

from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import yaml
from matplotlib.figure import Figure

from stiction.answer.data import Answer
from stiction.config.kinds import PULL_OFF, kind_of
from stiction.report.answer import figures as figures_answer
from stiction.report.budget import figures as figures_budget
from stiction.report.budget import tables as tables_budget
from stiction.report.devices import explorer, sentences, voltage_views
from stiction.report.devices import figures as figures_devices
from stiction.report.devices import tables as tables_devices
from stiction.report.limits.words import lines_with_numbers, texts
from stiction.report.page import Section
from stiction.stages.devices import device_warnings
from stiction.stages.devices.end_states import END_STATES
from stiction.stages.devices.results import charts_of, results_of
from stiction.stages.devices.stoppers import ends

#: Why a table of safe lengths has cells without a number.
_MISSING_LENGTHS = (
    "all drawn surfaces have the same tips, whose scatter is part of the error due to the number of beams, and the "
    "paper measured no tips; or too few beams stick for an estimate"
)
#: What is not inside a table of one stage.
_SIMULATED = (
    "Simulated limits: one touchdown, no voltage, and all inputs exact. The answer above has everything inside."
)
#: What a picture of places shows.
_PLACES = (
    "Fraction of measurements that give more than a force, of a place drawn at random, with the error of the measured "
    "force inside if one is stated; its band of 95 % contains the errors of simulation and inputs."
)
#: Terms that pages explain.
GLOSSARY = Path(__file__).with_name("terms.yaml")


@cache
def terms() -> dict[str, Any]:
    """Terms by part of a page."""
    return _read(yaml.safe_load(GLOSSARY.read_text(encoding="utf-8")))


def _read(entry):
    """Section of the glossary, or the text of a term with its parts joined."""
    if isinstance(entry, dict):
        return {name: _read(inner) for name, inner in entry.items()}
    return entry if isinstance(entry, str) else " ".join(entry)


class OfQuestion(NamedTuple):
    """Parts of the pages of devices that are asked one question, by functions of a device."""

    inputs: Callable[[Any, str], dict[str, Any]]  #: of the plan and its name
    #: First sections, sentences, warnings and terms, of its name, section, data and answer.
    parts: Callable[[str, Mapping, Mapping, Answer], tuple[list[Section], list[str], list[str], dict[str, str]]]
    views: Callable[[str, Mapping, Mapping, Answer], list[explorer.View]]  #: of the same
    figure: Callable[[str, Mapping], Figure]  #: by simulation alone, of its name and datasets


# Beams


def _inputs_of_beam(plan, device):
    """Safe lengths and charts by humidity."""
    return {"safe_lengths": results_of(plan, device, "lengths")["lengths"], "charts": charts_of(plan, device)}


def _cases(name, datasets):
    """Datasets by name and humidity."""
    return {(name, humidity): dataset for humidity, dataset in datasets.items()}


def _parts_of_beam(name, section, data, answer):
    """Parts of the page of a cantilever or bridge."""
    lengths, warnings = data["safe_lengths"], data["warnings"].lengths | data["warnings"].curves
    table = tables_devices.safe_lengths(_cases(name, lengths), warnings, data.get("errors")).cells
    pictures, cells = figures_devices.simulated(_cases(name, lengths), {}), table.drop(columns="device")
    sections = [Section("By simulation alone", (_SIMULATED,), cells, pictures, _MISSING_LENGTHS)]
    if data.get("charts"):
        axis = _cases(name, data["charts"])
        cells = tables_devices.chart(axis, warnings).cells.drop(columns="device")
        picture = figures_devices.chart(axis, warnings, {name: (*figures_devices.own_sizes(section), answer)})
        sections.append(Section("Other thicknesses and humidities", (), cells, picture))
    texts_of_cases = [*sentences.few_sentences(lengths), *sentences.prediction_sentences(lengths)]
    subjects = _other_beams(data["warnings"])
    listed = lines_with_numbers(warnings, sentences.shortest_warnings(section, answer), subjects)
    return sections, texts_of_cases, listed, _words_of_beam(data)


def _other_beams(warnings):
    """Beams of a chart in words, by the limits that those of the device itself do not have."""
    own = {limit for limits in warnings.lengths.values() for limit in limits}
    of_charts = device_warnings.subjects(warnings._replace(lengths={}, patches={}))
    return {limit: str(subject) for subject, limits in of_charts.items() for limit in limits if limit not in own}


def _words_of_beam(data):
    """Terms that the page of a beam explains."""
    lengths, words = data["safe_lengths"], terms()
    shapes = map(str, next(iter(lengths.values()))["shape"].values)
    held = {term: text for shape in shapes for term, text in END_STATES[shape].terms.items()}
    return (
        held
        | words["beams"]
        | {"Bound": tables_devices.about_bounds(lengths, **words["bounds"])}
        | (words["dry_air"] if any(float(dataset.film) == 0 for dataset in lengths.values()) else {})
        | (words["charts"] if data.get("charts") else {})
    )


def _views_of_beam(name, section, data, answer):
    """Views of a cantilever or bridge."""
    views = explorer.views_of_beam(name, section, data["safe_lengths"], data["charts"], answer)
    if "young_modulus_GPa" in section:
        views.append(explorer.beside(voltage_views.beam_view(name, section, data["safe_lengths"]), answer))
    return views


# Stoppers


def _parts_of_stopper(name, section, data, answer):
    """Parts of the page of a stopper."""
    stopper = data["stopper"]
    table = tables_budget.stoppers({name: stopper}, {name: []}, data.get("errors")).cells.drop(columns=["device"])
    picture = figures_budget.stoppers({name: stopper}, {}, {name: answer})
    sections = [Section("By simulation alone", (_SIMULATED,), table, picture)]
    worst = [sentences.worst_sentence(stopper)] if ends(stopper) else []
    texts_of_forces = [*sentences.safe_force_sentences(stopper, answer), *worst]
    words = terms()["stoppers"] | (terms()["probes"] if kind_of(section).shape else {})
    words |= terms()["worst_humidity"] if worst else {}
    return sections, texts_of_forces, texts(data["warnings"].patches[name]), words


def _views_of_stopper(name, section, data, answer):
    """Views of a stopper."""
    stopper, views = data["stopper"], explorer.views_of_stopper(section, data["stopper"], answer)
    if "tilted" in data:
        views.append(explorer.beside(explorer.tilted_view(name, section, data["tilted"], stopper), answer))
    if "biased" in data:
        views.append(explorer.beside(voltage_views.stopper_view(name, section, data["biased"]), answer))
    return views


# Probes without a spring


def _parts_of_places(name, _section, data, answer):
    """Parts of the page of a probe that is asked for its pull-off force."""
    picture = figures_answer.risk({name: answer})
    sections = [Section("Forces of the places", (_PLACES,), None, picture)]
    return sections, [], texts(data["warnings"].patches[name]), dict(terms()["probes"])


#: By the question about a device.
OF_QUESTION = {
    "beam": OfQuestion(
        _inputs_of_beam,
        _parts_of_beam,
        _views_of_beam,
        lambda name, datasets: figures_devices.simulated(_cases(name, datasets), {}),
    ),
    "stopper": OfQuestion(
        lambda plan, device: results_of(plan, device),
        _parts_of_stopper,
        _views_of_stopper,
        lambda name, datasets: figures_budget.stoppers({name: datasets["forces"]}, {}),
    ),
    PULL_OFF: OfQuestion(
        lambda plan, device: results_of(plan, device, "stopper"),
        _parts_of_places,
        lambda name, section, data, answer: [explorer.view_of_places(data["stopper"], answer)],
        lambda name, datasets: figures_budget.stoppers({name: datasets["forces"]}, {}),
    ),
}
