"""The estimated memory of a job exceeds what it takes, and rules reserve it."""

import subprocess
import sys

import pytest
import yaml
from configurations import PAPER, ROOT, changed

from stiction.config import memory
from stiction.stages.surfaces import FIELD

DRAWING = """
import sys
import numpy as np
from stiction.run.logs import peak_memory
from stiction.surface.field import RoughSurface, StripGrid, radial_periodogram
from stiction.surface.maxent import GAUSSIAN
from stiction.surface.spectrum import CutoffSelfAffine
from stiction.surface.translation import Translation

length, width, spacing = (float(word) for word in sys.argv[1:])
psd = CutoffSelfAffine(1e-32, 1e-36, 1e7, 0.9 * np.pi / spacing)
grid = StripGrid(length, width, spacing, 0.0)
z = RoughSurface(psd, Translation(GAUSSIAN), 1e-9, grid).draw(np.random.default_rng(1))
if length == width:
    radial_periodogram(z, spacing)
print(peak_memory())
"""


@pytest.mark.parametrize("size_um", [(10.24, 10.24, 10), (10.24, 10.24, 5), (2.5, 31, 4)])
def test_drawing_takes_at_most_the_estimated_memory_and_at_least_a_quarter(size_um):
    length, width, spacing = size_um
    words = [sys.executable, "-c", DRAWING, *(str(1e-6 * side) for side in (length, width)), str(1e-9 * spacing)]
    used = float(subprocess.run(words, text=True, capture_output=True, check=True).stdout)
    assert 0.25 * memory.of_field(*size_um) < used < memory.of_field(*size_um)


def test_memory_grows_with_the_number_of_points():
    small, fine, wide = memory.of_field(3, 5, 10), memory.of_field(3, 5, 5), memory.of_field(6, 5, 10)
    empty = memory.of_field(0, 5, 10)
    assert fine - empty == pytest.approx(4 * (small - empty))
    assert wide - empty == pytest.approx(2 * (small - empty))


def test_the_paper_needs_no_more_than_the_usual_memory_of_the_profiles():
    assert memory.of_job(PAPER) == memory.USUAL
    for profile in ("default", "slurm"):
        settings = yaml.safe_load((ROOT / "profiles" / profile / "config.yaml").read_text(encoding="utf-8"))
        assert f"mem_mb={memory.USUAL}" in settings["default-resources"]


@pytest.mark.parametrize(
    ("overlay", "size"),
    [
        ("sampling: {spacing_nm: 2}", (10.24, 10.24, 2)),
        ("identification: {patch_um: 40}", (40, 40, 10)),
        ("sampling: {margin_um: 30}\nstudies: {variants: {spacing_nm: []}}", (31.5, 60, 10)),
        ("beam: {width_um: 600}\nstudies: {variants: {spacing_nm: []}}", (2.5, 601, 10)),
        ("studies: {variants: {spacing_nm: [2.5]}}", (2.5, 31, 2.5)),
    ],
)
def test_the_largest_field_of_a_configuration_counts(overlay, size):
    assert memory.of_job(changed(overlay)) == max(memory.USUAL, round(memory.of_field(*size))) > memory.USUAL


def test_the_fields_of_spectra_have_the_size_of_the_stages():
    assert pytest.approx(FIELD) == 1e-6 * memory.FIELD_UM
