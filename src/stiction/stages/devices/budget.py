"""Stage budget: the effect of each input of a device on its length, or on the pull-off force of a stopper.

A cantilever has a budget of its sticking length as an S-shape, and another one of the length that its tip holds:
its contact is that of the tips. Slopes are central differences with common random numbers: sample k of two contacts has
the same random numbers, and device j meets the same samples on both sides. The chaos model is left out: force laws are
those of the samples. A partly assumed surface has no slopes: whole typical surfaces take its place
(`stiction.config.surfaces.members`).
"""

import traceback
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from stiction.beam.cantilever import Beam
from stiction.config import memory, test_beams
from stiction.config.cases import Case, case_id
from stiction.config.surfaces.members import like
from stiction.config.units import in_si
from stiction.contact import forcelaw
from stiction.contact.materials import OF_REPLICAS
from stiction.contact.tilt import EDGE_RADIUS
from stiction.devices import arcs
from stiction.devices.budget import Budget, choice_effect, joined, log_slope, weights_of_kind
from stiction.devices.stoppers import pull_off_force
from stiction.devices.strips import drawn_from
from stiction.devices.tail import FEWEST, TAIL, fit_tail
from stiction.plan.stage import At, Running, Stage, subsection
from stiction.progress import progress
from stiction.stages.contact import curves
from stiction.stages.contact.changes.members import samples_on
from stiction.stages.contact.changes.patches import TIPS
from stiction.stages.contact.contact import first
from stiction.stages.contact.corrections import with_correction
from stiction.stages.contact.error_notes import explain_errors
from stiction.stages.devices.contact_names import contacts_of_budget, contacts_of_tip_budget
from stiction.stages.devices.opening import (
    ARC,
    FORCE,
    SOUGHT_BY,
    DesignedBeam,
    addresses,
    around,
    arrests,
    ground_of,
    own_section,
)
from stiction.stages.devices.uncertain_inputs import (
    Input,
    InputState,
    QuantityErrors,
    Settings,
    countable,
    covariances,
    uncertain,
)


@dataclass(frozen=True)
class Responses:
    """Lengths [m] or forces [N] of the same devices at several states, and their common part."""

    values: np.ndarray  #: (states, devices); infinite where a beam has no S-shaped crack
    centre: Callable[[np.ndarray], float]  #: statistic of all devices of a state, such as the mean length
    shared: np.ndarray | None = None  #: of the samples that all beams share (states, m, ...): energies, for example
    length: Callable[[np.ndarray], float] | None = None  #: length on the mean of the samples (m, ...) [m]
    compared: Callable[[np.ndarray], float] | None = None  #: stands for all where two states are compared; else centre
    end: Callable[[np.ndarray], float] | None = None  #: stands for all where two surfaces are compared; else centre

    @property
    def centre_of_slopes(self) -> Callable[[np.ndarray], float]:
        """Statistic of all devices of a state, for its comparison with another state."""
        return self.compared or self.centre


#: Folder of the budgets of test beams, and the share of their tips whose length theirs is of.
OF_ARRAYS, HALF = "devices/test_beams/budget", 0.5
#: Part of the tips that is fitted for slopes. ASSUME: inputs move the lowest quarter as the lowest 5 %. Slopes of 1000
#: tips of pair b by both differ by less than their errors, and those by the quarter have 0.6 times the error.
_OF_SLOPES = 0.25
#: Factor of the lengths of beams where an input changes adhesion many times: cracks on weak ground scatter most.
_LONGER = 2
#: Devices at several states.
Respond = Callable[[Sequence[InputState]], Responses]


@dataclass(frozen=True, kw_only=True)
class _OfBeams(Settings):
    """Budget of a length of beams."""

    device: DesignedBeam

    @property
    def sizes(self) -> tuple[str, ...]:
        """Sizes open to a measurement of the device itself."""
        return self.device.opening.sizes

    def state(self, contact: xr.Dataset) -> InputState:
        """State with the stated inputs."""
        return InputState(contact, self.humidity, self.water, self.device, alike=self.alike)


