"""Rules on where results are beyond the model: each gives a `stiction.devices.limits.limit.Limit`, or None.

Lengths are in metres, angles of rotation in radians, shares between 0 and 1. Effects of known amount are relative
changes of a length or a force. `stiction.report.limits.words` has the sentences.
"""

import math
from collections.abc import Mapping, Sequence

from stiction.beam.foundation import LONGER, TOO_EARLY
from stiction.constants import WATER_MOLECULE
from stiction.contact.air import MOLECULES as LIQUID
from stiction.contact.air import is_humid
from stiction.contact.full.smooth_pairs import shortfall
from stiction.contact.materials import COATING, COATING_ATTRACTION, OF_COATINGS, PROPERTIES
from stiction.devices.limits.limit import Limit, Side

#: Largest plastic share of the contact area. Pair c has 58 %, and its beams stick at 72 % of the predicted length.
PLASTIC = 0.02
#: ASSUME: smallest gap, in units of film height plus rms roughness. The model takes the range of the force laws as
#: short compared with the gap: with a film of half the gap, Eq. (13) gives half of the adhesion energy.
FILMS = 20
#: Fewest molecules across a film for which results are within the range of validity, RH 0.395 at 300 K where water wets
#: both surfaces perfectly.
MOLECULES = 4
#: ASSUME: largest share of the force on a patch that the surface tension along its rim may add.
RIM = 0.1
#: Largest slope of a beam.
ROTATION = 0.1
#: Growth of the length that sticks by the square of the slope, and the largest slope up to which it was computed.
OF_SLOPE, STEEPEST = 0.096, 0.3
#: Smallest ratio of crack length to thickness.
SLENDER = 20.0
#: Relative shortening of a crack by the compliance of an elastic clamp times its ratio to the thickness, and by shear
#: times the square of this ratio: see `stubby_beam`.
CLAMP, SHEAR = 0.442, 1.22
#: Largest 6 h w² / (t l²), beyond which a beam bends as a plate.
PLATE = 10.0
#: Largest gap of a bridge, in thicknesses, for which its stretching lets bridges come free that are up to 5 % longer.
STRETCH = 0.5
#: Longer bridges that stretching lets come free, at most, at a gap of one thickness.
STRETCHED = 0.16
#: Largest shortfall of forces on summits without a warning.
SHORTFALL = 0.1
#: Largest part of one strip in full contact in the squared error of a change, without a warning.
OF_ONE_STRIP = 1 / 3
#: Lengths from 500 resampled strips over those from 5000, at most, on two microscope files.
RESAMPLED = 1.03


def arcs_of_elements(share: float, strip: float) -> Limit | None:
    """Beams ending as an arc in the finite elements. Their fraction depends on the length of the strips."""
    if share == 0:
        return None
    return Limit("arcs_of_elements", Side.EITHER, False, numbers={"share": share, "strip": strip})


def long_strips(strip: float, longest: float, is_bridge: bool = False) -> Limit | None:
    """Strips longer than the cracks, or the middle, of a beam allow.

    If much too long, nothing is simulated, and the strongest patch is everywhere. Otherwise cracks stop too early.
    """
    if strip <= longest:
        return None
    numbers = {"strip": strip, "longest": longest}
    if strip > LONGER * longest:
        return Limit("nothing_simulated", Side.SAFE, False, numbers=numbers | {"is_bridge": is_bridge})
    if is_bridge:
        return Limit("long_strips_of_bridge", Side.EITHER, False, numbers=numbers)
    return Limit("long_strips", Side.SAFE, True, TOO_EARLY, numbers)


def resampled_strips(samples: int) -> Limit | None:
    """Strips drawn from samples, 0 if they are drawn from a chaos model. Stronger strips that are rarer are missing."""
    if samples == 0:
        return None
    return Limit("resampled_strips", Side.UNSAFE, True, 1 / RESAMPLED - 1, {"samples": samples})


