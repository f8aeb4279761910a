"""Arrays of test beams in a configuration: their cantilevers, and single beams in CSV files.

Whatever is computed for an array is computed for a cantilever of its dimensions at the humidities of its data.

In a file, a row is a beam: measured if it has a crack length, counted if it says whether it is stuck. The configuration
has the means and counts from the start; what is wrong with them is said with the row, and nothing else knows of files.
"""

import math
from collections.abc import Iterator, Mapping
from itertools import zip_longest
from pathlib import Path
from statistics import fmean, median, stdev
from typing import Any, NamedTuple

from stiction.config.kinds import KEYS
from stiction.config.merging import section_at
from stiction.config.messages import ConfigError, one_line
from stiction.config.reading import text
from stiction.config.tables import csv_rows
from stiction.config.tables.csv_rows import WrongFileError
from stiction.contact.air import DRY, humid

#: Keys of an array that list what was measured.
DATA = ("crack_lengths", "stuck")
#: Key of pull-off forces of a device, which key ``probe`` names. They come in place of an array.
PULL_OFFS = "pull_offs"
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
#: Ratio of crack lengths of equal beams at a humidity from which one is in mm and the other in µm: between 1 and 1000.
_OTHER_UNIT = math.sqrt(1000)


def users(config: Mapping, array: str) -> dict[str, dict]:
    """Devices with predictions from an array, by name."""
    devices = config.get("devices", {})
    return {name: device for name, device in devices.items() if array in device.get("test_beams", ())}


def humidities(array: Mapping, *kinds: str) -> list[float]:
    """Humidities of the data of an array, increasing. ``kinds`` selects data, by default all."""
    return sorted({datum["humidity"] for kind in kinds or DATA for datum in array.get(kind, ())})


def pair_of(config: Mapping, array: str) -> str:
    """Pair of an array, or of the probe of its pull-off forces."""
    section = config["test_beams"][array]
    return (config["devices"][section["probe"]] if PULL_OFFS in section else section)["pair"]


def pulled(config: Mapping, device: str) -> dict[str, dict]:
    """Sections with pull-off forces among the test beams of a device, by name."""
    named = {name: config["test_beams"][name] for name in config["devices"][device].get("test_beams", ())}
    return {name: section for name, section in named.items() if PULL_OFFS in section}


def first_datum(array: Mapping, humidity: float) -> tuple[str, int]:
    """Key and index of the first data of an array at one of its humidities."""
    data = ((kind, k, datum) for kind in DATA for k, datum in enumerate(array.get(kind, ())))
    return next((kind, k) for kind, k, datum in data if datum["humidity"] == humidity)


def shared_uncertainty(device: Mapping) -> dict[str, float]:
    """Uncertainties of a device apart from those of its dimensions: its test beams have the same inputs."""
    stated = device.get("uncertainty", {})
    return {key: value for key, value in stated.items() if key not in KEYS}


def as_cantilevers(config: Mapping) -> dict[str, dict]:
    """Sections of all arrays with data as if they were devices."""
    arrays = config.get("test_beams", {})
    measured_at = {name: humidities(array) for name, array in arrays.items()}
    return {name: _cantilever(config, name, values) for name, values in measured_at.items() if values}


def at_single_humidities(config: Mapping) -> list[dict[str, dict]]:
    """Sections as of `as_cantilevers` with one humidity each, those with the highest humidity of every array first."""
    rows = zip_longest(*(humidities(array)[::-1] for array in config["test_beams"].values()))
    return [
        {
            name: _cantilever(config, name, [humidity])
            for name, humidity in zip(config["test_beams"], row, strict=True)
            if humidity is not None
        }
        for row in rows
    ]


def counts_as_devices(config: Mapping) -> dict[str, dict]:
    """Sections of the arrays with counts as if they were devices: their tips may hold them."""
    return {name: device for name, device in as_cantilevers(config).items() if "stuck" in config["test_beams"][name]}


def _cantilever(config, name, measured_at):
    """Section of an array at some of its humidities, with itself as its test beams."""
    array = config["test_beams"][name]
    shared = {key: value for user in users(config, name).values() for key, value in shared_uncertainty(user).items()}
    if not humid(measured_at):  # dry air has no humidity that could be uncertain
        shared = {key: value for key, value in shared.items() if key != "humidity"}
    sizes = {key: array[key] for key in _SIZES if key in array}
    stated = {"humidities": measured_at, "uncertainty": shared | array.get("uncertainty", {}), "test_beams": [name]}
    return {"kind": "cantilever"} | sizes | stated


