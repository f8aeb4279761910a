"""Limits of the model: one function each, with a sentence and its number, or None.

Lengths are in metres, angles of rotation in radians, shares between 0 and 1.
"""

import math
from collections.abc import Mapping, Sequence

from stiction.analysis.smooth_pairs import largest_shortfall, shortfall
from stiction.beam.foundation import ACCURACY, LONGER, TOO_EARLY
from stiction.constants import WATER_MOLECULE
from stiction.contact.materials import COATING, COATING_ATTRACTION, OF_COATINGS, PROPERTIES
from stiction.rounding import in_percent

#: Largest plastic share of the contact area. Pair c has 58 %, and its beams stick at 72 % of the predicted length.
PLASTIC = 0.02
#: ASSUME: smallest gap, in units of film height plus rms roughness. The model takes the range of the force laws as
#: short compared with the gap: with a film of half the gap, Eq. (13) gives half of the adhesion energy.
FILMS = 20
#: Fewest molecules across a film for which results are within the range of validity, RH 0.395 at 300 K where water wets
#: both surfaces perfectly. Films of less than `stiction.contact.meniscus.MOLECULES` are refused.
MOLECULES = 4
#: ASSUME: largest share of the force on a patch that the surface tension along its rim may add.
RIM = 0.1
#: Largest slope of a beam.
ROTATION = 0.1
#: Smallest ratio of crack length to thickness.
SLENDER = 20.0
#: Largest 6 h w² / (t l²), beyond which a beam bends as a plate.
PLATE = 10.0
#: Largest gap of a bridge, in thicknesses, for which its stretching lets bridges come free that are up to 5 % longer.
STRETCH = 0.5
#: What plastic contact does to beams and to stoppers that were pressed as hard.
SHORTER, STRONGER = "beams that were pressed stick at shorter lengths", "stoppers that were pressed hold more"
#: Error of contact on summits alone. In humid air, full contact of two strips each of 1.0 and 1.7 nm rms at RH 0.45 and
#: 0.65 has 1.05 to 1.16 times their energy; at higher rms it has less energy. Forces: `stiction.analysis.smooth_pairs`.
SUMMITS = (
    "interaction of neighbouring summits (in humid air, on surfaces of 0.5 to 1.7 nm rms, lengths come out up to 4 % "
    f"too long and forces, up to RH 0.97, up to {in_percent(largest_shortfall())} too small)"
)
#: Largest shortfall of forces on summits without a warning.
SHORTFALL = 0.1
#: The same in dry air, from six strips of each pair of the paper (docs/tables/deformed.md) and five of the coated pair
#: of examples/sealed.yaml. On the first strip of the smoothest pair there, e is 7.26 in place of 2.36 mJ/m², f_max 5.70
#: in place of 1.61 MPa.
BENT = (
    "in dry air the bending of surfaces towards each other (on surfaces like those of the paper lengths come out 1 to "
    "8 % too long and forces 10 to 40 % too small; on a strip of 1.6 nm rms, lengths were a third too long and the "
    "force 3.5 times too small; without contact.model summits it is included)"
)
#: Words of every warning about a result on the unsafe side.
UNSAFE = "the unsafe side"
#: How to let plastic contact be checked, and how where the list of studies leaves it out.
DISTANCE = "give its distance in studies.plasticity.distance_nm"
NAMED = f"{DISTANCE}, and name plasticity in run.studies"


def not_modelled(left_out: Sequence[str] = (), humid: bool = True) -> str:
    """Effects relevant to stiction but not in the model: at no settings, or left out by the present ones."""
    time = ["the time that water needs to condense and to evaporate"] * humid
    never = [
        "residues of drying",
        *time,
        "drift of electric charge",
        "wear",
        "conformal films, which correlate both surfaces",
    ]
    sentence = f"Not in the model: {', '.join([*left_out, *never])}, and curl by a stress gradient."
    fast = " If surfaces separate faster than water evaporates, they hold more than computed: this is the unsafe side."
    return sentence + fast * humid


def arcs_of_elements(share: float, strip: float) -> str | None:
    """Beams ending as an arc in the finite elements. Their fraction depends on the length of the strips."""
    if share == 0:
        return None
    return (
        f"{100 * share:.4g} % of the beams end as arcs, held by the tip only. This share depends on the strip length, "
        f"here {strip * 1e6:.3g} µm. For a realistic share, describe the beam under `devices`, where tips are computed "
        "on tilted strips."
    )


