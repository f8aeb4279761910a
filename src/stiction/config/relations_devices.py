"""Relations between the keys of devices.

Lengths are in µm, as in the configuration.
"""

import math
from collections.abc import Mapping
from functools import partial

import numpy as np

from stiction.config import memory
from stiction.config.keys import Relations
from stiction.config.kinds import KEYS, KINDS, ROUGHNESSES, kind_of
from stiction.config.materials import hamaker_constant, material_of
from stiction.config.meetings import (
    TEMPERATURE,
    device_meeting,
    films,
    least_gap,
    surfaces_of,
    with_rms,
)
from stiction.config.messages import duplicates
from stiction.config.reading import is_stated
from stiction.config.relations import (
    cases_have_unique_names,
    correlated,
    fields_too_large,
    off_grid,
    pairs_run,
    references_are_defined,
    repeated,
    schema,
    without_density,
    without_unique_names,
)
from stiction.config.surfaces import process as process_surfaces
from stiction.config.test_beams import DATA, pair_of, shared_uncertainty
from stiction.config.units import NM_PER_UM, from_si, in_si, to_si
from stiction.contact.air import MOLECULES, Air, humid, is_humid
from stiction.contact.materials import COATING_ATTRACTION, COHERENCE, OF_CONTACT, OF_REPLICAS, PLAY
from stiction.contact.probes.shape import RISE, Probe
from stiction.contact.tilt import EDGE_RADIUS, Edge
from stiction.rounding import is_at_most
from stiction.surface.feasible import largest_kurtosis

#: Least standard deviation of crack lengths, in parts of their mean. ASSUME: beams differ by more than 1 nm in 10 µm.
LEAST_SCATTER = 1e-4

#: Relations between the names of devices, and between their keys that are given or not.
relation_of_names = Relations()
#: Relations between the keys of devices.
relation = Relations()
#: Relations between the sizes of all tips, those of counted test beams among them.
relation_of_tips = Relations()

#: Keys of the grid of contact points.
_GRID = "sampling.spacing_nm", "contact.every"
_STRIP = "sampling.strip_length_um"


relation_of_names(partial(references_are_defined, section="devices", key="pair", to="pairs"))
relation(partial(cases_have_unique_names, section="devices"))


@relation
def an_accuracy_decides_a_number(config):
    """Require a number of beams or of samples not stated beside the accuracy from which it follows."""
    numbers = ("design", "beams"), ("contact", "samples")
    if config["design.accuracy"] and all(is_stated(config, *key) for key in numbers):
        message = "must have a number to decide: leave out design.beams, contact.samples or design.accuracy"
        yield "design.accuracy", message, *map(".".join, numbers)


@relation
def strips_and_patches_are_whole_on_the_grid(config):
    """Require sides of strips and stoppers to be multiples of the distance between contact points."""
    sides = ("strip_um", "width_um", "contact_um")
    of_devices = [f"devices.{name}.{key}" for key in sides for name, _ in config.entries("devices", key)]
    for key, stated in config.given_items(*["beam.width_um"] * pairs_run(config), _STRIP, *of_devices):
        refusals = (off_grid(float(side), *(config[step] for step in _GRID)) for side in np.ravel(stated))
        yield key, next(filter(None, refusals), None), *_GRID


@relation_of_names
def devices_have_the_keys_of_their_kind(config):
    """Require all keys of the kind of a device, and none of another kind."""
    for name, kind in config.entries("devices", "kind"):
        yield f"devices.{name}.kind", KINDS[kind].refusal(config.names(f"devices.{name}"))


@relation
def lengths_of_devices_are_those_of_slender_beams(config):
    """Require beams longer than their thickness and deflection. Lengths in mm are not."""
    sizes = "thickness_um", "gap_um"
    for key in ("length_um", "requirement.length_um"):
        for name, length, *values in config.entries("devices", key, *sizes):
            if length <= max(values):
                message = "must be in µm, above the thickness and the gap of the beam"
                yield f"devices.{name}.{key}", message, *(f"devices.{name}.{size}" for size in sizes)


@relation
def lengths_of_devices_are_those_that_are_required(config):
    """Require the same length of a device and of its requirement, if both are given."""
    for name, length, required in config.entries("devices", "length_um", "requirement.length_um"):
        if length != required:
            message, other = "must be the length that is required", f"devices.{name}.requirement.length_um"
            yield f"devices.{name}.length_um", message, other


@relation
def voltages_are_across_a_dielectric(config):
    """Require a dielectric for a voltage or offset. Without it, touching surfaces would short."""
    for key in ("voltage_V", "offset_V"):
        for name, _ in config.entries("devices", key):
            if "dielectric" not in config.names(f"devices.{name}"):
                yield f"devices.{name}.{key}", "must come with dielectric: {thickness_nm, permittivity}"
    for name, _ in config.entries("devices", "dielectric"):
        if not {"voltage_V", "offset_V"} & set(config.names(f"devices.{name}")):
            yield f"devices.{name}.dielectric", "must come with voltage_V or offset_V"


