"""Where results of pairs and devices are beyond the limits of the model, in sentences of `stiction.devices.limits`."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from stiction.beam.cantilever import Beam
from stiction.config.units import typed
from stiction.designs.cracks import Device
from stiction.designs.safe_lengths import EITHER
from stiction.devices import limits
from stiction.stages.cantilevers import Dimensions, Gap, Stiffness, StripLength, cantilever
from stiction.stages.releases import ended

#: Warnings by their subject, such as ``pair b, RH 0.67, G``.
Warnings = dict[str, list[str]]


@dataclass(frozen=True)
class OfPairs:
    """Nominal beams of all pairs, and their strips."""

    solid: Stiffness
    beam: Dimensions
    pairs: dict[str, Gap]
    sampling: StripLength


@dataclass(frozen=True)
class OfDevice:
    """A device and its pair."""

    device: Device
    tip: float  #: length of the strips of tips [m]
    #: Names of the materials of its pair, each with the properties that are stated.
    materials: tuple[tuple[str, Sequence[str]], ...] = ()


def of_beams(beams: xr.Dataset, nominal: Beam, strip: float) -> list[str]:
    """Warnings about the beams of a case of the main line: dataset of stage beams, length of the strips [m]."""
    s_shaped = ended(beams, "S-shape")
    warnings = [limits.arcs_of_elements(float(ended(beams, "arc").mean()), strip)]
    if s_shaped.any():
        mean = float(beams.crack_length.values[s_shaped].mean())
        warnings += [
            limits.cut_off_mean(float(s_shaped.mean()), mean, nominal.length),
            limits.large_rotation(nominal.gap, mean),
            limits.stubby_beam(mean, nominal.thickness),
            limits.wide_beam(nominal.gap, nominal.width, nominal.thickness, mean),
        ]
    return limits.given(*warnings)


def of_device(found: xr.Dataset, of: OfDevice, plastic: float = np.nan) -> list[str]:
    """Warnings about a device at a humidity.

    Parameters
    ----------
    found : Dataset
        Of stage safe_lengths.
    of : OfDevice
    plastic : float
        Plastic share of the contact area; NaN if it was not studied [-].
    """
    device = of.device
    # Slopes are largest and cracks shortest for the shortest of the lengths.
    crack = float(found.estimate.min()) / device.cracks
    sizes = device.gap, device.width, device.thickness, crack, float(found.film), float(found.rms)
    return limits.of_cantilever(*sizes) + limits.given(
        limits.stretched_bridge(device.gap, device.thickness) if device.kind == "bridge" else None,
        limits.short_wedge(of.tip, float(found.wedge)) if EITHER in found["shape"] else None,
        None if np.isnan(plastic) else limits.plastic_contact(plastic),
        *(limits.default_material(name, stated) for name, stated in of.materials),
    )


def _plastic_share(plasticity, pair):
    """Plastic share of the contact area of a pair from the datasets of study plasticity; NaN if there is none."""
    return float(plasticity[pair].plastic_share) if pair in plasticity else np.nan


def of_pairs(
    beams: Mapping[tuple[str, float, str], xr.Dataset], plasticity: Mapping[str, xr.Dataset], plain: dict[str, Any]
) -> Warnings:
    """Warnings about the main line.

    Parameters
    ----------
    beams : dict
        Pair, humidity and model to the dataset of stage beams.
    plasticity : dict
        Pair to the dataset of study plasticity, as far as it was studied.
    plain : dict
        Settings of a job, `OfPairs` in units of the configuration.
    """
    settings = typed(OfPairs, plain)
    shares = {pair: _plastic_share(plasticity, pair) for pair in settings.pairs}
    found = {f"pair {pair}": limits.given(limits.plastic_contact(share)) for pair, share in shares.items() if share > 0}
    for (pair, humidity, model), dataset in beams.items():
        nominal = cantilever(settings, pair)
        found[f"pair {pair}, RH {humidity:g}, {model}"] = of_beams(dataset, nominal, settings.sampling.strip_length)
    return found


def of_devices(
    found: Mapping[tuple[str, float], xr.Dataset],
    plasticity: Mapping[str, xr.Dataset],
    plain: Mapping[str, dict[str, Any]],
) -> dict[tuple[str, float], list[str]]:
    """Warnings about all devices by name and humidity.

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
        (name, humidity): of_device(dataset, settings[name], _plastic_share(plasticity, settings[name].device.pair))
        for (name, humidity), dataset in found.items()
    }


def of_stoppers(plasticity: Mapping[str, xr.Dataset], plain: Mapping[str, dict[str, Any]]) -> dict[str, list[str]]:
    """Warnings about stoppers by name.

    Parameters
    ----------
    plasticity : dict
        As in `of_pairs`.
    plain : dict
        Settings of a job: name to its ``pair`` and the ``materials`` as in `OfDevice`.
    """
    shares = {name: _plastic_share(plasticity, section["pair"]) for name, section in plain.items()}
    return {
        name: limits.given(
            None if np.isnan(shares[name]) else limits.plastic_contact(shares[name]),
            *(limits.default_material(material, stated) for material, stated in section["materials"]),
        )
        for name, section in plain.items()
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


def as_markdown(of_pairs: Warnings, of_devices: Mapping[tuple[str, float], list[str]]) -> str:
    """All warnings of a run as a page."""
    subjects = of_pairs | {f"{name}, RH {humidity:g}": found for (name, humidity), found in of_devices.items()}
    lines = [f"- {subject}: {sentence}" for subject, found in subjects.items() for sentence in found]
    none = ["No result is beyond the limits of the model that are checked."]
    return "\n".join(["# Where results are beyond the model", "", *(lines or none), "", limits.NOT_MODELLED, ""])
