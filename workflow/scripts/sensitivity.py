"""Fig. 13: sensitivity of the adhesion energy of a pair to one moment of the beam's surface."""

from stiction.config.units import typed
from stiction.models import SHIFTED
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.studies import sensitivity


def main(job):
    """Compare the energies at the two values of the moment."""
    contacts = storage.load_all(storage.in_order(job.input.contacts, SHIFTED), "contact")
    dataset = sensitivity.compute(contacts, typed(sensitivity.Settings, job.params.settings))
    storage.save(dataset, job.output[0], "sensitivity", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
