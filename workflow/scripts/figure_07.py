"""Figure 7: densities of the heights."""

from stiction.report.figures_surfaces import height_densities
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages.named import load_named


def main(job):
    """Draw the densities of all surfaces."""
    save(height_densities(load_named(job.input.heights, "heights")), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
