"""Time the stages and their floors on one core, and state the machine: ``make bench``. This is no test."""

import os
import platform
import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from functools import partial
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[name] = "1"

import floors  # noqa: E402
import numpy as np  # noqa: E402
from scipy import fft  # noqa: E402

from stiction.beam.montecarlo import Experiment, simulate  # noqa: E402
from stiction.chaos import model as chaos  # noqa: E402
from stiction.config import files  # noqa: E402
from stiction.config.units import in_si  # noqa: E402
from stiction.contact.environment import Water  # noqa: E402
from stiction.contact.meniscus import film  # noqa: E402
from stiction.plan.plan import Plan  # noqa: E402
from stiction.scans.estimate import estimate  # noqa: E402
from stiction.scans.levelling import Levelling  # noqa: E402
from stiction.scans.model_scans import draw_model_scans  # noqa: E402
from stiction.scans.scan import Scan  # noqa: E402
from stiction.stages.contact.contact import tables  # noqa: E402
from stiction.stages.laws import forces  # noqa: E402
from stiction.streams import stream  # noqa: E402
from stiction.study import PairStudy  # noqa: E402
from stiction.surface.field import StripGrid  # noqa: E402

ROOT = Path(__file__).parents[2]
CONFIG = files.load({"contact": {"samples": 5}, "chaos": {"order": 1}})  # as few samples as are allowed
#: Force laws along the beam of the paper.
STRIPS = 1000


def side_by_side(name, stage, floor, repeats):
    """Row of the table: median times of a stage and of its floor, which are called in turn.

    The first calls, which may compile, are left out.
    """
    seconds = np.array([[timed(call, k) for call in (stage, floor)] for k in range(repeats + 1)])
    measured, least = np.median(seconds[1:], axis=0)
    return name, shown(measured), shown(least), f"{measured / least:.1f}"


def timed(call, k):
    """Seconds of one call."""
    start = time.perf_counter()
    call(k)
    return time.perf_counter() - start


def shown(seconds):
    """Time with two digits and its unit."""
    return f"{seconds:.2g} s" if seconds >= 0.095 else f"{1e3 * seconds:.2g} ms"


def contact_rows():
    """Contact of one pair of surfaces, draws included."""
    for name in CONFIG["pairs"]:
        pair = PairStudy.of(CONFIG, name).surfaces

        def contact(k, pair=pair):
            pair.contact(pair.draw(stream(1, k), stream(2, k)))

        def floor(k, pair=pair):
            for number, side in enumerate((pair.beam, pair.substrate), 1):
                floors.surface(side, stream(number, k))

        yield side_by_side(f"contact of one sample, pair {name}", contact, floor, 40)


def force_rows():
    """Force curves of one case and their parameters; the few samples drawn are repeated."""
    study, samples = PairStudy.of(CONFIG, "b"), 5000
    contact = study.contact.isel(strip=np.arange(samples) % study.contact.sizes["strip"])
    settings = forces.Settings(in_si(Water, Plan(CONFIG).air.water("b")), 0.67)
    water = film(settings.humidity, settings.water.temperature)
    yield side_by_side(
        f"forces of one case, {samples} samples",
        lambda _: forces.compute(contact, settings),
        lambda _: floors.forces(tables(contact), water),
        10,
    )


def vectors():
    """Vectors v like those of pair b at RH 0.67."""
    z = stream(3).standard_normal((5000, 4)) @ np.linalg.cholesky(0.7 + 0.3 * np.eye(4)).T
    e, f, d, gap = (z * [0.3, 0.3, 0.3e-9, 0.1]).T
    d_max = 8e-9 + d
    return np.column_stack([7e-3 * np.exp(e), 2e6 * np.exp(f), d_max, d_max - 1.5e-9 * np.exp(gap)])


