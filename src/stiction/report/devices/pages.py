"""Pages of single devices for the report: the answer in words, tables, figures, warnings and terms."""

import base64
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from html import escape
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.figure import Figure

from stiction.config.cases import DRY, case_id
from stiction.config.kinds import KEYS, ROUGHNESSES, kind_of
from stiction.config.materials import material_of
from stiction.plan.names import by_case
from stiction.plan.stage import File, Shown, Stage
from stiction.report.budget import figures as figures_budget
from stiction.report.budget import tables as tables_budget
from stiction.report.devices import figures as figures_devices
from stiction.report.devices import tables as tables_devices
from stiction.report.format import MISSING, UM, UN, airs, humidity_text
from stiction.report.model_error import sentences as model_errors
from stiction.report.roughness import figures as figures_roughness
from stiction.report.roughness import tables as tables_roughness
from stiction.report.style import STYLE, png
from stiction.report.test_beams import figures as figures_test_beams
from stiction.report.test_beams import tables as tables_test_beams
from stiction.run import provenance
from stiction.run.atomic import save_text
from stiction.stages.beams import pair_warnings
from stiction.stages.devices import device_warnings
from stiction.stages.devices.budget import budget_of, budgets_of
from stiction.stages.devices.end_states import END_STATES
from stiction.stages.devices.opening import EITHER
from stiction.stages.devices.stoppers import ends, in_any_air, is_at_an_end, shares_stuck

_PAGE = """<!DOCTYPE html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>
body {{ font: 15px/1.45 sans-serif; max-width: 62em; margin: 1.5em auto; padding: 0 1em }}
h1 {{ font-size: 1.5em }} h2 {{ font-size: 1.15em; margin-top: 1.6em }}
table {{ border-collapse: collapse; margin: .6em 0 }}
td, th {{ padding: 2px 12px; text-align: right; border-bottom: 1px solid #ddd }}
td:first-child, th:first-child {{ text-align: left }}
td {{ white-space: nowrap }} .facts td {{ white-space: normal; text-align: left }}
img {{ max-width: 100% }} .table {{ overflow-x: auto }}
.answer {{ font-size: 1.1em; border-left: 4px solid #0072B2; padding: .2em 1em }}
.made {{ font-size: .85em; color: #555; margin-top: 2em }}
.warning {{ border-left: 4px solid #D55E00; padding: .2em 1em }}
dt {{ font-weight: bold }} dd {{ margin: 0 0 .5em 1.5em }}
</style>
<h1>{title}</h1>
{body}
</html>
"""
#: Pixels of a page for one inch of a figure, and most rows of a table that is not folded.
_PIXELS, _ROWS = 120, 30


@dataclass(frozen=True)
class Section:
    """Part of a page: paragraphs, a table and a figure, each of which may be missing."""

    title: str
    paragraphs: Sequence[str] = ()
    cells: pd.DataFrame | None = None
    figure: Figure | None = None


@dataclass(frozen=True)
class Page:
    """Everything that the page of a device shows."""

    title: str
    facts: Mapping[str, str]  #: dimensions and conditions, by name
    answer: Sequence[str]  #: sentences at the top, the first of which is the verdict
    sections: Sequence[Section] = ()
    warnings: Sequence[str] = ()  #: where the model ends for this device
    words: Mapping[str, str] = field(default_factory=dict)  #: terms and what they mean
    made: Sequence[str] = ()  #: when and by which code
    not_modelled: str = ""  #: what is not in the model

    @property
    def html(self) -> str:
        """The page as one file: figures are part of it."""
        parts = [_answer(self.answer), _facts(self.facts), *map(_section, self.sections)]
        parts += ["<h2>Limits of this prediction</h2>", _block("warning", [*self.warnings, self.not_modelled])]
        parts += ["<h2>Terms</h2>", _words(self.words), _block("made", self.made)]
        return _PAGE.format(title=escape(self.title), body="\n".join(parts))


def _answer(sentences):
    """The verdict in bold, and what it rests on."""
    verdict, *reasons = sentences
    return f'<div class="answer"><p><strong>{escape(verdict)}</strong></p>\n{_paragraphs(reasons)}</div>'


def _block(kind, sentences):
    return f'<div class="{kind}">{_paragraphs(sentences)}</div>'


