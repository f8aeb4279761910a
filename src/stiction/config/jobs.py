"""Settings of every job: exactly the part of the configuration on which it depends.

There is one function per rule of the workflow. The settings are parameters of the jobs of the rule, so that a changed
key reruns only the jobs whose settings contain it. Settings are plain numbers, strings, lists and dicts, with the units
of the configuration in their keys; `stiction.config.units.typed` converts them to the objects that the stages take.
Where a function takes only a `stiction.config.plan.Plan`, the settings are the same for all jobs of the rule.
"""

from collections.abc import Iterable
from pathlib import Path

from stiction.config import measured
from stiction.config.cases import humidity_of, pair_of
from stiction.config.designs import KEYS_OF_SOLIDS, OF_TIPS, Designs, Patch, hamaker_constants
from stiction.config.files import paper
from stiction.config.merging import merged
from stiction.config.plan import ELASTIC, MOMENTS, SUMMITS, Plan, chosen
from stiction.config.units import NM_PER_UM
from stiction.models import SHIFTED, SIDES


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
        "pairs": {pair: chosen(plan.config["pairs"][pair], ["gap_um"]) | plan.beam_modulus(pair) for pair in pairs},
    }


# Sec. II


def scan(plan: Plan, surface: str, number: str) -> dict:
    """File of a scan by its content, and how it is read; the folder of the file does not affect the result."""
    path = plan.scan_files(surface)[number]
    source = measured.source(plan.config["surfaces"][surface])
    return {"file": Path(path).name, "sha256": measured.digest(path), "source": source}


def estimate(plan: Plan, surface: str) -> dict:
    """How the scans of a surface are evaluated, with the names of the files: other files alone rerun nothing."""
    evaluation = measured.evaluation(plan.config["surfaces"][surface], plan.config["scans"])
    files = [Path(path).name for path in plan.scan_files(surface).values()]
    number = plan.config["scans"]["model_scans"]
    return chosen(plan.config, ["seed"]) | {"evaluation": evaluation, "model_scans": number, "files": files}


def heights_of_scans(plan: Plan, surface: str) -> dict:
    """Source of the heights of a measured surface."""
    return {"surface": surface} | chosen(plan.config["surfaces"][surface], ["heights"])


def spectrum_of_scans(plan: Plan, surface: str) -> dict:
    """Source of the spectrum of a measured surface, the strips it is used for, and the grid."""
    sampling = plan.config["sampling"]
    use = {"surface": surface} | chosen(sampling, ("strip_length_um", "margin_um"))
    source = chosen(plan.config["surfaces"][surface], ("psd", "beyond"))
    return source | {"spacing_nm": sampling["spacing_nm"], "use": use}


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


def _surface_pair(plan, pair, properties=ELASTIC):
    """Settings for drawing a pair, with the names of the surfaces, because other input files alone rerun nothing."""
    shared = chosen(plan.config, ("seed", "sampling", "solid", "van_der_waals"))
    return shared | {"surfaces": plan.sides(pair), "beam": _width(plan)} | plan.materials(pair, properties)


def _search(plan, **more):
    """Section ``contact`` without samples and chunks; the number of chunks does not affect the results."""
    return chosen(plan.config["contact"], ("distance_step_nm", "every")) | more


def contact(plan: Plan, pair: str) -> dict:
    """Everything that the contact of a pair depends on; independent of humidity and of the number of chunks."""
    return _surface_pair(plan, pair) | {"contact": _search(plan, samples=plan.config["contact"]["samples"])}


# Sec. III-B


def forces(plan: Plan, case: str) -> dict:
    """Water and humidity of a case; also the settings of stage fit."""
    return {"water": plan.water(pair_of(case)), "humidity": humidity_of(case)}


def chaos(plan: Plan) -> dict:
    """Truncation of the chaos model."""
    return chosen(plan.config, ("chaos", "seed"))


