"""Devices in a spreadsheet: the example runs in reduced form, answers in its order, and reruns the row that changes."""

import re
import shutil
from pathlib import Path

import pandas as pd
import pytest
from conftest import snakemake

EXAMPLE = Path(__file__).parents[2] / "examples" / "range"
#: Two levers whose names YAML would read as truth values, on little surface.
ROWS = "name,length_um,thickness_um\nOn,250,2.6\nOff,120,2\n"
SMALL = """
devices: {humidities: [0.6], width_um: 5, gap_um: 2, uncertainty: {thickness_um: 0, gap_um: 0}}
contact: {samples: 40, chunks: 1, model: summits}
design: {beams: 200, budget_beams: 20, budget_samples: 20}
"""
TABLE = "results/tables/devices.csv"


@pytest.mark.slow
def test_rows_are_answered_in_their_order_and_a_changed_row_reruns_its_device_alone(tmp_path):
    shutil.copy(EXAMPLE / "mine.yaml", tmp_path)
    (tmp_path / "range.csv").write_text(ROWS)
    (tmp_path / "small.yaml").write_text(SMALL)
    configs = (tmp_path / "mine.yaml", tmp_path / "small.yaml")
    snakemake(tmp_path, TABLE, configs=configs)
    found = pd.read_csv(tmp_path / TABLE, dtype={"device": str})
    assert list(found.device) == ["On", "Off"]
    assert list(found["size"]) == [250, 120]
    assert found.verdict.notna().all()
    assert not re.search(r"\d\.\d{13}", (tmp_path / TABLE).read_text())  # no noise behind twelve digits
    assert "Nothing to be done" in snakemake(tmp_path, TABLE, "--dry-run", configs=configs).stdout
    (tmp_path / "range.csv").write_text(ROWS.replace("120", "130"))
    planned = snakemake(tmp_path, TABLE, "--dry-run", configs=configs).stdout
    stale = re.findall(r"^results/(.*) was (?:computed|made) with .*$", planned, re.MULTILINE)
    assert {re.sub(r"(_rh\d+)?\.\w+$", "", name) for name in stale} == {
        "tables/devices", "devices/answer/Off", "devices/life/Off", "devices/safe_lengths/Off", "devices/warnings/Off"
    }  # fmt: skip
    of_devices = [line for line in planned.splitlines() if line.startswith("results/devices/")]
    assert not [line for line in of_devices if "more of this folder" in line]  # of others, which are not named
