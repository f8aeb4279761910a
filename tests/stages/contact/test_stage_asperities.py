from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import small
from numpy.testing import assert_allclose, assert_array_equal
from plans import job_settings

from stiction.config.merging import merged
from stiction.contact.environment import Gaps
from stiction.plan.graph import Results
from stiction.plan.plan import Plan
from stiction.stages.contact import asperities, curves, full_contact

HUMIDITIES = small.PLAN.config["pairs"]["b"]["humidities"]


@cache
def study():
    return Results.of(small.PLAN.config)["studies/asperities/b"]


def readings():
    return {(of["reading"], of["attraction"], of["spacing"]): e for of, e in asperities.energies_of_readings(study())}


@pytest.mark.slow
def test_the_first_reading_is_that_of_the_contact_and_of_full_contact():
    """All three are the same strips, drawn with the same random numbers."""
    (labels, found), *_ = asperities.energies_of_readings(study())
    assert labels == {"reading": "summit", "attraction": "water", "spacing": 1e-8}
    water = small.settings_of(full_contact, job_settings(small.PLAN, "studies/full_contact/b")).water
    for k, humidity in enumerate(HUMIDITIES):
        expected = curves.energies(small.contact_of_pair(), humidity, water)[: len(found)]
        assert_allclose(found[:, k], expected, rtol=1e-5)  # the contact is stored in single precision
        assert not np.allclose(expected, np.roll(expected, 1), rtol=1e-2)


def test_every_reading_is_computed_and_islands_of_true_shape_on_the_grid_of_the_contact():
    found = readings()
    spheres = {
        (reading, medium, h)
        for reading in ("summit", "island", "fitted")
        for medium in ("water", "none")
        for h in (1e-8, 5e-9)
    }
    assert set(found) == spheres | {("shape", "water", 1e-8), ("shape", "none", 1e-8)}
    for (reading, *_), energies in found.items():
        assert energies.shape == (2 if reading == "shape" else 3, len(HUMIDITIES))
        assert np.all(energies > 0)


def test_attraction_of_the_solids_adds_adhesion_under_every_reading():
    found = readings()
    for (reading, medium, spacing), energies in found.items():
        if medium == "water":
            assert np.all(energies > found[reading, "none", spacing])


def test_readings_agree_as_the_water_floods_everything():
    found = readings()
    base = found["summit", "water", 1e-8]
    for energies in found.values():
        apart = np.abs(energies.mean(axis=0) / base[: len(energies)].mean(axis=0) - 1)
        assert apart[-1] < 0.05
        assert apart[-1] <= apart[0]


def test_the_cost_is_that_of_the_first_reading():
    assert asperities.cost(study(), 1e-8, "summit", "water") == 1
    assert asperities.cost(study(), 1e-8, "shape", "none") > 0


def test_without_attraction_nothing_is_compared_twice():
    plain = job_settings(Plan(small.PLAN.config | {"van_der_waals": "none"}), "studies/asperities/b")["study"]
    settings = small.settings_of(asperities, plain)
    assert settings.attractions == ("none",)


def test_attraction_across_gaps_is_refused():
    settings = small.settings_of(asperities, job_settings(small.PLAN, "studies/asperities/b")["study"])
    water = replace(settings.water, gaps=Gaps({"water": 1e-20, "dry": 1e-19}, "water"))
    with pytest.raises(ValueError, match=r"attraction\.reach: touching"):
        asperities.compute([], "b", 1, replace(settings, water=water))


def test_no_more_islands_have_their_shape_than_there_are_strips():
    few = small.PLAN.config | {"studies": small.PLAN.config["studies"] | {"asperities": {"samples": 3, "shapes": 20}}}
    assert job_settings(Plan(few), "studies/asperities/b")["study"]["shapes"] == 3


@pytest.mark.parametrize(
    ("change", "same"),
    [
        ({"studies": {"variants": {"samples": 50}}}, True),
        ({"contact": {"samples": 30}}, True),
        ({"beam": {"samples": 5}}, True),
        ({"studies": {"asperities": {"shapes": 3}}}, False),
        ({"solid": {"young_modulus_GPa": 160}}, False),
        ({"water": {"temperature_K": 301}}, False),
        ({"surfaces": {"B2": {"rms_nm": 3.2}}}, False),
        ({"contact": {"distance_step_nm": 0.1}}, False),
    ],
)
def test_the_settings_are_what_the_energies_depend_on(change, same):
    job = "studies/asperities/b"
    assert (job_settings(Plan(merged(small.PLAN.config, change)), job) == job_settings(small.PLAN, job)) == same


def test_the_dataset_has_humidities_and_spacings():
    assert_array_equal(study().humidity, HUMIDITIES)
    assert_allclose(study().spacing, [1e-8, 5e-9])
