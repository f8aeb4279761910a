"""Pilot: first samples of a run, drawn before any job, for decisions beyond the relations between keys.

They show whether the summits of every patch resist the adhesion (Sec. III-B1), and whether strips resolve the cracks
(Sec. III-C). Samples and criteria are those of the jobs. A patch is refused if one of its samples does not resist or,
where jobs count single ones as flat surfaces, if half of them do not; a strip, if it is longer than allowed by more
than three standard errors of the samples. What passes may still be longer than the force laws of a job allow, which
then go on with a warning.

The spectrum of measured surfaces and of those whose spectrum is to be identified is preliminary, and so are force laws
that will be corrected to full elastic contact: these are refused only if none of their samples resists, or if strips
are far too long. Coherences of surfaces that follow each other must be feasible.
"""

import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial, reduce
from itertools import chain
from operator import getitem
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from stiction.beam.resolution import longest
from stiction.config.messages import Problem, dotted, one_line
from stiction.config.relations import field_too_large
from stiction.config.scans import is_measured, with_preliminary_estimates
from stiction.config.test_beams import DATA
from stiction.config.units import NM_PER_UM, from_si, in_si, to_si
from stiction.contact import forcelaw
from stiction.contact.air import Air, humid, is_humid
from stiction.contact.environment import ForceCurves, Water, force_curves
from stiction.contact.pair import contacts_of_samples
from stiction.models import SURFACE_MODELS
from stiction.plan.devices import Patch, patch
from stiction.plan.plan import Plan
from stiction.plan.stage import At, select
from stiction.stages.beams.cantilevers import Cantilevers, cantilever, sections
from stiction.stages.contact import full_contact
from stiction.stages.contact.changes.patches import GROUND
from stiction.stages.contact.pairs import Settings, streams_of_sides, surface_pair
from stiction.stages.devices.opening import DesignedBeam, section_of_beam
from stiction.stages.surfaces import heights, spectrum
from stiction.stages.surfaces.rough_surfaces import rough_surface
from stiction.surface.empirical import MeasuredDensity
from stiction.surface.field import StripGrid
from stiction.surface.identify import SummitTarget, estimated_spectrum
from stiction.surface.replica import ALLOWED, Coherence, Replica
from stiction.surface.spectrum import CutoffSelfAffine

#: Samples of a strip of the paper, and the least number of samples. Smaller patches have more, in the same time:
#: only some of them lack the summits that resist the adhesion.
SAMPLES, FEWEST = 20, 5
#: Points of the field of a strip of the paper, 2.5 x 31 µm every 10 nm, and its distances.
_POINTS, _DISTANCES = 250 * 3100, 400
#: Standard errors beyond which something is certain.
_CERTAIN = 3
#: ASSUME: preliminary surfaces and force laws give the longest strips within this factor.
_PRELIMINARY = 1.25


@dataclass(frozen=True)
class PatchUse:
    """Use of a patch at some humidities, and its keys."""

    patch: Patch
    models: tuple[str, ...]  #: of the surfaces
    humidities: list[float]  #: at which its summits must resist
    pair: tuple  #: key that names the pair
    size: tuple  #: key of the size of the patch
    air: tuple  #: key of the humidities
    resolved: list[float] = ()  #: humidities at which strips must resolve a crack
    longest_strip: Callable[[np.ndarray], float] | None = None  #: on force laws (n, 4) [m]; none for a stopper
    strip: tuple = ()  #: key that a refusal of its strips is about
    thickness: float | None = None  #: of its beam, if this key is its thickness [µm]
    #: Or of a pair that runs, whose solids may attract each other less, see `stiction.plan.environment.Environment`.
    of_devices: bool = True
    in_full_contact: bool = False  #: whether these are the strips on which force laws are corrected


