"""Time of full elastic contact and its floor, its Fourier transforms, on one core: ``make full-contact-times``.

Processor time, so that other work on the machine counts little. Prints a table; this is no test.
"""

import os
import time
from dataclasses import replace

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[name] = "1"

import numpy as np  # noqa: E402

from stiction.config import files  # noqa: E402
from stiction.contact.full.elements import separation  # noqa: E402
from stiction.contact.full.halfspace import HalfSpace  # noqa: E402
from stiction.plan.graph import Results  # noqa: E402
from stiction.run.provenance import cpu_name  # noqa: E402
from stiction.stages.contact import full_contact  # noqa: E402
from stiction.stages.surfaces.rough_surfaces import sides_of  # noqa: E402

CONFIG = files.load()
#: Strips that are timed, and those that give crack lengths to 2 %.
STRIPS, WANTED = 3, 15


class Counted(HalfSpace):
    """Half-space that counts the displacements that are computed, one Fourier transform and its inverse each."""

    number = 0

    def displacement(self, pressure):
        object.__setattr__(self, "number", self.number + 1)
        return super().displacement(pressure)


def row(results, pair):
    """One line: time of a strip at all its humidities, transforms, and the time of these alone."""
    job = results.graph.job(f"studies/full_contact/{pair}")
    settings = replace(job.stage.converted(job.settings), strips=STRIPS + 1)
    taken, floors, numbers = [], [], []
    for space, heights, cases in full_contact.strips(sides_of(results.inputs(job)), pair, settings):
        counted = Counted(space.shape, space.spacing, space.modulus)
        start = time.process_time()
        for adhesion, curve, _ in cases:
            separation(counted, heights, adhesion, curve)
        taken.append(time.process_time() - start)
        start = time.process_time()
        for _ in range(counted.number):
            space.displacement(heights)
        floors.append(time.process_time() - start)
        numbers.append(counted.number)
    taken, floors, numbers = (np.median(each[1:]) for each in (taken, floors, numbers))  # the first compiles
    cells = (
        pair,
        f"{taken:.1f}",
        f"{numbers:.0f}",
        f"{floors:.1f}",
        f"{taken / floors:.1f}",
        f"{WANTED * taken:.0f}",
    )
    return "| " + " | ".join(cells) + " |"


def main():
    """Print the table."""
    print(f"{cpu_name()}, one core used, processor time, strips of 1.5 × 30 µm, {STRIPS} of each pair\n")  # noqa: T201
    print(  # noqa: T201
        "| pair | one strip, three humidities [s] | displacements | these alone [s] | ratio | "
        f"{WANTED} strips [s] |\n|---|---|---|---|---|---|"
    )
    results = Results.of(CONFIG)
    for pair in CONFIG["pairs"]:
        print(row(results, pair), flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
