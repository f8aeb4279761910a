"""Names of the contacts and grounds used by the stages of devices."""

from typing import Any

from stiction.config.cases import Case, case_id
from stiction.config.units import without_unit
from stiction.contact.tilt import EDGE_RADIUS
from stiction.models import SHIFTS
from stiction.plan.devices import Patch, patch
from stiction.plan.stage import At
from stiction.stages.contact.changes.edges import EDGE
from stiction.stages.contact.changes.members import MEMBER
from stiction.stages.contact.changes.patches import GROUND, STRIPS, TILTED, TIPS
from stiction.stages.contact.changes.quantities import QUANTITY
from stiction.stages.contact.changes.solids import SOLID, VARIANT_OF_SOLIDS
from stiction.stages.contact.changes.table import AS_IT_IS, file_of
from stiction.stages.contact.changes.variants import VARIANT
from stiction.stages.contact.corrections import correction_inputs


def contact_of(plan: Any, case: Case) -> str:
    """Contact of the patch of a device at a humidity: the pair's in the main line if it is equal."""
    if plan.devices.has_strips_of_pair(case.device):
        return f"contact/{plan.contact_of_device(case)}_NG"
    return file_of(AS_IT_IS, GROUND, **patch_of(plan, case)._asdict())


def name_of_ground(plan: Any, case: Case) -> str:
    """Name of the ground of a device at a humidity."""
    size = plan.devices.ground(case.device)
    return f"{case_id(size.pair, case.humidity)}_{size.length}x{size.width}"


def case_on(plan: Any, at: At, of_tips: bool = False) -> Case:
    """Case of one of the devices on a ground, or with its tips on one.

    Raises
    ------
    KeyError
        If no device is on it.
    """
    size, devices = (at.case.pair, int(at.length), int(at.width)), plan.devices
    names, patch_of = (devices.with_tips, devices.tips) if of_tips else (devices.beams, devices.ground)
    if (user := next((name for name in names if patch_of(name) == size), None)) is None:
        raise KeyError(f"no device is on strips of {at.length} x {at.width} nm of pair {at.case.pair}")
    return Case(case_id(user, at.case.humidity))


def patch_of(plan: Any, case: Case) -> Patch:
    """Patch of contact of a device, named with its pair in the air of a case, see `stiction.plan.environment`."""
    return plan.devices.ground(case.device)._replace(pair=plan.contact_of_device(case))


def dimples_of(plan: Any, case: Case) -> str:
    """Contact of one dimple under a beam at a humidity."""
    sides = plan.devices.sections[case.device]["dimples"]["contact_um"]
    return file_of(AS_IT_IS, GROUND, **patch(plan.contact_of_device(case), *sides)._asdict())


def tilted_of(plan: Any, case: Case) -> str:
    """Contact of a tilted stopper at a humidity."""
    return file_of(AS_IT_IS, TILTED, **patch_of(plan, case)._asdict())


def tips_of(plan: Any, case: Case) -> dict[str, str]:
    """Contact of the strips at the tips of a cantilever at a humidity, none for a bridge."""
    if not plan.devices.kind(case.device).has_tip:
        return {}
    return {"tips": file_of(AS_IT_IS, TIPS, **patch_of_tips(plan, case)._asdict())}


def corrected_tips_of(plan: Any, case: Case) -> dict[str, str]:
    """Contact of the tips of a cantilever with its correction, none for a bridge, see `tips_of`."""
    tips = tips_of(plan, case)
    return tips | corrections_of(plan, case.device, case.humidity) if tips else {}


def patch_of_tips(plan: Any, case: Case) -> Patch:
    """Patch of the tips of a cantilever, named as by `patch_of`."""
    return plan.devices.tips(case.device)._replace(pair=plan.contact_of_device(case))


def corrections_of(plan: Any, device: str, *humidities: float) -> dict[str, str]:
    """Corrections of the pair of a device at some humidities, by default all of its own: by levels, or of its study."""
    section = plan.config["devices"][device]
    pair, airs = section["pair"], humidities or section["humidities"]
    if plan.devices.kind(device).shape:
        return changes_of_probe(plan, device)
    if plan.air_of_devices.by_levels(pair, airs):
        return {"model_error": f"studies/model_error/devices/{pair}"}
    return correction_inputs(plan, pair, airs, water=plan.air_of_devices.water(pair))


def changes_of_probe(plan: Any, device: str) -> dict[str, str]:
    """Changes of the forces of a probe by its own full contact, none of what is flat or if summits are wanted."""
    is_changed = plan.devices.kind(device).shape and plan.config["contact"].get("model") != "summits"
    return {"model_error": f"studies/model_error/probes/{device}"} if is_changed else {}


def contacts_of_budget(plan: Any, case: Case) -> dict[str, Any]:
    """Contact of the patch of a device, with less and more of every uncertain input, on members, and under choices."""
    device, patch = case.device, patch_of(plan, case)
    strips = STRIPS if plan.devices.has_strips_of_pair(device) else GROUND
    choices = plan.variants.choices_of_device(case)
    return {
        "contact": contact_of(plan, case),
        **corrections_of(plan, device, case.humidity),
        **_less_and_more(plan, device, patch, strips, GROUND),
        "members": _members(plan, device, patch, GROUND),
        "choices": {name: file_of(VARIANT, GROUND, **patch._asdict(), variant=name) for name in choices},
    }


def contacts_of_tip_budget(plan: Any, case: Case) -> dict[str, Any]:
    """Contact of the tips of a cantilever, with the changes of `contacts_of_budget`, and of the edge."""
    device, tips = case.device, patch_of_tips(plan, case)
    choices, changed = plan.variants.choices_of_solids(tips.pair), _less_and_more(plan, device, tips, TIPS, TIPS)
    if plan.devices.has_uncertain_edge(device):
        for shift in SHIFTS:
            edge = file_of(EDGE, TIPS, **tips._asdict(), side=shift)
            changed[f"properties_{shift}"][without_unit(EDGE_RADIUS.key)] = edge
    return {
        "contact": file_of(AS_IT_IS, TIPS, **tips._asdict()),
        **changed,
        "members": _members(plan, device, tips, TIPS),
        "choices": {name: file_of(VARIANT_OF_SOLIDS, TIPS, **tips._asdict(), variant=name) for name in choices},
    }


def _members(plan, device, patch, patch_kind):
    """Contacts of a patch with each other member in place of an assumed surface, by surface and member."""
    return {
        (surface, member): file_of(MEMBER, patch_kind, **patch._asdict(), surface=surface, member=member)
        for surface, members in plan.devices.members(device).items()
        for member in members
        if not plan.devices.is_itself(surface, member)
    }


def _less_and_more(plan, device, patch, of_surfaces, of_solids):
    """Contacts of a patch with less and more of every uncertain input of a device, by the kind of patch of each."""
    sides, quantities, properties = (
        patch._asdict(),
        plan.devices.quantities(device),
        plan.devices.uncertain_properties(device),
    )
    shifted = {
        shift: {
            (surface, quantity): file_of(QUANTITY, of_surfaces, **sides, surface=surface, quantity=quantity, each=shift)
            for surface, quantity in quantities
        }
        for shift in SHIFTS
    }
    uncertain = {
        f"properties_{shift}": {
            name: file_of(SOLID, of_solids, **sides, solid_property=name, side=shift) for name in properties
        }
        for shift in SHIFTS
    }
    return shifted | uncertain
