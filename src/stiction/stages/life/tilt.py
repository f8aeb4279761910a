"""Stopper at its tilts: force, probability of sticking, and transition to a wedge."""

import numpy as np
import xarray as xr

from stiction.config.cases import Air
from stiction.config.units import from_si
from stiction.devices.risk import Basis, one_in
from stiction.stages.life.answers import FREE, HOLD, STICK, TILTED, WEDGE, Answer

_SOURCE = "stage tilted_stoppers"


def tilted_answers(tilted: xr.Dataset) -> list[Answer]:
    """Fraction of stoppers stuck at their tilts, the force on them, and the tilt at the transition to a wedge."""
    tilts = [f"{from_si(float(tilt), 'deg'):.3g}" for tilt in tilted.tilt.values]
    by = f"tilted by {' to '.join(dict.fromkeys((tilts[0], tilts[-1])))}°"
    each = f"least and most of {len(tilts)} tilts; " if len(tilts) > 1 else ""
    form = f"{each}random patches; w e / s on smooth surfaces beyond the tilt of a wedge"
    answers = [
        Answer(
            f"stuck_tilted_{float(humidity):g}",
            STICK,
            f"probability of sticking {by}, {Air(float(humidity)).where}",
            float(tilted.stuck.sel(humidity=humidity, bound="low").min()),
            float(tilted.stuck.sel(humidity=humidity, bound="high").max()),
            *(np.nan, "1", f"{each}fraction of random patches, 95 %", _SOURCE),
        )
        for humidity in tilted.humidity.values
    ]
    most = tilted.isel(humidity=int(tilted["mean"].max("tilt").argmax("humidity")))
    low, high, air = int(most["mean"].argmin("tilt")), float(most["mean"].max()), Air(float(most.humidity)).where
    numbers = float(most["mean"][low]), high, float(most.mean_error[low])
    answers.append(Answer(TILTED, HOLD, f"mean pull-off force {by}, {air}", *numbers, "N", form, _SOURCE))
    what, form = "tilt beyond which a longer first side hardly holds more", "e / (f_max a), parallel patches"
    numbers = float(tilted.wedge.min()), float(tilted.wedge.max()), np.nan
    answers.append(Answer(WEDGE, HOLD, what, *numbers, "rad", form, _SOURCE))
    bounded = [float(share) for share in tilted.share[tilted.basis == Basis.SAMPLED]]
    if bounded:
        safe = tilted.safe_force.sel(share=min(bounded)).max("humidity")
        low = int(safe.sel(part="safe").argmin("tilt"))
        numbers = (
            float(safe.sel(part="safe")[low]),
            float(safe.sel(part="safe").max()),
            float(safe.sel(part="error")[low]),
        )
        what = f"restoring force that frees all but {one_in(min(bounded))}, {by}"
        form = f"{each}quantile of the force, 95 %"
        answers.append(Answer("restoring_force_tilted", FREE, what, *numbers, "N", form, _SOURCE))
    return answers
