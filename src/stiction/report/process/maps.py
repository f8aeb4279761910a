"""Table of devices over two processes, and sentences on sufficient pairs of settings."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import xarray as xr

from stiction.config.surfaces import process
from stiction.devices.risk import one_in
from stiction.devices.roughness import sufficient
from stiction.plan.names import by_name
from stiction.report.process import tables
from stiction.report.table import Table, table_stage, with_list
from stiction.stages.axes.law import law_inputs
from stiction.stages.axes.recommended import settings_of_processes

# Sentences


def answers(pairs: xr.Dataset) -> list[str]:
    """Sentences on the sufficient pairs of settings for a device, and on the best pair."""
    first, second = settings_of_processes(pairs)
    if np.isnan(pairs.best.values).any():
        return [briefly(pairs)]
    said = [briefly(pairs), *(_at_settings(pairs, first, second) if second.sufficient.size else [])]
    for view in (first, second):
        own = [*tables.best(view), *tables.following(view, tables.unit_of(view))]
        said += [f"{_words(view).capitalize()}: {one[:1].lower()}{one[1:]}" for one in own]
    return said


def briefly(pairs: xr.Dataset) -> str:
    """Range of the second process with sufficient settings of the first one, and the best pair, in a sentence."""
    first, second = settings_of_processes(pairs)
    names = f"the {_words(first)} and the {_words(second)}"
    if np.isnan(pairs.best.values).any():
        return f"Pairs of {names} that suffice are not known: not all could be computed."
    share, best = one_in(float(pairs.share)), " with ".join(map(_best, (first, second)))
    if not len(second.sufficient):
        whole = " and ".join(
            f"the {_words(view)} from {_range(view, *view.value.values[[0, -1]])}" for view in (first, second)
        )
        of_mean = f"{_words(second)}, {tables.mean_process(second)}"
        none = f"No pair of {whole} is sure to leave at most {share} stuck in the next runs"
        return f"{none} ({of_mean}); the best is {best}."
    ranges = " or ".join(_range(second, *ends) for ends in second.sufficient.values)
    return (
        f"Pairs of {names} leave at most {share} stuck in the next runs (95 % confidence) where the "
        f"{_words(second)} is {ranges} ({tables.mean_process(second)}), best {best}."
    )


def _at_settings(pairs, first, second):
    """Settings of the first process that suffice at the measured settings of the second one."""
    for value in pairs.second_settings.values:
        ranges = sufficient(pairs["value"].values, pairs.safe.sel(second=value).values)
        enough = " or ".join(_range(first, *ends) for ends in ranges)
        where = f"Where the {_words(second)} is {tables.setting_text(second, value)} {tables.unit_of(second)}"
        yield (
            f"{where}, {'an' if _words(first)[0] in 'aeiou' else 'a'} {_words(first)} of {enough} suffices."
            if ranges
            else (f"{where}, no {_words(first)} is sure to suffice.")
        )


def _words(view):
    """Variable of a process in words."""
    return process.words_of(view.variable)


def _range(view, low, high):
    """Range of settings as text."""
    return f"{tables.setting_text(view, low)} to {tables.setting_text(view, high)} {tables.unit_of(view)}"


def _best(view):
    """Best setting with its error."""
    return tables.at(view, float(view.best), float(view.best_error))


def notes(found: xr.Dataset, laws: Sequence[xr.Dataset]) -> list[str]:
    """Sentences on settings in contradiction to a law, and on points not computed or flagged."""
    said = [sentence for law in laws for sentence in str(law.flags.item()).splitlines()]
    words, unit = process.words_of(found.second_variable), process.unit_of(found.second_variable)
    for value in found.second.values:
        said += [f"{words.capitalize()} {value:.6g} {unit}: {one}" for one in tables.notes(found.sel(second=value), [])]
    return said


# Table


def table(
    maps: Mapping[str, xr.Dataset], pairs: Mapping[str, xr.Dataset], laws: Mapping[str, Sequence[xr.Dataset]]
) -> Table:
    """Margins of devices over two processes: a row per device, humidity, end state and pair of settings."""
    said = [f"{name}: {sentence}" for name, one in pairs.items() for sentence in answers(one)]
    said += dict.fromkeys(sentence for name, found in maps.items() for sentence in notes(found, laws[name]))
    caption = tables.caption("two processes make at values of their variables")
    rows = [row for device, found in maps.items() for row in _rows(device, found)]
    return Table.of(rows, with_list(caption, said), _COLUMNS)


def _rows(device: str, found: xr.Dataset) -> Iterator[dict]:
    """Numbers of a device."""
    for value in found.second.values:
        second = {"second_variable": found.second_variable, "second_value": float(value)}
        for row in tables.rows(device, found.sel(second=value)):
            yield row | second


_SECOND = {"second variable": (str, "second_variable"), "at": (".6g", "second_value")}
_COLUMNS = {
    name: column
    for key, own in tables.COLUMNS.items()
    for name, column in ({key: own} | (_SECOND if key == "value" else {})).items()
}


def _inputs(plan, _at):
    """Maps, recommended pairs and laws of all devices over two processes."""
    devices = plan.devices.processed_twice
    own = {f"laws_{name}": law_inputs(plan, name)["laws"] for name in devices}
    return {"maps": by_name("process/maps", devices), "pairs": by_name("process/pairs", devices)} | own


STAGES = (
    table_stage(
        "process_map",
        "which pairs of settings of two processes suffice",
        inputs=_inputs,
        compute=lambda data: table(data["maps"], data["pairs"], {name: data[f"laws_{name}"] for name in data["maps"]}),
        jobs=lambda plan: [{}] if plan.devices.processed_twice else [],
        targets=("devices",),
    ),
)
