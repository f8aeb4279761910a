"""A device in Python: the same stages, settings and random numbers as in the workflow."""

import numpy as np
import pytest
import xarray as xr

import stiction
from stiction.config import jobs
from stiction.config.designs import Designs
from stiction.config.plan import Plan
from stiction.config.units import typed
from stiction.designs import budget, chart, cracks, inputs, safe_lengths, stoppers
from stiction.devices import limits
from stiction.devices.budget import OF_SOLIDS
from stiction.models import OF_MOMENTS
from stiction.stages import contact
from stiction.studies import slope_contact
from stiction.study import surface_datasets
from stiction.variants import contact as variant_contact
from stiction.variants import summits

C1 = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 10, "width_um": 20, "humidities": [0.88]}
C1 |= {"chart": {"thicknesses_um": [2.6], "humidities": [0.8, 0.9]}}
R1 = {"kind": "bridge", "pair": "b", "thickness_um": 2, "gap_um": 2, "width_um": 4, "residual_stress_MPa": 50}
S1 = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "restoring_force_uN": 1, "humidities": [0.5]}
CONFIG = stiction.load(
    {
        "devices": {"C1": C1, "R1": R1 | {"humidities": [0.88]}, "S1": S1},
        "beam": {"width_um": 20},
        "contact": {"samples": 40},
        "chaos": {"order": 2},
        "design": {"beams": 200, "shares": [0.02]},
    }
)
PLAN = Plan(CONFIG)


@pytest.fixture(scope="module")
def device():
    return stiction.Device.of(CONFIG, "C1")


def drawn(settings):
    surfaces = [surface_datasets(PLAN, name) for name in ("B2", "Sub1")]
    return contact.compute(surfaces, "b", "NG", typed(contact.Settings, settings))


def test_strips_that_equal_those_of_the_pair_are_its_strips(device):
    xr.testing.assert_identical(device.contact, drawn(jobs.contact(PLAN, "b")))
    xr.testing.assert_identical(device.tips, drawn(jobs.tip_contact(PLAN, *Designs(CONFIG).tips("C1"))))
    assert device.tips.sizes["sample"] == 200


def test_safe_lengths_are_those_of_the_stages(device):
    wanted = typed(cracks.Settings, jobs.cracks(PLAN, "C1_rh088"))
    found = cracks.compute(device.contact, wanted)
    xr.testing.assert_identical(device.cracks(0.88), found)
    settings = typed(safe_lengths.Settings, jobs.safe_lengths(PLAN, "C1_rh088"))
    expected = safe_lengths.compute(found, device.tips, settings)
    xr.testing.assert_identical(device.safe_lengths(0.88), expected)
    assert np.all(expected.safe_length < expected.estimate)


def test_cracks_are_computed_once_for_each_humidity(device, monkeypatch):
    first = device.cracks(0.88)
    monkeypatch.setattr(cracks, "compute", lambda *_: pytest.fail("computed again"))
    assert device.cracks(0.88) is first
    device.safe_lengths(0.88)


def test_warnings_are_those_of_all_shapes_and_that_plasticity_is_not_checked(device):
    found = device.safe_lengths(0.88)
    assert device.warnings(found) == [limits.plastic_contact(np.nan)]
    length = float(found.safe_length.sel(shape="S-shape").min())
    warnings = device.warnings(found.assign(safe_length=found.safe_length * 100e-6 / length))
    assert warnings[0] == limits.large_rotation(10e-6, 100e-6)
    assert sum("slope" in sentence for sentence in warnings) == 2  # of beam and tip
    assert len(warnings) == len(set(warnings))


def test_the_chart_at_the_size_of_the_device_has_its_safe_lengths(device):
    settings = typed(chart.Settings, jobs.chart(PLAN, "C1_rh088"))
    xr.testing.assert_identical(device.chart(0.88), chart.compute(device.contact, device.tips, settings))
    alone = device.safe_lengths(0.88).safe_length.values
    np.testing.assert_array_equal(device.chart(0.88).safe_length.values[0, 0], alone)


