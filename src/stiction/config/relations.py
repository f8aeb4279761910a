"""Relations between the keys of a configuration.

The schema bounds every key on its own. Every condition between keys is one of the generators below, which yields a
problem for each entry that violates it; the message is the end of a sentence about the offending key. Values keep the
units of their keys.
"""

import functools
import itertools
import math
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import yaml
from scipy.special import ndtri

from stiction.beam.foundation import STRIP, decay_length, ground_stiffness
from stiction.config import memory
from stiction.config.cases import NAMEABLE, decimals
from stiction.config.conditions import Keys, Relations
from stiction.config.messages import did_you_mean, duplicates, shown
from stiction.config.units import MB_PER_GB, NM_PER_UM, from_si, in_si, to_si
from stiction.contact.bounds import least_law
from stiction.contact.estimate import ProfileMoments, force_law, repulsion_and_attraction
from stiction.contact.meniscus import dry_air, film, meniscus_height
from stiction.contact.solids import Solid, asperity_between
from stiction.devices import limits
from stiction.devices.materials import COATING
from stiction.errors import NotConverged
from stiction.models import SIDES
from stiction.numbers import is_multiple
from stiction.surface import maxent
from stiction.surface.empirical import MeasuredDensity
from stiction.surface.feasible import nearest_feasible
from stiction.surface.identify import SummitTarget, estimated_spectrum
from stiction.surface.spectrum import CutoffSelfAffine, correlation_length

#: Normal scores of equally probable heights; score that one of 10 strips with 450 000 points each exceeds.
_SCORES, _HIGHEST = ndtri((np.arange(200) + 0.5) / 200), 5.0


@functools.cache
def schema() -> dict:
    """JSON schema of the configuration: ``schema.yaml`` next to this module."""
    text = Path(__file__).with_name("schema.yaml").read_text(encoding="utf-8")
    return yaml.load(text, getattr(yaml, "CSafeLoader", yaml.SafeLoader))  # in C where PyYAML was built with it


#: Relations between the keys of surfaces, pairs and the sizes of computations.
relation = Relations()


@relation
def lists_have_no_duplicates(config):
    """A pair or a study runs once, a scan counts once, and a share has one safe length."""
    scans = [f"surfaces.{name}.scans.files" for name, _ in config.entries("surfaces", "scans.files")]
    for key, values in config.known("design.shares", *scans, "run.studies", "run.pairs"):
        if repeated := duplicates(values):
            yield key, f"must list each value once; {shown(repeated[0])} is listed twice"


@relation
def something_is_computed(config):
    """A run without pairs computes devices or evaluates scans."""
    names, devices, surfaces = config["run.pairs"], config["devices"], config["surfaces"]
    if not (names or devices or any("scans" in surface for surface in surfaces.values())):
        yield "run.pairs", "must name a pair: there are neither devices nor scans"


@relation
def selected_pairs_exist(config):
    """Only defined pairs can run."""
    pairs = config.names("pairs")
    for key, names in config.known("studies.plasticity.distance_nm", "run.pairs"):
        if strange := [name for name in names if name not in pairs]:
            yield key, f"{undefined(strange[0], pairs)}; {shown(strange[0])} is not"


@relation
def pair_of_the_figures_is_defined(config):
    """References must be to defined names."""
    yield "figures.pair", undefined(config["figures.pair"], config.names("pairs"))


@relation
def surfaces_of_pairs_are_defined(config):
    """As above, for both sides of every pair."""
    for side in reversed(SIDES):
        yield from references_are_defined(config, "pairs", side, "surfaces")


def references_are_defined(config: Keys, section: str, key: str, to: str) -> Iterator[tuple]:
    """Refusals of a key in every entry of a section that is to name an entry of another one."""
    defined = config.names(to)
    for name, reference in config.entries(section, key):
        yield f"{section}.{name}.{key}", undefined(reference, defined)


def undefined(name: str, defined: Iterable[str]) -> str | None:
    """Refusal of a name that is not defined."""
    return None if name in defined else f"must be one of {', '.join(defined)}{did_you_mean(name, defined)}"


@relation
def materials_are_defined(config):
    """Materials are defined in a section of their own, which the paper does not have."""
    none = "must be the name of a section of materials, where no material is described"
    for key, refusal in references_are_defined(config, "surfaces", "material", "materials"):
        yield key, refusal if config.names("materials") else none


@relation
def cases_have_unique_names(config, section="pairs"):
    """Each humidity of a pair has a unique name."""
    for name, humidities in config.entries(section, "humidities"):
        yield f"{section}.{name}.humidities", without_unique_names(humidities)


