"""Figure 18: convergence of the marginals in the order of the polynomials."""

from stiction.report.figures_studies import order_convergence
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import storage


def main(job):
    """Draw the marginals of one case."""
    save(order_convergence(storage.load(job.input.orders, "orders")), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
