"""Contacts of devices: of the patch on which a device sticks and of the tips of beams, with other solids as well.

The samples of all contacts of a patch have the same random numbers.
"""

from stiction.plan.stage import Stage
from stiction.stages.contact.contact import compute
from stiction.stages.contact.pairs import Settings
from stiction.stages.devices import patch_settings
from stiction.stages.devices.patch_settings import FOLDER, less_or_more
from stiction.stages.surfaces.rough_surfaces import both, of_pair


def _stage(name, file, settings, message):
    """Contact of a patch of a pair with some settings."""
    return Stage.writing(
        name,
        f"{FOLDER}/{file}",
        inputs=lambda plan, at: of_pair(plan, at.pair),
        settings=settings,
        kind=Settings,
        compute=lambda data, at, settings: compute(both(data), at.pair, "NG", settings),
        label="contact",
        message=f"Contact of pair {{pair}}, {message}.",
        cluster=True,
        minutes=120,
    )


_PATCH, _AT_TIPS = "{length} x {width} nm", "at the tips of beams"
STAGES = (
    _stage("device_contact", "{pair}_{length}x{width}", patch_settings.of_patch, _PATCH),
    _stage("tip_contact", "tips/{pair}_{length}x{width}", patch_settings.of_tips, f"{_PATCH}, {_AT_TIPS}"),
    _stage(
        "solid_contact",
        "{solid_property}/{pair}_{length}x{width}_{side}",
        lambda plan, at: patch_settings.with_property(
            patch_settings.on_patch(plan, at, plan.samples_of_slopes),
            at.solid_property,
            less_or_more(at.solid_property, at.side),
        ),
        f"{_PATCH}, with {{side}} {{solid_property}} of the solids",
    ),
    _stage(
        "tip_solid_contact",
        "tips/{solid_property}/{pair}_{length}x{width}_{side}",
        lambda plan, at: patch_settings.with_property(
            patch_settings.of_tips(plan, at), at.solid_property, less_or_more(at.solid_property, at.side)
        ),
        f"{_PATCH}, {_AT_TIPS}, with {{side}} {{solid_property}} of the solids",
    ),
    _stage(
        "tip_choice_contact",
        "tips/choices/{pair}_{length}x{width}_{variant}",
        lambda plan, at: patch_settings.of_tips(plan, at) | plan.variants.solids(at.pair, at.variant),
        f"{_PATCH}, {_AT_TIPS}, under variant {{variant}}",
    ),
)
