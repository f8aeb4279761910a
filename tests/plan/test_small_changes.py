"""No number of the configuration is a hidden switch: what is computed changes as little as the number does."""

import math
import re

import pytest

from stiction.config.files import load
from stiction.config.merging import merged
from stiction.config.messages import ConfigError, schema_problems
from stiction.config.reading import paper
from stiction.config.relations import schema
from stiction.config.validation import checked
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan

#: Relative changes of numbers, and of humidities, which have at most four decimals.
STEP, OF_HUMIDITY = 1e-7, 1e-4
#: A pair and a device that are not the paper's, so that more sections are used.
MORE = {
    "pairs": {"mine": {"beam": "B1", "substrate": "Sub2", "gap_um": 3.0, "humidities": [0.55]}},
    "devices": {
        "C1": {
            "kind": "cantilever",
            "pair": "b",
            "thickness_um": 2.6,
            "gap_um": 20,
            "width_um": 30,
            "humidities": [0.67],
        }
    },
    "run": {"pairs": ["a", "b", "c", "mine"]},
}
#: Lengths of grids. A change leaves no whole number of points.
ON_GRIDS = r"beam\.(length|width)_um|sampling\.(spacing_nm|strip_length_um)|identification\.patch_um"
ON_GRIDS += r"|character\.spacing_nm|devices\.C1\.width_um|studies\.variants\.spacing_nm"
#: Lengths of a study of grids, which leaves out those that do not divide each other.
OF_MESHES = r"studies\.mesh\..*"
#: The share of all samples.
ALL = ("studies", "sample_shares", 4)
#: Endings of keys with numbers that are no counts.
UNITS = ("um", "nm", "um2", "nm4", "K", "GPa")


def numbers(value, path=()):
    """Path and value of every number of a configuration."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        yield path, value
    elif isinstance(value, dict | list):
        for key, inner in value.items() if isinstance(value, dict) else enumerate(value):
            yield from numbers(inner, (*path, key))


def keys_of(path):
    """Names of the keys of a number."""
    return [key for key in path if isinstance(key, str)]


def of_pattern(path, pattern):
    """Whether a pattern matches the full key of a number."""
    return bool(re.fullmatch(pattern, ".".join(keys_of(path))))


def is_measured(path, value):
    """Whether a number is no count."""
    return isinstance(value, float) or path == ALL or any(key.endswith(UNITS) for key in keys_of(path))


def can_change(path, value):
    """Whether a number is no count, no length of a grid and no largest value."""
    return is_measured(path, value) and not of_pattern(path, f"{ON_GRIDS}|{OF_MESHES}") and path != ALL


def is_humidity(path):
    """Whether a key holds humidities."""
    return {"humidity", "humidities"} & {*path} and path[0] in ("pairs", "figures", "devices")


def slightly_larger(path, value):
    """Slightly larger number."""
    return round(value + OF_HUMIDITY, 4) if is_humidity(path) else value * (1 + STEP)


def shifted(value, keys, path=(), change=slightly_larger):
    """Configuration with other numbers at some paths."""
    if isinstance(value, dict):
        return {key: shifted(inner, keys, (*path, key), change) for key, inner in value.items()}
    if isinstance(value, list):
        return [shifted(inner, keys, (*path, key), change) for key, inner in enumerate(value)]
    return change(path, value) if path in keys else value


def settings(config):
    """Settings of all jobs of a run in the order of their files, without the numbers in these."""
    jobs = Graph(Plan(load(config))).needed("tables", "figures", "devices", "all")
    by_file = sorted((job.names[0], job.settings) for job in jobs if job.names)
    return [(re.sub(r"_rh\d+|(?<=poisson_ratio_)[\d.]+", "", name), found) for name, found in by_file]


def differences(value, other, step, path=()):
    """Paths at which settings differ by more than a relative change of a number explains."""
    if isinstance(value, dict) and isinstance(other, dict):
        value, other = (
            [[re.sub(r"_rh\d+", "", str(key)), inner] for key, inner in one.items()] for one in (value, other)
        )
    if isinstance(value, list | tuple) and isinstance(other, list | tuple) and len(value) == len(other):
        return [found for k in range(len(value)) for found in differences(value[k], other[k], step, (*path, k))]
    if isinstance(value, float | int) and isinstance(other, float | int) and not isinstance(value, bool):
        return [] if math.isclose(value, other, rel_tol=100 * step) else [(*path, value, other)]
    alike = [re.sub(r"_rh\d+|[\d.]+(e-\d+)?", "#", str(one)) for one in (value, other)]
    return [] if alike[0] == alike[1] else [(*path, value, other)]


CONFIG = merged(paper(), MORE)


@pytest.mark.parametrize("of_humidity", [False, True], ids=["numbers", "humidities"])
def test_small_changes_of_all_numbers_are_small_changes_of_all_settings(of_humidity):
    step = OF_HUMIDITY if of_humidity else STEP
    found = {path for path, value in numbers(CONFIG) if can_change(path, value)}
    keys = {path for path in found if bool(is_humidity(path)) == of_humidity}
    assert len(keys) > (15 if of_humidity else 60)
    before, after = settings(CONFIG), settings(shifted(CONFIG, keys))
    assert [name for name, _ in before] == [name for name, _ in after]
    assert differences(before, after, step) == []


@pytest.mark.parametrize("path", [path for path, _ in numbers(CONFIG) if of_pattern(path, ON_GRIDS) or path == ALL])
def test_a_length_that_fits_no_grid_is_refused(path):
    with pytest.raises(ConfigError, match="multiple|whole|at most 1"):
        checked(shifted(CONFIG, {path}))


def test_all_other_numbers_are_whole():
    counts = {path for path, value in numbers(CONFIG) if not is_measured(path, value)}
    halves = shifted(CONFIG, counts, change=lambda path, value: value + 0.5)
    assert {problem.path for problem in schema_problems(halves, schema())} == counts
    assert len(counts) > 30


@pytest.mark.parametrize("change", [{"beam": {"thickness_um": 2.7}}, {"pairs": {"b": {"attraction": "all"}}}])
def test_larger_changes_and_switches_are_found(change):
    assert differences(settings(CONFIG), settings(merged(CONFIG, change)), STEP)