def long_strips(strip: float, longest: float, is_bridge: bool = False) -> str | None:
    """Strips longer than the cracks, or the middle, of a beam allow."""
    if strip <= longest:
        return None
    what = "middle of this bridge" if is_bridge else "cracks of this beam"
    head = f"Strips of {strip * 1e6:.3g} µm are longer than the {longest * 1e6:.3g} µm that resolve the {what}"
    if strip > LONGER * longest:
        return (
            f"{head}, by so much that nothing is simulated: all beams count as stuck that surfaces could hold which "
            "are everywhere like their strongest patch, the safe side."
        )
    if is_bridge:
        return f"{head}: its lengths may be off to either side. Shorter strips are more accurate."
    return (
        f"{head} within {100 * ACCURACY:.0f} %: they stop too early, by at most {100 * TOO_EARLY:.0f} % where strips "
        f"are {LONGER:g} times as long, which is the safe side. Shorter strips are more accurate."
    )


def resampled_strips(samples: int) -> str | None:
    """Strips drawn from samples, 0 if they are drawn from a chaos model."""
    if samples == 0:
        return None
    return (
        f"Few strips hold much more than most: the chaos model lacks them, so that strips are drawn from the {samples} "
        "samples themselves. Strips that are rarer are missing. On two microscope files, lengths from 500 samples were "
        "up to 3 % longer than lengths from 5000; contact.samples sets their number."
    )


def lengths_of_sizes(error: float) -> str | None:
    """Lengths from those of a few sizes with an error, 0 if the device is simulated by itself."""
    if error == 0:
        return None
    return (
        f"Many devices are on this ground: lengths along the beam follow power laws through a few sizes. They err by "
        f"{error:.1%} at sizes between these. Where they are too long, all lengths are shortened by it."
    )


def repeated_strips(repetition: float, strip: float, learns: bool) -> str | None:
    """Strips that repeat laws with a probability, 0 if they are independent, of a device with test beams or not."""
    if repetition == 0:
        return None
    learnt = f" Test beams are computed in the same way and thus suggest too little adhesion: this is {UNSAFE}."
    return (
        f"Long waves raise or lower whole strips of {strip * 1e6:.3g} µm: a strip repeats the law of its neighbour "
        f"with a probability of {repetition:.2g}, the correlation of mean heights. Adhesion is correlated less, so "
        "lengths come out too short, the safe side."
        f"{learnt * learns}"
    )


def missed_accuracy(of_beams: float, of_surfaces: float, asked: float) -> str | None:
    """Relative errors of a length, by beams and by sampled surfaces, NaN without one, beyond the asked accuracy."""
    parts = {"design.beams": of_beams, "contact.samples": of_surfaces}
    known = {key: error for key, error in parts.items() if not math.isnan(error)}
    reached = math.hypot(*known.values())
    if reached <= asked:
        return None
    return (
        f"The standard error of this length is {in_percent(reached)}, more than the {in_percent(asked)} of "
        f"design.accuracy.length: state more {max(known, key=known.get)} than this run has, or a larger error there."
    )


def cut_off_mean(share: float, mean: float, length: float) -> str | None:
    """Mean crack length of S-shaped beams without the others, with longer cracks."""
    if share == 1:
        return None
    return (
        f"Only {100 * share:.4g} % of the beams end S-shaped. Their mean crack length, {mean * 1e6:.0f} µm, lacks the "
        f"longer cracks that beams of {length * 1e6:.0f} µm cut off: it is not the mean of longer beams."
    )


def plastic_contact(share: float, pressure: float, effect: str = SHORTER, remedy: str = DISTANCE) -> str | None:
    """Contact plastic under a mean pressure of the surfaces, NaN with a remedy if not studied.

    ``effect`` says what this does to a device that was pressed, `SHORTER` or `STRONGER`. Adhesion alone presses less.
    """
    if math.isnan(share):
        return f"Whether the contact is plastic was not checked: {remedy}."
    if share <= PLASTIC:
        return None
    return (
        f"{in_percent(share)} of the area in contact is plastic, more than {in_percent(PLASTIC)}, when the surfaces "
        f"are pressed together with {pressure / 1e6:.3g} MPa: {effect} than the elastic model predicts, which is the "
        "unsafe side. The study pressing says by how much, and from which pressure on."
    )


