"""Figure 13: sensitivity of the adhesion energy to the moments of a surface."""

from stiction.report import published
from stiction.report.figures_studies import sensitivities
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages.named import after_pair, load_named


def main(job):
    """Draw the sensitivities to the moments and the published ones."""
    settings = job.params.settings
    studies = load_named(job.input.studies, "sensitivity", after_pair)
    stated = published.of_paper(published.read(job.input.published), settings["of_paper"])
    stated = stated[(stated.pair == settings["pair"]) & stated.moment.isin(settings["moments"])]
    slopes = dict(zip(zip(stated.moment, stated.relative_humidity, strict=True), stated.slope, strict=True))
    save(sensitivities(studies, slopes), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
