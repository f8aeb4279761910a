"""What a finished study must show: laws that its datasets are checked against, each with its numbers.

A statistical law holds beyond, a target is met within, 4 standard errors. With the few hundred comparisons of a study
that raises one false alarm in about a hundred seeds; a seed that passes passes always.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pandas as pd
from scipy.stats import norm, t

from stiction.beam.cantilever import allowed_imbalance
from stiction.contact.forcelaw import admissible
from stiction.estimates import jackknife, mean_with_error
from stiction.report.tables import surface_statistics
from stiction.stages.data import ended, vectors

ALLOWED = 4
#: ASSUME: from this relative humidity on, just below the driest experiment, energies grow with it. Where menisci are
#: less than a nanometre high, beyond what continuous water can claim, those of the model can fall.
DRY = 0.4
#: The chaos model may miss the mean of its input by this part of the standard deviation, that by this part of itself,
#: and correlations by this much: kernels around log v widen the tails of v.
MEAN_OFF, SPREAD_OFF, CORRELATION_OFF = 0.02, 0.15, 0.05
#: Part of the mean crack length that the chaos model may take from it or add to it.
LENGTH_OFF = 0.01
#: Share of draws that may lack a force law: of non-Gaussian surfaces, and beyond that of the samples themselves.
REJECTED, REJECTED_OFF = 0.05, 0.02


@dataclass(frozen=True)
class Check:
    """One comparison."""

    law: str  #: what must hold
    case: str  #: of what
    passed: bool
    said: str  #: sentence with the numbers


def _energy(forces):
    """Energies of the samples (m,) [mJ m⁻²]."""
    return forces.adhesion_energy.values * 1e3


def energy_grows(case, drier, more_humid):
    """More water binds more: the same pairs of surfaces at two humidities, datasets of stage forces."""
    growth, error = mean_with_error(_energy(more_humid) - _energy(drier))
    said = f"mean adhesion energy grows by {growth:.4g} ± {error:.2g} mJ/m²"
    return Check("energy grows with humidity", case, bool(growth > ALLOWED * error), said)


def skewness_binds(case, gaussian, non_gaussian):
    """Negatively skewed surfaces, whose high summits are missing, hold tighter than their Gaussian twins."""
    more, error = mean_with_error(_energy(non_gaussian) - _energy(gaussian))
    said = f"non-Gaussian surfaces hold by {more:.4g} ± {error:.2g} mJ/m² more than Gaussian ones"
    return Check("negative skewness binds", case, bool(more > ALLOWED * error), said)


def scatter_falls(case, weaker, stronger):
    """Relative scatter of the energy does not grow with the energy: more summits share the load.

    Meant for non-Gaussian surfaces: where Gaussian ones hardly hold, the scatter of a few summits stays as it is.
    """

    def change(means):
        x, xx, y, yy = means
        return np.sqrt(yy / y**2 - 1) - np.sqrt(xx / x**2 - 1)

    x, y = _energy(weaker), _energy(stronger)
    rise, error = jackknife(change, np.column_stack([x, x**2, y, y**2]))
    said = f"standard deviation / mean changes by {rise:+.4f} ± {error:.2g}"
    return Check("scatter does not grow with energy", case, bool(rise < ALLOWED * error), said)


def moments_meet_targets(case, character, wanted, defect):
    """Rms, skewness and kurtosis of drawn surfaces, one check each.

    Parameters
    ----------
    case : str
    character : xarray.Dataset
        Stage character.
    wanted : dict
        rms_nm, skewness and kurtosis.
    defect : float
        Share of the variance that the translation could not place within the band of the spectrum [-].
    """
    values, errors = surface_statistics(character)
    # The error of few strips is itself uncertain: as improbable a deviation as 4 standard errors of many.
    allowed = t.isf(norm.sf(ALLOWED), character.sizes["strip"] - 1)
    for name, target in wanted.items():
        off, error = values[name] - target, errors[name]
        within = allowed * error + (defect * target if name == "rms_nm" else 0)
        said = f"{name} is {values[name]:.4g} ± {error:.2g}, wanted {target:.4g}, allowed ± {within:.2g}"
        yield Check("drawn surfaces have their moments", case, bool(abs(off) <= within), said)


def vectors_are_possible(case, forces):
    """Every v of Eq. (11) obeys e > 0, 0 < f_max <= f_limit and d_limit < d_max."""
    e, f_max, d_max, d_limit = vectors(forces).T
    good = (e > 0) & (f_max > 0) & (f_max <= float(forces.limit)) & (d_limit < d_max)
    said = f"{np.sum(~good)} of {len(good)} samples break a constraint"
    return Check("v respects its constraints", case, bool(good.all()), said)


def chaos_reproduces_input(case, chaos, samples):
    """Means, standard deviations and correlations of draws from the chaos model are those of its input.

    Vectors without a force law are on neither side. Of so many samples, 4 standard errors are allowed beside the
    tolerances. Quantiles are told: kernels around log v move the far one of a skewed energy outwards.
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
    said = (
        f"means off by up to {off[0]:.3f} standard deviations (allowed {limits[0]:.3f}), "
        f"standard deviations by {100 * off[1]:.1f} % (allowed {100 * limits[1]:.1f} %), "
        f"correlations by {off[2]:.3f} (allowed {limits[2]:.3f}), "
        f"99 % quantile of ē by {(drawn_far[0] - far[0]) / spread[0]:+.2f} standard deviations"
    )
    return Check("chaos model reproduces its input", case, bool(np.all(np.less_equal(off, limits))), said)


