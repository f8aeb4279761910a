"""Declaration of a stage: files written and read by its jobs, their settings, and their computation.

A stage is declared once, in its module. Snakemake, the Python interface and the search for stale results read the same
declaration (`stiction.plan.graph`).

Names of files are relative to ``results/`` and may contain wildcards in braces, see `WILDCARDS`. Those of datasets have
no extension. Inputs that are no datasets, such as published tables, are a `File`.
"""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import MISSING, dataclass, fields, is_dataclass, replace
from functools import cache
from importlib import import_module
from inspect import signature
from types import SimpleNamespace
from typing import Any, get_args, get_origin, get_type_hints

from stiction.config.cases import BEFORE_AIR, CASE, PAIR_IN_AIR, Case, PairInAir
from stiction.config.units import in_si, without_unit
from stiction.contact.air import DRY_AIR
from stiction.contact.materials import OF_PAIRS
from stiction.models import (
    ALTERNATIVES_OF_SCANS,
    BEAM_MODELS,
    MODE_QUANTITIES,
    MOMENT_QUANTITIES,
    SHIFTS,
    SPECTRUM_QUANTITIES,
)
from stiction.plan.names import VARIANT

#: Folders whose modules may declare stages.
FOLDERS = ("stages", "report")
#: Wildcards in the names of files, and the regular expression that each matches.
WILDCARDS = {
    "surface": "[A-Za-z][A-Za-z0-9_-]*",
    "device": f"(?!map_|law_){BEFORE_AIR}|map|law",  # process_map_C1 is the map of C1
    "process": "[A-Za-z][A-Za-z0-9_-]*",
    "variable": "[A-Za-z][A-Za-z0-9_]*",
    "pair": PAIR_IN_AIR,
    "model": "|".join(BEAM_MODELS),
    "case": CASE,
    "chunk": "[0-9]+",
    "number": "[0-9]+",
    "moment": "|".join(MOMENT_QUANTITIES),
    "quantity": "|".join(dict.fromkeys((*MOMENT_QUANTITIES, *MODE_QUANTITIES, *SPECTRUM_QUANTITIES))),
    "member": "[A-Za-z][A-Za-z0-9]*",
    "side": "|".join(SHIFTS),
    "solid_property": "|".join(OF_PAIRS),
    "choice": "|".join(ALTERNATIVES_OF_SCANS),
    "variant": VARIANT,
    "length": "[0-9]+",
    "width": "[0-9]+",
}
#: Folders with files of devices, where a case is one of a device or of a patch.
_OF_DEVICES = ("devices/", "process/")
#: What a wildcard is, if it is more than a text.
_KINDS = {"case": Case, "pair": PairInAir}


class At(SimpleNamespace):
    """Values of the wildcards of one job.

    Examples
    --------
    >>> At(case="b_rh067", model="NG").case.humidity
    0.67
    """

    def __init__(self, **wildcards: str):
        numbers = {name: kind(wildcards[name]) for name, kind in _KINDS.items() if name in wildcards}
        super().__init__(**wildcards | numbers)

    @property
    def identity(self) -> dict[str, str | float]:
        """Pair, relative humidity, surface, model and variant, as coordinates of the dataset of the job.

        Examples
        --------
        >>> At(case="b_rh067", model="NG").identity, At(pair="b_dry").identity
        ({'pair': 'b', 'relative_humidity': 0.67, 'model': 'NG'}, {'pair': 'b', 'relative_humidity': 0.0})
        """
        wildcards, coordinates = vars(self), {}
        if contact := wildcards.get("case", wildcards.get("pair")):
            coordinates["pair"] = contact.pair
        if "case" in wildcards or getattr(contact, "medium", None):
            coordinates["relative_humidity"] = getattr(contact, "humidity", DRY_AIR.humidity)
        return coordinates | {name: wildcards[name] for name in ("surface", "model", "variant") if name in wildcards}


class File(str):
    """Path of an input other than a dataset."""


#: A name, or names in an order or by key.
Names = str | Sequence[str] | Mapping[Any, str]


def _nothing(_plan, _at) -> dict:
    """Return no inputs and no settings."""
    return {}


def _once(plan) -> list[dict]:
    """Return the only job of a stage without wildcards, about the pairs in the run."""
    return [{}] if plan.pairs else []


def without_wildcards(file: str) -> str:
    """Name of a file without its wildcards.

    Examples
    --------
    >>> without_wildcards("budget_{device}")
    'budget'
    """
    return re.sub(r"_?\{\w+\}", "", file)


