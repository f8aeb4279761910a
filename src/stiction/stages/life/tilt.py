"""Stopper at its tilts: force, probability of sticking, and transition to a wedge."""

import numpy as np
import xarray as xr

from stiction.config.cases import Air
from stiction.config.units import from_si
from stiction.devices.risk import Basis, one_in
from stiction.stages.life.answers import FREE, HOLD, STICK, TILTED, WEDGE, Answer

_SOURCE = "stage tilted_stoppers"


def tilted_answers(tilted: xr.Dataset) -> list[Answer]:
    """Fraction of stoppers stuck at their tilts, the force on them, and the tilt at the transition to a wedge.

    At most counts every patch at the tilt at which it holds most, as if it landed at all of them.
    """
    tilts = [f"{from_si(float(tilt), 'deg'):.3g}" for tilt in tilted.tilt.values]
    by = f"tilted by {' to '.join(dict.fromkeys((tilts[0], tilts[-1])))}°"
    each = f"least of {len(tilts)} tilts, and each patch at its worst; " if len(tilts) > 1 else ""
    answers = [
        Answer(
            f"stuck_tilted_{float(humidity):g}",
            STICK,
            f"probability of sticking {by}, {Air(float(humidity)).where}",
            float(tilted.stuck.sel(humidity=humidity, bound="low").min()),
            float(tilted.largest_stuck.sel(humidity=humidity, bound="high")),
            *(np.nan, "1", f"{each}fraction of random patches, 95 %", _SOURCE),
        )
        for humidity in tilted.humidity.values
    ]
    most = tilted.isel(humidity=int(tilted.largest_mean.argmax("humidity")))
    low, air = int(most["mean"].argmin("tilt")), Air(float(most.humidity)).where
    numbers = float(most["mean"][low]), float(most.largest_mean), float(most.mean_error[low])
    form = f"{each}random patches; w e / s on smooth surfaces beyond the tilt of a wedge"
    answers.append(Answer(TILTED, HOLD, f"mean pull-off force {by}, {air}", *numbers, "N", form, _SOURCE))
    what, form = "tilt beyond which a longer first side hardly holds more", "e / (f_max a), parallel patches"
    numbers = float(tilted.wedge.min()), float(tilted.wedge.max()), np.nan
    answers.append(Answer(WEDGE, HOLD, what, *numbers, "rad", form, _SOURCE))
    return answers + _freed(tilted, by, f"{each}quantile of the force, 95 %")


def _freed(tilted, by, form):
    """Restoring force that frees all but a small fraction of the stoppers, none with too few patches."""
    bounded = [float(share) for share in tilted.share[tilted.basis == Basis.SAMPLED]]
    if not bounded:
        return []
    force, most = (
        tilted[name].sel(share=min(bounded)).max("humidity") for name in ("safe_force", "largest_safe_force")
    )
    low = int(force.sel(part="safe").argmin("tilt"))
    numbers = float(force.sel(part="safe")[low]), float(most.sel(part="safe")), float(force.sel(part="error")[low])
    what = f"restoring force that frees all but {one_in(min(bounded))}, {by}"
    return [Answer("restoring_force_tilted", FREE, what, *numbers, "N", form, _SOURCE)]
