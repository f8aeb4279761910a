"""Sec. II-A: the height density of a measured surface."""

from stiction.config.units import typed
from stiction.measured import heights
from stiction.run.logs import logged
from stiction.stages import storage


def main(job):
    """Take the density of the measured moments or of the measured quantiles."""
    estimate = storage.load(job.input.estimate, "estimate")
    dataset = heights.compute(estimate, typed(heights.Settings, job.params.settings))
    storage.save(dataset, job.output[0], "heights", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
