"""Table of devices: a CSV file with a row for each device, as from a spreadsheet.

``devices: {file: range.csv, kind: cantilever, pair: mine}`` makes a device of each row. Columns are ``name`` and keys
of devices, such as ``length_um`` and ``uncertainty.gap_um``. Keys beside ``file`` hold where a row has no value of its
own. Other entries beside it change the device of their name, or are devices of their own.
"""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from stiction.config.merging import merged
from stiction.config.messages import ConfigError, dotted, one_line
from stiction.config.reading import text
from stiction.config.tables.csv_rows import WrongFileError, rows

#: Column of the name of a device.
_NAME = "name"
#: Beginning of a sentence about a device, its name in quotes if it is no word.
_DEVICE = re.compile(r"devices\.(?:[\w-]+|'[^']*'|\"[^\"]*\")")
_WHOLE, _REAL = re.compile(r"[-+]?[0-9]{1,18}"), re.compile(r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?")


class Rows(NamedTuple):
    """Stands in for the file of devices once it has been read."""

    file: str  #: its name
    numbers: dict[str, int]  #: line of the file of each device, in the order of the file


def in_folder(config: dict[str, Any], named: Mapping[str, Any], folder: str | Path) -> dict[str, Any]:
    """Configuration, valid or not, with its file of devices relative to the folder of the file naming it."""
    file = _file(named)
    if file is None or _file(config) != file:
        return config
    return config | {"devices": config["devices"] | {"file": str(Path(folder).absolute() / file)}}


def with_rows(config: dict[str, Any]) -> dict[str, Any]:
    """Configuration, valid or not, with a device for each row of its file.

    `Rows` take the place of the name of the file until `without_file` removes them.

    Raises
    ------
    ConfigError
        If the file cannot be used; one sentence with the file, the row and the column.
    """
    if (file := _file(config)) is None:
        return config
    try:
        numbers, devices = _devices(text(file), _section_of_a_device())
    except WrongFileError as wrong:
        raise ConfigError(f"devices.file is {_shown(file)}, {wrong}") from None
    except (OSError, ValueError) as reason:
        why = getattr(reason, "strerror", None) or reason
        raise ConfigError(f"devices.file is {_shown(file)}, which cannot be read: {why}") from reason
    shared = {key: value for key, value in config["devices"].items() if key in _section_of_a_device()["properties"]}
    others = {key: value for key, value in config["devices"].items() if key not in shared}
    whole = merged({name: merged(shared, device) for name, device in devices.items()}, others)
    return config | {"devices": whole | {"file": Rows(file, numbers)}}


def without_file(config: Any) -> tuple[Any, Rows]:
    """Configuration, valid or not, without the `Rows` of its file, and these. Without a file they are empty."""
    devices = config.get("devices") if isinstance(config, dict) else None
    of_file = devices.get("file") if isinstance(devices, dict) else None
    if not isinstance(of_file, Rows):
        return config, Rows("", {})
    return config | {"devices": {name: device for name, device in devices.items() if name != "file"}}, of_file


def in_rows(sentences: Iterable[str], of_file: Rows) -> list[str]:
    """Sentences with file and row in place of the names of devices from a file. What rows share is one sentence.

    Examples
    --------
    >>> of_file = Rows("range.csv", {"L1": 2, "L2": 3, "L3": 4})
    >>> in_rows([f"devices.{name}.gap_um is 0, must be a number above 0" for name in of_file.numbers], of_file)
    ["devices.file is 'range.csv', rows 2 to 4: gap_um is 0, must be a number above 0"]
    """
    prefixes = {dotted(("devices", name)): name for name in of_file.numbers}
    numbers = {}
    for sentence in sentences:
        prefix = _DEVICE.match(sentence)
        if prefix and (name := prefixes.get(prefix[0])) is not None:
            about_cell = sentence.replace(f"{prefix[0]}.", "")
            sentence = about_cell.replace(prefix[0], f"{_NAME} is {one_line(name)}, which", 1)
            numbers.setdefault(sentence, []).append(of_file.numbers[name])
        else:
            numbers.setdefault(sentence, [])
    return [_of_rows(of_file.file, listed, sentence) for sentence, listed in numbers.items()]


def _of_rows(file, numbers, sentence):
    """Sentence about some rows. Itself if it is about none."""
    if not numbers:
        return sentence
    first, last = min(numbers), max(numbers)
    is_range = last - first + 1 == len(numbers) > 2
    listed = f"{first} to {last}" if is_range else ", ".join(map(str, sorted(numbers)))
    return f"devices.file is {_shown(file)}, row{'s' * (len(numbers) > 1)} {listed}: {sentence}"


def _shown(file):
    """Name of a file in messages, without the folder of the configuration."""
    return one_line(Path(file).name if Path(file).is_absolute() else file)


def _file(config):
    """File of devices, ``None`` if a configuration names none."""
    devices = config.get("devices") if isinstance(config, dict) else None
    file = devices.get("file") if isinstance(devices, dict) else None
    return file if isinstance(file, str) else None


def _section_of_a_device():
    """Part of the schema about one device."""
    from stiction.config.relations import schema  # imports the physics, which reading alone does not need

    return schema()["properties"]["devices"]["additionalProperties"]


def _columns(section, above=""):
    """Parts of the schema about the values of a device by their column."""
    found = {}
    for key, entry in section["properties"].items():
        is_section = entry["type"] == "object"
        found |= _columns(entry, f"{above}{key}.") if is_section else {above + key: entry}
    return found


def _devices(content, section):
    """Line of each device, and its section, by name."""
    columns, numbers, devices = _columns(section), {}, {}
    for number, cells in rows(content, [_NAME, *columns], [_NAME], "device"):
        name = cells.pop(_NAME)
        if not name:
            raise WrongFileError(f"row {number}: {_NAME} is empty, must be the name of a device")
        if name in numbers:
            raise WrongFileError(f"row {number}: {_NAME} is {one_line(name)} as in row {numbers[name]}, must differ")
        values = {column: _value(cell, columns[column]) for column, cell in cells.items() if cell}
        numbers[name], devices[name] = number, _nested(values)
    return numbers, devices


def _nested(values):
    """Section of values by dotted key."""
    section = {}
    for column, value in values.items():
        for key in reversed(column.split(".")):
            value = {key: value}
        section = merged(section, value)
    return section


def _value(cell, entry):
    """Value of a cell. Whatever is no number where one is wanted stays text, which the schema refuses."""
    if entry["type"] == "array":
        return [_value(item, entry["items"]) for item in re.split(r"[\s;]+", cell)]
    if entry["type"] == "string" or not _REAL.fullmatch(cell):
        return cell
    return int(cell) if _WHOLE.fullmatch(cell) else float(cell)
