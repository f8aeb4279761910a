"""Figure 19: convergence of the mesh, autocorrelation of the surfaces."""

from stiction.report.figures_studies import mesh_convergence
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import data


def main(paths, outputs):
    """Draw law, meshes and correlations."""
    save(mesh_convergence(data.load(paths.mesh, "mesh"), data.load(paths.correlation, "correlation")), *outputs)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output)
