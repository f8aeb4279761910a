"""Pull-off force of a stopper against its restoring force, over the humidity."""

from stiction.config.units import typed
from stiction.designs import stoppers
from stiction.run.logs import logged
from stiction.stages import storage


def main(job):
    """Compute the pull-off forces of all sampled patches."""
    contact = storage.load(job.input.contact, "contact")
    dataset = stoppers.compute(contact, typed(stoppers.Settings, job.params.settings))
    storage.save(dataset, job.output[0], "stoppers", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