def without_unique_names(humidities: list[float]) -> str | None:
    """Refusal of humidities whose cases have no name, or the same."""
    nameless = [humidity for humidity in humidities if not decimals(humidity)]
    if nameless:
        return f"must each {NAMEABLE}; {nameless[0]} has more"
    repeated = duplicates(humidities)
    return f"must list each humidity once; {repeated[0]} is listed twice" if repeated else None


@relation
def humidity_of_the_figures_has_a_name(config):
    """The humidity of the figures must be valid in the name of a case."""
    if not decimals(config["figures.humidity"]):
        yield "figures.humidity", f"must {NAMEABLE}"


#: Keys of a surface that is described by numbers.
_NUMBERS = ("rms_nm", "skewness", "kurtosis", "mean_summit_radius_um", "summit_density_per_um2", "published_psd")


@relation
def scans_stand_alone(config):
    """A surface is described either by scans or by numbers."""
    for name, _ in config.entries("surfaces", "scans"):
        if beside := [key for key in config.names(f"surfaces.{name}") if key in _NUMBERS]:
            message = f"must not be given beside {', '.join(beside)}; give the measured surface a name of its own"
            yield f"surfaces.{name}.scans", message


@relation
def spectra_suit_their_surfaces(config):
    """Scans give a spectrum themselves."""
    for name, psd in config.entries("surfaces", "psd"):
        keys = config.names(f"surfaces.{name}")
        if "scans" not in keys:
            which, sources = "without", ("published", "identified")
        elif not any(key in _NUMBERS for key in keys):  # otherwise the relation above reports this
            which, sources = "with", ("fitted", "tabulated")
        else:
            continue
        if psd not in sources:
            yield f"surfaces.{name}.psd", f"must be {' or '.join(sources)} for a surface {which} scans"


@relation
def only_scans_leave_a_choice(config):
    """Other surfaces have the heights of their moments and a spectrum with a cut-off."""
    for choice in ("beyond", "heights"):
        for name, _ in config.entries("surfaces", choice):
            if "scans" not in config.names(f"surfaces.{name}"):
                yield f"surfaces.{name}.{choice}", "must not be given for a surface without scans"


@relation
def heights_have_a_density(config):
    """A density has these moments, and a maximum-entropy density of Eq. (3) these or moments near them."""
    for name, kurtosis, skewness in config.entries("surfaces", "kurtosis", "skewness"):
        yield f"surfaces.{name}.kurtosis", without_density(skewness, kurtosis), f"surfaces.{name}.skewness"


def without_density(skewness: float, kurtosis: float) -> str | None:
    """Refusal of the kurtosis of heights that have no such density."""
    if kurtosis <= skewness**2 + 1:
        return f"must be above skewness² + 1 = {skewness**2 + 1:.6g}"
    try:
        nearest_feasible(skewness, kurtosis)
    except (ValueError, NotConverged) as reason:
        return f"must be near that of a maximum-entropy density of the heights: {reason}"
    return None


#: Key of a surface: largest wave number of its roughness.
_CUTOFF = "published_psd.cutoff_rad_per_um"


@relation
def spectra_fall(config):
    """Roughness decays between the corner and the cut-off with a negative exponent, Eq. (7)."""
    corner, floor, plateau = (f"published_psd.{key}" for key in ("corner_rad_per_um", "floor_nm4", "plateau_nm4"))
    for low, high, words in ((corner, _CUTOFF, "cut-off"), (floor, plateau, "plateau")):
        for name, value, bound in config.entries("surfaces", low, high):
            if value >= bound:
                yield f"surfaces.{name}.{low}", f"must be below the {words}", f"surfaces.{name}.{high}"


@relation
def grid_carries_the_roughness(config):
    """The cut-off lies within the Nyquist wave number of the grid."""
    nyquist = math.pi / config["sampling.spacing_nm"] * NM_PER_UM
    message = f"must be at most the Nyquist wave number of the grid, {nyquist:.6g} rad/µm"
    for name, cutoff in config.entries("surfaces", _CUTOFF):
        if cutoff > nyquist:
            yield f"surfaces.{name}.{_CUTOFF}", message, "sampling.spacing_nm"


@relation
def other_grids_carry_the_roughness(config):
    """The cut-off lies within the Nyquist wave number of the grid of a variant."""
    for key, spacing in config.items("studies.variants.spacing_nm"):
        for name, cutoff in config.entries("surfaces", _CUTOFF):
            largest = math.pi / cutoff * NM_PER_UM
            if spacing > largest:
                message = f"must be at most {largest:.6g} nm, for the Nyquist wave number of the grid"
                yield key, message, f"surfaces.{name}.{_CUTOFF}"


