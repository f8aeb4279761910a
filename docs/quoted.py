"""The numbers that the docs quote, as text, from the tables in ``docs/tables``.

Each number has one name, defined here; ``{{ name }}`` in ``docs/templates`` inserts it. Each function takes frames and
returns ``{name: text}``, without reading or writing a file (except `frame`).
"""

import re

import numpy as np
import pandas as pd

from stiction.answer.data import Cause
from stiction.beam.energy import apparent_adhesion_energy
from stiction.beam.foundation import ACCURACY, ELEMENT, STRIP
from stiction.config.files import paper
from stiction.config.units import in_si
from stiction.contact.full import smooth_pairs
from stiction.devices.limits.rules import FILMS
from stiction.plan.plan import Plan
from stiction.report.beams import prediction
from stiction.report.checks import COARSER_ACCURACY, RESOLVED
from stiction.report.devices.life import bounds_in_words
from stiction.report.format import MISSING, TO_MJ, TO_UM, bounding, number, with_error
from stiction.stages.beams.cantilevers import Cantilevers, cantilever, sections
from stiction.surface import feasible

#: Variant with attraction across gaps.
ACROSS = "reach_all"
#: Measured skewness and kurtosis of nearly Gaussian surfaces, as examples.
NEARLY_GAUSSIAN = ((-0.1, 3.05), (0.05, 3.02), (-0.3, 3.5), (-0.5, 4.0))

#: Experiments that stick more than predicted, by the names of their numbers.
UNSAFE = {
    "gold": "caltech_gold",
    "silicon": "stanford_force",
    "plates": "plates_polysilicon",
}


def numbers(tables):
    """All numbers, from a dict of the name of each table to its frame."""
    texts = crack_lengths(tables["table_3"]) | deviations(tables["table_3"]) | energies(tables["table_3"])
    texts |= supplement(tables) | finer(tables["print_finer"])
    texts |= statements(tables["table_3"], tables["variants"]) | statements_of_studies(tables)
    texts |= intervals(tables["table_3"]) | printed(tables["print"], tables["print_studies"])
    texts |= surfaces(tables["table_1"]) | identification(tables["table_2"]) | fits(tables["fit_quality"])
    texts |= (
        variants(tables["variants"])
        | removed(tables["variants"])
        | slopes(tables["sensitivity"])
        | chaos(tables["resampling"])
    )
    texts |= life(tables["life"])
    texts |= safe_lengths(tables["safe_lengths"]) | stoppers(tables["stoppers"]) | budget(tables["budget"])
    texts |= answers(tables["devices"])
    texts |= model_errors(tables["model_error"]) | attraction(tables["attraction"])
    texts |= readings(tables["asperities"]) | pressing(tables["pressing"])
    texts |= sealed(tables["sealed_safe_lengths"], tables["sealed_stoppers"])
    texts |= measured_beams(tables["measured_beams"]) | said(tables["test_beams"]) | skewed(tables["roughness"])
    texts |= said(tables["process_answers"])
    texts |= tails(tables["tails"]) | texts_of(tables["studies"]) | checks(tables["checks"]) | mesh(tables["checks"])
    texts |= validation(tables["validation"])
    texts |= scans(tables["example_scans"]) | timings(tables["timings"]) | constants() | nearly_gaussian()
    return texts | forces_on_summits()


def measured_beams(frame):
    """``beams_b_slope``: what the crack lengths of the paper say as test beams, by pair and name."""
    return {f"beams_{row.pair}_{row.name}": str(row.text) for row in frame.itertuples(index=False)}


def validation(frame):
    """``valid_inside``: how many measured values lie within their intervals; other counts, and how far levels miss.

    ``valid_factor`` is the median factor between measured and predicted levels, ``valid_off`` the same of crack lengths
    [%]; ``valid_gold``, ``valid_gold_measured``: predicted and measured value of one of `UNSAFE`, and so on.
    """
    known = frame[frame.predicted.notna()]
    named = known[~known.laboratory.str.startswith("not shown")]
    bounds, values = known[known.value.isna()], known[known.value.notna()]
    levels, is_crack = values[values.kind == "level"], values.experiment.str.startswith("crack_lengths")
    parts = {"lengths": values[is_crack], "levels": levels[~is_crack[levels.index]]}
    parts |= {"laws": values[values.kind != "level"], "bounds": bounds}
    counts = {f"valid_{name}_inside": int(part.inside.sum()) for name, part in parts.items()}
    counts |= {f"valid_{name}": len(part) for name, part in parts.items()}
    counts |= {"valid_inside": int(values.inside.sum()), "valid_values": len(values)}
    counts |= {"valid_experiments": known.experiment.nunique(), "valid_laboratories": named.laboratory.nunique()}
    counts |= {"valid_left_out": frame.experiment.nunique() - known.experiment.nunique()}
    away = {
        name: np.exp(np.abs(np.log(parts[name].value / parts[name].predicted)).median())
        for name in ("lengths", "levels")
    }
    texts = {name: str(count) for name, count in counts.items()}
    first = values.drop_duplicates("experiment").set_index("experiment")
    for name, experiment in UNSAFE.items():
        row = first.loc[experiment]
        texts |= {f"valid_{name}": f"{row.predicted:.1g}", f"valid_{name}_measured": f"{row.value:.2g}"}
    return texts | {"valid_factor": f"{away['levels']:.2g}", "valid_off": f"{100 * (away['lengths'] - 1):.0f}"}