def lengths_of_sizes(error: float) -> Limit | None:
    """Lengths from those of a few sizes with an error, 0 if the device is simulated by itself.

    Lengths that are too long are shortened by the error.
    """
    if error == 0:
        return None
    return Limit("lengths_of_sizes", Side.SAFE, True, error, {"error": error})


def repeated_strips(repetition: float, strip: float, learns: bool) -> Limit | None:
    """Strips that repeat laws with a probability, 0 if they are independent, of a device with test beams or not.

    Lengths are too short. Test beams, too short as well, suggest less adhesion than there is.
    """
    if repetition == 0:
        return None
    kind, side = ("repeated_strips_learnt", Side.UNSAFE) if learns else ("repeated_strips", Side.SAFE)
    return Limit(kind, side, False, numbers={"repetition": repetition, "strip": strip})


def strips_move_alone(play: float) -> Limit | None:
    """Strips of the beams of a pair that each draw an offset, with a play [m], where a beam moves as one body."""
    return Limit("strips_move_alone", Side.UNSAFE, False, numbers={"play": play}) if play else None


def missed_accuracy(of_beams: float, of_surfaces: float, accuracy: float) -> Limit | None:
    """Relative errors of a length, by beams and by sampled surfaces, NaN without one, beyond the asked accuracy."""
    errors = {"design.beams": of_beams, "contact.samples": of_surfaces}
    finite = {key: error for key, error in errors.items() if not math.isnan(error)}
    reached = math.hypot(*finite.values())
    if reached <= accuracy:
        return None
    numbers = {"reached": reached, "asked": accuracy, "key": max(finite, key=finite.get)}
    return Limit("missed_accuracy", Side.EITHER, True, reached, numbers)


def cut_off_mean(share: float, mean: float, length: float) -> Limit | None:
    """Mean crack length of S-shaped beams without the others, with longer cracks."""
    if share == 1:
        return None
    return Limit("cut_off_mean", Side.SAFE, False, numbers={"share": share, "mean": mean, "length": length})


def plastic_contact(share: float, pressure: float, is_stopper: bool = False, is_listed: bool = True) -> Limit | None:
    """Contact plastic under a mean pressure of the surfaces, NaN if not studied, of a stopper or of beams.

    ``is_listed`` says whether the list of studies admits plasticity. Adhesion alone presses less.
    """
    if math.isnan(share):
        return Limit("plasticity_unchecked", Side.EITHER, False, numbers={"is_listed": is_listed})
    if share <= PLASTIC:
        return None
    numbers = {"share": share, "pressure": pressure, "is_stopper": is_stopper}
    return Limit("plastic_contact", Side.UNSAFE, False, numbers=numbers)


def default_material(name: str, inputs: Sequence[str]) -> Limit | None:
    """Defaults used for another material than polysilicon. ``inputs`` lists given inputs."""
    missing = [entry.words for entry in PROPERTIES.values() if entry.words not in inputs]
    if name == "polysilicon" or not missing:
        return None
    return Limit("default_material", Side.EITHER, False, numbers={"name": name, "missing": missing})


def spacer(name: str, inputs: Sequence[str]) -> Limit | None:
    """Coating without its own attraction. ``inputs`` lists given inputs of its material."""
    if OF_COATINGS[COATING] not in inputs or OF_COATINGS[COATING_ATTRACTION] in inputs:
        return None
    return Limit("spacer", Side.UNSAFE, False, numbers={"name": name})


def without_gaps(changes: Mapping[float, tuple[float, float]], shorter: bool = False) -> Limit | None:
    """Left out attraction across gaps, and its effect on a length (``shorter``) or force.

    The changes and their standard errors are relative, by humidity. They are those of the mean: how much the safe size,
    which the tail decides, changes is not known.
    """
    if not changes:
        return None
    of_all = [change for change, _ in changes.values()]
    worst = min(of_all) if shorter else max(of_all)
    kind, side = ("without_gaps", Side.UNSAFE) if (worst < 0) == shorter else ("without_gaps_safe", Side.SAFE)
    numbers = {"changes": [[humidity, *change] for humidity, change in changes.items()], "shorter": shorter}
    return Limit(kind, side, False, worst, numbers)