def problems(
    config: dict, preliminary: dict[str, dict], code: object, remember: Callable[[object, Callable], Any]
) -> list[Problem]:
    """Problems in the first samples of a configuration, one for each key and patch.

    Parameters
    ----------
    config : dict
        Complete and valid configuration in normal form.
    preliminary : dict
        Preliminary numbers of its measured surfaces, see `stiction.config.scans.preliminary_estimates`.
    code : object
        Fingerprint of this module.
    remember : callable
        Keeps what the samples showed, see `stiction.run.disk_cache.DiskCache`.
    """
    plan = Plan(with_preliminary_estimates(config, preliminary), preliminary)
    if beyond_memory := list(_tips_beyond_memory(plan)):
        return beyond_memory
    surfaces = cache(partial(surface, plan))
    of_patch = cache(partial(Samples, plan, surfaces, ["pilot", code], remember))

    def samples(use, model, humidity):
        """First samples of the patch of a use, with attraction of its solids through the air of a humidity."""
        air = plan.air_of_devices if use.of_devices else plan.air
        return of_patch(use.patch._replace(pair=air.contact(use.patch.pair, humidity)), model, air.of_devices)

    guessed, by_key = _identified_spectra(config), {}
    uses = list(chain(_pairs(plan), _devices(plan, "devices"), _devices(plan.with_test_beams, "test_beams")))
    if infeasible := list(_infeasible_copies(plan, surfaces, uses, guessed)):
        return infeasible
    for use in chain(uses, _in_full_contact(plan, uses)):
        preliminary_settings = [guessed[name] for name in dict.fromkeys(plan.sides(use.patch.pair)) if name in guessed]
        is_changed = plan.variants.corrected(use.patch.pair, use.humidities) and not use.in_full_contact
        preliminary_settings += ["full elastic contact"] * bool(is_changed)
        for path, message in chain(
            _coarse_elements(plan, use), _refusals(use, samples, preliminary=bool(preliminary_settings))
        ):
            value = one_line(reduce(getitem, path, config))
            if not (use.in_full_contact and path in {refused for refused, _ in by_key}):
                by_key.setdefault(
                    (path, use.patch), Problem(path, f"is {value}, {message}{_preliminary(preliminary_settings)}")
                )
    return list(by_key.values())


def _identified_spectra(config):
    """Keys and values of the surfaces with a spectrum to be improved by the run, by name."""
    guesses = {}
    for name, entry in config["surfaces"].items():
        if is_measured(entry):
            files = [Path(file).name for file in entry["scans"]["files"]]
            guesses[name] = f"surfaces.{name}.scans.files = {one_line(files)}"
        elif entry["psd"] != "published":
            guesses[name] = f"surfaces.{name}.psd = {one_line(entry['psd'])}"
    return guesses


def _tips_beyond_memory(plan):
    """Yield problems of the gaps of cantilevers, with tips in fields beyond the memory of a job."""
    margin, spacing = (plan.config["sampling"][key] for key in ("margin_um", "spacing_nm"))
    for name in plan.devices.with_tips:
        length, width = (side / NM_PER_UM for side in plan.devices.tips(name)[1:])
        if refusal := field_too_large(length + margin, width + margin, spacing):
            reason = f"{refusal}; the wedge at the tip of a beam is the longer, the smaller the gap"
            gap = plan.devices.sections[name]["gap_um"]
            yield Problem(("devices", name, "gap_um"), f"is {one_line(gap)}, {reason}")


def _infeasible_copies(plan, surfaces, uses, guessed):
    """Yield coherences that the surfaces of a pair cannot have. ASSUME: preliminary ones err by as much as allowed."""
    for pair in dict.fromkeys(use.patch.pair for use in uses):
        for path, stated in _stated_copies(plan, pair):
            guesses = [guessed[name] for name in dict.fromkeys(plan.sides(pair)) if name in guessed]
            grid = StripGrid.periodic(to_si(1, "um"), to_si(plan.config["sampling"]["spacing_nm"], "nm"))
            sides = (rough_surface(*surfaces(name), "NG", grid) for name in plan.sides(pair))
            copy = Replica(*sides, in_si(Coherence, stated))
            if refusal := copy.refusal(2 * ALLOWED if guesses else ALLOWED):
                yield Problem(path, f"is {copy.of_heights.coherence:g}, {refusal}{_preliminary(guesses)}")


def _stated_copies(plan, pair):
    """Yield the replica of a pair, and those at the largest coherences of its devices, with paths of coherences."""
    stated = plan.replica(pair).get("replica")
    if stated:
        yield ("pairs", pair, "replica", "coherence"), stated
    for name, device in plan.devices.sections.items():
        if device["pair"] == pair and "coherence" in device.get("roughness", {}):
            largest = device["roughness"]["coherence"][1]
            yield ("devices", name, "roughness", "coherence", 1), stated | {"coherence": largest}


def _preliminary(settings):
    """End of a message about preliminary samples, given some settings."""
    return f" (preliminary, given {', '.join(settings)})" if settings else ""


# What sticks