def default_material(name: str, stated: Sequence[str]) -> str | None:
    """Defaults used for another material than polysilicon. ``stated`` lists given inputs."""
    missing = [entry.words for entry in PROPERTIES.values() if entry.words not in stated]
    if name == "polysilicon" or not missing:
        return None
    if len(missing) == 1:
        return f"1 property of {name} is not stated; that of section solid or of polysilicon is used: {missing[0]}."
    return (
        f"{len(missing)} properties of {name} are not stated; those of section solid and of polysilicon are used: "
        f"{', '.join(missing)}."
    )


def spacer(name: str, stated: Sequence[str]) -> str | None:
    """Coating without its own attraction. ``stated`` lists given inputs of its material."""
    if OF_COATINGS[COATING] not in stated or OF_COATINGS[COATING_ATTRACTION] in stated:
        return None
    return (
        f"The coating of {name} counts as a spacer that attracts no more than the air or water around it. Real "
        "coatings attract, so that this result is on the unsafe side; the one without coating_nm is on the safe side. "
        f"{COATING_ATTRACTION} includes it."
    )


def without_gaps(changes: Mapping[float, tuple[float, float]], shorter: bool = False) -> str | None:
    """Left out attraction across gaps, and its effect on a length (``shorter``) or force.

    The changes and their standard errors are relative, by humidity.
    """
    if not changes:
        return None
    by = [
        f"{100 * change:+.2g} ± {100 * error:.1g} %{f' at RH {humidity:g}' * (len(changes) > 1)}"
        for humidity, (change, error) in changes.items()
    ]
    what, unsafe = ("the length", min) if shorter else ("the force", max)
    worst = unsafe(change for change, _ in changes.values())
    side = ", which is the unsafe side" if (worst < 0) == shorter else ""
    return (
        f"Attraction of solids across gaps is left out. On these surfaces it would change {what} that holds by "
        f"{', '.join(by)}{side}. attraction.reach all includes it."
    )


def flat_patches(share: float) -> str | None:
    """Fraction of the sampled patches without resistance to the adhesion, counted as flat surfaces."""
    if share == 0:
        return None
    return (
        f"{in_percent(share)} of the patches of surface have too few summits to resist the adhesion. They count as "
        "flat surfaces in contact, which hold more than any rough ones: the prediction is on the safe side."
    )


def smooth_pair(rms: float, humidities: Sequence[float]) -> str | None:
    """Forces on summits at humidities [-] with water, on a pair of an rms [m] that attraction flattens."""
    short = {humidity: shortfall(rms, humidity) for humidity in humidities}
    large = {humidity: of for humidity, of in short.items() if of[0] > SHORTFALL}
    if not large:
        return None
    by = [f"{100 * of:.0f} ± {max(100 * error, 1):.0f} % at RH {humidity:g}" for humidity, (of, error) in large.items()]
    return (
        f"Surfaces as smooth as these, {rms * 1e9:.2g} nm rms together, flatten each other in humid air. Forces on "
        f"summits are then too small, {UNSAFE}: on slopes as gentle as those of B2 by {', '.join(by)}, on steeper ones "
        "by less. contact.model full computes them."
    )


def thin_film(film: float) -> str | None:
    """Film of height h_C too thin for a liquid. At height zero, there is none."""
    if not 0 < film < MOLECULES * WATER_MOLECULE:
        return None
    return (
        f"The film of water is {film * 1e9:.2g} nm high, thinner than {MOLECULES} molecules, "
        f"{MOLECULES * WATER_MOLECULE * 1e9:.3g} nm: the air is too dry for the theory of a liquid, and this result "
        "can be off to either side. Results for dry air and for the next humidity above bracket it."
    )


def no_water(film: float, humidity: float) -> str | None:
    """Humid air without a film of height h_C: no water condenses between the surfaces."""
    if film > 0 or humidity == 0:
        return None
    return (
        "No water condenses between the surfaces, because the cosines of their contact angles add up to zero or less: "
        "results at any humidity are those for dry air."
    )


