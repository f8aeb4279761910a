"""Lengths on strips that repeat laws, beside those on strips cut from fields of many strips.

The fields have long waves, which raise or lower whole strips, and short ones, whose summits touch.
"""

from functools import cache, partial
from types import SimpleNamespace

import numpy as np
import pytest
from published import SURFACES

from stiction.beam.middle import outwards
from stiction.contact import forcelaw
from stiction.contact.asperity import MaugisTable, reduced_modulus
from stiction.contact.environment import Water
from stiction.contact.pair import SurfacePair
from stiction.contact.vanderwaals import attraction
from stiction.devices import strips
from stiction.stages.contact import contact, curves
from stiction.stages.devices import opening
from stiction.stages.devices.opening import DesignedBeam
from stiction.surface.field import RoughSurface, StripGrid
from stiction.surface.maxent import GAUSSIAN
from stiction.surface.neighbours import mean_height_correlations
from stiction.surface.spectrum import CutoffSelfAffine
from stiction.surface.translation import Translation

UM = 1e-6
LONG = CutoffSelfAffine(1e-32, 1e-32 * 60**-3.3, 1e6, 60e6)
RMS, FIELD, FIELDS = 3e-9, 60 * UM, 40
C1 = DesignedBeam("cantilever", "long", 3 * UM, 10 * UM, 6 * UM, 164e9, 1.5 * UM)
R1 = DesignedBeam("bridge", "long", 2 * UM, 2 * UM, 20 * UM, 164e9, 0.5 * UM, residual_stress=50e6)
WATER = MaugisTable(reduced_modulus(164e9, 0.23), attraction("water"))


@cache
def laws(device):
    """Force laws of the strips of wide fields (fields, strips, 4).

    A strip without a law, 1 or 2 in 100, has that of the strip before it, which correlates neighbours a little more.
    """
    number, grid = round(FIELD / device.strip), StripGrid(FIELD, device.width, 20e-9, margin=9 * UM)
    rough = RoughSurface(LONG, Translation(GAUSSIAN), RMS, grid)
    pair = SurfacePair(rough, SURFACES["B2"].on(grid), 0.05e-9, asperity=WATER)
    fields = (pair.draw(*(np.random.default_rng([side, k]) for side in (1, 2))) for k in range(FIELDS))
    parts = [np.ascontiguousarray(part) for field in fields for part in np.split(field, number)]
    solid, bearing = map(np.array, zip(*map(pair.contact, parts), strict=True))
    drawn = contact.layout(solid, bearing, pair.distances, range(FIELDS * number))
    vectors, limit = curves.vectors(drawn, 0.7, Water(300.0))
    good = forcelaw.admissible(vectors, limit)
    assert good.mean() > 0.95
    before = np.maximum.accumulate(np.where(good, np.arange(len(good)), 0))
    return forcelaw.coefficients(vectors[before], limit).reshape(FIELDS, number, 4)


def correlations(device):
    """Correlations of the mean heights of the strips."""
    b2 = SURFACES["B2"]
    return mean_height_correlations([(LONG, RMS), (b2.spectrum, b2.rms)], (device.strip, device.width), 16)


def fields_in_row(device, number, rng):
    """Strips in a row, from one field after the other, in the order of a device (number, 4)."""
    fields = laws(device)
    cut = int(rng.integers(fields.shape[1]))
    drawn = fields[rng.integers(FIELDS, size=-(-(number + cut) // fields.shape[1]))]
    along = drawn.reshape(-1, 4)[cut : cut + number]
    return along if device.opening.arms == 1 else along[np.argsort(outwards(number))]


def lengths(device, draw, beams=400):
    """Lengths at which devices stick (beams,) [m]."""
    settings = SimpleNamespace(seed=7, device=device)
    ground = opening.ground_of(device, laws(device).reshape(-1, 4))
    return opening.arrests(device, ground, draw, beams, opening.addresses(settings))


def of_neighbours(values):
    """Correlation of neighbouring strips of all fields (fields, strips), and its standard error."""
    from_mean = values - values.mean()
    products = np.mean(from_mean[:, 1:] * from_mean[:, :-1], axis=1) / np.mean(from_mean**2)
    return products.mean(), products.std() / len(products) ** 0.5


@pytest.mark.slow
@pytest.mark.parametrize("device", [C1, R1], ids=lambda one: one.kind)
def test_adhesion_of_neighbours_is_correlated_less_than_their_mean_heights(device):
    found = laws(device)
    energy, largest, distance = forcelaw.energy(found), found[..., 0], found[..., 1]
    works = energy - largest.mean() * (distance - distance.mean())
    for values in (energy, largest, distance, works):
        correlation, error = of_neighbours(values)
        assert correlation + 4 * error < correlations(device)[0]
    correlation, error = of_neighbours(works)
    assert correlation > 4 * error  # long waves do correlate neighbours


@pytest.mark.slow
@pytest.mark.parametrize(("device", "least"), [(C1, 0.9), (R1, 0.75)], ids=["cantilever", "bridge"])
def test_lengths_on_repeated_laws_are_at_most_those_on_fields_and_lengths_on_independent_strips_are_longer(
    device, least
):
    independent = partial(strips.resampled, laws(device).reshape(-1, 4))
    repeated = strips.in_row(independent, strips.repetition(correlations(device)), device.opening.arms)
    draws = partial(fields_in_row, device), repeated, independent
    real, with_repetition, without = (lengths(device, draw) for draw in draws)
    for share in (0.1, 0.25, 0.5):
        of_real, of_repeated, of_independent = (np.quantile(of, share) for of in (real, with_repetition, without))
        assert of_repeated < 1.01 * of_real
        assert of_independent > 1.02 * of_real
    assert np.median(with_repetition) > least * np.median(real)
