"""Relations between the keys of processes, and of the devices computed over them."""

import math
from collections.abc import Iterator
from contextlib import suppress
from itertools import chain
from pathlib import Path

from stiction.config.keys import Keys, Relations
from stiction.config.meetings import surfaces_of
from stiction.config.messages import duplicates
from stiction.config.relations import undefined
from stiction.config.scans import digest
from stiction.config.surfaces.process import LEAST, NUMBERS, UNITS, all_names, unit_of

#: Relations between the keys of processes.
relation = Relations()


@relation
def surfaces_of_processes_are_defined(config):
    """Require an existing surface, and none at a setting."""
    names_of_settings = all_names(config.config)
    defined = [name for name in config.names("surfaces") if name not in names_of_settings]
    for name, surface in config.entries("process", "surface"):
        yield f"process.{name}.surface", undefined(surface, defined)


@relation
def variables_have_a_unit(config):
    """Require a variable with its unit at the end of its name."""
    for name, variable in config.entries("process", "variable"):
        if unit_of(variable) is None:
            units = ", ".join(f"_{unit}" for unit in UNITS)
            yield f"process.{name}.variable", f"must end in its unit, such as etch_time_s: {units}"


@relation
def processes_have_several_settings(config):
    """Require two settings with different values. One setting has nothing between it and another."""
    for name, settings in config.entries("process", "settings"):
        key, values = f"process.{name}.settings", [setting["value"] for setting in settings]
        if len(settings) < 2:
            message = "must have at least two settings; for the surface of one, use roughness of the device"
            yield f"{key}.0.value", message
        for value in duplicates(values):
            number = len(values) - 1 - values[::-1].index(value)
            yield f"{key}.{number}.value", "must differ from that of the other settings; one has all scans of a value"


@relation
def settings_are_possible(config):
    """Require values that their unit can have: no negative times, temperatures and pressures, at most 100 percent."""
    for name, settings, variable in config.entries("process", "settings", "variable"):
        unit = unit_of(variable)
        least, most = LEAST.get(unit, -math.inf), 100 if unit == "%" else math.inf
        for number, setting in enumerate(settings):
            key, value = f"process.{name}.settings.{number}.value", setting["value"]
            if not least <= value <= most:
                ratio = (
                    f"and at most 100 %; for another ratio, write {value / 100:g} and a variable that ends in _ratio"
                )
                message = f"must be at least {least:g} {ratio if unit == '%' else unit}"
                yield key, message, f"process.{name}.variable"


@relation
def settings_are_described_alike(config):
    """Require scans at every setting, or the same numbers, each with its error."""
    for name, settings in config.entries("process", "settings"):
        stated = [[key for key in ("scans", *NUMBERS) if key in setting] for setting in settings]
        for number, (setting, keys) in enumerate(zip(settings, stated, strict=True)):
            if refusal := _refusal(keys, list(setting.get("uncertainty", ())), stated[0]):
                yield f"process.{name}.settings.{number}.value", refusal


def _refusal(keys, uncertain, of_first):
    """Refusal of the keys of a setting, beside those of the first one."""
    if not keys:
        return f"must come with scans, or with some of {', '.join(NUMBERS)}"
    if "scans" in keys and (others := [*keys[1:], *("uncertainty" for _ in uncertain[:1])]):
        return f"must come with scans or with numbers, not with {others[0]} beside scans"
    if ("skewness" in keys) != ("kurtosis" in keys):
        return "must come with skewness and kurtosis or without both"
    if "scans" not in keys and (alone := [key for key in keys if key not in uncertain]):
        return f"must come with the error of every number: uncertainty: {{{alone[0]}: ...}} is missing"
    if strange := [key for key in uncertain if key not in keys]:
        return f"must come with {strange[0]}, of which it states an uncertainty"
    if set(keys) != set(of_first):
        return f"must come with what the first setting states, {', '.join(of_first)}; it has {', '.join(keys)}"
    return None


@relation
def scans_of_settings_are_those_of_one_surface(config):
    """Require each file at one setting of a process, and at no other surface."""
    listed = list(_files_of_scans(config))
    for number, (key, surface, content) in enumerate(listed):
        for other, of_other, same in listed[:number]:
            if same == content and (surface != of_other or key.startswith("process.") == other.startswith("process.")):
                yield key, f"must be a scan of one setting and of one surface: it is in {other} as well"
                break