@relation
def electrodes_pull_on_a_spring_across_a_gap(config):
    """Require the stiffness of a stopper for the voltage of an electrode, and contact before its electrode's."""
    for name, electrode in config.entries("devices", "electrode"):
        device, key = config["devices"][name], f"devices.{name}.electrode"
        if "stiffness_N_per_m" not in device:
            yield key, "must come with stiffness_N_per_m and gap_um in place of restoring_force_uN"
        elif electrode["gap_um"] < device["gap_um"]:
            message = "must be at least gap_um of the stopper, which would not touch otherwise"
            yield f"{key}.gap_um", message, f"devices.{name}.gap_um"


#: Points of the grid in the water under a probe: these and more know the area of a circle around one of them to 4.2 %.
POINTS_UNDER_PROBE = 200
#: Heights of both surfaces together under a probe, in their rms.
HEIGHTS_UNDER_PROBE = 6


@relation_of_names
def measured_forces_are_those_of_one_air(config):
    """Require one humidity beside a measured pull-off force."""
    for name, _, humidities in config.entries("devices", "measured_nN", "humidities"):
        if len(humidities) > 1:
            message = "must be the one of measured_nN; state a device for each measurement"
            yield f"devices.{name}.humidities", message, f"devices.{name}.measured_nN"


@relation
def water_under_probes_is_resolved(config):
    """Require some points of the grid in the water under a smooth probe, in the driest air with water."""
    for name, _ in config.entries("devices", "radius_um"):
        device = config["devices"][name]
        probe, step = in_si(Probe, kind_of(device).shape_of(device)), math.prod(config[key] for key in _GRID)
        for height in sorted(films(device["humidities"], device_meeting(name, config)))[:1]:
            points = math.pi * (probe.zone(height) / to_si(step, "nm")) ** 2
            if points < POINTS_UNDER_PROBE:
                finer = math.sqrt(points / POINTS_UNDER_PROBE) * config["sampling.spacing_nm"]
                message = (
                    f"must be larger, or sampling.spacing_nm at most {finer:.2g}: the grid has {points:.2g} points"
                )
                message += f" in the water under the probe, fewer than {POINTS_UNDER_PROBE}"
                yield f"devices.{name}.radius_um", message, *_GRID, f"devices.{name}.humidities"


@relation
def probes_rise_above_the_film(config):
    """Require what acts under a probe, film and heights, within the rise at the sides of its patch."""
    for name, _ in config.entries("devices", "radius_um"):
        meeting, humidities = device_meeting(name, config), config[f"devices.{name}.humidities"]
        height = max(films(humidities, meeting), default=0.0)
        needed, most = from_si(height, "nm") + HEIGHTS_UNDER_PROBE * meeting.rms, from_si(RISE, "nm")
        if needed > most:
            message = (
                f"must have smoother surfaces or drier air: the film and {HEIGHTS_UNDER_PROBE} times the rms of both "
                f"surfaces are {needed:.3g} nm, more than the {most:g} nm by which a probe rises"
            )
            yield f"devices.{name}.pair", message, f"devices.{name}.humidities", *meeting.keys_behind()


@relation
def probes_have_files_of_their_own(config):
    """Require another patch under each probe of a pair, which names its files."""
    shapes = {}
    for name, pair in config.entries("devices", "pair"):
        device, kind = config["devices"][name], KINDS[config[f"devices.{name}.kind"]]
        sides = kind.sides(device, config[_STRIP])
        shape = kind.shape_of(device)
        other, of_other = shapes.setdefault((pair, *sides), (name, shape))
        if shape != of_other:
            probe, flat = (name, other) if shape else (other, name)
            message = f"must differ from the area of {flat}, whose files would have the same names: state another one"
            yield f"devices.{probe}.contact_um", message


#: Fewest independent beams on dimples whose forces are sums of sampled patches.
SUMS = 50


@relation
def dimples_are_under_their_beam(config):
    """Require rows of dimples on the length of their beam, lower than its gap, and patches enough for their sums."""
    for name, dimples in config.entries("devices", "dimples"):
        device, key = config["devices"][name], f"devices.{name}.dimples"
        if "length_um" not in device:
            yield key, "must come with length_um, the length of the beam"
        elif max(dimples["at_um"]) >= device["length_um"]:
            yield f"{key}.at_um", "must be below length_um of the beam", f"devices.{name}.length_um"
        if "gap_um" in device and dimples["height_um"] >= device["gap_um"]:
            yield f"{key}.height_um", "must be below gap_um of the beam", f"devices.{name}.gap_um"
        rows = len(dimples["at_um"])
        if dimples["number"] * rows * SUMS > config["contact.samples"]:
            most = f"must be at most 1 / {rows * SUMS} of contact.samples"
            yield f"{key}.number", most, "contact.samples", f"{key}.at_um"


