"""Devices drawn for tests of their answers: lognormal thresholds of simulated devices, budgets and questions."""

import numpy as np

from stiction.answer import ladder
from stiction.answer.data import Cause
from stiction.answer.ladder import MainQuestion
from stiction.answer.unknowns import Draws, Exact, OfBudgets, Slopes
from stiction.answer.worlds import Condition, Sampled, StatedSize
from stiction.devices import risk
from stiction.life.freeing import probability_for
from stiction.streams import stream

SHARE, DEVICES, SCATTER = 1e-3, 1000, 0.15
ARC, ALONG = "S-shape or arc", "S-shape"


def stated(values, share, **bounds):
    """Statement about thresholds (n,) as stage safe_lengths makes it."""
    safe = risk.safe_length(np.exp(values), share, stream(0, "safe length"), risk.LengthBounds(**bounds))
    return StatedSize(share, np.log(max(safe.estimate, safe.length)), np.log(safe.length))


def sampled(values, touchdowns=1, **bounds):
    """Thresholds (n,) with statements for one touchdown and for all."""
    shares = [SHARE] + [probability_for(SHARE, touchdowns)] * (touchdowns > 1)
    ends = {"reach": np.log(bounds.get("reach", np.inf)), "flat": np.log(bounds.get("flat", np.exp(-4)))}
    return Sampled(np.sort(values), tuple(stated(values, share, **bounds) for share in shares), **ends)


def air(values, humidity=0.5, shape=ARC, cause=Cause.ESTIMATE, touchdowns=1, **bounds):
    """Condition of a beam from thresholds (n,)."""
    return Condition(humidity, shape, cause, f"{cause} {humidity}", sampled(values, touchdowns, **bounds))


def lognormal(rng, centre=0.0, scatter=SCATTER, number=DEVICES):
    """Thresholds of lognormal devices."""
    return centre + scatter * rng.standard_normal(number)


def slopes(slope=(0.2,), error=0.0, bend=0.0, names="abc", members=()):
    """Budget with independent inputs of unit variance."""
    k = len(slope)
    names = tuple(names[:k])
    spread = np.full(k, error), np.full(k, bend)
    return Slopes(names, tuple(f"group of {name}" for name in names), np.array(slope), *spread, np.eye(k), members)


def budgets(conditions, *args, **kwargs):
    """The same budget in all airs and end states of some conditions."""
    return OfBudgets(
        {
            (condition.humidity, condition.shape): slopes(*args, **kwargs)
            for condition in conditions
            if condition.sampled
        }
    )


def asked(conditions, unknowns=None, number=2000, before=None, **question):
    """Answer about a drawn device."""
    question = {"share": SHARE, "unit": "m"} | question
    return ladder.answer(
        MainQuestion("D", "cantilever", **question), conditions, unknowns or Exact(), Draws(number, 0), before
    )
