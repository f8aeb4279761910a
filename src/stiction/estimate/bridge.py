r"""Length at which the middle of a bridge holds it, as the estimate knows it. Plain Python, SI units.

The middle of a bridge has the curvature κ of its arms, which pull it with the force P. Without stress, a law of the
energy e that attracts with f up to e / f holds it up to

.. math:: L^8 = \frac{768 (E t^3)^2 h^3}{e f} , \quad \kappa P^2 = 8 w^2 e f ,

see `stiction.devices.bridges.least_length`. For flooded flats, :math:`e f = \Gamma^2 / h_C`. What is learnt is the
logarithm of a length over that of these, which hardly depends on the bridge.

Stress enters by P and κ: half of a bridge has the stiffnesses F by its deflection and M between both, 12 and 6 without
stress, as in `stiction.beam.tension.end_stiffness`. So it is held as well as one without stress of the length
:math:`L (864 / F^2 M)^{1/8}`. On a uniform law, finite elements agree within 0.5 % at 50 MPa and 3 % at 200 MPa; the
rest is learnt.

At a voltage all lengths shrink by one factor, as in a run. Flats in contact gain the most, the energy :math:`\Gamma_V`
and the tension p of `stiction.estimate.voltage`,

.. math:: \Bigl( \frac{L}{L_V} \Bigr)^8 = \Bigl( 1 + \frac{\Gamma_V}{e} \Bigr) \Bigl( 1 + \frac p f \Bigr) .

ASSUME: f is the median of patches as large as the middle, known from stoppers, and e what with it holds half of all.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

from stiction.config.units import to_si
from stiction.estimate import dry, dry_bridge
from stiction.estimate.asked import Asked
from stiction.estimate.closed import flats
from stiction.estimate.closed.beams import SlenderBeam
from stiction.estimate.closed.bending import end_stiffness
from stiction.estimate.closed.flats import FlatBound, FlatPull
from stiction.estimate.closed.life import BeamLife
from stiction.estimate.force import pull_off
from stiction.estimate.length import LengthRow, Lengths, NotLearnt, falling, known_at, on_solids
from stiction.estimate.solids import OF_POLYSILICON, BesideWater
from stiction.estimate.state import OF_PATCHES, Film, PatchState, film, held_by
from stiction.estimate.statistics import Heights
from stiction.estimate.table import Surrogate, processes

#: Names of the coordinates.
COORDINATES = (
    *OF_PATCHES[:6],
    "area of the middle in contact in summits (from thickness, gap and width)",
    *OF_PATCHES[7:],
    "gap over the film of water (from gap and humidity)",
    "stress over the middle in contact (from stress and thickness)",
)
#: Steps to a length under stress, each of which leaves at most 5/8 of the error of its logarithm.
_STEPS = 60


@dataclass(frozen=True)
class Stretched:
    """Bridge under a stress, and at a voltage."""

    decay: float  #: k of its deflection, the root of the tension over the bending stiffness [1/m]
    factor: float = 1.0  #: of its lengths without stress by a voltage

    @classmethod
    def of(cls, stress: float, thickness: float, modulus: float) -> "Stretched":
        """Bridge of a stress [Pa], a thickness [m] and a modulus [Pa]."""
        return cls(math.sqrt(12 * stress / modulus) / thickness)

    def bare(self, length: float) -> float:
        """Length without stress and voltage that is held as well as one with them [m]."""
        force, moment = end_stiffness(self.decay * length / 2)
        return length * (864 / (force**2 * moment)) ** 0.125 / self.factor

    def length(self, bare: float) -> float:
        """Length under the stress, at the voltage, that is held as well as one without them [m].

        Examples
        --------
        >>> bridge = Stretched.of(50e6, 2e-6, 164e9)
        >>> round(1e6 * bridge.length(150e-6), 1), round(1e6 * bridge.bare(bridge.length(150e-6)), 6)  # µm
        (173.0, 150.0)
        """
        length = bare
        for _ in range(_STEPS):
            length *= bare / self.bare(length)
        return length


@dataclass(frozen=True)
class MiddleState:
    """Surfaces, water and a bridge."""

    heights: Heights  #: of the sum of both surfaces
    film: Film
    thickness: float  #: t [m]
    gap: float  #: h [m]
    width: float  #: w [m]
    stress: float  #: [Pa]
    modulus: float  #: E of the bridge [Pa]
    modulus_in_contact: float  #: E of the solids [Pa]
    beside_water: BesideWater = OF_POLYSILICON
    names: ClassVar[tuple[str, ...]] = COORDINATES

    @property
    def held(self) -> float:
        """Product e f L⁸ with which it is held without stress [N² m⁵]."""
        return held_by(self.modulus * self.thickness**3, self.gap)

    @property
    def flooded_length(self) -> float:
        """Length at which flooded flats hold it without stress [m]."""
        return (self.held / (self.film.energy**2 / self.film.height)) ** 0.125

    @property
    def _width_in_contact(self):
        """Length P / 2wp of the middle on which flooded flats of the tension p hold it [m]."""
        tension = self.film.energy / self.film.height
        return 8 * self.modulus * self.thickness**3 * self.gap / (self.flooded_length**3 * tension)

    @property
    def patch(self) -> PatchState:
        """Middle in contact."""
        area = self.width * self._width_in_contact
        return PatchState(self.heights, self.film, area, self.modulus_in_contact, self.beside_water)

    @property
    def coordinates(self) -> tuple[float, ...]:
        """Numbers on which its length over that on flooded flats depends, by ``COORDINATES``."""
        gap, stress = math.log(self.gap / self.film.height), self.stretched.decay * self._width_in_contact
        return (*self.patch.coordinates, gap, stress)

    @property
    def stretched(self) -> Stretched:
        """Bridge under its stress."""
        return Stretched.of(self.stress, self.thickness, self.modulus)


def shorter(energy: float, pull_off: float, added: float, tension: float) -> float:
    """Factor of lengths by an added energy [J m⁻²] and tension [Pa], beside those that hold them without a voltage.

    Examples
    --------
    >>> shorter(6e-3, 3e6, 0.0, 0.0), round(shorter(6e-3, 3e6, 6e-3, 3e6), 4)
    (1.0, 0.8409)
    """
    return ((1 + added / energy) * (1 + tension / pull_off)) ** -0.125


def known_patch(patch: PatchState, learnt: Mapping[str, Any]) -> PatchState:
    """Patch with the nearest area that was learnt, from the part of the table about stoppers.

    ASSUME: beyond, its pressure hardly depends on the area.
    """
    low, high = (to_si(side, "um") ** 2 for side in learnt["sides"])
    return replace(patch, area=min(max(patch.area, low), high))


def lengths(state: MiddleState, middle: Surrogate, full: Surrogate, *changes: Surrogate) -> Lengths:
    """Lengths without stress that are held as well as those under it [m].

    Raises
    ------
    NotLearnt
        If the state is beyond what was learnt.
    """
    change = known_at(full, state.coordinates, COORDINATES)
    summits = falling(on_solids(middle, state, *changes), math.log(state.flooded_length))
    return changed(summits, change["shift"], change["power"])


def over_flooded(state: MiddleState, found: Lengths) -> float:
    """Length that few bridges stick at over that on flooded flats, the larger the weaker they stick [-].

    Where they stick weakly, most come free of two cracks at any length, and nothing is tested beyond some ratio.
    """
    return math.exp(found.logarithms[-1]) / state.flooded_length


def changed(summits: Lengths, shift: float, power: float) -> Lengths:
    """Lengths by full contact, from the shift of the logarithm of their median and the power of their scatter."""
    median = summits.logarithms[0]
    return Lengths(
        tuple(median + shift + power * (each - median) for each in summits.logarithms), power * summits.slope
    )


@dataclass(frozen=True)
class Bridge(Asked):
    """Question about one bridge."""

    thickness: float  #: [m]
    gap: float  #: [m]
    width: float  #: [m]
    stress: float  #: [Pa]
    length: float | None = None  #: [m]
    tension: float = 0.0  #: that a voltage adds [Pa]

    @property
    def size(self) -> float | None:
        """Its length [m]."""
        return self.length

    @property
    def closed(self) -> Stretched:
        """Closed form of its lengths, from those without stress."""
        return Stretched.of(self.stress, self.thickness, self.solids.beam_modulus)

    def closed_on(self, found: Mapping[Heights, Lengths], air: float, table: Mapping[str, Any]) -> Stretched:
        """Closed form of its lengths in one air, of the surface on which a voltage shortens them most."""
        if not self.tension:
            return self.closed
        factors = (self._factor(self._pull_off(heights, air, table), each) for heights, each in found.items())
        return replace(self.closed, factor=min(factors))

    def _factor(self, force, found):
        """Factor of the lengths by its voltage, from a pull-off pressure and the lengths without it."""
        energy = held_by(self._rigidity, self.gap) / (math.exp(found.logarithms[0]) ** 8 * force)
        return shorter(energy, force, self.added, self.tension)

    def _pull_off(self, heights, air, table):
        """Pull-off pressure of the middle on the sum of two surfaces at a humidity."""
        if self.is_dry(air):
            return self._dry_state(heights, table["dry"]).pull_off
        patch = self._state(heights, film(air, self.temperature, self.solids.wetting)).patch
        return pull_off(known_patch(patch, table["stoppers"]), table["stoppers"])

    @property
    def _rigidity(self):
        """E t³."""
        return self.solids.beam_modulus * self.thickness**3

    @property
    def life(self) -> BeamLife:
        """Its life."""
        sizes = self.thickness, self.gap, self.width, self.solids.beam_modulus
        return BeamLife(SlenderBeam(2, *sizes, self.stress), self.surroundings)

    def on_flats(self, attracted: Sequence[FlatPull]) -> FlatBound:
        """Length that flat surfaces hold by their attractions."""
        return flats.of_bridge(self.life.beam, attracted)

    def errors(self, table: Mapping[str, Any]) -> Mapping[str, Any]:
        """Part of the table with the errors of its lengths."""
        return table["bridges"]

    def lengths(self, heights: Heights, water: Film, table: Mapping[str, Any], *_tips: Surrogate | None) -> Lengths:
        """Lengths without stress that are held as well as those that its middle holds, on the sum of two surfaces."""
        learnt = table["bridges"]
        self._refuse(learnt["ranges"])
        state = self._state(heights, water)
        found = lengths(state, *processes(learnt, "middle", "full"))
        if over_flooded(state, found) > learnt["longest"]:
            raise NotLearnt("it sticks so weakly that no bridge as long was tested")
        return found

    def _state(self, heights, water):
        """State on the sum of two surfaces in a film."""
        sizes = self.thickness, self.gap, self.width, self.stress
        solids, ratios = self.solids, self.solids.beside_water(water.energy)
        return MiddleState(heights, water, *sizes, solids.beam_modulus, solids.modulus, ratios)

    def in_dry_air(self, heights: Heights, table: Mapping[str, Any]) -> Lengths:
        """Lengths of `lengths` in dry air."""
        self._refuse(table["bridges"]["ranges"])
        learnt = table["dry"]
        return dry_bridge.lengths(self._dry_state(heights, learnt), *dry.processes(learnt["bridges"], "middle"))

    def _dry_state(self, heights, learnt):
        """State on the sum of two surfaces in dry air, of which a part of the table is."""
        patch = dry.DryPatch(heights, self.solids.in_dry_air, dry_bridge.AREA, self.solids.modulus)
        force = dry.pull_off(patch, learnt["stoppers"])
        return dry_bridge.DryMiddle(patch, force, self._rigidity, self.gap, self.width)

    def _refuse(self, ranges):
        """Refuse sizes beyond ranges by their names, of ends and unit."""
        for name, (low, high, unit) in ranges.items():
            if not to_si(low, unit) <= getattr(self, name) <= to_si(high, unit):
                symbol = unit.replace("u", "µ")
                raise NotLearnt(f"the {name} of a bridge must be from {low:g} to {high:g} {symbol}")

    def row(self, row: LengthRow) -> LengthRow:
        """Row of lengths as it is."""
        return row
