"""The estimated memory of a job exceeds what it takes, and rules reserve it."""

import subprocess
import sys

import pytest
import yaml
from configurations import PAPER, ROOT, changed

from stiction.config import files
from stiction.config.memory import USUAL, field_memory, tip_memory
from stiction.plan import memory
from stiction.plan.cost import USUAL_MINUTES
from stiction.plan.devices import DevicePlan
from stiction.plan.graph import stages
from stiction.plan.plan import Plan

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


@pytest.mark.parametrize(
    "size_um",
    [(10.24, 10.24, 10), *(pytest.param(size, marks=pytest.mark.slow) for size in ((10.24, 10.24, 5), (2.5, 31, 4)))],
)
def test_drawing_takes_at_most_the_estimated_memory_and_at_least_a_quarter(size_um):
    length, width, spacing = size_um
    words = [sys.executable, "-c", DRAWING, *(str(1e-6 * side) for side in (length, width)), str(1e-9 * spacing)]
    used = float(subprocess.run(words, text=True, capture_output=True, check=True).stdout)
    assert 0.25 * field_memory(*size_um) < used < field_memory(*size_um)


def test_memory_grows_with_the_number_of_points():
    small, fine, wide = field_memory(3, 5, 10), field_memory(3, 5, 5), field_memory(6, 5, 10)
    empty = field_memory(0, 5, 10)
    assert fine - empty == pytest.approx(4 * (small - empty))
    assert wide - empty == pytest.approx(2 * (small - empty))


def test_the_paper_needs_no_more_than_the_usual_memory_and_time_of_the_profiles():
    assert memory.job_memory(PAPER) == USUAL
    for profile in ("default", "slurm"):
        settings = yaml.safe_load((ROOT / "profiles" / profile / "config.yaml").read_text(encoding="utf-8"))
        assert {f"mem_mb={USUAL}", f"runtime={USUAL_MINUTES}"} <= set(settings["default-resources"])


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
    assert memory.job_memory(changed(overlay)) == max(USUAL, round(field_memory(*size))) > USUAL


STICKING = """
contact: {samples: 100000, chunks: 100}
run: {pairs: [a]}
devices: {D1: {kind: stopper, pair: PAIR, contact_um: [1.5, 30], restoring_force_uN: 1, humidities: [0.5]}}
"""


TIPS = """
devices: {D1: {kind: cantilever, pair: b, thickness_um: 2.6, gap_um: 20, width_um: 2, humidities: [0.67]}}
"""


def test_long_wedges_at_tips_count_for_the_memory_of_fields():
    flat = changed(TIPS.replace("gap_um: 20", "gap_um: 0.5").replace("thickness_um: 2.6", "thickness_um: 80"))
    length = DevicePlan(flat).tips("D1").length / 1000
    assert length > 20
    assert memory._largest_field_memory(flat) >= field_memory(length + 1, 3, 10)


def test_the_patch_of_a_device_with_an_uncertainty_is_also_drawn_with_the_points_of_the_variants():
    plain = STICKING.replace("PAIR", "b").replace("100000", "100").replace("[1.5, 30]", "[40, 40]")
    stated = plain.replace("humidities: [0.5]", "humidities: [0.5], uncertainty: {gap_um: 1}")
    finer = "\nstudies: {variants: {spacing_nm: [5]}}"
    assert memory.job_memory(changed(plain)) == pytest.approx(field_memory(41, 41, 10), abs=1)
    assert memory.job_memory(changed(plain + finer)) == memory.job_memory(changed(plain))
    assert memory.job_memory(changed(stated + finer)) == pytest.approx(field_memory(41, 41, 5), abs=1)


HOLDING = """
import sys
import numpy as np
import xarray as xr
from stiction.contact.environment import Water
from stiction.run import storage
from stiction.run.logs import peak_memory
from stiction.stages.contact import curves

tips, contacts, path = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
rng, draw = np.random.default_rng(1), ("strip", "slope")
found = xr.Dataset(
    {
        "solid_pressure": ((*draw, "distance"), rng.random((tips, 12, 488), dtype=np.float32)),
        "bearing_area": ((*draw, "height"), rng.random((tips, 12, 715), dtype=np.float32)),
        "step": 1e-10,
        "length": 2.44e-6,
    },
    coords={
        "distance": 1e-10 * np.arange(488),
        "height": 1e-10 * np.arange(-500, 215),
        "slope": np.linspace(0.01, 0.1, 12),
    },
)
storage.save(found, path, "contact", {})
curves.tip_forces(found.isel(strip=[0]), 0.67, Water(300.0))  # compiles, which takes memory of its own
del found
before = peak_memory()
held = [storage.load(path, "contact") for _ in range(contacts)]
curves.tip_forces(held[-1], 0.67, Water(300.0))
print(before, peak_memory())
"""


@pytest.mark.slow
def test_contacts_of_tips_take_at_most_the_estimated_memory_and_at_least_a_quarter(tmp_path):
    """The numbers of distances and heights are those of pair c, the largest in the examples."""
    tips, contacts = 200, 12
    words = [sys.executable, "-c", HOLDING, str(tips), str(contacts), str(tmp_path / "c.nc")]
    before, used = map(float, subprocess.run(words, text=True, capture_output=True, check=True).stdout.split())
    estimate = tip_memory(12 * tips * contacts) - USUAL
    assert 0.25 * estimate < used - before < estimate


def test_budgets_of_tips_reserve_the_memory_of_all_their_tips_under_every_input():
    def reserved(*overlays):
        plan = Plan(files.load(ROOT / "examples" / "devices.yaml", *overlays))
        return [stages()[name][0].running.memory(plan) for name in ("tip_budget", "test_beam_tip_budget")]

    array = {"pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30}
    array |= {"stuck": [{"humidity": 0.67, "length_um": 300, "stuck": 3, "of": 20}]}
    counted = {"test_beams": {"A": array}, "devices": {"C1": {"test_beams": ["A"]}}}
    # 15 slopes; all tips with the inputs as stated, and 100 with less and more of eight, and under four choices.
    assert reserved() == [tip_memory(15 * (1000 + 100 * (2 * 8 + 4))), tip_memory(0)]
    assert reserved({"design": {"beams": 2000}}) == [tip_memory(15 * (2000 + 100 * (2 * 8 + 4))), tip_memory(0)]
    # Test beams have no chart, whose beams have other slopes, and no other choices of the model.
    assert reserved(counted)[1] == tip_memory(12 * (1000 + 100 * 2 * 8))


def test_a_job_that_failed_may_use_twice_as_much():
    assert [memory.for_attempt(1700, attempt) for attempt in (1, 2, 3)] == [1700, 3400, 6800]
