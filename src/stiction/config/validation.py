"""Validation of a whole configuration: schema, relations between its keys, files of scans."""

from pathlib import Path

from stiction.config import arrays, measured, relations, relations_devices
from stiction.config.cases import in_numbers
from stiction.config.conditions import Keys, Relations
from stiction.config.messages import ConfigError, Problem, schema_problems
from stiction.config.relations import schema

#: All relations between keys.
RELATIONS = Relations([*relations.relation, *relations_devices.relation])
#: Sections that a configuration need not have.
_OPTIONAL = {"materials": {}, "devices": {}, "test_beams": {}}


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
        Preliminary numbers of the measured surfaces by name, see `stiction.config.measured.preliminary_estimates`.

    Raises
    ------
    ConfigError
        If the configuration is invalid; one line per problem: full key, value, allowed values.
    """
    config = in_numbers(config)
    faults = schema_problems(config, schema())
    wrong = [fault.path for fault in faults]
    sections = _OPTIONAL | config if isinstance(config, dict) else config
    broken = _broken(sections, wrong)
    of_surfaces = [problem.path for problem in broken if problem.path[0] == "surfaces"]
    found, refused = measured.preliminary_estimates(config, wrong + of_surfaces, kept)
    problems = faults + broken + refused
    if found:
        files = {name: config["surfaces"][name]["scans"]["files"] for name in found}
        problems += _broken(measured.with_preliminary_estimates(sections, found), wrong, files)
    if problems:
        raise ConfigError(*dict.fromkeys(map(str, problems)))
    return found


def _broken(config, faults, files=None):
    """Violated relations; those of devices hold for the arrays of test beams, whose keys they name."""
    broken = list(RELATIONS.problems(Keys(config, faults, files or {})))
    if any(path[:1] in ((), ("devices",), ("test_beams",)) for path in faults):
        return broken  # sections that are wrong on their own
    beams = Keys(config | {"devices": arrays.as_cantilevers(config)}, faults, files or {})
    return broken + [_of_array(problem, config) for problem in relations_devices.relation.problems(beams)]


def _of_array(problem, config):
    """Problem of an array of test beams that was found as if the array were a device."""
    path, message = problem.path, problem.message.replace("devices.", "test_beams.")
    if path[0] == "devices":
        array = config["test_beams"][path[1]]
        data = next(filter(array.__contains__, arrays.DATA))
        path = ("test_beams", *(data if key == "humidities" else key for key in path[1:]))
    return Problem(path, message)
