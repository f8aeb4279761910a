"""Life of a device beside its estimate: that of the stages of a life and of an answer, for the same file."""

import math

import numpy as np
import pytest
from drawn_answers import air, asked, lognormal
from plans import job_settings

from stiction.answer.data import Cause
from stiction.config.files import load
from stiction.config.units import in_si
from stiction.constants import FREE_FALL
from stiction.estimate.answer import answer
from stiction.estimate.length import Impossible, NotLearnt
from stiction.estimate.question import questions
from stiction.estimate.table import content, known
from stiction.life import touch
from stiction.plan.plan import Plan
from stiction.stages.answer import conditions
from stiction.stages.life import beams, stoppers
from stiction.stages.life.answers import Name, layout
from stiction.stages.life.inputs import BeamKeys, StopperKeys

LIQUIDS = {"Water": {"surface_tension_mN_per_m": 72}, "Hexane": {"surface_tension_mN_per_m": 18}}
LIQUIDS |= {"Wax": {"surface_tension_mN_per_m": 30, "contact_angle_deg": 100}}
C1 = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.67]}
OXIDE = {"thickness_nm": 100, "permittivity": 3.9}
NARROW = C1 | {"width_um": 9, "gap_um": 12, "thickness_um": 2, "length_um": 150, "voltage_V": 3, "dielectric": OXIDE}
R1 = C1 | {"kind": "bridge", "thickness_um": 2, "gap_um": 2, "residual_stress_MPa": 50, "length_um": 160}
TIGHT = R1 | {"residual_stress_MPa": 150, "gap_um": 3, "length_um": 220}
SPRING = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "stiffness_N_per_m": 75, "gap_um": 1, "mass_ng": 50}
SPRING |= {"humidities": [0.67], "electrode": {"area_um2": 10000, "gap_um": 2}}


def file_of(device, **sections):
    """File with one device."""
    return {"run": {"pairs": ["b"], "studies": []}, "liquids": LIQUIDS, "devices": {"D": device}} | sections


def estimated(device, **sections):
    """Estimate of one device."""
    return answer(questions(file_of(device, **sections), content())["D"], *known())


def keys_of(device, **sections):
    """Keys of the life of a run of one device."""
    ((release, settings),) = job_settings(Plan(load(file_of(device, **sections))), "devices/life/D").items()
    return in_si({"beam": BeamKeys, "stopper": StopperKeys}[release], settings)


def rows_by_name(rows):
    """Answers of a life by name."""
    return {row.name: row for row in rows}


@pytest.mark.parametrize("device", [C1, NARROW, R1, TIGHT])
def test_a_beam_dries_and_touches_as_in_the_life_of_a_run(device):
    estimate, keys = estimated(device), keys_of(device)
    for name in LIQUIDS:
        rows = rows_by_name(beams.lengths_after_drying(keys, name, keys.liquids[name]))
        collapse, released = rows[f"{Name.COLLAPSE}_{name}"], rows[f"{Name.RELEASED}_{name}"]
        dried = estimate.dried[name]
        expected = collapse.low, collapse.high, released.high
        np.testing.assert_allclose(dried.lengths, expected, rtol=1e-9)
        assert dried.is_released == (not math.isnan(released.low))
    touching = estimate.touching
    rows = rows_by_name(beams.beam_touched(keys, touching.size))
    assert rows[Name.SHOCK].low * (1 - 4e-4) < touching.shock < rows[Name.SHOCK].low * (1 + 1e-9)
    if "dielectric" in device:
        assert touching.voltage == pytest.approx(rows[Name.VOLTAGE].low, rel=1e-9)
    else:
        assert math.isnan(touching.voltage)
    if device["kind"] == "cantilever":
        assert touching.slow_shock == pytest.approx(rows[Name.SHOCK].high, rel=1e-9)