@dataclass(frozen=True, kw_only=True)
class BeamBudget(_OfBeams):
    """Budget of the mean length of adhesion of beams: as S-shapes, or of bridges at their middle."""

    beams: int  #: number of beams for every slope
    share: ClassVar[float] = 0.0

    @property
    def response(self) -> str:
        """Quantity changed by the inputs."""
        return self.device.opening.shapes[0]

    def responder(self, *states: InputState, longer: int = 1) -> Respond:
        """How the devices respond: cracks of beams that are long enough at some states, or longer by a factor."""
        laws = [shared_laws([curves.vectors(state.contact, state.humidity, state.water)])[0] for state in states]
        beam, strips = around([ground_of(self.device, of_state) for of_state in laws])
        beam = replace(beam, length=longer * beam.length, elements=longer * beam.elements)
        return partial(
            beam_responses, mesh=(beam, longer * strips), number=self.beams, address=addresses(self), cache={}
        )


@dataclass(frozen=True, kw_only=True)
class TipBudget(_OfBeams):
    """Budget of the length with a fraction of the tips of all cantilevers stuck."""

    share: float  #: p [-]
    response: ClassVar[str] = ARC

    def responder(self, *_states: InputState, **_longer: int) -> Respond:
        """Response of the devices: arcs of all tips."""
        return partial(tip_responses, share=self.share)


@dataclass(frozen=True, kw_only=True)
class PatchBudget(Settings):
    """Budget of the mean pull-off force of a stopper. Methods as of `BeamBudget`."""

    contact: tuple[float, float]  #: sides of the patch [m]
    share: ClassVar[float] = 0.0
    response: ClassVar[str] = FORCE
    sizes: ClassVar[tuple[str, ...]] = ("area",)

    def state(self, contact: xr.Dataset) -> InputState:
        """State with the stated inputs."""
        return InputState(contact, self.humidity, self.water, area=self.contact[0] * self.contact[1], alike=self.alike)

    def responder(self, *_states: InputState, **_longer: int) -> Respond:
        """Response of the devices: pull-off forces of all patches."""
        return stopper_responses


#: Settings of any budget.
AnyBudget = BeamBudget | TipBudget | PatchBudget


def budget_settings(settings: dict[str, Any]) -> AnyBudget:
    """Settings of a budget from those of a job: tips have a share, and patches no beam."""
    return in_si(TipBudget if "share" in settings else BeamBudget if "device" in settings else PatchBudget, settings)


def compute(
    contact: xr.Dataset,
    shifted: Mapping[tuple[str, str], tuple[xr.Dataset, xr.Dataset]],
    properties: Mapping[str, tuple[xr.Dataset, xr.Dataset]],
    choices: Mapping[str, xr.Dataset],
    surface_errors: Mapping[str, QuantityErrors],
    settings: AnyBudget,
) -> xr.Dataset:
    """Slopes of all uncertain inputs of a device at a humidity, their covariance, scatter, and other model choices.

    The contact is that of the device, or of its tips; ``shifted``, ``properties`` and ``surface_errors`` are as in
    `stiction.stages.devices.uncertain_inputs.uncertain`. A contact under a choice of the model that has fewer samples
    is that of the first ones.
    """
    state = settings.state(contact)
    inputs, covariance = uncertain(state, shifted, properties, surface_errors, settings)
    far = [end for entry in inputs if np.isfinite(entry.limits).any() for end in entry.states]
    respond = settings.responder(state, *far, longer=_LONGER if far else 1)
    slopes_with_errors = slopes(inputs, respond)
    changes = {}
    for name, changed in choices.items():
        base = replace(state, contact=first(contact, changed.sizes["strip"]))
        with explain_errors(f"This is the contact under the choice {name}."):
            under = replace(state, contact=changed, water=settings.water_under(name))
            changes[name] = effect_if_known(base, under, respond)
    budget = layout(inputs, slopes_with_errors, covariance, respond([state]), changes, settings)
    return budget.assign(bend=("input", bends(inputs, respond))).assign(limits_of(inputs))


