"""Stage budget: which input of a device moves its length, or the pull-off force of a stopper, by how much.

Slopes are central differences with common random numbers: sample k of two contacts has the same random numbers, and
device j meets the same samples on both sides. The chaos model is left out: force laws are those of the samples.

Dimensions and Young's modulus are changed by 5 %: a crack jumps from strip to strip, so that larger steps have smaller
errors. Stress, air and contact angle are changed by their standard uncertainty, those that cannot be below zero in one
direction only.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import xarray as xr

from stiction.beam.cantilever import Beam
from stiction.beam.energy import CRACK_LENGTH_POWER
from stiction.beam.montecarlo import Experiment, columns, simulate
from stiction.beam.release import EndState
from stiction.contact import forcelaw
from stiction.designs.releases import Device, addresses, long_beam
from stiction.devices import bridges
from stiction.devices.budget import STEP, Budget, choice_effect, joined, log_slope
from stiction.models import OF_MEASURED, OF_MOMENTS, OF_SPECTRUM
from stiction.progress import progress
from stiction.scans import moments
from stiction.stages import curves, heights, spectrum
from stiction.stages.curves import Water
from stiction.studies.scan_uncertainty import errors_of
from stiction.studies.slope_contact import difference
from stiction.surface.empirical import MeasuredDensity
from stiction.surface.translation import Translation

_MODULUS = "Young's modulus"
#: Factors of dimensions and of Young's modulus on either side, and the difference of their logarithms.
_FACTORS = 1 - STEP, 1 + STEP
_STEP = float(np.log(_FACTORS[1] / _FACTORS[0]))


@dataclass(frozen=True)
class Uncertainty:
    """Standard uncertainties of the inputs apart from the surfaces; zero where not stated."""

    thickness: float = 0.0  #: [m]
    gap: float = 0.0  #: [m]
    residual_stress: float = 0.0  #: [Pa]
    young_modulus: float = 0.0  #: [Pa]
    humidity: float = 0.0  #: [-]
    temperature: float = 0.0  #: [K]
    contact_angle: float = 0.0  #: of both surfaces together [rad]
    scan: float = 0.0  #: side of the scan that gave the moments of the surfaces that are described by numbers [m]


@dataclass(frozen=True)
class Settings:
    """Everything that a budget depends on apart from contact and surfaces."""

    seed: int
    water: Water
    humidity: float  #: [-]
    uncertainty: Uncertainty
    young_modulus: float  #: E of the body of the beam or stopper [Pa]
    device: Device | None = None  #: a beam; none for a stopper
    beams: int = 0  #: number of beams for every slope
    contact: tuple[float, float] = (0.0, 0.0)  #: sides of the patch of a stopper [m]


@dataclass(frozen=True)
class State:
    """Everything that devices depend on at one value of each input."""

    contact: xr.Dataset
    humidity: float  #: [-]
    water: Water
    device: Device | None = None  #: a beam; none for a stopper
    area: float = 0.0  #: of a stopper [m²]


@dataclass(frozen=True)
class Input:
    """One uncertain input of a device and the states around its value."""

    name: str  #: for reading
    group: str  #: of the inputs that one measurement determines, for reading
    states: tuple[State, State]  #: with less and with more of the input
    step: float  #: difference of the input between both


@dataclass(frozen=True)
class Responses:
    """Lengths [m] or forces [N] of the same devices at several states, and what they share."""

    values: np.ndarray  #: (states, devices); infinite where a beam has no S-shaped crack
    shared: np.ndarray | None  #: adhesion energies of the samples that all beams share (states, m) [J m⁻²]


#: Devices at several states.
Respond = Callable[[Sequence[State]], Responses]


def compute(
    contact: xr.Dataset,
    shifted: Mapping[tuple[str, str], tuple[xr.Dataset, xr.Dataset]],
    modulus: tuple[xr.Dataset, xr.Dataset] | None,
    choices: Mapping[str, xr.Dataset],
    known: Mapping[str, Budget],
    settings: Settings,
) -> xr.Dataset:
    """Slopes of all uncertain inputs of a device at a humidity, their covariance, scatter, and other model choices.

    Parameters
    ----------
    contact : Dataset
        Contact of the device.
    shifted : dict
        (surface, quantity) to the contact with less and with more of it.
    modulus : tuple or None
        Contact with less and with more of Young's modulus, by `stiction.devices.budget.STEP`, if it is uncertain.
    choices : dict
        Name of the choice to the contact under it; with fewer samples than ``contact``, that of the first ones.
    known : dict
        Surface to the covariance of its quantities, without slopes; the quantities of ``shifted``.
    settings : Settings
    """
    state = nominal(contact, settings)
    respond = responder(state, settings)
    inputs, covariance = uncertain(state, shifted, modulus, known, settings)
    found = slopes(inputs, respond)
    changes = {}
    for name, changed in choices.items():
        base = replace(state, contact=contact.isel(sample=slice(changed.sizes["sample"])))
        changes[name] = effect(base, replace(state, contact=changed), respond)
    devices = of_devices(respond([state]).values[0], settings.device)
    return layout(inputs, found, covariance, devices, changes, "m" if settings.device else "N")


def nominal(contact: xr.Dataset, settings: Settings) -> State:
    """State of a device with the stated inputs."""
    area = settings.contact[0] * settings.contact[1]
    return State(contact, settings.humidity, settings.water, settings.device, area)


def responder(state: State, settings: Settings) -> Respond:
    """How the devices respond: pull-off forces of all patches of a stopper, or crack lengths of long beams."""
    if settings.device is None:
        return of_stoppers
    laws = shared_laws([curves.vectors(state.contact, state.humidity, state.water)])[0]
    beam, strips = long_beam(settings.device, laws)
    number = settings.beams * settings.device.cracks
    return partial(of_beams, mesh=beam, strips=strips, number=number, address=addresses(settings))


def of_stoppers(states: Sequence[State]) -> Responses:
    """Pull-off forces of all sampled patches at several states."""
    forces = [curves.pull_offs(state.contact, state.humidity, state.water) * state.area for state in states]
    return Responses(np.array(forces), None)


def of_beams(states: Sequence[State], mesh: Beam, strips: int, number: int, address: Callable) -> Responses:
    """Crack lengths of the same beams at several states, on force laws resampled from the contact.

    Parameters
    ----------
    states : sequence of State
    mesh : Beam
        Length and elements of all beams.
    strips : int
        Number of force laws along a beam.
    number : int
        Number of beams.
    address : callable
        ``address(k)`` is the stream of beam k.
    """
    laws = shared_laws([curves.vectors(state.contact, state.humidity, state.water) for state in states])

    def cracks(state, laws):
        beam = replace(state.device.beam, length=mesh.length, elements=mesh.elements)
        ended = columns(list(simulate(Experiment(beam, strips, partial(_picked, laws)), range(number), address)))
        return np.where(ended["state"] == EndState.S_SHAPE, ended["crack_length"], np.inf)

    values = [cracks(state, of_state) for state, of_state in zip(states, laws, strict=True)]
    return Responses(np.array(values), forcelaw.energy(np.array(laws)))


def shared_laws(found: Sequence[tuple[np.ndarray, float]]) -> list[np.ndarray]:
    """Force laws of the samples that have one at every state, from vectors and f_limit of each; (m, 4) each."""
    lawful = np.logical_and.reduce([forcelaw.admissible(vectors, limit) for vectors, limit in found])
    return [forcelaw.coefficients(vectors[lawful], limit) for vectors, limit in found]


def _picked(laws, number, rng):
    """Laws drawn with replacement."""
    return laws[rng.integers(len(laws), size=number)]


def of_devices(values: np.ndarray, device: Device | None) -> np.ndarray:
    """Lengths at which devices stick, or forces: the two cracks of a bridge add up, (n,) of (n,) or (2n,).

    ASSUME: for a cantilever, the two foundation lengths that hold its crack are left out, 1 % of the length.
    """
    return values if device is None or device.cracks == 1 else bridges.sticking_lengths(values)


# Inputs


def uncertain(
    state: State,
    shifted: Mapping[tuple[str, str], tuple[xr.Dataset, xr.Dataset]],
    modulus: tuple[xr.Dataset, xr.Dataset] | None,
    known: Mapping[str, Budget],
    settings: Settings,
) -> tuple[list[Input], np.ndarray]:
    """All uncertain inputs and the covariance of their errors; parameters as in `compute`."""
    inputs, parts = [], list(known.values())
    for surface, measured in known.items():
        inputs += [of_surface(state, surface, quantity, shifted[surface, quantity]) for quantity in measured.names]
    stated = settings.uncertainty
    others = [*of_dimensions(state, stated), *of_material(state, modulus, settings), *of_air(state, stated)]
    for entry, deviation in others:
        inputs.append(entry)
        parts.append(Budget((entry.name,), np.zeros(1), np.array([[deviation**2]])))
    return inputs, joined(parts).covariance


def of_surface(state: State, surface: str, quantity: str, contacts: tuple[xr.Dataset, xr.Dataset]) -> Input:
    """A quantity of a surface, of its heights or of its spectrum."""
    kind = "spectrum" if quantity in OF_SPECTRUM else "heights"
    both = tuple(replace(state, contact=contact) for contact in contacts)
    return Input(f"{quantity} of {surface}", f"the {kind} of {surface}", both, difference(contacts[0]))


def of_dimensions(state: State, stated: Uncertainty) -> Iterator[tuple[Input, float]]:
    """Uncertain dimensions of a beam, with the standard uncertainties of what the slopes are in."""
    if state.device is None:
        return
    for name in ("thickness", "gap"):
        if deviation := getattr(stated, name):
            value = getattr(state.device, name)
            sizes = [factor * value for factor in _FACTORS]
            both = tuple(replace(state, device=replace(state.device, **{name: size})) for size in sizes)
            yield Input(name, f"the {name}", both, _STEP), deviation / value
    if deviation := stated.residual_stress:
        ends = around(state.device.residual_stress, deviation, least=0.0)
        both = tuple(replace(state, device=replace(state.device, residual_stress=at)) for at in ends)
        yield Input("residual stress", "the residual stress", both, ends[1] - ends[0]), deviation


def of_material(
    state: State, modulus: tuple[xr.Dataset, xr.Dataset] | None, settings: Settings
) -> Iterator[tuple[Input, float]]:
    """Uncertain Young's modulus of the contact and of the beam, with the standard uncertainty of its logarithm."""
    if modulus is None:
        return
    both = []
    for contact, factor in zip(modulus, _FACTORS, strict=True):
        beam = state.device and replace(state.device, young_modulus=factor * settings.young_modulus)
        both.append(replace(state, contact=contact, device=beam))
    deviation = settings.uncertainty.young_modulus / settings.young_modulus
    yield Input(_MODULUS, _MODULUS, tuple(both), _STEP), deviation


