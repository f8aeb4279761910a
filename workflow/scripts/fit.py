"""Sec. III-B1, Fig. 5: how well Eq. (12) stands for the force curves."""

import numpy as np

from stiction.config.units import si
from stiction.contact.forcelaw import admissible, fit_errors
from stiction.run.logs import logged
from stiction.stages import data, data_studies
from stiction.stages.curves import force_curves


def main(contact, forces, output, settings):
    """Compare every curve with the law of its vector."""
    forces = data.load(forces, "forces")
    vectors, limit = data.vectors(forces), float(forces.limit)
    samples = np.flatnonzero(admissible(vectors, limit))
    temperature = si(settings["water"])["temperature"]
    distance, curve = force_curves(data.load(contact, "contact"), settings["humidity"], temperature)
    errors = fit_errors(distance, curve, samples, vectors[samples], limit)
    data.save(data_studies.fit(samples, errors, len(vectors)), output, "fit", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input.contact, snakemake.input.forces, snakemake.output[0], snakemake.params.settings)
