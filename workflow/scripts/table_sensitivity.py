"""Figure 13 in numbers."""

from stiction.report import published
from stiction.report.tables import save
from stiction.report.tables_studies import sensitivity
from stiction.run.logs import logged
from stiction.stages.named import after_pair, load_named


def main(job):
    """Compare the sensitivities with the published ones."""
    settings = job.params.settings
    studies = load_named(job.input.studies, "sensitivity", after_pair)
    known = published.of_paper(published.read(job.input.published), settings["of_paper"])
    save(sensitivity(studies, settings["pair"], known), job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
