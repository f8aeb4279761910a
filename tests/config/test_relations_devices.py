"""Devices and materials in a configuration: their keys, the relations between them, and what is computed for them."""

import functools
import json
import subprocess
import sys
from dataclasses import MISSING, fields, replace

import numpy as np
import pytest
from configurations import PAPER, changed, problems
from plans import job_settings

from stiction.config.files import load
from stiction.config.kinds import KEYS
from stiction.config.memory import field_memory
from stiction.config.merging import merged
from stiction.config.messages import ConfigError
from stiction.config.test_beams import counts_as_devices
from stiction.config.units import in_si
from stiction.config.validation import normalised
from stiction.contact.environment import Water
from stiction.contact.meniscus import meniscus_height
from stiction.contact.tilt import length_of_edge
from stiction.plan import memory
from stiction.plan.devices import MOST_POINTS, DevicePlan
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.stages.beams import pair_warnings
from stiction.stages.beams.cantilevers import Cantilevers, cantilever, sections
from stiction.stages.contact import contact
from stiction.stages.devices import chart, cracks, device_warnings, ground, safe_lengths

C1 = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.67, 0.44]}
R1 = {"kind": "bridge", "pair": "b", "thickness_um": 2, "gap_um": 2, "width_um": 30, "residual_stress_MPa": 50}
S1 = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "restoring_force_uN": 20, "humidities": [0.44, 0.9]}
PROBE = {
    "kind": "probe",
    "pair": "b",
    "radius_um": 10,
    "measured_nN": 80,
    "measured_error_nN": 30,
    "humidities": [0.67],
}
CHART = {"thicknesses_um": [2.0, 2.6], "gaps_um": [10, 20], "humidities": [0.4, 0.9]}
GOLD = {"young_modulus_GPa": 79, "poisson_ratio": 0.42, "hardness_GPa": 1.2, "contact_angle_deg": 60}
GOLD |= {"hamaker_constant_zJ": {"water": 250, "dry": 400}, "density_kg_per_m3": 19300}
UNCERTAIN = {"thickness_um": 0.05, "gap_um": 0.2, "young_modulus_GPa": 4, "humidity": 0.01, "scan_um": 10}
UNCERTAIN |= {"temperature_K": 1, "contact_angle_deg": 5, "poisson_ratio": 0.02, "hamaker_constant_zJ": 20}
DIMPLES = {"number": 4, "at_um": [200], "height_um": 1, "contact_um": [2, 2]}
UNCERTAIN |= {"adsorbed_nm": 0.1}
DEVICES = {
    "C1": C1 | {"chart": CHART, "dimples": DIMPLES, "strip_um": 1.2, "length_um": 300, "uncertainty": UNCERTAIN},
    "R1": R1 | {"humidities": [0.67], "uncertainty": {"residual_stress_MPa": 5}},
    "S1": S1,
    "S2": {
        "kind": "stopper",
        "pair": "b",
        "contact_um": [4, 4],
        "stiffness_N_per_m": 2,
        "gap_um": 1.5,
        "humidities": [0],
        "mass_ng": 50,
        "electrode": {"area_um2": 10000, "gap_um": 3},
        "touchdowns": 1000,
        "voltage_V": 5,
        "offset_V": 0.3,
        "dielectric": {"thickness_nm": 100, "permittivity": 3.9},
        "tilt_deg": [0, 0.1],
    },
    "P1": PROBE | {"flat_um": 1},
}
ALL = merged(PAPER, {"devices": DEVICES, "materials": {"Gold": GOLD}, "surfaces": {"B2": {"material": "Gold"}}})


def with_device(**keys):
    """The paper's configuration with device C1 under changes."""
    return merged(PAPER, {"devices": {"C1": C1 | keys}})


def plan(**changes):
    return Plan(load({"devices": {"C1": C1, "R1": R1 | {"humidities": [0.67]}}}, changes))


WRONG_PROBES = [
    ({"radius_um": 0.02}, {}, "P.radius_um", "sampling.spacing_nm at most 1.3: the grid has 3.3 points in the water"),
    ({"humidities": [0.99]}, {}, "P.pair", "6 times the rms of both surfaces are 124 nm, more than the 100 nm"),
    ({"humidities": [0.6, 0.7]}, {}, "P.humidities", "must be the one of measured_nN"),
    ({"tilt_deg": [0.1]}, {}, "P.kind", "must come without tilt_deg"),
    ({"contact_um": [2.005, 2]}, {}, "P.contact_um", "whole number of contact points"),
    ({}, PROBE | {"radius_um": 10.001}, "Q.contact_um", "must differ from the area of P"),
    ({}, S1 | {"contact_um": [2.83, 2.83]}, "P.contact_um", "must differ from the area of Q"),
]


@pytest.mark.parametrize(("keys", "other", "key", "words"), WRONG_PROBES)
def test_probes_that_the_grid_or_their_patch_cannot_represent_are_refused(keys, other, key, words):
    devices = {"P": PROBE | keys} | ({"Q": other} if other else {})
    (line,) = problems(merged(PAPER, {"devices": devices}))
    assert str(line).startswith(f"devices.{key} is")
    assert words in str(line)


