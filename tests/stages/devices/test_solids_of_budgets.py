"""Contacts with less and with more of a property of the solids, against what elasticity and scaling demand of them."""

from dataclasses import replace

import numpy as np
import pytest
import small
from numpy.testing import assert_allclose, assert_array_equal
from plans import job_settings

from stiction.config.files import load
from stiction.config.merging import merged
from stiction.config.units import in_si
from stiction.contact.environment import Water
from stiction.contact.materials import OF_CONTACT
from stiction.plan.plan import Plan
from stiction.stages.contact import contact, curves
from stiction.stages.devices import budget
from stiction.stages.devices.uncertain_inputs import Uncertainty

WATER = Water(300.0)
STOPPER = budget.PatchBudget(1, WATER, 0.5, Uncertainty(), ("B2", "Sub1"), 164e9, contact=(3e-6, 2e-6))
PATCH = "b", 1500, 6000
SIDES = {"B2": "beam", "Sub1": "substrate"}
GAPS = np.linspace(0, 2e-8, 50)
E, RATIO = 164.0, 0.23


def met(plain):
    """Contact of the surfaces of the small study under the settings of a job."""
    return contact.compute(small.surfaces(), "b", "NG", in_si(contact.Settings, plain))


def changed(name, plan=small.PLAN):
    """Contacts with less and with more of a property."""
    return tuple(
        met(job_settings(plan, f"devices/contact/{name}/{PATCH[0]}_{PATCH[1]}x{PATCH[2]}_{side}"))
        for side in ("less", "more")
    )


def with_solid(**properties):
    """Contact with other properties of the solid."""
    return met(merged(job_settings(small.PLAN, "contact/b_NG"), {"solid": properties}))


def slopes(stated, solids):
    """Slopes of the force of a stopper by input, (slope, standard error)."""
    settings = replace(STOPPER, uncertainty=stated, hamaker_constant=97.5e-21)
    found = budget.compute(small.contact_of_pair(), {}, solids, {}, {}, settings)
    return dict(zip(found.input.values, zip(found.slope.values, found.slope_error.values, strict=True), strict=True))


def test_poissons_ratio_acts_through_the_modulus_of_plane_strain_alone():
    less, more = changed("poisson_ratio")
    for ratio, found in ((0.18, less), (0.28, more)):
        stiff = E * (1 - RATIO**2) / (1 - ratio**2)
        assert_allclose(found.solid_pressure, with_solid(young_modulus_GPa=stiff).solid_pressure, rtol=1e-5)
        # The other shift, that of E alone which undoes it, gives the contact as it was.
        soft = with_solid(young_modulus_GPa=E * (1 - ratio**2) / (1 - RATIO**2), poisson_ratio=ratio)
        assert_allclose(soft.solid_pressure, small.contact_of_pair().solid_pressure, rtol=1e-5)
        assert abs(found.solid_pressure / small.contact_of_pair().solid_pressure - 1).max() > 0.01  # control


def test_the_force_between_the_solids_is_proportional_to_both_stiffness_and_hamaker_constant():
    step = OF_CONTACT["hamaker_constant"].step.size
    for factor, side in ((1 - step, "less"), (1 + step, "more")):
        plain = job_settings(small.PLAN, f"devices/contact/hamaker_constant/{PATCH[0]}_{PATCH[1]}x{PATCH[2]}_{side}")
        stiffer = {"young_modulus_GPa": factor * E}
        found = met(merged(plain, {"materials": {"beam": stiffer, "substrate": stiffer}}))
        base = small.contact_of_pair().solid_pressure
        assert_allclose(found.solid_pressure, factor * base, rtol=1e-5, atol=1e-5 * float(abs(base).max()))
        other = met(plain).solid_pressure
        assert abs(other - factor * base).max() > 1e-3 * abs(base).max()  # control: without the stiffness


def test_samples_of_changed_solids_have_the_same_surfaces():
    base = small.contact_of_pair()
    for name in OF_CONTACT:
        for one in changed(name):
            assert_array_equal(one.bearing_area, base.bearing_area)
            assert (one.solid_pressure != base.solid_pressure).any()  # control


def test_a_stopper_of_stiffer_solids_holds_less_and_one_of_stronger_attraction_more():
    solids = {name: changed(name) for name in OF_CONTACT}
    found = slopes(Uncertainty(young_modulus=5e9, poisson_ratio=0.02, hamaker_constant=2e-20), solids)
    modulus, ratio, constant = (found[name] for name in ("Young's modulus", "Poisson's ratio", "Hamaker constant"))
    assert modulus[0] < -4 * modulus[1]
    assert constant[0] > 4 * constant[1]
    # d ln E' / dν = 2 ν / (1 - ν²)
    power = np.log((1 - 0.18**2) / (1 - 0.28**2)) / 0.1
    assert_allclose(power, 2 * RATIO / (1 - RATIO**2), rtol=0.01)
    assert abs(ratio[0] - power * modulus[0]) < 4 * np.hypot(ratio[1], power * modulus[1]) + 0.02 * abs(ratio[0])
    assert_allclose(ratio[0], power * modulus[0], rtol=0.05)  # the same samples: far closer than their errors


