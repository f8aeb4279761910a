"""Grid of the drawn surfaces by default: as fine and as wide as the surfaces need.

The distance between heights is the largest whole part of 10 nm whose Nyquist wave number is not below the end of any
spectrum, or the smallest one whose fields take half of the memory of a job, which leaves room for longer tips. The
margin is 1 µm, or the smallest multiple of 0.5 µm above the correlation length of every surface. Only surfaces of pairs
that run, of devices and of test beams count. Those of the paper have the paper's grid.

What a configuration does not state fits the rest: the chaos model has the paper's order, or the largest one that the
samples carry; strips are whole on the grid, and fill the elements of the beam.
"""

import functools
import math
from collections.abc import Iterator, Mapping
from itertools import count
from typing import Any

from stiction.config import memory, scans
from stiction.config.kinds import kind_of
from stiction.config.merging import merged
from stiction.config.reading import is_stated
from stiction.config.surfaces import process
from stiction.config.units import NM_PER_UM, from_si, in_si
from stiction.models import SIDES
from stiction.rounding import is_at_most, is_multiple
from stiction.surface.spectrum import CutoffSelfAffine, correlation_length

#: Distance between heights [nm] and margin [µm] of the paper, and the steps of longer margins [µm].
_SPACING, _MARGIN, _STEP = memory.GRID["spacing_nm"], memory.GRID["margin_um"], 0.5
#: Decimals of chosen lengths in µm.
_PICOMETRES = 6


def completed(config: dict[str, Any], estimates: Mapping[str, dict]) -> dict[str, Any]:
    """Configuration with all keys of section ``sampling``, a chaos model, whole strips, and heights with a density.

    Variants on grids that are not finer than one that follows the surfaces, or whose fields do not fit into memory with
    a margin that does, are left out. The estimates are the preliminary numbers of measured surfaces.
    """
    return _with_whole_strips(_with_grid(_with_carried_order(scans.with_heights(config, estimates)), estimates))


def _with_grid(config, estimates):
    """Configuration with the distance between heights and the margin."""
    sampling = config["sampling"]
    if {"spacing_nm", "margin_um"} <= set(sampling):
        return config
    waves = [_waves(config["surfaces"][name], estimates.get(name)) for name in dict.fromkeys(used_surfaces(config))]
    waves = list(filter(None, waves))
    chosen = {"margin_um": max((_margin(length) for _, length in waves), default=_MARGIN)} | sampling
    config = config | {"sampling": {"spacing_nm": _SPACING} | chosen}
    if "margin_um" not in sampling and chosen["margin_um"] > _MARGIN:
        config = _with_variants(config, lambda spacing: _memory(config, spacing) <= memory.LARGEST)
    parts = _parts(config, max((end for end, _ in waves), default=0.0))
    if "spacing_nm" in sampling or parts == 1:
        return config
    spacing = _SPACING / parts
    config = config | {"sampling": config["sampling"] | {"spacing_nm": spacing}}
    return _with_variants(config, lambda other: not is_at_most(spacing, other))


def carried(order: int, samples: int) -> int:
    """Largest order, up to a given one, of polynomials in four variables that samples carry, App. B.

    Examples
    --------
    >>> carried(12, 5000), carried(12, 300)
    (12, 6)
    """
    return next(n for n in count(order, -1) if math.comb(n + 4, 4) <= samples)


def _with_carried_order(config):
    """Configuration with an order that the samples carry, if it states none of its own."""
    if is_stated(config, "chaos", "order"):
        return config
    order = carried(config["chaos"]["order"], config["contact"]["samples"])
    return config | {"chaos": config["chaos"] | {"order": order}}


def _with_whole_strips(config):
    """Configuration with strips that are whole on the grid and fill the elements of the beam, where it states none."""
    step = config["sampling"]["spacing_nm"] * config["contact"]["every"] / NM_PER_UM
    config = _with_whole(config, "sampling", "strip_length_um", step)
    if config["run"]["pairs"]:
        config = _with_filled_elements(_with_whole(config, "beam", "width_um", step), step)
    short = {name: _bridge_strip(device, config, step) for name, device in config.get("devices", {}).items()}
    changes = {name: {"strip_um": length} for name, length in short.items() if length}
    changes |= {name: {"contact_um": sides} for name, sides in _areas_under_shapes(config, step).items()}
    return merged(config, {"devices": changes}) if changes else config


def _with_whole(config, section, key, step):
    """Configuration with a length [µm] that is a multiple of a step, the nearest one, unless it is stated."""
    length = config[section][key]
    if is_stated(config, section, key) or is_multiple(length, step):
        return config
    return merged(config, {section: {key: round(round(length / step) * step, _PICOMETRES)}})


