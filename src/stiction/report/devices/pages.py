"""Pages of single devices for the report: the answer in words, tables, figures, warnings and terms."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from stiction.answer.data import Answer
from stiction.config.kinds import KEYS, ROUGHNESSES, kind_of
from stiction.config.merging import differing
from stiction.config.mission.conditions import CONDITIONS
from stiction.config.reading import paper
from stiction.config.scans import is_measured
from stiction.contact.air import DRY, Air
from stiction.devices.risk import one_in
from stiction.plan.stage import File, Shown, Stage
from stiction.report import drawings, html
from stiction.report.answer import figures as figures_answer
from stiction.report.answer import judged, screen
from stiction.report.answer import tables as tables_answer
from stiction.report.answer.words import stricter
from stiction.report.at_once import tables as tables_at_once
from stiction.report.axes import figures as figures_axes
from stiction.report.axes import roughness as sentences_roughness
from stiction.report.axes import section as process_section
from stiction.report.axes import tables as tables_axes
from stiction.report.budget import figures as figures_budget
from stiction.report.budget import tables as tables_budget
from stiction.report.devices import curve_views, explorer, life
from stiction.report.devices.parts import GLOSSARY, OF_QUESTION, terms
from stiction.report.format import MISSING, conditions_in_words, humidity_text
from stiction.report.limits.words import not_modelled, texts
from stiction.report.model_error import sentences as model_errors
from stiction.report.page import TEMPLATE, Page, Section
from stiction.report.style import STYLE, on_a_page
from stiction.report.surfaces.words import adhesion_in_words, replica_in_words, surface_in_words
from stiction.report.test_beams import figures as figures_test_beams
from stiction.report.test_beams import tables as tables_test_beams
from stiction.run import provenance
from stiction.run.atomic import save_text
from stiction.stages.axes.roughness import OF_COPIES
from stiction.stages.contact.adhesion_parameter import adhesion_parameters
from stiction.stages.devices import device_warnings
from stiction.stages.devices.budget import budgets_of
from stiction.stages.devices.opening import section_of_beam
from stiction.stages.devices.results import is_biased

#: What a map over two quantities shows.
_OF_MAPS = (
    "Blue: the requirement is met, by the factor at the colours. Solid line: the estimate meets it; dashed: the "
    "simulated limit does. Grey: the estimate meets it, but full contact of these smoother surfaces, in which more "
    "stick, is not computed. Dots: computed points; cross: the surface as it is given.",
)
#: Why a table of a budget has cells without a number.
_MISSING_EFFECTS = "this input does not act here, or too few of the simulated devices stick to show what it changes"
#: What a ladder shows.
_LADDER = (
    "Each row counts one cause more than the row above it, in the air and end state that are then the strictest. All "
    "but the estimate have a confidence of 95 %. Lines: the size to build, and yours (dotted)."
)
_LADDER_TO_BUILD = (
    "Build the size of the row that ends in “to build”: it counts all that you stated. A row below it is this size "
    "where something that you did not state happens as well."
)
_NO_ERROR = "Not inside: the error of the model of the contact, which study full_contact computes."


def device_page(name: str, section: Mapping[str, Any], data: Mapping[str, Any], answer: Answer) -> Page:
    """Page of a device, from its section of the configuration, its datasets and its answer.

    Of the data, ``safe_lengths`` and ``charts`` of a beam are by humidity, ``budgets`` by humidity and more, and
    ``warnings`` are those of `stiction.stages.devices.device_warnings.read`. A ``stopper`` has one dataset. Charts,
    budgets, ``test_beams``, ``errors`` of the model and ``roughness`` may be missing.
    """
    sections, sentences, listed, words = _of_question(section).parts(name, section, data, answer)
    budgets, errors, test_beams, roughness = (data.get(key) for key in ("budgets", "errors", "test_beams", "roughness"))
    of_model, notes = model_errors.sentences(name, errors), []
    limits = judged.limits_of(name, data["warnings"])
    if test_beams is not None:
        of_beams = tables_test_beams.warnings(test_beams)
        notes, listed, limits = [tables_test_beams.notes(test_beams)], listed + texts(of_beams), [*of_beams, *limits]
    forbidding = texts(dict.fromkeys(limit for limit in limits if limit.forbids))
    first, *others = of_model or [_NO_ERROR]
    of_first, below = ("", [first, *others]) if of_model and answer.is_by_tip else (first, others)
    shown = screen.screen(answer, section, forbidding, of_first)
    briefly = [] if roughness is None else sentences_roughness.briefly(roughness)
    sentences = [*sentences, *filter(None, notes), *briefly, *below]
    sections = [*_steps(answer), *sections, *_sure(name, budgets or {}, errors), *_test_beam_sections(name, test_beams)]
    sections += _how_rough(name, roughness)
    terms = words | _words_of_budgets(budgets)
    title = f"{name}: {kind_of(section).words}"
    return Page(title, _facts_of(section), sentences, sections, listed, terms, summary=shown, more=sentences)


def _steps(answer):
    """Section with the steps from the estimate to the size to build, none where no size is known."""
    if not answer.known_steps:
        return []
    ladder = tables_answer.steps(answer), figures_answer.ladder(answer)
    text = [_LADDER] if answer.forbidden else [_LADDER, _LADDER_TO_BUILD]
    if sizes := stricter(answer):
        text.append(f"Stricter, whether it is a row or not: {', '.join(sizes)}.")
    return [Section("From the estimate to the answer", text, *ladder)]


def _words_of_budgets(budgets):
    """Terms used by the budgets."""
    if not budgets:
        return {}
    words = dict(terms()["budgets"])
    choices = [str(name) for budget in budgets.values() for name in budget.choice.values]
    for start, of_choice in terms()["choices"].items():
        words |= of_choice if any(name.startswith(start) for name in choices) else {}
    return words


def _facts_of(section):
    """Dimensions and conditions of a device, by name."""
    facts = {"surfaces": f"pair {section['pair']}"} | section.get("surfaces", {})
    if "adhesion_parameters" in section:
        facts["adhesion parameter θ"] = adhesion_in_words(section["adhesion_parameters"])
    stated = kind_of(section).stated(section)
    for key in (key for key in KEYS if key in stated):
        (name, unit), value = KEYS[key], stated[key]
        values = value if isinstance(value, list) else [value]
        facts[name] = f"{' x '.join(f'{value:g}' for value in values)} {unit}"
    if "tip_edge" in section:
        facts["edge of the tip"] = section["tip_edge"]
    if CONDITIONS in section:
        facts["conditions"] = conditions_in_words(section[CONDITIONS])
    name = "relative humidities" if len(section["humidities"]) > 1 else "relative humidity"
    facts[name] = ", ".join(map(humidity_text, section["humidities"]))
    return facts | _requirement(section)


def _of_question(section):
    """Parts of pages by the question about a device."""
    return OF_QUESTION[kind_of(section).question(section)]


def _requirement(section):
    """Requirement of a device and its range of roughness, by name, or nothing without a requirement."""
    if "requirement" not in section:
        return {}
    required, over = section["requirement"], section.get("roughness", {})
    length = f"{required['length_um']:g} µm long, " if "length_um" in required else ""
    requirement = {"requirement": f"{length}at most {one_in(required['share'])} sticks"}
    if not over:
        return requirement
    ranges = (
        f"{quantity.words} from {over[key][0]:g} to {over[key][1]:g}{quantity.unit}"
        for key, quantity in ROUGHNESSES.items()
        if key in over
    )
    return requirement | {f"roughness of {over['surface']} asked for": ", ".join(ranges)}


def _sure(name, budgets, errors):
    """Section on the uncertainty of the result and on measurements, none if no input is uncertain."""
    if not budgets:
        return []
    cases = {(name, *key): dataset for key, dataset in budgets.items()}
    sentences = [
        f"{Air(humidity).choose(f'Relative humidity {humidity:g}', 'Dry air')}: {tables_budget.what_to_measure(budget)}"
        for (humidity, *_), budget in budgets.items()
    ]
    sentences.append(tables_budget.counted_as_exact(*budgets.values()))
    cells, drawn = _side_by_side(tables_budget.cells_of_page(cases, errors)), figures_budget.budget(cases)
    return [Section("Uncertainty, and what should be measured better", sentences, cells, drawn, _MISSING_EFFECTS)]


def _test_beam_sections(name, update):
    """Section on the evidence of the test beams of a device, if it has some."""
    if update is None:
        return []
    sentences = [
        tables_test_beams.agreement(update),
        *tables_test_beams.combinations(update),
        tables_test_beams.beams_to_add(update),
    ]
    sentences += [tables_test_beams.again(update), *tables_test_beams.stuck_sentences(update)]
    cells = tables_test_beams.test_beams({name: update}).cells.drop(columns="device")
    return [
        Section("What the test beams say", [*filter(None, sentences)], cells, figures_test_beams.test_beams(update))
    ]


def _how_rough(name, roughness):
    """Section on how rough a surface must be, none without a requirement."""
    if roughness is None:
        return []
    cells = tables_axes.of_roughness({name: roughness}).cells.drop(columns="device")
    of_map = "other" in roughness.dims
    sentences = [*sentences_roughness.answers(roughness), sentences_roughness.form(roughness)]
    question = "How closely may it follow?" if roughness.key in OF_COPIES else "How rough must it be?"
    sections = [Section(question, sentences, cells, figures_axes.roughness(roughness))]
    if of_map:
        sections.append(Section("Over two quantities", _OF_MAPS, None, figures_axes.roughness_map(roughness)))
    return sections


def _side_by_side(cells):
    """Cells of the budget of one device with a pair of columns for every humidity.

    What holds the device has no column if it is one thing alone.
    """
    keys = ["what", *(["held by"] if cells["held by"].nunique() > 1 else [])]
    shown = [
        effects.set_index(keys)[["effect [%]", "remaining [%]"]].add_prefix(
            f"{text if text == DRY else f'RH {text}'}: "
        )
        for text, effects in cells.groupby("RH", sort=False)
    ]
    return pd.concat(shown, axis=1).fillna(MISSING).reset_index()


def _inputs(plan, at):
    """Inputs of the page of a device."""
    devices, section = plan.devices, plan.config["devices"][at.device]
    budgets = budgets_of(plan, at.device) if at.device in devices.with_budget else {}
    inputs = {"answer": f"devices/answer/{at.device}"}
    inputs |= {"life": f"devices/life/{at.device}"} if at.device in devices.with_life else {}
    inputs |= {"budgets": {key[1:]: name for key, name in budgets.items()}}
    inputs |= {"warnings": device_warnings.files_of(at.device)[at.device]} | model_errors.error_inputs(plan, at.device)
    folders = {"test_beams": "devices/test_beams/rerun", "roughness": "devices/roughness"}
    inputs |= {key: f"{folder}/{at.device}" for key, folder in folders.items() if key in section}
    inputs |= process_section.inputs(plan, at.device) | tables_at_once.inputs(plan, at.device)
    inputs |= {"style": File(STYLE), "templates": [File(GLOSSARY), *html.files(TEMPLATE), *drawings.FILES]}
    return inputs | _of_question(section).inputs(plan, at.device)


def _settings(plan, at):
    """Section of a device, and its surfaces in words."""
    section = plan.config["devices"][at.device]
    pair = plan.config["pairs"][section["pair"]]
    names = {"surface of the device": pair["beam"], "surface of the substrate": pair["substrate"]}
    materials = list(map(plan.materials.stated, names.values()))
    surfaces = {
        side: f"{name}: {surface_in_words(plan.config['surfaces'][name], material)}"
        for (side, name), material in zip(names.items(), materials, strict=True)
    }
    if "replica" in pair:
        surfaces["surface of the device"] += f", {replica_in_words(pair['replica'])}"
    left_out = {"not_modelled": device_warnings.not_modelled(plan, at.device)}
    assumed = plan.devices.assumed_inputs(at.device)
    measured = [name for name in names.values() if is_measured(plan.config["surfaces"][name])]
    parameters = adhesion_parameters(plan, plan.air_of_devices, section["pair"], section["humidities"])
    further = {"assumed": assumed, "measured": measured, "adhesion_parameters": list(parameters.values())}
    if plan.devices.kind(at.device).has_tip:
        further["tip_edge"] = plan.devices.edge_in_words
    if plan.devices.kind(at.device).has_tip and is_biased(plan, at.device):
        further["young_modulus_GPa"] = section_of_beam(plan, at.device)["young_modulus_GPa"]
    return section | {"surfaces": surfaces} | left_out | {key: value for key, value in further.items() if value}


@on_a_page()
def _page(data, at, settings):
    """Page of a device."""
    data = dict(data) | {"warnings": device_warnings.read({at.device: data["warnings"]})}
    answer = judged.judged(data["answer"], data["warnings"])
    page, views = device_page(at.device, settings, data, answer), _of_question(settings).views
    views = [*views(at.device, settings, data, answer), *curve_views.views(at.device, settings, data)]
    page = with_life(page, at.device, data["life"], answer) if "life" in data else page
    page = process_section.with_process(page, at.device, data)
    page = tables_at_once.with_estimate(page, data)
    return replace(
        page,
        not_modelled=not_modelled(**settings["not_modelled"]),
        drawing=drawings.device_drawing(kind_of(settings).stated(settings), answer.is_by_tip),
        explorer=explorer.content(at.device, settings, views),
    )


def with_life(page: Page, name: str, answers: xr.Dataset, answer: Answer) -> Page:
    """Page with the life of its device: in words, and after the first section as table and figure.

    The first screen names what does not allow the size to build.
    """
    first, *others = page.sections
    cells = _numbers_first(life.table({name: answers}).cells.drop(columns="device"))
    build = np.nan if answer.forbidden else answer.build
    picture = life.figure({name: answers}, {name: None if answer.forbidden else answer})
    section = Section("From the first contact to the last", (life.CAPTION,), cells, picture)
    sentences, sections = life.sentences(answers, build, bool(answer.stays)), [first, section, *others]
    summary = page.summary and replace(page.summary, basis=[*page.summary.basis, *life.judged_without(answer)])
    return replace(
        page, answer=[*sentences, *page.answer], more=[*sentences, *page.more], sections=sections, summary=summary
    )


def _numbers_first(cells):
    """Cells of a life with what a row is about and its numbers before all else, for narrow pages."""
    later = ["question", "form", "source"]
    return cells[[*cells.columns.difference(later, sort=False), *later]]


def _save(page, paths):
    """Write a page with the date, code and study of the last run, and its answer, a sentence a line.

    Their record is no input of the page, so that a run with nothing else to do keeps page and date.
    """
    record = Path(paths["html"]).parents[1] / "provenance.json"
    study = differing(provenance.recorded_runs(record)[-1]["config"], paper())
    explorer = page.explorer and page.explorer | {"study": {key: study[key] for key in study if key != "devices"}}
    save_text(replace(page, run=provenance.last_run(record), explorer=explorer).html, paths["html"])
    save_text("".join(f"{html.with_minus(sentence)}\n" for sentence in page.lines), paths["answer"])


STAGES = (
    Stage(
        name="device_page",
        files={"html": "devices/{device}.html", "answer": "devices/{device}.txt"},
        inputs=_inputs,
        settings=_settings,
        compute=_page,
        save=_save,
        shown=Shown(file="html", title="{device}: what to build", category="Devices"),
        message="Page of device {device}.",
        jobs=lambda plan: [{"device": name} for name in plan.devices.sections],
        targets=("devices",),
    ),
)
