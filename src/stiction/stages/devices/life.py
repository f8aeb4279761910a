"""Stage life: causes of the contact of a device, its adhesion then, and ways to free it.

Every answer is a number between two bounds, which are equal where the model leaves nothing open. Voltage and shock of a
beam are those of its length: the stated one, or its least safe length.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from stiction.beam.cantilever import Beam
from stiction.beam.energy import apparent_adhesion_energy
from stiction.config.cases import case_id, in_air
from stiction.config.kinds import restoring_force
from stiction.config.materials import material_of
from stiction.config.units import from_si, in_si
from stiction.constants import DENSITY, LIQUIDS
from stiction.contact.voltage import BREAKDOWN, Capacitor, Dielectric
from stiction.devices.bridges import half_of_bridge
from stiction.devices.risk import Basis, one_in, samples_for
from stiction.devices.stoppers import safe_force, stuck_patches
from stiction.estimates import mean_with_error
from stiction.life import drying, freeing, holding, touch
from stiction.life.dimples import row
from stiction.plan.stage import Stage, select
from stiction.stages.devices import separation as stage_separation
from stiction.stages.devices.opening import DesignedBeam, section_of_beam
from stiction.stages.devices.safe_lengths import chosen_share

#: Questions of a designer, in their order.
QUESTIONS = TOUCH, STICK, HOLD, FREE = "touch", "stick", "hold", "free"
#: Names of answers that sentences are about.
VOLTAGE, SHOCK, COLLAPSE, RELEASED, AFTER = "voltage", "shock", "collapse", "released", "after"
AT_VOLTAGE, FIELD = "at_voltage", "field"
FAST, RESTORING = "fast", "restoring_force"
TILTED, WEDGE = "force_tilted", "wedge"
ON_DIMPLES, BESIDE, DIMPLES, PULLED = "stuck_dimples", "beside_dimples", "dimples", "dimples_force"
#: Sources of the answers about voltages and tilts.
_OF_VOLTAGE, _OF_TILT = "stage at_voltage, stiction.life.holding", "stage tilted_stoppers"


class Answer(NamedTuple):
    """One answer to a question, with numbers in SI."""

    name: str
    question: str
    what: str
    low: float  #: at least; NaN if no such bound is known
    high: float  #: at most; NaN if no such bound is known
    error: float  #: standard uncertainty of the lower bound, or of the upper one alone; NaN if none is known
    unit: str
    form: str
    source: str


@dataclass(frozen=True)
class Liquid:
    """Liquid for the release of devices."""

    surface_tension: float  #: γ [N m⁻¹]
    contact_angle: float = 0.0  #: θ on the device [rad]. ASSUME: 0, the safe side, where it is not stated

    @property
    def adhesion(self) -> float:
        """Adhesion tension γ cos θ [N m⁻¹]."""
        return float(self.surface_tension * np.cos(self.contact_angle))


@dataclass(frozen=True)
class Errors:
    """Standard uncertainties of the inputs of a beam."""

    thickness: float = 0.0  #: [m]
    gap: float = 0.0  #: [m]
    young_modulus: float = 0.0  #: [Pa]
    residual_stress: float = 0.0  #: [Pa]


@dataclass(frozen=True, kw_only=True)
class Stated:
    """Keys of any device beside its dimensions."""

    touchdowns: int = 1
    voltage: float = 0.0  #: [V]
    offset: float = 0.0  #: by charge and contact potential [V]
    dielectric: Dielectric | None = None

    @property
    def capacitor(self) -> Capacitor | None:
        """Device and substrate at their voltage, if there is any."""
        return self.dielectric and Capacitor(self.dielectric, self.voltage, self.offset)

    @property
    def potential(self) -> float:
        """Largest difference of potential [V]."""
        return self.capacitor.potential if self.capacitor else 0.0


@dataclass(frozen=True)
class Dimples:
    """A row of dimples across a beam."""

    number: int
    at: float  #: distance from a clamp [m]
    height: float  #: [m]


@dataclass(frozen=True, kw_only=True)
class OfBeam(Stated):
    """Beam and its surroundings beside its ground."""

    device: DesignedBeam
    density: float  #: ρ [kg m⁻³]
    liquids: dict[str, Liquid]
    uncertainty: Errors
    length: float = 0.0  #: as stated [m]; otherwise the least safe length counts
    dimples: Dimples | None = None

    @property
    def clamps(self) -> int:
        """Number of its clamps."""
        return self.device.opening.arms

    def beam(self, length: float, **changed: float) -> Beam:
        """Beam of a length [m] under its tension, with some inputs changed."""
        device = replace(self.device, **changed)
        sizes = length, device.width, device.thickness, device.young_modulus, device.gap
        return half_of_bridge(Beam(*sizes, elements=1), device.residual_stress)

    def number(self, of: Callable[[Beam], float], length: float) -> tuple[float, float]:
        """Number of the beam, and its standard uncertainty to first order, NaN if no input has any."""
        squares, value = 0.0, of(self.beam(length))
        for field in fields(self.uncertainty):
            mean, error = getattr(self.device, field.name), getattr(self.uncertainty, field.name)
            if error and np.isfinite(value):
                ends = max(mean - error, 0.0), mean + error
                low, high = (of(self.beam(length, **{field.name: end})) for end in ends)
                squares += ((high - low) / 2) ** 2
        return value, squares**0.5 or np.nan


@dataclass(frozen=True)
class Electrode:
    """Electrode for pulling a stopper down."""

    area: float  #: [m²]
    gap: float  #: from the moving part at rest [m]


@dataclass(frozen=True, kw_only=True)
class OfStopper(Stated):
    """Stopper and its surroundings beside its ground, zero if not given."""

    restoring_force: float  #: [N]
    contact: tuple[float, float]  #: sides of its area [m]
    stiffness: float = 0.0  #: of its spring [N m⁻¹]
    gap: float = 0.0  #: way to the contact [m]
    mass: float = 0.0  #: that moves [kg]
    electrode: Electrode | None = None


# Beams


def beam_answers(
    lengths: Mapping[float, xr.Dataset],
    after: Mapping[float, xr.Dataset],
    of: OfBeam,
    biased: Mapping[float, xr.Dataset] | None = None,
    separation: xr.Dataset | None = None,
) -> list[Answer]:
    """Answers about a beam from its safe lengths by humidity: for one touchdown, after all, and at its voltage.

    The dataset of its fast separation is needed where water condenses.
    """
    share = chosen_share(next(iter(lengths.values())))
    safe = {humidity: _safe(dataset, share) for humidity, dataset in lengths.items()}
    length = length_of(lengths, of)
    answers = [
        Answer(
            f"safe_length_{humidity:g}",
            STICK,
            f"safe length {in_air(humidity)}: at most {one_in(share)} sticks after one touchdown",
            *(value, value, error),
            *("m", f"bound of random beams, 95 %, {basis}", "stage safe_lengths"),
        )
        for humidity, (value, error, basis) in safe.items()
    ]
    answers += _touched(of, length) + _held(of, length) if 0 < length < np.inf else []
    answers += [answer for name, liquid in of.liquids.items() for answer in _dried(of, name, liquid.adhesion)]
    answers += _after_touchdowns(of, share, min(safe.values()), after) if after else []
    answers += _separated_fast(lengths, separation) if separation is not None else []
    return _in_order(answers + _at_voltage(of, min(safe.values()), biased))


def length_of(lengths: Mapping[float, xr.Dataset], of: OfBeam) -> float:
    """Length of a beam for voltage and shock [m]: the given one, or its least safe length."""
    return of.length or min(_safe(dataset, chosen_share(dataset))[0] for dataset in lengths.values())


def _safe(dataset, share):
    """Least safe length of all end states [m], the standard error of its estimate, and its basis."""
    one = dataset.sel(share=share)
    one = one.isel(shape=int(one.safe_length.argmin("shape")))
    return *_length_and_error(one), str(one.basis.values)


def _length_and_error(one):
    """Safe length of one end state [m], and the standard error of its estimate; NaN if none is known."""
    errors = [float(one[name]) for name in ("beams_error", "surfaces_error")]
    return float(one.safe_length), float(np.sqrt(np.nansum(np.square(errors)))) or np.nan


def _touched(of, length):
    """Voltage and shock for contact of a beam of a length [m]."""
    clamps, end = of.clamps, "tip" if of.clamps == 1 else "middle"
    forms = {
        1: ("V² = 0.2801 E t³ h³ / (ε₀ L⁴)", "a = 2 E t² h / (3 ρ L⁴)"),
        2: (
            "V² = λ E t³ h³ / (6 ε₀ L⁴), λ = 70.095 without tension",
            "a = 32 E t² h / (ρ L⁴) without tension",
        ),
    }[clamps]
    rigid = "" if clamps == 1 else "; at most: rigid clamps"
    voltage, error = of.number(lambda beam: touch.pull_in_voltage(beam, clamps), length)
    shock, shock_error = of.number(lambda beam: touch.touching_acceleration(beam, clamps, of.density), length)
    factor, beam = touch.half_sine_factor(of.beam(length), clamps), of.beam(length)
    return [
        Answer(
            VOLTAGE,
            TOUCH,
            f"voltage that pulls the {end} in",
            *(voltage, touch.pull_in_voltage(beam, clamps, rigid=True), error),
            *("V", forms[0] + rigid, "stiction.life.touch"),
        ),
        Answer(
            SHOCK,
            TOUCH,
            f"peak of a shock that brings the {end} down",
            *(shock / factor, touch.touching_acceleration(beam, clamps, of.density, rigid=True), shock_error / factor),
            "m s-2",
            f"{forms[1]}, ρ = {of.density:g} kg/m³; at least: / {factor:.2f}, any half-sine{rigid}",
            "stiction.life.touch",
        ),
    ]


def _dried(of, liquid, adhesion):
    """Lengths of beams standing while a liquid dries, and releasing afterwards."""
    clamps = of.clamps
    each, error = of.number(lambda beam: drying.longest_standing_each(beam, clamps, adhesion), 1.0)
    free, free_error = of.number(lambda beam: drying.longest_free(beam, clamps, adhesion), 1.0)
    connected = drying.longest_standing(of.beam(1.0), clamps, adhesion)
    standing, released = {
        1: ("L⁴ = N E t³ h² / (γ cos θ), N = 0.1160 or 0.2295 (connected)", "L⁴ = 3 E t³ h² / (16 γ cos θ)"),
        2: (
            "L⁴ = N E t³ h² / (γ cos θ), N = 4.873 or 8.466 (connected) without tension",
            "two cracks meet at the energy 2 γ cos θ; shorter bridges may be held by their middle",
        ),
    }[clamps]
    source = f"stiction.life.drying, γ cos θ = {from_si(adhesion, 'mN_per_m'):.3g} mN/m"
    return [
        Answer(
            f"{COLLAPSE}_{liquid}",
            TOUCH,
            f"longest beam that does not collapse while {liquid} dries",
            *(each, connected, error),
            *("m", standing, source),
        ),
        Answer(
            f"{RELEASED}_{liquid}",
            STICK,
            f"longest beam that comes free after {liquid} dried",
            *(free if clamps == 1 else np.nan, free, free_error),
            *("m", released, source),
        ),
    ]


def _held(of, length):
    """Adhesion of a stuck beam of a length [m], and its pulling force."""
    clamps = of.clamps
    along, error = of.number(lambda beam: float(apparent_adhesion_energy(length / clamps, beam)), length)
    force, force_error = of.number(lambda beam: freeing.force_at_contact(beam, clamps), length)
    forms = {
        1: ("Γ = 3 E t³ h² / (2 L⁴), Eq. (13)", "F = 3 E I h / L³"),
        2: ("energy at which two cracks meet", "F = 192 E I h / L³ without tension"),
    }[clamps]
    answers = [
        Answer(
            "energy",
            HOLD,
            "adhesion energy that holds it along the beam" if clamps == 1 else "adhesion energy that holds both cracks",
            *(along, along, error, "J m-2", forms[0], "stiction.beam.energy"),
        ),
        Answer(
            "force",
            FREE,
            f"force with which it pulls at its {'tip' if clamps == 1 else 'middle'}",
            *(force, force, force_error, "N", forms[1], "stiction.life.freeing"),
        ),
    ]
    if clamps == 1:
        tip, form = along / 4, "Γ = 3 E t³ h² / (8 L⁴)"
        what = "adhesion energy that holds its tip, on uniform surfaces"
        answers.append(Answer("tip", HOLD, what, tip, tip, error / 4, "J m-2", form, "stiction.devices.arcs"))
    return answers


def _at_voltage(of, safe, biased):
    """Effect of a voltage, and the length safe with it, from the safe length without it and its error [m].

    On flats in contact, and on rough surfaces from the safe lengths at the voltage by humidity, if there are any.
    """
    if not of.capacitor:
        return []
    added = holding.energy_of_voltage(of.capacitor, of.device.gap)
    distance = from_si(of.dielectric.distance, "nm")
    form = f"mean over samples (at least); Γ_V = ε₀ V² / 2 (1 / D - 1 / (D + h)), D = {distance:.3g} nm (at most)"
    gained = [(float(one.voltage_energy), float(one.voltage_error)) for one in (biased or {}).values()]
    low, error = max(gained, default=(np.nan, np.nan))
    what = f"adhesion energy that {of.potential:g} V add"
    numbers = min(low, added), added, error
    answers = [Answer("voltage_energy", HOLD, what, *numbers, "J m-2", form, _OF_VOLTAGE), _field(of)]
    numbers = _shorter(of, added, safe, [_safe(one, chosen_share(one)) for one in (biased or {}).values()])
    if np.isnan(numbers).all():
        return answers
    what = f"safe length while {of.potential:g} V are on"
    form = "1 / L_V⁴ = 1 / L⁴ + 8 Γ_V / (3 E t³ h²), flats (at least); gaps of rough surfaces (at most)"
    return [*answers, Answer(AT_VOLTAGE, HOLD, what, *numbers, "m", form, _OF_VOLTAGE)]


def _shorter(of, added, safe, rough):
    """Safe length at a voltage [m]: on flats, on rough surfaces, and an error of the first, or of the latter alone.

    NaN for bridges on flats, and on rough surfaces that were not computed. Tips are held at steeper slopes by more of
    their surfaces, so that rough ones can have the least length.
    """
    length, flat, error = safe[0], np.nan, np.nan
    high, high_error, _ = min(rough, default=(np.nan, np.nan, ""))
    if of.device.opening.has_tip and 0 < length < np.inf:
        flat = holding.length_at_voltage(length, of.beam(1.0), added, holding.ARC)
        error = safe[1] * (flat / length) ** 5
    if high < flat:
        return high, high, high_error
    return flat, high, high_error if np.isnan(flat) else error


def _field(of):
    """Field in the dielectric of a device whose surfaces touch."""
    what, form = "field in the dielectric in contact", "V / t; thin oxides break down near 1 V/nm"
    return Answer(FIELD, HOLD, what, np.nan, of.capacitor.field, np.nan, "V m-1", form, "stiction.contact.voltage")


def dimple_answers(of: OfBeam, dimples: Mapping[float, xr.Dataset]) -> list[Answer]:
    """Answers about a beam on its dimples, from the forces of rows of them by humidity; none without any."""
    if not dimples:
        return []
    bent = _bent_to_dimples(of)
    means = {humidity: tuple(map(float, mean_with_error(one.pull_off.values))) for humidity, one in dimples.items()}
    worst = max(means, key=means.get)
    what, form = (
        f"mean force on its row of dimples {in_air(worst)}",
        f"sum of {of.dimples.number} largest attractions x area",
    )
    mean, error = means[worst]
    held = Answer(DIMPLES, HOLD, what, mean, mean, error, "N", form, "stage dimples")
    force = np.array([bent[-1].low])
    sticking = [
        Answer(
            f"{ON_DIMPLES}_{humidity:g}",
            STICK,
            f"probability of sticking on its row of dimples {in_air(humidity)}",
            *(float(end[0]) for end in stuck_patches(one.pull_off.values, force)[1:]),
            *(np.nan, "1", "fraction of random rows, 95 %", "stage dimples"),
        )
        for humidity, one in dimples.items()
    ]
    return [*bent, held, *sticking]


def _bent_to_dimples(of):
    """Gap that is left beside the dimples of a beam while they touch, and the force with which it pulls there."""
    at, height = of.dimples.at, of.dimples.height

    def left(beam):
        """Part of the gap left at the deepest point beside the row [-]."""
        return 1 - row(beam, of.clamps, at).deepest * (beam.gap - height) / beam.gap

    def pull(beam):
        """Force of the beam at its row, bent to the dimples' height [N]."""
        return row(beam, of.clamps, at).stiffness * (beam.gap - height)

    (rest, rest_error), (force, error) = of.number(left, of.length), of.number(pull, of.length)
    what, form = "part of the gap that is left beside its dimples", "bent by the force on the row alone"
    source = "stiction.life.dimples"
    beside = Answer(BESIDE, TOUCH, what, max(rest, 0.0), max(rest, 0.0), rest_error, "1", form, source)
    what, form = "force with which it pulls at its row of dimples", "k (h - h_d)"
    return [beside, Answer(PULLED, FREE, what, force, force, error, "N", form, source)]


