"""Names of input files: written out by hand for the paper, for devices and for measured surfaces."""

from pathlib import Path

import pytest
from test_architecture import FILES, SCRIPTS, modules_used

from stiction.config.files import load
from stiction.config.merging import merged
from stiction.config.paths import Paths, of_surfaces
from stiction.config.plan import Plan

C1 = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.67, 0.44]}
R1 = {"kind": "bridge", "pair": "a", "thickness_um": 2, "gap_um": 2, "width_um": 20, "residual_stress_MPa": 50}
S1 = {"kind": "stopper", "pair": "b", "contact_um": [3, 2], "restoring_force_uN": 20, "humidities": [0.44, 0.9]}
STATED = {"scan_um": 10, "young_modulus_GPa": 5}
DEVICES = {
    "C1": C1 | {"chart": {"thicknesses_um": [2.6], "humidities": [0.6, 0.8]}, "uncertainty": STATED},
    "R1": R1 | {"humidities": [0.5]},
    "S1": S1 | {"uncertainty": STATED},
}
PAPER = Paths(Plan(load({"devices": DEVICES, "design": {"chart_points": 2}})))
#: A measured surface on one of the paper, and on itself.
SCANNED = {
    "scans": {"files": ["/data/one.gwy", "/data/two.gwy"]},
    "heights": "moments",
    "psd": "fitted",
    "beyond": "cut",
}
MEASURED = Paths(
    Plan(
        merged(
            PAPER.plan.config,
            {
                "surfaces": {"Mine": SCANNED, "B2": {"psd": "identified"}},
                "pairs": {"mine": {"beam": "Mine", "substrate": "Sub1"}, "same": {"beam": "Mine", "substrate": "Mine"}},
            },
        )
    )
)
SHIFTED = [f"{surface}_{moment}" for surface in ("B2", "Sub1") for moment in ("rms", "skewness", "kurtosis")]


def test_surfaces_of_a_pair_begin_with_that_of_the_beam():
    assert PAPER.surfaces("b") == {
        "heights": ["results/heights/B2.nc", "results/heights/Sub1.nc"],
        "spectrum": ["results/spectrum/B2.nc", "results/spectrum/Sub1.nc"],
    }
    assert PAPER.surfaces("b") == of_surfaces(PAPER.plan.sides("b"))


def test_only_an_identified_spectrum_depends_on_the_identification():
    assert PAPER.identification("B2") == []
    assert MEASURED.identification("B2") == "results/identification/B2.nc"


def test_the_contact_of_a_case_does_not_depend_on_its_humidity():
    assert PAPER.contact("b_rh067", "G") == PAPER.contact("b_rh044", "G") == "results/contact/b_G.nc"


