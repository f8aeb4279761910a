"""Validation of a whole configuration: schema, relations between its keys, files of scans."""

from dataclasses import dataclass, field
from pathlib import Path

from stiction.config import meetings, relations, relations_devices, scans, test_beams
from stiction.config.cases import in_numbers, in_words
from stiction.config.keys import Keys, Relations
from stiction.config.messages import ConfigError, schema_problems
from stiction.config.reading import paper
from stiction.config.relations import schema
from stiction.config.surfaces import described, grid, process, process_relations

#: Relations between the keys of devices, and of arrays of test beams in their place.
_OF_DEVICES = Relations([*meetings.relation, *relations_devices.relation])
#: All relations between keys.
RELATIONS = Relations(
    [*relations.relation, *_OF_DEVICES, *relations_devices.relation_of_tips, *process_relations.relation]
)
#: Sections that a configuration need not have.
_OPTIONAL = {"materials": {}, "devices": {}, "test_beams": {}, "process": {}}


def validate(config: dict, kept: str | Path | None = None) -> dict[str, dict]:
    """Check a configuration against the schema and the relations between its keys, and the files of its scans.

    Measured surfaces are checked with their preliminary estimates.

    Parameters
    ----------
    config : dict
        Complete configuration.
    kept : path, optional
        Folder in which the preliminary numbers of measured surfaces are kept between processes.

    Returns
    -------
    dict
        Preliminary numbers of the measured surfaces by name, see `stiction.config.scans.preliminary_estimates`.

    Raises
    ------
    ConfigError
        If the configuration is invalid; one line per problem: full key, value, allowed values.
    """
    stated = config
    config = in_numbers(test_beams.without_files(config))
    faults = schema_problems(config, schema())
    wrong = [path for fault in faults for path in (fault.path, *fault.others)]
    surfaces, incomplete, origins = _completed(config, wrong)
    sections = grid.completed(surfaces, {}, wrong)
    wrong += [problem.path for problem in incomplete]
    broken = _broken(sections, wrong, origins=origins)
    of_surfaces = [problem.path for problem in broken if problem.path[0] == "surfaces"]
    estimates, refused = scans.preliminary_estimates(config, wrong + of_surfaces, kept)
    problems = faults + incomplete + broken + refused
    if estimates and scans.simulates(sections):
        files = {name: config["surfaces"][name]["scans"]["files"] for name in estimates}
        on_grid = grid.completed(surfaces, estimates, wrong)
        problems += _broken(scans.with_preliminary_estimates(on_grid, estimates), wrong, files, origins)
    if problems:
        said = process.in_settings(problems, config if isinstance(config, dict) else {})
        raise ConfigError(*dict.fromkeys(test_beams.in_files(problem, stated) for problem in said))
    return estimates


def _completed(config, faults):
    """Configuration with all sections and complete surfaces, its problems, and the source keys of surfaces."""
    if any(len(fault) < 2 and fault[:1] in ((), ("surfaces",)) for fault in faults):
        return _OPTIONAL | config if isinstance(config, dict) else config, [], {}
    sections, problems = described.completed(_OPTIONAL | config, paper()["surfaces"], faults)
    return sections, problems, described.origins(config)


def _broken(config, faults, files=None, origins=None):
    """Violated relations. Those of devices hold for the arrays of test beams."""
    files, origins = files or {}, origins or {}
    broken = list(RELATIONS.problems(Keys(config, faults, files, origins)))
    if any(path[:1] in ((), ("devices",), ("test_beams",)) for path in faults):
        return broken  # sections that are wrong on their own
    single = [
        _KeysOfArrays(config | {"devices": beams, "run": {"pairs": []}}, faults, files, origins, config["devices"])
        for beams in test_beams.at_single_humidities(config)
    ]
    return broken + [problem for one in _OF_DEVICES for problem in _problems_of_arrays(one, single)]


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