GROWN = {"humidities": [0.3, 0.75], "thickness_nm": [0.8, 1.2]}


@pytest.mark.parametrize(
    ("keys", "key", "words"),
    [
        ({"humidities": [0.75, 0.3]}, "humidities", "must be in increasing order"),
        ({"thickness_nm": [0.8]}, "thickness_nm", "must have 2 values, one for each humidity"),
        ({"thickness_nm": [0.8, 0.2]}, "thickness_nm", "must not fall with the humidity"),
    ],
)
def test_isotherms_that_shrink_or_have_holes_are_refused(keys, key, words):
    (line,) = problems(merged(PAPER, {"water": {"isotherm": GROWN | keys}}))
    assert str(line).startswith(f"water.isotherm.{key} is")
    assert words in str(line)


def test_films_of_an_isotherm_widen_the_least_gap_and_reach_of_tips_and_reach_the_water_of_jobs():
    narrow = {"devices": {"C1": C1 | {"gap_um": 0.27, "humidities": [0.9]}}, "water": {"isotherm": GROWN}}
    assert "20 times the sum of the height of the water film, 12" in str(problems(merged(PAPER, narrow))[0])
    assert problems(merged(PAPER, narrow | {"water": {}})) == ()
    grown, plain = (Plan(load({"devices": {"C1": C1}}, {"water": water})) for water in ({"isotherm": GROWN}, {}))
    assert grown.devices.tips("C1").length > plain.devices.tips("C1").length
    assert grown.air_of_devices.water("b")["isotherm"] == GROWN
    assert "isotherm" not in plain.air_of_devices.water("b")


def test_probes_beside_others_have_the_area_that_they_attract():
    devices = {
        "P": PROBE,
        "Fine": PROBE | {"radius_um": 12},
        "Own": PROBE | {"radius_um": 10.001, "contact_um": [3, 2]},
    }
    found = load({"devices": devices | {"S1": S1}})["devices"]
    assert [found[name]["contact_um"] for name in devices] == [[2.83, 2.83], [3.1, 3.1], [3, 2]]


def test_devices_and_materials_with_all_their_keys_are_valid():
    assert problems(ALL) == ()
    assert set(KEYS) <= {key for section in DEVICES.values() for key in section}


LONG, ROUGH = {"share": 0.001, "length_um": 300}, {"surface": "B2", "rms_nm": [1, 8]}


def with_roughness(**keys):
    """Keys of a device over a roughness under changes."""
    return {"requirement": LONG, "roughness": ROUGH | keys}


