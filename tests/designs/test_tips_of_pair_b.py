"""Tips of pair b: adhesion energy of short strips, and lengths that tips hold from few tips against those of many."""

from functools import cache

import numpy as np
import pytest

from stiction.config import jobs
from stiction.config.files import load
from stiction.config.plan import Plan
from stiction.config.units import typed
from stiction.contact.meniscus import flooded_energy, meniscus_height
from stiction.designs.releases import DesignedBeam
from stiction.devices import arcs, risk
from stiction.stages import contact, curves
from stiction.streams import stream
from stiction.study import surface_datasets

WATER = curves.Water(300.0)
#: Mean adhesion energies [J m⁻²] and coefficients of variation at RH 0.44 and 0.67 by the length of the strips [µm], of
#: the first 800 samples. Those of 10 000 strips of 0.15 µm are 3.45 ± 0.03 and 8.06 ± 0.04 mJ/m², 1.5 standard errors
#: of 800 samples below.
STATED = {
    1.5: ((1.69e-3, 0.45), (6.14e-3, 0.24)),
    0.5: ((2.17e-3, 0.58), (6.73e-3, 0.36)),
    0.15: ((3.58e-3, 0.74), (8.33e-3, 0.50)),
}
SAMPLES = 800
#: Lengths of beams of the paper [m] that the tips of one in a thousand and of one in ten thousand hold, with the ends
#: of their 95 % interval: order statistics of 200 000 strips of 0.05 µm, by humidity.
BRUTE_FORCE = {
    0.44: {1e-3: (290.8e-6, 288.9e-6, 292.5e-6), 1e-4: (264.6e-6, 257.7e-6, 266.8e-6)},
    0.67: {1e-3: (299.1e-6, 297.9e-6, 300.1e-6), 1e-4: (279.5e-6, 275.3e-6, 282.3e-6)},
    0.92: {1e-3: (254.3e-6, 254.0e-6, 254.5e-6), 1e-4: (250.6e-6, 249.5e-6, 251.3e-6)},
}


@cache
def strips(length_um, number):
    """Contact of strips of pair b of this length, 30 µm wide."""
    plan = Plan(load({"design": {"beams": number}}))
    surfaces = [surface_datasets(plan, name) for name in plan.sides("b")]
    plain = jobs.tip_contact(plan, "b", round(1000 * length_um), 30000)
    return contact.compute(surfaces, "b", "NG", typed(contact.Settings, plain))


@pytest.mark.slow
def test_shorter_strips_hold_more_and_scatter_more():
    means = []
    for length, stated in STATED.items():
        for humidity, (mean, variation) in zip((0.44, 0.67), stated, strict=True):
            energies = curves.energies(strips(length, 300), humidity, WATER)
            error = energies.std() * np.sqrt(1 / len(energies) + 1 / SAMPLES)
            assert abs(energies.mean() - mean) < 4 * error
            assert abs(energies.std() / energies.mean() / variation - 1) < 4 * np.sqrt(1 / 600 + 1 / 1600) + 0.1
            means.append((energies.mean(), error))
    values, errors = np.reshape(means, (3, 2, 2)).transpose(2, 1, 0)
    assert np.all(np.diff(values) > 3 * errors[:, :-1])  # control


def test_tips_hold_less_than_saturated_air_and_lose_what_the_solids_keep_from_the_water():
    # The solids keep the mean planes at a distance d0, so that e = 2γ (1 - d0 / h_C) for a film much higher than d0.
    tips, limit = strips(0.05, 200), flooded_energy(WATER.temperature)
    for humidity in (0.44, 0.67, 0.92):
        assert curves.tip_energies(tips, humidity, WATER).max() < limit

    def kept_apart(humidity, factor=1):
        energy = factor * curves.tip_energies(tips, humidity, WATER).mean()
        return (1 - energy / limit) * meniscus_height(humidity, WATER.temperature)

    high = tips.height.values[np.argmin(tips.bearing_area.values.mean(axis=0) > 0)]  # of the highest summits
    assert 0 < kept_apart(0.99) < high
    assert kept_apart(0.99) == pytest.approx(kept_apart(0.97), rel=0.1)
    for factor in (0.5, 2):  # control
        assert kept_apart(0.99, factor) != pytest.approx(kept_apart(0.97, factor), rel=0.5)


@pytest.mark.slow
@pytest.mark.parametrize("humidity", BRUTE_FORCE)
def test_a_few_thousand_tips_find_the_lengths_of_200_000(humidity):
    beam = DesignedBeam("cantilever", "b", 2.6e-6, 20e-6, 30e-6, 164e9, 1.5e-6).beam
    lengths = arcs.arc_length(curves.tip_energies(strips(0.05, 2900), humidity, WATER), beam)
    for share, (length, low, high) in BRUTE_FORCE[humidity].items():
        found = risk.safe_length(lengths, share, stream(0))
        assert found.basis is risk.Basis.FITTED
        error = np.hypot(found.error, (high - low) / (2 * 1.96))
        assert abs(found.estimate - length) < 3 * error
        assert abs(np.quantile(lengths, 0.05) - length) > 3 * error  # control
        assert found.length < high
