"""Touchdowns of a beam at other offsets above the same surface, counted by those on other surfaces, by brute force."""

from functools import cache

import numpy as np
import pytest
from own_replicas import SPACING, Meeting, strips
from plans import plan_of_copy, surface_datasets

from stiction.config.units import in_si
from stiction.contact.environment import Water
from stiction.plan.stage import select
from stiction.stages.contact import contact, curves, pairs

#: Coherence, humidity, beams, touchdowns of each, and points along a square, which a beam covers with its strips.
COHERENCE, HUMIDITY, BEAMS, TOUCHDOWNS, POINTS = 0.9, 0.45, 60, 10, 1024
#: Share of all touchdowns after which a beam is stuck.
SHARE = 0.07
ALONG, ACROSS = 150, 1000


@cache
def touchdowns(play):
    """Mean energies of beams at offsets with a play [nm] (beams, touchdowns) [J/m²]."""
    plan = plan_of_copy({"samples": 400, "chunks": 1}, 200, {"coherence": COHERENCE})
    settings = in_si(
        pairs.Settings,
        select(pairs.Settings, plan.seen_by("copied", samples=1) | {"beam": {"width_um": 1e6 * ACROSS * SPACING}}),
    )
    pair = pairs.surface_pair([surface_datasets(plan, "Ground")] * 2, "NG", settings)
    water, rng = in_si(Water, plan.air_of_devices.water("copied")), np.random.default_rng(75)
    beams = (Meeting(COHERENCE, rng, POINTS) for _ in range(BEAMS))

    def energy(heights):
        rows = [np.array(each) for each in zip(*map(pair.contact, strips(heights, ALONG, ACROSS)), strict=True)]
        return curves.energies(contact.layout(*rows, pair.distances, range(len(rows[0]))), HUMIDITY, water).mean()

    offsets = 1e-9 * play * rng.standard_normal((BEAMS, TOUCHDOWNS, 2))
    return np.array([[energy(beam.heights(at)) for at in of] for beam, of in zip(beams, offsets, strict=True)])


def independent(energies):
    """Number of touchdowns on other surfaces that stick as many beams, where `SHARE` sticks at each."""
    stuck = energies > np.quantile(energies, 1 - SHARE)
    return np.log(1 - stuck.any(axis=1).mean()) / np.log(1 - stuck.mean())


def with_error(energies):
    """Number of `independent` touchdowns, and its standard error by beams drawn again."""
    rng = np.random.default_rng(1)
    again = [independent(energies[rng.integers(len(energies), size=len(energies))]) for _ in range(400)]
    return independent(energies), np.std(again)


def shuffled(energies):
    """Energies of the same touchdowns, each of any beam."""
    return np.random.default_rng(3).permuted(energies.ravel()).reshape(energies.shape)


def test_touchdowns_count_as_one_on_the_same_summits_and_each_on_others():
    beams = np.random.default_rng(2).standard_normal((3000, 1))
    assert independent(np.repeat(beams, TOUCHDOWNS, axis=1)) == pytest.approx(1)
    count, error = with_error(np.random.default_rng(2).standard_normal((3000, TOUCHDOWNS)))
    assert abs(count - TOUCHDOWNS) < 4 * error < 1


@pytest.mark.nightly
def test_touchdowns_at_other_offsets_count_as_far_as_the_play_reaches():
    """Ten touchdowns count as 9.6 ± 1.2 at a play of 20 nm, and as 4.9 ± 0.8 at 5 nm. Pages count all, safe."""
    (far, error_of_far), (near, error_of_near) = with_error(touchdowns(20)), with_error(touchdowns(5))
    (control, error) = with_error(shuffled(touchdowns(5)))
    assert abs(far - TOUCHDOWNS) < 2 * error_of_far < 3
    assert near + 3 * error_of_near < control - error, "control: the same touchdowns of other beams"
    assert abs(control - TOUCHDOWNS) < 2 * error
    assert near - 3 * error_of_near > 1, "more than one offset counts"