def test_example_devices_have_the_numbers_of_their_run():
    # runs/devices/results/tables/life.csv of examples/devices.yaml, whose liquids are water and isopropanol
    liquids = {"liquids": {"water": LIQUIDS["Water"], "isopropanol": {"surface_tension_mN_per_m": 21.7}}}
    lever = estimated(C1 | {"length_um": 219.3522087888716, "dielectric": OXIDE}, **liquids)
    bridge = estimated(R1 | {"length_um": 164.69616144184133}, **liquids)
    bump = estimated({key: SPRING[key] for key in ("kind", "pair", "contact_um", "mass_ng", "humidities")}
                     | {"restoring_force_uN": 20})  # fmt: skip
    computed = [1e6 * length for each in (lever, bridge) for dried in each.dried.values() for length in dried.lengths]
    expected = [199.255309285, 246.216439583, 234.084773309, 269.899135101, 332.303746292, 315.930354917]
    expected += [152.343836324, 180.520879631, 181.993063597, 222.962700921, 269.713677530, 257.298488024]
    np.testing.assert_allclose(computed, expected, rtol=1e-9)
    assert lever.touching.voltage == pytest.approx(420.741052017, rel=1e-9)
    shocks = [each.touching.shock / FREE_FALL for each in (lever, bridge, bump)]
    np.testing.assert_allclose(shocks, [153547.086617, 2199230.21819, 23063.9799373], rtol=1e-4)


@pytest.mark.parametrize("device", [C1, NARROW, R1, TIGHT])
def test_the_size_to_use_is_no_longer_than_that_of_a_run_with_its_liquids(device):
    estimate, keys = estimated(device), keys_of(device)
    rows = [row for name in LIQUIDS for row in beams.lengths_after_drying(keys, name, keys.liquids[name])]
    life = layout(rows, keys)
    least, most = estimate.chosen.intervals["90"]
    # Simulated devices stick near the upper end of the interval alone, so that the liquid decides in the run.
    slow = air(lognormal(np.random.default_rng(1), math.log(most), scatter=1e-3), humidity=0.67)
    run = asked([slow, *conditions.drying(life, LIQUIDS, [0.67])])
    assert run.build == pytest.approx(min(estimate.dried["Water"].stands, run.steps[0].size), rel=0.01)
    if estimate.dried["Water"].stands < least:
        assert run.stated_steps[-1].cause is Cause.DRYING
        assert estimate.drying == "Water"
        assert estimate.use == pytest.approx(run.build, rel=1e-9)
    else:
        assert estimate.drying is None
        assert estimate.use == least
    assert estimate.use <= run.build * (1 + 1e-9)
    dry = estimated(device, liquids={})
    assert (dry.use, dry.dried, dry.drying) == (least, {}, None), "the control: without a liquid"


def test_more_of_one_liquid_decides_and_a_harmless_one_never():
    assert estimated(C1).drying == "Water"
    assert estimated(C1, liquids={key: LIQUIDS[key] for key in ("Hexane", "Wax")}).drying is None
    assert estimated(C1, liquids={"Wax": LIQUIDS["Wax"]}).dried["Wax"].stands == math.inf


def test_a_stopper_touches_as_in_the_life_of_a_run():
    touching, rows = estimated(SPRING).touching, rows_by_name(stoppers.stopper_moved(keys_of(SPRING)))
    assert estimated(SPRING).dried == {}
    assert touching.shock == pytest.approx(rows[Name.SHOCK].low, rel=1e-9)
    assert touching.slow_shock == pytest.approx(rows[Name.SHOCK].high, rel=1e-9)
    assert touching.voltage == pytest.approx(rows[Name.VOLTAGE].low, rel=1e-4)
    light = {key: SPRING[key] for key in SPRING if key not in ("mass_ng", "electrode")}
    assert all(map(math.isnan, (estimated(light).touching.shock, estimated(light).touching.voltage)))
    weak = {key: SPRING[key] for key in ("kind", "pair", "contact_um", "mass_ng", "humidities")}
    assert estimated(weak).touching.shock == pytest.approx(estimated(weak).use / 50e-12 / touch.HALF_SINE, rel=1e-9)


@pytest.mark.parametrize(("way", "gap"), [(0.3, 3), (1, 3), (1.4, 2.5), (2.9, 3), (4, 3)])
def test_an_electrode_pulls_in_as_the_engine_says(way, gap):
    device = SPRING | {"gap_um": way, "electrode": {"area_um2": 5000, "gap_um": gap}}
    expected = touch.stopper_voltage_at_once(75.0, 1e-6 * way, 5e-9, 1e-6 * gap)
    assert estimated(device).touching.voltage == pytest.approx(expected, rel=1e-4)  # the engine nears an end by 1e-5


