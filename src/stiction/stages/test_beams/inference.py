"""Stage test_beams: evidence of crack lengths, counts and pull-off forces about a device, and its consequences.

Device and test beams have budgets of the same form (`stiction.stages.devices.budget`). Their dimensions are inputs of
their own; all other inputs of the same name are one input.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from statistics import fmean, stdev
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.interpolate import PPoly
from scipy.special import ndtr, ndtri

from stiction.beam.energy import CRACK_LENGTH_POWER, arrest_length
from stiction.beam.foundation import foundation_length
from stiction.config.cases import case_id
from stiction.config.test_beams import PULL_OFFS, humidities, pulled
from stiction.contact.air import Air
from stiction.contact.environment import Water
from stiction.devices import arcs, inference, risk
from stiction.devices.inference import Counts, CrackData, DiscrepancyOfModel, KnownInputs
from stiction.estimates import mean_with_error
from stiction.plan.stage import Stage
from stiction.stages.contact import curves
from stiction.stages.contact.corrections import applied
from stiction.stages.devices.budget import (
    budgets_of,
    budgets_of_arrays,
    budgets_of_pull_offs,
    response_of,
    shared_laws,
)
from stiction.stages.devices.contact_names import contact_of, corrections_of, tips_of
from stiction.stages.devices.opening import (
    ARC,
    EITHER,
    FORCE,
    LONG,
    S_SHAPE,
    DesignedBeam,
    own_section,
    section_of_beam,
)
from stiction.stages.devices.results import results_of
from stiction.stages.devices.uncertain_inputs import OF_BEAMS
from stiction.streams import stream

#: Inputs that are those of one device or array alone: its dimensions.
BEAM_SIZES = tuple(entry.name for entry in OF_BEAMS if entry.step)
#: p value below which data count as not explained.
UNLIKELY = 0.05
#: Numbers of further test beams for which the gain is stated.
FURTHER = (10, 100)
#: Points between the smallest and the largest share for which a safe length is stated.
_SMALL = 50
#: What may hold a counted beam.
_COUNTED = (S_SHAPE, ARC)
#: Keys of the data of the configuration.
_COLUMNS = {
    "crack_lengths": ("humidity", "mean_um", "std_um", "beams"),
    "stuck": ("humidity", "length_um", "stuck", "of"),
}


@dataclass(frozen=True)
class CrackLengths:
    """Measured crack lengths of an array, one mean for every humidity."""

    length: float  #: of the beams [m]
    humidity: tuple[float, ...]  #: [-]
    mean: tuple[float, ...]  #: [m]
    std: tuple[float, ...]  #: between the beams [m]
    beams: tuple[int, ...]  #: number of measured beams


@dataclass(frozen=True)
class StuckCounts:
    """Numbers of stuck beams of an array, one for every humidity and length."""

    water: Water
    humidity: tuple[float, ...]  #: [-]
    length: tuple[float, ...]  #: [m]
    stuck: tuple[int, ...]
    of: tuple[int, ...]  #: stuck and free together


@dataclass(frozen=True)
class PullOffs:
    """Measured pull-off forces of a probe, one mean for every humidity."""

    humidity: tuple[float, ...]  #: [-]
    mean: tuple[float, ...]  #: [N]
    std: tuple[float, ...]  #: between the forces, zero of a single one [N]
    number: tuple[int, ...]  #: of forces
    error: tuple[float, ...]  #: standard uncertainty of the mean by the calibration [N]


@dataclass(frozen=True)
class Settings:
    """Settings of the update, without budgets and safe lengths."""

    seed: int
    discrepancy: DiscrepancyOfModel
    arrays: dict[str, DesignedBeam]  #: test beams by the name of their array
    crack_lengths: dict[str, CrackLengths]  #: by array
    stuck: dict[str, StuckCounts]  #: by array
    device: DesignedBeam | None = None  #: none of a stopper
    pull_offs: dict[str, PullOffs] = field(default_factory=dict)  #: by the name of their test beams


def is_reliable(update: xr.Dataset) -> bool:
    """Whether inputs and model, as given, explain the data. Otherwise no result may rest on them."""
    return float(update.p_value) >= UNLIKELY


def shape_of(response: str) -> str:
    """Shape of adhesion in the safe lengths of a device, by its budget: tips give the lengths of either shape."""
    return EITHER if response == ARC else response


class Result(NamedTuple):
    """One length or force with a budget, of the device or of test beams."""

    owner: str  #: the device or the array
    humidity: float  #: [-]
    budget: xr.Dataset
    beam: DesignedBeam | None

    @property
    def response(self) -> str:
        """Response of its budget."""
        return response_of(self.budget)[0]

    @property
    def is_known(self) -> bool:
        """Whether enough of the simulated devices stick to show what its inputs change."""
        return bool(np.isfinite([self.budget.centre, *self.budget.slope]).all())

    @property
    def reduced(self) -> float:
        """Logarithm u of the crack length over the length at an adhesion energy of 1 J/m², zero of others [-]."""
        if self.response != S_SHAPE:
            return 0.0
        return float(np.log(self.budget.centre / arrest_length(1.0, self.beam.beam)))

    @property
    def names(self) -> list[str]:
        """Names of its inputs among those of all results."""
        return [
            f"{name} of {self.owner}" if name in BEAM_SIZES else name for name in map(str, self.budget.input.values)
        ]

    @property
    def scatter(self) -> float:
        """Standard deviation of ln l between beams [-]."""
        return float(self.budget.scatter)

    @property
    def own_inputs(self) -> list[str]:
        """Names of the inputs of this result alone, and of the rest of the model."""
        return [*(f"{name} of {self.owner}" for name in BEAM_SIZES), inference.rest(self.condition)]

    @property
    def condition(self) -> str:
        """Condition of one common rest of the model."""
        return f"{self.owner}, {Air(self.humidity).words}{', arc' if self.response == ARC else ''}"


def compute(
    budgets: Mapping[tuple, xr.Dataset],
    test_beams: Mapping[tuple, xr.Dataset],
    predicted: Mapping[float, xr.Dataset] | xr.Dataset,
    grounds: Mapping[tuple[str, str], xr.Dataset],
    tips: Mapping[tuple[str, str], xr.Dataset],
    settings: Settings,
    changes: Mapping[str, xr.Dataset] | None = None,
    forces: Mapping[str, xr.Dataset] | None = None,
) -> xr.Dataset:
    """Inputs, lengths and safe lengths, or forces, of a device before and after its test beams were measured.

    Budgets are by device or array, humidity and, for tips, more. What is predicted are the datasets of stage
    safe_lengths of a beam by humidity, or that of stage stoppers. ``grounds`` and ``tips`` are the contacts on which
    the beams of an array with counts stick, by array and kind of air, and those of their tips. ``changes`` are those of
    its contact by full elastic contact, if its beams are corrected: tips of the device have them as well. ``forces``
    are the datasets of stage stoppers of the probes with pull-off forces, by the name of their test beams.

    Data of test beams of which too few stick in the simulation say nothing, and are left out.
    """
    every = [Result(*key[:2], budget, settings.arrays.get(key[0])) for key, budget in test_beams.items()]
    of_arrays = [result for result in every if result.is_known]
    stuck = known_counts(_with_changes(settings.stuck, changes or {}), of_arrays)
    beams, of_tips, probes = (
        [result for result in of_arrays if result.response == response] for response in (S_SHAPE, ARC, FORCE)
    )
    of_device = [Result(*key[:2], budget, settings.device) for key, budget in budgets.items()]
    results = [*beams, *of_tips, *probes, *of_device]
    inputs = common_inputs(results)
    prior, responses = with_discrepancy(inputs, results, middle_of(beams, of_device), settings.discrepancy)
    of_probes = responses[len(beams) + len(of_tips) : len(of_arrays)]
    pull_offs = [pull_off(probe, settings.pull_offs[probe.owner], forces[probe.owner]) for probe in probes]
    lengths = with_pull_offs(length_data(beams, responses, settings.crack_lengths), of_probes, pull_offs)
    counts = count_data([*beams, *of_tips], responses, stuck, grounds, tips)
    posterior = inference.update(prior, lengths, counts, stream(settings.seed, "test beams", "counts"))
    device, number = responses[len(of_arrays) :], len(inputs.names)
    shown = [
        shown_at_tips(of_device, device, number, state)
        for state in (inference.given_lengths(prior, lengths), posterior)
    ]
    datasets = [
        input_dataset(prior, posterior, number + 2),
        length_dataset(beams, responses, prior, posterior, settings),
        count_dataset(counts, posterior, stuck),
        without_lengthening(result_dataset(of_device, device, number, prior, posterior), *shown),
        further_dataset(beams, responses, of_device, device, posterior),
        agreement_dataset(prior, lengths, counts, number),
        force_dataset(probes, of_probes, pull_offs, prior, posterior),
    ]
    left_out = "; ".join(result.condition for result in every if not result.is_known)
    merged = xr.merge(datasets, combine_attrs="no_conflicts").assign_attrs(left_out=left_out)
    return with_forces(merged, predicted) if settings.device is None else with_lengths(merged, predicted)


def middle_of(beams: Sequence[Result], of_device: Sequence[Result]) -> float:
    """Middle of u of all test beams, or of the cracks of the device where no beams say anything [-]."""
    cracks = [result.reduced for result in beams or of_device if result.response == S_SHAPE]
    return float(np.mean(cracks)) if cracks else 0.0


def common_inputs(results: Sequence[Result]) -> KnownInputs:
    """Inputs of all results and the covariance of their errors, as their budgets state it."""
    names = list(dict.fromkeys(name for result in results for name in result.names))
    covariance = np.zeros((len(names), len(names)))
    for result in results:
        at = [names.index(name) for name in result.names]
        covariance[np.ix_(at, at)] = result.budget.covariance.values
    return KnownInputs(tuple(names), np.zeros(len(names)), covariance)


def with_discrepancy(
    inputs: KnownInputs, results: Sequence[Result], middle: float, discrepancy: DiscrepancyOfModel
) -> tuple[KnownInputs, np.ndarray]:
    """Prior of inputs and model, and responses of all results, with the discrepancy of `stiction.devices.inference`.

    The slope of the model is about a ``middle`` of u [-], that of all test beams, counted or measured.

    ASSUME: test beams say nothing about how much the model errs at the middle of a bridge and at stoppers. These have
    the uncertainty of their budget. Pull-off forces have it, too: they say nothing about how much the model of cracks
    errs, and what full elastic contact leaves uncertain of them is in their errors.
    """
    responses = np.zeros((len(results), len(inputs.names)))
    for row, result in zip(responses, results, strict=True):
        row[[inputs.names.index(name) for name in result.names]] = result.budget.slope.values
    reduced = np.array([result.reduced for result in results]) - middle
    conditions = [result.condition if result.response == S_SHAPE else None for result in results]
    prior, responses = inference.with_discrepancy(inputs, responses, reduced, conditions, discrepancy)
    return prior, with_errors_of_cracks(results, responses, len(inputs.names))


def with_errors_of_cracks(results: Sequence[Result], responses: np.ndarray, number: int) -> np.ndarray:
    """Responses (n, k) with tips under the model error of the cracks of the same beams in the same air.

    The first ``number`` responses are to inputs, the others to the discrepancy of the model.

    ASSUME: an error of the model in the adhesion is that of the surfaces, and acts on tips as well, of test beams and
    of devices, measured or not.
    """
    pairs = list(zip(results, responses, strict=True))
    cracks = {(result.owner, result.humidity): row[number:] for result, row in pairs if result.response == S_SHAPE}
    shared = responses.copy()
    for result, row in zip(results, shared, strict=True):
        # Tips of test beams whose cracks are not known take no part.
        if result.response == ARC and (result.owner, result.humidity) in cracks:
            row[number:] = arcs.LENGTH_POWER / CRACK_LENGTH_POWER * cracks[result.owner, result.humidity]
    return shared


def shown_at_tips(of_device: Sequence[Result], responses: np.ndarray, number: int, state: KnownInputs) -> np.ndarray:
    """Change of ln l of tips by the expected error of the model, zero of other results (n,) [-]."""
    is_tip = np.array([result.response == ARC for result in of_device])
    return np.where(is_tip, responses[:, number:] @ state.mean[number:], 0.0)


def length_data(beams: Sequence[Result], responses: np.ndarray, crack_lengths: Mapping[str, CrackLengths]) -> CrackData:
    """Measured mean crack lengths beside the computed ones.

    ASSUME: the crack lengths of single beams are independent; the error of a computed mean is negligible.
    """
    differences, errors, rows = [], [], []
    for beam, row in zip(beams, responses, strict=False):
        if (at := _number_of_humidity(beam, crack_lengths)) is not None:
            mean, std, number = (getattr(crack_lengths[beam.owner], key)[at] for key in ("mean", "std", "beams"))
            differences.append(np.log(mean / float(beam.budget.centre)))
            errors.append(std / mean / np.sqrt(number))
            rows.append(row)
    return CrackData(np.reshape(rows, (-1, responses.shape[1])), np.array(differences), np.array(errors))


class PullOffData(NamedTuple):
    """Mean measured pull-off force of a probe at a humidity, beside the computed one."""

    measured: float  #: [N]
    computed: float  #: [N]
    error: float  #: standard error of ln(measured / computed) by anything but inputs [-]


def pull_off(result: Result, measured: PullOffs, stopper: xr.Dataset) -> PullOffData:
    r"""Pull-off force of a probe at one of m humidities, with the error of the logarithm of measured over computed.

    From the relative scatter s of n forces and s₀ of the sampled places, the uncertainty σ by the calibration, and σ₀
    by the simulation and its full elastic contact, this error has the variance

    .. math::

        R = \frac{s^2}{n} + m \left( \max(s_0^2 - s^2, 0) + \frac{\sigma^2}{F^2} \right)
            + \frac{\sigma_0^2}{F_0^2} .

    The dataset is that of stage stoppers.

    ASSUME: forces of one probe that scatter less than those of places on many probes have its own surface in common,
    and with it the rest of the variance, as a single force has. Here s is that part of the larger mean, because a probe
    that holds little would otherwise seem to scatter much.
    ASSUME: this and the calibration may be common to all humidities: m independent errors with m times the variance are
    no smaller in any combination, by the inequality of Cauchy and Schwarz, which is the safe side.
    """
    at, computed_forces = measured.humidity.index(result.humidity), stopper.sel(humidity=result.humidity)
    mean, std, forces = measured.mean[at], measured.std[at], computed_forces.pull_off.values
    expected, error = map(float, mean_with_error(forces))
    unexplained = max(forces.var(ddof=1) / expected**2 - (std / max(mean, expected)) ** 2, 0.0)
    common = len(measured.humidity) * (unexplained + (measured.error[at] / mean) ** 2)
    simulation = (error / expected) ** 2 + float(computed_forces.full_contact_error) ** 2
    variance = (std / mean) ** 2 / measured.number[at] + common + simulation
    return PullOffData(mean, expected, float(np.sqrt(variance)))


def with_pull_offs(lengths: CrackData, responses: np.ndarray, pull_offs: Sequence[PullOffData]) -> CrackData:
    """Data of crack lengths and of pull-off forces (n), with the responses of the latter (n, k)."""
    return CrackData(
        np.concatenate([lengths.responses, responses]),
        np.append(lengths.differences, [np.log(pull.measured / pull.computed) for pull in pull_offs]),
        np.append(lengths.errors, [pull.error for pull in pull_offs]),
    )


def _number_of_humidity(result, crack_lengths):
    """Place of a result of test beams among the humidities with measured crack lengths of its array."""
    measured_at = crack_lengths[result.owner].humidity if result.owner in crack_lengths else ()
    return measured_at.index(result.humidity) if result.humidity in measured_at else None


def known_counts(stuck: Mapping[str, StuckCounts], results: Sequence[Result]) -> dict[str, StuckCounts]:
    """Counts at humidities with results for every shape."""
    results_with_shape = {(result.owner, result.humidity, result.response) for result in results}
    counts = {}
    for name, data in stuck.items():
        at = [
            k
            for k, humidity in enumerate(data.humidity)
            if results_with_shape >= {(name, humidity, shape) for shape in _COUNTED}
        ]
        columns = ("humidity", "length", "stuck", "of")
        counts[name] = replace(data, **{key: tuple(getattr(data, key)[k] for k in at) for key in columns})
    return counts


def _with_changes(stuck, changes):
    """Counts of arrays with the corrections to full elastic contact of their tips, by array."""
    waters = {name: replace(stuck[name].water, correction=applied(error)) for name, error in changes.items()}
    return {name: replace(data, water=waters.get(name, data.water)) for name, data in stuck.items()}


def count_data(
    results: Sequence[Result],
    responses: np.ndarray,
    stuck: Mapping[str, StuckCounts],
    grounds: Mapping[tuple[str, str], xr.Dataset],
    tips: Mapping[tuple[str, str], xr.Dataset],
) -> Counts:
    """Numbers of stuck beams beside the lengths of stuck beams and tips.

    ASSUME: beams were counted whose tips had touched the substrate, and may be held by them. Crack lengths are
    lognormal.

    The results (n) are those of beams and tips of test beams, the first ones with responses (n or more, k); counts are
    by array, and contacts as in `compute`.
    """
    positions = {(result.owner, result.humidity, result.response): position for position, result in enumerate(results)}
    rows, lengths, scores = [], [], []
    for name, data in stuck.items():
        shapes = {}
        for humidity in set(data.humidity):
            on, cracks = (name, Air(humidity).kind), results[positions[name, humidity, S_SHAPE]]
            shapes[humidity] = lengths_and_scores(cracks, grounds[on], tips[on], data.water.at(humidity))
        for humidity, length in zip(data.humidity, data.length, strict=True):
            behind, of_humidity = shapes[humidity]
            rows.append(responses[[positions[name, humidity, shape] for shape in _COUNTED]])
            lengths.append(length - behind)
            scores.append(of_humidity)
    numbers = (np.concatenate([getattr(counted, key) for counted in stuck.values()] or [[]]) for key in ("stuck", "of"))
    shape = (-1, len(_COUNTED))
    return Counts(np.reshape(rows, (*shape, responses.shape[1])), np.reshape(lengths, shape), scores, *numbers)


def lengths_and_scores(
    cracks: Result, ground: xr.Dataset, tips: xr.Dataset, water: Water
) -> tuple[np.ndarray, list[PPoly]]:
    """Lengths of beams for an S-shaped crack and an arc (2,) [m], and the normal scores of both."""
    beam, humidity = cracks.beam.beam, cracks.humidity
    laws = shared_laws([curves.vectors(ground, humidity, water)])[0]
    longest_arcs = arcs.longest_free(*curves.tip_forces(tips, humidity, water), beam)
    scores = [inference.lognormal(float(cracks.budget.centre), cracks.scatter), inference.score(longest_arcs)]
    return np.array([risk.HOLD * foundation_length(beam, laws), 0.0]), scores


# Datasets


def input_dataset(prior: KnownInputs, posterior: KnownInputs, count: int) -> xr.Dataset:
    """First inputs before and after the measurement, and their combinations with or without evidence."""
    before, after = (first_inputs(state, count) for state in (prior, posterior))
    combinations = inference.combinations(before, after)
    return xr.Dataset(
        {
            "prior_deviation": ("input", before.deviations),
            "shift": ("input", after.mean),
            "deviation": ("input", after.deviations),
            "correlation": (("combination", "input"), [each.correlations for each in combinations]),
            "remaining": ("combination", [each.remaining for each in combinations]),
        },
        coords={"input": list(before.names)},
    )


def length_dataset(
    beams: Sequence[Result], responses: np.ndarray, prior: KnownInputs, posterior: KnownInputs, settings: Settings
) -> xr.Dataset:
    """Measured and computed crack lengths, and expected ones before and after the measurement.

    Those that were not measured, where beams were only counted, are not a number.
    """
    measured = [_measured_length(beam, settings.crack_lengths) for beam in beams]
    lengths = {"computed": [float(beam.budget.centre) for beam in beams]}
    lengths |= {key: [data[key] for data in measured] for key in ("measured", "beam_length")}
    numbers = {"measured_error": [data["error"] for data in measured]} | _moments(
        prior, posterior, responses[: len(beams)]
    )
    lengths |= {size: [getattr(beam.beam, size) for beam in beams] for size in BEAM_SIZES}
    numbers |= {"reduced": [beam.reduced for beam in beams]}
    numbers |= {"rest": posterior.mean[[posterior.names.index(inference.rest(beam.condition)) for beam in beams]]}
    return xr.Dataset(
        {name: ("datum", value) for name, value in lengths.items()}
        | {f"datum_{name}": ("datum", value) for name, value in numbers.items()}
        | _quantiles("datum", posterior, responses[: len(beams)]),
        coords={
            "datum": [beam.condition for beam in beams],
            "array": ("datum", [beam.owner for beam in beams]),
            "datum_humidity": ("datum", [beam.humidity for beam in beams]),
        },
        attrs={"rest": settings.discrepancy.rest},
    )


def _measured_length(result, crack_lengths):
    """Measured mean length, its relative standard error and the length of the beams [m], or no numbers."""
    at = _number_of_humidity(result, crack_lengths)
    if at is None:
        return dict.fromkeys(("measured", "error", "beam_length"), np.nan)
    data = crack_lengths[result.owner]
    error = data.std[at] / data.mean[at] / np.sqrt(data.beams[at])
    return {"measured": data.mean[at], "error": error, "beam_length": data.length}


def force_dataset(
    probes: Sequence[Result],
    responses: np.ndarray,
    pull_offs: Sequence[PullOffData],
    prior: KnownInputs,
    posterior: KnownInputs,
) -> xr.Dataset:
    """Measured and computed pull-off forces, and expected ones before and after; empty without any."""
    if not probes:
        return xr.Dataset()
    measured, computed_forces, errors = np.transpose(pull_offs)
    numbers = {"error": errors} | _moments(prior, posterior, responses)
    return xr.Dataset(
        {f"force_{name}": ("force", value) for name, value in numbers.items()}
        | {
            "measured_force": ("force", measured),
            "computed_force": ("force", computed_forces),
        },
        coords={
            "force": [probe.condition for probe in probes],
            "array_of_force": ("force", [probe.owner for probe in probes]),
            "humidity_of_force": ("force", [probe.humidity for probe in probes]),
        },
    )


def count_dataset(counts: Counts, posterior: KnownInputs, stuck: Mapping[str, StuckCounts]) -> xr.Dataset:
    """Counted beams and their P(stuck) before and after the measurement, for the expected inputs."""
    rows = [(name, *row) for name, data in stuck.items() for row in zip(data.humidity, data.length, strict=True)]
    names, humidities, lengths = zip(*rows, strict=True) if rows else ((), (), ())
    return xr.Dataset(
        {
            "stuck": ("count", counts.stuck),
            "counted": ("count", counts.beams),
            "stuck_before": ("count", counts.share(np.zeros_like(posterior.mean))),
            "stuck_after": ("count", counts.share(posterior.mean)),
        },
        coords={
            "array_of_count": ("count", np.array(names, str)),
            "humidity_of_count": ("count", np.array(humidities, float)),
            "length_of_count": ("count", np.array(lengths, float)),
        },
    )


def first_inputs(knowledge: KnownInputs, count: int) -> KnownInputs:
    """Knowledge of the first inputs alone."""
    return KnownInputs(knowledge.names[:count], knowledge.mean[:count], knowledge.covariance[:count, :count])


def agreement_dataset(prior: KnownInputs, lengths: CrackData, counts: Counts, number: int) -> xr.Dataset:
    """Agreement of the data with inputs and model, and with the first ``number`` inputs alone."""
    inputs = first_inputs(prior, number)
    alone = [replace(data, responses=data.responses[..., :number]) for data in (lengths, counts)]
    p_values = {
        "p_value": inference.p_value(prior, lengths, counts),
        "p_value_of_inputs": inference.p_value(inputs, *alone),
    }
    return xr.Dataset({name: ((), value) for name, value in p_values.items()})


def _moments(prior, posterior, responses):
    """Standard deviations before, shifts and standard deviations after the measurement, of ln l."""
    shift, after = posterior.response_moments(responses)
    return {"before": prior.response_moments(responses)[1], "shift": shift, "after": after}


def _quantiles(dimension, posterior, responses):
    """Quantiles of ln l after the measurement, less ln l as computed, by their normal scores."""
    quantiles = posterior.quantiles(responses)
    return {
        f"{dimension}_quantile": ((dimension, "score"), quantiles),
        "score": ("score", inference.SCORES),
    }


def result_dataset(
    of_device: Sequence[Result], responses: np.ndarray, number: int, prior: KnownInputs, posterior: KnownInputs
) -> xr.Dataset:
    """Results of a device before and after the measurement: mean crack lengths, lengths of few stuck tips, forces.

    The first ``number`` responses are to inputs.
    """
    numbers = {"of_inputs": first_inputs(prior, number).response_moments(responses[:, :number])[1]} | _moments(
        prior, posterior, responses
    )
    numbers |= {"reduced": [result.reduced for result in of_device]}
    centre = [float(result.budget.centre) for result in of_device], {"units": of_device[0].budget.centre.attrs["units"]}
    sizes = {size: [getattr(result.beam, size) for result in of_device] for size in BEAM_SIZES if of_device[0].beam}
    return xr.Dataset(
        {"centre": ("result", *centre)}
        | {f"own_{size}": ("result", values) for size, values in sizes.items()}
        | {f"result_{name}": ("result", value) for name, value in numbers.items()}
        | _quantiles("result", posterior, responses),
        coords={
            "result": [result.condition for result in of_device],
            "response": ("result", [result.response for result in of_device]),
            "humidity_of_result": ("result", [result.humidity for result in of_device]),
        },
    )


def without_lengthening(results: xr.Dataset, measured: np.ndarray, updated: np.ndarray) -> xr.Dataset:
    """Results with tips that are no longer than the inputs explain where only cracks say so, and their adhesion.

    The change of ln l of each by the expected error of the model is ``measured`` after crack lengths, and ``updated``
    after counts as well (n,) [-].

    ASSUME: where cracks show less adhesion than the inputs explain, tips do not adhere less, which is the safe side;
    they are as uncertain. Counted beams show it themselves: the tips of free ones do not hold them.
    """
    longer = xr.DataArray(np.maximum(np.minimum(measured, updated), 0), dims="result")
    moved = {name: results[name] - longer for name in ("result_shift", "result_quantile")}
    adhesion = np.exp(np.minimum(updated, 0) / arcs.LENGTH_POWER)
    return results.assign(moved | {"adhesion_of_tips": ("result", adhesion)})


def further_dataset(
    beams: Sequence[Result],
    responses: np.ndarray,
    of_device: Sequence[Result],
    device: np.ndarray,
    posterior: KnownInputs,
) -> xr.Dataset:
    """Standard deviations of the lengths of a device if further test beams were measured.

    These are more beams of an array at one of its humidities, or a new array like the device at one of its humidities,
    whose dimensions and rest of the model are then its own.
    """
    further = [(beam, row, 0.0) for beam, row in zip(beams, responses, strict=False)]
    for beam, row in zip(of_device, device, strict=True):
        if beam.response == S_SHAPE:
            own_inputs = np.isin(posterior.names, beam.own_inputs)
            further.append(
                (beam, np.where(own_inputs, 0, row), float(np.linalg.norm((row * posterior.deviations)[own_inputs])))
            )
    remaining = [
        [
            [
                inference.further_beams(posterior, target, row, np.hypot(beam.scatter / np.sqrt(n), apart))
                for n in FURTHER
            ]
            for beam, row, apart in further
        ]
        for target in device
    ]
    shape = len(of_device), len(further), len(FURTHER)
    return xr.Dataset(
        {
            "result_after_further": (("result", "further", "beams"), np.reshape(remaining, shape)),
            "further_length": ("further", [LONG * float(beam.budget.centre) for beam, *_ in further]),
        },
        coords={"further": [beam.condition for beam, *_ in further], "beams": list(FURTHER)},
    )


def with_lengths(update: xr.Dataset, safe_lengths: Mapping[float, xr.Dataset]) -> xr.Dataset:
    """Dataset with safe lengths before and after the measurement, and P(stuck) of beams of the former lengths.

    ASSUME: safe lengths shift as the mean length of S-shapes and bridges, or as the length that few tips hold, as the
    budgets do.
    """
    safe = xr.concat([dataset.safe_length for dataset in safe_lengths.values()], "humidity").assign_coords(
        humidity=list(safe_lengths)
    )

    def share(humidity, shape, length, quantiles):
        """P(stuck) of a length [m] at a humidity, after a shift with these quantiles."""
        lengths, shares = sticking(safe_lengths[humidity].sel(shape=shape))
        return inference.expected_share(np.log(length / lengths), np.diff(shares, prepend=0.0), quantiles)

    return update.assign(_before_and_after(update, safe) | _shares(update, safe, share))


def sticking(dataset: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Lengths of one shape (n,) [m] and P(stuck) at each [-]: estimated for the small shares, and counted above them.

    Too few beams are counted to give the small shares.
    """
    estimates = dataset.estimate.sortby("share")
    scores = ndtri(estimates.share.values)
    small = np.linspace(scores[0], scores[-1], _SMALL)
    lengths, shares = np.exp(np.interp(small, scores, np.log(estimates.values))), ndtr(small)
    above = (dataset.stuck.values > shares[-1]) & (dataset.length.values > lengths[-1])
    return (
        np.concatenate([lengths, dataset.length.values[above]]),
        np.concatenate([shares, dataset.stuck.values[above]]),
    )


