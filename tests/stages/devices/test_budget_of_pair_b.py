"""Slopes of the crack length of the paper's pair b, and what contact angles do to it, against an independent study."""

from dataclasses import replace

import numpy as np
import pytest
from plans import job_settings, surface_datasets

from stiction.config.files import load
from stiction.config.merging import merged
from stiction.config.units import in_si
from stiction.contact.environment import Water
from stiction.contact.materials import OF_CONTACT
from stiction.devices.budget import Budget
from stiction.estimates import jackknife
from stiction.models import MOMENT_QUANTITIES
from stiction.plan.plan import Plan
from stiction.stages.contact import contact, curves
from stiction.stages.contact.changes import quantities
from stiction.stages.devices import budget
from stiction.stages.devices import uncertain_inputs as inputs

C1 = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.44, 0.67]}
C1 |= {"uncertainty": {"thickness_um": 0.05, "gap_um": 0.3, "young_modulus_GPa": 5, "scan_um": 10}}
SOLIDS = {"young_modulus_GPa": 5, "poisson_ratio": 0.02, "hamaker_constant_zJ": 20}
PLAN = Plan(load({"devices": {"C1": C1}, "contact": {"samples": 200}, "chaos": {"order": 4}}))
#: Slopes d ln l_s / dx by humidity, by central differences on 5000 samples of contact and 1000 beams; those of rms,
#: dimensions and Young's modulus are logarithmic.
KNOWN = {
    0.67: {"rms of B2": 1.00, "skewness of B2": 0.76 / 0.76, "kurtosis of B2": 0.87 / 3.9}
    | {"thickness": 0.79, "gap": 0.50, "Young's modulus": 0.53},
    0.44: {"rms of B2": 1.40, "skewness of B2": 1.12 / 0.76, "kurtosis of B2": 1.40 / 3.9}
    | {"thickness": 0.77, "gap": 0.48, "Young's modulus": 0.80},
}
#: Their standard error [-].
ERROR = 0.02
WATER, RATIO = Water(300.0), PLAN.config["solid"]["poisson_ratio"]


@pytest.fixture(scope="module")
def surfaces():
    return [surface_datasets(PLAN, name) for name in PLAN.sides("b")]


@pytest.fixture(scope="module")
def base(surfaces):
    return contact.compute(surfaces, "b", "NG", in_si(contact.Settings, job_settings(PLAN, "contact/b_NG")))


@pytest.fixture(scope="module")
def changed(surfaces):
    """Contacts with less and with more of every quantity of B2."""
    settings = in_si(quantities.Settings, job_settings(PLAN, "studies/slopes/contact/b_B2_rms_less"))
    return {("B2", name): tuple(quantities.compute(surfaces, "b", "B2", name, settings)) for name in MOMENT_QUANTITIES}


@pytest.fixture(scope="module")
def solids(surfaces):
    """Contacts with less and with more of every property of the solids."""

    def changed(name, side):
        plain = job_settings(PLAN, f"devices/contact/{name}/b_1500x30000_{side}")
        return contact.compute(surfaces, "b", "NG", in_si(contact.Settings, plain))

    return {name: tuple(changed(name, side) for side in ("less", "more")) for name in OF_CONTACT}


