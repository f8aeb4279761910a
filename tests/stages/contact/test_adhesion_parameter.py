"""Adhesion parameter of pairs: against numbers by hand, only from stated summits, and in the air of a pair."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import stiction
from stiction.config.merging import merged
from stiction.constants import HAMAKER_CONSTANT, MOLECULAR_DISTANCE
from stiction.plan.plan import Plan
from stiction.stages.contact.adhesion_parameter import adhesion_parameters, summits

CONFIG = stiction.load()
#: D₀ of Eq. (10), and the modulus E' of the paper's polysilicon.
D0, MODULUS = (2 / 15) ** (1 / 6) * MOLECULAR_DISTANCE, 164e9 / (2 * (1 - 0.23**2))


def of(config, pair, *humidities, of_devices=False):
    """Adhesion parameters of a pair."""
    plan = Plan(config)
    return adhesion_parameters(plan, plan.air_of_devices if of_devices else plan.air, pair, humidities)


@pytest.mark.parametrize(
    ("pair", "rms", "radius"), [("a", (1.7, 0.17), 0.41), ("b", (3.4, 0.17), 0.84), ("c", (1.7, 5.5), 0.12)]
)
def test_parameters_of_the_paper_are_those_of_their_measured_summits(pair, rms, radius):
    sigma = 1e-9 * np.hypot(*rms)
    work = 2 * 0.072 + HAMAKER_CONSTANT["water"] / (16 * np.pi * D0**2)
    found = of(CONFIG, pair, 0.45)
    assert_allclose(found[0.45], MODULUS / work * np.sqrt(sigma**3 / (1e-6 * radius)), rtol=1e-4)
    dry = of(CONFIG, pair, 0.0, of_devices=True)[0.0]
    assert_allclose(dry / found[0.45], work / (HAMAKER_CONSTANT["dry"] / (16 * np.pi * D0**2)), rtol=0.05)  # retarded
    assert dry > 1.2 * found[0.45]  # control: air counts


def test_bodies_count_by_their_modulus():
    soft = merged(
        CONFIG, {"materials": {"Soft": {"young_modulus_GPa": 41}}, "surfaces": {"Sub1": {"material": "Soft"}}}
    )
    assert_allclose(of(soft, "b", 0.5)[0.5] / of(CONFIG, "b", 0.5)[0.5], 2 / (1 + 164 / 41), rtol=1e-6)


def test_surfaces_without_stated_summits_and_copies_have_none():
    described = {"rms_nm": 3.4, "hurst": 0.8, "correlation_length_nm": 100, "cutoff_rad_per_um": 138, "like": "B2"}
    other = stiction.load(
        {
            "surfaces": {"Mine": described},
            "pairs": {"mine": {"beam": "Mine", "substrate": "Sub1", "gap_um": 2, "humidities": [0.5]}},
            "run": {"pairs": ["mine"], "studies": []},
        }
    )
    assert of(other, "mine", 0.5) == {}
    copied = merged(CONFIG, {"pairs": {"b": {"replica": {"coherence": 0.05}}}})
    assert summits(Plan(copied), "b") is None
    assert summits(Plan(CONFIG), "b") is not None