def said(frame):
    """``onB_build``: sentences of the pages of devices with test beams, by device and name."""
    return {f"{row.device}_{row.name}": str(row.text) for row in frame.itertuples(index=False)}


def life(frame):
    """``life_C1_voltage``: both bounds of an answer in its unit, ``_least``: the lower; ``life_C1_length`` [µm]."""
    texts = {}
    for row in frame.itertuples(index=False):
        bounds = bounds_in_words(row.at_least, row.at_most, row.unit)
        texts[f"life_{row.device}_{row.answer}"] = " to ".join(dict.fromkeys(bounds))
        texts[f"life_{row.device}_{row.answer}_least"] = bounds[0]
        texts[f"life_{row.device}_length"] = bounding(row.length_um, 3, up=False)
    return texts


def skewed(frame):
    """``skewed_1``: share of stoppers that stick at the given rms, from the least skewness to the largest [%]."""
    given = frame[(frame.device == "Skewed") & np.isclose(frame.value, paper()["surfaces"]["B2"]["rms_nm"])]
    shares = given.sort_values("other_value").stuck_percent
    return {f"skewed_{k}": f"{share:.3g}" for k, share in enumerate(shares, 1)}


def crack_lengths(table_3):
    """``std_b_044_NG``: standard deviation of the crack lengths of a case [µm]."""
    return {f"std_{_case(row)}_{row.model}": f"{row.crack_length_std_um:.2g}" for row in table_3.itertuples()}


def crack_length(row):
    """Crack length of one row of Table III as text."""
    if np.isnan(row.crack_length_um):
        return "all stick at the tip only" if row.share_arc == 1 else MISSING
    share = "" if row.share_s_shape == 1 else f" ({100 * row.share_s_shape:.2g} % of beams)"
    return f"{row.crack_length_um:.0f} ± {row.crack_length_std_um:.0f}{share}"


def compared_lengths(table_3, pair="b"):
    """Crack lengths of one pair over the humidity: measured, published, computed. Markdown."""
    lines = [
        "| RH | measured | published, GEO | computed, G | computed, NG | computed, GEO |",
        "|---|---|---|---|---|---|",
    ]
    for humidity, rows in table_3[table_3.pair == pair].groupby("relative_humidity"):
        row = {model: next(rows[rows.model == model].itertuples()) for model in ("G", "NG", "GEO")}
        cells = [f"{humidity:.2f}", f"{row['GEO'].experiment_um:.0f} ± {row['GEO'].experiment_std_um:.0f}"]
        cells += [f"{row['GEO'].published_um:.0f} ± {row['GEO'].published_std_um:.0f}"]
        lines.append(f"| {' | '.join(cells + list(map(crack_length, row.values())))} |")
    return "\n".join(lines)


def model_errors(table):
    """``model_error_a``: largest error of the model in a crack length [%].

    ``summits_rms_a``, ``full_rms_a``: root mean square deviation from the published lengths [%].
    """
    texts = {}
    for pair, rows in table.groupby("pair"):
        texts[f"model_error_{pair}"] = f"{rows.model_error_percent.max():.0f}"
        for name, column in (("summits", "deviation_percent"), ("full", "full_contact_deviation_percent")):
            texts[f"{name}_rms_{pair}"] = f"{np.sqrt(np.mean(rows[column] ** 2)):.1f}"
    return texts


