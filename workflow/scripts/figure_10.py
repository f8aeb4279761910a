"""Figure 10: spectra of simulated surfaces."""

from stiction.report.figures_surfaces import spectra
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages.named import load_named, surface_of


def main(job):
    """Draw the spectra of all surfaces."""
    stages = [
        load_named(job.input[stage], stage, surface_of) for stage in ("heights", "spectrum", "character", "iteration")
    ]
    save(spectra({name: tuple(stage[name] for stage in stages) for name in stages[0]}), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
