"""App. B, Fig. 18: the order of polynomials at which the chaos model has converged."""

from functools import partial

import numpy as np

from stiction.chaos import model as chaos
from stiction.progress import progress
from stiction.run.logs import logged
from stiction.stages import data, data_studies, laws
from stiction.streams import stream
from stiction.studies import convergence

#: Bins of the marginal densities.
EDGES = np.linspace(-4, 4, 65)


def main(forces, model, output, settings):
    """Draw from the model cut at every order and compare the marginals with the kernel density and the samples."""
    vectors, fitted = data.vectors(data.load(forces, "forces")), laws.chaos_model(data.load(model, "chaos"))
    eta = fitted.coordinates.reduce(vectors)[:, : fitted.dimension]
    kernels = chaos.kernel_density(eta)
    targets = [convergence.kernel_distribution(centres, kernels.bandwidth) for centres in kernels.centres]
    histogram = partial(np.histogram, bins=EDGES, density=True)
    orders, densities, distances = range(1, fitted.order + 1), [], []
    for order in progress(orders, "orders"):
        xi = stream(settings["seed"], "orders", settings["case"]).random((settings["draws"], fitted.dimension))
        drawn = chaos.truncated(fitted, order)(xi)
        densities.append([histogram(column)[0] for column in drawn.T])
        to_kernels = [convergence.distance_to(column, target) for column, target in zip(drawn.T, targets, strict=True)]
        distances.append((to_kernels, list(map(convergence.distance_between, drawn.T, eta.T))))
    distances = np.swapaxes(distances, 0, 1)
    converged = [convergence.converged_order(orders, column, len(eta)) for column in distances[0].T]
    of_input = [histogram(column)[0] for column in eta.T]
    found = data_studies.orders(EDGES, of_input, densities, distances, len(eta), converged)
    data.save(found, output, "orders", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(
            snakemake.input.forces,
            snakemake.input.model,
            snakemake.output[0],
            snakemake.params.settings,
        )
