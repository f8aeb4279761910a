"""Fig. 15: the adhesion energy of a piece of surface along a fine axis of humidities."""

import numpy as np

from stiction.config.units import si
from stiction.contact.forcelaw import adhesion_energies
from stiction.progress import progress
from stiction.run.logs import logged
from stiction.stages import data, data_studies
from stiction.stages.curves import force_curves

#: Median and bounds of the band.
PROBABILITIES = np.array([0.05, 0.5, 0.95])


def main(contact, output, settings):
    """Find the energy of every sample at every humidity."""
    contact = data.load(contact, "contact")
    temperature, samples = si(settings["water"])["temperature"], contact.sizes["sample"]
    humidities = np.linspace(*settings["range"], settings["points"])
    curves = (force_curves(contact, float(h), temperature) for h in progress(humidities, "humidities"))
    energies = np.array([adhesion_energies(distance, curve, samples) for distance, curve in curves])
    data.save(data_studies.humidity_axis(humidities, PROBABILITIES, energies), output, "humidity", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input[0], snakemake.output[0], snakemake.params.settings)
