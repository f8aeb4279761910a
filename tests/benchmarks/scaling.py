"""Growth of time and memory with samples, strips, grid, cases and cores: part of ``make bench``; this is no test.

Each size is measured in a process of its own. Prints a table, and draws ``docs/pictures/scaling.png`` if asked to.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np
import yaml

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs"))

#: Changes of the configuration of the paper, by what grows and its size. Pair b; the first of each is the reference.
CONTACT = {
    "samples": {n: {"contact": {"samples": n}} for n in (100, 400, 1600)},
    "length of a strip [µm]": {
        length: {
            "sampling": {"strip_length_um": length},
            "beam": {"elements": 125},  # whole strips on each element
            "contact": {"samples": 100},
        }
        for length in (1, 2, 4)
    },
    "points of the grid per µm": {
        round(1e3 / spacing): {"sampling": {"spacing_nm": spacing}, "contact": {"samples": 100}}
        for spacing in (10, 5, 2.5)
    },
}
#: Numbers of samples of the chaos model of one case, and of humidities of each of the three pairs in a plan.
SAMPLES, HUMIDITIES = (1250, 5000, 20_000), (6, 25, 100)

_CONTACT = """
import json, sys, time
from stiction.config import files
from stiction.plan.graph import Results
from stiction.run.logs import peak_memory
from stiction.stages.contact import contact
from stiction.stages.surfaces.rough_surfaces import sides_of

results = Results.of(files.load(json.loads(sys.argv[1])))
job = results.graph.job("contact/b_NG/0-of-1")
surfaces, settings = sides_of(results.inputs(job)), job.stage.converted(job.settings)
contact.compute(surfaces, "b", "NG", settings, range(1))
start = time.perf_counter()
contact.compute(surfaces, "b", "NG", settings)
print(time.perf_counter() - start, peak_memory())
"""

_CHAOS = """
import sys, time
import numpy as np
from stiction.chaos import model
from stiction.run.logs import peak_memory
from stiction.streams import stream

number = int(sys.argv[1])
z = stream(3).standard_normal((number, 4)) @ np.linalg.cholesky(0.7 + 0.3 * np.eye(4)).T
e, f, d, gap = (z * [0.3, 0.3, 0.3e-9, 0.1]).T
vectors = np.column_stack([7e-3 * np.exp(e), 2e6 * np.exp(f), 8e-9 + d, 8e-9 + d - 1.5e-9 * np.exp(gap)])
model.fit(vectors[:50], vectors[:50, 1].max(), 2, 0.0)
start = time.perf_counter()
model.fit(vectors, vectors[:, 1].max(), 12, 0.0)
print(time.perf_counter() - start, peak_memory())
"""

_LOOP = """
import sys, time

start, sums = time.perf_counter(), 0
for number in range(int(float(sys.argv[1]))):
    sums ^= number
