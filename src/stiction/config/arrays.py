"""Arrays of test beams in a configuration: the cantilevers that they are, and single beams in CSV files.

Whatever is computed for an array is computed for a cantilever of its dimensions at the humidities of its data.

In a file, a row is a beam: measured if it has a crack length, counted if it says whether it is stuck. The configuration
has the means and counts from the start, so that nothing else knows of such files.
"""

import csv
import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from statistics import fmean, stdev
from typing import Any, NamedTuple

from stiction.config.cases import DRY
from stiction.config.kinds import KEYS
from stiction.config.messages import ConfigError, did_you_mean, shown
from stiction.config.reading import text

#: Keys of an array that list what was measured.
DATA = ("crack_lengths", "stuck")
#: Keys of an array that are those of a cantilever.
_SIZES = ("pair", "thickness_um", "gap_um", "width_um", "strip_um")
#: Columns of a file, and a file to start from.
COLUMNS = ("humidity", "length_um", "crack_length_um", "stuck")
TEMPLATE = f"""\
# Test beams of one array, a row for every beam; key test_beams.NAME.file of the configuration names this file.
# humidity: relative humidity, as a fraction of 1, or dry  length_um: length of the beam [µm]
# crack_length_um: measured crack length [µm], if any      stuck: yes or no, of a beam that was only counted
{",".join(COLUMNS)}
0.44,1500,941.0,
0.44,1500,968.5,
0.44,500,,yes
0.44,500,,no
"""
#: Keys of an array that a file replaces.
_REPLACED = ("length_um", "crack_lengths", "stuck")
_WORDS = {"yes": True, "1": True, "no": False, "0": False}


def users(config: Mapping, array: str) -> list[dict]:
    """Sections of the devices whose prediction uses an array."""
    return [device for device in config.get("devices", {}).values() if array in device.get("test_beams", ())]


def humidities(array: Mapping, *kinds: str) -> list[float]:
    """Humidities of the data of an array, increasing; those of some kinds of data, by default of all."""
    return sorted({datum["humidity"] for kind in kinds or DATA for datum in array.get(kind, ())})


def shared_uncertainty(device: Mapping) -> dict[str, float]:
    """Uncertainties of a device apart from those of its dimensions: its test beams have the same inputs."""
    stated = device.get("uncertainty", {})
    return {key: value for key, value in stated.items() if key not in KEYS}


def as_cantilevers(config: Mapping) -> dict[str, dict]:
    """Sections of all arrays with data as if they were devices."""
    arrays = config.get("test_beams", {})
    return {name: _cantilever(array, users(config, name)) for name, array in arrays.items() if humidities(array)}


def counted(config: Mapping) -> dict[str, dict]:
    """Sections of the arrays with counts as if they were devices: their tips may hold them."""
    return {name: one for name, one in as_cantilevers(config).items() if "stuck" in config["test_beams"][name]}


def _cantilever(array, devices):
    """Section of an array that some devices use."""
    shared, measured_at = next(map(shared_uncertainty, devices), {}), humidities(array)
    if not any(measured_at):  # dry air has no humidity that could be uncertain
        shared = {key: value for key, value in shared.items() if key != "humidity"}
    sizes = {key: array[key] for key in _SIZES if key in array}
    stated = {"humidities": measured_at, "uncertainty": shared | array.get("uncertainty", {})}
    return {"kind": "cantilever"} | sizes | stated


# Files of single beams


class Beam(NamedTuple):
    """One row."""

    row: int  #: line of the file
    humidity: float  #: [-]
    length: float  #: [µm]
    crack_length: float | None  #: [µm]
    stuck: bool | None


class _Wrong(ValueError):
    """What is wrong with a file, as the end of a sentence."""


def with_files(config: dict[str, Any], named: Mapping[str, Any], folder: str | Path) -> dict[str, Any]:
    """Configuration, which need not be valid, with means and counts instead of the files that the content names.

    ``named`` is the content of a configuration file, and ``folder`` the folder of this file.

    Raises
    ------
    ConfigError
        If a file cannot be used; one sentence with the key, the file, the row and the column.
    """
    files = {name: entry["file"] for name, entry in _arrays(named)}
    found = {name: entry for name, entry in _arrays(config) if entry["file"] == files.get(name)}
    replaced = {name: _replaced(name, entry, Path(folder)) for name, entry in found.items()}
    return config | {"test_beams": config["test_beams"] | replaced} if replaced else config


def _arrays(config) -> Iterator[tuple[str, dict]]:
    """Arrays that name a file."""
    arrays = config.get("test_beams")
    for name, entry in arrays.items() if isinstance(arrays, dict) else ():
        if isinstance(entry, dict) and isinstance(entry.get("file"), str):
            yield name, entry