def stage_name(kind: str, file: str) -> str:
    """Name of the stage of a ``table`` or ``figure`` with a file of this name.

    Examples
    --------
    >>> stage_name("figure", "figure_05"), stage_name("figure", "budget_{device}")
    ('figure_05', 'figure_budget')
    """
    return f"{kind}_{without_wildcards(file).removeprefix(f'{kind}_')}"


def title_of(name: str, shows: str) -> str:
    """Title of a table or figure in the report.

    Examples
    --------
    >>> title_of("figure_05", "a force curve"), title_of("fit_quality", "errors of Eq. (12)")
    ('Figure 5: a force curve', 'Fit quality: errors of Eq. (12)')
    """
    return f"{name.replace('_0', ' ').replace('_', ' ').capitalize()}: {shows}"


@dataclass(frozen=True, kw_only=True)
class Shown:
    """Settings for a file of a stage in the report."""

    file: str  #: key of the file
    title: str  #: may contain wildcards
    category: str
    caption: str | None = None  #: name of the text, without extension


@dataclass(frozen=True, kw_only=True)
class Running:
    """How the jobs of a stage run. Results do not depend on it."""

    minutes: int | None = None  #: longest run time of a job, if it is worth a job of its own on a cluster
    memory: Callable[[Any], float] | None = None  #: of a job that needs more than its fields, by the plan [MB]
    priority: int = 0  #: jobs of a higher priority start first: 1 for answers, 2 for the longest job of the paper
    last: bool = (
        False  #: whether a job waits for all other files of a whole run; new ones repeat it, changed ones do not
    )
    first: Callable[[Any], dict] | None = None  #: part of the inputs to read, by the settings
    streamed: bool = False  #: whether inputs in an order are loaded one at a time
    temporary: bool = False  #: whether the files are deleted once they have been read


@dataclass(frozen=True, kw_only=True)
class Stage:
    """Stage of the workflow: files written and read by its jobs, and their computation.

    ``inputs`` and ``settings`` are functions of the plan of a configuration (`stiction.plan.plan.Plan`) and of the
    wildcards of a job. ``compute`` takes what its parameters name: an input, structured as ``inputs`` structures its
    names, a wildcard, a setting that no ``kind`` converts, or all ``settings``; and all inputs as ``data``, all
    wildcards as ``at``.
    """

    name: str  #: of the rule
    files: Mapping[str, str]  #: names of the files by key; a dataset has the key ``dataset``
    message: str  #: what a job does; may contain wildcards
    compute: Callable[..., Any]
    inputs: Callable[[Any, At], Mapping[str, Names]] = _nothing
    settings: Callable[[Any, At], dict] = _nothing
    kind: type | None = None  #: dataclass to which the settings are converted
    complete: Callable[[Any, Mapping[str, Any]], Any] | None = None  #: completes the settings by the data of the inputs
    save: Callable[[Any, dict], None] | None = None  #: writes what ``compute`` returns to the files, if no dataset
    label: str = ""  #: name in the label of a dataset, if it differs from that of the rule
    each: Callable[[Any], Sequence[str]] | None = None  #: ends of the datasets that one job writes, by the plan
    surfaces: Callable[[Any], Iterable[str]] | None = None  #: surfaces to which the stage is restricted, by the plan
    jobs: Callable[[Any], list[dict]] = _once  #: wildcards of the jobs that its targets want, by the plan
    targets: tuple[str, ...] = ()  #: targets of the workflow that want its files
    study: str = ""  #: study without which its targets do not want its files
    shown: Shown | None = None  #: how the report shows one of the files
    libraries: tuple[str, ...] = ()  #: those whose versions count as code of the stage
    running: Running = Running()

    @property
    def stage(self) -> str:
        """Name of the stage in the labels of its datasets."""
        return self.label or self.name

    @classmethod
    def writing(cls, name: str, file: str, **declared: Any) -> "Stage":
        """Stage with a dataset, or with ``each``, one for each ending, in place of ``{each}`` in the name."""
        return cls(name=name, files={"dataset": file}, **declared)

    def on(self, name: str, file: str, **changed: Any) -> "Stage":
        """Same stage for another dataset, on a patch of a device, say."""
        return replace(self, name=name, files={"dataset": file}, **changed)

    @property
    def log(self) -> str:
        """Name of the log of a job, without extension."""
        return (
            next(iter(self.files.values())).rpartition(".")[0]
            if self.save
            else self.files["dataset"].removesuffix("_{each}")
        )

    def jobs_of_targets(self, plan: Any) -> list[dict]:
        """Wildcards of the jobs for the files of the targets."""
        return self.jobs(plan) if self.targets and (not self.study or self.study in plan.studies) else []

    @property
    def code(self) -> str:
        """Module of ``compute``. Its code and imports are the code of a job, the declaration's are not."""
        return self.compute.__module__

    def converted(self, settings: dict) -> Any:
        """Plain settings of a job as ``compute`` takes them."""
        return settings if self.kind is None else in_si(self.kind, settings)

    def result(self, data: Mapping[str, Any], at: At, settings: Any) -> Any:
        """Compute from the data of the inputs, the wildcards and the converted settings."""
        complete = self.complete(settings, data) if self.complete else settings
        single = settings if self.kind is None and settings else {}
        arguments = single | vars(at) | {"settings": complete, "data": data, "at": at} | data
        return self.compute(
            **{name: arguments[name] for name in signature(self.compute).parameters if name in arguments}
        )

    def datasets(self, result: Any, at: At) -> list[Any]:
        """Datasets of a result in the order of their files, with the identity of the job unless they are of devices."""
        identity = {} if self.files["dataset"].startswith(_OF_DEVICES) else at.identity
        return [dataset.assign_coords(identity) for dataset in (result if self.each else [result])]

    def patterns(self, plan: Any) -> dict[str, str]:
        """Names of all files of a job by key, with wildcards."""
        if self.each is None:
            return dict(self.files)
        return {end: self.files["dataset"].replace("{each}", end) for end in self.each(plan)}


