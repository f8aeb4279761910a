"""Uncertain inputs of devices: states with less and with more of each, and the covariance of their errors.

Dimensions and properties of the solids are changed by steps of their own: a crack jumps from strip to strip, so that
larger steps have smaller errors. Stress, air and contact angles are changed by their standard uncertainty, those that
cannot be below zero in one direction only. A new input is an entry of ``OF_BEAMS`` or ``OF_AIR``, or a property of
`stiction.contact.materials`.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, make_dataclass, replace
from itertools import groupby
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.linalg import block_diag

from stiction.config.units import without_unit
from stiction.contact.environment import Water
from stiction.contact.materials import OF_CONTACT, OF_PAIRS, OF_REPLICAS, InputStep
from stiction.contact.tilt import EDGE_RADIUS
from stiction.models import MODE_QUANTITIES, MOMENT_QUANTITIES, SIDES, SPECTRUM_QUANTITIES
from stiction.scans import moments
from stiction.stages.contact.changes.quantities import difference, is_large
from stiction.stages.contact.contact import first
from stiction.stages.devices.opening import DesignedBeam
from stiction.stages.laws.scan_uncertainty import errors_of
from stiction.stages.surfaces import heights, spectrum
from stiction.surface.empirical import MeasuredDensity
from stiction.surface.translation import Translation

#: Step of dimensions.
_OF_DIMENSIONS = InputStep(0.05)


@dataclass(frozen=True)
class InputState:
    """State of devices at one value of each input."""

    contact: xr.Dataset
    humidity: float  #: [-]
    water: Water
    device: DesignedBeam | None = None  #: a beam; none for a stopper
    area: float = 0.0  #: of a stopper [m²]
    alike: tuple[str, ...] = SIDES  #: bodies of the material of the beam or stopper

    def attracting(self, factor: float) -> "InputState":
        """State with a factor of the Hamaker constants of these bodies across gaps. Its contact stays."""
        gaps = self.water.gaps
        return replace(self, water=replace(self.water, gaps=gaps and gaps.scaled(factor, self.alike)))


@dataclass(frozen=True)
class Input:
    """One uncertain input of a device and the states around its value."""

    name: str  #: for reading
    group: str  #: measurement that would determine this input, shown in tables
    states: tuple[InputState, InputState]  #: with less and with more of the input
    step: float  #: difference of the input between both
    #: State between both, if they are as far around it as the uncertainty of the input and its curvature counts.
    middle: InputState | None = None
    limits: tuple[float, float] = (-np.inf, np.inf)  #: beyond which errors count as there


@dataclass(frozen=True)
class QuantityErrors:
    """Errors of the quantities of a surface."""

    quantities: tuple[str, ...]  #: keys of `stiction.analysis.shifts.STEPS`
    covariance: np.ndarray  #: of their errors (k, k)


@dataclass(frozen=True)
class Assumed:
    """Assumed quantities of a surface with whole typical surfaces in its place."""

    quantities: tuple[str, ...]  #: words of key ``unknown``


class Block(NamedTuple):
    """Inputs with a common cause of their errors."""

    inputs: list[Input]
    covariance: np.ndarray  #: of their errors (k, k)


@dataclass(frozen=True)
class Varied:
    """Input as a number of a state, with a standard uncertainty from the section of a device."""

    field: str  #: of `Uncertainty`; inputs with the same one err together
    name: str  #: for reading
    value: Callable[[InputState], float]
    changed: Callable[[InputState, float], InputState]
    step: InputStep | None = None  #: in either direction; by default its standard uncertainty
    least: float = -np.inf  #: below which it cannot be
    group: str = ""  #: as of `Input`, by default from its name

    def around(self, state: InputState, deviation: float) -> tuple[Input, float]:
        """Input around its value in a state, and its standard uncertainty, relative if the step is."""
        value = self.value(state)
        ends = self.step.ends(value) if self.step else around(value, deviation, self.least)
        states = tuple(self.changed(state, end) for end in ends)
        step = self.step.difference if self.step else ends[1] - ends[0]
        relative = self.step.error(value, deviation) if self.step else deviation
        return Input(self.name, self.group or f"the {self.name}", states, step), relative

    def moved(self, state: InputState, by: float) -> InputState:
        """State after an error of the input, in its logarithm if its step is relative."""
        value = self.value(state)
        return self.changed(state, self.step.moved(value, by) if self.step else max(value + by, self.least))


def _size(name, step=None, least=-np.inf):
    """Dimension, or stress, of a beam."""

    def changed(state, value):
        """State with another value of the dimension."""
        return replace(state, device=replace(state.device, **{name: value}))

    return Varied(name, name.replace("_", " "), lambda state: getattr(state.device, name), changed, step, least)


def _contact_angle(side):
    """Contact angle on one of the two surfaces, with the other one as it is."""

    def changed(state, value):
        """State with another contact angle of the side [rad]."""
        angles = tuple(value if k == side else angle for k, angle in enumerate(state.water.contact_angles))
        return replace(state, water=replace(state.water, contact_angles=angles))

    name, angle = f"contact angle on the {SIDES[side]}", lambda state: state.water.contact_angles[side]
    return Varied("contact_angle", name, angle, changed, least=0.0, group="the contact angles")


#: Uncertain inputs of beams, and those of all devices; the slopes of thickness and gap are in their logarithms.
OF_BEAMS = _size("thickness", _OF_DIMENSIONS), _size("gap", _OF_DIMENSIONS), _size("residual_stress", least=0.0)
OF_AIR = (
    Varied("humidity", "humidity", lambda state: state.humidity, lambda state, at: replace(state, humidity=at)),
    Varied(
        "temperature",
        "temperature",
        lambda state: state.water.temperature,
        lambda state, at: replace(state, water=replace(state.water, temperature=at)),
    ),
    *map(_contact_angle, range(len(SIDES))),
    Varied(
        "adsorbed",
        "adsorbed water",
        lambda state: state.water.adsorbed,
        lambda state, height: replace(state, water=replace(state.water, adsorbed=height)),
        least=0.0,
    ),
)
#: Uncertain properties that change the contact, by the name of this change: of pairs, and of edges.
_OF_CONTACTS = OF_PAIRS | {without_unit(EDGE_RADIUS.key): EDGE_RADIUS}
#: Fields of their uncertainties.
_FIELDS = {name: without_unit(entry.key) for name, entry in _OF_CONTACTS.items()}
#: Standard uncertainties of all inputs in SI, zero where not stated; ``scan`` is the side of the scan that gave the
#: moments of the surfaces that are described by numbers [m].
Uncertainty = make_dataclass(
    "Uncertainty",
    [
        (key, float, 0.0)
        for key in dict.fromkeys([*(entry.field for entry in (*OF_BEAMS, *OF_AIR)), *_FIELDS.values(), "scan"])
    ],
    frozen=True,
)


@dataclass(frozen=True)
class Settings:
    """Settings of any budget, without contact and surfaces."""

    seed: int
    water: Water
    humidity: float  #: [-]
    uncertainty: Uncertainty
    surfaces: tuple[str, ...]  #: names of those of the pair
    young_modulus: float  #: E of the body of the beam or stopper [Pa]
    edge_radius: float = 0.0  #: of the edges of tips that are budgeted [m]
    coherence: float = 0.0  #: of both surfaces, if it is uncertain [-]
    play: float | None = None  #: of the beam above a surface that it follows, if it is uncertain [m]
    hamaker_constant: float | None = None  #: of two bodies like the beam or stopper [J], if it is uncertain
    alike: tuple[str, ...] = SIDES  #: as of `InputState`
    waters: dict[str, Water] = field(
        default_factory=dict
    )  #: by choices of the model that change attraction across gaps
    known: dict[str, QuantityErrors] = field(
        default_factory=dict
    )  #: what is stated about surfaces without scans, by name
    assumed: dict[str, Assumed] = field(default_factory=dict)  #: what is assumed of surfaces with members, by name

    def water_under(self, choice: str) -> Water:
        """Water, and attraction across gaps, under a choice of the model."""
        return replace(self.waters.get(choice, self.water), correction=self.water.correction)


def uncertain(
    state: InputState,
    shifted: Mapping[tuple[str, str], tuple[xr.Dataset, xr.Dataset]],
    properties: Mapping[str, tuple[xr.Dataset, xr.Dataset]],
    surface_errors: Mapping[str, QuantityErrors],
    settings: Settings,
) -> tuple[list[Input], np.ndarray]:
    """Uncertain inputs and the covariance of their errors. Without condensation, the air has none.

    The state has the stated values of all inputs. There are contacts with less and with more of each quantity of a
    surface, by both, and of each uncertain property of the solids and of edges, by its step. ``surface_errors`` are
    those of the quantities of each surface.
    """
    uncertainty = settings.uncertainty
    blocks = [surface_block(state, name, shifted, measured) for name, measured in surface_errors.items()]
    blocks += [
        *(number_blocks(state, OF_BEAMS, uncertainty) if state.device else ()),
        *property_blocks(state, properties, settings),
    ]
    blocks += number_blocks(state, OF_AIR, uncertainty) if state.water.film(state.humidity)[0] else ()
    inputs = [entry for block in blocks for entry in block.inputs]
    return inputs, block_diag(np.empty((0, 0)), *(block.covariance for block in blocks))


def changed(state: InputState, errors: Mapping[str, float]) -> InputState:
    """State after errors of dimensions, air, modulus of the beam and attraction across gaps, by input.

    Its contact stays.
    """
    for entry in (*OF_BEAMS, *OF_AIR):
        if entry.name in errors:
            state = entry.moved(state, errors[entry.name])
    modulus = OF_CONTACT["modulus"]
    if modulus.words in errors and state.device:
        stiffer = modulus.step.moved(state.device.young_modulus, errors[modulus.words])
        state = replace(state, device=replace(state.device, young_modulus=stiffer))
    attraction = OF_CONTACT["hamaker_constant"].words
    return state.attracting(np.exp(errors[attraction])) if attraction in errors else state


def countable(sizes: Sequence[str], settings: Settings) -> list[str]:
    """Names of all possible measurements of a device with these sizes."""
    surfaces = [group for name in settings.surfaces for group in _parts_of_surface(name, settings)]
    further = [entry for name, entry in OF_REPLICAS.items() if getattr(settings.uncertainty, name)]
    further += [EDGE_RADIUS] * bool(settings.edge_radius)
    bodies = [entry.group for entry in (*OF_CONTACT.values(), *further)]
    air = [entry.group or f"the {entry.name}" for entry in OF_AIR if settings.water.film(settings.humidity)[0]]
    return [*surfaces, *(f"the {name.replace('_', ' ')}" for name in sizes), *bodies, *dict.fromkeys(air)]


def _parts_of_surface(name, settings):
    """Names of the parts of a surface that measurements determine. Of a partly assumed one, its rms may be exact."""
    if name not in settings.assumed:
        return [f"the {subject} of {name}" for subject in ("heights", "spectrum")]
    errors = settings.known[name].quantities if name in settings.known else ()
    is_exact = "rms" not in (*settings.assumed[name].quantities, *errors) and not settings.uncertainty.scan
    return [f"the rms of {name}"] * is_exact


def surface_block(
    state: InputState,
    surface: str,
    shifted: Mapping[tuple[str, str], tuple[xr.Dataset, xr.Dataset]],
    errors: QuantityErrors,
) -> Block:
    """Quantities of a surface, of its heights and of its spectrum."""
    inputs = []
    for quantity in errors.quantities:
        kind = "spectrum" if quantity in SPECTRUM_QUANTITIES else "heights"
        contacts = shifted[surface, quantity]
        states = tuple(replace(state, contact=contact) for contact in contacts)
        middle, less = None, contacts[0]
        if is_large(less, quantity):
            middle = replace(state, contact=first(state.contact, less.sizes["strip"]))
        inputs.append(Input(f"{quantity} of {surface}", f"the {kind} of {surface}", states, difference(less), middle))
    return Block(inputs, errors.covariance)


def number_blocks(state: InputState, varied: Sequence[Varied], uncertainty: Uncertainty) -> Iterator[Block]:
    """Yield blocks of the uncertain ones among some inputs."""
    for key, together in groupby(varied, lambda number: number.field):
        if deviation := getattr(uncertainty, key):
            inputs, deviations = zip(*(number.around(state, deviation) for number in together), strict=True)
            yield Block(list(inputs), np.full((len(inputs), len(inputs)), deviations[0] ** 2))


def property_blocks(
    state: InputState, properties: Mapping[str, tuple[xr.Dataset, xr.Dataset]], settings: Settings
) -> Iterator[Block]:
    """Uncertain properties of pairs and of edges. The slopes of those with a relative step are in their logarithms.

    ASSUME: a beam bends with Young's modulus alone, without the 1 - ν² of a plate; only the contact has the other two.
    """
    for name, entry in _OF_CONTACTS.items():
        if name not in properties:
            continue
        deviation = getattr(settings.uncertainty, _FIELDS[name])
        states, step = [replace(state, contact=contact) for contact in properties[name]], entry.step.by(deviation)
        if name == "modulus" and state.device:
            moduli = step.ends(settings.young_modulus)
            beams = [replace(state.device, young_modulus=modulus) for modulus in moduli]
            states = [replace(end, device=beam) for end, beam in zip(states, beams, strict=True)]
        if name == "hamaker_constant":
            states = [shifted_state.attracting(end) for shifted_state, end in zip(states, step.ends(1.0), strict=True)]
        value = getattr(settings, _FIELDS[name], np.nan)
        relative, limits = step.error(value, deviation), step.limits(value)
        middle = None
        if -np.inf < limits[0] <= -1:  # as far from both ends
            middle = replace(state, contact=first(state.contact, states[0].contact.sizes["strip"]))
        shifted_input = Input(entry.words, entry.group, tuple(states), step.around(value), middle, limits)
        yield Block([shifted_input], np.array([[relative**2]]))


def around(value: float, deviation: float, least: float = -np.inf) -> tuple[float, float]:
    """Values one standard uncertainty below and above, or from the value itself at its lower limit.

    ASSUME: an input at its lower end, such as a zero contact angle, has a one-sided error; the secant over one standard
    uncertainty is its slope. The derivative of a length by a contact angle of zero vanishes.
    """
    below = value - deviation
    return (below if below >= least else value), value + deviation


# Surfaces


def covariances(
    surfaces: Mapping[str, tuple[xr.Dataset, xr.Dataset]], estimates: Mapping[str, xr.Dataset], settings: Settings
) -> dict[str, QuantityErrors]:
    """Errors of the quantities of every uncertain surface."""
    return {
        name: scan_errors(estimates[name], described[0])
        if name in estimates
        else number_errors(name, described, settings)
        for name, described in surfaces.items()
    }


def number_errors(name: str, described: tuple[xr.Dataset, xr.Dataset], settings: Settings) -> QuantityErrors:
    """Errors of a surface by numbers: as given, and from the scan behind its moments."""
    causes = [settings.known[name]] if name in settings.known else []
    side = settings.uncertainty.scan
    return together([*causes, *([errors_of_one_scan(*described, side)] if side else [])])


def together(causes: Sequence[QuantityErrors]) -> QuantityErrors:
    """Quantities with several independent causes of their errors."""
    affected = {quantity for cause in causes for quantity in cause.quantities}
    quantities = tuple(name for name in MOMENT_QUANTITIES + SPECTRUM_QUANTITIES if name in affected)
    covariance = np.zeros((len(quantities), len(quantities)))
    for cause in causes:
        positions = [quantities.index(name) for name in cause.quantities]
        covariance[np.ix_(positions, positions)] += cause.covariance
    return QuantityErrors(quantities, covariance)


def scan_errors(estimate: xr.Dataset, heights_of: xr.Dataset) -> QuantityErrors:
    """Covariance of the quantities of a surface described by scans.

    ASSUME: the errors of heights and spectrum are independent.
    """
    measured = isinstance(heights.density(heights_of, "NG"), MeasuredDensity)
    errors = errors_of(estimate, MODE_QUANTITIES if measured else MOMENT_QUANTITIES)
    return QuantityErrors(errors.names + SPECTRUM_QUANTITIES, block_diag(errors.heights, errors.spectrum))


def errors_of_one_scan(heights_of: xr.Dataset, spectrum_of: xr.Dataset, side: float) -> QuantityErrors:
    """Covariance of rms, skewness and kurtosis of a surface, measured on one square scan of this side [m]."""
    translation = Translation(heights.density(heights_of, "NG"))
    underlying = spectrum.underlying(spectrum_of, "NG")
    reach = np.pi / float(spectrum_of.wavenumber[1] - spectrum_of.wavenumber[0])  # half of the period of its field
    return QuantityErrors(MOMENT_QUANTITIES, moments.covariance(translation, underlying, (side, side), reach))
