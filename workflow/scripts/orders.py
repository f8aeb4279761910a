"""App. B, Fig. 18: the order of polynomials at which the chaos model has converged."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.studies import orders


def main(job):
    """Draw from the model truncated at every order and compare."""
    dataset = orders.compute(
        storage.load(job.input.forces, "forces"),
        storage.load(job.input.chaos, "chaos"),
        typed(orders.Settings, job.params.settings),
    )
    storage.save(dataset, job.output[0], "orders", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
