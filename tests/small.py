"""A study small enough for tests: pair b on narrow strips, each stage computed once and by hand, without files."""

from functools import cache

from plans import job_settings

from stiction.config.cases import Case
from stiction.config.files import load
from stiction.config.units import in_si
from stiction.plan.plan import Plan
from stiction.stages.contact import contact
from stiction.stages.laws import chaos, forces
from stiction.stages.surfaces import heights, spectrum

PLAN = Plan(
    load(
        {
            "run": {"pairs": ["b"]},
            "contact": {"samples": 20},
            "attraction": {"reach": "touching"},
            "beam": {"samples": 3, "width_um": 6, "elements": 200},
            "chaos": {"order": 2},
            "character": {"strips": 3},
            "identification": {"patches": 2, "patch_um": 2},
            "studies": {
                "iteration": {"iterations": 2, "fields": 2},
                "sensitivity": {"samples": 4},
                "slopes": {"samples": 20},
                "plasticity": {"strips": 4},
                "full_contact": {"samples": 8},
                "asperities": {"samples": 3, "shapes": 2},
                "pressing": {"samples": 2, "steps": 2, "distance_nm": {"b": 4}},
                "orders": {"draws": 2000},
                "resampling": {"beams": 3},
                "mesh": {"elements_um": [15, 7.5], "strips_um": [7.5, 1.5]},
                "variants": {"samples": 20, "beams": 2, "asperity": ["island"]},
            },
        }
    )
)
SEED = PLAN.config["seed"]
CASE, HUMIDITY = Case("b_rh067"), 0.67


def settings_of(module, plain):
    """The settings of a stage or study from those of its job."""
    return in_si(module.Settings, plain)


@cache
def heights_of(surface):
    return heights.compute(settings_of(heights, job_settings(PLAN, f"heights/{surface}")))


@cache
def spectrum_of(surface):
    return spectrum.compute(heights_of(surface), settings_of(spectrum, job_settings(PLAN, f"spectrum/{surface}")))


@cache
def surfaces():
    """Datasets (heights, spectrum) of both surfaces of pair b."""
    return tuple((heights_of(name), spectrum_of(name)) for name in ("B2", "Sub1"))


@cache
def contact_of_pair():
    return contact.compute(surfaces(), "b", "NG", settings_of(contact, job_settings(PLAN, "contact/b_NG")))


@cache
def forces_of_case():
    return forces.compute(contact_of_pair(), settings_of(forces, job_settings(PLAN, f"forces/{CASE}_NG")))


@cache
def chaos_of_case():
    return chaos.compute(forces_of_case(), CASE, "NG", settings_of(chaos, job_settings(PLAN, "chaos/b_rh067_NG")))
