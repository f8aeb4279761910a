"""Contacts of the patch of a device under other choices of the model."""

from stiction.stages.contact.variant_contact import CONTACT
from stiction.stages.contact.variant_summits import SUMMITS
from stiction.stages.devices.patch_settings import FOLDER, of_choice_summits

STAGES = (
    SUMMITS.on(
        "device_choice_summits",
        FOLDER + "/summits/{pair}_{length}x{width}_{variant}",
        settings=of_choice_summits,
        message="Summits of pair {pair}, {length} x {width} nm, under variant {variant}.",
        label="variant_summits",
    ),
    CONTACT.on(
        "device_choice_contact",
        FOLDER + "/choices/{pair}_{length}x{width}_{variant}",
        inputs=lambda plan, at: {
            "summits": f"{FOLDER}/summits/{at.pair.pair}_{at.length}x{at.width}_"
            + plan.variants.with_summits_of(at.pair, at.variant)
        },
        message="Contact of pair {pair}, {length} x {width} nm, under variant {variant}.",
    ),
)