def with_members(
    budget: xr.Dataset,
    contact: xr.Dataset,
    members: Mapping[tuple[str, str], xr.Dataset],
    names: Sequence[tuple[str, str]],
    settings: AnyBudget,
) -> xr.Dataset:
    """Budget with the shifts of its response on whole typical surfaces, members in place of assumed ones.

    The names of all members are pairs of the surface and its member; those without a contact are the surface as stated.
    The response is not a number where nothing can be computed on a member.
    """
    state = settings.state(contact)
    effects = [
        shift(state, members[name], settings) if name in members else (0.0, 0.0) for name in progress(names, "members")
    ]
    (shifts, errors), (surfaces, labels) = np.transpose(effects), np.transpose(names)
    return budget.assign(member_shift=("member", shifts), member_error=("member", errors)).assign_coords(
        member=labels, member_of=("member", surfaces)
    )


def shift(state: InputState, member: xr.Dataset, settings: AnyBudget) -> tuple[float, float]:
    """Change of the logarithm of the response on the contact of a member, with its standard error [-].

    Compared are the lengths that few tips hold: whole surfaces move the lowest quarter of the tips by 0.02 to 0.05 less
    than the lowest 5 % (1000 tips on pair b).
    """
    base, changed = replace(state, contact=first(state.contact, member.sizes["strip"])), replace(state, contact=member)

    def respond(states):
        """Responses of devices that are long enough for both."""
        responses = settings.responder(*states)(states)
        return replace(responses, compared=responses.end)

    return effect_if_known(base, changed, respond)


def stopper_responses(states: Sequence[InputState]) -> Responses:
    """Pull-off forces of all sampled patches at several states."""
    forces = [
        pull_off_force(curves.pull_offs(state.contact, state.humidity, state.water), state.area) for state in states
    ]
    return Responses(np.array(forces), np.mean)


def tip_responses(states: Sequence[InputState], share: float) -> Responses:
    """Longest releasing arcs of all sampled tips at several states. Their quantile at p stands for all.

    ASSUME: no crack stops on beams that are so short that only a share p of the tips hold them.
    """
    forces_and_beams = [
        (curves.tip_forces(state.contact, state.humidity, state.water), state.device.beam) for state in states
    ]
    lengths = [arcs.longest_free(*forces, beam) for forces, beam in forces_and_beams]
    fewest = (FEWEST + 0.5) / len(lengths[0])  # as many as a fit needs
    fractions = (max(fraction, fewest) for fraction in (_OF_SLOPES, TAIL))
    compared, end = (partial(_stuck_length, share=share, fraction=fraction) for fraction in fractions)
    return Responses(np.array(lengths), partial(_stuck_length, share=share), compared=compared, end=end)


def _stuck_length(lengths, share, fraction=TAIL):
    """Length with a fraction stuck, infinite if too few stick. Small fractions take the fit of the shortest part."""
    finite = np.isfinite(lengths)
    if share > TAIL:
        return (
            float(np.quantile(lengths, share)) if finite.all() or finite.mean() > share + 1 / len(lengths) else np.inf
        )
    return fit_tail(lengths, fraction).length(share) if finite.sum() >= FEWEST else np.inf


def beam_responses(
    states: Sequence[InputState], mesh: tuple[Beam, int], number: int, address: Callable, cache: dict | None = None
) -> Responses:
    """Crack lengths, or lengths of held bridges, of the same beams at several states, on resampled force laws.

    Finite elements resolve the ``mesh`` of all beams, a part and its number of strips; ``address(k)`` is the stream of
    beam k. ``cache`` has the lengths of earlier calls.

    ASSUME: for a cantilever, the two foundation lengths that hold its crack are left out, 1 % of the length.
    ASSUME: neighbouring strips are independent, also on ground with blocks (`stiction.devices.strips`).
    """
    laws, lawful = lawful_at_all([curves.vectors(state.contact, state.humidity, state.water) for state in states])
    (of_mesh, strips), cache = mesh, {} if cache is None else cache

    def lengths(state, laws):
        """Crack lengths in a state on force laws [m]."""
        if (key := (state.device, laws.tobytes())) not in cache:
            beam = replace(state.device.beam, length=of_mesh.length, elements=of_mesh.elements)
            draw = drawn_from(laws, curves.displacements(state.contact, lawful))
            cache[key] = arrests(state.device, (beam, strips), draw, number, address)
        return cache[key]

    values = np.array([lengths(state, of_state) for state, of_state in zip(states, laws, strict=True)])
    # Some lengths may not be known. If most are not, the median is infinite, and no slope is known.
    centre = np.mean if np.isfinite(values).all() else np.median
    device = states[0].device
    length = partial(device.opening.length_on_mean, beam=device.beam)
    return Responses(values, centre, device.opening.contribution(np.array(laws)), length)