def across_gaps(table):
    """Table III, model NG, with attraction across gaps beside that of touching summits alone. Markdown."""
    lines = [
        "| pair | RH | ē, all / touching | l_s, touching [µm] | l_s, all [µm] | change [%] | published | deviation [%] "
        "| measured | deviation [%] |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for touching, across in _both_reaches(table):
        factor = 1 + across.meso_energy_shift_percent / 100
        row = [across.pair, f"{across.relative_humidity:.2f}"]
        row += [with_error(factor, across.meso_energy_shift_se_percent / 100)]
        row += [with_error(of.crack_length_um, of.crack_length_se_um) for of in (touching, across)]
        row += [with_error(across.shift_percent, across.shift_se_percent, "+")]
        for name in ("published", "experiment"):
            off = [getattr(of, f"{name}_deviation_percent") for of in (touching, across)]
            row += [f"{getattr(across, f'{name}_um'):.0f}", "{:+.1f} → {:+.1f}".format(*off)]
        lines.append(f"| {' | '.join(row)} |")
    return "\n".join(lines)


def attraction(table):
    """``across_a_045``: energy with attraction across gaps over that without; ``across_rms_published_a`` and so on.

    The latter are root mean square deviations from published and measured lengths [%]; ``touching_rms_…``: without.
    """
    pairs = list(_both_reaches(table))
    texts = {f"across_{_case(across)}": f"{1 + across.meso_energy_shift_percent / 100:.3g}" for _, across in pairs} | {
        f"across_shift_{_case(across)}": f"{across.shift_percent:+.1f}" for _, across in pairs
    }
    for (pair, variant), rows in table.groupby(["pair", "variant"]):
        reach = "across" if variant == ACROSS else "touching"
        for name, column in (("published", "published"), ("measured", "experiment")):
            rms = np.sqrt(np.mean(rows[f"{column}_deviation_percent"] ** 2))
            texts[f"{reach}_rms_{name}_{pair}"] = f"{rms:.1f}"
    return texts


def sealed(safe_lengths, stoppers):
    """``sealed_rms17_beam``, ``sealed_rms17_tip``: safe length in dry air, p = 0.001, beam or either holds [µm].

    ``sealed_bare``, ``sealed_bare_stuck``: pull-off force of a stopper [µN], and P(stuck) [%]; so on for each stopper.
    """
    texts = {}
    for row in safe_lengths[np.isclose(safe_lengths.share, 1e-3)].itertuples():
        held_by = "beam" if row.held_by == "beam" else "tip"
        texts[f"sealed_{row.device}_{held_by}"] = bounding(row.safe_length_um, 3, up=False)
    for device, rows in stoppers.groupby("device"):
        first = rows.iloc[0]
        texts[f"sealed_{device}"] = f"{first.pull_off_uN:.2g}"
        texts[f"sealed_{device}_stuck"] = f"{100 * first.share_stuck:.3g}"
    return texts


def _both_reaches(table):
    """Rows of each case without and with attraction across gaps."""
    of = {variant: rows.itertuples() for variant, rows in table.groupby("variant")}
    return zip(of["base"], of[ACROSS], strict=True)


def readings(table):
    """``island_5_water_a``: root mean square deviation from the published lengths under a reading, on a grid [%].

    ``error_summit``: largest standard error of a length [%]; ``strips_summit``: number of strips.
    """
    texts = {}
    for row in table.itertuples():
        texts[f"{row.reading}_{row.spacing_nm:g}_{row.vdw}_{row.pair}"] = f"{row.rms_published_percent:.1f}"
    for reading, rows in table.groupby("reading"):
        texts[f"error_{reading}"] = f"{rows.change_se_percent.max():.1g}"
        texts[f"strips_{reading}"] = str(rows.strips.max())
    return texts


def pressing(table):
    """``pressed_c_060``: ratio of the energies after the last press; ``adhered_c``: largest change by adhesion [%]."""
    texts = {}
    for pair, rows in table.groupby("pair"):
        alone, last = rows[rows.press == 0], rows[rows.press == rows.press.max()]
        texts[f"adhered_{pair}"] = f"{100 * (alone.energy_ratio - 1).abs().max():.1g}"
        texts[f"pressed_MPa_{pair}"] = f"{last.pressure_MPa.iloc[0]:.0f}"
        texts[f"pressed_at_H_{pair}"] = f"{last.at_hardness_percent.iloc[0]:.1g}"
        for row in last.itertuples():
            name = f"pressed_{pair}_{_digits(row.relative_humidity)}"
            texts[name] = with_error(row.energy_ratio, row.energy_ratio_se)
    return texts


def deviations(table_3):
    """``published_a``: range of the deviations of model NG [%]; ``measured_rms_a``: root mean square [%].

    ``measured_scatter``: smallest relative standard deviation of a measured crack length [%].
    """
    texts = {"measured_scatter": f"{100 * (table_3.experiment_std_um / table_3.experiment_um).min():.1f}"}
    for pair, rows in table_3[table_3.model == "NG"].groupby("pair"):
        off = rows.deviation_percent
        texts[f"published_{pair}"] = f"{off.min():+.0f} to {off.max():+.0f}"
        texts[f"measured_rms_{pair}"] = f"{np.sqrt(np.mean(rows.experiment_deviation_percent**2)):.1f}"
    return texts


def statements(table_3, variants):
    """What our tables say about statements of the paper.

    ``nearer_ng``: cases in which model NG is nearer to the measured length than model G, or G has no length;
    ``nearer_ng_alone``: the latter; ``nearer_g``: the other cases; ``steadier_ng``: cases in which ē scatters less with
    NG; ``with_summits_a``, ``without_summits_a``: deviation of pair a from measured lengths with the spectrum that has
    the measured summits, and with the printed one [%]; ``printed_energies_c``: range of Γ by the
    measured mean lengths of pair c, ``…_1`` by lengths a standard deviation beyond [mJ/m²].
    """
    models = table_3[table_3.experiment_um.notna()].pivot(index=["pair", "relative_humidity"], columns="model")
    off = np.log(models.crack_length_um.div(models.experiment_um.NG, axis=0)).abs()
    is_nearer, scatter = ~(off.G <= off.NG), models.meso_energy_cv
    nearer_g = ", ".join(f"{pair} {humidity:.2f}" for pair, humidity in off.index[~is_nearer])
    texts = {"nearer_ng": str(is_nearer.sum()), "nearer_ng_alone": str(off.G.isna().sum()), "nearer_g": nearer_g}
    texts["steadier_ng"] = str((scatter.NG < scatter.G).sum())
    texts |= {"stickier_ng": str((models.meso_energy_J_per_m2.NG > models.meso_energy_J_per_m2.G).sum())}
    texts |= trends(models.xs("NG", axis=1, level="model"))
    for name, variant in (("with", "psd_identified"), ("without", "base")):
        rows = variants[(variants.pair == "a") & (variants.variant == variant)]
        texts[f"{name}_summits_a"] = f"{np.sqrt(np.mean(rows.experiment_deviation_percent**2)):.1f}"
    beam = cantilever(in_si(Cantilevers, sections(Plan(paper()), "c")), "c")
    of_c = table_3[(table_3.model == "NG") & (table_3.pair == "c")]
    for name, deviations in (("", 0), ("_1", 1)):
        longest = (of_c.experiment_um + deviations * of_c.experiment_std_um).max()
        shortest = (of_c.experiment_um - deviations * of_c.experiment_std_um).min()
        energies = TO_MJ * apparent_adhesion_energy(np.array([longest, shortest]) / TO_UM, beam)
        texts[f"printed_energies_c{name}"] = "{:.2g} to {:.2g}".format(*energies)
    return texts


def statements_of_studies(tables):
    """What our studies say about statements of the paper.

    ``radius_B2_NG``: mean radius of the summits of B2 with its heights, ``…_G`` with Gaussian ones [µm];
    ``slope_rms_dry``, ``…_wet``: slope of ln ē over the rms in the driest and wettest air, and so on; ``off_a``: mean
    deviation from measured lengths [%], ``off_b_088`` that of one; ``without_vdw_least``, ``…_most``: how much less ē
    is without van der Waals forces [%]; ``gamma_a_060``: Γ/2γ [%].
    """
    surfaces, slopes, variants = (tables[name] for name in ("table_1", "sensitivity", "variants"))
    radii = surfaces[surfaces.surface == "B2"].set_index("column").mean_summit_radius_um
    texts = {f"radius_B2_{model}": f"{radii[model]:.2f}" for model in ("NG", "G")}
    for moment, rows in slopes[slopes.statistic == "mean"].groupby("moment"):
        ends = rows.sort_values("relative_humidity").slope.values
        texts |= {f"slope_{moment}_dry": f"{ends[0]:.2g}", f"slope_{moment}_wet": f"{ends[-1]:.2g}"}
    known = tables["table_3"].query("model == 'NG' and experiment_um.notna()").set_index(["pair", "relative_humidity"])
    off = 100 * np.abs(known.crack_length_um / known.experiment_um - 1)
    texts |= {f"off_{pair}": f"{mean:.2g}" for pair, mean in off.groupby("pair").mean().items()}
    without = -variants[variants.variant == "van_der_waals_none"].meso_energy_shift_percent
    texts |= {"without_vdw_least": f"{without.min():.2g}", "without_vdw_most": f"{without.max():.2g}"}
    shares = tables["supplement_shares"].set_index(["pair", "RH"])["Γ/2γ [%]"]
    return texts | {"off_b_088": f"{off['b', 0.88]:.2g}", "gamma_a_060": f"{shares['a', 0.6]:.2g}"}


def trends(models):
    """``growing_pairs``: pairs whose ē grows with every humidity; ``energies_at_080``: ē of all pairs [mJ/m²].

    ``scatter_ends_a``: std / mean of ē at the ends of the humidities [%].
    """
    energies, scatter = models.meso_energy_J_per_m2, 100 * models.meso_energy_cv
    growing = [of.is_monotonic_increasing for _, of in energies.groupby("pair")]
    texts = {"growing_pairs": str(sum(growing))}
    texts["energies_at_080"] = ", ".join(
        f"{TO_MJ * energy:.2g}" for energy in energies.xs(0.8, level="relative_humidity")
    )
    ends = {pair: of.iloc[[0, -1]] for pair, of in scatter.groupby("pair")}
    return texts | {f"scatter_ends_{pair}": "{:.2g} to {:.2g}".format(*of) for pair, of in ends.items()}


def intervals(table_3):
    """``contained_68``: measured lengths in their intervals, ``width_68``: median half-width [%], ``…_a`` of a pair.

    ``naive_68``: the largest root mean square deviation of a pair, for all; ``naive_contained_68``: lengths in it. For
    95 %, these have twice the width. ``measured_lengths``: number of all.
    """
    rows = table_3[table_3.model == "NG"]
    off = np.log(rows.experiment_um / rows.crack_length_um).abs()
    naive = rows.experiment_deviation_percent.pow(2).groupby(rows.pair).mean().max() ** 0.5 / 100
    texts = {"measured_lengths": str(len(rows))}
    for sizes, coverage in enumerate(prediction.COVERAGES, 1):
        name = f"{100 * coverage:.0f}"
        low, high = (rows[end] for end in prediction.ENDS[coverage])
        widths = 100 * np.log(high / low) / 2
        texts[f"contained_{name}"] = str(prediction.count_contained(table_3, coverage)[0])
        texts |= {
            f"naive_{name}": f"{100 * sizes * naive:.0f}",
            f"naive_contained_{name}": str((off < sizes * naive).sum()),
        }
        texts |= {f"width_{name}": f"{widths.median():.0f}"}
        texts |= {f"width_{name}_{pair}": f"{of.median():.0f}" for pair, of in widths.groupby(rows.pair)}
    return texts


def finer(table):
    """``finer_least``, ``finer_most``: change of the lengths of pair c on a grid of 2.5 nm, as printed [%].

    ``finer_rms``: their rms deviation from print [%], and ``finer_base``, on 5 nm of the same samples.
    """
    groups = dict(list(table.groupby("variant")))
    (name,) = groups.keys() - {"base"}
    shift = groups[name].shift_percent
    rms = {key: np.sqrt(np.mean(group.published_deviation_percent**2)) for key, group in groups.items()}
    texts = {"least": shift.min(), "most": shift.max(), "rms": rms[name], "base": rms["base"]}
    return {f"finer_{key}": f"{value:.1f}" for key, value in texts.items()}


def supplement(tables):
    """Numbers of ``make supplement``.

    ``greenwood_a``: energy of model NG over that of Greenwood and Williamson's at the lowest humidity, ``…_wet_a`` at
    the highest; ``theta_a``: adhesion parameter; ``index_a``: plasticity index; ``size_a``: cv √area of the smallest
    patch over that of the largest; ``neighbours_B1``: correlation of neighbouring strips [%]; ``equal_b``: Γ/2γ at
    which both sources scatter Γ equally [%]; ``least_gamma_a``, ``most_gamma_a``: Γ/2γ over the humidities [%].
    """
    texts = {}
    for pair, rows in tables["supplement_greenwood_williamson"].groupby("pair"):
        ratio = (rows["ē, NG [mJ/m²]"] / rows["ē, GW [mJ/m²]"]).values
        texts |= {f"greenwood_{pair}": _rounded(ratio[0]), f"greenwood_wet_{pair}": _rounded(ratio[-1])}
        texts[f"theta_{pair}"] = f"{rows['θ'].iloc[0]:.0f}"
        texts[f"index_{pair}"] = f"{rows['plasticity index'].iloc[0]:.2f}"
    for pair, rows in tables["supplement_sizes"].groupby("pair"):
        scaled = rows["cv √area [µm]"].values
        texts[f"size_{pair}"] = f"{scaled[-1] / scaled[0]:.2f}"
    for row in tables["supplement_surfaces"].to_dict("records"):
        texts[f"neighbours_{row['surface']}"] = f"{100 * row['neighbouring strips']:.1f}"
    shares = tables["supplement_shares"]
    texts |= {f"equal_{pair}": f"{share:.1f}" for pair, share in equal_shares(shares).items()}
    for pair, rows in shares.groupby("pair"):
        ends = rows["Γ/2γ [%]"]
        texts |= {f"least_gamma_{pair}": f"{ends.min():.2g}", f"most_gamma_{pair}": f"{ends.max():.2g}"}
    return texts


def equal_shares(shares):
    """Γ/2γ at which surfaces and dimensions scatter Γ equally, by pair [%]: between the humidities around it.

    Examples
    --------
    >>> rows = pd.DataFrame({"pair": "b", "Γ/2γ [%]": [1, 4], "surfaces [%]": [20, 5], "dimensions [%]": 10})
    >>> equal_shares(rows)
    {'b': 2.0}
    """
    found = {}
    for pair, rows in shares.groupby("pair"):
        ratio = np.log(rows["surfaces [%]"] / rows["dimensions [%]"]).values
        places = np.log(rows["Γ/2γ [%]"].values)
        below = np.flatnonzero(ratio < 0)
        if len(below) and below[0] > 0:
            around = [below[0], below[0] - 1]
            found[pair] = round(float(np.exp(np.interp(0.0, ratio[around], places[around]))), 6)
    return found


def _rounded(ratio):
    """Ratio as text, a large one as a power of ten."""
    if ratio < 1000:
        return f"{ratio:.2g}" if ratio < 100 else f"{ratio:.0f}"
    return "10" + str(round(np.log10(ratio))).translate(str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹"))


def printed(table, studies):
    """``base_rms_a``, ``print_rms_a``: deviations of model NG from print under both readings [%]; ``…_GEO_a`` of GEO.

    ``…_mean_…``: their mean; ``…_measured_…``: rms deviation from the measured lengths; ``…_scatter_…``: geometric mean
    of the standard deviation over the printed one; ``print_std_b_044``: standard deviation of NG [µm], ``base_std_…``
    and ``printed_std_…`` beside it. ``print_mesh_excess`` and others: scalars of the studies under the reading.
    """
    texts = {f"print_{name}": text for name, text in texts_of(studies).items()}
    for (model, pair), rows in table.groupby(["model", "pair"]):
        end = f"_{pair}" if model == "NG" else f"_{model}_{pair}"
        for name in ("base", "print"):
            off, measured = (rows[f"{name}_{which}_percent"] for which in ("deviation", "measured_deviation"))
            texts[f"{name}_rms{end}"] = f"{np.sqrt(np.mean(off**2)):.1f}"
            texts[f"{name}_mean{end}"] = f"{off.mean():+.1f}"
            texts[f"{name}_measured{end}"] = f"{np.sqrt(np.mean(measured**2)):.1f}"
            texts[f"{name}_scatter{end}"] = f"{np.exp(np.log(rows[f'{name}_scatter_ratio']).mean()):.2f}"
    for row in table[table.model == "NG"].itertuples():
        stds = row.base_crack_length_std_um, row.print_crack_length_std_um, row.published_std_um
        names = ("base", "print", "printed")
        texts |= {f"{name}_std_{_case(row)}": f"{std:.2g}" for name, std in zip(names, stds, strict=True)}
    return texts


def energies(table_3):
    """``e_b_044_NG``: mean ē [mJ/m²], ``cv_…``: its scatter [%], ``gain_b_044``: NG over G; samples without a law."""
    texts = {}
    for row in table_3.itertuples():
        name = f"{_case(row)}_{row.model}"
        texts[f"e_{name}"] = f"{TO_MJ * row.meso_energy_J_per_m2:.3g}"
        texts[f"cv_{name}"] = f"{100 * row.meso_energy_cv:.0f}"
        texts[f"lawless_{name}"] = f"{100 * row.share_without_law:.2g}"
        texts[f"lawful_{name}"] = f"{100 * (row.meso_energy_lawful_J_per_m2 / row.meso_energy_J_per_m2 - 1):.0f}"
    by_model = {model: rows for model, rows in table_3.groupby("model")}
    for gaussian, other in zip(by_model["G"].itertuples(), by_model["NG"].itertuples(), strict=True):
        texts[f"gain_{_case(other)}"] = f"{other.meso_energy_J_per_m2 / gaussian.meso_energy_J_per_m2:.0f}"
    below = by_model["NG"][by_model["NG"].adhesion_energy_J_per_m2 < by_model["NG"].meso_energy_J_per_m2]
    texts["arrest_below_mean"] = _listed(
        f"pair {row.pair} at RH {row.relative_humidity:.2f}" for row in below.itertuples()
    )
    return texts


def surfaces(table_1):
    """``radius_B2_NG`` [µm], ``summits_B2_NG`` [µm⁻²] and, with ``published_`` before the name, those of the paper."""
    texts = {}
    for row in table_1.itertuples():
        name = f"{row.surface}_{row.column}"
        texts[f"radius_{name}"] = f"{row.mean_summit_radius_um:.2f}"
        texts[f"summits_{name}"] = f"{row.summit_density_per_um2:.0f}"
        texts[f"published_radius_{name}"] = f"{row.mean_summit_radius_um_published:g}"
        texts[f"published_summits_{name}"] = f"{row.summit_density_per_um2_published:g}"
    return texts


def identification(table_2):
    """``identified_B1``: larger of the deviations of radius and density [%]."""
    rows = table_2[table_2.psd == "identified"]
    off = np.maximum(rows.radius_residual_percent.abs(), rows.density_residual_percent.abs())
    texts = {f"identified_{surface}": f"{value:.1f}" for surface, value in zip(rows.surface, off, strict=True)}
    return texts | {"identified_but_Sub2": f"{off[rows.surface != 'Sub2'].max():.1f}"}


def fits(fit_quality):
    """Range over the cases of the mean error of Eq. (12), model NG [%]."""
    error = fit_quality[fit_quality.model == "NG"].curve_error_percent
    return {"fit_least": f"{error.min():.0f}", "fit_most": f"{error.max():.0f}"}


def variants(table):
    """``shift_spacing_nm_5_a``: largest change of a mean crack length by a variant [%], and its humidity."""
    texts = {}
    for (pair, name), rows in table[table.variant != "base"].groupby(["pair", "variant"]):
        row = rows.loc[rows.shift_percent.abs().idxmax()] if rows.shift_percent.notna().any() else rows.iloc[0]
        texts[f"shift_{name}_{pair}"] = f"{abs(row.shift_percent):.1f}"
        texts[f"shift_{name}_{pair}_at"] = f"{row.relative_humidity:.2f}"
    return texts


def removed(table):
    """``removed_spacing_nm_5_a``: share of the deviation from the published lengths that a variant removes [%]."""
    first = table[table.variant != "base"].groupby(["pair", "variant"]).first()
    return {
        f"removed_{name}_{pair}": with_error(row.removed_percent, row.removed_se_percent)
        for (pair, name), row in first.iterrows()
    }


def slopes(sensitivity):
    """``slope_skewness_044``: sensitivity of the mean ē ± standard error; ``published_slope_…``.

    ``less_skewness_044``, ``more_skewness_044``: one-sided differences; ``lowered_skewness_044``: by how much more of
    the moment, one step, lowers ē [%].
    """
    texts = {}
    for row in sensitivity[sensitivity.statistic.str.startswith("mean, ")].itertuples():
        step = float(row.statistic.removeprefix("mean, ").removesuffix(" %"))
        name = f"{row.moment}_{_digits(row.relative_humidity)}"
        texts[f"{'more' if step > 0 else 'less'}_{name}"] = with_error(row.slope, row.slope_se)
        texts |= {f"lowered_{name}": f"{-step * row.slope:.0f}", "sensitivity_step": f"{step:g}"} if step > 0 else {}
    for row in sensitivity[sensitivity.statistic == "mean"].itertuples():
        name = f"{row.moment}_{_digits(row.relative_humidity)}"
        texts[f"slope_{name}"] = with_error(row.slope, row.slope_se)
        texts[f"published_slope_{name}"] = number(row.published, "g")
    return texts


def chaos(resampling):
    """Largest difference of a mean crack length between laws of the chaos model and of the samples [%]."""
    return {"chaos_most": f"{resampling.difference_percent.abs().max():.1f}"}


def tails(table):
    """``tail_c_060_touching``, ``parabola_c_060_touching``: cracks on curves over those on Eq. (12), or parabolas [%].

    ``tail_right``: the largest change by the right branch of the curves [%]; ``tail_left_least``, ``tail_left_most``:
    energy left of d_max over that of the curves [-]; ``tail_energy_a``: dry energy over that of touching summits [-].
    The table has texts, as the script of ``make tails`` prints them.
    """
    texts, energies = {}, table[["ē [mJ/m²]", "touching summits alone [mJ/m²]"]].map(_value)
    for row, energy in zip(table.to_dict("records"), energies.itertuples(index=False), strict=True):
        is_dry = row["air"] == "dry"
        case = f"{row['pair']}_{'dry' if is_dry else _digits(_value(row['air'].removeprefix('RH ')))}_{row['reach']}"
        texts[f"tail_{case}"] = row["ln l_s, curves over Eq. (12) [%]"]
        texts[f"parabola_{case}"] = row["curves over parabola [%]"]
        texts |= {f"tail_energy_{row['pair']}": f"{energy[0] / energy[1]:.0f}"} if is_dry else {}
    left = table["energy left of d_max, Eq. (12) over curves"].map(_value)
    right = table["right branch of the curve over Eq. (12) [%]"].map(_value)
    ends = {"tail_left_least": left.min(), "tail_left_most": left.max(), "tail_right": right.abs().max()}
    return texts | {name: f"{value:.1f}" for name, value in ends.items()}


def _value(text):
    """The number before an error."""
    return float(text.split(" ± ")[0])


def texts_of(table):
    """Scalars of the studies by name, as written by `update.scalars`."""
    return {row.name: row.text for row in table.itertuples(index=False)}


def checks(table):
    """``checks`` and ``checks_passed``: number of checks and of those that passed."""
    return {"checks": f"{len(table)}", "checks_passed": f"{int(table.passed.sum())}"}


def mesh(checks):
    """``mesh_off``: largest error of a crack length on uniform ground by the mesh of the paper [%]."""
    messages = checks[checks["name"] == RESOLVED].message
    off = [abs(float(re.search(r"([-+][\d.]+) % off", message)[1])) for message in messages]
    return {"mesh_off": f"{max(off):.1f}", "mesh_allowed": f"{100 * COARSER_ACCURACY:g}"}


def scans(table):
    """``scan_errors``: error of the skewness of a scan of the example over that of independent points."""
    row = next(table[table.surface == "Etched"].itertuples())
    independent = np.sqrt(6 / (row.points_fast * row.points_slow))
    return {"scan_errors": f"{row.skewness_se / independent:.0f}"}


def timings(table):
    """``time_paper``: minutes and seconds, or seconds, of every row."""
    return {f"time_{row.name}": _duration(row.seconds) for row in table.itertuples(index=False)}


def constants():
    """Constants of the package that pages state."""
    return {
        "longest_strip": f"{STRIP:g}",
        "longest_element": f"{ELEMENT:g}",
        "mesh_accuracy": f"{100 * ACCURACY:g}",
        "films": f"{FILMS:g}",
    }


def forces_on_summits():
    """``short_5_067``: percent by which forces on summits are too small at 0.5 nm rms and RH 0.67; ``short``: most."""
    texts = {"short": f"{100 * smooth_pairs.largest_shortfall():.2g}"}
    for beam, rms in zip(smooth_pairs.OF_BEAMS, smooth_pairs.RMS, strict=True):
        for humidity in smooth_pairs.HUMIDITIES:
            short, error = (100 * part for part in smooth_pairs.shortfall(rms, humidity))
            texts[f"short_{10 * beam:.0f}_{_digits(humidity)}"] = f"{short:.0f} ± {max(error, 1):.0f} %"
    return texts


def nearly_gaussian():
    """``kurtosis_01``: largest at skewness ± 0.1; ``near_1``, ``near_1_off``: moments used for `NEARLY_GAUSSIAN`."""
    errors = np.sqrt(np.diag(feasible.sampling_covariance(feasible.SAMPLE)))
    texts = {
        f"kurtosis_{skewness:02.0f}": f"{feasible.largest_kurtosis(skewness / 10):.2f}" for skewness in (0, 1, 3, 5, 10)
    }
    texts |= {"scan_heights": str(feasible.SAMPLE), "farthest": f"{feasible.LARGEST_DISTANCE:.2f}"}
    texts |= {"farthest_scans": f"{feasible.LARGEST_DISTANCE_OF_SCANS:.2f}"}
    texts |= {f"error_of_{name}": f"{error:.2g}" for name, error in zip(("skewness", "kurtosis"), errors, strict=True)}
    for k, measured in enumerate(NEARLY_GAUSSIAN, 1):
        used = feasible.nearest_feasible(*measured)
        texts |= {f"near_{k}": f"{used.skewness:.3f}, {used.kurtosis:.3f}".replace("-", "−")}
        texts |= {f"near_{k}_off": f"{used.distance:.2f}"}
        texts |= {f"near_{k}_of": f"{measured[0]:g}, {measured[1]:g}".replace("-", "−")}
    return texts


def safe_lengths(table):
    """``safe_C1_067_1e-03``: safe length of a device [µm], held by the beam alone; ``…_tip``: by beam or tip."""
    texts = {}
    for row in table.itertuples():
        name = f"safe_{row.device}_{_digits(row.relative_humidity)}_{row.share:.0e}".replace("-", "")
        texts[name + ("_tip" if row.held_by == "beam or tip" else "")] = bounding(row.safe_length_um, 3, up=False)
    return texts


def stoppers(table):
    """``worst_S1``: worst humidity; ``stuck_S1_067``: P(stuck) [%]; ``force_S1_067_1e02``: safe force [µN].

    In the worst of all computed airs they are called ``force_S1_any_1e02`` and so on.
    """
    texts = {}
    for row in table.to_dict("records"):
        air = row["relative_humidity"]
        name = f"{row['device']}_{_digits(air) if air >= 0 else 'any'}"
        texts[f"worst_{row['device']}"] = f"{row['worst_humidity']:.2f}"
        texts[f"stuck_{name}"] = f"{100 * row['share_stuck']:.2g}"
        shares = [key.rpartition("_")[2] for key in row if key.startswith("safe_force_uN")]
        texts |= {
            f"force_{name}_{float(share):.0e}".replace("-", ""): bounding(row[f"safe_force_uN_{share}"], 3, up=True)
            for share in shares
        }
    return texts


def budget(table):
    """``total_C1_067``, ``independent_C1_067`` and ``scatter_C1_067`` [%]; ``best_C1_067``: what to measure better.

    Those of tips are called ``total_C1_067_tip`` and so on.
    """
    texts = {}
    for (device, humidity, held_by), rows in table.groupby(["device", "relative_humidity", "held_by"]):
        name = f"{device}_{_digits(humidity)}" + ("_tip" if held_by == "tip" else "")
        totals = rows[rows.part == "total"].effect_percent.values
        texts |= {
            f"{what}_{name}": f"{value:.1f}" for what, value in zip(("total", "independent"), totals, strict=True)
        }
        texts[f"scatter_{name}"] = f"{rows[rows.part == 'scatter'].effect_percent.iloc[0]:.2g}"
        best = rows.loc[rows.remaining_percent.idxmin()]
        texts |= {f"best_{name}": best["name"], f"left_{name}": f"{best.remaining_percent:.1f}"}
        inputs = rows[rows.part == "input"]
        for entry in inputs.itertuples():
            quantity = entry.name.replace("'", "").replace(" ", "_")
            texts[f"slope_{name}_{quantity}"] = with_error(entry.slope, entry.slope_se)
    return texts


def answers(table):
    """``build_C1``: size to build [µm, µN], ``stricter_C1``: what is stricter; ``step_C1_inputs``: after a step."""
    texts = {}
    for row in table.to_dict("records"):
        up, before = row["unit"] == "µN", row["after_estimate"]
        texts |= {
            f"build_{row['device']}": bounding(row["to_build"], 3, up),
            f"measure_{row['device']}": row["measure"],
            f"stricter_{row['device']}": row["stricter"].replace("; ", " and "),
        }
        for cause in Cause:
            size = row[f"after_{cause}"]
            if np.isfinite(size):
                texts[f"step_{row['device']}_{cause}"] = bounding(size, 3, up)
                texts[f"change_{row['device']}_{cause}"] = f"{100 * (size / before - 1):+.1f}".replace("-", "−")
                before = before if cause is Cause.FAST else size
    return texts


def _duration(seconds):
    """Seconds as ``8:02 min``, or as ``26 s`` below 100 s."""
    return f"{seconds // 60:.0f}:{seconds % 60:02.0f} min" if seconds >= 100 else f"{seconds:g} s"


def _case(row):
    return f"{row.pair}_{_digits(row.relative_humidity)}"


def _digits(humidity):
    return f"{humidity:.2f}".replace(".", "")


def _listed(parts):
    parts = list(parts)
    return " and ".join([", ".join(parts[:-1]), parts[-1]] if len(parts) > 1 else parts) or "no case"


def of_markdown(path):
    """A table in Markdown as texts."""
    head, _, *rows = ([cell.strip() for cell in line.split("|")[1:-1]] for line in path.read_text("utf-8").splitlines())
    return pd.DataFrame(rows, columns=head)


def licensed(path):
    """A table in CSV whose first line is its licence."""
    return pd.read_csv(path, skiprows=1)


def frame(path):
    """A table in CSV; text columns stay text."""
    return pd.read_csv(path, keep_default_na=True, dtype={"pair": str, "name": str, "text": str})
