"""Beams of a case under one variant, i.e. one model choice changed: the stages after its contact."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.analysis.variants import Variant
from stiction.chaos.model import Truncation, fit
from stiction.config.cases import Case
from stiction.contact.environment import Water
from stiction.plan.stage import Running, Stage
from stiction.stages.beams import releases
from stiction.stages.contact import corrections, curves
from stiction.stages.contact.contact import first


@dataclass(frozen=True, kw_only=True)
class Settings(releases.OnStrips):
    """Settings of the stages after contact: samples of it, water, force laws and beams without scatter."""

    samples: int  #: number of pairs of surfaces, the first of the contact
    water: Water
    chaos: Truncation


def compute(contact: xr.Dataset, case: Case, settings: Settings) -> xr.Dataset:
    """Run the stages after contact at the humidity of a case. Model NG, nominal dimensions."""
    vectors, limit = curves.vectors(first(contact, settings.samples), case.humidity, settings.water)
    model = fit(vectors, limit, settings.chaos.order, settings.chaos.dimension_tolerance)
    beams = releases.without_scatter(settings, settings.beam.samples)
    return layout([case.humidity], [vectors[:, 0]], [releases.release_beams(model, case, beams)])


def layout(humidities: Sequence[float], energies: Sequence, beams: Sequence[dict]) -> xr.Dataset:
    """Dataset of the crack lengths of a pair under one variant, at some humidities [-].

    The energies of the sampled pairs are (n_rh, m) [J m⁻²], the beams of each humidity arrays of
    :func:`stiction.beam.montecarlo.columns`.
    """
    return xr.Dataset(
        {
            "adhesion_energy": (("humidity", "strip"), energies),
            "crack_length": (("humidity", "beam"), [b["crack_length"] for b in beams]),
            "state": (("humidity", "beam"), np.array([b["state"] for b in beams], np.int8), releases.FLAGS),
        },
        coords={"humidity": list(humidities)},
    )


def by_pair(cases: Mapping[tuple[str, float, str], xr.Dataset]) -> dict[tuple[str, str], xr.Dataset]:
    """Datasets of all humidities by pair and variant, from those by pair, humidity and variant."""
    cases_of = {}
    for (pair, _, variant), dataset in sorted(cases.items(), key=lambda item: item[0][1]):
        cases_of.setdefault((pair, variant), []).append(dataset)
    along_humidity = {"data_vars": "all", "coords": "different", "compat": "equals", "join": "exact"}
    keys = dict.fromkeys((pair, variant) for pair, _, variant in cases)
    return {key: xr.concat(cases_of[key], "humidity", **along_humidity) for key in keys}


def cases_of(dataset: xr.Dataset) -> Iterator[tuple[float, Variant]]:
    """Yield every case of the dataset: relative humidity [-] and the results under the variant."""
    for k, humidity in enumerate(dataset.humidity.values):
        in_air = dataset.isel(humidity=k)
        stuck = releases.ends_as(in_air, "S-shape")
        yield float(humidity), Variant(in_air.adhesion_energy.values, in_air.crack_length.values, stuck)


def _inputs(plan, at):
    """Contact of the pair of a case under a variant, possibly shared with other variants.

    That of the base is the contact of the main line, unless the variants have more samples.
    """
    pair, shared = at.case.pair, plan.variants.contact_under(at.variant)
    other = f"studies/variants/{'islands' if plan.variants.has_islands(shared) else 'contact'}/{pair}_{shared}"
    of_main_line = shared == "base" and plan.variants.has_samples
    return {"contact": f"contact/{pair}_NG" if of_main_line else other} | corrections.correction_inputs(
        plan, pair, [at.case.humidity], at.variant
    )


def _settings(plan, at):
    """Stages after contact under a variant: samples of the contact, water, force laws and beams without scatter."""
    study = plan.config["studies"]["variants"]
    water = plan.variants.water(at.case.pair, at.variant)
    laws = {"chaos": plan.config["chaos"], "water": water, "samples": study["samples"]}
    nominal = releases.sections(plan, at.case)
    beam = nominal["beam"] | {"samples": study["beams"]} | plan.variants.finer_beams.get(at.variant, {})
    return nominal | laws | {"beam": beam}


STAGES = (
    Stage.writing(
        "variant",
        "studies/variants/{case}_{variant}",
        inputs=_inputs,
        settings=_settings,
        kind=Settings,
        running=Running(first=lambda settings: {"strip": slice(settings.samples)}),
        complete=corrections.with_all_corrections,
        compute=compute,
        message="Crack lengths of {case} under variant {variant}.",
    ),
)
