"""Stage answer: the size to build of a device, the steps that lead to it, and P(stuck) at its own size, as data."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import xarray as xr

from stiction.answer import ladder, places, sought
from stiction.answer.data import INPUTS, Answer, AnswerInAir, Between, Cause, Probability, PullOff, Stay, Step, Unasked
from stiction.answer.ladder import MainQuestion
from stiction.answer.unknowns import Draws, OfBudgets
from stiction.answer.worlds import DRAWS
from stiction.config.mission.conditions import CONDITIONS
from stiction.config.mission.stays import stays
from stiction.config.units import in_si
from stiction.contact.air import Air, humid
from stiction.devices.budget import LARGEST
from stiction.plan.stage import Stage, select
from stiction.stages.answer import beside, conditions
from stiction.stages.devices.budget import budgets_of
from stiction.stages.devices.opening import FORCE, DesignedBeam, own_section
from stiction.stages.devices.results import charts_of, results_of
from stiction.stages.devices.safe_lengths import chosen_share
from stiction.stages.devices.stoppers import bounded_share
from stiction.stages.life.separation import separation_inputs
from stiction.stages.test_beams.inference import is_reliable


@dataclass(frozen=True)
class Settings:
    """Settings of an answer, without the datasets that it comes from."""

    seed: int
    name: str  #: of the device
    kind: str
    length: float = np.nan  #: of a beam, NaN if none is stated [m]
    touchdowns: int = 1
    shock: float = 0.0  #: peak [m s⁻²]
    liquids: tuple[str, ...] = ()  #: that are stated
    left_out: tuple[str, ...] = ()  #: conditions that are stated but not inside
    required: float = 1.0  #: fraction of a requirement, 1 without one [-]
    beam: DesignedBeam | None = None  #: none for a stopper
    budgets: tuple[float, ...] = ()  #: humidities of the budgets [-]
    temperatures: dict[str, float] = field(default_factory=dict)  #: of the water of a mission, by humidity in words [K]
    stays: dict[str, Stay] = field(default_factory=dict)  #: touchdowns of its conditions, by number
    question: str = ""  #: about what has no spring
    measured: float = np.nan  #: pull-off force [N]
    measured_error: float = np.nan  #: its standard error [N]


def compute(data: Mapping[str, Any], settings: Settings) -> Answer:
    """Answer about a device."""
    return _of_pull_off(data, settings) if settings.question else _of_size(data, settings)


def _of_pull_off(data, settings):
    """Answer about a probe without a spring."""
    stopper, unknowns = data["stopper"], conditions.of_budgets(data["budgets"], settings.budgets)
    forces, errors = stopper.pull_off, stopper.full_contact_error
    forces_by_air = {
        float(rh): places.Places(forces.sel(humidity=rh).values, float(errors.sel(humidity=rh)))
        for rh in stopper.humidity.values
    }
    numbers = settings.measured, settings.measured_error
    left_out = (
        ("inputs",)
        if isinstance(unknowns, OfBudgets) and any(unknowns.budget((rh, FORCE)) is None for rh in forces_by_air)
        else ()
    )
    question = places.ProbeQuestion(
        settings.name, settings.kind, FORCE, "stoppers", *numbers, left_out, _forbidden(data, unknowns)
    )
    return places.answer(question, forces_by_air, unknowns, Draws(DRAWS, settings.seed))


def _of_size(data, settings):
    """Answer about a beam, or about what a spring pulls off."""
    circumstances, question = _of_beam(data, settings) if settings.beam else _of_stopper(data)
    circumstances = [
        replace(condition, is_stated=settings.shock > 0) if condition.cause is Cause.FAST else condition
        for condition in circumstances
    ]
    before = conditions.of_budgets(data["budgets"], settings.budgets)
    unknowns = conditions.of_test_beams(data.get("test_beams")) or before
    left_out = (*settings.left_out, *_left_out(data, circumstances, unknowns, settings.shock))
    if settings.required < question["share"]:
        left_out = (*left_out, "requirement")
    mission = {"touchdowns": settings.touchdowns, "stays": tuple(settings.stays.values()), "left_out": left_out}
    full_question = MainQuestion(
        settings.name, settings.kind, forbidden=_forbidden(data, unknowns), **mission, **question
    )
    draws = Draws(DRAWS, settings.seed)
    answer = ladder.answer(full_question, circumstances, unknowns, draws, None if unknowns is before else before)
    at = [settings.temperatures.get(Air(air.humidity).name, np.nan) for air in answer.airs]
    airs = [replace(air, temperature=kelvin) for air, kelvin in zip(answer.airs, at, strict=True)]
    unasked = beside.unasked(data["life"], answer)
    return replace(
        answer, airs=tuple(airs), between=beside.between(answer, _limits(data, settings, answer.share)), unasked=unasked
    )


def _limits(data, settings, share):
    """Simulated limits in all computed airs."""
    if settings.beam:
        return beside.of_lengths(data["lengths"], data.get("charts", {}), settings.beam, share)
    return beside.of_forces(data["stopper"], share)


def _of_beam(data, settings):
    """Conditions of a beam, and its question."""
    slow = list(conditions.of_lengths(data["lengths"], Cause.ESTIMATE, "safe_lengths", data.get("after")))
    circumstances = [
        *slow,
        *conditions.separated_fast(slow, data.get("fast_strips", {}), data.get("fast_tips", {}), settings.beam),
        *conditions.of_lengths(data["biased"], Cause.VOLTAGE, "at_voltage"),
        *conditions.at_voltage_on_flats(slow, data["life"], settings.beam),
        *conditions.drying(data["life"], settings.liquids, data["lengths"]),
    ]
    share = chosen_share(next(iter(data["lengths"].values())))
    return circumstances, {"share": share, "unit": sought.LENGTH.unit, "size": settings.length}


def _of_stopper(data):
    """Conditions of a stopper, and its question."""
    stopper = data["stopper"]
    share, errors = bounded_share(stopper), stopper.full_contact_error
    parallel = list(conditions.of_forces(stopper.pull_off, share, stopper.safe_force, errors, Cause.ESTIMATE))
    circumstances = [*parallel, *conditions.at_voltage_on_flat_patches(parallel, data["life"])]
    if "separation" in data:
        circumstances += conditions.of_forces(data["separation"].pull_off, share, None, errors, Cause.FAST)
    if "tilted" in data:
        tilted = data["tilted"]
        most, safe = tilted.pull_off.max("tilt"), tilted.largest_safe_force
        circumstances += conditions.of_forces(most, share, safe, errors, Cause.TILT)
    if "biased" in data:
        biased = data["biased"]
        circumstances += conditions.of_forces(biased.pull_off, share, biased.safe_force, errors, Cause.VOLTAGE)
    size = float(stopper.restoring_force)
    return circumstances, {"share": share or float(stopper.share.max()), "unit": sought.FORCE.unit, "size": size}


def _left_out(data, circumstances, unknowns, shock):
    """Stated conditions and inputs that no dataset bounds.

    That is a voltage on a bridge at which its dielectric breaks down, a shock where no summits stop some strips, and
    inputs of end states in which too few devices stick to show what they change.
    """
    inside = {condition.cause for condition in circumstances}
    at = {(condition.humidity, condition.shape) for condition in circumstances} & set(getattr(unknowns, "budgets", ()))
    left_out = ["voltage"] if float(data["life"].potential) > 0 and Cause.VOLTAGE not in inside else []
    left_out += ["shock"] if shock and data.get("fast_strips") and Cause.FAST not in inside else []
    return left_out + (["inputs"] if any(unknowns.budget(key) is None for key in at) else [])


def _forbidden(data, unknowns):
    """Reasons why no number may be stated: test beams that contradict, and inputs that are too uncertain."""
    reasons = []
    if data.get("test_beams") is not None and not is_reliable(data["test_beams"]):
        reasons.append("test_beams_contradict")
    margins = [budget.margin for budget in unknowns.budgets.values()] if isinstance(unknowns, OfBudgets) else []
    if max(filter(np.isfinite, margins), default=0.0) > LARGEST:
        reasons.append(INPUTS)
    return tuple(reasons)


# Dataset

#: Fields of an answer that are sizes, whose unit is stated here, and others.
_SIZES = ("build", "exact", "size", "if_measured", "without_test_beams")
_NUMBERS = ("share", "spread_of_budget")
_TEXTS, _LISTS = ("device", "kind", "measure"), ("left_out", "forbidden")
_STUCK = ("value", "low", "high", "none_seen")
#: Fields of its steps beside their size, and of its airs.
_STEPS = ("factor", "humidity", "shape", "source", "stated")
_AIRS = ("build", "without_tip", "first", "temperature")


def layout(answer: Answer) -> xr.Dataset:
    """Dataset of an answer: steps along ``step``, stated airs along ``air``."""
    size = {"units": answer.unit}
    variables = {name: ((), getattr(answer, name), size) for name in _SIZES}
    variables |= {name: ((), getattr(answer, name)) for name in _NUMBERS}
    variables |= {"touchdowns": ((), answer.touchdowns), "extrapolated": ((), int(answer.extrapolated))}
    variables |= {name: (name, np.array(getattr(answer, name), dtype=object)) for name in _LISTS}
    variables["step_size"] = ("step", np.array([step.size for step in answer.steps]), size)
    for name in _STEPS:
        values = [getattr(step, name) for step in answer.steps]
        variables[f"step_{name}"] = ("step", np.array(values, dtype=int if name == "stated" else None))
    for name in _AIRS:
        variables[f"air_{name}"] = ("air", [getattr(air, name) for air in answer.airs], size)
    for name in _STUCK:
        every = [answer.stuck, *(air.stuck for air in answer.airs)]
        at = [np.nan if stuck is None else float(getattr(stuck, name)) for stuck in every]
        variables[f"stuck_{name}"] = ((), at[0])
        variables[f"air_stuck_{name}"] = ("air", at[1:])
    curves = [air.curve for air in answer.airs]
    variables |= {"air_curve": (("air", "end", "point"), curves), "curve": (("end", "point"), answer.curve)}
    variables["curve_size"] = "point", answer.sizes, size
    if answer.stays:
        inside = [[int(air.humidity in stay.humidities) for air in answer.airs] for stay in answer.stays]
        variables |= {"stay_air": (("stay", "air"), inside)}
        variables |= {"stay_touchdowns": ("stay", [stay.touchdowns for stay in answer.stays])}
    variables |= _of_places(answer.pull_offs) | _beside(answer, size)
    coords = {"step": [str(step.cause) for step in answer.steps], "air": [air.humidity for air in answer.airs]}
    coords["end"] = ["value", "low", "high"]
    return xr.Dataset(variables, coords, {name: getattr(answer, name) for name in _TEXTS})


def _beside(answer, size):
    """Variables of the stricter sizes beside the size to build, none where there is none."""
    variables = {}
    if answer.between:
        variables |= {"between_humidity": ((), answer.between.humidity)}
        variables |= {f"between_{name}": ((), getattr(answer.between, name), size) for name in ("size", "safe")}
    if answer.unasked:
        variables |= {
            f"unasked_{name}": ("unasked", [getattr(limit, name) for limit in answer.unasked]) for name in _NAMED
        }
        variables |= {"unasked_size": ("unasked", [limit.size for limit in answer.unasked], size)}
    return variables


#: Texts of a limit that nothing stated asks for.
_NAMED = ("name", "what")


def _stricter(dataset):
    """Yield the limits of a dataset that nothing stated asks for, if it has some."""
    for row in (dataset.isel(unasked=k) for k in range(dataset.sizes.get("unasked", 0))):
        yield Unasked(*(str(row[f"unasked_{name}"].values) for name in _NAMED), float(row.unasked_size))


#: Probabilities of a measured force.
_RANKS = ("less", "more", "two_sided")


def _of_places(pull_offs):
    """Variables of pull-off forces by air, none for a device that is not asked for them."""
    if not pull_offs:
        return {}
    ranks = [[_numbers(getattr(forces, name)) for forces in pull_offs] for name in _RANKS]
    variables = {name: (("air", "end"), rank) for name, rank in zip(_RANKS, ranks, strict=True)}
    variables["place_pull_off"] = (("air", "share_below", "end"), [forces.quantiles for forces in pull_offs])
    variables["measured_error"] = ("air", [forces.error for forces in pull_offs])
    return variables | {"share_below": ("share_below", list(places.SHARES))}


def _numbers(probability):
    """Value and ends of the band of a probability, NaN where there is none."""
    return [np.nan] * 3 if probability is None else [probability.value, probability.low, probability.high]


def _pull_offs(dataset):
    """Yield the pull-off forces of a dataset, if it has some."""
    for row in (dataset.isel(air=k) for k in range(dataset.sizes["air"]) if "place_pull_off" in dataset):
        ranks = [row[name].values for name in _RANKS]
        probabilities = [None if np.isnan(rank).any() else Probability(*map(float, rank)) for rank in ranks]
        yield PullOff(float(row.air), row.place_pull_off.values, float(row.measured_error), *probabilities)


def answer_of(dataset: xr.Dataset) -> Answer:
    """Answer from its dataset, the inverse of `layout`."""
    steps = [
        Step(
            Cause(str(row.step.values)),
            *(float(row[f"step_{name}"]) for name in ("size", "factor", "humidity")),
            *(str(row[f"step_{name}"].values) for name in ("shape", "source")),
            bool(row.step_stated),
        )
        for row in (dataset.isel(step=k) for k in range(dataset.sizes["step"]))
    ]
    airs = [
        AnswerInAir(
            float(row.air),
            *(float(row[f"air_{name}"]) for name in ("build", "without_tip")),
            _probability(row, "air_stuck_"),
            row.air_curve.values,
            float(row.air_first),
            float(row.air_temperature),
        )
        for row in (dataset.isel(air=k) for k in range(dataset.sizes["air"]))
    ]
    return Answer(
        **{name: dataset.attrs[name] for name in _TEXTS},
        **{name: float(dataset[name]) for name in (*_SIZES, *_NUMBERS)},
        **{name: tuple(map(str, dataset[name].values)) for name in _LISTS},
        unit=dataset.build.attrs["units"],
        steps=tuple(steps),
        airs=tuple(airs),
        stuck=_probability(dataset, "stuck_"),
        touchdowns=int(dataset.touchdowns),
        stays=tuple(_stays(dataset)),
        extrapolated=bool(dataset.extrapolated),
        sizes=dataset["curve_size"].values,
        curve=dataset["curve"].values,
        pull_offs=tuple(_pull_offs(dataset)),
        between=_between(dataset),
        unasked=tuple(_stricter(dataset)),
    )


def _between(dataset):
    """Stricter size of an air between the stated ones of a dataset, none where it has none."""
    if "between_size" not in dataset:
        return None
    return Between(*(float(dataset[f"between_{name}"]) for name in ("humidity", "size", "safe")))


def _stays(dataset):
    """Yield the parts of the mission of a dataset, if it has some."""
    for row in (dataset.isel(stay=k) for k in range(dataset.sizes.get("stay", 0))):
        humidities = row.air.values[row.stay_air.values > 0]
        yield Stay(tuple(map(float, humidities)), float(row.stay_touchdowns))


def _probability(dataset, start):
    """P(stuck) of a dataset, none where it has none."""
    *numbers, none_seen = (float(dataset[f"{start}{name}"]) for name in _STUCK)
    return None if np.isnan(numbers[0]) else Probability(*numbers, bool(none_seen))


# Stage


def _inputs(plan, at):
    """All datasets of a device that bear on its size."""
    section, device = plan.config["devices"][at.device], at.device
    inputs = {"budgets": list(_budgets(plan, device).values())}
    if device not in plan.devices.with_life:
        return inputs | results_of(plan, device, "stopper")
    inputs |= {"life": f"devices/life/{device}"} | separation_inputs(plan, device)
    inputs |= {"test_beams": f"devices/test_beams/{device}"} if "test_beams" in section else {}
    inputs |= {"charts": charts_of(plan, device)} if device in plan.devices.with_chart else {}
    return inputs | results_of(plan, device, "tilted", "biased", "stopper", "after", "lengths")


def _budgets(plan, device):
    """Budgets of a device by humidity and more; none without uncertain inputs."""
    budgets = budgets_of(plan, device) if device in plan.devices.with_budget else {}
    return {key[1:]: name for key, name in budgets.items()}


def _settings(plan, at):
    """Settings of a device."""
    section, beam, name = plan.config["devices"][at.device], own_section(plan, at.device, key="beam"), at.device
    liquids = plan.config.get("liquids", {}) if beam else {}
    derived = {"seed": plan.config["seed"], "name": name, "liquids": sorted(liquids)}
    derived |= {"left_out": ["dimples"] if "dimples" in section else []}
    derived |= {"budgets": [humidity for humidity, *_ in _budgets(plan, name)]}
    at = {Air(air).name: plan.air_of_devices.temperature(section["pair"], air) for air in humid(section["humidities"])}
    derived |= {"temperatures_K": at} if CONDITIONS in section else {}
    mission = stays(section, plan.air_of_devices.wetting(section["pair"]))
    derived |= {"stays": mission} if mission else {}
    derived |= {"required": section["requirement"]["share"]} if "requirement" in section else {}
    derived |= {} if name in plan.devices.with_life else {"question": plan.devices.question(name)}
    return select(Settings, section | derived | beam)


STAGES = (
    Stage.writing(
        "answer",
        "devices/answer/{device}",
        inputs=_inputs,
        settings=_settings,
        compute=lambda data, settings: layout(compute(data, in_si(Settings, settings))),
        message="Answer about device {device}.",
        jobs=lambda plan: [{"device": name} for name in plan.devices.sections],
        targets=("devices",),
    ),
)
