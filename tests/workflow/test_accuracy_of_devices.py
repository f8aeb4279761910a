"""Numbers for an accuracy are those of Python, whatever the cores, and are said before a run."""

import pytest
from conftest import snakemake

import stiction
from stiction import accuracy

pytestmark = pytest.mark.slow

SMALL = """
run: {pairs: [], studies: []}
chaos: {order: 2}
design: {accuracy: {length: 0.01}}
devices:
  R1: {kind: bridge, pair: b, thickness_um: 2, gap_um: 2, width_um: 3, residual_stress_MPa: 50, humidities: [0.88]}
"""


def test_a_run_says_the_numbers_that_it_takes_and_decides_them_once(tmp_path, overlay):
    file = overlay(SMALL)
    said = str(accuracy.numbers(stiction.load(file), {}))
    kept = tmp_path / ".snakemake" / "accuracy.json"
    assert said in snakemake(tmp_path, "--dry-run", "devices", configs=[file], cores=1).stdout
    written = kept.stat().st_mtime_ns
    assert said in snakemake(tmp_path, "--dry-run", "devices", configs=[file], cores=2).stdout
    assert kept.stat().st_mtime_ns == written
