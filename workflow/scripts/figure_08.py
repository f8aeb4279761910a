"""Figure 8: simulated surfaces."""

from stiction.report.figures_surfaces import elevation_maps
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import data


def main(characters, outputs, settings):
    """Draw a piece of every surface."""
    names = settings["surfaces"]
    save(elevation_maps({n: data.load(p, "character") for n, p in zip(names, characters, strict=True)}), *outputs)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input.characters, snakemake.output, snakemake.params.settings)
