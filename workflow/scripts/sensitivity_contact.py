"""Fig. 13: contact of a pair with one moment of the beam's surface slightly decreased or increased."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.studies import sensitivity_contact


def main(job):
    """Draw samples with the same random numbers for all values of the moments."""
    surfaces = storage.load_surfaces(job.input.heights, job.input.spectrum)
    wanted = typed(sensitivity_contact.Settings, job.params.settings)
    paths = storage.in_order(job.output, sensitivity_contact.names(wanted))
    contacts = sensitivity_contact.compute(surfaces, job.wildcards.pair, wanted)
    for dataset, path in zip(contacts, paths, strict=True):
        storage.save(dataset, path, "contact", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
