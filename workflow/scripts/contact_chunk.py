"""Sec. III-A: contact of one chunk of the samples of a pair."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import contact, storage


def main(job):
    """Draw surface pairs and compute their solid pressure and bearing area."""
    surfaces = storage.load_surfaces(job.input.heights, job.input.spectrum)
    wanted = typed(contact.Settings, job.params.settings)
    samples = contact.chunk(wanted.contact.samples, int(job.wildcards.chunk), int(job.wildcards.number))
    dataset = contact.compute(surfaces, job.wildcards.pair, job.wildcards.model, wanted, samples)
    storage.save(dataset, job.output[0], "contact", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