@relation
def other_grids_carry_an_identified_spectrum(config):
    """The cut-off of an identified spectrum is the Nyquist wave number of the grid of Table I."""
    for key, spacing in config.items("studies.variants.spacing_nm"):
        for name, psd in config.entries("surfaces", "psd"):
            if spacing > config["character.spacing_nm"] and psd != "published":
                yield key, "must be at most that of Table I", "character.spacing_nm", f"surfaces.{name}.psd"


@relation
def lengths_exceed_the_correlation(config):
    """Strips are samples of the field, and opposite edges of a strip, or of a patch to identify, are uncorrelated."""
    strips = dict.fromkeys(("sampling.margin_um", "sampling.strip_length_um"), ("published_psd",))
    lengths = strips | {"identification.patch_um": ("published_psd", "summit_density_per_um2")}
    for key, length in config.known(*lengths):
        for name, psd, *_ in config.entries("surfaces", *lengths[key]):
            yield key, correlated(length, psd), *(f"surfaces.{name}.{stated}" for stated in lengths[key])


def correlated(length: float, psd: dict) -> str | None:
    """Refusal of a length [µm] within the correlation length of a published spectrum."""
    try:
        bound = _correlation_length(**psd)
    except ValueError:
        return None  # no spectrum or no decaying spectrum, which other relations report
    return None if length > bound else f"must be above the correlation length of the surface, {bound:.3g} µm"


@functools.cache
def _correlation_length(**psd):
    """Correlation length of a published spectrum [µm]."""
    return from_si(correlation_length(in_si(CutoffSelfAffine, psd)), "um")


@relation
def lengths_can_exceed_the_correlation(config):
    """As above for identified spectra, as far as it is known before; the jobs check the identified spectrum itself."""
    keys = "psd", "rms_nm", "mean_summit_radius_um", "summit_density_per_um2"
    spacing = config["character.spacing_nm"]
    for key, length in config.known("sampling.margin_um", "sampling.strip_length_um", "identification.patch_um"):
        for name, psd, *summits in config.entries("surfaces", *keys):
            if psd == "identified" and (refusal := correlated_as_estimated(length, *summits, spacing)):
                given = [f"surfaces.{name}.{stated}" for stated in keys]
                yield key, refusal, *given, "character.spacing_nm"


#: The correlation length estimated from summits exceeds that of the identified spectrum by this factor at most.
_AT_MOST = 1.5


def correlated_as_estimated(length: float, rms: float, radius: float, density: float, spacing: float) -> str | None:
    """Refusal of a length within the correlation length that the targets of an identification suggest."""
    try:
        with np.errstate(all="ignore"):
            bound = _estimated_correlation_length(rms, radius, density, spacing)
    except (ValueError, ArithmeticError):
        return None  # targets that no spectrum has, which the identification reports
    if not length * _AT_MOST < bound:
        return None
    return f"must be above the correlation length of the surface, estimated as {bound:.2g} µm from its summits"


@functools.lru_cache(maxsize=1000)
def _estimated_correlation_length(rms, radius, density, spacing):
    """Correlation length of the spectrum from which an identification starts [µm]."""
    summits = to_si(radius, "um"), to_si(density, "per_um2"), to_si(spacing, "nm")
    target = SummitTarget(np.float64(to_si(rms, "nm")), *summits)
    return from_si(correlation_length(estimated_spectrum(target)), "um")


@relation
def strips_are_whole_on_the_grid(config):
    """Both sides of a strip are multiples of the distance between contact points."""
    grid = "sampling.spacing_nm", "contact.every"
    for key, side in config.known("beam.width_um", "sampling.strip_length_um"):
        yield key, off_grid(side, *(config[step] for step in grid)), *grid


def off_grid(side: float, spacing: float, every: int) -> str | None:
    """Refusal of a side [µm] that is no multiple of the distance between contact points."""
    step = spacing * every
    whole = is_multiple(side * NM_PER_UM, step)
    return None if whole else f"must be a whole number of contact points {step:g} nm apart"


@relation
def strips_are_whole_under_a_variant(config):
    """As above, for the step in grid points times the grid spacing, either of which a variant may change."""
    sides = "sampling.strip_length_um", "beam.width_um"
    variants = {"sampling.spacing_nm": "studies.variants.every", "contact.every": "studies.variants.spacing_nm"}
    for other, step in config.known(*variants):
        for key, changed in config.items(variants[other]):
            if any(off_grid(config[side], changed, step) for side in sides):
                yield key, "must divide both sides of a strip into whole contact points", other, *sides


@relation
def patches_are_whole_on_the_grid(config):
    """The side of a patch is a multiple of the grid spacing."""
    spacing = config["sampling.spacing_nm"]
    if not is_multiple(config["identification.patch_um"] * NM_PER_UM, spacing):
        message = f"must be a whole number of grid spacings of {spacing} nm"
        yield "identification.patch_um", message, "sampling.spacing_nm"


