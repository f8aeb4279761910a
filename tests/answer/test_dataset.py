"""Dataset of an answer: the answer comes back from it, also through a file."""

from dataclasses import astuple, replace

import numpy as np
import pytest
import xarray as xr
from drawn_answers import ALONG, ARC, air, asked, budgets, lognormal
from numpy.testing import assert_equal

from stiction.answer.data import Cause, Stay
from stiction.answer.unknowns import OfTestBeams
from stiction.answer.worlds import Condition, Sampled
from stiction.stages.answer.answer import answer_of, layout

ONE = air(lognormal(np.random.default_rng(0)))
BOTH = [replace(ONE, shape=ALONG), ONE, replace(ONE, humidity=0.8, sampled=replace(ONE.sampled, values=np.ones(1000)))]
UNBOUNDED = [Condition(0.5, "force", Cause.ESTIMATE, "x", Sampled(np.zeros(100), (), is_bounded=False))]
NEVER = air(np.full(1000, np.inf), reach=1.0, flat=0.5)
LEFT = OfTestBeams(np.array([-4.0, 4.0]), {(0.5, ARC): np.array([-0.4, 0.4])})

ANSWERS = {
    "beam without a length": lambda: asked(BOTH, budgets(BOTH)),
    "beam with a length": lambda: asked(BOTH, budgets(BOTH), size=0.7, touchdowns=1000),
    "stopper": lambda: asked([ONE], budgets([ONE]), unit="N", size=1.2),
    "no bound": lambda: asked(UNBOUNDED, unit="N", size=2.0),
    "none sticks": lambda: asked([NEVER], size=0.8, touchdowns=100),
    "test beams": lambda: asked([ONE], LEFT, size=0.7, before=budgets([ONE])),
    "mission": lambda: asked(BOTH, touchdowns=10, stays=(Stay((0.5, 0.8), 9.0), Stay((0.8,), 1.0))),
    "forbidden": lambda: asked([ONE], left_out=("dimples",), forbidden=("inputs", "test_beams")),
}


@pytest.mark.parametrize("name", ANSWERS)
def test_the_answer_comes_back_from_its_dataset(name, tmp_path):
    answer = ANSWERS[name]()
    dataset = layout(answer)
    dataset.to_netcdf(tmp_path / "answer.nc")
    with xr.open_dataset(tmp_path / "answer.nc") as stored:
        for one in (dataset, stored.load()):
            again = answer_of(one)
            assert_equal(astuple(again), astuple(answer))
            assert_equal([air.curve for air in again.airs], [air.curve for air in answer.airs])
            assert again.verdict is answer.verdict
            assert again.included == answer.included