def flat_patches(share: float) -> Limit | None:
    """Fraction of the sampled patches without resistance to the adhesion, counted as flat surfaces."""
    return None if share == 0 else Limit("flat_patches", Side.SAFE, False, numbers={"share": share})


def smooth_pair(rms: float, humidities: Sequence[float]) -> Limit | None:
    """Forces on summits at humidities [-] with water, on a pair of an rms [m] that attraction flattens.

    The amount is that of slopes like those of B2. It is not known for gentler ones, whose forces are larger still.
    """
    short = {humidity: shortfall(rms, humidity) for humidity in humidities}
    large = [[humidity, *deficits] for humidity, deficits in short.items() if deficits[0] > SHORTFALL]
    if not large:
        return None
    worst = max(deficit for _, deficit, _ in large)
    return Limit("smooth_pair", Side.UNSAFE, False, 1 / (1 - worst) - 1, {"rms": rms, "short": large})


def unknown_full_contact(unknown: Sequence[float]) -> Limit | None:
    """Forces on summits at humidities [-] with water, at which full contact did not settle or would take too long."""
    if not unknown:
        return None
    return Limit("unknown_full_contact", Side.EITHER, False, numbers={"humidities": list(unknown)})


def few_strips(fraction: float) -> Limit | None:
    """Part of one strip in the squared error of the change by full elastic contact, NaN without one [-].

    Of pair c, one strip of 60 held a fifth of its force on summits, on two peaks 1 nm above all others. Without it, the
    ratio and its stated error were both wrong.
    """
    return Limit("few_strips", Side.EITHER, False, numbers={"part": fraction}) if fraction > OF_ONE_STRIP else None


def thin_film(film: float) -> Limit | None:
    """Film of height h_C too thin for a liquid. At height zero, there is none.

    Thinner ones than the thinnest liquid are those of devices with what bounds them beside them.
    """
    if not 0 < film < MOLECULES * WATER_MOLECULE:
        return None
    if film < LIQUID * WATER_MOLECULE:
        return Limit("solid_film", Side.SAFE, False, numbers={"film": film})
    return Limit("thin_film", Side.EITHER, False, numbers={"film": film})


def beyond_isotherm(measured: float, wettest: float) -> Limit | None:
    """Wettest air in which an isotherm was measured, and that of some results. Films do not grow beyond it [-]."""
    if wettest <= measured:
        return None
    return Limit("beyond_isotherm", Side.UNSAFE, False, numbers={"measured": measured, "wettest": wettest})


def condensing(conditions: Sequence[Mapping[str, float]]) -> Limit | None:
    """Conditions of a device at or below their dew points. Both in °C, of those with a ``dew_point_C``."""
    wet = [air for air in conditions if air.get("dew_point_C", -math.inf) >= air["temperature_C"]]
    if not wet:
        return None
    numbers = {"airs": [[air["temperature_C"], air["dew_point_C"]] for air in wet]}
    return Limit("condensing", Side.UNSAFE, False, numbers=numbers)


def supercooled(conditions: Sequence[Mapping[str, float]]) -> Limit | None:
    """Conditions of a device in which water is below 0 °C, and does not condense."""
    airs = [air for air in conditions if air.get("dew_point_C", -math.inf) < air["temperature_C"] < 0]
    celsius = sorted({air["temperature_C"] for air in airs})
    return Limit("supercooled", Side.EITHER, False, numbers={"celsius": celsius}) if celsius else None


def no_water(film: float, humidity: float) -> Limit | None:
    """Humid air without a film of height h_C: no water condenses between the surfaces."""
    return None if film > 0 or not is_humid(humidity) else Limit("no_water", Side.EITHER, True, 0.0)


