"""Relations between the keys of a configuration.

The schema bounds every key on its own. Every condition between keys is one of the generators below, which yields a
problem for each entry that violates it; the message is the end of a sentence about the offending key. Values keep the
units of their keys. Relations between names come first: where they hold, the others find what is named.
"""

import contextlib
import functools
import math
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import numpy as np
import yaml

from stiction.config import memory
from stiction.config.cases import IN_HUMID_AIR, NAMEABLE
from stiction.config.keys import Keys, Relations
from stiction.config.kinds import kind_of
from stiction.config.materials import hamaker_constants, sourced_properties
from stiction.config.meetings import pair_meetings
from stiction.config.messages import did_you_mean, duplicates, one_line
from stiction.config.scans import MEASURED_CORRELATION
from stiction.config.surfaces.grid import carried, published_correlation, used_surfaces
from stiction.config.surfaces.moments import nearest_shape
from stiction.config.units import MB_PER_GB, NM_PER_UM, from_si, to_si
from stiction.contact.air import DRY, Air, humid
from stiction.contact.materials import COATING, COATING_ATTRACTION
from stiction.errors import NotConverged
from stiction.models import SIDES
from stiction.rounding import is_at_most, is_multiple
from stiction.surface.identify import SummitTarget, estimated_spectrum
from stiction.surface.spectrum import correlation_length


@functools.cache
def schema() -> dict:
    """JSON schema of the configuration: ``schema.yaml`` next to this module."""
    text = Path(__file__).with_name("schema.yaml").read_text(encoding="utf-8")
    return yaml.load(text, getattr(yaml, "CSafeLoader", yaml.SafeLoader))  # in C where PyYAML was built with it


#: Relations between names, and between keys that are given or not.
relation_of_names = Relations()
#: Relations between the keys of surfaces, pairs and the sizes of computations.
relation = Relations()


@relation_of_names
def lists_have_no_duplicates(config):
    """Require each pair, study, scan and fraction once in its list."""
    scans = [f"surfaces.{name}.scans.files" for name, _ in config.entries("surfaces", "scans.files")]
    for key, values in config.given_items("design.shares", *scans, "run.studies", "run.pairs"):
        if repeated := duplicates(values):
            yield key, f"must list each value once; {one_line(repeated[0])} is listed twice"


@relation
def compared_values_make_different_copies(config):
    """Require as many values of keys changed together, and different copies."""
    paths, compared = zip(*config["compare"].items(), strict=True)
    for path, listed in zip(paths, compared, strict=True):
        if len(listed) != len(compared[0]):
            yield "compare", f"must list as many values of {path} as of {paths[0]}, {len(compared[0])}"
    for twice in duplicates(zip(*compared, strict=False)):
        yield "compare", f"must list each copy once; {', '.join(map(one_line, twice))} is listed twice"


@relation_of_names
def something_is_computed(config):
    """Require something to compute: pairs, devices, or scans to evaluate."""
    if not (config["run.pairs"] or config["devices"] or any(config.entries("surfaces", "scans"))):
        yield "run.pairs", "must name a pair: there are neither devices nor scans"


@relation_of_names
def isotherms_grow(config):
    """Require a thickness for each humidity of an isotherm, both increasing: wetter air thins no film."""
    for key, water in config.given_items("water.isotherm"):
        humidities, thickness = water["humidities"], water["thickness_nm"]
        if np.any(np.diff(humidities) <= 0):
            yield f"{key}.humidities", "must be in increasing order, each value once"
        elif len(thickness) != len(humidities):
            yield (
                f"{key}.thickness_nm",
                f"must have {len(humidities)} values, one for each humidity",
                f"{key}.humidities",
            )
        elif np.any(np.diff(thickness) < 0):
            yield f"{key}.thickness_nm", "must not fall with the humidity", f"{key}.humidities"


@relation_of_names
def selected_pairs_exist(config):
    """Require pairs in the run to be defined."""
    pairs = config.names("pairs")
    for key, names in config.given_items(
        *(f"studies.{name}.distance_nm" for name in ("plasticity", "pressing")), "run.pairs"
    ):
        if strange := [name for name in names if name not in pairs]:
            yield key, f"{undefined(strange[0], pairs)}; {one_line(strange[0])} is not"


@relation_of_names
def pair_of_the_figures_is_defined(config):
    """Require a defined pair for the figures."""
    yield "figures.pair", undefined(config["figures.pair"], config.names("pairs"))


