"""Figure 19: convergence of the mesh, autocorrelation of the surfaces."""

from stiction import data
from stiction.figures import save
from stiction.figures_studies import mesh_convergence
from stiction.logs import logged


def main(paths, outputs):
    """Draw law, meshes and correlations."""
    save(mesh_convergence(data.load(paths.mesh, "mesh"), data.load(paths.correlation, "correlation")), *outputs)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output)
