"""Figure 13: sensitivity of the adhesion energy to the moments of a surface."""

from stiction.report import tables
from stiction.report.figures_studies import sensitivities
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import data


def main(paths, outputs, settings):
    """Draw the sensitivities to the moments beside those that the paper states."""
    loaded = {
        moment: data.load(path, "sensitivity") for moment, path in zip(settings["moments"], paths.studies, strict=True)
    }
    stated = tables.published(paths.printed)
    stated = stated[(stated.pair == settings["pair"]) & stated.moment.isin(settings["moments"])]
    printed = dict(zip(zip(stated.moment, stated.relative_humidity, strict=True), stated.slope, strict=True))
    save(sensitivities(loaded, printed), *outputs)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output, snakemake.params.settings)
