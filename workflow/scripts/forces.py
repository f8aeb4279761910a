"""Sec. III-B1: force curves at one humidity and the vectors of their parameters."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import forces, storage


def main(job):
    """Add the water to the solid contact of every sample and compute the parameters of the curves."""
    dataset = forces.compute(storage.load(job.input.contact, "contact"), typed(forces.Settings, job.params.settings))
    storage.save(dataset, job.output[0], "forces", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
