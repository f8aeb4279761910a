"""Contact of a pair under a variant, i.e. one changed model choice: its summits, and the contact of solids on them.

The summits depend neither on the elasticity of the solids nor on their attraction, so that variants of the solids share
them. Islands are found again at every distance instead: there are many times as many.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr

from stiction.config.merging import merged
from stiction.config.units import in_si
from stiction.contact.materials import Solid
from stiction.contact.pair import (
    DistanceGrid,
    EquivalentSurface,
    Summits,
    SurfacePair,
    contacts_of_samples,
    solid_pressure,
)
from stiction.plan.stage import Running
from stiction.progress import progress
from stiction.stages.contact import contact as stage_contact
from stiction.stages.contact.changes.patches import PatchChange
from stiction.stages.contact.pairs import Contact, SolidBySide, asperity_of, equivalent_surface, streams_of_sides
from stiction.stages.surfaces import heights as stage_heights
from stiction.stages.surfaces import spectrum as stage_spectrum
from stiction.stages.surfaces.rough_surfaces import Sampling, Width
from stiction.surface.replica import Coherence
from stiction.surface.spectrum import CutoffSelfAffine


@dataclass(frozen=True)
class DrawnSurface:
    """Description of one surface, for drawing it."""

    rms: float  #: [m]
    skewness: float  #: [-]
    kurtosis: float  #: [-]
    psd: str  #: source of the spectrum, ``published`` or ``identified``
    published_psd: CutoffSelfAffine | None = None  #: Eq. (7)


@dataclass(frozen=True)
class Sides:
    """Names of the two surfaces of a pair."""

    beam: str
    substrate: str


@dataclass(frozen=True)
class Settings:
    """Settings of the summits of a pair, with its surfaces."""

    seed: int
    sampling: Sampling
    contact: Contact
    beam: Width
    pairs: dict[str, Sides]
    surfaces: dict[str, DrawnSurface]
    replica: Coherence | None = None  #: of the two surfaces


@dataclass(frozen=True)
class SolidsOfPair:
    """Solids of a pair. Everything else about the contact is determined by the summits."""

    solid: Solid
    van_der_waals: str
    materials: SolidBySide = field(default_factory=dict)


# Surfaces


def equivalent_under(
    identifications: Mapping[str, xr.Dataset],
    pair: str,
    base: Settings,
    changed: Settings,
    measured: Mapping[str, tuple[xr.Dataset, xr.Dataset]] | None = None,
) -> EquivalentSurface:
    """Surfaces under the changed settings, the same as those of the base, even if drawn on a different grid.

    Identifications are by surface whose spectrum is identified; ``measured`` has the datasets (heights, spectrum) of
    the surfaces described by scans.

    Raises
    ------
    ValueError
        If an identified spectrum must not be used, see `stiction.stages.surfaces.spectrum.refuse_misuse`.
    """
    for name, identification in identifications.items():
        stage_spectrum.refuse_misuse(
            identification, stage_spectrum.SpectrumUse(name, changed.sampling.strip_length, changed.sampling.margin)
        )
    surfaces = surfaces_of(base.pairs[pair], base.surfaces, base.sampling.spacing, identifications, measured)
    return equivalent_surface(surfaces, "NG", changed)


def surfaces_of(
    sides: Sides,
    surfaces: Mapping[str, DrawnSurface],
    spacing: float,
    identifications: Mapping[str, xr.Dataset],
    measured: Mapping[str, tuple[xr.Dataset, xr.Dataset]] | None = None,
) -> list[tuple[xr.Dataset, xr.Dataset]]:
    """Datasets (heights, spectrum) of the surfaces of beam and substrate, computed by their stages.

    ``surfaces`` describes those without scans by name; spacing of the grid [m]; the others as in `equivalent_under`.
    """
    datasets = measured or {}
    return [
        datasets[name] if name in datasets else _datasets(surfaces[name], spacing, identifications.get(name))
        for name in (sides.beam, sides.substrate)
    ]


def _datasets(surface, spacing, identification):
    """Datasets of stages heights and spectrum of one surface."""
    heights = stage_heights.compute(stage_heights.Settings(surface.rms, surface.skewness, surface.kurtosis))
    psd = surface.published_psd if surface.psd == "published" else "identified"
    return heights, stage_spectrum.compute(heights, stage_spectrum.Settings(spacing, psd), identification)


# Summits


def summits_under(
    identifications: Mapping[str, xr.Dataset],
    pair: str,
    base: Settings,
    changed: Settings,
    measured: Mapping[str, tuple[xr.Dataset, xr.Dataset]] | None = None,
) -> xr.Dataset:
    """Summits of all samples under the changed settings, arguments of `equivalent_under`."""
    equivalent = equivalent_under(identifications, pair, base, changed, measured)
    streams = streams_of_sides(changed.seed, pair)
    summits, areas = [], []
    for k in progress(range(changed.contact.samples), "surface pairs"):
        heights = equivalent.draw(*streams(k))
        summits.append(equivalent.summits(heights))
        areas.append(equivalent.bearing_area(heights))
    return layout(summits, areas, equivalent.distances)


def layout(summits: Sequence[Summits], bearing_areas: Sequence[np.ndarray], grid: DistanceGrid) -> xr.Dataset:
    """Dataset of the summits of all samples above the mean plane, found in equal areas, and of their bearing areas."""
    above = [of_sample.tops > 0 for of_sample in summits]
    tops, curvatures = (
        np.concatenate([values[above_mean] for values, above_mean in zip(column, above, strict=True)])
        for column in ([of_sample.tops for of_sample in summits], [of_sample.curvatures for of_sample in summits])
    )
    return xr.Dataset(
        {
            "top": ("summit", tops.astype(np.float32)),  # drawn in single precision
            "curvature": ("summit", curvatures),
            "count": ("strip", np.array([above_mean.sum() for above_mean in above])),
            "area": ((), summits[0].area),
            "bearing_area": (("strip", "height"), np.array(bearing_areas, np.float32)),
            "step": ((), grid.step),
            "below": ((), grid.below),
        },
        coords={"height": ("height", grid.bearing)},
    )


def samples_of(dataset: xr.Dataset) -> Iterator[Summits]:
    """Summits of each sample."""
    ends = np.cumsum(dataset["count"].values)[:-1]
    tops, curvatures = (np.split(dataset[name].values.astype(float), ends) for name in ("top", "curvature"))
    for sample in zip(tops, curvatures, strict=True):
        yield Summits(*sample, float(dataset.area))


def distances(dataset: xr.Dataset) -> DistanceGrid:
    """Grid of the distances."""
    below = int(dataset.below)
    return DistanceGrid(float(dataset.step), below, dataset.sizes["height"] - below)


def inputs(plan: Any, at: Any) -> dict[str, dict[str, str]]:
    """Identifications of the surfaces under a variant, and datasets of the measured surfaces of the pair."""
    identified = plan.variants.summits(at.pair, at.variant)["identified"]
    measured = plan.scans.sides(at.pair)
    return {"identifications": {name: f"identification/{name}" for name in identified}} | {
        stage: {name: f"{stage}/{name}" for name in measured} for stage in ("heights", "spectrum")
    }


def summits_of_job(data: Mapping[str, Any], pair: str, settings: dict[str, Any]) -> xr.Dataset:
    """Summits of all samples, from the inputs and plain settings of a job."""
    return summits_under(*arguments(data, pair, settings))


def arguments(data: Mapping[str, Any], pair: str, settings: dict[str, Any]) -> tuple:
    """Arguments of `equivalent_under` from the inputs and plain settings of a job."""
    measured = {name: (heights, data["spectrum"][name]) for name, heights in data["heights"].items()}
    both_settings = (
        in_si(Settings, section) for section in (settings["base"], merged(settings["base"], settings["changes"]))
    )
    return data["identifications"], pair, *both_settings, measured


# Contact


def contact_of(summits: xr.Dataset, settings: SolidsOfPair) -> xr.Dataset:
    """Contact of solids on the summits of a pair, as in stage contact."""
    model, grid = asperity_of(settings), distances(summits)
    pressures = [solid_pressure(model, sample, grid) for sample in samples_of(summits)]
    areas = summits.bearing_area.values
    return stage_contact.layout(np.array(pressures), areas, grid, range(len(areas)))


def contact_of_islands(data: Mapping[str, Any], pair: str, settings: dict[str, Any]) -> xr.Dataset:
    """Contact of all samples with islands as asperities, from the inputs and plain settings of a job."""
    surfaces, solids = arguments(data, pair, settings), in_si(SolidsOfPair, settings["solids"])
    _, _, _, changed, _ = surfaces
    islands = SurfacePair(**vars(equivalent_under(*surfaces)), asperity=asperity_of(solids))
    samples = range(changed.contact.samples)
    streams = streams_of_sides(changed.seed, pair)
    (curves,) = contacts_of_samples([islands], streams, progress(samples, "surface pairs"))
    return stage_contact.layout(*curves, islands.distances, samples)


def _summit_settings(plan, at, patch_kind):
    """Settings of the summits without the variant, and its changes. Patches of devices have the samples of budgets."""
    settings, size = plan.variants.summits(at.pair, at.variant), patch_kind.size(plan, at)
    if size:
        size |= {"contact": {"samples": patch_kind.fewer(plan, at)}}
    return settings | {"base": merged(settings["base"], size)}


#: The summits under a variant of the model, which variants of the solids share.
SUMMITS = PatchChange(
    subject="Summits",
    words="under variant {variant}",
    end="_{variant}",
    inputs=lambda plan, at, name_of: inputs(plan, at),
    settings=_summit_settings,
    kind=None,
    compute=summits_of_job,
    label="variant_summits",
    running=Running(minutes=30),
)


def _on_summits(plan, at, name_of):
    """Summits of the first variant with the same."""
    return {"summits": name_of(SUMMITS, pair=at.pair.pair, variant=plan.variants.with_summits_of(at.pair, at.variant))}


#: A variant of the model: its solids on its summits.
VARIANT = PatchChange(
    words="under variant {variant}",
    end="_{variant}",
    inputs=_on_summits,
    settings=lambda plan, at, patch_kind: plan.variants.solids(at.pair, at.variant),
    kind=SolidsOfPair,
    compute=contact_of,
    running=Running(),
)
#: A variant of the model whose asperities are islands.
VARIANT_OF_ISLANDS = PatchChange(
    subject="Contact of islands",
    words="under variant {variant}",
    end="_{variant}",
    inputs=lambda plan, at, name_of: inputs(plan, at),
    settings=lambda plan, at, patch_kind: (
        _summit_settings(plan, at, patch_kind) | {"solids": plan.variants.solids(at.pair, at.variant)}
    ),
    kind=None,
    compute=contact_of_islands,
    running=Running(minutes=30),
)
