"""Contact of a pair under one variant, i.e. one changed model choice; independent of humidity."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.variants import contact


def main(job):
    """Compute the contact of the summits with the solids of the variant."""
    summits = storage.load(job.input.summits, "variant_summits")
    dataset = contact.compute(summits, typed(contact.Settings, job.params.settings))
    storage.save(dataset, job.output[0], "contact", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
