"""Uncertain inputs of devices: states with less and with more of each, and the covariance of their errors.

Dimensions and properties of the solids are changed by the steps of `stiction.devices.budget`: a crack jumps from strip
to strip, so that larger steps have smaller errors. Stress, air and contact angles are changed by their standard
uncertainty, those that cannot be below zero in one direction only.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.linalg import block_diag

from stiction.devices.budget import OF_DIMENSIONS, OF_SOLIDS
from stiction.models import MODE_QUANTITIES, MOMENT_QUANTITIES, SIDES, SPECTRUM_QUANTITIES
from stiction.scans import moments
from stiction.stages.contact.curves import Water
from stiction.stages.contact.slope_contact import difference
from stiction.stages.devices.releases import DesignedBeam
from stiction.stages.laws.scan_uncertainty import errors_of
from stiction.stages.surfaces import heights, spectrum
from stiction.surface.empirical import MeasuredDensity
from stiction.surface.translation import Translation

#: What the inputs of a budget may move apart from the mean length at which beams stick: a length that tips hold, and a
#: mean force.
ARC, FORCE = "arc", "force"
#: Properties of solids, keys of `stiction.devices.budget.OF_SOLIDS`: field of their uncertainty, and for reading.
_SOLIDS = {
    "modulus": ("young_modulus", "Young's modulus"),
    "poisson_ratio": ("poisson_ratio", "Poisson's ratio"),
    "hamaker_constant": ("hamaker_constant", "the Hamaker constant"),
}


@dataclass(frozen=True)
class Uncertainty:
    """Standard uncertainties of the inputs apart from the surfaces; zero where not stated."""

    thickness: float = 0.0  #: [m]
    gap: float = 0.0  #: [m]
    residual_stress: float = 0.0  #: [Pa]
    young_modulus: float = 0.0  #: [Pa]
    poisson_ratio: float = 0.0  #: [-]
    hamaker_constant: float = 0.0  #: [J]
    humidity: float = 0.0  #: [-]
    temperature: float = 0.0  #: [K]
    contact_angle: float = 0.0  #: of both surfaces, in the same direction [rad]
    scan: float = 0.0  #: side of the scan that gave the moments of the surfaces that are described by numbers [m]


@dataclass(frozen=True)
class Settings:
    """Everything that a budget depends on apart from contact and surfaces."""

    seed: int
    water: Water
    humidity: float  #: [-]
    uncertainty: Uncertainty
    surfaces: tuple[str, ...]  #: names of those of the pair
    young_modulus: float  #: E of the body of the beam or stopper [Pa]
    device: DesignedBeam | None = None  #: a beam; none for a stopper
    hamaker_constant: float | None = None  #: of two bodies like the beam or stopper [J], if it is uncertain
    share: float = 0.0  #: p of the length that tips hold, if the budget is of that length [-]
    beams: int = 0  #: number of beams for every slope
    contact: tuple[float, float] = (0.0, 0.0)  #: sides of the patch of a stopper [m]

    @property
    def response(self) -> str:
        """What the inputs move."""
        if self.device is None:
            return FORCE
        return ARC if self.share else self.device.opening.shapes[0]


@dataclass(frozen=True)
class State:
    """Everything that devices depend on at one value of each input."""

    contact: xr.Dataset
    humidity: float  #: [-]
    water: Water
    device: DesignedBeam | None = None  #: a beam; none for a stopper
    area: float = 0.0  #: of a stopper [m²]


@dataclass(frozen=True)
class Input:
    """One uncertain input of a device and the states around its value."""

    name: str  #: for reading
    group: str  #: what a measurement determines, this input and perhaps others, for reading
    states: tuple[State, State]  #: with less and with more of the input
    step: float  #: difference of the input between both


@dataclass(frozen=True)
class Known:
    """How well the quantities of a surface are known."""

    quantities: tuple[str, ...]  #: keys of `stiction.analysis.shifts.STEPS`
    covariance: np.ndarray  #: of their errors (k, k)


class Block(NamedTuple):
    """Inputs whose errors have a common cause."""

    inputs: list[Input]
    covariance: np.ndarray  #: of their errors (k, k)


def uncertain(
    state: State,
    shifted: Mapping[tuple[str, str], tuple[xr.Dataset, xr.Dataset]],
    solids: Mapping[str, tuple[xr.Dataset, xr.Dataset]],
    known: Mapping[str, Known],
    settings: Settings,
) -> tuple[list[Input], np.ndarray]:
    """All uncertain inputs and the covariance of their errors.

    Parameters
    ----------
    state : State
        At the stated values of all inputs.
    shifted : dict
        (surface, quantity) to the contact with less and with more of it.
    solids : dict
        Uncertain property of the solids to the contact with less and with more of it, by the step of
        `stiction.devices.budget.OF_SOLIDS`.
    known : dict
        Surface to what is known of its quantities, those of ``shifted``.
    settings : Settings
    """
    stated = settings.uncertainty
    blocks = [of_surface(state, name, shifted, measured) for name, measured in known.items()]
    blocks += [*of_dimensions(state, stated), *of_solids(state, solids, settings), *of_air(state, stated)]
    inputs = [entry for block in blocks for entry in block.inputs]
    return inputs, block_diag(np.empty((0, 0)), *(block.covariance for block in blocks))


def countable(settings: Settings) -> list[str]:
    """Everything that a measurement of a device could determine, whether uncertain or not, for reading."""
    names = settings.device.opening.sizes if settings.device else ["area"]
    sizes = [f"the {name.replace('_', ' ')}" for name in names]
    surfaces = [f"the {part} of {name}" for name in settings.surfaces for part in ("heights", "spectrum")]
    solids = [words for _, words in _SOLIDS.values()]
    return [*surfaces, *sizes, *solids, "the humidity", "the temperature", "the contact angles"]


def of_surface(
    state: State, surface: str, shifted: Mapping[tuple[str, str], tuple[xr.Dataset, xr.Dataset]], known: Known
) -> Block:
    """Quantities of a surface, of its heights and of its spectrum."""
    inputs = []
    for quantity in known.quantities:
        kind = "spectrum" if quantity in SPECTRUM_QUANTITIES else "heights"
        contacts = shifted[surface, quantity]
        both = tuple(replace(state, contact=contact) for contact in contacts)
        inputs.append(Input(f"{quantity} of {surface}", f"the {kind} of {surface}", both, difference(contacts[0])))
    return Block(inputs, known.covariance)


def _alone(name, group, states, step, deviation):
    """Block of one input."""
    return Block([Input(name, group, tuple(states), step)], np.array([[deviation**2]]))


def of_dimensions(state: State, stated: Uncertainty) -> Iterator[Block]:
    """Uncertain dimensions of a beam; the slopes of thickness and gap are in their logarithms."""
    if state.device is None:
        return
    for name in ("thickness", "gap"):
        if deviation := getattr(stated, name):
            value = getattr(state.device, name)
            sizes = OF_DIMENSIONS.ends(value)
            both = (replace(state, device=replace(state.device, **{name: size})) for size in sizes)
            yield _alone(name, f"the {name}", both, OF_DIMENSIONS.difference, deviation / value)
    if deviation := stated.residual_stress:
        ends = around(state.device.residual_stress, deviation, least=0.0)
        both = (replace(state, device=replace(state.device, residual_stress=at)) for at in ends)
        yield _alone("residual stress", "the residual stress", both, ends[1] - ends[0], deviation)


def of_solids(state: State, solids: Mapping[str, tuple[xr.Dataset, xr.Dataset]], settings: Settings) -> Iterator[Block]:
    """Uncertain properties of the solids; the slopes of those with a relative step are in their logarithms.

    ASSUME: a beam bends with Young's modulus alone, without the 1 - ν² of a plate; only the contact has the other two.
    """
    for name, (field, words) in _SOLIDS.items():
        if name not in solids:
            continue
        both, step = [replace(state, contact=contact) for contact in solids[name]], OF_SOLIDS[name]
        if name == "modulus" and state.device:
            moduli = step.ends(settings.young_modulus)
            beams = [replace(state.device, young_modulus=modulus) for modulus in moduli]
            both = [replace(of, device=beam) for of, beam in zip(both, beams, strict=True)]
        deviation = getattr(settings.uncertainty, field)
        relative = deviation / getattr(settings, field) if step.relative else deviation
        yield _alone(words.removeprefix("the "), words, both, step.difference, relative)


def of_air(state: State, stated: Uncertainty) -> Iterator[Block]:
    """Uncertain humidity, temperature and contact angles."""
    water = state.water
    if deviation := stated.humidity:
        ends = around(state.humidity, deviation)
        both = (replace(state, humidity=at) for at in ends)
        yield _alone("humidity", "the humidity", both, ends[1] - ends[0], deviation)
    if deviation := stated.temperature:
        ends = around(water.temperature, deviation)
        both = (replace(state, water=replace(water, temperature=at)) for at in ends)
        yield _alone("temperature", "the temperature", both, ends[1] - ends[0], deviation)
    if deviation := stated.contact_angle:
        inputs = [_contact_angle(state, side, deviation) for side in range(len(SIDES))]
        yield Block(inputs, np.full((len(SIDES), len(SIDES)), deviation**2))


def _contact_angle(state, side, deviation):
    """Contact angle on one of the two surfaces, with the other one as it is."""
    angles = state.water.contact_angles
    ends = around(angles[side], deviation, least=0.0)
    changed = [tuple(at if k == side else angle for k, angle in enumerate(angles)) for at in ends]
    both = tuple(replace(state, water=replace(state.water, contact_angles=each)) for each in changed)
    return Input(f"contact angle on the {SIDES[side]}", "the contact angles", both, ends[1] - ends[0])


def around(value: float, deviation: float, least: float = -np.inf) -> tuple[float, float]:
    """Values one standard uncertainty below and above, or from the value itself where it cannot be lower.

    ASSUME: an input at its lower end, such as a zero contact angle, has a one-sided error; the secant over one standard
    uncertainty is its slope. The derivative of a length by a contact angle of zero vanishes.
    """
    below = value - deviation
    return (below if below >= least else value), value + deviation


# Surfaces


def covariances(
    surfaces: Mapping[str, tuple[xr.Dataset, xr.Dataset]], estimates: Mapping[str, xr.Dataset], settings: Settings
) -> dict[str, Known]:
    """What is known of the quantities of every uncertain surface.

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


