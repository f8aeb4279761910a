"""Access of relations to keys: values of a configuration by dotted key, and reported problems."""

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from functools import reduce
from operator import getitem
from pathlib import Path
from typing import Any, ClassVar

from stiction.config.cases import in_words
from stiction.config.messages import Problem, dotted, one_line


class Unknown(LookupError):
    """Key not given. Relations on it are not checked."""


class Relations(list):
    """Generators of refusals of values. Also the decorator to add them."""

    def __call__(self, relation: Callable) -> Callable:
        """Register a relation. It yields a key, its refusal or ``None``, and other keys behind the refusal.

        It takes `Keys` and ends where it reads a key that is unknown.
        """
        self.append(relation)
        return relation

    def problems(self, config: "Keys") -> Iterator[Problem]:
        """Yield violated relations."""
        for relation in self:
            with suppress(Unknown):
                for key, refusal, *others in relation(config):
                    if refusal:
                        yield config.problem(key, refusal, *others)


@dataclass(frozen=True)
class Keys:
    """Values of a configuration by dotted key such as ``pairs.a.gap_um`` or ``run.pairs.0``.

    Examples
    --------
    >>> config = Keys({"pairs": {"a": {"gap_um": 20}, "b": {}}})
    >>> config["pairs.a.gap_um"], config.names("pairs"), list(config.entries("pairs", "gap_um"))
    (20, ['a', 'b'], [('a', 20)])
    """

    config: dict
    files: dict[str, list] = field(default_factory=dict)  #: of the scans of measured surfaces, by name
    origins: dict[tuple, tuple] = field(default_factory=dict)  #: paths and values that users stated, by what follows
    #: Whether devices have what bounds films that are no liquid, see `stiction.config.mission.airs`.
    bounds_films: ClassVar[bool] = True

    def __getitem__(self, key: str) -> Any:
        """Value of a key. Raises `Unknown` if it is not given."""
        try:
            return reduce(getitem, _path(key), self.config)
        except (LookupError, TypeError):  # a name with a dot, such as b.gap_um
            raise Unknown(key) from None

    def names(self, section: str) -> list[str]:
        """Names in a section or indices of a list."""
        value = self[section]
        return list(value) if isinstance(value, dict) else [*map(str, range(len(value)))]

    def given_items(self, *keys: str) -> Iterator[tuple[str, Any]]:
        """Yield (key, value) for every given key."""
        for key in keys:
            with suppress(Unknown):
                yield key, self[key]

    def items(self, listed: str) -> Iterator[tuple[str, Any]]:
        """Keys of the items of a list, with their values."""
        with suppress(Unknown):
            yield from self.given_items(*(f"{listed}.{index}" for index in self.names(listed)))

    def entries(self, section: str, *keys: str) -> Iterator[tuple]:
        """Yield the name of every entry of a section with all these keys, and their values."""
        for name in self.names(section):
            values = dict(self.given_items(*(f"{section}.{name}.{key}" for key in keys)))
            if len(values) == len(keys):
                yield name, *values.values()

    def scanned(self, *surfaces: str) -> list[str]:
        """Keys of measured surfaces. A problem with them names the files of their scans."""
        return [f"surfaces.{name}.rms_nm" for name in self.files if name in surfaces]

    def problem(self, key: str, message: str, *other_keys: str) -> Problem:
        """Problem with a key, and the other keys behind it."""
        path, value = self._origin(key)
        follows = path[0] == "surfaces" and path != _path(key) and value != self[key]
        number = f", which gives {_path(key)[-1]} = {self[key]:.4g}" if follows else ""
        others = dict.fromkeys(
            f"{dotted(other)} = {one_line(content)}" for other, content in map(self._origin, other_keys)
        )
        more = f" (given {', '.join(others)})" if others else ""
        return Problem(path, f"is {one_line(value)}{number}, {message}{more}")

    def _origin(self, key):
        """Path and value as the user states them: numbers of a surface may follow from other keys or from files."""
        path = _path(key)
        if path in self.origins:
            return self.origins[path]
        if path[0] == "surfaces" and path[1] in self.files:
            return (*path[:2], "scans", "files"), [Path(file).name for file in self.files[path[1]]]
        return path, in_words(self[key], path)


def _path(key):
    """Names and indices of a dotted key."""
    return tuple(int(name) if name.isdecimal() else name for name in key.split("."))
