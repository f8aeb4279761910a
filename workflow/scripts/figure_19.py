"""Figure 19: convergence of the mesh, and the autocorrelation of the surfaces."""

from stiction.report.figures_studies import mesh_convergence
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import storage


def main(job):
    """Draw the mesh and the correlation studies."""
    studies = storage.load(job.input.mesh, "mesh"), storage.load(job.input.correlation, "correlation")
    save(mesh_convergence(*studies), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
