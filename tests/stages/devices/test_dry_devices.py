"""Devices in dry air: contacts of their own, no inputs of the air, a row and a point beside the axis for dry air."""

import re
from dataclasses import replace

import numpy as np
import pytest
import small
import xarray as xr
from answers import BEAM, beam_page, budget_dataset, stopper_page
from charted import charted
from ground import C1, R1, safe_with_tips
from numpy.testing import assert_allclose, assert_array_equal
from plans import job_settings

from stiction.beam.energy import arrest_length
from stiction.config.cases import Case
from stiction.config.files import load
from stiction.constants import HAMAKER_CONSTANT
from stiction.contact.environment import Gaps, Water, flooded_law
from stiction.contact.vanderwaals import attraction
from stiction.device import Device
from stiction.devices.arcs import arc_length
from stiction.devices.bridges import least_length
from stiction.plan.graph import Graph, Results
from stiction.plan.plan import Plan
from stiction.report.budget import figures as figures_budget
from stiction.report.budget import tables as tables_budget
from stiction.report.devices import figures as figures_devices
from stiction.report.devices import pages, sentences
from stiction.report.devices import tables as tables_devices
from stiction.report.format import airs
from stiction.stages.contact import contact, curves
from stiction.stages.devices import stoppers
from stiction.stages.devices.device_warnings import OfDevices
from stiction.stages.devices.sticking import flooded_lengths
from stiction.stages.devices.uncertain_inputs import InputState, Uncertainty, countable, uncertain

ACROSS = Water(300.0, gaps=Gaps(HAMAKER_CONSTANT, "water", 100e-9))
SIDES = (1.5e-6, 6e-6)
CANTILEVER = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 6}
CANTILEVER |= {"chart": {"thicknesses_um": [2.6, 4], "humidities": [0.5, 0.9]}}
CANTILEVER |= {"uncertainty": {"young_modulus_GPa": 5, "temperature_K": 2, "contact_angle_deg": 10, "scan_um": 10}}
STOPPER = {"kind": "stopper", "pair": "b", "contact_um": [1.5, 6], "restoring_force_uN": 1}
SIZES = {"attraction": {"reach": "all"}, "run": {"pairs": []}, "design": {"chart_points": 3}}


def plan_of(humidities):
    """A cantilever and a stopper at some humidities."""
    devices = {"C1": CANTILEVER | {"humidities": humidities}, "S1": STOPPER | {"humidities": humidities}}
    return Plan(load(SIZES, {"devices": devices}))


PLAN = plan_of(["dry", 0.67])
SURFACES = {stage: [f"{stage}/B2", f"{stage}/Sub1"] for stage in ("heights", "spectrum")}
#: Correction to full elastic contact.
FULL = {"model_error": "studies/model_error/dry/b"}
BY_LEVELS = {"model_error": "studies/model_error/devices/b"}


# Names and settings


@pytest.mark.parametrize(
    ("job", "inputs"),
    [
        ("devices/cracks/C1_dry", {"ground": "devices/ground/b_dry_1500x6000"}),
        ("devices/ground/b_dry_1500x6000", {"contact": "devices/contact/b_dry_1500x6000", **SURFACES, **FULL}),
        ("devices/ground/b_rh067_1500x6000", {"contact": "devices/contact/b_1500x6000", **SURFACES, **BY_LEVELS}),
        (
            "devices/stoppers/S1",
            {"contact": "devices/contact/b_1500x6000", "dry": "devices/contact/b_dry_1500x6000"} | BY_LEVELS,
        ),
    ],
)
def test_a_device_in_dry_air_sticks_on_the_contact_in_dry_air(job, inputs):
    assert Graph(PLAN).job(job).inputs == inputs


def test_tips_budgets_and_charts_have_contacts_in_dry_air_with_the_same_surfaces():
    graph = Graph(PLAN)
    for name in ("devices/safe_lengths/C1", "devices/chart/C1", "devices/budget/C1"):
        dry, humid = (graph.job(f"{name}_{air}") for air in ("dry", "rh067" if "chart" not in name else "rh070"))
        files = _files(dry.inputs)
        for file in files & {file for file in files if file.startswith("devices/contact")}:
            if "choices" in file:
                continue
            settings = graph.job(file).settings
            assert settings == graph.job(file.replace("b_dry_", "b_")).settings | {"van_der_waals": "dry"}
        assert {file.replace("b_dry_", "b_") for file in files} - _files(humid.inputs) <= {
            "devices/cracks/C1_dry",
            "devices/ground/b_1500x6000",
            *FULL.values(),
        }


