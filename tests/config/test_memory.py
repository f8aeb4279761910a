"""The estimated memory of a job exceeds what it takes, and rules reserve it."""

import re
import subprocess
import sys

import numpy as np
import pytest
import yaml
from configurations import PAPER, ROOT, changed

from stiction.config import jobs, memory
from stiction.config.designs import Designs
from stiction.config.plan import Plan
from stiction.config.units import typed
from stiction.scans.estimate import _CORRELATED
from stiction.scans.model_scans import _PERIOD, _POINTS
from stiction.stages import contact, storage
from stiction.study import surface_datasets

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


JOINING = """
import sys
from stiction.run.logs import peak_memory
from stiction.stages import contact, curves, storage

before, samples, paths = peak_memory(), int(sys.argv[1]), sys.argv[2:]
joined = contact.joined((storage.load(path, "contact") for path in paths), samples)
storage.save(joined, paths[0].replace("/0.nc", "/all.nc"), "contact", {})
curves.energies(joined, 0.67, curves.Water(300.0))
print(before, peak_memory())
"""


@pytest.mark.slow
def test_joining_the_chunks_of_many_samples_takes_at_most_the_stated_memory_and_at_least_half_of_what_it_adds(tmp_path):
    samples, chunks, rms = 40_000, 4, 7.2  # of pair c
    grid = contact.DistanceGrid.covering(-10 * rms * 1e-9, 7 * rms * 1e-9, 0.05e-9)
    pressure, area = (np.zeros((samples, n), np.float32) for n in (grid.above, grid.below + grid.above))
    pressure[:, 100] = -1e6
    for k in range(chunks):
        part = contact.chunk(samples, k, chunks)
        dataset = contact.layout(pressure[part.start : part.stop], area[part.start : part.stop], grid, part)
        storage.save(dataset, tmp_path / f"{k}.nc", "contact", {})
    paths = [str(tmp_path / f"{k}.nc") for k in range(chunks)]
    words = [sys.executable, "-c", JOINING, str(samples), *paths]
    before, used = map(float, subprocess.run(words, text=True, capture_output=True, check=True).stdout.split())
    overlay = f"contact: {{samples: {samples}, chunks: {chunks}}}\nrun: {{pairs: [c]}}"
    stated = memory.of_samples(changed(overlay))
    few = memory.of_samples(changed("run: {pairs: [c]}"))
    assert few == memory.USUAL < stated
    assert before + 0.5 * (stated - before) < used < stated


#: Pairs that run: a smooth one, and with it the roughest one.
RUNNING = ("[a]", "[a, c]")


def test_the_roughest_pair_that_runs_determines_the_memory_of_the_samples():
    sizes = {
        pairs: memory.of_samples(changed(f"contact: {{samples: 100000}}\nrun: {{pairs: {pairs}}}"))
        for pairs in ("[a]", "[b]", "[a, b, c]")
    }
    assert memory.USUAL < sizes["[a]"] < sizes["[b]"] < sizes["[a, b, c]"]


STICKING = """
contact: {samples: 100000, chunks: 100}
run: {pairs: [a]}
devices: {D1: {kind: stopper, pair: PAIR, contact_um: [1.5, 30], restoring_force_uN: 1, humidities: [0.5]}}
"""


def test_the_pairs_of_devices_and_their_tips_count_for_the_memory_of_the_samples():
    alone, of_a, of_c = (
        memory.of_samples(changed(overlay))
        for overlay in (STICKING.partition("devices")[0], STICKING.replace("PAIR", "a"), STICKING.replace("PAIR", "c"))
    )
    assert memory.USUAL < alone <= of_a < of_c


TIPS = """
devices: {D1: {kind: cantilever, pair: b, thickness_um: 2.6, gap_um: 20, width_um: 2, humidities: [0.67]}}
"""


def test_the_memory_of_tips_is_that_of_their_slopes_and_more_than_their_contact_takes():
    few, many = (changed(TIPS + f"design: {{beams: {beams}}}") for beams in (50_000, 100_000))
    plan = Plan(few)
    tips = Designs(few).tips("D1")
    settings = jobs.tip_contact(plan, *tips)
    settings["contact"]["samples"] = 2
    surfaces = [surface_datasets(plan, name) for name in plan.sides("b")]
    held = contact.compute(surfaces, "b", "NG", typed(contact.Settings, settings)).nbytes / 2e6
    stated = (memory.of_samples(many) - memory.of_samples(few)) / 50_000
    assert 0.5 * stated < held < stated
    assert memory.of_budget(many, 7) - memory.of_samples(many) == pytest.approx(7e5 * stated, rel=0.01)
    assert memory.of_contact(many, contacts=2) - memory.of_contact(many) == pytest.approx(2e5 * stated, rel=0.01)


