"""App. B: release beams on force laws resampled from the contact samples, to assess the chaos model."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.studies import resampling


def main(job):
    """Draw the force laws of every beam from the samples, with replacement, and release the beam."""
    dataset = resampling.compute(
        storage.load(job.input.forces, "forces"), job.wildcards.case, typed(resampling.Settings, job.params.settings)
    )
    storage.save(dataset, job.output[0], "resampling", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
