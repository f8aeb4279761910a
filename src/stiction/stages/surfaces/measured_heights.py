"""Heights of a measured surface (Sec. II-A): the dataset of stage heights from stage estimate."""

import xarray as xr

from stiction.plan.stage import Stage
from stiction.scans.moments import moments_of
from stiction.stages.surfaces import estimate as stage_estimate
from stiction.stages.surfaces import heights as stage_heights
from stiction.surface.feasible import Moments
from stiction.surface.translation import Translation


def compute(estimate: xr.Dataset, surface: str, heights: str) -> xr.Dataset:
    """Density of the measured moments, of the nearest feasible ones, or of the measured quantiles.

    The heights are ``moments`` (maximum entropy) or ``measured``; messages name the surface.

    Raises
    ------
    ValueError
        If the density of the moments is asked for, and neither these nor any near them have one.
    """
    try:
        density = stage_estimate.density(estimate, heights)
    except ValueError as reason:
        raise ValueError(f"surfaces.{surface}.heights is {heights}, but {reason}") from None
    if heights == "moments":
        shape, distance = stage_estimate.feasible(estimate), stage_estimate.distance(estimate)
    else:
        shape, distance = map(float, moments_of(Translation(density))[1:]), 0.0
    moments = stage_heights.Settings(stage_estimate.rms(estimate), *shape)
    return stage_heights.layout(density, moments, Moments(*stage_estimate.shape(estimate), distance))


STAGES = (
    Stage.writing(
        "heights_of_scans",
        "heights/{surface}",
        surfaces=lambda plan: plan.scans.surfaces,
        inputs=lambda plan, at: {"estimate": f"estimate/{at.surface}"},
        settings=lambda plan, at: {
            "surface": at.surface,
            "heights": plan.config["surfaces"][at.surface]["heights"],
        },
        compute=compute,
        label="heights",
        message="Height density of measured surface {surface} (Sec. II-A).",
    ),
)