def test_without_van_der_waals_forces_the_hamaker_constant_has_no_effect():
    hertz = Plan(merged(small.PLAN.config, {"van_der_waals": "none"}))
    less, more = changed("hamaker_constant", hertz)
    assert_array_equal(less.solid_pressure, more.solid_pressure)
    assert slopes(Uncertainty(hamaker_constant=2e-20), {"hamaker_constant": (less, more)}) == {
        "Hamaker constant": (0, 0)
    }


#: Properties of both surfaces with a material; with none, both are of polysilicon.
GLASS, COATED = ({"hamaker_constant_zJ": {"water": 40, "dry": 90}} | more for more in ({}, {"coating_nm": 1.2}))
COATED |= {"coating_hamaker_constant_zJ": {"water": 4, "dry": 50}}


@pytest.mark.parametrize(
    "materials", [{}, {"Sub1": GLASS}, {"B2": GLASS}, {"Sub1": COATED}, {"B2": GLASS, "Sub1": GLASS}]
)
def test_the_hamaker_constant_of_a_device_acts_across_gaps_like_that_of_other_solids(materials):
    def plan(factor):
        solids = {
            name: {"hamaker_constant_zJ": {"water": 97.5, "dry": 186.5}} | materials.get(name, {}) for name in SIDES
        }
        for name in [name for name in SIDES if solids[name] == solids["B2"]]:
            constants = solids[name]["hamaker_constant_zJ"].items()
            solids[name] |= {"hamaker_constant_zJ": {medium: factor * value for medium, value in constants}}
        surfaces = {name: {"material": f"Of{name}"} for name in solids}
        return Plan(load({"materials": {f"Of{name}": solid for name, solid in solids.items()}, "surfaces": surfaces}))

    gaps = {factor: in_si(Water, plan(factor).air_of_devices.water("b")).gaps for factor in (1, 1.2)}
    found, height = gaps[1].scaled(1.2, plan(1).materials.alike("b")), 1.4e-9
    assert_allclose(found.work(GAPS, height), gaps[1.2].work(GAPS, height), rtol=1e-12)
    assert abs(found.work(GAPS, height) / gaps[1].work(GAPS, height) - 1).max() > 0.03  # control


def test_the_slope_of_the_hamaker_constant_is_that_of_summits_and_gaps_together():
    across = Plan(merged(small.PLAN.config, {"attraction": {"reach": "all"}}))
    water = in_si(Water, across.air_of_devices.water("b"))
    solids = changed("hamaker_constant", across)
    settings = replace(STOPPER, water=water, uncertainty=Uncertainty(hamaker_constant=2e-20), hamaker_constant=97.5e-21)
    found = budget.compute(small.contact_of_pair(), {}, {"hamaker_constant": solids}, {}, {}, settings)
    step = OF_CONTACT["hamaker_constant"].step
    waters = [replace(water, gaps=water.gaps.scaled(end, SIDES.values())) for end in step.ends(1.0)]
    less, more = (curves.pull_offs(one, 0.5, air).mean() for one, air in zip(solids, waters, strict=True))
    assert float(found.slope[0]) == pytest.approx(np.log(more / less) / step.difference)
    alone = [curves.pull_offs(one, 0.5, water).mean() for one in solids]
    assert float(found.slope[0]) > 1.2 * np.log(alone[1] / alone[0]) / step.difference  # control: summits alone


@pytest.mark.parametrize("medium", ["water", "dry"])
def test_a_body_of_another_material_halves_the_change_of_the_attraction(medium):
    # A_132 = sqrt(A_131 A_232): as much change of one body is that of both by its square root.
    glass = {"hamaker_constant_zJ": {"water": 40, "dry": 90}}
    named = {"van_der_waals": medium, "materials": {"Glass": glass}, "surfaces": {"B2": {"material": "Glass"}}}
    one = changed("hamaker_constant", Plan(merged(small.PLAN.config, named)))
    for factor, found in zip((0.8, 1.2), one, strict=True):
        mean = {at: np.sqrt(factor * glass["hamaker_constant_zJ"][at] * known) for at, known in KNOWN.items()}
        both = {side: {"hamaker_constant_zJ": mean} | small.PLAN.config["solid"] for side in ("beam", "substrate")}
        plain = job_settings(small.PLAN, "contact/b_NG") | {"van_der_waals": medium, "materials": both}
        assert_allclose(found.solid_pressure, met(plain).solid_pressure, rtol=1e-5, atol=10)


#: Hamaker constants of polysilicon [zJ].
KNOWN = {"water": 97.5, "dry": 186.5}
