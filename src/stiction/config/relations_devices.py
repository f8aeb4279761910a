"""Relations between the keys of devices.

Lengths are in µm, as in the configuration. A relation gets the name of a device, and takes the rest from its section.
"""

from stiction.config import memory
from stiction.config.arrays import DATA, shared_uncertainty
from stiction.config.conditions import Relations
from stiction.config.designs import Designs, hamaker_constant
from stiction.config.kinds import COMMON, KEYS, KINDS, kind_of
from stiction.config.relations import (
    cases_have_unique_names,
    coatings_leave_a_gap,
    estimated_strip,
    field_too_large,
    length_can_exceed_the_correlation,
    length_exceeds_the_correlation,
    name_is_defined,
    not_apart,
    schema,
    sides_of,
    solids_resist_the_adhesion,
    strip_is_whole_on_the_grid,
    too_dry,
    too_few_summits,
    wetting,
)
from stiction.config.units import NM_PER_UM
from stiction.devices.materials import OF_CONTACT
from stiction.models import SIDES

#: Relations between the keys of devices.
relation = Relations()

#: What a relation about the humidities of a device needs: its name, all devices and the surfaces that meet.
_MEETING = ("devices.*.@", "devices", "pairs", "surfaces", "materials", "water.temperature_K")

relation("devices.*.pair", "pairs.#")(name_is_defined)
relation("devices.*.humidities")(cases_have_unique_names)
relation("devices.*.strip_um", "sampling.spacing_nm", "contact.every")(strip_is_whole_on_the_grid)
relation("devices.*.width_um", "sampling.spacing_nm", "contact.every")(strip_is_whole_on_the_grid)


@relation(
    "devices.*.kind", "devices.*.@", "devices", "sampling.strip_length_um", "sampling.spacing_nm", "contact.every"
)
def strips_of_a_bridge_are_whole_on_the_grid(kind, name, devices, strip, spacing, every):
    """Strips at the middle of a bridge are whole on the grid also if their length is not stated."""
    if not KINDS[kind].has_short_strips or "strip_um" in devices[name]:
        return None
    refusal = strip_is_whole_on_the_grid(KINDS[kind].strip(devices[name], strip), spacing, every)
    short = KINDS[kind].longest_strip
    return refusal and f"must come with strip_um, because {short} µm are not whole on the grid: it {refusal}"


@relation("devices.*.kind", "devices.*.#")
def device_has_the_keys_of_its_kind(kind, keys):
    """A device has all keys that its kind needs, and no key of another kind."""
    needed = set(KINDS[kind].keys)
    missing, strange = needed - set(keys), set(keys) - needed - set(KINDS[kind].optional) - COMMON
    if missing:
        return f"must come with {', '.join(sorted(missing))}"
    return f"must come without {', '.join(sorted(strange))}" if strange else None


@relation("devices.*.contact_um", "sampling.spacing_nm", "contact.every")
def patch_of_a_stopper_is_whole_on_the_grid(sides, spacing, every):
    """Both sides of the area of a stopper are multiples of the distance between contact points."""
    refusals = (strip_is_whole_on_the_grid(side, spacing, every) for side in sides)
    return next(filter(None, refusals), None)


@relation("contact.asperity", "devices.*.pair")
def asperities_of_devices_are_summits(asperity, _):
    """The tips of beams and the budgets of devices are computed with summits."""
    return None if asperity == "summit" else "must be summit, or the devices left out: their contact has summits"


#: What the relations about them need apart from the sides of a patch.
_GROUND = ("devices.*.@", "devices", "pairs", "surfaces")


@relation("devices.*.width_um", *_GROUND, "sampling.strip_length_um")
def strips_hold_enough_summits(width, name, devices, pairs, surfaces, length):
    """The strips along a beam hold so many summits that each sample resists the adhesion."""
    return _too_few_summits(kind_of(devices[name]).strip(devices[name], length), width, devices[name], pairs, surfaces)


@relation("devices.*.contact_um", *_GROUND)
def patch_of_a_stopper_holds_enough_summits(sides, name, devices, *surfaces):
    """As above, for the area of a stopper."""
    return _too_few_summits(*sides, devices[name], *surfaces)


def _too_few_summits(length, width, device, pairs, surfaces):
    """Refusal of a patch [µm] of a device that holds too few summits."""
    return too_few_summits(length, width, device["pair"], _sides(device, pairs, surfaces))