def _paragraphs(sentences):
    return "\n".join(f"<p>{escape(sentence)}</p>" for sentence in sentences)


def _facts(facts):
    rows = "".join(f"<tr><td>{escape(name)}</td><td>{escape(value)}</td></tr>" for name, value in facts.items())
    return f'<table class="facts">{rows}</table>'


def _section(section):
    parts = [f"<h2>{escape(section.title)}</h2>", _paragraphs(section.paragraphs)]
    if section.cells is not None:
        table = f'<div class="table">{section.cells.to_html(index=False, border=0)}</div>'
        folded = f"<details><summary>Table of {len(section.cells)} rows</summary>{table}</details>"
        parts.append(table if len(section.cells) <= _ROWS else folded)
    if section.figure is not None:
        picture, width = base64.b64encode(png(section.figure)).decode(), round(_PIXELS * section.figure.get_figwidth())
        parts.append(f'<img alt="{escape(section.title)}" width="{width}" src="data:image/png;base64,{picture}">')
    return "\n".join(parts)


def _words(words):
    return "<dl>" + "".join(f"<dt>{escape(term)}</dt><dd>{escape(text)}</dd>" for term, text in words.items()) + "</dl>"


# Devices


#: What a map over two quantities shows.
_OF_MAPS = (
    "Blue: the requirement is met, by the factor of which the decimal logarithm is shown. Solid line: the estimate "
    "meets it; dashed: the safe value does, with a confidence of 95 %. Dots: computed points; cross: the surface as it "
    "is given.",
)
#: Keys of a surface, what they are called and their unit.
_OF_SURFACES = {
    "rms_nm": ("rms", " nm"),
    "skewness": ("skewness", ""),
    "kurtosis": ("kurtosis", ""),
    "mean_summit_radius_um": ("mean radius of summits", " µm"),
    "summit_density_per_um2": ("density of summits", " per µm²"),
}
#: The same of its material.
_OF_MATERIALS = {"contact_angle_deg": ("contact angle", "°"), "coating_nm": ("coating", " nm")}
#: What shares are of.
_TOUCHDOWNS = (
    "The share p is that of one touchdown at one humidity. Of devices that touch n times and meet other summits each "
    "time, the share 1 - (1 - p)^n sticks, about n p: for a share q after n touchdowns, or at n humidities, take "
    "p = q / n. Devices that meet the same summits each time stick at the first touchdown or never."
)
_OF_BEAMS = {
    "Safe length": (
        "Largest length at which at most the stated share sticks, with a confidence of 95 %. The confidence is that of "
        "the simulated beams, given the drawn surfaces. The error due to the number of drawn surfaces is next to the "
        "estimate (se, surfaces), the uncertainty due to the measurements further below. The least of the lengths at "
        "several humidities is safe at all of them with at least 95 %; that every one of n lengths is safe at its own, "
        "with at least 100 - 5 n %."
    ),
    "P(stuck), share": _TOUCHDOWNS,
    "Estimate": "Length at which exactly the stated share sticks, as well as it is known; it is no bound.",
    "Sampled, fitted, extrapolated": (
        "What a length rests on: simulated beams alone; a line through the shortest 5 % of them, within what many more "
        "beams, tips and bridges on the surfaces of the paper's pair b confirmed; or that line beyond it."
    ),
}
_BOUND = (
    "Of a cantilever: the length that sticks where water fills all gaps. A single tip may hold a shorter one, "
    "where its roughness follows its slope. Of a bridge: the length up to which no surfaces hold it at this "
    "humidity, not even flooded flats in contact."
)
_DRY_BOUND = (
    "Of a cantilever: the length that sticks on flats in contact. A single tip may hold a shorter one, where its "
    "roughness follows its slope. Of a bridge: the length up to which no surfaces hold it, not even flats in contact."
)
_WHERE_DRY = "In dry air: that of flats in contact."
_IN_DRY_AIR = {
    "Dry air": "No water condenses: the surfaces attract each other alone, where they touch and across gaps.",
}
_OF_CHARTS = {
    "Finite elements, power law": (
        "Lengths of simulated beams, or a power of thickness and gap between them, with its largest error at simulated "
        "beams that it had to predict."
    ),
}
_OF_STOPPERS = {
    "Pull-off force": (
        "Largest force with which the two surfaces hold each other while they are separated: pressure times area, for "
        "an area that moves as a whole. One that tilts, or is so large that it bends, comes off part by part and holds "
        "less: for it, this force is an upper bound."
    ),
    "P(stuck)": f"Share of equal stoppers whose pull-off force exceeds the restoring force. {_TOUCHDOWNS}",
    "Safe force": (
        "Restoring force that is exceeded by the pull-off force of at most the stated share of stoppers, with a "
        "confidence of 95 %. The largest of the forces at several humidities suffices at all of them with at least "
        "95 %; that every one of n forces suffices at its own, with at least 100 - 5 n %."
    ),
}
_WORST = {"Worst humidity": "Humidity of the largest mean pull-off force. Wetter air wets more area, but pulls less."}
_OF_BUDGETS = {
    "Effect": "Standard uncertainty of the result due to one measurement, if all others were exact.",
    "Remaining": "Standard uncertainty of the result if this measurement were exact.",
    "Scatter between devices": "How much equal devices differ. A better measurement does not reduce it.",
}
#: Terms of other choices of the model, by the start of their names; all have the first.
_OF_CHOICES = {
    "": ("Choice of the model", "What another assumption of the theory would change. It has no distribution."),
    "van_der_waals": (
        "Van der Waals in dry gaps, or none",
        "The force between the solids as through air instead of water, or left out.",
    ),
    "psd": ("Spectrum from summits", "Spectrum chosen for the measured summits, instead of the published one."),
    "spacing": ("Grid", "Distance of the points at which the surfaces are drawn; summits are found on these points."),
    "every": ("Grid", "Distance of the points at which the surfaces are drawn; summits are found on these points."),
}


