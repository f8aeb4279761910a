import pytest

from stiction.config.units import si


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
    ],
)
def test_a_key_gives_its_unit_away(key, value, name, expected):
    assert si({key: value}) == {name: pytest.approx(expected, rel=1e-15)}


def test_numbers_without_unit_stay_as_they_are():
    assert si({"samples": 5000, "kurtosis": 3.1, "psd": "published"}) == {
        "samples": 5000,
        "kurtosis": 3.1,
        "psd": "published",
    }