def _separated_fast(lengths, separation):
    """Safe length of a beam that separates faster than water evaporates, by humidity and end state, in the worst one.

    It is at most that of slow separation.
    """
    slow, fast = [], []
    for humidity, dataset in lengths.items():
        one = dataset.sel(share=chosen_share(dataset))
        for shape in map(str, one["shape"].values):
            length, spread = _length_and_error(one.sel(shape=shape))
            factor, error = _factor(separation, humidity, shape)
            slow.append(length)
            shorter = length * factor if factor else 0.0
            fast.append((shorter, float(np.hypot(spread * factor, length * error)), factor, in_air(humidity)))
    shorter, error, factor, air = min(fast)
    form = f"L x {factor:.3g} {air}, by (e / e_V)^(1/4) of strips or lengths of tips (at least); slow (at most)"
    what = "safe length if it separates faster than water evaporates"
    numbers = (shorter, min(slow), error) if 0 < shorter < np.inf else (np.nan, min(slow), np.nan)
    return [Answer(FAST, FREE, what, *numbers, "m", form, "stage separation")]


def _factor(separation, humidity, shape):
    """Factor of the length by fast separation and its standard error [-]; 1 in air without water."""
    if humidity not in separation.humidity.values:
        return 1.0, 0.0
    one = separation.sel(humidity=humidity, shape=shape)
    return float(one.factor), float(one.factor_error)