def of_air(state: State, stated: Uncertainty) -> Iterator[tuple[Input, float]]:
    """Uncertain humidity, temperature and contact angles, with their standard uncertainties."""
    water = state.water
    if deviation := stated.humidity:
        ends = around(state.humidity, deviation)
        both = tuple(replace(state, humidity=at) for at in ends)
        yield Input("humidity", "the humidity", both, ends[1] - ends[0]), deviation
    if deviation := stated.temperature:
        ends = around(water.temperature, deviation)
        both = tuple(replace(state, water=replace(water, temperature=at)) for at in ends)
        yield Input("temperature", "the temperature", both, ends[1] - ends[0]), deviation
    if deviation := stated.contact_angle:
        ends = np.transpose([around(angle, deviation, least=0.0) for angle in water.contact_angles])
        both = tuple(replace(state, water=replace(water, contact_angles=tuple(map(float, at)))) for at in ends)
        yield Input("contact angles", "the contact angles", both, float(np.mean(ends[1] - ends[0]))), deviation


def around(value: float, deviation: float, least: float = -np.inf) -> tuple[float, float]:
    """Values one standard uncertainty below and above, or from the value itself where it cannot be lower.

    ASSUME: an input at its lower end, such as a zero contact angle, has a one-sided error; the secant over one standard
    uncertainty is its slope. The derivative of a length by a contact angle of zero vanishes.
    """
    below = value - deviation
    return (below if below >= least else value), value + deviation


