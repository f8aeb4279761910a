"""Results of devices by their release: files, and P(stuck) in one layout, for users.

Datasets of P(stuck) have the variables ``stuck``, and ``low`` and ``high``, the ends of the band of 95 %, along one
axis: ``length`` [m] or ``force`` [N].
"""

from typing import Any

import numpy as np
import xarray as xr

from stiction.answer import sought
from stiction.config.cases import case_id
from stiction.config.units import in_si
from stiction.contact.voltage import BREAKDOWN, Capacitor
from stiction.devices.risk import stuck_share
from stiction.plan.names import by_case


def is_biased(plan: Any, device: str) -> bool:
    """Whether a device has a voltage at which its dielectric does not break down."""
    capacitor = plan.devices.capacitor(device)
    return bool(capacitor) and in_si(Capacitor, capacitor).field <= BREAKDOWN


def results_of(plan: Any, device: str, *names: str) -> dict[str, Any]:
    """Files with some results of a device as inputs of a stage, by default all: those of a beam by humidity.

    Above the breakdown of the dielectric, no voltage can hold a device.
    """
    files = _FILES[plan.devices.kind(device).release.name](plan, device)
    return {name: files[name] for name in names or files if name in files}


def charts_of(plan: Any, device: str) -> dict[float, str]:
    """Charts of a beam by humidity as inputs of a stage, none without a chart."""
    cases = plan.devices.chart_cases(device) if device in plan.devices.with_chart else []
    return {humidity: name for (_, humidity), name in by_case("devices/chart", cases).items()}


def _of_beam(plan, device):
    """Safe lengths at all humidities: for one touchdown, for all, and at the voltage, and the forces of dimples."""
    section = plan.devices.sections[device]
    stages = {"lengths": "safe_lengths", "after": "touchdowns" * ("touchdowns" in section)}
    stages |= {"biased": "at_voltage" * is_biased(plan, device), "dimples": "dimples" * ("dimples" in section)}
    return {
        name: {rh: f"devices/{stage}/{case_id(device, rh)}" for rh in section["humidities"]} if stage else {}
        for name, stage in stages.items()
    }


def _of_stopper(plan, device):
    """Forces: as the stopper is, at its voltage, and at its tilts."""
    biased = {"biased": f"devices/at_voltage/{device}"} if is_biased(plan, device) else {}
    tilted = {"tilted": f"devices/tilted/{device}"} if "tilt_deg" in plan.devices.sections[device] else {}
    return {"stopper": f"devices/stoppers/{device}"} | biased | tilted


_FILES = {"beam": _of_beam, "stopper": _of_stopper}


# P(stuck)


def stuck_beams(safe_lengths: xr.Dataset) -> xr.Dataset:
    """P(stuck) over the length of a beam, whatever holds it, from the dataset of stage safe_lengths."""
    in_any_state = safe_lengths.isel(shape=-1)
    return _layout(
        sought.LENGTH,
        "length of the device",
        in_any_state.length.values,
        [in_any_state.stuck.values, *in_any_state.stuck_band.values],
    )


def stuck_stoppers(stopper: xr.Dataset, humidity: float) -> xr.Dataset:
    """P(stuck) over the restoring force of a stopper at a humidity, from the dataset of stage stoppers."""
    forces = np.sort(stopper.pull_off.sel(humidity=humidity).values)
    return _layout(sought.FORCE, "restoring force", forces, stuck_share(-forces, -forces))


def _layout(axis, label, sizes, stuck):
    """Dataset of P(stuck) and of the ends of its band along an axis."""
    words = {"stuck": "P(stuck)", "low": "P(stuck), lower end of the 95 % band", "high": "P(stuck), upper end"}
    variables = {
        name: (axis.name, values, {"units": "1", "long_name": words[name]})
        for name, values in zip(words, stuck, strict=True)
    }
    return xr.Dataset(variables, {axis.name: (axis.name, sizes, {"units": axis.unit, "long_name": label})})