@relation(
    "devices.*.gap_um",
    "devices.*.@",
    "devices",
    "pairs",
    "surfaces",
    "materials",
    "solid",
    "water",
    "sampling",
    "contact",
)
def tips_fit_into_memory(_, name, devices, *sections):
    """The fields of the strips that hold the tips of a cantilever fit into the memory of a job."""
    if not kind_of(devices[name]).has_tip:
        return None
    keys = ("pairs", "surfaces", "materials", "solid", "water", "sampling", "contact")
    config = {"devices": devices} | dict(zip(keys, sections, strict=True))
    margin, spacing = (config["sampling"][key] for key in ("margin_um", "spacing_nm"))
    try:
        length, width = (side / NM_PER_UM for side in Designs(config).tips(name)[1:])
    except (KeyError, ValueError, ArithmeticError):
        return None  # other relations report what is missing or out of range
    if length <= config["sampling"]["strip_length_um"]:
        return None  # as for the strips along the beam, of which another relation reports
    refusal = field_too_large(length + margin, width + margin, spacing)
    return refusal and f"{refusal}; the wedge at the tip of a beam is the longer, the smaller the gap"


@relation("design.worst_humidities")
@relation("devices.*.chart.humidities")
@relation("devices.*.chart.thicknesses_um")
@relation("devices.*.chart.gaps_um")
def axis_increases(values):
    """Values along an axis increase."""
    increasing = all(low < high for low, high in zip(values, values[1:], strict=False))
    return None if increasing else "must be in increasing order, each value once"


@relation("devices.*.gap_um", "devices.*.humidities", *_MEETING)
def device_is_apart_from_the_film(gap, humidities, name, devices, pairs, surfaces, materials, temperature):
    """The gap of a device is far above the film of water and the peaks, as for pairs."""
    return not_apart(gap, humidities, temperature, _sides(devices[name], pairs, surfaces), materials)


@relation("devices.*.gap_um", "devices.*.@", "devices", "pairs", "surfaces", "materials")
def coatings_leave_a_gap_of_a_device(gap, name, devices, pairs, *bodies):
    """Both coatings together are thinner than the gap of a device, as for pairs."""
    pair = pairs.get(devices[name]["pair"], {})
    return coatings_leave_a_gap(gap, *map(pair.get, SIDES), *bodies)


@relation("devices.*.gap_um", "devices.*.chart.humidities", *_MEETING)
def charted_device_is_apart_from_the_film(gap, humidities, name, devices, *meeting):
    """As above, along the axis of a chart without gaps of its own."""
    if "gaps_um" in devices[name]["chart"]:
        return None
    return device_is_apart_from_the_film(gap, humidities, name, devices, *meeting)


@relation("devices.*.chart.gaps_um", "devices.*.chart.humidities", *_MEETING)
def charted_gaps_are_apart_from_the_film(gaps, humidities, *meeting):
    """As above, for the smallest gap of a chart."""
    return device_is_apart_from_the_film(gaps[0], humidities, *meeting)


@relation("devices.*.humidities", *_MEETING)
@relation("devices.*.chart.humidities", *_MEETING)
def water_of_a_device_is_a_liquid(humidities, name, devices, pairs, surfaces, materials, temperature):
    """The air is not too dry for a film of liquid water, at the humidities of a device and along its chart."""
    return too_dry(humidities, temperature, _sides(devices[name], pairs, surfaces), materials)


@relation("design.worst_humidities", *_MEETING)
def water_of_a_stopper_is_a_liquid(humidities, name, devices, *meeting):
    """As above, along the axis on which the worst humidity of a stopper is sought."""
    if kind_of(devices[name]).is_beam:
        return None
    return water_of_a_device_is_a_liquid(humidities, name, devices, *meeting)


@relation("devices.*.uncertainty.humidity", "devices.*.humidities", *_MEETING)
def water_at_an_uncertain_humidity_is_a_liquid(deviation, humidities, *meeting):
    """As above, one standard uncertainty below the humidities, too."""
    driest = min(humidities) - deviation
    return _too_dry(driest, humidities, *meeting) if driest > 0 else None  # otherwise another relation reports it


