"""Page of all warnings about devices, counted by the last lines of a run: limits of the model, and test beams."""

from collections.abc import Mapping

import xarray as xr

from stiction.plan.names import by_name
from stiction.plan.stage import Stage
from stiction.report.test_beams import tables as tables_test_beams
from stiction.run.atomic import save_text
from stiction.stages.beams.pair_warnings import as_markdown
from stiction.stages.devices import device_warnings
from stiction.stages.devices.device_warnings import OfDevices, subjects


def page(limits: OfDevices, test_beams: Mapping[str, xr.Dataset], not_modelled: str) -> str:
    """Warnings about devices, and about the evidence of their test beams, by name of the device."""
    said = {f"{name}, test beams": tables_test_beams.warnings(update) for name, update in test_beams.items()}
    return as_markdown(subjects(limits) | said, not_modelled)


STAGES = (
    Stage(
        name="device_limits",
        files={"markdown": "devices/warnings.md"},
        inputs=lambda plan, at: {
            "warnings": device_warnings.files_of(*plan.devices.sections),
            "test_beams": by_name("devices/test_beams/rerun", plan.devices.with_test_beams),
        },
        settings=lambda plan, at: {"not_modelled": device_warnings.not_modelled(plan, *plan.devices.sections)},
        compute=lambda data, settings: page(device_warnings.read(data["warnings"]), data["test_beams"], **settings),
        save=lambda page, paths: save_text(page, paths["markdown"]),
        message="Where the results of devices are beyond the model.",
        jobs=lambda plan: [{}] if plan.devices.sections else [],
        targets=("devices",),
    ),
)
