"""Devices after many touchdowns: probability of sticking, safe length and force."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from stiction.devices.risk import one_in, samples_for
from stiction.devices.stoppers import safe_force
from stiction.life import freeing
from stiction.stages.devices.safe_lengths import chosen_share
from stiction.stages.life.answers import AFTER, FREE, Answer
from stiction.stages.life.inputs import OfBeam, OfStopper
from stiction.stages.life.lengths import least_safe


def beam_after_touchdowns(
    of: OfBeam, share: float, once: tuple[float, float, str], after: Mapping[float, xr.Dataset]
) -> list[Answer]:
    """Safe length and P(stuck) after all touchdowns, from the safe length of one, and its standard error [m].

    Both bounds have errors of the simulation. More touchdowns never allow a longer beam.
    """
    independent = min(once, *(least_safe(dataset, chosen_share(dataset)) for dataset in after.values()))
    stuck = freeing.stuck_after(share, of.touchdowns)
    numbers = f"{of.touchdowns} touchdowns"
    return [
        Answer(
            AFTER,
            FREE,
            f"simulated limit for {numbers}: at most {one_in(share)} sticks after all of them",
            *(independent[0], once[0], independent[1], "m"),
            "P of one = 1 - (1 - p)^(1/n) (at least); the same summits each time (at most)",
            "stage touchdowns",
        ),
        Answer(
            "stuck_after",
            FREE,
            f"probability of sticking after {numbers} at the limit of one",
            *(np.nan, stuck, np.nan, "1", "1 - (1 - p)^n; p with the same summits each time", "stiction.life.freeing"),
        ),
    ]


def stopper_after_touchdowns(stopper: xr.Dataset, of: OfStopper) -> list[Answer]:
    """P(stuck) after all touchdowns in the worst given air, and the force for a small fraction stuck.

    The bounds are those of the 95 % band of P: what none of the patches do bounds it from above alone.
    """
    if of.touchdowns == 1:
        return []
    once, most = (float(stopper.stuck.sel(bound=bound).max()) for bound in ("low", "high"))
    form = "P (at least) and 1 - (1 - P)^n (at most), of the 95 % band of P"
    numbers, after = f"{of.touchdowns} touchdowns", freeing.stuck_after(most, of.touchdowns)
    what = f"probability of sticking after {numbers}"
    answers = [Answer("stuck_after", FREE, what, once, after, np.nan, "1", form, "stiction.life.freeing")]
    share = float(stopper.share.max())
    rare = freeing.probability_for(share, of.touchdowns)
    if stopper.sizes["sample"] >= samples_for(rare):
        few, many = (max(safe_force(row, p)[::2] for row in stopper.pull_off.values) for p in (share, rare))
        what = f"restoring force that frees all but {one_in(share)} after {numbers}"
        form = "the same summits each time (at least); P of one = 1 - (1 - p)^(1/n) (at most)"
        answers.append(Answer(AFTER, FREE, what, few[0], many[0], few[1], "N", form, "stage stoppers"))
    return answers
