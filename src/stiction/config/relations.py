"""Relations between the keys of a configuration.

The schema bounds every key on its own. Conditions between keys are the relations below: functions of the values that
return ``None``, or the end of the error message about the offending key. Values keep the units of their keys.
"""

import functools
import itertools
import math
from pathlib import Path

import numpy as np
import yaml
from scipy.special import ndtri

from stiction.beam.foundation import STRIP, decay_length, ground_stiffness
from stiction.config import memory
from stiction.config.cases import NAMEABLE, decimals
from stiction.config.conditions import Relations
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
#: Keys of the targets of an identification.
_TARGET = (
    "surfaces.*.rms_nm",
    "surfaces.*.mean_summit_radius_um",
    "surfaces.*.summit_density_per_um2",
    "character.spacing_nm",
)


@relation("run.pairs")
@relation("run.studies")
@relation("surfaces.*.scans.files")
@relation("design.shares")
def list_has_no_duplicates(values):
    """A pair or a study runs once, a scan counts once, and a share has one safe length."""
    repeated = duplicates(values)
    return f"must list each value once; {shown(repeated[0])} is listed twice" if repeated else None


@relation("run.pairs", "devices", "surfaces")
def something_is_computed(names, devices, surfaces):
    """A run without pairs computes devices or evaluates scans."""
    scanned = any("scans" in surface for surface in surfaces.values())
    return None if names or devices or scanned else "must name a pair: there are neither devices nor scans"


@relation("run.pairs", "pairs.#")
@relation("studies.plasticity.distance_nm", "pairs.#")
def selected_pairs_exist(names, pairs):
    """Only defined pairs can run."""
    refusals = ((name, name_is_defined(name, pairs)) for name in names)
    return next((f"{message}; {shown(name)} is not" for name, message in refusals if message), None)


@relation("pairs.*.beam", "surfaces.#")
@relation("pairs.*.substrate", "surfaces.#")
@relation("figures.pair", "pairs.#")
def name_is_defined(name, defined):
    """References must be to defined names."""
    return None if name in defined else f"must be one of {', '.join(defined)}{did_you_mean(name, defined)}"


@relation("surfaces.*.material", "materials.#")
def material_is_defined(name, defined):
    """Materials are defined in a section of their own, which the paper does not have."""
    if not defined:
        return "must be the name of a section of materials, where no material is described"
    return name_is_defined(name, defined)


@relation("pairs.*.humidities")
def cases_have_unique_names(humidities):
    """Each humidity of a pair has a unique name."""
    nameless = [humidity for humidity in humidities if not decimals(humidity)]
    if nameless:
        return f"must each {NAMEABLE}; {nameless[0]} has more"
    repeated = duplicates(humidities)
    return f"must list each humidity once; {repeated[0]} is listed twice" if repeated else None


@relation("figures.humidity")
def humidity_of_the_figures_has_a_name(humidity):
    """The humidity of the figures must be valid in the name of a case."""
    return None if decimals(humidity) else f"must {NAMEABLE}"


#: Keys of a surface that is described by numbers.
_NUMBERS = ("rms_nm", "skewness", "kurtosis", "mean_summit_radius_um", "summit_density_per_um2", "published_psd")


@relation("surfaces.*.scans", "surfaces.*.#")
def scans_stand_alone(scans, keys):  # noqa: ARG001
    """A surface is described either by scans or by numbers."""
    beside = [key for key in keys if key in _NUMBERS]
    if not beside:
        return None
    return f"must not be given beside {', '.join(beside)}; give the measured surface a name of its own"


@relation("surfaces.*.psd", "surfaces.*.#")
def spectrum_suits_the_surface(psd, keys):
    """Scans give a spectrum themselves."""
    if "scans" in keys and any(key in _NUMBERS for key in keys):
        return None  # the relation above reports this
    which, sources = ("with", ("fitted", "tabulated")) if "scans" in keys else ("without", ("published", "identified"))
    return None if psd in sources else f"must be {' or '.join(sources)} for a surface {which} scans"


@relation("surfaces.*.heights", "surfaces.*.#")
@relation("surfaces.*.beyond", "surfaces.*.#")
def only_scans_leave_this_choice(choice, keys):  # noqa: ARG001
    """Other surfaces have the heights of their moments and a spectrum with a cut-off."""
    return None if "scans" in keys else "must not be given for a surface without scans"