def _after_touchdowns(of, share, once, after):
    """Safe length and P(stuck) after all touchdowns, from the safe length of one, and its standard error [m]."""
    independent = min(_safe(dataset, chosen_share(dataset)) for dataset in after.values())
    stuck = freeing.stuck_after(share, of.touchdowns)
    numbers = f"{of.touchdowns} touchdowns"
    return [
        Answer(
            AFTER,
            FREE,
            f"safe length for {numbers}: at most {one_in(share)} sticks after all of them",
            *(independent[0], max(once[0], independent[0]), independent[1], "m"),
            "P of one = 1 - (1 - p)^(1/n) (at least); the same summits each time (at most)",
            "stage touchdowns",
        ),
        Answer(
            "stuck_after",
            FREE,
            f"probability of sticking after {numbers} at the safe length of one",
            *(share, stuck, np.nan, "1", "P (at least) and 1 - (1 - P)^n (at most)", "stiction.life.freeing"),
        ),
    ]


# Stoppers


def stopper_answers(
    stopper: xr.Dataset,
    of: OfStopper,
    biased: xr.Dataset | None = None,
    tilted: xr.Dataset | None = None,
    separation: xr.Dataset | None = None,
) -> list[Answer]:
    """Answers about a stopper from the datasets of its pull-off forces: as it is, at its voltage, tilted, and fast."""
    worst = int(stopper.mean_along.argmax("axis"))
    mean, error = (float(stopper[name][worst]) for name in ("mean_along", "mean_along_error"))
    where = in_air(round(float(stopper.worst_humidity), 2))
    answers = [
        Answer(
            f"stuck_{float(humidity):g}",
            STICK,
            f"probability of sticking {in_air(float(humidity))}",
            *map(float, stopper.stuck.sel(humidity=humidity, bound=["low", "high"])),
            *(np.nan, "1", "fraction of random patches, 95 %", "stage stoppers"),
        )
        for humidity in stopper.humidity.values
    ]
    what = f"mean pull-off force {where}, the worst air"
    answers.append(Answer("force", HOLD, what, mean, mean, error, "N", "largest attraction x area", "stage stoppers"))
    answers += _moved(of) + _freed(stopper, of, separation) + _often(stopper, of)
    answers += [] if tilted is None else _tilted(tilted)
    return _in_order(answers + (_pulled(stopper, of, biased) if of.capacitor else []))