def _files(inputs):
    """Files of all inputs of a job."""
    named = (names if not isinstance(names, str) else [names] for names in inputs.values())
    return {file for names in named for file in (names.values() if isinstance(names, dict) else names)}


def test_counted_test_beams_stick_on_the_contacts_of_their_own_air():
    array = {key: CANTILEVER[key] for key in ("pair", "thickness_um", "gap_um", "width_um")}
    array["stuck"] = [{"humidity": h, "length_um": 300, "stuck": 3, "of": 20} for h in ("dry", 0.5, 0.67)]
    device = CANTILEVER | {"humidities": [0.67], "test_beams": ["T"]}
    job = Graph(Plan(load(SIZES, {"devices": {"C1": device}, "test_beams": {"T": array}}))).job("devices/test_beams/C1")
    patch = "1500x6000"
    grounds = {("T", "dry"): f"devices/contact/b_dry_{patch}", ("T", "humid"): f"devices/contact/b_{patch}"}
    assert job.inputs["grounds"] == grounds
    assert [name.split("/")[-1].rsplit("_", 1)[0] for name in job.inputs["tips"].values()] == ["b_dry", "b"]
    water = job.stage.converted(job.settings).stuck["T"].water
    assert [water.at(humidity).gaps.summits for humidity in (0.0, 0.5)] == ["dry", "water"]
    coated = replace(water, contact_angles=(2.0, 2.0))
    assert coated.at(0.5) == coated.at(0.0)


def test_humid_air_is_as_without_dry_air():
    humid = plan_of([0.67])
    tips = f"devices/contact/tips/{humid.devices.tips('C1').name}"
    for name in (
        "cracks/C1_rh067",
        "safe_lengths/C1_rh067",
        "chart/C1_rh070",
        "budget/C1_rh067",
        "budget/C1_rh067_tip",
    ):
        jobs = [Graph(plan).job(f"devices/{name}") for plan in (PLAN, humid)]
        assert jobs[0].settings == jobs[1].settings
        assert jobs[0].inputs == jobs[1].inputs
    assert job_settings(PLAN, tips) == job_settings(humid, tips)


def test_choices_of_the_medium_are_none_in_dry_air():
    dry, humid = (PLAN.variants.choices_of_device(Case(case)) for case in ("C1_dry", "C1_rh067"))
    assert dry == [name for name in humid if not name.startswith("van_der_waals")]
    assert not [name for name in dry if name.startswith("van_der_waals")]
    assert [name for name in dry if name.startswith("poisson_ratio")]


def test_a_chart_has_dry_air_beside_its_axis_if_the_device_states_it():
    axis = [f"C1_rh0{percent}" for percent in (50, 67, 70, 90)]
    assert PLAN.devices.chart_cases("C1") == ["C1_dry", *axis]
    assert plan_of([0.67]).devices.chart_cases("C1") == ["C1_rh050", "C1_rh067", "C1_rh070", "C1_rh090"]


def test_a_device_of_surfaces_that_water_does_not_wet_is_dry_at_any_humidity():
    wax = {
        "materials": {"Wax": {"contact_angle_deg": 100}},
        "surfaces": {n: {"material": "Wax"} for n in ("B2", "Sub1")},
    }
    graph = Graph(Plan(load(SIZES, wax, {"devices": {"S1": STOPPER | {"humidities": [0.67]}}})))
    job = graph.job("devices/stoppers/S1")
    assert job.inputs == {"contact": "devices/contact/b_dry_1500x6000"} | FULL
    settings = job.stage.converted(job.settings)
    assert settings.water.gaps.summits == "dry"
    assert_array_equal(stoppers.axis_of(settings), [0.0])
    known = {
        "lengths": {},
        "charts": {},
        "plasticity": {},
        "estimates": {},
        "spectra": {},
        "stoppers": {"S1": xr.Dataset({"share_flat": 0.0, "rms": 3e-9})},
    }
    found = graph.job("devices/warnings/S1.json").compute(known)[2][0][1]
    assert found[0].kind == "no_water"


