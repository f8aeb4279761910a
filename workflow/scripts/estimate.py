"""Estimate a measured surface, with errors, from its scans."""

from stiction.config.units import typed
from stiction.measured import estimate
from stiction.run.logs import logged
from stiction.stages import storage


def main(job):
    """Estimate moments, height density and spectrum from all scans of the surface."""
    scans = storage.load_all(job.input, "scan")
    dataset = estimate.compute(scans, job.wildcards.surface, typed(estimate.Settings, job.params.settings))
    storage.save(dataset, job.output[0], "estimate", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