def law_rows():
    """Chaos model of one case, force laws drawn from it and beams that use them."""
    sample, beam = vectors(), PairStudy.of(CONFIG, "b").beam
    for tolerance in (0.1, 0.0):
        model = chaos.fit(sample, sample[:, 1].max(), 12, tolerance)
        kept = f"{model.dimension} coordinates"
        yield side_by_side(
            f"chaos model of one case, order 12, {kept}",
            lambda _, tolerance=tolerance: chaos.fit(sample, sample[:, 1].max(), 12, tolerance),
            lambda _, model=model: floors.chaos(len(sample), model.dimension),
            5,
        )
        yield side_by_side(
            f"{STRIPS} force laws, {kept}",
            lambda k, model=model: chaos.draw_laws(model, STRIPS, stream(5, k)),
            lambda k, model=model: floors.laws(model, STRIPS, stream(5, k)),
            40,
        )
        yield beam_row(model, beam)


def beam_row(model, beam):
    """Beams with force laws of their own; the floor includes that of the laws."""
    experiment = Experiment(beam, STRIPS, partial(chaos.draw_laws, model))
    numbers, streams = range(100), partial(stream, 4)
    steps = floors.newton_steps(experiment, numbers, streams)

    def floor(_):
        for number in numbers:
            floors.laws(model, STRIPS, streams(number))
        floors.beams(steps, int(steps.max()))

    def release(_):
        list(simulate(experiment, numbers, streams))

    return side_by_side(f"{len(numbers)} beams, {model.dimension} coordinates", release, floor, 5)


def scan_rows():
    """Estimate of one scan of 512² points, and its model scans alone."""
    points, pixel = 512, 20e-9
    surface = PairStudy.of(CONFIG, "b").surfaces.beam
    side = points * pixel
    drawn = replace(surface, grid=StripGrid(side, side, surface.grid.spacing, 1e-6)).draw(stream(6))
    every = round(pixel / surface.grid.spacing)
    scan = Scan(drawn[::every, ::every].astype(float), (side, side))
    model = estimate([scan], 1).model

    def floor(k, number):
        for n in range(number):
            floors.surface(model._surface, stream(k, n))

    def estimate_floor(k):
        fft.rfft2(scan.heights)
        floor(k, 2 * 24)  # two rounds of model scans

    yield side_by_side(
        "24 model scans of 512² points",
        lambda k: draw_model_scans(model, Levelling(), (stream(k, n) for n in range(24))),
        partial(floor, number=24),
        5,
    )
    yield side_by_side("estimate of one scan of 512² points", lambda k: estimate([scan], k), estimate_floor, 3)


def dry_run_row():
    """Planning the whole paper; the floor is that of a plan without jobs."""
    with tempfile.TemporaryDirectory() as folder:
        empty = Path(folder) / "Snakefile"
        empty.write_text("rule all:\n")

        def plan(_, snakefile):
            command = [sys.executable, "-m", "snakemake", "-s", snakefile, "-d", folder, "-n", "-q", "all"]
            subprocess.run(list(map(str, command)), cwd=ROOT, check=True, capture_output=True)

        whole, nothing = (partial(plan, snakefile=path) for path in (ROOT / "Snakefile", empty))
        yield side_by_side("dry run of the whole paper", whole, nothing, 3)


def main():
    """Print the table."""
    cpu = Path("/proc/cpuinfo").read_text().splitlines()
    model = next((line.split(":")[1].strip() for line in cpu if line.startswith("model name")), "?")
    print(f"{model}, {os.cpu_count()} cores, Python {platform.python_version()}, one core used\n")  # noqa: T201
    print("| stage | measured | floor | ratio |\n|---|---|---|---|")  # noqa: T201
    for rows in (contact_rows, force_rows, law_rows, scan_rows, dry_run_row):
        for row in rows():
            print("| " + " | ".join(row) + " |", flush=True)  # noqa: T201
    print(f"\npeak memory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB")  # noqa: T201


if __name__ == "__main__":
    main()
