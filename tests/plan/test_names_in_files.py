"""Names with _ and -: every file of a plan has one job, whose wildcards are the names that it was made from."""

import re

import numpy as np
import pytest
from configurations import PAPER, SCHEMA, problems

from stiction.config import files
from stiction.config.cases import Case, PairInAir, case_id
from stiction.config.merging import merged
from stiction.config.messages import dotted
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.plan.planner import ALL_TARGETS
from stiction.plan.stage import WILDCARDS

#: Parts of names of files, of which names are drawn.
PARTS = ["my", "B2", "NG", "GEO", "0", "1-of-2", "rms", "less", "mode2", "base", "psd", "van_der_waals", "waals", "tip"]
PARTS += ["dry", "rh067", "rh0", "5x2", "map", "law", "x5", "beyond", "modulus", "C1", "published"]
#: Sections of names, and what names in them must not contain.
REFUSED = {
    "materials": "$^",
    "process": "^dry_",
    "surfaces": "^dry_",
    "pairs": "_dry|_rh0|_[0-9]+x[0-9]",
    "test_beams": "_dry|_rh0",
    "devices": "^map_|^law_|_dry|_rh0",
}


def pattern_of(section):
    """Pattern of the names of the entries of a section."""
    return SCHEMA["properties"][section]["propertyNames"]["pattern"]


def drawn(rng, section, number=3):
    """Different names that a section allows."""
    found = {}
    while len(found) < number:
        name = "".join(f"{part}{rng.choice(['_', '-', '__'])}" for part in rng.choice(PARTS, rng.integers(1, 4)))
        name = name.rstrip("-_") if rng.integers(4) else name
        if re.search(pattern_of(section), name) and len(name) <= 24:
            found[name] = None
    return list(found)


def study(pairs, surfaces, devices, arrays, processes):
    """Configuration with many kinds of results: pairs on surfaces, in dry air, too, and devices on pairs."""
    beam = {"thickness_um": 2.5, "gap_um": 2, "width_um": 20}
    cantilever = {"kind": "cantilever", "humidities": [0.67, "dry"], "requirement": {"share": 0.01, "length_um": 300}}
    cantilever |= {"uncertainty": {"thickness_um": 0.1, "young_modulus_GPa": 5, "scan_um": 10}}
    measured = {"length_um": 1500, "crack_lengths": [{"humidity": 0.67, "mean_um": 700, "std_um": 20, "beams": 9}]}
    measured |= {"stuck": [{"humidity": 0.67, "length_um": 300, "stuck": 3, "of": 20}]}
    etched = [{"value": 30 * k, "rms_nm": 2 + k, "uncertainty": {"rms_nm": 0.1}} for k in (1, 2)]
    sections = {name: {} for name in ("pairs", "test_beams", "devices", "process")}
    named = zip(pairs, surfaces, devices, arrays, processes, strict=True)
    for k, (pair, surface, device, array, process) in enumerate(named):
        sides = {"beam": surface, "substrate": surfaces[k - 1]}
        sections["pairs"][pair] = sides | {"gap_um": 10, "humidities": [0.67, "dry"]}
        sections["test_beams"][array] = {"pair": pair} | beam | measured
        sections["process"][process] = {"variable": "time_s", "surface": surface, "settings": etched}
        varied = {"roughness": {"surface": surface, "rms_nm": [3, 5]}, "process": process}
        sections["devices"][device] = {"pair": pair, "test_beams": [array]} | beam | cantilever | varied
    distances = {name: {"distance_nm": dict.fromkeys(pairs, 4)} for name in ("plasticity", "pressing")}
    studies = SCHEMA["properties"]["run"]["properties"]["studies"]["items"]["enum"]
    run = {"run": {"pairs": pairs, "studies": studies}, "attraction": {"reach": "all"}, "studies": distances}
    return run | sections | {"surfaces": {name: PAPER["surfaces"]["B2"] for name in surfaces}}


#: Names that begin with others. Files of poly on wet_oxide would have the names of those of poly_wet on oxide.
NESTED = study(
    ["poly_wet", "poly"], ["oxide", "B_5x2_um"], ["C_1-b", "C_1"], ["my-pair_2", "my-pair"], ["etch_1", "etch"]
)
NESTED["surfaces"]["wet_oxide"] = PAPER["surfaces"]["B2"]
NESTED["pairs"]["on-it"] = NESTED["pairs"]["poly"] | {"substrate": "wet_oxide"}


def matches_of(graph, name):
    """Stages and wildcards that match the name of a file."""
    found = ((stage, expression.fullmatch(name)) for stage, expression in graph._expressions)
    return [(stage.name, match.groupdict()) for stage, match in found if match]


@pytest.fixture(
    scope="module",
    params=[None, 0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(1, 20))],
    ids=lambda seed: "nested" if seed is None else str(seed),
)
def graph(request):
    """Plan of a study with names that begin with others, or with drawn ones."""
    config, rng = NESTED, np.random.default_rng(request.param)
    if request.param is not None:
        config = study(*(drawn(rng, one) for one in ("pairs", "surfaces", "devices", "test_beams", "process")))
    return Graph(Plan(files.load(config)))


