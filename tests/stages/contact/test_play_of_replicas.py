"""Energies of surfaces that follow each other, at random offsets."""

import numpy as np
import pytest
from standard_errors import ALLOWED
from test_replicas import contact_of, energies

HUMIDITY = 0.67


def works(play, samples, **stated):
    """Energies of strips at a coherence of 0.97 and a play [nm], of independent surfaces without a play [mJ/m²]."""
    replica = None if play is None else {"coherence": 0.97, "play_nm": play} | stated
    return 1e3 * energies(contact_of(replica, samples=samples), HUMIDITY)


def apart(one, other):
    """Difference of the means of independent draws, in standard errors."""
    return abs(one.mean() - other.mean()) / np.hypot(*(each.std(ddof=1) / np.sqrt(len(each)) for each in (one, other)))


def test_contact_without_play_is_that_in_register():
    stated = {"coherence": 0.7, "offset_nm": 30}
    assert contact_of(stated | {"play_nm": 0}, samples=2).identical(contact_of(stated, samples=2))


def test_energies_fall_with_play_to_those_of_independent_surfaces():
    means = [works(play, samples=20).mean() for play in (0, 5, 10, 20, 40, 80)]
    assert np.all(np.diff(means) < 0)
    independent = works(None, samples=60)
    assert apart(works(20_000, samples=60), independent) < ALLOWED
    assert apart(works(40, samples=60), independent) > ALLOWED


@pytest.mark.slow
def test_energies_with_play_are_those_at_stated_offsets_by_their_distribution():
    """Distances of normal offsets have Rayleigh's distribution, here in 16 classes of equal probability."""
    play, classes = 15, 16
    levels = (np.arange(classes) + 0.5) / classes
    distances = play * np.sqrt(-2 * np.log(1 - levels))
    by_class = np.array([works(0, samples=20, offset_nm=float(distance)) for distance in distances])
    drawn = works(play, samples=500)
    assert apart(by_class.mean(axis=0), drawn) < ALLOWED
    assert apart(works(0, samples=500, offset_nm=play * np.sqrt(2)), drawn) > ALLOWED  # at the rms distance alone
