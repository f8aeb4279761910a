"""Coherence of two surfaces from scans of their facing sides."""

import numpy as np
import pytest
from published import SPACING, SURFACES
from standard_errors import ALLOWED, errors_off

from stiction.analysis.facing import facing_coherence
from stiction.errors import ScanError
from stiction.scans.scan import Scan
from stiction.streams import stream
from stiction.surface.field import StripGrid
from stiction.surface.replica import Coherence, Replica

SIZE = 1.4e-6
GRID = StripGrid(SIZE, SIZE, SPACING, margin=0.6e-6)
GAUSSIAN = SURFACES["B2"].with_gaussian_heights(GRID)
SKEWED = SURFACES["B2"].on(GRID)
OFFSET = 37e-9


def scans(stated, number, surface=GAUSSIAN, turn=np.s_[:, ::-1]):
    """Scans of a copy, turned over, and of its original."""
    of_beam, of_substrate = ((2021, side, number) for side in ("beam", "substrate"))
    upper = Replica(surface, surface, stated).draw_beam(stream(*of_beam), stream(*of_substrate))
    return Scan(upper[turn], (SIZE, SIZE)), Scan(surface.draw(stream(*of_substrate)), (SIZE, SIZE))


def found(stated, count, **options):
    """Coherences of several pairs of scans."""
    return [facing_coherence(*scans(stated, k, **options)) for k in range(count)]


def values(coherences):
    """Coherences and their errors, (n, bands) each."""
    bands = min(np.sum(each.wavelength > 55e-9) for each in coherences)  # the Gaussian field has no waves below 50 nm
    return tuple(np.array([getattr(each, name)[:bands] for each in coherences]) for name in ("coherence", "error"))


@pytest.mark.parametrize("surface", [GAUSSIAN, SKEWED], ids=["Gaussian", "skewed"])
@pytest.mark.parametrize("stated", [0.4, 0.85])
def test_scans_of_a_copy_show_its_coherence_and_register(surface, stated):
    copies = found(Coherence(stated, offset=OFFSET), 8, surface=surface)
    coherences, errors = values(copies)
    assert errors_off(coherences.mean(axis=1), stated) < ALLOWED
    assert errors_off(coherences.mean(axis=1), stated - 0.1) > ALLOWED
    pulls = (coherences - stated) / errors
    assert np.mean(pulls**2) == pytest.approx(1, abs=ALLOWED * np.sqrt(2 / pulls.size))
    assert all(copy.is_registered for copy in copies)
    np.testing.assert_allclose([copy.shifts for copy in copies], [[[-OFFSET, 0]] * 2] * 8, atol=0.6 * SPACING)


def test_independent_surfaces_have_none_within_the_errors():
    copies = found(Coherence(0.0), 10)
    coherences, errors = values(copies)
    pulls = coherences / errors
    assert abs(pulls.mean()) < ALLOWED / np.sqrt(pulls.size)
    assert np.mean(pulls**2) == pytest.approx(1, abs=ALLOWED * np.sqrt(2 / pulls.size))
    assert np.mean([copy.is_registered for copy in copies]) < 0.3


def test_waves_that_were_not_copied_have_no_coherence():
    copies = found(Coherence(0.9, above=100e-9), 8)
    coherences, _ = values(copies)
    wavelength = copies[0].wavelength[: coherences.shape[1]]
    long, short = wavelength > 130e-9, wavelength < 77e-9
    assert np.all(np.diff(wavelength) < 0)
    assert errors_off(coherences[:, short].mean(axis=1), 0) < ALLOWED
    assert errors_off(coherences[:, long].mean(axis=1), 0.9) < ALLOWED


def test_either_axis_may_be_mirrored():
    stated = Coherence(0.9, offset=OFFSET)
    slow, fast = (facing_coherence(*scans(stated, 1, turn=turn)) for turn in (np.s_[:, ::-1], np.s_[::-1, :]))
    np.testing.assert_allclose(slow.coherence, fast.coherence, rtol=1e-9)
    unturned = facing_coherence(*scans(stated, 1, turn=np.s_[:, :]))
    assert not unturned.is_registered


def test_scans_without_the_same_points_are_refused():
    upper, lower = scans(Coherence(0.5), 0)
    with pytest.raises(ScanError, match="points and size of"):
        facing_coherence(Scan(upper.heights[:-1], upper.size), lower)
    holed = upper.heights.copy()
    holed[3, 4] = np.nan
    with pytest.raises(ScanError, match="heights at all points"):
        facing_coherence(Scan(holed, upper.size), lower)


@pytest.mark.slow
@pytest.mark.parametrize("stated", [0.0, 0.6, 0.95])
def test_errors_cover_the_coherence_as_often_as_normal_ones(stated):
    coherences, errors = values(found(Coherence(stated, offset=OFFSET), 40))
    inside = np.abs(coherences - stated) < 2 * errors
    assert np.mean(inside) == pytest.approx(0.954, abs=ALLOWED * np.sqrt(0.954 * 0.046 / inside.size))
