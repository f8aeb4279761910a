"""Air by its dew point: the humidity at the temperature of the water, refused where water condenses."""

import pytest
import yaml
from configurations import problems

import stiction
from stiction.config.files import joined

STUDY = {
    "run": {"pairs": [], "studies": []},
    "pairs": {"mine": {"beam": "B2", "substrate": "Sub1", "gap_um": 20, "humidities": [{"dew_point_C": 10}]}},
    "devices": {
        "S": {"kind": "stopper", "pair": "mine", "contact_um": [3, 3], "restoring_force_uN": 5,
              "humidities": ["dry", {"dew_point_C": 10}]},
    },
}  # fmt: skip


def at(celsius, dew_point=10):
    """The study in air of a temperature and a dew point [°C]."""
    text = yaml.safe_dump(STUDY | {"water": {"temperature_K": celsius + 273.15}})
    return joined(yaml.safe_load(text.replace("dew_point_C: 10", f"dew_point_C: {dew_point}")))


@pytest.mark.parametrize(("celsius", "humidity"), [(25, 0.39), (12, 0.88), (15, 0.72)])
def test_a_dew_point_of_ten_degrees_is_the_humidity_of_tables(celsius, humidity):
    """Humidities read from a psychrometric chart."""
    config = stiction.config.validation.checked(at(celsius)).config
    for found in (config["pairs"]["mine"]["humidities"][0], config["devices"]["S"]["humidities"][1]):
        assert found == pytest.approx(humidity, abs=0.01)
        assert found == round(found, 4)
    assert config["devices"]["S"]["humidities"][0] == 0


@pytest.mark.parametrize("celsius", [0, 5, 9.9, 10])
def test_below_the_dew_point_water_condenses(celsius):
    (line,) = problems(at(celsius))
    assert line.startswith(
        "pairs.mine.humidities[0] is {'dew_point_C': 10}, must be below the temperature of the water, "
    )
    assert "which is not in the model, and unsafe" in line
    assert line.endswith(f"(given water.temperature_K = {celsius + 273.15:g})")


@pytest.mark.parametrize(("celsius", "dew_point"), [(85, 10), (25, -60), (25, -300)])
def test_air_far_above_its_dew_point_is_too_dry_for_a_film_but_not_dry(celsius, dew_point):
    lines = problems(at(celsius, dew_point))
    assert any(
        "humidities is [" in line and "the film between the surfaces is thinner than 1" in line for line in lines
    )


@pytest.mark.parametrize("wrong", ["ten", True, None, [10]])
def test_a_dew_point_that_is_no_number_is_refused(wrong):
    study = {"pairs": {"b": {"humidities": [{"dew_point_C": wrong}]}}}
    (line,) = problems(joined(study))
    assert line.startswith("pairs.b.humidities[0] is {'dew_point_C': ")


@pytest.mark.parametrize("kelvin", [1, 5, 25, 272.9, 1e9])
def test_a_temperature_of_no_liquid_is_refused_alone(kelvin):
    (line,) = problems(at(kelvin - 273.15))
    assert line.startswith("water.temperature_K is ")


@pytest.mark.parametrize("dew_point", [100, 374, 500, 1e6])
def test_a_dew_point_above_the_critical_one_condenses(dew_point):
    (line,) = problems(at(25, dew_point))
    assert "water condenses on colder surfaces" in line


def test_a_dew_point_is_no_uncertainty_of_a_humidity():
    study = {"devices": {"S": STUDY["devices"]["S"] | {"uncertainty": {"humidity": {"dew_point_C": 2}}}}}
    lines = problems(joined(STUDY | study))
    assert any(
        line.startswith("devices.S.uncertainty.humidity is {'dew_point_C': 2}, must be a number") for line in lines
    )
