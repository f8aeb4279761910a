"""Estimates at once beside a run: same question, all inputs, refusals by air, and what lies outside its intervals."""

import csv
import io
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from answers import CANTILEVER, beam_page, safe

import stiction
from stiction.config.units import in_si
from stiction.estimate.answer import answer
from stiction.estimate.question import questions
from stiction.estimate.table import known
from stiction.plan.graph import Graph, Results
from stiction.plan.plan import Plan
from stiction.report.at_once import tables
from stiction.run import storage
from stiction.run.variables import described
from stiction.stages.at_once import beside
from stiction.stages.devices.opening import EITHER

BEAM = {"kind": "cantilever", "pair": "mine", "thickness_um": 2.6, "width_um": 30, "gap_um": 20, "humidities": [0.6]}
FILE = {
    "run": {"pairs": [], "studies": []},
    "surfaces": {"Etched": {"like": "B2", "rms_nm": 3}},
    "pairs": {"mine": {"beam": "Etched", "substrate": "Sub1", "gap_um": 20, "humidities": [0.6]}},
    "devices": {"Lever": BEAM},
}

#: Standard errors of a length of a run [m].
PARTS = {"beams": 3e-6, "surfaces": 4e-6}


def planned(**device):
    """Graph of the file, with changed keys of its device."""
    return Graph(Plan(stiction.load(FILE, {"devices": {"Lever": device}})))


def settings_of(graph, name="Lever"):
    return graph.job(f"devices/estimate/{name}").settings


def dataset(lengths, graph=None):
    """Dataset of the job of the device on some safe lengths by humidity."""
    return beside.compute(lengths, in_si(beside.Settings, settings_of(graph or planned())))


def asked_as_in_file(**changed):
    """Answer to the question of the file about one touchdown on the surfaces as stated."""
    exact = {"members": ({}, {}), "touchdowns": 1} | changed
    return answer(replace(questions(FILE, known()[0])["Lever"], **exact), *known())


def test_the_estimate_is_that_of_the_file_for_exact_surfaces():
    found, rows = dataset({0.6: safe(), 0.8: safe()}), {row.fraction: row for row in asked_as_in_file().rows}
    wetter = {row.fraction: row for row in asked_as_in_file(humidities=(0.8,)).rows}
    for air, of_air in ((0.6, rows), (0.8, wetter)):
        for share in found.share.values:
            at, row = found.sel(humidity=air, share=share), of_air[share]
            numbers = [float(at[name]) for name in ("estimate", "low", "high")]
            np.testing.assert_allclose(
                numbers, [row.length, *row.intervals["90"]], rtol=1e-7
            )  # nine digits of a spectrum
    assert rows[1e-3].length != wetter[1e-3].length, "the control: the air matters"


def test_the_length_of_the_run_is_its_estimate_by_beam_or_tip_with_both_errors():
    run = safe()
    run = run.assign({f"{name}_error": xr.full_like(run.estimate, error) for name, error in PARTS.items()})
    found = dataset({0.6: run}).isel(humidity=0)
    np.testing.assert_array_equal(found.length, run.estimate.sel(shape=EITHER))
    assert not np.any(found.length == run.estimate.isel(shape=0)), "the control: another end state"
    np.testing.assert_allclose(found.length_error, 5e-6)
    alone = dataset({0.6: run.assign(surfaces_error=run.surfaces_error * np.nan)})
    np.testing.assert_allclose(alone.length_error, 3e-6)


def test_a_length_that_the_run_does_not_know_is_neither_inside_nor_outside():
    run = safe()
    found = dataset({0.6: run.assign(estimate=run.estimate * np.inf)})
    assert np.isnan(found.length).all()
    assert np.isnan(tables.is_inside(found)).all()
    assert tables.counted([found]) == "No length of the run stands beside an estimate."


