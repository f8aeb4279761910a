"""Errors of Eq. (12) over all samples of every case."""

from stiction.report.tables import save
from stiction.report.tables_beams import fit_quality
from stiction.run.logs import logged
from stiction.stages.named import key_of, load_named


def main(job):
    """Summarise the errors of every case."""
    save(fit_quality(load_named(job.input.fits, "fit", key_of)), job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
