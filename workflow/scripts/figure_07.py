"""Figure 7: densities of the heights."""

from stiction.report.figures_surfaces import height_densities
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import data


def main(heights, outputs, settings):
    """Draw the densities of all surfaces."""
    names = settings["surfaces"]
    save(height_densities({n: data.load(p, "heights") for n, p in zip(names, heights, strict=True)}), *outputs)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input.heights, snakemake.output, snakemake.params.settings)
