"""Checks of the results of a finished study, each with its numbers.

Inequalities must hold by more than 4 standard errors, targets must be met within 4. With the few hundred comparisons of
a study, this gives one false alarm in about a hundred seeds; for a given seed the outcome is always the same.
"""

import sys
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain, pairwise
from os import PathLike

import numpy as np
import pandas as pd
import xarray as xr
from scipy.special import ndtr, stdtrit

from stiction.analysis.mesh import resolution, rigid_energy
from stiction.beam.cantilever import Beam
from stiction.beam.energy import CRACK_LENGTH_POWER
from stiction.beam.equilibrium import allowed_imbalance
from stiction.beam.foundation import ACCURACY
from stiction.config.units import in_si
from stiction.contact.air import Air, is_humid
from stiction.contact.environment import Water, flooded_law
from stiction.contact.forcelaw import admissible, coefficients, energy
from stiction.contact.meniscus import is_wetted
from stiction.errors import NotConverged
from stiction.estimates import jackknife, mean_with_error
from stiction.models import MOMENT_KEYS, SURFACE_MODELS, surface_model
from stiction.plan.names import Outcome, by_case, by_model, by_name, by_outcome
from stiction.plan.stage import File, Running, Stage, select, subsection
from stiction.report.format import TO_MJ, TO_NM, TO_UM, number, with_error
from stiction.report.surfaces.tables import surface_statistics
from stiction.rounding import in_percent
from stiction.run.atomic import save_text
from stiction.run.markdown import literal
from stiction.stages.beams.cantilevers import Cantilevers, StripLength, cantilever, sections
from stiction.stages.beams.releases import stuck_energies, stuck_lengths
from stiction.stages.laws import forces as stage_forces
from stiction.stages.surfaces.heights import measured_moments, substitution
from stiction.stages.surfaces.parameters import misfits
from stiction.stages.surfaces.spectrum import defect
from stiction.surface.feasible import LARGEST_DISTANCE_OF_SCANS

#: Standard errors by which an inequality must hold and within which a target must be met.
ALLOWED = 4
#: ASSUME: from this relative humidity on, just below the driest experiment, energies grow with it. In drier air menisci
#: are less than a nanometre high: water is no continuum at this scale, and the energy of the model can decrease.
DRY = 0.4
#: Tolerances of the chaos model: mean, in standard deviations; standard deviation, relative; correlations, absolute.
#: They are not zero because kernels around log v widen the tails of v.
MEAN_OFF, SPREAD_OFF, CORRELATION_OFF = 0.02, 0.15, 0.05
#: Tolerance of the chaos model: mean crack length, relative.
LENGTH_OFF = 0.01
#: Largest misfit of an identified spectrum [%]: a little above that which the paper accepts, 23 % for Sub2.
MISFIT = 30
#: Name of the check of the mesh.
RESOLVED = "elements and strips resolve the crack"
#: Relative tolerance of a crack length on a coarser mesh. On that of the paper, elements have up to 3.7 and strips up
#: to 0.73 foundation lengths (pair a). Every measured crack length has a larger standard deviation, at least 2.4 %.
COARSER_ACCURACY = 0.02
#: Number of force laws for the energy of a stiff beam.
_RIGID = 500
#: Largest share of draws without a force law, non-Gaussian surfaces; largest difference from the share of the samples.
REJECTED, REJECTED_OFF = 0.05, 0.02


@dataclass(frozen=True)
class Check:
    """One comparison."""

    name: str  #: what must hold
    case: str  #: surface, or pair with model and humidity
    passed: bool
    message: str  #: sentence with the numbers


@dataclass(frozen=True)
class Flooded:
    """Flats of the solids of a pair, in contact under water, or in dry air."""

    water: Water
    hamaker_constant: float  #: of both solids, 0 without van der Waals forces [J]

    def energy(self, humidity: float) -> float:
        """Adhesion energy of flooded flats, the bound of all surfaces [J m⁻²]."""
        return flooded_law(humidity, self.water, self.hamaker_constant)[0]

    def in_words(self, humidity: float) -> str:
        """Name of the flats: without a film of water, they are not flooded."""
        return "flooded flats" if self.water.film(humidity)[0] else "flats in contact"


def _energy(forces):
    """Energies of the samples (m,) [mJ m⁻²]."""
    return TO_MJ * stage_forces.energies(forces)


