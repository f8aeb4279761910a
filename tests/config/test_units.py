import math
from dataclasses import FrozenInstanceError, dataclass

import numpy as np
import pytest

from stiction.config.units import from_si, in_si, to_si


@dataclass(frozen=True)
class Anything:
    rms: float | None = None
    gap: float | None = None
    plateau: float | None = None
    corner: float | None = None
    summit_density: float | None = None
    young_modulus: float | None = None
    temperature: float | None = None
    contact_angle: float | None = None
    restoring_force: float | None = None
    hamaker_constant: dict | None = None
    elements: tuple[float, ...] = ()
    samples: int | None = None
    psd: str | None = None


@dataclass(frozen=True)
class Inner:
    spacing: float


@dataclass(frozen=True)
class Outer:
    sampling: Inner
    pairs: dict[str, Inner]
    psd: Inner | str


@pytest.mark.parametrize(
    ("key", "value", "name", "expected"),
    [
        ("rms_nm", 1.7, "rms", 1.7e-9),
        ("gap_um", 20, "gap", 20e-6),
        ("plateau_nm4", 525, "plateau", 525e-36),
        ("corner_rad_per_um", 32, "corner", 32e6),
        ("summit_density_per_um2", 68, "summit_density", 68e12),
        ("young_modulus_GPa", 164, "young_modulus", 164e9),
        ("temperature_K", 300, "temperature", 300.0),
        ("young_modulus_MPa", 50, "young_modulus", 50e6),
        ("restoring_force_uN", 20, "restoring_force", 20e-6),
        ("contact_angle_deg", 90, "contact_angle", 1.5707963267948966),
        (
            "hamaker_constant_zJ",
            {"water": 97.5, "dry": 186.5},
            "hamaker_constant",
            {"water": 9.75e-20, "dry": 1.865e-19},
        ),
    ],
)
def test_a_value_is_converted_by_the_unit_of_its_key(key, value, name, expected):
    assert getattr(in_si(Anything, {key: value}), name) == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize(
    ("value", "unit", "expected"),
    [(3e-9, "nm", 3), (164e9, "GPa", 164), (5.25e-34, "nm4", 525), (math.pi, "deg", 180), (300.0, "K", 300)],
)
def test_a_value_is_stated_in_a_unit_and_back_in_si(value, unit, expected):
    assert from_si(value, unit) == pytest.approx(expected, rel=1e-15)
    assert to_si(expected, unit) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(("unit", "factor"), [("nm", 1e9), ("zJ", 1e21)])
def test_factors_from_si_are_exact_where_one_over_a_factor_to_si_is_not(unit, factor):
    assert from_si(1.0, unit) == factor != 1 / to_si(1.0, unit)


def test_arrays_are_converted_element_by_element():
    np.testing.assert_array_equal(from_si(to_si(np.array([1.0, 2.0]), "um"), "um"), [1.0, 2.0])


def test_values_without_unit_stay_as_they_are_and_lists_become_tuples():
    found = in_si(Anything, {"samples": 5000, "psd": "published", "elements_um": [30, 7.5]})
    assert (found.samples, found.psd) == (5000, "published")
    assert found.elements == pytest.approx((30e-6, 7.5e-6), rel=1e-15)
    with pytest.raises(FrozenInstanceError):
        found.samples = 1


@pytest.mark.parametrize("psd", ["identified", {"spacing_nm": 3}])
def test_sections_inside_become_objects_of_their_fields(psd):
    plain = {"sampling": {"spacing_nm": 10}, "pairs": {"a": {"spacing_nm": 5}, "b": {"spacing_nm": 20}}, "psd": psd}
    found = in_si(Outer, plain)
    assert found.sampling == Inner(10e-9)
    assert found.pairs == {"a": Inner(5e-9), "b": Inner(20e-9)}
    assert found.psd == (Inner(3 * 1e-9) if isinstance(psd, dict) else psd)


@pytest.mark.parametrize("section", [{}, {"spacing_nm": 1, "margin_um": 2}])
def test_a_missing_or_an_unknown_key_is_rejected(section):
    with pytest.raises(TypeError, match=r"spacing|margin"):
        in_si(Inner, section)
