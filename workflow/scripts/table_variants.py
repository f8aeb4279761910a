"""Table III under other model choices."""

from stiction.report import published
from stiction.report.tables import save
from stiction.report.tables_studies import variants
from stiction.run.logs import logged
from stiction.stages.named import key_of, load_named
from stiction.variants.beams import by_pair


def main(job):
    """Compare every variant with the base and with the published and measured crack lengths."""
    loaded = by_pair(load_named(job.input.studies, "variant", key_of))
    known = published.of_paper(published.read(job.input.published), job.params.settings["of_paper"])
    save(variants(loaded, known), job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
