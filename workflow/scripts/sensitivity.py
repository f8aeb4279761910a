"""Fig. 13: sensitivity of the adhesion energy of a pair to one moment of its beam's surface."""

import numpy as np

from stiction.run.logs import logged
from stiction.stages import data, data_studies
from stiction.studies import sensitivity
from stiction.study import PairStudy


def main(contacts, output, settings, pair):
    """Compare the same samples, in the sense of their random numbers, at the two values of the moment."""
    contacts = [data.load(contact, "contact") for contact in contacts]
    at, humidities = [float(contact.moment) for contact in contacts], settings["humidities"]
    studies = [PairStudy(pair, contact, settings) for contact in contacts]
    energies = np.array([[study.energies(humidity) for humidity in humidities] for study in studies])
    estimate = sensitivity.energy_sensitivity(energies.swapaxes(1, 2), at)
    data.save(data_studies.sensitivity(energies, at, estimate, humidities), output, "sensitivity", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output[0], snakemake.params.settings, snakemake.wildcards.pair)
