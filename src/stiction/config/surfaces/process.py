"""Section ``process``: surfaces at several settings of a process, each a surface of the configuration.

``process: {etch: {variable: etch_time_s, surface: Poly, settings: [{value: 30, scans: [...]}, ...]}}`` makes the
surfaces etch-1, etch-2 and so on: as Poly, apart from what their setting states. Nothing else knows how a surface at a
setting is described, by scans or by numbers.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from stiction.config.merging import section_at, texts
from stiction.config.messages import ConfigError, Problem, dotted
from stiction.config.surfaces.knowledge import slope
from stiction.surface import self_affine

#: Units of process variables, by the ends of their names, as tables and figures show them.
UNITS = {
    **{unit: unit for unit in ("s", "min", "h", "nm", "K", "Pa", "kPa", "mbar", "V", "A", "mA", "W", "rpm", "sccm")},
    "um": "µm",
    "C": "°C",
    "mTorr": "mTorr",
    "Torr": "Torr",
    "nm_per_min": "nm/min",
    "J_per_cm2": "J/cm²",
    "percent": "%",
    "ratio": "1",
    "cycles": "cycles",
}
#: Units of quantities that are never negative. Lengths, voltages and rates can be differences.
_POSITIVE = ("s", "min", "h", "K", "Pa", "kPa", "mbar", "mTorr", "Torr", "W", "rpm", "sccm", "J/cm²", "%", "cycles")
#: Least value in a unit that has one.
LEAST = dict.fromkeys(_POSITIVE, 0.0) | {"°C": -273.15}
_UNIT = re.compile(f"_({'|'.join(sorted(UNITS, key=len, reverse=True))})$")
#: Numbers that a setting may state, and those among them of the spectrum.
NUMBERS = ("rms_nm", "skewness", "kurtosis", "corner_rad_per_um", "hurst")
_OF_SPECTRUM = NUMBERS[3:]
#: Other descriptions of a surface by numbers.
_BY_NUMBERS = ("unknown", "uncertainty")


def unit_of(variable: str) -> str | None:
    """Unit of a process variable, ``None`` without one.

    Examples
    --------
    >>> unit_of("etch_time_s"), unit_of("rate_nm_per_min"), unit_of("time")
    ('s', 'nm/min', None)
    """
    match = _UNIT.search(variable)
    return UNITS[match[1]] if match else None


def words_of(variable: str) -> str:
    """Process variable in words, without its unit.

    Examples
    --------
    >>> words_of("etch_time_s")
    'etch time'
    """
    return _UNIT.sub("", variable).replace("_", " ")


def names(config: Mapping[str, Any], process: str) -> list[str]:
    """Names of the surfaces at the settings of a process, in the order of the file."""
    return [f"{process}-{number}" for number in range(1, len(config["process"][process]["settings"]) + 1)]


def all_names(config: Mapping[str, Any]) -> list[str]:
    """Names of the surfaces at all settings of all processes."""
    return [name for process in config.get("process", {}) for name in names(config, process)]


def has_scans(config: Mapping[str, Any]) -> bool:
    """Whether a configuration, valid or not, describes a setting by scans."""
    processes = section_at(config, "process")
    return any("scans" in section_at(setting) for name in processes for setting in _settings(config, name))


def processes_of(config: Mapping[str, Any], device: str) -> list[str]:
    """Names of the processes of a device: the stated one, and one of its other surface.

    The latter is the second one that it states, or one at the same time.
    """
    section, processes = config["devices"][device], config.get("process", {})
    named = section.get("process")
    if is_mapped(config, device):
        return [named, section["second_process"]]
    sides = config["pairs"].get(section["pair"], {}).values()
    others = (
        name
        for name in processes
        if processes[name].get("together_with") == named and processes[name]["surface"] in sides
    )
    return [named, *others] if named in processes else []


def is_mapped(config: Mapping[str, Any], device: str) -> bool:
    """Whether a device is computed over the variables of two processes."""
    return "second_process" in config["devices"][device]


def variable_of(config: Mapping[str, Any], device: str) -> str:
    """Variable of the processes of a device."""
    return config["process"][config["devices"][device]["process"]]["variable"]


def used_processes(config: Mapping[str, Any]) -> list[str]:
    """Names of the processes of all devices."""
    return list(dict.fromkeys(name for device in config.get("devices", {}) for name in processes_of(config, device)))


def with_surfaces(config: dict[str, Any]) -> dict[str, Any]:
    """Configuration with a surface for each setting of each process of an existing surface.

    Raises
    ------
    ConfigError
        If a surface has the name of one of a process.
    """
    surfaces, added = config["surfaces"], {}
    for process, section in config.get("process", {}).items():
        if section["surface"] in surfaces:
            sections = (_surface(surfaces[section["surface"]], setting) for setting in section["settings"])
            added |= dict(zip(names(config, process), sections, strict=True))
    for name in added:
        if surfaces.get(name, added[name]) != added[name]:
            raise ConfigError(f"surfaces.{name} must have another name: process makes a surface of this name")
    return config | {"surfaces": surfaces | added} if added else config


def in_settings(problems: Iterable[Problem], config: Mapping[str, Any]) -> Iterator[str]:
    """Yield problems in words, those of the surface of a setting as problems of the setting."""
    settings_by_surface = {
        dotted(("surfaces", name)): dotted(("process", process, "settings", number))
        for process in config.get("process", {})
        for number, name in enumerate(names(config, process))
    }
    for text in map(str, problems):
        for surface, setting in settings_by_surface.items():
            text = text.replace(f"{surface}.scans.files", f"{setting}.scans").replace(f"{surface}.", f"{setting}.")
            text = text.replace(f"{surface} ", f"{setting} ")
        yield text


def resolve_scan_paths(config: dict[str, Any], named: Mapping[str, Any], folder: str | Path) -> dict[str, Any]:
    """Configuration, valid or not, with paths of scans of settings relative to the folder of the file naming them."""
    moved = {}
    for process in section_at(named, "process"):
        settings = _settings(named, process)
        if settings and _settings(config, process) == settings:
            in_folder = [_in_folder(setting, folder) for setting in settings]
            moved[process] = config["process"][process] | {"settings": in_folder}
    return config | {"process": config["process"] | moved} if moved else config


def _in_folder(setting, folder):
    """Setting with its relative files in a folder."""
    files = [str(Path(folder).absolute() / file) for file in texts(section_at(setting).get("scans"))]
    return setting | {"scans": files} if files else setting


def _settings(config, process):
    """Settings of a process of a configuration, valid or not. None if they are no list."""
    settings = section_at(config, "process", process).get("settings")
    return settings if isinstance(settings, list) else []


def _surface(base, setting):
    """Section of the surface at a setting, from that of the surface of the process."""
    stated = {key: value for key, value in setting.items() if key != "value"}
    if "scans" in stated:
        options = {key: base[key] for key in ("material", "heights", "psd", "beyond") if key in base}
        if "scans" not in base:
            options.pop("psd", None)
        of_scans = {key: value for key, value in base.get("scans", {}).items() if key not in ("files", "left_out")}
        return options | {"scans": of_scans | {"files": stated.pop("scans")}} | stated
    entry = {key: value for key, value in base.items() if key not in _BY_NUMBERS}
    if "published_psd" in base and any(key in stated for key in _OF_SPECTRUM):
        changed = {key: stated.pop(key) for key in _OF_SPECTRUM if key in stated}
        entry["published_psd"] = _bent(base["published_psd"], **changed)
    elif "corner_rad_per_um" in stated:
        entry.pop("correlation_length_nm", None)
    return entry | stated


def _bent(psd, corner_rad_per_um=None, hurst=None):
    """Section ``published_psd`` with another corner or Hurst exponent."""
    falling = self_affine.slope_of(hurst) if hurst is not None else slope(psd)
    corner = corner_rad_per_um or psd["corner_rad_per_um"]
    try:
        floor = psd["plateau_nm4"] * (psd["cutoff_rad_per_um"] / corner) ** falling
    except ArithmeticError:
        return psd  # relations refuse the spectrum of the surface itself
    return psd | {"corner_rad_per_um": corner, "floor_nm4": float(f"{floor:.12g}")}