@pytest.mark.slow
@pytest.mark.parametrize("humidity", KNOWN)
def test_slopes_of_pair_b_are_those_of_an_independent_study(humidity, surfaces, base, changed, solids):
    known = {"B2": inputs.errors_of_one_scan(*surfaces[0], 10e-6)}
    settings = budget.budget_settings(
        job_settings(PLAN, f"devices/budget/{f'C1_rh{round(100 * humidity):03}'}")["budget"]
    )
    found = budget.compute(base, changed, {"modulus": solids["modulus"]}, {}, known, settings)
    slopes = dict(zip(found.input.values, zip(found.slope.values, found.slope_error.values, strict=True), strict=True))
    assert set(slopes) == set(KNOWN[humidity])
    for name, (slope, error) in slopes.items():
        assert abs(slope - KNOWN[humidity][name]) < 4 * np.hypot(error, ERROR), name
    whole, heights = budget.budget_of(found), tuple(f"{quantity} of B2" for quantity in MOMENT_QUANTITIES)
    expected = Budget(heights, np.array([KNOWN[humidity][name] for name in heights]), whole.covariance[:3, :3])
    error = np.hypot(
        whole.error_of_effect(heights, found.slope_error.values), expected.error_of_effect(heights, [ERROR] * 3)
    )
    assert abs(whole.effect(heights) - expected.effect(heights)) < 4 * error
    # Errors of skewness and kurtosis from one scan compensate: taken as independent they seem more than twice as large.
    assert whole.uncorrelated.effect(heights) > 2 * whole.effect(heights)


@pytest.mark.slow
@pytest.mark.parametrize("humidity", KNOWN)
def test_slopes_of_the_solids_follow_the_energy_of_the_contact(humidity, base, solids):
    plan = Plan(merged(PLAN.config, {"devices": {"C1": {"uncertainty": SOLIDS}}}))
    settings = budget.budget_settings(
        job_settings(plan, f"devices/budget/{f'C1_rh{round(100 * humidity):03}'}")["budget"]
    )
    found = budget.compute(base, {}, solids, {}, {}, settings)
    slopes = dict(zip(found.input.values, zip(found.slope.values, found.slope_error.values, strict=True), strict=True))
    # Eq. (13): the length has the power -1/4 of the energy of the contact.
    for name, key in (("Poisson's ratio", "poisson_ratio"), ("Hamaker constant", "hamaker_constant")):
        energy = np.log([curves.energies(one, humidity, WATER).mean() for one in solids[key]])
        expected = -0.25 * np.diff(energy)[0] / OF_CONTACT[key].step.difference
        slope, error = slopes[name]
        assert abs(slope - expected) < 4 * error, name
        assert abs(slope) > 4 * error, name  # control: another sign, or no effect, would be seen
    # Young's modulus of the contact enters with E / (1 - ν²), that of the beam alone with the power 1/4.
    (modulus, own), (ratio, error) = slopes["Young's modulus"], slopes["Poisson's ratio"]
    power = 2 * RATIO / (1 - RATIO**2)
    assert abs(ratio - power * (modulus - 0.25)) < 4 * np.hypot(error, power * own)
    assert slopes["Hamaker constant"][0] < 0 < ratio < power * modulus


@pytest.mark.slow
def test_a_contact_angle_of_20_degrees_costs_a_quarter_of_the_energy_and_one_of_40_two_thirds(base):
    energies = [
        curves.energies(base, 0.67, replace(WATER, contact_angles=(np.radians(angle),) * 2)) for angle in (0, 20, 40)
    ]
    perfect = energies[0].mean()
    for wetted, loss in zip(energies[1:], (-0.23, -0.70), strict=True):
        ratio = wetted.mean() / perfect
        error = (wetted - ratio * energies[0]).std() / perfect / np.sqrt(len(wetted))
        assert abs(ratio - 1 - loss) < 4 * error + 0.005  # rounded


@pytest.mark.slow
@pytest.mark.parametrize(("humidity", "added", "expected"), [(0.44, 0.50, 632 / 894), (0.67, 0.63, 551 / 684)])
def test_adsorbed_films_shorten_lengths_as_in_an_independent_study_of_energies(humidity, added, expected, base):
    # Films of van der Waals forces of 10 zJ, 3 t: lengths with them over those without, by the power -1/4 of energies.
    films = (replace(WATER, adsorbed=add * 1e-9) for add in (added, 0.0))
    energies = np.transpose([curves.energies(base, humidity, water) for water in films])
    ratio, error = jackknife(lambda means: (means[..., 0] / means[..., 1]) ** -0.25, energies)
    assert abs(ratio - expected) < 4 * error
    assert abs(ratio - 1) > 40 * error  # control