@relation_of_names
def surfaces_of_pairs_are_defined(config):
    """Require both surfaces of every pair to be defined."""
    for side in reversed(SIDES):
        yield from references_are_defined(config, "pairs", side, "surfaces")


def references_are_defined(config: Keys, section: str, key: str, to: str) -> Iterator[tuple]:
    """Yield refusals of a key in every entry of a section unless it names an entry of another section."""
    defined = config.names(to)
    for name, reference in config.entries(section, key):
        yield f"{section}.{name}.{key}", undefined(reference, defined)


def undefined(name: str, defined: Iterable[str]) -> str | None:
    """Refusal of an undefined name."""
    return None if name in defined else f"must be one of {', '.join(defined)}{did_you_mean(name, defined)}"


@relation_of_names
def materials_are_defined(config):
    """Require materials to be defined in their own section, or by name in ``materials.yaml``."""
    defined = [*dict.fromkeys([*config.names("materials"), *sourced_properties()])]
    for name, material in config.entries("surfaces", "material"):
        yield f"surfaces.{name}.material", undefined(material, defined)


@relation
def cases_have_unique_names(config, section="pairs"):
    """Require a unique name for each humidity of a pair."""
    for name, humidities in config.entries(section, "humidities"):
        yield f"{section}.{name}.humidities", without_unique_names(humidities)


@relation
def pairs_have_files_of_their_own(config):
    """Require different names for the files about a pair and one of its surfaces."""
    files = {}
    for name, *surfaces in config.entries("pairs", *SIDES):
        for side, surface in zip(SIDES, surfaces, strict=True):
            other, key = files.setdefault(f"{name}_{surface}", (name, f"pairs.{name}.{side}"))
            if other != name:
                message = f"must have another name, or the pair: files of pair {other} would have the same names"
                yield f"pairs.{name}.{side}", message, key


def without_unique_names(humidities: list[float]) -> str | None:
    """Refusal of humidities without a name of their cases, or with the same."""
    nameless = [humidity for humidity in humidities if not Air(humidity).ending]
    if nameless:
        return f"must {NAMEABLE}; {nameless[0]} has more"
    return repeated(humidities)


def repeated(humidities: list[float]) -> str | None:
    """Refusal of humidities listed twice."""
    twice = duplicates(humidities)
    return f"must list each humidity once; {twice[0] or DRY} is listed twice" if twice else None


@relation
def humidity_of_the_figures_has_a_name(config):
    """Require a humidity of the figures valid in the name of a case."""
    if not Air(config["figures.humidity"]).ending:
        yield "figures.humidity", f"must {NAMEABLE}"


#: Keys of a surface that is described by numbers.
_NUMBERS = ("rms_nm", "skewness", "kurtosis", "mean_summit_radius_um", "summit_density_per_um2", "published_psd")


@relation_of_names
def scans_stand_alone(config):
    """Require a surface to have either scans or numbers."""
    for name, _ in config.entries("surfaces", "scans"):
        if beside := [key for key in config.names(f"surfaces.{name}") if key in _NUMBERS]:
            message = f"must not be given beside {', '.join(beside)}; give the measured surface a name of its own"
            yield f"surfaces.{name}.scans", message


@relation_of_names
def spectra_suit_their_surfaces(config):
    """Require fitted or tabulated spectra for scans, others for numbers."""
    for name, psd in config.entries("surfaces", "psd"):
        keys = config.names(f"surfaces.{name}")
        if "scans" not in keys:
            preposition, sources = "without", ("published", "identified")
        elif not any(key in _NUMBERS for key in keys):  # otherwise the relation above reports this
            preposition, sources = "with", ("fitted", "tabulated")
        else:
            continue
        if psd not in sources:
            yield f"surfaces.{name}.psd", f"must be {' or '.join(sources)} for a surface {preposition} scans"


@relation_of_names
def only_scans_leave_a_choice(config):
    """Refuse a choice of heights, or of the spectrum beyond the cut-off, without scans."""
    for choice in ("beyond", "heights"):
        for name, _ in config.entries("surfaces", choice):
            if "scans" not in config.names(f"surfaces.{name}"):
                yield f"surfaces.{name}.{choice}", "must not be given for a surface without scans"


@relation
def heights_have_a_density(config):
    """Require moments of a density, and of a maximum-entropy density of Eq. (3) at or near them."""
    for name, kurtosis, skewness in config.entries("surfaces", "kurtosis", "skewness"):
        yield f"surfaces.{name}.kurtosis", without_density(skewness, kurtosis), f"surfaces.{name}.skewness"


