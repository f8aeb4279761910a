"""Figure 16: largest stress of the touching summits."""

from stiction.report.figures_studies import summit_stresses
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages.named import load_named


def main(job):
    """Draw the pairs side by side."""
    save(summit_stresses(load_named(job.input.studies, "plasticity")), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
