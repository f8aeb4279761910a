"""Memory of jobs: that draw surfaces, by their largest field; that hold the contact of all samples, by their number."""

import math
from collections.abc import Mapping, Sequence

from stiction.config.designs import OF_TIPS, Designs, strip_of
from stiction.config.units import NM_PER_UM, from_si
from stiction.models import FIELD, SIDES

#: Side of the periodic fields on which spectra are estimated [µm].
FIELD_UM = from_si(FIELD, "um")
#: Memory of a job: libraries and small arrays [MB]; fields, their waves and their spectra [bytes per point]. Measured:
#: 54 bytes per point of a field whose spectrum is estimated, up to 24 of one from which a strip is cut.
_BASE, _PER_POINT = 350, 60
#: Number of distances at which the contact of a pair is stored, in single precision, times their step over the sum of
#: both rms. Measured: 17 to 21 for the pairs of the paper.
_DISTANCES = 30
#: Memory that every job may use without a request [MB], and the most that a job may need.
USUAL, LARGEST = 800, 8000
#: Memory of an estimate from scans [bytes per point]: of the transforms, of the map with square pixels that is drawn,
#: of every scan. Measured: 694 MB for one scan of 2048² points with 38 wavelengths of the corner, 1134 MB for one of
#: 2048 x 256 points with 10, which are eight times as far apart in one direction.
_PER_TRANSFORMED_POINT, _PER_DRAWN_POINT, _PER_STORED_POINT = 75, 85, 12
#: Period of the transforms in wavelengths of the corner, least and largest number of its points;
#: `stiction.scans.model_scans`.
_PERIOD, _TRANSFORMED = 16, (512, 4096)


def of_field(length_um: float, width_um: float, spacing_nm: float) -> float:
    """Memory of a job that draws fields of this size on a grid of this spacing [MB].

    Examples
    --------
    >>> round(of_field(10.24, 10.24, 10))
    413
    """
    points = (NM_PER_UM * length_um / spacing_nm) * (NM_PER_UM * width_um / spacing_nm)
    return _BASE + from_si(_PER_POINT * points, "MB")


def of_samples(config: dict) -> int:
    """Memory to reserve for any job that holds the contact of all samples of a pair of a configuration [MB].

    The chunks are joined one at a time. Jobs of devices hold the contact of the tips of all beams as well.
    """
    contact, devices = config["contact"], config.get("devices", {}).values()
    running = _stored(config, config["run"]["pairs"]) * contact["samples"] * (1 + 1 / contact["chunks"])
    sticking = _stored(config, [device["pair"] for device in devices]) * contact["samples"]
    return max(USUAL, round(_BASE + max(running, sticking + _of_tip(config) * config["design"]["beams"])))


def _stored(config, pairs, tilt=None):
    """Contact of one sample of the roughest of some pairs, or of its tip at one slope [MB]; 0 without pairs."""
    rms = [[config["surfaces"][config["pairs"][pair][side]]["rms_nm"] for side in SIDES] for pair in pairs]
    reach, step = (tilt["reach_nm"], OF_TIPS) if tilt else (0, 1)
    heights = _DISTANCES * max(map(sum, rms), default=0) + reach
    return from_si(4 * heights / (step * config["contact"]["distance_step_nm"]), "MB")


def _of_tip(config):
    """Contact of the tip of one beam at all its slopes, the largest of all devices [MB]; 0 without cantilevers."""
    designs = Designs(config)
    tilts = {name: designs.tilt(designs.tips(name)) for name in designs.of_kind("cantilever")}
    found = (
        len(tilt["slopes"]) * _stored(config, [designs.devices[name]["pair"]], tilt) for name, tilt in tilts.items()
    )
    return max(found, default=0)


def patch_of(device: dict, sampling: dict) -> tuple[float, float]:
    """Sides of the patch of surface on which a device sticks [µm]; section of the device."""
    if device["kind"] == "stopper":
        return tuple(device["contact_um"])
    return strip_of(device, sampling["strip_length_um"]), device["width_um"]