@relation("devices.*.uncertainty.temperature_K", "devices.*.humidities", *_MEETING)
def water_at_an_uncertain_temperature_is_a_liquid(deviation, humidities, *meeting):
    """As above, one standard uncertainty above the temperature, too."""
    if water_stays_liquid(deviation, meeting[-1]):
        return None
    return _too_dry(min(humidities), humidities, *meeting, warmer=deviation)


@relation("devices.*.uncertainty.contact_angle_deg", "devices.*.humidities", *_MEETING)
def water_at_uncertain_contact_angles_is_a_liquid(deviation, humidities, *meeting):
    """As above, one standard uncertainty above the contact angles, too."""
    return _too_dry(min(humidities), humidities, *meeting, more=deviation)


def _too_dry(driest, humidities, name, devices, pairs, surfaces, materials, temperature, warmer=0, more=0):
    """Refusal of an uncertainty with which the air is too dry, unless it is so without; in K and degrees."""
    sides = _sides(devices[name], pairs, surfaces)
    if too_dry(humidities, temperature, sides, materials):
        return None
    refusal = too_dry(driest, temperature + warmer, sides, materials, more)
    return f"must leave water that is a liquid: the humidity, {driest:g}, {refusal}" if refusal else None


#: What it takes to resolve a crack.
_RESOLVING = (*_MEETING, "solid", "van_der_waals", "sampling.strip_length_um")


@relation("devices.*.thickness_um", "devices.*.humidities", *_RESOLVING)
def strips_resolve_the_cracks_of_a_device(
    thickness, humidities, name, devices, pairs, surfaces, materials, temperature, solid, medium, strip
):
    """Strips are short enough for the force laws of a device, as far as they can be estimated without its contact.

    What passes may still be refused after the contact, by `stiction.beam.resolution.resolved`.
    """
    strip, sides = kind_of(devices[name]).strip(devices[name], strip), _sides(devices[name], pairs, surfaces)
    meeting = temperature, sides, materials
    needed = {rh: estimated_strip(thickness, solid, medium, rh, *meeting) for rh in humidities} if sides else {}
    shortest = min(needed, key=needed.get, default=None)
    if shortest is None or strip <= needed[shortest]:
        return None
    return (
        f"must be so large that strips of {strip:g} µm resolve its cracks: at RH {shortest:g} they must be below "
        f"about {needed[shortest]:.2g} µm; decrease strip_um, which must stay above the correlation length"
    )


@relation("devices.*.chart.thicknesses_um", "devices.*.chart.humidities", *_RESOLVING)
def strips_resolve_the_thinnest_beam_of_a_chart(thicknesses, humidities, *meeting):
    """As above, for the thinnest beam of a chart."""
    return strips_resolve_the_cracks_of_a_device(thicknesses[0], humidities, *meeting)


@relation("devices.*.strip_um", "devices.*.kind", "devices.*.pair", "pairs", "surfaces", "character.spacing_nm")
def strips_of_a_device_exceed_the_correlation(strip, kind, pair, pairs, surfaces, spacing):
    """Strips are independent samples; those of tips, which are never next to each other, may be shorter.

    So may those of bridges: force laws of neighbouring strips of 0.25 and 0.5 µm correlate by less than 0.05 on pair b.
    """
    if KINDS[kind].has_short_strips:
        return None
    for side in _sides({"pair": pair}, pairs, surfaces):
        target = side["rms_nm"], side.get("mean_summit_radius_um"), side.get("summit_density_per_um2"), spacing
        if side["psd"] == "published":
            refusal = length_exceeds_the_correlation(strip, side["published_psd"])
        else:
            refusal = length_can_exceed_the_correlation(strip, "identified", *target)
        if refusal:
            return refusal
    return None


@relation("devices.*.pair", *_MEETING, "solid", "van_der_waals", "design.worst_humidities")
def solids_resist_the_adhesion_of_a_device(
    pair, name, devices, pairs, surfaces, materials, temperature, solid, medium, worst
):
    """As for pairs that run, at the humidities of a device, and at those among which its worst one is sought."""
    device = devices[name]

    def refusal(humidities):
        met = {name: section | {"humidities": humidities} for name, section in pairs.items() if name == pair}
        return solids_resist_the_adhesion(pair, met, surfaces, solid, medium, temperature, humidities[0], materials)

    stated = refusal([*device["humidities"], *device.get("chart", {}).get("humidities", ())])
    if stated or kind_of(device).is_beam:
        return stated
    sought = refusal(worst)
    return f"{sought} in design.worst_humidities" if sought else None


