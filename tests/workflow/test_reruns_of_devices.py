"""Which rules of stoppers and budgets a change reruns and which it must not, as `test_reruns` for the main line."""

# ruff: noqa: E501
import re

import pytest
from test_reruns import Tree

pytestmark = pytest.mark.slow

#: Settings of a process.
SETTINGS = "[{value: 30, rms_nm: 2, uncertainty: {rms_nm: 0.1}}, {value: 90, rms_nm: 6, uncertainty: {rms_nm: 0.1}}]"
#: A beam on the strips of its pair with a chart, a bridge, a stopper on a patch of its own, and one over a process.
SMALL = """
run: {pairs: [b]}
pairs: {b: {humidities: [0.8]}}
contact: {chunks: 1}
studies: {variants: {van_der_waals: [none], psd: [identified], every: [], spacing_nm: [], poisson_ratio: []}}
design: {chart_points: 2}
devices:
  C1: {kind: cantilever, pair: b, thickness_um: 2.6, gap_um: 20, width_um: 30, humidities: [0.7],
       chart: {thicknesses_um: [2.6, 3], humidities: [0.6, 0.8]}, uncertainty: {gap_um: 0.2, hamaker_constant_zJ: 10, scan_um: 10}}
  R1: {kind: bridge, pair: b, thickness_um: 2, gap_um: 2, width_um: 20, residual_stress_MPa: 50, humidities: [0.7]}
  S1: {kind: stopper, pair: b, contact_um: [3, 3], restoring_force_uN: 20, humidities: [0.7],
       uncertainty: {humidity: 0.01, young_modulus_GPa: 5}}
  E1: {kind: stopper, pair: b, contact_um: [3, 3], restoring_force_uN: 20, humidities: [0.7],
       requirement: {share: 0.05}, process: etch}
process: {etch: {variable: etch_time_s, surface: B2, settings: SETTINGS}}
""".replace("SETTINGS", SETTINGS)
#: Rules of this test, and the rules that read their outputs, listed by hand.
READ_BY = {
    "heights": "identification spectrum device_contact tip_contact device_slope_contact solid_contact plasticity"
    " tip_solid_contact budget tip_slope_contact tip_choice_contact tip_budget process_point",
    "spectrum": "device_contact tip_contact device_slope_contact solid_contact plasticity budget tip_slope_contact"
    " tip_solid_contact tip_choice_contact tip_budget process_point",
    "identification": "device_choice_summits",
    "contact_chunk": "contact",
    "contact": "ground safe_lengths budget fast_strips",
    "device_contact": "ground safe_lengths stoppers budget separation fast_strips",
    "ground": "cracks chart",
    "tip_contact": "safe_lengths chart tip_budget fast_tips",
    "slope_contact": "budget",
    "device_slope_contact": "budget",
    "solid_contact": "budget",
    "tip_solid_contact": "tip_budget",
    "tip_edge_contact": "tip_budget",
    "device_choice_summits": "device_choice_contact",
    "device_choice_contact": "budget",
    "plasticity": "device_warnings",
    "device_warnings": "table_safe_lengths figure_risk figure_life table_chart figure_chart table_stoppers figure_stoppers"
    " device_limits device_page table_devices",
    "cracks": "safe_lengths",
    "safe_lengths": "answer table_safe_lengths device_warnings device_page life device_estimate",
    "device_estimate": "table_estimate device_page",
    "touchdowns": "answer life",
    "separation": "answer life",
    "fast_strips": "answer life",
    "fast_tips": "answer life",
    "at_voltage": "answer life",
    "stoppers_at_voltage": "answer life",
    "dimples": "life",
    "tilted_contact": "tilted_stoppers",
    "tilted_stoppers": "answer life device_page",
    "life": "answer table_life figure_life device_page",
    "answer": "table_devices figure_risk figure_life device_page device_limits",
    "chart": "answer table_chart figure_chart device_warnings device_page",
    "tip_slope_contact": "tip_budget",
    "tip_choice_contact": "tip_budget",
    "stoppers": "answer table_stoppers figure_stoppers device_page life device_warnings",
    "budget": "answer table_budget figure_budget device_page",
    "tip_budget": "answer table_budget figure_budget device_page",
    "process_law": "process_point process_curve process_settings table_process figure_process figure_process_law"
    " device_page",
    "process_point": "process_curve",
    "process_curve": "process_settings table_process figure_process device_page",
    "process_settings": "table_process figure_process device_page",
}
RULES = set(READ_BY) | set(" ".join(READ_BY.values()).split())
COMPUTING = set(READ_BY)
#: Rules of one kind of device.
NO_BEAM = {"device_limits"}
OF_STOPPERS = {"stoppers", "separation", "table_stoppers", "figure_stoppers"}
SHOWN = {"table_safe_lengths"}
OF_CHARTS = {"chart", "table_chart", "figure_chart"}
OF_ESTIMATE = {"device_estimate", "table_estimate"}
OF_BEAMS = {"ground", "cracks", "safe_lengths", "fast_strips", "fast_tips"} | SHOWN | OF_CHARTS | OF_ESTIMATE
#: Rules that read the changes of a pair by full contact. All of its humidities and tips are one file.
FULL = "ground safe_lengths chart stoppers budget separation fast_strips fast_tips device_warnings process_point"
BODY = "surfaces: {B2: {material: Other}}\nmaterials: {Other: "

