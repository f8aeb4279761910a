"""P(stuck) with play beside 2000 beams on surfaces of another generator and with another search for cracks."""

import numpy as np
import pytest
from own_replicas import SPACING, STRIP, Meeting, crack_lengths, strips
from plans import plan_of_copy

from stiction.config.units import in_si
from stiction.contact.environment import Water
from stiction.plan.graph import Graph, Results
from stiction.plan.stage import select
from stiction.stages.contact import contact, curves, pairs
from stiction.stages.devices import opening
from stiction.stages.devices.cracks import Settings
from stiction.stages.devices.ground import ground_from
from stiction.streams import stream

#: Coherence and play [nm] that are used nowhere else, and offsets for the play, each of a pair of surfaces of its own.
COHERENCE, PLAY, OFFSETS, BEAMS = 0.8, 35, 36, 2000
#: Shares at which lengths and P(stuck) are compared. ASSUME: 6 % of a length, and 0.06 of a share, for the crack tip
#: and the sampling: either half of the offsets moves lengths by up to 5 %.
SHARES, ALLOWED = (0.05, 0.1, 0.2, 0.5), 0.06


def computed(plan):
    """Crack lengths of the package, of beams that move as one body and of strips that move alone [m]."""
    graph = Graph(plan)
    results = Results(graph)
    settings = in_si(Settings, graph.job("devices/cracks/Lever_rh045").settings)
    ground = ground_from(results["devices/ground/copied_rh045_1500x20000"], settings)
    part, address = opening.ground_of(settings.device, ground.laws), opening.addresses(settings)
    draws = ground.strips.in_row(settings.device), ground.strips.draw
    lengths = [opening.arrests(settings.device, part, draw, BEAMS, address) for draw in draws]
    return settings.device, lengths, spread(settings.device, ground.strips.sampled)


def spread(device, laws):
    """Foundation length of a lever, over which its crack tip spreads, by the energies that hold it: 7.9 µm here [m].

    Half and three times as much move lengths by up to 5 %; from twice as much on, they miss what is allowed.
    """
    largest, _, before, _ = laws.T
    lengths = (device.young_modulus * device.thickness**3 / (12 * before * largest)) ** 0.25
    return np.average(lengths, weights=largest / before)


def energies_at_offsets(plan):
    """Energies of strips at offsets with equally probable distances (offsets, strips) [J/m²]."""
    surface = [Results(Graph(plan))[f"{stage}/Ground"] for stage in ("heights", "spectrum")]
    settings = in_si(pairs.Settings, select(pairs.Settings, plan.seen_by("copied", samples=1)))
    pair = pairs.surface_pair([tuple(surface)] * 2, "NG", settings)
    water, rng = in_si(Water, plan.air_of_devices.water("copied")), stream(35, "held out")
    distances = 1e-9 * PLAY * np.sqrt(-2 * np.log(1 - (np.arange(OFFSETS) + 0.5) / OFFSETS))
    found = []
    for distance, angle in zip(distances, 2 * np.pi * rng.random(OFFSETS), strict=True):
        heights = Meeting(COHERENCE, rng).heights(distance * np.array([np.cos(angle), np.sin(angle)]))
        curves_of_strips = zip(*map(pair.contact, strips(heights)), strict=True)
        rows = [np.array(each) for each in curves_of_strips]
        found.append(curves.energies(contact.layout(*rows, pair.distances, range(len(rows[0]))), 0.45, water))
    return np.array(found), rng


@pytest.mark.slow
def test_2000_beams_on_other_surfaces_stick_as_computed():
    plan = plan_of_copy({"samples": 400, "chunks": 1}, BEAMS, {"coherence": COHERENCE, "play_nm": PLAY})
    device, (body, alone), of_tip = computed(plan)
    energies, rng = energies_at_offsets(plan)
    number = int(1.2e-3 / (STRIP[0] * SPACING))
    offset = np.arange(BEAMS)[:, None] % OFFSETS
    drawn = energies[offset, rng.integers(energies.shape[1], size=(BEAMS, number))]
    found = crack_lengths(drawn, STRIP[0] * SPACING, device, of_tip)
    ratios, shares = (np.array([of(lengths, found) for lengths in (body, alone)]) for of in (differences, stuck))
    assert np.abs(ratios[0]).max() < ALLOWED
    assert np.abs(shares[0] - SHARES).max() < ALLOWED
    assert np.abs(ratios[1]).min() > ALLOWED, "control: strips that move alone"
    assert np.abs(shares[1] - SHARES).max() > ALLOWED, "control"


def differences(lengths, others):
    """Differences of ln l at the shares."""
    return [float(np.log(np.quantile(np.minimum(lengths, 1), p) / np.quantile(others, p))) for p in SHARES]


def stuck(lengths, others):
    """P(stuck) of beams as long as those of which the shares stick."""
    return [float((lengths < np.quantile(others, p)).mean()) for p in SHARES]