@relation("devices.*.width_um", "devices.*.@", "devices", "sampling", "studies.variants.spacing_nm")
@relation("devices.*.contact_um", "devices.*.@", "devices", "sampling", "studies.variants.spacing_nm")
def device_fits_into_memory(_, name, devices, sampling, of_variants):
    """The fields from which a patch of surface is cut fit into the memory of a job."""
    device, margin = devices[name], sampling["margin_um"]
    if not set(kind_of(device).keys) <= set(device):
        return None
    length, width = memory.patch_of(device, sampling)
    spacings = memory.spacings_of(device, sampling["spacing_nm"], of_variants)
    return next(filter(None, (field_too_large(length + margin, width + margin, at) for at in spacings)), None)


@relation("devices.*.uncertainty.thickness_um", "devices.*.thickness_um")
@relation("devices.*.uncertainty.gap_um", "devices.*.gap_um")
def dimension_stays_positive(deviation, value):
    """A dimension is positive one standard uncertainty below its value, too."""
    return None if deviation < value else "must be below the dimension itself"


#: What the relations about uncertain properties of the material of a beam need.
_MATERIAL = (*_GROUND, "materials", "solid")


@relation("devices.*.uncertainty.young_modulus_GPa", *_MATERIAL)
def uncertain_modulus_stays_positive(deviation, *known):
    """Young's modulus is positive one standard uncertainty below its value, too."""
    value = _material(*known)["young_modulus_GPa"]
    return None if deviation < value else f"must be below Young's modulus itself, {value:g} GPa"


@relation("devices.*.uncertainty.poisson_ratio", *_MATERIAL)
def uncertain_poisson_ratio_stays_within_its_limits(deviation, *known):
    """Poisson's ratio is possible one standard uncertainty, and one step of its slope, around its value, too."""
    value, change = _material(*known)["poisson_ratio"], max(deviation, OF_CONTACT["poisson_ratio"].step.size)
    if not deviation or (value - change > -1 and value + change < 0.5):
        return None
    return f"must leave Poisson's ratio above -1 and below 0.5: its budget needs {value:g} ± {change:g}"


@relation("devices.*.uncertainty.hamaker_constant_zJ", *_MATERIAL, "van_der_waals")
def uncertain_hamaker_constant_stays_positive(deviation, *known):
    """The Hamaker constant is positive one standard uncertainty below its value, too."""
    value = hamaker_constant(_material(*known[:-1]), known[-1])
    return None if deviation < value else f"must be below the Hamaker constant itself, {value:g} zJ"


@relation("devices.*.uncertainty.hamaker_constant_zJ", "attraction.reach")
def uncertain_hamaker_constant_is_that_of_summits(deviation, reach):
    """The budget changes the Hamaker constant of the summits alone, and that across gaps would have to follow."""
    return "must be left out if attraction.reach is all" if deviation and reach == "all" else None


@relation("devices.*.uncertainty.humidity", "devices.*.humidities")
def uncertain_humidity_stays_within_its_limits(deviation, humidities):
    """Humidities are above 0 and below 1 one standard uncertainty around their values, too."""
    inside = min(humidities) - deviation > 0 and max(humidities) + deviation < 1
    return None if inside else "must leave the humidities above 0 and below 1"


@relation("devices.*.uncertainty.temperature_K", "water.temperature_K")
def water_stays_liquid(deviation, temperature):
    """Water is liquid one standard uncertainty around its temperature, too."""
    liquid = schema()["properties"]["water"]["properties"]["temperature_K"]
    freezing, boiling = liquid["minimum"], liquid["maximum"]
    inside = temperature - deviation >= freezing and temperature + deviation <= boiling
    return None if inside else f"must leave the temperature of the water between {freezing} and {boiling} K"


@relation("devices.*.uncertainty.contact_angle_deg", *_GROUND, "materials")
def uncertain_contact_angles_leave_water(deviation, name, devices, pairs, surfaces, materials):
    """Water condenses one standard uncertainty above the contact angles, too."""
    sides = _sides(devices[name], pairs, surfaces)
    if not wetting(sides, materials) or wetting(sides, materials, deviation):
        return None
    return "must leave contact angles at which water condenses: their cosines must add up to more than zero"


