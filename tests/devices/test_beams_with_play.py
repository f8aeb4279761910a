"""Beams above a surface that they follow move in their plane as one body."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plans import plan_of_copy

from stiction.config.units import in_si
from stiction.contact import forcelaw
from stiction.contact.environment import Water
from stiction.devices.strips import FEWEST, NEAREST, of_one_body, resampled
from stiction.plan.graph import Graph, Results
from stiction.plan.stage import select
from stiction.stages.contact import contact, curves, pairs
from stiction.stages.devices import opening
from stiction.stages.devices.cracks import Settings
from stiction.stages.devices.ground import ground_from
from stiction.streams import stream

SAMPLES = 700
PLAY = 20


@given(st.integers(1, 400), st.integers(0, 2**32))
def test_strips_of_one_beam_have_nearly_equal_displacements(samples, seed):
    rng = np.random.default_rng(seed)
    displacements = rng.rayleigh(size=samples)
    laws = np.repeat(displacements[:, None], 4, axis=1)
    of_beam = of_one_body(laws, displacements)(30, rng)[:, 0]
    rank = np.searchsorted(np.sort(displacements), of_beam)
    assert np.ptp(rank) < max(FEWEST, NEAREST * samples + 1)


def test_beams_meet_all_displacements_and_err_towards_the_register():
    """A strip of a beam is on average half of the nearest samples closer than its beam."""
    samples, beams = 1000, 4000
    order = np.random.default_rng(3).permutation(samples).astype(float)
    draw = of_one_body(np.repeat(order[:, None], 4, axis=1), order)
    means = np.array([draw(50, stream(5, k))[:, 0].mean() for k in range(beams)])
    shift = NEAREST * samples / 2
    error = means.std() / np.sqrt(beams)
    assert means.mean() == pytest.approx((samples - 1) / 2 - shift, abs=4 * error + shift * NEAREST)
    assert means.mean() < (samples - 1) / 2
    assert means.std() == pytest.approx(samples / np.sqrt(12), rel=0.05)
    alone = np.array([resampled(order[:, None], 50, stream(5, k)).mean() for k in range(beams)])
    assert alone.std() < 0.2 * means.std()


def plan_of(**replica):
    """Plan of the example of a copy at a coherence of 0.9."""
    return plan_of_copy({"samples": SAMPLES, "chunks": 3}, 600, {"coherence": 0.9} | replica)


@pytest.fixture(scope="module")
def with_play():
    """Plan with play, and its results."""
    plan = plan_of(play_nm=PLAY)
    return plan, Results(Graph(plan))


@pytest.mark.slow
def test_jobs_with_play_keep_the_displacements_of_their_samples(with_play):
    _, results = with_play
    ground = results["devices/ground/copied_rh045_1500x20000"]
    energy, moved = forcelaw.energy(ground.sampled.values), ground.displacement.values
    assert moved.std() == pytest.approx(1e-9 * PLAY * np.sqrt(2 - np.pi / 2), rel=0.1)
    assert np.corrcoef(moved, np.log(energy))[0, 1] < -0.8
    assert "displacement" not in Results(Graph(plan_of()))["devices/ground/copied_rh045_1500x20000"]


def laws_at(plan, results, offset, strips):
    """Force laws of some strips at an offset in register [nm]."""
    other = plan_of(offset_nm=float(offset))
    settings = in_si(pairs.Settings, select(pairs.Settings, other.seen_by("copied", samples=strips)))
    width = in_si(Settings, Graph(plan).job("devices/cracks/Lever_rh045").settings).device.width
    settings = replace(settings, beam=pairs.Width(width))
    surfaces = [(results[f"heights/{name}"], results[f"spectrum/{name}"]) for name in plan.sides("copied")]
    dataset = contact.compute(surfaces, "copied", "NG", settings)
    vectors, limit = curves.vectors(dataset, 0.45, in_si(Water, plan.air_of_devices.water("copied")))
    return forcelaw.coefficients(vectors[forcelaw.admissible(vectors, limit)], limit)


@pytest.mark.slow
def test_lengths_are_those_of_beams_at_stated_offsets(with_play):
    """Each of the other beams has one of 40 offsets, equally probable ones of Rayleigh's distribution."""
    plan, results = with_play
    settings = in_si(Settings, Graph(plan).job("devices/cracks/Lever_rh045").settings)
    ground = ground_from(results["devices/ground/copied_rh045_1500x20000"], settings)
    offsets = PLAY * np.sqrt(-2 * np.log(1 - (np.arange(40) + 0.5) / 40))
    classes = [laws_at(plan, results, offset, 40) for offset in offsets]

    def at_one_offset(number, rng):
        """Laws of the strips of one beam (number, 4)."""
        return resampled(classes[rng.integers(len(classes))], number, rng)

    device, address = settings.device, opening.addresses(settings)
    part = opening.ground_of(device, ground.laws)
    draws = {"one body": ground.strips.in_row(device), "offsets": at_one_offset, "alone": ground.strips.draw}
    found = {
        name: opening.arrests(device, part, draw, 600, partial(address, name) if name == "offsets" else address)
        for name, draw in draws.items()
    }
    ratios = {}
    for share in (0.05, 0.2, 0.5):  # lengths of 600 beams err by 1 %
        body, offsets, alone = (np.quantile(np.minimum(lengths, 1), share) for lengths in found.values())
        assert 0.95 < body / offsets < 1.02  # safe side
        ratios[share] = alone / offsets
    assert ratios[0.05] > 1.03  # strips that move alone make few beams short, and few long
    assert ratios[0.5] < 0.95
