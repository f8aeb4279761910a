"""Figure 11: heights and radii of summits, of one surface or of the others."""

from stiction.report.figures_surfaces import summits
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import data


def main(gaussian, other, outputs, settings):
    """Draw the joint densities of some surfaces with either height model."""
    models = [
        {"G": data.load(g, "character"), "NG": data.load(o, "character")} for g, o in zip(gaussian, other, strict=True)
    ]
    save(summits(dict(zip(settings["surfaces"], models, strict=True))), *outputs)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input.gaussian, snakemake.input.other, snakemake.output, snakemake.params.settings)