def humidity(plan: Plan, pair: str) -> dict:
    """Water and humidity axis of a pair."""
    humidities = plan.config["pairs"][pair]["humidities"]
    axis = {"points": plan.config["figures"]["humidity_points"], "range": [min(humidities), max(humidities)]}
    return {"water": plan.water(pair)} | axis


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
    """As `contact`, with the number of samples, the moments and the step of Fig. 13."""
    study = plan.config["studies"]["sensitivity"]
    shifts = {"moments": plan.shifted_moments, "step": study["step"]}
    return _surface_pair(plan, pair) | {"contact": _search(plan, samples=study["samples"])} | shifts


def slope_contact(plan: Plan, pair: str) -> dict:
    """As `contact`, with the number of samples of the slopes."""
    return _surface_pair(plan, pair) | {"contact": _search(plan, samples=plan.config["studies"]["slopes"]["samples"])}


def _samples_of_slopes(plan):
    """Number of samples of a contact that is compared with the first samples of the contact itself."""
    return min(plan.config["studies"]["slopes"]["samples"], plan.config["contact"]["samples"])


def choice_contact(plan: Plan, pair: str) -> dict:
    """As `contact`, with the number of samples of the slopes, at most its own, and the sources of measured surfaces."""
    entries = {name: plan.config["surfaces"][name] for name in plan.scanned_sides(pair)}
    sources = {name: chosen(entry, ("heights", "psd", "beyond")) for name, entry in entries.items()}
    return _surface_pair(plan, pair) | {"contact": _search(plan, samples=_samples_of_slopes(plan)), "sources": sources}


def sensitivity(plan: Plan, pair: str) -> dict:
    """Water and humidities of Fig. 13; also the settings of study slopes."""
    return {"water": plan.water(pair), "humidities": plan.config["pairs"][pair]["humidities"]}


def plasticity(plan: Plan, pair: str) -> dict:
    """As `contact`, with the number of strips and the distance of App. A."""
    study = plan.config["studies"]["plasticity"]
    size = {"strips": study["strips"], "distance_nm": study["distance_nm"][pair]}
    return _surface_pair(plan, pair, (*ELASTIC, "hardness_GPa")) | {"contact": _search(plan)} | size


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


def variant(plan: Plan, case: str, name: str) -> dict:
    """Stages after contact under a variant: samples of the contact, water, force laws and beams without scatter."""
    pair, study = pair_of(case), plan.config["studies"]["variants"]
    found = chosen(plan.config, ("seed", "chaos")) | {"water": plan.water(pair)} | cantilevers(plan, pair)
    found["beam"] |= {"samples": study["beams"]} | plan.finer_beams.get(name, {})
    return found | chosen(study, ["samples"]) | {"sampling": _strip(plan)} | _refined(plan, case)


# Devices


def _on_patch(plan, pair, length, width, samples):
    """As `contact`, on a patch of another size [nm]."""
    size = {"strip_length_um": int(length) / NM_PER_UM}
    found = _surface_pair(plan, pair) | {"contact": _search(plan, samples=samples)}
    return found | {"sampling": found["sampling"] | size, "beam": {"width_um": int(width) / NM_PER_UM}}


def device_contact(plan: Plan, pair: str, length: int, width: int) -> dict:
    """As `contact`, for a device whose patch of surface differs from the strips of the main line; sides in nm."""
    return _on_patch(plan, pair, length, width, plan.config["contact"]["samples"])


def tip_contact(plan: Plan, pair: str, length: int, width: int) -> dict:
    """As `device_contact`, for the tilted strips that hold the tips of beams; every beam has its own."""
    found = _on_patch(plan, pair, length, width, plan.config["design"]["beams"])
    step = {"distance_step_nm": OF_TIPS * found["contact"]["distance_step_nm"]}
    tips = Patch(pair, int(length), int(width))
    return found | {"contact": found["contact"] | step, "tilt": Designs(plan.config).tilt(tips)}


