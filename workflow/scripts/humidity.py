"""Fig. 15: the adhesion energy of a strip along a fine humidity axis."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.studies import humidity


def main(job):
    """Compute the energy of every sample at every humidity."""
    dataset = humidity.compute(
        storage.load(job.input.contact, "contact"), typed(humidity.Settings, job.params.settings)
    )
    storage.save(dataset, job.output[0], "humidity", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
