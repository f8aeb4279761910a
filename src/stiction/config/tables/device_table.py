"""Table of devices: a CSV file with a row for each device, as from a spreadsheet.

``devices: {file: range.csv, kind: cantilever, pair: mine}`` makes a device of each row. Columns are ``name`` and keys
of devices, such as ``length_um`` and ``uncertainty.gap_um``. Keys beside ``file`` hold where a row has no value of its
own. Other entries beside it change the device of their name, or are devices of their own.
"""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from stiction.config.merging import merged, section_at
from stiction.config.messages import ConfigError, dotted, one_line
from stiction.config.reading import text
from stiction.config.tables.csv_rows import WrongFileError, rows

#: Column of the name of a device.
_NAME = "name"
#: Beginning of a sentence about a device, its name in quotes if it is no word.
_DEVICE = re.compile(r"devices\.(?:[\w-]+|'[^']*'|\"[^\"]*\")")
#: Key of a device after its name.
_KEY = re.compile(r"(?:\.[\w-]+|\[[0-9]+\])*")
_INTEGER, _REAL = re.compile(r"[-+]?[0-9]{1,18}"), re.compile(r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?")


class DeviceRows(NamedTuple):
    """Stands in for the file of devices once it has been read."""

    file: str  #: its name
    numbers: dict[str, int]  #: line of the file of each device, in the order of the file
    shared: list[str]  #: keys beside the file whose values hold for all its devices
    entry_keys: dict[str, list[str]]  #: keys of devices that have values in entries of their own beside the file


def in_folder(config: dict[str, Any], named: Mapping[str, Any], folder: str | Path) -> dict[str, Any]:
    """Configuration, valid or not, with its file of devices relative to the folder of the file naming it."""
    file = _file(named)
    if file is None or _file(config) != file:
        return config
    return config | {"devices": config["devices"] | {"file": str(Path(folder).absolute() / file)}}


def with_rows(config: dict[str, Any]) -> dict[str, Any]:
    """Configuration, valid or not, with a device for each row of its file.

    `DeviceRows` take the place of the name of the file until `without_file` removes them.

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
    sections = merged({name: merged(shared, device) for name, device in devices.items()}, others)
    entry_keys = {name: list(_dotted(section)) for name, section in others.items() if name in numbers}
    cells = {column for device in devices.values() for column in _dotted(device)}
    return config | {
        "devices": sections | {"file": DeviceRows(file, numbers, [*{*_dotted(shared)} - cells], entry_keys)}
    }


def without_file(config: Any) -> tuple[Any, DeviceRows]:
    """Configuration, valid or not, without the `DeviceRows` of its file, and these. Without a file they are empty."""
    devices = dict(section_at(config, "devices"))
    if not isinstance(of_file := devices.pop("file", None), DeviceRows):
        return config, DeviceRows("", {}, [], {})
    return config | {"devices": devices}, of_file


def in_rows(sentences: Iterable[str], of_file: DeviceRows) -> list[str]:
    """Sentences with file and row in place of the names of devices from a file. What rows share is one sentence.

    What holds for all rows of a key beside the file is about this key.

    Examples
    --------
    >>> of_file = Rows("range.csv", {"L1": 2, "L2": 3, "L3": 4}, ["width_um"], {})
    >>> in_rows([f"devices.{name}.gap_um is 0, must be a number above 0" for name in of_file.numbers], of_file)
    ["devices.file is 'range.csv', rows 2 to 4: gap_um is 0, must be a number above 0"]
    >>> in_rows([f"devices.{name}.width_um is 0, must be a number above 0" for name in of_file.numbers], of_file)
    ['devices.width_um is 0, must be a number above 0']
    """
    prefixes = {dotted(("devices", name)): name for name in of_file.numbers}
    numbers, of_all = {}, set()
    for sentence in sentences:
        prefix = _DEVICE.match(sentence)
        name = prefixes.get(prefix[0]) if prefix else None
        key = _KEY.match(sentence, prefix.end())[0] if prefix else ""
        if name is None or name in of_file.entry_keys and (not key or _is_among(key, of_file.entry_keys[name])):
            numbers.setdefault(sentence, [])
            continue
        about_cell = sentence.replace(f"{prefix[0]}.", "")
        about_cell = about_cell.replace(prefix[0], f"{_NAME} is {one_line(name)}, which", 1)
        numbers.setdefault(about_cell, []).append(of_file.numbers[name])
        if _is_among(key, of_file.shared):
            of_all.add(about_cell)
    return [
        f"devices.{sentence}"
        if sentence in of_all and len(listed) == len(of_file.numbers)
        else _of_rows(of_file.file, listed, sentence)
        for sentence, listed in numbers.items()
    ]


def _is_among(key, stated):
    """Whether a key of a sentence, such as ``.humidities[0]``, is one of the stated ones or in it."""
    return any(re.match(rf"\.{re.escape(other)}(?![\w])", key) for other in stated)


def _dotted(section, above=""):
    """Yield the dotted keys of the values of a section, which may be none."""
    for key, value in section_at(section).items():
        if isinstance(value, dict):
            yield from _dotted(value, f"{above}{key}.")
        else:
            yield f"{above}{key}"


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
    file = section_at(config, "devices").get("file")
    return file if isinstance(file, str) else None


def _section_of_a_device():
    """Part of the schema about one device."""
    from stiction.config.relations import schema  # imports the physics, which reading alone does not need

    return schema()["properties"]["devices"]["additionalProperties"]


def _columns(section, above=""):
    """Parts of the schema about the values of a device by their column."""
    columns = {}
    for key, entry in section["properties"].items():
        is_section = entry["type"] == "object"
        columns |= _columns(entry, f"{above}{key}.") if is_section else {above + key: entry}
    return columns


def _devices(content, section):
    """Line of each device, and its section, by name."""
    columns, numbers, devices = _columns(section), {}, {}
    for number, cells in rows(content, [_NAME, *columns], [_NAME], "device"):
        name = cells.pop(_NAME)
        if not name:
            raise WrongFileError(f"row {number}: {_NAME} is empty, must be the name of a device")
        if name == "file":
            raise WrongFileError(f"row {number}: {_NAME} is 'file', must differ from the key that names this file")
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
    return int(cell) if _INTEGER.fullmatch(cell) else float(cell)
