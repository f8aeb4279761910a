"""Figure 8: simulated surfaces."""

from stiction.report.figures_surfaces import elevation_maps
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages.named import load_named, surface_of


def main(job):
    """Draw a piece of every surface."""
    save(elevation_maps(load_named(job.input.characters, "character", surface_of)), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
