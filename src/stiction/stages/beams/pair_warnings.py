"""Results of pairs beyond the limits of the model, in sentences of `stiction.devices.limits`."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from stiction.beam.cantilever import Beam
from stiction.config.cases import Air
from stiction.config.units import in_si
from stiction.contact.environment import Water
from stiction.devices import limits
from stiction.plan.names import by_name, by_outcome
from stiction.plan.stage import Stage, select
from stiction.run.atomic import save_text
from stiction.run.markdown import literal
from stiction.stages.beams.cantilevers import Cantilevers, StripLength, cantilever, sections
from stiction.stages.beams.releases import ends_as, stuck_lengths
from stiction.stages.surfaces import surface_flags

#: Warnings by their subject, such as ``pair b, RH 0.67, G``.
Warnings = dict[str, list[str]]
#: Names of materials, each with the properties that are stated.
StatedProperties = Sequence[tuple[str, Sequence[str]]]
#: Plastic share of the contact area of a pair [-], and the mean pressure of its surfaces at which it is plastic [Pa].
Plastic = tuple[float, float]
NOT_STUDIED = (np.nan, np.nan)


@dataclass(frozen=True, kw_only=True)
class OfPairs(Cantilevers):
    """Nominal beams of all pairs, and their strips."""

    sampling: StripLength
    water: dict[str, Water]  #: by pair


def beam_warnings(beams: xr.Dataset, nominal: Beam, strip: float) -> list[str]:
    """Warnings about the beams of a case of the main line: dataset of stage beams, length of the strips [m]."""
    s_shaped = ends_as(beams, "S-shape")
    warnings = [limits.arcs_of_elements(float(ends_as(beams, "arc").mean()), strip)]
    if "longest_strip" in beams:
        warnings.append(limits.long_strips(strip, float(beams.longest_strip)))
    if s_shaped.any():
        mean = float(stuck_lengths(beams).mean())
        warnings += [
            limits.cut_off_mean(float(s_shaped.mean()), mean, nominal.length),
            limits.large_rotation(nominal.gap, mean),
            limits.stubby_beam(mean, nominal.thickness),
            limits.wide_beam(nominal.gap, nominal.width, nominal.thickness, mean),
        ]
    return limits.triggered(*warnings)


def contact_warnings(
    plastic: Plastic, materials: StatedProperties, effect: str = limits.SHORTER, remedy: str = limits.DISTANCE
) -> list[str | None]:
    """Warnings, or None, about the contact of a pair, with the remedy if its plasticity was not studied."""
    about = (limit(*material) for material in materials for limit in (limits.default_material, limits.spacer))
    return [limits.plastic_contact(*plastic, effect, remedy), *about]


def plastic_contact(plasticity: Mapping[str, xr.Dataset], pair: str) -> Plastic:
    """Plastic fraction of the contact of a pair and its pressure, from the datasets of study plasticity."""
    if pair not in plasticity:
        return NOT_STUDIED
    return float(plasticity[pair].plastic_share), float(plasticity[pair].pressure)


def main_line_warnings(
    beams: Mapping[tuple[str, float, str], xr.Dataset],
    plasticity: Mapping[str, xr.Dataset],
    materials: Mapping[str, StatedProperties],
    settings: OfPairs,
    remedy: str = limits.DISTANCE,
) -> Warnings:
    """Warnings about the main line, with the plasticity of studied pairs and a remedy for the others.

    Each pair has the names of its materials, each with the properties that are stated.
    """
    warnings = {
        f"pair {pair}": limits.triggered(
            _without_water(pair, beams, settings.water[pair]),
            *contact_warnings(plastic_contact(plasticity, pair), materials[pair], remedy=remedy),
        )
        for pair in settings.pairs
    }
    for (pair, humidity, model), dataset in beams.items():
        nominal = cantilever(settings, pair)
        film = limits.triggered(limits.thin_film(settings.water[pair].film(humidity)[0]))
        warnings[f"pair {pair}, {Air(humidity).words}, {model}"] = film + beam_warnings(
            dataset, nominal, settings.sampling.strip_length
        )
    return warnings


def _without_water(pair, cases, water):
    """Warning, or None, about a pair without water. All cases give pair, humidity and model."""
    wettest = max((humidity for of, humidity, _ in cases if of == pair), default=0.0)
    return limits.no_water(water.film(wettest)[0], wettest)


def film_warnings(cases: Collection[tuple[str, float, str]], water: Mapping[str, Water]) -> list[str]:
    """Warnings about pairs without water, and about films too thin for a liquid, at each humidity of a pair.

    The cases are pair, humidity and model.
    """
    by_subject = {f"Pair {pair}": _without_water(pair, cases, film) for pair, film in water.items()}
    for pair, humidity, _ in cases:
        by_subject[f"Pair {pair}, {Air(humidity).words}"] = limits.thin_film(water[pair].film(humidity)[0])
    return [f"{subject}: {sentence}" for subject, sentence in by_subject.items() if sentence]


def numbered(warnings: Mapping[Any, list[str]]) -> tuple[list[str], dict[Any, list[int]]]:
    """Different sentences in their order, and the numbers, from 1, of those of each subject.

    Examples
    --------
    >>> numbered({"a": ["x.", "y."], "b": ["y."]})
    (['x.', 'y.'], {'a': [1, 2], 'b': [2]})
    """
    sentences = list(dict.fromkeys(sentence for said in warnings.values() for sentence in said))
    return sentences, {key: [sentences.index(one) + 1 for one in said] for key, said in warnings.items()}


def with_numbers(warnings: Mapping[Any, list[str]]) -> list[str]:
    """Different sentences, each after its number."""
    return [f"({k}) {sentence}" for k, sentence in enumerate(numbered(warnings)[0], 1)]


def as_markdown(warnings: Warnings, not_modelled: str) -> str:
    """Warnings as a page, each sentence with all its subjects, and a sentence on effects not in the model."""
    sentences, _ = numbered(warnings)
    about = ["; ".join(name for name, said in warnings.items() if sentence in said) for sentence in sentences]
    lines = [f"- {literal(f'{names}: {sentence}')}" for names, sentence in zip(about, sentences, strict=True)]
    none = ["No result is beyond the limits of the model that are checked."]
    return "\n".join(["# Where results are beyond the model", "", *(lines or none), "", literal(not_modelled), ""])


def surface_notes(
    data: Mapping[str, Mapping[str, xr.Dataset]],
    surfaces: Mapping[str, Sequence[str]],
    assumed: Mapping[str, Sequence[str]] = {},
) -> Warnings:
    """Flags of the measured surfaces of every pair, and sentences on assumptions about the others.

    Datasets of ``surface_flags.inputs``, measured surfaces and sentences by pair.
    """
    flags = surface_flags.sentences(data)
    return {
        pair: [*(sentence for name in names for sentence in flags[name]), *assumed.get(pair, ())]
        for pair, names in surfaces.items()
    }


def _warnings(data, settings):
    """Warnings about all pairs as a page."""
    nominal = in_si(OfPairs, settings["pairs"])
    remedy = limits.DISTANCE if settings["plasticity_runs"] else limits.NAMED
    warnings = main_line_warnings(data["beams"], data["plasticity"], settings["materials"], nominal, remedy)
    for pair, flags in surface_notes(data, settings["surfaces"], settings["assumed"]).items():
        warnings[f"pair {pair}"] += flags
    return as_markdown(warnings, settings["not_modelled"])


STAGES = (
    Stage(
        name="model_limits",
        files={"markdown": "warnings.md"},
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
            | sections(plan, *plan.pairs),
            "materials": {pair: plan.materials.in_words(pair) for pair in plan.pairs},
            "plasticity_runs": "plasticity" in plan.studies,
            "not_modelled": plan.air.not_modelled((case.pair, case.humidity) for case in plan.cases),
            "surfaces": {pair: plan.scans.sides(pair) for pair in plan.pairs},
            "assumed": plan.assumptions(*plan.pairs),
        },
        compute=_warnings,
        save=lambda page, paths: save_text(page, paths["markdown"]),
        message="Where the results of pairs are beyond the model.",
        targets=("all",),
    ),
)
