"""P(stuck) of beams with play: in register, at a random offset, and after many touchdowns."""

import numpy as np
import pytest
import xarray as xr
from test_beams_with_play import plan_of

from stiction.devices.strips import in_register
from stiction.plan.graph import Graph, Results
from stiction.stages.devices.opening import S_SHAPE
from stiction.stages.life.answers import answers_of
from stiction.stages.life.beams import beam_at_registers


def stated(register, lengths, touchdowns=10):
    """Rows of a beam of 300 µm with some sticking lengths in register and at random offsets [µm]."""
    numbers = {"register_sticking_length": ("device", register)} if register else {}
    numbers |= {"sticking_length": (("shape", "device"), [lengths])}
    dataset = xr.Dataset({name: (dims, 1e-6 * np.array(values)) for name, (dims, values) in numbers.items()})
    of = type("Of", (), {"touchdowns": touchdowns})
    return beam_at_registers(of, 300e-6, {0.45: dataset})


def test_touchdowns_lie_between_one_offset_and_others():
    register, offsets = stated([100, 120, 140, 500], [250, 310, 320, 330])
    assert (register.high, offsets.low) == (0.75, 0.25)
    assert offsets.high == pytest.approx(1 - 0.75**10)
    assert offsets.error == pytest.approx(np.sqrt(0.25 * 0.75 / 4))
    _, once = stated([100, 120, 140, 500], [250, 310, 320, 330], touchdowns=1)
    assert once.low == pytest.approx(once.high)
    assert stated([], [250, 310, 320, 330]) == [], "without play"


def test_in_register_are_the_samples_that_moved_least():
    moved = np.random.default_rng(1).permutation(2000).astype(float)
    drawn = in_register(np.repeat(moved[:, None], 4, axis=1), moved)(500, np.random.default_rng(2))
    assert set(drawn[:, 0]) <= set(range(40))
    assert len(set(drawn[:, 0])) == 40


@pytest.mark.slow
def test_beams_in_register_are_those_without_play():
    """The nearest samples moved by up to 0.2 of the play, so that lengths are no shorter than without any."""
    jobs = {play: Results(Graph(plan_of(play_nm=play))) for play in (0, 20)}
    safe = {play: results["devices/safe_lengths/Lever_rh045"] for play, results in jobs.items()}
    assert "register_sticking_length" not in safe[0]
    exact, offsets = (np.median(safe[play].sticking_length.sel(shape=S_SHAPE)) for play in (0, 20))
    assert 0.98 < np.median(safe[20].register_sticking_length) / exact < 1.04
    assert offsets / exact > 1.3, "control"
    rows = {row.name: row for row in answers_of(jobs[20]["devices/life/Lever"])}
    assert rows["register"].high >= rows["offsets"].low