def with_forces(update: xr.Dataset, stopper: xr.Dataset) -> xr.Dataset:
    """Dataset with safe forces of a stopper before and after, and P(stuck) at its restoring force.

    ASSUME: the forces of all patches shift as their mean.
    """
    safe = stopper.safe_force.sel(part="safe", drop=True).expand_dims(shape=[FORCE])
    at_spring = xr.full_like(safe.isel(share=0, drop=True), float(stopper.restoring_force))

    def share(humidity, _, force, quantiles):
        """P(stuck) of a restoring force [N] at a humidity, after a shift with these quantiles."""
        pull_offs = np.maximum(stopper.pull_off.sel(humidity=humidity).values, np.finfo(float).tiny)
        return inference.expected_share(
            np.log(pull_offs / force), np.full(len(pull_offs), 1 / len(pull_offs)), -quantiles[::-1]
        )

    return update.assign(_before_and_after(update, safe) | _shares(update, at_spring, share))


def _before_and_after(update, safe):
    """Safe lengths or forces before and after the measurement."""
    return {
        "safe": safe,
        "updated_safe": safe * np.exp(_by_shape(update, "result_shift").reindex_like(safe.isel(share=0))),
    }


def _by_shape(update, name):
    """Numbers of the results of a device by humidity and shape."""
    shapes = list(map(shape_of, update.response.values))
    keys = {"humidity": ("result", update.humidity_of_result.values), "shape": ("result", shapes)}
    return (
        update[name]
        .drop_vars(["result", "response", "humidity_of_result"])
        .assign_coords(keys)
        .set_index(result=["humidity", "shape"])
        .unstack("result")
    )


