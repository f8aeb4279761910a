"""P(stuck) of a device at a humidity over its length, and its safe lengths."""

from stiction.config.units import typed
from stiction.designs import safe_lengths
from stiction.run.logs import logged
from stiction.stages import storage


def main(job):
    """Combine cracks and tips."""
    tips = storage.load(job.input.tips, "contact") if job.input.tips else None
    wanted = typed(safe_lengths.Settings, job.params.settings)
    dataset = safe_lengths.compute(storage.load(job.input.cracks, "cracks"), tips, wanted)
    storage.save(dataset, job.output[0], "safe_lengths", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
