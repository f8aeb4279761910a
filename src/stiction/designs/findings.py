"""Where results of pairs and devices are beyond the limits of the model, in sentences of `stiction.devices.limits`."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np
import xarray as xr

from stiction.beam.cantilever import Beam
from stiction.config.units import from_si, typed
from stiction.contact.meniscus import meniscus_height
from stiction.designs.releases import DesignedBeam
from stiction.designs.sticking import EITHER, MIDDLE, S_SHAPE
from stiction.devices import limits
from stiction.stages.cantilevers import Dimensions, Gap, Stiffness, StripLength, cantilever
from stiction.stages.curves import Water
from stiction.stages.releases import ended, stuck_lengths

#: Warnings by their subject, such as ``pair b, RH 0.67, G``.
Warnings = dict[str, list[str]]
#: Names of materials, each with the properties that are stated.
Materials = Sequence[tuple[str, Sequence[str]]]
#: Shapes in words: what holds a device that sticks.
HELD_BY = {S_SHAPE: "beam", EITHER: "beam or tip", MIDDLE: "middle"}


@dataclass(frozen=True)
class OfPairs:
    """Nominal beams of all pairs, and their strips."""

    solid: Stiffness
    beam: Dimensions
    pairs: dict[str, Gap]
    sampling: StripLength
    water: dict[str, Water]  #: by pair


@dataclass(frozen=True)
class OfDevice:
    """A device and its pair."""

    device: DesignedBeam
    materials: Materials = ()  #: of its pair


@dataclass(frozen=True)
class OfStopper:
    """A stopper and its pair."""

    pair: str
    water: Water
    contact: tuple[float, float]  #: sides of the patch [m]
    humidities: tuple[float, ...]  #: of the stopper [-]
    worst_humidities: tuple[float, float]  #: ends of the axis along which the worst humidity is sought [-]
    materials: Materials = ()  #: of its pair


def height(humidity: float, water: Water) -> float:
    """Height h_C of the film at a relative humidity [m]."""
    return float(meniscus_height(humidity, water.temperature, water.contact_angles))


def of_beams(beams: xr.Dataset, nominal: Beam, strip: float) -> list[str]:
    """Warnings about the beams of a case of the main line: dataset of stage beams, length of the strips [m]."""
    s_shaped = ended(beams, "S-shape")
    warnings = [limits.arcs_of_elements(float(ended(beams, "arc").mean()), strip)]
    if s_shaped.any():
        mean = float(stuck_lengths(beams).mean())
        warnings += [
            limits.cut_off_mean(float(s_shaped.mean()), mean, nominal.length),
            limits.large_rotation(nominal.gap, mean),
            limits.stubby_beam(mean, nominal.thickness),
            limits.wide_beam(nominal.gap, nominal.width, nominal.thickness, mean),
        ]
    return limits.given(*warnings)


def of_device(found: xr.Dataset, of: OfDevice, plastic: float = np.nan) -> dict[str, list[str]]:
    """Warnings about a device at a humidity, by the shape in which it sticks.

    Each shape is checked at the shortest of its lengths, where slopes are largest.

    Parameters
    ----------
    found : Dataset
        Of stage safe_lengths.
    of : OfDevice
    plastic : float
        Plastic share of the contact area; NaN if it was not studied [-].
    """
    shortest = found.safe_length.min("share")
    return {
        shape: _of_length(float(shortest.sel(shape=shape)), found, of, plastic)
        for shape in map(str, found["shape"].values)
    }


def of_chart(
    found: Sequence[xr.Dataset], of: OfDevice, plastic: float = np.nan
) -> dict[tuple[float, float, str], list[str]]:
    """Warnings about the chart of a device by thickness [m], gap [m] and shape.

    Each curve is checked at its shortest length.

    Parameters
    ----------
    found : sequence
        Datasets of stage chart, one for each humidity.
    of, plastic
        As in `of_device`.
    """
    warnings = {}
    for thickness, gap, shape in curves(found[0]):
        along = [one.sel(thickness=thickness, gap=gap, shape=shape) for one in found]
        shortest = min(along, key=lambda one: float(one.safe_length.min()))
        of_size = replace(of, device=replace(of.device, thickness=thickness, gap=gap))
        length = float(shortest.safe_length.min())
        warnings[thickness, gap, shape] = _of_length(
            length, shortest, of_size, plastic, min(float(one.film) for one in along)
        )
    return warnings


def curves(chart: xr.Dataset) -> list[tuple[float, float, str]]:
    """Thickness [m], gap [m] and shape of every curve of a dataset of stage chart."""
    return list(product(*(chart[name].values.tolist() for name in ("thickness", "gap", "shape"))))


def _of_length(length, found, of, plastic, thinnest=None):
    """Warnings about a device of a length [m]; film and rms from a dataset.

    The thinnest film [m] is that of the dataset, or along the axis of a chart.
    """
    device = of.device
    sizes = device.gap, device.width, device.thickness, length / device.arms
    return limits.of_beam(*sizes, float(found.film), float(found.rms)) + limits.given(
        limits.thin_film(thinnest or float(found.film)),
        limits.stretched_bridge(device.gap, device.thickness) if device.is_bridge else None,
        *_of_contact(plastic, of.materials),
    )


def _of_water(of):
    """Warnings, or None, about the thinnest and the thickest film on the patch of a stopper."""
    films = [height(humidity, of.water) for humidity in (*of.humidities, *of.worst_humidities)]
    return limits.thin_film(min(films)), limits.wide_meniscus(max(films), of.contact)


def _of_contact(plastic, materials, effect=limits.SHORTER):
    """Warnings, or None, about the contact of a pair."""
    defaults = (limits.default_material(name, stated) for name, stated in materials)
    return [limits.plastic_contact(plastic, effect), *defaults]


def _plastic_share(plasticity, pair):
    """Plastic share of the contact area of a pair from the datasets of study plasticity; NaN if there is none."""
    return float(plasticity[pair].plastic_share) if pair in plasticity else np.nan


def of_pairs(
    beams: Mapping[tuple[str, float, str], xr.Dataset],
    plasticity: Mapping[str, xr.Dataset],
    materials: Mapping[str, Materials],
    plain: dict[str, Any],
) -> Warnings:
    """Warnings about the main line.

    Parameters
    ----------
    beams : dict
        Pair, humidity and model to the dataset of stage beams.
    plasticity : dict
        Pair to the dataset of study plasticity, as far as it was studied.
    materials : dict
        Pair to the names of its materials, each with the properties that are stated.
    plain : dict
        Settings of a job, `OfPairs` in units of the configuration.
    """
    settings = typed(OfPairs, plain)
    found = {
        f"pair {pair}": limits.given(*_of_contact(_plastic_share(plasticity, pair), materials[pair]))
        for pair in settings.pairs
    }
    for (pair, humidity, model), dataset in beams.items():
        nominal = cantilever(settings, pair)
        film = limits.given(limits.thin_film(height(humidity, settings.water[pair])))
        found[f"pair {pair}, RH {humidity:g}, {model}"] = film + of_beams(
            dataset, nominal, settings.sampling.strip_length
        )
    return found


def of_thin_films(cases: Iterable[tuple[str, float, str]], plain: Mapping[str, dict[str, Any]]) -> list[str]:
    """Warnings about films that are hardly a liquid, one for each pair and humidity of some cases.

    Parameters
    ----------
    cases : iterable of tuple
        Pair, humidity and model.
    plain : dict
        Water by pair in units of the configuration.
    """
    films = {(pair, humidity): height(humidity, typed(Water, plain[pair])) for pair, humidity, _ in cases}
    found = {case: limits.thin_film(film) for case, film in films.items()}
    return [f"Pair {pair}, RH {humidity:g}: {sentence}" for (pair, humidity), sentence in found.items() if sentence]


def of_devices(
    found: Mapping[tuple[str, float], xr.Dataset],
    plasticity: Mapping[str, xr.Dataset],
    plain: Mapping[str, dict[str, Any]],
) -> dict[tuple[str, float, str], list[str]]:
    """Warnings about all devices by name, humidity and shape.

    Parameters
    ----------
    found : dict
        Name and humidity to the dataset of stage safe_lengths.
    plasticity : dict
        As in `of_pairs`.
    plain : dict
        Settings of a job: name to `OfDevice` in units of the configuration.
    """
    settings = {name: typed(OfDevice, section) for name, section in plain.items()}
    return {
        (name, humidity, shape): sentences
        for (name, humidity), dataset in found.items()
        for share in [_plastic_share(plasticity, settings[name].device.pair)]
        for shape, sentences in of_device(dataset, settings[name], share).items()
    }


def of_charts(
    found: Mapping[tuple[str, float], xr.Dataset],
    plasticity: Mapping[str, xr.Dataset],
    plain: Mapping[str, dict[str, Any]],
) -> dict[tuple[str, float, float, str], list[str]]:
    """Warnings about all charts by name, thickness [m], gap [m] and shape; parameters as in `of_devices`."""
    warnings = {}
    for name in dict.fromkeys(name for name, _ in found):
        of = typed(OfDevice, plain[name])
        datasets = [dataset for (device, _), dataset in found.items() if device == name]
        of_curves = of_chart(datasets, of, _plastic_share(plasticity, of.device.pair))
        warnings |= {(name, *curve): sentences for curve, sentences in of_curves.items()}
    return warnings


def of_stoppers(plasticity: Mapping[str, xr.Dataset], plain: Mapping[str, dict[str, Any]]) -> dict[str, list[str]]:
    """Warnings about stoppers by name.

    Parameters
    ----------
    plasticity : dict
        As in `of_pairs`.
    plain : dict
        Settings of a job: name to `OfStopper` in units of the configuration.
    """
    return {
        name: limits.given(
            *_of_water(of), *_of_contact(_plastic_share(plasticity, of.pair), of.materials, limits.STRONGER)
        )
        for name, section in plain.items()
        for of in [typed(OfStopper, section)]
    }


def numbered(warnings: Mapping[Any, list[str]]) -> tuple[list[str], dict[Any, list[int]]]:
    """Different sentences in their order, and the numbers, from 1, of those of each subject.

    Examples
    --------
    >>> numbered({"a": ["x.", "y."], "b": ["y."]})
    (['x.', 'y.'], {'a': [1, 2], 'b': [2]})
    """
    sentences = list(dict.fromkeys(sentence for found in warnings.values() for sentence in found))
    return sentences, {key: [sentences.index(one) + 1 for one in found] for key, found in warnings.items()}


def subjects(
    devices: Mapping[tuple[str, float, str], list[str]],
    charts: Mapping[tuple[str, float, float, str], list[str]],
    stoppers: Mapping[str, list[str]],
) -> Warnings:
    """Warnings of `of_devices`, `of_charts` and `of_stoppers` by their subjects in words."""
    found = {f"{name}, RH {rh:g}, held by the {HELD_BY[shape]}": each for (name, rh, shape), each in devices.items()}
    for (name, thickness, gap, shape), each in charts.items():
        size = f"{from_si(thickness, 'um'):g} µm thick, gap {from_si(gap, 'um'):g} µm"
        found[f"{name}, chart, {size}, held by the {HELD_BY[shape]}"] = each
    return found | stoppers


def as_markdown(warnings: Warnings) -> str:
    """Warnings as a page, each sentence with all its subjects."""
    sentences, _ = numbered(warnings)
    about = [[subject for subject, found in warnings.items() if sentence in found] for sentence in sentences]
    lines = [f"- {'; '.join(names)}: {sentence}" for names, sentence in zip(about, sentences, strict=True)]
    none = ["No result is beyond the limits of the model that are checked."]
    return "\n".join(["# Where results are beyond the model", "", *(lines or none), "", limits.NOT_MODELLED, ""])
