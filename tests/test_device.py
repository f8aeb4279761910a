"""A device in Python: the same stages, settings and random numbers as in the workflow."""

import numpy as np
import pytest
import xarray as xr

import stiction
from stiction.config.units import in_si
from stiction.contact.environment import Water
from stiction.devices.limits import rules as limits
from stiction.models import MOMENT_QUANTITIES
from stiction.plan.graph import Graph, Results
from stiction.plan.plan import Plan
from stiction.report.limits.words import text
from stiction.stages.contact import curves

C1 = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 10, "width_um": 20, "humidities": [0.88]}
C1 |= {"chart": {"thicknesses_um": [2.6], "humidities": [0.8, 0.9]}}
R1 = {"kind": "bridge", "pair": "b", "thickness_um": 2, "gap_um": 2, "width_um": 4, "residual_stress_MPa": 50}
S1 = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "restoring_force_uN": 1, "humidities": [0.5]}
CONFIG = stiction.load(
    {
        "devices": {"C1": C1, "R1": R1 | {"humidities": [0.88]}, "S1": S1},
        "beam": {"width_um": 20},
        "contact": {"samples": 40, "model": "summits"},
        "chaos": {"order": 2},
        "design": {"beams": 200, "shares": [0.02]},
    }
)


@pytest.fixture(scope="module")
def device():
    return stiction.Device.of(CONFIG, "C1")


def test_strips_that_equal_those_of_the_pair_are_its_strips(device):
    xr.testing.assert_identical(device.contact, stiction.PairStudy.of(CONFIG, "b").contact)
    assert device.tips.sizes["strip"] == 200
    assert (device.tips.sizes["slope"] > 1) is True


def test_safe_lengths_are_shorter_than_their_estimates(device):
    found = device.safe_lengths(0.88)
    assert np.all(found.safe_length < found.estimate)
    assert np.all(found.safe_length.sel(shape="S-shape or arc") <= found.safe_length.sel(shape="S-shape"))


def test_lengths_held_by_the_beam_have_intervals_with_the_form_of_the_model_as_an_error(device):
    found = device.safe_lengths(0.88)
    held, tips = found.sel(shape="S-shape"), found.sel(shape="S-shape or arc")
    assert np.all((held.prediction_low < held.estimate) & (held.estimate < held.prediction_high))
    assert np.isnan(tips.prediction_low).all()


def test_results_are_computed_once(device):
    assert device.cracks(0.88) is device.cracks(0.88)
    assert device.safe_lengths(0.88) is device.safe_lengths(0.88)


def test_warnings_are_those_of_all_shapes_and_that_plasticity_is_not_checked(device):
    found = device.safe_lengths(0.88)
    assert device.limits(found) == [limits.plastic_contact(np.nan, np.nan)]
    length = float(found.safe_length.sel(shape="S-shape").min())
    warnings = device.warnings(found.assign(safe_length=found.safe_length * 100e-6 / length))
    assert warnings[0] == text(limits.large_rotation(10e-6, 100e-6))
    assert sum("slope" in sentence for sentence in warnings) == 2  # of beam and tip
    assert len(warnings) == len(set(warnings))


def test_the_chart_at_the_size_of_the_device_has_its_safe_lengths(device):
    alone = device.safe_lengths(0.88).safe_length.values
    np.testing.assert_array_equal(device.chart(0.88).safe_length.values[0, 0], alone)


def test_a_bridge_has_strips_of_its_own_width_and_no_tips():
    bridge = stiction.Device.of(CONFIG, "R1")
    assert bridge.tips is None
    assert bridge.results.graph.job("devices/ground/b_rh088_500x4000").inputs == {
        "contact": "devices/contact/b_500x4000",
        "heights": ["heights/B2", "heights/Sub1"],
        "spectrum": ["spectrum/B2", "spectrum/Sub1"],
    }
    assert bridge.contact.sizes["strip"] == 40


def test_a_stopper_has_its_whole_area_and_the_forces_of_its_stage():
    stopper = stiction.Device.of(CONFIG, "S1")
    assert stopper.tips is None
    found = stopper.forces()
    water = in_si(Water, Plan(CONFIG).air_of_devices.water("b"))
    assert water.gaps is not None
    pulls = curves.pull_offs(stopper.contact, 0.5, water)
    np.testing.assert_allclose(found.pull_off.sel(humidity=0.5), 9e-12 * pulls, rtol=1e-12)
    assert stopper.limits(found) == [limits.plastic_contact(np.nan, np.nan)]


def test_a_stopper_on_very_rough_surfaces_does_not_stick_and_a_smooth_one_does():
    small = {"kind": "stopper", "pair": "b", "contact_um": [1, 1], "restoring_force_uN": 1, "humidities": [0.67]}
    few = {
        "devices": {"S1": small},
        "contact": {"samples": 30, "model": "summits"},
        "run": {"pairs": [], "studies": []},
    }
    for rms, expected in ((40, [0, 0, 1 - 0.025 ** (1 / 30)]), (3.4, [1, 0.025 ** (1 / 30), 1])):
        found = stiction.Device.of(stiction.load(few, {"surfaces": {"B2": {"rms_nm": rms}}}), "S1").forces()
        np.testing.assert_allclose(found.stuck.sel(humidity=0.67), expected, rtol=1e-12)