WRONG = [
    ({"humidities": [0.67, 0.02]}, "devices.C1.humidities", "must be at least 0.0245: in drier air"),
    ({"chart": CHART | {"humidities": [0.1, 0.9]}}, "devices.C1.chart.humidities", "must be at least 0.2903"),
    (
        {"humidities": [0.3], "uncertainty": {"humidity": 0.02}},
        "devices.C1.uncertainty.humidity",
        "must leave water that is a liquid: the humidity, 0.28, must be at least 0.2903",
    ),
    (
        {"humidities": [0.291], "uncertainty": {"temperature_K": 5}},
        "devices.C1.uncertainty.temperature_K",
        "the humidity, 0.291, must be at least 0.2",
    ),
    (
        {"humidities": [0.291], "uncertainty": {"contact_angle_deg": 20}},
        "devices.C1.uncertainty.contact_angle_deg",
        "contact angles of 20 and 20 degrees",
    ),
    ({"kind": "bridge"}, "devices.C1.kind", "must come with residual_stress_MPa"),
    (
        {"kind": "bridge", "residual_stress_MPa": 100000},
        "devices.C1.residual_stress_MPa",
        "at most 5000: tensile stress in a bridge, below the strength of its film",
    ),
    ({"residual_stress_MPa": 5}, "devices.C1.kind", "must come without residual_stress_MPa"),
    ({"restoring_force_uN": 5, "contact_um": [1, 1]}, "devices.C1.kind", "without contact_um, restoring_force_uN"),
    ({"kind": "plate"}, "devices.C1.kind", "one of cantilever, bridge"),
    ({"pair": "d"}, "devices.C1.pair", "must be one of a, b, c"),
    ({"humidities": [0.6, 0.6]}, "devices.C1.humidities", "listed twice"),
    ({"humidities": [0.65001]}, "devices.C1.humidities", "at most 4 decimals"),
    ({"gap_um": 0.1}, "devices.C1.gap_um", "20 times the sum of the height of the water film"),
    ({"humidities": [0.9999]}, "devices.C1.gap_um", "must be at least 207.9"),
    ({"strip_um": 1.505}, "devices.C1.strip_um", "whole number of contact points"),
    ({"width_um": 30.005}, "devices.C1.width_um", "whole number of contact points"),
    ({"width_um": 9000}, "devices.C1.width_um", "within 8 GB of memory: 2.5 x 9001 µm every 10 nm take 13.9 GB"),
    ({"chart": CHART | {"humidities": [0.9, 0.4]}}, "devices.C1.chart.humidities", "in increasing order"),
    ({"chart": CHART | {"humidities": [0.4, 0.56 + 0.02]}}, "devices.C1.chart.humidities", "at most 4 decimals"),
    ({"chart": CHART | {"thicknesses_um": [2, 2]}}, "devices.C1.chart.thicknesses_um", "each value once"),
    ({"chart": CHART | {"gaps_um": [0.1, 20]}}, "devices.C1.chart.gaps_um", "20 times the sum of the height"),
    ({"uncertainty": {"gap_um": -1}}, "devices.C1.uncertainty.gap_um", "at least 0"),
    ({"uncertainty": {"temperature_K": 80}}, "devices.C1.uncertainty.temperature_K", "between 273 and 373 K"),
    (
        {"requirement": {"share": 0.001, "length_um": 300}},
        "devices.C1.requirement",
        "must come with roughness or process; design.shares has the fractions of all answers",
    ),
    (
        {"requirement": {"share": 0.1}, "roughness": ROUGH},
        "devices.C1.requirement.share",
        "at least 1e-06 and at most 0.05: allowed fraction of stuck devices",
    ),
    ({"requirement": {"share": 0.001}, "roughness": ROUGH}, "devices.C1.requirement", "must come with length_um"),
    ({"length_um": 0.3}, "devices.C1.length_um", "must be in µm, above the thickness and the gap of the beam (given"),
    (
        {"length_um": 310, "requirement": LONG, "roughness": ROUGH},
        "devices.C1.length_um",
        "the length that is required",
    ),
    ({"roughness": ROUGH}, "devices.C1.roughness", "must come with requirement"),
    (
        {"requirement": LONG, "roughness": {"surface": "B2"}},
        "devices.C1.roughness",
        "must have one or two of rms_nm, skewness, corner_rad_per_um, coherence, play_nm, and has none",
    ),
    (
        with_roughness(skewness=[-1, 0], corner_rad_per_um=[12, 24]),
        "devices.C1.roughness",
        "play_nm, and has rms_nm, skewness, corner_rad_per_um",
    ),
    (with_roughness(skewness=[0, -1]), "devices.C1.roughness.skewness", "must be in increasing order"),
    (with_roughness(skewness=[-3, 0]), "devices.C1.roughness.skewness", "must have densities at both ends: at -3"),
    (with_roughness(surface="B1"), "devices.C1.roughness.surface", "must be a surface of pair b, B2 or Sub1"),
    (with_roughness(surface="B9"), "devices.C1.roughness.surface", "must be a surface of pair b, B2 or Sub1"),
    (with_roughness(rms_nm=[8, 1]), "devices.C1.roughness.rms_nm", "must be in increasing order"),
    (with_roughness(rms_nm=[1, 8000]), "devices.C1.roughness.rms_nm[1]", "at most 1000: standard deviation"),
    (with_roughness(rms_nm=[1]), "devices.C1.roughness.rms_nm", "2 entries"),
    (
        with_roughness(rms_nm=3),
        "devices.C1.roughness.rms_nm",
        "range of the rms [nm]; both ends are wanted",
    ),
    (with_roughness(skewness=-1), "devices.C1.roughness.skewness", "both ends are wanted, as in [-1, 0]"),
    (
        {"requirement": LONG, "roughness": {"surface": "B2", "skewness": [-3, 0]}},
        "devices.C1.roughness.skewness",
        "must have densities at both ends: at -3 the kurtosis of B2 must be above skewness² + 1 = 10",
    ),
    (
        {"requirement": LONG, "roughness": {"surface": "B2", "corner_rad_per_um": [9, 130]}},
        "devices.C1.roughness.corner_rad_per_um",
        "must be below the cut-off of surface B2, 125 rad/µm",
    ),
    (
        {"requirement": LONG, "roughness": {"surface": "B2", "corner_rad_per_um": [3, 20]}},
        "devices.C1.roughness.corner_rad_per_um",
        "must be larger at 3 rad/µm, where sampling.margin_um must be above the correlation length",
    ),
    (
        {"gap_um": 0.5, "humidities": [0.44], "chart": {"thicknesses_um": [2, 2.6], "humidities": [0.44, 0.97]}},
        "devices.C1.gap_um",
        "20 times the sum of the height",
    ),
]


@pytest.mark.parametrize(("keys", "key", "message"), WRONG, ids=[str(row[0]) for row in WRONG])
def test_a_wrong_device_is_refused_by_name(keys, key, message):
    (line,) = problems(with_device(**keys))
    assert line.startswith(f"{key} is ")
    assert message in line