# Files of single beams


class BeamRow(NamedTuple):
    """One row."""

    row: int  #: line of the file
    humidity: float  #: [-]
    length: float  #: [µm]
    crack_length: float | None  #: [µm]
    stuck: bool | None


class Origin(NamedTuple):
    """Stands in for a file name once the file has been read."""

    file: str  #: name
    beams: list[BeamRow]


def with_files(config: dict[str, Any], named: Mapping[str, Any], folder: str | Path) -> dict[str, Any]:
    """Configuration, valid or not, with means and counts from the files named by the content.

    The `Origin` of the data takes the place of the name of a file, until `without_files` removes it. ``named`` is the
    content of a configuration file, and ``folder`` the folder of this file.

    Raises
    ------
    ConfigError
        If a file cannot be used; one sentence with the key, the file, the row and the column.
    """
    files = {name: entry["file"] for name, entry in _arrays(named)}
    named_here = {name: entry for name, entry in _arrays(config) if entry["file"] == files.get(name)}
    replaced = {name: _with_file(name, entry, Path(folder)) for name, entry in named_here.items()}
    return config | {"test_beams": config["test_beams"] | replaced} if replaced else config


def _arrays(config) -> Iterator[tuple[str, dict]]:
    """Yield arrays with a file."""
    for name, entry in section_at(config, "test_beams").items():
        if isinstance(section_at(entry).get("file"), str):
            yield name, entry


def _with_file(name, entry, folder):
    """Section of an array with the content of its file."""
    key = f"test_beams.{name}.file is {one_line(entry['file'])}"
    stated = [other for other in _REPLACED if other in entry]
    if stated:
        raise ConfigError(f"{key}, must come without {', '.join(stated)}: the file has them")
    try:
        rows = beams(text(folder / entry["file"]))
        data = summary(rows)
    except WrongFileError as wrong:
        raise ConfigError(f"{key}, {wrong}") from None
    except (OSError, ValueError) as reason:
        raise ConfigError(f"{key}, which cannot be read: {getattr(reason, 'strerror', None) or reason}") from reason
    return entry | {"file": Origin(entry["file"], rows)} | data


def without_files(config: Any) -> Any:
    """Configuration, valid or not, without the origins of data from files."""
    if not (read := _origins(config)):
        return config
    arrays = config["test_beams"]
    without = {name: {key: value for key, value in arrays[name].items() if key != "file"} for name in read}
    return config | {"test_beams": arrays | without}


def in_files(sentence: str, config: Any) -> str:
    """Sentence with file, row and column in place of the keys of data from files."""
    for name, origin in _origins(config).items():
        for key, row, words in _places(origin.beams, config["test_beams"][name]):
            row_in_file = f"test_beams.{name}.file is {one_line(origin.file)}, row {row}: {words}"
            sentence = sentence.replace(f"test_beams.{name}.{key}", row_in_file)
    return sentence


def _origins(config):
    """Origins by the name of the array."""
    files = {name: section_at(entry).get("file") for name, entry in section_at(config, "test_beams").items()}
    return {name: origin for name, origin in files.items() if isinstance(origin, Origin)}


#: Values that a file does not have in a column of the same name.
_STATISTICS = {
    "mean_um": "the mean of crack_length_um at its humidity",
    "std_um": "the standard deviation of crack_length_um at its humidity",
}


def _places(of_file, array):
    """Yield keys of the data of an array from beams, the first row of each, and its column in words."""
    data = summary(of_file)
    for kind, groups in _by_kind(of_file).items():
        if groups and array.get(kind) == data[kind]:  # another file of the configuration may replace a list
            first = [group[0].row for _, group in groups]
            yield from (
                (f"{kind}[{k}].{key}", first[k], _STATISTICS.get(key, key))
                for k, datum in enumerate(data[kind])
                for key in datum
            )
            if kind == "crack_lengths":
                yield "length_um", min(first), "length_um"


# Rows


