"""Relations of measured pull-off forces among test beams with their probe and the devices that use them."""

from stiction.config.keys import Relations
from stiction.config.kinds import KINDS
from stiction.config.relations import repeated, undefined
from stiction.config.relations_devices import agree
from stiction.config.test_beams import PULL_OFFS, users

#: Relations between names and keys, then between values. They hold for no arrays as devices.
relation_of_names = Relations()
relation = Relations()

#: Keys beside pull-off forces.
_KEYS = {"probe", PULL_OFFS}


@relation_of_names
def pull_off_forces_are_those_of_a_probe(config):
    """Require a probe among the devices, and no key of beams beside its forces."""
    probes = [name for name, kind in config.entries("devices", "kind") if KINDS[kind].shape]
    for name, probe in config.entries("test_beams", "probe"):
        if others := [key for key in config.names(f"test_beams.{name}") if key not in _KEYS]:
            yield f"test_beams.{name}.probe", f"must come without {', '.join(others)}, for pull_offs are of no beam"
        elif not probes:
            yield f"test_beams.{name}.probe", "must be a device of kind probe: there is none"
        else:
            yield f"test_beams.{name}.probe", undefined(probe, probes)


@relation
def pull_offs_are_in_the_airs_of_their_probe(config):
    """Require each humidity once, among those of the probe."""
    for name, probe, data in config.entries("test_beams", "probe", PULL_OFFS):
        yield f"test_beams.{name}.{PULL_OFFS}", repeated([datum["humidity"] for datum in data])
        computed = config["devices"][probe]["humidities"]
        for k, datum in enumerate(data):
            if datum["humidity"] not in computed:
                key = f"test_beams.{name}.{PULL_OFFS}.{k}.humidity"
                yield key, "must be among the humidities of its probe", f"devices.{probe}.humidities"


@relation
def probes_share_the_uncertainties_of_the_devices_that_use_them(config):
    """Require equal uncertainties of common inputs of a probe and the devices. They are one variable."""
    for name, probe in config.entries("test_beams", "probe"):
        for device, section in users(config.config, name).items():
            if not agree(section, config["devices"][probe]):
                message = (
                    f"must not name {name}, because its probe {probe} states other uncertainties: apart from those of "
                    "dimensions, both must be the same"
                )
                yield f"devices.{device}.test_beams", message
