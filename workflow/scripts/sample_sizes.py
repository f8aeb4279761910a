"""App. B, Fig. 17a: convergence of the density of the adhesion energy in the number of samples."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.studies import sample_sizes


def main(job):
    """Compare the first samples with all samples."""
    dataset = sample_sizes.compute(
        storage.load(job.input.forces, "forces"), typed(sample_sizes.Settings, job.params.settings)
    )
    storage.save(dataset, job.output[0], "sample_sizes", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