def _device(plan, name):
    """Kind, pair and dimensions of a beam, and the length of its strips."""
    section = plan.config["devices"][name]
    sizes = chosen(section, ("kind", "pair", "thickness_um", "gap_um", "width_um", "residual_stress_MPa"))
    modulus = chosen(plan.config["solid"], ["young_modulus_GPa"]) | plan.beam_modulus(section["pair"])
    solids = {"hamaker_constant_zJ": plan.hamaker_constant(section["pair"])} if section["kind"] == "bridge" else {}
    return sizes | modulus | solids | {"strip_um": Designs(plan.config).strip(name)}


def cracks(plan: Plan, case: str) -> dict:
    """A device at a humidity: force laws, dimensions and number of beams."""
    device = _device(plan, pair_of(case))
    found = chosen(plan.config, ("seed", "chaos")) | {
        "water": plan.water(device["pair"]),
        "humidity": humidity_of(case),
    }
    return found | {"device": device, "beams": plan.config["design"]["beams"]}


def safe_lengths(plan: Plan, case: str) -> dict:
    """As `cracks`, with the shares of stuck devices, without the force laws."""
    found = cracks(plan, case)
    return chosen(found, ("seed", "water", "humidity", "device")) | chosen(plan.config["design"], ["shares"])


def chart(plan: Plan, case: str) -> dict:
    """As `cracks` and `safe_lengths`, for all thicknesses and gaps of the chart of a device."""
    section = plan.config["devices"][pair_of(case)]
    sizes = {"gaps_um": [section["gap_um"]]} | chosen(section["chart"], ("thicknesses_um", "gaps_um"))
    return cracks(plan, case) | safe_lengths(plan, case) | sizes


#: Names of the properties of a material in warnings.
_PROPERTIES = {
    "young_modulus_GPa": "Young's modulus",
    "poisson_ratio": "Poisson's ratio",
    "hardness_GPa": "hardness",
    "hamaker_constant_zJ": "Hamaker constant",
    "contact_angle_deg": "contact angle",
}


#: ASSUME: a solid is polysilicon if its Young's modulus differs from that of the paper by no more than this share.
_POLYSILICON = 0.1


def _stated(plan, pair):
    """Names of the materials of a pair, each with its stated properties in words; section solid if it is one."""
    named, solid = plan.config.get("materials", {}), plan.config["solid"]
    if abs(solid["young_modulus_GPa"] / paper()["solid"]["young_modulus_GPa"] - 1) > _POLYSILICON:
        named = named | {"the solid": solid}
    used = dict.fromkeys(plan.config["surfaces"][surface].get("material", "the solid") for surface in plan.sides(pair))
    return [[name, [_PROPERTIES[key] for key in named[name]]] for name in used if name in named]


def beyond_the_model(plan: Plan) -> dict:
    """Cases of beams, and the input of the warnings about each device: sizes, stated properties."""
    designs = Designs(plan.config)
    devices = {
        name: {"device": _device(plan, name), "materials": _stated(plan, plan.config["devices"][name]["pair"])}
        for name in designs.beams
    }
    return {"cases": designs.cases, "pressed": designs.pressed_pairs, "devices": devices}


def charts(plan: Plan) -> dict:
    """Cases of all charts, and as `beyond_the_model` of their devices."""
    designs, beyond = Designs(plan.config), beyond_the_model(plan)["devices"]
    cases = {name: designs.chart_cases(name) for name in designs.charted}
    return {"charts": cases, "pressed": designs.pressed(*cases), "devices": chosen(beyond, cases)}


def device_limits(plan: Plan) -> dict:
    """As `beyond_the_model`, with all charts and stoppers."""
    return beyond_the_model(plan) | {"charts": charts(plan)["charts"], "stoppers": beyond_stoppers(plan)}


def _waters(plan):
    """Water of every pair that runs."""
    return {"water": {pair: plan.water(pair) for pair in plan.pairs}}


def model_limits(plan: Plan) -> dict:
    """Cases, nominal beams, strips and stated properties of all pairs that run."""
    pairs = {"sampling": _strip(plan)} | _waters(plan) | cantilevers(plan, *plan.pairs)
    materials = {pair: _stated(plan, pair) for pair in plan.pairs}
    return {"outcomes": plan.outcomes, "pressed": plan.pressed_pairs, "pairs": pairs, "materials": materials}


