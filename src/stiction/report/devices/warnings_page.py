"""Page of all limits of devices, counted by the last lines of a run: of the model, and of test beams."""

from collections.abc import Mapping

import xarray as xr

from stiction.plan.names import by_name
from stiction.plan.stage import Stage
from stiction.report.limits import pages
from stiction.report.test_beams import tables as tables_test_beams
from stiction.stages.beams.pair_warnings import Limits, Subject
from stiction.stages.devices import device_warnings
from stiction.stages.devices.device_warnings import OfDevices, subjects


def together(found: OfDevices, test_beams: Mapping[str, xr.Dataset]) -> Limits:
    """Limits of devices, and of the evidence of their test beams, by name of the device."""
    of_test_beams = {name: tables_test_beams.warnings(update) for name, update in test_beams.items()}
    return subjects(found) | {Subject(name, ("test beams",)): limits for name, limits in of_test_beams.items()}


STAGES = (
    Stage(
        name="device_limits",
        files={key: f"devices/{file}" for key, file in pages.FILES.items()},
        inputs=lambda plan, at: {
            "warnings": device_warnings.files_of(*plan.devices.sections),
            "test_beams": by_name("devices/test_beams/rerun", plan.devices.with_test_beams),
        },
        settings=lambda plan, at: {"not_modelled": device_warnings.not_modelled(plan, *plan.devices.sections)},
        compute=lambda data, settings: (
            together(device_warnings.read(data["warnings"]), data["test_beams"]),
            settings["not_modelled"],
        ),
        save=pages.save,
        message="Where the results of devices are beyond the model.",
        jobs=lambda plan: [{}] if plan.devices.sections else [],
        targets=("devices",),
    ),
)