def stages_of(module: str) -> tuple[Stage, ...]:
    """Stages declared by a module."""
    return getattr(import_module(module), "STAGES", ())


def expression(pattern: str, constraints: Mapping[str, str]) -> re.Pattern:
    """Regular expression of a name with wildcards.

    Examples
    --------
    >>> expression("forces/{case}_{model}", WILDCARDS).fullmatch("forces/b_rh067_NG").groupdict()
    {'case': 'b_rh067', 'model': 'NG'}
    """
    texts = re.split(r"\{(\w+)\}", pattern)
    patterns = [f"(?P<{text}>{constraints[text]})" if k % 2 else re.escape(text) for k, text in enumerate(texts)]
    return re.compile("".join(patterns))


def filled(pattern: str, at: At) -> str:
    """Name with the values of its wildcards."""
    return pattern.format(**vars(at))


def subsection(section: Mapping[str, Any], names: Iterable[str]) -> dict[str, Any]:
    """Section reduced to the named keys, as far as it contains them."""
    return {name: section[name] for name in names if name in section}


def select(kind: type, section: Mapping[str, Any], **values: Any) -> dict[str, Any]:
    """Settings for a dataclass from a section of the configuration: exactly its fields.

    Nested sections are reduced to the fields of their dataclasses. Fields with a default are left out where the section
    does not have them.

    Parameters
    ----------
    kind : type
        Dataclass whose fields are named like the keys, without units.
    section : dict
        Plain numbers, strings, lists and dicts.
    **values
        Settings that do not have the value of the section, by key.

    Raises
    ------
    KeyError
        If a field without default has no key.

    Examples
    --------
    >>> from dataclasses import make_dataclass
    >>> Water = make_dataclass("Water", [("temperature", float), ("samples", int)])
    >>> select(Water, {"temperature_K": 300, "samples": 5, "more": 1}, samples=7)
    {'temperature_K': 300, 'samples': 7}
    """
    keys = {without_unit(key): key for key in (*section, *values)}
    kinds, selected = _kinds_of(kind), {}
    for field in fields(kind):
        key = keys.get(field.name)
        if key in values:
            selected[key] = values[key]
        elif key is not None:
            selected[key] = _reduced(kinds[field.name], section[key])
        elif field.default is MISSING and field.default_factory is MISSING:
            raise KeyError(f"no key for {kind.__qualname__}.{field.name}")
    return selected


_kinds_of = cache(get_type_hints)  # a plan asks for those of a few classes thousands of times


def _reduced(kind, value):
    """Value of one key, reduced to the fields of its dataclass if it has one."""
    if not isinstance(value, dict):
        return value
    if get_origin(kind) is dict:
        inner = get_args(kind)[1]
        return {name: select(inner, entry) for name, entry in value.items()} if is_dataclass(inner) else value
    kinds = [option for option in (kind, *get_args(kind)) if is_dataclass(option)]
    return select(kinds[0], value) if kinds else value
