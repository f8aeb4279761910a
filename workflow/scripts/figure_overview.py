"""Overview of one pair: surface, force curves, beams, crack length over the relative humidity."""

from stiction.report import published
from stiction.report.figures_overview import overview
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.stages.named import key_of, load_named


def main(job):
    """Draw the overview of the README."""
    released = {key[1:]: found for key, found in load_named(job.input.released, "beams", key_of).items()}
    datasets = [storage.load(job.input[stage], stage) for stage in ("character", "forces", "beams")]
    known = published.of_paper(published.read(job.input.published), job.params.settings["of_paper"])
    save(overview(job.params.settings["pair"], *datasets, released, known), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