def without_density(skewness: float, kurtosis: float) -> str | None:
    """Refusal of a kurtosis without such a density."""
    if kurtosis <= skewness**2 + 1:
        return f"must be above skewness² + 1 = {skewness**2 + 1:.6g}"
    try:
        nearest_shape(skewness, kurtosis)
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
            if is_at_most(bound, value):
                yield f"surfaces.{name}.{low}", f"must be below the {words}", f"surfaces.{name}.{high}"


def only_if(runs: Callable[[Keys], bool]) -> Callable:
    """Condition of a relation. Without it the relation refuses nothing."""

    def decorated(relation):
        """Relation under the condition."""

        @functools.wraps(relation)
        def conditional(config):
            """Yield from the relation under the condition."""
            if runs(config):
                yield from relation(config)

        return conditional

    return decorated


def pairs_run(config: Keys) -> bool:
    """Whether pairs run, with the beam and the studies of the paper."""
    return bool(config["run.pairs"])


def variants_run(config: Keys) -> bool:
    """Whether contacts under variants of the model are computed, by the study of pairs or for a budget of devices."""
    return variants_of_pairs_run(config) or bool(config["devices"])


def variants_of_pairs_run(config: Keys) -> bool:
    """Whether the study of variants of pairs runs."""
    return pairs_run(config) and "variants" in config["run"].get("studies", ["variants"])


def spectra_are_identified(config: Keys) -> bool:
    """Whether spectra may be identified: by a variant of pairs, or for a surface itself."""
    sources = [psd for name, psd in config.entries("surfaces", "psd") if name in set(used_surfaces(config.config))]
    return pairs_run(config) or "identified" in sources


def _drawn_surfaces(config, *keys):
    """Name and values of some keys of every drawn surface."""
    drawn = set(used_surfaces(config.config))
    return (entry for entry in config.entries("surfaces", *keys) if entry[0] in drawn)


@relation
def grid_carries_the_roughness(config):
    """Require a cut-off within the Nyquist wave number of the grid."""
    nyquist = math.pi / config["sampling.spacing_nm"] * NM_PER_UM
    message = f"must be at most the Nyquist wave number of the grid, {nyquist:.6g} rad/µm"
    for name, cutoff in _drawn_surfaces(config, _CUTOFF):
        if not is_at_most(cutoff, nyquist):
            yield f"surfaces.{name}.{_CUTOFF}", message, "sampling.spacing_nm"


@relation
@only_if(variants_run)
def other_grids_carry_the_roughness(config):
    """Require a cut-off within the Nyquist wave number of the grid of a variant."""
    for key, spacing in config.items("studies.variants.spacing_nm"):
        for name, cutoff in _drawn_surfaces(config, _CUTOFF):
            largest = math.pi / cutoff * NM_PER_UM
            if not is_at_most(spacing, largest):
                message = f"must be at most {largest:.6g} nm, for the Nyquist wave number of the grid"
                yield key, message, f"surfaces.{name}.{_CUTOFF}"


@relation
@only_if(variants_run)
def other_grids_carry_an_identified_spectrum(config):
    """Require grids no coarser than Table I's for an identified spectrum, cut off at the Nyquist wave number there."""
    for key, spacing in config.items("studies.variants.spacing_nm"):
        for name, psd in _drawn_surfaces(config, "psd"):
            if spacing > config["character.spacing_nm"] and psd != "published":
                yield key, "must be at most that of Table I", "character.spacing_nm", f"surfaces.{name}.psd"


@relation
def lengths_exceed_the_correlation(config):
    """Require uncorrelated opposite edges of strips, and of patches to identify.

    Strips themselves may be shorter: under devices they then repeat laws, see `stiction.devices.strips`. ASSUME: under
    the beams of pairs, their force laws are independent nevertheless. Laws of strips of 0.25 and 0.5 µm on pair b, for
    bridges, correlate by less than 0.05.
    """
    lengths = {"sampling.margin_um": ("published_psd",)}
    if spectra_are_identified(config):
        lengths["identification.patch_um"] = ("published_psd", "summit_density_per_um2")
    for key, length in config.given_items(*lengths):
        for name, psd, *_ in _drawn_surfaces(config, *lengths[key]):
            yield key, correlated(length, psd), *(f"surfaces.{name}.{stated}" for stated in lengths[key])


