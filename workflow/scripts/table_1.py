"""Table I: statistics of the simulated surfaces."""

from stiction.measured import estimate
from stiction.report import published
from stiction.report.tables import save
from stiction.report.tables_surfaces import table_1
from stiction.run.logs import logged
from stiction.stages.heights import substitution
from stiction.stages.named import load_named, surface_and_model


def main(job):
    """Compare simulated, published and measured statistics."""
    settings = job.params.settings
    characters = load_named(job.input.characters, "character", surface_and_model)
    substitutions = {name: substitution(found) for name, found in load_named(job.input.heights, "heights").items()}
    scanned = {name: estimate.statistics(found) for name, found in load_named(job.input.estimates, "estimate").items()}
    known = published.of_paper(published.read(job.input.published), settings["of_paper"])
    save(table_1(characters, settings["measured"] | scanned, known, substitutions), job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
