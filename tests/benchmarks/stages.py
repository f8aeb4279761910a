"""Time the stages on one core and state the machine: ``make bench``. Prints a table; this is no test."""

import os
import platform
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from functools import partial
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[name] = "1"

import numpy as np  # noqa: E402
from scipy import fft  # noqa: E402

from stiction.beam.montecarlo import Experiment, simulate  # noqa: E402
from stiction.chaos import model as chaos  # noqa: E402
from stiction.config import files  # noqa: E402
from stiction.scans.estimate import estimate  # noqa: E402
from stiction.scans.levelling import Levelling  # noqa: E402
from stiction.scans.model_scans import draw_model_scans  # noqa: E402
from stiction.scans.scan import Scan  # noqa: E402
from stiction.streams import stream  # noqa: E402
from stiction.study import PairStudy  # noqa: E402
from stiction.surface.field import StripGrid  # noqa: E402
from stiction.surface.normals import standard_normal  # noqa: E402

ROOT = Path(__file__).parents[2]
CONFIG = files.load({"contact": {"samples": 5}, "chaos": {"order": 1}})  # as few samples as are allowed
#: Force laws along the beam of the paper.
STRIPS = 1000


def timed(function, repeats):
    """Median seconds of one call."""
    seconds = []
    for k in range(repeats):
        start = time.perf_counter()
        function(k)
        seconds.append(time.perf_counter() - start)
    return statistics.median(seconds)


def contact_rows():
    """Contact of one pair compared with its floor: the normal numbers and inverse FFTs of its two surfaces.

    The floor includes the fastest known way to the same normal numbers, and transforms of input that is not copied.
    """
    for name in CONFIG["pairs"]:
        pair = PairStudy.of(CONFIG, name).surfaces
        sides, grid = (pair.beam, pair.substrate), pair.beam.grid

        def floor(k, sides=sides, grid=grid):
            for side in sides:
                _, amplitude, columns = side._modes
                standard_normal(stream(1, k), 2 * len(amplitude))
                waves = np.zeros((columns, grid.field_shape[0]), np.complex64)
                fft.ifft(waves, axis=1, overwrite_x=True)
                waves = np.zeros((grid.shape[0], grid.field_shape[1] // 2 + 1), np.complex64)
                fft.irfft(waves, n=grid.field_shape[1], axis=1)

        def contact(k, pair=pair):
            pair.contact(pair.draw(stream(1, k), stream(2, k)))

        contact(0)
        least, whole = timed(floor, 20), timed(contact, 40)
        yield f"contact of a pair of surfaces, {name}", f"{1e3 * whole:.1f} ms", "12 ms"
        yield f"— divided by its floor ({1e3 * least:.1f} ms)", f"{whole / least:.2f}", ""


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
        fit = partial(chaos.fit, sample, sample[:, 1].max(), 12, tolerance)
        seconds, model = timed(lambda _, fit=fit: fit(), 3), fit()
        yield f"chaos model of one case, order 12, {model.dimension} coordinates", f"{seconds:.2f} s", "6 s"
        laws = timed(lambda k, model=model: chaos.draw_laws(model, STRIPS, stream(5, k)), 20)
        yield f"{STRIPS} force laws, {model.dimension} coordinates", f"{1e3 * laws:.2f} ms", "1 ms"
        experiment = Experiment(beam, STRIPS, partial(chaos.draw_laws, model))
        start = time.perf_counter()
        list(simulate(experiment, range(100), partial(stream, 4)))
        yield f"one beam, {model.dimension} coordinates", f"{10 * (time.perf_counter() - start):.1f} ms", "15 ms"


def scan_rows():
    """Estimate of one scan of 512² points, and its model scans alone."""
    points, pixel = 512, 20e-9
    surface = PairStudy.of(CONFIG, "b").surfaces.beam
    side = points * pixel
    drawn = replace(surface, grid=StripGrid(side, side, surface.grid.spacing, 1e-6)).draw(stream(6))
    every = round(pixel / surface.grid.spacing)
    scan = Scan(drawn[::every, ::every].astype(float), (side, side))
    seconds = timed(lambda k: estimate([scan], k), 3)
    yield f"estimate of one scan of {points}² points", f"{seconds:.1f} s", "5 s"
    model = estimate([scan], 1).model
    seconds = timed(lambda k: draw_model_scans(model, Levelling(), (stream(k, n) for n in range(24))), 3)
    yield f"24 model scans of {points}² points", f"{seconds:.1f} s", "10 s"


def dry_run_row():
    """Planning the whole paper."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "snakemake", "-s", ROOT / "Snakefile", "-d", folder, "-n", "-q", "all"]
        start = time.perf_counter()
        subprocess.run(
            list(map(str, command)), cwd=ROOT, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
    yield "dry run of the whole paper", f"{time.perf_counter() - start:.1f} s", "5 s"


def main():
    """Print the table."""
    cpu = Path("/proc/cpuinfo").read_text().splitlines()
    model = next((line.split(":")[1].strip() for line in cpu if line.startswith("model name")), "?")
    print(f"{model}, {os.cpu_count()} cores, Python {platform.python_version()}, one core used\n")  # noqa: T201
    print("| stage | measured | wanted at most |\n|---|---|---|")  # noqa: T201
    for rows in (contact_rows, law_rows, scan_rows, dry_run_row):
        for row in rows():
            print("| " + " | ".join(row) + " |", flush=True)  # noqa: T201
    print(f"\npeak memory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB")  # noqa: T201


if __name__ == "__main__":
    main()