def _files_of_scans(config: Keys) -> Iterator[tuple[str, str, str]]:
    """Keys of all files of scans, surface of each, and content. Those of surfaces are before those of settings."""
    settings = {
        f"process.{name}.settings.{number}.scans": (surface, setting.get("scans", ()))
        for name, settings, surface in config.entries("process", "settings", "surface")
        for number, setting in enumerate(settings)
    }
    names_of_settings = all_names(config.config)
    surfaces = {
        f"surfaces.{name}.scans.files": (name, files)
        for name, files in config.entries("surfaces", "scans.files")
        if name not in names_of_settings and settings
    }
    for key, (surface, files) in chain(surfaces.items(), settings.items()):
        for number, file in enumerate(files):
            content = str(Path(file).absolute())
            with suppress(OSError):
                content = digest(file)
            yield f"{key}.{number}", surface, content


@relation
def laws_are_those_of_moments(config):
    """Require heights by their moments. Laws of a process are laws of moments."""
    for name, surface in config.entries("process", "surface"):
        if config["surfaces"].get(surface, {}).get("heights") == "measured":
            message = (
                f"must be a surface with heights: moments, of which a process has laws; {surface} has measured ones"
            )
            yield f"process.{name}.surface", message, f"surfaces.{surface}.heights"


@relation
def processes_at_the_same_time_have_one_variable(config):
    """Require another process with the same variable, a common range of settings and another surface."""
    processes = config["process"]
    for name, other, variable, surface, settings in config.entries(
        "process", "together_with", "variable", "surface", "settings"
    ):
        key, others = f"process.{name}.together_with", [process for process in processes if process != name]
        if not others:
            yield key, "must be left out, where no other process is described"
        elif refusal := undefined(other, others):
            yield key, refusal
        elif processes[other]["variable"] != variable:
            yield key, "must be a process with the same variable, in the same unit", f"process.{other}.variable"
        elif processes[other]["surface"] == surface or "together_with" in processes[other]:
            yield key, "must be a process that makes another surface, and is together with none itself"
        else:
            ranges = [
                [setting["value"] for setting in settings_of_process]
                for settings_of_process in (settings, processes[other]["settings"])
            ]
            if max(map(min, ranges)) >= min(map(max, ranges)):
                yield key, "must be a process with settings in a common range", f"process.{name}.settings"


@relation
def processes_of_devices_make_their_surfaces(config):
    """Require an existing process of a surface of the pair of a device."""
    processes = config["process"]
    for name, process, pair in config.entries("devices", "process", "pair"):
        key, sides = f"devices.{name}.process", dict.fromkeys(surfaces_of(pair, config))
        if not processes:
            yield key, "must be a process of section process, where none is described"
        elif refusal := undefined(process, processes):
            yield key, refusal
        elif processes[process]["surface"] in config["surfaces"].keys() - sides:
            message = f"must make a surface of pair {pair}, {' or '.join(sides)}"
            yield key, message, f"process.{process}.surface"


@relation
def second_processes_make_the_other_surface(config):
    """Require a second process with another variable, and as the only one of the other surface of the pair."""
    processes = config["process"]
    for name, first, second, pair in config.entries("devices", "process", "second_process", "pair"):
        key, sides = f"devices.{name}.second_process", dict.fromkeys(surfaces_of(pair, config))
        if first not in processes:
            continue
        surface = processes[first]["surface"]
        beside = [
            other
            for other, process in processes.items()
            if process.get("together_with") == first and process["surface"] in sides
        ]
        if refusal := undefined(second, [process for process in processes if process != first]):
            yield key, refusal
        elif processes[second]["surface"] not in sides or processes[second]["surface"] == surface:
            yield key, f"must make the other surface of pair {pair}, beside {surface}", f"process.{second}.surface"
        elif processes[second]["variable"] == processes[first]["variable"]:
            message = f"must have another variable; with the same one, state together_with: {first} in process.{second}"
            yield key, message, f"process.{second}.variable"
        elif beside:
            yield key, f"must be left out, where process {beside[0]} makes the other surface together with {first}"