@pytest.mark.parametrize(
    ("keys", "key", "message"),
    [
        ({}, "dimples", "must come with length_um"),
        ({"length_um": 200}, "dimples.at_um", "must be below length_um of the beam"),
        ({"length_um": 300, "gap_um": 1}, "dimples.height_um", "must be below gap_um of the beam"),
        (
            {"width_um": 210, "length_um": 300, "dimples": DIMPLES | {"number": 101}},
            "dimples.number",
            "at most 1 / 50 of",
        ),
        ({"length_um": 300, "dimples": DIMPLES | {"number": 0}}, "dimples.number", "at least 1"),
        (
            {"width_um": 110, "length_um": 300, "dimples": DIMPLES | {"number": 51, "at_um": [9, 200]}},
            "dimples.number",
            "at most 1 / 100",
        ),
        ({"length_um": 300, "dimples": DIMPLES | {"at_um": [200, 200]}}, "dimples.at_um", "in increasing order"),
        ({"length_um": 300, "dimples": DIMPLES | {"at_um": 200}}, "dimples.at_um", "[200]"),
        ({"length_um": 300, "dimples": DIMPLES | {"at_um": [20, 300]}}, "dimples.at_um", "must be below length_um"),
        (
            {"width_um": 200, "length_um": 300, "dimples": DIMPLES | {"number": 1, "contact_um": [200, 200]}},
            "dimples.contact_um",
            "memory",
        ),
    ],
)
def test_dimples_are_refused_by_name(keys, key, message):
    (line,) = problems(with_device(**{"dimples": DIMPLES} | keys))
    assert line.startswith(f"devices.C1.{key} is ")
    assert message in line


def test_a_stopper_has_no_length():
    (line,) = problems(merged(PAPER, {"devices": {"S1": S1 | with_roughness()}}))
    assert line.startswith("devices.S1.requirement is ")
    assert "must come without length_um, for a stopper has a force" in line


@pytest.mark.parametrize(
    ("keys", "key", "message"),
    [
        ({"electrode": {"area_um2": 1e4, "gap_um": 3}}, "electrode", "must come with stiffness_N_per_m and gap_um"),
        ({"electrode": {"area_um2": 1e4}}, "electrode.gap_um", "is missing, must be a number at least 0.001"),
        ({"mass_ng": 0}, "mass_ng", "above 0"),
        ({"touchdowns": 0}, "touchdowns", "at least 1"),
        ({"touchdowns": 2.5}, "touchdowns", "must be a whole number"),
        ({"tilt_deg": 0.1}, "tilt_deg", "must be a list with 1 or 2 entries"),
        ({"tilt_deg": 0.1}, "tilt_deg", "write [0.1]"),
        ({"tilt_deg": []}, "tilt_deg", "must be a list with 1 or 2 entries"),
        ({"tilt_deg": [0.2, 0.1]}, "tilt_deg", "must be in increasing order"),
        ({"tilt_deg": [-0.1]}, "tilt_deg[0]", "at least 0"),
        ({"voltage_V": 5}, "voltage_V", "must come with dielectric: {thickness_nm, permittivity}"),
        ({"dielectric": {"thickness_nm": 9, "permittivity": 4}}, "dielectric", "must come with voltage_V or offset_V"),
        ({"offset_V": 1, "dielectric": {"thickness_nm": 9}}, "dielectric.permittivity", "is missing"),
        ({"thickness_um": 2}, "kind", "must come without thickness_um"),
    ],
)
def test_what_moves_a_stopper_is_refused_by_name(keys, key, message):
    (line,) = problems(merged(PAPER, {"devices": {"S1": S1 | keys}}))
    assert line.startswith(f"devices.S1.{key} is ")
    assert message in line


def test_an_electrode_is_at_least_as_far_as_the_contact():
    stopper = DEVICES["S2"] | {"electrode": {"area_um2": 10000, "gap_um": 1}}
    (line,) = problems(merged(PAPER, {"devices": {"S2": stopper}}))
    assert line.startswith("devices.S2.electrode.gap_um is 1, must be at least gap_um of the stopper")


@pytest.mark.parametrize(
    ("liquid", "key", "message"),
    [
        ({"contact_angle_deg": 30}, "surface_tension_mN_per_m", "is missing"),
        ({"surface_tension_mN_per_m": 0.018}, "surface_tension_mN_per_m", "write 18 if 0.018 is in N/m"),
        ({"surface_tension_mN_per_m": 22, "contact_angle_deg": 190}, "contact_angle_deg", "at least 0 and at most 180"),
    ],
)
def test_a_wrong_liquid_is_refused_by_name(liquid, key, message):
    (line,) = problems(merged(with_device(), {"liquids": {"Mine": liquid}}))
    assert line.startswith(f"liquids.Mine.{key} is ")
    assert message in line


def test_islands_are_refused_with_devices_alone():
    (line,) = problems(merged(with_device(), {"contact": {"asperity": "island"}}))
    assert line.startswith("contact.asperity is ")
    assert "must be summit, or the devices left out" in line
    assert not problems(merged(PAPER, {"contact": {"asperity": "island"}}))


@pytest.mark.parametrize(
    ("overlay", "key", "message"),
    [
        ("design: {tip_um: 0.05}", "design.tip_um", "no longer needed"),
        ("design: {tip_edge: sharp}", "design.tip_edge", "one of rounded, square"),
        ("design: {beams: 199}", "design.beams", "at least 200"),
        ("design: {shares: [0.06]}", "design.shares[0]", "at most 0.05"),
        ("design: {shares: [0.01, 0.010]}", "design.shares", "each value once; 0.01 is listed twice"),
        ("surfaces: {B2: {material: Gold}}", "surfaces.B2.material", "must be one of gold"),
        ("materials: {Gold: {hamaker_constant_zJ: {water: 250}}}", "materials.Gold.hamaker_constant_zJ.dry", "missing"),
    ],
)  # fmt: skip
def test_wrong_sizes_and_materials_are_refused_by_name(overlay, key, message):
    line = problems(changed(overlay))[0]
    assert line.startswith(f"{key} is ")
    assert message in line


