from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import small
from numpy.testing import assert_array_equal
from plans import job_settings

from stiction.contact.materials import Solid
from stiction.stages.contact import full_contact, pressing

SETTINGS = small.settings_of(pressing, job_settings(small.PLAN, "studies/pressing/b"))


@cache
def study(gigapascals, **changed):
    solid = Solid(hardness=1e9 * gigapascals)
    smaller = {"strips": 1, "humidities": (0.44, 0.92), "materials": dict.fromkeys(("beam", "substrate"), solid)}
    settings = replace(SETTINGS, **smaller | changed)
    return pressing.compute(small.surfaces(), "b", settings)


def test_settings_are_those_of_full_contact_with_a_distance():
    assert SETTINGS.humidities == (0.44, 0.67, 0.92)
    assert (SETTINGS.strips, SETTINGS.steps, SETTINGS.distance) == (2, 2, 4e-9)


def test_fresh_strips_have_the_energies_of_full_contact():
    plain = small.settings_of(full_contact, job_settings(small.PLAN, "studies/full_contact/b"))
    expected = full_contact.compute(small.surfaces(), "b", replace(plain, strips=1, humidities=(0.44, 0.92)))
    assert_array_equal(study(1000.0).fresh_energy, expected.adhesion_energy)


def test_without_yield_pressing_changes_nothing():
    hard = study(1000.0)
    assert not hard.hardness_share.any()
    assert_array_equal(hard.adhered_energy, hard.fresh_energy)
    for step in range(SETTINGS.steps):
        assert_array_equal(hard.pressed_energy[:, step], hard.fresh_energy)


def test_the_harder_surfaces_are_pressed_the_more_they_are_flattened_and_stick():
    soft = study(2.0)
    for growing in (soft.pressure, soft.contact_share, soft.flattening, -soft.separation):
        assert np.all(growing.diff("step") > 0)
    assert soft.separation[0, -1] == pytest.approx(SETTINGS.distance)
    in_dry_air = soft.pressed_energy.mean("strip").isel(humidity=0)
    assert in_dry_air[-1] > 1.02 * soft.fresh_energy.mean("strip")[0]


def test_a_film_that_floods_everything_does_not_feel_the_flattening():
    soft = study(2.0)
    ratio = soft.pressed_energy.isel(step=-1).mean("strip") / soft.fresh_energy.mean("strip")
    assert abs(ratio[-1] - 1) < 0.1 * abs(ratio[0] - 1)


def test_surfaces_that_rest_closer_than_they_are_to_be_pressed_are_refused():
    with pytest.raises(ValueError, match=r"studies\.pressing\.distance_nm: the surfaces rest .* nm apart"):
        study(1000.0, distance=9e-9)