# Figures of charts and of stoppers read the answers of their devices alone.
#: Description of a change; overlay; rules that it affects directly, whose readers rerun as well; rules excepted because
#: their files do not depend on it; pattern of files that must not rerun.
MATRIX = [
    ("restoring force", "devices: {S1: {restoring_force_uN: 30}}", "stoppers", ("table_safe_lengths", "table_chart", "figure_chart"), "C1|R1|budget"),
    ("uncertainty of a dimension", "devices: {C1: {uncertainty: {gap_um: 0.5}}}", "budget tip_budget life figure_chart", (),
     "R1|S1|contact|chart"),
    ("tension of a liquid", "liquids: {Mine: {surface_tension_mN_per_m: 30}}", "life figure_chart", (), "S1|contact|cracks|safe"),
    ("number of touchdowns", "devices: {C1: {touchdowns: 10}}", "touchdowns figure_chart", (), "R1|S1|contact|cracks|safe"),
    ("voltage of a beam", "devices: {C1: {voltage_V: 3, dielectric: {thickness_nm: 100, permittivity: 4}}}", "at_voltage figure_chart", (),
     "R1|S1|contact|cracks|safe"),
    ("voltage of a stopper", "devices: {S1: {voltage_V: 3, dielectric: {thickness_nm: 100, permittivity: 4}}}",
     "stoppers_at_voltage figure_stoppers", NO_BEAM, "R1|C1|contact|devices/stoppers/"),
    ("tilt of a stopper", "devices: {S1: {tilt_deg: [0, 0.1]}}", "tilted_contact figure_stoppers", NO_BEAM, "R1|C1|devices/contact/b|devices/stoppers/"),
    ("dimples of a bridge", "devices: {R1: {length_um: 200, dimples: {number: 2, at_um: [100], height_um: 1, contact_um: [3, 3]}}}",
     "dimples safe_lengths", OF_STOPPERS | OF_CHARTS, "C1|S1|contact|cracks"),
    ("size of a scan", "devices: {C1: {uncertainty: {scan_um: 20}}}", "budget tip_budget figure_chart", (), "R1|S1|contact|chart"),
    ("an input becomes uncertain", "devices: {S1: {uncertainty: {scan_um: 10}}}", "device_slope_contact budget figure_stoppers", NO_BEAM,
     "C1|R1|slopes/contact|stoppers"),
    ("a quantity of a surface becomes uncertain", "surfaces: {B2: {uncertainty: {skewness: 0.1}}}",
     "device_slope_contact device_choice_summits budget tip_budget figure_chart figure_stoppers", (), "heights|spectrum/|cracks|safe_lengths|chart|devices/stoppers"),
    ("another property of the solids becomes uncertain", "devices: {S1: {uncertainty: {poisson_ratio: 0.02}}}",
     "solid_contact budget figure_stoppers", NO_BEAM, "C1|R1|modulus|hamaker|slopes|choices|heights|spectrum|contact/b|stoppers"),
    ("another property of the solids of a cantilever becomes uncertain",
     "devices: {C1: {uncertainty: {poisson_ratio: 0.02}}}",
     "solid_contact tip_solid_contact budget tip_budget figure_chart", (),
     "S1|R1|modulus|hamaker|slopes|choices|heights|spectrum|contact/b|3000x3000|cracks|safe|chart"),
    ("the edge of a tip becomes uncertain", "devices: {C1: {uncertainty: {edge_radius_um: 0.03}}}",
     "tip_edge_contact tip_budget figure_chart", (), "S1|R1|solids|slopes|choices|heights|contact/b|cracks|safe|chart|budget/C1_rh070.nc"),
    ("uncertainty of a property of the solids", "devices: {C1: {uncertainty: {hamaker_constant_zJ: 15}}}",
     "budget tip_budget figure_chart", (), "R1|S1|contact|chart"),
    ("one humidity of a stopper", "devices: {S1: {humidities: [0.7, 0.9]}}", FULL, (), "/contact/"),
    ("area of a stopper", "devices: {S1: {contact_um: [3, 2]}}", "device_contact solid_contact device_choice_summits",
     OF_BEAMS, "C1|R1|1500x"),
    ("samples of slopes of measured surfaces", "studies: {slopes: {samples: 200}}", "", (), ""),
    ("samples of budgets", "design: {budget_samples: 80}", "device_slope_contact solid_contact device_choice_summits process_point figure_chart figure_stoppers"
     " tip_slope_contact tip_solid_contact tip_choice_contact", (), "stoppers|chart|cracks"),
    ("beams of slopes", "design: {budget_beams: 150}", "budget figure_chart", (), "S1|contact|chart|cracks|tip"),
    ("beams, each with a tip", "design: {beams: 900}", "cracks tip_contact chart", OF_STOPPERS,
     "S1|budget/C1_rh070.nc"),
    ("range of the worst humidity", "design: {worst_humidities: [0.5, 0.9]}", FULL, (), "/contact/"),
    ("another choice of the model", "studies: {variants: {van_der_waals: [none, dry]}}",
     "device_choice_contact tip_choice_contact figure_chart figure_stoppers", (), "none|identified|slopes|modulus|stoppers|cracks"),
    ("water", "water: {temperature_K: 310}", "ground safe_lengths chart stoppers budget tip_budget separation fast_strips fast_tips process_point",
     (), "/contact/"),
    # It moves the scatter of energies, and with it the number of samples of C1.
    ("adsorbed water", "water: {adsorbed_nm: 0.1}", "device_contact ground safe_lengths chart stoppers budget tip_budget separation fast_strips fast_tips process_point", (),
     "results/contact|slopes|modulus|choices|/contact/tips"),
    ("uncertainty of the adsorbed water", "devices: {C1: {uncertainty: {adsorbed_nm: 0.1}}}", "budget tip_budget figure_chart", (),
     "R1|S1|contact|chart"),
    ("attraction across gaps", "attraction: {wavelength_nm: 90}", "ground safe_lengths chart stoppers budget tip_budget separation fast_strips fast_tips process_point", (),
     "/contact/"),
    ("skewness of a surface", "surfaces: {B2: {skewness: -0.7}}", "heights device_choice_summits process_law", (), "Sub1.nc"),
    ("skewness of another surface", "surfaces: {B1: {skewness: -0.7}}", "", (), ""),
    # Stated ones let C1 share the strips of its pair.
    ("number of samples", "contact: {samples: 5500}", "contact_chunk device_contact slope_contact process_point", (), "modulus|choices|tip"),
    ("chunks", "contact: {chunks: 2}", "", (), ""),
    ("edge of tips", "design: {tip_edge: square}", f"tip_contact tip_slope_contact tip_solid_contact tip_choice_contact {FULL}",
     (), "contact/b"),
    ("radius of the edge of tips", "design: {edge_radius_um: 0.5}",
     f"tip_contact tip_slope_contact tip_solid_contact tip_choice_contact {FULL}", (), "contact/b"),
    ("shares", "design: {shares: [0.02]}", "safe_lengths chart tip_budget", OF_STOPPERS, "cracks|S1|contact|budget/C1_rh070.nc"),
    ("points of charts", "design: {chart_points: 4}", FULL, (), "/contact/"),
    ("humidities of a chart", "devices: {C1: {chart: {humidities: [0.6, 0.9]}}}",
     f"tip_contact tip_slope_contact tip_solid_contact tip_choice_contact {FULL}", (), "/contact/b|contact/slopes"),
    ("gap of a beam", "devices: {C1: {gap_um: 19}}", "cracks safe_lengths chart budget tip_budget", OF_STOPPERS, "contact|S1|R1"),
    ("width of a beam", "devices: {C1: {width_um: 24}}",
     "device_contact tip_contact device_slope_contact solid_contact device_choice_summits tip_slope_contact"
     f" tip_solid_contact tip_choice_contact {FULL}", (), "b_NG"),
    ("strips of a beam", "devices: {C1: {strip_um: 1.2}}",
     "device_contact device_slope_contact solid_contact device_choice_summits chart tip_budget", OF_STOPPERS, "S1|R1|b_NG|tips"),
    ("stress in a bridge", "devices: {R1: {residual_stress_MPa: 60}}", "cracks safe_lengths", OF_STOPPERS | OF_CHARTS, "contact|C1|S1|chart"),
    ("Hamaker constant of a body", BODY + "{hamaker_constant_zJ: {water: 20, dry: 200}}}",
     "device_contact tip_contact device_slope_contact solid_contact device_choice_contact plasticity"
     " tip_slope_contact tip_solid_contact tip_choice_contact process_point", (), "heights|spectrum|summits"),
    ("number at a setting of a process", f"process: {{etch: {{settings: {SETTINGS.replace('rms_nm: 6', 'rms_nm: 7')}}}}}",
     "process_law", (), "C1|R1|S1|contact|stoppers|heights"),
    ("setting of a process", f"process: {{etch: {{settings: {SETTINGS.replace('90', '80')}}}}}",
     "process_law process_point", (), "C1|R1|S1|contact|stoppers|heights"),
    ("requirement of a device over a process", "devices: {E1: {restoring_force_uN: 30}}", "stoppers process_point",
     {"table_safe_lengths", "table_chart", "figure_chart"}, "C1|R1|S1|contact|laws"),
    # The estimate refuses other materials than polysilicon.
    ("hardness of a body", BODY + "{hardness_GPa: 9}}", "plasticity device_estimate", (), "contact|cracks|stoppers/|budget"),
]  # fmt: skip
# One row of each kind is fast; these are slow tests.
FURTHER = {
    "size of a scan",
    "beams of slopes",
    "another choice of the model",
    "shares",
    "points of charts",
    "gap of a beam",
}
FURTHER |= {"humidities of a chart", "width of a beam", "strips of a beam", "stress in a bridge", "hardness of a body"}
FURTHER |= {"tension of a liquid", "number of touchdowns", "voltage of a beam", "voltage of a stopper"}
FURTHER |= {"tilt of a stopper", "dimples of a bridge", "adsorbed water", "uncertainty of the adsorbed water"}
FURTHER |= {"number at a setting of a process", "setting of a process", "requirement of a device over a process"}
FURTHER |= {"Hamaker constant of a body", "uncertainty of a property of the solids"}
FURTHER |= {"another property of the solids of a cantilever becomes uncertain"}
ROWS = [pytest.param(*row, id=name, marks=[pytest.mark.slow] * (name in FURTHER)) for name, *row in MATRIX]
#: Modules, and the rules whose datasets a new variable changes.
LAYOUTS = {
    "stages/devices/stoppers": {"stoppers", "process_point"},
    "stages/devices/budget": {"budget", "tip_budget"},
    "stages/devices/chart": {"chart"},
}
LAYOUTS |= {
    "stages/devices/ground": {"ground"},
    "stages/devices/cracks": {"cracks", "safe_lengths"},
    "stages/devices/safe_lengths": {"safe_lengths"},
}
LAYOUTS |= {"stages/axes/law": {"process_law"}, "stages/axes/recommended": {"process_settings"}}
LAYOUTS |= {"stages/life/answers": {"life"}, "stages/life/separation": {"separation", "fast_strips", "fast_tips"}}


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