@relation("surfaces.*.kurtosis", "surfaces.*.skewness")
def heights_have_a_density(kurtosis, skewness):
    """A density has these moments, and a maximum-entropy density of Eq. (3) these or moments near them."""
    if kurtosis <= skewness**2 + 1:
        return f"must be above skewness² + 1 = {skewness**2 + 1:.6g}"
    try:
        nearest_feasible(skewness, kurtosis)
    except (ValueError, NotConverged) as reason:
        return f"must be near that of a maximum-entropy density of the heights: {reason}"
    return None


@relation("surfaces.*.published_psd.corner_rad_per_um", "surfaces.*.published_psd.cutoff_rad_per_um")
def corner_lies_below_the_cutoff(corner, cutoff):
    """Roughness decays between the corner and the cut-off, Eq. (7)."""
    return None if corner < cutoff else "must be below the cut-off"


@relation("surfaces.*.published_psd.floor_nm4", "surfaces.*.published_psd.plateau_nm4")
def spectrum_falls(floor, plateau):
    """The exponent of the power law in Eq. (7) is negative."""
    return None if floor < plateau else "must be below the plateau"


@relation("surfaces.*.published_psd.cutoff_rad_per_um", "sampling.spacing_nm")
def grid_carries_the_roughness(cutoff, spacing):
    """The cut-off lies within the Nyquist wave number of the grid."""
    nyquist = math.pi / spacing * NM_PER_UM
    return None if cutoff <= nyquist else f"must be at most the Nyquist wave number of the grid, {nyquist:.6g} rad/µm"


@relation("studies.variants.spacing_nm.*", "surfaces.*.published_psd.cutoff_rad_per_um")
def other_grid_carries_the_roughness(spacing, cutoff):
    """The cut-off lies within the Nyquist wave number of the grid of a variant."""
    largest = math.pi / cutoff * NM_PER_UM
    return None if spacing <= largest else f"must be at most {largest:.6g} nm, for the Nyquist wave number of the grid"


@relation("studies.variants.spacing_nm.*", "character.spacing_nm", "surfaces.*.psd")
def other_grid_carries_an_identified_spectrum(spacing, coarse, psd):
    """The cut-off of an identified spectrum is the Nyquist wave number of the grid of Table I."""
    return None if spacing <= coarse or psd == "published" else "must be at most that of Table I"


@relation("identification.patch_um", "surfaces.*.published_psd", "surfaces.*.summit_density_per_um2")
@relation("sampling.strip_length_um", "surfaces.*.published_psd")
@relation("sampling.margin_um", "surfaces.*.published_psd")
def length_exceeds_the_correlation(length, psd, _=None):
    """Strips are samples of the field, and opposite edges of a strip, or of a patch to identify, are uncorrelated."""
    try:
        bound = _correlation_length(**psd)
    except ValueError:
        return None  # no spectrum or no decaying spectrum, which other relations report
    return None if length > bound else f"must be above the correlation length of the surface, {bound:.3g} µm"


#: The correlation length estimated from summits exceeds that of the identified spectrum by this factor at most.
_AT_MOST = 1.5


@relation("identification.patch_um", "surfaces.*.psd", *_TARGET)
@relation("sampling.strip_length_um", "surfaces.*.psd", *_TARGET)
@relation("sampling.margin_um", "surfaces.*.psd", *_TARGET)
def length_can_exceed_the_correlation(length, psd, *target):
    """As above for identified spectra, as far as it is known before; the jobs check the identified spectrum itself."""
    if psd != "identified":
        return None
    try:
        with np.errstate(all="ignore"):
            bound = _estimated_correlation_length(*target)
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


@functools.cache
def _correlation_length(**psd):
    """Correlation length of a published spectrum [µm]."""
    return from_si(correlation_length(in_si(CutoffSelfAffine, psd)), "um")


@relation("sampling.strip_length_um", "sampling.spacing_nm", "contact.every")
@relation("beam.width_um", "sampling.spacing_nm", "contact.every")
def strip_is_whole_on_the_grid(side, spacing, every):
    """Both sides of a strip are multiples of the distance between contact points."""
    step = spacing * every
    whole = is_multiple(side * NM_PER_UM, step)
    return None if whole else f"must be a whole number of contact points {step:g} nm apart"