def shared_laws(parametrised: Sequence[tuple[np.ndarray, float]]) -> list[np.ndarray]:
    """Force laws of the samples lawful at every state, from vectors and f_limit of each, (m, 4) each."""
    return lawful_at_all(parametrised)[0]


def lawful_at_all(parametrised: Sequence[tuple[np.ndarray, float]]) -> tuple[list[np.ndarray], np.ndarray]:
    """Force laws as of `shared_laws`, and which of the samples they are of (n,)."""
    lawful = np.logical_and.reduce([forcelaw.admissible(vectors, limit) for vectors, limit in parametrised])
    return [forcelaw.coefficients(vectors[lawful], limit) for vectors, limit in parametrised], lawful


# Slopes


def slopes(inputs: Sequence[Input], respond: Respond) -> np.ndarray:
    """Slopes of the logarithm of the response and their standard errors, (inputs, 2)."""
    with_errors = []
    for entry in progress(inputs, "inputs"):
        with explain_errors(f"This is the contact with less or more of the input {entry.name}."):
            with_errors.append(_slope(respond(entry.states), entry.step))
    return np.array(with_errors).reshape(len(inputs), 2)


def bends(inputs: Sequence[Input], respond: Respond) -> np.ndarray:
    """Curvatures b of the logarithm of the response, g x + b x² around an input, zero without a middle (inputs,)."""
    return np.array([_bend(entry, respond) if entry.middle else 0.0 for entry in inputs])


def limits_of(inputs: Sequence[Input]) -> dict[str, tuple]:
    """Variable with the errors of the inputs beyond which they count as there, none if all errors count."""
    limits = np.reshape([entry.limits for entry in inputs], (-1, 2))
    return {"limit": (("input", "end"), limits)} if np.isfinite(limits).any() else {}


def _bend(entry, respond):
    """Curvature of one input from three states with the same samples."""
    less, more = entry.states
    responses = respond([less, entry.middle, more])
    low, centre, high = np.log([responses.centre_of_slopes(values) for values in responses.values])
    return (low + high - 2 * centre) / 2 / (entry.step / 2) ** 2


def _slope(responses, step):
    """Slope between two states and its standard error, of the devices and of their common samples."""
    value, error = log_slope(responses.centre_of_slopes, *responses.values, step)
    if responses.shared is None:
        return value, error
    return value, np.hypot(error, log_slope(responses.length, *responses.shared, step)[1])


def effect(base: InputState, changed: InputState, respond: Respond) -> tuple[float, float]:
    """Relative change of the response by another choice of the model, with its standard error [-]."""
    responses = respond([base, changed])
    return choice_effect(*map(responses.centre_of_slopes, responses.values)), _slope(responses, 1.0)[1]


def effect_if_known(base: InputState, changed: InputState, respond: Respond) -> tuple[float, float]:
    """As `effect`, NaN where nothing can be computed under the choice.

    Without attraction across gaps, patches that do not resist the adhesion have no bound.
    """
    try:
        return effect(base, changed, respond)
    except ValueError:
        traceback.print_exc()  # the log keeps where the reason arose, should it be an error of the code
        return np.nan, np.nan


# Dataset


