"""Page of all limits of devices, counted by the last lines of a run: of the model, and of test beams."""

from collections.abc import Mapping
from typing import Any

import xarray as xr

from stiction.plan.names import by_name
from stiction.plan.stage import Stage
from stiction.report.devices.sentences import shortest_warnings
from stiction.report.limits import pages
from stiction.report.test_beams import tables as tables_test_beams
from stiction.stages.answer.answer import answer_of
from stiction.stages.beams.pair_warnings import Limits, Subject
from stiction.stages.devices import device_warnings
from stiction.stages.devices.device_warnings import OfDevices, subjects


def together(devices: OfDevices, test_beams: Mapping[str, xr.Dataset]) -> Limits:
    """Limits of devices, and of the evidence of their test beams, by name of the device."""
    of_test_beams = {name: tables_test_beams.warnings(update) for name, update in test_beams.items()}
    return subjects(devices) | {Subject(name, ("test beams",)): limits for name, limits in of_test_beams.items()}


def of_lengths(beams: Mapping[str, Any], answers: Mapping[str, xr.Dataset]) -> Limits:
    """Limits of the lengths to build, or the stated ones, from sections of beams and their answers by name."""
    limits_of_lengths = {name: shortest_warnings(section, answer_of(answers[name])) for name, section in beams.items()}
    return {Subject(name, ("length",)): limits for name, limits in limits_of_lengths.items() if limits}


def _beams(plan):
    """Sections of all beams by name."""
    return {name: plan.devices.sections[name] for name in plan.devices.beams}


STAGES = (
    Stage(
        name="device_limits",
        files={key: f"devices/{file}" for key, file in pages.FILES.items()},
        inputs=lambda plan, at: {
            "warnings": device_warnings.files_of(*plan.devices.sections),
            "test_beams": by_name("devices/test_beams/rerun", plan.devices.with_test_beams),
            "answers": by_name("devices/answer", _beams(plan)),
        },
        settings=lambda plan, at: {
            "not_modelled": device_warnings.not_modelled(plan, *plan.devices.sections),
            "beams": _beams(plan),
        },
        compute=lambda data, settings: (
            together(device_warnings.read(data["warnings"]), data["test_beams"])
            | of_lengths(settings["beams"], data["answers"]),
            settings["not_modelled"],
        ),
        save=pages.save,
        message="Limits of the model that devices exceed.",
        jobs=lambda plan: [{}] if plan.devices.sections else [],
        targets=("devices",),
    ),
)
