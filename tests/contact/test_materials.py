"""Properties of materials: their table and the solid body, steps of their slopes, and what limits and slopes take."""

from dataclasses import fields

import numpy as np
import pytest
from numpy.testing import assert_allclose

from stiction.config.units import without_unit
from stiction.contact.materials import ELASTIC, OF_COATINGS, PROPERTIES, InputStep, Solid


@pytest.mark.parametrize("value", [0.3, 1e-19, 164e9])
def test_ends_of_a_relative_step_differ_by_it_in_their_logarithm(value):
    step = InputStep(0.2)
    less, more = step.ends(value)
    assert_allclose([less / value, more / value], [0.8, 1.2], rtol=1e-12)
    assert_allclose(step.difference, np.log(more / less), rtol=1e-12)


@pytest.mark.parametrize("value", [0.23, 0, -0.3])
def test_ends_of_an_absolute_step_differ_by_it_where_the_value_is_zero_too(value):
    step = InputStep(0.05, relative=False)
    less, more = step.ends(value)
    assert_allclose([less, more], [value - 0.05, value + 0.05], rtol=1e-12, atol=1e-15)
    assert_allclose(step.difference, more - less, rtol=1e-12)


def test_contact_depends_on_elasticity_and_attraction_and_neither_on_hardness_nor_on_water():
    assert ("young_modulus_GPa", "poisson_ratio", "hamaker_constant_zJ", *OF_COATINGS) == ELASTIC


def test_a_property_named_after_someone_has_no_article():
    assert [one.group for one in PROPERTIES.values()][:3] == ["Young's modulus", "Poisson's ratio", "the hardness"]


def test_a_solid_has_the_properties_of_the_table_and_no_other():
    keys = [*(entry.key for entry in PROPERTIES.values()), *OF_COATINGS]
    assert [field.name for field in fields(Solid)] == list(map(without_unit, keys))
