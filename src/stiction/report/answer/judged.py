"""Answer about a device together with the limits of the model that forbid a number."""

from collections.abc import Iterable
from dataclasses import replace

import xarray as xr

from stiction.answer.data import Answer
from stiction.devices import limits
from stiction.stages.answer.answer import answer_of
from stiction.stages.devices.device_warnings import OfDevices


def judged(dataset: xr.Dataset, warnings: OfDevices) -> Answer:
    """Answer of a dataset of stage answer, without a number where a limit of its device forbids one."""
    answer = answer_of(dataset)
    return with_limits(answer, forbidding(answer.device, warnings))


def with_limits(answer: Answer, forbidding: Iterable[str]) -> Answer:
    """Answer that some limits forbid."""
    return replace(answer, forbidden=(*answer.forbidden, *["model"] * any(True for _ in forbidding)))


def forbidding(device: str, warnings: OfDevices) -> list[str]:
    """Limits of a device itself that forbid a number."""
    own = [some for (name, *_), some in warnings.lengths.items() if name == device]
    listed = [*own, warnings.patches.get(device, [])]
    return list(dict.fromkeys(one for some in listed for one in some if limits.forbids(one)))