def energy_grows(case: str, drier: xr.Dataset, more_humid: xr.Dataset) -> Check:
    """Check the growth of energy with humidity. Datasets of stage forces for one pair at two humidities."""
    growth, error = mean_with_error(_energy(more_humid) - _energy(drier))
    message = f"mean adhesion energy grows by {with_error(growth, error)} mJ/m²"
    return Check("energy grows with humidity", case, bool(growth > ALLOWED * error), message)


def skewness_increases_adhesion(case: str, gaussian: xr.Dataset, non_gaussian: xr.Dataset) -> Check:
    """Check the stronger adhesion of negatively skewed surfaces, without high summits, against Gaussian ones."""
    more, error = mean_with_error(_energy(non_gaussian) - _energy(gaussian))
    message = (
        f"mean adhesion energy is {with_error(more, error)} mJ/m² higher on non-Gaussian surfaces than on Gaussian ones"
    )
    return Check("negative skewness increases adhesion", case, bool(more > ALLOWED * error), message)


def scatter_falls(case: str, weaker: xr.Dataset, stronger: xr.Dataset) -> Check:
    """Relative scatter of the energy does not grow with the energy, because more summits share the load.

    For non-Gaussian surfaces only: where Gaussian ones hardly adhere, few summits touch and the scatter stays constant.
    """

    def change(means):
        """Change of the relative standard deviation, from moments of both cases."""
        x, xx, y, yy = means
        return np.sqrt(yy / y**2 - 1) - np.sqrt(xx / x**2 - 1)

    x, y = _energy(weaker), _energy(stronger)
    rise, error = jackknife(change, np.column_stack([x, x**2, y, y**2]))
    message = f"standard deviation / mean changes by {with_error(rise, error, '+')}"
    return Check("scatter does not grow with energy", case, bool(rise < ALLOWED * error), message)


def heights_are_as_measured(case: str, heights: xr.Dataset) -> Check:
    """Check the height density for the measured moments, or the nearest feasible ones within a measurement's error."""
    distance = measured_moments(heights).distance
    message = substitution(heights) or f"skewness {float(heights.skewness):.4g}, kurtosis {float(heights.kurtosis):.4g}"
    return Check("heights have the measured moments", case, distance <= LARGEST_DISTANCE_OF_SCANS, message)


def moments_meet_targets(
    case: str, character: xr.Dataset, targets: Mapping[str, float], defect: float
) -> Iterator[Check]:
    """Rms, skewness and kurtosis of drawn surfaces, one check each: dataset of stage character, targets by their keys.

    The ``defect`` is the share of the variance that no Gaussian field provides within the band of the spectrum [-].
    """
    values, errors = surface_statistics(character)
    # The error of few strips is itself uncertain: allow a deviation as improbable as 4 standard errors of many strips.
    allowed = -stdtrit(character.sizes["strip"] - 1, ndtr(-ALLOWED))
    for name, target in targets.items():
        off, error = values[name] - target, errors[name]
        within = allowed * error + (defect * target if name == "rms_nm" else 0)
        message = f"{name} is {with_error(values[name], error)}, target {target:.4g}, allowed ± {within:.2g}"
        yield Check("drawn surfaces have the target moments", case, bool(abs(off) <= within), message)


def identification_meets_targets(case: str, identification: xr.Dataset) -> Iterator[Check]:
    """Check radius and density of the summits of the identified spectrum against the measured ones."""
    for word, (off, error) in misfits(identification).items():
        allowed = MISFIT + ALLOWED * error
        message = f"{word} off by {with_error(off, error, '+')} %, allowed ± {in_percent(allowed / 100)}"
        yield Check("identified spectra have the measured summits", case, bool(abs(off) <= allowed), message)


def vectors_are_possible(case: str, forces: xr.Dataset) -> Check:
    """Check every v of Eq. (11): e > 0, 0 < f_max <= f_limit and d_limit < d_max."""
    parameters, limit = stage_forces.vectors(forces)
    e, f_max, d_max, d_limit = parameters.T
    good = (e > 0) & (f_max > 0) & (f_max <= limit) & (d_limit < d_max)
    message = f"{np.sum(~good)} of {len(good)} samples violate a constraint"
    return Check("v obeys its constraints", case, bool(good.all()), message)


