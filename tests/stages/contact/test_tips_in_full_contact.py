"""Tilted strips in full elastic contact, and the change of tips by that of parallel strips."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import small

from stiction.analysis.model_error import mean_ratios
from stiction.config.files import load
from stiction.contact.correction import Change
from stiction.contact.pair import EquivalentSurface
from stiction.devices.risk import CONFIDENCE
from stiction.plan.graph import Results
from stiction.stages.contact import full_contact
from stiction.stages.surfaces.rough_surfaces import both

NM, UM = 1e-9, 1e-6
DRAW = EquivalentSurface.draw
#: Radius of the edge of a tip, and depth of edge and wedge below the mean plane [m].
RADIUS, DEPTH = 1 * UM, 8 * NM
#: Height of the mean plane of tips [m], because sums over summits begin at 0.
ABOVE = 5 * NM


def tip(slope):
    """Replacement of `EquivalentSurface.draw`: strips fall by a slope, and before the edge along its radius."""

    def draw(pair, *streams):
        heights = DRAW(pair, *streams)
        along = pair.spacing * np.arange(len(heights)) - np.sqrt(2 * RADIUS * DEPTH)
        fall = slope * along + np.minimum(along, 0) ** 2 / (2 * RADIUS)
        return heights - (fall - ABOVE).astype(np.float32)[:, None]

    return draw


@cache
def study(width):
    """Full contact in dry air of the surface of pair b with half of its rms, 1.7 nm. Width of the strips [µm]."""
    config = {"run": {"pairs": ["b"]}, "attraction": {"reach": "all"}, "surfaces": {"B2": {"rms_nm": 1.7}}}
    results = Results.of(load(config | {"pairs": {"b": {"humidities": ["dry"]}}, "beam": {"width_um": width}}))
    return results, results.graph.job("studies/full_contact/dry/b")


def change(strips, length, width, draw=DRAW):
    """Change of the largest attraction of strips with a length [m] and a width [µm]."""
    results, job = study(width)
    settings = small.settings_of(full_contact, job.settings)
    settings = replace(
        settings, strips=strips, most=0, on_summits=0, sampling=replace(settings.sampling, strip_length=length)
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(EquivalentSurface, "draw", draw)
        found = full_contact.compute(both(results.inputs(job)), "b", settings)
    ratio, error = (float(one[0]) for one in mean_ratios(*full_contact.pull_offs(found)[1:], np.zeros(1), np.zeros(1)))
    return Change(ratio, ratio_error=error / ratio)


@pytest.mark.nightly
def test_full_contact_changes_tips_with_a_rounded_edge_less_than_parallel_strips_and_does_change_them():
    slope = 0.026
    tips = change(10, np.sqrt(2 * RADIUS * DEPTH) + DEPTH / slope, 20, tip(slope))
    parallel = change(6, 1 * UM, 8)
    assert tips.at_most(CONFIDENCE).ratio < parallel.at_most(1 - CONFIDENCE).ratio
    assert tips.at_most(1 - CONFIDENCE).ratio > 1, "control: as on summits, smooth tips would hold too little"