@relation
def asperities_of_devices_are_summits(config):
    """Require summits for tips of beams and for the budgets of devices."""
    for name in config["devices"]:
        if config["contact.asperity"] != "summit":
            message = "must be summit, or the devices left out: their contact has summits"
            yield "contact.asperity", message, f"devices.{name}.pair"


@relation
def axes_increase(config):
    """Values along an axis increase."""
    axes = "chart.gaps_um", "chart.thicknesses_um", "chart.humidities", *(f"roughness.{key}" for key in ROUGHNESSES)
    charts = [f"devices.{name}.{axis}" for axis in axes for name, _ in config.entries("devices", axis)]
    tilts = [f"devices.{name}.tilt_deg" for name, _ in config.entries("devices", "tilt_deg")]
    rows = [f"devices.{name}.dimples.at_um" for name, _ in config.entries("devices", "dimples.at_um")]
    for key, values in config.given_items(*charts, *tilts, *rows, "design.worst_humidities"):
        if any(low >= high for low, high in zip(values, values[1:], strict=False)):
            yield key, "must be in increasing order, each value once"


@relation
def wettest_airs_along_axes_have_names(config):
    """Require a name for the wettest air of charts and of the search of the worst, where contacts may be full."""
    charts = [f"devices.{name}.chart.humidities" for name, _ in config.entries("devices", "chart.humidities")]
    for key, humidities in config.given_items(*charts, "design.worst_humidities"):
        if refusal := without_unique_names([max(humidities)]):
            yield key, refusal


@relation
def uncertain_water_of_devices_is_a_liquid(config):
    """Require the film to stay liquid when humidity, temperature or contact angle err by one standard uncertainty."""
    keys = "humidity", "temperature_K", "contact_angle_deg"
    for key in keys:
        for name, deviation, humidities in config.entries("devices", f"uncertainty.{key}", "humidities"):
            meeting, (drier, warmer, more) = (
                device_meeting(name, config),
                (deviation * (key == wrong) for wrong in keys),
            )
            driest = min(humid(humidities), default=0) - drier
            other = f"devices.{name}.humidities"
            molecules = meeting.molecules(other) if meeting.too_dry(humidities) else MOLECULES
            if not is_humid(driest) or _freezes_or_boils(warmer, config[TEMPERATURE]):
                continue  # other relations report it
            if meeting.too_dry(humidities, molecules=molecules):
                continue
            if refusal := meeting.too_dry(driest, more, warmer, molecules):
                message = f"must leave water that is a liquid: the humidity, {driest:g}, {refusal}"
                yield f"devices.{name}.uncertainty.{key}", message, other, *meeting.keys_behind(TEMPERATURE)


@relation
def devices_fit_into_memory(config):
    """Require the fields around all patches of surface to fit into the memory of a job."""
    others = "studies.variants.spacing_nm"
    for name, device in config["devices"].items():
        refused = {}
        for key, sides, spacing in memory.fields_of(device, config["sampling"], config[others]):
            other_keys = [] if "dimples" in key else [others]
            for refused_key, *refusal in fields_too_large(config, f"devices.{name}.{key}", sides, spacing, *other_keys):
                refused.setdefault(refused_key, refusal)
        yield from ((key, *refusal) for key, refusal in refused.items())


@relation
def dimensions_stay_positive(config):
    """Require dimensions to stay positive one standard uncertainty below their values."""
    for key in ("gap_um", "thickness_um"):
        for name, deviation, value in config.entries("devices", f"uncertainty.{key}", key):
            if deviation >= value:
                message, other = "must be below the dimension itself", f"devices.{name}.{key}"
                yield f"devices.{name}.uncertainty.{key}", message, other


@relation
def uncertain_moduli_stay_positive(config):
    """Require a positive Young's modulus one standard uncertainty below its value."""
    key = "uncertainty.young_modulus_GPa"
    for name, deviation in config.entries("devices", key):
        value = _material(config, name)["young_modulus_GPa"]
        if deviation >= value:
            message = f"must be below Young's modulus itself, {value:g} GPa"
            yield f"devices.{name}.{key}", message, *_keys_of_scans(config, name)


@relation
def uncertain_poisson_ratios_stay_within_their_limits(config):
    """Require possible Poisson's ratios one standard uncertainty, and one step of the slope, around the value."""
    key = "uncertainty.poisson_ratio"
    for name, deviation in config.entries("devices", key):
        value = _material(config, name)["poisson_ratio"]
        change = max(deviation, OF_CONTACT["poisson_ratio"].step.size)
        if deviation and not (value - change > -1 and value + change < 0.5):
            message = f"must leave Poisson's ratio above -1 and below 0.5: its budget needs {value:g} ± {change:g}"
            yield f"devices.{name}.{key}", message, *_keys_of_scans(config, name)


