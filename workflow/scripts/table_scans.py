"""Scans of the measured surfaces."""

from stiction.measured.tables_scans import scans
from stiction.report.tables import save
from stiction.run.logs import logged
from stiction.stages.named import load_named


def main(job):
    """List every scan with its moments."""
    estimates = load_named(job.input.estimates, "estimate")
    spectra = load_named(job.input.spectra, "spectrum")
    read = load_named(job.input.scans, "scan")
    maps = {name: [read[f"{name}_{number}"] for number in job.params.settings["scans"][name]] for name in estimates}
    save(scans(estimates, spectra, maps), job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