def crack_lengths_are_kept(case, beams, resampled):
    """Beams on laws of the chaos model stop where those on laws of the samples themselves do, in the mean."""
    (length, error), (target, its_error) = (
        mean_with_error(1e6 * end.crack_length.values[ended(end, "S-shape")]) for end in (beams, resampled)
    )
    allowed = LENGTH_OFF * target + ALLOWED * np.hypot(error, its_error)
    said = f"{length:.1f} ± {error:.2g} µm, on the samples {target:.1f} ± {its_error:.2g} µm, allowed ± {allowed:.2g}"
    return Check("chaos model keeps the crack length", case, bool(abs(length - target) <= allowed), said)


def few_draws_rejected(case, chaos, forces, limit):
    """Draws that Eq. (12) cannot follow are at most ``limit``, and as frequent as such samples.

    ASSUME: no limit for Gaussian surfaces: dry, many of their samples hold too little for Eq. (12), which is a result.
    """
    rejected, n = float(chaos.rejected), forces.sizes["sample"]
    without = float(np.mean(~admissible(vectors(forces), float(forces.limit))))
    error = np.sqrt(max(without * (1 - without), 1 / n) / n)
    passed = rejected <= limit + ALLOWED * error and abs(rejected - without) <= REJECTED_OFF + ALLOWED * error
    said = f"{100 * rejected:.2f} % of the draws have no force law, {100 * without:.2f} % of the samples"
    return Check("few draws are rejected", case, passed, said)


def beams_are_in_balance(case, outcomes, limit, beam, strip):
    """No beam was left before it found its equilibrium.

    Parameters
    ----------
    case : str
    outcomes : xarray.Dataset
        Stage beams.
    limit : float
        Largest pull-off pressure f_limit [Pa].
    beam : stiction.beam.cantilever.Beam
        Nominal dimensions.
    strip : float
        Length of a strip [m].
    """
    allowed = allowed_imbalance(beam, limit * beam.width * strip)
    unbalanced = int(np.sum(~(outcomes.imbalance.values <= allowed)))
    said = f"{unbalanced} of {outcomes.sizes['sample']} beams are off by more than {allowed:.2g} N"
    return Check("beams found their equilibrium", case, unbalanced == 0, said)


def of_surfaces(characters, targets, defects):
    """All checks of drawn surfaces.

    Parameters
    ----------
    characters : dict
        (surface, model) to the dataset of stage character.
    targets : dict
        Surface to rms_nm, skewness and kurtosis.
    defects : dict
        Surface to the share of variance that its spectrum could not place.
    """
    for (surface, model), character in characters.items():
        wanted = targets[surface] if model == "NG" else targets[surface] | {"skewness": 0.0, "kurtosis": 3.0}
        yield from moments_meet_targets(f"{surface} {model}", character, wanted, defects[surface])