def test_a_bridge_has_strips_of_its_own_width_and_no_tips():
    bridge = stiction.Device.of(CONFIG, "R1")
    assert bridge.tips is None
    xr.testing.assert_identical(bridge.contact, drawn(jobs.device_contact(PLAN, "b", 500, 4000)))


def test_a_stopper_has_its_whole_area_and_the_forces_of_its_stage():
    stopper = stiction.Device.of(CONFIG, "S1")
    assert stopper.tips is None
    xr.testing.assert_identical(stopper.contact, drawn(jobs.device_contact(PLAN, "b", 3000, 3000)))
    settings = typed(stoppers.Settings, jobs.stoppers(PLAN, "S1"))
    found = stopper.forces()
    xr.testing.assert_identical(found, stoppers.compute(stopper.contact, settings))
    assert stopper.warnings(found) == [limits.plastic_contact(np.nan)]


@pytest.fixture(scope="module")
def uncertain():
    """Device on strips of its pair, of which the gap, all solids and the heights of one surface are uncertain."""
    stated = {"gap_um": 0.1, "young_modulus_GPa": 5, "poisson_ratio": 0.02, "hamaker_constant_zJ": 20, "scan_um": 10}
    variants = {"van_der_waals": ["none"], "psd": [], "every": [], "spacing_nm": [], "poisson_ratio": []}
    studies = {"slopes": {"samples": 20}, "variants": variants}
    few = {"design": {"budget_beams": 20}, "studies": studies, "pairs": {"b": {"substrate": "B2"}}}
    narrow = {"beam": {"width_um": 6}, "devices": {"C1": {"width_um": 6, "uncertainty": stated}}}
    return stiction.load(CONFIG, few, narrow)


@pytest.mark.slow
def test_the_budget_is_that_of_its_stage_and_contacts(uncertain):
    found = stiction.Device.of(uncertain, "C1").budget(0.88)
    plan = Plan(uncertain)
    described = surface_datasets(plan, "B2")
    settings = typed(slope_contact.Settings, jobs.slope_contact(plan, "b"))

    def with_(quantity):
        return tuple(slope_contact.compute([described] * 2, "b", "B2", quantity, settings))

    def of(plain):
        return contact.compute([described] * 2, "b", "NG", typed(contact.Settings, plain))

    base, none = (
        jobs.contact(plan, "b"),
        jobs.device_choice_summits(plan, "b", 1500, 6000, "van_der_waals_none")["base"],
    )
    wanted = typed(inputs.Settings, jobs.budget(plan, "C1_rh088")["budget"])
    expected = budget.compute(
        of(base),
        {("B2", quantity): with_(quantity) for quantity in OF_MOMENTS},
        {
            name: tuple(of(jobs.solid_contact(plan, "b", 1500, 6000, name, side)) for side in ("less", "more"))
            for name in OF_SOLIDS
        },
        {"van_der_waals_none": of(base | {"contact": none["contact"], "van_der_waals": "none"})},
        inputs.covariances({"B2": described}, {}, wanted),
        wanted,
    )
    xr.testing.assert_identical(found, expected)
    solids = ["Young's modulus", "Poisson's ratio", "Hamaker constant"]
    assert list(found.input.values) == [*(f"{name} of B2" for name in OF_MOMENTS), "gap", *solids]


