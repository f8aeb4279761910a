"""Figure 9: profiles of one surface with either height model."""

from stiction.report.figures_surfaces import profiles
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import data


def main(characters, outputs, settings):
    """Draw a Gaussian and a non-Gaussian profile."""
    models = {m: data.load(p, "character") for m, p in zip(("G", "NG"), characters, strict=True)}
    save(profiles(settings["surface"], models), *outputs)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input.characters, snakemake.output, snakemake.params.settings)
