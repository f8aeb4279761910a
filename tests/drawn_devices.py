"""Devices on drawn surfaces: from a configuration to all files of the target ``devices``, in one process.

Smooth and rough, humid and dry, beams and stoppers: every draw must end in an answer, or in sentences before the first
job. ``tests/benchmarks/draw_devices.py`` runs many draws, a test some that failed once.
"""

import json
import tempfile
import traceback
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

import stiction
from stiction import pilot
from stiction.config.messages import ConfigError
from stiction.plan.graph import Graph, Job, Results, stages, structured
from stiction.plan.plan import Plan
from stiction.plan.stage import At, File
from stiction.run.disk_cache import DiskCache
from stiction.streams import stream
from stiction.surface.feasible import largest_kurtosis

#: Record of a run, which pages show.
RUN = {"started": "2026-01-31T23:05:59+00:00", "config": {}, "versions": {}, "git": None}
#: Few samples, so that a draw takes seconds; beams are as many as the tail of their lengths needs.
SMALL = {
    "run": {"pairs": [], "studies": []},
    "contact": {"samples": 80, "chunks": 1},
    "chaos": {"order": 4},
    "character": {"strips": 3},
    "design": {"beams": 200, "budget_beams": 20, "budget_samples": 20, "chart_points": 3},
    "studies": {"slopes": {"samples": 20}, "variants": {"van_der_waals": [], "psd": [], "every": [], "spacing_nm": []}},
}
#: A smooth and a rough substrate of the paper, and the surface itself.
SUBSTRATES = ("Sub1", "Sub2", "Drawn")
BEAM = {"thickness_um": 2, "gap_um": 2, "width_um": 5}
DEVICES = {
    "cantilever": {"kind": "cantilever", **BEAM},
    "bridge": {"kind": "bridge", **BEAM, "residual_stress_MPa": 50},
    "stopper": {"kind": "stopper", "contact_um": [3, 3], "restoring_force_uN": 5},
}


class Drawn(NamedTuple):
    """A surface, what it meets and in which air."""

    rms: float  #: [nm]
    skewness: float
    kurtosis: float
    corner: float  #: end of the plateau of the spectrum [rad/µm]
    substrate: str
    humidity: float | str
    kind: str  #: of the device
    extra: str = ""  #: what else is asked: a chart, a budget or a roughness


def drawn(number: int) -> Drawn:
    """A draw by its number: rms and corner between their ends by equal factors."""
    rng = stream(46, "drawn devices", number)
    rms, corner = 10 ** rng.uniform(-1, 2), 2 * 100 ** rng.uniform()
    skewness, fraction = rng.uniform(-2, 2), rng.uniform()
    least = max(1.5, skewness**2 + 1.1)
    kurtosis = least + fraction * (min(15, largest_kurtosis(skewness)) - least)
    return Drawn(
        *(float(np.round(value, 3)) for value in (rms, skewness, kurtosis, corner)),
        str(rng.choice(SUBSTRATES)),
        "dry" if rng.uniform() < 0.3 else float(np.round(rng.uniform(0.4, 0.95), 2)),
        str(rng.choice(list(DEVICES))),
        str(rng.choice(["", "", "chart", "uncertainty", "roughness"])),
    )


def overlay(draw: Drawn) -> dict:
    """Configuration of a draw: spectra fall with the same power as that of the paper's surface B2."""
    cutoff, long = min(10 * draw.corner, 300.0), max(1.5, round(9 / draw.corner, 2))
    spectrum = {"plateau_nm4": 1e4, "floor_nm4": 1e4 * (cutoff / draw.corner) ** -4.6, "corner_rad_per_um": draw.corner}
    surface = {"rms_nm": draw.rms, "skewness": draw.skewness, "kurtosis": draw.kurtosis, "psd": "published"}
    surface["published_psd"] = spectrum | {"cutoff_rad_per_um": cutoff}
    device = DEVICES[draw.kind] | {"pair": "drawn", "humidities": [draw.humidity]} | asked(draw)
    pair = {"beam": "Drawn", "substrate": draw.substrate, "gap_um": 2, "humidities": [draw.humidity]}
    reach = {"attraction": {"reach": "all"}} if draw.humidity == "dry" else {}
    sampling = {"sampling": {"strip_length_um": long, "margin_um": long}, "beam": {"length_um": 1000 * long}}
    return (
        SMALL | reach | sampling | {"surfaces": {"Drawn": surface}, "pairs": {"drawn": pair}, "devices": {"D": device}}
    )


def asked(draw: Drawn) -> dict:
    """Further keys of a device."""
    if draw.extra == "uncertainty":
        return {"uncertainty": {"scan_um": 10, "young_modulus_GPa": 5}}
    if draw.extra == "roughness":
        length = {} if draw.kind == "stopper" else {"length_um": 100}
        rms = {"surface": "Drawn", "rms_nm": [draw.rms / 2, 2 * draw.rms]}
        return {"requirement": {"share": 0.05} | length, "roughness": rms}
    if draw.extra == "chart" and draw.kind != "stopper":
        wet = 0.7 if draw.humidity == "dry" else draw.humidity
        return {"chart": {"thicknesses_um": [2, 3], "humidities": [round(wet - 0.02, 2), round(wet + 0.02, 2)]}}
    return {}


@dataclass(frozen=True)
class Files(Results):
    """Results with files that are no datasets, in a folder."""

    folder: Path = Path()

    def _read(self, file):
        if not isinstance(file, File):
            return self[file]
        if not file.startswith("results/"):
            return file
        self.write(self.graph.job(file.removeprefix("results/")))
        return str(self.folder / file.removeprefix("results/"))

    def write(self, job: Job) -> None:
        """Compute and save a job."""
        data = {name: structured(files, self._read) for name, files in job.inputs.items()}
        result = job.compute(data)
        paths = {key: self.folder / name.format(**vars(job.at)) for key, name in job.stage.files.items()}
        for path in paths.values():
            path.parent.mkdir(parents=True, exist_ok=True)
        if job.stage.save is not None:
            job.stage.save(result, {key: str(path) for key, path in paths.items()})


def outcome(draw: Drawn) -> str:
    """``answer``, ``refused`` with the sentences, or the traceback of the job that failed."""
    try:
        config = stiction.load(overlay(draw))
    except ConfigError as error:
        return f"refused {' | '.join(error.problems)}"
    if problems := pilot.problems(config, {}, "code", DiskCache("none")):
        return f"refused {' | '.join(map(str, problems))}"
    plan = Plan(config)
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "provenance.json").write_text(json.dumps([RUN]), encoding="utf-8")
        results = Files(Graph(plan), folder=Path(folder))
        for stage, _ in stages().values():
            if "devices" not in stage.targets:
                continue
            for wildcards in stage.jobs_of_targets(plan):
                try:
                    results.write(Job(stage, At(**wildcards), plan))
                except Exception:
                    return f"failed {stage.name} {traceback.format_exc()}"
        return "answer " + next(Path(folder).glob("devices/*.txt")).read_text(encoding="utf-8")