def _shares(update, sizes, share):
    """P(stuck) of some sizes before and after the measurement, averaged over the uncertainty of the inputs."""
    quantiles = {
        "expected_stuck": _by_shape(update, "result_before") * update.score,
        "updated_stuck": _by_shape(update, "result_quantile"),
    }
    stacked = sizes.stack(at=sizes.dims)
    expected = {name: [] for name in quantiles}
    for size in stacked:
        at = {"humidity": float(size.humidity), "shape": str(size["shape"].values)}
        for name, each in quantiles.items():
            expected[name].append(share(*at.values(), float(size), each.sel(at).values))
    return {
        name: stacked.copy(data=values).unstack("at").transpose(*sizes.dims).reindex_like(sizes)
        for name, values in expected.items()
    }


# Stage


def _settings(plan, at):
    """Dimensions of a device and of its test beams, the measured data, and the discrepancy of the model."""
    with_forces = pulled(plan.config, at.device)
    names = [name for name in plan.config["devices"][at.device]["test_beams"] if name not in with_forces]
    arrays = {name: plan.config["test_beams"][name] for name in names}
    data = {
        kind: {
            name: {key: [datum[key] for datum in array[kind]] for key in columns}
            for name, array in arrays.items()
            if kind in array
        }
        for kind, columns in _COLUMNS.items()
    }
    for name in data["crack_lengths"]:
        data["crack_lengths"][name]["length_um"] = arrays[name]["length_um"]
    for name in data["stuck"]:
        wettest = case_id(name, max(data["stuck"][name]["humidity"]))
        contact = plan.with_test_beams.contact_of_device(wettest)
        data["stuck"][name]["water"] = plan.air_of_devices.water(contact)
    common = {"seed": plan.config["seed"], "discrepancy": plan.config["design"]["discrepancy"]}
    common["arrays"] = {name: section_of_beam(plan.with_test_beams, name) for name in names}
    common |= {PULL_OFFS: {name: _of_forces(section) for name, section in with_forces.items()}} if with_forces else {}
    return data | own_section(plan, at.device) | common