def test_long_wedges_at_tips_count_for_the_memory_of_fields():
    flat = changed(TIPS.replace("gap_um: 20", "gap_um: 0.5").replace("thickness_um: 2.6", "thickness_um: 80"))
    length = Designs(flat).tips("D1").length / 1000
    assert length > 20
    assert memory._of_largest_field(flat) >= memory.of_field(length + 1, 3, 10)


def test_the_patch_of_a_device_with_an_uncertainty_is_also_drawn_with_the_points_of_the_variants():
    plain = STICKING.replace("PAIR", "b").replace("100000", "100").replace("[1.5, 30]", "[40, 40]")
    stated = plain.replace("humidities: [0.5]", "humidities: [0.5], uncertainty: {gap_um: 1}")
    finer = "\nstudies: {variants: {spacing_nm: [5]}}"
    assert memory.of_job(changed(plain)) == pytest.approx(memory.of_field(41, 41, 10), abs=1)
    assert memory.of_job(changed(plain + finer)) == memory.of_job(changed(plain))
    assert memory.of_job(changed(stated + finer)) == pytest.approx(memory.of_field(41, 41, 5), abs=1)


def test_a_budget_holds_all_contacts_that_it_compares():
    config = changed(STICKING.replace("PAIR", "c") + "studies: {slopes: {samples: 100000}}")
    one = memory.of_samples(config) - 350
    assert memory.of_budget(config, 7) - memory.of_samples(config) == pytest.approx(7 * one, rel=0.01)
    assert memory.of_budget(changed("{}"), 7) == memory.of_samples(changed("{}"))


def test_samples_of_slopes_count_for_devices_where_they_are_more_than_those_of_the_budget():
    few, many = (
        changed(STICKING.replace("PAIR", "c").replace("100000", "100") + f"studies: {{slopes: {{samples: {n}}}}}")
        for n in (100, 100_000)
    )
    assert memory.of_contact(many) > 2 * memory.of_contact(few)
    assert memory.of_budget(many, 7) > 2 * memory.of_budget(few, 7)


def test_a_job_that_draws_all_samples_holds_field_and_curves():
    plain = changed(STICKING.replace("PAIR", "c"))
    few = changed(STICKING.replace("PAIR", "c").replace("100000", "100"))
    stored = memory.of_contact(plain) - memory.of_field(2.5, 31, 5)
    assert memory.of_contact(few) == memory.of_job(few) == memory.USUAL
    assert stored == pytest.approx(2 * (memory.of_samples(plain) - 350), rel=0.02)


def test_a_job_that_draws_samples_of_pairs_holds_the_curves_of_the_roughest_one_that_runs():
    smooth, rough = (
        changed(f"run: {{pairs: {pairs}}}\ncontact: {{samples: 100000, chunks: 100}}") for pairs in RUNNING
    )
    field = memory.of_field(2.5, 31, 5)
    one = memory.of_drawn(rough, 100_000) - field
    assert one == pytest.approx(2 * (memory.of_samples(rough) - 350), rel=0.02)
    assert memory.of_drawn(rough, 100_000, contacts=3) - field == pytest.approx(3 * one, rel=1e-3)
    assert memory.of_drawn(smooth, 100_000) < memory.of_drawn(rough, 100_000)
    assert memory.of_drawn(rough, 500) == memory.USUAL


def of_estimate(points, pixel, files, corner=12):
    return memory.of_estimate({"points": points, "pixel_nm": pixel, "corner_rad_per_um": corner}, files)


#: Points, pixel [nm], number of scans and peak memory [MB] of estimates of B2 measured one by one.
MEASURED = [
    ((512, 512), (20, 20), 1, 366),
    ((1024, 1024), (10, 10), 3, 480),
    ((2048, 2048), (10, 10), 1, 694),
    ((3072, 3072), (20, 20), 1, 1235),
    ((2048, 256), (2.5, 20), 1, 1134),
]


@pytest.mark.parametrize(("points", "pixel", "files", "used"), MEASURED)
def test_an_estimate_takes_at_most_the_reserved_memory(points, pixel, files, used):
    assert used < of_estimate(points, pixel, files) < 2.3 * used


def test_memory_of_an_estimate_grows_with_the_points_of_its_scans_and_their_number():
    one, three, larger = (of_estimate((4096, n), (20, 20), files) for n, files in ((4096, 1), (4096, 3), (8192, 1)))
    assert three - one == pytest.approx(24e-6 * 4096**2, abs=1)
    assert larger - one == pytest.approx(97e-6 * 4096**2, abs=1)