def _with_filled_elements(config, step):
    """Configuration with a whole number of strips in every element: a longer beam, or other strips, if not stated."""
    beam, strip = config["beam"], config["sampling"]["strip_length_um"]
    element = strip * beam["elements"]
    if is_multiple(beam["length_um"], element):
        return config
    length_is_stated, strip_is_stated = (
        is_stated(config, *key) for key in (("beam", "length_um"), ("sampling", "strip_length_um"))
    )
    if not length_is_stated:
        longer = math.ceil(beam["length_um"] / element) * element
        return merged(config, {"beam": {"length_um": round(longer, _PICOMETRES)}})
    most = 0 if strip_is_stated else math.ceil(2 * beam["length_um"] / element)
    strips = (beam["length_um"] / beam["elements"] / n for n in range(1, most + 1))
    if not (fitting := [length for length in strips if is_multiple(length, step)]):
        return config
    nearest = min(fitting, key=lambda length: abs(math.log(length / strip)))
    return merged(config, {"sampling": {"strip_length_um": round(nearest, _PICOMETRES)}})


def _bridge_strip(device, config, step):
    """Length of the strips of a bridge [µm] where neither it nor the grid has the usual one, otherwise ``None``."""
    kind, usual = kind_of(device), config["sampling"]["strip_length_um"]
    length = kind.strip(device, usual)
    if not kind.has_short_strips or "strip_um" in device or is_multiple(length, step):
        return None
    return round(max(math.floor(length / step), 1) * step, _PICOMETRES)


def _areas_under_shapes(config, step):
    """Sides of the patches under devices that are not flat [µm], whole on the grid, where they are not stated."""
    devices = config.get("devices", {}).items()
    areas = {
        name: kind_of(device).area(device)
        for name, device in devices
        if kind_of(device).shape and "contact_um" not in device
    }
    return {
        name: [round(math.ceil(side / step) * step, _PICOMETRES) for side in sides] for name, sides in areas.items()
    }


def used_surfaces(config: Mapping[str, Any]) -> Iterator[str]:
    """Names of the surfaces of pairs in the run, of devices and of test beams, as often as they occur."""
    users = (*config.get("devices", {}).values(), *config.get("test_beams", {}).values())
    for pair in (*config["run"]["pairs"], *(user["pair"] for user in users if "pair" in user)):
        yield from (config["pairs"][pair][side] for side in SIDES)
    yield from process.all_names(config)


def _waves(entry, estimate):
    """Largest wave number of a surface [rad/µm] and correlation length [µm], ``None`` if unknown."""
    if estimate:
        return estimate["end_rad_per_um"], estimate["correlation_um"][scans.complete(entry)["psd"]]
    if entry["psd"] != "published":
        return None
    try:
        return float(entry["published_psd"]["cutoff_rad_per_um"]), published_correlation(**entry["published_psd"])
    except ValueError:
        return None  # a relation reports a spectrum that does not decay


@functools.cache
def published_correlation(**psd: float) -> float:
    """Correlation length of a published spectrum [µm]. Raises a ValueError if it does not decay."""
    return from_si(correlation_length(in_si(CutoffSelfAffine, psd)), "um")


def _margin(correlation):
    """Margin above a correlation length [µm]."""
    return _MARGIN if correlation < _MARGIN else _STEP * (math.floor(correlation / _STEP) + 1)


def _parts(config, end):
    """Number of parts of the paper's distance for waves up to a wave number [rad/µm], within the memory."""
    nyquist = math.pi / _SPACING * NM_PER_UM

    def too_many(parts):
        """Whether the largest field takes half of the memory of a job."""
        return _memory(config, _SPACING / parts) > memory.LARGEST / 2

    return next(n for n in count(1) if is_at_most(end, n * nyquist) or too_many(n + 1))


def _memory(config, spacing):
    """Memory of the largest drawn field with this distance between heights [nm] in MB."""
    return memory.field_memory(max(_areas(config)), 1, spacing)


def _areas(config):
    """Areas of the drawn fields [µm²]."""
    yield memory.FIELD_UM**2
    sampling, width = config["sampling"], config["beam"]["width_um"]
    yield float((sampling["strip_length_um"] + sampling["margin_um"]) * (width + sampling["margin_um"]))
    for device in config.get("devices", {}).values():
        for _, sides, _ in memory.fields_of(device, sampling):
            yield float(math.prod(sides))


def _with_variants(config, kept):
    """Configuration with the variants on grids whose distance between heights [nm] meets a condition."""
    listed = config["studies"]["variants"]["spacing_nm"]
    return merged(config, {"studies": {"variants": {"spacing_nm": list(filter(kept, listed))}}})
