"""Contact of a pair under one variant, i.e. one changed model choice; independent of humidity."""

from stiction.config.merging import merged
from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.stages.named import load_named
from stiction.studies import variant_contact


def main(job):
    """Compute the contact with the changed settings, of the surfaces of the base."""
    settings = job.params.settings
    identifications = load_named(job.input.identifications, "identification")
    changed = merged(settings["base"], settings["changes"])
    wanted = [typed(variant_contact.Settings, plain) for plain in (settings["base"], changed)]
    dataset = variant_contact.compute(identifications, job.wildcards.pair, *wanted)
    storage.save(dataset, job.output[0], "contact", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake)
