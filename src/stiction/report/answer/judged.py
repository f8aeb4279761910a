"""Answer about a device together with the limits of the model that forbid a number."""

from collections.abc import Iterable
from dataclasses import replace

import xarray as xr

from stiction.answer.data import Answer
from stiction.devices.limits.limit import Limit
from stiction.stages.answer.answer import answer_of
from stiction.stages.devices.device_warnings import OfDevices


def judged(dataset: xr.Dataset, warnings: OfDevices) -> Answer:
    """Answer of a dataset of stage answer, without a number where a limit of its device forbids one."""
    answer = answer_of(dataset)
    return with_limits(answer, limits_of(answer.device, warnings))


def with_limits(answer: Answer, limits: Iterable[Limit]) -> Answer:
    """Answer that some limits may forbid."""
    kinds = [limit.kind for limit in limits if limit.forbids]
    return replace(answer, forbidden=tuple(dict.fromkeys([*answer.forbidden, *kinds])))


def limits_of(device: str, warnings: OfDevices) -> list[Limit]:
    """Limits of a device itself, not of a chart's other sizes."""
    lengths = [limits for (name, *_), limits in warnings.lengths.items() if name == device]
    return [limit for limits_of_patch in (*lengths, warnings.patches.get(device, [])) for limit in limits_of_patch]