@pytest.mark.slow
def test_the_budget_of_the_tips_is_that_of_their_contacts(uncertain):
    found = stiction.Device.of(uncertain, "C1").tip_budget(0.88)
    plan, described = Plan(uncertain), surface_datasets(Plan(uncertain), "B2")
    patch = Designs(uncertain).tips("C1")
    tips, shifts = jobs.tip_contact(plan, *patch), typed(slope_contact.Settings, jobs.tip_contact(plan, *patch))

    def of(plain):
        return contact.compute([described] * 2, "b", "NG", typed(contact.Settings, plain))

    wanted = typed(inputs.Settings, jobs.tip_budget(plan, "C1_rh088")["budget"])
    expected = budget.compute(
        of(tips),
        {
            ("B2", quantity): tuple(slope_contact.compute([described] * 2, "b", "B2", quantity, shifts))
            for quantity in OF_MOMENTS
        },
        {
            name: tuple(of(jobs.tip_solid_contact(plan, *patch, name, side)) for side in ("less", "more"))
            for name in OF_SOLIDS
        },
        {"van_der_waals_none": of(tips | {"van_der_waals": "none"})},
        inputs.covariances({"B2": described}, {}, wanted),
        wanted,
    )
    xr.testing.assert_identical(found, expected)
    assert 0.4 < found.slope.sel(input="gap") < 0.8
    assert found.centre.attrs["response"] == "arc"


@pytest.mark.parametrize(("stated", "names"), [({"scan_um": 10}, ["B2", "Sub1"]), ({"gap_um": 0.1}, [])])
def test_a_budget_needs_the_errors_of_the_surfaces_with_uncertain_quantities_only(monkeypatch, stated, names):
    monkeypatch.setattr(contact, "compute", lambda *_: None)
    monkeypatch.setattr(stiction.Device, "_changed", ({}, {}, {}))
    monkeypatch.setattr(inputs, "covariances", lambda surfaces, *_: list(surfaces))
    monkeypatch.setattr(budget, "compute", lambda *given: given[4])
    config = stiction.load(CONFIG, {"devices": {"C1": {"uncertainty": stated}}})
    assert stiction.Device.of(config, "C1").budget(0.88) == names


@pytest.mark.parametrize(("strip", "length"), [({}, 1.5e-6), ({"strip_um": 3}, 3e-6)])
def test_contacts_of_a_budget_are_on_the_strips_of_the_device_and_choices_change_them(
    monkeypatch, uncertain, strip, length
):
    every = {"van_der_waals": [], "psd": [], "every": [2], "spacing_nm": [], "poisson_ratio": []}
    config = stiction.load(uncertain, {"devices": {"C1": strip}, "studies": {"variants": every}})
    asked = {"slopes": [], "choices": []}
    monkeypatch.setattr(contact, "compute", lambda *_: None)
    monkeypatch.setattr(variant_contact, "compute", lambda found, _: found)
    monkeypatch.setattr(slope_contact, "compute", lambda *given: asked["slopes"].append(given[-1]) or (None, None))
    monkeypatch.setattr(summits, "compute", lambda *given: asked["choices"].append(given[2:4]))
    stiction.Device.of(config, "C1")._changed  # noqa: B018
    assert [settings.sampling.strip_length for settings in asked["slopes"]] == pytest.approx([length] * 3)
    ((base, changed),) = asked["choices"]
    assert base.sampling.strip_length == changed.sampling.strip_length == pytest.approx(length)
    assert (base.contact.every, changed.contact.every) == (1, 2)


def test_a_device_that_does_not_exist_is_refused_with_those_that_do():
    with pytest.raises(ValueError, match="no device C9; the configuration has C1, R1, S1"):
        stiction.Device.of(CONFIG, "C9")


@pytest.mark.parametrize(
    ("name", "ask", "message"),
    [
        ("S1", lambda device: device.safe_lengths(0.5), "S1 is a stopper; only a cantilever or bridge has this"),
        ("S1", lambda device: device.chart(0.5), "S1 is a stopper"),
        ("C1", lambda device: device.forces(), "C1 is a cantilever; only a stopper has this"),
        ("R1", lambda device: device.chart(0.5), "R1 has no chart: state devices.R1.chart"),
        ("C1", lambda device: device.budget(0.5), "C1 has no uncertainty: state devices.C1.uncertainty"),
    ],
)
def test_what_a_device_does_not_have_is_refused_by_name(name, ask, message):
    with pytest.raises(ValueError, match=message):
        ask(stiction.Device(name, None, None, CONFIG, []))
