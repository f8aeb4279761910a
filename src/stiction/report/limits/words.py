"""Sentences on limits of results, one for each kind, from the numbers of `stiction.devices.limits.limit.Limit`.

Nothing is decided here: sides and amounts are fields of the limits.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from stiction.beam.foundation import ACCURACY, LONGER, TOO_EARLY
from stiction.constants import WATER_MOLECULE
from stiction.contact.air import DRY_AIR, has_dry, humid
from stiction.contact.air import MOLECULES as LIQUID
from stiction.contact.full.smooth_pairs import largest_shortfall
from stiction.contact.materials import COATING_ATTRACTION
from stiction.devices.limits.limit import Limit, Side
from stiction.devices.limits.rules import FILMS, MOLECULES, OF_SLOPE, PLASTIC, PLATE, RIM, ROTATION, SLENDER, STEEPEST
from stiction.report.format import TO_MPA, TO_NM, TO_UM, airs, bounding, listed, with_error
from stiction.rounding import in_percent
from stiction.stages.surfaces.surface_flags import SIDES


def text(limit: Limit) -> str:
    """Sentence on a limit.

    Raises
    ------
    KeyError
        If the kind has no sentence.
    """
    return SENTENCES[limit.kind](**limit.numbers)


def texts(limits: Iterable[Limit]) -> list[str]:
    """Sentences on limits, in order."""
    return [text(limit) for limit in limits]


def joined(limits: Iterable[Limit]) -> str:
    """Sentences on limits of one point as one, empty without any."""
    return "; ".join(texts(limits))


#: Names of kinds that their keys do not say, and sides of results, in short.
_NAMES = {"large_rotation": f"slope above {ROTATION}"}
_ON_SIDE = {Side.SAFE: "safe side", Side.UNSAFE: "unsafe side", Side.EITHER: "either side"}


def in_short(limits: Iterable[Limit]) -> str:
    """Names of limits, each once with the side on which results err and, where it is known, by how much at most.

    Examples
    --------
    >>> in_short([Limit("large_rotation", Side.SAFE, False, amount) for amount in (0.002, 0.001)])
    'slope above 0.1 (safe side, by up to 0.2 %)'
    >>> in_short([Limit("thin_film", Side.EITHER, False)])
    'thin film (either side)'
    """
    amounts: dict = {}
    for limit in limits:
        amounts.setdefault((_NAMES.get(limit.kind, limit.kind.replace("_", " ")), limit.side), []).append(limit.amount)
    most = {named: max(map(abs, each)) if np.isfinite(each).all() else np.nan for named, each in amounts.items()}
    return "; ".join(
        f"{name} ({_ON_SIDE[side]}{f', by up to {in_percent(amount)}' * bool(np.isfinite(amount))})"
        for (name, side), amount in most.items()
    )


# Strips and lengths


def _longer_strips(strip, longest, is_bridge):
    part_of_beam = "middle of this bridge" if is_bridge else "cracks of this beam"
    return (
        f"Strips of {TO_UM * strip:.3g} µm are longer than the {TO_UM * longest:.3g} µm that resolve the {part_of_beam}"
    )


def _repeated_strips(repetition, strip):
    return (
        f"Long waves raise or lower whole strips of {TO_UM * strip:.3g} µm: a strip repeats the law of its neighbour "
        f"with a probability of {repetition:.2g}, the correlation of mean heights. Adhesion is correlated less, so "
        "lengths come out too short, the safe side."
    )


# Contact


def _plasticity_unchecked(is_listed):
    named = "" if is_listed else ", and name plasticity in run.studies"
    return (
        f"Whether the contact is plastic was not checked: give its distance in studies.plasticity.distance_nm{named}."
    )


def _plastic_contact(share, pressure, is_stopper):
    of_beams, of_stoppers = "beams that were pressed stick at shorter lengths", "stoppers that were pressed hold more"
    effect = of_stoppers if is_stopper else of_beams
    return (
        f"{in_percent(share)} of the area in contact is plastic, more than {in_percent(PLASTIC)}, when the surfaces "
        f"are pressed together with {TO_MPA * pressure:.3g} MPa: {effect} than the elastic model predicts, which is "
        "the unsafe side. The study pressing says by how much, and from which pressure on."
    )


def _default_material(name, missing):
    if len(missing) == 1:
        return f"1 property of {name} is not stated; that of section solid or of polysilicon is used: {missing[0]}."
    return (
        f"{len(missing)} properties of {name} are not stated; those of section solid and of polysilicon are used: "
        f"{', '.join(missing)}."
    )


def _gaps(changes, shorter, side=""):
    by = [
        f"{100 * change:+.2g} ± {100 * error:.1g} %{f' at RH {humidity:g}' * (len(changes) > 1)}"
        for humidity, change, error in changes
    ]
    return (
        f"Attraction of solids across gaps is left out. On these surfaces it would change the "
        f"{'length' if shorter else 'force'} that holds by {', '.join(by)}{side}. attraction.reach all includes it."
    )


def _smooth_pair(rms, short):
    by = [
        f"{100 * shortfall:.0f} ± {max(100 * error, 1):.0f} % at RH {humidity:g}"
        for humidity, shortfall, error in short
    ]
    return (
        f"Surfaces as smooth as these, {TO_NM * rms:.2g} nm rms together, flatten each other in humid air. Forces on "
        f"summits are then too small, the unsafe side: on slopes as gentle as those of B2 by {', '.join(by)}, on "
        "steeper ones by less. Full elastic contact, the default, computes them where it settles in time."
    )


# Water


def _condensing(airs):
    where = ", ".join(f"{celsius:g} °C with a dew point of {dew_point:g} °C" for celsius, dew_point in airs)
    return (
        f"Water condenses on the device: {where}. Drops that dry pull surfaces together, which is not in the model: "
        "this is the unsafe side. Keep the dew point lower, or leave this condition out for the answer in all others."
    )


def _supercooled(celsius):
    listed = " and ".join(f"{value:g}" for value in celsius)
    return (
        f"At {listed} °C water counts as a supercooled liquid, and dew points are those over it. Ice and frost are not "
        "in the model, so that this result can be off to either side."
    )


def _filled_gap(gap, film, rms):
    lengths, acts = ("sum of film height and roughness", "water") if film else ("roughness", "attraction across gaps")
    return (
        f"The gap of {TO_UM * gap:.3g} µm is less than {FILMS} times the {lengths}, "
        f"{TO_NM * (film + rms):.3g} nm: the {acts} acts on the beam ahead of its contact, too."
    )


# Beams


def _large_rotation(crack_length, slope):
    length = bounding(TO_UM * crack_length, 3, up=False)
    steep = f"At a length of {length} µm the beam reaches a slope of {slope:.3g}, above {ROTATION}: "
    by = f"about {in_percent(OF_SLOPE * slope**2)}" if slope <= STEEPEST else "more"
    return (
        f"{steep}the linear theory of beams does not hold. Longer beams would release, too, by {by}: the length is on "
        "the safe side."
    )


def _stretched_bridge(ratio):
    size = "equal to the thickness" if f"{ratio:.3g}" == "1" else f"{ratio:.3g} times the thickness"
    return (
        f"The gap is {size} of the bridge: its stretching, which is left out, helps to free it. Longer bridges would "
        "release, too: by up to 5 % at a gap of half the thickness, by up to 16 % at an equal gap, and by more beyond. "
        "The prediction is on the safe side."
    )


# Surfaces


#: Assumed quantities of a surface: name, unit, and whether their scatter is relative.
_UNKNOWN = {
    "rms": ("rms", " nm", True),
    "skewness": ("skewness", "", False),
    "kurtosis": ("kurtosis", "", False),
    "corner": ("corner of the spectrum", " rad/µm", True),
    "hurst": ("Hurst exponent", "", False),
    "cutoff": ("cut-off of the spectrum", " rad/µm", True),
}


def _assumption(word, value, scatter):
    """Assumed value, if it is known, with its scatter over typical surfaces, if there are any."""
    label, unit, relative = _UNKNOWN[word]
    text = label + ("" if value is None else f" {value:.3g}{unit}")
    if scatter is None:
        return text
    return f"{text} ± {100 * scatter:.2g} %" if relative else f"{text} ± {scatter:.2g}"


def _assumed_surface(surface, library, listed):
    assumptions = "; ".join(_assumption(*each) for each in listed)
    kind = f"any of {len(library)} typical surfaces ({', '.join(library)})"
    return f"surface {surface}: not measured but assumed, {kind}: {assumptions}"


def _assumed_without_scatter(surface, listed, **_):
    assumptions = "; ".join(_assumption(*each) for each in listed)
    reason = "not measured but assumed, without an uncertainty, for want of typical surfaces"
    return f"surface {surface}: {reason}: {assumptions}"


def _unlike_typical(surface, changed):
    differences = [
        f"{_UNKNOWN[word][0]} {value:.3g}{_UNKNOWN[word][1]} in place of {typical:.3g}{_UNKNOWN[word][1]} of {other}"
        for word, value, typical, other in changed
    ]
    return f"surface {surface}: what is stated allows no more than {'; '.join(differences)}"


# Test beams


def _nonlinear_update(different):
    listed = [f"{with_error(100 * apart, 100 * error)} % ({again})" for again, apart, error in different]
    return (
        f"The update is not linear: results computed again differ from it by {', '.join(listed)}. If this "
        "matters beside their standard uncertainties, set the inputs to the values from the test beams and "
        "compute the device again."
    )


def _beyond_humidities_of_test_beams(measured, beyond):
    wet = humid(measured)
    where = [DRY_AIR.where] * has_dry(measured) + [f"from RH {wet[0]:g} to {wet[-1]:g}" for _ in wet[:1]]
    return f"Test beams were measured {' and '.join(where)}: the prediction {airs(beyond)} is an extrapolation."


def _beyond_adhesion_of_test_beams(result, change):
    words = "longer than the longest" if change > 0 else "shorter than the shortest"
    return (
        f"{result}: cracks of equal beams would be {100 * abs(change):.0f} % {words} of the "
        "test beams, so that the slope of the model over the adhesion is extrapolated."
    )


#: Sentence of each kind, as a function of its numbers.
SENTENCES: dict[str, Callable[..., str]] = {
    # Strips and lengths
    "arcs_of_elements": lambda share, strip: (
        f"{100 * share:.4g} % of the beams end as arcs, held by the tip only. This share depends on the strip length, "
        f"here {TO_UM * strip:.3g} µm. For a realistic share, describe the beam under `devices`, where tips are "
        "computed on tilted strips."
    ),
    "nothing_simulated": lambda is_bridge, **strips: (
        f"{_longer_strips(**strips, is_bridge=is_bridge)}, by so much that nothing is simulated: every beam "
        "counts as stuck that a surface made of its strongest patch alone would hold (safe side)."
    ),
    "long_strips_of_bridge": lambda **strips: (
        f"{_longer_strips(**strips, is_bridge=True)}: its lengths may be off to either side. Shorter strips are more "
        "accurate."
    ),
    "long_strips": lambda **strips: (
        f"{_longer_strips(**strips, is_bridge=False)} within {100 * ACCURACY:.0f} %: they stop too early, by at most "
        f"{100 * TOO_EARLY:.0f} % where strips are {LONGER:g} times as long, which is the safe side. Shorter strips "
        "are more accurate."
    ),
    "smoother_than_full_contact": lambda: (
        "smoother surfaces than the given one change more in full elastic contact than is computed, which is the "
        "unsafe side: give the smoothest surface of the range"
    ),
    "resampled_strips": lambda samples: (
        f"Few strips hold much more than most: the chaos model lacks them, so that strips are drawn from the {samples} "
        "samples themselves. Strips that are rarer are missing. On two microscope files, lengths from 500 samples were "
        "up to 3 % longer than lengths from 5000; contact.samples sets their number."
    ),
    "lengths_of_sizes": lambda error: (
        f"Many devices are on this ground: lengths along the beam follow power laws through a few sizes. They err by "
        f"{error:.1%} at sizes between these. Where they are too long, all lengths are shortened by it."
    ),
    "repeated_strips": _repeated_strips,
    "repeated_strips_learnt": lambda **numbers: (
        f"{_repeated_strips(**numbers)} Test beams are computed in the same way and thus suggest too little adhesion: "
        "this is the unsafe side."
    ),
    "strips_move_alone": lambda play: (
        f"Each strip of these beams draws an offset of its own, with a play of {TO_NM * play:.3g} nm, where beams move "
        "as one body. At a coherence of 0.8 and a play of 35 nm, cracks were 35 % too long at 1 in 20 and 19 % in the "
        "median, the unsafe side: state a device, whose strips move together."
    ),
    "missed_accuracy": lambda reached, asked, key: (
        f"The standard error of this length is {in_percent(reached)}, more than the {in_percent(asked)} of "
        f"design.accuracy.length: state more {key} than this run has, or a larger error there."
    ),
    "cut_off_mean": lambda share, mean, length: (
        f"Only {100 * share:.4g} % of the beams end S-shaped. Their mean crack length, {TO_UM * mean:.0f} µm, lacks "
        f"the longer cracks that beams of {TO_UM * length:.0f} µm cut off: it is not the mean of longer beams."
    ),
    # Contact
    "plasticity_unchecked": _plasticity_unchecked,
    "plastic_contact": _plastic_contact,
    "default_material": _default_material,
    "spacer": lambda name: (
        f"The coating of {name} counts as a spacer that attracts no more than the air or water around it. Real "
        "coatings attract, so that this result is on the unsafe side; the one without coating_nm is on the safe side. "
        f"{COATING_ATTRACTION} includes it."
    ),
    "without_gaps": lambda changes, shorter: _gaps(changes, shorter, ", which is the unsafe side"),
    "without_gaps_safe": _gaps,
    "flat_patches": lambda share: (
        f"{in_percent(share)} of the patches of surface have too few summits to resist the adhesion. They count as "
        "flat surfaces in contact, which hold more than any rough ones: the prediction is on the safe side."
    ),
    "smooth_pair": _smooth_pair,
    "unknown_full_contact": lambda humidities: (
        f"Full elastic contact does not settle, or takes too long, {airs(humidities)}. Forces then rest on summits: on "
        f"rough surfaces they are too large, on smooth ones with gentle slopes too small, by up to "
        f"{in_percent(largest_shortfall())}."
    ),
    "few_strips": lambda part: (
        f"One strip of surface makes {in_percent(part)} of the squared error of full elastic contact. Others like it "
        "can be missing, so that the change and its error are themselves hardly known."
    ),
    # Water
    "thin_film": lambda film: (
        f"The film of water is {TO_NM * film:.2g} nm high, thinner than {MOLECULES} molecules, "
        f"{MOLECULES * TO_NM * WATER_MOLECULE:.3g} nm: the air is too dry for the theory of a liquid, and this result "
        "can be off to either side. Results for dry air and for the next humidity above do not bound it."
    ),
    "solid_film": lambda film: (
        f"The film of water is {TO_NM * film:.2g} nm high, thinner than {LIQUID} molecules, which are no liquid. The "
        "answer is the worst of three airs: this one as if it had a liquid, the driest with a liquid film, and dry air."
    ),
    "beyond_isotherm": lambda measured, wettest: (
        f"Air at RH {wettest:g} is wetter than the wettest of the isotherm, RH {measured:g}. Films grow there and "
        "count as constant: this is the unsafe side. State water.isotherm up to this humidity."
    ),
    "condensing": _condensing,
    "supercooled": _supercooled,
    "no_water": lambda: (
        "No water condenses between the surfaces, because the cosines of their contact angles add up to zero or less: "
        "results at any humidity are those for dry air."
    ),
    "wide_meniscus": lambda film, share: (
        f"The film of water is up to {TO_UM * film:.3g} µm high, not small against the area in contact: the surface "
        f"tension along its rim, which is left out, adds up to {100 * share:.3g} % of the force of the film, more than "
        f"{100 * RIM:.0f} %. Stoppers may hold more than computed, which is the unsafe side."
    ),
    "filled_gap": _filled_gap,
    # Beams
    "large_rotation": _large_rotation,
    "stubby_beam": lambda crack_length, ratio, shorter: (
        f"A crack of {TO_UM * crack_length:.0f} µm is only {ratio:.3g} times as long as the beam is thick, less than "
        f"{SLENDER:.0f}: shear and the compliance of the clamp, which are not in the model, shorten it by about "
        f"{in_percent(shorter)}."
    ),
    "wide_beam": lambda crack_length, ratio: (
        f"At a length of {TO_UM * crack_length:.0f} µm, 6 h w² / (t l²) is {ratio:.3g}, above {PLATE:.0f}: the beam "
        "bends as a plate, with the modulus E / (1 - ν²)."
    ),
    "stretched_bridge": _stretched_bridge,
    # Surfaces
    **dict.fromkeys(SIDES, lambda surface, flag: f"surface {surface}: {flag}"),
    "assumed_surface": _assumed_surface,
    "assumed_without_scatter": _assumed_without_scatter,
    "unlike_typical": _unlike_typical,
    # Test beams
    "test_beams_contradict": lambda p_value: (
        "Neither the errors of the inputs nor those of the model, as stated, explain the test beams (p = "
        f"{p_value:.1g}): something else is wrong, such as a dimension, a humidity or plastic contact. "
        "Until it is found, rely neither on the update nor on what is stated without it."
    ),
    "model_explains_test_beams": lambda p_value, factor, slope: (
        f"The errors of the inputs, as stated, do not explain the test beams (p = {p_value:.1g}); an error of "
        f"the model does: lengths are {factor:.3g} times as large as computed, with a slope of "
        f"{slope:+.2g} in the logarithm of the length."
    ),
    "cracks_beyond_test_beams": lambda datum, computed, beam_length: (
        f"{datum}: computed cracks of {TO_UM * computed:.0f} µm are longer than the beams, "
        f"{TO_UM * beam_length:.0f} µm: mean lengths of the beams that stick are too short."
    ),
    "moved_input": lambda name, score: (
        f"The test beams move the {name} by {score:+.2g} of its standard uncertainties: check it."
    ),
    "left_to_the_model": lambda datum, rest: (
        f"{datum}: {100 * rest:+.2g} % of the length are left to errors of the model at this humidity alone."
    ),
    "nonlinear_update": _nonlinear_update,
    "beyond_humidities_of_test_beams": _beyond_humidities_of_test_beams,
    "beyond_sizes_of_test_beams": lambda size, device, nearest, factor: (
        f"The {size} of the device, {TO_UM * device:.3g} µm, differs by more than a factor of {factor:g} from "
        f"that of the test beams, {TO_UM * nearest:.3g} µm: the prediction is an extrapolation."
    ),
    "beyond_adhesion_of_test_beams": _beyond_adhesion_of_test_beams,
}


# What is in no result


#: Effects that settings leave out, by their keys of `stiction.plan.environment.Environment.not_modelled`. Errors of
#: contact on summits: in humid air, full contact of two strips each of 1.0 and 1.7 nm rms at RH 0.45 and 0.65 has 1.05
#: to 1.16 times their energy; at higher rms it has less. In dry air, from six strips of each pair of the paper
#: (docs/tables/deformed.md) and five of the coated pair of examples/sealed.yaml: on the first strip of the smoothest
#: pair there, e is 7.26 in place of 2.36 mJ/m², f_max 5.70 in place of 1.61 MPa.
_LEFT_OUT = {
    "gaps": "attraction of solids across gaps",
    "van_der_waals": "van der Waals attraction of solids",
    "summits": "interaction of neighbouring summits (in humid air, on surfaces of 0.5 to 1.7 nm rms, lengths come out "
    f"up to 4 % too long and forces, up to RH 0.97, up to {in_percent(largest_shortfall())} too small)",
    "bent": "in dry air the bending of surfaces towards each other (on surfaces like those of the paper lengths come "
    "out 1 to 8 % too long and forces 10 to 40 % too small; on a strip of 1.6 nm rms, lengths were a third too long "
    "and the force 3.5 times too small; without contact.model summits it is included)",
}


#: What is not known of how both surfaces lie on each other, if the underside is stated to copy the ground and if not.
#: Energies are of strips 10 and 30 µm wide, as in tests/stages/contact/test_replicas.py.
_COPIES = {
    True: "movement of a beam in its plane beyond the stated play (in register it sticks most; how often, in register "
    "and at other offsets, is stated for cantilevers along their length alone, not for tips, bridges and stoppers)",
    False: "conformal films, which correlate both surfaces (between two Gaussian surfaces like B2 in humid air, a "
    "coherence of 0.9 raises the energy 100 to 450 times; key replica of the pair states it)",
}


def not_modelled(
    left_out: Sequence[str] = (), humid: bool = True, pairs: Sequence[str] = (), copied: bool = False
) -> str:
    """Effects relevant to stiction but not in the model: at no settings, or left out by the present ones.

    Attraction across gaps is left out for some pairs, or, if these are empty, for all. Undersides are ``copied`` if all
    pairs state it.
    """
    of_some = {"gaps": f" (pairs {', '.join(pairs)})"} if pairs else {}
    named = [_LEFT_OUT[key] + of_some.get(key, "") for key in left_out]
    time = ["the time that water needs to condense and to evaporate"] * humid
    never = [
        "residues of drying",
        *time,
        "drift of electric charge",
        "wear",
        _COPIES[copied],
    ]
    sentence = f"Not in the model: {', '.join([*named, *never])}, and curl by a stress gradient."
    fast = " If surfaces separate faster than water evaporates, they hold more than computed: this is the unsafe side."
    return sentence + fast * humid


# Lists

#: Kinds of limits that share a line of a list, by the number that is worst.
_WORST = {"large_rotation": "slope"}
#: Milder limits of such a line in words.
_ALSO = {
    "large_rotation": lambda crack_length, slope: (
        f"At {bounding(TO_UM * crack_length, 3, up=False)} µm (the device itself) the slope is {slope:.3g}."
    ),
}


def line_of(limit: Limit) -> Any:
    """Key that limits of one line of a list share: many steep lengths have one line, on the steepest."""
    return limit.kind if limit.kind in _WORST else limit


def worst(limits: Sequence[Limit]) -> Limit:
    """Worst of the limits of one line."""
    return max(limits, key=lambda limit: limit.numbers[_WORST[limit.kind]]) if len(limits) > 1 else limits[0]


def distinct(limits: Mapping[Any, Iterable[Limit]]) -> list[Limit]:
    """Different limits of all subjects in their order."""
    return list(dict.fromkeys(limit for of_subject in limits.values() for limit in of_subject))


def numbered(limits: Mapping[Any, Iterable[Limit]]) -> dict[Any, list[int]]:
    """Numbers, from 1, of the limits of each subject among the `distinct` ones."""
    numbers = {limit: number for number, limit in enumerate(distinct(limits), 1)}
    return {subject: [numbers[limit] for limit in of_subject] for subject, of_subject in limits.items()}


def with_numbers(limits: Mapping[Any, Iterable[Limit]]) -> list[str]:
    """Sentences on the different limits, each after its number."""
    return [f"({k}) {sentence}" for k, sentence in enumerate(texts(distinct(limits)), 1)]


def lines_with_numbers(
    limits: Mapping[Any, Iterable[Limit]], others: Iterable[Limit] = (), subjects: Mapping[Limit, str] | None = None
) -> list[str]:
    """Sentences on the worst limit of each line, after the numbers of all of its limits.

    ``others`` have no number, because no table has their size: a line that they share names it. Limits of another
    device than that of the page have their ``subjects`` in words.
    """
    numbers, lines = {limit: f"({k})" for k, limit in enumerate(distinct(limits), 1)}, {}
    for limit in dict.fromkeys([*numbers, *others]):
        lines.setdefault(line_of(limit), []).append(limit)
    return [_line(line, numbers, subjects or {}) for line in lines.values()]


def _line(line, numbers, subjects):
    """Limits of a line in words, with the numbers and subjects of those that have one."""
    shown, marks = worst(line), [numbers[limit] for limit in line if limit in numbers]
    subject = [f"{subjects[shown]}:"] if shown in subjects else []
    parts = [*([listed(marks)] if marks else []), *subject, text(shown)]
    parts += [f"This is the worst of {len(line)}."] * (len(line) > 1)
    parts += [_ALSO[limit.kind](**limit.numbers) for limit in line if limit not in numbers and limit != shown]
    return " ".join(parts)