def test_dry_air_has_its_own_estimate_and_changes_no_other_air():
    found, alone = dataset({0.0: safe(), 0.6: safe()}, planned(humidities=["dry", 0.6])), dataset({0.6: safe()})
    dry = asked_as_in_file(humidities=(0.0,)).chosen
    np.testing.assert_allclose(found.estimate.sel(humidity=0.0, share=1e-3), dry.length, rtol=1e-7)
    np.testing.assert_array_equal(found.estimate.sel(humidity=0.6), alone.estimate.sel(humidity=0.6))
    assert float(found.estimate.sel(humidity=0.6, share=1e-3)) != dry.length
    assert found.refused.values.tolist() == ["", ""]


def test_air_that_was_not_learnt_has_a_reason_in_place_of_a_number():
    found = dataset({0.6: safe(), 0.999: safe()})
    assert found.refused.values[0] == ""
    assert np.isnan(found.estimate.sel(humidity=0.999)).all()
    (said,) = tables.refusals(found)
    assert said.startswith("Not known at once at a relative humidity of 0.999: ")
    assert tables.refusals(dataset({0.6: safe()})) == []


def test_a_material_in_dry_air_has_its_hamaker_constant_among_the_inputs():
    etched, wafer = {"like": "B2", "rms_nm": 3}, {"like": "Sub1", "rms_nm": 0.2}
    sides = {name: side | {"material": "Hard"} for name, side in (("S", etched), ("T", wafer))}
    of_pair = {"beam": "S", "substrate": "T", "gap_um": 20, "humidities": ["dry"]}
    material = {"materials": {"Hard": {"hamaker_constant_zJ": {"water": 60, "dry": 250}}}}
    device = {"devices": {"Lever": BEAM | {"humidities": ["dry"]}}}
    found = []
    for more in ({}, material):
        surfaces = {name: {key: of[key] for key in of if more or key != "material"} for name, of in sides.items()}
        graph = Graph(Plan(stiction.load(FILE, device, {"surfaces": surfaces, "pairs": {"mine": of_pair}}, more)))
        found.append(dataset({0.0: safe()}, graph))
    own, strong = found
    assert np.all(strong.estimate < own.estimate)
    assert float(strong.hamaker_constant) == pytest.approx(2.5e-19)
    assert "hamaker_constant" not in own
    (row, *_) = csv.DictReader(io.StringIO(tables.table({"Lever": strong}).csv))
    assert float(row["hamaker_constant_zJ"]) == pytest.approx(250)


def test_solids_and_water_are_among_the_inputs_where_they_differ():
    more = {"solid": {"young_modulus_GPa": 120}, "water": {"temperature_K": 320}}
    angle = {"surfaces": {"Sub1": {"material": "Oily"}}, "materials": {"Oily": {"contact_angle_deg": 40}}}
    own, other = dataset({0.6: safe()}), dataset({0.6: safe()}, Graph(Plan(stiction.load(FILE, more, angle))))
    stated = FILE | more | angle | {"surfaces": FILE["surfaces"] | angle["surfaces"]}
    asked = replace(questions(stated, known()[0])["Lever"], members=({}, {}))
    of_file = answer(asked, *known()).chosen.length
    assert float(other.estimate.sel(humidity=0.6, share=1e-3)) == pytest.approx(of_file, rel=1e-6)
    numbers = {"modulus": 120e9, "beam_modulus": 120e9, "temperature": 320, "wetting": 1 + np.cos(np.radians(40))}
    for name, value in numbers.items():
        assert float(other[name]) == pytest.approx(value)
        assert name not in own
    assert "hamaker_constant_in_water" not in other
    (row, *_) = csv.DictReader(io.StringIO(tables.table({"Lever": other}).csv))
    assert [float(row[key]) for key in ("modulus_GPa", "temperature_K")] == pytest.approx([120, 320])
    assert float(row["wetting"]) == pytest.approx(numbers["wetting"])


