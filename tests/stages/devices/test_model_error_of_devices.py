"""The error of the model stands beside predictions for devices, and nowhere else."""

import numpy as np
import pytest
from answers import BUDGETS, CANTILEVER, STOPPER, STOPPERS, beam_page, safe, stopper_page
from ground import safe_with_tips

from stiction.config.files import load
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.report.budget import tables as tables_budget
from stiction.report.devices import tables as tables_devices
from stiction.report.model_error import column
from stiction.report.model_error import sentences as model_errors
from stiction.stages.contact import full_contact, full_energy, pair_model_error
from stiction.stages.devices import device_model_error
from stiction.stages.devices.opening import EITHER, FORCE, S_SHAPE

COLUMN = "model error [%]"


def error(shapes, factor, computed=(0.44,), **changed):
    """Errors at two humidities; that of the last one of two end states is not known."""
    values = np.tile(np.array(factor, float), (len(shapes), 1))
    values[1:] = np.nan
    settings = device_model_error.Settings((0.44, 0.67), **changed)
    return device_model_error.layout(values, 0.01 * np.ones_like(values), shapes, settings, np.array(computed))


ERRORS = {
    "C1": error((S_SHAPE, EITHER), [1.11, 1.02]),
    "S1": error((FORCE,), [0.7, 0.9]),
    "S2": error((FORCE,), [1, 1]),
}
NONE = {("C1", humidity, shape): [] for humidity in (0.44, 0.67) for shape in (S_SHAPE, EITHER)}
QUIET = {"S1": [], "S2": []}


def test_safe_lengths_have_the_error_of_their_end_state_and_a_mark_where_it_is_interpolated():
    tips = 2e-3 * np.exp(0.4 * np.random.default_rng(9).standard_normal(400))
    found = {("C1", 0.44): safe_with_tips(tips), ("C1", 0.67): safe_with_tips(tips)}
    table = tables_devices.safe_lengths(found, NONE, ERRORS)
    cells = table.cells[COLUMN].tolist()
    assert cells == ["+11.0 ± 1.0", "+11.0 ± 1.0", "–", "–", "+2.0 ± 1.0 *", "+2.0 ± 1.0 *", "–", "–"]
    assert "would change what is stated" in table.caption
    plain = tables_devices.safe_lengths(found, NONE)
    assert COLUMN not in plain.cells
    assert "Model error" not in plain.caption
    columns = ["model_error_percent", "model_error_se_percent", "interpolated"]
    assert table.frame.drop(columns=columns).equals(plain.frame)


def test_stoppers_have_the_error_of_their_force_except_over_all_humidities():
    table = tables_budget.stoppers(STOPPERS, QUIET, ERRORS)
    assert table.cells[COLUMN].tolist()[:3] == ["-30.0 ± 1.0", "-10.0 ± 1.0 *", "–"]
    assert COLUMN not in tables_budget.stoppers(STOPPERS, QUIET).cells


def test_a_budget_has_a_row_of_the_model_that_is_no_part_of_its_total():
    table, plain = tables_budget.budget(BUDGETS, ERRORS), tables_budget.budget(BUDGETS)
    rows = table.cells[table.cells.what == "model error: full elastic contact"].set_index(["device", "RH", "held by"])
    shown = rows["effect [%]"].to_dict()
    assert shown == {
        ("C1", "0.44", "beam"): "+11.0 ± 1.0",
        ("C1", "0.67", "beam"): "+2.0 ± 1.0 *",
        ("C1", "0.67", "tip"): "–",
        ("S1", "0.67", "whole area"): "-10.0 ± 1.0 *",
    }
    others = table.frame[~table.frame.part.isin(tables_budget.MODEL)].reset_index(drop=True)
    assert others.equals(plain.frame)


