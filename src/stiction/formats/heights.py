"""Channel of a file with the heights, by its name and unit.

The library for files regards every channel with a length, and some without, as heights.
"""

import re
from collections.abc import Sequence
from typing import Any

from stiction.errors import ScanError

#: Units of length [m], and those of them that files have: an A in a file may be an ampere.
UNITS = {"m": 1.0, "mm": 1e-3, "µm": 1e-6, "um": 1e-6, "nm": 1e-9, "Å": 1e-10, "A": 1e-10, "pm": 1e-12}
STORED = set(UNITS) - {"A"}
#: Names of height channels consist of these words: at least one of the first set, others only of the second and third.
#: Heights by different means are different quantities. Those of both directions of a line are one quantity.
_HEIGHT, _MEANS = {"height", "heights", "topography", "z"}, {"axis", "sensor", "measured", "raw", "data"}
_DIRECTION = {"scan", "trace", "retrace", "forward", "backward", "channel"}
#: Words for other quantities that microscopes also give as lengths.
_NO_HEIGHT = {"adhesion", "amplitude", "deflection", "deformation", "error", "friction", "lateral", "phase"}
_NO_HEIGHT |= {"current", "dissipation", "force", "indentation", "intensity", "peak", "potential", "separation"}
#: Largest number of channels that a sentence lists.
_MOST_LISTED = 12
#: Names of the library for the channel of a file that names none.
_NAMELESS = re.compile(r"(default|channel \d+)$", re.IGNORECASE)


def height_channel(channels: Sequence[Any], channel_name: str | None, name: str) -> tuple[Any, tuple[str, ...]]:
    """Channel of the heights and notes on its choice.

    Parameters
    ----------
    channels : sequence of `stiction.formats.channel.Channel`
        Or of the library.
    channel_name : str or None
        Name of the channel, or name#2 for the second of equal names.
    name : str
        Of the file, for messages.

    Raises
    ------
    ScanError
        If no channel, or more than one kind, has heights.
    """
    if channel_name is not None:
        chosen = [channel for channel in channels if channel_name in (channel.channel_id, channel.name)]
        if not chosen:
            raise ScanError(name, "channel", f"has no channel {channel_name}, only: {_first_channels(channels)}")
    else:
        chosen = [channel for channel in channels if _is_height(channel)] or _only_length(channels)
        if not chosen:
            raise ScanError(
                name, "channel", f"has no channel that is named as a height, only: {_first_channels(channels)}"
            )
        if len({frozenset(_words(channel.name) - _DIRECTION) for channel in chosen}) > 1:
            raise ScanError(
                name, "channel", f"has several channels of heights; name one of: {_first_channels(_first(chosen))}"
            )
    others = f"; the file also has {_first_channels(chosen[1:])}" if chosen[1:] else ""
    unnamed = not (channel_name or _is_height(chosen[0]) or _NAMELESS.match(chosen[0].name))
    others += "; its name does not say that it has heights, but no other has lengths" if unnamed else ""
    return chosen[0], (f"{name}: channel {chosen[0].channel_id} was read{others}",) if others else ()


def unit_of(channel: Any) -> Any:
    """Unit of the heights of a channel, not always a length, or ``None`` if the file has none."""
    return channel.unit if channel.data_unit is None else channel.data_unit or None


def _words(name):
    """Words of the name of a channel, in lower case. ``HeightTrace`` has two."""
    return {word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", name)}


def _is_height(channel):
    """Whether name and unit of a channel fit heights."""
    words = _words(channel.name)
    return bool(words & _HEIGHT) and words <= _HEIGHT | _MEANS | _DIRECTION and _has_length(channel)


def _has_length(channel):
    """Whether the unit of a channel is a length, or is missing."""
    return unit_of(channel) is None or unit_of(channel) in STORED


def _only_length(channels):
    """Only channel with a length, or without a unit, unless its name belongs to another quantity."""
    lengths = [channel for channel in channels if _has_length(channel)]
    return lengths if len(lengths) == 1 and not _words(lengths[0].name) & _NO_HEIGHT else []


def _first(channels):
    """First channel of every name: others of its name are frames or directions."""
    names = [channel.name for channel in channels]
    return [channel for k, channel in enumerate(channels) if names.index(channel.name) == k]


def _first_channels(channels):
    """Channels by their identifiers, the first of many."""
    names = [channel.channel_id for channel in channels]
    more = len(names) - _MOST_LISTED
    return ", ".join(names) if more <= 0 else f"{', '.join(names[:_MOST_LISTED])} and {more} more"
