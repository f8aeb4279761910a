"""Contact of a pair with its measured surfaces evaluated by the other choice of ``beyond`` or of ``heights``."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from stiction.models import ALTERNATIVES_OF_SCANS
from stiction.plan.stage import select
from stiction.stages.contact import contact as stage_contact
from stiction.stages.contact import pairs
from stiction.stages.contact.changes.patches import PatchChange
from stiction.stages.surfaces import estimate as stage_estimate
from stiction.stages.surfaces import measured_heights, measured_spectrum
from stiction.stages.surfaces.rough_surfaces import sides_of, surface_inputs
from stiction.stages.surfaces.spectrum import SpectrumUse


@dataclass(frozen=True)
class EstimateParts:
    """Parts taken from an estimate."""

    heights: str  #: ``moments`` or ``measured``
    psd: str  #: ``fitted`` or ``tabulated``
    beyond: str  #: ``cut`` or ``continued``


@dataclass(frozen=True, kw_only=True)
class Settings(pairs.Settings):
    """Settings of the contact, and the sources of the measured surfaces."""

    sources: dict[str, EstimateParts]  #: of the measured surfaces, by name


def compute(
    surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]],
    estimates: Mapping[str, xr.Dataset],
    pair: str,
    choice: str,
    settings: Settings,
) -> xr.Dataset:
    """Contact with the other value of a choice, for all measured surfaces of the pair. Surfaces as in stage contact.

    Samples have the random numbers of the base; another cut-off gives another surface nevertheless. The estimates are
    by measured surface, the choice is a key of `stiction.models.ALTERNATIVES_OF_SCANS`.
    """
    with_options = [
        as_is if name not in estimates else _otherwise(name, estimates[name], choice, settings)
        for name, as_is in zip(settings.surfaces, surfaces, strict=True)
    ]
    return stage_contact.compute(with_options, pair, "NG", settings)


def from_surfaces(data: Mapping[str, Any], pair: str, choice: str, settings: Settings) -> xr.Dataset:
    """Compute from the datasets of both surfaces by stage and the estimates of the measured ones."""
    return compute(sides_of(data), data["estimates"], pair, choice, settings)


def _otherwise(name, estimate, choice, settings):
    """Datasets of stages heights and spectrum of a measured surface with the other value of a choice."""
    source = other(settings.sources[name], choice)
    if source.heights == "moments" and np.isnan(stage_estimate.distance(estimate)):
        source = replace(source, heights="measured")  # the only one that exists
    if not stage_estimate.is_resolved(estimate):
        source = replace(source, beyond="cut")  # as is no power law that could go on
    heights = measured_heights.compute(estimate, name, source.heights)
    sampling = settings.sampling
    use = SpectrumUse(name, sampling.strip_length, sampling.margin)
    spectrum = measured_spectrum.Settings(source.psd, source.beyond, sampling.spacing, use)
    return heights, measured_spectrum.compute(estimate, heights, spectrum)


def other(source: EstimateParts, choice: str) -> EstimateParts:
    """Source with the other value of a choice.

    Examples
    --------
    >>> other(EstimateParts("moments", "fitted", "cut"), "beyond")
    EstimateParts(heights='moments', psd='fitted', beyond='continued')
    """
    first, second = ALTERNATIVES_OF_SCANS[choice]
    return replace(source, **{choice: second if getattr(source, choice) == first else first})


def _with_sources(plan, at, patch_kind):
    """Settings with the sources of the measured surfaces."""
    entries = {name: plan.config["surfaces"][name] for name in plan.scans.sides(at.pair)}
    sources = {name: select(EstimateParts, entry) for name, entry in entries.items()}
    return patch_kind.settings(plan, at, patch_kind.fewer(plan, at)) | {"sources": sources}


def _with_estimates(plan, at, _name_of):
    """Two surfaces, and the estimates of the measured ones."""
    return surface_inputs(plan, at.pair) | {
        "estimates": {name: f"estimate/{name}" for name in plan.scans.sides(at.pair)}
    }


#: An option for the evaluation of scans.
SCAN_OPTION = PatchChange(
    words="with the other value of {choice}",
    end="_{choice}",
    inputs=_with_estimates,
    settings=_with_sources,
    kind=Settings,
    compute=from_surfaces,
)