@relation("devices.*.uncertainty", "devices.*.kind")
def uncertainty_is_that_of_the_kind(uncertainty, kind):
    """Only dimensions that a device has are uncertain."""
    strange = set(KEYS) & set(uncertainty) - set(KINDS[kind].keys)
    return f"must come without {', '.join(sorted(strange))}" if strange else None


def _material(name, devices, pairs, surfaces, materials, solid):
    """Properties of the material of the beam or stopper of a device."""
    surface = surfaces.get(pairs.get(devices[name]["pair"], {}).get("beam"), {})
    return solid | materials.get(surface.get("material"), {})


def _sides(device, pairs, surfaces):
    """Sections of the surfaces of the pair of a device; empty if one is not defined, which another relation reports."""
    pair = pairs.get(device["pair"])
    return sides_of(*(pair[side] for side in SIDES), surfaces) if pair else []


# Test beams, for which the relations of devices hold as well: see stiction.config.validation


@relation("devices.*.test_beams", "test_beams.#")
def arrays_of_a_device_are_defined(names, arrays):
    """A device uses arrays that exist, each once."""
    unknown = [name for name in names if name not in arrays]
    if unknown:
        return f"must be among {', '.join(arrays) or 'the arrays of section test_beams'}: {unknown[0]} is not there"
    return None if len(set(names)) == len(names) else "must contain each array once"


@relation("devices.*.test_beams", "devices.*.@", "devices", "test_beams", "pairs", "surfaces")
def arrays_have_the_materials_of_the_device(names, device, devices, arrays, pairs, surfaces):
    """Properties of the solids of test beams are those of the device."""
    wanted = _names_of_materials(devices[device]["pair"], pairs, surfaces)
    for name in names:
        if name in arrays and _names_of_materials(arrays[name].get("pair"), pairs, surfaces) != wanted:
            return f"must have the materials of the device: those of {name} differ"
    return None


def _names_of_materials(pair, pairs, surfaces):
    """Names of the materials of both sides of a pair; None where not stated."""
    return [surfaces.get(pairs.get(pair, {}).get(side), {}).get("material") for side in SIDES]


@relation("devices.*.test_beams", "devices.*.@", "devices")
def devices_with_common_test_beams_share_their_uncertainties(names, device, devices):
    """What test beams and devices share is one variable, with one uncertainty."""
    own = shared_uncertainty(devices[device])
    for other, section in devices.items():
        common = [name for name in names if name in section.get("test_beams", ())]
        if common and shared_uncertainty(section) != own:
            return (
                f"must not share {common[0]} with {other}, which states other uncertainties: apart from those of their "
                "dimensions, both must be the same"
            )
    return None


@relation("test_beams.*.pair", "test_beams.*.#")
def arrays_have_data(_, keys):
    """Something was measured on an array."""
    return None if set(DATA) & set(keys) else f"must come with {', '.join(DATA)} or file"


@relation("test_beams.*.crack_lengths", "test_beams.*.#")
def measured_beams_have_a_length(_, keys):
    """Beams with crack lengths have one length; those that were counted state their own."""
    return None if "length_um" in keys else "must come with length_um, the length of the beams"


@relation("test_beams.*.crack_lengths")
def crack_lengths_have_one_mean_at_a_humidity(data):
    """All beams of an array that were measured at a humidity have one mean."""
    return cases_have_unique_names([datum["humidity"] for datum in data])


@relation("test_beams.*.crack_lengths", "test_beams.*.length_um")
def cracks_end_on_the_beam(data, length):
    """Mean crack lengths are shorter than the beams."""
    longer = next((datum for datum in data if datum["mean_um"] >= length), None)
    if longer is None:
        return None
    return (
        f"must have means below the length of the beams: that at RH {longer['humidity']:g} is {longer['mean_um']:g} µm"
    )


@relation("test_beams.*.stuck")
def counts_are_parts_of_all_beams(data):
    """No more beams stick than there are, and each group of beams is counted once."""
    for entry in data:
        group = f"beams of {entry['length_um']:g} µm at RH {entry['humidity']:g}"
        if entry["stuck"] > entry["of"]:
            return f"must count no more stuck beams than there are: {entry['stuck']} of {entry['of']} {group}"
        if sum((entry["humidity"], entry["length_um"]) == (one["humidity"], one["length_um"]) for one in data) > 1:
            return f"must count each length at a humidity once: {group} are listed twice"
    return None
