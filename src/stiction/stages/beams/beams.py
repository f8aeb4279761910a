"""Stage beams (Secs. III-C and IV): press beams down, release them and find the arrest of their cracks."""

from dataclasses import replace

import numpy as np
import xarray as xr

from stiction.config.cases import Case
from stiction.models import surface_model
from stiction.plan.stage import Running, Stage
from stiction.stages.beams import releases
from stiction.stages.beams.cantilevers import cantilever
from stiction.stages.laws.stored_model import chaos_model

#: Number of beam shapes stored for Fig. 14.
_KEPT = 100

#: Everything that the beams of a case depend on apart from the force laws.
Settings = releases.Settings


def compute(chaos: xr.Dataset, case: Case, settings: Settings, threads: int = 1) -> xr.Dataset:
    """Release all beams of a case. Models NG and GEO have the same force laws.

    The name of the case is part of the addresses of random numbers; ``threads``, the number of beams computed in
    parallel, does not affect the results. Where strips are longer than the mesh of the pair allows, the dataset has the
    longest strip with an error of 1 %.
    """
    model = chaos_model(chaos)
    columns = releases.release_beams(model, case, settings, threads, shapes=_KEPT)
    elements = columns["deflection"].shape[1] - 1
    dataset = layout(columns, replace(cantilever(settings, case.pair), elements=elements).nodes)
    longest = releases.longest_strip(model, case, settings)
    if settings.sampling.strip_length <= settings.coarser_mesh * longest:
        return dataset
    return dataset.assign(longest_strip=longest)


def layout(columns: dict[str, np.ndarray], nodes: np.ndarray) -> xr.Dataset:
    """Dataset of the end state of every beam of a case and of the shapes of the first beams.

    From the arrays of `stiction.beam.montecarlo.columns` and the nominal positions of the nodes (n,) [m].
    """
    return xr.Dataset(
        {
            "state": ("beam", np.asarray(columns["state"], np.int8), releases.FLAGS),
            "crack_length": ("beam", columns["crack_length"]),
            "apparent_energy": ("beam", columns["energy"]),
            "imbalance": ("beam", columns["imbalance"]),
            "iterations": ("beam", columns["iterations"]),
            "deflection": (("shape", "node"), np.asarray(columns["deflection"], np.float32)),
        },
        coords={"beam": columns["sample"], "node": nodes},
    )


def _settings(plan, at):
    """Nominal beam of a case, number of beams and scatter of their dimensions."""
    section = plan.config["beam"]
    number = {"samples": section["samples"], "scatter": section["scatter"] if at.model == "GEO" else 0}
    return releases.sections(plan, at.case) | number


STAGES = (
    Stage.writing(
        "beams",
        "beams/{case}_{model}",
        inputs=lambda plan, at: {"chaos": f"chaos/{at.case}_{surface_model(at.model)}"},
        settings=_settings,
        kind=Settings,
        compute=compute,
        message="Release the beams of {case}, {model} (Sec. III-C).",
        running=Running(minutes=10),
    ),
)