# Stoppers and budgets of devices


def stoppers(plan: Plan, name: str) -> dict:
    """Water, patch, restoring force and humidities of a stopper, and its fine axis of humidities."""
    section = plan.config["devices"][name]
    found = chosen(section, ("contact_um", "restoring_force_uN", "humidities"))
    return found | {"water": plan.water(section["pair"])} | chosen(plan.config["design"], ["worst_humidities"])


def device_slope_contact(plan: Plan, pair: str, length: int, width: int) -> dict:
    """As `slope_contact`, on a patch of another size [nm]."""
    return _on_patch(plan, pair, length, width, plan.config["studies"]["slopes"]["samples"])


def solid_contact(plan: Plan, pair: str, length: int, width: int, solid_property: str, side: str) -> dict:
    """As `device_slope_contact`, with less or more of a property of the beam's material, in both bodies of it.

    It has no more samples than the contact of the device.
    """
    return _with_property(_on_patch(plan, pair, length, width, _samples_of_slopes(plan)), solid_property, side)


def tip_solid_contact(plan: Plan, pair: str, length: int, width: int, solid_property: str, side: str) -> dict:
    """As `tip_contact`, with less or more of a property of the beam's material, in both bodies of it."""
    return _with_property(tip_contact(plan, pair, length, width), solid_property, side)


def tip_choice_contact(plan: Plan, pair: str, length: int, width: int, variant: str) -> dict:
    """As `tip_contact`, with the solids of a variant of the model."""
    return tip_contact(plan, pair, length, width) | plan.variant_contact(pair, variant)


def _with_property(found, name, side):
    """Settings of a contact with less or more of a property of the beam's material."""
    key, solid = KEYS_OF_SOLIDS[name], found["solid"]
    if "materials" not in found and key in solid:
        return found | {"solid": _changed(solid, name, side)}
    bodies = found.get("materials", dict.fromkeys(SIDES, solid))
    of_beam = _changed(bodies["beam"], name, side)
    return found | {"materials": {at: of_beam if one == bodies["beam"] else one for at, one in bodies.items()}}


def _changed(material, name, side):
    """Material with less or more of a property; of its Hamaker constants through all media by the same factor."""
    from stiction.devices.budget import OF_SOLIDS  # its import takes a tenth of a plan, which few configurations need

    key, end = KEYS_OF_SOLIDS[name], SHIFTED.index(side)
    if name == "hamaker_constant":
        constants = hamaker_constants(material).items()
        return material | {key: {medium: OF_SOLIDS[name].ends(constant)[end] for medium, constant in constants}}
    return material | {key: OF_SOLIDS[name].ends(material[key])[end]}


def device_choice_summits(plan: Plan, pair: str, length: int, width: int, variant: str) -> dict:
    """As `stiction.config.plan.Plan.variant_summits`, on a patch of another size [nm]."""
    found = plan.variant_summits(pair, variant)
    size = _on_patch(plan, pair, length, width, _samples_of_slopes(plan))
    return found | {"base": merged(found["base"], chosen(size, ("sampling", "beam", "contact")))}


def budget(plan: Plan, case: str) -> dict:
    """Everything about a budget: its settings, the quantities of its surfaces and its variants of the model."""
    name, designs = pair_of(case), Designs(plan.config)
    section = plan.config["devices"][name]
    pair = section["pair"]
    found = chosen(plan.config, ["seed"]) | {"uncertainty": section.get("uncertainty", {})}
    found |= {"water": plan.water(pair), "humidity": humidity_of(case), "surfaces": plan.sides(pair)}
    found |= chosen(plan.config["solid"], ["young_modulus_GPa"]) | plan.beam_modulus(pair)
    if "hamaker_constant" in designs.uncertain_solids(name):
        found |= {"hamaker_constant_zJ": plan.beam_hamaker_constant(pair)}
    if section["kind"] == "stopper":
        found |= chosen(section, ["contact_um"])
    else:
        found |= {"device": _device(plan, name), "beams": plan.config["design"]["budget_beams"]}
    quantities = list(map(list, designs.quantities(name)))
    return {"budget": found, "quantities": quantities, "choices": plan.choices_of_device(name)}