def _pairs(plan):
    """Yield strips of the pairs in the run, at their humidities and the figures'."""
    config = plan.config
    for number, pair in enumerate(plan.pairs):
        beam = cantilever(in_si(Cantilevers, sections(plan, pair)), pair)
        coarser = config["pairs"][pair].get("coarser_mesh", 1)
        use = partial(
            PatchUse,
            patch(pair, config["sampling"]["strip_length_um"], config["beam"]["width_um"]),
            SURFACE_MODELS,
            pair=("run", "pairs", number),
            size=("beam", "width_um"),
            longest_strip=lambda laws, beam=beam, coarser=coarser: coarser * longest(beam, laws)[0],
            strip=("sampling", "strip_length_um"),
            of_devices=False,
        )
        stated, shown = config["pairs"][pair]["humidities"], [config["figures"]["humidity"]]
        yield use(stated, air=("pairs", pair, "humidities"), resolved=stated)
        yield use(shown, air=("figures", "humidity"), resolved=shown if pair == plan.figure_pair else [])


def _devices(plan, section):
    """Patches of devices, also along the axes of their charts and of the worst humidity of stoppers."""
    devices = plan.devices
    for name in devices.sections:
        path_of_device, ground = (section, name), devices.ground(name)
        use = partial(PatchUse, ground, ("NG",), pair=(*path_of_device, "pair"))
        air = (
            *path_of_device,
            "humidities" if section == "devices" else next(key for key in DATA if key in plan.config[section][name]),
        )
        yield from _OF_RELEASE[devices.kind(name).release.name](plan, name, use, air)


def _of_strips(plan, name, use, air):
    """Yield the strips of a beam, also along its chart."""
    device, path_of_device = plan.devices.sections[name], air[:2]
    sizes = [(device["humidities"], air, (*path_of_device, "thickness_um"), {})]
    if chart := device.get("chart"):
        thinnest = {"thickness_um": chart["thicknesses_um"][0], "gap_um": chart.get("gaps_um", [device["gap_um"]])[0]}
        keys = [(*path_of_device, "chart", key) for key in ("humidities", "thicknesses_um")]
        sizes.append((plan.devices.axis(name), *keys, thinnest))
    for humidities, of_air, key, size in sizes:
        beam = in_si(DesignedBeam, section_of_beam(plan, name) | size)
        yield use(
            humidities,
            size=(*path_of_device, "width_um"),
            air=of_air,
            resolved=humidities,
            longest_strip=partial(beam.opening.longest_strip, beam),
            strip=key,
            thickness=from_si(beam.thickness, "um"),
        )


def _of_area(plan, name, use, air):
    """Yield the area of a stopper, also at the ends of the humidities in which the worst is sought."""
    humidities, size = plan.devices.sections[name]["humidities"], (*air[:2], "contact_um")
    yield use(humidities, size=size, air=air)
    worst = plan.config["design"].get("worst_humidities")
    if worst and humid(humidities):
        yield use(worst, size=size, air=("design", "worst_humidities"))


_OF_RELEASE = {"beam": _of_strips, "stopper": _of_area}


def _in_full_contact(plan, uses):
    """Yield the strips in full elastic contact that correct the force laws of some uses."""
    for use in uses:
        if corrected := plan.variants.corrected(use.patch.pair, use.humidities):
            sides = plan.config["sampling"]["strip_length_um"], plan.config["beam"]["width_um"]
            strips = {"patch": patch(use.patch.pair, *sides), "models": ("NG",), "humidities": corrected}
            yield replace(use, **strips, resolved=[], longest_strip=None, size=(), in_full_contact=True)


def _coarse_elements(plan, use):
    """Yield the key of a pair, with a refusal, if the elements of its full contact are too large for its attraction."""
    if not use.in_full_contact:
        return
    stated = full_contact.settings_across(plan, At(pair=use.patch.pair)) | {"humidities": use.humidities}
    try:
        full_contact.require_fine_elements(in_si(full_contact.Settings, stated))
    except ValueError as reason:
        yield use.pair, f"must have stiffer solids or a weaker attraction: {reason}, or state contact.model: summits"


# What the samples show


def _refusals(use: PatchUse, samples: Callable, preliminary: bool) -> Iterator[tuple[tuple, str]]:
    """Yield keys and messages of the problems of a use."""
    law = use.longest_strip is not None
    try:
        shown = {
            (model, humidity): samples(use, model, humidity).at(humidity, law, preliminary)
            for model in use.models
            for humidity in use.humidities
        }
    except (ValueError, ArithmeticError) as reason:
        yield use.pair, f"must have surfaces and a solid whose contact can be computed: {reason}"
        return
    if weak := sorted(humidity for (_, humidity), evidence in shown.items() if "weak" in evidence):
        yield _weak(use, weak, next(evidence["weak"] for evidence in shown.values() if "weak" in evidence))
        return
    strips = [(*_longest(use, shown[at]["laws"]), at) for at in shown if at[1] in use.resolved]
    length, error, at = min(strips, default=(np.inf, 0.0, None))
    doubt = _PRELIMINARY if preliminary else 1
    if use.patch.length > doubt * (length + _CERTAIN * error):
        yield use.strip, _too_long(use, length, error, f"{Air(at[1]).where} {len(shown[at]['laws'])} samples")