@pytest.fixture(scope="module")
def uncertain():
    """Device on strips of its pair, of which the gap, all solids and the heights of one surface are uncertain."""
    stated = {"gap_um": 0.1, "young_modulus_GPa": 5, "poisson_ratio": 0.02, "hamaker_constant_zJ": 20, "scan_um": 10}
    variants = {"van_der_waals": ["none"], "psd": [], "every": [], "spacing_nm": [], "poisson_ratio": []}
    studies = {"slopes": {"samples": 20}, "variants": variants}
    design = {"budget_beams": 20, "budget_samples": 20}
    few = {"design": design, "studies": studies, "pairs": {"b": {"substrate": "B2"}}}
    narrow = {"beam": {"width_um": 6}, "devices": {"C1": {"width_um": 6, "uncertainty": stated}}}
    return stiction.load(CONFIG, few, narrow)


@pytest.mark.slow
def test_a_budget_has_every_uncertain_input_and_none_of_the_exact_ones(uncertain):
    found = stiction.Device.of(uncertain, "C1").budget(0.88)
    solids = ["Young's modulus", "Poisson's ratio", "Hamaker constant"]
    assert list(found.input.values) == [*(f"{name} of B2" for name in MOMENT_QUANTITIES), "gap", *solids]


@pytest.mark.slow
def test_the_budget_of_the_tips_is_of_the_length_that_they_hold(uncertain):
    found = stiction.Device.of(uncertain, "C1").tip_budget(0.88)
    assert 0.4 < found.slope.sel(input="gap") < 0.8
    assert found.centre.attrs["response"] == "arc"


@pytest.mark.parametrize(("stated", "names"), [({"scan_um": 10}, ["B2", "Sub1"]), ({"gap_um": 0.1}, [])])
def test_a_budget_needs_the_surfaces_with_uncertain_quantities_only(stated, names):
    config = stiction.load(CONFIG, {"devices": {"C1": {"uncertainty": stated}}})
    inputs = Graph(Plan(config)).job("devices/budget/C1_rh088").inputs
    assert list(inputs["heights"]) == list(inputs["spectrum"]) == names
    assert {surface for surface, _ in inputs["less"]} == set(names)


@pytest.mark.parametrize(("strip", "length"), [({}, 1.5), ({"strip_um": 3}, 3)])
def test_contacts_of_a_budget_are_on_the_strips_of_the_device_and_choices_change_them(uncertain, strip, length):
    every = {"van_der_waals": [], "psd": [], "every": [2], "spacing_nm": [], "poisson_ratio": []}
    graph = Graph(Plan(stiction.load(uncertain, {"devices": {"C1": strip}, "studies": {"variants": every}})))
    inputs = graph.job("devices/budget/C1_rh088").inputs
    for name in (inputs["contact"], *inputs["less"].values(), *inputs["properties_less"].values()):
        assert graph.job(name).settings["sampling"]["strip_length_um"] == length
    ((name, contact),) = inputs["choices"].items()
    settings = graph.job(graph.job(contact).inputs["summits"]).settings
    assert (name, settings["changes"]) == ("every_2", {"contact": {"every": 2}})
    assert settings["base"]["sampling"]["strip_length_um"] == length


def test_a_device_that_does_not_exist_is_refused_with_those_that_do():
    with pytest.raises(ValueError, match="no device C9; the configuration has C1, R1, S1"):
        stiction.Device.of(CONFIG, "C9")


@pytest.mark.parametrize(
    ("name", "ask", "message"),
    [
        ("S1", lambda device: device.safe_lengths(0.5), "S1 is a stopper; only a cantilever or bridge"),
        ("S1", lambda device: device.chart(0.5), "S1 is a stopper"),
        ("C1", lambda device: device.forces(), "C1 is a cantilever; only a stopper or probe has this"),
        ("R1", lambda device: device.chart(0.5), "R1 has no chart: state devices.R1.chart"),
        ("C1", lambda device: device.budget(0.5), "C1 has no uncertainty: state devices.C1.uncertainty"),
    ],
)
def test_what_a_device_does_not_have_is_refused_by_name(name, ask, message):
    with pytest.raises(ValueError, match=message):
        ask(stiction.Device(name, Results.of(CONFIG)))


def test_stuck_devices_have_one_layout_and_the_numbers_of_their_stages(device):
    beam = device.stuck(0.88)
    lengths = device.safe_lengths(0.88).sel(shape="S-shape or arc")
    np.testing.assert_array_equal(beam.stuck, lengths.stuck)
    np.testing.assert_array_equal([beam.low, beam.high], lengths.stuck_band)
    stopper = stiction.Device.of(CONFIG, "S1")
    patches, forces = stopper.stuck(0.5), stopper.forces()
    force = float(forces.restoring_force)
    at = patches.sel(force=force, method="bfill")  # P(stuck) falls from one sampled force to the next
    np.testing.assert_allclose(at.stuck, forces.stuck.sel(humidity=0.5, bound="estimate"), atol=1.01 / 40)
    assert np.all(np.diff(patches.stuck) <= 0)
    assert list(beam.data_vars) == list(patches.data_vars) == ["stuck", "low", "high"]
    assert (beam.length.units, patches.force.units) == ("m", "N")
    for found in (beam, patches):
        assert np.all((found.low <= found.stuck) & (found.stuck <= found.high))


def test_a_device_draws_the_figure_of_its_kind_and_is_described_in_one_line_and_in_a_table(device):
    stopper = stiction.Device(name="S1", results=Results.of(CONFIG))
    for one, words in ((device, "length of the device [µm]"), (stopper, "restoring force [µN]")):
        assert any(panel.get_xlabel().startswith(words) for panel in one.plot().axes)
    assert repr(device) == (
        "Device C1, beam clamped at one end: thickness 2.6 µm, gap 10 µm, width 20 µm, "
        "surfaces B2 on Sub1, pair b, relative humidity 0.88"
    )
    assert "sides of the area in contact 3 x 3 µm" in repr(stopper)
    assert "<td>gap</td><td>10 µm</td>" in device._repr_html_()
