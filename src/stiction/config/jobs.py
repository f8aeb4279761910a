"""Settings of every job: exactly the part of the configuration on which it depends.

There is one function per rule of the workflow. The settings are parameters of the jobs of the rule, so that a changed
key reruns only the jobs whose settings contain it. Settings are plain numbers, strings, lists and dicts, with the units
of the configuration in their keys; `stiction.config.units.typed` converts them to the objects that the stages take.
Where a function takes only a `stiction.config.plan.Plan`, the settings are the same for all jobs of the rule.
"""

from collections.abc import Iterable

from stiction.config.cases import case_id, humidity_of, pair_of
from stiction.config.plan import MOMENTS, SUMMITS, Plan, chosen


def _strip(plan):
    """The part of section ``sampling`` on which beams depend."""
    return chosen(plan.config["sampling"], ["strip_length_um"])


def _width(plan):
    """The part of section ``beam`` on which surfaces and contact depend."""
    return chosen(plan.config["beam"], ["width_um"])


def cantilevers(plan: Plan, *pairs: str) -> dict:
    """Sections from which `stiction.stages.cantilevers` builds the nominal beams of pairs."""
    return {
        "solid": chosen(plan.config["solid"], ["young_modulus_GPa"]),
        "beam": chosen(plan.config["beam"], ("length_um", "width_um", "thickness_um", "elements")),
        "pairs": {pair: chosen(plan.config["pairs"][pair], ["gap_um"]) for pair in pairs},
    }


# Sec. II


def heights(plan: Plan, surface: str) -> dict:
    """Moments of a surface."""
    return chosen(plan.config["surfaces"][surface], MOMENTS)


def identification(plan: Plan, surface: str) -> dict:
    """Measured summits of a surface and the patches on which its spectrum is identified."""
    return chosen(plan.config, ("seed", "identification")) | {
        "spacing_nm": plan.config["sampling"]["spacing_nm"],
        "target_spacing_nm": plan.config["character"]["spacing_nm"],
        "target": chosen(plan.config["surfaces"][surface], SUMMITS),
    }


def spectrum(plan: Plan, surface: str) -> dict:
    """Published spectrum of a surface, or ``identified`` with the strips it is used for, and the grid."""
    entry, sampling = plan.config["surfaces"][surface], plan.config["sampling"]
    if entry["psd"] == "published":
        return {"spacing_nm": sampling["spacing_nm"], "psd": entry["published_psd"]}
    use = {"surface": surface} | chosen(sampling, ("strip_length_um", "margin_um"))
    return {"spacing_nm": sampling["spacing_nm"], "psd": "identified", "identified": use}


def iteration(plan: Plan) -> dict:
    """Size of the study of Fig. 4 and the grid."""
    study = {"iteration": plan.config["studies"]["iteration"], "spacing_nm": plan.config["sampling"]["spacing_nm"]}
    return chosen(plan.config, ["seed"]) | study


def character(plan: Plan) -> dict:
    """Strips for Table I."""
    return chosen(plan.config, ("seed", "sampling", "character")) | {"beam": _width(plan)}


# Sec. III-A


def _meeting(plan, pair):
    """Settings for drawing a pair, with the names of the surfaces, because other input files alone rerun nothing."""
    shared = chosen(plan.config, ("seed", "sampling", "solid", "van_der_waals"))
    return shared | {"surfaces": plan.sides(pair), "beam": _width(plan)}


def _search(plan, **more):
    """Section ``contact`` without samples and chunks; the number of chunks does not affect the results."""
    return chosen(plan.config["contact"], ("distance_step_nm", "every")) | more


def contact(plan: Plan, pair: str) -> dict:
    """Everything that the contact of a pair depends on; independent of humidity and of the number of chunks."""
    return _meeting(plan, pair) | {"contact": _search(plan, samples=plan.config["contact"]["samples"])}


# Sec. III-B


def forces(plan: Plan, case: str) -> dict:
    """Water and humidity of a case; also the settings of stage fit."""
    return chosen(plan.config, ["water"]) | {"humidity": humidity_of(case)}


def chaos(plan: Plan) -> dict:
    """Truncation of the chaos model."""
    return chosen(plan.config, ("chaos", "seed"))


def humidity(plan: Plan, pair: str) -> dict:
    """Water and humidity axis of a pair."""
    humidities = plan.config["pairs"][pair]["humidities"]
    axis = {"points": plan.config["figures"]["humidity_points"], "range": [min(humidities), max(humidities)]}
    return chosen(plan.config, ["water"]) | axis


# Secs. III-C and IV


def _refined(plan, case):
    """Setting of beams whose elements follow the force laws; none for those on the mesh of the paper."""
    return {} if plan.has_mesh_of_paper(case) else {"refined": True}


def beams(plan: Plan, case: str, model: str) -> dict:
    """Nominal beam of a case, number of beams and scatter of their dimensions."""
    section = plan.config["beam"]
    number = {"samples": section["samples"], "scatter": section["scatter"] if model == "GEO" else 0}
    number |= _refined(plan, case)
    return chosen(plan.config, ["seed"]) | cantilevers(plan, pair_of(case)) | {"sampling": _strip(plan)} | number


# Studies outside the main line


def sensitivity_contact(plan: Plan, pair: str) -> dict:
    """As `contact`, with the number of samples and the step of Fig. 13."""
    study = plan.config["studies"]["sensitivity"]
    return _meeting(plan, pair) | {"contact": _search(plan, samples=study["samples"]), "step": study["step"]}


def sensitivity(plan: Plan, pair: str) -> dict:
    """Water and humidities of Fig. 13."""
    return chosen(plan.config, ["water"]) | {"humidities": plan.config["pairs"][pair]["humidities"]}


