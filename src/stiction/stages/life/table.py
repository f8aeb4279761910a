"""Stage life: causes of the contact of a device, its adhesion then, and ways to free it.

Every answer is a number between two bounds, which are equal where the model leaves nothing open, or the keys that give
the number (`stiction.stages.life.unknown`). Voltage and shock of a
beam are those of its length: the stated one, or its least safe length.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from stiction.config.cases import Air
from stiction.config.units import from_si, in_si
from stiction.constants import LIQUIDS
from stiction.devices.risk import one_in
from stiction.plan.stage import Stage, select
from stiction.stages.devices.opening import own_section
from stiction.stages.devices.results import results_of
from stiction.stages.devices.safe_lengths import chosen_share
from stiction.stages.life.answers import HOLD, SAFE, STICK, Answer, in_order, layout
from stiction.stages.life.dimples import dimple_answers
from stiction.stages.life.fast import separated_fast
from stiction.stages.life.freeing import beam_held, stopper_freed
from stiction.stages.life.inputs import OfBeam, OfStopper
from stiction.stages.life.lengths import least_safe, length_of
from stiction.stages.life.separation import of_beam, separation_inputs
from stiction.stages.life.tilt import tilted_answers
from stiction.stages.life.touch import beam_touched, lengths_after_drying, stopper_moved
from stiction.stages.life.touchdowns import beam_after_touchdowns, stopper_after_touchdowns
from stiction.stages.life.unknown import beam_unknown, stopper_unknown
from stiction.stages.life.voltage import beam_at_voltage, stopper_at_voltage


def beam_answers(
    lengths: Mapping[float, xr.Dataset],
    after: Mapping[float, xr.Dataset],
    of: OfBeam,
    biased: Mapping[float, xr.Dataset] | None = None,
    separation: xr.Dataset | None = None,
) -> list[Answer]:
    """Answers about a beam from its safe lengths by humidity: for one touchdown, after all, and at its voltage.

    The dataset of its fast separation is needed where water condenses.
    """
    share = chosen_share(next(iter(lengths.values())))
    safe = {humidity: least_safe(dataset, share) for humidity, dataset in lengths.items()}
    length = length_of(lengths, of)
    answers = [
        Answer(
            f"{SAFE}{humidity:g}",
            STICK,
            f"simulated limit {Air(humidity).where}: at most {one_in(share)} sticks after one touchdown",
            *(value, value, error),
            *("m", f"bound of random beams, 95 %, {basis}", "stage safe_lengths"),
        )
        for humidity, (value, error, basis) in safe.items()
    ]
    answers += beam_touched(of, length) + beam_held(of, length) if 0 < length < np.inf else []
    answers += [answer for name, liquid in of.liquids.items() for answer in lengths_after_drying(of, name, liquid)]
    answers += beam_after_touchdowns(of, share, min(safe.values()), after) if after else []
    answers += separated_fast(lengths, separation) if separation is not None else []
    answers += beam_at_voltage(of, min(safe.values()), biased)
    return in_order(answers + beam_unknown(answers))


def stopper_answers(
    stopper: xr.Dataset,
    of: OfStopper,
    biased: xr.Dataset | None = None,
    tilted: xr.Dataset | None = None,
    separation: xr.Dataset | None = None,
) -> list[Answer]:
    """Answers about a stopper from the datasets of its pull-off forces: as it is, at its voltage, tilted, and fast."""
    worst = int(stopper.mean_along.argmax("axis"))
    mean, error = (float(stopper[name][worst]) for name in ("mean_along", "mean_along_error"))
    where = Air(round(float(stopper.worst_humidity), 2)).where
    answers = [
        Answer(
            f"stuck_{float(humidity):g}",
            STICK,
            f"probability of sticking {Air(float(humidity)).where}",
            *map(float, stopper.stuck.sel(humidity=humidity, bound=["low", "high"])),
            *(np.nan, "1", "fraction of random patches, 95 %", "stage stoppers"),
        )
        for humidity in stopper.humidity.values
    ]
    what = f"mean pull-off force {where}{', the worst air' * (stopper.sizes['axis'] > 1)}"
    answers.append(Answer("force", HOLD, what, mean, mean, error, "N", "largest attraction x area", "stage stoppers"))
    answers += stopper_moved(of) + stopper_freed(stopper, of, separation) + stopper_after_touchdowns(stopper, of)
    answers += [] if tilted is None else tilted_answers(tilted)
    answers += stopper_at_voltage(stopper, of, biased) if of.capacitor else []
    return in_order(answers + stopper_unknown(answers, of, float(stopper.share.max())))


def compute(data: Mapping[str, Any], settings: dict[str, Any]) -> xr.Dataset:
    """Answers about a device, from its safe lengths by humidity or from the forces of a stopper."""
    ((release, own),) = settings.items()
    kind, answers = _OF_RELEASE[release]
    return answers(data, in_si(kind, own))


def _beam(data, of):
    """Answers about a beam."""
    strips, tips = (data.get(name, {}) for name in ("fast_strips", "fast_tips"))
    fast = of_beam(strips, tips, of.device) if strips else None
    answers = beam_answers(data["lengths"], data.get("after", {}), of, data.get("biased"), fast)
    answers += dimple_answers(of, data.get("dimples", {}))
    return layout(in_order(answers), of, length_of(data["lengths"], of))


def _stopper(data, of):
    """Answers about a stopper."""
    more = (data.get(name) for name in ("biased", "tilted", "separation"))
    return layout(stopper_answers(data["stopper"], of, *more), of)


#: Settings, and what makes the dataset, by the name of the release.
_OF_RELEASE = {"beam": (OfBeam, _beam), "stopper": (OfStopper, _stopper)}


def _settings(plan, at):
    """Settings of a device, with the liquids and its density."""
    own, release = {"uncertainty": {}} | plan.devices.stated(at.device), plan.devices.kind(at.device).release
    usual = {name: {"surface_tension_mN_per_m": from_si(tension, "mN_per_m")} for name, tension in LIQUIDS.items()}
    own |= {"liquids": usual | plan.config.get("liquids", {})} | own_section(plan, at.device)
    own |= {"density_kg_per_m3": plan.materials.density(own["pair"])}
    return {release.name: select(_OF_RELEASE[release.name][0], own)}


STAGES = (
    Stage.writing(
        "life",
        "devices/life/{device}",
        inputs=lambda plan, at: results_of(plan, at.device) | separation_inputs(plan, at.device),
        settings=_settings,
        compute=compute,
        message="Life of device {device}.",
    ),
)