def _tilted(tilted):
    """Fraction of stoppers stuck at their tilts, the force on them, and the tilt at the transition to a wedge."""
    ends = dict.fromkeys(f"{from_si(float(tilt), 'deg'):.3g}" for tilt in tilted.tilt)
    by, form = (
        f"tilted by {' to '.join(ends)}°",
        "random patches; w e / s on smooth surfaces beyond the tilt of a wedge",
    )
    answers = [
        Answer(
            f"stuck_tilted_{float(humidity):g}",
            STICK,
            f"probability of sticking {by}, {in_air(float(humidity))}",
            float(tilted.stuck.sel(humidity=humidity, bound="low").min()),
            float(tilted.stuck.sel(humidity=humidity, bound="high").max()),
            *(np.nan, "1", "fraction of random patches, 95 %", _OF_TILT),
        )
        for humidity in tilted.humidity.values
    ]
    most = tilted.isel(humidity=int(tilted["mean"].max("tilt").argmax("humidity")))
    low, high, air = int(most["mean"].argmin("tilt")), float(most["mean"].max()), in_air(float(most.humidity))
    numbers = float(most["mean"][low]), high, float(most.mean_error[low])
    answers.append(Answer(TILTED, HOLD, f"mean pull-off force {by}, {air}", *numbers, "N", form, _OF_TILT))
    what, form = "tilt beyond which a longer first side hardly holds more", "e / (f_max a), parallel patches"
    numbers = float(tilted.wedge.min()), float(tilted.wedge.max()), np.nan
    answers.append(Answer(WEDGE, HOLD, what, *numbers, "rad", form, _OF_TILT))
    bounded = [float(share) for share in tilted.share[tilted.basis == Basis.SAMPLED]]
    if bounded:
        safe = tilted.safe_force.sel(share=min(bounded)).max("humidity")
        low = int(safe.sel(part="safe").argmin("tilt"))
        numbers = (
            float(safe.sel(part="safe")[low]),
            float(safe.sel(part="safe").max()),
            float(safe.sel(part="error")[low]),
        )
        what, form = f"restoring force that frees all but {one_in(min(bounded))}, {by}", "quantile of the force, 95 %"
        answers.append(Answer("restoring_force_tilted", FREE, what, *numbers, "N", form, _OF_TILT))
    return answers