def test_an_unchanged_tree_reruns_nothing(tree):
    assert tree.rerun() == {}


@pytest.mark.parametrize(("overlay", "met", "spared", "stay"), ROWS)
def test_a_setting_reruns_the_rules_it_affects_and_their_readers_and_no_others(tree, overlay, met, spared, stay):
    rerun = tree.rerun(overlay=overlay)
    assert RULES & set(rerun.values()) == behind(met.split()) - set(spared)
    assert not [
        name for name in rerun if stay and re.search(stay, name) and "tables" not in name and "figures" not in name
    ]


@pytest.mark.parametrize(("module", "rules"), LAYOUTS.items())
def test_a_new_variable_in_a_dataset_reruns_its_rule_and_its_readers(tree, module, rules):
    path = tree.folder / "src" / "stiction" / f"{module}.py"
    code = path.read_text()
    assert "    return xr.Dataset(" in code
    path.write_text(code.replace("    return xr.Dataset(", "    more = 1\n    return xr.Dataset("))
    # Tables and figures of stoppers and budgets share modules that know both datasets.
    assert COMPUTING & set(tree.rerun().values()) == behind(rules) & COMPUTING


def test_a_second_process_of_a_device_runs_its_map_and_no_other_device(tree):
    second = SETTINGS.replace("rms_nm: 2", "rms_nm: 0.2").replace("rms_nm: 6", "rms_nm: 0.6")
    process = f"process: {{deposition: {{variable: deposition_time_min, surface: Sub1, settings: {second}}}}}"
    rerun = tree.rerun(overlay=f"devices: {{E1: {{second_process: deposition}}}}\n{process}")
    maps = {f"{kind}_process_map" for kind in ("table", "figure")} | {"process_map", "process_pairs"}
    assert {rule for rule in rerun.values() if "process" in rule} == maps | {
        "process_law",
        "process_point",
        "figure_process_law",
    }
    assert not [name for name in rerun if re.search("C1|R1|S1|laws/etch|law_etch|contact|devices/stoppers", name)]
    assert {f"results/process/points/E1_{number}.nc" for number in range(35)} <= rerun.keys()


def test_a_table_that_was_learnt_again_reruns_estimates_and_their_readers_alone(tree):
    tree.append("src/stiction/estimate/table.json", "\n")
    assert RULES & set(tree.rerun().values()) == behind({"device_estimate"})