def layout(
    inputs: Sequence[Input],
    slopes: np.ndarray,
    covariance: np.ndarray,
    devices: Responses,
    effects: Mapping[str, tuple[float, float]],
    settings: AnyBudget,
) -> xr.Dataset:
    """Dataset of the budget of a device at one humidity.

    Slopes d ln y / dx of k inputs with their standard errors (k, 2), covariance of the errors of the inputs (k, k),
    lengths or forces of all devices at the stated inputs, and relative effects of other choices of the model, each with
    its standard error [-].
    """
    names = [entry.name for entry in inputs]
    groups = [entry.group for entry in inputs]
    (values,) = devices.values
    finite, centre = values[np.isfinite(values)], devices.centre(values)
    changes = np.array(list(effects.values())).reshape(len(effects), 2)
    response = {"units": SOUGHT_BY[settings.response].unit, "response": settings.response, "share": settings.share}
    return xr.Dataset(
        {
            "slope": ("input", slopes[:, 0]),
            "slope_error": ("input", slopes[:, 1]),
            "bend": ("input", np.zeros(len(inputs))),
            "covariance": (("input", "other"), covariance),
            "group": ("input", groups),
            "centre": ((), centre if np.isfinite(centre) else np.nan, response),
            "scatter": ((), finite.std(ddof=1) / finite.mean() if len(finite) > 1 else np.nan),
            "effect": ("choice", changes[:, 0]),
            "effect_error": ("choice", changes[:, 1]),
        },
        coords={
            "input": names,
            "other": names,
            "choice": list(effects),
            "exact": [name for name in countable(settings.sizes, settings) if name not in groups],
        },
    )


def members_of(dataset: xr.Dataset) -> dict[str, xr.Dataset]:
    """Parts of a budget on the members of each assumed surface, by surface, none without any."""
    surfaces = dict.fromkeys(map(str, dataset.member_of.values)) if "member" in dataset.dims else ()
    return {name: dataset.isel(member=np.flatnonzero(dataset.member_of == name)) for name in surfaces}


def budget_of(dataset: xr.Dataset) -> Budget:
    """Budget from its dataset. Members are inputs, such as ``B2 like Sub1``, with shifts as slopes."""
    names = tuple(map(str, dataset.input.values))
    budgets = [Budget(names, dataset.slope.values, dataset.covariance.values)]
    for surface, members in members_of(dataset).items():
        kind = tuple(like(surface, str(member)) for member in members.member.values)
        budgets.append(Budget(kind, members.member_shift.values, weights_of_kind(len(kind)), (kind,)))
    return joined(budgets)


def slope_errors_of(dataset: xr.Dataset) -> np.ndarray:
    """Standard errors of the slopes of all inputs of `budget_of` (k,)."""
    of_members = [members.member_error.values for members in members_of(dataset).values()]
    return np.concatenate([dataset.slope_error.values, *of_members])


def groups_of(dataset: xr.Dataset) -> dict[str, list[str]]:
    """Inputs by the measurement for them."""
    groups = {}
    for name, group in zip(dataset.input.values, dataset.group.values, strict=True):
        groups.setdefault(str(group), []).append(str(name))
    for surface, members in members_of(dataset).items():
        groups[f"the surface {surface}"] = [like(surface, str(member)) for member in members.member.values]
    return groups


def response_of(dataset: xr.Dataset) -> tuple[str, float]:
    """Quantity changed by the inputs, ``S_SHAPE``, ``ARC`` or ``FORCE``, and the fraction p of an arc [-]."""
    return dataset.centre.attrs["response"], float(dataset.centre.attrs["share"])


def _inputs(plan, device):
    """Datasets of the surfaces of a device with uncertain quantities, and estimates of those described by scans."""
    names = dict.fromkeys(surface for surface, _ in plan.devices.quantities(device))
    scanned = plan.scans.sides(plan.config["devices"][device]["pair"])
    described = {stage: {name: f"{stage}/{name}" for name in names} for stage in ("heights", "spectrum")}
    return described | {"estimates": {name: f"estimate/{name}" for name in scanned}}


