"""Long beams of a device at a humidity: where their cracks stop."""

from stiction.config.units import typed
from stiction.designs import cracks
from stiction.run.logs import logged
from stiction.stages import storage


def main(job):
    """Fit the force laws and release the beams."""
    dataset = cracks.compute(storage.load(job.input.contact, "contact"), typed(cracks.Settings, job.params.settings))
    storage.save(dataset, job.output[0], "cracks", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
