"""Figure 11: heights and radii of summits, of one surface or several."""

from stiction.report.figures_surfaces import summits
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages.named import load_named, surface_of


def main(job):
    """Draw the joint densities of the surfaces with both height models."""
    gaussian, other = (load_named(paths, "character", surface_of) for paths in (job.input.gaussian, job.input.other))
    save(summits({name: {"G": gaussian[name], "NG": other[name]} for name in gaussian}), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