@relation
def summits_are_sought_on_the_grid(config):
    """Table I is sampled at every n-th height of the grid."""
    spacing = config["sampling.spacing_nm"]
    if not is_multiple(config["character.spacing_nm"], spacing):
        message = f"must be a multiple of the grid spacing of {spacing} nm"
        yield "character.spacing_nm", message, "sampling.spacing_nm"


@relation
def strips_can_hold_a_summit(config):
    """A summit has eight neighbours."""
    coarse = config["character.spacing_nm"]
    for key, side in config.known("beam.width_um", "sampling.strip_length_um", "identification.patch_um"):
        if 3 * coarse > side * NM_PER_UM:
            yield "character.spacing_nm", f"must be at most a third of a side of {side} µm", key


@relation
def chunks_are_not_empty(config):
    """Every chunk contains at least one sample."""
    if config["contact.chunks"] > config["contact.samples"]:
        yield "contact.chunks", "must be at most the number of samples", "contact.samples"


@relation
def samples_carry_the_chaos(config):
    """There are no more polynomials in four variables, App. B, than samples to fit them; stoppers need no model."""
    order, samples, pairs = config["chaos.order"], config["contact.samples"], config["run"]["pairs"]
    kinds = {device["kind"] for device in config["devices"].values()}
    carried = next(n for n in itertools.count(order, -1) if math.comb(n + 4, 4) <= samples)
    if order > carried and (pairs or kinds - {"stopper"}):
        hint = (
            "; run: {pairs: []} computes the stoppers alone, which need no chaos model" if kinds == {"stopper"} else ""
        )
        message = f"must be at most {carried}, or {math.comb(order + 4, 4)} samples are needed{hint}"
        yield "chaos.order", message, "contact.samples"


@relation
def strips_fill_the_elements(config):
    """Every element contains the same whole number of strips, its integration points (Fig. 6)."""
    given = "sampling.strip_length_um", "beam.elements"
    least = config[given[0]] * config[given[1]]
    if not is_multiple(config["beam.length_um"], least):
        message = f"must be a multiple of strip_length x elements = {least:.6g} µm: whole strips on each element"
        yield "beam.length_um", message, *given


@relation
def strips_fill_finer_elements(config):
    """As above, for a variant; at least two elements."""
    given = "beam.length_um", "sampling.strip_length_um"
    length, strip = (config[key] for key in given)
    for key, strips in config.items("studies.variants.strips_per_element"):
        if not (is_multiple(length, strip * strips) and length > 1.5 * strip * strips):
            message = "must divide the strips along the beam into whole elements, at least two"
            yield key, message, *given


@relation
def a_mesh_is_whole(config):
    """At least one mesh of Figure 19 is possible; lengths that do not fill each other and the beam are left out."""
    key, *given = "studies.mesh.elements_um", "studies.mesh.strips_um", "beam.length_um"
    elements, strips, length = (config[each] for each in (key, *given))
    fitting = (is_multiple(length, element) and is_multiple(element, strip) for element in elements for strip in strips)
    if "mesh" in config["run"].get("studies", ["mesh"]) and not any(fitting):
        yield key, "must include a divisor of the beam that is a multiple of one of the strips", *given


class Meeting(NamedTuple):
    """Two surfaces that meet, on which the water between them depends."""

    sides: list[dict]  #: sections of both surfaces; empty if one is not defined or has no numbers (yet)
    materials: dict
    temperature: float  #: [K]


def _running(config, *keys):
    """Pairs that run: the name, what meets, values of some keys, and the keys that say what meets."""
    running, surfaces, materials = config["run.pairs"], config["surfaces"], config["materials"]
    for pair, beam, substrate, *values in config.entries("pairs", *SIDES, *keys):
        if pair in running:
            given = "run.pairs", "water.temperature_K", *(f"pairs.{pair}.{side}" for side in SIDES)
            meeting = Meeting(sides_of(beam, substrate, surfaces), materials, config["water.temperature_K"])
            yield pair, meeting, *values, (*given, *config.scanned(beam, substrate))


@relation
def beams_are_apart_from_the_film(config):
    """Along most of a crack, the beam of a pair that runs is far from the water film and the peaks of the substrate."""
    for air in ("figures.humidity", "pairs.{}.humidities"):
        for pair, meeting, gap, given in _running(config, "gap_um"):
            for key, humidities in config.known(air.format(pair)):
                yield f"pairs.{pair}.gap_um", not_apart(gap, humidities, meeting), key, *given