def of_beam(
    name: str,
    section: Mapping,
    safe_lengths: Mapping[float, xr.Dataset],
    charts: Mapping[float, xr.Dataset],
    budgets: Mapping[tuple, xr.Dataset],
    warnings: Mapping[tuple, Sequence[str]],
    test_beams: xr.Dataset | None = None,
    errors: Mapping[str, xr.Dataset] | None = None,
    roughness: xr.Dataset | None = None,
) -> Page:
    """Page of a cantilever or bridge.

    Parameters
    ----------
    name : str
    section : dict
        Its section of the configuration.
    safe_lengths, charts : dict
        Humidity to the datasets of the stages safe_lengths and chart; the latter may be empty.
    budgets : dict
        Humidity and, for tips, more to the dataset of stage budget; may be empty.
    warnings : dict
        Where the model ends: ``lengths`` and ``curves`` of `stiction.stages.devices.device_warnings.OfDevices`.
    test_beams, roughness : Dataset, optional
        Of stages test_beams_rerun and roughness.
    errors : dict, optional
        Name of the device to the dataset of stage device_model_error.
    """
    cases = {(name, humidity): dataset for humidity, dataset in safe_lengths.items()}
    table = tables_devices.safe_lengths(cases, warnings, errors).cells.drop(columns="device")
    sections = [Section("How long may it be?", (), table, figures_devices.risk(cases, {}))]
    if charts:
        axis = {(name, humidity): dataset for humidity, dataset in charts.items()}
        table = tables_devices.chart(axis, warnings).cells.drop(columns="device")
        sections.append(Section("Other thicknesses and humidities", (), table, figures_devices.chart(axis, {})))
    sections += _sure(name, budgets, errors)
    answer = [build_sentence(safe_lengths, budgets), *_rough_enough(roughness)]
    if test_beams is not None:
        sections.append(_of_test_beams(name, test_beams))
        answer.append(tables_test_beams.built(test_beams))
    answer += [safe_sentence(humidity, dataset) for humidity, dataset in safe_lengths.items()]
    answer += model_errors.sentences(name, errors)
    sections += _how_rough(name, roughness)
    listed = pair_warnings.with_numbers(warnings)
    listed += [] if test_beams is None else tables_test_beams.warnings(test_beams)
    shapes = next(iter(safe_lengths.values()))["shape"].values
    held = {term: text for shape in shapes for term, text in END_STATES[str(shape)].terms.items()}
    words = (
        held
        | _OF_BEAMS
        | {"Bound": tables_devices.about_bounds(safe_lengths, _BOUND, _DRY_BOUND, _WHERE_DRY)}
        | (_IN_DRY_AIR if any(float(dataset.film) == 0 for dataset in safe_lengths.values()) else {})
        | (_OF_CHARTS if charts else {})
        | _words_of_budgets(budgets)
    )
    return Page(_title(name, section), _facts_of(section), answer, sections, listed, words)