def _pulled(stopper, of, biased):
    """Force of a voltage in addition to that on a stopper, and the fraction stuck while it is on."""
    flat = of.capacitor.largest_pressure * of.contact[0] * of.contact[1]
    low, error, sticking = np.nan, np.nan, []
    if biased is not None:
        gained = [mean_with_error(row) for row in (biased.pull_off - stopper.pull_off).values]
        low, error = max(gained)
        worst = biased.isel(humidity=int(biased.stuck.sel(bound="estimate").argmax("humidity")))
        what = f"probability of sticking while {of.potential:g} V are on, {in_air(float(worst.humidity))}"
        numbers = *map(float, worst.stuck.sel(bound=["low", "high"])), np.nan
        sticking = [Answer("stuck_at_voltage", HOLD, what, *numbers, "1", "as without voltage", _OF_VOLTAGE)]
    what, form = f"force that {of.potential:g} V add", "mean of rough patches (at least); ε₀ V² A / (2 D²) (at most)"
    added = Answer(AT_VOLTAGE, HOLD, what, min(low, flat), flat, error, "N", form, _OF_VOLTAGE)
    return [added, *sticking, _field(of)]


def _moved(of):
    """Shock and voltage for contact of a stopper, as far as mass and electrode are given."""
    answers = []
    if of.mass:
        slow = of.restoring_force / of.mass
        form = f"a = F / m; at least: / {touch.HALF_SINE:.3g}, any half-sine"
        numbers = slow / touch.HALF_SINE, slow, np.nan
        what = "peak of a shock that brings it into contact"
        answers.append(Answer(SHOCK, TOUCH, what, *numbers, "m s-2", form, "stiction.life.touch"))
    if of.electrode:
        voltage = touch.stopper_voltage(of.stiffness, of.gap, of.electrode.area, of.electrode.gap)
        form = "V² = 8 k g³ / (27 ε₀ A), or that of its way if it touches before g / 3"
        what = "voltage on its electrode that brings it into contact"
        answers.append(Answer(VOLTAGE, TOUCH, what, voltage, voltage, np.nan, "V", form, "stiction.life.touch"))
    return answers


