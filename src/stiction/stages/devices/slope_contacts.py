"""Contacts of the patch and the tips of a device with less and with more of a quantity of a surface."""

from stiction.stages.contact.slope_contact import SHIFTED_CONTACT
from stiction.stages.devices.patch_settings import FOLDER, of_slopes, of_tips

STAGES = (
    SHIFTED_CONTACT.on(
        "device_slope_contact",
        FOLDER + "/slopes/{pair}_{length}x{width}_{surface}_{quantity}_{each}",
        settings=of_slopes,
        message="Contact of pair {pair}, {length} x {width} nm, with less and more {quantity} of {surface}.",
    ),
    SHIFTED_CONTACT.on(
        "tip_slope_contact",
        FOLDER + "/tips/slopes/{pair}_{length}x{width}_{surface}_{quantity}_{each}",
        settings=of_tips,
        message="Contact of pair {pair} at the tips of beams, with less and more {quantity} of {surface}.",
    ),
)