@relation
def uncertain_hamaker_constants_stay_positive(config):
    """Require Hamaker constants to stay positive one standard uncertainty below their values."""
    key = "uncertainty.hamaker_constant_zJ"
    for name, deviation in config.entries("devices", key):
        value = hamaker_constant(_material(config, name), config["van_der_waals"])
        if deviation >= value:
            message = f"must be below the Hamaker constant itself, {value:g} zJ"
            yield f"devices.{name}.{key}", message, "van_der_waals", *_keys_of_scans(config, name)


@relation
def uncertain_hamaker_constants_are_those_of_bare_solids(config):
    """Require bare solids for an uncertain Hamaker constant. The budget changes the solids', not the coating's."""
    key = "uncertainty.hamaker_constant_zJ"
    for name, deviation in config.entries("devices", key):
        if deviation and COATING_ATTRACTION in _material(config, name):
            message = f"must be left out if the material states {COATING_ATTRACTION}"
            yield f"devices.{name}.{key}", message


@relation
def uncertain_replicas_are_stated(config):
    """Require a pair with a replica for an uncertain one, and test beams with the same."""
    for entry in OF_REPLICAS.values():
        for name, deviation, pair in config.entries("devices", f"uncertainty.{entry.key}", "pair"):
            key, replica = f"devices.{name}.uncertainty.{entry.key}", config["pairs"][pair].get("replica")
            if deviation and not replica:
                yield key, f"must be left out, because pair {pair} has no replica", f"devices.{name}.pair"
            for used in _pairs_of_arrays(config, name) if deviation and replica else ():
                if config["pairs"][used].get("replica") != replica:
                    yield key, f"must be left out, because pair {used} of its test beams has another replica"


def _pairs_of_arrays(config, device):
    """Pairs of the test beams of a device."""
    return dict.fromkeys(pair_of(config, name) for name in config["devices"][device].get("test_beams", ()))


@relation
def uncertain_coherences_leave_some(config):
    """Require a coherence of which a step of its slope leaves some for an uncertain one."""
    key, step = f"uncertainty.{COHERENCE.key}", COHERENCE.step
    for name, deviation, pair in config.entries("devices", key, "pair"):
        replica = config["pairs"][pair].get("replica")
        if deviation and replica and step.ends(replica["coherence"])[0] < 0:
            message = f"must be left out below a coherence of {step.size / (1 + step.size):.2g}"
            yield f"devices.{name}.{key}", message, f"pairs.{pair}.replica.coherence"


@relation
def uncertain_plays_are_those_of_pairs(config):
    """Require one uncertainty of the play on a pair: all budgets share its contacts with less and with more."""
    key, stated = f"uncertainty.{PLAY.key}", {}
    for name, deviation, pair in config.entries("devices", key, "pair"):
        for used in (pair, *_pairs_of_arrays(config, name)) if deviation else ():
            other, same = stated.setdefault(used, (name, deviation))
            if deviation != same:
                yield (
                    f"devices.{name}.{key}",
                    f"must be that of device {other} on pair {used}",
                    f"devices.{other}.{key}",
                )
                break


@relation
def uncertain_edges_are_those_of_round_tips(config):
    """Require a tip with a rounded edge for an uncertain radius, which stays positive below its value."""
    key, edge, radius = "uncertainty.edge_radius_um", "design.tip_edge", "design.edge_radius_um"
    for name, deviation, kind in config.entries("devices", key, "kind"):
        message, other = None, radius
        if not KINDS[kind].has_tip:
            message, other = "must be left out, because a device of this kind has no tip", f"devices.{name}.kind"
        elif config[edge] == Edge.SQUARE:
            message, other = "must be left out, because a square edge has no radius", edge
        elif config[radius] == 0:
            message = "must be left out, because an edge with the radius 0 is sharp"
        elif deviation >= config[radius]:
            message = "must be below the radius itself"
        if deviation and message:
            yield f"devices.{name}.{key}", message, other


@relation
def uncertain_humidities_stay_within_their_limits(config):
    """Require humidities above 0 and below 1 one standard uncertainty around their values."""
    for name, deviation, humidities in config.entries("devices", "uncertainty.humidity", "humidities"):
        message, other = None, f"devices.{name}.humidities"
        if deviation and not humid(humidities):
            message = "must be left out, because dry air has no humidity that could be uncertain"
        elif not (is_humid(min(humid(humidities), default=1) - deviation) and max(humidities) + deviation < 1):
            message = "must leave the humidities above 0 and below 1"
        if message:
            yield f"devices.{name}.uncertainty.humidity", message, other


