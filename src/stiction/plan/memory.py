"""Memory to request for jobs: enough for their largest field, and twice as much after each failure."""

from stiction.config.memory import FIELD_UM, USUAL, field_memory, fields_of
from stiction.config.units import NM_PER_UM
from stiction.plan.devices import DevicePlan


def job_memory(config: dict) -> int:
    """Memory to reserve for each job of a configuration [MB]. Stages with many samples or large scans may need more."""
    return round(max(USUAL, _largest_field_memory(config)))


def for_attempt(first: int, attempt: int) -> int:
    """Memory or time to reserve for an attempt of a job, from the first: twice as much after each failure.

    Examples
    --------
    >>> [for_attempt(800, attempt) for attempt in (1, 2, 3)]
    [800, 1600, 3200]
    """
    return first * 2 ** (attempt - 1)


def _largest_field_memory(config):
    """Memory of a job with the largest of all fields [MB]."""
    sampling, patch = config["sampling"], config["identification"]["patch_um"]
    spacing = sampling["spacing_nm"]
    other_spacings = config["studies"]["variants"]["spacing_nm"]
    margin = sampling["margin_um"]
    fields = [((FIELD_UM, FIELD_UM), spacing), ((patch, patch), spacing)]
    strip = sampling["strip_length_um"] + margin, config["beam"]["width_um"] + margin
    fields += [(strip, at) for at in (spacing, *other_spacings)]
    devices = DevicePlan(config)
    tips = [devices.tips(name) for name in devices.with_tips]
    fields += [((tip.length / NM_PER_UM + margin, tip.width / NM_PER_UM + margin), spacing) for tip in tips]
    for device in devices.sections.values():
        fields += [(sides, at) for _, sides, at in fields_of(device, sampling, other_spacings)]
    return max(field_memory(*side, at) for side, at in fields)