def wide_meniscus(film: float, sides: Sequence[float]) -> str | None:
    r"""Film of height h_C not small against the sides a and b of a patch of surface.

    The tension in the film pulls on the patch with :math:`\gamma (\cos\theta_1 + \cos\theta_2) a b / h_C`, and the
    surface of the water along its rim with at most :math:`2 \gamma (a + b)`. Where the solids are wetted, the ratio is
    :math:`h_C (1/a + 1/b)`.
    """
    share = film * sum(1 / side for side in sides)
    if share <= RIM:
        return None
    return (
        f"The film of water is up to {film * 1e6:.3g} µm high, not small against the area in contact: the surface "
        f"tension along its rim, which is left out, adds up to {100 * share:.3g} % of the force of the film, more than "
        f"{100 * RIM:.0f} %. Stoppers may hold more than computed, which is the unsafe side."
    )


def least_gap(film: float, rms: float) -> float:
    """Smallest gap with beam and film apart [m], from the height h_C of the film and rms roughness [m]."""
    return FILMS * (film + rms)


def filled_gap(gap: float, film: float, rms: float) -> str | None:
    """Gap not much wider than film h_C and roughness. Beam and film are not apart."""
    if gap >= least_gap(film, rms):
        return None
    what, acts = ("sum of film height and roughness", "water") if film else ("roughness", "attraction across gaps")
    return (
        f"The gap of {gap * 1e6:.3g} µm is less than {FILMS} times the {what}, "
        f"{(film + rms) * 1e9:.3g} nm: the {acts} acts on the beam ahead of its contact, too."
    )


def large_rotation(gap: float, crack_length: float) -> str | None:
    """Slope 1.5 h / l of a beam, too steep for the linear theory."""
    slope = 1.5 * gap / crack_length
    if slope <= ROTATION:
        return None
    return (
        f"At a length of {crack_length * 1e6:.0f} µm the beam reaches a slope of {slope:.3g}, above {ROTATION}: the "
        "linear theory of beams does not hold."
    )


def stubby_beam(crack_length: float, thickness: float) -> str | None:
    """Warn if the crack is too short for Euler-Bernoulli theory and an ideal clamp."""
    ratio = crack_length / thickness
    if ratio >= SLENDER:
        return None
    return (
        f"A crack of {crack_length * 1e6:.0f} µm is only {ratio:.3g} times as long as the beam is thick, less than "
        f"{SLENDER:.0f}: shear and the compliance of the clamp are not in the model."
    )


def wide_beam(gap: float, width: float, thickness: float, crack_length: float) -> str | None:
    """Beam too wide to curve freely across its width."""
    ratio = 6 * gap * width**2 / (thickness * crack_length**2)
    if ratio <= PLATE:
        return None
    return (
        f"At a length of {crack_length * 1e6:.0f} µm, 6 h w² / (t l²) is {ratio:.3g}, above {PLATE:.0f}: the beam "
        "bends as a plate, with the modulus E / (1 - ν²)."
    )


def stretched_bridge(gap: float, thickness: float) -> str | None:
    """Bridge with more tension by its deflection."""
    ratio = gap / thickness
    if ratio < STRETCH:
        return None
    size = "equal to the thickness" if f"{ratio:.3g}" == "1" else f"{ratio:.3g} times the thickness"
    return (
        f"The gap is {size} of the bridge: its stretching, which is left out, helps to free it. Longer bridges would "
        "release, too: by up to 5 % at a gap of half the thickness, by up to 16 % at an equal gap, and by more beyond. "
        "The prediction is on the safe side."
    )


def forbids(warning: str) -> bool:
    """Whether a warning forbids relying on a number: a result on the unsafe side, by an amount that is not known."""
    return UNSAFE in warning


def triggered(*warnings: str | None) -> list[str]:
    """Triggered warnings, in order."""
    return [warning for warning in warnings if warning is not None]


def beam_warnings(
    gap: float, width: float, thickness: float, crack_length: float, film: float, rms: float
) -> list[str]:
    """All warnings about the dimensions of a beam with this crack length, film height and rms roughness [m]."""
    return triggered(filled_gap(gap, film, rms)) + length_warnings(gap, width, thickness, crack_length)


def length_warnings(gap: float, width: float, thickness: float, crack_length: float) -> list[str]:
    """Warnings about a beam with a crack as short as this [m]."""
    return triggered(
        large_rotation(gap, crack_length),
        stubby_beam(crack_length, thickness),
        wide_beam(gap, width, thickness, crack_length),
    )