@relation
def water_stays_liquid(config):
    """Require liquid water one standard uncertainty around its temperature."""
    for name, deviation in config.entries("devices", "uncertainty.temperature_K"):
        if refusal := _freezes_or_boils(deviation, config[TEMPERATURE]):
            yield f"devices.{name}.uncertainty.temperature_K", refusal, TEMPERATURE


def _freezes_or_boils(deviation, temperature):
    """Refusal of an uncertainty large enough for water to freeze or boil [K]."""
    liquid = schema()["properties"]["water"]["properties"]["temperature_K"]
    freezing, boiling = liquid["minimum"], liquid["maximum"]
    inside = temperature - deviation >= freezing and temperature + deviation <= boiling
    return None if inside else f"must leave the temperature of the water between {freezing} and {boiling} K"


@relation
def uncertain_contact_angles_leave_water(config):
    """Require the same answer on condensation one standard uncertainty around the contact angles."""
    key = "uncertainty.contact_angle_deg"
    for name, deviation in config.entries("devices", key):
        meeting = device_meeting(name, config)
        if meeting.wetting() and not meeting.wetting(deviation):
            message = "must leave contact angles at which water condenses: their cosines must add up to more than zero"
            yield f"devices.{name}.{key}", message, *_keys_of_scans(config, name)
        if not meeting.is_wetted and meeting.wetting(-deviation):
            message = "must leave contact angles at which no water condenses: their cosines add up to zero or less"
            yield f"devices.{name}.{key}", message, *_keys_of_scans(config, name)


@relation
def uncertainties_are_those_of_the_kind(config):
    """Require uncertain dimensions to be dimensions of the device."""
    for name, uncertainty, kind in config.entries("devices", "uncertainty", "kind"):
        if strange := set(KEYS) & set(uncertainty) - set(KINDS[kind].keys):
            message, other = f"must come without {', '.join(sorted(strange))}", f"devices.{name}.kind"
            yield f"devices.{name}.uncertainty", message, other


def _material(config, name):
    """Properties of the material of the beam or stopper of a device."""
    beam, _ = surfaces_of(config["devices"][name]["pair"], config)
    return config["solid"] | material_of(config["materials"], config["surfaces"][beam])


def _keys_of_scans(config, name):
    """Keys of the measured surfaces of a device."""
    return config.scanned(*surfaces_of(config["devices"][name]["pair"], config))


# How rough it must be


@relation
def requirements_and_roughnesses_come_together(config):
    """Require a requirement with a roughness or a process. Both are compared along surfaces."""
    for stated, others in (
        ("requirement", ("roughness", "process")),
        ("roughness", ("requirement",)),
        ("process", ("requirement",)),
        ("second_process", ("process",)),
    ):
        for name, _ in config.entries("devices", stated):
            if not set(others) & set(config.names(f"devices.{name}")):
                hint = "; design.shares has the fractions of all answers" if stated == "requirement" else ""
                yield f"devices.{name}.{stated}", f"must come with {' or '.join(others)}{hint}"


@relation
def requirements_are_those_of_the_kind(config):
    """Require a length of a beam, and a restoring force of a stopper."""
    for name, requirement, kind in config.entries("devices", "requirement", "kind"):
        if set(requirement) - {"share"} != set(KINDS[kind].release.required):
            yield f"devices.{name}.requirement", KINDS[kind].release.refusal, f"devices.{name}.kind"


@relation_of_names
def varied_surfaces_are_in_the_pair(config):
    """Require one or two varied quantities, of a surface of the pair."""
    for name, roughness, pair in config.entries("devices", "roughness", "pair"):
        stated = [key for key in ROUGHNESSES if key in roughness]
        if len(stated) not in (1, 2):
            message = f"must have one or two of {', '.join(ROUGHNESSES)}, and has {', '.join(stated) or 'none'}"
            yield f"devices.{name}.roughness", message
        if roughness["surface"] not in (sides := surfaces_of(pair, config)):
            message = f"must be a surface of pair {pair}, {' or '.join(dict.fromkeys(sides))}"
            yield f"devices.{name}.roughness.surface", message, f"devices.{name}.pair"


@relation_of_names
def varied_replicas_are_stated(config):
    """Require a pair with a replica for a range of its coherence or play."""
    for key in (key for key, quantity in ROUGHNESSES.items() if quantity.of_replica):
        for name, _, pair in config.entries("devices", f"roughness.{key}", "pair"):
            if "replica" not in config["pairs"].get(pair, {}):
                message = f"must be left out, because pair {pair} has no replica; state replica: {{coherence: 0}}"
                yield f"devices.{name}.roughness.{key}", message, f"devices.{name}.pair"


