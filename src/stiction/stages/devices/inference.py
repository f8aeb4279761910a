"""Stage test_beams: what the crack lengths of test beams say about the inputs of a device, and what follows for it.

Device and test beams have budgets of the same form (`stiction.stages.devices.budget`). Their dimensions are inputs of
their own; all other inputs of the same name are one input.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import xarray as xr

from stiction.beam.energy import arrest_length
from stiction.config.cases import case_id
from stiction.devices import inference
from stiction.devices.inference import Discrepancy, Knowledge, Lengths
from stiction.plan.stage import Stage
from stiction.stages.devices.budget import budgets_of, budgets_of_arrays, response_of
from stiction.stages.devices.releases import ARC, EITHER, LONG, S_SHAPE, DesignedBeam, section_of_beam

#: Inputs that are those of one device or array alone.
OWN = ("thickness", "gap")
#: Numbers of further test beams for which the gain is stated.
FURTHER = (10, 100)
#: What holds a device, as in its safe lengths, by what its budget is of; lengths in either shape are those of tips.
SHAPES = {S_SHAPE: S_SHAPE, ARC: EITHER}
#: Keys of a datum of the configuration.
_COLUMNS = ("humidity", "mean_um", "std_um", "beams")


@dataclass(frozen=True)
class CrackLengths:
    """Measured crack lengths of an array, one mean for every humidity."""

    length: float  #: of the beams [m]
    humidity: tuple[float, ...]  #: [-]
    mean: tuple[float, ...]  #: [m]
    std: tuple[float, ...]  #: between the beams [m]
    beams: tuple[int, ...]  #: number of measured beams


@dataclass(frozen=True)
class Settings:
    """Everything that the update depends on apart from budgets and safe lengths."""

    discrepancy: Discrepancy
    device: DesignedBeam
    arrays: dict[str, DesignedBeam]  #: test beams by the name of their array
    crack_lengths: dict[str, CrackLengths]  #: by array


class Result(NamedTuple):
    """One length with a budget, of the device or of test beams."""

    owner: str  #: the device or the array
    humidity: float  #: [-]
    budget: xr.Dataset
    beam: DesignedBeam

    @property
    def response(self) -> str:
        """What holds it, ``S_SHAPE`` or ``ARC``."""
        return response_of(self.budget)[0]

    @property
    def reduced(self) -> float:
        """u, the logarithm of the crack length over that at an adhesion energy of 1 J/m² [-]."""
        return float(np.log(self.budget.centre / arrest_length(1.0, self.beam.beam)))

    @property
    def names(self) -> list[str]:
        """Names of its inputs among those of all results."""
        return [f"{name} of {self.owner}" if name in OWN else name for name in map(str, self.budget.input.values)]

    @property
    def scatter(self) -> float:
        """Standard deviation of ln l between beams [-]."""
        return float(self.budget.scatter)

    @property
    def own(self) -> list[str]:
        """Names of the inputs that no other result has, and of the rest of the model."""
        return [*(f"{name} of {self.owner}" for name in OWN), inference.rest(self.condition)]

    @property
    def condition(self) -> str:
        """Under which the model errs by the same rest."""
        return f"{self.owner}, RH {self.humidity:g}{', arc' if self.response == ARC else ''}"


def compute(
    budgets: Mapping[tuple, xr.Dataset],
    test_beams: Mapping[tuple[str, float], xr.Dataset],
    safe_lengths: Mapping[float, xr.Dataset],
    settings: Settings,
) -> xr.Dataset:
    """Inputs, lengths and safe lengths of a device before and after its test beams were measured.

    Parameters
    ----------
    budgets : dict
        Device, humidity and, for tips, more to the dataset of its budget.
    test_beams : dict
        Array and humidity to the dataset of its budget.
    safe_lengths : dict
        Humidity to the dataset of stage safe_lengths of the device.
    settings : Settings
    """
    beams = [Result(*key, one, settings.arrays[key[0]]) for key, one in test_beams.items()]
    of_device = [Result(*key[:2], one, settings.device) for key, one in budgets.items()]
    inputs = common_inputs([*beams, *of_device])
    prior, responses = with_discrepancy(inputs, beams, of_device, settings.discrepancy)
    data = measured(beams, responses[: len(beams)], settings.crack_lengths)
    posterior = inference.given(prior, data)
    device = responses[len(beams) :]
    found = [
        of_inputs(prior, posterior, len(inputs.names) + 2),
        of_data(beams, data, prior, posterior, settings),
        of_lengths(of_device, device, inputs, prior, posterior),
        of_further(beams, of_device, responses, posterior),
    ]
    alone = Lengths(data.responses[:, : len(inputs.names)], data.differences, data.errors)
    p_values = {"p_value": inference.p_value(prior, data), "p_value_of_inputs": inference.p_value(inputs, alone)}
    found.append(xr.Dataset({name: ((), value, {"units": "1"}) for name, value in p_values.items()}))
    return updated(xr.merge(found, combine_attrs="no_conflicts"), safe_lengths)


def common_inputs(results: Sequence[Result]) -> Knowledge:
    """Inputs of all results and the covariance of their errors, as their budgets state it."""
    names = list(dict.fromkeys(name for one in results for name in one.names))
    covariance = np.zeros((len(names), len(names)))
    for one in results:
        at = [names.index(name) for name in one.names]
        covariance[np.ix_(at, at)] = one.budget.covariance.values
    return Knowledge(tuple(names), np.zeros(len(names)), covariance)


def with_discrepancy(
    inputs: Knowledge, beams: Sequence[Result], of_device: Sequence[Result], stated: Discrepancy
) -> tuple[Knowledge, np.ndarray]:
    """As `stiction.devices.inference.with_discrepancy`; responses are those of test beams and, after them, of a device.

    ASSUME: cracks say nothing about how much the model errs at tips. Without a discrepancy, their length has the
    uncertainty of its budget; no model holds shorter arcs than saturated air does.
    """
    results = [*beams, *of_device]
    responses = np.zeros((len(results), len(inputs.names)))
    for row, one in zip(responses, results, strict=True):
        row[[inputs.names.index(name) for name in one.names]] = one.budget.slope.values
    reduced = np.array([one.reduced for one in results]) - np.mean([one.reduced for one in beams])
    conditions = [None if one.response == ARC else one.condition for one in results]
    return inference.with_discrepancy(inputs, responses, reduced, conditions, stated)


def measured(beams: Sequence[Result], responses: np.ndarray, found: Mapping[str, CrackLengths]) -> Lengths:
    """Measured mean crack lengths beside those that were computed.

    ASSUME: the crack lengths of single beams are independent; the error of a computed mean is negligible.
    """
    means, errors = [], []
    for one in beams:
        lengths = found[one.owner]
        at = lengths.humidity.index(one.humidity)
        means.append(lengths.mean[at])
        errors.append(lengths.std[at] / lengths.mean[at] / np.sqrt(lengths.beams[at]))
    computed = [float(one.budget.centre) for one in beams]
    return Lengths(responses, np.log(np.array(means) / computed), np.array(errors))


# Datasets


def of_inputs(prior: Knowledge, posterior: Knowledge, count: int) -> xr.Dataset:
    """The first inputs before and after the measurement, and their combinations that the data determine or do not."""
    before, after = (
        Knowledge(one.names[:count], one.mean[:count], one.covariance[:count, :count]) for one in (prior, posterior)
    )
    combinations = inference.combinations(before, after)
    return xr.Dataset(
        {
            "prior_deviation": ("input", before.deviations),
            "shift": ("input", after.mean),
            "deviation": ("input", after.deviations),
            "correlation": (("combination", "input"), [one.correlations for one in combinations], {"units": "1"}),
            "remaining": ("combination", [one.remaining for one in combinations], {"units": "1"}),
        },
        coords={"input": list(before.names)},
    )


def of_data(
    beams: Sequence[Result], data: Lengths, prior: Knowledge, posterior: Knowledge, settings: Settings
) -> xr.Dataset:
    """Measured and computed crack lengths, and those that are expected before and after the measurement."""
    computed = np.array([float(one.budget.centre) for one in beams])
    lengths = {"measured": computed * np.exp(data.differences), "computed": computed}
    lengths |= {"beam_length": [settings.crack_lengths[one.owner].length for one in beams]}
    numbers = {"measured_error": data.errors} | _both(prior, posterior, data.responses)
    lengths |= {size: [getattr(one.beam, size) for one in beams] for size in OWN}
    numbers |= {"rest": posterior.mean[[posterior.names.index(inference.rest(one.condition)) for one in beams]]}
    return xr.Dataset(
        {name: ("datum", value, {"units": "m"}) for name, value in lengths.items()}
        | {f"datum_{name}": ("datum", value, {"units": "1"}) for name, value in numbers.items()},
        coords={
            "datum": [one.condition for one in beams],
            "array": ("datum", [one.owner for one in beams]),
            "datum_humidity": ("datum", [one.humidity for one in beams]),
        },
        attrs={"rest": settings.discrepancy.rest},
    )


def _both(prior, posterior, responses):
    """Standard deviations before, shifts and standard deviations after the measurement, of ln l."""
    shift, after = posterior.of(responses)
    return {"before": prior.of(responses)[1], "shift": shift, "after": after}


def of_lengths(
    of_device: Sequence[Result], responses: np.ndarray, inputs: Knowledge, prior: Knowledge, posterior: Knowledge
) -> xr.Dataset:
    """Lengths of a device before and after the measurement: mean crack lengths, and lengths that few tips hold."""
    numbers = {"of_inputs": inputs.of(responses[:, : len(inputs.names)])[1]} | _both(prior, posterior, responses)
    return xr.Dataset(
        {"length": ("result", [float(one.budget.centre) for one in of_device], {"units": "m"})}
        | {f"length_{size}": ("result", [getattr(one.beam, size) for one in of_device], {"units": "m"}) for size in OWN}
        | {f"length_{name}": ("result", value, {"units": "1"}) for name, value in numbers.items()},
        coords={
            "result": [one.condition for one in of_device],
            "response": ("result", [one.response for one in of_device]),
            "humidity_of_result": ("result", [one.humidity for one in of_device]),
        },
    )


def of_further(
    beams: Sequence[Result], of_device: Sequence[Result], responses: np.ndarray, posterior: Knowledge
) -> xr.Dataset:
    """Standard deviations of the lengths of a device if further test beams were measured.

    These are more beams of an array at one of its humidities, or a new array like the device at one of its humidities,
    whose dimensions and rest of the model are then its own.
    """
    device = responses[len(beams) :]
    further = [(one, row, 0.0) for one, row in zip(beams, responses, strict=False)]
    for one, row in zip(of_device, device, strict=True):
        if one.response != ARC:
            own = np.isin(posterior.names, one.own)
            further.append((one, np.where(own, 0, row), float(np.linalg.norm((row * posterior.deviations)[own]))))
    left = [
        [
            [
                inference.further_beams(posterior, target, row, np.hypot(one.scatter / np.sqrt(n), apart))
                for n in FURTHER
            ]
            for one, row, apart in further
        ]
        for target in device
    ]
    return xr.Dataset(
        {
            "length_after_further": (("result", "further", "beams"), left, {"units": "1"}),
            "further_length": ("further", [LONG * float(one.budget.centre) for one, *_ in further], {"units": "m"}),
        },
        coords={"further": [one.condition for one, *_ in further], "beams": list(FURTHER)},
    )


def updated(found: xr.Dataset, safe_lengths: Mapping[float, xr.Dataset]) -> xr.Dataset:
    """The dataset with the safe lengths of the device before and after the measurement.

    ASSUME: safe lengths shift as the mean length of S-shapes, or as the length that few tips hold, as the budgets do.
    """
    safe = xr.concat([one.safe_length for one in safe_lengths.values()], "humidity").assign_coords(
        humidity=list(safe_lengths)
    )
    factors = xr.ones_like(safe.isel(share=0, drop=True))
    for response, shape in SHAPES.items():
        for at, shift in zip(*_shifts(found, response), strict=True):
            factors.loc[{"humidity": at, "shape": shape}] = np.exp(shift)
    return found.assign(safe_length=safe, updated_safe_length=safe * factors)


def _shifts(found, response):
    """Humidities and shifts of ln l of the results of a response."""
    chosen = found.isel(result=np.flatnonzero(found.response.values == response))
    return chosen.humidity_of_result.values, chosen.length_shift.values


# Stage


def _settings(plan, at):
    """Dimensions of a device and of its test beams, what was measured, and the discrepancy of the model."""
    names = plan.config["devices"][at.device]["test_beams"]
    arrays = {name: plan.config["test_beams"][name] for name in names}
    return {
        "discrepancy": plan.config["design"]["discrepancy"],
        "device": section_of_beam(plan, at.device),
        "arrays": {name: section_of_beam(plan.of_test_beams, name) for name in names},
        "crack_lengths": {
            name: {key: [datum[key] for datum in array["crack_lengths"]] for key in _COLUMNS}
            | {"length_um": array["length_um"]}
            for name, array in arrays.items()
        },
    }


STAGES = (
    Stage.writing(
        "test_beams",
        "devices/test_beams/{device}",
        inputs=lambda plan, at: {
            "budgets": budgets_of(plan, at.device),
            "test_beams": budgets_of_arrays(plan, at.device),
            "safe_lengths": {
                rh: f"devices/safe_lengths/{case_id(at.device, rh)}"
                for rh in plan.config["devices"][at.device]["humidities"]
            },
        },
        settings=_settings,
        kind=Settings,
        compute=lambda data, at, settings: compute(data["budgets"], data["test_beams"], data["safe_lengths"], settings),
        message="Test beams of device {device}.",
    ),
)
