"""Sec. II-A: the maximum-entropy height density of one surface."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import heights, storage


def main(job):
    """Solve for the maximum-entropy density with the moments of the surface."""
    dataset = heights.compute(typed(heights.Settings, job.params.settings))
    storage.save(dataset, job.output[0], "heights", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
