"""Grid of the drawn surfaces by default: as fine and as wide as the surfaces need.

The distance between heights is the largest whole part of 10 nm whose Nyquist wave number is not below the end of any
spectrum, or the smallest one whose fields take half of the memory of a job, which leaves room for longer tips. The
margin is 1 µm, or the smallest multiple of 0.5 µm above the correlation length of every surface. Only surfaces of pairs
that run, of devices and of test beams count. Those of the paper have the paper's grid.

Devices alone have a chaos model of the paper's order, or of the largest one that their samples carry.
"""

import functools
import math
from collections.abc import Collection, Iterator, Mapping
from itertools import chain, count
from typing import Any

from stiction.config import memory, scans
from stiction.config.messages import faulty
from stiction.config.reading import paper
from stiction.config.surfaces import process
from stiction.config.units import NM_PER_UM, from_si, in_si
from stiction.models import SIDES
from stiction.rounding import is_at_most
from stiction.surface.spectrum import CutoffSelfAffine, correlation_length

#: Distance between heights [nm] and margin [µm] of the paper, and the steps of longer margins [µm].
_SPACING, _MARGIN, _STEP = memory.GRID["spacing_nm"], memory.GRID["margin_um"], 0.5


def completed(config: dict[str, Any], estimates: Mapping[str, dict], faults: Collection[tuple] = ()) -> dict[str, Any]:
    """Configuration, valid or not, with all keys of section ``sampling``, a chaos model, and heights with a density.

    Variants on grids that are not finer than one that follows the surfaces, or whose fields do not fit into memory with
    a margin that does, are left out. The estimates are the preliminary numbers of measured surfaces. Surfaces with one
    of the faults, keys that are wrong on their own, do not count.
    """
    sampling = config.get("sampling") if isinstance(config, dict) else None
    if not isinstance(sampling, dict):
        return config
    config = _with_carried_order(scans.with_heights(config, estimates))
    if {"spacing_nm", "margin_um"} <= set(sampling):
        return config
    wrong = faulty(faults, "surfaces")
    waves = [_waves(config, name, estimates) for name in dict.fromkeys(used_surfaces(config)) if name not in wrong]
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
    """Configuration with an order that the samples carry, if it has no pairs and states no order of its own."""
    chaos, samples = _section(config, "chaos"), _section(config, "contact").get("samples")
    order = paper()["chaos"]["order"]
    if _section(config, "run").get("pairs") != [] or chaos.get("order") != order or not isinstance(samples, int):
        return config
    return config | {"chaos": chaos | {"order": carried(order, max(samples, 5))}}


def _section(config, *place):
    """Nested section of a configuration, empty if missing."""
    for name in place:
        config = config.get(name) if isinstance(config, dict) and isinstance(name, str) else None
    return config if isinstance(config, dict) else {}


def used_surfaces(config: Mapping[str, Any]) -> Iterator[str]:
    """Names of the surfaces of pairs in the run, of devices and of test beams, as often as they occur."""
    running = _section(config, "run").get("pairs")
    devices = chain.from_iterable(_section(config, section).values() for section in ("devices", "test_beams"))
    pairs = [
        *(running if isinstance(running, list) else ()),
        *(_section({"": entry}, "").get("pair") for entry in devices),
    ]
    for pair in pairs:
        sides = (_section(config, "pairs", pair).get(side) for side in SIDES)
        yield from (name for name in sides if isinstance(name, str))
    yield from process.all_names(config)


def _waves(config, name, estimates):
    """Largest wave number of a surface [rad/µm] and correlation length [µm], ``None`` if unknown."""
    entry = _section(config, "surfaces", name)
    if name in estimates:
        return estimates[name]["end_rad_per_um"], estimates[name]["correlation_um"][scans.complete(entry)["psd"]]
    if entry.get("psd") != "published":
        return None
    try:
        return float(entry["published_psd"]["cutoff_rad_per_um"]), published_correlation(**entry["published_psd"])
    except (KeyError, TypeError, ValueError):
        return None  # relations report what is missing or out of range


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
    sampling, width = config["sampling"], _section(config, "beam").get("width_um")
    try:
        yield float((sampling["strip_length_um"] + sampling["margin_um"]) * (width + sampling["margin_um"]))
        for device in _section(config, "devices").values():
            for _, sides, _ in memory.fields_of(device, sampling):
                yield float(math.prod(sides))
    except (KeyError, TypeError, ValueError, OverflowError):
        return  # other relations report what is missing or out of range


def _with_variants(config, kept):
    """Configuration with the variants on grids whose distance between heights [nm] meets a condition."""
    studies, variants = _section(config, "studies"), _section(config, "studies", "variants")
    listed = variants.get("spacing_nm")
    if not isinstance(listed, list):
        return config
    chosen = {"variants": variants | {"spacing_nm": list(filter(kept, listed))}}
    return config | {"studies": studies | chosen}
