"""Figure 18: convergence of the chaos model in the order of its polynomials."""

from stiction.report.figures_studies import order_convergence
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import data


def main(orders, outputs):
    """Draw the marginals and their distances."""
    save(order_convergence(data.load(orders, "orders")), *outputs)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input.orders, snakemake.output)