@pytest.mark.parametrize("device", [C1, R1, SPRING])
def test_a_shock_leaves_the_size_to_a_run_where_water_condenses(device):
    shaken = estimated(device | {"shock_g": 3000})
    assert shaken.is_fast
    assert math.isnan(shaken.use)
    assert not estimated(device).is_fast
    assert shaken.rows == estimated(device).rows
    if device["kind"] != "bridge":
        assert not estimated(device | {"shock_g": 3000, "humidities": ["dry"]}).is_fast


def test_a_voltage_is_that_of_a_dielectric_with_its_offset():
    driven = estimated(NARROW | {"offset_V": -0.5})
    assert driven.question.surroundings.potential == pytest.approx(3.5)
    assert estimated(C1).question.surroundings.potential is None


def test_the_density_of_the_beams_material_counts():
    heavy = {"materials": {"Gold": {"density_kg_per_m3": 19300}, "Light": {"density_kg_per_m3": 1000}}}
    library = content()["library"]
    heavy["surfaces"] = {"Top": library["B2"] | {"material": "Gold"}, "Low": library["Sub1"] | {"material": "Light"}}
    heavy["pairs"] = {"mine": {"beam": "Top", "substrate": "Low", "gap_um": 20, "humidities": ["dry"]}}
    device = C1 | {"humidities": ["dry"], "pair": "mine", "length_um": 200}
    of_silicon = estimated(device | {"pair": "b"}).touching.shock
    assert estimated(device, **heavy).touching.shock == pytest.approx(of_silicon * 2330 / 19300, rel=1e-9)


@pytest.mark.parametrize("device", [C1 | {"length_um": 200}, R1])
def test_a_beam_of_another_solid_has_the_life_of_its_run(device):
    sections = {"surfaces": {"Metal": {"like": "B2", "rms_nm": 3, "material": "Alloy"}}}
    sections["materials"] = {"Alloy": {"young_modulus_GPa": 90, "density_kg_per_m3": 8000}}
    sections["pairs"] = {"mine": {"beam": "Metal", "substrate": "Sub1", "gap_um": 20, "humidities": [0.67]}}
    sections["run"] = {"pairs": ["mine"], "studies": []}
    estimate, keys = (made(device | {"pair": "mine"}, **sections) for made in (estimated, keys_of))
    rows = rows_by_name(beams.lengths_after_drying(keys, "Water", keys.liquids["Water"]))
    assert estimate.dried["Water"].stands == pytest.approx(rows[f"{Name.COLLAPSE}_Water"].low, rel=1e-9)
    shock = rows_by_name(beams.beam_touched(keys, estimate.touching.size))[Name.SHOCK].low
    assert estimate.touching.shock == pytest.approx(shock, rel=4e-4)
    assert estimated(device).touching.shock != pytest.approx(shock, rel=0.1), "the control: polysilicon"


@pytest.mark.parametrize(
    ("device", "sections", "reason"),
    [
        (C1, {"liquids": {"Bad": {"surface_tension_mN_per_m": 0}}}, "surface_tension_mN_per_m must be above 0"),
        (
            C1,
            {"liquids": {"Bad": {"surface_tension_mN_per_m": 20, "contact_angle_deg": 181}}},
            "liquids.Bad.contact_angle_deg is 181, must be a number at least 0 and at most 180",
        ),
        (SPRING | {"mass_ng": -1}, {}, "mass_ng must be above 0"),
        (SPRING | {"electrode": {"area_um2": 0, "gap_um": 2}}, {}, "area_um2 must be above 0"),
        (C1 | {"shock_g": -1}, {}, "shock_g must be 0 or above"),
    ],
)
def test_an_impossible_number_of_a_life_has_its_key(device, sections, reason):
    with pytest.raises(Impossible, match=reason):
        estimated(device, **sections)


def test_a_liquid_without_a_tension_is_not_complete():
    with pytest.raises(NotLearnt, match="surface_tension_mN_per_m"):
        estimated(C1, liquids={"Bad": {"contact_angle_deg": 10}})