def not_apart(gap: float, humidities: float | list, meeting: Meeting) -> str | None:
    """Refusal of a gap [µm] that is not far above the film at the highest humidity."""
    angles = wetting(meeting.sides, meeting.materials)
    if not angles:
        return None
    height = float(np.max(meniscus_height(humidities, meeting.temperature, angles)))
    rms = math.hypot(*(to_si(side["rms_nm"], "nm") for side in meeting.sides))
    least = from_si(limits.least_gap(height, rms), "um")
    if gap >= least:
        return None
    return (
        f"must be at least {least:.4g} µm, {limits.FILMS} times the sum of the height of the water film, "
        f"{from_si(height, 'nm'):.5g} nm, and the rms of the surfaces, {from_si(rms, 'nm'):.3g} nm"
    )


@relation
def coatings_leave_a_gap(config):
    """Both coatings together are thinner than the gap."""
    for pair, gap, *names in config.entries("pairs", "gap_um", *SIDES):
        given = *(f"pairs.{pair}.{side}" for side in SIDES), *config.scanned(*names)
        yield f"pairs.{pair}.gap_um", filled(gap, names, config), *given


def filled(gap: float, names: list[str | None], config: Keys) -> str | None:
    """Refusal of a gap [µm] that the coatings of two surfaces, which need not be defined, fill."""
    both = of_material([config["surfaces"].get(name, {}) for name in names], config["materials"])
    coatings = sum(material.get(COATING, 0) for material in both)
    if gap * NM_PER_UM > coatings:
        return None
    return f"must be above the thickness of the coatings of both surfaces, {coatings:g} nm"


@relation
def water_is_a_liquid(config):
    """The air is not too dry for a film of liquid water between the surfaces of a pair that runs."""
    for pair, meeting, humidities, given in _running(config, "humidities"):
        yield f"pairs.{pair}.humidities", too_dry(humidities, meeting), *given


@relation
def water_of_the_figures_is_a_liquid(config):
    """As above, for the humidity at which all pairs that run are shown."""
    humidity, running = config["figures.humidity"], config["run.pairs"]
    refusals = (too_dry(humidity, meeting_of(pair, config)) for pair in running)
    yield "figures.humidity", next(filter(None, refusals), None), "run.pairs", "water.temperature_K"


def surfaces_of(pair: str, config: Keys) -> list[str | None]:
    """Names of the surfaces of a pair, which need not be defined."""
    return [config["pairs"].get(pair, {}).get(side) for side in SIDES]


def meeting_of(pair: str, config: Keys) -> Meeting:
    """What meets in a pair, which need not be defined."""
    sides = sides_of(*surfaces_of(pair, config), config["surfaces"])
    return Meeting(sides, config["materials"], config["water.temperature_K"])


def too_dry(humidities: float | list, meeting: Meeting, more: float = 0) -> str | None:
    """Refusal of the lowest humidity if the film between two surfaces is no liquid, contact angles as in `wetting`."""
    angles = wetting(meeting.sides, meeting.materials, more)
    return dry_air(float(np.min(humidities)), meeting.temperature, angles) if angles else None


#: What the strips of a pair depend on besides its humidities and surfaces.
_BEAM = "beam.thickness_um", "solid.young_modulus_GPa"


@relation
def strips_resolve_the_cracks(config):
    """Strips are short enough for the force laws of a pair that runs, as far as known without computing its contact.

    Strips that pass may still be refused after the contact, by `stiction.beam.resolution.resolved`.
    """
    for pair, meeting, humidities, given in _running(config, "humidities"):
        if refusal := _strips_too_long(config, pair, meeting, humidities):
            yield "sampling.strip_length_um", refusal, *_BEAM, f"pairs.{pair}.humidities", *given


@relation
def strips_resolve_the_cracks_of_the_figures(config):
    """As above, for the beams of the figures, whose humidity need not be one of their pair; one refusal is enough."""
    humidity, of_figures, running = config["figures.humidity"], config["figures.pair"], config["run.pairs"]
    shown_pair = of_figures if of_figures in running else next(iter(running), None)
    for pair, meeting, humidities, given in _running(config, "humidities"):
        own = _strips_too_long(config, pair, meeting, humidities)
        if pair == shown_pair and not own and (refusal := _strips_too_long(config, pair, meeting, [humidity])):
            stated = *_BEAM, "figures.humidity", f"pairs.{pair}.humidities", "figures.pair"
            yield "sampling.strip_length_um", refusal, *stated, *given


def _strips_too_long(config, pair, meeting, humidities):
    """Refusal of strips that do not resolve the cracks of a pair."""
    strip, thickness, modulus = config["sampling.strip_length_um"], *(config[key] for key in _BEAM)
    for stated in of_material(meeting.sides, meeting.materials)[:1]:
        modulus = stated.get("young_modulus_GPa", modulus)
    for humidity in humidities:
        longest = longest_strip(thickness, modulus, humidity, meeting.temperature, meeting.sides, meeting.materials)
        if strip > longest:
            return f"must be at most {longest:.3g} µm to resolve the cracks of pair {pair} at RH {humidity:g}"
    return None


