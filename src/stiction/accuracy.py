"""Numbers of beams and of samples for the errors of the lengths of devices.

They are decided before any job, from the errors of a pilot: of each device at each humidity, on few samples of its
ground and tips. Its random numbers are its own. The numbers are thus independent of the results, whose estimates and
bounds are those of stated numbers; the same whatever the cores; and found in the settings of every dataset.

An accuracy that a configuration asks for is that of the length of the middle share of stuck devices, of which pages
speak. Without one, and without samples of the user's own, grounds of beams get as many samples as the mean length on
their strips needs (`stiction.devices.numbers.strips_for_mean`), at most those of the configuration. As in
`stiction.pilot`, surfaces with a spectrum to be improved by the run are preliminary.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache, partial
from typing import Any

import numpy as np

from stiction.chaos.model import Truncation
from stiction.config.cases import Case
from stiction.config.merging import merged
from stiction.config.reading import is_stated
from stiction.config.scans import preliminary_estimates, with_preliminary_estimates
from stiction.config.units import in_si
from stiction.contact import forcelaw
from stiction.contact.environment import Water
from stiction.devices.numbers import Spread, beams_for, strips_for, strips_for_mean
from stiction.devices.sampling import sampled_surfaces
from stiction.devices.tail import fit_tail
from stiction.pilot import surface
from stiction.plan.devices import DevicePlan, Patch
from stiction.plan.numbers import Numbers
from stiction.plan.plan import Plan
from stiction.plan.stage import At, select
from stiction.progress import without_progress
from stiction.stages.contact import curves
from stiction.stages.contact.changes.patches import GROUND, TIPS, PatchKind
from stiction.stages.contact.contact import compute, with_correlations
from stiction.stages.contact.pairs import Settings, sides_of_strip
from stiction.stages.devices.contact_names import patch_of, patch_of_tips
from stiction.stages.devices.opening import DesignedBeam, settings_of_beam
from stiction.stages.devices.sticking import Released, ground, release_beams
from stiction.streams import stream

#: Samples of a ground, and beams with tips, of the pilot; order of its chaos model, which so many samples carry.
PILOT, _ORDER = 200, 5
#: Fraction of the lengths that is fitted. ASSUME: the lowest quarter has the slope of the lowest 5 %, with half the
#: error. Slopes of 1400 beams and tips of pair b differ by 5 to 20 %.
_FITTED = 0.25


def decided(config: dict) -> dict:
    """Complete configuration with the numbers for the errors of its devices, itself if it leaves none open."""
    if not DevicePlan(config).has_open_numbers:
        return config
    return numbers(config, preliminary_estimates(config)[0]).within(config)


def numbers(
    config: dict,
    preliminary: Mapping[str, dict],
    code: object = None,
    remember: Callable = lambda _, compute: compute(),
) -> Numbers | None:
    """Numbers for the errors of the devices of a configuration, none if it leaves none open.

    Stated numbers remain, and without beams those of the configuration. Cases have no part in them if too few of their
    beams stick for an error.

    Parameters
    ----------
    config : dict
        Complete and valid configuration in normal form.
    preliminary : dict
        Preliminary numbers of its measured surfaces, see `stiction.config.scans.preliminary_estimates`.
    code : object
        Fingerprint of this module.
    remember : callable
        Keeps what the pilot showed, see `stiction.run.disk_cache.DiskCache`.
    """
    plan = Plan(config, preliminary)
    if "accuracy" in config["design"]:
        return _for_accuracy(plan, code, remember)
    return _for_means(plan, code, remember) if plan.devices.has_open_numbers else None


def _for_accuracy(plan, code, remember):
    """Numbers for an accuracy."""
    config, design = plan.config, plan.config["design"]
    spreads = _spreads(plan, code, remember)
    share, accuracy = _middle(design["shares"]), design["accuracy"]["length"]
    stated, beams = config["contact"]["samples"], design["beams"]
    fewest = stated if is_stated(config, "contact", "samples") else _fewest(config)
    if spreads and not is_stated(config, "design", "beams"):
        beams = beams_for([spread for of_shapes in spreads.values() for spread in of_shapes], share, accuracy, fewest)
    samples = {}
    if not is_stated(config, "contact", "samples"):
        for name, cases in _by_ground(plan, spreads).items():
            of_ground = [spread for case in cases for spread in spreads[case]]
            samples[name] = strips_for(of_ground, share, accuracy, beams, fewest)
    strips = {case: samples.get(plan.devices.ground(case.device).name, stated) for case in spreads}
    errors = {
        case: max(spread.error(beams, strips[case], share) for spread in of_shapes)
        for case, of_shapes in spreads.items()
    }
    return Numbers(accuracy, beams, samples, errors)


def _for_means(plan, code, remember):
    """Numbers of samples that the mean lengths on the strips need, where they are fewer than by default.

    A ground without an error in one of its cases keeps those of the configuration. ASSUME: 500 samples carry any order
    of the chaos model, whose coefficients are projections of a kernel density: at order 12 on 500 samples of pair b at
    RH 0.67, lengths of P(stuck) = 0.001 are 0.1 ± 0.2 % shorter than on 5000.
    """
    config, samples, fewest = plan.config, {}, plan.config["studies"]["slopes"]["samples"]
    errors = _mean_errors(plan, code, remember)
    for name, cases in _by_ground(plan, plan.devices.cases).items():
        if all(errors[case] for case in cases):
            number = strips_for_mean(max(errors[case][0] for case in cases), fewest)
            samples |= {name: number} if number < config["contact"]["samples"] else {}
    return Numbers(None, config["design"]["beams"], samples, {})


def _middle(shares):
    """Share of stuck devices in the sentences of pages."""
    return shares[len(shares) // 2]


def _fewest(config):
    """Fewest samples that carry the chaos model and have those of the slopes among them."""
    return max(math.comb(config["chaos"]["order"] + 4, 4), config["studies"]["slopes"]["samples"])


def _by_ground(plan, cases):
    """Cases of every ground, without those that stoppers touch as well."""
    cases_of, of_stoppers = {}, {plan.devices.ground(name) for name in plan.devices.stoppers}
    for case in cases:
        if (ground := plan.devices.ground(case.device)) not in of_stoppers:
            cases_of.setdefault(ground.name, []).append(case)
    return cases_of


# Pilot


def _spreads(plan, code, remember):
    """Spread of the lengths of each shape, by case, of all with an error."""
    pilot = _Pilot.from_plan(plan)
    spreads = {
        case: remember([code, *pilot.determined_by(case)], lambda case=case: pilot.spreads(case))
        for case in plan.devices.cases
    }
    return {case: [Spread(*values) for values in of_shapes] for case, of_shapes in spreads.items() if of_shapes}


def _mean_errors(plan, code, remember):
    """Error of the length without scatter on one strip, by case, as a list without it where there is none.

    It is computed once for all cantilevers on a ground, whose lengths are one power of the energies.
    """
    pilot, errors = _Pilot.from_plan(plan), {}

    def error(case):
        """Error of a case, remembered."""
        return remember([code, "mean", *pilot.mean_determined_by(case)], lambda: pilot.mean_error(case))

    for case in plan.devices.cases:
        device = None if plan.devices.kind(case.device).has_tip else case.device
        ground = patch_of(plan, case), case.humidity, device
        errors[case] = errors[ground] if ground in errors else errors.setdefault(ground, error(case))
    return {case: errors[case] for case in plan.devices.cases}


@dataclass(frozen=True)
class _Settings:
    """Settings of the beams of a case and of their force laws."""

    seed: int
    chaos: Truncation
    water: Water
    humidity: float  #: [-]
    device: DesignedBeam
    beams: int


@dataclass(frozen=True)
class _Pilot:
    """Devices on few samples."""

    plan: Plan
    surfaces: Callable  #: datasets (heights, spectrum) of a surface by name
    contacts: dict[tuple, Any] = field(default_factory=dict)  #: those drawn, by kind and patch

    @classmethod
    def from_plan(cls, plan: Plan) -> "_Pilot":
        """Pilot of a plan, with its own seed and numbers."""
        config = with_preliminary_estimates(plan.config, plan.preliminary)
        seed = int(stream(config["seed"], "accuracy").integers(2**53))
        order = min(config["chaos"]["order"], _ORDER)
        changes = {"chaos": {"order": order}, "design": {"beams": PILOT}, "contact": {"model": "summits"}}
        few = Plan(merged(config, changes | {"seed": seed}), plan.preliminary)
        return cls(few, cache(lambda name: surface(few, name)))

    def determined_by(self, case: Case) -> list:
        """Settings and surfaces on which the spreads of a case depend."""
        names = self.plan.sides(self.plan.config["devices"][case.device]["pair"])
        entries = [self.plan.config["surfaces"][name] for name in names]
        of_contacts = [self._settings(*patch) for patch in self._patches(case)]
        share = _middle(self.plan.config["design"]["shares"])
        return [self._beam_settings(case), *of_contacts, entries, self.plan.config["character"], share]

    def spreads(self, case: Case) -> list[tuple[float, float]]:
        """Slope and error of the surfaces of the lengths of each shape, none where too few beams stick."""
        settings = in_si(_Settings, self._beam_settings(case))
        try:
            with without_progress():
                contact, *tips = (self._contact(*patch) for patch in self._patches(case))
                below = ground(contact, tips[0] if tips else None, case.humidity, settings)
                beams = release_beams(settings.device, below, settings)
            return spreads_of(beams, _middle(self.plan.config["design"]["shares"]), len(below.strips.sampled))
        except (ValueError, ArithmeticError):  # which the jobs of the case state
            return []

    def mean_determined_by(self, case: Case) -> list:
        """Settings and surfaces on which the error of the length without scatter depends."""
        names = self.plan.sides(self.plan.config["devices"][case.device]["pair"])
        entries = [self.plan.config["surfaces"][name] for name in names]
        of_contact = self._settings(GROUND, patch_of(self.plan, case))
        return [self._beam_settings(case), of_contact, entries, self.plan.config["character"]]

    def mean_error(self, case: Case) -> list[float]:
        """Relative error of the length without scatter on one strip [-], none where no strips have force laws."""
        settings = in_si(_Settings, self._beam_settings(case))
        try:
            with without_progress():
                contact = self._contact(GROUND, patch_of(self.plan, case))
                vectors, limit = curves.vectors(contact, case.humidity, settings.water)
            laws = forcelaw.coefficients(vectors[forcelaw.admissible(vectors, limit)], limit)
            opening = settings.device.opening
            on_mean = partial(opening.length_on_mean, beam=settings.device.beam)
            covariance = sampled_surfaces(laws, opening.contribution, on_mean, uniform=1.0).covariance
        except (ValueError, ArithmeticError):  # which the jobs of the case state
            return []
        return [float(np.sqrt(covariance[0, 0] * len(laws)))]

    def _beam_settings(self, case):
        """Settings of the beams of a case."""
        return select(_Settings, settings_of_beam(self.plan, case))

    def _patches(self, case):
        """Kinds of patch of a case, its ground first, each with the patch."""
        has_tip = self.plan.devices.kind(case.device).has_tip
        return [(GROUND, patch_of(self.plan, case))] + [(TIPS, patch_of_tips(self.plan, case))] * has_tip

    def _settings(self, patch_kind: PatchKind, patch: Patch):
        """Settings of the contact of a patch."""
        return patch_kind.settings(self.plan, At(**patch._asdict()), PILOT)

    def _contact(self, patch_kind, patch):
        """Contact of a patch, drawn once for all its humidities."""
        if (patch_kind, patch) not in self.contacts:
            surfaces = [self.surfaces(name) for name in self.plan.sides(patch.pair)]
            settings = in_si(Settings, self._settings(patch_kind, patch))
            contact = compute(surfaces, patch.pair, "NG", settings)
            self.contacts[patch_kind, patch] = with_correlations(contact, surfaces, sides_of_strip(settings))
        return self.contacts[patch_kind, patch]


def spreads_of(beams: Released, share: float, strips: int) -> list[tuple[float, float]]:
    """Slope and error of the surfaces of each shape, of released beams on a number of strips."""

    def quantiles(move):
        """Lengths of the share by shape (shapes,) [m]."""
        return np.array(
            [
                fit_tail(lengths_of_shape, _FITTED).length(share)
                for lengths_of_shape in beams.moved(move).lengths.values()
            ]
        )

    errors = beams.surfaces.error(quantiles) / quantiles(lambda lengths: lengths) * strips**0.5
    slopes = [fit_tail(lengths_of_shape, _FITTED).slope for lengths_of_shape in beams.lengths.values()]
    return [(float(slope), float(error)) for slope, error in zip(slopes, errors, strict=True)]