def correlated(length: float, psd: dict) -> str | None:
    """Refusal of a length [µm] within the correlation length of a published spectrum."""
    try:
        bound = published_correlation(**psd)
    except ValueError:
        return None  # no spectrum or no decaying spectrum, which other relations report
    return None if length > bound else f"must be above the correlation length of the surface, {bound:.3g} µm"


@relation
def offsets_stay_in_the_margin(config):
    """Require offsets within the margin of a strip, beyond which its periodic field repeats."""
    for pair, offset in config.entries("pairs", "replica.offset_nm"):
        if offset > config["sampling.margin_um"] * NM_PER_UM:
            message = f"must be at most {config['sampling.margin_um'] * NM_PER_UM:g} nm"
            yield f"pairs.{pair}.replica.offset_nm", message, "sampling.margin_um"


@relation
def lengths_can_exceed_the_correlation(config):
    """Require lengths above the estimated correlation of an identified spectrum. The jobs check the spectrum itself."""
    keys = "psd", "rms_nm", "mean_summit_radius_um", "summit_density_per_um2"
    spacing = config["character.spacing_nm"]
    for key, length in config.given_items("sampling.margin_um", "identification.patch_um"):
        for name, psd, *summits in _drawn_surfaces(config, *keys):
            if psd == "identified" and (refusal := correlated_as_estimated(length, *summits, spacing)):
                keys_of_surface = [f"surfaces.{name}.{stated}" for stated in keys]
                yield key, refusal, *keys_of_surface, "character.spacing_nm"


#: The correlation length estimated from summits exceeds that of the identified spectrum by this factor at most.
_AT_MOST = 1.5


def correlated_as_estimated(length: float, rms: float, radius: float, density: float, spacing: float) -> str | None:
    """Refusal of a length within the correlation length expected from the targets of an identification."""
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
    """Correlation length of the spectrum at the start of an identification [µm]."""
    summits = to_si(radius, "um"), to_si(density, "per_um2"), to_si(spacing, "nm")
    target = SummitTarget(np.float64(to_si(rms, "nm")), *summits)
    return from_si(correlation_length(estimated_spectrum(target)), "um")


def off_grid(side: float, spacing: float, every: int) -> str | None:
    """Refusal of a side [µm] other than a multiple of the distance between contact points."""
    step = spacing * every
    is_whole = is_multiple(side * NM_PER_UM, step)
    return None if is_whole else f"must be a whole number of contact points {step:g} nm apart"


@relation
@only_if(variants_run)
def strips_are_whole_under_a_variant(config):
    """Require whole strips for the step in grid points times the grid spacing, with either changed by a variant."""
    sides = "sampling.strip_length_um", *(["beam.width_um"] * pairs_run(config))
    variants = {"sampling.spacing_nm": "studies.variants.every", "contact.every": "studies.variants.spacing_nm"}
    for other, step in config.given_items(*variants):
        for key, changed in config.items(variants[other]):
            if any(off_grid(config[side], changed, step) for side in sides):
                yield key, "must divide both sides of a strip into whole contact points", other, *sides


@relation
@only_if(spectra_are_identified)
def patches_are_whole_on_the_grid(config):
    """Require sides of a patch to be multiples of the grid spacing."""
    spacing = config["sampling.spacing_nm"]
    if not is_multiple(config["identification.patch_um"] * NM_PER_UM, spacing):
        message = f"must be a whole number of grid spacings of {spacing} nm"
        yield "identification.patch_um", message, "sampling.spacing_nm"


@relation
@only_if(spectra_are_identified)
def summits_are_sought_on_the_grid(config):
    """Require a spacing of Table I at every n-th height of the grid."""
    spacing = config["sampling.spacing_nm"]
    if not is_multiple(config["character.spacing_nm"], spacing):
        message = f"must be a multiple of the grid spacing of {spacing} nm"
        yield "character.spacing_nm", message, "sampling.spacing_nm"


@relation
@only_if(spectra_are_identified)
def strips_can_hold_a_summit(config):
    """Require strips with room for a summit and its eight neighbours."""
    coarse = config["character.spacing_nm"]
    width = ["beam.width_um"] * pairs_run(config)
    for key, side in config.given_items(*width, "sampling.strip_length_um", "identification.patch_um"):
        if not is_at_most(3 * coarse, side * NM_PER_UM):
            yield "character.spacing_nm", f"must be at most a third of a side of {side} µm", key


