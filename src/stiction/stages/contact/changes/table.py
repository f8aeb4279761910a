"""Contacts of a pair: changes x kinds of patch for the contact of its surfaces.

A row of `TABLE` is a change, and a cell of it a kind of patch for which it is computed. Each change is described in its
module, with the function that computes it. All contacts of a patch have the same random numbers, so that their
differences are those of the changes.
"""

from dataclasses import replace

from stiction.plan.stage import Running, Stage
from stiction.stages.contact import contact
from stiction.stages.contact.changes.edges import EDGE
from stiction.stages.contact.changes.members import MEMBER
from stiction.stages.contact.changes.moments import MOMENTS
from stiction.stages.contact.changes.patches import GROUND, STRIPS, TILTED, TIPS, PatchChange, PatchKind
from stiction.stages.contact.changes.quantities import QUANTITY
from stiction.stages.contact.changes.scan_options import SCAN_OPTION
from stiction.stages.contact.changes.solids import SOLID, VARIANT_OF_SOLIDS
from stiction.stages.contact.changes.variants import SUMMITS, VARIANT, VARIANT_OF_ISLANDS
from stiction.stages.contact.pairs import Settings
from stiction.stages.surfaces.rough_surfaces import surface_inputs

#: No change.
AS_IT_IS = PatchChange(
    settings=lambda plan, at, patch_kind: patch_kind.settings(plan, at, patch_kind.samples(plan, at)),
    running=Running(minutes=10, priority=1),
)
#: Rule and folder of each contact, by change and kind of patch. Strips as they are follow below.
TABLE = {
    AS_IT_IS: {
        GROUND: ("device_contact", "devices/contact"),
        TIPS: ("tip_contact", "devices/contact/tips"),
        TILTED: ("tilted_contact", "devices/contact/tilted"),
    },
    QUANTITY: {
        STRIPS: ("slope_contact", "studies/slopes/contact"),
        GROUND: ("device_slope_contact", "devices/contact/slopes"),
        TIPS: ("tip_slope_contact", "devices/contact/tips/slopes"),
    },
    MEMBER: {
        GROUND: ("device_member_contact", "devices/contact/members"),
        TIPS: ("tip_member_contact", "devices/contact/tips/members"),
    },
    MOMENTS: {
        STRIPS: ("sensitivity_contact", "studies/sensitivity/contact"),
    },
    SCAN_OPTION: {
        STRIPS: ("choice_contact", "studies/choices"),
    },
    SOLID: {
        GROUND: ("solid_contact", "devices/contact/{solid_property}"),
        TIPS: ("tip_solid_contact", "devices/contact/tips/{solid_property}"),
    },
    EDGE: {
        TIPS: ("tip_edge_contact", "devices/contact/tips/edge"),
    },
    VARIANT_OF_SOLIDS: {
        TIPS: ("tip_choice_contact", "devices/contact/tips/choices"),
    },
    SUMMITS: {
        STRIPS: ("variant_summits", "studies/variants/summits"),
        GROUND: ("device_choice_summits", "devices/contact/summits"),
    },
    VARIANT: {
        STRIPS: ("variant_contact", "studies/variants/contact"),
        GROUND: ("device_choice_contact", "devices/contact/choices"),
    },
    VARIANT_OF_ISLANDS: {
        STRIPS: ("variant_islands", "studies/variants/islands"),
    },
}


def file_of(change: PatchChange, patch_kind: PatchKind, **wildcards: str) -> str:
    """Name of a contact."""
    return _pattern(change, patch_kind).format(**wildcards)


def _pattern(change, patch_kind):
    """Name of a contact with its wildcards."""
    _, folder = TABLE[change][patch_kind]
    return f"{folder}/{patch_kind.file}{change.end}"


def _stage(change, patch_kind):
    """Stage of a cell of the table."""

    def inputs(plan, at):
        """Inputs of a change, with names of contacts on this patch."""
        return change.inputs(plan, at, lambda other, **different: file_of(other, patch_kind, **vars(at) | different))

    rule, _ = TABLE[change][patch_kind]
    takes_longer = patch_kind is not STRIPS and change.running.minutes
    running = replace(change.running, minutes=120) if takes_longer else change.running
    message = f"{change.subject} of pair {{pair}}{patch_kind.words} {change.words}"
    return Stage.writing(
        rule,
        _pattern(change, patch_kind),
        inputs=inputs,
        settings=lambda plan, at: change.settings(plan, at, patch_kind),
        kind=change.kind,
        compute=change.compute,
        each=change.each,
        label=change.label,
        message=message.rstrip(" ,") + ".",
        running=running,
    )


def _chunks(plan, at):
    """Chunks of the samples of a pair in their order."""
    number = plan.config["contact"]["chunks"]
    return {"chunks": [f"contact/{at.pair}_{at.model}/{chunk}-of-{number}" for chunk in range(number)]}


#: Strips as they are, of Gaussian surfaces as well. They are the most, and drawn in chunks.
OF_PAIR = (
    Stage.writing(
        "contact_chunk",
        "contact/{pair}_{model}/{chunk}-of-{number}",
        inputs=lambda plan, at: surface_inputs(plan, at.pair),
        settings=lambda plan, at: AS_IT_IS.settings(plan, at, STRIPS),
        kind=Settings,
        compute=contact.drawn_chunk,
        label="contact",
        message="Contact of {model} surfaces of pair {pair}, chunk {chunk} of {number} (Sec. III-A).",
        running=Running(minutes=30, priority=1, temporary=True),
    ),
    Stage.writing(
        "contact",
        "contact/{pair}_{model}",
        inputs=_chunks,
        settings=lambda plan, at: AS_IT_IS.settings(plan, at, STRIPS),
        kind=Settings,
        compute=contact.join_chunks,
        running=Running(priority=1, streamed=True),
        message="Join the contact of {model} surfaces of pair {pair} (Sec. III-A).",
    ),
)
STAGES = (*OF_PAIR, *(_stage(change, patch_kind) for change, row in TABLE.items() for patch_kind in row))