def wide_meniscus(film: float, sides: Sequence[float]) -> Limit | None:
    r"""Film of height h_C not small against the sides a and b of a patch of surface.

    The tension in the film pulls on the patch with :math:`\gamma (\cos\theta_1 + \cos\theta_2) a b / h_C`, and the
    surface of the water along its rim with at most :math:`2 \gamma (a + b)`. Where the solids are wetted, the ratio is
    :math:`h_C (1/a + 1/b)`. It holds for films that fill the patch, not for the safe force.
    """
    share = film * sum(1 / side for side in sides)
    if share <= RIM:
        return None
    return Limit("wide_meniscus", Side.UNSAFE, False, share, {"film": film, "share": share})


def least_gap(film: float, rms: float) -> float:
    """Smallest gap with beam and film apart [m], from the height h_C of the film and rms roughness [m]."""
    return FILMS * (film + rms)


def filled_gap(gap: float, film: float, rms: float) -> Limit | None:
    """Gap not much wider than film h_C and roughness. Beam and film are not apart."""
    if gap >= least_gap(film, rms):
        return None
    return Limit("filled_gap", Side.EITHER, False, numbers={"gap": gap, "film": film, "rms": rms})


def large_rotation(gap: float, crack_length: float) -> Limit | None:
    """Slope 1.5 h / l of a beam, too steep for the linear theory.

    An inextensible beam that slides freely along the ground, the elastica, releases more energy: the length that
    sticks, along the beam or at its tip, grows by 0.096 to 0.098 times the square of the slope, as tests compute it up
    to slopes of 0.3. What holds it back stretches it, which stores more energy.
    """
    slope = 1.5 * gap / crack_length
    if slope <= ROTATION:
        return None
    numbers = {"crack_length": crack_length, "slope": slope}
    longer = OF_SLOPE * slope**2 if slope <= STEEPEST else math.nan
    return Limit("large_rotation", Side.SAFE, False, longer, numbers)


def stubby_beam(crack_length: float, thickness: float) -> Limit | None:
    r"""Crack too short for Euler-Bernoulli theory and an ideal clamp.

    A clamp on an elastic half space turns by 16.67 M / (π E t²) per width (O'Donnell, J. Appl. Mech. 27, 461 (1960)),
    as if the beam were longer by 0.442 t. Shear adds :math:`E t^2 / (\kappa G l^2)` to its compliance (κ 5/6, ν 0.22).
    """
    ratio = crack_length / thickness
    if ratio >= SLENDER:
        return None
    shorter = CLAMP / ratio + SHEAR / ratio**2
    numbers = {"crack_length": crack_length, "ratio": ratio, "shorter": shorter}
    return Limit("stubby_beam", Side.UNSAFE, True, -shorter, numbers)


def wide_beam(gap: float, width: float, thickness: float, crack_length: float) -> Limit | None:
    """Beam too wide to curve freely across its width. It is stiffer than computed."""
    ratio = 6 * gap * width**2 / (thickness * crack_length**2)
    if ratio <= PLATE:
        return None
    return Limit("wide_beam", Side.SAFE, False, numbers={"crack_length": crack_length, "ratio": ratio})


def stretched_bridge(gap: float, thickness: float) -> Limit | None:
    """Bridge with more tension by its deflection, which helps to free it."""
    ratio = gap / thickness
    if ratio < STRETCH:
        return None
    return Limit("stretched_bridge", Side.SAFE, False, STRETCHED if ratio <= 1 else math.nan, {"ratio": ratio})


def triggered(*limits: Limit | None) -> list[Limit]:
    """Triggered limits, in order."""
    return [limit for limit in limits if limit is not None]


def beam_warnings(
    gap: float, width: float, thickness: float, crack_length: float, film: float, rms: float
) -> list[Limit]:
    """All limits of the dimensions of a beam with this crack length, film height and rms roughness [m]."""
    return triggered(filled_gap(gap, film, rms)) + length_warnings(gap, width, thickness, crack_length)


def length_warnings(gap: float, width: float, thickness: float, crack_length: float) -> list[Limit]:
    """Limits of a beam with a crack as short as this [m]."""
    return triggered(
        large_rotation(gap, crack_length),
        stubby_beam(crack_length, thickness),
        wide_beam(gap, width, thickness, crack_length),
    )