def settings_of(plan: Any, at: At) -> dict[str, Any]:
    """Settings of a budget, the quantities of its surfaces and its variants of the model."""
    name, devices = at.case.device, plan.devices
    section = plan.config["devices"][name]
    pair = plan.contact_of_device(at.case)
    uncertainty = {key: value for key, value in section.get("uncertainty", {}).items() if key != EDGE_RADIUS.key}
    budget = {"uncertainty": uncertainty, "humidity": at.case.humidity}
    budget |= plan.materials.modulus(pair)
    properties = devices.uncertain_properties(name)
    replica = plan.replica(pair).get("replica", {})
    budget |= {entry.key: replica.get(entry.key, 0.0) for name, entry in OF_REPLICAS.items() if name in properties}
    if "hamaker_constant" in properties:
        budget |= {"hamaker_constant_zJ": plan.air.beam_hamaker_constant(pair), "alike": plan.materials.alike(pair)}
    beam = own_section(plan, name, pair)
    budget |= beam | {"beams": plan.config["design"]["budget_beams"]} if beam else subsection(section, ["contact_um"])
    budget |= {"seed": plan.config["seed"], "water": plan.air_of_devices.water(pair), "surfaces": plan.sides(pair)}
    errors = {surface: error.section for surface, error in devices.surface_errors(name).items() if error.quantities}
    budget |= {"known": errors} if errors else {}
    settings = {"budget": budget, "quantities": list(map(list, devices.quantities(name)))}
    if by_surface := devices.members(name):
        words = {surface: list(next(iter(members.values()))) for surface, members in by_surface.items()}
        budget["assumed"] = {surface: {"quantities": assumed} for surface, assumed in words.items()}
        settings["members"] = [[surface, member] for surface, members in by_surface.items() for member in members]
    return _with_choices(plan, pair, settings, plan.variants.choices_of_device(at.case))


def _with_choices(plan, pair, settings, choices):
    """Settings of a budget with its choices of the model, and with the water of choices with another."""
    changed = plan.variants.water_of_choices(pair, choices)
    budget = settings["budget"] | ({"waters": changed} if changed else {})
    return settings | {"budget": budget, "choices": choices}


