"""Figure 16: largest stress of the touching summits."""

from stiction.report.figures_studies import summit_stresses
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import data


def main(studies, outputs, settings):
    """Draw the pairs side by side."""
    loaded = {pair: data.load(path, "plasticity") for pair, path in zip(settings["pairs"], studies, strict=True)}
    save(summit_stresses(loaded), *outputs)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input.studies, snakemake.output, snakemake.params.settings)