def _freed(stopper, of, separation):
    """Restoring force, stiffness and shock that free all but a small fraction of the stoppers, slowly and fast."""
    bounded = [float(share) for share in stopper.share[stopper.basis == Basis.SAMPLED]]
    if not bounded:
        return []
    at = stopper.safe_force.sel(share=min(bounded))
    at = at.isel(humidity=int(at.sel(part="safe").argmax("humidity")))
    force, error = float(at.sel(part="safe")), float(at.sel(part="error"))
    fast = [] if separation is None else [safe_force(row, min(bounded))[0] for row in separation.pull_off.values]
    most = max([force, *fast]) if np.isfinite(fast).all() else np.nan
    but = f"all but {one_in(min(bounded))}, {in_air(float(at.humidity))}"
    source, bound = "stages stoppers and separation", "faster than water evaporates, in any of its air (at most)"
    form = f"quantile of the pull-off force, 95 %; {bound}"
    answers = [Answer(RESTORING, FREE, f"restoring force that frees {but}", force, most, error, "N", form, source)]
    if of.gap:
        what, form = f"stiffness of the spring that frees {but}", f"k = F / gap; {bound}"
        numbers = (number / of.gap for number in (force, most, error))
        answers.append(Answer("stiffness", FREE, what, *numbers, "N m-1", form, source))
    if of.mass:
        shocks = (freeing.freeing_acceleration(hold, of.restoring_force, of.mass) for hold in (force, most))
        what, form = f"shock that frees {but}", f"a = (F_hold - F) / m; {bound}"
        numbers = *shocks, error / of.mass
        answers.append(Answer("freeing", FREE, what, *numbers, "m s-2", form, "stiction.life.freeing"))
    return answers


