"""Contacts of devices: names of their datasets, and settings on patches of any size.

Separate from the stages that compute these contacts, so that no other stage depends on their code.
"""

from collections.abc import Callable
from typing import Any

from stiction.config.cases import Case
from stiction.config.device_plan import OF_TIPS, Patch
from stiction.config.merging import merged
from stiction.config.stated_materials import hamaker_constants
from stiction.config.units import NM_PER_UM
from stiction.devices.materials import OF_CONTACT
from stiction.models import SHIFTS, SIDES
from stiction.plan.stage import At, select
from stiction.stages.contact.corrections import of_pair
from stiction.stages.contact.pairs import Settings

#: Folder of the contacts of devices.
FOLDER = "devices/contact"


def contact_of(plan: Any, case: Case) -> str:
    """Contact of the patch on which a device sticks at a humidity: that of its pair in the main line if it is equal."""
    if plan.devices.has_strips_of_pair(case.device):
        return f"contact/{plan.contact_of_device(case)}_NG"
    return f"{FOLDER}/{patch_of(plan, case).name}"


def patch_of(plan: Any, case: Case) -> Patch:
    """Patch on which a device sticks, with the name of its pair in the air of a case."""
    return _in_its_air(plan, case, plan.devices.ground)


def _in_its_air(plan, case, of_device):
    """Patch of a device with the name of its pair in the air of a case, see `stiction.plan.air.Air`."""
    return of_device(case.device)._replace(pair=plan.contact_of_device(case))


def tips_of(plan: Any, case: Case) -> dict[str, str]:
    """Contact of the strips that hold the tips of a cantilever at a humidity; none for a bridge."""
    if not plan.devices.kind(case.device).has_tip:
        return {}
    return {"tips": f"{FOLDER}/tips/{_in_its_air(plan, case, plan.devices.tips).name}"}


def corrections_of(plan: Any, device: str) -> dict[str, str]:
    """As `stiction.stages.contact.corrections.of_pair`, of the pair of a device."""
    return of_pair(plan, plan.config["devices"][device]["pair"])


def contacts_of_budget(plan: Any, case: Case) -> dict[str, Any]:
    """Contact of the patch of a device, with less and more of every uncertain input, and under other choices."""
    devices, device = plan.devices, case.device
    patch = patch_of(plan, case)
    shared = f"studies/slopes/contact/{patch.pair}"
    slopes = shared if devices.has_strips_of_pair(device) else f"{FOLDER}/slopes/{patch.name}"
    contacts, choices = {"contact": contact_of(plan, case)}, plan.variants.choices_of_device(case)
    changed = _changed(plan, device, slopes, f"{FOLDER}/{{}}/{patch.name}", choices)
    return contacts | corrections_of(plan, device) | changed


def contacts_of_tip_budget(plan: Any, case: Case) -> dict[str, Any]:
    """As `contacts_of_budget`, of the tips of a cantilever."""
    tips = _in_its_air(plan, case, plan.devices.tips)
    folder, choices = f"{FOLDER}/tips", plan.variants.choices_of_solids(tips.pair)
    contacts = {"contact": f"{folder}/{tips.name}"}
    changed = f"{folder}/slopes/{tips.name}", f"{folder}/{{}}/{tips.name}"
    return contacts | _changed(plan, case.device, *changed, choices)


def _changed(plan, device, slopes, changed, choices):
    """Contacts of a patch with less and more of every uncertain input of a device, and under choices of the model.

    ``slopes`` begins the names of those with a shifted quantity of a surface, ``changed`` those of all others.
    """
    devices = plan.devices
    quantities, solids = devices.quantities(device), devices.uncertain_solids(device)
    shifted = {shift: {key: f"{slopes}_{key[0]}_{key[1]}_{shift}" for key in quantities} for shift in SHIFTS}
    uncertain = {f"solids_{shift}": {name: f"{changed.format(name)}_{shift}" for name in solids} for shift in SHIFTS}
    return shifted | uncertain | {"choices": {name: f"{changed.format('choices')}_{name}" for name in choices}}


# Settings


def on_patch(plan: Any, at: At, samples: int) -> dict[str, Any]:
    """As those of the contact of a pair, on a patch of another size."""
    size = {"strip_length_um": int(at.length) / NM_PER_UM}
    settings = select(Settings, plan.seen_by(at.pair, samples=samples))
    return settings | {
        "sampling": settings["sampling"] | size,
        "beam": {"width_um": int(at.width) / NM_PER_UM},
    }


def of_patch(plan: Any, at: At) -> dict[str, Any]:
    """Contact of the patch of a device."""
    return on_patch(plan, at, plan.config["contact"]["samples"])


def of_tips(plan: Any, at: At) -> dict[str, Any]:
    """Contact of the tilted strips that hold the tips of beams; every beam has its own."""
    settings = on_patch(plan, at, plan.config["design"]["beams"])
    step = {"distance_step_nm": OF_TIPS * settings["contact"]["distance_step_nm"]}
    tips = Patch(at.pair, int(at.length), int(at.width))
    return settings | {"contact": settings["contact"] | step, "tilt": plan.devices.tilt(tips)}


def of_slopes(plan: Any, at: At) -> dict[str, Any]:
    """Contact with a shifted quantity of a surface."""
    return on_patch(plan, at, plan.config["studies"]["slopes"]["samples"])


def of_rerun(plan: Any, patch: Patch) -> dict[str, Any]:
    """Contact that is compared with the first samples of that of a patch."""
    return on_patch(plan, At(**patch._asdict()), plan.samples_of_slopes)


def with_property(settings: dict[str, Any], name: str, change: Callable[[float], float]) -> dict[str, Any]:
    """Settings of a contact with another value of a property of the beam's material, in both bodies of it."""
    key, solid = OF_CONTACT[name].key, settings["solid"]
    if "materials" not in settings and key in solid:
        return settings | {"solid": _with_other(solid, name, change)}
    bodies = settings.get("materials", dict.fromkeys(SIDES, solid))
    of_beam = _with_other(bodies["beam"], name, change)
    changed = {body: of_beam if material == bodies["beam"] else material for body, material in bodies.items()}
    return settings | {"materials": changed}


def less_or_more(name: str, shift: str) -> Callable[[float], float]:
    """Change of a property to less or more of it, as in `with_property`."""
    return lambda value: OF_CONTACT[name].step.ends(value)[SHIFTS.index(shift)]


def _with_other(material, name, change):
    """Material with another value of a property; of its Hamaker constants through all media by the same factor."""
    key = OF_CONTACT[name].key
    value = (material | {"hamaker_constant_zJ": hamaker_constants(material)})[key]
    if isinstance(value, dict):
        return material | {key: {medium: change(constant) for medium, constant in value.items()}}
    return material | {key: change(value)}


def of_choice_summits(plan: Any, at: At) -> dict[str, Any]:
    """Summits of the patch of a device under a variant of the model."""
    settings, size = plan.variants.summits(at.pair, at.variant), on_patch(plan, at, plan.samples_of_slopes)
    return settings | {"base": merged(settings["base"], {key: size[key] for key in ("sampling", "beam", "contact")})}
