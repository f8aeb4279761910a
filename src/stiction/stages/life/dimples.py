"""Beam on its row of dimples: force, probability of sticking, and gap beside the row."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from stiction.config.cases import in_air
from stiction.devices.stoppers import stuck_patches
from stiction.estimates import mean_with_error
from stiction.life.dimples import row
from stiction.stages.life.answers import BESIDE, DIMPLES, FREE, HOLD, ON_DIMPLES, PULLED, STICK, TOUCH, Answer
from stiction.stages.life.inputs import OfBeam


def dimple_answers(of: OfBeam, dimples: Mapping[float, xr.Dataset]) -> list[Answer]:
    """Answers about a beam on its dimples, from the forces of rows of them by humidity; none without any."""
    if not dimples:
        return []
    bent = _bent_to_dimples(of)
    means = {humidity: tuple(map(float, mean_with_error(one.pull_off.values))) for humidity, one in dimples.items()}
    worst = max(means, key=means.get)
    what, form = (
        f"mean force on its row of dimples {in_air(worst)}",
        f"sum of {of.dimples.number} largest attractions x area",
    )
    mean, error = means[worst]
    held = Answer(DIMPLES, HOLD, what, mean, mean, error, "N", form, "stage dimples")
    force = np.array([bent[-1].low])
    sticking = [
        Answer(
            f"{ON_DIMPLES}_{humidity:g}",
            STICK,
            f"probability of sticking on its row of dimples {in_air(humidity)}",
            *(float(end[0]) for end in stuck_patches(one.pull_off.values, force)[1:]),
            *(np.nan, "1", "fraction of random rows, 95 %", "stage dimples"),
        )
        for humidity, one in dimples.items()
    ]
    return [*bent, held, *sticking]


def _bent_to_dimples(of):
    """Gap that is left beside the dimples of a beam while they touch, and the force with which it pulls there."""
    at, height = of.dimples.at, of.dimples.height

    def left(beam):
        """Part of the gap left at the deepest point beside the row [-]."""
        return 1 - row(beam, of.clamps, at).deepest * (beam.gap - height) / beam.gap

    def pull(beam):
        """Force of the beam at its row, bent to the dimples' height [N]."""
        return row(beam, of.clamps, at).stiffness * (beam.gap - height)

    (rest, rest_error), (force, error) = of.number(left, of.length), of.number(pull, of.length)
    what, form = "part of the gap that is left beside its dimples", "bent by the force on the row alone"
    source = "stiction.life.dimples"
    beside = Answer(BESIDE, TOUCH, what, max(rest, 0.0), max(rest, 0.0), rest_error, "1", form, source)
    what, form = "force with which it pulls at its row of dimples", "k (h - h_d)"
    return [beside, Answer(PULLED, FREE, what, force, force, error, "N", form, source)]
