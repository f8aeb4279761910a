"""Release of the beams of a device at a humidity, for cracks, charts, budgets and curves of roughness.

Cantilevers are longer than their cracks; bridges are shortened until their middle comes free: `BEAMS` has what the
stages need to know of each kind.

Random numbers have the address of the pair, not of the device, its dimensions or the humidity, so that devices are
compared with common random numbers.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Protocol

import numpy as np

from stiction.answer import sought
from stiction.beam.cantilever import Beam
from stiction.beam.energy import arrest_length
from stiction.beam.foundation import LONGER
from stiction.beam.montecarlo import Experiment, released_beams
from stiction.beam.release import EndState
from stiction.beam.resolution import longest, resolved
from stiction.chaos.model import ChaosModel, Truncation, fit
from stiction.config.cases import Case
from stiction.contact import forcelaw
from stiction.devices import bridges
from stiction.devices.arcs import arc_length
from stiction.devices.bridges import (
    half_of_bridge,
    held_lengths,
    held_on_mean,
    longest_strip,
    longest_tried,
    middle_zone,
)
from stiction.life import holding
from stiction.plan.stage import select
from stiction.streams import stream

#: End states in which a beam may stick: cracks stop on the way, or the tip holds as well, or the middle of a bridge.
S_SHAPE, EITHER, MIDDLE = "S-shape", "S-shape or arc", "middle"
#: What the inputs of a budget may move apart from the mean length at which beams stick: a length that tips hold, and a
#: mean force.
ARC, FORCE = "arc", "force"
#: Numbers sought for devices, by their end state or by what the inputs of a budget move.
SOUGHT_BY = dict.fromkeys([S_SHAPE, EITHER, MIDDLE, ARC], sought.LENGTH) | {FORCE: sought.FORCE}
#: Length of the long beams, in crack lengths that Eq. (13) predicts from the mean adhesion energy. Cracks stop where
#: adhesion is strongest, so that they are shorter than this prediction.
LONG = 1.3
#: Strips of one part of a beam, which can be divided into elements of 5, 4, 3, 2 and 1 strips.
STRIPS_OF_PART = 60
#: Strips per element where the force laws allow it, as in the paper.
PER_ELEMENT = 5
#: Number of force laws from which length and elements of the beams are chosen.
LAWS = 10_000


@dataclass(frozen=True)
class DesignedBeam:
    """Dimensions of a designed beam, and its ground."""

    kind: str  #: key of `BEAMS`
    pair: str  #: part of the addresses of random numbers
    thickness: float  #: t [m]
    gap: float  #: h [m]
    width: float  #: w [m]
    young_modulus: float  #: E [Pa]
    strip: float  #: length of a strip along the beam [m]
    residual_stress: float = 0.0  #: σ_R [Pa]
    hamaker_constant: float = 0.0  #: of the two solids, for the bound of flats [J]; 0 without van der Waals forces

    @property
    def opening(self) -> "Opening":
        """Opening of beams of its kind."""
        return BEAMS[self.kind]

    @property
    def beam(self) -> Beam:
        """One part of the beam in one element, under the tension of a bridge."""
        beam = Beam(STRIPS_OF_PART * self.strip, self.width, self.thickness, self.young_modulus, self.gap, elements=1)
        return half_of_bridge(beam, self.residual_stress)


class Seeded(Protocol):
    """Settings of any job with released beams of a device."""

    seed: int
    device: DesignedBeam


def fit_chaos(vectors: np.ndarray, limit: float, chaos: Truncation) -> ChaosModel:
    """Chaos model of the force laws of some samples (m, 4)."""
    return fit(vectors, limit, chaos.order, chaos.dimension_tolerance)


def addresses(settings: Seeded) -> Callable:
    """Streams of the beams of a device: ``(number) -> numpy.random.Generator``."""
    return partial(stream, settings.seed, "devices", settings.device.pair)


def _long_beam(device, laws):
    """Long beam with the elements of the paper."""
    beam = device.beam
    number = int(np.ceil(LONG * arrest_length(forcelaw.energy(laws).mean(), beam) / beam.length))
    points = number * STRIPS_OF_PART
    return replace(beam, length=number * beam.length, elements=points // PER_ELEMENT), points


def long_beam(device: DesignedBeam, laws: np.ndarray) -> tuple[Beam, int]:
    """Beam of a device longer than its cracks, with elements fine enough for them, and its number of strips.

    Raises
    ------
    ValueError
        If the strips are too long for the force laws (n, 4).
    """
    beam, points = _long_beam(device, laws)
    return resolved(beam, points, laws), points


def ground_of(device: DesignedBeam, laws: np.ndarray) -> tuple[Beam, int]:
    """Part of a device in finite elements on force laws (n, 4), and its number of strips.

    There are none where strips are too long: a patch that counts as a flat surface may be much stiffer than all others.
    """
    if device.strip > LONGER * device.opening.longest_strip(device, laws):
        return device.beam, 0
    return device.opening.resolved(device, laws)


def around(grounds: Sequence[tuple[Beam, int]]) -> tuple[Beam, int]:
    """Ground as of `ground_of`, as long as the longest of some, with elements as fine as the finest.

    It has no strips if one of them has none.
    """
    beam, strips = max(grounds, key=lambda ground: ground[1])
    if not all(points for _, points in grounds):
        return beam, 0
    finest = max(other.elements / points for other, points in grounds)
    return replace(beam, elements=round(finest * strips)), strips


def least_length(device: DesignedBeam, laws: np.ndarray) -> float:
    """Length of a device, apart from its tip, that comes free of ground no stronger than force laws (n, 4) [m]."""
    strongest = device.opening.contribution(laws).max(axis=0)
    return float(device.opening.bound(strongest, device.beam))


def arrests(
    device: DesignedBeam, ground: tuple[Beam, int], draw: Callable, number: int, address: Callable
) -> np.ndarray:
    """Crack lengths of cantilevers, infinite if not S-shaped, or of the shortest bridges that are held (n,) [m].

    The ground is from `ground_of`; ``draw(n, rng)`` gives n force laws (n, 4) [SI], and ``address(k)`` the stream of
    device k. Where the ground has no strips, all have the `least_length`, the safe side.
    """
    beam, strips = ground
    if not strips:
        return np.full(number, least_length(device, draw(LAWS, address("mesh"))))
    return device.opening.arrests(beam, strips, draw, number, address)


def reach(
    device: DesignedBeam, ground: tuple[Beam, int], draw: Callable, arrested: np.ndarray, address: Callable
) -> float:
    """Largest simulated length of devices with these ``arrested`` lengths (n,), infinite if all are finite [m].

    Other parameters as of `arrests`.
    """
    unknown = np.flatnonzero(np.isinf(arrested))
    return min((device.opening.tried(*ground, draw, address(int(k))) for k in unknown), default=np.inf)


def _crack_lengths(beam, strips, draw, number, address):
    """Crack lengths of long cantilevers, parameters as of `held_lengths`."""
    released = released_beams(Experiment(beam, strips, draw), number, address)
    return np.where(released["state"] == EndState.S_SHAPE, released["crack_length"], np.inf)


@dataclass(frozen=True, kw_only=True)
class Opening:
    """Opening of beams of one kind, and their places of adhesion."""

    arms: int  #: number of clamped ends, from each of which a crack opens
    sizes: tuple[str, ...]  #: fields of `DesignedBeam` that a measurement may determine
    shapes: tuple[str, ...]  #: end states in which beams may stick
    length: str  #: name in datasets of the length at which a beam is arrested
    resolved: Callable[[DesignedBeam, np.ndarray], tuple[Beam, int]]  #: as `long_beam`
    longest_strip: Callable[[DesignedBeam, np.ndarray], float]  #: that it resolves on force laws (n, 4) [m]
    arrests: Callable[..., np.ndarray]  #: as ``held_lengths``
    tried: Callable[..., float]  #: longest simulated length, parameters as of ``longest_tried``
    #: What the samples of force laws (..., m, 4) contribute to the length (..., m, ...), and the length on their mean.
    contribution: Callable[[np.ndarray], np.ndarray]
    length_on_mean: Callable[[np.ndarray, Beam], float]
    uniform: Callable[[Beam, np.ndarray], float]  #: length on the mean of force laws (m, 4) at every strip [m]
    bound: Callable[[np.ndarray, Beam], float]  #: length below which nothing of at most a contribution holds it
    #: Lengths (n,) at a voltage from those without it, and from the mean e and f_max (2,) without and with it.
    at_voltage: Callable[[np.ndarray, np.ndarray, np.ndarray, Beam], np.ndarray]

    @property
    def has_tip(self) -> bool:
        """Whether a free end may hold a beam."""
        return EITHER in self.shapes


#: How beams open by kind. ASSUME: crack lengths follow the mean energy of the samples as in Eq. (13), and lengths of
#: bridges their mean energy and pull-off force as in ``bridges.least_length``, as far as errors of the samples and
#: effects of a voltage are concerned.
BEAMS = {
    "cantilever": Opening(
        arms=1,
        sizes=("thickness", "gap", "width"),
        shapes=(S_SHAPE, EITHER),
        length="crack_length",
        resolved=long_beam,
        longest_strip=lambda device, laws: longest(_long_beam(device, laws)[0], laws)[0],
        arrests=_crack_lengths,
        tried=lambda beam, *_: beam.length,
        contribution=forcelaw.energy,
        length_on_mean=lambda sample, beam: arrest_length(sample.mean(), beam),
        uniform=lambda beam, laws: float(arrest_length(forcelaw.energy(laws).mean(), beam)),
        bound=arc_length,
        at_voltage=lambda lengths, without, at, beam: holding.length_at_voltage(
            lengths, beam, float(at[0] - without[0])
        ),
    ),
    "bridge": Opening(
        arms=2,
        sizes=("thickness", "gap", "width", "residual_stress"),
        shapes=(MIDDLE,),
        length="held_length",
        resolved=lambda device, laws: middle_zone(device.beam, device.strip, laws),
        longest_strip=lambda device, laws: longest_strip(device.beam, laws),
        arrests=held_lengths,
        tried=longest_tried,
        contribution=lambda laws: np.stack([forcelaw.energy(laws), laws[..., 0]], axis=-1),
        length_on_mean=lambda sample, beam: bridges.least_length(*sample.mean(axis=0), beam),
        uniform=held_on_mean,
        bound=lambda strongest, beam: bridges.least_length(*strongest, beam),
        at_voltage=lambda lengths, without, at, beam: (
            lengths * (bridges.least_length(*at, beam) / bridges.least_length(*without, beam))
        ),
    ),
}


def settings_of_beam(plan: Any, case: Case) -> dict[str, Any]:
    """Device at a humidity: force laws, dimensions and number of beams. More than any one stage needs."""
    pair = plan.contact_of_device(case)
    values = {"device": section_of_beam(plan, case.device, pair), "humidity": case.humidity}
    values |= {"edge_radius_um": plan.devices.edge_radius(case.device)}
    return plan.seen_by(pair) | plan.config["design"] | values | {"water": plan.air_of_devices.water(pair)}


def at_voltage(plan: Any, device: str, settings: dict[str, Any]) -> dict[str, Any]:
    """Settings of a device with its voltage beside its water."""
    return settings | {"water": settings["water"] | {"capacitor": plan.devices.capacitor(device)}}


def own_section(plan: Any, name: str, contact: str | None = None, key: str = "device") -> dict[str, Any]:
    """Section of a beam under a key, as of `section_of_beam`; none of other devices."""
    return {key: section_of_beam(plan, name, contact)} if name in plan.devices.beams else {}


def section_of_beam(plan: Any, name: str, contact: str | None = None) -> dict[str, Any]:
    """Kind, pair and dimensions of a beam, length of its strips, and its solids in the air of a contact."""
    section = plan.config["devices"][name]
    solids = {"hamaker_constant_zJ": plan.air.hamaker_constant(contact or section["pair"])}
    solids |= plan.materials.modulus(section["pair"])
    return select(DesignedBeam, section | solids, strip_um=plan.devices.strip(name))