def test_scans_with_few_wavelengths_of_the_corner_need_wide_transforms():
    many, few = (of_estimate((4096, 4096), (20, 20), 1, corner) for corner in (4, 2))
    assert few - many == pytest.approx(75e-6 * ((16 * np.pi / 0.02) ** 2 - (8 * np.pi / 0.02) ** 2), abs=1)
    assert of_estimate((4096, 4096), (20, 20), 1, 0.5) == of_estimate((4096, 4096), (20, 20), 1, 0.1)


def test_scans_with_oblong_pixels_need_square_maps():
    square, oblong = (of_estimate((4096, n), (20, 20 * 4096 / n), 1) for n in (4096, 512))
    assert square - oblong == pytest.approx(12e-6 * 4096 * (4096 - 512), abs=1)


def test_the_transforms_are_those_of_the_evaluation():
    assert (memory._PERIOD, memory._TRANSFORMED) == (_PERIOD * _CORRELATED, _POINTS)


HOLDING = """
import sys
import yaml
from stiction.config import jobs
from stiction.config.plan import Plan
from stiction.config.units import typed
from stiction.run.logs import peak_memory
from stiction.stages import contact, heights, spectrum

plan, surfaces = Plan(yaml.safe_load(sys.stdin)), []
for name in plan.sides("b"):
    density = heights.compute(typed(heights.Settings, jobs.heights(plan, name)))
    surfaces.append((density, spectrum.compute(density, None, typed(spectrum.Settings, jobs.spectrum(plan, name)))))
settings = typed(contact.Settings, jobs.contact(plan, "b"))
alternatives = [surfaces] * int(sys.argv[1])
contact.compute_each(alternatives, "b", "NG", settings, range(settings.contact.samples // 2))
before = peak_memory()
contact.compute_each(alternatives, "b", "NG", settings)
print(before, peak_memory())
"""


def test_more_samples_of_a_rough_pair_add_at_most_the_stated_memory_and_at_least_half_of_it():
    rough = changed(
        "surfaces: {B2: {rms_nm: 15}, Sub1: {rms_nm: 15}}\ncontact: {samples: 400}\nrun: {pairs: [b]}\n"
        "sampling: {strip_length_um: 0.6}\nbeam: {width_um: 0.9}"
    )
    contacts, samples = 8, rough["contact"]["samples"]
    # What is stated for so many samples is linear in their number: no other job of the study is as large.
    stated = memory.of_drawn(rough, 100 * samples, contacts) - memory.of_drawn(rough, 50 * samples, contacts)
    words = [sys.executable, "-c", HOLDING, str(contacts)]
    done = subprocess.run(words, input=yaml.safe_dump(rough), text=True, capture_output=True, check=True)
    of_half, of_all = map(float, done.stdout.split())
    assert 0.5 * stated / 100 < of_all - of_half < stated / 100


#: Rules of jobs of devices that run on a cluster, and the memory that they reserve.
OF_DEVICES = {"device_contact": "CONTACT", "cracks": "SAMPLES", "chart": "SAMPLES"}
OF_DEVICES |= {"budget": "lambda w, input: memory.of_budget(VIEW, len(input))", "device_choice_summits": "MEMORY"}
SHIFTS = "memory.of_contact(VIEW, contacts=len(SHIFTED))"
OF_DEVICES |= {"device_slope_contact": SHIFTS, "tip_slope_contact": SHIFTS}
#: The same for jobs that draw samples of pairs.
OF_PAIRS = {
    "contact_chunk": 'config["contact"]["samples"] / config["contact"]["chunks"]',
    "sensitivity_contact": 'config["studies"]["sensitivity"]["samples"], '
    "contacts=len(plan.shifted_moments) * len(SHIFTED)",
    "slope_contact": 'config["studies"]["slopes"]["samples"], contacts=len(SHIFTED)',
    "choice_contact": 'config["studies"]["slopes"]["samples"]',
}


def lines_of(rule):
    """Text of a rule, with single spaces."""
    text = "".join(path.read_text(encoding="utf-8") for path in sorted((ROOT / "workflow" / "rules").glob("*.smk")))
    head = rf"^(?:rule {rule}|use rule \w+ as {rule} with):\n"
    (block,) = re.findall(rf"{head}(.*?)^(?:rule|use rule|def) ", text, re.MULTILINE | re.DOTALL)
    return " ".join(block.split())


@pytest.mark.parametrize(("rule", "reserved"), OF_DEVICES.items())
def test_rules_of_devices_reserve_memory_and_more_time_than_the_default(rule, reserved):
    assert f"resources: runtime=120, mem_mb={reserved}," in lines_of(rule)


@pytest.mark.parametrize(("rule", "drawn"), OF_PAIRS.items())
def test_rules_that_draw_samples_of_pairs_reserve_memory_for_them(rule, drawn):
    assert f"memory.of_drawn(VIEW, {drawn})" in lines_of(rule).replace("( VIEW", "(VIEW").replace(" ),", "),")
