"""Experiments of the benchmark: files ``validation/NAME.yaml``, checked here and nowhere else."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import numpy as np
import yaml

from stiction.config.messages import schema_problems

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "validation"
SCHEMA = Path(__file__).with_name("schema.yaml")
#: Factors from SI to the units of rows.
FROM_SI = {"-": 1.0, "nN": 1e9, "µN": 1e6, "MPa": 1e-6, "mJ/m²": 1e3, "µJ/m²": 1e6, "nm": 1e9, "µm": 1e6}
#: Exactly one of these is what was measured.
MEASURED = ("value", "at_most", "at_least")
#: Laws on a linear scale. All others are compared by their logarithms.
LINEAR = ("exponent", "maximum")


@dataclass(frozen=True)
class Assumed:
    """Input that the source does not state: a range or equally probable values."""

    why: str
    range: tuple = ()
    scale: str = "uniform"
    one_of: tuple = ()
    larger: str = "either"

    def at(self, quantile: float):
        """Value at a quantile in [0, 1), to four digits, which names of files can hold.

        Examples
        --------
        >>> Assumed("", (1, 100), "log").at(0.5), Assumed("", (1, 3)).at(0.5), Assumed("", one_of=("a", "b")).at(0.5)
        (10.0, 2.0, 'b')
        """
        if self.one_of:
            return self.one_of[int(quantile * len(self.one_of))]
        ends = np.log(self.range) if self.scale == "log" else np.array(self.range, float)
        value = ends[0] + quantile * (ends[1] - ends[0])
        return float(f"{np.exp(value) if self.scale == 'log' else value:.4g}")


@dataclass(frozen=True)
class Row:
    """One measured quantity and the states whose law it is."""

    quantity: str
    kind: str
    unit: str
    value: float = np.nan  #: in its unit, as error and bounds
    error: float = 0.0
    at_most: float = np.nan
    at_least: float = np.nan
    reading: str = ""
    observable: str = ""  #: in place of that of the setup
    constants: dict = field(default_factory=dict)  #: variables of this row
    along: dict = field(default_factory=dict)  #: name and values of the variable of its states
    powers: tuple = (1.0, -1.0)
    falls_to: float = np.nan
    reason: str = ""
    side: str = ""

    @property
    def is_bound(self) -> bool:
        """Whether only a bound was measured."""
        return np.isnan(self.value)

    @property
    def states(self) -> list[dict]:
        """Variables of each state."""
        varied = [{self.along["name"]: value} for value in self.along["values"]] if self.along else [{}]
        return [self.constants | state for state in varied]


@dataclass(frozen=True)
class Experiment:
    """One experiment: source, facts, assumed inputs, what is computed, rows."""

    name: str
    title: str
    laboratory: str
    source: dict
    stated: tuple
    rows: tuple[Row, ...]
    assumed: dict[str, Assumed] = field(default_factory=dict)
    setup: dict = field(default_factory=dict)
    not_computed: str = ""

    def states(self, row: Row, inputs: dict) -> list[dict]:
        """Setups of the states of a row with values of the assumed inputs in place of their names."""
        setup = self.setup | ({"observable": row.observable} if row.observable else {})
        return [filled(setup, inputs | state) for state in row.states]


def experiments(folder: Path = FOLDER) -> list[Experiment]:
    """All experiments of a folder by name."""
    return [read(path) for path in sorted(folder.glob("*.yaml"))]


def read(path: Path) -> Experiment:
    """Experiment of a file.

    Raises
    ------
    ValueError
        One sentence with the first problem of the file.
    """
    stated = yaml.safe_load(path.read_text(encoding="utf-8"))
    for problem in (*map(str, schema_problems(stated, schema())), *relations(stated)):
        raise ValueError(f"{path.name}: {problem}")
    assumed = {name: Assumed(**_tuples(entry)) for name, entry in stated.get("assumed", {}).items()}
    rows = tuple(Row(**_tuples(_renamed(row))) for row in stated["measured"])
    kept = {key: stated[key] for key in ("title", "laboratory", "source", "setup", "not_computed") if key in stated}
    return Experiment(path.stem, stated=tuple(stated["stated"]), rows=rows, assumed=assumed, **kept)


def predicted_from(path: Path) -> str:
    """All that a prediction depends on, as text: no measured value and no reason."""
    of = read(path)
    rows = [(row.kind, row.observable, row.constants, row.along, row.powers, row.falls_to) for row in of.rows]
    return repr((of.assumed, of.setup, of.not_computed, rows))


@cache
def schema() -> dict:
    """Allowed keys and values."""
    return yaml.safe_load(SCHEMA.read_text(encoding="utf-8"))


def relations(stated: dict) -> Iterator[str]:
    """Problems that no single key has."""
    if not {"doi", "link"} & stated["source"].keys():
        yield "source must have a doi or a link"
    yield from _problems_of_setup(stated)
    assumed = stated.get("assumed", {})
    for name, entry in assumed.items():
        if ("range" in entry) == ("one_of" in entry):
            yield f"assumed.{name} must have either range or one_of"
        elif entry.get("scale") == "log" and min(entry["range"]) <= 0:
            yield f"assumed.{name}.range must be positive on a scale of logarithms"
    rows = stated["measured"]
    used = set(variables([stated.get("setup", {}), [[row.get("with"), row.get("along")] for row in rows]]))
    for name in sorted(assumed.keys() - used):
        yield f"assumed.{name} is used nowhere in setup: write ${name} there"
    for number, row in enumerate(rows):
        yield from (f"measured[{number}] {problem}" for problem in _problems_of(row, used - assumed.keys()))


def _problems_of_setup(stated):
    """Problems of what is computed."""
    if ("setup" in stated) == ("not_computed" in stated):
        yield "write either setup or not_computed"
    if ("radius_um" in (setup := stated.get("setup", {}))) != (setup.get("observable") == "probe"):
        yield "setup must have radius_um for a probe, and only for one"


def _problems_of(row, left):
    """Problems of one row. ``left`` are variables of the setup that are not assumed."""
    if len([key for key in MEASURED if key in row]) != 1:
        yield f"must have one of {', '.join(MEASURED)}"
    if (row["kind"] == "level") == ("along" in row):
        yield "is a level without along, or a law with it"
    if (row["kind"] == "threshold") != ("falls_to" in row):
        yield "must have falls_to for a threshold, and only for one"
    if len(row.get("powers", (1, -1))) != len(row.get("along", {}).get("values", (1, -1))) and row["kind"] == "ratio":
        yield "must have as many powers as states"
    defined = {*row.get("with", {}), *([row["along"]["name"]] if "along" in row else [])}
    if missing := sorted(left - defined):
        yield f"leaves ${missing[0]} without a value: write it in assumed, with or along"


def variables(template) -> Iterator[str]:
    """Names behind $ in a setup."""
    return iter(re.findall(r"\$([a-z][a-z0-9_]*)", yaml.safe_dump(template)))


def filled(template, values: dict):
    """Setup with values in place of $NAME.

    Examples
    --------
    >>> filled({"faces": ["$face", {"rms_nm": "$rms"}]}, {"face": {"rms_nm": 1}, "rms": 2.0})
    {'faces': [{'rms_nm': 1}, {'rms_nm': 2.0}]}
    """
    if isinstance(template, dict):
        return {key: filled(value, values) for key, value in template.items()}
    if isinstance(template, list):
        return [filled(value, values) for value in template]
    if isinstance(template, str) and template.startswith("$"):
        return filled(values[template[1:]], values)
    return template


def _renamed(row):
    """Row whose key ``with`` is a name of Python."""
    return {{"with": "constants"}.get(key, key): value for key, value in row.items()}


def _tuples(entry):
    """Entry with tuples in place of lists."""
    return {key: tuple(value) if isinstance(value, list) else value for key, value in entry.items()}