def settings_of_tips(plan: Any, at: At, share: float | None = None) -> dict[str, Any]:
    """Settings of `settings_of`, for the length of a fraction of stuck tips, by default the middle one."""
    settings, shares = settings_of(plan, at), plan.config["design"]["shares"]
    budget = {key: value for key, value in settings["budget"].items() if key not in ("beams", "waters")}
    budget |= {"uncertainty": plan.config["devices"][at.case.device].get("uncertainty", {})}
    budget |= {"edge_radius_um": plan.devices.edge_radius(at.case.device)}
    settings |= {"budget": budget | {"share": share or shares[len(shares) // 2]}}
    pair = plan.contact_of_device(at.case)
    return _with_choices(plan, pair, settings, plan.variants.choices_of_solids(pair))


def _budget_of_job(data, settings):
    """Budget from the contacts with less and with more of every input, and those under other choices of the model."""
    corrected = with_correction(budget_settings(settings["budget"]), data)
    described = {name: (heights, data["spectrum"][name]) for name, heights in data["heights"].items()}
    shifted = {key: (less, data["more"][key]) for key, less in data["less"].items()}
    properties = {name: (less, data["properties_more"][name]) for name, less in data["properties_less"].items()}
    surface_errors = covariances(described, data["estimates"], corrected)
    budget = compute(data["contact"], shifted, properties, data["choices"], surface_errors, corrected)
    if not (names := list(map(tuple, settings.get("members", ())))):
        return budget
    return with_members(budget, data["contact"], data["members"], names, corrected)


def budgets_of(plan: Any, *devices: str) -> dict[tuple, str]:
    """Datasets of the budgets of devices by name and humidity, and ``tip`` if they are of tips."""
    names = plan.devices.budgets(*devices) if devices else []
    cases = {name: Case(name.removesuffix("_tip")) for name in names}
    return {
        (case.device, case.humidity, *(["tip"] if name != case else [])): f"devices/budget/{name}"
        for name, case in cases.items()
    }


def _memory_of_tips(plan, view, names):
    """Memory of the largest budget of tips, with all its contacts [MB]. ``view`` has these beams as devices."""
    slopes = []
    for name in names:
        contacts = contacts_of_tip_budget(view, case_id(name, view.devices.sections[name]["humidities"][0]))
        left_out = ["contact", "members"] + ["choices"] * (view is not plan)
        changed = sum(len(files) for kind, files in contacts.items() if kind not in left_out)
        tips = TIPS.samples(plan, None) + changed * TIPS.fewer(plan, None)
        tips += len(contacts["members"]) * samples_on(TIPS, plan, None)
        slopes.append(tips * len(plan.devices.tilt(view.devices.tips(name))["slopes"]))
    return memory.tip_memory(max(slopes, default=0))


BUDGET = Stage.writing(
    "budget",
    "devices/budget/{case}",
    inputs=lambda plan, at: _inputs(plan, at.case.device) | contacts_of_budget(plan, at.case),
    settings=settings_of,
    compute=_budget_of_job,
    message="Budget of {case}.",
    running=Running(minutes=120),
)


def budgets_of_arrays(plan: Any, device: str) -> dict[tuple, str]:
    """Datasets of the budgets of the test beams of a device, by array and humidity, and ``tip`` if of counted tips."""
    budgets = {}
    for name in plan.config["devices"][device].get("test_beams", []):
        array = plan.config["test_beams"][name]
        for humidity in test_beams.humidities(array):
            budgets[name, humidity] = f"{OF_ARRAYS}/{case_id(name, humidity)}"
        for humidity in test_beams.humidities(array, "stuck"):
            budgets[name, humidity, "tip"] = f"{OF_ARRAYS}/{case_id(name, humidity)}_tip"
    return budgets


def budgets_of_pull_offs(plan: Any, device: str) -> dict[tuple, str]:
    """Datasets of the budgets of the probes whose pull-off forces a device has, by test beams and humidity."""
    return {
        (name, datum["humidity"]): f"devices/budget/{case_id(section['probe'], datum['humidity'])}"
        for name, section in test_beams.pulled(plan.config, device).items()
        for datum in section[test_beams.PULL_OFFS]
    }


def _inputs_of_test_beams(contacts):
    """Inputs of a cantilever, or of its tips. Other choices of the model are left out."""

    def inputs(plan, at):
        """Inputs of an array, as of a device."""
        plan, name = plan.with_test_beams, at.case.device
        return _inputs(plan, name) | contacts(plan, at.case) | {"choices": {}}

    return inputs


STAGES = (
    BUDGET.on("budget", "devices/budget/{case}"),
    BUDGET.on(
        "tip_budget",
        "devices/budget/{case}_tip",
        inputs=lambda plan, at: _inputs(plan, at.case.device) | contacts_of_tip_budget(plan, at.case),
        settings=settings_of_tips,
        running=Running(
            minutes=120,
            memory=lambda plan: _memory_of_tips(
                plan, plan, [name for name in plan.devices.with_budget if name in plan.devices.with_tips]
            ),
        ),
        label="budget",
        message="Budget of the tips of {case}.",
    ),
    BUDGET.on(
        "test_beam_budget",
        OF_ARRAYS + "/{case}",
        inputs=_inputs_of_test_beams(contacts_of_budget),
        settings=lambda plan, at: _with_choices(plan, "", settings_of(plan.with_test_beams, at), []),
        label="budget",
        message="Budget of test beams {case}.",
    ),
    BUDGET.on(
        "test_beam_tip_budget",
        OF_ARRAYS + "/{case}_tip",
        inputs=_inputs_of_test_beams(contacts_of_tip_budget),
        settings=lambda plan, at: _with_choices(plan, "", settings_of_tips(plan.with_test_beams, at, HALF), []),
        running=Running(
            minutes=120,
            memory=lambda plan: _memory_of_tips(plan, plan.with_test_beams, test_beams.counts_as_devices(plan.config)),
        ),
        label="budget",
        message="Budget of the tips of test beams {case}.",
    ),
)