def beams(content: str) -> list[BeamRow]:
    """Single beams from the text of a file. Lines beginning with # are comments."""
    return [_beam(row, cells) for row, cells in csv_rows.rows(content, COLUMNS, COLUMNS[:2], "beam")]


def _beam(row, cells):
    """Beam of a row."""
    row_cells = dict.fromkeys(COLUMNS, "") | cells
    humidity = (
        0.0 if row_cells["humidity"] == DRY else _number(row, row_cells, "humidity", 1, "as a fraction of 1, or dry")
    )
    length = _number(row, row_cells, "length_um", math.inf, "in µm")
    if bool(row_cells["crack_length_um"]) == bool(row_cells["stuck"]):
        raise WrongFileError(f"row {row}: it must have either crack_length_um or stuck")
    if row_cells["stuck"]:
        if row_cells["stuck"].lower() not in _WORDS:
            raise WrongFileError(f"row {row}: stuck is {one_line(row_cells['stuck'])}, must be yes or no")
        return BeamRow(row, humidity, length, None, _WORDS[row_cells["stuck"].lower()])
    crack = _number(row, row_cells, "crack_length_um", length, f"below the length of the beam, {length:g} µm")
    return BeamRow(row, humidity, length, crack, None)


def _number(row, cells, column, limit, words):
    """Number of a cell between zero and a limit."""
    try:
        value = float(cells[column])
    except ValueError:
        value = math.nan
    if not 0 < value < limit:
        raise WrongFileError(f"row {row}: {column} is {one_line(cells[column])}, must be a number above 0, {words}")
    return value


# Means and counts


def summary(beams: list[BeamRow]) -> dict[str, Any]:
    """Keys of an array: means of crack lengths by humidity, and counts by humidity and length."""
    measured, counted = _by_kind(beams).values()
    data = {}
    if measured:
        first, *others = sorted(beam for _, group in measured for beam in group)
        other = next((beam for beam in others if beam.length != first.length), None)
        if other is not None:
            raise WrongFileError(
                f"row {other.row}: length_um is {other.length:g}, must be {first.length:g} as in row {first.row}: all "
                "beams with crack lengths are equal"
            )
        data["length_um"] = first.length
        data["crack_lengths"] = [_mean(humidity, group) for (humidity,), group in measured]
    if counted:
        data["stuck"] = [
            {"humidity": humidity, "length_um": length, "stuck": sum(beam.stuck for beam in group), "of": len(group)}
            for (humidity, length), group in counted
        ]
    return data


def _by_kind(of_array):
    """Groups of equal beams by the key of their data: beams with crack lengths, and counted beams."""
    measured = [beam for beam in of_array if beam.stuck is None]
    counted = [beam for beam in of_array if beam.stuck is not None]
    return {"crack_lengths": _groups(measured, "humidity"), "stuck": _groups(counted, "humidity", "length")}


def _mean(humidity, group):
    """Mean crack length of beams at a humidity."""
    _require_one_unit(group)
    lengths = [beam.crack_length for beam in group]
    if len(set(lengths)) < 2:
        raise WrongFileError(
            f"row {group[0].row}: crack_length_um must have different values in at least two rows at humidity "
            f"{humidity:g}: their standard deviation gives the error of the mean"
        )
    return {"humidity": humidity, "mean_um": fmean(lengths), "std_um": stdev(lengths), "beams": len(group)}


def _require_one_unit(group):
    """Refuse a crack length in mm among those in µm, or the reverse. Their mean may hide it."""
    usual = median(beam.crack_length for beam in group)
    off = max(group, key=lambda beam: abs(math.log(beam.crack_length / usual)))
    other = max(group, key=lambda beam: abs(math.log(beam.crack_length / off.crack_length)))
    if max(off.crack_length / other.crack_length, other.crack_length / off.crack_length) > _OTHER_UNIT:
        raise WrongFileError(
            f"row {off.row}: crack_length_um is {off.crack_length:g}, but {other.crack_length:g} in row {other.row}: "
            "all must be in µm"
        )


def _groups(beams, *fields):
    """Beams with equal values of some fields, in the order of these values."""
    groups = {}
    for beam in beams:
        groups.setdefault(tuple(getattr(beam, field) for field in fields), []).append(beam)
    return sorted(groups.items())