def test_what_was_not_learnt_has_its_reason_in_all_airs_and_a_section_without_a_table():
    of_strips = dataset({0.6: safe(), 0.8: safe()}, planned(strip_um=1))
    assert of_strips.refused.values.tolist() == ["strip_um was not learnt"] * 2
    (said,) = tables.section(of_strips).paragraphs
    assert said == "Not known at once at relative humidities of 0.6, 0.8: strip_um was not learnt."
    assert tables.section(of_strips).cells is None
    assert tables.section(dataset({0.6: safe()})).cells is not None


@pytest.mark.parametrize("ends", [(0.9, 1.1, 1), (1.001, 1.1, 0), (0.9, 0.999, 0)])
def test_a_length_is_inside_between_both_ends(ends):
    low, high, inside = ends
    found = dataset({0.6: safe()})
    found = found.assign(low=low * found.length, high=high * found.length)
    assert tables.is_inside(found).values.tolist() == [[inside] * 3]
    assert tables.counted([found, found]) == f"{6 - 6 * inside} of 6 lengths are outside the interval of 90 %."


def test_rows_of_the_table_have_all_inputs_from_which_the_estimate_follows():
    found = dataset({0.6: safe()})
    table = tables.table({"Lever": found})
    for row in csv.DictReader(io.StringIO(table.csv)):
        sides = {
            side: {key.removeprefix(f"{side}_"): float(row[key]) for key in row if key.startswith(side)}
            for side in ("beam", "substrate")
        }
        spectra = {
            key: [one.pop(key) for one in sides.values()]
            for key in ("plateau_nm4", "floor_nm4", "corner_rad_per_um", "cutoff_rad_per_um")
        }
        for k, one in enumerate(sides.values()):
            one["published_psd"] = {key: values[k] for key, values in spectra.items()}
        sizes = {key: float(row[key]) for key in ("thickness_um", "gap_um", "width_um")}
        settings = in_si(beside.Settings, {"asked": sides | sizes})
        again = beside.compute({float(row["relative_humidity"]): safe()}, settings)
        at = again.isel(humidity=0).sel(share=float(row["share"]))
        stated = [float(row[f"{name}_um"]) for name in ("estimate", "low", "high", "run")]
        np.testing.assert_allclose([1e6 * float(at[name]) for name in ("estimate", "low", "high", "length")], stated)
        assert row["inside"] == {1: "yes", 0: "no"}[int(tables.is_inside(at))]
    assert {cell for cell in table.cells["stuck"]} == {"1 in 100", "1 in 1000", "1 in 10 000"}


def test_only_cantilevers_bridges_and_stoppers_have_it():
    bridge = BEAM | {"kind": "bridge", "residual_stress_MPa": 50}
    stopper = {"kind": "stopper", "pair": "mine", "contact_um": [3, 3], "restoring_force_uN": 20, "humidities": [0.6]}
    dry = BEAM | {"humidities": ["dry"]}
    probe = stopper | {"kind": "probe", "radius_um": 5}
    del probe["contact_um"]
    more = {"R": bridge, "S": stopper, "D": dry, "P": probe, "T": stopper | {"humidities": ["dry"]}}
    plan = Plan(stiction.load(FILE, {"devices": more}))
    graph = Graph(plan)
    assert beside.estimated(plan, beside.LENGTHS) == ["D", "Lever", "R"]
    assert beside.estimated(plan, beside.FORCES) == ["S", "T"]
    read = {name: "estimate" in graph.job(f"devices/{name}.html").inputs for name in plan.devices.sections}
    assert read == {"Lever": True, "R": True, "S": True, "D": True, "P": False, "T": True}
    without = Plan(stiction.load())
    assert not [
        job
        for job in Graph(without).needed("all", "devices")
        if "estimate" in job.names[0] and "_estimate" in job.stage.name
    ]
    assert [job for job in graph.needed("devices") if job.stage.name == "table_estimate"]