def plasticity(plan: Plan, pair: str) -> dict:
    """As `contact`, with the number of strips and the distance of App. A."""
    study = plan.config["studies"]["plasticity"]
    size = {"strips": study["strips"], "distance_nm": study["distance_nm"][pair]}
    return _meeting(plan, pair) | {"contact": _search(plan)} | size


def sample_sizes(plan: Plan) -> dict:
    """Shares of the samples of Fig. 17."""
    return {"shares": plan.config["studies"]["sample_shares"], "case": plan.figure_case}


def orders(plan: Plan) -> dict:
    """Number of draws of Fig. 18."""
    return chosen(plan.config, ["seed"]) | {
        "draws": plan.config["studies"]["orders"]["draws"],
        "case": plan.figure_case,
    }


def mesh(plan: Plan) -> dict:
    """Meshes of Fig. 19 and the nominal beam."""
    study = {"mesh": plan.config["studies"]["mesh"], "case": plan.figure_case, "pair": plan.figure_pair}
    return study | cantilevers(plan, plan.figure_pair)


def resampling(plan: Plan, case: str) -> dict:
    """As `beams`, with the number of beams of the study."""
    number = {"beams": plan.config["studies"]["resampling"]["beams"]} | _refined(plan, case)
    return chosen(plan.config, ["seed"]) | cantilevers(plan, pair_of(case)) | {"sampling": _strip(plan)} | number


def variant(plan: Plan, pair: str, name: str) -> dict:
    """Stages after contact under a variant: water, force laws and beams without scatter, at all humidities."""
    found = chosen(plan.config, ("seed", "water", "chaos")) | cantilevers(plan, pair) | {"sampling": _strip(plan)}
    found["beam"] |= {"samples": plan.config["studies"]["variants"]["beams"]} | plan.finer_beams.get(name, {})
    found["pairs"][pair] |= chosen(plan.config["pairs"][pair], ["humidities"])
    refined = [h for h in plan.config["pairs"][pair]["humidities"] if not plan.has_mesh_of_paper(case_id(pair, h))]
    return found | ({"refined": refined} if refined else {})


# Tables, checks and figures


def table_1(plan: Plan) -> dict:
    """Measured statistics of all surfaces, and the surfaces whose published values are shown."""
    entries = plan.config["surfaces"]
    measured = {name: chosen(entries[name], (*MOMENTS, *SUMMITS)) for name in plan.surfaces}
    return {"measured": measured, "of_paper": plan.paper_surfaces}


def moments(plan: Plan) -> dict:
    """Target moments of the drawn surfaces."""
    return {name: heights(plan, name) for name in plan.surfaces}


def skewed(plan: Plan, pairs: Iterable[str]) -> list[str]:
    """Pairs, out of some, without a positively skewed surface and with a negatively skewed one."""
    skewness = {pair: [plan.config["surfaces"][name]["skewness"] for name in plan.sides(pair)] for pair in pairs}
    return [pair for pair, values in skewness.items() if max(values) <= 0 > min(values)]


def table_2(plan: Plan) -> dict:
    """Spectrum in use of every surface with measured summits, and the surfaces whose published values are shown."""
    sources = {name: plan.config["surfaces"][name]["psd"] for name in plan.measured}
    return {"sources": sources, "of_paper": plan.paper_surfaces}


def table_3(plan: Plan) -> dict:
    """Cases of Table III, and the pairs whose published values are shown."""
    return {"outcomes": plan.outcomes, "of_paper": plan.paper_pairs}


def table_variants(plan: Plan) -> dict:
    """Pairs and variants, and the pairs whose published values are shown."""
    return {"studied": plan.studied, "of_paper": plan.paper_pairs}


def checks(plan: Plan) -> dict:
    """Results that are checked and their targets."""
    # The claim that negative skewness increases adhesion applies to the pairs of the paper only.
    return {
        "laws": plan.laws,
        "outcomes": plan.outcomes,
        "targets": moments(plan),
        "skewed": skewed(plan, plan.paper_pairs),
        "sampling": _strip(plan),
        "on_mesh_of_paper": [case for case in plan.cases if plan.has_mesh_of_paper(case)],
    } | cantilevers(plan, *plan.pairs)


def figure_case(plan: Plan) -> dict:
    """Pair and humidity of the figures that show one case."""
    return {"pair": plan.figure_pair, "humidity": plan.config["figures"]["humidity"]}


def figure_13(plan: Plan) -> dict:
    """Pair and moments of Fig. 13, and the pairs whose published values are shown."""
    return {"pair": plan.figure_pair, "moments": plan.shifted_moments, "of_paper": plan.paper_pairs}


def figure_15(plan: Plan) -> dict:
    """Cases of Fig. 15, water, the nominal beams, and the pairs whose published values are drawn."""
    shown = {"outcomes": plan.outcomes, "of_paper": plan.paper_pairs} | chosen(plan.config, ["water"])
    return shown | cantilevers(plan, *plan.pairs)


def figure_17(plan: Plan) -> dict:
    """Cases of Fig. 17 and the tolerance of the dimension reduction."""
    tolerance = plan.config["chaos"]["dimension_tolerance"]
    return {"cases": plan.cases, "tolerance": tolerance} | figure_case(plan)


def figure_overview(plan: Plan) -> dict:
    """Pair and humidities of the overview, and the pairs whose published values are shown."""
    humidities = plan.config["pairs"][plan.figure_pair]["humidities"]
    return figure_case(plan) | {"humidities": humidities, "of_paper": plan.paper_pairs}