@relation("studies.variants.spacing_nm.*", "contact.every", "sampling.strip_length_um", "beam.width_um")
@relation("studies.variants.every.*", "sampling.spacing_nm", "sampling.strip_length_um", "beam.width_um")
def strip_is_whole_under_a_variant(changed, other, *sides):
    """As above, for the step in grid points times the grid spacing, either of which a variant may change."""
    whole = all(is_multiple(side * NM_PER_UM, changed * other) for side in sides)
    return None if whole else "must divide both sides of a strip into whole contact points"


@relation("identification.patch_um", "sampling.spacing_nm")
def patch_is_whole_on_the_grid(side, spacing):
    """The side of a patch is a multiple of the grid spacing."""
    whole = is_multiple(side * NM_PER_UM, spacing)
    return None if whole else f"must be a whole number of grid spacings of {spacing} nm"


@relation("character.spacing_nm", "sampling.spacing_nm")
def summits_are_sought_on_the_grid(coarse, spacing):
    """Table I is sampled at every n-th height of the grid."""
    return None if is_multiple(coarse, spacing) else f"must be a multiple of the grid spacing of {spacing} nm"


@relation("character.spacing_nm", "identification.patch_um")
@relation("character.spacing_nm", "sampling.strip_length_um")
@relation("character.spacing_nm", "beam.width_um")
def strip_can_hold_a_summit(coarse, side):
    """A summit has eight neighbours."""
    return None if 3 * coarse <= side * NM_PER_UM else f"must be at most a third of a side of {side} µm"


@relation("contact.chunks", "contact.samples")
def chunks_are_not_empty(chunks, samples):
    """Every chunk contains at least one sample."""
    return None if chunks <= samples else "must be at most the number of samples"


@relation("chaos.order", "contact.samples", "run", "devices")
def samples_carry_the_chaos(order, samples, run, devices):
    """There are no more polynomials in four variables, App. B, than samples to fit them; stoppers need no model."""
    stoppers = {device["kind"] for device in devices.values()} == {"stopper"}
    carried = next(n for n in itertools.count(order, -1) if math.comb(n + 4, 4) <= samples)
    if order == carried or (not run["pairs"] and (stoppers or not devices)):
        return None
    hint = "; run: {pairs: []} computes the stoppers alone, which need no chaos model" if stoppers else ""
    return f"must be at most {carried}, or {math.comb(order + 4, 4)} samples are needed{hint}"


@relation("beam.length_um", "sampling.strip_length_um", "beam.elements")
def strips_fill_the_elements(length, strip, elements):
    """Every element contains the same whole number of strips, its integration points (Fig. 6)."""
    if is_multiple(length, strip * elements):
        return None
    return f"must be a multiple of strip_length x elements = {strip * elements:.6g} µm: whole strips on each element"


@relation("studies.variants.strips_per_element.*", "beam.length_um", "sampling.strip_length_um")
def strips_fill_finer_elements(strips, length, strip):
    """As above, for a variant; at least two elements."""
    if is_multiple(length, strip * strips) and length > 1.5 * strip * strips:
        return None
    return "must divide the strips along the beam into whole elements, at least two"


@relation("studies.mesh.elements_um", "studies.mesh.strips_um", "beam.length_um", "run")
def a_mesh_is_whole(elements, strips, length, run):
    """At least one mesh of Figure 19 is possible; lengths that do not fill each other and the beam are left out."""
    if "mesh" not in run.get("studies", ["mesh"]):
        return None
    fitting = (is_multiple(length, element) and is_multiple(element, strip) for element in elements for strip in strips)
    return None if any(fitting) else "must include a divisor of the beam that is a multiple of one of the strips"


#: Keys of a pair, of the water and of the surfaces that meet: the last arguments of the next two relations.
_MEETING = (
    "run.pairs",
    "pairs.*.@",
    "water.temperature_K",
    "pairs.*.beam",
    "pairs.*.substrate",
    "surfaces",
    "materials",
)


@relation("pairs.*.gap_um", "pairs.*.humidities", *_MEETING)
@relation("pairs.*.gap_um", "figures.humidity", *_MEETING)
def beam_is_apart_from_the_film(gap, humidities, running, pair, temperature, *meeting):
    """Along most of a crack, the beam of a pair that runs is far from the water film and the peaks of the substrate."""
    sides = sides_of(*meeting[:-1]) if pair in running else []
    return not_apart(gap, humidities, temperature, sides, meeting[-1])