def _of_forces(section):
    """Means of the measured pull-off forces of a probe."""
    forces = [datum["forces_nN"] for datum in section[PULL_OFFS]]
    return {
        "humidity": [datum["humidity"] for datum in section[PULL_OFFS]],
        "mean_nN": list(map(fmean, forces)),
        "std_nN": [stdev(values) if len(values) > 1 else 0.0 for values in forces],
        "number": list(map(len, forces)),
        "error_nN": [datum["error_nN"] for datum in section[PULL_OFFS]],
    }


def _forces(plan, device):
    """Forces of the probes with pull-off forces, none without any."""
    forces = {name: f"devices/stoppers/{section['probe']}" for name, section in pulled(plan.config, device).items()}
    return {"forces": forces} if forces else {}


def _contacts(plan, device):
    """Contacts of the counted test beams of a device, and of their tips, as in `compute`."""
    arrays, of_arrays = plan.config["test_beams"], plan.with_test_beams
    cases = {
        (name, Air(humidity).kind): case_id(name, humidity)
        for name in plan.config["devices"][device]["test_beams"]
        for humidity in humidities(arrays[name], "stuck")
    }
    return {
        "grounds": {key: contact_of(of_arrays, case) for key, case in cases.items()},
        "tips": {key: tips_of(of_arrays, case)["tips"] for key, case in cases.items()},
    } | _changes(of_arrays, {name for name, _ in cases})


def _changes(of_arrays, names):
    """Corrections to full elastic contact of some arrays, none where there are none."""
    corrections = {name: corrections_of(of_arrays, name) for name in sorted(names)}
    changes = {name: correction["model_error"] for name, correction in corrections.items() if correction}
    return {"changes": changes} if changes else {}


STAGES = (
    Stage.writing(
        "test_beams",
        "devices/test_beams/{device}",
        inputs=lambda plan, at: (
            {
                "budgets": budgets_of(plan, at.device),
                "test_beams": budgets_of_arrays(plan, at.device) | budgets_of_pull_offs(plan, at.device),
                "predicted": next(iter(results_of(plan, at.device, "lengths", "stopper").values())),
            }
            | _contacts(plan, at.device)
            | _forces(plan, at.device)
        ),
        settings=_settings,
        kind=Settings,
        compute=compute,
        message="Test beams of device {device}.",
    ),
)