def test_every_file_has_one_job_whose_wildcards_are_names_of_the_configuration(graph):
    jobs, config = graph.needed(*ALL_TARGETS, "model_error", "asperities", "pressing"), graph.plan.config
    made = {name: job for job in jobs for name in job.names}
    assert len(made) == sum(len(job.names) for job in jobs), "two jobs write one file"
    stages = {job.stage.name for job in jobs}
    assert stages >= {
        "device_slope_contact",
        "variant",
        "process_point",
        "test_beam_tip_budget",
        "roughness_point",
    }
    named = {"surface": config["surfaces"], "device": config["devices"], "process": config["process"]}
    named |= {"pair": config["pairs"], "case": config["pairs"] | config["devices"] | config["test_beams"]}
    for name, job in made.items():
        at = vars(job.at)
        assert matches_of(graph, name) == [(job.stage.name, at)], name
        assert all(getattr(at[key], "pair", at[key]) in names for key, names in named.items() if key in at), (name, at)
        assert not {"pair", "surface"} <= at.keys() or at["surface"] in graph.plan.sides(at["pair"]), (name, at)


@pytest.mark.parametrize(("end", "more"), [("", {}), ("_rms_less", {"quantity": "rms"})])
def test_the_sides_of_a_pair_tell_where_its_name_ends(graph, end, more):
    """Files about a pair and its surface have nothing but _ between the two names."""
    folder = "studies/slopes/contact" if end else "studies/slopes"
    for pair in graph.plan.config["pairs"]:
        for contact in (PairInAir(pair), PairInAir.in_dry_air(pair)):
            for side in graph.plan.sides(pair):
                ((_, at),) = matches_of(graph, f"{folder}/{contact}_{side}{end}")
                assert at == {"pair": contact, "surface": side} | more


def test_pairs_whose_files_would_have_the_same_names_are_refused():
    pairs = {"poly": {"beam": "wet_oxide"}, "poly_wet": {"beam": "oxide"}}
    made = {"pairs": {name: PAPER["pairs"]["b"] | sides for name, sides in pairs.items()}}
    config = merged(PAPER, made | {"surfaces": dict.fromkeys(("oxide", "wet_oxide"), PAPER["surfaces"]["B2"])})
    (line,) = problems(config)
    assert line == (
        "pairs.poly_wet.beam is 'oxide', must have another name, or the pair: files of pair poly would have the same "
        "names (given pairs.poly.beam = 'wet_oxide')"
    )
    assert problems(merged(config, {"pairs": {"poly": {"beam": "oxide"}}})) == ()


@pytest.mark.parametrize("section", REFUSED)
def test_a_section_refuses_only_names_that_files_do_not_tell_apart(section):
    """Names are drawn: the schema, the patterns of wildcards, and cases made from names agree."""
    rng, refused = np.random.default_rng(1), 0
    wildcard = {"surfaces": "surface", "pairs": "pair", "devices": "device", "process": "process"}.get(section)
    for name in ("_".join(rng.choice(PARTS, 3)) for _ in range(300)):
        allowed = bool(re.search(pattern_of(section), name))
        assert allowed == (name[0].isalpha() and not re.search(REFUSED[section], name)), name
        refused += not allowed
        if section == "test_beams":
            assert allowed == (name[0].isalpha() and bool(re.fullmatch(WILDCARDS["case"], f"{name}_rh067"))), name
        if allowed and wildcard:
            assert re.fullmatch(WILDCARDS[wildcard], name)
        if allowed and section in ("pairs", "devices", "test_beams"):
            assert {Case(str(case_id(name, air))).pair for air in (0.67, "dry")} == {name}
        if allowed and section == "pairs":
            assert (PairInAir(name).pair, PairInAir.in_dry_air(name).pair) == (name, name)
    assert refused > 5


@pytest.mark.parametrize("wildcard", ["model", "moment", "quantity", "side", "solid_property", "choice"])
def test_no_end_of_the_name_of_a_file_is_the_end_of_another(wildcard):
    """The end of a file's name then tells where the name of an entry before it ends."""
    ends = WILDCARDS[wildcard].split("|")
    assert not [(end, other) for end in ends for other in ends if end.endswith(f"_{other}")]


@pytest.mark.parametrize("section", REFUSED)
@pytest.mark.parametrize("name", ["dry_x", "x_dry", "x_rh067", "map_x", "x_5x2", "_x", "-x", "x.y", "x\n", "2x", "ä"])
def test_a_message_states_the_allowed_names(section, name):
    entry = next(iter(NESTED.get(section, {"Oxide": {}}).values()))
    found = problems(merged(merged(PAPER, NESTED), {section: {name: entry}}))
    if re.search(pattern_of(section), name):
        assert found == ()
        return
    (line,) = found
    words = SCHEMA["properties"][section]["propertyNames"]["description"]
    longest = SCHEMA["properties"][section]["propertyNames"]["maxLength"]
    assert line == f"{dotted((section, name))} is not a valid name, must be {words}, at most {longest} characters"
    assert words.startswith("letters and digits, _ and -, starting with a letter")
    assert all(text in words for text in re.findall("dry_|_dry|_rh0|map_|law_", REFUSED[section]))