def of_stopper(
    name: str,
    section: Mapping,
    stopper: xr.Dataset,
    budgets: Mapping[tuple, xr.Dataset],
    warnings: Sequence[str],
    test_beams: xr.Dataset | None = None,
    errors: Mapping[str, xr.Dataset] | None = None,
    roughness: xr.Dataset | None = None,
) -> Page:
    """Page of a stopper; parameters as in `of_beam`, with one dataset of stage stoppers and a list of warnings."""
    table = tables_budget.stoppers({name: stopper}, {name: []}, errors).cells.drop(columns=["device"])
    sections = [Section("Does the restoring force suffice?", (), table, figures_budget.stoppers({name: stopper}, {}))]
    sections += [*_sure(name, budgets, errors), *_how_rough(name, roughness)]
    answer, listed = [verdict(stopper), *_rough_enough(roughness)], list(warnings)
    if test_beams is not None:
        sections.append(_of_test_beams(name, test_beams))
        answer.append(tables_test_beams.built(test_beams))
        listed += tables_test_beams.warnings(test_beams)
    answer += [stuck_sentence(*row, force=float(stopper.restoring_force)) for row in shares_stuck(stopper)]
    worst = [worst_sentence(stopper)] if ends(stopper) else []
    answer += [*safe_force_sentences(stopper), *worst, *model_errors.sentences(name, errors)]
    words = _OF_STOPPERS | (_WORST if worst else {}) | _words_of_budgets(budgets)
    return Page(_title(name, section), _facts_of(section), answer, sections, listed, words)


def _words_of_budgets(budgets):
    """Terms that the budgets use."""
    choices = [str(name) for budget in budgets.values() for name in budget.choice.values]
    used = dict(words for start, words in _OF_CHOICES.items() if any(name.startswith(start) for name in choices))
    return _OF_BUDGETS | used if budgets else {}


def _title(name, section):
    return f"{name}: {kind_of(section).words}"


def _facts_of(section):
    """Dimensions and conditions of a device, by name."""
    facts = {"surfaces": f"pair {section['pair']}"} | section.get("surfaces", {})
    for key in kind_of(section).keys:
        (name, unit), value = KEYS[key], section[key]
        values = value if isinstance(value, list) else [value]
        facts[name] = f"{' x '.join(f'{value:g}' for value in values)} {unit}"
    name = "relative humidities" if len(section["humidities"]) > 1 else "relative humidity"
    facts[name] = ", ".join(map(humidity_text, section["humidities"]))
    return facts | _asked(section)


def _asked(section):
    """What is required of a device and over which roughness it is asked for, by name; nothing if it is not asked."""
    if "requirement" not in section:
        return {}
    required, over = section["requirement"], section["roughness"]
    length = f"{required['length_um']:g} µm long, " if "length_um" in required else ""
    ranges = (
        f"{quantity.words} from {over[key][0]:g} to {over[key][1]:g}{quantity.unit}"
        for key, quantity in ROUGHNESSES.items()
        if key in over
    )
    return {
        "requirement": f"{length}at most 1 in {1 / required['share']:g} sticks",
        f"roughness of {over['surface']} asked for": ", ".join(ranges),
    }


def _at(humidity):
    """One humidity, for the beginning of a sentence."""
    return airs([humidity]).capitalize()


def described(surface: Mapping, material: Mapping) -> str:
    """A surface of the configuration by its numbers, or by its scans, and by its material.

    Examples
    --------
    >>> described({"rms_nm": 3.4, "skewness": -0.76, "kurtosis": 3.9}, {})
    'rms 3.4 nm, skewness -0.76, kurtosis 3.9'
    >>> described({"rms_nm": 3.4, "material": "FDTS"}, {"contact_angle_deg": 110, "coating_nm": 1.2})
    'rms 3.4 nm, FDTS, contact angle 110°, coating 1.2 nm'
    """
    stated = _stated(surface, _OF_SURFACES)
    if "scans" in surface:
        files = len(surface["scans"]["files"])
        stated.append(f"described by {files} {'scan' if files == 1 else 'scans'}")
    stated += [surface["material"]] if "material" in surface else []
    return ", ".join(stated + _stated(material, _OF_MATERIALS))