def test_tips_of_corrected_devices_have_the_correction_of_their_pair():
    size = {"pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.67]}
    chart = {"thicknesses_um": [2, 2.6], "humidities": [0.5, 0.8]}
    devices = {
        "C1": size | {"kind": "cantilever", "chart": chart},
        "R1": size | {"kind": "bridge", "gap_um": 2, "residual_stress_MPa": 50},
    }
    full, summits = (Plan(load({"devices": devices, "contact": {"model": model}})) for model in ("full", "summits"))
    for job in ("devices/safe_lengths/C1_rh067", "devices/chart/C1_rh067"):
        assert Graph(full).job(job).inputs["model_error"] == "studies/model_error/across/b"
        assert "model_error" not in Graph(summits).job(job).inputs
    assert "model_error" not in Graph(full).job("devices/safe_lengths/R1_rh067").inputs


@pytest.mark.slow
def test_a_page_says_by_how_much_and_which_side_is_safe():
    (dry, wet) = (safe(), safe(longest=500e-6))
    given = {"C1": CANTILEVER | {"humidities": [0.44, 0.67]}}
    page = beam_page(given["C1"], {0.44: dry, 0.67: wet}, errors=ERRORS).html
    assert "would change the lengths held by the beam by +11.0 ± 1.0 % at a relative humidity of 0.44" in page
    assert "It is not known for what the tip holds." in page
    applied = {"C1": ERRORS["C1"].assign(applied=("humidity", [True, True]))}
    corrected = beam_page(given["C1"], {0.44: dry, 0.67: wet}, errors=applied).html
    assert "Sizes contain the upper end (95 % confidence)." in corrected
    assert "It is not known for what the tip holds." not in corrected
    assert "What is stated is on the safe side" in page
    stopper = stopper_page(STOPPER, STOPPERS["S1"], {(0.67,): BUDGETS["S1", 0.67]}, errors=ERRORS).html
    assert "the pull-off force by −30.0 ± 1.0 % at a relative humidity of 0.44" in stopper
    assert "model error: full elastic contact" in stopper
    assert "Full elastic contact" not in stopper_page(STOPPER, STOPPERS["S1"]).html


@pytest.mark.parametrize(
    ("shape", "factor", "said"),
    [
        (S_SHAPE, [1.1, 1.1], "is on the safe side"),
        (S_SHAPE, [1.1, 0.985], "is on the safe side"),  # within two standard errors
        (
            S_SHAPE,
            [1.1, 0.9],
            "is not on the safe side of it at a relative humidity of 0.67: shorten the lengths by 10 %",
        ),
        (FORCE, [0.7, 0.9], "is on the safe side"),
        (
            FORCE,
            [1.2, 0.9],
            "is not on the safe side of it at a relative humidity of 0.44: raise the restoring force by 20 %",
        ),
    ],
)
def test_longer_beams_and_smaller_forces_are_on_the_safe_side(shape, factor, said):
    assert said in " ".join(model_errors.sentences("D", {"D": error((shape,), factor)}))


def test_sentences_say_what_full_contact_leaves_out_and_whether_it_has_been_applied():
    plain, across, applied = (
        " ".join(model_errors.sentences("D", {"D": error((S_SHAPE,), [1.1, np.nan], **changed)}))
        for changed in ({}, {"across_gaps": True}, {"applied": (0.44, 0.67)})
    )
    assert "is in neither model" in plain
    assert "ttraction across gaps" not in across, "a designer asks for what is left out"
    assert "It is not known at a relative humidity of 0.67." in plain
    assert "Full elastic contact of the surfaces, inside, has changed the lengths" in applied
    assert "Full elastic contact of the surfaces, not inside, would change the lengths" in plain
    assert "safe side" not in applied
    unknown = model_errors.sentences("D", {"D": error((FORCE,), [np.nan, np.nan])})
    assert "is not known at relative humidities of 0.44, 0.67, beyond the humidities of the pair." in unknown[0]
    dry = error((FORCE,), [np.nan, 1.1]).assign_coords(humidity=[0.0, 0.67])
    assert "It is not known in dry air." in model_errors.sentences("D", {"D": dry})


# Pairs in dry air alone


DRY = {
    "run": {"pairs": ["a"], "studies": ["full_contact"]},
    "pairs": {"b": {"humidities": ["dry"]}},
    "devices": {
        name: {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "restoring_force_uN": 20, "humidities": [air]}
        for name, air in (("S1", "dry"), ("S2", 0.6))
    },
}


def test_a_device_in_dry_air_has_the_error_of_strips_in_dry_air():
    graph = Graph(Plan(load(DRY)))
    assert graph.job("devices/S1.html").inputs["errors"] == {"S1": "devices/model_error/S1"}
    assert graph.job("devices/model_error/S1").inputs == {"study": "studies/full_contact/across/b"}
    assert graph.job("studies/full_contact/across/b").settings["humidities"] == [0]
    study = full_contact.layout(np.tile([2.0, 1.5, 1, 1, 0, 0, 0, 0, 0], (3, 1, 1)), [0.0], 1e-8)
    job = graph.job("devices/model_error/S1")
    assert float(job.compute({"study": study}).factor[0, 0]) == pytest.approx(1.5)
    humid = graph.job("devices/model_error/S2").compute({"study": study})
    said = " ".join(model_errors.sentences("S2", {"S2": humid}))
    assert "is not known at a relative humidity of 0.6" in said


def test_where_no_water_condenses_a_device_has_the_error_of_dry_air_at_any_humidity():
    waxed = {"materials": {"Wax": {"contact_angle_deg": 110}}}
    waxed |= {"surfaces": {name: {"material": "Wax"} for name in ("B2", "Sub1")}}
    waxed |= {"run": {"pairs": ["b"], "studies": []}, "pairs": {"b": {"humidities": [0.6]}}}
    graph = Graph(Plan(load(DRY, waxed, {"contact": {"model": "full"}})))
    assert graph.job("studies/full_contact/across/b").settings["humidities"] == [0]
    of_pair = graph.job("studies/model_error/across/b")
    assert of_pair.settings["humidities"] == of_pair.settings["applied"] == [0.6, 0.65, 0]
    study = full_contact.layout(np.tile([2.0, 1.5, 1, 1, 0, 0, 0, 0, 0], (3, 1, 1)), [0.0], 1e-8)
    found = graph.job("devices/model_error/S2").compute({"study": study})
    assert float(found.factor.sel(humidity=0.6)[0]) == pytest.approx(1.5)
    ratios = of_pair.compute({"study": study})
    np.testing.assert_allclose(ratios.pull_off_ratio, [1.5, 1.5, 1.5])
    for dataset in (found, ratios):
        assert dataset.applied.all()
        assert not dataset.interpolated.any()


IN_BOTH = {
    "pairs": {"b": {"humidities": [0.6]}},
    "devices": {
        "C1": {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30},
        "S1": DRY["devices"]["S1"],
    },
}
IN_BOTH["devices"]["C1"] |= {"humidities": ["dry", 0.6]}


def test_devices_are_corrected_in_all_air_unless_the_model_is_stated():
    """A device needs dry air of its own alone: its pair has none."""
    graph = Graph(Plan(load(IN_BOTH)))
    dry = {"model_error": "studies/model_error/dry/b"}
    for job in ("devices/safe_lengths/C1_dry", "devices/ground/b_dry_1500x30000", "devices/stoppers/S1"):
        assert dry.items() <= graph.job(job).inputs.items()
    humid = {"model_error": "studies/model_error/devices/b"}
    for job in ("devices/ground/b_rh060_1500x30000", "devices/safe_lengths/C1_rh060"):
        assert humid.items() <= graph.job(job).inputs.items()
    assert graph.job("studies/model_error/devices/b").inputs["study"] == "studies/full_contact/dry/b"
    assert graph.job("studies/full_contact/dry/b").settings["humidities"] == [0]
    ratios = graph.job("studies/model_error/dry/b").settings
    assert (ratios["humidities"], ratios["applied"]) == ([0.6, 0], [0])
    summits = Graph(Plan(load(IN_BOTH, {"contact": {"model": "summits"}})))
    assert "model_error" not in summits.job("devices/safe_lengths/C1_dry").inputs
    assert "errors" not in summits.job("devices/C1.html").inputs


def test_a_device_in_dry_and_in_humid_air_says_what_full_contact_has_changed_and_what_is_not_known():
    graph = Graph(Plan(load(IN_BOTH)))
    study = full_contact.layout(np.tile([2.0, 1.5, 1, 1, 0, 0, 0, 0, 0], (3, 1, 1)), [0.0], 1e-8)
    unknown = full_energy.layout(full_energy.UNKNOWN, full_energy.NOT_FOUND, "it does not settle")
    by_levels = pair_model_error.of_devices({("b", 0.6): unknown}, study)
    found = graph.job("devices/model_error/C1").compute({"study": study, "by_levels": by_levels})
    assert found.applied.values.tolist() == [True, False]
    said = " ".join(model_errors.sentences("C1", {"C1": found}))
    assert "has changed the lengths held by the beam by -15.9" in said, "2 ** (-1/4) - 1"
    assert "It is not known at a relative humidity of 0.6." in said
    assert "Full elastic contact changes the tip, too." in said
    assert "It is not known for what the tip holds at a relative humidity of 0.6." in said
    assert "would change" not in said


def test_a_table_of_beams_says_that_lengths_without_a_known_change_are_those_on_summits():
    by_levels = error((S_SHAPE, EITHER), [1.1, 1.1], applied=(0.44,), by_levels=True)
    assert ", or would change it where its error is too large" in str(column.caption({"C1": by_levels}))
    assert "in dry air" in str(column.caption({"C1": error((S_SHAPE,), [0.9, 1.1], applied=(0.44,))}))


def test_with_the_study_of_full_contact_dry_air_is_part_of_it():
    graph = Graph(Plan(load(IN_BOTH, {"run": {"studies": ["full_contact"]}})))
    assert graph.job("devices/safe_lengths/C1_dry").inputs["model_error"] == "studies/model_error/across/b"
    assert graph.job("devices/ground/b_rh060_1500x30000").inputs["model_error"] == "studies/model_error/devices/b"
    assert graph.job("studies/model_error/devices/b").inputs["study"] == "studies/full_contact/across/b"
    assert graph.job("studies/full_contact/across/b").settings["humidities"] == [0, 0.6]
    assert graph.job("studies/model_error/across/b").settings["applied"] == [0]


def test_without_errors_nothing_is_said():
    assert model_errors.sentences("S3", None) == []
    assert np.isnan(model_errors.device_change(ERRORS, "S3", 0.67, FORCE)["model_error_percent"])
