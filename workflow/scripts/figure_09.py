"""Figure 9: profiles of one surface with both height models."""

from stiction.report.figures_surfaces import profiles
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages.named import load_named, model_of


def main(job):
    """Draw a Gaussian and a non-Gaussian profile."""
    characters = load_named(job.input.characters, "character", model_of)
    save(profiles(job.params.settings["surface"], characters), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
