"""Figure 5: a force curve and its force law."""

from stiction.report.figures_forces import fitted_curve
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import storage


def main(job):
    """Draw the typical curve of one case."""
    save(fitted_curve(storage.load(job.input.forces, "forces"), storage.load(job.input.fit, "fit")), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