print(time.perf_counter() - start, 0)
"""


def run(program, argument):
    """Seconds and peak memory [MB] that a program prints."""
    words = [sys.executable, "-c", program, argument]
    environment = os.environ | dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
    done = subprocess.run(words, text=True, capture_output=True, check=False, env=environment)
    if done.returncode:
        raise RuntimeError(done.stderr)
    seconds, megabytes = map(float, done.stdout.split())
    return seconds, megabytes


def contact(changes):
    """Contact of pair b under changes of the configuration."""
    few = {
        "run": {"pairs": ["b"]},
        "pairs": {"b": {"humidities": [0.44]}},  # hardly adheres, so that long strips resolve the crack
        "chaos": {"order": 2},  # 100 samples carry no order 12
        "studies": {"variants": {"spacing_nm": [], "strips_per_element": []}},
    }
    return run(_CONTACT, json.dumps(changes | few))


def plan_of(humidities):
    """Dry run of the paper with this number of humidities of each pair."""
    axis = np.round(np.linspace(0.44, 0.92, humidities), 4).tolist()
    with tempfile.TemporaryDirectory() as folder:
        overlay = Path(folder) / "many.yaml"
        overlay.write_text(yaml.safe_dump({"pairs": {pair: {"humidities": axis} for pair in "abc"}}))
        words = [sys.executable, "-m", "snakemake", "-s", ROOT / "Snakefile", "-d", folder, "-n", "-q", "all"]
        words += ["--configfile", ROOT / "config.yaml", overlay]
        start = time.perf_counter()
        process = subprocess.Popen(list(map(str, words)), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        if status:
            raise RuntimeError(f"the dry run with {humidities} humidities failed")
        return time.perf_counter() - start, usage.ru_maxrss / 1024


def rows():
    """What grows, its size, seconds and peak memory [MB]."""
    for name, sizes in CONTACT.items():
        for size, changes in sizes.items():
            yield f"contact: {name}", size, *contact(changes)
    for number in SAMPLES:
        yield "chaos model: samples", number, *run(_CHAOS, str(number))
    for number in HUMIDITIES:
        yield "plan: humidities per pair", number, *plan_of(number)


def on_two_cores(work):
    """Gain of the second core: two independent processes over one, each of the shortest of three times."""

    def seconds(processes):
        start = time.perf_counter()
        with ThreadPoolExecutor(processes) as pool:
            list(pool.map(lambda _: work(), range(processes)))
        return time.perf_counter() - start

    work()
    alone, both = zip(*((seconds(1), seconds(2)) for _ in range(3)), strict=True)
    return 2 * min(alone) / min(both)


def gains():
    """Gains of the second core: of the contact of 800 pairs, and of a loop that uses neither memory nor files."""
    yield "contact", on_two_cores(partial(contact, {"contact": {"samples": 800}}))
    yield "this machine, a loop in Python", on_two_cores(partial(run, _LOOP, "8e7"))


def table(measured, gained):
    """The table in Markdown; growth is the exponent of the time between the last two sizes."""
    lines = [
        "| what grows | size | seconds | memory [MB] | seconds grow as size to the power |",
        "|---|---|---|---|---|",
    ]
    before = {}
    for name, size, seconds, megabytes in measured:
        power = ""
        if name in before:
            power = f"{np.log(seconds / before[name][1]) / np.log(size / before[name][0]):.2f}"
        before[name] = size, seconds
        lines.append(f"| {name} | {size:g} | {seconds:.2f} | {megabytes:.0f} | {power} |")
    return "\n".join(lines + [f"| {name}: two cores over one | 2 | {gain:.2f} × |  |  |" for name, gain in gained])


def draw(measured, path):
    """Seconds and memory over size, each relative to the smallest, on logarithmic axes."""
    from stiction.report.style import (  # noqa: PLC0415
        DOUBLE,
        SINGLE,
        dashes,
        handles,
        legend_outside,
        letter,
        marker,
        on_a_page,
        panels,
        plain_log,
        styled,
    )

    curves = defaultdict(list)
    for name, *point in measured:
        curves[name].append(point)

    @styled
    def figure():
        drawn, ((left, right),) = panels(1, 2, (DOUBLE, 3.2))
        for k, (name, points) in enumerate(curves.items()):
            size, seconds, megabytes = np.array(points).T
            style = {"marker": marker(k), "linestyle": dashes(k), "label": f"{name}, {size[0]:g} to {size[-1]:g}"}
            left.loglog(size / size[0], seconds / seconds[0], **style)
            right.semilogx(size / size[0], megabytes, **style)
        factor = np.array([1, 20])
        left.loglog(factor, factor, color="0.6", linewidth=0.8, label="proportional")
        for axis in (left.xaxis, left.yaxis, right.xaxis):
            plain_log(axis)
        left.set(xlabel="size / smallest size [–]", ylabel="time / time of the smallest [–]")
        right.set(xlabel="size / smallest size [–]", ylabel="peak memory [MB]", ylim=(0, None))
        letter([left, right], ["time", "memory"])
        legend_outside(drawn, handles(left), "lower", 2)
        return drawn

    with on_a_page(SINGLE):  # text that a phone shows
        figure().savefig(path)


def main():
    """Print the table, and draw the picture into the file named by the argument."""
    measured = list(rows())
    print("\n" + table(measured, gains()))  # noqa: T201
    if len(sys.argv) > 1:
        from update import WIDTH, shrink  # noqa: PLC0415

        with tempfile.TemporaryDirectory() as folder:
            draw(measured, Path(folder) / "scaling.png")
            shrink(Path(folder) / "scaling.png", Path(sys.argv[1]), WIDTH)


if __name__ == "__main__":
    main()
