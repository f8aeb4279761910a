"""Every variable of every file has a row in one table, and files follow the CF conventions as they claim."""

import csv
import re
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from conventions import faults, is_udunits

from stiction.plan.graph import stages
from stiction.run import storage, variables
from stiction.run.fingerprint import PACKAGE

ROWS = variables.rows()


def test_every_row_has_a_meaning_and_a_unit_of_udunits_and_an_equation_of_the_paper():
    for key, row in ROWS.items():
        assert row.long_name == row.long_name.strip() != "", key
        assert row.units in ("", "stated") or is_udunits(row.units), key
        assert not row.equation or 1 <= int(re.fullmatch(r"\((\d+)\)", row.equation)[1]) <= 19, key


def test_the_control_knows_units_of_no_library():
    assert all(map(is_udunits, ("1", "m", "J m-2", "rad m-1", "m2 J-1", "nm", "N m-1")))
    assert not any(map(is_udunits, ("m^order", "SI", "m, m-2", "J/m2", "", "mJ.m-2", "m-")))


def test_no_variable_has_two_rows_in_a_stage_and_every_stage_of_the_table_exists_and_has_a_title():
    text = Path(variables.__file__).with_name("variables.csv").read_text(encoding="utf-8")
    _, *lines = csv.reader(text.splitlines())
    twice = Counter((stage, name) for named, name, *_ in lines for stage in named.split() or [""])
    assert max(twice.values()) == 1
    written = {stage.stage for stage, _ in stages().values() if stage.save is None}
    assert {stage for stage, _ in ROWS} - {""} == written
    assert {stage for stage, name in ROWS if not name} == written


def test_energies_of_strips_and_beams_have_different_names():
    strips, beams = ROWS["", "adhesion_energy"], ROWS["beams", "apparent_energy"]
    assert (strips.symbol, beams.symbol) == ("ē", "Γ")
    assert ("beams", "adhesion_energy") not in ROWS


#: Modules of stages with units that depend on the configuration, and with datasets for users, which have no row.
STATED = {"answer.answer", "axes.law", "axes.requirement", "devices.budget", "test_beams.inference"}
FOR_USERS = {"devices.results", "laws.samples", "surfaces.maps"}


def test_units_and_meanings_stand_in_the_table_alone():
    folder = PACKAGE / "stages"
    stating = {path for path in folder.rglob("*.py") if re.search(r'"(units|long_name)":', path.read_text("utf-8"))}
    assert {".".join(path.relative_to(folder).with_suffix("").parts) for path in stating} == STATED | FOR_USERS


@pytest.mark.parametrize(
    ("stage", "name", "message"), [("beams", "stickiness", "variable stickiness of stage beams"), ("x", "rms", "title")]
)
def test_a_variable_or_stage_without_a_row_is_named_and_saved(tmp_path, stage, name, message):
    with pytest.warns(UserWarning, match=message):
        storage.save(xr.Dataset({name: 1.0}), tmp_path / "a.nc", stage, {})
    assert xr.load_dataset(tmp_path / "a.nc")[name] == 1.0


def test_files_of_all_stages_follow_the_conventions(tmp_path):
    for kind in {stage for stage, _ in ROWS} - {""}:
        named = {name: row.units for (stage, name), row in ROWS.items() if stage in ("", kind) and name}
        units = {name: {"units": "1"} if unit == "stated" else {} for name, unit in named.items()}
        storage.save(
            xr.Dataset({name: ((), np.nan, attrs) for name, attrs in units.items()}), tmp_path / "a.nc", kind, {}
        )
        assert faults(tmp_path / "a.nc") == [], kind


def some_beams():
    """A dataset with a flag, a scalar coordinate, a coordinate without unit and unknown numbers."""
    return xr.Dataset(
        {
            "state": ("beam", np.arange(3, dtype=np.int8), {"flag_values": np.arange(3, dtype=np.int8)}),
            "crack_length": ("beam", [1e-3, np.nan, 2e-3], {"units": "wrong"}),
        },
        coords={"beam": [0, 1, 2], "node": [0.0, 1e-3], "pair": "b", "relative_humidity": 0.67},
    )


def test_a_saved_file_follows_the_conventions_and_is_described_by_the_table(tmp_path):
    beams = some_beams()
    beams.state.attrs["flag_meanings"] = "S-shape arc free"
    storage.save(beams, tmp_path / "a.nc", "beams", {})
    assert faults(tmp_path / "a.nc") == []
    found = storage.load(tmp_path / "a.nc", "beams")
    length = found.crack_length.attrs
    assert (length["units"], length["symbol"], length["equation"]) == ("m", "l_s", "(13)")
    assert found.relative_humidity.attrs["standard_name"] == "relative_humidity"
    assert found.attrs["title"] == ROWS["beams", ""].long_name
    assert set(beams.crack_length.attrs) == {"units"}, "the dataset of the stage is left as it was"
    xr.testing.assert_equal(found, beams)


def test_the_control_finds_the_faults_of_a_plain_file(tmp_path):
    plain = some_beams().assign(power=("beam", [1.0, 2.0, 3.0], {"units": "m^order"}))
    plain.to_netcdf(tmp_path / "a.nc", engine="netcdf4")
    found = faults(tmp_path / "a.nc")
    for fault in ("no Conventions", "no title", "node: a coordinate with a fill value", "power: unit m^order"):
        assert fault in found
    assert "state: flags without meanings" in found
    assert "crack_length: neither long_name nor standard_name" in found