def longest_strip(
    thickness: float, modulus: float, humidity: float, temperature: float, sides: list, materials: dict
) -> float:
    """Length that no strip may exceed on which a beam of this thickness [µm] and Young's modulus [GPa] is to stop [µm].

    It is infinite where nothing is known without the contact.
    """
    shapes, angles = _shapes(sides), wetting(sides, materials)
    if not angles or not shapes or dry_air(humidity, temperature, angles):
        return math.inf
    (beam, substrate), highest = zip(*shapes, strict=True)
    rms = np.array([to_si(side["rms_nm"], "nm") for side in sides])
    heights, top = np.add.outer(rms[0] * np.array(beam), rms[1] * np.array(substrate)), float(rms @ highest)
    bending = to_si(modulus, "GPa") * to_si(thickness, "um") ** 3 / 12
    f_max, a_left = least_law(heights, top, film(humidity, temperature, angles))
    if not f_max:
        return math.inf
    return from_si(STRIP * decay_length(bending, ground_stiffness(f_max, a_left)), "um")


#: ASSUME: estimated foundation lengths are at most this much too long; more often they are too short.
_ESTIMATED = 1.25


def estimated_strip(
    thickness: float, solid: dict, medium: str, humidity: float, temperature: float, sides: list, materials: dict
) -> float:
    """As `longest_strip`, from the estimated force law, which is far closer but no bound; section ``solid``."""
    shapes, angles = _shapes(sides), wetting(sides, materials)
    if not angles or not shapes or dry_air(humidity, temperature, angles):
        return math.inf
    bodies = [in_si(Solid, solid | stated) for stated in of_material(sides, materials)]
    summit, water = asperity_between(*bodies, medium), film(humidity, temperature, angles)
    try:
        stiffness = _estimated_stiffness(tuple(map(_summit_source, sides)), tuple(s for s, _ in shapes), summit, water)
    except (ValueError, ArithmeticError):
        return math.inf  # other relations report what is out of range
    bending = bodies[0].young_modulus * to_si(thickness, "um") ** 3 / 12
    return from_si(_ESTIMATED * STRIP * decay_length(bending, stiffness), "um")


@functools.lru_cache(maxsize=1000)
def _estimated_stiffness(sources, shapes, summit, water):
    """Estimated stiffness of the ground of a pair [Pa/m]."""
    rms = [to_si(source[0], "nm") for source in sources]
    heights = np.sort(np.add.outer(rms[0] * np.array(shapes[0]), rms[1] * np.array(shapes[1])).ravel())
    with np.errstate(all="raise", under="ignore"):
        surface = ProfileMoments.of_sum(map(_moments, sources))
        return ground_stiffness(*force_law(surface, summit, heights, water))


def sides_of(beam: str, substrate: str, surfaces: dict) -> list[dict]:
    """Sections of the surfaces of a pair; empty if one is not defined or has no numbers (yet)."""
    both = [surfaces.get(name, {}) for name in (beam, substrate)]
    return both if all("rms_nm" in surface and "scans" not in surface for surface in both) else []


def of_material(sides: list[dict], materials: dict) -> list[dict]:
    """Stated properties of the material of each surface; none of the solid of both bodies, or of an undefined one."""
    return [materials.get(side.get("material"), {}) for side in sides]


def wetting(sides: list[dict], materials: dict, more: float = 0) -> tuple[float, ...]:
    """Contact angles of two surfaces [rad]; empty without surfaces or without water, which other relations report.

    ``more`` degrees are added to both angles.
    """
    stated = (material.get("contact_angle_deg", 0) for material in of_material(sides, materials))
    angles = [to_si(angle + more, "deg") for angle in stated]
    return tuple(angles) if sum(map(math.cos, angles)) > 1e-9 else ()


def _shapes(sides):
    """Equally probable heights and the highest one of each side, in units of its rms; empty if one has no density."""
    found = [_shape(side.get("skewness"), side.get("kurtosis"), side.get("form")) for side in sides]
    return [] if None in found else found


@functools.cache
def _shape(skewness, kurtosis, form):
    """As `_shapes`, of moments or of the form of measured heights; ``None`` without a density, as above."""
    if form:
        density = MeasuredDensity(*map(np.array, form))
    elif skewness is None:  # of scans whose moments have no density, which is reported with their files
        return None
    else:
        try:
            moments = nearest_feasible(skewness, kurtosis)
        except (ValueError, NotConverged):
            return None
        density = maxent.solve(moments.skewness, moments.kurtosis)
    return tuple(density.quantile_of_normal(_SCORES)), float(density.quantile_of_normal(_HIGHEST))


