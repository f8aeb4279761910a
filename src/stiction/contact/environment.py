r"""Environment of two surfaces: condensed water, or attraction in dry air, and force curves in it (Sec. III-A).

The contact of the solids does not depend on it. Force curves at any humidity follow from the contact and the water.

**Adsorbed water.** A solid that water wets has a film of some thickness t before any water condenses between two of
them. At the tension p = -ΔP its disjoining pressure is p. The grand potential of a gap g full of water is p g above
that of both solids under thick water. That of two films without a meniscus has the derivative t₁ + t₂ by p, the water
in them, and is γ (cos θ₁ + cos θ₂) in saturated air. Water bridges gaps for which the first is less, up to

.. math:: h_C = \frac{\gamma (\cos\theta_1 + \cos\theta_2)}{p} + \frac{1}{p} \int_0^p (t_1 + t_2) \, dp' .

The tension stays p, so that flats need the work p h_C. Films of van der Waals forces,
:math:`t = (\mathfrak{H} / 6 \pi p)^{1/3}`, add 3 t, which is 0.5 nm at RH 0.44 and 1.0 nm at RH 0.90 for
:math:`\mathfrak{H}` = 10 zJ. Layers of a fixed thickness add 2 t, or nothing if they are part of the solid. In
saturated air the work p t of the films vanishes. Contact angles are those in saturated air.
"""

from collections.abc import Callable, Collection
from dataclasses import dataclass, field, replace
from functools import partial
from typing import NamedTuple

import numpy as np

from stiction.contact import forcelaw, gaps, vanderwaals
from stiction.contact.air import MOLECULES, Air
from stiction.contact.correction import NONE, Correction, ElasticChange
from stiction.contact.materials import Solid
from stiction.contact.meniscus import BRIDGE, Isotherm, film
from stiction.contact.solids import attraction_between, interfaces
from stiction.contact.voltage import Capacitor
from stiction.models import SIDES


@dataclass(frozen=True)
class Gaps:
    """Attraction across the gaps between the solids."""

    hamaker_constant: dict[str, float]  #: of the two solids, by medium [J]
    summits: str  #: medium through which the summits attract, whose work is not counted again
    wavelength: float = np.inf  #: of the retardation [m]
    spacer: float = 0.0  #: thickness of both coatings [m]
    bodies: dict[str, Solid] = field(default_factory=dict)  #: both solids by side, where coatings attract as well

    def through(self, medium: str) -> gaps.FlatAttraction | gaps.LayeredFlats:
        """Attraction of flats through a medium."""
        if not self.bodies:
            return gaps.FlatAttraction(self.hamaker_constant[medium], self.wavelength, self.spacer)
        pairs = interfaces(*self.bodies.values(), medium)
        return gaps.LayeredFlats(tuple(gaps.FlatAttraction(each, self.wavelength, apart) for each, apart in pairs))

    def work(self, gap: float | np.ndarray, height: float) -> float | np.ndarray:
        """Work of two flats beyond the summits' [J m⁻²], at gaps [m] and under a film of a height [m].

        If the summits attract through dry air, so do the solids across the film.
        """
        across = gaps.work_across_film(gap, height, self.through(self.summits), self.through("dry"))
        return across - self._summit_attraction.work(gap)

    def scaled(self, factor: float, sides: Collection[str]) -> "Gaps":
        """Gaps with a factor of the Hamaker constants of the solids on some sides, see ``combined``."""
        scales = {side: factor if side in sides else 1.0 for side in SIDES}
        scale = vanderwaals.combined(*scales.values())
        constants = {medium: scale * constant for medium, constant in self.hamaker_constant.items()}
        bodies = {side: body.attracting(scales[side]) for side, body in self.bodies.items()}
        return replace(self, hamaker_constant=constants, bodies=bodies)

    @property
    def _summit_attraction(self):
        """Attraction of the summits."""
        if self.bodies:
            return attraction_between(*self.bodies.values(), self.summits)
        return vanderwaals.attraction(self.summits, self.hamaker_constant[self.summits], self.spacer)