@pytest.mark.parametrize(
    ("angles", "deviation", "refused"),
    [
        ((95, 80), 5, True),
        ((95, 80), 1, False),
        ((0, 0), 90, True),
        ((0, 0), 30, False),  # beyond, the film at RH 0.44 is thinner than three molecules
        ((0, 0), 89, True),
        ((170, 5), 2, False),
        ((170, 5), 20, True),
    ],
)
def test_uncertain_contact_angles_leave_water(angles, deviation, refused):
    named = {name: {"contact_angle_deg": angle} for name, angle in zip(("One", "Other"), angles, strict=True)}
    surfaces = {"B2": {"material": "One"}, "Sub1": {"material": "Other"}}
    config = merged(
        with_device(uncertainty={"contact_angle_deg": deviation}), {"materials": named, "surfaces": surfaces}
    )
    found = [line for line in problems(config) if "uncertainty" in line]
    assert len(found) == refused
    assert all(line.startswith("devices.C1.uncertainty.contact_angle_deg is ") for line in found)


@pytest.mark.parametrize(
    ("key", "deviation", "changes", "value"),
    [
        ("young_modulus_GPa", 79, {}, "79 GPa"),
        ("young_modulus_GPa", 78, {}, None),
        ("young_modulus_GPa", 79, {"surfaces": {"B2": {"material": "Other"}}}, None),
        ("poisson_ratio", 0.01, {}, None),
        ("poisson_ratio", 0.09, {}, "0.42 ± 0.09"),
        ("poisson_ratio", 0.01, {"materials": {"Gold": {"poisson_ratio": 0.46}}}, "0.46 ± 0.05"),
        ("poisson_ratio", 0.01, {"materials": {"Gold": {"poisson_ratio": -0.96}}}, "-0.96 ± 0.05"),
        ("poisson_ratio", 0, {"materials": {"Gold": {"poisson_ratio": 0.46}}}, None),
        ("hamaker_constant_zJ", 250, {}, "250 zJ"),
        ("hamaker_constant_zJ", 250, {"van_der_waals": "dry"}, None),
        ("hamaker_constant_zJ", 250, {"van_der_waals": "none"}, None),
        ("hamaker_constant_zJ", 100, {"surfaces": {"B2": {"material": "Other"}}}, "97.5 zJ"),
    ],
)
def test_an_uncertain_property_of_the_material_of_the_beam_stays_possible(key, deviation, changes, value):
    named = {"materials": {"Gold": GOLD, "Other": {"hardness_GPa": 9}}, "surfaces": {"B2": {"material": "Gold"}}}
    config = functools.reduce(merged, (named, changes), with_device(uncertainty={key: deviation}))
    found = [line for line in problems(config) if "uncertainty" in line]
    assert len(found) == (value is not None)
    assert all(line.startswith(f"devices.C1.uncertainty.{key} is ") and value in line for line in found)


@pytest.mark.parametrize(
    ("temperature", "deviation", "refused"), [(300, 27, 0), (300, 28, 1), (360, 13, 0), (360, 14, 1)]
)
def test_uncertain_temperatures_are_those_of_liquid_water(temperature, deviation, refused):
    config = merged(with_device(uncertainty={"temperature_K": deviation}), {"water": {"temperature_K": temperature}})
    assert len([line for line in problems(config) if "uncertainty.temperature_K is" in line]) == refused


def test_the_gap_of_a_device_does_not_matter_for_a_chart_of_other_gaps():
    near = with_device(gap_um=0.5, humidities=[0.44], chart={"thicknesses_um": [2, 2.6], "humidities": [0.44, 0.97]})
    assert [line.split(" is ")[0] for line in problems(near)] == ["devices.C1.gap_um"]
    assert problems(merged(near, {"devices": {"C1": {"chart": {"gaps_um": [10, 20]}}}})) == ()


def test_the_patch_of_a_stopper_is_whole_on_the_grid():
    (line,) = problems(merged(PAPER, {"devices": {"S1": S1 | {"contact_um": [3, 3.005]}}}))
    assert line.startswith("devices.S1.contact_um is [3, 3.005], must be a whole number of contact points")


def test_water_that_does_not_wet_makes_the_film_lower():
    other = {"materials": {"Plain": {"contact_angle_deg": 80}}, "surfaces": {"B2": {"material": "Plain"}}}
    low = with_device(gap_um=0.25, humidities=[0.92])
    assert any(line.startswith("devices.C1.gap_um") for line in problems(low))
    assert not any(line.startswith("devices.C1.gap_um") for line in problems(merged(low, other)))


# Names


def test_the_normal_form_sorts_the_humidities_of_devices():
    assert normalised(with_device())["devices"]["C1"]["humidities"] == [0.44, 0.67]
    assert "devices" not in load()