@relation
def solids_attract_across_gaps(config):
    """Without van der Waals forces of the summits there are none across gaps."""
    if (config["attraction.reach"], config["van_der_waals"]) == ("all", "none"):
        yield "attraction.reach", "must be touching if van_der_waals is none", "van_der_waals"


@relation
def full_contact_has_no_attraction_across_gaps(config):
    """Corrections to full elastic contact are ratios without attraction across gaps."""
    if config["contact"].get("model") == "full":
        for key, reach in config.known("attraction.reach", "studies.variants.reach"):
            if "all" in reach:
                yield "contact.model", "must be summits where attraction reaches across all gaps", key


@relation
def water_wets_the_pairs(config):
    """Water condenses between two surfaces only if the cosines of their contact angles add up to more than zero."""
    surfaces, materials = config["surfaces"], config["materials"]
    for pair, *names in config.entries("pairs", *SIDES):
        sides = sides_of(*names, surfaces)
        if sides and not wetting(sides, materials):
            stated = " and ".join(f"{one.get('contact_angle_deg', 0):g}" for one in of_material(sides, materials))
            message = (
                f"must be of a material that water wets enough: contact angles of {stated} degrees on the two surfaces"
            )
            given = f"pairs.{pair}.substrate", *config.scanned(*names)
            yield f"pairs.{pair}.beam", message, *given


@relation
def beam_is_slender(config):
    """The beam is longer than it is wide, thick and deflected (Euler-Bernoulli)."""
    gaps = [f"pairs.{pair}.gap_um" for pair, _ in config.entries("pairs", "gap_um")]
    for key, size in config.known("beam.thickness_um", "beam.width_um", *gaps):
        if size >= config["beam.length_um"]:
            yield key, "must be below the length of the beam", "beam.length_um"


#: Least ratio of the estimated repulsion at zero distance to the estimated pull-off pressure. ASSUME: 3, because the
#: repulsion is estimated up to a factor of two too high, and the weakest sample must resist the strongest attraction.
_SAFE = 3


def _resist(repulsion, pull):
    """Whether summits resist the adhesion; an estimate without attraction is of surfaces that do not stick."""
    return repulsion > 0 and repulsion >= _SAFE * pull


@relation
def solids_resist_the_adhesion(config):
    """The force rises to the pull-off pressure on the grid of distances, which begins where mean planes meet."""
    given = "van_der_waals", "water.temperature_K", "figures.humidity"
    solid, pairs, (medium, _, humidity) = config["solid"], config["pairs"], (config[key] for key in given)
    for key, name in config.items("run.pairs"):
        if refusal := too_soft(
            meeting_of(name, config), solid, medium, [*pairs.get(name, {}).get("humidities", ()), humidity]
        ):
            yield key, refusal, *given, *config.scanned(*surfaces_of(name, config))


def too_soft(meeting: Meeting, solid: dict, medium: str, humidities: list[float]) -> str | None:
    """Refusal of surfaces and solids that do not resist the adhesion at all humidities."""
    both, materials, temperature = meeting
    if not both:
        return None  # other relations report this and the next
    spectra = [surface["published_psd"] for surface in both if surface["psd"] == "published"]
    if any(
        psd["floor_nm4"] >= psd["plateau_nm4"] or psd["corner_rad_per_um"] >= psd["cutoff_rad_per_um"]
        for psd in spectra
    ):
        return None
    humidities, angles = sorted({*humidities}), wetting(both, materials)
    if not angles or dry_air(humidities[0], temperature, angles):
        return None  # no water, which other relations report
    try:
        bodies = [in_si(Solid, solid | stated) for stated in of_material(both, materials)]
        films = tuple(film(humidity, temperature, angles) for humidity in humidities)
        forces = _estimated(tuple(map(_summit_source, both)), asperity_between(*bodies, medium), films)
    except (ValueError, ArithmeticError):
        return "must have surfaces and a solid for which the adhesion can be estimated; some value is far out of range"
    stuck = [(at, *force) for at, force in zip(humidities, forces, strict=True) if not _resist(*force)]
    if not stuck:
        return None
    humidity, repulsion, pull = stuck[0]
    pull, repulsion = (f"{from_si(pressure, 'MPa'):.3g} MPa" for pressure in (pull, max(repulsion, 0)))
    return (
        f"must have surfaces rough enough and a solid stiff enough for its humidities: at {humidity}"
        f"{' and others' if len(stuck) > 1 else ''}, water and van der Waals forces pull with an estimated {pull} and "
        f"the summits resist with {repulsion} where the mean planes meet, where {_SAFE} times the pull is needed; "
        "increase the roughness or young_modulus_GPa, or choose other humidities"
    )


