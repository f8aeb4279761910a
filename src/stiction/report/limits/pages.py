"""Pages of all limits of pairs, or devices, and their files for other programs, which the last lines of a run count."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

from stiction.config.units import in_si
from stiction.devices.limits.limit import Limit, restored
from stiction.plan.names import by_name, by_outcome
from stiction.plan.stage import Stage, select
from stiction.report.limits import words
from stiction.run.atomic import save_text
from stiction.run.markdown import literal
from stiction.stages.beams.cantilevers import StripLength, sections
from stiction.stages.beams.pair_warnings import Limits, OfPairs, Subject, main_line_warnings, surface_notes
from stiction.stages.surfaces import surface_flags

#: Files of a page, below the folder of results.
FILES = {"markdown": "warnings.md", "json": "warnings.json"}


def by_limit(limits: Limits) -> dict[Limit, list[Subject]]:
    """Subjects of each different limit, in order."""
    subjects: dict[Limit, list[Subject]] = {}
    for subject, of_subject in limits.items():
        for limit in dict.fromkeys(of_subject):
            subjects.setdefault(limit, []).append(subject)
    return subjects


def sentence(limit: Limit, subjects: Sequence[Subject]) -> str:
    """Sentence on a limit after its subjects."""
    return f"{'; '.join(map(str, subjects))}: {words.text(limit)}"


def sentences(subjects: Mapping[Limit, Sequence[Subject]]) -> list[str]:
    """Sentences on different limits: of a device with many steep lengths, one on the steepest."""
    lines: dict[Any, list[Limit]] = {}
    for limit, named in subjects.items():
        names = {subject.name for subject in named}
        key = (words.line_of(limit), *names) if len(names) == 1 else limit
        lines.setdefault(key, []).append(limit)
    return [_of_worst(limits, subjects) for limits in lines.values()]


def _of_worst(limits, subjects):
    """Sentence on one limit, or on the worst of some."""
    if len(limits) == 1:
        return sentence(limits[0], subjects[limits[0]])
    worst = words.worst(limits)
    others = sum(len(subjects[limit]) for limit in limits) - len(subjects[worst])
    return f"{sentence(worst, subjects[worst])} This is the worst; {others} more results are beyond the same limit."


def as_markdown(limits: Limits, not_modelled: Mapping[str, Any]) -> str:
    """Page of limits, each sentence with all its subjects, and a sentence on effects not in the model."""
    lines = [f"- {literal(text)}" for text in sentences(by_limit(limits))]
    none = ["No result is beyond the limits of the model that are checked."]
    ends = literal(words.not_modelled(**not_modelled))
    return "\n".join(["# Where results are beyond the model", "", *(lines or none), "", ends, ""])


def as_json(limits: Limits) -> str:
    """Different limits, each with the names and words of its subjects."""
    stored = [{"subjects": subjects, **limit.stored()} for limit, subjects in by_limit(limits).items()]
    return json.dumps(stored, ensure_ascii=False, indent=1, allow_nan=False)


def of_json(text: str) -> list[tuple[Limit, list[Subject]]]:
    """Different limits with their subjects, the inverse of `as_json`; none of an empty text."""
    return [
        (restored(fields), [Subject(name, tuple(words_of_subject)) for name, words_of_subject in subjects])
        for stored in json.loads(text or "[]")
        for subjects, fields in [(stored.pop("subjects"), stored)]
    ]


def save(page: tuple[Limits, Mapping[str, Any]], paths: Mapping[str, str]) -> None:
    """Write a page of limits and missing effects."""
    save_text(as_markdown(*page), paths["markdown"])
    save_text(as_json(page[0]), paths["json"])


def _of_pairs(data, settings):
    """Limits of all pairs, and the effects that none of their results has."""
    nominal, is_listed = in_si(OfPairs, settings["pairs"]), settings["plasticity_runs"]
    limits = main_line_warnings(data["beams"], data["plasticity"], settings["materials"], nominal, is_listed)
    for pair, flags in surface_notes(data, settings["surfaces"], settings["assumed"]).items():
        limits[Subject(f"pair {pair}")] += flags
    return limits, settings["not_modelled"]


def _replicas(plan):
    """Settings of the replicas of pairs, none without one."""
    stated = {pair: replica["replica"] for pair in plan.pairs if (replica := plan.replica(pair))}
    return {"replicas": stated} if stated else {}


STAGES = (
    Stage(
        name="model_limits",
        files=FILES,
        inputs=lambda plan, at: (
            {
                "beams": by_outcome("beams", plan.outcomes),
                "plasticity": by_name("studies/plasticity", plan.pressed_pairs),
            }
            | surface_flags.inputs(plan, *plan.pairs)
        ),
        settings=lambda plan, at: {
            "pairs": {
                "sampling": select(StripLength, plan.config["sampling"]),
                "water": {pair: plan.air.water(pair) for pair in plan.pairs},
            }
            | sections(plan, *plan.pairs)
            | _replicas(plan),
            "materials": {pair: plan.materials.in_words(pair) for pair in plan.pairs},
            "plasticity_runs": "plasticity" in plan.studies,
            "not_modelled": plan.air.not_modelled((case.pair, case.humidity) for case in plan.cases),
            "surfaces": {pair: plan.scans.sides(pair) for pair in plan.pairs},
            "assumed": plan.limits_of_pairs(),
        },
        compute=_of_pairs,
        save=save,
        message="Limits of the model that pairs exceed.",
        targets=("all",),
    ),
)
