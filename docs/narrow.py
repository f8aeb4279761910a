"""Pictures of the docs: figures of a run, drawn as on pages, with panels below each other and text for a phone."""

from collections.abc import Iterable
from pathlib import Path

from matplotlib.figure import Figure

from stiction.config.files import load
from stiction.plan.graph import Graph, Job, structured
from stiction.plan.plan import Plan
from stiction.plan.stage import File
from stiction.report.style import SINGLE, on_a_page, save
from stiction.run import storage


def draw(folder: Path, into: Path, names: Iterable[str], *overlays: Path) -> None:
    """Draw figures of a run in a working folder and save them into another one.

    Parameters
    ----------
    folder
        Working folder of the run, with ``results``.
    names
        Of the figures.
    overlays
        Configuration files of the run.
    """
    graph = Graph(Plan(load(*overlays)))
    for name in names:
        save(figure_of(folder, graph.job(f"figures/{name}.png")), into / f"{name}.png")


def figure_of(folder: Path, job: Job) -> Figure:
    """Figure of a job from the results in a working folder, as wide as a column of a journal."""

    def read(file):
        if isinstance(file, File):
            return folder / file
        stage = job_of(file).stage.stage
        return storage.load(folder / "results" / f"{file}.nc", stage)

    job_of = Graph(job.plan).job
    with on_a_page(SINGLE):
        return job.compute({name: structured(names, read) for name, names in job.inputs.items()})