#: Least expected number of summits on a patch. ASSUME: as many resist the adhesion of every sample. Measured on patches
#: of pair b that are 0.05 to 1.5 µm long: with 19 summits none of 5000 samples fails at RH 0.5 or more and 2 fail at RH
#: 0.3; with 10 there are 2 of 1000 samples, and with 4 there are 50. Pairs a and c need fewer.
_SUMMITS = 18


@relation
def strips_of_a_pair_hold_enough_summits(config):
    """Strips of a pair that runs hold so many summits that each sample resists the adhesion."""
    width, length = config["beam.width_um"], config["sampling.strip_length_um"]
    for key, pair in config.items("run.pairs"):
        names = surfaces_of(pair, config)
        if refusal := too_few_summits(length, width, pair, sides_of(*names, config["surfaces"])):
            given = "sampling.strip_length_um", key, *config.scanned(*names)
            yield "beam.width_um", refusal, *given


def too_few_summits(length: float, width: float, pair: str, sides: list[dict]) -> str | None:
    """Refusal of a patch [µm] that holds too few summits, as far as their density is known."""
    try:
        number = summit_density(sides) * length * width if sides else _SUMMITS
    except (ValueError, ArithmeticError):
        return None  # other relations report what is out of range
    if number >= _SUMMITS:
        return None
    return (
        f"must give patches of surface with at least {_SUMMITS} summits, so that every sample resists the adhesion: "
        f"{length:g} x {width:g} µm of pair {pair} hold about {number:.2g}"
    )


def summit_density(sides: list[dict]) -> float:
    """Estimated density of the summits of the sum of two surfaces, that of the rougher one [1/µm²].

    ASSUME: without a measured density it is half of that of the spectrum, because sampling leaves out fine summits; the
    spectra of the paper have 1.5 to 2 times the measured density.

    Raises
    ------
    ValueError or ArithmeticError
        If a number is far out of range.
    """
    rougher = max(sides, key=lambda side: side["rms_nm"])
    with np.errstate(all="raise", under="ignore"):
        stated = rougher.get("summit_density_per_um2")
        return float(stated or 0.5 * from_si(_moments(_summit_source(rougher)).summit_density, "per_um2"))


def _summit_source(surface):
    """What the estimate takes of a surface, hashable: rms and either Eq. (7) or the summits."""
    if surface["psd"] == "published":
        return surface["rms_nm"], tuple(surface["published_psd"].items())
    return surface["rms_nm"], (surface["mean_summit_radius_um"], surface["summit_density_per_um2"])


@functools.lru_cache(maxsize=1000)
def _estimated(sources, summit, films):
    """Estimated repulsion at zero distance and attraction of a pair with each film of water [Pa]."""
    with np.errstate(all="raise", under="ignore"):
        return repulsion_and_attraction(ProfileMoments.of_sum(map(_moments, sources)), summit, films)


def _moments(source):
    """Moments of the profile of one surface."""
    rms, given = np.float64(to_si(source[0], "nm")), source[1]
    if isinstance(given[0], tuple):
        return ProfileMoments.of_spectrum(rms, in_si(CutoffSelfAffine, dict(given)))
    radius, density = np.float64(to_si(given[0], "um")), np.float64(to_si(given[1], "per_um2"))
    return ProfileMoments.of_summits(rms, radius, density)


@relation
def strips_fit_into_memory(config):
    """The field from which a strip is cut fits into the memory of a job."""
    given = "sampling.strip_length_um", "sampling.margin_um", "beam.width_um"
    length, margin, width = (config[key] for key in given)
    grids = [key for key, _ in config.items("studies.variants.spacing_nm")]
    for key, spacing in config.known(*grids, "sampling.spacing_nm"):
        yield key, field_too_large(length + margin, width + margin, spacing), *given


@relation
def fields_fit_into_memory(config):
    """The fields on which spectra are estimated fit into the memory of a job."""
    yield "sampling.spacing_nm", field_too_large(memory.FIELD_UM, memory.FIELD_UM, config["sampling.spacing_nm"])


@relation
def patches_fit_into_memory(config):
    """A patch fits into the memory of a job."""
    side = config["identification.patch_um"]
    yield "identification.patch_um", field_too_large(side, side, config["sampling.spacing_nm"]), "sampling.spacing_nm"


def field_too_large(length: float, width: float, spacing: float) -> str | None:
    """Refusal of a field [µm, nm] whose memory exceeds that of the largest job; ``None`` if it does not."""
    needed = memory.of_field(length, width, spacing)
    if needed <= memory.LARGEST:
        return None
    return (
        f"must leave fields within {memory.LARGEST / MB_PER_GB:g} GB of memory: {length:g} x {width:g} µm every "
        f"{spacing:g} nm take {needed / MB_PER_GB:.3g} GB"
    )