def energies_are_bounded(case: str, forces: xr.Dataset, humidity: float, flooded: Flooded) -> Check:
    """Check the energies of all samples against the bound of flooded flats in contact."""
    largest, bound, flats = float(_energy(forces).max()), flooded.energy(humidity), flooded.in_words(humidity)
    message = f"the largest adhesion energy is {largest:.3g} mJ/m², {flats} have {TO_MJ * bound:.3g} mJ/m²"
    return Check(f"energies are below those of {flats}", case, bool(largest <= TO_MJ * bound), message)


def chaos_reproduces_input(case: str, chaos: xr.Dataset, samples: int) -> Check:
    """Means, standard deviations and correlations of draws from the chaos model equal those of its input.

    Neither side includes vectors without a force law. The tolerances are widened by 4 standard errors of this number of
    samples. The 99 % quantile is reported but not checked: kernels around log v move it outwards where the energy
    is skewed.
    """
    (mean, spread, _, far), (drawn_mean, drawn_spread, _, drawn_far) = (
        chaos.statistics.sel(source=source).values for source in ("input", "chaos")
    )
    correlation, drawn_correlation = (chaos.correlation.sel(source=source).values for source in ("input", "chaos"))
    off = (
        np.max(np.abs(drawn_mean - mean) / spread),
        np.max(np.abs(drawn_spread / spread - 1)),
        np.max(np.abs(drawn_correlation - correlation)),
    )
    limits = np.array([MEAN_OFF, SPREAD_OFF, CORRELATION_OFF]) + ALLOWED / np.sqrt(samples)
    message = (
        f"means off by up to {off[0]:.3f} standard deviations (allowed {limits[0]:.3f}), "
        f"standard deviations by {100 * off[1]:.1f} % (allowed {100 * limits[1]:.1f} %), "
        f"correlations by {off[2]:.3f} (allowed {limits[2]:.3f}), "
        f"99 % quantile of ē by {number((drawn_far[0] - far[0]) / spread[0], '+.2f')} standard deviations"
    )
    return Check("chaos model reproduces its input", case, bool(np.all(np.less_equal(off, limits))), message)


def chaos_keeps_crack_length(case: str, beams: xr.Dataset, resampled: xr.Dataset) -> Check:
    """Check mean crack length on laws of the chaos model against beams on laws of the samples themselves."""
    (length, error), (target, target_error) = (
        mean_with_error(TO_UM * stuck_lengths(end)) for end in (beams, resampled)
    )
    allowed = LENGTH_OFF * target + ALLOWED * np.hypot(error, target_error)
    message = (
        f"{with_error(length, error)} µm, on laws of the samples {with_error(target, target_error)} µm, "
        f"allowed ± {allowed:.2g} µm"
    )
    return Check("chaos model keeps the crack length", case, bool(abs(length - target) <= allowed), message)


def few_draws_rejected(case: str, chaos: xr.Dataset, forces: xr.Dataset, limit: float) -> Check:
    """Draws without a force law of Eq. (12) are at most the share ``limit``, and as frequent as such samples.

    ASSUME: no limit for Gaussian surfaces: in dry air many of their samples adhere too weakly for Eq. (12); this is a
    result of the model, not a fault of the draws.
    """
    rejected, n = float(chaos.rejected), forces.sizes["strip"]
    without = float(np.mean(~admissible(*stage_forces.vectors(forces))))
    error = np.sqrt(max(without * (1 - without), 1 / n) / n)
    passed = rejected <= limit + ALLOWED * error and abs(rejected - without) <= REJECTED_OFF + ALLOWED * error
    message = f"{100 * rejected:.2f} % of the draws have no force law, {100 * without:.2f} % of the samples"
    return Check("few draws are rejected", case, passed, message)


def beams_are_in_equilibrium(case: str, outcomes: xr.Dataset, limit: float, beam: Beam, area: float) -> Check:
    """Check the equilibrium of every beam: dataset of stage beams, pull-off pressure [Pa], area of a strip [m²]."""
    allowed = allowed_imbalance(beam, limit * area)
    unbalanced = int(np.sum(~(outcomes.imbalance.values <= allowed)))
    message = f"{unbalanced} of {outcomes.sizes['beam']} beams have a residual force of more than {allowed:.2g} N"
    return Check("beams are in equilibrium", case, unbalanced == 0, message)