@relation_of_names
def varied_skewnesses_are_those_of_moments(config):
    """Require heights by their moments for a range of the skewness."""
    for name, surface, _ in config.entries("devices", "roughness.surface", "roughness.skewness"):
        if config["surfaces"][surface].get("heights") == "measured":
            message = f"must be left out: surface {surface} has the measured form of its heights"
            yield f"devices.{name}.roughness.skewness", message


@relation
def varied_skewnesses_have_a_density(config):
    """Require a density at both ends of the skewness, at the kurtosis of the surface or less."""
    for name, ends, surface in config.entries("devices", "roughness.skewness", "roughness.surface"):
        key, section = f"devices.{name}.roughness.skewness", config["surfaces"][surface]
        for skewness in ends if "kurtosis" in section else ():
            kurtosis = min(section["kurtosis"], largest_kurtosis(abs(skewness)))
            if refusal := without_density(skewness, kurtosis):
                message = f"must have densities at both ends: at {skewness:g} the kurtosis of {surface} {refusal}"
                yield key, message, *config.scanned(surface)


@relation
def varied_corners_are_those_of_spectra(config):
    """Require corners below the cut-off, and patches wide enough for the lowest one, at the same slope."""
    for name, ends, surface in config.entries("devices", "roughness.corner_rad_per_um", "roughness.surface"):
        key, section = f"devices.{name}.roughness.corner_rad_per_um", config["surfaces"][surface]
        if section.get("psd") != "published":
            continue
        psd, (low, high) = section["published_psd"], ends
        cutoff, plateau = psd["cutoff_rad_per_um"], psd["plateau_nm4"]
        if is_at_most(cutoff, high):
            yield key, f"must be below the cut-off of surface {surface}, {cutoff:g} rad/µm", *config.scanned(surface)
            continue
        slope = math.log(psd["floor_nm4"] / plateau) / math.log(cutoff / psd["corner_rad_per_um"])
        longest = psd | {"corner_rad_per_um": low, "floor_nm4": plateau * (cutoff / low) ** slope}
        if refusal := correlated(config["sampling.margin_um"], longest):
            message = f"must be larger at {low:g} rad/µm, where sampling.margin_um {refusal}"
            yield key, message, "sampling.margin_um", *config.scanned(surface)


# Test beams, for which the relations of devices hold as well: see stiction.config.validation


@relation_of_names
def arrays_of_devices_are_defined(config):
    """Require existing test beams for a device, each once."""
    arrays = config.names("test_beams")
    for name, used in config.entries("devices", "test_beams"):
        if unknown := [array for array in used if array not in arrays]:
            defined = ", ".join(arrays) or "the arrays of section test_beams"
            yield f"devices.{name}.test_beams", f"must be among {defined}: {unknown[0]} is not there"
        elif len(set(used)) < len(used):
            yield f"devices.{name}.test_beams", "must contain each array once"


@relation
def arrays_have_the_materials_of_their_devices(config):
    """Require test beams of the materials of their device."""
    for name, used in config.entries("devices", "test_beams"):
        materials = _names_of_materials(config, config["devices"][name]["pair"])
        if other := next(
            (array for array in used if _names_of_materials(config, pair_of(config, array)) != materials), None
        ):
            message = f"must have the materials of the device: those of {other} differ"
            yield f"devices.{name}.test_beams", message, *_keys_of_scans(config, name)


def _names_of_materials(config, pair):
    """Names of the materials of both sides of a pair, None if not stated."""
    return [config["surfaces"][surface].get("material") for surface in surfaces_of(pair, config)]


@relation
def devices_with_common_test_beams_share_their_uncertainties(config):
    """Require equal uncertainties of inputs common to test beams and devices. They are one variable."""
    devices = config["devices"]
    for name, used in config.entries("devices", "test_beams"):
        for other, section in devices.items():
            common = [array for array in used if array in section.get("test_beams", ())]
            if common and not agree(section, devices[name]):
                message = (
                    f"must not share {common[0]} with {other}, which states other uncertainties: apart from those of "
                    "their dimensions, both must be the same"
                )
                yield f"devices.{name}.test_beams", message
                break


def agree(*devices: Mapping) -> bool:
    """Whether devices have the same uncertainties of shared inputs. Some have no edge of a tip, or dry air alone."""
    left_out = set() if all(kind_of(device).has_tip for device in devices) else {EDGE_RADIUS.key}
    left_out |= set() if all(humid(device["humidities"]) for device in devices) else {"humidity"}
    shared = [shared_uncertainty(device).items() for device in devices]
    first, second = ({key: value for key, value in stated if key not in left_out} for stated in shared)
    return first == second


@relation_of_names
def arrays_have_data(config):
    """Require crack lengths or counts of each array."""
    for name, _ in config.entries("test_beams", "pair"):
        if not set(DATA) & set(config.names(f"test_beams.{name}")):
            yield f"test_beams.{name}.pair", f"must come with {', '.join(DATA)} or file"


