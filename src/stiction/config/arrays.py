"""Arrays of test beams in a configuration, and the cantilevers that they are.

Whatever is computed for an array is computed for a cantilever of its dimensions at the humidities of its data.
"""

from collections.abc import Mapping

from stiction.config.kinds import KEYS

#: Keys of an array that list what was measured.
DATA = ("crack_lengths", "stuck")
#: Keys of an array that are those of a cantilever.
_SIZES = ("pair", "thickness_um", "gap_um", "width_um", "strip_um")


def users(config: Mapping, array: str) -> list[dict]:
    """Sections of the devices whose prediction uses an array."""
    return [device for device in config.get("devices", {}).values() if array in device.get("test_beams", ())]


def humidities(array: Mapping, *kinds: str) -> list[float]:
    """Humidities of the data of an array, increasing; those of some kinds of data, by default of all."""
    return sorted({datum["humidity"] for kind in kinds or DATA for datum in array.get(kind, ())})


def shared_uncertainty(device: Mapping) -> dict[str, float]:
    """Uncertainties of a device apart from those of its dimensions: its test beams have the same inputs."""
    stated = device.get("uncertainty", {})
    return {key: value for key, value in stated.items() if key not in KEYS}


def as_cantilevers(config: Mapping) -> dict[str, dict]:
    """Sections of all arrays with data as if they were devices."""
    arrays = config.get("test_beams", {})
    return {name: _cantilever(array, users(config, name)) for name, array in arrays.items() if humidities(array)}


def counted(config: Mapping) -> dict[str, dict]:
    """Sections of the arrays with counts as if they were devices: their tips may hold them."""
    return {name: one for name, one in as_cantilevers(config).items() if "stuck" in config["test_beams"][name]}


def _cantilever(array, devices):
    """Section of an array that some devices use."""
    shared = next(map(shared_uncertainty, devices), {})
    sizes = {key: array[key] for key in _SIZES if key in array}
    stated = {"humidities": humidities(array), "uncertainty": shared | array.get("uncertainty", {})}
    return {"kind": "cantilever"} | sizes | stated