def _stated(section, words):
    """Numbers that a section states, in words."""
    return [f"{name} {section[key]:g}{unit}" for key, (name, unit) in words.items() if key in section]


def build_sentence(safe_lengths: Mapping[float, xr.Dataset], budgets: Mapping[tuple, xr.Dataset]) -> str:
    """The length to build for all humidities of a device, for the middle one of the shares.

    It is the least safe length, less twice the largest uncertainty of what holds the shortest devices, if any is known.

    Parameters
    ----------
    safe_lengths, budgets : dict
        As in `of_beam`.
    """
    least = min(_safe(dataset).item() for dataset in safe_lengths.values())
    total = max((budget_of(budget).total for key, budget in _of_shortest(safe_lengths, budgets).items()), default=0.0)
    length = (1 - 2 * total) * least / UM
    if length <= 0:
        return f"No length can be stated: twice the uncertainty due to the measurements is {200 * total:.2g} % of it."
    sentence = (
        f"Build it no longer than {length:.0f} µm: then at most 1 in {1 / _chosen(_any(safe_lengths)):g} sticks "
        f"{airs(safe_lengths)} (95 % confidence, given the drawn surfaces)."
    )
    if total == 0:
        return f"{sentence} No uncertainty of the measurements is subtracted, because none is stated."
    return (
        f"{sentence} The shortest safe length, {least / UM:.0f} µm, is reduced by {200 * total:.2g} %, twice the "
        "uncertainty due to the measurements."
    )


def _any(safe_lengths):
    """One of the datasets of a device, which have the same shares and shapes."""
    return next(iter(safe_lengths.values()))


def _safe(dataset):
    """Safe length for the chosen share, however the device is held [m]."""
    return dataset.safe_length.sel(share=_chosen(dataset)).min()