def spacings_of(device: dict, spacing_nm: float, others_nm: Sequence[float]) -> tuple[float, ...]:
    """Distances of points at which the patch of a device is drawn [nm]; with an uncertainty, also those of variants."""
    return (spacing_nm, *others_nm) if "uncertainty" in device else (spacing_nm,)


def of_job(config: dict) -> int:
    """Memory to reserve for any job that draws surfaces of a configuration [MB]."""
    return max(USUAL, round(_of_largest_field(config)))


def of_drawn(config: dict, samples: float, contacts: int = 1) -> int:
    """Memory to reserve for any job that draws samples of a pair and holds one or more contacts of them [MB]."""
    return _of_drawn(config, samples * _stored(config, config["run"]["pairs"]), contacts)


def of_contact(config: dict, contacts: int = 1) -> int:
    """As `of_drawn`, for all samples or tips of a device."""
    pairs = [device["pair"] for device in config.get("devices", {}).values()]
    held = max(config["contact"]["samples"] * _stored(config, pairs), _of_change(config, pairs))
    return _of_drawn(config, held, contacts)


def _of_change(config, pairs):
    """Largest contact that shows what one changed input does to a device or to its tips [MB]."""
    samples = config["studies"]["slopes"]["samples"] * _stored(config, pairs)
    return max(samples, config["design"]["beams"] * _of_tip(config))


def _of_drawn(config, held, contacts):
    # The curves of the samples are collected before they become one array.
    return max(USUAL, round(_of_largest_field(config) + 2 * contacts * held))


def of_budget(config: dict, contacts: int) -> int:
    """Memory to reserve for the budget of a device, which compares this number of contacts [MB]."""
    pairs = [device["pair"] for device in config.get("devices", {}).values()]
    return of_samples(config) + round(contacts * _of_change(config, pairs))


def _of_largest_field(config):
    """Memory of a job that draws the largest of all fields [MB]."""
    sampling, patch = config["sampling"], config["identification"]["patch_um"]
    spacing, others, margin = sampling["spacing_nm"], config["studies"]["variants"]["spacing_nm"], sampling["margin_um"]
    drawn = [((FIELD_UM, FIELD_UM), spacing), ((patch, patch), spacing)]
    strip = sampling["strip_length_um"] + margin, config["beam"]["width_um"] + margin
    drawn += [(strip, at) for at in (spacing, *others)]
    designs = Designs(config)
    tips = [designs.tips(name) for name in designs.of_kind("cantilever")]
    drawn += [((tip.length / NM_PER_UM + margin, tip.width / NM_PER_UM + margin), spacing) for tip in tips]
    for device in designs.devices.values():
        length, width = patch_of(device, sampling)
        drawn += [((length + margin, width + margin), at) for at in spacings_of(device, spacing, others)]
    return max(of_field(*side, at) for side, at in drawn)


def of_estimate(found: Mapping, files: int) -> int:
    """Memory to reserve for the estimate of a surface from a number of scans [MB].

    Parameters
    ----------
    found : mapping
        Preliminary numbers of the surface, see `stiction.config.measured.evaluated`.
    files : int
        Number of scans.
    """
    points, pixel = found["points"], found["pixel_nm"]
    period = _PERIOD * 2 * math.pi / found["corner_rad_per_um"] * NM_PER_UM / min(pixel)
    transformed = min(max(period, _TRANSFORMED[0]), _TRANSFORMED[1]) ** 2
    drawn = math.prod(n * p / min(pixel) for n, p in zip(points, pixel, strict=True))
    stored = math.prod(points) * files
    of_arrays = _PER_TRANSFORMED_POINT * transformed + _PER_DRAWN_POINT * drawn + _PER_STORED_POINT * stored
    return max(USUAL, round(_BASE + from_si(of_arrays, "MB")))