def _longest(use, laws):
    """Longest strip to resolve the cracks of a use, and its jackknife error [nm]."""
    laws = np.array(laws)
    without = [use.longest_strip(np.delete(laws, k, axis=0)) for k in range(len(laws))]
    error = np.std(without) * np.sqrt(len(laws) - 1)
    return from_si(use.longest_strip(laws), "nm"), from_si(float(error), "nm")


def _too_long(use, length, error, samples):
    """Message about strips too long by the samples, with a sufficient length or thickness."""
    strip, enough = use.patch.length / NM_PER_UM, (length - _CERTAIN * error) / NM_PER_UM
    evidence = f"{samples} allow {length / NM_PER_UM:.3g} ± {error / NM_PER_UM:.1g} µm"
    if use.thickness is None:
        return f"must be at most {enough:.3g} µm to resolve the cracks of pair {use.patch.pair}: {evidence}"
    # All lengths of a crack on given force laws are proportional to t^(3/4).
    thickness = use.thickness * (strip / enough) ** (4 / 3)
    return (
        f"must be so large that strips of {strip:g} µm resolve its cracks, at least {thickness:.3g} µm: {evidence}; or "
        f"decrease strip_um to at most {enough:.3g} µm"
    )


def _weak(use, humidities, weak):
    """Key and message of a patch with a sample too weak against the adhesion at the first of some humidities."""
    pull, repulsion = (f"{from_si(weak[key], 'MPa'):.3g} MPa" for key in ("pull", "repulsion"))
    more, water = " and others" * (len(set(humidities)) > 1), "water and " * is_humid(humidities[0])
    resist = (
        f"{Air(humidities[0]).where}{more}, {water}van der Waals forces pull "
        f"with up to {pull}, and the summits of sample {weak['sample']} of {weak['samples']} resist with {repulsion}"
    )
    if weak["together"] and not use.in_full_contact:
        length, width = (side / NM_PER_UM for side in use.patch[1:])
        return use.size, (
            f"must give patches of surface with so many summits that every sample resists the adhesion: {resist} on "
            f"{length:g} x {width:g} µm of pair {use.patch.pair}; as far as these samples show, {weak['together']} "
            "times the area would do"
        )
    others = [Air(humidity).name for humidity in use.humidities if humidity not in humidities]
    choose = f"only {', '.join(others)}" if others else "other humidities"
    is_wet = bool(humid(use.humidities))  # a study of dry air has no humidity to choose
    full = " of the strips in full elastic contact" * use.in_full_contact
    flat = ", or state contact.model: summits, which counts weak samples as flat" * use.in_full_contact
    return use.pair, (
        f"must have surfaces rough enough and a solid stiff enough{' for its humidities' * is_wet}: {resist} where the "
        f"mean planes{full} meet; increase the roughness or young_modulus_GPa{flat}"
        + f", or choose {choose} in {dotted(use.air)}"
        * is_wet
    )


def surface(plan: Plan, name: str) -> tuple[xr.Dataset, xr.Dataset]:
    """Datasets (heights, spectrum) of a surface described by numbers."""
    entry, rms = plan.config["surfaces"][name], plan.config["surfaces"][name]["rms_nm"]
    if "form" in entry:
        measured = heights.Settings(to_si(rms, "nm"), np.nan, np.nan)
        density = heights.layout(MeasuredDensity(*map(np.array, entry["form"])), measured)
    else:
        with warnings.catch_warnings(action="ignore"):  # about nearest feasible moments, which the job will give
            density = heights.compute(in_si(heights.Settings, select(heights.Settings, entry)))
    if entry["psd"] == "published":
        target = in_si(CutoffSelfAffine, entry["published_psd"])
    else:
        radius, number = to_si(entry["mean_summit_radius_um"], "um"), to_si(entry["summit_density_per_um2"], "per_um2")
        of_summits = to_si(plan.config["character"]["spacing_nm"], "nm")
        target = estimated_spectrum(SummitTarget(to_si(rms, "nm"), radius, number, of_summits))
    return density, spectrum.on_grid(target, density, to_si(plan.config["sampling"]["spacing_nm"], "nm"))