def test_a_device_takes_the_word_and_the_number():
    device = Device("S1", Results.of(PLAN.config))
    assert device._result.__self__ is device  # noqa: SLF001
    with pytest.raises(ValueError, match="only a cantilever or bridge has this"):
        device.cracks("dry")


# Stoppers


def in_air(name):
    """Contact of pair b of the small study, in the air that its name says."""
    plan = Plan(
        load(
            {"attraction": {"reach": "all"}, "contact": {"samples": 20}, "beam": {"width_um": 6}, "chaos": {"order": 2}}
        )
    )
    settings = small.settings_of(contact, job_settings(plan, f"contact/{name}_NG"))
    return contact.compute(small.surfaces(), name, "NG", settings)


@pytest.fixture(scope="module")
def grounds():
    return in_air("b"), in_air("b_dry")


SETTINGS = stoppers.Settings(1, ACROSS, SIDES, (0.0, 0.67), (0.6, 0.9), restoring_force=1e-6)


def test_a_stopper_holds_least_in_dry_air_and_its_worst_air_is_the_worst_of_all(grounds):
    found = stoppers.compute(grounds[0], SETTINGS, grounds[1])
    assert found.axis[0] == 0
    assert_allclose(found.pull_off.sel(humidity=0.0), 9e-12 * curves.pull_offs(grounds[1], 0.0, ACROSS.at(0.0)))
    assert np.all(found.pull_off.sel(humidity=0.0) < found.pull_off.sel(humidity=0.67))
    humid = stoppers.compute(grounds[0], replace(SETTINGS, humidities=(0.67,)))
    assert_array_equal(found.isel(axis=slice(1, None)).mean_along, humid.mean_along)
    for name in ("worst_humidity", "worst_humidity_error"):
        assert found[name] == humid[name]
    assert stoppers.ends(found) == stoppers.ends(humid) == (0.6, 0.9)


def test_dry_air_is_the_worst_of_a_stopper_that_holds_most_in_it(grounds):
    found = stoppers.compute(
        grounds[0], SETTINGS, grounds[0].assign(solid_pressure=grounds[1].solid_pressure * 0 - 1e9)
    )
    assert (float(found.worst_humidity), float(found.worst_humidity_error)) == (0.0, 0.0)
    assert not stoppers.is_at_an_end(found)
    assert tables_budget.worst_humidity(0.0, 0.0, False) == "dry"
    assert sentences.worst_sentence(found).startswith(
        "Its mean force is largest in dry air: larger than in humid air from 0.6 to 0.9."
    )


def test_a_stopper_in_dry_air_alone_is_in_no_humid_air(grounds):
    found = stoppers.compute(grounds[1], replace(SETTINGS, water=ACROSS.at(0.0), humidities=(0.0,)))
    assert_array_equal(found.axis, [0.0])
    assert stoppers.ends(found) == ()
    forces = 5e-8 * np.arange(1, 401)[None]
    for restoring, sign in ((1e-6, "Too weak"), (21e-6, "Suffices")):
        settings = replace(SETTINGS, humidities=(0.0,), restoring_force=restoring)
        layout = stoppers.layout(settings, forces, np.array([0.0]), forces)
        made = stopper_page(STOPPER | {"humidities": [0.0]}, layout)
        assert made.lines[0].startswith(f"{sign}: At least 20 µN; with your {1e6 * restoring:g} µN, ")
        page = made.html + " ".join(made.lines)
        assert "humidity of" not in page.replace("Humidity of the largest", "")
        assert "in dry air, " in page
        assert "orst humidity" not in page
    alone = tables_budget.stoppers({"S1": layout}, {"S1": []})
    assert list(alone.cells.RH) == ["dry"]
    assert "RH of largest mean" not in alone.cells
    assert "axis" not in alone.caption
    legend = figures_budget.stoppers({"S1": layout}, {}).axes[1].get_legend()
    shown = ["mean and 5 to 95 %, dry", "simulated limit, 1 in 100", "restoring force"]
    assert [text.get_text() for text in legend.texts] == shown
    both = tables_budget.stoppers({"S1": layout, "S2": humid_layout()}, {"S1": [], "S2": []})
    assert list(both.cells.RH) == ["dry", "0.67", "0.6 to 0.9"]
    assert list(both.cells["RH of largest mean"])[0] == "dry"
    assert "One in a single air has no such row." in both.caption


