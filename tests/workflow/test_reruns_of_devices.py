"""Which rules of stoppers and budgets a change reruns and which it must not, as `test_reruns` for the main line."""

# ruff: noqa: E501
import re

import pytest
from test_reruns import Tree

#: A beam on the strips of its pair and a stopper on a patch of its own.
SMALL = """
run: {pairs: [b]}
pairs: {b: {humidities: [0.8]}}
contact: {chunks: 1}
studies: {variants: {van_der_waals: [none], psd: [identified], every: [], spacing_nm: [], poisson_ratio: []}}
devices:
  C1: {kind: cantilever, pair: b, thickness_um: 2.6, gap_um: 20, width_um: 30, humidities: [0.7],
       uncertainty: {gap_um: 0.2, scan_um: 10}}
  S1: {kind: stopper, pair: b, contact_um: [3, 3], restoring_force_uN: 20, humidities: [0.7],
       uncertainty: {humidity: 0.01, young_modulus_GPa: 5}}
"""
#: Rules of this test, and the rules that read their outputs, listed by hand.
READ_BY = {
    "heights": "identification spectrum contact_chunk device_contact slope_contact modulus_contact budget tip_contact "
    "tip_slope_contact tip_choice_contact tip_budget",
    "spectrum": "contact_chunk device_contact slope_contact modulus_contact budget tip_contact tip_slope_contact "
    "tip_choice_contact tip_budget",
    "identification": "device_choice_summits",
    "contact_chunk": "contact",
    "contact": "budget",
    "device_contact": "stoppers budget",
    "slope_contact": "budget",
    "device_slope_contact": "budget",
    "modulus_contact": "budget",
    "device_choice_summits": "device_choice_contact",
    "device_choice_contact": "budget",
    "tip_contact": "tip_budget",
    "tip_slope_contact": "tip_budget",
    "tip_choice_contact": "tip_budget",
    "stoppers": "table_stoppers figure_stoppers device_page",
    "budget": "table_budget figure_budget device_page",
    "tip_budget": "table_budget figure_budget device_page",
}
RULES = set(READ_BY) | set(" ".join(READ_BY.values()).split())
COMPUTING = set(READ_BY)

#: Description of a change; overlay; rules that it affects directly; pattern of files that must not rerun.
MATRIX = [
    ("restoring force", "devices: {S1: {restoring_force_uN: 30}}", "stoppers", "C1|budget"),
    ("uncertainty of a dimension", "devices: {C1: {uncertainty: {gap_um: 0.5}}}", "budget tip_budget", "S1|contact"),
    ("size of a scan", "devices: {C1: {uncertainty: {scan_um: 20}}}", "budget tip_budget", "S1|contact"),
    ("an input becomes uncertain", "devices: {S1: {uncertainty: {scan_um: 10}}}", "device_slope_contact budget",
     "C1|slopes/contact|stoppers"),
    ("one humidity of a stopper", "devices: {S1: {humidities: [0.7, 0.9]}}", "stoppers budget", "C1|contact|S1_rh070"),
    ("area of a stopper", "devices: {S1: {contact_um: [3, 2]}}", "device_contact modulus_contact device_choice_summits",
     "C1|1500x30000"),
    ("samples of slopes", "studies: {slopes: {samples: 200}}", "slope_contact modulus_contact device_choice_summits", "stoppers"),
    ("beams of slopes", "design: {budget_beams: 100}", "budget", "S1|contact|tip"),
    ("beams, each with a tip", "design: {beams: 900}", "tip_contact tip_slope_contact tip_choice_contact", "S1|budget/C1_rh070.nc"),
    ("strips of tips", "design: {tip_um: 0.1}", "tip_contact tip_slope_contact tip_choice_contact", "S1|50x30000"),
    ("middle share", "design: {shares: [1.0e-2]}", "tip_budget", "S1|contact|budget/C1_rh070.nc"),
    ("range of the worst humidity", "design: {worst_humidities: [0.5, 0.9]}", "stoppers", "C1|budget|contact"),
    ("another choice of the model", "studies: {variants: {van_der_waals: [none, dry]}}",
     "device_choice_contact tip_choice_contact",
     "none|identified|slopes|modulus|stoppers"),
    ("water", "water: {temperature_K: 310}", "stoppers budget tip_budget", "contact"),
    ("skewness of a surface", "surfaces: {B2: {skewness: -0.7}}", "heights device_choice_summits", "Sub1.nc"),
    ("skewness of another surface", "surfaces: {B1: {skewness: -0.7}}", "", ""),
    ("number of samples", "contact: {samples: 5500}", "contact_chunk device_contact", "slopes|modulus|choices"),
    ("chunks", "contact: {chunks: 2}", "", ""),
]  # fmt: skip
#: Modules, and the rules whose datasets a new variable changes.
LAYOUTS = {"designs/stoppers": {"stoppers"}, "designs/budget": {"budget", "tip_budget"}}


def behind(rules):
    """Rules and all rules downstream of them."""
    reached = set(rules)
    while more := set(" ".join(READ_BY.get(rule, "") for rule in reached).split()) - reached:
        reached |= more
    return reached


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """Source tree with all results up to date."""
    tree = Tree(tmp_path_factory.mktemp("tree"), tmp_path_factory.mktemp("scratch"), SMALL, ["devices"])
    yield tree
    tree.planner.close()


@pytest.fixture
def tree(done):
    """Source tree, restored after the test."""
    yield done
    done.git("checkout", "--force", "main")


def test_an_unchanged_tree_reruns_nothing(tree):
    assert tree.rerun() == {}


@pytest.mark.parametrize(("overlay", "met", "stay"), [pytest.param(*row, id=name) for name, *row in MATRIX])
def test_a_setting_reruns_the_rules_it_affects_and_their_readers_and_no_others(tree, overlay, met, stay):
    rerun = tree.rerun(overlay=overlay)
    assert RULES & set(rerun.values()) == behind(met.split())
    assert not [
        name for name in rerun if stay and re.search(stay, name) and "tables" not in name and "figures" not in name
    ]


@pytest.mark.parametrize(("module", "rules"), LAYOUTS.items())
def test_a_new_variable_in_a_dataset_reruns_its_rule_and_its_readers(tree, module, rules):
    path = tree.folder / "src" / "stiction" / f"{module}.py"
    code = path.read_text()
    assert code.count("    return xr.Dataset(") == 1
    path.write_text(code.replace("    return xr.Dataset(", "    more = 1\n    return xr.Dataset("))
    # Tables and figures of stoppers and budgets share modules that know both datasets.
    assert COMPUTING & set(tree.rerun().values()) == behind(rules) & COMPUTING
