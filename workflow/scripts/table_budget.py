"""Uncertainty of all devices."""

from stiction.designs.tables_budget import budget
from stiction.report.tables import save
from stiction.run.logs import logged
from stiction.stages.named import key_of, load_named


def main(job):
    """Write inputs, measurements, totals and choices of the model."""
    save(budget(load_named(job.input.budgets, "budget", key_of)), job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