@dataclass(frozen=True)
class Water:
    """Condensed water, and the attraction without it."""

    temperature: float  #: T [K]
    contact_angles: tuple[float, float] = (0.0, 0.0)  #: on beam and substrate [rad]
    gaps: Gaps | None = None  #: attraction across the gaps; without it, only the summits attract
    correction: Correction | None = None  #: to full elastic contact; without it, the sum over summits
    capacitor: Capacitor | None = None  #: attraction by a voltage
    #: Height that films adsorbed on both solids add to the water between them [m]. ASSUME: the same at any humidity,
    #: and none in the paper.
    adsorbed: float = 0.0
    isotherm: Isotherm | None = None  #: of films that grow with the humidity, beside this height
    #: How much warmer the water is in some conditions of devices [K], by humidity in words.
    warmer: dict[str, float] = field(default_factory=dict)
    #: Whether films that are no liquid are computed: those of devices, which have what bounds them beside them.
    bounded: bool = False

    def temperature_at(self, humidity: float) -> float:
        """Temperature of the water at a humidity [K]."""
        return self.temperature + self.warmer.get(Air(humidity).name, 0.0)

    def between(self, device_airs: Collection[float], humidities: Collection[float]) -> "Water":
        """Water with temperatures at some humidities (n,) between those of humid airs in which devices are stated [-].

        ASSUME: from one of these to the next, the temperature follows the humidity linearly. Beyond them it stays.
        """
        if not self.warmer or not device_airs:
            return self
        nodes = sorted(device_airs)
        differences = np.interp(humidities, nodes, [self.temperature_at(air) - self.temperature for air in nodes])
        added = zip(map(float, humidities), map(float, differences), strict=True)
        return replace(self, warmer=self.warmer | {Air(air).name: more for air, more in added})

    @property
    def reaches_across(self) -> bool:
        """Whether anything attracts across the gaps between the surfaces."""
        return bool(self.gaps or self.capacitor)

    def work_across(self, gap: float | np.ndarray, height: float) -> float | np.ndarray:
        """Work of two flats beyond summits and film [J m⁻²], at gaps [m] and under a film of a height [m]."""
        work = self.gaps.work(gap, height) if self.gaps else 0.0
        return work + self.capacitor.work(gap) if self.capacitor else work

    def changes(self, humidity: float) -> tuple[ElasticChange, ElasticChange]:
        """Changes of e and f_max by full elastic contact at a humidity: those of dry air without condensation."""
        if self.correction is None:
            return NONE, NONE
        return self.correction.at(humidity if self.film(humidity)[0] else 0.0)

    def changes_of_tips(self, humidity: float, slopes: np.ndarray) -> list[ElasticChange]:
        """Changes of the largest attraction of tips at slopes (s,) [-] by full elastic contact, as `changes`."""
        if self.correction is None:
            return [NONE] * len(slopes)
        return self.correction.of_tips(humidity if self.film(humidity)[0] else 0.0, slopes)

    def film(self, humidity: float) -> tuple[float, float]:
        """Height h_C [m] and tension -ΔP [Pa] at a relative humidity, see `stiction.contact.meniscus.film`.

        The height has what adsorbed films add. Whether the water is a liquid does not depend on it.

        Raises
        ------
        ValueError
            If the film is no liquid, and nothing bounds it.
        """
        fewest = BRIDGE if self.bounded else MOLECULES
        height, tension = film(humidity, self.temperature_at(humidity), self.contact_angles, fewest)
        if not height:
            return height, tension
        return height + self.adsorbed + (self.isotherm.height(humidity) if self.isotherm else 0.0), tension

    def at(self, humidity: float) -> "Water":
        """Water at a humidity. Without condensation, the summits attract each other through air."""
        if self.film(humidity)[0]:
            return self
        return replace(self, gaps=self.gaps and replace(self.gaps, summits="dry"))


class ForceCurves(NamedTuple):
    """Force curves of all samples, as `stiction.contact.forcelaw.parametrise` takes them."""

    distance: np.ndarray  #: d (n_d,) [m]
    curve: Callable[[int], np.ndarray]  #: force of sample k (n_d,) [Pa]
    samples: int
    beyond: np.ndarray | None = None  #: energy beyond the last distance, where attraction reaches farther (m,) [J m⁻²]
    #: Upper bounds of e [J m⁻²] and f_max [Pa] of any surfaces, known where attraction reaches across gaps.
    flat: tuple[float, float] | None = None


def force_curves(
    solid: np.ndarray,
    bearing: np.ndarray,
    starts: tuple[float, float],
    step: float,
    humidity: float,
    water: Water,
) -> ForceCurves:
    """Force curves of all samples at a relative humidity, from their contact.

    The contact is as in `stiction.contact.forcelaw.humid_curves`.
    """
    layer = water.film(humidity)
    distance, curve = forcelaw.humid_curves(solid, bearing, starts, step, layer)
    if not water.reaches_across:
        return ForceCurves(distance, curve, len(solid))
    work = partial(water.work_across, height=layer[0])
    pressure, beyond = gaps.gap_pressures(bearing, starts[1], distance, step, work)
    bound = flooded_law(humidity, water, 0.0)
    return ForceCurves(distance, lambda k: curve(k) + pressure[k], len(solid), beyond, bound)


def flooded_law(humidity: float, water: Water, hamaker_constant: float) -> tuple[float, float]:
    """Upper bounds of e [J m⁻²] and f_max [Pa] of any surfaces at a humidity: flooded flats in contact.

    Water pulls nowhere harder or farther than between flats, and neither do the solids. Their Hamaker constant [J] is 0
    without van der Waals forces, and that of the water if attraction reaches across gaps.
    """
    energy, pull = flooded_parts(humidity, water, hamaker_constant).sum(axis=0)
    return float(energy), float(pull)


def flooded_parts(humidity: float, water: Water, hamaker_constant: float) -> np.ndarray:
    """Parts of `flooded_law` (3, 2) [J m⁻², Pa]: of water, solids and voltage, 0 where one does not attract."""
    height, pull = water.film(humidity)
    solids, voltage = np.zeros((2, 2))
    if water.gaps:
        hamaker_constant = water.gaps.hamaker_constant[water.gaps.summits]
    if hamaker_constant:
        summits = vanderwaals.DugdaleAttraction(hamaker_constant)
        solids += summits.work_of_adhesion, summits.stress
    if water.gaps:
        solids += float(water.gaps.work(0.0, height)), water.gaps.through("dry").largest_pressure
    if water.capacitor:
        voltage += float(water.capacitor.work(0.0)), water.capacitor.largest_pressure
    return np.array([(height * pull, pull), solids, voltage])