def test_the_estimate_of_a_bridge_is_that_of_the_file_beside_the_length_of_its_middle():
    bridge = BEAM | {"kind": "bridge", "residual_stress_MPa": 50, "thickness_um": 2, "gap_um": 2}
    graph = Graph(Plan(stiction.load(FILE, {"devices": {"R": bridge}})))
    stated = settings_of(graph, "R")
    assert stated["asked"]["residual_stress_MPa"] == 50
    assert "residual_stress_MPa" not in settings_of(graph)["asked"], "the control: a cantilever has the same settings"
    run = safe("bridge", longest=250e-6)
    found = beside.compute({0.6: run}, in_si(beside.Settings, stated))
    exact = {"members": ({}, {}), "touchdowns": 1}
    asked = replace(questions(FILE | {"devices": {"R": bridge}}, known()[0])["R"], **exact)
    for row in answer(asked, *known()).rows[1:4]:
        at = found.isel(humidity=0).sel(share=row.fraction)
        numbers = [float(at[name]) for name in ("estimate", "low", "high")]
        np.testing.assert_allclose(numbers, [row.length, *row.intervals["90"]], rtol=1e-7)
    np.testing.assert_array_equal(found.length.isel(humidity=0), run.estimate.isel(shape=0))
    assert described(found, beside.LENGTHS).residual_stress.units == "Pa"
    rows = list(csv.DictReader(io.StringIO(tables.table({"Lever": dataset({0.6: safe()}), "R": found}).csv)))
    assert {row["device"]: row["residual_stress_MPa"] for row in rows} == {"Lever": "", "R": "50.0"}


@pytest.mark.parametrize(
    ("overlay", "is_input"),
    [
        ({"devices": {"Lever": {"thickness_um": 3}}}, True),
        ({"surfaces": {"Etched": {"rms_nm": 3.1}}}, True),
        ({"surfaces": {"Sub1": {"skewness": -0.3}}}, True),
        ({"devices": {"Lever": {"strip_um": 1}}}, True),
        ({"surfaces": {"B1": {"rms_nm": 1.8}}}, False),
        ({"devices": {"Lever": {"length_um": 200, "touchdowns": 10, "uncertainty": {"gap_um": 1}}}}, False),
        ({"contact": {"samples": 100, "chunks": 1}, "design": {"accuracy": {"length": 0.05}}}, False),
        ({"surfaces": {"Etched": {"uncertainty": {"rms_nm": 0.1}}}}, False),
        ({"devices": {"Other": BEAM | {"gap_um": 10}}}, False),
    ],
)
def test_settings_are_the_inputs_of_the_estimate_and_nothing_else(overlay, is_input):
    changed = settings_of(Graph(Plan(stiction.load(FILE, overlay))))
    assert (changed != settings_of(planned())) == is_input


def test_a_device_with_decided_numbers_has_its_estimate():
    config = stiction.load(FILE, {"contact": {"samples": 80, "chunks": 1}, "design": {"beams": 300}})
    numbers = config | {"design": config["design"] | {"samples_of_patches": {"mine": 200}}}
    plain, found = (stiction.Device("Lever", Results.of(one)).estimate().rows for one in (stiction.load(FILE), numbers))
    assert found == plain


def test_a_page_ends_with_the_estimate_beside_the_run():
    found = dataset({0.6: safe()})
    page = beam_page(CANTILEVER, {0.67: safe()})
    (section,) = tables.with_estimate(page, {"estimate": found}).sections[len(page.sections) :]
    assert section.cells["RH"].tolist() == ["0.6"] * 3
    assert section.cells["stuck"].tolist() == ["1 in 100", "1 in 1000", "1 in 10 000"]
    assert tables.counted([found]) in section.paragraphs[0]
    assert tables.with_estimate(page, {}) is page


def test_a_stored_estimate_makes_the_same_table(tmp_path):
    found = dataset({0.6: safe(), 0.999: safe()})
    storage.save(found, tmp_path / "a.nc", "device_estimate", {}, [])
    again = storage.load(tmp_path / "a.nc", "device_estimate")
    assert tables.table({"Lever": again}).csv == tables.table({"Lever": found}).csv
    assert tables.refusals(again) == tables.refusals(found) != []


# Stoppers