def _chosen(dataset):
    """The share of stuck devices for which sentences state lengths: the middle one [-]."""
    return float(dataset.share[dataset.sizes["share"] // 2])


def _of_shortest(safe_lengths, budgets):
    """Budgets of what holds the shortest devices: of tips, if there are tips."""
    of_tips = EITHER in _any(safe_lengths)["shape"].values
    return {key: budget for key, budget in budgets.items() if ("tip" in key) == of_tips}


def verdict(stopper: xr.Dataset) -> str:
    """Whether the restoring force of a stopper suffices, for the smallest share that its patches can bound."""
    force, where = float(stopper.restoring_force), airs(stopper.humidity.values)
    stated, any_air = stopper.safe_force.sel(part="safe").max("humidity", skipna=False), in_any_air(stopper)[1]
    known = [float(share) for share in stopper.share if np.isfinite(stated.sel(share=share))]
    if not known:
        return _verdict_of_few(stopper)
    share = min(known)
    at_these, anywhere = (float(needed.sel(share=share)) for needed in (stated, any_air))
    head = f"The restoring force of {force / UN:g} µN"
    tail = f"at most 1 in {1 / share:g} sticks (95 % confidence, given the drawn surfaces)."
    if force < at_these:
        return f"{head} does not suffice {where}: a larger one is needed if {tail}"
    if force < anywhere:
        return f"{head} suffices {where}, but not at all{_range(stopper)}: {tail}"
    dry = ["in dry air"] if stopper.axis[0] == 0 else []
    humid = [f"at all relative humidities{_range(stopper)}"] if ends(stopper) else []
    return f"{head} suffices {' and '.join(dry + humid)}: {tail}"


def _verdict_of_few(stopper):
    """The verdict where there are too few patches to bound any of the shares from above."""
    (humidity, _, low, _), share = max(shares_stuck(stopper), key=lambda row: row[2]), float(stopper.share.max())
    if low <= share:
        return "There are too few patches to say whether the restoring force suffices."
    where, force = airs([humidity]), float(stopper.restoring_force)
    return (
        f"The restoring force of {force / UN:g} µN does not suffice {where}: at least {100 * low:.3g} % of the "
        "stoppers stick (95 % confidence, given the drawn surfaces)."
    )


def safe_sentence(humidity: float, dataset: xr.Dataset) -> str:
    """The safe lengths of a device at one humidity in words, for the middle one of the shares."""
    share = _chosen(dataset)
    lengths = dataset.safe_length.sel(share=share) / UM
    shortest, longest = float(lengths.min()), float(lengths.max())
    air, but = _at(humidity), f"at most 1 in {1 / share:g}"
    sentence = (
        f"{air}, devices of up to {shortest:.0f} µm come free after they were pressed down, except for {but} (95 % "
        "confidence, given the drawn surfaces)."
    )
    if longest == shortest:
        return sentence
    return f"{sentence} If the tip cannot hold them, this is true of up to {longest:.0f} µm."


def stuck_sentence(humidity: float, stuck: float, low: float, high: float, force: float) -> str:
    """P(stuck) of a stopper at one humidity in words; restoring force [N].

    Examples
    --------
    >>> stuck_sentence(0.67, 0.012, 0.01, 0.015, 20e-6)
    'At a relative humidity of 0.67, 1.2 % of the stoppers (1 to 1.5 %) hold more than the restoring force of 20 µN.'
    """
    share, band = f"{100 * stuck:.3g} %", f"{100 * low:.3g} to {100 * high:.3g} %"
    return f"{_at(humidity)}, {share} of the stoppers ({band}) hold more than the restoring force of {force / UN:g} µN."


def safe_force_sentences(stopper: xr.Dataset) -> list[str]:
    """Restoring forces that would suffice at the humidities of a stopper, and in any air of its fine axis.

    For the shares that its patches can bound.
    """
    stated = stopper.safe_force.sel(part="safe").max("humidity")
    where = "At all these humidities" if stopper.sizes["humidity"] > 1 else _at(float(stopper.humidity[0]))
    return [
        f"{where}, a restoring force of {float(force) / UN:.3g} µN leaves at most 1 in "
        f"{1 / float(force.share):g} stuck (95 % confidence)"
        + (f"; at any humidity{_range(stopper)}, {float(more) / UN:.3g} µN are needed." if ends(stopper) else ".")
        for force, more in zip(stated, in_any_air(stopper)[1], strict=True)
        if np.isfinite(force)
    ]


def worst_sentence(stopper: xr.Dataset) -> str:
    """The worst humidity of a stopper in words."""
    worst = float(stopper.worst_humidity)
    share, least, most = (100 * share for share in in_any_air(stopper)[0])
    stuck = f" In no air of this range do more than {share:.3g} % ({least:.3g} to {most:.3g} %) stick."
    stuck = "" if f"{share:.3g}" == "100" else stuck
    if is_at_an_end(stopper):
        low, high = ends(stopper)
        return f"Between relative humidities of {low:g} and {high:g}, the stopper holds most at {worst:g}.{stuck}"
    if not worst:
        return f"The stopper holds most in dry air; humid air{_range(stopper)} is less critical.{stuck}"
    return (
        f"The stopper holds most at a relative humidity of {worst:.2f}; drier and wetter air,{_range(stopper)}, "
        f"are less critical.{stuck}"
    )


def _range(stopper):
    """Range of humidities along which the worst was sought, in words."""
    low, high = ends(stopper)
    return f" from {low:g} to {high:g}"


def _sure(name, budgets, errors):
    """Section on the uncertainty of the result and what to measure better; none if no input is uncertain."""
    if not budgets:
        return []
    cases = {(name, *key): dataset for key, dataset in budgets.items()}
    sentences = [
        f"{f'Relative humidity {humidity:g}' if humidity else 'Dry air'}: {tables_budget.advised(budget)}"
        for (humidity, *_), budget in budgets.items()
    ]
    sentences += dict.fromkeys(map(tables_budget.counted_as_exact, budgets.values()))
    cells, drawn = _side_by_side(tables_budget.budget(cases, errors).cells), figures_budget.budget(cases)
    return [Section("Uncertainty, and what should be measured better", sentences, cells, drawn)]


def _of_test_beams(name, update):
    """Section on what the test beams of a device say."""
    said = [
        tables_test_beams.explained(update),
        *tables_test_beams.combinations(update),
        tables_test_beams.advised(update),
    ]
    said += [tables_test_beams.again(update), *tables_test_beams.stuck(update)]
    cells = tables_test_beams.test_beams({name: update}).cells.drop(columns="device")
    return Section("What the test beams say", said, cells, figures_test_beams.test_beams(update))


def _rough_enough(roughness):
    """Which roughness suffices, among the first sentences; nothing if this was not asked."""
    return [] if roughness is None else tables_roughness.briefly(roughness)


def _how_rough(name, roughness):
    """Section on how rough a surface must be; none if this was not asked."""
    if roughness is None:
        return []
    cells = tables_roughness.roughness({name: roughness}).cells.drop(columns="device")
    of_map = "other" in roughness.dims
    said = [*tables_roughness.answers(roughness), tables_roughness.form(roughness)]
    sections = [Section("How rough must it be?", said, cells, figures_roughness.roughness(roughness))]
    if of_map:
        sections.append(Section("Over two quantities", _OF_MAPS, None, figures_roughness.roughness_map(roughness)))
    return sections


def _side_by_side(cells):
    """Cells of the budget of one device with a pair of columns for every humidity."""
    shown = [
        part.set_index(["held by", "what"])[["effect [%]", "remaining [%]"]].add_prefix(
            f"{text if text == DRY else f'RH {text}'}: "
        )
        for text, part in cells.groupby("RH", sort=False)
    ]
    return pd.concat(shown, axis=1).fillna(MISSING).reset_index()


def _inputs(plan, at):
    """Everything that the page of a device shows."""
    devices, section = plan.devices, plan.config["devices"][at.device]
    cases = [case_id(at.device, humidity) for humidity in section["humidities"]]
    budgets = budgets_of(plan, at.device) if at.device in devices.budgeted else {}
    own = {"budgets": {key[1:]: name for key, name in budgets.items()}, "warnings": device_warnings.files_of(at.device)}
    own |= model_errors.of_devices(plan, at.device)
    asked = {"test_beams": "devices/test_beams/rerun", "roughness": "devices/roughness"}
    own |= {key: f"{folder}/{at.device}" for key, folder in asked.items() if key in section}
    if not devices.kind(at.device).is_beam:
        return own | {"stopper": f"devices/stoppers/{at.device}", "style": File(STYLE)}
    charts = devices.chart_cases(at.device) if at.device in devices.charted else []
    return own | {
        "safe_lengths": {key[1]: name for key, name in by_case("devices/safe_lengths", cases).items()},
        "charts": {key[1]: name for key, name in by_case("devices/chart", charts).items()},
        "style": File(STYLE),
    }


def _settings(plan, at):
    """Section of a device, and its surfaces in words."""
    section = plan.config["devices"][at.device]
    pair = plan.config["pairs"][section["pair"]]
    names = {f"surface of the {part}": pair[part] for part in ("beam", "substrate")}
    materials = [material_of(plan.config, name) for name in names.values()]
    surfaces = {
        part: f"{name}: {described(plan.config['surfaces'][name], material)}"
        for (part, name), material in zip(names.items(), materials, strict=True)
    }
    not_modelled = {"not_modelled": device_warnings.not_modelled(plan, at.device)}
    return section | {"surfaces": surfaces} | not_modelled


def _page(data, at, settings):
    """Page of a device."""
    warnings, budgets = device_warnings.read(data["warnings"]), data["budgets"]
    more = {name: data.get(name) for name in ("test_beams", "errors", "roughness")}
    if "stopper" in data:
        page = of_stopper(at.device, settings, data["stopper"], budgets, warnings.patches[at.device], **more)
    else:
        lengths, charts = data["safe_lengths"], data["charts"]
        page = of_beam(at.device, settings, lengths, charts, budgets, warnings.lengths | warnings.curves, **more)
    return replace(page, not_modelled=settings["not_modelled"])


def _save(page, paths):
    """Write a page with the date and the code of the last run.

    Its record is no input of the page, so that a run with nothing else to do keeps page and date.
    """
    record = Path(paths["html"]).parents[1] / "provenance.json"
    save_text(replace(page, made=provenance.last_run(record)).html, paths["html"])


STAGES = (
    Stage(
        name="device_page",
        files={"html": "devices/{device}.html"},
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