@relation
def chunks_are_not_empty(config):
    """Require at least one sample in every chunk."""
    if config["contact.chunks"] > config["contact.samples"]:
        yield "contact.chunks", "must be at most the number of samples", "contact.samples"


@relation
def samples_carry_the_chaos(config):
    """Require more samples than polynomials in four variables, App. B. Stoppers need no model."""
    order, samples, pairs = config["chaos.order"], config["contact.samples"], config["run"]["pairs"]
    have_laws = [kind_of(device).release.has_laws for device in config["devices"].values()]
    most = carried(order, samples)
    if order > most and (pairs or any(have_laws)):
        alone = "; run: {pairs: []} computes the stoppers alone, which need no chaos model"
        hint = "" if any(have_laws) or not have_laws else alone
        message = f"must be at most {most}, or {math.comb(order + 4, 4)} samples are needed{hint}"
        yield "chaos.order", message, "contact.samples"


@relation
@only_if(pairs_run)
def strips_fill_the_elements(config):
    """Require the same whole number of strips in every element, its integration points (Fig. 6)."""
    keys = "sampling.strip_length_um", "beam.elements"
    least = config[keys[0]] * config[keys[1]]
    if not is_multiple(config["beam.length_um"], least):
        message = f"must be a multiple of strip_length x elements = {least:.6g} µm: whole strips on each element"
        yield "beam.length_um", message, *keys


@relation
@only_if(pairs_run)
@only_if(variants_run)
def strips_fill_finer_elements(config):
    """Require the same for a variant, with at least two elements."""
    keys = "beam.length_um", "sampling.strip_length_um"
    length, strip = (config[key] for key in keys)
    for key, strips in config.items("studies.variants.strips_per_element"):
        if not (is_multiple(length, strip * strips) and length > 1.5 * strip * strips):
            message = "must divide the strips along the beam into whole elements, at least two"
            yield key, message, *keys


@relation
@only_if(pairs_run)
def a_mesh_is_whole(config):
    """Require one possible mesh of Figure 19. Lengths not filling each other and the beam are left out."""
    key, *others = "studies.mesh.elements_um", "studies.mesh.strips_um", "beam.length_um"
    elements, strips, length = (config[each] for each in (key, *others))
    fitting = (is_multiple(length, element) and is_multiple(element, strip) for element in elements for strip in strips)
    if "mesh" in config["run"].get("studies", ["mesh"]) and not any(fitting):
        yield key, "must include a divisor of the beam that is a multiple of one of the strips", *others


@relation
def solids_are_less_hard_than_stiff(config):
    """Require a hardness up to Young's modulus. Bonds break at a strain well below 1."""
    for name, hardness in config.entries("materials", "hardness_GPa"):
        modulus = (config["solid"] | config["materials"][name])["young_modulus_GPa"]
        if hardness > modulus:
            source = f"materials.{name}" if "young_modulus_GPa" in config["materials"][name] else "solid"
            message = f"must be at most Young's modulus of the material, {modulus:g} GPa"
            yield f"materials.{name}.hardness_GPa", message, f"{source}.young_modulus_GPa"


@relation
def coatings_attract_less_than_their_solids(config):
    """Require a coating to attract at most as its material, and to have a thickness."""
    key = COATING_ATTRACTION
    for name, constants in config.entries("materials", key):
        material, path = config["materials"][name], f"materials.{name}.{key}"
        if not material.get(COATING):
            yield path, "must come with a thickness coating_nm above 0"
        for medium, constant in hamaker_constants(material).items():
            if constants[medium] > constant:
                yield f"{path}.{medium}", f"must be at most that of the material itself, {constant:g} zJ"


@relation
def solids_attract_across_gaps(config):
    """Refuse attraction across gaps without van der Waals forces of the summits."""
    if (config["attraction.reach"], config["van_der_waals"]) == ("all", "none"):
        yield "attraction.reach", "must be touching if van_der_waals is none", "van_der_waals"


@relation
def studies_in_humid_air_have_some(config):
    """Require a pair with condensed water in the run for each requested study of humid air.

    That of the sensitivity is about the pair of the figures.
    """
    wet = {
        meeting.pair: humid(config[f"pairs.{meeting.pair}.humidities"]) and meeting.is_wetted
        for meeting in pair_meetings(config)
    }
    running = config["run.pairs"]
    shown = [pair for pair in running if pair == config["figures.pair"]] or running[:1]
    for name in config["run.studies"]:
        if name in IN_HUMID_AIR and not any(wet.values()):
            yield "run.studies", _without(name, "no pair of run.pairs is in any"), "run.pairs"
        elif name == "sensitivity" and shown and not wet[shown[0]]:
            yield (
                "run.studies",
                _without(name, f"pair {shown[0]} of the figures is in none"),
                "run.pairs",
                "figures.pair",
            )


