"""App. C, Fig. 19: what the mesh makes of one force law."""

import warnings
from dataclasses import replace

import numpy as np

from stiction.config.units import si
from stiction.contact import forcelaw
from stiction.progress import progress
from stiction.run.logs import logged
from stiction.stages import data, data_studies
from stiction.stages.cantilevers import cantilever
from stiction.studies import convergence


def main(forces, output, settings):
    """Release beams on uniform ground under ever finer meshes."""
    forces = data.load(forces, "forces")
    energies = forces.adhesion_energy.values[: forces.sizes["curve"]]
    # ASSUME: the paper's one realisation is a typical one: of the curves kept, that of median energy.
    sample = int(np.argsort(energies)[len(energies) // 2])
    law = forcelaw.coefficients(data.vectors(forces)[[sample]], float(forces.limit))[0]
    beam = cantilever(settings, settings["pair"])
    lengths = si({key: np.array(values) for key, values in settings["mesh"].items()})
    meshes = convergence.whole_meshes(beam.length, lengths["elements"], lengths["strips"])
    arrests = {}
    for element, point in progress(meshes, "meshes"):
        ground = replace(beam, elements=round(beam.length / element)), law, round(beam.length / point)
        try:
            arrests[element, point] = convergence.arrest_on_uniform_ground(*ground)
        except ValueError as reason:  # the crack is too short for the elements
            warnings.warn(f"left out: {reason}", stacklevel=2)
    if not arrests:
        raise ValueError("no mesh of studies.mesh resolves the crack: take shorter elements")
    curve = forces.distance.values, forces.force.values[sample]
    data.save(data_studies.mesh([*arrests], [*arrests.values()], law, curve), output, "mesh", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input[0], snakemake.output[0], snakemake.params.settings)