@relation
def measured_beams_have_a_length(config):
    """Require one length of beams with crack lengths. Counted beams have their own."""
    for name, _ in config.entries("test_beams", "crack_lengths"):
        if "length_um" not in config.names(f"test_beams.{name}"):
            yield f"test_beams.{name}.crack_lengths", "must come with length_um, the length of the beams"


@relation
def crack_lengths_have_one_mean_at_a_humidity(config):
    """Require one mean of all beams of an array measured at a humidity."""
    for name, data in config.entries("test_beams", "crack_lengths"):
        yield f"test_beams.{name}.crack_lengths", repeated([datum["humidity"] for datum in data])


@relation
def cracks_end_on_the_beams(config):
    """Require mean crack lengths below the length of the beams, and a measurable scatter below the mean."""
    for array, key, datum, length in _data(config, "crack_lengths", "length_um"):
        if datum["mean_um"] >= length:
            yield f"{key}.mean_um", "must be below the length of the beams", f"{array}.length_um"
        if datum["std_um"] >= datum["mean_um"]:
            yield f"{key}.std_um", "must be below the mean", f"{key}.mean_um"
        if datum["std_um"] < LEAST_SCATTER * datum["mean_um"]:
            message = f"must be at least {LEAST_SCATTER:g} of the mean: no measured cracks differ by less"
            yield f"{key}.std_um", message, f"{key}.mean_um"


@relation
def test_beams_are_slender(config):
    """Require cracks and counted beams longer than thickness and deflection. Lengths in mm are not."""
    sizes = "thickness_um", "gap_um"
    for kind, length in (("crack_lengths", "mean_um"), ("stuck", "length_um")):
        for array, key, datum, *values in _data(config, kind, *sizes):
            if datum[length] <= max(values):
                message = "must be in µm, above the thickness and the gap of the beams"
                yield f"{key}.{length}", message, *(f"{array}.{size}" for size in sizes)


def _data(config, kind, *keys):
    """Keys of the arrays and of their data of one kind, the data, and the values of other keys of their arrays."""
    for name, data, *values in config.entries("test_beams", kind, *keys):
        array = f"test_beams.{name}"
        yield from ((array, f"{array}.{kind}.{k}", datum, *values) for k, datum in enumerate(data))


@relation
def counts_are_parts_of_all_beams(config):
    """Require no more stuck beams than beams."""
    for _, key, datum in _data(config, "stuck"):
        if datum["stuck"] > datum["of"]:
            yield f"{key}.stuck", "must be no more than there are beams", f"{key}.of"


@relation
def beams_are_counted_once(config):
    """Require each group of beams to be counted once."""
    for name, data in config.entries("test_beams", "stuck"):
        for length, humidity in duplicates((datum["length_um"], datum["humidity"]) for datum in data):
            group = f"beams of {length:g} µm {Air(humidity).where}"
            yield f"test_beams.{name}.stuck", f"must count each length at a humidity once: {group} are listed twice"


# Sizes: the parts of a device fit together, and its uncertain inputs stay possible


@relation
def tilted_stoppers_fit_into_their_gap(config):
    """Require both ends of a tilted stopper within the gap: the higher end is not above its place at rest."""
    for name, tilts, sides, gap in config.entries("devices", "tilt_deg", "contact_um", "gap_um"):
        rise = sides[0] * math.sin(math.radians(max(tilts)))
        if rise > gap:
            steepest = math.degrees(math.asin(gap / sides[0]))
            message = (
                f"must leave both ends within the gap, at most {steepest:.3g}: at {max(tilts):g}° one end is "
                f"{rise:.3g} µm above the other"
            )
            yield f"devices.{name}.tilt_deg", message, f"devices.{name}.gap_um", f"devices.{name}.contact_um"


@relation
def dimples_have_room(config):
    """Require dimples side by side in their row, rows apart from each other, and both on the beam."""
    for name, dimples, width in config.entries("devices", "dimples", "width_um"):
        key = f"devices.{name}.dimples"
        along, across = _along_and_across(dimples, width)
        if dimples["number"] * across > width:
            message = (
                f"must leave {dimples['number']} dimples side by side on the width of the beam, sides of at most "
                f"{width / dimples['number']:.3g} µm"
            )
            yield f"{key}.contact_um", message, f"{key}.number", f"devices.{name}.width_um"
        rows = dimples["at_um"]
        if any(0 < high - low < along for low, high in zip(rows, rows[1:], strict=False)):
            message = f"must have rows at least {along:g} µm apart, a side of their dimples"
            yield f"{key}.at_um", message, f"{key}.contact_um"


