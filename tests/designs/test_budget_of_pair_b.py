"""Slopes of the crack length of the paper's pair b against an independent study."""

import numpy as np
import pytest

from stiction.config import jobs
from stiction.config.files import load
from stiction.config.plan import Plan
from stiction.config.units import typed
from stiction.designs import budget
from stiction.devices.budget import Budget
from stiction.models import OF_MOMENTS
from stiction.stages import contact
from stiction.studies import slope_contact
from stiction.study import surface_datasets

C1 = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.67]}
C1 |= {"uncertainty": {"thickness_um": 0.05, "gap_um": 0.3, "young_modulus_GPa": 5, "scan_um": 10}}
#: Slopes d ln l_s / dx at RH 0.67 by central differences on 5000 samples of contact and 1000 beams; those of rms,
#: dimensions and Young's modulus are logarithmic.
KNOWN = {"rms of B2": 1.00, "skewness of B2": 0.76 / 0.76, "kurtosis of B2": 0.87 / 3.9}
KNOWN |= {"thickness": 0.79, "gap": 0.50, "Young's modulus": 0.53}
#: Their standard error [-].
ERROR = 0.02


@pytest.mark.slow
def test_slopes_of_pair_b_are_those_of_an_independent_study():
    plan = Plan(load({"devices": {"C1": C1}, "contact": {"samples": 300}, "chaos": {"order": 4}}))
    surfaces = [surface_datasets(plan, name) for name in plan.sides("b")]
    settings = typed(slope_contact.Settings, jobs.slope_contact(plan, "b"))

    def shifted(quantity):
        return tuple(slope_contact.compute(surfaces, "b", "B2", quantity, settings))

    def of_modulus(side):
        return contact.compute(
            surfaces, "b", "NG", typed(contact.Settings, jobs.modulus_contact(plan, "b", 1500, 30000, side))
        )

    base = contact.compute(surfaces, "b", "NG", typed(contact.Settings, jobs.contact(plan, "b")))
    found = budget.compute(
        base,
        {("B2", quantity): shifted(quantity) for quantity in OF_MOMENTS},
        tuple(map(of_modulus, ("less", "more"))),
        {},
        {"B2": budget.of_one_scan(*surfaces[0], 10e-6)},
        typed(budget.Settings, jobs.budget(plan, "C1_rh067")["budget"]),
    )
    slopes = dict(zip(found.input.values, zip(found.slope.values, found.slope_error.values, strict=True), strict=True))
    assert set(slopes) == set(KNOWN)
    for name, (slope, error) in slopes.items():
        assert abs(slope - KNOWN[name]) < 4 * np.hypot(error, ERROR), name
    whole, heights = budget.budget_of(found), tuple(f"{quantity} of B2" for quantity in OF_MOMENTS)
    known = Budget(heights, np.array([KNOWN[name] for name in heights]), whole.covariance[:3, :3])
    error = np.hypot(
        whole.error_of_effect(heights, found.slope_error.values), known.error_of_effect(heights, [ERROR] * 3)
    )
    assert abs(whole.effect(heights) - known.effect(heights)) < 4 * error
    # Errors of skewness and kurtosis from one scan compensate: taken as independent they seem more than twice as large.
    assert whole.uncorrelated.effect(heights) > 2 * whole.effect(heights)