def covariances(
    surfaces: Mapping[str, tuple[xr.Dataset, xr.Dataset]], estimates: Mapping[str, xr.Dataset], settings: Settings
) -> dict[str, Budget]:
    """Covariance of the quantities of every uncertain surface, as budgets without slopes.

    Parameters
    ----------
    surfaces : dict
        Surface to its datasets of stages heights and spectrum.
    estimates : dict
        Surface to its dataset of stage estimate, of the surfaces described by scans.
    settings : Settings
    """
    return {
        name: of_scans(estimates[name], described[0])
        if name in estimates
        else of_one_scan(*described, settings.uncertainty.scan)
        for name, described in surfaces.items()
    }


def of_scans(estimate: xr.Dataset, heights_of: xr.Dataset) -> Budget:
    """Covariance of the quantities of a surface described by scans; without slopes.

    ASSUME: the errors of heights and spectrum are independent.

    Parameters
    ----------
    estimate, heights_of : Dataset
        Of stages estimate and heights.
    """
    measured = isinstance(heights.density(heights_of, "NG"), MeasuredDensity)
    found = errors_of(estimate, OF_MEASURED if measured else OF_MOMENTS)
    parts = (found.names, found.heights), (OF_SPECTRUM, found.spectrum)
    return joined([Budget(names, np.zeros(len(names)), covariance) for names, covariance in parts])