def of_laws(forces, chaoses):
    """All checks of single cases: samples, chaos model and rejection; dicts of datasets by (pair, humidity, model)."""
    for key, samples in forces.items():
        case, chaos = _name(*key), chaoses[key]
        yield vectors_are_possible(case, samples)
        yield chaos_reproduces_input(case, chaos, samples.sizes["sample"])
        yield few_draws_rejected(case, chaos, samples, REJECTED if key[2] == "NG" else 1.0)


def of_trends(forces, skewed):
    """All comparisons between cases.

    Parameters
    ----------
    forces : dict
        (pair, humidity, model) to the dataset of stage forces.
    skewed : collection of str
        Pairs of which no surface is skewed positively and one is negatively.
    """
    for pair, model in sorted({(pair, model) for pair, _, model in forces}):
        rising = sorted(humidity for p, humidity, m in forces if (p, m) == (pair, model))
        for low, high in pairwise(rising):
            case, drier, humid = (
                f"{_name(pair, low, model)} to {high:g}",
                forces[pair, low, model],
                forces[pair, high, model],
            )
            if low >= DRY:
                yield energy_grows(case, drier, humid)
            if model == "NG" and pair in skewed:
                yield scatter_falls(case, drier, humid)
    for pair, humidity, model in forces:
        if model == "NG" and pair in skewed:
            twins = (forces[pair, humidity, twin] for twin in ("G", "NG"))
            yield skewness_binds(f"{pair}, RH {humidity:g}", *twins)


def of_beams(outcomes, forces, beams, strip):
    """Balance of the beams of every case.

    Parameters
    ----------
    outcomes, forces : dict
        (pair, humidity, model) to the datasets of stages beams and forces; model GEO shares the forces of NG.
    beams : dict
        Pair to its nominal beam.
    strip : float
        Length of a strip [m].
    """
    for (pair, humidity, model), released in outcomes.items():
        limit = float(forces[pair, humidity, "G" if model == "G" else "NG"].limit)
        yield beams_are_in_balance(_name(pair, humidity, model), released, limit, beams[pair], strip)


def of_resampling(outcomes, resampled):
    """What the chaos model does to crack lengths, wherever two beams stick at least.

    Parameters
    ----------
    outcomes, resampled : dict
        (pair, humidity, model) to the datasets of stage beams and, for model NG, of study resampling.
    """
    for key, reference in resampled.items():
        if min(ended(beams, "S-shape").sum() for beams in (outcomes[key], reference)) >= 2:
            yield crack_lengths_are_kept(_name(*key), outcomes[key], reference)


def _name(pair, humidity, model):
    """A case in words."""
    return f"{pair} {model}, RH {humidity:g}"


def table(checks):
    """Checks as a frame, one row each."""
    return pd.DataFrame([vars(check) for check in checks])


def verdict(table):
    """One sentence about all checks and one for each that failed."""
    failed = table[~table.passed]
    if failed.empty:
        return f"All {len(table)} checks of the results passed."
    faults = [f"{row.law}: {row.case}: {row.said}" for row in failed.itertuples()]
    return f"{len(failed)} of {len(table)} checks of the results failed. " + "; ".join(faults)


def markdown(table):
    """Checks for reading: the verdict, a count for each law, then every number."""
    counts = table.groupby("law", sort=False).passed.agg(["sum", "count"]).reset_index()
    counts.columns = ["law", "passed", "of"]
    parts = ["# Checks of the results", verdict(table), counts.to_markdown(index=False)]
    for law, rows in table.groupby("law", sort=False):
        lines = [f"- {'' if row.passed else '**FAILED** '}{row.case}: {row.said}" for row in rows.itertuples()]
        parts.append(f"## {law[0].upper()}{law[1:]}\n\n" + "\n".join(lines))
    return "\n\n".join(parts) + "\n"