def crack_is_resolved(
    case: str, outcomes: xr.Dataset, forces: xr.Dataset, beam: Beam, strip: float, accuracy: float
) -> Iterator[Check]:
    """Check crack lengths on a finer mesh, and the energy of Eq. (13) against the energies of the strips.

    On uniform ground, with the force law of median energy, the crack length is compared with that on a finer mesh. On
    random ground a crack opens up to the first strips that hold it, so that Γ exceeds ē, but not the energy of the
    strongest strip; it is at least that of a beam too stiff to follow single strips. There is no check if fewer than
    two beams end S-shaped, or if the beam on uniform ground does not.

    The datasets are those of stages beams and forces. The beam has the elements in use; length of a strip [m], allowed
    relative error of a crack length [-].
    """
    stuck = stuck_energies(outcomes)
    if len(stuck) < 2:
        return
    samples, limit = stage_forces.vectors(forces)
    laws = coefficients(samples[admissible(samples, limit)], limit)
    energies = energy(laws)
    median = laws[np.argsort(energies)[len(laws) // 2]]
    try:
        crack = resolution(beam, median, round(beam.length / strip))
    except (ValueError, NotConverged) as reason:
        yield Check(RESOLVED, case, False, f"no crack on uniform ground: {reason}")
        return
    if not np.isfinite(crack.error):
        return
    message = (
        f"crack on uniform ground is {TO_UM * crack.coarse.crack_length:.4g} µm, {100 * crack.error:+.2f} % off that "
        f"on a finer mesh (allowed ± {100 * accuracy:g} %)"
    )
    yield Check(RESOLVED, case, bool(abs(crack.error) <= accuracy), message)
    gamma, error = mean_with_error(TO_MJ * stuck)
    tolerance = accuracy / abs(CRACK_LENGTH_POWER)
    low = TO_MJ * rigid_energy(laws[:_RIGID]) * (1 - tolerance) - ALLOWED * error
    high = TO_MJ * energies.max() * crack.excess * (1 + tolerance) + ALLOWED * error
    message = (
        f"{with_error(gamma, error)} mJ/m², ē is {TO_MJ * energies.mean():.3g} mJ/m²; strips allow {low:.3g} to "
        f"{high:.3g} mJ/m²"
    )
    yield Check("energy of the cracks is one of the strips", case, bool(low <= gamma <= high), message)


def surface_checks(
    heights: Mapping[str, xr.Dataset],
    characters: Mapping[tuple[str, str], xr.Dataset],
    targets: Mapping[str, Mapping],
    defects: Mapping[str, float],
) -> Iterator[Check]:
    """Yield checks of drawn surfaces: datasets of stages heights, by surface, and character, by surface and model.

    The targets by surface are rms_nm, skewness and kurtosis as given, of which feasible ones replace the last two;
    surfaces described by scans have the rms of their heights. The defects are as in `moments_meet_targets`.
    """
    for surface, density in heights.items():
        yield heights_are_as_measured(surface, density)
    for (surface, model), character in characters.items():
        used = heights[surface] if model == "NG" else {"skewness": 0.0, "kurtosis": 3.0}
        moments = targets.get(surface, {"rms_nm": TO_NM * float(heights[surface].rms)})
        targets_of_model = moments | {name: float(used[name]) for name in ("skewness", "kurtosis")}
        yield from moments_meet_targets(f"{surface} {model}", character, targets_of_model, defects[surface])


def identification_checks(identifications: Mapping[str, xr.Dataset]) -> Iterator[Check]:
    """Yield checks of identified spectra, from the dataset of stage identification by surface."""
    for surface, identification in identifications.items():
        yield from identification_meets_targets(surface, identification)


def case_checks(
    forces: Mapping[Outcome, xr.Dataset], chaoses: Mapping[Outcome, xr.Dataset], flooded: Mapping[str, Flooded]
) -> Iterator[Check]:
    """Yield checks of single cases: samples, chaos model and rejection. ``flooded`` bounds the energies of a pair."""
    for key, samples in forces.items():
        case, chaos = _case(*key), chaoses[key]
        yield vectors_are_possible(case, samples)
        yield energies_are_bounded(case, samples, key[1], flooded[key[0]])
        yield chaos_reproduces_input(case, chaos, samples.sizes["strip"])
        yield few_draws_rejected(case, chaos, samples, REJECTED if key[2] == "NG" else 1.0)


def trend_checks(
    forces: Mapping[Outcome, xr.Dataset], skewed: Collection[str], wetted: Collection[str]
) -> Iterator[Check]:
    """Yield comparisons between cases. No trend leads to dry air.

    Of the ``skewed`` pairs, which are the paper's, no surface is skewed positively and at least one negatively. Between
    the surfaces of the ``wetted`` pairs, water condenses: others are in dry air at any humidity.
    """
    for pair, model in sorted({(pair, model) for pair, _, model in forces if pair in wetted}):
        rising = sorted(humidity for p, humidity, m in forces if (p, m) == (pair, model) and is_humid(humidity))
        for low, high in pairwise(rising):
            case = f"{_case(pair, low, model)} to {high:g}"
            drier, more_humid = (forces[pair, humidity, model] for humidity in (low, high))
            if low >= DRY:
                yield energy_grows(case, drier, more_humid)
            if model == "NG" and pair in skewed:
                yield scatter_falls(case, drier, more_humid)
    for pair, humidity, model in forces:
        if model == "NG" and pair in skewed:
            models = (forces[pair, humidity, heights] for heights in SURFACE_MODELS)
            yield skewness_increases_adhesion(f"{pair}, {Air(humidity).words}", *models)


def beam_checks(
    outcomes: Mapping[Outcome, xr.Dataset],
    forces: Mapping[Outcome, xr.Dataset],
    beams: Mapping[str, Beam],
    strip: float,
    coarser: Collection[str],
    scatter: float = 0.0,
) -> Iterator[Check]:
    """Yield checks of equilibrium, mesh and energy of the beams of every case. Model GEO shares the forces of NG.

    The nominal beams are by pair; length of a strip [m], pairs whose beams can have a coarser mesh, standard
    deviation of the dimensions in model GEO [-].
    """
    for (pair, humidity, model), released in outcomes.items():
        case, laws = _case(pair, humidity, model), forces[pair, humidity, surface_model(model)]
        beam = replace(beams[pair], elements=released.sizes["node"] - 1)
        accuracy = COARSER_ACCURACY if pair in coarser else ACCURACY
        larger = 1 + ALLOWED * scatter if model == "GEO" else 1.0  # width, and length of a strip
        yield beams_are_in_equilibrium(case, released, float(laws.limit), beam, larger**2 * beam.width * strip)
        yield from crack_is_resolved(case, released, laws, beam, strip, accuracy)


def resampling_checks(
    outcomes: Mapping[Outcome, xr.Dataset], resampled: Mapping[Outcome, xr.Dataset]
) -> Iterator[Check]:
    """Yield the effect of the chaos model on crack lengths, of cases with at least two stuck beams."""
    for key, reference in resampled.items():
        if min(len(stuck_lengths(beams)) for beams in (outcomes[key], reference)) >= 2:
            yield chaos_keeps_crack_length(_case(*key), outcomes[key], reference)


def _case(pair, humidity, model):
    """Case as text."""
    return f"{pair} {model}, {Air(humidity).words}"


def table(checks: Iterable[Check]) -> pd.DataFrame:
    """Checks as a frame, one row each."""
    return pd.DataFrame([vars(check) for check in checks])


def read(path: str | PathLike) -> pd.DataFrame:
    """Checks from a file written by `table`."""
    return pd.read_csv(path, dtype={"passed": bool}, keep_default_na=False)


def verdict(table: pd.DataFrame) -> str:
    """One sentence about all checks and one for each failure."""
    failed = table[~table.passed]
    if failed.empty:
        return f"All {len(table)} checks of the results passed."
    faults = [f"{row.name}: {row.case}: {row.message}" for row in failed.itertuples(index=False)]
    return f"{len(failed)} of {len(table)} checks of the results failed. " + "; ".join(faults)


def markdown(table: pd.DataFrame) -> str:
    """Checks for reading: the verdict, counts by name, then the numbers of every check."""
    counts = table.groupby("name", sort=False).passed.agg(["sum", "count"]).reset_index()
    counts.columns = ["check", "passed", "of"]
    parts = ["# Checks of the results", literal(verdict(table)), counts.to_markdown(index=False)]
    for name, rows in table.groupby("name", sort=False):
        lines = [
            f"- {'' if row.passed else '**FAILED** '}{literal(f'{row.case}: {row.message}')}"
            for row in rows.itertuples()
        ]
        parts.append(f"## {name[0].upper()}{name[1:]}\n\n" + "\n".join(lines))
    return "\n\n".join(parts) + "\n"


def _all_checks(data, settings):
    """All checks, passed or failed."""
    nominal = in_si(Cantilevers, {name: settings[name] for name in ("solid", "beam", "pairs")})
    beams = {pair: cantilever(nominal, pair) for pair in settings["pairs"]}
    strip = in_si(StripLength, settings["sampling"]).strip_length
    defects = {name: defect(spectrum) for name, spectrum in data["spectrum"].items()}
    flooded = {pair: in_si(Flooded, solids) for pair, solids in settings["flooded"].items()}
    wetted = [pair for pair, flats in flooded.items() if is_wetted(flats.water.contact_angles)]
    resampled = {(*case, "NG"): study for case, study in data["resampling"].items()}
    return table(
        chain(
            surface_checks(data["heights"], data["character"], settings["targets"], defects),
            identification_checks(data["identification"]),
            case_checks(data["forces"], data["chaos"], flooded),
            trend_checks(data["forces"], settings["skewed"], wetted),
            beam_checks(data["beams"], data["forces"], beams, strip, settings["coarser"], settings["scatter"]),
            resampling_checks(data["beams"], resampled),
        )
    )


def _save(checked, paths):
    """Write all checks. They may have failed, because Snakemake would remove the files of a failed job."""
    save_text(checked.to_csv(index=False), paths["csv"])
    save_text(markdown(checked), paths["markdown"])


def _skewed_pairs(plan):
    """Pairs of the paper without a positively skewed surface and with a negatively skewed one.

    The claim that negative skewness increases adhesion applies to the pairs of the paper only.
    """
    surfaces = plan.config["surfaces"]
    skewness = {pair: [surfaces[name]["skewness"] for name in plan.sides(pair)] for pair in plan.paper.pairs}
    return [pair for pair, values in skewness.items() if max(values) <= 0 > min(values)]


def _verdict(data):
    """Write a sentence about the checks. It ends the job if a check has failed."""
    checked = read(data["checks"])
    sentence = verdict(checked)
    if not checked.passed.all():
        sys.exit(f"{sentence} Every number is in results/checks.md.")
    return sentence


STAGES = (
    Stage(
        name="checks",
        files={"csv": "checks.csv", "markdown": "checks.md"},
        inputs=lambda plan, at: {
            "heights": by_name("heights", plan.surfaces),
            "spectrum": by_name("spectrum", plan.surfaces),
            "identification": by_name("identification", plan.with_summits),
            "character": by_model("character", plan.surfaces, SURFACE_MODELS[::-1]),
            "forces": by_outcome("forces", plan.laws),
            "chaos": by_outcome("chaos", plan.laws),
            "beams": by_outcome("beams", plan.outcomes),
            "resampling": by_case("studies/resampling", plan.cases) if "resampling" in plan.studies else {},
        },
        settings=lambda plan, at: (
            {
                "targets": {
                    name: subsection(plan.config["surfaces"][name], MOMENT_KEYS) for name in plan.surfaces_by_numbers
                },
                "skewed": _skewed_pairs(plan),
                "flooded": {
                    pair: {"water": plan.air.water(pair), "hamaker_constant_zJ": plan.air.hamaker_constant(pair)}
                    for pair in plan.pairs
                },
                "sampling": select(StripLength, plan.config["sampling"]),
                "coarser": [pair for pair in plan.pairs if plan.config["pairs"][pair].get("coarser_mesh", 1) > 1],
                "scatter": plan.config["beam"]["scatter"],
            }
            | sections(plan, *plan.pairs)
        ),
        compute=_all_checks,
        save=_save,
        message="Check the results.",
    ),
    Stage(
        name="verdict",
        files={"text": "verdict.txt"},
        inputs=lambda plan, at: {"checks": File("results/checks.csv")},
        compute=_verdict,
        save=lambda sentence, paths: save_text(f"{sentence}\n", paths["text"]),
        message="Fail if a check has failed.",
        targets=("all",),
        running=Running(last=True),
    ),
)