def of_one_scan(heights_of: xr.Dataset, spectrum_of: xr.Dataset, side: float) -> Budget:
    """Covariance of rms, skewness and kurtosis of a surface, measured on one square scan; without slopes.

    Parameters
    ----------
    heights_of, spectrum_of : Dataset
        Of stages heights and spectrum.
    side : float
        [m]
    """
    translation = Translation(heights.density(heights_of, "NG"))
    underlying = spectrum.underlying(spectrum_of, "NG")
    known = np.pi / float(spectrum_of.wavenumber[1] - spectrum_of.wavenumber[0])  # half of the period of its field
    return Budget(OF_MOMENTS, np.zeros(3), moments.covariance(translation, underlying, (side, side), known))


# Slopes


def slopes(inputs: Sequence[Input], respond: Respond) -> np.ndarray:
    """Slopes of the logarithm of the mean response and their standard errors, (inputs, 2)."""
    found = [_slope(entry, respond(entry.states)) for entry in progress(inputs, "inputs")]
    return np.array(found).reshape(len(inputs), 2)


def _slope(entry, found):
    """Slope with respect to one input and its standard error, of the devices and of the samples that they share."""
    value, own = log_slope(centre(found.values), *found.values, entry.step)
    if found.shared is None:
        return value, own
    _, common = log_slope(np.mean, *found.shared, entry.step)
    # ASSUME: lengths follow the mean energy of the samples as in Eq. (13), as far as the error of these is concerned.
    return value, np.hypot(own, CRACK_LENGTH_POWER * common)


def centre(values: np.ndarray) -> Callable[[np.ndarray], float]:
    """Mean, or the median if some lengths are not known."""
    return np.mean if np.isfinite(values).all() else np.median


def effect(base: State, changed: State, respond: Respond) -> tuple[float, float]:
    """Relative change of the mean response by another choice of the model, with its standard error [-]."""
    both = respond([base, changed])
    of = centre(both.values)
    return choice_effect(of(both.values[0]), of(both.values[1])), _slope(Input("", "", (base, changed), 1.0), both)[1]


# Dataset


def layout(
    inputs: Sequence[Input],
    slopes: np.ndarray,
    covariance: np.ndarray,
    nominal: np.ndarray,
    effects: Mapping[str, tuple[float, float]],
    unit: str,
) -> xr.Dataset:
    """Dataset of the budget of a device at one humidity.

    Parameters
    ----------
    inputs : sequence of k Input
    slopes : (k, 2) array
        d ln y / dx and standard error.
    covariance : (k, k) array
        Of the errors of the inputs.
    nominal : (n,) array
        Lengths [m] or forces [N] of n devices.
    effects : dict
        Choice of the model to its relative effect and standard error [-].
    unit : str
        Of the response, ``m`` or ``N``.
    """
    names = [entry.name for entry in inputs]
    known = nominal[np.isfinite(nominal)]
    changes = np.array(list(effects.values())).reshape(len(effects), 2)
    return xr.Dataset(
        {
            "slope": ("input", slopes[:, 0]),
            "slope_error": ("input", slopes[:, 1]),
            "covariance": (("input", "other"), covariance),
            "group": ("input", [entry.group for entry in inputs]),
            "mean": ((), centre(nominal)(nominal), {"units": unit}),
            "scatter": ((), known.std(ddof=1) / known.mean(), {"units": "1"}),
            "effect": ("choice", changes[:, 0], {"units": "1"}),
            "effect_error": ("choice", changes[:, 1], {"units": "1"}),
        },
        coords={"input": names, "other": names, "choice": list(effects)},
    )


def budget_of(dataset: xr.Dataset) -> Budget:
    """Budget from its dataset."""
    names = tuple(map(str, dataset.input.values))
    return Budget(names, dataset.slope.values, dataset.covariance.values)


def groups_of(dataset: xr.Dataset) -> dict[str, list[str]]:
    """Inputs by the measurement that determines them."""
    found = {}
    for name, group in zip(dataset.input.values, dataset.group.values, strict=True):
        found.setdefault(str(group), []).append(str(name))
    return found
