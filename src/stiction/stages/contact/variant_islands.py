"""Contact of a pair under a variant whose asperities are islands, found again at every distance.

They are not stored as summits are: there are many times as many, and they depend on the distances.
"""

import xarray as xr

from stiction.config.units import in_si
from stiction.contact.pair import SurfacePair, contacts_of_samples
from stiction.plan.stage import Stage
from stiction.progress import progress
from stiction.stages.contact import contact as stage_contact
from stiction.stages.contact import variant_contact, variant_summits
from stiction.stages.contact.pairs import asperity_of, streams_of_sides


def compute(surfaces: tuple, solids: variant_contact.Settings) -> xr.Dataset:
    """Contact of all samples; arguments of `stiction.stages.contact.variant_summits.equivalent_under`, and solids."""
    _, name, _, changed, _ = surfaces
    drawn = variant_summits.equivalent_under(*surfaces)
    pair = SurfacePair(**vars(drawn), asperity=asperity_of(solids))
    samples = range(changed.contact.samples)
    streams = streams_of_sides(changed.seed, name)
    (curves,) = contacts_of_samples([pair], streams, progress(samples, "surface pairs"))
    return stage_contact.layout(*curves, pair.distances, samples)


def _settings(plan, at):
    """Surfaces and solids of a pair under a variant."""
    return plan.variants.summits(at.pair, at.variant) | {"solids": plan.variants.solids(at.pair, at.variant)}


STAGES = (
    Stage.writing(
        "variant_islands",
        "studies/variants/islands/{pair}_{variant}",
        inputs=variant_summits.inputs,
        settings=_settings,
        compute=lambda data, at, settings: compute(
            variant_summits.arguments(data, at, settings), in_si(variant_contact.Settings, settings["solids"])
        ),
        label="contact",
        message="Contact of islands of pair {pair} under variant {variant}.",
        cluster=True,
        minutes=30,
    ),
)
