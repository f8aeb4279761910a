"""Contact of a pair in chunks: the same numbers as in one piece, and no sample is lost or taken twice."""

from dataclasses import replace

import numpy as np
import pytest
import small
import xarray as xr
from numpy.testing import assert_allclose, assert_array_equal
from plans import job_settings
from scipy.stats import norm

from stiction.constants import HAMAKER_CONSTANT
from stiction.contact.environment import Gaps, Water
from stiction.contact.materials import Solid
from stiction.contact.pair import DistanceGrid
from stiction.models import SIDES
from stiction.stages.contact import contact
from stiction.stages.contact.curves import energies

SETTINGS = small.settings_of(contact, job_settings(small.PLAN, "contact/b_NG"))
SAMPLES = SETTINGS.contact.samples
FEW = replace(SETTINGS, contact=replace(SETTINGS.contact, samples=4))


def part(samples):
    """Contact of some samples of the small pair."""
    return contact.compute(small.surfaces(), "b", "NG", SETTINGS, samples)


@pytest.mark.parametrize(("samples", "chunks"), [(20, 3), (5, 5), (7, 1), (5000, 12)])
def test_chunks_contain_every_sample_once_in_order_and_are_nearly_equal(samples, chunks):
    found = [contact.chunk(samples, number, chunks) for number in range(chunks)]
    assert [k for chunk in found for k in chunk] == list(range(samples))
    assert max(map(len, found)) - min(map(len, found)) <= 1


def test_samples_do_not_depend_on_the_chunks():
    chunks = [part(contact.chunk(SAMPLES, number, 3)) for number in range(3)]
    xr.testing.assert_identical(contact.join_chunks(iter(chunks), SETTINGS), small.contact_of_pair())


def test_chunks_that_are_missing_repeated_or_of_other_distances_are_refused():
    first, second = (part(contact.chunk(4, number, 2)) for number in range(2))
    with pytest.raises(ValueError, match="the chunk after 2 of 4 samples does not continue the contact"):
        contact.join_chunks([first, first], FEW)
    with pytest.raises(ValueError, match="the chunk after 0 of 4 samples does not continue the contact"):
        contact.join_chunks([second, first], FEW)
    with pytest.raises(ValueError, match="the chunks contain 2 of 4 samples"):
        contact.join_chunks([first], FEW)
    shifted = second.isel(height=slice(1, None))
    with pytest.raises(ValueError, match="the chunk after 2 of 4 samples does not continue the contact"):
        contact.join_chunks([first, shifted], FEW)


def test_the_first_samples_are_those_computed_alone():
    xr.testing.assert_identical(contact.first(small.contact_of_pair(), 2), part(range(2)))


def test_summits_adhere_less_with_thicker_coatings_and_a_coating_without_thickness_changes_no_bit():
    def coated(thickness):
        both = {side: Solid(164e9, 0.23, coating=thickness) for side in SIDES}
        return contact.compute(small.surfaces(), "b", "NG", replace(SETTINGS, materials=both), range(2))

    xr.testing.assert_identical(coated(0.0), part(range(2)))
    pulls = [-coated(thickness).solid_pressure.min("distance").values for thickness in (0.0, 0.2e-9, 0.6e-9, 1.2e-9)]
    assert np.all(np.diff(pulls, axis=0) < 0)
    water = Water(300.0, gaps=Gaps(HAMAKER_CONSTANT, "dry", 100e-9))
    across = [
        energies(coated(thickness), 0.4, replace(water, gaps=replace(water.gaps, spacer=2 * thickness)))
        for thickness in (0.0, 0.2e-9, 0.6e-9, 1.2e-9)
    ]
    assert np.all(np.diff(across, axis=0) < 0)


def test_the_rms_of_the_surfaces_is_in_their_bearing_area():
    grid, rms = DistanceGrid(0.05e-9, 500, 501), 3.4e-9
    area = np.tile(norm.sf(grid.bearing, scale=rms), (3, 1))
    found = contact.layout(np.zeros((3, len(grid.solid))), area, grid, range(3))
    assert_allclose(contact.surface_rms(found), rms, rtol=1e-3)


def test_a_dataset_gives_back_its_tables_in_single_precision():
    grid = DistanceGrid(0.5e-9, 3, 8)
    pressure, area = np.arange(16.0).reshape(2, 8), np.linspace(0, 1, 22).reshape(2, 11)
    found = contact.layout(pressure, area, grid, range(4, 6))
    assert found.strip.values.tolist() == [4, 5]
    solid, bearing, starts, step = contact.tables(found)
    assert_array_equal(solid, pressure.astype(np.float32))
    assert_array_equal(bearing, area.astype(np.float32))
    assert solid.dtype == bearing.dtype == np.float32
    assert (starts, step) == ((grid.solid[0], grid.bearing[0]), 0.5e-9)
    assert starts[1] < starts[0] == 0


def test_another_seed_or_pair_gives_other_samples_of_equal_distances():
    one = part(range(2))
    others = [
        contact.compute(small.surfaces(), "b", "NG", replace(SETTINGS, seed=small.SEED + 1), range(2)),
        contact.compute(small.surfaces(), "c", "NG", SETTINGS, range(2)),
    ]
    for other in others:
        assert_array_equal(other.distance, one.distance)
        assert np.all(other.solid_pressure[:, 0] != one.solid_pressure[:, 0])


def test_choices_of_the_surfaces_share_random_numbers():
    one, other = small.surfaces(), small.surfaces()[::-1]
    alone = [contact.compute(surfaces, "b", "NG", SETTINGS, range(3)) for surfaces in (one, other)]
    for found, expected in zip(contact.compute_each([one, other], "b", "NG", SETTINGS, range(3)), alone, strict=True):
        xr.testing.assert_identical(found, expected)