def _without(study, why):
    """Refusal of a study of humid air."""
    return f"must be without {study}, which is computed in humid air alone: {why}"


@relation
@only_if(pairs_run)
def beam_is_slender(config):
    """Require a beam longer than its width, thickness and deflection (Euler-Bernoulli)."""
    gaps = [f"pairs.{pair}.gap_um" for pair, _ in config.entries("pairs", "gap_um")]
    for key, size in config.given_items("beam.thickness_um", "beam.width_um", *gaps):
        if size >= config["beam.length_um"]:
            yield key, "must be below the length of the beam", "beam.length_um"


@relation
@only_if(pairs_run)
def strips_fit_into_memory(config):
    """Require the field around a strip to fit into the memory of a job."""
    keys = "sampling.strip_length_um", "sampling.margin_um", "beam.width_um"
    length, margin, width = (config[key] for key in keys)
    grids = [key for key, _ in config.items("studies.variants.spacing_nm") if variants_of_pairs_run(config)]
    for key, spacing in config.given_items(*grids, "sampling.spacing_nm"):
        yield from fields_too_large(config, key, (length + margin, width + margin), spacing, *keys)


@relation
@only_if(pairs_run)
def fields_fit_into_memory(config):
    """Require the fields for estimating spectra to fit into the memory of a job."""
    yield "sampling.spacing_nm", field_too_large(memory.FIELD_UM, memory.FIELD_UM, config["sampling.spacing_nm"])


@relation
@only_if(spectra_are_identified)
def patches_fit_into_memory(config):
    """Require a patch to fit into the memory of a job."""
    side = config["identification.patch_um"]
    yield "identification.patch_um", field_too_large(side, side, config["sampling.spacing_nm"]), "sampling.spacing_nm"


def fields_too_large(
    config: Keys, key: str, sides: tuple[float, float], spacing: float, *others: str
) -> Iterator[tuple[str, ...]]:
    """Yield refusals of the field around a patch, margin included [µm, nm], if its memory exceeds the largest job's.

    They are about the key of the patch, or about the surfaces whose correlation length alone makes the field too large.
    """

    def with_margin(margin):
        """Refusal of the field with a margin [µm]."""
        return field_too_large(*(side - config["sampling.margin_um"] + margin for side in sides), spacing)

    if not (refusal := field_too_large(*sides, spacing)):
        return
    long = {} if with_margin(memory.GRID["margin_um"]) else _correlations(config)
    long = {key: length for key, length in long.items() if with_margin(length)}
    for of_surface, length in long.items():
        yield of_surface, _TOO_LONG.format(length)
    if not long:
        yield key, refusal, *others


def _correlations(config):
    """Correlation lengths of the drawn surfaces with a decaying spectrum [µm], by the key behind each."""
    lengths = {
        f"surfaces.{name}.{MEASURED_CORRELATION}": length
        for name, length in _drawn_surfaces(config, MEASURED_CORRELATION)
    }
    for name, psd in _drawn_surfaces(config, "published_psd"):
        with contextlib.suppress(ValueError):
            if name not in config.files:
                lengths[f"surfaces.{name}.published_psd.corner_rad_per_um"] = published_correlation(**psd)
    return lengths


#: Refusal of a correlation length [µm].
_TOO_LONG = (
    f"must leave fields within {memory.LARGEST / MB_PER_GB:g} GB of memory: heights correlate over {{:.3g}} µm. What "
    "touches is 20 nm to 5 µm wide: scan 5 to 20 µm with pixels of at most 20 nm, or state numbers of the surface"
)


def field_too_large(length: float, width: float, spacing: float) -> str | None:
    """Refusal of a field [µm, nm] if its memory exceeds the largest job's."""
    needed = memory.field_memory(length, width, spacing)
    if needed <= memory.LARGEST:
        return None
    return (
        f"must leave fields within {memory.LARGEST / MB_PER_GB:g} GB of memory: {length:g} x {width:g} µm every "
        f"{spacing:g} nm take {needed / MB_PER_GB:.3g} GB"
    )