STOPPER = {"kind": "stopper", "pair": "mine", "contact_um": [3, 2], "restoring_force_uN": 20, "humidities": [0.6]}


def stoppers(**device):
    """Graph of the file with a stopper."""
    return Graph(Plan(stiction.load(FILE, {"devices": {"Bump": STOPPER | device}})))


def dataset_of_forces(forces, graph=None):
    """Dataset of the job of the stopper beside forces [µN] for 1 in 100 and 1 in 1000 by humidity, which err by 3 %."""
    parts = np.moveaxis([1e-6 * np.array(one) * np.array([[1.2], [1.0], [0.03]]) for one in forces.values()], 1, 0)
    coords = {"part": ["safe", "estimate", "error"], "humidity": list(forces), "share": [1e-2, 1e-3]}
    run = xr.Dataset({"safe_force": (("part", "humidity", "share"), parts)}, coords)
    job = (graph or stoppers()).job("devices/estimate_of_force/Bump")
    return beside.compute_stopper(run, in_si(beside.SettingsOfStopper, job.settings))


def test_the_estimate_of_a_stopper_is_that_of_the_file_beside_the_force_of_the_run():
    found = dataset_of_forces({0.6: [40, 50], 0.8: [60, 70]})
    content = FILE | {"devices": {"Bump": STOPPER}}
    exact = {"members": ({}, {}), "touchdowns": 1}
    for k, air in enumerate((0.6, 0.8)):
        asked = replace(questions(content, known()[0])["Bump"], **exact, humidities=(air,))
        rows = {row.fraction: row for row in answer(asked, *known()).rows}
        for share in (1e-2, 1e-3):
            at = found.sel(humidity=air, share=share)
            numbers = [float(at[name]) for name in ("estimate", "low", "high")]
            np.testing.assert_allclose(numbers, [rows[share].force, *rows[share].intervals["90"]], rtol=1e-7)
        np.testing.assert_allclose(found.force[k], np.array([[4e-5, 5e-5], [6e-5, 7e-5]])[k])
        np.testing.assert_allclose(found.force_error, 0.03 * found.force)


def test_a_table_of_stoppers_has_their_inputs_and_what_is_inside(tmp_path):
    found = dataset_of_forces({0.6: [1, 2]})
    found = found.assign(force=found.estimate.copy(data=found.estimate * [[1.0, 1e3]]))
    sizes = tables.SIZES["force"]
    table = tables.table({"Bump": found}, sizes)
    rows = list(csv.DictReader(io.StringIO(table.csv)))
    assert [row["inside"] for row in rows] == ["yes", "no"]
    assert [(float(row["contact_x_um"]), float(row["contact_y_um"])) for row in rows] == [(3, 2)] * 2
    assert float(rows[0]["run_uN"]) == pytest.approx(1e6 * float(found.force[0, 0]))
    assert "1 of 2 forces are outside the interval of 90 %." in table.caption
    assert tables.section(found).cells["stuck"].tolist() == ["1 in 100", "1 in 1000"]
    storage.save(found, tmp_path / "a.nc", "stopper_estimate", {}, [])
    assert tables.table({"Bump": storage.load(tmp_path / "a.nc", "stopper_estimate")}, sizes).csv == table.csv


def test_a_stopper_that_was_not_learnt_has_a_reason():
    tilted = dataset_of_forces({0.6: [1, 2]}, stoppers(tilt_deg=[0.1]))
    assert tilted.refused.values.tolist() == ["tilt_deg was not learnt"]
    assert np.isnan(tilted.estimate).all()
    large = dataset_of_forces({0.6: [1, 2]}, stoppers(contact_um=[3, 30]))
    assert large.refused.values.tolist() == ["sides of a stopper must be from 1 to 6 µm"]


def test_the_tables_of_lengths_and_of_forces_are_of_their_devices():
    tables_of = {job.stage.name for job in stoppers().needed("devices") if job.stage.name.startswith("table_estimate")}
    assert tables_of == {"table_estimate", "table_estimate_of_force"}