def _often(stopper, of):
    """P(stuck) after all touchdowns in the worst given air, and the force for a small fraction stuck."""
    if of.touchdowns == 1:
        return []
    once = float(stopper.stuck.sel(bound="estimate").max())
    numbers, form = f"{of.touchdowns} touchdowns", "P (at least) and 1 - (1 - P)^n (at most)"
    what, after = f"probability of sticking after {numbers}", freeing.stuck_after(once, of.touchdowns)
    answers = [Answer("stuck_after", FREE, what, once, after, np.nan, "1", form, "stiction.life.freeing")]
    share = float(stopper.share.max())
    rare = freeing.probability_for(share, of.touchdowns)
    if stopper.sizes["sample"] >= samples_for(rare):
        few, many = (max(safe_force(row, p)[::2] for row in stopper.pull_off.values) for p in (share, rare))
        what = f"restoring force that frees all but {one_in(share)} after {numbers}"
        form = "the same summits each time (at least); P of one = 1 - (1 - p)^(1/n) (at most)"
        answers.append(Answer(AFTER, FREE, what, few[0], many[0], few[1], "N", form, "stage stoppers"))
    return answers


def _in_order(answers):
    """Answers in the order of the questions."""
    return sorted(answers, key=lambda answer: QUESTIONS.index(answer.question))


# Dataset


