"""Table II: published and identified spectra."""

from stiction.report import published
from stiction.report.tables import save
from stiction.report.tables_surfaces import table_2
from stiction.run.logs import logged
from stiction.stages.named import load_named


def main(job):
    """Compare the parameters of Eq. (7)."""
    settings = job.params.settings
    found = load_named(job.input.identifications, "identification")
    spectra = load_named(job.input.spectra, "spectrum")
    known = published.of_paper(published.read(job.input.published), settings["of_paper"])
    save(table_2(found, spectra, known, settings["sources"]), job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
