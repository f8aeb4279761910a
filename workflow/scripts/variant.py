"""Beams of a case under one variant, i.e. one changed model choice, from its contact."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.variants import beams


def main(job):
    """Run the stages after contact."""
    settings = typed(beams.Settings, job.params.settings)
    contact = storage.load(job.input.contact, "contact", sample=slice(settings.samples))
    dataset = beams.compute(contact, job.wildcards.case, settings)
    storage.save(dataset, job.output[0], "variant", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