def not_apart(gap: float, humidities: float | list, temperature: float, sides: list, materials: dict) -> str | None:
    """Refusal of a gap [µm] that is not far above the film at the highest humidity; sections of the two surfaces."""
    angles = wetting(sides, materials)
    if not angles:
        return None
    height = float(np.max(meniscus_height(humidities, temperature, angles)))
    rms = math.hypot(*(to_si(side["rms_nm"], "nm") for side in sides))
    least = from_si(limits.least_gap(height, rms), "um")
    if gap >= least:
        return None
    return (
        f"must be at least {least:.4g} µm, {limits.FILMS} times the sum of the height of the water film, "
        f"{from_si(height, 'nm'):.5g} nm, and the rms of the surfaces, {from_si(rms, 'nm'):.3g} nm"
    )


@relation("pairs.*.gap_um", "pairs.*.beam", "pairs.*.substrate", "surfaces", "materials")
def coatings_leave_a_gap(gap, beam, substrate, surfaces, materials):
    """Both coatings together are thinner than the gap."""
    both = of_material([surfaces.get(name, {}) for name in (beam, substrate)], materials)
    coatings = sum(material.get(COATING, 0) for material in both)
    if gap * NM_PER_UM > coatings:
        return None
    return f"must be above the thickness of the coatings of both surfaces, {coatings:g} nm"


@relation("pairs.*.humidities", *_MEETING)
def water_is_a_liquid(humidities, running, pair, temperature, *meeting):
    """The air is not too dry for a film of liquid water between the surfaces of a pair that runs."""
    return too_dry(humidities, temperature, sides_of(*meeting[:-1]) if pair in running else [], meeting[-1])


@relation("figures.humidity", "run.pairs", "pairs", "surfaces", "materials", "water.temperature_K")
def water_of_the_figures_is_a_liquid(humidity, running, pairs, surfaces, materials, temperature):
    """As above, for the humidity at which all pairs that run are shown."""
    meeting = [[pairs.get(name, {}).get(side) for side in SIDES] for name in running]
    refusals = (too_dry(humidity, temperature, sides_of(*names, surfaces), materials) for names in meeting)
    return next(filter(None, refusals), None)


def too_dry(humidities: float | list, temperature: float, sides: list, materials: dict, more: float = 0) -> str | None:
    """Refusal of the lowest humidity if the film between two surfaces is no liquid, contact angles as in `wetting`."""
    angles = wetting(sides, materials, more)
    return dry_air(float(np.min(humidities)), temperature, angles) if angles else None


@relation("sampling.strip_length_um", "beam.thickness_um", "solid.young_modulus_GPa", "pairs.*.humidities", *_MEETING)
def strips_resolve_the_crack(strip, thickness, modulus, humidities, running, pair, temperature, *meeting):
    """Strips are short enough for the force laws of a pair that runs, as far as known without computing its contact.

    Strips that pass may still be refused after the contact, by `stiction.beam.resolution.resolved`.
    """
    sides = sides_of(*meeting[:-1]) if pair in running else []
    stated = of_material(sides, meeting[-1])
    modulus = stated[0].get("young_modulus_GPa", modulus) if stated else modulus
    for humidity in humidities:
        longest = longest_strip(thickness, modulus, humidity, temperature, sides, meeting[-1])
        if strip > longest:
            return f"must be at most {longest:.3g} µm to resolve the cracks of pair {pair} at RH {humidity:g}"
    return None


@relation(
    "sampling.strip_length_um",
    "beam.thickness_um",
    "solid.young_modulus_GPa",
    "figures.humidity",
    "pairs.*.humidities",
    "figures.pair",
    *_MEETING,
)
def strips_resolve_the_crack_of_the_figures(
    strip, thickness, modulus, shown, humidities, of_figures, running, pair, *meeting
):
    """As above, for the beams of the figures, whose humidity need not be one of their pair."""
    if pair != (of_figures if of_figures in running else next(iter(running), None)):
        return None
    own, of_shown = (
        strips_resolve_the_crack(strip, thickness, modulus, each, running, pair, *meeting)
        for each in (humidities, [shown])
    )
    return None if own else of_shown  # one refusal is enough


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


