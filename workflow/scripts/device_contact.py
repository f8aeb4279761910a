"""Contact of a pair on patches of the size of a device."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import contact, storage


def main(job):
    """Draw surface pairs and compute their solid pressure and bearing area."""
    surfaces = storage.load_surfaces(job.input.heights, job.input.spectrum)
    dataset = contact.compute(surfaces, job.wildcards.pair, "NG", typed(contact.Settings, job.params.settings))
    storage.save(dataset, job.output[0], "contact", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