def humid_layout():
    """Dataset of a stopper that is in humid air alone."""
    settings, axis = replace(SETTINGS, humidities=(0.67,)), stoppers.fine_axis(0.6, 0.9)
    forces = np.outer(axis, 5e-8 * np.arange(1, 401))
    return stoppers.layout(settings, forces[:1], axis, forces)


# Bounds and budgets


def test_the_bound_of_a_dry_cantilever_is_that_of_flats_in_contact():
    work = attraction("dry").work_of_adhesion
    found = flooded_lengths(C1, ACROSS.at(0.0), 0.0, 0.0)
    assert_allclose(found, [arrest_length(work, C1.beam), arc_length(work, C1.beam)], rtol=1e-12)
    for medium in ("dry", "water"):  # that of the air counts, also on a curve in both airs
        bridge = replace(R1, hamaker_constant=HAMAKER_CONSTANT[medium])
        law = flooded_law(0.0, ACROSS.at(0.0), HAMAKER_CONSTANT["dry"])
        assert_allclose(law[0], work, rtol=1e-12)
        assert flooded_lengths(bridge, ACROSS.at(0.0), 0.0, 0.0) == [least_length(*law, bridge.beam)]


def test_a_budget_in_dry_air_has_no_inputs_of_the_air():
    stated = Uncertainty(thickness=1e-7, humidity=0.01, temperature=2.0, contact_angle=0.1, adsorbed=1e-10)
    names = {}
    for humidity in (0.0, 0.67):
        settings = replace(BEAM, water=ACROSS, humidity=humidity, uncertainty=stated)
        inputs, covariance = uncertain(InputState(None, humidity, ACROSS, C1), {}, {}, {}, settings)
        names[humidity] = [one.name for one in inputs]
        assert covariance.shape == (len(inputs), len(inputs))
        assert ("the humidity" in countable(("thickness",), settings)) == (humidity > 0)
    assert names[0.0] == ["thickness"]
    assert set(names[0.67]) - set(names[0.0]) == {
        "humidity",
        "temperature",
        "contact angle on the beam",
        "contact angle on the substrate",
        "adsorbed water",
    }


# Tables, figures, pages


def test_tables_print_dry_and_their_numbers_are_those_of_humidity_zero():
    tips = 2e-3 * np.exp(0.4 * np.random.default_rng(9).standard_normal(400))
    cases = {("C1", 0.0): safe_with_tips(tips), ("C1", 0.67): safe_with_tips(1.5 * tips)}
    warnings = {(*case, shape): [] for case in cases for shape in ("S-shape", "S-shape or arc")}
    table = tables_devices.safe_lengths(cases, warnings)
    assert list(dict.fromkeys(table.cells.RH)) == ["dry", "0.67"]
    assert set(table.frame.relative_humidity) == {0.0, 0.67}
    assert "dry" in [text.get_text() for text in figures_devices.simulated(cases, warnings).axes[0].get_legend().texts]
    budgets = tables_budget.budget({("C1", 0.0): budget_dataset(), ("C1", 0.67): budget_dataset()})
    assert "C1, dry: " in budgets.caption
    assert set(budgets.cells.RH) == {"dry", "0.67"}


def without_water(dataset):
    """The same where no water condenses: in dry air, or because it does not wet the surfaces."""
    return dataset.assign(film=0.0)


TIPS = safe_with_tips(2e-3 * np.exp(0.4 * np.random.default_rng(9).standard_normal(400)))


