"""Coverage of lengths after counts: how many drawn truths are inside the stated intervals of 95 %.

``pytest -m "slow or nightly" --log-cli-level INFO tests/devices/test_coverage.py`` gives numbers of test-beams.md.
"""

import itertools
import logging

import numpy as np
import pytest

from stiction.devices.inference import (
    Counts,
    CrackData,
    DiscrepancyOfModel,
    KnownInputs,
    lognormal,
    update,
    with_discrepancy,
)
from stiction.streams import stream

TRUTHS, SCATTER = 400, 0.05
#: Test beams and device at three humidities: responses of cracks to rms and modulus, and u.
SHARED, REDUCED = np.array([[1.4, 0.25], [1.0, 0.25], [0.3, 0.25]]), np.array([0.5, 0.1, -0.6])
#: Median ln l of cracks and of tips: where one of them is large, it holds no beam.
CENTRES = {"cracks": (0.0, 10.0), "tips": (10.0, 0.0), "both": (0.0, 0.0)}
BEAMS, DEVICE = np.hstack([SHARED, np.full((3, 1), 0.75), np.zeros((3, 1))]), np.zeros((3, 4))
DEVICE[:, [0, 1, 3]] = BEAMS[:, :3]
PRIOR, RESPONSES = with_discrepancy(
    KnownInputs(("rms", "modulus", "thickness of A", "thickness"), np.zeros(4), np.diag([0.05, 0.03, 0.03, 0.03]) ** 2),
    np.vstack([BEAMS, BEAMS, DEVICE, DEVICE]),
    np.concatenate([REDUCED, np.zeros(3)] * 2),
    [*"abc", None, None, None, *"def", None, None, None],
    DiscrepancyOfModel(0.1, 0.3, 0.05),
)
# Tips err by 4/3 of what the cracks of the same beams do.
RESPONSES[3:6, 4:], RESPONSES[9:, 4:] = 4 / 3 * RESPONSES[:3, 4:], 4 / 3 * RESPONSES[6:9, 4:]
CRACKS, TIPS, RESULTS = RESPONSES[:3], RESPONSES[3:6], RESPONSES[6:]
NOTHING = CrackData(np.empty((0, RESPONSES.shape[1])), np.empty(0), np.empty(0))


def drawn(rng, centres, beams):
    """Errors of all inputs, and counts of beams with one length at each humidity that stick with them."""
    truth = rng.multivariate_normal(PRIOR.mean, PRIOR.covariance)
    lengths = rng.uniform(-0.1, 0.2, 3)
    held = [
        centre + responses @ truth + SCATTER * rng.normal(size=(beams, 3))
        for centre, responses in zip(centres, (CRACKS, TIPS), strict=True)
    ]
    stuck = np.sum(np.minimum(*held) < lengths, axis=0)
    scores = [[lognormal(np.exp(centre), SCATTER) for centre in centres]] * 3
    responses = np.stack([CRACKS, TIPS], axis=1)
    return truth, Counts(responses, np.exp(np.stack([lengths] * 2, axis=1)), scores, stuck, np.full(3, beams))


@pytest.mark.parametrize(
    ("held_by", "beams"),
    [
        pytest.param(*case, marks=pytest.mark.slow if case == ("both", 10) else pytest.mark.nightly)
        for case in itertools.product(CENTRES, (10, 40))
    ],
)
def test_intervals_of_95_percent_hold_95_percent_of_the_true_lengths(held_by, beams):
    by_deviation, by_quantiles, is_box = [], [], []
    for k in range(TRUTHS):
        truth, counts = drawn(stream(k, "truth"), CENTRES[held_by], beams)
        found, lengths = update(PRIOR, NOTHING, counts, stream(k, "draws")), RESULTS @ truth
        mean, deviation = found.response_moments(RESULTS)
        low, high = found.quantiles(RESULTS, np.array([-1.96, 1.96])).T
        by_deviation.append(np.abs(lengths - mean) < 1.96 * deviation)
        by_quantiles.append((low < lengths) & (lengths < high))
        is_box.append(np.all((counts.stuck == 0) | (counts.stuck == beams)))
    by_deviation, by_quantiles, is_box = map(np.array, (by_deviation, by_quantiles, is_box))
    shares = [100 * np.mean(inside) for inside in (by_deviation, by_quantiles, by_quantiles[is_box])]
    of_boxes = is_box.sum(), shares[2]
    logging.info("%s, %d beams: %.1f and %.1f %%; all or none, %d: %.1f %%", held_by, beams, *shares[:2], *of_boxes)
    assert np.all(np.abs(np.array(shares[:2]) - 95) <= 2.5)
    assert abs(shares[2] - 95) <= 4 * 100 * np.sqrt(0.05 * 0.95 / is_box.sum())
