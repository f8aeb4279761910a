"""Figure 5: a force curve and its law."""

from stiction.report.figures_forces import fitted_curve
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import data


def main(forces, fit, outputs):
    """Draw the typical curve of one case."""
    save(fitted_curve(data.load(forces, "forces"), data.load(fit, "fit")), *outputs)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input.forces, snakemake.input.fit, snakemake.output)