def tip_budget(plan: Plan, case: str) -> dict:
    """As `budget`, of the length that the tip of a cantilever holds, for the middle one of the shares."""
    found, shares = budget(plan, case), plan.config["design"]["shares"]
    settings = {key: value for key, value in found["budget"].items() if key != "beams"}
    choices = plan.choices_of_solids(plan.config["devices"][pair_of(case)]["pair"])
    return found | {"budget": settings | {"share": shares[len(shares) // 2]}, "choices": choices}


def beyond_stoppers(plan: Plan) -> dict:
    """Input of the warnings about stoppers: their pairs, water, patches and the stated properties of materials."""
    devices = {name: plan.config["devices"][name] for name in Designs(plan.config).stoppers}
    return {
        name: {"pair": device["pair"], "materials": _stated(plan, device["pair"])}
        | chosen(stoppers(plan, name), ("water", "contact_um", "humidities", "worst_humidities"))
        for name, device in devices.items()
    }


def page(plan: Plan, name: str) -> dict:
    """Section of a device, and the input of its warnings."""
    warned = beyond_the_model(plan)["devices"] | beyond_stoppers(plan)
    return {"name": name, "device": plan.config["devices"][name], "warned": {name: warned[name]}}


# Tables, checks and figures


def table_1(plan: Plan) -> dict:
    """Measured statistics of all surfaces without scans, and the surfaces whose published values are shown."""
    entries = plan.config["surfaces"]
    statistics = {name: chosen(entries[name], (*MOMENTS, *SUMMITS)) for name in plan.described}
    return {"measured": statistics, "of_paper": plan.paper_surfaces}


def table_scans(plan: Plan) -> dict:
    """Numbers of the scans of every measured surface."""
    return {"scans": {name: list(plan.scan_files(name)) for name in plan.scanned}}


def moments(plan: Plan) -> dict:
    """Target moments of the drawn surfaces that have no scans."""
    return {name: heights(plan, name) for name in plan.described}


def skewed(plan: Plan, pairs: Iterable[str]) -> list[str]:
    """Pairs, out of some, without a positively skewed surface and with a negatively skewed one."""
    skewness = {pair: [plan.config["surfaces"][name]["skewness"] for name in plan.sides(pair)] for pair in pairs}
    return [pair for pair, values in skewness.items() if max(values) <= 0 > min(values)]


def table_2(plan: Plan) -> dict:
    """Spectrum in use of every surface with measured summits, and the surfaces whose published values are shown."""
    sources = {name: plan.config["surfaces"][name]["psd"] for name in plan.with_summits}
    return {"sources": sources, "of_paper": plan.paper_surfaces}


def table_3(plan: Plan) -> dict:
    """Cases of Table III, and the pairs whose published values are shown."""
    return {"outcomes": plan.outcomes, "of_paper": plan.paper_pairs} | _waters(plan)


def table_variants(plan: Plan) -> dict:
    """Cases and variants, and the pairs whose published values are shown."""
    return {"studied": plan.studied_cases, "of_paper": plan.paper_pairs}


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
    """Cases of Fig. 15, water of each pair, the nominal beams, and the pairs whose published values are drawn."""
    shown = {"outcomes": plan.outcomes, "of_paper": plan.paper_pairs}
    return shown | _waters(plan) | cantilevers(plan, *plan.pairs)


def figure_17(plan: Plan) -> dict:
    """Cases of Fig. 17 and the tolerance of the dimension reduction."""
    tolerance = plan.config["chaos"]["dimension_tolerance"]
    return {"cases": plan.cases, "tolerance": tolerance} | figure_case(plan)


def figure_overview(plan: Plan) -> dict:
    """Pair and humidities of the overview, and the pairs whose published values are shown."""
    humidities = plan.config["pairs"][plan.figure_pair]["humidities"]
    return figure_case(plan) | {"humidities": humidities, "of_paper": plan.paper_pairs}