def of_scans(estimate: xr.Dataset, heights_of: xr.Dataset) -> Known:
    """Covariance of the quantities of a surface described by scans.

    ASSUME: the errors of heights and spectrum are independent.

    Parameters
    ----------
    estimate, heights_of : Dataset
        Of stages estimate and heights.
    """
    measured = isinstance(heights.density(heights_of, "NG"), MeasuredDensity)
    found = errors_of(estimate, MODE_QUANTITIES if measured else MOMENT_QUANTITIES)
    return Known(found.names + SPECTRUM_QUANTITIES, block_diag(found.heights, found.spectrum))


def of_one_scan(heights_of: xr.Dataset, spectrum_of: xr.Dataset, side: float) -> Known:
    """Covariance of rms, skewness and kurtosis of a surface, measured on one square scan.

    Parameters
    ----------
    heights_of, spectrum_of : Dataset
        Of stages heights and spectrum.
    side : float
        [m]
    """
    translation = Translation(heights.density(heights_of, "NG"))
    underlying = spectrum.underlying(spectrum_of, "NG")
    reach = np.pi / float(spectrum_of.wavenumber[1] - spectrum_of.wavenumber[0])  # half of the period of its field
    return Known(MOMENT_QUANTITIES, moments.covariance(translation, underlying, (side, side), reach))