def test_a_configuration_without_devices_has_no_cases():
    none = DevicePlan(load())
    assert (none.cases, none.with_chart, none.pressed_pairs) == ([], [], [])


def test_cases_are_beams_at_their_humidities():
    devices = DevicePlan(load({"devices": DEVICES}))
    assert devices.cases == ["C1_rh044", "C1_rh067", "R1_rh067"]
    assert devices.stoppers == ["P1", "S1", "S2"]
    assert devices.with_chart == ["C1"]
    assert devices.pressed_pairs == ["b"]
    other = {"pairs": {"d": PAPER["pairs"]["b"]}, "devices": {"C1": C1 | {"pair": "d"}}}
    assert DevicePlan(load(other)).pressed_pairs == []


def test_strips_equal_to_those_of_the_main_line_share_their_contact():
    devices = DevicePlan(load({"devices": {"C1": C1, "C2": C1 | {"width_um": 20}, "C3": C1 | {"strip_um": 1.2}}}))
    assert [devices.has_strips_of_pair(name) for name in ("C1", "C2", "C3")] == [True, False, False]
    assert devices.ground("C2").name == "b_1500x20000"
    assert devices.ground("C3").name == "b_1200x30000"


def test_the_strip_of_a_tip_holds_its_edge_the_wedge_of_the_flattest_beam_and_its_film():
    devices = DevicePlan(load({"devices": {"C1": C1, "C2": C1 | {"width_um": 20}, "C3": C1 | {"gap_um": 5}}}))
    for name in ("C1", "C2", "C3"):
        tips = devices.tips(name)
        tilt = devices.tilt(tips)
        flattest, steepest = tilt["slopes"][0], tilt["slopes"][-1]
        before = 10 * round(length_of_edge(100, tilt["reach_nm"], steepest) / 10)  # on the grid
        assert before >= 50
        assert 0 <= (tips.length - before) * flattest - tilt["reach_nm"] < 10 * flattest + 0.1
        film = float(meniscus_height(max(C1["humidities"]), 300))
        assert 1e9 * film + 3 * np.hypot(3.4, 0.17) <= tilt["reach_nm"] < 1.2 * (1e9 * film + 10.3)
    assert devices.tips("C1") == devices.tips("C2")._replace(width=30000)
    assert devices.tips("C3").length > 1.5 * devices.tips("C1").length


def test_a_square_edge_has_no_radius_and_a_rounder_edge_a_longer_strip():
    rounder, square, sharp = (
        DevicePlan(load({"devices": {"C1": C1}, "design": design}))
        for design in ({"edge_radius_um": 1}, {"tip_edge": "square"}, {"edge_radius_um": 0})
    )
    radii = [plan.tilt(plan.tips("C1"))["radius_um"] for plan in (rounder, square, sharp)]
    assert radii == [plan.edge_radius("C1") for plan in (rounder, square, sharp)] == [1, 0, 0]
    assert rounder.tips("C1").length > square.tips("C1").length == sharp.tips("C1").length


def test_each_device_with_an_uncertain_edge_that_it_cannot_have_is_told_why():
    stated = {"uncertainty": {"edge_radius_um": 0.2}}
    with pytest.raises(ConfigError) as caught:
        load({"devices": {"A1": S1 | stated, "C1": C1 | stated}})
    assert "devices.A1.uncertainty.edge_radius_um" in str(caught.value)
    assert "must be below the radius itself (given design.edge_radius_um = 0.1)" in str(caught.value)
    assert str(caught.value).count("devices.A1.kind") == 1


