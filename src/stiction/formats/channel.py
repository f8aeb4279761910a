"""One map of values in a file, with the same attributes as the library's channels."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np


@dataclass(frozen=True, eq=False)
class Channel:
    """Values on a rectangular grid."""

    name: str
    data_unit: str  #: of the values, empty if the file has none
    nb_grid_pts: tuple[int, int]  #: along x and y
    physical_sizes: tuple[float, float] | None  #: along both, number of points times their distance, in ``unit``
    values: Callable[[], np.ndarray]  #: gives the values, (n_x, n_y) [m if both units are lengths, else ``data_unit``]
    channel_id: str = ""  #: name, with a number behind # if others have the same
    index: int = 0
    unit: str | None = "m"  #: of the sides
    dim: int = 2
    is_uniform: bool = True
    info: dict = field(default_factory=dict)

    def topography(self, **_: object) -> "Channel":
        """Map itself."""
        return self

    def heights(self) -> np.ndarray:
        """Values of the map, (n_x, n_y)."""
        return self.values()


def numbered(channels: Iterable[Channel]) -> list[Channel]:
    """Channels with an identifier each, as those of the library.

    Examples
    --------
    >>> one = Channel("Z", "m", (1, 1), (1.0, 1.0), None)
    >>> [channel.channel_id for channel in numbered([one, replace(one, name="Phase"), one])]
    ['Z#1', 'Phase', 'Z#2']
    """
    channels = list(channels)
    names = [channel.name for channel in channels]
    return [
        replace(channel, index=index, channel_id=_identifier(names, index)) for index, channel in enumerate(channels)
    ]


def _identifier(names: Sequence[str], index: int):
    name = names[index]
    return f"{name}#{names[: index + 1].count(name)}" if names.count(name) > 1 else name
