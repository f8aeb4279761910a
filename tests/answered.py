"""Answers about devices from the datasets of their simulation alone, without uncertain inputs."""

import numpy as np

from stiction.answer import ladder
from stiction.answer.data import Answer, Cause
from stiction.answer.unknowns import Draws, OfBudgets
from stiction.stages.answer import conditions
from stiction.stages.devices.safe_lengths import chosen_share
from stiction.stages.devices.stoppers import bounded_share

DRAWS = Draws(2000, 0)


def of_beam(lengths, length=np.nan, touchdowns=1, kind="cantilever") -> Answer:
    """Answer about a beam from its safe lengths by humidity, perhaps with a length [m]."""
    circumstances = list(conditions.of_lengths(lengths, Cause.ESTIMATE, "safe_lengths"))
    share = chosen_share(next(iter(lengths.values())))
    asked = ladder.MainQuestion("C1", kind, share, "m", length, touchdowns)
    return ladder.answer(asked, circumstances, OfBudgets({}), DRAWS)


def of_stopper(stopper, touchdowns=1) -> Answer:
    """Answer about a stopper from its dataset."""
    share = bounded_share(stopper)
    errors = stopper.full_contact_error
    circumstances = list(conditions.of_forces(stopper.pull_off, share, stopper.safe_force, errors, Cause.ESTIMATE))
    share = share or float(stopper.share.max())
    asked = ladder.MainQuestion("S1", "stopper", share, "N", float(stopper.restoring_force), touchdowns)
    return ladder.answer(asked, circumstances, OfBudgets({}), DRAWS)
