"""Validation of a whole configuration: schema, relations between its keys, files of scans.

Each step ends the check if it refuses something, so that the next one sees sections as it needs them: of the right
types, then with all humidities, then with names of what exists, then with surfaces by numbers.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

from stiction.config import materials, meetings, relations, relations_devices, scans, test_beams
from stiction.config.cases import in_numbers, in_words
from stiction.config.evidence import pull_offs
from stiction.config.keys import Keys, Relations
from stiction.config.merging import expanded, merged
from stiction.config.messages import ConfigError, Problem, schema_problems
from stiction.config.mission import airs
from stiction.config.mission.conditions import CONDITIONS
from stiction.config.reading import paper
from stiction.config.relations import schema
from stiction.config.surfaces import described, grid, process, process_relations, profiles
from stiction.config.tables import device_table

#: Relations between the names and the keys of devices, then between their values. Those of arrays of test beams, too.
_NAMES_OF_DEVICES = relations_devices.relation_of_names
_OF_DEVICES = Relations([*meetings.relation, *relations_devices.relation])
#: Relations between names and keys that are given or not, and those between values, where the first hold.
NAMES = Relations(
    [
        *relations.relation_of_names,
        *_NAMES_OF_DEVICES,
        *pull_offs.relation_of_names,
        *process_relations.relation,
    ]
)
RELATIONS = Relations(
    [
        *relations.relation,
        *airs.relation,
        *_OF_DEVICES,
        *relations_devices.relation_of_tips,
        *pull_offs.relation,
    ]
)
#: Sections that a configuration need not have.
_OPTIONAL = {"materials": {}, "devices": {}, "test_beams": {}, "process": {}}


class Checked(NamedTuple):
    """Valid configuration."""

    config: dict[str, Any]  #: complete and in normal form
    estimates: dict[str, dict]  #: of its measured surfaces, see `stiction.config.scans.preliminary_estimates`


def checked(stated: Any, kept: Path | None = None) -> Checked:
    """Check and complete a configuration, as its files state it. The numbers of its scans are kept in a folder.

    Raises
    ------
    ConfigError
        If it is invalid; one line per problem: full key, or row of the file of devices, value, allowed values.
    """
    stated, of_file = device_table.without_file(device_table.with_rows(stated))
    try:
        valid = _checked(stated, kept)
    except ConfigError as error:
        raise ConfigError(*device_table.in_rows(error.problems, of_file)) from error
    if not of_file.numbers:
        return valid
    return valid._replace(config=merged(valid.config, {"design": {"order": list(of_file.numbers)}}))


def _checked(stated, kept):
    """Checked configuration without a file of devices. Raises the errors of `checked`."""
    stated, plain = _typed(stated, kept)
    library = paper()["surfaces"]
    _refuse(_broken(NAMES, _NAMES_OF_DEVICES, Keys(_OPTIONAL | plain)), stated, plain)
    _refuse(described.problems(plain, library), stated, plain)
    plain = airs.bracketed(plain)
    estimates, unusable = scans.preliminary_estimates(plain, kept)
    _refuse(unusable, stated, plain)
    config = grid.completed(described.completed(plain, library), estimates)
    by_numbers = _by_numbers(config, estimates, described.origins(plain))
    shown = {"figures": {"humidity": meetings.shown_humidity(by_numbers)}}
    config, by_numbers = merged(config, shown), replace(by_numbers, config=merged(by_numbers.config, shown))
    _refuse(_broken(RELATIONS, _OF_DEVICES, by_numbers), stated, plain)
    return Checked(normalised(config), estimates)


def _typed(stated, kept):
    """Configuration with all its airs, surfaces and copies, as stated and in plain values, which the schema allows."""
    stated = airs.with_keys_of_airs(stated)
    sections = _plain(airs.with_any_air(meetings.with_any_humidity(stated)))
    _refuse(schema_problems(sections, schema()), stated, {})
    _refuse(airs.relation_of_conditions.problems(Keys(_OPTIONAL | sections)), stated, {})
    stated, unreadable = profiles.with_numbers(airs.expanded(meetings.at_dew_points(stated)), kept)
    _refuse(unreadable, stated, {})
    stated = process.with_surfaces(expanded(materials.with_named(stated)))
    if (plain := _plain(stated)) != sections:  # with airs, copies and surfaces of settings
        _refuse(schema_problems(plain, schema()), stated, plain)
    return stated, plain


def _plain(stated):
    """Configuration without the files of test beams and without the word for dry air."""
    return in_numbers(test_beams.without_files(stated))


def _refuse(problems: Iterable[Problem], stated: Any, plain: dict[str, Any]) -> None:
    """Raise problems with the keys and files of the user, each once."""
    if problems := list(problems):
        lines = process.in_settings(problems, plain)
        raise ConfigError(*dict.fromkeys(test_beams.in_files(line, stated) for line in lines))


def _by_numbers(config, estimates, origins):
    """Configuration in which numbers describe all surfaces that are simulated."""
    estimates = estimates if scans.simulates(config) else {}
    files = {name: config["surfaces"][name]["scans"]["files"] for name in estimates}
    uncertain = described.with_uncertain_devices(config)
    return Keys(_OPTIONAL | scans.with_preliminary_estimates(uncertain, estimates), files, origins)


def _broken(relations: Relations, of_devices: Relations, keys: Keys) -> Iterator[Problem]:
    """Yield violated relations. Those of devices hold for the arrays of test beams."""
    yield from relations.problems(keys)
    config = keys.config
    single = [
        _KeysOfArrays(config | {"devices": beams, "run": {"pairs": []}}, keys.files, keys.origins, config["devices"])
        for beams in test_beams.at_single_humidities(config)
    ]
    for relation in of_devices:
        yield from _problems_of_arrays(relation, single)


def _problems_of_arrays(relation, single):
    """Problems of arrays with one relation, each key once."""
    problems = {}
    for keys in single:
        for problem in Relations([relation]).problems(keys):
            problems.setdefault(problem.path, problem)
    return problems.values()


@dataclass(frozen=True)
class _KeysOfArrays(Keys):
    """Keys of arrays as devices, each at one of its humidities. Problems name the keys of users."""

    bounds_films: ClassVar[bool] = False

    devices: dict = field(default_factory=dict)  #: those of the configuration

    def _origin(self, key):
        path, value = super()._origin(key)
        if path[0] != "devices":
            return path, value
        _, name, *below = path
        array = self.config["test_beams"][name]
        if below[0] == "humidities":
            humidity = self.config["devices"][name]["humidities"][0]
            path = "test_beams", name, *test_beams.first_datum(array, humidity), "humidity"
            return path, in_words(humidity, path)
        if below[0] == "uncertainty" and below[-1] not in array.get("uncertainty", {}):
            return ("devices", next(iter(test_beams.users({"devices": self.devices}, name))), *below), value
        return ("test_beams", name, *below), value


# Normal form


def normalised(config: dict) -> dict:
    """Complete and valid configuration in normal form: equivalent settings are equal, whatever their order in the file.

    Keys are sorted, so that the parameters of a rule do not depend on their order. The humidities of each pair and
    device are sorted as well, so that tables and curves begin with the lowest. Surfaces by scans, or described as in
    papers, get all their keys. Dry air has the humidity 0. Data of test beams are without the files of their beams.
    """
    config = described.completed(_plain(config), paper()["surfaces"])
    named = {section: config[section] for section in ("pairs", "devices") if section in config}
    surfaces = {name: scans.complete(entry) for name, entry in config["surfaces"].items()}
    in_order = {section: _sorted(entries) for section, entries in named.items()}
    return _in_order(config | in_order | {"surfaces": surfaces})


#: Lists of pairs and devices whose order has no meaning, and how they are sorted.
_ORDER = {"humidities": sorted, CONDITIONS: partial(sorted, key=lambda condition: sorted(condition.items()))}


def _sorted(entries):
    """Pairs or devices with their humidities and conditions sorted."""
    return {
        name: entry | {key: _ORDER[key](entry[key]) for key in _ORDER if key in entry}
        for name, entry in entries.items()
    }


def _in_order(value):
    """Value with the keys of all nested sections sorted."""
    return {key: _in_order(value[key]) for key in sorted(value)} if isinstance(value, dict) else value