def test_devices_of_other_kinds_share_test_beams_with_a_cantilever_whose_edge_is_uncertain():
    array = {"pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30}
    array |= {"stuck": [{"humidity": 0.67, "length_um": 300, "stuck": 3, "of": 20}]}
    round_edge = C1 | {"test_beams": ["A"], "uncertainty": {"humidity": 0.01, "edge_radius_um": 0.03}}
    stopper = S1 | {"test_beams": ["A"], "uncertainty": {"humidity": 0.01}}
    config = load({"test_beams": {"A": array}, "devices": {"S1": stopper, "C1": round_edge}})
    assert counts_as_devices(config)["A"]["uncertainty"] == round_edge["uncertainty"]
    other = round_edge | {"uncertainty": {"humidity": 0.01}}
    with pytest.raises(ConfigError, match="which states other uncertainties"):
        load({"test_beams": {"A": array}, "devices": {"C2": other, "C1": round_edge}})


def test_all_tips_of_a_pair_have_the_slopes_of_both_ends_the_least_width_and_the_largest_reach():
    wide = C1 | {"width_um": 50, "gap_um": 5, "humidities": [0.9]}
    devices = DevicePlan(load({"devices": {"C1": C1, "C2": wide}}))
    both = [devices.tilt(devices.tips(name)) for name in ("C1", "C2")]
    found = devices.all_tips("b")
    slopes = [slope for tilt in both for slope in tilt["slopes"]]
    assert found["tilt"]["slopes"][::2] == [min(slopes), max(slopes)]
    assert found["tilt"]["slopes"][1] == pytest.approx(np.sqrt(min(slopes) * max(slopes)), rel=1e-4)
    assert found["tilt"]["reach_nm"] == max(tilt["reach_nm"] for tilt in both)
    assert found["beam"] == {"width_um": min(C1["width_um"], 50)}
    assert devices.has_tips("b")
    assert not devices.has_tips("a")
    with pytest.raises(KeyError, match="no device has tips on pair a"):
        devices.all_tips("a")


@pytest.mark.parametrize(
    ("changed", "width"), [({}, 30), ({"sampling": {"spacing_nm": 2}}, None), ({"B2": 100}, None), ({"B2": 500}, 2)]
)
def test_strips_for_tips_have_a_bounded_number_of_points(changed, width):
    rms = {"surfaces": {"B2": {"rms_nm": changed.pop("B2")}}} if "B2" in changed else {}
    found = DevicePlan(load({"devices": {"C1": C1}} | rms | changed)).all_tips("b")
    spacing = changed.get("sampling", {"spacing_nm": 10})["spacing_nm"] / 1000
    tilt, of_strips = found["tilt"], found["beam"]["width_um"]
    points = tilt["reach_nm"] / 1000 / tilt["slopes"][0] * of_strips / spacing**2
    assert points <= 1.01 * MOST_POINTS or of_strips == 2
    assert of_strips == (width or pytest.approx(of_strips * MOST_POINTS / points, rel=0.01))


def test_tips_reach_into_adsorbed_films_as_well():
    thin, thick, dry = (
        DevicePlan(load({"water": {"adsorbed_nm": added}, "devices": {"C1": C1 | {"humidities": [humidity]}}}))
        for added, humidity in ((0, 0.67), (4, 0.67), (4, 0))
    )
    reach, higher, without = (plan.tilt(plan.tips("C1"))["reach_nm"] for plan in (thin, thick, dry))
    film = 1e9 * float(meniscus_height(0.67, 300))
    assert film + 4 + 10.2 <= higher < 1.2 * (film + 4 + 10.3)
    assert without < reach < higher


def test_tips_reach_into_the_film_of_the_wettest_air_of_a_device_and_its_chart():
    for humidities, more, wettest in (([0.44, 0.95], {}, 0.95), ([0.44], {"chart": CHART}, 0.9)):
        devices = DevicePlan(load({"devices": {"C1": C1 | {"humidities": humidities} | more}}))
        film = 1e9 * float(meniscus_height(wettest, 300))
        assert film + 10.2 <= devices.tilt(devices.tips("C1"))["reach_nm"] < 1.2 * (film + 10.3)


def test_slopes_of_tips_cover_charts_and_devices_share_strips_of_one_length():
    alone, charted = (
        DevicePlan(load({"devices": {"C1": C1 | chart}}))
        for chart in ({}, {"chart": CHART | {"thicknesses_um": [2, 6]}})
    )
    few, many = (found.tilt(found.tips("C1"))["slopes"] for found in (alone, charted))
    assert set(few) < set(many)
    assert many[0] < few[0] / 1.6
    both = DevicePlan(load({"devices": {"C1": C1, "C2": C1 | {"thickness_um": 2.59}}}))
    assert both.tips("C1") == both.tips("C2")
    assert both.tilt(both.tips("C1"))["edge"] == "rounded"
    assert set(both.tilt(both.tips("C1"))["slopes"]) >= set(few)


def test_the_axis_of_a_chart_has_names_and_ends():
    devices = DevicePlan(load({"devices": DEVICES, "design": {"chart_points": 8}}))
    axis = devices.axis("C1")
    own = [humidity for humidity in DEVICES["C1"]["humidities"] if 0.4 < humidity < 0.9]
    assert own
    assert set(own) < set(axis), "so that a chart has the lengths of its device"
    assert (axis[0], axis[-1], len({*axis} - {*own})) == (0.4, 0.9, 8)
    assert devices.chart_cases("C1")[2] == "C1_rh04714"


# Settings


PLAN = Plan(normalised(ALL))
JOBS = {
    cracks: job_settings(PLAN, "devices/cracks/C1_rh067"),
    ground: job_settings(PLAN, Graph(PLAN).job("devices/cracks/C1_rh067").inputs["ground"]),
    safe_lengths: job_settings(PLAN, "devices/safe_lengths/R1_rh067"),
    chart: job_settings(PLAN, "devices/chart/C1_rh067"),
    contact: job_settings(
        PLAN,
        f"devices/contact/tips/{DevicePlan(PLAN.config).tips('C1').name}",
    ),
}


@pytest.mark.parametrize("stage", JOBS, ids=lambda stage: stage.__name__)
def test_a_stage_takes_exactly_the_settings_of_its_jobs(stage):
    settings = JOBS[stage]
    found = in_si(stage.Settings, settings)
    optional = {field.name for field in fields(found) if not field.default is field.default_factory is MISSING}
    assert set(vars(found)) - optional <= {key.removesuffix("_um") for key in settings}
    assert json.loads(json.dumps(settings)) == settings


def test_settings_in_si_are_those_of_the_device():
    found = in_si(cracks.Settings, JOBS[cracks])
    assert found.device.beam.young_modulus == pytest.approx(79e9)
    assert (found.device.thickness, found.device.strip) == pytest.approx((2.6e-6, 1.2e-6))
    laws = in_si(ground.Settings, JOBS[ground])
    assert (laws.strip, laws.humidity) == (found.device.strip, 0.67)
    assert replace(laws.water, gaps=None) == Water(300, pytest.approx((1.0471975512, 0.0)))
    assert laws.water.gaps.wavelength == pytest.approx(100e-9)
    bridge = in_si(safe_lengths.Settings, JOBS[safe_lengths])
    assert bridge.device.beam.tension == pytest.approx(50e6 * 60e-12)
    assert in_si(chart.Settings, JOBS[chart]).gaps == pytest.approx((10e-6, 20e-6))
    assert job_settings(
        plan(devices={"C1": {"chart": {"thicknesses_um": [2], "humidities": [0.4, 0.5]}}}), "devices/chart/C1_rh045"
    )["gaps_um"] == [20]


def test_materials_reach_contact_forces_and_beams_and_nothing_changes_without_them():
    found = in_si(contact.Settings, JOBS[contact])
    assert found.sampling.strip_length == pytest.approx(1e-9 * DevicePlan(PLAN.config).tips("C1").length)
    assert found.contact.samples == PAPER["design"]["beams"]
    assert found.materials["beam"].hamaker_constant == pytest.approx({"water": 2.5e-19, "dry": 4e-19})
    assert found.materials["substrate"].young_modulus == pytest.approx(164e9)
    assert cantilever(in_si(Cantilevers, sections(PLAN, "b")), "b").young_modulus == pytest.approx(79e9)
    paper = Plan(load())
    assert "materials" not in job_settings(paper, "contact/b_NG")
    assert job_settings(paper, "forces/b_rh067_NG") == {"water": {"temperature_K": 300}, "humidity": 0.67}
    assert sections(paper, "b")["pairs"] == {"b": {"gap_um": 20}}


def test_each_property_of_a_material_affects_only_its_stages():
    def with_gold(**properties):
        return Plan(load({"materials": {"Gold": properties}, "surfaces": {"Sub1": {"material": "Gold"}}}))

    bare, paper = with_gold(hardness_GPa=1.0), Plan(load())
    wet = with_gold(contact_angle_deg=30)
    assert (
        job_settings(bare, "contact/b_NG") == job_settings(wet, "contact/b_NG") == job_settings(paper, "contact/b_NG")
    )
    assert (
        job_settings(bare, "studies/plasticity/b")
        != job_settings(paper, "studies/plasticity/b")
        == job_settings(wet, "studies/plasticity/b")
    )
    assert job_settings(wet, "forces/b_rh067_NG")["water"]["contact_angles_deg"] == [0, 30]
    assert job_settings(wet, "forces/c_rh065_NG") == job_settings(paper, "forces/c_rh065_NG")
    assert job_settings(with_gold(young_modulus_GPa=79), "contact/b_NG") != job_settings(paper, "contact/b_NG")


def test_the_uncertainty_of_a_device_is_no_setting_of_its_cracks():
    assert "uncertainty" not in json.dumps([*JOBS.values(), job_settings(PLAN, "devices/warnings/C1.json")])


def test_warnings_know_what_is_stated_of_a_material():
    found = in_si(device_warnings.OfDevice, job_settings(PLAN, "devices/warnings/C1.json")["beam"])
    assert [name for name, _ in found.materials] == ["Gold"]
    assert len(found.materials[0][1]) == 5
    assert in_si(
        pair_warnings.OfPairs, job_settings(PLAN, "warnings.md")["pairs"]
    ).sampling.strip_length == pytest.approx(1.5e-6)


def test_patches_of_devices_count_for_the_memory_of_jobs():
    wide = normalised(with_device(width_um=600))
    assert memory.job_memory(wide) == round(field_memory(2.5, 601, 10))
    stopper = normalised(merged(PAPER, {"devices": {"S1": S1 | {"contact_um": [30, 40]}}}))
    assert memory.job_memory(stopper) == round(field_memory(31, 41, 10))


def test_the_axis_of_the_worst_humidity_holds_no_air_that_is_too_dry_for_a_stopper():
    dry = {"design": {"worst_humidities": [0.2, 0.9]}}
    assert problems(merged(PAPER, dry)) == problems(merged(PAPER, dry | {"devices": {"C1": C1}})) == ()
    (line,) = problems(merged(PAPER, dry | {"devices": {"S1": S1}}))
    assert line.startswith("design.worst_humidities is [0.2, 0.9], must be at least 0.2903: in drier air")


def test_a_configuration_is_checked_for_devices_whatever_was_imported_before():
    code = "import json, sys; from stiction.config.validation import checked; checked(json.load(sys.stdin))"
    broken = json.dumps(with_device(pair="d"))
    run = subprocess.run([sys.executable, "-c", code], input=broken, text=True, capture_output=True, check=False)
    assert "devices.C1.pair is 'd', must be one of a, b, c" in run.stderr