def compute(data: Mapping[str, Any], settings: dict[str, Any]) -> xr.Dataset:
    """Answers about a device, from its safe lengths by humidity or from the forces of a stopper."""
    if "stopper" in data:
        of = in_si(OfStopper, settings["stopper"])
        own = (data.get(name) for name in ("biased", "tilted", "separation"))
        return layout(stopper_answers(data["stopper"], of, *own), of)
    of, lengths = in_si(OfBeam, settings["beam"]), data["lengths"]
    answers = beam_answers(lengths, data.get("after", {}), of, data.get("biased"), data.get("separation"))
    answers += dimple_answers(of, data.get("dimples", {}))
    return layout(_in_order(answers), of, length_of(lengths, of))


def layout(answers: Sequence[Answer], of: Stated, length: float = np.nan) -> xr.Dataset:
    """Dataset of the answers about a device; ``length`` is that at which a beam is asked for voltage and shock [m]."""
    columns = dict(zip(Answer._fields, zip(*answers, strict=True), strict=True))
    numbers = {"low": "at least", "high": "at most", "error": "standard uncertainty"}
    return xr.Dataset(
        {name: ("answer", list(columns[name])) for name in ("question", "what", "unit", "form", "source")}
        | {name: ("answer", list(columns[name]), {"long_name": text}) for name, text in numbers.items()}
        | {"length": ((), length, {"units": "m"}), "touchdowns": ((), of.touchdowns, {"units": "1"})}
        | {"potential": ((), of.potential, {"units": "V"})},
        coords={"answer": list(columns["name"])},
    )


def answers_of(dataset: xr.Dataset) -> list[Answer]:
    """Answers about a device from its dataset."""
    texts = ("name", "question", "what", "unit", "form", "source")
    rows = zip(*(dataset["answer" if name == "name" else name].values for name in Answer._fields), strict=True)
    return [
        Answer(
            *(str(value) if name in texts else float(value) for name, value in zip(Answer._fields, row, strict=True))
        )
        for row in rows
    ]


def _inputs(plan, at):
    """Safe lengths at all humidities of a beam, for all touchdowns and at its voltage as well, or forces of a stopper.

    Beyond the breakdown of the dielectric, no voltage is there that could hold, and flats alone bound what it does.
    """
    section, capacitor = plan.config["devices"][at.device], plan.devices.capacitor(at.device)
    fast = stage_separation.separation_inputs(plan, at.device)
    is_biased = bool(capacitor) and in_si(Capacitor, capacitor).field <= BREAKDOWN
    if not plan.devices.kind(at.device).is_beam:
        biased = {"biased": f"devices/at_voltage/{at.device}"} if is_biased else {}
        tilted = {"tilted": f"devices/tilted/{at.device}"} if "tilt_deg" in section else {}
        return {"stopper": f"devices/stoppers/{at.device}"} | biased | tilted | fast
    cases = {humidity: case_id(at.device, humidity) for humidity in section["humidities"]}
    more, biased = cases if "touchdowns" in section else {}, cases if is_biased else {}
    dimpled = cases if "dimples" in section else {}
    return fast | {
        "lengths": {humidity: f"devices/safe_lengths/{case}" for humidity, case in cases.items()},
        "after": {humidity: f"devices/touchdowns/{case}" for humidity, case in more.items()},
        "biased": {humidity: f"devices/at_voltage/{case}" for humidity, case in biased.items()},
        "dimples": {humidity: f"devices/dimples/{case}" for humidity, case in dimpled.items()},
    }


def _settings(plan, at):
    """Settings of a device, the liquids and its density, or of a stopper."""
    section = plan.config["devices"][at.device]
    if not plan.devices.kind(at.device).is_beam:
        return {"stopper": select(OfStopper, section, restoring_force_uN=restoring_force(section))}
    material = material_of(plan.config, plan.config["pairs"][section["pair"]]["beam"])
    density = material.get("density_kg_per_m3", DENSITY)
    known = {name: {"surface_tension_mN_per_m": from_si(tension, "mN_per_m")} for name, tension in LIQUIDS.items()}
    own = {"uncertainty": {}} | section | {"device": section_of_beam(plan, at.device)}
    own |= {"density_kg_per_m3": density, "liquids": known | plan.config.get("liquids", {})}
    return {"beam": select(OfBeam, own)}


STAGES = (
    Stage.writing(
        "life",
        "devices/life/{device}",
        inputs=_inputs,
        settings=_settings,
        compute=compute,
        message="Life of device {device}.",
    ),
)
