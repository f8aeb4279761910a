"""Uncertainty of the adhesion energy due to finite scans of measured surfaces."""

from stiction.measured.tables_scans import scan_uncertainty
from stiction.report.tables import save
from stiction.run.logs import logged
from stiction.stages.named import load_named


def main(job):
    """List the errors of every pair."""
    save(scan_uncertainty(load_named(job.input.studies, "scan_uncertainty")), job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
