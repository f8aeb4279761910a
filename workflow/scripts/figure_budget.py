"""Uncertainty of a device."""

from stiction.designs.figures_budget import budget
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages.named import key_of, load_named


def main(job):
    """Draw the effect of every measurement."""
    save(budget(load_named(job.input.budgets, "budget", key_of)), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
