"""App. B, Fig. 17a: how many samples the density of the adhesion energy needs."""

import numpy as np

from stiction.run.logs import logged
from stiction.stages import data, data_studies
from stiction.studies import convergence

#: Energies at which the density is given.
POINTS = 200


def main(forces, output, settings):
    """Compare the first samples with all."""
    energies = data.load(forces, "forces").adhesion_energy.values
    at = np.linspace(0, 1.2 * energies.max(), POINTS)
    sizes = sorted({max(2, round(share * len(energies))) for share in settings["shares"]} | {len(energies)})
    density = [convergence.kernel_estimate(energies[:size], at) for size in sizes]
    distances = [convergence.distance_of_parts(energies, size) for size in sizes]
    data.save(data_studies.sample_sizes(at, density, sizes, distances), output, "sample_sizes", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input[0], snakemake.output[0], snakemake.params.settings)
