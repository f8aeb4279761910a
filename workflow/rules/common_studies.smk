"""What the rules of the studies beside the main line share."""

from stiction.studies import sensitivity

STUDIES = config["studies"]
CONTACT = {key: value for key, value in config["contact"].items() if key not in ("chunks", "samples")}
PRESSED_PAIRS = [pair for pair in PAIRS if pair in STUDIES["plasticity"]["distance_nm"]]
# Section of the configuration in which a reading changes a key; the source of the spectra stands with each surface.
CHANGED = {"van_der_waals": None, "psd": None, "every": "contact", "spacing_nm": "sampling", "poisson_ratio": "solid"}
READINGS = {"base": {}} | {
    f"{key}_{value}": {part: {key: value}} if part else {key: value}
    for key, part in CHANGED.items()
    for value in STUDIES["readings"][key]
}
# A finer beam meets the same surfaces.
FINER = {
    f"strips_per_element_{strips}": {
        "elements": round(config["beam"]["length_um"] / (STRIP["strip_length_um"] * strips))
    }
    for strips in STUDIES["readings"]["strips_per_element"]
}
READINGS |= {
    reading: {"beam": mesh} for reading, mesh in FINER.items() if mesh["elements"] != config["beam"]["elements"]
}


def can_be_shifted(moment):
    """Whether the surface of Figure 13 exists with a little less and a little more of a moment."""
    shape = chosen(config["surfaces"][FIGURE_SURFACE], ("skewness", "kurtosis"))
    at = sensitivity.shifted(shape[moment], STUDIES["sensitivity"]["step"])
    return at[0] * at[1] > 0 and not any(settings.heights_have_a_density(**shape | {moment: value}) for value in at)


SHIFTED = ["rms", *filter(can_be_shifted, ("skewness", "kurtosis"))]


def sides_of(pair):
    """Names of the surfaces of a pair, the beam's first."""
    return [config["pairs"][pair][side] for side in SIDES]


def psd_under(reading, surface):
    """Source of the spectrum of a surface under a reading: the one it asks for, where that is known."""
    entry = config["surfaces"][surface]
    known = {"published": "published_psd" in entry, "identified": surface in MEASURED}
    wanted = READINGS[reading].get("psd", entry["psd"])
    return wanted if known[wanted] else entry["psd"]


def surface_under(reading, surface):
    """What a surface is drawn from under a reading."""
    psd = psd_under(reading, surface)
    used = [*MOMENTS, "published_psd"] if psd == "published" else MOMENTS
    return chosen(config["surfaces"][surface], used) | {"psd": psd}


def reading_contact_settings(pair, reading):
    """What the contact of a pair under a reading starts from, and what the reading changes."""
    base = section(
        "seed",
        "sampling",
        "solid",
        "van_der_waals",
        contact=CONTACT | {"samples": STUDIES["readings"]["samples"]},
        beam=chosen(config["beam"], ["width_um"]),
        pairs={pair: chosen(config["pairs"][pair], SIDES)},
        surfaces={name: surface_under(reading, name) for name in sides_of(pair)},
    )
    changes = {key: change for key, change in READINGS[reading].items() if key != "psd"}
    identified = sorted(name for name, entry in base["surfaces"].items() if entry["psd"] == "identified")
    return {"base": base, "changes": changes, "identified": identified}


def under(pair, reading):
    """Settings of a pair as a reading changes them."""
    found = reading_contact_settings(pair, reading)
    return keys.merged(found["base"], found["changes"])


# What a reading leaves as it is stands with the base.
STUDIED = [
    (pair, reading)
    for pair in PAIRS
    for reading in READINGS
    if reading == "base" or under(pair, reading) != under(pair, "base")
]


def contact_of_reading(wildcards):
    """Contact under a reading."""
    reading = "base" if wildcards.reading in FINER else wildcards.reading
    return f"results/studies/readings/contact/{wildcards.pair}_{reading}.nc"


def reading_settings(wildcards):
    """What follows the contact under a reading: water, force laws and beams without scatter, at all humidities."""
    found = section("seed", "water", "chaos", **cantilever_settings(wildcards.pair), sampling=STRIP)
    found["beam"] |= {"samples": STUDIES["readings"]["beams"]} | FINER.get(wildcards.reading, {})
    found["pairs"][wildcards.pair] |= chosen(config["pairs"][wildcards.pair], ["humidities"])
    return found