def captions(datasets):
    """Captions of the tables of a device and the page, of datasets of stages safe_lengths and chart by humidity."""
    shapes = [str(shape) for shape in TIPS["shape"].values]
    warnings = {("C1", humidity, shape): [] for humidity in datasets for shape in shapes}
    warnings |= {("C1", t, g, s): [] for t in (2e-6, 3e-6) for g in (10e-6, 20e-6) for s in shapes}
    charts = {humidity: charted(humidity).assign(film=dataset.film) for humidity, dataset in datasets.items()}
    section = CANTILEVER | {"humidities": list(datasets)}
    return (
        tables_devices.safe_lengths({("C1", humidity): one for humidity, one in datasets.items()}, warnings).caption,
        tables_devices.chart({("C1", humidity): one for humidity, one in charts.items()}, warnings).caption,
        beam_page(section, datasets, charts=charts, warnings=OfDevices(warnings, {}, {})).html,
    )


@pytest.mark.parametrize("humidity", [0.0, 0.67])
def test_nothing_is_said_of_water_that_fills_gaps_where_none_condenses(humidity):
    for text in captions({humidity: without_water(TIPS)}):
        assert "flats in contact" in text
        assert not [word for word in ("saturated", "flooded", "all gaps", "at this humidity") if word in text]


@pytest.mark.slow
def test_bounds_in_both_airs_are_told_apart():
    for text in captions({0.0: without_water(TIPS), 0.67: TIPS}):
        assert "with water in all gaps" in text
        assert re.search("(Without condensation, bounds are those|In dry air: that) of flats in contact", text)
    for text in captions({0.67: TIPS}):
        assert "Without condensation" not in text
        assert "Dry air" not in text


def test_a_chart_shows_dry_air_beside_the_axis_and_no_line_leads_there():
    cases = {("C1", humidity): charted(humidity) for humidity in (0.0, 0.5, 0.6)}
    warnings = {
        ("C1", t, g, s): [] for t in (2e-6, 3e-6) for g in (10e-6, 20e-6) for s in ("S-shape", "S-shape or arc")
    }
    panel = figures_devices.chart(cases, warnings).axes[0]
    ticks = dict(zip([text.get_text() for text in panel.get_xticklabels()], panel.get_xticks(), strict=True))
    assert 0.4 < ticks["dry"] < 0.5
    lines = [line for line in panel.lines if line.get_linestyle() not in ("None", "") and len(line.get_xdata()) > 1]
    assert not [line for line in lines if line.get_xdata()[0] == ticks["dry"] != line.get_xdata()[-1]]
    assert [line for line in panel.lines if list(line.get_xdata()) == [ticks["dry"]]]
    assert set(tables_devices.chart(cases, warnings).cells.RH) == {"dry", "0.5", "0.6"}


def test_a_budget_has_bars_of_zero_length_for_what_dry_air_does_not_have():
    humid = budget_dataset()
    dry = humid.isel(input=[2], other=[2]).drop_sel(choice="van_der_waals_dry")
    rows = figures_budget._measurements({0.0: dry, 0.67: humid})  # noqa: SLF001
    assert rows["heights of B2"][0] == (0.0, 0.0, 0.0)
    assert rows["heights of B2"][1][1] > 0
    assert rows["thickness"][0][1] == pytest.approx(100), "dry air has no other input"
    assert rows["thickness"][1][1] == pytest.approx(100 - rows["heights of B2"][1][1])
    assert figures_budget._choices({0.0: dry, 0.67: humid})["van der Waals in dry gaps"][0] == (0.0, 0.0, 0.0)  # noqa: SLF001
    cells = pages._side_by_side(tables_budget.cells_of_page({("C1", 0.0): dry, ("C1", 0.67): humid}))  # noqa: SLF001
    assert cells.columns[0] == "what"
    assert "held by" not in cells, "all the same"
    assert "dry: effect [%]" in cells
    assert "–" in set(cells["dry: effect [%]"])


@pytest.mark.parametrize(
    ("humidities", "words"),
    [
        ([0.0], "in dry air"),
        ([0.0, 0.45], "in dry air and at a relative humidity of 0.45"),
        ([0.45], "at a relative humidity of 0.45"),
        ([0.45, 0.67], "at relative humidities of 0.45, 0.67"),
    ],
)
def test_sentences_say_in_which_air(humidities, words):
    assert airs(humidities) == words
