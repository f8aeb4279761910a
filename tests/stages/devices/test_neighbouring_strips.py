"""Lengths on strips that repeat laws, beside those on strips cut from fields of many strips.

The fields have long waves, which raise or lower whole strips, and short ones, whose summits touch.
"""

from functools import cache, partial
from types import SimpleNamespace

import numpy as np
import pytest
from published import SURFACES

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
RMS, SIDES, FIELDS, STRIPS = 3e-9, (1.5 * UM, 6 * UM), 80, 40
C1 = DesignedBeam("cantilever", "long", 3 * UM, 10 * UM, SIDES[1], 164e9, SIDES[0])
WATER = MaugisTable(reduced_modulus(164e9, 0.23), attraction("water"))


@cache
def laws():
    """Force laws of the strips of wide fields (fields, strips, 4)."""
    grid = StripGrid(STRIPS * SIDES[0], SIDES[1], 20e-9, margin=9 * UM)
    rough = RoughSurface(LONG, Translation(GAUSSIAN), RMS, grid)
    pair = SurfacePair(rough, SURFACES["B2"].on(grid), 0.05e-9, asperity=WATER)
    fields = (pair.draw(*(np.random.default_rng([side, k]) for side in (1, 2))) for k in range(FIELDS))
    parts = [np.ascontiguousarray(part) for field in fields for part in np.split(field, STRIPS)]
    solid, bearing = map(np.array, zip(*map(pair.contact, parts), strict=True))
    drawn = contact.layout(solid, bearing, pair.distances, range(FIELDS * STRIPS))
    vectors, limit = curves.vectors(drawn, 0.7, Water(300.0))
    good = forcelaw.admissible(vectors, limit)
    assert good.mean() > 0.98
    vectors[~good] = np.median(vectors[good], axis=0)
    return forcelaw.coefficients(vectors, limit).reshape(FIELDS, STRIPS, 4)


def correlations():
    """Correlations of the mean heights of the strips."""
    b2 = SURFACES["B2"]
    return mean_height_correlations([(LONG, RMS), (b2.spectrum, b2.rms)], SIDES, 6)


def fields_in_row(number, rng):
    """Strips in a row, from one field after the other (number, 4)."""
    cut = int(rng.integers(STRIPS))
    drawn = laws()[rng.integers(FIELDS, size=-(-(number + cut) // STRIPS))]
    return drawn.reshape(-1, 4)[cut : cut + number]


def lengths(draw, beams=400):
    """Sticking lengths along beams (beams,) [m]."""
    settings = SimpleNamespace(seed=7, device=C1)
    ground = opening.ground_of(C1, laws().reshape(-1, 4))
    return opening.arrests(C1, ground, draw, beams, opening.addresses(settings))


def of_neighbours(values):
    """Correlation of neighbouring strips of all fields (fields, strips), and its standard error."""
    from_mean = values - values.mean()
    products = np.mean(from_mean[:, 1:] * from_mean[:, :-1], axis=1) / np.mean(from_mean**2)
    return products.mean(), products.std() / len(products) ** 0.5


@pytest.mark.slow
def test_adhesion_of_neighbours_is_correlated_less_than_their_mean_heights():
    found = laws()
    energy, largest, distance = forcelaw.energy(found), found[..., 0], found[..., 1]
    works = energy - largest.mean() * (distance - distance.mean())
    for values in (energy, largest, distance, works):
        correlation, error = of_neighbours(values)
        assert correlation + 4 * error < correlations()[0]
    correlation, error = of_neighbours(works)
    assert correlation > 4 * error  # long waves do correlate neighbours


@pytest.mark.slow
def test_lengths_on_repeated_laws_are_at_most_those_on_fields_and_lengths_on_independent_strips_are_longer():
    independent = partial(strips.resampled, laws().reshape(-1, 4))
    repeated = strips.in_row(independent, strips.repetition(correlations()), C1.opening.arms)
    real, with_repetition, without = map(lengths, (fields_in_row, repeated, independent))
    for share in (0.1, 0.25, 0.5):
        of_real, of_repeated, of_independent = (np.quantile(of, share) for of in (real, with_repetition, without))
        assert of_repeated < 1.01 * of_real
        assert of_independent > 1.02 * of_real
    assert np.median(with_repetition) > 0.9 * np.median(real)
