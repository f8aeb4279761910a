"""App. C, Fig. 19: convergence of the crack length in the mesh, for one force law."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.studies import mesh


def main(job):
    """Release beams on uniform ground with increasingly fine meshes."""
    dataset = mesh.compute(storage.load(job.input.forces, "forces"), typed(mesh.Settings, job.params.settings))
    storage.save(dataset, job.output[0], "mesh", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
