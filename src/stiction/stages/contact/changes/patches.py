"""Kinds of patch for the contact of the surfaces of a pair, and the parts of the declaration of a change there."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from stiction.config.merging import merged
from stiction.config.units import NM_PER_UM
from stiction.plan.devices import OF_TIPS, Patch
from stiction.plan.stage import Names, Running, select
from stiction.stages.contact import contact
from stiction.stages.contact.pairs import Settings
from stiction.stages.surfaces.rough_surfaces import surface_inputs


@dataclass(frozen=True, eq=False)
class PatchKind:
    """Kind of patch for the contact of the two surfaces of a pair."""

    file: str  #: patch in the names of files
    words: str  #: patch in messages, after its pair
    size: Callable[[Any, Any], dict]  #: settings that differ from those of the strips, by the plan and the wildcards
    #: Number of samples of the unchanged contact, by the plan and the wildcards.
    samples: Callable[[Any, Any], int] = lambda plan, _at: plan.config["contact"]["samples"]
    #: Number of samples of each of two changed contacts. Only devices read them, unless stated otherwise.
    changed: Callable[[Any, Any], int] = lambda plan, _at: plan.config["design"]["budget_samples"]

    def fewer(self, plan: Any, at: Any) -> int:
        """Number of samples of a changed contact, compared with the first samples of the unchanged one."""
        return min(self.changed(plan, at), self.samples(plan, at))

    def settings(self, plan: Any, at: Any, samples: int) -> dict[str, Any]:
        """Settings of the unchanged contact of a patch."""
        return merged(select(Settings, plan.seen_by(at.pair, samples=samples)), self.size(plan, at))


def _changed_strips(plan, at):
    """Samples of changed strips of a pair. The errors of measured surfaces are found on the same files."""
    measured = plan.config["studies"]["slopes"]["samples"]
    return measured if plan.scans.sides(at.pair) else plan.config["design"]["budget_samples"]


def _samples(plan, at):
    """Samples of a patch."""
    return plan.devices.samples(Patch(at.pair, int(at.length), int(at.width)))


def _size(_plan, at):
    """Length and width of a patch."""
    length, width = (int(side) / NM_PER_UM for side in (at.length, at.width))
    return {"sampling": {"strip_length_um": length}, "beam": {"width_um": width}}


def _size_of_ground(plan, at):
    """Patch under a device, with the shape of a probe."""
    return _size(plan, at) | plan.devices.probe(Patch(at.pair, int(at.length), int(at.width)))


def _size_of_tips(plan, at):
    """Tilted strips with larger steps of the distance."""
    step = OF_TIPS * plan.config["contact"]["distance_step_nm"]
    tilt = plan.devices.tilt(Patch(at.pair, int(at.length), int(at.width)))
    return _size(plan, at) | {"contact": {"distance_step_nm": step}, "tilt": tilt}


def _size_of_tilted(plan, at):
    """Area of tilted stoppers with larger steps of the distance."""
    step = OF_TIPS * plan.config["contact"]["distance_step_nm"]
    tilt = plan.devices.inclination(Patch(at.pair, int(at.length), int(at.width)))
    return _size(plan, at) | {"contact": {"distance_step_nm": step}, "tilt": tilt}


#: Strips along the beam, as in the paper.
STRIPS = PatchKind("{pair}", "", lambda plan, at: {}, changed=_changed_strips)
#: Patch on which a device sticks: strips of another size, or the whole area of a stopper.
GROUND = PatchKind("{pair}_{length}x{width}", ", {length} x {width} nm,", _size_of_ground, _samples)
#: Tilted strips that hold the tips of cantilevers, one for each beam.
TIPS = PatchKind(
    GROUND.file,
    f"{GROUND.words} at the tips of beams,",
    _size_of_tips,
    lambda plan, _at: plan.config["design"]["beams"],
)
#: Area in which a tilted stopper touches.
TILTED = PatchKind(GROUND.file, f"{GROUND.words} of tilted stoppers,", _size_of_tilted)


@dataclass(frozen=True, eq=False, kw_only=True)
class PatchChange:
    """Change of the contact of a patch."""

    settings: Callable[[Any, Any, PatchKind], dict]  #: by the plan, the wildcards and the kind of patch
    kind: type | None = Settings  #: dataclass of the settings
    #: By the plan, the wildcards, and a function that names the contact of the patch with another change.
    inputs: Callable[[Any, Any, Callable], Mapping[str, Names]] = lambda plan, at, name_of: surface_inputs(
        plan, at.pair
    )
    compute: Callable[..., Any] = contact.from_surfaces
    each: Callable[[Any], Sequence[str]] | None = None  #: ends of the names of files that one job writes, by the plan
    end: str = ""  #: of the names of files
    subject: str = "Contact"  #: what is computed, in messages
    words: str = ""  #: change in messages, after the patch
    label: str = "contact"  #: name in the labels of the datasets
    running: Running = Running(minutes=10)  #: on strips; larger patches take longer