@dataclass(frozen=True)
class Samples:
    """First samples of a patch of a pair."""

    plan: Plan
    surfaces: Callable  #: datasets (heights, spectrum) of a surface by name
    code: list  #: on which the answers depend
    remember: Callable
    patch: Patch
    model: str
    of_devices: bool

    def at(self, humidity: float, law: bool, preliminary: bool) -> dict[str, Any]:
        """Findings of the samples at a humidity, see `shown_by`."""
        entries = [self.plan.config["surfaces"][name] for name in self.plan.sides(self.patch.pair)]
        air = self.plan.air_of_devices if self.of_devices else self.plan.air
        water = air.water(self.patch.pair)
        settings = [self.patch, self.model, entries, self.plan.config["character"], self._settings]
        return self.remember(
            [*self.code, *settings, water, humidity, law, preliminary],
            lambda: shown_by(force_curves(*self._contact, humidity, in_si(Water, water)), law, preliminary),
        )

    @cached_property
    def _settings(self):
        """Settings of the contact of as many samples as the time allows."""
        at = At(pair=self.patch.pair, length=str(self.patch.length), width=str(self.patch.width))
        return GROUND.settings(self.plan, at, self.plan.config["contact"]["samples"])

    @cached_property
    def _contact(self):
        """Solid pressures, bearing areas and their grids, as in stage contact."""
        settings = in_si(Settings, self._settings)
        surfaces = [self.surfaces(name) for name in self.plan.sides(self.patch.pair)]
        pair = surface_pair(surfaces, self.model, settings)
        work = np.prod(pair.beam.grid.field_shape) / _POINTS * (1 + pair.distances.above / _DISTANCES) / 2
        number = min(settings.contact.samples, max(FEWEST, int(SAMPLES / work)))
        streams = streams_of_sides(settings.seed, self.patch.pair)
        ((solid, bearing),) = contacts_of_samples([pair], streams, range(number))
        grid = pair.distances
        return solid, bearing, (float(grid.solid[0]), float(grid.bearing[0])), grid.step


def shown_by(curves: ForceCurves, law: bool, preliminary: bool = False) -> dict[str, Any]:
    """What force curves show: their force laws, or the sample that resists the adhesion least if it does not resist.

    Those that jobs count as flat surfaces have no part in the laws: with them, no strips may be short enough, and jobs
    then state the safe side.

    Parameters
    ----------
    curves : ForceCurves
    law : bool
        Whether they must have force laws, and rise to the largest attraction of all samples, or only hold a patch.
    preliminary : bool
        Whether samples that do not resist are allowed as long as others do.

    Returns
    -------
    dict
        ``laws`` (n, 4) [SI], none if none are needed. Or ``weak``: number of a ``sample`` and of all ``samples``, its
        ``repulsion`` and the largest ``pull`` [Pa], and how many patches ``together`` resist, ``None`` if not even all.

    Raises
    ------
    ValueError
        If the criteria of the jobs refuse the curves for another reason, or fewer than two have a force law.
    """
    forces = np.array([curves.curve(k).copy() for k in range(curves.samples)])
    repulsion, needed = forcelaw.repulsions(forces), -forces.min() if law and curves.flat is None else 0.0
    resist = repulsion > needed
    # Jobs count single samples as flat surfaces where these have a bound. If most are flat, the sum over summits fails.
    most = np.mean(resist) > 1 / 2 if curves.flat else resist.all()
    if not (resist.any() if preliminary else most):
        weakest = int(np.argmin(repulsion))
        weak = {"sample": weakest, "repulsion": max(float(repulsion[weakest]), 0.0), "pull": -float(forces.min())}
        return {"weak": weak | {"samples": len(forces), "together": forcelaw.together(forces, needed)}}
    resist |= curves.flat is not None
    kept = forces[resist]
    if not law:
        forcelaw.pull_offs(curves.distance, kept.__getitem__, len(kept), curves.flat)
        return {"laws": []}
    beyond = None if curves.beyond is None else curves.beyond[resist]
    laws, lawful = forcelaw.coefficients_where_lawful(
        *forcelaw.parametrise(curves.distance, kept.__getitem__, len(kept), beyond, curves.flat)
    )
    if lawful.sum() < 2:
        raise ValueError(f"{lawful.sum()} of {len(kept)} samples have a force law of Eq. (12)")
    held = np.array([forcelaw.resists(force) for force in kept])
    return {"laws": laws[lawful & held].tolist()}
