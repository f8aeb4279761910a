"""Sec. II-C: identify the spectrum from the measured summit statistics."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import identification, storage


def main(job):
    """Fit Eq. (7) to radius and density of the summits."""
    dataset = identification.compute(
        storage.load(job.input.heights, "heights"),
        job.wildcards.surface,
        typed(identification.Settings, job.params.settings),
    )
    storage.save(dataset, job.output[0], "identification", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