def _along_and_across(dimples, width):
    """Sides of a dimple along and across the beam: the longer one lies across where all of a row have room then."""
    short, long = sorted(dimples["contact_um"])
    return (short, long) if dimples["number"] * long <= width else (long, short)


@relation
def dimples_are_whole_on_their_beam(config):
    """Require the first and the last row with half a side of a dimple between them and the ends of the beam."""
    for name, dimples, width, length in config.entries("devices", "dimples", "width_um", "length_um"):
        rows, key = dimples["at_um"], f"devices.{name}.dimples"
        half = _along_and_across(dimples, width)[0] / 2
        if max(rows) < length and not half <= min(rows) <= max(rows) <= length - half:
            message = f"must leave whole dimples on the beam, between {half:g} and {length - half:g} µm"
            yield f"{key}.at_um", message, f"{key}.contact_um", f"devices.{name}.length_um"


@relation
def strips_are_parts_of_their_beam(config):
    """Require strips no longer than the beam."""
    for name, strip, length in config.entries("devices", "strip_um", "length_um"):
        if strip > length:
            yield f"devices.{name}.strip_um", "must be at most the length of the beam", f"devices.{name}.length_um"


@relation
def dielectrics_fit_into_the_gap(config):
    """Require layers thinner than the gap: closed forms of voltages have the electrode at the distance of the gap."""
    for name, thickness, gap in config.entries("devices", "dielectric.thickness_nm", "gap_um"):
        if thickness >= gap * NM_PER_UM:
            message = f"must be below the gap, {gap * NM_PER_UM:g} nm: voltages act across gap_um, with the layer in it"
            yield f"devices.{name}.dielectric.thickness_nm", message, f"devices.{name}.gap_um"


@relation
def films_stand_their_stress(config):
    """Require a stress below Young's modulus, a strain below 1."""
    for name, stress, _ in config.entries("devices", "residual_stress_MPa", "pair"):
        modulus = from_si(to_si(_material(config, name)["young_modulus_GPa"], "GPa"), "MPa")
        if stress >= modulus:
            message = f"must be below Young's modulus of the beam, {modulus:g} MPa"
            yield f"devices.{name}.residual_stress_MPa", message, f"devices.{name}.pair"


@relation
def uncertain_stresses_are_tensile(config):
    """Require a tensile stress one standard uncertainty below its value, too. Compression is not in the model."""
    key = "residual_stress_MPa"
    for name, deviation, stress in config.entries("devices", f"uncertainty.{key}", key):
        if deviation > stress:
            message = "must be at most the stress itself: compression is not in the model"
            yield f"devices.{name}.uncertainty.{key}", message, f"devices.{name}.{key}"


@relation
def gaps_are_far_above_varied_surfaces(config):
    """Require the gap far above the film and the roughest surface of a range, as above the given one."""
    for name, key, surface, rms in _varied_surfaces(config):
        device = config["devices"][name]
        least, refusal = least_gap(device["humidities"], with_rms(config, name, {surface: rms}))
        if device.get("gap_um", math.inf) < least:
            message = f"must leave a gap at the rms of {rms:g} nm, where gap_um {refusal}"
            yield f"devices.{name}.{key}", message, f"devices.{name}.gap_um", f"devices.{name}.humidities"


def _varied_surfaces(config):
    """Devices over a range of surfaces: name, key of the range, surface, and its largest rms [nm]."""
    for name, ends, surface in config.entries("devices", "roughness.rms_nm", "roughness.surface"):
        yield name, "roughness.rms_nm", surface, ends[1]
    for key in ("process", "second_process"):
        for name, process in config.entries("devices", key):
            surfaces = process_surfaces.names(config.config, process)
            largest = max(config["surfaces"][at]["rms_nm"] for at in surfaces)
            yield name, key, config["process"][process]["surface"], largest


@relation_of_tips
def edges_are_within_their_tips(config):
    """Require the radius of a rounded edge up to the thickness of every tip that may touch."""
    if config["design.tip_edge"] == Edge.SQUARE:
        return
    key, radius = "design.edge_radius_um", config["design.edge_radius_um"]
    kinds = config.entries("devices", "kind", "thickness_um")
    tips = {f"devices.{name}.thickness_um": thickness for name, kind, thickness in kinds if KINDS[kind].has_tip}
    for name, thicknesses in config.entries("devices", "chart.thicknesses_um"):
        if f"devices.{name}.thickness_um" in tips:
            tips[f"devices.{name}.chart.thicknesses_um"] = min(thicknesses)
    for name, _, thickness in config.entries("test_beams", "stuck", "thickness_um"):
        tips[f"test_beams.{name}.thickness_um"] = thickness
    thinnest = min(tips, key=tips.get, default=None)
    if thinnest and radius > tips[thinnest]:
        yield key, f"must be at most the thickness of every tip, {tips[thinnest]:g} µm, or 0 for a sharp edge", thinnest
