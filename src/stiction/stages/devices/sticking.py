"""Sticking lengths of a device at a humidity and its safe lengths, for safe lengths, charts and curves of roughness."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Protocol

import numpy as np
import xarray as xr

from stiction.beam.energy import arrest_length
from stiction.beam.foundation import foundation_length
from stiction.chaos.model import ChaosModel, Truncation, draw_laws
from stiction.contact import forcelaw
from stiction.contact.correction import NONE, ElasticChange
from stiction.contact.environment import Water, flooded_parts
from stiction.devices import arcs, bridges, risk, strips
from stiction.devices.risk import NO_BOUNDS, Basis, LengthBounds, SafeLength
from stiction.devices.sampling import Move, SampledSurfaces, sampled_surfaces
from stiction.stages.contact import curves
from stiction.stages.contact.error_notes import on_patch
from stiction.stages.devices import opening
from stiction.stages.devices.opening import DesignedBeam
from stiction.streams import stream


class Settings(Protocol):
    """Settings of any job with safe lengths."""

    seed: int
    water: Water
    humidity: float  #: [-]
    shares: tuple[float, ...]  #: p [-]


class BeamSettings(Protocol):
    """Settings of any job with released beams."""

    seed: int
    device: DesignedBeam
    beams: int


class LawSettings(Protocol):
    """Settings of any job with force laws of strips."""

    chaos: Truncation
    water: Water


@dataclass(frozen=True)
class Laws:
    """Force laws of strips at one humidity."""

    model: ChaosModel
    sampled: np.ndarray  #: force laws of the samples (m, 4) [SI]
    is_narrow: bool  #: whether strips are drawn from the samples: the model lacks their mean, scatter or displacements
    repetition: float  #: probability that a strip repeats the law of its neighbour [-]
    #: Change of the energies by full elastic contact, in these laws, of which the errors matter.
    change: ElasticChange = NONE
    displacements: np.ndarray | None = None  #: of the samples from their register (m,) [m], if beams have play

    @property
    def draw(self) -> strips.Draw:
        """Draw of the force laws of independent strips."""
        return partial(strips.resampled, self.sampled) if self.is_narrow else partial(draw_laws, self.model)

    def in_row(self, device: DesignedBeam) -> strips.Draw:
        """Draw of the force laws of strips in a row under a device."""
        of_beam = self.draw if self.displacements is None else strips.of_one_body(self.sampled, self.displacements)
        return strips.in_row(of_beam, self.repetition, device.opening.arms)


@dataclass(frozen=True)
class Ground:
    """Ground of beams of any thickness and gap at one humidity."""

    strips: Laws
    laws: np.ndarray  #: sample of the force laws of strips (k, 4) [SI]
    tips: tuple[np.ndarray, np.ndarray] | None  #: slopes [-] and forces [N/m] of tips; none for a bridge


@dataclass(frozen=True)
class Released:
    """Beams of a device, released on its ground."""

    device: DesignedBeam
    arrested: np.ndarray  #: as from `stiction.stages.devices.opening.arrests` (n,) [m]
    reach: float  #: longest simulated length, if not all devices stick [m]
    foundation: float  #: foundation length [m]
    surfaces: SampledSurfaces  #: their errors
    arc_lengths: np.ndarray | None  #: longest arcs that come free of their tips (n,) [m]; none without a tip

    @property
    def lengths(self) -> dict[str, np.ndarray]:
        """Sticking lengths by shape, (n,) each [m]."""
        return sticking_lengths(self.arrested, self.foundation, self.device, self.arc_lengths)

    def moved(self, move: Move) -> "Released":
        """Beams as on other samples of the same surfaces. ASSUME: their tips are the same, one of each beam."""
        return replace(self, arrested=move(self.arrested), reach=float(move(self.reach)))


def fitted_laws(contact: xr.Dataset, humidity: float, settings: LawSettings, sides: tuple[float, float]) -> Laws:
    """Force laws at a relative humidity, from the contact of strips with these sides [m].

    The contact is from `stiction.stages.contact.contact.with_correlations`.
    """
    with on_patch(*sides):
        vectors, limit = curves.vectors(contact, humidity, settings.water)
    model = opening.fit_chaos(vectors, limit, settings.chaos)
    lawful = forcelaw.admissible(vectors, limit)
    sampled = forcelaw.coefficients(vectors[lawful], limit)
    displacements = curves.displacements(contact, lawful)
    draws = draw_laws(model, strips.DRAWS, stream(0, "narrow"))
    is_narrow = displacements is not None or strips.is_narrow(forcelaw.energy(draws), forcelaw.energy(sampled))
    repetition = strips.repetition(contact.correlations.values)
    return Laws(model, sampled, is_narrow, repetition, settings.water.changes(humidity)[0], displacements)


def ground_of_laws(laws: Laws, settings: BeamSettings) -> Ground:
    """Ground without tips, of the force laws of its strips."""
    return Ground(laws, laws.draw(opening.LAWS, opening.addresses(settings)("mesh")), None)


def with_tips(ground: Ground, tips: xr.Dataset | None, humidity: float, water: Water) -> Ground:
    """Ground with the contact of tips at a relative humidity, ``None`` for a bridge."""
    return ground if tips is None else replace(ground, tips=curves.tip_forces(tips, humidity, water))


def ground(contact: xr.Dataset, tips: xr.Dataset | None, humidity: float, settings: Any) -> Ground:
    """Ground at a relative humidity, from the contact of the strips and of the tips, or ``None`` for a bridge.

    The contact is as of `fitted_laws`, and the settings are `BeamSettings` and `LawSettings`.
    """
    laws = fitted_laws(contact, humidity, settings, (settings.device.strip, settings.device.width))
    return with_tips(ground_of_laws(laws, settings), tips, humidity, settings.water)


def release_beams(device: DesignedBeam, ground: Ground, settings: BeamSettings) -> Released:
    """Released beams of a device, or of one of another thickness and gap, on its ground."""
    mesh = opening.ground_of(device, ground.laws)
    address = opening.addresses(settings)
    draw = ground.strips.in_row(device)
    arrested = opening.arrests(device, mesh, draw, settings.beams, address)
    return released(device, ground, arrested, opening.reach(device, mesh, draw, arrested, address))


def released(device: DesignedBeam, ground: Ground, arrested: np.ndarray, reach: float) -> Released:
    """Released beams of a device from their arrested lengths (n,) and the longest simulated one [m]."""
    sampled, (beam, _) = ground.strips.sampled, opening.ground_of(device, ground.laws)
    on_mean = partial(device.opening.length_on_mean, beam=device.beam)
    surfaces = sampled_surfaces(sampled, device.opening.contribution, on_mean, device.opening.uniform(beam, sampled))
    return Released(
        device,
        arrested,
        reach,
        foundation_length(device.beam, ground.laws),
        surfaces.with_errors(*_errors_of_change(ground.strips.change, sampled, device)),
        None if ground.tips is None else arcs.longest_free(*ground.tips, device.beam),
    )


def _errors_of_change(change, sampled, device):
    """Standard errors of ln l₀ and ln s of laws changed by full elastic contact, of which few strips are computed.

    ASSUME: both are independent. The scatter s follows the power of the energy.
    """
    stronger = sampled * [1 + change.ratio_error, 1, 1, 1]
    lengths = [
        device.opening.length_on_mean(device.opening.contribution(laws), device.beam) for laws in (stronger, sampled)
    ]
    return np.log(lengths[0] / lengths[1]), change.power_error / change.power


def flooded_lengths(device: DesignedBeam, water: Water, humidity: float, edge_radius: float) -> list[float]:
    """Lengths that stick on flats in contact, with water in all gaps where it condenses, one for each end state [m].

    Water, solids, adsorbed films and a voltage all do their work, see `stiction.contact.environment.flooded_parts`. No
    surfaces hold a shorter cantilever along its underside, or a shorter bridge by its middle. The length of a tip, with
    its edge, is no bound: roughness that follows its slope lets it hold harder than a flat one. The radius of a rounded
    edge is in metres.
    """
    attractions = flooded_parts(humidity, water.at(humidity), device.hamaker_constant)
    energy, largest = attractions.sum(axis=0)
    if not device.opening.has_tip:
        return [bridges.least_length(energy, largest, device.beam)]
    return [float(arrest_length(energy, device.beam)), arcs.flat_length(attractions, edge_radius, device.beam)]


def sticking_lengths(
    cracks: np.ndarray, foundation: float, device: DesignedBeam, arc_lengths: np.ndarray | None
) -> dict[str, np.ndarray]:
    """Sticking lengths of devices by shape, (n,) each [m].

    Crack lengths (n,) are infinite for beams that are not S-shaped, or those of bridges that their middle holds [m];
    foundation length [m]; ``arc_lengths`` are the longest arcs that come free (n,) [m], ``None`` without a tip.
    """
    if arc_lengths is None:
        return dict.fromkeys(device.opening.shapes, cracks)
    alone = risk.sticking_lengths(cracks, np.isfinite(cracks), foundation)
    return dict(zip(device.opening.shapes, (alone, risk.with_arcs(alone, arc_lengths)), strict=True))


def lengths_without_samples(
    device: DesignedBeam, water: Water, humidity: float, edge_radius: float, reach: float
) -> dict[str, LengthBounds]:
    """Known lengths of a device without samples, by shape, with the reach of the simulation [m].

    No surfaces hold a bridge up to the length of `flooded_lengths`, but a single tip may hold a shorter beam.
    """
    lengths = flooded_lengths(device, water, humidity, edge_radius)
    safe = 0.0 if device.opening.has_tip else lengths[0]
    return {shape: LengthBounds(reach, flat, safe) for shape, flat in zip(device.opening.shapes, lengths, strict=True)}


def by_shape(beams: Released, settings: Settings, bounds: Mapping[str, LengthBounds]) -> dict[str, list[SafeLength]]:
    """Safe length for every share, by shape. The error of the sampled surfaces is part of the bound."""

    def on_samples(move):
        """Safe lengths given other samples of the surfaces."""
        moved = beams.moved(move)
        ends = {shape: replace(bound, reach=moved.reach) for shape, bound in bounds.items()}
        return _given_surfaces(moved.lengths, settings, ends)

    def numbers(move):
        """Safe lengths and estimates (shapes, shares, 2) [m]."""
        return np.array([[(safe.length, safe.estimate) for safe in row] for row in on_samples(move).values()])

    unmoved, errors = on_samples(lambda lengths: lengths), beams.surfaces.error(numbers)
    return _in_order(
        {
            shape: [
                risk.on_sampled_surfaces(safe, *error, bounds[shape])
                for safe, error in zip(row, errors_of_row, strict=True)
            ]
            for (shape, row), errors_of_row in zip(unmoved.items(), errors, strict=True)
        }
    )


def _in_order(by_shape_and_share):
    """Safe lengths for every share, by shape, in the order of `stiction.devices.risk.in_order`."""
    shares = [safe.share for safe in next(iter(by_shape_and_share.values()))]
    ordered = risk.in_order([[safe.length for safe in row] for row in by_shape_and_share.values()], shares)
    return {
        shape: [replace(safe, length=float(length)) for safe, length in zip(row, lengths, strict=True)]
        for (shape, row), lengths in zip(by_shape_and_share.items(), ordered, strict=True)
    }


def _given_surfaces(sticking, settings, bounds):
    """Safe length for every share, by shape, from sticking lengths (n,) each, given the sampled surfaces [m].

    The last shape holds whatever another one holds. What is safe against it is safe against each, which says more than
    flat surfaces do.
    """
    safe_by_shape = {shape: safe_lengths(values, settings, bounds[shape]) for shape, values in sticking.items()}
    *_, of_all = safe_by_shape.values()
    return {
        shape: [
            max(bound, last, key=lambda safe: safe.length) if bound.basis is Basis.FLAT else bound
            for bound, last in zip(lengths, of_all, strict=True)
        ]
        for shape, lengths in safe_by_shape.items()
    }


def safe_lengths(sticking: np.ndarray, settings: Settings, bounds: LengthBounds = NO_BOUNDS) -> list[SafeLength]:
    """Safe length for every share, from sticking lengths (n,) [m]."""
    return [
        risk.safe_length(sticking, share, stream(settings.seed, "safe length"), bounds) for share in settings.shares
    ]