@relation("attraction.reach", "van_der_waals")
def solids_attract_across_gaps(reach, medium):
    """Without van der Waals forces of the summits there are none across gaps."""
    return "must be touching if van_der_waals is none" if (reach, medium) == ("all", "none") else None


@relation("pairs.*.beam", "pairs.*.substrate", "surfaces", "materials")
def water_wets_the_pair(beam, substrate, surfaces, materials):
    """Water condenses between two surfaces only if the cosines of their contact angles add up to more than zero."""
    sides = sides_of(beam, substrate, surfaces)
    if not sides or wetting(sides, materials):
        return None
    angles = " and ".join(f"{stated.get('contact_angle_deg', 0):g}" for stated in of_material(sides, materials))
    return f"must be of a material that water wets enough: contact angles of {angles} degrees on the two surfaces"


@relation("pairs.*.gap_um", "beam.length_um")
@relation("beam.width_um", "beam.length_um")
@relation("beam.thickness_um", "beam.length_um")
def beam_is_slender(size, length):
    """The beam is longer than it is wide, thick and deflected (Euler-Bernoulli)."""
    return None if size < length else "must be below the length of the beam"


#: Least ratio of the estimated repulsion at zero distance to the estimated pull-off pressure. ASSUME: 3, because the
#: repulsion is estimated up to a factor of two too high, and the weakest sample must resist the strongest attraction.
_SAFE = 3


def _resist(repulsion, pull):
    """Whether summits resist the adhesion; an estimate without attraction is of surfaces that do not stick."""
    return repulsion > 0 and repulsion >= _SAFE * pull


@relation(
    "run.pairs.*",
    "pairs",
    "surfaces",
    "solid",
    "van_der_waals",
    "water.temperature_K",
    "figures.humidity",
    "materials",
)
def solids_resist_the_adhesion(name, pairs, surfaces, solid, medium, temperature, shown_humidity, materials):
    """The force rises to the pull-off pressure on the grid of distances, which begins where mean planes meet."""
    both = sides_of(*(pairs.get(name, {}).get(side) for side in SIDES), surfaces)
    if not both:
        return None  # other relations report this and the next
    pair = pairs[name]
    spectra = [surface["published_psd"] for surface in both if surface["psd"] == "published"]
    if any(spectrum_falls(psd["floor_nm4"], psd["plateau_nm4"]) for psd in spectra) or any(
        corner_lies_below_the_cutoff(psd["corner_rad_per_um"], psd["cutoff_rad_per_um"]) for psd in spectra
    ):
        return None
    humidities = tuple(sorted({*pair["humidities"], shown_humidity}))
    angles = wetting(both, materials)
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


@relation("beam.width_um", "sampling.strip_length_um", "run.pairs.*", "pairs", "surfaces")
def strips_of_a_pair_hold_enough_summits(width, length, pair, pairs, surfaces):
    """Strips of a pair that runs hold so many summits that each sample resists the adhesion."""
    return too_few_summits(length, width, pair, sides_of(*(pairs.get(pair, {}).get(side) for side in SIDES), surfaces))


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


@relation("sampling.spacing_nm", "sampling.strip_length_um", "sampling.margin_um", "beam.width_um")
@relation("studies.variants.spacing_nm.*", "sampling.strip_length_um", "sampling.margin_um", "beam.width_um")
def strips_fit_into_memory(spacing, length, margin, width):
    """The field from which a strip is cut fits into the memory of a job."""
    return field_too_large(length + margin, width + margin, spacing)


@relation("sampling.spacing_nm")
def fields_fit_into_memory(spacing):
    """The fields on which spectra are estimated fit into the memory of a job."""
    return field_too_large(memory.FIELD_UM, memory.FIELD_UM, spacing)


@relation("identification.patch_um", "sampling.spacing_nm")
def patches_fit_into_memory(side, spacing):
    """A patch fits into the memory of a job."""
    return field_too_large(side, side, spacing)


def field_too_large(length: float, width: float, spacing: float) -> str | None:
    """Refusal of a field [µm, nm] whose memory exceeds that of the largest job; ``None`` if it does not."""
    needed = memory.of_field(length, width, spacing)
    if needed <= memory.LARGEST:
        return None
    return (
        f"must leave fields within {memory.LARGEST / MB_PER_GB:g} GB of memory: {length:g} x {width:g} µm every "
        f"{spacing:g} nm take {needed / MB_PER_GB:.3g} GB"
    )