def _replaced(name, entry, folder):
    """Section of an array with what its file holds."""
    key = f"test_beams.{name}.file is {shown(entry['file'])}"
    stated = [other for other in _REPLACED if other in entry]
    if stated:
        raise ConfigError(f"{key}, must come without {', '.join(stated)}: the file has them")
    try:
        data = summary(beams(text(folder / entry["file"])))
    except _Wrong as wrong:
        raise ConfigError(f"{key}, {wrong}") from None
    except (OSError, ValueError) as reason:
        raise ConfigError(f"{key}, which cannot be read: {getattr(reason, 'strerror', None) or reason}") from reason
    return {other: value for other, value in entry.items() if other != "file"} | data


# Rows


def beams(content: str) -> list[Beam]:
    """Single beams from the text of a file; lines that begin with # are comments."""
    lines = ((k, line) for k, line in enumerate(content.removeprefix("\ufeff").splitlines(), 1) if line.strip(" ,"))
    rows = [(k, [cell.strip() for cell in next(csv.reader([line]))]) for k, line in lines if line[0] != "#"]
    if not rows:
        raise _Wrong(f"which is empty, must begin with the names of its columns: {','.join(COLUMNS)}")
    (first, columns), *others = rows
    _check_columns(first, columns)
    if not others:
        raise _Wrong("which holds no beam, must have a row for every beam")
    return [_beam(row, cells, columns) for row, cells in others]


def _check_columns(row, columns):
    """Refuse columns that are unknown, missing or given twice."""
    for name in columns:
        if name not in COLUMNS:
            hint = "; separate columns by commas" if ";" in name or "\t" in name else did_you_mean(name, COLUMNS)
            raise _Wrong(f"row {row}: column {shown(name)} is unknown, must be among {', '.join(COLUMNS)}{hint}")
    missing = [name for name in COLUMNS[:2] if name not in columns]
    if missing or len(set(columns)) < len(columns):
        raise _Wrong(
            f"row {row}: the columns are {', '.join(columns)}, must have {' and '.join(COLUMNS[:2])}, each once"
        )


def _beam(row, cells, columns):
    """Beam of a row."""
    if len(cells) != len(columns):
        raise _Wrong(f"row {row}: it has {len(cells)} values, must have {len(columns)}, with points in decimal numbers")
    of = dict.fromkeys(COLUMNS, "") | dict(zip(columns, cells, strict=True))
    humidity = 0.0 if of["humidity"] == DRY else _number(row, of, "humidity", 1, "as a fraction of 1, or dry")
    length = _number(row, of, "length_um", math.inf, "in µm")
    if bool(of["crack_length_um"]) == bool(of["stuck"]):
        raise _Wrong(f"row {row}: it must have either crack_length_um or stuck")
    if of["stuck"]:
        if of["stuck"].lower() not in _WORDS:
            raise _Wrong(f"row {row}: stuck is {shown(of['stuck'])}, must be yes or no")
        return Beam(row, humidity, length, None, _WORDS[of["stuck"].lower()])
    crack = _number(row, of, "crack_length_um", length, f"below the length of the beam, {length:g} µm")
    return Beam(row, humidity, length, crack, None)


def _number(row, cells, column, limit, words):
    """Number of a cell between zero and a limit."""
    try:
        value = float(cells[column])
    except ValueError:
        value = math.nan
    if not 0 < value < limit:
        raise _Wrong(f"row {row}: {column} is {shown(cells[column])}, must be a number above 0, {words}")
    return value


# Means and counts


def summary(found: list[Beam]) -> dict[str, Any]:
    """Keys of an array: means of crack lengths by humidity, and counts by humidity and length."""
    measured = [beam for beam in found if beam.stuck is None]
    counted = [beam for beam in found if beam.stuck is not None]
    data = {}
    if measured:
        other = next((beam for beam in measured if beam.length != measured[0].length), None)
        if other is not None:
            raise _Wrong(
                f"row {other.row}: length_um is {other.length:g}, must be {measured[0].length:g} as in row "
                f"{measured[0].row}: all beams with crack lengths are equal"
            )
        data["length_um"] = measured[0].length
        data["crack_lengths"] = [_mean(humidity, group) for humidity, group in _groups(measured, "humidity")]
    if counted:
        data["stuck"] = [
            {"humidity": humidity, "length_um": length, "stuck": sum(beam.stuck for beam in group), "of": len(group)}
            for (humidity, length), group in _groups(counted, "humidity", "length")
        ]
    return data


def _mean(humidity, group):
    """Mean crack length of beams at a humidity."""
    lengths = [beam.crack_length for beam in group]
    if len(set(lengths)) < 2:
        raise _Wrong(
            f"row {group[0].row}: crack_length_um must have different values in at least two rows at humidity "
            f"{humidity:g}: their standard deviation gives the error of the mean"
        )
    return {"humidity": humidity, "mean_um": fmean(lengths), "std_um": stdev(lengths), "beams": len(group)}


def _groups(found, *fields):
    """Beams with equal values of some fields, in the order of these values."""
    groups = {}
    for beam in found:
        values = tuple(getattr(beam, field) for field in fields)
        groups.setdefault(values if len(values) > 1 else values[0], []).append(beam)
    return sorted(groups.items())