def test_scans_are_relative_to_the_working_directory(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    found = MEASURED.scan("Mine", "1")
    assert not Path(found).is_absolute()
    assert (tmp_path / found).resolve() == Path("/data/two.gwy")


def test_a_measured_surface_of_a_pair_is_listed_once_and_no_other_is():
    assert MEASURED.estimates("mine") == MEASURED.estimates("same") == ["results/estimate/Mine.nc"]
    assert MEASURED.measured_surfaces("mine") == MEASURED.measured_surfaces("same") == of_surfaces(["Mine"])
    assert MEASURED.estimates("b") == []
    assert MEASURED.measured_surfaces("b") == {"heights": [], "spectrum": []}


def test_slopes_need_contacts_with_less_and_with_more_of_every_quantity_of_the_surface():
    found = MEASURED.shifted_contacts("mine", "Mine")
    quantities = MEASURED.plan.quantities("Mine")
    assert quantities == ("rms", "skewness", "kurtosis", "corner", "slope", *(f"mode{k}" for k in range(2, 9)))
    for side in ("less", "more"):
        assert found[side] == [f"results/studies/slopes/contact/mine_Mine_{name}_{side}.nc" for name in quantities]


def test_variants_share_summits_and_contact_where_these_are_equal():
    folder = "results/studies/variants"
    assert PAPER.summits_of_variant("b", "van_der_waals_dry") == f"{folder}/summits/b_base.nc"
    assert PAPER.summits_of_variant("b", "every_2") == f"{folder}/summits/b_every_2.nc"
    assert PAPER.contact_of_variant("b_rh067", "van_der_waals_dry") == f"{folder}/contact/b_van_der_waals_dry.nc"
    assert PAPER.summits_of_choice("b", "3000x2000", "every_2").endswith("/summits/b_3000x2000_every_2.nc")
    assert PAPER.summits_of_choice("b", "3000x2000", "van_der_waals_dry").endswith("/summits/b_3000x2000_base.nc")


@pytest.mark.parametrize("variant", ["base", "strips_per_element_2"])
def test_the_base_of_the_variants_has_the_contact_of_the_main_line_if_that_has_as_many_samples(variant):
    fewer = Paths(Plan(merged(PAPER.plan.config, {"contact": {"samples": 599}})))
    assert PAPER.contact_of_variant("b_rh067", variant) == PAPER.contact("b_rh067", "NG") == "results/contact/b_NG.nc"
    assert fewer.contact_of_variant("b_rh067", variant) == "results/studies/variants/contact/b_base.nc"


def test_a_device_on_the_strips_of_its_pair_shares_their_contact():
    assert PAPER.ground("C1") == "results/contact/b_NG.nc"
    assert PAPER.ground("R1") == "results/devices/contact/a_500x20000.nc"
    assert PAPER.ground("S1") == "results/devices/contact/b_3000x2000.nc"


def test_only_a_cantilever_has_a_tip():
    assert PAPER.tips("C1") == "results/devices/contact/tips/b_520x30000.nc"
    assert PAPER.tips("R1") == []


def test_uncertain_surfaces_of_a_device_have_estimates_if_they_are_described_by_scans():
    assert PAPER.uncertain_surfaces("C1") == of_surfaces(["B2", "Sub1"]) | {"estimates": []}
    assert PAPER.uncertain_surfaces("R1") == of_surfaces([]) | {"estimates": []}
    scanned = Paths(Plan(merged(MEASURED.plan.config, {"devices": {"R1": {"pair": "mine"}}})))
    assert scanned.uncertain_surfaces("R1") == of_surfaces(["Mine"]) | {"estimates": ["results/estimate/Mine.nc"]}


def test_uncertain_quantities_are_shifted_on_the_patch_of_the_device():
    main = [f"results/studies/slopes/contact/b_{name}_less.nc" for name in SHIFTED]
    own = [f"results/devices/contact/slopes/b_3000x2000_{name}_more.nc" for name in SHIFTED]
    assert PAPER.contacts_of_budget("C1")["less"] == main
    assert PAPER.contacts_of_budget("S1")["more"] == own
    assert PAPER.contacts_of_budget("C1")["contact"] == PAPER.ground("C1")


def test_only_an_uncertain_modulus_is_shifted():
    folder = "results/devices/contact/modulus"
    stated = PAPER.contacts_of_budget("S1")["modulus"]
    assert stated == [f"{folder}/b_3000x2000_less.nc", f"{folder}/b_3000x2000_more.nc"]
    assert PAPER.contacts_of_budget("R1")["modulus"] == []
    exact = merged(PAPER.plan.config, {"devices": {"S1": {"uncertainty": {"young_modulus_GPa": 0}}}})
    assert Paths(Plan(exact)).contacts_of_budget("S1")["modulus"] == []


def test_other_properties_of_the_solids_are_changed_only_where_they_are_uncertain():
    stated = {"poisson_ratio": 0.02, "hamaker_constant_zJ": 20}
    found = Paths(Plan(merged(PAPER.plan.config, {"devices": {"C1": {"uncertainty": stated}}})))
    for key in ("poisson_ratio", "hamaker_constant"):
        folder, sides = "results/devices/contact", ("less", "more")
        strips, tips = (of("C1")[key] for of in (found.contacts_of_budget, found.contacts_of_tip_budget))
        assert strips == [f"{folder}/{key}/b_1500x30000_{side}.nc" for side in sides]
        assert tips == [f"{folder}/tips/{key}/b_520x30000_{side}.nc" for side in sides]
        assert found.contacts_of_budget("S1")[key] == []
    shared = {"less", "more", "modulus", "choices", "contact"}
    assert all(found.contacts_of_budget("C1")[key] == PAPER.contacts_of_budget("C1")[key] for key in shared)


def test_the_short_strips_of_a_bridge_have_the_choices_of_the_solids_alone():
    found = PAPER.contacts_of_budget("R1")["choices"]
    folder = "results/devices/contact/choices/a_500x20000"
    assert found == [f"{folder}_{name}.nc" for name in PAPER.plan.choices_of_solids("a")]
    assert len(found) < len(PAPER.plan.choices("a"))


def test_choices_are_the_variants_that_change_the_contact():
    found = PAPER.contacts_of_budget("S1")["choices"]
    assert len(found) == len(PAPER.plan.choices("b")) == 7
    assert "results/devices/contact/choices/b_3000x2000_van_der_waals_dry.nc" in found


def test_a_budget_of_tips_needs_contacts_of_the_tips_alone():
    folder = "results/devices/contact/tips"
    assert PAPER.contacts_of_tip_budget("C1") == {
        "contact": f"{folder}/b_520x30000.nc",
        "less": [f"{folder}/slopes/b_520x30000_{name}_less.nc" for name in SHIFTED],
        "more": [f"{folder}/slopes/b_520x30000_{name}_more.nc" for name in SHIFTED],
        "modulus": [f"{folder}/modulus/b_520x30000_less.nc", f"{folder}/modulus/b_520x30000_more.nc"],
        "poisson_ratio": [],
        "hamaker_constant": [],
        "choices": [
            f"{folder}/choices/b_520x30000_{name}.nc"
            for name in ("van_der_waals_dry", "van_der_waals_none", "poisson_ratio_0.18", "poisson_ratio_0.28")
        ],
    }


@pytest.mark.parametrize(
    ("device", "expected"),
    [
        (
            "C1",
            {
                "budgets": ["budget/C1_rh044", "budget/C1_rh067", "budget/C1_rh044_tip", "budget/C1_rh067_tip"],
                "charts": ["chart/C1_rh060", "chart/C1_rh080"],
                "safe_lengths": ["safe_lengths/C1_rh044", "safe_lengths/C1_rh067"],
                "stoppers": [],
            },
        ),
        ("R1", {"budgets": [], "charts": [], "safe_lengths": ["safe_lengths/R1_rh050"], "stoppers": []}),
        (
            "S1",
            {
                "budgets": ["budget/S1_rh044", "budget/S1_rh090"],
                "charts": [],
                "safe_lengths": [],
                "stoppers": ["stoppers/S1"],
            },
        ),
    ],
)
def test_a_page_shows_the_results_of_its_device(device, expected):
    found = PAPER.results(device)
    pair = DEVICES[device]["pair"]
    assert found.pop("plasticity") == [f"results/studies/plasticity/{pair}.nc"]
    assert found == {stage: [f"results/devices/{name}.nc" for name in names] for stage, names in expected.items()}


def test_no_result_depends_on_the_code_of_the_names_of_files():
    # Otherwise a change of a name in this module would rerun jobs whose files keep their names.
    assert not [path for path in (*FILES, *SCRIPTS) if "config.paths" in modules_used(path)]
